//! Shock response spectra: the peak of a quantity over the natural frequency of the component.

use crate::peaks::{Peak, Peaks, Range};
use crate::suspension::Modes;
use crate::{DampingRatio, Error, Pulses, Stop, Suspension, VelocityShocks};
use std::f64::consts::TAU;

/// The five quantities of ISO 18431-4. Signs as in [`crate::Response`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Quantity {
    /// Absolute acceleration of the component, A.
    AbsoluteAcceleration,
    /// Displacement relative to the base, z.
    RelativeDisplacement,
    /// Velocity relative to the base, z′.
    RelativeVelocity,
    /// Pseudo-velocity, ωz.
    PseudoVelocity,
    /// Equivalent static acceleration, ω²z.
    EquivalentStaticAcceleration,
}

impl Quantity {
    /// Returns the row of the modes and its positive factor, for the angular frequency ω.
    pub(crate) fn row(self, omega: f64) -> (usize, f64) {
        match self {
            Self::AbsoluteAcceleration => (Modes::ACCELERATION, omega),
            Self::RelativeDisplacement => (Modes::DISPLACEMENT, omega.recip()),
            Self::RelativeVelocity => (Modes::VELOCITY, 1.0),
            Self::PseudoVelocity => (Modes::DISPLACEMENT, 1.0),
            Self::EquivalentStaticAcceleration => (Modes::DISPLACEMENT, omega),
        }
    }
}

/// A checked list of natural frequencies.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "Vec<f64>", into = "Vec<f64>")
)]
pub struct Frequencies {
    hz: Vec<f64>,
}

impl Frequencies {
    /// Returns the frequencies given, in the order given.
    /// # Errors
    /// [`Error::Empty`]; [`Error::Entry`] for one that is not finite and positive.
    pub fn list(hz: Vec<f64>) -> Result<Self, Error> {
        if hz.is_empty() {
            return Err(Error::Empty("list of frequencies"));
        }
        for (i, &value) in hz.iter().enumerate() {
            if !(value > 0.0 && value.is_finite()) {
                return Err(Error::Entry {
                    list: "frequencies",
                    entry: i + 1,
                    name: "natural frequency (Hz)",
                    value,
                    allowed: "finite and > 0",
                });
            }
        }
        Ok(Self { hz })
    }
    /// Creates frequencies from `low` to `high`, both included, in equal ratios, at least `per_octave` steps to the
    /// octave.
    ///
    /// ```
    /// # use clatter_shock::Frequencies;
    /// let thirds = Frequencies::per_octave(100.0, 400.0, 3.0)?;
    /// assert_eq!(thirds.hz().len(), 7);
    /// assert!((thirds.hz()[1] - 100.0 * 2_f64.powf(1.0 / 3.0)).abs() < 1e-12);
    /// # Ok::<(), clatter_shock::Error>(())
    /// ```
    /// # Errors
    /// [`Error::Quantity`] unless 0 < low ≤ high, per octave > 0, and there are at most 10⁷ frequencies.
    pub fn per_octave(low: f64, high: f64, per_octave: f64) -> Result<Self, Error> {
        crate::error::positive("lowest frequency (Hz)", low)?;
        crate::error::positive("highest frequency (Hz)", high)?;
        crate::error::positive("frequencies per octave", per_octave)?;
        if high < low {
            return Err(Error::Quantity {
                name: "highest frequency (Hz)",
                value: high,
                allowed: "at least the lowest",
            });
        }
        // A whole number of steps that rounding made a little larger stays that number.
        let steps = (libm::log2(high / low) * per_octave * (1.0 - 4.0 * f64::EPSILON)).ceil();
        if steps > 1e7 {
            return Err(Error::Quantity { name: "number of frequencies", value: steps, allowed: "at most 1e7" });
        }
        let mut hz = vec![low];
        let mut i = 1.0;
        while i < steps {
            hz.push(low * libm::pow(high / low, i / steps));
            i += 1.0;
        }
        if high > low {
            hz.push(high);
        }
        Ok(Self { hz })
    }
    /// Returns the frequencies in hertz.
    #[must_use]
    pub fn hz(&self) -> &[f64] {
        &self.hz
    }
}

/// A shock response spectrum. All arrays have one entry for each frequency; all values are absolute values.
///
/// The primary part lasts from the first start to the last end of the excitation, the residual part from there on: the
/// whole ring-down.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Spectrum {
    /// The quantity.
    pub quantity: Quantity,
    /// The damping ratio.
    pub damping: DampingRatio,
    /// Natural frequencies in hertz.
    pub frequency_hz: Vec<f64>,
    /// Largest absolute value of the primary part.
    pub primary: Vec<f64>,
    /// Largest absolute value of the residual part.
    pub residual: Vec<f64>,
    /// Largest absolute value over both.
    pub maximax: Vec<f64>,
    /// Largest positive value over both.
    pub positive: Vec<f64>,
    /// Largest negative value over both, without its sign.
    pub negative: Vec<f64>,
    /// Largest positive value of the primary part.
    pub primary_positive: Vec<f64>,
    /// Largest negative value of the primary part, without its sign.
    pub primary_negative: Vec<f64>,
    /// Largest positive value of the residual part.
    pub residual_positive: Vec<f64>,
    /// Largest negative value of the residual part, without its sign.
    pub residual_negative: Vec<f64>,
    /// Times of the maximax, in seconds on the time axis of the excitation; the first one if several values are equal,
    /// and the start of the excitation where nothing moves.
    ///
    /// Near a peak the motion is flat: a rounding ε of the value moves the time by some √ε/ω.
    pub time_of_peak_s: Vec<f64>,
}

