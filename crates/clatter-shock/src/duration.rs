//! Effective durations of a shock, by MIL-STD-810.

use crate::Error;
use crate::samples::{check, float, peak};

/// The two effective durations of a shock.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct EffectiveDuration {
    /// Tₑ, s: from the first to the last time at which the acceleration is a third of its peak.
    pub third_of_peak_s: f64,
    /// T_E, s: from the first to the last time at which the running root mean square is a tenth of its peak.
    pub tenth_of_rms_s: f64,
    /// The averaging time of that root mean square, s.
    pub averaging_s: f64,
}

/// Share of the peak above which Tₑ counts.
const THIRD: f64 = 1.0 / 3.0;
/// Share of the peak root mean square above which T_E counts.
const TENTH: f64 = 0.1;
/// Averaging times that are allowed, in T_E.
const AVERAGING: std::ops::RangeInclusive<f64> = 0.1..=0.2;
/// Averaging time of a trial, as a share of the duration so far: the middle of that range.
const MIDDLE: f64 = 0.15;
/// Trials of the averaging time. Each next one moves T_E by less than half as much, unless another shock comes in.
const TRIALS: usize = 20;

/// Returns the effective durations of the shock in a history that holds one shock.
///
/// ```text
/// Tₑ    the shortest time that holds all |a| above a third of the largest one        (MIL-STD-810F, method 516.5)
/// T_E   the shortest time that holds all root mean squares above a tenth of the
///       largest one, with an averaging time of 10 to 20 % of T_E                     (MIL-STD-810G and H, method 516)
/// ```
/// Tₑ counts on straight lines between the samples. The root mean square at a time is that of the samples around it; the
/// history is zero before and after. The averaging time begins with 15 % of Tₑ and becomes 15 % of the T_E found until it
/// lies in 10 to 20 % of it; where that does not come about in 20 trials, or one sample is longer, the last one holds, and
/// `averaging_s` gives it. For an exponential decay T_E is 2.1 Tₑ and the part of an averaging time.
///
/// # Validity
///
/// One shock, without offset: both durations run from the first to the last sample that counts, and hold whatever lies
/// between.
///
/// # Accuracy
///
/// Tₑ is exact for the straight lines; T_E is a whole number of samples.
///
/// # Errors
///
/// [`Error::Quantity`] for a time between samples outside [1e-15, 1e9] s; [`Error::Sample`]; [`Error::Short`] for no
/// sample; [`Error::NoShock`] where all are zero.
///
/// # Examples
///
/// A triangle is above a third of its peak for two thirds of its length:
///
/// ```
/// let triangle = [0.0, 1.0, 2.0, 3.0, 2.0, 1.0, 0.0];
/// let duration = clatter_shock::effective_duration(&triangle, 0.5)?;
/// assert_eq!(duration.third_of_peak_s, 2.0);
/// # Ok::<(), clatter_shock::Error>(())
/// ```
pub fn effective_duration(acceleration: &[f64], step_s: f64) -> Result<EffectiveDuration, Error> {
    check(acceleration, step_s, "a duration", 1)?;
    let largest = acceleration[peak(acceleration)].abs();
    if largest == 0.0 {
        return Err(Error::NoShock);
    }
    let third_of_peak_s = above(acceleration, THIRD * largest) * step_s;
    // Sums of squares up to each sample, in units of the peak.
    let mut sums = Vec::with_capacity(acceleration.len() + 1);
    let mut sum = 0.0;
    sums.push(sum);
    for a in acceleration {
        sum += (a / largest) * (a / largest);
        sums.push(sum);
    }
    let mut window = samples(MIDDLE * third_of_peak_s / step_s, acceleration.len());
    let mut length = active(&sums, window);
    for _ in 0..TRIALS {
        if AVERAGING.contains(&(float(window) / length)) {
            break;
        }
        window = samples(MIDDLE * length, acceleration.len());
        length = active(&sums, window);
    }
    Ok(EffectiveDuration { third_of_peak_s, tenth_of_rms_s: length * step_s, averaging_s: float(window) * step_s })
}

/// Returns a number of samples, one at least and `most` at most.
fn samples(wanted: f64, most: usize) -> usize {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 1 and the samples there are")]
    let whole = wanted.round().clamp(1.0, float(most)) as usize;
    whole
}

/// Returns samples from the first to the last time at which |a| is at the level, on straight lines.
fn above(acceleration: &[f64], level: f64) -> f64 {
    let size = |i: usize| acceleration[i].abs();
    let within = |i: &usize| size(*i) >= level;
    let n = acceleration.len();
    let (Some(first), Some(last)) = ((0..n).find(within), (0..n).rev().find(within)) else { return 0.0 };
    // A straight line to the neighbor, which may have the other sign.
    let reach = |inside: usize, outside: usize| {
        let outside = acceleration[outside] * acceleration[inside].signum();
        (size(inside) - level) / (size(inside) - outside)
    };
    let before = if first > 0 { reach(first, first - 1) } else { 0.0 };
    let after = if last + 1 < n { reach(last, last + 1) } else { 0.0 };
    float(last - first) + before + after
}

