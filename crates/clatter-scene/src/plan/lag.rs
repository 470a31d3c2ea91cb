//! A lane held against the one with all physics, as one component has both.

use super::STRIKES;
use super::coarse::Landing;
use super::ends::Ends;
use super::floats::{greater, lesser};
use super::lane::Own;
use super::swing::{Motion, Peak, Swing, Turn};

/// Phases up to which a motion is taken as a straight line.
const STRAIGHT: f64 = 0.1;

/// Phases times 1 + 2ζ up to which a motion is taken as three terms of its series: 2 % of how far it moves are left out.
const BENT: f64 = 0.7;

/// A component at its place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Part<'a> {
    pub(super) ends: &'a Ends,
    pub(super) swing: &'a Swing,
    pub(super) omega: f64,
    /// Velocity shocks are asked for, not a response.
    pub(super) shocks: bool,
    /// Contact time, and how long after its begin a contact acts on the mean; 0 where they are not known.
    pub(super) time: f64,
    pub(super) acts_s: f64,
}

/// A strike of the lane with all physics as the component has it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Beat {
    pub(super) landing: Landing,
    /// Time since the last one.
    pub(super) gap_s: f64,
    /// Its velocity shock, and what both contacts do one by one where they act at once.
    pub(super) delta_v: f64,
    pub(super) gross: f64,
    pub(super) together: bool,
    /// The component just after the last one, and as this one meets it.
    pub(super) begun: Motion,
    pub(super) met: Motion,
    /// What the time between both did to it.
    pub(super) turn: Turn,
}

/// What both contacts do to the component's place where they act at once.
#[derive(Debug, Clone, Copy)]
pub(super) struct TwoShocks {
    /// That of the end that lands, and of the one that lay.
    pub(super) first: f64,
    pub(super) other: f64,
}

impl TwoShocks {
    pub(super) fn of(ends: &Ends, landed: usize, (a, b): (f64, f64)) -> Self {
        let ratio = ends.flat;
        // 1 − r₀ r₁ without cancellation; ends without mass of their own are taken as nearly so.
        let [p, q] = ends.arm.map(|arm| arm * arm + ends.gyration2);
        let length = ends.arm[0] + ends.arm[1];
        let over = p * q / (ends.gyration2 * length * length).max(f64::MIN_POSITIVE);
        let of_contacts = [
            over * (a + ratio[1] * b) * ends.at((1.0, -ratio[0])),
            over * (b + ratio[0] * a) * ends.at((-ratio[1], 1.0)),
        ];
        Self { first: of_contacts[landed], other: of_contacts[1 - landed] }
    }
}

/// The component where a strike of the lane with all physics meets it.
#[derive(Debug)]
struct Meeting<'a> {
    swing: &'a Swing,
    /// Just after the last strike, now, and the phase between.
    begun: Motion,
    motion: Motion,
    turned: f64,
    /// How fast it changes by the phase, and the square of the bound of that.
    rate: Motion,
    square: f64,
}

/// What the strike of a lane does to its component that comes at another time.
#[derive(Debug, Clone, Copy)]
struct Shifted {
    by: Motion,
    /// Whether the lane goes on as before.
    goes_on: bool,
    /// By how much the interval begins elsewhere, and what the lane has before it.
    beginning: f64,
    early: f64,
}

