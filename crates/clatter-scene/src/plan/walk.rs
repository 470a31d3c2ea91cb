//! The first strikes of a drop as one component has them.

use std::slice::{from_mut, from_ref};

use super::bounds::{later_response, later_shock, pile_until_rest, weight};
use super::coarse::Alike;
use super::coupling::of;
use super::demand::serves;
use super::floats::{greater, lesser};
use super::lag::{Beat, Lag, Part, TwoShocks};
use super::pulse::Pulse;
use super::swing::{Motion, Peak, Turn};
use super::trail::{Course, Step, Strikes};
use super::walked::{Interval, Stop, Top, Walk, smoothing};
use super::{FIRST_STRIKES, STRIKES};

/// What later strikes can do must stay below this share of the peak for the following to stop: pulses flatten both, not
/// alike.
const CLEAR: f64 = 0.9;

/// Fitted: an end that lies down mistimes what the other one does by this share of the time until then.
const LYING: f64 = 0.03;

/// From one strike to the next.
#[derive(Debug, Clone, Copy)]
struct Flight {
    gap_s: f64,
    /// Share of the weight that the component feels of an end that lies on the ground meanwhile.
    lying: Option<f64>,
    tumbles: bool,
    /// Bound on the speed at the component.
    speed: f64,
}

/// Follows strikes until nothing later counts.
#[derive(Debug)]
pub(super) struct Walker<'a> {
    part: Part<'a>,
    gravity: f64,
    /// The speed that the weight gives in one radian of the component.
    fall: f64,
    pulse: Pulse,
    /// Whether the model of contacts takes it.
    compliant: bool,
    /// Share of the time since the first strike by which strikes are mistimed.
    blur: f64,
    /// Time after which a strike finds nothing of the contact before, whose end has come up by then.
    apart_s: f64,
    /// How many times the largest later shock the speeds of all later ones allow.
    pile: f64,
    pub(super) walk: Walk,
    beats: [Beat; STRIKES],
    /// The component now, and just after the last strike.
    motion: Motion,
    begun: Motion,
    /// What the time between did to it.
    turn: Turn,
    peak: f64,
    /// Shocks in doubt, faded.
    doubtful: f64,
    /// How much higher the component may ring where strikes are mistimed.
    adrift: f64,
    /// Speed at the component before the last strike, and what overlapping contacts leave of it.
    before: f64,
    floor: f64,
    /// Whether nothing falls any more, after more than the first strike.
    rests: bool,
}

impl<'a> Walker<'a> {
    #[inline]
    pub(super) fn new(part: Part<'a>, course: &Course, gravity: f64, compliant: bool) -> Self {
        let fall = gravity / part.omega;
        let weight = if part.shocks { 0.0 } else { weight(part.swing, fall) };
        Self {
            part,
            gravity,
            fall,
            pulse: course.pulse,
            compliant,
            blur: course.blur,
            apart_s: (1.0 + course.pulse.delay()) * part.time,
            pile: course.pile,
            walk: Walk {
                intervals: [Interval::NONE; STRIKES],
                strikes: 0,
                late: 0.0,
                extra: 0.0,
                until_s: f64::INFINITY,
                last_s: 0.0,
                shortest_gap_s: f64::INFINITY,
                overlaps: false,
                weight,
                jumps: 0.0,
                tilted: Lag::NONE,
                stop: Stop::Whole,
                near: false,
            },
            beats: [Beat::NONE; STRIKES],
            motion: Motion::default(),
            begun: Motion::default(),
            turn: Turn::NONE,
            peak: 0.0,
            doubtful: 0.0,
            adrift: 0.0,
            before: 0.0,
            floor: 0.0,
            rests: false,
        }
    }

