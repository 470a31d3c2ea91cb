//! Fragility of a component: limits and margins, the damage boundary, and the equivalent shock-table pulse of a
//! clatter.

use crate::{DampingRatio, Error, Pulse, Pulses, Response, Shape, Suspension};
use std::f64::consts::TAU;

/// A limit on the response of a component.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Limit {
    /// Peak absolute acceleration of the component.
    Acceleration(f64),
    /// Peak displacement relative to the base: the free space around it.
    RattleSpace(f64),
}

impl Limit {
    pub(crate) fn allowed(self) -> Result<f64, Error> {
        match self {
            Self::Acceleration(a) => crate::error::positive("limit of acceleration", a),
            Self::RattleSpace(z) => crate::error::positive("rattle space", z),
        }
    }
    fn demand(self, response: &Response) -> f64 {
        match self {
            Self::Acceleration(_) => response.absolute_acceleration.magnitude(),
            Self::RattleSpace(_) => response.relative_displacement.magnitude(),
        }
    }
    /// Returns the margin of a response to the limit.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless the limit is finite and positive.
    pub fn margin(self, response: &Response) -> Result<Margin, Error> {
        Ok(Margin { allowed: self.allowed()?, demand: self.demand(response) })
    }
}

/// An allowed value and a demand, in one unit: of a response, or of a velocity change of the base.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Margin {
    /// The limit.
    pub allowed: f64,
    /// The value that is reached.
    pub demand: f64,
}

impl Margin {
    /// Returns allowed/demand − 1: negative where the limit is exceeded, infinite where the demand is zero.
    ///
    /// ```
    /// # use clatter_shock::Margin;
    /// let margin = Margin { allowed: 20.0, demand: 10.0 };
    /// assert_eq!(margin.ratio(), 1.0);
    /// assert!((margin.decibel() - 6.02).abs() < 1e-3);
    /// ```
    #[must_use]
    pub fn ratio(&self) -> f64 {
        self.allowed / self.demand - 1.0
    }
    /// Returns 20 log₁₀(allowed/demand).
    #[must_use]
    pub fn decibel(&self) -> f64 {
        20.0 * libm::log10(self.allowed / self.demand)
    }
    /// Returns whether the limit holds.
    #[must_use]
    pub fn is_safe(&self) -> bool {
        self.demand <= self.allowed
    }
}

/// The damage boundary of a component for one pulse shape (Newton 1968; ASTM D3332).
///
/// Pulses below the critical velocity change are safe at any acceleration, pulses below the critical acceleration at
/// any velocity change; between, the boundary turns, and ends at the knee.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DamageBoundary {
    suspension: Suspension,
    limit: Limit,
    shape: Shape,
    critical_velocity_change: f64,
    critical_acceleration: f64,
    knee_duration: f64,
}

/// Result of one shock test.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Trial {
    /// Velocity change or acceleration of the table.
    pub level: f64,
    /// True if the component was damaged.
    pub damaged: bool,
}

/// Steps of the search for the largest amplification, per octave of duration.
const STEPS: f64 = 24.0;

