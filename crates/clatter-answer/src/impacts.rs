//! This module computes the impacts of one drop of a bar, the largest shocks, and the totals of the train.
//!
//! ```
//! use clatter::{Bar, Start};
//! use clatter_answer::impacts;
//! let question = impacts::Question::new(Bar::new(0.5, 0.3)?, Start::default());
//! let answer = impacts::answer(&question)?;
//! // A uniform bar with e = 0.3 strikes the ground four times.
//! assert_eq!((answer.count.0, answer.impacts.iter().count()), (clatter::Count::Finite(4), 4));
//! # Ok::<(), clatter::Error>(())
//! ```

pub mod plate;

use clatter::{Bar, End, Error, PeakImpact, Start, Summary};
use serde::{Serialize, Serializer};

use crate::{Json, JsonCount, letter, on_body};

/// A bar and how it falls: end a strikes first.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Question {
    /// The bar.
    pub bar: Bar,
    /// Velocities and height gap at the first touch.
    pub start: Start,
    /// Positions in [−1, 1] whose velocity shocks are requested.
    pub at: Vec<f64>,
    /// The largest number of impacts in the list.
    pub limit: usize,
}

impl Question {
    /// Makes a question with at most 1000 impacts in the list, and no position but the ends.
    #[must_use]
    pub fn new(bar: Bar, start: Start) -> Self {
        Self { bar, start, at: Vec::new(), limit: 1000 }
    }
}

/// The totals of one drop of a bar, and its impacts.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Answer<'a> {
    /// Inertia ratio: where the center of mass is not the middle, that of the symmetric bar with this clatter.
    pub q: Json,
    /// Center of mass in [−1, 1]; only where it is not the middle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub center_of_mass: Option<Json>,
    /// The inertia ratios for strikes at end a and end b; only where the center of mass is not the middle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub inertia_ratios: Option<[Json; 2]>,
    /// Radius of gyration over half-length.
    pub gyration_ratio: Json,
    /// Coefficient of restitution.
    pub e: Json,
    /// The velocities of ends a and b at the first touch, in v0, upward positive.
    pub velocity: [Json; 2],
    /// The height of end b at the first touch, in h0.
    pub height_gap: Json,
    /// The requested positions.
    pub at: Vec<Json>,
    /// Number of impacts.
    pub count: JsonCount,
    /// True where the count is that of the masses as given.
    pub count_exact: bool,
    /// Time of the last impact, or the limit it tends to, in h0/v0.
    pub duration: Json,
    /// Largest shocks.
    pub peak: Peak,
    /// Change of velocity over the whole train.
    pub net: Net,
    /// Velocities of ends a and b after the train, in v0; none where they do not settle.
    #[serde(rename = "final")]
    pub final_velocity: Option<[Json; 2]>,
    /// The impacts in the order of time, made while they are read.
    pub impacts: Impacts<'a>,
}

/// Largest velocity shocks of a train.
#[derive(Debug, Clone, Copy, Serialize)]
#[non_exhaustive]
pub struct Peak {
    /// The largest shock of the end that strikes, in v0.
    pub end: Json,
    /// The impact that gives it, the first if several do.
    #[serde(serialize_with = "peak_impact")]
    pub impact: PeakImpact,
    /// The largest shock of the center of mass, in v0.
    pub center: Json,
    /// Change of angular velocity, in v0/L.
    pub angular: Json,
    /// The largest shocks of ends a and b whichever is struck, in v0; only where the center of mass is not the middle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ends: Option<[Json; 2]>,
}

/// Change of velocity over a whole train; only that of the center where the velocities do not settle.
#[derive(Debug, Clone, Copy, Serialize)]
#[non_exhaustive]
pub struct Net {
    /// The change of velocity of end a, in v0.
    pub a: Option<Json>,
    /// The change of velocity of end b, in v0.
    pub b: Option<Json>,
    /// The change of velocity of the center of mass, in v0.
    pub center: Json,
    /// The change of the angular velocity, in v0/L.
    pub angular: Option<Json>,
}

/// One impact of a bar.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Impact {
    /// The number of the impact, from 1.
    pub number: u64,
    /// The end that strikes, `"a"` or `"b"`.
    pub end: &'static str,
    /// The time from the first touch, in h0/v0.
    pub time: Json,
    /// Velocity of the end before it strikes, in v0.
    pub approach: Json,
    /// Velocity shocks of ends a and b, in v0.
    pub delta_v: [Json; 2],
    /// Velocity shocks at the requested positions, in v0.
    pub delta_v_at: Vec<Json>,
}

/// The impacts of a drop, made while they are read: no list is too long.
#[derive(Debug, Clone, Copy)]
pub struct Impacts<'a>(&'a Question);

impl<'a> Impacts<'a> {
    /// Returns the impacts from the first on.
    pub fn iter(&self) -> impl Iterator<Item = Impact> + use<'a> {
        let Question { bar, start, at, limit } = self.0;
        bar.train(start).take(*limit).map(move |impact| Impact {
            number: impact.number,
            end: letter(impact.end),
            time: Json(impact.time),
            approach: Json(impact.approach),
            delta_v: impact.delta_v.map(Json),
            delta_v_at: at.iter().map(|&s| Json(impact.delta_v_at(s))).collect(),
        })
    }
}

impl Serialize for Impacts<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.iter())
    }
}

fn peak_impact<S: Serializer>(impact: &PeakImpact, serializer: S) -> Result<S::Ok, S::Error> {
    match *impact {
        PeakImpact::Number(n) => serializer.serialize_u64(n),
        PeakImpact::Huge(n) => serializer.serialize_f64(n),
        PeakImpact::Limit => serializer.serialize_str("limit"),
    }
}

/// Sums up one drop at once, by the closed form; its impacts come when they are read.
///
/// # Errors
/// A position off the bar.
pub fn answer(question: &Question) -> Result<Answer<'_>, Error> {
    let Question { bar, start, at, .. } = question;
    on_body(at.iter().copied())?;
    let Summary { count, duration, peak, final_velocity, net } = bar.summary(start);
    let off = !bar.is_symmetric();
    let ends = || {
        let shocks = bar.shocks(start, End::A);
        [-1.0, 1.0].map(|s| Json(shocks.at(s)))
    };
    Ok(Answer {
        q: Json(bar.q()),
        center_of_mass: off.then(|| Json(bar.center_of_mass())),
        inertia_ratios: off.then(|| bar.inertia_ratios().map(Json)),
        gyration_ratio: Json(bar.gyration_ratio()),
        e: Json(bar.e()),
        velocity: start.velocity().map(Json),
        height_gap: Json(start.height_gap()),
        at: at.iter().copied().map(Json).collect(),
        count: JsonCount(count),
        count_exact: bar.count_is_exact(start),
        duration: Json(duration),
        peak: Peak {
            end: Json(peak.end),
            impact: peak.impact,
            center: Json(peak.center),
            angular: Json(peak.angular),
            ends: off.then(ends),
        },
        net: Net {
            a: net.map(|net| Json(net.a)),
            b: net.map(|net| Json(net.b)),
            center: Json(net.map_or(0.0, |net| net.center)),
            angular: net.map(|net| Json(net.angular)),
        },
        final_velocity: final_velocity.map(|velocity| velocity.map(Json)),
        impacts: Impacts(question),
    })
}
