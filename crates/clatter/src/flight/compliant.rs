//! Contact that takes time: a linear spring and dashpot at each end, never pulling.
//!
//! An end in contact at height h ≤ 0 feels the force per unit mass of the body
//!
//! ```text
//! f = −κ (h + θ h′),   κ = ω²/μ,   θ = 2ζ/ω,   μ = 1 + x²/ρ²,   contact lost at f = 0
//! ```
//!
//! where x = L cos φ is the lever arm at the angle of touch, kept until no end is in contact. The stiffness is that of
//! the effective mass at that angle, so a lone contact has the same natural frequency ω and damping ratio ζ at any
//! angle, and with it the restitution and the duration that were asked for.
//!
//! # Fit
//! A lone contact without gravity loses contact when h + θ h′ = 0. With ζ = cos β (or cosh β beyond critical damping)
//! this gives duration and restitution in closed form:
//!
//! ```text
//! ω τ = 2β/sin β   (2β/sinh β),   e = exp(−ζ ω τ) = exp(−2β cot β)   (exp(−2β coth β))
//! ```
//!
//! (At ζ = 0.3: e = 0.451.) Solved for β² by Newton's steps to a few roundings; e² decreases with ζ throughout.
//!
//! # Phases
//! With one end in contact its height is a damped oscillation, the other end a parabola plus a multiple of it. With
//! both, `w = √κ h` obeys `w″ = −√κ g − S (w + θ w′)` with a symmetric S, whose two modes are damped in proportion to
//! their stiffness. So every phase is a sum of known functions, evaluated and not stepped. Touching, parting and coming
//! back into contact are first zeros found by [`roots`](super::roots): the energy `z′² + k z²` of a mode never grows
//! and bounds every derivative from any moment on. A lone contact parts between a zero and a crest of its mode, which
//! are known.
//!
//! After parting the end is still below zero by what the dashpot held back. It touches again when it comes back to zero
//! from above, or, if it never gets there, when the force law pushes again; that belongs to the same strike.
//!
//! # Error of the kept lever arm
//! Lever arms are those of the beginning of a phase; at its end the pose follows in exact geometry. A phase ends with
//! any touch or parting, and after a turn of 1/200 rad. From then on the body pivots on its spring, with the lever
//! arms, and the acceleration by turning, of halfway through a phase of 0.03 rad at most. What kept arms would take
//! from an end that lies, one more impulse on it gives back: it is not thrown up. The shock of a contact is off by tan
//! φ · ω τ of itself at most, ω the spin it leaves.
//!
//! What the ground does for the body in a phase is known in closed form; whatever else its energy changes by is the
//! kept lever arm's doing, and is summed without regard to sign in [`CompliantFlight::energy_error`]. It grows with the
//! turn during a contact. The worst of 100 strikes at q from −0.5 to 0.98, e from 0.1 to 1 and tilts from 0.1° to 85°,
//! for contact times τ:
//!
//! | τ √(g/length) | τ v0/length = 0.1 | 0.01 | 0.001 |
//! |---|---|---|---|
//! | 0.1 | 0.7 | 0.3 | 0.3 |
//! | 0.03 | 0.09 | 0.02 | 0.03 |
//! | 0.01 | 0.1 | 0.001 | 0.002 |
//! | 0.003 | 0.06 | 0.001 | 0.0003 |
//!
//! After many strikes of long contacts it hangs on roundings of the start: changes of the speed by 1e−13 make up to
//! three times as much of it.

use std::cell::Cell;

use super::ballistic::Clock;
use super::finite_tilt::{Pose, end_of, sigma};
use super::roots::{STEPS, Step, far_step, first_zero, safe_step};
use super::{Flight, Log, SHARE, Scene, Stop, Strike};
use crate::{End, Error};

/// Newton's steps of the fit at most: eight do.
const NEWTON: usize = 12;

/// Natural frequency and damping ratio of a lone contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    time: f64,
    frequency: f64,
    damping: f64,
}

