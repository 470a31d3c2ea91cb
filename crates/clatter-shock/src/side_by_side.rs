//! Velocity shocks at eight natural frequencies side by side.

use crate::VelocityShock;
use crate::eight::{Many, WIDTH, decay, sin_cos};
use crate::impulse::difference;
use crate::peaks::{Peak, Peaks, Range};
use crate::suspension::{Modes, Motion};
use std::f64::consts::PI;

/// Peaks of quantity `k` at eight angular frequencies, as [`crate::VelocityShocks::peaks`] has them at one.
/// `None` on a machine without vectors. The phases must stay below [`crate::eight::LARGEST_ANGLE`].
#[derive(Debug)]
pub(crate) struct SideBySide<'a> {
    pub(crate) shocks: &'a [VelocityShock],
    pub(crate) modes: &'a Modes,
    pub(crate) omega: Many,
    pub(crate) k: usize,
}

/// Largest and smallest values so far, and their times.
#[derive(Clone, Copy)]
struct Found {
    high: Many,
    high_at: Many,
    low: Many,
    low_at: Many,
}

impl Found {
    /// Creates the state of rest from `time` on.
    fn rest(time: f64) -> Self {
        Self { high: [0.0; WIDTH], high_at: [time; WIDTH], low: [0.0; WIDTH], low_at: [time; WIDTH] }
    }
    /// Returns the peaks of one frequency.
    fn peaks(&self, l: usize) -> Peaks {
        Peaks {
            high: Peak { value: self.high[l], time: self.high_at[l] },
            low: Peak { value: self.low[l], time: self.low_at[l] },
        }
    }
}

/// The free motion over one time at eight angular frequencies, see [`crate::suspension::Propagator`], and its angle βτ.
pub(crate) struct Step {
    pub(crate) c: Many,
    pub(crate) s: Many,
    pub(crate) k: Many,
    angle: Many,
}

#[expect(clippy::inline_always, reason = "they must take on the instruction set of the caller")]
impl Step {
    /// Returns the motion over the time `dt` + `dt_lo`.
    #[inline(always)]
    pub(crate) fn new(modes: &Modes, omega: &Many, dt: f64, dt_lo: f64) -> Self {
        if modes.beta > 0.0 { Self::swing(modes, omega, dt, dt_lo) } else { Self::cascade(modes, omega, dt) }
    }
    /// Returns the motion below critical damping, a decaying swing. Phase and exponent are carried in two doubles.
    #[inline(always)]
    fn swing(modes: &Modes, omega: &Many, dt: f64, dt_lo: f64) -> Self {
        let (beta, beta_lo) = (modes.beta, modes.beta_lo);
        let (mut angle, mut angle_lo, mut exponent, mut exponent_lo) =
            ([0.0; WIDTH], [0.0; WIDTH], [0.0; WIDTH], [0.0; WIDTH]);
        for l in 0..WIDTH {
            let tau = omega[l] * dt;
            let lo = omega[l].mul_add(dt_lo, omega[l].mul_add(dt, -tau));
            angle[l] = beta * tau;
            angle_lo[l] = beta_lo.mul_add(tau, beta.mul_add(lo, beta.mul_add(tau, -angle[l])));
            exponent[l] = modes.zeta * tau;
            exponent_lo[l] = modes.zeta.mul_add(lo, modes.zeta.mul_add(tau, -exponent[l]));
        }
        let (mut s, mut c) = sin_cos(angle, angle_lo);
        let inverse = beta.recip();
        if modes.zeta == 0.0 {
            return Self { c, s, k: c, angle };
        }
        let (fall, _) = decay(exponent, exponent_lo);
        for l in 0..WIDTH {
            c[l] *= fall[l];
            s[l] *= fall[l] * inverse;
        }
        Self { c, s, k: c, angle }
    }
    /// Returns the motion from critical damping on, two decays in a row.
    #[inline(always)]
    fn cascade(modes: &Modes, omega: &Many, dt: f64) -> Self {
        let (mut slow, mut apart, mut tau) = ([0.0; WIDTH], [0.0; WIDTH], [0.0; WIDTH]);
        for l in 0..WIDTH {
            tau[l] = omega[l] * dt;
            slow[l] = modes.sigma * tau[l];
            apart[l] = modes.kappa * tau[l];
        }
        let (c, _) = decay(slow, [0.0; WIDTH]);
        if modes.kappa == 0.0 {
            let mut s = c;
            for l in 0..WIDTH {
                s[l] *= tau[l];
            }
            return Self { c, s, k: c, angle: [0.0; WIDTH] };
        }
        let (faster, less) = decay(apart, [0.0; WIDTH]);
        let (mut s, mut k) = (c, c);
        let inverse = modes.kappa.recip();
        for l in 0..WIDTH {
            s[l] *= -less[l] * inverse;
            k[l] *= faster[l];
        }
        Self { c, s, k, angle: [0.0; WIDTH] }
    }
}

