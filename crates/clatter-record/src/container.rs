//! Files that hold numbers in binary, or in fixed fields: from their bytes to a [`Table`].
//!
//! A file is known by its first bytes, never by the ending of its name. Every reader stays within two bounds: what the
//! file itself holds, and the number of values that the caller allows, which is checked before memory is taken.

mod bytes;
mod codec;
mod kind;
mod mat;
mod npy;
mod number;
mod tdms;
mod uff;
mod wav;

#[cfg(feature = "parquet")]
mod arrow;
#[cfg(feature = "hdf5")]
mod hdf5;
#[cfg(feature = "parquet")]
mod parquet;
#[cfg(feature = "parquet")]
mod stored;

pub use kind::Kind;
#[cfg(feature = "parquet")]
pub use parquet::{RowGroupWriter, RowGroups, Series, write as write_parquet};

use crate::unit::lists;
use crate::{Column, Error, Table, Values};
use number::Number;
use std::collections::HashMap;

/// The columns of a file in one of the binary kinds.
///
/// At most `most` values are read, all columns together. A column keeps the name, the unit and the rate that the file
/// gives it; numbers are not converted. Columns may differ in length where the file has channels of several lengths.
/// Single numbers beside them are left out, save those that name a rate (`fs`, `dt` …): they become
/// [`Column::sampled_s`]. 64-bit integers beyond 2⁵³, points in time, times of day and durations stay [`Values::Integer`],
/// times in nanoseconds, which are their unit; all else are floats, exactly where floats hold them. Numbers that are kept as
/// text, in dictionaries or as sparse matrices are read as well.
///
/// Every column, array or channel is one of [`Table::columns`] or named in [`Table::left_out`].
///
/// # Errors
/// [`Error::File`] where the bytes are torn or not as the kind has to be, hold more than `most` values, hold no numbers,
/// or are of a kind that is read elsewhere ([`Kind::Text`]) or left out of this build.
///
/// # Examples
/// ```
/// use clatter_record::{Kind, Values, read};
/// let mut file = b"\x93NUMPY\x01\0\x38\0{'descr': '<f8', 'fortran_order': False, 'shape': (2,)}\n".to_vec();
/// file.extend([0.0_f64, 9.81].into_iter().flat_map(f64::to_le_bytes));
/// let kind = Kind::of(&file)?;
/// assert_eq!(kind, Kind::Npy);
/// let table = read(kind, &file, 1000)?;
/// assert_eq!(table.columns[0].values, Values::Float(vec![0.0, 9.81]));
/// # Ok::<(), clatter_record::Error>(())
/// ```
pub fn read(kind: Kind, bytes: &[u8], most: usize) -> Result<Table, Error> {
    let table = &mut TableBuilder { left: most, most, ..TableBuilder::default() };
    match kind {
        Kind::Text => return Err(refuse("a text file is not read as a binary one")),
        Kind::Npy => npy::read(bytes, table)?,
        Kind::Wav => wav::read(bytes, table)?,
        Kind::Mat5 => mat::read(bytes, table)?,
        Kind::Mat4 => mat::level4::read(bytes, table)?,
        Kind::Tdms => tdms::read(bytes, table)?,
        Kind::Uff => uff::read(bytes, table)?,
        #[cfg(feature = "hdf5")]
        Kind::Hdf5 => hdf5::read(bytes, table)?,
        #[cfg(feature = "parquet")]
        Kind::Parquet => parquet::read(bytes, table)?,
        #[cfg(feature = "parquet")]
        Kind::Arrow => arrow::read(bytes, table)?,
        #[cfg(not(all(feature = "hdf5", feature = "parquet")))]
        other => return Err(refuse(format!("this build does not read {other}"))),
    }
    let named = table.left_out.iter().map(|(reason, names)| format!("{} ({reason})", names.join(", ")));
    table.table.left_out = named.collect();
    let Table { columns, left_out, .. } = &table.table;
    if columns.is_empty() {
        let all = left_out.join("; ");
        let why = if all.is_empty() { "no column of numbers".to_owned() } else { format!("nothing but {all}") };
        return Err(refuse(format!("{kind}: it holds {why}")));
    }
    Ok(std::mem::take(&mut table.table))
}

fn refuse(message: impl Into<String>) -> Error {
    Error::File(message.into())
}

/// The table of a file while it is filled: every reader puts its columns here, and what it leaves out.
#[derive(Debug, Default)]
struct TableBuilder {
    table: Table,
    /// What is no column of numbers: each reason, and the names.
    left_out: Vec<(String, Vec<String>)>,
    /// How many values may still be read.
    left: usize,
    most: usize,
    /// Groups, the file by an empty name, and the time between samples that numbers beside the columns tell for each.
    intervals_s: HashMap<String, f64>,
}

