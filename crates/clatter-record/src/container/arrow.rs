//! Arrow: messages in flatbuffers, each with a body of buffers; a file is a stream between two frames.
//!
//! Source: Arrow Columnar Format 1.5, "Serialization and Interprocess Communication". The flatbuffers are read by a
//! crate; the buffers are plain arrays and read here, within bounds.

mod schema;

pub(super) use schema::{ArrowTime, schema_message, told};

use super::bytes::Bytes;
use super::number::{Number, number};
use super::stored::looked_up;
use super::{TableBuilder, codec, refuse};
use crate::{Error, Values};
use polars_arrow_format::ipc::planus::ReadAsRoot;
use polars_arrow_format::ipc::{self, CompressionType, MessageHeaderRef, MessageRef, RecordBatchRef};
use schema::{Field, Kept, Schema};
use std::borrow::Cow;
use std::collections::HashMap;

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
    let mut dictionaries = HashMap::new();
    // A stream may end without a mark.
    while is_file || bytes.left() > 0 {
        let Some(message) = next_message(&mut bytes)? else { break };
        let length = message.body_length().map_err(damaged)?;
        let body = bytes.take_u64(u64::try_from(length).unwrap_or(u64::MAX))?;
        match (message.header().map_err(damaged)?, &mut schema) {
            (Some(MessageHeaderRef::Schema(found)), None) => schema = Some(Schema::read(found)?),
            (Some(MessageHeaderRef::RecordBatch(batch)), Some(schema)) => {
                let batch = Batch::read(batch, body, schema.big_endian)?;
                batch.append(&mut schema.fields, &mut Vec::new(), &mut batch.turn(), &dictionaries, table)?;
            }
            (Some(MessageHeaderRef::DictionaryBatch(batch)), Some(schema)) => {
                let (id, data) = (batch.id().map_err(damaged)?, batch.data().map_err(damaged)?);
                // None of those that lie in lists is read.
                if let (Some(data), Some(field)) = (data, with_dictionary(&schema.fields, id)) {
                    let data = Batch::read(data, body, schema.big_endian)?;
                    let more = data.column(field, &[], &mut data.turn(), table)?;
                    match (dictionaries.get_mut(&id), more) {
                        (Some(Ok(before)), Ok(more)) if batch.is_delta().map_err(damaged)? => {
                            before.append(more);
                        }
                        (_, more) => {
                            dictionaries.insert(id, more);
                        }
                    }
                }
            }
            _ => return Err(refuse("Arrow file: a message is not where it should be; the file is damaged")),
        }
    }
    for field in schema.into_iter().flat_map(|schema| schema.fields) {
        field.finish(table);
    }
    Ok(())
}

/// The column with numbers in this dictionary.
fn with_dictionary(fields: &[Field], id: i64) -> Option<&Field> {
    fields.iter().find_map(|field| match &field.kept {
        Kept::Structure(fields) => with_dictionary(fields, id),
        Kept::Nothing => None,
        _ => Some(field).filter(|field| field.dictionary.is_some_and(|(known, _)| known == id)),
    })
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
    big_endian: bool,
    /// Offset and length of each buffer in the body.
    buffers: Vec<[i64; 2]>,
    /// Buffers of each column of views, in turn.
    variadic: Vec<i64>,
    compression: Option<CompressionType>,
    body: &'a [u8],
}

/// The buffers of a batch that are to come, and the numbers of those of views.
struct Turn<'b>(std::slice::Iter<'b, [i64; 2]>, std::slice::Iter<'b, i64>);

impl Turn<'_> {
    fn next(&mut self) -> Result<[i64; 2], Error> {
        self.0.next().copied().ok_or_else(missing)
    }
    /// Buffers of the next column of views.
    fn variadic(&mut self) -> Result<usize, Error> {
        self.1.next().and_then(|count| usize::try_from(*count).ok()).ok_or_else(missing)
    }
    /// Skips a column.
    fn skip(&mut self, field: &Field) -> Result<(), Error> {
        let mut count = field.buffers;
        for _ in 0..field.variadic {
            count = count.checked_add(self.variadic()?).ok_or_else(missing)?;
        }
        if count > 0 { self.0.nth(count - 1).map(|_| ()).ok_or_else(missing) } else { Ok(()) }
    }
}

