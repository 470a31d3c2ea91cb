//! The classical pulse that fits the main shock of a history best.

use crate::levels::{Level, Levels};
use crate::samples::{check, float, peak, sum};
use crate::{Error, Pulse, Shape};
use std::f64::consts::{PI, TAU};

/// A pulse fitted to a history.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PulseFit {
    /// Amplitude in m/s² with its sign; duration and start in seconds, from the first sample.
    pub pulse: Pulse,
    /// Residual: root mean square of history less pulse over that of the history, from half a duration before the
    /// earliest of the three fits to half a duration after the last.
    pub residual: f64,
}

/// The shapes that are fitted.
const SHAPES: [Shape; 3] = [Shape::HalfSine, Shape::Haversine, Shape::TerminalPeakSawtooth];
/// The shortest pulse, in samples: three lie within it, for its three unknowns.
const SHORTEST: f64 = 4.0;
/// Durations of the grid, to the octave: 9 % apart, of which half lies well within the range of convergence of the
/// refinement.
const PER_OCTAVE: u32 = 8;
/// Starts of the grid for each duration.
const STARTS: u32 = 32;
/// The most steps of the refinement; each one doubles the digits.
const STEPS: usize = 60;
/// The most steps for a line, which ends with the second step unless a sample comes in or falls out.
const LINE_STEPS: usize = 12;
/// Steps, in durations, whose gain is hardly above its rounding: their squares are below 1e-12.
const SMALL: f64 = 1e-6;

/// Fits a half-sine, a haversine and a terminal-peak sawtooth to the main shock of a history; the best one first.
///
/// Each fit is the pulse a p((t − s)/D) with the least sum of squares Σ(aᵢ − a p)² over all samples, among those that
/// hold the sample of largest size. For a start s and a duration D the amplitude is a = Σaᵢp/Σp², and Σaᵢ² falls by
/// (Σaᵢp)²/Σp². This gain is first searched on a grid of all durations from 4 samples to the whole history, 9 % apart,
/// and 33 starts each; the best one is refined by Gauss–Newton steps (variable projection; Golub and Pereyra 1973),
/// damped where a step gains nothing. A sawtooth ends halfway between two samples: of all such ends near that of the
/// grid the one with the largest gain is taken.
///
/// Long pulses are fitted to averages over blocks of samples, 2048 or more to the duration.
///
/// # Accuracy
///
/// A clean half-sine or haversine of 4 to 4096 samples comes back to 1e-12 in amplitude, duration and start (of the
/// duration), a longer one to 2e-7. A sawtooth comes back within half a sample in duration and end, and within half a
/// sample over its duration in amplitude; beyond 4096 samples, within half a block. Equal histories give equal fits.
///
/// # Errors
///
/// [`Error::Quantity`] for a time between samples outside [1e-15, 1e9] s; [`Error::Sample`]; [`Error::Short`] for fewer
/// than 5 samples; [`Error::NoShock`] where all are zero.
///
/// # Examples
///
/// ```
/// use clatter_shock::{Shape, fit_pulses};
/// // 500 m/s² for 2 ms, from 1.005 ms on, a sample every 50 µs
/// let record: Vec<f64> = (0..100)
///     .map(|i| {
///         let u = (f64::from(i) * 50e-6 - 1.005e-3) / 2e-3;
///         if (0.0..=1.0).contains(&u) { 500.0 * (std::f64::consts::PI * u).sin() } else { 0.0 }
///     })
///     .collect();
/// let [best, second, _] = fit_pulses(&record, 50e-6)?;
/// assert_eq!(best.pulse.shape, Shape::HalfSine);
/// assert!((best.pulse.amplitude - 500.0).abs() < 1e-6 && (best.pulse.duration - 2e-3).abs() < 1e-11);
/// assert!((best.pulse.start - 1.005e-3).abs() < 1e-11 && best.residual < 1e-8);
/// assert!(second.residual > 0.05);
/// # Ok::<(), clatter_shock::Error>(())
/// ```
pub fn fit_pulses(acceleration: &[f64], step_s: f64) -> Result<[PulseFit; 3], Error> {
    check(acceleration, step_s, "a fit", 5)?;
    let top = peak(acceleration);
    if acceleration[top] == 0.0 {
        return Err(Error::NoShock);
    }
    // Values are in units of the peak and of samples, where no square overflows.
    let size = acceleration[top].abs();
    let scaled: Vec<f64> = acceleration.iter().map(|a| a / size).collect();
    let levels = Levels::new(&scaled);
    let mut fits = SHAPES.map(|shape| Trial::fit(&levels, shape, float(top)));
    fits.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    let first = fits.iter().map(|f| f.start - 0.5 * f.duration).fold(f64::INFINITY, f64::min);
    let last = fits.iter().map(|f| f.start + 1.5 * f.duration).fold(0.0, f64::max);
    let record = levels.finest();
    Ok(fits.map(|fit| PulseFit {
        pulse: Pulse {
            shape: fit.shape,
            amplitude: fit.amplitude * size,
            duration: fit.duration * step_s,
            start: fit.start * step_s,
        },
        residual: fit.residual(&record, first, last),
    }))
}

