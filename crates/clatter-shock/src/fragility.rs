//! What a component stands: limits and margins, the damage boundary, and the shock-table pulse that equals a clatter.

use crate::{DampingRatio, Error, Pulse, Pulses, Response, Shape, Suspension};
use std::f64::consts::TAU;

/// A limit on what a component goes through.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Limit {
    /// Peak absolute acceleration of the component.
    Acceleration(f64),
    /// Peak displacement relative to the base: the free space around it.
    RattleSpace(f64),
}

impl Limit {
    fn allowed(self) -> Result<f64, Error> {
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
    /// How far a response stays from the limit.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless the limit is finite and positive.
    pub fn margin(self, response: &Response) -> Result<Margin, Error> {
        Ok(Margin { allowed: self.allowed()?, demand: self.demand(response) })
    }
}

/// What is allowed and what is asked, in one unit: of a response, or of a velocity change of the base.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Margin {
    /// The limit.
    pub allowed: f64,
    /// What is reached.
    pub demand: f64,
}

impl Margin {
    /// allowed/demand − 1: negative where the limit is passed, infinite where nothing is asked.
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
    /// 20 log₁₀(allowed/demand).
    #[must_use]
    pub fn decibel(&self) -> f64 {
        20.0 * (self.allowed / self.demand).log10()
    }
    /// Whether the limit holds.
    #[must_use]
    pub fn is_safe(&self) -> bool {
        self.demand <= self.allowed
    }
}

/// The damage boundary of a component for one pulse shape (Newton 1968; ASTM D3332).
///
/// Pulses below the critical velocity change are safe at any acceleration, pulses below the critical acceleration at any
/// velocity change; between, the boundary turns, and ends at the knee.
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
pub struct Trial {
    /// Velocity change or acceleration of the table.
    pub level: f64,
    /// Whether the component was damaged.
    pub damaged: bool,
}

/// Steps of the search for the largest amplification, per octave of duration.
const STEPS: f64 = 24.0;

impl DamageBoundary {
    /// From a suspension, a limit and a pulse shape.
    ///
    /// # Examples
    ///
    /// For an undamped component and the rectangle the knee is at π/2 times the critical velocity change (1.57 in ASTM D3332):
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
    /// [`Error::Quantity`] unless the limit is finite and positive; [`Error::Entry`] for a trapezoid without ramps.
    pub fn new(suspension: Suspension, limit: Limit, shape: Shape) -> Result<Self, Error> {
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
    /// From shock tests as in ASTM D3332: `velocity` with short pulses of rising velocity change, `acceleration` with long
    /// rectangles of rising acceleration. Critical is the highest level below all damage; the boundary between is that of the
    /// undamped component with both, whose knee is at π/2 of the critical velocity change.
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
    /// Below it no pulse does damage, however high.
    #[must_use]
    pub fn critical_velocity_change(&self) -> f64 {
        self.critical_velocity_change
    }
    /// Below it no pulse does damage, however long.
    #[must_use]
    pub fn critical_acceleration(&self) -> f64 {
        self.critical_acceleration
    }
    /// Velocity change from which the critical acceleration alone decides; infinite if amplification only tends to its largest
    /// value as pulses grow longer.
    #[must_use]
    pub fn knee_velocity_change(&self) -> f64 {
        // Also where the critical acceleration is too small for the floats, 0.
        if self.knee_duration == f64::INFINITY {
            return f64::INFINITY;
        }
        self.shape.area() * self.critical_acceleration * self.knee_duration
    }
    /// The boundary from the critical velocity change to the knee: `points` pairs of (velocity change, acceleration), for durations
    /// in equal ratios. Where the knee is infinite it ends at ten periods.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless there are at least two points.
    pub fn curve(&self, points: usize) -> Result<Vec<(f64, f64)>, Error> {
        if points < 2 {
            return Err(Error::Empty("a curve of at least two points"));
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
                let duration = first * (last / first).powf(share);
                let unit = Pulse { shape: self.shape, amplitude: 1.0, duration, start: 0.0 };
                let amplitude = allowed / self.limit.demand(&Pulses::new(&[unit])?.respond(&self.suspension));
                Ok((self.shape.area() * amplitude * duration, amplitude))
            })
            .collect()
    }
    /// Margin of one pulse of this shape: what the component stands over what it gets.
    ///
    /// # Errors
    /// As [`Pulses::new`].
    pub fn margin(&self, amplitude: f64, duration: f64) -> Result<Margin, Error> {
        let pulse = Pulse { shape: self.shape, amplitude, duration, start: 0.0 };
        self.limit.margin(&Pulses::new(&[pulse])?.respond(&self.suspension))
    }
}

