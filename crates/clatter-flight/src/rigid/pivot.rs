//! One end lies on the frictionless ground and the body turns about it.
//!
//! With ψ the angle of the body above the ground at the resting end, L the arm of that end and
//! `I(ψ) = ρ² + L² cos² ψ`, the energy per unit mass `E = ½ I ψ′² + g L sin ψ` is kept (the resting end slides, so the
//! center moves vertically), and everything but the time is closed:
//!
//! - force on the end: `ρ² (g − L ψ′² sin ψ)/I`, so it lifts off at the smaller root of
//!   `g L² s² − 2 L E s + g (ρ² + L²) = 0`, s = sin ψ, if that is met on the way up;
//! - turning point: `sin ψ = E/(g L)`; landing of the other end at ψ = 0 or π with `ψ′² = 2E/(ρ² + L²)`.
//!
//! With corners, L is the distance of the corner from the center and ψ the angle of the line between them: the body
//! lies at `ψ_0 = atan(t/2L)` in place of 0, and stands on its end at `90° + ψ_0`.
//!
//! The time is the integral of `√(I/2K)`, K the kinetic energy, by adaptive quadrature; near a turning point `ψ_m` in
//! `x = √(ψ_m − ψ)`, where the integrand is smooth.

use super::finite_tilt::Airborne;
use crate::profile::Profile;
use clatter::quadrature::integrate;

/// Tolerance of the quadrature: its own rounding alone.
const ROUNDING: f64 = 0.0;

/// The end of a pivot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Event {
    /// The other end lands.
    Landing,
    /// The turning lifts the resting end.
    LiftOff,
    /// A body of thickness stands on its end.
    Upright,
}

/// Runs the pivot about end `i`, which lies still; returns the pose after, the time taken and what ended it.
pub(super) fn run(pose: &Airborne, i: usize) -> (Airborne, f64, Event) {
    let g = pose.gravity;
    let arm = pose.body.radius(i);
    let rho2 = pose.body.gyration_m().powi(2);
    // Angle of the center above the ground and its rate from the resting end, mirrored to ψ ≤ 90°: p > 0 is upward.
    let side = if i == 0 { 1.0 } else { -1.0 };
    let (levers, over_center) = pose.body.levers(pose.sin, pose.cos);
    let x = -side * levers[i];
    let (s0, c0) = (-over_center[i] / arm, x.abs() / arm);
    let p0 = side * pose.spin * 1.0_f64.copysign(x);
    // Angles at which the body lies, and (mirrored) at which it has turned over; a body with corners stands there.
    let slope = libm::atan2(0.5 * pose.body.thickness_m(), pose.body.arms_m()[i]);
    let corners = slope > 0.0;
    let beyond = x < 0.0 && corners;
    let other_side = if corners { 0.5 * std::f64::consts::PI - slope } else { 0.0 };
    // Angles count from that of the lying body, where they are exact to the last digit however small.
    let base = if beyond { 0.0 } else { slope };
    let about = Turn { gl: g * arm, rho2, arm2: arm * arm, base };
    let tilt0 = if beyond { libm::atan2(s0, c0) } else { libm::atan2(side * pose.sin, pose.cos.abs()) };
    let [near, far] = if beyond { [other_side, slope] } else { [0.0, other_side] };
    let kinetic0 = 0.5 * about.inertia(c0) * p0 * p0;
    let energy = kinetic0 + about.gl * s0;
    let landing = kinetic0 + about.gain(near, tilt0);
    let mut next = *pose;
    next.ends.h = [0.0; 2];
    next.ends.v = [0.0; 2];
    let length = pose.body.length_m();
    let lift = if p0 > 0.0 && !beyond { about.lift_off(energy) } else { None };
    if let Some(s) = lift.filter(|&s| s > s0 && s < 1.0) {
        let psi = libm::asin(s);
        let p = (2.0 * (energy - about.gl * s) / about.inertia(libm::cos(psi))).sqrt();
        let tilt = psi - base;
        next.sin = side * libm::sin(tilt);
        next.cos = libm::cos(tilt).copysign(pose.cos);
        next.spin = side * p * 1.0_f64.copysign(pose.cos);
        next.ends.h[1 - i] = length * libm::sin(tilt);
        next.ends.v[1 - i] = length * libm::cos(tilt) * p;
        return (next, about.direct(tilt0, tilt, kinetic0), Event::LiftOff);
    }
    let over = p0 > 0.0 && energy >= about.gl;
    let upright = 0.5 * std::f64::consts::PI;
    let time = if over {
        // The body goes over the top: up to 90°, then down as a mirror image of going up from the other side.
        let mirror = Turn { base: 0.0, ..about };
        let up = about.direct(tilt0, upright - base, kinetic0);
        up + mirror.direct(far, upright, energy - about.gl * libm::sin(far))
    } else if energy < about.gl && (p0 > 0.0 || kinetic0 < 0.5 * landing) {
        let rise = about.rise(tilt0, c0, kinetic0);
        let top = tilt0 + rise;
        let down = about.below_top(top, 0.0, (top - near).sqrt());
        let part = about.below_top(top, 0.0, rise.sqrt());
        if p0 > 0.0 { down + part } else { about.below_top(top, rise.sqrt(), (top - near).sqrt()) }
    } else {
        about.direct(near, tilt0, landing)
    };
    if corners && over != beyond {
        (next.sin, next.cos) = (side, 0.0);
        return (next, time, Event::Upright);
    }
    let landing = if over { energy - about.gl * libm::sin(slope) } else { landing };
    let p = (2.0 * landing / about.inertia(libm::cos(slope))).sqrt();
    next.sin = 0.0;
    next.cos = if over && !corners { -1.0_f64.copysign(pose.cos) } else { 1.0_f64.copysign(pose.cos) };
    next.ends.v[1 - i] = -length * p;
    next.spin = (next.ends.v[1] - next.ends.v[0]) / (length * next.cos);
    (next, time, Event::Landing)
}