/// A pulse of the search: start and duration in samples.
#[derive(Debug, Clone, Copy)]
struct Trial {
    shape: Shape,
    start: f64,
    duration: f64,
    amplitude: f64,
    /// Decrease of the sum of squares.
    gain: f64,
}

/// Returns the acceleration of a pulse at a time, in m/s²; zero outside of it.
///
/// ```
/// use clatter_shock::{Pulse, Shape};
/// let pulse = Pulse { shape: Shape::Triangle, amplitude: 10.0, duration: 2.0, start: 1.0 };
/// assert_eq!([0.5, 1.5, 2.0].map(|time_s| clatter_shock::pulse_at(&pulse, time_s)), [0.0, 5.0, 10.0]);
/// ```
#[must_use]
pub fn pulse_at(pulse: &Pulse, time_s: f64) -> f64 {
    pulse.amplitude * value(pulse.shape, (time_s - pulse.start) / pulse.duration)[0]
}

/// Returns the shape at u = (t − s)/D, and its slope.
pub(crate) fn value(shape: Shape, u: f64) -> [f64; 2] {
    if !(0.0..=1.0).contains(&u) {
        return [0.0; 2];
    }
    match shape {
        Shape::HalfSine => {
            let (sin, cos) = libm::sincos(PI * u);
            [sin, PI * cos]
        }
        Shape::Haversine => {
            let (sin, cos) = libm::sincos(TAU * u);
            [0.5 - 0.5 * cos, PI * sin]
        }
        Shape::Triangle => {
            if u < 0.5 {
                [2.0 * u, 2.0]
            } else {
                [2.0 - 2.0 * u, -2.0]
            }
        }
        Shape::InitialPeakSawtooth => [1.0 - u, -1.0],
        Shape::TerminalPeakSawtooth => [u, 1.0],
        Shape::Rectangle => [1.0, 0.0],
        Shape::Trapezoid { ramp } => {
            if u < ramp {
                [u / ramp, ramp.recip()]
            } else if u > 1.0 - ramp {
                [(1.0 - u) / ramp, -ramp.recip()]
            } else {
                [1.0, 0.0]
            }
        }
    }
}

