//! This module answers a part in one drop of any body, as an assessment answers it.
//!
//! ```
//! use clatter_answer::respond::drop;
//! use clatter_product::{Body, Drop, Model, Place};
//! // A place at end b of a phone, 140 mm long, that falls at 4.43 m/s and a tilt of 5°.
//! let fall = Drop::new(Body::new(0.14, 0.0404)?, 4.43, 5_f64.to_radians(), 0.3);
//! let answer = drop::answer(&drop::Question::new(fall, Model::FiniteTilt, Place::flat([0.07, 0.0])))?;
//! // Without clatter it would be (1 + e) v, everywhere.
//! assert!(answer.place.velocity_change_m_s.0 > 1.3 * 4.43);
//! // As data the drop is answered again.
//! let again = drop::answer(&drop::Question::of(&answer.drop)?)?;
//! assert_eq!(again.place.velocity_change_m_s.0, answer.place.velocity_change_m_s.0);
//! # Ok::<(), clatter_answer::Error>(())
//! ```

use clatter_assess::{Case, Part, Swings};
use clatter_product::{Axis, Drop, Limit, Model, Place, Side};
use clatter_shock::{ShockTable, Suspension};
use serde::Serialize;

use super::AtPlace;
use super::limits::OneDrop;
use crate::{Error, on_body};

/// A drop and a part of what falls.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Question {
    /// The drop.
    pub drop: Drop,
    /// The physics that is kept of it.
    pub model: Model,
    /// The places on the product where the part may be: of several, the one with the highest demand on a limit is answered, else the first.
    pub places: Vec<Place>,
    /// The part; none that is mounted rigidly.
    pub suspension: Option<Suspension>,
    /// Limits of the part that are held against the drop.
    pub limits: Option<Vec<Limit>>,
    /// The allowed error of the answer for the model, as a share of the answer.
    pub tolerance: f64,
    /// A table whose half-sine is to do the same to the part.
    pub shock_table: Option<ShockTable>,
}

impl Question {
    /// Makes the question of a place on which a part is mounted rigidly, to 1 %.
    #[must_use]
    pub fn new(drop: Drop, model: Model, place: Place) -> Self {
        let places = vec![place];
        Self { drop, model, places, suspension: None, limits: None, tolerance: 0.01, shock_table: None }
    }
    /// Makes the question of a drop that is given as data.
    ///
    /// # Errors
    /// A part that does not swing.
    pub fn of(case: &Case) -> Result<Self, Error> {
        let Part { place, suspension } = case.part()?;
        Ok(Self { suspension, tolerance: case.tolerance, ..Self::new(case.drop, case.model, place) })
    }
}

/// A drop, and what it does to a part and at its place.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Answer {
    /// The drop with the place that is answered, as it is read again.
    pub drop: Case,
    /// The part and its place.
    #[serde(flatten)]
    pub place: AtPlace,
}

/// Returns the place of the body that is so many half-sides from its middle, along each side that it has.
///
/// # Errors
/// [`Error::Input`] for another number of sides, and beyond the body.
pub fn place(drop: &Drop, at: &[f64], axis: Axis) -> Result<Place, Error> {
    let sides: Vec<f64> = drop.sides().iter().map(Side::m).collect();
    if at.len() != sides.len() {
        let count = format!("{} values: the body has {} sides, and takes as many", at.len(), sides.len());
        return Err(Error::input("at", count));
    }
    on_body(at.iter().copied())?;
    let mut at_m = [0.0; 3];
    for ((at_m, at), side_m) in at_m.iter_mut().zip(at).zip(sides) {
        *at_m = 0.5 * side_m * at;
    }
    Ok(Place { at_m, axis })
}

/// Follows one drop until nothing later counts.
///
/// # Errors
/// No place or one off the body, or along another axis than z of a body that is no box; a part too slow or too fast, or one that would
/// swing along no axis; those of
/// [`clatter_assess::answer`].
pub fn answer(question: &Question) -> Result<Answer, Error> {
    let Question { drop, model, ref places, suspension, ref limits, tolerance, shock_table } = *question;
    if !drop.is_solid() && places.iter().any(|place| place.axis != Axis::Z) {
        return Err(Error::input("axis", "it is that of a box: parts of bars and plates move along the thickness"));
    }
    if let (Some(part), true) = (suspension, places.iter().any(|place| place.axis == Axis::Any)) {
        let (name, allowed) = ("natural frequency in rad/s", "that of a part that swings: it does so along one axis");
        return Err(Error::Quantity { name, value: part.omega(), allowed });
    }
    let asked = OneDrop { drop, model, tolerance, suspension, limits: limits.as_deref(), shock_table };
    let place = asked.at(places)?;
    let drop = Case { drop, model, tolerance, place: places[place.index], swings: suspension.map(Swings::of) };
    Ok(Answer { drop, place })
}

#[cfg(test)]
mod tests {
    use super::*;
    use clatter_flight::{Block, BlockDrop};
    use clatter_product::Axis;
    use clatter_shock::DampingRatio;

    /// A soft part without damping on a box that is set down swings under its weight, by twice its static deflection, and by no more
    /// than the velocity of the box adds.
    #[test]
    fn a_part_of_a_box_at_rest_carries_its_weight() {
        let block = Block::new([0.15, 0.07, 0.015], [0.0; 3], [0.0207, 0.0435, 0.0478]).unwrap();
        let drop = Drop::of_block(&BlockDrop::tilted(block, 0.0, 0.0, 0.05, 9.81).unwrap(), 0.1);
        let drop = Drop { contact_time_s: Some(1e-4), ..drop };
        let part = Suspension::from_hz(2.0, DampingRatio::new(0.0).unwrap()).unwrap();
        let question = Question::new(drop, Model::Compliant, Place { at_m: [0.0; 3], axis: Axis::Z });
        let question = Question { suspension: Some(part), ..question };
        let swings = answer(&question).unwrap().place.part.unwrap().omega_peak_relative_displacement.0;
        let weight = 2.0 * 9.81 / part.omega();
        assert!((swings - weight).abs() < 1.1 * 0.05, "{swings}, not {weight}");
    }
}
