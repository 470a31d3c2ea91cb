//! This module shows a part in one drop of any body, answered by the engine that answers an assessment.

use std::io::{self, Write};
use std::path::Path;

use clatter_answer::respond::drop::{self, Answer, Question};
use clatter_answer::respond::{AtPlace, Factors, Largest, Peaks};
use clatter_answer::{Error, Json};
use clatter_assess::Case;
use clatter_product::{
    Drop as Falls, LimitKind, Model, OwnContacts, Place, Unit,
    units::{Quantity, TIME},
};
use clatter_shock::Suspension;

use super::peaks::{Shocks, at_stop, doubts, equivalent_table};
use super::{Args, limits, six};
use crate::drop_args::{ExtraArgs, Setup};
use crate::inputs::Format;
use crate::numbers::{figures, given};
use crate::one_drop::{OneDrop, PartSetup};
use crate::quantities::{Show, Shown, neat};
use crate::text::path as shown_path;
use crate::words::in_words;
use crate::{Failure, Streams, assess};

/// A part in one drop.
struct Drop<'a> {
    args: &'a Args,
    shown: Shown,
    /// The part of a product file.
    part: Option<PartSetup>,
    /// True where the drop was found by a search, so that its inputs have all of their digits.
    is_found: bool,
    suspension: Option<Suspension>,
    answer: Answer,
}

impl Args {
    /// Answers one drop that was written as data.
    pub(super) fn run_case(&self, path: &Path, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let case: Case = serde_json::from_str(&assess::text(path)?)
            .map_err(|error| Failure::Wrong(format!("{}: {error}", shown_path(path))))?;
        let question = Question::of(&case)?;
        let answer = drop::answer(&question)?;
        let show = |unit: Unit| Show { unit: Some(unit.customary()), name: "" };
        let shown = Shown {
            length: show(Unit::Meter),
            speed: show(Unit::MeterPerSecond),
            time: Show { unit: TIME.unit("ms"), name: "s" },
            acceleration: show(Unit::MeterPerSecondSquared),
            spin: show(Unit::RadianPerSecond),
            angle: None,
        };
        Drop { args: self, shown, part: None, is_found: true, suspension: question.suspension, answer }.write(streams)
    }

    pub(super) fn run_drop(&self, file: Option<OneDrop>, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let is_found = file.as_ref().is_some_and(|file| file.worst().is_some());
        let setup = self.drop.setup(ExtraArgs {
            model: self.model,
            e: self.e,
            gyration: self.inertia.given(),
            masses: &self.inertia.mass,
            is_flat: self.flat,
            instant_contacts: true,
            spin_rad_s: self.spin_rad_s,
            first: self.first.map(Into::into),
            file,
        })?;
        let mut fall = setup.drop;
        fall.body.feet = self.feet(&fall)?;
        fall.own_contacts = self.own_contacts(&fall)?;
        let places = self.places(&fall, &setup)?;
        let mut question = Question::new(fall, setup.model, places[0]);
        question.places = places;
        question.suspension = {
            let part = setup.part.as_ref();
            self.suspension(part.and_then(|part| part.suspension), part.and_then(|part| part.stop))?
        };
        question.limits = setup.part.as_ref().map(|part| part.allowed.clone());
        question.tolerance = self.tolerance;
        question.shock_table = self.equivalent_pulse.then_some(self.shock_table);
        let answer = drop::answer(&question).map_err(|error| match error {
            Error::Quantity { .. } => self.of_omega(error),
            error => self.drop.failure(error, self.inertia.given()),
        })?;
        let Setup { shown, part, notes, .. } = setup;
        Drop { args: self, shown, part, is_found, suspension: question.suspension, answer }.write(streams)?;
        for (kind, note) in &notes {
            streams.note(kind, note);
        }
        self.warn(std::iter::empty(), streams);
        Ok(())
    }

    /// Returns the given feet that the product lands on, or its own.
    fn feet(&self, fall: &Falls) -> Result<Option<clatter_product::Feet>, Failure> {
        let Some([x, y, height_m]) = self.feet_m else { return Ok(fall.body.feet) };
        if fall.is_solid() {
            return Err(Failure::Usage("--feet-m are those of a bar or a plate: a box lands on any of its sides"));
        }
        if y != 0.0 && !fall.body.is_wide() {
            return Err(Failure::Usage("--feet-m=X,Y,HEIGHT of a bar has Y = 0: it goes on along its length alone"));
        }
        Ok(Some(clatter_product::Feet { inset_m: [x, y], height_m }))
    }

    /// Returns the given contacts of their own, or those of the product.
    fn own_contacts(&self, fall: &Falls) -> Result<OwnContacts, Failure> {
        let mut own = fall.own_contacts;
        for (k, (at, contact)) in self.contact.iter().enumerate() {
            if *at >= fall.body.points() {
                return Err(Failure::Usage("--contact of a bar is at a or b"));
            }
            if self.contact[..k].iter().any(|(other, _)| other == at) {
                return Err(Failure::Usage("--contact is given once for each end or corner"));
            }
            own.0[*at] = *contact;
        }
        Ok(own)
    }