impl Trial {
    /// Creates a trial with the amplitude of least squares on a level.
    fn at(level: &Level, shape: Shape, start: f64, duration: f64) -> Self {
        let (mut pp, mut pa) = (0.0, 0.0);
        for (t, a) in level.within(start, start + duration) {
            let [p, _] = value(shape, (t - start) / duration);
            pp += p * p;
            pa += p * a;
        }
        let amplitude = if pp > 0.0 { pa / pp } else { 0.0 };
        Self { shape, start, duration, amplitude, gain: level.width * amplitude * pa }
    }
    /// Returns the best of all pulses that hold the time `top`.
    fn fit(levels: &Levels, shape: Shape, top: f64) -> Self {
        let best = Self::on_grid(levels, shape, top);
        let level = levels.fine(best.duration);
        if shape == Shape::TerminalPeakSawtooth {
            best.refine_sawtooth(&level)
        } else {
            best.refine(&level, levels.length() + 1.0)
        }
    }
    /// Returns the best pulse of the grid.
    fn on_grid(levels: &Levels, shape: Shape, top: f64) -> Self {
        let longest = levels.length() + 1.0;
        let mut best = Self { shape, start: top - 0.5 * SHORTEST, duration: SHORTEST, amplitude: 0.0, gain: -1.0 };
        for k in 0.. {
            let duration = SHORTEST * libm::exp2(f64::from(k) / f64::from(PER_OCTAVE));
            if duration > longest {
                return best;
            }
            let level = levels.coarse(duration);
            for i in 0..=STARTS {
                let start = top - duration * f64::from(i) / f64::from(STARTS);
                // The pulse reaches no further than a sample beyond the history.
                if start >= -1.0 && start + duration <= longest {
                    let trial = Self::at(&level, shape, start, duration);
                    if trial.gain > best.gain {
                        best = trial;
                    }
                }
            }
        }
        best
    }
    /// Refines start and duration by Gauss–Newton steps; the amplitude follows. The pulse ends at `latest` at the
    /// latest.
    fn refine(self, level: &Level, latest: f64) -> Self {
        let mut best = Self::at(level, self.shape, self.start, self.duration);
        let (mut damping, mut last) = (0.0, f64::INFINITY);
        for _ in 0..STEPS {
            let [by_start, by_duration] = best.step(level, damping);
            let moved = by_start.abs().max(by_duration.abs());
            let (start, duration) = (best.start + by_start * best.duration, best.duration * (1.0 + by_duration));
            let within = duration >= SHORTEST && start >= -1.0 && start + duration <= latest;
            let trial = Self::at(level, self.shape, start, duration);
            // The gain of the last digits is below rounding; there the steps must shrink instead.
            if within && (trial.gain > best.gain || (moved < SMALL && moved < 0.5 * last)) {
                (best, last) = (trial, moved);
                damping *= 0.1;
            } else {
                damping = if damping == 0.0 { 1e-3 } else { 10.0 * damping };
            }
            if moved < 1e-14 {
                break;
            }
        }
        best
    }
    /// Returns the changes of start and duration to the next trial, in durations.
    fn step(&self, level: &Level, damping: f64) -> [f64; 2] {
        let [mut pp, mut ps, mut pd, mut ss, mut sd, mut dd, mut rs, mut rd] = [0.0; 8];
        for (t, a) in level.within(self.start, self.start + self.duration) {
            let u = (t - self.start) / self.duration;
            let [p, slope] = value(self.shape, u);
            let (s, d, rest) = (-slope, -u * slope, a - self.amplitude * p);
            pp += p * p;
            ps += p * s;
            pd += p * d;
            ss += s * s;
            sd += s * d;
            dd += d * d;
            rs += rest * s;
            rd += rest * d;
        }
        // The part along the pulse itself is removed: the amplitude takes it.
        let (ss, sd, dd) = (ss - ps * ps / pp, sd - ps * pd / pp, dd - pd * pd / pp);
        let (ss, dd) = (ss * (1.0 + damping), dd * (1.0 + damping));
        let scale = self.amplitude * (ss * dd - sd * sd);
        let step = [(dd * rs - sd * rd) / scale, (ss * rd - sd * rs) / scale];
        // No step is longer than a tenth: the grid is closer than that.
        step.map(|x| if x.is_finite() { x.clamp(-0.1, 0.1) } else { 0.0 })
    }
    /// Returns the pulse with the best start for every end near that of the grid, each end halfway between two samples.
    fn refine_sawtooth(self, level: &Level) -> Self {
        let reach = self.duration / f64::from(STARTS) + level.width;
        let near = self.start + self.duration;
        let mut best = Self::at(level, self.shape, self.start, self.duration);
        for (t, _) in level.within(near - reach, near + reach) {
            let end = t + 0.5 * level.width;
            // A pulse of the shortest duration may end half a sample early or late.
            let latest = end - (SHORTEST - 1.0);
            if latest < -1.0 {
                continue;
            }
            let mut start = self.start.min(latest);
            // The start is the zero of the straight line through the samples, until these are the ones between zero and
            // end.
            for _ in 0..LINE_STEPS {
                let [mut n, mut lp, mut la, mut pp, mut pa] = [0.0; 5];
                for (t, a) in level.within(start, end) {
                    let p = t - start;
                    n += 1.0;
                    lp += p;
                    la += a;
                    pp += p * p;
                    pa += p * a;
                }
                let slope = (n * pa - lp * la) / (n * pp - lp * lp);
                let by = (lp - la / slope) / n;
                if !by.is_finite() {
                    break;
                }
                // The start stays short of the end and within the history, whatever the noise.
                let next = (start + by).clamp(-1.0, latest);
                let moved = (next - start).abs();
                start = next;
                if moved < 1e-14 * self.duration {
                    break;
                }
            }
            let trial = Self::at(level, self.shape, start, end - start);
            if trial.gain >= best.gain {
                best = trial;
            }
        }
        best
    }
    /// Returns the root mean square of the residual, over that of the history, between two times.
    fn residual(&self, record: &Level, first: f64, last: f64) -> f64 {
        let rest = |(t, a)| {
            let [p, _] = value(self.shape, (t - self.start) / self.duration);
            (a - self.amplitude * p) * (a - self.amplitude * p)
        };
        let all = sum(record.within(first, last).map(|(_, a)| a * a));
        (sum(record.within(first, last).map(rest)) / all).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the value of a shape, written down on its own.
    fn shape(shape: Shape, u: f64) -> f64 {
        match shape {
            _ if !(0.0..=1.0).contains(&u) => 0.0,
            Shape::HalfSine => (PI * u).sin(),
            Shape::Haversine => (PI * u).sin().powi(2),
            Shape::TerminalPeakSawtooth => u,
            other => panic!("{other:?}"),
        }
    }

    fn record(n: usize, pulse: &Pulse, step: f64) -> Vec<f64> {
        let at = |i| (float(i) * step - pulse.start) / pulse.duration;
        (0..n).map(|i| pulse.amplitude * shape(pulse.shape, at(i))).collect()
    }

    fn of(fits: &[PulseFit], shape: Shape) -> Pulse {
        fits.iter().find(|fit| fit.pulse.shape == shape).expect("every shape").pulse
    }

    #[test]
    fn clean_pulses_come_back() {
        let step = 2.5e-5;
        for kind in SHAPES {
            let every_length = (0..60).map(|i| (1001, 4.0 + 11.7 * f64::from(i), 20.0 + 1.37 * f64::from(i)));
            for (n, samples, start) in every_length.chain([
                (40, 4.3, 11.7),
                (60, 17.0, 20.0),
                (500, 100.3, 3.25),
                (1000, 940.0, 30.5),
                (3000, 2000.7, 500.1),
                (400_000, 30_000.4, 150_000.3),
                (400_000, 390_000.0, 5000.5),
                (200_000, 80.2, 180_000.9),
            ]) {
                let amplitude = if n % 40 == 0 { -3000.0 } else { 12.0 };
                let pulse = Pulse { shape: kind, amplitude, duration: samples * step, start: start * step };
                let record = record(n, &pulse, step);
                let fits = fit_pulses(&record, step).expect("a shock");
                let got = of(&fits, kind);
                let told = format!("{kind:?}, {samples} samples: {got:?}, not {pulse:?}");
                let errors = [
                    (got.amplitude / amplitude - 1.0).abs(),
                    (got.duration / pulse.duration - 1.0).abs(),
                    (got.start - pulse.start).abs() / pulse.duration,
                    (got.start + got.duration - pulse.start - pulse.duration).abs() / pulse.duration,
                ];
                // The allowed errors are those stated; for a sawtooth of blocks as of samples, because one block of
                // 2048 is longer than one sample.
                let allowed = if kind == Shape::TerminalPeakSawtooth {
                    1e-9 + 0.5 / samples.min(2048.0)
                } else if samples < 4096.0 {
                    1e-12
                } else {
                    2e-7
                };
                assert!(errors.iter().all(|e| *e <= allowed), "{told}: {errors:?}");
                if samples > 50.0 {
                    assert_eq!(fits[0].pulse.shape, kind, "{told}");
                    assert!(
                        fits[0].residual < if kind == Shape::TerminalPeakSawtooth { 0.12 } else { 1e-5 },
                        "{fits:?}"
                    );
                    assert!(fits[1].residual > 0.05, "{fits:?}");
                }
            }
        }
    }

    /// Returns the sum of squares over all samples, with the amplitude that makes it least.
    fn squares(record: &[f64], kind: Shape, start: f64, duration: f64) -> f64 {
        let p = |i| shape(kind, (float(i) - start) / duration);
        let pa: f64 = (0..record.len()).map(|i| p(i) * record[i]).sum();
        let pp: f64 = (0..record.len()).map(|i| p(i) * p(i)).sum();
        let amplitude = if pp > 0.0 { pa / pp } else { 0.0 };
        (0..record.len()).map(|i| (record[i] - amplitude * p(i)).powi(2)).sum()
    }

    /// No start and duration of a grid four times as fine fits better, on histories with noise, ringing and a second
    /// shock.
    #[test]
    fn no_other_pulse_fits_better() {
        let mut seed = 99_u64;
        let mut noise = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            float(usize::try_from(seed >> 40).expect("24 bits")) / 8_388_608.0 - 1.0
        };
        for (kind, samples) in [(Shape::HalfSine, 30.0), (Shape::Haversine, 45.5), (Shape::TerminalPeakSawtooth, 25.0)]
        {
            let pulse = Pulse { shape: kind, amplitude: 100.0, duration: samples, start: 40.3 };
            let mut record = record(140, &pulse, 1.0);
            for (i, a) in record.iter_mut().enumerate() {
                *a += 8.0 * noise() + 12.0 * (1.9 * float(i)).sin() + if (110..125).contains(&i) { 40.0 } else { 0.0 };
            }
            let top = float(peak(&record));
            for fit in fit_pulses(&record, 1.0).expect("a shock") {
                let Pulse { shape: fitted, duration, start, amplitude } = fit.pulse;
                let got = squares(&record, fitted, start, duration);
                let mut least = f64::INFINITY;
                for k in 0..155 {
                    let duration = SHORTEST * 1.022_f64.powi(k);
                    for j in 0..=128 {
                        let start = top - duration * f64::from(j) / 128.0;
                        if start >= -1.0 && start + duration <= 140.0 {
                            least = least.min(squares(&record, fitted, start, duration));
                        }
                    }
                }
                assert!(got <= least * (1.0 + 1e-12), "{kind:?} by {fitted:?}: {got}, the grid has {least}");
                // The amplitude is that of this sum.
                let p = |i: usize| shape(fitted, (float(i) - start) / duration);
                let rest: f64 = (0..140).map(|i| (record[i] - amplitude * p(i)) * p(i)).sum();
                assert!(rest.abs() < 1e-9 * got, "{fit:?}: {rest}");
            }
        }
    }

