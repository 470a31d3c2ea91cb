//! A part on a plate in one drop, with contacts that take time.

use std::io::{self, Write};

use clatter_assess::{Answer, Model, PlateAnswers, PlateDrop, PlatePart};
use clatter_flight::Contact;
use clatter_shock::Suspension;
use serde::Serialize;

use super::Args;
use super::drop::AnswersJson;
use super::peaks::{
    Equivalent, EquivalentJson, FactorsJson, ResponseJson, Shocks, at_once, equivalent, equivalent_table,
};
use crate::drop_args::PlateSetup;
use crate::inputs::Format;
use crate::numbers::{Json, figures, given};
use crate::quantities::{Show, neat};
use crate::{Failure, Streams};

/// A part on a plate.
struct Drop<'a> {
    args: &'a Args,
    setup: PlateSetup,
    contact: Contact,
    /// In half-sides.
    at: [f64; 2],
    suspension: Option<Suspension>,
    answers: PlateAnswers,
    equivalent: Option<Equivalent>,
}

/// What is left open is told where it could raise an answer by more than so many tolerances.
const TOLD: f64 = 10.0;

impl Args {
    pub(super) fn run_plate(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let drop = self.plate()?;
        match self.format {
            Format::Table => drop.table(streams.out).map_err(Failure::Answer),
            Format::Json => streams.json(&drop.answer()),
        }?;
        for (kind, note) in &drop.setup.notes {
            streams.note(kind, note);
        }
        self.warn(std::iter::empty(), streams);
        Ok(())
    }

    fn plate(&self) -> Result<Drop<'_>, Failure> {
        if !self.inertia.mass.is_empty() {
            return Err(Failure::Usage(
                "--mass is that of a bar: a plate takes --gyration=KX,KY and --center-of-mass=SX,SY",
            ));
        }
        if self.flat || self.first.is_some() {
            return Err(Failure::Usage(
                "--flat and --first are those of a bar: a plate lands flat with --tilt=0deg, corner a first",
            ));
        }
        if matches!(self.model, Some(model) if model != Model::Compliant) {
            return Err(Failure::Usage("a part on a plate is answered by --model=compliant alone"));
        }
        let flag = self.inertia.flag();
        let setup = self.drop.plate_setup(self.model, self.e, self.inertia.given(), flag)?;
        // That there is a contact time was checked before.
        let Some(contact) = setup.contact else {
            return Err(Failure::Usage("--model=compliant needs a --contact-time"));
        };
        let Some(at) = self.at else { return Err(Failure::Usage("the place is missing: --at=X,Y")) };
        let at = setup.places(&[at])?[0];
        let suspension = self.suspension(None)?;
        let drop = PlateDrop { scene: setup.scene, contact };
        let place = setup.scene.plate().place(at);
        let answers = drop.answers(place, suspension.as_ref(), self.tolerance).map_err(|error| match error {
            clatter_assess::Error::Flight(error) => self.drop.named_plate(error, flag),
            error => Failure::Assess(error),
        })?;
        let asked = suspension.as_ref().zip(answers.part.as_ref()).filter(|_| self.equivalent_pulse);
        let equivalent =
            asked.map(|(part, answer)| equivalent(&self.shock_table, part, &answer.response)).transpose()?;
        Ok(Drop { args: self, setup, contact, at, suspension, answers, equivalent })
    }
}

