//! The corners at the samples after the first touch: measured, or as a model predicts them.

use clatter_flight::{Block, BlockDrop, Contact, ContactLaw};
use nalgebra::Vector3;

use super::body::{Cube, upward};
use super::flight::State;
use super::rigid::Rigid;
use super::strike::second_flight;
use super::tosses::Toss;
use crate::Error;

/// Samples of a path: 162 ms of the cube from the first one to the last, 96 ms of the square.
pub(super) const SAMPLES: usize = 25;

/// The part of a pose that gives the heights of corners.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pose {
    /// Height of the center over the ground.
    pub(super) height_m: f64,
    /// Vertical in axes of the cube.
    pub(super) upward: Vector3<f64>,
}

impl Pose {
    /// Returns the root mean square over the eight corners of their differences in height.
    pub(super) fn off_m(&self, other: &Self, cube: &Cube) -> f64 {
        let turned = cube.half_m * (self.upward - other.upward).norm();
        libm::hypot(self.height_m - other.height_m, turned)
    }
    pub(super) fn heights_m(&self, cube: &Cube) -> [f64; 8] {
        let corner = |i: usize, axis: usize| if i >> axis & 1 == 1 { self.upward[axis] } else { -self.upward[axis] };
        std::array::from_fn(|i| self.height_m + cube.half_m * (corner(i, 0) + corner(i, 1) + corner(i, 2)))
    }
}

/// A toss from its first touch on: its state then, and the pose at each sample.
#[derive(Debug, Clone)]
pub(super) struct Case {
    pub(super) number: u32,
    pub(super) training: bool,
    /// State at the first touch, by the flight before it.
    pub(super) touch: State,
    /// Times of the samples, from the first touch; 0 for one that was taken almost at it.
    pub(super) times_s: Vec<f64>,
    pub(super) measured: Vec<Pose>,
    /// The sample in the middle of the second flight.
    pub(super) middle: Option<usize>,
}

impl Case {
    /// Creates the case; `None` where the flight does not come down to the ground near the end of its poses.
    pub(super) fn new(toss: &Toss, training: bool, cube: &Cube) -> Option<Self> {
        let first = toss.first_flight(cube);
        let end = cube.time_s(first.until);
        let touch_s = first.touch_s(end - 3.0 / cube.rate_hz, end + 3.0 / cube.rate_hz, cube)?;
        let middle = second_flight(toss, cube).map(|flight| usize::midpoint(flight.from, flight.until) - first.until);
        let until = (first.until + SAMPLES).min(toss.poses.len());
        let seen =
            |pose: &super::tosses::Pose| Pose { height_m: pose.place.z - cube.ground_m, upward: upward(&pose.turned) };
        Some(Self {
            number: toss.number,
            training,
            touch: first.at(touch_s, cube),
            times_s: (first.until..until).map(|sample| (cube.time_s(sample) - touch_s).max(0.0)).collect(),
            measured: toss.poses[first.until..until].iter().map(seen).collect(),
            middle: middle.filter(|middle| (1..SAMPLES - 1).contains(middle)),
        })
    }

    /// Returns the same case up to so many samples.
    pub(super) fn first(&self, samples: usize) -> Self {
        let mut case = self.clone();
        case.times_s.truncate(samples);
        case.measured.truncate(samples);
        case
    }

    /// Returns the pose at the first touch.
    pub(super) fn touch_pose(&self, cube: &Cube) -> Pose {
        Pose { height_m: self.touch.place.z - cube.ground_m, upward: upward(&self.touch.turned) }
    }

    /// Returns the error of a path at each sample.
    pub(super) fn off_m(&self, path: &[Pose], cube: &Cube) -> Vec<f64> {
        self.measured.iter().zip(path).map(|(measured, pose)| measured.off_m(pose, cube)).collect()
    }