    #[test]
    fn any_record_has_fits_and_none_that_is_no_record() {
        for record in [
            vec![1.0; 5],
            vec![0.0, 0.0, 0.0, 0.0, -1.0],
            vec![1e100, -1e100, 1e100, -1e100, 1e100, -1e100],
            vec![1e-300, 0.0, 0.0, 0.0, 0.0],
            (0..1000).map(float).collect(),
            (0..5000).map(|i| if i % 2 == 0 { 1.0 } else { -1.0 }).collect(),
        ] {
            for fit in fit_pulses(&record, 1e-3).expect("a shock") {
                let Pulse { amplitude, duration, start, .. } = fit.pulse;
                let finite = [amplitude, duration, start, fit.residual].iter().all(|x| x.is_finite());
                assert!(finite && duration > 0.0, "{:?}: {fit:?}", &record[..5]);
                // No fit is worse than none.
                assert!((0.0..=1.0 + 1e-12).contains(&fit.residual), "{:?}: {fit:?}", &record[..5]);
            }
        }
        assert_eq!(fit_pulses(&[0.0; 10], 1.0), Err(Error::NoShock));
        assert!(matches!(fit_pulses(&[1.0; 4], 1.0), Err(Error::Short { samples: 4, needed: 5, .. })));
        assert!(matches!(fit_pulses(&[f64::NAN; 5], 1.0), Err(Error::Sample { .. })));
        assert!(matches!(fit_pulses(&[1.0; 5], 0.0), Err(Error::Quantity { .. })));
    }
}
