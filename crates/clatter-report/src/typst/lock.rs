//! This module lets one process at a time put typst into the project's cache.

use std::fs::{File, TryLockError};
use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};

use super::failed;
use crate::ReportError;

/// Takes the lock, or gives up at the limit.
pub(super) fn lock(path: &Path, limit: Duration, progress: &mut dyn FnMut(&str)) -> Result<File, ReportError> {
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
                    "no typst: another process has held {path}, the lock for installing it, for {limit} s; \
                     end that process, or set CLATTER_TYPST"
                )));
            }
            Err(TryLockError::WouldBlock) => {
                if !told {
                    progress(&format!("waiting for another process that installs typst: it holds {}", path.display()));
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
}
