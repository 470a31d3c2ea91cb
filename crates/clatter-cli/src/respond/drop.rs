//! A part in a drop in SI units, answered by the engine that answers an assessment.

use std::io::{self, Write};

use clatter::End;
use clatter_assess::units::Quantity;
use clatter_assess::{Accuracy, Answer, Limit, LimitKind, Model, Part, SingleDrop, answer, respond};
use clatter_shock::{ImpulseFactors, Response, Suspension};
use serde::Serialize;

use super::Args;
use super::limits::{self, LimitJson, OfLimit};
use super::peaks::{
    Equivalent, EquivalentJson, FactorsJson, ResponseJson, Shocks, at_once, equivalent, equivalent_table,
};
use crate::drop_args::{Beside, Setup};
use crate::inputs::letter;
use crate::numbers::{Json, figures, given};
use crate::quantities::{self, Show, neat};
use crate::words::in_words;
use crate::{Failure, Streams};

/// A part in one drop.
pub(super) struct Drop<'a> {
    args: &'a Args,
    setup: Setup,
    /// Position s, and how it is called.
    at: f64,
    called: String,
    single: SingleDrop,
    /// What is asked of each limit of a part of a product file.
    limits: Vec<OfLimit>,
    /// What the place goes through.
    place: Place,
    /// The part; none that is mounted rigidly.
    part: Option<Suspended>,
}

/// The largest values at a place; none of what is not felt there.
struct Place {
    velocity_change: Option<Answer>,
    /// Asked where a contact time is given.
    acceleration: Option<Answer>,
    angular_velocity_change: Option<Answer>,
}

/// A part on its suspension.
struct Suspended {
    suspension: Suspension,
    response: Response,
    acceleration: Option<Answer>,
    displacement: Option<Answer>,
    equivalent: Option<Equivalent>,
}

/// Later strikes are told of where they could raise an answer by more than so many tolerances.
const TOLD: f64 = 10.0;

impl Args {
    pub(super) fn drop_by(&self, streams: &mut Streams<'_>) -> Result<Drop<'_>, Failure> {
        let mass = &self.inertia.mass;
        let beside = Beside {
            flat: self.flat,
            model: self.model,
            e: self.e,
            gyration: self.inertia.gyration()?,
            masses: mass,
            instant_contacts: true,
            first: self.first.map(Into::into),
            of_product: true,
            worst: self
                .worst
                .map(|of| (of, Accuracy { tolerance: self.tolerance, model: self.model, ..Accuracy::default() })),
            files: self.files(),
        };
        let setup = self.drop.setup(&beside, streams)?;
        let (scene, model, body) = (&setup.scene, setup.model, setup.scene.body());
        let drop = SingleDrop {
            body,
            first: End::A,
            tilt_rad: scene.tilt_rad(),
            flat: setup.flat,
            speed_m_s: scene.speed_m_s(),
            restitution: scene.e(),
            gravity_m_s2: scene.gravity_m_s2(),
            contact_time_s: setup.contact_time_s,
            contact_law: setup.contact_law,
        };
        let part = setup.part.as_ref();
        let half_m = 0.5 * body.length_m();
        // Places of the product, from end a at -1 to end b at 1.
        let asked = self.bar_at()?;
        let places = match (asked, part) {
            (Some(place), _) => quantities::positions(&[place], "--at", half_m)?,
            (None, Some(part)) => part.places_m.iter().map(|x| (x / half_m).clamp(-1.0, 1.0)).collect(),
            (None, None) => {
                return Err(Failure::Usage("the place is missing: --at=S, or with --product the --component=NAME"));
            }
        };
        let ask = Ask { drop: &drop, model, tolerance: self.tolerance };
        // The end that touches first feels every drop: where not even that is answered, none is.
        ask.of(&Limit::new(LimitKind::VelocityChange, 1.0), -half_m, None).map_err(|error| self.named(error))?;
        let suspension = self.suspension(part.and_then(|part| part.suspension))?;
        let side = setup.side();
        let felt = |limit: &Limit, s: f64| ask.felt_of(limit, side * s * half_m, suspension);
        let limits = part.map_or(Ok(Vec::new()), |part| limits::of(part, &places, half_m, felt))?;
        let at = limits::worst(&limits).map_or(places[0], |limit| limit.at);
        let position_m = side * at * half_m;
        let called = asked.map_or_else(|| setup.shown.length.given(neat(at * half_m)), quantities::Place::said);
        let place_felt = ask.place(position_m)?;
        let part = suspension.map(|suspension| self.suspended(&ask, position_m, suspension)).transpose()?;
        Ok(Drop { args: self, setup, at, called, single: drop, limits, place: place_felt, part })
    }

    /// A drop that was refused, with the options as they were given.
    fn named(&self, error: clatter_assess::Error) -> Failure {
        match error {
            clatter_assess::Error::Flight(error) => {
                self.inertia.gyration().map_or_else(|failure| failure, |gyration| self.drop.named(error, gyration))
            }
            error => Failure::Assess(error),
        }
    }

    fn suspended(&self, ask: &Ask<'_>, position_m: f64, suspension: Suspension) -> Result<Suspended, Failure> {
        let response = respond(ask.drop, position_m, &suspension, ask.model, ask.tolerance);
        let response = response.map_err(Failure::Assess)?;
        let asked = self.equivalent_pulse.then(|| equivalent(&self.shock_table, &suspension, &response));
        Ok(Suspended {
            suspension,
            response,
            acceleration: ask.felt(LimitKind::Acceleration, position_m, Some(suspension))?,
            displacement: ask.felt(LimitKind::RattleSpace, position_m, Some(suspension))?,
            equivalent: asked.transpose()?,
        })
    }
}

/// A drop, and how it is answered.
struct Ask<'a> {
    drop: &'a SingleDrop,
    model: Model,
    tolerance: f64,
}

