//! Studies with clatter: science about the product, and no part of it.
//!
//! - [`paper`]: the results that the reference paper prints, compared with those of clatter, with the curves of its
//!   figures ([`contour`]);
//! - [`plate_claims`], [`plate_numbers`]: the effects of a plate that lands on its corners, beyond those of a bar;
//! - [`suspended`]: the effect of a clatter on suspended parts of any frequency, anywhere on a bar;
//! - [`orders`], [`residues`], [`measured`]: the convergence of the models of a drop to one another, and the accuracy
//!   of all results;
//! - [`bars`], [`trade_files`], [`peers`]: the cost of accuracy, for our models and for other tools;
//! - [`cube`]: measured tosses of a cube and of a square compared with the box and with other tools, and the effect of
//!   friction;
//! - [`friction`]: what friction of the ground changes of a box, by tilt, thickness and coefficient.
//!
//! [`figures`] draws the results; [`write()`] makes the printed reports of the command `clatter report`.

#![allow(clippy::disallowed_methods, reason = "what is shown has few digits")]

mod accuracy;
#[cfg(test)]
mod both_ways;
pub mod contour;
pub mod cube;
pub mod figures;
mod files;
#[cfg(test)]
#[path = "../../crates/clatter-report/src/frame.rs"]
mod frame;
pub mod friction;
mod orders;
pub mod paper;
mod peers;
mod plate;
mod shock;
pub mod suspended;
mod trade;

use std::path::Path;

pub use accuracy::{Measured, measured};
use clatter_report::{File, ReportError, Written, write_pages};
pub use orders::{Order, Residue, orders, residues};
pub use plate::{plate_claims, plate_numbers};
pub use shock::shock_numbers;
pub use trade::{bars, trade_files};

/// A report that can be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Report {
    /// The paper's own figures, table and claims.
    Paper,
    /// The effects of a plate that lands on its corners, beyond those of a bar.
    Plate,
    /// The effect of the clatter on a suspended part.
    Shock,
    /// The accuracy of all results.
    Accuracy,
}