/// The rule that combines several spectra into one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Summary {
    /// The root of the sum of squares: for the axes of one sensor a bound on the length of the response.
    RootSumSquare,
    /// The largest.
    Envelope,
    /// The mean and 3 dB: times 10^(3/20).
    MeanPlus3Db,
}

impl Spectrum {
    /// Returns one spectrum for several of the same frequencies, value by value. It has the damping of the first; times
    /// of peaks are those of the largest in an envelope, else not a number.
    ///
    /// ```
    /// # use clatter_shock::{DampingRatio, Frequencies, Quantity, Spectrum, Summary, VelocityShock, VelocityShocks};
    /// let (hz, undamped) = (Frequencies::list(vec![10.0])?, DampingRatio::new(0.0)?);
    /// let of = |delta_v| VelocityShocks::new(vec![VelocityShock { time: 0.0, delta_v }]);
    /// let [x, y] = [of(3.0)?, of(-4.0)?].map(|shock| shock.spectrum(&hz, undamped, Quantity::PseudoVelocity));
    /// let both = Spectrum::summary(&[&x, &y], Summary::RootSumSquare).unwrap();
    /// assert!((both.maximax[0] - 5.0).abs() < 1e-12);
    /// # Ok::<(), clatter_shock::Error>(())
    /// ```
    ///
    /// `None` for no spectrum, and for spectra of different frequencies.
    #[must_use]
    pub fn summary(spectra: &[&Self], summary: Summary) -> Option<Self> {
        let mut of = (*spectra.first()?).clone();
        if spectra.iter().any(|other| other.frequency_hz != of.frequency_hz) {
            return None;
        }
        let fold = |values: &mut Vec<f64>, field: fn(&Self) -> &[f64]| {
            for (i, value) in values.iter_mut().enumerate() {
                let all = || spectra.iter().map(|spectrum| field(spectrum)[i]);
                #[expect(clippy::cast_precision_loss, reason = "a count of spectra")]
                let count = spectra.len() as f64;
                *value = match summary {
                    Summary::RootSumSquare => all().fold(0.0, libm::hypot),
                    Summary::Envelope => all().fold(0.0, f64::max),
                    Summary::MeanPlus3Db => all().sum::<f64>() / count * libm::pow(10.0, 0.15),
                };
            }
        };
        for (i, time) in of.time_of_peak_s.iter_mut().enumerate() {
            let largest =
                spectra.iter().reduce(|best, other| if other.maximax[i] > best.maximax[i] { other } else { best });
            let known = largest.filter(|_| summary == Summary::Envelope);
            *time = known.map_or(f64::NAN, |spectrum| spectrum.time_of_peak_s[i]);
        }
        fold(&mut of.primary, |s| &s.primary);
        fold(&mut of.residual, |s| &s.residual);
        fold(&mut of.maximax, |s| &s.maximax);
        fold(&mut of.positive, |s| &s.positive);
        fold(&mut of.negative, |s| &s.negative);
        fold(&mut of.primary_positive, |s| &s.primary_positive);
        fold(&mut of.primary_negative, |s| &s.primary_negative);
        fold(&mut of.residual_positive, |s| &s.residual_positive);
        fold(&mut of.residual_negative, |s| &s.residual_negative);
        Some(of)
    }

    /// Collects the extremes during and after the excitation, frequency by frequency.
    pub(crate) fn collect(
        frequencies: &Frequencies,
        damping: DampingRatio,
        quantity: Quantity,
        mut extremes: impl FnMut(usize, f64, usize) -> [Peaks; 2],
    ) -> Self {
        let n = frequencies.hz.len();
        let empty = || Vec::with_capacity(n);
        let mut s = Self {
            quantity,
            damping,
            frequency_hz: frequencies.hz.clone(),
            primary: empty(),
            residual: empty(),
            maximax: empty(),
            positive: empty(),
            negative: empty(),
            primary_positive: empty(),
            primary_negative: empty(),
            residual_positive: empty(),
            residual_negative: empty(),
            time_of_peak_s: empty(),
        };
        for (i, &hz) in frequencies.hz.iter().enumerate() {
            let omega = TAU * hz;
            let (row, factor) = quantity.row(omega);
            let [during, after] = extremes(i, omega, row);
            let [positive, negative] = [|p: &Peaks| p.high.value, |p: &Peaks| -p.low.value]
                .map(|value| [&during, &after].map(|peaks| factor * value(peaks) + 0.0));
            s.primary_positive.push(positive[0]);
            s.primary_negative.push(negative[0]);
            s.residual_positive.push(positive[1]);
            s.residual_negative.push(negative[1]);
            s.primary.push(positive[0].max(negative[0]));
            s.residual.push(positive[1].max(negative[1]));
            s.positive.push(positive[0].max(positive[1]));
            s.negative.push(negative[0].max(negative[1]));
            s.maximax.push(s.primary[i].max(s.residual[i]));
            let [Peak { value, time }, later] = [during.largest(), after.largest()];
            s.time_of_peak_s.push(if later.value > value { later.time } else { time });
        }
        s
    }
}