impl Ask<'_> {
    fn of(
        &self,
        limit: &Limit,
        position_m: f64,
        suspension: Option<Suspension>,
    ) -> Result<Answer, clatter_assess::Error> {
        let suspension = suspension.filter(|_| limit.is_response());
        answer(self.drop, &Part { position_m, suspension }, limit, self.model, self.tolerance)
    }

    /// The same of a drop that is known to be answered: none where nothing is felt.
    fn felt(
        &self,
        kind: LimitKind,
        position_m: f64,
        suspension: Option<Suspension>,
    ) -> Result<Option<Answer>, Failure> {
        // Nothing is allowed or forbidden here: the value alone counts.
        self.felt_of(&Limit::new(kind, 1.0), position_m, suspension)
    }

    fn felt_of(
        &self,
        limit: &Limit,
        position_m: f64,
        suspension: Option<Suspension>,
    ) -> Result<Option<Answer>, Failure> {
        match self.of(limit, position_m, suspension) {
            Err(clatter_assess::Error::Unfinished | clatter_assess::Error::Contact) => Ok(None),
            answer => answer.map(Some).map_err(Failure::Assess),
        }
    }

    fn place(&self, position_m: f64) -> Result<Place, Failure> {
        let of = |kind| self.felt(kind, position_m, None);
        Ok(Place {
            velocity_change: of(LimitKind::VelocityChange)?,
            acceleration: self.drop.contact_time_s.map_or(Ok(None), |_| of(LimitKind::Acceleration))?,
            angular_velocity_change: of(LimitKind::AngularVelocityChange)?,
        })
    }
}

/// What is not felt is 0.
fn value(answer: Option<&Answer>) -> f64 {
    answer.map_or(0.0, |answer| answer.value)
}

