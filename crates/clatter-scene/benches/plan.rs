//! Cost of a plan, and of the pairs that it chooses from, on one drop.

use clatter::flight::{Body, Scene};
use clatter_scene::plan::{Pair, Quantity, STRIKES, Setup};
use clatter_shock::{DampingRatio, Suspension};
use divan::{Bencher, black_box};

fn main() {
    divan::main();
}

/// A phone lands at 5° from 1 m; contacts of 0.1 ms; a part at 180 Hz, Q = 10, near its end.
fn setup(e: f64) -> Setup {
    tilted(e, 5.0)
}

/// The same at any tilt.
fn tilted(e: f64, tilt_deg: f64) -> Setup {
    let body = Body::new(0.14, 0.14 / 12.0_f64.sqrt()).expect("a phone");
    let scene = Scene::from_height(body, e, 1.0, tilt_deg, 9.81).expect("a drop");
    let damping = DampingRatio::from_quality_factor(10.0).expect("a quality factor");
    let part = Suspension::from_hz(180.0, damping).expect("a part");
    Setup::new(scene, Some(1e-4), 0.9, part).expect("a setup")
}

/// Estimates for all rungs, and the choice: few strikes where little bounces, all that are followed where much does.
#[divan::bench(args = [0.05, 0.3, 0.9])]
fn plan(bencher: Bencher, e: f64) {
    let setup = setup(e);
    bencher.bench(|| black_box(&setup).forecast(Quantity::PeakAcceleration).plan(0.01));
}

/// The choice alone, by a first look.
#[divan::bench(args = [0.05, 0.3, 0.9])]
fn choice(bencher: Bencher, e: f64) {
    let setup = setup(e);
    bencher.bench(|| black_box(&setup).plan(Quantity::PeakAcceleration, 0.01));
}

/// The same from as many strikes as it hangs on.
#[divan::bench(args = [0.05, 0.3, 0.9])]
fn choice_in_all(bencher: Bencher, e: f64) {
    let setup = setup(e);
    bencher.bench(|| black_box(&setup).plan_from(Quantity::PeakAcceleration, 0.01, STRIKES));
}

/// The first look at a flat drop, whose contacts overlap.
#[divan::bench(args = [0.05, 0.3, 0.9])]
fn choice_of_overlap(bencher: Bencher, e: f64) {
    let setup = tilted(e, 0.1);
    bencher.bench(|| black_box(&setup).plan(Quantity::PeakAcceleration, 0.01));
}

/// Every pair, in the order of `Pair::planned`.
#[divan::bench(args = 0..9)]
fn pair(bencher: Bencher, k: usize) {
    let setup = setup(0.3);
    let pair = Pair::planned(Quantity::PeakAcceleration)[k];
    let until_s = setup.forecast(Quantity::PeakAcceleration).until_s;
    bencher.bench(|| black_box(&setup).demand(pair, Quantity::PeakAcceleration, until_s));
}
