//! 16 trains of half-sines against a reference, and the amplification figures of the classical pulse shapes.

use clatter_shock::{
    DampingRatio, Frequencies, Pulse, Pulses, Quantity, Response, Shape, SpectrumFilter, Suspension, VelocityShock,
    VelocityShocks,
};
use serde_json::Value;
use std::f64::consts::{FRAC_PI_2, TAU};

fn zeta(z: f64) -> DampingRatio {
    DampingRatio::new(z).expect("value")
}

#[test]
fn maximax_of_the_reference_trains() {
    let data: Value = serde_json::from_str(include_str!("data/spectrum.json")).expect("value");
    let cases = data["cases"].as_array().expect("value");
    assert_eq!(cases.len(), 16, "cases");
    let numbers =
        |v: &Value| -> Vec<f64> { v.as_array().expect("value").iter().map(|x| x.as_f64().expect("value")).collect() };
    for (i, case) in cases.iter().enumerate() {
        let pulses: Vec<Pulse> = case["pulses"]
            .as_array()
            .expect("value")
            .iter()
            .map(|p| Pulse {
                shape: Shape::HalfSine,
                amplitude: p["amplitude_m_s2"].as_f64().expect("value"),
                duration: p["duration_s"].as_f64().expect("value"),
                start: p["start_s"].as_f64().expect("value"),
            })
            .collect();
        let frequencies = Frequencies::list(numbers(&case["frequency_hz"])).expect("value");
        let got = Pulses::new(&pulses).expect("value").spectrum(
            &frequencies,
            zeta(case["damping"].as_f64().expect("value")),
            Quantity::AbsoluteAcceleration,
        );
        for ((f, got), want) in frequencies.hz().iter().zip(&got.maximax).zip(numbers(&case["maximax_acceleration"])) {
            let error = (got / want - 1.0).abs();
            // Up to ten pulses of a few tens of roundings each.
            assert!(error <= 1e-12, "case {i}, {f} Hz: {got:?}, not {want:?}, off by {error:e}");
        }
    }
}

/// Returns the amplification A/a at f·D = `fd` and 1 Hz.
fn amplification(shape: Shape, damping: f64, fd: f64) -> f64 {
    let pulses = Pulses::new(&[Pulse { shape, amplitude: 1.0, duration: fd, start: 0.0 }]).expect("value");
    pulses.respond(&Suspension::from_hz(1.0, zeta(damping)).expect("value")).absolute_acceleration.magnitude()
}

/// Returns the largest amplification for f·D in [lo, hi] by a golden section, and where.
fn largest(shape: Shape, damping: f64, mut lo: f64, mut hi: f64) -> (f64, f64) {
    let ratio = 0.5 * (5_f64.sqrt() - 1.0);
    for _ in 0..60 {
        let (a, b) = (hi - ratio * (hi - lo), lo + ratio * (hi - lo));
        if amplification(shape, damping, a) < amplification(shape, damping, b) { lo = a } else { hi = b }
    }
    let at = 0.5 * (lo + hi);
    (amplification(shape, damping, at), at)
}

#[test]
fn amplification_and_knee_of_each_shape() {
    // Largest amplification, where (f·D), and the knee ω Δv/A: published charts agree to their three digits.
    for (shape, damping, height, place, knee) in [
        (Shape::HalfSine, 0.0, "1.768458", "0.80994", "1.83196"),
        (Shape::HalfSine, 0.05, "1.6516", "0.8233", ""),
        (Shape::Haversine, 0.0, "1.705143", "1.0", "1.842422"),
        (Shape::Triangle, 0.0, "1.517178", "0.904593", "1.873125"),
        (Shape::TerminalPeakSawtooth, 0.0, "1.259591", "0.650239", "1.621787"),
        (Shape::Trapezoid { ramp: 0.1 }, 0.0, "1.994446", "0.57809", "1.639057"),
    ] {
        let (amplification, fd) = largest(shape, damping, 0.4, 1.2);
        let digits = |text: &str, x: f64| {
            let places = text.split('.').nth(1).map_or(0, str::len);
            assert_eq!(format!("{x:.places$}"), text, "{shape:?} at damping {damping}: {x}");
        };
        digits(height, amplification);
        digits(place, fd);
        if !knee.is_empty() {
            digits(knee, TAU * fd * shape.area() / amplification);
        }
    }
    for fd in [0.5, 0.75, 3.0, 40.0] {
        assert!((amplification(Shape::Rectangle, 0.0, fd) - 2.0).abs() < 1e-14, "rectangle at {fd}");
    }
    assert!(amplification(Shape::Rectangle, 0.0, 0.499) < 2.0, "rectangle below half a period");
    assert!((TAU * 0.5 / amplification(Shape::Rectangle, 0.0, 0.5) - FRAC_PI_2).abs() < 1e-14, "knee of the rectangle");
}