/// Response over that to a steady acceleration of the pulse's amplitude, for ω = 1 and the duration `phase`.
fn amplification(damping: DampingRatio, limit: Limit, shape: Shape, phase: f64) -> Result<f64, Error> {
    let pulse = Pulse { shape, amplitude: 1.0, duration: phase, start: 0.0 };
    Ok(limit.demand(&Pulses::new(&[pulse])?.respond(&Suspension::unit(damping))))
}

/// The largest amplification over all durations, and the shortest ωD that has it; infinite if it is only tended to.
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
        // All that a rectangle can do, a step has done at its first peak.
        return Ok(if step_overshoots { (step_peak.value, step_peak.time) } else { (1.0, f64::INFINITY) });
    }
    // Very long pulses act like their steepest part: a step for the initial peak, else a slow rise.
    let long = if shape == Shape::InitialPeakSawtooth { step_peak.value.max(1.0) } else { 1.0 };
    let mut best = (0.0, 0.0);
    let ratio = 2_f64.powf(1.0 / STEPS);
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

/// What a shock table can do.
#[derive(Debug, Clone, Copy, PartialEq)]
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

/// A half-sine that does to a component what another excitation does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EquivalentPulse {
    /// The half-sine; it gives the component the same peak absolute acceleration.
    pub pulse: Pulse,
    /// Its peak relative displacement over the one asked for, less 1.
    pub displacement_mismatch: f64,
}

impl ShockTable {
    /// The half-sine of this table that gives a component the same peak absolute acceleration as `response`, and the same peak
    /// relative displacement to within `tolerance` (0.01: 1 %). Where many do, the longest: it needs the least
    /// acceleration.
    ///
    /// # Errors
    ///
    /// [`Error::NoEquivalent`] says that there is none, and how near the table comes; [`Error::Quantity`] for a table that can do
    /// nothing.
    pub fn equivalent_half_sine(
        &self,
        suspension: &Suspension,
        response: &Response,
        tolerance: f64,
    ) -> Result<EquivalentPulse, Error> {
        crate::error::positive("shortest pulse", self.shortest)?;
        crate::error::positive("longest pulse", self.longest)?;
        let (a, z) = (response.absolute_acceleration.magnitude(), response.relative_displacement.magnitude());
        crate::error::positive("peak acceleration to reproduce", a)?;
        let steps = ((self.longest / self.shortest).log2() * 2.0 * STEPS).ceil().clamp(1.0, 1e4);
        let (mut i, mut nearest) = (steps, f64::INFINITY);
        while i >= 0.0 {
            let duration = self.shortest * (self.longest / self.shortest).powf(i / steps);
            let mut pulse = Pulse { shape: Shape::HalfSine, amplitude: 1.0, duration, start: 0.0 };
            let unit = Pulses::new(&[pulse])?.respond(suspension);
            pulse.amplitude = a / unit.absolute_acceleration.magnitude();
            let displacement_mismatch = pulse.amplitude * unit.relative_displacement.magnitude() / z - 1.0;
            if pulse.amplitude <= self.acceleration && pulse.velocity_change() <= self.velocity_change {
                if displacement_mismatch.abs() <= tolerance {
                    return Ok(EquivalentPulse { pulse, displacement_mismatch });
                }
                nearest = nearest.min(displacement_mismatch.abs());
            }
            i -= 1.0;
        }
        Err(Error::NoEquivalent { nearest })
    }
}
