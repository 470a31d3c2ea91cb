//! TDMS of National Instruments: segments, each a lead-in, a list of objects and raw data.
//!
//! Source: "TDMS File Format Internal Structure", National Instruments, 2024.

mod daqmx;
mod meta;
mod scale;

use super::bytes::Bytes;
use super::number::{Number, numbers};
use super::{TableBuilder, column, refuse};
use crate::unit::{Kind, Unit};
use crate::{Column, Error, Values};
use daqmx::Daqmx;
use meta::{Layout, Properties, Property, Stored, layout, property, stamp, text};
use scale::scaled;
use std::collections::{BTreeMap, HashMap, HashSet};

const PART: &str = "TDMS file";
/// Bits of a lead-in.
const NEW_LIST: u32 = 1 << 2;
const RAW_DATA: u32 = 1 << 3;
const INTERLEAVED: u32 = 1 << 5;
const BIG_ENDIAN: u32 = 1 << 6;
/// Bytes before the list of channels of a segment.
const LEAD_IN: usize = 28;
/// The length of a segment that was not finished.
const UNFINISHED: u64 = u64::MAX;

#[derive(Debug, Default)]
struct Object {
    path: Vec<String>,
    properties: Properties,
    layout: Option<Layout>,
    values: Option<Values>,
    /// What its data are, where they are no numbers.
    other: Option<&'static str>,
    /// Where the data are raw ones of DAQmx, how they lie, and what was read of each source.
    daqmx: Option<Daqmx>,
    scalers: BTreeMap<u32, Values>,
}

/// All that is known so far.
#[derive(Debug, Default)]
struct File {
    objects: Vec<Object>,
    by_path: HashMap<String, usize>,
    /// Those with data in this segment, in their order.
    active: Vec<usize>,
    is_active: HashSet<usize>,
    /// How often a channel was gone to in a segment.
    visits: usize,
    /// Tells whether data are missing at the end of a segment.
    is_cut: bool,
}

pub(super) fn read(bytes: &[u8], table: &mut TableBuilder) -> Result<(), Error> {
    let mut bytes = Bytes::new(bytes, PART);
    let mut file = File::default();
    // Channels have bytes in each segment, save empty ones: only a made-up file has many more channels than bytes.
    let most_visits = bytes.left().saturating_mul(16);
    while bytes.left() > 0 {
        if bytes.left() < LEAD_IN && file.has_data() {
            file.is_cut = true;
            break;
        }
        file.segment(&mut bytes, table)?;
        if file.visits > most_visits {
            return Err(refuse("TDMS file: its segments list more channels than they have bytes; the file is damaged"));
        }
    }
    if file.is_cut {
        table.table.notes.push("the file ends within its last segment: samples are missing there".to_owned());
    }
    file.columns(table)
}

impl File {
    fn segment(&mut self, bytes: &mut Bytes<'_>, table: &mut TableBuilder) -> Result<(), Error> {
        bytes.big_endian = false;
        let begins = bytes.at();
        if bytes.take(4)? != b"TDSm" {
            return Err(refuse(format!("TDMS file: no segment begins at byte {begins}; the file is damaged")));
        }
        let contents = bytes.u32()?;
        bytes.big_endian = contents & BIG_ENDIAN != 0;
        let version = bytes.u32()?;
        if !matches!(version, 4712 | 4713) {
            return Err(refuse(format!("TDMS file: version {version} is not known, 4712 and 4713 are")));
        }
        let (next, data) = (bytes.u64()?, bytes.u64()?);
        let big_endian = bytes.big_endian;
        // A segment that is longer than the file was not finished either.
        let unfinished = next == UNFINISHED || next > bytes.left() as u64;
        let length = if unfinished { bytes.left() as u64 } else { next };
        let segment = bytes.take_u64(length)?;
        let Some((meta, raw)) = usize::try_from(data).ok().and_then(|data| segment.split_at_checked(data)) else {
            if unfinished && self.has_data() {
                self.is_cut = true;
                return Ok(());
            }
            return Err(refuse(format!("TDMS file: the data of the segment at byte {begins} begin beyond its end")));
        };
        if !meta.is_empty() {
            let mut meta = Bytes::new(meta, "TDMS file, the list of channels");
            meta.big_endian = big_endian;
            self.list(&mut meta, contents & NEW_LIST != 0)?;
        }
        if contents & RAW_DATA == 0 || raw.is_empty() {
            return Ok(());
        }
        // Where the length was never entered, nothing says that all is there.
        self.is_cut |= next != UNFINISHED && unfinished;
        self.chunks(raw, Order { big_endian, interleaved: contents & INTERLEAVED != 0, unfinished }, table)
    }

