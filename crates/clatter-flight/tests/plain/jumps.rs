//! A plate by Newton's laws, instant impacts: small time steps, bisection, a corner that no longer bounces held by a force of its own.

use clatter_flight::{Plate, PlateScene};

/// Height and slopes of the plate, or their rates, or what a push does to these.
type Motion = [f64; 3];

#[derive(Clone, Copy, Debug)]
pub(crate) struct Jumps {
    plate: Plate,
    e: f64,
    gravity: f64,
    speed: f64,
    place: Motion,
    rate: Motion,
    held: [bool; 4],
    /// The corner that struck last, which is on the ground whatever roundings make of it.
    down: [bool; 4],
    pub(crate) time: f64,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Jump {
    pub(crate) corner: usize,
    pub(crate) time: f64,
    pub(crate) approach: f64,
    pub(crate) delta_v: [f64; 4],
    /// Another corner comes down within a millionth of the time of a fall from the first speed, so that roundings tell which is first.
    pub(crate) close: bool,
}

/// A rebound that is slower, over the first speed, is none.
const DEAD: f64 = 1e-9;

impl Jumps {
    pub(crate) fn new(scene: &PlateScene, e: f64) -> Self {
        let plate = scene.plate();
        let ([length, width], [hx, hy], [sx, sy]) = (plate.sides_m(), scene.gaps_m(), scene.spin_rad_s());
        let [left, _, front, _] = plate.edges_m();
        let (x, y) = (hx / length, hy / width);
        Self {
            plate,
            e,
            gravity: scene.gravity_m_s2(),
            speed: scene.speed_m_s(),
            place: [left * x + front * y, x, y],
            rate: [-scene.speed_m_s(), sx, sy],
            held: [false; 4],
            down: [true, hx == 0.0, hx + hy == 0.0, hy == 0.0],
            time: 0.0,
        }
    }
    fn at(&self, of: Motion, i: usize) -> f64 {
        let [x, y] = self.plate.corners_m()[i];
        of[0] + x * of[1] + y * of[2]
    }
    fn height(&self, i: usize) -> f64 {
        if self.down[i] { 0.0 } else { self.at(self.place, i) }
    }
    /// What an impulse of 1 over the mass at a corner does: the moment balance C (x″, y″) = r by Cramer's rule.
    fn push(&self, i: usize) -> Motion {
        let [x, y] = self.plate.corners_m()[i];
        let ([kx, ky], c) = (self.plate.gyration_m(), self.plate.product_of_inertia_m2());
        let determinant = kx * kx * ky * ky - c * c;
        [1.0, (x * ky * ky - y * c) / determinant, (y * kx * kx - x * c) / determinant]
    }
    fn add(to: Motion, share: f64, of: Motion) -> Motion {
        [0, 1, 2].map(|k| to[k] + share * of[k])
    }
    /// What is left of a motion where pushes at these corners stop them, and whether each only pushes: of two by turns, until nothing
    /// changes.
    fn stopped(&self, mut of: Motion, corners: [bool; 4]) -> (Motion, [f64; 4]) {
        let mut pushes = [0.0; 4];
        for _ in 0..4000 {
            let before = of;
            for i in (0..4).filter(|&i| corners[i]) {
                let push = self.push(i);
                let share = -self.at(of, i) / self.at(push, i);
                pushes[i] += share;
                of = Self::add(of, share, push);
            }
            if (0..3).all(|k| of[k].to_bits() == before[k].to_bits()) {
                break;
            }
        }
        (of, pushes)
    }
    fn strike(&mut self, i: usize, close: bool) -> Jump {
        let (push, approach, before) = (self.push(i), self.at(self.rate, i), self.rate);
        self.rate = Self::add(self.rate, -(1.0 + self.e) * approach / self.at(push, i), push);
        let delta_v = std::array::from_fn(|k| self.at(self.rate, k) - self.at(before, k));
        self.down[i] = true;
        Jump { corner: i, time: self.time, approach, delta_v, close }
    }
    fn after(&self, fall: Motion, t: f64) -> Self {
        let place = Self::add(Self::add(self.place, t, self.rate), 0.5 * t * t, fall);
        Self { place, rate: Self::add(self.rate, t, fall), time: self.time + t, ..*self }
    }
    /// A corner that is below the ground and sinks.
    fn sinks(&self, i: usize) -> bool {
        !self.held[i] && self.at(self.place, i) < 0.0 && self.at(self.rate, i) < 0.0
    }
    /// The next strike; none once the plate lies, or after so many steps.
    pub(crate) fn next(&mut self, step: f64, steps: usize) -> Option<Jump> {
        let dead = DEAD * self.speed;
        for _ in 0..steps {
            // What is on the ground strikes at once, without end if nothing were dead.
            let falls = |i: usize| self.down[i] && self.at(self.rate, i) < -dead;
            if let Some(i) = (0..4).find(|&i| falls(i)) {
                let close = (0..4).filter(|&k| falls(k)).count() > 1;
                return Some(self.strike(i, close));
            }
            self.held = std::array::from_fn(|i| self.down[i] && self.at(self.rate, i).abs() <= dead);
            if self.held.iter().filter(|held| **held).count() > 2 {
                return None;
            }
            self.rate = self.stopped(self.rate, self.held).0;
            let (mut fall, mut forces) = self.stopped([-self.gravity, 0.0, 0.0], self.held);
            if let Some(i) = (0..4).find(|&i| forces[i] < 0.0) {
                self.held[i] = false;
                (fall, forces) = self.stopped([-self.gravity, 0.0, 0.0], self.held);
            }
            assert!(forces.iter().all(|force| *force >= 0.0), "no corner is held down");
            let then = self.after(fall, step);
            let sinking = |of: &Self| (0..4).any(|i| of.sinks(i));
            if !sinking(&then) {
                let held = self.held;
                *self = then;
                self.down = held;
                continue;
            }
            let (mut lo, mut hi) = (0.0, step);
            for _ in 0..80 {
                let mid = 0.5 * (lo + hi);
                if sinking(&self.after(fall, mid)) { hi = mid } else { lo = mid }
            }
            let held = self.held;
            *self = self.after(fall, hi);
            self.down = held;
            let i = (0..4).find(|&i| self.sinks(i))?;
            let soon = 1e-6 * self.speed / self.gravity;
            let lands = |k: usize| !held[k] && k != i && self.height(k) + soon * self.at(self.rate, k) < 0.0;
            let close = (0..4).any(lands);
            let jump = self.strike(i, close);
            if jump.approach < -dead {
                return Some(jump);
            }
        }
        None
    }
}
