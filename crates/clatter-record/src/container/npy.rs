//! NPY, the array file of NumPy: a header that is a Python dictionary, then the numbers.
//!
//! Source: NEP 1 and `numpy.lib.format`, versions 1 to 3.

use super::bytes::Bytes;
use super::number::Number;
use super::{Matrix, Naming, TableBuilder, column, refuse};
use crate::{Column, Error, Values};

const MAGIC: &[u8] = b"\x93NUMPY";
/// A hundred times what NumPy itself reads.
const LONGEST_HEADER: u32 = 1 << 20;

pub(super) fn read(bytes: &[u8], table: &mut TableBuilder) -> Result<(), Error> {
    let mut bytes = Bytes::new(bytes, "NPY file");
    bytes.take(MAGIC.len())?;
    let version = bytes.u8()?;
    bytes.u8()?;
    let length = match version {
        1 => u32::from(bytes.u16()?),
        2 | 3 => bytes.u32()?,
        other => return Err(refuse(format!("NPY file: version {other} is not known, 1 to 3 are"))),
    };
    if length > LONGEST_HEADER {
        return Err(refuse(format!("NPY file: a header of {length} bytes is damaged; {LONGEST_HEADER} are the most")));
    }
    let header = bytes.take_u64(length.into())?;
    let header = Header::read(header)?;
    let [rows, columns] = header.shape()?;
    let (fields, size) = header.fields()?;
    let values = table.take(&[rows, columns, fields.len()])?;
    // As many bytes as the header says: all of them are there, or the file is refused.
    let count = rows.checked_mul(columns).and_then(|count| count.checked_mul(size)).unwrap_or(usize::MAX);
    let data = bytes.take(count)?;
    if values == 0 {
        return Ok(());
    }
    if let [Field { name, element, .. }] = fields.as_slice()
        && name.is_empty()
        && element.tick_ns.is_none()
    {
        let Element { number, big_endian, .. } = *element;
        let column_by_column = header.fortran_order();
        let matrix = Matrix { rows, columns, column_by_column, bytes: data, number, big_endian };
        table.extend("", matrix.split("", Naming::None));
        return Ok(());
    }
    for field in fields {
        table.extend("", [field.column(data, size, rows * columns)?]);
    }
    Ok(())
}

/// A number of a row.
#[derive(Debug, Clone)]
struct Field {
    name: String,
    offset: usize,
    element: Element,
}

/// How a number is stored.
#[derive(Debug, Clone, Copy)]
struct Element {
    number: Number,
    big_endian: bool,
    /// Nanoseconds of one, where it is a time.
    tick_ns: Option<i64>,
}

impl Element {
    /// From a name such as `<f8`, `|i1`, `>M8[ns]`.
    fn named(text: &str) -> Result<Self, Error> {
        let not_known = || not_known(text);
        let (order, rest) = text.split_at_checked(1).ok_or_else(not_known)?;
        let (kind, size) = rest.split_at_checked(1).ok_or_else(not_known)?;
        let (size, tick) = match size.split_once('[') {
            Some((size, tick)) => (size, tick.strip_suffix(']')),
            None => (size, None),
        };
        let size: u64 = size.parse().map_err(|_| not_known())?;
        let number = match kind {
            "f" => Number::float(size),
            "i" | "M" | "m" => Number::integer(size, true),
            "u" | "b" => Number::integer(size, false),
            _ => None,
        };
        let tick_ns = match (kind, tick) {
            ("M" | "m", Some("s")) => Some(1_000_000_000),
            ("M" | "m", Some("ms")) => Some(1_000_000),
            ("M" | "m", Some("us")) => Some(1000),
            ("M" | "m", Some("ns")) => Some(1),
            ("M" | "m", _) => return Err(not_known()),
            _ => None,
        };
        Ok(Self { number: number.ok_or_else(not_known)?, big_endian: order == ">", tick_ns })
    }
}

impl Field {
    fn column(&self, data: &[u8], size: usize, length: usize) -> Result<Column, Error> {
        let Element { number, big_endian, tick_ns } = self.element;
        let values = number.placed(data, big_endian, self.offset, size, length);
        let Some(tick) = tick_ns else { return Ok(column(self.name.as_str(), None, values)) };
        let mut times = values.into_integers();
        for time in &mut times {
            // The smallest integer stands for no time at all.
            *time = time.checked_mul(tick).filter(|time| *time != i64::MIN).ok_or_else(|| {
                refuse(format!("NPY file: column {:?} holds a time that is none, or beyond 2262", self.name))
            })?;
        }
        Ok(column(self.name.as_str(), Some("ns".to_owned()), Values::Integer(times)))
    }
}

