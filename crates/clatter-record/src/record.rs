//! A record: channels of acceleration over time, in SI.

use std::io::Read;

use crate::error::Bad;
use crate::finding::{At, Finding, Judged, LISTED, gaps};
use crate::roles::Roles;
use crate::text::{self, BLOCK, Rows, decoded};
use crate::times::{Printed, Times};
use crate::{Error, Options};

/// A record of one or several channels, in seconds and m/s².
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    channels: Vec<Channel>,
    start_s: f64,
    spacing: Spacing,
    samples: usize,
    /// Samples that follow no other on the line before, each with its line.
    numbering: Vec<(usize, usize)>,
    /// What was found while reading.
    read: Vec<Finding>,
}

/// One channel of a record.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// Its name, as the file has it.
    pub name: String,
    /// Its unit as the file or the caller spells it.
    pub unit: String,
    /// Accelerations in m/s².
    pub values: Vec<f64>,
}

/// When the samples are.
#[derive(Debug, Clone, PartialEq)]
enum Spacing {
    /// So many seconds from one to the next.
    Even(f64),
    /// Seconds since the first one.
    Uneven(Vec<f64>),
}

/// What a reader hands on.
struct Raw {
    channels: Vec<Channel>,
    start_s: f64,
    unit_s: f64,
    since_s: Vec<f64>,
    printed: Printed,
    step_s: Option<f64>,
    numbering: Vec<(usize, usize)>,
    found: Vec<Finding>,
}

impl Record {
    /// Reads a record from a file of any kind that is known.
    ///
    /// Columns of time and acceleration are found by their names and units, then by their places; see [`Options`] for what a
    /// caller may tell. Times are taken as exact as they are printed, and as even where that is all they are off by.
    ///
    /// ```
    /// # use clatter_record::{Options, Record};
    /// let csv = "time [ms];acceleration [g]\n0,00;0\n0,25;100\n0,50;0\n";
    /// let record = Record::read(csv.as_bytes(), &Options::default(), |_| ())?;
    /// assert_eq!(record.step_s(), Some(0.25e-3));
    /// assert_eq!(record.channels()[0].values, [0.0, 980.665, 0.0]);
    ///
    /// let broken = Record::read("t [s],a [g]\n0,1\n1e-3,NaN\n".as_bytes(), &Options::default(), |_| ());
    /// assert_eq!(broken.unwrap_err().to_string(), "line 3: NaN in column 2 (a) is no finite number");
    /// # Ok::<(), clatter_record::Error>(())
    /// ```
    ///
    /// `progress` is told how many bytes are read.
    ///
    /// # Errors
    /// [`Error`] tells what is wrong, where, and what is allowed.
    pub fn read(mut input: impl Read, options: &Options, mut progress: impl FnMut(u64)) -> Result<Self, Error> {
        let mut begin = vec![0; BLOCK];
        let length = text::fill(&mut input, &mut begin)?;
        begin.truncate(length);
        if begin.is_empty() {
            return Err(Error::File("the file is empty".to_owned()));
        }
        let (rows, roles) = match decoded(&begin) {
            Some(decode) => {
                let bytes = to_end(begin, &mut input, options)?;
                progress(bytes.len() as u64);
                let text = decode(&bytes);
                drop(bytes);
                text::read(text, &mut std::io::empty(), options, &mut |_| ())?
            }
            None => text::read(begin, &mut input, options, &mut progress)?,
        };
        Self::of_text(rows, roles, options)
    }

    fn of_text(mut rows: Rows, roles: Roles, options: &Options) -> Result<Self, Error> {
        let mut found = Vec::new();
        if !roles.left_out.is_empty() {
            found.push(Finding::LeftOut(roles.left_out));
        }
        if rows.below().count > 0 {
            found.push(Finding::Below(rows.below().clone()));
        }
        let (start_s, unit_s) = (rows.start_s(), rows.time_size());
        let (mut start, mut step_s) = (start_s, None);
        if let Some(hz) = options.sample_rate_hz {
            step_s = Some(period(hz)?);
        } else if let (Some([from_s, by_s]), None) = (rows.sampled_s, roles.time) {
            (start, step_s) = (from_s, Some(by_s));
        }
        let values = std::mem::take(&mut rows.channels);
        let channels = values.into_iter().zip(roles.channels).map(|(values, role)| Channel {
            name: role.name,
            unit: role.unit,
            values,
        });
        let raw = Raw {
            channels: channels.collect(),
            start_s: start,
            unit_s,
            since_s: std::mem::take(&mut rows.times),
            printed: std::mem::take(&mut rows.printed),
            step_s,
            numbering: std::mem::take(&mut rows.numbering),
            found,
        };
        raw.finish(rows.bad, options)
    }

