//! This module computes the effect of one clatter, or of a list of shocks or pulses, on one part.
//!
//! ```
//! use clatter::{Bar, Start};
//! use clatter_answer::respond::{self, Excitation};
//! use clatter_shock::{DampingRatio, Suspension};
//! // In the middle of a bar with all its mass at the center both ends give the same shocks, which fade by e.
//! let bar = Excitation::Bar { bar: Bar::new(1.0, 0.2)?, start: Start::default(), at: 0.0 };
//! let part = Suspension::new(5.0, DampingRatio::new(0.05)?)?;
//! let answer = respond::answer(&respond::Question::new(bar, part))?;
//! assert_eq!((answer.part.omega.0, answer.stiff.is_some()), (5.0, true));
//! # Ok::<(), clatter_answer::Error>(())
//! ```
//!
//! The drops of [`mod@drop`] are in SI units; [`rule`] has the same part at all natural frequencies.

pub mod drop;
mod limits;
mod peaks;
pub mod rule;

use std::f64::consts::TAU;
use std::ops::RangeInclusive;

use clatter::{Bar, Start};
use clatter_shock::{Hit, Pulse, Pulses, Response, ShockTable, Suspension, VelocityShock, VelocityShocks};
use serde::Serialize;

use crate::error::within_periods;
use crate::{Error, Json, on_body};
pub use limits::{AtPlace, Limit};
pub use peaks::{
    AllPeaks, AtStop, Equivalent, Extreme, Extremes, Factors, HalfSine, HitStop, Largest, LargestValues, NOTHING_FELT,
    Peaks, ServiceCondition,
};

/// The source of the shocks on a part.
#[derive(Debug, Clone)]
pub enum Excitation {
    /// The clatter of a bar. In v0 and h0, or all in SI units.
    Bar {
        /// The bar.
        bar: Bar,
        /// Velocities and height gap at the first touch.
        start: Start,
        /// The position of the part, in [−1, 1].
        at: f64,
    },
    /// Velocity shocks.
    Shocks(VelocityShocks),
    /// Pulses, in any order.
    Pulses(Vec<Pulse>),
}

/// A part and the source of its shocks.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Question {
    /// The source of its shocks.
    pub excitation: Excitation,
    /// The part.
    pub suspension: Suspension,
    /// A shock table whose half-sine is to have the same effect on the part; it is accepted in SI units alone.
    pub shock_table: Option<ShockTable>,
}

impl Question {
    /// Makes a question without an equivalent pulse.
    #[must_use]
    pub fn new(excitation: Excitation, suspension: Suspension) -> Self {
        Self { excitation, suspension, shock_table: None }
    }
}

/// The response of a part, with that to single shocks for comparison.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Answer {
    /// The bar that clatters.
    #[serde(flatten)]
    pub bar: Option<BarAnswer>,
    /// The part and its peaks.
    #[serde(flatten)]
    pub part: Peaks,
    /// The hits of its stops, where it has any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at_stop: Option<AtStop>,
    /// The shocks at its place.
    pub shocks: Shocks,
    /// The response to the sum of the shocks at one instant.
    pub soft: Factors,
    /// The response to the largest shock alone; null without damping, and for pulses.
    pub stiff: Option<Factors>,
    /// The response to (1 + e) v0 at one instant, as without clatter: of clatters alone, as the next two.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clatter_free: Option<Factors>,
    /// The response to 2 v0, as standards assume.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub standard: Option<Factors>,
    /// Peak acceleration over that of the standards' shock.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gain: Option<Json>,
    /// The equivalent pulse, where a shock table was given.
    #[serde(flatten)]
    pub equivalent: Option<Equivalent>,
}

/// A bar that clatters.
#[derive(Debug, Clone, Copy, Serialize)]
#[non_exhaustive]
pub struct BarAnswer {
    /// Inertia ratio.
    pub q: Json,
    /// Radius of gyration over half-length.
    pub gyration_ratio: Json,
    /// Coefficient of restitution.
    pub e: Json,
    /// The velocities of ends a and b at the first touch.
    pub velocity: [Json; 2],
    /// The height of end b at the first touch.
    pub height_gap: Json,
    /// The position of the part.
    pub at: Json,
}

/// Shocks at the place of a part.
#[derive(Debug, Clone, Copy, Serialize)]
#[non_exhaustive]
pub struct Shocks {
    /// The number of shocks that were followed.
    pub count: usize,
    /// Their sum.
    pub net: Json,
    /// The largest, in size.
    pub largest: Json,
    /// The bound on the change of W z by the shocks that are omitted from an endless train.
    pub omitted: Json,
    /// The count, with one more for the many shocks at one instant.
    #[serde(skip)]
    pub listed: usize,
}