impl Drop<'_> {
    fn at_once(&self) -> [f64; 2] {
        at_once(self.single.restitution, self.single.speed_m_s)
    }

    /// W h0/v0.
    fn ratio(&self, part: &Suspended) -> f64 {
        part.suspension.omega() * self.setup.scene.height_gap_m() / self.single.speed_m_s
    }

    pub(super) fn notes(&self) -> &[(&'static str, String)] {
        &self.setup.notes
    }

    /// An input: what was typed as it was, what a search found to six digits.
    fn shortly(&self, x: f64) -> f64 {
        if self.args.worst.is_some() { format!("{x:.5e}").parse().unwrap_or(x) } else { x }
    }

    fn headings(&self, out: &mut dyn Write) -> io::Result<()> {
        let (at, e, shown) = (&self.called, given(self.single.restitution), &self.setup.shown);
        let length = shown.length.given(self.setup.scene.body().length_m());
        let part = self.part.as_ref().map(|part| part.suspension);
        match part {
            Some(part) => {
                let zeta = given(self.shortly(neat(part.damping().get())));
                let of_file = self.setup.part.as_ref().and_then(|part| part.suspension).map(|(frequency, _)| frequency);
                let of_file = of_file.filter(|_| self.args.omega.is_none());
                let frequency = match self.args.frequency.or(of_file) {
                    Some(Quantity { si, unit }) => Show { unit, name: "Hz" }.given(si),
                    None => format!("W = {} rad/s", given(part.omega())),
                };
                writeln!(out, "Component at {at} of a body of {length}, e = {e}; {frequency}, damping ratio {zeta}")?;
            }
            None => writeln!(out, "Place {at} of a body of {length}, e = {e}; a part there is mounted rigidly")?,
        }
        let contact = self.single.contact_time_s.filter(|_| self.setup.model == Model::Compliant);
        let (model, speed) = (self.setup.model.name(), shown.speed.said(self.single.speed_m_s));
        let (tilt, tolerance) = (shown.tilt(self.shortly(self.setup.tilt_deg)), given(100.0 * self.args.tolerance));
        let first = letter(self.setup.first);
        writeln!(out, "Model {model}, to {tolerance} %: end {first} strikes first, at {speed}, tilt {tilt}")?;
        match contact {
            Some(time) => {
                let law = self.single.contact_law.name();
                writeln!(out, "Contacts of {}, {law}", shown.time.given(time))
            }
            None => Ok(()),
        }
    }

    pub(super) fn table(&self, out: &mut dyn Write) -> io::Result<()> {
        self.headings(out)?;
        if let Some(part) = &self.setup.part {
            limits::table(part, &self.limits, self.setup.shown.time, out)?;
        }
        if let Some(part) = &self.part {
            self.peaks(part, out)?;
        }
        self.place(out)?;
        if let Some(part) = &self.part {
            self.shocks(part, out)?;
        }
        self.doubts(out)?;
        let equivalent = self.part.as_ref().and_then(|part| part.equivalent.as_ref());
        equivalent.map_or(Ok(()), |equivalent| equivalent_table(equivalent, out))
    }

    /// The peaks of the part.
    fn peaks(&self, part: &Suspended, out: &mut dyn Write) -> io::Result<()> {
        let (response, time, speed) = (&part.response, self.setup.shown.time, self.setup.shown.speed);
        let when = format!("when, {}", time.name());
        writeln!(out, "\n{:<34}{:>12} {when:>13}", "Peak of the part", "")?;
        let mut line = |name: &str, size: String, at: f64, answer: Option<Answer>| {
            let after = answer.map_or(String::new(), |answer| format!("  after impact {}", answer.impact));
            writeln!(out, "  {name:<32}{size:>12} {:>13}{after}", time.figures(at))
        };
        // As an assessment tells it.
        let limits = self.setup.part.as_ref().map(|part| part.limits);
        for (name, kind, answer) in [
            ("acceleration", LimitKind::Acceleration, part.acceleration),
            ("relative displacement", LimitKind::RattleSpace, part.displacement),
        ] {
            let Some(Answer { value, unit, time_s, .. }) = answer else { continue };
            let written = limits.and_then(|limits| limits.unit(kind, unit));
            line(name, in_words(unit, written, value), time_s, answer)?;
        }
        for (name, extremes, answer) in [
            ("relative displacement, W z", response.pseudo_velocity(), part.displacement),
            ("relative velocity", response.relative_velocity, None),
            ("absolute acceleration, A/W", response.acceleration_over_omega(), part.acceleration),
        ] {
            let peak = extremes.peak();
            line(name, speed.said(peak.value.abs()), peak.time, answer)?;
        }
        Ok(())
    }

    /// What the place goes through.
    fn place(&self, out: &mut dyn Write) -> io::Result<()> {
        let Place { velocity_change, acceleration, angular_velocity_change } = &self.place;
        let shown = &self.setup.shown;
        let when = format!("when, {}", shown.time.name());
        writeln!(out, "\n{:<34}{:>12} {when:>13}", "Largest at this position", "")?;
        let mut line = |name: &str, show: Show, answer: Option<&Answer>, note: &str| {
            let name = format!("{name}, {}", show.name());
            let Some(Answer { value, time_s, impact, .. }) = answer else {
                return writeln!(out, "  {name:<33}{:>11}", "0");
            };
            let (value, time) = (show.figures(*value), shown.time.figures(*time_s));
            writeln!(out, "  {name:<33}{value:>11} {time:>13}  at impact {impact}{note}")
        };
        line("change of velocity", shown.speed, velocity_change.as_ref(), "")?;
        if let Some(time) = self.single.contact_time_s {
            let half_sine = format!(", taken for a half-sine of {}", shown.time.given(time));
            let note = if self.setup.model == Model::Compliant { "" } else { &half_sine };
            line("acceleration", shown.acceleration, acceleration.as_ref(), note)?;
        }
        line("change of angular velocity", shown.spin, angular_velocity_change.as_ref(), "")?;
        if self.part.is_none() {
            let [flat, _] = self.at_once();
            writeln!(out, "\nWithout clatter, (1 + e) v0 everywhere at once: {}", shown.speed.said(flat))?;
        }
        Ok(())
    }

    /// Single shocks at the position beside the answer.
    fn shocks(&self, part: &Suspended, out: &mut dyn Write) -> io::Result<()> {
        let [flat, standard] = self.at_once();
        let factors = part.suspension.damping().impulse_factors();
        let mut shocks = Shocks { show: self.setup.shown.speed, out };
        shocks.head()?;
        let largest = value(self.place.velocity_change.as_ref());
        shocks.row("the largest of this drop", largest, Some(factors.times(largest)))?;
        shocks.row("without clatter, (1 + e) v0", flat, Some(factors.times(flat)))?;
        shocks.row("as standards assume, 2 v0", standard, Some(factors.times(standard)))?;
        let (ratio, gain) = (figures(self.ratio(part)), figures(part.gain(factors.times(standard))));
        writeln!(out, "\nW h0/v0 = {ratio}; acceleration over that of the standards' shock: {gain}")
    }

    /// What later strikes could still do.
    fn doubts(&self, out: &mut dyn Write) -> io::Result<()> {
        let part = self.part.as_ref().map(|part| [("W z", &part.displacement), ("A/W", &part.acceleration)]);
        let place = [
            ("the change of velocity", &self.place.velocity_change),
            ("the change of angular velocity", &self.place.angular_velocity_change),
        ];
        for (name, answer) in part.into_iter().flatten().chain(place) {
            let error = answer.map_or(0.0, |answer| answer.error());
            if error > TOLD * self.args.tolerance {
                let share = if error.is_infinite() { "?".to_owned() } else { figures(100.0 * error) };
                writeln!(out, "Off by {share} % at most: {name}; strikes multiply what those before got wrong")?;
            }
        }
        Ok(())
    }

    pub(super) fn answer(&self) -> DropJson {
        let part = self.part.as_ref();
        let standard = |i: usize| {
            let shock = self.at_once()[i];
            part.map(|part| part.suspension.damping().impulse_factors().times(shock))
        };
        let contact = self.single.contact_time_s.filter(|_| self.setup.model == Model::Compliant);
        DropJson {
            model: self.setup.model.name(),
            first: letter(self.setup.first),
            length_m: Json(self.setup.scene.body().length_m()),
            gyration_m: Json(self.setup.scene.body().gyration_m()),
            center_of_mass: Json(self.setup.side() * self.setup.center_of_mass + 0.0),
            inertia_ratios: self.setup.inertia_ratios().map(Json),
            e: Json(self.single.restitution),
            speed_m_s: Json(self.single.speed_m_s),
            tilt_deg: Json(self.setup.tilt_deg),
            height_gap_m: Json(self.setup.scene.height_gap_m()),
            gravity_m_s2: Json(self.single.gravity_m_s2),
            contact_time_s: self.single.contact_time_s.map(Json),
            contact_law: contact.map(|_| self.single.contact_law.name()),
            tolerance: Json(self.args.tolerance),
            at: Json(self.at),
            limits: self.setup.part.as_ref().map(|_| self.limits.iter().map(Into::into).collect()),
            response: part.map(|part| ResponseJson::new(&part.suspension, &part.response, |_| None)),
            velocity_change_m_s: Json(value(self.place.velocity_change.as_ref())),
            acceleration_m_s2: self.single.contact_time_s.map(|_| Json(value(self.place.acceleration.as_ref()))),
            angular_velocity_change_rad_s: Json(value(self.place.angular_velocity_change.as_ref())),
            answers: AnswersJson::new(
                [self.place.velocity_change, self.place.acceleration, self.place.angular_velocity_change],
                [part.and_then(|part| part.acceleration), part.and_then(|part| part.displacement)],
            ),
            clatter_free: standard(0).map(Into::into),
            standard: standard(1).map(Into::into),
            gain: part.zip(standard(1)).map(|(part, standard)| Json(part.gain(standard))),
            equivalent: part.and_then(|part| part.equivalent.as_ref()).map(Into::into),
        }
    }
}

