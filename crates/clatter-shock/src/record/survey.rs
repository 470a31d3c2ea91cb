//! What one pass over a record tells, in constant memory.

use super::{Lines, Sample, Stamp};
use crate::Error;
use std::collections::VecDeque;
use std::io::BufRead;

/// Something about a record that its owner should know; the spectrum is computed all the same.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Finding {
    /// Samples are missing on a grid that is even otherwise, or a step is more than five times the usual: the history
    /// is taken as linear across.
    Gap {
        /// Line at its end.
        line: usize,
        /// Its length in seconds.
        seconds: f64,
        /// Usual step around it, in seconds.
        usual: f64,
    },
    /// The record starts away from zero by more than 1 % of its largest value: an offset, or a late trigger.
    Offset {
        /// Lines it was averaged over.
        lines: (usize, usize),
        /// Mean acceleration there, m/s².
        mean: f64,
    },
    /// The level strays from that of the start by more than 1 % of the largest value: at the end (drift, or a cut-off
    /// shock), or to one side over a quarter of the record or more (a bow of the base line, or a slow swing).
    Drift {
        /// Lines it was averaged over.
        lines: (usize, usize),
        /// Mean acceleration there less that at the start, m/s².
        change: f64,
    },
    /// Columns beyond the two that are read: they are left out.
    Columns {
        /// The first line that has them.
        line: usize,
        /// Numbers of all columns, and their names if a header gives them.
        names: Vec<String>,
    },
}

impl std::fmt::Display for Finding {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Gap { line, seconds, usual } => {
                write!(
                    f,
                    "line {line}: {seconds:.4e} s since the line above, usual are {usual:.4e} s; taken as linear across"
                )
            }
            Self::Offset { lines: (a, b), mean } => {
                write!(f, "lines {a} to {b}: mean {mean:.4e} m/s² before the shock, more than 1 % of the largest value")
            }
            Self::Drift { lines: (a, b), change } => write!(
                f,
                "lines {a} to {b}: {change:+.4e} m/s² from the level of the start, more than 1 % of the largest value"
            ),
            Self::Columns { line, names } => write!(
                f,
                "line {line}: time is taken from column {}, acceleration from column {}, nothing from column {}; \
                 for another, put it second",
                names[0],
                names[1],
                names[2..].join(", ")
            ),
        }
    }
}

/// What one pass over a record tells, in constant memory.
#[derive(Debug, Clone, PartialEq)]
pub struct Survey {
    /// Number of samples.
    pub samples: usize,
    /// Time of the first sample, in seconds.
    pub start: f64,
    /// Time of the last one.
    pub end: f64,
    /// Time between samples if they are even: every time is start + i·step to within 10⁻³ of a step, or to within one
    /// unit of its last printed digit where that is at most a quarter of a step.
    pub step: Option<f64>,
    /// Largest absolute acceleration, m/s².
    pub largest: f64,
    /// What is odd.
    pub findings: Vec<Finding>,
}

/// Times may be off an even grid by this share of a step.
const UNEVEN: f64 = 1e-3;
/// Printed digits as coarse as this share of a step, or coarser, tell no rounding from a missing sample.
const COARSE: f64 = 0.25;
/// Levels differ when they do by this share of the largest value.
const LEVEL: f64 = 0.01;
/// A bow stays below this share of the largest value: what is above is the shock.
const BOW: f64 = 0.25;
/// It extends over this part of the record.
const LONG: usize = 4;
/// Findings of one kind listed at most.
const MOST_FINDINGS: usize = 100;
/// Bins of the running mean: their number is halved when they are full.
const BINS: usize = 64;

impl<R: BufRead> Lines<R> {
    /// Reads to the end and tells what is there, handing each sample to `each`.
    ///
    /// # Errors
    /// As [`Lines::sample`]; [`Error::Short`] for fewer than two samples.
    pub fn survey(mut self, mut each: impl FnMut(Sample, u64)) -> Result<Survey, Error> {
        let (mut n, mut largest) = (0_usize, 0.0_f64);
        let (mut start, mut end) = (0.0, f64::NEG_INFINITY);
        let (mut steps, mut grid, mut bins) = (Steps::default(), Grid::default(), Bins::default());
        while let Some(s) = self.sample()? {
            if n == 0 {
                start = s.time;
            } else {
                steps.add(s.line, s.time - end);
            }
            grid.add(s.time, self.stamp());
            (n, end, largest) = (n + 1, s.time, largest.max(s.acceleration.abs()));
            bins.add(s);
            each(s, self.bytes);
        }
        if n < 2 {
            return Err(Error::Short(n));
        }
        let mut findings: Vec<Finding> = self.more_columns.into_iter().collect();
        let gaps = steps.gaps();
        let step = grid.step().filter(|_| gaps.is_empty());
        findings.extend(gaps);
        bins.judge(largest, &mut findings);
        Ok(Survey { samples: n, start, end, step, largest, findings })
    }
}

