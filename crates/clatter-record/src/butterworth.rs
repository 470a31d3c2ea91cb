//! Butterworth filters that shift nothing in time: forward and backward over the record.

use crate::Error;
use clatter_shock::samples::{check, float};
use std::f64::consts::{FRAC_PI_2, PI, SQRT_2};

/// What a filter lets through.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Pass {
    /// What is below the cutoff.
    Low,
    /// What is above it.
    High,
}

/// Cutoff times the time between samples, at least: below, the response lasts longer than records do, and roundings
/// are no longer small beside it.
const LOWEST: f64 = 1e-6;
/// Poles of one pass, at most.
const HIGHEST_ORDER: u32 = 8;
/// Length by which the record is continued, in time constants of the slowest pole: 1/1000 of its response is left.
const CONTINUED: f64 = 7.0;
/// Samples by which it is continued in any case.
const SHORTEST: f64 = 10.0;

/// Filters a record forward and backward with a Butterworth filter of `order` poles, so that nothing is shifted in time.
///
/// **The cutoff is where both passes together leave 1/√2 (−3 dB)**, as SAE J211 and ISO 6487 have it. Their channel
/// frequency classes are the low-pass of order 2 (four poles in both passes) at 100 Hz (CFC 60), 300 Hz (CFC 180), 1000 Hz
/// (CFC 600) and 1650 Hz (CFC 1000). `filtfilt` of MATLAB and SciPy is at −6 dB there instead: each of its passes has
/// −3 dB at the frequency given.
///
/// The amplitude that is left at a frequency f, for the cutoff f₀ and samples h apart, is
/// ```text
/// low-pass   1/(1 + (√2 − 1) r²ⁿ),      high-pass   1/(1 + (√2 − 1) r⁻²ⁿ),      r = tan(πfh)/tan(πf₀h)
/// ```
/// n the order: the bilinear transform, exact at the cutoff, and r = f/f₀ far below half the sampling rate. Both fall off
/// by 12n dB an octave.
///
/// # Edges
///
/// The record is continued at both ends, turned about its first and last sample, by seven time constants of the slowest
/// pole or its own length, whichever is less; the filter begins as if the first value had always been. A constant stays
/// itself (low-pass) or becomes zero (high-pass) to the last digit. A cutoff below 1/(length of the record) is carried
/// out, but what comes out is then made of the continuation more than of the record.
///
/// # Accuracy
///
/// The sections are state-variable filters (trapezoidal rule), which keep their digits at low cutoffs, unlike the sections
/// of a difference equation: every value is within 1e-10 of the largest sample, from 10⁻⁶ of the sampling rate up
/// (measured: 2e-11 at 10⁻⁶, 6e-13 at 10⁻⁴, 1e-15 on short records).
///
/// # Errors
///
/// [`Error::Quantity`] for an order outside 1 to 8, or a cutoff outside [1e-6, 0.5) of the sampling rate; [`Error::Shock`] for a
/// time between samples outside [1e-15, 1e9] s, a sample that is not usable, or none.
///
/// # Examples
///
/// ```
/// use clatter_record::{Pass, butterworth};
/// // CFC 1000 at 20 kHz leaves an offset as it is; a high-pass takes it out.
/// assert_eq!(butterworth(&[9.81; 50], 5e-5, Pass::Low, 1650.0, 2)?, [9.81; 50]);
/// assert_eq!(butterworth(&[9.81; 50], 5e-5, Pass::High, 10.0, 4)?, [0.0; 50]);
/// # Ok::<(), clatter_record::Error>(())
/// ```
pub fn butterworth(
    acceleration: &[f64],
    step_s: f64,
    pass: Pass,
    cutoff_hz: f64,
    order: u32,
) -> Result<Vec<f64>, Error> {
    check(acceleration, step_s, "a filter", 1)?;
    if !(1..=HIGHEST_ORDER).contains(&order) {
        return Err(Error::Quantity { name: "order of the filter", value: f64::from(order), allowed: "in 1 to 8" });
    }
    let relative = cutoff_hz * step_s;
    if !(LOWEST..0.5).contains(&relative) {
        return Err(Error::Quantity {
            name: "cutoff (Hz) times the time between samples (s)",
            value: relative,
            allowed: "in [1e-6, 0.5)",
        });
    }
    let cascade = Cascade::new(pass, relative, order);
    let edge = cascade.edge(acceleration.len());
    let mut continued = continue_both(acceleration, edge);
    cascade.run(continued.iter_mut());
    cascade.run(continued.iter_mut().rev());
    continued.truncate(edge + acceleration.len());
    continued.drain(..edge);
    Ok(continued)
}

