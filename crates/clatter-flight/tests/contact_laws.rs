//! What each contact law says of a lone contact, of symmetry, and of its limits.

use clatter_flight::{Contact, ContactLaw, Model, Profile, Scene, Stop, Strike};
use proptest::prelude::*;

fn body(q: f64) -> Profile {
    Profile::new(0.14, 0.07 * ((1.0 - q) / (1.0 + q)).sqrt()).expect("a bar")
}

fn contact(law: ContactLaw, e: f64, time_s: f64) -> Contact {
    Contact::new(law, e, time_s).expect("a contact")
}

#[test]
fn the_restitution_fitted_is_the_restitution_had() {
    for law in ContactLaw::ALL {
        for e in [0.01, 0.05, 0.13, (-2.0_f64).exp(), 0.14, 0.3, 0.7, 0.99, 1.0 - 1e-9, 1.0] {
            for time in [1e-3, 1e-6, 1e-9] {
                // Straight down on one point under the center of mass, as a body without tilt does not turn.
                let body = Profile::of_points([[0.0, -0.07]], 0.05).expect("a body");
                let scene = Scene::new(body, e, 2.0, 0.0, 0.0).expect("a drop");
                let flight = scene.contacts_until(&contact(law, e, time), 1e-4, |_| false).expect("a flight");
                let strike = flight.strikes[0];
                let had = strike.delta_v_m_s[0] / 2.0 - 1.0;
                // But for the last digits of heights, 1e-17 m, beside the depth.
                let allowed = 1e-11 + 2e-17 / time;
                assert!(
                    (had - e).abs() < allowed && (strike.velocity_m_s[0] / 2.0 - e).abs() < allowed,
                    "{law:?} {e}: {had}"
                );
                let lasts = flight.presses[0].until_s - flight.presses[0].from_s;
                assert!((lasts / time - 1.0).abs() < 1e-9 + 1e-16 / time, "{law:?} {e}: lasts {lasts}, not {time}");
            }
        }
    }
    assert!((contact(ContactLaw::Dashpot, 0.4510, 1.0).damping_ratio() - 0.3).abs() < 1e-4);
}

/// The crest of a lone contact, by 20 000 moments of it.
#[test]
fn the_largest_acceleration_of_a_lone_contact_is_that_of_its_law() {
    for law in ContactLaw::ALL {
        for e in [1e-3, 0.01, 0.1, 0.29, 0.3, 0.5, 0.8, 1.0] {
            let body = Profile::of_points([[0.0, -0.07]], 0.05).expect("a body");
            let scene = Scene::new(body, e, 2.0, 0.0, 0.0).expect("a drop");
            let lone = contact(law, e, 1e-3);
            let flight = scene.contacts_until(&lone, 1e-4, |_| false).expect("a flight");
            let at = |k: u32| flight.sample(1e-3 * f64::from(k) / 20_000.0).expect("contacts").acceleration_m_s2[0];
            let crest = (0..20_000).map(at).fold(0.0, f64::max) / flight.strikes[0].delta_v_m_s[0];
            // As a crest is flat, half a step from it is within 1e-7; a force that jumps to it and falls is missed by none.
            assert!((crest / lone.peak_per_change() - 1.0).abs() < 1e-6, "{law:?} {e}: {crest}");
        }
    }
}

/// A bar with a lone contact at 60°: the same but for the turn while it presses, which is in proportion to the time.
#[test]
fn a_tilted_contact_has_its_restitution_too() {
    for law in ContactLaw::ALL {
        for e in [0.05, 0.3, 0.7, 1.0] {
            let off = [1e-4, 1e-5, 1e-6].map(|time| {
                let scene = Scene::new(body(-0.3), e, 2.0, 60.0, 0.0).expect("a drop");
                let flight = scene.contacts_until(&contact(law, e, time), 1e-7, |_| false).expect("a flight");
                let strike = flight.strikes[0];
                let had = -(strike.approach_m_s + strike.delta_v_m_s[0]) / strike.approach_m_s;
                ((had - e).abs(), ((flight.presses[0].until_s - flight.presses[0].from_s) / time - 1.0).abs())
            });
            assert!(off[2].0 < 1e-4 && off[2].1 < 1e-4, "{law:?} {e}: {off:?}");
            for pair in off.windows(2) {
                assert!(
                    pair[1].0 < 0.11 * pair[0].0 + 1e-7 && pair[1].1 < 0.11 * pair[0].1 + 1e-7,
                    "{law:?} {e}: {off:?}"
                );
            }
        }
    }
}

