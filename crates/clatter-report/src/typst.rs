//! This module is the one place that starts typst.

mod build;
mod find;
mod lock;
mod run;
mod wheel;

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use clatter_product::visible_lines;

use crate::ReportError;
use crate::leftovers::Listed;
use find::Env;
use run::run;

/// The version the pages are tested with.
const VERSION: &str = "0.15.1";
/// A compile of these pages takes well under a second; whatever takes so long hangs.
const COMPILE_LIMIT: Duration = Duration::from_secs(300);
/// The time limit of a request for the version, which takes milliseconds.
const VERSION_LIMIT: Duration = Duration::from_secs(20);
/// The time limit of the lock, which is several times that of a build.
const LOCK_LIMIT: Duration = Duration::from_secs(45 * 60);

/// A typst to start: its command, or a program that does the same once it is given some arguments before those of typst.
///
/// Reports find one by themselves; this is for those who must know which.
#[derive(Debug)]
pub struct Typst {
    program: PathBuf,
    before: &'static [&'static str],
    limit: Duration,
}

/// Returns a variable of the environment; an empty one counts as not set.
fn env(name: &str) -> Option<OsString> {
    std::env::var_os(name).filter(|value| !value.is_empty())
}

/// Makes the failure of an outside program; the message may hold the program's own words.
pub(crate) fn failed(message: impl AsRef<str>) -> ReportError {
    ReportError::Typst(visible_lines(message.as_ref()).into_owned())
}

impl Typst {
    fn new(program: PathBuf) -> Self {
        Self { program, before: &[], limit: COMPILE_LIMIT }
    }

    /// Finds the typst that `CLATTER_TYPST` names, else the first on PATH that runs, else the one in the project's cache, else makes
    /// a new one there, unless `CLATTER_NO_INSTALL` is set: the wheel for Python, and where that cannot be had, one built
    /// with cargo. Warnings name the ones that were passed over and a version other than the tested one.
    pub(crate) fn find(progress: &mut dyn FnMut(&str)) -> Result<(Self, Vec<String>), ReportError> {
        Self::find_with(&env, progress)
    }

    /// Finds the command typst of the version that the pages are tested with, where there is one: named by `CLATTER_TYPST`, on PATH or
    /// built into the project's cache.
    ///
    /// # Errors
    /// [`ReportError::Typst`] where `CLATTER_TYPST` names no file.
    pub fn by_command() -> Result<Option<Self>, ReportError> {
        let all = find::named(&env)?.into_iter().chain(find::on_path(&env, "typst")).map(Self::new);
        let mut all = all.chain(find::root(&env).ok().map(|root| build::kept(&root)));
        Ok(all.find(|typst| typst.asked().is_ok_and(|warning| warning.is_none())))
    }

    /// Finds the wheel of typst in the project's cache, or puts it there if none runs, unless `CLATTER_NO_INSTALL` is set.
    ///
    /// # Errors
    /// [`ReportError`] where it cannot be had.
    pub fn by_wheel(progress: &mut dyn FnMut(&str)) -> Result<Self, ReportError> {
        let root = find::root(&env)?;
        fs::create_dir_all(&root).map_err(|source| ReportError::Io { path: root.clone(), source })?;
        let _lock = lock::lock(&root.join("lock"), LOCK_LIMIT, progress)?;
        let kept = wheel::kept(&root);
        if kept.asked().is_ok() {
            return Ok(kept);
        }
        find::may_install(&env)?;
        wheel::install(&env, &root, wheel::STEP_LIMIT, progress)
    }

    /// Finds typst, and makes every failure one of the outside program: also a full disk, and a directory that cannot be written.
    fn find_with(env: Env<'_>, progress: &mut dyn FnMut(&str)) -> Result<(Self, Vec<String>), ReportError> {
        Self::search(env, progress).map_err(|error| {
            let text = match error {
                ReportError::Io { path, source } => format!("{}: {source}", path.display()),
                error => error.to_string(),
            };
            let said = text.strip_prefix("no typst: ").unwrap_or(&text);
            failed(format!("no typst: {said}"))
        })
    }

    fn search(env: Env<'_>, progress: &mut dyn FnMut(&str)) -> Result<(Self, Vec<String>), ReportError> {
        if let Some(named) = find::named(env)? {
            let typst = Self::new(named);
            let warning = typst.asked()?;
            return Ok((typst, warning.into_iter().collect()));
        }
        let mut warnings = Vec::new();
        let on_path = find::on_path(env, "typst").into_iter().map(Self::new);
        let found = match Self::first(on_path, &mut warnings) {
            Some(typst) => Ok(typst),
            None => Self::cached(env, &mut warnings, progress),
        };
        match found {
            Ok(typst) => Ok((typst, warnings)),
            Err(ReportError::Typst(text)) => Err(failed([&[text], &warnings[..]].concat().join("\n"))),
            Err(error) => Err(error),
        }
    }

