//! The least service condition that covers the response of a part.

use clatter_shock::{DampingRatio, Pulse, Pulses, Shape, Suspension, covering_condition, standard_pulse};

/// A long pulse moves a heavily damped part further than a short one of the same acceleration: a condition must cover
/// both, or it is not returned.
#[test]
fn a_condition_that_moves_a_part_less_does_not_cover() {
    let part = Suspension::from_hz(100.0, DampingRatio::new(1.0).expect("a ratio")).expect("a part");
    let felt = |pulse: Pulse| Pulses::new(&[pulse]).expect("a pulse").respond(&part);
    let mut by_displacement = 0;
    for n in 1..=40 {
        let drop = felt(Pulse { shape: Shape::HalfSine, amplitude: 50.0 * f64::from(n), duration: 12e-3, start: 0.0 });
        let found = covering_condition(&part, &drop);
        let [acceleration, displacement] = ["C", "D", "E", "A", "F", "B", "G", "H"]
            .map(|name| standard_pulse(&format!("JESD22-B110/{name}")).expect("built in"))
            .iter()
            .map(|pulse| felt(pulse.pulse()))
            .fold([None::<f64>; 2], |first, does| {
                let [a, z] = [
                    does.absolute_acceleration.magnitude() / drop.absolute_acceleration.magnitude(),
                    does.relative_displacement.magnitude() / drop.relative_displacement.magnitude(),
                ];
                [first[0].or((a >= 1.0).then_some(a)), first[1].or((a >= 1.0 && z >= 1.0).then_some(a))]
            });
        let close = |x: f64, y: f64| (x / y - 1.0).abs() < 1e-12;
        match (found, displacement) {
            (Some(found), Some(want)) => assert!(close(found.acceleration, want), "{n}: {found:?}, not {want}"),
            (found, want) => assert!(found.is_none() && want.is_none(), "{n}: {found:?}, not {want:?}"),
        }
        by_displacement += u32::from(acceleration != displacement);
    }
    assert!(by_displacement > 0, "no displacement decides");
}