impl<'a> Meeting<'a> {
    #[inline]
    fn new(beat: &Beat, part: &Part<'a>) -> Self {
        let (swing, motion) = (part.swing, beat.met);
        let rate = swing.rate(motion);
        Self { swing, begun: beat.begun, motion, turned: part.omega * beat.gap_s, rate, square: swing.square(rate) }
    }
    /// How far a strike at another phase moves the component of a lane. It meets a motion that has turned to another
    /// place, as which the lane goes on; or is itself turned, and the lane goes on as before: the less of the two.
    #[inline]
    fn shift(&self, own: f64, phase: f64) -> Shifted {
        let (swing, straight) = (self.swing, phase.abs() <= STRAIGHT);
        let (mut moved, mut most) =
            (Motion { x: phase * self.rate.x, w: phase * self.rate.w }, phase * phase * self.square);
        if !straight {
            moved = self.far(phase);
            most = swing.square(moved);
        }
        let turned = greater(lesser(phase, 2.0), -2.0);
        let shifted = swing.factor * own * turned;
        if shifted * shifted < most {
            let early = if phase < 0.0 && !straight { self.early(own, turned, moved) } else { 0.0 };
            let by = Motion { x: own * turned, w: -2.0 * swing.zeta() * own * turned };
            Shifted { by, goes_on: true, beginning: swing.quantity(moved).abs(), early }
        } else {
            Shifted { by: moved, goes_on: false, beginning: 0.0, early: 0.0 }
        }
    }
    /// How far the motion moves in a phase that is not straight.
    #[cold]
    fn far(&self, phase: f64) -> Motion {
        // It begins with the last strike.
        let phase = greater(phase, -self.turned);
        if phase.abs() * (1.0 + 2.0 * self.swing.zeta()) <= BENT {
            // By three terms of its series.
            let by =
                |rate: Motion, bend: Motion, step: f64| Motion { x: rate.x + step * bend.x, w: rate.w + step * bend.w };
            let bend = self.swing.rate(self.rate);
            let change = by(self.rate, by(bend, self.swing.rate(bend), phase * (1.0 / 3.0)), 0.5 * phase);
            return Motion { x: phase * change.x, w: phase * change.w };
        }
        let met = self.swing.after(&self.swing.turn(self.turned + phase), self.begun);
        Motion { x: met.x - self.motion.x, w: met.w - self.motion.w }
    }
    /// What a lane has before the interval whose strike comes before by `turned`, where the motion is elsewhere by
    /// `moved`.
    #[cold]
    fn early(&self, own: f64, turned: f64, moved: Motion) -> f64 {
        let swing = self.swing;
        let met = Motion { x: self.motion.x + moved.x, w: self.motion.w + moved.w };
        swing.bound(met) + own.abs() * lesser(swing.quantity(Motion { x: -turned, w: 1.0 }), swing.factor)
    }
}

/// Bounds on how far a lane is off in one interval.
#[derive(Debug, Clone, Copy)]
pub(super) struct Off {
    pub(super) all: f64,
    /// By what more as it begins.
    pub(super) beginning: f64,
    /// On what the lane has before it that strikes earlier.
    pub(super) early: f64,
}

/// One lane, as the component has the strikes so far.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lag {
    /// Motion of the component less that in the lane with all physics, and by how much later the strikes come than
    /// that has it.
    motion: Motion,
    behind_s: f64,
    /// Shocks that it lacks, faded.
    pub(super) lacking: f64,
    /// Whether it has had the same strikes.
    pub(super) alive: bool,
    /// The map, which has no more strikes than those of its train.
    pub(super) is_map: bool,
    /// Of each interval.
    pub(super) off: [Off; STRIKES],
}

impl Lag {
    /// Before the first touch.
    pub(super) const NONE: Self = Self {
        motion: Motion { x: 0.0, w: 0.0 },
        behind_s: 0.0,
        lacking: 0.0,
        alive: true,
        is_map: false,
        off: [Off { all: 0.0, beginning: 0.0, early: 0.0 }; STRIKES],
    };

