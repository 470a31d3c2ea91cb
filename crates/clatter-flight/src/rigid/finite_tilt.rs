//! Exact planar geometry at any angle.
//!
//! In flight the center follows a parabola and the body turns uniformly, θ = ω t. With σ = −1 at end a, +1 at b,
//!
//! ```text
//! h(t) = h + v t − ½ g t² − σ L [(θ − sin θ) cos φ + (1 − cos θ) sin φ]
//! h″(t) = −g − σ L ω² sin φ(t)
//! ```
//!
//! (for an end of lever arm x and height H over the center in general, `h − x (θ − sin θ) − H (1 − cos θ)` and
//! `−g − ω² H`) written from the state after the last strike, so that a small gap is a sum of terms of its own size. A
//! strike at end i acts at the lever arm x = L cos φ: `Δv_i = −(1 + e) u`, `Δv_j = −q(φ) Δv_i`,
//! `q_i(φ) = (x_a x_b − ρ²)/(x_i² + ρ²)`.
//!
//! # No strike is missed, none taken twice
//! `h″ ≥ −(g + L ω²)`, L the distance of the end, bounds the motion from below: [`roots`](super::roots) advances by
//! steps that are proven free of zeros, so the first touch of either end is the first touch. While the center is higher
//! than L no angle lets the end touch, and the parabola of the center alone gives the step. The end that has just
//! struck starts from exactly zero with its velocity upward, and the first step takes it off the ground for good; a
//! touch without speed is no strike.
//!
//! # One end on the ground
//! Chatter of one end at finite tilt is not exactly geometric, but nearly: with γ = −h″ and S = w/(1 − e), over the
//! time 4S/γ the bounds on ω and φ keep γ within a share d ≤ (1 − e)/4, so each bounce is at most
//! `e √((1+d)/(1−d)) ≤ 1 − 0.7 (1 − e)` of the one before, and all of them fit in that time. Then the end is a pivot
//! (see [`pivot`](super::pivot)) until the other end lands or the turning lifts it.
//!
//! # Both ends near the ground
//! The bound of [`settling`](super::settling) is doubled; it is used where `L ω² ≤ g/1000` and the tilt is below
//! 1/1000, where it would hold with 1.01 in place of 2.

use super::ballistic::Clock;
use super::pivot::{self, Event};
use super::settling::Settling;
use crate::flight::{After, Flight, Log, SHARE, State, short};
use crate::profile::Profile;
use crate::roots::{far_step, first_zero, safe_step};
use crate::scene::Scene;

/// The body in flight, or at the moment of a strike.
#[derive(Debug, Clone, Copy)]
pub(super) struct Airborne {
    pub(super) body: Profile,
    pub(super) gravity: f64,
    /// Heights and vertical velocities of the ends.
    pub(super) ends: State,
    /// sin φ, cos φ.
    pub(super) sin: f64,
    pub(super) cos: f64,
    /// Angular velocity.
    pub(super) spin: f64,
}

/// Returns −1 for end a, +1 for end b.
pub(super) fn sigma(i: usize) -> f64 {
    if i == 0 { -1.0 } else { 1.0 }
}

/// Returns θ − sin θ, to a few roundings of itself.
fn theta_minus_sin(theta: f64, sin: f64) -> f64 {
    if theta.abs() > 0.7 {
        return theta - sin;
    }
    let t2 = theta * theta;
    // The terms of sin by Horner, each factor the ratio of neighbors; the eighth is below 1e-17 of the first at 0.7.
    let mut sum = 1.0;
    for k in [17.0_f64, 15.0, 13.0, 11.0, 9.0, 7.0, 5.0] {
        sum = 1.0 - sum * t2 / (k * (k - 1.0));
    }
    theta * t2 / 6.0 * sum
}

