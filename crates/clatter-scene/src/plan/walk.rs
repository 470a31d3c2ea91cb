//! The first strikes of a drop as one component has them, in four lanes at once.

use super::bounds::{later_response, later_shock, pile_until_rest, weight};
use super::coupling::of;
use super::ends::Ends;
use super::floats::{greater, lesser};
use super::lane::MapLane;
use super::swing::{Motion, Swing};
use super::trail::{Course, Step, Strikes};

/// What later strikes can do must stay below this share of the peak for the following to stop: pulses flatten both, not
/// alike.
const CLEAR: f64 = 0.9;

/// Later strikes that could add more than this share of the peak are not foreseen from the earlier ones.
const ROOM: f64 = 0.5;

/// Fitted: an end that lies down mistimes what the other one does by this share of the time until then.
const LYING: f64 = 0.03;

/// Phases up to which a motion is taken as a straight line.
const STRAIGHT: f64 = 0.1;

/// One interval between strikes, as the lane with all physics has it.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Interval {
    /// When it begins.
    from_s: f64,
    /// Largest value, and the phase at which it stands.
    pub(super) value: f64,
    pub(super) phase: f64,
    /// Rate of the value by the phase there: below 0 where a shock begins the interval, above 0 where the next one ends
    /// it.
    pub(super) slope: f64,
    /// Bound on how far the map, the parabolas and real tilt are off it, and by what more at its beginning.
    off: [f64; 3],
    beginning: [f64; 3],
    /// Bound on how far all of them are off beside.
    doubt: f64,
    /// Bound on what a lane has before it that strikes earlier.
    early: [f64; 3],
    /// By how much more it may ring where strikes are mistimed in all models.
    adrift: f64,
    /// Bound on all that comes after it.
    late: f64,
}

impl Interval {
    fn is_higher(&self, other: &Self) -> bool {
        self.value > other.value
    }
    /// Bound on how far lane k is off its largest value.
    fn off(&self, k: usize) -> f64 {
        let off = self.off[k] + self.doubt + if self.phase > 0.0 { 0.0 } else { self.beginning[k] };
        if off.is_nan() { f64::INFINITY } else { off }
    }
}

/// What one component has of the strikes followed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Walk<const N: usize> {
    intervals: [Interval; N],
    strikes: usize,
    /// Bound on the response, or shock, after the strikes followed; what of it one more shock does.
    pub(super) late: f64,
    extra: f64,
    /// Until when models need to be followed for nothing later to exceed the peak.
    pub(super) until_s: f64,
    /// Largest and sum of the shocks of the map.
    pub(super) largest: f64,
    pub(super) net: f64,
    pub(super) last_s: f64,
    pub(super) shortest_gap_s: f64,
    pub(super) overlaps: bool,
    /// What the weight does in the end, which no train has.
    weight: f64,
    /// Bound on what impacts, one after the other at one instant, do on the way.
    pub(super) jumps: f64,
    /// Lanes that have had the same strikes so far.
    alive: [bool; 3],
    /// Whether real tilt is off by more than the tolerance, whatever comes later.
    pub(super) is_certain: bool,
}

