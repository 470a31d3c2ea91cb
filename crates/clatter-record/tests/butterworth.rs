//! Filters, against the stated curve and against 60 digits.

use clatter_record::{Error, Pass, butterworth};
use clatter_shock::Error::{Sample, Short};
use clatter_shock::samples::float;
use serde_json::Value;
use std::f64::consts::{PI, SQRT_2};

/// The stated amplitude, written down on its own.
fn left(pass: Pass, f: f64, cutoff: f64, order: u32) -> f64 {
    let ratio = (PI * f).tan() / (PI * cutoff).tan();
    let power = ratio.powf(2.0 * f64::from(order));
    match pass {
        Pass::Low => 1.0 / (1.0 + (SQRT_2 - 1.0) * power),
        Pass::High => 1.0 / (1.0 + (SQRT_2 - 1.0) / power),
    }
}

/// In the middle of a long record, where no edge is felt, a sinusoid keeps its phase and the stated amplitude.
#[test]
fn amplitudes_are_the_stated_curve_and_nothing_is_shifted() {
    for (pass, order) in [Pass::Low, Pass::High].into_iter().flat_map(|p| (1..=8).map(move |n| (p, n))) {
        for (cutoff, half) in [(2e-3, 80_000), (0.05, 4000), (0.45, 4000)] {
            // At the cutoff itself −3 dB, whatever the order.
            assert!((left(pass, cutoff, cutoff, order) - 0.5_f64.sqrt()).abs() < 1e-12, "{pass:?} {order}");
            for ratio in [0.3, 0.8, 1.0, 1.08, 3.0] {
                let f: f64 = cutoff * ratio;
                if f > 0.49 {
                    continue;
                }
                let wave = |i: usize| (2.0 * PI * f * float(i) + 0.4).sin();
                let record: Vec<f64> = (0..2 * half).map(wave).collect();
                let got = butterworth(&record, 1.0, pass, cutoff, order).expect("a record");
                let amplitude = left(pass, f, cutoff, order);
                for i in half..half + 50 {
                    // Roundings: 6e-13 at the worst, tenfold; the edges are 190 time constants away or more.
                    let (got, want) = (got[i], amplitude * wave(i));
                    assert!((got - want).abs() < 6e-12, "{pass:?} {order}, {f} of {cutoff}: {got} not {want}");
                }
            }
        }
    }
}

/// Against the difference equations at 60 digits (tests/data/make_filters.py), edges and all, down to 10⁻⁶ of the
/// sampling rate.
#[test]
fn records_are_filtered_as_with_sixty_digits() {
    let data: Value = serde_json::from_str(include_str!("data/filters.json")).expect("data");
    let numbers = |v: &Value| -> Vec<f64> {
        v.as_array().expect("numbers").iter().map(|v| v.as_f64().expect("a number")).collect()
    };
    let record = numbers(&data["record"]);
    let cases = data["cases"].as_array().expect("cases");
    assert_eq!(cases.len(), 12, "cases");
    for case in cases {
        let pass = if case["kind"] == "low" { Pass::Low } else { Pass::High };
        let relative = case["relative"].as_f64().expect("a number");
        let order = u32::try_from(case["order"].as_u64().expect("a count")).expect("a count");
        // The step takes part in nothing but the cutoff.
        let got = butterworth(&record, 1e-4, pass, relative / 1e-4, order).expect("a record");
        assert_eq!(got.len(), record.len());
        for (i, want) in numbers(&case["y"]).into_iter().enumerate() {
            let got = got[8 * i];
            // Tenfold the 1e-15 of the largest sample, some 110, that is measured.
            assert!((got - want).abs() < 1e-14 * 110.0, "{pass:?} {relative} {order}, {i}: {got:?}, not {want:?}");
        }
    }
}

/// The lowest cutoffs over ten million samples, where roundings add up longest.
#[test]
fn the_lowest_cutoffs_keep_their_digits() {
    let middle = 5_000_000;
    for (pass, cutoff) in [(Pass::Low, 1e-6), (Pass::High, 2e-6)] {
        let wave = |i: usize| (2.0 * PI * cutoff * float(i) + 0.4).sin();
        let record: Vec<f64> = (0..2 * middle).map(wave).collect();
        let got = butterworth(&record, 1.0, pass, cutoff, 1).expect("a record");
        for (i, got) in got.iter().enumerate().skip(middle).take(100) {
            // As stated; the edges are 40 time constants away or more.
            let want = 0.5_f64.sqrt() * wave(i);
            assert!((got - want).abs() < 1e-10, "{pass:?}: {got}, not {want}");
        }
    }
}

#[test]
fn constants_and_straight_lines_have_no_transient() {
    let line: Vec<f64> = (0..500).map(|i| 3.0 + 0.25 * float(i)).collect();
    for order in 1..=8 {
        for relative in [1e-6, 1e-3, 0.1, 0.499] {
            let constant = butterworth(&[7.3; 100], 1.0, Pass::Low, relative, order).expect("a record");
            assert_eq!(constant, [7.3; 100], "{order} {relative}");
            let nothing = butterworth(&[7.3; 100], 1.0, Pass::High, relative, order).expect("a record");
            assert_eq!(nothing, [0.0; 100], "{order} {relative}");
        }
        // Turned about its ends, a line goes on; 7 time constants (1/1000 each way) hide where it stops, and no
        // phase is left to shift it. 0.25 · 500 is its rise.
        let got = butterworth(&line, 1.0, Pass::Low, 0.1, order).expect("a record");
        for (got, want) in got.iter().zip(&line) {
            assert!((got - want).abs() < 2e-3 * 125.0, "{order}: {got}, not {want}");
        }
    }
}

#[test]
fn what_cannot_be_filtered_is_refused_with_the_value() {
    let low = |record: &[f64], step, cutoff, order| butterworth(record, step, Pass::Low, cutoff, order);
    for cutoff in [0.0, 0.99e-6, 0.5, 1.0, -0.1, f64::NAN, f64::INFINITY] {
        let error = low(&[1.0; 9], 1.0, cutoff, 2).expect_err("refused");
        assert!(matches!(error, Error::Quantity { value, .. } if value.to_bits() == cutoff.to_bits()), "{error}");
    }
    for order in [0, 9, u32::MAX] {
        assert!(matches!(low(&[1.0; 9], 1.0, 0.1, order), Err(Error::Quantity { .. })), "{order}");
    }
    assert!(matches!(low(&[], 1.0, 0.1, 2), Err(Error::Shock(Short { .. }))));
    assert!(matches!(low(&[1.0, f64::INFINITY], 1.0, 0.1, 2), Err(Error::Shock(Sample { sample: 2, .. }))));
    // The shortest, and the closest to half the sampling rate.
    assert_eq!(low(&[4.0], 1.0, 0.1, 8), Ok(vec![4.0]));
    let wild: Vec<f64> = (0..1000).map(|i| if i % 2 == 0 { 1e100 } else { -1e100 }).collect();
    for (pass, cutoff) in [(Pass::Low, 0.499_999_999), (Pass::High, 1e-6), (Pass::High, 0.499_999_999)] {
        let got = butterworth(&wild, 1.0, pass, cutoff, 8).expect("a record");
        assert!(got.iter().all(|a| a.is_finite()), "{pass:?}");
    }
}
