//! Measured tosses of a cube, and of a square: predictions of the box of the product compared with other models, and
//! the effect of friction.

mod body;
mod compare;
mod flight;
mod page;
mod path;
mod rigid;
mod strike;
mod study;
#[cfg(test)]
mod synthetic;
mod tosses;

use path::Case;
use serde_json::json;
use study::Study;

use crate::Error;
pub(crate) use page::files;
pub use page::numbers;

/// 109 tosses of DAIRLab/dair_pll, as `studies/data/cube.py` has trimmed them.
const TOSSES: &str = include_str!("../data/cube.csv");

/// 118 of the tosses of DAIRLab/ImpactModeling, as `studies/data/square.py` has written them.
const SQUARES: &str = include_str!("../data/square.csv");

/// Returns the quantile of values, interpolated linearly between neighbors.
pub(crate) fn quantile(values: impl IntoIterator<Item = f64>, share: f64) -> f64 {
    let mut values: Vec<f64> = values.into_iter().collect();
    values.sort_by(f64::total_cmp);
    #[expect(
        clippy::cast_precision_loss,
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "some hundred values"
    )]
    let (place, below) = {
        let place = share * (values.len() - 1) as f64;
        (place.fract(), place as usize)
    };
    let above = values[(below + 1).min(values.len() - 1)];
    values[below] + place * (above - values[below])
}

fn median(values: impl IntoIterator<Item = f64>) -> f64 {
    quantile(values, 0.5)
}

/// Returns the state of each toss at its first touch, and the cube at the samples after it: the input of
/// `peers/cube.py` for other tools.
///
/// # Errors
/// [`Error::Data`] if the file of tosses is torn.
pub fn touches() -> Result<String, Error> {
    let study = Study::new(tosses::read(TOSSES)?, &body::CUBE);
    let cube = study.cube;
    let case = |case: &Case| {
        let touch = &case.touch;
        let turned = touch.turned.quaternion();
        json!({
            "toss": case.number, "training": case.training, "height_m": touch.place.z - cube.ground_m,
            "velocity_m_s": touch.velocity.as_slice(), "turned": [turned.w, turned.i, turned.j, turned.k],
            "spin_rad_s": touch.spin.as_slice(), "times_s": case.times_s,
            "measured": case.measured.iter().map(|pose| [pose.height_m, pose.upward.x, pose.upward.y, pose.upward.z]).collect::<Vec<_>>(),
        })
    };
    let all = json!({
        "half_m": cube.half_m, "gravity_m_s2": cube.gravity_m_s2, "gyration_m": cube.gyration_m,
        "tosses": study.cases.iter().map(case).collect::<Vec<_>>(),
    });
    serde_json::to_string(&all).map_err(|error| Error::Data(error.to_string()))
}
