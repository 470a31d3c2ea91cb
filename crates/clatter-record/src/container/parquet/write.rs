//! Parquet files of numbers, without compression.

use super::pages::checksum;
use super::{ARROW_SCHEMA, MAGIC, damaged};
use crate::container::{arrow, equal_length, refuse};
use crate::{Error, Field, FieldKind};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use polars_parquet_format::thrift::protocol::TCompactOutputProtocol;
use polars_parquet_format::{
    ColumnChunk, ColumnMetaData, CompressionCodec, DataPageHeader, Encoding, FieldRepetitionType, FileMetaData,
    KeyValue, PageHeader, PageType, RowGroup, SchemaElement, Type,
};
use std::io::{self, Write};

/// Numbers of a page: 1 MiB, as the documentation of the format recommends.
const PAGE: usize = 1 << 17;

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
    equal_length(&values)?;
    let field = |column: &Series<'_>| Field {
        name: format!("{} [{}]", column.name, column.unit),
        unit: column.unit.to_owned(),
        kind: FieldKind::Float,
    };
    let fields: Vec<Field> = columns.iter().map(field).collect();
    let mut names: Vec<&str> = fields.iter().map(|field| field.name.as_str()).collect();
    names.sort_unstable();
    if let Some([name, ..]) = names.windows(2).find(|pair| pair[0] == pair[1]) {
        return Err(refuse(format!("two columns are named {name:?}; each needs a name of its own")));
    }
    let mut file = Vec::new();
    let mut writer = RowGroupWriter::begin(&mut file, fields, false).map_err(damaged)?;
    writer.write(&values).map_err(damaged)?;
    writer.finish(&[]).map_err(damaged)?;
    Ok(file)
}

/// Writes a Parquet file row group by row group: no more of it is in memory than one of them.
///
/// Numbers are stored to the bit and pages have checksums. What is written is read again by [`RowGroups`](super::RowGroups).
///
/// # Examples
/// ```
/// use clatter_record::{Field, FieldKind, RowGroupWriter, RowGroups};
/// let field = |name: &str, unit: &str, kind| Field { name: name.to_owned(), unit: unit.to_owned(), kind };
/// let fields = vec![field("tilt_rad", "rad", FieldKind::Float), field("held", "", FieldKind::Flag)];
/// let mut writer = RowGroupWriter::new(Vec::new(), fields)?;
/// writer.write(&[&[0.01, 0.02], &[1.0, 0.0]])?;
/// writer.write(&[&[0.03], &[1.0]])?;
/// let file = writer.finish(&[("seed", "7")])?;
/// let mut groups = RowGroups::new(std::io::Cursor::new(file))?;
/// assert_eq!((groups.rows(), groups.note("seed")), (&[2, 1][..], Some("7")));
/// assert_eq!(groups.read(1, 0)?, [0.03]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct RowGroupWriter<W> {
    out: W,
    /// Bytes written.
    at: i64,
    fields: Vec<Field>,
    has_checksums: bool,
    groups: Vec<RowGroup>,
    rows: i64,
}

impl<W: Write> RowGroupWriter<W> {
    /// Begins a file with these columns.
    ///
    /// # Errors
    /// An error of the writer.
    pub fn new(out: W, fields: Vec<Field>) -> io::Result<Self> {
        Self::begin(out, fields, true)
    }

    fn begin(mut out: W, fields: Vec<Field>, has_checksums: bool) -> io::Result<Self> {
        out.write_all(MAGIC)?;
        Ok(Self { out, at: whole(MAGIC.len())?, fields, has_checksums, groups: Vec::new(), rows: 0 })
    }

    /// Writes a group of rows, column by column.
    ///
    /// # Errors
    /// An error of the writer, or one where the columns are not those of the file or differ in length.
    pub fn write(&mut self, columns: &[&[f64]]) -> io::Result<()> {
        let rows = equal_length(columns).map_err(io::Error::other)?;
        if columns.len() != self.fields.len() {
            return Err(io::Error::other(format!("{} columns of {}", columns.len(), self.fields.len())));
        }
        let (rows, begin) = (whole(rows)?, self.at);
        let mut chunks = Vec::with_capacity(columns.len());
        for (i, values) in columns.iter().enumerate() {
            let start = self.at;
            for values in values.chunks(PAGE) {
                let page = page(self.fields[i].kind, values, self.has_checksums)?;
                self.out.write_all(&page)?;
                self.at += whole(page.len())?;
            }
            chunks.push(chunk(&self.fields[i], [rows, start, self.at - start]));
        }
        let bytes = self.at - begin;
        let number = i16::try_from(self.groups.len()).ok();
        self.groups.push(RowGroup::new(chunks, bytes, rows, None, begin, bytes, number));
        self.rows += rows;
        Ok(())
    }