impl Suspended {
    /// Peak acceleration over that of one shock of 2 v0.
    fn gain(&self, standard: ImpulseFactors) -> f64 {
        self.response.acceleration_over_omega().magnitude() / standard.acceleration
    }
}

#[derive(Serialize)]
pub(super) struct DropJson {
    model: &'static str,
    /// The end that touches first.
    first: &'static str,
    length_m: Json,
    gyration_m: Json,
    center_of_mass: Json,
    inertia_ratios: [Json; 2],
    e: Json,
    speed_m_s: Json,
    tilt_deg: Json,
    height_gap_m: Json,
    gravity_m_s2: Json,
    #[serde(skip_serializing_if = "Option::is_none")]
    contact_time_s: Option<Json>,
    #[serde(skip_serializing_if = "Option::is_none")]
    contact_law: Option<&'static str>,
    tolerance: Json,
    at: Json,
    /// Of a part of a product file.
    #[serde(skip_serializing_if = "Option::is_none")]
    limits: Option<Vec<LimitJson>>,
    #[serde(flatten)]
    response: Option<ResponseJson>,
    velocity_change_m_s: Json,
    /// Null without a contact time.
    acceleration_m_s2: Option<Json>,
    angular_velocity_change_rad_s: Json,
    answers: AnswersJson,
    #[serde(skip_serializing_if = "Option::is_none")]
    clatter_free: Option<FactorsJson>,
    #[serde(skip_serializing_if = "Option::is_none")]
    standard: Option<FactorsJson>,
    #[serde(skip_serializing_if = "Option::is_none")]
    gain: Option<Json>,
    #[serde(flatten)]
    equivalent: Option<EquivalentJson>,
}

