//! Parquet: columns in row groups, columns in pages, which are compressed one by one.
//!
//! Source: Apache Parquet format 2.11. Metadata and heads of pages are read by a crate; the pages of numbers are read
//! here, within bounds, and unpacked by codecs that are Rust alone.
//!
//! The crates `parquet` and `arrow-ipc` 60.1 were tried in place of this module and `arrow`. The tests of torn files
//! refuse them: a file from outside may end the program or take memory without bound. Arrow alone does not panic if its
//! buffers are checked first, but needs C and licenses that are not allowed as well.
//!
//! | | here | `parquet`, `arrow-ipc` |
//! |---|---|---|
//! | lines, with `stored` and `codec`; before text and dictionaries were read 1345 | 1815 | 525 |
//! | packages in Cargo.lock | 251 | 286 |
//! | processor time to build the crate from clean | 151 s | 470 s |
//! | panics in torn variants of each Parquet file of the tests | 0 of 2000 | up to 27 of 20 000 |
//! | memory for a page that tells a length | rows × (width + 8) B + 64 KiB | 2.1 GB for a file of 179 B |
//! | memory for 4 MB of gzip that hold 4 GiB | the same | 5.4 GB |
//! | Arrow buffer of LZ4 that tells 2⁶² bytes | refused | the program aborts |
//! | checksums of pages | written and checked | checked alone |
//! | Arrow in the order of big-endian machines | read | refused by its reader of files |
//! | Zstandard | Rust | C, which needs clang for `wasm32` |
//! | licenses | allowed | CC0-1.0 (`tiny-keccak`) is not |
//! | time to read 10⁶ rows of 3 columns: plain, Snappy, Zstandard, gzip, LZ4 | 1 | 0.98, 0.73, 0.28, 0.90, 0.22 |
//! | the same of Arrow: plain, LZ4, Zstandard | 1 | 1.61, 1.34, 0.36 |
//! | time to write, to read a shard of 10⁶ rows of 20 columns | 1, 1 | 0.72 without checksums, 0.30 |
//!
//! The page holds no reader of either kind. Times are medians of five pairs.

mod encoding;
mod groups;
mod pages;
mod write;

pub use groups::RowGroups;
pub use write::{RowGroupWriter, Series, write};

use super::arrow::ArrowTime;
use super::number::{HALF, Number};
use super::stored::Stored;
use super::{TableBuilder, arrow, refuse};
use crate::{Error, Values};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use polars_parquet_format::thrift::protocol::TCompactInputProtocol;
use polars_parquet_format::{
    ConvertedType, FieldRepetitionType, FileMetaData, KeyValue, LogicalType, SchemaElement, TimeUnit, Type,
};
use std::collections::HashMap;

const MAGIC: &[u8; 4] = b"PAR1";
/// The key under which Arrow keeps its schema, with the units of the columns.
const ARROW_SCHEMA: &str = "ARROW:schema";
/// Fields within fields.
const DEEPEST: usize = 32;

pub(super) fn read(bytes: &[u8], table: &mut TableBuilder) -> Result<(), Error> {
    let metadata = metadata(bytes)?;
    let told = told(metadata.key_value_metadata.as_deref().unwrap_or_default());
    for (place, leaf) in leaves(&metadata.schema)?.into_iter().enumerate() {
        let ArrowTime { unit, tick_ns } = told.get(&leaf.path).cloned().unwrap_or_default();
        let kept = match (leaf.kept(), tick_ns) {
            (Ok(Kept::Stored(Stored::Number(Number::I64))), Some(tick)) => {
                Ok(Kept::Stored(Stored::Time(Number::I64, tick)))
            }
            (kept, _) => kept,
        };
        let unit = kept.ok().and_then(Kept::unit).or(unit);
        let left = table.left;
        let values = match kept {
            Ok(kept) => column(bytes, &metadata, place, &leaf, kept, table)?,
            Err(reason) => Err(reason.to_owned()),
        };
        if values.is_err() {
            table.left = left;
        }
        table.add(&leaf.path, unit, values);
    }
    Ok(())
}

