//! Maps of one quantity over a grid of (q, e).

use crate::{Bar, Count, Error, Start};

/// What a map shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Quantity {
    /// Number of impacts; endless is +∞.
    Impacts,
    /// Largest velocity shock at the ends, in v0.
    PeakEnd,
    /// Largest velocity shock at the center, in v0.
    PeakCenter,
    /// Largest change of angular velocity, in v0/L.
    PeakAngular,
    /// Net change of velocity at the center, in v0.
    NetCenter,
    /// Time of the last impact, in h0/v0.
    Duration,
    /// Safe zone s of a threshold in v0 (Eq. 5, not clipped).
    Zone(f64),
}

/// An axis of a grid: `points` values from `lo` to `hi`, both included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axis {
    lo: f64,
    hi: f64,
    points: usize,
}

impl Axis {
    /// An axis over q.
    /// # Errors
    /// [`Error::Axis`] unless −1 < lo ≤ hi ≤ 1 and there are at least 2 points (or 1 with lo = hi).
    pub fn q(lo: f64, hi: f64, points: usize) -> Result<Self, Error> {
        Ok(Self { lo, hi, points })
    }
    /// An axis over e.
    /// # Errors
    /// [`Error::Axis`] unless 0 ≤ lo ≤ hi ≤ 1 and there are at least 2 points (or 1 with lo = hi).
    pub fn e(lo: f64, hi: f64, points: usize) -> Result<Self, Error> {
        Ok(Self { lo, hi, points })
    }
    /// Number of points.
    #[must_use]
    pub fn points(&self) -> usize {
        self.points
    }
    /// Value `i`: `lo + (hi − lo) i/(points − 1)`, exact at both ends.
    #[must_use]
    #[expect(clippy::cast_precision_loss, reason = "a grid has far fewer than 2^53 points")]
    pub fn value(&self, i: usize) -> f64 {
        if i + 1 == self.points {
            self.hi
        } else {
            self.lo + (self.hi - self.lo) * (i as f64 / (self.points - 1) as f64)
        }
    }
}

/// A quantity over a grid: `values[i * e.points() + j]` belongs to `q.value(i)`, `e.value(j)`.
#[derive(Debug, Clone, PartialEq)]
pub struct Map {
    /// The quantity.
    pub quantity: Quantity,
    /// Slow axis.
    pub q: Axis,
    /// Fast axis.
    pub e: Axis,
    /// The values.
    pub values: Vec<f64>,
}

impl Map {
    /// Computes the map for pure translation, on all threads.
    /// # Errors
    /// [`Error::TooLarge`] if the memory is not to be had.
    #[expect(clippy::cast_precision_loss, reason = "rounds to the nearest float")]
    pub fn compute(quantity: Quantity, q: Axis, e: Axis) -> Result<Self, Error> {
        let start = Start::default();
        let mut values = Vec::new();
        for i in 0..q.points {
            for j in 0..e.points {
                let bar = Bar::new(q.value(i), e.value(j))?;
                let s = bar.summary(&start);
                values.push(match quantity {
                    Quantity::Impacts => match s.count {
                        Count::Finite(n) => n as f64,
                        Count::Huge(n) => n,
                        Count::Endless => f64::INFINITY,
                    },
                    Quantity::PeakEnd => s.peak.end,
                    Quantity::PeakCenter => s.peak.center,
                    Quantity::PeakAngular => s.peak.angular,
                    Quantity::NetCenter => s.net.map_or(0.0, |n| n.center),
                    Quantity::Duration => s.duration,
                    Quantity::Zone(x) => bar.safe_zone(&start, x).s,
                });
            }
        }
        Ok(Self { quantity, q, e, values })
    }
}
