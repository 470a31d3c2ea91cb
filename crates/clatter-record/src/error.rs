//! The one error type of the crate: what was given, where, and what is allowed.

use std::fmt::Write as _;

use crate::At;

/// What makes a file no record. Lines count from 1.
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
    /// A record too short to be one.
    #[error("the record has {}; it needs two at least", if *.0 == 1 { "one sample" } else { "no samples" })]
    Short(usize),
    /// More numbers than are to be read.
    #[error("the record has more than {0} numbers: take a part of it, or fewer channels")]
    Many(usize),
    /// What makes no spectrum.
    #[error(transparent)]
    Shock(#[from] clatter_shock::Error),
    /// A number outside of its range.
    #[error("{name} = {value:?} is not {allowed}")]
    Quantity {
        /// What the value stands for, with its unit.
        name: &'static str,
        /// The value.
        value: f64,
        /// The range that makes sense.
        allowed: &'static str,
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
