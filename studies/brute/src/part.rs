//! The load of a place on the bar, and the response of a suspended part there, between stops or without.

use crate::flight::{Flight, Step};
use crate::ground::LEAST_RESTITUTION;

/// A largest value and its time.
#[derive(Debug, Clone, Copy, Default)]
pub struct Peak {
    /// Its magnitude.
    pub value: f64,
    /// Its time.
    pub time: f64,
}

impl Peak {
    fn see(&mut self, value: f64, time: f64) {
        if value.abs() > self.value {
            *self = Self { value: value.abs(), time };
        }
    }
}

/// Peaks of a suspended part.
#[derive(Debug, Clone, Default)]
pub struct Response {
    /// Absolute acceleration.
    pub acceleration: Peak,
    /// Displacement relative to the place.
    pub displacement: Peak,
    /// Speeds at which it reaches the surface of a stop, in order of time.
    pub hits: Vec<Peak>,
}

impl Response {
    /// Returns the hardest hit of a stop.
    #[must_use]
    pub fn hardest(&self) -> Peak {
        let mut peak = Peak::default();
        for hit in &self.hits {
            peak.see(hit.value, hit.time);
        }
        peak
    }
}

/// What holds a part: a spring, a dashpot, and stops on either side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Suspension {
    /// Natural angular frequency.
    pub omega: f64,
    /// Damping ratio.
    pub zeta: f64,
    /// The stops.
    pub stop: Option<Stop>,
}

/// Stops on either side of a part, pressed by the hysteretic law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop {
    /// The way to each of them.
    pub gap: f64,
    /// Time of a contact of the part alone.
    pub time: f64,
    /// Restitution of such a contact.
    pub e: f64,
}

/// One shock.
#[derive(Debug, Clone, Copy)]
pub struct Shock {
    /// Time of its peak.
    pub time: f64,
    /// Change of velocity, or of angular velocity.
    pub change: f64,
    /// Largest acceleration; infinite for an instant impact.
    pub acceleration: f64,
}

/// The motion that changes in a shock.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Motion {
    /// The velocity of the place.
    Velocity,
    /// The angular velocity of the bar.
    Turning,
}

/// Angle of the part's oscillation per step of time, in radians.
const FINE: f64 = 0.25;
/// The same of a part with stops, of the fastest oscillation of the time.
const AT_STOP: f64 = 0.1;
/// The largest number of steps of a part with stops between two moments of its history.
const MOST_STEPS: usize = 4_000_000;
/// Strikes that come closer than this are one: longer than an end that hops in place of resting is off the ground when
/// the other lands.
pub const INSTANT: f64 = 2e-8;

/// How a part is at one of its stops.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
enum Press {
    #[default]
    Away,
    /// On the virgin line.
    Load,
    /// On the steeper one below it.
    Unload,
}

/// The stop on one side.
#[derive(Debug, Clone, Copy, Default)]
struct Side {
    press: Press,
    /// How far its surface is behind the gap.
    dent: f64,
    /// Depth below that surface where the part turned, and where the force would be 0.
    deepest: f64,
    zero: f64,
}

/// A mass on spring and dashpot.
#[derive(Debug, Clone)]
struct Suspended {
    omega: f64,
    zeta: f64,
    stop: Option<Stop>,
    /// The stops at positive and at negative displacements.
    sides: [Side; 2],
    /// Displacement relative to the place, and its rate.
    z: f64,
    v: f64,
    time: f64,
    peaks: Response,
}

/// The direction of the stop on a side.
const SIGNS: [f64; 2] = [1.0, -1.0];

impl Stop {
    /// Returns the restitution that is stepped.
    fn restitution(&self) -> f64 {
        self.e.max(LEAST_RESTITUTION)
    }

    /// Returns the angular frequency of a free mass of 1 on the virgin line: a quarter of its period to the crest and a
    /// quarter of e times its period back make the contact time.
    fn omega(&self) -> f64 {
        std::f64::consts::FRAC_PI_2 * (1.0 + self.restitution()) / self.time
    }

    /// Returns the stiffness on the line of a press, and the depth where its force is 0.
    fn line(&self, side: &Side) -> (f64, f64) {
        match side.press {
            Press::Away => (0.0, 0.0),
            Press::Load => (self.omega().powi(2), 0.0),
            Press::Unload => ((self.omega() / self.restitution()).powi(2), side.zero),
        }
    }
}

