//! The lists of a TDMS file are made of texts, properties and types of data.

use std::collections::HashMap;

use crate::container::bytes::Bytes;
use crate::container::number::Number;
use crate::container::{COMPLEX, refuse};
use crate::{Error, Values};

/// A property, as far as it is used.
#[derive(Debug, Clone)]
pub(super) enum Property {
    Number(f64),
    Text(String),
    /// In 2⁻⁶⁴ s since 1904.
    Time(i128),
    Other,
}

pub(super) type Properties = HashMap<String, Property>;

/// How the raw data of a channel lie in a chunk.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Layout {
    pub(super) kind: Stored,
    pub(super) count: usize,
    /// Bytes of all.
    pub(super) bytes: usize,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Stored {
    Number(Number),
    /// Seconds since 1904 and 2⁻⁶⁴ of one.
    Time,
    /// Ends of all texts, then the texts.
    Text,
    /// What is no number: of so many bytes each, and what it is.
    Skipped(usize, &'static str),
}

impl Stored {
    pub(super) fn size(self) -> Option<usize> {
        match self {
            Self::Number(number) => Some(number.size()),
            Self::Time => Some(16),
            Self::Text => None,
            Self::Skipped(size, _) => Some(size),
        }
    }
}

pub(super) fn text(bytes: &mut Bytes<'_>) -> Result<String, Error> {
    let length = bytes.u32()?;
    Ok(String::from_utf8_lossy(bytes.take_u64(length.into())?).into_owned())
}

pub(super) fn layout(meta: &mut Bytes<'_>) -> Result<Layout, Error> {
    let kind = stored(meta.u32()?)?;
    let dimension = meta.u32()?;
    let count = meta.u64()?;
    if dimension != 1 {
        return Err(refuse(format!("TDMS file: a channel has {dimension} dimensions; the format allows 1")));
    }
    let bytes = match kind.size() {
        Some(size) => count.saturating_mul(size as u64),
        None => meta.u64()?,
    };
    let beyond = |_| refuse(format!("TDMS file: a channel of {count} values is beyond the file"));
    Ok(Layout { kind, count: count.try_into().map_err(beyond)?, bytes: bytes.try_into().map_err(beyond)? })
}

/// A type of data by its number.
pub(super) fn stored(kind: u32) -> Result<Stored, Error> {
    Ok(match kind {
        0 => Stored::Skipped(0, "without values"),
        1 => Stored::Number(Number::I8),
        2 => Stored::Number(Number::I16),
        3 => Stored::Number(Number::I32),
        4 => Stored::Number(Number::I64),
        0x21 => Stored::Skipped(1, "truths"),
        5 => Stored::Number(Number::U8),
        6 => Stored::Number(Number::U16),
        7 => Stored::Number(Number::U32),
        8 => Stored::Number(Number::U64),
        9 | 0x19 => Stored::Number(Number::F32),
        10 | 0x1a => Stored::Number(Number::F64),
        // With a unit or without.
        0x0b | 0x1b => Stored::Skipped(16, "extended floats; save them as doubles"),
        0x10_000d => Stored::Skipped(16, COMPLEX),
        0x08_000c => Stored::Skipped(8, COMPLEX),
        0x20 => Stored::Text,
        0x44 => Stored::Time,
        other => return Err(refuse(format!("TDMS file: data of the type {other:#x} are not known"))),
    })
}

pub(super) fn property(meta: &mut Bytes<'_>) -> Result<Property, Error> {
    let kind = stored(meta.u32()?)?;
    let Some(size) = kind.size() else { return Ok(Property::Text(text(meta)?)) };
    let bytes = meta.take(size)?;
    if let Stored::Time = kind {
        let (seconds, fraction) = stamp(&mut meta.part(bytes, "TDMS file, a property"))?;
        return Ok(Property::Time((i128::from(seconds) << 64) + i128::from(fraction)));
    }
    let Stored::Number(number) = kind else { return Ok(Property::Other) };
    Ok(match number.values(bytes, meta.big_endian) {
        Values::Float(value) => value.first().map_or(Property::Other, |value| Property::Number(*value)),
        Values::Integer(_) => Property::Other,
    })
}

/// Seconds since 1904, and 2⁻⁶⁴ of one.
pub(super) fn stamp(bytes: &mut Bytes<'_>) -> Result<(i64, u64), Error> {
    if bytes.big_endian {
        let seconds = bytes.i64()?;
        return Ok((seconds, bytes.u64()?));
    }
    let fraction = bytes.u64()?;
    Ok((bytes.i64()?, fraction))
}
