//! The peak of one quantity above a given size is that of the whole response.

use clatter_shock::{
    DampingRatio, Extreme, Peaked, Pulse, Pulses, Response, Shape, Suspension, VelocityShock, VelocityShocks,
};
use proptest::prelude::*;

/// Compares two peaks. Both are computed in the same way, and differ by the scale of the wanted one alone.
fn same(response: &Response, ask: impl Fn(Peaked, f64) -> Option<Extreme>) -> Result<(), TestCaseError> {
    for peaked in [Peaked::PseudoVelocity, Peaked::AccelerationOverOmega] {
        let whole = match peaked {
            Peaked::PseudoVelocity => response.pseudo_velocity(),
            Peaked::AccelerationOverOmega => response.acceleration_over_omega(),
            Peaked::StopSpeed => unreachable!("a part without a stop"),
        };
        let (peak, size) = (whole.peak(), whole.magnitude());
        for above in [0.0, 0.5 * size, 0.999 * size] {
            let found = ask(peaked, above);
            let found =
                found.ok_or_else(|| TestCaseError::fail(format!("{peaked:?}: none above {above}, {peak:?}")))?;
            prop_assert!(
                (found.value.abs() - size).abs() <= 1e-13 * size,
                "{peaked:?} above {above}: {found:?} {peak:?}"
            );
            // Where both signs are as large, either is the peak.
            if (whole.positive.value + whole.negative.value).abs() > 1e-9 * size {
                prop_assert!(found.value * peak.value > 0.0, "{peaked:?} above {above}: {found:?} {peak:?}");
            }
            prop_assert!(found.time.is_finite(), "{found:?}");
        }
        prop_assert_eq!(ask(peaked, 1.001 * size), None);
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn of_shocks_pulses_and_histories(
        frequency in (0.0..4.0_f64).prop_map(|x| 10f64.powf(x)),
        zeta in prop_oneof![Just(0.0), 0.0..0.2_f64, 0.2..3.0_f64, Just(1.0)],
        blows in prop::collection::vec((0.0..0.05_f64, -2.0..2.0_f64, 1e-5..1e-2_f64), 1..7),
        scale in (-150.0..150.0_f64).prop_map(|x| 10f64.powf(x)),
    ) {
        let part = Suspension::from_hz(frequency, DampingRatio::new(zeta).expect("a ratio")).expect("a part");
        let mut blows: Vec<_> = blows.into_iter().map(|(time, size, lasts)| (time, size * scale, lasts)).collect();
        blows.sort_by(|a, b| a.0.total_cmp(&b.0));
        prop_assume!(blows.iter().any(|blow| blow.1 != 0.0));

        let shocks = blows.iter().map(|&(time, delta_v, _)| VelocityShock { time, delta_v }).collect();
        let shocks = VelocityShocks::new(shocks).expect("in order");
        same(&shocks.respond(&part), |peaked, above| shocks.peak_above(&part, peaked, above))?;

        let pulses: Vec<_> = blows
            .iter()
            .map(|&(start, amplitude, duration)| Pulse { shape: Shape::HalfSine, amplitude, duration, start })
            .collect();
        let pulses = Pulses::new(&pulses).expect("pulses");
        same(&pulses.respond(&part), |peaked, above| pulses.peak_above(&part, peaked, above))?;

        // Straight pieces of one length, and others.
        let points: Vec<_> = (0..9u32).map(|k| (f64::from(k) / 256.0, blows[k as usize % blows.len()].1)).collect();
        let even = Pulses::piecewise_linear(&points).expect("a history");
        same(&even.respond(&part), |peaked, above| even.peak_above(&part, peaked, above))?;
    }
}
