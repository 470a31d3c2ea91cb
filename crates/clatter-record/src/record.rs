//! A record: channels of acceleration over time, in SI.

use std::collections::HashMap;
use std::fs::File;
use std::io::Read;
use std::path::Path;
use std::sync::Arc;

use clatter_shock::samples::check;

use crate::axis::{Spacing, TimeAxis};
use crate::columns::SAME_RATE;
use crate::container::{self, Kind};
use crate::error::Bad;
use crate::finding::{At, Finding, Inspection, gaps, is_of_events};
use crate::plausible::{against_times, refuse_counts};
use crate::raw::{Raw, Untimed};
use crate::roles::{Role, Roles};
use crate::text::{self, Rows, decoded};
use crate::times::Printed;
use crate::{Account, Error, FULL_SCALE, Options};

/// A record of one or several channels, in seconds and m/s².
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    pub(crate) channels: Vec<Channel>,
    /// Findings of the reader.
    pub(crate) read: Vec<Finding>,
    /// The account of the lines and columns of a text.
    pub(crate) account: Option<Account>,
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
    pub(crate) times: Arc<TimeAxis>,
    pub(crate) is_resultant: bool,
}

impl Channel {
    /// Whether the file has it as the resultant of all others, the root of the sum of their squares in every sample: it is no direction of
    /// its own.
    ///
    /// ```
    /// # use clatter_record::{Options, Record};
    /// let csv = "time [ms],x [g],y [g],sum [g]\n0,0,0,0\n0.1,3,-4,5\n0.2,1,0,1\n";
    /// let record = Record::read(csv.as_bytes(), &Options::default(), |_| ())?;
    /// assert!(record.channels()[2].is_resultant() && !record.channels()[0].is_resultant());
    /// # Ok::<(), clatter_record::Error>(())
    /// ```
    #[must_use]
    pub fn is_resultant(&self) -> bool {
        self.is_resultant
    }
    /// When its samples are.
    #[must_use]
    pub fn times(&self) -> &TimeAxis {
        &self.times
    }
    /// When its sample of largest size is, in seconds as the file counts them, and its value in m/s²; the first of several.
    #[must_use]
    pub fn peak(&self) -> (f64, f64) {
        let sample = clatter_shock::samples::peak(&self.values);
        (self.times.start_s() + self.times.since_s(sample), self.values[sample])
    }
}

impl Record {
    /// Reads the file of this name, as [`read`](Self::read) does where nothing is told about it.
    ///
    /// ```no_run
    /// use clatter_record::Record;
    /// let drop = Record::open("drop.csv")?;
    /// let (time_s, peak_m_s2) = drop.channel("a_x").ok_or("no channel a_x")?.peak();
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Read`] where there is no such file or it may not be read, else those of [`read`](Self::read).
    pub fn open(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let file = File::open(path).map_err(|error| Error::Read(format!("{}: {error}", path.display())))?;
        Self::read(file, &Options::default(), |_| ())
    }

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
        let mut begin = Vec::new();
        if text::read_block(&mut input, &mut begin)? == 0 {
            return Err(Error::File("the file is empty".to_owned()));
        }
        let kind = Kind::of(&begin)?;
        if kind != Kind::Text {
            one_record(options)?;
            text::to_end(&mut begin, &mut input, options)?;
            progress(begin.len() as u64);
            let table = container::read(kind, &begin, options.most_values)?;
            drop(begin);
            return Self::of_table(table, options);
        }
        let parts = match decoded(&begin) {
            Some(decode) => {
                text::to_end(&mut begin, &mut input, options)?;
                progress(begin.len() as u64);
                let text = decode(&begin);
                drop(begin);
                text::read(text, &mut std::io::empty(), options, &mut |_| ())?
            }
            None => text::read(begin, &mut input, options, &mut progress)?,
        };
        Self::of_texts(parts, options)
    }

    /// A record of accelerations in m/s² that are there already, at even times from `start_s` on, each with its name.
    ///
    /// ```
    /// # use clatter_record::Record;
    /// let record = Record::from_samples(0.0, 1e-4, vec![("ax", vec![0.0, 900.0, 0.0])])?;
    /// assert_eq!(record.step_s(), Some(1e-4));
    /// # Ok::<(), clatter_record::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error`] unless there is a channel, all have as many values, two at least, and all numbers are finite and below 1e100,
    /// steps from 1e-15 to 1e9 s.
    pub fn from_samples(start_s: f64, step_s: f64, channels: Vec<(&str, Vec<f64>)>) -> Result<Self, Error> {
        let Some(samples) = channels.first().map(|(_, values)| values.len()) else {
            return Err(Error::Columns("a record has a channel at least".to_owned()));
        };
        for (_, values) in &channels {
            check(values, step_s, "a record", 2)?;
            if values.len() != samples {
                return Err(Error::Columns("channels differ in length".to_owned()));
            }
        }
        let untimed = |(name, values): (&str, _)| Untimed { name: name.to_owned(), unit: "m/s2".to_owned(), values };
        let channels = channels.into_iter().map(untimed).collect();
        Raw::even(channels, [start_s, step_s]).finish(Bad::default(), &Options::default())
    }

