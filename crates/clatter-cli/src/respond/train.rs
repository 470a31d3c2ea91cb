//! A component that is driven by the paper's bar, or by shocks or pulses of a file.

use std::io::{self, Write};
use std::ops::RangeInclusive;
use std::path::Path;

use clatter::{Bar, Start};
use clatter_assess::units::Quantity;
use clatter_shock::{
    DampingRatio, Extreme, Frequencies, ImpulseFactors, Pulses, Response, Suspension, VelocityShock, VelocityShocks,
};
use serde::Serialize;

use super::peaks::{
    Equivalent, EquivalentJson, FactorsJson, ResponseJson, Shocks, at_once, equivalent, equivalent_table,
};
use super::{Args, rule};
use crate::numbers::{Json, figures, given};
use crate::output::Target;
use crate::quantities::Show;
use crate::{Failure, excitation, lists, text};

/// What shakes the component.
enum Driven<'a> {
    Bar { bar: Bar, start: Start },
    Shocks(&'a Path),
    Pulses(&'a Path),
}

/// What is shown.
pub(super) struct Train<'a> {
    args: &'a Args,
    position: Option<f64>,
    driven: Driven<'a>,
    suspension: Suspension,
    response: Response,
    /// Velocity changes at the place.
    shocks: VelocityShocks,
    /// Bound on what an endless train leaves out.
    omitted: f64,
    equivalent: Option<Equivalent>,
}

/// Angular frequencies whose squares, and times between, are floats beside the pulses', in rad/s.
const SWINGS: RangeInclusive<f64> = 1e-100..=1e100;

impl Args {
    pub(super) fn train(&self) -> Result<Train<'_>, Failure> {
        let Some(omega) = self.omega() else {
            return Err(Failure::Usage("--omega is missing: the natural angular frequency of the component"));
        };
        let suspension = Suspension::new(omega, self.damping.ratio()?)?;
        let position = self.position()?;
        let (driven, response, shocks, omitted) = if let Some(path) = &self.shocks_file {
            let shocks = VelocityShocks::new(lists::shocks(path)?)?;
            (Driven::Shocks(path), shocks.respond(&suspension), shocks, 0.0)
        } else if let Some(path) = &self.pulses_file {
            let (response, shocks) = pulses(path, &suspension)?;
            (Driven::Pulses(path), response, shocks, 0.0)
        } else {
            let (bar, start) =
                (self.inertia.bar(self.e())?, Start::new(self.velocity.map(|v| v.si), self.height_gap.si)?);
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
            let train = clatter_shock::respond(&bar, &start, position.unwrap_or(f64::NAN), &suspension)?;
            (Driven::Bar { bar, start }, train.response, train.shocks, train.omitted)
        };
        let asked = self.equivalent_pulse.then(|| equivalent(&self.shock_table, &suspension, &response));
        let equivalent = asked.transpose()?;
        Ok(Train { args: self, position, driven, suspension, response, shocks, omitted, equivalent })
    }
}

/// The response to the pulses of a file, and their velocity changes in order of time.
fn pulses(path: &Path, suspension: &Suspension) -> Result<(Response, VelocityShocks), Failure> {
    let mut list = lists::pulses(path)?;
    let omega = suspension.omega();
    if !SWINGS.contains(&omega) {
        let what = format!("--omega {omega:?} rad/s is not in [1e-100, 1e100], which pulses take");
        return Err(Failure::Wrong(what));
    }
    let hz = Frequencies::list(vec![omega / std::f64::consts::TAU])?;
    excitation::check_periods(&list, &hz).map_err(Failure::Wrong)?;
    let response = Pulses::new(&list)?.respond(suspension);
    list.sort_by(|a, b| a.start.total_cmp(&b.start));
    let shock = |p: &clatter_shock::Pulse| VelocityShock { time: p.start, delta_v: p.velocity_change() };
    Ok((response, VelocityShocks::new(list.iter().map(shock).collect())?))
}