#[expect(clippy::inline_always, reason = "they must take on the instruction set of the caller")]
impl SideBySide<'_> {
    /// Finds the turning points after `time` at the frequencies that may hold a new extreme, one by one.
    #[inline(never)]
    fn turn(&self, new: &[u64; WIDTH], [x, w, angle]: [&Many; 3], time: f64, found: &mut Found) {
        for l in (0..WIDTH).filter(|&l| new[l] == 1) {
            let m = Motion { x: x[l], w: w[l] };
            // The angle decides whether a second one follows; the first is certain.
            let span = if self.modes.beta > 0.0 { angle[l].max(PI) / self.modes.beta } else { f64::INFINITY };
            self.modes.free_extremes(self.k, m, span, (found.low[l], found.high[l]), |tau, value| {
                let at = time + tau / self.omega[l];
                if value > found.high[l] {
                    (found.high[l], found.high_at[l]) = (value, at);
                }
                if value < found.low[l] {
                    (found.low[l], found.low_at[l]) = (value, at);
                }
            });
        }
    }
    /// Returns the largest and smallest values from the first to the last shock, and the motion after it.
    #[inline(always)]
    fn run(&self) -> (Found, Many, Many) {
        let modes = self.modes;
        let ([q0, q1], [s0, s1]) = (modes.rows[self.k], modes.rows[self.k + 1]);
        let swinging = modes.beta > 0.0;
        let half_swing = modes.half_swing * modes.half_swing;
        let (mut x, mut w) = ([0.0; WIDTH], [0.0; WIDTH]);
        let mut last = self.shocks[0].time;
        let mut found = Found::rest(last);
        for shock in self.shocks {
            let (dt, dt_lo) = difference(last, shock.time);
            let step = Step::new(modes, &self.omega, dt, dt_lo);
            let (mut x1, mut w1, mut new) = (x, w, [0; WIDTH]);
            for l in 0..WIDTH {
                x1[l] = step.c[l].mul_add(x[l], step.s[l] * w[l]);
                w1[l] = step.k[l].mul_add(w[l], -modes.p * step.s[l] * x[l]);
                let (slope, slope1) = (s0.mul_add(x[l], s1 * w[l]), s0.mul_add(x1[l], s1 * w1[l]));
                let turns = u64::from(slope * slope1 <= 0.0) | u64::from(step.angle[l] >= PI);
                // For ζ < 1 the squared amplitude of all turning points to come.
                let n = w[l].mul_add(w[l], modes.p * x[l] * x[l]);
                let (high, low) = (found.high[l], found.low[l]);
                let (ahead, behind) = if slope > 0.0 { (high, low) } else { (low, high) };
                let passes = u64::from(n > ahead * ahead) | u64::from(n * half_swing > behind * behind);
                new[l] = turns & (passes | u64::from(!swinging));
            }
            if new.contains(&1) {
                self.turn(&new, [&x, &w, &step.angle], last, &mut found);
            }
            for l in 0..WIDTH {
                let before = q0.mul_add(x1[l], q1 * w1[l]);
                x[l] = x1[l];
                w[l] = w1[l] - shock.delta_v;
                let after = q0.mul_add(x[l], q1 * w[l]);
                let (most, least) = if before > after { (before, after) } else { (after, before) };
                found.high_at[l] = if most > found.high[l] { shock.time } else { found.high_at[l] };
                found.high[l] = if most > found.high[l] { most } else { found.high[l] };
                found.low_at[l] = if least < found.low[l] { shock.time } else { found.low_at[l] };
                found.low[l] = if least < found.low[l] { least } else { found.low[l] };
            }
            last = shock.time;
        }
        (found, x, w)
    }
}

impl pulp::WithSimd for SideBySide<'_> {
    type Output = [[Peaks; 2]; WIDTH];
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn with_simd<S: pulp::Simd>(self, _: S) -> Self::Output {
        let (found, x, w) = self.run();
        let end = self.shocks[self.shocks.len() - 1].time;
        std::array::from_fn(|l| {
            let mut after = Range::default();
            after.note_free(self.modes, self.k, Motion { x: x[l], w: w[l] }, f64::INFINITY, 0);
            [found.peaks(l), after.peaks(self.omega[l], |_| end)]
        })
    }
}
