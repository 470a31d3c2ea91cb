//! The pages of one column in one row group: unpacked, and its numbers as plain bytes.

use super::Kept;
use super::encoding::{Dictionary, delta, hybrid, plain_bits, plain_texts, split_streams};
use crate::container::codec;
use crate::container::number::{decimal, number};
use crate::container::stored::Stored;
use crate::{Error, Values};
use polars_parquet_format::thrift::protocol::TCompactInputProtocol;
use polars_parquet_format::{ColumnMetaData, CompressionCodec, Encoding, PageHeader, PageType};
use std::borrow::Cow;

/// The rows to read, as the schema tells of them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shape {
    pub(super) rows: usize,
    pub(super) kept: Kept,
    /// Levels of a value that is there.
    pub(super) levels: u32,
}

impl Shape {
    /// Bytes of a number.
    fn width(self) -> usize {
        self.kept.stored().width()
    }
    /// Bytes of any length as numbers; none where they are none.
    fn numbers<'a>(self, mut texts: impl Iterator<Item = Option<&'a [u8]>>) -> Result<Vec<u8>, Fault> {
        texts.try_fold(Vec::new(), |mut bytes, text| {
            let text = text.ok_or(CUT)?;
            let number = match self.kept {
                Kept::Decimals(scale) => (text.len() <= 32).then(|| decimal(text, scale, true)),
                _ => number(text),
            };
            let number = number.ok_or(NO_NUMBER)?;
            bytes.extend(number.to_le_bytes());
            Ok(bytes)
        })
    }
}

/// Numbers as the plain encoding has them, one for each row; zeros where there is none.
#[derive(Debug, Default)]
pub(super) struct Rows {
    pub(super) bytes: Vec<u8>,
    /// Which rows have a number; empty where all have to.
    pub(super) valid: Vec<bool>,
}

impl Rows {
    /// As the values of a column.
    pub(super) fn values(&self, stored: Stored, name: &str) -> Result<Values, Error> {
        stored.values(&self.bytes, false, |row| self.valid.is_empty() || self.valid.get(row) == Some(&true), name)
    }
}

/// All rows of a column in a row group.
pub(super) fn read(bytes: &[u8], chunk: &ColumnMetaData, shape: Shape) -> Result<Rows, Fault> {
    Chunk { told: chunk, shape, dictionary: None, rows: Rows::default(), left: shape.rows }.read(bytes)
}

/// The checksum of a page, as zlib's.
pub(super) fn checksum(page: &[u8]) -> u32 {
    let mut sum = flate2::Crc::new();
    sum.update(page);
    sum.sum()
}

/// A fault of a column: what follows its name in a message.
pub(super) type Fault = String;

pub(super) const NO_NUMBER: &str = "is no number";
const CUT: &str = "ends too early; the file is damaged";

struct Chunk<'a> {
    told: &'a ColumnMetaData,
    shape: Shape,
    dictionary: Option<Vec<u8>>,
    rows: Rows,
    /// Rows to come.
    left: usize,
}

