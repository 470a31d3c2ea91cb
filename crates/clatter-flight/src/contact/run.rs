//! A flight under way: phases one after the other, and the events between them.

use super::law::Contact;
use super::mode::Motion;
use super::phase::{Hold, Phase};
use super::pose::{Extent, Pose};
use super::touch::{Event, Margins, State, Touch, Watch};
use super::{Depth, Phases, Press, Refused};
use crate::Error;
use crate::flight::{After, Flight, Log, Model, State as Heights, Stop};
use crate::motion::{Ahead, Course};
use crate::rigid::Clock;
use crate::roots::{Zero, far_step, first_zero, safe_step};

/// Share of the energy at the first touch whose unexplained change ends a flight, whatever the number of its strikes. A
/// phase that changes the energy by as much is an error.
const ENERGY: f64 = 0.01;
/// Factor on the precision for the turn of a phase over the lever arm, times its push over the fastest approach: a
/// strike is then wrong by less than the precision (measured on random scenes by the tests).
const KEPT: f64 = 4.0;
/// The largest change of what a force does to any point, as a share, in a phase in which something vibrates, over the precision: as much an
/// acceleration may be off while velocities are as precise as asked. A tolerance is ten times the precision, half of the change is on either side of the mean, and
/// a part may swing by twice that.
const SMOOTH: f64 = 5.0;
/// The precision below which that share no longer falls: a phase would be a thousandth of a contact.
const SMOOTHEST: f64 = 1e-4;
/// The most computations of a phase with better lever arms.
const PASSES: usize = 6;
/// Share of the past force on a point by which roundings may pull or push it.
const BEARS: f64 = 1e-9;
/// Share of a contact time within which an event counts as immediate.
const AT_ONCE: f64 = 1e-6;
/// The most cuts of a phase.
const CUTS: usize = 12;
/// The largest length of a phase over the one before, where that was cut.
const GROWTH: f64 = 4.0;
/// Events in a row without time between them that no motion needs.
const IDLE: u32 = 64;
/// The longest phase in contact times where anything vibrates, else a tenth of √(reach/gravity) or of a turn by 1 if
/// that is longer.
const LONG: f64 = 64.0;
/// The most phases beyond those for each strike so far: a body that neither rests nor strikes is left then.
const PHASES: usize = 150_000;
const EACH_STRIKE: usize = 128;
/// The parts of a phase, and the halvings next to the lowest of them, by which the lowest height of a dashpot is found.
const PARTS: u32 = 32;
const NARROWED: usize = 40;
/// Heights within this share of the body's length, and velocities within this share of the largest approach, count as
/// equal just after an event.
const MARGIN: f64 = 1e-14;

pub(crate) struct Run<'a, P: Pose<N>, const N: usize> {
    /// Contact of each point, all by one law.
    pub(super) contacts: &'a [Contact; N],
    pub(super) precision: f64,
    /// Depth below the ground that no point may exceed.
    deepest: f64,
    pub(super) margins: Margins,
    pub(super) extent: Extent,
    pub(super) log: Log<N>,
    pub(super) presses: Vec<Press>,
    pub(super) phases: Vec<(f64, Phase<P, N>)>,
    pub(super) time: Clock,
    pub(super) pose: P,
    pub(super) touches: [Touch; N],
    /// Largest approach so far.
    pub(super) fastest: f64,
    /// Largest length of the next phase, from the error of the last one.
    stride: f64,
    opened: f64,
    misfit: f64,
    idle: u32,
    /// The body just before it comes to rest.
    pub(super) unrested: Option<P>,
    pub(super) resting: [f64; N],
}

/// A phase, its length, and the event that ends it.
struct Lasting<P: Pose<N>, const N: usize> {
    phase: Phase<P, N>,
    dt: f64,
    event: Option<(usize, Watch)>,
}

