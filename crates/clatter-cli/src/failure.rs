//! Why a command could not answer.

use std::io;
use std::path::PathBuf;

use clatter_report::ReportError;

use crate::Exit;

#[derive(Debug, thiserror::Error)]
pub(crate) enum Failure {
    #[error(transparent)]
    Input(#[from] clatter::Error),
    /// Arguments that are right one by one and wrong together.
    #[error("{0}")]
    Usage(&'static str),
    #[error("cannot write the answer: {0}")]
    Answer(#[source] io::Error),
    #[error("cannot write {}: {reason}", .path.display())]
    File { path: PathBuf, reason: io::Error },
    #[error(transparent)]
    Report(#[from] ReportError),
}

impl Failure {
    pub(crate) fn exit(&self) -> Exit {
        match self {
            Self::Report(ReportError::Typst(_)) => Exit::Outside,
            _ => Exit::BadInput,
        }
    }
}
