//! The check of a measured shock against the pulse of a standard, within its tolerances.

use crate::levels::{Level, Levels};
use crate::pulse_fit::value;
use crate::samples::{LARGEST, check, float, peak, sum};
use crate::shocks::tenths;
use crate::{Error, Pulse, Shape};
use std::f64::consts::PI;

/// The tolerances of a standard on a measured pulse. A quantity that it does not limit, or limits by a figure that is
/// not built in, is `None`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct PulseTolerance {
    /// Its name on the command line and in files.
    pub keyword: &'static str,
    /// Largest difference of the acceleration from the nominal pulse while that lasts, as a share of its peak.
    pub distortion: Option<f64>,
    /// Largest difference of the duration between the 10 % points from the nominal one: a share of it, or a time in
    /// seconds, whichever is more. The nominal duration then counts between these points too.
    pub duration: Option<(f64, f64)>,
    /// Largest difference of the velocity change from the nominal one, as a share of it. The velocity change counts
    /// from 0.4 D before to 0.1 D after the nominal pulse.
    pub velocity_change: Option<f64>,
    /// Its printed source, and the parts of it that are not built in.
    pub source: &'static str,
}

/// The tolerances that are built in.
pub const PULSE_TOLERANCES: [PulseTolerance; 3] = [
    PulseTolerance {
        keyword: "IEC 60068-2-27",
        distortion: None,
        duration: None,
        velocity_change: Some(0.15),
        source: "IEC 60068-2-27:2008, clause 4: velocity change; figures 1 to 3 (limits of tolerance) are not built in",
    },
    PulseTolerance {
        keyword: "MIL-STD-202/213",
        distortion: None,
        duration: None,
        velocity_change: Some(0.1),
        source: "MIL-STD-202, method 213, shock pulses: velocity change; figures 213-1 and 213-2 are not built in",
    },
    PulseTolerance {
        keyword: "MIL-STD-883/2002",
        distortion: Some(0.2),
        duration: Some((0.3, 1e-4)),
        velocity_change: None,
        source: "MIL-STD-883, method 2002: half-sine, distortion of 20 % of the peak, duration within 0.1 ms or 30 %",
    },
];

/// Begin and end of the interval of the velocity change: durations before the nominal pulse, and after it.
const INTEGRATED: [f64; 2] = [0.4, 0.1];

/// The shortest nominal pulse, in samples, equal to the shortest that is fitted, and the longest, in seconds.
const FEWEST: f64 = 3.0;
const LONGEST_S: f64 = 1e9;

/// Returns a built-in tolerance by its keyword, in capital letters or not.
///
/// ```
/// assert_eq!(clatter_shock::pulse_tolerance("iec 60068-2-27").unwrap().velocity_change, Some(0.15));
/// ```
#[must_use]
pub fn pulse_tolerance(keyword: &str) -> Option<&'static PulseTolerance> {
    static TOLERANCES: [PulseTolerance; 3] = PULSE_TOLERANCES;
    TOLERANCES.iter().find(|tolerance| tolerance.keyword.eq_ignore_ascii_case(keyword))
}

/// A measured value and the range that is allowed.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Within {
    /// The measured value, with the sign of the history.
    pub measured: f64,
    /// The least and the largest allowed value.
    pub allowed: [f64; 2],
}

impl Within {
    /// Returns whether the value is in the range.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.allowed[0] <= self.measured && self.measured <= self.allowed[1]
    }
    /// Creates the range around a nominal value of either sign.
    fn around(measured: f64, nominal: f64, by: f64) -> Self {
        Self { measured, allowed: [nominal - by, nominal + by] }
    }
}

/// The difference of a history from the nominal pulse while that lasts.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Distortion {
    /// The largest difference, history less pulse, m/s².
    pub largest_m_s2: Within,
    /// Time of that difference, s.
    pub largest_s: f64,
    /// Number of samples outside of the allowed range.
    pub outside: usize,
    /// Time of the first of them, s: the history leaves the band there.
    pub leaves_s: Option<f64>,
}

/// The comparison of a history with a nominal pulse.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PulseCheck {
    /// The nominal pulse at the best fit to the history, as its base: it begins and ends at zero.
    pub nominal: Pulse,
    /// Difference from the nominal pulse, if it is limited.
    pub distortion: Option<Distortion>,
    /// Duration between the 10 % points, s, if it is limited.
    pub duration_s: Option<Within>,
    /// Velocity change, m/s, if it is limited.
    pub velocity_change_m_s: Option<Within>,
}

