//! Bodies of more than two contact points.

use crate::plain::Plain;
use clatter_flight::{Contact, ContactLaw, Model, Motion, Profile, Scene, Stop};
use proptest::prelude::*;

const G: f64 = 9.81;

/// Points that go round the body, of which a turn by a right angle puts another side down.
fn block(length: f64, height: f64, gyration: f64) -> Profile<4> {
    let (x, z) = (0.5 * length, 0.5 * height);
    Profile::of_points([[-x, -z], [x, -z], [x, z], [-x, z]], gyration).expect("a block")
}

fn fly<const N: usize>(body: Profile<N>, law: ContactLaw, e: f64, speed: f64, tilt: f64) -> Motion<N> {
    let scene = Scene::new(body, e, speed, tilt, G).and_then(|s| s.with_impact_limit(200)).expect("a drop");
    scene.contacts_until(&Contact::new(law, e, 3e-4).expect("a contact"), 1e-4, |_| false).expect("a flight")
}

/// Velocity of the center of mass, by two points that are apart.
fn energy<const N: usize>(flight: &Motion<N>, body: &Profile<N>, t: f64) -> f64 {
    let now = flight.sample(t).expect("contacts");
    let [x, z] = body.points_m()[0];
    let (sin, cos) = now.tilt_rad.sin_cos();
    let y = now.height_m[0] - x * sin - z * cos;
    let v = now.velocity_m_s[0] - (x * cos - z * sin) * now.spin_rad_s;
    0.5 * (v * v + (body.gyration_m() * now.spin_rad_s).powi(2)) + G * y
}

fn never_grows<const N: usize>(flight: &Motion<N>, body: &Profile<N>, law: ContactLaw) -> Result<(), TestCaseError> {
    let first = energy(flight, body, 0.0);
    let mut held = first;
    let mut free: Vec<f64> = flight.presses.iter().map(|p| p.until_s).filter(|t| *t < flight.stop.time_s()).collect();
    free.sort_by(f64::total_cmp);
    for t in free.into_iter().map(|t| t * (1.0 + 4.0 * f64::EPSILON)) {
        let now = flight.sample(t).expect("contacts");
        if now.force_per_mass_m_s2.iter().all(|force| *force == 0.0) {
            // A dashpot that has parted below the ground may press again, and give what its spring holds.
            let above = law == ContactLaw::Hysteretic || now.height_m.iter().all(|h| *h >= 0.0);
            let now = energy(flight, body, t);
            prop_assert!(now <= held + first * (flight.energy_error + 1e-12), "{now} after {held} of {first}");
            held = if above { held.min(now) } else { held };
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, max_shrink_iters: 0, ..ProptestConfig::default() })]

    /// Until it lies on one of its sides, whichever.
    #[test]
    fn a_block_tumbles_until_it_lies(
        height in 0.3..1.5_f64, gyration in 0.3..0.7_f64, e in prop_oneof![Just(0.0), 0.0..0.7_f64],
        speed in 0.5..6.0_f64, tilt in 0.0..89.0_f64, law in prop::sample::select(&ContactLaw::ALL[..]),
    ) {
        let body = block(0.2, 0.2 * height, 0.1 * gyration * 1.0_f64.hypot(height));
        let flight = fly(body, law, e, speed, tilt);
        never_grows(&flight, &body, law)?;
        prop_assert!(flight.strikes.iter().all(|s| s.tilt_rad.abs() <= std::f64::consts::PI));
        if let Stop::AtRest { time_s, .. } = flight.stop {
            let rest = flight.sample(time_s).expect("contacts");
            // Two corners of one side carry the weight, and the others are above them.
            let carries: Vec<_> = (0..4).filter(|&i| rest.force_per_mass_m_s2[i] > 0.0).collect();
            prop_assert_eq!(carries.len(), 2, "{:?}", rest);
            prop_assert!((rest.force_per_mass_m_s2.iter().sum::<f64>() - G).abs() < 1e-12);
            prop_assert!((0..4).filter(|i| !carries.contains(i)).all(|i| rest.height_m[i] > 0.01), "{:?}", rest);
        } else {
            prop_assert!(matches!(flight.stop, Stop::ImpactLimit { .. }), "{:?}", flight.stop);
        }
    }
}

/// Lever arms of now and of later once took turns at whether a corner lies or loads, 10⁻¹⁶ s each, until no more phases were
/// followed.
#[test]
fn a_corner_that_lies_and_loads_takes_no_turns() {
    let (height, gyration) = (0.884_620_092_667_451_8, 0.314_594_423_919_700_16);
    let body = block(0.2, 0.2 * height, 0.1 * gyration * 1.0_f64.hypot(height));
    let flight = fly(body, ContactLaw::Hysteretic, 0.0, 5.988_344_336_143_666, 88.855_591_618_875_89);
    assert_eq!(flight.stop.reason(), "at-rest", "{:?}", flight.stop);
    assert!(flight.phases_s().count() < 100, "{}", flight.phases_s().count());
}

#[test]
fn a_block_strikes_with_more_than_two_of_its_points() {
    let mut most = 0;
    for (tilt, speed) in [(30.0, 5.0), (40.0, 4.0), (60.0, 3.0), (80.0, 6.0)] {
        let flight = fly(block(0.2, 0.15, 0.06), ContactLaw::Hysteretic, 0.5, speed, tilt);
        assert_eq!(flight.stop.reason(), "at-rest", "{:?}", flight.stop);
        most = most.max((0..4).filter(|&i| flight.strikes.iter().any(|s| s.point == i)).count());
    }
    assert_eq!(most, 4, "none tumbled over all its corners");
}