/// A literal of Python, as far as headers use them.
#[derive(Debug, PartialEq)]
enum Literal {
    Text(String),
    Whole(usize),
    Truth(bool),
    /// A list or a tuple.
    List(Vec<Literal>),
    Dictionary(Vec<(Literal, Literal)>),
}

#[derive(Debug)]
struct Header {
    entries: Vec<(Literal, Literal)>,
}

impl Header {
    fn read(bytes: &[u8]) -> Result<Self, Error> {
        let text = String::from_utf8_lossy(bytes);
        match literal(&mut text.trim_start(), 0) {
            Some(Literal::Dictionary(entries)) => Ok(Self { entries }),
            _ => Err(refuse("NPY file: its header is damaged, or is none of NumPy's")),
        }
    }
    fn entry(&self, key: &str) -> Option<&Literal> {
        self.entries.iter().find(|(name, _)| matches!(name, Literal::Text(name) if name == key)).map(|entry| &entry.1)
    }
    fn fortran_order(&self) -> bool {
        self.entry("fortran_order") == Some(&Literal::Truth(true))
    }
    /// Rows and columns; sides of length 1 in front do not count.
    fn shape(&self) -> Result<[usize; 2], Error> {
        let Some(Literal::List(sides)) = self.entry("shape") else {
            return Err(refuse("NPY file: its header has no \"shape\""));
        };
        let sides: Option<Vec<usize>> =
            sides.iter().map(|side| if let Literal::Whole(side) = side { Some(*side) } else { None }).collect();
        let sides = sides.ok_or_else(|| refuse("NPY file: the \"shape\" of its header is damaged"))?;
        match sides.as_slice() {
            [] => Ok([1, 1]),
            [rows] => Ok([*rows, 1]),
            [rows, columns] => Ok([*rows, *columns]),
            [front @ .., rows, columns] if front.iter().all(|side| *side == 1) => Ok([*rows, *columns]),
            other => {
                Err(refuse(format!("NPY file: an array of {} dimensions is no record; 1 or 2 are read", other.len())))
            }
        }
    }
    /// The numbers of a row, or the one number, and the bytes from one to the next.
    fn fields(&self) -> Result<(Vec<Field>, usize), Error> {
        let descr = self.entry("descr").ok_or_else(|| refuse("NPY file: its header has no \"descr\""))?;
        let (mut fields, mut size) = (Vec::new(), 0);
        flatten(descr, "", &mut size, &mut fields)?;
        Ok((fields, size))
    }
}

fn damaged() -> Error {
    refuse("NPY file: the \"descr\" of its header is damaged")
}

fn not_known(text: &str) -> Error {
    refuse(format!("NPY file: numbers of the type {text:?} are not read; save them as float64, float32 or int"))
}

/// Bytes of text and padding, which have a length and no numbers: `|V4`, `<U8` (4 bytes a letter).
fn skipped(text: &str) -> Option<Result<usize, Error>> {
    let each = match text.get(1..2)? {
        "V" | "S" => 1,
        "U" => 4,
        _ => return None,
    };
    let count = text.get(2..).and_then(|digits| digits.parse::<usize>().ok());
    Some(count.and_then(|count| count.checked_mul(each)).ok_or_else(|| not_known(text)))
}

/// How often a field stands in a row: the product of its shape.
fn repeats(shape: &[Literal]) -> Result<usize, Error> {
    let sides = match shape {
        [] => return Ok(1),
        [Literal::List(sides)] => sides.as_slice(),
        [side] => std::slice::from_ref(side),
        _ => return Err(damaged()),
    };
    sides.iter().try_fold(1_usize, |product, side| match side {
        Literal::Whole(side) => product.checked_mul(*side).ok_or_else(damaged),
        _ => Err(damaged()),
    })
}

/// More fields in a row are no record.
const MOST_FIELDS: usize = 10_000;

