//! This crate goes from a product file to verdicts: how a drop is answered, the worst drop, what each part stands.
//!
//! [`ProductFile::read`] takes the text of a file (see [`EXAMPLE`]) and tells everything that is wrong with it at once,
//! each fault where it stands. A product that is built in code obeys the same rules: [`ProductFile::check`] tells the first value that is
//! not allowed, and everything that takes a product calls it. Inside, all quantities are SI. [`answer`] is the one way from a drop to
//! a number.
//!
//! # If you have X, call Y
//! - The text of a product file: [`ProductFile::read`], then [`ProductFile::assess`].
//! - The data of a product: [`Product::new`], [`DropRanges::new`] and [`Component::new`], and from them [`ProductFile::new`].
//! - An assessment with parts that are not safe: [`ProductFile::remedies`].
//! - Distributions in place of ranges: [`scatter::Sampler`].
//! - Measured strikes, heights or accelerations: [`fit::fit`].
//! - One drop and one part: [`answer`], or [`respond`] for all its peaks.
//! - Text with units, such as "70 mm": [`units`].
//!
//! # From a file
//! ```
//! use clatter_assess::{EXAMPLE, ProductFile};
//! let file = ProductFile::read(EXAMPLE, "example.toml")?;
//! let assessment = file.assess()?;
//! assert_eq!(assessment.components.len(), file.components.len());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Built in code
//! A board on a soft mount in a handheld that falls from a meter on either end; its limit is that of the data sheet.
//! ```
//! use clatter_assess::{
//!     Component, Damping, DataFault, DropRanges, Error, Fall, Law, LimitKind, Limits, Mount, Product, ProductFile, Spread, Verdict,
//! };
//! use clatter_flight::Body;
//! let handheld = Product::new("handheld", Body::new(0.15, 0.045)?, Spread::value(0.3)?);
//! let drop = DropRanges::new(Fall::HeightM(Spread::value(1.0)?), Spread::new(0.02, 0.1, Law::Range)?);
//! let mount = Mount::Suspended { frequency_hz: Spread::value(40.0)?, damping: Damping::Ratio(Spread::value(0.05)?) };
//! let limits = Limits::default().with(LimitKind::Acceleration, Spread::value(300.0)?);
//! let board = Component::new("board", Spread::value(0.05)?, mount, limits);
//! let mut file = ProductFile::new(handheld, drop, vec![board])?;
//! assert_eq!(file.assess()?.verdict, Verdict::Unsafe);
//!
//! // What no product file may say is an error that can be matched.
//! file.product.restitution = Spread::value(1.7)?;
//! let Err(Error::Data { fault: DataFault::Value { field, value, .. }, .. }) = file.assess() else { unreachable!() };
//! assert_eq!((field, value), ("restitution", 1.7));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![cfg_attr(
    test,
    allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")
)]

mod assess;
mod attitude;
mod bound;
mod case;
mod check;
mod component;
mod data_fault;
pub mod design;
mod engine;
mod error;
mod fault;
pub mod fit;
mod history;
mod inputs;
mod keys;
pub mod ladder;
mod model;
mod portrait;
mod product;
mod quantity;
mod read;
mod reason;
mod repeat;
pub mod scatter;
mod schema;
mod search;
mod shock;
mod slip;
mod spread;
mod standard;
pub mod units;
mod verdict;
mod visible;

pub use attitude::Attitude;
pub use case::{Case, Swings};
pub use clatter_flight::{Axis, Body, ContactLaw, Drop, Feet, OwnContact, OwnContacts, Place, Side};
pub use clatter_shock::STANDARD_GRAVITY_M_S2;
pub use component::{Component, Damping, Inside, Limits, Mount};
pub use data_fault::DataFault;
pub use engine::{Answer, Part, answer, respond};
pub use error::Error;
pub use fault::{Fault, Faults};
pub use inputs::{INPUTS, Input, Optional, Row, optional_inputs};
pub use model::Model;
pub use portrait::{CornerStrike, Curve, PlaceMap, PlatePortrait, Point, Portrait};
pub use product::{DropName, DropRanges, Fall, First, Landing, Product, ProductFile, RecordFile};
pub use quantity::{Limit, LimitKind, Unit};
pub use read::{Family, GridAxis, LARGEST_FILE, Plan};
pub use reason::{Contradiction, Doubt, Note, Reason};
pub use repeat::repeat;
pub use schema::schema;
pub use search::Watch;
pub use slip::{Slip, outside, slip};
pub use spread::{Law, Spread};
pub use verdict::{
    Accuracy, Assessment, Assumed, ComponentAssessment, LandingAssessment, LandingLimit, LimitAssessment, ModelChoice,
    Sides, Verdict, WorstCase,
};
pub use visible::{visible, visible_lines};

/// A commented product file that assesses as it stands.
pub const EXAMPLE: &str = include_str!("example.toml");
