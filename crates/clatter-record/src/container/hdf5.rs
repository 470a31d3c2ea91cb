//! HDF5, and MATLAB 7.3, which is HDF5 with the sides of a matrix exchanged.
//!
//! A column goes by the path of its data set. Attributes of a data set, or of a group it lies in,
//! give its unit and its rate.

use super::number::{Number, number, numbers};
use super::{COMPLEX, Matrix, Naming, TableBuilder, agreed, by_column, column, interval_s, refuse, sparse};
use crate::{Column, Error, Values};
use hdf5_pure::{
    AttrValue, CompoundMember, Dataset, Datatype, DatatypeByteOrder, EnumMember, File, FloatingPointLayout, Group,
    VlenStringReadOptions,
};
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
            let attributes = group.attrs().map_err(damaged)?;
            match attributes.get("MATLAB_sparse").and_then(as_number) {
                Some(rows) => self.sparse(&group, &attributes, rows, &full(&name))?,
                None => self.group(&group, &full(&name), depth + 1)?,
            }
        }
        Ok(())
    }

    /// Adds the columns of a sparse matrix, which is a group.
    fn sparse(&mut self, group: &Group, attributes: &Attributes, rows: f64, path: &str) -> Result<(), Error> {
        let mut parts: HashMap<String, Dataset> = group.iter_datasets().map_err(damaged)?.collect();
        let mut part = |name: &str| -> Result<Option<Values>, Error> {
            // A matrix of zeros lacks some.
            let Some(dataset) = parts.remove(name) else { return Ok(Some(Values::Float(Vec::new()))) };
            let kind = dataset.datatype().map_err(damaged)?;
            let Ok(Element::Number(number, big_endian)) = element(&kind) else { return Ok(None) };
            Ok(Some(number.values(&self.bytes(&dataset, path)?, big_endian)))
        };
        let (places, starts, numbers) = (part("ir")?, part("jc")?, part("data")?);
        let truths = text(attributes, &["MATLAB_class"]).is_some_and(|class| class == "logical");
        match (places, starts, numbers) {
            (Some(places), Some(starts), Some(numbers)) if !truths => {
                let [places, starts] = [places, starts].map(Values::into_integers);
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a number of rows")]
                let size = [rows as usize, starts.len().saturating_sub(1)];
                sparse(path, size, by_column(&places, &starts, &numbers), self.table)
            }
            _ => {
                self.table.leave_out(path, if truths { "truths" } else { COMPLEX });
                Ok(())
            }
        }
    }

    /// Adds the columns of a data set, or a single number; or names it.
    fn dataset(&mut self, dataset: &Dataset, group: &str, name: &str, path: &str) -> Result<(), Error> {
        let kind = dataset.datatype().map_err(damaged)?;
        let attributes = dataset.attrs().map_err(damaged)?;
        let matlab = self.matlab;
        // Text of MATLAB is stored as integers; so are truths.
        let class = text(&attributes, &["MATLAB_class"]);
        let other = match class.as_deref().map(|class| class.trim_start_matches('u')) {
            None | Some("double" | "single" | "int8" | "int16" | "int32" | "int64") => None,
            Some("char") => Some("text".to_owned()),
            Some("logical") => Some("truths".to_owned()),
            Some("cell") => Some("cells".to_owned()),
            Some(class) => Some(format!("of class {class} of MATLAB")),
        };
        let shape = dataset.shape().map_err(damaged)?;
        let mut sides: Vec<usize> = shape.iter().map(|side| usize::try_from(*side).unwrap_or(usize::MAX)).collect();
        if sides.len() > 2 {
            sides.retain(|side| *side != 1);
        }
        let [rows, columns] = match *sides.as_slice() {
            [] => [1, 1],
            [rows] => [rows, 1],
            // MATLAB counts the rows first, and stores column by column.
            [columns, rows] if matlab => [rows, columns],
            [rows, columns] => [rows, columns],
            // More dimensions are no record.
            _ => [0, 0],
        };
        let single = rows == 1 && columns == 1;
        let other = other.or_else(|| (sides.len() > 2).then(|| format!("of {} dimensions", sides.len())));
        let is_empty = rows == 0 || columns == 0 || attributes.contains_key("MATLAB_empty");
        let other = other.or_else(|| is_empty.then(|| "empty".to_owned()));
        if let Some(what) = other {
            self.table.leave_out(path, what);
            return Ok(());
        }
        let mut fields = Vec::new();
        flatten(&kind, path, 0, &mut fields);
        for field in &fields {
            if let Err(what) = &field.element {
                self.table.leave_out(&field.name, what);
            }
        }
        fields.retain(|field| field.element.is_ok());
        if fields.is_empty() {
            return Ok(());
        }
        let mut found = self.columns(dataset, path, [rows, columns], &fields)?;
        if single {
            for column in found {
                let own = column.name.strip_prefix(path).filter(|own| !own.is_empty()).unwrap_or(name);
                self.table.number(group, own.trim_start_matches('.'), &column.name, column.values.float(0));
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

    /// The columns of a data set. Text that is no number is named.
    fn columns(
        &mut self,
        dataset: &Dataset,
        path: &str,
        [rows, columns]: [usize; 2],
        fields: &[Field],
    ) -> Result<Vec<Column>, Error> {
        let count = self.table.take(&[rows, columns, fields.len()])?;
        let size = usize::try_from(dataset.element_size().map_err(damaged)?).unwrap_or(usize::MAX);
        let bytes = self.bytes(dataset, path)?;
        // A space of no numbers has no sides, as that of one number has.
        if bytes.is_empty() {
            self.table.left += count;
            self.table.leave_out(path, "empty");
            return Ok(Vec::new());
        }
        if rows.checked_mul(columns).and_then(|count| count.checked_mul(size)) != Some(bytes.len()) {
            return Err(refuse(format!(
                "HDF5 file, {path:?}: {} bytes do not hold {rows} x {columns} numbers",
                bytes.len()
            )));
        }
        let naming = if self.matlab { Naming::Matlab } else { Naming::Python };
        let matrix = |bytes: &[u8], number, big_endian| {
            Matrix { rows, columns, column_by_column: self.matlab, bytes, number, big_endian }.split(path, naming)
        };
        let mut found = Vec::new();
        for Field { name, offset, element } in fields {
            match element {
                Ok(Element::Number(number, big_endian)) if name == path => {
                    found.extend(matrix(&bytes, *number, *big_endian));
                }
                Ok(Element::Number(number, big_endian)) => {
                    found.push(column(name, None, number.placed(&bytes, *big_endian, *offset, size, rows * columns)));
                }
                Ok(text) => {
                    let texts = || bytes.chunks(size.max(1)).filter_map(|row| row.get(*offset..));
                    let numbers = match text {
                        Element::Text(length) => numbers(texts().map(|row| row.get(..*length).unwrap_or_default())),
                        _ => long_texts(dataset, count),
                    };
                    match numbers {
                        Some(numbers) if name == path => {
                            let bytes: Vec<u8> = numbers.into_iter().flat_map(f64::to_le_bytes).collect();
                            found.extend(matrix(&bytes, Number::F64, false));
                        }
                        Some(numbers) => found.push(column(name, None, Values::Float(numbers))),
                        None => {
                            self.table.left += rows * columns;
                            self.table.leave_out(name, "text");
                        }
                    }
                }
                Err(_) => {}
            }
        }
        Ok(found)
    }

    /// The bytes of a data set. All of them, and those of a chunk, are bounded by the values that are allowed.
    fn bytes(&self, dataset: &Dataset, path: &str) -> Result<Vec<u8>, Error> {
        let size = dataset.element_size().map_err(damaged)?;
        let product = |sides: &[u64]| sides.iter().try_fold(size, |product, side| product.checked_mul(*side));
        let chunk = dataset.chunk_shape().map_err(damaged)?;
        let most = self.table.most as u64;
        let chunk_fits = chunk.is_none_or(|chunk| {
            product(&chunk).is_some_and(|bytes| bytes <= most.saturating_mul(8).saturating_add(1 << 20))
        });
        let fits = product(&dataset.shape().map_err(damaged)?)
            .is_some_and(|bytes| bytes <= most.saturating_mul(LONGEST_TEXT.into()));
        if !fits || !chunk_fits {
            return Err(refuse(format!(
                "HDF5 file, {path:?}: its numbers, or a chunk of them, take more bytes than are read"
            )));
        }
        dataset.read_raw().map_err(|error| refuse(format!("HDF5 file, {path:?}: {error}")))
    }
}

/// A number in an element of a data set, or why it is none.
#[derive(Debug)]
struct Field {
    name: String,
    offset: usize,
    element: Result<Element, &'static str>,
}

/// How a number is stored.
#[derive(Debug, Clone, Copy)]
enum Element {
    /// And whether it is big-endian.
    Number(Number, bool),
    /// As text of so many bytes.
    Text(usize),
    /// As text of any length, which lies elsewhere in the file.
    LongText,
}

/// Bytes of the text of a number.
const LONGEST_TEXT: u32 = 64;
/// Elements in an element: more are no record.
const MOST_FIELDS: usize = 1000;

/// Adds what an element holds, from byte `offset` of it on.
fn flatten(kind: &Datatype, name: &str, offset: usize, fields: &mut Vec<Field>) {
    let parts: Vec<(String, usize, &Datatype)> = match kind {
        Datatype::Compound { members, .. } if !is_complex(members) => {
            let at = |member: &CompoundMember| usize::try_from(member.byte_offset).unwrap_or(usize::MAX);
            members.iter().map(|member| (format!("{name}.{}", member.name), at(member), &member.datatype)).collect()
        }
        Datatype::Array { base_type, dimensions } => {
            let count = dimensions.iter().try_fold(1_usize, |product, side| product.checked_mul(*side as usize));
            let size = base_type.type_size() as usize;
            let count = count.filter(|count| *count <= MOST_FIELDS).unwrap_or(0);
            (0..count).map(|i| (format!("{name}[{i}]"), i.saturating_mul(size), &**base_type)).collect()
        }
        _ => Vec::new(),
    };
    if parts.is_empty() || fields.len() + parts.len() > MOST_FIELDS {
        fields.push(Field { name: name.to_owned(), offset, element: element(kind) });
    } else {
        for (name, at, kind) in parts {
            flatten(kind, &name, offset.saturating_add(at), fields);
        }
    }
}

/// Complex numbers, as h5py and MATLAB store them.
fn is_complex(members: &[CompoundMember]) -> bool {
    let names: Vec<&str> = members.iter().map(|member| member.name.as_str()).collect();
    matches!(names[..], ["r", "i"] | ["real", "imag"])
}

/// How a type keeps a number; else what it is.
fn element(kind: &Datatype) -> Result<Element, &'static str> {
    let unknown = "numbers of a kind that is not known";
    let (number, order) = match kind {
        Datatype::FixedPoint { size, byte_order, layout } => {
            let whole = layout.bit_offset == 0 && u64::from(layout.bit_precision) == 8 * u64::from(*size);
            (Number::integer((*size).into(), layout.signed).filter(|_| whole), byte_order)
        }
        Datatype::FloatingPoint { size, byte_order, layout } => {
            let FloatingPointLayout { exponent_size: exponent, mantissa_size: fraction, .. } = *layout;
            let size = u8::try_from(*size).ok().filter(|size| *size <= 16);
            // As IEEE 754 has them, in other widths too.
            let is_plain = (layout.bit_offset, layout.mantissa_location, layout.exponent_location) == (0, 0, fraction)
                && (2..=15).contains(&exponent)
                && (2..=112).contains(&fraction)
                && layout.exponent_bias == (1 << (exponent - 1)) - 1
                && size.is_some_and(|size| 8 * u16::from(size) > u16::from(exponent) + u16::from(fraction));
            let number = match *layout {
                FloatingPointLayout::IEEE754_BINARY32 => Some(Number::F32),
                FloatingPointLayout::IEEE754_BINARY64 => Some(Number::F64),
                _ => size.filter(|_| is_plain).map(|size| Number::Float(size, exponent, fraction)),
            };
            (number, byte_order)
        }
        Datatype::String { size, .. } if *size > LONGEST_TEXT => return Err("text"),
        Datatype::String { size, .. } => return Ok(Element::Text(*size as usize)),
        Datatype::VariableLength { is_string: true, .. } => return Ok(Element::LongText),
        Datatype::VariableLength { .. } => return Err("lists"),
        Datatype::Array { .. } => return Err("arrays"),
        Datatype::Compound { members, .. } if is_complex(members) => return Err(COMPLEX),
        Datatype::Compound { .. } => return Err("a structure"),
        Datatype::Enumeration { members, .. } => {
            let is_truth = |member: &EnumMember| matches!(member.name.as_str(), "TRUE" | "FALSE");
            return Err(if members.iter().all(is_truth) { "truths" } else { "of an enumeration" });
        }
        Datatype::Reference { .. } => return Err("references"),
        Datatype::Opaque { .. } | Datatype::BitField { .. } => return Err("bytes"),
        _ => return Err(unknown),
    };
    match (number, order) {
        (Some(number), DatatypeByteOrder::LittleEndian) => Ok(Element::Number(number, false)),
        (Some(number), DatatypeByteOrder::BigEndian) => Ok(Element::Number(number, true)),
        _ => Err(unknown),
    }
}

/// The numbers of a data set of texts that lie elsewhere; none where one is no number, or they take more bytes than numbers do.
fn long_texts(dataset: &Dataset, count: usize) -> Option<Vec<f64>> {
    let most = VlenStringReadOptions::new().with_max_elements(count).with_max_payload_bytes(count.saturating_mul(32));
    let mut all = Vec::with_capacity(count);
    dataset.visit_vlen_strings(most, |text| all.push(number(text.as_bytes()))).ok()?;
    let numbers = all.into_iter().collect::<Option<Vec<f64>>>()?;
    numbers.iter().any(|number| !number.is_nan()).then_some(numbers)
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

/// The numbers of an attribute.
fn as_numbers(value: &AttrValue) -> Vec<f64> {
    macro_rules! floats {
        ($values:expr) => {
            $values.iter().map(|value| f64::from(*value)).collect()
        };
    }
    #[expect(clippy::cast_precision_loss, reason = "a rate is far below 2^53")]
    match value {
        AttrValue::F64(value) => vec![*value],
        AttrValue::F32(value) => vec![f64::from(*value)],
        AttrValue::I64(value) => vec![*value as f64],
        AttrValue::U64(value) => vec![*value as f64],
        AttrValue::I32(value) => vec![f64::from(*value)],
        AttrValue::U32(value) => vec![f64::from(*value)],
        AttrValue::I16(value) => vec![f64::from(*value)],
        AttrValue::U16(value) => vec![f64::from(*value)],
        AttrValue::I8(value) => vec![f64::from(*value)],
        AttrValue::U8(value) => vec![f64::from(*value)],
        AttrValue::F64Array(values) => values.clone(),
        AttrValue::F32Array(values) => floats!(values),
        AttrValue::I64Array(values) => values.iter().map(|value| *value as f64).collect(),
        AttrValue::U64Array(values) => values.iter().map(|value| *value as f64).collect(),
        AttrValue::I32Array(values) => floats!(values),
        AttrValue::U32Array(values) => floats!(values),
        AttrValue::I16Array(values) => floats!(values),
        AttrValue::U16Array(values) => floats!(values),
        AttrValue::I8Array(values) => floats!(values),
        AttrValue::U8Array(values) => floats!(values),
        _ => Vec::new(),
    }
}

fn as_number(value: &AttrValue) -> Option<f64> {
    if let [number] = as_numbers(value)[..] { Some(number) } else { None }
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

/// Packed numbers by the CF conventions (NetCDF): those that stand for a missing one are none, others times `scale_factor`,
/// plus `add_offset`.
fn unpack(values: &mut Values, attributes: &Attributes) {
    let number = |name: &str| attributes.get(name).and_then(as_number);
    let (factor, offset) = (number("scale_factor"), number("add_offset"));
    let fills = ["_FillValue", "missing_value"].map(|name| attributes.get(name).map(as_numbers).unwrap_or_default());
    let fills = fills.concat();
    #[expect(clippy::cast_possible_truncation, clippy::float_cmp, reason = "the same number, single or double")]
    let is_fill = |value: f64| fills.iter().any(|fill| value == *fill || value == f64::from(*fill as f32));
    if let Values::Integer(integers) = &values
        && (0..integers.len()).any(|row| is_fill(values.float(row)))
    {
        *values = Values::Float(std::mem::replace(values, Values::Float(Vec::new())).into_floats());
    }
    if let Values::Float(values) = values {
        let (factor, offset, is_packed) = (factor.unwrap_or(1.0), offset.unwrap_or(0.0), factor.or(offset).is_some());
        for value in values {
            if is_fill(*value) {
                *value = f64::NAN;
            } else if is_packed {
                *value = *value * factor + offset;
            }
        }
    }
}
