//! This module reads measured drops: the given ones, and those whose records a product names.

use std::fs::File;
use std::io::{Cursor, Read};
use std::path::Path;

use clatter_answer::Error;
use clatter_answer::fit::{self, Data, DropRecords, List};
use clatter_fit::{Known, Measured, MeasuredDrop, MeasuredHeights, MeasuredStrike};
use clatter_product::{ProductFile, RecordFile, visible};
use pyo3::prelude::*;
use pyo3::types::PyMapping;

use crate::answered::Refused;
use crate::given::{Given, Value, parts, rows};
use crate::records::{self, Record};
use crate::refused;
use crate::work::Wanted;

impl Value for Vec<MeasuredStrike> {
    /// Reads times of strikes, each with its end where that is known.
    fn read(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        rows(name, value, |name, row| {
            let [time_s, end] = parts(name, row, "(time_s, end)")?;
            Ok(MeasuredStrike {
                time_s: f64::read(&format!("time of {name}"), &time_s)?,
                end: Value::read(name, &end)?,
            })
        })
    }
}

/// Reads the records of a given drop, and the standard deviation of its times.
pub(crate) fn records(given: &Given<'_>) -> PyResult<(Vec<fit::Record>, Option<f64>)> {
    let deviation_s = given.read("timing_s")?;
    let mut records = Vec::new();
    let mut add = |name: &str, data| records.push(fit::Record { name: name.to_owned(), data });
    if let Some(strikes) = given.read("strikes")? {
        add("strikes", Data::Measured(Measured::Strikes { strikes, deviation_s }));
    }
    if let Some(list) = given.read::<Option<Vec<[f64; 3]>>>("heights")? {
        let samples = list.into_iter().map(|[time_s, a, b]| MeasuredHeights { time_s, height_m: [a, b] }).collect();
        add("heights", Data::Measured(Measured::Heights { samples, deviation_m: None }));
    }
    if let Some(list) = given.read("bounces")? {
        add("bounces", Data::Bounces(list));
    }
    let accelerations = given.value("accelerations")?;
    if !accelerations.is_none() {
        for (record, position_m) in rows("accelerations", &accelerations, acceleration)? {
            let record = record.get();
            add(&record.file, Data::acceleration(&record.record, position_m).map_err(refused)?);
        }
    }
    Ok((records, deviation_s))
}

/// Reads an acceleration, and where it was measured.
fn acceleration(name: &str, row: &Bound<'_, PyAny>) -> PyResult<(Py<Record>, f64)> {
    let pair = parts(name, row, "").ok();
    let held = pair.and_then(|[record, at]| Some((record.getattr("_data").ok()?.extract().ok()?, at)));
    let (record, position_m) = held.ok_or_else(|| refused(format!("{name} is not (Record, position_m)")))?;
    Ok((record, f64::read(&format!("position of {name}"), &position_m)?))
}

/// Reads the drops that are given by their names.
pub(crate) fn given(drops: &Bound<'_, PyAny>) -> PyResult<Vec<DropRecords>> {
    if drops.is_none() {
        return Ok(Vec::new());
    }
    let one = |(name, drop): (String, Given<'_>)| {
        let (records, timing_s) = records(&drop)?;
        if let Some(key) = drop.unread() {
            let keys = "strikes, heights, bounces, accelerations and timing_s";
            return Err(refused(format!("measured '{name}' has '{key}'; a drop has {keys}")));
        }
        Ok(DropRecords { name, records, timing_s })
    };
    drops.cast::<PyMapping>()?.items()?.iter().map(|item| one(item.extract()?)).collect()
}

/// Reads the drops whose records a product names, from its folder.
pub(crate) fn named(file: &ProductFile, folder: &Path, wanted: &Wanted) -> Result<Vec<DropRecords>, Refused> {
    DropRecords::of_product(file, |record| read(record, &folder.join(&record.file), wanted))
}

fn read(record: &RecordFile, path: &Path, wanted: &Wanted) -> Result<Data, Refused> {
    let unreadable = |error| Refused::System(path.to_owned(), error);
    let name = visible(&path.to_string_lossy()).into_owned();
    let bad = |error: &dyn std::fmt::Display| Refused::Words(format!("{name}: {error}"));
    let (mut file, mut begin) = (File::open(path).map_err(unreadable)?, Vec::new());
    let size = file.metadata().map_err(unreadable)?.len();
    (&mut file).take(List::HEADER).read_to_end(&mut begin).map_err(unreadable)?;
    let whole = Cursor::new(&begin).chain(file);
    if let Some(list) = List::of(&begin) {
        return list.read(whole, record.timing_s).map_err(|error| bad(&error));
    }
    let Some(position_m) = record.position_m else {
        let none = "strikes, heights or bounces are not in its first line: an acceleration needs its position";
        return Err(bad(&none));
    };
    let options = fit::options(record).map_err(|error| bad(&error))?;
    let read = records::read(whole, size, &options, &name, wanted)?;
    Data::acceleration(&read, position_m).map_err(|error| match error {
        Error::Channels(count) => bad(&format!("{count} channels; acceleration picks the one of the position")),
        error => bad(&error),
    })
}

/// Finds the computed drop nearest to each.
pub(crate) fn fitted(
    drops: Vec<DropRecords>,
    file: &ProductFile,
    wanted: &Wanted,
) -> Result<Vec<MeasuredDrop>, Refused> {
    let known = Known::from(file);
    let one = |drop: DropRecords| {
        wanted.or_leave();
        let names: Vec<String> = drop.records.iter().map(|record| visible(&record.name).into_owned()).collect();
        let name = |n: usize| names.get(n.saturating_sub(1)).cloned().unwrap_or_else(|| format!("record {n}"));
        drop.fitted(&known).map_err(|error| Refused::Words(fit::refusal(&error, name)))
    };
    drops.into_iter().map(one).collect()
}