impl TableBuilder {
    /// Room for so many values more, before memory is taken for them: rows times columns.
    fn take(&mut self, counts: &[usize]) -> Result<usize, Error> {
        // A product that overflows is beyond any room.
        let values =
            counts.iter().try_fold(1_usize, |product, count| product.checked_mul(*count)).unwrap_or(usize::MAX);
        self.left = self.left.checked_sub(values).ok_or_else(|| {
            refuse(format!("the file holds more than {} values, which is the most that is read", self.most))
        })?;
        Ok(values)
    }
    /// Bytes that a compressed part of the file may unpack to: 8 a value, and some for names and headers.
    fn bytes(&self) -> usize {
        self.left.saturating_mul(8).saturating_add(1 << 16)
    }

    /// Adds columns of a group.
    fn extend(&mut self, group: &str, columns: impl IntoIterator<Item = Column>) {
        let columns = columns.into_iter().map(|column| Column { group: group.to_owned(), ..column });
        self.table.columns.extend(columns);
    }
    /// Names what is no column of numbers.
    fn leave_out(&mut self, name: &str, reason: impl AsRef<str>) {
        let (name, reason) = (format!("{name:?}"), reason.as_ref());
        match self.left_out.iter_mut().find(|(known, _)| known == reason) {
            Some((_, names)) => names.push(name),
            None => self.left_out.push((reason.to_owned(), vec![name])),
        }
    }
    /// Adds a column without a rate of its own, or names it where it is none of numbers.
    #[cfg(feature = "parquet")]
    fn add(&mut self, name: &str, unit: Option<String>, values: Result<Values, String>) {
        match values {
            Ok(values) => self.extend("", [column(name, unit, values)]),
            Err(reason) => self.leave_out(name, reason),
        }
    }

    /// Takes in a single number of a group, which may tell the time between samples of its columns.
    fn number(&mut self, group: &str, name: &str, path: &str, value: f64) {
        if let Some(interval_s) = interval_s(name, value) {
            let told = agreed(self.intervals_s.get(group).copied(), interval_s);
            self.intervals_s.insert(group.to_owned(), told);
        } else {
            self.leave_out(path, "a single number");
        }
    }
    /// Columns without a time between samples get that of their group, or of the nearest one around it. The names of groups
    /// within groups have this separator.
    fn spread_intervals(&mut self, separator: char) {
        for column in &mut self.table.columns {
            let mut group = Some(column.group.as_str());
            while let (Some(name), None) = (group, column.sampled_s) {
                column.sampled_s = self.intervals_s.get(name).map(|interval_s| [0.0, *interval_s]);
                group = match name.rsplit_once(separator) {
                    Some((around, _)) => Some(around),
                    None => Some("").filter(|_| !name.is_empty()),
                };
            }
        }
    }
}

/// A column without a rate of its own.
fn column(name: impl Into<String>, unit: Option<String>, values: Values) -> Column {
    Column { name: name.into(), group: String::new(), unit, sampled_s: None, values }
}

/// The number of rows of columns that are written.
#[cfg(feature = "parquet")]
fn equal_length(columns: &[&[f64]]) -> Result<usize, Error> {
    let rows = columns.first().ok_or_else(|| refuse("there is no column to write"))?.len();
    match columns.iter().position(|column| column.len() != rows) {
        None => Ok(rows),
        Some(i) => Err(refuse(format!(
            "column {} has {} values, the first has {rows}; columns of one file are of equal length",
            i + 1,
            columns[i].len()
        ))),
    }
}

/// Why complex numbers are left out.
const COMPLEX: &str = "complex; a record is real: save its real part";

/// How the columns of a matrix are told apart by name.
#[derive(Debug, Clone, Copy)]
enum Naming {
    /// Not at all.
    None,
    /// `name(:,1)`, from 1.
    Matlab,
    /// `name[:,0]`, from 0.
    #[cfg(feature = "hdf5")]
    Python,
}

impl Naming {
    fn name(self, name: &str, index: usize, by_row: bool) -> String {
        match (self, by_row) {
            (Self::None, _) => String::new(),
            (Self::Matlab, false) => format!("{name}(:,{})", index + 1),
            (Self::Matlab, true) => format!("{name}({},:)", index + 1),
            #[cfg(feature = "hdf5")]
            (Self::Python, false) => format!("{name}[:,{index}]"),
            #[cfg(feature = "hdf5")]
            (Self::Python, true) => format!("{name}[{index},:]"),
        }
    }
}