    /// Until nothing later counts, or by the strikes so far real tilt is off or serves; `most` strikes at most.
    pub(super) fn follow(&mut self, trail: &mut impl Strikes, tolerance: f64, most: usize) {
        let ends = self.part.ends;
        self.before = ends.reach(trail.course().twice_energy);
        let mut flight = Flight { gap_s: 0.0, lying: None, tumbles: false, speed: self.before };
        while let Some(step) = trail.step(self.walk.strikes) {
            self.strike(step, &flight);
            let Some(follows) = step.follows else {
                self.rest(step);
                break;
            };
            self.rival(step, follows);
            let lying = step.landing.rests.map(|end| {
                let other = -ends.flat[end];
                ends.at(if end == 0 { (1.0, other) } else { (other, 1.0) }).abs()
            });
            let speed = ends.reach(step.twice_energy);
            flight = Flight { gap_s: follows, lying, tumbles: step.tumbles, speed };
            self.floor = greater(step.rebound * self.before, self.floor);
            self.fly(trail, &flight);
            if self.is_over(&flight) {
                break;
            }
            if self.compliant && self.is_off(tolerance) {
                self.walk.stop = Stop::Off;
                break;
            }
            if flight.tumbles || self.walk.strikes == STRIKES {
                break;
            }
            if tolerance < f64::INFINITY && self.walk.strikes >= most.min(FIRST_STRIKES) {
                let gap_s = flight.gap_s - self.blur * (self.walk.last_s + flight.gap_s);
                self.walk.near = gap_s < self.apart_s;
                self.walk.stop = Stop::CutShort;
                if self.walk.strikes >= most || self.serves(tolerance) {
                    break;
                }
                self.walk.stop = Stop::Whole;
            }
        }
    }

    /// Whether real tilt serves whatever comes later.
    fn serves(&self, tolerance: f64) -> bool {
        let Top { left, .. } = self.top();
        serves(self.walk.errors(&self.walk.tilted, left, &self.walk.lates()).1 / left, tolerance)
    }

    /// The peak as pulses leave it: one that they flatten leaves more room to every error.
    pub(super) fn top(&self) -> Top {
        let Part { swing, omega, shocks, time, .. } = self.part;
        let peak = self.walk.peak();
        if shocks {
            return Top { peak: peak.value, smooth: 0.0, phase: [0.0; 2], left: peak.value };
        }
        let (smooth, phase) = smoothing(&self.pulse, omega * time, &peak, swing.zeta());
        Top { peak: peak.value, smooth, phase, left: (1.0 - lesser(smooth, 0.8)) * peak.value }
    }

    /// From the last strike to the next.
    fn fly(&mut self, trail: &mut impl Strikes, flight: &Flight) {
        let (Part { swing, omega, shocks, time, .. }, gap) = (self.part, flight.gap_s);
        let n = self.walk.strikes - 1;
        let interval = &mut self.walk.intervals[n];
        if !shocks {
            let turn = trail.turn(n, swing, omega * gap);
            let last = swing.after(&turn, self.motion);
            let (end, rate) = (swing.quantity(last), swing.quantity(swing.rate(last)));
            if n == 0 {
                interval.peak = swing.peak_of_shock(self.motion.w, omega * gap);
            } else if swing.square(self.motion) > 0.25 * self.peak * self.peak {
                interval.peak = swing.peak_before(self.motion, omega * gap, rate);
            }
            self.motion = last;
            if end.abs() > interval.peak.value {
                let slope = greater(rate * end.signum(), 0.0);
                interval.peak = Peak { value: end.abs(), phase: omega * gap, slope };
            }
            self.turn = turn;
            self.doubtful *= turn.fade;
            self.adrift *= turn.fade;
            if let Some(share) = flight.lying {
                // The ground carried the weight, which no train of strikes has: as one push, or as a load.
                let weight = share * self.gravity * gap.min(2.0 / omega);
                self.doubtful += weight;
                interval.doubt += swing.factor * weight;
            }
        }
        self.peak = greater(interval.peak.value, self.peak);
        self.walk.shortest_gap_s = lesser(gap, self.walk.shortest_gap_s);
        if gap < time {
            self.walk.overlaps = true;
        }
        self.before = flight.speed;
        (self.walk.late, self.walk.extra) = self.to_come(flight.speed, true);
        if flight.speed < self.floor {
            (self.walk.late, self.walk.extra) = self.to_come(self.floor, true);
        }
        self.walk.intervals[n].late = self.walk.late;
    }