impl PulseCheck {
    /// Returns whether the history keeps all tolerances.
    #[must_use]
    pub fn holds(&self) -> bool {
        let largest = self.distortion.map(|distortion| distortion.largest_m_s2);
        [largest, self.duration_s, self.velocity_change_m_s].iter().flatten().all(Within::holds)
    }
}

/// Compares the main shock of a history with a nominal pulse within the tolerances of a standard.
///
/// The start of the nominal pulse is not used: the pulse is placed where the sum of squares Σ(aᵢ − a p)² is least, of
/// all starts at which it holds the sample of largest size, to 10⁻⁶ of its duration.
///
/// | checked | how |
/// |---|---|
/// | distortion | samples during the pulse, against a p ± share · \|a\| |
/// | duration | between the 10 % points of the largest sample, on straight lines, as [`find_shocks`](crate::find_shocks) |
/// | velocity change | integral of the straight lines between the samples, from 0.4 D before to 0.1 D after |
///
/// # Errors
///
/// [`Error::Quantity`] for an amplitude that is zero or beyond 1e100 m/s², a duration below 3 samples or beyond 1e9 s, a
/// ramp outside (0, ½], or a time between samples outside [1e-15, 1e9] s; [`Error::Sample`]; [`Error::Short`] for fewer than 2 samples;
/// [`Error::NoShock`] where all are zero.
///
/// # Examples
///
/// A half-sine 12 % too large fails MIL-STD-202 and passes IEC 60068-2-27:
///
/// ```
/// use clatter_shock::{Pulse, Shape, check_pulse, pulse_tolerance};
/// let record: Vec<f64> = (0..=300)
///     .map(|i| if (100..200).contains(&i) { 112.0 * (f64::from(i - 100) * 0.01 * std::f64::consts::PI).sin() } else { 0.0 })
///     .collect();
/// let nominal = Pulse { shape: Shape::HalfSine, amplitude: 100.0, duration: 0.01, start: 0.0 };
/// let iec = check_pulse(&record, 1e-4, &nominal, pulse_tolerance("IEC 60068-2-27").unwrap())?;
/// assert!(iec.holds() && (iec.nominal.start - 0.01).abs() < 1e-7);
/// let mil = check_pulse(&record, 1e-4, &nominal, pulse_tolerance("MIL-STD-202/213").unwrap())?;
/// assert!(!mil.holds());
/// # Ok::<(), clatter_shock::Error>(())
/// ```
pub fn check_pulse(
    acceleration: &[f64],
    step_s: f64,
    nominal: &Pulse,
    tolerance: &PulseTolerance,
) -> Result<PulseCheck, Error> {
    check(acceleration, step_s, "a comparison", 2)?;
    if !(nominal.amplitude != 0.0 && nominal.amplitude.abs() <= LARGEST) {
        let (name, value) = ("amplitude (m/s²)", nominal.amplitude);
        return Err(Error::Quantity { name, value, allowed: "other than zero and at most 1e100 in size" });
    }
    if !(nominal.duration >= (1.0 - 1e-9) * FEWEST * step_s && nominal.duration <= LONGEST_S) {
        let (name, value) = ("duration (s)", nominal.duration);
        return Err(Error::Quantity { name, value, allowed: "at least 3 samples and at most 1e9 s" });
    }
    if let Shape::Trapezoid { ramp } = nominal.shape
        && !(ramp > 0.0 && ramp <= 0.5)
    {
        return Err(Error::Quantity { name: "ramp over duration", value: ramp, allowed: "in (0, 0.5]" });
    }
    let top = peak(acceleration);
    if acceleration[top] == 0.0 {
        return Err(Error::NoShock);
    }
    let base = if tolerance.duration.is_some() { base(nominal) } else { *nominal };
    let start = lay(acceleration, float(top), &base, step_s);
    let nominal_s = nominal.duration;
    let nominal = Pulse { start: start * step_s, ..base };
    let record = Levels::of_record(acceleration);
    let distortion =
        tolerance.distortion.map(|share| distortion(&record, &nominal, step_s, share * nominal.amplitude.abs()));
    let duration_s = tolerance.duration.map(|(share, least)| {
        let [first, last] = tenths(acceleration, top, 0..acceleration.len());
        Within::around((last - first) * step_s, nominal_s, (share * nominal_s).max(least))
    });
    let velocity_change_m_s = tolerance.velocity_change.map(|share| {
        let change = nominal.velocity_change();
        let length = nominal.duration / step_s;
        let [before, after] = INTEGRATED;
        let measured = integral(acceleration, start - before * length, start + (1.0 + after) * length) * step_s;
        Within::around(measured, change, share * change.abs())
    });
    Ok(PulseCheck { nominal, distortion, duration_s, velocity_change_m_s })
}

