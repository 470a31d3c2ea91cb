//! The curves of Figs. 2 and 5 to 7 in the plane of q and e, solved rather than traced on a grid.
//!
//! The unit square 0 ≤ q ≤ 1, 0 ≤ e ≤ 1 is the design plane of the paper; every start is pure translation.

use clatter::contour::{Point, falling_root, refine};
use clatter::quadrature::{Integral, integrate};
use clatter::{Bar, Start};

/// Returns the curve between n and n + 1 impacts, in `segments` pieces from e = 1 to (0, 0).
///
/// With θ from π/(n + ½) to π/n (Fig. 2; theory: nθ + φ = π):
///
/// ```text
/// √e = −sin nθ / sin (n+1)θ,    q = 2√e cos θ / (1 + e)
/// ```
///
/// Below it there are n impacts or fewer, above it more. For n = 1 it is q = −1/(1 + e), outside the design
/// plane; there is none for n = 0.
///
/// ```
/// // between two and three impacts T² + T = e, so q = (√5 − 1)/4 at e = 1
/// let curve = clatter_studies::contour::impacts(2, 64);
/// assert!((curve[0].q - (5f64.sqrt() - 1.0) / 4.0).abs() < 1e-15);
/// ```
#[must_use]
pub fn impacts(n: u32, segments: u32) -> Vec<Point> {
    let at = |i| {
        let x = f64::from(i) / f64::from(segments.max(1));
        match (n, i) {
            (1, _) => Point { q: -1.0 / (2.0 - x), e: 1.0 - x },
            (_, 0) => Point { e: 1.0, ..impacts_at(n, last_delta(n)) },
            _ => impacts_at(n, last_delta(n) * (1.0 - x)),
        }
    };
    if n == 0 { Vec::new() } else { (0..=segments).map(at).collect() }
}

/// Returns δ = π/n − θ where the curve between n and n + 1 impacts has e = 1, which is θ = π/(n + ½).
fn last_delta(n: u32) -> f64 {
    std::f64::consts::PI / (f64::from(n) * (2.0 * f64::from(n) + 1.0))
}

/// Returns the point of the curve between n and n + 1 impacts at θ = π/n − δ, where √e = sin nδ / sin(π/n − (n+1)δ)
/// keeps its digits for large n.
fn impacts_at(n: u32, delta: f64) -> Point {
    let n = f64::from(n);
    let corner = std::f64::consts::PI / n;
    let root = libm::sin(n * delta) / libm::sin(corner - (n + 1.0) * delta);
    let e = root * root;
    Point { q: 2.0 * root * libm::cos(corner - delta) / (1.0 + e), e }
}

/// Returns the bounding curve of the endless region, q = 2√e/(1 + e), in `segments` pieces from (0, 0) to (1, 1).
///
/// On it and above it the impacts never end (from pure translation). The area above it is π − 3.
///
/// ```
/// let curve = clatter_studies::contour::endless(2);
/// assert_eq!((curve[1].q, curve[1].e), (0.8, 0.25)); // 2 · ½/(1 + ¼)
/// ```
#[must_use]
pub fn endless(segments: u32) -> Vec<Point> {
    let at = |i| {
        let root = f64::from(i) / f64::from(segments.max(1));
        Point { q: 2.0 * root / (1.0 + root * root), e: root * root }
    };
    (0..=segments).map(at).collect()
}

/// Returns the area of the design plane with at most n impacts, the integral of q de along [`impacts`].
///
/// Accuracy: `error` bounds the error of the quadrature, 1e-13 or better.
///
/// ```
/// // all finite counts together fill 4 − π
/// assert!((clatter_studies::contour::area_up_to(10_000).value - (4.0 - std::f64::consts::PI)).abs() < 1e-6);
/// ```
#[must_use]
pub fn area_up_to(n: u32) -> Integral {
    if n < 2 {
        return Integral { value: 0.0, error: 0.0 };
    }
    let m = f64::from(n);
    let corner = std::f64::consts::PI / m;
    let q_de = |delta: f64| {
        let (a, b) = (m * delta, corner - (m + 1.0) * delta);
        let ((sin_a, cos_a), (sin_b, cos_b)) = (libm::sincos(a), libm::sincos(b));
        let root = sin_a / sin_b;
        let de = 2.0 * root * (m * cos_a * sin_b + (m + 1.0) * cos_b * sin_a) / (sin_b * sin_b);
        2.0 * root * libm::cos(corner - delta) / (1.0 + root * root) * de
    };
    integrate(q_de, &[0.0, last_delta(n)], 1e-13)
}

/// The solution on a line of constant q: the position of `level` relative to the safe zone by the peak at the ends.
enum Solution {
    /// s < level for every e.
    Below,
    /// s = level here.
    At(f64),
    /// s > level for every e.
    Above,
}

