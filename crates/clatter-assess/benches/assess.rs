//! Assessments of ten components with two limits each over full ranges, and of the worked products.

#![allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")]

use std::fmt::Write as _;

use clatter_product::{EXAMPLE, ProductFile};
use divan::{Bencher, black_box};

fn main() {
    divan::main();
}

/// Ten suspended parts of a product, each with two limits; `drop` and `contact` complete the file.
fn ten(drop: &str, contact: &str) -> ProductFile {
    let mut text = format!(
        "[product]\nname = \"ten\"\nlength = \"150 mm\"\nradius_of_gyration = \"41 mm\"\nrestitution = [0.2, 0.4]\n{contact}\n\
         [drop]\n{drop}\ntilt = [\"0.5 deg\", \"10 deg\"]\n"
    );
    for i in 0..10 {
        let (position, frequency) = (-60 + 12 * i, 30 + 25 * i);
        let _ = write!(
            text,
            "[[component]]\nname = \"part {i}\"\nposition = \"{position} mm\"\nextent = \"10 mm\"\n\
             natural_frequency = [\"{frequency} Hz\", \"{} Hz\"]\nquality_factor = 10\nacceleration_limit = \"500 gn\"\n\
             rattle_space = \"5 mm\"\n",
            frequency + 10
        );
    }
    ProductFile::read(&text, "ten").unwrap_or_else(|faults| panic!("{faults}"))
}

/// Instant impacts at real tilt.
#[divan::bench(sample_count = 10)]
fn ten_parts_without_contact_time(bencher: Bencher<'_, '_>) {
    let file = ten("height = [\"0.8 m\", \"1.3 m\"]", "");
    bencher.bench(|| clatter_assess::assess(black_box(&file)));
}

/// Contacts that take time.
#[divan::bench(sample_count = 10)]
fn ten_parts(bencher: Bencher<'_, '_>) {
    let file = ten("height = [\"0.8 m\", \"1.3 m\"]", "contact_time = \"0.4 ms\"");
    bencher.bench(|| clatter_assess::assess(black_box(&file)));
}

#[divan::bench(sample_count = 10, args = ["phone", "terminal", "laptop"])]
fn worked(bencher: Bencher<'_, '_>, name: &str) {
    let text = match name {
        "phone" => include_str!("../../../tests/cases/bar-phone.toml"),
        "terminal" => include_str!("../../../tests/cases/bar-terminal.toml"),
        _ => include_str!("../../../tests/cases/bar-laptop.toml"),
    };
    let file = ProductFile::read(text, name).unwrap_or_else(|faults| panic!("{faults}"));
    bencher.bench(|| clatter_assess::assess(black_box(&file)));
}

/// From text to product.
#[divan::bench]
fn reading(bencher: Bencher<'_, '_>) {
    bencher.bench(|| ProductFile::read(black_box(EXAMPLE), "example"));
}