impl Contact {
    /// The contact with restitution `e` and duration `contact_time_s`.
    ///
    /// # Accuracy
    /// A lone contact without gravity has this restitution and this duration to 1e−12.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless 0.01 ≤ e ≤ 1 and the contact time is in [1e−12, 1e3] s: shorter ones vanish beside
    /// the times of flight.
    ///
    /// ```
    /// let contact = clatter::flight::Contact::new(0.451, 1e-3)?;
    /// assert!((contact.damping_ratio() - 0.3).abs() < 1e-3);
    /// # Ok::<(), clatter::Error>(())
    /// ```
    pub fn new(e: f64, contact_time_s: f64) -> Result<Self, Error> {
        if !(0.01..=1.0).contains(&e) {
            let allowed = "in [0.01, 1] for a compliant contact";
            return Err(Error::Quantity { name: "restitution e", value: e, allowed });
        }
        if !(1e-12..=1e3).contains(&contact_time_s) {
            let allowed = "in [1e-12, 1000]";
            return Err(Error::Quantity { name: "contact time in s", value: contact_time_s, allowed });
        }
        let loss = -e.ln(); // ζ ω τ
        // β cot β, and β coth β with x = −β², are one function of x = β², 1 − x/3 − …, which falls and is concave:
        // Newton's steps from where its tangent at 0 has the value stay on one side of x.
        let mut x = 3.0 - 1.5 * loss;
        for _ in 0..NEWTON {
            let (b, sine, cosine) = Self::angle(x);
            let (value, slope) = if b < 1e-4 {
                (1.0 - x / 3.0, -1.0 / 3.0)
            } else {
                (b * cosine / sine, (sine * cosine - b).copysign(-1.0) / (2.0 * b * sine * sine))
            };
            let step = (0.5 * loss - value) / slope;
            x += step;
            if step.abs() <= 4.0 * f64::EPSILON * x.abs().max(1.0) {
                break;
            }
        }
        let (b, sine, cosine) = Self::angle(x);
        let damping = if loss > 0.0 { cosine } else { 0.0 };
        let stretch = if b > 0.0 { b / sine } else { 1.0 };
        Ok(Self { time: contact_time_s, frequency: 2.0 * stretch / contact_time_s, damping })
    }
    /// β, sin β and cos β of β² = x; sinh and cosh where x is negative.
    fn angle(x: f64) -> (f64, f64, f64) {
        let b = x.abs().sqrt();
        let (sine, cosine) = if x > 0.0 { b.sin_cos() } else { (b.sinh(), b.cosh()) };
        (b, sine, cosine)
    }
    /// Natural frequency ω of a lone contact, rad/s.
    #[must_use]
    pub fn frequency_rad_s(&self) -> f64 {
        self.frequency
    }
    /// Damping ratio ζ of a lone contact.
    #[must_use]
    pub fn damping_ratio(&self) -> f64 {
        self.damping
    }
    fn delay(&self) -> f64 {
        2.0 * self.damping / self.frequency
    }
}

/// `y″ + 2 s y′ + k y = k rest`, from z = y − rest and z′ at time 0.
#[derive(Debug, Clone, Copy)]
struct Mode {
    s: f64,
    k: f64,
    /// √k and √|k − s²|.
    root: f64,
    nu: f64,
    rest: f64,
    z: f64,
    dz: f64,
}

impl Mode {
    fn new(k: f64, delay: f64, force: f64, y: f64, dy: f64) -> Self {
        let (rest, s) = (force / k, 0.5 * delay * k);
        Self { s, k, root: k.sqrt(), nu: (k - s * s).abs().sqrt(), rest, z: y - rest, dz: dy }
    }
    /// z and z′ at time t.
    fn at(&self, t: f64) -> (f64, f64) {
        if t == 0.0 { (self.z, self.dz) } else { self.turned((self.z, self.dz), self.turn(t)) }
    }
    /// e^(−st) cos νt and e^(−st) sin(νt)/ν, beyond critical damping of the hyperbolic functions.
    fn turn(&self, t: f64) -> (f64, f64) {
        let nu = self.nu;
        if self.s * self.s < self.k {
            let decay = (-self.s * t).exp();
            let (sin, cos) = (nu * t).sin_cos();
            (decay * cos, decay * sin / nu)
        } else {
            // The slow exponent by the product of both, without cancellation.
            let decay = (-self.k / (self.s + nu) * t).exp();
            let x = 2.0 * nu * t;
            // e^(−x) − 1, which cancels for small x alone.
            let less = if x < 1.0 { (-x).exp_m1() } else { (-x).exp() - 1.0 };
            let sn = if x > 0.0 { -less / x } else { 1.0 };
            (decay * (1.0 + 0.5 * less), decay * t * sn)
        }
    }
    /// The turn of twice the time.
    fn twice(&self, (c, sn): (f64, f64)) -> (f64, f64) {
        let square = (self.nu * sn).powi(2);
        (c * c + if self.s * self.s < self.k { -square } else { square }, 2.0 * c * sn)
    }
    /// z and z′ a turn later.
    fn turned(&self, (z, dz): (f64, f64), (c, sn): (f64, f64)) -> (f64, f64) {
        (z * c + (dz + self.s * z) * sn, dz * c - (self.k * z + self.s * dz) * sn)
    }
    fn second(&self, (z, dz): (f64, f64)) -> f64 {
        -2.0 * self.s * dz - self.k * z
    }
    /// Bounds from the moment of (z, z′) on: of |z|, |z″| and |z‴|; the first derivatives are at most √k times these.
    /// And z‴ then.
    fn bounds(&self, now: (f64, f64)) -> ([f64; 3], f64) {
        let a = self.second(now);
        let jerk = self.second((now.1, a));
        let snap = self.second((a, jerk));
        // Lengths, speeds and contact times are let in from 1e−31 to 1e30: no square leaves the floats. `hypot` would
        // take a tenth of a simulation.
        let length = |x: f64, y: f64| (x * x + y * y).sqrt();
        let bounds = [length(now.0, now.1 / self.root), length(a, jerk / self.root), length(jerk, snap / self.root)];
        (bounds, jerk)
    }
    /// When the force of a lone contact, `−(y + θ y′)` over its stiffness, has fallen to zero, if before `cap`: for a
    /// rest that presses.
    ///
    /// `w = z + θ z′` moves as z does, and its zeros and crests are known. From a zero on the way up it is concave as
    /// far as the crest, the first being the highest: Newton's steps from there never pass the moment it reaches −rest,
    /// nor miss it. Without weight it is the zero itself.
    fn lets_go(&self, delay: f64, cap: f64) -> Option<f64> {
        let Self { s, k, nu, rest, .. } = *self;
        let whole = |(z, dz): (f64, f64)| (z + delay * dz, dz + delay * self.second((z, dz)));
        let (w, dw) = whole((self.z, self.dz));
        let (zero, crest) = if s * s < k {
            let (zero, lag) = (-w.atan2((dw + s * w) / nu) / nu, nu.atan2(s) / nu);
            let zero = if zero + lag > 0.0 { zero } else { zero + std::f64::consts::TAU / nu };
            (zero, zero + lag)
        } else {
            // Once up and down at most: what falls above zero, or is too slow to reach it, never comes up to it.
            let time = |x: f64| if nu > 0.0 { (nu * x).atanh() / nu } else { x };
            let zero = if w < 0.0 { time(-w / (dw + s * w)) } else { 0.0 };
            if !(zero >= 0.0 && dw > 0.0) {
                return None;
            }
            (zero, time(dw / (k * w + s * dw)))
        };
        let (from, cap) = (zero.max(0.0), cap.min(crest));
        if from >= cap {
            return None;
        }
        let force = |t: f64| {
            let (w, dw) = whole(self.at(t));
            [-(rest + w), -dw]
        };
        let step = |_: f64, [f, slope]: [f64; 2]| {
            let by = -f / slope;
            // |w″| on the way to −rest is at most this; where it takes no more than half of the slope, the step is short by no more than this.
            let bend = k * rest.abs() - 2.0 * s * slope;
            let short = if 2.0 * by * bend <= -slope { by * by * bend / -slope } else { f64::INFINITY };
            Step { by, short }
        };
        first_zero(from, cap, force, step)
    }
    /// Slowest rate of decay.
    fn decay(&self) -> f64 {
        if self.s * self.s > self.k { self.k / (self.s + self.nu) } else { self.s }
    }
}

