//! A body seen from the side, in exact geometry: height and velocity of its center of mass, angle and spin.
//!
//! With the lever arms x and the radius of gyration ρ, M_ij = 1 + x_i x_j/ρ².

use std::f64::consts::FRAC_PI_2;

use clatter::Sine;

use super::pose::{Borne, Extent, Pose, Pushes};
use crate::excitation::turning;
use crate::profile::Profile;
use crate::roots::safe_step;
use crate::scene::Scene;

/// A [`Profile`] in motion.
#[derive(Debug, Clone, Copy)]
pub struct Planar<const N: usize> {
    pub(crate) body: Profile<N>,
    gravity: f64,
    /// Square of the radius of gyration.
    rho2: f64,
    /// Height and velocity of the center of mass.
    y: f64,
    v: f64,
    pub(crate) tilt: f64,
    pub(crate) spin: f64,
}

/// Lever arms, and heights over the center of mass, of all contact points, at one angle and spin.
#[derive(Debug, Clone, Copy)]
pub struct Levers<const N: usize> {
    x: [f64; N],
    over: [f64; N],
    sin: f64,
    cos: f64,
    spin: f64,
}

impl<const N: usize> Planar<N> {
    /// Returns the body at its first touch: the lowest point is on the ground.
    pub(super) fn start(scene: &Scene<N>) -> Self {
        let body = scene.body();
        let tilt = scene.tilt_rad();
        let (_, over) = body.levers(libm::sin(tilt), libm::cos(tilt));
        let lowest = over.iter().fold(f64::INFINITY, |low, h| low.min(*h));
        let (gravity, v, spin) = (scene.gravity_m_s2(), -scene.speed_m_s(), scene.spin_rad_s());
        Self { body, gravity, rho2: body.gyration_m().powi(2), y: -lowest, v, tilt, spin }
    }
    /// Returns the acceleration of a place at one lever arm by a force of 1 over the mass at another.
    fn share(&self, x: f64, other: f64) -> f64 {
        1.0 + x * other / self.rho2
    }
    /// Returns the angular acceleration by a force of 1 over the mass at each point.
    pub(super) fn turned_by(&self, arms: &Levers<N>) -> [f64; N] {
        arms.x.map(|x| x / self.rho2)
    }
    /// Returns whether all points are on one side, so that a body that turns over comes down on none of them.
    fn one_sided(&self) -> bool {
        self.body.points_m().iter().all(|[_, z]| *z < 0.0)
    }
    /// Returns the lowest points on both sides of the center of mass; `None` where a side has none.
    fn lowest(x: &[f64; N], height: &[f64; N]) -> Option<[usize; 2]> {
        let lowest = |side: f64| {
            let there = (0..N).filter(|&i| side * x[i] > 0.0);
            there.min_by(|&i, &j| height[i].total_cmp(&height[j]))
        };
        Some([lowest(-1.0)?, lowest(1.0)?])
    }
    /// Returns the outermost of some points on both sides.
    fn outermost(x: &[f64; N], of: &[bool; N]) -> Option<[usize; 2]> {
        let those = || (0..N).filter(|&i| of[i]);
        let left = those().min_by(|&i, &j| x[i].total_cmp(&x[j]))?;
        let right = those().max_by(|&i, &j| x[i].total_cmp(&x[j]))?;
        (left != right).then_some([left, right])
    }
}

impl<const N: usize> Pose<N> for Planar<N> {
    type Arms = Levers<N>;
    type Impacts = Scene;

    fn gravity_of(scene: &Scene) -> f64 {
        scene.gravity_m_s2()
    }

    fn extent(&self) -> Extent {
        let reach = self.body.reach();
        Extent { size: self.body.length_m().max(reach), reach, coupling: self.share(reach, reach) }
    }
    fn gravity(&self) -> f64 {
        self.gravity
    }
    fn points_by(&self, Levers { x, over, .. }: &Levers<N>) -> ([f64; N], [f64; N]) {
        (over.map(|h| self.y + h), x.map(|x| self.v + x * self.spin))
    }
    /// Returns the velocity at x, z on the body.
    fn velocity_of(&self, [x, z]: [f64; 2]) -> f64 {
        let (sin, cos) = libm::sincos(self.tilt);
        self.v + (x * cos - z * sin) * self.spin
    }
    fn angles(&self) -> [f64; 2] {
        [self.tilt, self.spin]
    }
    fn kinetic(&self) -> f64 {
        0.5 * (self.v * self.v + self.rho2 * self.spin * self.spin)
    }
    fn energy(&self) -> f64 {
        self.kinetic() + self.gravity * self.y
    }

    fn flown(&self, t: f64) -> Self {
        let g = self.gravity;
        let (y, v) = (self.y + t * (self.v - 0.5 * g * t), self.v - g * t);
        Self { y, v, tilt: self.tilt + self.spin * t, ..*self }
    }
    fn flying(&self, point: usize, t: f64) -> [f64; 4] {
        let [x0, z0] = self.body.points_m()[point];
        let (sin, cos) = libm::sincos(self.tilt + self.spin * t);
        let (x, over, w, g) = (x0 * cos - z0 * sin, x0 * sin + z0 * cos, self.spin, self.gravity);
        [self.y + t * (self.v - 0.5 * g * t) + over, self.v - g * t + w * x, -g - w * w * over, -w * w * w * x]
    }
    fn flying_bounds(&self, point: usize) -> [f64; 3] {
        let w = self.spin.abs();
        let turning = self.body.radius(point) * w * w;
        [self.gravity + turning, turning * w, turning * w * w]
    }
    fn flying_excitation(&self, place: [f64; 2], length_s: f64) -> (Sine, f64) {
        turning(place, self.tilt, self.spin, length_s)
    }
    /// The point cannot touch while the center of mass is higher than its distance.
    fn clear(&self, point: usize, t: f64) -> f64 {
        let g = self.gravity;
        let clear = self.y + t * (self.v - 0.5 * g * t) - self.body.radius(point);
        if clear > 0.0 { safe_step(clear, self.v - g * t, g) } else { 0.0 }
    }

