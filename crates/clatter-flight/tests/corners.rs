//! Bodies with corners at finite tilt: what a strike must keep, and where corners make no difference.

use clatter_flight::{Model, Profile, Scene, Stop, Strike};
use proptest::prelude::*;

/// Motion of the center of mass and the turning, from the velocities of both corners: `v = v_y + x ω`.
struct Motion {
    velocity: f64,
    spin: f64,
}

/// Lever arms of the corners, and the height of the center over the line through them, from the angle alone.
fn geometry(body: &Profile, s: &Strike) -> ([f64; 2], f64) {
    let ([a, b], half) = (body.arms_m(), 0.5 * body.thickness_m());
    let (sin, cos) = s.tilt_rad.sin_cos();
    ([-a * cos + half * sin, b * cos + half * sin], half * cos)
}

fn motion(x: [f64; 2], v: [f64; 2]) -> Motion {
    let spin = (v[1] - v[0]) / (x[1] - x[0]);
    Motion { velocity: v[0] - x[0] * spin, spin }
}

fn energy(scene: &Scene, s: &Strike, over: f64, m: &Motion) -> f64 {
    let body = scene.body();
    let [a, b] = body.arms_m();
    let height = (b * s.height_m[0] + a * s.height_m[1]) / (a + b) + over;
    0.5 * (m.velocity.powi(2) + (body.gyration_m() * m.spin).powi(2)) + scene.gravity_m_s2() * height
}

fn thick_scene() -> impl Strategy<Value = Scene> {
    // Up to 80°: near 90° the corners' velocities do not know the spin.
    (
        0.05..0.1_f64,
        0.5..2.0_f64,
        0.2..1.5_f64,
        0.01..1.0_f64,
        0.0..=1.0_f64,
        0.05..80.0_f64,
        0.0..20.0_f64,
        -0.5..0.5_f64,
    )
        .prop_map(|(a, ratio, gyration, thickness, e, tilt, g, spin)| {
            let body = Profile::off_center(a, a * ratio, gyration * a).expect("a body");
            let body = body.with_thickness(thickness * body.length_m()).expect("a thickness");
            let scene = Scene::new(body, e, 2.0, tilt, g).expect("a drop").with_impact_limit(100).expect("a limit");
            scene.with_spin(spin * 2.0 / a).unwrap_or(scene)
        })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, max_shrink_iters: 0, ..ProptestConfig::default() })]

    /// A strike keeps the angular momentum about the struck corner and takes `½ m (1 − e²) u²`; flight keeps the
    /// energy.
    #[test]
    fn a_strike_keeps_the_angular_momentum_about_its_corner(scene in thick_scene()) {
        let (body, e) = (scene.body(), scene.e());
        let rho2 = body.gyration_m().powi(2);
        let flight = scene.fly(Model::FiniteTilt).expect("a motion");
        let mut kept: Option<f64> = None;
        for s in &flight.strikes {
            if s.tilt_rad.abs() > 1.4 {
                kept = None;
                continue;
            }
            let i = s.point;
            let (x, over) = geometry(&body, s);
            let after = motion(x, s.velocity_m_s);
            let before = motion(x, [0, 1].map(|k| s.velocity_m_s[k] - s.delta_v_m_s[k]));
            // Some hundreds of roundings of the terms, the angle near 80° among them.
            let fast = s.velocity_m_s.iter().chain(&s.delta_v_m_s).fold(0.0, |m: f64, v| m.max(v.abs()));
            let blur = 1e-12 * (1.0 + 1.0 / s.tilt_rad.cos());
            let about = |m: &Motion| rho2 * m.spin - x[i] * m.velocity;
            let size = rho2 * after.spin.abs() + rho2 * before.spin.abs() + body.length_m() * fast;
            prop_assert!((about(&after) - about(&before)).abs() <= blur * size, "strike {}", s.number);
            prop_assert!((after.spin - s.spin_rad_s).abs() * body.length_m() <= blur * fast / s.tilt_rad.cos(), "strike {}", s.number);

            let lost = energy(&scene, s, over, &before) - energy(&scene, s, over, &after);
            let wanted = 0.5 * rho2 / (rho2 + x[i] * x[i]) * (1.0 - e * e) * s.approach_m_s.powi(2);
            let scale = energy(&scene, s, over, &before).max(fast * fast);
            prop_assert!((lost - wanted).abs() <= blur * scale, "strike {}: lost {lost}, not {wanted}", s.number);
            if let Some(kept) = kept {
                let came = energy(&scene, s, over, &before);
                prop_assert!((came - kept).abs() <= 1e-11 * scale.max(kept), "strike {}: {came} of {kept}", s.number);
            }
            kept = Some(energy(&scene, s, over, &after));
        }
    }
    /// However a thick body ends, it says how.
    #[test]
    fn thick_bodies_rest_or_turn_over(scene in thick_scene()) {
        let flight = scene.with_impact_limit(3000).expect("a limit").fly(Model::FiniteTilt).expect("a motion");
        let ordered = flight.strikes.windows(2).all(|p| p[0].time_s <= p[1].time_s);
        prop_assert!(ordered && flight.strikes.iter().all(|s| s.tilt_rad.abs() <= 0.5 * std::f64::consts::PI));
        prop_assert!(flight.strikes.iter().all(|s| s.delta_v_m_s.iter().chain(&s.height_m).all(|x| x.is_finite())));
        match flight.stop {
            Stop::AtRest { time_s, time_bound_s, .. } => prop_assert!(time_bound_s <= f64::EPSILON * time_s),
            Stop::TurnedOver { time_s } => prop_assert!(time_s.is_finite()),
            Stop::ImpactLimit { .. } => prop_assert!(scene.e() > 0.5 || scene.gravity_m_s2() < 1.0),
            stop => prop_assert!(matches!(stop, Stop::BouncedClear { .. }) && scene.gravity_m_s2() < 1e-60, "{stop:?}"),
        }
    }
}

