//! Damage boundaries, margins and equivalent pulses.

use clatter::{Bar, Start};
use clatter_shock::{
    DamageBoundary, DampingRatio, Error, Limit, Shape, ShockTable, Suspension, Trial, respond, three_way_rule,
};
use std::f64::consts::FRAC_PI_2;

fn mount(zeta: f64) -> Suspension {
    Suspension::from_hz(100.0, DampingRatio::new(zeta).expect("damping")).expect("mount")
}

#[test]
fn knees_of_the_undamped_component() {
    // Published to the digits given.
    for (shape, knee) in [
        (Shape::HalfSine, "1.8320"),
        (Shape::Haversine, "1.842422"),
        (Shape::Triangle, "1.873125"),
        (Shape::TerminalPeakSawtooth, "1.621787"),
        (Shape::Trapezoid { ramp: 0.1 }, "1.639057"),
    ] {
        let boundary = DamageBoundary::new(mount(0.0), Limit::Acceleration(300.0), shape).expect("boundary");
        let places = knee.len() - 2;
        let got = boundary.knee_velocity_change() / boundary.critical_velocity_change();
        assert_eq!(format!("{got:.places$}"), knee, "{shape:?}");
    }
}

#[test]
fn every_point_of_the_curve_is_on_the_limit_and_inside_the_asymptotes() {
    for zeta in [0.0, 0.05, 0.5, 1.5] {
        for limit in [Limit::Acceleration(300.0), Limit::RattleSpace(2e-3)] {
            for shape in [Shape::HalfSine, Shape::InitialPeakSawtooth, Shape::Rectangle] {
                let boundary = DamageBoundary::new(mount(zeta), limit, shape).expect("boundary");
                let curve = boundary.curve(20).expect("curve");
                let (dv, a) = (boundary.critical_velocity_change(), boundary.critical_acceleration());
                // It begins at ωD = 10⁻³, where the dashpot's jump has decayed by about 2ζωD.
                assert!(
                    (curve[0].0 / dv - 1.0).abs() < 1e-3 * (1.0 + 2.0 * zeta),
                    "{shape:?} {zeta}: {} and {dv}",
                    curve[0].0
                );
                for &(v, amplitude) in &curve {
                    let margin = boundary.margin(amplitude, v / (amplitude * shape.area())).expect("margin");
                    assert!(margin.ratio().abs() < 1e-12, "{shape:?} {zeta}: {margin:?}");
                    // Rounding only: durations pass through a quotient.
                    assert!(
                        v >= dv * (1.0 - 1e-12) && amplitude >= a * (1.0 - 1e-9),
                        "{shape:?} {zeta} {limit:?}: {v} {amplitude}"
                    );
                }
            }
        }
    }
}

#[test]
fn boundary_from_tests() {
    let trial = |level, damaged| Trial { level, damaged };
    let velocity = [trial(2.0, false), trial(2.5, false), trial(3.0, true), trial(3.5, false)];
    let acceleration = [trial(500.0, true), trial(300.0, false), trial(400.0, false)];
    let boundary = DamageBoundary::from_tests(&velocity, &acceleration).expect("boundary");
    assert!((boundary.critical_velocity_change() - 2.5).abs() < 1e-12);
    assert!((boundary.critical_acceleration() - 400.0).abs() < 1e-10);
    assert!((boundary.knee_velocity_change() - 2.5 * FRAC_PI_2).abs() < 1e-12);
    assert_eq!(DamageBoundary::from_tests(&velocity[..2], &acceleration), Err(Error::Trials("velocity change")));
}

#[test]
fn an_equivalent_half_sine_or_none() {
    // A phone: v0 = 4.85 m/s, h0 = 2 mm, as if v0 = 1 and time in seconds.
    let start = Start::new([-4.85, -4.85], 2e-3).expect("start");
    let bar = Bar::new(0.5, 0.3).expect("bar");
    let table = ShockTable { shortest: 2e-4, longest: 2e-2, acceleration: 5e4, velocity_change: 20.0 };
    let component = mount(0.05);
    let clatter = respond(&bar, &start, 1.0, &component).expect("response").response;
    let found = table.equivalent_half_sine(&component, &clatter, 0.01).expect("pulse");
    let again = clatter_shock::Pulses::new(&[found.pulse]).expect("pulses").respond(&component);
    assert!((again.absolute_acceleration.magnitude() / clatter.absolute_acceleration.magnitude() - 1.0).abs() < 1e-12);
    assert!((again.relative_displacement.magnitude() / clatter.relative_displacement.magnitude() - 1.0).abs() <= 0.01);
    let weak = ShockTable { acceleration: 10.0, ..table };
    assert_eq!(
        weak.equivalent_half_sine(&component, &clatter, 0.01),
        Err(Error::NoEquivalent { nearest: f64::INFINITY })
    );
}

#[test]
fn the_three_way_rule_reaches_its_asymptotes() {
    for (q, e) in [(0.5, 0.3), (0.73, 0.2), (0.67, 0.15), (0.57, 0.1), (0.9, 0.2)] {
        let bar = Bar::new(q, e).expect("bar");
        for position in [-1.0, -0.5, 0.0, 0.5, 1.0] {
            for zeta in [0.05, 0.3, 1.5] {
                let damping = DampingRatio::new(zeta).expect("damping");
                let rule = three_way_rule(&bar, &Start::default(), position, damping, &[1e-8, 1e7]).expect("rule");
                let stiff = rule.stiff.expect("damped");
                let close = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-5;
                let name = format!("q {q} e {e} at {position}, damping {zeta}");
                assert!(close(rule.points[0].acceleration, rule.soft.acceleration), "{name}: {rule:?}");
                assert!(close(rule.points[0].displacement, rule.soft.displacement), "{name}: {rule:?}");
                if q > 0.8 {
                    // Endless: strikes crowd together at the end, and the stiff limit is only crept up to.
                    assert!(rule.points[1].acceleration > 0.999 * stiff.acceleration, "{name}: {rule:?}");
                    continue;
                }
                assert!(close(rule.points[1].acceleration, stiff.acceleration), "{name}: {rule:?}");
                assert!(close(rule.points[1].displacement, stiff.displacement), "{name}: {rule:?}");
            }
            let undamped = DampingRatio::new(0.0).expect("undamped");
            let rule = three_way_rule(&bar, &Start::default(), position, undamped, &[1.0]).expect("rule");
            assert_eq!(rule.stiff, None, "no such limit without damping");
        }
    }
}