/// Returns the pulse whose duration between the 10 % points is the nominal one.
fn base(nominal: &Pulse) -> Pulse {
    let between = match nominal.shape {
        Shape::HalfSine => 1.0 - 2.0 * libm::asin(0.1) / PI,
        Shape::Haversine => 1.0 - 2.0 * libm::asin(0.1_f64.sqrt()) / PI,
        Shape::Triangle | Shape::InitialPeakSawtooth | Shape::TerminalPeakSawtooth => 0.9,
        Shape::Rectangle => 1.0,
        Shape::Trapezoid { ramp } => 1.0 - 0.2 * ramp,
    };
    Pulse { duration: nominal.duration / between, ..*nominal }
}

/// Returns the start, in samples, at which the pulse fits best and holds the time `top`.
fn lay(acceleration: &[f64], top: f64, pulse: &Pulse, step_s: f64) -> f64 {
    let size = pulse.amplitude.abs();
    let scaled: Vec<f64> = acceleration.iter().map(|a| a / size).collect();
    let levels = Levels::new(&scaled);
    let (duration, sign) = (pulse.duration / step_s, pulse.amplitude.signum());
    let level = levels.fine(duration);
    // This is the decrease of the sum of squares by the pulse.
    let gain = |start: f64| {
        let terms = level.within(start, start + duration).map(|(t, a)| {
            let [p, _] = value(pulse.shape, (t - start) / duration);
            p * (2.0 * sign * a - p)
        });
        terms.sum::<f64>()
    };
    // A grid of 64 starts comes first, then four grids, each sixteen times as fine around the best: 64 · 16⁴ > 10⁶.
    let (mut best, mut most) = (top - 0.5 * duration, f64::NEG_INFINITY);
    let mut reach = 0.5 * duration;
    for _ in 0..5 {
        let center = best;
        for i in -32..=32 {
            let start = (center + reach * f64::from(i) / 32.0).clamp(top - duration, top);
            let lowered = gain(start);
            if lowered > most {
                (best, most) = (start, lowered);
            }
        }
        reach /= 16.0;
    }
    best
}

/// Returns the difference of the samples from the pulse while that lasts, if `by` is allowed.
fn distortion(record: &Level, pulse: &Pulse, step_s: f64, by: f64) -> Distortion {
    let (mut largest, mut largest_s, mut outside, mut leaves_s) = (0.0_f64, pulse.start, 0, None);
    let first = pulse.start / step_s;
    for (t, a) in record.within(first, first + pulse.duration / step_s) {
        let [p, _] = value(pulse.shape, (t - first) * step_s / pulse.duration);
        let difference = a - pulse.amplitude * p;
        if difference.abs() > largest.abs() {
            (largest, largest_s) = (difference, t * step_s);
        }
        if difference.abs() > by {
            outside += 1;
            leaves_s.get_or_insert(t * step_s);
        }
    }
    Distortion { largest_m_s2: Within::around(largest, 0.0, by), largest_s, outside, leaves_s }
}