impl<const N: usize> Walk<N> {
    /// The interval that holds the peak.
    pub(super) fn peak(&self) -> Interval {
        let none = Interval::default();
        let highest = |most, interval| if Interval::is_higher(interval, most) { interval } else { most };
        *self.intervals[..self.strikes].iter().fold(&none, highest)
    }
    /// What each lane gets wrong, if pulses leave `top` of the `peak`: by the strikes followed, and by all.
    pub(super) fn errors(&self, peak: &Interval, top: f64) -> [[f64; 2]; 3] {
        let followed = self.followed([0, 1, 2], peak, top);
        [0, 1, 2].map(|k| {
            let [error, least] = followed[k];
            [error, greater(self.later(k, peak.value), error)].map(|error| lesser(least, error))
        })
    }
    /// Bounds on all that comes after the intervals.
    fn lates(&self) -> [f64; N] {
        let (mut lates, mut most) = ([0.0; N], self.late);
        for (late, interval) in lates.iter_mut().zip(&self.intervals[..self.strikes]).rev() {
            most = greater(interval.late, most);
            *late = most;
        }
        lates
    }
    /// What these lanes get wrong by the strikes followed, and what they get wrong at most if what follows some
    /// interval is left to its bound.
    #[inline]
    fn followed<const K: usize>(&self, lanes: [usize; K], peak: &Interval, top: f64) -> [[f64; 2]; K] {
        let mut errors = lanes.map(|k| [peak.off(k), f64::INFINITY]);
        for (interval, late) in self.intervals[..self.strikes].iter().zip(self.lates()) {
            // Another that comes up to the top may be the higher one.
            let short = lesser(interval.value + interval.adrift - top, 0.0);
            for ([error, least], k) in errors.iter_mut().zip(lanes) {
                *error = greater(interval.early[k] - top, greater(interval.off(k) + short, *error));
                // From the peak on, what follows may be left to its bound.
                if interval.from_s >= peak.from_s {
                    *least = lesser(greater(late - top, *error), *least);
                }
            }
        }
        errors
    }
    /// What lane k may get wrong after the strikes followed.
    fn later(&self, k: usize, peak: f64) -> f64 {
        let above = self.late - peak;
        let intervals = &self.intervals[..self.strikes];
        // The map has no later strikes; the others have them, about.
        if above <= 0.0 || k == 0 || self.extra >= ROOM * peak {
            return above;
        }
        let worst = intervals.iter().fold(0.0, |m, i| greater(i.off[k] + i.doubt, m));
        // Fitted: what later strikes add is off by 4 times what the earlier ones were.
        let share = if self.alive[k] { 4.0 * (worst / peak).min(1.0) } else { 4.0 };
        above.min(share * self.extra + self.weight + intervals.last().map_or(0.0, |i| i.off[k] + i.doubt))
    }
    /// Strikes until `until_s`, about, of models with impacts (until they have fallen by 10⁻¹⁵, both ends in turn) and
    /// with contacts (until both ends lie on their springs).
    pub(super) fn about(&self, e: f64) -> (f64, f64) {
        let loss = 0.05 - libm::log(e.max(1e-30));
        #[expect(clippy::cast_precision_loss, reason = "a few strikes")]
        let followed = self.strikes as f64;
        if self.until_s < f64::INFINITY { (followed, followed) } else { (followed + 240.0 / loss, 2.0 + 8.0 / loss) }
    }
}

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

impl Meeting<'_> {
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
        let met = self.swing.after(&self.swing.turn(greater(self.turned + phase, 0.0)), self.begun);
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

/// Follows strikes until nothing later counts.
#[derive(Debug)]
pub(super) struct Walker<'a, const N: usize> {
    ends: &'a Ends,
    swing: &'a Swing,
    /// Velocity shocks are asked for, not a response.
    shocks: bool,
    /// Contact time; 0 where it is not known.
    time: f64,
    gravity: f64,
    omega: f64,
    /// The speed that the weight gives in one radian of the component.
    fall: f64,
    /// Share of the time since the first strike by which strikes are mistimed.
    blur: f64,
    /// How many times the largest later shock the speeds of all later ones allow.
    pile: f64,
    walk: Walk<N>,
    /// The component now, and just after the last strike.
    motion: Motion,
    begun: Motion,
    peak: f64,
    /// Motion of the component in the other lanes less this one, and by how much later their strikes come than that has
    /// it.
    off: [Motion; 3],
    behind_s: [f64; 3],
    /// Shocks that a lane lacks, and shocks in doubt, faded.
    lacking: [f64; 3],
    doubtful: f64,
    /// How much higher the component may ring where strikes are mistimed.
    adrift: f64,
    /// Speed at the component before the last strike, and what overlapping contacts leave of it.
    before: f64,
    floor: f64,
    /// Bound on what later strikes of the lane with all physics add.
    coming: f64,
}

impl<'a, const N: usize> Walker<'a, N> {
    pub(super) fn new(
        (ends, swing, course): (&'a Ends, &'a Swing, &Course),
        shocks: bool,
        gravity: f64,
        omega: f64,
    ) -> Self {
        let fall = gravity / omega;
        let weight = if shocks { 0.0 } else { weight(swing, fall) };
        Self {
            ends,
            swing,
            shocks,
            time: course.contact_s,
            gravity,
            omega,
            fall,
            blur: course.blur,
            pile: course.pile,
            walk: Walk {
                intervals: [Interval::default(); N],
                strikes: 0,
                late: 0.0,
                extra: 0.0,
                until_s: f64::INFINITY,
                largest: 0.0,
                net: 0.0,
                last_s: 0.0,
                shortest_gap_s: f64::INFINITY,
                overlaps: false,
                weight,
                jumps: 0.0,
                alive: [true; 3],
                is_certain: false,
            },
            motion: Motion::default(),
            begun: Motion::default(),
            peak: 0.0,
            off: [Motion::default(); 3],
            behind_s: [0.0; 3],
            lacking: [0.0; 3],
            doubtful: 0.0,
            adrift: 0.0,
            before: 0.0,
            floor: 0.0,
            coming: f64::INFINITY,
        }
    }

