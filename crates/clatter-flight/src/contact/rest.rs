//! What lies, what rests, and what may still come.

use super::Ahead;
use super::law::ContactLaw;
use super::phase::Hold;
use super::run::Run;
use super::touch::{Event, State, Touch};
use crate::flight::Stop;

/// A depth must be so many times what heights are told apart by.
const SUNK: f64 = 16.0;

/// So many times the energy of a weight that comes to press at once do not rise from it: with that, both ends press in turn, each
/// deeper in its dent, and no force is more than four times the weight that the point carries. (Between 2 and 3 times is what bodies
/// with q = 0.7 keep up for ever, as the ground gives way.)
const BY_WEIGHT: f64 = 4.0;

/// A point whose force swings by its weight and this more does not part, or parts so slowly that it soon does not.
const PARTS: f64 = 1.001;

/// A body over the points that would carry its weight.
struct Weighed<const N: usize> {
    on: [usize; 2],
    forces: [f64; N],
    /// Its energy over that at rest there.
    left: f64,
    /// What that is where both points come to press with their weight at once, from no depth and no speed.
    by_weight: f64,
}

impl<const N: usize> Run<'_, N> {
    /// What a force at point i does to point j.
    pub(super) fn share(&self, i: usize, j: usize) -> f64 {
        let x = self.pose.levers().x;
        1.0 + x[i] * x[j] / self.pose.rho2
    }

    /// Takes the velocity of a point that lies.
    pub(super) fn stop_point(&mut self, i: usize) {
        let (_, velocity) = self.pose.points();
        let impulse = -velocity[i] / self.share(i, i);
        self.pushed(i, impulse);
        self.pose = self.pose.pushed(impulse, self.pose.levers().x[i]);
    }

    /// Books an impulse over the mass.
    pub(super) fn pushed(&mut self, i: usize, impulse: f64) {
        self.book(i, std::array::from_fn(|j| self.share(i, j) * impulse));
    }

    /// The speed that is not followed: by the precision, or because roundings of heights are deeper than it sinks in.
    pub(super) fn slow(&self) -> f64 {
        (self.precision * self.fastest).max(SUNK * self.margins.height * self.contact.frequency_rad_s())
    }

    /// Lays down a point that alone presses and rings too slowly to be followed, or by less than its weight.
    pub(super) fn lay_down(&mut self) {
        let mut pressing = (0..N).filter(|&i| self.touches[i].is_pressing());
        let (Some(i), None) = (pressing.next(), pressing.next()) else { return };
        let Hold::On(line) = self.touches[i].hold(self.contact) else { return };
        let loads = self.touches[i].state == State::Loading && self.contact.law() == ContactLaw::Hysteretic;
        let fall = self.pose.fall(i);
        if loads || fall <= 0.0 {
            return;
        }
        let (height, velocity) = self.pose.points();
        let rate = (line.stiffness * self.share(i, i)).sqrt();
        let rest = line.zero - fall / (rate * rate);
        let by_weight = if self.contact.law() == ContactLaw::Hysteretic { PARTS * fall / rate } else { 0.0 };
        if velocity[i].hypot(rate * (height[i] - rest)) <= self.slow().max(by_weight) {
            let (contact, told) = (self.contact, SUNK * self.margins.height);
            let force = fall / self.share(i, i);
            let touch = &mut self.touches[i];
            touch.state = State::Lying;
            // What sinks in by less than heights tell carries its weight.
            if touch.limit(contact) < force && force < told * touch.stiffness {
                touch.ground = touch.crest + 2.0 * force / touch.stiffness;
            }
        }
    }

    /// Points that lie answer on their own lines to what another one does through the body; upright lines have none.
    pub(super) fn rouse_others(&mut self, striking: usize) {
        if self.contact.is_plastic() {
            return;
        }
        let (height, _) = self.pose.points();
        for i in 0..N {
            if i == striking || self.touches[i].state != State::Lying {
                continue;
            }
            let pushed = |j: usize| match self.touches[j].hold(self.contact) {
                Hold::On(line) => self.share(i, j) * line.stiffness * (line.zero - height[j]).max(0.0),
                Hold::No | Hold::Lies => 0.0,
            };
            let force = (self.pose.fall(i) - (0..N).map(pushed).sum::<f64>()) / self.share(i, i);
            self.touches[i].rouse(height[i], force.max(0.0), self.contact);
        }
    }

    /// What may still come.
    pub(super) fn ahead(&self, lands: bool) -> Ahead {
        let strikes = &self.log.flight.strikes;
        let down = (0..N).filter(|&i| self.touches[i].is_pressing());
        // The body may yet come to lie on a lower side.
        let most = self.weighed().map(|Weighed { on, left, .. }| {
            let lower = self.pose.body.height_over(on).abs() - self.pose.body.lowest_m();
            2.0 * self.fastest_by(left + self.pose.gravity * lower.max(0.0))
        });
        let unfinished = down.flat_map(|i| strikes[self.touches[i].strike].delta_v_m_s);
        Ahead {
            time_s: self.time.now(),
            largest_m_s: unfinished.fold(self.log.largest_m_s, |most, dv| most.max(dv.abs())),
            most_m_s: most.unwrap_or(f64::INFINITY),
            lands,
        }
    }

    /// No point of the body is faster with this energy.
    fn fastest_by(&self, energy: f64) -> f64 {
        (2.0 * energy.max(0.0) * (1.0 + self.reach * self.reach / self.pose.rho2)).sqrt()
    }

    /// The forces of the ground on the body where it is at rest, and a bound of the velocity shocks that may still come.
    pub(super) fn rests(&mut self) -> Option<([f64; N], f64)> {
        if let Some(forces) = self.lies_still() {
            return Some((forces, 0.0));
        }
        let (kinetic, slow) = (self.kinetic(), self.slow());
        if self.pose.gravity == 0.0 {
            let fastest = self.fastest_by(kinetic);
            // Nothing on a line of its law, which would hold energy, and not all in the air.
            let holds = |touch: &Touch| matches!(touch.state, State::Loading | State::Elastic);
            let down = self.touches.iter().any(|touch| touch.state != State::Away) && !self.touches.iter().any(holds);
            return (down && fastest <= slow).then_some(([0.0; N], 2.0 * fastest));
        }
        let Weighed { on, forces, left, by_weight } = self.weighed()?;
        let fastest = self.fastest_by(left);
        let struck = |i: usize| self.log.flight.strikes.iter().any(|strike| strike.point == i);
        ((fastest <= slow || left <= BY_WEIGHT * by_weight) && on.into_iter().all(struck))
            .then_some((forces, 2.0 * fastest))
    }

    fn kinetic(&self) -> f64 {
        let turning = self.pose.rho2 * self.pose.spin * self.pose.spin;
        0.5 * (self.pose.v * self.pose.v + turning)
    }

    /// The body on its lowest points on both sides of its center of mass; none where there is none on one side.
    fn weighed(&self) -> Option<Weighed<N>> {
        let pose = &self.pose;
        let (x, (height, _)) = (pose.levers().x, pose.points());
        let lowest = |side: f64| {
            let there = (0..N).filter(|&i| side * x[i] > 0.0);
            there.min_by(|&i, &j| height[i].total_cmp(&height[j]))
        };
        let on = [lowest(-1.0)?, lowest(1.0)?];
        let [i, j] = on;
        let mut forces = [0.0; N];
        (forces[i], forces[j]) = (pose.gravity * x[j] / (x[j] - x[i]), -pose.gravity * x[i] / (x[j] - x[i]));
        let left = self.kinetic() + on.iter().map(|&i| self.over(i, height[i], forces[i])).sum::<f64>();
        let by_weight = on.iter().map(|&i| 0.5 * forces[i] * forces[i] / self.stiffness(i)).sum::<f64>();
        Some(Weighed { on, forces, left, by_weight })
    }

    /// Energy of a point under a weight over the least that it can have, by the line on which it is or would be.
    ///
    /// What loads it deeper takes more energy than the ground there gives: from a force above twice its weight on, the energy
    /// that is left never rises.
    fn over(&self, i: usize, height: f64, weight: f64) -> f64 {
        let touch = &self.touches[i];
        let unloading = touch.stiffness * self.contact.unloading();
        let (stiffness, zero) = match (touch.state, self.contact.law()) {
            (State::Away, _) => (self.stiffness(i), 0.0),
            (State::Loading, _) | (State::Parted, ContactLaw::Dashpot) => (touch.stiffness, touch.ground),
            (State::Parted, ContactLaw::Hysteretic) => (self.stiffness(i), touch.zero),
            (State::Elastic, _) => (unloading, touch.zero),
            (State::Lying, ContactLaw::Dashpot) => (touch.stiffness, height + weight / touch.stiffness),
            (State::Lying, ContactLaw::Hysteretic) => (unloading, height + weight / unloading),
        };
        let energy = |h: f64| weight * h + if h < zero { 0.5 * stiffness * (zero - h).powi(2) } else { 0.0 };
        (energy(height) - energy(zero - weight / stiffness)).max(0.0)
    }

    /// The forces on a body of which two points lie. Where they can not carry it, one of them parts or loads further.
    fn lies_still(&mut self) -> Option<[f64; N]> {
        loop {
            let (x, (height, _)) = (self.pose.levers().x, self.pose.points());
            let lying = || (0..N).filter(|&i| self.touches[i].state == State::Lying);
            let i = lying().min_by(|&i, &j| x[i].total_cmp(&x[j]))?;
            let j = lying().max_by(|&i, &j| x[i].total_cmp(&x[j]))?;
            if i == j {
                return None;
            }
            let mut forces = [0.0; N];
            for k in 0..N {
                if let Hold::On(line) = self.touches[k].hold(self.contact) {
                    forces[k] = line.stiffness * (line.zero - height[k]).max(0.0);
                }
            }
            let (weight, moment) =
                (0..N).fold((self.pose.gravity, 0.0), |(w, m), k| (w - forces[k], m - x[k] * forces[k]));
            forces[j] = (moment - x[i] * weight) / (x[j] - x[i]);
            forces[i] = weight - forces[j];
            if let Some(k) = [i, j].into_iter().find(|&k| forces[k] < 0.0) {
                self.apply(k, Event::Parts);
            } else if let Some(k) = [i, j].into_iter().find(|&k| forces[k] > self.touches[k].limit(self.contact)) {
                self.apply(k, Event::Reloads);
            } else {
                return Some(forces);
            }
        }
    }

    /// Ends the flight at rest: what is left of the motion is taken by the points that carry the weight, or by the
    /// one that lies.
    pub(super) fn rest(&mut self, forces: [f64; N], shock_bound_m_s: f64) {
        self.unrested = Some(self.pose);
        let x = self.pose.levers().x;
        let carries = |i: &usize| forces[*i] > 0.0 || self.touches[*i].state == State::Lying;
        let left = (0..N).filter(carries).min_by(|&i, &j| x[i].total_cmp(&x[j]));
        let right = (0..N).filter(carries).max_by(|&i, &j| x[i].total_cmp(&x[j]));
        if let (Some(i), Some(j)) = (left, right)
            && i != j
        {
            let pose = &self.pose;
            let impulse = (x[i] * pose.v - pose.rho2 * pose.spin) / (x[j] - x[i]);
            let other = -pose.v - impulse;
            self.pushed(i, other);
            self.pushed(j, impulse);
            for k in [i, j] {
                self.presses[self.touches[k].strike].until_s = f64::INFINITY;
            }
        } else if let Some(i) = left.or_else(|| (0..N).find(|&i| self.touches[i].state != State::Away)) {
            // Without gravity one point lies alone, or both bounce in their dents ever more slowly.
            self.book(i, self.pose.points().1.map(|velocity| -velocity));
        }
        (self.pose.v, self.pose.spin) = (0.0, 0.0);
        self.resting = forces;
        self.log.flight.stop = Stop::AtRest { time_s: self.time.now(), time_bound_s: 0.0, shock_bound_m_s };
    }
}
