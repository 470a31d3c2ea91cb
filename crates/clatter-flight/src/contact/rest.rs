//! What lies, what rests, and what may still come.

use super::Ahead;
use super::law::ContactLaw;
use super::phase::Hold;
use super::run::Run;
use super::touch::{Event, State};
use crate::flight::Stop;

/// A point that bounces more often in the dent that it has made is laid down: no motion so small goes on for so long
/// without loss, whatever the law says.
const BOUNCES: u32 = 256;

/// Phases after the last strike from which on a body of which two points are below the ground is taken to be at rest.
const PHASES: usize = 4 * BOUNCES as usize;

/// Contact times for which a strike is followed though no point can rise above the ground any more: it is one shock until then.
const WHOLE: f64 = 3.0;

/// A depth must be so many times what heights are told apart by.
const SUNK: f64 = 16.0;

/// A point as a well of energy under its share of the weight.
struct Well {
    /// Energy over the least that it can have.
    over: f64,
    /// What it must have to rise above the ground; none where it may do so now, or where its weight loads it further.
    escape: Option<f64>,
}

/// A body over the points that would carry its weight.
struct Weighed<const N: usize> {
    on: [usize; 2],
    forces: [f64; N],
    wells: [Well; 2],
    /// Its energy over that at rest there.
    left: f64,
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

    /// Lays down a point that alone presses and rings too slowly to be followed.
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
        let slow = velocity[i].hypot(rate * (height[i] - rest)) <= self.slow();
        if slow || self.touches[i].bounces > BOUNCES {
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
        let down = (0..N).filter(|&i| self.touches[i].state != State::Away);
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
            let lies = self.touches.iter().any(|touch| touch.state == State::Lying);
            return (lies && fastest <= slow).then_some(([0.0; N], 2.0 * fastest));
        }
        let may_be_trapped =
            self.touches.iter().filter(|t| !matches!(t.state, State::Away | State::Loading)).count() > 1;
        if !may_be_trapped && self.fastest_by(kinetic) > slow {
            return None;
        }
        let Weighed { on, forces, wells, left } = self.weighed()?;
        let fastest = self.fastest_by(left);
        let touched = self.presses.last().map_or(0.0, |press| press.from_s);
        let trapped = self.time.now() - touched > WHOLE * self.contact.time_s()
            && wells.iter().all(|well| well.escape.is_some_and(|escape| left < escape));
        let tired = self.phases.len() - self.since > PHASES && on.iter().all(|&i| self.touches[i].state != State::Away);
        let struck = |i: usize| self.log.flight.strikes.iter().any(|strike| strike.point == i);
        ((fastest <= slow || trapped || tired) && on.into_iter().all(struck)).then_some((forces, 2.0 * fastest))
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
        let wells = on.map(|i| self.well(i, height[i], forces[i]));
        let left = self.kinetic() + wells.iter().map(|well| well.over).sum::<f64>();
        Some(Weighed { on, forces, wells, left })
    }

    /// A point under a weight, by the line on which it is or would be.
    ///
    /// What loads it deeper takes more energy than the ground there gives: from a force above its weight on, the energy
    /// that is left never rises, nor does the ground come closer.
    fn well(&self, i: usize, height: f64, weight: f64) -> Well {
        let touch = &self.touches[i];
        let unloading = touch.stiffness * self.contact.unloading();
        let (stiffness, zero) = match (touch.state, self.contact.law()) {
            (State::Away, _) => (self.stiffness(i), 0.0),
            (State::Loading, _) | (State::Parted, ContactLaw::Dashpot) => (touch.stiffness, touch.ground),
            (State::Parted | State::Elastic, _) => (unloading, touch.zero),
            (State::Lying, ContactLaw::Dashpot) => (touch.stiffness, height + weight / touch.stiffness),
            (State::Lying, ContactLaw::Hysteretic) => (unloading, height + weight / unloading),
        };
        let energy = |h: f64| weight * h + if h < zero { 0.5 * stiffness * (zero - h).powi(2) } else { 0.0 };
        let least = energy(zero - weight / stiffness);
        let over = (energy(height) - least).max(0.0);
        let hysteretic = self.contact.law() == ContactLaw::Hysteretic;
        let dented = hysteretic && matches!(touch.state, State::Elastic | State::Lying | State::Parted);
        // The whole of its strike is over: it has parted once, or is too slow to.
        let struck = touch.bounces > 0 || touch.state == State::Lying || over <= 0.5 * weight * weight / stiffness;
        let escape = (dented && struck && touch.limit(self.contact) > weight).then_some(-least);
        Well { over, escape }
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
        } else if let Some(i) = left {
            // Without gravity one point lies alone.
            self.book(i, self.pose.points().1.map(|velocity| -velocity));
        }
        (self.pose.v, self.pose.spin) = (0.0, 0.0);
        self.resting = forces;
        self.log.flight.stop = Stop::AtRest { time_s: self.time.now(), time_bound_s: 0.0, shock_bound_m_s };
    }
}
