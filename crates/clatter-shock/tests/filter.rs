//! The recursive filter against the exact response to the same piecewise linear history, step by step.

use clatter_shock::accuracy::RECORD;
use clatter_shock::{DampingRatio, Frequencies, Pulses, Quantity, SpectrumFilter, State, Suspension};
use proptest::prelude::*;

const QUANTITIES: [Quantity; 5] = [
    Quantity::AbsoluteAcceleration,
    Quantity::RelativeDisplacement,
    Quantity::RelativeVelocity,
    Quantity::PseudoVelocity,
    Quantity::EquivalentStaticAcceleration,
];

fn compare(samples: &[f64], dt: f64, hz: &[f64], zeta: f64) {
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
        let largest = &want.maximax;
        for (name, got, want) in [
            ("primary", &got.primary, &want.primary),
            ("residual", &got.residual, &want.residual),
            ("positive", &got.positive, &want.positive),
            ("negative", &got.negative, &want.negative),
        ] {
            for (i, f) in hz.iter().enumerate() {
                // Primary keeps its own relative accuracy on soft mounts, the others that of the largest.
                let scale = if name == "primary" { want[i] } else { largest[i] };
                assert!(
                    (got[i] - want[i]).abs() <= RECORD.error * scale,
                    "{quantity:?}, {name} at f dt = {:e}, damping {zeta}: {:?}, not {:?}",
                    f * dt,
                    got[i],
                    want[i]
                );
            }
        }
    }
}

/// Returns a burst: a growing and fading oscillation with an offset that keeps all signs in play.
fn burst(n: u32) -> Vec<f64> {
    (0..n).map(|i| f64::from(i) / f64::from(n)).map(|t| (40.0 * t).sin() * (-8.0 * t).exp() * 100.0 + 3.0 * t).collect()
}

#[test]
fn filter_is_the_exact_response_at_every_frequency_and_damping() {
    let hz: Vec<f64> = (-36..=4).map(|i| 10_f64.powf(f64::from(i) / 4.0)).collect();
    for zeta in [0.0, 1e-3, 0.05, 0.7, 1.0 - 1e-9, 1.0, 1.0 + 1e-9, 1.3, 10.0] {
        // dt = 1, so that hz is f·dt from 1e-9 to 10.
        compare(&burst(300), 1.0, &hz, zeta);
    }
}

