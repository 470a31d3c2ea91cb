//! This crate makes printed reports as pure functions of data: it has the pages of an assessment, and the means to write and set every
//! report.
//!
//! A report computes nothing: it is handed what was computed and says how it is drawn, worded and set. Figures are SVG, data
//! JSON; the page is a typst file that reads them. One module alone starts typst.

#![allow(clippy::disallowed_methods, reason = "what is shown has few digits")]

mod assessment;
mod file;
#[cfg(test)]
mod frame;
mod ladder;
mod leftovers;
mod page;
mod typst;
pub mod words;

use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use clatter_assess::{Assessment, design::Remedies};
use clatter_product::ProductFile;

pub use file::{create, differ_by_case_alone, directory_of, is_protected, place_of, replace, takes_files};
pub use leftovers::remove_leftovers;
pub use page::{File, write_pages};
pub use typst::Typst;

/// The files of a written report, and its warnings.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Written {
    /// The files, the PDF first.
    pub files: Vec<PathBuf>,
    /// The warnings that the caller should show the user.
    pub warnings: Vec<String>,
}

/// The reason why a report was not written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// typst is missing, failed or was cut off: an outside program, not a bad input.
    #[error("{0}")]
    Typst(String),
    /// A file could not be written or read.
    #[error("{}: {source}", clatter_product::visible(&path.display().to_string()))]
    Io {
        /// The file.
        path: PathBuf,
        /// The error of the system.
        source: io::Error,
    },
    /// A figure could not be drawn.
    #[error(transparent)]
    Figure(#[from] clatter_figures::FigureError),
}

/// The data that the pages of an assessment are made from.
#[derive(Debug, Clone, Copy)]
pub struct Pages<'a> {
    /// The product.
    pub file: &'a ProductFile,
    /// The assessment of the product.
    pub assessment: &'a Assessment,
    /// The data of the figures of each part.
    pub portraits: &'a [clatter_assess::Portrait],
    /// The changes that would make parts safe with a margin of 10 %; where a part that is not safe has no entry, the pages name the command
    /// that finds its changes.
    pub remedies: &'a [Remedies],
    /// The measured drops of the product; the pages have a section for each.
    pub measured: &'a [clatter_fit::MeasuredDrop],
    /// The path that the product was read from, as the pages print it.
    pub path: &'a str,
    /// The day that the pages print, if any.
    pub date: Option<&'a str>,
}

/// Writes the pages of an assessment to `pdf`: the verdict first, then one part after the other. Returns the warnings that the caller
/// should show the user.
///
/// Where names have characters that the typefaces cannot set, they are drawn as boxes, and a warning says so. The file is
/// written next to its place and renamed; the same assessment gives the same bytes.
///
/// ```no_run
/// // typst may have to be installed first
/// use clatter_product::{EXAMPLE, ProductFile};
/// let file = ProductFile::read(EXAMPLE, "example.toml")?;
/// let assessment = clatter_assess::assess(&file)?;
/// let portraits = clatter_assess::portraits(&file, &assessment);
/// let remedies = clatter_assess::remedies(&file, &assessment, &clatter_assess::design::Bounds::default(), 0.1)?;
/// let (file, assessment, portraits, remedies) = (&file, &assessment, &portraits, &remedies);
/// let pages = clatter_report::Pages { file, assessment, portraits, remedies, measured: &[], path: "example.toml", date: None };
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

/// Makes the same report without writing it anywhere, and returns it with the warnings.
///
/// # Errors
/// [`ReportError`].
pub fn assessment_pdf(
    pages: &Pages<'_>,
    progress: &mut dyn FnMut(&str),
) -> Result<(Vec<u8>, Vec<String>), ReportError> {
    let (typst, mut warnings) = Typst::find(progress)?;
    progress("setting the pages");
    let set_of = |assessment| {
        let files = assessment::files(&Pages { assessment, ..*pages })?;
        let inputs = files.iter().map(|(name, content)| (name.as_str(), content.as_str()));
        typst.set(("assessment.typ", include_str!("../../../reports/assessment.typ")), inputs)
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

/// Draws error over cost of every model that was measured on the worst drop of each limit, log-log, one panel for each limit: the
/// cheapest model within the tolerance is ringed. A model whose error is below that of the reference stands in a strip at the foot.
///
/// ```
/// use clatter_product::{EXAMPLE, ProductFile};
/// let file = ProductFile::read(EXAMPLE, "example.toml")?;
/// let ladders = clatter_assess::ladders(&file, &clatter_assess::assess(&file)?, 0.01)?;
/// assert!(clatter_report::ladder_svg(&ladders)?.contains("plate"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`clatter_figures::FigureError`].
pub fn ladder_svg(product: &clatter_assess::ladder::ProductLadder) -> Result<String, clatter_figures::FigureError> {
    ladder::of_product(product)
}
