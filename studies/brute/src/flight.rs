//! One drop of a bar, integrated in small steps: exact geometry, gravity, forces at the two ends.

/// Force of a contact over its depth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Law {
    /// Loads on one line and unloads on a steeper one; leaves a dent.
    Hysteretic,
    /// Spring and dashpot that never pull.
    Dashpot,
}

/// A bar at the moment when its lower end touches the ground, all of it falling at one speed; SI units.
#[derive(Debug, Clone, Copy)]
pub struct Drop {
    /// From end a to end b.
    pub length: f64,
    /// Radius of gyration about the center of mass.
    pub gyration: f64,
    /// Center of mass, from the middle towards end b.
    pub center: f64,
    /// Restitution of the ends.
    pub e: f64,
    /// Law and time of a lone contact; none for instant impacts.
    pub contact: Option<(Law, f64)>,
    /// Speed.
    pub speed: f64,
    /// Angle to the ground.
    pub tilt: f64,
    /// Whether end b is the lower one.
    pub b_first: bool,
    /// Gravity.
    pub gravity: f64,
}

/// When to stop.
#[derive(Debug, Clone, Copy)]
pub struct Until {
    /// After this time.
    pub time: f64,
    /// When both ends strike more slowly than this share of the speed of the drop.
    pub quiet: f64,
}

/// One step of time under contact. A place at x from the center of mass feels `push + x · lift`, at begin, middle and end.
#[derive(Debug, Clone, Copy)]
pub struct Step {
    /// When it begins.
    pub time: f64,
    /// How long it is; 0 for an instant impact, whose three values are then changes of velocity.
    pub length: f64,
    /// Whether neither end is down.
    pub flying: bool,
    /// Felt acceleration of the center of mass.
    pub push: [f64; 3],
    /// Felt acceleration for each meter from it.
    pub lift: [f64; 3],
    /// Angular acceleration.
    pub turn: [f64; 3],
}

/// An end meets the ground.
#[derive(Debug, Clone, Copy)]
pub struct Touch {
    /// When.
    pub time: f64,
    /// 0 for end a, 1 for end b.
    pub end: usize,
    /// Velocity of the end, upward positive.
    pub velocity: f64,
    /// Kinetic, potential and stored energy per mass.
    pub energy: f64,
}

/// A drop that was followed.
#[derive(Debug, Clone, Default)]
pub struct Flight {
    /// All steps under contact, in order; between them nothing is felt.
    pub steps: Vec<Step>,
    /// Each time that an end met the ground.
    pub touches: Vec<Touch>,
    /// When it was left.
    pub end: f64,
    /// Whether the bar lies still from then on, and its weight is on.
    pub at_rest: bool,
    /// Gravity.
    pub gravity: f64,
    /// Energy per mass when it was left.
    pub energy: f64,
}

/// Height of the center of mass, angle, and their rates.
type State = [f64; 4];

/// Restitution below which the unloading line of the hysteretic law is too steep to be stepped.
const LEAST_RESTITUTION: f64 = 0.01;
/// Steps of time in radians of the fastest oscillation.
const FINE: f64 = 0.08;
/// The same while nothing but the weight is carried.
const COARSE: f64 = 0.5;
/// Steps of free flight in radians that the bar turns.
const TURN: f64 = 0.1;
/// A drop that needs more is left.
const MOST_STEPS: usize = 1_000_000;
/// Rebound speed below which an end that strikes at an instant hops on, as a share of the speed of the drop.
const HOP: f64 = 1e-4;

#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
enum Phase {
    #[default]
    Free,
    /// Loading on the virgin line; the only phase of a dashpot.
    Load,
    /// Below the virgin line.
    Unload,
}

#[derive(Debug, Clone, Copy, Default)]
struct Contact {
    phase: Phase,
    /// Height of the ground under this end: 0, or below it where it was parted in its dent.
    ground: f64,
    stiffness: f64,
    dashpot: f64,
    /// Depth where the unloading line begins, and where it meets zero.
    deepest: f64,
    zero: f64,
}

struct Bar {
    drop: Drop,
    /// The ends from the center of mass.
    ends: [f64; 2],
    inertia: f64,
    e: f64,
    /// Frequency and damping rate of a lone contact.
    omega: f64,
    damping: f64,
    contacts: [Contact; 2],
}

impl Bar {
    fn new(drop: &Drop) -> Self {
        let half = drop.length / 2.0;
        let (omega, damping, e) = match drop.contact {
            Some((Law::Hysteretic, time)) => {
                let e = drop.e.max(LEAST_RESTITUTION);
                (std::f64::consts::FRAC_PI_2 * (1.0 + e) / time, 0.0, e)
            }
            Some((Law::Dashpot, time)) => {
                let (omega, zeta) = dashpot(drop.e.max(LEAST_RESTITUTION));
                (omega / time, zeta * omega / time, drop.e)
            }
            None => (0.0, 0.0, drop.e),
        };
        Self {
            drop: *drop,
            ends: [-half - drop.center, half - drop.center],
            inertia: drop.gyration * drop.gyration,
            e,
            omega,
            damping,
            contacts: [Contact::default(); 2],
        }
    }

