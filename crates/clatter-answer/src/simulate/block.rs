//! This module follows one drop of a box in time, in any orientation, with contacts that take time.

use clatter_flight::{Block, BlockDrop, BlockStrike, Contact, Model as Physics, Stop};
use serde::{Serialize, Serializer};

use super::{Question, is_cut};
use crate::{Error, Json, neat};

/// A drop of a box in time.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Answer {
    /// The drop.
    #[serde(flatten)]
    pub drop: DropAnswer,
    /// The law by which the ground acts while a corner touches.
    pub contact_law: &'static str,
    /// The numerical error of the energy of the body, over its energy at the first touch.
    pub energy_error: Json,
    /// The presses, in the order of their touches.
    pub impacts: Vec<Impact>,
    /// The reason why the motion ends.
    #[serde(serialize_with = "stop")]
    pub stop: Stop,
}

/// The inputs of a drop of a box.
#[derive(Debug, Clone, Copy, Serialize)]
#[non_exhaustive]
pub struct DropAnswer {
    /// The model of the drop: contacts that take time.
    pub model: &'static str,
    /// Length, width and thickness.
    pub size_m: [Json; 3],
    /// The radii of gyration about the axes of the box through its center of mass.
    pub gyration_m: [Json; 3],
    /// The position of the center of mass from the middle.
    pub center_of_mass_m: [Json; 3],
    /// Coefficient of restitution.
    pub e: Json,
    /// The speed at the first touch.
    pub speed_m_s: Json,
    /// The vertical in axes of the box.
    pub upward: [Json; 3],
    /// The angular velocities about the axes of the box.
    pub spin_rad_s: [Json; 3],
    /// The acceleration of gravity.
    pub gravity_m_s2: Json,
    /// The duration of a lone contact.
    pub contact_time_s: Json,
}

impl DropAnswer {
    /// Takes the reported inputs from a drop and its contact.
    #[must_use]
    pub fn new(drop: &BlockDrop, contact: &Contact) -> Self {
        let block = drop.block();
        Self {
            model: "compliant",
            size_m: block.size_m().map(|side| Json(neat(side))),
            gyration_m: block.gyration_m().map(|radius| Json(neat(radius))),
            center_of_mass_m: block.center_of_mass_m().map(|center| Json(neat(center))),
            e: Json(contact.restitution()),
            speed_m_s: Json(drop.speed_m_s()),
            upward: drop.upward().map(Json),
            spin_rad_s: drop.spin_rad_s().map(Json),
            gravity_m_s2: Json(drop.gravity_m_s2()),
            contact_time_s: Json(contact.time_s()),
        }
    }
}

/// The reason for the end of the motion of a box, and its time.
#[derive(Debug, Clone, Copy, Serialize)]
#[non_exhaustive]
pub struct StopAnswer {
    /// The reason, by the name of [`Stop::reason`].
    pub reason: &'static str,
    /// The time since the first touch.
    pub time_s: Json,
    /// The bound on the change of a velocity by any later press; at rest alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shock_bound_m_s: Option<Json>,
}

impl StopAnswer {
    /// Takes the reported end from the stop of a motion.
    #[must_use]
    pub fn new(stop: &Stop) -> Self {
        let bound = if let Stop::AtRest { shock_bound_m_s, .. } = stop { Some(Json(*shock_bound_m_s)) } else { None };
        Self { reason: stop.reason(), time_s: Json(stop.time_s()), shock_bound_m_s: bound }
    }
}

fn stop<S: Serializer>(stop: &Stop, serializer: S) -> Result<S::Ok, S::Error> {
    StopAnswer::new(stop).serialize(serializer)
}

/// One press of a corner.
#[derive(Debug, Clone, Copy, Serialize)]
#[non_exhaustive]
pub struct Impact {
    /// The number of the press, from 1.
    pub number: u64,
    /// The signs of x, y and z.
    pub corner: &'static str,
    /// The time at which the corner touches.
    pub time_s: Json,
    /// Vertical velocity of the corner as it touches.
    pub approach_m_s: Json,
    /// Vertical velocity shocks of corners ---, +--, -+-, ++-, --+, +-+, -++, +++; none where a limit has cut off the contact.
    pub delta_v_m_s: [Option<Json>; 8],
    /// The time at which the corner parts from the ground; infinite where it stays down.
    pub until_s: Json,
    /// Its index among the corners.
    #[serde(skip)]
    pub index: usize,
}

impl Impact {
    /// Returns whether a limit has cut off the contact.
    #[must_use]
    pub fn is_unfinished(&self) -> bool {
        self.delta_v_m_s[self.index].is_none()
    }
    /// Returns the largest shock of a corner, 0 where it is not known.
    #[must_use]
    pub fn largest_m_s(&self) -> f64 {
        self.delta_v_m_s.into_iter().flatten().fold(0.0, |most: f64, v| most.max(v.0.abs()))
    }
}

/// Follows one drop of a box.
pub(super) fn answer(question: &Question, drop: &BlockDrop, physics: Physics) -> Result<Answer, Error> {
    let Physics::Contacts(contact) = physics else {
        let how = "a box is followed with contacts that take time alone: compliant, with a short contact time";
        return Err(Error::input("model", how));
    };
    if !question.at.is_empty() {
        return Err(Error::input(
            "at",
            "places are those of a bar and a plate; 'clatter respond' answers one of a box",
        ));
    }
    let drop = question.impact_limit.map_or(*drop, |limit| drop.with_impact_limit(limit));
    let drop = question.time_limit_s.map_or(Ok(drop), |limit_s| drop.with_time_limit_s(limit_s))?;
    let flight = drop.contacts(&contact, |_| ())?;
    let impact = |strike: &BlockStrike| {
        let unfinished = is_cut(&flight.stop) && strike.until_s.is_infinite();
        Impact {
            number: strike.number,
            corner: Block::corner_name(strike.corner),
            time_s: Json(strike.time_s),
            approach_m_s: Json(strike.approach_m_s),
            delta_v_m_s: strike.delta_v_m_s.map(|v| (!unfinished).then_some(Json(v))),
            until_s: Json(strike.until_s),
            index: strike.corner,
        }
    };
    Ok(Answer {
        drop: DropAnswer::new(&drop, &contact),
        contact_law: contact.law().name(),
        energy_error: Json(flight.energy_error),
        impacts: flight.strikes.iter().map(impact).collect(),
        stop: flight.stop,
    })
}
