//! Motion while the base accelerates: linear and sinusoidal histories, in closed form, and their largest values.
//!
//! The response from rest to e^(μτ) is the divided difference of the exponential over the two modes λ₁, λ₂ and μ. It is
//! formed as
//!
//! ```text
//! e[λ₁, λ₂, μ] = (e[λ₁, μ] − e[λ₁, λ₂]) / (μ − λ₂),    e[λ₁, λ₂] = sin(βτ) e^(−ζτ)/β
//! ```
//!
//! where μ − λ₂ is never small and e[λ₁, μ] is e^(μτ) τ (e^z − 1)/z: resonance (λ₁ = μ) and critical damping (λ₁ = λ₂)
//! are ordinary points. For short spans the power series of the motion is summed instead.

mod crossing;

use crate::eight::{Many, WIDTH, decay};
use crate::peaks::Range;
use crate::side_by_side::Step;
use crate::suspension::{Modes, Motion, Phase, Propagator};
pub(crate) use crossing::Exit;
use num_complex::Complex64;
use std::cell::Cell;
use std::f64::consts::PI;

/// The most terms of a series.
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

/// The largest (1 + 2ζ)τ of the series; beyond it, the closed forms lose no more than two bits to their differences of
/// terms of size τ.
const SERIES_REACH: f64 = 0.5;

/// Phase of a sinusoid beyond which its power series would lose digits: a whole swing, of a haversine, loses nine bits.
const SERIES_SWING: f64 = 7.0;

/// Phase βτ beyond which the turning points under a ramp are not visited one by one.
const MANY_SWINGS: f64 = 128.0 * PI;

/// The damping ratio from which on the steady motion is bounded at every frequency, and bounds on derivatives start
/// from it.
const STRONG_DAMPING: f64 = 0.5;

/// The most panels of one segment that are halved; then the largest value so far counts. Bounds that lead so far know
/// nothing of the motion any more: this was seen only in ramps of 10⁸ swings and more, while ordinary pulses take tens
/// of panels.
const PANELS: u32 = 100_000;

/// Share of the forcing's terms below which their sum is bounded by itself at every damping.
const CANCELLED: f64 = 0.01;
/// Share of the static motion below which the whole motion is not taken as the difference of two.
const CANCELS: f64 = 0.125;

/// Response from rest to f = 1 (`x0`, `w0`) and to f = τ (`x1`, `w1`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Ramp {
    pub(crate) x0: f64,
    pub(crate) w0: f64,
    pub(crate) x1: f64,
    pub(crate) w1: f64,
}

impl Modes {
    pub(crate) fn is_short(&self, tau: f64) -> bool {
        (1.0 + 2.0 * self.zeta) * tau <= SERIES_REACH
    }
    /// Returns the free motion over τ, and the responses from rest to a constant and to a ramp.
    pub(crate) fn driven(&self, phase: Phase) -> (Propagator, Ramp) {
        let tau = phase.hi;
        if self.is_short(tau) {
            return self.short(tau);
        }
        let step = self.propagator(phase);
        (step, self.long_ramp(tau, &step))
    }
    /// Returns the free motion over a short τ, and the responses from rest to a constant and to a ramp, from one power
    /// series, which costs less than the exponential and the sine.
    fn short(&self, tau: f64) -> (Propagator, Ramp) {
        // The ramp response is Σ u_k τ^k from u₃ = 1/6; its derivatives are the step and the impulse response.
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
        // The impulse response h is s, and by the equation of motion h′ = 1 − 2ζh − x₀, where 2ζ = ρ + σ.
        let step = Propagator { c: 1.0 - x0 - self.sigma * h, s: h, k: 1.0 - x0 - self.rho * h };
        (step, Ramp { x0, w0: h + self.sigma * x0, x1, w1: x0 + self.sigma * x1 })
    }
    /// Returns the responses from rest to a constant and to a ramp after a τ that is not short; `step` is the free
    /// motion over the same τ.
    fn long_ramp(&self, tau: f64, step: &Propagator) -> Ramp {
        if self.kappa == 0.0 {
            let x0 = 1.0 - step.c - self.zeta * step.s;
            let x1 = tau - 2.0 * self.zeta * x0 - step.s;
            return Ramp { x0, w0: step.s + self.zeta * x0, x1, w1: x0 + self.zeta * x1 };
        }
        // Two decays in a row, each integrated on its own.
        let slow = self.sigma * tau;
        let rise = -libm::expm1(-slow) / self.sigma;
        let rise_of_ramp = if slow < 0.5 { tau * tau * psi2(slow) } else { (tau - rise) / self.sigma };
        let w0 = -libm::expm1(-self.rho * tau) / self.rho;
        let x0 = (rise - step.s) / self.rho;
        Ramp { x0, w0, x1: (rise_of_ramp - x0) / self.rho, w1: (tau - w0) / self.rho }
    }
}

