//! Parquet: columns in row groups, columns in pages, which are compressed one by one.
//!
//! Source: Apache Parquet format 2.12. The crate reads metadata and pages as they lie; pages are unpacked here, within
//! a bound, and by codecs that are Rust alone.

mod pages;

use super::{Room, arrow, column, joined, nulls, number, refuse};
use crate::{Column, Error, Values};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use pages::Pages;
use parquet::basic::{ConvertedType, LogicalType, TimeUnit, Type};
use parquet::column::reader::ColumnReaderImpl;
use parquet::data_type::{DataType, DoubleType, FloatType, Int32Type, Int64Type, Int96Type};
use parquet::file::metadata::{KeyValue, ParquetMetaData};
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::{ColumnDescPtr, Type as Schema};
use std::collections::HashMap;
use std::sync::Arc;

/// The key under which Arrow keeps its schema, with the units of the columns.
const ARROW_SCHEMA: &str = "ARROW:schema";

pub(super) fn read(bytes: &[u8], room: &mut Room) -> Result<Vec<Column>, Error> {
    let bytes = bytes::Bytes::copy_from_slice(bytes);
    let file = SerializedFileReader::new(bytes.clone()).map_err(damaged)?;
    let metadata = file.metadata();
    let units = units(metadata);
    let bytes = Arc::new(bytes);
    let schema = metadata.file_metadata().schema_descr();
    let mut columns = Vec::new();
    for (place, descr) in schema.columns().iter().enumerate() {
        let Some(stored) = stored(descr) else { continue };
        let name = descr.path().string();
        let unit = if stored.is_time() { Some("ns".to_owned()) } else { units.get(&name).cloned() };
        let mut values = Values::Float(Vec::new());
        for group in 0..metadata.num_row_groups() {
            let chunk = metadata.row_group(group).columns().get(place);
            let chunk =
                chunk.ok_or_else(|| refuse(format!("Parquet file: row group {group} lacks column {name:?}")))?;
            let rows = metadata.row_group(group).num_rows();
            let rows =
                usize::try_from(rows).map_err(|_| refuse(format!("Parquet file: {rows} is no number of rows")))?;
            room.take(rows)?;
            let part = stored.read(|| Pages::new(&bytes, chunk, rows, &name), descr, rows, &name)?;
            values = joined(values, part);
        }
        columns.push(column(name, unit, values));
    }
    Ok(columns)
}

fn damaged(error: impl std::fmt::Display) -> Error {
    refuse(format!("Parquet file: {error}"))
}

/// Units of the columns by name, as Arrow keeps them. They are no part of the numbers: damaged ones are none.
fn units(metadata: &ParquetMetaData) -> HashMap<String, String> {
    let entries = metadata.file_metadata().key_value_metadata().into_iter().flatten();
    let schema = entries.into_iter().find(|entry| entry.key == ARROW_SCHEMA).and_then(|entry| entry.value.as_ref());
    let message = schema.and_then(|schema| STANDARD.decode(schema).ok()).unwrap_or_default();
    arrow::units(&message).unwrap_or_default().into_iter().collect()
}

/// How the numbers of a column are stored.
#[derive(Debug, Clone, Copy)]
enum Stored {
    Double,
    Float,
    /// 32 bits, with a sign or without.
    Int32(bool),
    Int64(bool),
    /// Times in ticks of so many nanoseconds.
    Time(i64),
    /// Days and nanoseconds of the day, as old programs write times.
    Int96,
}

/// None for what holds no numbers: text, lists, decimals, dates.
fn stored(descr: &ColumnDescPtr) -> Option<Stored> {
    if descr.max_rep_level() > 0 {
        return None;
    }
    let integer = |signed: bool| match descr.physical_type() {
        Type::INT32 => Some(Stored::Int32(signed)),
        Type::INT64 => Some(Stored::Int64(signed)),
        _ => None,
    };
    match (descr.physical_type(), descr.logical_type_ref(), descr.converted_type()) {
        (Type::DOUBLE, ..) => Some(Stored::Double),
        (Type::FLOAT, ..) => Some(Stored::Float),
        (Type::INT96, ..) => Some(Stored::Int96),
        (Type::INT64, Some(LogicalType::Timestamp(stamp)), _) => Some(Stored::Time(match stamp.unit {
            TimeUnit::MILLIS => 1_000_000,
            TimeUnit::MICROS => 1000,
            TimeUnit::NANOS => 1,
        })),
        (Type::INT64, None, ConvertedType::TIMESTAMP_MILLIS) => Some(Stored::Time(1_000_000)),
        (Type::INT64, None, ConvertedType::TIMESTAMP_MICROS) => Some(Stored::Time(1000)),
        (_, Some(LogicalType::Integer(kind)), _) => integer(kind.is_signed),
        (_, Some(_), _) => None,
        (_, None, ConvertedType::UINT_8 | ConvertedType::UINT_16 | ConvertedType::UINT_32 | ConvertedType::UINT_64) => {
            integer(false)
        }
        (
            _,
            None,
            ConvertedType::NONE
            | ConvertedType::INT_8
            | ConvertedType::INT_16
            | ConvertedType::INT_32
            | ConvertedType::INT_64,
        ) => integer(true),
        _ => None,
    }
}

