//! One drop of a bar, integrated in small steps: exact geometry, gravity, forces at the two ends.

use crate::ground::{Contact, Ground, LEAST_RESTITUTION, Phase, fine};
pub use crate::ground::{Law, Own};

/// A bar at the moment when its lower end touches the ground; SI units.
#[derive(Debug, Clone, Copy)]
pub struct Drop {
    /// Length from end to end.
    pub length: f64,
    /// Radius of gyration about the center of mass.
    pub gyration: f64,
    /// Position of the center of mass, from the middle towards end b.
    pub center: f64,
    /// Restitution of the ends.
    pub e: f64,
    /// Law and time of a lone contact; none for instant impacts.
    pub contact: Option<(Law, f64)>,
    /// Own contacts of ends a and b.
    pub own: [Own; 2],
    /// Speed of the center of mass.
    pub speed: f64,
    /// Angular velocity, positive where the tilt grows.
    pub spin: f64,
    /// Angle to the ground.
    pub tilt: f64,
    /// True if end b is the lower one.
    pub b_first: bool,
    /// Gravity.
    pub gravity: f64,
}

/// Conditions that end the integration.
#[derive(Debug, Clone, Copy)]
pub struct Until {
    /// Time limit.
    pub time: f64,
    /// Share of the speed of the drop: it ends when both ends strike more slowly.
    pub quiet: f64,
}

/// One step of time under contact. The acceleration above free fall at x from the center of mass is `push + x · lift`,
/// at begin, middle and end.
#[derive(Debug, Clone, Copy)]
pub struct Step {
    /// Time of its begin.
    pub time: f64,
    /// Its length; 0 for an instant impact, whose three values are then changes of velocity.
    pub length: f64,
    /// True if neither end is down.
    pub flying: bool,
    /// Acceleration of the center of mass above free fall.
    pub push: [f64; 3],
    /// Acceleration above free fall for each meter from the center of mass.
    pub lift: [f64; 3],
    /// Angular acceleration.
    pub turn: [f64; 3],
}

/// A touch of an end on the ground.
#[derive(Debug, Clone, Copy)]
pub struct Touch {
    /// Time of the touch.
    pub time: f64,
    /// Index of the end: 0 for end a, 1 for end b.
    pub end: usize,
    /// Velocity of the end, upward positive.
    pub velocity: f64,
    /// Kinetic, potential and stored energy per mass.
    pub energy: f64,
}

/// A followed drop.
#[derive(Debug, Clone, Default)]
pub struct Flight {
    /// All steps under contact, in order; between them the acceleration above free fall is 0.
    pub steps: Vec<Step>,
    /// All touches of ends.
    pub touches: Vec<Touch>,
    /// End of the integration.
    pub end: f64,
    /// True if the bar lies still from then on, under its weight.
    pub at_rest: bool,
    /// Gravity.
    pub gravity: f64,
    /// Radius of gyration about the center of mass, the least of all.
    pub gyration: f64,
    /// Energy per mass at the end.
    pub energy: f64,
}

/// Height of the center of mass, angle, and their rates.
type State = [f64; 4];

/// Angle of rotation per step of free flight, in radians.
const TURN: f64 = 0.1;
/// The largest number of steps; a drop is followed no further.
const MOST_STEPS: usize = 1_000_000;
/// Rebound speed below which an end that strikes at an instant hops on, as a share of the speed of the drop.
const HOP: f64 = 1e-4;

struct Bar {
    drop: Drop,
    /// Positions of the ends from the center of mass.
    ends: [f64; 2],
    inertia: f64,
    grounds: [Ground; 2],
    contacts: [Contact; 2],
}

impl Bar {
    fn new(drop: &Drop) -> Self {
        let half = drop.length / 2.0;
        Self {
            drop: *drop,
            ends: [-half - drop.center, half - drop.center],
            inertia: drop.gyration * drop.gyration,
            grounds: Ground::own(drop.contact, drop.e, &drop.own),
            contacts: [Contact::default(); 2],
        }
    }