impl Chunk<'_> {
    fn read(mut self, bytes: &[u8]) -> Result<Rows, Fault> {
        /// Texts in the head of a page may take so much: smallest and largest value.
        const MOST: usize = 1 << 16;
        let start = match self.told.dictionary_page_offset {
            Some(dictionary) if (1..self.told.data_page_offset).contains(&dictionary) => dictionary,
            _ => self.told.data_page_offset,
        };
        let range = usize::try_from(start).ok().zip(usize::try_from(self.told.total_compressed_size).ok());
        let range = range.and_then(|(start, length)| bytes.get(start..start.checked_add(length)?));
        let mut rest = range.ok_or("lies beyond the file; the file is damaged")?;
        while self.left > 0 {
            let head = PageHeader::read_from_in_protocol(&mut TCompactInputProtocol::new(&mut rest, MOST));
            let head = head.map_err(|error| format!("has a damaged page: {error}"))?;
            let length = usize::try_from(head.compressed_page_size).map_err(|_| CUT)?;
            let page = rest.split_off(..length).ok_or(CUT)?;
            if head.crc.is_some_and(|crc| crc.cast_unsigned() != checksum(page)) {
                return Err("has a page that is not as it was written; the file is damaged".to_owned());
            }
            match (head.type_, &head) {
                (PageType::DICTIONARY_PAGE, PageHeader { dictionary_page_header: Some(_), .. }) => {
                    let page = self.unpacked(page)?;
                    let texts = matches!(self.shape.kept, Kept::Texts(_) | Kept::Decimals(_));
                    self.dictionary =
                        Some(if texts { self.shape.numbers(plain_texts(&page))? } else { page.into_owned() });
                }
                (PageType::DATA_PAGE, PageHeader { data_page_header: Some(head), .. }) => {
                    let page = self.unpacked(page)?;
                    let levels = if self.shape.levels > 0 { head.definition_level_encoding } else { Encoding::RLE };
                    if levels != Encoding::RLE {
                        return Err(format!("has levels in encoding {}; write it with a program of today", levels.0));
                    }
                    let (levels, values) = if self.shape.levels > 0 {
                        let (length, rest) = page.split_first_chunk().ok_or(CUT)?;
                        rest.split_at_checked(u32::from_le_bytes(*length) as usize).ok_or(CUT)?
                    } else {
                        (&[][..], &*page)
                    };
                    self.page(head.num_values, head.encoding, levels, values)?;
                }
                (PageType::DATA_PAGE_V2, PageHeader { data_page_header_v2: Some(head), .. }) => {
                    let size = |length: i32| usize::try_from(length).map_err(|_| CUT);
                    let repetition = size(head.repetition_levels_byte_length)?;
                    let (_, rest) = page.split_at_checked(repetition).ok_or(CUT)?;
                    let levels = size(head.definition_levels_byte_length)?;
                    let (levels, values) = rest.split_at_checked(levels).ok_or(CUT)?;
                    let packed = head.is_compressed.unwrap_or(true) && !values.is_empty();
                    let values = if packed { self.unpacked(values)? } else { values.into() };
                    self.page(head.num_values, head.encoding, levels, &values)?;
                }
                // An index.
                _ => {}
            }
        }
        Ok(self.rows)
    }

    /// A page as it was before it was compressed.
    fn unpacked<'b>(&self, packed: &'b [u8]) -> Result<Cow<'b, [u8]>, Fault> {
        let rows = self.shape.rows;
        // The text of a number has some digits, and its length before it; other text may be longer.
        let (width, part) = match self.shape.kept {
            Kept::Texts(_) => (32, "is long"),
            _ => (self.shape.width(), "is damaged"),
        };
        // A page that holds all rows, its levels, and heads of their runs.
        let most = rows.saturating_mul(width + 8).saturating_add(1 << 16);
        let unpacked = match self.told.codec {
            CompressionCodec::UNCOMPRESSED => return Ok(packed.into()),
            CompressionCodec::SNAPPY => codec::snappy(packed, most, part),
            CompressionCodec::GZIP => codec::gzip(packed, most, part),
            CompressionCodec::ZSTD => codec::zstd(packed, most, part),
            CompressionCodec::LZ4_RAW => codec::lz4_block(packed, most, part),
            CompressionCodec(other) => {
                let names = ["LZO", "Brotli", "the LZ4 of old"];
                let name = usize::try_from(other).ok().and_then(|other| names.get(other.checked_sub(3)?));
                let name = name.unwrap_or(&"a codec that is not known");
                return Err(format!("is compressed by {name}; write it with snappy, zstd, gzip or lz4_raw"));
            }
        };
        unpacked.map(Cow::from).map_err(|error| error.to_string())
    }

    /// Adds the rows of a page.
    fn page(&mut self, rows: i32, encoding: Encoding, levels: &[u8], values: &[u8]) -> Result<(), Fault> {
        let told = usize::try_from(rows).ok().filter(|rows| *rows <= self.left);
        let rows = told.ok_or_else(|| format!("has a page of {rows} rows where {} are to come", self.left))?;
        self.left -= rows;
        let (width, full) = (self.shape.width(), self.shape.levels);
        let first = self.rows.valid.len();
        let mut there = rows;
        if full > 0 {
            let levels = hybrid(levels, u32::BITS - full.leading_zeros(), rows).ok_or(CUT)?;
            self.rows.valid.extend(levels.into_iter().map(|level| level == full));
            there = self.rows.valid[first..].iter().filter(|valid| **valid).count();
        }
        let plain: Cow<'_, [u8]> = match (encoding, self.shape.kept) {
            (Encoding::PLAIN, Kept::Flags) => plain_bits(values, there).ok_or(CUT)?.into(),
            (Encoding::PLAIN, Kept::Stored(_)) => values.get(..there * width).ok_or(CUT)?.into(),
            (Encoding::PLAIN, _) => self.shape.numbers(plain_texts(values).chain([None]).take(there))?.into(),
            (Encoding::PLAIN_DICTIONARY | Encoding::RLE_DICTIONARY, _) => {
                let numbers =
                    self.dictionary.as_deref().ok_or("has no dictionary before its pages; the file is damaged")?;
                Dictionary { numbers, width }.look_up(values, there).ok_or("has a number beyond its dictionary")?.into()
            }
            (Encoding::BYTE_STREAM_SPLIT, Kept::Stored(_)) => split_streams(values, width, there).ok_or(CUT)?.into(),
            (Encoding::DELTA_BINARY_PACKED, Kept::Stored(_)) if width < 12 => delta(values, there)
                .ok_or(CUT)?
                .0
                .iter()
                .flat_map(|number| number.to_le_bytes().into_iter().take(width))
                .collect(),
            (Encoding::DELTA_LENGTH_BYTE_ARRAY, Kept::Texts(_) | Kept::Decimals(_)) => {
                let (lengths, mut values) = delta(values, there).ok_or(CUT)?;
                let lengths = lengths.into_iter().map(|length| usize::try_from(length).ok());
                self.shape.numbers(lengths.map(|length| values.split_off(..length?)))?.into()
            }
            (Encoding(other), _) => return Err(format!("has numbers in encoding {other}, which is not known")),
        };
        if there == rows {
            self.rows.bytes.extend_from_slice(&plain);
            return Ok(());
        }
        let mut numbers = plain.chunks_exact(width);
        for valid in &self.rows.valid[first..] {
            let number = if *valid { numbers.next() } else { None };
            let bytes = &mut self.rows.bytes;
            bytes.resize(bytes.len() + width, 0);
            if let (Some(number), Some(place)) = (number, bytes.len().checked_sub(width)) {
                bytes[place..].copy_from_slice(number);
            }
        }
        Ok(())
    }
}
