//! The shocks of a long history: their times, sizes and durations.

use crate::Error;
use crate::error::positive;
use crate::samples::{check, float, peak, sum};
use std::ops::Range;

/// The criteria that separate shocks from noise and from each other.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Search {
    /// Threshold that the acceleration of a shock passes either way, m/s²; [`noise_threshold`] if it is not given.
    pub threshold_m_s2: Option<f64>,
    /// Quiet time, s: an acceleration that passes the threshold again within this time belongs to the same shock, as
    /// its ringing.
    pub quiet_s: f64,
}

/// The shocks of a history.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Shocks {
    /// The threshold of the search, m/s².
    pub threshold_m_s2: f64,
    /// The largest shocks, at most [`MOST_SHOCKS`], in order of time.
    pub shocks: Vec<Shock>,
    /// Number of smaller shocks that are not listed.
    pub omitted: usize,
}

/// One shock. Times count from the first sample.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Shock {
    /// First 10 % point, s: the last time before the peak at which the acceleration was a tenth of it.
    pub start_s: f64,
    /// The sample of largest size, with its sign, m/s².
    pub peak_m_s2: f64,
    /// Time of that sample, s.
    pub peak_time_s: f64,
    /// Time from the first 10 % point to the one after the peak, s.
    pub duration_s: f64,
    /// Integral of the straight lines between the samples from one 10 % point to the other, m/s.
    pub velocity_change_m_s: f64,
    /// Indices from the first sample beyond the threshold to the last one of the shock, ringing included.
    pub samples: Range<usize>,
}

/// The largest number of shocks in a list: nobody reads a longer table.
pub const MOST_SHOCKS: usize = 1000;

/// Share of the peak at the two points between which a duration counts (MIL-STD-883, method 2002).
const POINT: f64 = 0.1;

/// The median of |a| of normal noise, in standard deviations: the upper quartile of the normal distribution.
const QUARTILE: f64 = 0.674_489_750_196_081_7;

/// The largest share of histories of noise alone in which a sample passes the threshold.
const FALSE_ALARMS: f64 = 1e-3;

/// Threshold as a share of the peak where most samples are zero, so that the noise is unknown: above the steps of an
/// 8-bit converter, 1/128.
const CLEAN: f64 = 0.01;

/// Returns a threshold above the noise, m/s²; it is the default of [`find_shocks`].
///
/// The standard deviation of the noise comes from the median, which shocks in less than half of the history hardly
/// move: σ = median|a|/0.6745. Normal noise passes x σ either way with a probability below exp(−x²/2), so that in n
/// samples of noise alone
/// ```text
/// threshold = σ √(2 ln(1000 n))
/// ```
/// is passed in less than one history of 1000: 5.7 σ for 10⁴ samples, 6.8 σ for 10⁷. Where half of the samples are exactly
/// zero, it is 1 % of the peak.
///
/// # Validity
///
/// The offset must be taken out first. The history has to be quiet for more than half of its samples, and its noise
/// normal: a history that a shock fills, or with impulsive noise, needs a threshold from the user.
///
/// # Errors
///
/// [`Error::Sample`], [`Error::Short`] for no sample.
///
/// # Examples
///
/// ```
/// let quiet = [0.5, -0.5].repeat(500);
/// let threshold = clatter_shock::noise_threshold(&quiet)?;
/// assert!((threshold - 0.5 / 0.674_489_75 * (2.0 * 1e6_f64.ln()).sqrt()).abs() < 1e-7);
/// # Ok::<(), clatter_shock::Error>(())
/// ```
pub fn noise_threshold(acceleration: &[f64]) -> Result<f64, Error> {
    check(acceleration, 1.0, "a threshold", 1)?;
    let mut sizes: Vec<f64> = acceleration.iter().map(|a| a.abs()).collect();
    let middle = sizes.len() / 2;
    let median = *sizes.select_nth_unstable_by(middle, f64::total_cmp).1;
    if median == 0.0 {
        return Ok(CLEAN * acceleration[peak(acceleration)].abs());
    }
    Ok(median / QUARTILE * (2.0 * libm::log(float(acceleration.len()) / FALSE_ALARMS)).sqrt())
}

