//! The flights against figures computed elsewhere.

use clatter_flight::{Model, Motion, Profile, Scene, Stop};
use serde_json::Value;

/// Times are held to 1e-7 of themselves (of 0.1 ms at least), shocks to 1e-7 of the drop speed: the digits that the
/// reference, an event-driven integration in multiple precision, is known to have.
const ALLOWED: f64 = 1e-7;

fn cases() -> Vec<Value> {
    let text = include_str!("data/flight.json");
    let file: Value = serde_json::from_str(text).expect("as the test has it");
    file["cases"].as_array().expect("as the test has it").clone()
}

fn hold(model_name: &str, model: Model) {
    let mut held = 0;
    for (n, case) in cases().iter().enumerate().filter(|(_, c)| c["model"] == model_name) {
        let get = |name: &str| case[name].as_f64().expect("as the test has it");
        let body = Profile::new(get("length_m"), get("gyration_m")).expect("as the test has it");
        let v0 = get("speed_m_s");
        let scene = Scene::new(body, get("e"), v0, get("tilt_deg"), get("gravity_m_s2")).expect("as the test has it");
        let flight = scene.fly(model).expect("a motion");
        let wanted = case["impacts"].as_array().expect("as the test has it");
        assert!(flight.strikes.len() >= wanted.len(), "case {n}: {} strikes", flight.strikes.len());
        for (s, w) in flight.strikes.iter().zip(wanted) {
            let point = usize::from(w["end"] == "b");
            assert_eq!(s.point, point, "case {n}, strike {}", s.number);
            let t = w["time_s"].as_f64().expect("as the test has it");
            assert!(
                (s.time_s - t).abs() <= ALLOWED * t.max(1e-4),
                "case {n}, strike {}: {} not {t}",
                s.number,
                s.time_s
            );
            for k in 0..2 {
                let d = w["delta_v_m_s"][k].as_f64().expect("as the test has it");
                let got = s.delta_v_m_s[k];
                assert!((got - d).abs() <= ALLOWED * v0, "case {n}, strike {}: Δv {got} not {d}", s.number);
            }
        }
        held += 1;
    }
    assert_eq!(held, 20, "cases of {model_name}");
}

#[test]
fn ballistic_agrees_with_the_reference() {
    hold("ballistic", Model::Ballistic);
}

#[test]
fn finite_tilt_agrees_with_the_reference() {
    hold("finite-tilt", Model::FiniteTilt);
}

/// A phone: half-length 70 mm, 4.43 m/s, in units of h0/v0.
fn phone(q: f64, e: f64, model: Model) -> (Motion, f64) {
    let half = 0.07;
    let gyration = half * ((1.0 - q) / (1.0 + q)).sqrt();
    let scene = Scene::new(Profile::new(2.0 * half, gyration).expect("as the test has it"), e, 4.43, 5.0, 9.81)
        .expect("as the test has it");
    (scene.fly(model).expect("a motion"), scene.height_gap_m() / scene.speed_m_s())
}

/// The first strikes after number 1, to the digits printed.
fn hold_times(got: &(Motion, f64), wanted: &[(usize, f64)]) {
    let (flight, unit) = got;
    for (s, &(point, time)) in flight.strikes[1..].iter().zip(wanted) {
        assert_eq!(s.point, point, "strike {}", s.number);
        let t = s.time_s / unit;
        assert!((t - time).abs() <= 5.1e-5 * time.max(1.0), "strike {}: {t}, not {time}", s.number);
    }
}

#[test]
fn gravity_brings_the_fourth_strike_forward() {
    let wanted = [(1, 0.6054), (0, 0.8370), (1, 5.2763), (1, 9.1507), (1, 10.313)];
    hold_times(&phone(0.5, 0.3, Model::Ballistic), &wanted);
}

#[test]
fn gravity_brings_the_body_to_rest_where_the_map_goes_on() {
    let (flight, unit) = phone(0.73, 0.2, Model::Ballistic);
    let Stop::AtRest { time_s, time_bound_s, shock_bound_m_s } = flight.stop else { panic!("{:?}", flight.stop) };
    assert!((time_s / unit - 0.7465).abs() < 5e-5, "at rest at {}", time_s / unit);
    assert!(time_bound_s <= f64::EPSILON * time_s, "time bound {time_bound_s:e}");
    assert!(shock_bound_m_s <= f64::EPSILON * 10.0, "shock bound {shock_bound_m_s:e}");
    // In the end every pair of strikes is 0.335234 of the pair before.
    let [.., x, _, z] = flight.strikes.as_slice() else { panic!("too few strikes") };
    let ratio = z.approach_m_s / x.approach_m_s;
    assert!((ratio - 0.335_234).abs() < 1e-6, "{ratio}");
    let (map, unit) = phone(0.73, 0.2, Model::Map);
    assert_eq!(map.strikes.len(), 16);
    assert!((map.stop.time_s() / unit - 2.203).abs() < 5e-4, "map until {}", map.stop.time_s() / unit);
}

#[test]
fn a_body_that_has_bounced_clear_comes_back() {
    // The figures in units of v0 are the shocks 0.40 and 0.76 of the first strikes back, near 87 h0/v0.
    let (flight, unit) = phone(0.5, 0.5, Model::Ballistic);
    let back = &flight.strikes[3];
    assert!((back.time_s / unit - 87.0).abs() < 0.5, "back at {}", back.time_s / unit);
    let shock = |k: usize| flight.strikes[k].delta_v_m_s.map(f64::abs).into_iter().fold(0.0, f64::max) / 4.43;
    assert!((shock(3) - 0.40).abs() < 5e-3, "{}", shock(3));
    assert!((shock(4) - 0.76).abs() < 5e-3, "{}", shock(4));
}

#[test]
fn finite_tilt_of_five_degrees_is_later_by_tenths() {
    let wanted = [(1, 0.6058), (0, 0.8408), (1, 5.6352), (1, 9.5126), (1, 10.6722)];
    hold_times(&phone(0.5, 0.3, Model::FiniteTilt), &wanted);
    let back = [0.5712, 0.9227, 92.879, 128.80, 143.26];
    let (flight, unit) = phone(0.5, 0.5, Model::FiniteTilt);
    for (s, time) in flight.strikes[1..].iter().zip(back) {
        assert!((s.time_s / unit - time).abs() <= 5.1e-5 * time.max(1.0), "strike {}: {}", s.number, s.time_s / unit);
    }
}