    /// Ends the file, with notes about it by their names.
    ///
    /// # Errors
    /// An error of the writer.
    pub fn finish(mut self, notes: &[(&str, &str)]) -> io::Result<W> {
        let arrow = STANDARD.encode(arrow::schema_message(&self.fields));
        let mut entries = vec![KeyValue::new(ARROW_SCHEMA.to_owned(), arrow)];
        entries.extend(notes.iter().map(|(name, note)| KeyValue::new((*name).to_owned(), (*note).to_owned())));
        let count = i32::try_from(self.fields.len()).map_err(io::Error::other)?;
        let mut schema = vec![root(count)];
        schema.extend(self.fields.iter().map(element));
        let program = concat!("clatter version ", env!("CARGO_PKG_VERSION")).to_owned();
        let metadata = FileMetaData::new(2, schema, self.rows, self.groups, entries, program, None, None, None);
        let mut end = Vec::new();
        metadata.write_to_out_protocol(&mut TCompactOutputProtocol::new(&mut end)).map_err(io::Error::other)?;
        let length = u32::try_from(end.len()).map_err(io::Error::other)?;
        end.extend_from_slice(&length.to_le_bytes());
        end.extend_from_slice(MAGIC);
        self.out.write_all(&end)?;
        Ok(self.out)
    }
}

fn whole(number: usize) -> io::Result<i64> {
    i64::try_from(number).map_err(io::Error::other)
}

/// A page: its head, then the numbers.
fn page(kind: FieldKind, values: &[f64], has_checksum: bool) -> io::Result<Vec<u8>> {
    let mut body = Vec::with_capacity(8 * values.len());
    match kind {
        FieldKind::Float => body.extend(values.iter().flat_map(|value| value.to_le_bytes())),
        FieldKind::FloatOrNone => {
            let there = levels(values);
            body.extend(u32::try_from(there.len()).map_err(io::Error::other)?.to_le_bytes());
            body.extend(there);
            body.extend(values.iter().filter(|value| !value.is_nan()).flat_map(|value| value.to_le_bytes()));
        }
        #[expect(clippy::cast_possible_truncation, reason = "whole and within 2^53")]
        FieldKind::Whole => body.extend(values.iter().flat_map(|value| (*value as i64).to_le_bytes())),
        FieldKind::Flag => body.extend(packed(values, |value| value != 0.0)),
    }
    let size = i32::try_from(body.len()).map_err(io::Error::other)?;
    let count = i32::try_from(values.len()).map_err(io::Error::other)?;
    let data = DataPageHeader::new(count, Encoding::PLAIN, Encoding::RLE, Encoding::RLE, None);
    let sum = has_checksum.then(|| checksum(&body).cast_signed());
    let head = PageHeader::new(PageType::DATA_PAGE, size, size, sum, data, None, None, None);
    let mut page = Vec::with_capacity(64 + body.len());
    head.write_to_out_protocol(&mut TCompactOutputProtocol::new(&mut page)).map_err(io::Error::other)?;
    page.append(&mut body);
    Ok(page)
}

/// Which numbers are there: one run where all are, else groups of eight.
fn levels(values: &[f64]) -> Vec<u8> {
    let all = !values.iter().any(|value| value.is_nan());
    let mut head = if all { 2 * values.len() } else { 2 * values.len().div_ceil(8) + 1 };
    let mut bytes = Vec::new();
    while head >= 0x80 {
        bytes.push(head.to_le_bytes()[0] | 0x80);
        head >>= 7;
    }
    bytes.push(head.to_le_bytes()[0]);
    if all {
        bytes.push(1);
    } else {
        bytes.extend(packed(values, |value| !value.is_nan()));
    }
    bytes
}

/// Flags, eight a byte, the first in the last bit.
fn packed(values: &[f64], flag: impl Fn(f64) -> bool) -> impl Iterator<Item = u8> {
    values.chunks(8).map(move |eight| eight.iter().rev().fold(0, |bits, value| bits << 1 | u8::from(flag(*value))))
}

fn stored(kind: FieldKind) -> Type {
    match kind {
        FieldKind::Float | FieldKind::FloatOrNone => Type::DOUBLE,
        FieldKind::Whole => Type::INT64,
        FieldKind::Flag => Type::BOOLEAN,
    }
}

/// Where the pages of a column are.
fn chunk(field: &Field, [rows, start, size]: [i64; 3]) -> ColumnChunk {
    let with_levels = field.kind == FieldKind::FloatOrNone;
    let encodings = if with_levels { vec![Encoding::PLAIN, Encoding::RLE] } else { vec![Encoding::PLAIN] };
    let (path, codec) = (vec![field.name.clone()], CompressionCodec::UNCOMPRESSED);
    let kind = stored(field.kind);
    let metadata = ColumnMetaData::new(
        kind, encodings, path, codec, rows, size, size, None, start, None, None, None, None, None, None, None,
    );
    ColumnChunk::new(None, start, metadata, None, None, None, None, None, None)
}

/// The root of the schema, with so many children.
fn root(children: i32) -> SchemaElement {
    let field = Field { name: "schema".to_owned(), unit: String::new(), kind: FieldKind::Float };
    SchemaElement { type_: None, repetition_type: None, num_children: Some(children), ..element(&field) }
}

/// A column in the schema.
fn element(field: &Field) -> SchemaElement {
    let may_be_missing = field.kind == FieldKind::FloatOrNone;
    let repetition = if may_be_missing { FieldRepetitionType::OPTIONAL } else { FieldRepetitionType::REQUIRED };
    let (kind, name) = (stored(field.kind), field.name.clone());
    SchemaElement::new(kind, None, repetition, name, None, None, None, None, None, None)
}
