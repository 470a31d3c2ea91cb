//! Motion while the base accelerates: linear and sinusoidal histories, in closed form, and their largest values.
//!
//! The response from rest to e^(μτ) is the divided difference of the exponential over the two modes λ₁, λ₂ and μ. It is formed as
//!
//! ```text
//! e[λ₁, λ₂, μ] = (e[λ₁, μ] − e[λ₁, λ₂]) / (μ − λ₂),    e[λ₁, λ₂] = sin(βτ) e^(−ζτ)/β
//! ```
//!
//! where μ − λ₂ is never small and e[λ₁, μ] is e^(μτ) τ (e^z − 1)/z: resonance (λ₁ = μ) and critical damping (λ₁ = λ₂) are
//! ordinary points. For short spans the power series of the motion is summed instead.

use crate::peaks::Range;
use crate::suspension::{Modes, Motion, Phase, Propagator};
use num_complex::Complex64;
use std::f64::consts::PI;

/// Terms of a series at most.
const TERMS: usize = 60;
/// 1/k, and 1/((k+1)(k+2)): divisions would take most of the time of a series.
const RECIPROCAL: [[f64; 2]; TERMS + 1] = {
    let mut table = [[1.0; 2]; TERMS + 1];
    let (mut i, mut k) = (0, 0.0);
    while i <= TERMS {
        table[i] = [if i == 0 { 1.0 } else { 1.0 / k }, 1.0 / ((k + 1.0) * (k + 2.0))];
        (i, k) = (i + 1, k + 1.0);
    }
    table
};

/// Series up to (1 + 2ζ)τ = ½; beyond, the closed forms lose no more than two bits to their differences of terms of size τ.
const SERIES_REACH: f64 = 0.5;

/// From here on the steady motion is bounded at every frequency, and bounds on derivatives start from it.
const STRONG_DAMPING: f64 = 0.5;

/// Response from rest to f = 1 (`x0`, `w0`) and to f = τ (`x1`, `w1`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Ramp {
    pub(crate) x0: f64,
    pub(crate) w0: f64,
    pub(crate) x1: f64,
    pub(crate) w1: f64,
}

impl Modes {
    fn is_short(&self, tau: f64) -> bool {
        (1.0 + 2.0 * self.zeta) * tau <= SERIES_REACH
    }
    /// Response from rest to a constant and to a ramp after τ; `step` is the free motion over the same τ.
    pub(crate) fn ramp(&self, tau: f64, step: &Propagator) -> Ramp {
        if self.is_short(tau) {
            // Ramp response Σ u_k τ^k from u₃ = 1/6; its derivatives are the step and the impulse response.
            let (damp, square) = (2.0 * self.zeta * tau, tau * tau);
            let (mut older, mut u) = (0.0, 1.0 / 6.0);
            let (mut x1, mut x0, mut h) = (u, 3.0 * u, 6.0 * u);
            let mut k = 3.0;
            for [_, reciprocal] in &RECIPROCAL[2..40] {
                let next = (-damp * k * u - square * older) * reciprocal;
                (older, u, k) = (u, next, k + 1.0);
                x1 += u;
                x0 += k * u;
                let term = k * (k - 1.0) * u;
                h += term;
                if term.abs() + (k * k * older).abs() < 1e-18 {
                    break;
                }
            }
            let (x1, x0, h) = (x1 * tau * square, x0 * square, h * tau);
            return Ramp { x0, w0: h + self.sigma * x0, x1, w1: x0 + self.sigma * x1 };
        }
        if self.kappa == 0.0 {
            let x0 = 1.0 - step.c - self.zeta * step.s;
            let x1 = tau - 2.0 * self.zeta * x0 - step.s;
            return Ramp { x0, w0: step.s + self.zeta * x0, x1, w1: x0 + self.zeta * x1 };
        }
        // Two decays in a row, each integrated on its own.
        let slow = self.sigma * tau;
        let rise = -(-slow).exp_m1() / self.sigma;
        let rise_of_ramp = if slow < 0.5 { tau * tau * psi2(slow) } else { (tau - rise) / self.sigma };
        let w0 = -(-self.rho * tau).exp_m1() / self.rho;
        let x0 = (rise - step.s) / self.rho;
        Ramp { x0, w0, x1: (rise_of_ramp - x0) / self.rho, w1: (tau - w0) / self.rho }
    }
}

