//! A file of any kind is read within the allowed number of values, or refused with its fault.

#![no_main]

use clatter_record::{Kind, read};
use libfuzzer_sys::fuzz_target;

const MOST: usize = 100_000;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(kind) = Kind::of(bytes)
        && let Ok(table) = read(kind, bytes, MOST)
    {
        assert!(table.columns.iter().map(|column| column.values.len()).sum::<usize>() <= MOST);
    }
});