    /// The channels.
    #[must_use]
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }
    /// Samples of each channel.
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
    /// Time of a sample since the first one, in seconds.
    ///
    /// # Panics
    /// If there is no such sample.
    #[must_use]
    pub fn since_s(&self, sample: usize) -> f64 {
        match &self.spacing {
            #[expect(clippy::cast_precision_loss, reason = "a count of samples stays below 2^53")]
            Spacing::Even(step_s) => sample as f64 * step_s,
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
    /// What is odd, for one who asks for a spectrum from `lowest_hz` on.
    #[must_use]
    pub fn findings(&self, lowest_hz: f64) -> Vec<Finding> {
        let mut findings = self.read.clone();
        let at = |sample| self.at(sample);
        for Channel { name, values, .. } in &self.channels {
            let duration_s = self.duration_s();
            Judged { channel: name, values, duration_s, lowest_hz, at: &at }.judge(&mut findings);
        }
        findings
    }
}

/// The rest of an input, as far as it may hold what is read at most.
fn to_end(mut begin: Vec<u8>, input: &mut dyn Read, options: &Options) -> Result<Vec<u8>, Error> {
    // No number takes more bytes, in any text or container.
    const WIDEST: u64 = 64;
    let most = WIDEST.saturating_mul(options.most_values as u64);
    input.take(most).read_to_end(&mut begin).map_err(|error| Error::Read(error.to_string()))?;
    Ok(begin)
}

/// Seconds from one sample to the next.
fn period(hz: f64) -> Result<f64, Error> {
    let period_s = hz.recip();
    if hz > 0.0 && period_s.is_normal() {
        return Ok(period_s);
    }
    Err(Error::Quantity { name: "sample rate (Hz)", value: hz, allowed: "finite and > 0" })
}

impl Raw {
    /// A record, where the times go forwards.
    fn finish(mut self, mut bad: Bad, options: &Options) -> Result<Record, Error> {
        let mut step_s = self.step_s.or_else(|| self.times().step());
        if step_s.is_none() && !self.since_s.is_empty() {
            self.refuse_coarse()?;
            self.drop_backward(&mut bad);
            step_s = self.times().step();
        }
        if bad.count > 0 {
            if !options.skip_bad {
                return Err(Error::Lines(bad));
            }
            self.found.push(Finding::Skipped(bad));
        }
        let samples = self.channels[0].values.len();
        if samples < 2 {
            return Err(Error::Short(samples));
        }
        if step_s.is_none() {
            let numbering = &self.numbering;
            self.found.extend(gaps(&self.since_s, &|sample| At::of(numbering, sample)));
        }
        Ok(Record {
            channels: self.channels,
            start_s: self.start_s,
            spacing: step_s.map_or(Spacing::Uneven(self.since_s), Spacing::Even),
            samples,
            numbering: self.numbering,
            read: self.found,
        })
    }

    fn times(&self) -> Times<'_> {
        Times { since_s: &self.since_s, start_s: self.start_s, unit_s: self.unit_s, printed: &self.printed }
    }

    /// Refuses times that are printed so coarsely that samples have one and the same.
    fn refuse_coarse(&self) -> Result<(), Error> {
        let count = self.since_s.len();
        let same = self.since_s.windows(2).filter(|pair| pair[0].to_bits() == pair[1].to_bits()).count();
        let unit_s = self.printed.unit() * self.unit_s;
        #[expect(clippy::cast_precision_loss, reason = "a count of samples stays below 2^53")]
        let coarse = unit_s * (count - 1) as f64 > 0.5 * self.since_s[count - 1].abs();
        if same == 0 || !coarse {
            return Ok(());
        }
        Err(Error::Columns(format!(
            "{same} of {count} times are those of the sample before: they are printed in steps of {unit_s:e} s, too coarse for \
             samples so close; give the sample rate"
        )))
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
                    let (At::Line(line) | At::Sample(line)) = at;
                    let [time, last] = [time, last].map(|since_s| self.start_s + since_s);
                    bad.add(line, || {
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
        if kept.iter().all(|kept| *kept) {
            return;
        }
        let keep = |values: &mut Vec<f64>| {
            let mut kept = kept.iter();
            values.retain(|_| kept.next().copied().unwrap_or(true));
        };
        keep(&mut self.since_s);
        self.channels.iter_mut().for_each(|channel| keep(&mut channel.values));
        self.printed.keep(&kept);
        let numbering = &self.numbering;
        if !numbering.is_empty() {
            let lines = (0..kept.len()).filter(|i| kept[*i]).map(|i| text::line_of(numbering, i));
            let mut runs: Vec<(usize, usize)> = Vec::new();
            for (sample, line) in lines.enumerate() {
                if runs.last().is_none_or(|(first, at)| at + sample - first != line) {
                    runs.push((sample, line));
                }
            }
            self.numbering = runs;
        }
    }
}
