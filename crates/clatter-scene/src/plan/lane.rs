//! One bar, strike by strike, with as much physics as its lane keeps.
//!
//! Between strikes both ends follow parabolas. With real tilt the turning bends them by `−σ L ω² sin φ`: its means over
//! the flight, as it acts on the height and on the velocity, are series in the angle turned, whose fifth powers are
//! left out. A contact moves the bar as one impulse at its centroid does: beside the jump Δv both ends are set back by
//! Δv times that time. The jump grows by what the contact carries of the weight.

use super::both::Both;
use super::ends::Ends;
use super::floats::{greater, lesser};
use super::pulse::Pulse;

/// A strike: the end, the time since the last one, and velocity shocks of both ends.
pub(super) type Strike = (usize, f64, (f64, f64));

/// The same strike in another lane: the time since the last one, and velocity shocks of both ends.
pub(super) type Own = (f64, (f64, f64));

/// The map: a bar without gravity, whose ends strike in turn.
#[derive(Debug, Clone)]
pub(super) struct MapLane {
    /// The end that strikes next.
    end: usize,
    /// Heights, velocities and inertia ratios, of that end first.
    height: [f64; 2],
    velocity: [f64; 2],
    ratio: [f64; 2],
    /// 1 + e
    gain: f64,
    touched: bool,
}

impl MapLane {
    /// At the first touch, as the other lane has it.
    pub(super) fn start(ends: &Ends, lane: &Lane<false>) -> Self {
        let Lane { height, velocity, .. } = *lane;
        Self { end: 0, height, velocity, ratio: ends.flat, gain: 1.0 + ends.e, touched: false }
    }
}

impl Iterator for MapLane {
    type Item = Strike;

    #[inline]
    fn next(&mut self) -> Option<Strike> {
        let ([height, other], [fall, rise], end) = (self.height, self.velocity, self.end);
        // The one that struck goes up.
        if self.touched && fall >= 0.0 {
            return None;
        }
        // Speeds do not wait for heights, so that their reciprocal is there before.
        let after = if self.touched { greater(height * (1.0 / -fall), 0.0) } else { 0.0 };
        let jump = -self.gain * lesser(fall, 0.0);
        let back = -self.ratio[0] * jump;
        *self = Self {
            end: 1 - end,
            height: [other + after * rise, 0.0],
            velocity: [rise + back, fall + jump],
            ratio: [self.ratio[1], self.ratio[0]],
            touched: true,
            ..*self
        };
        Some((end, after, if end == 0 { (jump, back) } else { (back, jump) }))
    }
}

/// The state of one lane with gravity just after a strike, with real tilt or as parabolas.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lane<const TILTS: bool> {
    height: [f64; 2],
    velocity: [f64; 2],
    gravity: f64,
    /// Time from touch to centroid, and in which the weight gives what a contact carries of it.
    delay: f64,
    carried: f64,
    /// Time over the speed of an end within which the other must land for that one not to lie down: at least two thirds
    /// of it.
    brief: f64,
    down: Down,
    /// How it turns now.
    sweep: Sweep,
}

/// What lies on the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Down {
    Nothing,
    /// One end, and the other turns about it, after the time that its bounces took.
    End(usize, f64),
    Bar,
}

/// An end whose bounces all end within this share of the time that the other needs to land is down at once.
const BRIEF: f64 = 0.05;

/// The turning of a lane: sine of the angle, its rate, and the spin squared.
#[derive(Debug, Clone, Copy)]
struct Sweep {
    sin: f64,
    rate: f64,
    spin2: f64,
}

/// cos² of the angle from which on a bar counts as upright: its sine no longer tells how fast it turns.
const LEAST_COS2: f64 = 1e-3;

impl Sweep {
    /// Means of sin φ over a time, as it acts on heights and on velocities: series of
    /// `2 (sin φ + x cos φ − sin(φ + x))/x²` and `(cos φ − cos(φ + x))/x`, x = ω t.
    #[inline]
    fn means(&self, t: f64) -> [f64; 2] {
        let (x2, turned) = (self.spin2 * t * t, self.rate * t);
        [
            self.sin * (1.0 - x2 * (1.0 / 12.0)) + turned * (1.0 / 3.0 - x2 * (1.0 / 60.0)),
            self.sin * (1.0 - x2 * (1.0 / 6.0)) + turned * (0.5 - x2 * (1.0 / 24.0)),
        ]
    }
}

