//! Compressed parts of a file, unpacked within a bound.

use super::refuse;
use crate::Error;
use std::io::Read;

/// Reads to the end, but no more than `most` bytes.
pub(super) fn unpack(packed: impl Read, most: usize, part: &str) -> Result<Vec<u8>, Error> {
    let mut bytes = Vec::new();
    // One byte more tells a stream that goes on.
    let limit = u64::try_from(most).unwrap_or(u64::MAX).saturating_add(1);
    packed
        .take(limit)
        .read_to_end(&mut bytes)
        .map_err(|error| refuse(format!("{part}: the compressed bytes are damaged: {error}")))?;
    if bytes.len() > most {
        return Err(refuse(format!("{part}: it unpacks to more than the {most} bytes that are allowed")));
    }
    Ok(bytes)
}

/// A zlib stream.
pub(super) fn zlib(packed: &[u8], most: usize, part: &str) -> Result<Vec<u8>, Error> {
    unpack(flate2::read::ZlibDecoder::new(packed), most, part)
}

/// A Zstandard stream.
#[cfg(feature = "parquet")]
pub(super) fn zstd(packed: &[u8], most: usize, part: &str) -> Result<Vec<u8>, Error> {
    let stream = ruzstd::decoding::StreamingDecoder::new(packed)
        .map_err(|error| refuse(format!("{part}: the Zstandard bytes are damaged: {error}")))?;
    unpack(stream, most, part)
}

/// An LZ4 frame.
#[cfg(feature = "parquet")]
pub(super) fn lz4_frame(packed: &[u8], most: usize, part: &str) -> Result<Vec<u8>, Error> {
    unpack(lz4_flex::frame::FrameDecoder::new(packed), most, part)
}

/// A block of LZ4 without a frame.
#[cfg(feature = "parquet")]
pub(super) fn lz4_block(packed: &[u8], most: usize, part: &str) -> Result<Vec<u8>, Error> {
    // A byte of LZ4 stands for 255 at most.
    let mut bytes = vec![0; most.min(packed.len().saturating_mul(255))];
    let length = lz4_flex::block::decompress_into(packed, &mut bytes)
        .map_err(|error| refuse(format!("{part}: the LZ4 bytes are damaged: {error}")))?;
    bytes.truncate(length);
    Ok(bytes)
}

/// A gzip stream.
#[cfg(feature = "parquet")]
pub(super) fn gzip(packed: &[u8], most: usize, part: &str) -> Result<Vec<u8>, Error> {
    unpack(flate2::read::MultiGzDecoder::new(packed), most, part)
}

/// A block of Snappy, which begins with its length.
#[cfg(feature = "parquet")]
pub(super) fn snappy(packed: &[u8], most: usize, part: &str) -> Result<Vec<u8>, Error> {
    let damaged = |error| refuse(format!("{part}: the Snappy bytes are damaged: {error}"));
    let length = snap::raw::decompress_len(packed).map_err(damaged)?;
    // As with LZ4: a copy of 64 bytes takes 2.
    if length > most || length > packed.len().saturating_mul(64) {
        return Err(refuse(format!("{part}: it unpacks to {length} bytes, more than are allowed")));
    }
    snap::raw::Decoder::new().decompress_vec(packed).map_err(damaged)
}
