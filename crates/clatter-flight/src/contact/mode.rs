//! One mode of a phase: a damped oscillation about a constant load.

use std::f64::consts::PI;

/// `z″ + θλ z′ + λ z = p` from z and z′ at time 0: the damping of every mode is in proportion to its stiffness.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Mode {
    lambda: f64,
    theta: f64,
    load: f64,
    z: f64,
    dz: f64,
    /// ½θλ, and √|λ − s²|.
    s: f64,
    nu: f64,
}

/// Difference of angles that counts as zero: some hundred roundings.
const ROUNDING: f64 = 1e-13;

/// A mode at one time: z and its first three derivatives.
pub(crate) type Motion = [f64; 4];

impl Mode {
    pub(super) fn new(lambda: f64, theta: f64, load: f64, z: f64, dz: f64) -> Self {
        let s = 0.5 * theta * lambda;
        Self { lambda, theta, load, z, dz, s, nu: (lambda - s * s).abs().sqrt() }
    }
    /// Returns the z of rest.
    pub(crate) fn rest(&self) -> f64 {
        self.load / self.lambda
    }
    pub(super) fn at(&self, t: f64) -> Motion {
        let (u, du) = if t == 0.0 {
            (self.z - self.rest(), self.dz)
        } else {
            let (c, sn) = self.turn(t);
            let u = self.z - self.rest();
            (u * c + (self.dz + self.s * u) * sn, self.dz * c - (self.lambda * u + self.s * self.dz) * sn)
        };
        let second = |x: f64, dx: f64| -2.0 * self.s * dx - self.lambda * x;
        let ddu = second(u, du);
        [u + self.rest(), du, ddu, second(du, ddu)]
    }
    /// Returns e^(−st) cos νt and e^(−st) sin(νt)/ν, with hyperbolic functions beyond critical damping.
    fn turn(&self, t: f64) -> (f64, f64) {
        let Self { s, nu, lambda, .. } = *self;
        if s == 0.0 {
            let (sin, cos) = libm::sincos(nu * t);
            (cos, sin / nu)
        } else if s * s < lambda {
            let decay = libm::exp(-s * t);
            let (sin, cos) = libm::sincos(nu * t);
            (decay * cos, decay * sin / nu)
        } else {
            // The slow exponent comes from the product of both, without cancellation.
            let decay = libm::exp(-lambda / (s + nu) * t);
            let x = 2.0 * nu * t;
            // e^(−x) − 1, which cancels for small x alone.
            let less = if x < 1.0 { libm::expm1(-x) } else { libm::exp(-x) - 1.0 };
            let sn = if x > 0.0 { -less / x } else { 1.0 };
            (decay * (1.0 + 0.5 * less), decay * t * sn)
        }
    }
    /// Returns the force of the mode over its stiffness, z + θ z′, at a motion.
    pub(crate) fn press(&self, motion: &Motion) -> f64 {
        motion[0] + self.theta * motion[1]
    }
    /// Returns the first and second integrals of [`press`](Self::press) since time 0, at the motion of time t.
    pub(super) fn pressed(&self, t: f64, motion: &Motion) -> [f64; 2] {
        let half = 0.5 * t * t;
        [
            (self.load * t - (motion[1] - self.dz)) / self.lambda,
            (self.load * half - (motion[0] - self.z - self.dz * t)) / self.lambda,
        ]
    }
    /// Returns the energy that its dashpot has taken since time 0, at the motion of time t: θ∫z′² dt, the loss of ½ z′²
    /// + ½ λ (z − rest)² over λ.
    pub(super) fn taken(&self, motion: &Motion) -> f64 {
        if self.theta == 0.0 {
            return 0.0;
        }
        let held = |z: f64, dz: f64| 0.5 * (dz * dz / self.lambda + (z - self.rest()).powi(2));
        held(self.z, self.dz) - held(motion[0], motion[1])
    }
    /// Returns the stiffness λ.
    pub(crate) fn lambda(&self) -> f64 {
        self.lambda
    }
    /// Returns bounds, from time 0 on, of |z − rest| and of the second, third and fourth derivatives.
    pub(crate) fn bounds(&self) -> [f64; 4] {
        self.bounds_from(&self.at(0.0))
    }
    /// Returns the same bounds from the time of a motion on.
    pub(crate) fn bounds_from(&self, &[z, dz, ddz, dddz]: &Motion) -> [f64; 4] {
        // √(x² + x′²/λ) never grows, for z and for every derivative.
        let root = self.lambda.sqrt();
        let fourth = -2.0 * self.s * dddz - self.lambda * ddz;
        let length = |x: f64, dx: f64| (x * x + dx * dx / self.lambda).sqrt();
        let third = length(dddz, fourth);
        [length(z - self.rest(), dz), length(ddz, dddz), third, root * third]
    }
    /// Returns the time at which `offset + of_z z + of_rate z′` of an undamped mode first falls to zero, where it is
    /// positive before; one of both factors is 0.
    pub(super) fn falls(&self, offset: f64, of_z: f64, of_rate: f64) -> Option<f64> {
        let [amplitude, rate, phase] = self.wave();
        let level = offset + of_z * self.rest();
        // The sum is level + swing sin(begin + νt), with z′ a quarter of a turn ahead of z.
        let (swing, begin) =
            if of_rate == 0.0 { (of_z * amplitude, phase) } else { (of_rate * amplitude * rate, phase + 0.5 * PI) };
        let (swing, begin) = if swing < 0.0 { (-swing, begin + PI) } else { (swing, begin) };
        let (value, slope) = (level + swing * libm::sin(begin), swing * libm::cos(begin));
        if value <= 0.0 && slope <= 0.0 {
            return Some(0.0);
        }
        if level > swing {
            return None;
        }
        let turn = (PI + libm::asin((level / swing).max(-1.0)) - begin).rem_euclid(2.0 * PI);
        // It falls, and is zero but for rounding.
        let over = slope < 0.0 && turn > 2.0 * PI - ROUNDING;
        Some(if over { 0.0 } else { turn / rate })
    }
    /// Returns whether it has no damping.
    pub(super) fn is_undamped(&self) -> bool {
        self.s == 0.0
    }
    /// Returns the undamped vibration as an amplitude, a rate and a phase: z = rest + a sin(ψ + νt).
    pub(crate) fn wave(&self) -> [f64; 3] {
        let u = self.z - self.rest();
        let across = self.dz / self.nu;
        [libm::hypot(u, across), self.nu, libm::atan2(u, across)]
    }
}