    /// Returns the first that runs; the ones that were passed over, and remarks on that one, become warnings.
    fn first(all: impl IntoIterator<Item = Self>, warnings: &mut Vec<String>) -> Option<Self> {
        all.into_iter().find(|typst| match typst.asked() {
            Ok(warning) => {
                warnings.extend(warning);
                true
            }
            Err(error) => {
                warnings.push(format!("passed over: {error}"));
                false
            }
        })
    }

    /// Returns the one in the project's cache, or puts one there if none runs.
    fn cached(env: Env<'_>, warnings: &mut Vec<String>, progress: &mut dyn FnMut(&str)) -> Result<Self, ReportError> {
        let root = find::root(env)?;
        let kept = || [build::kept(&root), wheel::kept(&root)].into_iter().filter(|typst| typst.program.is_file());
        if let Some(typst) = Self::first(kept(), warnings) {
            return Ok(typst);
        }
        find::may_install(env)?;
        fs::create_dir_all(&root).map_err(|source| ReportError::Io { path: root.clone(), source })?;
        // Two commands, or two tests, must not do this twice.
        let _lock = lock::lock(&root.join("lock"), LOCK_LIMIT, progress)?;
        if let Some(typst) = Self::first(kept(), &mut Vec::new()) {
            return Ok(typst);
        }
        match wheel::install(env, &root, wheel::STEP_LIMIT, progress) {
            Ok(typst) => Ok(typst),
            Err(error) => {
                let why = format!("passed over: {error}");
                progress(&why); // now, for what follows takes minutes
                warnings.push(why);
                let typst = build::build(env, &root, progress)?;
                warnings.extend(typst.asked()?);
                Ok(typst)
            }
        }
    }

    /// Returns the command with the arguments that all runs of typst share.
    fn command(&self) -> Command {
        let mut command = Command::new(&self.program);
        command.args(self.before);
        command
    }

    /// Runs typst for its version; returns a warning where that is not the tested one.
    fn asked(&self) -> Result<Option<String>, ReportError> {
        let program = &self.program;
        let own = Listed::directory(tempfile::tempdir);
        let (_listed, own) = own.map_err(|source| ReportError::Io { path: std::env::temp_dir(), source })?;
        let ended = run(self.command().arg("--version").current_dir(&own), VERSION_LIMIT, program)?;
        let version = ended.stdout.split_whitespace().nth(1).unwrap_or_default();
        if !ended.success || !ended.stdout.starts_with("typst ") {
            let said = ended.stderr.lines().last().map_or(String::new(), |said| format!(": {said}"));
            return Err(failed(format!("{} is not typst: it does not tell its version{said}", program.display())));
        }
        Ok((version != VERSION).then(|| {
            let text = format!("typst {version} at {}: the pages are tested with {VERSION}", program.display());
            visible_lines(&text).into_owned()
        }))
    }

    /// Compiles `main`, a file in `root`, and gives the PDF. Whatever typst says is a failure: it warns of missing
    /// fonts and goes on.
    pub(crate) fn compile(&self, root: &Path, main: &str) -> Result<Vec<u8>, ReportError> {
        let output = root.join("page.pdf");
        let mut command = self.command();
        command.args(["compile", "--ignore-system-fonts", "--pdf-standard", "ua-1", "--diagnostic-format", "short"]);
        // the pages carry no date; this keeps typst from adding one
        command.args(["--creation-timestamp", "0", "--root", "."]).arg(main).arg("page.pdf").current_dir(root);
        for name in ["TYPST_FONT_PATHS", "TYPST_PACKAGE_PATH", "TYPST_ROOT", "TYPST_FEATURES", "SOURCE_DATE_EPOCH"] {
            command.env_remove(name);
        }
        let ended = run(&mut command, self.limit, &self.program)?;
        let said = ended.stderr.trim();
        if !ended.success || !said.is_empty() {
            let said = if said.is_empty() { "it gave no reason" } else { said };
            return Err(failed(format!("typst could not set the page: {said}")));
        }
        let pdf = if output.is_file() { fs::read(&output) } else { Err(std::io::ErrorKind::NotFound.into()) };
        let pdf = pdf.map_err(|error| failed(format!("{} made no page: {error}", self.program.display())))?;
        if is_pdf(&pdf) {
            Ok(pdf)
        } else {
            Err(failed(format!("{} made a page that is no whole PDF", self.program.display())))
        }
    }
}

