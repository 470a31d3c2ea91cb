//! The time for which a body with little energy can still move: the proof behind [`Stop::AtRest`](crate::Stop::AtRest).
//!
//! Take a small-tilt motion under gravity g with energy E per unit mass, e < 1, effective masses
//! `m_i = ρ²/(ρ² + L_i²)` and m the smaller of the two. E bounds every velocity of an end by `V = √(2E/m)` and every
//! height by `E L/(g L_min)`.
//!
//! *q ≥ 0: a strike never lifts the other end.* So each end touches within `τ = (V + √(V² + 2 E L/L_min))/g`. Look
//! at the time 2τ, and suppose that all strikes in it approach slower than δ. At its middle both ends have touched and
//! will touch again; between touches an end only ever loses velocity, so all velocities are in (−δ, δ), all heights
//! below δ²/2g, hence the energy is at most `C δ²` with `C = 1 + 2 ρ²/L²`. In other words, if E′ is the energy after
//! 2τ, one strike was at least `√(E′/C)` fast, and it took `½ m (1 − e²)` of its square:
//!
//! ```text
//! E ≥ (1 + κ) E′,   κ = m (1 − e²)/(2C)
//! ```
//!
//! The times 2τ shrink like √E, so that the rest of the motion takes at most `2τ(E)/(1 − 1/√(1 + κ))`. An end that lies
//! still is the limit of ever more, ever slower strikes, and changes nothing. This holds for any pattern of strikes.
//!
//! *q < 0: strikes lift the other end,* by `p = max(−q_a, −q_b) < 1` of their own jump. Momentum of the other end
//! limits how often: `v_a(t) = v_a(0) − (1 − p) g t + p (v_b(t) − v_b(0))` until a touches, and likewise for b. The
//! same steps give `τ = V (6 + √((1 − p) m L/L_min))/((1 − p) g)`, velocities below 5δ at any time with two touches of
//! both ends around it, heights below `(11 δ)²/(2 (1 − p) g)`, so a window of 4τ and `C = 12.5 + 50 ρ²/L² + 60.5/(1 −
//! p)`. The bound is coarse, but each factor costs only a few more strikes.

use crate::profile::Profile;

/// The constants of the bound for one body and restitution.
#[derive(Debug, Clone, Copy)]
pub(super) struct Settling {
    arm: [f64; 2],
    gyration: f64,
    gravity: f64,
    mass: f64,
    /// Time in which a strike as fast as `√(E′/C)` must happen, over √E.
    window_per_root: f64,
    /// `C`, the energy over δ² when all strikes of a window are slower than δ.
    #[cfg(test)]
    slow: f64,
    /// κ: a window takes the share κ/(1 + κ) of the energy at least.
    kappa: f64,
}

