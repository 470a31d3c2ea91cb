//! Columns of a file whose numbers are no text, as channels: each with the times that the file gives it.

use std::collections::{BTreeMap, HashMap, HashSet};

use clatter_shock::samples::{LARGEST, float};

use crate::error::Bad;
use crate::finding::gaps;
use crate::heading::Heading;
use crate::plausible::against_times;
use crate::raw::{Raw, Untimed};
use crate::record::{one_scale, period};
use crate::roles::{Preview, Role, Roles};
use crate::text::SHOWN;
use crate::times::Printed;
use crate::{At, Column, Error, FULL_SCALE, Finding, Options, Pick, Record, Table, Values};

/// Rates that a file tells twice are the same where they differ by no more than this share.
pub(crate) const SAME_RATE: f64 = 1e-3;

/// Where the times of a channel are.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Source {
    /// Time of the first sample and between samples, in seconds.
    Even([f64; 2]),
    /// A column.
    Column(usize),
}

impl Record {
    /// A record of the columns of a table, as of a file whose numbers are no text: of time and accelerations by their names and units.
    ///
    /// ```
    /// use clatter_record::{Column, Options, Record, Table, Values};
    /// let column = |name: &str, values| Column {
    ///     name: name.to_owned(),
    ///     group: String::new(),
    ///     unit: None,
    ///     sampled_s: None,
    ///     values: Values::Float(values),
    /// };
    /// let columns = vec![column("time [ms]", vec![0.0, 0.1, 0.2]), column("a [g]", vec![0.0, 100.0, 0.0])];
    /// let record = Record::of_table(Table { columns, ..Table::default() }, &Options::default())?;
    /// assert_eq!(record.channels()[0].peak(), (1e-4, 980.665));
    /// # Ok::<(), clatter_record::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error`] tells what is wrong, where, and what is allowed.
    pub fn of_table(table: Table, options: &Options) -> Result<Self, Error> {
        let Table { columns, left_out, notes } = table;
        if columns.is_empty() {
            return Err(Error::Columns("a table has a column of numbers at least".to_owned()));
        }
        let options = &by_number(options, &columns);
        let seen = seen(&columns, options);
        let Roles { time, channels, checked, left_out: unused, .. } = seen.roles(options)?;
        one_scale(&channels, options)?;
        let against = against_given(&columns, &channels, checked, options)?;
        let sought = Sought::new(&columns, &seen, options, time, &channels)?;
        let mut groups: Vec<(Source, Vec<Role>)> = Vec::new();
        let mut known: HashMap<([u64; 3], usize), usize> = HashMap::new();
        for role in channels {
            let source = sought.source(&role)?;
            let key = match source {
                Source::Even([start_s, step_s]) => [0, start_s.to_bits(), step_s.to_bits()],
                Source::Column(time) => [1, time as u64, 0],
            };
            let group = *known.entry((key, columns[role.column].values.len())).or_insert(groups.len());
            match groups.get_mut(group) {
                Some((_, roles)) => roles.push(role),
                None => groups.push((source, vec![role])),
            }
        }
        let of_times = |(source, _): &(Source, Vec<Role>)| match source {
            Source::Even(_) => None,
            Source::Column(time) => Some(seen.called(*time)),
        };
        let used: HashSet<String> = groups.iter().filter_map(of_times).collect();
        let several = sought.times.len() > 1;
        let part = |(source, roles): (Source, Vec<Role>)| {
            let places = roles.iter().map(|role| role.column).collect();
            let size = if let Source::Column(time) = source { seen.time_size(time, options)? } else { 1.0 };
            Ok((places, group(&columns, source, size, roles, several, options)?))
        };
        let mut record = Self::of_parts(groups.into_iter().map(part).collect::<Result<_, Error>>()?);
        let unused: Vec<String> = unused.into_iter().filter(|column| !used.contains(column)).collect();
        if !unused.is_empty() {
            record.read.insert(0, Finding::LeftOut(unused));
        }
        let left_out = (!left_out.is_empty()).then(|| format!("nothing is made of {}", left_out.join("; ")));
        record.read.extend(left_out.into_iter().chain(notes).map(Finding::Note).chain(against));
        Ok(record)
    }
}

/// Holds a rate that is given against the times and the rates that the file has.
fn against_given(
    columns: &[Column],
    channels: &[Role],
    checked: Option<(usize, f64)>,
    options: &Options,
) -> Result<Vec<Finding>, Error> {
    let Some(hz) = options.sample_rate_hz else { return Ok(Vec::new()) };
    let (given_s, mut found) = (period(hz)?, Vec::new());
    if let Some((time, size)) = checked {
        let (_, since_s) = columns[time].values.since_first(size);
        if since_s.iter().all(|since_s| since_s.is_finite()) {
            let rate = against_times(given_s, &since_s, 0.0, "the rate that is given")?;
            let lacks = || gaps(&since_s, &|sample| At::Sample(sample + 1));
            found.extend(rate.or_else(lacks));
        }
    }
    let told = |role: &&Role| columns[role.column].sampled_s.map(|[_, step_s]| step_s);
    let differs = |role: &&Role| told(role).is_some_and(|step_s| (step_s / given_s - 1.0).abs() > SAME_RATE);
    if let Some(role) = channels.iter().find(differs) {
        let own_hz = told(&role).map_or(f64::NAN, f64::recip);
        found.push(Finding::Note(format!(
            "the file tells {own_hz} Hz of {}, and the rate that is given is {hz} Hz",
            role.name
        )));
    }
    Ok(found)
}

