//! First zeros that cannot be missed: advance by what a bound on the second derivative proves.
//!
//! Where f ≥ 0 with slope s, and f″ ≥ −M from here on, f stays positive up to the root of `f + s x − ½ M x²`. Stepping
//! there again and again never passes a zero, whatever f does in between, and near a simple zero the error of a step
//! is `(f″ + M) x²/2`: quadratic, as Newton's. The zero is approached from the left and taken once; there is no
//! tolerance, the steps end when they no longer change the time. What decides is the value computed for f, so an f
//! written without cancellation gives a zero of any size to its last digits. Where f only grazes zero, within the
//! rounding of f, either answer is right.

/// The largest step that is proven to stay above zero; infinite where nothing pulls down.
pub(super) fn safe_step(f: f64, slope: f64, bound: f64) -> f64 {
    // `hypot` takes five times as long, and only tiny speeds need it.
    let square = slope * slope + 2.0 * bound * f;
    let root = if square.is_normal() { square.sqrt() } else { slope.hypot((2.0 * bound * f).sqrt()) };
    if slope > 0.0 { (slope + root) / bound } else { 2.0 * f / (root - slope) }
}

/// Steps towards a grazing zero shrink by a constant factor only; this many bring any f64 to its last digit.
pub(super) const STEPS: usize = 2000;

/// First zero of f at or after `t`, where f is positive before; `None` if there is none before `cap`.
///
/// `f(t)` gives value and slope, `step(t, f, slope)` a step that is proven to be free of zeros.
pub(super) fn first_zero(
    mut t: f64,
    cap: f64,
    f: impl Fn(f64) -> (f64, f64),
    step: impl Fn(f64, f64, f64) -> f64,
) -> Option<f64> {
    for _ in 0..STEPS {
        let (value, slope) = f(t);
        if value <= 0.0 {
            break;
        }
        let next = t + step(t, value, slope);
        if next >= cap {
            return None;
        }
        if next <= t {
            break;
        }
        t = next;
    }
    Some(t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_of_many_zeros_is_taken_even_if_the_next_is_close() {
        // (t − 1)(t − 1 − gap) has two zeros a gap apart.
        for gap in [1e-3, 1e-6, 1e-9, 1e-12] {
            let f = |t: f64| ((t - 1.0) * (t - 1.0 - gap), 2.0 * (t - 1.0) - gap);
            // f″ = 2 ≥ −1: a bound far from the truth still misses nothing.
            let zero = first_zero(0.0, f64::INFINITY, f, |_, v, s| safe_step(v, s, 1.0)).unwrap();
            assert!((zero - 1.0).abs() <= 2.0 * f64::EPSILON, "gap {gap:e}: {zero}");
        }
    }
    #[test]
    fn a_dip_that_stays_above_zero_is_passed() {
        let f = |t: f64| ((t - 1.0).powi(2) * (5.0 - t) + 1e-12, (t - 1.0) * (11.0 - 3.0 * t));
        let zero = first_zero(0.0, f64::INFINITY, f, |_, v, s| safe_step(v, s, 40.0)).unwrap();
        assert!((zero - 5.0).abs() < 1e-12, "{zero}");
    }
    #[test]
    fn nothing_pulls_down_and_nothing_is_found() {
        assert_eq!(first_zero(0.0, f64::INFINITY, |t| (1.0 + t, 1.0), |_, v, s| safe_step(v, s, 0.0)), None);
    }
}
