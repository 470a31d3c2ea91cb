//! Drops in time: of a bar, a plate and a box.

use clatter_answer::{neat, simulate as simulate_of};
use clatter_assess::Model;
use clatter_flight::{Block, BlockDrop, Contact, Model as Physics, Plate, PlateScene, Profile, Scene};
use pyo3::prelude::*;

use crate::answered::{Answered, Drawing, json};
use crate::bodies::{law, model};
use crate::{refused, work};

/// A bar that falls, in SI units.
#[derive(Debug, Clone, FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Fall {
    length_m: f64,
    gyration_m: f64,
    pub(crate) center_of_mass: f64,
    thickness_m: f64,
    e: f64,
    speed_m_s: Option<f64>,
    height_m: Option<f64>,
    pub(crate) tilt_deg: f64,
    gravity_m_s2: f64,
}

/// Rows of a motion that an answer has at most.
const MOST_ROWS: usize = 4_000_000;
const TOO_LONG: &str =
    "the motion has more than 4 million rows: time_limit_s or impact_limit says how far it is wanted";

/// A drop of a bar.
pub(crate) fn scene(fall: &Fall) -> PyResult<Scene> {
    let Fall { length_m, gyration_m, center_of_mass, thickness_m, e, tilt_deg, gravity_m_s2, .. } = *fall;
    let half = 0.5 * length_m;
    let body = Profile::off_center(half * (1.0 + center_of_mass), half * (1.0 - center_of_mass), gyration_m);
    let body = body.and_then(|body| body.with_thickness(thickness_m)).map_err(refused)?;
    match (fall.speed_m_s, fall.height_m) {
        (Some(speed), None) => Scene::new(body, e, speed, tilt_deg, gravity_m_s2),
        (None, Some(height)) => Scene::from_height(body, e, height, tilt_deg, gravity_m_s2),
        _ => return Err(refused("one of speed_m_s and height_m says how fast it comes down")),
    }
    .map_err(refused)
}

#[pyfunction]
pub(crate) fn simulate(
    py: Python<'_>,
    fall: Fall,
    model_name: &str,
    contact_time_s: Option<f64>,
    contact_law: Option<&str>,
    spin_rad_s: f64,
    time_limit_s: Option<f64>,
    impact_limit: usize,
    at: Vec<f64>,
    history: bool,
) -> PyResult<Answered> {
    let physics = match (model(model_name)?, contact_time_s) {
        (Model::Compliant, Some(time)) => {
            let law = contact_law.map_or(Ok(clatter_flight::ContactLaw::default()), law)?;
            Physics::Contacts(Contact::new(law, fall.e, time).map_err(refused)?)
        }
        (Model::Compliant, None) => return Err(refused("the drop is not whole: give contact_time_s")),
        (_, Some(_)) => return Err(refused("contact_time_s goes with model='compliant' alone")),
        _ if contact_law.is_some() => return Err(refused("contact_law goes with model='compliant' alone")),
        (Model::Ballistic, _) => Physics::Ballistic,
        (Model::FiniteTilt, _) => Physics::FiniteTilt,
        _ => Physics::Map,
    };
    let scene = scene(&fall)?.with_spin(spin_rad_s).and_then(|scene| scene.with_impact_limit(impact_limit));
    let scene = scene.and_then(|scene| time_limit_s.map_or(Ok(scene), |limit| scene.with_time_limit_s(limit)));
    let mut question = simulate_of::Question::new(scene.map_err(refused)?, physics);
    question.at.clone_from(&at);
    (question.length_m, question.tilt_deg) = (fall.length_m, fall.tilt_deg);
    (question.center_of_mass, question.height_m) = (fall.center_of_mass, fall.height_m);
    let (told, answer) = work::done(py, move |_| {
        let answer = simulate_of::answer(&question).map_err(|error| error.to_string())?;
        if history && answer.impacts.motion().rows().nth(MOST_ROWS).is_some() {
            return Err(TOO_LONG.to_owned());
        }
        let told = if history { json(&answer.with_history()) } else { json(&answer) };
        Ok::<_, String>((told?, answer))
    })?
    .map_err(refused)?;
    let called =
        at.iter().map(|s| format!("at {} mm", clatter_figures::three(500.0 * fall.length_m * s))).collect::<Vec<_>>();
    let kept = words(&physics, fall.gravity_m_s2);
    let draw = move || {
        let motion = answer.impacts.motion();
        let rows: Vec<_> = motion.rows().collect();
        clatter_figures::drop(&clatter_figures::Drop {
            model: &kept,
            rows: &rows,
            strikes: &motion.strikes,
            pulses: &motion.presses,
            stop: motion.stop,
            at: &at,
            called: &called,
        })
    };
    Ok((told, Some(Drawing::new(draw))))
}

/// What is kept of a drop, as the picture has it.
fn words(physics: &Physics, gravity_m_s2: f64) -> String {
    let given = |x: f64| format!("{x:?}").trim_end_matches(".0").to_owned();
    let gravity = given(gravity_m_s2);
    match physics {
        Physics::Map => "Small tilt, no gravity, instant impacts".to_owned(),
        Physics::Ballistic => format!("Small tilt, gravity {gravity} m/s², instant impacts"),
        Physics::FiniteTilt => format!("Any tilt, gravity {gravity} m/s², instant impacts"),
        Physics::Contacts(contact) => {
            let (law, time) = (contact.law().name(), given(contact.time_s()));
            format!("Any tilt, gravity {gravity} m/s², {law} contacts of {time} s")
        }
    }
}

