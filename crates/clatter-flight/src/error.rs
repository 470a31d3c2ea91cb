//! The one error type of the crate.

/// A drop that no flight answers.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A value that describes no drop.
    #[error(transparent)]
    Given(#[from] clatter::Error),
    /// A motion that does not keep its energy.
    #[error(
        "the motion changes its energy by {:.2} % without reason: it is no answer (contacts so long that they turn the body far, or so short that roundings of heights count)",
        100.0 * share
    )]
    Energy {
        /// What was made and lost, without regard to sign, over the energy at the first touch.
        share: f64,
    },
}
