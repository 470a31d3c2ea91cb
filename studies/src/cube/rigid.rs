//! A rigid cube on rigid ground with Coulomb's friction: the study's own estimate of the effect of friction.
//!
//! Impacts take no time and happen at one corner after the other. By Newton's restitution a corner leaves with −e times the vertical velocity it
//! came with. It sticks where the impulse for that lies within the cone of friction; else it slides on, and the horizontal part of the impulse
//! is μ times the vertical one, against the sliding. With I the identity, k the radius of gyration and r the arm, an impulse j over the mass
//! changes the velocity of the corner by K j, K = I + (|r|² I − r rᵀ)/k².

use nalgebra::{Matrix3, Vector3};

use super::body::{Cube, upward};
use super::flight::State;
use super::path::{Case, Pose};

/// Restitution and coefficient of friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rigid {
    pub(super) e: f64,
    pub(super) friction: f64,
}

/// Steps between samples, and rounds over the corners of a step: halving the one or doubling the other moves paths by
/// less than 0.1 mm.
const STEP_S: f64 = 1e-4;
const ROUNDS: usize = 4;

impl Rigid {
    /// Returns the two as they are printed; friction only where there is some.
    pub(super) fn words(self) -> String {
        let friction = if self.friction > 0.0 { format!(", μ = {}", self.friction) } else { String::new() };
        format!("e = {}{friction}", self.e)
    }

    /// Returns the impulse over the mass at a corner that comes down.
    pub(super) fn impulse(self, arm: Vector3<f64>, velocity: Vector3<f64>, gyration_m: f64) -> Vector3<f64> {
        let k = gyration_m.powi(2);
        let coupling = Matrix3::identity() * (1.0 + arm.norm_squared() / k) - arm * arm.transpose() / k;
        let wanted = Vector3::new(0.0, 0.0, -self.e * velocity.z) - velocity;
        if let Some(inverse) = coupling.try_inverse() {
            let sticks = inverse * wanted;
            if sticks.xy().norm() <= self.friction * sticks.z {
                return sticks;
            }
        }
        let along = Vector3::new(velocity.x, velocity.y, 0.0).try_normalize(1e-12).unwrap_or_default();
        let direction = Vector3::z() - self.friction * along;
        direction * (wanted.z / (coupling * direction).z)
    }

    /// Returns the state after an impact at an arm.
    pub(super) fn strike(self, state: &State, arm: Vector3<f64>, cube: &Cube) -> State {
        let impulse = self.impulse(arm, state.velocity_at(arm), cube.gyration_m);
        State {
            velocity: state.velocity + impulse,
            spin: state.spin + arm.cross(&impulse) / cube.gyration_m.powi(2),
            ..*state
        }
    }

    pub(super) fn path(self, case: &Case, cube: &Cube) -> Vec<Pose> {
        let (mut state, mut now) = (case.touch, 0.0);
        let at = |time: &f64| {
            state = self.after(&state, time - now, cube);
            now = *time;
            Pose { height_m: state.place.z - cube.ground_m, upward: upward(&state.turned) }
        };
        case.times_s.iter().map(at).collect()
    }

    /// Returns the state after some time.
    pub(super) fn after(self, state: &State, time_s: f64, cube: &Cube) -> State {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "some hundred steps")]
        let steps = (time_s / STEP_S).ceil().max(1.0) as u32;
        (0..steps).fold(*state, |state, _| self.step(&state, time_s / f64::from(steps), cube))
    }

    fn step(self, state: &State, step_s: f64, cube: &Cube) -> State {
        let mut state = *state;
        let arms = cube.arms(&state.turned);
        for _ in 0..ROUNDS {
            for arm in arms {
                if state.place.z + arm.z <= cube.ground_m + 1e-9 && state.velocity_at(arm).z < 0.0 {
                    state = self.strike(&state, arm, cube);
                }
            }
        }
        state.after(step_s, cube.gravity_m_s2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cube::body::CUBE;
    use crate::cube::synthetic::numbers;

    fn energy(state: &State) -> f64 {
        state.velocity.norm_squared() + CUBE.gyration_m.powi(2) * state.spin.norm_squared()
    }

    #[test]
    fn a_corner_sticks_or_slides_by_the_laws_of_newton_and_coulomb() {
        let mut next = numbers(1);
        let (mut stuck, mut slid) = (0, 0);
        for _ in 0..1000 {
            let mut vector = |size: f64| Vector3::from_fn(|_, _| size * next());
            let turned = nalgebra::UnitQuaternion::from_scaled_axis(vector(3.0));
            let velocity = vector(1.0) - Vector3::z();
            let state = State { place: Vector3::zeros(), velocity, turned, spin: vector(4.0) };
            let arm = CUBE.arms(&turned)[CUBE.lowest(&state).0];
            let before = state.velocity_at(arm);
            if before.z >= 0.0 {
                continue;
            }
            let rigid = Rigid { e: 0.3, friction: 0.3 };
            let after = rigid.strike(&state, arm, &CUBE);
            let (velocity, impulse) = (after.velocity_at(arm), after.velocity - state.velocity);
            // The bound is some roundings of velocities of a few m/s.
            assert!((velocity.z + 0.3 * before.z).abs() < 1e-12, "restitution {}", -velocity.z / before.z);
            if velocity.xy().norm() < 1e-12 {
                stuck += 1;
                assert!(impulse.xy().norm() <= 0.3 * impulse.z + 1e-12, "sticks outside of the cone");
            } else {
                slid += 1;
                assert!((impulse.xy().norm() - 0.3 * impulse.z).abs() < 1e-12, "slides by another friction");
                assert!(impulse.xy().dot(&before.xy()) < 0.0, "pushed along");
            }
            let smooth = Rigid { e: 1.0, friction: 0.0 }.strike(&state, arm, &CUBE);
            assert!((energy(&smooth) / energy(&state) - 1.0).abs() < 1e-12, "an elastic impact keeps its energy");
        }
        assert!(stuck > 50 && slid > 300, "{stuck} stuck, {slid} slid");
    }
}