/// The largest force of a hysteretic contact is that of the half-sine with the same length and velocity change,
/// (π/2)(1 + e) v/τ over μ; it is reached at τ/(1 + e), from where a quarter cosine goes down.
#[test]
fn the_pulse_of_a_hysteretic_contact_is_a_quarter_sine_and_a_quarter_cosine() {
    for e in [0.0, 0.1, 0.5, 1.0] {
        let (time, speed) = (1e-3, 2.0);
        let scene = Scene::new(body(0.5), e, speed, 0.0, 0.0).expect("a drop");
        let flight = scene.fly(Model::Contacts(contact(ContactLaw::Hysteretic, e, time))).expect("a flight");
        // Of both ends together the center of mass feels what a lone contact at it would: μ is 1 − q there. So much stiffer is
        // the pair, so much shorter its pulse.
        let share = (1.0 - 0.5) / (1.0 + 0.5_f64) * 2.0;
        let mu = 1.0 + (0.07 / body(0.5).gyration_m()).powi(2);
        let faster = (2.0 / mu).sqrt();
        assert!((share - 2.0 / (1.0 + 2.0)).abs() < 1e-12 && (mu - 4.0).abs() < 1e-12, "{share} {mu}");
        let loading = time / (1.0 + e) / faster;
        let force = |t: f64| flight.sample(t).expect("contacts").force_per_mass_m_s2.iter().sum::<f64>();
        let largest = std::f64::consts::FRAC_PI_2 * speed / loading;
        for k in 1..10 {
            let share = f64::from(k) / 10.0;
            let sine = largest * (share * std::f64::consts::FRAC_PI_2).sin();
            assert!((force(share * loading) / sine - 1.0).abs() < 1e-9, "e {e}: {} {sine}", force(share * loading));
            if e > 0.0 {
                let cosine = largest * (share * std::f64::consts::FRAC_PI_2).cos();
                let unloading = loading * (1.0 + e * share);
                assert!((force(unloading) / cosine - 1.0).abs() < 1e-9, "e {e}: {} {cosine}", force(unloading));
            }
        }
    }
    // A lone one, through the force itself.
    for (tilt, e) in [(0.0, 0.3), (0.0, 0.9)] {
        let lone = Profile::of_points([[-0.07, -0.02]], 0.05).expect("a body");
        let scene = Scene::new(lone, e, 2.0, tilt, 0.0).expect("a drop");
        let time = 1e-7;
        let flight =
            scene.contacts_until(&contact(ContactLaw::Hysteretic, e, time), 1e-4, |_| false).expect("a flight");
        let mu = 1.0 + (0.07_f64 / 0.05).powi(2);
        let largest = (1..1000)
            .map(|k| flight.sample(1e-3 * f64::from(k) * time).expect("contacts").force_per_mass_m_s2[0])
            .fold(0.0, f64::max);
        let want = std::f64::consts::FRAC_PI_2 * (1.0 + e) * 2.0 / time / mu;
        assert!((largest / want - 1.0).abs() < 1e-5, "e {e}: {largest} {want}");
    }
}

/// What two points that are alike do is alike to the last bit, through every strike until rest.
#[test]
fn a_flat_even_drop_stays_even_bit_by_bit() {
    for law in ContactLaw::ALL {
        for e in [0.0, 0.3, 0.7, 1.0] {
            for q in [-0.5, 0.0, 0.5, 0.9] {
                let scene =
                    Scene::new(body(q), e, 2.0, 0.0, 9.81).and_then(|s| s.with_impact_limit(100)).expect("a drop");
                let flight = scene.fly(Model::Contacts(contact(law, e, 5e-4))).expect("a flight");
                let bits = |v: [f64; 2]| v[0].to_bits() == v[1].to_bits();
                assert!(flight.strikes.len().is_multiple_of(2), "{law:?} {e} {q}: an end strikes alone");
                for (n, pair) in flight.strikes.chunks(2).enumerate() {
                    let [a, b] = pair else { panic!("{law:?} {e} {q}: an end strikes alone") };
                    assert!((a.point, b.point) == (0, 1) && bits([a.time_s, b.time_s]), "{law:?} {e} {q}: {a:?} {b:?}");
                    assert!(bits([a.approach_m_s, b.approach_m_s]) && bits(a.velocity_m_s), "{law:?} {e} {q}: {a:?}");
                    assert!(bits([a.delta_v_m_s[0], b.delta_v_m_s[1]]), "{law:?} {e} {q}: {a:?} {b:?}");
                    assert!(a.tilt_rad == 0.0 && a.spin_rad_s == 0.0, "{law:?} {e} {q}: {a:?}");
                    assert_eq!(flight.presses[2 * n], flight.presses[2 * n + 1], "{law:?} {e} {q}");
                }
                for t in flight.phases_s() {
                    let now = flight.sample(t).expect("contacts");
                    assert!(
                        bits(now.height_m) && bits(now.force_per_mass_m_s2) && now.tilt_rad == 0.0,
                        "{law:?} {e} {q}"
                    );
                }
            }
        }
    }
}