/// Returns samples from the first to the last running root mean square of `window` samples above a tenth of the
/// largest.
fn active(sums: &[f64], window: usize) -> f64 {
    let n = sums.len() - 1;
    // The window that ends before sample `end`, cut where the history begins and ends.
    let energy = |end: usize| sums[end.min(n)] - sums[end.saturating_sub(window)];
    let ends = 1..n + window;
    let level = TENTH * TENTH * ends.clone().map(energy).fold(0.0, f64::max);
    let first = ends.clone().find(|&end| energy(end) > level);
    let last = ends.rev().find(|&end| energy(end) > level);
    first.zip(last).map_or(0.0, |(first, last)| float(last - first))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn a_decay_lasts_as_its_formulas_say() {
        let (step, tau) = (1e-5, 0.01);
        // The decay begins with sample 1000; 12 time constants leave 6e-6 of it.
        let record: Vec<f64> = (0..13_000)
            .map(|i| if i < 1000 { 0.0 } else { -700.0 * (-(float(i) - 1000.0) * step / tau).exp() })
            .collect();
        let got = effective_duration(&record, step).expect("a shock");
        // It rises within one sample, of which two thirds are above a third.
        let want = tau * 3.0_f64.ln() + 2.0 / 3.0 * step;
        // A straight line instead of the exponential: (h/τ)²/8 of the value, by the slope 1/(3τ).
        assert!((got.third_of_peak_s - want).abs() < step * step / tau, "{got:?} {want}");
        assert!(AVERAGING.contains(&(got.averaging_s / got.tenth_of_rms_s)), "{got:?}");
        // The window that holds most begins with the shock. Later ones fall by e^(−t/τ); of earlier ones, those count
        // that hold 1 % of its energy, 1 − e^(−2t/τ) of 1 − e^(−2w/τ).
        let full = 1.0 - (-2.0 * got.averaging_s / tau).exp();
        let early = -0.5 * tau * (1.0 - 0.01 * full).ln();
        let want = tau * 10.0_f64.ln() + got.averaging_s - early;
        assert!((got.tenth_of_rms_s - want).abs() < 2.0 * step, "{got:?} {want}");
    }

    #[test]
    fn a_half_sine_and_a_rectangle_last_as_their_formulas_say() {
        let (n, step) = (2000, 1e-6);
        let half_sine: Vec<f64> = (0..=n).map(|i| (PI * float(i) / float(n)).sin()).collect();
        let got = effective_duration(&half_sine, step).expect("a shock");
        let want = float(n) * step * (1.0 - 2.0 / PI * (1.0_f64 / 3.0).asin());
        assert!((got.third_of_peak_s - want).abs() < 1e-3 * step, "{got:?} {want}");

        let mut rectangle = vec![0.0; 5000];
        rectangle[1000..3000].fill(4.0);
        let got = effective_duration(&rectangle, step).expect("a shock");
        assert!((got.third_of_peak_s - (1999.0 + 2.0 * 2.0 / 3.0) * step).abs() < 1e-12, "{got:?}");
        // Windows that hold more than 1 % of their samples.
        let window = got.averaging_s / step;
        let want = 2000.0 - 1.0 + window - 1.0 - 2.0 * (0.01 * window).floor();
        assert!((got.tenth_of_rms_s / step - want).abs() < 1e-6, "{got:?} {want}");
    }

    /// A shock lasts as long forward as backward, also one that the record begins or ends with.
    #[test]
    fn a_shock_lasts_as_long_backward() {
        for before in [0, 700] {
            let record: Vec<f64> = (0..4000)
                .map(|i: usize| {
                    i.checked_sub(before).map_or(0.0, |i| (-float(i) / 400.0).exp() * (0.05 * float(i)).cos())
                })
                .collect();
            let backward: Vec<f64> = record.iter().rev().copied().collect();
            let [one, other] = [record, backward].map(|a| effective_duration(&a, 1.0).expect("a shock"));
            assert!((one.third_of_peak_s - other.third_of_peak_s).abs() < 1e-9, "{one:?} {other:?}");
            // Sums of squares are added the other way: by their roundings a sample more or less may count.
            assert!((one.tenth_of_rms_s - other.tenth_of_rms_s).abs() < 1.5, "{one:?} {other:?}");
        }
    }

    #[test]
    fn the_shortest_records_have_a_duration() {
        let one = effective_duration(&[5.0], 1.0).expect("a shock");
        assert_eq!((one.third_of_peak_s, one.tenth_of_rms_s, one.averaging_s), (0.0, 0.0, 1.0));
        let swing = effective_duration(&[1.0, -1.0], 1.0).expect("a shock");
        assert!((swing.third_of_peak_s - 1.0).abs() < 1e-15, "{swing:?}");
        assert_eq!(effective_duration(&[0.0; 5], 1.0), Err(Error::NoShock));
        assert!(matches!(effective_duration(&[], 1.0), Err(Error::Short { .. })));
        assert!(matches!(effective_duration(&[f64::NAN], 1.0), Err(Error::Sample { .. })));
        // Two far shocks, of which the smaller comes in or not with the averaging time: an end all the same.
        let mut two = vec![0.0; 100_000];
        two[10] = 1.0;
        two[99_000..99_100].fill(0.11);
        let got = effective_duration(&two, 1.0).expect("a shock");
        assert!(got.tenth_of_rms_s > 0.0 && got.tenth_of_rms_s <= 2e5, "{got:?}");
    }

    /// The line to a neighbor of the other sign: from 3 to −0.6 it is at a third of the peak after 2/3.6 of a sample, up to it after 2/3.
    #[test]
    fn a_line_to_the_other_sign_goes_through_zero() {
        for sign in [1.0, -1.0] {
            let got = effective_duration(&[0.0, 3.0 * sign, -0.6 * sign, 0.0].map(|a| a + 0.0), 1.0).expect("a shock");
            assert!((got.third_of_peak_s - (2.0 / 3.0 + 2.0 / 3.6)).abs() < 1e-12, "{got:?}");
        }
    }
}
