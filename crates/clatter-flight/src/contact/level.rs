//! A plate that is almost level: height of its center of mass and slopes along x and y, with lever arms that do not change.
//!
//! With the positions x, y of the points about the center of mass and the radii of gyration k_x, k_y,
//! M_ij = 1 + x_i x_j/k_x² + y_i y_j/k_y²; with a product of inertia 1 + r_i·C⁻¹ r_j, C the second moments of the mass.
//!
//! The first four points are the corners of the [`Plate`], on which it rests; others lie above them, such as the edges
//! beyond feet.

use super::Sample;
use super::pose::{Borne, Extent, Pose, Pushes, solve};
use crate::plate::{Plate, PlateScene};
use crate::rigid::Falls;

/// A [`Plate`] in motion.
#[derive(Debug, Clone, Copy)]
pub struct Level<const N: usize = 4> {
    plate: Plate,
    points: [[f64; 2]; N],
    /// Heights of the points above the corners of the plate, where it is level.
    over: [f64; N],
    gravity: f64,
    /// Height and velocity of the center of mass.
    y: f64,
    v: f64,
    /// Slopes along x and y, and their rates.
    slopes: [f64; 2],
    rates: [f64; 2],
}

/// Signs of forces around the plate that have no effect on it.
const AROUND: [f64; 4] = [1.0, -1.0, 1.0, -1.0];

impl Level {
    /// Returns the plate at its first touch: the lowest corner is on the ground.
    pub(crate) fn start(scene: &PlateScene) -> Self {
        Self::on(scene, scene.plate().corners_m(), [0.0; 4])
    }
    /// Returns the plate with its corners at these heights and velocities.
    pub(crate) fn of(scene: &PlateScene, height: [f64; 4], velocity: [f64; 4]) -> Self {
        let level = Self::start(scene);
        let [length, width] = level.plate.sides_m();
        let along = |[a, b, _, d]: [f64; 4]| [(b - a) / length, (d - a) / width];
        let mean = |of: [f64; 4]| level.even().iter().zip(of).map(|(share, x)| share * x).sum();
        Self { y: mean(height), v: mean(velocity), slopes: along(height), rates: along(velocity), ..level }
    }
}

impl<const N: usize> Level<N> {
    /// Returns the plate at its first touch with these points and their heights over its corners, which are the first
    /// four.
    pub(crate) fn on(scene: &PlateScene, points: [[f64; 2]; N], over: [f64; N]) -> Self {
        let plate = scene.plate();
        let ([length, width], [x, y]) = (plate.sides_m(), scene.gaps_m());
        let slopes = [x / length, y / width];
        let (gravity, v) = (scene.gravity_m_s2(), -scene.speed_m_s());
        let mut level = Self { plate, points, over, gravity, y: 0.0, v, slopes, rates: scene.spin_rad_s() };
        level.y = -level.points().0.into_iter().fold(f64::INFINITY, f64::min);
        level
    }
    fn height_of(&self, point: usize) -> f64 {
        self.y + Self::along(self.slopes, self.points[point]) + self.over[point]
    }
    /// Returns the forces on all points if the lying ones hold the plate, by those of them that move independently.
    fn held_by_any(&self, lying: &[bool; N], forces: &[f64; N]) -> Option<[f64; N]> {
        let coupling = |i: usize, j: usize| self.share(self.points[i], self.points[j]);
        let pushed = |i: usize, forces: &[f64; N]| (0..N).map(|j| coupling(i, j) * forces[j]).sum::<f64>();
        let others = std::array::from_fn(|i| if lying[i] { 0.0 } else { forces[i] });
        let falls = std::array::from_fn(|i| self.gravity - pushed(i, &others));
        let held = solve(coupling, lying, falls);
        let all = std::array::from_fn(|i| if lying[i] { held[i] } else { forces[i] });
        // The balance is to a rounding of gravity.
        (0..4).all(|i| (pushed(i, &all) - self.gravity).abs() <= 1e-9 * self.gravity).then_some(all)
    }
    /// Returns the value at a place of a quantity with these slopes along x and y.
    fn along(of: [f64; 2], [x, y]: [f64; 2]) -> f64 {
        x * of[0] + y * of[1]
    }
    /// Returns the acceleration at one place by a force of 1 over the mass at another.
    fn share(&self, one: [f64; 2], other: [f64; 2]) -> f64 {
        1.0 + Self::along(self.plate.turned(other), one)
    }
    /// Returns the acceleration of the slope along a direction by a force of 1 over the mass at each point.
    pub(super) fn slope_by(&self, direction: [f64; 2]) -> [f64; N] {
        self.points.map(|corner| Self::along(self.plate.turned(corner), direction))
    }
    /// Returns the rate of the slope along a direction.
    pub(super) fn rate_along(&self, direction: [f64; 2]) -> f64 {
        Self::along(self.rates, direction)
    }
    /// Returns the forces on the corners that are equivalent to a force of 1 at a place.
    fn shares_of(&self, [x, y]: [f64; 2]) -> [f64; 4] {
        let ([left, right, front, back], [length, width]) = (self.plate.edges_m(), self.plate.sides_m());
        let ([left, right], [front, back]) =
            ([(right - x) / length, (left + x) / length], [(back - y) / width, (front + y) / width]);
        [left * front, right * front, right * back, left * back]
    }
    /// Returns forces on the corners that sum to 1 and have no moment.
    fn even(&self) -> [f64; 4] {
        self.shares_of([0.0; 2])
    }
}

