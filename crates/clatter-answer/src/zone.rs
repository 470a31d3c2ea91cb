//! This module finds where on a bar no velocity shock exceeds a threshold: the safe zone (Eq. 5).
//!
//! ```
//! use clatter::Bar;
//! use clatter_answer::zone;
//! let question = zone::Question::new(Bar::new(0.5, 0.3)?, vec![0.5, 1.0]);
//! let answer = zone::answer(&question)?;
//! // Table 1: none at half the drop speed, the middle 28.8 % of a uniform bar at the drop speed.
//! assert_eq!(answer.zones[0].extent, clatter::Extent::None);
//! assert!((answer.zones[1].s.0 - 0.288).abs() < 5e-4);
//! # Ok::<(), clatter::Error>(())
//! ```

pub mod plate;

use clatter::{Bar, End, Error, Extent, Start};
use serde::{Serialize, Serializer};

use crate::{Json, in_bounds, letter};

/// A bar that falls without spin, and what a part on it survives.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Question {
    /// The bar.
    pub bar: Bar,
    /// Velocity shocks that a part survives, in v0.
    pub thresholds: Vec<f64>,
    /// The end that strikes first, where the safe interval of that drop is requested as well.
    pub first: Option<End>,
}

impl Question {
    /// Makes a question for whichever end strikes first.
    #[must_use]
    pub fn new(bar: Bar, thresholds: Vec<f64>) -> Self {
        Self { bar, thresholds, first: None }
    }
}

/// The safe zones of a bar.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Answer {
    /// Inertia ratio: where the center of mass is not the middle, that of the symmetric bar with this clatter.
    pub q: Json,
    /// Center of mass in [−1, 1]; only where it is not the middle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub center_of_mass: Option<Json>,
    /// The inertia ratios for strikes at end a and end b; only where the center of mass is not the middle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub inertia_ratios: Option<[Json; 2]>,
    /// The place where the largest shock is least, whichever end strikes first; only where the center of mass is not the middle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub safest: Option<Safest>,
    /// Radius of gyration over half-length.
    pub gyration_ratio: Json,
    /// Coefficient of restitution.
    pub e: Json,
    /// The requested first end, `"a"` or `"b"`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub first: Option<&'static str>,
    /// The zones: one for each threshold.
    pub zones: Vec<Zone>,
}

/// The safe zone of one threshold.
#[derive(Debug, Clone, Copy, Serialize)]
#[non_exhaustive]
pub struct Zone {
    /// The threshold, in v0.
    pub threshold: Json,
    /// Half the width in half-lengths, not clipped: below 0 nothing is safe, from 1 on the whole bar is.
    pub s: Json,
    /// The share of the bar that is safe: none, a part or all.
    #[serde(serialize_with = "extent")]
    pub extent: Extent,
    /// The bounds, whichever end strikes first; only where the center of mass is not the middle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub zone: Option<Interval>,
    /// The bounds if the requested end strikes first.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub interval: Option<Interval>,
}

/// An interval between two positions in [−1, 1]; none where nothing is safe.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Interval(pub Option<[Json; 2]>);

/// The place where the largest shock is least.
#[derive(Debug, Clone, Copy, Serialize)]
#[non_exhaustive]
pub struct Safest {
    /// Position in [−1, 1].
    pub s: Json,
    /// Largest velocity shock there, in v0.
    pub shock: Json,
}

/// Returns `"none"`, `"part"` or `"whole"`.
#[must_use]
pub fn name(extent: Extent) -> &'static str {
    match extent {
        Extent::None => "none",
        Extent::Part => "part",
        Extent::Whole => "whole",
    }
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "as serde calls it")]
fn extent<S: Serializer>(extent: &Extent, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(name(*extent))
}

/// Finds the safe zone of each threshold.
///
/// # Errors
/// A threshold out of bounds.
pub fn answer(question: &Question) -> Result<Answer, Error> {
    let Question { bar, thresholds, first } = question;
    in_bounds(thresholds)?;
    let start = Start::default();
    let either = bar.shocks_either(&start);
    let shocks = first.map(|first| bar.shocks(&start, first));
    let off = !bar.is_symmetric();
    let interval = |bounds: Option<[f64; 2]>| Interval(bounds.map(|bounds| bounds.map(Json)));
    let zone = |&threshold: &f64| {
        let zone = either.safe_zone(threshold);
        Zone {
            threshold: Json(threshold),
            s: Json(zone.s),
            extent: zone.extent,
            zone: off.then(|| interval(either.safe_interval(threshold))),
            interval: shocks.map(|shocks| interval(shocks.safe_interval(threshold))),
        }
    };
    let safest = either.safest();
    Ok(Answer {
        q: Json(bar.q()),
        center_of_mass: off.then(|| Json(bar.center_of_mass())),
        inertia_ratios: off.then(|| bar.inertia_ratios().map(Json)),
        safest: off.then_some(Safest { s: Json(safest.s), shock: Json(safest.shock) }),
        gyration_ratio: Json(bar.gyration_ratio()),
        e: Json(bar.e()),
        first: first.map(letter),
        zones: thresholds.iter().map(zone).collect(),
    })
}
