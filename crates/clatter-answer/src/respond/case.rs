//! One drop that was written as data, answered again.

use clatter_assess::Case;
use serde::Serialize;

use super::limits::OneDrop;
use super::{AtPlace, Position};
use crate::{Error, Json};

/// A drop as data, and what it does to its part.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Answer {
    /// The drop.
    pub drop: Case,
    /// The part and its place.
    #[serde(flatten)]
    pub place: AtPlace,
}

/// Follows one drop until nothing later counts.
///
/// # Errors
/// A part too slow or too fast; those of [`clatter_assess::answer`].
///
/// # Examples
/// ```
/// use clatter_answer::respond::case;
/// use clatter_assess::{Body, Case, Drop, Model, Place};
/// let drop = Drop { contact_time_s: Some(3e-4), ..Drop::new(Body::new(0.15, 0.043)?, 4.0, 0.05, 0.3) };
/// let place = Place::flat([0.07, 0.0]);
/// let case = Case { drop, model: Model::Compliant, tolerance: 0.01, place, swings: None };
/// assert!(case::answer(&case)?.place.velocity_change_m_s.0 > 4.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn answer(case: &Case) -> Result<Answer, Error> {
    let part = case.part()?;
    let asked = OneDrop {
        drop: case.drop,
        model: case.model,
        tolerance: case.tolerance,
        suspension: part.suspension,
        limits: None,
        shock_table: None,
    };
    let rigid = clatter_assess::Part { suspension: None, ..part };
    let place = asked.at(&rigid, &[(rigid, Position::All(part.place.at_m.map(Json)))])?;
    Ok(Answer { drop: *case, place })
}
