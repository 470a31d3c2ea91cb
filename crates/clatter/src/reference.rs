//! Eqs. 1 to 3 of the paper as they are printed, with vectors and matrices, for a center of mass in the middle. They
//! are the plain reference for tests of the fast ways. Each impact takes one matrix power, so a train of N impacts
//! costs O(N²): this module is for reading, not for use.

use nalgebra::{Matrix2, RowVector2, Vector2};

/// Returns `A = [[−e, 0], [q(1 + e), 1]]`, which gives the velocities [`v_a`, `v_b`] after a strike at end a.
#[must_use]
pub fn strike(q: f64, e: f64) -> Matrix2<f64> {
    Matrix2::new(-e, 0.0, q * (1.0 + e), 1.0)
}

/// Returns `P = [[0, 1], [1, 0]]`, which exchanges the ends.
#[must_use]
pub fn exchange() -> Matrix2<f64> {
    Matrix2::new(0.0, 1.0, 1.0, 0.0)
}

/// Returns the velocities after impact `i` (Eq. 1): `P(PA)ⁱ v0` for odd i, `(PA)ⁱ v0` for even i.
///
/// # Accuracy
/// Some i roundings relative to the largest velocity so far; none guaranteed relative to a small one.
///
/// # Examples
/// ```
/// let v = clatter::reference::velocities(0.5, 0.0, [-1.0, -1.0].into(), 1);
/// assert_eq!((v.x, v.y), (0.0, -1.5));
/// ```
#[must_use]
pub fn velocities(q: f64, e: f64, v0: Vector2<f64>, i: u32) -> Vector2<f64> {
    let (p, a) = (exchange(), strike(q, e));
    let v = (p * a).pow(i) * v0;
    if i % 2 == 1 { p * v } else { v }
}

/// Returns the jumps of both ends at impact `i` ≥ 1 (Eq. 2): `(A − I)(PA)^{i−1} v0` for odd i, P times that for even i.
#[must_use]
pub fn jumps(q: f64, e: f64, v0: Vector2<f64>, i: u32) -> Vector2<f64> {
    let (p, a) = (exchange(), strike(q, e));
    let jump = (a - Matrix2::identity()) * (p * a).pow(i - 1) * v0;
    if i % 2 == 1 { jump } else { p * jump }
}

/// Returns the velocity shock at position `l/L` in [−1, 1] (Eq. 3): `[(L − l)/2L, (L + l)/2L] · Δv`.
#[must_use]
pub fn shock_at(jump: Vector2<f64>, l: f64) -> f64 {
    (RowVector2::new(0.5 * (1.0 - l), 0.5 * (1.0 + l)) * jump).x
}

/// Returns the change of angular velocity (Eq. 3), in v0/L: `[−1/2, 1/2] · Δv`.
#[must_use]
pub fn angular_change(jump: Vector2<f64>) -> f64 {
    (RowVector2::new(-0.5, 0.5) * jump).x
}