impl Suspended {
    /// Returns the absolute acceleration.
    fn acceleration(&self, z: f64, v: f64) -> f64 {
        -self.omega * (2.0 * self.zeta * v + self.omega * z) + self.pressed(z)
    }

    /// Returns the share of the stops in it.
    fn pressed(&self, z: f64) -> f64 {
        let Some(stop) = self.stop else { return 0.0 };
        let of = |k: usize| {
            let (stiffness, zero) = stop.line(&self.sides[k]);
            -SIGNS[k] * stiffness * (self.depth(&stop, k, z) - zero)
        };
        of(0) + of(1)
    }

    /// Returns the depth below the surface of a stop, as it is now.
    fn depth(&self, stop: &Stop, k: usize, z: f64) -> f64 {
        SIGNS[k] * z - stop.gap - self.sides[k].dent
    }

    /// Returns a value that is positive within the phase of a stop, and negative when it is over.
    fn room(&self, stop: &Stop, k: usize, z: f64, v: f64) -> f64 {
        let (side, depth) = (&self.sides[k], self.depth(stop, k, z));
        match side.press {
            Press::Away if side.dent > 0.0 => (-depth).min(depth + side.dent),
            Press::Away => -depth,
            Press::Load => SIGNS[k] * v,
            Press::Unload => (depth - side.zero).min(side.deepest - depth),
        }
    }

    /// Begins the next phase at a stop.
    fn advance(&mut self, stop: &Stop, k: usize) {
        let (depth, approach) = (self.depth(stop, k, self.z), SIGNS[k] * self.v);
        let side = &mut self.sides[k];
        match side.press {
            // It is back within the gap.
            Press::Away if depth < 0.0 => side.dent = 0.0,
            Press::Away => {
                side.press = Press::Load;
                self.peaks.hits.push(Peak { value: approach, time: self.time });
            }
            Press::Load => {
                let e = stop.restitution();
                (side.press, side.deepest, side.zero) = (Press::Unload, depth, depth * (1.0 - e * e));
            }
            Press::Unload if depth < side.zero => {
                side.press = Press::Away;
                side.dent = (side.dent + depth).max(0.0);
            }
            Press::Unload => side.press = Press::Load,
        }
    }