    /// Until nothing later counts, or until real tilt can not be within the tolerance any more.
    pub(super) fn follow(&mut self, trail: &mut impl Strikes, tolerance: f64) -> &Walk<N> {
        self.before = self.ends.reach(trail.course().twice_energy);
        let mut flight = Flight { gap_s: 0.0, lying: None, tumbles: false, speed: self.before };
        while let Some(step) = trail.step(self.walk.strikes) {
            self.strike(step, &flight);
            let Some(follows) = step.follows else {
                self.rest(step);
                break;
            };
            self.rival(step, follows);
            let lying = step.rests.map(|end| {
                let other = -self.ends.flat[end];
                self.ends.at(if end == 0 { (1.0, other) } else { (other, 1.0) }).abs()
            });
            let speed = self.ends.reach(step.twice_energy);
            flight = Flight { gap_s: follows, lying, tumbles: step.tumbles, speed };
            self.floor = greater(step.rebound * self.before, self.floor);
            self.fly(trail, &flight);
            if self.is_over(&flight) {
                break;
            }
            if tolerance < f64::INFINITY && self.is_certain(tolerance) {
                self.walk.is_certain = true;
                // Not looked at.
                (self.walk.net, self.walk.largest) = (f64::INFINITY, f64::INFINITY);
                return &self.walk;
            }
        }
        if !self.shocks {
            self.take_map(trail.course().map.clone());
        }
        &self.walk
    }

    fn unit(&self) -> f64 {
        if self.shocks { 1.0 } else { self.swing.factor }
    }

    /// From the last strike to the next.
    fn fly(&mut self, trail: &mut impl Strikes, flight: &Flight) {
        let (swing, omega, gap, time) = (self.swing, self.omega, flight.gap_s, self.time);
        let n = self.walk.strikes - 1;
        let interval = &mut self.walk.intervals[n];
        if !self.shocks {
            let turn = trail.turn(n, swing, omega * gap);
            let last = swing.after(&turn, self.motion);
            let (end, rate) = (swing.quantity(last), swing.quantity(swing.rate(last)));
            if swing.square(self.motion) > 0.25 * self.peak * self.peak {
                let top = swing.peak_before(self.motion, omega * gap, rate);
                (interval.value, interval.phase, interval.slope) = (top.value, top.phase, top.slope);
            }
            self.motion = last;
            if end.abs() > interval.value {
                (interval.value, interval.phase) = (end.abs(), omega * gap);
                interval.slope = greater(rate * end.signum(), 0.0);
            }
            for (off, lacking) in self.off.iter_mut().zip(&mut self.lacking) {
                *off = swing.after(&turn, *off);
                *lacking *= turn.fade;
            }
            self.doubtful *= turn.fade;
            self.adrift *= turn.fade;
            if let Some(share) = flight.lying {
                // The ground carried the weight, which no train of strikes has: as one push, or as a load.
                let weight = share * self.gravity * gap.min(2.0 / omega);
                self.doubtful += weight;
                interval.doubt += swing.factor * weight;
            }
        }
        self.peak = greater(interval.value, self.peak);
        self.walk.shortest_gap_s = lesser(gap, self.walk.shortest_gap_s);
        if gap < time {
            self.walk.overlaps = true;
        }
        self.before = flight.speed;
        (self.walk.late, self.walk.extra, self.coming) = self.to_come(flight.speed, true);
        if flight.speed < self.floor {
            (self.walk.late, self.walk.extra, _) = self.to_come(self.floor, true);
        }
        self.walk.intervals[n].late = self.walk.late;
    }

    /// Bound on what a bar of such a speed does to the component from now on, and what of it one shock and all of them
    /// do; `more` than one may come.
    fn to_come(&self, speed: f64, more: bool) -> (f64, f64, f64) {
        if self.shocks {
            let shock = later_shock(speed, self.ends.e, self.gravity, self.time);
            return (shock, shock, shock);
        }
        // As if both ends pushed the same way, and threw back all of the speed: the study holds what follows from that.
        let times = if more { pile_until_rest(self.pile, self.swing, speed, self.fall, true) } else { 1.0 };
        let [extra, coming] = [1.0, times].map(|times| later_response(self.swing, speed, 1.0, times, self.fall));
        let all = self.swing.bound(self.motion) + self.adrift + coming;
        (if all.is_nan() { f64::INFINITY } else { all }, extra, coming)
    }

