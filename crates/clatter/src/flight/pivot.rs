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
//! The time is the integral of `√(I/2K)`, K the kinetic energy, by adaptive quadrature; near a turning point `ψ_m` in
//! `x = √(ψ_m − ψ)`, where the integrand is smooth.

use super::finite_tilt::Pose;
use crate::quadrature::integrate;

/// No error allowed beyond the quadrature's own rounding.
const ROUNDING: f64 = 0.0;

/// How a pivot ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Event {
    /// The other end lands.
    Landing,
    /// The turning lifts the resting end.
    LiftOff,
}

/// Runs the pivot about end `i`, which lies still; returns the pose after, the time taken and what ended it.
pub(super) fn run(pose: &Pose, i: usize) -> (Pose, f64, Event) {
    let g = pose.gravity;
    let arm = pose.body.arms_m()[i];
    let rho2 = pose.body.gyration_m().powi(2);
    // Angle and rate from the resting end, mirrored to ψ ≤ 90°: p > 0 is upward.
    let side = if i == 0 { 1.0 } else { -1.0 };
    let (s0, c0) = (side * pose.sin, pose.cos.abs());
    let p0 = side * pose.spin * 1.0_f64.copysign(pose.cos);
    let about = Turn { gl: g * arm, rho2, arm2: arm * arm };
    let kinetic0 = 0.5 * about.inertia(c0) * p0 * p0;
    let energy = kinetic0 + about.gl * s0;
    let psi0 = s0.atan2(c0);
    let mut next = *pose;
    next.ends.h = [0.0; 2];
    next.ends.v = [0.0; 2];
    let length = pose.body.length_m();
    let lift = if p0 > 0.0 { about.lift_off(energy) } else { None };
    if let Some(s) = lift.filter(|&s| s > s0 && s < 1.0) {
        let psi = s.asin();
        let c = psi.cos();
        let p = (2.0 * (energy - about.gl * s) / about.inertia(c)).sqrt();
        next.sin = side * s;
        next.cos = c.copysign(pose.cos);
        next.spin = side * p * 1.0_f64.copysign(pose.cos);
        next.ends.h[1 - i] = length * s;
        next.ends.v[1 - i] = length * c * p;
        return (next, about.direct(psi0, psi, kinetic0), Event::LiftOff);
    }
    let over = p0 > 0.0 && energy >= about.gl;
    let time = if over {
        // Over the top: up to 90°, then down as a mirror image of going up from the ground.
        about.direct(psi0, 0.5 * std::f64::consts::PI, kinetic0) + about.direct(0.0, 0.5 * std::f64::consts::PI, energy)
    } else if energy < about.gl && (p0 > 0.0 || kinetic0 < 0.5 * energy) {
        let rise = about.rise(psi0, c0, kinetic0);
        let top = psi0 + rise;
        let down = about.below_top(top, 0.0, top.sqrt());
        let part = about.below_top(top, 0.0, rise.sqrt());
        if p0 > 0.0 { down + part } else { about.below_top(top, rise.sqrt(), top.sqrt()) }
    } else {
        about.direct(0.0, psi0, energy)
    };
    let p = (2.0 * energy / (rho2 + arm * arm)).sqrt();
    next.sin = 0.0;
    next.cos = if over { -1.0_f64.copysign(pose.cos) } else { 1.0_f64.copysign(pose.cos) };
    next.ends.v[1 - i] = -length * p;
    next.spin = (next.ends.v[1] - next.ends.v[0]) / (length * next.cos);
    (next, time, Event::Landing)
}

/// The motion about one end: g L, ρ², L².
struct Turn {
    gl: f64,
    rho2: f64,
    arm2: f64,
}

impl Turn {
    fn inertia(&self, cos: f64) -> f64 {
        self.rho2 + self.arm2 * cos * cos
    }
    /// sin ψ where the force on the end vanishes on the way up.
    fn lift_off(&self, energy: f64) -> Option<f64> {
        // In units of g L: s² − 2 ε s + (ρ² + L²)/L² = 0, the smaller root.
        let eps = energy / self.gl;
        let c = (self.rho2 + self.arm2) / self.arm2;
        (eps * eps >= c).then(|| c / (eps + (eps * eps - c).sqrt()))
    }
    /// Angle from ψ0 up to the turning point: sin(ψ0 + δ) − sin ψ0 = K0/gL.
    fn rise(&self, psi0: f64, c0: f64, kinetic0: f64) -> f64 {
        let k = kinetic0 / self.gl;
        let mut delta = k / c0;
        // The sine is concave: Newton's tangents stay below the root and rise to it.
        for _ in 0..60 {
            let miss = k - 2.0 * (psi0 + 0.5 * delta).cos() * (0.5 * delta).sin();
            let next = delta + miss / (psi0 + delta).cos();
            if next.is_nan() || next <= delta {
                break;
            }
            delta = next;
        }
        delta
    }
    /// Time between angles `lo < hi` below any turning point, with kinetic energy `k_lo` at `lo`.
    fn direct(&self, lo: f64, hi: f64, k_lo: f64) -> f64 {
        let f = |psi: f64| {
            let drop = 2.0 * self.gl * (0.5 * (lo + psi)).cos() * (0.5 * (psi - lo)).sin();
            (self.inertia(psi.cos()) / (2.0 * (k_lo - drop))).sqrt()
        };
        integrate(f, &[lo, hi], ROUNDING).value
    }
    /// Time between `x = √(ψ_m − ψ)` of `x0 < x1`, where the turning point `ψ_m` is `top`.
    fn below_top(&self, top: f64, x0: f64, x1: f64) -> f64 {
        let f = |x: f64| {
            let d = 0.5 * x * x;
            let sinc = if d == 0.0 { 1.0 } else { d.sin() / d };
            // K = 2 g L cos(ψ_m − d) sin d and dψ = 2 x dx.
            (2.0 * self.inertia((top - x * x).cos()) / (self.gl * (top - d).cos() * sinc)).sqrt()
        };
        integrate(f, &[x0, x1], ROUNDING).value
    }
}
