//! The motion of a box from its first touch until nothing significant can follow.

use clatter::Error as InputError;

use super::dormand_prince::Step;
use super::system::{Corner, Hold, ROUGH, SMOOTH, System, Turns, cross, dot, ground, in_box, parts, set_stretch};
use super::{Block, BlockDrop, times};
use crate::Error;
use crate::contact::{Contact, alike};
use crate::flight::Stop;

/// Allowed error of a step: depths over the deepest, velocities over the fastest. Peaks of parts are then within some
/// 1e−6.
const TOLERANCE: f64 = 1e-8;
/// The same of stretches along the ground, over that of depths.
const STRETCH: f64 = 30.0;
/// Samples of a step among which events are searched.
const SAMPLES: u32 = 8;
/// Halvings of the time of an event: to the last bit of a share.
const HALVINGS: u32 = 52;
/// The most steps: a box that rings on for so long is left.
const STEPS: usize = 100_000;
/// Events in a row at one time that no motion needs.
const IDLE: usize = 256;
/// A box is followed until later presses change velocities by less than this share of the largest approach.
const REST: f64 = 1e-3;
/// The number of contact times whose velocity change by the weight ends the flight as well.
const WEIGHT: f64 = 4.0;
/// Share of unexplained change of energy at which a flight ends.
const ENERGY: f64 = 0.01;
/// The least restitution of hysteretic contacts of a box: unloading is then a hundred times as fast as loading.
pub const LEAST_OF_BLOCKS: f64 = 0.01;

/// One press of a corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BlockStrike {
    /// Number of the press, from 1.
    pub number: u64,
    /// Index of its corner in [`Block::corners_m`].
    pub corner: usize,
    /// Time of touching.
    pub time_s: f64,
    /// Time of parting; infinite where it still presses at the end of the flight.
    pub until_s: f64,
    /// Vertical velocity of the corner as it touches; negative.
    pub approach_m_s: f64,
    /// Changes of the vertical velocities of all corners by the force of this press.
    pub delta_v_m_s: [f64; 8],
}

/// A flight of a box.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockFlight {
    /// Presses in the order of their touches.
    pub strikes: Vec<BlockStrike>,
    /// Reason for its end; at rest with a bound on the effect of later presses.
    pub stop: Stop,
    /// Unexplained changes of the energy of the box, summed without regard to sign, over the energy at the first touch.
    pub energy_error: f64,
    /// Height of the center of mass at the end.
    pub center_m: f64,
    /// Velocity of the center of mass at the end, upward.
    pub center_m_s: f64,
    /// The same along x and y of the ground, 0 without friction.
    pub along_m_s: [f64; 2],
    /// The vertical in axes of the box, at the end.
    pub upward: [f64; 3],
    /// Spin in axes of the box, at the end.
    pub spin_rad_s: [f64; 3],
    /// Speed of the center of mass that the whole remaining energy would give it: the energy above that of lying still,
    /// on the face under the box where it cannot fall over an edge, else on the broadest face.
    pub left_m_s: f64,
    /// Largest depth of a corner.
    pub deepest_m: f64,
    /// Energy over the mass at the end, of lying with the center of mass on the ground 0.
    pub energy_m2_s2: f64,
}

impl BlockFlight {
    /// Returns the largest change of velocity of a corner by one press.
    #[must_use]
    pub fn largest_m_s(&self) -> f64 {
        self.strikes.iter().flat_map(|strike| strike.delta_v_m_s).fold(0.0, |most, v| most.max(v.abs()))
    }
    /// Returns the acceleration above free fall at a place from the center of mass, along the axes of a box that lies
    /// and turns on about the vertical.
    #[must_use]
    pub fn at_rest_m_s2(&self, place_m: [f64; 3], gravity_m_s2: f64) -> [f64; 3] {
        let turn = dot(self.spin_rad_s, self.upward);
        let around = self.upward.map(|n| turn * n);
        let outward = cross(around, cross(around, place_m));
        std::array::from_fn(|axis| gravity_m_s2 * self.upward[axis] + outward[axis])
    }
}

