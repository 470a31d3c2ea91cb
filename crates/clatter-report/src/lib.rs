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
use std::thread;

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
/// ```no_run
/// // typst may have to be built first
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
            page("paper.pdf", source, &|| paper::Data::compute()?.files(), &paper::page(), dir, progress)
        }
    }
}

/// The shared style of all pages.
const STYLE: &str = include_str!("../../../reports/style.typ");

/// Computes and writes the files while typst is looked for, then sets the page from them in a directory of its own.
fn page(
    pdf: &str,
    (name, source): (&str, &str),
    compute: &(impl Fn() -> Result<Vec<paper::File>, ReportError> + Sync),
    data: &str,
    dir: &Path,
    progress: &mut dyn FnMut(&str),
) -> Result<Written, ReportError> {
    fs::create_dir_all(dir).map_err(|source| ReportError::Io { path: dir.into(), source })?;
    progress("computing figures and tables");
    let files = || {
        let files = compute()?;
        let paths = files.iter().map(|(name, content)| place(dir, name, content.as_bytes()));
        let paths = paths.collect::<Result<Vec<_>, _>>()?;
        Ok::<_, ReportError>((files, paths))
    };
    let (files, typst) = thread::scope(|scope| {
        let files = scope.spawn(files);
        let typst = typst::Typst::find(progress);
        (files.join(), typst)
    });
    let (files, paths) = files.unwrap_or_else(|panic| std::panic::resume_unwind(panic))?;
    let target = dir.join(pdf);
    let stale = |error| match error {
        ReportError::Typst(text) if target.exists() => {
            ReportError::Typst(format!("{text}\n{} is still the one from before", target.display()))
        }
        error => error,
    };
    let (typst, warning) = typst.map_err(stale)?;
    progress("setting the page");
    let work = tempfile::tempdir().map_err(|source| ReportError::Io { path: std::env::temp_dir(), source })?;
    let inputs = files.iter().map(|(name, content)| (*name, content.as_str()));
    for (name, content) in inputs.chain([(name, source), ("style.typ", STYLE), ("page.json", data)]) {
        let path = work.path().join(name);
        fs::write(&path, content).map_err(|source| ReportError::Io { path, source })?;
    }
    let bytes = typst.compile(work.path(), name).map_err(stale)?;
    let mut written = Written { files: vec![place(dir, pdf, &bytes)?], warnings: warning.into_iter().collect() };
    written.files.extend(paths);
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

/// A map as a heat map with a color bar, a cell a grid point; endless (+∞) is shown apart. The color bar is
/// logarithmic where no value is negative and the positive ones span more than a factor of 30.
///
/// ```
/// use clatter::{Axis, Map, Quantity};
/// let map = Map::compute(Quantity::Impacts, Axis::q(0.0, 1.0, 50)?, Axis::e(0.0, 1.0, 50)?)?;
/// assert!(clatter_report::map_svg(&map).contains("endless"));
/// # Ok::<(), clatter::Error>(())
/// ```
#[must_use]
pub fn map_svg(map: &clatter::Map) -> String {
    figure::heat::heat(map)
}

#[cfg(test)]
mod tests {
    use super::*;

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
            Ok(files)
        };
        let dir = tempfile::tempdir().unwrap();
        let source = ("paper.typ", include_str!("../../../reports/paper.typ"));
        page("page.pdf", source, &files, &paper::page(), dir.path(), &mut |_| ()).unwrap();
        let plain = |text: &str| text.chars().filter(|c| !c.is_whitespace()).collect::<String>();
        let said = plain(&text(&dir.path().join("page.pdf")));
        assert!(said.contains(&plain(hostile)), "{said}");
    }

    #[test]
    fn the_page_is_the_same_from_run_to_run() {
        let run = || {
            let dir = tempfile::tempdir().unwrap();
            let written = write(Report::Paper, dir.path(), &mut |_| ()).unwrap();
            written.files.iter().map(|file| fs::read(file).unwrap()).collect::<Vec<_>>()
        };
        assert!(run() == run(), "two runs differ");
    }

    #[test]
    fn a_failed_page_leaves_figures_tables_and_the_old_pdf() {
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("x.pdf"), "old").unwrap();
        let files = || Ok(vec![("figure.svg", "<svg/>".to_owned())]);
        let error = page("x.pdf", ("x.typ", "= One\n#panic(1)"), &files, "{}", dir.path(), &mut |_| ()).unwrap_err();
        assert!(matches!(error, ReportError::Typst(_)), "{error:?}");
        let said = error.to_string();
        assert!(said.contains("x.typ:2:") && said.contains("still the one from before"), "{said}");
        let mut names: Vec<_> = fs::read_dir(dir.path()).unwrap().map(|f| f.unwrap().file_name()).collect();
        names.sort();
        assert_eq!(names, ["figure.svg", "x.pdf"], "what is left");
        assert_eq!(fs::read(dir.path().join("x.pdf")).unwrap(), b"old", "the old page");
    }

    #[test]
    fn a_directory_that_cannot_be_made_is_named() {
        let dir = tempfile::tempdir().unwrap();
        let file = dir.path().join("file");
        fs::write(&file, "").unwrap();
        let error = write(Report::Paper, &file.join("in"), &mut |_| ()).unwrap_err();
        assert!(matches!(&error, ReportError::Io { path, .. } if path.ends_with("file/in")), "{error:?}");
    }
}
