//! Points that lie, bodies at rest, and bounds on their later motion.

use super::phase::Hold;
use super::pose::{Borne, Pose, Pushes, solve};
use super::run::Run;
use super::touch::{Event, State, Touch};
use crate::flight::Stop;
use crate::motion::Ahead;

/// The least depth over the resolution of heights.
const SUNK: f64 = 16.0;

/// The multiple of the energy of a suddenly applied weight up to which energy does not rise again: with that, both ends
/// press in turn, each deeper in its dent, and no force is more than four times the weight that the point carries.
/// (Between 2 and 3 times is the level that bodies with q = 0.7 keep up for ever, as the ground yields.)
const BY_WEIGHT: f64 = 4.0;

/// The factor on the weight of a point by which its force may swing: it does not part then, or parts so slowly that it
/// soon does not.
const PARTS: f64 = 1.001;

/// A body over the points that would carry its weight.
struct Weighed<const N: usize> {
    forces: [f64; N],
    /// Its energy above that at rest there, on the present lines.
    left: f64,
    /// The same energy if one of them may leave its line: a point that parts from its dent or bears more than ever
    /// before loads it further and sinks.
    yielding: f64,
    /// The energy above rest if these points were suddenly loaded by their weight, from no depth and no speed.
    by_weight: f64,
}