    /// Returns displacement and velocity after a step of Runge and Kutta under an acceleration of the place at its begin,
    /// middle and end.
    fn stepped(&self, h: f64, [f0, f1, f2]: [f64; 3]) -> [f64; 2] {
        let rate = |z: f64, v: f64, f: f64| [v, self.acceleration(z, v) - f];
        let from = |[a, b]: [f64; 2], h: f64, f: f64| rate(self.z + h * a, self.v + h * b, f);
        let k1 = rate(self.z, self.v, f0);
        let k2 = from(k1, h / 2.0, f1);
        let k3 = from(k2, h / 2.0, f1);
        let k4 = from(k3, h, f2);
        let mean = |i: usize| (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]) / 6.0;
        [self.z + h * mean(0), self.v + h * mean(1)]
    }

    /// Follows the part between its stops for a time, under an acceleration of the place that is a parabola through
    /// three values: by steps that end where a phase ends.
    fn between(&mut self, stop: &Stop, whole: f64, acceleration: [f64; 3]) {
        let (begin, [p, q, r]) = (self.time, acceleration);
        let at = |t: f64| {
            let u = t / whole;
            p + u * (4.0 * q - 3.0 * p - r + u * 2.0 * (p + r - 2.0 * q))
        };
        let is_even = [q, r].iter().all(|at| at.to_bits() == p.to_bits());
        let mut passed = 0.0;
        for _ in 0..MOST_STEPS {
            let left = whole - passed;
            if left <= 0.0 {
                break;
            }
            if is_even && self.coast(stop, left, p) {
                return;
            }
            let within = |h: f64| [at(passed), at(passed + h / 2.0), at(passed + h)];
            let step = |h: f64, part: &Self| part.stepped(h, within(h));
            let mut h = self.fine(stop).min(left);
            let mut next = step(h, self);
            if self.v * next[1] < 0.0 {
                // It may reach a stop and leave it within the step: that then ends where it turns.
                let slope = |v: f64, z: f64, f: f64| self.acceleration(z, v) - f;
                let ends = [slope(self.v, self.z, at(passed)), slope(next[1], next[0], at(passed + h))];
                let top = turning(h, [self.z, self.v], next).abs();
                if ends[0] * self.v < 0.0 && top > stop.gap && self.sides.iter().all(|side| side.press == Press::Away) {
                    h = bisected(h, |h| step(h, self)[1] * self.v <= 0.0);
                    next = step(h, self);
                }
            }
            let over = |[z, v]: [f64; 2], part: &Self, k: usize| part.room(stop, k, z, v) < 0.0;
            let mut ended = [false; 2];
            if (0..2).any(|k| over(next, self, k)) {
                h = bisected(h, |h| (0..2).any(|k| over(step(h, self), self, k)));
                next = step(h, self);
                ended = [0, 1].map(|k| over(next, self, k));
            }
            self.arrive(h, next, [at(passed), at(passed + h)], begin + passed);
            passed += h;
            for k in (0..2).filter(|&k| ended[k]) {
                self.advance(stop, k);
            }
        }
        self.time = begin + whole;
    }

    /// Goes to the end of a step that began at a time, and sees the turning points within: of the cubics through values
    /// and slopes.
    fn arrive(&mut self, h: f64, [z, v]: [f64; 2], [f, g]: [f64; 2], begin: f64) {
        let stiffness = self.stop.map_or(0.0, |stop| self.sides.iter().map(|side| stop.line(side).0).sum());
        let seen = |z: f64, v: f64, f: f64| {
            let now = self.acceleration(z, v);
            let slope = -2.0 * self.zeta * self.omega * (now - f) - (self.omega * self.omega + stiffness) * v;
            [now, slope]
        };
        let top = turning(h, seen(self.z, self.v, f), seen(z, v, g));
        self.peaks.displacement.see(turning(h, [self.z, self.v], [z, v]), begin);
        self.peaks.acceleration.see(top, begin);
        (self.z, self.v, self.time) = (z, v, begin + h);
        self.see();
    }

    /// Returns a step of time that resolves the fastest oscillation of now.
    fn fine(&self, stop: &Stop) -> f64 {
        let fast = |side: &Side| match side.press {
            Press::Away if side.dent > 0.0 => stop.omega(),
            _ => stop.line(side).0.sqrt(),
        };
        AT_STOP / (self.omega * (1.0 + 2.0 * self.zeta) + self.sides.iter().map(fast).sum::<f64>())
    }

    /// Follows the part for a time under a constant acceleration of the place, if its energy lets no phase end, and
    /// returns whether it does.
    fn coast(&mut self, stop: &Stop, h: f64, acceleration: f64) -> bool {
        let pressed = (0..2).find(|&k| self.sides[k].press != Press::Away);
        let square = self.omega * self.omega;
        let (stiffness, middle, low, high) = match pressed {
            None if self.sides.iter().any(|side| side.dent > 0.0) => return false,
            None => (square, 0.0, -stop.gap, stop.gap),
            Some(k) if self.sides[k].press == Press::Unload => {
                let side = &self.sides[k];
                let (steep, _) = stop.line(side);
                let [zero, deepest] = [side.zero, side.deepest].map(|depth| SIGNS[k] * (stop.gap + side.dent + depth));
                (square + steep, steep * zero, zero.min(deepest), zero.max(deepest))
            }
            Some(_) => return false,
        };
        let rest = (middle - acceleration) / stiffness;
        let reach = (self.z - rest).hypot(self.v / stiffness.sqrt());
        let is_within = rest - reach > low && rest + reach < high;
        if is_within {
            let omega = stiffness.sqrt();
            self.swing(h, acceleration, rest, omega, self.zeta * self.omega / omega);
        }
        is_within
    }

    fn see(&mut self) {
        self.peaks.displacement.see(self.z, self.time);
        self.peaks.acceleration.see(self.acceleration(self.z, self.v), self.time);
    }

    /// Makes a step under an acceleration of the place that is a parabola through three values.
    fn push(&mut self, h: f64, acceleration: [f64; 3]) {
        if let Some(stop) = self.stop {
            return self.between(&stop, h, acceleration);
        }
        let parts = (self.omega * (1.0 + 2.0 * self.zeta) * h / FINE).ceil().max(1.0);
        let (from, h) = (self.time, h / parts);
        for i in 0..parts as u64 {
            let at = |u: f64| {
                let [p, q, r] = acceleration;
                p + u * (4.0 * q - 3.0 * p - r + u * 2.0 * (p + r - 2.0 * q))
            };
            let [f0, f1, f2] = [0.0, 0.5, 1.0].map(|j| at((i as f64 + j) / parts));
            let (z, v) = (self.z, self.v);
            let (omega, zeta) = (self.omega, self.zeta);
            let spring = |z: f64, v: f64| -omega * (2.0 * zeta * v + omega * z);
            let a1 = spring(z, v) - f0;
            let (v2, z2) = (v + h / 2.0 * a1, z + h / 2.0 * v);
            let a2 = spring(z2, v2) - f1;
            let (v3, z3) = (v + h / 2.0 * a2, z + h / 2.0 * v2);
            let a3 = spring(z3, v3) - f1;
            let (v4, z4) = (v + h * a3, z + h * v3);
            let a4 = spring(z4, v4) - f2;
            self.z += h / 6.0 * (v + 2.0 * (v2 + v3) + v4);
            self.v += h / 6.0 * (a1 + 2.0 * (a2 + a3) + a4);
            let time = from + i as f64 * h;
            self.time = time + h;
            self.see();
            // Peaks between the samples are the turning points of the cubics through values and slopes.
            let (u, w) = (spring(z, v), spring(self.z, self.v));
            self.peaks.displacement.see(turning(h, [z, v], [self.z, self.v]), time);
            self.peaks.acceleration.see(turning(h, [u, spring(v, a1)], [w, spring(self.v, w - f2)]), time);
        }
        self.time = from + parts * h;
    }

    /// Follows the part for a time under a constant acceleration of the place.
    fn ring(&mut self, h: f64, acceleration: f64) {
        if let Some(stop) = self.stop {
            return self.between(&stop, h, [acceleration; 3]);
        }
        self.swing(h, acceleration, -acceleration / (self.omega * self.omega), self.omega, self.zeta);
    }

    /// Follows it without an end of a phase, about its rest.
    fn swing(&mut self, h: f64, acceleration: f64, rest: f64, w: f64, zeta: f64) {
        let (z, v) = (self.z - rest, self.v);
        // The turning points: of the displacement, and of the acceleration, which obeys the same equation.
        let pull = |z: f64, v: f64| -w * (2.0 * zeta * v + w * z);
        let (u, ut) = (pull(z, v), pull(v, pull(z, v)));
        for (start, slope, displacement) in [(z, v, true), (u, ut, false)] {
            let mut from = 0.0;
            for t in turns(w, zeta, start, slope) {
                from += t;
                if from > h || !from.is_finite() {
                    break;
                }
                let (at, _) = free(w, zeta, start, slope, from);
                let peaks = &mut self.peaks;
                if displacement {
                    peaks.displacement.see(rest + at, self.time + from);
                } else {
                    peaks.acceleration.see(acceleration + at, self.time + from);
                }
            }
        }
        let (z, v) = free(w, zeta, z, v, h);
        (self.z, self.v) = (rest + z, v);
        self.time += h;
        self.see();
    }
}

