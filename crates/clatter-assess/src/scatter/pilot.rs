//! Whether the closed form will do: measured on drops of the product itself.
//!
//! # What a pilot shows
//! Its n drops are drawn as all others are, and are answered by the closed form and by the model with the most physics. ε is the
//! largest factor less 1 between both utilizations, over all parts and drops. If more than a share p of all drops were off by more
//! than ε, all n would be within it with a probability below (1 − p)ⁿ. So with confidence 1 − (1 − p)ⁿ at most the share p of drops
//! is off by more. That holds for any distribution of the errors (S. S. Wilks, Annals of Mathematical Statistics 12, 1941).

use rayon::prelude::*;

use super::Asked;
use crate::Error;

/// What was found by the closed form and the model with the most physics on the same drops.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Pilot {
    /// How many drops; those of a pilot that showed too large an error are the fewest.
    pub drops: u64,
    /// The largest factor between both utilizations of a part, less 1; infinite where one of them has no answer.
    pub worst_error: f64,
    /// At most this share of all drops is off by more than the worst error …
    pub share: f64,
    /// … with this confidence.
    pub confidence: f64,
    /// Whether the closed form was taken.
    pub taken: bool,
}

/// Up to this error the closed form is taken.
const LARGEST_ERROR: f64 = 0.05;
/// Drops that are tried first; one that shows a larger error is not gone on with.
const FIRST: u64 = 400;
/// A pilot is one of so many samples, at most.
const ONE_OF: u64 = 20;
/// Fewer samples are cheap enough without a pilot.
pub(super) const LEAST_SAMPLES: u64 = FIRST * ONE_OF;
const MOST: u64 = 30_000;

impl Pilot {
    /// For so many samples, by the error of each drop.
    pub(super) fn of(samples: u64, confidence: f64, error: impl Fn(u64) -> f64 + Sync) -> Self {
        let drops = (samples / ONE_OF).clamp(FIRST, MOST);
        let worst = |from: u64, to: u64| (from..to).into_par_iter().map(&error).reduce(|| 0.0, f64::max);
        let first = worst(0, FIRST);
        if first > LARGEST_ERROR {
            return Self::shown(FIRST, first, confidence);
        }
        Self::shown(drops, first.max(worst(FIRST, drops)), confidence)
    }

    fn shown(drops: u64, worst_error: f64, confidence: f64) -> Self {
        #[expect(clippy::cast_precision_loss, reason = "at most 30 000")]
        let share = -libm::expm1(libm::log1p(-confidence) / drops as f64);
        Self { drops, worst_error, share, confidence, taken: worst_error <= LARGEST_ERROR }
    }
}

/// The largest factor, less 1, between what both models ask of the parts of a drop; infinite where the fuller one has no answer.
pub(super) fn error(cheap: &[Asked], full: &[Result<Asked, Error>]) -> f64 {
    let of = |(cheap, full): (&Asked, &Result<Asked, Error>)| {
        let Ok(full) = full else { return f64::INFINITY };
        let [least, most] = full.within;
        if most <= 0.0 && cheap.utilization <= 0.0 {
            return 0.0;
        }
        let factor = (most / cheap.utilization).max(cheap.utilization / least);
        if factor.is_nan() { f64::INFINITY } else { factor - 1.0 }
    };
    cheap.iter().zip(full).map(of).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_share_that_is_off_by_more_hides_from_a_pilot_as_seldom_as_promised() {
        // Of 59 drops all are within the worst with 95 % confidence for 95 % of all: the known sample size.
        let pilot = Pilot::shown(59, 0.01, 0.95);
        assert!((pilot.share - 0.05).abs() < 0.001, "{pilot:?}");
        assert!(((1.0 - pilot.share).powi(59) - 0.05).abs() < 1e-12);
    }

    #[test]
    fn a_pilot_is_left_where_its_first_drops_are_off() {
        let pilot = Pilot::of(1_000_000, 0.95, |k| if k == 300 { 0.2 } else { 0.01 });
        assert_eq!((pilot.drops, pilot.worst_error, pilot.taken), (FIRST, 0.2, false));
        let pilot = Pilot::of(1_000_000, 0.95, |k| if k == 20_000 { 0.049 } else { 0.01 });
        assert_eq!((pilot.drops, pilot.worst_error, pilot.taken), (30_000, 0.049, true));
    }

    #[test]
    fn a_drop_without_an_answer_is_off_by_anything() {
        let mut asked = Asked::default();
        asked.raise(0, 0.5, 0.0);
        assert!(error(&[asked], &[Err(Error::Unfinished)]).is_infinite(), "no answer");
        let mut full = Asked::default();
        full.raise(0, 0.6, 0.0);
        assert!((error(&[asked], &[Ok(full)]) - 0.2).abs() < 1e-12, "a fifth more");
        assert!((error(&[full], &[Ok(asked)]) - 0.2).abs() < 1e-12, "a fifth less");
        assert!(error(&[Asked::default()], &[Ok(full)]).is_infinite(), "nothing where something is asked");
    }
}
