//! A history at several rates: averages over blocks of 2, 4, 8, … samples.

use crate::samples::float;

/// Blocks to a duration that suffice for a first estimate.
const COARSE: f64 = 64.0;
/// Blocks to a duration for the result: a block average is off the value in its middle by (π/4096)²/24, below 1e-7.
const FINE: f64 = 4096.0;

/// A history and its block averages.
pub(crate) struct Levels<'a> {
    record: &'a [f64],
    averages: Vec<Vec<f64>>,
}

/// Samples or averages, evenly in time; times in samples of the history.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Level<'a> {
    values: &'a [f64],
    /// Time between them.
    pub(crate) width: f64,
}

impl<'a> Levels<'a> {
    pub(crate) fn new(record: &'a [f64]) -> Self {
        let mut averages: Vec<Vec<f64>> = Vec::new();
        loop {
            let below = averages.last().map_or(record, Vec::as_slice);
            // A pulse as long as the history still has enough blocks.
            if float(below.len()) <= COARSE {
                return Self { record, averages };
            }
            averages.push(below.chunks_exact(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect());
        }
    }
    /// Returns a history as a level of its own.
    pub(crate) fn of_record(record: &'a [f64]) -> Level<'a> {
        Level { values: record, width: 1.0 }
    }
    /// Returns the time of the last sample.
    pub(crate) fn length(&self) -> f64 {
        float(self.record.len() - 1)
    }
    /// Returns the history itself.
    pub(crate) fn finest(&self) -> Level<'_> {
        Levels::of_record(self.record)
    }
    /// Returns the level that has some 32 to 64 blocks in a duration, or fewer where the history has.
    pub(crate) fn coarse(&self, duration: f64) -> Level<'_> {
        self.with_blocks(duration, COARSE)
    }
    /// Returns the level that has some 2048 to 4096 blocks in a duration.
    pub(crate) fn fine(&self, duration: f64) -> Level<'_> {
        self.with_blocks(duration, FINE)
    }
    fn with_blocks(&self, duration: f64, blocks: f64) -> Level<'_> {
        let (mut width, mut values) = (1.0, self.record);
        for averages in &self.averages {
            if duration <= blocks * width {
                break;
            }
            (width, values) = (2.0 * width, averages);
        }
        Level { values, width }
    }
}

impl Level<'_> {
    /// Returns the times and values from one time to another, both included.
    pub(crate) fn within(&self, first: f64, last: f64) -> impl Iterator<Item = (f64, f64)> {
        let offset = 0.5 * (self.width - 1.0);
        let index = |time: f64| (time - offset) / self.width;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and the length")]
        let whole = |x: f64| x.clamp(0.0, float(self.values.len())) as usize;
        let (from, to) = (whole(index(first).ceil()), whole(index(last).floor() + 1.0));
        let values = self.values.get(from..to).unwrap_or_default();
        values.iter().enumerate().map(move |(i, &a)| (float(from + i) * self.width + offset, a))
    }
}
