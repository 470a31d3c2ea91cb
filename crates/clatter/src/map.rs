//! Maps of one quantity over a grid of (q, e), or of gyration ratio and e, for pure translation of symmetric bars.

use crate::symmetric::Symmetric;
use crate::{Bar, Count, Error, Start};
#[cfg(feature = "parallel")]
use rayon::prelude::*;

/// The quantity that a map shows.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Quantity {
    /// Number of impacts; endless is +∞.
    Impacts,
    /// Largest velocity shock at the ends, in v0.
    PeakEnd,
    /// Largest velocity shock at the center, in v0.
    PeakCenter,
    /// Largest change of angular velocity, in v0/L.
    PeakAngular,
    /// Net change of velocity at the center, in v0; 0 at q = 1, where nothing reaches the center.
    NetCenter,
    /// Time of the last impact, in h0/v0.
    Duration,
    /// Safe zone s of a threshold in v0 (Eq. 5, not clipped).
    Zone(f64),
}

/// The quantity that an axis of a grid runs over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Variable {
    /// Inertia ratio q.
    InertiaRatio,
    /// k = ρ/L, radius of gyration over half-length.
    GyrationRatio,
    /// Coefficient of restitution e.
    Restitution,
}

/// An axis of a grid: `points` values from `lo` to `hi`, both included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axis {
    variable: Variable,
    lo: f64,
    hi: f64,
    points: usize,
}

impl Variable {
    fn name(self) -> &'static str {
        match self {
            Self::InertiaRatio => "q",
            Self::GyrationRatio => "gyration ratio",
            Self::Restitution => "e",
        }
    }
}

impl Axis {
    /// Returns an axis over q.
    ///
    /// # Errors
    /// [`Error::Axis`] unless −1 < lo ≤ hi ≤ 1 and there are at least 2 points, or 1 where lo = hi.
    pub fn q(lo: f64, hi: f64, points: usize) -> Result<Self, Error> {
        let reason = "q must lie in (-1, 1]";
        Self::new(Variable::InertiaRatio, lo, hi, points, reason, lo > -1.0 && hi <= 1.0)
    }

    /// Returns an axis over k = ρ/L in place of q = (1 − k²)/(1 + k²): no digit is lost near q = 1.
    ///
    /// # Errors
    /// [`Error::Axis`] unless lo ≤ hi, every value is 0 or in [1e−35, 1e35] and there are at least 2 points, or 1 where
    /// lo = hi.
    pub fn gyration_ratio(lo: f64, hi: f64, points: usize) -> Result<Self, Error> {
        let reason = "the gyration ratio must be 0 or in [1e-35, 1e35]";
        let allowed = |k: f64| k == 0.0 || (1e-35..=1e35).contains(&k);
        let axis = Self::new(Variable::GyrationRatio, lo, hi, points, reason, allowed(lo) && allowed(hi))?;
        // The one after 0 is the smallest of all.
        let all = allowed(axis.value(1));
        all.then_some(axis).ok_or(Error::Axis { name: Variable::GyrationRatio.name(), lo, hi, points, reason })
    }

    /// Returns an axis over e.
    ///
    /// # Errors
    /// [`Error::Axis`] unless 0 ≤ lo ≤ hi ≤ 1 and there are at least 2 points, or 1 where lo = hi.
    pub fn e(lo: f64, hi: f64, points: usize) -> Result<Self, Error> {
        let reason = "e must lie in [0, 1]";
        Self::new(Variable::Restitution, lo, hi, points, reason, lo >= 0.0 && hi <= 1.0)
    }

    fn new(
        variable: Variable,
        lo: f64,
        hi: f64,
        points: usize,
        range: &'static str,
        inside: bool,
    ) -> Result<Self, Error> {
        let error = |reason| Error::Axis { name: variable.name(), lo, hi, points, reason };
        if lo.is_nan() || hi.is_nan() {
            return Err(error("both bounds must be numbers"));
        }
        if lo > hi {
            return Err(error("the first bound must not exceed the last"));
        }
        if !inside {
            return Err(error(range));
        }
        // Two points are needed for two bounds; one will do where they are the same.
        if points == 0 || (points == 1 && lo < hi) {
            return Err(error("at least 2 points are needed, or 1 where both bounds are the same"));
        }
        Ok(Self { variable, lo: lo + 0.0, hi: hi + 0.0, points })
    }

    /// Returns the quantity that the axis runs over.
    #[must_use]
    pub fn variable(&self) -> Variable {
        self.variable
    }

    /// Returns the number of points.
    #[must_use]
    pub fn points(&self) -> usize {
        self.points
    }