/// Returns whether the bytes begin and end as a PDF does; after the end there may be little else.
fn is_pdf(bytes: &[u8]) -> bool {
    let last = &bytes[bytes.len().saturating_sub(1024)..];
    bytes.starts_with(b"%PDF-") && last.windows(5).any(|end| end == b"%%EOF")
}

#[cfg(test)]
mod both_ways;
#[cfg(test)]
mod ways;

#[cfg(test)]
#[cfg(unix)]
pub(crate) mod tests {
    use super::*;
    use std::os::unix::fs::PermissionsExt as _;

    /// Makes a program that stands in for another one.
    pub(crate) fn stand_in(dir: &Path, name: &str, script: &str) -> PathBuf {
        let path = dir.join(name);
        fs::write(&path, format!("#!/bin/sh\n[ \"$1\" = ready ] && exit\n{script}\n")).unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
        // A process that another test starts holds the file open for a moment: until then it cannot be run.
        while let Err(error) = Command::new(&path).arg("ready").status() {
            assert_eq!(error.kind(), std::io::ErrorKind::ExecutableFileBusy, "{error}");
        }
        path
    }

    /// Makes a stand-in for typst in a directory of its own.
    fn typst(script: &str) -> (tempfile::TempDir, PathBuf) {
        let dir = tempfile::tempdir().unwrap();
        let path = stand_in(dir.path(), "typst", script);
        (dir, path)
    }

    fn only(name: &'static str, value: &Path) -> impl Fn(&str) -> Option<OsString> {
        let value = value.as_os_str().to_owned();
        move |asked| match asked {
            "CLATTER_NO_INSTALL" => Some("1".into()),
            asked => (asked == name).then(|| value.clone()),
        }
    }

    fn compile(script: &str, limit: Duration) -> String {
        let (dir, program) = typst(script);
        let done = Typst { limit, ..Typst::new(program) }.compile(dir.path(), "page.typ");
        done.expect_err("a stand-in sets no page").to_string()
    }

    #[test]
    fn it_is_found_by_name_by_path_and_in_the_cache() {
        let (dir, program) = typst("echo typst 0.15.1");
        let cached = dir.path().join("clatter/typst-0.15.1/bin");
        fs::create_dir_all(&cached).unwrap();
        fs::copy(&program, cached.join("typst")).unwrap();
        for (name, value, want) in [
            ("CLATTER_TYPST", program.clone(), program.clone()),
            ("PATH", dir.path().to_owned(), program.clone()),
            ("XDG_CACHE_HOME", dir.path().to_owned(), cached.join("typst")),
        ] {
            let (typst, warnings) = Typst::find_with(&only(name, &value), &mut |_| ()).unwrap();
            assert_eq!((typst.program, warnings), (want, vec![]), "{name}");
        }
    }

    #[test]
    fn another_version_is_a_warning_and_another_program_an_error() {
        let (_dir, program) = typst("echo typst 0.99.0");
        let (_, warnings) = Typst::find_with(&only("CLATTER_TYPST", &program), &mut |_| ()).unwrap();
        assert!(warnings.concat().contains("typst 0.99.0"), "{warnings:?}");
        let (_dir, program) = typst("echo hello");
        let error = Typst::find_with(&only("CLATTER_TYPST", &program), &mut |_| ()).unwrap_err();
        assert!(error.to_string().contains("is not typst"), "{error}");
    }

    #[test]
    fn without_one_nothing_is_built_when_told_not_to() {
        let empty = tempfile::tempdir().unwrap();
        let error = Typst::find_with(&only("XDG_CACHE_HOME", empty.path()), &mut |_| ()).unwrap_err().to_string();
        assert!(error.contains("CLATTER_NO_INSTALL") && error.contains("cargo install typst-cli"), "{error}");
        let missing = empty.path().join("nowhere");
        let error = Typst::find_with(&only("CLATTER_TYPST", &missing), &mut |_| ()).unwrap_err().to_string();
        assert!(error.contains("nowhere"), "{error}");
    }

