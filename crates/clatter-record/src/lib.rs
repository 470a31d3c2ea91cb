//! Measured shocks: from the files of loggers to channels in SI.

mod baseline;
mod butterworth;
mod error;
mod integrate;
mod samples;
mod shocks;
mod table;

pub use baseline::{Baseline, PRE_SHOCK_SHARE, Removed, remove_baseline};
pub use butterworth::{Pass, butterworth};
pub use error::Error;
pub use integrate::{Motion, integrate};
pub use shocks::{MOST_SHOCKS, Search, Shock, Shocks, find_shocks, noise_threshold};
pub use table::{Column, Table, Values};
