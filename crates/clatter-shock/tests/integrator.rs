//! Pulses of every shape against a Runge–Kutta integrator of order 5 (`ode_solvers`, DOPRI5) at tight tolerance.

use clatter_shock::{DampingRatio, Pulse, Pulses, Shape, State, Suspension, VelocityShock, VelocityShocks};
use ode_solvers::dop_shared::OutputType;
use ode_solvers::{Dopri5, System, Vector2};
use std::f64::consts::{PI, TAU};

const SHAPES: [Shape; 7] = [
    Shape::HalfSine,
    Shape::Haversine,
    Shape::Triangle,
    Shape::InitialPeakSawtooth,
    Shape::TerminalPeakSawtooth,
    Shape::Rectangle,
    Shape::Trapezoid { ramp: 0.2 },
];

/// Returns the textbook formulas, from inside the open interval of the pulse.
fn acceleration(p: &Pulse, t: f64) -> f64 {
    let s = (t - p.start) / p.duration;
    if !(0.0..=1.0).contains(&s) {
        return 0.0;
    }
    p.amplitude
        * match p.shape {
            Shape::HalfSine => (PI * s).sin(),
            Shape::Haversine => 0.5 - 0.5 * (TAU * s).cos(),
            Shape::Triangle => 1.0 - (2.0 * s - 1.0).abs(),
            Shape::InitialPeakSawtooth => 1.0 - s,
            Shape::TerminalPeakSawtooth => s,
            Shape::Rectangle => 1.0,
            Shape::Trapezoid { ramp } => (s / ramp).min((1.0 - s) / ramp).min(1.0),
        }
}

struct Mount<'a> {
    pulses: &'a [Pulse],
    omega: f64,
    zeta: f64,
    /// Accelerations are evaluated within this interval alone, so that a jump at its end stays out.
    within: (f64, f64),
}

impl System<f64, Vector2<f64>> for Mount<'_> {
    fn system(&self, t: f64, state: &Vector2<f64>, change: &mut Vector2<f64>) {
        let margin = 1e-12 * (self.within.1 - self.within.0);
        let t = t.clamp(self.within.0 + margin, self.within.1 - margin);
        let base: f64 = self.pulses.iter().map(|p| acceleration(p, t)).sum();
        change[0] = state[1];
        change[1] = -base - 2.0 * self.zeta * self.omega * state[1] - self.omega * self.omega * state[0];
    }
}

/// The results of the integrator: largest |z| and |A|, and z and z′ at each wanted time.
struct Found {
    peaks: [f64; 2],
    states: Vec<Vector2<f64>>,
}

/// Integrates from rest through jumps of the base's velocity and pulses, in steps of 0.005/ω at most; `stops` are the
/// times of the wanted states, and the last of them the end. Between two steps values are those of the cubic of values
/// and slopes.
fn integrate(pulses: &[Pulse], shocks: &[VelocityShock], [omega, zeta]: [f64; 2], stops: &[f64]) -> Found {
    let mut cuts = stops.to_vec();
    for p in pulses {
        for s in [0.0, 0.2, 0.5, 0.8, 1.0] {
            cuts.push(p.start + s * p.duration);
        }
    }
    cuts.extend(shocks.iter().map(|s| s.time));
    cuts.sort_by(f64::total_cmp);
    cuts.dedup_by(|a, b| *a - *b < 1e-13);
    let values = |s: &Vector2<f64>| [s[0], 2.0 * zeta * omega * s[1] + omega * omega * s[0]];
    let (mut state, mut found) = (Vector2::new(0.0, 0.0), Found { peaks: [0.0; 2], states: Vec::new() });
    let mut jump = |state: &mut Vector2<f64>, at: f64| {
        for shock in shocks.iter().filter(|s| (s.time - at).abs() < 1e-13) {
            state[1] -= shock.delta_v;
        }
        for (peak, value) in found.peaks.iter_mut().zip(values(state)) {
            *peak = peak.max(value.abs());
        }
        if stops.iter().any(|stop| (stop - at).abs() < 1e-13) {
            found.states.push(*state);
        }
    };
    jump(&mut state, cuts[0]);
    let mut between = [0.0_f64; 2];
    for cut in cuts.windows(2) {
        let mount = Mount { pulses, omega, zeta, within: (cut[0], cut[1]) };
        let step = (cut[1] - cut[0]) / ((cut[1] - cut[0]) * omega / 0.005).ceil();
        let slopes = |t: f64, s: &Vector2<f64>| {
            let mut change = Vector2::new(0.0, 0.0);
            Mount { pulses, omega, zeta, within: (cut[0], cut[1]) }.system(t, s, &mut change);
            values(&change)
        };
        // The defaults of `Dopri5::new`, but for the search for stiffness, which such tolerances set off.
        #[rustfmt::skip]
        let mut solver = Dopri5::from_param(
            mount, cut[0], cut[1], step, state, 1e-11, 1e-12, 0.9, 0.04, 0.2, 10.0, step, step, 1_000_000, u32::MAX, OutputType::Sparse,
        );
        solver.integrate().expect("integration");
        let (times, states) = (solver.x_out(), solver.y_out());
        for i in 1..states.len() {
            let h = times[i] - times[i - 1];
            let (from, to) = (values(&states[i - 1]), values(&states[i]));
            let (out, into) = (slopes(times[i - 1], &states[i - 1]), slopes(times[i], &states[i]));
            for k in 0..2 {
                between[k] = between[k].max(largest_of_cubic([from[k], to[k]], [h * out[k], h * into[k]]));
            }
        }
        state = *states.last().expect("states");
        for (peak, value) in between.iter_mut().zip(values(&state)) {
            *peak = peak.max(value.abs());
        }
        jump(&mut state, cut[1]);
    }
    for (peak, between) in found.peaks.iter_mut().zip(between) {
        *peak = peak.max(between);
    }
    found
}