/// Responses from rest to f = 1 and f = τ for eight phases, some of them long; `step` is the free motion over them. A
/// short phase loses digits.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ramps {
    pub(crate) x0: Many,
    pub(crate) w0: Many,
    pub(crate) x1: Many,
    pub(crate) w1: Many,
}

impl Ramps {
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    pub(crate) fn long(modes: &Modes, tau: &Many, step: &Step) -> Self {
        let zero = [0.0; WIDTH];
        let mut ramps = Self { x0: zero, w0: zero, x1: zero, w1: zero };
        if modes.kappa == 0.0 {
            for (l, tau) in tau.iter().enumerate() {
                let x0 = 1.0 - step.c[l] - modes.zeta * step.s[l];
                let x1 = tau - 2.0 * modes.zeta * x0 - step.s[l];
                (ramps.x0[l], ramps.x1[l]) = (x0, x1);
                (ramps.w0[l], ramps.w1[l]) = (step.s[l] + modes.zeta * x0, x0 + modes.zeta * x1);
            }
            return ramps;
        }
        let (mut slow, mut fast) = (zero, zero);
        for l in 0..WIDTH {
            (slow[l], fast[l]) = (modes.sigma * tau[l], modes.rho * tau[l]);
        }
        let ((_, slow_less), (_, fast_less)) = (decay(slow, zero), decay(fast, zero));
        for l in 0..WIDTH {
            let rise = -slow_less[l] / modes.sigma;
            let of_ramp = if slow[l] < 0.5 { tau[l] * tau[l] * psi2(slow[l]) } else { (tau[l] - rise) / modes.sigma };
            let (x0, w0) = ((rise - step.s[l]) / modes.rho, -fast_less[l] / modes.rho);
            (ramps.x0[l], ramps.w0[l]) = (x0, w0);
            (ramps.x1[l], ramps.w1[l]) = ((of_ramp - x0) / modes.rho, (tau[l] - w0) / modes.rho);
        }
        ramps
    }
}

/// Returns (e^(−z) − 1 + z)/z² = 1/2 − z/6 + z²/24 − … for 0 ≤ z < ½.
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
    /// Its absolute value.
    size: f64,
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
    /// Panels that may still be halved.
    panels: Cell<u32>,
    /// The sinusoid added last and the motion over the last segment of sinusoids: pulses of a train are often of one
    /// length.
    last_sine: Option<Sine>,
    last_end: Option<(Phase, bool, (Propagator, Ramp))>,
}

/// The motion and the forcing at one instant.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sample {
    pub(crate) tau: f64,
    pub(crate) m: Motion,
    /// Steady motion under the forcing alone; infinite or not a number at resonance without damping.
    steady: Motion,
    f: f64,
    f_slope: f64,
}

