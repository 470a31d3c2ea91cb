//! This module limits the memory and the time of a command, and watches both while the command works.
//!
//! A thread checks the process some fifty times a second, and shows how far the work is where somebody watches. When the time is
//! over, searches and samples stop: their answer covers the work done by then, and is undecided where that is not enough.
//! Where they don't stop, where other work goes on, or where the memory is used up, temporary files are removed, the command says
//! why it stopped, how far it had come and how to use less, and the process ends with exit code 2; where the answer is complete
//! and only extra work was cut, the process ends with exit code 4.

use std::io::{self, Write as _};
use std::panic::resume_unwind;
use std::process::exit;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use clatter_product::units::{Dimension, TIME, Unit};

use crate::{Exit, progress};

/// What a command may take, for every command.
#[derive(Debug, Clone, Copy, clap::Args)]
pub(crate) struct Budget {
    /// Memory that the command may take, such as 4GiB or 500MB; beyond it stops [default: 1GiB]
    #[arg(long, global = true, value_name = "BYTES", allow_hyphen_values = true, value_parser = bytes)]
    memory: Option<u64>,
    /// How long the command may run, such as 90s, 5min or 2h; then it stops, 'assess', 'scatter' and 'design' with the answer
    /// that they have by then [default: no limit]
    #[arg(long, global = true, value_name = "TIME", allow_hyphen_values = true, value_parser = seconds)]
    time_limit: Option<Duration>,
}

/// True where the process is the command's own, which may then end it.
static OWN_PROCESS: AtomicBool = AtomicBool::new(false);
/// True where the time of the command that runs is over.
static OVER: AtomicBool = AtomicBool::new(false);
/// True where the end of the time has cut work short.
static CUT: AtomicBool = AtomicBool::new(false);
/// The memory of the command that runs.
static MEMORY: OnceLock<u64> = OnceLock::new();
/// The words for the extra work after an answer that is complete, which may still be cut.
static BESIDE: Mutex<Option<String>> = Mutex::new(None);
/// The memory unless another limit is given: 1 GiB.
const DEFAULT: u64 = 1 << 30;
/// Time between two checks, and checks between two pictures of the progress.
const INTERVAL: Duration = Duration::from_millis(20);
const PICTURE: u32 = 10;
/// The search for an answer ends this long before the time does, a quarter of the time at most; the answer by then is reported within
/// `GRACE` after the end of the time.
const BEFORE: Duration = Duration::from_secs(1);
const GRACE: Duration = Duration::from_millis(200);

/// Notes that the process is the command's own from here on.
pub(crate) fn own_process() {
    OWN_PROCESS.store(true, Ordering::Relaxed);
}

/// Returns the memory that a command may take, in bytes.
pub(crate) fn memory() -> u64 {
    MEMORY.get().copied().unwrap_or(DEFAULT)
}

/// Returns whether work may go on, as its time is not over.
pub(crate) fn go_on() -> bool {
    let over = OVER.load(Ordering::Relaxed);
    CUT.fetch_or(over, Ordering::Relaxed);
    !over
}

/// Returns whether work was stopped because its time was over.
pub(crate) fn was_cut() -> bool {
    CUT.load(Ordering::Relaxed)
}

fn told() -> Option<String> {
    BESIDE.lock().unwrap_or_else(PoisonError::into_inner).clone()
}

/// Notes that the answer is complete; extra work may still be cut, with these words.
pub(crate) fn is_told(beside: String) {
    *BESIDE.lock().unwrap_or_else(PoisonError::into_inner) = Some(beside);
}

/// Returns the result of work that cannot be interrupted; none where the time is over first, and then the work is abandoned. Where no
/// thread can be made, the time is not watched and the work runs to its end.
pub(crate) fn in_time<T: Send + 'static>(work: impl FnOnce() -> T + Send + 'static) -> Option<T> {
    let work = Arc::new(Mutex::new(Some(work)));
    let (sender, receiver) = mpsc::channel();
    let take = |work: &Mutex<Option<_>>| work.lock().unwrap_or_else(PoisonError::into_inner).take();
    let its = Arc::clone(&work);
    let beside = move || take(&its).map(|work| sender.send(work()));
    let Ok(beside) = thread::Builder::new().spawn(beside) else { return take(&work).map(|work| work()) };
    loop {
        match receiver.recv_timeout(INTERVAL) {
            Ok(done) => return Some(done),
            Err(RecvTimeoutError::Timeout) if go_on() => {}
            Err(RecvTimeoutError::Timeout) => return None,
            Err(RecvTimeoutError::Disconnected) => match beside.join() {
                Err(panic) => resume_unwind(panic),
                Ok(_) => return None,
            },
        }
    }
}