/// Adds the fields with numbers of a description, from byte `offset` of the row on.
fn flatten(descr: &Literal, name: &str, offset: &mut usize, fields: &mut Vec<Field>) -> Result<(), Error> {
    let too_many = || refuse(format!("NPY file: a row has more than {MOST_FIELDS} fields"));
    match descr {
        Literal::Text(text) => {
            if fields.len() == MOST_FIELDS {
                return Err(too_many());
            }
            let element = Element::named(text)?;
            fields.push(Field { name: name.to_owned(), offset: *offset, element });
            *offset = offset.checked_add(element.number.size()).ok_or_else(damaged)?;
        }
        Literal::List(list) => {
            for field in list {
                let Literal::List(field) = field else { return Err(damaged()) };
                let [own, descr, shape @ ..] = field.as_slice() else { return Err(damaged()) };
                let own = match own {
                    Literal::Text(own) => own,
                    // A title and a name.
                    Literal::List(names) => match names.as_slice() {
                        [_, Literal::Text(own)] => own,
                        _ => return Err(damaged()),
                    },
                    _ => return Err(damaged()),
                };
                let full = if name.is_empty() { own.clone() } else { format!("{name}.{own}") };
                let count = repeats(shape)?;
                if let Literal::Text(text) = descr
                    && let Some(size) = skipped(text)
                {
                    let size = size?.checked_mul(count).ok_or_else(damaged)?;
                    *offset = offset.checked_add(size).ok_or_else(damaged)?;
                    continue;
                }
                match (descr, shape) {
                    (_, []) => flatten(descr, &full, offset, fields)?,
                    (Literal::Text(_), _) if count <= MOST_FIELDS => {
                        for i in 0..count {
                            flatten(descr, &format!("{full}[{i}]"), offset, fields)?;
                        }
                    }
                    (Literal::Text(_), _) => return Err(too_many()),
                    _ => {
                        return Err(refuse(format!("NPY file: field {full:?} is an array of rows, which is not read")));
                    }
                }
            }
        }
        _ => return Err(damaged()),
    }
    Ok(())
}

/// Takes one literal off the front of the text. Lists in lists go 8 deep, more than any array of numbers needs.
fn literal(text: &mut &str, depth: usize) -> Option<Literal> {
    *text = text.trim_start();
    let first = text.chars().next()?;
    if depth > 8 {
        return None;
    }
    match first {
        '\'' | '"' => {
            let (inner, rest) = text[1..].split_once(first)?;
            *text = rest;
            Some(Literal::Text(inner.to_owned()))
        }
        '0'..='9' => {
            let end = text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
            let (digits, rest) = text.split_at(end);
            // Python 2 wrote `3L`.
            *text = rest.strip_prefix('L').unwrap_or(rest);
            digits.parse().ok().map(Literal::Whole)
        }
        '(' | '[' => {
            let close = if first == '(' { ')' } else { ']' };
            *text = &text[1..];
            let mut list = Vec::new();
            while !ended(text, close)? {
                list.push(literal(text, depth + 1)?);
                separated(text, close)?;
            }
            Some(Literal::List(list))
        }
        '{' => {
            *text = &text[1..];
            let mut entries = Vec::new();
            while !ended(text, '}')? {
                let key = literal(text, depth + 1)?;
                *text = text.trim_start().strip_prefix(':')?;
                entries.push((key, literal(text, depth + 1)?));
                separated(text, '}')?;
            }
            Some(Literal::Dictionary(entries))
        }
        _ => {
            let (truth, rest) = match (text.strip_prefix("True"), text.strip_prefix("False")) {
                (Some(rest), _) => (true, rest),
                (_, Some(rest)) => (false, rest),
                _ => return None,
            };
            *text = rest;
            Some(Literal::Truth(truth))
        }
    }
}

/// Returns whether the list ends here, which takes its bracket.
fn ended(text: &mut &str, close: char) -> Option<bool> {
    *text = text.trim_start();
    let next = text.chars().next()?;
    if next == close {
        *text = &text[1..];
    }
    Some(next == close)
}

/// Takes the comma after an entry, which the last one may lack.
fn separated(text: &mut &str, close: char) -> Option<()> {
    *text = text.trim_start();
    match text.strip_prefix(',') {
        Some(rest) => *text = rest,
        None if text.starts_with(close) => {}
        None => return None,
    }
    Some(())
}