/// Finds the shocks of a history.
///
/// A shock lasts from the first sample beyond the threshold to the last one that is not followed by another within the
/// quiet time. Its peak is its sample of largest size; duration and velocity change are those of the pulse that the peak
/// belongs to, between its 10 % points, on straight lines between the samples. Where the acceleration does not come down
/// to a tenth before the next shock or the end of the history, the point is there.
///
/// One pass over the samples, at most [`MOST_SHOCKS`] rows: 10⁷ samples of noise take no longer than 10⁷ of rest.
///
/// # Accuracy
///
/// The peak is a sample: the largest value between samples is above it, for a half-sine of N samples by (π/N)²/8 at most.
///
/// # Errors
///
/// [`Error::Quantity`] for a threshold or a quiet time that is not positive, or a time between samples outside
/// [1e-15, 1e9] s; [`Error::Sample`]; [`Error::Short`] for no sample.
///
/// # Examples
///
/// ```
/// use clatter_shock::{Search, find_shocks};
/// let mut record = vec![0.0; 1000];
/// record[400..405].copy_from_slice(&[0.0, 500.0, 1000.0, 500.0, 0.0]);
/// record[700..703].copy_from_slice(&[-100.0, -200.0, -100.0]);
/// let found = find_shocks(&record, 1e-3, &Search { threshold_m_s2: None, quiet_s: 0.01 })?;
/// assert_eq!(found.threshold_m_s2, 10.0); // 1 % of the peak: the rest is zero
/// let [first, second] = &found.shocks[..] else { panic!("{found:?}") };
/// assert_eq!((first.peak_m_s2, first.peak_time_s), (1000.0, 0.402));
/// assert!((first.duration_s - 0.0036).abs() < 1e-12); // from 0.4002 s to 0.4038 s
/// assert!((first.velocity_change_m_s - 1.98).abs() < 1e-12); // 2 m/s less the two ends
/// assert_eq!(second.peak_m_s2, -200.0);
/// # Ok::<(), clatter_shock::Error>(())
/// ```
pub fn find_shocks(acceleration: &[f64], step_s: f64, search: &Search) -> Result<Shocks, Error> {
    check(acceleration, step_s, "a search", 1)?;
    positive("quiet time (s)", search.quiet_s)?;
    let threshold_m_s2 = match search.threshold_m_s2 {
        Some(threshold) => positive("threshold (m/s²)", threshold)?,
        None => noise_threshold(acceleration)?,
    };
    let mut rows = Rows::default();
    let (mut open, mut free): (Option<Event>, usize) = (None, 0);
    for (i, a) in acceleration.iter().enumerate() {
        if a.abs() <= threshold_m_s2 {
            continue;
        }
        let here = Event { samples: i..i + 1, peak: i };
        open = Some(match open.take() {
            None => here,
            Some(event) if float(i + 1 - event.samples.end) * step_s <= search.quiet_s => {
                let peak = if a.abs() > acceleration[event.peak].abs() { i } else { event.peak };
                Event { samples: event.samples.start..i + 1, peak }
            }
            Some(event) => {
                // The samples up to the next shock are read twice at most.
                let end = event.samples.end;
                rows.add(event.measure(acceleration, step_s, free..i));
                free = end;
                here
            }
        });
    }
    if let Some(event) = open {
        rows.add(event.measure(acceleration, step_s, free..acceleration.len()));
    }
    let Rows { mut shocks, omitted } = rows.largest();
    shocks.sort_by_key(|shock| shock.samples.start);
    Ok(Shocks { threshold_m_s2, shocks, omitted })
}

