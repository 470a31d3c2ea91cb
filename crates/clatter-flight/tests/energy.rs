//! Energy: lost at strikes alone, exactly (1 − e²) of what the strike's normal speed carries.

use clatter_flight::{Model, Motion, Profile, Scene, Strike};
use proptest::prelude::*;

/// Energy per unit mass, `½ v_y² + ½ ρ² ω² + g y`, with the given velocities of the ends and angular velocity.
fn energy(body: &Profile, g: f64, s: &Strike, v: [f64; 2], spin: f64) -> f64 {
    let [a, b] = body.arms_m();
    let center = |of: [f64; 2]| (b * of[0] + a * of[1]) / (a + b);
    0.5 * (center(v).powi(2) + (body.gyration_m() * spin).powi(2)) + g * center(s.height_m)
}

fn before(s: &Strike) -> [f64; 2] {
    [s.velocity_m_s[0] - s.delta_v_m_s[0], s.velocity_m_s[1] - s.delta_v_m_s[1]]
}

fn scene(q: f64, e: f64, tilt: f64) -> Scene {
    let half = 0.07;
    let gyration = half * ((1.0 - q) / (1.0 + q)).sqrt();
    Scene::new(Profile::new(2.0 * half, gyration).expect("as the test has it"), e, 4.43, tilt, 9.81)
        .expect("as the test has it")
}

/// Largest relative drift of the energy over the flight of an elastic body.
fn drift(flight: &Motion, scene: &Scene) -> f64 {
    let e0 = 0.5 * scene.speed_m_s().powi(2) + scene.gravity_m_s2() * scene.body().arms_m()[0] * scene.tilt_rad().sin();
    let of = |s: &Strike| energy(&scene.body(), scene.gravity_m_s2(), s, s.velocity_m_s, s.spin_rad_s);
    flight.strikes.iter().map(|s| (of(s) / e0 - 1.0).abs()).fold(0.0, f64::max)
}

#[test]
fn ten_thousand_elastic_strikes_keep_the_energy() {
    for model in [Model::Ballistic, Model::FiniteTilt] {
        for q in [-0.6, 0.0, 0.3, 0.5, 0.8, 0.95, 0.995, 0.9995] {
            for tilt in [1e-6, 1.0, 5.0, 30.0, 80.0] {
                let scene = scene(q, 1.0, tilt).with_impact_limit(10_000).expect("as the test has it");
                let flight = scene.fly(model).expect("a motion");
                assert_eq!(flight.strikes.len(), 10_000);
                let drift = drift(&flight, &scene);
                let allowed = 1e-13 * (0.05 / (1.0 - q)).max(1.0);
                assert!(drift <= allowed, "{model:?} q {q} tilt {tilt}: {drift:e} of {allowed:e}");
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, max_shrink_iters: 0, ..ProptestConfig::default() })]

    /// From strike to strike the energy changes by the strike's loss alone.
    #[test]
    fn strikes_lose_what_the_theory_says(
        q in -0.8..0.95_f64, e in 0.0..=1.0_f64, tilt in 0.01..60.0_f64, model in prop_oneof![Just(Model::Ballistic), Just(Model::FiniteTilt)],
    ) {
        let scene = scene(q, e, tilt).with_impact_limit(200).expect("as the test has it");
        let (body, g, finite) = (scene.body(), scene.gravity_m_s2(), model == Model::FiniteTilt);
        let flight = scene.fly(model).expect("a motion");
        let rho2 = body.gyration_m().powi(2);
        let e0 = 0.5 * 4.43 * 4.43;
        let mut kept = 0.5 * 4.43_f64.powi(2) + g * 0.07 * scene.tilt_rad().sin();
        for s in &flight.strikes {
            let x = 0.07 * if finite { s.tilt_rad.cos() } else { 1.0 };
            let x2 = x * x;
            let struck = s.point;
            let side = [-1.0, 1.0][struck];
            let spin_before = s.spin_rad_s - side * x * s.delta_v_m_s[struck] / (x2 + rho2);
            let now = energy(&body, g, s, before(s), spin_before);
            // Some tens of roundings of the first energy.
            let budget = 100.0 * f64::EPSILON * e0;
            prop_assert!((now - kept).abs() <= budget, "strike {}: {now} arrived, {kept} left; {model:?}", s.number);
            let lost = 0.5 * rho2 / (rho2 + x2) * (1.0 - e * e) * s.approach_m_s.powi(2);
            kept = energy(&body, g, s, s.velocity_m_s, s.spin_rad_s);
            prop_assert!((now - kept - lost).abs() <= budget, "strike {}: lost {}, not {lost}", s.number, now - kept);
        }
    }
}
