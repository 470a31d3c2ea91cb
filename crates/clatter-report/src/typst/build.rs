//! Builds typst into the project's cache.

use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use super::find::{Env, absolute};
use super::{VERSION, failed};
use crate::ReportError;

/// Some times what a build takes.
const LOCK_LIMIT: Duration = Duration::from_secs(45 * 60);

/// The cargo command, its words apart by one space; what is missing is where to.
pub(super) fn by_hand() -> String {
    format!(
        "cargo install typst-cli --version {VERSION} --locked --no-default-features --features embedded-fonts,vendor-openssl"
    )
}

/// Builds `program` into `root`, unless another process does so meanwhile.
pub(super) fn build(
    env: Env<'_>,
    root: &Path,
    program: PathBuf,
    progress: &mut dyn FnMut(&str),
) -> Result<PathBuf, ReportError> {
    let io = |source| ReportError::Io { path: root.into(), source };
    fs::create_dir_all(root).map_err(io)?;
    // Two commands, or two tests, must not build it twice.
    let _lock = lock(&root.join("lock"), LOCK_LIMIT, progress)?;
    if program.is_file() {
        return Ok(program);
    }
    progress(&format!("no typst found: building {VERSION} into {}, 7 to 12 minutes, once", root.display()));
    // cargo obeys settings in the directory that it runs in and those above, such as which compiler to run: it gets the topmost, which
    // is not for users to write to.
    let top = root.ancestors().last().unwrap_or(root);
    let cargo = env("CARGO").map_or("cargo".into(), PathBuf::from);
    let cargo = if cargo.components().count() > 1 { absolute(&cargo)? } else { cargo };
    let status = Command::new(cargo)
        .args(by_hand().split(' ').skip(1))
        .arg("--root")
        .arg(root)
        .current_dir(top)
        .env("CARGO_PROFILE_RELEASE_OPT_LEVEL", "1") // sets a page as fast and builds in half the time
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .status()
        .map_err(|error| failed(format!("no typst, and cargo to build it cannot be started: {error}")))?;
    if status.success() && program.is_file() {
        Ok(program)
    } else {
        Err(failed(format!("typst could not be built ({status}); by hand: {}", by_hand())))
    }
}

/// Takes the lock, or gives up at the limit.
fn lock(path: &Path, limit: Duration, progress: &mut dyn FnMut(&str)) -> Result<File, ReportError> {
    let io = |source| ReportError::Io { path: path.into(), source };
    let file = File::create(path).map_err(io)?;
    let end = Instant::now() + limit;
    let mut told = false;
    loop {
        match file.try_lock() {
            Ok(()) => return Ok(file),
            Err(TryLockError::Error(source)) => return Err(io(source)),
            Err(TryLockError::WouldBlock) if Instant::now() >= end => {
                let (path, limit) = (path.display(), limit.as_secs_f64());
                return Err(failed(format!(
                    "no typst: another process has held {path}, the lock for building it, for {limit} s; \
                     end that process, or set CLATTER_TYPST"
                )));
            }
            Err(TryLockError::WouldBlock) => {
                if !told {
                    progress(&format!("waiting for another process that builds typst: it holds {}", path.display()));
                    told = true;
                }
                thread::sleep(Duration::from_millis(50).min(limit));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_held_lock_is_told_and_waited_for_up_to_a_limit() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("lock");
        let holder = lock(&path, Duration::ZERO, &mut |said| panic!("{said}")).unwrap();
        let mut said = Vec::new();
        let error = lock(&path, Duration::from_millis(20), &mut |step| said.push(step.to_owned())).unwrap_err();
        assert!(matches!(error, ReportError::Typst(_)), "{error:?}");
        for text in [&error.to_string(), &said.concat()] {
            assert!(text.contains(&path.display().to_string()), "{text}");
        }
        assert_eq!(said.len(), 1, "{said:?}");
        drop(holder);
        // A process that another test starts at this moment holds it a little longer.
        lock(&path, Duration::from_secs(10), &mut |_| ()).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn cargo_runs_where_no_settings_are() {
        let dir = tempfile::tempdir().unwrap();
        // It notes where it runs, and puts a file where typst belongs.
        let script = "pwd > $0.noted\n\
            while [ $1 != --root ]; do shift; done; mkdir $2/bin; : > $2/bin/typst";
        let cargo = crate::typst::tests::stand_in(dir.path(), "cargo", script);
        let root = dir.path().canonicalize().unwrap().join("cache");
        let env = |name: &str| (name == "CARGO").then(|| cargo.clone().into_os_string());
        let built = build(&env, &root, root.join("bin/typst"), &mut |_| ()).unwrap();
        assert!(built.is_file(), "{}", built.display());
        let noted = fs::read_to_string(cargo.with_extension("noted")).unwrap();
        assert_eq!(noted.trim_end(), "/");
    }
}
