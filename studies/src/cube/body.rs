//! The cube and the ground, as estimated from the poses themselves.

use nalgebra::{UnitQuaternion, Vector3};

use super::flight::{Flight, State};
use super::tosses::{Pose, Toss};

/// A cube, or a square that moves in a plane across y, of even moments of inertia whose corners are points.
///
/// Real corners are round. Without friction a ball at a corner acts like a point at its center on ground that is higher
/// by its radius: so the half-edge is that to the centers, and the ground is at the lowest height of these.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cube {
    /// Distance from the center to a face through the corners.
    pub(super) half_m: f64,
    pub(super) ground_m: f64,
    pub(super) gravity_m_s2: f64,
    pub(super) gyration_m: f64,
    /// Number of poses per second.
    pub(super) rate_hz: f64,
    /// Contact times that the fits try.
    pub(super) contacts_s: [f64; 4],
    /// True if it moves in a plane: two corners across it are one then.
    pub(super) is_planar: bool,
}

/// The cube with its published size: 104.8 mm, 0.37 kg, 8.1e−4 kg m² about each axis; gravity where nothing is
/// measured.
pub(super) const CUBE: Cube = Cube {
    half_m: 0.0524,
    ground_m: 0.0,
    gravity_m_s2: 9.80665,
    gyration_m: 0.046_79,
    rate_hz: 148.0,
    contacts_s: [1e-3, 2e-3, 3e-3, 4e-3],
    is_planar: false,
};
/// A square of 60 mm, of even mass.
pub(super) const SQUARE: Cube = Cube {
    half_m: 0.03,
    gyration_m: 0.024_495,
    rate_hz: 250.0,
    contacts_s: [2e-4, 5e-4, 1e-3, 1.5e-3],
    is_planar: true,
    ..CUBE
};
/// The least number of samples of a first flight from which gravity is estimated.
const TELLS_GRAVITY: usize = 12;
/// A corner counts as carried if the lowest one keeps its height to the first length over five samples, and is no
/// higher than the second over the ground.
const KEEPS_M: f64 = 4e-4;
const CARRIED_M: f64 = 3e-3;
/// The number of samples from which the half-edge is estimated; a body that slides for fewer keeps the published one,
/// on the ground on which it lies in the end.
const ENOUGH: usize = 200;

impl Cube {
    /// Returns the cube with gravity, half-edge and height of the ground as estimated from these tosses. Gravity comes
    /// from the parabolas of their first flights; the other two from a straight line through the heights of the center
    /// while a corner slides, over the sum of the vertical's parts, Σ|n_i|: z = ground + half · Σ|n_i|.
    pub(super) fn measured(&self, tosses: &[&Toss]) -> Self {
        let gravities = tosses.iter().filter_map(|toss| {
            let down = toss.near(self);
            (down >= TELLS_GRAVITY).then(|| self.curvature(&toss.poses[..down]))
        });
        let mut cube = Self { gravity_m_s2: super::median(gravities), ..*self };
        // The carried samples depend a little on the size: hence a second round.
        for _ in 0..2 {
            let carried: Vec<_> = tosses.iter().flat_map(|toss| cube.carried(toss)).collect();
            if carried.len() < ENOUGH {
                let rests =
                    tosses.iter().map(|toss| toss.rest.place.z - cube.half_m * upward(&toss.rest.turned).abs().sum());
                cube.ground_m = super::median(rests);
                continue;
            }
            let count = f64::from(u32::try_from(carried.len()).unwrap_or(u32::MAX));
            let [mean_sum, mean_height] = [0, 1].map(|i| carried.iter().map(|both| both[i]).sum::<f64>() / count);
            let mixed = |[sum, height]: &[f64; 2]| (sum - mean_sum) * (height - mean_height);
            let squares: f64 = carried.iter().map(|[sum, _]| (sum - mean_sum).powi(2)).sum();
            cube.half_m = carried.iter().map(mixed).sum::<f64>() / squares;
            cube.ground_m = mean_height - cube.half_m * mean_sum;
        }
        cube
    }