impl Airborne {
    pub(super) fn start(scene: &Scene) -> Self {
        let (sin, cos) = libm::sincos(scene.tilt_rad());
        let (levers, _) = scene.body().levers(sin, cos);
        let ends = State { h: [0.0, scene.height_gap_m()], v: scene.end_velocities(levers) };
        Self { body: scene.body(), gravity: scene.gravity_m_s2(), ends, sin, cos, spin: scene.spin_rad_s() }
    }
    /// Returns the signed lever arms of the ends.
    pub(super) fn levers(&self) -> [f64; 2] {
        self.body.levers(self.sin, self.cos).0
    }
    /// Returns the height, velocity and acceleration of end i after a flight of time t.
    pub(super) fn end(&self, i: usize, t: f64) -> [f64; 3] {
        let (h, v, g, w) = (self.ends.h[i], self.ends.v[i], self.gravity, self.spin);
        if t == 0.0 {
            return [h, v, self.acceleration(i)];
        }
        let [bend, swing, over] = self.bend(i, w * t);
        [h + (t * (v - 0.5 * g * t) - bend), v - g * t - w * swing, -g - w * w * over]
    }
    /// Returns the loss of height of end i by a turn by θ beyond that of its lever arm x, `x (θ − sin θ) + H (1 − cos
    /// θ)` for an end at height H over the center; the loss of lever arm; and the height over the center after the
    /// turn.
    pub(super) fn bend(&self, i: usize, theta: f64) -> [f64; 3] {
        let (half_sin, half_cos) = libm::sincos(0.5 * theta);
        let sin = 2.0 * half_sin * half_cos;
        let versine = 2.0 * half_sin * half_sin;
        let (x, over) = self.body.levers(self.sin, self.cos);
        let (x, over) = (x[i], over[i]);
        [theta_minus_sin(theta, sin) * x + versine * over, versine * x + sin * over, over - versine * over + sin * x]
    }
    pub(super) fn after(&self) -> After {
        After { ends: self.ends, tilt: libm::atan2(self.sin, self.cos), spin: self.spin }
    }
    /// Returns the free vertical acceleration of end i.
    pub(super) fn acceleration(&self, i: usize) -> f64 {
        -self.gravity - self.spin * self.spin * self.body.levers(self.sin, self.cos).1[i]
    }
    /// Returns the height and velocity of the center.
    pub(super) fn center(&self) -> (f64, f64) {
        let [a, b] = self.body.arms_m();
        let State { h, v } = self.ends;
        let d = 0.5 * self.body.thickness_m();
        let on_the_line = |of: [f64; 2]| (b * of[0] + a * of[1]) / (a + b);
        (on_the_line(h) + d * self.cos, on_the_line(v) - d * self.sin * self.spin)
    }
    /// Returns the time after t in which no angle lets end i touch: the center is higher than its distance.
    pub(super) fn clear(&self, i: usize, t: f64) -> f64 {
        let (y, v) = self.center();
        let clear = y + t * (v - 0.5 * self.gravity * t) - self.body.radius(i);
        if clear > 0.0 { safe_step(clear, v - self.gravity * t, self.gravity) } else { 0.0 }
    }
    /// Returns the time at which end i touches the ground, if before `cap`. With `leaving` it starts on the ground
    /// without velocity, upward.
    pub(super) fn touch(&self, i: usize, cap: f64, leaving: bool) -> Option<f64> {
        let arm = self.body.radius(i);
        let w2 = self.spin * self.spin;
        let bound = self.gravity + arm * w2;
        let jerk = arm * w2 * self.spin.abs();
        let step = |t: f64, now: [f64; 3]| far_step(now, bound, jerk).max(self.clear(i, t));
        let (h, v) = (self.ends.h[i], self.ends.v[i]);
        let first = if h > 0.0 {
            0.0
        } else if v > 0.0 {
            step(0.0, [0.0, v, self.acceleration(i)]).by
        } else if v == 0.0 && leaving {
            // h ≥ ½ h″ t² + h‴ t³/6 − R ω⁴ t⁴/24, R the distance of the end. Where turning has just lifted it, h″ is
            // zero but for rounding.
            let up = self.acceleration(i).max(0.0);
            let rate = -self.levers()[i] * self.spin * w2;
            let bound = arm * w2 * w2;
            if up == 0.0 && rate <= 0.0 {
                return None; // level and turned downward: the other end strikes at once
            }
            let root = libm::hypot(rate, (3.0 * bound * up).sqrt());
            if rate > 0.0 { 2.0 * (rate + root) / bound } else { 6.0 * up / (root - rate) }
        } else if v == 0.0 {
            return None; // lies still
        } else {
            return (cap > 0.0).then_some(0.0);
        };
        if first.is_nan() || first >= cap { None } else { first_zero(first, cap, |t| self.end(i, t), step).last() }
    }
    /// Returns whether a touch of end i at t is meaningless: the body turned so often until then that its angle is no
    /// longer known to 10⁻⁴, or the search was given up with the end still in the air.
    fn is_lost(&self, i: usize, t: f64) -> bool {
        (self.spin * t).abs() > 1e-4 / f64::EPSILON || self.end(i, t)[0] > 1e-3 * self.body.length_m()
    }
    /// Returns the pose after a flight of time t that ends with end i on the ground, before the strike.
    pub(super) fn landed(&self, i: usize, t: f64) -> Self {
        let j = 1 - i;
        let (turn_sin, turn_cos) = libm::sincos(self.spin * t);
        let sin = self.sin * turn_cos + self.cos * turn_sin;
        let cos = self.cos * turn_cos - self.sin * turn_sin;
        let length = self.body.length_m();
        let mut next = *self;
        next.ends.v[i] = self.end(i, t)[1];
        let [h, v, _] = self.end(j, t);
        (next.ends.h[i], next.ends.v[j]) = (0.0, v);
        if sin.abs() < 0.5 {
            // Heights give a small angle to its last digit. Below zero is rounding: the other end has not touched.
            next.ends.h[j] = h.max(0.0);
            next.sin = sigma(j) * next.ends.h[j] / length;
            next.cos = ((1.0 - next.sin) * (1.0 + next.sin)).sqrt().copysign(cos);
        } else {
            let norm = libm::hypot(sin, cos);
            (next.sin, next.cos) = (sin / norm, cos / norm);
            next.ends.h[j] = (sigma(j) * length * next.sin).max(0.0);
        }
        if t > 0.0 && next.cos.abs() <= 0.5 {
            // The spin gives the angle of a steep body; the other end follows, so that both never drift apart.
            let x = next.levers();
            next.ends.v[j] = next.ends.v[i] + (x[j] - x[i]) * next.spin;
        }
        next
    }
    /// Returns the inertia ratio of a strike at end i at this angle.
    fn ratio(&self, i: usize) -> f64 {
        let [a, b] = self.levers();
        let product = if self.body.thickness_m() > 0.0 {
            -a * b - self.body.gyration_m().powi(2)
        } else {
            self.body.product(self.cos * self.cos)
        };
        product / self.body.inertia([a, b][i])
    }
    /// Returns the effective mass of end i over the mass of the body, ρ²/(ρ² + x²).
    fn mass(&self, i: usize) -> f64 {
        self.body.gyration_m().powi(2) / self.body.inertia(self.levers()[i])
    }
    /// Returns the time until a body of thickness stands at a right angle; never for one without, which has no other
    /// corners.
    fn upright(&self) -> f64 {
        let turn = libm::atan2(self.sin, self.cos) * self.spin.signum();
        if self.body.thickness_m() > 0.0 && self.spin != 0.0 {
            (0.5 * std::f64::consts::PI - turn) / self.spin.abs()
        } else {
            f64::INFINITY
        }
    }
    /// Gives end i the velocity jump; returns that of the other end.
    fn strike(&mut self, i: usize, jump: f64) -> f64 {
        let other = -self.ratio(i) * jump;
        let x = self.levers()[i];
        self.ends.v[i] += jump;
        self.ends.v[1 - i] += other;
        self.spin += jump * x / self.body.inertia(x);
        self.level();
        other
    }
    /// Returns the energy per unit mass.
    pub(super) fn energy(&self) -> f64 {
        let (y, v) = self.center();
        let turning = self.body.gyration_m() * self.spin;
        0.5 * (v * v + turning * turning) + self.gravity * y
    }
    /// Sets the spin from the velocities of the ends, which are more exact while they shrink.
    fn level(&mut self) {
        if self.cos.abs() > 0.5 {
            self.spin = (self.ends.v[1] - self.ends.v[0]) / (self.body.length_m() * self.cos);
        }
    }
}

