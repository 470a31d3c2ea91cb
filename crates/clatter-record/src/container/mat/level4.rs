//! MAT files of MATLAB 4: one matrix behind the other, each with five numbers and its name before it.
//!
//! Source: MAT-File Format, The MathWorks, chapter 2 (Level 4).

use super::{letters, numbers};
use crate::container::bytes::Bytes;
use crate::container::number::Number;
use crate::container::{COMPLEX, Matrix, TableBuilder, refuse, sparse};
use crate::{Error, Values};

const PART: &str = "MAT file of version 4";

/// Type of data, rows, columns, imaginary or not, and length of the name with its zero.
#[derive(Debug, Clone, Copy)]
struct Head {
    big_endian: bool,
    number: Number,
    /// 0 for numbers, 1 for text, 2 for sparse matrices.
    class: u32,
    rows: u32,
    columns: u32,
    is_complex: bool,
    name: u32,
}

impl Head {
    fn read(words: [[u8; 4]; 5]) -> Option<Self> {
        // The type is a small number, so that its order of bytes shows.
        let [kind, ..] = words;
        let big_endian = u32::from_le_bytes(kind) > u32::from_be_bytes(kind);
        let [kind, rows, columns, imaginary, name] =
            words.map(if big_endian { u32::from_be_bytes } else { u32::from_le_bytes });
        let number = match kind / 10 % 10 {
            0 => Number::F64,
            1 => Number::F32,
            2 => Number::I32,
            3 => Number::I16,
            4 => Number::U16,
            5 => Number::U8,
            _ => return None,
        };
        // Thousands: IEEE numbers, little-endian or big-endian.
        let fits = kind / 1000 == u32::from(big_endian) && kind / 100 % 10 == 0 && kind % 10 < 3 && imaginary < 2;
        let head = Self { big_endian, number, class: kind % 10, rows, columns, is_complex: imaginary == 1, name };
        (fits && (1..=LONGEST_NAME).contains(&name)).then_some(head)
    }
}

const LONGEST_NAME: u32 = 256;

fn words(bytes: &[u8]) -> Option<[[u8; 4]; 5]> {
    let mut words = [[0; 4]; 5];
    words.as_flattened_mut().copy_from_slice(bytes.get(..20)?);
    Some(words)
}

/// Returns whether a file begins as one of MATLAB 4: with a head that holds, and a name that ends where it says.
pub(in crate::container) fn is_level4(beginning: &[u8]) -> bool {
    let name = || {
        let head = words(beginning).and_then(Head::read).filter(|head| head.rows > 0 && head.columns > 0)?;
        beginning.get(20..20 + usize::try_from(head.name).ok()?)
    };
    name().and_then(<[u8]>::split_last).is_some_and(|(zero, name)| {
        let is_word = |byte: &u8| byte.is_ascii_alphanumeric() || *byte == b'_';
        *zero == 0 && name.first().is_some_and(u8::is_ascii_alphabetic) && name.iter().all(is_word)
    })
}

pub(in crate::container) fn read(bytes: &[u8], table: &mut TableBuilder) -> Result<(), Error> {
    let mut bytes = Bytes::new(bytes, PART);
    while bytes.left() > 0 {
        let at = bytes.at();
        let head = words(bytes.take(20)?).and_then(Head::read);
        let head =
            head.ok_or_else(|| refuse(format!("{PART}: no variable begins at byte {at}; the file is damaged")))?;
        let name = bytes.take_u64(head.name.into())?;
        let name = String::from_utf8_lossy(name.strip_suffix(b"\0").unwrap_or(name)).into_owned();
        let [rows, columns] = [head.rows, head.columns].map(|side| usize::try_from(side).unwrap_or(usize::MAX));
        let size = rows.saturating_mul(columns).saturating_mul(head.number.size());
        let real = bytes.take(size)?;
        if head.is_complex {
            bytes.take(size)?;
        }
        let Head { number, big_endian, is_complex, class, .. } = head;
        let matrix = Matrix { rows, columns, column_by_column: true, bytes: real, number, big_endian };
        match class {
            0 => numbers(&name, matrix, is_complex, table)?,
            1 => letters(&name, matrix, table)?,
            _ if columns != 3 => table.leave_out(&name, COMPLEX),
            _ => triplets(&name, &number.values(real, big_endian), rows, table)?,
        }
    }
    table.spread_intervals('.');
    Ok(())
}

/// Adds a sparse matrix: row, column and number of each that is not zero, and the size in the last row.
fn triplets(name: &str, numbers: &Values, count: usize, table: &mut TableBuilder) -> Result<(), Error> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole and within 32 bits")]
    let whole =
        |place| Some(numbers.float(place)).filter(|n| n.fract() == 0.0 && (1.0..4e9).contains(n)).map(|n| n as usize);
    let size = count.checked_sub(1).and_then(|last| Some((last, whole(last)?, whole(count + last)?)));
    let (last, rows, columns) =
        size.ok_or_else(|| refuse(format!("{PART}: {name:?} is sparse and tells no size; the file is damaged")))?;
    let kept = (0..last).map(|i| Some((whole(i)? - 1, whole(count + i)? - 1, numbers.float(2 * count + i))));
    sparse(name, [rows, columns], kept, table)
}