/// Steps in time, each judged beside its neighbors.
#[derive(Debug)]
struct Steps {
    /// Line and length: the one to be judged, and as many before and after it as there are, up to [`NEIGHBORS`].
    window: VecDeque<(usize, f64)>,
    shortest: f64,
    judged: usize,
    found: Vec<Finding>,
}

/// Steps looked at on either side of one.
const NEIGHBORS: usize = 8;
/// A step longer than this many usual ones lacks a sample, where the steps around it are even.
const MISSING: f64 = 1.5;
/// A step longer than this many usual ones is a gap wherever it is.
const GAP: f64 = 5.0;

impl Default for Steps {
    fn default() -> Self {
        Self { window: VecDeque::new(), shortest: f64::INFINITY, judged: 0, found: Vec::new() }
    }
}

impl Steps {
    fn add(&mut self, line: usize, seconds: f64) {
        self.window.push_back((line, seconds));
        self.shortest = self.shortest.min(seconds);
        if self.window.len() <= 2 * NEIGHBORS {
            return;
        }
        self.judge_to(NEIGHBORS + 1);
        if self.window.pop_front().is_some_and(|step| step.1 <= self.shortest) {
            self.shortest = self.window.iter().fold(f64::INFINITY, |least, step| least.min(step.1));
        }
        self.judged -= 1;
    }
    /// Judges the steps of the window before the one of this number.
    fn judge_to(&mut self, number: usize) {
        while self.judged < number {
            let (line, seconds) = self.window[self.judged];
            self.judged += 1;
            // Most steps need no sorting.
            if seconds <= MISSING * self.shortest || self.found.len() == MOST_FINDINGS {
                continue;
            }
            let mut sorted: Vec<f64> = self.window.iter().map(|step| step.1).collect();
            sorted.sort_by(f64::total_cmp);
            let usual = sorted[(sorted.len() - 1) / 2];
            let even = sorted.iter().filter(|step| (*step - usual).abs() <= 0.25 * usual).count();
            let otherwise_even = even >= NEIGHBORS && 4 * even >= 3 * (sorted.len() - 1);
            if seconds > GAP * usual || seconds > MISSING * usual && otherwise_even {
                self.found.push(Finding::Gap { line, seconds, usual });
            }
        }
    }
    /// All that were found, at the end.
    fn gaps(&mut self) -> Vec<Finding> {
        self.judge_to(self.window.len());
        std::mem::take(&mut self.found)
    }
}

/// Whether times lie on an even grid, as far as their printed digits tell.
#[derive(Debug)]
struct Grid {
    /// Samples read before the printed digits are judged.
    first: Vec<(f64, Stamp)>,
    count: usize,
    start: f64,
    end: f64,
    /// Power of ten of the last digit printed of any time, and the most significant digits of one: formats keep one or
    /// the other.
    place: i32,
    digits: i32,
    /// The last power of ten that was asked for.
    power: (i32, f64),
    /// Steps that keep every time so far within the band about an even grid.
    slowest: f64,
    fastest: f64,
}

impl Default for Grid {
    fn default() -> Self {
        Self {
            first: Vec::new(),
            count: 0,
            start: 0.0,
            end: 0.0,
            place: i32::MAX,
            digits: 0,
            power: (0, 1.0),
            slowest: f64::INFINITY,
            fastest: 0.0,
        }
    }
}

/// Samples that show how times are printed.
const FIRST: usize = 64;

