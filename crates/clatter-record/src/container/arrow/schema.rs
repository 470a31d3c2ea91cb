//! The columns that a schema of Arrow describes.

use super::damaged;
use crate::container::number::{HALF, Number};
use crate::container::stored::Stored;
use crate::container::{TableBuilder, refuse};
use crate::{Error, Values};
use crate::{Field as WrittenField, FieldKind};
use polars_arrow_format::ipc::{
    self, Endianness, FieldRef, IntRef, Precision, SchemaRef, TimeUnit, TypeRef, UnionMode,
};
use std::collections::HashMap;

/// Fields, those within fields too: more are no record.
const MOST_FIELDS: usize = 10_000;
/// Fields within fields.
const DEEPEST: usize = 32;

#[derive(Debug)]
pub(super) struct Schema {
    pub(super) fields: Vec<Field>,
    pub(super) big_endian: bool,
}

/// A column, or a structure of columns.
#[derive(Debug)]
pub(super) struct Field {
    /// With those of the structures it lies in.
    pub(super) name: String,
    unit: Option<String>,
    pub(super) kept: Kept,
    /// The dictionary in which its numbers are, and how places in it are stored.
    pub(super) dictionary: Option<(i64, Number)>,
    /// Its numbers so far; else why it has none.
    pub(super) values: Result<Values, String>,
    /// Buffers that it takes in a batch, those of its children too.
    pub(super) buffers: usize,
    /// Columns of views in it, whose number of buffers each batch tells.
    pub(super) variadic: usize,
}

/// How a column is kept.
#[derive(Debug)]
pub(super) enum Kept {
    Stored(Stored),
    /// Texts behind each other, and their ends in so many bytes each.
    Texts(Number),
    /// Texts in several buffers, the short ones beside their lengths.
    Views,
    Structure(Vec<Field>),
    /// What holds no numbers.
    Nothing,
}

impl Schema {
    pub(super) fn read(schema: SchemaRef<'_>) -> Result<Self, Error> {
        let mut left = MOST_FIELDS;
        let fields = schema.fields().map_err(damaged)?.into_iter().flatten();
        let fields =
            fields.map(|field| read_field(field.map_err(damaged)?, "", &mut left)).collect::<Result<_, _>>()?;
        Ok(Self { fields, big_endian: schema.endianness().map_err(damaged)? == Endianness::Big })
    }
}

impl Field {
    /// Adds the columns it becomes to the table, or names it.
    pub(super) fn finish(self, table: &mut TableBuilder) {
        let unit = if let Kept::Stored(stored) = self.kept { stored.unit() } else { None };
        match (self.kept, self.values) {
            (Kept::Structure(fields), _) if !fields.is_empty() => {
                for field in fields {
                    field.finish(table);
                }
            }
            (Kept::Texts(_) | Kept::Views, Ok(Values::Float(all))) if all.iter().all(|number| number.is_nan()) => {
                table.add(&self.name, None, Err("text".to_owned()));
            }
            (_, values) => table.add(&self.name, unit.or(self.unit), values),
        }
    }
}

fn read_field(field: FieldRef<'_>, above: &str, left: &mut usize) -> Result<Field, Error> {
    let own = field.name().map_err(damaged)?.unwrap_or_default();
    let name = if above.is_empty() { own.to_owned() } else { format!("{above}.{own}") };
    let (buffers, variadic) = count(&field, left, 0)?;
    let kind = field.type_().map_err(damaged)?;
    let encoded = field.dictionary().map_err(damaged)?;
    let mut values = Ok(Values::Float(Vec::new()));
    let kept = match &kind {
        Some(TypeRef::Utf8(_)) => Kept::Texts(Number::I32),
        Some(TypeRef::LargeUtf8(_)) => Kept::Texts(Number::I64),
        Some(TypeRef::Utf8View(_)) => Kept::Views,
        Some(TypeRef::Struct(_)) if encoded.is_none() => {
            let children = field.children().map_err(damaged)?.into_iter().flatten();
            // They have been counted.
            let mut left = MOST_FIELDS;
            let children = children.map(|child| read_field(child.map_err(damaged)?, &name, &mut left));
            values = Err("a structure without members".to_owned());
            Kept::Structure(children.collect::<Result<_, _>>()?)
        }
        Some(kind) => match numbers(kind)? {
            Ok(stored) => Kept::Stored(stored),
            Err(what) => {
                values = Err(what.to_owned());
                Kept::Nothing
            }
        },
        // Refused when it was counted.
        None => Kept::Nothing,
    };
    let dictionary = match encoded {
        Some(encoding) => {
            let places = encoding.index_type().map_err(damaged)?.map_or(Ok(Some(Number::I32)), |int| integer(&int))?;
            Some((encoding.id().map_err(damaged)?, places.unwrap_or(Number::I32)))
        }
        None => None,
    };
    Ok(Field { unit: unit(&field)?, name, kept, dictionary, values, buffers, variadic })
}

