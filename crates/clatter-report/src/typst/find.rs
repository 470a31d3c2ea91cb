//! This module finds the places of programs: named, on PATH, or in the project's cache.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use super::build::by_hand;
use super::{VERSION, failed};
use crate::ReportError;

/// Looks up an environment variable; what is empty counts as not set.
pub(super) type Env<'a> = &'a dyn Fn(&str) -> Option<OsString>;

/// Returns the program that `CLATTER_TYPST` names, if it is set.
pub(super) fn named(env: Env<'_>) -> Result<Option<PathBuf>, ReportError> {
    let Some(named) = env("CLATTER_TYPST") else { return Ok(None) };
    let path = absolute(Path::new(&named))?;
    if path.is_file() {
        Ok(Some(path))
    } else {
        Err(failed(format!("CLATTER_TYPST names {}, which is no file", path.display())))
    }
}

/// Returns every file on PATH that is a program of this name, in their order.
pub(super) fn on_path(env: Env<'_>, name: &str) -> Vec<PathBuf> {
    let path = env("PATH").unwrap_or_default();
    let files = std::env::split_paths(&path).filter_map(|dir| absolute(&dir.join(program(name))).ok());
    files.filter(|file| file.is_file()).collect()
}

/// Returns the directory where the project keeps typst.
pub(super) fn root(env: Env<'_>) -> Result<PathBuf, ReportError> {
    let Some(cache) = cache(env) else {
        return Err(failed("none on PATH, and no home directory to keep one in; set CLATTER_TYPST"));
    };
    Ok(absolute(&cache)?.join("clatter").join(format!("typst-{VERSION}")))
}

/// Returns an error where `CLATTER_NO_INSTALL` forbids to put anything there.
pub(super) fn may_install(env: Env<'_>) -> Result<(), ReportError> {
    if env("CLATTER_NO_INSTALL").is_none_or(|value| value == "0") {
        return Ok(());
    }
    Err(failed(format!(
        "no typst: set CLATTER_TYPST, put typst {VERSION} on PATH, or unset CLATTER_NO_INSTALL to have it installed; \
         by hand: {}",
        by_hand()
    )))
}

/// Returns the same path from any directory: programs are run in directories of their own.
pub(super) fn absolute(path: &Path) -> Result<PathBuf, ReportError> {
    std::path::absolute(path).map_err(|source| ReportError::Io { path: path.into(), source })
}

/// Returns the file name of a program.
pub(super) fn program(name: &str) -> String {
    format!("{name}{}", std::env::consts::EXE_SUFFIX)
}

/// Returns the user's cache directory.
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
