//! The response of a component with stops, phase by phase.
//!
//! Off the stops the component moves as without them. On a stop of stiffness k per mass it is again a linear component,
//! about another place c (side ±1, s the surface at which F = 0):
//!
//! ```text
//! z = c + y,   y″ + 2ζ′ω′ y′ + ω′² y = −a,   A = −(2ζ′ω′ y′ + ω′² y),   ω′² = ω² + k,   ζ′ω′ = ζω
//! side·y = depth + s (ω/ω′)²,   c = side·s k/ω′²
//! ```
//!
//! so each phase is a [`Segment`] of its own system, and only the times at which one phase ends are found by iteration.

use super::{Piece, Pulses};
use crate::forced::{Exit, Sample, Segment};
use crate::peaks::{Extreme, Mark, Range};
use crate::stop::{Hit, Stop};
use crate::suspension::{Modes, Motion, Phase};
use crate::{DampingRatio, State, Suspension};
use num_complex::Complex64;

/// The most touches that are followed in a history of few sections; of one with more, one for each.
const MOST_HITS: usize = 4096;
/// The most ends of phases for each of them: a touch has its crest and its parting, and at times a dent that is left.
const EVENTS: usize = 4;
/// The most panels that the search for the ends of phases looks at, for each of the most touches and for one end. Ordinary
/// histories take a few for each section.
const PANELS: usize = 64;
const MOST_PANELS_OF_ONE: u32 = 1 << 14;
/// Touches in the ring-down that follow the hardest one.
const TOUCHES_AFTER: usize = 7;
/// Share by which a touch is faster than another, more than its roundings.
const FASTER: f64 = 1.0 + 1e-12;

/// Returns the most touches that are followed in a history.
pub(crate) fn most_hits(pulses: &Pulses) -> usize {
    MOST_HITS.max(pulses.pieces.len())
}

/// What the component touches.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Contact {
    Off,
    /// On the line of first loading.
    Loading,
    /// On the line of unloading and reloading.
    Returning,
}

/// The linear system of one contact.
struct System {
    modes: Modes,
    omega: f64,
    /// ω/ω′ of the component alone and this one.
    ratio: f64,
    /// k/ω′².
    share: f64,
}

impl System {
    fn new(part: &Suspension, stop_omega: f64) -> Self {
        let omega = libm::hypot(part.omega(), stop_omega);
        let ratio = part.omega() / omega;
        // It is no larger than the ratio that it comes from.
        let damping = DampingRatio::new(part.damping().get() * ratio).unwrap_or(part.damping());
        Self { modes: Modes::new(damping), omega, ratio, share: (stop_omega / omega) * (stop_omega / omega) }
    }
}

/// The systems of one component with a stop, by [`Contact`].
pub(crate) struct Systems {
    list: [System; 3],
    stop: Stop,
}

impl Systems {
    pub(crate) fn new(part: &Suspension, stop: Stop) -> Self {
        let omega = stop.omega();
        let list = [0.0, omega, omega / stop.acting_restitution()].map(|stop_omega| System::new(part, stop_omega));
        Self { list, stop }
    }
}

/// Quantities that are wanted and their extremes so far.
pub(crate) struct Wanted<'r> {
    pub(crate) quantities: &'r [usize],
    pub(crate) ranges: &'r mut [Range],
}

/// A touch with the interval it falls into.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Touch {
    pub(crate) hit: Hit,
    pub(crate) interval: usize,
}

/// The motion of a component at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    /// The time.
    pub time: f64,
    /// Displacement and velocity relative to the base.
    pub state: State,
    /// Absolute acceleration: that of spring, damper and stop.
    pub acceleration: f64,
}

/// The most moments of one phase.
const MOST_PARTS: f64 = 1e4;

/// An instant as the interval it falls into and the time since its begin.
#[derive(Debug, Clone, Copy)]
struct When {
    interval: usize,
    at: f64,
}

