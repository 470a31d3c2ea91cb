//! What goes when the process is stopped from outside: temporary files and directories.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Temporaries that are there now.
static THERE: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn there() -> MutexGuard<'static, Vec<PathBuf>> {
    THERE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes every temporary file and directory. For the last moment of a process that is stopped by a signal or a time limit: nothing
/// that is written goes on, and no new temporary is made until the process ends.
pub fn remove_leftovers() {
    let mut there = there();
    for path in there.drain(..) {
        // What is gone already, or cannot be removed, is no reason to stay.
        let _ = if path.is_dir() { fs::remove_dir_all(&path) } else { fs::remove_file(&path) };
    }
    std::mem::forget(there);
}

/// A temporary that goes with the process, too.
#[derive(Debug)]
pub(crate) struct Temporary<T> {
    inner: T,
    path: PathBuf,
}

impl<T: AsRef<Path>> Temporary<T> {
    /// Makes one; no signal comes between its making and its listing.
    pub(crate) fn new(make: impl FnOnce() -> io::Result<T>) -> io::Result<Self> {
        let mut there = there();
        let inner = make()?;
        let path = inner.as_ref().to_owned();
        there.push(path.clone());
        Ok(Self { inner, path })
    }

    pub(crate) fn get(&mut self) -> &mut T {
        &mut self.inner
    }

    /// Ends it, by a new name for a file or by removing it, and takes it off the list.
    pub(crate) fn end<R>(self, end: impl FnOnce(T) -> R) -> R {
        let ended = end(self.inner);
        there().retain(|path| *path != self.path);
        ended
    }
}
