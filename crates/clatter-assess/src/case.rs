//! A drop with the part that it shakes, as data.

use clatter_flight::{Drop, Place};
use clatter_shock::{DampingRatio, Suspension};
use serde::{Deserialize, Serialize};

use crate::{Part, WorstCase};
use clatter_product::{Error, Model};

/// A drop with the part that it shakes, and how it is answered. An assessment writes it as JSON, and `clatter respond --drop` reads it.
///
/// # Examples
/// ```
/// use clatter_assess::{Case, answer};
/// use clatter_product::{EXAMPLE, LimitKind, ProductFile};
/// let assessment = clatter_assess::assess(&ProductFile::read(EXAMPLE, "example.toml")?)?;
/// let limit = &assessment.components[0].limits[0];
/// let text = serde_json::to_string(&Case::of(&limit.worst_case.unwrap()))?;
/// let again: Case = serde_json::from_str(&text)?;
/// let allowed = clatter_product::Limit::new(limit.limit, limit.allowed);
/// let asked = answer(&again.drop, &again.part()?, &allowed, again.model, again.tolerance)?;
/// assert_eq!(Some(asked.value), limit.demand);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// The drop.
    pub drop: Drop,
    /// The model that answers it.
    pub model: Model,
    /// The tolerance of the answer.
    pub tolerance: f64,
    /// The place of the part, and the axis along which it moves.
    pub place: Place,
    /// The free vibration of the part; null where it is mounted rigidly.
    pub swings: Option<Swings>,
}

/// The free vibration of a part.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Swings {
    /// Natural angular frequency.
    pub omega_rad_s: f64,
    /// Damping ratio.
    pub damping_ratio: f64,
}

impl Case {
    /// Returns the case of a worst drop.
    #[must_use]
    pub fn of(worst: &WorstCase) -> Self {
        let WorstCase { drop, part, model, tolerance, .. } = *worst;
        let swings = |part: Suspension| Swings { omega_rad_s: part.omega(), damping_ratio: part.damping().get() };
        Self { drop, model, tolerance, place: part.place, swings: part.suspension.map(swings) }
    }
    /// Returns the part.
    ///
    /// # Errors
    /// [`Error::Shock`] for one that does not swing.
    pub fn part(&self) -> Result<Part, Error> {
        let suspension = |of: Swings| Suspension::new(of.omega_rad_s, DampingRatio::new(of.damping_ratio)?);
        Ok(Part::at(self.place, self.swings.map(suspension).transpose()?))
    }
}
