//! This module removes the leftovers of a process that is stopped from outside: temporary files and directories, and programs that work
//! for it.

use std::fs;
use std::io;
use std::path::PathBuf;
use std::process::Child;
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::TempDir;

/// A thing that must not outlive the process.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Left {
    Path(PathBuf),
    /// A program and what it started, by the number of their group.
    Group(u32),
}

/// The leftovers that are there now.
static THERE: Mutex<Vec<Left>> = Mutex::new(Vec::new());

fn there() -> MutexGuard<'static, Vec<Left>> {
    THERE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes every temporary file and directory, and ends the programs that work for the process. For its last moment, where a signal
/// or a time limit stops it: no new temporary is made and no program started until it ends.
pub fn remove_leftovers() {
    let mut there = there();
    // Programs end first: they write into the directories.
    there.sort_by_key(|left| matches!(left, Left::Path(_)));
    for left in there.drain(..) {
        // A leftover that is gone already, or that cannot be removed, is no reason to stay.
        match left {
            Left::Group(number) => kill_group(number),
            Left::Path(path) if path.is_dir() => drop(fs::remove_dir_all(&path)),
            Left::Path(path) => drop(fs::remove_file(&path)),
        }
    }
    std::mem::forget(there);
}

/// Kills a program and what it started.
#[cfg(unix)]
pub(crate) fn kill_group(number: u32) {
    use rustix::process::{Pid, Signal, kill_process_group};
    if let Some(group) = i32::try_from(number).ok().and_then(Pid::from_raw) {
        // A program that has ended by itself in the meantime needs no killing.
        let _ = kill_process_group(group, Signal::KILL);
    }
}

#[cfg(not(unix))]
pub(crate) fn kill_group(_: u32) {}

/// Keeps something on the list, and takes it off when this is dropped, which must come after the end of the thing itself.
#[derive(Debug)]
pub(crate) struct Listed(Left);

impl Listed {
    /// Makes something; no signal comes between its making and its listing.
    pub(crate) fn new<T>(make: impl FnOnce() -> io::Result<T>, of: impl FnOnce(&T) -> Left) -> io::Result<(Self, T)> {
        let mut there = there();
        let made = make()?;
        let left = of(&made);
        there.push(left.clone());
        Ok((Self(left), made))
    }

    /// Makes a temporary directory and keeps it on the list.
    pub(crate) fn directory(make: impl FnOnce() -> io::Result<TempDir>) -> io::Result<(Self, TempDir)> {
        Self::new(make, |dir| Left::Path(dir.path().to_owned()))
    }

    /// Starts a program that leads a group of its own, and keeps it on the list.
    pub(crate) fn group(start: impl FnOnce() -> io::Result<Child>) -> io::Result<(Self, Child)> {
        Self::new(start, |child| Left::Group(child.id()))
    }
}

impl Drop for Listed {
    fn drop(&mut self) {
        there().retain(|left| *left != self.0);
    }
}