impl<'a, P: Pose<N>, const N: usize> Run<'a, P, N> {
    /// Creates a flight from the first touch, in which no point sinks in deeper than `deepest`.
    pub(crate) fn new(pose: P, log: Log<N>, contacts: &'a [Contact; N], precision: f64, deepest: f64) -> Self {
        let extent = pose.extent();
        Self {
            contacts,
            precision,
            deepest,
            margins: Margins { height: MARGIN * extent.size, velocity: 0.0, force: precision },
            extent,
            log,
            presses: Vec::with_capacity(16),
            phases: Vec::with_capacity(64),
            time: Clock::default(),
            pose,
            touches: [Touch::away(); N],
            fastest: 0.0,
            stride: f64::INFINITY,
            opened: pose.energy(),
            misfit: 0.0,
            idle: 0,
            unrested: None,
            resting: [0.0; N],
        }
    }

    pub(crate) fn run(mut self, mut enough: impl FnMut(&Ahead<N>) -> bool) -> Result<crate::Motion<N, P>, Refused> {
        let mut goes_on = self.first_touches();
        while goes_on {
            if let Some((forces, bound)) = self.rests() {
                self.rest(forces, bound);
                break;
            }
            goes_on = self.step(&mut enough)?;
        }
        Ok(self.finish())
    }

    /// Returns starts a press at the points that are on the ground and come down, and returns whether the flight goes
    /// on.
    fn first_touches(&mut self) -> bool {
        let (height, velocity) = self.pose.points();
        (0..N).all(|i| height[i] > 0.0 || velocity[i] >= 0.0 || self.touch(i, height[i], velocity[i]))
    }

    /// Computes a phase and the event at its end, and returns whether the flight goes on.
    fn step(&mut self, enough: &mut impl FnMut(&Ahead<N>) -> bool) -> Result<bool, Refused> {
        let Lasting { phase, dt, event } = self.next();
        if dt > 0.0 {
            self.phases.push((self.time.now(), phase));
        }
        if dt == f64::INFINITY {
            self.bounced_clear();
            return Ok(false);
        }
        let left = self.log.time_limit_s - self.time.now();
        if dt > left {
            self.advance(&phase, left)?;
            self.log.lost(self.log.time_limit_s);
            return Ok(false);
        }
        self.advance(&phase, dt)?;
        self.time.add(dt);
        if self.misfit > ENERGY * self.opened {
            self.log.flight.stop = Stop::EnergyLimit { time_s: self.time.now() };
            return Ok(false);
        }
        if self.pose.is_over() {
            self.log.turned_over(self.time.now());
            return Ok(false);
        }
        self.idle = if dt > 0.0 { 0 } else { self.idle + 1 };
        if self.phases.len() >= PHASES + EACH_STRIKE * self.presses.len() || self.idle > IDLE {
            self.log.lost(self.time.now());
            return Ok(false);
        }
        let Some((point, watch)) = event else { return Ok(true) };
        let loads = self.touches.iter().any(|touch| touch.state == State::Loading);
        if !loads
            && !self.presses.is_empty()
            && enough(&self.ahead(matches!(watch.event, Event::Touches | Event::Presses)))
        {
            self.log.flight.stop = Stop::Enough { time_s: self.time.now() };
            return Ok(false);
        }
        Ok(self.happens(&phase, dt, point, watch))
    }

    /// Ends the flight at the last parting, after which nothing happens.
    fn bounced_clear(&mut self) {
        let parted = self.presses.iter().fold(0.0_f64, |last, press| last.max(press.until_s));
        let begun = self.phases.partition_point(|(from, _)| *from <= parted);
        self.phases.truncate(begun.max(1));
        if let Some((from, phase)) = self.phases.last() {
            self.pose = phase.start.flown(parted - from);
        }
        self.log.flight.stop = Stop::BouncedClear { time_s: parted };
    }

