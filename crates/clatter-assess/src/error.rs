//! What can be wrong with a product that was not read from a file, and with an assessment.

use crate::Law;

/// A value that describes no product, and what is allowed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A value that no product has.
    #[error("{name} is {value}; allowed: {allowed}")]
    Given {
        /// What it is, as product files call it.
        name: String,
        /// The value, in SI.
        value: String,
        /// What is allowed.
        allowed: String,
    },
    /// A number that is not finite.
    #[error("{0:?} is not a finite number")]
    Number(f64),
    /// A range that runs backwards.
    #[error("the range begins at {lo:?}, above its end {hi:?}")]
    Range {
        /// Its lower end.
        lo: f64,
        /// Its upper end.
        hi: f64,
    },
    /// An invalid distribution.
    #[error("{0:?} is no distribution over its range: a deviation is positive, a mode within the range")]
    Law(Law),
    /// A tolerance that no model could be held to, or that says nothing.
    #[error("the tolerance is {0:?}; allowed: a share in [1e-4, 0.5]")]
    Tolerance(f64),
    /// What the bar does not accept.
    #[error(transparent)]
    Bar(#[from] clatter::Error),
    /// What the component does not accept.
    #[error(transparent)]
    Shock(#[from] clatter_shock::Error),
    /// A part for which the pulse is no velocity shock, in a product without contact time.
    #[error("component {component:?} needs the contact time of the product: {reason}")]
    ContactTime {
        /// Name of the component.
        component: String,
        /// Why.
        reason: String,
    },
    /// A drop that a flight does not answer.
    #[error(transparent)]
    Flight(#[from] clatter_flight::Error),
    /// A motion that was given up while more was to come.
    #[error("the motion goes on beyond 1024 strikes or 20 000 phases, and was left there")]
    Unfinished,
    /// A search that was told to stop.
    #[error("the search for the worst drop was stopped before")]
    Stopped,
    /// A model of the contact, in a product without contact time.
    #[error("this model needs the contact time, and none is known")]
    Contact,
}
