//! Laws that hold for any drop.

#![allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")]

use std::f64::consts::PI;

use clatter_brute::flight::{Drop, Law, Own, Until, flat, follow};
use clatter_brute::part::{Motion, largest, largest_acceleration, respond, shocks};
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
        let got = respond(&flight, 0.0, 1e4, zeta, None).acceleration.value / 3e4;
        assert!((got - want).abs() < 1e-3, "{zeta}: {got}, not {want}");
    }
}
