//! One drop of a box in time, in any orientation, with contacts that take time.
//!
//! ```
//! use clatter_answer::simulate::block;
//! use clatter_flight::{Block, BlockDrop, Contact, ContactLaw};
//! // A handheld of 150 by 70 by 15 mm lands on its long edge.
//! let handheld = Block::new([0.15, 0.07, 0.015], [0.0; 3], [0.0207, 0.0435, 0.0478])?;
//! let drop = BlockDrop::new(handheld, [0.923_879_532_511_286_7, 0.382_683_432_365_089_8, 0.0, 0.0], 4.43, 9.806_65)?;
//! let contact = Contact::new(ContactLaw::Hysteretic, 0.3, 1e-3)?;
//! let answer = block::answer(&block::Question::new(drop, contact))?;
//! assert_eq!((answer.impacts[0].number, answer.stop.reason()), (1, "at-rest"));
//! # Ok::<(), clatter_flight::Error>(())
//! ```

use clatter_flight::{Block, BlockDrop, BlockStrike, Contact, Error, Stop};
use serde::{Serialize, Serializer};

use super::is_cut;
use crate::Json;

/// A drop of a box and its contacts.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct Question {
    /// The drop.
    pub drop: BlockDrop,
    /// Of each corner.
    pub contact: Contact,
}

impl Question {
    /// All that is asked.
    #[must_use]
    pub fn new(drop: BlockDrop, contact: Contact) -> Self {
        Self { drop, contact }
    }
}

/// A drop of a box in time.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Answer {
    /// The drop.
    #[serde(flatten)]
    pub drop: DropAnswer,
    /// What the ground does while a corner touches.
    pub contact_law: &'static str,
    /// What the energy of the body changes by without reason, over that at the first touch.
    pub energy_error: Json,
    /// The presses, in the order of their touches.
    pub impacts: Vec<Impact>,
    /// Why the motion ends.
    #[serde(serialize_with = "stop")]
    pub stop: Stop,
}

/// What a drop of a box is.
#[derive(Debug, Clone, Copy, Serialize)]
#[non_exhaustive]
pub struct DropAnswer {
    /// What was kept of it: contacts that take time.
    pub model: &'static str,
    /// Length, width and thickness.
    pub size_m: [Json; 3],
    /// About the axes of the box through its center of mass.
    pub gyration_m: [Json; 3],
    /// From the middle.
    pub center_of_mass_m: [Json; 3],
    /// Coefficient of restitution.
    pub e: Json,
    /// At the first touch.
    pub speed_m_s: Json,
    /// The vertical in axes of the box.
    pub upward: [Json; 3],
    /// About the axes of the box.
    pub spin_rad_s: [Json; 3],
    /// Of gravity.
    pub gravity_m_s2: Json,
    /// Of a lone contact.
    pub contact_time_s: Json,
}

impl DropAnswer {
    /// A drop as it is told.
    #[must_use]
    pub fn new(drop: &BlockDrop, contact: &Contact) -> Self {
        let block = drop.block();
        Self {
            model: "compliant",
            size_m: block.size_m().map(Json),
            gyration_m: block.gyration_m().map(Json),
            center_of_mass_m: block.center_of_mass_m().map(Json),
            e: Json(contact.restitution()),
            speed_m_s: Json(drop.speed_m_s()),
            upward: drop.upward().map(Json),
            spin_rad_s: drop.spin_rad_s().map(Json),
            gravity_m_s2: Json(drop.gravity_m_s2()),
            contact_time_s: Json(contact.time_s()),
        }
    }
}

/// Why and when the motion of a box ends.
#[derive(Debug, Clone, Copy, Serialize)]
#[non_exhaustive]
pub struct StopAnswer {
    /// As [`Stop::reason`] calls it.
    pub reason: &'static str,
    /// Since the first touch.
    pub time_s: Json,
    /// At rest alone: no later press changes a velocity by more.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shock_bound_m_s: Option<Json>,
}

impl StopAnswer {
    /// The end of a motion as it is told.
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
    /// From 1.
    pub number: u64,
    /// The signs of x, y and z.
    pub corner: &'static str,
    /// When it touches.
    pub time_s: Json,
    /// Vertical velocity of the corner as it touches.
    pub approach_m_s: Json,
    /// Vertical velocity shocks of corners ---, +--, -+-, ++-, --+, +-+, -++, +++; none where a limit has cut off the contact.
    pub delta_v_m_s: [Option<Json>; 8],
    /// When it parts, infinite where the corner stays down.
    pub until_s: Json,
    /// Its index among the corners.
    #[serde(skip)]
    pub index: usize,
}

impl Impact {
    /// Whether a limit has cut off the contact.
    #[must_use]
    pub fn is_unfinished(&self) -> bool {
        self.delta_v_m_s[self.index].is_none()
    }
    /// The largest shock of a corner, 0 where it is not known.
    #[must_use]
    pub fn largest_m_s(&self) -> f64 {
        self.delta_v_m_s.into_iter().flatten().fold(0.0, |most: f64, v| most.max(v.0.abs()))
    }
}

/// Follows one drop.
///
/// # Errors
/// Those of [`BlockDrop::contacts`].
pub fn answer(question: &Question) -> Result<Answer, Error> {
    let Question { drop, contact } = question;
    let flight = drop.contacts(contact, |_| ())?;
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
        drop: DropAnswer::new(drop, contact),
        contact_law: contact.law().name(),
        energy_error: Json(flight.energy_error),
        impacts: flight.strikes.iter().map(impact).collect(),
        stop: flight.stop,
    })
}