    fn has_data(&self) -> bool {
        self.objects.iter().any(|object| object.values.is_some() || !object.scalers.is_empty())
    }

    /// The objects of a segment.
    fn list(&mut self, meta: &mut Bytes<'_>, new: bool) -> Result<(), Error> {
        if new {
            self.active.clear();
            self.is_active.clear();
        }
        for _ in 0..meta.u32()? {
            let path = text(meta)?;
            let index = if let Some(index) = self.by_path.get(&path) {
                *index
            } else {
                self.objects.push(Object { path: parts(&path), ..Object::default() });
                self.by_path.insert(path, self.objects.len() - 1);
                self.objects.len() - 1
            };
            let object = &mut self.objects[index];
            let has_data = match meta.u32()? {
                u32::MAX => false,
                // As in the segment before.
                0 => object.layout.is_some(),
                // 0x126a is what files have for digital lines, 0x1369 what NI describes.
                kind @ (0x1269 | 0x126a | 0x1369) => {
                    let daqmx = Daqmx::read(meta, kind != 0x1269)?;
                    object.layout = Some(Layout { count: daqmx.count, ..NOTHING });
                    object.daqmx = Some(daqmx);
                    true
                }
                _ => {
                    object.layout = Some(layout(meta)?);
                    object.daqmx = None;
                    true
                }
            };
            for _ in 0..meta.u32()? {
                let name = text(meta)?;
                let value = property(meta)?;
                object.properties.insert(name, value);
            }
            if has_data && self.is_active.insert(index) {
                self.active.push(index);
            } else if !has_data && self.is_active.remove(&index) {
                self.visits += self.active.len();
                self.active.retain(|active| *active != index);
            }
        }
        Ok(())
    }

    /// The raw data of a segment: chunks of one layout, one behind the other. The last one may be cut short: then channels have as
    /// many values of it as are there where the segment was not finished, else all the same share.
    fn chunks(&mut self, raw: &[u8], order: Order, table: &mut TableBuilder) -> Result<(), Error> {
        self.visits += self.active.len();
        if self.active.iter().any(|object| self.objects[*object].daqmx.is_some()) {
            let whole = daqmx::chunks(raw, &mut self.objects, &self.active, order.big_endian, table)?;
            self.is_cut |= !whole;
            return Ok(());
        }
        let layouts: Vec<Layout> =
            self.active.iter().map(|object| self.objects[*object].layout.unwrap_or(NOTHING)).collect();
        let size = layouts.iter().try_fold(0_usize, |sum, layout| sum.checked_add(layout.bytes)).unwrap_or(usize::MAX);
        if size == 0 {
            return Err(refuse("TDMS file: a segment has data of no channel; the file is damaged"));
        }
        for chunk in raw.chunks(size) {
            if chunk.len() == size {
                self.chunk(chunk, &layouts, order, table)?;
                continue;
            }
            self.is_cut = true;
            // Of text no one can tell how much is there.
            if layouts.iter().any(|layout| layout.bytes > 0 && layout.kind.size().is_none()) {
                continue;
            }
            if order.unfinished && !order.interleaved {
                self.chunk(chunk, &layouts, order, table)?;
                continue;
            }
            let share = |count: usize| count as u128 * chunk.len() as u128 / size as u128;
            let part = |layout: &Layout| {
                let count = usize::try_from(share(layout.count)).unwrap_or(0);
                Layout { count, bytes: count.saturating_mul(layout.kind.size().unwrap_or(0)), ..*layout }
            };
            let layouts: Vec<Layout> = layouts.iter().map(part).collect();
            self.chunk(chunk, &layouts, order, table)?;
        }
        Ok(())
    }

