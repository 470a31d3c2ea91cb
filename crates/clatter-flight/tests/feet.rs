//! Bars and plates on feet, whose edges come down beside them: against plain integrations of the laws.

use crate::plain::Plain;
use crate::plain::plate::{Drop, PlainPlate};
use clatter_flight::{Contact, ContactLaw, Plate, PlateScene, Profile, Scene, Stop};
use proptest::prelude::*;

const G: f64 = 9.80665;

fn any_own() -> impl Strategy<Value = (f64, f64)> {
    (prop_oneof![Just(0.0), 0.05..=1.0_f64, 0.05..=1.0_f64], 1e-4..1.5e-3_f64)
}

fn contacts<const N: usize>(own: [(f64, f64); N]) -> [Contact; N] {
    own.map(|(e, time)| Contact::new(ContactLaw::Hysteretic, e, time).expect("a contact"))
}

fn config(cases: u32) -> ProptestConfig {
    let rng_seed = proptest::test_runner::RngSeed::Fixed(1);
    ProptestConfig { cases, failure_persistence: None, rng_seed, max_shrink_iters: 0, ..ProptestConfig::default() }
}

proptest! {
    #![proptest_config(config(150))]

    /// The first touches of random bars are those of the laws, to four times the precision times what a change of the drop is multiplied by.
    #[test]
    fn bars_on_feet_move_as_newton_has_it(
        half in 0.035..0.14_f64, off in -0.3..0.3_f64, q in -0.3..0.9_f64, beyond in 0.1..0.6_f64, height in 0.01..0.15_f64,
        own in [any_own(), any_own()], edges in any_own(), speed in 0.5..5.0_f64, tilt in 0.0..0.9_f64,
    ) {
        let precision = 1e-4;
        let (arms, gyration) = ([half * (1.0 + off), half * (1.0 - off)], half * ((1.0 - q) / (1.0 + q)).sqrt());
        let (x, z) = (beyond * half, height * half);
        let body = Profile::of_points([[-arms[0], 0.0], [arms[1], 0.0], [-arms[0] - x, z], [arms[1] + x, z]], gyration);
        let (body, own) = (body.expect("a body"), [own[0], own[1], edges, edges]);
        // Up to where the edge would touch first.
        let tilt = tilt * (z / x).atan();
        let scene = Scene::new(body, 0.5, speed, tilt.to_degrees(), G).expect("a drop").with_impact_limit(60).expect("a limit");
        let flight = scene.own_contacts_until(&contacts(own), precision, |_| false).expect("a flight");
        prop_assert!(flight.energy_error < 0.02, "{:e}", flight.energy_error);
        let grazes = |approach: f64| approach.abs() < 1e-3 * speed;
        let strikes: Vec<_> = flight.strikes.iter().filter(|s| !grazes(s.approach_m_s)).take(6).collect();
        let longest = own.iter().fold(0.0_f64, |most, (_, time)| most.max(*time));
        let until = strikes[strikes.len() - 1].time_s * 1.01 + 1e-3 * longest;
        let run = |faster: f64, spin: f64| {
            let plain = Plain::new(&body.points_m(), gyration, G, (ContactLaw::Hysteretic, 0.5, 1e-3)).with_own(&own);
            let mut plain = plain.start(speed * (1.0 + faster), tilt, spin * speed / arms[0]);
            prop_assume!(plain.run(usize::MAX, until, 150_000)); // else one end turns about the other for seconds
            plain.touches.retain(|touch| !grazes(touch.approach));
            Ok(plain)
        };
        let (plain, shaken) = (run(0.0, 0.0)?, [run(1e-6, 0.0)?, run(0.0, 1e-6)?]);
        let mut times = 1.0_f64;
        for (k, (strike, touch)) in (0_u32..).zip(strikes.iter().zip(&plain.touches)) {
            let late = |t: f64| (t - touch.time).abs() / touch.time.max(longest) * (touch.approach / speed).abs();
            let fast = |v: f64| (v - touch.approach).abs() / speed;
            for other in shaken.iter().filter_map(|other| other.touches.get(k as usize)) {
                times = times.max(late(other.time).max(fast(other.approach)) / 1e-6);
            }
            if times > 100.0 {
                return Ok(());
            }
            prop_assert_eq!(strike.point, touch.point, "touch {}", k);
            let (late, fast) = (late(strike.time_s), fast(strike.approach_m_s));
            // Each press before leaves its own.
            prop_assert!(late.max(fast) < (4.0 + f64::from(k)) * precision * times, "touch {k}: {late:e} {fast:e}, {times}-fold");
        }
        prop_assert!(plain.touches.len() >= strikes.len(), "{} touches", plain.touches.len());
    }

    /// Random plates are where a plain integration has them before a point lies or chatters, and all that is left is below what is said
    /// ahead.
    #[test]
    fn plates_on_feet_move_as_newton_has_it(
        half in 0.025..0.14_f64, aspect in 0.2..2.0_f64, off in [-0.4..0.4_f64, -0.4..0.4_f64], inertia in [0.5..1.2_f64, 0.5..1.2_f64],
        gaps in (0.0..0.05_f64, 0.0..0.05_f64), beyond in [0.1..0.5_f64, 0.1..0.5_f64], height in 0.005..0.1_f64,
        own in [any_own(), any_own(), any_own(), any_own()], edges in any_own(), speed in 0.5..5.0_f64, dashpots in any::<bool>(),
    ) {
        let ([a, b], [x, y]) = ([half, half * aspect], off);
        let short = |(e, time): (f64, f64)| (e, time.min(0.19 * 2.0 * a.max(b) / speed));
        let edges = if dashpots { short((edges.0.max(0.05), edges.1)) } else { short(edges) };
        let own = if dashpots { [edges; 4] } else { own.map(short) };
        let own: [(f64, f64); 8] = std::array::from_fn(|i| if i < 4 { own[i] } else { edges });
        let longest = own.iter().fold(0.0_f64, |most, (_, time)| most.max(*time));
        let law = if dashpots { ContactLaw::Dashpot } else { ContactLaw::Hysteretic };
        let drop = Drop {
            edges: [a * (1.0 + x), a * (1.0 - x), b * (1.0 + y), b * (1.0 - y)],
            gyration: [inertia[0] * a, inertia[1] * b], gaps: [gaps.0 * 2.0 * a, gaps.1 * 2.0 * b],
            speed, spin: [0.0; 2], gravity: G, law, e: edges.0, time: edges.1,
        };
        let (beyond_m, height_m) = ([beyond[0] * a, beyond[1] * b], height * half);
        // A foot touches first.
        let slopes = [0.5 * drop.gaps[0] / a, 0.5 * drop.gaps[1] / b];
        prop_assume!(height_m > slopes[0] * beyond_m[0] + slopes[1] * beyond_m[1]);
        let plate = Plate::new(drop.edges, drop.gyration).expect("a plate");
        let scene = PlateScene::new(plate, speed, drop.gaps, G).expect("a drop").with_impact_limit(400);
        let all = own.map(|(e, time)| Contact::new(law, e, time).expect("a contact"));
        let mut asked = Vec::new();
        let whole = scene.on_feet_until(beyond_m, height_m, &all, 1e-4, |ahead| { asked.push(*ahead); false }).expect("a flight");
        prop_assert!(whole.energy_error < 1e-8, "{:e}", whole.energy_error);
        for ahead in &asked {
            for strike in whole.strikes.iter().filter(|strike| strike.time_s >= ahead.time_s) {
                prop_assert!(-strike.approach_m_s <= 0.5 * ahead.most_m_s * (1.0 + 1e-9), "{strike:?} after {ahead:?}");
            }
        }
        let until_s = 30.0 * longest + 2.0 * (drop.gaps[0] + drop.gaps[1]) / speed;
        let slow = whole.strikes.iter().find(|strike| strike.approach_m_s.abs() < 4.0 * G * longest);
        let lies = |t: &f64| {
            let now = whole.sample(*t).expect("contacts");
            (0..8).any(|i| now.force_per_mass_m_s2[i] > 0.0 && now.acceleration_m_s2[i] == 0.0 && own[i].0 > 0.0)
        };
        let until_s = slow.map_or(until_s, |strike| until_s.min(strike.time_s)).min(whole.phases_s().find(lies).unwrap_or(f64::INFINITY));
        let until_s = 0.999 * until_s.min(whole.stop.time_s());
        let run = |faster: f64| {
            let mut plain = PlainPlate::on_feet(&Drop { speed: speed * (1.0 + faster), ..drop }, beyond_m, height_m, own);
            prop_assume!(plain.run(until_s, 3_000_000)); // else it chatters without end
            Ok(plain)
        };
        let (plain, shaken) = (run(0.0)?, run(1e-7)?);
        let fast = |a: [f64; 8], b: [f64; 8]| (0..8).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max) / speed;
        let times = (fast(plain.velocities(), shaken.velocities()) / 1e-7).max(1.0);
        let off = fast(whole.sample(until_s).expect("contacts").velocity_m_s, plain.velocities());
        prop_assert!(times > 1e3 || off < 1e-7 * times, "{off:e}, {times}-fold of {drop:?} {own:?}");
    }

    /// Plates that lose what they have come to rest on their feet, which carry the weight, whatever their edges did.
    #[test]
    fn plates_come_to_rest_on_their_feet(
        off in [-0.4..0.4_f64, -0.4..0.4_f64], gaps in [0.0..0.03_f64, 0.0..0.03_f64], beyond in [0.0..0.5_f64, 0.0..0.5_f64],
        height in 0.0005..0.05_f64, e in prop_oneof![Just(0.0), 0.0..0.7_f64], time in 1e-4..1.5e-3_f64, speed in 0.5..4.0_f64,
        dashpots in any::<bool>(),
    ) {
        let ([a, b], [x, y]) = ([0.1, 0.06], off);
        let plate = Plate::new([a * (1.0 + x), a * (1.0 - x), b * (1.0 + y), b * (1.0 - y)], [0.06, 0.035]).expect("a plate");
        let scene = PlateScene::new(plate, speed, [gaps[0] * 2.0 * a, gaps[1] * 2.0 * b], G).expect("a drop").with_impact_limit(20_000);
        let law = if dashpots { ContactLaw::Dashpot } else { ContactLaw::Hysteretic };
        let contacts = [Contact::new(law, e.max(if dashpots { 0.05 } else { 0.0 }), time).expect("a contact"); 8];
        let flight = scene.on_feet_until([beyond[0] * a, beyond[1] * b], height * a, &contacts, 1e-4, |_| false).expect("a flight");
        let Stop::AtRest { time_s, .. } = flight.stop else { return Err(TestCaseError::fail(format!("{:?}", flight.stop))) };
        prop_assert!(flight.energy_error < 1e-8, "{:e}", flight.energy_error);
        let forces = flight.sample(2.0 * time_s).expect("contacts").force_per_mass_m_s2;
        prop_assert!((forces.iter().sum::<f64>() / G - 1.0).abs() < 1e-9 && forces.iter().all(|force| *force >= 0.0), "{forces:?}");
    }
}