impl DamageBoundary {
    /// Creates the boundary from a suspension, a limit and a pulse shape.
    ///
    /// # Examples
    ///
    /// For an undamped component and the rectangle the knee is at π/2 times the critical velocity change (1.57 in ASTM
    /// D3332):
    ///
    /// ```
    /// # use clatter_shock::{DamageBoundary, DampingRatio, Limit, Shape, Suspension};
    /// let mount = Suspension::from_hz(100.0, DampingRatio::new(0.0)?)?;
    /// let boundary = DamageBoundary::new(mount, Limit::Acceleration(500.0), Shape::Rectangle)?;
    /// assert!((boundary.critical_velocity_change() - 500.0 / mount.omega()).abs() < 1e-12);
    /// assert!((boundary.critical_acceleration() - 250.0).abs() < 1e-9);
    /// let knee = boundary.knee_velocity_change() / boundary.critical_velocity_change();
    /// assert!((knee - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
    /// # Ok::<(), clatter_shock::Error>(())
    /// ```
    /// # Errors
    /// [`Error::Quantity`] unless the limit is finite and positive; [`Error::Entry`] for a trapezoid without ramps;
    /// [`Error::Stop`] for a suspension with a stop.
    pub fn new(suspension: Suspension, limit: Limit, shape: Shape) -> Result<Self, Error> {
        suspension.refuse_stop("a damage boundary")?;
        let allowed = limit.allowed()?;
        let factors = suspension.damping().impulse_factors();
        let omega = suspension.omega();
        let (factor, equivalent) = match limit {
            Limit::Acceleration(_) => (factors.acceleration, allowed),
            Limit::RattleSpace(_) => (factors.displacement, allowed * omega * omega),
        };
        let (largest, phase) = largest_amplification(suspension.damping(), limit, shape)?;
        Ok(Self {
            suspension,
            limit,
            shape,
            critical_velocity_change: equivalent / (omega * factor),
            critical_acceleration: equivalent / largest,
            knee_duration: phase / omega,
        })
    }
    /// Creates the boundary from shock tests as in ASTM D3332: `velocity` with short pulses of rising velocity change,
    /// `acceleration` with long rectangles of rising acceleration. Critical is the highest level below all damage; the
    /// boundary between is that of the undamped component with both, whose knee is at π/2 of the critical velocity
    /// change.
    ///
    /// # Errors
    /// [`Error::Trials`] if a list has no level without damage below the lowest with damage, or no damage at all.
    pub fn from_tests(velocity: &[Trial], acceleration: &[Trial]) -> Result<Self, Error> {
        let critical = |name, trials: &[Trial]| {
            let damage = trials.iter().filter(|t| t.damaged).fold(f64::INFINITY, |m, t| m.min(t.level));
            let safe = trials.iter().filter(|t| !t.damaged && t.level < damage).fold(0.0_f64, |m, t| m.max(t.level));
            if damage.is_finite() && safe > 0.0 { Ok(safe) } else { Err(Error::Trials(name)) }
        };
        let (dv, a) = (critical("velocity change", velocity)?, critical("acceleration", acceleration)?);
        let undamped = DampingRatio::new(0.0)?;
        Self::new(Suspension::new(2.0 * a / dv, undamped)?, Limit::Acceleration(2.0 * a), Shape::Rectangle)
    }
    /// Returns the critical velocity change: below it no pulse does damage, however high.
    #[must_use]
    pub fn critical_velocity_change(&self) -> f64 {
        self.critical_velocity_change
    }
    /// Returns the critical acceleration: below it no pulse does damage, however long.
    #[must_use]
    pub fn critical_acceleration(&self) -> f64 {
        self.critical_acceleration
    }
    /// Returns the velocity change from which on the critical acceleration alone decides; infinite if amplification
    /// only tends to its largest value as pulses grow longer.
    #[must_use]
    pub fn knee_velocity_change(&self) -> f64 {
        // This also holds where the critical acceleration underflows to 0.
        if self.knee_duration == f64::INFINITY {
            return f64::INFINITY;
        }
        self.shape.area() * self.critical_acceleration * self.knee_duration
    }
    /// Returns the boundary from the critical velocity change to the knee: `points` pairs of (velocity change,
    /// acceleration), for durations in equal ratios. Where the knee is infinite it ends at ten periods.
    ///
    /// # Errors
    /// [`Error::Points`] below two points.
    pub fn curve(&self, points: usize) -> Result<Vec<(f64, f64)>, Error> {
        if points < 2 {
            return Err(Error::Points("the curve", points));
        }
        let omega = self.suspension.omega();
        let last = self.knee_duration.min(10.0 * TAU / omega);
        let first = 1e-3 / omega;
        let allowed = self.limit.allowed()?;
        let steps = points - 1;
        (0..points)
            .map(|i| {
                #[expect(clippy::cast_precision_loss, reason = "a number of points on a curve")]
                let share = i as f64 / steps as f64;
                let duration = first * libm::pow(last / first, share);
                let unit = Pulse { shape: self.shape, amplitude: 1.0, duration, start: 0.0 };
                let amplitude = allowed / self.limit.demand(&Pulses::new(&[unit])?.respond(&self.suspension));
                Ok((self.shape.area() * amplitude * duration, amplitude))
            })
            .collect()
    }
    /// Returns the margin of one pulse of this shape: the limit over the response.
    ///
    /// # Errors
    /// The errors of [`Pulses::new`].
    pub fn margin(&self, amplitude: f64, duration: f64) -> Result<Margin, Error> {
        let pulse = Pulse { shape: self.shape, amplitude, duration, start: 0.0 };
        self.limit.margin(&Pulses::new(&[pulse])?.respond(&self.suspension))
    }
}

