//! HDF5, and MATLAB 7.3, which is HDF5 with the sides of a matrix exchanged.
//!
//! A column goes by the path of its data set. Attributes of a data set, or of a group it lies in,
//! give its unit and its rate.

use super::number::Number;
use super::{Matrix, Naming, TableBuilder, agreed, column, interval_s, refuse};
use crate::{Column, Error, Values};
use hdf5_pure::{AttrValue, Dataset, Datatype, DatatypeByteOrder, File, FloatingPointLayout, Group};
use std::collections::HashMap;

/// Groups within groups: a link may lead back to a group above.
const DEEPEST: usize = 16;
/// Groups and data sets together, for the same reason.
const MOST_OBJECTS: usize = 10_000;

pub(super) fn read(bytes: &[u8], table: &mut TableBuilder) -> Result<(), Error> {
    // MATLAB puts a header of its own before the file.
    let matlab = bytes.starts_with(b"MATLAB");
    let file = File::from_bytes(bytes.to_vec()).map_err(damaged)?;
    Collector { matlab, table, objects: 0 }.group(&file.root(), "", 0)?;
    table.spread_intervals('/');
    Ok(())
}

fn damaged(error: impl std::fmt::Display) -> Error {
    refuse(format!("HDF5 file: {error}"))
}

type Attributes = HashMap<String, AttrValue>;

#[derive(Debug)]
struct Collector<'a> {
    matlab: bool,
    table: &'a mut TableBuilder,
    objects: usize,
}