/// The range of angular frequencies, in rad/s, whose squares and times stay floating-point numbers together with those of the pulses.
const SWINGS: RangeInclusive<f64> = 1e-100..=1e100;

/// Computes the exact peaks, from turning points and not from samples, with the complete ring-down.
///
/// # Errors
/// A place off the bar, or at q = 1 off the middle; pulses that are none, or last too long for the part; a part too slow or too fast
/// for pulses.
pub fn answer(question: &Question) -> Result<Answer, Error> {
    let Question { excitation, suspension, shock_table } = question;
    let (response, hits, shocks, omitted) = felt(excitation, suspension)?;
    let is_pulses = matches!(excitation, Excitation::Pulses(_));
    let damping = suspension.damping();
    let part = Peaks::new(suspension, &response, |extreme| {
        // Pulses overlap: an extreme follows the start of one.
        Some(if is_pulses {
            shocks.as_slice().partition_point(|shock| shock.time <= extreme.time).max(1)
        } else {
            (extreme.interval + 1).min(shocks.single().len())
        })
    });
    let bar = if let Excitation::Bar { bar, start, at } = excitation { Some((bar, start, at)) } else { None };
    let at_once = bar.map(|(bar, start, _)| Factors::at_once(damping, bar.e(), -start.velocity()[0]));
    let equivalent = shock_table.map(|table| Equivalent::new(&table, suspension, &response)).transpose()?;
    Ok(Answer {
        bar: bar.map(|(bar, start, at)| BarAnswer {
            q: Json(bar.q()),
            gyration_ratio: Json(bar.gyration_ratio()),
            e: Json(bar.e()),
            velocity: start.velocity().map(Json),
            height_gap: Json(start.height_gap()),
            at: Json(*at),
        }),
        shocks: Shocks {
            count: shocks.single().len(),
            net: Json(shocks.net()),
            largest: Json(shocks.largest()),
            omitted: Json(omitted),
            listed: shocks.as_slice().len(),
        },
        soft: Factors::of(shocks.net().abs(), shocks.soft_limit(damping)),
        stiff: shocks.stiff_limit(damping).filter(|_| !is_pulses).map(|factors| Factors::of(shocks.largest(), factors)),
        clatter_free: at_once.map(|[flat, _]| flat),
        standard: at_once.map(|[_, standard]| standard),
        gain: at_once.map(|[_, standard]| part.gain(&standard)),
        at_stop: suspension.stop().map(|_| AtStop::of(&hits)),
        part,
        equivalent,
    })
}

/// Returns the response with the hits of stops, the velocity changes at the place in order of time, and the bound on those that are
/// omitted.
fn felt(excitation: &Excitation, suspension: &Suspension) -> Result<(Response, Vec<Hit>, VelocityShocks, f64), Error> {
    match excitation {
        Excitation::Bar { bar, start, at } => {
            on_body([*at])?;
            let train = clatter_shock::respond(bar, start, *at, suspension)?;
            Ok((train.response, train.shocks.pulses().hits(suspension)?, train.shocks, train.omitted))
        }
        Excitation::Shocks(shocks) => {
            Ok((shocks.respond(suspension), shocks.pulses().hits(suspension)?, shocks.clone(), 0.0))
        }
        Excitation::Pulses(pulses) => {
            let omega = suspension.omega();
            if !SWINGS.contains(&omega) {
                let (name, allowed) = ("natural angular frequency in rad/s", "in [1e-100, 1e100], which pulses take");
                return Err(Error::Quantity { name, value: omega, allowed });
            }
            within_periods(pulses, &[omega / TAU])?;
            let train = Pulses::new(pulses)?;
            let (response, hits) = (train.respond(suspension), train.hits(suspension)?);
            let mut shocks: Vec<_> = pulses
                .iter()
                .map(|pulse| VelocityShock { time: pulse.start, delta_v: pulse.velocity_change() })
                .collect();
            shocks.sort_by(|a, b| a.time.total_cmp(&b.time));
            Ok((response, hits, VelocityShocks::new(shocks)?, 0.0))
        }
    }
}

/// Refuses a part of a drop that is too slow or too fast: beyond, no motion can be distinguished from rounding, and the search would take
/// for ever.
fn swings(suspension: Option<&Suspension>) -> Result<(), Error> {
    match suspension.map(Suspension::omega).filter(|omega| !(1e-12..=1e12).contains(omega)) {
        Some(value) => Err(Error::Quantity { name: "natural frequency in rad/s", value, allowed: "in [1e-12, 1e12]" }),
        None => Ok(()),
    }
}