impl Settling {
    /// Creates the bound. `slack` ≥ 0 widens the case q < 0 for a motion whose inertia ratios are only nearly those of
    /// a level body.
    pub(super) fn new(body: &Profile, e: f64, gravity: f64, slack: f64) -> Self {
        let arm = body.arms_m();
        let length = body.length_m();
        let shortest = length / arm[0].min(arm[1]);
        let gyration = body.gyration_m();
        let longest = arm[0].max(arm[1]);
        let mass = gyration * gyration / body.inertia(longest);
        let [qa, qb] = body.inertia_ratios();
        let ratio = (gyration / length).powi(2);
        let lift = (slack - qa).max(slack - qb).max(0.0);
        let root_v = (2.0 / mass).sqrt(); // V/√E
        let (window, c) = if lift > 0.0 {
            let fall = 1.0 - lift;
            let tau = root_v * (6.0 + (fall * mass * shortest).sqrt()) / (fall * gravity);
            (4.0 * tau, 12.5 + 50.0 * ratio + 60.5 / fall)
        } else {
            (2.0 * (root_v + (root_v * root_v + 2.0 * shortest).sqrt()) / gravity, 1.0 + 2.0 * ratio)
        };
        Self {
            arm,
            gyration,
            gravity,
            mass,
            window_per_root: window,
            #[cfg(test)]
            slow: c,
            kappa: mass * (1.0 - e) * (1.0 + e) / (2.0 * c),
        }
    }
    /// Returns the sum of all windows over the first, `1/(1 − 1/√(1+κ))` without cancellation; infinite for e = 1 or
    /// massless ends, which never settle.
    fn windows(&self) -> f64 {
        let root = (1.0 + self.kappa).sqrt();
        root * (root + 1.0) / self.kappa
    }
    /// Returns the energy per unit mass for heights and velocities of the ends.
    pub(super) fn energy(&self, h: [f64; 2], v: [f64; 2]) -> f64 {
        let [a, b] = self.arm;
        let length = a + b;
        let center = (b * v[0] + a * v[1]) / length;
        let spin = self.gyration * (v[1] - v[0]) / length;
        0.5 * (center * center + spin * spin) + self.gravity * (b * h[0] + a * h[1]) / length
    }
    /// Returns bounds on the remaining time and on the end velocities for this energy.
    pub(super) fn remaining(&self, energy: f64) -> (f64, f64) {
        (self.window_per_root * self.windows() * energy.sqrt(), (2.0 * energy / self.mass).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Model, Motion, Scene, Stop};

    const G: f64 = 9.81;

    /// Bodies with q from −0.9 to 0.9, on center and off, and restitutions from 0 to 0.9.
    fn cases() -> impl Iterator<Item = (Profile, f64)> {
        let arms = [[0.07, 0.07], [0.05, 0.09], [0.2, 0.06]];
        arms.into_iter().flat_map(|[a, b]| {
            [0.02, 0.05, 0.07, 0.12, 0.3].into_iter().flat_map(move |rho| {
                let body = Profile::off_center(a, b, rho).expect("a body");
                [0.0, 0.1, 0.3, 0.6, 0.9].map(|e| (body, e))
            })
        })
    }

    fn settling(body: &Profile, e: f64) -> Settling {
        Settling::new(body, e, G, 0.0)
    }

    /// Returns bounds on velocities and heights of a window whose strikes are slower than 1, over 1 and over 1/2g.
    fn slow_box(body: &Profile) -> (f64, f64) {
        let lift = body.inertia_ratios().into_iter().fold(0.0, |p: f64, q| p.max(-q));
        if lift > 0.0 { (5.0, 121.0 / (1.0 - lift)) } else { (1.0, 1.0) }
    }

    /// κ is the loss of energy by the slowest strike that a window must have: the impact law on the lighter end.
    #[test]
    fn the_strike_of_a_window_takes_kappa_of_the_energy_after_it() {
        for (body, e) in cases() {
            let s = settling(&body, e);
            let q = body.inertia_ratios();
            let speed = 1.0 / s.slow.sqrt(); // for an energy of 1
            let taken = [0, 1].map(|i| {
                let mut before = [0.3; 2];
                before[i] = -speed;
                let mut after = before;
                after[i] = e * speed;
                after[1 - i] -= q[i] * (1.0 + e) * speed;
                s.energy([0.0; 2], before) - s.energy([0.0; 2], after)
            });
            let least = taken[0].min(taken[1]);
            assert!((least / s.kappa - 1.0).abs() < 1e-11, "{body:?} e {e}: {least}, κ = {}", s.kappa);
        }
    }
    /// Checks that C is a bound, by all corners of the box, and for q ≥ 0 within a factor of 2.
    #[test]
    fn no_slow_motion_has_more_energy_than_the_box() {
        for (body, e) in cases() {
            let s = settling(&body, e);
            let (v, h) = slow_box(&body);
            let most =
                [[-v, -v], [-v, v], [v, v]].map(|v| s.energy([0.5 * h / G; 2], v)).into_iter().fold(0.0, f64::max);
            assert!(most <= s.slow && s.slow <= 2.0 * most, "{body:?}: {most} of {}", s.slow);
        }
    }
    /// The windows shrink by √(1 + κ) each.
    #[test]
    fn the_windows_are_summed() {
        for (body, e) in cases() {
            let s = settling(&body, e);
            let sum: f64 = (0..200_000).map(|k| (1.0 + s.kappa).powf(-0.5 * f64::from(k))).sum();
            // This is the sum of the terms after 200 000.
            let rest = (1.0 + s.kappa).powf(-100_000.0);
            assert!((sum / s.windows() + rest - 1.0).abs() < 1e-9, "{body:?} e {e}: {sum} {}", s.windows());
        }
    }

    /// Returns drops until rest, low enough that the body stays near the ground, high enough for strikes of every
    /// pattern.
    fn drops(body: Profile, e: f64) -> impl Iterator<Item = Motion> {
        [(0.0, 0.0), (0.3, 0.0), (3.0, 0.0), (0.3, 6.0), (3.0, -5.0)].into_iter().map(move |(tilt, spin)| {
            let scene = Scene::new(body, e, 1.5, tilt, G).and_then(|s| s.with_spin(spin)).expect("a drop");
            scene.fly(Model::Ballistic).expect("a motion")
        })
    }

    /// In half a window both ends touch, in a whole one the energy falls by 1 + κ, and all is over within the bound.
    #[test]
    fn flights_keep_every_bound() {
        let mut seen = 0;
        for (body, e) in cases() {
            let s = settling(&body, e);
            for flight in drops(body, e) {
                let Stop::AtRest { time_s: rest, .. } = flight.stop else {
                    panic!("{body:?} e {e}: {:?}", flight.stop)
                };
                let energies: Vec<_> = flight.strikes.iter().map(|k| s.energy(k.height_m, k.velocity_m_s)).collect();
                // Fastest approach from each strike on.
                let mut fastest_from: Vec<f64> = flight.strikes.iter().map(|k| k.approach_m_s.abs()).collect();
                for n in (1..fastest_from.len()).rev() {
                    fastest_from[n - 1] = fastest_from[n - 1].max(fastest_from[n]);
                }
                // The last strikes are too near to rest for the resolution of times.
                for (n, strike) in flight.strikes.iter().enumerate().filter(|(_, k)| rest - k.time_s > 1e-9 * rest) {
                    let window = s.window_per_root * energies[n].sqrt();
                    let (left, fastest) = s.remaining(energies[n]);
                    assert!(
                        rest - strike.time_s <= left,
                        "{body:?} e {e}, strike {n}: {} of {left}",
                        rest - strike.time_s
                    );
                    let fastest = fastest * (1.0 + 8.0 * f64::EPSILON); // attained at e = 0, to roundings
                    let later = &flight.strikes[n + 1..];
                    assert!(fastest_from.get(n + 1).is_none_or(|v| *v <= fastest), "{body:?} e {e}, strike {n}");
                    let lies = |point: usize| {
                        flight.pivots.iter().any(|p| {
                            p.point == point && p.from_s <= strike.time_s + 0.5 * window && p.until_s >= strike.time_s
                        })
                    };
                    for point in 0..2 {
                        let next = later.iter().find(|k| k.point == point).map_or(rest, |k| k.time_s);
                        assert!(
                            next - strike.time_s <= 0.5 * window || lies(point),
                            "{body:?} e {e}, strike {n}: point {point}"
                        );
                    }
                    let m = later.partition_point(|k| k.time_s < strike.time_s + window);
                    if m < later.len() {
                        let after = energies[n + m];
                        assert!(after * (1.0 + s.kappa) <= energies[n], "{body:?} e {e}, strike {n}: {after}");
                        seen += 1;
                    }
                }
            }
        }
        assert!(seen > 1000, "{seen} windows");
    }
}
