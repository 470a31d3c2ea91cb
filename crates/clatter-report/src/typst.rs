//! The one place that starts typst.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use crate::ReportError;

/// The version the pages are tested with.
const VERSION: &str = "0.15.1";
/// A compile of these pages takes well under a second; whatever takes so long hangs.
const COMPILE_LIMIT: Duration = Duration::from_secs(120);
/// Asking for the version takes milliseconds.
const VERSION_LIMIT: Duration = Duration::from_secs(20);

/// A typst to start.
#[derive(Debug)]
pub(crate) struct Typst {
    program: PathBuf,
    limit: Duration,
}

/// Looks up an environment variable; what is empty counts as not set.
type Env<'a> = &'a dyn Fn(&str) -> Option<OsString>;

/// How a run ended, where it did not hang.
struct Ended {
    success: bool,
    stdout: String,
    stderr: String,
}

fn failed(message: impl Into<String>) -> ReportError {
    ReportError::Typst(message.into())
}

impl Typst {
    /// The typst that `CLATTER_TYPST` names, else the one on PATH, else the one in the project's cache, else a
    /// new one there, built with cargo unless `CLATTER_NO_INSTALL` is set. A version other than the tested one
    /// is a warning.
    pub(crate) fn find(progress: &mut dyn FnMut(&str)) -> Result<(Self, Option<String>), ReportError> {
        Self::find_with(&|name| std::env::var_os(name).filter(|value| !value.is_empty()), progress)
    }

    fn find_with(env: Env<'_>, progress: &mut dyn FnMut(&str)) -> Result<(Self, Option<String>), ReportError> {
        let typst = Self { program: locate(env, progress)?, limit: COMPILE_LIMIT };
        let ended = run(Command::new(&typst.program).arg("--version"), VERSION_LIMIT, &typst.program)?;
        let version = ended.stdout.split_whitespace().nth(1).unwrap_or_default();
        if !ended.success || !ended.stdout.starts_with("typst ") {
            return Err(failed(format!("{} is not typst: it does not tell its version", typst.program.display())));
        }
        let warning = (version != VERSION)
            .then(|| format!("typst {version} at {}: the pages are tested with {VERSION}", typst.program.display()));
        Ok((typst, warning))
    }

    /// Compiles `main`, a file in `root`, and gives the PDF. Whatever typst says is a failure: it warns of missing
    /// fonts and goes on.
    pub(crate) fn compile(&self, root: &Path, main: &str) -> Result<Vec<u8>, ReportError> {
        let output = root.join("page.pdf");
        let mut command = Command::new(&self.program);
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
        fs::read(&output).map_err(|source| ReportError::Io { path: output, source })
    }
}

/// Finds or builds the program.
fn locate(env: Env<'_>, progress: &mut dyn FnMut(&str)) -> Result<PathBuf, ReportError> {
    if let Some(named) = env("CLATTER_TYPST") {
        let path = PathBuf::from(named);
        return if path.is_file() {
            Ok(path)
        } else {
            Err(failed(format!("CLATTER_TYPST names {}, which is no file", path.display())))
        };
    }
    let name = format!("typst{}", std::env::consts::EXE_SUFFIX);
    let path = env("PATH").unwrap_or_default();
    if let Some(found) = std::env::split_paths(&path).map(|dir| dir.join(&name)).find(|file| file.is_file()) {
        return Ok(found);
    }
    let Some(cache) = cache(env) else {
        return Err(failed("no typst on PATH, and no home directory to keep one in; set CLATTER_TYPST"));
    };
    let root = cache.join("clatter").join(format!("typst-{VERSION}"));
    let program = root.join("bin").join(&name);
    if program.is_file() {
        return Ok(program);
    }
    let build = format!(
        "cargo install typst-cli --version {VERSION} --locked --no-default-features --features embedded-fonts,vendor-openssl"
    );
    if env("CLATTER_NO_INSTALL").is_some_and(|value| value != "0") {
        return Err(failed(format!(
            "no typst: set CLATTER_TYPST, put typst {VERSION} on PATH, or unset CLATTER_NO_INSTALL to have it built; \
             by hand: {build}"
        )));
    }
    // two commands, or two tests, must not build it twice
    let lock = fs::create_dir_all(&root).and_then(|()| fs::File::create(root.join("lock")));
    let lock = lock.and_then(|file| file.lock().map(|()| file));
    let _lock = lock.map_err(|source| ReportError::Io { path: root.join("lock"), source })?;
    if program.is_file() {
        return Ok(program);
    }
    progress(&format!("no typst found: building {VERSION} into {}, 7 to 12 minutes, once", root.display()));
    let status = Command::new(env("CARGO").unwrap_or_else(|| "cargo".into()))
        .args(build.split(' ').skip(1))
        .arg("--root")
        .arg(&root)
        .env("CARGO_PROFILE_RELEASE_OPT_LEVEL", "1") // sets a page as fast and builds in half the time
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .status()
        .map_err(|error| failed(format!("no typst, and cargo to build it cannot be started: {error}")))?;
    if status.success() && program.is_file() {
        Ok(program)
    } else {
        Err(failed(format!("typst could not be built ({status}); by hand: {build}")))
    }
}

