//! Fits to synthetic drops whose truth is known. Strikes come from the plain recursion of the paper's Eqs. 1 to 3 or, with
//! gravity and at real tilt, from parabolas; heights and accelerations from small steps in time: nothing here shares code with the flights that the fit computes.

#![cfg(test)]

mod curves;
mod falling;
mod intervals;
mod modes;
mod real;
mod strikes;
mod synthetic;

use clatter_assess::fit::{Measured, MeasuredStrike, fit};

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