    fn finish(mut self) -> crate::Motion<N, P> {
        let energy_error = self.misfit / self.opened;
        let later_m_s = match self.log.flight.stop {
            Stop::AtRest { shock_bound_m_s, .. } => shock_bound_m_s,
            Stop::BouncedClear { .. } => 0.0,
            Stop::TurnedOver { .. } => f64::INFINITY,
            _ => self.ahead(false).most_m_s,
        };
        let ((_, velocity), [_, spin]) = (self.pose.points(), self.pose.angles());
        for (press, strike) in self.presses.iter().zip(&mut self.log.flight.strikes) {
            if press.until_s == f64::INFINITY {
                (strike.velocity_m_s, strike.spin_rad_s) = (velocity, spin);
            }
        }
        let Self { log, presses, phases, pose: end, unrested, resting, precision, .. } = self;
        let Flight { strikes, pivots, stop } = log.flight;
        let course = Course::Contacts(Phases {
            precision,
            contacts: *self.contacts,
            end_s: stop.time_s(),
            rests: matches!(stop, Stop::AtRest { .. }),
            list: phases,
            last: unrested.unwrap_or(end),
            end,
            resting,
        });
        let model = Model::Contacts(self.contacts[0]);
        crate::Motion { strikes, pivots, presses, stop, later_m_s, energy_error, model, course }
    }

    fn next(&mut self) -> Lasting<P, N> {
        let holds = self.holds();
        if holds.iter().any(|hold| !matches!(hold, Hold::No)) {
            self.lay_down();
            self.stop_lying();
            return self.pressed(self.holds());
        }
        let phase = Phase::free(self.pose);
        let upright = self.pose.upright();
        let event = self.first_event(&phase, upright);
        let dt = event.map_or(upright, |(t, _)| t);
        Lasting { phase, dt, event: event.and_then(|(_, event)| event) }
    }

    /// Returns a phase with forces, its lever arms and length by the wanted precision.
    fn pressed(&mut self, holds: [Hold; N]) -> Lasting<P, N> {
        let delay = self.contacts[0].delay_s();
        let arms = self.pose.arms();
        // This is the relative change of the lever arms by a turn.
        let steep = (0..N)
            .filter(|&i| self.touches[i].is_pressing())
            .fold(0.1_f64, |most, i| most.max(self.pose.steepness(&arms, i)));
        let pressing = (0..N).filter(|&i| self.touches[i].is_pressing());
        let bend = pressing.fold(0.0_f64, |most, i| most.max(self.pose.bend(&arms, i)));
        let of_pressing = |of: &dyn Fn(&Contact) -> f64| {
            let pressing = (0..N).filter(|&i| self.touches[i].is_pressing());
            pressing.fold(f64::INFINITY, |least, i| least.min(of(&self.contacts[i])))
        };
        let budget = self.precision.min(of_pressing(&Contact::springs_back)) * self.fastest;
        // This is the shortest contact time of those that press.
        let contact_s = of_pressing(&Contact::time_s);
        let mut longest = self.stride;
        let mut halfway = self.pose.flown(0.5 * longest.min(0.5 * contact_s));
        let ([_, spin], reach) = (self.pose.angles(), self.extent.reach);
        let (mut passes, mut cuts) = (0, 0);
        // These are whether the lever arms are the present ones, and the length of the phase by the last lever arms.
        let (mut early, mut before) = (false, f64::INFINITY);
        loop {
            let phase = Phase::new(self.pose, &halfway, holds, delay);
            let slowest = (reach / self.pose.gravity()).sqrt().min(spin.abs().recip());
            let swing = if phase.is_still() && slowest < f64::INFINITY { 0.1 * slowest } else { 0.0 };
            longest = longest.min(swing.max(LONG * contact_s));
            let event = self.first_event(&phase, longest);
            let dt = event.map_or(longest, |(t, _)| t);
            let Mean { pose, turn, pushed, off: gap, end } = self.mean(&phase, dt);
            if let Some(past) = self.lets_go(&phase, &end).filter(|_| cuts < CUTS) {
                cuts += 1;
                longest = past * dt;
                (halfway, early) = (self.mean(&phase, longest).pose, false);
                continue;
            }
            // An event that later lever arms bring about now is decided by the present ones, or a load and a rest take
            // turns for ever.
            if !early && dt < AT_ONCE * contact_s && passes < PASSES {
                passes += 1;
                longest = longest.min(0.5 * before);
                (halfway, early) = (self.pose, true);
                continue;
            }
            let gap = gap.max(self.pressed_off(&phase, dt, event, &end));
            let wrong = turn * steep * (pushed + turn * steep * reach * pose.angles()[1].abs());
            let over = (wrong / KEPT + gap) / budget;
            let rough = if phase.is_still() { 0.0 } else { turn * bend / (SMOOTH * self.precision.max(SMOOTHEST)) };
            // The first grows with the square of the length, the second with the length.
            let shorter = over.sqrt().max(rough).recip();
            if (over > 1.5 || rough > 1.2) && cuts < CUTS {
                cuts += 1;
                longest = dt * shorter.clamp(0.1, 0.8);
                (halfway, early) = (self.mean(&phase, longest).pose, false);
                continue;
            }
            passes += 1;
            let off = pose.turned_from(&halfway) * steep * pushed;
            if off > 0.1 * budget && passes < PASSES {
                (halfway, early, before) = (pose, false, dt);
                continue;
            }
            let cut = dt > 0.0 && (event.is_none() || cuts > 0);
            self.stride = if cut { dt * shorter.min(GROWTH) } else { f64::INFINITY };
            return Lasting { phase, dt, event: event.and_then(|(_, event)| event) };
        }
    }