    /// Returns Σ|n_i| and height of the center of samples at which a corner is carried.
    fn carried(&self, toss: &Toss) -> Vec<[f64; 2]> {
        let sample = |pose: &Pose| {
            let sum = upward(&pose.turned).abs().sum();
            [sum, pose.place.z, pose.place.z - self.half_m * sum]
        };
        let samples: Vec<_> = toss.poses[toss.near(self)..].iter().map(sample).collect();
        let keeps = |five: &&[[f64; 3]]| {
            let lows = five.iter().map(|[_, _, low]| *low);
            let span = lows.clone().fold(f64::MIN, f64::max) - lows.fold(f64::MAX, f64::min);
            span < KEEPS_M && five[2][2] < CARRIED_M
        };
        samples.windows(5).filter(keeps).map(|five| [five[2][0], five[2][1]]).collect()
    }

    /// Returns the corners from the center in axes of the world: `---`, `+--`, `-+-` and so on, x first.
    pub(super) fn arms(&self, turned: &UnitQuaternion<f64>) -> [Vector3<f64>; 8] {
        let half = |axis: usize| if axis == 1 && self.is_planar { 0.0 } else { self.half_m };
        let side = |corner: usize, axis: usize| if corner >> axis & 1 == 1 { half(axis) } else { -half(axis) };
        std::array::from_fn(|i| turned * Vector3::new(side(i, 0), side(i, 1), side(i, 2)))
    }

    /// Returns the lowest corner and its height over the ground.
    pub(super) fn lowest(&self, state: &State) -> (usize, f64) {
        let arms = self.arms(&state.turned);
        let lowest = (0..8).min_by(|a, b| arms[*a].z.total_cmp(&arms[*b].z)).unwrap_or(0);
        (lowest, state.place.z + arms[lowest].z - self.ground_m)
    }

    /// Returns the time of a sample.
    pub(super) fn time_s(&self, sample: usize) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "some hundred samples")]
        let sample = sample as f64;
        sample / self.rate_hz
    }

    /// Returns the downward acceleration of a free fall through these poses.
    fn curvature(&self, poses: &[Pose]) -> f64 {
        let middle = 0.5 * self.time_s(poses.len() - 1);
        let squares: Vec<f64> = (0..poses.len()).map(|sample| (self.time_s(sample) - middle).powi(2)).collect();
        let mean = squares.iter().sum::<f64>() / f64::from(u32::try_from(poses.len()).unwrap_or(u32::MAX));
        // Squares of times less their mean are orthogonal to height and velocity.
        let mixed: f64 = squares.iter().zip(poses).map(|(square, pose)| (square - mean) * pose.place.z).sum();
        -2.0 * mixed / squares.iter().map(|square| (square - mean).powi(2)).sum::<f64>()
    }
}

/// Returns the vertical in axes of the cube.
pub(super) fn upward(turned: &UnitQuaternion<f64>) -> Vector3<f64> {
    turned.inverse() * Vector3::z()
}

impl Toss {
    /// Returns the first sample with a corner so near the ground that it may be down by the next one.
    pub(super) fn near(&self, cube: &Cube) -> usize {
        let low = |pose: &Pose| pose.place.z - cube.half_m * upward(&pose.turned).abs().sum() - cube.ground_m;
        self.poses.iter().position(|pose| low(pose) < NEAR_M).unwrap_or(self.poses.len())
    }

    /// Returns the flight from the hand to the first touch: through the last ten poses that all fit, and on until a
    /// pose does not.
    pub(super) fn first_flight(&self, cube: &Cube) -> Flight {
        let near = self.near(cube);
        let mut flight = Flight::fit(&self.poses, near.saturating_sub(FIRST), near, cube);
        while flight.misfit_m > FLIES_M && flight.until > flight.from + LEAST {
            flight = Flight::fit(&self.poses, flight.from + 1, near, cube);
        }
        flight.extended(&self.poses, FLIES_M, cube)
    }
}

/// Height for round corners, noise and the sampling: no corner has been down before the lowest is at this height.
const NEAR_M: f64 = 3e-3;
/// The number of samples before the first touch by which the hand has let go.
const FIRST: usize = 10;
const LEAST: usize = 5;
/// Largest distance of poses from a first flight, six times the noise.
const FLIES_M: f64 = 4e-4;
