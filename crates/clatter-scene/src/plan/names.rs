//! Rungs and quantities by name, in tables and in JSON.

use serde::{Serialize, Serializer};

use super::{BarRung, ComponentRung, Quantity};

impl Quantity {
    /// `peak-acceleration`, `rattle-space` or `velocity-shock`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::PeakAcceleration => "peak-acceleration",
            Self::RattleSpace => "rattle-space",
            Self::VelocityShock => "velocity-shock",
        }
    }
}

impl BarRung {
    /// From the cheapest.
    pub const ALL: [Self; 5] = [Self::ClosedForm, Self::Map, Self::Ballistic, Self::FiniteTilt, Self::Compliant];

    /// `closed-form`, `map`, `ballistic`, `finite-tilt` or `compliant`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::ClosedForm => "closed-form",
            Self::Map => "map",
            Self::Ballistic => "ballistic",
            Self::FiniteTilt => "finite-tilt",
            Self::Compliant => "compliant",
        }
    }
}

impl ComponentRung {
    /// From the cheapest.
    pub const ALL: [Self; 4] = [Self::NetChange, Self::LargestShock, Self::ImpulseTrain, Self::PulseTrain];

    /// `net-change`, `largest-shock`, `impulse-train` or `pulse-train`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::NetChange => "net-change",
            Self::LargestShock => "largest-shock",
            Self::ImpulseTrain => "impulse-train",
            Self::PulseTrain => "pulse-train",
        }
    }
}

impl Serialize for Quantity {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

impl Serialize for BarRung {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

impl Serialize for ComponentRung {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}
