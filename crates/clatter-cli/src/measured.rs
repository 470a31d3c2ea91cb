//! This module reads measured drops: records, whose kind is recognized by the first line of the file, and those that a product file names.

use std::io::{Cursor, Read};
use std::path::{Path, PathBuf};

use clatter_answer::Error;
use clatter_answer::fit::{self, Data, DropRecords, List, Record};
use clatter_fit::{Known, MeasuredDrop};
use clatter_product::ProductFile;

use crate::progress::Counted;
use crate::record_args::RecordArgs;
use crate::{Failure, budget, input, text};

/// Reads a file; `position_m` gives the place of the sensor where the record is an acceleration.
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
    (&mut file).take(List::HEADER).read_to_end(&mut begin).map_err(unreadable)?;
    let whole = Cursor::new(&begin).chain(file);
    if let Some(list) = List::of(&begin) {
        return list.read(whole, timing_s).map_err(|reason| Failure::List { path: path.to_owned(), reason });
    }
    let position_m = position_m()?.ok_or_else(|| {
        Failure::Wrong(format!(
            "{} has neither strikes (time_s,end) nor heights (time_s,height_a_m,height_b_m) nor bounces (bounce_s or interval_s) \
             in its first line: an acceleration needs --position (of [[record]], position), where it was measured",
            text::path(path)
        ))
    })?;
    let record = reading.read_from(path, whole)?;
    Data::acceleration(&record, position_m).map_err(|error| match error {
        Error::Channels(count) => Failure::Wrong(format!(
            "{}: {count} channels; --acceleration (of [[record]], acceleration) picks the one of the position",
            text::path(path)
        )),
        Error::Record(reason) => Failure::Record { path: path.to_owned(), reason },
        error => Failure::Wrong(format!("{}: {error}", text::path(path))),
    })
}

/// Returns the reason why there is no fit, with the name of the record.
pub(crate) fn why(error: Error, files: &[PathBuf]) -> Failure {
    if !matches!(error, Error::Fit(_)) {
        return error.into();
    }
    let name = |record: usize| {
        let path = files.get(record.saturating_sub(1)).map(|path| text::path(path));
        path.unwrap_or_else(|| format!("record {record}"))
    };
    Failure::Wrong(fit::refusal(&error, name))
}

/// Records of one drop that a product file names.
pub(crate) struct Drop {
    of: DropRecords,
    paths: Vec<PathBuf>,
}

/// Returns the path of a record that a product file names, as seen from that file.
pub(crate) fn path_of(record: &str, product: &Path) -> PathBuf {
    product.parent().unwrap_or(Path::new("")).join(record)
}

/// Reads the drops whose records a product file names.
pub(crate) fn drops(file: &ProductFile, product: &Path) -> Result<Vec<Drop>, Failure> {
    let of = DropRecords::of_product(file, |record| {
        let path = path_of(&record.file, product);
        data(&path, || Ok(record.position_m), record.timing_s, &RecordArgs::of(record, &path)?)
    })?;
    let paths = |of: &DropRecords| of.records.iter().map(|record| path_of(&record.name, product)).collect();
    Ok(of.into_iter().map(|of| Drop { paths: paths(&of), of }).collect())
}

impl Drop {
    /// Finds the computed drop that is nearest. A result without any near drop, or the end of the time, is an answer as well.
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
