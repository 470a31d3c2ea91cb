//! How long a body with little energy can still move: the proof behind [`super::Stop::AtRest`].
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
//! The times 2τ shrink like √E, so all that is left takes at most `2τ(E)/(1 − 1/√(1 + κ))`. An end that lies still is
//! the limit of ever more, ever slower strikes, and changes nothing. This holds for any pattern of strikes.
//!
//! *q < 0: strikes lift the other end,* by `p = max(−q_a, −q_b) < 1` of their own jump. Momentum of the other end limits
//! how often: `v_a(t) = v_a(0) − (1 − p) g t + p (v_b(t) − v_b(0))` until a touches, and likewise for b. The same
//! steps give `τ = V (6 + √((1 − p) m L/L_min))/((1 − p) g)`, velocities below 5δ at any time with two touches of
//! both ends around it, heights below `(11 δ)²/(2 (1 − p) g)`, so a window of 4τ and
//! `C = 12.5 + 50 ρ²/L² + 60.5/(1 − p)`. Coarse, but the price of a factor is a few more strikes.

use super::Body;

/// The constants of the bound for one body and restitution.
#[derive(Debug, Clone, Copy)]
pub(super) struct Settling {
    arm: [f64; 2],
    gyration: f64,
    gravity: f64,
    mass: f64,
    /// Time bound over √E.
    time_per_root: f64,
}

impl Settling {
    /// `slack` ≥ 0 widens the case q < 0 for a motion whose inertia ratios are only nearly those of a level body.
    pub(super) fn new(body: &Body, e: f64, gravity: f64, slack: f64) -> Self {
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
        let kappa = mass * (1.0 - e) * (1.0 + e) / (2.0 * c);
        let root = (1.0 + kappa).sqrt();
        // 1/(1 − 1/√(1+κ)) without cancellation; infinite for e = 1 or massless ends, which never settle.
        Self { arm, gyration, gravity, mass, time_per_root: window * root * (root + 1.0) / kappa }
    }
    /// Energy per unit mass for heights and velocities of the ends.
    pub(super) fn energy(&self, h: [f64; 2], v: [f64; 2]) -> f64 {
        let [a, b] = self.arm;
        let length = a + b;
        let center = (b * v[0] + a * v[1]) / length;
        let spin = self.gyration * (v[1] - v[0]) / length;
        0.5 * (center * center + spin * spin) + self.gravity * (b * h[0] + a * h[1]) / length
    }
    /// Largest time and largest end velocity that this energy leaves.
    pub(super) fn left(&self, energy: f64) -> (f64, f64) {
        (self.time_per_root * energy.sqrt(), (2.0 * energy / self.mass).sqrt())
    }
}
