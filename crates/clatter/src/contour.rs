//! Points of curves in the plane of q and e, and their solvers: curves are solved, not traced on a grid.
//!
//! The unit square 0 ≤ q ≤ 1, 0 ≤ e ≤ 1 is the design plane of the paper; every start is pure translation.

/// A point of the design plane.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Point {
    /// Inertia ratio.
    pub q: f64,
    /// Restitution.
    pub e: f64,
}

/// Returns the root in [0, 1] of a falling function with values `low ≥ 0 ≥ high` at the ends, to 1e-14. The method is
/// regula falsi in the form of Illinois, with bisection where that stalls.
///
/// ```
/// let half = clatter::contour::falling_root(|x| 0.25 - x * x, 0.25, -0.75);
/// assert!((half - 0.5).abs() < 1e-14);
/// ```
pub fn falling_root(f: impl Fn(f64) -> f64, low: f64, high: f64) -> f64 {
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

/// Adds points between `a` and `b`, and `b`, until three probes between lie within `flatness` of the chord.
///
/// ```
/// use clatter::contour::{Point, refine};
/// let parabola = |q: f64| Point { q, e: q * q };
/// let mut curve = vec![parabola(0.0)];
/// refine(&parabola, parabola(0.0), parabola(1.0), 1e-3, &mut curve);
/// assert_eq!((curve[curve.len() - 1], curve.len()), (Point { q: 1.0, e: 1.0 }, 17));
/// ```
pub fn refine(at: &impl Fn(f64) -> Point, a: Point, b: Point, flatness: f64, out: &mut Vec<Point>) {
    halve(at, a, b, flatness, 0, out);
}

fn halve(at: &impl Fn(f64) -> Point, a: Point, b: Point, flatness: f64, depth: u32, out: &mut Vec<Point>) {
    let m = at(0.5 * (a.q + b.q));
    let (dq, de) = (b.q - a.q, b.e - a.e);
    let off = |p: Point| (dq * (p.e - a.e) - de * (p.q - a.q)).abs() > flatness * libm::hypot(dq, de);
    let bent = || off(m) || off(at(0.75 * a.q + 0.25 * b.q)) || off(at(0.25 * a.q + 0.75 * b.q));
    if depth < 3 || (depth < 24 && bent()) {
        halve(at, a, m, flatness, depth + 1, out);
        halve(at, m, b, flatness, depth + 1, out);
    } else {
        out.push(b);
    }
}