    /// Returns the value `i`: `lo + (hi − lo) i/(points − 1)`, exact at both ends.
    #[must_use]
    #[expect(clippy::cast_precision_loss, reason = "a grid has far fewer than 2^53 points")]
    pub fn value(&self, i: usize) -> f64 {
        if i + 1 >= self.points {
            self.hi
        } else {
            (self.lo + (self.hi - self.lo) * (i as f64 / (self.points - 1) as f64)).clamp(self.lo, self.hi)
        }
    }
}

/// A quantity over a grid: `values[i * e.points() + j]` belongs to `q.value(i)`, `e.value(j)`.
#[derive(Debug, Clone, PartialEq)]
pub struct Map {
    /// The quantity.
    pub quantity: Quantity,
    /// Slow axis: over q, or over the gyration ratio in its place ([`Axis::variable`]).
    pub q: Axis,
    /// Fast axis.
    pub e: Axis,
    /// The values.
    pub values: Vec<f64>,
}

/// The most points of a map, 2 GiB of them.
const MOST: usize = 1 << 28;

impl Map {
    /// Computes the map for pure translation, row by row on all threads.
    ///
    /// # Method
    /// Peaks, and the quantities that follow from them, come from the recurrence of the differences d = |a_{n+1}| −
    /// |a_n| of 16 points side by side: `d ← max(0, e d − (1 − q)(1 + e) |a|)`, `|a| ← |a| + d`, which stands still at
    /// the peak. All other quantities, and the few points that rise for more than 64 strikes, come point by point from
    /// [`Bar::summary`] or [`Bar::count`].
    ///
    /// # Accuracy
    /// Every point is as exact as [`Bar::summary`], peaks to [`crate::accuracy::PEAK`].
    ///
    /// # Errors
    /// [`Error::Axis`] where `q` is an axis over e, or `e` is none; [`Error::TooLarge`] beyond 2²⁸ points, or where
    /// their memory is not available; it is asked for once.
    ///
    /// # Examples
    /// ```
    /// use clatter::{Axis, Map, Quantity};
    /// let map = Map::compute(Quantity::Impacts, Axis::q(0.0, 1.0, 3)?, Axis::e(0.0, 1.0, 3)?)?;
    /// let endless = f64::INFINITY;
    /// assert_eq!(map.values, [2.0, 2.0, 2.0, endless, 3.0, 3.0, endless, endless, endless]);
    /// # Ok::<(), clatter::Error>(())
    /// ```
    pub fn compute(quantity: Quantity, q: Axis, e: Axis) -> Result<Self, Error> {
        for (axis, inertia) in [(q, true), (e, false)] {
            if (axis.variable != Variable::Restitution) != inertia {
                let Axis { variable, lo, hi, points } = axis;
                let reason = if inertia { "the slow axis is one of inertia" } else { "the fast axis is one of e" };
                return Err(Error::Axis { name: variable.name(), lo, hi, points, reason });
            }
        }
        let points = q.points.saturating_mul(e.points);
        let mut values = Vec::new();
        if points > MOST || values.try_reserve_exact(points).is_err() {
            return Err(Error::TooLarge(points));
        }
        values.resize(points, 0.0);
        let columns: Vec<f64> = (0..e.points).map(|j| e.value(j)).collect();
        // A task takes rows for about 10 µs at least.
        let rows = 8192_usize.div_ceil(e.points);
        #[cfg(feature = "parallel")]
        let tasks = values.par_chunks_mut(rows * e.points);
        #[cfg(not(feature = "parallel"))]
        let tasks = values.chunks_mut(rows * e.points);
        tasks.enumerate().for_each(|(chunk, values)| {
            for (i, row) in values.chunks_mut(e.points).enumerate() {
                let inertia = q.value(chunk * rows + i);
                let bar = |e| bar(q.variable, inertia, e);
                fill(quantity, bar, &columns, row);
            }
        });
        Ok(Self { quantity, q, e, values })
    }
}

/// Fills one row, of fixed inertia.
fn fill(quantity: Quantity, bar: impl Fn(f64) -> Symmetric, columns: &[f64], row: &mut [f64]) {
    let Symmetric { less, more, .. } = bar(0.0);
    let spread: &dyn Fn(&mut f64) = match quantity {
        Quantity::PeakEnd => &|_| {},
        Quantity::PeakCenter => &|v| *v = if less == 0.0 { 0.0 } else { 0.5 * less * *v },
        Quantity::PeakAngular => &|v| *v *= 0.5 * more,
        Quantity::Zone(threshold) => &move |v| *v = (2.0 * threshold / *v - less) / more,
        Quantity::Impacts | Quantity::Duration | Quantity::NetCenter => {
            let start = Start::default();
            for (v, &e) in row.iter_mut().zip(columns) {
                let bar = bar(e);
                *v = match quantity {
                    Quantity::Duration => bar.summary(&start).duration,
                    Quantity::NetCenter => bar.summary(&start).net.map_or(0.0, |net| net.center),
                    _ => count(bar.count(&start)),
                };
            }
            return;
        }
    };
    peaks(bar, columns, row);
    if quantity != Quantity::PeakEnd {
        row.iter_mut().for_each(spread);
    }
}