/// A part of a flight in which every force is smooth.
#[derive(Debug)]
pub struct BlockStep<'a> {
    /// Begin of the part.
    pub from_s: f64,
    /// Duration of the part.
    pub length_s: f64,
    whole: f64,
    step: &'a dyn Sampled,
    system: &'a System,
}

/// A step without or with friction.
trait Sampled: std::fmt::Debug {
    /// Returns the numbers of a state that both have, at a share of the step.
    fn state(&self, share: f64) -> [f64; SMOOTH];
    /// Returns the force and the moment of the ground over the mass, in axes of the box.
    fn load(&self, system: &System, share: f64) -> [[f64; 3]; 2];
}

impl<const N: usize> Sampled for Step<N> {
    fn state(&self, share: f64) -> [f64; SMOOTH] {
        let y = self.at(share);
        std::array::from_fn(|k| y[k])
    }
    fn load(&self, system: &System, share: f64) -> [[f64; 3]; 2] {
        let y = self.at(share);
        let load = system.load(&y);
        [load.force(&y), load.moment]
    }
}

impl BlockStep<'_> {
    fn part(&self, share: f64) -> f64 {
        share * self.length_s / self.whole
    }
    fn state(&self, share: f64) -> [f64; SMOOTH] {
        self.step.state(self.part(share))
    }
    /// Returns the acceleration above free fall at a place from the center of mass, along the axes of the box, at a
    /// share of the step.
    #[must_use]
    pub fn felt_m_s2(&self, place_m: [f64; 3], share: f64) -> [f64; 3] {
        self.felt_everywhere(share).map(|[center, x, y, z]| center + dot([x, y, z], place_m))
    }
    /// Returns that acceleration for every place: along each axis of the box the one of the center of mass, and its
    /// increase per meter along x, y and z.
    #[must_use]
    pub fn felt_everywhere(&self, share: f64) -> [[f64; 4]; 3] {
        let (_, _, _, spin) = parts(&self.state(share));
        let [force, moment] = self.step.load(self.system, self.part(share));
        let [tx, ty, tz] = self.system.turning(spin, moment);
        let turning = [[0.0, -tz, ty], [tz, 0.0, -tx], [-ty, tx, 0.0]];
        let square = dot(spin, spin);
        std::array::from_fn(|i| {
            // Towards the axis of the spin: ω (ω·r) − ω² r.
            let around = |j: usize| spin[i] * spin[j] - if i == j { square } else { 0.0 };
            let [x, y, z] = [0, 1, 2].map(|j| turning[i][j] + around(j));
            [force[i], x, y, z]
        })
    }
    /// Returns whether the ground presses on a corner.
    #[must_use]
    pub fn presses(&self) -> bool {
        self.system.presses()
    }
    /// Returns the vertical in axes of the box, at a share of the step.
    #[must_use]
    pub fn upward(&self, share: f64) -> [f64; 3] {
        parts(&self.state(share)).2
    }
    /// Returns the height and vertical velocity of a place from the center of mass, at a share of the step.
    #[must_use]
    pub fn place_m(&self, place_m: [f64; 3], share: f64) -> (f64, f64) {
        System::place(&self.state(share), place_m)
    }
    /// Returns the forces of the ground on the corners over the mass, upward.
    #[must_use]
    pub fn force_per_mass_m_s2(&self, share: f64) -> [f64; 8] {
        let y = self.state(share);
        std::array::from_fn(|i| self.system.force(i, &y))
    }
}

