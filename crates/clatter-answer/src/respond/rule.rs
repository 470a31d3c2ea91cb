//! This module computes the peaks of a part of any natural frequency over W h0/v0.
//!
//! ```
//! use clatter::{Bar, Start};
//! use clatter_answer::respond::rule;
//! use clatter_shock::{DampingRatio, Suspension};
//! let part = Suspension::new(3.0, DampingRatio::new(0.05)?)?;
//! let answer = rule::answer(&Bar::new(0.5, 0.3)?, &Start::default(), 1.0, &part)?;
//! // From 0.01 to 1000, with 100 points to a decade.
//! assert_eq!(answer.rule.points.len(), 501);
//! # Ok::<(), clatter_answer::Error>(())
//! ```

use clatter::{Bar, Start};
use clatter_shock::{Rule, RulePoint, Suspension, three_way_rule};
use serde::{Serialize, Serializer};

use super::Factors;
use crate::{Error, Json, on_body};

/// The least and the largest W h0/v0, unless the part lies beyond.
const DRAWN: [f64; 2] = [1e-2, 1e3];
/// The number of points to a decade, and in all.
const POINTS: [f64; 2] = [100.0, 4000.0];

/// The rule. It serializes to a list for each quantity of its points.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Answer {
    /// The rule.
    pub rule: Rule,
}

/// Computes the rule at a position of a bar, over frequencies about that of a part.
///
/// # Errors
/// A position off the bar, a flat drop, which has no rule, or what [`three_way_rule`] refuses.
pub fn answer(bar: &Bar, start: &Start, at: f64, part: &Suspension) -> Result<Answer, Error> {
    on_body([at])?;
    let ratio = part.omega() * start.height_gap() / -start.velocity()[0];
    if ratio == 0.0 {
        let (name, allowed) = ("height gap", "above 0: a flat drop has no rule over W h0/v0");
        return Err(Error::Quantity { name, value: start.height_gap(), allowed });
    }
    Ok(Answer { rule: three_way_rule(bar, start, at, part.damping(), &omegas(ratio))? })
}

/// Returns W h0/v0 of the points.
fn omegas(ratio: f64) -> Vec<f64> {
    let (low, high) = (DRAWN[0].min(0.1 * ratio).max(1e-300), DRAWN[1].max(10.0 * ratio).min(1e300));
    let steps = (POINTS[0] * libm::log10(high / low)).ceil().min(POINTS[1]);
    let mut omegas = Vec::new();
    let mut i = 0.0;
    while i <= steps {
        omegas.push(low * libm::pow(high / low, i / steps));
        i += 1.0;
    }
    omegas
}

#[derive(Serialize)]
struct Columns {
    omega: Vec<Json>,
    displacement: Vec<Json>,
    acceleration: Vec<Json>,
    gain: Vec<Json>,
    soft: Factors,
    stiff: Option<Factors>,
    standard: Factors,
}

impl Serialize for Answer {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Rule { points, soft, stiff, standard, .. } = &self.rule;
        let all = |of: fn(&RulePoint) -> f64| points.iter().map(|p| Json(of(p))).collect();
        let factors = |of| Factors::of(f64::NAN, of);
        Columns {
            omega: all(|p| p.omega),
            displacement: all(|p| p.displacement),
            acceleration: all(|p| p.acceleration),
            gain: all(|p| p.gain),
            soft: factors(*soft),
            stiff: stiff.map(factors),
            standard: factors(*standard),
        }
        .serialize(serializer)
    }
}
