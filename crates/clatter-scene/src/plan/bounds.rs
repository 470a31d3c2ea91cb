//! What can still come, by the energy that is left.

use super::lane::Ends;
use super::swing::Swing;

/// The smaller one, and b for a NaN: one instruction, where `f64::min` takes five.
#[inline]
pub(super) fn lesser(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The larger one, and b for a NaN.
#[inline]
pub(super) fn greater(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// Bound on the shocks to come of a bar whose speed at the component stays below `speed`: from one side to the other, by one contact
/// or by both together.
pub(super) fn later_shock(speed: f64, gravity: f64, contact_s: f64) -> f64 {
    2.0 * speed + gravity * contact_s
}

/// What the same may add to the response, about: one such shock, and the weight that the ground carries in the end.
pub(super) fn later_response(swing: &Swing, speed: f64, gravity: f64, omega: f64) -> f64 {
    2.0 * swing.factor * speed + weight(swing, gravity / omega)
}

/// What the weight does to the response when the ground takes it up at once.
pub(super) fn weight(swing: &Swing, fall: f64) -> f64 {
    (1.0 + swing.factor) * fall
}

/// How many times the largest later shock all later ones may do together: speeds fall by λ = max(√e, λ₊) a strike or faster, which
/// allows 1/(1 − λ); and while the component dies down, in 1/(ζω), the ground gives no more than the weight does in that time, beside
/// what stops and throws back the bar.
pub(super) fn pile(ends: &Ends, zeta: f64, speed: f64, fall: f64) -> f64 {
    piled(largest_pile(ends), zeta, speed, fall)
}

/// The same of a bar whose speeds allow `most`.
pub(super) fn piled(most: f64, zeta: f64, speed: f64, fall: f64) -> f64 {
    greater(lesser(1.0 + fall / (2.0 * speed * zeta), most), 1.0)
}

/// What the speeds alone allow.
pub(super) fn largest_pile(ends: &Ends) -> f64 {
    // The pair of ends moves as that of an even bar of the mean ratio; where one lifts the other, T is below 0.
    let t = (ends.flat[0] * ends.flat[1]).max(0.0).sqrt() * (1.0 + ends.e);
    let root = 0.5 * (t + (t * t - 4.0 * ends.e).max(0.0).sqrt());
    let decay = root.max(ends.e.sqrt());
    if decay < 1.0 { 1.0 / (1.0 - decay) } else { f64::INFINITY }
}
