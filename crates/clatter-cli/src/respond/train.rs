//! This module shows a component that is driven by the paper's bar, or by shocks or pulses of a file.

use std::io::{self, Write};
use std::path::Path;

use clatter::Start;
use clatter_answer::Error;
use clatter_answer::respond::{self, Answer, BarAnswer, Excitation, Extreme, Question};
use clatter_product::units::Quantity;
use clatter_shock::{Suspension, VelocityShocks};
use serde::Serialize;

use super::peaks::{Shocks, equivalent_table};
use super::{Args, rule};
use crate::numbers::{figures, given};
use crate::output::Target;
use crate::quantities::Show;
use crate::{Failure, lists, text};

/// The answer for a train of shocks, with the arguments that it is shown by.
pub(super) struct Train<'a> {
    args: &'a Args,
    question: Question,
    answer: Answer,
    /// The file of the shocks or pulses.
    file: Option<&'a Path>,
}

/// The answer for programs, after the file of the shocks.
#[derive(Serialize)]
pub(super) struct OfFile<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<&'a Path>,
    #[serde(flatten)]
    answer: &'a Answer,
}

impl Args {
    pub(super) fn train(&self) -> Result<Train<'_>, Failure> {
        let Some(omega) = self.omega() else {
            return Err(Failure::Usage("--omega is missing: the natural angular frequency of the component"));
        };
        let free = Suspension::new(omega, self.damping.ratio()?)?;
        let stop = self.stop.given()?;
        if stop.is_some() && self.shocks_file.is_none() && self.pulses_file.is_none() {
            return Err(Failure::Usage("--stop needs SI units: --model, --product or a file"));
        }
        let suspension = stop.map_or(free, |stop| free.with_stop(stop));
        let (file, excitation) = match (&self.shocks_file, &self.pulses_file) {
            (Some(path), _) => (Some(path), Excitation::Shocks(VelocityShocks::new(lists::shocks(path)?)?)),
            (None, Some(path)) => (Some(path), Excitation::Pulses(lists::pulses(path)?)),
            (None, None) => (None, self.clatter()?),
        };
        let mut question = Question::new(excitation, suspension);
        question.shock_table = self.equivalent_pulse.then_some(self.shock_table);
        let answer = respond::answer(&question).map_err(|error| match error {
            Error::Quantity { value, allowed, .. } => {
                Failure::Wrong(format!("--omega {value:?} rad/s is not {allowed}"))
            }
            error => error.into(),
        })?;
        Ok(Train { args: self, question, answer, file: file.map(AsRef::as_ref) })
    }

    /// Makes the clatter of the paper's bar.
    fn clatter(&self) -> Result<Excitation, Failure> {
        let at = self.position()?.unwrap_or(f64::NAN);
        let (bar, start) = (self.inertia.bar(self.e())?, Start::new(self.velocity.map(|v| v.si), self.height_gap.si)?);
        let in_si = self.has_units()? || start != Start::default();
        // A frequency needs both: one alone would leave the other in v0 or h0.
        let plain = Start::default();
        #[expect(clippy::float_cmp, reason = "the defaults themselves")]
        let both = start.velocity() != plain.velocity() && start.height_gap() != plain.height_gap();
        if self.frequency.is_some() && !(self.has_units()? || both) {
            return Err(Failure::Usage(
                "--frequency needs SI units: --velocity in m/s and --height-gap in m, --model, or a file; --omega is in v0/h0",
            ));
        }
        if self.equivalent_pulse && !in_si {
            return Err(Failure::Usage(
                "--equivalent-pulse needs SI units: --velocity in m/s and --height-gap in m, --model, or a file",
            ));
        }
        Ok(Excitation::Bar { bar, start, at })
    }
}

