//! This module puts the wheel of typst into the project's cache: a Python environment of its own, made within seconds.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use super::find::{self, Env};
use super::run::run;
use super::{Typst, VERSION, failed};
use crate::ReportError;
use crate::leftovers::Listed;

/// The version of the wheel, which differs from that of typst.
const WHEEL: &str = "0.15.2";
/// The packages that pip may install.
const LIST: &str = include_str!("wheel.txt");
/// Python reads no settings and nothing of the directory that it runs in; the script takes the arguments of typst.
const BEFORE: &[&str] = &["-I", "-X", "utf8", "-c", include_str!("wheel.py")];
/// The time limit of a step; each takes seconds, or minutes where the network is slow.
pub(super) const STEP_LIMIT: Duration = Duration::from_secs(10 * 60);
/// The beginning of the name of an environment that is not complete.
const PART: &str = "part-";

/// Returns the wheel in the cache, whether it is there or not.
pub(super) fn kept(root: &Path) -> Typst {
    typst(&whole(root))
}

fn whole(root: &Path) -> PathBuf {
    root.join(format!("wheel-{WHEEL}"))
}

fn typst(environment: &Path) -> Typst {
    let python = if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" };
    Typst { before: BEFORE, ..Typst::new(environment.join(python)) }
}

/// Installs the wheel with the first Python on PATH. The environment has another name until it runs, so that the remains of a killed
/// process are never taken for a complete one; no other process does this at the same time.
pub(super) fn install(
    env: Env<'_>,
    root: &Path,
    limit: Duration,
    progress: &mut dyn FnMut(&str),
) -> Result<Typst, ReportError> {
    let name = if cfg!(windows) { "python" } else { "python3" };
    let Some(python) = find::on_path(env, name).into_iter().next() else {
        return Err(failed(format!("the wheel of typst needs {name}, and none is on PATH")));
    };
    progress(&format!(
        "no typst found: fetching its wheel for Python, 34 MB, into {}; some 10 seconds, once",
        root.display()
    ));
    let io = |path: &Path| {
        let path = path.to_owned();
        move |source| ReportError::Io { path, source }
    };
    for left in fs::read_dir(root).map_err(io(root))?.flatten() {
        if left.file_name().to_string_lossy().starts_with(PART) {
            let _ = fs::remove_dir_all(left.path()); // of a process that was killed; it does no harm
        }
    }
    let (_work, work) = Listed::directory(tempfile::tempdir).map_err(io(&std::env::temp_dir()))?;
    let part = || tempfile::Builder::new().prefix(PART).tempdir_in(root);
    let (_part, part) = Listed::directory(part).map_err(io(root))?;
    let (work, part) = (work.path(), part.path());
    let list = work.join("wheel.txt");
    fs::write(&list, LIST).map_err(io(&list))?;
    let made = typst(part);
    step(Command::new(&python).args(["-I", "-m", "venv"]).arg(part), work, limit, &python)?;
    let pip = ["-I", "-m", "pip", "install", "--no-input", "--disable-pip-version-check", "--no-cache-dir"];
    let wheel = ["--only-binary=:all:", "--no-deps", "--require-hashes", "--retries=2", "-r", "wheel.txt"];
    step(Command::new(&made.program).args(pip).args(wheel), work, limit, &python)?;
    made.asked()?;
    let whole = whole(root);
    if whole.exists() {
        fs::remove_dir_all(&whole).map_err(io(&whole))?; // it does not run: its Python may be gone
    }
    fs::rename(part, &whole).map_err(io(&whole))?;
    Ok(kept(root))
}

/// Runs a step of the installation by `python` in a directory of its own, which takes its temporaries as well.
fn step(command: &mut Command, work: &Path, limit: Duration, python: &Path) -> Result<(), ReportError> {
    command.current_dir(work);
    for name in ["TMPDIR", "TEMP", "TMP"] {
        command.env(name, work);
    }
    // The user's settings of pip say where the wheel is fetched from; it goes where we say.
    for name in ["PIP_TARGET", "PIP_PREFIX", "PIP_ROOT"] {
        command.env_remove(name);
    }
    let ended = run(command.env("PIP_USER", "0"), limit, python)?;
    if ended.success {
        return Ok(());
    }
    let said = if ended.stderr.trim().is_empty() { ended.stdout } else { ended.stderr };
    Err(failed(format!(
        "the wheel of typst {VERSION} could not be installed with {}: {}",
        python.display(),
        said.trim()
    )))
}

#[cfg(test)]
#[cfg(unix)]
mod tests {
    use std::ffi::OsString;
    use std::thread;

    use super::*;
    use crate::typst::tests::stand_in;

    /// Stands in for Python: its environment is a copy of it, and it notes the arguments of pip and where it runs.
    const GOOD: &str = "case $3 in venv) mkdir $4/bin; cp $0 $4/bin/python;; \
        pip) sleep 0.1; echo \"$PWD $TMPDIR $*\" >> ${0%/clatter/*}/noted; cat wheel.txt > list;; *) echo typst 0.15.1;; esac";

    /// A cache with a stand-in for Python on PATH, and one for cargo that builds nothing.
    struct Cache {
        dir: tempfile::TempDir,
        cargo: PathBuf,
    }

    impl Cache {
        fn with(python: &str) -> Self {
            let dir = tempfile::tempdir().unwrap();
            stand_in(dir.path(), "python3", python);
            let cargo = stand_in(dir.path(), "cargo", "echo cargo >> ${0%/*}/noted; exit 1");
            Self { dir, cargo }
        }

