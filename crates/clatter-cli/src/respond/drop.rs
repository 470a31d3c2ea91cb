//! A part in a drop in SI units, answered by the engine that answers an assessment.

use std::io::{self, Write};

use clatter::End;
use clatter_answer::respond::drop::{self, Answer, Question};
use clatter_answer::respond::{AtPlace, Factors, Largest, Peaks};
use clatter_answer::{Error, Json};
use clatter_assess::units::Quantity;
use clatter_assess::{LimitKind, Model};

use super::Args;
use super::limits;
use super::peaks::{Shocks, doubts, equivalent_table};
use crate::Failure;
use crate::drop_args::{ExtraArgs, Setup};
use crate::numbers::{figures, given};
use crate::one_drop::OneDrop;
use crate::quantities::{self, Show, neat};
use crate::words::in_words;

/// A part in one drop.
pub(super) struct Drop<'a> {
    args: &'a Args,
    setup: Setup,
    question: Question,
    answer: Answer,
    /// How the place is called.
    called: String,
}

impl Args {
    pub(super) fn drop_by(&self, file: Option<OneDrop>) -> Result<Drop<'_>, Failure> {
        let (mass, feet) = (&self.inertia.mass, self.feet(file.as_ref()));
        let own_contacts = self.own_contacts(file.as_ref(), false)?;
        if feet.is_some_and(|feet| feet.inset_m[1] != 0.0) {
            return Err(Failure::Usage("--feet-m=X,Y,HEIGHT of a bar has Y = 0: it goes on along its length alone"));
        }
        let flag = "--spin-rad-s";
        let spin = self.spin_rad_s.map(|spin| Ok::<_, Failure>((spin.of_bar(flag)?, flag))).transpose()?;
        let beside = ExtraArgs {
            spin,
            flat: self.flat,
            model: self.model,
            e: self.e,
            gyration: self.inertia.gyration()?,
            masses: mass,
            instant_contacts: true,
            first: self.first.map(Into::into),
            of_product: true,
            file,
        };
        let setup = self.drop.setup(beside)?;
        let part = setup.part.as_ref();
        let half_m = 0.5 * setup.scene.body().length_m();
        // Places of the product, from end a at -1 to end b at 1.
        let beyond_m = feet.map_or(0.0, |feet| feet.inset_m[0]);
        let most = 1.0 + beyond_m / half_m;
        let asked = self.bar_at()?;
        let places = match (asked, part) {
            (Some(place), _) => quantities::positions_beyond(&[place], "--at", half_m, beyond_m)?,
            (None, Some(part)) => part.places_m.iter().map(|[x, _]| (x / half_m).clamp(-most, most)).collect(),
            (None, None) => {
                return Err(Failure::Usage("the place is missing: --at=S, or with --product the --component=NAME"));
            }
        };
        let mut question = Question::new(setup.scene, setup.model, places[0]);
        question.at = places;
        question.first = setup.first;
        question.flat = setup.flat;
        question.contact_time_s = setup.contact_time_s;
        question.contact_law = setup.contact_law;
        question.feet = feet;
        question.own_contacts = own_contacts.mirrored([setup.first == End::B, false]);
        question.suspension = self.suspension(part.and_then(|part| part.suspension))?;
        question.limits = part.map(|part| part.allowed.clone());
        question.tolerance = self.tolerance;
        question.shock_table = self.equivalent_pulse.then_some(self.shock_table);
        question.center_of_mass = setup.center_of_mass;
        question.tilt_deg = setup.tilt_deg;
        let answer = drop::answer(&question).map_err(|error| self.named(error))?;
        let at = neat(answer.at.0 * half_m);
        let called = asked.map_or_else(|| setup.shown.length.given(at), quantities::Place::said);
        Ok(Drop { args: self, setup, question, answer, called })
    }

    /// A drop that was refused, with the options as they were given.
    fn named(&self, error: Error) -> Failure {
        match error {
            Error::Flight(error) => {
                self.inertia.gyration().map_or_else(|failure| failure, |gyration| self.drop.named(error, gyration))
            }
            error => self.of_omega(error),
        }
    }
}