impl<'a> Segment<'a> {
    pub(crate) fn new(modes: &'a Modes) -> Self {
        Self {
            modes,
            start: Motion::default(),
            constant: 0.0,
            slope: 0.0,
            sines: Vec::new(),
            bound: [0.0; 3],
            panels: Cell::new(PANELS),
            last_sine: None,
            last_end: None,
        }
    }
    /// Returns the system that moves.
    pub(crate) fn modes(&self) -> &'a Modes {
        self.modes
    }
    /// Begins a segment of phase length `span` at `start` with forcing `constant` + `slope` τ.
    pub(crate) fn begin(&mut self, start: Motion, constant: f64, slope: f64, span: f64) {
        (self.start, self.constant, self.slope) = (start, constant, slope);
        self.sines.clear();
        self.panels.set(PANELS);
        let highest = constant.abs().max((constant + slope * span).abs());
        self.bound = [highest, slope.abs(), 0.0];
    }
    /// Begins a segment of `length` in time at `start`, where the base's acceleration goes from `from` to `to` in a
    /// line, and returns its phase length.
    pub(crate) fn begin_line(&mut self, start: Motion, omega: f64, length: f64, from: f64, to: f64) -> Phase {
        let span = Phase::product(omega, length);
        self.begin(start, -from / omega, -(to - from) / (omega * span.hi), span.hi);
        span
    }
    /// Adds a sin(φ + ντ), with e^(iφ) given.
    pub(crate) fn add_sine(&mut self, amplitude: f64, phase: Complex64, nu: f64) {
        let sine = match self.last_sine {
            Some(last) if last.nu.to_bits() == nu.to_bits() => Sine { amplitude, phase, ..last },
            _ => Sine::new(self.modes, amplitude, phase, nu),
        };
        self.last_sine = Some(sine);
        self.sines.push(sine);
        for (bound, factor) in self.bound.iter_mut().zip([1.0, nu, nu * nu]) {
            *bound += amplitude.abs() * factor;
        }
    }
    fn is_free(&self) -> bool {
        self.constant == 0.0 && self.slope == 0.0 && self.sines.is_empty()
    }
    /// Returns the motion after τ.
    pub(crate) fn sample(&self, phase: Phase) -> Sample {
        let tau = phase.hi;
        self.sample_turned(tau, &self.driven(phase), |sine, _| Complex64::cis(sine.nu * tau))
    }
    /// Returns the motion at the end, with e^(iντ) of each sinusoid given.
    pub(crate) fn sample_end(&mut self, phase: Phase, turned: impl Fn(usize) -> Complex64) -> Sample {
        let driven = match self.last_end {
            Some((last, pushed, driven)) if last == phase && (pushed || !self.is_pushed()) => driven,
            _ => self.driven(phase),
        };
        self.last_end = Some((phase, self.is_pushed(), driven));
        self.sample_turned(phase.hi, &driven, |_, i| turned(i))
    }
    fn is_pushed(&self) -> bool {
        self.constant != 0.0 || self.slope != 0.0
    }
    /// Returns the free motion and, where there is a linear part, the response to it.
    #[inline]
    fn driven(&self, phase: Phase) -> (Propagator, Ramp) {
        if self.is_pushed() {
            return self.modes.driven(phase);
        }
        (self.modes.propagator(phase), Ramp { x0: 0.0, w0: 0.0, x1: 0.0, w1: 0.0 })
    }
    #[inline]
    fn sample_turned(
        &self,
        tau: f64,
        (step, ramp): &(Propagator, Ramp),
        turned: impl Fn(&Sine, usize) -> Complex64,
    ) -> Sample {
        let modes = self.modes;
        let mut s = self.linear_sample(tau, step.apply(modes.p, self.start));
        if self.is_pushed() {
            s.m.x += self.constant * ramp.x0 + self.slope * ramp.x1;
            s.m.w += self.constant * ramp.w0 + self.slope * ramp.w1;
        }
        let short = modes.is_short(tau);
        for (i, sine) in self.sines.iter().enumerate() {
            let turned = turned(sine, i);
            let now = sine.phase * turned;
            s.add(sine, now, modes);
            let from_rest = if short && sine.nu * tau <= SERIES_SWING {
                sine.series(modes, tau)
            } else {
                sine.closed(modes, tau, turned, step)
            };
            s.m.x += sine.amplitude * from_rest.x;
            s.m.w += sine.amplitude * from_rest.w;
        }
        s
    }
    /// Returns the sample of a motion, with the linear part of the forcing.
    fn linear_sample(&self, tau: f64, m: Motion) -> Sample {
        let f = self.constant + self.slope * tau;
        let x = f - 2.0 * self.modes.zeta * self.slope;
        let steady = Motion { x, w: self.slope + self.modes.sigma * x };
        Sample { tau, m, steady, f, f_slope: self.slope }
    }
    /// Returns the value, slope and bend of quantity `k`.
    fn value(&self, k: usize, s: &Sample) -> f64 {
        self.modes.quantity(k, s.m)
    }
    fn slope(&self, k: usize, s: &Sample) -> f64 {
        self.modes.quantity(k + 1, s.m) + self.modes.rows[k][1] * s.f
    }
    fn bend(&self, k: usize, s: &Sample) -> f64 {
        self.modes.quantity(k + 2, s.m) + self.modes.rows[k + 1][1] * s.f + self.modes.rows[k][1] * s.f_slope
    }
    /// Returns bounds on |f|, |f′|, |f″| for a time `h` after `a`: where terms of the forcing cancel, as in the foot of
    /// a haversine, far below those of the whole segment.
    fn forcing_bounds(&self, a: &Sample, h: f64) -> [f64; 3] {
        let [f0, f1, f2] = self.bound;
        let slope = a.f_slope.abs();
        [f0.min(a.f.abs() + h * (slope + 0.5 * h * f2)), f1.min(slope + h * f2), f2]
    }
    /// Returns bounds on |q″| and |q‴| for a time `h` after `a` under forcing within these bounds: √(x² + y²) grows by
    /// no more than |f|.
    fn energy_bounds(&self, k: usize, a: &Sample, h: f64, [f0, f1, f2]: [f64; 3]) -> [f64; 2] {
        let modes = self.modes;
        let input = |j: usize| modes.rows[j][1].abs();
        let v = modes.energy(a.m) + h * f0;
        let row = |j: usize| (modes.rows[j][0].abs() + modes.rows[j][1].abs() * modes.tilt) * v;
        [
            row(k + 2) + input(k + 1) * f0 + input(k) * f1,
            row(k + 3) + input(k + 2) * f0 + input(k + 1) * f1 + input(k) * f2,
        ]
    }
    /// Returns the bounds on |q″| and |q‴| from `steady`, those of the steady motion, and `rest`, the free motion about
    /// it, which reaches `most`: that only swings and decays, and below critical damping its derivatives all have one
    /// amplitude. (At resonance without damping there is no steady motion.)
    fn steady_bounds_with(&self, k: usize, steady: [f64; 2], rest: Motion, most: f64, h: f64) -> [f64; 2] {
        let modes = self.modes;
        if modes.zeta < STRONG_DAMPING {
            return [most + steady[0], most + steady[1]];
        }
        let (x, w) = if modes.kappa == 0.0 {
            (modes.energy(rest), modes.tilt * modes.energy(rest))
        } else {
            (rest.x.abs() + h * rest.w.abs(), rest.w.abs())
        };
        let most = if modes.beta > 0.0 { most } else { f64::INFINITY };
        let row = |j: usize| (modes.rows[j][0].abs() * x + modes.rows[j][1].abs() * w).min(most);
        [row(k + 2) + steady[0], row(k + 3) + steady[1]]
    }
    /// Returns bounds on q″ and q‴ of the steady motion.
    fn steady_bounds(&self, k: usize) -> [f64; 2] {
        let mut bounds = [0.0; 2];
        for sine in &self.sines {
            let size = match k {
                Modes::DISPLACEMENT => 1.0,
                Modes::VELOCITY => sine.nu,
                _ => 1.0 + 2.0 * self.modes.zeta * sine.nu,
            };
            let size = size * sine.size * sine.amplitude.abs() * sine.nu * sine.nu;
            bounds[0] += size;
            bounds[1] += size * sine.nu;
        }
        bounds
    }
    /// Returns the sample at the begin.
    fn begin_sample(&self) -> Sample {
        let mut s = self.linear_sample(0.0, self.start);
        for sine in &self.sines {
            s.add(sine, sine.phase, self.modes);
        }
        s
    }
    /// Returns the sample at the end of a segment of linear forcing whose motion is known.
    pub(crate) fn sample_known(&self, tau: f64, m: Motion) -> Sample {
        self.linear_sample(tau, m)
    }
    /// Notes the extremes of quantity `k` over the segment up to `end` in `range`, both ends included.
    ///
    /// # Method
    ///
    /// Free motion and constant forcing have turning points in closed form; under a ramp the zeros of the bend are
    /// known and bracket them. Otherwise panels are halved until a bound on q″ shows that a panel cannot hold a new
    /// extreme, or one on q‴ that its slope vanishes once or never; the turning point is then a Newton iteration on the
    /// exact motion.
    pub(crate) fn extremes(&self, k: usize, end: &Sample, interval: usize, range: &mut Range) {
        let modes = self.modes;
        let span = end.tau;
        // √(x² + y²) grows by no more than |f|.
        let row = modes.rows[k][0].abs() + modes.rows[k][1].abs() * modes.tilt;
        if row * (modes.energy(self.start) + span * self.bound[0]) <= range.high.value.min(-range.low.value) {
            return;
        }
        let begin = self.begin_sample();
        let bent = self.sines.is_empty() && self.keeps_its_bend(k, &begin, end);
        if bent && !self.turns_beyond(k, &begin, end, range) {
            range.note(interval, 0.0, modes.quantity(k, self.start));
            range.note(interval, span, self.value(k, end));
            return;
        }
        if self.is_free() {
            range.note_free(modes, k, self.start, span, interval);
            range.note(interval, span, self.value(k, end));
            return;
        }
        range.note(interval, 0.0, modes.quantity(k, self.start));
        range.note(interval, span, self.value(k, end));
        if !self.sines.is_empty() {
            self.search(k, self.steady_bounds(k), &begin, end, interval, range);
        } else if bent && self.slope != 0.0 {
            self.turning_point(k, &begin, end, interval, range);
        } else {
            self.linear_extremes(k, begin, end, interval, range);
        }
    }
    /// Returns whether the bend of quantity `k`, here free motion, surely keeps its sign up to `end`: less than half a
    /// swing, at whose ends it has one sign. (For a longer decay that sign would be rounding.)
    fn keeps_its_bend(&self, k: usize, begin: &Sample, end: &Sample) -> bool {
        let (modes, span) = (self.modes, end.tau);
        modes.beta * span < PI && modes.zeta * span < 4.0 && self.bend(k, begin) * self.bend(k, end) > 0.0
    }
    /// Notes the extremes under linear forcing: the motion swings freely about the static one, x = c₀ + c₁(τ − 2ζ), y =
    /// c₁, A/ω = −(c₀ + c₁τ). The bend of a quantity is free motion, so its zeros are known, and between two of them
    /// the slope vanishes once at most.
    fn linear_extremes(&self, k: usize, mut a: Sample, end: &Sample, interval: usize, range: &mut Range) {
        let (modes, span) = (self.modes, end.tau);
        let (bent, swing) = (a.steady, a.swing());
        let about = |tau: f64| match k {
            Modes::DISPLACEMENT => bent.x + self.slope * tau,
            Modes::VELOCITY => self.slope,
            _ => -(self.constant + self.slope * tau),
        };
        let (first, last) = (about(0.0), about(span));
        if self.slope == 0.0 {
            // For a soft part the static motion is far above the true one, which is then the difference of two large
            // motions: the time of its turning point is known, but its value there only from the begin.
            let slack = 8.0 * f64::EPSILON * first.abs();
            let seen = (range.low.value - first + slack, range.high.value - first - slack);
            modes.free_extremes(k, swing, span, seen, |tau, value| {
                let sum = first + value;
                let cancels = sum.abs() < CANCELS * first.abs();
                let value = if cancels { self.value(k, &self.sample(Phase::product(1.0, tau))) } else { sum };
                range.note(interval, tau, value);
            });
            return;
        }
        if modes.beta * span > MANY_SWINGS {
            self.search(k, self.steady_bounds(k), &a, end, interval, range);
            return;
        }
        // Off its turning points the swing reaches N/β.
        let amplitude = modes.amplitude(swing) / modes.beta;
        let mut next = modes.zero(k + 2, swing).map_or(span, |(tau, _)| tau);
        loop {
            if modes.beta > 0.0 {
                let reach = amplitude * libm::exp(-modes.zeta * a.tau);
                let here = about(a.tau);
                if here.max(last) + reach <= range.high.value && here.min(last) - reach >= range.low.value {
                    return;
                }
            }
            // A zero beyond the range of floats does not count.
            let goes_on = next < span;
            let b = if goes_on { self.sample(Phase::product(1.0, next)) } else { *end };
            if self.turns_beyond(k, &a, &b, range) {
                self.turning_point(k, &a, &b, interval, range);
            }
            if !goes_on {
                return;
            }
            // Beyond critical damping the bend vanishes once.
            next = if modes.beta > 0.0 { next + PI / modes.beta } else { span };
            a = b;
        }
    }
    /// Returns the free motion about the steady one at `a`. Beyond critical damping the fast decay soon takes it below
    /// the rounding of the difference, which would enter the bounds on derivatives in powers of ρ: there it is the free
    /// motion from the begin.
    fn rest(&self, a: &Sample) -> Motion {
        let modes = self.modes;
        if modes.kappa == 0.0 {
            return a.swing();
        }
        modes.propagator(Phase::product(1.0, a.tau)).apply(modes.p, self.begin_sample().swing())
    }
    /// Returns whether quantity `k`, whose bend keeps its sign from `a` to `b`, turns in between, and may do so outside
    /// of `range`: it turns no further out than the crossing of the tangents at both ends.
    fn turns_beyond(&self, k: usize, a: &Sample, b: &Sample, range: &Range) -> bool {
        let (sa, sb) = (self.slope(k, a), self.slope(k, b));
        if sa * sb >= 0.0 {
            return false;
        }
        let (qa, qb) = (self.value(k, a), self.value(k, b));
        let crossing = qa + sa * ((qb - qa - sb * (b.tau - a.tau)) / (sa - sb));
        if sa > 0.0 { crossing > range.high.value } else { crossing < range.low.value }
    }
    /// Halves the panel from `a` to `b` until its parts can hold nothing new, the likelier part first.
    ///
    /// Over many swings the motion stays within its amplitude of the steady one; `steady` bounds the bend of that, and
    /// the change of the bend.
    fn search(&self, k: usize, steady: [f64; 2], a: &Sample, b: &Sample, interval: usize, range: &mut Range) {
        let h = b.tau - a.tau;
        // Rounding of the compared values decides nothing.
        let scale = range.high.value.max(-range.low.value);
        let slack = 8.0 * f64::EPSILON * self.modes.size(k, a.m).max(self.modes.size(k, b.m)).max(scale);
        let (high, low) = (range.high.value + slack, range.low.value - slack);
        let (qa, qb) = (self.value(k, a), self.value(k, b));
        let holds_nothing = |m2: f64| {
            let bump = 0.125 * m2 * h * h;
            (qa.max(qb) + bump <= high && qa.min(qb) - bump >= low) || bump <= 1e-16 * high.max(-low)
        };
        let mut bounds = [f64::INFINITY; 2];
        let forcing = self.forcing_bounds(a, h);
        if self.modes.zeta < STRONG_DAMPING || forcing[0] < CANCELLED * self.bound[0] {
            bounds = self.energy_bounds(k, a, h, forcing);
            if holds_nothing(bounds[0]) {
                return;
            }
        }
        let (steady_a, steady_b) = (self.modes.quantity(k, a.steady), self.modes.quantity(k, b.steady));
        let rest = self.rest(a);
        let most = self.modes.reach(k, rest);
        let around = 0.125 * steady[0] * h * h + most;
        let above = steady_a.max(steady_b) + around - high;
        let below = low - (steady_a.min(steady_b) - around);
        if above <= 0.0 && below <= 0.0 {
            return;
        }
        let other = self.steady_bounds_with(k, steady, rest, most, h);
        let [m2, m3] = [bounds[0].min(other[0]), bounds[1].min(other[1])];
        if other[0] < bounds[0] && holds_nothing(m2) {
            return;
        }
        let (sa, sb) = (self.slope(k, a), self.slope(k, b));
        let (ba, bb) = (self.bend(k, a), self.bend(k, b));
        if ba * bb > 0.0 && ba.abs().min(bb.abs()) > 0.5 * m3 * h {
            if self.turns_beyond(k, a, b, range) {
                self.turning_point(k, a, b, interval, range);
            }
            return;
        }
        if sa * sb > 0.0 && sa.abs().min(sb.abs()) > 0.125 * m3 * h * h {
            return;
        }
        let middle = a.tau + 0.5 * h;
        let panels = self.panels.get();
        if middle > a.tau && middle < b.tau && panels > 0 {
            self.panels.set(panels - 1);
            let c = self.sample(Phase::product(1.0, middle));
            range.note(interval, middle, self.value(k, &c));
            let mut part = |a: &Sample, b: &Sample| self.search(k, steady, a, b, interval, range);
            let first = if above >= below { steady_a > steady_b } else { steady_a < steady_b };
            if first {
                part(a, &c);
                part(&c, b);
            } else {
                part(&c, b);
                part(a, &c);
            }
        }
    }
    /// Finds the turning point by Newton's iteration, kept between `a` and `b`, where the slope changes sign once.
    fn turning_point(&self, k: usize, a: &Sample, b: &Sample, interval: usize, range: &mut Range) {
        let (mut low, mut high) = (a.tau, b.tau);
        let (sa, sb) = (self.slope(k, a), self.slope(k, b));
        let mut tau = low + (high - low) * first_guess([sa, sb], [self.bend(k, a), self.bend(k, b)], high - low);
        for _ in 0..60 {
            let s = self.sample(Phase::product(1.0, tau));
            let (value, slope, bend) = (self.value(k, &s), self.slope(k, &s), self.bend(k, &s));
            let step = -slope / bend;
            // At the end of the step the value is known to its third order.
            let next = tau + step;
            let near =
                next > low && next < high && (step * step * step * self.jerk(k, &s)).abs() <= 1e-17 * value.abs();
            if near {
                range.note(interval, next, value + 0.5 * step * slope);
                return;
            }
            range.note(interval, tau, value);
            // This bounds the gain of another step.
            if slope * slope <= 1e-17 * (bend * value).abs() {
                return;
            }
            if (slope > 0.0) == (sa > 0.0) {
                low = tau;
            } else {
                high = tau;
            }
            tau = next;
            if !(tau > low && tau < high) {
                tau = 0.5 * (low + high);
            }
        }
    }
    /// Returns a bound on |q‴|.
    fn jerk(&self, k: usize, s: &Sample) -> f64 {
        let modes = self.modes;
        let input = |j: usize| modes.rows[j][1].abs();
        modes.size(k + 3, s.m) + input(k + 2) * s.f.abs() + input(k + 1) * s.f_slope.abs() + input(k) * self.bound[2]
    }
}

