//! MAT files of MATLAB 5 to 7.2: elements with a tag, compressed or not; and of MATLAB 4, in [`level4`].
//!
//! Source: MAT-File Format, The MathWorks, chapter 1 (Level 5).

pub(super) mod level4;

use super::bytes::Bytes;
use super::number::Number;
use super::{Matrix, Naming, TableBuilder, codec, refuse};
use crate::{Error, Values};

const PART: &str = "MAT file";
const MATRIX: u32 = 14;
const COMPRESSED: u32 = 15;
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
        None | Some(0) => {}
        Some(1) => {
            if let Values::Float(values) = number.values(bytes, big_endian) {
                table.number(group, own, values[0]);
            }
        }
        Some(_) if is_complex => {
            table.leave_out(format!("{name:?}, which is complex; a record is real: save its real part"));
        }
        Some(_) => {
            table.take(&[rows, columns])?;
            table.extend(group, matrix.split(name, Naming::Matlab));
        }
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
            2 => Number::U8,
            3 => Number::I16,
            4 => Number::U16,
            5 => Number::I32,
            6 => Number::U32,
            7 => Number::F32,
            9 => Number::F64,
            12 => Number::I64,
            13 => Number::U64,
            _ => return None,
        })
    }
}

/// Adds the columns of one variable; one that holds no numbers adds none.
fn variable(
    data: &[u8],
    big_endian: bool,
    given: Option<&str>,
    depth: usize,
    table: &mut TableBuilder,
) -> Result<(), Error> {
    const STRUCTURE: u32 = 2;
    const OPAQUE: u32 = 17;
    const COMPLEX: u32 = 0x0800;
    let mut bytes = Bytes::new(data, PART);
    bytes.big_endian = big_endian;
    // An empty cell or field.
    if data.is_empty() {
        return Ok(());
    }
    let flags = Element::read(&mut bytes)?.data;
    let flags = bytes.part(flags, "MAT file, the flags of a variable").u32()?;
    let class = flags & 0xff;
    if class == OPAQUE {
        return Ok(());
    }
    let sides = Element::read(&mut bytes)?;
    let own = Element::read(&mut bytes)?.data;
    let own = String::from_utf8_lossy(own);
    let name = given.unwrap_or(&own);
    // Variables that MATLAB keeps for itself have no name.
    if name.is_empty() {
        return Ok(());
    }
    let sides = match Number::I32.values(sides.data, big_endian) {
        Values::Float(sides) => sides,
        Values::Integer(_) => Vec::new(),
    };
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "32-bit integers; negative ones are refused"
    )]
    let sides: Vec<usize> = sides.iter().filter(|side| **side >= 0.0).map(|side| *side as usize).collect();
    let &[rows, columns] = sides.as_slice() else {
        // More than two dimensions are no record.
        return if sides.len() > 2 {
            Ok(())
        } else {
            Err(refuse(format!("MAT file: the size of {name:?} is damaged")))
        };
    };
    match class {
        STRUCTURE if rows == 1 && columns == 1 && depth < DEEPEST => fields(&mut bytes, name, depth, table),
        6..=15 => {
            let real = Element::read(&mut bytes)?;
            let number =
                real.number().ok_or_else(|| refuse(format!("MAT file: {name:?} has no numbers of a known kind")))?;
            let matrix = Matrix { rows, columns, column_by_column: true, bytes: real.data, number, big_endian };
            numbers(name, matrix, flags & COMPLEX != 0, table)
        }
        // Text, cells, sparse matrices, arrays of structures.
        _ => Ok(()),
    }
}

/// The fields of one structure: the length of a name, the names, then a variable each.
fn fields(bytes: &mut Bytes, name: &str, depth: usize, table: &mut TableBuilder) -> Result<(), Error> {
    let length = Element::read(bytes)?.data;
    let length = bytes.part(length, "MAT file, the fields of a structure").u32()?;
    let length = usize::try_from(length).unwrap_or(usize::MAX).max(1);
    let names = Element::read(bytes)?.data;
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
