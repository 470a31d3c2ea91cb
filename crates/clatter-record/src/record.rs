//! A record: channels of acceleration over time, in SI.

use std::io::Read;

use crate::container::{self, Kind};
use crate::error::Bad;
use crate::finding::{At, Finding, Judged, LISTED, gaps, is_of_events};
use crate::heading::Heading;
use crate::plausible::{against_times, refuse_counts};
use crate::roles::{Roles, Seen};
use crate::samples::{LARGEST, check};
use crate::text::{self, BLOCK, Rows, SHOWN, decoded};
use crate::times::{Printed, Times};
use crate::{Account, Column, Error, Options, Table, Values};

/// A record of one or several channels, in seconds and m/s².
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    pub(crate) channels: Vec<Channel>,
    pub(crate) start_s: f64,
    pub(crate) spacing: Spacing,
    pub(crate) samples: usize,
    /// Samples that follow no other at the place before, each with its place.
    pub(crate) numbering: Vec<(usize, At)>,
    /// What was found while reading.
    read: Vec<Finding>,
    /// What became of each line and column of a text.
    account: Option<Account>,
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
pub(crate) enum Spacing {
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
    numbering: Vec<(usize, At)>,
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
        let kind = Kind::of(&begin)?;
        if kind != Kind::Text {
            let bytes = to_end(begin, &mut input, options)?;
            progress(bytes.len() as u64);
            let table = container::read(kind, &bytes, options.most_values)?;
            drop(bytes);
            return Self::of_table(table, options);
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

    /// A record of values that are there already, at even times from `start_s` on.
    ///
    /// ```
    /// # use clatter_record::{Channel, Record};
    /// let channel = Channel { name: "ax".to_owned(), unit: "m/s2".to_owned(), values: vec![0.0, 900.0, 0.0] };
    /// assert_eq!(Record::from_samples(0.0, 1e-4, vec![channel])?.step_s(), Some(1e-4));
    /// # Ok::<(), clatter_record::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error`] unless there is a channel, all have as many values, two at least, and all numbers are finite and below 1e100,
    /// steps from 1e-15 to 1e9 s.
    pub fn from_samples(start_s: f64, step_s: f64, channels: Vec<Channel>) -> Result<Self, Error> {
        let Some(samples) = channels.first().map(|channel| channel.values.len()) else {
            return Err(Error::Columns("a record has a channel at least".to_owned()));
        };
        for channel in &channels {
            check(&channel.values, step_s, "a record", 2)?;
            if channel.values.len() != samples {
                return Err(Error::Columns("channels differ in length".to_owned()));
            }
        }
        let raw = Raw {
            channels,
            start_s,
            unit_s: 1.0,
            since_s: Vec::new(),
            printed: Printed::floats(),
            step_s: Some(step_s),
            numbering: Vec::new(),
            found: Vec::new(),
        };
        raw.finish(Bad::default(), &Options::default())
    }

    fn of_text(mut rows: Rows, roles: Roles, options: &Options) -> Result<Self, Error> {
        let mut found = Vec::new();
        if !roles.left_out.is_empty() {
            found.push(Finding::LeftOut(roles.left_out));
        }
        if rows.below().count > 0 {
            found.push(Finding::Below(rows.below().clone()));
        }
        let account = Account { lines: rows.lines(), columns: roles.columns };
        if account.lines.missing() > 0 {
            return Err(Error::File(format!(
                "{} lines of the file are not accounted for: {account}",
                account.lines.missing()
            )));
        }
        let (mut start_s, unit_s) = (rows.start_s(), rows.time_size());
        let mut step_s = None;
        if let Some(hz) = options.sample_rate_hz {
            let given_s = period(hz)?;
            (start_s, step_s) = (0.0, Some(given_s));
            let rounded_s = rows.printed.unit() * unit_s;
            found.extend(against_times(
                given_s,
                &std::mem::take(&mut rows.times),
                rounded_s,
                "the rate that is given",
            )?);
            rows.printed = Printed::default();
        } else if let (Some([from_s, by_s]), None) = (rows.sampled_s, roles.time) {
            (start_s, step_s) = (from_s, Some(by_s));
        } else if let Some((told_s, line)) = rows.told() {
            let rounded_s = rows.printed.unit() * unit_s;
            found.extend(
                against_times(told_s, &rows.times, rounded_s, &format!("the rate of line {line}")).unwrap_or_default(),
            );
        }
        let values = std::mem::take(&mut rows.channels);
        let channels = values.into_iter().zip(roles.channels).map(|(values, role)| Channel {
            name: role.name,
            unit: role.unit,
            values,
        });
        let raw = Raw {
            channels: channels.collect(),
            start_s,
            unit_s,
            since_s: std::mem::take(&mut rows.times),
            printed: std::mem::take(&mut rows.printed),
            step_s,
            numbering: std::mem::take(&mut rows.numbering),
            found,
        };
        let mut raw = raw;
        if options.units.is_some() {
            refuse_counts(&raw.channels)?;
        }
        if !raw.since_s.is_empty() && !rows.doubled.is_empty() {
            raw.refuse_coarse()?;
            let mut kept = vec![true; raw.since_s.len()];
            for (sample, line) in &rows.doubled {
                kept[*sample] = false;
                rows.bad.add(At::Line(*line), || "is the line before once more".to_owned());
            }
            raw.keep(&kept);
        }
        let record = raw.finish(rows.bad, options)?;
        Ok(Self { account: Some(account), ..record })
    }

    /// Of the columns of a file whose numbers are no text.
    fn of_table(table: Table, options: &Options) -> Result<Self, Error> {
        let columns = table.columns;
        let headings: Vec<Heading> = columns
            .iter()
            .map(|column| {
                let heading = Heading::of(&column.name);
                column.unit.iter().fold(heading, |heading, unit| heading.with_unit(unit))
            })
            .collect();
        let number = |column: &Column, row: usize| match &column.values {
            Values::Float(values) => values.get(row).copied().unwrap_or(f64::NAN),
            #[expect(clippy::cast_precision_loss, reason = "the first rows tell times from indices")]
            Values::Integer(values) => values.get(row).map_or(f64::NAN, |value| *value as f64),
        };
        let seen = Seen {
            named: headings.iter().any(|heading| !heading.name.is_empty()),
            sampled: columns.iter().any(|column| column.sampled_s.is_some()),
            rows: (0..SHOWN).map(|row| columns.iter().map(|column| number(column, row)).collect()).collect(),
            headings,
            ..Seen::default()
        };
        let roles = seen.roles(options)?;
        let samples = columns[roles.channels[0].column].values.len();
        for role in &roles.channels {
            let other = columns[role.column].values.len();
            if other != samples {
                let first = &roles.channels[0].name;
                return Err(Error::Columns(format!(
                    "{} has {other} samples and {first} has {samples}: take one of them",
                    role.name
                )));
            }
        }
        let (mut start_s, mut step_s, mut unit_s, mut since_s, mut printed) =
            (0.0, None, 1.0, Vec::new(), Printed::floats());
        if let Some(hz) = options.sample_rate_hz {
            step_s = Some(period(hz)?);
        } else if let Some((time, size)) = roles.time {
            unit_s = size;
            let column = &columns[time];
            if column.values.len() != samples {
                return Err(Error::Columns(format!(
                    "{} has {} values for {samples} samples",
                    column.name,
                    column.values.len()
                )));
            }
            (start_s, since_s) = since_first(&column.values, size);
            if let Values::Integer(_) = column.values {
                printed = Printed::whole();
            }
        } else if let Some([from_s, by_s]) = columns[roles.channels[0].column].sampled_s {
            (start_s, step_s) = (from_s, Some(by_s));
        } else {
            return Err(Error::Columns("the file tells no times: give the sample rate".to_owned()));
        }
        let mut bad = Bad::default();
        let mut kept = vec![true; samples];
        let channels: Vec<Channel> = roles
            .channels
            .into_iter()
            .map(|role| {
                let values: Vec<f64> = match &columns[role.column].values {
                    Values::Float(values) => values.iter().map(|value| value * role.size).collect(),
                    #[expect(clippy::cast_precision_loss, reason = "no converter has so many digits")]
                    Values::Integer(values) => values.iter().map(|value| *value as f64 * role.size).collect(),
                };
                Channel { name: role.name, unit: role.unit, values }
            })
            .collect();
        for (sample, kept) in kept.iter_mut().enumerate() {
            let values = channels.iter().map(|channel| (channel.name.as_str(), channel.values[sample]));
            let mut values = values.chain(since_s.get(sample).map(|since_s| ("time", *since_s)));
            if let Some((name, value)) = values.find(|(_, value)| !value.is_finite() || value.abs() > LARGEST) {
                *kept = false;
                bad.add(At::Sample(sample + 1), || format!("{value} in {name} is no number up to {LARGEST:e}"));
            }
        }
        let found = if roles.left_out.is_empty() { Vec::new() } else { vec![Finding::LeftOut(roles.left_out)] };
        let mut raw = Raw { channels, start_s, unit_s, since_s, printed, step_s, numbering: Vec::new(), found };
        raw.keep(&kept);
        raw.finish(bad, options)
    }

    /// The channels.
    #[must_use]
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }
    /// What became of every line and every column, of a text.
    #[must_use]
    pub fn account(&self) -> Option<&Account> {
        self.account.as_ref()
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
        let is_even = match &self.spacing {
            Spacing::Even(_) => true,
            Spacing::Uneven(since_s) => !is_of_events(since_s),
        };
        for Channel { name, values, .. } in &self.channels {
            let duration_s = self.duration_s();
            Judged { channel: name, values, duration_s, is_even, lowest_hz, at: &at }.judge(&mut findings);
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
        let samples = self.channels[0].values.len();
        if samples < 2 {
            return Err(Error::Short { what: "a record", samples, needed: 2 });
        }
        #[expect(clippy::cast_precision_loss, reason = "a count of samples stays below 2^53")]
        let last_s = step_s.map_or(0.0, |step_s| step_s * samples as f64);
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
            self.found.extend(gaps(&self.since_s, &|sample| At::of(numbering, sample)));
        }
        Ok(Record {
            channels: self.channels,
            start_s: self.start_s,
            spacing: step_s.map_or(Spacing::Uneven(self.since_s), Spacing::Even),
            samples,
            numbering: self.numbering,
            read: self.found,
            account: None,
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
    fn keep(&mut self, kept: &[bool]) {
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

/// The first of some times in seconds, and all of them since it; exact for integers.
fn since_first(values: &Values, size: f64) -> (f64, Vec<f64>) {
    match values {
        Values::Float(values) => {
            let first = values.first().copied().unwrap_or(0.0);
            (first * size, values.iter().map(|value| (value - first) * size).collect())
        }
        #[expect(clippy::cast_precision_loss, reason = "a record lasts less than 2^53 of its units")]
        Values::Integer(values) => {
            let first = values.first().copied().unwrap_or(0);
            let since = |value: &i64| (i128::from(*value) - i128::from(first)) as f64 * size;
            (first as f64 * size, values.iter().map(since).collect())
        }
    }
}