/// Columns that are picked by their whole names, with the groups that they lie in, by their numbers.
fn by_number(options: &Options, columns: &[Column]) -> Options {
    let number = |pick: &Pick| match pick {
        Pick::Name(name) => {
            let exact = columns.iter().position(|column| column.name == *name);
            let found = exact.or_else(|| columns.iter().position(|column| column.name.eq_ignore_ascii_case(name)));
            found.map_or_else(|| pick.clone(), |column| Pick::Number(column + 1))
        }
        Pick::Number(_) => pick.clone(),
    };
    Options {
        time: options.time.as_ref().map(number),
        accelerations: options.accelerations.iter().map(number).collect(),
        ..options.clone()
    }
}

/// The columns by their names without those of groups, which say nothing of what a column is.
fn seen(columns: &[Column], options: &Options) -> Preview {
    let heading = |column: &Column| {
        let heading = Heading::of(column.own_name());
        let heading = column.unit.iter().fold(heading, |heading, unit| heading.with_unit(unit));
        let plain = heading.spelled.is_none() && heading.named() != crate::heading::Named::Time;
        // Floats have no scale of their own.
        if options.full_scale_m_s2.is_some() && plain { heading.with_unit(FULL_SCALE) } else { heading }
    };
    let headings: Vec<Heading> = columns.iter().map(heading).collect();
    Preview {
        named: headings.iter().any(|heading| !heading.name.is_empty()),
        sampled: columns.iter().any(|column| column.sampled_s.is_some()),
        rows: (0..SHOWN).map(|row| columns.iter().map(|column| column.values.float(row)).collect()).collect(),
        headings,
        ..Preview::default()
    }
}

/// The times of channels are sought here.
struct Sought<'a> {
    columns: &'a [Column],
    seen: &'a Preview,
    options: &'a Options,
    /// The column of times of the whole file, if it has one.
    time: Option<(usize, f64)>,
    /// All columns of times.
    times: Vec<usize>,
    /// For each channel a column of times that lies in the same group and is as long.
    beside: HashMap<usize, usize>,
}

impl<'a> Sought<'a> {
    fn new(
        columns: &'a [Column],
        seen: &'a Preview,
        options: &'a Options,
        time: Option<(usize, f64)>,
        channels: &[Role],
    ) -> Result<Self, Error> {
        let times = if seen.named {
            (0..columns.len()).filter(|column| seen.headings[*column].is_time()).collect()
        } else {
            Vec::new()
        };
        let mut sought = Self { columns, seen, options, time, times, beside: HashMap::new() };
        if options.sample_rate_hz.is_some() || options.time.is_some() {
            return Ok(sought);
        }
        let mut together: BTreeMap<(&str, usize), [Vec<usize>; 2]> = BTreeMap::new();
        let place = |column: usize| (columns[column].group.as_str(), columns[column].values.len());
        for role in channels {
            together.entry(place(role.column)).or_default()[0].push(role.column);
        }
        // A column of times by its place where none is by its name.
        let by_place = time.map(|(time, _)| time).filter(|time| !sought.times.contains(time));
        for time in sought.times.iter().copied().chain(by_place) {
            if let Some([_, times]) = together.get_mut(&place(time)) {
                times.push(time);
            }
        }
        for [channels, mut times] in together.into_values().filter(|[_, times]| !times.is_empty()) {
            times.sort_unstable();
            let owners = match times[..] {
                [time] => vec![time; channels.len()],
                _ => sought.seen.paired(&times, &channels).map_or_else(|| sought.one_clock(&times, &channels), Ok)?,
            };
            sought.beside.extend(channels.into_iter().zip(owners));
        }
        Ok(sought)
    }

    /// One of several columns of times that are those of one clock, in several units; else no one can tell.
    fn one_clock(&self, times: &[usize], channels: &[usize]) -> Result<Vec<usize>, Error> {
        let steps = times.iter().map(|time| self.mean_step(*time)).collect::<Result<Vec<_>, _>>()?;
        let same = |step: &Option<f64>| {
            step.zip(steps[0]).is_some_and(|(step, first): (f64, f64)| (step / first - 1.0).abs() <= SAME_RATE)
        };
        if !steps.iter().all(same) {
            let all: Vec<String> = times.iter().take(SHOWN).map(|time| self.seen.called(*time)).collect();
            return Err(Error::Columns(format!(
                "which times are those of column {} is not clear: {}; name the column of times",
                self.seen.called(channels[0]),
                all.join(", ")
            )));
        }
        let chosen = self.time.map(|(time, _)| time).filter(|time| times.contains(time)).unwrap_or(times[0]);
        Ok(vec![chosen; channels.len()])
    }