/// (e^(−z) − 1 + z)/z² = 1/2 − z/6 + z²/24 − … for 0 ≤ z < ½.
fn psi2(z: f64) -> f64 {
    let (mut term, mut sum) = (0.5, 0.5);
    for k in 3..18 {
        term *= -z / f64::from(k);
        sum += term;
    }
    sum
}

/// One sinusoid of the forcing, a sin(φ + ντ), ready for one system.
#[derive(Debug, Clone, Copy)]
struct Sine {
    amplitude: f64,
    /// e^(iφ)
    phase: Complex64,
    nu: f64,
    /// λ₁ − μ
    apart: Complex64,
    /// 1/(μ − λ₂)
    across: Complex64,
    /// x of the steady motion, 1/((μ − λ₁)(μ − λ₂)); infinite at resonance without damping.
    steady: Complex64,
}

/// Forcing over one segment and the motion at its start.
#[derive(Debug, Clone)]
pub(crate) struct Segment<'a> {
    modes: &'a Modes,
    start: Motion,
    /// Linear part c₀ + c₁τ.
    constant: f64,
    slope: f64,
    sines: Vec<Sine>,
    /// Bounds on |f|, |f′|, |f″|.
    bound: [f64; 3],
}

/// The motion and the forcing at one instant.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sample {
    tau: f64,
    pub(crate) m: Motion,
    f: f64,
    f_slope: f64,
}

