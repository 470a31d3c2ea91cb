//! A part on a plate in one drop, with contacts that take time.

use std::io::{self, Write};

use clatter::Corner;
use clatter_answer::Error;
use clatter_answer::respond::plate::{self, Answer, Question};
use clatter_answer::respond::{AtPlace, Factors, Largest};
use clatter_assess::Model;
use clatter_assess::units::Quantity;

use super::Args;
use super::limits;
use super::peaks::{Shocks, doubts, equivalent_table};
use crate::drop_args::{BesidePlate, PlateSetup};
use crate::inputs::Format;
use crate::numbers::given;
use crate::one_drop::OneDrop;
use crate::quantities::{Show, neat};
use crate::simulate::turning;
use crate::{Failure, Streams};

/// A part on a plate.
struct Drop<'a> {
    args: &'a Args,
    setup: PlateSetup,
    question: Question,
    answer: Answer,
}

impl Args {
    pub(super) fn run_plate(&self, file: Option<OneDrop>, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let drop = self.plate(file)?;
        match self.format {
            Format::Table => drop.table(streams.out).map_err(Failure::Answer),
            Format::Json => streams.json(&drop.answer),
        }?;
        for (kind, note) in &drop.setup.notes {
            streams.note(kind, note);
        }
        self.warn(std::iter::empty(), streams);
        Ok(())
    }

    fn plate(&self, file: Option<OneDrop>) -> Result<Drop<'_>, Failure> {
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
        let (gyration, flag, feet) = (self.inertia.given(), self.inertia.flag(), self.feet(file.as_ref()));
        let own_contacts = self.own_contacts(file.as_ref(), true)?;
        let spin_rad_s = self.spin_rad_s;
        let beside = BesidePlate { model: self.model, e: self.e, gyration, gyration_flag: flag, spin_rad_s, file };
        let setup = self.drop.plate_setup(beside)?;
        // That there is a contact time was checked before.
        let Some(contact) = setup.contact else {
            return Err(Failure::Usage("--model=compliant needs a --contact-time"));
        };
        let part = setup.part.as_ref();
        let (halves, beyond_m) = (setup.halves_m(), feet.map_or([0.0; 2], |feet| feet.inset_m));
        let on_side = |place: &[f64; 2], side: usize| {
            let most = 1.0 + beyond_m[side] / halves[side];
            (place[side] / halves[side]).clamp(-most, most)
        };
        let places: Vec<[f64; 2]> = match (self.at, part) {
            (Some(at), _) => setup.places(&[at], beyond_m)?,
            (None, Some(part)) => part.places_m.iter().map(|place| [0, 1].map(|side| on_side(place, side))).collect(),
            (None, None) => {
                return Err(Failure::Usage("the place is missing: --at=X,Y, or with --product the --component=NAME"));
            }
        };
        let mut question = Question::new(setup.scene, contact, places[0]);
        question.at = places;
        question.feet = feet;
        question.own_contacts = own_contacts.mirrored(setup.mirrored);
        question.mirrored = setup.mirrored;
        question.suspension = self.suspension(part.and_then(|part| part.suspension))?;
        question.limits = part.map(|part| part.allowed.clone());
        question.tolerance = self.tolerance;
        question.shock_table = self.equivalent_pulse.then_some(self.shock_table);
        let ([cx, cy], signs) = (setup.center_of_mass, setup.signs());
        question.center_of_mass = [signs[0] * cx, signs[1] * cy];
        question.tilt_deg = setup.tilt_deg;
        question.direction_deg = setup.direction_deg;
        let answer = plate::answer(&question).map_err(|error| match error {
            Error::Flight(error) => self.drop.named_plate(error, flag),
            error => self.of_omega(error),
        })?;
        Ok(Drop { args: self, setup, question, answer })
    }
}

