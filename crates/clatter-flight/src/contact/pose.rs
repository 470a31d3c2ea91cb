//! The body in exact geometry: height and velocity of its center of mass, angle and spin.

use crate::body::Body;
use crate::roots::safe_step;
use crate::scene::Scene;

#[derive(Debug, Clone, Copy)]
pub(crate) struct Pose<const N: usize> {
    pub(super) body: Body<N>,
    pub(crate) gravity: f64,
    /// Square of the radius of gyration.
    pub(super) rho2: f64,
    /// Height and velocity of the center of mass.
    pub(super) y: f64,
    pub(super) v: f64,
    pub(crate) tilt: f64,
    pub(crate) spin: f64,
}

/// Lever arms, and heights over the center of mass, of all contact points.
#[derive(Debug, Clone, Copy)]
pub(super) struct Levers<const N: usize> {
    pub(super) x: [f64; N],
    pub(super) over: [f64; N],
}

impl<const N: usize> Pose<N> {
    /// The first touch: the lowest point is on the ground.
    pub(super) fn start(scene: &Scene<N>) -> Self {
        let body = scene.body();
        let tilt = scene.tilt_rad();
        let (_, over) = body.levers(tilt.sin(), tilt.cos());
        let lowest = over.iter().fold(f64::INFINITY, |low, h| low.min(*h));
        let (gravity, v, spin) = (scene.gravity_m_s2(), -scene.speed_m_s(), scene.spin_rad_s());
        Self { body, gravity, rho2: body.gyration_m().powi(2), y: -lowest, v, tilt, spin }
    }
    pub(super) fn levers(&self) -> Levers<N> {
        let (sin, cos) = self.tilt.sin_cos();
        let (x, over) = self.body.levers(sin, cos);
        Levers { x, over }
    }
    /// Velocity of a place at x, z on the body.
    pub(crate) fn velocity_of(&self, [x, z]: [f64; 2]) -> f64 {
        let (sin, cos) = self.tilt.sin_cos();
        self.v + (x * cos - z * sin) * self.spin
    }
    /// Acceleration with which a point falls where nothing presses.
    pub(super) fn fall(&self, point: usize) -> f64 {
        self.gravity + self.spin * self.spin * self.levers().over[point]
    }
    /// Heights and vertical velocities of all points.
    pub(super) fn points(&self) -> ([f64; N], [f64; N]) {
        let Levers { x, over } = self.levers();
        (over.map(|h| self.y + h), x.map(|x| self.v + x * self.spin))
    }
    /// The pose after a free flight of time t.
    pub(super) fn flown(&self, t: f64) -> Self {
        let g = self.gravity;
        let (y, v) = (self.y + t * (self.v - 0.5 * g * t), self.v - g * t);
        Self { y, v, tilt: self.tilt + self.spin * t, ..*self }
    }
    /// Height of a point after a free flight of time t, and its first three derivatives.
    pub(super) fn flying(&self, point: usize, t: f64) -> [f64; 4] {
        let [x0, z0] = self.body.points_m()[point];
        let (sin, cos) = (self.tilt + self.spin * t).sin_cos();
        let (x, over, w, g) = (x0 * cos - z0 * sin, x0 * sin + z0 * cos, self.spin, self.gravity);
        [self.y + t * (self.v - 0.5 * g * t) + over, self.v - g * t + w * x, -g - w * w * over, -w * w * w * x]
    }
    /// Bounds of the second, third and fourth derivative of the height of a point in free flight.
    pub(super) fn flying_bounds(&self, point: usize) -> [f64; 3] {
        let w = self.spin.abs();
        let turning = self.body.radius(point) * w * w;
        [self.gravity + turning, turning * w, turning * w * w]
    }
    /// Time after t in which no angle lets a point touch: the center of mass is higher than its distance.
    pub(super) fn clear(&self, point: usize, t: f64) -> f64 {
        let g = self.gravity;
        let clear = self.y + t * (self.v - 0.5 * g * t) - self.body.radius(point);
        if clear > 0.0 { safe_step(clear, self.v - g * t, g) } else { 0.0 }
    }
    /// The pose after an impulse over the mass at a lever arm.
    pub(super) fn pushed(&self, impulse: f64, x: f64) -> Self {
        Self { v: self.v + impulse, spin: self.spin + x * impulse / self.rho2, ..*self }
    }
    /// The pose after a push at a lever arm that moves that point by so much.
    pub(super) fn moved(&self, by: f64, x: f64) -> Self {
        let own = 1.0 + x * x / self.rho2;
        Self { y: self.y + by / own, tilt: self.tilt + by / own * x / self.rho2, ..*self }
    }
    /// Energy per mass, the center of mass at height 0 without any.
    pub(super) fn energy(&self) -> f64 {
        0.5 * (self.v * self.v + self.rho2 * self.spin * self.spin) + self.gravity * self.y
    }
}
