//! MAT files of MATLAB 5 to 7.2: elements with a tag, compressed or not; and of MATLAB 4, in [`level4`].
//!
//! Source: MAT-File Format, The MathWorks, chapter 1 (Level 5).

pub(super) mod level4;

use super::bytes::Bytes;
use super::number::Number;
use super::{COMPLEX, Matrix, Naming, TableBuilder, by_column, codec, column, refuse, sparse};
use crate::{Error, Values};

const PART: &str = "MAT file";
const MATRIX: u32 = 14;
const COMPRESSED: u32 = 15;
const UTF8: u32 = 16;
const UTF16: u32 = 17;
const UTF32: u32 = 18;
/// Structures in structures.
const DEEPEST: usize = 8;

/// Adds a variable of numbers.
fn numbers(name: &str, matrix: Matrix<'_>, is_complex: bool, table: &mut TableBuilder) -> Result<(), Error> {
    let Matrix { rows, columns, bytes, number, big_endian, .. } = matrix;
    let values = rows.checked_mul(columns);
    if values.and_then(|values| values.checked_mul(number.size())) != Some(bytes.len()) {
        return Err(refuse(format!(
            "MAT file: {name:?} should hold {rows} times {columns} numbers, but has {} bytes",
            bytes.len()
        )));
    }
    let (group, own) = name.rsplit_once('.').unwrap_or(("", name));
    match values {
        None | Some(0) => table.leave_out(name, "empty"),
        _ if is_complex => table.leave_out(name, COMPLEX),
        Some(1) => table.number(group, own, name, number.values(bytes, big_endian).float(0)),
        Some(_) => {
            table.take(&[rows, columns])?;
            table.extend(group, matrix.split(name, Naming::Matlab));
        }
    }
    Ok(())
}

/// Adds the numbers that the rows of a matrix of letters are, or names it as text.
fn letters(name: &str, matrix: Matrix<'_>, table: &mut TableBuilder) -> Result<(), Error> {
    let Matrix { rows, columns, bytes, number, big_endian, .. } = matrix;
    let fits = rows.checked_mul(columns).and_then(|count| count.checked_mul(number.size())) == Some(bytes.len());
    if !fits || rows < 2 {
        table.leave_out(name, "text");
        return Ok(());
    }
    let codes = number.values(bytes, big_endian).into_integers();
    let letter = |code: i64| u8::try_from(code).unwrap_or(b'?');
    let texts =
        (0..rows).map(|row| codes.iter().skip(row).step_by(rows).map(|code| letter(*code)).collect::<Vec<u8>>());
    match super::number::numbers(texts) {
        Some(values) => {
            table.take(&[rows])?;
            let group = name.rsplit_once('.').map_or("", |(group, _)| group);
            table.extend(group, [column(name, None, Values::Float(values))]);
        }
        None => table.leave_out(name, "text"),
    }
    Ok(())
}

pub(super) fn read(bytes: &[u8], table: &mut TableBuilder) -> Result<(), Error> {
    let mut bytes = Bytes::new(bytes, PART);
    bytes.take(126)?;
    bytes.big_endian = bytes.take(2)? == b"MI";
    while bytes.left() > 0 {
        let Element { kind, data } = Element::read(&mut bytes)?;
        if kind == COMPRESSED {
            let part = "MAT file, a compressed variable";
            let unpacked = codec::zlib(data, table.bytes(), part)?;
            let inner = Element::read(&mut bytes.part(&unpacked, part))?;
            if inner.kind == MATRIX {
                variable(inner.data, bytes.big_endian, None, 0, table)?;
            }
        } else if kind == MATRIX {
            variable(data, bytes.big_endian, None, 0, table)?;
        }
    }
    table.spread_intervals('.');
    Ok(())
}

/// A tagged part of the file.
#[derive(Debug, Clone, Copy)]
struct Element<'a> {
    kind: u32,
    data: &'a [u8],
}

impl<'a> Element<'a> {
    fn read(bytes: &mut Bytes<'a>) -> Result<Self, Error> {
        let tag = bytes.u32()?;
        if tag >> 16 != 0 {
            // A small one: up to 4 bytes within the tag.
            let (kind, length) = (tag & 0xffff, tag >> 16);
            let data = bytes.take(4)?;
            let data = usize::try_from(length).ok().and_then(|length| data.get(..length));
            return Ok(Self {
                kind,
                data: data.ok_or_else(|| refuse("MAT file: a small element is longer than 4 bytes"))?,
            });
        }
        let length = bytes.u32()?;
        let data = bytes.take_u64(length.into())?;
        if tag != COMPRESSED {
            // Fill to 8 bytes, which the last one may lack.
            bytes.take(data.len().wrapping_neg() % 8)?;
        }
        Ok(Self { kind: tag, data })
    }
    /// Its numbers.
    fn number(self) -> Option<Number> {
        Some(match self.kind {
            1 => Number::I8,
            2 | UTF8 => Number::U8,
            3 => Number::I16,
            4 | UTF16 => Number::U16,
            5 => Number::I32,
            6 | UTF32 => Number::U32,
            7 => Number::F32,
            9 => Number::F64,
            12 => Number::I64,
            13 => Number::U64,
            _ => return None,
        })
    }
}

