//! Records of strikes that several drops explain, or that one far from the middle of all ranges explains alone.

use clatter::End;
use clatter_fit::{Fit, Known, Measured, MeasuredStrike, Quantity, fit};
use clatter_product::ProductFile;

use super::synthetic::of;

fn fitted(product: &str, record: &str) -> Fit {
    let file = ProductFile::read(product, "product.toml").expect("as the test has it");
    let strike = |line: &str| {
        let (time, end) = line.split_once(',').expect("a time and an end");
        let end = match end {
            "a" => Some(End::A),
            "b" => Some(End::B),
            _ => None,
        };
        MeasuredStrike { time_s: time.parse().expect("a time"), end }
    };
    let strikes = record.lines().skip(1).map(strike).collect();
    fit(&Known::from(&file), &[Measured::Strikes { strikes, deviation_s: Some(5e-6) }]).expect("an explanation")
}

/// How far off each value may be, beside a value that another least-squares search found, from thousands of starts.
fn assert_tells(found: &Fit, quantity: Quantity, value: f64) {
    let [lo, hi] = of(found, quantity).interval.expect("an interval");
    assert!(lo <= value && value <= hi, "{quantity:?}: {value} is not in {lo} to {hi}");
}

/// A second strike after 2 ms and a third after 280 ms more: a search from the first strikes misses the drop that explains all six, and one
/// far from the ranges of the file explains five.
#[test]
fn no_true_strike_is_left_out_before_the_ranges_are_searched() {
    let found = fitted(include_str!("modes/cl6_71_41.toml"), include_str!("modes/cl6_71_41.csv"));
    assert!(found.records[0].strikes.iter().enumerate().all(|(k, strike)| strike.number == Some(k + 1)));
    for (quantity, value) in
        [(Quantity::Restitution, 0.69608), (Quantity::RadiusOfGyration, 0.043_802), (Quantity::Speed, 3.130_98)]
    {
        assert!((of(&found, quantity).value / value - 1.0).abs() < 1e-4, "{quantity:?}: {found:?}");
    }
}

/// Nothing says which end touched first, and both explain five times: the one within the range of the radius of gyration is told first, and
/// the intervals hold both.
#[test]
fn both_ends_that_may_have_touched_first_are_told() {
    let found = fitted(include_str!("modes/strikes_601_30.toml"), include_str!("modes/strikes_601_30.csv"));
    assert_eq!((found.first, found.others.len()), (End::A, 1), "{found:?}");
    assert_eq!(found.others[0].first, End::B);
    // At the middle of the range of the speed, ±2 µs off.
    for value in [0.071_06, 0.072_315] {
        assert_tells(&found, Quantity::RadiusOfGyration, value);
    }
    assert_tells(&found, Quantity::Restitution, 0.326_01);
}