impl<'a> Segment<'a> {
    pub(crate) fn new(modes: &'a Modes) -> Self {
        Self { modes, start: Motion::default(), constant: 0.0, slope: 0.0, sines: Vec::new(), bound: [0.0; 3] }
    }
    /// Begins a segment of phase length `span` at `start` with forcing `constant` + `slope` τ.
    pub(crate) fn begin(&mut self, start: Motion, constant: f64, slope: f64, span: f64) {
        (self.start, self.constant, self.slope) = (start, constant, slope);
        self.sines.clear();
        let highest = constant.abs().max((constant + slope * span).abs());
        self.bound = [highest, slope.abs(), 0.0];
    }
    /// Adds a sin(φ + ντ).
    pub(crate) fn add_sine(&mut self, amplitude: f64, phi: f64, nu: f64) {
        let m = self.modes;
        let mu = Complex64::new(0.0, nu);
        let (slow, fast) = if m.kappa == 0.0 {
            (Complex64::new(-m.zeta, m.beta), Complex64::new(-m.zeta, -m.beta))
        } else {
            (Complex64::new(-m.sigma, 0.0), Complex64::new(-m.rho, 0.0))
        };
        let (apart, across) = (slow - mu, (mu - fast).inv());
        self.sines.push(Sine { amplitude, phase: Complex64::cis(phi), nu, apart, across, steady: -across / apart });
        for (bound, factor) in self.bound.iter_mut().zip([1.0, nu, nu * nu]) {
            *bound += amplitude.abs() * factor;
        }
    }
    fn is_free(&self) -> bool {
        self.constant == 0.0 && self.slope == 0.0 && self.sines.is_empty()
    }
    /// The motion after τ.
    pub(crate) fn sample(&self, phase: Phase) -> Sample {
        let (tau, modes) = (phase.hi, self.modes);
        let step = modes.propagator(phase);
        let mut m = step.apply(modes.p, self.start);
        let (mut f, mut f_slope) = (self.constant + self.slope * tau, self.slope);
        if self.constant != 0.0 || self.slope != 0.0 {
            let ramp = modes.ramp(tau, &step);
            m.x += self.constant * ramp.x0 + self.slope * ramp.x1;
            m.w += self.constant * ramp.w0 + self.slope * ramp.w1;
        }
        for sine in &self.sines {
            let turned = Complex64::cis(sine.nu * tau);
            let now = sine.phase * turned;
            f += sine.amplitude * now.im;
            f_slope += sine.amplitude * sine.nu * now.re;
            let from_rest =
                if modes.is_short(tau) { sine.series(modes, tau) } else { sine.closed(modes, tau, turned, &step) };
            m.x += sine.amplitude * from_rest.x;
            m.w += sine.amplitude * from_rest.w;
        }
        Sample { tau, m, f, f_slope }
    }
    /// Value, slope and bend of quantity `k`.
    fn value(&self, k: usize, s: &Sample) -> f64 {
        self.modes.quantity(k, s.m)
    }
    fn slope(&self, k: usize, s: &Sample) -> f64 {
        self.modes.quantity(k + 1, s.m) + self.modes.rows[k][1] * s.f
    }
    fn bend(&self, k: usize, s: &Sample) -> f64 {
        self.modes.quantity(k + 2, s.m) + self.modes.rows[k + 1][1] * s.f + self.modes.rows[k][1] * s.f_slope
    }
    /// The motion that is left of the forcing alone after a long time.
    fn steady(&self, tau: f64) -> Motion {
        let modes = self.modes;
        let x = self.constant + self.slope * (tau - 2.0 * modes.zeta);
        let mut m = Motion { x, w: self.slope + modes.sigma * x };
        for sine in &self.sines {
            let x = sine.phase * Complex64::cis(sine.nu * tau) * sine.steady;
            m.x += sine.amplitude * x.im;
            m.w += sine.amplitude * (x * Complex64::new(modes.sigma, sine.nu)).im;
        }
        m
    }
    /// Bounds on |q″| and |q‴| for a time `h` after `a`.
    fn bounds(&self, k: usize, a: &Sample, h: f64) -> [f64; 2] {
        let (modes, [f0, f1, f2]) = (self.modes, self.bound);
        let r = &modes.rows;
        let row = |j: usize, x: f64, w: f64| r[j][0].abs() * x + r[j][1].abs() * w;
        let energy = |m: Motion| {
            let y = m.w - modes.sigma * m.x;
            (m.x * m.x + y * y).sqrt()
        };
        let tilt = (1.0 + modes.sigma * modes.sigma).sqrt();
        if modes.zeta < STRONG_DAMPING {
            // √(x² + y²) grows by no more than |f|.
            let v = energy(a.m) + h * f0;
            let input = |j: usize| r[j][1].abs();
            return [
                row(k + 2, v, tilt * v) + input(k + 1) * f0 + input(k) * f1,
                row(k + 3, v, tilt * v) + input(k + 2) * f0 + input(k + 1) * f1 + input(k) * f2,
            ];
        }
        // What is not steady only decays.
        let steady = self.steady(a.tau);
        let rest = Motion { x: a.m.x - steady.x, w: a.m.w - steady.w };
        let [x, w] = if modes.kappa == 0.0 {
            [energy(rest), tilt * energy(rest)]
        } else {
            [rest.x.abs() + h * rest.w.abs(), rest.w.abs()]
        };
        let mut bounds = [row(k + 2, x, w), row(k + 3, x, w)];
        for sine in &self.sines {
            let size = match k {
                Modes::DISPLACEMENT => 1.0,
                Modes::VELOCITY => sine.nu,
                _ => (2.0 * modes.zeta * sine.nu).hypot(1.0),
            };
            let size = size * sine.steady.norm() * sine.amplitude.abs() * sine.nu * sine.nu;
            bounds[0] += size;
            bounds[1] += size * sine.nu;
        }
        bounds
    }
    /// The motion at the begin.
    fn begin_sample(&self) -> Sample {
        let mut s = Sample { tau: 0.0, m: self.start, f: self.constant, f_slope: self.slope };
        for sine in &self.sines {
            s.f += sine.amplitude * sine.phase.im;
            s.f_slope += sine.amplitude * sine.nu * sine.phase.re;
        }
        s
    }
    /// The end of a segment of linear forcing whose motion is known.
    pub(crate) fn sample_known(&self, tau: f64, m: Motion) -> Sample {
        Sample { tau, m, f: self.constant + self.slope * tau, f_slope: self.slope }
    }
    /// Takes the extremes of quantity `k` over the segment up to `end` into `range`, both ends included.
    ///
    /// # Method
    ///
    /// Free motion and constant forcing have turning points in closed form; under a ramp the zeros of the bend are known and
    /// bracket them. Otherwise panels are halved until a bound on q″ shows that a panel cannot hold a new extreme, or one on
    /// q‴ that its slope vanishes once or never; the turning point is then a Newton iteration on the exact motion.
    pub(crate) fn extremes(&self, k: usize, end: &Sample, interval: usize, range: &mut Range) {
        let modes = self.modes;
        let span = end.tau;
        if self.is_free() {
            range.note_free(modes, k, self.start, span, interval);
            range.note(interval, span, self.value(k, end));
            return;
        }
        range.note(interval, 0.0, modes.quantity(k, self.start));
        range.note(interval, span, self.value(k, end));
        if self.sines.is_empty() {
            self.linear_extremes(k, end, interval, range);
        } else {
            self.search(k, &self.begin_sample(), end, interval, range);
        }
    }
    /// Linear forcing: the motion swings freely about the static one, x = c₀ + c₁(τ − 2ζ), y = c₁, A/ω = −(c₀ + c₁τ). The
    /// bend of a quantity is free motion, so its zeros are known, and between two of them the slope vanishes once at most.
    fn linear_extremes(&self, k: usize, end: &Sample, interval: usize, range: &mut Range) {
        let (modes, span) = (self.modes, end.tau);
        let bent = self.steady(0.0);
        let swing = Motion { x: self.start.x - bent.x, w: self.start.w - bent.w };
        let about = |tau: f64| match k {
            Modes::DISPLACEMENT => bent.x + self.slope * tau,
            Modes::VELOCITY => self.slope,
            _ => -(self.constant + self.slope * tau),
        };
        let (first, last) = (about(0.0), about(span));
        if self.slope == 0.0 {
            let seen = (range.low.value - first, range.high.value - first);
            modes.free_extremes(k, swing, span, seen, |tau, value| range.note(interval, tau, first + value));
            return;
        }
        let mut a = self.begin_sample();
        if modes.beta * span < PI && modes.zeta * span < 4.0 && self.bend(k, &a) * self.bend(k, end) > 0.0 {
            // Less than half a swing, and the bend keeps its sign. (Of a longer decay it would be rounding.)
            if self.slope(k, &a) * self.slope(k, end) < 0.0 {
                self.turning_point(k, &a, end, interval, range);
            }
            return;
        }
        // Off its turning points the swing reaches N/β.
        let amplitude = modes.amplitude(swing) / modes.beta;
        let mut next = modes.zero(k + 2, swing).map_or(span, |(tau, _)| tau);
        loop {
            if modes.beta > 0.0 {
                let reach = amplitude * (-modes.zeta * a.tau).exp();
                let here = about(a.tau);
                if here.max(last) + reach <= range.high.value && here.min(last) - reach >= range.low.value {
                    return;
                }
            }
            let b = if next < span { self.sample(Phase::product(1.0, next)) } else { *end };
            if self.slope(k, &a) * self.slope(k, &b) < 0.0 {
                self.turning_point(k, &a, &b, interval, range);
            }
            if next >= span {
                return;
            }
            // Beyond critical damping the bend vanishes once.
            next = if modes.beta > 0.0 { next + PI / modes.beta } else { span };
            a = b;
        }
    }
    /// Halves the panel from `a` to `b` until nothing new can be in its parts.
    fn search(&self, k: usize, a: &Sample, b: &Sample, interval: usize, range: &mut Range) {
        let h = b.tau - a.tau;
        let [m2, m3] = self.bounds(k, a, h);
        let (qa, qb) = (self.value(k, a), self.value(k, b));
        let bump = 0.125 * m2 * h * h;
        let scale = range.high.value.max(-range.low.value);
        if (qa.max(qb) + bump <= range.high.value && qa.min(qb) - bump >= range.low.value) || bump <= 1e-16 * scale {
            return;
        }
        let (sa, sb) = (self.slope(k, a), self.slope(k, b));
        let (ba, bb) = (self.bend(k, a), self.bend(k, b));
        if ba * bb > 0.0 && ba.abs().min(bb.abs()) > 0.5 * m3 * h {
            if sa * sb < 0.0 {
                self.turning_point(k, a, b, interval, range);
            }
            return;
        }
        if sa * sb > 0.0 && sa.abs().min(sb.abs()) > 0.125 * m3 * h * h {
            return;
        }
        let middle = a.tau + 0.5 * h;
        if middle > a.tau && middle < b.tau {
            let c = self.sample(Phase::product(1.0, middle));
            range.note(interval, middle, self.value(k, &c));
            self.search(k, a, &c, interval, range);
            self.search(k, &c, b, interval, range);
        }
    }
    /// Newton's iteration, kept between `a` and `b`, where the slope changes sign once.
    fn turning_point(&self, k: usize, a: &Sample, b: &Sample, interval: usize, range: &mut Range) {
        let (mut low, mut high) = (a.tau, b.tau);
        let (sa, sb) = (self.slope(k, a), self.slope(k, b));
        let mut tau = low + (high - low) * sa / (sa - sb);
        for _ in 0..60 {
            let s = self.sample(Phase::product(1.0, tau));
            let (value, slope, bend) = (self.value(k, &s), self.slope(k, &s), self.bend(k, &s));
            range.note(interval, tau, value);
            // What another step could still add.
            if slope * slope <= 1e-17 * (bend * value).abs() {
                return;
            }
            if (slope > 0.0) == (sa > 0.0) {
                low = tau;
            } else {
                high = tau;
            }
            tau -= slope / bend;
            if !(tau > low && tau < high) {
                tau = 0.5 * (low + high);
            }
        }
    }
}

