//! A measured record is read, or its fault is told.

#![no_main]

use clatter_shock::Record;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(record) = Record::read(bytes, None) {
        assert!(record.points().windows(2).all(|p| p[0].0 < p[1].0 && p[0].1.is_finite()));
    }
});