/// The reasons for a report that was not written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Its files or its pages could not be written.
    #[error(transparent)]
    Report(#[from] ReportError),
    /// The report's data could not be computed.
    #[error(transparent)]
    Model(#[from] clatter::Error),
    /// A drop in time could not be computed.
    #[error(transparent)]
    Flight(#[from] clatter_flight::Error),
    /// A component could not be computed.
    #[error(transparent)]
    Shock(#[from] clatter_shock::Error),
    /// A product could not be computed.
    #[error(transparent)]
    Assess(#[from] clatter_product::Error),
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
/// Each file is written under another name and then renamed, so that no file is ever incomplete. The PDF
/// is the same, byte for byte, from run to run, but for the times in that of [`Report::Accuracy`]. Another build of the
/// same typst packs the same content differently.
///
/// ```no_run
/// // typst may have to be installed first
/// let written = clatter_studies::write(clatter_studies::Report::Paper, "report".as_ref(), &mut |step| eprintln!("{step}"))?;
/// assert!(written.files[0].ends_with("paper.pdf"));
/// # Ok::<(), clatter_studies::Error>(())
/// ```
///
/// # Errors
/// [`Error`]; with [`ReportError::Typst`] everything but the PDF has been written.
pub fn write(report: Report, dir: &Path, progress: &mut dyn FnMut(&str)) -> Result<Written, Error> {
    match report {
        Report::Paper => {
            let source = ("paper.typ", include_str!("../../reports/paper.typ"));
            write_pages("paper.pdf", source, &|| paper::Data::compute()?.files(), &[], dir, progress)
        }
        Report::Plate => {
            let source = ("plate.typ", include_str!("../../reports/plate.typ"));
            write_pages("plate.pdf", source, &|| plate::Data::compute()?.files(), &[], dir, progress)
        }
        Report::Shock => {
            let source = ("shock.typ", include_str!("../../reports/shock.typ"));
            write_pages("shock.pdf", source, &|| shock::Data::compute()?.files(), &[], dir, progress)
        }
        Report::Accuracy => {
            let source = ("accuracy.typ", include_str!("../../reports/accuracy.typ"));
            let inputs = [
                ("trade.typ", include_str!("../../reports/trade.typ")),
                ("peers.typ", include_str!("../../reports/peers.typ")),
                ("cube.typ", include_str!("../../reports/cube.typ")),
                ("friction.typ", include_str!("../../reports/friction.typ")),
            ];
            write_pages("accuracy.pdf", source, &accuracy_files, &inputs, dir, progress)
        }
    }
}

/// Returns errors, the trade between them and time, the results of other tools for the same scenes, measured tosses, and
/// what friction does.
fn accuracy_files() -> Result<Vec<File>, Error> {
    let mut files = accuracy::Data::compute()?.files()?;
    // This comes after the rest: it measures times.
    files.extend(trade_files()?);
    files.extend(peers()?);
    files.extend(cube::files()?);
    files.extend(friction::files()?);
    Ok(files)
}

/// Returns the results of other tools for the same scenes, each at the best setting found, as `peers/run.py` last
/// measured them: `peers.json` for the page and `peers.svg`, a row a tool with its times, counts and error on the four
/// bars of Table 1.
///
/// The times are those of one machine, which the files name.
///
/// ```
/// let files = clatter_studies::peers()?;
/// assert!(files.iter().any(|(name, content)| *name == "peers.svg" && content.contains("MuJoCo")));
/// # Ok::<(), clatter_studies::Error>(())
/// ```
///
/// # Errors
/// [`Error::Data`] if the results of the last run are not whole.
pub fn peers() -> Result<Vec<File>, Error> {
    peers::files()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::path::PathBuf;

    fn text(pdf: &Path) -> String {
        let pdf = lopdf::Document::load(pdf).unwrap();
        pdf.extract_text(&pdf.get_pages().into_keys().collect::<Vec<_>>()).unwrap()
    }

    #[test]
    fn words_that_look_like_markup_print_as_they_are() {
        let hostile = r#"#eval("x") $ *b* _c_ @d <e> \ `f` // g"#;
        let quoted = serde_json::to_string(hostile).unwrap();
        let files = || {
            let mut files = paper::Data::compute()?.files()?;
            for (_, content) in files.iter_mut().filter(|(name, _)| *name == "claims.json") {
                *content = content.replace("\"The region of three impacts dominates.\"", &quoted);
            }
            Ok::<_, Error>(files)
        };
        let dir = tempfile::tempdir().unwrap();
        let source = ("paper.typ", include_str!("../../reports/paper.typ"));
        write_pages("page.pdf", source, &files, &[], dir.path(), &mut |_| ()).unwrap();
        let plain = |text: &str| text.chars().filter(|c| !c.is_whitespace()).collect::<String>();
        let said = plain(&text(&dir.path().join("page.pdf")));
        assert!(said.contains(&plain(hostile)), "{said}");
    }

    #[test]
    fn the_page_is_the_same_from_run_to_run() {
        let run = |report| {
            let dir = tempfile::tempdir().unwrap();
            let written = write(report, dir.path(), &mut |_| ()).unwrap();
            // The times of models are those of the run, on the page too.
            let timed = |file: &&PathBuf| {
                let name = file.file_name().unwrap().to_string_lossy();
                name.starts_with("trade") || name == "accuracy.pdf"
            };
            let untimed = written.files.iter().filter(|file| !timed(file));
            untimed.map(|file| fs::read(file).unwrap()).collect::<Vec<_>>()
        };
        // Numbers of plates, which take long, are held by their golden.
        for report in [Report::Paper, Report::Shock, Report::Accuracy] {
            let files = run(report);
            assert!(files.len() > 3 && files == run(report), "two runs of {report:?} differ");
        }
    }
}