/// Returns the response over that to a steady acceleration of the pulse's amplitude, for ω = 1 and the duration
/// `phase`.
fn amplification(damping: DampingRatio, limit: Limit, shape: Shape, phase: f64) -> Result<f64, Error> {
    let pulse = Pulse { shape, amplitude: 1.0, duration: phase, start: 0.0 };
    Ok(limit.demand(&Pulses::new(&[pulse])?.respond(&Suspension::unit(damping))))
}

/// Returns the largest amplification over all durations, and the shortest ωD that has it; infinite if the amplification
/// only tends to it.
fn largest_amplification(damping: DampingRatio, limit: Limit, shape: Shape) -> Result<(f64, f64), Error> {
    let longest = 40.0 * TAU * (1.0 + damping.get());
    let step = Pulses::new(&[Pulse { shape: Shape::Rectangle, amplitude: 1.0, duration: longest, start: 0.0 }])?
        .respond(&Suspension::unit(damping));
    let step_peak = match limit {
        Limit::Acceleration(_) => step.absolute_acceleration.positive,
        Limit::RattleSpace(_) => {
            let e = step.relative_displacement.negative;
            crate::Extreme { value: -e.value, ..e }
        }
    };
    let step_overshoots = step_peak.value > 1.0 && step_peak.time < 0.5 * longest;
    if shape == Shape::Rectangle {
        // A step reaches the largest response to a rectangle at its first peak.
        return Ok(if step_overshoots { (step_peak.value, step_peak.time) } else { (1.0, f64::INFINITY) });
    }
    // Very long pulses act like their steepest part: a step for the initial peak, else a slow rise.
    let long = if shape == Shape::InitialPeakSawtooth { step_peak.value.max(1.0) } else { 1.0 };
    let mut best = (0.0, 0.0);
    let ratio = libm::pow(2.0, 1.0 / STEPS);
    let mut phase = 0.1;
    while phase < longest {
        let a = amplification(damping, limit, shape, phase)?;
        if a > best.0 {
            best = (a, phase);
        }
        phase *= ratio;
    }
    // Golden section between the neighbors of the best.
    let golden = 0.5 * (5_f64.sqrt() - 1.0);
    let (mut low, mut high) = (best.1 / ratio, best.1 * ratio);
    for _ in 0..48 {
        let (a, b) = (high - golden * (high - low), low + golden * (high - low));
        if amplification(damping, limit, shape, a)? < amplification(damping, limit, shape, b)? {
            low = a;
        } else {
            high = b;
        }
    }
    let phase = 0.5 * (low + high);
    let top = amplification(damping, limit, shape, phase)?;
    Ok(if top > long { (top, phase) } else { (long, f64::INFINITY) })
}

/// The capacity of a shock table, in the units of the component; a limit may be infinite.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ShockTable {
    /// Shortest half-sine.
    pub shortest: f64,
    /// Longest half-sine.
    pub longest: f64,
    /// Highest acceleration.
    pub acceleration: f64,
    /// Largest velocity change.
    pub velocity_change: f64,
}

/// A half-sine with the same effect on a component as another excitation.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct EquivalentPulse {
    /// The half-sine; it gives the component the same peak absolute acceleration.
    pub pulse: Pulse,
    /// Its peak relative displacement over the given one, less 1.
    pub displacement_mismatch: f64,
}

