//! This module reads files of measured drops: lists, each recognized by the line that names its columns, and the records that a product
//! file names.

use std::io::Read;

use clatter::End;
use clatter_fit as fit;
use clatter_fit::{MOST_SAMPLES, MOST_STRIKES, Measured, MeasuredHeights, MeasuredStrike};
use clatter_product::{ProductFile, RecordFile, visible};
use clatter_record::{Cell, Options, names_columns, read_list};

use super::{Data, DropRecords, Record};
use crate::Error;

/// Columns of heights, also by the names in tables of trackers.
const HEIGHTS: [[&str; 3]; 2] = [["time_s", "height_a_m", "height_b_m"], ["time_s", "y_a_m", "y_b_m"]];

/// A list of what was measured; what begins as none is a record of accelerations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum List {
    /// `time_s,end`.
    Strikes,
    /// `time_s,height_a_m,height_b_m`, by these names.
    Heights([&'static str; 3]),
    /// `bounce_s`.
    Bounces,
    /// `interval_s`: bounces by the times between them.
    Intervals,
}

impl List {
    /// The largest number of bytes in the lines down to the names of the columns.
    pub const HEADER: u64 = 1 << 16;

    /// Returns the kind of list that begins with these bytes, if any.
    ///
    /// ```
    /// use clatter_answer::fit::List;
    /// assert_eq!(List::of(b"time [ms];end\n0;a\n"), Some(List::Strikes));
    /// assert_eq!(List::of(b"time [s],a [g]\n0,1\n"), None);
    /// ```
    #[must_use]
    pub fn of(begin: &[u8]) -> Option<Self> {
        if names_columns(begin, ["bounce_s"]) {
            return Some(Self::Bounces);
        }
        if names_columns(begin, ["interval_s"]) {
            return Some(Self::Intervals);
        }
        if names_columns(begin, ["time_s", "end"]) {
            return Some(Self::Strikes);
        }
        HEIGHTS.into_iter().find(|names| names_columns(begin, *names)).map(Self::Heights)
    }

    /// Reads it; `timing_s` is the standard deviation of the times of strikes.
    ///
    /// # Errors
    /// The first row that is none.
    pub fn read(self, input: impl Read, timing_s: Option<f64>) -> Result<Data, clatter_record::Error> {
        Ok(match self {
            Self::Bounces => Data::Bounces(bounces(input)?),
            Self::Intervals => Data::Bounces(intervals(input)?),
            Self::Strikes => Data::Measured(Measured::Strikes { strikes: strikes(input)?, deviation_s: timing_s }),
            Self::Heights(names) => {
                Data::Measured(Measured::Heights { samples: heights(input, names)?, deviation_m: None })
            }
        })
    }
}

fn strikes(input: impl Read) -> Result<Vec<MeasuredStrike>, clatter_record::Error> {
    let mut list: Vec<MeasuredStrike> = Vec::new();
    read_list(input, ["time_s", "end"], |[time, end]| {
        let time_s = rising("time_s", time, list.last().map(|strike| strike.time_s))?;
        let end = match end.text {
            "a" => Some(End::A),
            "b" => Some(End::B),
            "" => None,
            _ => return Err(format!("end '{}' is not a, b or empty", visible(end.text))),
        };
        below(list.len(), MOST_STRIKES, "strikes")?;
        list.push(MeasuredStrike { time_s, end });
        Ok(())
    })?;
    Ok(list)
}

fn bounces(input: impl Read) -> Result<Vec<f64>, clatter_record::Error> {
    let mut list: Vec<f64> = Vec::new();
    read_list(input, ["bounce_s"], |[time]| {
        let time_s = rising("bounce_s", time, list.last().copied())?;
        below(list.len(), MOST_STRIKES, "bounces")?;
        list.push(time_s);
        Ok(())
    })?;
    Ok(list)
}

/// Reads the times of bounces from the intervals between them, from the first bounce on.
fn intervals(input: impl Read) -> Result<Vec<f64>, clatter_record::Error> {
    let mut list = vec![0.0];
    read_list(input, ["interval_s"], |[interval]| {
        let interval_s = finite("interval_s", interval)?;
        if interval_s <= 0.0 {
            return Err(format!("interval_s = {interval_s:?} is not > 0"));
        }
        below(list.len(), MOST_STRIKES, "bounces")?;
        list.extend(list.last().map(|last| last + interval_s));
        Ok(())
    })?;
    Ok(list)
}

fn heights(input: impl Read, names: [&str; 3]) -> Result<Vec<MeasuredHeights>, clatter_record::Error> {
    let mut list: Vec<MeasuredHeights> = Vec::new();
    read_list(input, names, |[time, a, b]| {
        let time_s = rising(names[0], time, list.last().map(|sample| sample.time_s))?;
        let height_m = [finite(names[1], a)?, finite(names[2], b)?];
        below(list.len(), MOST_SAMPLES, "samples")?;
        list.push(MeasuredHeights { time_s, height_m });
        Ok(())
    })?;
    Ok(list)
}

/// Reads the number of a cell.
fn finite(name: &str, cell: Cell<'_>) -> Result<f64, String> {
    cell.number.ok_or_else(|| format!("{name}: '{}' is not a number such as 0.5", visible(cell.text)))
}

/// Reads a time that is not before the one in the row above.
fn rising(name: &str, cell: Cell<'_>, before: Option<f64>) -> Result<f64, String> {
    let time = finite(name, cell)?;
    match before {
        Some(before) if time < before => {
            Err(format!("{name} {time:?} is before {before:?}, the row above; sort by time"))
        }
        _ => Ok(time),
    }
}

fn below(count: usize, most: usize, name: &str) -> Result<(), String> {
    if count < most { Ok(()) } else { Err(format!("more than {most} {name}")) }
}

/// Returns the options for reading a record of accelerations that a product file names.
///
/// # Errors
/// Units that are none.
pub fn options(record: &RecordFile) -> Result<Options, clatter_record::Error> {
    Ok(Options {
        accelerations: record.acceleration.iter().flat_map(|column| column.parse()).collect(),
        units: record.units.as_deref().map(str::parse).transpose()?,
        sample_rate_hz: record.sample_rate_hz,
        ..Options::default()
    })
}

impl DropRecords {
    /// Reads the drops whose records a product file names, in its order; `read` reads one of the records.
    ///
    /// # Errors
    /// Those of `read`.
    pub fn of_product<E>(
        file: &ProductFile,
        mut read: impl FnMut(&RecordFile) -> Result<Data, E>,
    ) -> Result<Vec<Self>, E> {
        let mut groups: Vec<Vec<&RecordFile>> = Vec::new();
        for record in &file.records {
            let same = |group: &&mut Vec<&RecordFile>| record.drop.is_some() && group[0].drop == record.drop;
            match groups.iter_mut().find(same) {
                Some(group) => group.push(record),
                None => groups.push(vec![record]),
            }
        }
        let mut one = |record: &RecordFile| Ok(Record { name: record.file.clone(), data: read(record)? });
        let of_one = |records: Vec<&RecordFile>| {
            Ok(Self {
                name: records[0].drop.clone().unwrap_or_else(|| records[0].file.clone()),
                timing_s: records[0].timing_s,
                records: records.into_iter().map(&mut one).collect::<Result<_, E>>()?,
            })
        };
        groups.into_iter().map(of_one).collect()
    }
}

/// Returns the reason why there is no fit, with the names of the records in place of their numbers, from 1.
pub fn refusal(error: &Error, name: impl Fn(usize) -> String) -> String {
    let Error::Fit(error) = error else { return error.to_string() };
    match error {
        fit::Error::Value { record, name: what, value, allowed } => {
            format!("{}: {what} = {value:?} is not {allowed}", name(*record))
        }
        fit::Error::Count { record, count, name: what, allowed } => {
            format!("{}: {count} {what}; allowed: {allowed}", name(*record))
        }
        // The name of the file replaces "record 1".
        fit::Error::Far { record, .. } | fit::Error::Scatter { record, .. } | fit::Error::Noise { record, .. } => {
            error.to_string().replacen(&format!("record {record}"), &name(*record), 1)
        }
        error => error.to_string(),
    }
}