/// A component that moves between its stops.
pub(crate) struct Stopped<'a, 'r> {
    pulses: &'a Pulses,
    systems: &'a Systems,
    segments: [Segment<'a>; 3],
    wanted: Wanted<'r>,
    contact: Contact,
    /// The motion in the coordinates of the contact.
    m: Motion,
    /// The side that was touched last, 1 or −1, how far its surface is behind the gap, and the largest depth behind that
    /// in the last press. The other side has no dent: on the way there it has left this one.
    side: f64,
    dent: f64,
    deepest: f64,
    pub(crate) touches: Vec<Touch>,
    events: usize,
    panels: u32,
    /// Where it is no longer followed, if it touches its stops too often.
    gave_up: Option<When>,
    /// The moments that are wanted: no further apart than so long.
    pub(crate) curve: Option<(f64, Vec<Moment>)>,
}

impl<'a, 'r> Stopped<'a, 'r> {
    pub(crate) fn new(pulses: &'a Pulses, systems: &'a Systems, wanted: Wanted<'r>) -> Self {
        Self {
            pulses,
            systems,
            segments: [0, 1, 2].map(|i: usize| Segment::new(&systems.list[i].modes)),
            wanted,
            contact: Contact::Off,
            m: Motion::default(),
            side: 1.0,
            dent: 0.0,
            deepest: 0.0,
            touches: Vec::new(),
            events: 0,
            panels: u32::try_from(PANELS * most_hits(pulses)).unwrap_or(u32::MAX),
            gave_up: None,
            curve: None,
        }
    }
    /// Goes on noting extremes in other ranges.
    pub(crate) fn noting<'s>(self, ranges: &'s mut [Range]) -> Stopped<'a, 's>
    where
        'r: 's,
    {
        Stopped { wanted: Wanted { quantities: self.wanted.quantities, ranges }, ..self }
    }
    /// Returns the interval and the time at which it gave up, if it did.
    pub(crate) fn gave_up(&self) -> Option<(usize, f64)> {
        self.gave_up.map(|when| (when.interval, self.pulses.begin(when.interval) + when.at))
    }
    /// Returns z and z′; both are infinite where it gave up.
    pub(crate) fn state(&self) -> State {
        if self.gave_up.is_some() {
            return State { displacement: f64::INFINITY, velocity: f64::INFINITY };
        }
        let system = self.system();
        let State { displacement, velocity } = system.modes.state(system.omega, self.m);
        State { displacement: displacement + self.center(), velocity }
    }
    /// Ends the run: all wanted values are infinite if it gave up.
    pub(crate) fn finish(self) {
        let Some(When { interval, at }) = self.gave_up else { return };
        let tau = self.systems.list[0].omega * at;
        for range in self.wanted.ranges {
            range.note(interval, tau, f64::INFINITY);
            range.note(interval, tau, f64::NEG_INFINITY);
        }
    }
    /// Returns the fastest touch, the first of equal ones, if it is faster than `above`.
    pub(crate) fn hardest_touch(&self, above: f64) -> Option<Extreme> {
        let mut hardest = None;
        let mut most = above.max(0.0);
        for touch in &self.touches {
            if touch.hit.speed > most {
                most = touch.hit.speed;
                hardest = Some(Extreme { value: most, time: touch.hit.time, interval: touch.interval });
            }
        }
        hardest
    }
    fn system(&self) -> &'a System {
        &self.systems.list[self.contact as usize]
    }
    /// Returns the distance from rest to the place of no force of the stop, from where depths count; off the stops 0.
    fn surface(&self) -> f64 {
        let surface = self.systems.stop.gap() + self.dent;
        match self.contact {
            Contact::Off => 0.0,
            Contact::Loading => surface,
            Contact::Returning => surface + self.residual(),
        }
    }
    /// Returns d₀ = d_max (1 − e²).
    fn residual(&self) -> f64 {
        let e = self.systems.stop.acting_restitution();
        self.deepest * ((1.0 - e) * (1.0 + e))
    }
    /// Returns e² d_max, how far d_max is beyond d₀.
    fn recovered(&self) -> f64 {
        let e = self.systems.stop.acting_restitution();
        self.deepest * e * e
    }
    /// Returns c.
    fn center(&self) -> f64 {
        self.side * (self.surface() * self.system().share)
    }
    /// Returns the distance of the surface from c.
    fn offset(&self) -> f64 {
        let ratio = self.system().ratio;
        self.surface() * ratio * ratio
    }
    /// Returns x = ω′y at a depth: always the same digits for one depth.
    fn place(&self, depth: f64) -> f64 {
        self.side * (self.system().omega * (depth + self.offset()))
    }
    /// Returns the depth behind the surface.
    fn depth(&self) -> f64 {
        self.side * self.m.x / self.system().omega - self.offset()
    }
    /// Puts the component at a depth with velocity z′, in the coordinates of the contact.
    fn put(&mut self, depth: f64, velocity: f64) {
        let x = self.place(depth);
        self.m = Motion { x, w: velocity + self.system().modes.sigma * x };
    }
    /// Returns the quantity whose exit from a band ends the phase, and the band: the surfaces around it off the stops, the
    /// crest while it loads, d₀ and d_max on the way back.
    fn band(&self) -> (usize, [f64; 2]) {
        let gap = self.systems.stop.gap();
        let (k, inner, outer) = match self.contact {
            Contact::Off if self.dent > 0.0 => (Modes::DISPLACEMENT, self.place(gap), self.place(gap + self.dent)),
            Contact::Off => (Modes::DISPLACEMENT, -self.place(gap), self.place(gap)),
            Contact::Loading => (Modes::VELOCITY, 0.0, self.side * f64::INFINITY),
            Contact::Returning => (Modes::DISPLACEMENT, self.place(0.0), self.place(self.recovered())),
        };
        (k, if self.side > 0.0 { [inner, outer] } else { [outer, inner] })
    }
    /// Returns how to note extremes of the present contact from `when` on.
    fn frame(&self, when: When) -> Frame {
        let (system, omega) = (self.system(), self.systems.list[0].omega);
        Frame {
            plain: self.contact == Contact::Off && when.at == 0.0,
            ratio: system.ratio,
            center: omega * self.center(),
            interval: when.interval,
            tau: omega * when.at,
        }
    }
    /// Follows the component from rest to the end of the history.
    pub(crate) fn drive(&mut self) {
        let pulses = self.pulses;
        for (i, piece) in pulses.pieces.iter().enumerate() {
            if piece.shock != 0.0 {
                self.m.w -= piece.shock;
                let (frame, modes, m) = (self.frame(When { interval: i, at: 0.0 }), &self.system().modes, self.m);
                frame.note(&mut self.wanted, |k, range| range.note(i, 0.0, modes.quantity(k, m)));
            }
            if piece.length > 0.0 {
                self.cross(i, piece);
            }
            if self.gave_up.is_some() {
                return;
            }
        }
    }
    /// Follows it through one piece.
    fn cross(&mut self, i: usize, piece: &Piece) {
        let mut when = When { interval: i, at: 0.0 };
        while when.at < piece.length && self.gave_up.is_none() {
            let Some(end) = self.begin(piece, when.at) else { return };
            let Some(exit) = self.follow(when, &end) else { return };
            when.at = (when.at + exit.tau / self.system().omega).min(piece.length);
            self.turn(exit, when);
        }
    }
    /// Begins a segment at a time within a piece and returns its end, unless nothing is left of the piece.
    fn begin(&mut self, piece: &Piece, at: f64) -> Option<Sample> {
        let omega = self.system().omega;
        let (segment, pulses) = (&mut self.segments[self.contact as usize], self.pulses);
        if at == 0.0 {
            return Some(pulses.begin_piece(segment, self.m, omega, piece));
        }
        let rest = piece.length - at;
        if omega * rest < f64::MIN_POSITIVE {
            return None;
        }
        let from = piece.from + (piece.to - piece.from) * (at / piece.length);
        let span = segment.begin_line(self.m, omega, rest, from, piece.to);
        for sine in &pulses.sines[piece.sines.0..piece.sines.1] {
            segment.add_sine(-sine.amplitude / omega, sine.phase * Complex64::cis(sine.rate * at), sine.rate / omega);
        }
        Some(segment.sample(span))
    }
    /// Takes the component to where it leaves the band of its contact, or else to the end of the segment under way, and
    /// notes its extremes until then.
    fn follow(&mut self, when: When, end: &Sample) -> Option<Exit> {
        let ((k, band), center) = (self.band(), self.center());
        let segment = &self.segments[self.contact as usize];
        let mut panels = self.panels.min(MOST_PANELS_OF_ONE);
        self.panels -= panels;
        let exit = segment.first_exit(k, band, end, &mut panels);
        self.panels += panels;
        if panels == 0 {
            self.gave_up = Some(when);
            return None;
        }
        let end = exit.map_or(*end, |exit| segment.sample(Phase::product(1.0, exit.tau)));
        if exit.is_none_or(|exit| exit.tau > 0.0) {
            self.frame(when).note(&mut self.wanted, |k, range| segment.extremes(k, &end, when.interval, range));
        }
        if let Some((step, curve)) = &mut self.curve {
            let (system, start) =
                (&self.systems.list[self.contact as usize], self.pulses.begin(when.interval) + when.at);
            let parts = (end.tau / (system.omega * *step)).ceil().clamp(1.0, MOST_PARTS);
            let mut part = 0.0;
            while part <= parts {
                let tau = end.tau * (part / parts);
                let m = segment.sample(Phase::product(1.0, tau)).m;
                let State { displacement, velocity } = system.modes.state(system.omega, m);
                curve.push(Moment {
                    time: start + tau / system.omega,
                    state: State { displacement: displacement + center, velocity },
                    acceleration: system.omega * system.modes.quantity(Modes::ACCELERATION, m),
                });
                part += 1.0;
            }
        }
        self.m = end.m;
        exit
    }
    /// Goes over to the next contact.
    fn turn(&mut self, exit: Exit, when: When) {
        self.events += 1;
        if self.events > EVENTS * most_hits(self.pulses) || self.touches.len() > most_hits(self.pulses) {
            self.gave_up = Some(when);
            return;
        }
        let velocity = self.system().modes.quantity(Modes::VELOCITY, self.m);
        let outward = exit.upward == (self.side > 0.0);
        match self.contact {
            Contact::Off if self.dent > 0.0 && !outward => {
                self.dent = 0.0;
                self.put(self.systems.stop.gap(), velocity);
            }
            Contact::Off => {
                if !outward {
                    self.side = -self.side;
                }
                let speed = (self.side * velocity).max(0.0);
                let time = self.pulses.begin(when.interval) + when.at;
                self.touches.push(Touch {
                    hit: Hit { time, speed, side: if self.side > 0.0 { 1 } else { -1 } },
                    interval: when.interval,
                });
                self.contact = Contact::Loading;
                self.put(0.0, self.side * speed);
            }
            Contact::Loading => {
                self.deepest = self.depth().max(0.0);
                self.contact = Contact::Returning;
                self.put(self.recovered(), self.side * (self.side * velocity).min(0.0));
            }
            Contact::Returning if outward => {
                self.contact = Contact::Loading;
                self.put(self.deepest, velocity);
            }
            Contact::Returning => {
                self.dent += self.residual();
                self.contact = Contact::Off;
                self.put(self.systems.stop.gap() + self.dent, velocity);
            }
        }
    }
    /// Follows the ring-down, under a constant acceleration or none, until no stop is reached any more.
    ///
    /// Without that, the energy about the place of rest z₀ = −a/ω² never grows, and at a touch of the surface at s the
    /// speed is v² = 2E − ω²(s − z₀)². Where z₀ is within the gap a component that has left a dent meets that stop at the
    /// gap again, so that of two touches of one stop the later one is no faster, and its press no deeper, apart from one
    /// in a dent of the history. Where z₀ is beyond the gap the surface goes with each press toward z₀: speeds there rise
    /// until it is reached, and fall from then on. So the hardest touch is known once seven in a row are no harder. (What
    /// a steady push on such a stop does later, by creep from dent to dent, is not followed.)
    pub(crate) fn ring_down(&mut self) {
        let (interval, first) = (self.pulses.pieces.len(), self.touches.len());
        let (mut when, mut hardest) = (When { interval, at: 0.0 }, first);
        while self.gave_up.is_none() && self.touches.len() <= hardest + TOUCHES_AFTER {
            let (system, (k, band)) = (self.system(), self.band());
            let (modes, m, forcing) = (&system.modes, self.m, -self.pulses.carried / system.omega);
            let mut seen = Range::outside(band[0], band[1]);
            seen.note_carried(modes, k, m, forcing, interval);
            let leaves = seen.high.value > band[1] || seen.low.value < band[0];
            let exit = leaves.then(|| {
                let segment = &mut self.segments[self.contact as usize];
                segment.begin(m, forcing, 0.0, modes.settling());
                let end = segment.sample(Phase::product(1.0, modes.settling()));
                self.follow(when, &end)
            });
            if self.gave_up.is_some() {
                return;
            }
            let Some(exit) = exit.flatten() else {
                self.frame(when).note(&mut self.wanted, |k, range| range.note_carried(modes, k, m, forcing, interval));
                return;
            };
            when.at += exit.tau / system.omega;
            self.turn(exit, when);
            if let Some(last) = self.touches.len().checked_sub(1)
                && last >= first
                && self.touches[last].hit.speed
                    > FASTER * self.touches.get(hardest).map_or(0.0, |touch| touch.hit.speed)
            {
                hardest = last;
            }
        }
    }
}