/// Share of a radian, and of the time √(L/g), after which the lever arms of a strike that does not end are renewed.
const TURN: f64 = 0.005;
/// The same of a body that pivots on its spring, with the lever arms of halfway: off by the square of it.
const PIVOT: f64 = 0.03;

/// Phases, beyond 16 a strike, after which a body that neither rests nor strikes is left at the time it has reached.
const PHASES: usize = 100_000;

/// A phase with one or both ends in contact, at fixed lever arms; with none it only holds the pose.
#[derive(Debug, Clone, Copy)]
struct Phase {
    start: Pose,
    on: [bool; 2],
    delay: f64,
    /// Downward acceleration of each end without contact: gravity, in a long contact also the turning at the start.
    fall: [f64; 2],
    /// Lever arms with sign, 1 + x²/ρ², and `1 + x_a x_b/ρ²`.
    x: [f64; 2],
    mu: [f64; 2],
    cross: f64,
    /// Stiffness over the mass of the body, from the angle of touch.
    kappa: [f64; 2],
    modes: [Mode; 2],
    /// Heights of both ends in contact as sums of modes.
    weights: [[f64; 2]; 2],
}

impl Phase {
    /// With the lever arms of the pose `of`, which in a long contact are those halfway through the phase.
    fn new(start: Pose, of: &Pose, on: [bool; 2], contact: Contact, kappa: [f64; 2], long: bool) -> Self {
        let rho2 = start.body.gyration_m().powi(2);
        let x = of.levers();
        let mu = x.map(|x| 1.0 + x * x / rho2);
        let cross = 1.0 + x[0] * x[1] / rho2;
        let fall = if long { [0, 1].map(|i| -of.acceleration(i)) } else { [start.gravity; 2] };
        let (h, v) = (start.ends.h, start.ends.v);
        let delay = contact.delay();
        let (modes, weights) = if on == [true; 2] {
            let root = kappa.map(f64::sqrt);
            // S = [[κ_a μ_a, off], [off, κ_b μ_b]], positive definite.
            let (off, half) = (root[0] * root[1] * cross, 0.5 * (kappa[0] * mu[0] - kappa[1] * mu[1]));
            let (sin, cos) = (0.5 * off.atan2(half)).sin_cos();
            let large = 0.5 * (kappa[0] * mu[0] + kappa[1] * mu[1]) + half.hypot(off);
            // The small eigenvalue by the determinant, κ_a κ_b (x_b − x_a)²/ρ².
            let small = kappa[0] * kappa[1] * (x[1] - x[0]).powi(2) / rho2 / large;
            let one = |u: [f64; 2]| cos * root[0] * u[0] + sin * root[1] * u[1];
            let two = |u: [f64; 2]| cos * root[1] * u[1] - sin * root[0] * u[0];
            let modes = [
                Mode::new(large, delay, -one(fall), one(h), one(v)),
                Mode::new(small, delay, -two(fall), two(h), two(v)),
            ];
            (modes, [[cos / root[0], -sin / root[0]], [sin / root[1], cos / root[1]]])
        } else {
            let i = usize::from(on[1]);
            ([Mode::new(kappa[i] * mu[i], delay, -fall[i], h[i], v[i]); 2], [[1.0, 0.0]; 2])
        };
        Self { start, on, delay, fall, x, mu, cross, kappa, modes, weights }
    }
    fn both(&self) -> bool {
        self.on == [true; 2]
    }
    /// z and z′ of the modes at time t; of one end in contact they are the same.
    fn modes_at(&self, t: f64) -> [(f64, f64); 2] {
        let first = self.modes[0].at(t);
        [first, if self.both() { self.modes[1].at(t) } else { first }]
    }
    /// The same, kept for whoever asks again for the time asked last.
    fn kept_modes_at(&self) -> impl Fn(f64) -> [(f64, f64); 2] {
        let last = Cell::new((0.0_f64, self.modes_at(0.0)));
        move |t| {
            if t.to_bits() != last.get().0.to_bits() {
                last.set((t, self.modes_at(t)));
            }
            last.get().1
        }
    }
    /// Height, velocity, acceleration of end i at time t, from the modes then.
    #[inline]
    fn end(&self, i: usize, t: f64, modes: &[(f64, f64); 2]) -> [f64; 3] {
        if self.on[i] { self.pressed_end(i, modes) } else { self.free_end(i, t, self.pressed_end(1 - i, modes)) }
    }
    /// The same of one in contact.
    #[inline]
    fn pressed_end(&self, i: usize, modes: &[(f64, f64); 2]) -> [f64; 3] {
        let of = |k: usize| {
            let (mode, now) = (&self.modes[k], modes[k]);
            [mode.rest + now.0, now.1, mode.second(now)]
        };
        if !self.both() {
            return of(0);
        }
        let ([c, d], one, two) = (self.weights[i], of(0), of(1));
        [c * one[0] + d * two[0], c * one[1] + d * two[1], c * one[2] + d * two[2]]
    }
    /// The same of the free one, where the other one is known.
    #[inline]
    fn free_end(&self, i: usize, t: f64, [h, v, a]: [f64; 3]) -> [f64; 3] {
        let j = 1 - i;
        let share = self.cross / self.mu[j];
        let (h0, v0, g) = (self.start.ends.h, self.start.ends.v, self.fall);
        let half = 0.5 * t * t;
        [
            h0[i] + v0[i] * t - half * g[i] + share * (h - h0[j] - v0[j] * t + half * g[j]),
            v0[i] - g[i] * t + share * (v - v0[j] + g[j] * t),
            -g[i] + share * (a + g[j]),
        ]
    }
    /// Both ends.
    fn ends(&self, t: f64) -> [[f64; 3]; 2] {
        let modes = self.modes_at(t);
        [0, 1].map(|i| self.end(i, t, &modes))
    }
    fn force(&self, i: usize, [h, v, _]: [f64; 3]) -> f64 {
        if self.on[i] { (-self.kappa[i] * (h + self.delay * v)).max(0.0) } else { 0.0 }
    }
    /// Solves `M (f_a, f_b) = r` for the ends in contact.
    fn solve(&self, r: [f64; 2]) -> [f64; 2] {
        if self.both() {
            let det = ((self.x[1] - self.x[0]) / self.start.body.gyration_m()).powi(2);
            [(self.mu[1] * r[0] - self.cross * r[1]) / det, (self.mu[0] * r[1] - self.cross * r[0]) / det]
        } else {
            let i = usize::from(self.on[1]);
            let mut f = [0.0; 2];
            f[i] = r[i] / self.mu[i];
            f
        }
    }
    /// Impulses of both ends over the time t, from what they do then.
    fn impulses(&self, t: f64, ends: &[[f64; 3]; 2]) -> [f64; 2] {
        self.solve([0, 1].map(|i| ends[i][1] - self.start.ends.v[i] + self.fall[i] * t))
    }
    /// Adds to a strike of end k what its impulse does to both ends.
    fn push(&self, strike: &mut Strike, k: usize, impulses: [f64; 2]) {
        let delta = if k == 0 { [self.mu[0], self.cross] } else { [self.cross, self.mu[1]] };
        for (d, m) in strike.delta_v_m_s.iter_mut().zip(delta) {
            *d += m * impulses[k];
        }
    }
    /// The pose at time t, from what the ends do then: angle and spin are what the impulses give, the velocities of
    /// both ends follow by that of the center, which keeps the energy. `parts`: the center is where the impulses have
    /// brought it, which keeps the energy too; else the end in contact is where its spring is. What is left follows in
    /// exact geometry. `stays`: the end in contact keeps its own velocity, so that it lies still if it did; what kept
    /// lever arms take from that is one more impulse on it.
    fn pose(&self, t: f64, ends: &[[f64; 3]; 2], impulses: &mut [f64; 2], parts: bool, stays: bool) -> Pose {
        let s = &self.start;
        let length = s.body.length_m();
        let mut next = *s;
        (next.ends.h, next.ends.v) = (ends.map(|e| e[0]), ends.map(|e| e[1]));
        if self.both() {
            next.sin = (ends[1][0] - ends[0][0]) / length;
            next.cos = ((1.0 - next.sin) * (1.0 + next.sin)).sqrt().copysign(s.cos);
            next.spin = (ends[1][1] - ends[0][1]) / (length * next.cos);
            return next;
        }
        let rho2 = s.body.gyration_m().powi(2);
        let i = usize::from(self.on[1]);
        let j = 1 - i;
        let twice = (ends[i][0] - s.ends.h[i] - s.ends.v[i] * t + 0.5 * self.fall[i] * t * t) / self.mu[i];
        next = next.turned(s.spin * t + self.x[i] * twice / rho2);
        next.spin = s.spin + self.x[i] * impulses[i] / rho2;
        if parts {
            let y = s.center().0 + t * (s.center().1 - 0.5 * s.gravity * t) + twice;
            next.ends.h[i] = y + sigma(i) * s.body.arms_m()[i] * next.sin;
        }
        next.ends.h[j] = next.ends.h[i] + sigma(j) * length * next.sin;
        let (x, mut center) = (next.levers(), s.center().1 - s.gravity * t + impulses[i]);
        if stays {
            let lacks = (ends[i][1] - center - x[i] * next.spin) / (1.0 + x[i] * x[i] / rho2);
            impulses[i] += lacks;
            center += lacks;
            next.spin += x[i] * lacks / rho2;
        }
        next.ends.v = x.map(|x| center + x * next.spin);
        next
    }
    /// Work of the ground on the body until the ends do this, per unit mass: with `M` the map of forces to
    /// accelerations, `∫ f·v dt = ½ Δ(v·M⁻¹v) + fall·M⁻¹Δh`.
    fn work(&self, ends: &[[f64; 3]; 2]) -> f64 {
        let (h, v) = (self.start.ends.h, self.start.ends.v);
        let rise = self.solve([0, 1].map(|i| ends[i][0] - h[i]));
        let push = self.solve([0, 1].map(|i| ends[i][1] - v[i]));
        (0..2).map(|i| 0.5 * (ends[i][1] + v[i]) * push[i] + self.fall[i] * rise[i]).sum()
    }
    /// The first of the ends in contact that parts, and when, if before `cap`. `fresh`: it has just begun to press.
    ///
    /// Of two, both are followed at once: what costs most are the modes, which they share.
    fn parting(&self, cap: f64, fresh: [bool; 2]) -> Option<(usize, f64)> {
        let delay = self.delay;
        let rests = self.weights.map(|c| c[0] * self.modes[0].rest + c[1] * self.modes[1].rest);
        if !self.both() {
            let i = usize::from(self.on[1]);
            if rests[i] <= 0.0 {
                return self.modes[0].lets_go(delay, cap).map(|t| (i, t));
            }
        }
        let whole = self.weights.map(|c| [0, 1].map(|k| c[k].abs() * (1.0 + delay * self.modes[k].root)));
        let (mut t, mut begins) = (0.0, fresh);
        let mut soonest = (Step::clear(f64::INFINITY), 0);
        for _ in 0..STEPS {
            let modes = self.modes_at(t);
            let bounds = [0, 1].map(|k| self.modes[k].bounds(modes[k]));
            soonest = (Step::clear(f64::INFINITY), 0);
            for i in (0..2).filter(|&i| self.on[i]) {
                let [h, v, a] = self.end(i, t, &modes);
                let (force, slope) = (-(h + delay * v), -(v + delay * a));
                if force <= 0.0 && !begins[i] {
                    return Some((i, t));
                }
                let sum = |of: [f64; 2]| whole[i][0] * of[0] + whole[i][1] * of[1];
                // Where the vibration is too weak to lift it, it presses for good.
                let step = if sum(bounds.map(|([z, ..], _)| z)) < -rests[i] {
                    Step::clear(f64::INFINITY)
                } else {
                    let jerk = self.weights[i][0] * bounds[0].1 + self.weights[i][1] * bounds[1].1;
                    let [second, third] = [1, 2].map(|n| sum(bounds.map(|(of, _)| of[n])));
                    far_step([force.max(0.0), slope, -(a + delay * jerk)], second, third)
                };
                if step.by < soonest.0.by {
                    soonest = (step, i);
                }
            }
            let next = t + soonest.0.by;
            if next >= cap {
                return None;
            }
            if next <= t {
                break;
            }
            (t, begins) = (next, [false; 2]);
            if soonest.0.arrives(t) {
                break;
            }
        }
        Some((soonest.1, t))
    }
    /// The next end to touch or to part, when, and whether it touches from above.
    fn event(&self, contact: Contact, fresh: [bool; 2]) -> Option<(usize, f64, bool)> {
        if self.both() {
            return self.parting(f64::INFINITY, fresh).map(|(i, t)| (i, t, false));
        }
        let mut event: Option<(usize, f64, bool)> = None;
        // The end in contact first: when it parts is soon known.
        let first = usize::from(self.on[1]);
        for i in [first, 1 - first] {
            let cap = event.map_or(f64::INFINITY, |(_, t, _)| t);
            let next = if self.on[i] {
                self.parting(cap, fresh).map(|(_, t)| (t, false))
            } else if self.on == [false; 2] {
                self.start.touching(i, contact.delay(), cap, fresh[i])
            } else {
                self.touching(i, cap, fresh[i])
            };
            event = next.map(|(t, above)| (i, t, above)).or(event);
        }
        event
    }
    /// Whether the one end in contact, at fixed lever arms, never parts any more after the time t.
    fn presses_for_good(&self, t: f64) -> bool {
        let [mode, _] = self.modes;
        (1.0 + self.delay * mode.root) * mode.bounds(mode.at(t)).0[0] < -mode.rest
    }
    /// When free end j comes into contact.
    fn touching(&self, j: usize, cap: f64, fresh: bool) -> Option<(f64, bool)> {
        let delay = self.delay;
        let share = (self.cross / self.mu[1 - j]).abs();
        let modes_at = self.kept_modes_at();
        let bounds = |t: f64| {
            let ([_, second, third], _) = self.modes[0].bounds(modes_at(t)[0]);
            [self.fall[j].abs() + share * (self.fall[1 - j].abs() + second), share * third]
        };
        next_contact(delay, cap, fresh, |t| self.end(j, t, &modes_at(t)), bounds, |_| 0.0)
    }
    /// Time in which the vibration dies down to `SHARE`.
    fn ringing_s(&self) -> f64 {
        -SHARE.ln() / self.modes[0].decay().min(self.modes[1].decay())
    }
}

