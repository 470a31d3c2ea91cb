//! Figures, tables and printed reports as pure functions of data.

use std::path::{Path, PathBuf};

/// A report that can be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Report {
    /// The paper's own figures, table and claims.
    Paper,
}

/// What was written.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Written {
    /// The files, the PDF first.
    pub files: Vec<PathBuf>,
    /// What the caller should tell the user.
    pub warnings: Vec<String>,
}

/// Why a report was not written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// typst is missing, failed or was cut off: an outside program, not a bad input.
    #[error("{0}")]
    Typst(String),
    /// A file could not be written.
    #[error("{path}: {source}", path = path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The report's data could not be computed.
    #[error(transparent)]
    Model(#[from] clatter::Error),
}

/// Writes a report into `dir`, which is made if it is missing: `<name>.pdf`, its figures as SVG, its tables as
/// JSON and CSV. `progress` gets one line a step.
///
/// # Errors
/// [`ReportError`]; with [`ReportError::Typst`] everything but the PDF has been written.
pub fn write(report: Report, dir: &Path, progress: &mut dyn FnMut(&str)) -> Result<Written, ReportError> {
    let _ = (report, dir, progress);
    Ok(Written::default())
}

/// A map as a heat map with a color bar; endless (+∞) is shown apart.
#[must_use]
pub fn map_svg(map: &clatter::Map) -> String {
    let _ = map;
    String::new()
}