#[test]
fn without_restitution_nothing_rebounds() {
    // A point under the center of mass, and a flat bar: still from the moment of the lowest point on.
    let lone = Profile::of_points([[0.0, -0.07]], 0.05).expect("a body");
    let lone = Scene::new(lone, 0.0, 2.0, 0.0, 9.81).expect("a drop");
    let flight = lone.contacts_until(&contact(ContactLaw::Hysteretic, 0.0, 1e-3), 1e-4, |_| false).expect("a flight");
    assert!(flight.strikes.len() == 1 && flight.strikes[0].velocity_m_s == [0.0], "{flight:?}");
    // Nothing holds it upright but that it does not move: no time is its rest, and it is left.
    assert!(matches!(flight.stop, Stop::TimeLimit { .. }), "{flight:?}");
    for (q, g) in [(0.5, 9.81), (-0.5, 9.81), (0.5, 0.0)] {
        let scene = Scene::new(body(q), 0.0, 2.0, 0.0, g).expect("a drop");
        let flight = scene.fly(Model::Contacts(contact(ContactLaw::Hysteretic, 0.0, 1e-3))).expect("a flight");
        assert_eq!((flight.strikes.len(), flight.stop.reason()), (2, "at-rest"), "{flight:?}");
        assert!(flight.strikes.iter().all(|s| s.velocity_m_s.iter().all(|v| v.abs() <= 0.0)), "{:?}", flight.strikes);
        // Then the ground carries the weight, and nothing moves.
        let rest = flight.sample(1.0).expect("contacts");
        assert!(
            (rest.force_per_mass_m_s2.iter().sum::<f64>() - g).abs() < 1e-12
                && rest.velocity_m_s.iter().all(|v| v.abs() <= 0.0)
        );
    }
    // An end that has struck stays where it is while the other one falls.
    let scene = Scene::new(body(-0.5), 0.0, 0.5, 20.0, 9.81).expect("a drop");
    let flight = scene.fly(Model::Contacts(contact(ContactLaw::Hysteretic, 0.0, 1e-4))).expect("a flight");
    let [first, second] = [0, 1].map(|n| flight.strikes[n].time_s);
    let held = flight.sample(first + 2e-4).expect("contacts").height_m[0];
    for share in [0.1, 0.5, 0.9] {
        let now = flight.sample(first + share * (second - first)).expect("contacts");
        assert!((now.height_m[0] / held - 1.0).abs() < 1e-9 && now.velocity_m_s[0].abs() < 1e-12, "{now:?}");
        assert!(now.force_per_mass_m_s2[0] > 0.0, "{now:?}");
    }
}