/// Returns a time after which a condition holds that does not at 0 and does after a time, as close to its first moment as
/// numbers allow.
fn bisected(most: f64, is_over: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (0.0, most);
    for _ in 0..44 {
        let h = f64::midpoint(low, high);
        if is_over(h) { high = h } else { low = h }
    }
    high
}

/// Returns the largest value of the cubic with these values and slopes, where it turns within; else 0.
fn turning(h: f64, [u, ut]: [f64; 2], [w, wt]: [f64; 2]) -> f64 {
    if ut * wt >= 0.0 {
        return 0.0;
    }
    let t = ut / (ut - wt);
    let (a, b) = (ut * h, wt * h);
    let r = 1.0 - t;
    u * r * r * (1.0 + 2.0 * t) + a * t * r * r + w * t * t * (3.0 - 2.0 * t) - b * t * t * r
}

/// Returns the free motion of a part after a time.
fn free(omega: f64, zeta: f64, z: f64, v: f64, t: f64) -> (f64, f64) {
    let (a, d) = (omega * zeta, omega * omega * (1.0 - zeta * zeta));
    let (c, s) = if d.abs() * t * t < 1e-12 {
        ((-a * t).exp(), t * (-a * t).exp())
    } else if d > 0.0 {
        let w = d.sqrt();
        ((-a * t).exp() * (w * t).cos(), (-a * t).exp() * (w * t).sin() / w)
    } else {
        let w = (-d).sqrt();
        let (slow, fast) = (((w - a) * t).exp(), (-(w + a) * t).exp());
        (f64::midpoint(slow, fast), (slow - fast) / (2.0 * w))
    };
    (z * c + (v + a * z) * s, v * c - (a * v + omega * omega * z) * s)
}

