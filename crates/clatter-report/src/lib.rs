//! Figures, tables and printed reports as pure functions of data.
//!
//! A report computes nothing: it is handed what `clatter` computed and says how it is drawn, worded and set. Figures
//! are SVG, tables JSON and CSV; the page is a typst file that reads them. One module alone starts typst.

#![allow(clippy::disallowed_methods, reason = "what is shown has few digits")]

mod accuracy;
mod assessment;
mod file;
mod leftovers;
mod page;
mod paper;
mod peers;
mod shock;
mod table;
mod trade;
mod typst;
mod words;

use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

pub use accuracy::{Measured, measured};
pub use file::{create, differ_by_case_alone, directory_of, is_protected, place_of, replace, takes_files};
pub use leftovers::remove_leftovers;
pub use shock::shock_numbers;
pub use trade::trade_files;

use page::{page, set};

/// A report that can be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Report {
    /// The paper's own figures, table and claims.
    Paper,
    /// What the clatter does to a suspended part.
    Shock,
    /// How exact all of it is.
    Accuracy,
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
    #[error("{}: {source}", clatter_assess::visible(&path.display().to_string()))]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The report's data could not be computed.
    #[error(transparent)]
    Model(#[from] clatter::Error),
    /// The same of a drop in time.
    #[error(transparent)]
    Flight(#[from] clatter_flight::Error),
    /// The same of a component.
    #[error(transparent)]
    Shock(#[from] clatter_shock::Error),
    /// The same of a product.
    #[error(transparent)]
    Assess(#[from] clatter_assess::Error),
    /// A figure could not be drawn.
    #[error(transparent)]
    Figure(#[from] clatter_figures::FigureError),
    /// The report's data could not be written as JSON.
    #[error("the report's data: {0}")]
    Data(String),
}

/// Writes a report into `dir`, which is made if it is missing: the PDF, its figures as SVG, its tables as
/// JSON and CSV. `progress` gets one line a step.
///
/// Each file is written beside its place and renamed, so that none is ever half there. The PDF is the same, byte for
/// byte, from run to run, but for the times in that of [`Report::Accuracy`]. Another build of the same typst packs the same
/// content differently.
///
/// ```no_run
/// // typst may have to be installed first
/// let written = clatter_report::write(clatter_report::Report::Paper, "report".as_ref(), &mut |step| eprintln!("{step}"))?;
/// assert!(written.files[0].ends_with("paper.pdf"));
/// # Ok::<(), clatter_report::ReportError>(())
/// ```
///
/// # Errors
/// [`ReportError`]; with [`ReportError::Typst`] everything but the PDF has been written.
pub fn write(report: Report, dir: &Path, progress: &mut dyn FnMut(&str)) -> Result<Written, ReportError> {
    match report {
        Report::Paper => {
            let source = ("paper.typ", include_str!("../../../reports/paper.typ"));
            page(
                "paper.pdf",
                source,
                &|| paper::Data::compute()?.files(),
                &[("page.json", &paper::page())],
                dir,
                progress,
            )
        }
        Report::Shock => {
            let source = ("shock.typ", include_str!("../../../reports/shock.typ"));
            page(
                "shock.pdf",
                source,
                &|| shock::Data::compute()?.files(),
                &[("page.json", &paper::page())],
                dir,
                progress,
            )
        }
        Report::Accuracy => {
            let source = ("accuracy.typ", include_str!("../../../reports/accuracy.typ"));
            let data = paper::page();
            let inputs = [
                ("page.json", data.as_str()),
                ("trade.typ", include_str!("../../../reports/trade.typ")),
                ("peers.typ", include_str!("../../../reports/peers.typ")),
            ];
            page("accuracy.pdf", source, &accuracy_files, &inputs, dir, progress)
        }
    }
}

/// Errors, the trade between them and time, and what other tools make of the same scenes.
fn accuracy_files() -> Result<Vec<paper::File>, ReportError> {
    let mut files = accuracy::Data::compute()?.files()?;
    // After the rest: it takes times.
    files.extend(trade_files()?);
    files.extend(peers()?);
    Ok(files)
}

/// What the pages of an assessment are made from.
#[derive(Debug, Clone, Copy)]
pub struct Pages<'a> {
    /// The product.
    pub file: &'a clatter_assess::ProductFile,
    /// What was found of it.
    pub assessment: &'a clatter_assess::Assessment,
    /// What there is to draw of each part.
    pub portraits: &'a [clatter_assess::Portrait],
    /// What was measured of it; a section stands for each drop.
    pub measured: &'a [clatter_assess::fit::MeasuredDrop],
    /// Where the product was read from, as it is to be told.
    pub path: &'a str,
    /// The day that is to be told, if any.
    pub date: Option<&'a str>,
}

/// Writes the pages of an assessment to `pdf`: the verdict first, then a part at a time. Gives what the caller should
/// tell the user.
///
/// Where names have characters that the typefaces cannot set, they are drawn as boxes, and a warning says so. The file is
/// written beside its place and renamed; the same assessment gives the same bytes.
///
/// ```no_run
/// // typst may have to be installed first
/// use clatter_assess::{EXAMPLE, ProductFile};
/// let file = ProductFile::read(EXAMPLE, "example.toml")?;
/// let assessment = file.assess()?;
/// let portraits = file.portraits(&assessment);
/// let pages = clatter_report::Pages { file: &file, assessment: &assessment, portraits: &portraits, measured: &[], path: "example.toml", date: None };
/// clatter_report::write_assessment(&pages, "report.pdf".as_ref(), &mut |_| ())?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`ReportError`]; nothing is left at `pdf` that was not there before.
pub fn write_assessment(
    pages: &Pages<'_>,
    pdf: &Path,
    progress: &mut dyn FnMut(&str),
) -> Result<Vec<String>, ReportError> {
    let (bytes, warnings) = assessment_pdf(pages, progress)?;
    replace(pdf, |file| file.write_all(&bytes)).map_err(|source| ReportError::Io { path: pdf.into(), source })?;
    Ok(warnings)
}

/// The same report, not written anywhere, and the warnings.
///
/// # Errors
/// [`ReportError`].
pub fn assessment_pdf(
    pages: &Pages<'_>,
    progress: &mut dyn FnMut(&str),
) -> Result<(Vec<u8>, Vec<String>), ReportError> {
    let (typst, mut warnings) = typst::Typst::find(progress)?;
    progress("setting the pages");
    let set_of = |assessment| {
        let files = assessment::files(&Pages { assessment, ..*pages })?;
        let inputs = files.iter().map(|(name, content)| (name.as_str(), content.as_str()));
        set(&typst, ("assessment.typ", include_str!("../../../reports/assessment.typ")), inputs)
    };
    let bytes = match (set_of(pages.assessment), assessment::surely_named(pages.assessment)) {
        (Err(error @ ReportError::Typst(_)), Some(sure)) => {
            progress("setting the pages once more, with plainer names");
            let bytes = set_of(&sure).map_err(|_| error)?;
            let told = "the typefaces of the report cannot set some characters of its names: they are drawn as boxes";
            warnings.push(told.to_owned());
            bytes
        }
        (bytes, _) => bytes?,
    };
    Ok((bytes, warnings))
}

/// Error over cost of every model that was measured on the worst drop of each limit, log-log, a panel a limit: the cheapest one
/// within the tolerance is ringed. What is off by less than the reference is known to stands in a strip at the foot.
///
/// ```
/// use clatter_assess::{EXAMPLE, ProductFile};
/// let file = ProductFile::read(EXAMPLE, "example.toml")?;
/// let ladders = file.ladders(&file.assess()?, 0.01)?;
/// assert!(clatter_report::ladder_svg(&ladders)?.contains("finite tilt"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`clatter_figures::FigureError`].
pub fn ladder_svg(product: &clatter_assess::ladder::ProductLadder) -> Result<String, clatter_figures::FigureError> {
    trade::of_product(product)
}

/// What other tools make of the same scenes, each at the best setting found, as `peers/run.py` last measured them:
/// `peers.json` for the page and `peers.svg`, a row a tool with its times, counts and error on the four bars of Table 1.
///
/// The times are those of one machine, which is named beside them.
///
/// ```
/// let files = clatter_report::peers()?;
/// assert!(files.iter().any(|(name, content)| *name == "peers.svg" && content.contains("MuJoCo")));
/// # Ok::<(), clatter_report::ReportError>(())
/// ```
///
/// # Errors
/// [`ReportError::Data`] if the results of the last run are not whole.
pub fn peers() -> Result<Vec<(&'static str, String)>, ReportError> {
    peers::files()
}
