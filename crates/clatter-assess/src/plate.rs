//! One drop of a plate with contacts that take time, and what it does to a part.

use clatter_flight::{Contact, PlateMotion, PlateScene, Stop};
use clatter_shock::{Pulses, Response, Suspension};

use crate::course::directions;
use crate::drop::{LEAST_SHARE, PRECISION};
use crate::engine::{Answer, CHATTER, FINER, SAFETY};
use crate::history::pulses;
use crate::quantity::Source;
use crate::shock::{Shock, largest, shocks};
use crate::{Error, LimitKind};

/// A drop of a plate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlateDrop {
    /// The plate as corner a touches.
    pub scene: PlateScene,
    /// What the ground does to a corner.
    pub contact: Contact,
}

/// What a drop does at a place of a plate.
#[derive(Debug, Clone)]
pub struct PlateAnswers {
    /// Largest change of velocity of one shock.
    pub velocity_change: Answer,
    /// Largest felt acceleration.
    pub acceleration: Answer,
    /// Largest change of angular velocity of one shock, about any axis in the plane, to half a percent.
    pub angular_velocity_change: Answer,
    /// What a part on a suspension does there.
    pub part: Option<PlatePart>,
}

/// What a drop does to a part on a suspension.
#[derive(Debug, Clone)]
pub struct PlatePart {
    /// All of its peaks.
    pub response: Response,
    /// Peak absolute acceleration.
    pub acceleration: Answer,
    /// Peak displacement relative to the plate.
    pub displacement: Answer,
}

/// Strikes followed at most.
const MOST_STRIKES: usize = 4096;

impl PlateDrop {
    /// What the drop does at a place x, y, in m from the center of mass, and to a part there.
    ///
    /// `tolerance` is how exact the answer is for its model: when a corner is too slow to be followed, how finely damped vibrations
    /// are cut, and when nothing later can count.
    ///
    /// # Validity
    /// As of [`PlateScene`]; the part is light and linear.
    ///
    /// # Accuracy
    /// [`Answer::off_by`]: what is laid down, what strikes multiply of it (by the difference to a drop followed ten times as exactly),
    /// and what the energy left allows of later strikes.
    ///
    /// # Errors
    /// [`Error::Tolerance`], [`Error::Flight`] and [`Error::Shock`].
    pub fn answers(
        &self,
        place: [f64; 2],
        suspension: Option<&Suspension>,
        tolerance: f64,
    ) -> Result<PlateAnswers, Error> {
        if !(1e-6..=0.5).contains(&tolerance) {
            return Err(Error::Tolerance(tolerance));
        }
        let mut answers = self.once(place, suspension, tolerance)?;
        let finer = self.once(place, suspension, FINER * tolerance)?;
        let differ = |answer: &mut Answer, finer: &Answer| {
            answer.off_by = answer.off_by.max(SAFETY * (answer.value - finer.value).abs());
        };
        differ(&mut answers.velocity_change, &finer.velocity_change);
        differ(&mut answers.acceleration, &finer.acceleration);
        differ(&mut answers.angular_velocity_change, &finer.angular_velocity_change);
        if let (Some(part), Some(finer)) = (&mut answers.part, &finer.part) {
            differ(&mut part.acceleration, &finer.acceleration);
            differ(&mut part.displacement, &finer.displacement);
        }
        Ok(answers)
    }