impl Drop<'_> {
    fn at_once(&self) -> [f64; 2] {
        at_once(self.setup.e, self.setup.scene.speed_m_s())
    }

    fn headings(&self, out: &mut dyn Write) -> io::Result<()> {
        let (scene, shown, e) = (&self.setup.scene, &self.setup.shown, given(self.setup.e));
        let [length, width] = scene.plate().sides_m().map(|side| shown.length.given(neat(side)));
        let at = self.at.map(given).join(",");
        match (&self.suspension, self.args.frequency) {
            (Some(part), frequency) => {
                let frequency = frequency.map_or_else(
                    || format!("W = {} rad/s", given(part.omega())),
                    |frequency| Show { unit: frequency.unit, name: "Hz" }.given(frequency.si),
                );
                let zeta = given(neat(part.damping().get()));
                writeln!(
                    out,
                    "Component at {at} of a plate of {length} by {width}, e = {e}; {frequency}, damping ratio {zeta}"
                )?;
            }
            (None, _) => {
                writeln!(
                    out,
                    "Place {at} of a plate of {length} by {width}, e = {e}; a part there is mounted rigidly"
                )?;
            }
        }
        let ([hx, hy], speed) = (scene.gaps_m().map(|gap| shown.length.said(gap)), shown.speed.said(scene.speed_m_s()));
        let tolerance = given(100.0 * self.args.tolerance);
        writeln!(out, "To {tolerance} %: corner a touches at {speed}; b is {hx} higher, d {hy}, c both together")?;
        writeln!(out, "Contacts of {}, {}", shown.time.given(self.contact.time_s()), self.contact.law().name())
    }

    fn table(&self, out: &mut dyn Write) -> io::Result<()> {
        self.headings(out)?;
        let shown = &self.setup.shown;
        let when = format!("when, {}", shown.time.name());
        let line = |out: &mut dyn Write, name: &str, show: Show, answer: &Answer| {
            let (name, value) = (format!("{name}, {}", show.name()), show.figures(answer.value));
            let (time, impact) = (shown.time.figures(answer.time_s), answer.impact);
            writeln!(out, "  {name:<33}{value:>11} {time:>13}  at impact {impact}")
        };
        if let Some(PlatePart { acceleration, displacement, .. }) = &self.answers.part {
            writeln!(out, "\n{:<34}{:>12} {when:>13}", "Peak of the part", "")?;
            line(out, "acceleration", shown.acceleration, acceleration)?;
            line(out, "relative displacement", Show { unit: None, name: "m" }, displacement)?;
        }
        writeln!(out, "\n{:<34}{:>12} {when:>13}", "Largest at this position", "")?;
        line(out, "change of velocity", shown.speed, &self.answers.velocity_change)?;
        line(out, "acceleration", shown.acceleration, &self.answers.acceleration)?;
        line(out, "change of angular velocity", shown.spin, &self.answers.angular_velocity_change)?;
        self.shocks(out)?;
        for (name, answer) in self.all() {
            let error = answer.error();
            if error > TOLD * self.args.tolerance {
                let share = if error.is_infinite() { "?".to_owned() } else { figures(100.0 * error) };
                writeln!(out, "Off by {share} % at most: {name}; strikes multiply what those before got wrong")?;
            }
        }
        self.equivalent.as_ref().map_or(Ok(()), |equivalent| equivalent_table(equivalent, out))
    }

    fn all(&self) -> Vec<(&'static str, &Answer)> {
        let part = self.answers.part.as_ref();
        let of_part = part.map(|part| [("W z", &part.displacement), ("A/W", &part.acceleration)]);
        let place = [
            ("the change of velocity", &self.answers.velocity_change),
            ("the change of angular velocity", &self.answers.angular_velocity_change),
        ];
        of_part.into_iter().flatten().chain(place).collect()
    }

    /// Single shocks at the position beside the answer.
    fn shocks(&self, out: &mut dyn Write) -> io::Result<()> {
        let [flat, standard] = self.at_once();
        let Some(part) = &self.suspension else {
            return writeln!(
                out,
                "\nWithout clatter, (1 + e) v0 everywhere at once: {}",
                self.setup.shown.speed.said(flat)
            );
        };
        let factors = part.damping().impulse_factors();
        let mut shocks = Shocks { show: self.setup.shown.speed, out };
        shocks.head()?;
        let largest = self.answers.velocity_change.value;
        shocks.row("the largest of this drop", largest, Some(factors.times(largest)))?;
        shocks.row("without clatter, (1 + e) v0", flat, Some(factors.times(flat)))?;
        shocks.row("as standards assume, 2 v0", standard, Some(factors.times(standard)))
    }

    fn answer(&self) -> PlateJson {
        let (setup, scene) = (&self.setup, &self.setup.scene);
        let [length, width] = scene.plate().sides_m();
        let (part, PlateAnswers { velocity_change, acceleration, angular_velocity_change, .. }) =
            (self.answers.part.as_ref(), &self.answers);
        let standard = |i: usize| {
            let shock = self.at_once()[i];
            self.suspension.map(|part| part.damping().impulse_factors().times(shock))
        };
        let of_part = |of: fn(&PlatePart) -> Answer| part.map(of);
        PlateJson {
            model: setup.model.name(),
            length_m: Json(length),
            width_m: Json(width),
            gyration_m: scene.plate().gyration_m().map(Json),
            center_of_mass: setup.center_of_mass.map(Json),
            e: Json(setup.e),
            speed_m_s: Json(scene.speed_m_s()),
            tilt_deg: Json(setup.tilt_deg),
            direction_deg: setup.direction_deg.map(Json),
            gaps_m: scene.gaps_m().map(Json),
            gravity_m_s2: Json(scene.gravity_m_s2()),
            contact_time_s: Json(self.contact.time_s()),
            contact_law: self.contact.law().name(),
            tolerance: Json(self.args.tolerance),
            at: self.at.map(Json),
            response: self.suspension.zip(part).map(|(of, part)| ResponseJson::new(&of, &part.response, |_| None)),
            velocity_change_m_s: Json(velocity_change.value),
            acceleration_m_s2: Json(acceleration.value),
            angular_velocity_change_rad_s: Json(angular_velocity_change.value),
            answers: AnswersJson::new(
                [Some(*velocity_change), Some(*acceleration), Some(*angular_velocity_change)],
                [of_part(|part| part.acceleration), of_part(|part| part.displacement)],
            ),
            clatter_free: standard(0).map(Into::into),
            standard: standard(1).map(Into::into),
            equivalent: self.equivalent.as_ref().map(Into::into),
        }
    }
}

#[derive(Serialize)]
struct PlateJson {
    model: &'static str,
    length_m: Json,
    width_m: Json,
    gyration_m: [Json; 2],
    center_of_mass: [Json; 2],
    e: Json,
    speed_m_s: Json,
    tilt_deg: Json,
    /// Null of a plate that falls level.
    direction_deg: Option<Json>,
    gaps_m: [Json; 2],
    gravity_m_s2: Json,
    contact_time_s: Json,
    contact_law: &'static str,
    tolerance: Json,
    at: [Json; 2],
    #[serde(flatten)]
    response: Option<ResponseJson>,
    velocity_change_m_s: Json,
    acceleration_m_s2: Json,
    /// About the axis along the length or along the width, whichever is more.
    angular_velocity_change_rad_s: Json,
    answers: AnswersJson,
    #[serde(skip_serializing_if = "Option::is_none")]
    clatter_free: Option<FactorsJson>,
    #[serde(skip_serializing_if = "Option::is_none")]
    standard: Option<FactorsJson>,
    #[serde(flatten)]
    equivalent: Option<EquivalentJson>,
}