impl Grid {
    fn add(&mut self, time: f64, stamp: Stamp) {
        (self.place, self.digits) = (self.place.min(stamp.place), self.digits.max(stamp.digits));
        if self.count >= FIRST {
            self.bound(time, stamp);
            return;
        }
        self.first.push((time, stamp));
        if self.first.len() == FIRST {
            self.begin();
        }
    }
    /// Takes in the first samples, whose digits are known now.
    fn begin(&mut self) {
        for (time, stamp) in std::mem::take(&mut self.first) {
            self.bound(time, stamp);
        }
    }
    fn bound(&mut self, time: f64, stamp: Stamp) {
        if self.count == 0 {
            self.start = time;
        } else {
            #[expect(clippy::cast_precision_loss, reason = "a count of lines stays below 2^53")]
            let steps = self.count as f64;
            let mean = (time - self.start) / steps;
            let place = self.place.max(stamp.place + stamp.digits - self.digits);
            if place != self.power.0 {
                self.power = (place, 10_f64.powi(place));
            }
            let printed = stamp.unit * self.power.1;
            let band = if printed <= COARSE * mean { printed.max(UNEVEN * mean) } else { UNEVEN * mean } / steps;
            (self.slowest, self.fastest) = (self.slowest.min(mean + band), self.fastest.max(mean - band));
        }
        (self.count, self.end) = (self.count + 1, time);
    }
    /// The step, if all is even.
    fn step(&mut self) -> Option<f64> {
        if self.count == 0 {
            self.begin();
        }
        #[expect(clippy::cast_precision_loss, reason = "a count of lines stays below 2^53")]
        let mean = (self.end - self.start) / (self.count - 1) as f64;
        (self.fastest <= self.slowest).then(|| mean.clamp(self.fastest, self.slowest))
    }
}

/// Means over equal shares of a record of unknown length.
#[derive(Debug, Default)]
struct Bins {
    full: Vec<Bin>,
    size: usize,
    count: usize,
}

#[derive(Debug, Clone, Copy)]
struct Bin {
    lines: (usize, usize),
    mean: f64,
}

impl Bins {
    fn add(&mut self, s: Sample) {
        self.size = self.size.max(1);
        if self.count == 0 {
            if self.full.len() == BINS {
                let joined =
                    |p: &[Bin]| Bin { lines: (p[0].lines.0, p[1].lines.1), mean: 0.5 * (p[0].mean + p[1].mean) };
                self.full = self.full.chunks(2).map(joined).collect();
                self.size *= 2;
            }
            self.full.push(Bin { lines: (s.line, s.line), mean: 0.0 });
        }
        self.count += 1;
        if let Some(bin) = self.full.last_mut() {
            bin.lines.1 = s.line;
            #[expect(clippy::cast_precision_loss, reason = "a count of lines stays below 2^53")]
            let share = self.count as f64;
            bin.mean += (s.acceleration - bin.mean) / share;
        }
        if self.count == self.size {
            self.count = 0;
        }
    }
    fn judge(&self, largest: f64, findings: &mut Vec<Finding>) {
        let whole = if self.count > 0 && self.full.len() > 1 { self.full.len() - 1 } else { self.full.len() };
        let bins = &self.full[..whole];
        let (Some(first), Some(last)) = (bins.first(), bins.last()) else { return };
        if first.mean.abs() > LEVEL * largest {
            findings.push(Finding::Offset { lines: first.lines, mean: first.mean });
        }
        // The side that a level has strayed to, unless it is the shock itself.
        let strayed = |bin: &Bin| {
            let change = bin.mean - first.mean;
            let share = change.abs() / largest;
            if share > LEVEL && share < BOW { change.signum() } else { 0.0 }
        };
        // Of fewer than 64 samples each may be part of the shock.
        let long = |run: &[Bin]| LONG * run.len() >= bins.len() && run.len() >= BINS / 2 / LONG;
        let total = (last.mean - first.mean).abs() > LEVEL * largest;
        let mut end = 0;
        for run in bins.chunk_by(|a, b| strayed(a).total_cmp(&strayed(b)).is_eq()) {
            end += run.len();
            // What lasts to the end is told as what the end is off by.
            if strayed(&run[0]) == 0.0 || !long(run) || end == bins.len() {
                continue;
            }
            #[expect(clippy::cast_precision_loss, reason = "at most 64")]
            let change = run.iter().map(|bin| bin.mean - first.mean).sum::<f64>() / run.len() as f64;
            findings.push(Finding::Drift { lines: (run[0].lines.0, run[run.len() - 1].lines.1), change });
        }
        if total {
            findings.push(Finding::Drift { lines: last.lines, change: last.mean - first.mean });
        }
    }
}
