//! Predictions of a model compared with measurements.

use nalgebra::Vector3;

use super::body::Cube;
use super::path::{Case, Pose};
use super::{median, quantile};

/// The number of first samples by whose mean error settings are fitted: 74 ms of the cube from the first one to the
/// last.
pub(super) const FITTED: usize = 12;
/// A corner comes down when it falls below the first height, after having been above the second.
const DOWN_M: f64 = 4e-3;
const UP_M: f64 = 8e-3;

/// First quartile, median and third quartile.
pub(super) type Quartiles = [f64; 3];

pub(super) fn quartiles(values: &[f64]) -> Quartiles {
    [0.25, 0.5, 0.75].map(|share| quantile(values.iter().copied(), share))
}

/// A model on tosses: all errors are sizes.
#[derive(Debug, Clone)]
pub(super) struct Errors {
    /// Error of corners, the mean over the first samples, in m.
    pub(super) corners_m: Quartiles,
    /// Error of corners at each sample.
    pub(super) samples_m: Vec<Quartiles>,
    /// Errors in the middle of the second flight: vertical velocity of the center, rate of the vertical, rise of the
    /// center.
    pub(super) speed_m_s: Quartiles,
    pub(super) turn_rad_s: Quartiles,
    pub(super) rise_m: Quartiles,
    /// Predicted less measured rise, the median.
    pub(super) rise_bias_m: f64,
    /// Number of tosses in which the next corner to come down is the measured one, and number of tosses with a measured
    /// one; the same of the next two.
    pub(super) next: [usize; 2],
    pub(super) next_two: [usize; 2],
}

/// Returns the mean error of the first samples.
pub(super) fn corners_m(case: &Case, path: &[Pose], cube: &Cube) -> f64 {
    let off = case.off_m(path, cube);
    let first = &off[..off.len().min(FITTED)];
    first.iter().sum::<f64>() / f64::from(u32::try_from(first.len()).unwrap_or(u32::MAX))
}

/// Returns the score by which settings are fitted: the median over tosses of [`corners_m`].
pub(super) fn score_m<'a>(pairs: impl Iterator<Item = (&'a Case, Vec<Pose>)>, cube: &Cube) -> f64 {
    median(pairs.map(|(case, path)| corners_m(case, &path, cube)))
}

/// The motion in the middle of a flight: velocity of the center upward, rate of the vertical in axes of the cube, and
/// rise of the center.
#[derive(Debug, Clone, Copy)]
pub(super) struct Middle {
    pub(super) speed_m_s: f64,
    pub(super) turn_rad_s: Vector3<f64>,
    pub(super) rise_m: f64,
}

impl Middle {
    pub(super) fn of(path: &[Pose], middle: usize, cube: &Cube) -> Self {
        let (before, after) = (path[middle - 1], path[middle + 1]);
        let speed_m_s = 0.5 * cube.rate_hz * (after.height_m - before.height_m);
        Self {
            speed_m_s,
            turn_rad_s: 0.5 * cube.rate_hz * (after.upward - before.upward),
            rise_m: path[middle].height_m + 0.5 * speed_m_s.powi(2) / cube.gravity_m_s2,
        }
    }
}

/// Returns the corners that come down after the first touch, with their times, in order.
pub(super) fn touchdowns(case: &Case, path: &[Pose], cube: &Cube) -> Vec<(usize, f64)> {
    let (mut last, mut time) = (case.touch_pose(cube).heights_m(cube), 0.0);
    let mut armed = last.map(|height| height > DOWN_M);
    let mut touchdowns = Vec::new();
    for (pose, next) in path.iter().zip(&case.times_s) {
        let heights = pose.heights_m(cube);
        for i in (0..8).filter(|i| !cube.is_planar || i & 2 == 0) {
            if armed[i] && heights[i] < DOWN_M {
                let share = ((last[i] - DOWN_M) / (last[i] - heights[i])).clamp(0.0, 1.0);
                touchdowns.push((i, time + share * (next - time)));
                armed[i] = false;
            } else if heights[i] > UP_M {
                armed[i] = true;
            }
        }
        (last, time) = (heights, *next);
    }
    touchdowns.sort_by(|a, b| a.1.total_cmp(&b.1));
    touchdowns
}

impl Errors {
    pub(super) fn of(pairs: &[(&Case, Vec<Pose>)], cube: &Cube) -> Self {
        let off: Vec<_> = pairs.iter().map(|(case, path)| case.off_m(path, cube)).collect();
        let samples = (0..super::path::SAMPLES)
            .map(|k| quartiles(&off.iter().filter_map(|off| off.get(k).copied()).collect::<Vec<_>>()));
        let middles = pairs.iter().filter_map(|(case, path)| {
            let middle = case.middle?;
            Some((Middle::of(&case.measured, middle, cube), Middle::of(path, middle, cube)))
        });
        let middles: Vec<_> = middles.collect();
        let flown =
            |error: &dyn Fn(&Middle, &Middle) -> f64| middles.iter().map(|(a, b)| error(a, b)).collect::<Vec<_>>();
        let (mut next, mut next_two) = ([0; 2], [0; 2]);
        for (case, path) in pairs {
            let [measured, predicted] = [&case.measured, path].map(|path| touchdowns(case, path, cube));
            let same = |i: usize| measured.get(i).zip(predicted.get(i)).filter(|(a, b)| a.0 == b.0);
            next[0] += usize::from(same(0).is_some());
            next[1] += usize::from(!measured.is_empty());
            next_two[0] += usize::from(same(0).and(same(1)).is_some());
            next_two[1] += usize::from(measured.len() > 1);
        }
        Self {
            corners_m: quartiles(&pairs.iter().map(|(case, path)| corners_m(case, path, cube)).collect::<Vec<_>>()),
            samples_m: samples.collect(),
            speed_m_s: quartiles(&flown(&|a, b| (a.speed_m_s - b.speed_m_s).abs())),
            turn_rad_s: quartiles(&flown(&|a, b| (a.turn_rad_s - b.turn_rad_s).norm())),
            rise_m: quartiles(&flown(&|a, b| (a.rise_m - b.rise_m).abs())),
            rise_bias_m: median(flown(&|a, b| b.rise_m - a.rise_m)),
            next,
            next_two,
        }
    }
}
