//! Strike times: what they tell, and which strike is which.

use clatter::End;
use clatter_fit::{Fit, Known, Measured, MeasuredStrike, Quantity, fit};
use clatter_flight::Body;

use super::synthetic::{LENGTH_M, Random, Truth, gyration_m, known, noisy, of, restitution_of_a, strikes};

/// Four strikes timed to 10 µs give e within 0.01 where the radius of gyration is known.
#[test]
fn four_strikes_give_the_restitution() {
    let mut random = Random(3);
    for (q, e) in [(0.5, 0.3), (0.55, 0.35), (0.6, 0.2), (0.65, 0.5)] {
        let truth = Truth { q, e: [e; 2], gap_s: 5e-3 };
        let body = Body::new(LENGTH_M, gyration_m(q)).expect("as the test has it");
        let known = Known { gyration_known: true, body, ..known(q) };
        let near = (0..100).filter(|_| {
            let list = noisy(&truth, 4, 1e-5, &mut random);
            assert_eq!(list.len(), 4, "{q}, {e}");
            let found = fit(&known, &[Measured::Strikes { strikes: strikes(&list), deviation_s: Some(1e-5) }])
                .expect("as the test has it");
            (restitution_of_a(&found).value - e).abs() < 0.01
        });
        let near = near.count();
        // 95 of 100 is what an interval of 95 % with a half-width of 0.01 would give; chance may take 5 more.
        assert!(near >= 90, "q = {q}, e = {e}: {near} of 100 within 0.01");
    }
}

#[test]
fn exact_strikes_give_the_truth() {
    for (q, e) in [(0.5, 0.3), (0.73, 0.2), (0.85, 0.6), (0.6, 0.45)] {
        let truth = Truth { q, e: [e; 2], gap_s: 2e-3 };
        let list: Vec<_> = truth.strikes(8).into_iter().map(|(time_s, end)| (time_s + 0.37, end)).collect();
        let found = fit(&known(q), &[Measured::Strikes { strikes: strikes(&list), deviation_s: Some(1e-9) }])
            .expect("as the test has it");
        // As far as 1e-9 s of noise tell, and the tilt of 4e-6 rad that the recursion leaves out.
        assert!((restitution_of_a(&found).value - e).abs() < 1e-4, "{q}, {e}: {found:#?}");
        assert!((of(&found, Quantity::InertiaRatio).value - q).abs() < 1e-4, "{q}, {e}");
        assert!((of(&found, Quantity::GapOverSpeed).value - 2e-3).abs() < 1e-6, "{q}, {e}");
        assert!((found.records[0].first_touch_s - 0.37).abs() < 1e-8, "{q}, {e}");
    }
}

/// Ends that rebound differently are told apart.
#[test]
fn each_end_has_its_restitution() {
    let truth = Truth { q: 0.75, e: [0.35, 0.25], gap_s: 4e-3 };
    let list = truth.strikes(9);
    assert!(list.len() >= 6, "{list:?}");
    let found = fit(&known(0.75), &[Measured::Strikes { strikes: strikes(&list), deviation_s: Some(1e-7) }])
        .expect("as the test has it");
    let [a, b] = [Quantity::RestitutionA, Quantity::RestitutionB].map(|quantity| of(&found, quantity));
    assert!((a.value - 0.35).abs() < 1e-3 && (b.value - 0.25).abs() < 1e-3, "{a:?} {b:?}");
    // Seen from the other side it is end b that touches first and rebounds more.
    let list: Vec<_> = list.into_iter().map(|(time_s, end)| (time_s, end.other())).collect();
    let found = fit(&known(0.75), &[Measured::Strikes { strikes: strikes(&list), deviation_s: Some(1e-7) }])
        .expect("as the test has it");
    let [a, b] = [Quantity::RestitutionA, Quantity::RestitutionB].map(|quantity| of(&found, quantity));
    assert!((a.value - 0.25).abs() < 1e-3 && (b.value - 0.35).abs() < 1e-3, "{a:?} {b:?}");
}

/// Gap and speed, both doubled, give the same strikes: the data cannot tell them apart, and that is said.
#[test]
fn strike_times_alone_tell_gap_over_speed() {
    let list = Truth { q: 0.6, e: [0.4; 2], gap_s: 3e-3 }.strikes(4);
    let measured = [Measured::Strikes { strikes: strikes(&list), deviation_s: Some(1e-6) }];
    let fits = [1.0, 2.0].map(|factor| {
        let speed_m_s = [factor * 3.5, factor * 4.5];
        fit(
            &Known {
                speed_m_s,
                gyration_known: true,
                body: Body::new(LENGTH_M, gyration_m(0.6)).expect("as the test has it"),
                ..known(0.6)
            },
            &measured,
        )
        .expect("as the test has it")
    });
    let [slow, fast] = fits.each_ref().map(|found| of(found, Quantity::Tilt).value);
    assert!((fast / slow - 2.0).abs() < 1e-6, "the tilt follows the speed of the product file: {slow}, {fast}");
    let [slow, fast] = fits.each_ref().map(|found| of(found, Quantity::GapOverSpeed).value);
    assert!((fast / slow - 1.0).abs() < 1e-6, "{slow}, {fast}");
    let untold = fits[0].untold.iter().find(|untold| untold.quantity == Quantity::Speed).expect("as the test has it");
    assert!(untold.reason.contains("strike times alone tell the gap over the speed"), "{}", untold.reason);
}

