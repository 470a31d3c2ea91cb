//! A spectrum that a shock test has to reach, and the deviation of a measured one.

use crate::{Error, LimitCurve, Spectrum};

/// The shock response spectrum that a test has to reach, with its tolerances in decibel.
///
/// A spectrum reaches it at a frequency where its maximax S is at least the required R, less the tolerance below it. If
/// there is a tolerance above it, S may not exceed R by more: −below ≤ 20 log₁₀(S/R) ≤ above.
///
/// ```
/// use clatter_shock::{DampingRatio, Frequencies, LimitCurve, Pulse, Pulses, Quantity, RequiredSpectrum, Shape};
/// // A half-sine of 1000 m/s², 1 ms: at 2 kHz, two of its lengths a period, it shakes by 1.15 times its peak.
/// let pulse = Pulse { shape: Shape::HalfSine, amplitude: 1000.0, duration: 1e-3, start: 0.0 };
/// let at = Frequencies::list(vec![2000.0])?;
/// let spectrum = Pulses::new(&[pulse])?.spectrum(&at, DampingRatio::new(0.05)?, Quantity::AbsoluteAcceleration);
/// let required = RequiredSpectrum::new(LimitCurve::constant(1000.0)?, 0.0, Some(3.0))?;
/// let off = required.deviations(&spectrum)[0].unwrap();
/// assert!(off.is_reached() && off.decibel() > 0.5 && off.decibel() < 2.0);
/// let more = RequiredSpectrum::new(LimitCurve::constant(1500.0)?, 1.5, None)?;
/// assert!(more.deviations(&spectrum)[0].unwrap().is_below);
/// # Ok::<(), clatter_shock::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct RequiredSpectrum {
    curve: LimitCurve,
    lowest: LimitCurve,
    highest: Option<LimitCurve>,
}

/// The deviation of a spectrum from the required one, at one frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Deviation {
    /// The required value.
    pub required: f64,
    /// The maximax of the spectrum.
    pub reached: f64,
    /// True if it is below the required value by more than the tolerance.
    pub is_below: bool,
    /// True if it is above the required value by more than the tolerance, if there is one.
    pub is_above: bool,
}

impl Deviation {
    /// Returns 20 log₁₀(reached/required).
    #[must_use]
    pub fn decibel(&self) -> f64 {
        20.0 * libm::log10(self.reached / self.required)
    }

    /// Returns whether it is within the tolerances.
    #[must_use]
    pub fn is_reached(&self) -> bool {
        !self.is_below && !self.is_above
    }
}

impl RequiredSpectrum {
    /// Creates it from a curve, the tolerance below it and, if any, the one above it, in dB.
    ///
    /// # Errors
    /// [`Error::Quantity`] for a tolerance outside of [0, 60] dB, and for levels that it takes beyond the floats.
    pub fn new(curve: LimitCurve, below_db: f64, above_db: Option<f64>) -> Result<Self, Error> {
        let checked = |value: f64| {
            if (0.0..=60.0).contains(&value) {
                Ok(value)
            } else {
                Err(Error::Quantity { name: "tolerance (dB)", value, allowed: "in [0, 60]" })
            }
        };
        let lowest = curve.times(libm::pow(10f64, -checked(below_db)? / 20.0))?;
        let highest = above_db.map(|above_db| curve.times(libm::pow(10f64, checked(above_db)? / 20.0))).transpose()?;
        Ok(Self { curve, lowest, highest })
    }

    /// Returns the required curve.
    #[must_use]
    pub fn curve(&self) -> &LimitCurve {
        &self.curve
    }

    /// Returns the lowest and, if there is a tolerance above the curve, the highest allowed spectrum.
    #[must_use]
    pub fn band(&self) -> (&LimitCurve, Option<&LimitCurve>) {
        (&self.lowest, self.highest.as_ref())
    }

    /// Returns the deviation of the maximax of a spectrum at each of its frequencies; `None` outside of the curve.
    ///
    /// The curve is in the unit of the spectrum.
    #[must_use]
    pub fn deviations(&self, spectrum: &Spectrum) -> Vec<Option<Deviation>> {
        let one = |(&hz, &reached): (&f64, &f64)| {
            let above = self.highest.as_ref().and_then(|highest| highest.at(hz));
            Some(Deviation {
                required: self.curve.at(hz)?,
                reached,
                is_below: reached < self.lowest.at(hz)?,
                is_above: above.is_some_and(|above| reached > above),
            })
        };
        spectrum.frequency_hz.iter().zip(&spectrum.maximax).map(one).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{DampingRatio, Frequencies, Quantity, VelocityShock, VelocityShocks};

    /// Returns the spectrum of a velocity shock: its pseudo-velocity is |Δv| of an undamped part at every frequency.
    fn level(delta_v: f64) -> Spectrum {
        let shock = VelocityShocks::new(vec![VelocityShock { time: 0.0, delta_v }]).expect("a shock");
        let list = Frequencies::list(vec![10.0, 100.0, 1000.0]).expect("frequencies");
        shock.spectrum(&list, DampingRatio::new(0.0).expect("undamped"), Quantity::PseudoVelocity)
    }

    #[test]
    fn a_band_is_held_on_both_sides_and_nothing_is_told_beyond_its_curve() {
        let curve = LimitCurve::new(vec![(5.0, 2.0), (200.0, 2.0)]).expect("a curve");
        let required = RequiredSpectrum::new(curve, 1.0, Some(3.0)).expect("a band");
        // 2 m/s less 1 dB is 1.783, and 3 dB more 2.825.
        for (v, below, above) in [(1.78, true, false), (1.79, false, false), (2.82, false, false), (2.83, false, true)]
        {
            let off = required.deviations(&level(v));
            for of in &off[..2] {
                let of = of.expect("within the curve");
                assert_eq!((of.is_below, of.is_above, of.is_reached()), (below, above, !below && !above), "{v}");
                assert!((of.decibel() - 20.0 * (v / 2.0_f64).log10()).abs() < 1e-9, "{v}");
            }
            assert_eq!(off[2], None, "the curve ends at 200 Hz");
        }
    }

    #[test]
    fn without_a_tolerance_above_nothing_is_too_much() {
        let curve = LimitCurve::constant(2.0).expect("a level");
        let required = RequiredSpectrum::new(curve, 0.0, None).expect("a level");
        assert!(required.deviations(&level(200.0)).iter().flatten().all(Deviation::is_reached));
        assert!(required.deviations(&level(1.999)).iter().flatten().all(|of| of.is_below));
    }

    #[test]
    fn a_tolerance_that_is_none_is_refused() {
        let curve = LimitCurve::constant(2.0).expect("a level");
        for (below, above) in
            [(-1.0, None), (f64::NAN, None), (61.0, None), (0.0, Some(-0.5)), (0.0, Some(f64::INFINITY))]
        {
            assert!(RequiredSpectrum::new(curve.clone(), below, above).is_err(), "{below} {above:?}");
        }
    }
}