/// Returns the zero of the slope, as a share of the way from one end to the other, `h` apart: a step from the chord on
/// the cubic of both slopes and bends.
fn first_guess([sa, sb]: [f64; 2], [ba, bb]: [f64; 2], h: f64) -> f64 {
    let chord = sa / (sa - sb);
    // The cubic is the chord and t (1 − t) (c (1 − t) − d t).
    let (c, d) = (h * ba - (sb - sa), h * bb - (sb - sa));
    let (t, r) = (chord, 1.0 - chord);
    let off = t * r * (c * r - d * t);
    let rate = (sb - sa) + (r - t) * (c * r - d * t) - t * r * (c + d);
    let guess = t - off / rate;
    if guess > 0.0 && guess < 1.0 { guess } else { chord }
}

impl Sample {
    /// Adds a sinusoid whose phase is e^(iφ) = `now`.
    #[inline]
    fn add(&mut self, sine: &Sine, now: Complex64, modes: &Modes) {
        self.f += sine.amplitude * now.im;
        self.f_slope += sine.amplitude * sine.nu * now.re;
        let x = now * sine.steady;
        self.steady.x += sine.amplitude * x.im;
        self.steady.w += sine.amplitude * (modes.sigma * x.im + sine.nu * x.re);
    }
    /// Returns the free motion about the steady one, which only swings and decays.
    fn swing(&self) -> Motion {
        Motion { x: self.m.x - self.steady.x, w: self.m.w - self.steady.w }
    }
}

