//! Contacts that act on each other through the bar.

use super::Quantity;
use super::lane::Ends;
use super::pulse::Pulse;

/// Share of a shock that pushes an end which has just parted down once more.
const DENT: f64 = 0.3;

/// How far the contacts of one strike and of the next act on each other.
#[derive(Debug, Clone, Copy)]
pub(super) struct Coupling {
    pulse: Pulse,
    e: f64,
    /// Contact time; 0 where it is not known.
    pub(super) time: f64,
    pub(super) velocity_shock: bool,
    /// Of both ends together: √(1 − q).
    root: f64,
}

/// A strike as its contact has it: its shocks of both ends, and its age.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Pressing {
    pub(super) delta_v: (f64, f64),
    pub(super) age_s: f64,
}

impl Coupling {
    pub(super) fn new(ends: &Ends, pulse: Pulse, time: f64, quantity: Quantity) -> Self {
        let q = ends.flat[0].abs().max(ends.flat[1].abs());
        let velocity_shock = quantity == Quantity::VelocityShock;
        Self { pulse, e: ends.e, time, velocity_shock, root: (1.0 - q).max(0.0).sqrt() }
    }
    /// Share of the speed that both ends together rebound with.
    #[cold]
    pub(super) fn rebound(&self) -> f64 {
        // Both contacts at once swing with √(1 ∓ q) of the lone frequency and damping; 1.3 for partings that are not at once.
        (1.3 * libm::pow(self.e, self.root)).min(1.0)
    }
    /// What end i may have been given more or less of, in m/s, where the other one strikes with `kick` for end i while the contact of end i,
    /// which does `had` in all, is as old as `age`.
    ///
    /// A linear contact struck by a velocity δ in the share x of its time gives `(1 + e)(1 − r(1 − x)) δ` more, with r the share that is to
    /// come after a time. Upward it parts early, and loses what is to come at most; downward the train of impacts has
    /// a strike of its own there, which differs by e of the contact and by what no longer has time to come back.
    pub(super) fn pushed(&self, age: f64, kick: f64, had: f64) -> f64 {
        let (x, rise) = (age / self.time, self.pulse.delay());
        if x.is_nan() || x >= 1.0 + rise {
            return 0.0;
        }
        // Fitted: an end that has parted is still below the ground, and comes up with what it rebounds with.
        let dent = if kick < 0.0 { -kick * (DENT * (1.0 + rise - x) / rise).min(DENT) } else { 0.0 };
        if x >= 1.0 {
            return dent;
        }
        let back = self.pulse.remaining(1.0 - x);
        let whole = (1.0 + self.e) * (1.0 - back) * kick.abs();
        if kick > 0.0 {
            whole.min(self.pulse.remaining(x) * had)
        } else {
            whole.min(self.e * had + (1.0 + self.e) * back * -kick).max(dent)
        }
    }
    /// The same of the end that strikes, for which the other contact had `kick`: what of that is to come acts while it presses.
    pub(super) fn held(&self, age: f64, kick: f64) -> f64 {
        if age >= self.time {
            return 0.0;
        }
        (1.0 + self.e) * self.pulse.remaining(age / self.time).powi(2) * kick.abs()
    }
    /// By how much a window of one contact time may hold more than one of two shocks, or less.
    pub(super) fn windows(&self, gap: f64, [earlier, later]: [f64; 2]) -> f64 {
        if gap >= self.time {
            return 0.0;
        }
        let x = gap / self.time;
        let tail = self.pulse.remaining(x) * earlier.abs();
        let head = (1.0 - self.pulse.remaining(1.0 - x)) * later.abs();
        if earlier * later > 0.0 { tail + head } else { tail }
    }
}
