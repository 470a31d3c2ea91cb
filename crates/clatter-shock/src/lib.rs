//! The response of a suspended component to a train of shocks, and the analysis of the shocks in a history.
//!
//! A component on a suspension is a single-degree-of-freedom system whose base is shaken:
//!
//! ```text
//! z″ + 2ζω z′ + ω² z = −(acceleration of the base),      A = −(2ζω z′ + ω² z)
//! ```
//!
//! z is its displacement relative to the base, A its absolute acceleration, ω its natural angular frequency, ζ ≥ 0 its
//! damping ratio, of any size. With a [`Stop`] it presses a surface on either side beyond a gap. Its response is exact for the excitation given, but for rounding: peaks come from
//! turning points, never from samples, and the ring-down is always complete.
//!
//! | excitation | type | when |
//! |---|---|---|
//! | jumps of velocity | [`VelocityShocks`] | pulses much shorter than the period |
//! | pulses of a shape, overlapping or not | [`Pulses`] | any pulse |
//! | samples, linear between them | [`SpectrumFilter`], [`UnevenFilter`] | measured records, which `clatter-record` reads |
//! | a clattering bar | [`respond`], [`three_way_rule`] | a part at a position of the bar |
//!
//! Each gives a [`Response`] of one component or a [`Spectrum`] over many; [`Limit`], [`DamageBoundary`],
//! [`HistoryBoundary`] and [`ShockTable`] turn these into margins.
//!
//! In a history of even samples [`find_shocks`] finds the shocks. For one shock [`effective_duration`] returns its
//! durations, [`fit_pulses`] the pulses that fit it, and [`check_pulse`] whether it is the pulse that a standard asks
//! for. [`STANDARD_PULSES`], [`PULSE_TOLERANCES`] and [`STANDARD_CURVES`] hold the data of standards.
//!
//! The feature `serde` writes and reads parts, pulses, spectra and results, and repeats the checks of construction.
//!
//! ```
//! use clatter::{Bar, Start};
//! use clatter_shock::{DampingRatio, Limit, Suspension, respond};
//!
//! // A board mode at 180 Hz, Q = 10, at the end of a phone that falls from 1.2 m: v0 = 4.85 m/s, tilted so that h0 = 5 mm.
//! let bar = Bar::new(0.5, 0.3)?;
//! let start = Start::new([-4.85, -4.85], 5e-3)?;
//! let board = Suspension::from_hz(180.0, DampingRatio::from_quality_factor(10.0)?)?;
//! let shaken = respond(&bar, &start, 1.0, &board)?;
//! let peak = shaken.response.absolute_acceleration.peak();
//! assert!(peak.interval > 0); // the first impact is not the worst
//! assert!(Limit::Acceleration(20_000.0).margin(&shaken.response)?.is_safe());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![cfg_attr(
    test,
    allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")
)]

pub mod accuracy;
mod coupling;
mod duration;
mod eight;
mod enveloping;
mod error;
#[cfg(feature = "serde")]
mod fields;
mod filter;
mod forced;
mod fragility;
mod history;
mod history_boundary;
mod impulse;
mod integrals;
mod levels;
mod limit_curve;
mod peaks;
mod pulse;
mod pulse_fit;
mod required;
pub mod samples;
mod shocks;
mod side_by_side;
mod spectrum;
mod standard;
mod stop;
mod suspension;
mod tolerance;
mod uneven;

pub use coupling::{ImpulseFactors, Rule, RulePoint, TrainResponse, respond, shocks_at, three_way_rule};
pub use duration::{EffectiveDuration, effective_duration};
pub use enveloping::EnvelopingPulse;
pub use error::Error;
pub use filter::SpectrumFilter;
pub use fragility::{DamageBoundary, EquivalentPulse, Limit, Margin, ShockTable, Trial};
pub use history_boundary::HistoryBoundary;
pub use impulse::{VelocityShock, VelocityShocks};
pub use limit_curve::LimitCurve;
pub use peaks::{Extreme, Extremes, Peaked, Response};
pub use pulse::{Moment, Pulse, Pulses, Shape};
pub use pulse_fit::{PulseFit, fit_pulses, pulse_at};
pub use required::{Deviation, RequiredSpectrum};
pub use shocks::{MOST_SHOCKS, Search, Shock, Shocks, find_shocks, noise_threshold};
pub use spectrum::{Frequencies, Quantity, Spectrum, Summary};
pub use standard::{
    STANDARD_CURVES, STANDARD_PULSES, ServiceCondition, StandardCurve, StandardPulse, covering_condition,
    standard_curve, standard_pulse,
};
pub use stop::{Hit, Stop};
pub use suspension::{DampingRatio, State, Suspension};
pub use tolerance::{Distortion, PULSE_TOLERANCES, PulseCheck, PulseTolerance, Within, check_pulse, pulse_tolerance};
pub use uneven::UnevenFilter;

/// Standard acceleration of free fall, 9.80665 m/s² exactly (3rd CGPM, 1901).
pub const STANDARD_GRAVITY_M_S2: f64 = 9.806_65;
