//! Contacts that act on each other through the bar.

use super::ends::Ends;
use super::floats::{greater, lesser};
use super::pulse::Pulse;
use super::quick::{decay, ln};

/// Share of a shock that pushes an end which has just parted down once more.
const DENT: f64 = 0.3;

/// The last contacts of both ends, and how far they and the next one act on each other.
#[derive(Debug, Clone)]
pub(super) struct Coupling {
    pulse: Pulse,
    e: f64,
    flat: [f64; 2],
    /// Contact time; 0 where it is not known.
    time: f64,
    pressing: [Option<Pressing>; 2],
    /// How far the motion of the ends is in doubt.
    loose: f64,
    /// Share of the speed that both ends together rebound with, once it is asked for.
    rebound: Option<f64>,
}

/// A strike as its contact has it: its shocks of both ends, and its age.
#[derive(Debug, Clone, Copy, Default)]
struct Pressing {
    delta_v: (f64, f64),
    age_s: f64,
}

/// What a strike and the contacts before it do to each other.
#[derive(Debug, Clone, Copy)]
pub(super) struct Coupled {
    /// Share of its shock by which the motion that it meets is in doubt.
    pub(super) astray: f64,
    /// Whether the end presses already: it is the same contact.
    pub(super) presses: bool,
    /// The contact of the other end, where it has not done all it would.
    pub(super) other: Option<Other>,
}

/// The contact of the other end.
#[derive(Debug, Clone, Copy)]
pub(super) struct Other {
    /// Its velocity shocks of both ends.
    pub(super) delta_v: (f64, f64),
    /// What it, and the one of the end that strikes, may have been given more or less of, in m/s at its own end.
    pub(super) pushed: f64,
    pub(super) held: f64,
    /// Shares of a pulse that are to come after its age, and after what is left of its time.
    remaining: [f64; 2],
}

impl Other {
    /// By how much a window of one contact time may hold more than one of two shocks, or less: with both the same way,
    /// the other one at most; against each other, what it holds of the other one, or leaves of its own to end before
    /// that.
    pub(super) fn window(&self, [earlier, later]: [f64; 2]) -> f64 {
        let tail = self.remaining[0] * earlier.abs();
        let head = (1.0 - self.remaining[1]) * later.abs();
        if earlier * later > 0.0 { lesser(tail + head, lesser(earlier.abs(), later.abs())) } else { lesser(tail, head) }
    }
}