/// The energy that a body must have, kept apart from the motion so that roundings do not add up over 10⁴ strikes.
struct Ledger {
    energy: f64,
    opened: f64,
}

impl Ledger {
    fn open(pose: &Airborne) -> Self {
        let energy = pose.energy();
        Self { energy, opened: energy }
    }
    /// Corrects the velocities of a body in flight for the roundings of its energy.
    fn settle(&self, pose: &mut Airborne) {
        let (y, _) = pose.center();
        let now = pose.energy();
        let share = 0.5 * (self.energy - now) / (now - pose.gravity * y);
        // More than 10⁵ roundings are no rounding: the kinetic energy is a small difference there.
        if share.abs() < 1e5 * f64::EPSILON {
            pose.ends.v = pose.ends.v.map(|v| v + share * v);
            pose.spin += share * pose.spin;
        }
    }
    /// Books the loss of a strike at effective mass `mass`; opens anew once the old account is twice as large.
    fn strike(&mut self, pose: &Airborne, mass: f64, e: f64, u: f64) {
        self.energy -= 0.5 * mass * (1.0 - e) * (1.0 + e) * u * u;
        if self.energy < 0.5 * self.opened {
            *self = Self::open(pose);
        }
    }
}

/// Touches in a row without speed that no motion needs: beyond them the time has no digits left for a turn.
const IDLE: u32 = 64;