/// A safe zone of one threshold (in v0), whose levels s = const are curves in the design plane.
///
/// At fixed q the peak at the ends grows with e, so that s falls with e (see [`crate::paper::claims`], which
/// measures it) and each level is a function e(q).
///
/// Accuracy: e is solved to 1e-14 for the peak as computed.
///
/// ```
/// // within 2 v0 the whole bar is safe where (1 + e)(1 + q (1 + e)) ≤ 2: area 1 − ln 2
/// let whole = clatter_studies::contour::SafeZone::new(2.0).area(1.0);
/// assert!((whole.value - (1.0 - 2f64.ln())).abs() < 1e-9);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SafeZone {
    threshold: f64,
}

impl SafeZone {
    /// Creates the safe zone of `threshold`, in v0.
    #[must_use]
    pub fn new(threshold: f64) -> Self {
        Self { threshold }
    }

    /// Returns 1/peak at the ends, which is finite at (1, 1) too.
    fn inverse_peak(q: f64, e: f64) -> f64 {
        Bar::new(q, e).map_or(f64::NAN, |bar| 1.0 / bar.summary(&Start::default()).peak.end)
    }

    /// Solves Eq. 5, s = level, for e at fixed q, as 1/peak = (level (1 + q) + 1 − q)/(2 threshold).
    fn solve(self, level: f64, q: f64) -> Solution {
        let wanted = (level * (1.0 + q) + 1.0 - q) / (2.0 * self.threshold);
        let excess = |e| Self::inverse_peak(q, e) - wanted;
        let (low, high) = (excess(0.0), excess(1.0));
        if low < 0.0 {
            Solution::Below
        } else if high > 0.0 {
            Solution::Above
        } else {
            Solution::At(falling_root(excess, low, high))
        }
    }

    /// Returns the e at which s = `level` on the line of constant q, `None` where no e in [0, 1] has it.
    #[must_use]
    pub fn restitution(self, level: f64, q: f64) -> Option<f64> {
        match self.solve(level, q) {
            Solution::At(e) => Some(e),
            Solution::Below | Solution::Above => None,
        }
    }

    /// Returns the values of q, ascending, between which the level curve stays inside the square or outside it.
    fn breaks(self, level: f64) -> Vec<f64> {
        let side = |q| match self.solve(level, q) {
            Solution::Below => -1,
            Solution::At(_) => 0,
            Solution::Above => 1,
        };
        let mut breaks = vec![0.0];
        for i in 0..SCAN {
            let (mut a, mut b) = (f64::from(i) / f64::from(SCAN), f64::from(i + 1) / f64::from(SCAN));
            let left = side(a);
            if side(b) == left {
                continue;
            }
            while (b - a) > f64::EPSILON * b {
                let middle = 0.5 * (a + b);
                *(if side(middle) == left { &mut a } else { &mut b }) = middle;
            }
            breaks.push(0.5 * (a + b));
        }
        breaks.push(1.0);
        breaks
    }

    /// Returns the curve s = `level` inside the square, in connected pieces with q ascending, such that the true curve
    /// stays within about `flatness` of the chords. Pieces end exactly on the border.
    #[must_use]
    pub fn curve(self, level: f64, flatness: f64) -> Vec<Vec<Point>> {
        let at = |q| match self.solve(level, q) {
            Solution::Below => Point { q, e: 0.0 },
            Solution::At(e) => Point { q, e },
            Solution::Above => Point { q, e: 1.0 },
        };
        let inside = |a: f64, b: f64| matches!(self.solve(level, 0.5 * (a + b)), Solution::At(_));
        let mut pieces = Vec::new();
        for pair in self.breaks(level).windows(2) {
            let &[a, b] = pair else { continue };
            let (start, end) = (at(a), at(b));
            // at (1, 1) every zone has s = 0, without a curve
            if b - a > f64::EPSILON * 4.0 && inside(a, b) {
                let mut piece = vec![start];
                refine(&at, start, end, flatness, &mut piece);
                pieces.push(piece);
            }
        }
        pieces
    }

    /// Returns the area of the design plane where s ≥ `level`: the integral of e(q) along the exact curve.
    ///
    /// Accuracy: `error` bounds the error of the quadrature, 1e-9 or better.
    #[must_use]
    pub fn area(self, level: f64) -> Integral {
        let e = |q| match self.solve(level, q) {
            Solution::Below => 0.0,
            Solution::At(e) => e,
            Solution::Above => 1.0,
        };
        integrate(e, &self.breaks(level), 1e-10)
    }
}

/// Steps of the search along q for places where a level curve leaves the square; a piece shorter in q is missed.
const SCAN: u32 = 512;

#[cfg(test)]
mod tests {
    use super::*;
    use clatter::{Count, Restitution};

