//! Laws that hold for any drop.

#![allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")]

use std::f64::consts::PI;

use clatter_brute::flight::{Drop, Flight, Law, Own, Until, flat, follow};
use clatter_brute::part::{Motion, Stop, Suspension, largest, largest_acceleration, respond, shocks};
use clatter_brute::random::Random;

/// Returns a drop of a body too slow to turn, on one end: a lone contact.
fn lone(law: Law, e: f64) -> Drop {
    Drop {
        length: 0.2,
        gyration: 1e3,
        center: 0.0,
        e,
        contact: Some((law, 4e-4)),
        own: [Own::default(); 2],
        speed: 3.0,
        tilt: 0.5,
        spin: 0.0,
        b_first: false,
        gravity: 0.0,
    }
}

/// Restitution, time and peak are the stated ones: the half-sine's peak of the hysteretic law at any e; for spring and
/// dashpot without loss the half-sine itself, with large loss the force at the touch, 2 v ln(1/e)/τ.
#[test]
fn a_lone_contact_is_as_stated() {
    for law in [Law::Hysteretic, Law::Dashpot] {
        for e in [0.05, 0.1, 0.25, 0.6, 1.0] {
            let mut drop = lone(law, e);
            if (0.2..0.3).contains(&e) {
                // These are the values of the end that lands, not of the product.
                drop.own[0] = Own { e: Some(e), time: Some(4e-4) };
                (drop.e, drop.contact) = (0.9, Some((law, 2e-3)));
            }
            let flight = follow(&drop, Until { time: 0.01, quiet: 0.0 });
            let last = flight.steps.iter().rev().find(|step| !step.flying).unwrap();
            let end = last.time + last.length;
            assert!((end / 4e-4 - 1.0).abs() < 1e-5, "{law:?} {e}: touches for {end:e}");
            let change = largest(&shocks(&flight, 0.0, Motion::Velocity)).value;
            assert!((change / (1.0 + e) / 3.0 - 1.0).abs() < 1e-5, "{law:?} {e}: velocity change {change}");
            let want = match law {
                Law::Dashpot if (0.2..0.9).contains(&e) => continue,
                Law::Dashpot if e < 0.2 => 2.0 * 3.0 * (1.0 / e).ln() / 4e-4,
                _ => PI / 2.0 * (1.0 + e) * 3.0 / 4e-4,
            };
            let peak = largest_acceleration(&flight, 0.0).value;
            assert!((peak / want - 1.0).abs() < 1e-5, "{law:?} {e}: peak {peak}, not {want}");
        }
    }
}

#[test]
fn energy_never_grows() {
    let mut random = Random::new(3);
    for i in 0..300 {
        let contact = [None, Some(Law::Hysteretic), Some(Law::Dashpot)][i % 3];
        let length = random.log(0.05, 0.4);
        let drop = Drop {
            length,
            gyration: length * random.within(0.15, 0.45),
            center: length * random.within(-0.15, 0.15),
            e: random.within(0.03, 0.95),
            contact: contact.map(|law| (law, random.log(1e-4, 2e-3))),
            speed: random.within(1.0, 6.0),
            tilt: random.within(0.0, 0.5),
            spin: 0.0,
            b_first: random.chance(0.5),
            gravity: 9.806_65,
            own: if contact == Some(Law::Hysteretic) && i % 2 == 0 {
                let (e, time) = (Some(random.within(0.03, 0.95)), Some(random.log(1e-4, 2e-3)));
                [Own { e, time }, Own::default()]
            } else {
                [Own::default(); 2]
            },
        };
        let flight = follow(&drop, Until { time: 0.3, quiet: 1e-3 });
        let all = flight.touches.iter().map(|touch| touch.energy).chain([flight.energy]);
        let first = flight.touches[0].energy;
        let mut before = first;
        for energy in all {
            assert!(energy <= before + 1e-6 * first, "{drop:?}: {before} to {energy}");
            before = energy;
        }
    }
}

/// The paper's bar with q = 0.5 and e = 0.3 at a small tilt, nearly without gravity: the largest shocks are 2.145 v0 at the
/// ends, 0.53625 v0 in the middle, 1.60875 v0/L of turning.
#[test]
fn instant_impacts_are_those_of_the_paper() {
    let drop = Drop {
        length: 0.2,
        gyration: 0.1 / 3f64.sqrt(),
        center: 0.0,
        e: 0.3,
        contact: None,
        speed: 5.0,
        tilt: 1e-3,
        spin: 0.0,
        b_first: false,
        own: [Own::default(); 2],
        gravity: 1e-3,
    };
    let flight = follow(&drop, Until { time: 0.05, quiet: 0.0 });
    let change = |place: f64| largest(&shocks(&flight, place, Motion::Velocity)).value / 5.0;
    for (got, want) in [
        (change(0.1).max(change(-0.1)), 2.145),
        (change(0.0), 0.536_25),
        (largest(&shocks(&flight, 0.0, Motion::Turning)).value / 5.0 * 0.1, 1.608_75),
    ] {
        assert!((got - want).abs() < 1e-4, "{got}, not {want}");
    }
}