impl Collector<'_> {
    fn count(&mut self) -> Result<(), Error> {
        self.objects += 1;
        if self.objects > MOST_OBJECTS {
            return Err(refuse(format!("HDF5 file: more than {MOST_OBJECTS} groups and data sets are no record")));
        }
        Ok(())
    }

    fn group(&mut self, group: &Group, path: &str, depth: usize) -> Result<(), Error> {
        self.count()?;
        if depth > DEEPEST {
            return Err(refuse(format!("HDF5 file: groups lie more than {DEEPEST} deep at {path:?}")));
        }
        let interval_s = rate(&group.attrs().map_err(damaged)?);
        let full = |name: &str| if path.is_empty() { name.to_owned() } else { format!("{path}/{name}") };
        // Opened in one walk: by name each would be a walk of its own.
        let mut datasets: Vec<_> = group.iter_datasets().map_err(damaged)?.collect();
        datasets.sort_unstable_by(|(one, _), (other, _)| one.cmp(other));
        for (name, dataset) in datasets {
            self.count()?;
            self.dataset(&dataset, path, &name, &full(&name))?;
        }
        // A single number of the group holds before its attributes.
        if let Some(interval_s) = interval_s {
            self.table.intervals_s.entry(path.to_owned()).or_insert(interval_s);
        }
        let mut groups: Vec<_> = group.iter_groups().map_err(damaged)?.collect();
        groups.sort_unstable_by(|(one, _), (other, _)| one.cmp(other));
        // MATLAB keeps some groups for itself.
        for (name, group) in groups.into_iter().filter(|(name, _)| !name.starts_with('#')) {
            self.group(&group, &full(&name), depth + 1)?;
        }
        Ok(())
    }

    /// Adds the columns of a data set, or a single number.
    fn dataset(&mut self, dataset: &Dataset, group: &str, name: &str, path: &str) -> Result<(), Error> {
        let kind = dataset.datatype().map_err(damaged)?;
        let Some(fields) = fields(&kind) else { return Ok(()) };
        let attributes = dataset.attrs().map_err(damaged)?;
        let matlab = self.matlab;
        // Text of MATLAB is stored as integers; so are truths.
        let class = text(&attributes, &["MATLAB_class"]);
        let number = |class: &str| {
            matches!(class.trim_start_matches('u'), "double" | "single" | "int8" | "int16" | "int32" | "int64")
        };
        if class.is_some_and(|class| !number(&class)) || attributes.contains_key("MATLAB_empty") {
            return Ok(());
        }
        let shape = dataset.shape().map_err(damaged)?;
        let sides: Vec<usize> = shape.iter().map(|side| usize::try_from(*side).unwrap_or(usize::MAX)).collect();
        let [rows, columns] = match *sides.as_slice() {
            [] => [1, 1],
            [rows] => [rows, 1],
            // MATLAB counts the rows first, and stores column by column.
            [columns, rows] if matlab => [rows, columns],
            [rows, columns] => [rows, columns],
            // More dimensions are no record.
            _ => return Ok(()),
        };
        let single = rows == 1 && columns == 1;
        if self.table.take(&[rows, columns, fields.len()])? == 0 {
            return Ok(());
        }
        let size = usize::try_from(dataset.element_size().map_err(damaged)?).unwrap_or(usize::MAX);
        self.bounded(dataset, path)?;
        let bytes = dataset.read_raw().map_err(|error| refuse(format!("HDF5 file, {path:?}: {error}")))?;
        if rows.checked_mul(columns).and_then(|count| count.checked_mul(size)) != Some(bytes.len()) {
            return Err(refuse(format!(
                "HDF5 file, {path:?}: {} bytes do not hold {rows} x {columns} numbers",
                bytes.len()
            )));
        }
        let mut found: Vec<Column> = match fields.as_slice() {
            [Field { name: None, number, big_endian, .. }] => {
                let naming = if matlab { Naming::Matlab } else { Naming::Python };
                let (number, big_endian) = (*number, *big_endian);
                Matrix { rows, columns, column_by_column: matlab, bytes: &bytes, number, big_endian }
                    .split(path, naming)
            }
            _ => fields.iter().map(|field| field.column(path, &bytes, size, rows * columns)).collect(),
        };
        if single {
            if let Some(Values::Float(values)) = found.first().map(|column| &column.values)
                && let Some(value) = values.first()
            {
                self.table.number(group, name, *value);
            }
            return Ok(());
        }
        let unit = text(&attributes, &["unit", "units", "unit_string"]);
        let interval = rate(&attributes);
        for column in &mut found {
            column.unit.clone_from(&unit);
            column.sampled_s = interval.map(|interval| [0.0, interval]);
            unpack(&mut column.values, &attributes);
        }
        self.table.extend(group, found);
        Ok(())
    }

    /// Refuses a chunk that would take more memory than all values that are allowed.
    fn bounded(&self, dataset: &Dataset, path: &str) -> Result<(), Error> {
        let Some(chunk) = dataset.chunk_shape().map_err(damaged)? else { return Ok(()) };
        let size = dataset.element_size().map_err(damaged)?;
        let bytes = chunk.iter().try_fold(size, |product, side| product.checked_mul(*side)).unwrap_or(u64::MAX);
        let most = self.table.most.saturating_mul(8).saturating_add(1 << 20) as u64;
        if bytes > most {
            return Err(refuse(format!("HDF5 file, {path:?}: its chunks of {bytes} bytes are beyond what is read")));
        }
        Ok(())
    }
}

/// A number in an element of a data set.
#[derive(Debug)]
struct Field {
    /// Where elements have several.
    name: Option<String>,
    offset: usize,
    number: Number,
    big_endian: bool,
}

impl Field {
    fn column(&self, path: &str, bytes: &[u8], size: usize, length: usize) -> Column {
        let name = self.name.as_ref().map_or_else(|| path.to_owned(), |name| format!("{path}.{name}"));
        column(name, None, self.number.placed(bytes, self.big_endian, self.offset, size, length))
    }
}

/// The numbers of an element; none where it is text or another thing.
fn fields(kind: &Datatype) -> Option<Vec<Field>> {
    if let Datatype::Compound { members, .. } = kind {
        let fields = members.iter().filter_map(|member| {
            let (number, big_endian) = number(&member.datatype)?;
            let offset = usize::try_from(member.byte_offset).ok()?;
            Some(Field { name: Some(member.name.clone()), offset, number, big_endian })
        });
        return Some(fields.collect::<Vec<_>>()).filter(|fields| !fields.is_empty());
    }
    number(kind).map(|(number, big_endian)| vec![Field { name: None, offset: 0, number, big_endian }])
}