/// A record of ten strikes of an even bar, some of them taken out or moved.
fn faulty(change: impl Fn(&mut Vec<(f64, End)>)) -> Fit {
    let mut random = Random(5);
    let truth = Truth { q: 0.86, e: [0.55; 2], gap_s: 8e-3 };
    let mut list = noisy(&truth, 10, 2e-6, &mut random);
    assert!(list.len() >= 7, "{list:?}");
    change(&mut list);
    let body = Body::new(LENGTH_M, gyration_m(0.86)).expect("as the test has it");
    let known = Known { gyration_known: true, body, ..known(0.86) };
    fit(&known, &[Measured::Strikes { strikes: strikes(&list), deviation_s: Some(2e-6) }]).expect("as the test has it")
}

#[test]
fn missing_merged_and_wrong_strikes_are_found() {
    let whole = faulty(|_| ());
    assert!(
        whole.records[0].missing.is_empty() && whole.records[0].strikes.iter().all(|s| s.number.is_some()),
        "{whole:#?}"
    );
    for place in 1..4 {
        let missing = faulty(|list| {
            list.remove(place);
        });
        assert_eq!(missing.records[0].missing, [place + 1], "strike {}", place + 1);
        assert!((restitution_of_a(&missing).value - 0.55).abs() < 0.01, "{place}: {:?}", restitution_of_a(&missing));
    }
    // Half a millisecond late, a dozen times the error of the others and more.
    for place in 1..4 {
        let wrong = faulty(|list| list[place].0 += if place == 1 { -5e-4 } else { 1e-4 });
        let left_out: Vec<_> =
            (0..wrong.records[0].strikes.len()).filter(|&k| wrong.records[0].strikes[k].number.is_none()).collect();
        assert_eq!(left_out, [place], "{:#?}", wrong.records[0]);
        assert!((restitution_of_a(&wrong).value - 0.55).abs() < 0.01, "{place}: {:?}", restitution_of_a(&wrong));
        assert!(wrong.notes.iter().any(|note| note.contains("was left out")), "{:?}", wrong.notes);
    }
}

/// A strike is of the end that it was measured at: where one is named wrongly, the strikes are not all explained.
#[test]
fn a_strike_of_the_wrong_end_is_not_explained() {
    let truth = Truth { q: 0.86, e: [0.55; 2], gap_s: 8e-3 };
    let mut list: Vec<_> = truth.strikes(8).into_iter().map(|(time_s, end)| (time_s, Some(end))).collect();
    list[4..].iter_mut().for_each(|strike| strike.1 = None);
    let taken = |list: &[(f64, Option<End>)]| {
        let strikes = list.iter().map(|&(time_s, end)| MeasuredStrike { time_s, end }).collect();
        let found = fit(&known(0.86), &[Measured::Strikes { strikes, deviation_s: Some(2e-6) }]);
        found.map_or(0, |found| found.records[0].strikes.iter().filter(|strike| strike.number.is_some()).count())
    };
    assert_eq!(taken(&list), list.len());
    list[3].1 = list[3].1.map(End::other);
    assert!(taken(&list) < list.len());
}

/// With contacts that take time missing strikes are not looked for. Where one is missing, the answer says so.
#[test]
fn contacts_that_take_time_say_that_missing_strikes_are_not_looked_for() {
    let list = Truth { q: 0.86, e: [0.55; 2], gap_s: 8e-3 }.strikes(8);
    let body = Body::new(LENGTH_M, gyration_m(0.86)).expect("as the test has it");
    let known = Known { gyration_known: true, body, contact_time_s: Some([2e-5, 2e-5]), ..known(0.86) };
    let notes = |list: &[(f64, End)]| {
        let measured = [Measured::Strikes { strikes: strikes(list), deviation_s: None }];
        fit(&known, &measured).map(|found| found.notes)
    };
    assert!(!notes(&list).expect("as the test has it").iter().any(|note| note.contains("missing")), "nothing is");
    for place in 1..5 {
        let mut list = list.clone();
        list.remove(place);
        let said = match notes(&list) {
            Ok(notes) => notes.join("\n"),
            Err(error) => error.to_string(),
        };
        assert!(said.contains("missing strikes are not looked for"), "strike {}: {said}", place + 1);
    }
}