/// Four points in a row on one side press at once, where the body has two ways to move alone.
#[test]
fn a_row_of_points_presses_as_the_laws_say() {
    let points = [[-0.1, -0.02], [-0.04, -0.02], [0.03, -0.02], [0.1, -0.02]];
    for (law, e) in [(ContactLaw::Hysteretic, 0.5), (ContactLaw::Hysteretic, 0.9), (ContactLaw::Dashpot, 0.4)] {
        for tilt in [0.0, 0.05, 0.3] {
            let time = 1e-3;
            let scene = Scene::new(Profile::of_points(points, 0.06).expect("a row"), e, 2.0, tilt, G).expect("a drop");
            let contact = Contact::new(law, e, time).expect("a contact");
            let flight = scene.contacts_until(&contact, 1e-6, |_| false).expect("a flight");
            let mut plain = Plain::new(&points, 0.06, G, (law, e, time));
            plain.fine = 300.0;
            let mut plain = plain.start(2.0, f64::to_radians(tilt), 0.0);
            for share in [0.1, 0.2, 0.3, 0.5, 0.8, 1.0, 1.5, 2.0] {
                assert!(plain.run(usize::MAX, share * time, 10_000_000), "{law:?} {e} {tilt}");
                let (now, s) = (flight.sample(plain.time).expect("contacts"), plain.state);
                for i in 0..4 {
                    let [h, v] = [plain.height(&s, i), plain.velocity(&s, i)];
                    let off = (now.height_m[i] - h).abs() / (2.0 * time) + (now.velocity_m_s[i] - v).abs() / 2.0;
                    assert!(off < 1e-5, "{law:?} {e} {tilt} at {share}: {off:e}");
                }
            }
            assert!(flight.strikes.len() >= 4, "{law:?} {e} {tilt}");
        }
    }
}

/// A bar with corners on one side alone ends as it turns over; nothing is known of what it comes down on.
#[test]
fn a_bar_with_corners_turns_over() {
    let body = Profile::new(0.14, 0.04).and_then(|b| b.with_thickness(0.02)).expect("a bar");
    let scene = Scene::new(body, 1.0, 1.0, 60.0, 0.0).and_then(|s| s.with_spin(80.0)).expect("a drop");
    for law in ContactLaw::ALL {
        let flight =
            scene.contacts_until(&Contact::new(law, 1.0, 1e-5).expect("a contact"), 1e-6, |_| false).expect("a flight");
        let Stop::TurnedOver { time_s } = flight.stop else { panic!("{:?}", flight.stop) };
        assert!(
            (flight.sample(time_s).expect("contacts").tilt_rad.abs() - 0.5 * std::f64::consts::PI).abs() < 1e-9,
            "{time_s}"
        );
        let hard = scene.fly(Model::FiniteTilt).expect("a motion").stop.time_s();
        assert!((time_s / hard - 1.0).abs() < 1e-2, "{time_s} {hard}");
        assert!(flight.later_m_s.is_infinite(), "{law:?}: nobody knows what it comes down on");
    }
}

/// A box that stands on its end topples: from there on it may be as fast as its fall to the long side makes it, and it is told before.
#[test]
fn what_topples_is_told_ahead() {
    let points = [[-0.15, -0.03], [0.15, -0.03], [0.15, 0.03], [-0.15, 0.03]];
    let body = Profile::of_points(points, 0.09).expect("a box");
    let scene = Scene::new(body, 0.1, 0.1, 75.0, G).and_then(|scene| scene.with_impact_limit(60)).expect("a drop");
    let mut told = Vec::new();
    let contact = Contact::new(ContactLaw::Hysteretic, 0.1, 1e-3).expect("a contact");
    let flight = scene.contacts_until(&contact, 1e-5, |ahead| {
        told.push(*ahead);
        false
    });
    let strikes = flight.expect("a flight").strikes;
    let fastest = strikes.iter().map(|strike| -strike.approach_m_s).fold(0.0, f64::max);
    // It lands with 0.1 m/s; from 0.15 m to 0.03 m over the ground its center gains √(2 g 0.12 m) = 1.5 m/s, the far end twice that.
    assert!(fastest > 1.0, "{fastest}: it does not topple");
    for ahead in told {
        for strike in strikes.iter().filter(|strike| strike.time_s >= ahead.time_s) {
            assert!(-strike.approach_m_s <= 0.5 * ahead.most_m_s * (1.0 + 1e-6), "{strike:?} after {ahead:?}");
        }
    }
}

/// A corner that had parted in its dent once pressed again from above it, by what a long turn about the other one had wrong: the ground
/// pulled, and energy grew.
#[test]
fn the_ground_never_pulls() {
    let (height, gyration) = (0.439_331_968_574_293_8, 0.360_002_216_167_153_33);
    let body = block(0.2, 0.2 * height, 0.1 * gyration * 1.0_f64.hypot(height));
    let flight =
        fly(body, ContactLaw::Hysteretic, 0.042_648_958_568_219_39, 2.137_926_186_721_748, 87.817_578_724_000_88);
    never_grows(&flight, &body, ContactLaw::Hysteretic).expect("no growth");
}
