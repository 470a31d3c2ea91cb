//! Fits to synthetic drops whose truth is known. Strikes come from the plain recursion of the paper's Eqs. 1 to 3, heights and
//! accelerations from small steps in time: nothing here shares code with the flights that the fit computes.

#![cfg(test)]

use clatter::End;
use clatter_assess::First;
use clatter_assess::fit::{Estimate, Fit, Known, Measured, MeasuredHeights, MeasuredStrike, Quantity, bounces, fit};
use clatter_flight::{Body, ContactLaw};

/// Numbers in (0, 1), and of the standard normal distribution: `SplitMix64`, and Box and Muller.
struct Random(u64);

impl Random {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        #[expect(clippy::cast_precision_loss, reason = "53 bits")]
        let bits = ((z ^ (z >> 31)) >> 11) as f64;
        (bits + 0.5) / 9_007_199_254_740_992.0
    }
    fn within(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.uniform()
    }
    fn normal(&mut self) -> f64 {
        (-2.0 * self.uniform().ln()).sqrt() * (std::f64::consts::TAU * self.uniform()).cos()
    }
}

/// A drop of a symmetric bar at small tilt, without gravity.
#[derive(Debug, Clone, Copy)]
struct Truth {
    q: f64,
    e: [f64; 2],
    /// Gap over speed.
    gap_s: f64,
}

impl Truth {
    /// Times and ends of at most so many strikes, by Eqs. 1 to 3: the end that strikes leaves with −e u, the other gets −q (1 + e) u
    /// downward; between strikes straight lines.
    fn strikes(&self, most: usize) -> Vec<(f64, End)> {
        let (mut height, mut velocity, mut time) = ([0.0, self.gap_s], [-1.0, -1.0], 0.0);
        let mut strikes = Vec::new();
        let mut end = 0;
        while strikes.len() < most {
            strikes.push((time, if end == 0 { End::A } else { End::B }));
            let (u, e) = (velocity[end], self.e[end]);
            velocity[end] = -e * u;
            velocity[1 - end] += self.q * (1.0 + e) * u;
            height[end] = 0.0;
            end = 1 - end;
            if velocity[end] >= 0.0 {
                break;
            }
            let wait = height[end] / -velocity[end];
            height[1 - end] += velocity[1 - end] * wait;
            time += wait;
        }
        strikes
    }
}

/// So long that the gap is a vanishing tilt.
const LENGTH_M: f64 = 2000.0;

/// The radius of gyration of a bar with this inertia ratio.
fn gyration_m(q: f64) -> f64 {
    0.5 * LENGTH_M * ((1.0 - q) / (1.0 + q)).sqrt()
}

/// What a product file would say of it, which is wrong by a tenth in the radius of gyration.
fn known(q: f64) -> Known {
    Known {
        body: Body::new(LENGTH_M, 1.1 * gyration_m(q)).expect("as the test has it"),
        gyration_known: false,
        first: First::Either,
        gravity_m_s2: 0.0,
        restitution: [0.1, 0.9],
        speed_m_s: [3.5, 4.5],
        tilt_rad: [0.0, 1e-5],
        contact_time_s: None,
        contact_law: ContactLaw::Hysteretic,
    }
}

fn strikes(list: &[(f64, End)]) -> Vec<MeasuredStrike> {
    list.iter().map(|&(time_s, end)| MeasuredStrike { time_s, end: Some(end) }).collect()
}

fn of(found: &Fit, quantity: Quantity) -> &Estimate {
    found
        .estimates
        .iter()
        .find(|estimate| estimate.quantity == quantity)
        .unwrap_or_else(|| panic!("{quantity:?} in {found:#?}"))
}

/// A record of a drop with noise: strikes up to the first that come within ten standard deviations, which no sensor tells apart.
fn noisy(truth: &Truth, most: usize, deviation_s: f64, random: &mut Random) -> Vec<(f64, End)> {
    let mut list = truth.strikes(most);
    if let Some(k) = list.windows(2).position(|pair| pair[1].0 - pair[0].0 < 10.0 * deviation_s) {
        list.truncate(k + 1);
    }
    list.iter().map(|(time_s, end)| (time_s + 0.1 + deviation_s * random.normal(), *end)).collect()
}

