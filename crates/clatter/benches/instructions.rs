//! Instruction counts under valgrind, the same on every run: `cargo bench -p clatter --bench instructions`.
//!
//! Needs valgrind and `cargo install gungraun-runner`, of the version that Cargo.lock names.
#![expect(missing_docs, unused_qualifications, reason = "of items that the macros make")]
#![allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")]

use clatter::{Axis, Bar, Count, Map, Quantity, Start, Summary};
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
#[bench::four_impacts(bar(0.5, 0.3))]
#[bench::thirty_one_impacts(bar(0.67, 0.15))]
#[bench::forty_seven_impacts(bar(0.9978, 1.0))]
#[bench::two_thousand_impacts(bar(0.999_999, 1.0))]
#[bench::one_float_below_endless(bar(0.799_999_999_999_999_9, 0.25))]
#[bench::endless_by_one_float(bar(0.8, 0.25))]
fn count(bar: Bar) -> Count {
    black_box(bar).count(black_box(&Start::default()))
}

// The loop anyone would write, to its end.
#[library_benchmark]
#[bench::four_impacts(0.5, 0.3)]
#[bench::thirty_one_impacts(0.67, 0.15)]
fn plain_loop(q: f64, e: f64) -> [f64; 6] {
    let (q, e) = black_box((q, e));
    let t = q * (1.0 + e);
    let (mut a, mut next, mut b, mut b_next, mut n, mut peak) = (-1.0, -t - 1.0, 0.0, 1.0, 1.0, 1.0_f64);
    while next < 0.0 {
        (a, next) = (next, t * next - e * a);
        (b, b_next) = (b_next, t * b_next - e * b);
        n += 1.0;
        peak = peak.max(-a);
    }
    [n, (1.0 + e) * peak, b / -a, -e * a, next, b_next]
}

#[library_benchmark]
#[bench::four_impacts(bar(0.5, 0.3))]
#[bench::two_thousand_impacts(bar(0.999_999, 1.0))]
fn train_one_by_one(bar: Bar) -> f64 {
    let mut sum = 0.0;
    for impact in black_box(bar).train(&Start::default()) {
        sum += impact.time + impact.delta_v[0];
    }
    sum
}

#[library_benchmark]
#[bench::four_impacts(bar(0.5, 0.3))]
#[bench::two_thousand_impacts(bar(0.999_999, 1.0))]
fn train_summed(bar: Bar) -> f64 {
    black_box(bar).train(&Start::default()).map(|impact| impact.time + impact.delta_v[0]).sum()
}

// Times, approach velocities and shocks at an end, into a list that lasts.
#[library_benchmark]
#[bench::four_impacts(bar(0.5, 0.3), vec![[0.0; 3]; 4])]
#[bench::thirty_one_impacts(bar(0.67, 0.15), vec![[0.0; 3]; 31])]
#[bench::forty_seven_impacts(bar(0.9978, 1.0), vec![[0.0; 3]; 47])]
#[bench::two_thousand_impacts(bar(0.999_999, 1.0), vec![[0.0; 3]; 2221])]
fn train_listed(bar: Bar, mut list: Vec<[f64; 3]>) -> Vec<[f64; 3]> {
    black_box(bar).train(&Start::default()).fold(0, |n, impact| {
        list.get_mut(n).into_iter().for_each(|row| *row = [impact.time, impact.approach, impact.delta_v[0]]);
        n + 1
    });
    list
}

#[library_benchmark]
fn map_of_the_peak() -> Map {
    let (q, e) = (Axis::q(0.0, 1.0, 100).expect("an axis"), Axis::e(0.0, 1.0, 100).expect("an axis"));
    Map::compute(Quantity::PeakEnd, q, e).expect("80 kB")
}

library_benchmark_group!(name = closed_form; benchmarks = summary, count, plain_loop, train_one_by_one, train_summed, train_listed, map_of_the_peak);
main!(library_benchmark_groups = closed_form);