/// Adds the columns of one variable; one that holds no numbers adds none.
fn variable<'a>(
    data: &'a [u8],
    big_endian: bool,
    given: Option<&str>,
    depth: usize,
    table: &mut TableBuilder,
) -> Result<(), Error> {
    const STRUCTURE: u32 = 2;
    const LETTERS: u32 = 4;
    const SPARSE: u32 = 5;
    const OPAQUE: u32 = 17;
    const IS_COMPLEX: u32 = 0x0800;
    const IS_TRUTH: u32 = 0x0200;
    let mut bytes = Bytes::new(data, PART);
    bytes.big_endian = big_endian;
    if data.is_empty() {
        table.leave_out(given.unwrap_or("variable without a name"), "empty");
        return Ok(());
    }
    let flags = Element::read(&mut bytes)?.data;
    let flags = bytes.part(flags, "MAT file, the flags of a variable").u32()?;
    let class = flags & 0xff;
    let sides = if class == OPAQUE { None } else { Some(Element::read(&mut bytes)?) };
    let own = Element::read(&mut bytes)?.data;
    let own = String::from_utf8_lossy(own);
    let name = given.unwrap_or(&own);
    // Variables that MATLAB keeps for itself have no name.
    if name.is_empty() {
        return Ok(());
    }
    let Some(sides) = sides else {
        table.leave_out(name, "an object of MATLAB, such as a table or a string");
        return Ok(());
    };
    let sides = Number::I32.values(sides.data, big_endian).into_integers();
    let sides: Vec<usize> = sides.iter().filter_map(|side| usize::try_from(*side).ok()).collect();
    let &[rows, columns] = sides.as_slice() else {
        if sides.len() < 2 {
            return Err(refuse(format!("MAT file: the size of {name:?} is damaged")));
        }
        table.leave_out(name, format!("of {} dimensions", sides.len()));
        return Ok(());
    };
    let matrix = |bytes: &mut Bytes<'a>| -> Result<Matrix<'a>, Error> {
        let Element { kind, data } = Element::read(bytes)?;
        let number = Element { kind, data }.number();
        let number = number.ok_or_else(|| refuse(format!("MAT file: {name:?} has no numbers of a known kind")))?;
        Ok(Matrix { rows, columns, column_by_column: true, bytes: data, number, big_endian })
    };
    match class {
        STRUCTURE if rows == 1 && columns == 1 && depth < DEEPEST => return fields(&mut bytes, name, depth, table),
        LETTERS => return letters(name, matrix(&mut bytes)?, table),
        SPARSE | 6..=15 if flags & IS_TRUTH != 0 => table.leave_out(name, "truths"),
        SPARSE if flags & IS_COMPLEX != 0 => table.leave_out(name, COMPLEX),
        SPARSE => {
            let [places, starts, numbers] = [matrix(&mut bytes)?, matrix(&mut bytes)?, matrix(&mut bytes)?]
                .map(|Matrix { bytes, number, .. }| number.values(bytes, big_endian));
            let [places, starts] = [places, starts].map(Values::into_integers);
            return sparse(name, [rows, columns], by_column(&places, &starts, &numbers), table);
        }
        6..=15 => return numbers(name, matrix(&mut bytes)?, flags & IS_COMPLEX != 0, table),
        1 => table.leave_out(name, "cells"),
        STRUCTURE => table.leave_out(name, "an array of structures"),
        _ => table.leave_out(name, "an object of MATLAB"),
    }
    Ok(())
}

/// The fields of one structure: the length of a name, the names, then a variable each.
fn fields(bytes: &mut Bytes, name: &str, depth: usize, table: &mut TableBuilder) -> Result<(), Error> {
    let length = Element::read(bytes)?.data;
    let length = bytes.part(length, "MAT file, the fields of a structure").u32()?;
    let length = usize::try_from(length).unwrap_or(usize::MAX).max(1);
    let names = Element::read(bytes)?.data;
    if names.is_empty() {
        table.leave_out(name, "a structure without members");
    }
    for field in names.chunks(length) {
        let end = field.iter().position(|byte| *byte == 0).unwrap_or(field.len());
        let field = String::from_utf8_lossy(&field[..end]);
        let Element { kind, data } = Element::read(bytes)?;
        if kind == MATRIX {
            variable(data, bytes.big_endian, Some(&format!("{name}.{field}")), depth + 1, table)?;
        }
    }
    Ok(())
}