    /// Returns the distance of a dashpot that presses again from the begin of its line, as the equivalent velocity of
    /// its vibration: the ground would pull, or push at once.
    fn pressed_off(&self, phase: &Phase<P, N>, dt: f64, event: Option<(f64, Option<(usize, Watch)>)>, end: &P) -> f64 {
        let Some((_, Some((i, watch)))) = event else { return 0.0 };
        if watch.event != Event::Presses || self.leave_dents() {
            return 0.0;
        }
        let rate = (self.touches[i].stiffness * self.pose.coupled(i, i)).sqrt();
        rate * ((end.points().0[i] - phase.watched(i, dt)[0]).abs() - self.margins.height).max(0.0)
    }

    /// Returns the share of a phase after which turning lifts a point that alone presses and lies, and a little more.
    fn lets_go(&self, phase: &Phase<P, N>, end: &P) -> Option<f64> {
        let l = phase.lies.iter().position(|lies| *lies).filter(|_| phase.modes().is_empty())?;
        let (now, then) = (self.pose.fall(l), end.fall(l));
        let share = 1.02 * now / (now - then);
        (now > 0.0 && then < 0.0 && share < 0.9).then_some(share)
    }

    /// Returns the mean pose of a phase of length dt, weighed by its forces by Simpson's rule; the turn of the body,
    /// and the push on a point that presses.
    fn mean(&self, phase: &Phase<P, N>, dt: f64) -> Mean<P> {
        let at = |t: f64, motions: &[Motion; N]| {
            let pushes = phase.pushes(t, motions);
            (phase.forces(motions).iter().sum::<f64>(), phase.pose(t, &pushes), pushes)
        };
        let [first, half, last] = [0.0, 0.5 * dt, dt].map(|t| phase.motions(t));
        let (begins, (middles, middle, _), (ends, end, pushes)) =
            (phase.forces(&first).iter().sum::<f64>(), at(0.5 * dt, &half), at(dt, &last));
        let sum = begins + 4.0 * middles + ends;
        let weigh = |[a, b, c]: [f64; 3]| (begins * a + 4.0 * middles * b + ends * c) / sum;
        let pose = if sum > 0.0 { P::mean(&self.pose, &middle, &end, weigh) } else { middle };
        let turn = end.turned_from(&self.pose).max(middle.turned_from(&self.pose));
        let off = phase.mismatch(dt, &last, &end, self.margins.height);
        Mean { pose, turn, pushed: phase.pushed(&pushes), off, end }
    }

