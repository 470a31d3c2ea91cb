//! Measured drops: records, each kind told by the first line of its file, and those that a product file names.

use std::io::{Cursor, Read};
use std::path::{Path, PathBuf};

use clatter::End;
use clatter_assess::fit::{
    self, Fit, Known, MOST_SAMPLES, MOST_STRIKES, Measured, MeasuredDrop, MeasuredHeights, MeasuredStrike,
};
use clatter_assess::{ProductFile, RecordFile};
use clatter_record::{Cell, names_columns};

use crate::lists::{finite, rows_of};
use crate::progress::Counted;
use crate::record_args::RecordArgs;
use crate::text::visible;
use crate::{Failure, budget, input, text};

/// What one file holds.
#[derive(Debug, Clone)]
pub(crate) enum Record {
    Measured(Measured),
    Bounces(Vec<f64>),
}

/// Columns of heights: as tables of trackers call them too.
const HEIGHTS: [[&str; 3]; 2] = [["time_s", "height_a_m", "height_b_m"], ["time_s", "y_a_m", "y_b_m"]];
/// Bytes that the lines down to the names of the columns may have.
const HEADER: u64 = 1 << 16;

/// Reads a file; `position_m` tells where an acceleration was measured, if it is one.
pub(crate) fn read(
    path: &Path,
    position_m: impl FnOnce() -> Result<Option<f64>, Failure>,
    timing_s: Option<f64>,
    reading: &RecordArgs,
) -> Result<Record, Failure> {
    let unreadable = |reason| Failure::Unreadable { path: path.to_owned(), reason };
    let (mut file, mut begin) = (input::open(path).map_err(unreadable)?, Vec::new());
    (&mut file).take(HEADER).read_to_end(&mut begin).map_err(unreadable)?;
    let whole = Cursor::new(&begin).chain(file);
    if names_columns(&begin, ["bounce_s"]) {
        return bounces(path, whole).map(Record::Bounces);
    }
    if names_columns(&begin, ["interval_s"]) {
        return intervals(path, whole).map(Record::Bounces);
    }
    let measured = if names_columns(&begin, ["time_s", "end"]) {
        Measured::Strikes { strikes: strikes(path, whole)?, deviation_s: timing_s }
    } else if let Some(names) = HEIGHTS.into_iter().find(|names| names_columns(&begin, *names)) {
        Measured::Heights { samples: heights(path, whole, names)?, deviation_m: None }
    } else {
        let position_m = position_m()?.ok_or_else(|| {
            Failure::Wrong(format!(
                "{} has neither strikes (time_s,end) nor heights (time_s,height_a_m,height_b_m) nor bounces (bounce_s or interval_s) \
                 in its first line: an acceleration needs --position (of [[record]], position), where it was measured",
                text::path(path)
            ))
        })?;
        acceleration(path, whole, reading, position_m)?
    };
    Ok(Record::Measured(measured))
}

