//! A drop with the part that it shakes, as data.

use clatter_flight::{Drop, Place};
use clatter_shock::{DampingRatio, Stop, Suspension};
use serde::{Deserialize, Serialize};

use crate::{Part, WorstCase};
use clatter_product::{Error, Model, Stops};

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
    /// The stops on either side of the part, where it has any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stop: Option<CaseStop>,
}

/// The stops of a part.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CaseStop {
    /// The room from the part at rest to either of them.
    pub gap_m: f64,
    /// The time of a contact of the part alone with one of them.
    pub contact_time_s: f64,
    /// The restitution of such a contact.
    pub restitution: f64,
}

impl From<Stop> for CaseStop {
    fn from(stop: Stop) -> Self {
        let [gap_m, contact_time_s, restitution] = Stops::numbers(&stop);
        Self { gap_m, contact_time_s, restitution }
    }
}

impl Swings {
    /// Returns those of a suspension.
    #[must_use]
    pub fn of(part: Suspension) -> Self {
        let (omega_rad_s, damping_ratio) = (part.omega(), part.damping().get());
        Self { omega_rad_s, damping_ratio, stop: part.stop().map(CaseStop::from) }
    }
    fn suspension(self) -> Result<Suspension, Error> {
        let free = Suspension::new(self.omega_rad_s, DampingRatio::new(self.damping_ratio)?)?;
        let stop = |of: CaseStop| Stops::of([of.gap_m, of.contact_time_s, of.restitution]);
        Ok(self.stop.map(stop).transpose()?.map_or(free, |stop| free.with_stop(stop)))
    }
}

impl Case {
    /// Returns the case of a worst drop.
    #[must_use]
    pub fn of(worst: &WorstCase) -> Self {
        let WorstCase { drop, part, model, tolerance, .. } = *worst;
        Self { drop, model, tolerance, place: part.place, swings: part.suspension.map(Swings::of) }
    }
    /// Returns the part.
    ///
    /// # Errors
    /// [`Error::Shock`] for one that does not swing.
    pub fn part(&self) -> Result<Part, Error> {
        Ok(Part::at(self.place, self.swings.map(Swings::suspension).transpose()?))
    }
}
