//! This module builds typst into the project's cache.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use super::find::{Env, absolute, program};
use super::{Typst, VERSION, failed};
use crate::ReportError;

/// Returns the cargo command, with one space between its words; the place to build into is missing.
pub(super) fn by_hand() -> String {
    format!(
        "cargo install typst-cli --version {VERSION} --locked --no-default-features --features embedded-fonts,vendor-openssl"
    )
}

/// Returns the typst built into the cache, whether it is there or not.
pub(super) fn kept(root: &Path) -> Typst {
    Typst::new(root.join("bin").join(program("typst")))
}

/// Builds typst into `root`; no other process does so at the same time.
pub(super) fn build(env: Env<'_>, root: &Path, progress: &mut dyn FnMut(&str)) -> Result<Typst, ReportError> {
    progress(&format!("building typst {VERSION} with cargo into {}, 7 to 12 minutes, once", root.display()));
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
    let typst = kept(root);
    if status.success() && typst.program.is_file() {
        Ok(typst)
    } else {
        Err(failed(format!("typst could not be built ({status}); by hand: {}", by_hand())))
    }
}

#[cfg(test)]
#[cfg(unix)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn cargo_runs_where_no_settings_are() {
        let dir = tempfile::tempdir().unwrap();
        // It notes where it runs, and puts a file where typst belongs.
        let script = "pwd > $0.noted\n\
            while [ $1 != --root ]; do shift; done; mkdir $2/bin; : > $2/bin/typst";
        let cargo = crate::typst::tests::stand_in(dir.path(), "cargo", script);
        let root = dir.path().canonicalize().unwrap().join("cache");
        let env = |name: &str| (name == "CARGO").then(|| cargo.clone().into_os_string());
        fs::create_dir(&root).unwrap();
        let built = build(&env, &root, &mut |_| ()).unwrap();
        assert!(built.program.is_file(), "{}", built.program.display());
        let noted = fs::read_to_string(cargo.with_extension("noted")).unwrap();
        assert_eq!(noted.trim_end(), "/");
    }
}
