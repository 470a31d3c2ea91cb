//! The pulse of a shape whose spectrum is nowhere below another.

use crate::{Error, Frequencies, Pulse, Pulses, Shape, Spectrum};

/// A pulse whose spectrum is nowhere below a given one, and its excess.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct EnvelopingPulse {
    /// The pulse, from time zero; its amplitude is positive.
    pub pulse: Pulse,
    /// The largest excess of its spectrum, in dB.
    pub most_db: f64,
    /// Frequency of the largest excess, Hz.
    pub most_hz: f64,
    /// Mean excess over the frequencies, in dB.
    pub mean_db: f64,
}

/// Durations to the octave in the first search, and steps on either side of the best one in each finer search.
const PER_OCTAVE: f64 = 8.0;
const CLOSER: i32 = 8;

impl EnvelopingPulse {
    /// Returns the pulse of a shape whose spectrum is above the given one by the least mean excess, in dB over its
    /// frequencies, of all durations, each with its least amplitude. A spectrum of zero has none.
    ///
    /// # Method
    /// The spectrum s of a pulse of unit amplitude depends on its duration D alone; A(D) = max S/s over the
    /// frequencies. The mean of 20 log₁₀(A s/S) is minimized on a grid of durations, 8 to the octave, from a hundredth
    /// of the shortest period to ten of the longest, then twice on a grid eight times finer: D is good to 0.1 %.
    /// Frequencies where the spectrum is zero do not count.
    ///
    /// # Examples
    /// The spectrum of a half-sine is enveloped by that half-sine:
    ///
    /// ```
    /// use clatter_shock::{DampingRatio, EnvelopingPulse, Frequencies, Pulse, Pulses, Quantity, Shape};
    /// let pulse = Pulse { shape: Shape::HalfSine, amplitude: 500.0, duration: 2e-3, start: 0.0 };
    /// let frequencies = Frequencies::per_octave(10.0, 2000.0, 6.0)?;
    /// let spectrum = Pulses::new(&[pulse])?.spectrum(&frequencies, DampingRatio::new(0.05)?, Quantity::AbsoluteAcceleration);
    /// let found = EnvelopingPulse::of(&spectrum, Shape::HalfSine)?.unwrap();
    /// assert!((found.pulse.duration / 2e-3 - 1.0).abs() < 2e-3 && (found.pulse.amplitude / 500.0 - 1.0).abs() < 2e-3);
    /// assert!(found.most_db < 0.03);
    /// # Ok::<(), clatter_shock::Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`Pulses::new`] for an invalid shape.
    pub fn of(spectrum: &Spectrum, shape: Shape) -> Result<Option<Self>, Error> {
        let given: Vec<(f64, f64)> = spectrum
            .frequency_hz
            .iter()
            .copied()
            .zip(spectrum.maximax.iter().copied())
            .filter(|(_, level)| *level > 0.0 && level.is_finite())
            .collect();
        let hz: Vec<f64> = given.iter().map(|(hz, _)| *hz).collect();
        let (low, high) = hz.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), hz| (low.min(*hz), high.max(*hz)));
        if hz.is_empty() {
            return Ok(None);
        }
        let frequencies = Frequencies::list(hz)?;
        let of = |duration: f64| {
            let unit = Pulse { shape, amplitude: 1.0, duration, start: 0.0 };
            let answer = Pulses::new(&[unit])?.spectrum(&frequencies, spectrum.damping, spectrum.quantity);
            let amplitude =
                given.iter().zip(&answer.maximax).map(|((_, level), of_unit)| level / of_unit).fold(0.0, f64::max);
            let over = given
                .iter()
                .zip(&answer.maximax)
                .map(|((hz, level), of_unit)| (*hz, 20.0 * libm::log10(amplitude * of_unit / level)));
            let (mut most, mut sum) = ((f64::NAN, f64::NEG_INFINITY), 0.0);
            for (hz, db) in over {
                sum += db;
                if db > most.1 {
                    most = (hz, db);
                }
            }
            #[expect(clippy::cast_precision_loss, reason = "a number of frequencies")]
            let mean_db = sum / given.len() as f64;
            let pulse = Pulse { amplitude, ..unit };
            Ok::<_, Error>(Self { pulse, most_db: most.1, most_hz: most.0, mean_db })
        };
        let [shortest, longest] = [1e-2 / high, 10.0 / low];
        let octaves = libm::log2(longest / shortest);
        let mut best: Option<Self> = None;
        let mut take = |duration: f64| {
            let found = of(duration)?;
            if found.pulse.amplitude.is_finite() && best.is_none_or(|best| found.mean_db < best.mean_db) {
                best = Some(found);
            }
            Ok::<_, Error>(best.map_or(duration, |best| best.pulse.duration))
        };
        let mut center = shortest;
        let mut k = 0.0;
        while k <= octaves * PER_OCTAVE {
            center = take(shortest * libm::exp2(k / PER_OCTAVE))?;
            k += 1.0;
        }
        let mut step = 1.0 / PER_OCTAVE;
        for _ in 0..2 {
            step /= f64::from(CLOSER);
            let from = center;
            for k in (-CLOSER..=CLOSER).filter(|k| *k != 0) {
                center = take(from * libm::exp2(f64::from(k) * step))?;
            }
        }
        Ok(best)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{DampingRatio, Quantity};

    #[test]
    fn the_pulse_is_nowhere_below_and_touches_the_spectrum() {
        let part = DampingRatio::new(0.05).expect("a ratio");
        let frequencies = Frequencies::per_octave(10.0, 3000.0, 6.0).expect("frequencies");
        let of = |pulses: &[Pulse]| {
            Pulses::new(pulses).expect("pulses").spectrum(&frequencies, part, Quantity::AbsoluteAcceleration)
        };
        let half_sine = |amplitude, duration, start| Pulse { shape: Shape::HalfSine, amplitude, duration, start };
        let measured = of(&[half_sine(800.0, 0.6e-3, 0.0), half_sine(-500.0, 2e-3, 5e-3)]);
        for shape in [Shape::HalfSine, Shape::TerminalPeakSawtooth, Shape::Rectangle] {
            let found = EnvelopingPulse::of(&measured, shape).expect("a shape").expect("a pulse");
            let db = |(a, b): (&f64, &f64)| 20.0 * (a / b).log10();
            let over: Vec<f64> = of(&[found.pulse]).maximax.iter().zip(&measured.maximax).map(db).collect();
            let [least, most] =
                [over.iter().copied().fold(f64::INFINITY, f64::min), over.iter().copied().fold(0.0, f64::max)];
            assert!(least.abs() < 1e-9, "{shape:?}: it touches at {least} dB");
            assert!((most - found.most_db).abs() < 1e-9, "{shape:?}: {most} {}", found.most_db);
            #[expect(clippy::cast_precision_loss, reason = "a number of frequencies")]
            let mean = over.iter().sum::<f64>() / over.len() as f64;
            assert!((mean - found.mean_db).abs() < 1e-9, "{shape:?}: {mean} {}", found.mean_db);
            // No duration beside it has a smaller excess.
            for factor in [0.5, 0.9, 0.97, 1.03, 1.1, 2.0] {
                let other = Pulse { amplitude: 1.0, duration: factor * found.pulse.duration, ..found.pulse };
                let of_unit = of(&[other]);
                let amplitude = measured.maximax.iter().zip(&of_unit.maximax).map(|(a, b)| a / b).fold(0.0, f64::max);
                #[expect(clippy::cast_precision_loss, reason = "a number of frequencies")]
                let mean = of_unit
                    .maximax
                    .iter()
                    .zip(&measured.maximax)
                    .map(|(a, b)| 20.0 * (amplitude * a / b).log10())
                    .sum::<f64>()
                    / over.len() as f64;
                assert!(mean > found.mean_db, "{shape:?}: {factor} times as long has {mean} dB, {} dB", found.mean_db);
            }
        }
    }

    #[test]
    fn nothing_is_enveloped_by_nothing() {
        let frequencies = Frequencies::list(vec![100.0]).expect("a frequency");
        let mut filter = crate::SpectrumFilter::new(
            frequencies,
            DampingRatio::new(0.05).expect("a ratio"),
            Quantity::AbsoluteAcceleration,
            1e-4,
        )
        .expect("a filter");
        filter.push(&[0.0; 8]);
        assert_eq!(EnvelopingPulse::of(&filter.finish().expect("a spectrum"), Shape::HalfSine), Ok(None));
    }

    /// A pulse envelopes itself, from a tenth of the shortest period to several of the longest.
    #[test]
    fn a_pulse_is_its_own_envelope() {
        let part = DampingRatio::new(0.05).expect("a ratio");
        let frequencies = Frequencies::per_octave(10.0, 3000.0, 3.0).expect("frequencies");
        for duration in [3e-5, 1e-3, 0.3] {
            let pulse = Pulse { shape: Shape::HalfSine, amplitude: 700.0, duration, start: 0.0 };
            let pulses = Pulses::new(&[pulse]).expect("a pulse");
            let measured = pulses.spectrum(&frequencies, part, Quantity::AbsoluteAcceleration);
            let found = EnvelopingPulse::of(&measured, Shape::HalfSine).expect("a shape").expect("a pulse");
            // Durations are tried in steps of 2^(1/512).
            assert!(found.mean_db < 0.02, "{duration} s: {found:?}");
        }
    }
}