    fn start(&self) -> State {
        let angle = if self.drop.b_first { -self.drop.tilt } else { self.drop.tilt };
        let rate = if self.drop.b_first { -self.drop.spin } else { self.drop.spin };
        [-self.ends[usize::from(self.drop.b_first)] * angle.sin(), angle, -self.drop.speed, rate]
    }

    fn height(&self, end: usize, s: &State) -> f64 {
        s[0] + self.ends[end] * s[1].sin()
    }

    fn velocity(&self, end: usize, s: &State) -> f64 {
        s[2] + self.ends[end] * s[1].cos() * s[3]
    }

    /// Returns the acceleration of an end for each unit of force on it, per mass.
    fn mobility(&self, end: usize, s: &State) -> f64 {
        1.0 + (self.ends[end] * s[1].cos()).powi(2) / self.inertia
    }

    /// Returns the force per mass, on the line of the present phase.
    fn force(&self, end: usize, s: &State) -> f64 {
        self.contacts[end].force(&self.grounds[end], self.height(end, s), self.velocity(end, s))
    }

    /// Returns the acceleration of the center of mass above free fall, and the angular acceleration.
    fn accelerations(&self, s: &State) -> (f64, f64) {
        let [a, b] = [self.force(0, s), self.force(1, s)];
        (a + b, (a * self.ends[0] + b * self.ends[1]) * s[1].cos() / self.inertia)
    }

    fn rate(&self, s: &State) -> State {
        let (push, turn) = self.accelerations(s);
        [s[2], s[3], push - self.drop.gravity, turn]
    }

    /// Makes a step of Runge and Kutta.
    fn step(&self, s: &State, h: f64) -> State {
        let along = |rate: &State, h: f64| -> State { std::array::from_fn(|i| s[i] + h * rate[i]) };
        let k1 = self.rate(s);
        let k2 = self.rate(&along(&k1, h / 2.0));
        let k3 = self.rate(&along(&k2, h / 2.0));
        let k4 = self.rate(&along(&k3, h));
        std::array::from_fn(|i| s[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]))
    }

    /// Returns a value that is positive within a phase, and negative when it is over.
    fn room(&self, end: usize, s: &State) -> f64 {
        self.contacts[end].room(&self.grounds[end], self.height(end, s), self.velocity(end, s))
    }

    /// Begins the next phase of an end, and returns whether it is a touch.
    fn advance(&mut self, end: usize, s: &State) -> bool {
        let (height, mobility) = (self.height(end, s), self.mobility(end, s));
        self.contacts[end].advance(&self.grounds[end], height, mobility)
    }

    fn energy(&self, s: &State) -> f64 {
        let stored =
            |end: usize| self.contacts[end].stored(&self.grounds[end], self.height(end, s), self.velocity(end, s));
        let kinetic = 0.5 * (s[2] * s[2] + self.inertia * s[3] * s[3]);
        kinetic + self.drop.gravity * s[0] + stored(0) + stored(1)
    }

    /// Returns a step of time that resolves the fastest oscillation of the pressing ends.
    fn fine(&self, s: &State) -> f64 {
        let of = |end: usize| (self.height(end, s), self.velocity(end, s), self.mobility(end, s));
        let each = [0, 1].map(|end| {
            let (height, velocity, mobility) = of(end);
            (self.contacts[end], self.grounds[end], height, velocity, mobility)
        });
        fine(&each, self.drop.gravity)
    }

    /// Returns the time until an end comes to the ground, in free flight, by steps that cannot reach beyond it.
    fn fall(&self, s: &State, most: f64) -> (f64, usize) {
        let mut time = 0.0;
        loop {
            let now = self.ballistic(s, time);
            let bound = |end: usize| {
                let (height, velocity) = (self.height(end, &now), self.velocity(end, &now));
                let bend = self.drop.gravity + self.ends[end].abs() * now[3] * now[3];
                if velocity < 0.0 && height <= 1e-14 {
                    return 0.0;
                }
                let root = (velocity * velocity + 2.0 * bend * height.max(0.0)).sqrt();
                if velocity > 0.0 { (velocity + root) / bend } else { 2.0 * height.max(0.0) / (root - velocity) }
            };
            let [a, b] = [bound(0), bound(1)];
            let end = if self.drop.b_first { usize::from(b <= a) } else { usize::from(b < a) };
            let step = a.min(b);
            time += step;
            if step <= 1e-15 * time || step == 0.0 || time >= most {
                return (time, end);
            }
        }
    }

    fn ballistic(&self, s: &State, t: f64) -> State {
        let g = self.drop.gravity;
        [s[0] + t * (s[2] - g * t / 2.0), s[1] + t * s[3], s[2] - g * t, s[3]]
    }

    fn leave(&self, mut flight: Flight, s: &State, time: f64, at_rest: bool) -> Flight {
        flight.end = time;
        (flight.at_rest, flight.gravity, flight.gyration) = (at_rest, self.drop.gravity, self.drop.gyration);
        flight.energy = self.energy(s);
        flight
    }

    /// Returns the longest lone contact.
    fn longest(&self) -> f64 {
        let of = |time: f64| self.drop.own.iter().map(|own| own.time.unwrap_or(time)).fold(0.0, f64::max);
        self.drop.contact.map_or(0.0, |(_, time)| of(time))
    }

    /// Returns the time for which both ends have to press without an event to be at rest: twice the slower oscillation
    /// on the steep lines.
    fn patience(&self, s: &State) -> f64 {
        let mobility = self.mobility(0, s).min(self.mobility(1, s));
        let steep = self.grounds.map(|ground| ground.omega / ground.e.max(LEAST_RESTITUTION));
        let slow = steep[0].min(steep[1]) * (2.0 * (mobility - 1.0).min(1.0) / mobility).sqrt();
        (2.0 * std::f64::consts::TAU / slow).max(4.0 * self.longest())
    }
}

