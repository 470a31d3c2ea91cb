//! Histories of sections against Runge–Kutta steps of order 4, and against pulses of the same shape.

#![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small counts of steps")]

use clatter::{Section, Sine};
use clatter_shock::{DampingRatio, Peaked, Pulse, Pulses, Response, Shape, Suspension, VelocityShock, VelocityShocks};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

fn mount(omega: f64, zeta: f64) -> Suspension {
    Suspension::new(omega, DampingRatio::new(zeta).expect("damping")).expect("mount")
}

/// A section that keeps its own sinusoids.
#[derive(Debug, Clone)]
struct Own {
    length: f64,
    delta_v: f64,
    acceleration: [f64; 2],
    sines: Vec<Sine>,
}

impl Own {
    fn base(&self, t: f64) -> f64 {
        let [from, to] = self.acceleration;
        from + (to - from) * (t / self.length)
            + self.sines.iter().map(|s| s.amplitude * (s.phase + s.rate * t).sin()).sum::<f64>()
    }
    fn fastest(&self) -> f64 {
        self.sines.iter().fold(0.0, |most, s| s.rate.max(most))
    }
}

fn history(list: &[Own]) -> Pulses {
    let sections = list.iter().map(|own| Section {
        acceleration: own.acceleration,
        sines: &own.sines,
        ..Section::shock(0.0, own.length, own.delta_v)
    });
    Pulses::of_sections(sections).expect("sections")
}

/// Returns the largest |ωz| and |A/ω| at the ends of steps within the sections, and how much a value may rise between
/// two ends.
fn by_steps(list: &[Own], omega: f64, zeta: f64) -> [f64; 2] {
    let (mut x, mut v, mut most) = (0.0_f64, 0.0_f64, [0.0_f64; 2]);
    for own in list {
        v -= own.delta_v;
        let swing = own.length * omega.max(own.fastest()) * (1.0 + zeta);
        let steps = (swing / 0.01).ceil().clamp(64.0, 1e6);
        let h = own.length / steps;
        let slope = |t: f64, x: f64, v: f64| (v, -own.base(t) - 2.0 * zeta * omega * v - omega * omega * x);
        let mut note = |x: f64, v: f64| {
            most[0] = most[0].max((omega * x).abs());
            most[1] = most[1].max((2.0 * zeta * v + omega * x).abs());
        };
        note(x, v);
        if own.length == 0.0 {
            continue;
        }
        for i in 0..steps as u32 {
            let t = f64::from(i) * h;
            let (a, b) = slope(t, x, v);
            let (c, d) = slope(t + 0.5 * h, x + 0.5 * h * a, v + 0.5 * h * b);
            let (e, f) = slope(t + 0.5 * h, x + 0.5 * h * c, v + 0.5 * h * d);
            let (g, k) = slope(t + h, x + h * e, v + h * f);
            x += h / 6.0 * (a + 2.0 * (c + e) + g);
            v += h / 6.0 * (b + 2.0 * (d + f) + k);
            note(x, v);
        }
    }
    most
}

fn any_section() -> impl Strategy<Value = Own> {
    let sine = (-1.0..1.0_f64, -1.0..2.3_f64, -4.0..4.0_f64).prop_map(|(amplitude, decade, phase)| Sine {
        amplitude,
        rate: 10f64.powf(decade),
        phase,
    });
    let length = prop_oneof![Just(0.0), 1e-3..1.0_f64, 1.0..8.0_f64];
    (length, prop_oneof![Just(0.0), -1.0..1.0_f64], [-1.0..1.0_f64, -1.0..1.0_f64], prop::collection::vec(sine, 0..4))
        .prop_map(|(length, delta_v, acceleration, sines)| Own { length, delta_v, acceleration, sines })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    /// Peaks within the history, of any rates, slow ones against the component and fast ones. Steps of 0.01 rad err by
    /// 1e-10 in all, and a peak between two of them rises by (0.01)²/8 of the acceleration of the value, at most twenty
    /// times the largest here; damping that follows a short line of length L adds 2ζ |Δa| L/(8·64²), 1.3e-4 of its size at most.
    #[test]
    fn peaks_are_those_of_small_steps(
        list in prop::collection::vec(any_section(), 1..5),
        decade in -0.5..1.5_f64,
        zeta in prop_oneof![Just(0.0), 0.0..0.2_f64, 0.2..2.0_f64],
    ) {
        let omega = 10f64.powf(decade);
        let part = mount(omega, zeta);
        let pulses = history(&list);
        let size: f64 = list.iter().map(|own| {
            own.delta_v.abs() + own.length * (own.acceleration.map(f64::abs).iter().sum::<f64>()
                + own.sines.iter().map(|s| s.amplitude.abs()).sum::<f64>())
        }).sum();
        let stepped = by_steps(&list, omega, zeta);
        for (peaked, stepped) in [Peaked::PseudoVelocity, Peaked::AccelerationOverOmega].into_iter().zip(stepped) {
            let got = pulses.peak_within(&part, peaked, 0.0).map_or(0.0, |peak| peak.value.abs());
            prop_assert!(got >= stepped - 1e-8 * size, "{peaked:?}: {got} below {stepped}");
            prop_assert!(got <= stepped + 2.5e-4 * (size + stepped), "{peaked:?}: {got} above {stepped}");
            let whole = pulses.peak_above(&part, peaked, 0.0).map_or(0.0, |peak| peak.value.abs());
            prop_assert!(whole >= got, "{peaked:?}: {whole} with the ring-down, {got} without");
        }
    }

    /// Compares one long sinusoid with the same cut into parts of half a circle at most.
    #[test]
    fn a_long_sinusoid_is_the_sum_of_its_parts(
        turned in 3.0..400.0_f64,
        rate_decade in -2.0..2.0_f64,
        zeta in prop_oneof![Just(0.0), 0.0..0.2_f64, 0.2..2.0_f64],
        phase in -3.0..3.0_f64,
    ) {
        let rate = 10f64.powf(rate_decade);
        let part = mount(1.0, zeta);
        let sine = |phase| vec![Sine { amplitude: 1.0, rate, phase }];
        let own = |length, phase| Own { length, delta_v: 0.0, acceleration: [0.0; 2], sines: sine(phase) };
        let pieces = (turned / PI).ceil();
        let piece = turned / pieces;
        let whole = history(&[own(turned / rate, phase)]).respond(&part);
        let parts: Vec<_> = (0..pieces as u32).map(|i| own(piece / rate, phase + f64::from(i) * piece)).collect();
        let parts = history(&parts).respond(&part);
        let [a, b] = [whole, parts].map(|r| [r.pseudo_velocity().magnitude(), r.acceleration_over_omega().magnitude()]);
        for (a, b) in a.into_iter().zip(b) {
            // A thousand roundings of what the sinusoid would add up to at resonance.
            prop_assert!((a - b).abs() <= 1e-13 * (b + turned / rate), "{a}, in parts {b}");
        }
    }
}