impl<const N: usize> Pose<N> for Level<N> {
    type Arms = ();
    type Impacts = Falls;

    fn gravity_of(falls: &Falls) -> f64 {
        falls.gravity_m_s2()
    }
    /// Instant impacts are those of the corners alone.
    fn sample_of(falls: &Falls, time_s: f64) -> Option<Sample<N>> {
        falls.sample(time_s).with_points()
    }

    fn extent(&self) -> Extent {
        let corners = self.points;
        let reach = corners.iter().fold(0.0_f64, |most, [x, y]| most.max(libm::hypot(*x, *y)));
        let [length, width] = self.plate.sides_m();
        let coupling = corners.iter().fold(1.0_f64, |most, corner| most.max(self.share(*corner, *corner)));
        Extent { size: length.max(width).max(reach), reach, coupling }
    }
    fn gravity(&self) -> f64 {
        self.gravity
    }
    fn points_by(&self, (): &()) -> ([f64; N], [f64; N]) {
        let height = std::array::from_fn(|i| self.height_of(i));
        (height, self.points.map(|point| self.velocity_of(point)))
    }
    /// Returns the velocity at x, y on the plate.
    fn velocity_of(&self, place: [f64; 2]) -> f64 {
        self.v + Self::along(self.rates, place)
    }
    fn angles(&self) -> [f64; 2] {
        [self.slopes, self.rates].map(|[x, y]| libm::hypot(x, y))
    }
    fn kinetic(&self) -> f64 {
        let [kx, ky] = self.plate.gyration_m();
        let [x, y] = [kx * self.rates[0], ky * self.rates[1]];
        let both = 2.0 * self.plate.product_of_inertia_m2() * self.rates[0] * self.rates[1];
        0.5 * (self.v * self.v + x * x + y * y + both)
    }
    fn energy(&self) -> f64 {
        self.kinetic() + self.gravity * self.y
    }

    fn flown(&self, t: f64) -> Self {
        let g = self.gravity;
        let slopes = [0, 1].map(|i| self.slopes[i] + self.rates[i] * t);
        Self { y: self.y + t * (self.v - 0.5 * g * t), v: self.v - g * t, slopes, ..*self }
    }
    fn flying(&self, point: usize, t: f64) -> [f64; 4] {
        let then = self.flown(t);
        [then.height_of(point), then.velocity_of(self.points[point]), -self.gravity, 0.0]
    }
    fn flying_bounds(&self, _: usize) -> [f64; 3] {
        [self.gravity, 0.0, 0.0]
    }