    /// Returns the places where the part may be.
    fn places(&self, fall: &Falls, setup: &Setup) -> Result<Vec<Place>, Failure> {
        if !fall.is_solid() && (self.at_m.is_some() || self.axis.is_some()) {
            return Err(Failure::Usage("--at-m and --axis are of a box, which has --width and --thickness"));
        }
        let axis = self.axis.unwrap_or_default();
        let beyond_m = fall.body.feet.map_or([0.0; 2], |feet| feet.inset_m);
        match (self.at_m, self.at, &setup.part) {
            (Some(at_m), ..) => Ok(vec![Place { at_m, axis }]),
            (None, Some(at), _) => Ok(vec![Place { at_m: setup.place_m(at, beyond_m)?, axis }]),
            (None, None, Some(part)) => Ok(part.places.clone()),
            (None, None, None) => Err(Failure::Usage(
                "the place is missing: --at=S, or with --product the --component=NAME; of a plate --at=X,Y, of a box --at=X,Y,Z",
            )),
        }
    }
}

impl Drop<'_> {
    fn write(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        match self.args.format {
            Format::Table => self.table(streams.out).map_err(Failure::Answer),
            Format::Json => streams.json(&self.answer),
        }
    }

    /// Returns an input as it was typed, or to six digits where a search found it.
    fn input(&self, x: f64) -> f64 {
        if self.is_found { six(x) } else { neat(x) }
    }

    /// Returns the number of sides of the body along which a place is shown.
    fn axes(&self) -> usize {
        self.answer.drop.drop.sides().len()
    }

    /// Names the place.
    fn called(&self) -> String {
        let place = &self.answer.drop.place;
        if let (Some(at), false) = (self.args.at, self.is_found) {
            return at.values().into_iter().map(crate::quantities::Place::said).collect::<Vec<_>>().join(", ");
        }
        let units = self.part.as_ref().map_or([None; 2], |part| part.units);
        let show = |axis: usize| {
            let unit = units.get(axis).copied().flatten().or(self.shown.length.unit);
            Show { unit, name: "m" }.given(self.input(place.at_m[axis]))
        };
        (0..self.axes()).map(show).collect::<Vec<_>>().join(", ")
    }

    fn headings(&self, out: &mut dyn Write) -> io::Result<()> {
        let (shown, Case { drop, model, tolerance, place, .. }) = (&self.shown, &self.answer.drop);
        let sides: Vec<_> = drop.sides().iter().map(|side| shown.length.given(self.input(side.m()))).collect();
        let (at, sides, e) = (self.called(), sides.join(" by "), given(self.input(drop.restitution)));
        let axis = if drop.is_solid() { format!(" along {}", place.axis.name()) } else { String::new() };
        let axis = axis.replace(" along any", " in magnitude");
        match &self.answer.place.part {
            Some(Peaks { omega, damping, .. }) => {
                let zeta = given(six(damping.0));
                let of_file = self.part.as_ref().and_then(|part| part.suspension).map(|(frequency, _)| frequency);
                let of_file = of_file.filter(|_| self.args.omega.is_none());
                let frequency = match self.args.frequency.or(of_file) {
                    Some(Quantity { si, unit }) => Show { unit, name: "Hz" }.given(self.input(si)),
                    None => format!("W = {} rad/s", given(self.input(omega.0))),
                };
                let stop = self.suspension.and_then(|part| part.stop()).map_or(String::new(), |stop| {
                    let (gap, time) = (self.input(stop.gap()), self.input(stop.contact_time()));
                    let (gap, time) = (shown.length.given(gap), shown.time.given(time));
                    format!("; stops at {gap} with contacts of {time}, e = {}", given(self.input(stop.restitution())))
                });
                writeln!(
                    out,
                    "Component at {at}{axis} of a body of {sides}, e = {e}; {frequency}, damping ratio {zeta}{stop}"
                )?;
            }
            None => writeln!(out, "Place {at}{axis} of a body of {sides}, e = {e}; a part there is mounted rigidly")?,
        }
        let (point, lowest, speed) = (drop.point(), drop.lowest(), shown.speed.said(drop.speed_m_s));
        let lands = format!(
            "Model {}, to {} %: {point} {lowest} strikes first, at {speed}",
            model.name(),
            given(100.0 * tolerance)
        );
        let optional = shown.optional(drop, |si| self.input(si));
        let tilt = shown.tilt(self.input(drop.tilt_rad.to_degrees()));
        if drop.is_solid() {
            let [x, y, z] = drop.up().map(|up| figures(libm::acos(up.clamp(-1.0, 1.0)).to_degrees()));
            writeln!(out, "{lands}{optional}; the vertical is {x}, {y} and {z} degrees from its axes")?;
        } else if drop.body.is_wide() && drop.tilt_rad > 0.0 {
            let (towards, [along, across]) = (drop.direction_rad.to_degrees().rem_euclid(360.0), drop.gaps_m());
            let (towards, [along, across]) =
                (given(self.input(towards)), [along, across].map(|gap| shown.length.said(gap)));
            writeln!(
                out,
                "{lands}, tilt {tilt} towards {towards} degrees{optional}; its neighbors are {along} and {across} higher"
            )?;
        } else {
            writeln!(out, "{lands}, tilt {tilt}{optional}")?;
        }
        let Some(time_s) = drop.contact_time_s.filter(|_| *model == Model::Compliant) else { return Ok(()) };
        let time = |time_s: f64| shown.time.given(self.input(time_s));
        let own = drop.own_contacts.told(drop.restitution, drop.contact_time_s).map(|(at, e, time_s)| {
            let lasts = time_s.map_or(String::new(), |time_s| format!(" and {}", time(time_s)));
            format!("; at {at} e = {}{lasts}", given(self.input(e)))
        });
        let friction =
            if drop.is_solid() { format!(", friction {}", given(self.input(drop.friction))) } else { String::new() };
        let law = drop.contact_law.name();
        writeln!(out, "Contacts of {}, {law}{}{friction}", time(time_s), own.collect::<String>())
    }

    fn table(&self, out: &mut dyn Write) -> io::Result<()> {
        self.headings(out)?;
        if let (Some(part), Some(limits)) = (&self.part, &self.answer.place.limits) {
            limits::table(part, limits, self.axes(), self.shown.time, out)?;
        }
        if let Some(part) = &self.answer.place.part {
            self.peaks(part, out)?;
            at_stop(self.answer.place.at_stop.as_ref(), self.shown.speed, self.shown.time, out)?;
        }
        self.place(out)?;
        self.shocks(out)?;
        doubts(self.answer.drop.tolerance, &self.answer.place.answers, out)?;
        equivalent_table(self.answer.place.equivalent.as_ref(), out)
    }

    /// Writes the peaks of the part.
    fn peaks(&self, part: &Peaks, out: &mut dyn Write) -> io::Result<()> {
        let (peaks, time, speed) = (&part.peaks, self.shown.time, self.shown.speed);
        let [acceleration, displacement] =
            [self.answer.place.answers.part_acceleration, self.answer.place.answers.part_displacement];
        let when = format!("when, {}", time.name());
        writeln!(out, "\n{:<34}{:>12} {when:>13}", "Peak of the part", "")?;
        let mut line = |name: &str, size: String, at: Json, largest: Option<Largest>| {
            let after = largest.map_or(String::new(), |largest| format!("  after impact {}", largest.impact));
            writeln!(out, "  {name:<32}{size:>12} {:>13}{after}", time.figures(at.0))
        };
        // The values are shown as in an assessment.
        let limits = self.part.as_ref().map(|part| part.limits);
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

    /// Writes the largest values at the place.
    fn place(&self, out: &mut dyn Write) -> io::Result<()> {
        let (of, shown, Case { drop, model, .. }) = (&self.answer.place.answers, &self.shown, &self.answer.drop);
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
        if let Some(time_s) = drop.contact_time_s {
            let half_sine = format!(", taken for a half-sine of {}", shown.time.given(self.input(time_s)));
            let note = if *model == Model::Compliant { "" } else { &half_sine };
            line("acceleration", shown.acceleration, of.acceleration, note)?;
        }
        line("change of angular velocity", shown.spin, of.angular_velocity_change, "")
    }

    /// Writes single shocks at the position next to the answer.
    fn shocks(&self, out: &mut dyn Write) -> io::Result<()> {
        let (speed, Case { drop, .. }) = (self.shown.speed, &self.answer.drop);
        let AtPlace { velocity_change_m_s, clatter_free, standard, gain, .. } = &self.answer.place;
        let (Some(part), Some(gain)) = (&self.suspension, gain) else {
            let flat = speed.said((1.0 + drop.restitution) * drop.speed_m_s);
            return writeln!(out, "\nWithout clatter, (1 + e) v0 everywhere at once: {flat}");
        };
        let mut shocks = Shocks { show: speed, out };
        shocks.head()?;
        let largest = Factors::new(part.damping(), velocity_change_m_s.0);
        shocks.row("the largest of this drop", largest.shock, Some(&largest))?;
        shocks.at_once(clatter_free.as_ref(), standard.as_ref())?;
        let ratio = figures(part.omega() * drop.gap_m() / drop.speed_m_s);
        writeln!(out, "\nW h0/v0 = {ratio}; acceleration over that of the standards' shock: {}", figures(gain.0))
    }
}