/// Returns the times from one turning point of a free motion to the next, two of them.
fn turns(omega: f64, zeta: f64, z: f64, v: f64) -> [f64; 2] {
    let (a, d) = (omega * zeta, omega * omega * (1.0 - zeta * zeta));
    let pull = a * v + omega * omega * z;
    if d > 0.0 {
        let w = d.sqrt();
        // v cos(wt) = pull/w sin(wt)
        let angle = (v * w).atan2(pull);
        let first = if angle > 0.0 { angle } else { angle + std::f64::consts::PI };
        [first / w, std::f64::consts::PI / w]
    } else {
        let w = (-d).sqrt();
        let ratio = if w > 0.0 { v * w / pull } else { v / pull };
        let first = if w > 0.0 { ratio.atanh() / w } else { ratio };
        [if first > 0.0 { first } else { f64::INFINITY }, f64::INFINITY]
    }
}

/// Returns the response of a part at `place` from the center of mass; it is followed until a time, or for two of its
/// periods after the end of the drop.
#[must_use]
pub fn respond(flight: &Flight, place: f64, suspension: &Suspension, until: Option<f64>) -> Response {
    let Suspension { omega, zeta, stop } = *suspension;
    let (sides, peaks) = <([Side; 2], Response)>::default();
    let mut part = Suspended { omega, zeta, stop, sides, z: 0.0, v: 0.0, time: 0.0, peaks };
    for step in &flight.steps {
        if step.time > part.time {
            part.ring(step.time - part.time, 0.0);
            part.time = step.time;
        }
        let acceleration: [f64; 3] = std::array::from_fn(|i| step.push[i] + place * step.lift[i]);
        if step.length == 0.0 {
            part.v -= acceleration[0];
            part.see();
        } else if step.flying && omega * step.length > 5.0 {
            part.ring(step.length, acceleration[1]); // so slow for the part that steps do not shake it
        } else {
            part.push(step.length, acceleration);
        }
    }
    if flight.end > part.time {
        part.ring(flight.end - part.time, 0.0);
    }
    let acceleration = if flight.at_rest { flight.gravity } else { 0.0 };
    let until = until.unwrap_or(flight.end + 2.0 * std::f64::consts::TAU / omega * (1.0 + zeta));
    if until > part.time {
        part.ring(until - part.time, acceleration);
    }
    part.peaks
}

/// Returns the largest acceleration above free fall of a place from the center of mass; 0 for instant impacts, which
/// have none.
#[must_use]
pub fn largest_acceleration(flight: &Flight, place: f64) -> Peak {
    let mut peak = Peak::default();
    for step in flight.steps.iter().filter(|step| !step.flying && step.length > 0.0) {
        peak.see(crest([0, 1, 2].map(|j| step.push[j] + place * step.lift[j])), step.time);
    }
    peak
}

/// Returns the shocks of a place from the center of mass, from the largest peak down.
#[must_use]
pub fn shocks(flight: &Flight, place: f64, motion: Motion) -> Vec<Shock> {
    let is_velocity = motion == Motion::Velocity;
    let (fall, least) = if is_velocity { (flight.gravity, 1.0) } else { (0.0, flight.gyration) };
    let push = |step: &Step| {
        let acceleration =
            [0, 1, 2].map(|j| if is_velocity { step.push[j] + place * step.lift[j] } else { step.turn[j] });
        Push {
            time: step.time,
            length: step.length,
            acceleration,
            moved: [acceleration.map(|acceleration| acceleration - fall), [0.0; 3], [0.0; 3]],
        }
    };
    let pushes: Vec<Push> = flight.steps.iter().filter(|step| !step.flying).map(push).collect();
    if pushes.iter().any(|push| push.length == 0.0) {
        return strikes(&pushes);
    }
    pulses(&pushes, 2.0 * flight.gravity / least)
}

/// A step with contact: the acceleration above free fall at its begin, middle and end, and the velocity change, along
/// one axis or along three.
pub(crate) struct Push {
    pub(crate) time: f64,
    pub(crate) length: f64,
    pub(crate) acceleration: [f64; 3],
    pub(crate) moved: [[f64; 3]; 3],
}

impl Push {
    /// Returns the change of velocity from its begin to a share of it: the integral of a parabola.
    fn moved_by(&self, u: f64) -> [f64; 3] {
        self.moved.map(|[p, q, r]| {
            self.length * u * (p + u * ((4.0 * q - 3.0 * p - r) / 2.0 + u * 2.0 * (p + r - 2.0 * q) / 3.0))
        })
    }
}