/// The next strike of a lane.
#[derive(Debug, Clone, Copy)]
pub(super) struct Next {
    pub(super) end: usize,
    /// Time since the last one.
    pub(super) after: f64,
    /// Downward acceleration of an end that turns about the other.
    turning: f64,
    /// Whether the bar turns upright or over before: what strikes then is not known from parabolas.
    pub(super) tumbles: bool,
    /// When the other end would strike, and how fast; infinite where it does not fall.
    pub(super) rival: [f64; 2],
}

/// No rival.
const ALONE: [f64; 2] = [f64::INFINITY, 0.0];

impl Next {
    /// The first touch.
    pub(super) const FIRST: Self = Self { end: 0, after: 0.0, turning: 0.0, tumbles: false, rival: ALONE };
}

/// Time until `h + v t − ½ g t²` comes to 0, the later root where it starts upward; 0 where it is below.
#[inline]
fn fall(h: f64, v: f64, g: f64) -> f64 {
    let square = v * v + 2.0 * g * h;
    if g <= 0.0 {
        return if v < 0.0 && square >= 0.0 { (2.0 * h / (square.sqrt() - v)).max(0.0) } else { f64::INFINITY };
    }
    let root = greater(square, 0.0).sqrt();
    // One division for either root.
    let (over, under) = if v >= 0.0 { (v + root, g) } else { (2.0 * h, root - v) };
    if square < 0.0 { 0.0 } else { greater(over / under, 0.0) }
}

impl Lane<true> {
    pub(super) fn with_contact(self, pulse: &Pulse, time: f64) -> Self {
        Self { delay: time * pulse.centroid, carried: time * pulse.carried, ..self }
    }
}