impl ShockTable {
    /// Returns the half-sine of this table that gives a component the same peak absolute acceleration as `response`,
    /// and the same peak relative displacement to within `tolerance` (0.01: 1 %). Where many do, the one of least
    /// acceleration.
    ///
    /// # Method
    ///
    /// Each duration D has one amplitude a(D) that gives the acceleration, and with it a mismatch of displacement. From
    /// durations 1/48 of an octave apart, and up to 128 periods no more than 1/16 of a period, the ends of the ranges
    /// within tolerance and limits are bisected wherever the mismatch passes ± `tolerance`, or a(D) a limit, from one
    /// to the next: also where the whole range lies between two of them. Smallest mismatches and amplitudes are found
    /// by golden sections.
    ///
    /// # Accuracy
    ///
    /// The amplitude is that of the duration to 10⁻¹², and above the least one by at most 10⁻¹². A range is missed only
    /// if it is entered and left between two neighbors, one of several there.
    ///
    /// # Examples
    ///
    /// Without damping A = ω²z for every pulse: all durations do, and the acceleration is least where a half-sine is
    /// amplified most, 1.768 times at 0.81 periods.
    ///
    /// ```
    /// # use clatter_shock::{DampingRatio, ShockTable, Suspension, VelocityShock, VelocityShocks};
    /// let mount = Suspension::from_hz(100.0, DampingRatio::new(0.0)?)?;
    /// let drop = VelocityShocks::new(vec![VelocityShock { time: 0.0, delta_v: 2.0 }])?.respond(&mount);
    /// let table = ShockTable { shortest: 2e-4, longest: 2e-2, acceleration: 5e4, velocity_change: 20.0 };
    /// let pulse = table.equivalent_half_sine(&mount, &drop, 0.01)?.pulse;
    /// assert!((pulse.duration - 8.0994e-3).abs() < 1e-7);
    /// assert!((drop.absolute_acceleration.magnitude() / pulse.amplitude - 1.768458).abs() < 1e-6);
    /// # Ok::<(), clatter_shock::Error>(())
    /// ```
    /// # Errors
    ///
    /// [`Error::NoEquivalent`] if there is none, with the nearest mismatch; [`Error::Quantity`] unless 0 < shortest ≤
    /// longest, the limits are above 0 and `tolerance` is finite and above 0, and for a response that is at rest or not
    /// finite; [`Error::Stop`] for a suspension with a stop.
    pub fn equivalent_half_sine(
        &self,
        suspension: &Suspension,
        response: &Response,
        tolerance: f64,
    ) -> Result<EquivalentPulse, Error> {
        suspension.refuse_stop("an equivalent pulse")?;
        crate::error::positive("shortest pulse of the table", self.shortest)?;
        crate::error::positive("longest pulse of the table", self.longest)?;
        if self.longest < self.shortest {
            let (name, value) = ("longest pulse of the table", self.longest);
            return Err(Error::Quantity { name, value, allowed: "at least the shortest" });
        }
        for (name, value) in
            [("acceleration of the table", self.acceleration), ("velocity change of the table", self.velocity_change)]
        {
            if value.is_nan() || value <= 0.0 {
                return Err(Error::Quantity { name, value, allowed: "> 0" });
            }
        }
        crate::error::positive("tolerance of the displacement", tolerance)?;
        let (a, z) = (response.absolute_acceleration.magnitude(), response.relative_displacement.magnitude());
        crate::error::positive("peak acceleration to reproduce", a)?;
        crate::error::positive("peak displacement to reproduce", z)?;
        Match { table: self, suspension, acceleration: a, displacement: z, tolerance }.find()
    }
}

/// The search for an equivalent pulse.
struct Match<'a> {
    table: &'a ShockTable,
    suspension: &'a Suspension,
    acceleration: f64,
    displacement: f64,
    tolerance: f64,
}

/// Durations of the first search, per octave, and per period up to so many periods.
const DURATIONS: f64 = 48.0;
const PER_PERIOD: f64 = 16.0;
const PERIODS: f64 = 128.0;
/// The most durations of the first search, for tables that no workshop has.
const MOST_DURATIONS: f64 = 1e4;

