//! Velocity and displacement, against whole numbers and a half-sine.

use clatter_record::{Error, integrate};
use clatter_shock::Error::{Quantity, Sample, Short};
use clatter_shock::samples::float;
use std::f64::consts::PI;

/// Against integrals in whole numbers, 2v/h and 6x/h². The samples are negative, then positive, so that velocity and
/// displacement come back to zero, the latter while the velocity is large.
#[test]
fn integrals_of_straight_lines_are_exact() {
    let n = 1_000_000;
    let mut seed = 1_u64;
    let whole: Vec<i64> = (0..n)
        .map(|i| {
            // Knuth's linear congruential generator; its high bits.
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let size = i64::try_from(seed >> 11).expect("53 bits");
            if i < n / 4 { -size } else { size }
        })
        .collect();
    #[expect(clippy::cast_precision_loss, reason = "53 bits")]
    let record: Vec<f64> = whole.iter().map(|&a| a as f64).collect();
    // A power of two, so that the step rounds nothing.
    let step = 1.0 / 65_536.0;
    let motion = integrate(&record, step).expect("a record");
    let (mut first, mut second, mut size) = (0_i128, 0_i128, 0.0);
    for i in 1..n {
        let (b, a) = (i128::from(whole[i - 1]), i128::from(whole[i]));
        second += 3 * first + 2 * b + a;
        first += b + a;
        size += record[i].abs();
        #[expect(clippy::cast_precision_loss, reason = "one rounding, which the test allows")]
        let (v, x) = (0.5 * step * first as f64, step * step * (second as f64 / 6.0));
        let (got_v, got_x) = (motion.velocity_m_s[i], motion.displacement_m[i]);
        // As stated, and one rounding of the value that it is held against.
        let half = 0.5 * f64::EPSILON;
        let allowed = 4.0 * half * v.abs() + f64::EPSILON * f64::EPSILON * step * size;
        assert!((got_v - v).abs() <= allowed, "{i}: {got_v:?} m/s, not {v:?}");
        let allowed = 4.0 * half * x.abs() + half * step * step * size;
        assert!((got_x - x).abs() <= allowed, "{i}: {got_x:?} m, not {x:?}");
    }
}

/// A half-sine of 100 samples: 2aD/π, with the known error of straight lines, (π/100)²/12 of it.
#[test]
fn a_half_sine_gives_its_velocity_change() {
    let (amplitude, duration, n) = (1000.0, 0.011, 100);
    let step = duration / float(n);
    let record: Vec<f64> = (0..=n).map(|i| amplitude * (PI * float(i) / float(n)).sin()).collect();
    let velocity = integrate(&record, step).expect("a record").velocity_m_s[n];
    let exact = 2.0 * amplitude * duration / PI;
    let line = (PI / float(n)).powi(2) / 12.0;
    // The next term of the series of x/tan x, (x⁴)/45 with x = π/200.
    assert!((velocity / exact - (1.0 - line)).abs() < (PI / 200.0).powi(4) / 40.0, "{velocity} {exact}");
}

#[test]
fn what_is_no_record_is_refused() {
    assert!(matches!(integrate(&[], 1.0), Err(Error::Shock(Short { .. }))));
    assert_eq!(integrate(&[1.0, 2e100], 1.0), Err(Error::Shock(Sample { sample: 2, value: 2e100 })));
    assert!(matches!(integrate(&[1.0], -1.0), Err(Error::Shock(Quantity { .. }))));
    // The largest that is taken stays finite.
    let motion = integrate(&[1e100; 1000], 1e9).expect("a record");
    assert!(motion.displacement_m[999].is_finite() && motion.velocity_m_s[999].is_finite());
}