#[test]
fn a_strong_short_shock_on_a_mount() {
    // 1000 g, 1 ms half-sine on a 100 Hz mount.
    let g = 9.80665;
    let pulse = Pulse { shape: Shape::HalfSine, amplitude: 1000.0 * g, duration: 1e-3, start: 0.0 };
    let pulses = Pulses::new(&[pulse]).expect("value");
    for (damping, acceleration, displacement) in [(0.05, "369", "9.12"), (0.25, "321", "7.00"), (0.5, "381", "5.38")] {
        let r = pulses.respond(&Suspension::from_hz(100.0, zeta(damping)).expect("value"));
        assert_eq!(format!("{:.0}", r.absolute_acceleration.magnitude() / g), acceleration, "at {damping}");
        assert_eq!(format!("{:.2}", r.relative_displacement.magnitude() * 1e3), displacement, "at {damping}");
    }
}

/// Positive of ω²z is ω² times positive of z, in spectra and in responses: one sign for all that is made of z.
#[test]
fn equivalent_static_acceleration_has_the_sign_of_the_displacement() {
    for (shape, fd) in [(Shape::TerminalPeakSawtooth, 4.2), (Shape::InitialPeakSawtooth, 0.7), (Shape::Triangle, 0.1)] {
        for damping in [0.05, 0.5] {
            let suspension = Suspension::from_hz(1.0, zeta(damping)).expect("mount");
            let pulses = Pulses::new(&[Pulse { shape, amplitude: 3.0, duration: fd, start: 0.0 }]).expect("pulse");
            let spectrum = |quantity| {
                let frequencies = Frequencies::list(vec![1.0]).expect("frequency");
                pulses.spectrum(&frequencies, suspension.damping(), quantity)
            };
            let z = spectrum(Quantity::RelativeDisplacement);
            let a = spectrum(Quantity::EquivalentStaticAcceleration);
            let name = format!("{shape:?} at damping {damping}");
            let square = suspension.omega() * suspension.omega();
            // A base that accelerates upward drives z downward first, and least of it comes back.
            assert!(z.negative[0] > 1.05 * z.positive[0], "{name}: {z:?}");
            // Each a product of the same peak, rounded another way.
            let close =
                |a: f64, b: f64| assert!((a - b).abs() <= 1e-14 * square * z.maximax[0], "{name}: {a}, not {b}");
            close(a.positive[0], square * z.positive[0]);
            close(a.negative[0], square * z.negative[0]);
            let response = pulses.respond(&suspension);
            let (got, z) = (response.equivalent_static_acceleration(), response.relative_displacement);
            close(got.positive.value, square * z.positive.value);
            close(got.negative.value, square * z.negative.value);
            close(got.positive.time, z.positive.time);
        }
    }
}