    /// Returns the first event of a phase before `cap`, or the time until which none is proven to happen.
    fn first_event(&self, phase: &Phase<P, N>, cap: f64) -> Option<(f64, Option<(usize, Watch)>)> {
        let modes = phase.mode_bounds();
        let mut found: Option<(f64, Option<(usize, Watch)>)> = None;
        // Points that press come first: their phases are short.
        let pressing = |i: &usize| phase.lines[*i].is_some();
        for i in (0..N).filter(pressing).chain((0..N).filter(|i| !pressing(i))) {
            for watch in self.touches[i].watches(&self.contacts[i], &self.margins).into_iter().flatten() {
                let cap = found.map_or(cap, |(t, _)| t);
                match self.when(phase, i, &watch, &modes, cap) {
                    Zero::Never => {}
                    Zero::At(t) => found = Some((t, Some((i, watch)))),
                    Zero::Beyond(t) => found = Some((t, None)),
                }
            }
        }
        found
    }

    /// Returns the value below which the watch on a lying point is no rounding at the begin of a phase: the last event
    /// has changed the forces that hold it, and it bears more or less than it can.
    fn overcome(&self, phase: &Phase<P, N>, i: usize) -> f64 {
        if phase.lies[i] { -BEARS * self.touches[i].limit(&self.contacts[i]) } else { f64::NEG_INFINITY }
    }

    /// Returns the time at which the watch on a point falls to zero, if before `cap`.
    fn when(&self, phase: &Phase<P, N>, i: usize, watch: &Watch, modes: &[[f64; 4]; N], cap: f64) -> Zero {
        if let Some(known) = phase.falls(i, watch) {
            return known.filter(|t| *t < cap).map_or(Zero::Never, Zero::At);
        }
        if phase.swing(i, modes).is_some_and(|swing| watch.never(swing)) {
            return Zero::Never;
        }
        let free = phase.is_free();
        let bounds = if free {
            self.pose.flying_bounds(i)
        } else if phase.lies[i] {
            phase.reaction_bounds(i, modes)
        } else {
            phase.bounds(i, modes)
        };
        let [second, third] = watch.bounds(bounds);
        if let Some([value, slope]) = phase.begins(i).and_then(|at| watch.begins(at))
            && value > 0.0
            && safe_step(value, slope, second) >= cap
        {
            return Zero::Never;
        }
        let clear = |t: f64| if free && watch.event == Event::Touches { self.pose.clear(i, t) } else { 0.0 };
        first(cap, [second, third], self.overcome(phase, i), |t| watch.at(phase.watched(i, t)), clear)
    }

    /// Moves the pose to the end of a phase, and books the impulses of the ground.
    fn advance(&mut self, phase: &Phase<P, N>, dt: f64) -> Result<(), Refused> {
        if phase.is_free() {
            self.pose = self.pose.flown(dt);
            return Ok(());
        }
        let motions = phase.motions(dt);
        let pushes = phase.pushes(dt, &motions);
        let held = phase.start.energy() + phase.springs(&phase.start.points().0);
        self.pose = phase.pose(dt, &pushes);
        let energy = self.pose.energy();
        if !energy.is_finite() {
            return Err(Error::Energy { share: f64::INFINITY }.into());
        }
        if let Some(depth) = self.sinks_too_deep(phase, dt) {
            return Err(Refused::Deep(depth));
        }
        let change = (energy + phase.springs(&self.pose.points().0) + phase.taken(&motions) - held).abs();
        if change > ENERGY * self.opened {
            return Err(Error::Energy { share: change / self.opened }.into());
        }
        self.misfit += change;
        for i in 0..N {
            if self.touches[i].is_pressing() {
                self.book(i, phase.jumps(i, pushes.impulse[i]));
            }
        }
        if phase.lies.contains(&true) {
            let (pose, impulses) = phase.held(&self.pose);
            self.pose = pose;
            self.pushed(&phase.lies, impulses);
        }
        Ok(())
    }