/// First time at which a free end comes into contact: at zero from above, or below zero when h + θ h′ falls to zero.
///
/// `end` gives height, velocity and acceleration, `bounds` from a time on at least −h″ and |h‴|, `clear` a time
/// known to be free from a time on. Says whether it comes from above.
fn next_contact(
    delay: f64,
    cap: f64,
    fresh: bool,
    end: impl Fn(f64) -> [f64; 3],
    bounds: impl Fn(f64) -> [f64; 2],
    clear: impl Fn(f64) -> f64,
) -> Option<(f64, bool)> {
    let mut t = 0.0;
    let mut first = fresh;
    loop {
        let [h, v, a] = end(t);
        if h > 0.0 {
            break;
        }
        let lift = h + delay * v;
        if lift <= 0.0 && !first {
            return Some((t, false));
        }
        let [fall, third] = bounds(t);
        let next = t + safe_step(lift.max(0.0), v + delay * a, fall + delay * third);
        if next.is_nan() || next >= cap {
            return None;
        }
        if next <= t {
            return Some((t, false));
        }
        (t, first) = (next, false);
    }
    let step = |t: f64, now: [f64; 3]| {
        let [fall, third] = bounds(t);
        far_step(now, fall, third).max(clear(t))
    };
    first_zero(t, cap, end, step).map(|t| (t, true))
}

