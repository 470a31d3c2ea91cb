//! The one error type of the crate: what was given, where, and what is allowed.

use std::fmt::Write as _;

use crate::At;

/// The reasons why a file is no record. Lines count from 1.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The file is of a kind that is not read, or not as its kind has to be.
    #[error("{0}")]
    File(String),
    /// The file could not be read.
    #[error("the record could not be read: {0}")]
    Read(String),
    /// Which column is time, and which acceleration, is not clear.
    #[error("{0}")]
    Columns(String),
    /// A unit that is not known, or that is not the one of the file.
    #[error("{0}")]
    Units(String),
    /// Lines that cannot be used.
    #[error("{}", list(.0))]
    Lines(Bad),
    /// A window of fewer than two samples.
    #[error(
        "the window from {from_s} s to {to_s} s has {samples} samples; it needs two at least, and the record goes from {start_s} s \
         to {end_s} s"
    )]
    Window {
        /// From this time of the file, in seconds,
        from_s: f64,
        /// to this.
        to_s: f64,
        /// How many samples are in it.
        samples: usize,
        /// Where the record begins, in seconds,
        start_s: f64,
        /// and ends.
        end_s: f64,
    },
    /// The request goes with channels of one time alone.
    #[error("{what} needs channels of one time: {first}; {other}")]
    Times {
        /// The request.
        what: &'static str,
        /// A channel and its times,
        first: String,
        /// and one with other times.
        other: String,
    },
    /// Which of the records of a file is meant is not clear, or there is no such record.
    #[error("{0}")]
    Records(String),
    /// The request goes with even samples alone.
    #[error("{0} needs samples that are even in time, and those of this record are not")]
    Uneven(&'static str),
    /// More numbers than are to be read.
    #[error("the record has more than {0} numbers: take a part of it, or fewer channels")]
    Many(usize),
    /// The request makes no spectrum, or the samples make no history.
    #[error(transparent)]
    Shock(#[from] clatter_shock::Error),
    /// A number outside of its range.
    #[error("{name} = {value:?} is not {allowed}")]
    Quantity {
        /// The quantity, with its unit.
        name: &'static str,
        /// The value.
        value: f64,
        /// The range that makes sense.
        allowed: &'static str,
    },
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

/// Lines or samples that cannot be used: the first ones, each with what is wrong, and how many there are in all.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Bad {
    /// Where each is and what is wrong with it, of the first ten.
    pub first: Vec<(At, String)>,
    /// How many there are.
    pub count: usize,
}

impl Error {
    /// There is no such record in a file that holds so many.
    pub(crate) fn no_record(number: usize, count: usize) -> Self {
        let there = if count == 1 { "there is one record".to_owned() } else { format!("there are {count} records") };
        Self::Records(format!("there is no record {number} in the file: {there}"))
    }
}

impl Bad {
    /// Listed one by one at most.
    const LISTED: usize = 10;
    pub(crate) fn add(&mut self, at: At, what: impl FnOnce() -> String) {
        if self.first.len() < Self::LISTED {
            self.first.push((at, what()));
        }
        self.count += 1;
    }
}

/// One line below the other where there are several.
fn list(bad: &Bad) -> String {
    let mut text = String::new();
    for (i, (at, what)) in bad.first.iter().enumerate() {
        let _ = write!(text, "{}{at}: {what}", if i == 0 { "" } else { "\n" });
    }
    if bad.count > bad.first.len() {
        let _ = write!(text, "\nand {} more", bad.count - bad.first.len());
    }
    text
}