    /// Of lines of text, by their times.
    fn of_texts(parts: Vec<(Rows, Roles)>, options: &Options) -> Result<Self, Error> {
        // A line that cannot be used for one of the channels is none of the rows.
        let worst = parts.iter().max_by_key(|(rows, _)| (rows.lines().bad, rows.lines().rows));
        let account = worst.map(|(rows, roles)| Account { lines: rows.lines(), columns: roles.columns.clone() });
        if let Some(account) = account.as_ref().filter(|account| account.lines.missing() > 0) {
            let missing = account.lines.missing();
            return Err(Error::File(format!("{missing} lines of the file are not accounted for: {account}")));
        }
        let part = |(rows, roles): (Rows, Roles)| {
            let places = roles.channels.iter().map(|role| role.column).collect();
            Ok((places, Self::of_text(rows, roles, options)?))
        };
        let parts = parts.into_iter().map(part).collect::<Result<_, Error>>()?;
        Ok(Self { account, ..Self::of_parts(parts) })
    }

    fn of_text(rows: Rows, roles: Roles, options: &Options) -> Result<Self, Error> {
        one_scale(&roles.channels, options)?;
        let mut found = Vec::new();
        if !roles.left_out.is_empty() {
            found.push(Finding::LeftOut(roles.left_out));
        }
        if rows.below().count > 0 {
            found.push(Finding::Below(rows.below().clone()));
        }
        found.extend(rows.against_header(&roles.channels).into_iter().map(Finding::Note));
        let slope = rows.slope();
        if let Some(([slope, offset], line)) = slope {
            found.push(Finding::Note(format!(
                "the numbers are taken times {slope}, plus {offset}, as line {line} tells"
            )));
        }
        let rate = rows.rate();
        let (start_s, unit_s, told) = (rows.start_s(), rows.time_size(), rows.told());
        let Rows { channels, times: since_s, printed, numbering, sampled_s, doubled, mut bad, .. } = rows;
        let untimed = |(mut values, Role { name, unit, size, .. }): (Vec<f64>, Role)| {
            if let Some(([slope, offset], _)) = slope {
                for value in &mut values {
                    *value = *value * slope + offset * size;
                }
            }
            Untimed { name, unit, values }
        };
        let channels = channels.into_iter().zip(roles.channels).map(untimed).collect();
        let mut raw = Raw { channels, start_s, unit_s, since_s, printed, step_s: None, numbering, found };
        let rounded_s = raw.printed.unit() * unit_s;
        if let Some(hz) = options.sample_rate_hz {
            let given_s = period(hz)?;
            let finding = against_times(given_s, &raw.since_s, rounded_s, "the rate that is given")?;
            // Times that lack samples do so by any rate.
            let is_fine = finding.is_none() && rounded_s < 0.25 * given_s;
            let lacks = is_fine.then(|| gaps(&raw.since_s, &|sample| At::of(&raw.numbering, sample))).flatten();
            raw.found.extend(finding.or(lacks));
            if let Some((told_s, line)) = rate.filter(|(told_s, _)| (told_s / given_s - 1.0).abs() > SAME_RATE) {
                let told_hz = told_s.recip();
                raw.found.push(Finding::Note(format!(
                    "line {line} tells {told_hz} Hz, and the rate that is given is {hz} Hz"
                )));
            }
            raw = Raw { start_s: 0.0, step_s: Some(given_s), since_s: Vec::new(), printed: Printed::default(), ..raw };
        } else if let (Some([from_s, by_s]), None) = (sampled_s, roles.time) {
            (raw.start_s, raw.step_s) = (from_s, Some(by_s));
        } else if let Some((told_s, line)) = told {
            let what = format!("the rate of line {line}");
            raw.found.extend(against_times(told_s, &raw.since_s, rounded_s, &what).unwrap_or_default());
        }
        if options.units.is_some() {
            refuse_counts(&raw.channels)?;
        }
        if !raw.since_s.is_empty() && !doubled.is_empty() {
            raw.refuse_coarse()?;
            let mut kept = vec![true; raw.since_s.len()];
            for (sample, line) in doubled {
                kept[sample] = false;
                bad.add(At::Line(line), || "is the line before once more".to_owned());
            }
            raw.keep(&kept);
        }
        raw.finish(bad, options)
    }

