//! Neighboring strikes carried on together, from one anchor in the closed form to the next.

use super::{Decay, Drive, Kind, angle, ldexp, to_f64};
use libm::{exp, expm1, sincos};

/// Neighboring strikes that are carried on together.
const LANES: usize = 4;
/// Strikes from one anchor in the closed form to the next: 64 steps of the four lanes, which add some 64 roundings.
const BLOCK: u64 = 256;

/// Four neighboring strikes, ready to be carried on to the next four.
///
/// For a wave, x = sin δ_n and y = sin nθ turn by 4θ a step in the form `d ← d − κx, x ← x + d` with κ = 4 sin² 2θ
/// (Reinsch), whose errors stay relative where δ_n or nθ are small; |a_n| = gx, time = cy/x. For an endless decay,
/// x = ρⁿ and y = (1 − ρⁿ)/(1 − ρ) with ρ = λ₋/λ₊ add up positive terms; |a_n| = g(αλ₊x + σy), time = h0 y over that.
#[derive(Debug, Clone)]
pub(crate) struct Lanes {
    /// Index n of the first lane.
    n: u64,
    wave: bool,
    x: [f64; LANES],
    dx: [f64; LANES],
    y: [f64; LANES],
    dy: [f64; LANES],
    g: [f64; LANES],
    kappa: f64,
    /// What g is multiplied by a step.
    decay: f64,
    /// What x and y of a decay are multiplied by before they are added up: αλ₊, σ.
    sum: [f64; 2],
    /// 2 h0/A, or h0.
    time: f64,
    /// θ of a wave.
    theta: f64,
    /// Of a turn by jθ of a wave: 1 − cos and sin. Of a decay: (1 − ρʲ)/(1 − ρ) and ρʲ.
    turns: [[f64; 2]; LANES],
}

impl Lanes {
    /// With index `n` in the first lane.
    pub(crate) fn new(drive: &Drive, n: u64) -> Self {
        let (zero, h0) = ([0.0; LANES], drive.start.height_gap());
        let wave = matches!(drive.kind, Kind::Wave(_));
        let (mut kappa, mut decay, mut sum, mut time) = (0.0, 0.0, [1.0, 0.0], h0);
        let (mut theta, mut turns) = (0.0, [[0.0; 2]; LANES]);
        match drive.kind {
            Kind::Wave(wave) => {
                theta = wave.theta;
                // Of halves of the turns, by doubling and adding: sums of what is not negative, for θ < π/3.
                let (s, c) = sincos(0.5 * wave.theta);
                let turn = |s: f64, c: f64| [2.0 * s * s, 2.0 * s * c];
                let [v, w] = turn(s, c);
                turns = [[0.0; 2], [v, w], turn(w, 1.0 - v), turn(s * (1.0 - v) + c * w, c * (1.0 - v) - s * w)];
                (kappa, decay) = (4.0 * turns[2][1] * turns[2][1], drive.bar.e * drive.bar.e);
                time = 2.0 * h0 / drive.amplitude(&wave);
            }
            Kind::Decay(roots) => {
                let (Decay { s, plus, sigma, .. }, [rate, ln_plus]) = (roots, drive.rates(&roots));
                turns = [0.0, 1.0, 2.0, 3.0].map(|j| [-expm1(-j * rate) * (plus / s), exp(-j * rate)]);
                (kappa, decay, sum) = (exp(-4.0 * rate), exp(4.0 * ln_plus), [drive.alpha * plus, sigma]);
            }
            Kind::Edge => {}
        }
        time = ldexp(time, drive.m - drive.unit);
        let mut lanes =
            Self { n, wave, x: zero, dx: zero, y: zero, dy: zero, g: zero, kappa, decay, sum, time, theta, turns };
        lanes.anchor(drive);
        lanes
    }

    /// Approach velocities and times of the next strikes, four by four.
    pub(crate) fn take<const N: usize>(&mut self, drive: &Drive, approach: &mut [f64; N], times: &mut [f64; N]) {
        if self.wave {
            self.turn(approach, times);
        } else {
            self.grow(approach, times);
        }
        self.n = self.n.saturating_add(N as u64);
        if self.n % BLOCK < N as u64 {
            self.anchor(drive);
        }
    }