impl BlockDrop {
    /// Returns the flight with contacts that take time at the corners; `each` is called with every part of it.
    ///
    /// It ends at rest: where the remaining energy lets later presses change the velocity of no corner by more than a
    /// thousandth of the largest approach, or than the weight does in some contact times.
    ///
    /// # Accuracy
    /// Steps are wrong by 1e−8 of depths and velocities; peaks of parts differ from an independent integration by 1e−5
    /// (`tests/block`), velocities and spins with friction by 2e−4 (`tests/friction`).
    /// The restitution of a hysteretic contact is [`LEAST_OF_BLOCKS`] at least.
    ///
    /// # Errors
    /// [`Error::Bound`] unless the contact time is at least 1e−7 of the largest size over the speed, and where a corner sinks in by more than
    /// the smallest size: it would be pressed through the ground.
    ///
    /// # Examples
    /// A flat drop with e = 1 and no gravity: four corners press along one half-sine and the box rises as fast as it came.
    /// ```
    /// use clatter_flight::{Block, BlockDrop, Contact, ContactLaw};
    /// let block = Block::new([0.12, 0.06, 0.02], [0.0; 3], [0.018, 0.035, 0.039])?;
    /// let drop = BlockDrop::tilted(block, 0.0, 0.0, 2.0, 0.0)?;
    /// let flight = drop.contacts(&Contact::new(ContactLaw::Hysteretic, 1.0, 3e-4)?, |_| ())?;
    /// assert_eq!(flight.strikes.len(), 4);
    /// assert!((flight.center_m_s - 2.0).abs() < 1e-6);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn contacts(&self, contact: &Contact, each: impl FnMut(&BlockStep<'_>)) -> Result<BlockFlight, Error> {
        self.own_contacts(&[*contact; 8], each)
    }

    /// Returns the same flight with a contact of its own at each corner, in the order of [`Block::corners_m`].
    ///
    /// # Errors
    /// The errors of [`contacts`](Self::contacts), for each of the contacts; [`Error::Laws`] if they differ and not all
    /// are hysteretic.
    pub fn own_contacts(
        &self,
        contacts: &[Contact; 8],
        mut each: impl FnMut(&BlockStep<'_>),
    ) -> Result<BlockFlight, Error> {
        alike(contacts)?;
        contacts.iter().try_for_each(|contact| self.check(contact))?;
        if self.friction == 0.0 {
            Run::<SMOOTH>::new(self, contacts).run(&mut each)
        } else {
            Run::<ROUGH>::new(self, contacts).run(&mut each)
        }
    }

    fn check(&self, contact: &Contact) -> Result<(), Error> {
        let largest = self.block.size_m().into_iter().fold(0.0, f64::max);
        let (value, bound) = (contact.time_s(), 1e-7 * largest / self.fastest());
        if value >= bound {
            return Ok(());
        }
        let reason = "1e-7 of the largest size over the speed, so that corners sink in at all";
        Err(Error::Bound { name: "contact time", value, bound, most: false, unit: "s", reason })
    }

    /// Returns a bound on the speed of every corner at the first touch.
    fn fastest(&self) -> f64 {
        let [x, y] = self.slide;
        (self.speed * self.speed + x * x + y * y).sqrt() + dot(self.spin, self.spin).sqrt() * self.block.reach()
    }
}

impl Block {
    /// Returns the distance of the furthest corner from the center of mass.
    fn reach(&self) -> f64 {
        self.corners_m().iter().map(|corner| dot(*corner, *corner).sqrt()).fold(0.0, f64::max)
    }
}

struct Run<'a, const N: usize> {
    drop: &'a BlockDrop,
    contacts: &'a [Contact; 8],
    /// Largest restitution of all contacts.
    restitution: f64,
    /// Shortest and longest contact times.
    times_s: [f64; 2],
    system: System,
    y: [f64; N],
    now: f64,
    /// Length of the next step.
    stride: f64,
    /// Scales of the numbers of a state.
    scales: [f64; N],
    strikes: Vec<BlockStrike>,
    fastest: f64,
    opened: f64,
    misfit: f64,
    most_coupling: f64,
    /// Largest depth of a corner so far.
    sunk: f64,
}

