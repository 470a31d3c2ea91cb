//! This module runs work without the lock of the interpreter, so that Ctrl-C ends it.
//!
//! The threads of a pool do the work, and one of its own reads files, while the thread of Python that requested it looks for signals some
//! twenty times a second.
//! After a signal the call ends at once; the work stops where it can be stopped, and else goes on without a listener.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// A flag that is true while work is still wanted.
#[derive(Debug, Clone)]
pub(crate) struct Wanted(Arc<AtomicBool>);

impl Wanted {
    pub(crate) fn still(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
    /// Leaves work that nobody wants any more, from within the call by which it reports its progress.
    pub(crate) fn or_leave(&self) {
        if !self.still() {
            resume_unwind(Box::new("not wanted any more"));
        }
    }
}

/// The time between two looks for signals.
const INTERVAL: Duration = Duration::from_millis(50);

/// The threads, and the process whose they are.
type Own = (u32, Arc<ThreadPool>);
static POOL: Mutex<Option<Own>> = Mutex::new(None);

/// Returns the threads of this process: those of the process that it was forked from do not go on in it.
fn pool() -> PyResult<Arc<ThreadPool>> {
    let mut own = POOL.lock().unwrap_or_else(PoisonError::into_inner);
    let process = std::process::id();
    if let Some((of, pool)) = own.as_ref()
        && *of == process
    {
        return Ok(Arc::clone(pool));
    }
    let made = ThreadPoolBuilder::new().thread_name(|n| format!("clatter {n}")).build();
    let pool = Arc::new(made.map_err(|error| PyRuntimeError::new_err(error.to_string()))?);
    std::mem::forget(own.replace((process, Arc::clone(&pool))));
    Ok(pool)
}

/// Runs `work` on the threads of the process, and returns its result.
///
/// # Errors
/// A signal whose handler raises, as that of Ctrl-C does.
pub(crate) fn done<T: Send + 'static>(py: Python<'_>, work: impl FnOnce(&Wanted) -> T + Send + 'static) -> PyResult<T> {
    let pool = pool()?;
    heard(py, work, |job| {
        pool.spawn(job);
        Ok(())
    })
}

/// Reads files on a thread of its own, and returns what they hold: one that is a pipe may keep it waiting for ever, and the threads of the
/// process have other work.
///
/// # Errors
/// Those of [`done`].
pub(crate) fn read<T: Send + 'static>(py: Python<'_>, read: impl FnOnce(&Wanted) -> T + Send + 'static) -> PyResult<T> {
    heard(py, read, |job| Ok(thread::Builder::new().name("clatter reads".to_owned()).spawn(job).map(drop)?))
}

/// Starts work, and waits for its result without the lock of the interpreter.
fn heard<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&Wanted) -> T + Send + 'static,
    start: impl FnOnce(Box<dyn FnOnce() + Send>) -> PyResult<()>,
) -> PyResult<T> {
    let wanted = Wanted(Arc::new(AtomicBool::new(true)));
    let (sender, receiver) = sync_channel(1);
    let its = wanted.clone();
    start(Box::new(move || {
        let given: Result<T, Box<dyn Any + Send>> = catch_unwind(AssertUnwindSafe(|| work(&its)));
        let _ = sender.send(given); // nobody may be left to hear it
    }))?;
    let receiver = Mutex::new(receiver);
    loop {
        let heard = py.detach(|| receiver.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(INTERVAL));
        match heard {
            Ok(Ok(given)) => return Ok(given),
            Ok(Err(panic)) => resume_unwind(panic),
            Err(RecvTimeoutError::Timeout) => py.check_signals().inspect_err(|_| {
                wanted.0.store(false, Ordering::Relaxed);
            })?,
            Err(RecvTimeoutError::Disconnected) => {
                return Err(PyRuntimeError::new_err("the work ended without an answer; please report this"));
            }
        }
    }
}
