//! Flights with a restitution of each end.

#![cfg(test)]

use clatter_flight::{Model, Profile, Scene, Stop};

/// Where both ends rebound alike it is the flight of that restitution, strike by strike and to rest.
#[test]
fn ends_alike_are_one_restitution() {
    for (e, tilt, gravity) in [(0.3, 5.0, 9.81), (0.0, 1.0, 9.81), (0.6, 20.0, 0.0), (0.45, 0.0, 9.81)] {
        let scene = Scene::new(Profile::off_center(0.06, 0.08, 0.04).unwrap(), e, 4.0, tilt, gravity).unwrap();
        let (both, one) = (scene.fly_by_ends([e, e], |_| false).unwrap(), scene.fly(Model::FiniteTilt).unwrap());
        assert_eq!((both.strikes, both.pivots, both.stop), (one.strikes, one.pivots, one.stop), "{e}, {tilt}");
    }
}

/// Each strike gives back the restitution of its own end, and momentum and energy add up: the other end gets −q(φ) of the jump.
#[test]
fn each_end_rebounds_by_its_own() {
    let e = [0.2, 0.7];
    let scene = Scene::new(Profile::new(0.14, 0.038).unwrap(), 0.5, 4.0, 3.0, 9.81).unwrap();
    let flight = scene.fly_by_ends(e, |flight| flight.struck.iter().sum::<usize>() == 40).unwrap();
    let [a, b] = [0, 1].map(|point| flight.strikes.iter().filter(|strike| strike.point == point).count());
    assert!(a > 3 && b > 3, "{a} and {b} strikes");
    for strike in &flight.strikes {
        let (i, j) = (strike.point, 1 - strike.point);
        // Two roundings of the velocity.
        assert!((strike.velocity_m_s[i] + e[i] * strike.approach_m_s).abs() <= 1e-15 * 4.0, "{strike:?}");
        let (x2, rho2) = ((0.07 * strike.tilt_rad.cos()).powi(2), 0.038 * 0.038);
        let ratio = (x2 - rho2) / (x2 + rho2);
        assert!((strike.delta_v_m_s[j] + ratio * strike.delta_v_m_s[i]).abs() < 1e-12, "{strike:?}");
    }
    assert!(scene.fly_by_ends([0.5, 1.1], |_| false).is_err(), "beyond 1");
}

/// Nothing is looked for beyond the time limit.
#[test]
fn a_time_limit_ends_the_search() {
    let scene = Scene::new(Profile::new(0.14, 0.04).unwrap(), 0.3, 4.0, 3.0, 9.81).unwrap();
    let whole = scene.fly_by_ends([0.3, 0.3], |_| false).unwrap();
    let limit = 0.5 * (whole.strikes[2].time_s + whole.strikes[3].time_s);
    let cut = scene.with_time_limit_s(limit).unwrap().fly_by_ends([0.3, 0.3], |_| false).unwrap();
    assert_eq!((&cut.strikes[..], cut.stop), (&whole.strikes[..3], Stop::TimeLimit { time_s: limit }));
}

/// What bounced clear flies on in the rows for an eighth of the time that is shown, straight up where nothing pulls.
#[test]
fn a_body_that_bounced_clear_is_followed_for_a_while() {
    let scene = Scene::new(Profile::new(0.14, 0.04).unwrap(), 0.3, 4.0, 3.0, 0.0).unwrap();
    let motion = scene.fly(Model::Map).unwrap();
    let Stop::BouncedClear { time_s } = motion.stop else { panic!("{:?}", motion.stop) };
    let (last, strike) = (motion.rows().last().unwrap(), motion.strikes.last().unwrap());
    assert!(time_s > 0.0 && (last.time_s / time_s - 8.0 / 7.0).abs() < 1e-12, "{} after {time_s}", last.time_s);
    for end in 0..2 {
        let flown = strike.height_m[end] + strike.velocity_m_s[end] * (last.time_s - time_s);
        assert!((last.height_m[end] - flown).abs() < 1e-12 && last.velocity_m_s[end] >= 0.0, "{last:?}, not {flown}");
    }
}