    fn count(q: f64, e: f64) -> Count {
        Bar::new(q.min(1.0), e).unwrap().count(&Start::default())
    }

    #[test]
    fn the_count_turns_on_the_curve() {
        for n in [1, 2, 3, 4, 7, 30] {
            for point in impacts(n, 40).iter().filter(|p| p.e > 1e-6) {
                let e = Restitution::new(point.e).unwrap().get();
                assert_eq!(count(point.q - 1e-12, e), Count::Finite(n.into()), "below curve {n} at {point:?}");
                assert_eq!(count(point.q + 1e-12, e), Count::Finite(u64::from(n) + 1), "above curve {n} at {point:?}");
            }
        }
        for point in &endless(40)[1..40] {
            assert_eq!(count(point.q + 1e-12, point.e), Count::Endless, "above {point:?}");
            assert_ne!(count(point.q - 1e-12, point.e), Count::Endless, "below {point:?}");
        }
    }

    #[test]
    fn curves_run_from_border_to_border() {
        assert!(impacts(0, 8).is_empty(), "there is no train without an impact");
        for n in 2..40 {
            let curve = impacts(n, 16);
            assert_eq!((curve.len(), curve[0].e), (17, 1.0), "curve {n}");
            assert_eq!(curve[16], Point { q: 0.0, e: 0.0 }, "curve {n}");
            assert!(curve.windows(2).all(|w| w[1].e < w[0].e && w[1].q < w[0].q), "curve {n} rises in both");
        }
    }

    #[test]
    fn areas_have_their_closed_forms() {
        // n = 2: q = (√(1 + 4e) − 1)/(2(1 + e)), integrated with u = √(1 + 4e)
        let two = 5f64.sqrt()
            - 1.0
            - 3f64.sqrt() * ((5f64 / 3.0).sqrt().atan() - (1f64 / 3.0).sqrt().atan())
            - 0.5 * 2f64.ln();
        assert!((area_up_to(2).value - two).abs() < 1e-14, "{:?}, not {two}", area_up_to(2));
        for n in 2..60 {
            assert!(area_up_to(n).error <= 1e-13, "{n}: {:?}", area_up_to(n));
        }
        // All finite counts together fill 4 − π; the rest beyond n falls like 1/n².
        let left = |n: u32| 4.0 - std::f64::consts::PI - area_up_to(n).value;
        assert!((left(2000) * 4.0 / left(1000) - 1.0).abs() < 0.01, "{} {}", left(1000), left(2000));
        // no zone within v0: between the roots of q²(1+e)² − q e (1+e) + 1 − e = 0
        let from = 8f64.sqrt() - 2.0;
        let width = |e: f64| (e * e + 4.0 * e - 4.0).max(0.0).sqrt() / (1.0 + e);
        let bare = integrate(width, &[from, 1.0], 1e-12).value;
        assert!((1.0 - SafeZone::new(1.0).area(0.0).value - bare).abs() < 1e-9, "{bare}");
    }

    #[test]
    fn a_level_curve_has_its_level_and_ends_on_the_border() {
        for (threshold, level) in [(0.5, 0.0), (0.5, 0.05), (0.5, 0.2), (1.0, 0.0), (1.0, 0.4), (2.0, 0.1), (2.0, 1.0)]
        {
            let pieces = SafeZone::new(threshold).curve(level, 1e-4);
            assert!(!pieces.is_empty(), "s({threshold}) = {level}");
            for piece in pieces {
                for p in &piece {
                    let s = Bar::new(p.q, p.e).unwrap().shocks_either(&Start::default()).safe_zone(threshold).s;
                    assert!((s - level).abs() < 1e-12, "s({threshold}) = {s} at {p:?}");
                }
                for p in [piece[0], piece[piece.len() - 1]] {
                    let border = [p.q, p.e, 1.0 - p.q, 1.0 - p.e].into_iter().any(|d| d.abs() < 1e-12);
                    assert!(border, "the curve {level} of {threshold} ends inside, at {p:?}");
                }
            }
        }
    }

    #[test]
    fn a_curve_is_as_flat_as_asked() {
        for flatness in [1e-2, 1e-3, 1e-4, 1e-5] {
            let zone = SafeZone::new(0.5);
            for w in zone.curve(0.02, flatness).concat().windows(2) {
                for x in [0.25, 0.5, 0.75] {
                    let q = w[0].q + (w[1].q - w[0].q) * x;
                    let off = zone.restitution(0.02, q).unwrap() - (w[0].e + (w[1].e - w[0].e) * x);
                    let (dq, de) = (w[1].q - w[0].q, w[1].e - w[0].e);
                    let distance = (off * dq).abs() / dq.hypot(de);
                    assert!(distance < 2.0 * flatness, "{distance} off between {w:?}, {flatness} allowed");
                }
            }
        }
    }
}