/// How to note the extremes of one contact as those of the component.
#[derive(Debug, Clone, Copy)]
struct Frame {
    /// True if both are the same.
    plain: bool,
    /// ω/ω′.
    ratio: f64,
    /// ωc.
    center: f64,
    interval: usize,
    /// Phase ωt of the begin within the interval.
    tau: f64,
}

impl Frame {
    /// Calls `extremes` for each wanted quantity, with a range in the coordinates of the contact.
    fn note(self, wanted: &mut Wanted, extremes: impl Fn(usize, &mut Range)) {
        for (&k, range) in wanted.quantities.iter().zip(wanted.ranges.iter_mut()) {
            if self.plain {
                extremes(k, range);
                continue;
            }
            let (unit, shift) = match k {
                Modes::DISPLACEMENT => (self.ratio, self.center),
                Modes::VELOCITY => (1.0, 0.0),
                _ => (self.ratio.recip(), 0.0),
            };
            let [low, high] = [range.low.value, range.high.value].map(|value| (value - shift) / unit);
            let mut own = Range::outside(low, high);
            extremes(k, &mut own);
            let mut note = |mark: Mark| {
                range.note(self.interval, self.tau + mark.tau * self.ratio, mark.value * unit + shift);
            };
            if own.high.value > high {
                note(own.high);
            }
            if own.low.value < low {
                note(own.low);
            }
        }
    }
}
