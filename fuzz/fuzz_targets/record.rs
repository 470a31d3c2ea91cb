//! A measured record.

#![no_main]

libfuzzer_sys::fuzz_target!(|input: &[u8]| clatter_fuzz::record(input));
