//! Neighboring strikes carried on together, from one anchor in the closed form to the next.

use super::{ANGLE, Decay, Drive, Kind, angle, compensated, to_f64};
use crate::Start;
use crate::dd::{ldexp, power_of_two};
use crate::symmetric::Symmetric;
use libm::{exp, expm1, sincos};

/// Neighboring strikes that are carried on together.
const WIDTH: usize = 4;
/// Strikes from one anchor in the closed form to the next: 64 steps of the four, which add some 64 roundings.
const BLOCK: u64 = 256;

/// Four neighboring strikes, ready to be carried on to the next four.
///
/// For a wave, x ∝ sin δ_n and y ∝ sin nθ turn by 4θ a step in the form `d ← d − κx, x ← x + d` with κ = 4 sin² 2θ
/// (Reinsch), whose errors stay relative where δ_n or nθ are small; |a_n| = gx, time = cy/x. For an endless decay,
/// x = ρⁿ and y = (1 − ρⁿ)/(1 − ρ) with ρ = λ₋/λ₊ add up positive terms; |a_n| = g(αλ₊x + σy), time = h0 y over that.
#[derive(Debug, Clone, Copy)]
struct Four {
    x: [f64; WIDTH],
    dx: [f64; WIDTH],
    y: [f64; WIDTH],
    dy: [f64; WIDTH],
    g: [f64; WIDTH],
    kappa: f64,
    /// Factor of g in a step.
    decay: f64,
    /// c, or h0.
    time: f64,
}

/// Four strikes that are anchored anew in the closed form, for trains of any length.
#[derive(Debug, Clone)]
pub(crate) struct Fours {
    /// Index n of the first of the four.
    n: u64,
    wave: bool,
    four: Four,
    /// True if neighboring times may differ by less than their errors.
    pub(crate) crowded: bool,
    /// Factors of x and y of a decay before they are added up: αλ₊, σ.
    sum: [f64; 2],
    /// θ of a wave.
    theta: f64,
    /// Turn by jθ of a wave: 1 − cos and sin. Turn of a decay: (1 − ρʲ)/(1 − ρ) and ρʲ.
    turns: [[f64; 2]; WIDTH],
}

impl Four {
    /// Computes strikes of a wave. The state is held in variables, so that it need not go through memory.
    fn turn<const N: usize>(&mut self, approach: &mut [f64; N], times: &mut [f64; N]) {
        let Self { mut x, mut dx, mut y, mut dy, mut g, kappa, decay, time } = *self;
        for (approach, times) in approach.as_chunks_mut::<WIDTH>().0.iter_mut().zip(times.as_chunks_mut::<WIDTH>().0) {
            for i in 0..WIDTH {
                approach[i] = -g[i] * x[i];
                times[i] = time * (y[i] / x[i]);
                g[i] *= decay;
                x[i] += dx[i];
                y[i] += dy[i];
                dx[i] -= kappa * x[i];
                dy[i] -= kappa * y[i];
            }
        }
        *self = Self { x, dx, y, dy, g, kappa, decay, time };
    }

    /// Computes strikes of a decay.
    fn grow<const N: usize>(&mut self, sum: [f64; 2], approach: &mut [f64; N], times: &mut [f64; N]) {
        let Self { mut x, mut y, dy, mut g, kappa, decay, time, .. } = *self;
        for (approach, times) in approach.as_chunks_mut::<WIDTH>().0.iter_mut().zip(times.as_chunks_mut::<WIDTH>().0) {
            for i in 0..WIDTH {
                let sum = sum[0] * x[i] + sum[1] * y[i];
                approach[i] = -g[i] * sum;
                times[i] = time * (y[i] / sum);
                g[i] *= decay;
                y[i] += dy[i] * x[i];
                // x is set to 0 before it is subnormal, and slow; it is negligible beside y then.
                x[i] = if x[i] > 1e-290 { x[i] * kappa } else { 0.0 };
            }
        }
        (self.x, self.y, self.g) = (x, y, g);
    }
}

/// The wave of a train of some 30 to 400 impacts. No angle is needed: all follows from the discriminant and the first
/// two strikes.
///
/// With x_n = |a_n|/(α e^{n/2}) and κ_m = 2 − 2 cos mθ, all of them sums without cancellation that matters to an
/// amplitude,
/// ```text
/// κ_1 = D/(2e + T√e),  κ_2m = κ_m(4 − κ_m),  Δ_m x_n = x_{n+m} − x_n,  Δ_2m x_n = (2 − κ_m) Δ_m x_n − κ_m x_n.
/// ```
/// The Casoratian of this wave and that of the heights is constant, so that times are sums of positive terms: t_{n+1} −
/// t_n = h0/(α√e x_n x_{n+1}).
#[derive(Debug, Clone)]
pub(crate) struct Sweep {
    x: [f64; WIDTH],
    dx: [f64; WIDTH],
    g: [f64; WIDTH],
    kappa: f64,
    /// Factor of g in a step.
    decay: f64,
    /// h0/(α√e).
    unit: f64,
    /// Time of the first of the four.
    time: f64,
    /// The x above which the time of a strike is known well enough.
    clear: f64,
}

