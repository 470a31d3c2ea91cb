//! Velocity shocks at eight natural frequencies side by side.

use crate::VelocityShock;
use crate::eight::{Many, WIDTH, decay, sin_cos};
use crate::impulse::difference;
use crate::peaks::Range;
use crate::suspension::{Modes, Motion};
use std::f64::consts::PI;

/// Extremes of quantity `k` at eight angular frequencies, as [`crate::VelocityShocks::extremes`] has them at one.
/// `None` on a machine without vectors. The phases must stay below [`crate::eight::LARGEST_ANGLE`].
#[derive(Debug)]
pub(crate) struct SideBySide<'a> {
    pub(crate) shocks: &'a [VelocityShock],
    pub(crate) modes: &'a Modes,
    pub(crate) omega: Many,
    pub(crate) k: usize,
}

/// The motion over one gap, see [`crate::suspension::Propagator`], and its angle βτ.
struct Step {
    c: Many,
    s: Many,
    k: Many,
    angle: Many,
}

#[expect(clippy::inline_always, reason = "they must take on the instruction set of the caller")]
impl SideBySide<'_> {
    /// Below critical damping: a decaying swing. Phase and exponent are carried in two doubles.
    #[inline(always)]
    fn swing(&self, dt: f64, dt_lo: f64) -> Step {
        let modes = self.modes;
        let (beta, beta_lo) = (modes.beta, modes.beta_lo);
        let (mut angle, mut angle_lo, mut exponent, mut exponent_lo) =
            ([0.0; WIDTH], [0.0; WIDTH], [0.0; WIDTH], [0.0; WIDTH]);
        for l in 0..WIDTH {
            let tau = self.omega[l] * dt;
            let lo = self.omega[l].mul_add(dt_lo, self.omega[l].mul_add(dt, -tau));
            angle[l] = beta * tau;
            angle_lo[l] = beta_lo.mul_add(tau, beta.mul_add(lo, beta.mul_add(tau, -angle[l])));
            exponent[l] = modes.zeta * tau;
            exponent_lo[l] = modes.zeta.mul_add(lo, modes.zeta.mul_add(tau, -exponent[l]));
        }
        let (mut s, mut c) = sin_cos(angle, angle_lo);
        let inverse = beta.recip();
        if modes.zeta == 0.0 {
            return Step { c, s, k: c, angle };
        }
        let (fall, _) = decay(exponent, exponent_lo);
        for l in 0..WIDTH {
            c[l] *= fall[l];
            s[l] *= fall[l] * inverse;
        }
        Step { c, s, k: c, angle }
    }
    /// From critical damping on: two decays in a row.
    #[inline(always)]
    fn cascade(&self, dt: f64) -> Step {
        let modes = self.modes;
        let (mut slow, mut apart, mut tau) = ([0.0; WIDTH], [0.0; WIDTH], [0.0; WIDTH]);
        for l in 0..WIDTH {
            tau[l] = self.omega[l] * dt;
            slow[l] = modes.sigma * tau[l];
            apart[l] = modes.kappa * tau[l];
        }
        let (c, _) = decay(slow, [0.0; WIDTH]);
        if modes.kappa == 0.0 {
            let mut s = c;
            for l in 0..WIDTH {
                s[l] *= tau[l];
            }
            return Step { c, s, k: c, angle: [0.0; WIDTH] };
        }
        let (faster, less) = decay(apart, [0.0; WIDTH]);
        let (mut s, mut k) = (c, c);
        let inverse = modes.kappa.recip();
        for l in 0..WIDTH {
            s[l] *= -less[l] * inverse;
            k[l] *= faster[l];
        }
        Step { c, s, k, angle: [0.0; WIDTH] }
    }
    /// The turning points at the frequencies that may hold a new extreme, one by one.
    #[inline(never)]
    fn turn(&self, new: &[u64; WIDTH], x: &Many, w: &Many, angle: &Many, high: &mut Many, low: &mut Many) {
        for l in (0..WIDTH).filter(|&l| new[l] == 1) {
            let m = Motion { x: x[l], w: w[l] };
            // The angle tells whether a second one follows; that there is a first is known.
            let span = if self.modes.beta > 0.0 { angle[l].max(PI) / self.modes.beta } else { f64::INFINITY };
            self.modes.free_extremes(self.k, m, span, (low[l], high[l]), |_, value| {
                high[l] = high[l].max(value);
                low[l] = low[l].min(value);
            });
        }
    }
    /// From the first to the last shock: largest and smallest values, and the motion after it.
    #[inline(always)]
    fn run(&self) -> (Many, Many, Many, Many) {
        let modes = self.modes;
        let ([q0, q1], [s0, s1]) = (modes.rows[self.k], modes.rows[self.k + 1]);
        let swinging = modes.beta > 0.0;
        let half_swing = modes.half_swing * modes.half_swing;
        let (mut x, mut w, mut high, mut low) = ([0.0; WIDTH], [0.0; WIDTH], [0.0; WIDTH], [0.0; WIDTH]);
        let mut last = self.shocks[0].time;
        for shock in self.shocks {
            let (dt, dt_lo) = difference(last, shock.time);
            let step = if swinging { self.swing(dt, dt_lo) } else { self.cascade(dt) };
            let (mut x1, mut w1, mut new) = (x, w, [0; WIDTH]);
            for l in 0..WIDTH {
                x1[l] = step.c[l].mul_add(x[l], step.s[l] * w[l]);
                w1[l] = step.k[l].mul_add(w[l], -modes.p * step.s[l] * x[l]);
                let (slope, slope1) = (s0.mul_add(x[l], s1 * w[l]), s0.mul_add(x1[l], s1 * w1[l]));
                let turns = u64::from(slope * slope1 <= 0.0) | u64::from(step.angle[l] >= PI);
                // For ζ < 1 the squared amplitude of all turning points to come.
                let n = w[l].mul_add(w[l], modes.p * x[l] * x[l]);
                let (ahead, behind) = if slope > 0.0 { (high[l], low[l]) } else { (low[l], high[l]) };
                let passes = u64::from(n > ahead * ahead) | u64::from(n * half_swing > behind * behind);
                new[l] = turns & (passes | u64::from(!swinging));
            }
            if new.contains(&1) {
                self.turn(&new, &x, &w, &step.angle, &mut high, &mut low);
            }
            for l in 0..WIDTH {
                let before = q0.mul_add(x1[l], q1 * w1[l]);
                x[l] = x1[l];
                w[l] = w1[l] - shock.delta_v;
                let after = q0.mul_add(x[l], q1 * w[l]);
                let (most, least) = if before > after { (before, after) } else { (after, before) };
                high[l] = if most > high[l] { most } else { high[l] };
                low[l] = if least < low[l] { least } else { low[l] };
            }
            last = shock.time;
        }
        (high, low, x, w)
    }
}

impl pulp::WithSimd for SideBySide<'_> {
    type Output = Option<[[Range; 2]; WIDTH]>;
    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
    fn with_simd<S: pulp::Simd>(self, _: S) -> Self::Output {
        if S::IS_SCALAR {
            return None;
        }
        let (high, low, x, w) = self.run();
        Some(std::array::from_fn(|l| {
            let (mut during, mut after) = (Range::default(), Range::default());
            during.note(0, 0.0, high[l]);
            during.note(0, 0.0, low[l]);
            after.note_free(self.modes, self.k, Motion { x: x[l], w: w[l] }, f64::INFINITY, 0);
            [during, after]
        }))
    }
}