/// Returns the flight with restitution `e` of ends a and b. Strikes are searched until `horizon_s`.
pub(super) fn simulate(scene: &Scene, e: [f64; 2], horizon_s: f64, mut enough: impl FnMut(&Log<2>) -> bool) -> Flight {
    let g = scene.gravity_m_s2();
    let rest = Rest::new(scene, e);
    let mut log = Log::new(scene.time_limit_s(), scene.impact_limit());
    let mut pose = Airborne::start(scene);
    let mut time = Clock::default();
    let mut leaving = [false; 2];
    let mut ledger = Ledger::open(&pose);
    let mut idle = 0;
    loop {
        let still = [0, 1].map(|i| pose.ends.h[i] == 0.0 && pose.ends.v[i] == 0.0 && !leaving[i]);
        if still == [true; 2] && g > 0.0 {
            log.at_rest(time.now(), 0.0, 0.0);
            break;
        }
        let down = [0, 1].map(|i| still[i] && g > 0.0 && pose.acceleration(i) < 0.0);
        leaving = [0, 1].map(|i| leaving[i] || (still[i] && !down[i]));
        let landing = |j: usize| pose.ends.h[j] == 0.0 && pose.ends.v[j] < 0.0;
        let i = if let Some(pivot) = (0..2).find(|&p| down[p] && !landing(1 - p)) {
            let from = time.now();
            let (after, dt, event) = pivot::run(&pose, pivot);
            time.add(dt);
            log.pivot(pivot, from, time.now(), &pose.after());
            pose = after;
            ledger = Ledger::open(&pose);
            if event == Event::Upright {
                log.turned_over(time.now());
                break;
            }
            if event == Event::LiftOff {
                log.lifted(&pose.after());
                leaving[pivot] = true;
                continue;
            }
            1 - pivot
        } else {
            let upright = pose.upright();
            let sight = upright.min((horizon_s - time.now()).max(0.0));
            let ta = pose.touch(0, sight, leaving[0]);
            let tb = pose.touch(1, ta.unwrap_or(sight), leaving[1]);
            // At one instant end a strikes first: b is searched before a's time only.
            if [ta, tb].into_iter().enumerate().any(|(i, t)| t.is_some_and(|t| pose.is_lost(i, t))) {
                log.lost(time.now());
                break;
            }
            let Some((i, dt)) = tb.map(|t| (1, t)).or(ta.map(|t| (0, t))) else {
                if sight < upright {
                    log.lost(horizon_s);
                } else if upright < f64::INFINITY {
                    log.turned_over(time.now() + upright);
                } else {
                    log.bounced_clear();
                }
                break;
            };
            time.add(dt);
            pose = pose.landed(i, dt);
            ledger.settle(&mut pose);
            if dt > 0.0 {
                leaving = [false; 2];
            }
            i
        };
        let before = pose;
        let u = pose.ends.v[i].min(0.0);
        if u == 0.0 {
            // This is a touch without speed. A point that lies still stays, one that turns upward leaves.
            pose.ends.v[i] = 0.0;
            idle += 1;
            if idle > IDLE {
                log.lost(time.now());
                break;
            }
            continue;
        }
        idle = 0;
        let jump = -(1.0 + e[i]) * u;
        let other = pose.strike(i, jump);
        pose.ends.v[i] = -e[i] * u;
        pose.level();
        ledger.strike(&pose, pose.mass(i), e[i], u);
        leaving[i] = false;
        let delta_v = if i == 0 { [jump, other] } else { [other, jump] };
        if !log.strike(i, time.now(), u, delta_v, &pose.after(), &mut enough) {
            break;
        }
        if jump <= SHARE * log.largest_m_s {
            if let Some((left_s, shock)) = rest.remaining(&before, &pose, i)
                && log.settled(time.now(), rest.scale_s, left_s, shock)
            {
                break;
            }
            if g > 0.0 {
                chatter(&mut pose, &mut time, &mut log, i, e[i]);
                ledger = Ledger::open(&pose);
            }
        }
    }
    log.flight
}

