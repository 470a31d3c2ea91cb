//! Measured shocks: from the files of loggers to channels in SI.

mod container;
mod error;
mod table;

pub use container::{Kind, read, write_npy};
#[cfg(feature = "parquet")]
pub use container::{Series, write_parquet};
pub use error::Error;
pub use table::{Column, Table, Values};
