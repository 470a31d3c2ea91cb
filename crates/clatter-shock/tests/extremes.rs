//! The motion at extreme frequencies, times and dampings, against values computed with 100 digits
//! (`data/make_extremes.py`).

use clatter_shock::accuracy::{FREE, PULSE};
use clatter_shock::{DampingRatio, Pulse, Pulses, Shape, State, Suspension};
use serde_json::Value;

fn data() -> Value {
    serde_json::from_str(include_str!("data/extremes.json")).expect("data")
}

fn number(v: &Value) -> f64 {
    v.as_f64().unwrap_or_else(|| v.as_str().and_then(|s| s.parse().ok()).expect("a number"))
}

#[test]
fn free_motion_is_exact_from_a_millionth_of_a_period_to_a_trillion() {
    let data = data();
    let cases = data["free"].as_array().expect("cases");
    assert_eq!(cases.len(), 117, "cases");
    for c in cases {
        let n = |k: &str| number(&c[k]);
        let (zeta, omega, t) = (n("zeta"), n("omega"), n("t"));
        let suspension = Suspension::new(omega, DampingRatio::new(zeta).expect("damping")).expect("suspension");
        let start = State { displacement: n("displacement"), velocity: n("velocity") };
        let after = suspension.free(start, t);
        // The stated accuracy: roundings of the start, decayed; beyond critical damping also of the exponent.
        let exponent = if zeta > 1.0 { omega * t / zeta } else { 0.0 };
        let size = (omega * start.displacement).abs() + start.velocity.abs();
        let tau = omega * t;
        // Near critical damping the motion itself grows by 1 + τ before it decays.
        let growth = if (zeta - 1.0).abs() < 0.2 { 1.0 + tau } else { 1.0 };
        let allowed = (FREE.error + exponent * f64::EPSILON) * size * growth * n("slow_decay") + f64::MIN_POSITIVE;
        for (name, got, want) in [("x", omega * after.displacement, n("x")), ("y", after.velocity, n("y"))] {
            assert!(
                (got - want).abs() <= allowed,
                "{name} at damping {zeta:?}, omega t {tau:e}: {got:?}, not {want:?}"
            );
        }
    }
}

#[test]
fn half_sine_is_exact_at_resonance_and_at_critical_damping() {
    let data = data();
    let cases = data["half_sine_end"].as_array().expect("cases");
    assert_eq!(cases.len(), 96, "cases");
    let pulse = Pulse { shape: Shape::HalfSine, amplitude: 1.0, duration: 1.0, start: 0.0 };
    let pulses = Pulses::new(&[pulse]).expect("pulses");
    let mut worst = [0.0_f64; 2];
    for c in cases {
        let n = |k: &str| number(&c[k]);
        let (zeta, omega) = (n("zeta"), n("omega"));
        let suspension = Suspension::new(omega, DampingRatio::new(zeta).expect("damping")).expect("suspension");
        let state = pulses.state_at_end(&suspension);
        let (x, y) = (n("x"), n("y"));
        let scale = x.hypot(y);
        for (i, (got, want, own)) in
            [(omega * state.displacement, x, x.abs()), (state.velocity, y, scale)].into_iter().enumerate()
        {
            // A soft mount keeps the relative accuracy of its small displacement.
            let scale = if i == 0 && omega <= 0.01 { own } else { scale };
            worst[i] = worst[i].max((got - want).abs() / scale);
            assert!(
                (got - want).abs() <= PULSE.error * scale,
                "{i}: damping {zeta:?}, omega {omega:?}: {got:?}, not {want:?}"
            );
        }
    }
    assert!(worst[0] > 0.0, "not compared with itself");
}

/// Turning points within pulses and after them, of both signs, on mounts from slow to stiff, at resonance and at
/// critical damping.
#[test]
fn peaks_of_pulses_are_exact() {
    let data = data();
    let cases = data["pulse_peaks"].as_array().expect("cases");
    assert_eq!(cases.len(), 140, "cases");
    for c in cases {
        let n = |k: &str| number(&c[k]);
        let (zeta, omega) = (n("zeta"), n("omega"));
        let shape = match c["shape"].as_str().expect("a shape") {
            "half-sine" => Shape::HalfSine,
            "haversine" => Shape::Haversine,
            "triangle" => Shape::Triangle,
            "trapezoid" => Shape::Trapezoid { ramp: 0.25 },
            other => panic!("{other}"),
        };
        let suspension = Suspension::new(omega, DampingRatio::new(zeta).expect("damping")).expect("suspension");
        let pulses = Pulses::new(&[Pulse { shape, amplitude: 1.0, duration: 1.0, start: 0.0 }]).expect("pulse");
        let response = pulses.respond(&suspension);
        for (name, got, high, low) in [
            ("ωz", response.pseudo_velocity(), n("x_high"), n("x_low")),
            ("A/ω", response.acceleration_over_omega(), n("a_high"), n("a_low")),
        ] {
            let allowed = PULSE.error * high.max(-low);
            for (got, want) in [(got.positive.value, high), (got.negative.value, low)] {
                assert!(
                    (got - want).abs() <= allowed,
                    "{name} of {shape:?} at damping {zeta:?}, omega {omega:?}: {got:?}, not {want:?}"
                );
            }
        }
    }
}

/// Pulses that push to and fro: 1 s down, 1 s up twice as hard, 1 s down. A soft part turns at 1.5 s, 0.75 m from where
/// it was, which is far below the static motion that a constant push makes it swing about. Values of the closed form in
/// 50 digits.
#[test]
fn soft_parts_turn_under_a_constant_push_where_they_do() {
    let rectangle = |amplitude, start| Pulse { shape: Shape::Rectangle, amplitude, duration: 1.0, start };
    let pulses = Pulses::new(&[rectangle(-1.0, 0.0), rectangle(2.0, 1.0), rectangle(-1.0, 2.0)]).expect("pulses");
    let zeta = DampingRatio::new(0.0).expect("damping");
    for (hz, displacement) in [
        (1e-9, 0.75),
        (1e-7, 0.749_999_999_999_919_8),
        (1e-5, 0.749_999_999_198_094_6),
        (1e-3, 0.749_991_981_068_385_9),
    ] {
        let suspension = Suspension::from_hz(hz, zeta).expect("a part");
        let response = pulses.respond(&suspension);
        let omega2 = suspension.omega() * suspension.omega();
        for (got, want) in [
            (response.relative_displacement.magnitude(), displacement),
            (response.absolute_acceleration.magnitude(), omega2 * displacement),
        ] {
            assert!((got / want - 1.0).abs() < 1e-14, "{hz} Hz: {got:e}, not {want:e}");
        }
    }
}
