//! The `.npy` file: a matrix of f64 as numpy reads it.
//!
//! Format version 1.0 (numpy.lib.format): a magic string, the length of the header, the header as a Python dictionary
//! padded with blanks until the data start at a multiple of 64 bytes, then the values, little-endian, row by row.

use std::io::{self, Write};

/// Values held at once: 256 KiB of bytes stay in the cache between being made and being written, so that a file costs
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
}