    /// Returns the point that is deeper below the ground than allowed at the end of a phase, or on the way there. A point with a dent is
    /// at its lowest as a phase ends, or has been there before.
    fn sinks_too_deep(&self, phase: &Phase<P, N>, dt: f64) -> Option<Depth> {
        let height = self.pose.points().0;
        let pressing = (0..N).filter(|&i| self.touches[i].is_pressing());
        let depth = |point: usize| {
            let lowest =
                if self.leave_dents() { height[point] } else { height[point].min(self.lowest(phase, point, dt)) };
            Depth { point, over_allowed: -lowest / self.deepest }
        };
        let deepest = pressing.map(depth).max_by(|one, other| one.over_allowed.total_cmp(&other.over_allowed));
        deepest.filter(|depth| depth.over_allowed > 1.0)
    }

    /// Returns the lowest height of a point in a phase where that may be too deep, else that at its begin.
    fn lowest(&self, phase: &Phase<P, N>, i: usize, dt: f64) -> f64 {
        let Some([height, velocity]) = phase.begins(i) else { return phase.start.points().0[i] };
        let [curved, ..] = phase.bounds(i, &phase.mode_bounds());
        if height - dt * (velocity.abs() + 0.5 * curved * dt) > -self.deepest {
            return height;
        }
        let at = |t: f64| phase.watched(i, t)[0];
        let part = dt / f64::from(PARTS);
        let lower = |t: f64, other: f64| if at(other) < at(t) { other } else { t };
        let near = (1..=PARTS).map(|k| f64::from(k) * part).fold(0.0, lower);
        let [mut from, mut until] = [(near - part).max(0.0), (near + part).min(dt)];
        for _ in 0..NARROWED {
            let [one, other] = [from + (until - from) / 3.0, until - (until - from) / 3.0];
            if at(one) < at(other) { until = other } else { from = one }
        }
        at(0.5 * (from + until)).min(at(near))
    }

    /// Books the effect of the ground at point i with its strike.
    pub(super) fn book(&mut self, i: usize, jumps: [f64; N]) {
        let strike = &mut self.log.flight.strikes[self.touches[i].strike];
        for (sum, jump) in strike.delta_v_m_s.iter_mut().zip(jumps) {
            *sum += jump;
        }
    }

    /// Applies an event, and all others of its kind that come with it by symmetry, and returns whether the flight goes
    /// on.
    fn happens(&mut self, phase: &Phase<P, N>, dt: f64, point: usize, watch: Watch) -> bool {
        let [value, ..] = watch.at(phase.watched(point, dt));
        let mut due = [None; N];
        for (i, due) in due.iter_mut().enumerate() {
            let comes_too = |other: &Watch| {
                let [v, slope, _] = other.at(phase.watched(i, dt));
                let falls = slope <= 0.0 || dt == 0.0 && v < self.overcome(phase, i);
                other.event == watch.event && v <= value && falls
            };
            let mut watches = self.touches[i].watches(&self.contacts[i], &self.margins).into_iter().flatten();
            *due = if i == point { Some(watch.event) } else { watches.find(comes_too).map(|w| w.event) };
        }
        (0..N).all(|i| due[i].is_none_or(|event| self.apply(i, event)))
    }

