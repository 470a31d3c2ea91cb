//! This module measures the time of a run, on this machine.

use std::hint::black_box;
use std::time::{Duration, Instant};

use serde::Serialize;

use clatter_product::Error;

/// The machine on which times were taken.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Machine {
    /// The processor, as the system names it.
    pub processor: String,
    /// Processors that this program may use; each time is of one.
    pub processors: usize,
    /// The operating system.
    pub system: &'static str,
    /// True where the program was built with optimization: without, times say nothing.
    pub optimized: bool,
}

impl Machine {
    /// Returns the machine that this runs on.
    #[must_use]
    pub fn here() -> Self {
        // Linux says it here; elsewhere the architecture has to do.
        let known = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        let model = known.lines().filter_map(|line| line.strip_prefix("model name")?.split_once(':'));
        let model = model.map(|(_, name)| name.trim().to_owned()).find(|name| !name.is_empty());
        Self {
            processor: model.unwrap_or_else(|| std::env::consts::ARCH.to_owned()),
            processors: std::thread::available_parallelism().map_or(1, usize::from),
            system: std::env::consts::OS,
            optimized: !cfg!(debug_assertions),
        }
    }
}

/// A clock is read in some 50 ns: a batch of runs takes so long that this does not count.
const BATCH: Duration = Duration::from_micros(20);
/// Time spent on one pair.
const TOTAL: Duration = Duration::from_millis(3);
/// Batches at least, of which the median is taken.
const LEAST: usize = 5;

/// Returns an answer, and the time of one run: the median over batches of runs, after one that fills the caches.
pub(super) fn measured<T>(mut run: impl FnMut() -> Result<T, Error>) -> Result<(T, f64), Error> {
    let (answer, first) = once(&mut run)?;
    let (batch, samples) = sizes(first);
    let mut times = Vec::with_capacity(samples);
    for _ in 0..samples {
        let start = Instant::now();
        for _ in 0..batch {
            black_box(run()?);
        }
        times.push(start.elapsed().as_secs_f64() / f64::from(batch));
    }
    times.sort_by(f64::total_cmp);
    Ok((answer, times[times.len() / 2]))
}

/// Runs a batch, and batches, for a first run of so many seconds.
fn sizes(first_s: f64) -> (u32, usize) {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 1000 and 150")]
    let whole = |ratio: f64, most: f64| ratio.ceil().clamp(1.0, most) as u32;
    // The first run is slower than those that follow, by a factor of 10 or so where it is short.
    let batch = whole(10.0 * BATCH.as_secs_f64() / first_s, 1000.0);
    let of_batch = first_s * f64::from(batch);
    let samples = whole(TOTAL.as_secs_f64() / of_batch, 150.0) as usize;
    (batch, samples.max(LEAST) | 1)
}

/// Returns an answer and the time of its one run.
pub(super) fn once<T>(run: impl FnOnce() -> Result<T, Error>) -> Result<(T, f64), Error> {
    let start = Instant::now();
    let answer = run()?;
    // A clock may stand still for a moment.
    Ok((answer, start.elapsed().as_secs_f64().max(1e-9)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn batches_are_longer_than_the_clock_and_few_where_runs_are_long() {
        for (first_s, batch, samples) in [(1e-9, 1000, 151), (1.5e-6, 134, 15), (1e-3, 1, 5), (1.0, 1, 5)] {
            assert_eq!(sizes(first_s), (batch, samples), "{first_s} s");
        }
    }

    #[test]
    fn failures_are_passed_on_and_runs_are_counted() {
        assert_eq!(measured(|| Err::<(), _>(Error::Contact)), Err(Error::Contact));
        let mut runs = 0;
        let (answer, seconds) = measured(|| {
            runs += 1;
            Ok(runs)
        })
        .unwrap();
        assert!(answer == 1 && runs > LEAST && seconds >= 0.0, "{answer} of {runs}, {seconds}");
    }
}
