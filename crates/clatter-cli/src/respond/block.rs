//! A part of a box in one drop.

use std::io::{self, Write};

use clatter_answer::respond::block::{self, Answer, Question};
use clatter_assess::WorstCase;
use clatter_flight::Contact;
use clatter_shock::Suspension;

use super::peaks::{largest_values, place};
use super::{Args, limits};
use crate::block::{Axis, Setup};
use crate::drop_args::BesideBlock;
use crate::inputs::Format;
use crate::one_drop::{OneDrop, PartSetup};
use crate::quantities::Show;
use crate::{Failure, Streams};

impl Args {
    /// Where the part is, from the middle.
    fn at_of_block(&self, size_m: [f64; 3]) -> Result<[f64; 3], Failure> {
        if let Some(at_m) = self.at_m {
            return Ok(at_m);
        }
        let Some(at) = self.at else {
            return Err(Failure::Usage("where the part of a box is has to be given: --at=X,Y,Z from its middle"));
        };
        let mut at_m = size_m;
        for (at, place) in at_m.iter_mut().zip(at.of_block("--at")?) {
            let half = 0.5 * *at;
            *at = half * place.relative("--at", Some(half))?;
        }
        Ok(at_m)
    }

    /// The worst drop of a box of a product file.
    pub(super) fn worst_of_box(
        &self,
        mut file: OneDrop,
        worst: &WorstCase,
        streams: &mut Streams<'_>,
    ) -> Result<(), Failure> {
        if self.flat || self.equivalent_pulse {
            return Err(Failure::Usage("--flat and --equivalent-pulse do not go with a box"));
        }
        let drop = &worst.drop;
        let (Some(of_box), Some(time_s)) = (drop.of_box()?, drop.contact_time_s) else {
            return Err(Failure::Usage("a box is followed with contacts that take time"));
        };
        let setup = Setup { drop: of_box, contact: Contact::new(drop.contact_law, drop.restitution, time_s)? };
        let [x, y, z] = of_box.block().size_m();
        let part = file.part([0.5 * x, 0.5 * y])?;
        let [x, y, height_m] = worst.part.place.at_m;
        let at_m = [x, y, height_m.clamp(-0.5 * z, 0.5 * z)];
        let mut question = Question::new(setup.drop, setup.contact, at_m, worst.part.place.axis);
        question.drop = *drop;
        question.suspension = self.suspension(part.as_ref().and_then(|part| part.suspension))?;
        question.limits = part.as_ref().map(|part| part.allowed.clone());
        question.tolerance = self.tolerance;
        let answer = block::answer(&question)?;
        let of_file = part.as_ref().map(|part| (part, Show { unit: file.time_unit(), name: "s" }));
        match self.format {
            Format::Table => table(&answer, &setup, of_file, streams.out).map_err(Failure::Answer)?,
            Format::Json => streams.json(&answer)?,
        }
        for note in file.into_notes() {
            streams.note("note", note);
        }
        if let Some(warning) = setup.warning() {
            streams.note("warning", warning);
        }
        Ok(())
    }

    pub(super) fn block(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        if self.feet_m.is_some() {
            return Err(Failure::Usage("--feet-m are those of a bar or a plate: a box lands on any of its sides"));
        }
        if self.flat || self.equivalent_pulse {
            return Err(Failure::Usage("--flat and --equivalent-pulse do not go with a box"));
        }
        let gyration = self.inertia.given().map(|radii| radii.of_block(self.inertia.flag())).transpose()?;
        let setup = self.drop.block(&BesideBlock {
            model: self.model,
            e: self.e,
            gyration,
            spin_rad_s: self.spin_rad_s.map_or(Ok([0.0; 3]), |spin| spin.of_block("--spin-rad-s"))?,
            time_limit_s: None,
            impact_limit: usize::MAX,
        })?;
        let at_m = self.at_of_block(setup.drop.block().size_m())?;
        setup.within(at_m)?;
        let axis = self.axis.unwrap_or(Axis::Z);
        let damping = self.damping.ratio()?;
        let mut question = Question::new(setup.drop, setup.contact, at_m, axis.into());
        question.drop.own_contacts = self.own_contacts(None, true)?;
        question.tolerance = self.tolerance;
        question.suspension = self.omega().map(|omega| Suspension::new(omega, damping)).transpose()?;
        if axis == Axis::Any && question.suspension.is_some() {
            return Err(Failure::Usage("a part that swings does so along one axis: --axis=x, y or z, or no --omega"));
        }
        let answer = block::answer(&question)?;
        match self.format {
            Format::Table => table(&answer, &setup, None, streams.out).map_err(Failure::Answer)?,
            Format::Json => streams.json(&answer)?,
        }
        if let Some(warning) = setup.warning() {
            streams.note("warning", warning);
        }
        self.warn(std::iter::empty(), streams);
        Ok(())
    }
}

fn table(answer: &Answer, setup: &Setup, of_file: Option<(&PartSetup, Show)>, out: &mut dyn Write) -> io::Result<()> {
    setup.heading(out)?;
    let time = of_file.map_or(Show { unit: None, name: "s" }, |(_, time)| time);
    let own = super::own_contacts(&answer.contacts, time);
    if !own.is_empty() {
        writeln!(out, "Contacts of their own{}", own.replacen(';', ":", 1))?;
    }
    place(answer.at_m.map(|x| x.0), answer.axis, out)?;
    if let Some(((part, time), limits)) = of_file.zip(answer.place.limits.as_ref()) {
        limits::table(part, limits, time, out)?;
    }
    largest_values(&answer.place, answer.tolerance.0, out)
}
