//! The damage boundary of sampled histories, against that of the pulses they sample and against scaled histories.

use clatter_shock::{
    DamageBoundary, DampingRatio, Error, Frequencies, HistoryBoundary, Limit, Pulses, Quantity, Shape, Suspension,
};
use std::f64::consts::PI;

fn mount(zeta: f64) -> Suspension {
    Suspension::from_hz(100.0, DampingRatio::new(zeta).expect("damping")).expect("mount")
}

const LIMITS: [Limit; 2] = [Limit::Acceleration(300.0), Limit::RattleSpace(2e-3)];

fn half_sine(n: u32) -> Vec<(f64, f64)> {
    (0..=n).map(|i| f64::from(i) / f64::from(n)).map(|t| (0.5 + 0.011 * t, 70.0 * (PI * t).sin())).collect()
}

/// Straight lines between n samples of a half-sine are off by π²/8n² of its peak at most: 4.5e-6 for 500 of them, the
/// knee by as much over its own accuracy.
#[test]
fn half_sines_have_the_boundary_of_the_pulse() {
    for zeta in [0.0, 0.05, 0.3] {
        for limit in LIMITS {
            let exact = DamageBoundary::new(mount(zeta), limit, Shape::HalfSine).expect("boundary");
            let got = HistoryBoundary::new(mount(zeta), limit, &half_sine(500)).expect("boundary");
            let name = format!("damping {zeta}, {limit:?}");
            let close = |a: f64, b: f64, share: f64| assert!((a / b - 1.0).abs() <= share, "{name}: {a}, not {b}");
            close(got.critical_velocity_change().expect("one"), exact.critical_velocity_change(), 1e-14);
            close(got.critical_acceleration(), exact.critical_acceleration(), 1e-5);
            // The largest amplification is flat: 1e-5 of it is 3e-3 of the duration.
            close(got.knee_velocity_change().expect("one"), exact.knee_velocity_change(), 3e-3);
            for (v, a) in got.curve(12).expect("curve") {
                let margin = exact.margin(a, v / (a * Shape::HalfSine.area())).expect("margin");
                assert!(margin.ratio().abs() <= 1e-5, "{name}: {margin:?} at {v} m/s, {a} m/s²");
            }
        }
    }
}

#[test]
fn rectangles_have_the_boundary_of_the_pulse() {
    let rectangle: Vec<(f64, f64)> = (0..=40_u32).map(|i| (1e-4 * f64::from(i), -20.0)).collect();
    for zeta in [0.0, 0.05, 0.5, 1.5] {
        for limit in LIMITS {
            let exact = DamageBoundary::new(mount(zeta), limit, Shape::Rectangle).expect("boundary");
            let got = HistoryBoundary::new(mount(zeta), limit, &rectangle).expect("boundary");
            let name = format!("damping {zeta}, {limit:?}");
            // The accuracies stated.
            let close = |a: f64, b: f64, share: f64| assert!((a / b - 1.0).abs() <= share, "{name}: {a}, not {b}");
            close(got.critical_velocity_change().expect("one"), exact.critical_velocity_change(), 1e-14);
            close(got.critical_acceleration(), exact.critical_acceleration(), 1e-9);
            let (knee, want) = (got.knee_velocity_change().expect("one"), exact.knee_velocity_change());
            assert!(
                knee.to_bits() == want.to_bits() || (knee / want - 1.0).abs() <= 1e-5,
                "{name}: knee {knee}, not {want}"
            );
            for (v, a) in got.curve(12).expect("curve") {
                let margin = exact.margin(a, v / a).expect("margin");
                assert!(margin.ratio().abs() <= 1e-10, "{name}: {margin:?} at {v} m/s, {a} m/s²");
            }
        }
    }
}

/// Each point of the curve is a history, scaled, that just reaches the limit.
#[test]
fn points_of_the_curve_are_histories_at_the_limit() {
    let points: Vec<(f64, f64)> = [0.0, 3.0, -1.0, 8.0, 2.0, -4.0, 0.0]
        .into_iter()
        .zip(0_u32..)
        .map(|(a, i)| (2e-3 * f64::from(i * (i + 3)), a))
        .collect();
    let (peak, change) = (8.0, points.windows(2).map(|w| 0.5 * (w[1].0 - w[0].0) * (w[0].1 + w[1].1)).sum::<f64>());
    for zeta in [0.0, 0.1, 2.0] {
        for limit in LIMITS {
            let boundary = HistoryBoundary::new(mount(zeta), limit, &points).expect("boundary");
            for (v, a) in boundary.curve(15).expect("curve") {
                let c = a / peak;
                let s = v / (c * f64::abs(change));
                let scaled: Vec<(f64, f64)> = points.iter().map(|(t, x)| (s * t, c * x)).collect();
                let response = Pulses::piecewise_linear(&scaled).expect("history").respond(&mount(zeta));
                let margin = limit.margin(&response).expect("margin");
                assert!(margin.ratio().abs() <= 1e-10, "damping {zeta}, {limit:?}: {margin:?} at {s} and {c}");
                assert!(a >= boundary.critical_acceleration() * (1.0 - 1e-9), "damping {zeta}, {limit:?}: {a}");
            }
        }
    }
}

#[test]
fn a_history_without_velocity_change_is_told() {
    let points: Vec<(f64, f64)> =
        (0..=200_u32).map(|i| (1e-4 * f64::from(i), (PI * f64::from(i) / 50.0).sin())).collect();
    let boundary = HistoryBoundary::new(mount(0.05), Limit::Acceleration(300.0), &points).expect("boundary");
    assert_eq!((boundary.critical_velocity_change(), boundary.knee_velocity_change()), (None, None));
    assert_eq!(boundary.curve(10), Err(Error::NoVelocityChange));
    // The largest of many parts, a ten-thousandth of an octave apart: flat to 1e-8 there.
    let hz = Frequencies::per_octave(80.0, 120.0, 10_000.0).expect("frequencies");
    let history = Pulses::piecewise_linear(&points).expect("history");
    let spectrum = history.spectrum(&hz, mount(0.05).damping(), Quantity::AbsoluteAcceleration);
    let most = spectrum.maximax.iter().fold(0.0_f64, |m, a| m.max(*a));
    let off = boundary.critical_acceleration() * most / 300.0 - 1.0;
    assert!(off.abs() < 1e-7, "{off:e}");
}

#[test]
fn histories_that_are_none_are_refused() {
    let of = |limit, points: &[(f64, f64)]| {
        HistoryBoundary::new(mount(0.05), limit, points).expect_err("refused").to_string()
    };
    let good = [(0.0, 1.0), (1.0, 1.0)];
    for (got, message) in [
        (of(Limit::Acceleration(-1.0), &good), "limit of acceleration = -1.0 is not finite and > 0"),
        (of(LIMITS[0], &good[..1]), "the history has one point; it needs two at least"),
        (of(LIMITS[0], &[(0.0, 0.0), (1.0, 0.0)]), "largest acceleration of the history = 0.0 is not finite and > 0"),
        (of(LIMITS[0], &[(0.0, 0.0), (1.0, f64::NAN)]), "history, entry 2: acceleration = NaN is not finite"),
    ] {
        assert_eq!(got, message);
    }
    let boundary = HistoryBoundary::new(mount(0.05), LIMITS[0], &good).expect("boundary");
    assert_eq!(boundary.curve(1), Err(Error::Points("the curve", 1)));
}
