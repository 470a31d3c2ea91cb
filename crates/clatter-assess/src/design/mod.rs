//! The design method for a product: what would make each failing part safe, and which (q, e) would.

mod lever;
mod plane;
mod remedies;
mod trial;
mod values;

pub use lever::{Bounds, Change, Lever, Outcome, Remedies, Remedy, Together};
pub use plane::{Border, Plane, PlaneComponent};
pub use remedies::{STEPS, remedies, remedies_watched};
pub use trial::least_margin;