    pub(super) fn apply(&mut self, i: usize, event: Event) -> bool {
        let (height, velocity) = self.pose.points();
        let (h, v) = (height[i], velocity[i]);
        match event {
            Event::Touches => return self.touch(i, h, v),
            Event::Crests => self.touches[i].crest(h, &self.contacts[i]),
            Event::Parts => {
                self.touches[i].part(h, v, &self.contacts[i]);
                let strike = self.touches[i].strike;
                self.presses[strike].until_s = self.time.now();
                let strike = &mut self.log.flight.strikes[strike];
                (strike.velocity_m_s, strike.spin_rad_s) = (velocity, self.pose.angles()[1]);
                self.log.largest_m_s =
                    strike.delta_v_m_s.iter().fold(self.log.largest_m_s, |most, dv| most.max(dv.abs()));
            }
            Event::Reloads => self.touches[i].reload(h),
            Event::Presses => {
                let dented = self.touches[i];
                let goes_on = self.touch(i, h, v);
                if !self.leave_dents() {
                    // It presses again from the ground, as stiff as before.
                    let strike = self.touches[i].strike;
                    self.touches[i] = Touch { state: State::Loading, strike, ..dented };
                }
                return goes_on;
            }
            Event::Clears => self.touches[i] = Touch { strike: self.touches[i].strike, ..Touch::away() },
        }
        true
    }

    /// Begins a new press, from the given height, and returns whether the flight goes on.
    fn touch(&mut self, i: usize, height: f64, velocity: f64) -> bool {
        self.rouse_others(i);
        // A grazing touch has no approach, whatever the rounding.
        let approach = velocity.min(0.0);
        let (h, v) = self.pose.points();
        self.pose = self.pose.unwound();
        let [tilt, spin] = self.pose.angles();
        let after = After { ends: Heights { h, v }, tilt, spin };
        let strike = self.log.flight.strikes.len();
        if !self.log.strike(i, self.time.now(), approach, [0.0; N], &after, &mut |_| false) {
            if let Stop::ImpactLimit { time_s } = &mut self.log.flight.stop {
                *time_s = self.time.now();
            }
            return false;
        }
        self.fastest = self.fastest.max(-approach);
        self.margins.velocity = MARGIN * self.fastest;
        let stiffness = self.stiffness(&self.pose.arms(), i);
        let [ground, crest, zero] = [height; 3];
        self.touches[i] = Touch { state: State::Loading, stiffness, ground, crest, zero, strike };
        self.presses.push(Press { from_s: self.time.now(), until_s: f64::INFINITY });
        true
    }

    /// Returns the stiffness of a lone contact of a point at this angle as it loads.
    pub(super) fn stiffness(&self, arms: &P::Arms, i: usize) -> f64 {
        self.contacts[i].frequency_rad_s().powi(2) / self.pose.coupling(arms, i, i)
    }

    /// Returns the states of the contacts of all points.
    fn holds(&self) -> [Hold; N] {
        std::array::from_fn(|i| self.touches[i].hold(&self.contacts[i]))
    }

    /// Returns whether the law takes energy by dents; it is one for all points.
    pub(super) fn leave_dents(&self) -> bool {
        self.contacts[0].law().leaves_a_dent()
    }
}

struct Mean<P> {
    pose: P,
    turn: f64,
    pushed: f64,
    off: f64,
    end: P,
}

/// Returns the first time before `cap` at which the watched value falls to zero; a begin at zero, or not far below,
/// with a rise does not count.
fn first(
    cap: f64,
    [second, third]: [f64; 2],
    below: f64,
    at: impl Fn(f64) -> [f64; 3],
    clear: impl Fn(f64) -> f64,
) -> Zero {
    let [value, slope, bend] = at(0.0);
    let begin = if value > 0.0 {
        0.0
    } else if slope > 0.0 && value >= below {
        slope / second
    } else if slope == 0.0 && bend > 0.0 && value >= below {
        bend / third
    } else {
        return if cap > 0.0 { Zero::At(0.0) } else { Zero::Never };
    };
    if begin.is_nan() || begin >= cap {
        return Zero::Never;
    }
    first_zero(begin, cap, at, |t, now| far_step(now, second, third).max(clear(t)))
}

#[cfg(test)]
mod tests;
