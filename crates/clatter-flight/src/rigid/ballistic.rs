//! Small tilt with gravity: parabolas between strikes.
//!
//! `h_i(t) = h_i + v_i t − ½ g t²` for both ends, so that each end keeps its own `½ v_i² + g h_i` until the next strike
//! of either. The end i that strikes with velocity u leaves with −e u and gives the other one `q_i (1 + e) u`. The time
//! of fall is the root of a quadratic, taken in the form that adds; the speed at landing is `√(v² + 2 g h)`.
//!
//! # Chatter of one end
//! Alone, an end that leaves with w returns after 2w/g with w and leaves with e w: times and speeds are geometric, and
//! once a shock is negligible the rest is summed exactly. With S = w/(1 − e):
//!
//! ```text
//! time 2S/g,   Δv_other = −2S − q (1+e) S,   Δh_other = v (2S/g) − 2S²/g − 2 q e S²/g
//! ```
//!
//! if the other end provably stays up that long. Then the end lies still (h = v = 0) and is a pivot: the other end
//! falls with `g (1 + q)`, the force on the pivot being `ρ²/(ρ² + L²)` of the weight, positive throughout. When it
//! lands, the train of strikes at that one instant follows from the same rules with a fall of no time.

use super::settling::Settling;
use crate::flight::{After, Flight, Log, SHARE, State, short};
use crate::scene::Scene;

pub(super) fn simulate(scene: &Scene, mut enough: impl FnMut(&Log<2>) -> bool) -> Flight {
    let (e, g) = (scene.e(), scene.gravity_m_s2());
    let q = scene.body().inertia_ratios();
    let length = scene.body().length_m();
    let settling = Settling::new(&scene.body(), e, g, 0.0);
    let scale_s = scene.speed_m_s() / g;
    let mut log = Log::new(scene.time_limit_s(), scene.impact_limit());
    let mut state = State { h: [0.0, scene.height_gap_m()], v: scene.level_velocities() };
    let mut time = Clock::default();
    loop {
        let down = [still(&state, 0), still(&state, 1)];
        let (i, dt) = match down {
            [true, true] => {
                log.at_rest(time.now(), 0.0, 0.0);
                break;
            }
            [true, false] => (1, fall(state.h[1], state.v[1], g * (1.0 + q[0]))),
            [false, true] => (0, fall(state.h[0], state.v[0], g * (1.0 + q[1]))),
            [false, false] => {
                let (ta, tb) = (fall(state.h[0], state.v[0], g), fall(state.h[1], state.v[1], g));
                if ta <= tb { (0, ta) } else { (1, tb) }
            }
        };
        let j = 1 - i;
        let from = time.now();
        time.add(dt);
        if down[j] {
            if dt > 0.0 {
                log.pivot(j, from, time.now(), &After::small(&state, length));
            }
            state.v[i] = landing(state.h[i], state.v[i], g * (1.0 + q[j]));
        } else {
            state.v[i] = landing(state.h[i], state.v[i], g);
            // An end that is not the first to land is above ground: below zero is rounding.
            state.h[j] = (state.h[j] + dt * (state.v[j] - 0.5 * g * dt)).max(0.0);
            state.v[j] -= g * dt;
        }
        state.h[i] = 0.0;
        let u = state.v[i];
        let jump = -(1.0 + e) * u;
        state.v[i] = -e * u;
        state.v[j] -= q[i] * jump;
        let mut delta_v = [0.0; 2];
        (delta_v[i], delta_v[j]) = (jump, -q[i] * jump);
        if !log.strike(i, time.now(), u, delta_v, &After::small(&state, length), &mut enough) {
            break;
        }
        if jump <= SHARE * log.largest_m_s {
            let (left_s, speed) = settling.remaining(settling.energy(state.h, state.v));
            if log.settled(time.now(), scale_s, left_s, (1.0 + e) * speed) {
                break;
            }
            chatter(&mut state, &mut time, &mut log, i, [q[i], e, g]);
        }
    }
    log.flight
}

/// Sums the chatter of end `i` alone, if it is negligible and the other end provably stays up.
fn chatter(state: &mut State, time: &mut Clock, log: &mut Log<2>, i: usize, [q, e, g]: [f64; 3]) {
    let j = 1 - i;
    let s = state.v[i] / (1.0 - e);
    let tau = 2.0 * s / g;
    if !short(tau, time.now(), 0.0) {
        return;
    }
    let kick = q * (1.0 + e) * s;
    let lowest = state.h[j] - tau * (state.v[j].abs() + kick.abs() + 0.5 * g * tau);
    if lowest > 0.0 {
        log.omitted_m_s = log.omitted_m_s.max((1.0 + e) * state.v[i]);
        state.h[j] += tau * (state.v[j] - s - q * e * s);
        state.v[j] -= 2.0 * s + kick;
        (state.h[i], state.v[i]) = (0.0, 0.0);
        time.add(tau);
    }
}

/// Returns whether an end lies on the ground without moving.
fn still(state: &State, i: usize) -> bool {
    state.h[i] == 0.0 && state.v[i] == 0.0
}

/// Returns the time until height h ≥ 0 with velocity v comes to 0 under gravity g > 0: `h + v t − ½ g t² = 0`, t ≥ 0,
/// the later root where h = 0 and v > 0.
fn fall(h: f64, v: f64, g: f64) -> f64 {
    let root = libm::hypot(v, (2.0 * g * h).sqrt());
    if v > 0.0 {
        (v + root) / g
    } else if h == 0.0 {
        0.0
    } else {
        2.0 * h / (root - v)
    }
}

/// Returns the velocity at landing from height h with velocity v.
fn landing(h: f64, v: f64, g: f64) -> f64 {
    -libm::hypot(v, (2.0 * g * h).sqrt())
}

/// Time as a sum of many terms, kept in two words so that 10⁶ small ones add up.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Clock {
    hi: f64,
    lo: f64,
}

impl Clock {
    pub(crate) fn add(&mut self, dt: f64) {
        let sum = self.hi + dt;
        let part = sum - self.hi;
        self.lo += (self.hi - (sum - part)) + (dt - part);
        self.hi = sum;
    }
    pub(crate) fn now(&self) -> f64 {
        self.hi + self.lo
    }
}
