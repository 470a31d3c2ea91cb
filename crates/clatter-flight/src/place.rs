//! Places on a body.

use serde::{Deserialize, Serialize};

/// The axis of a box along which a part moves and is shaken. A product file that names none means the magnitude of a part that is
/// mounted rigidly in a box, and the thickness else.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Axis {
    /// Along the length.
    X,
    /// Along the width.
    Y,
    /// Along the thickness, as every part of a bar and of a plate.
    #[default]
    Z,
    /// Along the blow: the magnitude, of a part that is mounted rigidly.
    Any,
}

impl Axis {
    /// Returns the axis of a name.
    #[must_use]
    pub fn of(name: &str) -> Option<Self> {
        [Self::X, Self::Y, Self::Z, Self::Any].into_iter().find(|axis| axis.name() == name)
    }
    /// `x`, `y`, `z` or `any`.
    #[must_use]
    pub fn name(self) -> &'static str {
        ["x", "y", "z", "any"][self as usize]
    }
}

/// A place on a body, and the axis along which a part there moves.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Place {
    /// From the middle of the body: along it towards end b, across it, and in its thickness; what a body does not have is 0.
    pub at_m: [f64; 3],
    /// Along which axis a part moves there.
    pub axis: Axis,
}

impl Place {
    /// A place from the middle, of a part that moves along the thickness.
    #[must_use]
    pub fn new(at_m: [f64; 3]) -> Self {
        Self { at_m, axis: Axis::Z }
    }
    /// The same in the plane of a bar or of a plate.
    #[must_use]
    pub fn flat([x, y]: [f64; 2]) -> Self {
        Self::new([x, y, 0.0])
    }
    /// Along the body and across it.
    #[must_use]
    pub fn plan_m(&self) -> [f64; 2] {
        [self.at_m[0], self.at_m[1]]
    }
}
