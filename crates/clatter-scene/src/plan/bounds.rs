//! What can still come, by the energy that is left.

use super::ends::Ends;
use super::floats::{greater, lesser};
use super::swing::Swing;

/// Bound on the shocks to come of a bar whose speed at the component stays below `speed`: by one contact, which throws
/// back (1 + e) of it, or by both together, about; with e = 1 whatever overlaps.
pub(super) fn later_shock(speed: f64, e: f64, gravity: f64, contact_s: f64) -> f64 {
    (1.0 + e) * speed + gravity * contact_s
}

/// What `times` shocks, each of which throws back (1 + e) of the speed at the component, may add to the response,
/// about, and the weight that the ground carries in the end.
pub(super) fn later_response(swing: &Swing, speed: f64, e: f64, times: f64, fall: f64) -> f64 {
    times * (1.0 + e) * swing.factor * speed + weight(swing, fall)
}

/// What the weight does to the response when the ground takes it up at once.
pub(super) fn weight(swing: &Swing, fall: f64) -> f64 {
    (1.0 + swing.factor) * fall
}

/// How many times the largest later shock all later ones may do together; `most` as the speeds allow.
///
/// The pushes sum to a velocity that stays below the speed, and to the weight: by parts, the response is at most that
/// speed times all that the response to one shock goes up and down ([`Swing::pile`]). `upward`: where both ends push
/// the same way, the ground gives, while the component dies down in 1/(ζω), no more than the weight does in that time,
/// beside what stops and throws back the bar.
pub(super) fn pile(most: f64, swing: &Swing, speed: f64, fall: f64, upward: bool) -> f64 {
    let net = if upward { 1.0 + fall / (2.0 * speed * swing.zeta()) } else { f64::INFINITY };
    greater(lesser(net, lesser(swing.pile, most)), 1.0)
}

/// The same, about, of a bar that comes to rest: until then, in a time of some `(2 most + 1) speed/g`, it does not get
/// far, which counts at low speeds.
pub(super) fn pile_until_rest(most: f64, swing: &Swing, speed: f64, fall: f64, upward: bool) -> f64 {
    let brief = (most + 0.5) * speed / (swing.factor * fall);
    greater(lesser(brief, pile(most, swing, speed, fall, upward)), 1.0)
}

/// What the speeds alone allow: they fall by λ = max(√e, λ₊) a strike or faster, which sums to 1/(1 − λ).
pub(super) fn largest_pile(ends: &Ends) -> f64 {
    // The pair of ends moves as that of an even bar of the mean ratio; where one lifts the other, T is below 0.
    let t = (ends.flat[0] * ends.flat[1]).max(0.0).sqrt() * (1.0 + ends.e);
    let root = 0.5 * (t + (t * t - 4.0 * ends.e).max(0.0).sqrt());
    let decay = root.max(ends.e.sqrt());
    if decay < 1.0 { 1.0 / (1.0 - decay) } else { f64::INFINITY }
}