impl Drop<'_> {
    pub(super) fn notes(&self) -> &[(&'static str, String)] {
        &self.setup.notes
    }

    fn headings(&self, out: &mut dyn Write) -> io::Result<()> {
        let (at, shown) = (&self.called, &self.setup.shown);
        let Answer { model, first, length_m, e, speed_m_s, contact_time_s, contact_law, .. } = &self.answer;
        let (length, e) = (shown.length.given(length_m.0), given(e.0));
        match &self.answer.place.part {
            Some(Peaks { omega, damping, .. }) => {
                let zeta = given(super::six(damping.0));
                let of_file = self.setup.part.as_ref().and_then(|part| part.suspension).map(|(frequency, _)| frequency);
                let of_file = of_file.filter(|_| self.args.omega.is_none());
                let frequency = match self.args.frequency.or(of_file) {
                    Some(Quantity { si, unit }) => Show { unit, name: "Hz" }.given(si),
                    None => format!("W = {} rad/s", given(omega.0)),
                };
                writeln!(out, "Component at {at} of a body of {length}, e = {e}; {frequency}, damping ratio {zeta}")?;
            }
            None => writeln!(out, "Place {at} of a body of {length}, e = {e}; a part there is mounted rigidly")?,
        }
        let speed = shown.speed.said(speed_m_s.0);
        let (tilt, tolerance) =
            (shown.tilt(self.args.shortly(self.setup.tilt_deg)), given(100.0 * self.args.tolerance));
        let spin = match self.setup.scene.spin_rad_s() {
            0.0 => String::new(),
            spin => format!(", turning at {}", shown.spin.given(self.args.shortly(spin))),
        };
        writeln!(out, "Model {model}, to {tolerance} %: end {first} strikes first, at {speed}, tilt {tilt}{spin}")?;
        match (contact_time_s, contact_law) {
            (Some(time), Some(law)) => writeln!(
                out,
                "Contacts of {}, {law}{}",
                shown.time.given(time.0),
                super::own_contacts(&self.answer.contacts, shown.time)
            ),
            _ => Ok(()),
        }
    }

    pub(super) fn table(&self, out: &mut dyn Write) -> io::Result<()> {
        self.headings(out)?;
        if let (Some(part), Some(limits)) = (&self.setup.part, &self.answer.place.limits) {
            limits::table(part, limits, self.setup.shown.time, out)?;
        }
        if let Some(part) = &self.answer.place.part {
            self.peaks(part, out)?;
        }
        self.place(out)?;
        self.shocks(out)?;
        doubts(self.args.tolerance, &self.answer.place.answers, out)?;
        equivalent_table(self.answer.place.equivalent.as_ref(), out)
    }

    /// The peaks of the part.
    fn peaks(&self, part: &Peaks, out: &mut dyn Write) -> io::Result<()> {
        let (peaks, time, speed) = (&part.peaks, self.setup.shown.time, self.setup.shown.speed);
        let [acceleration, displacement] =
            [self.answer.place.answers.part_acceleration, self.answer.place.answers.part_displacement];
        let when = format!("when, {}", time.name());
        writeln!(out, "\n{:<34}{:>12} {when:>13}", "Peak of the part", "")?;
        let mut line = |name: &str, size: String, at: Json, largest: Option<Largest>| {
            let after = largest.map_or(String::new(), |largest| format!("  after impact {}", largest.impact));
            writeln!(out, "  {name:<32}{size:>12} {:>13}{after}", time.figures(at.0))
        };
        // As an assessment tells it.
        let limits = self.setup.part.as_ref().map(|part| part.limits);
        for (name, kind, largest) in [
            ("acceleration", LimitKind::Acceleration, acceleration),
            ("relative displacement", LimitKind::RattleSpace, displacement),
        ] {
            let Some(Largest { value, unit, time_s, .. }) = largest else { continue };
            let written = limits.and_then(|limits| limits.unit(kind, unit));
            line(name, in_words(unit, written, value.0), time_s, largest)?;
        }
        for (name, extremes, largest) in [
            ("relative displacement, W z", peaks.omega_relative_displacement, displacement),
            ("relative velocity", peaks.relative_velocity, None),
            ("absolute acceleration, A/W", peaks.absolute_acceleration_over_omega, acceleration),
        ] {
            line(name, speed.said(extremes.peak.value.0.abs()), extremes.peak.time, largest)?;
        }
        Ok(())
    }

    /// What the place goes through.
    fn place(&self, out: &mut dyn Write) -> io::Result<()> {
        let of = &self.answer.place.answers;
        let shown = &self.setup.shown;
        let when = format!("when, {}", shown.time.name());
        writeln!(out, "\n{:<34}{:>12} {when:>13}", "Largest at this position", "")?;
        let mut line = |name: &str, show: Show, largest: Option<Largest>, note: &str| {
            let name = format!("{name}, {}", show.name());
            let Some(Largest { value, time_s, impact, .. }) = largest else {
                return writeln!(out, "  {name:<33}{:>11}", "0");
            };
            let (value, time) = (show.figures(value.0), shown.time.figures(time_s.0));
            writeln!(out, "  {name:<33}{value:>11} {time:>13}  at impact {impact}{note}")
        };
        line("change of velocity", shown.speed, of.velocity_change, "")?;
        if let Some(time) = self.answer.contact_time_s {
            let half_sine = format!(", taken for a half-sine of {}", shown.time.given(time.0));
            let note = if self.setup.model == Model::Compliant { "" } else { &half_sine };
            line("acceleration", shown.acceleration, of.acceleration, note)?;
        }
        line("change of angular velocity", shown.spin, of.angular_velocity_change, "")
    }

    /// Single shocks at the position beside the answer.
    fn shocks(&self, out: &mut dyn Write) -> io::Result<()> {
        let Answer { e, speed_m_s, height_gap_m, place, .. } = &self.answer;
        let AtPlace { velocity_change_m_s, clatter_free, standard, .. } = place;
        let speed = self.setup.shown.speed;
        let Some((part, gain)) = self.question.suspension.zip(self.answer.place.gain) else {
            let flat = speed.said((1.0 + e.0) * speed_m_s.0);
            return writeln!(out, "\nWithout clatter, (1 + e) v0 everywhere at once: {flat}");
        };
        let mut shocks = Shocks { show: speed, out };
        shocks.head()?;
        let largest = Factors::new(part.damping(), velocity_change_m_s.0);
        shocks.row("the largest of this drop", largest.shock, Some(&largest))?;
        shocks.at_once(clatter_free.as_ref(), standard.as_ref())?;
        let ratio = figures(part.omega() * height_gap_m.0 / speed_m_s.0);
        writeln!(out, "\nW h0/v0 = {ratio}; acceleration over that of the standards' shock: {}", figures(gain.0))
    }

    pub(super) fn answer(&self) -> &Answer {
        &self.answer
    }
}
