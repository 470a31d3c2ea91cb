//! This module follows drops in time: of a bar, a plate and a box.

use clatter_answer::simulate as simulate_of;
use clatter_answer::{DropInputs, neat};
use clatter_product::Model;
use pyo3::prelude::*;

use crate::answered::{Answered, Drawing, json};
use crate::bodies::Places;
use crate::given::Given;
use crate::single::LISTED;
use crate::{refused, words, work};

/// Reads the inputs of one drop, as Python names them.
pub(crate) fn inputs(given: &Given<'_>) -> PyResult<DropInputs> {
    Ok(DropInputs {
        length_m: given.read("length_m")?,
        width_m: given.read("width_m")?,
        thickness_m: given.read("thickness_m")?,
        gyration_m: given.read("gyration_m")?,
        center_of_mass: given.read("center_of_mass")?,
        center_of_mass_m: given.read("center_of_mass_m")?,
        e: given.read("e")?,
        speed_m_s: given.read("speed_m_s")?,
        height_m: given.read("height_m")?,
        tilt_deg: given.read("tilt_deg")?,
        direction_deg: given.read("direction_deg")?,
        gaps_m: given.read("gaps_m")?,
        orientation: given.read("orientation")?,
        spin_rad_s: given.read("spin_rad_s")?,
        gravity_m_s2: given.read("gravity_m_s2")?,
        contact_time_s: given.read("contact_time_s")?,
        contact_law: given.read("contact_law")?,
        friction: given.read("friction")?,
        first: given.read("first")?,
        is_flat: given.read::<Option<bool>>("flat")?.unwrap_or_default(),
        ..DropInputs::default()
    })
}

const TOO_LONG: &str =
    "the motion has more than a million rows: time_limit_s or impact_limit says how far it is wanted";

#[pyfunction]
pub(crate) fn simulate(py: Python<'_>, given: Given<'_>) -> PyResult<Answered> {
    let (model, inputs) = (given.read("model")?, inputs(&given)?);
    let (at, history) = (given.read::<Places>("at")?.of_any(), given.read("history")?);
    let time_limit_s = given.read("time_limit_s")?;
    let impact_limit = given.whole_if_given("impact_limit", 1..=LISTED as u64)?;
    given.done()?;
    if model != Model::Compliant && (inputs.contact_time_s.is_some() || inputs.contact_law.is_some()) {
        return Err(refused("contact_time_s and contact_law go with model='compliant' alone"));
    }
    let drop = inputs.drop(model).map_err(refused)?;
    if history && drop.body.is_wide() {
        return Err(refused("history is that of a bar"));
    }
    let mut question = simulate_of::Question::new(drop, model);
    question.at = at.iter().map(|[x, y]| [*x, *y, 0.0]).collect();
    (question.time_limit_s, question.impact_limit) = (time_limit_s, impact_limit);
    let (told, motion) = work::done(py, move |_| {
        let answer = simulate_of::answer(&question).map_err(words)?;
        let motion = answer.impacts.train().motion();
        if history && motion.is_some_and(|motion| motion.rows().nth(LISTED).is_some()) {
            return Err(TOO_LONG.to_owned());
        }
        let told = if history { json(&answer.with_history()) } else { json(&answer) };
        Ok::<_, String>((told?, motion.cloned()))
    })?
    .map_err(refused)?;
    let Some(motion) = motion else { return Ok((told, None)) };
    let half_m = 500.0 * drop.body.length_m();
    let called: Vec<_> = at.iter().map(|[s, _]| format!("at {} mm", clatter_figures::three(half_m * s))).collect();
    let number = |x: f64| format!("{:?}", neat(x)).trim_end_matches(".0").to_owned();
    let kept =
        simulate_of::physics_in_words(&drop, model, |g| format!("{} m/s²", number(g)), |s| format!("{} s", number(s)));
    let draw = move || {
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