impl<'a, const N: usize> Run<'a, N> {
    fn new(drop: &'a BlockDrop, contacts: &'a [Contact; 8]) -> Self {
        let block = drop.block;
        let has_dents = contacts[0].law().leaves_a_dent();
        let restitutions =
            contacts.map(|contact| contact.restitution().max(if has_dents { LEAST_OF_BLOCKS } else { 0.0 }));
        let (corners, reach) = (block.corners_m(), block.reach());
        let loss = restitutions.map(|e| if has_dents { e * e } else { 1.0 });
        // Dashpots are all equal.
        let delay = 2.0 * contacts[0].damping_ratio() / contacts[0].frequency_rad_s();
        let shortest = contacts.iter().fold(f64::INFINITY, |least, contact| least.min(contact.time_s()));
        let longest = contacts.iter().fold(0.0_f64, |most, contact| most.max(contact.time_s()));
        let up = Corner { hold: Hold::Up, ground: 0.0, stiffness: 0.0, frequency: 0.0, slips: false, strike: 0 };
        let (gravity, friction) = (drop.gravity, drop.friction);
        let (fastest, time) = (drop.fastest(), shortest);
        let (depth, turn) = (fastest * time, fastest * time / reach);
        let system = System { corners, block, gravity, friction, depth, delay, loss, holds: [up; 8] };
        let n = drop.upward;
        let lowest = corners.iter().map(|corner| dot(n, *corner)).fold(f64::INFINITY, f64::min);
        let smooth = [-lowest, -drop.speed, n[0], n[1], n[2], drop.spin[0], drop.spin[1], drop.spin[2]];
        let (fast, spin) = (fastest, fastest / reach);
        let mut y = [0.0; N];
        y[..SMOOTH].copy_from_slice(&smooth);
        // Friction follows a stretch less exactly than a force its depth.
        let mut scales = [STRETCH * depth; N];
        scales[..SMOOTH].copy_from_slice(&[depth, fast, turn, turn, turn, spin, spin, spin]);
        if N == ROUGH {
            y[8..10].copy_from_slice(&drop.slide);
            y[10..13].copy_from_slice(&drop.along);
            scales[8..13].copy_from_slice(&[fast, fast, turn, turn, turn]);
        }
        Self {
            drop,
            contacts,
            restitution: restitutions.into_iter().fold(0.0, f64::max),
            times_s: [shortest, longest],
            system,
            y,
            now: 0.0,
            stride: 0.01 * time,
            scales,
            strikes: Vec::new(),
            fastest: 0.0,
            opened: system.energy(&y) + drop.gravity * reach,
            misfit: 0.0,
            most_coupling: 1.0 + (reach / block.least).powi(2),
            sunk: 0.0,
        }
    }

    fn first_touches(&mut self) {
        let near = 1e-12 * self.drop.block.reach();
        for i in 0..8 {
            let (height, velocity) = System::place(&self.y, self.system.corners[i]);
            if height <= near && velocity < 0.0 {
                self.touch(i, velocity);
            }
        }
    }

