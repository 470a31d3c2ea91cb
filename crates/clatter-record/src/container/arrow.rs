//! Arrow: messages in flatbuffers, each with a body of buffers; a file is a stream between two frames.
//!
//! Source: Arrow Columnar Format 1.5, "Serialization and Interprocess Communication". The flatbuffers are read by a
//! crate; the buffers are plain arrays and read here, within bounds.

mod schema;

pub(super) use schema::{schema_message, units};

use super::bytes::Bytes;
use super::{TableBuilder, codec, refuse};
use crate::Error;
use polars_arrow_format::ipc::planus::ReadAsRoot;
use polars_arrow_format::ipc::{self, CompressionType, MessageHeaderRef, MessageRef, RecordBatchRef};
use schema::{Field, Schema};

const MAGIC: &[u8] = b"ARROW1\0\0";
const CONTINUES: u32 = u32::MAX;

pub(super) fn read(bytes: &[u8], table: &mut TableBuilder) -> Result<(), Error> {
    let is_file = bytes.starts_with(b"ARROW1");
    let mut bytes = Bytes::new(bytes, "Arrow file");
    if is_file {
        // The footer repeats where the messages are; they stand in turn.
        bytes.take(MAGIC.len())?;
    }
    let mut schema: Option<Schema> = None;
    // A stream may end without a mark.
    while is_file || bytes.left() > 0 {
        let Some(message) = next_message(&mut bytes)? else { break };
        let length = message.body_length().map_err(damaged)?;
        let body = bytes.take_u64(u64::try_from(length).unwrap_or(u64::MAX))?;
        match (message.header().map_err(damaged)?, &schema) {
            (Some(MessageHeaderRef::Schema(found)), None) => {
                let found = Schema::read(found)?;
                table.extend("", found.fields.iter().filter_map(Field::empty_column));
                schema = Some(found);
            }
            (Some(MessageHeaderRef::RecordBatch(batch)), Some(schema)) => {
                Batch::read(batch, body)?.append(schema, table)?;
            }
            // Dictionaries hold text.
            (Some(MessageHeaderRef::DictionaryBatch(_)), Some(_)) => {}
            _ => return Err(refuse("Arrow file: a message is not where it should be; the file is damaged")),
        }
    }
    Ok(())
}

fn damaged(error: ipc::planus::Error) -> Error {
    refuse(format!("Arrow file: a message is damaged: {error}"))
}

/// The next message; none at the mark of the end.
fn next_message<'a>(bytes: &mut Bytes<'a>) -> Result<Option<MessageRef<'a>>, Error> {
    let mut length = bytes.u32()?;
    // Before version 0.15 there was no mark in front of the length.
    if length == CONTINUES {
        length = bytes.u32()?;
    }
    if length == 0 {
        return Ok(None);
    }
    MessageRef::read_as_root(bytes.take_u64(length.into())?).map(Some).map_err(damaged)
}

/// The rows of one message.
#[derive(Debug)]
struct Batch<'a> {
    rows: usize,
    /// Offset and length of each buffer in the body.
    buffers: Vec<[i64; 2]>,
    /// Buffers of each column of views, in turn.
    variadic: Vec<i64>,
    compression: Option<CompressionType>,
    body: &'a [u8],
}

impl<'a> Batch<'a> {
    fn read(batch: RecordBatchRef<'_>, body: &'a [u8]) -> Result<Self, Error> {
        let rows = batch.length().map_err(damaged)?;
        let rows = usize::try_from(rows).map_err(|_| refuse(format!("Arrow file: {rows} is no number of rows")))?;
        let buffers = batch.buffers().map_err(damaged)?;
        let buffers = buffers.into_iter().flatten().map(|buffer| [buffer.offset(), buffer.length()]).collect();
        let variadic = batch.variadic_buffer_counts().map_err(damaged)?.into_iter().flatten().collect();
        let compression = batch.compression().map_err(damaged)?;
        let compression = compression.map(|compression| compression.codec().map_err(damaged)).transpose()?;
        Ok(Self { rows, buffers, variadic, compression, body })
    }

    /// Adds its rows to the columns of numbers.
    fn append(&self, schema: &Schema, table: &mut TableBuilder) -> Result<(), Error> {
        let mut buffers = self.buffers.iter();
        let mut variadic = self.variadic.iter();
        let mut place = 0..table.table.columns.len();
        let missing = || refuse("Arrow file: a message has fewer buffers than its columns need; the file is damaged");
        for field in &schema.fields {
            if let Some(stored) = field.stored
                && let Some(place) = place.next()
            {
                let (valid, data) = (buffers.next().ok_or_else(missing)?, buffers.next().ok_or_else(missing)?);
                table.take(&[self.rows])?;
                let valid = self.buffer(*valid, self.rows.div_ceil(8), &field.name)?;
                let most = self.rows.checked_mul(stored.width()).ok_or_else(missing)?;
                let data = self.buffer(*data, most, &field.name)?;
                let data = data.get(..most).ok_or_else(|| {
                    refuse(format!(
                        "Arrow file: column {:?} has {} bytes for {} rows; the file is damaged",
                        field.name,
                        data.len(),
                        self.rows
                    ))
                })?;
                let is_valid =
                    |row: usize| valid.is_empty() || valid.get(row / 8).is_some_and(|byte| byte >> (row % 8) & 1 == 1);
                let values = stored.values(data, schema.big_endian, is_valid, &field.name)?;
                table.table.columns[place].values.append(values);
            } else {
                let more = (0..field.variadic).try_fold(0, |sum: usize, _| {
                    variadic
                        .next()
                        .and_then(|count| usize::try_from(*count).ok())
                        .and_then(|count| sum.checked_add(count))
                });
                let count = more.and_then(|more| more.checked_add(field.buffers)).ok_or_else(missing)?;
                if count > 0 {
                    buffers.nth(count - 1).ok_or_else(missing)?;
                }
            }
        }
        Ok(())
    }

    /// A buffer, unpacked; one that holds more than `most` bytes is cut there, as buffers are filled up.
    fn buffer(&self, [offset, length]: [i64; 2], most: usize, name: &str) -> Result<std::borrow::Cow<'a, [u8]>, Error> {
        let beyond = || refuse(format!("Arrow file: column {name:?} lies beyond its message; the file is damaged"));
        let at = |place: i64| usize::try_from(place).map_err(|_| beyond());
        let (offset, length) = (at(offset)?, at(length)?);
        let bytes = offset.checked_add(length).and_then(|end| self.body.get(offset..end)).ok_or_else(beyond)?;
        let Some(compression) = self.compression.filter(|_| !bytes.is_empty()) else {
            return Ok(bytes[..bytes.len().min(most)].into());
        };
        let (told, packed) = bytes.split_first_chunk().ok_or_else(beyond)?;
        let told = i64::from_le_bytes(*told);
        // A buffer that would not get smaller stands as it is.
        if told == -1 {
            return Ok(packed[..packed.len().min(most)].into());
        }
        // Filled up to 64 bytes at most.
        let part = "Arrow file";
        let unpacked = match compression {
            CompressionType::Lz4Frame => codec::lz4_frame(packed, most.saturating_add(64), part)?,
            CompressionType::Zstd => codec::zstd(packed, most.saturating_add(64), part)?,
        };
        Ok(unpacked.into())
    }
}