/// The reason for the end of a stretch of a [`Sweep`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Then {
    /// The train goes on.
    On,
    /// The train has ended.
    End,
    /// The next strikes need more digits.
    Doubt,
}

impl Sweep {
    /// Largest amplitude of x: 408 strikes of a bar that falls flat. Rounded in some 100 steps, each approach velocity
    /// then was off by no more than 1.8e−13 of the first.
    const AMPLITUDE: f64 = 260.0;
    /// A strike with a smaller x over its amplitude is left to the closed form. The time of others was off by no more
    /// than 1.6e−12.
    const CLEAR: f64 = power_of_two(-11);
    /// An error that x over its amplitude never reaches.
    const ALLOWED: f64 = 1e-12;

    /// Returns whether a sweep may do, cos² θ from 0.990025 to 0.99994: π/408 < θ < 0.1. Trains with larger θ have 31
    /// impacts at most.
    #[inline]
    pub(crate) fn suits(bar: &Symmetric) -> bool {
        (bar.t * bar.t.abs() - 3.97993 * bar.e).abs() < 0.01983 * bar.e
    }

    /// Creates a sweep; `None` for other trains than those of a wave of up to some hundred strikes.
    #[inline]
    pub(crate) fn new(bar: &Symmetric, start: &Start) -> Option<Self> {
        let (e, [va, vb]) = (bar.e, start.velocity());
        // For small e, e^{n/2} may leave the range of floats.
        if e < 0.01 || !Self::suits(bar) || vb > 0.0 {
            return None;
        }
        let (root, beta) = (e.sqrt(), vb / va);
        let kappa = compensated(bar.wide_q(), e, e) / (2.0 * e + bar.t * root);
        let kappa_2 = kappa * (4.0 - kappa);
        // A step of one strike comes first; those of four follow from it.
        let (mut v, mut step) = (1.0, 1.0 - kappa + beta / root);
        let slope = step + 0.5 * kappa;
        let amplitude = 1.0 + 4.0 * slope * slope / kappa_2;
        if amplitude > Self::AMPLITUDE * Self::AMPLITUDE {
            return None;
        }
        let (mut x, mut dx) = ([0.0; WIDTH], [0.0; WIDTH]);
        let double = |kappa: f64, v: f64, step: f64| (2.0 - kappa) * step - kappa * v;
        for i in 0..WIDTH {
            (x[i], dx[i]) = (v, double(kappa_2, v, double(kappa, v, step)));
            v += step;
            step -= kappa * v;
        }
        Some(Self {
            x,
            dx,
            g: [1.0, root, e, e * root].map(|power| -va * power),
            kappa: kappa_2 * (4.0 - kappa_2),
            decay: e * e,
            unit: start.height_gap() / (-va * root),
            time: 0.0,
            clear: Self::CLEAR * amplitude.sqrt(),
        })
    }

    /// Returns approach velocities and times of the next four strikes, and how many of the four are valid.
    #[inline]
    pub(crate) fn take(&mut self) -> ([[f64; WIDTH]; 2], usize, Then) {
        let Self { x, unit, time, .. } = *self;
        let (mut approach, mut between) = ([0.0; WIDTH], [0.0; WIDTH]);
        for i in 0..WIDTH {
            approach[i] = -self.g[i] * x[i];
            self.g[i] *= self.decay;
            self.x[i] += self.dx[i];
            self.dx[i] -= self.kappa * self.x[i];
        }
        for i in 0..WIDTH {
            between[i] = unit / (x[i] * if i + 1 < WIDTH { x[i + 1] } else { self.x[0] });
        }
        let two = between[0] + between[1];
        self.time += two + (between[2] + between[3]);
        let strikes = [approach, [time, time + between[0], time + two, time + (two + between[2])]];
        // Between two strikes that are clear the wave is; after its end it stays below 0 for as long as it was above.
        if x[WIDTH - 1] > self.clear {
            return (strikes, WIDTH, Then::On);
        }
        let n = x.iter().take_while(|&&x| x > self.clear).count();
        let sure = x[n] * Self::CLEAR < -Self::ALLOWED * self.clear;
        (strikes, n, if sure { Then::End } else { Then::Doubt })
    }
}

