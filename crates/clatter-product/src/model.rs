//! Models of a drop, from the least physics to the most.

use clatter_flight::{Contact, Drop, Model as Physics};
use serde::{Deserialize, Serialize};

use crate::Error;

/// The model that answers a drop: from the least physics to the most.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Model {
    /// In closed form, small tilt and no gravity: the whole clatter as one change of velocity. A part that is slow compared with it
    /// responds to no more.
    NetChange,
    /// In closed form, likewise: the largest velocity shock alone. A damped part that is fast compared with the gaps responds to no more.
    LargestShock,
    /// Instant impacts, strike by strike, small tilt, no gravity.
    Map,
    /// With gravity.
    Ballistic,
    /// With gravity and exact geometry.
    FiniteTilt,
    /// With contacts that take time.
    Compliant,
}

impl Model {
    /// The models that follow a drop strike by strike.
    pub const FOLLOWED: [Self; 4] = [Self::Map, Self::Ballistic, Self::FiniteTilt, Self::Compliant];
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::NetChange, Self::LargestShock, Self::Map, Self::Ballistic, Self::FiniteTilt, Self::Compliant];
    /// Returns the name: `net-change`, `largest-shock`, `map`, `ballistic`, `finite-tilt` or `compliant`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::NetChange => "net-change",
            Self::LargestShock => "largest-shock",
            Self::Map => "map",
            Self::Ballistic => "ballistic",
            Self::FiniteTilt => "finite-tilt",
            Self::Compliant => "compliant",
        }
    }
    /// Returns the model with the most physics that the data of a drop allow: contacts where their time is known, else real tilt.
    #[must_use]
    pub fn fullest(drop: &Drop) -> Self {
        if drop.contact_time_s.is_some() { Self::Compliant } else { Self::FiniteTilt }
    }
    /// Returns the physics that a flight keeps of a drop; of a closed form that of the map.
    ///
    /// # Errors
    /// [`Error::OwnContacts`] of instant impacts, [`Error::Contact`] for contacts whose time is not known or is none.
    pub fn physics(self, drop: &Drop) -> Result<Physics, Error> {
        if self != Self::Compliant && !drop.own_contacts.is_none() {
            return Err(Error::OwnContacts(self));
        }
        Ok(match self {
            Self::NetChange | Self::LargestShock | Self::Map => Physics::Map,
            Self::Ballistic => Physics::Ballistic,
            Self::FiniteTilt => Physics::FiniteTilt,
            Self::Compliant => {
                let time_s = drop.contact_time_s.ok_or(Error::Contact)?;
                Physics::Contacts(Contact::new(drop.contact_law, drop.restitution, time_s)?)
            }
        })
    }
}
