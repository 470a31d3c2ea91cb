//! This module reads measured drops: the given ones, and those whose records a product names.

use std::fs::File;
use std::io::{self, Cursor, Read};
use std::path::{Path, PathBuf};

use clatter::End;
use clatter_answer::Error;
use clatter_answer::fit::{self, Data, DropRecords, List};
use clatter_fit::{Known, Measured, MeasuredDrop, MeasuredHeights, MeasuredStrike};
use clatter_product::{ProductFile, RecordFile, visible};
use pyo3::exceptions::{PyOSError, PyRuntimeError};
use pyo3::prelude::*;

use crate::records::Record;
use crate::work::Wanted;
use crate::{refused, single};

/// Strikes, heights of both ends, bounces, and accelerations with their places in m.
pub(crate) type Given =
    (Option<Vec<(f64, Option<String>)>>, Option<Vec<[f64; 3]>>, Option<Vec<f64>>, Vec<(Py<Record>, f64)>);

/// The reason why there is no answer: in the words of the command, or an error of the system or of an outside program.
pub(crate) enum Refused {
    Words(String),
    System(PathBuf, io::Error),
    Outside(String),
}

impl From<String> for Refused {
    fn from(words: String) -> Self {
        Self::Words(words)
    }
}

impl From<Refused> for PyErr {
    fn from(why: Refused) -> Self {
        match why {
            Refused::Words(words) => refused(words),
            Refused::System(path, error) => PyOSError::new_err((error.raw_os_error(), error.to_string(), path)),
            Refused::Outside(said) => PyRuntimeError::new_err(said),
        }
    }
}

/// Returns the records of a given drop.
pub(crate) fn records(given: Given, timing_s: Option<f64>) -> PyResult<Vec<fit::Record>> {
    let (strikes, heights, bounces, accelerations) = given;
    let mut records = Vec::new();
    let mut add = |name: &str, data| records.push(fit::Record { name: name.to_owned(), data });
    if let Some(list) = strikes {
        let strike = |(time_s, end): (f64, Option<String>)| {
            let end: Option<End> = end.map(|name| single::end(&name)).transpose()?;
            Ok(MeasuredStrike { time_s, end })
        };
        let strikes = list.into_iter().map(strike).collect::<PyResult<_>>()?;
        add("strikes", Data::Measured(Measured::Strikes { strikes, deviation_s: timing_s }));
    }
    if let Some(list) = heights {
        let samples = list.into_iter().map(|[time_s, a, b]| MeasuredHeights { time_s, height_m: [a, b] }).collect();
        add("heights", Data::Measured(Measured::Heights { samples, deviation_m: None }));
    }
    if let Some(list) = bounces {
        add("bounces", Data::Bounces(list));
    }
    for (record, position_m) in &accelerations {
        let record = record.get();
        add(record.file(), Data::acceleration(record.inner(), *position_m).map_err(refused)?);
    }
    Ok(records)
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
    let read = clatter_record::Record::read(whole, &options, |_| wanted.or_leave()).map_err(|error| bad(&error))?;
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
