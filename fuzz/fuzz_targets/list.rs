//! A list of shocks or pulses.

#![no_main]

libfuzzer_sys::fuzz_target!(|input: &[u8]| clatter_fuzz::list(input));