    fn chunk(&mut self, chunk: &[u8], layouts: &[Layout], order: Order, table: &mut TableBuilder) -> Result<(), Error> {
        let row = layouts.iter().filter(|layout| layout.count > 0).map(|layout| layout.kind.size().unwrap_or(0)).sum();
        let mut offset = 0;
        for (object, layout) in self.active.iter().zip(layouts) {
            let (size, bytes, stride) = match (layout.kind.size(), order.interleaved) {
                // Channels of the type "void" have values without bytes.
                _ if layout.bytes == 0 => continue,
                (Some(size), true) => (size, &chunk[offset.min(chunk.len())..], row),
                // The last chunk of an unfinished segment may lack channels.
                (size, false) => {
                    let end = offset.saturating_add(layout.bytes).min(chunk.len());
                    (size.unwrap_or(1), &chunk[offset.min(chunk.len())..end], size.unwrap_or(1))
                }
                (None, true) => return Err(refuse("TDMS file: text cannot be interleaved; the file is damaged")),
            };
            offset = offset.saturating_add(if order.interleaved { size } else { layout.bytes });
            // Rows whose last one may be cut within.
            let count = if bytes.len() < size { 0 } else { ((bytes.len() - size) / stride + 1).min(layout.count) };
            let object = &mut self.objects[*object];
            if let (Stored::Skipped(_, what), _) | (_, Some(what)) = (layout.kind, object.other) {
                object.other = Some(what);
                continue;
            }
            table.take(&[count])?;
            let values = match layout.kind {
                Stored::Number(number) => number.placed(bytes, order.big_endian, 0, stride, count),
                Stored::Text => {
                    let Some(numbers) = texts(bytes, order.big_endian, layout.count) else {
                        table.left += count + object.values.take().map_or(0, |values| values.len());
                        object.other = Some("text");
                        continue;
                    };
                    Values::Float(numbers)
                }
                _ => times(bytes, order.big_endian, stride, count)?,
            };
            match &mut object.values {
                Some(before) => before.append(values),
                none => *none = Some(values),
            }
        }
        Ok(())
    }

    fn columns(mut self, table: &mut TableBuilder) -> Result<(), Error> {
        let found: Vec<_> = self
            .objects
            .iter_mut()
            .map(|object| (object.values.take(), std::mem::take(&mut object.scalers)))
            .map(
                |(values, scalers)| if values.is_none() && scalers.is_empty() { None } else { Some((values, scalers)) },
            )
            .collect();
        let mut count: HashMap<&str, usize> = HashMap::new();
        for (object, _) in self.objects.iter().zip(&found).filter(|(_, values)| values.is_some()) {
            *count.entry(object.name()).or_default() += 1;
        }
        let properties: HashMap<&[String], &Properties> =
            self.objects.iter().map(|object| (object.path.as_slice(), &object.properties)).collect();
        // Channels that began later than others did.
        let began = self.objects.iter().zip(&found).filter(|(_, values)| values.is_some());
        let first = began.filter_map(|(object, _)| object.began()).min();
        for (object, values) in self.objects.iter().zip(found) {
            // A name that several groups have goes with its group.
            let several = count.get(object.name()).is_some_and(|count| *count > 1);
            let name = if several { object.path.join("/") } else { object.name().to_owned() };
            if let Some(what) = object.other.or(values.is_none().then_some("without samples")) {
                // A group or the file has none.
                if object.path.len() > 1 {
                    table.leave_out(&object.path.join("/"), what);
                }
                continue;
            }
            let Some((values, scalers)) = values else { continue };
            let group = object.path.split_last().map_or(&[][..], |(_, group)| group);
            let sampled_s = match object.sampled_s(first) {
                Ok(sampled_s) => sampled_s,
                Err(unit) => {
                    table.leave_out(&name, format!("over an abscissa in {unit}: it is no record over time"));
                    continue;
                }
            };
            let of_group = properties.get(group).copied();
            let sources = [Some(&object.properties), of_group, properties.get([].as_slice()).copied()];
            let values = scaled(values, &scalers, &sources, &name)?;
            let time = matches!(object.layout, Some(Layout { kind: Stored::Time, .. }));
            let unit = || object.text("unit_string").or_else(|| object.text("NI_UnitDescription"));
            let unit = if time { Some("ns".to_owned()) } else { unit() };
            if values.is_empty() {
                table.leave_out(&name, "without samples");
                continue;
            }
            table.extend(&group.join("/"), [Column { sampled_s, ..column(name, unit, values) }]);
        }
        Ok(())
    }
}

