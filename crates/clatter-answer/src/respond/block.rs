//! A part of a box in one drop, in any orientation, with contacts that take time, answered as an assessment answers it.
//!
//! ```
//! use clatter_answer::respond::block;
//! use clatter_assess::Axis;
//! use clatter_flight::{Block, BlockDrop, Contact, ContactLaw};
//! // The middle of a handheld of 150 by 70 by 15 mm that lands on an edge.
//! let handheld = Block::new([0.15, 0.07, 0.015], [0.0; 3], [0.0207, 0.0435, 0.0478])?;
//! let drop = BlockDrop::tilted(handheld, 0.7, 0.0, 4.43, 9.806_65)?;
//! let contact = Contact::new(ContactLaw::Hysteretic, 0.5, 5e-4)?;
//! let answer = block::answer(&block::Question::new(drop, contact, [0.0; 3], Axis::Any))?;
//! assert!(answer.place.acceleration_m_s2.is_some_and(|most| most.0 > 1000.0));
//! # Ok::<(), clatter_answer::Error>(())
//! ```

use clatter_assess::{Axis, Drop, Model, Part, Place};
use clatter_flight::{BlockDrop, Contact};
use clatter_shock::Suspension;
use serde::Serialize;

use super::limits::OneDrop;
use super::{AtPlace, ContactAt, Position, contacts};
use crate::simulate::block::DropAnswer;
use crate::{Error, Json};

/// A drop of a box and a part of it.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Question {
    /// The drop, as it is told.
    pub block: BlockDrop,
    /// What the ground does to a corner.
    pub contact: Contact,
    /// The same as an assessment has it, with contacts of their own.
    pub drop: Drop,
    /// Where the part is, from the middle along the axes of the box.
    pub at_m: [f64; 3],
    /// Along which axis it moves.
    pub axis: Axis,
    /// The part; none that is mounted rigidly.
    pub suspension: Option<Suspension>,
    /// Limits of the part that are held against the drop.
    pub limits: Option<Vec<clatter_assess::Limit>>,
    /// How exact the answer is, as a share of it.
    pub tolerance: f64,
}

impl Question {
    /// Of a place on which a part is mounted rigidly, to 1 %.
    #[must_use]
    pub fn new(block: BlockDrop, contact: Contact, at_m: [f64; 3], axis: Axis) -> Self {
        let drop = Drop::of_block(&block, &contact);
        Self { block, contact, drop, at_m, axis, suspension: None, limits: None, tolerance: 0.01 }
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
    /// How exact the answer is.
    pub tolerance: Json,
    /// The place.
    pub at_m: [Json; 3],
    /// `x`, `y`, `z` or `any`.
    pub axis: &'static str,
    /// The largest acceleration that is felt there, and when.
    pub acceleration: Acceleration,
    /// The part and its place.
    #[serde(flatten)]
    pub place: AtPlace,
}

/// A largest acceleration, and when.
#[derive(Debug, Clone, Copy, Serialize)]
#[non_exhaustive]
pub struct Acceleration {
    /// In size.
    pub value_m_s2: Json,
    /// Since the first touch.
    pub time_s: Json,
}

/// Follows one drop until nothing later counts.
///
/// # Errors
/// A place beyond the box; a part that would swing along no axis, or too slow or too fast; those of
/// [`clatter_assess::answer`].
pub fn answer(question: &Question) -> Result<Answer, Error> {
    let Question { ref block, ref contact, ref drop, at_m, axis, suspension, ref limits, tolerance } = *question;
    for (value, size) in at_m.into_iter().zip(block.block().size_m()) {
        if value.is_nan() || value.abs() > 0.5 * size * (1.0 + 1e-9) {
            let (name, allowed) = ("position in m", "within the box: from its middle, half of its size at most");
            return Err(Error::Quantity { name, value, allowed });
        }
    }
    if let (Some(part), Axis::Any) = (suspension, axis) {
        let (name, allowed) = ("natural frequency in rad/s", "that of a part that swings: it does so along one axis");
        return Err(Error::Quantity { name, value: part.omega(), allowed });
    }
    let limits = limits.as_deref();
    let asked = OneDrop { drop: *drop, model: Model::Compliant, tolerance, suspension, limits, shock_table: None };
    let part = Part::at(Place { at_m, axis }, None);
    let place = asked.at(&part, &[(part, Position::All(at_m.map(Json)))])?;
    Ok(Answer {
        drop: DropAnswer::new(block, contact),
        contact_law: contact.law().name(),
        contacts: contacts(&drop.own_contacts, contact.restitution(), Some(contact.time_s())),
        tolerance: Json(tolerance),
        at_m: at_m.map(Json),
        axis: axis.name(),
        acceleration: Acceleration {
            value_m_s2: place.acceleration_m_s2.unwrap_or(Json(0.0)),
            time_s: place.answers.acceleration.map_or(Json(0.0), |largest| largest.time_s),
        },
        place,
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
        let question = Question::new(drop, contact, [0.0; 3], Axis::Z);
        let question = Question { suspension: Some(part), ..question };
        let swings = answer(&question).unwrap().place.part.unwrap().omega_peak_relative_displacement.0;
        let weight = 2.0 * 9.81 / part.omega();
        assert!((swings - weight).abs() < 1.1 * 0.05, "{swings}, not {weight}");
    }
}
