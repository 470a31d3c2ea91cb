//! Measured drops: records, each kind told by the first line of its file, and those that a product file names.

use std::io::{Cursor, Read};
use std::path::{Path, PathBuf};

use clatter::End;
use clatter_answer::Error;
use clatter_answer::fit::{Data, DropRecords, Record};
use clatter_assess::fit::{
    self, Known, MOST_SAMPLES, MOST_STRIKES, Measured, MeasuredDrop, MeasuredHeights, MeasuredStrike,
};
use clatter_assess::{ProductFile, RecordFile};
use clatter_record::{Cell, names_columns};

use crate::lists::{finite, rows_of};
use crate::progress::Counted;
use crate::record_args::RecordArgs;
use crate::text::visible;
use crate::{Failure, budget, input, text};

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
    let data = data(path, position_m, timing_s, reading)?;
    Ok(Record { name: path.to_string_lossy().into_owned(), data })
}

fn data(
    path: &Path,
    position_m: impl FnOnce() -> Result<Option<f64>, Failure>,
    timing_s: Option<f64>,
    reading: &RecordArgs,
) -> Result<Data, Failure> {
    let unreadable = |reason| Failure::Unreadable { path: path.to_owned(), reason };
    let (mut file, mut begin) = (input::open(path).map_err(unreadable)?, Vec::new());
    (&mut file).take(HEADER).read_to_end(&mut begin).map_err(unreadable)?;
    let whole = Cursor::new(&begin).chain(file);
    if names_columns(&begin, ["bounce_s"]) {
        return bounces(path, whole).map(Data::Bounces);
    }
    if names_columns(&begin, ["interval_s"]) {
        return intervals(path, whole).map(Data::Bounces);
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
        let record = reading.read_from(path, whole)?;
        return Data::acceleration(&record, position_m).map_err(|error| match error {
            Error::Channels(count) => Failure::Wrong(format!(
                "{}: {count} channels; --acceleration (of [[record]], acceleration) picks the one of the position",
                text::path(path)
            )),
            Error::Record(reason) => Failure::Record { path: path.to_owned(), reason },
            error => Failure::Wrong(format!("{}: {error}", text::path(path))),
        });
    };
    Ok(Data::Measured(measured))
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

/// Why there is no fit, with the name of the record.
pub(crate) fn why(error: Error, files: &[PathBuf]) -> Failure {
    let Error::Fit(error) = error else { return error.into() };
    let name = |record: usize| {
        let path = files.get(record.saturating_sub(1)).map(|path| text::path(path));
        path.unwrap_or_else(|| format!("record {record}"))
    };
    Failure::Wrong(match error {
        fit::Error::Value { record, name: what, value, allowed } => {
            format!("{}: {what} = {value:?} is not {allowed}", name(record))
        }
        fit::Error::Count { record, count, name: what, allowed } => {
            format!("{}: {count} {what}; allowed: {allowed}", name(record))
        }
        // The name of the file in place of "record 1".
        fit::Error::Far { record, .. } | fit::Error::Scatter { record, .. } => {
            error.to_string().replacen(&format!("record {record}"), &name(record), 1)
        }
        error => error.to_string(),
    })
}

/// Records of one drop that a product file names.
pub(crate) struct Drop {
    of: DropRecords,
    paths: Vec<PathBuf>,
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
            let reading = RecordArgs::of(record, path)?;
            let data = data(path, || Ok(record.position_m), record.timing_s, &reading)?;
            Ok(Record { name: record.file.clone(), data })
        };
        let of = DropRecords {
            name: records[0].drop.clone().unwrap_or_else(|| records[0].file.clone()),
            records: records.iter().zip(&paths).map(read).collect::<Result<_, Failure>>()?,
            timing_s: records[0].timing_s,
        };
        Ok(Drop { of, paths })
    };
    groups.into_iter().map(of_one).collect()
}

impl Drop {
    /// The computed drop that is nearest. That none comes near what was measured, or that the time is over, is an answer.
    pub(crate) fn fitted(self, file: &ProductFile) -> Result<MeasuredDrop, Failure> {
        let too_late = |of: DropRecords| Ok(of.told(Err("not fitted, the time was over before".to_owned())));
        if !budget::go_on() {
            return too_late(self.of);
        }
        let (known, of) = (Known::from(file), self.of.clone());
        let _shown = Counted::begin("fitting", 0);
        match budget::in_time(move || of.fitted(&known)) {
            Some(fitted) => fitted.map_err(|error| why(error, &self.paths)),
            None => too_late(self.of),
        }
    }
}