    fn once(&self, place: [f64; 2], suspension: Option<&Suspension>, tolerance: f64) -> Result<PlateAnswers, Error> {
        let followed = Followed::new(self, tolerance)?;
        let felt = followed.motion.felt(place);
        let all = shocks(&felt, followed.motion.gravity_m_s2());
        let shock = largest(&all);
        let velocity_change = followed.answer(LimitKind::VelocityChange, shock.change, shock.time_s, 1.0);
        let higher = |most: (f64, f64), one: (f64, f64)| if one.0 > most.0 { one } else { most };
        let (peak, time_s) = all.iter().map(|shock| (shock.peak, shock.time_s)).fold((0.0, 0.0), higher);
        // A velocity shock of a lone contact has that acceleration at most.
        let per_shock = self.contact.frequency_rad_s();
        let acceleration = followed.answer(LimitKind::Acceleration, peak, time_s, per_shock);
        let turns = directions().map(|along| largest(&shocks(&followed.motion.turned(along), 0.0)));
        let most = |most: Shock, turn: Shock| if turn.change > most.change { turn } else { most };
        let turn = turns.fold(Shock::NONE, most);
        let [kx, ky] = self.scene.plate().gyration_m();
        let angular_velocity_change =
            followed.answer(LimitKind::AngularVelocityChange, turn.change, turn.time_s, 1.0 / kx.min(ky));
        let pulses = pulses(&felt, 0.0, followed.carried_m_s2())?;
        let part = suspension.map(|part| followed.part(&pulses, part, &self.contact));
        Ok(PlateAnswers { velocity_change, acceleration, angular_velocity_change, part })
    }
}

/// A drop as far as it was followed.
struct Followed {
    motion: PlateMotion,
    precision: f64,
    /// Largest velocity shock of a corner.
    largest_m_s: f64,
}

impl Followed {
    fn new(drop: &PlateDrop, tolerance: f64) -> Result<Self, Error> {
        let (precision, e) = (PRECISION * tolerance, drop.contact.restitution());
        let share = tolerance * e.max(LEAST_SHARE);
        let motion = drop
            .scene
            .with_impact_limit(MOST_STRIKES)
            .contacts_until(&drop.contact, precision, |ahead| ahead.most_m_s <= share * ahead.largest_m_s)?;
        let largest_m_s = motion.largest_m_s();
        Ok(Self { motion, precision, largest_m_s })
    }

    /// What a place feels for ever after the motion: its weight, on the mean too over what the plate still bounces.
    fn carried_m_s2(&self) -> f64 {
        let lies = matches!(self.motion.stop, Stop::AtRest { .. } | Stop::Enough { .. });
        if lies { self.motion.gravity_m_s2() } else { 0.0 }
    }

    /// A largest value; `unit` is what a velocity shock of 1 m/s of a corner is of it at most.
    fn answer(&self, kind: LimitKind, value: f64, time_s: f64, unit: f64) -> Answer {
        let strikes = &self.motion.strikes;
        let impact = strikes.partition_point(|strike| strike.time_s < time_s).max(1) as u64;
        let off_by = unit * self.precision * self.largest_m_s + (unit * self.motion.later_m_s - value).max(0.0);
        Answer { value, allowed: 1.0, unit: kind.unit(), time_s, impact, off_by }
    }

    fn part(&self, pulses: &Pulses, part: &Suspension, contact: &Contact) -> PlatePart {
        let omega = part.omega();
        // A part that is fast beside a contact follows its force: it feels no more of a shock than of a pulse twice as high.
        let follows = (2.0 * contact.frequency_rad_s() / omega).min(1.0);
        let response = pulses.respond(part);
        let rest = pulses.state_at_end(part);
        let rings =
            if self.motion.later_m_s > 0.0 { libm::hypot(omega * rest.displacement, rest.velocity) } else { 0.0 };
        let answer = |kind: LimitKind| {
            let Source::Response(of) = kind.source() else { unreachable!("the limit is on a response") };
            let unit = of.of_velocity(1.0, omega);
            let most =
                (rings + CHATTER * follows * self.motion.later_m_s) * libm::hypot(of.of_damper(part.damping()), 1.0);
            let peak = of.of(&response).peak();
            let value = peak.value.abs();
            let off_by = unit * (follows * self.precision * self.largest_m_s + (most - value).max(0.0));
            Answer { off_by, ..self.answer(kind, unit * value, peak.time, 0.0) }
        };
        let [acceleration, displacement] = [LimitKind::Acceleration, LimitKind::RattleSpace].map(answer);
        PlatePart { response, acceleration, displacement }
    }
}