/// Amounts of memory.
static MEMORY_UNITS: Dimension = Dimension {
    name: "memory",
    example: "4 GiB",
    plain: false,
    units: &[
        Unit::new("B", |v| v),
        Unit::new("KB", |v| v * 1e3),
        Unit::new("MB", |v| v * 1e6),
        Unit::new("GB", |v| v * 1e9),
        Unit::new("KIB", |v| v * 1024.0),
        Unit::new("MIB", |v| v * 1_048_576.0),
        Unit::new("GIB", |v| v * 1_073_741_824.0),
    ],
};

fn bytes(text: &str) -> Result<u64, String> {
    let bytes = MEMORY_UNITS.read(&text.to_uppercase()).ok().map(|bytes| bytes.si).filter(|b| (16e6..1e15).contains(b));
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within 1e15")]
    bytes.map(|bytes| bytes as u64).ok_or_else(|| "memory is a number with its unit, from 16MB: 500MB, 4GiB".to_owned())
}

fn seconds(text: &str) -> Result<Duration, String> {
    let time = TIME.read(&text.to_lowercase()).ok().map(|time| time.si).filter(|seconds| *seconds > 0.0);
    let time = time.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
    time.ok_or_else(|| "a time is a number with its unit: 90s, 5min, 2h".to_owned())
}

impl Budget {
    /// Watches until the process ends; `less` says how to use less. Work that checks whether to go on has a little more time to come to
    /// an answer. Nothing is watched in a process that is not the command's own, or where no
    /// thread can be made.
    pub(crate) fn watch(self, less: &'static str, asks: bool, interactive: bool) {
        if !OWN_PROCESS.load(Ordering::Relaxed) {
            return;
        }
        let memory = self.memory.unwrap_or(DEFAULT);
        let _ = MEMORY.set(memory);
        let begin = Instant::now();
        let check = move || {
            for n in 1_u32.. {
                if memory_stats::memory_stats().is_some_and(|now| now.physical_mem as u64 > memory) {
                    stop(&format!("--memory={} MiB is used up", memory >> 20), less);
                }
                if let Some(limit) = self.time_limit {
                    let asks = asks && told().is_none();
                    let [before, grace] = if asks { [BEFORE.min(limit / 4), GRACE] } else { [Duration::ZERO; 2] };
                    let passed = begin.elapsed();
                    OVER.store(passed > limit.saturating_sub(before), Ordering::Relaxed);
                    if passed > limit.saturating_add(grace) {
                        leave_beside();
                        stop("--time-limit is over", less);
                    }
                }
                if n.is_multiple_of(PICTURE) {
                    if interactive { progress::show() } else { progress::tell() }
                }
                thread::sleep(INTERVAL);
            }
        };
        let _ = thread::Builder::new().name("budget".into()).spawn(check);
    }
}

/// Ends the process where its answer is complete and only extra work is cut.
fn leave_beside() {
    let Some(beside) = told() else { return };
    clatter_report::remove_leftovers();
    let so_far = progress::so_far();
    let _ = writeln!(io::stderr(), "warning: stopped, --time-limit is over: {so_far}{beside}; the answer is whole");
    exit(Exit::Unprinted as i32)
}

fn stop(what: &str, less: &str) -> ! {
    clatter_report::remove_leftovers();
    let so_far = progress::so_far();
    // Where nobody hears it, it ends all the same.
    let _ = writeln!(io::stderr(), "error: stopped, {what}: {so_far}the answer is not whole; {less}");
    exit(Exit::BadInput as i32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn budgets_have_units() {
        assert_eq!(bytes("1GiB"), Ok(1 << 30));
        assert_eq!(bytes("500 MB"), Ok(500_000_000));
        assert_eq!(seconds("1.5min"), Ok(Duration::from_secs(90)));
        for text in ["", "1", "1 kB", "-1GiB", "nanGiB", "1e300GiB", "infGB", "1 s"] {
            assert!(bytes(text).is_err(), "{text}");
        }
        for text in ["", "1", "0s", "-1s", "1e300h", "1 y", "s"] {
            assert!(seconds(text).is_err(), "{text}");
        }
    }
}
