//! The flights at the edges of what a scene may be.

use clatter::Error;
use clatter_flight::{Contact, ContactLaw, Model, Motion, Profile, Scene, Stop, Strike};

const MODELS: [Model; 3] = [Model::Map, Model::Ballistic, Model::FiniteTilt];

fn body(q: f64) -> Profile {
    Profile::new(0.14, 0.07 * ((1.0 - q) / (1.0 + q)).sqrt()).expect("as the test has it")
}

/// What holds for any flight whatever.
fn sane(flight: &Motion, what: &str) {
    let mut last = 0.0;
    for (n, s) in flight.strikes.iter().enumerate() {
        let numbers = [s.time_s, s.approach_m_s, s.delta_v_m_s[0], s.delta_v_m_s[1], s.height_m[0], s.height_m[1]];
        assert!(numbers.iter().all(|x| x.is_finite()), "{what}: {s:?}");
        // The map takes each time from its own closed form, to a few roundings.
        assert!(s.time_s >= last * (1.0 - 8.0 * f64::EPSILON), "{what}: back in time at {s:?}");
        assert!(s.approach_m_s <= 0.0 && s.height_m.iter().all(|&h| h >= 0.0), "{what}: {s:?}");
        assert_eq!(s.number, n as u64 + 1, "{what}");
        last = s.time_s;
    }
    assert!(flight.stop.time_s() >= 0.0, "{what}: {:?}", flight.stop);
    if let Stop::AtRest { time_s, time_bound_s, shock_bound_m_s } = flight.stop {
        let largest = flight.strikes.iter().flat_map(|s| s.delta_v_m_s).fold(0.0, |m: f64, d| m.max(d.abs()));
        assert!(time_s >= last && shock_bound_m_s <= f64::EPSILON * largest, "{what}: {:?}", flight.stop);
        assert!(time_s == 0.0 || time_bound_s <= f64::EPSILON * time_s, "{what}: {:?}", flight.stop);
    }
}

