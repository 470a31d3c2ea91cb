//! Pages of one column, unpacked within a bound, with lengths that hold.

use crate::Error;
use crate::container::{codec, refuse};
use bytes::Bytes;
use parquet::basic::{Compression, CompressionCodec, Encoding};
use parquet::column::page::{Page, PageMetadata, PageReader};
use parquet::errors::{ParquetError, Result};
use parquet::file::metadata::ColumnChunkMetaData;
use parquet::file::serialized_reader::SerializedPageReader;
use std::sync::Arc;

/// Reads pages as they lie, and unpacks them itself: the crate would take what memory a header asks for, and its
/// Zstandard is no Rust.
pub(super) struct Pages {
    packed: SerializedPageReader<Bytes>,
    codec: CompressionCodec,
    /// Bytes of a page that holds all rows.
    most: usize,
    has_dictionary: bool,
}

impl Pages {
    pub(super) fn new(
        bytes: &Arc<Bytes>,
        chunk: &ColumnChunkMetaData,
        rows: usize,
        name: &str,
    ) -> std::result::Result<Self, Error> {
        let fault = |fault: &str| refuse(format!("Parquet file: column {name:?} {fault}"));
        let codec = chunk.compression_codec();
        if matches!(codec, CompressionCodec::BROTLI | CompressionCodec::LZ4 | CompressionCodec::LZO) {
            return Err(fault(&format!("is compressed by {codec}; write it with snappy, zstd, gzip or lz4_raw")));
        }
        let start = chunk.dictionary_page_offset().unwrap_or_else(|| chunk.data_page_offset());
        if start < 0 || chunk.compressed_size() < 0 {
            return Err(fault("begins before the file; the file is damaged"));
        }
        let as_it_lies = chunk.clone().into_builder().set_compression(Compression::UNCOMPRESSED).build();
        let as_it_lies = as_it_lies.map_err(|error| fault(&format!("is damaged: {error}")))?;
        let packed = SerializedPageReader::new(Arc::clone(bytes), &as_it_lies, rows, None);
        let packed = packed.map_err(|error| fault(&format!("is damaged: {error}")))?;
        // 12 bytes for the widest number, and some for levels; a page of few rows has a header.
        Ok(Self { packed, codec, most: rows.saturating_mul(16).saturating_add(1 << 16), has_dictionary: false })
    }

    fn unpack(&self, packed: &[u8]) -> Result<Bytes> {
        let part = "Parquet file, a page";
        let unpacked = match self.codec {
            CompressionCodec::SNAPPY => codec::snappy(packed, self.most, part),
            CompressionCodec::GZIP => codec::gzip(packed, self.most, part),
            CompressionCodec::ZSTD => codec::zstd(packed, self.most, part),
            CompressionCodec::LZ4_RAW => codec::lz4_block(packed, self.most, part),
            _ => Err(refuse("Parquet file: a page is packed in a way that is not read")),
        };
        unpacked.map(Bytes::from).map_err(|error| ParquetError::General(error.to_string()))
    }

    /// The page, with all that the crate takes for granted.
    fn unpacked(&mut self, page: Page) -> Result<Page> {
        let is_packed = self.codec != CompressionCodec::UNCOMPRESSED;
        let by_dictionary = matches!(page.encoding(), Encoding::PLAIN_DICTIONARY | Encoding::RLE_DICTIONARY);
        if page.is_data_page() && by_dictionary && !self.has_dictionary {
            return Err(ParquetError::General("a page needs a dictionary, but there is none before it".to_owned()));
        }
        Ok(match page {
            Page::DataPage { buf, num_values, encoding, def_level_encoding, rep_level_encoding, statistics } => {
                // The other coding of levels is of 2013, and the crate trusts its length.
                if def_level_encoding != Encoding::RLE {
                    return Err(ParquetError::General(format!("levels coded as {def_level_encoding} are not read")));
                }
                let buf = if is_packed { self.unpack(&buf)? } else { buf };
                Page::DataPage { buf, num_values, encoding, def_level_encoding, rep_level_encoding, statistics }
            }
            Page::DataPageV2 {
                buf,
                num_values,
                encoding,
                num_nulls,
                num_rows,
                def_levels_byte_len,
                rep_levels_byte_len,
                is_compressed,
                statistics,
            } => {
                let levels =
                    def_levels_byte_len.checked_add(rep_levels_byte_len).and_then(|sum| usize::try_from(sum).ok());
                let Some((levels, values)) = levels.and_then(|levels| buf.split_at_checked(levels)) else {
                    return Err(ParquetError::General("the levels of a page lie beyond it".to_owned()));
                };
                let buf = if is_packed && is_compressed && !values.is_empty() {
                    [levels, self.unpack(values)?.as_ref()].concat().into()
                } else {
                    buf
                };
                Page::DataPageV2 {
                    buf,
                    num_values,
                    encoding,
                    num_nulls,
                    num_rows,
                    def_levels_byte_len,
                    rep_levels_byte_len,
                    is_compressed: false,
                    statistics,
                }
            }
            Page::DictionaryPage { buf, num_values, encoding, is_sorted } => {
                let buf = if is_packed { self.unpack(&buf)? } else { buf };
                // No number is shorter than 4 bytes.
                if num_values as usize > buf.len() / 4 {
                    let fault = format!("a dictionary of {num_values} numbers cannot have {} bytes", buf.len());
                    return Err(ParquetError::General(fault));
                }
                self.has_dictionary = true;
                Page::DictionaryPage { buf, num_values, encoding, is_sorted }
            }
        })
    }
}

impl Iterator for Pages {
    type Item = Result<Page>;
    fn next(&mut self) -> Option<Self::Item> {
        self.get_next_page().transpose()
    }
}

impl PageReader for Pages {
    fn get_next_page(&mut self) -> Result<Option<Page>> {
        let page = self.packed.get_next_page()?;
        page.map(|page| self.unpacked(page)).transpose()
    }
    fn peek_next_page(&mut self) -> Result<Option<PageMetadata>> {
        self.packed.peek_next_page()
    }
    fn skip_next_page(&mut self) -> Result<()> {
        self.packed.skip_next_page()
    }
}