fn missing() -> Error {
    refuse("Arrow file: a message has fewer buffers than its columns need; the file is damaged")
}

/// Which rows have a value, a bit for each; none where all have.
type Valid<'a> = Cow<'a, [u8]>;

fn is_valid(valid: &Valid<'_>, row: usize) -> bool {
    valid.is_empty() || valid.get(row / 8).is_some_and(|byte| byte >> (row % 8) & 1 == 1)
}

/// The numbers of dictionaries; else why they have none.
type Dictionaries = HashMap<i64, Result<Values, String>>;

impl<'a> Batch<'a> {
    fn read(batch: RecordBatchRef<'_>, body: &'a [u8], big_endian: bool) -> Result<Self, Error> {
        let rows = batch.length().map_err(damaged)?;
        let rows = usize::try_from(rows).map_err(|_| refuse(format!("Arrow file: {rows} is no number of rows")))?;
        let buffers = batch.buffers().map_err(damaged)?;
        let buffers = buffers.into_iter().flatten().map(|buffer| [buffer.offset(), buffer.length()]).collect();
        let variadic = batch.variadic_buffer_counts().map_err(damaged)?.into_iter().flatten().collect();
        let compression = batch.compression().map_err(damaged)?;
        let compression = compression.map(|compression| compression.codec().map_err(damaged)).transpose()?;
        Ok(Self { rows, big_endian, buffers, variadic, compression, body })
    }

