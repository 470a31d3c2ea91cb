//! 16 trains of half-sines against a reference, and the amplification figures of the classical pulse shapes.

use clatter_shock::{DampingRatio, Frequencies, Pulse, Pulses, Quantity, Shape, Suspension};
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

/// Amplification A/a at f·D = `fd` and 1 Hz.
fn amplification(shape: Shape, damping: f64, fd: f64) -> f64 {
    let pulses = Pulses::new(&[Pulse { shape, amplitude: 1.0, duration: fd, start: 0.0 }]).expect("value");
    pulses.respond(&Suspension::from_hz(1.0, zeta(damping)).expect("value")).absolute_acceleration.magnitude()
}

/// Largest amplification for f·D in [lo, hi] by a golden section, and where.
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

/// A base that accelerates upward presses its component down, z < 0: the equivalent static acceleration is upward, +,
/// and the swing back −.
#[test]
fn signs_of_the_equivalent_static_acceleration() {
    for (shape, fd) in [(Shape::TerminalPeakSawtooth, 4.2), (Shape::InitialPeakSawtooth, 0.7), (Shape::Triangle, 0.1)] {
        for damping in [0.05, 0.5] {
            let suspension = Suspension::from_hz(1.0, zeta(damping)).expect("mount");
            let of = |amplitude| {
                let pulses = Pulses::new(&[Pulse { shape, amplitude, duration: fd, start: 0.0 }]).expect("pulse");
                let frequencies = Frequencies::list(vec![1.0]).expect("frequency");
                let quantity = Quantity::EquivalentStaticAcceleration;
                (pulses.respond(&suspension), pulses.spectrum(&frequencies, suspension.damping(), quantity))
            };
            let (up, up_spectrum) = of(3.0);
            let (down, down_spectrum) = of(-3.0);
            let got = up.equivalent_static_acceleration();
            let (most, back) = (got.positive.value, -got.negative.value);
            let name = format!("{shape:?} at damping {damping}");
            assert!(back > 0.0 && most > 1.05 * back, "{name}: +{most}, -{back}");
            // Each a product of the same peak, rounded another way.
            let close = |a: f64, b: f64| assert!((a - b).abs() <= 1e-14 * most, "{name}: {a}, not {b}");
            let square = suspension.omega() * suspension.omega();
            close(most, -square * up.relative_displacement.negative.value);
            close(back, square * up.relative_displacement.positive.value);
            close(got.positive.time, up.relative_displacement.negative.time);
            close(up_spectrum.positive[0], most);
            close(up_spectrum.negative[0], back);
            close(down_spectrum.positive[0], back);
            close(down_spectrum.negative[0], most);
            close(down.equivalent_static_acceleration().positive.value, back);
            close(-down.equivalent_static_acceleration().negative.value, most);
        }
    }
}
