//! The state of a contact point: in the air, loading, unloading, lying, or parted below the ground.

use super::law::{Contact, ContactLaw};
use super::phase::{Hold, Line};

/// A contact point and the marks of its last contact.
#[derive(Debug, Clone, Copy)]
pub(super) struct Touch {
    pub(super) state: State,
    /// Stiffness of the first loading.
    pub(super) stiffness: f64,
    /// Height from which the first loading counts its depth: the ground, or the end of the last press in this dent.
    pub(super) ground: f64,
    /// Lowest height so far.
    pub(super) crest: f64,
    /// Height at which the line of unloading has no force; after parting there it is the ground.
    pub(super) zero: f64,
    /// The strike it belongs to.
    pub(super) strike: usize,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum State {
    /// Above the ground, without a dent.
    Away,
    /// On the line of first loading, or on that of a dashpot.
    Loading,
    /// On the line of unloading and reloading.
    Elastic,
    /// Still: its ringing on the line of unloading is left out, or that line is upright.
    Lying,
    /// Without force in its dent.
    Parted,
}

/// The end of a phase.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Event {
    /// A point comes down on the ground.
    Touches,
    /// A loading point is at its lowest.
    Crests,
    /// The force has fallen to zero.
    Parts,
    /// A reloaded point is back at its lowest, with the force it had there.
    Reloads,
    /// A parted point presses again, as a new press.
    Presses,
    /// A parted point is above the ground.
    Clears,
}

/// A watch on one event: `offset + of_height h + of_velocity h′` is positive until it happens. Of a point that lies, h is
/// its force.
#[derive(Debug, Clone, Copy)]
pub(super) struct Watch {
    pub(super) event: Event,
    pub(super) offset: f64,
    pub(super) of_height: f64,
    pub(super) of_velocity: f64,
}

/// Margins against the repetition of an event just after it: a height, a velocity, and a share of a force.
#[derive(Debug, Clone, Copy)]
pub(super) struct Margins {
    pub(super) height: f64,
    pub(super) velocity: f64,
    pub(super) force: f64,
}

impl Watch {
    /// Returns value and first two derivatives at height, velocity, acceleration and jerk of a point.
    pub(super) fn at(&self, [h, v, a, j]: [f64; 4]) -> [f64; 3] {
        let (x, y) = (self.of_height, self.of_velocity);
        [self.offset + x * h + y * v, x * v + y * a, x * a + y * j]
    }
    /// Returns value and slope at height and velocity, if these are enough.
    pub(super) fn begins(&self, [h, v]: [f64; 2]) -> Option<[f64; 2]> {
        (self.of_velocity == 0.0).then_some([self.offset + self.of_height * h, self.of_height * v])
    }
    /// Bounds of the second and third derivative.
    pub(super) fn bounds(&self, [second, third, fourth]: [f64; 3]) -> [f64; 2] {
        let (x, y) = (self.of_height.abs(), self.of_velocity.abs());
        [x * second + y * third, x * third + y * fourth]
    }
    /// Returns whether a swing about a rest never reaches it.
    pub(super) fn never(&self, [rest, swing]: [f64; 2]) -> bool {
        self.of_velocity == 0.0 && self.offset + self.of_height * rest > self.of_height.abs() * swing
    }
}

impl Touch {
    pub(super) fn away() -> Self {
        Self { state: State::Away, stiffness: 0.0, ground: 0.0, crest: 0.0, zero: 0.0, strike: 0 }
    }
    /// Returns the state of its contact by the law.
    pub(super) fn hold(&self, contact: &Contact) -> Hold {
        match self.state {
            State::Away | State::Parted => Hold::No,
            State::Loading => Hold::On(Line { stiffness: self.stiffness, zero: self.ground }),
            State::Elastic => Hold::On(Line { stiffness: self.stiffness * contact.unloading(), zero: self.zero }),
            State::Lying => Hold::Lies,
        }
    }
    pub(super) fn is_pressing(&self) -> bool {
        !matches!(self.state, State::Away | State::Parted)
    }
    /// Returns the force at its lowest height: a larger one loads it further, where a dent is left.
    pub(super) fn limit(&self, contact: &Contact) -> f64 {
        if contact.law().leaves_a_dent() { self.stiffness * (self.ground - self.crest) } else { f64::INFINITY }
    }
    /// Returns the watches on its next events.
    pub(super) fn watches(&self, contact: &Contact, margins: &Margins) -> [Option<Watch>; 2] {
        let watch = |event, offset, of_height, of_velocity| Some(Watch { event, offset, of_height, of_velocity });
        let dashpot = !contact.law().leaves_a_dent();
        let (delay, margin) = (contact.delay_s(), margins.height);
        match self.state {
            State::Away => [watch(Event::Touches, 0.0, 1.0, 0.0), None],
            State::Loading if dashpot => [watch(Event::Parts, self.ground, -1.0, -delay), None],
            State::Loading => [watch(Event::Crests, margins.velocity, 0.0, -1.0), None],
            State::Elastic => {
                [watch(Event::Parts, self.zero, -1.0, 0.0), watch(Event::Reloads, margin - self.crest, 1.0, 0.0)]
            }
            State::Lying if dashpot => [watch(Event::Parts, 0.0, 1.0, 0.0), None],
            State::Lying => {
                let limit = self.limit(contact) * (1.0 + margins.force);
                [watch(Event::Parts, 0.0, 1.0, 0.0), watch(Event::Reloads, limit, -1.0, 0.0)]
            }
            State::Parted if dashpot => {
                [watch(Event::Presses, margin - self.ground, 1.0, delay), watch(Event::Clears, margin, -1.0, 0.0)]
            }
            State::Parted => {
                [watch(Event::Presses, margin - self.zero, 1.0, 0.0), watch(Event::Clears, margin, -1.0, 0.0)]
            }
        }
    }
    /// Turns from loading to unloading at its lowest height.
    pub(super) fn crest(&mut self, height: f64, contact: &Contact) {
        self.crest = height;
        self.zero = height + (self.ground - height) / contact.unloading();
        self.state = if contact.is_plastic() { State::Lying } else { State::Elastic };
    }
    /// Parts without force at this height.
    pub(super) fn part(&mut self, height: f64, velocity: f64, contact: &Contact) {
        let by = match contact.law() {
            ContactLaw::Hysteretic => height - self.zero,
            ContactLaw::Dashpot => height + contact.delay_s() * velocity - self.ground,
        };
        self.shift(by);
        self.state = State::Parted;
    }
    /// Loads further, from height and force at its lowest.
    pub(super) fn reload(&mut self, height: f64) {
        self.shift(height - self.crest);
        self.state = State::Loading;
    }
    /// Puts a point that lies with this force back on its line.
    pub(super) fn rouse(&mut self, height: f64, force: f64, contact: &Contact) {
        match contact.law() {
            ContactLaw::Hysteretic => {
                self.shift(height + force / (self.stiffness * contact.unloading()) - self.zero);
                self.state = State::Elastic;
            }
            ContactLaw::Dashpot => {
                self.shift(height + force / self.stiffness - self.ground);
                self.state = State::Loading;
            }
        }
    }
    /// Shifts all heights by the difference between the exact geometry and that of a phase.
    fn shift(&mut self, by: f64) {
        self.ground += by;
        self.crest += by;
        self.zero += by;
    }
}
