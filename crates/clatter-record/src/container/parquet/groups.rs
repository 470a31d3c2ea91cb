//! Parquet files read row group by row group: files that are larger than memory.

use super::{ARROW_SCHEMA, Kept, Leaf, damaged, leaves, metadata, pages};
use crate::container::refuse;
use crate::{Error, Values};
use polars_parquet_format::{FileMetaData, Type};
use std::io::{Read, Seek, SeekFrom};

/// A Parquet file that [`RowGroupWriter`](super::RowGroupWriter) wrote, read one column of one row group at a time.
#[derive(Debug)]
pub struct RowGroups<R> {
    input: R,
    length: u64,
    metadata: FileMetaData,
    names: Vec<String>,
    rows: Vec<usize>,
}

/// Rows of a group that are read together at most.
const MOST_ROWS: usize = 1 << 20;
/// The length of the metadata and the four letters stand behind them.
const END: u64 = 8;
/// Metadata of more bytes are none.
const MOST_METADATA: u64 = 1 << 28;

impl<R: Read + Seek> RowGroups<R> {
    /// Reads what a file says of itself.
    ///
    /// # Errors
    /// [`Error::File`] where it is cut short, damaged, or has groups of more than 2²⁰ rows.
    pub fn new(mut input: R) -> Result<Self, Error> {
        let length = input.seek(SeekFrom::End(0)).map_err(damaged)?;
        let end = bytes_at(&mut input, length, length.saturating_sub(END), END.min(length))?;
        let told = end.first_chunk().map_or(0, |told| u64::from(u32::from_le_bytes(*told)));
        // The start is as far back as the end tells; whether both make sense is for the reader of the metadata.
        let size = (told.min(MOST_METADATA) + END).min(length);
        let metadata = metadata(&bytes_at(&mut input, length, length - size, size)?)?;
        let names = leaves(&metadata.schema)?.into_iter().map(|leaf| leaf.path).collect();
        let rows = metadata.row_groups.iter().map(|group| {
            let rows = usize::try_from(group.num_rows).ok().filter(|rows| *rows <= MOST_ROWS);
            rows.ok_or_else(|| {
                refuse(format!("Parquet file: a row group of {} rows, at most {MOST_ROWS} are read", group.num_rows))
            })
        });
        let rows = rows.collect::<Result<_, _>>()?;
        Ok(Self { input, length, metadata, names, rows })
    }

    /// The columns by name, in the order of the file.
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Rows of each group.
    #[must_use]
    pub fn rows(&self) -> &[usize] {
        &self.rows
    }

    /// Returns what the file says of itself by this name.
    #[must_use]
    pub fn note(&self, name: &str) -> Option<&str> {
        let entries = self.metadata.key_value_metadata.as_deref().unwrap_or_default();
        let entry = entries.iter().find(|entry| entry.key == name && entry.key != ARROW_SCHEMA)?;
        entry.value.as_deref()
    }

    /// The numbers of a column in a group: NaN where there is none, 0 and 1 of flags.
    ///
    /// # Errors
    /// [`Error::File`] where there is no such column or group, it holds no numbers, or its bytes are damaged.
    pub fn read(&mut self, group: usize, column: usize) -> Result<Vec<f64>, Error> {
        let missing = || refuse(format!("Parquet file: no column {column} in row group {group}"));
        let leaves = leaves(&self.metadata.schema)?;
        let leaf: &Leaf<'_> = leaves.get(column).ok_or_else(missing)?;
        let rows = *self.rows.get(group).ok_or_else(missing)?;
        let chunk = self.metadata.row_groups[group].columns.get(column).and_then(|chunk| chunk.meta_data.as_ref());
        let mut chunk = chunk.ok_or_else(missing)?.clone();
        let place = u64::try_from(chunk.data_page_offset).ok().zip(u64::try_from(chunk.total_compressed_size).ok());
        let (start, size) = place.filter(|_| chunk.dictionary_page_offset.is_none()).ok_or_else(missing)?;
        let bytes = bytes_at(&mut self.input, self.length, start, size)?;
        chunk.data_page_offset = 0;
        let kept = if leaf.element.type_ == Some(Type::BOOLEAN) { Ok(Kept::Flags) } else { leaf.kept() };
        let fault = |fault| damaged(format!("column {:?} {fault}", leaf.path));
        let kept = kept.map_err(|what| fault(format!("holds no numbers, but is {what}")))?;
        let shape = pages::Shape { rows, kept, levels: leaf.levels };
        match pages::read(&bytes, &chunk, shape).map_err(fault)?.values(kept.stored(), &leaf.path)? {
            Values::Float(values) if values.len() == rows => Ok(values),
            _ => Err(damaged(format!("column {:?} has numbers that no float holds", leaf.path))),
        }
    }
}

/// So many bytes of a file from one on; memory is taken for what is there alone.
fn bytes_at<R: Read + Seek>(input: &mut R, length: u64, start: u64, size: u64) -> Result<Vec<u8>, Error> {
    if start.checked_add(size).is_none_or(|end| end > length) {
        return Err(damaged("a column lies beyond the file; the file is damaged"));
    }
    input.seek(SeekFrom::Start(start)).map_err(damaged)?;
    let mut bytes = Vec::new();
    input.take(size).read_to_end(&mut bytes).map_err(damaged)?;
    Ok(bytes)
}
