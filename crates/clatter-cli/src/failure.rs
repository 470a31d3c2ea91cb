//! This module has the reasons why a command could not answer.

use std::io;
use std::path::PathBuf;

use clatter_report::ReportError;

use crate::record_args::remedy;
use crate::{Exit, text};

#[derive(Debug, thiserror::Error)]
pub(crate) enum Failure {
    #[error(transparent)]
    Input(#[from] clatter::Error),
    /// A value that is wrong together with the others.
    #[error("invalid value for '{flag}': {reason}")]
    Flag { flag: &'static str, reason: clatter::Error },
    #[error(transparent)]
    Shock(#[from] clatter_shock::Error),
    /// A file of shock tests that shows no critical level.
    #[error("{}: {}", text::path(.path), text::visible(&.reason.to_string()))]
    Tests { path: PathBuf, reason: clatter_shock::Error },
    #[error("{}: {}{}", text::path(.path), text::visible_lines(&.reason.to_string()), remedy(.reason))]
    Record { path: PathBuf, reason: clatter_record::Error },
    /// A list that is none.
    #[error("{}: {}", text::path(.path), text::visible(&.reason.to_string()))]
    List { path: PathBuf, reason: clatter_record::Error },
    #[error(transparent)]
    Assess(#[from] clatter_product::Error),
    #[error(transparent)]
    Flight(#[from] clatter_flight::Error),
    #[error(transparent)]
    Question(#[from] clatter_answer::Error),
    /// Arguments that are right one by one and wrong together.
    #[error("{0}")]
    Usage(&'static str),
    /// The same, with values in the message.
    #[error("{}", text::visible(.0))]
    Wrong(String),
    #[error("cannot write the answer: {0}")]
    Answer(#[source] io::Error),
    #[error("cannot write {}: {}", text::path(.path), text::visible(&.reason.to_string()))]
    File { path: PathBuf, reason: io::Error },
    #[error("{} is read by this command and would be lost: choose another name for the output, or give --force", text::path(.0))]
    Overwrites(PathBuf),
    #[error("{} is write-protected: choose another name for the output, or give --force", text::path(.0))]
    Protected(PathBuf),
    #[error("{} is a record that {} names and would be lost: choose another name for the output", text::path(.path), text::path(.product))]
    NamedRecord { path: PathBuf, product: PathBuf },
    #[error("{} is where {stream} goes: what is written to it would be lost; choose another name for the output", text::path(.path))]
    Stream { path: PathBuf, stream: &'static str },
    #[error("a map of {points} points takes more than --memory allows: allowed are {most} points")]
    Large { points: u128, most: u128 },
    #[error("{} is there already, and is not this shard: choose another name, or give --force", text::path(.0))]
    OtherPart(PathBuf),
    #[error("{} is to be written twice: choose another name for one output", text::path(.0))]
    Twice(PathBuf),
    #[error("cannot read {}: {}", text::path(.path), text::visible(&.reason.to_string()))]
    Unreadable { path: PathBuf, reason: io::Error },
    #[error("{} is there already: choose another name, or remove it first", text::path(.0))]
    Exists(PathBuf),
    /// Faults in product files, each shown where it stands.
    #[error("{0}")]
    Product(String),
    #[error(transparent)]
    Figure(#[from] clatter_figures::FigureError),
    #[error(transparent)]
    Report(#[from] ReportError),
    #[error(transparent)]
    Study(#[from] clatter_studies::Error),
}

impl From<clatter_answer::study::Error> for Failure {
    fn from(error: clatter_answer::study::Error) -> Self {
        use clatter_answer::study::Error;
        match error {
            Error::Faults(faults) => Self::Product(faults.to_string()),
            other => Self::Wrong(other.to_string()),
        }
    }
}

impl Failure {
    /// Names the flag whose value the model refuses.
    pub(crate) fn flag(flag: &'static str) -> impl FnOnce(clatter::Error) -> Self {
        move |reason| Self::Flag { flag, reason }
    }

    pub(crate) fn exit(&self) -> Exit {
        match self {
            Self::Report(ReportError::Typst(_))
            | Self::Study(clatter_studies::Error::Report(ReportError::Typst(_))) => Exit::Outside,
            _ => Exit::BadInput,
        }
    }
}