/// Returns the largest change of all shocks.
#[must_use]
pub fn largest(shocks: &[Shock]) -> Peak {
    let mut peak = Peak::default();
    for shock in shocks {
        peak.see(shock.change, shock.time);
    }
    peak
}

/// Returns the changes by instant impacts; those at one instant add up.
fn strikes(pushes: &[Push]) -> Vec<Shock> {
    let mut list: Vec<Shock> = Vec::with_capacity(pushes.len());
    for &Push { time, acceleration: [jump, ..], .. } in pushes {
        match list.last_mut() {
            Some(last) if time - last.time < INSTANT => {
                last.change += jump;
                last.time = time;
            }
            _ => list.push(Shock { time, change: jump, acceleration: f64::INFINITY }),
        }
    }
    list
}

/// Returns the largest magnitude of a parabola through three values over its step.
fn crest([p, q, r]: [f64; 3]) -> f64 {
    let (bend, slope) = (p + r - 2.0 * q, (r - p) / 2.0);
    let ends = if p.abs() > r.abs() { p } else { r };
    let mut most = if q.abs() > ends.abs() { q } else { ends };
    if slope.abs() < bend.abs() {
        let top = q - slope * slope / (2.0 * bend);
        if top.abs() > most.abs() {
            most = top;
        }
    }
    most
}

/// A moment of a history: its time, the acceleration, and the velocity gained by then.
struct Point {
    time: f64,
    acceleration: f64,
    gained: [f64; 3],
}

/// Returns the shocks of a history, from the largest peak down. Each reaches on both sides as long as the sign is kept
/// and a tenth of its peak, at least `least`, is exceeded, and from there as long as it goes on falling, never into an
/// earlier one, nor beyond a contact without a gap. Peaks below `least` do not count if others are above it.
pub(crate) fn pulses(pushes: &[Push], least: f64) -> Vec<Shock> {
    let mut points: Vec<Point> = Vec::with_capacity(3 * pushes.len() + 2);
    let mut gained = [0.0; 3];
    for push in pushes {
        let (h, t, [p, q, r]) = (push.length, push.time, push.acceleration);
        let before = points.last().map_or(t, |point| point.time);
        if t > before + 1e-12 {
            points.extend([before, t].map(|time| Point { time, acceleration: 0.0, gained }));
        }
        let at = |u: f64, acceleration: f64| {
            let moved = push.moved_by(u);
            Point { time: t + u * h, acceleration, gained: std::array::from_fn(|i| gained[i] + moved[i]) }
        };
        points.push(at(0.0, p));
        for (from, to, half) in [(p, q, 0.5), (q, r, 1.0)] {
            if from * to < 0.0 {
                // This is the change of sign.
                points.push(at(half - 0.5 * to / (to - from), 0.0));
            }
            points.push(at(half, to));
        }
        gained = at(1.0, r).gained;
    }
    let size = |i: usize| points[i].acceleration.abs();
    let mut crests: Vec<usize> = (0..points.len())
        .filter(|&i| {
            size(i) > 0.0 && (i == 0 || size(i) >= size(i - 1)) && (i + 1 == points.len() || size(i) >= size(i + 1))
        })
        .collect();
    crests.sort_by(|&i, &j| size(j).total_cmp(&size(i)));
    if crests.first().is_some_and(|&highest| size(highest) > least) {
        crests.retain(|&top| size(top) > least);
    }
    let mut taken = vec![false; points.len()];
    let mut list = Vec::new();
    for &top in &crests {
        if taken[top] {
            continue;
        }
        let down_to = least.max(0.1 * size(top));
        let goes_on = |from: usize, to: usize| {
            let kept = !taken[to] && size(from) > 0.0 && points[to].acceleration * points[top].acceleration >= 0.0;
            kept && (size(from) > down_to && size(to) > down_to || size(to) <= size(from))
        };
        let (mut low, mut high) = (top, top);
        while low > 0 && goes_on(low, low - 1) {
            low -= 1;
        }
        while high + 1 < points.len() && goes_on(high, high + 1) {
            high += 1;
        }
        taken[low..=high].fill(true);
        let moved = [0, 1, 2].map(|i| points[high].gained[i] - points[low].gained[i]);
        let change = moved.iter().map(|by| by * by).sum::<f64>().sqrt();
        list.push(Shock { time: points[top].time, change, acceleration: size(top) });
    }
    list
}