    /// Whether real tilt is off by more than the tolerance, whatever strikes still come.
    ///
    /// As long as the peak stays where it is, what `Walk::followed` has counted against it only grows; and where pulses
    /// flatten the peak, its share does not fall.
    fn is_certain(&self, tolerance: f64) -> bool {
        self.rises_are_off(tolerance) && {
            let peak = self.walk.peak();
            let [[error, least]] = self.walk.followed([2], &peak, peak.value);
            lesser(error, least) > tolerance * peak.value
        }
    }

    /// Whether it is so of every later interval that passes the peak.
    fn rises_are_off(&self, tolerance: f64) -> bool {
        let lost = !self.walk.alive[2];
        if self.shocks {
            // A lane that has lost the strikes is off by each. Of both contacts at once, the first may be more than the
            // two together.
            return lost && tolerance < 1.0 || self.doubtful > 2.0 * tolerance * self.coming;
        }
        // In the share f that is left of it, the motion is at most f times its envelope, and the doubt f times what it
        // is now.
        let swing = self.swing;
        let doubt = swing.factor * (self.lacking[2] + self.doubtful);
        let [now, unit] = [self.motion, Motion { x: 0.0, w: 1.0 }].map(|motion| swing.envelope(motion));
        if lost && doubt > tolerance * now && swing.factor > tolerance * unit {
            return true;
        }
        // To pass the peak with all that comes, the motion must have kept this much; the doubt has then kept the same
        // share.
        let kept = self.peak - self.coming;
        if kept >= now || doubt * kept > tolerance * now * self.peak {
            return true;
        }
        // Or an earlier interval counts, however high the peak gets.
        let most = greater(swing.bound(self.motion) + self.coming, self.peak);
        let off = |interval: &Interval| interval.off(2) + lesser(interval.value + interval.adrift - most, 0.0);
        self.walk.intervals[..self.walk.strikes].iter().any(|interval| off(interval) > tolerance * most)
    }

    /// Whether nothing later counts, or is known.
    fn is_over(&mut self, flight: &Flight) -> bool {
        let time = self.time;
        if self.walk.late < CLEAR * self.peak && flight.gap_s >= time {
            // Strikes of other models may be later than those of this one.
            // A flat drop has all of it at the first touch, and a time limit is above 0.
            let until_s = 1.25 * self.walk.last_s + 0.5 * (flight.gap_s + time);
            self.walk.until_s = until_s.max(f64::MIN_POSITIVE);
            return true;
        }
        flight.tumbles || self.walk.strikes == N
    }

    fn strike(&mut self, step: &Step, flight: &Flight) {
        let (ends, swing, omega, time, shocks) = (self.ends, self.swing, self.omega, self.time, self.shocks);
        let n = self.walk.strikes;
        self.walk.last_s += flight.gap_s;
        // The ground also carries the weight while it pushes.
        self.doubtful += self.gravity * if n == 0 { time } else { lesser(time, flight.gap_s) };
        self.couple(step);
        let both = step.together.map(|lasts| (lasts, Parts::of(ends, step.end, step.delta_v)));
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
        let mistimed = self.blur * self.walk.last_s + if flight.lying.is_some() { LYING * flight.gap_s } else { 0.0 };
        self.adrift += swing.factor * last * lesser(omega * mistimed, 2.0);
        if n > 0 && self.walk.intervals[n - 1].slope > 0.0 {
            // A value that the next shock cuts off is as high as that is late.
            let cut = &mut self.walk.intervals[n - 1];
            for (off, own) in cut.off.iter_mut().zip(step.own) {
                *off += own.map_or(0.0, |(after, _)| cut.slope * (omega * (after - flight.gap_s)).abs().min(2.0));
            }
        }
        if n > 0 && !shocks && self.walk.intervals[n - 1].phase <= omega * time {
            // A pulse that ends on a dashpot is cut off by the next where only one of both trains has them overlap.
            let over = |gap: f64| if gap < time { 1.0 - gap / time } else { 0.0 };
            let here = over(flight.gap_s);
            let jump = swing.quantity(Motion { x: 0.0, w: last }).abs();
            for (off, own) in self.walk.intervals[n - 1].off.iter_mut().zip(step.own) {
                *off += own.map_or(0.0, |(after, _)| jump * (over(after) - here).abs());
            }
        }
        let from_s = self.walk.last_s;
        let interval = &mut self.walk.intervals[n];
        interval.from_s = from_s;
        if shocks {
            interval.value = last;
        } else {
            interval.adrift = self.adrift;
        }
        let (rate, turned) = (swing.rate(self.motion), omega * flight.gap_s);
        let square = swing.square(rate);
        let meeting = Meeting { swing, begun: self.begun, motion: self.motion, turned, rate, square };
        for k in 0..3 {
            let Some((after, own)) = step.own[k] else {
                self.walk.alive[k] = false;
                self.lacking[k] += gross;
                interval.off[k] =
                    if shocks { last } else { swing.bound(self.off[k]) + swing.factor * self.lacking[k] };
                continue;
            };
            if shocks {
                let own = if both.is_some() { Parts::of(ends, step.end, own).first } else { ends.at(own) };
                interval.off[k] = (own - delta_v).abs();
                continue;
            }
            let (mut off, own) = (self.off[k], ends.at(own));
            let behind_s = self.behind_s[k] + after - flight.gap_s;
            off.w -= own - delta_v;
            let shifted = meeting.shift(own, omega * behind_s);
            self.behind_s[k] = if shifted.goes_on { behind_s } else { 0.0 };
            off = Motion { x: off.x + shifted.by.x, w: off.w + shifted.by.w };
            (interval.beginning[k], interval.early[k]) = (shifted.beginning, shifted.early);
            self.off[k] = off;
            interval.off[k] = swing.bound(off) + swing.factor * self.lacking[k];
        }
        interval.doubt = if shocks { shape + self.doubtful } else { swing.factor * self.doubtful };
        interval.off[0] += if shocks { 1.0 } else { swing.factor } * gross * step.spread;
        self.motion.w -= delta_v;
        self.begun = self.motion;
        self.walk.strikes += 1;
    }