#[test]
fn every_corner_gives_an_answer() {
    for q in [-0.999, -0.5, 0.0, 1e-9, 0.5, 0.9, 0.999_999, 1.0] {
        for e in [0.0, 1e-300, 1e-9, 0.3, 0.9, 1.0] {
            for tilt in [0.0, 1e-9, 1.0, 45.0, 89.9] {
                for g in [0.0, 1e-3, 9.81, 1e6] {
                    for speed in [4.43e-3, 140.0] {
                        for model in MODELS {
                            let scene = Scene::new(body(q), e, speed, tilt, g)
                                .expect("as the test has it")
                                .with_impact_limit(300)
                                .expect("as the test has it");
                            sane(
                                &scene.fly(model).expect("a motion"),
                                &format!("{model:?} q {q} e {e} tilt {tilt} g {g} v {speed}"),
                            );
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn a_start_already_spinning_gives_an_answer() {
    for q in [-0.999, 0.0, 0.5, 0.999_999, 1.0] {
        for e in [0.0, 0.3, 1.0] {
            for tilt in [0.0, 1e-9, 1.0, 89.9] {
                for g in [0.0, 9.81, 1e6] {
                    for spin in [-0.999, -1e-9, 1e-9, 1.0, 1e3] {
                        for model in MODELS {
                            let scene = Scene::new(body(q), e, 1.0, tilt, g)
                                .and_then(|s| s.with_spin(spin / 0.07))
                                .and_then(|s| s.with_impact_limit(200))
                                .expect("as the test has it");
                            let what = format!("{model:?} q {q} e {e} tilt {tilt} g {g} spin {spin}");
                            sane(&scene.fly(model).expect("a motion"), &what);
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn every_corner_of_a_contact_gives_an_answer() {
    for q in [-0.9, 0.0, 0.5, 0.95] {
        for e in [0.0, 0.01, 0.3, 1.0] {
            for tilt in [0.0, 1e-9, 5.0, 89.9] {
                for g in [0.0, 9.81, 1e6] {
                    for (law, time) in [1.4e-9, 1e-7, 1e-5]
                        .into_iter()
                        .flat_map(|time| [(ContactLaw::Hysteretic, time), (ContactLaw::Dashpot, time)])
                    {
                        let scene = Scene::new(body(q), e, 1.0, tilt, g).and_then(|s| s.with_impact_limit(30));
                        let scene = scene.expect("as the test has it");
                        let what = format!("q {q} e {e} tilt {tilt} g {g} {law:?} {time}");
                        let contact = Contact::new(law, e, time).expect("as the test has it");
                        let flight =
                            scene.fly(Model::Contacts(contact)).unwrap_or_else(|error| panic!("{what}: {error}"));
                        let finite = |s: &Strike| s.delta_v_m_s.iter().chain(&s.velocity_m_s).all(|x| x.is_finite());
                        assert!(flight.strikes.iter().all(finite), "{what}");
                        assert!(flight.strikes.windows(2).all(|p| p[0].time_s <= p[1].time_s), "{what}");
                        assert!(flight.energy_error.is_finite() && flight.stop.time_s() >= 0.0, "{what}");
                        let idle = matches!(flight.stop, Stop::TimeLimit { .. });
                        assert!(!idle, "{what}: {:?}", flight.stop);
                    }
                }
            }
        }
    }
}

#[test]
fn heights_from_a_micrometer_to_a_kilometer() {
    for height in [1e-6, 1e-3, 1.2, 1e3] {
        for model in [Model::Ballistic, Model::FiniteTilt] {
            let scene = Scene::from_height(body(0.5), 0.5, height, 1.0, 9.81).expect("as the test has it");
            let flight = scene.fly(model).expect("a motion");
            sane(&flight, &format!("{model:?} from {height} m"));
            assert!(matches!(flight.stop, Stop::AtRest { .. }), "{model:?} from {height} m: {:?}", flight.stop);
        }
    }
}

#[test]
fn a_flat_drop_strikes_end_a_first_and_all_at_one_instant() {
    for model in MODELS {
        // c = T/(2√e) = 0.53: four strikes as the map has them, before anything can move.
        let scene = Scene::new(body(0.5), 0.3, 1.0, 0.0, 9.81).expect("as the test has it");
        let flight = scene.fly(model).expect("a motion");
        let first: Vec<_> = flight.strikes.iter().take_while(|s| s.time_s == 0.0).collect();
        assert_eq!(first.len(), 4, "{model:?}");
        let ends: Vec<_> = first.iter().map(|s| s.point).collect();
        assert_eq!(ends, [0, 1, 0, 1], "{model:?}");
        // a_1 = −T − 1, a_2 = −T a_1·(−1) …: the recurrence by hand, T = 0.65.
        for (s, a) in first.iter().zip([-1.0, -1.65, -0.7725, -0.007_125]) {
            assert!((s.approach_m_s - a).abs() < 1e-15, "{model:?}: {} not {a}", s.approach_m_s);
        }
    }
}

#[test]
fn an_endless_train_at_one_instant_is_rest() {
    for model in [Model::Ballistic, Model::FiniteTilt] {
        for g in [9.81, 0.0] {
            let flight =
                Scene::new(body(0.9), 0.1, 1.0, 0.0, g).expect("as the test has it").fly(model).expect("a motion");
            assert!(flight.strikes.len() > 10, "{model:?} g {g}");
            assert!(matches!(flight.stop, Stop::AtRest { time_s: 0.0, .. }), "{model:?} g {g}: {:?}", flight.stop);
        }
    }
}

#[test]
fn both_ends_at_one_instant_later_on() {
    // q = 0, e = 1: a strike leaves the other end alone, so from a level start both ends bounce together for ever.
    let flight = Scene::new(body(0.0), 1.0, 1.0, 0.0, 10.0)
        .expect("as the test has it")
        .with_impact_limit(100)
        .expect("as the test has it");
    for model in [Model::Ballistic, Model::FiniteTilt] {
        let flight = flight.fly(model).expect("a motion");
        assert_eq!(flight.strikes.len(), 100);
        for pair in flight.strikes.chunks(2) {
            assert_eq!([pair[0].point, pair[1].point], [0, 1], "{model:?}");
            assert!(pair[1].time_s - pair[0].time_s <= 4.0 * f64::EPSILON * pair[0].time_s, "{model:?}: {pair:?}");
        }
        // 49 flights of 2 v/g.
        assert!((flight.strikes[98].time_s - 9.8).abs() < 1e-12, "{model:?}: {}", flight.strikes[98].time_s);
    }
}

#[test]
fn a_million_strikes() {
    for model in [Model::Ballistic, Model::FiniteTilt] {
        let scene = Scene::new(body(0.5), 1.0, 1.0, 5.0, 9.81)
            .expect("as the test has it")
            .with_impact_limit(1_000_000)
            .expect("as the test has it");
        let flight = scene.fly(model).expect("a motion");
        assert_eq!(flight.strikes.len(), 1_000_000, "{model:?}");
        assert!(matches!(flight.stop, Stop::ImpactLimit { .. }), "{model:?}: {:?}", flight.stop);
    }
}

#[test]
fn limits_are_kept_and_said() {
    for model in MODELS {
        let scene = Scene::new(body(0.5), 0.5, 4.43, 5.0, 9.81).expect("as the test has it");
        let two = scene.with_impact_limit(2).expect("as the test has it").fly(model).expect("a motion");
        assert_eq!((two.strikes.len(), two.stop.reason()), (2, "impact-limit"), "{model:?}");
        let early = scene.with_time_limit_s(1e-3).expect("as the test has it").fly(model).expect("a motion");
        assert_eq!((early.strikes.len(), early.stop.reason()), (1, "time-limit"), "{model:?}");
        assert_eq!(early.stop.time_s().to_bits(), 1e-3_f64.to_bits(), "{model:?}");
    }
    // A train of three within a limit of three has bounced clear.
    let scene = Scene::new(body(0.5), 0.5, 4.43, 5.0, 0.0).expect("as the test has it");
    for model in MODELS {
        let flight = scene.with_impact_limit(3).expect("as the test has it").fly(model).expect("a motion");
        assert_eq!((flight.strikes.len(), flight.stop.reason()), (3, "bounced-clear"), "{model:?}");
    }
}

/// After a drop at 10⁹ m/s the body turns 10¹⁹ times before it comes back; the search for its touch once went on for
/// ever.
#[test]
fn a_turn_that_time_cannot_tell_ends_the_flight() {
    let body = Profile::new(1.0, 0.6).expect("as the test has it");
    for speed in [1e9, 1e12, 1e16] {
        let scene = Scene::new(body, 0.9, speed, 0.3, 0.3).expect("as the test has it");
        let flight = scene.with_impact_limit(10).expect("as the test has it").fly(Model::FiniteTilt).expect("a motion");
        assert_eq!(flight.stop.reason(), "time-limit", "{speed:e}: {:?}", flight.stop);
        assert!(flight.strikes.len() < 10, "{speed:e}: {}", flight.strikes.len());
    }
}

#[test]
fn a_spin_that_lifts_end_b_away_leaves_it_there_without_gravity() {
    let scene = Scene::new(body(0.5), 0.5, 1.0, 5.0, 0.0)
        .expect("as the test has it")
        .with_spin(200.0)
        .expect("as the test has it");
    for model in [Model::Map, Model::Ballistic] {
        let flight = scene.fly(model).expect("a motion");
        assert_eq!((flight.strikes.len(), flight.stop.reason()), (1, "bounced-clear"), "{model:?}");
    }
}

#[test]
fn an_off_center_mass_is_the_symmetric_map_in_disguise() {
    // Without gravity and at vanishing tilt the finite-tilt simulation knows nothing of that reduction.
    let body = Profile::off_center(0.05, 0.09, 0.03).expect("as the test has it");
    let scene = Scene::new(body, 0.4, 1.0, 1e-9, 0.0).expect("as the test has it");
    let (map, finite) = (scene.fly(Model::Map).expect("a motion"), scene.fly(Model::FiniteTilt).expect("a motion"));
    assert!(map.strikes.len() > 3, "{}", map.strikes.len());
    assert_eq!(map.strikes.len(), finite.strikes.len());
    for (m, f) in map.strikes.iter().zip(&finite.strikes) {
        assert_eq!(m.point, f.point);
        assert!((m.time_s - f.time_s).abs() <= 1e-12 * m.time_s, "strike {}: {} {}", m.number, m.time_s, f.time_s);
        for k in 0..2 {
            assert!((m.delta_v_m_s[k] - f.delta_v_m_s[k]).abs() < 1e-12, "strike {}", m.number);
            assert!((m.height_m[k] - f.height_m[k]).abs() <= 1e-11 * scene.height_gap_m(), "strike {}", m.number);
            assert!((m.velocity_m_s[k] - f.velocity_m_s[k]).abs() < 1e-12, "strike {}", m.number);
        }
    }
}

#[test]
fn bad_scenes_are_refused_with_the_value() {
    let refused = |r: Result<Scene, Error>, words: [&str; 2]| {
        let text = r.unwrap_err().to_string();
        assert!(words.iter().all(|w| text.contains(w)), "{text}");
    };
    let good = Scene::new(body(0.5), 0.5, 1.0, 5.0, 9.81).expect("as the test has it");
    for bad in [f64::NAN, -0.14, 0.0, f64::INFINITY] {
        assert!(Profile::new(bad, 0.04).is_err() && Profile::off_center(0.07, bad, 0.04).is_err());
    }
    for bad in [f64::NAN, -0.04, f64::INFINITY] {
        assert!(Profile::new(0.14, bad).is_err());
    }
    Profile::new(0.14, 0.0).expect("as the test has it");
    Profile::new(0.14, 0.2).expect("as the test has it"); // beyond the half-length: q < 0
    refused(Scene::new(body(0.5), 1.2, 1.0, 5.0, 9.81), ["restitution", "1.2"]);
    refused(Scene::new(body(0.5), 0.5, -1.0, 5.0, 9.81), ["speed", "-1.0"]);
    refused(Scene::new(body(0.5), 0.5, 1.0, 90.0, 9.81), ["tilt", "90"]);
    refused(Scene::new(body(0.5), 0.5, 1.0, -5.0, 9.81), ["tilt", "-5"]);
    refused(Scene::new(body(0.5), 0.5, 1.0, 5.0, -9.81), ["gravity", "-9.81"]);
    refused(Scene::from_height(body(0.5), 0.5, 1.2, 5.0, 0.0), ["gravity", "0"]);
    refused(Scene::from_height(body(0.5), 0.5, 0.0, 5.0, 9.81), ["height", "0"]);
    refused(good.with_time_limit_s(0.0), ["time limit", "0"]);
    refused(good.with_time_limit_s(f64::NAN), ["time limit", "NaN"]);
    refused(good.with_impact_limit(0), ["impact limit", "0"]);
    refused(good.with_spin(-15.0), ["spin", "-15"]);
    let other = Contact::new(ContactLaw::Hysteretic, 0.3, 1e-4).expect("a contact");
    let error = good.fly(Model::Contacts(other)).expect_err("two restitutions");
    assert!(matches!(error, clatter_flight::Error::Restitution { contact: 0.3, scene: 0.5 }), "{error}");
    refused(good.with_spin(f64::NAN), ["spin", "NaN"]);
}

#[test]
fn the_drawing_meets_the_ground_at_the_strikes() {
    for model in MODELS {
        let scene = Scene::new(body(0.5), 0.3, 4.43, 5.0, 9.81).expect("a scene");
        let flight = scene.fly(model).expect("a motion");
        for pair in flight.strikes.windows(2) {
            let dt = pair[1].time_s - pair[0].time_s;
            if dt < 1e-9 {
                continue;
            }
            // Just before it strikes, the end is its approach times a moment high.
            let moment = 1e-6 * dt;
            let h = flight.at(pair[1].time_s - moment).height_m[pair[1].point];
            let want = -pair[1].approach_m_s * moment;
            // After a pivot at 5° the parabola lands half a percent off the pendulum's speed.
            assert!((h - want).abs() <= 1e-2 * want + 1e-15, "{model:?}, strike {}: {h} not {want}", pair[1].number);
        }
    }
}

/// Two inertia ratios next to 1 whose root rounds above it.
#[test]
fn ends_next_to_massless_off_the_middle_are_bars() {
    for k in 1..2000 {
        let a = 0.15 * (0.02 + 1.96 * f64::from(k) / 2000.0);
        for gyration in [0.0, 1e-11, 1e-9] {
            let body = Profile::off_center(a, 0.3 - a, gyration).expect("as the test has it");
            let scene = Scene::new(body, 0.3, 1.0, 3.0, 0.0).expect("as the test has it");
            assert!(scene.symmetric_bar().0.q() <= 1.0, "{a} {gyration}");
        }
    }
}

/// A spin whose end speed rounds to nothing is no approach.
#[test]
fn the_least_spin_that_is_taken_leaves_an_approach() {
    let (mut taken, mut refused) = (0, 0);
    for k in 1..300 {
        let (length, speed) = (0.1 + 0.002 * f64::from(k), 0.5 + 0.02 * f64::from(k));
        let body = Profile::new(length, 0.2 * length).expect("as the test has it");
        let scene = Scene::new(body, 0.3, speed, 3.0, 0.0).expect("as the test has it");
        let still = -speed / (0.5 * length);
        for spin in [still, still.next_up(), still.next_up().next_up()] {
            match scene.with_spin(spin) {
                Ok(scene) => {
                    taken += 1;
                    sane(
                        &scene.with_impact_limit(20).expect("some").fly(Model::Map).expect("a motion"),
                        &format!("{length} {spin}"),
                    );
                }
                Err(error) => {
                    refused += 1;
                    assert!(
                        matches!(error, Error::Quantity { value, .. } if value.to_bits() == spin.to_bits()),
                        "{error}"
                    );
                }
            }
        }
    }
    assert!(taken > 100 && refused > 100, "{taken} {refused}");
}
