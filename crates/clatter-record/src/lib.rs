//! Measured shocks: from the files of loggers to channels in SI.

mod between;
mod container;
mod decimal;
mod error;
mod finding;
mod heading;
mod moment;
mod options;
mod record;
mod roles;
mod spectrum;
mod table;
mod text;
mod times;
mod unit;

pub use between::BAND;
pub use container::{Kind, read, write_npy};
#[cfg(feature = "parquet")]
pub use container::{Series, write_parquet};
pub use error::{Bad, Error};
pub use finding::{At, Finding};
pub use options::{Options, Pick, Units};
pub use record::{Channel, Record};
pub use spectrum::Between;
pub use table::{Column, Table, Values};

/// The unit of columns that count in shares of full scale, from −1 to 1.
pub(crate) const FULL_SCALE: &str = "full scale";