/// A matrix of numbers, as it lies in the file.
#[derive(Debug, Clone, Copy)]
struct Matrix<'a> {
    rows: usize,
    columns: usize,
    /// Tells whether the numbers of a column lie side by side, or those of a row.
    column_by_column: bool,
    bytes: &'a [u8],
    number: Number,
    big_endian: bool,
}

impl Matrix<'_> {
    /// Its columns, or its rows where they are longer: a record has more samples than channels.
    ///
    /// One that has one row or one column goes by `name` alone. The bytes have been counted.
    fn split(&self, name: &str, naming: Naming) -> Vec<Column> {
        let by_row = self.columns > self.rows;
        let (count, length) = if by_row { (self.rows, self.columns) } else { (self.columns, self.rows) };
        let side_by_side = self.column_by_column != by_row;
        let (step, next) = if side_by_side { (1, length) } else { (count, 1) };
        (0..count)
            .map(|i| {
                let values = self.number.strided(self.bytes, self.big_endian, i * next, step, length);
                let name = if count == 1 { name.to_owned() } else { naming.name(name, i, by_row) };
                column(name, None, values)
            })
            .collect()
    }
}

/// Adds the columns of a matrix of which the file keeps what is not zero: row, column and number of each, counted from 0.
fn sparse(
    name: &str,
    [rows, columns]: [usize; 2],
    kept: impl Iterator<Item = Option<(usize, usize, f64)>>,
    table: &mut TableBuilder,
) -> Result<(), Error> {
    let mut dense = vec![0.0_f64; table.take(&[rows, columns])?];
    for number in kept {
        let place = number.filter(|(row, column, _)| *row < rows && *column < columns);
        let (row, column, number) = place.ok_or_else(|| {
            refuse(format!("{name:?} is sparse, and has a number beyond its size; the file is damaged"))
        })?;
        dense[column * rows + row] = number;
    }
    if dense.is_empty() {
        table.leave_out(name, "empty");
        return Ok(());
    }
    let group = name.rsplit_once(['.', '/']).map_or("", |(group, _)| group);
    let bytes: Vec<u8> = dense.into_iter().flat_map(f64::to_le_bytes).collect();
    let matrix =
        Matrix { rows, columns, column_by_column: true, bytes: &bytes, number: Number::F64, big_endian: false };
    table.extend(group, matrix.split(name, Naming::Matlab));
    Ok(())
}

/// The numbers of a sparse matrix that is kept column by column: the row of each, and where in these each column begins.
fn by_column<'a>(
    rows: &'a [i64],
    starts: &'a [i64],
    numbers: &'a Values,
) -> impl Iterator<Item = Option<(usize, usize, f64)>> {
    let whole = |number: i64| usize::try_from(number).unwrap_or(usize::MAX);
    let of_column = move |(column, ends): (usize, &[i64])| {
        let row = move |i| rows.get(i).filter(|_| i < numbers.len()).map(|row| (whole(*row), column, numbers.float(i)));
        (whole(ends[0])..whole(ends[1])).map(row)
    };
    starts.windows(2).enumerate().flat_map(of_column)
}

/// Seconds between samples, by the name and the value of a number beside the columns: `fs` or `sample_rate` in Hz, `dt`
/// or `sample_interval` in s. The names are those of scripts and loggers, without regard to case and separators.
fn interval_s(name: &str, value: f64) -> Option<f64> {
    const RATES: &str = "\
        fs samplerate samplingrate samplefrequency samplingfrequency samplefreq samplingfreq samplespersecond \
        sampleratehz";
    const INTERVALS: &str = "\
        dt deltat ts sampleinterval samplinginterval sampleperiod samplingperiod sampletime timestep wfincrement";
    let name: String =
        name.chars().filter(char::is_ascii_alphanumeric).map(|letter| letter.to_ascii_lowercase()).collect();
    let interval = if lists(RATES, &name) {
        1.0 / value
    } else if lists(INTERVALS, &name) {
        value
    } else {
        return None;
    };
    (interval.is_finite() && interval > 0.0).then_some(interval)
}

/// A time between samples beside one that was told before in the same place: NaN where they contradict each other.
fn agreed(before: Option<f64>, interval_s: f64) -> f64 {
    before.map_or(interval_s, |before| if (before / interval_s - 1.0).abs() <= 1e-3 { interval_s } else { f64::NAN })
}