/// The record with `edge` samples more at both ends, turned about the end samples.
fn continue_both(record: &[f64], edge: usize) -> Vec<f64> {
    let [first, last] = [record[0], record[record.len() - 1]];
    let before = record[1..=edge].iter().rev().map(|a| 2.0 * first - a);
    let after = record[record.len() - 1 - edge..record.len() - 1].iter().rev().map(|a| 2.0 * last - a);
    before.chain(record.iter().copied()).chain(after).collect()
}

/// A Butterworth filter as sections of two poles and, of odd order, one of one pole.
struct Cascade {
    pass: Pass,
    /// tan of half the angle of a sample at the cutoff of one pass.
    g: f64,
    /// Twice the damping ratio of each section of two poles.
    damping: Vec<f64>,
    single: bool,
    order: u32,
}

impl Cascade {
    fn new(pass: Pass, relative: f64, order: u32) -> Self {
        // Each pass leaves the square root of 1/√2 at the cutoff given.
        let shift = libm::pow(SQRT_2 - 1.0, 0.5 / f64::from(order));
        let at = libm::tan(PI * relative);
        let g = match pass {
            Pass::Low => at / shift,
            Pass::High => at * shift,
        };
        let angle = |i| FRAC_PI_2 * f64::from(2 * i + 1) / f64::from(order);
        let damping = (0..order / 2).map(|i| 2.0 * libm::sin(angle(i))).collect();
        Self { pass, g, damping, single: order % 2 == 1, order }
    }
    /// By how many samples a record of `n` is continued.
    fn edge(&self, n: usize) -> usize {
        let slowest = libm::sin(FRAC_PI_2 / f64::from(self.order));
        // 2g radians a sample; near half the sampling rate the poles lie as far from the other end.
        let time_constant = self.g.max(self.g.recip()) / (2.0 * slowest);
        let wanted = (CONTINUED * time_constant).ceil() + SHORTEST;
        if wanted < float(n - 1) {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and n")]
            let wanted = wanted as usize;
            wanted
        } else {
            n - 1
        }
    }
    /// One pass, in place.
    fn run<'a>(&self, samples: impl Iterator<Item = &'a mut f64>) {
        let mut samples = samples.peekable();
        let Some(first) = samples.peek().map(|a| **a) else { return };
        // At rest under the first value: the low-pass of each section holds it, and nothing gets through the high-pass.
        let mut value = first;
        let mut pairs: Vec<Pair> = Vec::with_capacity(self.damping.len());
        for &damping in &self.damping {
            pairs.push(Pair::at_rest(self.g, damping, value));
            value = self.steady(value);
        }
        let mut single = Single { share: self.g / (1.0 + self.g), low: value };
        for sample in samples {
            let mut value = *sample;
            for pair in &mut pairs {
                let [low, high] = pair.step(value);
                value = if self.pass == Pass::Low { low } else { high };
            }
            if self.single {
                let low = single.step(value);
                value = if self.pass == Pass::Low { low } else { value - low };
            }
            *sample = value;
        }
    }
    /// What is left of a constant.
    fn steady(&self, value: f64) -> f64 {
        if self.pass == Pass::Low { value } else { 0.0 }
    }
}

/// A section of two poles as a state-variable filter by the trapezoidal rule (Zavalishin, The Art of VA Filter Design,
/// 2018, chapter 4): both states are integrals, so that a constant is held to the last digit.
struct Pair {
    damping: f64,
    one: f64,
    two: f64,
    three: f64,
    band: f64,
    low: f64,
}

