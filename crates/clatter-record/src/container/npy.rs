//! NPY, the array file of NumPy: a header that is a Python dictionary, then the numbers.
//!
//! Source: NEP 1 and `numpy.lib.format`, versions 1 to 3.

use super::bytes::Bytes;
use super::number::{Number, numbers};
use super::{COMPLEX, Matrix, Naming, TableBuilder, column, refuse};
use crate::{Error, Values};

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
    // As many bytes as the header says: all of them are there, or the file is refused.
    let count = rows.checked_mul(columns).and_then(|count| count.checked_mul(size)).unwrap_or(usize::MAX);
    let data = bytes.take(count)?;
    let length = rows.saturating_mul(columns);
    for Field { name, offset, element } in fields {
        let shown = if name.is_empty() { "array" } else { name.as_str() };
        let (big_endian, kept) = match element {
            Ok(element) if length > 0 => element,
            other => {
                table.leave_out(shown, other.err().unwrap_or("empty"));
                continue;
            }
        };
        let whole = name.is_empty();
        let matrix = |bytes: &[u8], number, column_by_column, big_endian| {
            Matrix { rows, columns, column_by_column, bytes, number, big_endian }.split("", Naming::None)
        };
        let order = header.fortran_order();
        table.take(&[rows, columns])?;
        let found = match kept {
            Element::Number(number) if whole => matrix(data, number, order, big_endian),
            Element::Number(number) => {
                vec![column(name, None, number.placed(data, big_endian, offset, size, length))]
            }
            Element::Time(number, tick) => {
                let values = number.placed(data, big_endian, offset, size, length);
                vec![column(name.as_str(), Some("ns".to_owned()), times(values, tick, &name)?)]
            }
            Element::Text(letters, each) => {
                let rows =
                    data.chunks(size.max(1)).filter_map(|row| row.get(offset..offset.checked_add(letters * each)?));
                let Some(values) = numbers(rows.map(|text| narrow(text, each, big_endian))) else {
                    table.left += length;
                    table.leave_out(shown, "text");
                    continue;
                };
                if whole {
                    let bytes: Vec<u8> = values.into_iter().flat_map(f64::to_le_bytes).collect();
                    matrix(&bytes, Number::F64, order, false)
                } else {
                    vec![column(name, None, Values::Float(values))]
                }
            }
        };
        table.extend("", found);
    }
    Ok(())
}

/// A part of a row.
#[derive(Debug, Clone)]
struct Field {
    /// Empty for an array that is no table.
    name: String,
    offset: usize,
    element: Kept,
}

/// Whether it is big-endian, and how a number is stored; else what it is.
type Kept = Result<(bool, Element), &'static str>;

/// How a number is stored.
#[derive(Debug, Clone, Copy)]
enum Element {
    Number(Number),
    /// In ticks of so many nanoseconds.
    Time(Number, i64),
    /// So many letters of so many bytes.
    Text(usize, usize),
}

/// The element of a name such as `<f8`, `|i1`, `>M8[ns]`, and its bytes.
fn element(text: &str) -> Result<(Kept, usize), Error> {
    let not_known = || not_known(text);
    let (order, rest) = text.split_at_checked(1).ok_or_else(not_known)?;
    let (kind, size) = rest.split_at_checked(1).ok_or_else(not_known)?;
    let (size, tick) = match size.split_once('[') {
        Some((size, tick)) => (size, tick.strip_suffix(']')),
        None => (size, None),
    };
    let size: usize = size.parse().map_err(|_| not_known())?;
    let number = match kind {
        "f" => Number::float(size as u64),
        "i" | "M" | "m" => Number::integer(size as u64, true),
        "u" => Number::integer(size as u64, false),
        _ => None,
    };
    let tick_ns = match (kind, tick) {
        ("m", Some("D")) => Some(86_400_000_000_000),
        ("m", Some("h")) => Some(3_600_000_000_000),
        ("m", Some("m")) => Some(60_000_000_000),
        (_, Some("s")) => Some(1_000_000_000),
        (_, Some("ms")) => Some(1_000_000),
        (_, Some("us")) => Some(1000),
        (_, Some("ns")) => Some(1),
        _ => None,
    };
    let letter = if kind == "U" { 4 } else { 1 };
    let bytes = size.checked_mul(letter).ok_or_else(not_known)?;
    let element = match (kind, number, tick_ns) {
        ("M" | "m", Some(number), Some(tick)) => Ok(Element::Time(number, tick)),
        ("M" | "m", Some(_), None) => Err("times in a unit that is not read; save them in ns"),
        (_, Some(number), _) => Ok(Element::Number(number)),
        ("S" | "U", ..) => Ok(Element::Text(size, letter)),
        ("b", ..) => Err("truths"),
        ("c", ..) => Err(COMPLEX),
        ("V", ..) => Err("bytes"),
        // It is another one on other machines.
        ("f", ..) => Err("a long double; save it as float64"),
        _ => return Err(not_known()),
    };
    Ok((element.map(|element| (order == ">", element)), bytes))
}

/// Nanoseconds from times in ticks.
fn times(values: Values, tick_ns: i64, name: &str) -> Result<Values, Error> {
    let mut times = values.into_integers();
    for time in &mut times {
        // The smallest integer stands for no time at all.
        *time = time
            .checked_mul(tick_ns)
            .filter(|time| *time != i64::MIN)
            .ok_or_else(|| refuse(format!("NPY file: column {name:?} holds a time that is none, or beyond 2262")))?;
    }
    Ok(Values::Integer(times))
}

/// A text of letters of so many bytes, with a question mark for one that no number has.
fn narrow(text: &[u8], letter: usize, big_endian: bool) -> Vec<u8> {
    if letter == 1 {
        return text.to_vec();
    }
    let codes = Number::U32.values(text, big_endian).into_integers();
    codes.into_iter().map(|code| u8::try_from(code).unwrap_or(b'?')).collect()
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
            let (element, bytes) = element(text)?;
            fields.push(Field { name: name.to_owned(), offset: *offset, element });
            *offset = offset.checked_add(bytes).ok_or_else(damaged)?;
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
                // Without a name it fills up a row.
                if let (Literal::Text(text), "") = (descr, own.as_str()) {
                    let bytes = element(text)?.1.checked_mul(count).ok_or_else(damaged)?;
                    *offset = offset.checked_add(bytes).ok_or_else(damaged)?;
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