/// Points that are carried on together: whole vectors on any machine, and long enough to hide latencies.
const WIDTH: usize = 16;
/// Differences a point may add before it is left to the closed form; 64 roundings stay below 1e−14.
const STEPS: usize = 64;

/// Computes the largest velocity shocks at the ends along a row.
fn peaks(bar: impl Fn(f64) -> Symmetric, columns: &[f64], row: &mut [f64]) {
    let dead = bar(0.0);
    let (q, less) = (dead.q, dead.less);
    // |a_2| ≤ |a_1| for q²(1 + e) ≤ 1, hence at every e.
    if q * q <= 0.499_999 {
        let q = q.max(0.0);
        for (v, &e) in row.iter_mut().zip(columns) {
            *v = (1.0 + e) * (1.0 + q * (1.0 + e));
        }
        return;
    }
    let q = q.max(0.0);
    for (values, es) in row.chunks_mut(WIDTH).zip(columns.chunks(WIDTH)) {
        // A last chunk that is short is filled with e = 0, which never rises.
        let mut e = [0.0; WIDTH];
        e[..es.len()].copy_from_slice(es);
        let (mut a, mut d, mut w) = ([0.0; WIDTH], [0.0; WIDTH], [0.0; WIDTH]);
        for i in 0..WIDTH {
            d[i] = q * (1.0 + e[i]);
            a[i] = 1.0 + d[i];
            w[i] = less * (1.0 + e[i]);
        }
        let mut rises = true;
        for _ in 0..STEPS {
            let mut most = [0.0; WIDTH / 2];
            for i in 0..WIDTH {
                let next = e[i] * d[i] - w[i] * a[i];
                d[i] = if next > 0.0 { next } else { 0.0 };
                a[i] += d[i];
            }
            for i in 0..WIDTH / 2 {
                most[i] = if d[i] > d[i + WIDTH / 2] { d[i] } else { d[i + WIDTH / 2] };
            }
            rises = most.iter().any(|&d| d > 0.0);
            if !rises {
                break;
            }
        }
        for i in 0..values.len() {
            values[i] = (1.0 + e[i]) * a[i];
        }
        if rises {
            for i in 0..values.len() {
                if d[i] > 0.0 {
                    values[i] = bar(e[i]).peak(&Start::default()).end;
                }
            }
        }
    }
}

/// Returns a bar from values that the axes have checked.
fn bar(variable: Variable, inertia: f64, e: f64) -> Symmetric {
    let bar = match variable {
        Variable::GyrationRatio => Bar::from_gyration_ratio(inertia, e),
        Variable::InertiaRatio | Variable::Restitution => Bar::new(inertia, e),
    };
    bar.unwrap_or_else(|error| unreachable!("an axis let it pass: {error}")).symmetric
}