    /// Bound on what a bar of such a speed does to the component from now on, and what of it one shock does; `more` than
    /// one may come.
    fn to_come(&self, speed: f64, more: bool) -> (f64, f64) {
        let Part { ends, swing, shocks, time, .. } = self.part;
        if shocks {
            let shock = later_shock(speed, ends.e, self.gravity, time);
            return (shock, shock);
        }
        // As if both ends pushed the same way, and threw back all of the speed: the study holds what follows from that.
        let times = if more { pile_until_rest(self.pile, swing, speed, self.fall, true) } else { 1.0 };
        let [extra, coming] = [1.0, times].map(|times| later_response(swing, speed, 1.0, times, self.fall));
        let all = swing.bound(self.motion) + self.adrift + coming;
        (if all.is_nan() { f64::INFINITY } else { all }, extra)
    }

    /// Whether real tilt is off by more than the tolerance by the strikes so far, which later ones seldom mend: twice
    /// that where the last one holds the peak, since the next may hold a higher one.
    fn is_off(&self, tolerance: f64) -> bool {
        let (walk, limit) = (&self.walk, tolerance * self.peak);
        if walk.off_at_most() <= limit {
            return false;
        }
        let lates = walk.lates();
        let peak = walk.intervals[lates.highest].peak.value;
        let (error, least) = walk.followed(&walk.tilted, peak, &lates);
        let rises = if lates.highest + 1 == walk.strikes { 2.0 } else { 1.0 };
        lesser(error, least) > rises * tolerance * peak
    }

    /// Whether nothing later counts.
    fn is_over(&mut self, flight: &Flight) -> bool {
        let time = self.part.time;
        let is_over = self.walk.late < CLEAR * self.peak && flight.gap_s >= time;
        if is_over {
            // Strikes of other models may be later than those of this one.
            // A flat drop has all of it at the first touch, and a time limit is above 0.
            let until_s = 1.25 * self.walk.last_s + 0.5 * (flight.gap_s + time);
            self.walk.until_s = until_s.max(f64::MIN_POSITIVE);
        }
        is_over
    }

    fn strike(&mut self, step: &Step, flight: &Flight) {
        let Part { ends, swing, omega, time, shocks, .. } = self.part;
        let n = self.walk.strikes;
        self.walk.last_s += flight.gap_s;
        // The ground also carries the weight while it pushes.
        self.doubtful += self.gravity * if n == 0 { time } else { lesser(time, flight.gap_s) };
        self.couple(step);
        let both = step.together.map(|lasts| (lasts, TwoShocks::of(ends, step.landing.end, step.delta_v)));
        let delta_v = match both {
            // The first of both contacts is the shock.
            Some((_, parts)) if shocks => parts.first,
            _ => ends.at(step.delta_v),
        };
        let last = delta_v.abs();
        let (mut gross, mut shape) = (last, 0.0);
        if let Some((lasts, parts)) = both {
            gross = parts.first.abs() + parts.other.abs();
            shape = parts.other.abs() + ends.flat[0] * ends.flat[1] * parts.first.abs();
            // Pulses as if at one instant, of contacts that last.
            self.doubtful += if shocks { 0.0 } else { shape * (0.5 * omega * lasts * time).min(2.0) };
            let jump = swing.quantity(Motion { x: 0.0, w: gross });
            self.walk.jumps = self.walk.jumps.max(swing.quantity(self.motion).abs() + jump.abs());
        }
        let beat = &mut self.beats[n];
        *beat = Beat {
            landing: step.landing,
            gap_s: flight.gap_s,
            delta_v,
            gross,
            together: both.is_some(),
            begun: self.begun,
            met: self.motion,
            turn: self.turn,
        };
        let before = n.checked_sub(1).map(|before| &self.walk.intervals[before].peak);
        Lag::strike(from_mut(&mut self.walk.tilted), from_ref(&step.tilted), n, (beat, &self.part, before));
        let from_s = self.walk.last_s;
        let interval = &mut self.walk.intervals[n];
        interval.from_s = from_s;
        if shocks {
            interval.peak.value = last;
            interval.doubt = shape + self.doubtful;
        } else {
            let mistimed = self.blur * from_s + if flight.lying.is_some() { LYING * flight.gap_s } else { 0.0 };
            self.adrift += swing.factor * last * lesser(omega * mistimed, 2.0);
            interval.adrift = self.adrift;
            interval.doubt = swing.factor * self.doubtful;
        }
        // Read at once as a whole, what was written in part is waited for.
        self.motion = Motion { x: self.motion.x, w: self.motion.w - delta_v };
        self.begun = self.motion;
        self.walk.strikes += 1;
    }

