//! When the samples of a channel are.

use clatter_shock::samples::float;

use crate::{At, Error};

/// The times of a channel; channels that were sampled together share them.
#[derive(Debug, Clone, PartialEq)]
pub struct TimeAxis {
    pub(crate) start_s: f64,
    pub(crate) spacing: Spacing,
    pub(crate) samples: usize,
    /// Samples that follow no other at the place before, each with its place.
    pub(crate) numbering: Vec<(usize, At)>,
}

/// When the samples are.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Spacing {
    /// So many seconds from one to the next.
    Even(f64),
    /// Seconds since the first one.
    Uneven(Vec<f64>),
}

impl TimeAxis {
    /// How many samples there are.
    #[must_use]
    pub fn samples(&self) -> usize {
        self.samples
    }
    /// Time of the first sample in seconds, as the file has it.
    #[must_use]
    pub fn start_s(&self) -> f64 {
        self.start_s
    }
    /// From the first sample to the last, in seconds.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.since_s(self.samples - 1)
    }
    /// Time between samples, if they are even: every time is a whole number of steps after the first to within a thousandth of
    /// a step, or as far as times were rounded in the file.
    #[must_use]
    pub fn step_s(&self) -> Option<f64> {
        match self.spacing {
            Spacing::Even(step_s) => Some(step_s),
            Spacing::Uneven(_) => None,
        }
    }
    /// The time between samples, for what goes with even samples alone.
    ///
    /// # Errors
    /// [`Error::Uneven`].
    pub fn even(&self, what: &'static str) -> Result<f64, Error> {
        self.step_s().ok_or(Error::Uneven(what))
    }
    /// Time of a sample since the first one, in seconds.
    ///
    /// # Panics
    /// If there is no such sample.
    #[must_use]
    pub fn since_s(&self, sample: usize) -> f64 {
        match &self.spacing {
            Spacing::Even(step_s) => float(sample) * step_s,
            Spacing::Uneven(since_s) => since_s[sample],
        }
    }
    /// Time of each sample since the first one, in seconds.
    pub fn times_s(&self) -> impl Iterator<Item = f64> {
        (0..self.samples).map(|sample| self.since_s(sample))
    }
    /// Place of a sample, from 0, in the file.
    #[must_use]
    pub fn at(&self, sample: usize) -> At {
        At::of(&self.numbering, sample)
    }

    /// Returns whether as many samples are at the same times, to a millionth of a step: units and offsets leave roundings.
    #[must_use]
    pub fn is_that_of(&self, other: &Self) -> bool {
        if std::ptr::eq(self, other) {
            return true;
        }
        let within = 1e-6 * self.duration_s() / float(self.samples - 1);
        let close = |one: f64, other: f64| (one - other).abs() <= within;
        self.samples == other.samples
            && self.step_s().is_some() == other.step_s().is_some()
            && close(self.start_s, other.start_s)
            && close(self.duration_s(), other.duration_s())
            && (self.step_s().is_some() || self.times_s().zip(other.times_s()).all(|(one, other)| close(one, other)))
    }

    /// The part from one time to another, both on the axis of the file, and the first sample of it.
    pub(crate) fn window(&self, from_s: f64, to_s: f64) -> Result<(usize, Self), Error> {
        let is_in = |since_s: f64| (from_s..=to_s).contains(&(self.start_s + since_s));
        let first = self.times_s().position(is_in).unwrap_or(self.samples);
        let samples = self.times_s().skip(first).take_while(|since_s| is_in(*since_s)).count();
        if samples < 2 {
            let end_s = self.start_s + self.duration_s();
            return Err(Error::Window { from_s, to_s, samples, start_s: self.start_s, end_s });
        }
        let begin_s = self.since_s(first);
        let spacing = match &self.spacing {
            Spacing::Even(step_s) => Spacing::Even(*step_s),
            Spacing::Uneven(since_s) => {
                Spacing::Uneven(since_s[first..first + samples].iter().map(|since_s| since_s - begin_s).collect())
            }
        };
        let within = self.numbering.iter().filter(|(sample, _)| (first + 1..first + samples).contains(sample));
        let within = within.map(|(sample, at)| (sample - first, *at));
        let numbering = std::iter::once((0, self.at(first))).chain(within).collect();
        Ok((first, Self { start_s: self.start_s + begin_s, spacing, samples, numbering }))
    }
}

/// As messages tell it.
impl std::fmt::Display for TimeAxis {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} samples from {} s on, ", self.samples, self.start_s)?;
        match self.spacing {
            Spacing::Even(step_s) => write!(f, "every {step_s} s"),
            Spacing::Uneven(_) => write!(f, "uneven in time"),
        }
    }
}