/// Returns the integral of the straight lines from one time to another, in samples; the history is zero before and
/// after.
fn integral(acceleration: &[f64], first: f64, last: f64) -> f64 {
    let lines = acceleration.windows(2).enumerate().map(|(i, w)| {
        let from = (first - float(i)).clamp(0.0, 1.0);
        let to = (last - float(i)).clamp(0.0, 1.0);
        // This is the value in the middle of the part within the bounds.
        (to - from) * (w[0] + 0.5 * (from + to) * (w[1] - w[0]))
    });
    sum(lines)
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: f64 = 1e-5;

    fn half_sine(amplitude: f64, samples: f64, start: f64, n: usize) -> Vec<f64> {
        let at = |i| (float(i) - start) / samples;
        let within = |u: &f64| (0.0..=1.0).contains(u);
        (0..n).map(|i| Some(at(i)).filter(within).map_or(0.0, |u| amplitude * (PI * u).sin())).collect()
    }

    fn tolerance(keyword: &str) -> &'static PulseTolerance {
        pulse_tolerance(keyword).expect("built in")
    }

    /// Every tolerance holds just within its edges and fails just outside.
    #[test]
    fn the_edges_of_a_tolerance_are_where_the_standard_has_them() {
        let nominal = Pulse { shape: Shape::HalfSine, amplitude: -4900.0, duration: 0.002, start: 0.0 };
        let velocity = |keyword, ratio: f64| {
            let record = half_sine(-4900.0 * ratio, 200.0, 300.4, 800);
            let got = check_pulse(&record, STEP, &nominal, tolerance(keyword)).expect("a shock");
            assert!(got.distortion.is_none() && got.duration_s.is_none(), "{got:?}");
            assert!((got.nominal.start - 300.4 * STEP).abs() < 2e-6 * 0.002, "{got:?}");
            let within: Within = got.velocity_change_m_s.expect("limited");
            // Straight lines lose (π/200)²/12 = 2e-5 of it; partial ones at the ends as much again.
            let want = 2.0 / PI * -4900.0 * ratio * 0.002;
            assert!((within.measured / want - 1.0).abs() < 5e-5, "{within:?} {want}");
            got.holds()
        };
        for (keyword, share) in [("IEC 60068-2-27", 0.15), ("MIL-STD-202/213", 0.1)] {
            for side in [-1.0, 1.0] {
                assert!(velocity(keyword, 1.0 + side * (share - 1e-3)), "{keyword} {side}");
                assert!(!velocity(keyword, 1.0 + side * (share + 1e-3)), "{keyword} {side}");
            }
        }
        // MIL-STD-883: 0.5 ms between 10 % points within 30 %, 0.2 ms within 0.1 ms.
        let between = 1.0 - 2.0 * 0.1_f64.asin() / PI;
        for (nominal_s, by) in [(5e-4, 1.5e-4), (2e-4, 1e-4)] {
            for (ratio, holds) in [(-1.0, true), (-1.02, false), (1.0, true), (1.02, false)] {
                let step = 1e-7;
                let samples = (nominal_s + by * ratio * 0.995) / between / step;
                let record = half_sine(14_700.0, samples, 2000.0, 20_000);
                let nominal = Pulse { amplitude: 14_700.0, duration: nominal_s, ..nominal };
                let got = check_pulse(&record, step, &nominal, tolerance("MIL-STD-883/2002")).expect("a shock");
                let duration = got.duration_s.expect("limited");
                assert_eq!(duration.holds(), holds, "{nominal_s} {ratio}: {got:?}");
                assert!((got.nominal.duration * between - nominal_s).abs() < 1e-15, "{got:?}");
                assert!((duration.measured - samples * between * step).abs() < step, "{got:?}");
            }
        }
    }

    #[test]
    fn a_departure_is_told_where_it_is() {
        let base_s = 5e-4 / (1.0 - 2.0 * 0.1_f64.asin() / PI);
        let nominal = Pulse { shape: Shape::HalfSine, amplitude: 1000.0, duration: 5e-4, start: 0.0 };
        let clean = half_sine(1000.0, base_s / 1e-6, 200.0, 1000);
        let check =
            |record: &[f64]| check_pulse(record, 1e-6, &nominal, tolerance("MIL-STD-883/2002")).expect("a shock");
        assert!(check(&clean).holds());
        // A dent and a spike of 210 and 250 m/s², one sample each: 200 are allowed.
        let mut record = clean.clone();
        record[300] -= 210.0;
        record[350] -= 250.0;
        let got = check(&record);
        let distortion = got.distortion.expect("limited");
        assert!(!got.holds() && distortion.outside == 2, "{got:?}");
        let leaves_s = distortion.leaves_s.expect("outside");
        assert!((leaves_s - 300e-6).abs() < 1e-12 && (distortion.largest_s - 350e-6).abs() < 1e-12, "{got:?}");
        // The dents shift the pulse by less than a sample, of slope π · 1000/534 each.
        let Within { measured, allowed } = distortion.largest_m_s2;
        assert!((measured + 250.0).abs() < 6.0 && (allowed[1] - allowed[0] - 400.0).abs() < 1e-9, "{got:?}");
    }

    /// A terminal-peak sawtooth whose end falls to zero within a sample, and its velocity change.
    #[test]
    fn other_shapes_are_laid_as_well() {
        let shapes = [
            Shape::Haversine,
            Shape::Triangle,
            Shape::InitialPeakSawtooth,
            Shape::TerminalPeakSawtooth,
            Shape::Rectangle,
            Shape::Trapezoid { ramp: 0.1 },
        ];
        for shape in shapes {
            let pulse = Pulse { shape, amplitude: 300.0, duration: 0.011, start: 0.02 };
            let record: Vec<f64> =
                (0..6000).map(|i| 300.0 * value(shape, (float(i) * STEP - 0.02) / 0.011)[0]).collect();
            let got = check_pulse(&record, STEP, &pulse, tolerance("IEC 60068-2-27")).expect("a shock");
            // The pulse jumps within a sample.
            assert!((got.nominal.start - 0.02).abs() < 1.01 * STEP, "{shape:?}: {got:?}");
            let change = got.velocity_change_m_s.expect("limited").measured;
            assert!((change - pulse.velocity_change()).abs() < 300.0 * STEP, "{shape:?}: {got:?}");
            assert!(got.holds(), "{shape:?}");
        }
    }

    /// The duration that a standard states between points at a tenth of the peak is that between them, of any shape.
    #[test]
    fn a_pulse_is_as_long_between_its_tenths_as_stated() {
        let shapes = [
            Shape::HalfSine,
            Shape::Haversine,
            Shape::Triangle,
            Shape::InitialPeakSawtooth,
            Shape::TerminalPeakSawtooth,
            Shape::Rectangle,
            Shape::Trapezoid { ramp: 0.3 },
        ];
        for shape in shapes {
            let pulse = base(&Pulse { shape, amplitude: 1.0, duration: 0.5, start: 0.0 });
            let steps = 100_000;
            let above = (0..steps).filter(|i| value(shape, (float(*i) + 0.5) / float(steps))[0] > 0.1).count();
            let between = pulse.duration * float(above) / float(steps);
            // A step at either end.
            assert!((between / 0.5 - 1.0).abs() < 3e-5, "{shape:?}: {between}");
        }
    }

    #[test]
    fn what_cannot_be_compared_is_refused() {
        let iec = tolerance("IEC 60068-2-27");
        let nominal = Pulse { shape: Shape::HalfSine, amplitude: 1.0, duration: 4.0, start: 0.0 };
        for bad in [
            Pulse { amplitude: 0.0, ..nominal },
            Pulse { amplitude: f64::NAN, ..nominal },
            Pulse { amplitude: 1e101, ..nominal },
            Pulse { duration: -1.0, ..nominal },
            Pulse { duration: 2.9, ..nominal },
            Pulse { duration: f64::NAN, ..nominal },
            Pulse { duration: f64::INFINITY, ..nominal },
            Pulse { shape: Shape::Trapezoid { ramp: 0.6 }, ..nominal },
        ] {
            assert!(matches!(check_pulse(&[1.0, 2.0], 1.0, &bad, iec), Err(Error::Quantity { .. })), "{bad:?}");
        }
        assert_eq!(check_pulse(&[0.0, 0.0], 1.0, &nominal, iec), Err(Error::NoShock));
        assert!(matches!(check_pulse(&[1.0], 1.0, &nominal, iec), Err(Error::Short { .. })));
        // The pulses fitted to the shortest possible shock are accepted.
        let mut spike = [0.0; 200];
        spike[50] = 1000.0;
        for fit in crate::fit_pulses(&spike, 1e-5).expect("a spike is a shock") {
            assert!(check_pulse(&spike, 1e-5, &fit.pulse, iec).is_ok(), "{fit:?}");
        }
        // Pulses that differ from the history by far in size and length get an answer in finite time.
        for (amplitude, duration) in [(1e-300, 4.0), (1e100, 1e9), (1.0, 1e9), (-1e90, 5.0)] {
            let nominal = Pulse { amplitude, duration, ..nominal };
            for tolerance in &PULSE_TOLERANCES {
                let got = check_pulse(&[1.0, 2.0, 1.0], 1.0, &nominal, tolerance).expect("an answer");
                assert!(!got.holds(), "{got:?}");
            }
        }
    }

    /// IEC 60068-2-27 integrates from 0.4 D before the nominal pulse to 0.1 D after it: the acceleration there counts,
    /// and nothing beyond.
    #[test]
    fn the_velocity_change_counts_from_before_the_pulse_to_after_it() {
        let (n, before, after) = (1000, 7.0, 30.0);
        let pulse = Pulse { shape: Shape::HalfSine, amplitude: 5000.0, duration: float(n) * STEP, start: 0.0 };
        let mut record = half_sine(5000.0, float(n), 1000.0, 3000);
        record[..1000].fill(before);
        record[1000 + n + 1..].fill(after);
        let got = check_pulse(&record, STEP, &pulse, tolerance("IEC 60068-2-27")).expect("a shock");
        let want = (2.0 / PI * 5000.0 + 0.4 * before + 0.1 * after) * pulse.duration;
        // Straight lines lose (π/1000)²/12 of the pulse; where the levels begin, a sample of each.
        let allowed = 1e-6 * want + (before + after) * STEP;
        let measured = got.velocity_change_m_s.expect("limited").measured;
        assert!((measured - want).abs() < allowed, "{measured}, not {want}");
    }
}