impl Sine {
    fn new(modes: &Modes, amplitude: f64, phase: Complex64, nu: f64) -> Self {
        let mu = Complex64::new(0.0, nu);
        let (slow, fast) = if modes.kappa == 0.0 {
            (Complex64::new(-modes.zeta, modes.beta), Complex64::new(-modes.zeta, -modes.beta))
        } else {
            (Complex64::new(-modes.sigma, 0.0), Complex64::new(-modes.rho, 0.0))
        };
        let (apart, across) = (slow - mu, (mu - fast).inv());
        let steady = -across / apart;
        Self { amplitude, phase, nu, apart, across, steady, size: steady.norm_sqr().sqrt() }
    }
    /// Returns the response from rest to sin(φ + ντ) by its power series.
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
    /// Returns the same response by divided differences; `turned` is e^(iντ).
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

/// Returns e^z − 1 without cancellation at small z.
fn exp_m1(z: Complex64) -> Complex64 {
    let (sin, half) = (libm::sin(z.im), libm::sin(0.5 * z.im));
    Complex64::new(libm::expm1(z.re) * libm::cos(z.im) - 2.0 * half * half, libm::exp(z.re) * sin)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DampingRatio;

    /// Bounds beyond critical damping follow the decay, not its rounding error: they settle a half-sine in some tens of
    /// panels at any damping.
    #[test]
    fn strong_damping_needs_no_more_panels() {
        for zeta in [1.5, 50.0, 1e4, 1e6, 1e9, 1e12] {
            let modes = Modes::new(DampingRatio::new(zeta).expect("damping"));
            for phase in [0.1, 3.0, 40.0, 0.1 * zeta, 10.0 * zeta] {
                let mut segment = Segment::new(&modes);
                segment.begin(Motion::default(), 0.0, 0.0, phase);
                segment.add_sine(1.0, Complex64::new(1.0, 0.0), PI / phase);
                let end = segment.sample(Phase::product(1.0, phase));
                for k in 0..3 {
                    segment.extremes(k, &end, 0, &mut Range::default());
                }
                let panels = PANELS - segment.panels.get();
                assert!(panels < 1000, "{panels} panels at damping {zeta:e}, phase {phase:e}");
            }
        }
    }
}
