//! The columns that a schema of Arrow describes.

use super::damaged;
use crate::container::number::Number;
use crate::container::stored::Stored;
use crate::container::{column, refuse};
use crate::{Column, Error, Values};
use crate::{Field as WrittenField, FieldKind};
use polars_arrow_format::ipc::{self, Endianness, FieldRef, Precision, SchemaRef, TimeUnit, TypeRef, UnionMode};

/// Fields, those within fields too: more are no record.
const MOST_FIELDS: usize = 10_000;
/// Fields within fields.
const DEEPEST: usize = 32;

#[derive(Debug)]
pub(super) struct Schema {
    pub(super) fields: Vec<Field>,
    pub(super) big_endian: bool,
}

/// One top-level column.
#[derive(Debug)]
pub(super) struct Field {
    pub(super) name: String,
    unit: Option<String>,
    /// None for what holds no numbers.
    pub(super) stored: Option<Stored>,
    /// Buffers that it takes in a batch, those of its children too.
    pub(super) buffers: usize,
    /// Columns of views in it, whose number of buffers each batch tells.
    pub(super) variadic: usize,
}

impl Field {
    /// The column it becomes, where it holds numbers.
    pub(super) fn empty_column(&self) -> Option<Column> {
        let unit = self.stored?.unit().or_else(|| self.unit.clone());
        Some(column(self.name.as_str(), unit, Values::Float(Vec::new())))
    }
}

impl Schema {
    pub(super) fn read(schema: SchemaRef<'_>) -> Result<Self, Error> {
        let mut left = MOST_FIELDS;
        let fields = schema.fields().map_err(damaged)?.into_iter().flatten();
        let fields = fields.map(|field| read_field(field.map_err(damaged)?, &mut left)).collect::<Result<_, _>>()?;
        Ok(Self { fields, big_endian: schema.endianness().map_err(damaged)? == Endianness::Big })
    }
}

fn read_field(field: FieldRef<'_>, left: &mut usize) -> Result<Field, Error> {
    let name = field.name().map_err(damaged)?.unwrap_or_default().to_owned();
    let encoded = field.dictionary().map_err(damaged)?.is_some();
    let stored = match field.type_().map_err(damaged)? {
        Some(kind) if !encoded => numbers(&kind)?,
        _ => None,
    };
    let (buffers, variadic) = count(&field, left, 0)?;
    Ok(Field { unit: unit(&field)?, name, stored, buffers, variadic })
}

/// The unit that the metadata of a field give.
fn unit(field: &FieldRef<'_>) -> Result<Option<String>, Error> {
    for entry in field.custom_metadata().map_err(damaged)?.into_iter().flatten() {
        let entry = entry.map_err(damaged)?;
        let key = entry.key().map_err(damaged)?.unwrap_or_default();
        if key.eq_ignore_ascii_case("unit") || key.eq_ignore_ascii_case("units") {
            return Ok(entry.value().map_err(damaged)?.map(str::to_owned));
        }
    }
    Ok(None)
}

/// How the numbers of a type are stored; none for what holds no numbers.
fn numbers(kind: &TypeRef<'_>) -> Result<Option<Stored>, Error> {
    let time = |unit| {
        Some(Stored::Time(match unit {
            TimeUnit::Second => 1_000_000_000,
            TimeUnit::Millisecond => 1_000_000,
            TimeUnit::Microsecond => 1000,
            TimeUnit::Nanosecond => 1,
        }))
    };
    Ok(match kind {
        TypeRef::Int(int) => {
            let bits = u64::try_from(int.bit_width().map_err(damaged)?).unwrap_or_default();
            Number::integer(bits / 8, int.is_signed().map_err(damaged)?).map(Stored::Number)
        }
        TypeRef::FloatingPoint(float) => match float.precision().map_err(damaged)? {
            Precision::Single => Some(Stored::Number(Number::F32)),
            Precision::Double => Some(Stored::Number(Number::F64)),
            Precision::Half => None,
        },
        TypeRef::Timestamp(stamp) => time(stamp.unit().map_err(damaged)?),
        TypeRef::Duration(duration) => time(duration.unit().map_err(damaged)?),
        _ => None,
    })
}