/// Accelerations and forces at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Heights of ends a and b; negative where the contact is compressed.
    pub height_m: [f64; 2],
    /// Vertical velocities of ends a and b.
    pub velocity_m_s: [f64; 2],
    /// Vertical accelerations of ends a and b, gravity included.
    pub acceleration_m_s2: [f64; 2],
    /// Forces of the ground on ends a and b over the mass of the body.
    pub force_per_mass_m_s2: [f64; 2],
}

impl Sample {
    /// Vertical acceleration at position `s` in [−1, 1] along the body (−1 is end a).
    #[must_use]
    pub fn acceleration_at(&self, s: f64) -> f64 {
        0.5 * ((1.0 - s) * self.acceleration_m_s2[0] + (1.0 + s) * self.acceleration_m_s2[1])
    }
}

/// The time in which a strike presses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pulse {
    /// Number of the strike it belongs to.
    pub strike: u64,
    /// First touch.
    pub from_s: f64,
    /// Last parting; infinite if the end stays down for good.
    pub until_s: f64,
}

/// A flight with contacts that take time, and its whole history.
#[derive(Debug, Clone)]
pub struct CompliantFlight {
    /// Strikes and stop; times are those of touching, Δv is what the force of that contact does in all: of one that
    /// stays down for good until both ends are still, from when neither parts any more beside carrying the weight.
    pub flight: Flight,
    /// Beginning and end of each strike's contact.
    pub pulses: Vec<Pulse>,
    /// Energy that the kept lever arms have made or lost, summed over all contacts without regard to sign, over the
    /// energy of the body at the first touch (the ground at height 0). Above 0.1, take late strikes for the right kind
    /// and not for the right size; a shorter contact time lowers it in proportion.
    pub energy_error: f64,
    phases: Vec<(f64, Phase)>,
}

