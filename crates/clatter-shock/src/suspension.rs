//! The suspended component and its free motion.
//!
//! # Two coordinates for every damping ratio
//!
//! With time τ = ωt, x = ωz and y = dx/dτ (both velocities) the component obeys
//!
//! ```text
//! x″ + 2ζ x′ + x = f(τ),    f = −(base acceleration)/ω
//! ```
//!
//! This crate carries x and w = y + σx, where σ is the decay rate of the slower mode: σ = ζ for ζ ≤ 1 and
//! σ = 1/(ζ + √(ζ²−1)) beyond. Then
//!
//! ```text
//! x′ = −σ x + w
//! w′ = −p x − ρ w + f,      (p, ρ) = (1 − ζ², ζ)  for ζ ≤ 1,   (0, 1/σ)  for ζ > 1
//! ```
//!
//! and the free motion needs the entire functions sin(βτ)/β and (1 − exp(−κτ))/κ, both τ at ζ = 1: nothing is
//! singular there, and nothing cancels at large damping, where the system is a cascade of two decays.

use crate::{Error, Stop};
use std::f64::consts::{PI, TAU};

/// Damping ratio ζ = c/(2√(km)), zero or more: 0 never decays, 1 is critical.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(try_from = "f64", into = "f64"))]
pub struct DampingRatio(f64);

impl DampingRatio {
    /// Creates a damping ratio.
    ///
    /// # Errors
    /// [`Error::DampingRatio`] unless 0 ≤ ζ ≤ 10⁶⁰; −0 counts as 0.
    pub fn new(zeta: f64) -> Result<Self, Error> {
        if (0.0..=1e60).contains(&zeta) { Ok(Self(zeta + 0.0)) } else { Err(Error::DampingRatio(zeta)) }
    }
    /// Creates the damping ratio from the quality factor Q = 1/(2ζ); an infinite Q is no damping.
    ///
    /// ```
    /// # use clatter_shock::DampingRatio;
    /// assert_eq!(DampingRatio::from_quality_factor(10.0)?.get(), 0.05);
    /// # Ok::<(), clatter_shock::Error>(())
    /// ```
    /// # Errors
    /// [`Error::QualityFactor`] unless Q ≥ 10⁻⁶⁰.
    pub fn from_quality_factor(q: f64) -> Result<Self, Error> {
        if q >= 1e-60 { Ok(Self(0.5 / q)) } else { Err(Error::QualityFactor(q)) }
    }
    /// Returns the value.
    #[must_use]
    pub fn get(self) -> f64 {
        self.0
    }
}

/// A base-excited component with one degree of freedom.
///
/// Units are the caller's, as long as they agree: rad/s with seconds and meters, or v0/h0 with the units of the bar.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "crate::fields::SuspensionFields", into = "crate::fields::SuspensionFields")
)]
pub struct Suspension {
    omega: f64,
    damping: DampingRatio,
    stop: Option<Stop>,
}

/// Motion of the component relative to its base.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct State {
    /// Relative displacement z.
    pub displacement: f64,
    /// Relative velocity z′.
    pub velocity: f64,
}

