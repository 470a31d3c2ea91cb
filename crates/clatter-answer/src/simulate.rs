//! One drop in time: its strikes, how hard they are, and how it comes to rest.
//!
//! ```
//! use clatter_answer::simulate::{self, Answer};
//! use clatter_assess::{Body, Drop, Model};
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

use clatter_assess::{Drop, Model};
use clatter_flight::{Contact, Stop};
use serde::{Serialize, Serializer};

use crate::{Error, Json};

/// A drop, and the physics that is kept of it.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Question {
    /// The drop.
    pub drop: Drop,
    /// What is kept of it.
    pub model: Model,
    /// Places of a bar or a plate whose velocity shocks are asked for, in half-lengths and half-widths from the middle, seen so that what
    /// touches first is end a or corner a.
    pub at: Vec<[f64; 2]>,
    /// Height from which it fell, where that was given.
    pub height_m: Option<f64>,
    /// Until when it is followed, where that is limited.
    pub time_limit_s: Option<f64>,
    /// Strikes that are followed at most: 100 000 unless given, of a plate without gravity 1000.
    pub impact_limit: Option<usize>,
}

impl Question {
    /// Until it rests, without a place but its ends or corners.
    #[must_use]
    pub fn new(drop: Drop, model: Model) -> Self {
        Self { drop, model, at: Vec::new(), height_m: None, time_limit_s: None, impact_limit: None }
    }
}

/// A drop in time, of each body as it strikes.
#[derive(Debug, Clone, Serialize)]
#[serde(untagged)]
pub enum Answer {
    /// Strikes of two ends.
    Bar(Box<bar::Answer>),
    /// Of four corners.
    Plate(Box<plate::Answer>),
    /// Of eight corners.
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
    /// Of a lone contact.
    pub contact_time_s: Json,
    /// What the ground does meanwhile.
    pub contact_law: &'static str,
    /// What the energy of the body changes by without reason, over that at the first touch.
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

/// What is left takes no longer, null where nothing bounds it, and no shock left out is larger.
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

/// Whether a limit has ended a motion, so that a contact that still presses is not known to its end.
fn is_cut(stop: &Stop) -> bool {
    !matches!(stop, Stop::AtRest { .. } | Stop::BouncedClear { .. })
}