    /// Channels of several times as one record, each with its place in the file.
    pub(crate) fn of_parts(parts: Vec<(Vec<usize>, Self)>) -> Self {
        let several = parts.len() > 1;
        let (mut channels, mut read): (Vec<(usize, Channel)>, _) = (Vec::new(), Vec::new());
        for (places, part) in parts {
            let names = part.channels.iter().map(|channel| channel.name.as_str()).collect::<Vec<_>>().join(", ");
            let of = |finding: Finding| match finding {
                Finding::LeftOut(_) => finding,
                finding if several => Finding::Of { channels: names.clone(), finding: Box::new(finding) },
                finding => finding,
            };
            for finding in part.read.into_iter().map(of) {
                if !read.contains(&finding) {
                    read.push(finding);
                }
            }
            channels.extend(places.into_iter().zip(part.channels));
        }
        channels.sort_by_key(|(place, _)| *place);
        let mut channels: Vec<Channel> = channels.into_iter().map(|(_, channel)| channel).collect();
        // Channels with times of their own that are the same share them.
        let mut known: HashMap<[u64; 3], Vec<Arc<TimeAxis>>> = HashMap::new();
        for channel in &mut channels {
            let times = &channel.times;
            let key = [times.samples as u64, times.start_s.to_bits(), times.duration_s().to_bits()];
            let alike = known.entry(key).or_default();
            match alike.iter().find(|other| Arc::ptr_eq(other, times) || ***other == **times) {
                Some(other) => channel.times = Arc::clone(other),
                None => alike.push(Arc::clone(times)),
            }
        }
        Self { channels, read, account: None }
    }

    /// The channels.
    #[must_use]
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }
    /// The first channel of this name, as the file has it.
    #[must_use]
    pub fn channel(&self, name: &str) -> Option<&Channel> {
        self.channels.iter().find(|channel| channel.name == name)
    }
    /// Returns the account of every line and every column, of a text.
    #[must_use]
    pub fn account(&self) -> Option<&Account> {
        self.account.as_ref()
    }
    /// The times of the channels: one for all that were sampled together, in the order of their first channels.
    #[must_use]
    pub fn times(&self) -> Vec<&TimeAxis> {
        let mut times: Vec<&TimeAxis> = Vec::new();
        for channel in &self.channels {
            if !times.iter().any(|other| other.is_that_of(&channel.times)) {
                times.push(&channel.times);
            }
        }
        times
    }
    /// Time between samples, if they are even and of the same times for all channels.
    #[must_use]
    pub fn step_s(&self) -> Option<f64> {
        let [times] = self.times()[..] else { return None };
        times.step_s()
    }
    /// The times that all channels have.
    ///
    /// # Errors
    /// [`Error::Times`], which names two channels that differ and `what` needs one time.
    pub fn one_time(&self, what: &'static str) -> Result<&TimeAxis, Error> {
        let first = &self.channels[0];
        match self.channels.iter().find(|channel| !channel.times.is_that_of(&first.times)) {
            None => Ok(&first.times),
            Some(other) => {
                let [first, other] = [first, other].map(|channel| format!("{} has {}", channel.name, channel.times));
                Err(Error::Times { what, first, other })
            }
        }
    }
    /// Returns what is odd, for one who asks for a spectrum from `lowest_hz` on.
    #[must_use]
    pub fn findings(&self, lowest_hz: f64) -> Vec<Finding> {
        let mut findings = self.read.clone();
        for Channel { name, values, times, .. } in &self.channels {
            let is_even = match &times.spacing {
                Spacing::Even(_) => true,
                Spacing::Uneven(since_s) => !is_of_events(since_s),
            };
            let at = |sample| times.at(sample);
            let duration_s = times.duration_s();
            Inspection { channel: name, values, duration_s, is_even, lowest_hz, at: &at }.add_to(&mut findings);
        }
        findings
    }
}

/// Refuses a full scale beside channels that have a unit, and a unit beside those that count in shares of full scale.
pub(crate) fn one_scale(channels: &[Role], options: &Options) -> Result<(), Error> {
    let shares = |role: &&Role| role.unit == FULL_SCALE;
    let (with, without) = (channels.iter().find(shares), channels.iter().find(|role| !shares(role)));
    match (options.full_scale_m_s2, &options.units, with, without) {
        (Some(_), _, _, Some(role)) => Err(Error::Units(format!(
            "{} is in {}: a full scale goes with channels that count in shares of it",
            role.name, role.unit
        ))),
        (_, Some(_), Some(role), _) => {
            Err(Error::Units(format!("{} counts in shares of full scale: units beside it have no meaning", role.name)))
        }
        _ => Ok(()),
    }
}

/// Refuses another record than the first of a file that holds one.
fn one_record(options: &Options) -> Result<(), Error> {
    match options.record {
        None | Some(1) => Ok(()),
        Some(number) => Err(Error::no_record(number, 1)),
    }
}

/// Seconds from one sample to the next.
pub(crate) fn period(hz: f64) -> Result<f64, Error> {
    let period_s = hz.recip();
    if hz > 0.0 && period_s.is_normal() {
        return Ok(period_s);
    }
    Err(Error::Quantity { name: "sample rate (Hz)", value: hz, allowed: "finite and > 0" })
}