    fn arms(&self) {}
    fn coupling(&self, (): &(), i: usize, j: usize) -> f64 {
        self.share(self.points[i], self.points[j])
    }
    fn couplings_of(&self, (): &(), place: [f64; 2]) -> [f64; N] {
        self.points.map(|point| self.share(place, point))
    }
    fn falls(&self, (): &()) -> [f64; N] {
        [self.gravity; N]
    }
    fn after(&self, t: f64, (): &(), pushes: &Pushes<N>) -> Self {
        let mut pose = self.flown(t);
        for (i, corner) in self.points.into_iter().enumerate() {
            let turns = self.plate.turned(corner);
            pose.y += pushes.path[i];
            pose.v += pushes.impulse[i];
            pose.slopes = [0, 1].map(|k| pose.slopes[k] + turns[k] * pushes.path[i]);
            pose.rates = [0, 1].map(|k| pose.rates[k] + turns[k] * pushes.impulse[i]);
        }
        pose
    }

    /// Returns the forces on its corners are those that leave the least energy above that at rest: F and F + s (1, −1,
    /// 1, −1) have the same effect on the plate. No other freedom remains where it rests on such lines.
    fn borne(&self, (): &(), height: &[f64; N], line: impl Fn(usize) -> [f64; 2]) -> Option<Borne<N>> {
        let even = self.even().map(|share| share * self.gravity);
        let [mut off, mut yields] = [0.0; 2];
        for i in 0..4 {
            let [stiffness, zero] = line(i);
            if stiffness < f64::INFINITY {
                off += AROUND[i] * (height[i] - zero + even[i] / stiffness);
                yields += stiffness.recip();
            }
        }
        let s = if yields > 0.0 { (-off / yields).clamp(-even[0].min(even[2]), even[1].min(even[3])) } else { 0.0 };
        let forces = std::array::from_fn(|i| if i < 4 { even[i] + s * AROUND[i] } else { 0.0 });
        Some(Borne { on: std::array::from_fn(|i| i < 4), forces })
    }
    /// Returns three or four corners that lie hold it; four share alike, as equal springs would. Where a point above
    /// them lies too, as many points hold it as move independently.
    fn held_by(&self, lying: &[bool; N], forces: &[f64; N]) -> Option<[f64; N]> {
        let beyond = || 4..N;
        if beyond().any(|i| lying[i]) {
            return self.held_by_any(lying, forces);
        }
        let mut even = self.even().map(|share| share * self.gravity);
        for i in beyond() {
            let shares = self.shares_of(self.points[i]);
            even = std::array::from_fn(|k| even[k] - forces[i] * shares[k]);
        }
        let others: Vec<usize> = (0..4).filter(|&i| !lying[i]).collect();
        let s = match others[..] {
            [] => 0.0,
            [i] => (forces[i] - even[i]) * AROUND[i],
            _ => return None,
        };
        Some(std::array::from_fn(|i| if i < 4 { even[i] + s * AROUND[i] } else { forces[i] }))
    }
    /// Where more than one corner does not carry, the motion that the others cannot stop is left out.
    fn stopping(&self, carrying: &[bool; N]) -> Option<[Option<f64>; N]> {
        if !carrying[..4].contains(&true) {
            return None;
        }
        let (even, [length, width], [kx, ky]) = (self.even(), self.plate.sides_m(), self.plate.gyration_m());
        let (c, [x, y]) = (self.plate.product_of_inertia_m2(), self.rates);
        let moments = [(kx * kx * x + c * y) / (2.0 * length), (ky * ky * y + c * x) / (2.0 * width)];
        let each: [f64; 4] = std::array::from_fn(|i| {
            let [x, y] = self.points[i];
            -self.v * even[i] - moments[0] * x.signum() - moments[1] * y.signum()
        });
        let idle: Vec<usize> = (0..4).filter(|&i| !carrying[i]).collect();
        let s = if let [i] = idle[..] { -each[i] * AROUND[i] } else { 0.0 };
        Some(std::array::from_fn(|i| (i < 4 && carrying[i]).then(|| each[i] + s * AROUND[i])))
    }
    fn still(&self) -> Self {
        Self { v: 0.0, rates: [0.0; 2], ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The plate is off center and askew, rises and turns both ways: the stopping impulses on four corners or on three
    /// leave no corner a velocity.
    #[test]
    fn what_stops_a_plate_stops_every_corner() {
        let plate =
            Plate::new([0.08, 0.07, 0.03, 0.045], [0.043, 0.02]).unwrap().with_product_of_inertia(4e-4).unwrap();
        let mut level = Level::start(&PlateScene::new(plate, 1.0, [0.0; 2], 9.81).unwrap());
        (level.v, level.rates) = (0.3, [4.0, -7.0]);
        for idle in [None, Some(0), Some(1), Some(2), Some(3)] {
            let carrying = std::array::from_fn(|i| idle != Some(i));
            let impulses = level.stopping(&carrying).unwrap();
            assert_eq!(impulses.map(|impulse| impulse.is_some()), carrying);
            let impulse = impulses.map(|impulse| impulse.unwrap_or(0.0));
            let stopped = level.after(0.0, &(), &Pushes { path: [0.0; 4], impulse });
            let left = stopped.points().1;
            assert!(left.iter().all(|v| v.abs() < 1e-14), "{idle:?}: {left:?}");
        }
    }

    /// Checks that forces carry the weight and do not turn the plate.
    fn carries(level: &Level, forces: [f64; 4]) {
        let corners = level.plate.corners_m();
        let moment = |axis: usize| (0..4).map(|i| forces[i] * corners[i][axis]).sum::<f64>();
        assert!((forces.iter().sum::<f64>() - level.gravity).abs() < 1e-12, "{forces:?}");
        assert!(moment(0).abs() < 1e-13 && moment(1).abs() < 1e-13, "{forces:?}");
    }

    /// Four springs of any stiffness and height carry a plate whose corners, each where its spring gives its force, lie in one plane.
    #[test]
    fn a_plate_at_rest_on_four_springs_stays_plane() {
        let plate = Plate::new([0.08, 0.07, 0.03, 0.045], [0.043, 0.02]).unwrap();
        let level = Level::start(&PlateScene::new(plate, 1.0, [0.0; 2], 9.81).unwrap());
        let lines = [[4e4, 0.0], [9e4, -1e-5], [2e4, 2e-5], [6e4, 0.0]];
        let Borne { forces, .. } = level.borne(&(), &level.points().0, |i| lines[i]).unwrap();
        carries(&level, forces);
        assert!(forces.iter().all(|force| *force > 0.1), "none is idle: {forces:?}");
        let heights: [f64; 4] = std::array::from_fn(|i| lines[i][1] - forces[i] / lines[i][0]);
        let warp = heights[0] - heights[1] + heights[2] - heights[3];
        assert!(warp.abs() < 1e-15, "{heights:?}");
    }

    /// Where three corners lie, they bear the weight less the spring force of the fourth.
    #[test]
    fn corners_that_lie_bear_what_the_other_leaves() {
        let plate = Plate::new([0.08, 0.07, 0.03, 0.045], [0.043, 0.02]).unwrap();
        let level = Level::start(&PlateScene::new(plate, 1.0, [0.0; 2], 9.81).unwrap());
        for other in 0..4 {
            let mut given = [0.0; 4];
            given[other] = 1.3;
            let forces = level.held_by(&std::array::from_fn(|i| i != other), &given).unwrap();
            carries(&level, forces);
            assert!((forces[other] - 1.3).abs() < 1e-12, "{forces:?}");
        }
    }
}