    /// What the last contacts and this strike do to each other.
    fn couple(&mut self, step: &Step) {
        let (Part { ends, shocks, .. }, coupled, n) = (self.part, &step.coupled, self.walk.strikes);
        let end = step.landing.end;
        let delta_v = ends.at(step.delta_v);
        let mut doubt = if coupled.presses && shocks { delta_v.abs() } else { 0.0 };
        if let Some(other) = &coupled.other {
            // What the component gets of a velocity that a contact gives.
            let at = |given: f64, contact: (f64, f64), end: usize| {
                let own = of(contact, end);
                if own == 0.0 { given } else { given * (ends.at(contact) / own).abs() }
            };
            doubt += at(other.pushed, other.delta_v, 1 - end);
            doubt += if other.held > 0.0 { at(other.held, step.delta_v, end) } else { 0.0 };
            if shocks {
                doubt += other.window([ends.at(other.delta_v), delta_v]);
            }
        }
        if doubt > 0.0 {
            // All that a contact which is still there has a part in.
            let unit = self.part.swing.factor;
            for interval in self.walk.intervals[..n].iter_mut().rev() {
                interval.doubt += unit * doubt;
                if self.walk.last_s - interval.from_s >= self.part.time {
                    break;
                }
            }
        }
        self.doubtful += doubt + coupled.astray * delta_v.abs();
    }

    /// Which end strikes first may not be known: the other one may do so, and be thrown up only then.
    fn rival(&mut self, step: &Step, follows_s: f64) {
        let (later_by, delta_v) = step.rival;
        if later_by < self.blur * (self.walk.last_s + follows_s) {
            let (unit, shock) = (self.part.swing.factor, self.part.ends.at(delta_v).abs());
            self.walk.intervals[self.walk.strikes - 1].doubt += unit * shock;
            self.doubtful += shock;
        }
    }

    /// Nothing falls any more.
    fn rest(&mut self, step: &Step) {
        let interval = &mut self.walk.intervals[self.walk.strikes - 1];
        if !self.part.shocks {
            interval.peak = self.part.swing.peak(self.motion, f64::INFINITY);
        }
        (self.walk.late, self.walk.extra) = (0.0, 0.0);
        if self.gravity > 0.0 {
            // The ground carries it from now on, and impacts have bounces left.
            self.rests = self.walk.strikes > 1;
            (self.walk.late, self.walk.extra) = self.to_come(self.part.ends.reach(step.twice_energy), false);
        }
    }

    /// The coarse lanes along the strikes followed. Where nothing falls any more, parabolas may have bounces left.
    pub(super) fn coarse(&mut self, trail: &mut impl Strikes, lags: &mut [Lag; 2]) {
        lags[0].is_map = true;
        for (n, beat) in self.beats[..self.walk.strikes].iter().enumerate() {
            let Alike { own, spread } = &trail.coarse(n, &beat.landing);
            let last = n.checked_sub(1).map(|last| &self.walk.intervals[last].peak);
            Lag::strike(lags, own, n, (beat, &self.part, last));
            lags[0].off[n].all += self.part.swing.factor * beat.gross * spread;
        }
        if self.rests
            && let Some(left) = trail.course().left_as_parabolas()
        {
            let (late, extra) = self.to_come(self.part.ends.reach(left), false);
            if late > self.walk.late {
                (self.walk.late, self.walk.extra) = (late, extra);
            }
        }
    }

    /// Sum and largest of the whole train of the map at the component, once the coarse lanes were followed; infinite
    /// where it is long.
    pub(super) fn train(&self, trail: &impl Strikes) -> [f64; 2] {
        let [mut net, mut largest] = [0.0; 2];
        for (k, (.., delta_v)) in trail.map().into_iter().flat_map(Clone::clone).enumerate() {
            if k > 2 * STRIKES {
                net = f64::INFINITY;
                break;
            }
            let delta_v = self.part.ends.at(delta_v);
            largest = greater(delta_v.abs(), largest);
            net += delta_v;
        }
        [net, largest]
    }
}