/// Sums the chatter of end `i` alone, if it is negligible, proven to contract, and the other end provably stays up.
fn chatter(pose: &mut Airborne, time: &mut Clock, log: &mut Log<2>, i: usize, e: f64) {
    let j = 1 - i;
    let gamma = -pose.acceleration(i);
    let s = pose.ends.v[i] / (1.0 - e);
    let tau = 4.0 * s / gamma;
    // This is the first omitted shock, as the contraction bounds it.
    let omitted = 1.3 * (1.0 + e) * pose.ends.v[i];
    if omitted > SHARE * log.largest_m_s || gamma <= 0.0 || !short(tau, time.now(), 0.0) {
        return;
    }
    let (arm, w) = (pose.body.radius(i), pose.spin.abs());
    let x = pose.levers()[i].abs();
    let kick = 2.0 * (1.0 + e) * s;
    let dw = kick * x / pose.body.inertia(x);
    let change = arm * ((2.0 * w + dw) * dw + (w + dw).powi(3) * tau);
    let fastest = pose.ends.v[j].abs() + pose.ratio(i).abs() * kick;
    let lowest = pose.ends.h[j] - tau * (fastest + tau * (pose.gravity + pose.body.radius(j) * (w + dw).powi(2)));
    if change <= 0.25 * gamma * (1.0 - e) && lowest > 0.0 {
        log.omitted_m_s = log.omitted_m_s.max(omitted);
        let dt = 2.0 * s / gamma;
        // The time is below an ulp: the effects of the free motion and of the strikes are of first order in it.
        let free = pose.acceleration(j) * dt;
        pose.ends.h[j] += dt * pose.ends.v[j];
        pose.ends.v[j] += free - pose.ratio(i) * (1.0 + e) * s;
        (pose.ends.h[i], pose.ends.v[i]) = (0.0, 0.0);
        if pose.sin.abs() < 0.5 {
            pose.sin = sigma(j) * pose.ends.h[j] / pose.body.length_m();
            pose.cos = ((1.0 - pose.sin) * (1.0 + pose.sin)).sqrt().copysign(pose.cos);
        }
        pose.level();
        time.add(dt);
    }
}

