//! This module adds the version to answers as they are written.

use serde::Serialize;

/// The version of clatter, as in `0.1.0`.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// An answer with the version of clatter before its fields, as the command, the wheel and the page write it.
///
/// ```
/// use clatter_answer::{VERSION, Versioned, map};
/// let (q, e) = (clatter::Axis::q(0.0, 1.0, 2)?, clatter::Axis::e(0.0, 1.0, 2)?);
/// let answer = map::answer(&map::Question::new(clatter::Quantity::PeakEnd, q, e))?;
/// let text = serde_json::to_string(&Versioned::new(&answer))?;
/// assert!(text.starts_with(&format!("{{\"clatter\":\"{VERSION}\",\"quantity\"")));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Versioned<'a, A> {
    clatter: &'static str,
    #[serde(flatten)]
    answer: &'a A,
}

impl<'a, A: Serialize> Versioned<'a, A> {
    /// Adds the version to an answer that is an object in JSON; a list of answers is a list of these.
    pub const fn new(answer: &'a A) -> Self {
        Self { clatter: VERSION, answer }
    }
}