/// When each largest value comes and how far off it may be; null where nothing is felt.
#[derive(Serialize)]
pub(super) struct AnswersJson {
    velocity_change: Option<AnswerJson>,
    acceleration: Option<AnswerJson>,
    angular_velocity_change: Option<AnswerJson>,
    part_acceleration: Option<AnswerJson>,
    part_displacement: Option<AnswerJson>,
}

impl AnswersJson {
    /// Of the place its change of velocity, acceleration and change of angular velocity; of the part acceleration and displacement.
    pub(super) fn new(place: [Option<Answer>; 3], part: [Option<Answer>; 2]) -> Self {
        let [velocity_change, acceleration, angular_velocity_change] = place.map(AnswerJson::new);
        let [part_acceleration, part_displacement] = part.map(AnswerJson::new);
        Self { velocity_change, acceleration, angular_velocity_change, part_acceleration, part_displacement }
    }
}

#[derive(Serialize)]
struct AnswerJson {
    value: Json,
    unit: &'static str,
    time_s: Json,
    impact: u64,
    error: Json,
}

impl AnswerJson {
    fn new(answer: Option<Answer>) -> Option<Self> {
        answer.map(|answer| Self {
            value: Json(answer.value),
            unit: answer.unit.name(),
            time_s: Json(answer.time_s),
            impact: answer.impact,
            error: Json(answer.error()),
        })
    }
}