fn strikes(path: &Path, input: impl Read) -> Result<Vec<MeasuredStrike>, Failure> {
    let mut list: Vec<MeasuredStrike> = Vec::new();
    rows_of(path, input, ["time_s", "end"], |[time, end]| {
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

fn bounces(path: &Path, input: impl Read) -> Result<Vec<f64>, Failure> {
    let mut list: Vec<f64> = Vec::new();
    rows_of(path, input, ["bounce_s"], |[time]| {
        let time_s = rising("bounce_s", time, list.last().copied())?;
        below(list.len(), MOST_STRIKES, "bounces")?;
        list.push(time_s);
        Ok(())
    })?;
    Ok(list)
}

/// Times of bounces by those between them, from the first bounce on.
fn intervals(path: &Path, input: impl Read) -> Result<Vec<f64>, Failure> {
    let mut list = vec![0.0];
    rows_of(path, input, ["interval_s"], |[interval]| {
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

fn heights(path: &Path, input: impl Read, names: [&str; 3]) -> Result<Vec<MeasuredHeights>, Failure> {
    let mut list: Vec<MeasuredHeights> = Vec::new();
    rows_of(path, input, names, |[time, a, b]| {
        let time_s = rising(names[0], time, list.last().map(|sample| sample.time_s))?;
        let height_m = [finite(names[1], a)?, finite(names[2], b)?];
        below(list.len(), MOST_SAMPLES, "samples")?;
        list.push(MeasuredHeights { time_s, height_m });
        Ok(())
    })?;
    Ok(list)
}

/// A time, not before the one in the row above.
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

/// An acceleration over even times, of one channel.
fn acceleration(path: &Path, input: impl Read, reading: &RecordArgs, position_m: f64) -> Result<Measured, Failure> {
    let bad = |reason| Failure::Record { path: path.to_owned(), reason };
    let record = reading.read_from(path, input)?;
    let [channel] = record.channels() else {
        return Err(Failure::Wrong(format!(
            "{}: {} channels; --acceleration (of [[record]], acceleration) picks the one of the position",
            text::path(path),
            record.channels().len()
        )));
    };
    let times = channel.times();
    let step_s = times.even("a fit").map_err(bad)?;
    if channel.values.len() > MOST_SAMPLES {
        let samples = channel.values.len();
        return Err(Failure::Wrong(format!(
            "{}: {samples} samples; a fit takes {MOST_SAMPLES} at most",
            text::path(path)
        )));
    }
    Ok(Measured::Acceleration { position_m, start_s: times.start_s(), step_s, values_m_s2: channel.values.clone() })
}

/// The drop that is nearest to records of one drop, or why there is none.
pub(crate) fn fitted(
    known: &Known,
    records: &[Record],
    timing_s: Option<f64>,
) -> Result<Result<Fit, fit::Error>, Failure> {
    if let [Record::Bounces(times_s)] = records {
        return Ok(fit::bounces(times_s, known.gravity_m_s2, timing_s));
    }
    let measured = |record: &Record| match record {
        Record::Measured(measured) => Ok(measured.clone()),
        Record::Bounces(_) => Err(Failure::Usage("a record of bounces is of another drop: fit it alone")),
    };
    let measured = records.iter().map(measured).collect::<Result<Vec<Measured>, _>>()?;
    let _shown = Counted::begin("fitting", 0);
    Ok(fit::fit(known, &measured))
}

/// Why there is no fit, with the name of the record.
pub(crate) fn why(error: &fit::Error, files: &[impl AsRef<Path>]) -> String {
    let name = |record: usize| {
        let path = files.get(record.saturating_sub(1)).map(|path| text::path(path.as_ref()));
        path.unwrap_or_else(|| format!("record {record}"))
    };
    match error {
        fit::Error::Value { record, name: what, value, allowed } => {
            format!("{}: {what} = {value:?} is not {allowed}", name(*record))
        }
        fit::Error::Count { record, count, name: what, allowed } => {
            format!("{}: {count} {what}; allowed: {allowed}", name(*record))
        }
        // The name of the file in place of "record 1".
        fit::Error::Far { record, .. } | fit::Error::Scatter { record, .. } => {
            error.to_string().replacen(&format!("record {record}"), &name(*record), 1)
        }
        error => error.to_string(),
    }
}

/// Records of one drop that a product file names.
pub(crate) struct Drop {
    name: String,
    files: Vec<String>,
    paths: Vec<PathBuf>,
    records: Vec<Record>,
    timing_s: Option<f64>,
}

/// The file of a record that a product file names, from where that file is.
pub(crate) fn path_of(record: &RecordFile, product: &Path) -> PathBuf {
    product.parent().unwrap_or(Path::new("")).join(&record.file)
}

/// The drops whose records a product file names.
pub(crate) fn drops(file: &ProductFile, product: &Path) -> Result<Vec<Drop>, Failure> {
    let mut groups: Vec<Vec<&RecordFile>> = Vec::new();
    for record in &file.records {
        let same = |group: &&mut Vec<&RecordFile>| record.drop.is_some() && group[0].drop == record.drop;
        match groups.iter_mut().find(same) {
            Some(group) => group.push(record),
            None => groups.push(vec![record]),
        }
    }
    let of_one = |records: Vec<&RecordFile>| {
        let paths: Vec<PathBuf> = records.iter().map(|record| path_of(record, product)).collect();
        let read = |(record, path): (&&RecordFile, &PathBuf)| {
            read(path, || Ok(record.position_m), record.timing_s, &RecordArgs::of(record, path)?)
        };
        Ok(Drop {
            name: records[0].drop.clone().unwrap_or_else(|| records[0].file.clone()),
            files: records.iter().map(|record| record.file.clone()).collect(),
            records: records.iter().zip(&paths).map(read).collect::<Result<_, _>>()?,
            paths,
            timing_s: records[0].timing_s,
        })
    };
    groups.into_iter().map(of_one).collect()
}

const TOO_LATE: &str = "not fitted, the time was over before";

impl Drop {
    /// The computed drop that is nearest. That none comes near what was measured, or that the time is over, is an answer.
    pub(crate) fn fitted(self, file: &ProductFile) -> Result<MeasuredDrop, Failure> {
        let found = if budget::go_on() {
            let (known, records, timing_s) = (Known::from(file), self.records, self.timing_s);
            let Some(found) = budget::in_time(move || fitted(&known, &records, timing_s)) else {
                return Ok(MeasuredDrop { name: self.name, files: self.files, found: Err(TOO_LATE.to_owned()) });
            };
            match found? {
                Ok(fit) => Ok(fit),
                Err(error @ (fit::Error::Far { .. } | fit::Error::Scatter { .. } | fit::Error::NoDrop(_))) => {
                    Err(error.to_string())
                }
                Err(error) => return Err(Failure::Wrong(why(&error, &self.paths))),
            }
        } else {
            Err(TOO_LATE.to_owned())
        };
        Ok(MeasuredDrop { name: self.name, files: self.files, found })
    }
}