/// The numbers of a column in all row groups; within, why it has none, as text that is no number.
fn column(
    bytes: &[u8],
    metadata: &FileMetaData,
    place: usize,
    leaf: &Leaf<'_>,
    kept: Kept,
    table: &mut TableBuilder,
) -> Result<Result<Values, String>, Error> {
    let name = &leaf.path;
    let mut values = Values::Float(Vec::new());
    for group in &metadata.row_groups {
        let chunk = group.columns.get(place).and_then(|chunk| chunk.meta_data.as_ref());
        let chunk = chunk.ok_or_else(|| refuse(format!("Parquet file: a row group lacks column {name:?}")))?;
        let rows = group.num_rows;
        let rows = usize::try_from(rows).map_err(|_| refuse(format!("Parquet file: {rows} is no number of rows")))?;
        table.take(&[rows])?;
        let shape = pages::Shape { rows, kept, levels: leaf.levels };
        match (pages::read(bytes, chunk, shape), kept) {
            (Ok(rows), _) => values.append(rows.values(kept.stored(), name)?),
            (Err(fault), Kept::Texts(what)) if fault == pages::NO_NUMBER => return Ok(Err(what.to_owned())),
            (Err(fault), Kept::Texts(what)) => return Ok(Err(format!("{what} that {fault}"))),
            (Err(fault), _) => return Err(refuse(format!("Parquet file: column {name:?} {fault}"))),
        }
    }
    Ok(match (&values, kept) {
        (Values::Float(found), Kept::Texts(what)) if found.iter().all(|number| number.is_nan()) => Err(what.to_owned()),
        _ => Ok(values),
    })
}

fn damaged(error: impl std::fmt::Display) -> Error {
    refuse(format!("Parquet file: {error}"))
}

/// The metadata at the end of the file, before their length and four letters.
fn metadata(bytes: &[u8]) -> Result<FileMetaData, Error> {
    /// Lists and texts in it may take so much together. A list of so many entries would be beyond any record.
    const MOST: usize = 1 << 23;
    let cut = || refuse("Parquet file: it does not end with PAR1; the file is cut short or damaged");
    let (rest, magic) = bytes.split_last_chunk::<4>().ok_or_else(cut)?;
    if magic != MAGIC {
        return Err(cut());
    }
    let (rest, length) = rest.split_last_chunk::<4>().ok_or_else(cut)?;
    let length = u32::from_le_bytes(*length) as usize;
    let start = rest.len().checked_sub(length).ok_or_else(|| {
        refuse(format!("Parquet file: metadata of {length} bytes do not fit in it; the file is damaged"))
    })?;
    // An entry of a list is a byte at least, and counts as 8.
    let most = length.saturating_mul(8).min(MOST);
    FileMetaData::read_from_in_protocol(&mut TCompactInputProtocol::new(&rest[start..], most)).map_err(damaged)
}

/// What the schema of Arrow tells of the columns by name. It is no part of the numbers: a damaged one tells nothing.
fn told(entries: &[KeyValue]) -> HashMap<String, ArrowTime> {
    let schema = entries.iter().find(|entry| entry.key == ARROW_SCHEMA).and_then(|entry| entry.value.as_ref());
    let message = schema.and_then(|schema| STANDARD.decode(schema).ok()).unwrap_or_default();
    arrow::told(&message).unwrap_or_default()
}

/// How a column of the file is read.
#[derive(Debug, Clone, Copy)]
enum Kept {
    Stored(Stored),
    /// Flags, of which a plain page has eight in a byte.
    Flags,
    /// Bytes of any length, which may be the text of numbers; else what they are.
    Texts(&'static str),
    /// Whole numbers of any length, in tens to the power of minus the scale.
    Decimals(i32),
}

impl Kept {
    /// How its numbers come from the pages.
    fn stored(self) -> Stored {
        match self {
            Self::Stored(stored) => stored,
            Self::Flags => Stored::Number(Number::U8),
            Self::Texts(_) | Self::Decimals(_) => Stored::Number(Number::F64),
        }
    }
    fn unit(self) -> Option<String> {
        self.stored().unit()
    }
}

/// A column of the file: what the tree of the schema ends in.
#[derive(Debug)]
struct Leaf<'a> {
    /// Names from the top, with dots between.
    path: String,
    element: &'a SchemaElement,
    /// How many of the fields on the way may be missing: a value that is there has so many levels.
    levels: u32,
    /// Tells whether it is in a list.
    repeated: bool,
}