impl Suspension {
    /// Creates a suspension from the natural angular frequency ω (rad per unit of time).
    /// # Errors
    /// [`Error::Quantity`] unless ω is finite and positive.
    pub fn new(omega: f64, damping: DampingRatio) -> Result<Self, Error> {
        Ok(Self { omega: crate::error::positive("natural angular frequency", omega)?, damping, stop: None })
    }
    /// Creates a suspension from the natural frequency in hertz: ω = 2πf.
    /// # Errors
    /// [`Error::Quantity`] unless f is finite and positive.
    pub fn from_hz(frequency_hz: f64, damping: DampingRatio) -> Result<Self, Error> {
        crate::error::positive("natural frequency (Hz)", frequency_hz)?;
        Self::new(TAU * frequency_hz, damping)
    }
    /// Creates a suspension from a natural angular frequency that is checked already.
    pub(crate) fn of_omega(omega: f64, damping: DampingRatio) -> Self {
        Self { omega, ..Self::unit(damping) }
    }
    /// Creates a suspension with ω = 1.
    pub(crate) fn unit(damping: DampingRatio) -> Self {
        Self { omega: 1.0, damping, stop: None }
    }
    /// Returns the same suspension with a stop on either side.
    ///
    /// [`Pulses`](crate::Pulses) and [`VelocityShocks`](crate::VelocityShocks) then answer with the stops: the absolute
    /// acceleration A is that of spring, damper and stop, and every phase between two touches, crests and partings is
    /// solved in closed form. Functions that scale a linear response refuse it ([`Error::Stop`]).
    ///
    /// # Examples
    ///
    /// A part on so soft a spring that it moves freely meets its stop at 2 m/s. Alone on it for 0.5 ms it presses with
    /// (π/2)(1 + e) v/τ, and leaves with e times its speed for the other one:
    ///
    /// ```
    /// # use clatter_shock::{DampingRatio, Peaked, Stop, Suspension, VelocityShock, VelocityShocks};
    /// # use std::f64::consts::FRAC_PI_2;
    /// let free = Suspension::new(1e-3, DampingRatio::new(0.0)?)?.with_stop(Stop::new(1e-3, 0.5e-3, 0.4)?);
    /// let shock = VelocityShocks::new(vec![VelocityShock { time: 0.0, delta_v: 2.0 }])?;
    /// let peak = shock.respond(&free).absolute_acceleration.peak().value;
    /// assert!((peak / (FRAC_PI_2 * 1.4 * 2.0 / 0.5e-3) - 1.0).abs() < 1e-9);
    /// let hit = shock.peak_above(&free, Peaked::StopSpeed, 0.0).unwrap();
    /// assert!((hit.value - 2.0).abs() < 1e-9 && (hit.time - 0.5e-3).abs() < 1e-12);
    /// # Ok::<(), clatter_shock::Error>(())
    /// ```
    #[must_use]
    pub fn with_stop(self, stop: Stop) -> Self {
        Self { stop: Some(stop), ..self }
    }
    /// Returns the stop, if there is one.
    #[must_use]
    pub fn stop(&self) -> Option<Stop> {
        self.stop
    }
    /// Returns the same suspension without a stop.
    #[must_use]
    pub fn without_stop(self) -> Self {
        Self { stop: None, ..self }
    }
    /// Returns an error that names `what` if there is a stop.
    pub(crate) fn refuse_stop(&self, what: &'static str) -> Result<(), Error> {
        if self.stop.is_some() { Err(Error::Stop(what)) } else { Ok(()) }
    }
    /// Returns the natural angular frequency ω.
    #[must_use]
    pub fn omega(&self) -> f64 {
        self.omega
    }
    /// Returns the damping ratio ζ.
    #[must_use]
    pub fn damping(&self) -> DampingRatio {
        self.damping
    }
    /// Returns the absolute acceleration of the component, A = −(2ζω z′ + ω² z), also while the base accelerates: that by
    /// spring and damper, without the force of a stop.
    #[must_use]
    pub fn absolute_acceleration(&self, state: State) -> f64 {
        let modes = Modes::new(self.damping);
        self.omega * modes.quantity(Modes::ACCELERATION, modes.motion(self.omega, state))
    }
    /// Returns the state a time `t` ≥ 0 after `state` in free motion, with the base at rest or in uniform motion. It is the
    /// motion between the stops, without them.
    ///
    /// ```text
    /// ζ < 1:  ωz = e^(−ζωt) [ωz₀ cos βωt + (z′₀ + ζωz₀) sin(βωt)/β],   β = √(1 − ζ²)
    /// ```
    ///
    /// and its continuation through ζ = 1 (see the module).
    ///
    /// # Accuracy
    ///
    /// ω z and z′ are within 8 ε of |ωz₀| + |z′₀| times the decay, e^(−ζωt) for ζ ≤ 1, for ωt from 0 to 10¹²: the phase
    /// βωt is carried in two doubles. For ζ > 1 the exponent is one double: within (8 + ωt/ζ) ε. Near critical damping
    /// the motion grows by 1 + ωt before it decays, and the error with it ([`crate::accuracy::FREE`]).
    ///
    /// # Examples
    ///
    /// A quarter of a period turns velocity into displacement:
    ///
    /// ```
    /// # use clatter_shock::{DampingRatio, State, Suspension};
    /// let undamped = Suspension::from_hz(0.25, DampingRatio::new(0.0)?)?;
    /// let after = undamped.free(State { displacement: 0.0, velocity: 1.0 }, 1.0);
    /// assert!((after.displacement - 1.0 / undamped.omega()).abs() < 1e-15 && after.velocity.abs() < 1e-15);
    /// # Ok::<(), clatter_shock::Error>(())
    /// ```
    #[must_use]
    pub fn free(&self, state: State, t: f64) -> State {
        let modes = Modes::new(self.damping);
        let step = modes.propagator(Phase::product(self.omega, t));
        modes.state(self.omega, step.apply(modes.p, modes.motion(self.omega, state)))
    }
}

