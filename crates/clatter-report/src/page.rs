//! A report on paper: its files computed and written, its page set from them.

use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::thread;

use crate::leftovers::Listed;
use crate::typst::{Typst, failed};
use crate::{ReportError, Written, is_protected, paper, replace};

/// The shared style of all pages.
const STYLE: &str = include_str!("../../../reports/style.typ");

/// Computes and writes the files while typst is looked for, then sets the page from them and from `inputs`, which are
/// not written, in a directory of its own.
pub(crate) fn page(
    pdf: &str,
    (name, source): (&str, &str),
    compute: &(impl Fn() -> Result<Vec<paper::File>, ReportError> + Sync),
    inputs: &[(&str, &str)],
    dir: &Path,
    progress: &mut dyn FnMut(&str),
) -> Result<Written, ReportError> {
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
        Ok::<_, ReportError>((files, paths))
    };
    let (files, typst) = thread::scope(|scope| {
        let beside = thread::Builder::new().spawn_scoped(scope, files);
        let typst = Typst::find(progress);
        let files = match beside {
            Ok(beside) => beside.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)),
            // Where no further thread can be made, one after the other.
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
    let bytes = set(&typst, (name, source), all).map_err(stale)?;
    let mut written = Written { files: vec![place(dir, pdf, &bytes)?], warnings };
    written.files.extend(paths);
    Ok(written)
}

/// Sets a page from its source, the shared style and `files`, in a directory of its own.
pub(crate) fn set<'a>(
    typst: &Typst,
    (name, source): (&'a str, &'a str),
    files: impl Iterator<Item = (&'a str, &'a str)>,
) -> Result<Vec<u8>, ReportError> {
    let work = Listed::directory(tempfile::tempdir);
    let (_listed, work) = work.map_err(|source| ReportError::Io { path: std::env::temp_dir(), source })?;
    for (name, content) in files.chain([(name, source), ("style.typ", STYLE)]) {
        let path = work.path().join(name);
        fs::write(&path, content).map_err(|source| ReportError::Io { path, source })?;
    }
    typst.compile(work.path(), name)
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
    use crate::{Report, write};

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
        page("page.pdf", source, &files, &[("page.json", &paper::page())], dir.path(), &mut |_| ()).unwrap();
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
        for report in [Report::Paper, Report::Shock, Report::Accuracy] {
            let files = run(report);
            assert!(files.len() > 3 && files == run(report), "two runs of {report:?} differ");
        }
    }

    #[test]
    fn a_failed_page_leaves_figures_tables_and_the_old_pdf() {
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("x.pdf"), "old").unwrap();
        let files = || Ok(vec![("figure.svg", "<svg/>".to_owned())]);
        let error = page("x.pdf", ("x.typ", "= One\n#panic(1)"), &files, &[], dir.path(), &mut |_| ()).unwrap_err();
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
        let error = page("x.pdf", ("x.typ", "= One"), &|| Ok(vec![]), &[], &file, &mut |_| ()).unwrap_err();
        assert!(error.to_string().ends_with("is a file; the reports need a directory"), "{error}");
    }
}