/// Returns the count as a float; endless is +∞.
#[expect(clippy::cast_precision_loss, reason = "rounds to the nearest float")]
fn count(count: Count) -> f64 {
    match count {
        Count::Finite(n) => n as f64,
        Count::Huge(n) => n,
        Count::Endless => f64::INFINITY,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accuracy::PEAK;
    use proptest::prelude::*;

    #[test]
    fn every_quantity_is_that_of_the_summary() {
        let e = Axis::e(0.0, 1.0, 19).unwrap();
        for q in [Axis::q(-0.9, 1.0, 23), Axis::gyration_ratio(0.0, 1.7, 23), Axis::gyration_ratio(1e-35, 1e-9, 3)] {
            every_quantity(q.unwrap(), e);
        }
    }

    fn every_quantity(q: Axis, e: Axis) {
        let start = Start::default();
        for quantity in [
            Quantity::Impacts,
            Quantity::PeakEnd,
            Quantity::PeakCenter,
            Quantity::PeakAngular,
            Quantity::NetCenter,
            Quantity::Duration,
            Quantity::Zone(1.0),
        ] {
            let map = Map::compute(quantity, q, e).unwrap();
            for i in 0..q.points() {
                for j in 0..e.points() {
                    let (inertia, e) = (q.value(i), e.value(j));
                    let bar = match q.variable() {
                        Variable::GyrationRatio => Bar::from_gyration_ratio(inertia, e),
                        _ => Bar::new(inertia, e),
                    }
                    .unwrap();
                    let s = bar.summary(&start);
                    let want = match quantity {
                        Quantity::Impacts => count(s.count),
                        Quantity::PeakEnd => s.peak.end,
                        Quantity::PeakCenter => s.peak.center,
                        Quantity::PeakAngular => s.peak.angular,
                        Quantity::NetCenter => s.net.map_or(0.0, |net| net.center),
                        Quantity::Duration => s.duration,
                        Quantity::Zone(x) => bar.shocks_either(&start).safe_zone(x).s,
                    };
                    let got = map.values[i * map.e.points() + j];
                    let same =
                        got.to_bits() == want.to_bits() || (got - want).abs() <= 2.0 * PEAK.error * want.abs().max(1.0);
                    assert!(same, "{quantity:?} at ({}, {}): {got} not {want}", bar.q(), bar.e());
                }
            }
        }
    }

    proptest! {
        /// Both are allowed `PEAK`, of which the map takes at most its half.
        #[test]
        fn peaks_in_lanes_are_those_of_the_closed_form(q in -0.999..=1.0_f64, x in 0.0..9.0_f64, e in 0.0..=1.0_f64) {
            for q in [q, 1.0 - 10f64.powf(-x)] {
                for e in [e, 1.0 - 0.1 * 10f64.powf(-x)] {
                    let map = Map::compute(Quantity::PeakEnd, Axis::q(q, q, 1).unwrap(), Axis::e(e, e, 1).unwrap());
                    let (got, want) = (map.unwrap().values[0], Bar::new(q, e).unwrap().peak(&Start::default()).end);
                    prop_assert!((got - want).abs() <= 0.5 * PEAK.error * want, "({q}, {e}): {got} not {want}");
                }
            }
        }
    }

    proptest! {
        /// Where q rounds to 1 the gyration ratio still decides.
        #[test]
        fn peaks_over_the_gyration_ratio_are_those_of_the_closed_form(k in -12.0..0.5_f64, x in 0.0..14.0_f64) {
            let (k, e) = (10f64.powf(k), 1.0 - 10f64.powf(-x));
            let map = Map::compute(Quantity::PeakEnd, Axis::gyration_ratio(k, k, 1).unwrap(), Axis::e(e, e, 1).unwrap());
            let want = Bar::from_gyration_ratio(k, e).unwrap().peak(&Start::default()).end;
            prop_assert!((map.unwrap().values[0] - want).abs() <= 0.5 * PEAK.error * want, "({k}, {e})");
        }
    }

    #[test]
    fn axes_in_the_wrong_place_are_refused() {
        let (q, e) = (Axis::q(0.0, 1.0, 2).unwrap(), Axis::e(0.0, 1.0, 2).unwrap());
        let k = Axis::gyration_ratio(0.0, 2.0, 2).unwrap();
        for (slow, fast, reason) in [(e, e, "one of inertia"), (q, q, "one of e"), (q, k, "one of e")] {
            let message = Map::compute(Quantity::PeakEnd, slow, fast).unwrap_err().to_string();
            assert!(message.contains(reason), "{message}");
        }
    }

    #[test]
    fn axes_say_what_is_wrong_with_them() {
        for (axis, reason) in [
            (Axis::q(-1.0, 1.0, 3), "(-1, 1]"),
            (Axis::q(0.5, 0.2, 3), "must not exceed"),
            (Axis::q(f64::NAN, 0.2, 3), "numbers"),
            (Axis::gyration_ratio(-0.1, 1.0, 3), "[1e-35, 1e35]"),
            (Axis::gyration_ratio(0.0, 1e36, 3), "[1e-35, 1e35]"),
            (Axis::gyration_ratio(0.0, 1e-34, 100), "[1e-35, 1e35]"),
            (Axis::e(0.0, 1.1, 3), "[0, 1]"),
            (Axis::e(0.0, 1.0, 1), "at least 2"),
            (Axis::e(0.0, 1.0, 0), "at least 2"),
        ] {
            let message = axis.unwrap_err().to_string();
            assert!(message.contains(reason), "{message}");
        }
        assert_eq!(Axis::e(-0.0, -0.0, 1).unwrap().value(0).to_bits(), 0, "−0 is 0");
    }

    #[test]
    fn too_many_points_are_refused_before_memory_is_touched() {
        let (q, e) = (Axis::q(0.0, 1.0, 1 << 40).unwrap(), Axis::e(0.0, 1.0, usize::MAX).unwrap());
        assert_eq!(Map::compute(Quantity::PeakEnd, q, e), Err(Error::TooLarge(usize::MAX)));
    }
}