#[pyfunction]
pub(crate) fn simulate_plate(
    py: Python<'_>,
    size_m: [f64; 2],
    gyration_m: [f64; 2],
    center_of_mass: [f64; 2],
    e: f64,
    speed_m_s: Option<f64>,
    height_m: Option<f64>,
    gravity_m_s2: f64,
    gaps_m: Option<[f64; 2]>,
    tilt_deg: Option<f64>,
    direction_deg: f64,
    model_name: &str,
    contact_time_s: Option<f64>,
    contact_law: Option<&str>,
    time_limit_s: Option<f64>,
    impact_limit: usize,
    at: Vec<[f64; 2]>,
) -> PyResult<Answered> {
    let edges = |half: f64, s: f64| [half * (1.0 + s), half * (1.0 - s)];
    let [[left, right], [front, back]] = [0, 1].map(|axis| edges(0.5 * size_m[axis], center_of_mass[axis]));
    let plate = Plate::new([left, right, front, back], gyration_m).map_err(refused)?;
    let speed = match (speed_m_s, height_m) {
        (Some(speed), None) => speed,
        (None, Some(height)) => (2.0 * gravity_m_s2 * height).sqrt(),
        _ => return Err(refused("one of speed_m_s and height_m says how fast it comes down")),
    };
    let gaps = match (gaps_m, tilt_deg) {
        (Some(gaps), None) => gaps,
        (None, Some(tilt)) if (0.0..=90.0).contains(&direction_deg) => {
            let [tilt, direction] = [tilt, direction_deg].map(f64::to_radians);
            let steep = libm::sin(tilt);
            [size_m[0] * steep * libm::cos(direction), size_m[1] * steep * libm::sin(direction)]
        }
        (None, Some(_)) => {
            return Err(refused(format!(
                "direction in degrees = {direction_deg:?} is not in [0, 90]: else it is not corner a that touches first"
            )));
        }
        _ => return Err(refused("one of gaps_m and tilt_deg says how it is tilted")),
    };
    let scene = PlateScene::new(plate, speed, gaps, gravity_m_s2).map(|scene| scene.with_impact_limit(impact_limit));
    let scene = scene.and_then(|scene| time_limit_s.map_or(Ok(scene), |limit| scene.with_time_limit_s(limit)));
    let model = match (model_name, contact_time_s) {
        ("map", None) if contact_law.is_none() => simulate_of::plate::Model::Map { e },
        ("ballistic", None) if contact_law.is_none() => simulate_of::plate::Model::Ballistic { e },
        ("map" | "ballistic", _) => {
            return Err(refused("contact_time_s and contact_law go with model='compliant' alone"));
        }
        ("compliant", Some(time)) => {
            let law = contact_law.map_or(Ok(clatter_flight::ContactLaw::default()), law)?;
            simulate_of::plate::Model::Contacts(Contact::new(law, e, time).map_err(refused)?)
        }
        ("compliant", None) => return Err(refused("the drop is not whole: give contact_time_s")),
        _ => return Err(refused("a plate is followed by model='map', without gravity, 'ballistic' or 'compliant'")),
    };
    let mut question = simulate_of::plate::Question::new(scene.map_err(refused)?, model);
    (question.at, question.height_m, question.center_of_mass) = (at, height_m, center_of_mass);
    // As it was given, else without the digits that the sines add.
    (question.tilt_deg, question.direction_deg) = match tilt_deg {
        Some(tilt) => (tilt, (tilt > 0.0).then_some(direction_deg)),
        None => (neat(question.tilt_deg), question.direction_deg.map(neat)),
    };
    let told =
        work::done(py, move |_| json(&simulate_of::plate::answer(&question).map_err(|error| error.to_string())?));
    Ok((told?.map_err(refused)?, None))
}

#[pyfunction]
pub(crate) fn simulate_box(
    py: Python<'_>,
    size_m: [f64; 3],
    gyration_m: [f64; 3],
    center_of_mass_m: [f64; 3],
    e: f64,
    speed_m_s: Option<f64>,
    height_m: Option<f64>,
    gravity_m_s2: f64,
    orientation: Option<[f64; 4]>,
    tilt_deg: Option<f64>,
    direction_deg: f64,
    spin_rad_s: [f64; 3],
    contact_time_s: f64,
    contact_law: Option<&str>,
    time_limit_s: Option<f64>,
    impact_limit: usize,
) -> PyResult<Answered> {
    let block = Block::new(size_m, center_of_mass_m, gyration_m).map_err(refused)?;
    let speed = match (speed_m_s, height_m) {
        (Some(speed), None) => speed,
        (None, Some(height)) => (2.0 * gravity_m_s2 * height).sqrt(),
        _ => return Err(refused("one of speed_m_s and height_m says how fast it comes down")),
    };
    let drop = match (orientation, tilt_deg) {
        (Some(orientation), None) => BlockDrop::new(block, orientation, speed, gravity_m_s2),
        (None, Some(tilt)) => {
            let [tilt, direction] = [tilt, direction_deg].map(f64::to_radians);
            BlockDrop::tilted(block, tilt, direction, speed, gravity_m_s2)
        }
        _ => return Err(refused("one of orientation and tilt_deg says how the box is turned")),
    };
    let drop = drop.and_then(|drop| drop.with_spin(spin_rad_s)).map(|drop| drop.with_impact_limit(impact_limit));
    let drop = drop.and_then(|drop| time_limit_s.map_or(Ok(drop), |limit| drop.with_time_limit_s(limit)));
    let law = contact_law.map_or(Ok(clatter_flight::ContactLaw::default()), law)?;
    let contact = Contact::new(law, e, contact_time_s).map_err(refused)?;
    let question = simulate_of::block::Question::new(drop.map_err(refused)?, contact);
    let told =
        work::done(py, move |_| json(&simulate_of::block::answer(&question).map_err(|error| error.to_string())?));
    Ok((told?.map_err(refused)?, None))
}
