//! This crate goes from a product file to a product, its drops and its fragile parts.
//!
//! [`ProductFile::read`] takes the text of a file (see [`EXAMPLE`]) and tells everything that is wrong with it at once,
//! each fault where it stands. A product that is built in code obeys the same rules: [`ProductFile::check`] tells the first value that is
//! not allowed. Inside, all quantities are SI. What a drop takes is a row of [`INPUTS`], what a part stands a row of [`LimitKind`].
//!
//! # If you have X, call Y
//! - The text of a product file: [`ProductFile::read`].
//! - The data of a product: [`Product::new`], [`DropRanges::new`] and [`Component::new`], and from them [`ProductFile::new`].
//! - A grid of products: [`Plan::read`] and [`Plan::family`].
//! - Text with units, such as "70 mm": [`units`].
//!
//! # Built in code
//! A board on a soft mount in a handheld that falls from a meter on either end; its limit is that of the data sheet.
//! ```
//! use clatter_product::{
//!     Body, Component, Damping, DataFault, DropRanges, Error, Fall, Law, LimitKind, Limits, Mount, Product, ProductFile, Spread,
//! };
//! let handheld = Product::new("handheld", Body::new(0.15, 0.045)?, Spread::value(0.3)?);
//! let drop = DropRanges::new(Fall::HeightM(Spread::value(1.0)?), Spread::new(0.02, 0.1, Law::Range)?);
//! let mount = Mount::Suspended { frequency_hz: Spread::value(40.0)?, damping: Damping::Ratio(Spread::value(0.05)?) };
//! let limits = Limits::default().with(LimitKind::Acceleration, Spread::value(300.0)?);
//! let board = Component::new("board", Spread::value(0.05)?, mount, limits);
//! let mut file = ProductFile::new(handheld, drop, vec![board])?;
//!
//! // What no product file may say is an error that can be matched.
//! file.product.restitution = Spread::value(1.7)?;
//! let Err(Error::Data { fault: DataFault::Value { field, value, .. }, .. }) = file.check() else { unreachable!() };
//! assert_eq!((field, value), ("restitution", 1.7));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![cfg_attr(
    test,
    allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")
)]

mod attitude;
mod check;
mod component;
mod data_fault;
mod error;
mod fault;
mod inputs;
mod keys;
mod model;
mod product;
mod quantity;
mod read;
mod reliability;
mod schema;
mod slip;
mod spread;
mod standard;
pub mod units;
mod visible;

pub use attitude::{Attitude, Base};
pub use check::{LEAST_GYRATION, MERGE_S, most_gyration_m};
pub use clatter_flight::{Axis, Body, ContactLaw, Drop, Feet, OwnContact, OwnContacts, Place, Side};
pub use clatter_shock::STANDARD_GRAVITY_M_S2;
pub use component::{Component, Damping, Inside, Limits, Mount, StopInput, Stops, places};
pub use data_fault::DataFault;
pub use error::Error;
pub use fault::{Fault, Faults};
pub use inputs::{
    AXES, INPUTS, Input, NUMBERS_OF_ALL, NUMBERS_OF_DROP, Optional, Row, Search, optional_inputs, searched,
};
pub use model::Model;
pub use product::{
    DropName, DropRanges, Fall, First, LEVEL_RAD, Landing, Listed, MOST_FRICTION, Product, ProductFile, RecordFile,
};
pub use quantity::{Limit, LimitKind, ResponsePeak, Source, Unit};
pub use read::{Family, GridAxis, LARGEST_FILE, Plan};
pub use reliability::Reliability;
pub use schema::schema;
pub use slip::{Slip, outside, slip};
pub use spread::{Law, Spread};
pub use visible::{visible, visible_lines};

/// A commented product file that assesses as it stands.
pub const EXAMPLE: &str = include_str!("example.toml");