const NOTHING: Layout = Layout { kind: Stored::Skipped(0, "without samples"), count: 0, bytes: 0 };

/// How a segment stores its chunks.
#[derive(Debug, Clone, Copy)]
struct Order {
    big_endian: bool,
    interleaved: bool,
    unfinished: bool,
}

impl Object {
    fn name(&self) -> &str {
        self.path.last().map_or("", String::as_str)
    }
    fn number(&self, name: &str) -> Option<f64> {
        if let Some(Property::Number(number)) = self.properties.get(name) { Some(*number) } else { None }
    }
    fn text(&self, name: &str) -> Option<String> {
        match self.properties.get(name) {
            Some(Property::Text(text)) if !text.is_empty() => Some(text.clone()),
            _ => None,
        }
    }
    /// When the channel began.
    fn began(&self) -> Option<i128> {
        if let Some(Property::Time(time)) = self.properties.get("wf_start_time") { Some(*time) } else { None }
    }
    /// Time of the first sample, since the earliest of all channels began, and between samples; else the unit of what the channel
    /// is sampled over, where that is no time.
    fn sampled_s(&self, first: Option<i128>) -> Result<Option<[f64; 2]>, String> {
        let Some(interval) = self.number("wf_increment").filter(|interval| interval.is_finite() && *interval > 0.0)
        else {
            return Ok(None);
        };
        let unit = self.text("wf_xunit_string").unwrap_or_else(|| "s".to_owned());
        let Some(Unit { kind: Kind::Time, size }) = Unit::of(&unit) else { return Err(unit) };
        let start = self.number("wf_start_offset").filter(|start| start.is_finite()).unwrap_or(0.0);
        let later = self.began().zip(first).and_then(|(own, first)| own.checked_sub(first)).unwrap_or(0);
        #[expect(clippy::cast_precision_loss, reason = "to the precision of a float of its size")]
        let later_s = later as f64 * 2_f64.powi(-64);
        Ok(Some([start * size + later_s, interval * size]))
    }
}

/// The parts of `/'group'/'channel'`, in which a quote stands twice.
fn parts(path: &str) -> Vec<String> {
    let inner = path.strip_prefix("/'").and_then(|path| path.strip_suffix('\''));
    inner.map(|path| path.split("'/'").map(|part| part.replace("''", "'")).collect()).unwrap_or_default()
}

/// The numbers of texts: where each of them ends, then all; none where one is no number.
fn texts(bytes: &[u8], big_endian: bool, count: usize) -> Option<Vec<f64>> {
    let (ends, all) = bytes.split_at_checked(count.checked_mul(4)?)?;
    let ends = Number::U32.values(ends, big_endian).into_integers();
    let ends = ends.into_iter().map(|end| usize::try_from(end).unwrap_or(usize::MAX));
    let mut last = 0;
    numbers(ends.map(|end| all.get(std::mem::replace(&mut last, end)..end).unwrap_or(b"?")))
}

/// Nanoseconds since 1970.
fn times(bytes: &[u8], big_endian: bool, stride: usize, count: usize) -> Result<Values, Error> {
    const FROM_1904_TO_1970_S: i64 = 2_082_844_800;
    let mut times = Vec::with_capacity(count);
    for stamp_bytes in bytes.chunks(stride).take(count) {
        let mut stamp_bytes = Bytes::new(stamp_bytes, "TDMS file, a time");
        stamp_bytes.big_endian = big_endian;
        let (seconds, fraction) = stamp(&mut stamp_bytes)?;
        // To the nearest; at most 10⁹, so that it fits.
        let fraction_ns = ((u128::from(fraction) * 1_000_000_000 + (1 << 63)) >> 64) as i64;
        let time = seconds
            .checked_sub(FROM_1904_TO_1970_S)
            .and_then(|seconds| seconds.checked_mul(1_000_000_000))
            .and_then(|time| time.checked_add(fraction_ns));
        times.push(time.ok_or_else(|| refuse(format!("TDMS file: a time of {seconds} s since 1904 is beyond 2262")))?);
    }
    Ok(Values::Integer(times))
}