/// The proofs of rest: by energy under gravity, by the map's contraction without.
struct Rest {
    settling: Settling,
    scale_s: f64,
    gravity: f64,
    /// The larger of both restitutions: it bounds both ends.
    e: f64,
    /// λ₊ and λ₋ of the level body where they are apart and below 1 and both ends rebound alike, κ.
    contraction: Option<(f64, f64, f64)>,
}

impl Rest {
    fn new(scene: &Scene, [e_a, e_b]: [f64; 2]) -> Self {
        let (body, e, gravity) = (scene.body(), e_a.max(e_b), scene.gravity_m_s2());
        let [qa, qb] = body.inertia_ratios();
        let q = (qa * qb).sqrt().copysign(qa);
        let trace = q * (1.0 + e);
        let root = (trace * trace - 4.0 * e).sqrt();
        // The margins are far above rounding and the tilt left: a bar closer to the edge runs to its limits instead.
        let contracts = e_a - e_b == 0.0 && trace > 0.0 && root > 1e-3 && q < 1.0 - 1e-6;
        let [a, b] = body.arms_m();
        let kappa = (body.inertia(a) / body.inertia(b)).sqrt();
        Self {
            settling: Settling::new(&body, e, gravity, 1e-3),
            scale_s: scene.speed_m_s() / gravity,
            gravity,
            e,
            contraction: contracts.then_some((0.5 * (trace + root), root, kappa)),
        }
    }
    /// Returns the largest remaining time and shock after a strike of end i, where a proof is at hand.
    fn remaining(&self, before: &Airborne, after: &Airborne, i: usize) -> Option<(f64, f64)> {
        let [a, b] = after.body.arms_m();
        // A center half a thickness over the ends moves them as a tilt does.
        if after.sin.abs() * (1.0 + after.body.thickness_m() / a.min(b)) > 1e-3 {
            return None;
        }
        if self.gravity > 0.0 {
            let energy = self.settling.energy(after.ends.h, after.ends.v);
            let gyration = after.body.gyration_m();
            let [near, far] = [0, 1].map(|i| after.body.radius(i));
            // ½ ρ² ω² ≤ E bounds the turning, g y ≤ E the tilt.
            let turning = 2.0 * energy * near.max(far) / (gyration * gyration);
            if turning > 1e-3 * self.gravity || energy > 1e-3 * self.gravity * a.min(b) {
                return None;
            }
            let (time, speed) = self.settling.remaining(energy);
            return Some((2.0 * time, 2.0 * (1.0 + self.e) * speed));
        }
        // Without gravity the tail is the map's: t_∞ = h/(λ₊|u| − v) from this strike on, doubled.
        let (lambda, root, kappa) = self.contraction?;
        let kappa = if i == 0 { kappa } else { 1.0 / kappa };
        let j = 1 - i;
        let (u, v, h) = (-before.ends.v[i], kappa * before.ends.v[j], kappa * before.ends.h[j]);
        let closing = lambda * u - v;
        if closing < 1e-3 * u {
            return None;
        }
        Some((2.0 * h / closing, 4.0 * (u + v.abs()) * (1.0 + self.e) / root * kappa.max(1.0 / kappa)))
    }
}