        fn root(&self) -> PathBuf {
            self.dir.path().join(format!("clatter/typst-{VERSION}"))
        }

        fn env(&self, name: &str) -> Option<OsString> {
            match name {
                // The stand-ins call programs of the system, but no Python of it.
                "PATH" | "XDG_CACHE_HOME" => Some(self.dir.path().into()),
                "CARGO" => Some(self.cargo.clone().into()),
                _ => None,
            }
        }

        fn find(&self) -> Result<(Typst, Vec<String>), ReportError> {
            Typst::find_with(&|name| self.env(name), &mut |_| ())
        }

        /// Returns the notes that pip and cargo left.
        fn noted(&self) -> String {
            fs::read_to_string(self.dir.path().join("noted")).unwrap_or_default()
        }

        /// Returns the sorted names in the cache of typst.
        fn names(&self) -> Vec<String> {
            let all = fs::read_dir(self.root()).unwrap();
            let mut names: Vec<_> = all.map(|f| f.unwrap().file_name().into_string().unwrap()).collect();
            names.sort();
            names
        }
    }

    #[test]
    fn it_is_installed_once_also_by_two_at_a_time_and_then_found() {
        let cache = Cache::with(GOOD);
        let found = thread::scope(|scope| {
            let both = [(); 2].map(|()| scope.spawn(|| cache.find().unwrap()));
            both.map(|one| one.join().unwrap())
        });
        for (typst, warnings) in found.into_iter().chain([cache.find().unwrap()]) {
            assert_eq!((typst.program, warnings), (kept(&cache.root()).program, vec![]));
        }
        assert_eq!(cache.names(), ["lock", "wheel-0.15.2"]);
        let noted = cache.noted();
        let words: Vec<_> = noted.split_whitespace().collect();
        assert!(noted.lines().count() == 1 && noted.contains("--require-hashes"), "{noted}");
        assert!(words[0] == words[1] && !Path::new(words[0]).exists(), "a directory of its own, gone again: {noted}");
    }

    #[test]
    fn where_it_cannot_be_installed_nothing_is_left_and_cargo_is_asked() {
        for (python, says) in [
            (GOOD.replace("mkdir", "echo no module named venv; exit 1; mkdir"), "no module named venv"),
            (
                GOOD.replace("sleep", "echo pip >> ${0%/clatter/*}/noted; echo no network >&2; exit 1; sleep"),
                "no network",
            ),
            (GOOD.replace("echo typst", "echo too old >&2; echo Typst"), "does not tell its version: too old"),
            (GOOD.replace("cp $0", "true"), "cannot be started"),
        ] {
            let cache = Cache::with(&python);
            let error = cache.find().unwrap_err().to_string();
            assert!(
                error.starts_with("no typst: typst could not be built") && error.contains(says),
                "{python}: {error}"
            );
            assert_eq!(cache.names(), ["lock"], "{python}");
            assert!(cache.noted().ends_with("cargo\n"), "{python}");
        }
        let cache = Cache::with(GOOD);
        fs::remove_file(cache.dir.path().join("python3")).unwrap();
        let error = cache.find().unwrap_err().to_string();
        assert!(error.contains("needs python3, and none is on PATH"), "{error}");
    }

    #[test]
    fn a_step_that_hangs_is_cut_off_and_leaves_nothing() {
        let cache = Cache::with(&GOOD.replace("sleep 0.1", "sleep 60"));
        fs::create_dir_all(cache.root()).unwrap();
        let limit = Duration::from_millis(300);
        let error = install(&|name| cache.env(name), &cache.root(), limit, &mut |_| ()).unwrap_err().to_string();
        assert!(error.contains("python3 was cut off: it had not ended after 0.3 s"), "{error}");
        assert_eq!(cache.names(), [""; 0]);
    }

    #[test]
    fn what_is_not_whole_or_runs_no_longer_is_replaced() {
        let cache = Cache::with(GOOD);
        // Killed processes left these: one before the end, and one with the name of a complete one but without its Python.
        for dir in ["part-1/bin", "wheel-0.15.2/lib"] {
            fs::create_dir_all(cache.root().join(dir)).unwrap();
        }
        assert_eq!(cache.find().unwrap().1, [""; 0]);
        assert_eq!(cache.names(), ["lock", "wheel-0.15.2"]);
        // The Python that it was made with is another one now.
        stand_in(kept(&cache.root()).program.parent().unwrap(), "python", "echo no typst >&2; exit 1");
        let (typst, warnings) = cache.find().unwrap();
        assert!(warnings.len() == 1 && warnings[0].ends_with("does not tell its version: no typst"), "{warnings:?}");
        assert!(typst.asked().is_ok() && !cache.root().join("wheel-0.15.2/lib").exists(), "it is new");
    }

    #[test]
    fn it_is_not_fetched_when_told_not_to() {
        let cache = Cache::with(GOOD);
        let env = |name: &str| if name == "CLATTER_NO_INSTALL" { Some("1".into()) } else { cache.env(name) };
        let error = Typst::find_with(&env, &mut |_| ()).unwrap_err().to_string();
        assert!(error.contains("CLATTER_NO_INSTALL"), "{error}");
        assert!(cache.noted().is_empty() && !cache.root().exists(), "{}", cache.noted());
    }
}