/// Follows a drop.
#[must_use]
pub fn follow(drop: &Drop, until: Until) -> Flight {
    if drop.contact.is_some() { contacts(drop, until) } else { instants(drop, until) }
}

/// Follows a drop with contacts that take time.
fn contacts(drop: &Drop, until: Until) -> Flight {
    let mut bar = Bar::new(drop);
    let mut flight = Flight::default();
    let mut s = bar.start();
    let (mut time, mut last_event, mut approach) = (0.0, 0.0, [f64::INFINITY; 2]);
    while time < until.time && flight.steps.len() < MOST_STEPS {
        let mut over = [false; 2];
        if bar.contacts.iter().all(Contact::is_up) {
            let (wait, end) = bar.fall(&s, until.time - time);
            if time + wait >= until.time {
                s = fly(&bar, &mut flight, &s, time, until.time - time);
                time = until.time;
                break;
            }
            s = fly(&bar, &mut flight, &s, time, wait);
            time += wait;
            over[end] = true;
        } else {
            let mut h = bar.fine(&s).min(until.time - time);
            let mut next = bar.step(&s, h);
            if (0..2).any(|end| bar.room(end, &next) < 0.0) {
                let (mut low, mut high) = (0.0, h);
                for _ in 0..44 {
                    h = f64::midpoint(low, high);
                    if (0..2).any(|end| bar.room(end, &bar.step(&s, h)) < 0.0) { high = h } else { low = h }
                }
                h = high;
                next = bar.step(&s, h);
                over = [0, 1].map(|end| bar.room(end, &next) < 0.0);
            }
            flight.steps.push(record(&bar, time, h, &s, &next));
            s = next;
            time += h;
        }
        for end in (0..2).filter(|&end| over[end]) {
            last_event = time;
            if bar.advance(end, &s) {
                let velocity = bar.velocity(end, &s);
                approach[end] = velocity.abs();
                flight.touches.push(Touch { time, end, velocity, energy: bar.energy(&s) });
            }
        }
        let slow = until.quiet * drop.speed;
        let calm = (0..2).all(|end| approach[end] < slow && bar.velocity(end, &s).abs() < slow);
        let pressing = bar.contacts.iter().all(|c| c.phase != Phase::Free);
        if calm || (pressing && time - last_event > bar.patience(&s)) {
            return bar.leave(flight, &s, time, true);
        }
    }
    bar.leave(flight, &s, time, false)
}

