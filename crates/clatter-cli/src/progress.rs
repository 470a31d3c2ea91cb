//! A progress bar for those who watch.

use std::io::Write;
use std::time::{Duration, Instant};

/// A bar on one line of the terminal; nothing at all where nobody watches.
pub(crate) struct Progress<W: Write> {
    err: Option<W>,
    what: &'static str,
    total: u64,
    shown: Option<u64>,
    begin: Instant,
}

/// An estimate of the time left is shown after this long.
const PATIENCE: Duration = Duration::from_secs(2);
/// Steps of the bar.
const WIDTH: u64 = 30;

impl<W: Write> Progress<W> {
    /// For `total` units of work, shown to `err` if somebody watches it.
    pub(crate) fn new(err: W, interactive: bool, total: u64) -> Self {
        Self { err: interactive.then_some(err), what: "", total: total.max(1), shown: None, begin: Instant::now() }
    }

    /// What is done now.
    pub(crate) fn stage(&mut self, what: &'static str) {
        (self.what, self.shown) = (what, None);
    }

    /// So much is done. Cheap: it writes only where another per cent is full.
    pub(crate) fn at(&mut self, done: u64) {
        let percent = u128::from(done.min(self.total)) * 100 / u128::from(self.total);
        let percent = u64::try_from(percent).unwrap_or(100);
        if self.shown == Some(percent) {
            return;
        }
        self.shown = Some(percent);
        let Some(err) = &mut self.err else { return };
        let full = usize::try_from(percent * WIDTH / 100).unwrap_or(0);
        let (full, rest) = ("=".repeat(full), " ".repeat(30 - full));
        let passed = self.begin.elapsed();
        // What is left, if it goes on as it did: told where it is worth waiting for.
        let left = passed.as_secs() * (100 - percent) / percent.max(1);
        let left = if passed < PATIENCE { String::new() } else { format!(", {left} s left") };
        let _ = write!(err, "\r{:<9} [{full}{rest}] {percent:>3} %{left:<16}", self.what);
        let _ = err.flush();
    }
}

impl<W: Write> Drop for Progress<W> {
    /// The line is left as it was found.
    fn drop(&mut self) {
        if let (Some(err), Some(_)) = (&mut self.err, self.shown) {
            let _ = write!(err, "\r{}\r", " ".repeat(64));
        }
    }
}