    fn start(&self) -> State {
        let angle = if self.drop.b_first { -self.drop.tilt } else { self.drop.tilt };
        [-self.ends[usize::from(self.drop.b_first)] * angle.sin(), angle, -self.drop.speed, 0.0]
    }

    fn hysteretic(&self) -> bool {
        matches!(self.drop.contact, Some((Law::Hysteretic, _)))
    }

    fn height(&self, end: usize, s: &State) -> f64 {
        s[0] + self.ends[end] * s[1].sin()
    }

    fn velocity(&self, end: usize, s: &State) -> f64 {
        s[2] + self.ends[end] * s[1].cos() * s[3]
    }

    /// Acceleration of an end for each unit of force on it, per mass.
    fn mobility(&self, end: usize, s: &State) -> f64 {
        1.0 + (self.ends[end] * s[1].cos()).powi(2) / self.inertia
    }

    /// Force per mass, on the line of the present phase.
    fn force(&self, end: usize, s: &State) -> f64 {
        let c = &self.contacts[end];
        let depth = c.ground - self.height(end, s);
        match c.phase {
            Phase::Free => 0.0,
            Phase::Load => c.stiffness * depth - c.dashpot * self.velocity(end, s),
            Phase::Unload => c.stiffness / (self.e * self.e) * (depth - c.zero),
        }
    }

    /// Felt acceleration of the center of mass and angular acceleration.
    fn accelerations(&self, s: &State) -> (f64, f64) {
        let [a, b] = [self.force(0, s), self.force(1, s)];
        (a + b, (a * self.ends[0] + b * self.ends[1]) * s[1].cos() / self.inertia)
    }

    fn rate(&self, s: &State) -> State {
        let (push, turn) = self.accelerations(s);
        [s[2], s[3], push - self.drop.gravity, turn]
    }

    /// A step of Runge and Kutta.
    fn step(&self, s: &State, h: f64) -> State {
        let along = |rate: &State, h: f64| -> State { std::array::from_fn(|i| s[i] + h * rate[i]) };
        let k1 = self.rate(s);
        let k2 = self.rate(&along(&k1, h / 2.0));
        let k3 = self.rate(&along(&k2, h / 2.0));
        let k4 = self.rate(&along(&k3, h));
        std::array::from_fn(|i| s[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]))
    }

    /// Positive within a phase, negative when it is over.
    fn room(&self, end: usize, s: &State) -> f64 {
        let c = &self.contacts[end];
        let height = self.height(end, s);
        match c.phase {
            Phase::Free if c.dashpot > 0.0 => {
                // Parted below the ground: presses again when spring and dashpot together push.
                (c.stiffness * height + c.dashpot * self.velocity(end, s)).min(-height)
            }
            Phase::Free if c.ground < 0.0 => (height - c.ground).min(-height),
            Phase::Free => height,
            Phase::Load if self.hysteretic() => -self.velocity(end, s),
            Phase::Load => self.force(end, s),
            Phase::Unload => (c.ground - height - c.zero).min(c.deepest - (c.ground - height)),
        }
    }

    /// The phase of an end is over: the next one begins. Tells whether it is a touch.
    fn advance(&mut self, end: usize, s: &State) -> bool {
        let (height, mobility) = (self.height(end, s), self.mobility(end, s));
        let (omega, damping, e, hysteretic) = (self.omega, self.damping, self.e, self.hysteretic());
        let c = &mut self.contacts[end];
        match c.phase {
            Phase::Free if height >= 0.0 && (c.ground < 0.0 || c.dashpot > 0.0) => (c.ground, c.dashpot) = (0.0, 0.0),
            Phase::Free => {
                c.phase = Phase::Load;
                if c.dashpot == 0.0 {
                    (c.stiffness, c.dashpot) = (omega * omega / mobility, 2.0 * damping / mobility);
                }
                return true;
            }
            Phase::Load if hysteretic => {
                c.deepest = c.ground - height;
                c.zero = c.deepest * (1.0 - e * e);
                c.phase = Phase::Unload;
            }
            Phase::Load => c.phase = Phase::Free,
            Phase::Unload if c.ground - height < c.zero => {
                c.phase = Phase::Free;
                c.ground = height;
            }
            Phase::Unload => c.phase = Phase::Load,
        }
        false
    }

    fn energy(&self, s: &State) -> f64 {
        let stored = |end: usize| {
            let c = &self.contacts[end];
            let force = self.force(end, s);
            match c.phase {
                // The spring of a dashpot keeps what it has until its end is up.
                _ if c.dashpot > 0.0 => c.stiffness * self.height(end, s).powi(2) / 2.0,
                Phase::Free => 0.0,
                _ => force * force * self.e * self.e / (2.0 * c.stiffness),
            }
        };
        let kinetic = 0.5 * (s[2] * s[2] + self.inertia * s[3] * s[3]);
        kinetic + self.drop.gravity * s[0] + stored(0) + stored(1)
    }

    /// A step of time that resolves the fastest oscillation of what presses.
    fn fine(&self, s: &State) -> f64 {
        let (mut square, mut rate) = (0.0, 0.0);
        for end in 0..2 {
            let (c, mobility) = (&self.contacts[end], self.mobility(end, s));
            match c.phase {
                Phase::Free => {}
                Phase::Load => {
                    square += c.stiffness * mobility;
                    rate += c.dashpot * mobility;
                }
                Phase::Unload => square += c.stiffness * mobility / (self.e * self.e),
            }
        }
        let little = 10.0 * self.drop.gravity;
        let weak = |end: usize| match (self.contacts[end].phase, &self.contacts[end]) {
            (Phase::Free, _) => true,
            (Phase::Load, c) => {
                let (depth, velocity) = (self.height(end, s), self.velocity(end, s));
                c.dashpot > 0.0 && c.stiffness * depth.abs() + c.dashpot * velocity.abs() < little
            }
            (Phase::Unload, c) => c.stiffness * c.deepest < little,
        };
        let radians = if weak(0) && weak(1) { COARSE } else { FINE };
        radians / f64::sqrt(square).max(rate).max(self.omega / 4.0)
    }

    /// Time until an end comes to the ground, in free flight: steps that cannot reach beyond it.
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
        (flight.at_rest, flight.gravity) = (at_rest, self.drop.gravity);
        flight.energy = self.energy(s);
        flight
    }

    /// How long both ends have to press without an event to be at rest: twice the slower oscillation on the steep lines.
    fn patience(&self, s: &State) -> f64 {
        let mobility = self.mobility(0, s).min(self.mobility(1, s));
        let slow = self.omega / self.e.max(LEAST_RESTITUTION) * (2.0 * (mobility - 1.0).min(1.0) / mobility).sqrt();
        (2.0 * std::f64::consts::TAU / slow).max(4.0 * self.drop.contact.map_or(0.0, |(_, time)| time))
    }
}