impl Train<'_> {
    fn damping(&self) -> DampingRatio {
        self.suspension.damping()
    }

    fn is_pulses(&self) -> bool {
        matches!(self.driven, Driven::Pulses(_))
    }

    /// How velocities are shown.
    fn speed_shown(&self) -> Show {
        let bar = matches!(self.driven, Driven::Bar { .. });
        let unit = if bar { self.args.velocity[0].unit } else { None };
        Show { unit, name: if bar { "v0" } else { "m/s" } }
    }

    /// The speed of the end that strikes first.
    fn speed(&self) -> Option<f64> {
        if let Driven::Bar { start, .. } = &self.driven { Some(-start.velocity()[0]) } else { None }
    }

    /// W h0/v0.
    fn ratio(&self) -> Option<f64> {
        let Driven::Bar { start, .. } = &self.driven else { return None };
        Some(self.suspension.omega() * start.height_gap() / -start.velocity()[0])
    }

    /// The clatter-free impact, and what standards assume.
    fn at_once(&self) -> Option<[f64; 2]> {
        self.speed().map(|speed| at_once(self.args.e(), speed))
    }

    /// Peaks of a component so stiff that it has calmed down before the next shock; pulses it follows.
    fn stiff(&self) -> Option<ImpulseFactors> {
        self.shocks.stiff_limit(self.damping()).filter(|_| !self.is_pulses())
    }

    fn impulse(&self, delta_v: f64) -> ImpulseFactors {
        self.damping().impulse_factors().times(delta_v)
    }

    /// Peak acceleration over that of one shock of 2 v0.
    fn gain(&self) -> Option<f64> {
        let peak = self.response.acceleration_over_omega().magnitude();
        self.at_once().map(|[_, standard]| peak / self.impulse(standard).acceleration)
    }

    pub(super) fn write_rule(&self, target: &Target) -> Result<(), Failure> {
        let (Driven::Bar { bar, start }, Some(ratio)) = (&self.driven, self.ratio()) else { return Ok(()) };
        let peak = self.response.acceleration_over_omega().magnitude() / -start.velocity()[0];
        rule::write(target, (bar, start), self.position.unwrap_or(f64::NAN), &self.suspension, [ratio, peak])
    }

    fn headings(&self, out: &mut dyn Write) -> io::Result<()> {
        let (omega, zeta) = (given(self.suspension.omega()), given(self.damping().get()));
        match &self.driven {
            Driven::Bar { bar, start } => {
                let (at, q, e) = (given(self.position.unwrap_or(f64::NAN)), given(bar.q()), given(bar.e()));
                let length = self.args.height_gap.unit;
                let frequency = match self.args.frequency {
                    Some(Quantity { si, unit }) => Show { unit, name: "Hz" }.given(si),
                    None => format!("W = {omega} {}", if length.is_some() { "rad/s" } else { "v0/h0" }),
                };
                writeln!(out, "Component at {at} of a bar with q = {q}, e = {e}; {frequency}, damping ratio {zeta}")?;
                let [va, vb] = start.velocity().map(|v| self.speed_shown().given(v));
                let gap = Show { unit: length, name: "h0" }.given(start.height_gap());
                writeln!(out, "End a strikes first, at {va}; end b comes with {vb} from {gap}\n")
            }
            Driven::Shocks(path) | Driven::Pulses(path) => {
                let kind = if self.is_pulses() { "pulses" } else { "velocity shocks" };
                let (path, count) = (text::path(path), self.shocks.as_slice().len());
                writeln!(out, "Component of W = {omega} rad/s, damping ratio {zeta}")?;
                writeln!(out, "{path}: {count} {kind}\n")
            }
        }
    }

    pub(super) fn table(&self, out: &mut dyn Write) -> io::Result<()> {
        self.headings(out)?;
        let speed = self.speed_shown();
        let in_units = !matches!(self.driven, Driven::Bar { .. }) || speed.unit.is_some();
        let when = format!("when, {}", if in_units { "s" } else { "h0/v0" });
        writeln!(out, "{:<34}{:>12} {when:>13}", "Peak", speed.name())?;
        let z = self.response.pseudo_velocity();
        let (v, a) = (self.response.relative_velocity, self.response.acceleration_over_omega());
        for (name, extremes) in
            [("relative displacement, W z", z), ("relative velocity", v), ("absolute acceleration, A/W", a)]
        {
            let peak = extremes.peak();
            let size = speed.figures(peak.value.abs());
            writeln!(out, "  {name:<32}{size:>12} {:>13}  {}", figures(peak.time), self.holder(peak))?;
        }
        let mut shocks = Shocks { show: speed, out };
        shocks.head()?;
        let net = self.shocks.net().abs();
        shocks.row("of the net change, W h0/v0 -> 0", net, Some(self.shocks.soft_limit(self.damping())))?;
        shocks.row("the largest, W h0/v0 -> infinity", self.shocks.largest(), self.stiff())?;
        if let Some([flat, standard]) = self.at_once() {
            shocks.row("without clatter, (1 + e) v0", flat, Some(self.impulse(flat)))?;
            shocks.row("as standards assume, 2 v0", standard, Some(self.impulse(standard)))?;
        }
        if let (Some(ratio), Some(gain)) = (self.ratio(), self.gain()) {
            let (ratio, gain) = (figures(ratio), figures(gain));
            writeln!(out, "\nW h0/v0 = {ratio}; acceleration over that of the standards' shock: {gain}")?;
        }
        if self.omitted > 0.0 {
            let omitted = speed.said(self.omitted);
            writeln!(out, "The impacts never end; what was left out changes W z by {omitted} at most")?;
        }
        self.equivalent.as_ref().map_or(Ok(()), |equivalent| equivalent_table(equivalent, out))
    }

    /// Number of the impact, shock or pulse that an extreme follows.
    fn number(&self, extreme: Extreme) -> usize {
        if self.is_pulses() {
            return self.shocks.as_slice().partition_point(|shock| shock.time <= extreme.time).max(1);
        }
        (extreme.interval + 1).min(self.shocks.single().len())
    }

    /// The same in words.
    fn holder(&self, peak: Extreme) -> String {
        if peak.value.abs() <= 0.0 {
            return "no impact is felt here".to_owned();
        }
        let what = match &self.driven {
            Driven::Bar { .. } => "impact",
            Driven::Shocks(_) => "shock",
            Driven::Pulses(_) => "the start of pulse",
        };
        let number = self.number(peak);
        let last = if number == self.shocks.as_slice().len() { ", the last" } else { "" };
        format!("after {what} {number}{last}")
    }

    pub(super) fn answer(&self) -> Answer<'_> {
        let shocks = &self.shocks;
        let at_once = self.at_once();
        Answer {
            driven: DrivenJson::new(&self.driven),
            at: self.position.map(Json),
            response: ResponseJson::new(&self.suspension, &self.response, |extreme| Some(self.number(extreme))),
            shocks: ShocksJson {
                count: shocks.single().len(),
                net: Json(shocks.net()),
                largest: Json(shocks.largest()),
                omitted: Json(self.omitted),
            },
            soft: shocks.soft_limit(self.damping()).into(),
            stiff: self.stiff().map(Into::into),
            clatter_free: at_once.map(|[flat, _]| self.impulse(flat).into()),
            standard: at_once.map(|[_, standard]| self.impulse(standard).into()),
            gain: self.gain().map(Json),
            equivalent: self.equivalent.as_ref().map(Into::into),
        }
    }
}