impl CompliantFlight {
    /// When each phase begins, in order from 0, and which ends press in it. Within a phase every force is smooth; a
    /// long contact is cut into phases where its lever arms are renewed.
    pub fn phases_s(&self) -> impl Iterator<Item = (f64, [bool; 2])> + '_ {
        self.phases.iter().map(|(from, phase)| (*from, phase.on))
    }
    /// Velocities of both ends as the phase of this number begins, if there is one.
    #[must_use]
    pub fn velocity_in(&self, phase: usize) -> Option<[f64; 2]> {
        self.phases.get(phase).map(|(_, phase)| phase.start.ends.v)
    }
    /// Height and velocity of both ends along the phase of this number in [`phases_s`](Self::phases_s), with the time
    /// since its beginning: there and after each of some steps, which last `step_s` doubled so many times, none shorter
    /// than the one before.
    ///
    /// # Accuracy
    /// One exponential and one sine serve all steps, turned on by multiplication: each of n steps loses a rounding or
    /// two of the motion, and a doubling doubles what is lost before.
    ///
    /// ```
    /// use clatter::flight::{Body, Scene};
    /// let flight = Scene::new(Body::new(0.14, 0.0404)?, 0.5, 4.43, 5.0, 9.81)?.simulate_compliant(1e-4)?;
    /// let steps: Vec<_> = flight.steps_in(0, 1e-5, &[0, 0, 1]).collect();
    /// assert!((steps[3].0 - 4e-5).abs() < 1e-20);
    /// assert!((steps[3].1[0].0 - flight.sample(4e-5).height_m[0]).abs() < 1e-15);
    /// # Ok::<(), clatter::Error>(())
    /// ```
    pub fn steps_in(
        &self,
        phase: usize,
        step_s: f64,
        doublings: &[u32],
    ) -> impl Iterator<Item = (f64, [(f64, f64); 2])> {
        let phase = &self.phases[phase.min(self.phases.len() - 1)].1;
        let free = phase.on == [false; 2];
        let first = phase.modes[0].turn(step_s);
        let mut turns = [first, if phase.both() { phase.modes[1].turn(step_s) } else { first }];
        let (mut modes, mut t) = (phase.modes_at(0.0), 0.0);
        let (mut step, mut level) = (step_s, 0);
        let motion = move |doublings: Option<&u32>| {
            if let Some(&doublings) = doublings {
                while level < doublings {
                    turns = [0, 1].map(|k| phase.modes[k].twice(turns[k]));
                    (level, step) = (level + 1, 2.0 * step);
                }
                modes = [0, 1].map(|k| phase.modes[k].turned(modes[k], turns[k]));
                t += step;
            }
            let end = |i| if free { phase.start.end(i, t) } else { phase.end(i, t, &modes) };
            (t, [0, 1].map(end).map(|[h, v, _]| (h, v)))
        };
        std::iter::once(None).chain(doublings.iter().map(Some)).map(motion)
    }
    /// Heights, velocities, accelerations and forces at a time since the first touch.
    #[must_use]
    pub fn sample(&self, time_s: f64) -> Sample {
        let n = self.phases.partition_point(|(from, _)| *from <= time_s);
        let phase = n.saturating_sub(1);
        self.sample_in(phase, (time_s - self.phases[phase].0).max(0.0))
    }
    /// The same at a time since the beginning of the phase of this number in [`phases_s`](Self::phases_s), the last one
    /// where there are fewer, as that phase has them.
    #[must_use]
    pub fn sample_in(&self, phase: usize, after_s: f64) -> Sample {
        let (phase, t) = (&self.phases[phase.min(self.phases.len() - 1)].1, after_s);
        let free = phase.on == [false; 2];
        let ends = if free { [0, 1].map(|i| phase.start.end(i, t)) } else { phase.ends(t) };
        Sample {
            height_m: ends.map(|e| e[0]),
            velocity_m_s: ends.map(|e| e[1]),
            acceleration_m_s2: ends.map(|e| e[2]),
            force_per_mass_m_s2: [0, 1].map(|i| if free { 0.0 } else { phase.force(i, ends[i]) }),
        }
    }
}