/// Frequency and damping ratio of spring and dashpot that touch for a time of 1 and part, where they would pull, with
/// restitution e.
fn dashpot(e: f64) -> (f64, f64) {
    // Time to the end of the push, in units of 1/ω; the restitution is then exp(−ζ ω t).
    let time = |zeta: f64| {
        let d = (1.0 - zeta * zeta).abs();
        match zeta {
            z if d < 1e-9 => 2.0 * z,
            z if z < 1.0 => 2.0 * z.acos() / d.sqrt(),
            z => 2.0 * z.acosh() / d.sqrt(),
        }
    };
    let (mut low, mut high) = (0.0_f64, 1e6_f64);
    for _ in 0..200 {
        let mid = if high > 2.0 { (low.max(1e-3) * high).sqrt() } else { f64::midpoint(low, high) };
        if (-mid * time(mid)).exp() > e { low = mid } else { high = mid }
    }
    (time(low), low)
}

/// Follows a drop.
#[must_use]
pub fn follow(drop: &Drop, until: Until) -> Flight {
    if drop.contact.is_some() { contacts(drop, until) } else { instants(drop, until) }
}

/// Contacts that take time.
fn contacts(drop: &Drop, until: Until) -> Flight {
    let mut bar = Bar::new(drop);
    let mut flight = Flight::default();
    let mut s = bar.start();
    let (mut time, mut last_event, mut approach) = (0.0, 0.0, [f64::INFINITY; 2]);
    while time < until.time && flight.steps.len() < MOST_STEPS {
        let above = |c: &Contact| c.phase == Phase::Free && c.ground == 0.0 && c.dashpot == 0.0;
        let mut over = [false; 2];
        if bar.contacts.iter().all(above) {
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

/// What a step felt like; its middle by the cubic through both ends.
fn record(bar: &Bar, time: f64, h: f64, s: &State, next: &State) -> Step {
    let (from, to) = (bar.rate(s), bar.rate(next));
    let middle: State = std::array::from_fn(|i| f64::midpoint(s[i], next[i]) + h / 8.0 * (from[i] - to[i]));
    let felt = [s, &middle, next].map(|s| {
        let (push, turn) = bar.accelerations(s);
        [push, turn * s[1].cos() - s[3] * s[3] * s[1].sin(), turn]
    });
    let [push, lift, turn] = [0, 1, 2].map(|what| felt.map(|felt| felt[what]));
    let flying = bar.contacts.iter().all(|c| c.phase == Phase::Free);
    Step { time, length: h, flying, push, lift, turn }
}

/// Free flight for a time: nothing but that the bar turns is felt.
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

/// Instant impacts, one after the other. An end that would come to rest hops on by a share of the first speed too small
/// to count, so that a bar pivots about it without a law of its own.
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

/// A flat landing of instant impacts: all places lose their speed at once and rebound with e of it.
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
