//! The damage boundary of a measured history.

use crate::{DampingRatio, Error, Frequencies, Limit, Pulse, Pulses, Quantity, Shape, Suspension, UnevenFilter};
use std::f64::consts::TAU;

/// The damage boundary of a component for one history of base acceleration, scaled in time by s and in amplitude by c.
///
/// ```text
/// c a(t/s) asks of a part of natural frequency f:   A = c S_A(f s),    z = c s² S_z(f s)
/// boundary:   (velocity change, acceleration) = (c s |V₀|, c A₀),
///             c = limit/S_A(f s)   or   c = limit/(s² S_z(f s))
/// ```
///
/// S is the spectrum of the history (maximax, with the damping of the component), A₀ its largest absolute acceleration
/// and V₀ its velocity change. Short histories (small s) act by their velocity change alone, so that the boundary begins
/// at the critical velocity change; the largest value of the spectrum gives the critical acceleration, as the largest
/// amplification does for a pulse in [`DamageBoundary`](crate::DamageBoundary).
///
/// Source: Newton, Fragility Assessment, 1968; the scaling is that of the equation of motion.
#[derive(Debug, Clone, PartialEq)]
pub struct HistoryBoundary {
    suspension: Suspension,
    history: History,
    /// The limit as an acceleration: that of the part, or ω² times its rattle space.
    allowed: f64,
    factor: f64,
    critical_acceleration: f64,
    /// Scale of time from which on the critical acceleration alone decides.
    knee_scale: f64,
}

/// Samples with straight lines between, and their scales.
#[derive(Debug, Clone, PartialEq)]
struct History {
    times_s: Vec<f64>,
    values: Vec<f64>,
    quantity: Quantity,
    damping: DampingRatio,
    duration: f64,
    peak: f64,
    /// `None` if both directions cancel.
    velocity_change: Option<f64>,
}

/// Frequencies of the first search, per octave, and per 1/T up to so many of them.
const PER_OCTAVE: f64 = 48.0;
const PER_PERIOD: f64 = 8.0;
const PERIODS: f64 = 64.0;
/// Frequencies between two neighbors in each round of the search, and the number of rounds: each round shrinks the
/// distance to two ninths, in the end to 10⁻⁹ of a frequency, where a peak is flat to all digits.
const BETWEEN: u8 = 8;
const ROUNDS: usize = 12;
/// Relative difference below which values count as equal: roundings of the spectrum.
const FLAT: f64 = 1e-12;

