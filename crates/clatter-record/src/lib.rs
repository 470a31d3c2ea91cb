//! Measured shocks: from the files of loggers to channels in SI.

mod error;
mod table;

pub use error::Error;
pub use table::{Column, Table, Values};