/// Samples beyond the threshold, and the largest of them.
struct Event {
    samples: Range<usize>,
    peak: usize,
}

impl Event {
    /// Returns the row of this shock; its 10 % points lie within `free`.
    fn measure(self, acceleration: &[f64], step_s: f64, free: Range<usize>) -> Shock {
        let [start, end] = tenths(acceleration, self.peak, free);
        let [first, last] = [whole(start.ceil()), whole(end.floor())];
        let level = POINT * acceleration[self.peak];
        let inner = acceleration[first..=last].windows(2).map(|w| 0.5 * (w[0] + w[1]));
        let ends = [(float(first) - start, first), (end - float(last), last)]
            .map(|(part, i)| 0.5 * part * (acceleration[i] + level));
        Shock {
            start_s: start * step_s,
            peak_m_s2: acceleration[self.peak],
            peak_time_s: float(self.peak) * step_s,
            duration_s: (end - start) * step_s,
            velocity_change_m_s: sum(inner.chain(ends)) * step_s,
            samples: self.samples,
        }
    }
}

/// Returns the 10 % points before and after a peak, in samples; on straight lines, or at the ends of `free`.
pub(crate) fn tenths(acceleration: &[f64], peak: usize, free: Range<usize>) -> [f64; 2] {
    let top = acceleration[peak];
    let level = POINT * top;
    // Positive where the pulse is above its tenth.
    let above = |i: usize| (acceleration[i] - level) * top.signum();
    let crossing = |inside: usize, outside: usize| above(inside) / (above(inside) - above(outside));
    let first = (free.start..peak).rev().take_while(|&i| above(i) > 0.0).last().unwrap_or(peak);
    let last = (peak..free.end).take_while(|&i| above(i) > 0.0).last().unwrap_or(peak);
    let before = if first > free.start { crossing(first, first - 1) } else { 0.0 };
    let after = if last + 1 < free.end { crossing(last, last + 1) } else { 0.0 };
    [float(first) - before, float(last) + after]
}

/// Returns a whole number of samples.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a whole number within the record")]
fn whole(samples: f64) -> usize {
    samples as usize
}

/// The rows so far: no more than twice as many as the list holds.
#[derive(Default)]
struct Rows {
    shocks: Vec<Shock>,
    omitted: usize,
}

