//! How fast each model tends to the one below it: the figures of the accuracy table.

use clatter::flight::{Body, Flight, Model, Scene};

/// Half-length 70 mm, q = ½, e = 0.3, 4.43 m/s: a train of four.
fn scene(tilt_deg: f64, gravity: f64) -> Scene {
    let half = 0.07;
    let body = Body::new(2.0 * half, half / 3.0_f64.sqrt()).expect("as the test has it");
    Scene::new(body, 0.3, 4.43, tilt_deg, gravity).expect("as the test has it")
}

/// Largest relative difference of times and shocks over the first three strikes.
fn distance(a: &Flight, b: &Flight) -> f64 {
    let mut worst = 0.0_f64;
    for (a, b) in a.strikes.iter().zip(&b.strikes).take(3) {
        assert_eq!(a.end, b.end, "strike {}", a.number);
        worst = worst.max((a.time_s - b.time_s).abs() / b.time_s.max(f64::MIN_POSITIVE));
        for k in 0..2 {
            worst = worst.max((a.delta_v_m_s[k] - b.delta_v_m_s[k]).abs() / 4.43);
        }
    }
    worst
}

fn orders(errors: &[f64], ratio: f64) -> Vec<f64> {
    errors.windows(2).map(|e| (e[0] / e[1]).ln() / ratio.ln()).collect()
}

#[test]
fn finite_tilt_tends_to_the_map_as_the_tilt_squared() {
    let errors: Vec<_> = [4.0, 2.0, 1.0, 0.5, 0.25]
        .map(|tilt| distance(&scene(tilt, 0.0).simulate(Model::FiniteTilt), &scene(tilt, 0.0).simulate(Model::Map)))
        .to_vec();
    assert!(orders(&errors, 2.0).iter().all(|o| (o - 2.0).abs() < 0.02), "{errors:?}");
    let flat = scene(1e-6, 0.0);
    assert!(distance(&flat.simulate(Model::FiniteTilt), &flat.simulate(Model::Map)) < 1e-12);
}

#[test]
fn ballistic_tends_to_the_map_as_gravity() {
    let errors: Vec<_> = [9.81, 0.981, 0.0981, 0.00981]
        .map(|g| distance(&scene(5.0, g).simulate(Model::Ballistic), &scene(5.0, 0.0).simulate(Model::Map)))
        .to_vec();
    assert!(orders(&errors, 10.0).iter().all(|o| (o - 1.0).abs() < 0.05), "{errors:?}");
    // Gravity too weak to act is none.
    assert!(distance(&scene(5.0, 1e-40).simulate(Model::Ballistic), &scene(5.0, 0.0).simulate(Model::Map)) < 1e-12);
}

#[test]
fn ballistic_and_finite_tilt_agree_at_vanishing_tilt_with_gravity() {
    let errors: Vec<_> = [4.0, 2.0, 1.0, 0.5]
        .map(|tilt| {
            distance(&scene(tilt, 9.81).simulate(Model::FiniteTilt), &scene(tilt, 9.81).simulate(Model::Ballistic))
        })
        .to_vec();
    assert!(orders(&errors, 2.0).iter().all(|o| (o - 2.0).abs() < 0.05), "{errors:?}");
}

/// The simulation by closed-form quadratics and the map by closed forms, strike by strike, where no gravity acts yet.
#[test]
fn weak_gravity_is_the_map_for_long_trains() {
    for (q, e) in [(0.73, 0.2), (0.5, 0.5), (0.9, 0.5), (0.95, 0.9), (-0.4, 0.7)] {
        let half = 0.07;
        let body = Body::new(2.0 * half, half * ((1.0 - q) / (1.0_f64 + q)).sqrt()).expect("as the test has it");
        let scene = |g: f64| {
            Scene::new(body, e, 4.43, 5.0, g)
                .expect("as the test has it")
                .with_impact_limit(40)
                .expect("as the test has it")
        };
        let (map, weak) = (scene(0.0).simulate(Model::Map), scene(1e-40).simulate(Model::Ballistic));
        for (m, w) in map.strikes.iter().zip(&weak.strikes) {
            assert_eq!(m.end, w.end, "q {q} e {e}");
            assert!((m.time_s - w.time_s).abs() <= 1e-12 * m.time_s, "q {q} e {e}: {} {}", m.time_s, w.time_s);
            assert!((m.approach_m_s - w.approach_m_s).abs() <= 1e-12 * 4.43, "q {q} e {e}");
        }
    }
}