/// Buffers that a field takes, and how many columns of views are in it.
fn count(field: &FieldRef<'_>, left: &mut usize, depth: usize) -> Result<(usize, usize), Error> {
    *left = left.checked_sub(1).filter(|_| depth < DEEPEST).ok_or_else(|| {
        refuse(format!(
            "Arrow file: more than {MOST_FIELDS} columns, or fields within fields {DEEPEST} deep, are no record"
        ))
    })?;
    let name = || field.name().ok().flatten().unwrap_or_default();
    if field.dictionary().map_err(damaged)?.is_some() {
        return Ok((2, 0));
    }
    let kind = field.type_().map_err(damaged)?;
    let kind = kind.ok_or_else(|| refuse(format!("Arrow file: column {:?} is of a type that is not known", name())))?;
    let mut buffers = match &kind {
        TypeRef::Null(_) | TypeRef::RunEndEncoded(_) => 0,
        TypeRef::Struct(_) | TypeRef::FixedSizeList(_) => 1,
        TypeRef::Union(union) => match union.mode().map_err(damaged)? {
            UnionMode::Sparse => 1,
            UnionMode::Dense => 2,
        },
        TypeRef::Utf8(_)
        | TypeRef::Binary(_)
        | TypeRef::LargeUtf8(_)
        | TypeRef::LargeBinary(_)
        | TypeRef::ListView(_)
        | TypeRef::LargeListView(_) => 3,
        _ => 2,
    };
    let mut variadic = usize::from(matches!(kind, TypeRef::Utf8View(_) | TypeRef::BinaryView(_)));
    for child in field.children().map_err(damaged)?.into_iter().flatten() {
        let (more, views) = count(&child.map_err(damaged)?, left, depth + 1)?;
        buffers += more;
        variadic += views;
    }
    Ok((buffers, variadic))
}

/// Names and units of the columns of a schema in a message, as Parquet files carry it.
pub(in crate::container) fn units(message: &[u8]) -> Result<Vec<(String, String)>, Error> {
    use ipc::planus::ReadAsRoot;
    // The mark and the length of the message may stand before it.
    let message = match message {
        [255, 255, 255, 255, _, _, _, _, rest @ ..] => rest,
        _ => message,
    };
    let message = ipc::MessageRef::read_as_root(message).map_err(damaged)?;
    let Some(ipc::MessageHeaderRef::Schema(schema)) = message.header().map_err(damaged)? else { return Ok(Vec::new()) };
    let mut units = Vec::new();
    for field in schema.fields().map_err(damaged)?.into_iter().flatten().take(MOST_FIELDS) {
        let field = field.map_err(damaged)?;
        if let (Some(name), Some(unit)) = (field.name().map_err(damaged)?, unit(&field)?) {
            units.push((name.to_owned(), unit));
        }
    }
    Ok(units)
}

/// The message of a schema: name, type and unit of each column.
pub(in crate::container) fn schema_message(fields: &[WrittenField]) -> Vec<u8> {
    let fields = fields.iter().map(|field| {
        let unit = ipc::KeyValue { key: Some("unit".to_owned()), value: Some(field.unit.clone()) };
        let type_ = match field.kind {
            FieldKind::Float | FieldKind::FloatOrNone => {
                ipc::Type::FloatingPoint(Box::new(ipc::FloatingPoint { precision: Precision::Double }))
            }
            FieldKind::Whole => ipc::Type::Int(Box::new(ipc::Int { bit_width: 64, is_signed: true })),
            FieldKind::Flag => ipc::Type::Bool(Box::new(ipc::Bool {})),
        };
        ipc::Field {
            name: Some(field.name.clone()),
            nullable: field.kind == FieldKind::FloatOrNone,
            type_: Some(type_),
            dictionary: None,
            children: Some(Vec::new()),
            custom_metadata: (!field.unit.is_empty()).then(|| vec![unit]),
        }
    });
    let schema = ipc::Schema {
        endianness: Endianness::Little,
        fields: Some(fields.collect()),
        custom_metadata: None,
        features: None,
    };
    let message = ipc::Message {
        version: ipc::MetadataVersion::V5,
        header: Some(ipc::MessageHeader::Schema(Box::new(schema))),
        body_length: 0,
        custom_metadata: None,
    };
    let mut builder = ipc::planus::Builder::new();
    let message = builder.finish(message, None);
    // Filled up to 8 bytes, behind the mark and the length.
    let length = message.len().next_multiple_of(8);
    let mut bytes = vec![255; 4];
    bytes.extend(u32::try_from(length).unwrap_or(u32::MAX).to_le_bytes());
    bytes.extend_from_slice(message);
    bytes.resize(8 + length, 0);
    bytes
}