impl HistoryBoundary {
    /// Creates the boundary from a suspension, a limit and samples of base acceleration (s, m/s²), linear between; the
    /// part and the base are at rest before and the base is in uniform motion after. Two samples at one time are a
    /// jump.
    ///
    /// # Accuracy
    ///
    /// Points of the curve are as exact as the spectrum ([`crate::accuracy::RECORD`]), the critical velocity change is
    /// exact. The critical acceleration is good to 10⁻⁹ and the velocity change of the knee to 10⁻⁵, if the largest
    /// amplification has no neighbor within 1/48 of an octave (or within 1/8 of 1/T for natural frequencies below 64/T,
    /// T the length of the history) that it could be taken for.
    ///
    /// # Cost
    ///
    /// It costs as much as a spectrum of some 500 frequencies for a short history, and of 50 more for each doubling of
    /// its samples.
    ///
    /// # Examples
    ///
    /// For a rectangle the knee is at π/2 times the critical velocity change (1.57 in ASTM D3332).
    ///
    /// ```
    /// # use clatter_shock::{DampingRatio, HistoryBoundary, Limit, Suspension};
    /// let mount = Suspension::from_hz(100.0, DampingRatio::new(0.0)?)?;
    /// let rectangle = [(0.0, 30.0), (0.001, 30.0)];
    /// let boundary = HistoryBoundary::new(mount, Limit::Acceleration(500.0), &rectangle)?;
    /// let critical = boundary.critical_velocity_change().unwrap();
    /// assert!((critical - 500.0 / mount.omega()).abs() < 1e-12);
    /// assert!((boundary.critical_acceleration() - 250.0).abs() < 1e-9);
    /// let knee = boundary.knee_velocity_change().unwrap() / critical;
    /// assert!((knee - std::f64::consts::FRAC_PI_2).abs() < 1e-5);
    /// # Ok::<(), clatter_shock::Error>(())
    /// ```
    /// # Errors
    /// The errors of [`Pulses::piecewise_linear`]; [`Error::Quantity`] unless the limit is finite and positive, and for
    /// a history that is zero throughout; [`Error::Stop`] for a suspension with a stop.
    pub fn new(suspension: Suspension, limit: Limit, points: &[(f64, f64)]) -> Result<Self, Error> {
        suspension.refuse_stop("the damage boundary of a history")?;
        let allowed = limit.allowed()?;
        let (omega, factors) = (suspension.omega(), suspension.damping().impulse_factors());
        let (quantity, factor, allowed) = match limit {
            Limit::Acceleration(_) => (Quantity::AbsoluteAcceleration, factors.acceleration, allowed),
            Limit::RattleSpace(_) => {
                (Quantity::EquivalentStaticAcceleration, factors.displacement, allowed * omega * omega)
            }
        };
        let history = History::new(points, quantity, suspension.damping())?;
        let (largest, hz) = history.largest()?;
        Ok(Self {
            critical_acceleration: allowed * (history.peak / largest),
            knee_scale: TAU * hz / omega,
            suspension,
            history,
            allowed,
            factor,
        })
    }
    /// Returns the velocity change below which the history does no damage, however short; `None` if its velocity change
    /// is zero, to roundings: then it does no damage by its velocity change, and short histories do less
    /// and less.
    #[must_use]
    pub fn critical_velocity_change(&self) -> Option<f64> {
        self.history.velocity_change.map(|_| self.allowed / (self.suspension.omega() * self.factor))
    }
    /// Returns the largest acceleration below which the history does no damage, however long.
    #[must_use]
    pub fn critical_acceleration(&self) -> f64 {
        self.critical_acceleration
    }
    /// Returns the velocity change of the shortest history that does damage at the critical acceleration; infinite if
    /// amplification only tends to its largest value as the history grows longer, `None` if the velocity change is
    /// zero.
    #[must_use]
    pub fn knee_velocity_change(&self) -> Option<f64> {
        let unit = self.history.velocity_change?.abs() / self.history.peak;
        Some(self.critical_acceleration * unit * self.knee_scale)
    }
    /// Returns the boundary from short histories to the knee: `points` pairs of (velocity change, acceleration), for
    /// scales of time in equal ratios. Where the knee is infinite it ends at ten periods.
    ///
    /// # Errors
    /// [`Error::Points`] below two points; [`Error::NoVelocityChange`] for a history whose velocity change is zero.
    pub fn curve(&self, points: usize) -> Result<Vec<(f64, f64)>, Error> {
        if points < 2 {
            return Err(Error::Points("the curve", points));
        }
        let history = &self.history;
        let velocity_change = history.velocity_change.ok_or(Error::NoVelocityChange)?.abs();
        let (omega, steps) = (self.suspension.omega(), points - 1);
        // The shortest history moves the phase of the part by a thousandth of a radian.
        let first = 1e-3 / (omega * history.duration);
        let last = if self.knee_scale.is_finite() { self.knee_scale } else { 10.0 * TAU / (omega * history.duration) };
        let last = last.max(first);
        let scales: Vec<f64> = (0..points)
            .map(|i| {
                #[expect(clippy::cast_precision_loss, reason = "a number of points on a curve")]
                let share = i as f64 / steps as f64;
                first * libm::pow(last / first, share)
            })
            .collect();
        let maximax = history.spectrum(scales.iter().map(|s| s * omega / TAU).collect())?;
        let point = |(s, maximax): (&f64, f64)| {
            let c = self.allowed / maximax;
            (c * s * velocity_change, c * history.peak)
        };
        Ok(scales.iter().zip(maximax).map(point).collect())
    }
}

