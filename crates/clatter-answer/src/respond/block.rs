//! A part of a box in one drop, in any orientation, with contacts that take time.
//!
//! ```
//! use clatter_answer::respond::block::{self, Axis};
//! use clatter_flight::{Block, BlockDrop, Contact, ContactLaw};
//! // The middle of a handheld of 150 by 70 by 15 mm that lands on an edge.
//! let handheld = Block::new([0.15, 0.07, 0.015], [0.0; 3], [0.0207, 0.0435, 0.0478])?;
//! let drop = BlockDrop::tilted(handheld, 0.7, 0.0, 4.43, 9.806_65)?;
//! let contact = Contact::new(ContactLaw::Hysteretic, 0.5, 5e-4)?;
//! let answer = block::answer(&block::Question::new(drop, contact, [0.0; 3], Axis::Any))?;
//! assert!(answer.acceleration.value_m_s2.0 > 1000.0);
//! # Ok::<(), clatter_answer::Error>(())
//! ```

use std::f64::consts::TAU;

use clatter_assess::{Model, OwnContacts, Part, SingleDrop};
use clatter_flight::{BlockDrop, BlockFlight, Contact, Stop};
use clatter_shock::{Frequencies, Quantity, Spectrum, Suspension, UnevenFilter};
use serde::Serialize;

use super::limits::OneDrop;
use super::{ContactAt, Limit, Position, contacts};
use crate::simulate::block::{DropAnswer, StopAnswer};
use crate::{Error, Json};

/// Samples of a smooth part of a flight, between which lines are straight: of some dozen parts a contact.
const SAMPLES: u32 = 8;
/// A part is followed on for so many periods once the box lies still.
const PERIODS: f64 = 3.0;

/// An axis of a box along which a part moves, or a place is shaken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// Along the length.
    X,
    /// Along the width.
    Y,
    /// Along the thickness.
    Z,
    /// The magnitude, of a place on which a part is mounted rigidly.
    Any,
}

impl From<clatter_assess::Axis> for Axis {
    fn from(axis: clatter_assess::Axis) -> Self {
        match axis {
            clatter_assess::Axis::X => Self::X,
            clatter_assess::Axis::Y => Self::Y,
            clatter_assess::Axis::Z => Self::Z,
            clatter_assess::Axis::Any => Self::Any,
        }
    }
}

impl Axis {
    fn index(self) -> Option<usize> {
        if self == Self::Any { None } else { Some(self as usize) }
    }
    /// `x`, `y`, `z` or `any`.
    #[must_use]
    pub fn name(self) -> &'static str {
        ["x", "y", "z", "any"][self as usize]
    }
}

/// A drop of a box and a part of it.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Question {
    /// The drop.
    pub drop: BlockDrop,
    /// What the ground does to a corner.
    pub contact: Contact,
    /// Corners with a contact of their own, as they are seen from above.
    pub own_contacts: OwnContacts,
    /// Where the part is, from the middle along the axes of the box.
    pub at_m: [f64; 3],
    /// Along which axis it moves.
    pub axis: Axis,
    /// The part; none that is mounted rigidly.
    pub suspension: Option<Suspension>,
    /// Limits that are held against the drop, as an assessment does.
    pub limits: Option<Limits>,
}

/// Limits of a part of a product, and the drop of a box that is held against them.
#[derive(Debug, Clone)]
pub struct Limits {
    /// The drop, as an assessment has it.
    pub drop: SingleDrop,
    /// The place.
    pub part: Part,
    /// The limits.
    pub limits: Vec<clatter_assess::Limit>,
    /// How exact the answer is, as a share of it.
    pub tolerance: f64,
}

impl Question {
    /// Of a place on which a part is mounted rigidly.
    #[must_use]
    pub fn new(drop: BlockDrop, contact: Contact, at_m: [f64; 3], axis: Axis) -> Self {
        Self { drop, contact, own_contacts: OwnContacts::NONE, at_m, axis, suspension: None, limits: None }
    }
}

