//! The rows of a flight: every strike, one continuous motion, and curves that straight lines follow.

use clatter::flight::{Body, Model, Scene, Stop, Strike};
use clatter::history::{Row, STRAIGHT};
use proptest::prelude::*;

/// Heights are continuous, and their changes are what the velocities say.
///
/// Over an interval in which neither height nor velocity leaves the straight line by more than their share, the mean of
/// both velocities gives the change of height to twice that share of the larger velocity; a pivot adds nothing, because
/// its heights and velocities are one parabola.
fn is_one_motion(rows: &[Row]) -> Result<(), String> {
    let tallest = rows.iter().flat_map(|row| row.height_m).fold(0.0, |h: f64, x| h.max(x.abs()));
    for pair in rows.windows(2) {
        let dt = pair[1].time_s - pair[0].time_s;
        if dt < 0.0 {
            return Err(format!("back in time: {pair:?}"));
        }
        for end in 0..2 {
            let [v0, v1] = [0, 1].map(|k: usize| pair[k].velocity_m_s[end]);
            let moved = pair[1].height_m[end] - pair[0].height_m[end];
            let fastest = pair.iter().flat_map(|row| row.velocity_m_s).fold(0.0, |v: f64, x| v.max(x.abs()));
            let allowed = 2.0 * STRAIGHT * fastest * dt + 1e-12 * tallest;
            if (moved - 0.5 * (v0 + v1) * dt).abs() > allowed {
                return Err(format!("end {end} moves by {moved:e}, not {:e}: {pair:?}", 0.5 * (v0 + v1) * dt));
            }
        }
    }
    Ok(())
}

/// Whether a row is the body just after a strike, bit for bit.
fn is_after(row: &Row, strike: &Strike) -> bool {
    let bits = |v: [f64; 2], t: f64| [v[0], v[1], t].map(f64::to_bits);
    bits(row.velocity_m_s, row.time_s) == bits(strike.velocity_m_s, strike.time_s)
}

fn has_every_strike(scene: &Scene, model: Model) -> Result<Vec<Row>, TestCaseError> {
    let flight = scene.simulate(model);
    let rows: Vec<_> = scene.history(model, &flight).collect();
    let mut at = 0;
    for strike in &flight.strikes {
        at += rows[at..]
            .iter()
            .position(|row| is_after(row, strike))
            .ok_or_else(|| TestCaseError::fail(format!("strike {} has no row after it", strike.number)))?;
        let (before, after) = (rows[at - 1], rows[at]);
        prop_assert_eq!((before.time_s, before.height_m), (after.time_s, after.height_m));
        for end in 0..2 {
            let jump = after.velocity_m_s[end] - before.velocity_m_s[end];
            // The subtraction and this one round.
            let scale = after.velocity_m_s[end].abs() + strike.delta_v_m_s[end].abs();
            prop_assert!(
                (jump - strike.delta_v_m_s[end]).abs() <= 2.0 * f64::EPSILON * scale,
                "strike {}",
                strike.number
            );
        }
        at += 1;
    }
    Ok(rows)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn rows_hold_every_strike_and_one_motion(
        off in -0.6..0.6_f64, gyration in 0.1..0.9_f64, e in prop_oneof![Just(0.0), 0.0..0.9_f64],
        speed in 0.1..5.0_f64, tilt in prop_oneof![Just(0.0), 0.1..60.0_f64], spin in -0.5..6.0_f64,
        model in prop_oneof![Just(Model::Map), Just(Model::Ballistic), Just(Model::FiniteTilt)],
    ) {
        let body = Body::off_center(0.07 * (1.0 + off), 0.07 * (1.0 - off), 0.07 * gyration).unwrap();
        let scene = Scene::new(body, e, speed, tilt, 9.81).unwrap();
        let scene = scene.with_spin(spin * speed / body.length_m()).unwrap().with_impact_limit(300).unwrap();
        let rows = has_every_strike(&scene, model)?;
        // Far from level a pivot is no parabola.
        if model != Model::FiniteTilt || scene.simulate(model).pivots.is_empty() {
            prop_assert_eq!(is_one_motion(&rows), Ok(()));
        }
    }
}