impl Rows {
    fn add(&mut self, shock: Shock) {
        self.shocks.push(shock);
        if self.shocks.len() == 2 * MOST_SHOCKS {
            *self = std::mem::take(self).largest();
        }
    }
    /// Returns the largest ones, as many as the list holds; the earlier of equal ones.
    fn largest(mut self) -> Self {
        if self.shocks.len() > MOST_SHOCKS {
            self.shocks.select_nth_unstable_by(MOST_SHOCKS, |a, b| {
                b.peak_m_s2.abs().total_cmp(&a.peak_m_s2.abs()).then(a.samples.start.cmp(&b.samples.start))
            });
            self.omitted += self.shocks.len() - MOST_SHOCKS;
            self.shocks.truncate(MOST_SHOCKS);
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{PI, TAU};

    /// Returns the normal noise of unit standard deviation (Box and Muller), from Marsaglia's xorshift.
    fn noise(n: usize, mut seed: u64) -> Vec<f64> {
        let mut uniform = || {
            seed ^= seed << 13;
            seed ^= seed >> 7;
            seed ^= seed << 17;
            (float(usize::try_from(seed >> 11).expect("53 bits")) + 0.5) / 9_007_199_254_740_992.0
        };
        (0..n).map(|_| (-2.0 * uniform().ln()).sqrt() * (TAU * uniform()).cos()).collect()
    }

    #[test]
    fn noise_alone_holds_no_shock_and_the_threshold_is_that_of_its_spread() {
        // One record of 1000 may pass: 60 records pass once in 17 such tests; these ones do not.
        for (n, records) in [(1000, 30), (100_000, 29), (3_000_000, 1)] {
            for seed in 1..=records {
                let record = noise(n, seed * 0x9E37_79B9_7F4A_7C15);
                let found =
                    find_shocks(&record, 1e-5, &Search { threshold_m_s2: None, quiet_s: 1e-3 }).expect("a record");
                assert!(found.shocks.is_empty(), "{n}, {seed}: {found:?}");
                let want = (2.0 * (1000.0 * float(n)).ln()).sqrt();
                // A median m of n samples scatters by 1/(2 f(m) √n), f the density: here by 1.17/√n of itself.
                let allowed = 5.0 * 1.17 / float(n).sqrt();
                assert!((found.threshold_m_s2 / want - 1.0).abs() < allowed, "{n}: {} {want}", found.threshold_m_s2);
            }
        }
    }

    /// Half-sines on noise are found at their places, with the figures of the formulas.
    #[test]
    fn half_sines_in_noise_are_found_and_measured() {
        let step = 1e-5;
        let mut record = noise(200_000, 7);
        // (begin, samples, amplitude); the noise is 1 m/s².
        let pulses = [(20_000, 100, 500.0), (50_000, 300, -800.0), (150_000, 40, 300.0)];
        for (begin, length, amplitude) in pulses {
            for i in 0..=length {
                record[begin + i] += amplitude * (PI * float(i) / float(length)).sin();
            }
        }
        let found = find_shocks(&record, step, &Search { threshold_m_s2: None, quiet_s: 1e-3 }).expect("a record");
        assert_eq!((found.shocks.len(), found.omitted), (3, 0), "{found:?}");
        for (shock, (begin, length, amplitude)) in found.shocks.iter().zip(pulses) {
            let (begin, length, rise) = (float(begin), float(length), 0.1_f64.asin() / PI);
            // Noise of 5 m/s² at the most: in the peak itself, and in the 10 % points by its share of the slope there.
            assert!((shock.peak_m_s2 - amplitude).abs() < 5.0, "{shock:?}");
            let slope = PI * amplitude.abs() / length * (1.0 - 0.01_f64).sqrt();
            let late = (5.0 + 0.1 * 5.0) / slope + 0.1;
            assert!((shock.start_s / step - (begin + rise * length)).abs() < late, "{shock:?}");
            assert!((shock.duration_s / step - (1.0 - 2.0 * rise) * length).abs() < 2.0 * late, "{shock:?}");
            // Noise adds 1 m/s² times the root of the samples; four of that, and the ends.
            let want = 2.0 / PI * (1.0 - 0.01_f64).sqrt() * amplitude * length;
            let allowed = 4.0 * length.sqrt() + 2.0 * late * 0.1 * amplitude.abs();
            assert!((shock.velocity_change_m_s / step - want).abs() < allowed, "{shock:?}");
        }
    }

    #[test]
    fn ringing_within_the_quiet_time_is_one_shock() {
        // A decaying sine of 100 Hz, 1 kHz of samples: it passes 10 m/s² every 5 ms until e^(−t/0.02) = 0.1.
        let record: Vec<f64> = (0..200)
            .map(|i| {
                let t = (float(i) - 20.0) * 1e-3;
                if t < 0.0 { 0.0 } else { 100.0 * (-t / 0.02).exp() * (TAU * 100.0 * t).sin() }
            })
            .collect();
        let find = |quiet_s| {
            find_shocks(&record, 1e-3, &Search { threshold_m_s2: Some(10.0), quiet_s }).expect("a record").shocks
        };
        let merged = find(0.006);
        assert_eq!(merged.len(), 1, "{merged:?}");
        let beyond = |i: &usize| record[*i].abs() > 10.0;
        let (first, last) = ((0..200).find(beyond).expect("one"), (0..200).rev().find(beyond).expect("one"));
        assert_eq!(merged[0].samples, first..last + 1);
        assert!(find(0.0005).len() > 5, "every half-swing by itself");
        // Two samples ten steps apart: within ten steps one shock, within less two.
        let mut two = [0.0; 50];
        (two[20], two[30]) = (5.0, -4.0);
        for (quiet_s, count) in [(10.0, 1), (9.9, 2)] {
            let found = find_shocks(&two, 1.0, &Search { threshold_m_s2: Some(1.0), quiet_s }).expect("a record");
            assert_eq!(found.shocks.len(), count, "{quiet_s}: {found:?}");
        }
    }

    #[test]
    fn no_record_takes_long_or_gives_more_than_a_thousand_rows() {
        // Every second sample is a shock of its own, above its neighbors' tenth: a search with quadratic cost would
        // hang.
        let n = 10_000_000;
        let record: Vec<f64> = (0..n).map(|i| if i % 2 == 0 { 1.0 } else { 1.1 + 1e-9 * float(i % 1000) }).collect();
        let search = Search { threshold_m_s2: Some(1.05), quiet_s: 1e-9 };
        let found = find_shocks(&record, 1e-5, &search).expect("a record");
        assert_eq!((found.shocks.len(), found.omitted), (MOST_SHOCKS, n / 2 - MOST_SHOCKS));
        // The largest ones, the earlier ones first: every 500th of the shocks.
        for (k, shock) in found.shocks.iter().enumerate() {
            assert_eq!(shock.samples, 1000 * k + 999..1000 * k + 1000);
        }
    }

    #[test]
    fn a_record_may_begin_and_end_within_a_shock() {
        let search = Search { threshold_m_s2: Some(1.0), quiet_s: 1.0 };
        let found = find_shocks(&[-5.0, -5.0, -5.0], 0.5, &search).expect("a record");
        let [shock] = &found.shocks[..] else { panic!("{found:?}") };
        assert_eq!((shock.start_s, shock.duration_s, shock.velocity_change_m_s), (0.0, 1.0, -5.0));
        let one = find_shocks(&[3.0], 0.5, &search).expect("a record");
        assert_eq!((one.shocks[0].duration_s, one.shocks[0].velocity_change_m_s), (0.0, 0.0));
        for (threshold_m_s2, quiet_s) in [(Some(0.0), 1.0), (Some(f64::NAN), 1.0), (None, -1.0), (None, f64::NAN)] {
            let refused = find_shocks(&[1.0], 1.0, &Search { threshold_m_s2, quiet_s });
            assert!(matches!(refused, Err(Error::Quantity { .. })), "{refused:?}");
        }
        assert!(
            find_shocks(&[0.0; 9], 1.0, &Search { threshold_m_s2: None, quiet_s: 1.0 })
                .expect("rest")
                .shocks
                .is_empty()
        );
    }

    /// Two equal pulses of which the upper half alone is above the threshold: the second is as long as the first.
    #[test]
    fn a_shock_begins_at_its_tenth_whatever_was_before_it() {
        let mut record = vec![0.0; 1000];
        for begin in [100, 600] {
            (0..=200).for_each(|i| record[begin + i] = 400.0 * (PI * float(i) / 200.0).sin());
        }
        let search = Search { threshold_m_s2: Some(200.0), quiet_s: 1e-3 };
        let found = find_shocks(&record, 1e-5, &search).expect("a record").shocks;
        assert_eq!(found.len(), 2, "{found:?}");
        for shock in &found {
            let between = 200e-5 * (1.0 - 2.0 * 0.1_f64.asin() / PI);
            // Straight lines between samples, by (π/200)²/8 of the peak over the slope.
            assert!((shock.duration_s - between).abs() < 1e-8, "{shock:?}, not {between}");
        }
        assert!((found[1].velocity_change_m_s / found[0].velocity_change_m_s - 1.0).abs() < 1e-12, "{found:?}");
        assert!((found[1].start_s - found[0].start_s - 500e-5).abs() < 1e-12, "{found:?}");
    }
}