/// Returns tilt and spin a time t after a pivot about end `i` began with these, by Runge and Kutta's fourth order in
/// steps of 1/256 of `whole`.
///
/// With the lever arm x and the height over the center of mass of that end, `ω′ = x (g + over ω²)/(ρ² + x²)`.
pub(super) fn along(body: &Profile, gravity: f64, i: usize, begin: [f64; 2], t: f64, whole: f64) -> [f64; 2] {
    let rate = |[tilt, spin]: [f64; 2]| {
        let (x, over) = body.levers(libm::sin(tilt), libm::cos(tilt));
        [spin, x[i] * (gravity + over[i] * spin * spin) / body.inertia(x[i])]
    };
    let mut now = begin;
    let mut left = t;
    while left > 0.0 {
        let h = left.min(whole / 256.0);
        let step = |k: [f64; 2], h: f64| [now[0] + h * k[0], now[1] + h * k[1]];
        let a = rate(now);
        let b = rate(step(a, 0.5 * h));
        let c = rate(step(b, 0.5 * h));
        let d = rate(step(c, h));
        now = [0, 1].map(|n| now[n] + h / 6.0 * (a[n] + 2.0 * (b[n] + c[n]) + d[n]));
        left -= h;
    }
    now
}

/// The motion about one end: g L, ρ², L², and the ψ from which angles count.
#[derive(Clone, Copy)]
struct Turn {
    gl: f64,
    rho2: f64,
    arm2: f64,
    base: f64,
}

impl Turn {
    fn inertia(&self, cos: f64) -> f64 {
        self.rho2 + self.arm2 * cos * cos
    }
    /// Returns the gain of potential energy between two angles, `g L (sin ψ − sin ψ0)`.
    fn gain(&self, from: f64, to: f64) -> f64 {
        2.0 * self.gl * libm::cos(self.base + 0.5 * (from + to)) * libm::sin(0.5 * (to - from))
    }
    /// Returns sin ψ where the force on the end vanishes on the way up.
    fn lift_off(&self, energy: f64) -> Option<f64> {
        // In units of g L: s² − 2 ε s + (ρ² + L²)/L² = 0, the smaller root.
        let eps = energy / self.gl;
        let c = (self.rho2 + self.arm2) / self.arm2;
        (eps * eps >= c).then(|| c / (eps + (eps * eps - c).sqrt()))
    }
    /// Returns the angle from `from` up to the turning point, where the gain is K0; `c0` = cos ψ at `from`.
    fn rise(&self, from: f64, c0: f64, kinetic0: f64) -> f64 {
        let k = kinetic0 / self.gl;
        let mut delta = k / c0;
        // The sine is concave: Newton's tangents stay below the root and rise to it.
        for _ in 0..60 {
            let miss = k - 2.0 * libm::cos(self.base + from + 0.5 * delta) * libm::sin(0.5 * delta);
            let next = delta + miss / libm::cos(self.base + from + delta);
            if next.is_nan() || next <= delta {
                break;
            }
            delta = next;
        }
        delta
    }
    /// Returns the time between angles `lo < hi` below any turning point, with kinetic energy `k_lo` at `lo`.
    fn direct(&self, lo: f64, hi: f64, k_lo: f64) -> f64 {
        let f = |at: f64| {
            let inertia = self.inertia(libm::cos(self.base + at));
            (inertia / (2.0 * (k_lo - self.gain(lo, at)))).sqrt()
        };
        integrate(f, &[lo, hi], ROUNDING).value
    }
    /// Returns the time between `x = √(ψ_m − ψ)` of `x0 < x1`, where the turning point `ψ_m` is `top`.
    fn below_top(&self, top: f64, x0: f64, x1: f64) -> f64 {
        let top = self.base + top;
        let f = |x: f64| {
            let d = 0.5 * x * x;
            let sinc = if d == 0.0 { 1.0 } else { libm::sin(d) / d };
            // K = 2 g L cos(ψ_m − d) sin d and dψ = 2 x dx.
            (2.0 * self.inertia(libm::cos(top - x * x)) / (self.gl * libm::cos(top - d) * sinc)).sqrt()
        };
        integrate(f, &[x0, x1], ROUNDING).value
    }
}