/// The user's cache directory.
fn cache(env: Env<'_>) -> Option<PathBuf> {
    let dir = |name: &str| env(name).map(PathBuf::from);
    if let Some(xdg) = dir("XDG_CACHE_HOME").filter(|path| path.is_absolute()) {
        return Some(xdg);
    }
    if cfg!(windows) {
        dir("LOCALAPPDATA")
    } else if cfg!(target_os = "macos") {
        dir("HOME").map(|home| home.join("Library").join("Caches"))
    } else {
        dir("HOME").map(|home| home.join(".cache"))
    }
}

/// Runs a command to its end, or kills it at the limit.
fn run(command: &mut Command, limit: Duration, program: &Path) -> Result<Ended, ReportError> {
    let child = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
    let mut child = child.map_err(|error| failed(format!("{} cannot be started: {error}", program.display())))?;
    let readers = (reader(child.stdout.take()), reader(child.stderr.take()));
    let Some(success) = wait(&mut child, limit)? else {
        return Err(failed(format!("{} was cut off after {} s without an end", program.display(), limit.as_secs())));
    };
    let text = |handle: thread::JoinHandle<String>| handle.join().unwrap_or_default();
    Ok(Ended { success, stdout: text(readers.0), stderr: text(readers.1) })
}

/// Reads a pipe to its end beside the wait, so that a full pipe stops nobody.
fn reader(pipe: Option<impl std::io::Read + Send + 'static>) -> thread::JoinHandle<String> {
    thread::spawn(move || {
        let mut bytes = Vec::new();
        if let Some(mut pipe) = pipe {
            let _ = pipe.read_to_end(&mut bytes); // what was read until then is still worth showing
        }
        String::from_utf8_lossy(&bytes).into_owned()
    })
}

/// Whether the child succeeded; `None` if it had to be killed.
fn wait(child: &mut Child, limit: Duration) -> Result<Option<bool>, ReportError> {
    let end = Instant::now() + limit;
    loop {
        match child.try_wait() {
            Ok(Some(status)) => return Ok(Some(status.success())),
            Ok(None) if Instant::now() < end => thread::sleep(Duration::from_millis(2)),
            Ok(None) => {
                let _ = child.kill(); // it may have ended by itself in between
                let _ = child.wait();
                return Ok(None);
            }
            Err(error) => return Err(failed(format!("typst was lost: {error}"))),
        }
    }
}

#[cfg(test)]
#[cfg(unix)]
mod tests {
    use super::*;
    use std::os::unix::fs::PermissionsExt as _;

    /// A program in a directory of its own that stands in for typst.
    fn stand_in(script: &str) -> (tempfile::TempDir, PathBuf) {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("typst");
        fs::write(&path, format!("#!/bin/sh\n{script}\n")).unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
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
        let (dir, program) = stand_in(script);
        let done = Typst { program, limit }.compile(dir.path(), "page.typ");
        done.expect_err("a stand-in sets no page").to_string()
    }

    #[test]
    fn it_is_found_by_name_by_path_and_in_the_cache() {
        let (dir, program) = stand_in("echo typst 0.15.1");
        let cached = dir.path().join("clatter/typst-0.15.1/bin");
        fs::create_dir_all(&cached).unwrap();
        fs::copy(&program, cached.join("typst")).unwrap();
        for (name, value, want) in [
            ("CLATTER_TYPST", program.clone(), program.clone()),
            ("PATH", dir.path().to_owned(), program.clone()),
            ("XDG_CACHE_HOME", dir.path().to_owned(), cached.join("typst")),
        ] {
            let (typst, warning) = Typst::find_with(&only(name, &value), &mut |_| ()).unwrap();
            assert_eq!((typst.program, warning), (want, None), "{name}");
        }
    }

    #[test]
    fn another_version_is_a_warning_and_another_program_an_error() {
        let (_dir, program) = stand_in("echo typst 0.99.0");
        let (_, warning) = Typst::find_with(&only("CLATTER_TYPST", &program), &mut |_| ()).unwrap();
        assert!(warning.unwrap().contains("0.99.0"), "the warning tells the version");
        let (_dir, program) = stand_in("echo hello");
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

    #[test]
    fn a_warning_and_a_silent_failure_are_failures() {
        let warned = compile("echo 'page.typ:3:7: warning: unknown font' >&2; : > page.pdf", COMPILE_LIMIT);
        assert!(warned.contains("page.typ:3:7"), "{warned}");
        let silent = compile("exit 1", COMPILE_LIMIT);
        assert!(silent.contains("no reason"), "{silent}");
    }

    #[test]
    fn a_hang_is_cut_off() {
        let started = Instant::now();
        let error = compile("exec sleep 60", Duration::from_millis(100));
        assert!(error.contains("cut off"), "{error}");
        assert!(started.elapsed() < Duration::from_secs(50), "the child was waited for");
    }
}