impl Stored {
    fn is_time(self) -> bool {
        matches!(self, Self::Time(_) | Self::Int96)
    }
    /// The numbers of one row group.
    fn read(
        self,
        pages: impl FnOnce() -> Result<Pages, Error>,
        descr: &ColumnDescPtr,
        rows: usize,
        name: &str,
    ) -> Result<Values, Error> {
        let pages = pages()?;
        macro_rules! read {
            ($kind:ty) => {
                rows_of::<$kind>(pages, descr, rows, name)?
            };
        }
        let floats = |(values, valid): (Vec<f64>, Vec<bool>)| Ok(Values::Float(spread(values, &valid, f64::NAN)));
        let integers = |values: Vec<i64>, valid: &[bool]| {
            let values = number::integers(spread(values, valid, 0));
            nulls::marked(values, |row| valid.get(row).copied().unwrap_or(true), name)
        };
        match self {
            Self::Double => floats(read!(DoubleType)),
            Self::Float => {
                let (values, valid) = read!(FloatType);
                floats((values.into_iter().map(f64::from).collect(), valid))
            }
            Self::Int32(signed) => {
                let (values, valid) = read!(Int32Type);
                let wide = |value: i32| if signed { value.into() } else { value.cast_unsigned().into() };
                integers(values.into_iter().map(wide).collect(), &valid)
            }
            Self::Int64(signed) => {
                let (values, valid) = read!(Int64Type);
                if signed || values.iter().all(|value| *value >= 0) {
                    return integers(values, &valid);
                }
                #[expect(clippy::cast_precision_loss, reason = "beyond both kinds of values; within half an ulp")]
                floats((values.into_iter().map(|value| value.cast_unsigned() as f64).collect(), valid))
            }
            Self::Time(tick) => {
                let (values, valid) = read!(Int64Type);
                let is_valid = |row| valid.get(row).copied().unwrap_or(true);
                nulls::times(Values::Integer(spread(values, &valid, 0)), tick, is_valid, name).map(Values::Integer)
            }
            Self::Int96 => {
                let (values, valid) = read!(Int96Type);
                let values = values.iter().map(|value| day_and_time(value.data())).collect::<Option<Vec<i64>>>();
                let values =
                    values.ok_or_else(|| refuse(format!("column {name:?}: a time is beyond the year 2262")))?;
                let is_valid = |row| valid.get(row).copied().unwrap_or(true);
                nulls::times(Values::Integer(spread(values, &valid, 0)), 1, is_valid, name).map(Values::Integer)
            }
        }
    }
}

/// Nanoseconds since 1970 from nanoseconds of a day and the number of the day by Julius Scaliger.
fn day_and_time(words: &[u32]) -> Option<i64> {
    const DAY_OF_1970: i64 = 2_440_588;
    let &[low, high, day] = words else { return None };
    let time = (u64::from(high) << 32 | u64::from(low)).cast_signed();
    (i64::from(day) - DAY_OF_1970).checked_mul(86_400_000_000_000)?.checked_add(time)
}

/// Values that are there to the rows that have one.
fn spread<T: Copy>(values: Vec<T>, valid: &[bool], missing: T) -> Vec<T> {
    if valid.iter().all(|valid| *valid) {
        return values;
    }
    let mut values = values.into_iter();
    valid.iter().map(|valid| if *valid { values.next().unwrap_or(missing) } else { missing }).collect()
}