    fn turn(&self) -> Turn<'_> {
        Turn(self.buffers.iter(), self.variadic.iter())
    }

    /// Adds its rows to the columns of numbers, which may lie in structures.
    fn append(
        &self,
        fields: &mut [Field],
        above: &mut Vec<Valid<'a>>,
        turn: &mut Turn<'_>,
        dictionaries: &Dictionaries,
        table: &mut TableBuilder,
    ) -> Result<(), Error> {
        for field in fields {
            if let Kept::Structure(fields) = &mut field.kept {
                above.push(self.buffer(turn.next()?, self.rows.div_ceil(8), &field.name)?);
                self.append(fields, above, turn, dictionaries, table)?;
                above.pop();
                continue;
            }
            if field.values.is_err() {
                turn.skip(field)?;
                continue;
            }
            let found = match field.dictionary {
                Some((id, places)) => self.places(field, places, dictionaries.get(&id), above, turn, table)?,
                None => self.column(field, above, turn, table)?,
            };
            match (&mut field.values, found) {
                (Ok(values), Ok(found)) => values.append(found),
                (values, Err(reason)) => {
                    table.left += self.rows + values.as_ref().map_or(0, Values::len);
                    *values = Err(reason);
                }
                (Err(_), _) => {}
            }
        }
        Ok(())
    }

    /// The numbers of a dictionary at the places that stand here.
    fn places(
        &self,
        field: &Field,
        places: Number,
        dictionary: Option<&Result<Values, String>>,
        above: &[Valid<'a>],
        turn: &mut Turn<'_>,
        table: &mut TableBuilder,
    ) -> Result<Result<Values, String>, Error> {
        let name = &field.name;
        table.take(&[self.rows])?;
        let valid = self.buffer(turn.next()?, self.rows.div_ceil(8), name)?;
        let places = places.values(&self.data(turn.next()?, places.size(), name)?, self.big_endian);
        match dictionary {
            Some(Ok(dictionary)) => {
                let is_there = |row| is_valid(&valid, row) && above.iter().all(|above| is_valid(above, row));
                Ok(Ok(looked_up(dictionary, places, is_there, name)?))
            }
            Some(Err(reason)) => Ok(Err(reason.clone())),
            None => {
                Err(refuse(format!("Arrow file: column {name:?} has no dictionary before it; the file is damaged")))
            }
        }
    }

    /// The numbers of a column, or of the dictionary of one; within, why it has none, as text that is no number.
    fn column(
        &self,
        field: &Field,
        above: &[Valid<'a>],
        turn: &mut Turn<'_>,
        table: &mut TableBuilder,
    ) -> Result<Result<Values, String>, Error> {
        let (name, rows) = (&field.name, self.rows);
        table.take(&[rows])?;
        let valid = self.buffer(turn.next()?, rows.div_ceil(8), name)?;
        let is_there = |row| is_valid(&valid, row) && above.iter().all(|above| is_valid(above, row));
        let most = table.bytes();
        Ok(match field.kept {
            Kept::Stored(stored) => {
                let data = self.data(turn.next()?, stored.width(), name)?;
                Ok(stored.values(&data, self.big_endian, is_there, name)?)
            }
            Kept::Texts(end) => {
                let ends = self.buffer(turn.next()?, (rows + 1).saturating_mul(end.size()), name)?;
                let ends = end.values(&ends, self.big_endian).into_integers();
                let end = |row: usize| ends.get(row).and_then(|end| usize::try_from(*end).ok());
                match self.buffer(turn.next()?, most, name) {
                    Ok(data) => self.numbers(is_there, |row| data.get(end(row)?..end(row + 1)?)),
                    Err(error) => Err(format!("text; {error}")),
                }
            }
            Kept::Views => {
                let views = self.data(turn.next()?, 16, name)?;
                let places = (0..turn.variadic()?).map(|_| turn.next()).collect::<Result<Vec<_>, _>>()?;
                let mut left = most;
                let part = |place| {
                    let part = self.buffer(place, left, name)?;
                    left = left.saturating_sub(part.len());
                    Ok(part)
                };
                match places.into_iter().map(part).collect::<Result<Vec<_>, Error>>() {
                    Ok(parts) => {
                        self.numbers(is_there, |row| view(views.get(16 * row..16 * row + 16)?, self.big_endian, &parts))
                    }
                    Err(error) => Err(format!("text; {error}")),
                }
            }
            Kept::Structure(_) | Kept::Nothing => Err("of a type that is not known".to_owned()),
        })
    }

    /// The numbers of texts.
    fn numbers<'t>(
        &self,
        is_there: impl Fn(usize) -> bool,
        text: impl Fn(usize) -> Option<&'t [u8]>,
    ) -> Result<Values, String> {
        let number = |row| if is_there(row) { text(row).and_then(number) } else { Some(f64::NAN) };
        (0..self.rows).map(number).collect::<Option<_>>().map(Values::Float).ok_or_else(|| "text".to_owned())
    }

    /// The buffer of all rows, of so many bytes each.
    fn data(&self, place: [i64; 2], width: usize, name: &str) -> Result<Cow<'a, [u8]>, Error> {
        let most = self.rows.checked_mul(width).ok_or_else(missing)?;
        let data = self.buffer(place, most, name)?;
        if data.len() < most {
            return Err(refuse(format!(
                "Arrow file: column {name:?} has {} bytes for {} rows; the file is damaged",
                data.len(),
                self.rows
            )));
        }
        Ok(match data {
            Cow::Borrowed(data) => data[..most].into(),
            Cow::Owned(mut data) => {
                data.truncate(most);
                data.into()
            }
        })
    }

    /// A buffer, unpacked; one that holds more than `most` bytes is cut there, as buffers are filled up.
    fn buffer(&self, [offset, length]: [i64; 2], most: usize, name: &str) -> Result<Cow<'a, [u8]>, Error> {
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

/// The text of a view: its length, then itself, or its beginning, the number of a buffer and the place in it.
fn view<'v>(view: &'v [u8], big_endian: bool, parts: &'v [Cow<'_, [u8]>]) -> Option<&'v [u8]> {
    let words = Number::U32.values(view, big_endian).into_integers();
    let [length, _, part, at] = [0, 1, 2, 3].map(|i| words.get(i).and_then(|word| usize::try_from(*word).ok()));
    let length = length?;
    if length <= 12 { view.get(4..4 + length) } else { parts.get(part?)?.get(at?..at?.checked_add(length)?) }
}
