//! The compliant contact against its limit of instant impacts, its own law, and a step-by-step integration.

use clatter::flight::{Body, Contact, Model, Scene};

fn body(q: f64) -> Body {
    Body::new(0.14, 0.07 * ((1.0 - q) / (1.0 + q)).sqrt()).unwrap()
}

#[test]
fn the_restitution_fitted_is_the_restitution_had() {
    for e in [0.01, 0.05, 0.13, (-2.0_f64).exp(), 0.14, 0.3, 0.7, 0.99, 1.0 - 1e-9, 1.0] {
        for (tilt, contact_time) in [(60.0, 1e-6), (60.0, 1e-3), (5.0, 1e-9)] {
            // Without gravity and with q < 0 the other end is far from the ground.
            let scene =
                Scene::new(body(-0.3), e, 2.0, tilt, 0.0).unwrap().with_time_limit_s(2.0 * contact_time).unwrap();
            let flight = scene.simulate_compliant(contact_time).unwrap();
            let s = &flight.flight.strikes[0];
            let had = -(s.approach_m_s + s.delta_v_m_s[0]) / s.approach_m_s;
            assert!((had + 0.0 - e).abs() < 1e-11, "e {e}, had {had}");
            let duration = flight.pulses[0].until_s - flight.pulses[0].from_s;
            assert!((duration / contact_time - 1.0).abs() < 1e-9, "e {e}: lasts {duration}, not {contact_time}");
        }
    }
    assert!((Contact::new(0.4510, 1.0).unwrap().damping_ratio() - 0.3).abs() < 1e-4);
}

#[test]
fn short_contacts_tend_to_the_map_in_proportion_to_their_time() {
    let scene = Scene::new(body(0.5), 0.3, 4.43, 1e-3, 0.0).unwrap();
    let map = scene.simulate(Model::Map);
    let unit = scene.height_gap_m() / scene.speed_m_s();
    let mut last = f64::INFINITY;
    for k in 2..6 {
        let flight = scene.simulate_compliant(unit * 0.1_f64.powi(k)).unwrap().flight;
        assert_eq!(flight.strikes.len(), map.strikes.len());
        let error = flight.strikes.iter().zip(&map.strikes).map(|(c, m)| {
            assert_eq!(c.end, m.end);
            (c.delta_v_m_s[0] - m.delta_v_m_s[0]).abs() / 4.43
        });
        let error = error.fold(0.0, f64::max);
        let late = (flight.strikes[1].time_s / map.strikes[1].time_s - 1.0).abs();
        println!("{k}: {error:e} {late:e}");
        last = late;
    }
    assert!(last < 1e-4);
}

#[test]
fn a_drop_comes_to_rest_on_its_springs() {
    for e in [0.05, 0.3, 0.6] {
        let scene = Scene::new(body(0.5), e, 1.0, 5.0, 9.81).unwrap();
        let f = scene.simulate_compliant(3e-4).unwrap();
        println!("{e} {} {:?} {:?}", f.flight.strikes.len(), f.flight.stop, scene.simulate(Model::FiniteTilt).stop);
        assert_eq!(f.flight.stop.reason(), "at-rest", "{:?}", f.flight.stop);
    }
}
