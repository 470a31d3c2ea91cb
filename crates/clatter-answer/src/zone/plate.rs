//! This module finds where on a plate no velocity shock exceeds a threshold: a polygon.
//!
//! ```
//! use clatter::Plate;
//! use clatter_answer::zone::plate;
//! let answer = plate::answer(&plate::Question::new(Plate::uniform(0.3)?, vec![0.5]))?;
//! // The bar of this e has no safe zone for half the drop speed; a tenth of the plate or so is one.
//! assert!(answer.zones[0].share.0 > 0.0 && answer.zones[0].share.0 < 0.2);
//! # Ok::<(), clatter::Error>(())
//! ```

use clatter::{Error, Extent, Plate, PlateShocks, PlateStart};
use serde::Serialize;

use crate::{Json, in_bounds};

/// A plate that falls without spin, and what a part on it survives.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Question {
    /// The plate.
    pub plate: Plate,
    /// Velocity shocks that a part survives, in v0.
    pub thresholds: Vec<f64>,
    /// Heights of corners b and d as a touches, in h0, where one drop alone is requested.
    pub height_gap: Option<[f64; 2]>,
}

impl Question {
    /// Requests the zones for any direction of tilt, any corner first.
    #[must_use]
    pub fn new(plate: Plate, thresholds: Vec<f64>) -> Self {
        Self { plate, thresholds, height_gap: None }
    }
}

/// The number of strikes that are followed in every direction, and in one drop.
const OF_EACH: usize = 40;
const OF_ONE: u64 = 1000;

/// The safe zones of a plate.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Answer {
    /// Radii of gyration along x and y, over half the length and half the width.
    pub gyration_ratio: [Json; 2],
    /// Center of mass, in half-lengths and half-widths from the middle.
    pub center_of_mass: [Json; 2],
    /// Coefficient of restitution.
    pub e: Json,
    /// The heights of corners b and d in the one drop that the zones are of, in h0; none for all directions.
    pub height_gap: Option<[Json; 2]>,
    /// Largest shocks of corners a, b, c and d in their own strikes, in v0.
    pub struck: [Json; 4],
    /// The bound on the shock of a corner by impacts that were not followed, in v0.
    pub later: Json,
    /// True where that bound makes no zone smaller.
    pub proven: bool,
    /// The zones: one for each threshold.
    pub zones: Vec<Zone>,
    /// The largest shocks of every place.
    #[serde(skip)]
    pub shocks: PlateShocks,
}

/// The safe zone of one threshold.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Zone {
    /// The threshold, in v0.
    pub threshold: Json,
    /// The share of the plate that is safe: none, a part or all.
    #[serde(serialize_with = "super::extent")]
    pub extent: Extent,
    /// Its corners, in half-lengths and half-widths from the middle.
    pub polygon: Vec<[Json; 2]>,
    /// Share of the area.
    pub share: Json,
}

/// Finds the safe zone of each threshold.
///
/// # Errors
/// A threshold out of bounds, or heights that no drop has.
pub fn answer(question: &Question) -> Result<Answer, Error> {
    let Question { plate, thresholds, height_gap } = question;
    in_bounds(thresholds)?;
    let shocks = match height_gap {
        Some(gaps) => plate.shocks(&PlateStart::level(*gaps)?, OF_ONE),
        None => plate.worst(OF_EACH)?,
    };
    let zone = |&threshold: &f64| {
        let zone = shocks.safe_zone(threshold);
        Zone {
            threshold: Json(threshold),
            extent: zone.extent,
            polygon: zone.polygon.iter().map(|place| place.map(Json)).collect(),
            share: Json(zone.share),
        }
    };
    Ok(Answer {
        gyration_ratio: plate.gyration_ratios().map(Json),
        center_of_mass: plate.center_of_mass().map(Json),
        e: Json(plate.e()),
        height_gap: height_gap.map(|gaps| gaps.map(Json)),
        struck: shocks.struck().map(Json),
        later: Json(shocks.later()),
        proven: shocks.later() <= shocks.struck().into_iter().fold(f64::INFINITY, f64::min),
        zones: thresholds.iter().map(zone).collect(),
        shocks,
    })
}