fn brick(thickness: f64) -> Profile {
    Profile::new(0.14, 0.04).and_then(|b| b.with_thickness(thickness)).expect("a brick")
}

#[test]
fn a_flat_drop_knows_no_corners() {
    let strikes = |thickness| {
        let scene = Scene::new(brick(thickness), 0.3, 1.0, 0.0, 9.81).expect("a drop");
        let strikes = scene.fly(Model::FiniteTilt).expect("a motion").strikes;
        strikes.into_iter().take_while(|s| s.time_s == 0.0).collect::<Vec<_>>()
    };
    let (thin, thick) = (strikes(0.0), strikes(0.1));
    assert!(thin.len() == 4 && thick.len() == 4, "{} and {}", thin.len(), thick.len());
    for (a, b) in thin.iter().zip(&thick) {
        assert!((a.approach_m_s - b.approach_m_s).abs() < 1e-15, "{a:?} {b:?}");
    }
}

/// The lever arm is shorter by `(t/2) sin φ`: the first shock of the far end changes in proportion.
#[test]
fn thin_corners_tend_to_none_in_proportion() {
    let far = |thickness| {
        let scene = Scene::new(brick(thickness), 0.3, 1.0, 20.0, 9.81).expect("a drop");
        scene.fly(Model::FiniteTilt).expect("a motion").strikes[0].delta_v_m_s[1]
    };
    let thin = far(0.0);
    let off = [4e-3, 2e-3, 1e-3].map(|t| far(t) - thin);
    for pair in off.windows(2) {
        assert!(((pair[0] / pair[1]).log2() - 1.0).abs() < 0.05, "{off:?}");
    }
}

/// In flight without gravity the right angle comes when the spin has turned the body that far; on the ground, a tall
/// body whose center is beyond its corner topples.
#[test]
fn a_body_that_turns_past_its_end_says_when() {
    let scene = Scene::new(brick(0.02), 1.0, 1.0, 60.0, 0.0).and_then(|s| s.with_spin(80.0)).expect("a drop");
    let flight = scene.fly(Model::FiniteTilt).expect("a motion");
    let Stop::TurnedOver { time_s } = flight.stop else { panic!("{:?}", flight.stop) };
    let last = flight.strikes.last().expect("a strike");
    let turn = 0.5 * std::f64::consts::PI - last.tilt_rad * last.spin_rad_s.signum();
    assert!((time_s - last.time_s - turn / last.spin_rad_s.abs()).abs() < 1e-14, "{flight:?}");
    assert_eq!(flight.stop.reason(), "turned-over", "{flight:?}");
    assert!(flight.later_m_s.is_infinite(), "nobody knows what it comes down on: {}", flight.later_m_s);

    let tall = Scene::new(brick(0.1), 0.0, 0.1, 80.0, 9.81).expect("a drop").fly(Model::FiniteTilt).expect("a motion");
    assert!(matches!(tall.stop, Stop::TurnedOver { .. }), "{:?}", tall.stop);
    assert!(!tall.pivots.is_empty(), "it stands on its corner first");
    // Before that, a time limit.
    let soon = scene.with_time_limit_s(0.5 * time_s).expect("a limit").fly(Model::FiniteTilt).expect("a motion");
    assert_eq!(soon.stop, Stop::TimeLimit { time_s: 0.5 * time_s }, "{soon:?}");
}

#[test]
fn bad_corners_are_refused_with_the_value() {
    let body = Profile::new(0.14, 0.04).expect("a body");
    for bad in [f64::NAN, -0.01, 0.15, f64::INFINITY, 1e-16] {
        let text = body.with_thickness(bad).unwrap_err().to_string();
        assert!(text.contains("thickness") && text.contains(&format!("{bad:?}")), "{text}");
    }
    // The center of a tall body is beyond end a: a spin that lifts that corner is no touch.
    let tall = Scene::new(brick(0.14), 0.5, 1.0, 80.0, 9.81).expect("a drop");
    let text = tall.with_spin(100.0).unwrap_err().to_string();
    assert!(text.contains("spin in rad/s = 100.0") && text.contains("approaches"), "{text}");
}