    /// A cache that is a file, a name without a file, a program that is no typst, no home: one kind of failure, one beginning.
    #[test]
    fn whatever_keeps_typst_away_is_one_failure() {
        let dir = tempfile::tempdir().unwrap();
        let file = dir.path().join("file");
        fs::write(&file, "").unwrap();
        let (_dir, hello) = typst("echo hello");
        let all = |name: &'static str, value: PathBuf| {
            move |asked: &str| (asked == name).then(|| value.clone().into_os_string())
        };
        for env in [
            &all("XDG_CACHE_HOME", file.clone()) as Env<'_>,
            &all("CLATTER_TYPST", dir.path().join("nowhere")),
            &all("CLATTER_TYPST", hello),
            &all("NOTHING", PathBuf::new()),
        ] {
            let error = Typst::find_with(env, &mut |_| ()).unwrap_err();
            assert!(matches!(&error, ReportError::Typst(text) if text.starts_with("no typst: ")), "{error:?}");
        }
    }

    #[test]
    fn a_warning_and_a_silent_failure_are_failures() {
        let warned = compile("echo 'page.typ:3:7: warning: unknown font' >&2; : > page.pdf", COMPILE_LIMIT);
        assert!(warned.contains("page.typ:3:7"), "{warned}");
        let silent = compile("exit 1", COMPILE_LIMIT);
        assert!(silent.contains("no reason"), "{silent}");
    }

    #[test]
    fn a_hang_is_cut_off() {
        let started = std::time::Instant::now();
        // The script is not replaced by what it runs, which holds its output open.
        let error = compile("sleep 60", Duration::from_millis(100));
        assert!(error.contains("cut off"), "{error}");
        assert!(started.elapsed() < Duration::from_secs(50), "the child was waited for");
    }

    #[test]
    fn what_is_no_pdf_is_no_page() {
        for (script, says) in [
            ("true", "made no page"),
            ("mkdir page.pdf", "made no page"),
            (": > page.pdf", "no whole PDF"),
            ("echo junk %%EOF > page.pdf", "no whole PDF"),
            ("echo %PDF-1.7 > page.pdf", "no whole PDF"),
            ("(echo %PDF-1.7 %%EOF; yes | head -c 2000) > page.pdf", "no whole PDF"),
        ] {
            let error = compile(script, COMPILE_LIMIT);
            assert!(error.contains(says), "{script}: {error}");
        }
        let (dir, program) = typst("(echo %PDF-1.7; yes | head -c 2000; echo %%EOF) > page.pdf");
        let pdf = Typst::new(program).compile(dir.path(), "page.typ").unwrap();
        assert_eq!(pdf.len(), 9 + 2000 + 6);
    }

    #[test]
    fn on_path_what_does_not_run_is_passed_over() {
        let (last, program) = typst("echo typst 0.15.1");
        let plain = tempfile::tempdir().unwrap();
        fs::write(plain.path().join("typst"), "no program").unwrap();
        let (format, other) = typst("");
        fs::write(other, b"\x7fELF, but not really").unwrap();
        let (hello, _) = typst("echo hello");
        let dirs = [plain.path(), format.path(), hello.path()];
        let path = |dirs: &[&Path]| PathBuf::from(std::env::join_paths(dirs).unwrap());
        let all = path(&[&dirs[..], &[last.path()]].concat());
        let (typst, warnings) = Typst::find_with(&only("PATH", &all), &mut |_| ()).unwrap();
        assert_eq!((typst.program, warnings.len()), (program, 3), "{warnings:?}");
        // Where none runs, the error names each of them.
        let bad = path(&dirs);
        let env = |name: &str| match name {
            "PATH" => Some(bad.clone().into_os_string()),
            "XDG_CACHE_HOME" => Some(plain.path().into()),
            name => only("", plain.path())(name),
        };
        let error = Typst::find_with(&env, &mut |_| ()).unwrap_err().to_string();
        assert!(error.starts_with("no typst: ") && error.matches("\npassed over: ").count() == 3, "{error}");
    }

    #[test]
    fn what_typst_says_is_harmless_for_a_terminal() {
        let said =
            compile(r"printf 'page.typ:\033[2J\007\tred\r\nnext\342\200\256\302\233m' >&2; exit 1", COMPILE_LIMIT);
        assert!(said.ends_with("page.typ:\\u{1b}[2J\\u{7}    red\nnext\\u{202e}\\u{9b}m"), "{said:?}");
        let (_dir, program) = typst(r"printf 'typst \033[31m'");
        let (_, warnings) = Typst::find_with(&only("CLATTER_TYPST", &program), &mut |_| ()).unwrap();
        assert!(warnings.concat().contains("typst \\u{1b}[31m"), "{warnings:?}");
    }
}