/// What a drop of a box does to a part and at its place.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Answer {
    /// The drop.
    #[serde(flatten)]
    pub drop: DropAnswer,
    /// What the ground does while a corner touches.
    pub contact_law: &'static str,
    /// Corners with a contact of their own.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub contacts: Vec<ContactAt>,
    /// The place.
    pub at_m: [Json; 3],
    /// `x`, `y`, `z` or `any`.
    pub axis: &'static str,
    /// The limits that were given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limits: Option<Vec<Limit>>,
    /// The part.
    #[serde(flatten)]
    pub part: Option<PartAnswer>,
    /// What an accelerometer at the place feels at most along the axis.
    pub acceleration: Largest,
    /// Why the motion ends.
    pub stop: StopAnswer,
    /// The flight.
    #[serde(skip)]
    pub flight: BlockFlight,
}

/// A largest acceleration, and when.
#[derive(Debug, Clone, Copy, Serialize)]
#[non_exhaustive]
pub struct Largest {
    /// In size.
    pub value_m_s2: Json,
    /// Since the first touch.
    pub time_s: Json,
}

/// A part on its suspension: its largest W z and A/W, as velocities.
#[derive(Debug, Clone, Copy, Serialize)]
#[non_exhaustive]
pub struct PartAnswer {
    /// Natural angular frequency W.
    pub omega: Json,
    /// Damping ratio.
    pub damping: Json,
    /// Largest W z.
    pub omega_peak_relative_displacement: Json,
    /// When.
    pub time_of_peak_relative_displacement: Json,
    /// Largest A/W.
    pub peak_absolute_acceleration_over_omega: Json,
    /// When.
    pub time_of_peak: Json,
}

/// What a place feels along the axes of the box, over time.
struct PlaceHistory {
    times_s: Vec<f64>,
    along_m_s2: [Vec<f64>; 3],
    /// What it feels once the box lies, its turn about the vertical with it.
    at_rest_m_s2: [f64; 3],
    flight: BlockFlight,
}

impl PlaceHistory {
    fn new(question: &Question) -> Result<Self, Error> {
        let place = question.drop.block().place(question.at_m);
        let (mut times_s, mut along_m_s2) = (Vec::new(), [const { Vec::new() }; 3]);
        let flight = question.drop.own_contacts(&question.own_contacts.of_box(&question.contact)?, |step| {
            for k in 0..=SAMPLES {
                let share = f64::from(k) / f64::from(SAMPLES);
                times_s.push(step.from_s + share * step.length_s);
                for (values, value) in along_m_s2.iter_mut().zip(step.felt_m_s2(place, share)) {
                    values.push(value);
                }
            }
        })?;
        let at_rest_m_s2 = flight.at_rest_m_s2(place, question.drop.gravity_m_s2());
        Ok(Self { times_s, along_m_s2, at_rest_m_s2, flight })
    }

    /// The largest felt acceleration along an axis, or in magnitude, and when.
    fn largest(&self, axis: Axis) -> Largest {
        let [x, y, z] = &self.along_m_s2;
        let size = |k: usize| match axis.index() {
            Some(axis) => self.along_m_s2[axis][k].abs(),
            None => (x[k] * x[k] + y[k] * y[k] + z[k] * z[k]).sqrt(),
        };
        let largest = (0..self.times_s.len()).max_by(|&a, &b| size(a).total_cmp(&size(b)).then(b.cmp(&a)));
        let [value, time] = largest.map_or([0.0; 2], |k| [size(k), self.times_s[k]]);
        Largest { value_m_s2: Json(value), time_s: Json(time) }
    }

    /// Largest value of a quantity of a part that moves along an axis, and when, over the whole flight; at rest the weight is on.
    fn peak(&self, axis: usize, part: &Suspension, quantity: Quantity) -> Result<[f64; 2], Error> {
        let omega = part.omega();
        let mut filter = UnevenFilter::new(Frequencies::list(vec![omega / TAU])?, part.damping(), quantity);
        filter.push(&self.times_s, &self.along_m_s2[axis])?;
        if let (Stop::AtRest { .. }, Some(end_s)) = (self.flight.stop, self.times_s.last()) {
            filter.push(&[*end_s, end_s + PERIODS * TAU / omega], &[self.at_rest_m_s2[axis]; 2])?;
            let Spectrum { primary, time_of_peak_s, .. } = filter.finish()?;
            return Ok([primary[0], time_of_peak_s[0]]);
        }
        let Spectrum { maximax, time_of_peak_s, .. } = filter.finish()?;
        Ok([maximax[0], time_of_peak_s[0]])
    }