    fn arms(&self) -> Levers<N> {
        let (sin, cos) = libm::sincos(self.tilt);
        let (x, over) = self.body.levers(sin, cos);
        Levers { x, over, sin, cos, spin: self.spin }
    }
    fn coupling(&self, arms: &Levers<N>, i: usize, j: usize) -> f64 {
        self.share(arms.x[i], arms.x[j])
    }
    fn couplings_of(&self, arms: &Levers<N>, [x, z]: [f64; 2]) -> [f64; N] {
        let lever = x * arms.cos - z * arms.sin;
        arms.x.map(|x| self.share(lever, x))
    }
    fn falls(&self, arms: &Levers<N>) -> [f64; N] {
        arms.over.map(|h| self.gravity + arms.spin * arms.spin * h)
    }
    fn turning(&self, &Levers { sin, cos, spin, .. }: &Levers<N>, [x, z]: [f64; 2]) -> f64 {
        -spin * spin * (x * sin + z * cos)
    }
    fn after(&self, t: f64, arms: &Levers<N>, pushes: &Pushes<N>) -> Self {
        let mut pose = self.flown(t);
        for i in 0..N {
            pose.y += pushes.path[i];
            pose.v += pushes.impulse[i];
            pose.tilt += arms.x[i] * pushes.path[i] / self.rho2;
            pose.spin += arms.x[i] * pushes.impulse[i] / self.rho2;
        }
        pose
    }

    fn mean(begin: &Self, middle: &Self, end: &Self, weigh: impl Fn([f64; 3]) -> f64) -> Self {
        let tilt = weigh([begin.tilt, middle.tilt, end.tilt]);
        Self { tilt, spin: weigh([begin.spin, middle.spin, end.spin]), ..*middle }
    }
    fn turned_from(&self, other: &Self) -> f64 {
        (self.tilt - other.tilt).abs()
    }
    fn steepness(&self, arms: &Levers<N>, point: usize) -> f64 {
        arms.over[point].abs() / arms.x[point].abs().max(0.1 * self.body.gyration_m())
    }
    /// Of 1 + x x_i/ρ² the lever arm x_i changes by its height over the center of mass.
    fn bend(&self, arms: &Levers<N>, point: usize) -> f64 {
        let farthest = arms.x.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        arms.over[point].abs() * farthest / (self.rho2 + arms.x[point] * arms.x[point])
    }

    /// The lowest points on both sides of its center of mass bear it.
    fn borne(
        &self,
        Levers { x, .. }: &Levers<N>,
        height: &[f64; N],
        _: impl Fn(usize) -> [f64; 2],
    ) -> Option<Borne<N>> {
        let [i, j] = Self::lowest(x, height)?;
        let mut borne = Borne { on: [false; N], forces: [0.0; N] };
        (borne.on[i], borne.on[j]) = (true, true);
        (borne.forces[i], borne.forces[j]) =
            (self.gravity * x[j] / (x[j] - x[i]), -self.gravity * x[i] / (x[j] - x[i]));
        Some(borne)
    }
    fn lower(&self) -> f64 {
        let arms = self.arms();
        let Some(on @ [i, j]) = Self::lowest(&arms.x, &self.points_by(&arms).0) else { return 0.0 };
        // Above a steep side the center is higher than the height over it.
        let [[x1, z1], [x2, z2]] = [i, j].map(|point| self.body.points_m()[point]);
        let above = self.body.height_over(on).abs() * libm::hypot(x2 - x1, z2 - z1) / (arms.x[j] - arms.x[i]);
        self.gravity * (above - self.body.lowest_m()).max(0.0)
    }
    fn held_by(&self, lying: &[bool; N], forces: &[f64; N]) -> Option<[f64; N]> {
        let x = self.arms().x;
        let [i, j] = Self::outermost(&x, lying)?;
        let mut forces = *forces;
        let (weight, moment) = (0..N).fold((self.gravity, 0.0), |(w, m), k| (w - forces[k], m - x[k] * forces[k]));
        forces[j] = (moment - x[i] * weight) / (x[j] - x[i]);
        forces[i] = weight - forces[j];
        Some(forces)
    }
    fn stopping(&self, carrying: &[bool; N]) -> Option<[Option<f64>; N]> {
        let x = self.arms().x;
        let [i, j] = Self::outermost(&x, carrying)?;
        let impulse = (x[i] * self.v - self.rho2 * self.spin) / (x[j] - x[i]);
        let mut impulses = [None; N];
        (impulses[i], impulses[j]) = (Some(-self.v - impulse), Some(impulse));
        Some(impulses)
    }

    fn still(&self) -> Self {
        Self { v: 0.0, spin: 0.0, ..*self }
    }

    /// Returns the time is finite for a body with points on one side alone.
    fn upright(&self) -> f64 {
        let Self { tilt, spin, .. } = *self;
        if spin != 0.0 && self.one_sided() {
            ((FRAC_PI_2 - tilt * spin.signum()) / spin.abs()).max(0.0)
        } else {
            f64::INFINITY
        }
    }
    fn is_over(&self) -> bool {
        self.tilt.abs() >= FRAC_PI_2 && self.one_sided()
    }
    fn unwound(self) -> Self {
        Self { tilt: libm::atan2(libm::sin(self.tilt), libm::cos(self.tilt)), ..self }
    }
}
