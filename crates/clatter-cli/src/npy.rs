//! This module writes `.npy` files: a matrix of f64, or columns with names, as numpy reads them.
//!
//! Format version 1.0 (numpy.lib.format): a magic string, the length of the header, the header as a Python dictionary
//! padded with blanks until the data start at a multiple of 64 bytes, then the values, little-endian, row by row.

use std::io::{self, Write};

/// The number of values held at once: 256 KiB of bytes stay in the cache between being made and being written, so that a file costs
/// about as much as copying it.
const CHUNK: usize = 1 << 15;

/// Writes `values` as `rows` rows of equal length.
pub(crate) fn write(out: &mut impl Write, rows: usize, values: &[f64]) -> io::Result<()> {
    let columns = values.len().checked_div(rows).unwrap_or(0);
    out.write_all(&header(rows, columns))?;
    let mut bytes = vec![0; 8 * CHUNK.min(values.len())];
    for chunk in values.chunks(CHUNK) {
        let bytes = &mut bytes[..8 * chunk.len()];
        for (eight, value) in bytes.chunks_exact_mut(8).zip(chunk) {
            eight.copy_from_slice(&value.to_le_bytes());
        }
        out.write_all(bytes)?;
    }
    Ok(())
}

/// Writes columns of equal length as a structured array: a row of f64 for each sample, whose fields have these names.
pub(crate) fn write_columns(out: &mut impl Write, columns: &[(String, &[f64])]) -> io::Result<()> {
    let rows = columns.first().map_or(0, |(_, values)| values.len());
    // Two fields of one name are not allowed.
    let mut names: Vec<String> = Vec::new();
    for (name, _) in columns {
        let plain: String = name.chars().map(|c| if c.is_control() || "\\'\"".contains(c) { '_' } else { c }).collect();
        let other = (2..).map(|n| format!("{n} {plain}"));
        names.extend(std::iter::once(plain.clone()).chain(other).find(|name| !names.contains(name)));
    }
    let fields: Vec<String> = names.iter().map(|name| format!("('{name}', '<f8')")).collect();
    out.write_all(&structured(rows, &fields.join(", ")))?;
    let mut bytes = Vec::with_capacity(8 * CHUNK);
    for row in 0..rows {
        for (_, values) in columns {
            bytes.extend_from_slice(&values[row].to_le_bytes());
        }
        if bytes.len() >= 8 * CHUNK {
            out.write_all(&bytes)?;
            bytes.clear();
        }
    }
    out.write_all(&bytes)
}

/// Makes a header of version 1.0, or of 3.0 where names are not ASCII, which it has in UTF-8, or long.
fn structured(rows: usize, fields: &str) -> Vec<u8> {
    let dictionary = format!("{{'descr': [{fields}], 'fortran_order': False, 'shape': ({rows},), }}");
    let long = !dictionary.is_ascii() || dictionary.len() > 60_000;
    let before = if long { 12 } else { 10 };
    let length = (before + dictionary.len() + 1).next_multiple_of(64) - before;
    let mut header = b"\x93NUMPY".to_vec();
    let size = u32::try_from(length).unwrap_or(u32::MAX).to_le_bytes();
    header.extend(if long { [&[3, 0], &size[..]].concat() } else { [&[1, 0], &size[..2]].concat() });
    header.extend(dictionary.as_bytes());
    header.resize(before + length - 1, b' ');
    header.push(b'\n');
    header
}

fn header(rows: usize, columns: usize) -> Vec<u8> {
    const PREFIX: &[u8] = b"\x93NUMPY\x01\x00";
    let mut dictionary = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({rows}, {columns}), }}");
    // The two sizes have at most 20 digits each: prefix, length, dictionary and line end always fit 128 bytes.
    dictionary.extend(std::iter::repeat_n(' ', 128 - PREFIX.len() - 2 - 1 - dictionary.len()));
    dictionary.push('\n');
    [PREFIX, &[118, 0], dictionary.as_bytes()].concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_header_is_the_one_numpy_writes() {
        // numpy 2.4.6: np.save(f, np.zeros((3, 1000)))
        let numpy = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': (3, 1000), }}{:55}\n", "");
        assert_eq!(header(3, 1000), [b"\x93NUMPY\x01\x00\x76\x00", numpy.as_bytes()].concat());
    }

    #[test]
    fn the_longest_header_still_fits() {
        assert_eq!(header(usize::MAX, usize::MAX).len(), 128);
    }

    #[test]
    fn values_follow_row_by_row_across_chunks() {
        let values: Vec<f64> =
            (0..u32::try_from(2 * CHUNK + 3).unwrap()).map(f64::from).chain([f64::INFINITY]).collect();
        let mut file = Vec::new();
        write(&mut file, 2, &values).unwrap();
        let read: Vec<f64> = file[128..].chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect();
        assert_eq!(read, values);
    }

    /// A structured array that is written in several parts holds each row once.
    #[test]
    fn columns_are_written_row_by_row_across_chunks() {
        let rows = CHUNK + 5;
        let count = u32::try_from(rows).unwrap();
        let [a, b] = [0.0, 0.5].map(|more| (0..count).map(|i| f64::from(i) + more).collect::<Vec<f64>>());
        let mut file = Vec::new();
        write_columns(&mut file, &[("a".to_owned(), &a), ("b".to_owned(), &b)]).unwrap();
        let cells = &file[10 + usize::from(u16::from_le_bytes([file[8], file[9]]))..];
        let read: Vec<f64> = cells.chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect();
        let want: Vec<f64> = a.iter().zip(&b).flat_map(|(a, b)| [*a, *b]).collect();
        assert!(read == want, "{} cells, not {}", read.len(), want.len());
    }
}