    fn part(&self, axis: usize, part: &Suspension) -> Result<PartAnswer, Error> {
        let [displacement, when] = self.peak(axis, part, Quantity::PseudoVelocity)?;
        let [acceleration, time] = self.peak(axis, part, Quantity::AbsoluteAcceleration)?;
        Ok(PartAnswer {
            omega: Json(part.omega()),
            damping: Json(part.damping().get()),
            omega_peak_relative_displacement: Json(displacement),
            time_of_peak_relative_displacement: Json(when),
            peak_absolute_acceleration_over_omega: Json(acceleration / part.omega()),
            time_of_peak: Json(time),
        })
    }
}

/// Follows one drop.
///
/// # Errors
/// A place beyond the box; a part that would swing along no axis; those of [`BlockDrop::contacts`], and frequencies that no spectrum has.
pub fn answer(question: &Question) -> Result<Answer, Error> {
    let Question { drop, contact, own_contacts, at_m, axis, suspension, limits } = question;
    for (&value, size) in at_m.iter().zip(drop.block().size_m()) {
        if value.is_nan() || value.abs() > 0.5 * size * (1.0 + 1e-9) {
            let (name, allowed) = ("position in m", "within the box: from its middle, half of its size at most");
            return Err(Error::Quantity { name, value, allowed });
        }
    }
    let of_limits = |of: &Limits| {
        let asked = OneDrop { drop: of.drop, model: Model::Compliant, tolerance: of.tolerance };
        asked.limits(&of.limits, &[(of.part, Position::All(at_m.map(Json)))], *suspension)
    };
    let limits = limits.as_ref().map(of_limits).transpose()?;
    let felt = PlaceHistory::new(question)?;
    let part = match (suspension, axis.index()) {
        (Some(part), Some(axis)) => Some(felt.part(axis, part)?),
        (Some(part), None) => {
            let (name, allowed) =
                ("natural frequency in rad/s", "that of a part that swings: it does so along one axis");
            return Err(Error::Quantity { name, value: part.omega(), allowed });
        }
        (None, _) => None,
    };
    Ok(Answer {
        drop: DropAnswer::new(drop, contact),
        contact_law: contact.law().name(),
        contacts: contacts(own_contacts, contact.restitution(), Some(contact.time_s())),
        at_m: at_m.map(Json),
        axis: axis.name(),
        limits,
        part,
        acceleration: felt.largest(*axis),
        stop: StopAnswer::new(&felt.flight.stop),
        flight: felt.flight,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use clatter_flight::{Block, ContactLaw};
    use clatter_shock::DampingRatio;

    /// A soft part without damping on a box that is set down swings under its weight, by twice its static deflection, and by no more
    /// than the velocity of the box adds.
    #[test]
    fn a_part_of_a_box_at_rest_carries_its_weight() {
        let block = Block::new([0.15, 0.07, 0.015], [0.0; 3], [0.0207, 0.0435, 0.0478]).unwrap();
        let drop = BlockDrop::tilted(block, 0.0, 0.0, 0.05, 9.81).unwrap();
        let contact = Contact::new(ContactLaw::Hysteretic, 0.1, 1e-4).unwrap();
        let part = Suspension::from_hz(2.0, DampingRatio::new(0.0).unwrap()).unwrap();
        let question = Question { suspension: Some(part), ..Question::new(drop, contact, [0.0; 3], Axis::Z) };
        let swings = answer(&question).unwrap().part.unwrap().omega_peak_relative_displacement.0;
        let weight = 2.0 * 9.81 / part.omega();
        assert!((swings - weight).abs() < 1.1 * 0.05, "{swings}, not {weight}");
    }
}
