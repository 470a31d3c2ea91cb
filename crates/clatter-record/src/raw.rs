//! A reader hands channels that share their times on before it is known what the times are.

use std::sync::Arc;

use clatter_shock::samples::{LARGEST, float};

use crate::axis::{Spacing, TimeAxis};
use crate::error::Bad;
use crate::finding::{At, Finding, LISTED, gaps};
use crate::times::{Printed, Times};
use crate::{Channel, Error, Options, Record};

/// A channel before its times are known.
pub(crate) struct Untimed {
    pub(crate) name: String,
    pub(crate) unit: String,
    /// Accelerations in m/s².
    pub(crate) values: Vec<f64>,
}

/// Channels of one time, as a reader hands them on.
#[derive(Default)]
pub(crate) struct Raw {
    pub(crate) channels: Vec<Untimed>,
    pub(crate) start_s: f64,
    /// The unit of the times in the file, in seconds.
    pub(crate) unit_s: f64,
    /// Seconds since the first sample, where the file has a column of times,
    pub(crate) since_s: Vec<f64>,
    /// and how they are printed.
    pub(crate) printed: Printed,
    /// Seconds from one sample to the next, where they are told.
    pub(crate) step_s: Option<f64>,
    /// Samples that follow no other at the place before, each with its place.
    pub(crate) numbering: Vec<(usize, At)>,
    pub(crate) found: Vec<Finding>,
}

/// Returns whether a name says that a channel is the resultant of others.
fn is_named_resultant(name: &str) -> bool {
    const WORDS: [&str; 13] = [
        "result",
        "résult",
        "sum",
        "summe",
        "somme",
        "vector",
        "vektor",
        "total",
        "magnitude",
        "norm",
        "abs",
        "betrag",
        "svm",
    ];
    let name = name.to_lowercase();
    WORDS.iter().any(|word| name.contains(word))
}

/// The channel that is the root of the sum of the squares of all others, two at least, in every sample.
fn resultant(channels: &[Untimed]) -> Option<usize> {
    /// As files print it, in parts of the largest value.
    const PRINTED: f64 = 1e-3;
    let is_resultant = |k: &usize| {
        let own = &channels[*k].values;
        let most = own.iter().copied().fold(0.0, f64::max);
        let others = || channels.iter().enumerate().filter(|(other, _)| other != k);
        let root = |i: usize| others().fold(0.0, |root, (_, other)| libm::hypot(root, other.values[i]));
        let moves = |(_, other): &(usize, &Untimed)| other.values.iter().any(|value| value.abs() > PRINTED * most);
        // Of one direction alone the resultant is its size, as another sensor beside it may be: the name has to say so.
        let is_told = others().filter(moves).count() > 1 || is_named_resultant(&channels[*k].name);
        most > 0.0 && is_told && own.iter().enumerate().all(|(i, value)| (root(i) - value).abs() <= PRINTED * most)
    };
    (0..channels.len()).rev().filter(|_| channels.len() > 2).find(is_resultant)
}

impl Raw {
    /// Channels of samples that are so far apart.
    pub(crate) fn even(channels: Vec<Untimed>, [start_s, step_s]: [f64; 2]) -> Self {
        Self { channels, start_s, step_s: Some(step_s), ..Self::default() }
    }

    /// A record, where the times go forwards.
    pub(crate) fn finish(mut self, mut bad: Bad, options: &Options) -> Result<Record, Error> {
        self.drop_unbounded(&mut bad);
        let mut step_s = self.step_s.or_else(|| self.times().step());
        if step_s.is_none() && !self.since_s.is_empty() {
            self.refuse_coarse()?;
            self.drop_backward(&mut bad);
            step_s = self.times().step();
        }
        if bad.count > 0 {
            // Where samples have no times each of them counts, but for those at the end.
            let last = self.channels[0].values.len().checked_sub(1).map(|last| At::of(&self.numbering, last));
            let in_between = || bad.first.iter().any(|(at, _)| last.is_none_or(|last| at.number() < last.number()));
            if !options.skip_bad || self.since_s.is_empty() && in_between() {
                return Err(Error::Lines(bad));
            }
            self.found.push(Finding::Skipped(bad));
        }
        self.refuse_dates()?;
        let samples = self.channels[0].values.len();
        if samples < 2 {
            return Err(clatter_shock::Error::Short { what: "a record", samples, needed: 2 }.into());
        }
        let last_s = step_s.map_or(0.0, |step_s| step_s * float(samples));
        for value in [self.start_s, last_s] {
            if !(-LARGEST..=LARGEST).contains(&value) {
                return Err(Error::Quantity { name: "time of a sample (s)", value, allowed: "within 1e100" });
            }
        }
        if let Some(value) = step_s.filter(|step_s| *step_s < LARGEST.recip()) {
            return Err(Error::Quantity { name: "time between samples (s)", value, allowed: "at least 1e-100" });
        }
        if step_s.is_none() {
            let numbering = &self.numbering;
            let lacks = gaps(&self.since_s, &|sample| At::of(numbering, sample));
            let unit_s = self.printed.unit() * self.unit_s;
            let (last_s, steps) = (self.since_s.last().copied().unwrap_or(0.0), float(samples - 1));
            // Half of a step: what rounding does, and what is missing, is not told apart.
            let coarse = (lacks.is_none() && unit_s * steps > 0.5 * last_s).then(|| {
                Finding::Note(format!(
                    "times are printed in steps of {unit_s:e} s, which no one rate explains: samples may be missing"
                ))
            });
            self.found.extend(lacks.or(coarse));
        }
        let times = Arc::new(TimeAxis {
            start_s: self.start_s,
            spacing: step_s.map_or(Spacing::Uneven(self.since_s), Spacing::Even),
            samples,
            numbering: self.numbering,
        });
        let resultant = resultant(&self.channels);
        let timed = |(k, Untimed { name, unit, values })| Channel {
            name,
            unit,
            values,
            times: Arc::clone(&times),
            is_resultant: resultant == Some(k),
        };
        let channels = self.channels.into_iter().enumerate().map(timed).collect();
        Ok(Record { channels, read: self.found, account: None })
    }

