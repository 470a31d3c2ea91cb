//! What a train of shocks does to a suspended component.
mod coupling;
mod error;
mod filter;
mod forced;
mod fragility;
mod impulse;
mod peaks;
mod pulse;
mod record;
mod spectrum;
mod suspension;

pub use coupling::{ImpulseFactors, Rule, RulePoint, TrainResponse, respond, shocks_at, three_way_rule};
pub use error::Error;
pub use filter::SpectrumFilter;
pub use fragility::{DamageBoundary, EquivalentPulse, Limit, Margin, ShockTable, Trial};
pub use impulse::{VelocityShock, VelocityShocks};
pub use peaks::{Extreme, Extremes, Response};
pub use pulse::{Pulse, Pulses, Shape};
pub use record::{Finding, Lines, Record, STANDARD_GRAVITY_M_S2, Sample, Survey, Units, stream};
pub use spectrum::{Frequencies, Quantity, Spectrum};
pub use suspension::{DampingRatio, State, Suspension};