/// All values of a column in a row group, and which rows have one where some may not.
fn rows_of<T: DataType>(
    pages: Pages,
    descr: &ColumnDescPtr,
    rows: usize,
    name: &str,
) -> Result<(Vec<T::T>, Vec<bool>), Error> {
    let (mut values, mut levels) = (Vec::new(), Vec::new());
    let mut reader = ColumnReaderImpl::<T>::new(Arc::clone(descr), Box::new(pages));
    let optional = descr.max_def_level() > 0;
    let mut left = rows;
    while left > 0 {
        let (records, ..) =
            reader.read_records(left, optional.then_some(&mut levels), None, &mut values).map_err(damaged)?;
        if records == 0 {
            return Err(refuse(format!(
                "Parquet file: column {name:?} lacks {left} of {rows} rows; the file is damaged"
            )));
        }
        left = left.saturating_sub(records);
    }
    let valid: Vec<bool> = levels.iter().map(|level| *level == descr.max_def_level()).collect();
    let there = if optional { valid.iter().filter(|valid| **valid).count() } else { rows };
    if values.len() != there {
        return Err(refuse(format!("Parquet file: column {name:?} has {} values, not {there}", values.len())));
    }
    Ok((values, valid))
}

/// A column to write.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Series<'a> {
    /// Its name, without the unit.
    pub name: &'a str,
    /// Its unit, such as `m/s2`.
    pub unit: &'a str,
    /// Its numbers.
    pub values: &'a [f64],
}

/// The bytes of a Parquet file with these columns, as `name [unit]`; the unit stands in the metadata of each as well, as
/// Arrow has them.
///
/// The numbers are doubles, to the bit, without compression, in one row group.
///
/// # Errors
/// [`Error::File`] where columns differ in length, two have one name, or there are none.
///
/// # Examples
/// ```
/// use clatter_record::{Kind, Series, Values, read, write_parquet};
/// let file = write_parquet(&[
///     Series { name: "time", unit: "s", values: &[0.0, 0.001] },
///     Series { name: "ax", unit: "m/s2", values: &[0.0, -9.81] },
/// ])?;
/// let table = read(Kind::of(&file)?, &file, 4)?;
/// assert_eq!(table.columns[1].name, "ax [m/s2]");
/// assert_eq!(table.columns[1].unit.as_deref(), Some("m/s2"));
/// assert_eq!(table.columns[1].values, Values::Float(vec![0.0, -9.81]));
/// # Ok::<(), clatter_record::Error>(())
/// ```
pub fn write(columns: &[Series<'_>]) -> Result<Vec<u8>, Error> {
    let values: Vec<&[f64]> = columns.iter().map(|column| column.values).collect();
    super::equal_length(&values)?;
    let named: Vec<(String, &str)> =
        columns.iter().map(|column| (format!("{} [{}]", column.name, column.unit), column.unit)).collect();
    let mut names: Vec<&str> = named.iter().map(|column| column.0.as_str()).collect();
    names.sort_unstable();
    if let Some(pair) = names.windows(2).find(|pair| pair[0] == pair[1]) {
        return Err(refuse(format!("two columns are named {:?}; each needs a name of its own", pair[0])));
    }
    let field = |(name, _): &(String, _)| {
        let kind = Schema::primitive_type_builder(name, Type::DOUBLE);
        kind.with_repetition(parquet::basic::Repetition::REQUIRED).build().map(Arc::new)
    };
    let fields = named.iter().map(field).collect::<Result<_, _>>().map_err(damaged)?;
    let schema = Schema::group_type_builder("record").with_fields(fields).build().map_err(damaged)?;
    let arrow = KeyValue::new(ARROW_SCHEMA.to_owned(), STANDARD.encode(arrow::schema_message(&named)));
    let properties = WriterProperties::builder()
        .set_dictionary_enabled(false)
        .set_created_by("clatter".to_owned())
        .set_key_value_metadata(Some(vec![arrow]))
        .build();
    let mut writer = SerializedFileWriter::new(Vec::new(), Arc::new(schema), Arc::new(properties)).map_err(damaged)?;
    let mut group = writer.next_row_group().map_err(damaged)?;
    for values in values {
        let Some(mut column) = group.next_column().map_err(damaged)? else { break };
        column.typed::<DoubleType>().write_batch(values, None, None).map_err(damaged)?;
        column.close().map_err(damaged)?;
    }
    group.close().map_err(damaged)?;
    writer.into_inner().map_err(damaged)
}
