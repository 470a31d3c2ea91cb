//! Free flights: place, velocity, orientation and spin from poses, and the end of a flight.

use nalgebra::{UnitQuaternion, Vector3};

use super::body::Cube;
use super::tosses::Pose;

/// A cube at a moment, all in axes of the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct State {
    pub(super) place: Vector3<f64>,
    pub(super) velocity: Vector3<f64>,
    pub(super) turned: UnitQuaternion<f64>,
    pub(super) spin: Vector3<f64>,
}

impl State {
    /// Returns the state after a free flight of some time: a parabola, and a constant spin, as the moments of inertia
    /// of a cube are all the same.
    pub(super) fn after(&self, time_s: f64, gravity_m_s2: f64) -> Self {
        let fall = Vector3::z() * gravity_m_s2 * time_s;
        Self {
            place: self.place + (self.velocity - 0.5 * fall) * time_s,
            velocity: self.velocity - fall,
            turned: UnitQuaternion::from_scaled_axis(self.spin * time_s) * self.turned,
            spin: self.spin,
        }
    }
    /// Returns the velocity of a place on the cube, from the center in axes of the world.
    pub(super) fn velocity_at(&self, arm: Vector3<f64>) -> Vector3<f64> {
        self.velocity + self.spin.cross(&arm)
    }
}

/// A free flight through poses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Flight {
    /// Time of its `state`, from the first pose of the toss.
    pub(super) time_s: f64,
    pub(super) state: State,
    /// Its samples, the last one excluded.
    pub(super) from: usize,
    pub(super) until: usize,
    /// Root mean square of the distances of poses, with turns as displacements of a corner.
    pub(super) misfit_m: f64,
}

/// Returns values at even times as a straight line by least squares: the value in the middle, and the slope.
fn line(times: &[f64], values: &[Vector3<f64>]) -> [Vector3<f64>; 2] {
    let count = f64::from(u32::try_from(times.len()).unwrap_or(u32::MAX));
    let mean = values.iter().sum::<Vector3<f64>>() / count;
    let slope = times.iter().zip(values).map(|(t, value)| value * *t).sum::<Vector3<f64>>();
    [mean, slope / times.iter().map(|t| t * t).sum::<f64>()]
}

impl Flight {
    /// Returns the free flight nearest to two poses or more: samples `from..until`.
    pub(super) fn fit(poses: &[Pose], from: usize, until: usize, cube: &Cube) -> Self {
        let poses = &poses[from..until];
        let middle = 0.5 * (cube.time_s(from) + cube.time_s(until - 1));
        let times: Vec<f64> = (from..until).map(|sample| cube.time_s(sample) - middle).collect();
        let lifted = |(t, pose): (&f64, &Pose)| pose.place + Vector3::z() * (0.5 * cube.gravity_m_s2 * t * t);
        let places: Vec<_> = times.iter().zip(poses).map(lifted).collect();
        let [place, velocity] = line(&times, &places);
        // The turns begin from a first guess of the orientation in the middle; a second round makes them as good as
        // exact.
        let (mut turned, mut spin) = (poses[poses.len() / 2].turned, Vector3::zeros());
        for _ in 0..3 {
            let unspun = |(t, pose): (&f64, &Pose)| {
                let spun = UnitQuaternion::from_scaled_axis(spin * *t);
                (spun.inverse() * pose.turned * turned.inverse()).scaled_axis()
            };
            let [offset, more] = line(&times, &times.iter().zip(poses).map(unspun).collect::<Vec<_>>());
            turned = UnitQuaternion::from_scaled_axis(offset) * turned;
            spin += more;
        }
        let state = State { place, velocity, turned, spin };
        let mut flight = Self { time_s: middle, state, from, until, misfit_m: 0.0 };
        let off = poses.iter().zip(from..).map(|(pose, sample)| flight.off(pose, sample, cube).powi(2));
        let squares = off.sum::<f64>() / f64::from(u32::try_from(poses.len()).unwrap_or(u32::MAX));
        flight.misfit_m = squares.sqrt();
        flight
    }

    pub(super) fn at(&self, time_s: f64, cube: &Cube) -> State {
        self.state.after(time_s - self.time_s, cube.gravity_m_s2)
    }

    /// Returns the distance of a pose from this flight.
    fn off(&self, pose: &Pose, sample: usize, cube: &Cube) -> f64 {
        let state = self.at(cube.time_s(sample), cube);
        let turn = (pose.turned * state.turned.inverse()).angle() * cube.half_m;
        ((pose.place - state.place).norm_squared() + 2.0 * turn * turn).sqrt()
    }

    /// Returns the longest free flight from a sample on: through `least` poses that fit, and on as long as the next
    /// pose fits.
    pub(super) fn longest(poses: &[Pose], from: usize, least: usize, cube: &Cube) -> Option<Self> {
        if from + least > poses.len() {
            return None;
        }
        let flight = Self::fit(poses, from, from + least, cube);
        (flight.misfit_m < FITS_M).then(|| flight.extended(poses, BREAKS_M, cube))
    }

    /// Returns this flight, extended as long as the next pose is off by less than `breaks_m`.
    pub(super) fn extended(mut self, poses: &[Pose], breaks_m: f64, cube: &Cube) -> Self {
        while let Some(next) = poses.get(self.until)
            && self.off(next, self.until, cube) < breaks_m
        {
            self = Self::fit(poses, self.from, self.until + 1, cube);
        }
        self
    }

    /// Returns the time at which the lowest corner comes down to the ground, between two times.
    pub(super) fn touch_s(&self, from_s: f64, until_s: f64, cube: &Cube) -> Option<f64> {
        let height = |time: f64| cube.lowest(&self.at(time, cube)).1;
        let (mut up, mut down) = (from_s, until_s);
        if height(up) < 0.0 || height(down) > 0.0 {
            return None;
        }
        for _ in 0..40 {
            let middle = 0.5 * (up + down);
            *(if height(middle) > 0.0 { &mut up } else { &mut down }) = middle;
        }
        Some(0.5 * (up + down))
    }

    /// Returns the time at which the heights of two flights agree: the moment of a strike between them, as if it took
    /// no time.
    pub(super) fn meets_s(&self, other: &Self, cube: &Cube) -> f64 {
        let apart = |time: f64| self.at(time, cube).place.z - other.at(time, cube).place.z;
        let (now, then) = (apart(0.0), apart(1.0));
        now / (now - then)
    }
}

/// Largest misfit of poses that form a flight: four times the misfit of the first flights.
const FITS_M: f64 = 4e-4;
/// Distance of the next pose at which the flight has ended.
const BREAKS_M: f64 = 1e-3;