    /// Strikes of a wave. What is carried on is held in variables, so that it need not go through memory.
    fn turn(&mut self, approach: &mut [f64], times: &mut [f64]) {
        let Self { mut x, mut dx, mut y, mut dy, mut g, kappa, decay, time, .. } = *self;
        for (approach, times) in approach.as_chunks_mut::<LANES>().0.iter_mut().zip(times.as_chunks_mut::<LANES>().0) {
            for i in 0..LANES {
                approach[i] = -g[i] * x[i];
                times[i] = time * (y[i] / x[i]);
                g[i] *= decay;
                x[i] += dx[i];
                y[i] += dy[i];
                dx[i] -= kappa * x[i];
                dy[i] -= kappa * y[i];
            }
        }
        (self.x, self.dx, self.y, self.dy, self.g) = (x, dx, y, dy, g);
    }

    /// Strikes of a decay.
    fn grow(&mut self, approach: &mut [f64], times: &mut [f64]) {
        let Self { mut x, mut y, dy, mut g, kappa, decay, sum, time, .. } = *self;
        for (approach, times) in approach.as_chunks_mut::<LANES>().0.iter_mut().zip(times.as_chunks_mut::<LANES>().0) {
            for i in 0..LANES {
                let sum = sum[0] * x[i] + sum[1] * y[i];
                approach[i] = -g[i] * sum;
                times[i] = time * (y[i] / sum);
                g[i] *= decay;
                y[i] += dy[i] * x[i];
                // Before it is subnormal, and slow, it is nothing beside y.
                x[i] = if x[i] > 1e-290 { x[i] * kappa } else { 0.0 };
            }
        }
        (self.x, self.y, self.g) = (x, y, g);
    }

    /// All lanes from the closed form at the first.
    fn anchor(&mut self, drive: &Drive) {
        let n = to_f64(u128::from(self.n));
        match drive.kind {
            Kind::Wave(wave) => {
                let phi = angle(drive.alpha * wave.s, wave.x);
                let [delta] = drive.remainders(&wave, [u128::from(self.n)], 1e-13);
                let (turned, lead) = (n * wave.theta, phi + n * wave.theta);
                // Each angle from the near end of its half turn, so that a small one is known to its last digit.
                (self.x, self.dx) = if lead < 1.0 { self.lanes(lead, 1.0) } else { self.lanes(delta, -1.0) };
                (self.y, self.dy) = if turned < 1.0 { self.lanes(turned, 1.0) } else { self.lanes(phi + delta, -1.0) };
                let (first, root) =
                    (drive.decayed(u128::from(self.n), drive.amplitude(&wave) / wave.s), drive.bar.e.sqrt());
                self.g = [first, first * root, first * drive.bar.e, first * (drive.bar.e * root)];
            }
            Kind::Decay(decay) => {
                let (Decay { s, plus, .. }, [rate, ln_plus]) = (decay, drive.rates(&decay));
                let (x, y) = (exp(-n * rate), -expm1(-n * rate) * (plus / s));
                let (first, once) = (drive.power(n * ln_plus, 1.0 / plus), exp(ln_plus));
                (self.x, self.y) = (self.turns.map(|[_, p]| x * p), self.turns.map(|[g, _]| y + x * g));
                self.dy = [-expm1(-4.0 * rate) * (plus / s); LANES];
                self.g = [first, first * once, first * (once * once), first * (once * once * once)];
            }
            Kind::Edge => {}
        }
    }

    /// Sines of the angles `first` ± jθ, and what they grow by over the next 4θ. One sine and cosine, taken 2θ ahead,
    /// give them all by turns that keep small angles exact.
    fn lanes(&self, first: f64, sign: f64) -> ([f64; LANES], [f64; LANES]) {
        let [v2, w2] = self.turns[2];
        let (sin, cos) = sincos(first + sign * 2.0 * self.theta);
        let mut lanes = ([0.0; LANES], [0.0; LANES]);
        for (j, [v, w]) in self.turns.into_iter().enumerate() {
            let (s, c) = (sin - (sin * v - sign * cos * w), cos - (cos * v + sign * sin * w));
            lanes.0[j] = s - (s * v2 + sign * c * w2);
            lanes.1[j] = 2.0 * sign * c * w2;
        }
        lanes
    }
}