/// A velocity shock v gives a part without damping ω v and one with a damping ratio of 0.05 0.931 ω v; a damper of
/// ratio 5 passes 2 ζ ω v on at once.
#[test]
fn a_part_answers_one_shock_as_is_known() {
    let drop = Drop { contact: None, e: 0.0, gravity: 9.8, ..lone(Law::Hysteretic, 0.0) };
    let flight = flat(&drop, Until { time: 1e-4, quiet: 0.0 });
    for (zeta, want) in [(0.0, 1.0), (0.05, 0.931), (5.0, 10.0)] {
        let suspension = Suspension { omega: 1e4, zeta, stop: None };
        let got = respond(&flight, 0.0, &suspension, None).acceleration.value / 3e4;
        assert!((got - want).abs() < 1e-3, "{zeta}: {got}, not {want}");
    }
}

/// A free part flies from stop to stop. Each throws it back with e of its speed, in the contact time, by a force whose largest
/// value is that of a half-sine, and is pressed in by v/ω₁.
#[test]
fn a_free_part_leaves_its_stop_as_is_stated() {
    let drop = Drop { contact: None, e: 0.0, gravity: 0.0, ..lone(Law::Hysteretic, 0.0) };
    let flight = flat(&drop, Until { time: 1e-4, quiet: 0.0 });
    for e in [0.0, 0.02, 0.1, 0.4, 0.8, 1.0] {
        let (gap, time) = (2e-3, 5e-4);
        let suspension = Suspension { omega: 1e-3, zeta: 0.0, stop: Some(Stop { gap, time, e }) };
        let response = respond(&flight, 0.0, &suspension, Some(0.02));
        let kept = f64::max(e, 0.01);
        let force = PI / 2.0 * (1.0 + kept) * 3.0 / time;
        let depth = 3.0 * time / (PI / 2.0 * (1.0 + kept));
        assert!((response.acceleration.value / force - 1.0).abs() < 1e-5, "{e}: {response:?}");
        assert!((response.displacement.value / (gap + depth) - 1.0).abs() < 1e-5, "{e}: {response:?}");
        assert!((response.hardest().value / 3.0 - 1.0).abs() < 1e-9, "{e}: {response:?}");
        // It leaves the dent from where its surface was left.
        let way = 2.0 * gap + depth * (1.0 - kept * kept);
        for pair in response.hits.windows(2).take(1) {
            assert!((pair[1].value / (kept * pair[0].value) - 1.0).abs() < 1e-5, "{e}: {pair:?}");
            let took = pair[1].time - pair[0].time;
            assert!((took / (time + way / (3.0 * kept)) - 1.0).abs() < 1e-5, "{e}: {pair:?}");
        }
        assert!(e < 0.1 || response.hits.len() > 1, "{e}: {response:?}");
    }
}

/// A part that a lasting push holds at its stop comes to rest there, in its dent, where spring and stop carry the push.
#[test]
fn a_part_that_is_held_at_its_stop_comes_to_rest_there() {
    let flight = Flight { at_rest: true, gravity: 9.806_65, ..Flight::default() };
    for (e, zeta) in [(0.3, 0.05), (0.3, 0.0), (0.9, 0.02), (0.0, 0.2)] {
        let stop = Stop { gap: 1e-3, time: 1e-3, e };
        let response = respond(&flight, 0.0, &Suspension { omega: 30.0, zeta, stop: Some(stop) }, Some(3.0));
        assert!(!response.hits.is_empty(), "{e}: {response:?}");
        let speed = response.hits[0].value;
        // Without damping the fall within the gap keeps its energy.
        let free: f64 = (2.0 * 9.806_65 * 1e-3 - 900.0 * 1e-6_f64).sqrt();
        assert!(zeta > 0.0 || (speed / free - 1.0).abs() < 1e-6, "{e}: {speed}, not {free}");
        assert!(speed <= free * (1.0 + 1e-9), "{e}: {speed} beyond {free}");
        let hits = &response.hits;
        assert!(hits.windows(2).all(|pair| pair[1].value < pair[0].value), "{e}: {hits:?}");
    }
}