impl VelocityShocks {
    /// Returns the shock response spectrum of the shocks, exact at every frequency; times in seconds.
    ///
    /// Eight frequencies are carried side by side on machines with vectors of fused multiply-adds, with the accuracy of
    /// [`VelocityShocks::respond`].
    ///
    /// The instant of the last shock ends the primary part, just before the jump and just after.
    #[must_use]
    pub fn spectrum(&self, frequencies: &Frequencies, damping: DampingRatio, quantity: Quantity) -> Spectrum {
        let modes = Modes::new(damping);
        let omegas: Vec<f64> = frequencies.hz.iter().map(|hz| TAU * hz).collect();
        let peaks = self.peaks_at(&modes, &omegas, quantity.row(omegas[0]).0);
        Spectrum::collect(frequencies, damping, quantity, |i, _, _| peaks[i])
    }
}

impl Pulses {
    /// Returns the spectrum of components that all have the same stops: of the acceleration that of spring, damper and stop.
    ///
    /// # Accuracy
    ///
    /// It is that of [`respond`](Self::respond) at every frequency; all is infinite of a component that touches its stops too often.
    ///
    /// # Examples
    ///
    /// Soft components reach a stop that stiff ones do not, which then changes nothing:
    ///
    /// ```
    /// # use clatter_shock::{DampingRatio, Frequencies, Pulse, Pulses, Quantity, Shape, Stop};
    /// let pulses = Pulses::new(&[Pulse { shape: Shape::HalfSine, amplitude: 5000.0, duration: 1e-3, start: 0.0 }])?;
    /// let (list, zeta) = (Frequencies::list(vec![50.0, 2000.0])?, DampingRatio::new(0.05)?);
    /// let free = pulses.spectrum(&list, zeta, Quantity::AbsoluteAcceleration).maximax;
    /// let stop = Stop::new(1e-3, 0.5e-3, 0.4)?;
    /// let stopped = pulses.spectrum_with_stop(&list, zeta, Quantity::AbsoluteAcceleration, stop).maximax;
    /// assert!(stopped[0] > 5.0 * free[0] && (stopped[1] / free[1] - 1.0).abs() < 1e-12);
    /// # Ok::<(), clatter_shock::Error>(())
    /// ```
    #[must_use]
    pub fn spectrum_with_stop(
        &self,
        frequencies: &Frequencies,
        damping: DampingRatio,
        quantity: Quantity,
        stop: Stop,
    ) -> Spectrum {
        Spectrum::collect(frequencies, damping, quantity, |_, omega, k| {
            let part = Suspension::of_omega(omega, damping);
            self.stopped_ranges(&part, stop, k).map(|range| range.peaks(omega, |i| self.begin(i)))
        })
    }
    /// Returns the shock response spectrum of the pulses, exact at every frequency; times in seconds.
    ///
    /// # Examples
    ///
    /// A short half-sine on a soft mount is a velocity shock of its area, 2aD/π:
    ///
    /// ```
    /// # use clatter_shock::{DampingRatio, Frequencies, Pulse, Pulses, Quantity, Shape};
    /// let shock = Pulse { shape: Shape::HalfSine, amplitude: 1000.0, duration: 1e-4, start: 0.0 };
    /// let spectrum = Pulses::new(&[shock])?.spectrum(
    ///     &Frequencies::list(vec![1.0])?,
    ///     DampingRatio::new(0.0)?,
    ///     Quantity::PseudoVelocity,
    /// );
    /// assert!((spectrum.maximax[0] / shock.velocity_change() - 1.0).abs() < 1e-7);
    /// # Ok::<(), clatter_shock::Error>(())
    /// ```
    #[must_use]
    pub fn spectrum(&self, frequencies: &Frequencies, damping: DampingRatio, quantity: Quantity) -> Spectrum {
        let modes = Modes::new(damping);
        Spectrum::collect(frequencies, damping, quantity, |_, omega, k| {
            let mut ranges = [Range::default()];
            let last = self.drive(&modes, omega, &[k], &mut ranges);
            let mut after = Range::default();
            after.note_free(&modes, k, last, f64::INFINITY, self.end_interval());
            [ranges[0], after].map(|range| range.peaks(omega, |i| self.begin(i)))
        })
    }
}
