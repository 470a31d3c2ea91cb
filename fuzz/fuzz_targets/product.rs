//! A product file is read, or its faults are told.

#![no_main]

use clatter_assess::ProductFile;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    if let Err(faults) = ProductFile::read(text, "product.toml") {
        assert!(faults.to_string().starts_with("error: "));
    }
});