#[test]
fn a_step_and_a_single_spike() {
    let hz = [1e-9, 1e-4, 0.03, 0.2, 0.5, 1.7, 10.0];
    for zeta in [0.0, 0.05, 1.0, 3.0] {
        compare(&[1.0; 130], 1.0, &hz, zeta);
        let mut spike = vec![0.0; 200];
        spike[70] = -4.0;
        compare(&spike, 1.0, &hz, zeta);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    #[test]
    fn filter_is_exact_for_any_record(
        samples in prop::collection::vec(-100.0..100.0_f64, 2..400),
        zeta in 0.0..2.0_f64,
        exponent in -5.0..0.5_f64,
    ) {
        compare(&samples, 1e-4, &[1e4 * 10_f64.powf(exponent)], zeta);
    }
}

/// Samples as large as records may have; next to the largest floats, where what a turning point is found from passes
/// them, it went on for ever once.
#[test]
fn huge_samples_are_answered_like_small_ones() {
    let spectrum = |scale: f64, quantity| {
        let frequencies = Frequencies::list(vec![1e-9, 1e-3]).expect("frequencies");
        let damping = DampingRatio::new(0.1).expect("damping");
        let mut filter = SpectrumFilter::new(frequencies, damping, quantity, 1.0).expect("filter");
        filter.push(&[0.0, scale, -scale, 0.0, 0.1 * scale]);
        filter.finish().expect("spectrum").maximax
    };
    for quantity in QUANTITIES {
        let (huge, small) = (spectrum(1e100, quantity), spectrum(1.0, quantity));
        for i in 0..2 {
            assert!((huge[i] / 1e100 / small[i] - 1.0).abs() < 1e-12, "{quantity:?}: {:e}, {:e}", huge[i], small[i]);
        }
        assert_eq!(spectrum(1e305, quantity).len(), 2);
    }
}

/// A base that ends where it began, at rest: of a soft part that leaves far less than one rounding of the velocities on
/// the way. Records of whole numbers, whose integrals are exact.
#[test]
fn soft_parts_on_a_base_that_comes_back() {
    let dt = 1e-4;
    for (n, phase, zeta) in [
        (5, 1e-9, 0.0),
        (40, 1e-9, 0.7),
        (40, 1e-8, 2.0),
        (300, 1e-9, 0.0),
        (300, 1e-8, 0.05),
        (300, 1e-7, 0.0),
        (3000, 1e-9, 0.05),
    ] {
        // Second differences of a path that begins and ends in rest.
        let path = |i: i32| if (1..n).contains(&i) { f64::from(i % 97 * 71 % 199 - 99) } else { 0.0 };
        let samples: Vec<f64> = (-1..=n + 1).map(|i| path(i + 1) - 2.0 * path(i) + path(i - 1)).collect();
        let frequencies = Frequencies::list(vec![phase / dt]).expect("frequency");
        let damping = DampingRatio::new(zeta).expect("damping");
        let mut filter = SpectrumFilter::new(frequencies, damping, Quantity::RelativeDisplacement, dt).expect("filter");
        filter.push(&samples);
        let got = filter.finish().expect("spectrum");
        // By Laplace: 1/(s² + 2ζθs + θ²) = s⁻² − 2ζθ s⁻³ + (4ζ² − 1) θ² s⁻⁴ …, of −a dt² = −s² path dt².
        let once: f64 = (1..n).map(path).sum();
        let twice: f64 = (1..n).map(|i| path(i) * f64::from(n + 1 - i)).sum();
        let suspension = Suspension::from_hz(phase / dt, damping).expect("mount");
        let theta = suspension.omega() * dt;
        let [c1, c2, c3] = [-2.0 * zeta, 4.0 * zeta * zeta - 1.0, 4.0 * zeta - 8.0 * zeta.powi(3)];
        let left = State {
            displacement: -dt * dt * theta * (c1 * once + c2 * theta * twice),
            velocity: -dt * theta * theta * (c2 * once + c3 * theta * twice),
        };
        let ring = (0..200_000).map(|k| suspension.free(left, f64::from(k) * 1e-4 / suspension.omega()).displacement);
        let want = ring.fold(0.0, |most: f64, z| most.max(z.abs()));
        let off = (got.residual[0] - want).abs() / got.maximax[0];
        assert!(off <= RECORD.error, "{n} samples, f dt = {phase:e}, damping {zeta}: off by {off:e}");
    }
}

/// Checks a peak in the first step of a block, after the largest sample, the last of the block before: once missed.
#[test]
fn a_peak_between_samples_of_a_rough_record() {
    let hz = 1e4 * 10_f64.powf(-1.652_892_353_661_28);
    let frequencies = Frequencies::list(vec![hz]).expect("frequency");
    let damping = DampingRatio::new(0.780_344_792_223_943_6).expect("damping");
    for zeros in [1, 40, 62, 91] {
        let mut samples = vec![0.0; zeros];
        samples.extend([
            -59.284_529_868_747_605,
            -98.441_873_235_761_24,
            -77.179_702_717_545_61,
            80.657_460_828_120_49,
            0.0,
        ]);
        let mut filter =
            SpectrumFilter::new(frequencies.clone(), damping, Quantity::RelativeVelocity, 1e-4).expect("filter");
        filter.push(&samples);
        let filtered = filter.finish().expect("spectrum").primary[0];
        let points: Vec<(f64, f64)> = (0_u32..).map(|i| f64::from(i) * 1e-4).zip(samples).collect();
        let history = Pulses::piecewise_linear(&points).expect("history");
        let exact = history.spectrum(&frequencies, damping, Quantity::RelativeVelocity).primary[0];
        // Runge–Kutta with 20 000 steps a sample.
        assert!((exact - 0.015_603_992_494_9).abs() < 1e-11, "step by step after {zeros}: {exact}");
        assert!((filtered - 0.015_603_992_494_9).abs() < 1e-11, "filter after {zeros}: {filtered}");
    }
}

/// Checks a ramp so long that the bend at its end is rounding, beyond critical damping: the first dip was once missed.
#[test]
fn a_dip_at_the_start_of_a_long_ramp() {
    let damping = DampingRatio::new(1.035_481_347_345_282_2).expect("damping");
    let suspension = Suspension::from_hz(10_f64.powf(0.887_435_990_724_708), damping).expect("mount");
    let ramp = [(0.0, 49.254_086_951_025_3), (1.0, -3.408_668_997_919_896)];
    let whole = Pulses::piecewise_linear(&ramp).expect("history").respond(&suspension);
    // A tenth of a second in, the component has followed the jump of 49 m/s² to nearly its static place, −f/ω².
    let static_place = -(49.254_086_951_025_3 - 0.1 * 52.662_755_948_945_2) / suspension.omega().powi(2);
    assert!(whole.relative_displacement.negative.value < 0.9 * static_place, "{:?}", whole.relative_displacement);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    /// The history cut off at any instant ends within the peaks of the whole.
    #[test]
    fn no_instant_passes_the_peaks(
        values in prop::collection::vec(-100.0..100.0_f64, 2..12),
        zeta in 0.0..2.0_f64,
        exponent in -2.0..1.0_f64,
    ) {
        let suspension =
            Suspension::from_hz(10_f64.powf(exponent), DampingRatio::new(zeta).expect("damping")).expect("mount");
        let points: Vec<(f64, f64)> = (0_u32..).map(f64::from).zip(values).collect();
        let whole = Pulses::piecewise_linear(&points).expect("history").respond(&suspension);
        for i in 1..points.len() {
            let (before, after) = (points[i - 1], points[i]);
            for share in [0.1, 0.25, 0.4, 0.55, 0.7, 0.85, 1.0] {
                let mut part = points[..i].to_vec();
                part.push((before.0 + share, before.1 + share * (after.1 - before.1)));
                let state = Pulses::piecewise_linear(&part).expect("part").state_at_end(&suspension);
                for (value, range) in [
                    (state.displacement, whole.relative_displacement),
                    (state.velocity, whole.relative_velocity),
                    (suspension.absolute_acceleration(state), whole.absolute_acceleration),
                ] {
                    // Rounding of a dozen pieces.
                    let slack = 1e-12 * range.magnitude();
                    prop_assert!(
                        value <= range.positive.value + slack && value >= range.negative.value - slack,
                        "{} at {}: {:?}", value, i, range
                    );
                }
            }
        }
    }
}

/// Bursts in a long record with noise between: whole blocks are passed by where nothing new can be in them, and the
/// true peaks are those of the exact response all the same.
#[test]
fn long_records_with_quiet_stretches() {
    let mut state = 1_u64;
    let mut noise = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        f64::from(u32::try_from(state >> 32).expect("32 bits")) / f64::from(u32::MAX) - 0.5
    };
    for (bursts, floor) in [(1_u32, 0.0), (4, 0.1), (3, 3.0)] {
        let mut samples: Vec<f64> = (0..2600).map(|_| floor * noise()).collect();
        for b in 0..bursts {
            for i in 0..40 {
                let size = 100.0 * (1.0 - 0.2 * f64::from(b)) * (std::f64::consts::PI * f64::from(i) / 40.0).sin();
                samples[(150 + b * 610 + i) as usize] += if b % 2 == 0 { size } else { -size };
            }
        }
        let hz = [1e-7, 1e-5, 4e-4, 3e-3, 0.011, 0.013, 0.05, 0.11, 0.2, 0.45, 1.7];
        for zeta in [0.0, 1e-3, 0.05, 0.7, 1.0, 3.0] {
            compare(&samples, 1.0, &hz, zeta);
        }
    }
}
