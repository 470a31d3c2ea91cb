//! A product file is read, or refused with its faults.

#![no_main]

use clatter_product::ProductFile;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    if let Err(faults) = ProductFile::read(text, "product.toml") {
        assert!(faults.to_string().starts_with("error: "));
    }
});
