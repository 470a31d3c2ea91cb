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
    /// A number outside its range.
    #[error("{name} = {value:?} is not {allowed}")]
    Quantity {
        /// What the value stands for, with its unit.
        name: &'static str,
        /// The value.
        value: f64,
        /// The range that makes sense.
        allowed: &'static str,
    },
    /// A sample that is not usable; samples count from 1.
    #[error("sample {sample}: acceleration (m/s²) = {value:?} is not finite and at most 1e100 in size")]
    Sample {
        /// Its place in the record, from 1.
        sample: usize,
        /// Its value.
        value: f64,
    },
    /// A record too short for what is asked.
    #[error("{what} needs {needed} samples at least; the record has {samples}")]
    Short {
        /// What is asked.
        what: &'static str,
        /// How many samples there are.
        samples: usize,
        /// How many it takes.
        needed: usize,
    },
    /// A record that never changes.
    #[error("every sample of the record is alike: there is no shock in it")]
    NoShock,
    /// A record without quiet before the shock.
    #[error(
        "{samples} samples come before the shock, which begins where the record is {share:?} of its peak away from its first \
         {needed} samples; a mean before the shock needs {needed} at least: take out the mean of the whole record instead"
    )]
    NoQuiet {
        /// Samples before the shock.
        samples: usize,
        /// How many it takes.
        needed: usize,
        /// Share of the peak at which the shock begins.
        share: f64,
    },
}