impl History {
    fn new(points: &[(f64, f64)], quantity: Quantity, damping: DampingRatio) -> Result<Self, Error> {
        // This call only checks the points.
        Pulses::piecewise_linear(points)?;
        let (times_s, values): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
        let peak = values.iter().fold(0.0_f64, |m, a| m.max(a.abs()));
        crate::error::positive("largest acceleration of the history", peak)?;
        let (mut change, mut total) = (0.0, 0.0);
        for pair in points.windows(2) {
            let dt = pair[1].0 - pair[0].0;
            change += 0.5 * dt * (pair[0].1 + pair[1].1);
            total += 0.5 * dt * (pair[0].1.abs() + pair[1].1.abs());
        }
        #[expect(clippy::cast_precision_loss, reason = "a number of samples")]
        let roundings = 2.0 * f64::EPSILON * points.len() as f64;
        let velocity_change = (change.abs() > roundings * total).then_some(change);
        let duration = times_s[times_s.len() - 1] - times_s[0];
        Ok(Self { times_s, values, quantity, damping, duration, peak, velocity_change })
    }
    /// Returns the responses of parts of these natural frequencies.
    fn spectrum(&self, hz: Vec<f64>) -> Result<Vec<f64>, Error> {
        let mut filter = UnevenFilter::new(Frequencies::list(hz)?, self.damping, self.quantity);
        filter.push(&self.times_s, &self.values)?;
        Ok(filter.finish()?.maximax)
    }
    /// Returns the largest value of the spectrum and the lowest frequency that has it; infinite if the spectrum only
    /// tends to it.
    fn largest(&self) -> Result<(f64, f64), Error> {
        let hz = self.frequencies();
        let maximax = self.spectrum(hz.clone())?;
        let best = (0..hz.len()).max_by(|a, b| maximax[*a].total_cmp(&maximax[*b])).unwrap_or(0);
        let mut top = (hz[best], maximax[best]);
        let (mut low, mut high) = (hz[best.saturating_sub(1)], hz[(best + 1).min(hz.len() - 1)]);
        for _ in 0..ROUNDS {
            let step = (high - low) / f64::from(BETWEEN + 1);
            let between: Vec<f64> = (1..=BETWEEN).map(|i| low + f64::from(i) * step).collect();
            for (hz, maximax) in between.iter().zip(self.spectrum(between.clone())?) {
                if maximax > top.1 {
                    top = (*hz, maximax);
                }
            }
            (low, high) = ((top.0 - step).max(low), (top.0 + step).min(high));
        }
        let (long, by_overshoot) = self.long()?;
        let reached = top.1 > long * (1.0 + FLAT) || (by_overshoot && top.1 >= long * (1.0 - FLAT));
        if !reached {
            return Ok((long, f64::INFINITY));
        }
        // If many frequencies have it, the lowest counts.
        let enough = top.1.max(long) * (1.0 - FLAT);
        let first = maximax.iter().position(|maximax| *maximax >= enough).map_or(top.0, |i| hz[i].min(top.0));
        let below = hz.iter().copied().filter(|hz| *hz < first).fold(0.0, f64::max);
        Ok((top.1, self.lowest(below.max(0.5 * first), first, enough)?))
    }
    /// Returns the lowest frequency between two with a value of at least `enough`.
    fn lowest(&self, mut low: f64, mut high: f64, enough: f64) -> Result<f64, Error> {
        for _ in 0..ROUNDS {
            let step = (high - low) / f64::from(BETWEEN + 1);
            let between: Vec<f64> = (1..=BETWEEN).map(|i| low + f64::from(i) * step).collect();
            for (hz, maximax) in between.iter().zip(self.spectrum(between.clone())?) {
                if maximax >= enough {
                    high = *hz;
                    break;
                }
                low = *hz;
            }
        }
        Ok(high)
    }
    /// Returns the frequencies of the first search: from parts that respond to the velocity change alone to parts that
    /// follow each sample.
    fn frequencies(&self) -> Vec<f64> {
        #[expect(clippy::cast_precision_loss, reason = "a number of samples")]
        let highest = 4.0 * self.times_s.len() as f64;
        let (ratio, mut periods, mut hz) = (libm::pow(2.0, 1.0 / PER_OCTAVE) - 1.0, 0.01, Vec::new());
        while periods < highest {
            hz.push(periods / self.duration);
            let fine = if periods < PERIODS { 1.0 / PER_PERIOD } else { f64::INFINITY };
            periods += (ratio * periods).min(fine);
        }
        hz
    }
    /// Returns the response of ever stiffer parts, which follow each line and swing beyond each jump, and whether a
    /// jump gives the largest one.
    fn long(&self) -> Result<(f64, bool), Error> {
        let long = 40.0 * TAU * (1.0 + self.damping.get());
        let step = [Pulse { shape: Shape::Rectangle, amplitude: 1.0, duration: long, start: 0.0 }];
        let response = Pulses::new(&step)?.respond(&Suspension::unit(self.damping));
        let peak = match self.quantity {
            Quantity::AbsoluteAcceleration => response.absolute_acceleration.positive.value,
            _ => -response.relative_displacement.negative.value,
        };
        let over = (peak - 1.0).max(0.0);
        let mut most = (self.peak, false);
        let (mut before, mut last_time) = (0.0, f64::NEG_INFINITY);
        let ends = self.times_s.iter().copied().zip(self.values.iter().copied());
        let after = std::iter::once((self.times_s[self.times_s.len() - 1], 0.0));
        for (time, a) in ends.chain(after) {
            if time <= last_time || last_time == f64::NEG_INFINITY {
                let beyond = (a + over * (a - before)).abs();
                if over > FLAT && beyond > most.0 {
                    most = (beyond, true);
                }
            }
            (before, last_time) = (a, time);
        }
        Ok(most)
    }
}
