//! Curves in the plane of q and e, solved rather than traced on a grid.
//!
//! The unit square 0 ≤ q ≤ 1, 0 ≤ e ≤ 1 is the design plane of the paper; every start is pure translation.

use crate::quadrature::{Integral, integrate};
use crate::{Bar, Start};

/// A point of the design plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Inertia ratio.
    pub q: f64,
    /// Restitution.
    pub e: f64,
}

/// The curve between n and n + 1 impacts, in `segments` pieces from e = 1 to (0, 0).
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
/// let curve = clatter::contour::impacts(2, 64);
/// assert!((curve[0].q - (5f64.sqrt() - 1.0) / 4.0).abs() < 1e-15);
/// ```
#[must_use]
pub fn impacts(n: u32, segments: u32) -> Vec<Point> {
    let steps = 0..=if n == 0 { 0 } else { segments };
    let curve = |i| {
        let x = f64::from(i) / f64::from(segments.max(1));
        if n == 1 {
            return Point { q: -1.0 / (2.0 - x), e: 1.0 - x };
        }
        match i {
            0 => Point { q: impacts_at(n, theta_range(n).0).q, e: 1.0 },
            i if i == segments => Point { q: 0.0, e: 0.0 },
            _ => {
                let (from, to) = theta_range(n);
                impacts_at(n, from + (to - from) * x)
            }
        }
    };
    if n == 0 { Vec::new() } else { steps.map(curve).collect() }
}

/// θ where the curve between n and n + 1 impacts has e = 1 and e = 0.
fn theta_range(n: u32) -> (f64, f64) {
    let n = f64::from(n);
    (std::f64::consts::PI / (n + 0.5), std::f64::consts::PI / n)
}

/// The point of the curve between n and n + 1 impacts at θ.
fn impacts_at(n: u32, theta: f64) -> Point {
    let n = f64::from(n);
    let root = -(n * theta).sin() / ((n + 1.0) * theta).sin();
    let e = root * root;
    Point { q: 2.0 * root * theta.cos() / (1.0 + e), e }
}

/// The bounding curve of the endless region, q = 2√e/(1 + e), in `segments` pieces from (0, 0) to (1, 1).
///
/// On it and above it the impacts never end (from pure translation).
#[must_use]
pub fn endless(segments: u32) -> Vec<Point> {
    let at = |i| {
        let root = f64::from(i) / f64::from(segments.max(1));
        Point { q: 2.0 * root / (1.0 + root * root), e: root * root }
    };
    (0..=segments).map(at).collect()
}

/// Area of the design plane with at most n impacts, the integral of q de along [`impacts`].
///
/// Accuracy: `error` bounds what the quadrature leaves, 1e-13 or better.
#[must_use]
pub fn area_up_to(n: u32) -> Integral {
    if n < 2 {
        return Integral { value: 0.0, error: 0.0 };
    }
    let (from, to) = theta_range(n);
    let m = f64::from(n);
    let q_de = |theta: f64| {
        let (a, b) = (m * theta, (m + 1.0) * theta);
        let root = -a.sin() / b.sin();
        let slope = 2.0 * root * ((m + 1.0) * b.cos() * a.sin() - m * a.cos() * b.sin()) / b.sin().powi(2);
        -2.0 * root * theta.cos() / (1.0 + root * root) * slope
    };
    integrate(q_de, &[from, to], 1e-14)
}

/// Where on the line of constant q the peak at the ends puts the safe zone at `level`.
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
/// let whole = clatter::contour::SafeZone::new(2.0).area(1.0);
/// assert!((whole.value - (1.0 - 2f64.ln())).abs() < 1e-9);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SafeZone {
    threshold: f64,
}

impl SafeZone {
    /// The safe zone of `threshold`, in v0.
    #[must_use]
    pub fn new(threshold: f64) -> Self {
        Self { threshold }
    }

    /// The level s where e = 1 − x... of the line q: 1/peak at (q, e), finite at (1, 1) too.
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

    /// The e at which s = `level` on the line of constant q, `None` where no e in [0, 1] has it.
    #[must_use]
    pub fn restitution(self, level: f64, q: f64) -> Option<f64> {
        match self.solve(level, q) {
            Solution::At(e) => Some(e),
            Solution::Below | Solution::Above => None,
        }
    }

    /// The values of q, ascending, between which the level curve stays inside the square or outside it.
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

    /// The curve s = `level` inside the square, in connected pieces with q ascending, such that the true curve
    /// stays within about `flatness` of the chords. Pieces end on the border, not beside it.
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
            if a < b && inside(a, b) {
                let (start, end) = (at(a), at(b));
                let mut piece = vec![start];
                refine(&at, start, end, flatness, 0, &mut piece);
                pieces.push(piece);
            }
        }
        pieces
    }

    /// Area of the design plane where s ≥ `level`: the integral of e(q) along the exact curve.
    ///
    /// Accuracy: `error` bounds what the quadrature leaves, 1e-9 or better.
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

/// The root in [0, 1] of a falling function with values `low ≥ 0 ≥ high` at the ends, to 1e-14, by regula falsi
/// in the form of Illinois, which bisects where it stalls.
fn falling_root(f: impl Fn(f64) -> f64, low: f64, high: f64) -> f64 {
    let (mut a, mut fa, mut b, mut fb) = (0.0, low, 1.0, high);
    for step in 0..200 {
        if b - a <= 1e-14 || fa == 0.0 {
            return a;
        }
        let x = if step % 4 == 3 { 0.5 * (a + b) } else { (a * fb - b * fa) / (fb - fa) };
        let x = x.clamp(a, b);
        let fx = f(x);
        if fx == 0.0 {
            return x;
        }
        if fx > 0.0 {
            (a, fa, fb) = (x, fx, 0.5 * fb);
        } else {
            (b, fb, fa) = (x, fx, 0.5 * fa);
        }
    }
    0.5 * (a + b)
}

/// Adds points between `a` and `b`, and `b`, until the middle lies within `flatness` of the chord.
fn refine(at: &impl Fn(f64) -> Point, a: Point, b: Point, flatness: f64, depth: u32, out: &mut Vec<Point>) {
    let m = at(0.5 * (a.q + b.q));
    let (dq, de) = (b.q - a.q, b.e - a.e);
    let off = (dq * (m.e - a.e) - de * (m.q - a.q)).abs();
    if depth < 4 || (depth < 16 && off > flatness * dq.hypot(de)) {
        refine(at, a, m, flatness, depth + 1, out);
        refine(at, m, b, flatness, depth + 1, out);
    } else {
        out.push(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tmp() {
        for n in 2..8 {
            eprintln!("{n} {:?}", area_up_to(n));
        }
        let t = std::time::Instant::now();
        for (x, l) in [(0.5, 0.0), (0.5, 0.1), (1.0, 0.0), (1.0, 0.5), (2.0, 1.0), (2.0, 0.5)] {
            let z = SafeZone::new(x);
            let c = z.curve(l, 1e-4);
            eprintln!("{x} {l}: {:?} {:?}", c.iter().map(|c| (c.len(), c[0], c[c.len() - 1])).collect::<Vec<_>>(), z.area(l));
            eprintln!("{:?}", t.elapsed());
        }
    }
}