/// Simulates until rest (both ends press for good; the bound of the time is that of the vibration left), or a limit.
/// `enough` is asked before each strike but the first, of the flight up to there, and ends it as the impact limit
/// would.
pub(super) fn simulate(
    scene: &Scene,
    contact: Contact,
    mut enough: impl FnMut(&CompliantFlight) -> bool,
) -> CompliantFlight {
    let mut log = Log::new(scene);
    let mut time = Clock::default();
    let mut pose = Pose::start(scene);
    let mut on = [true, false];
    // Ends whose last event is now: their force is zero by rounding only.
    let mut fresh = [true, false];
    let mut kappa = [pose.stiffness(0, contact), 0.0];
    // Whether the contact has outlasted a phase.
    let mut long = false;
    let mut phases = Vec::with_capacity(32);
    let mut pulses: Vec<Pulse> = Vec::with_capacity(16);
    let mut strike_of = [0_usize; 2];
    let most = PHASES + 16 * scene.impact_limit();
    let opened = pose.energy();
    let mut misfit = 0.0;
    // The limit is at least one strike.
    log.strike(End::A, 0.0, pose.ends.v[0], [0.0; 2], &pose.after(), &mut |_| false);
    pulses.push(Pulse { strike: 1, from_s: 0.0, until_s: f64::INFINITY });
    loop {
        let free = on == [false; 2];
        let pivots = long && on != [true; 2];
        let longest = if free { f64::INFINITY } else { pose.longest(contact, pivots) };
        let halfway = if pivots { pose.halfway(usize::from(on[1]), 0.5 * longest) } else { pose };
        phases.push((time.now(), Phase::new(pose, &halfway, on, contact, kappa, long)));
        let phase = &phases[phases.len() - 1].1;
        let event = phase.event(contact, fresh);
        if event.is_none() && phase.both() {
            // Neither end will ever part: proven by the energy of the vibration.
            let time_bound_s = phase.ringing_s();
            let impulses = phase.solve(pose.ends.v.map(|v| -v));
            for (k, last) in strike_of.into_iter().enumerate() {
                let strike = &mut log.flight.strikes[last];
                phase.push(strike, k, impulses);
                (strike.velocity_m_s, strike.spin_rad_s) = ([0.0; 2], 0.0);
            }
            log.flight.stop = Stop::AtRest { time_s: time.now(), time_bound_s, shock_bound_m_s: 0.0 };
            break;
        }
        let event = event.filter(|(_, t, _)| *t <= longest);
        let dt = event.map_or(longest, |(_, t, _)| t);
        if dt == f64::INFINITY {
            log.bounced_clear();
            break;
        }
        time.add(dt);
        // A time that no contact has digits for is none.
        if dt > f64::EPSILON * contact.time {
            fresh = [false; 2];
        }
        if time.now() > log.time_limit_s || phases.len() >= most {
            log.flight.stop = Stop::TimeLimit { time_s: time.now().min(log.time_limit_s) };
            break;
        }
        if free {
            pose = pose.flown(dt);
        } else {
            let ends = phase.ends(dt);
            let mut impulses = phase.impulses(dt, &ends);
            let parts = !long && event.is_some_and(|(i, ..)| on[i]);
            let stays = long || event.is_none() && phase.presses_for_good(dt);
            pose = phase.pose(dt, &ends, &mut impulses, parts, stays);
            misfit += (pose.energy() - phase.start.energy() - phase.work(&ends)).abs();
            for k in (0..2).filter(|&k| on[k]) {
                phase.push(&mut log.flight.strikes[strike_of[k]], k, impulses);
            }
        }
        long = event.is_none();
        let Some((i, _, above)) = event else { continue };
        fresh[i] = true;
        on[i] = !on[i];
        if on[i] {
            // Below zero it comes back into the contact that it has hardly left.
            let again = !above && pose.ends.v[i] >= 0.0;
            if again && kappa[i] > 0.0 {
                pulses[strike_of[i]].until_s = f64::INFINITY;
            } else {
                // The flight so far, lent.
                let flight = std::mem::replace(&mut log.flight, Flight::NONE);
                let mut so_far = CompliantFlight { flight, pulses, energy_error: misfit / opened, phases };
                so_far.flight.stop =
                    Stop::ImpactLimit { time_s: so_far.flight.strikes.last().map_or(0.0, |s| s.time_s) };
                let over = enough(&so_far);
                CompliantFlight { flight: log.flight, pulses, phases, .. } = so_far;
                if over {
                    break;
                }
                pose.ends.h[i] = if above { 0.0 } else { pose.ends.h[i].min(0.0) };
                kappa[i] = pose.stiffness(i, contact);
                strike_of[i] = log.flight.strikes.len();
                // A touch that grazes has no approach, whatever rounding says.
                if !log.strike(end_of(i), time.now(), pose.ends.v[i].min(0.0), [0.0; 2], &pose.after(), &mut |_| false)
                {
                    break;
                }
                pulses.push(Pulse { strike: pulses.len() as u64 + 1, from_s: time.now(), until_s: f64::INFINITY });
            }
        } else {
            pulses[strike_of[i]].until_s = time.now();
            let strike = &mut log.flight.strikes[strike_of[i]];
            (strike.velocity_m_s, strike.spin_rad_s) = (pose.ends.v, pose.spin);
        }
    }
    CompliantFlight { flight: log.flight, pulses, energy_error: misfit / opened, phases }
}

