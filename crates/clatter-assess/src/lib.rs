//! From a product file to verdicts: how a drop is answered, the worst drop, what each part stands.
//!
//! [`ProductFile::read`] takes the text of a file (see [`EXAMPLE`]) and tells everything that is wrong with it at once,
//! each fault where it stands. Inside, all quantities are SI. [`answer`] is the one way from a drop to a number.

mod assess;
mod bound;
mod check;
mod data_fault;
pub mod design;
mod drop;
mod engine;
mod error;
mod fault;
pub mod fit;
mod history;
mod keys;
pub mod ladder;
mod portrait;
mod product;
mod quantity;
mod read;
mod repeat;
pub mod scatter;
mod schema;
mod search;
mod shock;
mod slip;
mod spread;
pub mod units;
mod verdict;
mod visible;

pub use clatter_flight::ContactLaw;
pub use clatter_shock::STANDARD_GRAVITY_M_S2;
pub use data_fault::DataFault;
pub use drop::{Model, SingleDrop};
pub use engine::{Answer, Part, answer, respond};
pub use error::Error;
pub use fault::{Fault, Faults};
pub use portrait::{Changes, Curve, Point, Portrait};
pub use product::{Boundary, Component, Damping, Drop, Fall, First, Limits, Mount, Product, ProductFile, RecordFile};
pub use quantity::{Limit, LimitKind, Unit};
pub use read::LARGEST_FILE;
pub use repeat::repeat;
pub use schema::schema;
pub use search::Watch;
pub use slip::{Slip, outside, slip};
pub use spread::{Law, Spread};
pub use verdict::{Accuracy, Assessment, ComponentAssessment, LimitAssessment, ModelChoice, Verdict, WorstCase};
pub use visible::{visible, visible_lines};

/// A commented product file that assesses as it stands.
pub const EXAMPLE: &str = include_str!("example.toml");
