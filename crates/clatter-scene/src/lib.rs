//! From a product file to verdicts: which models the scene needs, the worst drop, what each part stands.
//!
//! [`ProductFile::read`] takes the text of a file (see [`EXAMPLE`]) and tells everything that is wrong with it at once,
//! each fault where it stands. Inside, all quantities are SI.

mod accuracy;
mod assess;
mod base;
mod demand;
mod error;
pub mod explain;
mod fault;
mod guaranteed;
mod keys;
mod loose_train;
mod models;
pub mod plan;
mod portrait;
mod product;
mod read;
mod schema;
mod search;
mod spread;
mod units;
mod verdict;

pub mod design;
pub mod scatter;
pub mod tradeoff;

pub use accuracy::Accuracy;
pub use base::{Base, SingleDrop};
pub use clatter_shock::STANDARD_GRAVITY_M_S2;
pub use error::Error;
pub use fault::{Fault, Faults};
pub use portrait::{Curve, Portrait};
pub use product::{Boundary, Component, Drop, Fall, First, Limits, Mount, Product, ProductFile};
pub use read::LARGEST_FILE;
pub use schema::schema;
pub use spread::{Law, Spread};
pub use verdict::{
    Assessment, BarModel, ComponentAssessment, ComponentModel, LimitAssessment, LimitKind, ModelChoice, Unit, Verdict,
    WorstCase,
};

/// A commented product file that assesses as it stands.
pub const EXAMPLE: &str = include_str!("example.toml");
