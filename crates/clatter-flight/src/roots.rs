//! First zeros that cannot be missed: each step is proven by bounds on the derivatives.
//!
//! Where f ≥ 0 with slope s, and f″ ≥ −M from here on, f stays positive up to the root of `f + s x − ½ M x²`. Within a
//! reach r of that order the second derivative b at hand proves more, with |f‴| ≤ J from here on:
//! `f ≥ f + s x − ½ (J r/3 − b) x²`. Stepping there again and again never passes a zero, whatever f does in between,
//! and near a simple zero the error of a step is of the order of `J x³`: one order more than Newton's. The zero is
//! approached from the left and taken once; there is no tolerance, the steps end when they no longer change the time.
//! The computed value of f decides, so an f written without cancellation gives a zero of any size to its last digits.
//! Where f only grazes zero, within the rounding of f, either answer is right.

/// Returns the largest step that is proven to stay above zero; infinite where nothing pulls down.
pub(crate) fn safe_step(f: f64, slope: f64, bound: f64) -> f64 {
    // `hypot` takes five times as long, and only tiny speeds need it.
    let square = slope * slope + 2.0 * bound * f;
    let root = if square.is_normal() { square.sqrt() } else { libm::hypot(slope, (2.0 * bound * f).sqrt()) };
    if slope > 0.0 { (slope + root) / bound } else { 2.0 * f / (root - slope) }
}

/// A step that is proven to stay above zero.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Step {
    pub(crate) by: f64,
    /// Bound on the distance of the zero beyond it; infinite where that is not known.
    pub(crate) short: f64,
}

impl Step {
    /// Creates a step that bounds no zero.
    pub(crate) fn clear(by: f64) -> Self {
        Self { by, short: f64::INFINITY }
    }
    /// Returns the longer one.
    pub(crate) fn max(self, other: f64) -> Self {
        if other > self.by { Self::clear(other) } else { self }
    }
    /// Returns whether the zero is closer to a time `t` than a rounding of it.
    pub(crate) fn arrives(self, t: f64) -> bool {
        self.short <= 0.5 * f64::EPSILON * t
    }
}

/// Returns the step by the bend f″ at hand and a bound on |f‴|.
pub(crate) fn far_step([f, slope, bend]: [f64; 3], bound: f64, jerk: f64) -> Step {
    let mut step = Step::clear(safe_step(f, slope, bound));
    for _ in 0..REACHES {
        let reach = 2.0 * step.by;
        let pull = jerk * reach / 3.0 - bend;
        let square = slope * slope + 2.0 * pull * f;
        if !(pull < bound && reach < f64::INFINITY) || square.is_subnormal() {
            break;
        }
        // With an upward pull there may be no zero, or two.
        let root = square.sqrt();
        let by = if square < 0.0 || slope > 0.0 && pull <= 0.0 {
            f64::INFINITY
        } else if slope > 0.0 {
            (slope + root) / pull
        } else {
            2.0 * f / (root - slope)
        };
        if by < reach {
            // f is J x² (x + r)/6 at most there, and falls at the rate of the root less J x (x/2 + r/3): half of it, or
            // there is no bound.
            let falls = jerk * by * (0.5 * by + reach / 3.0) <= 0.5 * root;
            let short = if falls { jerk * by * by * (by + reach) / (3.0 * root) } else { f64::INFINITY };
            return if by < step.by { step } else { Step { by, short } };
        }
        step.by = reach;
    }
    step
}

/// The most doublings of a reach.
const REACHES: usize = 8;

/// Steps towards a grazing zero shrink by a constant factor only; this many bring any f64 to its last digit.
pub(crate) const STEPS: usize = 2000;

/// The place of a first zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Zero {
    /// No zero before the cap.
    Never,
    /// The zero.
    At(f64),
    /// No zero before this time, at which the search was given up.
    Beyond(f64),
}

impl Zero {
    /// Returns the zero, or the end of a search that was given up.
    pub(crate) fn last(self) -> Option<f64> {
        match self {
            Self::Never => None,
            Self::At(t) | Self::Beyond(t) => Some(t),
        }
    }
}