    /// Refuses days since 1900, since the year 0 or since 4713 BC, as programs keep dates, that are read as seconds: parts of a day after
    /// very many.
    fn refuse_dates(&self) -> Result<(), Error> {
        let (span_s, count) = (self.since_s.last().copied().unwrap_or(0.0), float(self.since_s.len().max(2) - 1));
        let is_day = [2e4..8e4, 7e5..8e5, 2.4e6..2.5e6].iter().any(|days| days.contains(&self.start_s));
        let is_date = self.unit_s.to_bits() == 1.0_f64.to_bits() && is_day && span_s > 0.0 && span_s < 1e-6 * count;
        if !is_date {
            return Ok(());
        }
        Err(Error::Columns(format!(
            "times from {} on, {:.3e} apart, are days, as spreadsheets count them, and not seconds: --units=d and that of the acceleration",
            self.start_s,
            span_s / count
        )))
    }

    fn times(&self) -> Times<'_> {
        Times { since_s: &self.since_s, start_s: self.start_s, unit_s: self.unit_s, printed: &self.printed }
    }

    /// Refuses times that are printed so coarsely that samples have one and the same.
    pub(crate) fn refuse_coarse(&self) -> Result<(), Error> {
        let count = self.since_s.len();
        let same = self.since_s.windows(2).filter(|pair| pair[0].to_bits() == pair[1].to_bits()).count();
        let unit_s = self.printed.unit() * self.unit_s;
        let coarse = unit_s * float(count - 1) > 0.5 * self.since_s[count - 1].abs();
        // A few samples at one time are jumps, or there twice.
        if 10 * same < count || !coarse {
            return Ok(());
        }
        Err(Error::Columns(format!(
            "{same} of {count} times are those of the sample before: they are printed in steps of {unit_s:e} s, too coarse for \
             samples so close; give the sample rate"
        )))
    }

    /// Leaves out samples at times that no record reaches.
    fn drop_unbounded(&mut self, bad: &mut Bad) {
        let kept: Vec<bool> = self.since_s.iter().map(|since_s| since_s.abs() <= LARGEST).collect();
        for i in (0..kept.len()).filter(|i| !kept[*i]) {
            let since_s = self.since_s[i];
            bad.add(At::of(&self.numbering, i), || {
                format!("the time, {since_s:e} s after the first one, is beyond {LARGEST:e} s")
            });
        }
        self.keep(&kept);
    }

    /// Leaves out samples whose time is before another one's that came earlier. Two samples at one time are a jump.
    fn drop_backward(&mut self, bad: &mut Bad) {
        let mut kept = vec![true; self.since_s.len()];
        let mut jumps = (Vec::new(), 0);
        let mut latest: Option<(f64, usize)> = None;
        for (i, &time) in self.since_s.iter().enumerate() {
            let at = At::of(&self.numbering, i);
            match latest {
                Some((last, times)) if time < last || time <= last && times > 1 => {
                    kept[i] = false;
                    let [time, last] = [time, last].map(|since_s| self.start_s + since_s);
                    bad.add(at, || {
                        format!("time {time:?} s does not come after {last:?} s, that of the sample before")
                    });
                }
                Some((last, times)) if time <= last => {
                    latest = Some((time, times + 1));
                    if jumps.0.len() < LISTED {
                        jumps.0.push(at);
                    }
                    jumps.1 += 1;
                }
                _ => latest = Some((time, 1)),
            }
        }
        if jumps.1 > 0 {
            self.found.push(Finding::Jumps { first: jumps.0, count: jumps.1 });
        }
        self.keep(&kept);
    }

    /// Leaves out samples.
    pub(crate) fn keep(&mut self, kept: &[bool]) {
        if kept.iter().all(|kept| *kept) {
            return;
        }
        let keep = |values: &mut Vec<f64>| {
            let mut kept = kept.iter();
            values.retain(|_| kept.next().copied().unwrap_or(true));
        };
        keep(&mut self.since_s);
        self.channels.iter_mut().for_each(|channel| keep(&mut channel.values));
        self.printed.keep(kept);
        let mut runs: Vec<(usize, At)> = Vec::new();
        let places = (0..kept.len()).filter(|i| kept[*i]).map(|i| At::of(&self.numbering, i));
        for (sample, at) in places.enumerate() {
            if runs.last().is_none_or(|(first, begin)| begin.after(sample - first) != at) {
                runs.push((sample, at));
            }
        }
        self.numbering = runs;
    }
}
