//! Known tosses, for tests.

use nalgebra::{UnitQuaternion, Vector3};

use super::body::CUBE;
use super::flight::State;
use super::rigid::Rigid;
use super::tosses::{Pose, Toss};

/// Returns numbers in [−1, 1], the same for the same seed: a linear congruential generator, of which the upper bits
/// count.
pub(super) fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x1234_5678_9abc_def1;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        f64::from(u32::try_from(state >> 32).unwrap_or(0)) / f64::from(u32::MAX) * 2.0 - 1.0
    }
}

/// Returns a toss of the published cube that flies and strikes by a known law, with the noise of the measured ones.
pub(super) fn toss(seed: u64, rigid: Rigid) -> Toss {
    let mut next = numbers(seed);
    let mut vector = |size: f64| Vector3::from_fn(|_, _| size * next());
    let mut state = State {
        place: Vector3::new(0.0, 0.0, 0.15),
        velocity: Vector3::new(1.1, 0.3, 0.0) + vector(0.2),
        turned: UnitQuaternion::from_scaled_axis(vector(3.0)),
        spin: vector(4.0),
    };
    let mut poses = Vec::new();
    for _ in 0..60 {
        let turned = UnitQuaternion::from_scaled_axis(vector(5e-4)) * state.turned;
        poses.push(Pose { turned, place: state.place + vector(5e-5) });
        state = rigid.after(&state, 1.0 / CUBE.rate_hz, &CUBE);
    }
    Toss { number: 0, rest: poses[59], poses }
}
