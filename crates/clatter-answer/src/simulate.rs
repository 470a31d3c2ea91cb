//! This module follows one drop in time: its strikes, how hard they are, and how it comes to rest.
//!
//! ```
//! use clatter_answer::simulate::{self, Answer};
//! use clatter_product::{Body, Drop, Model};
//! // Mass spread evenly over 140 mm, at 4.43 m/s and a tilt of 5°.
//! let drop = Drop::new(Body::new(0.14, 0.0404)?, 4.43, 5_f64.to_radians(), 0.3);
//! let Answer::Bar(answer) = simulate::answer(&simulate::Question::new(drop, Model::FiniteTilt))? else { panic!("a bar") };
//! let first = answer.impacts.iter().next().expect("an impact");
//! assert_eq!((first.end, first.approach_m_s.0, answer.stop.reason()), ("a", -4.43, "at-rest"));
//! # Ok::<(), clatter_answer::Error>(())
//! ```

pub mod bar;
pub mod block;
pub mod plate;

use clatter_flight::{Contact, Stop};
use clatter_product::{Drop, Model};
use serde::{Serialize, Serializer};

use crate::{Error, Json};

/// A drop, and the physics that is kept of it.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Question {
    /// The drop.
    pub drop: Drop,
    /// The model, which decides the physics that are kept.
    pub model: Model,
    /// Places of a bar or a plate whose velocity shocks are requested, in half-lengths and half-widths from the middle; end a or corner a
    /// is the one that touches first.
    pub at: Vec<[f64; 2]>,
    /// Height from which it fell, where that was given.
    pub height_m: Option<f64>,
    /// The time until which the drop is followed, where that is limited.
    pub time_limit_s: Option<f64>,
    /// The largest number of strikes that are followed: 100 000 unless given, of a plate without gravity 1000.
    pub impact_limit: Option<usize>,
}

impl Question {
    /// Makes a question that follows the drop until it rests, without a place but the ends or corners.
    #[must_use]
    pub fn new(drop: Drop, model: Model) -> Self {
        Self { drop, model, at: Vec::new(), height_m: None, time_limit_s: None, impact_limit: None }
    }
}

/// A drop in time, of each body as it strikes.
#[derive(Debug, Clone, Serialize)]
#[serde(untagged)]
pub enum Answer {
    /// The drop of a bar, with two ends.
    Bar(Box<bar::Answer>),
    /// The drop of a plate, with four corners.
    Plate(Box<plate::Answer>),
    /// The drop of a box, with eight corners.
    Block(Box<block::Answer>),
}

/// Follows one drop.
///
/// # Errors
/// A place off the body, contacts of their own, and a model that does not follow the body; those of its flight.
pub fn answer(question: &Question) -> Result<Answer, Error> {
    let Question { drop, model, .. } = question;
    if !drop.own_contacts.is_none() {
        return Err(Error::input("contacts", "a drop is followed strike by strike with contacts that are alike"));
    }
    let physics = model.physics(drop)?;
    if let Some(scene) = drop.of_level()? {
        return plate::answer(question, scene, physics).map(Box::new).map(Answer::Plate);
    }
    if let Some(block) = drop.of_box()? {
        return block::answer(question, &block, physics).map(Box::new).map(Answer::Block);
    }
    bar::answer(question, physics).map(Box::new).map(Answer::Bar)
}

/// Contacts that take time.
#[derive(Debug, Clone, Copy, Serialize)]
#[non_exhaustive]
pub struct ContactAnswer {
    /// The duration of a lone contact.
    pub contact_time_s: Json,
    /// The law by which the ground acts during a contact.
    pub contact_law: &'static str,
    /// The numerical error of the energy of the body, over its energy at the first touch.
    pub energy_error: Json,
}

impl ContactAnswer {
    fn new(contact: &Contact, energy_error: f64) -> Self {
        Self {
            contact_time_s: Json(contact.time_s()),
            contact_law: contact.law().name(),
            energy_error: Json(energy_error),
        }
    }
}

#[derive(Serialize)]
struct StopJson {
    reason: &'static str,
    time_s: Json,
    #[serde(flatten)]
    rest: Option<RestJson>,
}

/// The bounds on the rest of the motion: its time, null where nothing bounds it, and its largest shock.
#[derive(Serialize)]
struct RestJson {
    time_bound_s: Option<Json>,
    shock_bound_m_s: Json,
}

fn stop<S: Serializer>(stop: &Stop, serializer: S) -> Result<S::Ok, S::Error> {
    let rest = match *stop {
        Stop::AtRest { time_bound_s, shock_bound_m_s, .. } => {
            let time_bound_s = time_bound_s.is_finite().then_some(Json(time_bound_s));
            Some(RestJson { time_bound_s, shock_bound_m_s: Json(shock_bound_m_s) })
        }
        _ => None,
    };
    StopJson { reason: stop.reason(), time_s: Json(stop.time_s()), rest }.serialize(serializer)
}

/// Returns whether a limit has ended a motion, so that a contact that still presses is not known to its end.
fn is_cut(stop: &Stop) -> bool {
    !matches!(stop, Stop::AtRest { .. } | Stop::BouncedClear { .. })
}