    /// What the last contacts and this strike do to each other.
    fn couple(&mut self, step: &Step) {
        let (ends, coupled, shocks, n) = (self.ends, &step.coupled, self.shocks, self.walk.strikes);
        let delta_v = ends.at(step.delta_v);
        let mut doubt = if coupled.presses && shocks { delta_v.abs() } else { 0.0 };
        if let Some(other) = &coupled.other {
            // What the component gets of a velocity that a contact gives.
            let at = |given: f64, contact: (f64, f64), end: usize| {
                let own = of(contact, end);
                if own == 0.0 { given } else { given * (ends.at(contact) / own).abs() }
            };
            doubt += at(other.pushed, other.delta_v, 1 - step.end);
            doubt += if other.held > 0.0 { at(other.held, step.delta_v, step.end) } else { 0.0 };
            if shocks {
                doubt += other.window([ends.at(other.delta_v), delta_v]);
            }
        }
        if doubt > 0.0 {
            // All that a contact which is still there has a part in.
            let unit = self.unit();
            for interval in self.walk.intervals[..n].iter_mut().rev() {
                interval.doubt += unit * doubt;
                if self.walk.last_s - interval.from_s >= self.time {
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
            let (unit, shock) = (self.unit(), self.ends.at(delta_v).abs());
            self.walk.intervals[self.walk.strikes - 1].doubt += unit * shock;
            self.doubtful += shock;
        }
    }

    /// Nothing falls any more.
    fn rest(&mut self, step: &Step) {
        let interval = &mut self.walk.intervals[self.walk.strikes - 1];
        if !self.shocks {
            let top = self.swing.peak(self.motion, f64::INFINITY);
            (interval.value, interval.phase, interval.slope) = (top.value, top.phase, top.slope);
        }
        (self.walk.late, self.walk.extra) = (0.0, 0.0);
        if self.gravity > 0.0 {
            // The ground carries it from now on, and impacts have bounces left.
            (self.walk.late, self.walk.extra, _) = self.to_come(self.ends.reach(step.twice_energy), false);
        }
    }

    /// The closed form has the whole train of the map.
    fn take_map(&mut self, map: MapLane) {
        let walk = &mut self.walk;
        for (k, (.., delta_v)) in map.enumerate() {
            if k > 2 * N {
                walk.net = f64::INFINITY;
                break;
            }
            let delta_v = self.ends.at(delta_v);
            walk.largest = greater(delta_v.abs(), walk.largest);
            walk.net += delta_v;
        }
    }
}

/// What both contacts do to the component's place where they act at once.
#[derive(Debug, Clone, Copy)]
struct Parts {
    /// That of the end that lands, and of the one that lay.
    first: f64,
    other: f64,
}

impl Parts {
    fn of(ends: &Ends, landed: usize, (a, b): (f64, f64)) -> Self {
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
