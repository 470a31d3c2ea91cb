//! Instruction counts under valgrind, the same on every run: `cargo bench -p clatter --bench instructions`.
//!
//! Needs valgrind and `cargo install gungraun-runner`, of the version that Cargo.lock names.
#![expect(missing_docs, unused_qualifications, reason = "of items that the macros make")]

use clatter::{Axis, Bar, Map, Quantity, Start, Summary};
use gungraun::{library_benchmark, library_benchmark_group, main};
use std::hint::black_box;

fn bar(q: f64, e: f64) -> Bar {
    Bar::new(q, e).expect("q and e in range")
}

#[library_benchmark]
#[bench::four_impacts(bar(0.5, 0.3))]
#[bench::sixteen_impacts(bar(0.73, 0.2))]
#[bench::thirty_one_impacts(bar(0.67, 0.15))]
#[bench::two_hundred_million_impacts(bar(1.0 - f64::EPSILON / 2.0, 1.0))]
#[bench::one_float_below_endless(bar(0.799_999_999_999_999_9, 0.25))]
#[bench::endless(bar(0.9, 0.2))]
fn summary(bar: Bar) -> Summary {
    black_box(bar).summary(black_box(&Start::default()))
}

#[library_benchmark]
#[bench::four(bar(0.5, 0.3), 4)]
#[bench::two_thousand(bar(0.999_999, 1.0), 2221)]
fn train(bar: Bar, impacts: usize) -> f64 {
    black_box(bar).train(&Start::default()).take(impacts).map(|impact| impact.time).sum()
}

#[library_benchmark]
fn map_of_the_peak() -> Map {
    let (q, e) = (Axis::q(0.0, 1.0, 100).expect("an axis"), Axis::e(0.0, 1.0, 100).expect("an axis"));
    Map::compute(Quantity::PeakEnd, q, e).expect("80 kB")
}

library_benchmark_group!(name = closed_form; benchmarks = summary, train, map_of_the_peak);
main!(library_benchmark_groups = closed_form);
