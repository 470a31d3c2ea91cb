//! Drops that were integrated by another program.
#![allow(clippy::unwrap_used, reason = "tests")]

use clatter_brute::flight::{Drop, Law, Own, Until, follow};
use clatter_brute::part::{Motion, Stop, Suspension, largest, largest_acceleration, respond, shocks};
use clatter_brute::solid::{Solid, Vector};
use serde_json::Value;

fn cases(text: &str) -> Vec<Value> {
    let file: Value = serde_json::from_str(text).unwrap();
    file["cases"].as_array().unwrap().clone()
}

fn number(case: &Value, key: &str) -> f64 {
    case[key].as_f64().unwrap()
}

fn drop_of(case: &Value) -> Drop {
    let length = number(case, "length_m");
    Drop {
        length,
        gyration: number(case, "gyration_m"),
        center: number(case, "center_of_mass") * length / 2.0,
        e: number(case, "e"),
        contact: Some((Law::Hysteretic, number(case, "contact_time_s"))),
        own: [Own::default(); 2],
        speed: number(case, "speed_m_s"),
        tilt: number(case, "tilt_deg").to_radians(),
        spin: 0.0,
        b_first: false,
        gravity: number(case, "gravity_m_s2"),
    }
}

/// Returns a place from the center of mass, given in half-lengths from the middle.
fn place(drop: &Drop, at: f64) -> f64 {
    at * drop.length / 2.0 - drop.center
}

/// Touches above a thousandth of the first speed are compared, and the peaks of a part. The peaks of the oracle are
/// samples, up to 2.5e-3 below the highest of the stiffest parts.
#[test]
fn contacts_and_parts_are_those_of_another_integration() {
    let cases = cases(include_str!("data/contact-bar.json"));
    assert_eq!(cases.len(), 26);
    for (i, case) in cases.iter().enumerate() {
        let (drop, until) = (drop_of(case), number(case, "until_s"));
        let flight = follow(&drop, Until { time: until, quiet: 0.0 });
        let micro = 1e-3 * drop.speed;
        let got: Vec<_> = flight.touches.iter().filter(|touch| touch.velocity.abs() > micro).collect();
        let touches = case["touches"].as_array().unwrap();
        let want: Vec<_> = touches.iter().filter(|touch| number(touch, "approach_m_s").abs() > micro).collect();
        assert_eq!(got.len(), want.len(), "case {i}: touches");
        for (got, want) in got.iter().zip(&want) {
            assert_eq!(["a", "b"][got.end], want["end"], "case {i}");
            let speed = (got.velocity - number(want, "approach_m_s")) / drop.speed;
            let time = (got.time - number(want, "time_s")) / until;
            assert!(speed.abs() < 1e-4 && time.abs() < 1e-4, "case {i}: {got:?}, not {want}");
        }
        let part = &case["part"];
        let omega = number(part, "omega_rad_s");
        let suspension = Suspension { omega, zeta: number(part, "damping"), stop: None };
        let response = respond(&flight, place(&drop, number(part, "at")), &suspension, Some(until));
        for (got, key) in [
            (response.displacement.value * omega, "omega_peak_displacement"),
            (response.acceleration.value / omega, "peak_acceleration_over_omega"),
        ] {
            let off = got / number(part, key) - 1.0;
            assert!((-2e-4..2.5e-3).contains(&off), "case {i}: {key} is off by {off:e}");
        }
    }
}

/// Returns the vertical in axes of the body, whose attitude is a quaternion.
fn upward(q: &[f64]) -> Vector {
    let [w, x, y, z] = [q[0], q[1], q[2], q[3]];
    [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)]
}

/// Boxes without friction, whose parts hit stops: peaks until a time, and every hit that is no micro-touch.
#[test]
fn parts_between_stops_are_those_of_another_integration() {
    let cases = cases(include_str!("../../../crates/clatter-assess/tests/data/stop.json"));
    assert_eq!(cases.len(), 24);
    for (i, case) in cases.iter().enumerate() {
        let list = |case: &Value, key: &str| -> Vec<f64> {
            case[key].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
        };
        let vector = |case: &Value, key: &str| -> Vector { list(case, key).try_into().unwrap() };
        let solid = Solid {
            sides: vector(case, "half_m").map(|half| 2.0 * half),
            center: vector(case, "center_of_mass_m"),
            radii: vector(case, "gyration_m"),
            askew: 0.0,
            e: number(case, "e"),
            contact: (Law::Hysteretic, number(case, "contact_time_s")),
            own: [Own::default(); 4],
            speed: number(case, "speed_m_s"),
            spin: vector(case, "spin_rad_s"),
            upward: upward(&list(case, "quaternion")),
            gravity: number(case, "gravity_m_s2"),
            friction: 0.0,
        };
        let until = number(case, "until_s");
        let course = clatter_brute::solid::follow(&solid, Until { time: until, quiet: 0.0 });
        let (part, stop) = (&case["part"], &case["part"]["stop"]);
        let at = vector(part, "at_m");
        let suspension = Suspension {
            omega: number(part, "omega_rad_s"),
            zeta: number(part, "damping"),
            stop: Some(Stop {
                gap: number(stop, "gap_m"),
                time: number(stop, "contact_time_s"),
                e: number(stop, "restitution"),
            }),
        };
        let axis = ["x", "y", "z"].iter().position(|axis| part["axis"] == *axis);
        let history = course.at(std::array::from_fn(|i| at[i] - solid.center[i]), axis);
        let response = respond(&history, 0.0, &suspension, Some(until));
        for (got, key) in [
            (response.displacement.value, "peak_displacement_m"),
            (response.acceleration.value, "peak_acceleration_m_s2"),
            (response.hardest().value, "largest_hit_m_s"),
        ] {
            let off = got / number(part, key) - 1.0;
            // The oracle says how far its own two integrations are apart.
            let most = f64::max(1e-3, 2.0 * number(case, "accuracy"));
            assert!(off.abs() < most, "case {i}: {key} is off by {off:e}");
        }
        assert_eq!(u64::try_from(response.hits.len()).ok(), part["hits"].as_u64(), "case {i}: {:?}", response.hits);
    }
}

#[test]
fn shocks_are_those_of_another_integration() {
    let cases = cases(include_str!("data/shocks.json"));
    assert_eq!(cases.len(), 40);
    for (i, case) in cases.iter().enumerate() {
        let drop = drop_of(case);
        let flight = follow(&drop, Until { time: 3.0, quiet: 1e-3 });
        let place = place(&drop, number(case, "at"));
        let velocity = largest(&shocks(&flight, place, Motion::Velocity)).value;
        let off = velocity / number(case, "velocity_change_m_s") - 1.0;
        assert!(off.abs() < 5e-5, "case {i}: velocity change off by {off:e}");
        let off = largest_acceleration(&flight, place).value / number(case, "acceleration_m_s2") - 1.0;
        assert!(off.abs() < 5e-5, "case {i}: acceleration off by {off:e}");
    }
}
