//! This module follows drops in time: of a bar, a plate and a box.

use clatter_answer::simulate::{self as simulate_of, Answer};
use clatter_answer::{DropInputs, neat};
use clatter_product::{Drop, Model};
use pyo3::prelude::*;

use crate::answered::{Answered, Drawing, json};
use crate::bodies::{law, model};
use crate::{refused, single, work};

/// The inputs of one drop, as Python names them.
#[derive(Debug, Clone, FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Inputs {
    length_m: Option<f64>,
    width_m: Option<f64>,
    thickness_m: Option<f64>,
    gyration_m: Option<Vec<f64>>,
    center_of_mass: Option<Vec<f64>>,
    center_of_mass_m: Option<[f64; 3]>,
    e: Option<f64>,
    speed_m_s: Option<f64>,
    height_m: Option<f64>,
    tilt_deg: Option<f64>,
    direction_deg: Option<f64>,
    gaps_m: Option<[f64; 2]>,
    orientation: Option<[f64; 4]>,
    spin_rad_s: Option<Vec<f64>>,
    gravity_m_s2: Option<f64>,
    contact_time_s: Option<f64>,
    contact_law: Option<String>,
    first: Option<String>,
    flat: Option<bool>,
}

impl Inputs {
    /// Makes the drop that the inputs describe.
    pub(crate) fn drop(&self, model: Model) -> PyResult<Drop> {
        let given = self.clone();
        let is_flat = given.flat.unwrap_or(false);
        if is_flat && model == Model::Compliant {
            return Err(refused("flat goes with instant impacts: contacts that take time land flat with tilt_deg=0"));
        }
        let inputs = DropInputs {
            length_m: given.length_m,
            width_m: given.width_m,
            thickness_m: given.thickness_m,
            gyration_m: given.gyration_m,
            center_of_mass: given.center_of_mass,
            center_of_mass_m: given.center_of_mass_m,
            e: given.e,
            speed_m_s: given.speed_m_s,
            height_m: given.height_m,
            tilt_deg: given.tilt_deg,
            direction_deg: given.direction_deg,
            gaps_m: given.gaps_m,
            orientation: given.orientation,
            spin_rad_s: given.spin_rad_s,
            gravity_m_s2: given.gravity_m_s2,
            contact_time_s: given.contact_time_s,
            contact_law: given.contact_law.as_deref().map(law).transpose()?,
            first: given.first.as_deref().map(single::end).transpose()?,
            is_flat,
            ..DropInputs::default()
        };
        inputs.drop(model).map_err(refused)
    }
}

/// The largest number of rows of a motion in an answer.
const MOST_ROWS: usize = 4_000_000;
const TOO_LONG: &str =
    "the motion has more than 4 million rows: time_limit_s or impact_limit says how far it is wanted";

#[pyfunction]
pub(crate) fn simulate(
    py: Python<'_>,
    inputs: Inputs,
    model_name: &str,
    time_limit_s: Option<f64>,
    impact_limit: Option<usize>,
    at: Vec<[f64; 2]>,
    history: bool,
) -> PyResult<Answered> {
    let model = model(model_name)?;
    if model != Model::Compliant && (inputs.contact_time_s.is_some() || inputs.contact_law.is_some()) {
        return Err(refused("contact_time_s and contact_law go with model='compliant' alone"));
    }
    let drop = inputs.drop(model)?;
    if history && drop.body.is_wide() {
        return Err(refused("history is that of a bar"));
    }
    let mut question = simulate_of::Question::new(drop, model);
    question.at.clone_from(&at);
    (question.height_m, question.time_limit_s, question.impact_limit) = (inputs.height_m, time_limit_s, impact_limit);
    let (told, answer) = work::done(py, move |_| {
        let answer = simulate_of::answer(&question).map_err(|error| error.to_string())?;
        let Answer::Bar(bar) = answer else { return Ok((json(&answer)?, None)) };
        if history && bar.impacts.motion().rows().nth(MOST_ROWS).is_some() {
            return Err(TOO_LONG.to_owned());
        }
        let told = if history { json(&bar.with_history()) } else { json(&bar) };
        Ok::<_, String>((told?, Some(bar)))
    })?
    .map_err(refused)?;
    let Some(answer) = answer else { return Ok((told, None)) };
    let half_m = 500.0 * answer.length_m.0;
    let called: Vec<_> = at.iter().map(|[s, _]| format!("at {} mm", clatter_figures::three(half_m * s))).collect();
    let kept = words(model, &drop);
    let draw = move || {
        let motion = answer.impacts.motion();
        let rows: Vec<_> = motion.rows().collect();
        clatter_figures::drop(&clatter_figures::Drop {
            model: &kept,
            rows: &rows,
            strikes: &motion.strikes,
            pulses: &motion.presses,
            stop: motion.stop,
            at: &at.iter().map(|[s, _]| *s).collect::<Vec<_>>(),
            called: &called,
        })
    };
    Ok((told, Some(Drawing::new(draw))))
}

/// Describes the physics that are kept of a drop, in the words of the picture.
fn words(model: Model, drop: &Drop) -> String {
    let given = |x: f64| format!("{:?}", neat(x)).trim_end_matches(".0").to_owned();
    let gravity = given(drop.gravity_m_s2);
    match model {
        Model::Ballistic => format!("Small tilt, gravity {gravity} m/s², instant impacts"),
        Model::FiniteTilt => format!("Any tilt, gravity {gravity} m/s², instant impacts"),
        Model::Compliant => {
            let (law, time) = (drop.contact_law.name(), given(drop.contact_time_s.unwrap_or_default()));
            format!("Any tilt, gravity {gravity} m/s², {law} contacts of {time} s")
        }
        _ => "Small tilt, no gravity, instant impacts".to_owned(),
    }
}
