//! Measured shocks: from the files of loggers to channels in SI.

mod baseline;
mod butterworth;
mod duration;
mod error;
mod integrate;
mod levels;
mod pulse_fit;
mod samples;
mod shocks;
mod standard;
mod table;
mod tolerance;

pub use baseline::{Baseline, PRE_SHOCK_SHARE, Removed, remove_baseline};
pub use butterworth::{Pass, butterworth};
pub use duration::{EffectiveDuration, effective_duration};
pub use error::Error;
pub use integrate::{Motion, integrate};
pub use pulse_fit::{PulseFit, fit_pulses};
pub use shocks::{MOST_SHOCKS, Search, Shock, Shocks, find_shocks, noise_threshold};
pub use standard::{STANDARD_CURVES, STANDARD_PULSES, StandardCurve, StandardPulse, standard_curve, standard_pulse};
pub use table::{Column, Table, Values};
pub use tolerance::{Distortion, PULSE_TOLERANCES, PulseCheck, PulseTolerance, Within, check_pulse, pulse_tolerance};