/// Returns the largest absolute value over [0, 1] of the cubic with these values and slopes at its ends.
fn largest_of_cubic([a, b]: [f64; 2], [m, n]: [f64; 2]) -> f64 {
    let (third, second) = (m + n - 2.0 * (b - a), 3.0 * (b - a) - 2.0 * m - n);
    let value = |t: f64| (a + t * (m + t * (second + t * third))).abs();
    let mut most = a.abs().max(b.abs());
    if m * n < 0.0 {
        // One turning point: Newton's iteration from the chord of the slopes.
        let mut t = m / (m - n);
        for _ in 0..4 {
            t -= (m + t * (2.0 * second + 3.0 * t * third)) / (2.0 * second + 6.0 * t * third);
        }
        most = most.max(value(t.clamp(0.0, 1.0)));
    }
    most
}

/// DOPRI5 keeps about 1e-10 of the largest over some hundred steps a swing; the cubic adds (0.005)⁴/384 of the fourth
/// derivative, which at ζ = 2.5 is 5⁴ times a velocity: 1e-9.
const CLOSE: f64 = 1.1e-9;

fn hold(name: &str, got: [f64; 2], want: [f64; 2]) {
    for (what, (got, want)) in ["z", "A"].iter().zip(got.into_iter().zip(want)) {
        assert!((got / want - 1.0).abs() <= CLOSE, "{name}: peak {what} {got}, not {want}");
    }
}

/// Checks z and z′; their errors are relative to the peak.
fn hold_state(name: &str, omega: f64, got: State, want: &Vector2<f64>, peak: f64) {
    let off = (omega * (got.displacement - want[0])).hypot(got.velocity - want[1]);
    assert!(off <= 1e-9 * omega * peak, "{name}: {got:?}, not {want:?}");
}

#[test]
fn overlapping_pulses_of_every_shape() {
    for (i, &shape) in SHAPES.iter().enumerate() {
        for zeta in [0.0, 0.05, 0.7, 1.0, 2.5] {
            let other = SHAPES[(i + 3) % SHAPES.len()];
            let pulses = [
                Pulse { shape, amplitude: 1.0, duration: 0.8, start: 0.1 },
                Pulse { shape: other, amplitude: -1.6, duration: 0.5, start: 0.6 },
                Pulse { shape, amplitude: 0.9, duration: 1.1, start: 1.7 },
            ];
            for omega in [0.7, TAU, 25.0] {
                let suspension = Suspension::new(omega, DampingRatio::new(zeta).expect("damping")).expect("mount");
                let exact = Pulses::new(&pulses).expect("pulses");
                let got = exact.respond(&suspension);
                let want = integrate(&pulses, &[], [omega, zeta], &[1.7 + 1.1, 2.8 + 6.0 / omega]);
                let name = format!("{shape:?}, damping {zeta}, omega {omega}");
                hold(&name, [got.relative_displacement.magnitude(), got.absolute_acceleration.magnitude()], want.peaks);
                hold_state(&name, omega, exact.state_at_end(&suspension), &want.states[0], want.peaks[0]);
            }
        }
    }
}

#[test]
fn trains_of_velocity_shocks() {
    // Alternating and not, two of them at one instant.
    let shocks = [(0.1, 1.0), (0.45, -1.7), (0.9, 0.6), (0.9, 0.8), (1.55, -0.4), (1.7, 0.9), (2.6, -1.1)]
        .map(|(time, delta_v)| VelocityShock { time, delta_v });
    for zeta in [0.0, 0.05, 0.7, 1.0, 2.5] {
        for omega in [0.7, TAU, 25.0] {
            let suspension = Suspension::new(omega, DampingRatio::new(zeta).expect("damping")).expect("mount");
            let got = VelocityShocks::new(shocks.to_vec()).expect("shocks").respond(&suspension);
            let mut stops: Vec<f64> = shocks.iter().map(|s| s.time).collect();
            stops.dedup();
            stops.push(2.6 + 6.0 / omega);
            let want = integrate(&[], &shocks, [omega, zeta], &stops);
            let name = format!("damping {zeta}, omega {omega}");
            hold(&name, [got.relative_displacement.magnitude(), got.absolute_acceleration.magnitude()], want.peaks);
            let (mut state, mut last) = (State::default(), stops[0]);
            for (&stop, want) in stops.iter().zip(&want.states) {
                state = suspension.free(state, stop - last);
                for shock in shocks.iter().filter(|s| (s.time - stop).abs() < 1e-13) {
                    state.velocity -= shock.delta_v;
                }
                hold_state(&format!("{name}, {stop}"), omega, state, want, got.relative_displacement.magnitude());
                last = stop;
            }
            assert_eq!(want.states.len(), stops.len(), "{name}");
        }
    }
}