/// Returns the first zero of f at or after `t` and before `cap`, where f is positive before.
///
/// `f(t)` gives the value and derivatives, `step(t, those)` a step that is proven to be free of zeros.
pub(crate) fn first_zero<const N: usize>(
    mut t: f64,
    cap: f64,
    f: impl Fn(f64) -> [f64; N],
    step: impl Fn(f64, [f64; N]) -> Step,
) -> Zero {
    for _ in 0..STEPS {
        let now = f(t);
        if now[0] <= 0.0 {
            return Zero::At(t);
        }
        let step = step(t, now);
        let next = t + step.by;
        if next >= cap {
            return Zero::Never;
        }
        if next <= t || step.arrives(next) {
            return Zero::At(next.max(t));
        }
        t = next;
    }
    Zero::Beyond(t)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig { cases: 4000, failure_persistence: None, ..ProptestConfig::default() })]

        /// Steps by the third derivative find the zero that those by the second find, in fewer, and to its last digits.
        #[test]
        fn far_steps_miss_no_zero(
            level in 0.0..2.0_f64,
            slope in -1.0..1.0_f64,
            waves in prop::collection::vec((0.0..1.0_f64, -1.0..1.0_f64, -3.2..3.2_f64), 1..4),
        ) {
            // 30 swings at most.
            const CAP: f64 = 20.0;
            // level + slope t + Σ a sin(w t + φ), moved up to begin above zero.
            let waves: Vec<_> = waves.into_iter().map(|(a, w, phase)| (a, 10f64.powf(w), phase)).collect();
            let sum = |of: &dyn Fn(f64, f64, f64) -> f64| waves.iter().map(|&(a, w, phase)| of(a, w, phase)).sum::<f64>();
            let begin = sum(&|a, _, phase| a * phase.sin());
            let f = |t: f64| [
                level - begin + slope * t + sum(&|a, w, phase| a * (w * t + phase).sin()),
                slope + sum(&|a, w, phase| a * w * (w * t + phase).cos()),
                sum(&|a, w, phase| -a * w * w * (w * t + phase).sin()),
            ];
            let (bound, jerk) = (sum(&|a, w, _| a * w * w), sum(&|a, w, _| a * w * w * w));
            let evaluations = std::cell::Cell::new([0, 0]);
            let count = |k: usize, t: f64| {
                let mut so_far = evaluations.get();
                so_far[k] += 1;
                evaluations.set(so_far);
                f(t)
            };
            let near = first_zero(0.0, CAP, |t| count(0, t), |_, [v, s, _]| Step::clear(safe_step(v, s, bound))).last();
            let far = first_zero(0.0, CAP, |t| count(1, t), |_, now| far_step(now, bound, jerk)).last();
            let size = level + begin.abs() + sum(&|a, _, _| a);
            let rounding = |t: f64| 64.0 * f64::EPSILON * (size + (slope.abs() + sum(&|a, w, _| a * w)) * t);
            match (near, far) {
                (None, None) => {}
                (Some(near), Some(far)) if (near - far).abs() <= 1e-6 => {
                    prop_assert!(f(far)[0].abs() <= rounding(far), "{} at {far}", f(far)[0]);
                }
                // Where it only grazes zero, either answer is right.
                (near, far) => {
                    let first = near.unwrap_or(CAP).min(far.unwrap_or(CAP));
                    prop_assert!(f(first)[0].abs() <= rounding(first), "{near:?} {far:?}");
                }
            }
            let [near, far] = evaluations.get();
            prop_assert!(far <= near + 2, "{far} evaluations, {near} by the second derivative");
        }
    }

    #[test]
    fn the_first_of_many_zeros_is_taken_even_if_the_next_is_close() {
        // (t − 1)(t − 1 − gap) has two zeros a gap apart.
        for gap in [1e-3, 1e-6, 1e-9, 1e-12] {
            let f = |t: f64| [(t - 1.0) * (t - 1.0 - gap), 2.0 * (t - 1.0) - gap];
            // f″ = 2 ≥ −1: a bound far from the truth still misses nothing.
            let zero = first_zero(0.0, f64::INFINITY, f, |_, [v, s]| Step::clear(safe_step(v, s, 1.0))).last().unwrap();
            assert!((zero - 1.0).abs() <= 2.0 * f64::EPSILON, "gap {gap:e}: {zero}");
        }
    }
    #[test]
    fn a_dip_that_stays_above_zero_is_passed() {
        let f = |t: f64| [(t - 1.0).powi(2) * (5.0 - t) + 1e-12, (t - 1.0) * (11.0 - 3.0 * t), 14.0 - 6.0 * t];
        let zero = first_zero(0.0, f64::INFINITY, f, |_, [v, s, _]| Step::clear(safe_step(v, s, 40.0))).last().unwrap();
        assert!((zero - 5.0).abs() < 1e-12, "{zero}");
        let zero = first_zero(0.0, f64::INFINITY, f, |_, now| far_step(now, 40.0, 6.0)).last().unwrap();
        assert!((zero - 5.0).abs() < 1e-12, "{zero}");
    }
    #[test]
    fn nothing_pulls_down_and_nothing_is_found() {
        assert_eq!(
            first_zero(0.0, f64::INFINITY, |t| [1.0 + t, 1.0], |_, [v, s]| Step::clear(safe_step(v, s, 0.0))),
            Zero::Never
        );
    }
}