/// Checks the five quantities at three dampings, from shocks, pulses, and the same history sampled.
#[test]
fn signs_of_both_parts_and_the_time_of_the_peak_are_those_of_the_response() {
    let list = [(0.3, 2.0), (0.9, -3.1), (1.7, 1.2)];
    let shocks =
        VelocityShocks::new(list.map(|(time, delta_v)| VelocityShock { time, delta_v }).to_vec()).expect("shocks");
    let pulses = list.map(|(start, amplitude)| Pulse { shape: Shape::HalfSine, amplitude, duration: 0.4, start });
    let pulses = Pulses::new(&pulses).expect("pulses");
    let points: Vec<(f64, f64)> =
        (0_u32..40).map(|i| (0.7 + 0.05 * f64::from(i), f64::from(i * i * 37 % 41) - 18.0)).collect();
    let lines = Pulses::piecewise_linear(&points).expect("lines");
    let hz: Vec<f64> = (0..23).map(|i| 0.05 * 1.35_f64.powi(i)).collect();
    let frequencies = Frequencies::list(hz.clone()).expect("frequencies");
    for damping in [0.0, 0.05, 1.0, 2.5].map(zeta) {
        for quantity in [Quantity::AbsoluteAcceleration, Quantity::RelativeDisplacement, Quantity::RelativeVelocity] {
            let mut filter = SpectrumFilter::new(frequencies.clone(), damping, quantity, 0.05).expect("filter");
            filter = filter.starting_at(0.7).expect("start");
            filter.push(&points.iter().map(|p| p.1).collect::<Vec<_>>());
            let of = |r: &Response| match quantity {
                Quantity::AbsoluteAcceleration => r.absolute_acceleration,
                Quantity::RelativeDisplacement => r.relative_displacement,
                _ => r.relative_velocity,
            };
            let respond = |hz: f64| {
                let suspension = Suspension::from_hz(hz, damping).expect("mount");
                [shocks.respond(&suspension), pulses.respond(&suspension), lines.respond(&suspension)].map(|r| of(&r))
            };
            let spectra = [
                (shocks.spectrum(&frequencies, damping, quantity), 0),
                (pulses.spectrum(&frequencies, damping, quantity), 1),
                (lines.spectrum(&frequencies, damping, quantity), 2),
                (filter.finish().expect("spectrum"), 2),
            ];
            for (kind, (s, which)) in spectra.iter().enumerate() {
                for (i, hz) in hz.iter().enumerate() {
                    let name = format!("{kind} at {hz} Hz, {damping:?}, {quantity:?}");
                    // Both parts make up the whole, the very same numbers.
                    let same = |a: f64, b: f64| assert!(a.to_bits() == b.to_bits(), "{name}: {a}, {b}");
                    same(s.positive[i], s.primary_positive[i].max(s.residual_positive[i]));
                    same(s.negative[i], s.primary_negative[i].max(s.residual_negative[i]));
                    same(s.primary[i], s.primary_positive[i].max(s.primary_negative[i]));
                    same(s.residual[i], s.residual_positive[i].max(s.residual_negative[i]));
                    same(s.maximax[i], s.positive[i].max(s.negative[i]));
                    let want = respond(*hz)[*which];
                    // Peaks that are nearly equal may change places.
                    let (p, n) = (want.positive.value, -want.negative.value);
                    if (p / n - 1.0).abs() > 1e-9 {
                        let off = (s.time_of_peak_s[i] - want.peak().time).abs();
                        // √ε of a radian: the motion is flat there.
                        assert!(off <= 1e-7 / (TAU * hz) + 1e-12, "{name}: off by {off:e} s, {want:?}");
                    }
                }
            }
        }
    }
}

/// The first of equal peaks counts: two pulses so far apart that nothing is left of the first, a block of samples or
/// many between them.
#[test]
fn of_equal_peaks_the_first_is_told() {
    for gap in [40_u32, 500, 9000] {
        let sample = |i: u32| if (3..9).contains(&(i % gap)) { f64::from(i % gap) } else { 0.0 };
        let samples: Vec<f64> = (0..2 * gap).map(sample).collect();
        for (hz, zeta_of) in [(2.0, 3.0), (0.3, 1.0)] {
            let frequencies = Frequencies::list(vec![hz]).expect("frequency");
            let mut filter =
                SpectrumFilter::new(frequencies, zeta(zeta_of), Quantity::AbsoluteAcceleration, 1.0).expect("filter");
            filter.push(&samples);
            let time = filter.finish().expect("spectrum").time_of_peak_s[0];
            assert!((7.0..12.0).contains(&time), "{hz} Hz, {gap} samples apart: {time} s");
        }
    }
    // Without damping the swing back is as large.
    let shock = VelocityShocks::new(vec![VelocityShock { time: 2.0, delta_v: -1.0 }]).expect("shock");
    let frequencies = Frequencies::list(vec![0.25]).expect("frequency");
    let spectrum = shock.spectrum(&frequencies, zeta(0.0), Quantity::RelativeDisplacement);
    assert!((spectrum.time_of_peak_s[0] - 3.0).abs() < 1e-7, "a quarter of a period: {spectrum:?}");
}