    /// Strike n of some lanes, where they have it; `last` is the peak of the interval before.
    #[inline]
    pub(super) fn strike(
        lags: &mut [Self],
        own: &[Option<Own>],
        n: usize,
        (beat, part, last): (&Beat, &Part<'_>, Option<&Peak>),
    ) {
        let swing = part.swing;
        let meeting = if part.shocks || n == 0 { None } else { Some(Meeting::new(beat, part)) };
        for (lag, &own) in lags.iter_mut().zip(own) {
            if n > 0 && !part.shocks {
                lag.motion = swing.after(&beat.turn, lag.motion);
                lag.lacking *= beat.turn.fade;
            }
            let Some((after, own)) = own else {
                lag.alive = false;
                lag.lacking += beat.gross;
                let rings = swing.bound(lag.motion) + swing.factor * lag.lacking;
                lag.off[n].all = if part.shocks { beat.delta_v.abs() } else { rings };
                continue;
            };
            if part.shocks {
                let first = || TwoShocks::of(part.ends, beat.landing.end, own).first;
                let own = if beat.together { first() } else { part.ends.at(own) };
                lag.off[n].all = (own - beat.delta_v).abs();
                continue;
            }
            let own = part.ends.at(own);
            let (Some(meeting), Some(last)) = (&meeting, last) else {
                // At the first touch all find it at rest.
                lag.motion.w = beat.delta_v - own;
                lag.off[n].all = swing.factor * lag.motion.w.abs();
                continue;
            };
            lag.off[n - 1].all += beat.cuts(after, last, part);
            let behind_s = lag.behind_s + after - beat.gap_s;
            let shifted = meeting.shift(own, part.omega * behind_s);
            lag.behind_s = if shifted.goes_on { behind_s } else { 0.0 };
            lag.motion =
                Motion { x: lag.motion.x + shifted.by.x, w: lag.motion.w - (own - beat.delta_v) + shifted.by.w };
            let all = swing.bound(lag.motion) + swing.factor * lag.lacking;
            lag.off[n] = Off { all, beginning: shifted.beginning, early: shifted.early };
        }
    }
}

impl Beat {
    pub(super) const NONE: Self = Self {
        landing: Landing::NONE,
        gap_s: 0.0,
        delta_v: 0.0,
        gross: 0.0,
        together: false,
        begun: Motion { x: 0.0, w: 0.0 },
        met: Motion { x: 0.0, w: 0.0 },
        turn: Turn::NONE,
    };

    /// What a strike that comes after another time than this one changes of the peak before.
    #[inline]
    fn cuts(&self, after: f64, last: &Peak, part: &Part<'_>) -> f64 {
        let mut off = if last.slope > 0.0 {
            // A value that the next shock cuts off is as high as that is late.
            last.slope * lesser((part.omega * (after - self.gap_s)).abs(), 2.0)
        } else {
            // A peak inside the swing, which bends by itself, is cut off where the next pulse begins before it.
            let short = |gap: f64| lesser(greater(last.phase + part.omega * (part.acts_s - gap), 0.0), 1.0);
            let [other, own] = [short(after), short(self.gap_s)];
            0.5 * last.value * (other * other - own * own).abs()
        };
        if last.phase <= part.omega * part.time {
            // A pulse that ends on a dashpot is cut off by the next where only one of both trains has them overlap.
            let over = |gap: f64| if gap < part.time { 1.0 - gap / part.time } else { 0.0 };
            let jump = part.swing.quantity(Motion { x: 0.0, w: self.delta_v }).abs();
            off += jump * (over(after) - over(self.gap_s)).abs();
        }
        off
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three terms of the series leave out what is stated, and no motion begins before its shock.
    #[test]
    fn a_far_phase_moves_as_the_motion_does() {
        for zeta in [0.0, 0.1, 0.6, 1.0, 1.8, 10.0] {
            let swing = Swing::new(zeta, true);
            for begun in [Motion { x: 0.0, w: 1.0 }, Motion { x: 1.0, w: -0.4 }, Motion { x: -0.3, w: 0.2 }] {
                let turned = 0.8;
                let motion = swing.after(&swing.turn(turned), begun);
                let rate = swing.rate(motion);
                let meeting = Meeting { swing: &swing, begun, motion, turned, rate, square: swing.square(rate) };
                let size = |m: Motion| m.x.hypot(m.w);
                for k in -30..=30 {
                    let phase = f64::from(k) / 25.0;
                    let moved = meeting.far(phase);
                    let met = swing.after(&swing.turn((turned + phase).max(0.0)), begun);
                    let exact = Motion { x: met.x - motion.x, w: met.w - motion.w };
                    let off = size(Motion { x: moved.x - exact.x, w: moved.w - exact.w });
                    // Of a motion whose parts cancel, the share is of what they move.
                    let whole = size(exact) + 0.1 * phase.abs() * (1.0 + 2.0 * zeta) * size(motion);
                    assert!(off <= 0.02 * whole, "zeta {zeta} {begun:?} by {phase}: {moved:?} {exact:?}");
                }
            }
        }
    }
}