    /// Returns the path by the box of the product: contacts that take time.
    pub(super) fn box_path(&self, rigid: Rigid, contact_s: f64, cube: &Cube) -> Result<Vec<Pose>, Error> {
        let block = Block::new([2.0 * cube.half_m; 3], [0.0; 3], [cube.gyration_m; 3])?;
        let [w, i, j, k] = [self.touch.turned.w, self.touch.turned.i, self.touch.turned.j, self.touch.turned.k];
        let spin = self.touch.turned.inverse() * self.touch.spin;
        let end = self.times_s.last().copied().unwrap_or(0.0);
        let drop = BlockDrop::new(block, [w, i, j, k], -self.touch.velocity.z, cube.gravity_m_s2)?
            .with_spin(spin.into())?
            .with_friction(rigid.friction)?
            .with_slide([self.touch.velocity.x, self.touch.velocity.y])?
            .with_time_limit_s(end + 1e-3)?;
        let contact = Contact::new(ContactLaw::Hysteretic, rigid.e, contact_s)?;
        let mut path = Vec::with_capacity(self.times_s.len());
        let flight = drop.contacts(&contact, |step| {
            while let Some(time) = self.times_s.get(path.len())
                && *time <= step.from_s + step.length_s
            {
                let share = (time - step.from_s).max(0.0) / step.length_s;
                let height_m = step.place_m([0.0; 3], share).0;
                let along =
                    |axis: usize| step.place_m(std::array::from_fn(|i| f64::from(u8::from(i == axis))), share).0;
                path.push(Pose { height_m, upward: Vector3::from_fn(|axis, _| along(axis) - height_m) });
            }
        })?;
        // At rest nothing moves any more.
        let rest = Pose { height_m: flight.center_m, upward: flight.upward.into() };
        path.resize(self.times_s.len(), rest);
        Ok(path)
    }
}

#[cfg(test)]
mod tests {
    use crate::cube::body::{CUBE, SQUARE};
    use crate::cube::rigid::Rigid;
    use crate::cube::study::Study;
    use crate::cube::tosses::read;
    use crate::cube::{SQUARES, TOSSES};

    /// The two ways share nothing: the box of the product with short contacts, and impacts at points, as long as the
    /// lowest corner rises.
    #[test]
    fn short_contacts_without_friction_are_rigid_impacts() {
        let study = Study::new(read(TOSSES).unwrap(), &CUBE);
        let lowest = |pose: &super::Pose| pose.heights_m(&study.cube).into_iter().fold(f64::INFINITY, f64::min);
        let rigid = Rigid { e: 0.3, friction: 0.0 };
        let mut compared = 0;
        for case in &study.cases {
            let own = case.box_path(rigid, 5e-5, &study.cube).unwrap();
            let mut last = 0.0;
            for (a, b) in own.iter().zip(&rigid.path(case, &study.cube)) {
                if lowest(a) < last {
                    break;
                }
                last = lowest(a);
                compared += 1;
                // The bound is a step of the impacts, at 4 m/s of the fastest corner.
                assert!(a.off_m(b, &study.cube) < 4e-4, "toss {}: {:e}", case.number, a.off_m(b, &study.cube));
            }
        }
        assert!(compared > 300, "{compared} samples");
    }

    /// By so much the next corner is higher, so that it comes down later.
    const ALONE_M: f64 = 0.015;

    /// Where the corner slides on all along a press its force has one direction, that of Coulomb's law at a point: in a plane exactly so.
    #[test]
    fn short_contacts_that_slide_on_are_rigid_impacts() {
        let study = Study::new(read(SQUARES).unwrap(), &SQUARE);
        let mut compared = 0;
        for friction in [0.05, 0.1, 0.2] {
            let (rigid, smooth) = (Rigid { e: 0.3, friction }, Rigid { e: 0.3, friction: 0.0 });
            for case in &study.cases {
                let arms = study.cube.arms(&case.touch.turned);
                let arm = arms[study.cube.lowest(&case.touch).0];
                if arms.iter().any(|other| *other != arm && other.z < arm.z + ALONE_M) {
                    continue;
                }
                let [before, after] =
                    [case.touch, rigid.strike(&case.touch, arm, &study.cube)].map(|state| state.velocity_at(arm));
                let [slid, slides_on] = [before, after].map(|velocity| velocity.xy().dot(&before.xy().normalize()));
                // A slower one sticks at first, as the ground gives along itself too.
                if slid.min(slides_on) < 1.5 * friction * -before.z {
                    continue;
                }
                let soon = super::Case { times_s: vec![1e-3], ..case.first(1) };
                let own = soon.box_path(rigid, 1e-6, &study.cube).unwrap();
                let [with, without] = [rigid, smooth].map(|rigid| rigid.path(&soon, &study.cube));
                let (off, does) = (own[0].off_m(&with[0], &study.cube), with[0].off_m(&without[0], &study.cube));
                // The bound is the way of a corner within the contact time, 1e-6 s, over that by friction within 1e-3 s.
                assert!(off < 0.03 * does, "toss {}: {off:e} of {does:e} by friction of {friction}", case.number);
                compared += 1;
            }
        }
        assert!(compared > 50, "{compared} touches");
    }
}
