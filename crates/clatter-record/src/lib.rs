//! Measured shocks: from the files of loggers to channels in SI, conditioned.
//!
//! [`Record::open`] reads what loggers and programs write, [`Record::read`] with what a caller may tell of it; [`Record::window`], [`Record::without_baseline`] and
//! [`Record::filter`] make it ready, and [`Channel::spectrum`] makes its spectra. What shocks its samples hold, which
//! pulses fit them and what standards ask of these is for [`clatter_shock`], which takes slices of numbers.
//!
//! ```
//! use clatter_record::{Options, Record};
//! let csv = "time [ms],a_x [g],a_z [g]\n0,0,0\n0.1,1,-40\n0.2,2,30\n0.3,0,0\n";
//! let drop = Record::read(csv.as_bytes(), &Options::default(), |_| ())?;
//! assert_eq!(drop.channel("a_z").expect("a channel").peak(), (1e-4, -40.0 * 9.80665));
//! # Ok::<(), clatter_record::Error>(())
//! ```

#![cfg_attr(
    test,
    allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")
)]

mod account;
mod axis;
mod baseline;
mod between;
mod butterworth;
mod columns;
mod condition;
mod container;
mod decimal;
mod error;
mod factor;
mod field;
mod finding;
mod heading;
mod integrate;
mod limit;
mod moment;
mod options;
mod pairs;
mod plausible;
mod raw;
mod record;
mod roles;
mod spectrum;
mod table;
mod text;
mod times;
mod unit;

pub use account::{Account, Lines};
pub use axis::TimeAxis;
pub use baseline::{Baseline, PRE_SHOCK_SHARE, Removed, remove_baseline};
pub use between::BAND;
pub use butterworth::{Pass, butterworth};
pub use container::{Kind, read};
#[cfg(feature = "parquet")]
pub use container::{RowGroupWriter, RowGroups, Series, write_parquet};
pub use error::{Bad, Error};
pub use field::{Field, FieldKind};
pub use finding::{At, Finding};
pub use integrate::{Motion, integrate};
pub use limit::{LimitPoints, read_limit};
pub use options::{Options, Pick, Units, sensitivity};
pub use record::{Channel, Record};
pub use spectrum::Between;
pub use table::{Column, Table, Values};
pub use text::{Cell, names_columns, read_list};

/// The unit of columns that count in shares of full scale, from −1 to 1.
pub(crate) const FULL_SCALE: &str = "full scale";
