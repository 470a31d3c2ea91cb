//! Baselines that are taken out of records.

use clatter_record::{Baseline, Error, remove_baseline};
use clatter_shock::Error::{NoShock, Quantity, Sample, Short};
use clatter_shock::samples::float;
use std::f64::consts::PI;

/// Sums in whole numbers are exact: the samples are whole, and what is removed is compared as a fraction.
#[test]
fn mean_and_line_are_those_of_exact_sums() {
    for n in [2_i64, 3, 1000, 1_000_001] {
        // Large offset, small drift and a scatter from a congruential generator.
        let mut seed = 12_345_i64;
        let whole: Vec<i64> = (0..n)
            .map(|i| {
                seed = (seed * 1_103_515_245 + 12_345) % 2_147_483_648;
                1_000_000_000 + i / 7 + seed % 1000
            })
            .collect();
        let record: Vec<f64> = whole.iter().map(|&a| float(usize::try_from(a).expect("positive"))).collect();
        let total: i128 = whole.iter().map(|&a| i128::from(a)).sum();
        // Twice the moment about the middle, in whole numbers.
        let moment: i128 = (0..).zip(&whole).map(|(i, &a)| i128::from(2 * i - (n - 1)) * i128::from(a)).sum();
        let n = i128::from(n);
        let exact = |above: i128, below: i128| {
            let whole = above.div_euclid(below);
            let part = above.rem_euclid(below);
            #[expect(clippy::cast_precision_loss, reason = "rounded once each, as the test allows")]
            let value = whole as f64 + part as f64 / below as f64;
            value
        };
        let step = 1e-4;
        // Four roundings of the largest sample, as stated.
        let allowed = 4.0 * f64::EPSILON * 1e9;

        let removed = remove_baseline(&mut record.clone(), step, Baseline::Mean).expect("a mean");
        let want = exact(total, n);
        assert!((removed.offset_m_s2 - want).abs() <= allowed, "{n}: {removed:?}, not {want:?}");

        let mut rest = record.clone();
        let removed = remove_baseline(&mut rest, step, Baseline::Linear).expect("a line");
        let slope = exact(6 * moment, n * (n * n - 1));
        let want = exact(total, n) - slope * (exact(n - 1, 2));
        assert!((removed.offset_m_s2 - want).abs() <= allowed, "{n}: {removed:?}, not {want:?}");
        // Over the record the drift is as exact as the offset.
        let over = (removed.drift_m_s3 * step - slope) * float(rest.len());
        assert!(over.abs() <= allowed, "{n}: {removed:?}, not {slope:?} a sample");
    }
}

#[test]
fn the_mean_before_the_shock_leaves_the_quiet_part_at_zero() {
    let (offset, amplitude, quiet, pulse) = (-9.806_65, 5000.0, 400_usize, 100_usize);
    let mut record: Vec<f64> = (0..1000)
        .map(|i| {
            let at = float(i) - float(quiet);
            let on = (0.0..=float(pulse)).contains(&at);
            offset + if on { amplitude * (PI * at / float(pulse)).sin() } else { 0.0 }
        })
        .collect();
    let removed = remove_baseline(&mut record, 1e-5, Baseline::PreShock { share: 0.05 }).expect("quiet");
    // sin(πi/100) passes 0.05 at i = 2; the samples before it, 0 and 1, rise to sin(π/100) of the amplitude.
    assert_eq!(removed.samples, quiet + 2);
    let want = offset + amplitude * (PI / 100.0).sin() / float(quiet + 2);
    assert!((removed.offset_m_s2 - want).abs() < 1e-12, "{removed:?}, not {want:?}");
    assert!((record[0] - (offset - want)).abs() < 1e-12, "{}", record[0]);
    // The bound that the documentation states.
    assert!((want - offset).abs() < 0.05 * amplitude * 2.0 / float(quiet + 2), "{want}");
}

#[test]
fn what_has_no_baseline_is_refused_and_left() {
    let shock: Vec<f64> = (0..100).map(|i| if i < 10 { 0.0 } else { 100.0 }).collect();
    let pre = Baseline::PreShock { share: 0.05 };
    let refused = |record: &[f64], step, baseline| {
        let mut record = record.to_vec();
        let before = record.clone();
        let error = remove_baseline(&mut record, step, baseline).expect_err("refused");
        assert!(record.iter().zip(&before).all(|(a, b)| a.to_bits() == b.to_bits()), "{error}: changed");
        error
    };
    // The mean of the first 16 lies at 37.5; the first sample is 0.6 of the furthest away.
    assert_eq!(refused(&shock, 1e-3, pre), Error::NoQuiet { samples: 0, needed: 16, share: 0.05 });
    // A peak at sample 10, which the mean knows by a sixteenth.
    let early: Vec<f64> = (0..100).map(|i| if i == 10 { 100.0 } else { 0.0 }).collect();
    let half = Baseline::PreShock { share: 0.5 };
    assert_eq!(refused(&early, 1e-3, half), Error::NoQuiet { samples: 10, needed: 16, share: 0.5 });
    assert_eq!(refused(&[5.0; 100], 1e-3, pre), Error::Shock(NoShock));
    assert!(matches!(refused(&[1.0; 16], 1e-3, pre), Error::Shock(Short { samples: 16, needed: 17, .. })));
    assert!(matches!(refused(&[], 1e-3, Baseline::Mean), Error::Shock(Short { samples: 0, needed: 1, .. })));
    assert!(matches!(refused(&[1.0], 1e-3, Baseline::Linear), Error::Shock(Short { samples: 1, needed: 2, .. })));
    assert!(matches!(refused(&[0.0, f64::NAN], 1e-3, Baseline::Mean), Error::Shock(Sample { sample: 2, .. })));
    for share in [0.0, 1.0, -1.0, f64::NAN] {
        assert!(matches!(refused(&shock, 1e-3, Baseline::PreShock { share }), Error::Quantity { .. }), "{share}");
    }
    for step in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-16] {
        assert!(matches!(refused(&shock, step, Baseline::Mean), Error::Shock(Quantity { .. })), "{step}");
    }
}
