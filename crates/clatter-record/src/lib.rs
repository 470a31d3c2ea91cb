//! Measured shocks: from the files of loggers to channels in SI.

mod account;
mod axis;
mod baseline;
mod between;
mod butterworth;
mod columns;
mod condition;
mod container;
mod decimal;
mod duration;
mod error;
mod factor;
mod finding;
mod heading;
mod integrate;
mod levels;
mod limit;
mod moment;
mod options;
mod pairs;
mod plausible;
mod pulse_fit;
mod raw;
mod record;
mod roles;
mod samples;
mod shocks;
mod spectrum;
mod standard;
mod table;
mod text;
mod times;
mod tolerance;
mod unit;

pub use account::{Account, Lines};
pub use axis::TimeAxis;
pub use baseline::{Baseline, PRE_SHOCK_SHARE, Removed, remove_baseline};
pub use between::BAND;
pub use butterworth::{Pass, butterworth};
pub use container::{Kind, read};
#[cfg(feature = "parquet")]
pub use container::{Series, write_parquet};
pub use duration::{EffectiveDuration, effective_duration};
pub use error::{Bad, Error};
pub use finding::{At, Finding};
pub use integrate::{Motion, integrate};
pub use limit::{LimitPoints, read_limit};
pub use options::{Options, Pick, Units, sensitivity};
pub use pulse_fit::{PulseFit, fit_pulses, pulse_at};
pub use record::{Channel, Record};
pub use shocks::{MOST_SHOCKS, Search, Shock, Shocks, find_shocks, noise_threshold};
pub use spectrum::Between;
pub use standard::{STANDARD_CURVES, STANDARD_PULSES, StandardCurve, StandardPulse, standard_curve, standard_pulse};
pub use table::{Column, Table, Values};
pub use text::{Cell, names_columns, read_list};
pub use tolerance::{Distortion, PULSE_TOLERANCES, PulseCheck, PulseTolerance, Within, check_pulse, pulse_tolerance};

/// The unit of columns that count in shares of full scale, from −1 to 1.
pub(crate) const FULL_SCALE: &str = "full scale";
