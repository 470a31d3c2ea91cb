//! This module makes a report on paper: its files are computed and written, and its page is set from them.

use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::thread;

use crate::leftovers::Listed;
use crate::typst::{Typst, failed};
use crate::{ReportError, Written, is_protected, replace};

/// The shared style of all pages.
const STYLE: &str = include_str!("../../../reports/style.typ");
/// The data that every page receives in addition to its own.
const PAGE: &str = concat!("{\"version\":\"", env!("CARGO_PKG_VERSION"), "\"}");

/// A file of a report that needs no typst: its name and content.
pub type File = (&'static str, String);

/// Writes a report into `dir`, which is made if it is missing: its files as `compute` gives them, and the pages `pdf`, set from
/// the source of that name, from the files and from `inputs`, which are not written.
///
/// The files are computed while typst is looked for. Each is written next to its place and renamed, so that none is ever half
/// there. `progress` gets one line a step.
///
/// ```no_run
/// // typst may have to be installed first
/// use clatter_report::{File, ReportError, write_pages};
/// let files = || Ok::<_, ReportError>(vec![("speed.json", "4.43".to_owned())]);
/// let source = "#set document(title: \"Speed\")\n= Speed\n#json(\"speed.json\") m/s";
/// let written = write_pages("speed.pdf", ("speed.typ", source), &files, &[], "report".as_ref(), &mut |_| ())?;
/// assert!(written.files[0].ends_with("speed.pdf"));
/// # Ok::<(), ReportError>(())
/// ```
///
/// # Errors
/// Those of `compute`, and [`ReportError`]; with [`ReportError::Typst`] everything but the PDF has been written.
pub fn write_pages<E: From<ReportError> + Send>(
    pdf: &str,
    (name, source): (&str, &str),
    compute: &(impl Fn() -> Result<Vec<File>, E> + Sync),
    inputs: &[(&str, &str)],
    dir: &Path,
    progress: &mut dyn FnMut(&str),
) -> Result<Written, E> {
    fs::create_dir_all(dir).map_err(|source| {
        let is_file = source.kind() == io::ErrorKind::AlreadyExists;
        let source = if is_file { io::Error::other("is a file; the reports need a directory") } else { source };
        ReportError::Io { path: dir.into(), source }
    })?;
    progress("computing figures and tables");
    let files = || {
        let files = compute()?;
        let paths = files.iter().map(|(name, content)| place(dir, name, content.as_bytes()));
        let paths = paths.collect::<Result<Vec<_>, _>>()?;
        Ok::<_, E>((files, paths))
    };
    let (files, typst) = thread::scope(|scope| {
        let beside = thread::Builder::new().spawn_scoped(scope, files);
        let typst = Typst::find(progress);
        let files = match beside {
            Ok(beside) => beside.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)),
            // The files come after the search for typst where no further thread can be made.
            Err(_) => files(),
        };
        (files, typst)
    });
    let (files, paths) = files?;
    let target = dir.join(pdf);
    let stale = |error| match error {
        ReportError::Typst(text) if target.exists() => {
            failed(format!("{text}\n{} is still the one from before", target.display()))
        }
        error => error,
    };
    let (typst, warnings) = typst.map_err(stale)?;
    progress("setting the page");
    let all = files.iter().map(|(name, content)| (*name, content.as_str())).chain(inputs.iter().copied());
    let bytes = typst.set((name, source), all).map_err(stale)?;
    let mut written = Written { files: vec![place(dir, pdf, &bytes)?], warnings };
    written.files.extend(paths);
    Ok(written)
}

impl Typst {
    /// Sets pages from their source, the shared style, the version and `files`, in a directory of its own.
    ///
    /// # Errors
    /// [`ReportError`].
    pub fn set<'a>(
        &self,
        (name, source): (&'a str, &'a str),
        files: impl Iterator<Item = (&'a str, &'a str)>,
    ) -> Result<Vec<u8>, ReportError> {
        let work = Listed::directory(tempfile::tempdir);
        let (_listed, work) = work.map_err(|source| ReportError::Io { path: std::env::temp_dir(), source })?;
        let shared = [("style.typ", STYLE), ("page.json", PAGE)];
        for (name, content) in files.chain(shared).chain([(name, source)]) {
            let path = work.path().join(name);
            fs::write(&path, content).map_err(|source| ReportError::Io { path, source })?;
        }
        self.compile(work.path(), name)
    }
}

/// Writes a file into `dir`.
fn place(dir: &Path, name: &str, content: &[u8]) -> Result<PathBuf, ReportError> {
    let target = dir.join(name);
    if is_protected(&target) {
        let source = io::Error::other("it is write-protected: remove it, or choose another directory");
        return Err(ReportError::Io { path: target, source });
    }
    match replace(&target, |file| file.write_all(content)) {
        Ok(()) => Ok(target),
        Err(source) => Err(ReportError::Io { path: target, source }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Made = Result<Vec<File>, ReportError>;

    #[test]
    fn a_failed_page_leaves_figures_tables_and_the_old_pdf() {
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("x.pdf"), "old").unwrap();
        let files = || Made::Ok(vec![("figure.svg", "<svg/>".to_owned())]);
        let error =
            write_pages("x.pdf", ("x.typ", "= One\n#panic(1)"), &files, &[], dir.path(), &mut |_| ()).unwrap_err();
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
        let write = |dir: &Path| write_pages("x.pdf", ("x.typ", "= One"), &|| Made::Ok(vec![]), &[], dir, &mut |_| ());
        let error = write(&file.join("in")).unwrap_err();
        assert!(matches!(&error, ReportError::Io { path, .. } if path.ends_with("file/in")), "{error:?}");
        let error = write(&file).unwrap_err();
        assert!(error.to_string().ends_with("is a file; the reports need a directory"), "{error}");
    }
}
