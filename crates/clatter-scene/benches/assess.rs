//! Assessments of ten components with two limits each over full ranges, by what the scene needs.
//!
//! Wall time on a shared machine of 2 cores at 2.9 GHz, at a quiet moment: 33 ms with contacts that take time, 18 ms
//! without; on a busy one twice that and more. With contacts it is 0.43 thousand million instructions, all of it spread
//! over the cores.

use std::fmt::Write as _;

use clatter_scene::{Accuracy, BarModel, EXAMPLE, ProductFile};
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

/// Proven demands alone.
#[divan::bench]
fn without_gravity(bencher: Bencher<'_, '_>) {
    let file = ten("speed = [\"4 m/s\", \"5 m/s\"]\ngravity = \"0 gn\"", "");
    bencher.bench(|| black_box(&file).prove());
}

/// Proven demands, and the search with gravity and real tilt.
#[divan::bench]
fn with_gravity_and_tilt(bencher: Bencher<'_, '_>) {
    let file = ten("height = [\"0.8 m\", \"1.3 m\"]", "");
    bencher.bench(|| black_box(&file).assess());
}

/// The search with contacts that take time.
#[divan::bench(sample_count = 5)]
fn with_contact_time(bencher: Bencher<'_, '_>) {
    let file = ten("height = [\"0.8 m\", \"1.3 m\"]", "contact_time = \"0.4 ms\"");
    bencher.bench(|| black_box(&file).assess());
}

/// The worked products, by plans and by the highest rung there is, which follows every drop of the grid.
#[divan::bench(sample_count = 3, args = ["phone", "terminal", "laptop"], consts = [true, false])]
fn worked<const PLANNED: bool>(bencher: Bencher<'_, '_>, name: &str) {
    let text = match name {
        "phone" => include_str!("../../../reports/examples/phone.toml"),
        "terminal" => include_str!("../../../reports/examples/handheld-terminal.toml"),
        _ => include_str!("../../../reports/examples/laptop.toml"),
    };
    let file = ProductFile::read(text, name).unwrap_or_else(|faults| panic!("{faults}"));
    let contacts = file.product.contact_time_s.is_some();
    let highest = if contacts { BarModel::Compliant } else { BarModel::FiniteTilt };
    let accuracy = Accuracy { model: (!PLANNED).then_some(highest), ..Accuracy::default() };
    bencher.bench(|| black_box(&file).assess_to(&accuracy));
}

/// From text to product.
#[divan::bench]
fn reading(bencher: Bencher<'_, '_>) {
    bencher.bench(|| ProductFile::read(black_box(EXAMPLE), "example"));
}
