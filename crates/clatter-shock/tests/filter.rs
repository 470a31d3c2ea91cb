//! The recursive filter against the exact response to the same piecewise linear history, step by step.

use clatter_shock::{DampingRatio, Frequencies, Pulses, Quantity, SpectrumFilter};
use proptest::prelude::*;

const QUANTITIES: [Quantity; 5] = [
    Quantity::AbsoluteAcceleration,
    Quantity::RelativeDisplacement,
    Quantity::RelativeVelocity,
    Quantity::PseudoVelocity,
    Quantity::EquivalentStaticAcceleration,
];

fn compare(samples: &[f64], dt: f64, hz: &[f64], zeta: f64, allowed: f64) {
    let frequencies = Frequencies::list(hz.to_vec()).expect("frequencies");
    let damping = DampingRatio::new(zeta).expect("damping");
    let points: Vec<(f64, f64)> = (0_u32..).map(|i| f64::from(i) * dt).zip(samples.iter().copied()).collect();
    let history = Pulses::piecewise_linear(&points).expect("history");
    for quantity in QUANTITIES {
        let want = history.spectrum(&frequencies, damping, quantity);
        let mut filter = SpectrumFilter::new(frequencies.clone(), damping, quantity, dt).expect("filter");
        // Pieces of any size give the same.
        let (a, b) = samples.split_at(samples.len() / 3);
        filter.push(a);
        filter.push(b);
        let got = filter.finish().expect("spectrum");
        for (name, got, want) in [
            ("primary", &got.primary, &want.primary),
            ("residual", &got.residual, &want.residual),
            ("positive", &got.positive, &want.positive),
            ("negative", &got.negative, &want.negative),
        ] {
            for (i, f) in hz.iter().enumerate() {
                let scale = if name == "primary" { want[i] } else { want[i].max(1e-3 * got[i]) };
                assert!(
                    (got[i] - want[i]).abs() <= allowed * scale,
                    "{quantity:?}, {name} at f dt = {:e}, damping {zeta}: {:?}, not {:?}",
                    f * dt,
                    got[i],
                    want[i]
                );
            }
        }
    }
}

/// A burst: a growing and fading oscillation with an offset that keeps all signs in play.
fn burst(n: u32) -> Vec<f64> {
    (0..n).map(|i| f64::from(i) / f64::from(n)).map(|t| (40.0 * t).sin() * (-8.0 * t).exp() * 100.0 + 3.0 * t).collect()
}

#[test]
fn filter_is_the_exact_response_at_every_frequency_and_damping() {
    let hz: Vec<f64> = (-36..=4).map(|i| 10_f64.powf(f64::from(i) / 4.0)).collect();
    for zeta in [0.0, 1e-3, 0.05, 0.7, 1.0 - 1e-9, 1.0, 1.0 + 1e-9, 1.3, 10.0] {
        // dt = 1, so that hz is f·dt from 1e-9 to 10.
        compare(&burst(300), 1.0, &hz, zeta, 1e-10);
    }
}

#[test]
fn a_step_and_a_single_spike() {
    let hz = [1e-9, 1e-4, 0.03, 0.2, 0.5, 1.7, 10.0];
    for zeta in [0.0, 0.05, 1.0, 3.0] {
        compare(&[1.0; 130], 1.0, &hz, zeta, 1e-10);
        let mut spike = vec![0.0; 200];
        spike[70] = -4.0;
        compare(&spike, 1.0, &hz, zeta, 1e-10);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn filter_is_exact_for_any_record(
        samples in prop::collection::vec(-100.0..100.0_f64, 2..400),
        zeta in 0.0..2.0_f64,
        exponent in -5.0..0.5_f64,
    ) {
        compare(&samples, 1e-4, &[1e4 * 10_f64.powf(exponent)], zeta, 1e-10);
    }
}