impl Sine {
    /// Response from rest to sin(φ + ντ) by its power series.
    fn series(&self, modes: &Modes, tau: f64) -> Motion {
        let (damp, square, swing) = (2.0 * modes.zeta * tau, tau * tau, self.nu * tau);
        // Terms (ντ)^k/k! of the forcing, with the derivatives of the sine in turn.
        let wheel = [self.phase.im, self.phase.re, -self.phase.im, -self.phase.re];
        let mut power = 1.0;
        let (mut older, mut u) = (0.0, 0.0);
        let (mut x, mut y) = (0.0, 0.0);
        let mut k = 0.0;
        for (i, [_, reciprocal]) in RECIPROCAL.iter().take(TERMS).enumerate() {
            let next = (power * wheel[i % 4] - damp * (k + 1.0) * u - square * older) * reciprocal;
            (older, u) = (u, next);
            x += u;
            y += (k + 2.0) * u;
            k += 1.0;
            power *= swing * RECIPROCAL[i + 1][0];
            if power + (k * k) * (u.abs() + older.abs()) <= 1e-17 * y.abs() {
                break;
            }
        }
        let (x, y) = (x * square, y * tau);
        Motion { x, w: y + modes.sigma * x }
    }
    /// The same by divided differences; `turned` is e^(iντ).
    fn closed(&self, modes: &Modes, tau: f64, turned: Complex64, step: &Propagator) -> Motion {
        let z = self.apart * tau;
        let first = if z.norm_sqr() < 0.25 {
            let growth = if z.re == 0.0 && z.im == 0.0 { Complex64::new(1.0, 0.0) } else { exp_m1(z) / z };
            turned * growth * tau
        } else {
            let slow = Complex64::new(step.c, modes.beta * step.s);
            (slow - turned) / self.apart
        };
        let x = (first - step.s) * self.across;
        let w = if modes.kappa == 0.0 {
            first - Complex64::new(-modes.beta * x.im, modes.beta * x.re)
        } else {
            (turned - step.k) * self.across
        };
        Motion { x: (self.phase * x).im, w: (self.phase * w).im }
    }
}

/// e^z − 1 without cancellation at small z.
fn exp_m1(z: Complex64) -> Complex64 {
    let (sin, half) = (z.im.sin(), (0.5 * z.im).sin());
    Complex64::new(z.re.exp_m1() * z.im.cos() - 2.0 * half * half, z.re.exp() * sin)
}