/// The estimate of the restitution that end a has, alone or with end b.
fn restitution_of_a(found: &Fit) -> &Estimate {
    restitution_told(found).unwrap_or_else(|| panic!("a restitution in {found:#?}"))
}

fn restitution_told(found: &Fit) -> Option<&Estimate> {
    let is = |x: &&Estimate| matches!(x.quantity, Quantity::Restitution | Quantity::RestitutionA);
    found.estimates.iter().find(is)
}

fn holds(estimate: &Estimate, truth: f64) -> bool {
    let [lo, hi] = estimate.interval.expect("as the test has it");
    (lo..=hi).contains(&truth)
}

/// 93 to 97 of 100: for a true 95 % and 1000 drops chance leaves these bounds once in 300 times.
fn assert_covers(name: &str, held: usize, of: usize) {
    #[expect(clippy::cast_precision_loss, reason = "a thousand")]
    let share = held as f64 / of as f64;
    assert!((0.93..=0.97).contains(&share), "{name}: {held} of {of}");
}

/// A thousand random drops, timed to 10 µs, of products whose radius of gyration is known: nothing tells the fit how well they are
/// timed, so that intervals are those of Student's t with one degree of freedom and more.
#[test]
fn intervals_hold_the_truth_where_the_radius_of_gyration_is_known() {
    let mut random = Random(7);
    let (mut e_held, mut gap_held) = (0, 0);
    for _ in 0..1000 {
        let (truth, list) = loop {
            let (q, e) = (random.within(0.4, 0.9), random.within(0.1, 0.8));
            let truth = Truth { q, e: [e; 2], gap_s: random.within(2e-3, 8e-3) };
            let list = noisy(&truth, 10, 1e-5, &mut random);
            if list.len() >= 5 {
                break (truth, list);
            }
        };
        let body = Body::new(LENGTH_M, gyration_m(truth.q)).expect("as the test has it");
        let known = Known { gyration_known: true, body, ..known(truth.q) };
        let found = fit(&known, &[Measured::Strikes { strikes: strikes(&list), deviation_s: None }])
            .expect("as the test has it");
        e_held += usize::from(holds(restitution_of_a(&found), truth.e[0]));
        gap_held += usize::from(holds(of(&found, Quantity::GapOverSpeed), truth.gap_s));
    }
    assert_covers("restitution", e_held, 1000);
    assert_covers("gap over speed", gap_held, 1000);
}

/// The same timed to 2 µs, with a radius of gyration in the product file that is wrong by a tenth, and told by the strikes.
#[test]
fn intervals_hold_the_truth_where_the_radius_of_gyration_is_fitted() {
    let mut random = Random(11);
    let (mut e_held, mut e_told, mut gap_held, mut q_held, mut q_told) = (0, 0, 0, 0, 0);
    for _ in 0..1000 {
        let (truth, list) = loop {
            let (q, e) = (random.within(0.4, 0.9), random.within(0.1, 0.8));
            let truth = Truth { q, e: [e; 2], gap_s: random.within(2e-3, 8e-3) };
            let list = noisy(&truth, 10, 2e-6, &mut random);
            if list.len() >= 6 {
                break (truth, list);
            }
        };
        let found = fit(&known(truth.q), &[Measured::Strikes { strikes: strikes(&list), deviation_s: None }])
            .expect("as the test has it");
        if let Some(e) = restitution_told(&found) {
            e_told += 1;
            e_held += usize::from(holds(e, truth.e[0]));
        }
        gap_held += usize::from(holds(of(&found, Quantity::GapOverSpeed), truth.gap_s));
        if let Some(q) = found.estimates.iter().find(|x| x.quantity == Quantity::InertiaRatio) {
            q_told += 1;
            q_held += usize::from(holds(q, truth.q));
        }
    }
    assert_covers("restitution", e_held, e_told);
    assert_covers("gap over speed", gap_held, 1000);
    assert_covers("inertia ratio", q_held, q_told);
    assert!(e_told >= 980, "{e_told} of 1000 told the restitution");
    assert!(q_told >= 980, "{q_told} of 1000 told the radius of gyration");
}

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

