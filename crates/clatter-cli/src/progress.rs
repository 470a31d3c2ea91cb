//! This module counts how far the work is where it is done; the thread that watches the process shows and reports it.

use std::io::{self, Write};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use crate::text::visible;

/// Work that takes long.
struct Work {
    what: &'static str,
    /// The step that it is at, where it has such.
    step: String,
    done: u64,
    /// The total; 0 where the work is not counted.
    total: u64,
    begin: Instant,
    shown: bool,
    /// When it is told next where nobody watches; none of work that is not.
    told_at: Option<Duration>,
}

/// The work of now.
static WORK: Mutex<Option<Work>> = Mutex::new(None);

fn work() -> MutexGuard<'static, Option<Work>> {
    WORK.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The time for which work shows no progress.
const PATIENCE: Duration = Duration::from_secs(1);
/// Where standard error is no terminal, long draws are told once in this time.
const SILENCE: Duration = Duration::from_secs(20);
/// The number of steps of the bar.
const WIDTH: usize = 30;

/// Keeps count of one piece of work; once this is dropped its line is gone from the terminal.
pub(crate) struct Counted(());

impl Counted {
    /// Begins `what`, such as "drawing", of which there are `total` parts; 0 where they are not counted.
    pub(crate) fn begin(what: &'static str, total: u64) -> Self {
        *work() = Some(Work {
            what,
            step: String::new(),
            done: 0,
            total,
            begin: Instant::now(),
            shown: false,
            told_at: None,
        });
        Self(())
    }

    /// Begins work that is told now and then where standard error is no terminal, too.
    pub(crate) fn heard(what: &'static str) -> Self {
        let counted = Self::begin(what, 0);
        if let Some(work) = &mut *work() {
            work.told_at = Some(SILENCE);
        }
        counted
    }

    /// Notes how much of the work is done.
    #[expect(clippy::unused_self, reason = "without it nothing is begun")]
    pub(crate) fn at(&self, done: u64) {
        if let Some(work) = &mut *work() {
            work.done = work.done.max(done);
        }
    }

    /// Notes the step of the work.
    #[expect(clippy::unused_self, reason = "without it nothing is begun")]
    pub(crate) fn step(&self, step: &str) {
        if let Some(work) = &mut *work() {
            work.step = visible(step).into_owned();
        }
    }

    /// Notes how much of a search is done, which counts from several threads.
    pub(crate) fn of(&self, done: usize, total: usize) {
        if let Some(work) = &mut *work() {
            work.total = total as u64;
        }
        self.at(done as u64);
    }
}

impl Drop for Counted {
    fn drop(&mut self) {
        let mut work = work();
        wipe(work.as_ref());
        *work = None;
    }
}

/// Shows the work of now on the terminal that standard error is.
pub(crate) fn show() {
    if let Some(work) = &mut *work()
        && work.begin.elapsed() > PATIENCE
    {
        work.shown = true;
        let mut err = io::stderr();
        let _ = write!(err, "\r{}", work.line(work.begin.elapsed()));
        let _ = err.flush();
    }
}

/// Tells the work of now, where that is heard, in a line now and then.
pub(crate) fn tell() {
    if let Some(work) = &mut *work()
        && let Some(at) = work.told_at.filter(|at| work.begin.elapsed() > *at)
    {
        work.told_at = Some(at + SILENCE);
        let _ = writeln!(io::stderr(), "clatter: {}", work.line(work.begin.elapsed()).trim_end());
    }
}

/// Returns the name of the work that was cut and how far it had come, as part of a sentence, for the last words of a process that is
/// stopped.
pub(crate) fn so_far() -> String {
    let work = work();
    wipe(work.as_ref());
    work.as_ref().map_or_else(String::new, Work::cut)
}

/// Clears the progress from the line of the terminal.
fn wipe(work: Option<&Work>) {
    if work.is_some_and(|work| work.shown) {
        let _ = write!(io::stderr(), "\r{:78}\r", "");
    }
}

impl Work {
    fn cut(&self) -> String {
        match self.percent() {
            Some(percent) => format!("{} had come to {percent} %, ", self.what),
            None if self.step.is_empty() => format!("{} was cut, ", self.what),
            None => format!("{} was cut ({}), ", self.what, self.step),
        }
    }

    fn percent(&self) -> Option<u64> {
        let percent = (u128::from(self.done.min(self.total)) * 100).checked_div(u128::from(self.total))?;
        u64::try_from(percent).ok()
    }

    /// Returns the progress as a line; the time left is estimated from the rate so far.
    fn line(&self, passed: Duration) -> String {
        let seconds = passed.as_secs();
        let Some(percent) = self.percent() else { return format!("{}, {seconds} s so far ", self.what) };
        let full = usize::try_from(percent).unwrap_or(0) * WIDTH / 100;
        let (full, open) = ("=".repeat(full), " ".repeat(WIDTH - full));
        let rest = u128::from(self.total.saturating_sub(self.done));
        let left = (u128::from(seconds) * rest).checked_div(u128::from(self.done));
        let left = left.map_or_else(String::new, |left| format!(", {left} s left"));
        format!("{:<10} [{full}{open}] {percent:>3} %{left:<16}", self.what)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_says_what_is_done_and_left() {
        let work = |done, total| Work {
            what: "drawing",
            step: String::new(),
            done,
            total,
            begin: Instant::now(),
            shown: false,
            told_at: None,
        };
        let at = |done, total| work(done, total).line(Duration::from_secs(30));
        assert_eq!(at(25, 100), format!("drawing    [=======                       ]  25 %, {:<14}", "90 s left"));
        assert!(at(100, 100).contains("100 %, 0 s left"), "{}", at(100, 100));
        assert!(at(u64::MAX, u64::MAX).contains("100 %"));
        assert!(!at(0, 100).contains("left"), "nothing is known yet");
        assert_eq!(at(7, 0).trim_end(), "drawing, 30 s so far");
        assert_eq!(work(25, 100).cut(), "drawing had come to 25 %, ");
        assert_eq!(work(7, 0).cut(), "drawing was cut, ");
        assert_eq!(Work { step: "the last page".to_owned(), ..work(7, 0) }.cut(), "drawing was cut (the last page), ");
    }
}