/// Returns the accelerations of a step; its middle follows by the cubic through both ends.
fn record(bar: &Bar, time: f64, h: f64, s: &State, next: &State) -> Step {
    let (from, to) = (bar.rate(s), bar.rate(next));
    let middle: State = std::array::from_fn(|i| f64::midpoint(s[i], next[i]) + h / 8.0 * (from[i] - to[i]));
    let values = [s, &middle, next].map(|s| {
        let (push, turn) = bar.accelerations(s);
        [push, turn * s[1].cos() - s[3] * s[3] * s[1].sin(), turn]
    });
    let [push, lift, turn] = [0, 1, 2].map(|what| values.map(|values| values[what]));
    let flying = bar.contacts.iter().all(|c| c.phase == Phase::Free);
    Step { time, length: h, flying, push, lift, turn }
}

/// Follows free flight for a time: only the turning of the bar gives an acceleration above free fall.
fn fly(bar: &Bar, flight: &mut Flight, s: &State, time: f64, wait: f64) -> State {
    let spin = s[3];
    let parts = if spin == 0.0 { 0.0 } else { (wait * spin.abs() / TURN).ceil() };
    for i in 0..parts as u64 {
        let lift = [0.0, 0.5, 1.0].map(|j| -spin * spin * (s[1] + spin * wait * (i as f64 + j) / parts).sin());
        let (time, length) = (time + wait * i as f64 / parts, wait / parts);
        flight.steps.push(Step { time, length, flying: true, push: [0.0; 3], lift, turn: [0.0; 3] });
    }
    bar.ballistic(s, wait)
}

/// Follows a drop with instant impacts, one after the other. An end that would come to rest hops on by a negligible
/// share of the first speed, so that a bar pivots about it without a law of its own.
fn instants(drop: &Drop, until: Until) -> Flight {
    let bar = Bar::new(drop);
    let mut flight = Flight::default();
    let mut s = bar.start();
    let (mut time, mut approach) = (0.0, [f64::INFINITY; 2]);
    let hop = HOP * drop.speed;
    while flight.touches.len() < MOST_STEPS {
        let (wait, end) = bar.fall(&s, until.time - time);
        if time + wait >= until.time {
            s = fly(&bar, &mut flight, &s, time, until.time - time);
            time = until.time;
            break;
        }
        s = fly(&bar, &mut flight, &s, time, wait);
        time += wait;
        let velocity = bar.velocity(end, &s);
        flight.touches.push(Touch { time, end, velocity, energy: bar.energy(&s) });
        let impulse = ((drop.e * velocity.abs()).max(hop) - velocity) / bar.mobility(end, &s);
        let turn = impulse * bar.ends[end] * s[1].cos() / bar.inertia;
        s[2] += impulse;
        s[3] += turn;
        let lift = turn * s[1].cos();
        flight.steps.push(Step {
            time,
            length: 0.0,
            flying: false,
            push: [impulse; 3],
            lift: [lift; 3],
            turn: [turn; 3],
        });
        approach[end] = velocity.abs();
        if (0..2).all(|end| approach[end] < (until.quiet * drop.speed).max(3.0 * hop)) {
            return bar.leave(flight, &s, time, true);
        }
    }
    bar.leave(flight, &s, time, false)
}

/// Returns a flat landing of instant impacts: all places lose their speed at once and rebound with e of it.
#[must_use]
pub fn flat(drop: &Drop, until: Until) -> Flight {
    let mut flight = Flight::default();
    let (mut time, mut speed) = (0.0, drop.speed);
    while time < until.time && speed > until.quiet.max(HOP) * drop.speed {
        let jump = (1.0 + drop.e) * speed;
        flight.touches.push(Touch { time, end: 0, velocity: -speed, energy: speed * speed / 2.0 });
        flight.steps.push(Step { time, length: 0.0, flying: false, push: [jump; 3], lift: [0.0; 3], turn: [0.0; 3] });
        speed *= drop.e;
        time += 2.0 * speed / drop.gravity;
    }
    flight.end = time;
    (flight.at_rest, flight.gravity) = (time < until.time, drop.gravity);
    flight
}