impl Train<'_> {
    fn is_pulses(&self) -> bool {
        matches!(self.question.excitation, Excitation::Pulses(_))
    }

    /// Returns the unit in which velocities are shown.
    fn speed_shown(&self) -> Show {
        let unit = if self.file.is_none() { self.args.velocity[0].unit } else { None };
        Show { unit, name: if self.file.is_none() { "v0" } else { "m/s" } }
    }

    /// Returns W h0/v0 of a bar.
    fn ratio(&self) -> Option<f64> {
        self.answer.bar.map(|bar| self.answer.part.omega.0 * bar.height_gap.0 / -bar.velocity[0].0)
    }

    pub(super) fn write_rule(&self, target: &Target) -> Result<(), Failure> {
        let (Excitation::Bar { bar, start, at }, Some(ratio)) = (&self.question.excitation, self.ratio()) else {
            return Ok(());
        };
        if ratio == 0.0 {
            return Err(Failure::Usage("a flat drop has no rule over W h0/v0; give a --height-gap above 0"));
        }
        let rule = respond::rule::answer(bar, start, *at, &self.question.suspension)?;
        let peak = self.answer.part.peak_absolute_acceleration_over_omega.0 / -start.velocity()[0];
        rule::write(target, &rule, [ratio, peak])
    }

    fn headings(&self, out: &mut dyn Write) -> io::Result<()> {
        let (omega, zeta) = (given(self.answer.part.omega.0), given(self.answer.part.damping.0));
        if let Some(path) = self.file {
            let kind = if self.is_pulses() { "pulses" } else { "velocity shocks" };
            let (path, count) = (text::path(path), self.answer.shocks.listed);
            writeln!(out, "Component of W = {omega} rad/s, damping ratio {zeta}")?;
            return writeln!(out, "{path}: {count} {kind}\n");
        }
        let Some(BarAnswer { q, e, velocity, height_gap, at, .. }) = self.answer.bar else { return Ok(()) };
        let [at, q, e] = [at, q, e].map(|x| given(x.0));
        let length = self.args.height_gap.unit;
        let frequency = match self.args.frequency {
            Some(Quantity { si, unit }) => Show { unit, name: "Hz" }.given(si),
            None => format!("W = {omega} {}", if length.is_some() { "rad/s" } else { "v0/h0" }),
        };
        writeln!(out, "Component at {at} of a bar with q = {q}, e = {e}; {frequency}, damping ratio {zeta}")?;
        let [va, vb] = velocity.map(|v| self.speed_shown().given(v.0));
        let gap = Show { unit: length, name: "h0" }.given(height_gap.0);
        writeln!(out, "End a strikes first, at {va}; end b comes with {vb} from {gap}\n")
    }

    pub(super) fn table(&self, out: &mut dyn Write) -> io::Result<()> {
        self.headings(out)?;
        let Answer { part, shocks: of_place, soft, stiff, clatter_free, standard, gain, .. } = &self.answer;
        let speed = self.speed_shown();
        let in_units = self.file.is_some() || speed.unit.is_some();
        let when = format!("when, {}", if in_units { "s" } else { "h0/v0" });
        writeln!(out, "{:<34}{:>12} {when:>13}", "Peak", speed.name())?;
        for (name, Extreme { value, time, after_impact, .. }) in [
            ("relative displacement, W z", part.peaks.omega_relative_displacement.peak),
            ("relative velocity", part.peaks.relative_velocity.peak),
            ("absolute acceleration, A/W", part.peaks.absolute_acceleration_over_omega.peak),
        ] {
            let (size, holder) = (speed.figures(value.0.abs()), self.holder(value.0, after_impact.unwrap_or(0)));
            writeln!(out, "  {name:<32}{size:>12} {:>13}  {holder}", figures(time.0))?;
        }
        let mut shocks = Shocks { show: speed, out };
        shocks.head()?;
        shocks.row("of the net change, W h0/v0 -> 0", soft.shock, Some(soft))?;
        shocks.row("the largest, W h0/v0 -> infinity", of_place.largest.0, stiff.as_ref())?;
        shocks.at_once(clatter_free.as_ref(), standard.as_ref())?;
        if let (Some(ratio), Some(gain)) = (self.ratio(), gain) {
            let (ratio, gain) = (figures(ratio), figures(gain.0));
            writeln!(out, "\nW h0/v0 = {ratio}; acceleration over that of the standards' shock: {gain}")?;
        }
        if of_place.omitted.0 > 0.0 {
            let omitted = speed.said(of_place.omitted.0);
            writeln!(out, "The impacts never end; what was left out changes W z by {omitted} at most")?;
        }
        equivalent_table(self.answer.equivalent.as_ref(), out)
    }

    /// Describes the impact, shock or pulse that a peak follows.
    fn holder(&self, peak: f64, number: usize) -> String {
        if peak.abs() <= 0.0 {
            return "no impact is felt here".to_owned();
        }
        let what = match self.question.excitation {
            Excitation::Bar { .. } => "impact",
            Excitation::Shocks(_) => "shock",
            Excitation::Pulses(_) => "the start of pulse",
        };
        let last = if number == self.answer.shocks.listed { ", the last" } else { "" };
        format!("after {what} {number}{last}")
    }

    pub(super) fn answer(&self) -> OfFile<'_> {
        OfFile { file: self.file, answer: &self.answer }
    }
}