impl Fours {
    /// Creates the four, with index `n` as the first.
    pub(crate) fn new(drive: &Drive, n: u64) -> Self {
        let h0 = drive.start.height_gap();
        let wave = matches!(drive.kind, Kind::Wave(_));
        let (mut kappa, mut decay, mut sum, mut time) = (0.0, 0.0, [1.0, 0.0], h0);
        let (mut theta, mut turns, mut crowded) = (0.0, [[0.0; 2]; WIDTH], true);
        match drive.kind {
            Kind::Wave(wave) => {
                theta = wave.theta;
                // The halves of the turns come from doubling and adding: sums of terms that are not negative, for θ <
                // π/3.
                let (s, c) = sincos(0.5 * wave.theta);
                let turn = |s: f64, c: f64| [2.0 * s * s, 2.0 * s * c];
                let [v, w] = turn(s, c);
                turns = [[0.0; 2], [v, w], turn(w, 1.0 - v), turn(s * (1.0 - v) + c * w, c * (1.0 - v) - s * w)];
                (kappa, decay) = (4.0 * turns[2][1] * turns[2][1], drive.bar.e * drive.bar.e);
                time = 2.0 * h0 / drive.amplitude(&wave);
                // Neighboring times differ by sin θ sin ψ/(sin δ_n+1 sin nθ) of themselves, with sin ψ = αS/A.
                crowded = wave.theta * (drive.alpha * wave.s) < 1e-8 * drive.amplitude(&wave);
            }
            Kind::Decay(roots) => {
                let (Decay { s, plus, sigma, .. }, [rate, ln_plus]) = (roots, drive.rates(&roots));
                turns = [0.0, 1.0, 2.0, 3.0].map(|j| [-expm1(-j * rate) * (plus / s), exp(-j * rate)]);
                (kappa, decay, sum) = (exp(-4.0 * rate), exp(4.0 * ln_plus), [drive.alpha * plus, sigma]);
            }
            Kind::Edge => {}
        }
        time = ldexp(time, drive.m - drive.unit);
        let [x, dx, y, dy, g] = [[0.0; WIDTH]; 5];
        let mut fours =
            Self { n, wave, crowded, four: Four { x, dx, y, dy, g, kappa, decay, time }, sum, theta, turns };
        fours.anchor(drive);
        fours
    }

    /// Computes approach velocities and times of the next strikes, four by four.
    pub(crate) fn take<const N: usize>(&mut self, drive: &Drive, approach: &mut [f64; N], times: &mut [f64; N]) {
        if self.wave {
            self.four.turn(approach, times);
        } else {
            self.four.grow(self.sum, approach, times);
        }
        self.n = self.n.saturating_add(N as u64);
        if self.n % BLOCK < N as u64 {
            self.anchor(drive);
        }
    }

    /// Computes all four anew from the closed form, at the index of the first.
    fn anchor(&mut self, drive: &Drive) {
        let n = to_f64(u128::from(self.n));
        match drive.kind {
            Kind::Wave(wave) => {
                let phi = angle(drive.alpha * wave.s, wave.x);
                let first = drive.decayed(u128::from(self.n), drive.amplitude(&wave) / wave.s);
                // In the last stretch velocities come down to the first one or below, from an amplitude far above it.
                let left = (wave.psi - n * wave.theta).abs();
                let share = -drive.start.velocity()[0] / first;
                let is_last = left < 1.5 * to_f64(u128::from(BLOCK)) * wave.theta;
                let error = if is_last { (ANGLE * share / left).min(1e-13) } else { 1e-13 };
                let ([delta], _) = drive.remainders(&wave, [u128::from(self.n)], error);
                let (turned, lead) = (n * wave.theta, phi + n * wave.theta);
                // Each angle counts from the near end of its half turn, so that a small one is known to its last digit.
                (self.four.x, self.four.dx) = if lead < 1.0 { self.sines(lead, 1.0) } else { self.sines(delta, -1.0) };
                (self.four.y, self.four.dy) =
                    if turned < 1.0 { self.sines(turned, 1.0) } else { self.sines(phi + delta, -1.0) };
                let root = drive.bar.e.sqrt();
                self.four.g = [first, first * root, first * drive.bar.e, first * (drive.bar.e * root)];
            }
            Kind::Decay(decay) => {
                let (Decay { s, plus, .. }, [rate, ln_plus]) = (decay, drive.rates(&decay));
                let (x, y) = (exp(-n * rate), -expm1(-n * rate) * (plus / s));
                let (first, once) = (drive.power(n * ln_plus, 1.0 / plus), exp(ln_plus));
                (self.four.x, self.four.y) = (self.turns.map(|[_, p]| x * p), self.turns.map(|[g, _]| y + x * g));
                self.four.dy = [-expm1(-4.0 * rate) * (plus / s); WIDTH];
                self.four.g = [first, first * once, first * (once * once), first * (once * once * once)];
            }
            Kind::Edge => {}
        }
    }

    /// Returns the sines of the angles `first` ± jθ, and their growth over the next 4θ. One sine and cosine, taken 2θ
    /// ahead, give them all by turns that keep small angles exact.
    fn sines(&self, first: f64, sign: f64) -> ([f64; WIDTH], [f64; WIDTH]) {
        let [v2, w2] = self.turns[2];
        let (sin, cos) = sincos(first + sign * 2.0 * self.theta);
        let mut sines = ([0.0; WIDTH], [0.0; WIDTH]);
        for (j, [v, w]) in self.turns.into_iter().enumerate() {
            let (s, c) = (sin - (sin * v - sign * cos * w), cos - (cos * v + sign * sin * w));
            sines.0[j] = s - (s * v2 + sign * c * w2);
            sines.1[j] = 2.0 * sign * c * w2;
        }
        sines
    }
}
