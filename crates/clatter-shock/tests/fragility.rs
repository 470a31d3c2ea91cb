//! Damage boundaries, margins and equivalent pulses.

use clatter::{Bar, Start};
use clatter_shock::{
    DamageBoundary, DampingRatio, Error, Limit, Pulse, Pulses, Shape, ShockTable, Suspension, Trial, respond,
    three_way_rule,
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
                // It ends at the knee; without one after ten periods, where pulses do as the longest.
                let ends = if boundary.knee_velocity_change().is_finite() { 1e-6 } else { 0.2 };
                let last = curve[curve.len() - 1].1;
                assert!((last / a - 1.0).abs() < ends, "{shape:?} {zeta} {limit:?}: {last} and {a}");
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
    let again = Pulses::new(&[found.pulse]).expect("pulses").respond(&component);
    assert!((again.absolute_acceleration.magnitude() / clatter.absolute_acceleration.magnitude() - 1.0).abs() < 1e-12);
    assert!((again.relative_displacement.magnitude() / clatter.relative_displacement.magnitude() - 1.0).abs() <= 0.01);
    let weak = ShockTable { acceleration: 10.0, ..table };
    assert_eq!(
        weak.equivalent_half_sine(&component, &clatter, 0.01),
        Err(Error::NoEquivalent { nearest: f64::INFINITY, tolerance: 0.01 })
    );
}

/// Returns the peaks by a half-sine, the acceleration first.
fn done(component: &Suspension, amplitude: f64, duration: f64) -> [f64; 2] {
    let pulse = Pulse { shape: Shape::HalfSine, amplitude, duration, start: 0.0 };
    let response = Pulses::new(&[pulse]).expect("pulse").respond(component);
    [response.absolute_acceleration.magnitude(), response.relative_displacement.magnitude()]
}

/// No duration of a fine grid needs less acceleration and fits, and the pulse found does fit. Once the longest was
/// taken, which needs half as much again.
#[test]
fn the_equivalent_half_sine_needs_the_least_acceleration() {
    let start = Start::new([-4.85, -4.85], 2e-3).expect("start");
    for (q, e, zeta, tolerance) in [
        (0.5, 0.3, 0.05, 0.01),
        (0.5, 0.3, 0.0, 0.01),
        (0.73, 0.2, 0.3, 0.003),
        (0.5, 0.3, 0.7, 0.1),
        (0.67, 0.15, 0.05, 1e-6),
    ] {
        let component = mount(zeta);
        let clatter = respond(&Bar::new(q, e).expect("bar"), &start, 1.0, &component).expect("response").response;
        let (a, z) = (clatter.absolute_acceleration.magnitude(), clatter.relative_displacement.magnitude());
        for (acceleration, velocity_change) in [(5e4, 20.0), (f64::INFINITY, 8.0), (2500.0, f64::INFINITY)] {
            let table = ShockTable { shortest: 2e-4, longest: 5e-2, acceleration, velocity_change };
            let found = table.equivalent_half_sine(&component, &clatter, tolerance);
            let mut least = f64::INFINITY;
            for i in 0..=5000 {
                let duration = 2e-4 * 250_f64.powf(f64::from(i) / 5000.0);
                let [unit_a, unit_z] = done(&component, 1.0, duration);
                let amplitude = a / unit_a;
                let possible =
                    amplitude <= acceleration && amplitude * duration * Shape::HalfSine.area() <= velocity_change;
                if possible && (amplitude * unit_z / z - 1.0).abs() <= tolerance {
                    least = least.min(amplitude);
                }
            }
            let name =
                format!("q {q}, damping {zeta}, tolerance {tolerance:e}, up to {acceleration} and {velocity_change}");
            let Ok(found) = found else {
                assert!(least.is_infinite(), "{name}: {found:?}, not {least}");
                continue;
            };
            let pulse = found.pulse;
            assert!(pulse.amplitude <= least * (1.0 + 1e-12), "{name}: {}, not {least}", pulse.amplitude);
            assert!(pulse.amplitude <= acceleration && pulse.velocity_change() <= velocity_change, "{name}: {found:?}");
            let [got_a, got_z] = done(&component, pulse.amplitude, pulse.duration);
            assert!((got_a / a - 1.0).abs() < 1e-12, "{name}: {got_a}, not {a}");
            assert!((got_z / z - 1.0).abs() <= tolerance + 1e-12, "{name}: {got_z}, not {z}");
            // The grid comes as near as its steps.
            assert!(
                least.is_infinite() || pulse.amplitude >= 0.999 * least,
                "{name}: {}, not {least}",
                pulse.amplitude
            );
        }
    }
}

