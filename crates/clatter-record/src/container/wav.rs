//! WAV: chunks of a RIFF file, of which `fmt ` and `data` count.
//!
//! Source: Multimedia Programming Interface and Data Specifications 1.0 (IBM and Microsoft, 1991); for `RF64` and its
//! `ds64`, EBU Tech 3306.

use super::bytes::Bytes;
use super::number::Number;
use super::{TableBuilder, column, refuse};
use crate::{Column, Error, Values};

/// The contents of `fmt `.
#[derive(Debug, Clone, Copy)]
struct Format {
    coding: Coding,
    channels: usize,
    rate_hz: u32,
}

#[derive(Debug, Clone, Copy)]
enum Coding {
    /// 8 bits, 128 for zero.
    Unsigned,
    /// Signed integers of so many bytes.
    Signed(usize),
    Float(Number),
}

impl Coding {
    fn size(self) -> usize {
        match self {
            Self::Unsigned => 1,
            Self::Signed(bytes) => bytes,
            Self::Float(number) => number.size(),
        }
    }
}

pub(super) fn read(bytes: &[u8], table: &mut TableBuilder) -> Result<(), Error> {
    let mut bytes = Bytes::new(bytes, "WAV file");
    let form = bytes.take(4)?;
    bytes.big_endian = match form {
        b"RIFF" | b"RF64" | b"BW64" => false,
        b"RIFX" => true,
        _ => return Err(refuse("WAV file: it does not begin with RIFF, RIFX or RF64")),
    };
    bytes.take(8)?;
    let (mut format, mut long_data) = (None, None);
    loop {
        let name = bytes.take(4)?;
        let length = bytes.u32()?;
        match name {
            b"fmt " => {
                let part = bytes.take_u64(length.into())?;
                format = Some(Format::read(part, bytes.big_endian)?);
            }
            b"ds64" => {
                let mut part = Bytes::new(bytes.take_u64(length.into())?, "WAV file, ds64");
                part.take(8)?;
                long_data = Some(part.u64()?);
            }
            b"data" => {
                let format = format.ok_or_else(|| refuse("WAV file: no \"fmt \" before its data"))?;
                let data = match (length, long_data) {
                    (u32::MAX, Some(length)) => bytes.take_u64(length)?,
                    // A program that wrote to a pipe could not go back to enter the length.
                    (0 | u32::MAX, _) => bytes.rest(),
                    (length, _) => bytes.take_u64(length.into())?,
                };
                return format.columns(data, bytes.big_endian, table);
            }
            _ => {
                bytes.take_u64(length.into())?;
            }
        }
        // Chunks begin at even bytes.
        if length % 2 == 1 {
            bytes.take(1)?;
        }
    }
}

impl Format {
    fn read(part: &[u8], big_endian: bool) -> Result<Self, Error> {
        const EXTENSIBLE: u32 = 0xfffe;
        let mut part = Bytes::new(part, "WAV file, fmt");
        part.big_endian = big_endian;
        let mut kind = u32::from(part.u16()?);
        let channels = usize::from(part.u16()?);
        let rate_hz = part.u32()?;
        part.take(4)?;
        let block = usize::from(part.u16()?);
        let bits = part.u16()?;
        if kind == EXTENSIBLE {
            // Its own length, valid bits, places of the speakers, then the kind as the first bytes of an identifier.
            part.take(8)?;
            kind = part.u32()?;
        }
        let coding = match (kind, bits) {
            (1, 1..=8) => Coding::Unsigned,
            (1, 9..=32) => Coding::Signed(usize::from(bits).div_ceil(8)),
            (3, 32) => Coding::Float(Number::F32),
            (3, 64) => Coding::Float(Number::F64),
            (1 | 3, bits) => return Err(refuse(format!("WAV file: samples of {bits} bits are not read"))),
            (kind, _) => {
                return Err(refuse(format!(
                    "WAV file: coding {kind} is not read; save it as PCM or float without loss"
                )));
            }
        };
        if channels == 0 || rate_hz == 0 {
            return Err(refuse(format!("WAV file: {channels} channels at {rate_hz} Hz are none")));
        }
        if block != channels * coding.size() {
            return Err(refuse(format!(
                "WAV file: {channels} channels of {bits} bits take {} bytes a sample, not {block}",
                channels * coding.size()
            )));
        }
        Ok(Self { coding, channels, rate_hz })
    }

    fn columns(self, data: &[u8], big_endian: bool, table: &mut TableBuilder) -> Result<(), Error> {
        let Self { coding, channels, rate_hz } = self;
        let length = data.len() / (channels * coding.size());
        if table.take(&[channels, length])? == 0 {
            return Ok(());
        }
        let unit = match coding {
            Coding::Float(_) => None,
            _ => Some(crate::FULL_SCALE.to_owned()),
        };
        let channel = |channel| Column {
            sampled_s: Some([0.0, 1.0 / f64::from(rate_hz)]),
            ..column(
                format!("channel {}", channel + 1),
                unit.clone(),
                coding.channel(data, big_endian, channel, channels, length),
            )
        };
        table.extend("", (0..channels).map(channel));
        Ok(())
    }
}

impl Coding {
    fn channel(self, data: &[u8], big_endian: bool, channel: usize, channels: usize, length: usize) -> Values {
        let share = match self {
            Self::Float(number) => return number.strided(data, big_endian, channel, channels, length),
            Self::Unsigned => |bytes: &[u8], _| (f64::from(bytes[0]) - 128.0) / 128.0,
            Self::Signed(_) => |bytes: &[u8], big_endian: bool| {
                // To the upper bytes of 32 bits, so that the sign is in its place.
                let mut upper = [0; 4];
                if big_endian {
                    upper[..bytes.len()].copy_from_slice(bytes);
                    f64::from(i32::from_be_bytes(upper)) / -f64::from(i32::MIN)
                } else {
                    upper[4 - bytes.len()..].copy_from_slice(bytes);
                    f64::from(i32::from_le_bytes(upper)) / -f64::from(i32::MIN)
                }
            },
        };
        let size = self.size();
        let blocks = data.chunks_exact(size * channels).take(length);
        Values::Float(blocks.map(|block| share(&block[channel * size..(channel + 1) * size], big_endian)).collect())
    }
}
