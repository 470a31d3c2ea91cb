//! Isolated strikes: those between two free flights that meet.

use nalgebra::Vector3;

use super::body::Cube;
use super::flight::{Flight, State};
use super::tosses::Toss;

/// The first strike of a toss, if nothing else happens between the flights before and after it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Strike {
    pub(super) corner: usize,
    /// Vector from the center to the corner, in axes of the world.
    pub(super) arm: Vector3<f64>,
    pub(super) before: State,
    pub(super) after: State,
    /// Delay against the touch by free flight.
    pub(super) late_s: f64,
}

/// Flights meet if, at the moment when their heights agree, their orientations agree to so many radians or to the turn
/// in so much time, and their places to so many meters.
const MEETS_RAD: f64 = 3e-3;
const MEETS_S: f64 = 1.5e-3;
const MEETS_M: f64 = 6e-4;
/// Height of the next corner over the half-edge from which on a corner strikes alone.
const ALONE: f64 = 0.15;
/// The least number of samples of a flight after a strike.
const LEAST: usize = 4;

/// Returns the flight after the first touch: the first of four samples and more with every corner up.
pub(super) fn second_flight(toss: &Toss, cube: &Cube) -> Option<Flight> {
    let down = toss.first_flight(cube).until;
    let flies = |flight: &Flight| {
        let heights = (flight.from..flight.until).map(|k| cube.lowest(&flight.at(cube.time_s(k), cube)).1);
        heights.fold(f64::MIN, f64::max) > CLEAR_M
    };
    (down..down + LATEST).filter_map(|from| Flight::longest(&toss.poses, from, LEAST, cube)).find(flies)
}

/// The least height of a flight over the ground.
const CLEAR_M: f64 = 2e-3;
/// The last sample after the first touch at which it may begin.
const LATEST: usize = 12;

impl Strike {
    /// Returns the first strike of a toss; none where a second corner strikes before the cube has flown.
    pub(super) fn first(toss: &Toss, cube: &Cube) -> Option<Self> {
        let first = toss.first_flight(cube);
        let second = second_flight(toss, cube)?;
        if second.from > first.until + 2 {
            return None;
        }
        let time = first.meets_s(&second, cube);
        let (before, after) = (first.at(time, cube), second.at(time, cube));
        let turn = (after.turned * before.turned.inverse()).angle();
        let allowed = MEETS_RAD.max(MEETS_S * (after.spin - before.spin).norm());
        if turn > allowed || (after.place - before.place).norm() > MEETS_M {
            return None;
        }
        let touch = first.touch_s(cube.time_s(first.until - 2), cube.time_s(first.until + 1), cube)?;
        let corner = cube.lowest(&before).0;
        let arms = cube.arms(&before.turned);
        let arm = arms[corner];
        // On an edge or a face other corners press as well.
        if arms.iter().any(|other| *other != arm && other.z - arm.z < ALONE * cube.half_m) {
            return None;
        }
        Some(Self { corner, arm, before, after, late_s: time - touch })
    }

    /// Returns the velocity of the corner before and after.
    pub(super) fn corner_m_s(&self) -> [Vector3<f64>; 2] {
        [self.before, self.after].map(|state| state.velocity_at(self.arm))
    }

    /// Returns the vertical velocity of the corner after over before, upward over downward.
    pub(super) fn restitution(&self) -> f64 {
        let [before, after] = self.corner_m_s();
        -after.z / before.z
    }

    /// Returns the change of the velocity of the center.
    pub(super) fn impulse_m_s(&self) -> Vector3<f64> {
        self.after.velocity - self.before.velocity
    }

    /// Returns the change of horizontal velocity over that of vertical velocity: the effective coefficient of friction.
    pub(super) fn friction(&self) -> f64 {
        let impulse = self.impulse_m_s();
        impulse.xy().norm() / impulse.z
    }

    /// Returns the horizontal velocity of the corner after the strike along that before: positive where it slides on.
    pub(super) fn slides_on_m_s(&self) -> f64 {
        let [before, after] = self.corner_m_s().map(|v| v.xy());
        before.dot(&after) / before.norm()
    }

    /// Returns the distance of the impulse from the corner, by the change of spin.
    pub(super) fn lever_m(&self, gyration_m: f64) -> f64 {
        let [moment, spin] = self.moments();
        (moment - gyration_m.powi(2) * spin).norm() / self.impulse_m_s().norm()
    }

    /// Returns the change of angular momentum over the mass in two ways: as the impulse at its arm, and as the change
    /// of spin to multiply with the square of the radius of gyration.
    pub(super) fn moments(&self) -> [Vector3<f64>; 2] {
        [self.arm.cross(&self.impulse_m_s()), self.after.spin - self.before.spin]
    }
}

/// Returns the radius of gyration that fits strikes best: r × Δv = k² Δω.
pub(super) fn gyration_m(strikes: &[Strike]) -> f64 {
    let (mut mixed, mut squares) = (0.0, 0.0);
    for [moment, spin] in strikes.iter().map(Strike::moments) {
        mixed += moment.dot(&spin);
        squares += spin.norm_squared();
    }
    (mixed / squares).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cube::body::CUBE;
    use crate::cube::rigid::Rigid;
    use crate::cube::synthetic::toss;
    use crate::cube::{median, quantile};

    /// The tosses are known, with the noise of the measured ones: 0.05 mm and half a milliradian.
    #[test]
    fn strikes_of_known_tosses_are_found_with_their_restitution_and_friction() {
        let rigid = Rigid { e: 0.4, friction: 0.2 };
        let strikes: Vec<Strike> = (0..60).filter_map(|seed| Strike::first(&toss(seed, rigid), &CUBE)).collect();
        assert!(strikes.len() > 20, "{} stand alone", strikes.len());
        let off = |value: &dyn Fn(&Strike) -> f64| quantile(strikes.iter().map(value), 0.9);
        // Velocities are exact to 0.05 mm/6.8 ms over the root of the samples, 3 mm/s of some 1 m/s, and turns to as
        // much at the corner.
        let e = off(&|strike| (strike.restitution() - rigid.e).abs());
        assert!(e < 0.02, "restitution is off by {e}");
        let sliding = strikes.iter().filter(|strike| strike.slides_on_m_s() > 0.2);
        let friction = median(sliding.map(Strike::friction));
        assert!((friction - rigid.friction).abs() < 0.01, "friction is {friction}");
        // The bound is 0.1 mm at 1 m/s.
        let late = off(&|strike| strike.late_s.abs());
        assert!(late < 3e-4, "instant strikes are late by {late} s");
        let gyration = gyration_m(&strikes);
        assert!((gyration / CUBE.gyration_m - 1.0).abs() < 0.02, "the radius of gyration is {gyration}");
    }
}
