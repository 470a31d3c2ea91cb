//! Tests of fits, in one program: fits to synthetic drops whose truth is known. Strikes come from the plain recursion of the paper's
//! Eqs. 1 to 3 or, with gravity and at real tilt, from parabolas; heights and accelerations from small steps in time. Nothing here shares
//! code with the flights that a fit computes.

#![cfg(test)]
#![allow(clippy::disallowed_methods, reason = "references may differ in the last digit between machines")]

mod curves;
mod falling;
mod intervals;
mod modes;
mod real;
mod strikes;
mod synthetic;

use clatter_fit::{Error, Known, Measured, MeasuredStrike, bounces, fit};

use synthetic::known;

/// What no record can hold is told with its value.
#[test]
fn bad_records_are_refused() {
    let strike = |time_s: f64| MeasuredStrike { time_s, end: None };
    let strikes =
        |times: &[f64]| Measured::Strikes { strikes: times.iter().map(|t| strike(*t)).collect(), deviation_s: None };
    for (bad, said) in [
        (strikes(&[0.0]), "1 strikes; allowed: 2 to 4096"),
        (strikes(&[0.0, 1.0, 0.5]), "time_s = 0.5 is not after the one before it"),
        (strikes(&[0.0, f64::NAN]), "NaN"),
        (strikes(&[1.0, 1.0]), "time from the first to the last strike in s = 0.0"),
        (
            Measured::Strikes { strikes: vec![strike(0.0), strike(1.0)], deviation_s: Some(0.0) },
            "standard deviation in s = 0.0",
        ),
        (Measured::Heights { samples: Vec::new(), deviation_m: None }, "0 samples; allowed: 4"),
        (
            Measured::Acceleration { position_m: 1e9, start_s: 0.0, step_s: 1.0, values_m_s2: vec![1.0; 9] },
            "position in m = 1000000000.0",
        ),
        (
            Measured::Acceleration { position_m: 0.0, start_s: 0.0, step_s: 0.0, values_m_s2: vec![1.0; 9] },
            "time step in s = 0.0",
        ),
        (
            Measured::Acceleration { position_m: 0.0, start_s: 0.0, step_s: 1.0, values_m_s2: vec![0.0; 9] },
            "largest acceleration",
        ),
    ] {
        let error = fit(&known(0.5), &[bad]).unwrap_err().to_string();
        assert!(error.contains(said), "{error}, not {said}");
    }
    assert!(fit(&known(0.5), &[]).is_err(), "nothing");
}

/// Data of a product that no file may state are refused.
#[test]
fn what_a_fit_is_told_is_checked() {
    let sound = known(0.5);
    let strikes = [0.0, 2e-3, 3e-3, 9e-3].map(|time_s| MeasuredStrike { time_s, end: None }).to_vec();
    let measured = [Measured::Strikes { strikes, deviation_s: Some(1e-5) }];
    let mut wrong =
        vec![Known { restitution: [0.5, 0.2], ..sound.clone() }, Known { tilt_rad: [0.0, 0.7], ..sound.clone() }];
    for x in [f64::NAN, f64::INFINITY, -1.0] {
        wrong.extend([
            Known { restitution: [x, 0.5], ..sound.clone() },
            Known { restitution: [0.2, x], ..sound.clone() },
            Known { speed_m_s: [x, x], ..sound.clone() },
            Known { tilt_rad: [0.0, x], ..sound.clone() },
            Known { contact_time_s: Some([x, x]), ..sound.clone() },
            Known { gravity_m_s2: x, ..sound.clone() },
        ]);
        assert!(matches!(bounces(&[1.0, 1.4, 1.6, 1.7], x, None), Err(Error::Known { .. })), "{x}");
    }
    assert_eq!(sound.check(), Ok(()));
    for wrong in wrong {
        let error = fit(&wrong, &measured).expect_err("it is refused");
        assert!(matches!(error, Error::Known { .. }), "{wrong:?}: {error}");
    }
}
