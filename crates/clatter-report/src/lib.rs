//! Figures, tables and printed reports as pure functions of data.
//!
//! A report computes nothing: it is handed what `clatter` computed and says how it is drawn, worded and set. Figures
//! are SVG, tables JSON and CSV; the page is a typst file that reads them. One module alone starts typst.

mod figure;
mod paper;
mod svg;
mod table;
mod typst;

use std::fs;
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
    /// A file could not be written or read.
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
    /// The report's data could not be written as JSON.
    #[error("the report's data: {0}")]
    Data(String),
}

/// Writes a report into `dir`, which is made if it is missing: the PDF, its figures as SVG, its tables as
/// JSON and CSV. `progress` gets one line a step.
///
/// Each file is written beside its place and renamed, so that none is ever half there. The PDF is the same, byte for
/// byte, from run to run.
///
/// # Errors
/// [`ReportError`]; with [`ReportError::Typst`] everything but the PDF has been written.
pub fn write(report: Report, dir: &Path, progress: &mut dyn FnMut(&str)) -> Result<Written, ReportError> {
    match report {
        Report::Paper => {
            progress("computing figures and tables");
            let files = paper::Data::compute()?.files()?;
            page("paper.pdf", ("paper.typ", include_str!("../../../reports/paper.typ")), &files, &paper::page(), dir, progress)
        }
    }
}

/// The shared style of all pages.
const STYLE: &str = include_str!("../../../reports/style.typ");

/// Writes the files, then sets the page from them in a directory of its own.
fn page(
    pdf: &str,
    (name, source): (&str, &str),
    files: &[paper::File],
    data: &str,
    dir: &Path,
    progress: &mut dyn FnMut(&str),
) -> Result<Written, ReportError> {
    fs::create_dir_all(dir).map_err(|source| ReportError::Io { path: dir.into(), source })?;
    let mut written = Written::default();
    for (name, content) in files {
        written.files.push(place(dir, name, content.as_bytes())?);
    }
    let target = dir.join(pdf);
    let stale = |error| match error {
        ReportError::Typst(text) if target.exists() => {
            ReportError::Typst(format!("{text}\n{} is still the one from before", target.display()))
        }
        error => error,
    };
    let (typst, warning) = typst::Typst::find(progress).map_err(stale)?;
    written.warnings.extend(warning);
    progress("setting the page");
    let work = tempfile::tempdir().map_err(|source| ReportError::Io { path: std::env::temp_dir(), source })?;
    let inputs = files.iter().map(|(name, content)| (*name, content.as_str()));
    for (name, content) in inputs.chain([(name, source), ("style.typ", STYLE), ("page.json", data)]) {
        let path = work.path().join(name);
        fs::write(&path, content).map_err(|source| ReportError::Io { path, source })?;
    }
    let bytes = typst.compile(work.path(), name).map_err(stale)?;
    written.files.insert(0, place(dir, pdf, &bytes)?);
    Ok(written)
}

/// Writes a file beside its place, then renames it.
fn place(dir: &Path, name: &str, content: &[u8]) -> Result<PathBuf, ReportError> {
    let target = dir.join(name);
    let beside = dir.join(format!(".{name}.{}", std::process::id()));
    let placed = fs::write(&beside, content).and_then(|()| fs::rename(&beside, &target));
    placed.map_err(|source| {
        let _ = fs::remove_file(&beside); // it may not be there
        ReportError::Io { path: target.clone(), source }
    })?;
    Ok(target)
}

/// A map as a heat map with a color bar; endless (+∞) is shown apart.
#[must_use]
pub fn map_svg(map: &clatter::Map) -> String {
    figure::heat::heat(map)
}
