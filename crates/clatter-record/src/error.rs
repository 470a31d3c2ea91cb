//! The one error type of the crate: what was given, where, and what is allowed.

/// What makes a file no record.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The file is of a kind that is not read, or not as its kind has to be.
    #[error("{0}")]
    File(String),
    /// The file could not be read.
    #[error("the record could not be read: {0}")]
    Read(String),
}