impl Pair {
    fn at_rest(g: f64, damping: f64, value: f64) -> Self {
        let one = 1.0 / (1.0 + g * (g + damping));
        Self { damping, one, two: g * one, three: g * g * one, band: 0.0, low: value }
    }
    /// Low-pass and high-pass of the next value.
    #[inline]
    fn step(&mut self, value: f64) -> [f64; 2] {
        let over = value - self.low;
        let band = self.one * self.band + self.two * over;
        let rise = self.two * self.band + self.three * over;
        let low = self.low + rise;
        self.band = 2.0 * band - self.band;
        self.low += 2.0 * rise;
        [low, value - self.damping * band - low]
    }
}

/// A section of one pole.
struct Single {
    share: f64,
    low: f64,
}

impl Single {
    #[inline]
    fn step(&mut self, value: f64) -> f64 {
        let rise = self.share * (value - self.low);
        let low = self.low + rise;
        self.low = low + rise;
        low
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clatter_shock::Error::{Sample, Short};
    use serde_json::Value;

    /// The stated amplitude, written down on its own.
    fn left(pass: Pass, f: f64, cutoff: f64, order: u32) -> f64 {
        let ratio = (PI * f).tan() / (PI * cutoff).tan();
        let power = ratio.powf(2.0 * f64::from(order));
        match pass {
            Pass::Low => 1.0 / (1.0 + (SQRT_2 - 1.0) * power),
            Pass::High => 1.0 / (1.0 + (SQRT_2 - 1.0) / power),
        }
    }

    /// In the middle of a long record, where no edge is felt, a sinusoid keeps its phase and the stated amplitude.
    #[test]
    fn amplitudes_are_the_stated_curve_and_nothing_is_shifted() {
        for (pass, order) in [Pass::Low, Pass::High].into_iter().flat_map(|p| (1..=8).map(move |n| (p, n))) {
            for (cutoff, half) in [(2e-3, 80_000), (0.05, 4000), (0.45, 4000)] {
                // At the cutoff itself −3 dB, whatever the order.
                assert!((left(pass, cutoff, cutoff, order) - 0.5_f64.sqrt()).abs() < 1e-12, "{pass:?} {order}");
                for ratio in [0.3, 0.8, 1.0, 1.08, 3.0] {
                    let f: f64 = cutoff * ratio;
                    if f > 0.49 {
                        continue;
                    }
                    let wave = |i: usize| (2.0 * PI * f * float(i) + 0.4).sin();
                    let record: Vec<f64> = (0..2 * half).map(wave).collect();
                    let got = butterworth(&record, 1.0, pass, cutoff, order).expect("a record");
                    let amplitude = left(pass, f, cutoff, order);
                    for i in half..half + 50 {
                        // Roundings: 6e-13 at the worst, tenfold; the edges are 190 time constants away or more.
                        let (got, want) = (got[i], amplitude * wave(i));
                        assert!((got - want).abs() < 6e-12, "{pass:?} {order}, {f} of {cutoff}: {got} not {want}");
                    }
                }
            }
        }
    }

    /// Against the difference equations at 60 digits (tests/data/make_filters.py), edges and all, down to 10⁻⁶ of the
    /// sampling rate.
    #[test]
    fn records_are_filtered_as_with_sixty_digits() {
        let data: Value = serde_json::from_str(include_str!("../tests/data/filters.json")).expect("data");
        let numbers = |v: &Value| -> Vec<f64> {
            v.as_array().expect("numbers").iter().map(|v| v.as_f64().expect("a number")).collect()
        };
        let record = numbers(&data["record"]);
        let cases = data["cases"].as_array().expect("cases");
        assert_eq!(cases.len(), 12, "cases");
        for case in cases {
            let pass = if case["kind"] == "low" { Pass::Low } else { Pass::High };
            let relative = case["relative"].as_f64().expect("a number");
            let order = u32::try_from(case["order"].as_u64().expect("a count")).expect("a count");
            // The step takes part in nothing but the cutoff.
            let got = butterworth(&record, 1e-4, pass, relative / 1e-4, order).expect("a record");
            assert_eq!(got.len(), record.len());
            for (i, want) in numbers(&case["y"]).into_iter().enumerate() {
                let got = got[8 * i];
                // Tenfold the 1e-15 of the largest sample, some 110, that is measured.
                assert!((got - want).abs() < 1e-14 * 110.0, "{pass:?} {relative} {order}, {i}: {got:?}, not {want:?}");
            }
        }
    }

    /// The lowest cutoffs over ten million samples, where roundings add up longest.
    #[test]
    fn the_lowest_cutoffs_keep_their_digits() {
        let middle = 5_000_000;
        for (pass, cutoff) in [(Pass::Low, 1e-6), (Pass::High, 2e-6)] {
            let wave = |i: usize| (2.0 * PI * cutoff * float(i) + 0.4).sin();
            let record: Vec<f64> = (0..2 * middle).map(wave).collect();
            let got = butterworth(&record, 1.0, pass, cutoff, 1).expect("a record");
            for (i, got) in got.iter().enumerate().skip(middle).take(100) {
                // As stated; the edges are 40 time constants away or more.
                let want = 0.5_f64.sqrt() * wave(i);
                assert!((got - want).abs() < 1e-10, "{pass:?}: {got}, not {want}");
            }
        }
    }

    #[test]
    fn constants_and_straight_lines_have_no_transient() {
        let line: Vec<f64> = (0..500).map(|i| 3.0 + 0.25 * float(i)).collect();
        for order in 1..=8 {
            for relative in [1e-6, 1e-3, 0.1, 0.499] {
                let constant = butterworth(&[7.3; 100], 1.0, Pass::Low, relative, order).expect("a record");
                assert_eq!(constant, [7.3; 100], "{order} {relative}");
                let nothing = butterworth(&[7.3; 100], 1.0, Pass::High, relative, order).expect("a record");
                assert_eq!(nothing, [0.0; 100], "{order} {relative}");
            }
            // Turned about its ends, a line goes on; 7 time constants (1/1000 each way) hide where it stops, and no
            // phase is left to shift it. 0.25 · 500 is its rise.
            let got = butterworth(&line, 1.0, Pass::Low, 0.1, order).expect("a record");
            for (got, want) in got.iter().zip(&line) {
                assert!((got - want).abs() < 2e-3 * 125.0, "{order}: {got}, not {want}");
            }
        }
    }

    #[test]
    fn what_cannot_be_filtered_is_refused_with_the_value() {
        let low = |record: &[f64], step, cutoff, order| butterworth(record, step, Pass::Low, cutoff, order);
        for cutoff in [0.0, 0.99e-6, 0.5, 1.0, -0.1, f64::NAN, f64::INFINITY] {
            let error = low(&[1.0; 9], 1.0, cutoff, 2).expect_err("refused");
            assert!(matches!(error, Error::Quantity { value, .. } if value.to_bits() == cutoff.to_bits()), "{error}");
        }
        for order in [0, 9, u32::MAX] {
            assert!(matches!(low(&[1.0; 9], 1.0, 0.1, order), Err(Error::Quantity { .. })), "{order}");
        }
        assert!(matches!(low(&[], 1.0, 0.1, 2), Err(Error::Shock(Short { .. }))));
        assert!(matches!(low(&[1.0, f64::INFINITY], 1.0, 0.1, 2), Err(Error::Shock(Sample { sample: 2, .. }))));
        // The shortest, and the closest to half the sampling rate.
        assert_eq!(low(&[4.0], 1.0, 0.1, 8), Ok(vec![4.0]));
        let wild: Vec<f64> = (0..1000).map(|i| if i % 2 == 0 { 1e100 } else { -1e100 }).collect();
        for (pass, cutoff) in [(Pass::Low, 0.499_999_999), (Pass::High, 1e-6), (Pass::High, 0.499_999_999)] {
            let got = butterworth(&wild, 1.0, pass, cutoff, 8).expect("a record");
            assert!(got.iter().all(|a| a.is_finite()), "{pass:?}");
        }
    }
}