impl Drop<'_> {
    fn headings(&self, out: &mut dyn Write) -> io::Result<()> {
        let shown = &self.setup.shown;
        let Answer { length_m, width_m, e, at, gaps_m, speed_m_s, contact_time_s, contact_law, .. } = &self.answer;
        let [length, width] = [length_m, width_m].map(|side| shown.length.given(neat(side.0)));
        let halves = self.setup.halves_m();
        let place = |side: usize| match &self.setup.part {
            // Of a product file as it has places.
            Some(part) if self.args.at.is_none() => {
                let show = Show { unit: part.place[side].unit().or(shown.length.unit), name: "m" };
                show.given(self.args.shortly(neat(at[side].0 * halves[side])))
            }
            _ => given(at[side].0),
        };
        let (e, at) = (given(self.args.shortly(e.0)), format!("{},{}", place(0), place(1)));
        let plate = format!("{at} of a plate of {length} by {width}, e = {e}");
        match &self.question.suspension {
            Some(part) => {
                let of_file = self.setup.part.as_ref().and_then(|part| part.suspension).map(|(frequency, _)| frequency);
                let of_file = of_file.filter(|_| self.args.omega.is_none());
                let frequency = match self.args.frequency.or(of_file) {
                    Some(Quantity { si, unit }) => Show { unit, name: "Hz" }.given(si),
                    None => format!("W = {} rad/s", given(part.omega())),
                };
                let zeta = given(super::six(part.damping().get()));
                writeln!(out, "Component at {plate}; {frequency}, damping ratio {zeta}")?;
            }
            None => writeln!(out, "Place {plate}; a part there is mounted rigidly")?,
        }
        let ([hx, hy], speed) = (gaps_m.map(|gap| shown.length.said(gap.0)), shown.speed.said(speed_m_s.0));
        let tolerance = given(100.0 * self.args.tolerance);
        let spin = turning(self.question.scene.spin_rad_s(), shown.spin, |spin| self.args.shortly(spin));
        let [first, along, opposite, across] = self.setup.corners().map(Corner::letter);
        writeln!(
            out,
            "To {tolerance} %: corner {first} touches at {speed}{spin}; {along} is {hx} higher, {across} {hy}, {opposite} both together"
        )?;
        let own = super::own_contacts(&self.answer.contacts, shown.time);
        writeln!(out, "Contacts of {}, {contact_law}{own}", shown.time.given(contact_time_s.0))
    }

    fn table(&self, out: &mut dyn Write) -> io::Result<()> {
        self.headings(out)?;
        let (shown, of) = (&self.setup.shown, &self.answer.place.answers);
        if let (Some(part), Some(limits)) = (&self.setup.part, &self.answer.place.limits) {
            limits::table(part, limits, shown.time, out)?;
        }
        let when = format!("when, {}", shown.time.name());
        let line = |out: &mut dyn Write, name: &str, show: Show, largest: Option<Largest>| {
            let Some(Largest { value, time_s, impact, .. }) = largest else { return Ok(()) };
            let (name, value) = (format!("{name}, {}", show.name()), show.figures(value.0));
            writeln!(out, "  {name:<33}{value:>11} {:>13}  at impact {impact}", shown.time.figures(time_s.0))
        };
        if self.answer.place.part.is_some() {
            writeln!(out, "\n{:<34}{:>12} {when:>13}", "Peak of the part", "")?;
        }
        line(out, "acceleration", shown.acceleration, of.part_acceleration)?;
        line(out, "relative displacement", Show { unit: None, name: "m" }, of.part_displacement)?;
        writeln!(out, "\n{:<34}{:>12} {when:>13}", "Largest at this position", "")?;
        line(out, "change of velocity", shown.speed, of.velocity_change)?;
        line(out, "acceleration", shown.acceleration, of.acceleration)?;
        line(out, "change of angular velocity", shown.spin, of.angular_velocity_change)?;
        self.shocks(out)?;
        doubts(self.args.tolerance, of, out)?;
        equivalent_table(self.answer.place.equivalent.as_ref(), out)
    }

    /// Single shocks at the position beside the answer.
    fn shocks(&self, out: &mut dyn Write) -> io::Result<()> {
        let Answer { e, speed_m_s, place, .. } = &self.answer;
        let AtPlace { velocity_change_m_s, clatter_free, standard, .. } = place;
        let speed = self.setup.shown.speed;
        let Some(part) = &self.question.suspension else {
            let flat = speed.said((1.0 + e.0) * speed_m_s.0);
            return writeln!(out, "\nWithout clatter, (1 + e) v0 everywhere at once: {flat}");
        };
        let mut shocks = Shocks { show: speed, out };
        shocks.head()?;
        let largest = Factors::new(part.damping(), velocity_change_m_s.0);
        shocks.row("the largest of this drop", largest.shock, Some(&largest))?;
        shocks.at_once(clatter_free.as_ref(), standard.as_ref())
    }
}