/// x = ωz and w = z′ + σωz.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Motion {
    pub(crate) x: f64,
    pub(crate) w: f64,
}

/// ωt as an unevaluated sum of two doubles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Phase {
    pub(crate) hi: f64,
    lo: f64,
}

impl Phase {
    /// Returns ω t; the rounding error is kept where it can reach a phase.
    #[inline]
    pub(crate) fn product(omega: f64, t: f64) -> Self {
        Self::product2(omega, t, 0.0)
    }
    /// Returns ω (t + `t_lo`).
    #[inline]
    pub(crate) fn product2(omega: f64, t: f64, t_lo: f64) -> Self {
        // An infinite time behind ζ = 0 would have no phase; the largest double has one.
        let hi = (omega * t).min(f64::MAX);
        if hi <= PLAIN_PHASE || hi > 1e290 {
            return Self { hi, lo: 0.0 };
        }
        Self { hi, lo: omega.mul_add(t, -hi) + omega * t_lo }
    }
}

/// The phase up to which one rounding stays below 16 ε/2, so that no second double is needed.
const PLAIN_PHASE: f64 = 16.0;

/// The dimensionless system of one damping ratio.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Modes {
    pub(crate) zeta: f64,
    /// Decay rate of the slower mode.
    pub(crate) sigma: f64,
    /// Decay rate of w.
    pub(crate) rho: f64,
    /// 1 − ζ², or 0 beyond critical damping.
    pub(crate) p: f64,
    /// √(1 − ζ²), or 0 beyond critical damping, and its rounding error.
    pub(crate) beta: f64,
    pub(crate) beta_lo: f64,
    /// Difference of the decay rates 2√(ζ² − 1), or 0 up to critical damping.
    pub(crate) kappa: f64,
    /// exp(−ζπ/β), the factor of amplitude over half a swing.
    pub(crate) half_swing: f64,
    /// √(1 + σ²): |w| stays below that times √(x² + y²).
    pub(crate) tilt: f64,
    /// Rows k: the k-th derivative of x in free motion is `row[0] x + row[1] w`. Rows 0, 1, 2 are the three
    /// quantities: displacement ωz, velocity z′, absolute acceleration A/ω.
    pub(crate) rows: [[f64; 2]; 7],
}

/// x, w after a time: x = c x₀ + s w₀, w = k w₀ − p s x₀.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Propagator {
    pub(crate) c: f64,
    pub(crate) s: f64,
    pub(crate) k: f64,
}

impl Propagator {
    #[inline]
    pub(crate) fn apply(&self, p: f64, m: Motion) -> Motion {
        Motion { x: self.c * m.x + self.s * m.w, w: self.k * m.w - p * self.s * m.x }
    }
}

/// A turning point of free motion: its phase and its value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Turn {
    pub(crate) tau: f64,
    pub(crate) value: f64,
}

/// Returns the root of a sum of squares, by `otherwise` where squares may over- or underflow.
#[inline]
fn root_of(square: f64, otherwise: impl Fn() -> f64) -> f64 {
    if (1e-280..1e280).contains(&square) { square.sqrt() } else { otherwise() }
}

impl Modes {
    pub(crate) const DISPLACEMENT: usize = 0;
    pub(crate) const VELOCITY: usize = 1;
    pub(crate) const ACCELERATION: usize = 2;