    /// The rate that the caller gives, else times beside the channel, else its own rate, else the times of the file.
    fn source(&self, role: &Role) -> Result<Source, Error> {
        let column = &self.columns[role.column];
        let samples = column.values.len();
        if let Some(hz) = self.options.sample_rate_hz {
            return Ok(Source::Even([0.0, period(hz)?]));
        }
        if let (Some(_), Some((time, _))) = (&self.options.time, self.time) {
            return self.long_enough(time, role);
        }
        if column.sampled_s.is_some_and(|[_, step_s]| step_s.is_nan()) {
            return Err(Error::Columns(format!("the file tells two rates of {}: give the sample rate", column.name)));
        }
        let beside = self.beside.get(&role.column).copied();
        match (beside, column.sampled_s, self.time) {
            (Some(time), None, _) => Ok(Source::Column(time)),
            (Some(time), Some([_, step_s]), _) => {
                let mean_s = self.mean_step(time)?;
                if mean_s.is_some_and(|mean_s| (mean_s / step_s - 1.0).abs() <= SAME_RATE) {
                    return Ok(Source::Column(time));
                }
                Err(Error::Columns(format!(
                    "{} has a sample every {step_s} s by what the file tells, and every {} s by its times {}: say which \
                     holds, by the column of times or a sample rate",
                    column.name,
                    mean_s.unwrap_or(f64::NAN),
                    self.columns[time].name
                )))
            }
            (None, Some(sampled_s), _) => Ok(Source::Even(sampled_s)),
            (None, None, Some((time, _))) => self.long_enough(time, role),
            (None, None, None) => {
                let name = if column.name.is_empty() { "samples" } else { &column.name };
                Err(Error::Columns(format!(
                    "the file tells no times of {name}, {samples} of them: give the sample rate"
                )))
            }
        }
    }

    fn long_enough(&self, time: usize, role: &Role) -> Result<Source, Error> {
        let [count, samples] = [time, role.column].map(|column| self.columns[column].values.len());
        if count == samples {
            return Ok(Source::Column(time));
        }
        Err(Error::Columns(format!(
            "column {} has {count} values for {samples} samples of {}: take columns that go together",
            self.seen.called(time),
            role.name
        )))
    }

    /// Seconds between samples by a column of times, on average.
    fn mean_step(&self, time: usize) -> Result<Option<f64>, Error> {
        let size = self.seen.time_size(time, self.options)?;
        let (_, since_s) = self.columns[time].values.since_first(size);
        let steps = float(since_s.len().saturating_sub(1));
        Ok(since_s.last().map(|last| last / steps).filter(|step_s| *step_s > 0.0))
    }
}

/// Channels that share their times.
fn group(
    columns: &[Column],
    source: Source,
    time_size: f64,
    roles: Vec<Role>,
    several: bool,
    options: &Options,
) -> Result<Record, Error> {
    let untimed = |role: Role| {
        let Column { name, group, values, .. } = &columns[role.column];
        // The whole name where the file has groups.
        let name = if group.is_empty() { role.name } else { name.clone() };
        Untimed { name, unit: role.unit, values: values.times(role.size) }
    };
    let channels: Vec<Untimed> = roles.into_iter().map(untimed).collect();
    let mut raw = match source {
        Source::Even(sampled_s) => Raw::even(channels, sampled_s),
        Source::Column(time) => {
            let values = &columns[time].values;
            let (start_s, since_s) = values.since_first(time_size);
            let printed = if let Values::Integer(_) = values { Printed::whole() } else { Printed::floats() };
            Raw { channels, start_s, unit_s: time_size, since_s, printed, ..Raw::default() }
        }
    };
    // A table fills up columns that end before others.
    if several && !raw.since_s.is_empty() {
        let is_filled =
            |row: usize| raw.since_s[row].is_nan() && raw.channels.iter().all(|channel| channel.values[row].is_nan());
        let end = (0..raw.since_s.len()).rposition(|row| !is_filled(row)).map_or(0, |last| last + 1);
        raw.since_s.truncate(end);
        for channel in &mut raw.channels {
            channel.values.truncate(end);
        }
    }
    let mut bad = Bad::default();
    let mut kept = vec![true; raw.channels[0].values.len()];
    for (sample, kept) in kept.iter_mut().enumerate() {
        let values = raw.channels.iter().map(|channel| (channel.name.as_str(), channel.values[sample]));
        let mut values = values.chain(raw.since_s.get(sample).map(|since_s| ("time", *since_s)));
        if let Some((name, value)) = values.find(|(_, value)| !value.is_finite() || value.abs() > LARGEST) {
            *kept = false;
            bad.add(At::Sample(sample + 1), || format!("{value} in {name} is no number up to {LARGEST:e}"));
        }
    }
    raw.keep(&kept);
    raw.finish(bad, options)
}