    fn run(mut self, each: &mut dyn FnMut(&BlockStep<'_>)) -> Result<BlockFlight, Error> {
        self.first_touches();
        if self.strikes.is_empty() {
            let (name, allowed) = ("spin in rad/s", "such that the lowest corner approaches");
            let value = dot(self.drop.spin, self.drop.spin).sqrt();
            return Err(InputError::Quantity { name, value, allowed }.into());
        }
        let mut idle = 0;
        for _ in 0..STEPS {
            if let Some(stop) = self.ends() {
                return self.finish(stop);
            }
            let before = self.now;
            if self.step(each) {
                break;
            }
            idle = if self.now > before { 0 } else { idle + 1 };
            if self.strikes.len() > self.drop.impact_limit {
                self.strikes.truncate(self.drop.impact_limit);
                let time_s = self.now;
                return self.finish(Stop::ImpactLimit { time_s });
            }
            if idle > IDLE {
                break;
            }
        }
        let time_s = self.now;
        self.finish(Stop::TimeLimit { time_s })
    }

    /// Refuses corners that sink in by the smallest size.
    fn check_depth(&self) -> Result<(), Error> {
        let most = self.drop.block.size_m().into_iter().fold(f64::INFINITY, f64::min);
        if self.sunk <= most {
            return Ok(());
        }
        let (name, value, unit) = ("contact time", self.times_s[1], "s");
        let reason = "so that corners sink in by the smallest size at most";
        Err(Error::Bound { name, value, bound: value * most / self.sunk, most: true, unit, reason })
    }

    /// Returns the reason to stop, if nothing significant can follow.
    fn ends(&self) -> Option<Stop> {
        let (z, v, _, _) = parts(&self.y);
        if self.misfit > ENERGY * self.opened {
            return Some(Stop::EnergyLimit { time_s: self.now });
        }
        let gravity = self.drop.gravity;
        if gravity == 0.0 {
            let is_up = self.system.holds.iter().all(|corner| corner.hold == Hold::Up);
            let is_clear = is_up && v > 0.0 && z > self.drop.block.reach();
            return is_clear.then_some(Stop::BouncedClear { time_s: self.now });
        }
        let bound = (1.0 + self.restitution) * (2.0 * self.available_energy() * self.most_coupling).sqrt();
        let weight = WEIGHT * gravity * self.times_s[0];
        if bound <= (REST * self.fastest).max(weight) {
            let (time_s, time_bound_s) = (self.now, f64::INFINITY);
            return Some(Stop::AtRest { time_s, time_bound_s, shock_bound_m_s: bound });
        }
        (bound <= self.drop.enough * self.fastest).then_some(Stop::Enough { time_s: self.now })
    }

    /// Returns the energy over the mass that later presses can take.
    fn available_energy(&self) -> f64 {
        let (_, _, n, spin) = parts(&self.y);
        let energy = self.system.energy(&self.y) + self.system.stored(&self.y);
        // Friction may brake any turning.
        let momentum = if N == SMOOTH { dot(n, times(&self.drop.block.inertia, spin)) } else { 0.0 };
        let ground = std::array::from_fn(|i| self.system.dent(i, &self.y));
        (energy - self.drop.block.kept(n, energy, self.drop.gravity, momentum, ground)).max(0.0)
    }

    /// Makes one step, to the next event at most, and returns whether the time is over.
    fn step(&mut self, each: &mut dyn FnMut(&BlockStep<'_>)) -> bool {
        let left = self.drop.time_limit - self.now;
        let (_, _, _, spin) = parts(&self.y);
        let turn = 0.25 / dot(spin, spin).sqrt();
        let fall = 0.1 * (self.drop.block.reach() / self.drop.gravity).sqrt();
        let apart = 0.1 * self.drop.block.reach() / self.drop.speed;
        let mut h = self.stride.min(turn).min(fall.min(apart)).min(left);
        let step = loop {
            let step = Step::new(&self.y, h, |y| self.system.slope(y));
            let over = (0..N).map(|i| step.error[i].abs() / (TOLERANCE * self.scales[i])).fold(0.0, f64::max);
            // Below this error the factor exceeds the largest growth of the stride.
            let factor = if over < 1e-4 { 5.0 } else { 0.9 * libm::pow(over, -0.2) };
            if over <= 1.0 {
                self.stride = h * factor.clamp(0.2, 5.0);
                break step;
            }
            h *= factor.clamp(0.1, 0.9);
        };
        let reach = step.reach();
        let is_watched: [bool; 8] = std::array::from_fn(|i| !self.system.stays_up(i, &self.y, &reach));
        let happened = |share: f64| {
            let y = step.at(share);
            (0..8).any(|i| is_watched[i] && self.system.has_happened(i, &y))
        };
        let samples = if is_watched == [false; 8] { 0 } else { SAMPLES };
        let samples = (1..=samples).map(|k| f64::from(k) / f64::from(SAMPLES));
        let event = samples.into_iter().find(|share| happened(*share)).map(|until| {
            let (mut before, mut after) = (until - 1.0 / f64::from(SAMPLES), until);
            // Of those that have happened by then, one is the first.
            let y = step.at(until);
            let all: [bool; 8] = std::array::from_fn(|i| is_watched[i] && self.system.has_happened(i, &y));
            for _ in 0..HALVINGS {
                let middle = 0.5 * (before + after);
                let y = step.at(middle);
                let is_over = (0..8).any(|i| all[i] && self.system.has_happened(i, &y));
                *(if is_over { &mut after } else { &mut before }) = middle;
            }
            after
        });
        let share = event.unwrap_or(1.0);
        let (from_s, system) = (self.now, &self.system);
        each(&BlockStep { from_s, length_s: share * h, whole: h, step: &step, system });
        self.push(&step, h, share);
        self.now += share * h;
        if event.is_some() {
            for i in 0..8 {
                if self.system.has_turned(i, &self.y) {
                    if self.now >= self.drop.lands_after && self.system.lands(i, &self.y) && self.is_light() {
                        return true;
                    }
                    self.stride = self.stride.min(0.01 * self.times_s[0]);
                    self.turns(i);
                } else if self.system.has_happened(i, &self.y) {
                    if self.system.holds[i].slips {
                        self.system.sticks(i, &mut self.y);
                    } else {
                        self.system.slides_on(i, &mut self.y);
                    }
                }
            }
            return false;
        }
        h >= left
    }

    /// Books the effect of the forces over a part of a step, by Simpson's rule, and the error of its energy.
    fn push(&mut self, step: &Step<N>, h: f64, share: f64) {
        let states = [0.0, 0.5, 1.0].map(|of| step.at(of * share));
        let mut work = 0.0;
        for (y, weight) in states.iter().zip([1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0]) {
            let (_, _, n, _) = parts(y);
            let mut turns: Option<Turns> = None;
            for i in 0..8 {
                let impulse = weight * h * share * self.system.force(i, y);
                if impulse == 0.0 {
                    continue;
                }
                work += impulse * System::place(y, self.system.corners[i]).1;
                let turns = turns.get_or_insert_with(|| self.system.turns(n));
                let strike = self.system.holds[i].strike;
                for (j, delta_v) in self.strikes[strike].delta_v_m_s.iter_mut().enumerate() {
                    *delta_v += impulse * turns.coupling(i, j);
                }
                if N == ROUGH {
                    let grip = self.system.grip(i, y, self.system.force(i, y));
                    let along = grip.force.map(|force| weight * h * share * force);
                    work += along[0] * grip.slides[0] + along[1] * grip.slides[1];
                    let turned = times(&self.drop.block.inverse, cross(self.system.corners[i], in_box(y, along)));
                    for (j, delta_v) in self.strikes[strike].delta_v_m_s.iter_mut().enumerate() {
                        *delta_v += dot(turned, turns.arms[j]);
                    }
                }
            }
        }
        let before = self.system.energy(&self.y);
        self.y = states[2];
        for corner in self.system.corners {
            self.sunk = self.sunk.max(-System::place(&self.y, corner).0);
        }
        self.misfit += (self.system.energy(&self.y) - before - work).abs();
        // This removes the effect of roundings on the length of the vertical.
        let n = [self.y[2], self.y[3], self.y[4]];
        let length = dot(n, n).sqrt();
        (2..5).for_each(|i| self.y[i] /= length);
        if N == ROUGH {
            let ((_, _, n, _), along) = (parts(&self.y), ground(&self.y)[0]);
            let off = dot(n, along);
            let level: [f64; 3] = std::array::from_fn(|axis| along[axis] - off * n[axis]);
            let length = dot(level, level).sqrt();
            (0..3).for_each(|axis| self.y[10 + axis] = level[axis] / length);
            for i in 0..8 {
                if self.system.holds[i].bears() && self.system.holds[i].slips {
                    self.system.slides_on(i, &mut self.y);
                }
            }
        }
    }

    fn touch(&mut self, i: usize, velocity: f64) {
        let (_, _, n, _) = parts(&self.y);
        let own = self.system.turns(n).coupling(i, i);
        let corner = &mut self.system.holds[i];
        corner.frequency = self.contacts[i].frequency_rad_s();
        corner.stiffness = corner.frequency * corner.frequency / own;
        (corner.hold, corner.strike) = (Hold::Loads, self.strikes.len());
        if N == ROUGH {
            let slides = System::slides(&self.y, self.system.corners[i]);
            self.system.holds[i].slips = false;
            if self.system.slips_at_once(slides, velocity) {
                self.system.slides_on(i, &mut self.y);
            }
        }
        self.fastest = self.fastest.max(-velocity);
        self.strikes.push(BlockStrike {
            number: self.strikes.len() as u64 + 1,
            corner: i,
            time_s: self.now,
            until_s: f64::INFINITY,
            approach_m_s: velocity,
            delta_v_m_s: [0.0; 8],
        });
    }

    fn turns(&mut self, i: usize) {
        let (height, velocity) = System::place(&self.y, self.system.corners[i]);
        let corner = &mut self.system.holds[i];
        let depth = corner.ground - height;
        match corner.hold {
            Hold::Up if height > 0.0 => corner.ground = 0.0,
            Hold::Loads if self.system.delay > 0.0 => self.parts(i, if depth > 0.0 { Hold::Slack } else { Hold::Up }),
            Hold::Loads => corner.hold = Hold::Unloads(depth),
            Hold::Unloads(deepest) if depth > deepest => corner.hold = Hold::Loads,
            Hold::Unloads(deepest) => {
                corner.ground -= deepest * (1.0 - self.system.loss[i]);
                self.parts(i, Hold::Up);
            }
            Hold::Slack if depth <= 0.0 => corner.hold = Hold::Up,
            Hold::Up | Hold::Slack => self.touch(i, velocity),
        }
    }

    /// Returns whether the ground presses no harder than twice the weight: else the motion that is left would go on by what presses, and
    /// parts would ring by that as it is left out.
    fn is_light(&self) -> bool {
        self.system.load(&self.y).up <= 2.0 * self.drop.gravity
    }

    fn parts(&mut self, i: usize, hold: Hold) {
        self.system.holds[i].hold = hold;
        if N == ROUGH {
            set_stretch(&mut self.y, i, [0.0; 2]);
        }
        self.strikes[self.system.holds[i].strike].until_s = self.now;
    }

    fn finish(self, stop: Stop) -> Result<BlockFlight, Error> {
        self.check_depth()?;
        let (center_m, center_m_s, upward, spin_rad_s) = parts(&self.y);
        let along_m_s = if N == ROUGH { [self.y[8], self.y[9]] } else { [0.0; 2] };
        let (energy_error, left_m_s) = (self.misfit / self.opened, (2.0 * self.available_energy()).sqrt());
        let strikes = self.strikes;
        let (deepest_m, energy_m2_s2) = (self.sunk, self.system.energy(&self.y) + self.system.stored(&self.y));
        Ok(BlockFlight {
            strikes,
            stop,
            energy_error,
            center_m,
            center_m_s,
            along_m_s,
            upward,
            spin_rad_s,
            left_m_s,
            deepest_m,
            energy_m2_s2,
        })
    }
}

#[cfg(test)]
mod tests;
