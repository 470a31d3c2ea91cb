//! A command line.

#![no_main]

libfuzzer_sys::fuzz_target!(|input: &str| clatter_fuzz::arguments(input));