fn same(one: &Response, other: &Response, name: &str) {
    for (a, b) in [
        (one.pseudo_velocity(), other.pseudo_velocity()),
        (one.acceleration_over_omega(), other.acceleration_over_omega()),
        (one.relative_velocity, other.relative_velocity),
    ] {
        for (a, b) in [(a.positive.value, b.positive.value), (a.negative.value, b.negative.value)] {
            assert!((a - b).abs() <= 1e-13, "{name}: {a}, not {b}");
        }
    }
}

#[test]
fn pulses_and_shocks_as_sections() {
    let d = 0.7;
    let own = |length, acceleration, sines: Vec<Sine>| Own { length, delta_v: 0.0, acceleration, sines };
    let sine = |amplitude, rate, phase| Sine { amplitude, rate, phase };
    for (omega, zeta) in [(0.01, 0.05), (2.0, 0.0), (PI / d, 0.0), (300.0, 0.3), (5.0, 1.0), (5.0, 4.0)] {
        let part = mount(omega, zeta);
        let shapes = [
            (Shape::HalfSine, vec![own(d, [0.0; 2], vec![sine(1.0, PI / d, 0.0)])]),
            (Shape::Haversine, vec![own(d, [0.5; 2], vec![sine(0.5, TAU / d, -FRAC_PI_2)])]),
            (Shape::Triangle, vec![own(0.5 * d, [0.0, 1.0], vec![]), own(0.5 * d, [1.0, 0.0], vec![])]),
            (Shape::Rectangle, vec![own(d, [1.0; 2], vec![])]),
        ];
        for (shape, sections) in shapes {
            let pulse = Pulse { shape, amplitude: 1.0, duration: d, start: 0.0 };
            let pulse = Pulses::new(&[pulse]).expect("a pulse").respond(&part);
            same(&history(&sections).respond(&part), &pulse, &format!("{shape:?} at {omega}, {zeta}"));
        }
        let shocks = [(0.0, 1.0), (0.3, -0.4), (1.1, 0.2)];
        let shocks = shocks.map(|(time, delta_v)| VelocityShock { time, delta_v });
        let sections: Vec<_> = [(0.3, 1.0), (1.1 - 0.3, -0.4), (0.0, 0.2)]
            .map(|(length, delta_v)| Own { length, delta_v, acceleration: [0.0; 2], sines: vec![] })
            .to_vec();
        let shocks = VelocityShocks::new(shocks.to_vec()).expect("shocks").respond(&part);
        same(&history(&sections).respond(&part), &shocks, &format!("shocks at {omega}, {zeta}"));
    }
}

#[test]
fn sections_of_no_sense_are_refused() {
    let good = Section::shock(0.0, 1.0, 0.0);
    let wrong = [Sine { amplitude: 1.0, rate: 0.0, phase: 0.0 }];
    for (section, said) in [
        (Section { length: -1.0, ..good }, "length"),
        (Section { length: f64::INFINITY, ..good }, "length"),
        (Section { delta_v: f64::NAN, ..good }, "delta v"),
        (Section { acceleration: [0.0, f64::INFINITY], ..good }, "acceleration"),
        (Section { sines: &wrong, ..good }, "rate"),
    ] {
        let refused = Pulses::of_sections([good, section]).expect_err(said).to_string();
        assert!(refused.contains(said) && refused.contains('2'), "{refused}");
    }
    assert!(Pulses::of_sections([]).is_err());
}