/// The columns in their order. The tree lies in the file depth first.
fn leaves(schema: &[SchemaElement]) -> Result<Vec<Leaf<'_>>, Error> {
    /// A branch with children that are still to come.
    struct Branch {
        left: i32,
        path: String,
        levels: u32,
        repeated: bool,
    }
    let Some((root, elements)) = schema.split_first() else { return Err(refuse("Parquet file: it has no schema")) };
    let mut branches =
        vec![Branch { left: root.num_children.unwrap_or(0), path: String::new(), levels: 0, repeated: false }];
    let mut leaves = Vec::new();
    for element in elements {
        while branches.last().is_some_and(|branch| branch.left <= 0) {
            branches.pop();
        }
        let depth = branches.len();
        let Some(branch) = branches.last_mut().filter(|_| depth <= DEEPEST) else {
            return Err(refuse(format!("Parquet file: its schema is damaged, or more than {DEEPEST} deep")));
        };
        branch.left -= 1;
        let name = &element.name;
        let path = if branch.path.is_empty() { name.clone() } else { format!("{}.{name}", branch.path) };
        let optional = element.repetition_type != Some(FieldRepetitionType::REQUIRED);
        let repeated = branch.repeated || element.repetition_type == Some(FieldRepetitionType::REPEATED);
        let levels = branch.levels + u32::from(optional);
        match element.num_children {
            Some(left) if element.type_.is_none() => branches.push(Branch { left, path, levels, repeated }),
            _ => leaves.push(Leaf { path, element, levels, repeated }),
        }
    }
    Ok(leaves)
}

impl Leaf<'_> {
    /// How its numbers are kept; else what it is.
    fn kept(&self) -> Result<Kept, &'static str> {
        let SchemaElement { logical_type: logical, converted_type: converted, .. } = self.element;
        let decimal = match logical {
            Some(LogicalType::DECIMAL(decimal)) => Some(decimal.scale),
            None if *converted == Some(ConvertedType::DECIMAL) => Some(self.element.scale.unwrap_or(0)),
            _ => None,
        };
        let time = |number, tick| Ok(Kept::Stored(Stored::Time(number, tick)));
        let number = |number| Ok(Kept::Stored(Stored::Number(number)));
        let whole = match self.element.type_ {
            _ if self.repeated => return Err("a list"),
            Some(Type::DOUBLE) => return number(Number::F64),
            Some(Type::FLOAT) => return number(Number::F32),
            Some(Type::INT96) => return Ok(Kept::Stored(Stored::Int96)),
            Some(Type::BOOLEAN) => return Err("truths"),
            Some(Type::INT64) => 8,
            Some(Type::INT32) => 4,
            Some(Type::BYTE_ARRAY) => {
                let text = matches!(logical, Some(LogicalType::STRING(_))) || *converted == Some(ConvertedType::UTF8);
                return Ok(decimal.map_or(Kept::Texts(if text { "text" } else { "bytes" }), Kept::Decimals));
            }
            Some(Type::FIXED_LEN_BYTE_ARRAY) => {
                let length = self.element.type_length.and_then(|length| u8::try_from(length).ok());
                return match (decimal, length, logical) {
                    (Some(scale), Some(bytes @ 1..=32), _) => {
                        number(Number::Decimal { bytes, scale, big_endian: true })
                    }
                    (None, Some(2), Some(LogicalType::FLOAT16(_))) => number(HALF),
                    _ => Err("bytes"),
                };
            }
            _ => return Err("of a type that is not known"),
        };
        let integer =
            |signed| Number::integer(whole.into(), signed).ok_or("of a type that is not known").and_then(number);
        let signed = Number::integer(whole.into(), true).unwrap_or(Number::I64);
        let unit = match logical {
            Some(LogicalType::TIMESTAMP(stamp)) => Some(&stamp.unit),
            Some(LogicalType::TIME(time)) => Some(&time.unit),
            _ => None,
        };
        match (logical, *converted) {
            _ if let Some(scale) = decimal => number(Number::Decimal { bytes: whole, scale, big_endian: false }),
            _ if let Some(unit) = unit => time(
                signed,
                match unit {
                    TimeUnit::MILLIS(_) => 1_000_000,
                    TimeUnit::MICROS(_) => 1000,
                    TimeUnit::NANOS(_) => 1,
                },
            ),
            (Some(LogicalType::DATE(_)), _) | (None, Some(ConvertedType::DATE)) => Err("dates"),
            (Some(LogicalType::UNKNOWN(_)), _) => Err("without values"),
            (Some(LogicalType::INTEGER(kind)), _) => integer(kind.is_signed),
            (None, Some(ConvertedType::TIMESTAMP_MILLIS | ConvertedType::TIME_MILLIS)) => time(signed, 1_000_000),
            (None, Some(ConvertedType::TIMESTAMP_MICROS | ConvertedType::TIME_MICROS)) => time(signed, 1000),
            (None, Some(kind)) if (ConvertedType::UINT_8.0..=ConvertedType::UINT_64.0).contains(&kind.0) => {
                integer(false)
            }
            (None, Some(kind)) if (ConvertedType::INT_8.0..=ConvertedType::INT_64.0).contains(&kind.0) => integer(true),
            (None, None) => integer(true),
            _ => Err("of a type that is not known"),
        }
    }
}