#[test]
fn a_resting_end_that_lifts_off_goes_on_from_there() {
    // End a stays down (e = 0) and is pulled up by the turning, which mass beyond the ends keeps up, as the body stands
    // steeper.
    let body = Body::new(0.14, 0.2).unwrap();
    let drop = |spin: f64| Scene::new(body, 0.0, 0.1, 5.0, 9.81).unwrap().with_spin(spin).unwrap();
    let lifts = |scene: &Scene| scene.simulate(Model::FiniteTilt).pivots.iter().any(|pivot| pivot.lift_off.is_some());
    let scene = (0..60).map(|spin| drop(f64::from(spin))).find(lifts).unwrap();
    let flight = scene.simulate(Model::FiniteTilt);
    let pivot = flight.pivots.iter().find(|pivot| pivot.lift_off.is_some()).unwrap();
    let off = pivot.lift_off.unwrap();
    let arm = body.arms_m()[0];
    let pull = off.spin_rad_s.powi(2) * arm * off.tilt_rad.sin();
    assert!((pull - 9.81).abs() < 1e-9 * 9.81, "{pull}: the end parts where the ground no longer pushes");
    let rows: Vec<_> = scene.history(Model::FiniteTilt, &flight).collect();
    let up = rows.iter().position(|row| row.time_s >= pivot.until_s).unwrap();
    let [before, after] = [rows[up - 1], rows[up + 1]];
    assert!((rows[up].height_m[1] - off.height_m).abs() < 1e-15);
    assert!(before.height_m[0] == 0.0 && after.height_m[0] > 0.0, "end a is down before and up after");
    let mean = 0.5 * (off.velocity_m_s + after.velocity_m_s[1]);
    let moved = after.height_m[1] - off.height_m;
    let allowed = 2.0 * STRAIGHT * off.velocity_m_s * (after.time_s - pivot.until_s);
    assert!((moved - mean * (after.time_s - pivot.until_s)).abs() <= allowed, "end b goes on at the speed it had");
}

#[test]
fn straight_lines_through_the_rows_are_as_good_as_stated() {
    let body = Body::new(0.14, 0.04).unwrap();
    // Only so many that the roundings of late times stay small beside the last heights.
    let scene = Scene::new(body, 0.6, 3.0, 40.0, 9.81).unwrap().with_impact_limit(40).unwrap();
    let flight = scene.simulate(Model::FiniteTilt);
    let rows: Vec<_> = scene.history(Model::FiniteTilt, &flight).collect();
    let mut worst = 0.0_f64;
    for pair in rows.windows(2).filter(|pair| pair[0].time_s < pair[1].time_s) {
        let middle = 0.5 * (pair[0].time_s + pair[1].time_s);
        let largest = pair.iter().flat_map(|row| row.height_m).fold(0.0, f64::max);
        for (end, h) in scene.heights_m(Model::FiniteTilt, &flight, middle).into_iter().enumerate() {
            let line = 0.5 * (pair[0].height_m[end] + pair[1].height_m[end]);
            worst = worst.max((h - line).abs() / largest.max(h));
        }
    }
    assert!(worst <= STRAIGHT && worst > 0.1 * STRAIGHT, "{worst}: kept, and not at the price of needless rows");
}

#[test]
fn the_forces_of_the_rows_make_the_velocities_of_the_rows() {
    // Overlapping contacts, and one that presses for long.
    for (e, tilt_deg, contact_time_s) in [(0.3, 5.0, 5e-4), (0.4, 3.0, 3e-3), (0.9, 0.0, 1e-3)] {
        let scene = Scene::new(Body::new(0.14, 0.04).unwrap(), e, 4.43, tilt_deg, 9.81).unwrap();
        let flight = scene.simulate_compliant(contact_time_s).unwrap();
        let rows: Vec<_> = flight.history(contact_time_s).collect();
        let center = |row: &Row| row.velocity_at(0.0);
        let force = |row: &Row| row.press.unwrap().force_per_mass_m_s2.iter().sum::<f64>();
        let impulse: f64 =
            rows.windows(2).map(|p| 0.5 * (force(&p[0]) + force(&p[1])) * (p[1].time_s - p[0].time_s)).sum();
        let whole = rows[rows.len() - 1].time_s;
        let gained = center(&rows[rows.len() - 1]) - center(&rows[0]) + 9.81 * whole;
        // A force between its rows is off by at most its share of the larger force of both ends: a third of a per cent
        // in all, for pulses that are not a long sequence of kinks.
        assert!((impulse / gained - 1.0).abs() < 3e-3, "{impulse} of force for {gained} of velocity, e = {e}");
        assert!(matches!(flight.flight.stop, Stop::AtRest { .. }), "{:?}", flight.flight.stop);
        for strike in &flight.flight.strikes {
            assert!(
                rows.iter().any(|row| row.time_s.to_bits() == strike.time_s.to_bits()),
                "strike {} has its row",
                strike.number
            );
        }
    }
}