/// Flights of f, e f, e² f, …: the plain geometric sequence, with noise.
#[test]
fn bounces_give_the_restitution_by_the_ratio_of_flight_times() {
    let mut random = Random(9);
    let mut held = 0;
    for _ in 0..1000 {
        let (e, flight) = (random.within(0.2, 0.9), random.within(0.2, 0.5));
        let at = |n: i32| 1.0 + flight * (1.0 - f64::powi(e, n)) / (1.0 - e) + 1e-4 * random.normal();
        let times: Vec<f64> = (0..6).map(at).collect();
        let found = bounces(&times, 9.81, None).expect("as the test has it");
        held += usize::from(holds(&found.estimates[0], e));
    }
    assert_covers("restitution", held, 1000);
    // Dropped from 1 m: 4.4294 m/s, flights of 2 e v/g.
    let (e, v) = (0.6, 4.429_446_918_f64);
    let times: Vec<f64> = (0..5)
        .scan((0.5, 2.0 * e * v / 9.81), |(t, f), _| {
            let now = *t;
            *t += *f;
            *f *= e;
            Some(now)
        })
        .collect();
    let found = bounces(&times, 9.81, Some(1e-6)).expect("as the test has it");
    assert!(
        (found.estimates[0].value - 0.6).abs() < 1e-9 && (found.estimates[1].value - 1.0).abs() < 1e-6,
        "{found:?}"
    );
    for bad in [vec![0.0, 1.0], vec![0.0, 1.0, 0.5], vec![0.0, f64::NAN, 1.0]] {
        assert!(bounces(&bad, 9.81, None).is_err(), "{bad:?}");
    }
}

/// The body of what follows: a bar of 140 mm.
const BAR_M: f64 = 0.14;
const RHO_M: f64 = 0.0365;
const G: f64 = 9.806_65;

fn bar(contact_time_s: Option<[f64; 2]>) -> Known {
    Known {
        body: Body::new(BAR_M, 0.038).expect("as the test has it"),
        gyration_known: false,
        first: First::Either,
        gravity_m_s2: G,
        restitution: [0.2, 0.5],
        speed_m_s: [3.8, 4.8],
        tilt_rad: [0.0, 0.1],
        contact_time_s,
        contact_law: ContactLaw::Hysteretic,
    }
}

/// Heights of a drop at real tilt with gravity, in steps of a microsecond: an end that is below the ground and moves down strikes.
fn heights(e: f64, speed: f64, tilt: f64, spin: f64, random: &mut Random) -> Vec<MeasuredHeights> {
    let half = 0.5 * BAR_M;
    let (touch, step) = (0.020_34, 1e-6);
    let ends = |y: f64, phi: f64| [y - half * phi.sin(), y + half * phi.sin()];
    let (mut y, mut v, mut phi, mut w) = (half * tilt.sin(), -speed, tilt, spin);
    let mut samples = Vec::new();
    for k in 0..140_000_u32 {
        let t = f64::from(k) * step - touch;
        if t < 0.0 {
            if k % 1000 == 0 {
                samples.push(ends(half * tilt.sin() - t * (speed + 0.5 * G * t), tilt + spin * t));
            }
            continue;
        }
        for (i, side) in [-1.0, 1.0].into_iter().enumerate() {
            let x = side * half * phi.cos();
            let rate = v + x * w;
            if ends(y, phi)[i] <= 0.0 && rate < 0.0 {
                let jump = -(1.0 + e) * rate / (1.0 + (x / RHO_M).powi(2));
                v += jump;
                w += jump * x / (RHO_M * RHO_M);
            }
        }
        if k % 1000 == 0 {
            samples.push(ends(y, phi));
        }
        y += step * (v - 0.5 * G * step);
        v -= G * step;
        phi += step * w;
    }
    let noisy = |(k, height_m): (usize, &[f64; 2])| {
        let height_m = height_m.map(|h| h + 2e-4 * random.normal());
        #[expect(clippy::cast_precision_loss, reason = "a hundred")]
        MeasuredHeights { time_s: 3.0 + k as f64 * 1e-3, height_m }
    };
    samples.iter().enumerate().map(noisy).collect()
}

