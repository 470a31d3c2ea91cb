//! This module computes the impacts of one drop of a plate.
//!
//! ```
//! use clatter::{Plate, PlateCount, PlateStart};
//! use clatter_answer::impacts::plate;
//! let question = plate::Question::new(Plate::uniform(0.3)?, PlateStart::level([2.0, 1.0])?);
//! let answer = plate::answer(&question)?;
//! // Corner a strikes first; q = 5/7 for the corner opposite, c.
//! let first = answer.impacts.iter().next().expect("an impact");
//! assert!((first.delta_v[2].0 + 5.0 / 7.0 * first.delta_v[0].0).abs() < 1e-15);
//! # Ok::<(), clatter::Error>(())
//! ```

use clatter::{Error, Plate, PlateCount, PlatePeak, PlateStart, PlateSummary};
use serde::{Serialize, Serializer};

use crate::{Json, on_body};

/// A plate and how it falls: corner a strikes first.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Question {
    /// The plate.
    pub plate: Plate,
    /// Velocities and height gaps at the first touch.
    pub start: PlateStart,
    /// Places whose velocity shocks are requested, in half-lengths and half-widths from the middle.
    pub at: Vec<[f64; 2]>,
    /// The largest number of impacts in the list; at least 1000 are followed for the summary.
    pub limit: usize,
}

impl Question {
    /// Makes a question with at most 1000 impacts in the list, and no place but the corners.
    #[must_use]
    pub fn new(plate: Plate, start: PlateStart) -> Self {
        Self { plate, start, at: Vec::new(), limit: FOLLOWED }
    }
}

/// The least number of impacts that are followed for the summary.
const FOLLOWED: usize = 1000;

/// The totals of one drop of a plate, and its impacts.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Answer<'a> {
    /// Radii of gyration along x and y, over half the length and half the width.
    pub gyration_ratio: [Json; 2],
    /// Center of mass, in half-lengths and half-widths from the middle.
    pub center_of_mass: [Json; 2],
    /// Coefficient of restitution.
    pub e: Json,
    /// The velocities of corners a, b, c and d at the first touch, in v0, upward positive.
    pub velocity: [Json; 4],
    /// The heights of corners b and d at the first touch, in h0.
    pub height_gap: [Json; 2],
    /// The requested places.
    pub at: Vec<[Json; 2]>,
    /// Number of impacts, as far as they were followed.
    #[serde(serialize_with = "count")]
    pub count: PlateCount,
    /// True where that is the whole count, not only the number of impacts that were followed.
    pub count_exact: bool,
    /// Time of the last impact, or the limit it tends to, in h0/v0.
    pub duration: Json,
    /// Largest shocks.
    pub peak: Peak,
    /// Velocities of the corners after the train, in v0; none where it was not followed to its end.
    #[serde(rename = "final")]
    pub final_velocity: Option<[Json; 4]>,
    /// The impacts in the order of time, made while they are read.
    pub impacts: Impacts<'a>,
}

/// Largest velocity shocks of a train, in v0.
#[derive(Debug, Clone, Copy, Serialize)]
#[non_exhaustive]
pub struct Peak {
    /// The largest shock of a corner.
    pub corner: Json,
    /// The impact that gives it, the first if several do.
    pub impact: u64,
    /// The corner that strikes then.
    pub struck: char,
    /// The largest shock of the center of mass.
    pub center: Json,
    /// The bound on the shock of any impact that was not followed.
    pub later: Json,
}

/// One impact of a plate.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Impact {
    /// The number of the impact, from 1.
    pub number: u64,
    /// The corner that strikes.
    pub corner: char,
    /// The time from the first touch, in h0/v0.
    pub time: Json,
    /// Velocity of the corner before it strikes, in v0.
    pub approach: Json,
    /// Velocity shocks of corners a, b, c and d, in v0.
    pub delta_v: [Json; 4],
    /// Velocity shocks at the requested places, in v0.
    pub delta_v_at: Vec<Json>,
    /// True where another corner comes down at the same instant.
    pub tie: bool,
    /// The rule by which the order of a tie is taken.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub order: Option<&'static str>,
}

/// The impacts of a drop, made while they are read: no list is too long.
#[derive(Debug, Clone, Copy)]
pub struct Impacts<'a>(&'a Question);

impl<'a> Impacts<'a> {
    /// Returns the impacts from the first on.
    pub fn iter(&self) -> impl Iterator<Item = Impact> + use<'a> {
        let Question { plate, start, at, limit } = self.0;
        plate.train(start).take(*limit).map(move |impact| Impact {
            number: impact.number,
            corner: impact.corner.letter(),
            time: Json(impact.time),
            approach: Json(impact.approach),
            delta_v: impact.delta_v.map(Json),
            delta_v_at: at.iter().map(|place| Json(impact.delta_v_at(*place))).collect(),
            tie: impact.tie,
            order: impact.tie.then(|| order(start)),
        })
    }
}

impl Serialize for Impacts<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.iter())
    }
}

/// Describes the order of a tie in words.
fn order(start: &PlateStart) -> &'static str {
    if start.gaps().iter().all(|gap| *gap == 0.0) {
        "as if tilted along the diagonal by next to nothing"
    } else {
        "as if corner d were higher, or with HX = 0 corner b, by next to nothing"
    }
}

fn count<S: Serializer>(count: &PlateCount, serializer: S) -> Result<S::Ok, S::Error> {
    match *count {
        PlateCount::Finite(n) | PlateCount::MoreThan(n) => serializer.serialize_u64(n),
        _ => serializer.serialize_str("endless"),
    }
}

/// Follows one drop impact by impact, the order of its corners exact.
///
/// # Errors
/// A place off the plate.
pub fn answer(question: &Question) -> Result<Answer<'_>, Error> {
    let Question { plate, start, at, limit } = question;
    on_body(at.iter().flatten().copied())?;
    let PlateSummary { count, duration, peak, final_velocity, .. } =
        plate.summary(start, (*limit).max(FOLLOWED) as u64);
    let PlatePeak { corner, impact, struck, center, later, .. } = peak;
    Ok(Answer {
        gyration_ratio: plate.gyration_ratios().map(Json),
        center_of_mass: plate.center_of_mass().map(Json),
        e: Json(plate.e()),
        velocity: start.velocities().map(Json),
        height_gap: start.gaps().map(Json),
        at: at.iter().map(|place| place.map(Json)).collect(),
        count,
        count_exact: !matches!(count, PlateCount::MoreThan(_)),
        duration: Json(duration),
        peak: Peak { corner: Json(corner), impact, struck: struck.letter(), center: Json(center), later: Json(later) },
        final_velocity: final_velocity.map(|velocities| velocities.map(Json)),
        impacts: Impacts(question),
    })
}