/// The tolerance is far below the steps of the grid of durations: the wanted pulse is found all the same, between them.
#[test]
fn an_equivalent_half_sine_between_the_durations_of_a_grid() {
    let table =
        ShockTable { shortest: 1e-4, longest: 1e-2, acceleration: f64::INFINITY, velocity_change: f64::INFINITY };
    for zeta in [0.05, 0.3, 1.0, 2.0] {
        let component = mount(zeta);
        for duration in [1.234e-3, 4.321e-3, 8.765e-3] {
            let pulse = Pulse { shape: Shape::HalfSine, amplitude: 1000.0, duration, start: 0.0 };
            let asked = Pulses::new(&[pulse]).expect("pulse").respond(&component);
            let found = table.equivalent_half_sine(&component, &asked, 1e-10).expect("the pulse itself").pulse;
            assert!(found.amplitude <= pulse.amplitude * (1.0 + 1e-8), "damping {zeta}: {found:?}, not {pulse:?}");
        }
    }
    // The durations span many periods, of which 1/48 of an octave is most of one.
    let (component, table) = (mount(2e-3), ShockTable { shortest: 0.59, longest: 0.62, ..table });
    for i in 0..21 {
        let duration = 0.592 + 0.0013 * f64::from(i);
        let pulse = Pulse { shape: Shape::HalfSine, amplitude: 1000.0, duration, start: 0.0 };
        let asked = Pulses::new(&[pulse]).expect("pulse").respond(&component);
        let found = table.equivalent_half_sine(&component, &asked, 1e-9).expect("the pulse itself").pulse;
        assert!(found.amplitude <= pulse.amplitude * (1.0 + 1e-7), "{duration} s: {found:?}, not {pulse:?}");
    }
}

#[test]
fn tables_that_are_none_are_refused() {
    let component = mount(0.05);
    let pulse = Pulse { shape: Shape::HalfSine, amplitude: 1000.0, duration: 3e-3, start: 0.0 };
    let asked = Pulses::new(&[pulse]).expect("pulse").respond(&component);
    let table = ShockTable { shortest: 1e-4, longest: 1e-2, acceleration: 1e4, velocity_change: 10.0 };
    for (table, tolerance, message) in [
        (ShockTable { shortest: 0.0, ..table }, 0.01, "shortest pulse of the table = 0.0 is not finite and > 0"),
        (ShockTable { shortest: f64::NAN, ..table }, 0.01, "shortest pulse of the table = NaN is not finite and > 0"),
        (
            ShockTable { longest: f64::INFINITY, ..table },
            0.01,
            "longest pulse of the table = inf is not finite and > 0",
        ),
        (ShockTable { longest: 5e-5, ..table }, 0.01, "longest pulse of the table = 5e-5 is not at least the shortest"),
        (ShockTable { acceleration: -1.0, ..table }, 0.01, "acceleration of the table = -1.0 is not > 0"),
        (ShockTable { acceleration: f64::NAN, ..table }, 0.01, "acceleration of the table = NaN is not > 0"),
        (ShockTable { velocity_change: f64::NAN, ..table }, 0.01, "velocity change of the table = NaN is not > 0"),
        (ShockTable { velocity_change: 0.0, ..table }, 0.01, "velocity change of the table = 0.0 is not > 0"),
        (table, f64::NAN, "tolerance of the displacement = NaN is not finite and > 0"),
        (table, -0.01, "tolerance of the displacement = -0.01 is not finite and > 0"),
    ] {
        let refused = table.equivalent_half_sine(&component, &asked, tolerance).expect_err(message);
        assert_eq!(refused.to_string(), message);
    }
    // One duration alone is a table, and too far from the wanted one by its own mismatch.
    let one = ShockTable { shortest: 6e-3, longest: 6e-3, ..table };
    let Err(Error::NoEquivalent { nearest, .. }) = one.equivalent_half_sine(&component, &asked, 1e-5) else {
        panic!("one duration is another pulse");
    };
    let ratio = |[a, z]: [f64; 2]| z / a;
    let mismatch = ratio(done(&component, 1.0, 6e-3)) / ratio(done(&component, 1.0, 3e-3)) - 1.0;
    assert!((nearest / mismatch.abs() - 1.0).abs() < 1e-9, "{nearest}, not {mismatch}");
    let told = |nearest| Error::NoEquivalent { nearest, tolerance: 1e-4 }.to_string();
    let expected = "no half-sine of this shock table is equivalent: at equal acceleration the displacement is off by 0.0101 % at \
                    best, more than the 0.01 % allowed";
    assert_eq!(told(1.001e-4), expected);
    assert!(told(f64::INFINITY).ends_with("are beyond its acceleration or velocity change"));
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