/// From a video: speed, tilt and spin as well, for either end first.
#[test]
fn heights_tell_how_it_fell() {
    let mut random = Random(21);
    let mut held = [0; 5];
    for _ in 0..12 {
        let (e, speed, spin) = (random.within(0.25, 0.4), random.within(3.9, 4.6), random.within(-3.0, 3.0));
        let tilt = random.within(0.02, 0.04);
        let samples = heights(e, speed, tilt, spin, &mut random);
        let found = fit(&bar(None), &[Measured::Heights { samples, deviation_m: None }]).expect("as the test has it");
        let truths = [speed, tilt, spin, RHO_M];
        let quantities = [Quantity::Speed, Quantity::Tilt, Quantity::Spin, Quantity::RadiusOfGyration];
        for (k, (quantity, truth)) in quantities.into_iter().zip(truths).enumerate() {
            held[k] += usize::from(holds(of(&found, quantity), truth));
        }
        held[4] += usize::from(holds(restitution_of_a(&found), e));
        assert!((found.records[0].first_touch_s - 3.020_34).abs() < 1e-3, "{}", found.records[0].first_touch_s);
        assert!(found.records[0].scatter < 2.4e-4, "noise is 0.2 mm: {:e}", found.records[0].scatter);
    }
    // Of 12, 11 on the mean; 8 or fewer are chance once in 500 times.
    assert!(held.iter().all(|held| *held >= 9), "{held:?}");
}

/// The acceleration at a place of a bar that lands with contacts of the hysteretic law, by small steps in time, as a sensor reads it.
fn acceleration(e: f64, speed: f64, tilt: f64, contact_s: f64, place_m: f64, random: &mut Random) -> Vec<f64> {
    let half = 0.5 * BAR_M;
    let mu = 1.0 + (half / RHO_M).powi(2);
    let loading = (0.5 * std::f64::consts::PI * (1.0 + e) / contact_s).powi(2) / mu;
    let unloading = loading / (e * e);
    let (step, every) = (1e-8, 2000);
    let (mut h, mut v, mut deepest) = ([0.0, BAR_M * tilt], [-speed; 2], [0.0_f64; 2]);
    let mut values = vec![0.0; 100];
    let mut mean = 0.0;
    for k in 0..every * 500 {
        let mut force = [0.0; 2];
        for i in 0..2 {
            let depth = -h[i];
            if depth <= 0.0 {
                deepest[i] = 0.0;
            } else if depth >= deepest[i] {
                deepest[i] = depth;
                force[i] = loading * depth;
            } else {
                force[i] = (unloading * (depth - deepest[i] * (1.0 - e * e))).max(0.0);
            }
        }
        let center = force[0] + force[1] - G;
        let turn = half * (force[1] - force[0]) / (RHO_M * RHO_M);
        for (i, x) in [-half, half].into_iter().enumerate() {
            v[i] += step * (center + turn * x);
            h[i] += step * v[i];
        }
        mean += (center + turn * place_m + G) / f64::from(every);
        if (k + 1) % every == 0 {
            values.push(mean + 5.0 * random.normal());
            mean = 0.0;
        }
    }
    values
}

/// From an accelerometer: the contact time as well.
#[test]
fn accelerations_tell_the_contact_time() {
    let mut random = Random(31);
    let (e, speed, tilt, contact_s) = (0.33, 4.4, 0.03, 4.5e-4);
    let values_m_s2 = acceleration(e, speed, tilt, contact_s, 0.03, &mut random);
    for contact in [Some([3e-4, 6e-4]), None] {
        let measured =
            Measured::Acceleration { position_m: 0.03, start_s: 7.0, step_s: 2e-5, values_m_s2: values_m_s2.clone() };
        let found = fit(&bar(contact), &[measured]).expect("as the test has it");
        // Largest is some 8000 m/s²; half a percent for the levers that small steps keep, and for noise of 5 m/s².
        for (quantity, truth) in [
            (Quantity::Restitution, e),
            (Quantity::RadiusOfGyration, RHO_M),
            (Quantity::Speed, speed),
            (Quantity::Tilt, tilt),
            (Quantity::ContactTime, contact_s),
        ] {
            let value = of(&found, quantity).value;
            assert!((value / truth - 1.0).abs() < 5e-3, "{quantity:?}: {value}, not {truth}");
        }
        assert!((found.records[0].first_touch_s - 7.002).abs() < 2e-5, "{}", found.records[0].first_touch_s);
    }
}

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