    pub(crate) fn new(damping: DampingRatio) -> Self {
        let zeta = damping.get();
        let mut modes = if zeta <= 1.0 {
            let square = zeta * zeta;
            let square_lo = zeta.mul_add(zeta, -square);
            let p = 1.0 - square;
            let p_lo = (1.0 - p) - square - square_lo;
            let p_sum = p + p_lo;
            let beta = p_sum.sqrt();
            let beta_lo =
                if beta > 0.0 { (p_lo + (p - p_sum) - beta.mul_add(beta, -p_sum)) / (2.0 * beta) } else { 0.0 };
            Self {
                zeta,
                sigma: zeta,
                rho: zeta,
                p: p_sum,
                beta,
                beta_lo,
                kappa: 0.0,
                half_swing: libm::exp(-zeta * PI / beta),
                tilt: 0.0,
                rows: [[0.0; 2]; 7],
            }
        } else {
            let eta = (zeta - 1.0).sqrt() * (zeta + 1.0).sqrt();
            let rho = zeta + eta;
            Self {
                zeta,
                sigma: rho.recip(),
                rho,
                p: 0.0,
                beta: 0.0,
                beta_lo: 0.0,
                kappa: 2.0 * eta,
                half_swing: 0.0,
                tilt: 0.0,
                rows: [[0.0; 2]; 7],
            }
        };
        modes.tilt = (1.0 + modes.sigma * modes.sigma).sqrt();
        modes.rows[0] = [1.0, 0.0];
        for k in 1..7 {
            let [a, b] = modes.rows[k - 1];
            modes.rows[k] = [-modes.sigma * a - modes.p * b, a - modes.rho * b];
        }
        modes
    }
    pub(crate) fn motion(&self, omega: f64, state: State) -> Motion {
        let x = omega * state.displacement;
        Motion { x, w: state.velocity + self.sigma * x }
    }
    pub(crate) fn state(&self, omega: f64, m: Motion) -> State {
        State { displacement: m.x / omega, velocity: self.quantity(Self::VELOCITY, m) }
    }
    /// Returns row k of the motion.
    #[inline]
    pub(crate) fn quantity(&self, k: usize, m: Motion) -> f64 {
        self.rows[k][0] * m.x + self.rows[k][1] * m.w
    }
    /// Returns the free motion over a phase ωt.
    #[inline]
    pub(crate) fn propagator(&self, phase: Phase) -> Propagator {
        let tau = phase.hi;
        if self.kappa == 0.0 {
            let (theta, decay) = if phase.lo == 0.0 && tau <= PLAIN_PHASE {
                (libm::sincos(self.beta * tau), libm::exp(-self.zeta * tau))
            } else {
                self.long(phase)
            };
            let s = if self.beta == 0.0 { tau } else { theta.0 / self.beta };
            Propagator { c: decay * theta.1, s: decay * s, k: decay * theta.1 }
        } else {
            let slow = libm::exp(-self.sigma * tau);
            let phi = -libm::expm1(-self.kappa * tau) / self.kappa;
            Propagator { c: slow, s: slow * phi, k: libm::exp(-self.rho * tau) }
        }
    }
    /// Returns the sine and cosine of βτ and the decay, with phase and exponent in two doubles.
    #[cold]
    fn long(&self, phase: Phase) -> ((f64, f64), f64) {
        let (tau, lo) = (phase.hi, phase.lo);
        let product = |a: f64, a_lo: f64| {
            let hi = a * tau;
            if hi.is_finite() { (hi, a.mul_add(tau, -hi) + a * lo + a_lo * tau) } else { (f64::MAX, 0.0) }
        };
        let (angle, angle_lo) = product(self.beta, self.beta_lo);
        let (exponent, exponent_lo) = product(self.zeta, 0.0);
        let (sin, cos) = libm::sincos(angle);
        let (small_sin, small_cos) = if angle_lo.abs() < 1e-8 { (angle_lo, 1.0) } else { libm::sincos(angle_lo) };
        let decay = libm::exp(-exponent) * (1.0 - exponent_lo.clamp(-0.5, 0.5));
        ((sin * small_cos + cos * small_sin, cos * small_cos - sin * small_sin), decay)
    }
    /// Returns an upper bound on each of the three quantities at later turning points, for ζ ≤ 1: √(w² + (1−ζ²)x²),
    /// their common amplitude.
    #[inline]
    pub(crate) fn amplitude(&self, m: Motion) -> f64 {
        root_of(m.w * m.w + self.p * m.x * m.x, || libm::hypot(m.w, self.beta * m.x))
    }
    /// Returns the sum of the sizes of the terms of quantity `k`, the scale of its rounding.
    pub(crate) fn size(&self, k: usize, m: Motion) -> f64 {
        self.rows[k][0].abs() * m.x.abs() + self.rows[k][1].abs() * m.w.abs()
    }
    /// Returns √(x² + y²), which free motion never raises.
    pub(crate) fn energy(&self, m: Motion) -> f64 {
        let y = m.w - self.sigma * m.x;
        root_of(m.x * m.x + y * y, || libm::hypot(m.x, y))
    }
    /// Returns an upper bound on quantity `k` in all free motion from `m`.
    pub(crate) fn reach(&self, k: usize, m: Motion) -> f64 {
        if self.beta > 0.0 {
            return self.amplitude(m) / self.beta;
        }
        // Two decays in a row: |x| ≤ |x₀| + |w₀|.
        let [a, b] = self.rows[k];
        a.abs() * (m.x.abs() + m.w.abs()) + b.abs() * m.w.abs()
    }
    /// Returns a bound on |q″ + q| of quantity q, number `k`, where |x| and |y| stay within `v` and the forcing and its
    /// slope within `f` and `slope`: q″ = −q − 2ζq′ + (input).
    #[inline]
    pub(crate) fn bend_bound(&self, k: usize, v: f64, f: f64, slope: f64) -> f64 {
        let damp = 2.0 * self.zeta;
        match k {
            Self::DISPLACEMENT => damp * v + f,
            Self::VELOCITY => damp * ((1.0 + damp) * v + f) + slope,
            _ => damp * ((1.0 + damp + damp * damp) * v + damp * f + slope) + f,
        }
    }
    /// Returns the first zero of row `j` after the start of free motion from `m`, as τ and, beyond critical damping, φ.
    ///
    /// The row is e^(−στ) (r cos βτ + b sin(βτ)/β), or e^(−στ) (r + b (1 − e^(−κτ))/κ), with b = r′ + σr.
    #[inline]
    pub(crate) fn zero(&self, j: usize, m: Motion) -> Option<(f64, f64)> {
        let start = self.quantity(j, m);
        let bend = self.quantity(j + 1, m) + self.sigma * start;
        if self.beta > 0.0 {
            let angle = if start == 0.0 { PI } else { libm::atan2(self.beta * start.abs(), -bend * start.signum()) };
            return Some((angle / self.beta, 0.0));
        }
        let phi = -start / bend;
        if !(phi > 0.0 && phi < f64::INFINITY && self.kappa * phi < 1.0) {
            return None;
        }
        Some((if self.kappa == 0.0 { phi } else { -libm::log1p(-self.kappa * phi) / self.kappa }, phi))
    }
    /// Returns the first turning point of quantity `k` after the start of free motion from `m`.
    ///
    /// For ζ < 1 the quantities are derivatives of one another and swing with one amplitude N = √(w² + (1−ζ²)x²): at
    /// its turning points each is ±N e^(−ζτ).
    #[inline]
    pub(crate) fn turn(&self, k: usize, m: Motion) -> Option<Turn> {
        let (tau, phi) = self.zero(k + 1, m)?;
        let slope = self.quantity(k + 1, m);
        let value = if self.beta > 0.0 {
            let sign = if slope == 0.0 { self.quantity(k + 2, m) } else { slope };
            libm::exp(-self.zeta * tau) * self.amplitude(m).copysign(sign)
        } else {
            let value = self.quantity(k, m);
            (value + (slope + self.sigma * value) * phi) * libm::exp(-self.sigma * tau)
        };
        Some(Turn { tau, value })
    }
    /// Reports the two largest extremes of quantity `k` inside free motion from `m`, up to τ = `span`, as (τ, value);
    /// none where the amplitude cannot pass the lowest and highest values `seen`.
    #[inline]
    pub(crate) fn free_extremes(
        &self,
        k: usize,
        m: Motion,
        span: f64,
        seen: (f64, f64),
        mut report: impl FnMut(f64, f64),
    ) {
        if self.beta > 0.0 {
            // The first turning point lies in the direction of the motion, the second on the other side half a swing
            // later.
            let n = self.amplitude(m);
            let (ahead, behind) = if self.quantity(k + 1, m) > 0.0 { (seen.1, -seen.0) } else { (-seen.0, seen.1) };
            if n <= ahead && n * self.half_swing <= behind {
                return;
            }
        }
        let Some(turn) = self.turn(k, m) else { return };
        if turn.tau >= span {
            return;
        }
        report(turn.tau, turn.value);
        if self.beta > 0.0 {
            let tau = turn.tau + PI / self.beta;
            if tau < span {
                report(tau, -turn.value * self.half_swing);
            }
        }
    }
}
