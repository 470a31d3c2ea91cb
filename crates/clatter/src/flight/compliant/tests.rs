use super::*;
use proptest::prelude::*;

/// When the force of a lone contact has fallen to zero, by steps that the energy of the vibration proves.
fn by_bounds(mode: &Mode, delay: f64) -> Option<f64> {
    let force = |t: f64| {
        let (z, dz) = mode.at(t);
        [-(mode.rest + z + delay * dz), -(dz + delay * mode.second((z, dz)))]
    };
    let whole = 1.0 + delay * mode.root;
    let step = |t: f64, [f, slope]: [f64; 2]| {
        let ([z, a, _], _) = mode.bounds(mode.at(t));
        Step::clear(if whole * z < -mode.rest { f64::INFINITY } else { safe_step(f, slope, whole * a) })
    };
    let first = step(0.0, force(0.0)).by;
    if first < f64::INFINITY { first_zero(first, f64::INFINITY, force, step) } else { None }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, failure_persistence: None, ..ProptestConfig::default() })]

    /// From any moment on no derivative of a mode passes its bound, nor the next one √k times that, at any damping.
    #[test]
    fn bounds_of_a_mode_hold_ever_after(
        zeta in prop_oneof![0.0..1.0_f64, 1.0..5.0_f64, Just(1.0)],
        now in (-1.0..1.0_f64, -3.0..3.0_f64),
        after in 0.0..20.0_f64,
    ) {
        let mode = Mode::new(4.0, zeta, 0.0, now.0, now.1);
        let ([z, second, third], jerk) = mode.bounds(now);
        let (y, dy) = mode.at(after);
        let a = mode.second((y, dy));
        let (j, snap) = (mode.second((dy, a)), mode.second((a, mode.second((dy, a)))));
        for (value, bound) in [(y, z), (dy, 2.0 * z), (a, second), (j, 2.0 * second), (j, third), (snap, 2.0 * third)] {
            prop_assert!(value.abs() <= bound * (1.0 + 1e-12), "{value} above {bound}");
        }
        prop_assert_eq!(jerk.to_bits(), mode.second((now.1, mode.second(now))).to_bits());
    }

    /// From any moment at which a contact presses, below and beyond critical damping and next to it, with and without
    /// weight: the first zero of its force, neither a later one nor one that is none.
    #[test]
    fn a_lone_contact_lets_go_at_the_first_zero_of_its_force(
        zeta in prop_oneof![0.0..1.0_f64, 1.0..5.0_f64, (-12.0..-3.0_f64).prop_map(|x| 1.0 + 10f64.powf(x)), Just(0.0), Just(1.0)],
        weight in prop_oneof![Just(0.0), 0.0..2.0_f64, (-9.0..0.0_f64).prop_map(|x| 10f64.powf(x))],
        (y, dy) in (-1.0..1.0_f64, -3.0..3.0_f64),
    ) {
        let (k, delay) = (1.0, 2.0 * zeta);
        let side = -1.0_f64.copysign(y + delay * dy);
        let mode = Mode::new(k, delay, -weight, side * y, side * dy);
        let (found, proven) = (mode.lets_go(delay, f64::INFINITY), by_bounds(&mode, delay));
        let force = |t: f64| {
            let (z, dz) = mode.at(t);
            mode.rest + z + delay * dz
        };
        match (found, proven) {
            (Some(a), Some(b)) => prop_assert!((a - b).abs() <= 1e-9 * b.max(1.0), "{a} {b}"),
            // What only dies down is zero where floats end.
            (None, Some(b)) if force(0.9 * b).abs() < 1e-30 => {}
            (None, None) => {}
            // Where a crest only grazes, either answer is right.
            (a, b) => {
                let crest = (0..400).map(|i| force(0.025 * f64::from(i))).fold(f64::NEG_INFINITY, f64::max);
                prop_assert!(crest.abs() < 1e-3, "{a:?} {b:?}, crest {crest}");
            }
        }
        if let Some(t) = found {
            prop_assert_eq!(mode.lets_go(delay, 0.999 * t), None);
        }
    }
}