impl Coupling {
    pub(super) fn new(ends: &Ends, pulse: Pulse, time: f64) -> Self {
        Self { pulse, e: ends.e, flat: ends.flat, time, pressing: [None; 2], loose: 0.0, rebound: None }
    }
    /// Share of the speed that both ends together rebound with.
    #[cold]
    pub(super) fn rebound(&mut self) -> f64 {
        let q = self.flat[0].abs().max(self.flat[1].abs());
        // Both contacts at once swing with √(1 ∓ q) of the lone frequency and damping; 1.3 for partings that are not at
        // once.
        *self.rebound.get_or_insert_with(|| {
            let apart = greater(1.0 - q, 0.0).sqrt();
            lesser(1.3 * decay(-apart * ln(self.pulse.e)), 1.0)
        })
    }
    /// A strike after this time, which is known to `blur_s`; `together` with the other end, which is one contact.
    pub(super) fn strike(
        &mut self,
        end: usize,
        delta_v: (f64, f64),
        [gap_s, blur_s]: [f64; 2],
        together: bool,
    ) -> Coupled {
        for pressing in self.pressing.iter_mut().flatten() {
            pressing.age_s += gap_s;
        }
        // Of a motion in doubt, the shock is as much.
        let strike = of(delta_v, end).abs();
        let astray = if strike > 0.0 { (self.loose * (1.0 + self.e) / strike).min(1.0) } else { 0.0 };
        // Where this end presses already, it is the same contact.
        let own = self.pressing[end].filter(|own| own.age_s < self.time);
        let other = if together { None } else { self.meets(end, delta_v, blur_s, own.is_some()) };
        if let Some(other) = other {
            self.loose += other.pushed + other.held;
        }
        let contact = own.unwrap_or_default();
        let delta_v = (contact.delta_v.0 + delta_v.0, contact.delta_v.1 + delta_v.1);
        self.pressing[end] = Some(Pressing { delta_v, ..contact });
        if together {
            self.pressing[1 - end] = self.pressing[end];
        }
        Coupled { astray, presses: own.is_some(), other }
    }
    /// What the contact of the other end and this strike do to each other.
    ///
    /// A linear contact struck by a velocity δ in the share x of its time gives `(1 + e)(1 − r(1 − x)) δ` more, with r
    /// the share that is to come after a time. Upward it parts early, and loses what is to come at most; downward the
    /// train of impacts has a strike of its own there, which differs by e of the contact and by what no longer has time
    /// to come back.
    fn meets(&self, end: usize, delta_v: (f64, f64), blur_s: f64, presses: bool) -> Option<Other> {
        let (other, e) = (self.pressing[1 - end]?, self.e);
        let (x, rise) = ((other.age_s - blur_s).max(0.0) / self.time, self.pulse.delay());
        if x.is_nan() || x >= 1.0 + rise {
            return None;
        }
        let (kick, had) = (of(delta_v, 1 - end), of(other.delta_v, 1 - end).abs());
        // Fitted: an end that has parted is still below the ground, and comes up with what it rebounds with.
        let dent = if kick < 0.0 { -kick * (DENT * (1.0 + rise - x) / rise).min(DENT) } else { 0.0 };
        let (mut pushed, mut remaining) = (dent, [0.0, 1.0]);
        if x < 1.0 {
            remaining = [x, 1.0 - x].map(|t| self.pulse.remaining(t));
            let [to_come, back] = remaining;
            let whole = (1.0 + e) * (1.0 - back) * kick.abs();
            pushed = if kick > 0.0 {
                whole.min(to_come * had)
            } else {
                whole.min(e * had + (1.0 + e) * back * -kick).max(dent)
            };
        }
        // What it does back is one more load on the one that strikes, and what of it is to come acts while that
        // presses.
        let load = if presses { 0.0 } else { (1.0 + e) * remaining[0].powi(2) * of(other.delta_v, end).abs() };
        let held = pushed * self.flat[1 - end].abs() + load;
        Some(Other { delta_v: other.delta_v, pushed, held, remaining })
    }
}

/// That of one end.
pub(super) fn of((a, b): (f64, f64), end: usize) -> f64 {
    if end == 0 { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two pulses that only overlap: no window of one contact time holds more than the larger shock and what is told.
    #[test]
    fn a_window_holds_no_more_than_is_told() {
        let at = |k: i32| f64::from(k) / 100.0;
        let mut nearest = 1.0_f64;
        for e in [0.02, 0.1, 0.4, 0.9] {
            let pulse = Pulse::new(e);
            let given = |t: f64| 1.0 - pulse.remaining(t.clamp(0.0, 1.0));
            for x in [0.05, 0.3, 0.6, 0.9].iter().copied() {
                for later in [-2.0, -0.7, -0.2, 0.2, 0.7, 2.0] {
                    let velocity = |t: f64| given(t) + later * given(t - x);
                    let changes = (0..200).flat_map(|from| (from..=from + 100).map(move |to| (at(from), at(to))));
                    let largest = changes.map(|(from, to)| (velocity(to) - velocity(from)).abs()).fold(0.0, f64::max);
                    let remaining = [x, 1.0 - x].map(|t| pulse.remaining(t));
                    let other = Other { delta_v: (1.0, 0.0), pushed: 0.0, held: 0.0, remaining };
                    let (larger, told) = (later.abs().max(1.0), other.window([1.0, later]));
                    // The changes are those of a hundred instants a contact.
                    assert!((largest - larger).abs() <= told + 0.02, "e {e} x {x} {later}: {largest} {told}");
                    nearest = nearest.min(told - (largest - larger).abs());
                }
            }
        }
        assert!(nearest < 0.05, "{nearest}");
    }
}
