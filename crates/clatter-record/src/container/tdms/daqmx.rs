//! Raw data of DAQmx: rows of one width for each acquisition card, of which a channel takes some bytes.
//!
//! The format is not in NI's description of TDMS; it is read as npTDMS reads it.

use super::{Object, PART};
use crate::container::bytes::Bytes;
use crate::container::number::Number;
use crate::container::{TableBuilder, refuse};
use crate::{Error, Values};

/// How the raw data of a channel lie in a chunk.
#[derive(Debug, Clone, Default)]
pub(super) struct Daqmx {
    pub(super) count: usize,
    scalers: Vec<Scaler>,
    /// Bytes of a row of each buffer, the same for all channels.
    widths: Vec<usize>,
}

/// Where one source of a channel lies.
#[derive(Debug, Clone, Copy)]
struct Scaler {
    number: Number,
    buffer: usize,
    /// Bytes from the begin of a row.
    offset: usize,
    /// The one bit that counts, of a digital line.
    bit: Option<u32>,
    id: u32,
}

impl Daqmx {
    /// From the index of a channel.
    pub(super) fn read(meta: &mut Bytes<'_>, is_digital: bool) -> Result<Self, Error> {
        meta.u32()?;
        let dimension = meta.u32()?;
        if dimension != 1 {
            return Err(refuse(format!("{PART}: a channel has {dimension} dimensions; the format allows 1")));
        }
        let count = usize::try_from(meta.u64()?).unwrap_or(usize::MAX);
        let mut scalers = Vec::new();
        for _ in 0..meta.u32()? {
            let kind = meta.u32()?;
            let number = match kind {
                0 => Number::U8,
                1 => Number::I8,
                2 => Number::U16,
                3 => Number::I16,
                4 => Number::U32,
                5 => Number::I32,
                6 => Number::U64,
                7 => Number::I64,
                8 => Number::F32,
                9 => Number::F64,
                other => return Err(refuse(format!("{PART}: raw data of the DAQmx type {other} are not known"))),
            };
            let (buffer, offset) = (meta.u32()? as usize, meta.u32()?);
            if is_digital {
                meta.u8()?;
            } else {
                meta.u32()?;
            }
            let (offset, bit) =
                if is_digital { ((offset / 8) as usize, Some(offset % 8)) } else { (offset as usize, None) };
            scalers.push(Scaler { number, buffer, offset, bit, id: meta.u32()? });
        }
        let mut widths = Vec::new();
        for _ in 0..meta.u32()? {
            widths.push(meta.u32()? as usize);
        }
        let within = |scaler: &Scaler| {
            widths.get(scaler.buffer).is_some_and(|width| scaler.offset.saturating_add(scaler.number.size()) <= *width)
        };
        if scalers.is_empty() || !scalers.iter().all(within) {
            return Err(refuse(format!("{PART}: raw data of DAQmx lie beyond their rows; the file is damaged")));
        }
        Ok(Self { count, scalers, widths })
    }
}

/// Rows and width of each buffer in a chunk.
fn buffers(active: &[&Daqmx]) -> Result<Vec<(usize, usize)>, Error> {
    let Some(first) = active.first() else { return Ok(Vec::new()) };
    let mut buffers: Vec<(usize, usize)> = first.widths.iter().map(|width| (0, *width)).collect();
    for daqmx in active {
        if daqmx.widths != first.widths {
            return Err(refuse(format!(
                "{PART}: channels of DAQmx differ in the width of their rows; the file is damaged"
            )));
        }
        for scaler in &daqmx.scalers {
            buffers[scaler.buffer].0 = buffers[scaler.buffer].0.max(daqmx.count);
        }
    }
    Ok(buffers)
}

/// Adds the raw data of a segment to its channels, and says whether the last chunk is whole.
pub(super) fn chunks(
    raw: &[u8],
    objects: &mut [Object],
    active: &[usize],
    big_endian: bool,
    table: &mut TableBuilder,
) -> Result<bool, Error> {
    let daqmx: Vec<Daqmx> = active.iter().filter_map(|index| objects[*index].daqmx.clone()).collect();
    if daqmx.len() < active.len() {
        return Err(refuse(format!(
            "{PART}: a segment mixes raw data of DAQmx with others; convert the file with LabVIEW"
        )));
    }
    let buffers = buffers(&daqmx.iter().collect::<Vec<_>>())?;
    let bytes = |(rows, width): &(usize, usize)| rows.saturating_mul(*width);
    let size = buffers.iter().map(bytes).fold(0, usize::saturating_add);
    if size == 0 {
        return Err(refuse(format!("{PART}: a segment has data of no channel; the file is damaged")));
    }
    for chunk in raw.chunks(size) {
        let mut at = 0_usize;
        for (number, buffer) in buffers.iter().enumerate() {
            let end = at.saturating_add(bytes(buffer)).min(chunk.len());
            let part = &chunk[at..end];
            at = end;
            for (index, daqmx) in active.iter().zip(&daqmx) {
                let rows = (part.len() / buffer.1.max(1)).min(daqmx.count);
                for scaler in daqmx.scalers.iter().filter(|scaler| scaler.buffer == number) {
                    table.take(&[rows])?;
                    let values = scaler.values(&part[..rows * buffer.1], buffer.1, rows, big_endian);
                    let empty = || Values::Float(Vec::new());
                    objects[*index].scalers.entry(scaler.id).or_insert_with(empty).append(values);
                }
            }
        }
    }
    Ok(raw.len().is_multiple_of(size))
}

impl Scaler {
    fn values(self, rows: &[u8], width: usize, count: usize, big_endian: bool) -> Values {
        let values = self.number.placed(rows, big_endian, self.offset, width, count);
        let Some(bit) = self.bit else { return values };
        let bits = values.into_integers();
        Values::Float(bits.into_iter().map(|value| f64::from(u8::from(value >> bit & 1 == 1))).collect())
    }
}