impl Match<'_> {
    fn find(&self) -> Result<EquivalentPulse, Error> {
        let mut list = self.durations()?;
        let mut between = Vec::new();
        for pair in list.windows(2) {
            self.crossings(&pair[0], &pair[1], &mut between)?;
        }
        let (size, amplitude) =
            (|e: &EquivalentPulse| e.displacement_mismatch.abs(), |e: &EquivalentPulse| e.pulse.amplitude);
        for near in list.windows(3) {
            let [before, here, after] = [&near[0], &near[1], &near[2]];
            let ends = (before.pulse.duration, after.pulse.duration);
            if !self.fits(here) && size(here) <= size(before).min(size(after)) {
                let least = self.least(ends, size)?;
                self.crossings(before, &least, &mut between)?;
                self.crossings(&least, after, &mut between)?;
                between.push(least);
            }
            if near.iter().all(|e| self.fits(e)) && amplitude(here) <= amplitude(before).min(amplitude(after)) {
                between.push(self.least(ends, amplitude)?);
            }
        }
        list.append(&mut between);
        let fitting = list.iter().filter(|e| self.fits(e));
        if let Some(least) = fitting.min_by(|a, b| amplitude(a).total_cmp(&amplitude(b))) {
            return Ok(*least);
        }
        let nearest = list.iter().filter(|e| self.is_possible(e)).map(size).fold(f64::INFINITY, f64::min);
        Err(Error::NoEquivalent { nearest, tolerance: self.tolerance })
    }
    /// Returns the pulses of the first search.
    fn durations(&self) -> Result<Vec<EquivalentPulse>, Error> {
        let ShockTable { shortest, longest, .. } = *self.table;
        let period = TAU / self.suspension.omega();
        let ratio = libm::pow(2.0, (libm::log2(longest / shortest) / MOST_DURATIONS).max(1.0 / DURATIONS));
        let (mut list, mut duration) = (Vec::new(), shortest);
        while duration < longest {
            list.push(self.at(duration)?);
            let fine = if duration < PERIODS * period { period / PER_PERIOD } else { f64::INFINITY };
            duration += (duration * (ratio - 1.0)).min(fine);
        }
        list.push(self.at(longest)?);
        Ok(list)
    }
    /// Returns the pulse of this duration that gives the acceleration.
    fn at(&self, duration: f64) -> Result<EquivalentPulse, Error> {
        let mut pulse = Pulse { shape: Shape::HalfSine, amplitude: 1.0, duration, start: 0.0 };
        let unit = Pulses::new(&[pulse])?.respond(self.suspension);
        pulse.amplitude = self.acceleration / unit.absolute_acceleration.magnitude();
        let reached = pulse.amplitude * unit.relative_displacement.magnitude();
        Ok(EquivalentPulse { pulse, displacement_mismatch: reached / self.displacement - 1.0 })
    }
    fn is_possible(&self, e: &EquivalentPulse) -> bool {
        e.pulse.amplitude <= self.table.acceleration && e.pulse.velocity_change() <= self.table.velocity_change
    }
    fn fits(&self, e: &EquivalentPulse) -> bool {
        self.is_possible(e) && e.displacement_mismatch.abs() <= self.tolerance
    }
    /// Adds the ends of ranges of fitting pulses between two durations.
    fn crossings(
        &self,
        one: &EquivalentPulse,
        other: &EquivalentPulse,
        list: &mut Vec<EquivalentPulse>,
    ) -> Result<(), Error> {
        for bound in 0..4 {
            if (self.excess(one, bound) > 0.0) != (self.excess(other, bound) > 0.0) {
                list.push(self.crossing(*one, *other, bound)?);
            }
        }
        Ok(())
    }
    /// Returns the excess of a pulse over one of the bounds.
    fn excess(&self, e: &EquivalentPulse, bound: usize) -> f64 {
        match bound {
            0 => e.displacement_mismatch - self.tolerance,
            1 => -e.displacement_mismatch - self.tolerance,
            2 => e.pulse.amplitude - self.table.acceleration,
            _ => e.pulse.velocity_change() - self.table.velocity_change,
        }
    }
    /// Returns the last pulse within a bound, between one within and one beyond it.
    fn crossing(
        &self,
        mut within: EquivalentPulse,
        mut beyond: EquivalentPulse,
        bound: usize,
    ) -> Result<EquivalentPulse, Error> {
        if self.excess(&within, bound) > 0.0 {
            std::mem::swap(&mut within, &mut beyond);
        }
        loop {
            let (a, b) = (within.pulse.duration, beyond.pulse.duration);
            let middle = 0.5 * a + 0.5 * b;
            if middle <= a.min(b) || middle >= a.max(b) {
                return Ok(within);
            }
            let e = self.at(middle)?;
            *(if self.excess(&e, bound) <= 0.0 { &mut within } else { &mut beyond }) = e;
        }
    }
    /// Returns the pulse with the least value of a function between two durations, by a golden section.
    fn least(
        &self,
        (mut low, mut high): (f64, f64),
        size: impl Fn(&EquivalentPulse) -> f64,
    ) -> Result<EquivalentPulse, Error> {
        let golden = 0.5 * (5_f64.sqrt() - 1.0);
        for _ in 0..40 {
            let (a, b) = (high - golden * (high - low), low + golden * (high - low));
            if size(&self.at(a)?) > size(&self.at(b)?) {
                low = a;
            } else {
                high = b;
            }
        }
        self.at(0.5 * (low + high))
    }
}