impl<const TILTS: bool> Lane<TILTS> {
    /// At the first touch: the speed, the spin as it turns a bar that lies flat, the height of end b.
    pub(super) fn start(ends: &Ends, (speed, spin, gap): (f64, f64, f64), gravity: f64) -> Self {
        let [a, b] = ends.arm;
        let velocity = [-speed - a * spin, -speed + b * spin];
        let brief = 4.0 / (3.0 * BRIEF * gravity * (1.0 - ends.e));
        let sweep = Sweep { sin: 0.0, rate: 0.0, spin2: 0.0 };
        let flat =
            Self { height: [0.0, gap], velocity, gravity, delay: 0.0, carried: 0.0, brief, down: Down::Nothing, sweep };
        flat.turning(ends)
    }
    /// The same with its turning worked out from heights and velocities; of parabolas only the energy asks for it.
    #[inline]
    fn turning(self, ends: &Ends) -> Self {
        if !TILTS {
            return self;
        }
        let sin = ends.over * (self.height[1] - self.height[0]);
        let rate = ends.over * (self.velocity[1] - self.velocity[0]);
        let cos2 = greater((1.0 - sin) * (1.0 + sin), LEAST_COS2);
        Self { sweep: Sweep { sin, rate, spin2: rate * rate / cos2 }, ..self }
    }
    /// The next strike, put in its place: copied it would be waited for. `false` if nothing falls.
    #[inline]
    pub(super) fn next(&self, ends: &Ends, next: &mut Next) -> bool {
        match self.down {
            Down::Nothing if TILTS => self.next_tilted(ends, next),
            Down::Nothing => {
                let (a, b) = self.lands([self.gravity; 2]);
                let (end, after) = if b < a { (1, b) } else { (0, a) };
                *next = Next { end, after, ..Next::FIRST };
                after < f64::INFINITY
            }
            Down::End(i, bounced) => {
                let end = 1 - i;
                let turning = self.gravity * (1.0 + ends.flat[i]);
                let (height, velocity) = (self.height[end], self.velocity[end]);
                let after = bounced + fall(height, velocity, turning);
                let top = height + 0.5 * greater(velocity, 0.0).powi(2) / turning;
                *next = Next { end, after, turning, tumbles: top * ends.over > 1.0, ..Next::FIRST };
                after < f64::INFINITY
            }
            Down::Bar => false,
        }
    }
    /// When both ends land that sink like this.
    #[inline]
    fn lands(&self, sinks: [f64; 2]) -> (f64, f64) {
        let (h, v) = (self.height, self.velocity);
        if sinks[0] <= 0.0 || sinks[1] <= 0.0 {
            return (fall(h[0], v[0], sinks[0]), fall(h[1], v[1], sinks[1]));
        }
        // Without branches, both at once.
        let square = [v[0] * v[0] + 2.0 * sinks[0] * h[0], v[1] * v[1] + 2.0 * sinks[1] * h[1]];
        let root = [greater(square[0], 0.0).sqrt(), greater(square[1], 0.0).sqrt()];
        let over = [
            if v[0] >= 0.0 { v[0] + root[0] } else { 2.0 * h[0] },
            if v[1] >= 0.0 { v[1] + root[1] } else { 2.0 * h[1] },
        ];
        let under =
            [if v[0] >= 0.0 { sinks[0] } else { root[0] - v[0] }, if v[1] >= 0.0 { sinks[1] } else { root[1] - v[1] }];
        let times = [greater(over[0] / under[0], 0.0), greater(over[1] / under[1], 0.0)];
        (if square[0] < 0.0 { 0.0 } else { times[0] }, if square[1] < 0.0 { 0.0 } else { times[1] })
    }
    #[inline]
    fn next_tilted(&self, ends: &Ends, next: &mut Next) -> bool {
        let (g, sweep) = (self.gravity, &self.sweep);
        let (a, b) = self.lands([g; 2]);
        let first = lesser(a, b);
        if first == f64::INFINITY {
            return false;
        }
        let bend = sweep.spin2 * sweep.means(first)[0];
        let sinks = [g - ends.arm[0] * bend, g + ends.arm[1] * bend];
        let (a, b) = self.lands(sinks);
        if b < a {
            self.first_of::<1>(ends, sinks, [a, b], next)
        } else {
            self.first_of::<0>(ends, sinks, [a, b], next)
        }
    }
    /// When an end lands for which that was found from the bend at another time: once more, as a straight line.
    #[inline]
    fn again<const I: usize>(&self, ends: &Ends, after: f64) -> f64 {
        let arm = if I == 0 { -ends.arm[0] } else { ends.arm[1] };
        let [height, velocity] = self.sweep.means(after).map(|mean| self.gravity + arm * self.sweep.spin2 * mean);
        let low = self.height[I] + after * (self.velocity[I] - 0.5 * height * after);
        let (speed, most) = (self.velocity[I] - velocity * after, 0.1 * after);
        if speed < 0.0 { greater(after - greater(lesser(low / speed, most), -most), 0.0) } else { after }
    }
    /// The next strike where end i comes first, as far as that is known from the bend at another time.
    #[inline]
    fn first_of<const I: usize>(&self, ends: &Ends, sinks: [f64; 2], times: [f64; 2], next: &mut Next) -> bool {
        let (i, j, sweep) = (I, 1 - I, &self.sweep);
        if times[i] == f64::INFINITY {
            return false;
        }
        let again = |end: usize| {
            if end == 0 { self.again::<0>(ends, times[0]) } else { self.again::<1>(ends, times[1]) }
        };
        let (mut end, mut after, mut later) = (i, self.again::<I>(ends, times[i]), times[j]);
        // It moves each by a tenth at most, so that no other order is possible beyond.
        if later < 1.25 * after {
            later = again(j);
            if later < after {
                (end, after, later) = (j, later, after);
            }
        }
        let (sinks, velocity) = if end == i { (sinks[j], self.velocity[j]) } else { (sinks[i], self.velocity[i]) };
        let tumbles = (sweep.sin + after * sweep.rate).abs() > 1.0;
        *next = Next { end, after, tumbles, rival: [later, sinks * later - velocity], ..Next::FIRST };
        true
    }
    /// The strike that the lane with all physics has at this end, after this time, if this one has it too: the time
    /// since the last one, and shocks. Where that one has an end lying, so has this one; `impacts` are those on it.
    #[inline]
    pub(super) fn along(
        &mut self,
        ends: &Ends,
        (end, near): (usize, f64),
        first: bool,
        impacts: Option<&Both>,
        lying: Option<usize>,
    ) -> Option<Own> {
        let mut next = Next { end, ..Next::FIRST };
        if first && end != 0 || !first && !self.reaches(ends, near, &mut next) {
            return None;
        }
        let delta_v = match impacts {
            Some(impacts) if self.lying().is_some() => self.strike_lying(ends, &next, impacts, 0.0),
            _ => self.strike(ends, &next),
        };
        if let Some(end) = lying
            && self.lying().is_none()
        {
            self.lie(ends, end);
        }
        Some((next.after, delta_v))
    }
    /// Whether the next strike, about after the time `near`, is one of its end: when.
    #[inline]
    fn reaches(&self, ends: &Ends, near: f64, next: &mut Next) -> bool {
        if self.down != Down::Nothing {
            let end = next.end;
            return self.next(ends, next) && next.end == end;
        }
        if next.end == 0 { self.reaches_at::<0>(ends, near, next) } else { self.reaches_at::<1>(ends, near, next) }
    }
    #[inline]
    fn reaches_at<const I: usize>(&self, ends: &Ends, near: f64, next: &mut Next) -> bool {
        let (j, mut sinks) = (1 - I, [self.gravity; 2]);
        if TILTS {
            let bend = self.sweep.spin2 * self.sweep.means(near)[0];
            sinks = [sinks[0] - ends.arm[0] * bend, sinks[1] + ends.arm[1] * bend];
        }
        let mut after = fall(self.height[I], self.velocity[I], sinks[I]);
        if after == f64::INFINITY {
            return false;
        }
        if TILTS {
            after = self.again::<I>(ends, after);
        }
        next.after = after;
        // The other one is not down before.
        let speed = self.velocity[j] - sinks[j] * after;
        speed >= 0.0 || self.height[j] + 0.5 * after * (self.velocity[j] + speed) >= 0.0
    }
    /// Flies and strikes; returns the velocity shocks of both ends.
    #[inline]
    pub(super) fn strike(&mut self, ends: &Ends, next: &Next) -> (f64, f64) {
        // All that follows for a known end: what is indexed by a variable goes through memory.
        if next.end == 0 { self.strike_at::<0>(ends, next) } else { self.strike_at::<1>(ends, next) }
    }
    fn strike_at<const I: usize>(&mut self, ends: &Ends, next: &Next) -> (f64, f64) {
        let (t, [mut h0, mut h1], [mut v0, mut v1]) = (next.after, self.height, self.velocity);
        let mut falls = [self.gravity; 2];
        if let Down::End(_, bounced) = self.down {
            let speed = (t - bounced) * next.turning;
            (v0, v1) = if I == 0 { (v0 - speed, v1) } else { (v0, v1 - speed) };
            self.down = Down::Nothing;
        } else if t > 0.0 {
            let mut sinks = falls;
            if TILTS {
                let [height, velocity] = self.sweep.means(t).map(|mean| self.sweep.spin2 * mean);
                sinks = [sinks[0] - ends.arm[0] * height, sinks[1] + ends.arm[1] * height];
                falls = [falls[0] - ends.arm[0] * velocity, falls[1] + ends.arm[1] * velocity];
            }
            h0 += t * (v0 - 0.5 * sinks[0] * t);
            h1 += t * (v1 - 0.5 * sinks[1] * t);
            v0 -= t * falls[0];
            v1 -= t * falls[1];
        } else if TILTS {
            // As at the first touch.
            let velocity = self.sweep.spin2 * self.sweep.sin;
            falls = [falls[0] - ends.arm[0] * velocity, falls[1] + ends.arm[1] * velocity];
        }
        let (height, fall) = if I == 0 { (h1, v0) } else { (h0, v1) };
        let jump = self.carried * greater(falls[I], 0.0) - (1.0 + ends.e) * lesser(fall, 0.0);
        let (mut ratio, mut from_cos2, mut over_cos2) = (ends.flat[I], 1.0, 1.0);
        if TILTS {
            let sin = greater(lesser(height * ends.over, 0.9), -0.9);
            from_cos2 = (1.0 - sin) * (1.0 + sin);
            // One division for the inertia ratio and for 1/cos².
            let under = ends.arm[I] * ends.arm[I] * from_cos2 + ends.gyration2;
            let over = 1.0 / (under * from_cos2);
            ratio = (ends.arm[0] * ends.arm[1] * from_cos2 - ends.gyration2) * (from_cos2 * over);
            over_cos2 = under * over;
        }
        let back = -ratio * jump;
        let delta_v = if I == 0 { (jump, back) } else { (back, jump) };
        (h0, h1) = if I == 0 { (0.0, h1) } else { (h0, 0.0) };
        h0 -= delta_v.0 * self.delay;
        h1 -= delta_v.1 * self.delay;
        v0 += delta_v.0;
        v1 += delta_v.1;
        if TILTS {
            let sin = ends.over * (h1 - h0);
            let mut rate = ends.over * (v1 - v0);
            let mut spin2 = rate * rate * over_cos2;
            let cos2 = (1.0 - sin) * (1.0 + sin);
            if self.delay > 0.0 {
                // Set back from an angle, the spin is the same, and its vertical part is not.
                let change = rate * ((greater(cos2, LEAST_COS2) * over_cos2).sqrt() - 1.0);
                v0 -= ends.arm[0] * change;
                v1 += ends.arm[1] * change;
                rate += change;
            } else if cos2 < from_cos2 {
                // Beyond the angles that a strike is taken at.
                spin2 = rate * rate / greater(cos2, LEAST_COS2);
            }
            self.sweep = Sweep { sin, rate, spin2 };
        }
        (self.height, self.velocity) = ([h0, h1], [v0, v1]);
        let ((h, w), other) = if I == 0 { ((h0, v0), (h1, v1)) } else { ((h1, v1), (h0, v0)) };
        // Turning lifts it.
        let lift = if TILTS {
            ends.arm[I] * self.sweep.spin2 * if I == 0 { self.sweep.sin } else { -self.sweep.sin }
        } else {
            0.0
        };
        let g = self.gravity - lift;
        // Where the other lands soon, without a root.
        let soon = self.brief * w;
        let low = other.0 + soon * (other.1 - 0.5 * self.gravity * soon);
        let bounces = low < 0.0 && other.0 >= 0.0 && 2.0 * g < 3.0 * self.gravity;
        if !bounces || w * w + 2.0 * g * h < 0.0 {
            self.settle::<I>(ends, ratio, g);
        }
        delta_v
    }
    /// Lets end i lie where it would bounce ever less for a short while, or where its contact does not lift it out of
    /// the ground again.
    fn settle<const I: usize>(&mut self, ends: &Ends, ratio: f64, g: f64) {
        let (h, w) = (self.height[I], self.velocity[I]);
        let sunk = w * w + 2.0 * g * h < 0.0;
        if sunk && self.velocity[1 - I] >= 0.0 && self.is_sunk(1 - I) {
            self.down = Down::Bar;
            return;
        }
        if g > 0.0 && w >= 0.0 {
            let lands = self.lands_at(1 - I);
            if lands > 0.0 && (sunk || 2.0 * w < BRIEF * lands * g * (1.0 - ends.e)) {
                self.lie_at::<I>(ends, ratio, if sunk { 0.0 } else { lands });
            }
        }
    }
    /// Whether an end has no speed to come out of the ground with.
    fn is_sunk(&self, k: usize) -> bool {
        self.velocity[k] * self.velocity[k] + 2.0 * self.gravity * self.height[k] < 0.0
    }
    /// When end j would land by gravity alone; 0 where that is not to come.
    #[inline]
    fn lands_at(&self, j: usize) -> f64 {
        if self.gravity > 0.0 { fall(self.height[j], self.velocity[j], self.gravity) } else { 0.0 }
    }
    /// Lets an end lie; without contacts, whose ends can not sink, once its bounces have ended, if the other lands
    /// after that.
    pub(super) fn lie(&mut self, ends: &Ends, end: usize) {
        let (lands, ratio) = (self.lands_at(1 - end), ends.flat[end]);
        let sum = self.velocity[end].max(0.0) / (1.0 - ends.e);
        let lands = if self.delay > 0.0 {
            0.0
        } else if 2.0 * sum < lands * self.gravity {
            lands
        } else {
            return;
        };
        if end == 0 { self.lie_at::<0>(ends, ratio, lands) } else { self.lie_at::<1>(ends, ratio, lands) }
    }
    /// Bounces of w, e w, … last 2S/g in all, S = w/(1 − e), if they end before the other end `lands`.
    #[cold]
    fn lie_at<const I: usize>(&mut self, ends: &Ends, ratio: f64, lands: f64) {
        let (i, j, sum) = (I, 1 - I, self.velocity[I].max(0.0) / (1.0 - ends.e));
        let mut bounced = 2.0 * sum / self.gravity;
        if bounced < lands {
            self.height[j] += bounced * (self.velocity[j] - sum);
            self.velocity[j] -= (2.0 + ratio * (1.0 + ends.e)) * sum;
            if TILTS {
                // It lands with what its spin has, of which this is the vertical part.
                let sin = (self.height[j] * ends.over).min(0.9);
                self.velocity[j] /= ((1.0 - sin) * (1.0 + sin)).sqrt();
            }
        } else {
            bounced = 0.0;
        }
        (self.height[i], self.velocity[i], self.down) = (0.0, 0.0, Down::End(i, bounced));
        *self = self.turning(ends);
    }
    /// The end that lies on the ground, if one does.
    #[inline]
    pub(super) fn lying(&self) -> Option<usize> {
        if let Down::End(end, _) = self.down { Some(end) } else { None }
    }
    /// Whether the next strike presses the end that lies there into the ground.
    #[inline]
    pub(super) fn is_pressed_by(&self, ends: &Ends, next: &Next, contact_s: f64) -> bool {
        self.lying().is_some() && next.after >= contact_s && ends.flat[next.end] > 0.0
    }
    /// Flies until the other end lands, and does what both do together; returns the velocity shocks of both ends.
    pub(super) fn strike_lying(&mut self, ends: &Ends, next: &Next, both: &Both, contact_s: f64) -> (f64, f64) {
        let Down::End(_, bounced) = std::mem::replace(&mut self.down, Down::Nothing) else { return (0.0, 0.0) };
        let speed = (next.after - bounced) * next.turning - self.velocity[next.end];
        self.height = both.set_back.map(|back| speed * contact_s * back);
        self.velocity = both.velocity.map(|velocity| speed * velocity);
        let mut delta_v = self.velocity;
        delta_v[next.end] += speed;
        *self = self.turning(ends);
        match [self.is_sunk(0), self.is_sunk(1)] {
            [true, true] => self.down = Down::Bar,
            [true, false] => self.lie(ends, 0),
            [false, true] => self.lie(ends, 1),
            [false, false] => {}
        }
        (delta_v[0], delta_v[1])
    }
    /// What a strike at end i that changed its velocity by this took of twice the energy, just after that; what the
    /// contact carries of the weight takes nothing.
    #[inline]
    pub(super) fn twice_lost(&self, ends: &Ends, i: usize, jump: f64) -> f64 {
        let jump = greater(jump - self.carried * self.gravity, 0.0);
        let sin = if TILTS { self.height[1 - i] * ends.over } else { 0.0 };
        let arm2 = ends.arm[i] * ends.arm[i] * greater(1.0 - sin * sin, 0.0);
        jump * jump * ends.loss / (ends.gyration2 + arm2)
    }
    /// Twice the energy over the mass.
    #[inline]
    pub(super) fn twice_energy(&self, ends: &Ends) -> f64 {
        let [a, b] = ends.arm;
        let center = (b * self.velocity[0] + a * self.velocity[1]) * ends.over;
        let rate = (self.velocity[1] - self.velocity[0]) * ends.over;
        let spin2 = if TILTS { self.sweep.spin2 } else { rate * rate };
        let height = greater((b * self.height[0] + a * self.height[1]) * ends.over, 0.0);
        center * center + ends.gyration2 * spin2 + 2.0 * self.gravity * height
    }
}
