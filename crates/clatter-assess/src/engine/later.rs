//! What may come after a motion was left, by the energy that is left.

use clatter_shock::Suspension;

/// What strikes may do at a place after a motion was left, by the energy left.
pub(super) struct Later {
    /// Of a motion that was given up, with many strikes to come.
    pub(super) given_up: Option<GivenUp>,
    /// What the place will come to feel for ever.
    pub(super) weight_m_s2: f64,
    /// Of one strike, and of strikes that overlap.
    pub(super) shock_m_s: f64,
    pub(super) turned_m_s: f64,
    pub(super) turn_rad_s: f64,
    /// All energy in the springs of both ends, or in that of one, at any tilt.
    pub(super) acceleration_m_s2: f64,
}

impl Later {
    /// The velocity shock that does as much to a part: one that is fast beside a contact feels no more than a pulse twice as high, and a
    /// weight that comes on at once moves it by no more than twice its static deflection.
    pub(super) fn shock_of(&self, part: &Suspension) -> f64 {
        let one = self.shock_m_s.min(2.0 * self.acceleration_m_s2 / part.omega());
        let all = self.given_up.as_ref().map_or(0.0, |left| left.shock_of(part, one));
        all.max(CHATTER * one) + 2.0 * self.weight_m_s2 / part.omega()
    }
}

/// What bounds many strikes that are all in step with a part.
pub(super) struct GivenUp {
    /// Ends that bounce one at a time do e times as much at each strike: so many times the first in all, of both.
    pub(super) in_turn: f64,
    /// What an impulse does to the place over what it does to the center of mass, at most.
    pub(super) lever: f64,
    /// Change of velocity of the center of mass, at most.
    pub(super) center_m_s: f64,
    pub(super) gravity_m_s2: f64,
}

impl GivenUp {
    /// Momentum: within a time t the ground gives the center of mass no more than what turns it around and g t. A part forgets at its
    /// rate of decay, so that of g t the weight over that rate counts.
    fn shock_of(&self, part: &Suspension, one_m_s: f64) -> f64 {
        let momentum = self.lever * (self.center_m_s + self.gravity_m_s2 / (slowest(part) * part.omega()));
        momentum.min(self.in_turn * one_m_s)
    }
}

/// Rate at which the free motion of a part decays, over ω.
pub(super) fn slowest(part: &Suspension) -> f64 {
    let zeta = part.damping().get();
    if zeta < 1.0 { zeta } else { 1.0 / (zeta + (zeta * zeta - 1.0).sqrt()) }
}

/// Strikes of both ends in step do this many times what one does that has all the energy, at most: of the drops of random
/// products without damping, one in a thousand exceeds it.
const CHATTER: f64 = 1.5;