#[derive(Serialize)]
pub(super) struct Answer<'a> {
    #[serde(flatten)]
    driven: DrivenJson<'a>,
    #[serde(skip_serializing_if = "Option::is_none")]
    at: Option<Json>,
    #[serde(flatten)]
    response: ResponseJson,
    shocks: ShocksJson,
    soft: FactorsJson,
    /// Null without damping, and for pulses.
    stiff: Option<FactorsJson>,
    /// These three of clatters alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    clatter_free: Option<FactorsJson>,
    #[serde(skip_serializing_if = "Option::is_none")]
    standard: Option<FactorsJson>,
    #[serde(skip_serializing_if = "Option::is_none")]
    gain: Option<Json>,
    #[serde(flatten)]
    equivalent: Option<EquivalentJson>,
}

/// What shakes the component.
#[derive(Serialize)]
#[serde(untagged)]
enum DrivenJson<'a> {
    Bar { q: Json, gyration_ratio: Json, e: Json, velocity: [Json; 2], height_gap: Json },
    File { file: &'a Path },
}

impl<'a> DrivenJson<'a> {
    fn new(driven: &Driven<'a>) -> Self {
        match driven {
            Driven::Bar { bar, start } => Self::Bar {
                q: Json(bar.q()),
                gyration_ratio: Json(bar.gyration_ratio()),
                e: Json(bar.e()),
                velocity: start.velocity().map(Json),
                height_gap: Json(start.height_gap()),
            },
            Driven::Shocks(file) | Driven::Pulses(file) => Self::File { file },
        }
    }
}

#[derive(Serialize)]
struct ShocksJson {
    count: usize,
    net: Json,
    largest: Json,
    omitted: Json,
}