impl<P: Pose<N>, const N: usize> Run<'_, P, N> {
    /// Stops the points that lie.
    pub(super) fn stop_lying(&mut self) {
        let lying = self.touches.map(|touch| touch.state == State::Lying);
        if lying.contains(&true) {
            let arms = self.pose.arms();
            let stopped = self.pose.points_by(&arms).1.map(|velocity| -velocity);
            let impulse = solve(|i, j| self.pose.coupling(&arms, i, j), &lying, stopped);
            self.pushed(&lying, impulse);
            self.pose = self.pose.after(0.0, &arms, &Pushes { impulse, path: [0.0; N] });
        }
    }

    /// Books impulses over the mass at some points.
    pub(super) fn pushed(&mut self, points: &[bool; N], impulses: [f64; N]) {
        let arms = self.pose.arms();
        for i in (0..N).filter(|&i| points[i]) {
            self.book(i, std::array::from_fn(|j| self.pose.coupling(&arms, i, j) * impulses[i]));
        }
    }

    /// Returns the speed below which motion is not followed: by the precision, or because roundings of heights exceed
    /// the depth.
    pub(super) fn slow(&self) -> f64 {
        let stiffest = self.contacts.iter().fold(0.0_f64, |most, contact| most.max(contact.frequency_rad_s()));
        (self.precision * self.fastest).max(SUNK * self.margins.height * stiffest)
    }

    /// Lays down a point that alone presses and rings too slowly to be followed, or by less than its weight.
    pub(super) fn lay_down(&mut self) {
        let mut pressing = (0..N).filter(|&i| self.touches[i].is_pressing());
        let (Some(i), None) = (pressing.next(), pressing.next()) else { return };
        let Hold::On(line) = self.touches[i].hold(&self.contacts[i]) else { return };
        let loads = self.touches[i].state == State::Loading && self.leave_dents();
        let fall = self.pose.fall(i);
        if loads || fall <= 0.0 {
            return;
        }
        let (height, velocity) = self.pose.points();
        let rate = (line.stiffness * self.pose.coupled(i, i)).sqrt();
        let rest = line.zero - fall / (rate * rate);
        // The point must be below its rest, where its spring holds no less than its weight: else lying would give it
        // the missing force.
        let rings_by_weight = self.leave_dents() && height[i] <= rest;
        let by_weight = if rings_by_weight { PARTS * fall / rate } else { 0.0 };
        if libm::hypot(velocity[i], rate * (height[i] - rest)) <= self.slow().max(by_weight) {
            let (contact, resolution) = (&self.contacts[i], SUNK * self.margins.height);
            let force = fall / self.pose.coupled(i, i);
            let touch = &mut self.touches[i];
            touch.state = State::Lying;
            // A point whose depth is below the resolution of heights carries its weight.
            if touch.limit(contact) < force && force < resolution * touch.stiffness {
                touch.ground = touch.crest + 2.0 * force / touch.stiffness;
            }
        }
    }

    /// Puts lying points back on their own lines, to respond to another one through the body; upright lines have none.
    pub(super) fn rouse_others(&mut self, striking: usize) {
        let (height, _) = self.pose.points();
        for i in 0..N {
            if i == striking || self.touches[i].state != State::Lying || self.contacts[i].is_plastic() {
                continue;
            }
            let pushed = |j: usize| match self.touches[j].hold(&self.contacts[j]) {
                Hold::On(line) => self.pose.coupled(i, j) * line.stiffness * (line.zero - height[j]).max(0.0),
                Hold::No | Hold::Lies => 0.0,
            };
            let force = (self.pose.fall(i) - (0..N).map(pushed).sum::<f64>()) / self.pose.coupled(i, i);
            self.touches[i].rouse(height[i], force.max(0.0), &self.contacts[i]);
        }
    }

    /// Returns the state of the motion and bounds on its continuation.
    pub(super) fn ahead(&self, lands: bool) -> Ahead<N> {
        let strikes = &self.log.flight.strikes;
        let down = (0..N).filter(|&i| self.touches[i].is_pressing());
        // The body may yet come to lie on a lower side.
        let most = self.weighed().map(|of| 2.0 * self.fastest_by(of.yielding + self.pose.lower()));
        let unfinished = down.flat_map(|i| strikes[self.touches[i].strike].delta_v_m_s);
        Ahead {
            time_s: self.time.now(),
            struck: self.log.struck,
            largest_m_s: unfinished.fold(self.log.largest_m_s, |most, dv| most.max(dv.abs())),
            most_m_s: most.unwrap_or(f64::INFINITY),
            lands,
        }
    }

    /// Returns a bound on the speed of every point with this energy.
    fn fastest_by(&self, energy: f64) -> f64 {
        (2.0 * energy.max(0.0) * self.extent.coupling).sqrt()
    }

    /// Returns the forces of the ground on the body if it is at rest, and a bound on later velocity shocks.
    pub(super) fn rests(&mut self) -> Option<([f64; N], f64)> {
        if let Some(forces) = self.lies_still() {
            return Some((forces, 0.0));
        }
        let slow = self.slow();
        if self.pose.gravity() == 0.0 {
            let fastest = self.fastest_by(self.pose.kinetic());
            // No point is on a line of its law, which would hold energy, and not all are in the air.
            let holds = |touch: &Touch| matches!(touch.state, State::Loading | State::Elastic);
            let down = self.touches.iter().any(|touch| touch.state != State::Away) && !self.touches.iter().any(holds);
            return (down && fastest <= slow).then_some(([0.0; N], 2.0 * fastest));
        }
        let Weighed { forces, left, yielding, by_weight } = self.weighed()?;
        let struck = |i: usize| self.log.flight.strikes.iter().any(|strike| strike.point == i);
        ((self.fastest_by(left) <= slow || left <= BY_WEIGHT * by_weight)
            && (0..N).all(|i| forces[i] <= 0.0 || struck(i)))
        .then_some((forces, 2.0 * self.fastest_by(yielding)))
    }

    /// Returns the body on the points that would bear its weight; `None` where they cannot.
    fn weighed(&self) -> Option<Weighed<N>> {
        let arms = self.pose.arms();
        let (height, _) = self.pose.points_by(&arms);
        let line = |i: usize| self.line(&arms, i, height[i]);
        let Borne { on, forces } = self.pose.borne(&arms, &height, line)?;
        let those = || (0..N).filter(|&i| on[i]);
        // Springs that press elsewhere hold energy too.
        let left = self.pose.kinetic() + (0..N).map(|i| over(line(i), height[i], forces[i])).sum::<f64>();
        let by_weight = those().map(|i| 0.5 * forces[i] * forces[i] / self.stiffness(&arms, i)).sum::<f64>();
        let dented = |i: &usize| self.leave_dents() && matches!(self.touches[*i].state, State::Elastic | State::Lying);
        let unloaded = || those().filter(dented);
        let loading = |i: usize| 0.5 * forces[i] * forces[i] / self.touches[i].stiffness;
        let softer = |i: usize| self.contacts[i].unloading().recip();
        // The point is too slow to part, and has been pressed by its whole load before.
        let stays = |i: usize| left < loading(i) * softer(i) && forces[i] <= self.touches[i].limit(&self.contacts[i]);
        let sinking =
            if unloaded().all(stays) { 0.0 } else { unloaded().map(|i| loading(i) * (1.0 - softer(i))).sum() };
        let yielding = left + sinking;
        Some(Weighed { forces, left, yielding, by_weight })
    }

    /// Returns stiffness and zero of the line on which a point at this height is or would be. A point that lies stays
    /// where it is under any weight.
    fn line(&self, arms: &P::Arms, i: usize, height: f64) -> [f64; 2] {
        let touch = &self.touches[i];
        match (touch.state, self.leave_dents()) {
            (State::Away, _) => [self.stiffness(arms, i), 0.0],
            (State::Loading, _) | (State::Parted, false) => [touch.stiffness, touch.ground],
            (State::Parted, true) => [self.stiffness(arms, i), touch.zero],
            (State::Elastic, _) => [touch.stiffness * self.contacts[i].unloading(), touch.zero],
            (State::Lying, _) => [f64::INFINITY, height],
        }
    }

    /// Returns the forces on a body that lying points hold. Where they cannot carry it, one of them parts or loads
    /// further.
    fn lies_still(&mut self) -> Option<[f64; N]> {
        loop {
            let lying = self.touches.map(|touch| touch.state == State::Lying);
            if !lying.contains(&true) {
                return None;
            }
            let (height, _) = self.pose.points();
            let forces = std::array::from_fn(|k| match self.touches[k].hold(&self.contacts[k]) {
                Hold::On(line) => line.stiffness * (line.zero - height[k]).max(0.0),
                Hold::No | Hold::Lies => 0.0,
            });
            let forces = self.pose.held_by(&lying, &forces)?;
            let those = || (0..N).filter(|&k| lying[k]);
            if let Some(k) = those().find(|&k| forces[k] < 0.0) {
                self.apply(k, Event::Parts);
            } else if let Some(k) = those().find(|&k| forces[k] > self.touches[k].limit(&self.contacts[k])) {
                self.apply(k, Event::Reloads);
            } else {
                return Some(forces);
            }
        }
    }

    /// Ends the flight at rest: the rest of the motion is taken by the points that carry the weight, or by the one that
    /// lies.
    pub(super) fn rest(&mut self, forces: [f64; N], shock_bound_m_s: f64) {
        self.unrested = Some(self.pose);
        let carrying: [bool; N] = std::array::from_fn(|i| forces[i] > 0.0 || self.touches[i].state == State::Lying);
        let lone = || (0..N).find(|&i| self.touches[i].state != State::Away);
        if let Some(impulses) = self.pose.stopping(&carrying) {
            self.pushed(&impulses.map(|impulse| impulse.is_some()), impulses.map(|impulse| impulse.unwrap_or(0.0)));
            for i in (0..N).filter(|&i| impulses[i].is_some()) {
                self.presses[self.touches[i].strike].until_s = f64::INFINITY;
            }
        } else if let Some(i) = (0..N).find(|&i| carrying[i]).or_else(lone) {
            // Without gravity one point lies alone, or both bounce in their dents ever more slowly.
            self.book(i, self.pose.points().1.map(|velocity| -velocity));
        }
        self.pose = self.pose.still();
        self.resting = forces;
        self.log.flight.stop = Stop::AtRest { time_s: self.time.now(), time_bound_s: f64::INFINITY, shock_bound_m_s };
    }
}

/// Returns the energy of a point under a weight over its least value, by its line.
///
/// Loading it deeper takes more energy than the ground there gives: from a force above twice its weight on, the
/// remaining energy never rises.
fn over([stiffness, zero]: [f64; 2], height: f64, weight: f64) -> f64 {
    if stiffness == f64::INFINITY {
        return 0.0;
    }
    let energy = |h: f64| weight * h + if h < zero { 0.5 * stiffness * (zero - h).powi(2) } else { 0.0 };
    (energy(height) - energy(zero - weight / stiffness)).max(0.0)
}
