//! Laws that hold for any box.

#![allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")]

use clatter_brute::flight::{Law, Own, Until};
use clatter_brute::solid::{Solid, follow};

/// Returns a box of these sides that lands on its lowest corner.
fn solid(upward: [f64; 3], e: f64, law: Law) -> Solid {
    let sides = [0.15, 0.07, 0.02];
    let k = [0.043, 0.02, 0.02 / 12_f64.sqrt()];
    let radii = [k[1].hypot(k[2]), k[0].hypot(k[2]), k[0].hypot(k[1])];
    Solid {
        sides,
        center: [0.004, -0.002, 0.0],
        radii,
        askew: 0.0,
        e,
        contact: (law, 4e-4),
        own: [Own::default(); 4],
        speed: 4.0,
        spin: [0.0; 3],
        upward,
        gravity: 9.806_65,
        friction: 0.0,
    }
}

#[test]
fn a_box_gains_no_energy() {
    for law in [Law::Hysteretic, Law::Dashpot] {
        for k in 0..40 {
            let share = f64::from(k) / 40.0;
            let upward = [share - 0.5, 0.3 - share * share, 0.2 + share];
            let course = follow(&solid(upward, 0.1 + 0.5 * share, law), Until { time: 0.2, quiet: 1e-2 });
            assert!(course.gain < 1e-9, "{law:?} {upward:?}: {}", course.gain);
        }
    }
}

/// A single corner straight below the center of mass gives it (1 + e) v without turning the box.
#[test]
fn a_box_on_its_corner_is_one_mass() {
    let on = solid([1.0, 0.0, 0.0], 0.4, Law::Hysteretic);
    let corner = [on.sides[0] / 2.0 - on.center[0], on.sides[1] / 2.0 - on.center[1], on.sides[2] / 2.0];
    let course = follow(&Solid { upward: corner.map(|x| -x), ..on }, Until { time: 1e-3, quiet: 1e-2 });
    let size = corner.iter().map(|x| x * x).sum::<f64>().sqrt();
    let along: Vec<f64> = (0..3)
        .map(|axis| {
            let history = course.at([0.01, 0.02, -0.003], Some(axis));
            history.steps.iter().map(|s| s.length / 6.0 * (s.push[0] + 4.0 * s.push[1] + s.push[2])).sum()
        })
        .collect();
    for (axis, change) in along.iter().enumerate() {
        // Gravity takes some 3e-3 of it back while the corner presses; the acceleration above free fall includes it.
        let expected = -corner[axis] / size * (1.4 * 4.0 + 9.806_65 * 4e-4);
        assert!((change - expected).abs() < 2e-3, "axis {axis}: {change}, not {expected}");
    }
    assert_eq!(course.order, [7]);
}
