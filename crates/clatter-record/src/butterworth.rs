//! Butterworth filters that shift nothing in time: forward and backward over the record.

use crate::Error;
use clatter_shock::samples::{check, float};
use std::f64::consts::{FRAC_PI_2, PI, SQRT_2};

/// The part of a record that a filter lets through.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Pass {
    /// Frequencies below the cutoff.
    Low,
    /// Frequencies above it.
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
    /// Returns what is left of a constant.
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
