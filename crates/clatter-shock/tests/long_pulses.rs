//! Pulses of many periods and pulses in heaps: every turning point counts, and none may take for ever.

use clatter_shock::{DampingRatio, Error, Pulse, Pulses, Shape, State, Suspension};
use std::f64::consts::PI;

fn mount(omega: f64, zeta: f64) -> Suspension {
    Suspension::new(omega, DampingRatio::new(zeta).expect("damping")).expect("mount")
}

/// Returns z and z′ in a half-sine of unit amplitude and duration D at ω = 1: steady motion Im S e^(iνt), S = −1/(1 −
/// ν² + 2iζν), and the free motion that brings it from rest.
fn in_half_sine(mount: &Suspension, duration: f64, t: f64) -> State {
    let (nu, zeta) = (PI / duration, mount.damping().get());
    let (re, im) = (1.0 - nu * nu, 2.0 * zeta * nu);
    let norm = re * re + im * im;
    let (s_re, s_im) = (-re / norm, im / norm);
    let steady = |t: f64| {
        let (sin, cos) = (nu * t).sin_cos();
        State { displacement: s_re * sin + s_im * cos, velocity: nu * (s_re * cos - s_im * sin) }
    };
    let start = steady(0.0);
    let free = mount.free(State { displacement: -start.displacement, velocity: -start.velocity }, t);
    let now = steady(t);
    State { displacement: now.displacement + free.displacement, velocity: now.velocity + free.velocity }
}

/// Returns the largest value of `f` on [0, end]: on a grid of 1/6, then by golden section around the ten best.
fn largest(f: impl Fn(f64) -> f64, end: f64) -> f64 {
    let step = 1.0 / 6.0;
    let mut values: Vec<(f64, f64)> =
        (0..1_000_000_u32).map(|i| f64::from(i) * step).take_while(|&t| t < end).map(|t| (f(t), t)).collect();
    values.push((f(end), end));
    values.sort_by(|a, b| b.0.total_cmp(&a.0));
    let golden = 0.5 * (5_f64.sqrt() - 1.0);
    values.iter().take(10).fold(f64::NEG_INFINITY, |best, &(value, t)| {
        let (mut low, mut high) = ((t - step).max(0.0), (t + step).min(end));
        for _ in 0..40 {
            let (a, b) = (high - golden * (high - low), low + golden * (high - low));
            if f(a) < f(b) { low = a } else { high = b }
        }
        best.max(value).max(f(0.5 * (low + high)))
    })
}

#[test]
fn no_turning_point_of_a_long_half_sine_is_missed() {
    for zeta in [0.0, 1e-3, 0.05, 0.7, 1.0, 2.0] {
        for duration in [3.0, 11.0, 70.0, 1000.0] {
            let mount = mount(1.0, zeta);
            let pulse = Pulse { shape: Shape::HalfSine, amplitude: 1.0, duration, start: 0.0 };
            let got = Pulses::new(&[pulse]).expect("pulse").respond(&mount);
            for (name, extremes) in
                [("z", got.relative_displacement), ("z'", got.relative_velocity), ("A", got.absolute_acceleration)]
            {
                let value = |t: f64| {
                    let state = in_half_sine(&mount, duration, t);
                    match name {
                        "z" => state.displacement,
                        "z'" => state.velocity,
                        _ => mount.absolute_acceleration(state),
                    }
                };
                for (extreme, sign) in [(extremes.positive, 1.0), (extremes.negative, -1.0)] {
                    let within = largest(|t| sign * value(t), duration).max(0.0);
                    // Ten thousand roundings of a displacement of about 1, of which a velocity is a small difference.
                    let allowed = 1e-12;
                    let got = sign * extreme.value;
                    assert!(got >= within - allowed, "{name} at {zeta}, {duration}: {got}, not {within}");
                    if extreme.time < duration && extreme.value != 0.0 {
                        assert!(got <= within + allowed, "{name} at {zeta}, {duration}: {got}, not {within}");
                    }
                }
            }
        }
    }
}

/// Returns the response to the sum of pulses as the sum of the responses, at one instant after all of them.
fn end_by_sum(list: &[Pulse], mount: &Suspension, end: f64) -> State {
    list.iter().fold(State::default(), |sum, p| {
        let one = Pulses::new(&[*p]).expect("pulse").state_at_end(mount);
        let later = mount.free(one, end - (p.start + p.duration));
        State { displacement: sum.displacement + later.displacement, velocity: sum.velocity + later.velocity }
    })
}

#[test]
fn heaps_of_pulses_add_up() {
    let shapes = [
        Shape::HalfSine,
        Shape::Haversine,
        Shape::Triangle,
        Shape::InitialPeakSawtooth,
        Shape::TerminalPeakSawtooth,
        Shape::Rectangle,
        Shape::Trapezoid { ramp: 0.2 },
    ];
    // A hundred at a time, of three lengths: far more than are summed one by one.
    let list: Vec<Pulse> = (0_u32..600)
        .map(|i| Pulse {
            shape: shapes[i as usize % shapes.len()],
            amplitude: 1.0 + f64::from(i * 37 % 101) / 101.0,
            duration: 0.5 + 0.25 * f64::from(i % 3),
            start: f64::from(i) * 0.007,
        })
        .collect();
    let pulses = Pulses::new(&list).expect("pulses");
    let end = list.iter().fold(0.0_f64, |m, p| m.max(p.start + p.duration));
    for (omega, zeta) in [(0.3, 0.0), (6.0, 0.05), (40.0, 0.0), (6.0, 1.0), (3.0, 4.0)] {
        let mount = mount(omega, zeta);
        let (got, want) = (pulses.state_at_end(&mount), end_by_sum(&list, &mount, end));
        let size = 600.0 / omega;
        for (got, want) in [(got.displacement * omega, want.displacement * omega), (got.velocity, want.velocity)] {
            // A thousand roundings of the sum of all.
            assert!((got - want).abs() <= 1e-13 * size, "at {omega}, {zeta}: {got}, not {want}");
        }
        let peak = pulses.respond(&mount).relative_displacement.magnitude();
        assert!(peak >= got.displacement.abs() * (1.0 - 1e-12), "at {omega}, {zeta}: {peak} at most");
    }
}

#[test]
fn too_many_lengths_at_once_are_refused() {
    let list = |n: u32, spread: f64| -> Vec<Pulse> {
        (0..n)
            .map(|i| Pulse {
                shape: Shape::HalfSine,
                amplitude: 1.0,
                duration: 1.0 + spread * f64::from(i),
                start: 1e-6 * f64::from(i),
            })
            .collect()
    };
    assert!(Pulses::new(&list(3000, 0.0)).is_ok(), "one length adds up");
    let refused = Pulses::new(&list(3000, 1e-6)).expect_err("three thousand lengths");
    assert!(matches!(refused, Error::Overlap { .. }), "{refused}");
    assert!(refused.to_string().starts_with("the pulses overlap in 9000000 sinusoids"), "{refused}");
}
