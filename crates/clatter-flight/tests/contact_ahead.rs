//! What a flight says ahead of what still comes, and that spin and shocks add up.

use clatter_flight::{Ahead, Contact, ContactLaw, Model, Motion, Press, Profile, Scene};
use proptest::prelude::*;

const TIME: f64 = 1e-3;

fn any_drop() -> impl Strategy<Value = (Scene, Contact)> {
    let law = prop::sample::select(&ContactLaw::ALL[..]);
    let e = prop_oneof![Just(0.0), 0.0..0.95_f64];
    let off = prop_oneof![Just(0.0), -0.3..0.3_f64];
    let tilt = prop_oneof![0.0..60.0_f64, 0.0..2.0_f64];
    (law, -0.3..0.9_f64, off, e, tilt, 0.001..0.05_f64, 0.002..0.05_f64).prop_map(
        |(law, q, off, e, tilt, by_gravity, by_speed)| {
            let (a, b) = (0.5 * (1.0 + off), 0.5 * (1.0 - off));
            let body = Profile::off_center(a, b, 0.5 * ((1.0 - q) / (1.0 + q)).sqrt()).expect("a bar");
            let (g, speed) = ((by_gravity / TIME).powi(2), by_speed / TIME);
            let scene = Scene::new(body, e, speed, tilt, g).and_then(|scene| scene.with_impact_limit(200));
            (scene.expect("a drop"), Contact::new(law, e, TIME).expect("a contact"))
        },
    )
}

fn flown(scene: &Scene, contact: &Contact, precision: f64) -> (Motion, Vec<Ahead>) {
    let mut asked = Vec::new();
    let flight = scene.contacts_until(contact, precision, |ahead| {
        asked.push(*ahead);
        false
    });
    (flight.expect("a flight"), asked)
}

fn largest(delta_v: [f64; 2]) -> f64 {
    delta_v[0].abs().max(delta_v[1].abs())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, max_shrink_iters: 0, ..ProptestConfig::default() })]

    /// Later strikes stay below `most_m_s`, and `largest_m_s` is that of the strikes so far; `lands` where one touches then, and
    /// nowhere else.
    #[test]
    fn what_is_said_ahead_holds((scene, contact) in any_drop()) {
        let (flight, asked) = flown(&scene, &contact, 1e-4);
        let strikes = &flight.strikes;
        // What carrying the body at one end alone does to that end.
        let arm = scene.body().arms_m().into_iter().fold(0.0, f64::max);
        let weight = scene.gravity_m_s2() * (1.0 + (arm / scene.body().gyration_m()).powi(2));
        for ahead in &asked {
            // What a flight gets wrong of its energy may come on top.
            let wrong = 1e-3 * scene.speed_m_s();
            for (strike, press) in strikes.iter().zip(&flight.presses).filter(|(strike, _)| strike.time_s >= ahead.time_s) {
                prop_assert!(-strike.approach_m_s <= 0.5 * ahead.most_m_s + wrong, "{strike:?} after {ahead:?}");
                // The Δv of a strike that presses for long has the weight in it that it carries, that of one beside another what it
                // holds against it.
                let pressed_s = press.until_s - press.from_s;
                let beside = |other: &&Press| other.from_s < press.until_s && press.from_s < other.until_s;
                if pressed_s < 2.0 * TIME && flight.presses.iter().filter(beside).count() == 1 {
                    let most = ahead.most_m_s + weight * pressed_s + wrong;
                    prop_assert!(largest(strike.delta_v_m_s) <= most, "{strike:?} after {ahead:?}");
                }
            }
            let touches = strikes.iter().any(|strike| strike.time_s.to_bits() == ahead.time_s.to_bits());
            // The flight may end with the touch that was asked for.
            let last = ahead.time_s >= flight.stop.time_s();
            prop_assert!(ahead.lands == touches || last, "{ahead:?}, {touches}");
            let whole = |press: &Press| press.until_s < ahead.time_s;
            let ended = strikes.iter().zip(&flight.presses).filter(|(_, press)| whole(press));
            let known = ended.map(|(strike, _)| largest(strike.delta_v_m_s)).fold(0.0, f64::max);
            prop_assert!(ahead.largest_m_s >= known * (1.0 - 1e-9), "{ahead:?}, {known} so far");
        }
        prop_assert!(asked.is_sorted_by(|a, b| a.time_s <= b.time_s));
    }

    /// The flight ends where it was enough, before what lands then.
    #[test]
    fn a_flight_ends_where_it_is_enough((scene, contact) in any_drop(), n in 0..6_usize) {
        let (whole, asked) = flown(&scene, &contact, 1e-4);
        let Some(at) = asked.get(n) else { return Ok(()) };
        let mut count = 0;
        let short = scene.contacts_until(&contact, 1e-4, |_| {
            count += 1;
            count > n
        });
        let short = short.expect("a flight");
        prop_assert_eq!(short.stop.time_s().to_bits(), at.time_s.to_bits());
        let before = whole.strikes.iter().filter(|strike| strike.time_s < at.time_s).count();
        prop_assert_eq!(short.strikes.len(), before);
    }

    /// What turns the body adds up to how its spin changes, from any moment to any other.
    #[test]
    fn what_turns_adds_up((scene, contact) in any_drop(), share in 0.0..1.0_f64) {
        let (flight, _) = flown(&scene, &contact, 1e-3);
        let end_s = flight.stop.time_s();
        let turned = flight.turned();
        let sum: f64 = turned.sections().map(|section| section.velocity_after(section.length)).sum();
        let changed = flight.sample(end_s).expect("contacts").spin_rad_s - scene.spin_rad_s();
        let size = scene.speed_m_s();
        prop_assert!((sum - changed).abs() < 1e-9 * size, "{sum} {changed}");
        // Within a phase what is spread over it is not where it was: as much as kept arms get wrong.
        let until = share * end_s;
        let within = turned.sections().filter(|section| section.from <= until);
        let part: f64 = within.map(|s| s.velocity_after((until - s.from).min(s.length))).sum();
        let moved = flight.sample(until).expect("contacts").spin_rad_s - scene.spin_rad_s();
        let fastest = flight.strikes.iter().fold(0.0_f64, |most, strike| most.max(-strike.approach_m_s));
        let allowed = 4.0 * 1e-3 * fastest / (0.5 * scene.body().gyration_m());
        prop_assert!((part - moved).abs() < allowed, "{part} {moved}, {allowed} allowed");
    }

    /// No instant impact has a shock above what was told of it after any strike before.
    #[test]
    fn no_later_shock_is_larger_than_told((scene, _) in any_drop()) {
        for model in [Model::Ballistic, Model::FiniteTilt] {
            let mut told = Vec::new();
            let motion = scene.fly_until(model, 1e-4, |ahead| {
                told.push(0.5 * (1.0 + scene.e()) * ahead.most_m_s);
                false
            });
            let motion = motion.expect("a motion");
            let strikes = &motion.strikes;
            told.push(if strikes.len() > told.len() { motion.later_m_s } else { f64::INFINITY });
            let mut most = 0.0_f64;
            for (k, strike) in strikes.iter().enumerate().rev() {
                let told = told[k];
                // Roundings of heights, where strikes are so small.
                prop_assert!(most <= told * (1.0 + 1e-12) + 1e-15 * scene.speed_m_s(), "{model:?}, after {k}: {most}, {told} told");
                most = most.max(largest(strike.delta_v_m_s));
            }
        }
    }
}