fn integer(int: &IntRef<'_>) -> Result<Option<Number>, Error> {
    let bits = u64::try_from(int.bit_width().map_err(damaged)?).unwrap_or_default();
    Ok(Number::integer(bits / 8, int.is_signed().map_err(damaged)?))
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

fn tick_ns(unit: TimeUnit) -> i64 {
    match unit {
        TimeUnit::Second => 1_000_000_000,
        TimeUnit::Millisecond => 1_000_000,
        TimeUnit::Microsecond => 1000,
        TimeUnit::Nanosecond => 1,
    }
}

/// How the numbers of a type are stored; else what it is.
fn numbers(kind: &TypeRef<'_>) -> Result<Result<Stored, &'static str>, Error> {
    let unknown = Err("of a type that is not known");
    Ok(match kind {
        TypeRef::Int(int) => integer(int)?.map(Stored::Number).map_or(unknown, Ok),
        TypeRef::FloatingPoint(float) => Ok(Stored::Number(match float.precision().map_err(damaged)? {
            Precision::Single => Number::F32,
            Precision::Double => Number::F64,
            Precision::Half => HALF,
        })),
        TypeRef::Decimal(decimal) => match (decimal.bit_width().map_err(damaged)?, decimal.scale().map_err(damaged)?) {
            (bits @ (32 | 64 | 128 | 256), scale) => {
                let bytes = u8::try_from(bits / 8).unwrap_or_default();
                Ok(Stored::Number(Number::Decimal { bytes, scale, big_endian: false }))
            }
            _ => unknown,
        },
        TypeRef::Timestamp(stamp) => Ok(Stored::Time(Number::I64, tick_ns(stamp.unit().map_err(damaged)?))),
        TypeRef::Duration(duration) => Ok(Stored::Time(Number::I64, tick_ns(duration.unit().map_err(damaged)?))),
        TypeRef::Time(time) => {
            let number = if time.bit_width().map_err(damaged)? == 32 { Number::I32 } else { Number::I64 };
            Ok(Stored::Time(number, tick_ns(time.unit().map_err(damaged)?)))
        }
        TypeRef::Date(_) => Err("dates"),
        TypeRef::Bool(_) => Err("truths"),
        TypeRef::Null(_) => Err("without values"),
        TypeRef::Binary(_) | TypeRef::LargeBinary(_) | TypeRef::FixedSizeBinary(_) | TypeRef::BinaryView(_) => {
            Err("bytes")
        }
        TypeRef::List(_)
        | TypeRef::LargeList(_)
        | TypeRef::FixedSizeList(_)
        | TypeRef::ListView(_)
        | TypeRef::LargeListView(_)
        | TypeRef::Map(_) => Err("a list"),
        TypeRef::Struct(_) => Err("a structure"),
        TypeRef::Union(_) => Err("a union"),
        TypeRef::Interval(_) => Err("a calendar interval"),
        _ => unknown,
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

/// What a schema tells of a column beyond its numbers.
#[derive(Debug, Clone, Default)]
pub(in crate::container) struct ArrowTime {
    pub(in crate::container) unit: Option<String>,
    /// Nanoseconds of one, where it is a duration.
    pub(in crate::container) tick_ns: Option<i64>,
}

/// What a schema in a message, as Parquet files carry it, tells of the columns by their names.
pub(in crate::container) fn told(message: &[u8]) -> Result<HashMap<String, ArrowTime>, Error> {
    use ipc::planus::ReadAsRoot;
    // The mark and the length of the message may stand before it.
    let message = match message {
        [255, 255, 255, 255, _, _, _, _, rest @ ..] => rest,
        _ => message,
    };
    let message = ipc::MessageRef::read_as_root(message).map_err(damaged)?;
    let mut told = HashMap::new();
    if let Some(ipc::MessageHeaderRef::Schema(schema)) = message.header().map_err(damaged)? {
        for field in schema.fields().map_err(damaged)?.into_iter().flatten() {
            tell(&field.map_err(damaged)?, "", 0, &mut told)?;
        }
    }
    Ok(told)
}

/// Adds a field, and those of a structure.
fn tell(field: &FieldRef<'_>, above: &str, depth: usize, told: &mut HashMap<String, ArrowTime>) -> Result<(), Error> {
    let own = field.name().map_err(damaged)?.unwrap_or_default();
    let name = if above.is_empty() { own.to_owned() } else { format!("{above}.{own}") };
    if told.len() > MOST_FIELDS || depth > DEEPEST {
        return Ok(());
    }
    for child in field.children().map_err(damaged)?.into_iter().flatten() {
        tell(&child.map_err(damaged)?, &name, depth + 1, told)?;
    }
    let tick_ns = match field.type_().map_err(damaged)? {
        Some(TypeRef::Duration(duration)) => Some(tick_ns(duration.unit().map_err(damaged)?)),
        _ => None,
    };
    told.insert(name, ArrowTime { unit: unit(field)?, tick_ns });
    Ok(())
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