impl Pose {
    /// The same body turned by an angle.
    fn turned(&self, angle: f64) -> Self {
        let (s, c) = angle.sin_cos();
        let (sin, cos) = (self.sin * c + self.cos * s, self.cos * c - self.sin * s);
        let norm = sin.hypot(cos);
        Self { sin: sin / norm, cos: cos / norm, ..*self }
    }
    /// Longest phase with ends in contact: a strike itself is never cut, as its energy is exact while its lever arm is
    /// kept; what lasts is, and the lever arms renewed.
    fn longest(&self, contact: Contact, pivots: bool) -> f64 {
        let [a, b] = self.body.arms_m();
        let (spin, fastest) = (self.spin.abs(), self.gravity / a.min(b));
        if pivots {
            // spin t + ½ fastest t² = PIVOT
            2.0 * PIVOT / (spin + (spin * spin + 2.0 * PIVOT * fastest).sqrt())
        } else {
            (TURN / (spin + fastest.sqrt())).max(2.0 * contact.time)
        }
    }
    /// The pose after a time in which end i lies still and the body turns about it, about.
    fn halfway(&self, i: usize, t: f64) -> Self {
        let x = self.levers()[i];
        let turning = -x * self.acceleration(i) / (self.body.gyration_m().powi(2) + x * x);
        let angle = t * (self.spin + 0.5 * turning * t);
        Self { spin: self.spin + turning * t, ..self.turned(angle) }
    }
    /// When free end i comes into contact.
    fn touching(&self, i: usize, delay: f64, cap: f64, fresh: bool) -> Option<(f64, bool)> {
        let arm = self.body.arms_m()[i];
        let w = self.spin.abs();
        let bounds = [self.gravity + arm * w * w, arm * w * w * w];
        next_contact(delay, cap, fresh, |t| self.end(i, t), |_| bounds, |t| self.clear(i, t))
    }
    /// The pose after a flight of time t.
    fn flown(&self, t: f64) -> Self {
        let mut next = self.turned(self.spin * t);
        for i in 0..2 {
            [next.ends.h[i], next.ends.v[i], _] = self.end(i, t);
        }
        next
    }
    /// Stiffness of the contact that gives a lone end its frequency at this angle, over the mass of the body.
    fn stiffness(&self, i: usize, contact: Contact) -> f64 {
        let x = self.levers()[i];
        contact.frequency.powi(2) / (1.0 + (x / self.body.gyration_m()).powi(2))
    }
}

#[cfg(test)]
mod tests;