fn number(kind: &Datatype) -> Option<(Number, bool)> {
    let (number, order) = match kind {
        Datatype::FixedPoint { size, byte_order, layout } => {
            let whole = layout.bit_offset == 0 && u64::from(layout.bit_precision) == 8 * u64::from(*size);
            (Number::integer((*size).into(), layout.signed).filter(|_| whole), byte_order)
        }
        Datatype::FloatingPoint { byte_order, layout, .. } => {
            let number = match *layout {
                FloatingPointLayout::IEEE754_BINARY32 => Some(Number::F32),
                FloatingPointLayout::IEEE754_BINARY64 => Some(Number::F64),
                _ => None,
            };
            (number, byte_order)
        }
        _ => (None, &DatatypeByteOrder::Vax),
    };
    match order {
        DatatypeByteOrder::LittleEndian => Some((number?, false)),
        DatatypeByteOrder::BigEndian => Some((number?, true)),
        DatatypeByteOrder::Vax => None,
    }
}

/// The text of the first of these attributes that there is, in any case of letters.
fn text(attributes: &Attributes, names: &[&str]) -> Option<String> {
    let found = names.iter().find_map(|wanted| {
        let mut same: Vec<_> = attributes.iter().filter(|(name, _)| name.eq_ignore_ascii_case(wanted)).collect();
        same.sort_unstable_by_key(|(name, _)| name.as_str());
        same.first().map(|(_, value)| *value)
    })?;
    let text = match found {
        AttrValue::String(text)
        | AttrValue::AsciiString(text)
        | AttrValue::VarLenString(text)
        | AttrValue::VarLenAsciiString(text) => text,
        AttrValue::StringSized { value, .. } | AttrValue::AsciiStringSized { value, .. } => value,
        AttrValue::StringArray(texts)
        | AttrValue::AsciiStringArray(texts)
        | AttrValue::VarLenStringArray(texts)
        | AttrValue::VarLenAsciiStringArray(texts) => texts.first()?,
        AttrValue::StringArraySized { values, .. } | AttrValue::AsciiStringArraySized { values, .. } => {
            values.first()?
        }
        _ => return None,
    };
    let text = text.trim_matches(['\0', ' ']);
    (!text.is_empty()).then(|| text.to_owned())
}

fn as_number(value: &AttrValue) -> Option<f64> {
    #[expect(clippy::cast_precision_loss, reason = "a rate is far below 2^53")]
    Some(match value {
        AttrValue::F64(value) => *value,
        AttrValue::F32(value) => (*value).into(),
        AttrValue::I64(value) => *value as f64,
        AttrValue::U64(value) => *value as f64,
        AttrValue::I32(value) => (*value).into(),
        AttrValue::U32(value) => (*value).into(),
        AttrValue::I16(value) => (*value).into(),
        AttrValue::U16(value) => (*value).into(),
        AttrValue::F64Array(values) if values.len() == 1 => values[0],
        AttrValue::F32Array(values) if values.len() == 1 => values[0].into(),
        AttrValue::I64Array(values) if values.len() == 1 => values[0] as f64,
        AttrValue::I32Array(values) if values.len() == 1 => values[0].into(),
        _ => return None,
    })
}

/// Seconds between samples by the attributes.
fn rate(attributes: &Attributes) -> Option<f64> {
    let mut names: Vec<&String> = attributes.keys().collect();
    names.sort_unstable();
    let mut told = None;
    for name in names {
        if let Some(interval) = as_number(&attributes[name]).and_then(|number| interval_s(name, number)) {
            told = Some(agreed(told, interval));
        }
    }
    told
}

/// Packed numbers by the CF conventions (NetCDF): times `scale_factor`, plus `add_offset`.
fn unpack(values: &mut Values, attributes: &Attributes) {
    let number = |name: &str| attributes.get(name).and_then(as_number);
    let (factor, offset) = (number("scale_factor"), number("add_offset"));
    if let (Values::Float(values), true) = (values, factor.or(offset).is_some()) {
        let (factor, offset) = (factor.unwrap_or(1.0), offset.unwrap_or(0.0));
        for value in values {
            *value = *value * factor + offset;
        }
    }
}
