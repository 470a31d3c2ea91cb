//! This module computes one quantity over a grid of q, or gyration ratio, and e.
//!
//! ```
//! use clatter::{Axis, Quantity};
//! use clatter_answer::map;
//! let question = map::Question::new(Quantity::Impacts, Axis::q(0.0, 1.0, 3)?, Axis::e(0.0, 0.6, 3)?);
//! let answer = map::answer(&question)?;
//! // A row for each q: a uniform bar, q = 0.5, with e = 0.3 strikes the ground four times.
//! assert_eq!(answer.map.values[3 + 1], 4.0);
//! # Ok::<(), clatter::Error>(())
//! ```

use clatter::{Axis, Error, Map, Quantity, Variable};
use serde::{Serialize, Serializer};

use crate::{Json, JsonWhole, in_bounds};

/// A quantity to compute for the bars of a grid, which fall without spin.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct Question {
    /// The quantity.
    pub quantity: Quantity,
    /// Values of q, or of the gyration ratio.
    pub inertia: Axis,
    /// Values of e.
    pub e: Axis,
}

impl Question {
    /// Requests the quantity for every pair of values.
    #[must_use]
    pub fn new(quantity: Quantity, inertia: Axis, e: Axis) -> Self {
        Self { quantity, inertia, e }
    }
}

/// A map.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Answer {
    /// The quantity, by its [`name`].
    pub quantity: &'static str,
    /// The velocity shock that a part survives, in v0: of the safe zone alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub threshold: Option<Json>,
    /// Values of q, where the map is over them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub q: Option<Vec<Json>>,
    /// Values of the gyration ratio, where the map is over them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gyration_ratio: Option<Vec<Json>>,
    /// Values of e.
    pub e: Vec<Json>,
    /// The map itself: its values, a row for each value of the inertia.
    #[serde(rename = "values", serialize_with = "rows")]
    pub map: Map,
}

/// Returns the name of a quantity.
#[must_use]
pub fn name(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Impacts => "impacts",
        Quantity::PeakEnd => "peak-end",
        Quantity::PeakCenter => "peak-center",
        Quantity::PeakAngular => "peak-angular",
        Quantity::NetCenter => "net-center",
        Quantity::Duration => "duration",
        Quantity::Zone(_) => "zone",
    }
}

/// Works out every point of the grid.
///
/// # Errors
/// Axes in the wrong order, more points than an address has, or a threshold out of bounds.
pub fn answer(question: &Question) -> Result<Answer, Error> {
    let Question { quantity, inertia, e } = *question;
    let threshold = if let Quantity::Zone(threshold) = quantity { Some(threshold) } else { None };
    in_bounds(threshold.as_slice())?;
    // The map comes before the axes, as it refuses those that are too long.
    let map = Map::compute(quantity, inertia, e)?;
    let axis = |axis: Axis| (0..axis.points()).map(|i| Json(axis.value(i))).collect();
    let of = |variable| (inertia.variable() == variable).then(|| axis(inertia));
    Ok(Answer {
        quantity: name(quantity),
        threshold: threshold.map(Json),
        q: of(Variable::InertiaRatio),
        gyration_ratio: of(Variable::GyrationRatio),
        e: axis(e),
        map,
    })
}

fn rows<S: Serializer>(map: &Map, serializer: S) -> Result<S::Ok, S::Error> {
    let counts = map.quantity == Quantity::Impacts;
    serializer.collect_seq(map.values.chunks(map.e.points()).map(|values| Row { values, counts }))
}

struct Row<'a> {
    values: &'a [f64],
    /// True where the values are whole numbers.
    counts: bool,
}

impl Serialize for Row<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.counts {
            serializer.collect_seq(self.values.iter().copied().map(JsonWhole))
        } else {
            serializer.collect_seq(self.values.iter().copied().map(Json))
        }
    }
}
