//! What a train of shocks does to a suspended component.
mod coupling;
mod error;
mod impulse;
mod peaks;
mod suspension;

pub use coupling::{ImpulseFactors, Rule, RulePoint, TrainResponse, respond, shocks_at, three_way_rule};
pub use error::Error;
pub use impulse::{VelocityShock, VelocityShocks};
pub use peaks::{Extreme, Extremes, Response};
pub use suspension::{DampingRatio, State, Suspension};