/// e = 0 is what small restitutions tend to.
#[test]
fn small_restitutions_tend_to_none() {
    let time = |e: f64, end: usize| {
        let scene = Scene::new(body(0.6), e, 3.0, 10.0, 9.81).expect("a drop");
        let strikes =
            scene.contacts_until(&contact(ContactLaw::Hysteretic, e, 3e-4), 1e-6, |_| false).expect("a flight").strikes;
        let first = strikes.iter().find(|strike| strike.point == end).expect("it lands");
        (first.time_s, first.approach_m_s)
    };
    let (t0, v0) = time(0.0, 1);
    for e in [0.02, 0.01, 0.005] {
        let (t, v) = time(e, 1);
        assert!((t / t0 - 1.0).abs() < 2.0 * e && (v / v0 - 1.0).abs() < 2.0 * e, "{e}: {t} {t0}, {v} {v0}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, max_shrink_iters: 0, ..ProptestConfig::default() })]

    /// The flight knows neither the order of the points nor which of them is called a.
    #[test]
    fn points_in_another_order_fly_the_same(
        off in -0.3..0.3_f64, q in -0.3..0.9_f64, e in prop_oneof![Just(0.0), 0.0..1.0_f64], tilt in 0.5..60.0_f64, law in prop::sample::select(&ContactLaw::ALL[..]),
    ) {
        let gyration = 0.07 * ((1.0 - q) / (1.0 + q)).sqrt();
        let points = [[-0.07 * (1.0 + off), 0.0], [0.07 * (1.0 - off), 0.0]];
        let fly = |points: [[f64; 2]; 2]| {
            let body = Profile::of_points(points, gyration).expect("a body");
            let scene = Scene::new(body, e, 2.0, tilt, 9.81).and_then(|s| s.with_impact_limit(20)).expect("a drop");
            let flight = scene.fly(Model::Contacts(contact(law, e, 3e-4))).expect("a flight");
            flight.strikes.into_iter().zip(flight.presses).collect::<Vec<_>>()
        };
        let (one, other) = (fly(points), fly([points[1], points[0]]));
        // Roundings grow from strike to strike, and by hundreds of bounces in the dent of one.
        for ((s, p), (o, q)) in one.iter().zip(&other).take(4) {
            prop_assert_eq!(s.point, 1 - o.point);
            prop_assert!((s.time_s - o.time_s).abs() <= 1e-8 * s.time_s.max(3e-4), "{} {}", s.time_s, o.time_s);
            prop_assert!((s.approach_m_s - o.approach_m_s).abs() <= 1e-7, "{s:?} {o:?}");
            if (p.until_s - q.until_s).abs() < 1e-9 {
                let [near, far] = [0, 1].map(|k| (s.delta_v_m_s[k] - o.delta_v_m_s[1 - k]).abs());
                prop_assert!(near.max(far) < 1e-7, "{s:?} {o:?}");
            }
        }
    }
}

/// Shocks and times of contacts tend to those of instant impacts in proportion to the contact time, at any tilt.
#[test]
fn short_contacts_tend_to_instant_impacts_in_proportion_to_their_time() {
    let off = |a: &Strike, b: &Strike| {
        let shock = (0..2).map(|k| (a.delta_v_m_s[k] - b.delta_v_m_s[k]).abs() / 4.43).fold(0.0, f64::max);
        shock.max((a.time_s - b.time_s).abs() / b.time_s.max(1e-9))
    };
    for law in ContactLaw::ALL {
        for (q, e, tilt) in [(0.5, 0.3, 45.0), (0.2, 0.6, 20.0), (-0.4, 0.5, 30.0)] {
            let scene = Scene::new(body(q), e, 4.43, tilt, 9.81).expect("a drop");
            let hard = scene.fly(Model::FiniteTilt).expect("a motion").strikes;
            let runs = [1e-5, 1e-6, 1e-7].map(|time| {
                // A touch is late by the time of the contact before.
                let until = hard[1].time_s + 2.0 * time;
                let soft = scene.contacts_until(&contact(law, e, time), 1e-8, |ahead| ahead.time_s > until);
                let soft = soft.expect("a flight").strikes;
                assert_eq!(soft[1].point, hard[1].point, "{law:?} {q} {e} {tilt}");
                off(&soft[0], &hard[0]).max(off(&soft[1], &hard[1]))
            });
            for pair in runs.windows(2) {
                let order = (pair[0] / pair[1]).log10();
                assert!((order - 1.0).abs() < 0.05, "{law:?} {q} {e} {tilt}: order {order}, {runs:?}");
            }
        }
    }
}

/// Without gravity and at vanishing tilt shocks of contacts that do not overlap know nothing of their duration: they are
/// those of instant impacts, and to φ² those of the map.
#[test]
fn shocks_that_do_not_overlap_are_those_of_instant_impacts() {
    let scene = Scene::new(body(0.5), 0.3, 4.43, 1e-3, 0.0).expect("a drop");
    let unit = scene.height_gap_m() / scene.speed_m_s();
    let (map, finite) =
        (scene.fly(Model::Map).expect("a motion").strikes, scene.fly(Model::FiniteTilt).expect("a motion").strikes);
    for law in ContactLaw::ALL {
        let late = [2, 3, 4, 5].map(|k| {
            let flight = scene.fly(Model::Contacts(contact(law, 0.3, unit * 0.1_f64.powi(k)))).expect("a flight");
            assert_eq!(flight.strikes.len(), map.len(), "strikes");
            for (c, m) in flight.strikes.iter().zip(&map) {
                assert_eq!(c.point, m.point, "strike {}", m.number);
                for k in 0..2 {
                    assert!((c.delta_v_m_s[k] - m.delta_v_m_s[k]).abs() < 1e-9 * 4.43, "{law:?}: {c:?} {m:?}");
                    // What a turn of the contact changes of φ².
                    let exact = finite[usize::try_from(m.number - 1).expect("four")].delta_v_m_s[k];
                    assert!((c.delta_v_m_s[k] - exact).abs() < 1e-10 * 4.43, "{law:?}: {c:?} {exact}");
                }
            }
            (flight.strikes[1].time_s / map[1].time_s - 1.0).abs()
        });
        for pair in late.windows(2) {
            assert!(((pair[0] / pair[1]).log10() - 1.0).abs() < 0.01, "{law:?}: {late:?}");
        }
        // Contacts that overlap are another matter: of four strikes, fewer are left.
        let overlap = scene.fly(Model::Contacts(contact(law, 0.3, unit))).expect("a flight").strikes.len();
        assert!(overlap < map.len(), "{law:?}: {overlap}");
    }
}
