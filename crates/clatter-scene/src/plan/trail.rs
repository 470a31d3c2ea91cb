//! The first strikes of a drop in all lanes: what the forecasts for every component of one drop share.

use clatter::flight::Scene;

use super::STRIKES;
use super::both::Both;
use super::bounds::largest_pile;
use super::coarse::{Alike, Coarse, Landing};
use super::coupling::{Coupled, Coupling};
use super::ends::Ends;
use super::floats::greater;
use super::lane::{Lane, MapLane, Next, Own};
use super::pulse::Pulse;
use super::swing::{Swing, Turn};

/// A strike of the lane with all physics.
#[derive(Debug, Clone, Copy)]
pub(super) struct Step {
    pub(super) landing: Landing,
    /// Velocity shocks of both ends.
    pub(super) delta_v: (f64, f64),
    /// The same one with real tilt; `None` once that had another strike.
    pub(super) tilted: Option<Own>,
    /// Twice the energy that is left.
    pub(super) twice_energy: f64,
    /// Time until the next strike; `None` where nothing falls.
    pub(super) follows: Option<f64>,
    /// How long after that the other end would strike without it, and the velocity shocks of both ends then.
    pub(super) rival: Own,
    /// What it and the contacts before do to each other.
    pub(super) coupled: Coupled,
    /// Share of the speed that both ends together rebound with, where contacts overlap until the next strike; 0
    /// elsewhere.
    pub(super) rebound: f64,
    /// Of both contacts at once: for how many contact times.
    pub(super) together: Option<f64>,
    /// Whether the bar turns upright or over until then.
    pub(super) tumbles: bool,
}

/// Frequencies of a part whose turns are kept: those of a grid over its range.
const FREQUENCIES: usize = 3;

/// Where the strikes come from: followed now, or kept.
pub(super) trait Strikes {
    /// Strike n, from 0; asked for in order.
    fn step(&mut self, n: usize) -> Option<&Step>;
    /// The same strike in the coarse lanes; asked for in order, and after it.
    fn coarse(&mut self, n: usize, landing: &Landing) -> Alike;
    /// The map from the first touch on, once a strike of it was asked for.
    fn map(&self) -> Option<&MapLane> {
        self.course().coarse.as_ref().map(Coarse::map)
    }
    /// A part of this damping ratio, asked for its acceleration or its displacement.
    fn swing(&mut self, zeta: f64, acceleration: bool) -> Swing;
    /// What the phase θ after strike n does to a part.
    fn turn(&mut self, n: usize, swing: &Swing, theta: f64) -> Turn;
    /// The drop itself.
    fn course(&self) -> &Course;
}

/// All lanes after the strikes so far.
#[derive(Debug, Clone)]
pub(crate) struct Course {
    ends: Ends,
    /// Height of the end that lands second, at the first touch.
    pub(super) gap_m: f64,
    pub(super) pulse: Pulse,
    pub(super) contact_s: f64,
    /// Share of the time since the first strike by which strikes are mistimed.
    pub(super) blur: f64,
    /// How many times the largest later shock the speeds of all later ones allow.
    pub(super) pile: f64,
    /// The time since the first strike.
    last_s: f64,
    coupling: Coupling,
    full: Lane<true>,
    /// Twice the energy after the strikes so far.
    energy: f64,
    tilted: Lane<true>,
    /// Whether it has had the same strikes.
    alive: bool,
    gravity: f64,
    /// Speed, spin and height gap at the first touch, and the coarse lanes as far as they were asked for.
    touch: (f64, f64, f64),
    coarse: Option<Coarse>,
    /// The strike to come, if something falls.
    next: Next,
    falls: bool,
    /// Of an end that lies while the other lands: impacts, contacts. Every one of the drop moves alike.
    both: Option<[Both; 2]>,
    /// Twice the energy at the first touch.
    pub(super) twice_energy: f64,
    touched: bool,
    /// The last strike; `None` where nothing falls any more.
    step: Option<Step>,
}

impl Course {
    /// Nothing followed yet.
    #[inline]
    pub(super) fn new(ends: Ends, scene: &Scene, contact_time_s: Option<f64>) -> Self {
        let (pulse, contact_s, g) = (Pulse::new(ends.e), contact_time_s.unwrap_or(0.0), scene.gravity_m_s2());
        let (speed, spin, gap_m) = (scene.speed_m_s(), scene.spin_rad_s(), scene.height_gap_m());
        let flat_spin = if spin == 0.0 { 0.0 } else { spin * libm::cos(scene.tilt_rad()) };
        let tilted = Lane::start(&ends, (speed, flat_spin, gap_m), g);
        let full = tilted.with_contact(&pulse, contact_s);
        let energy = full.twice_energy(&ends);
        Self {
            ends,
            gap_m,
            pulse,
            contact_s,
            // Fitted: the mean bend of a large tilt.
            blur: 0.25 * scene.tilt_rad() * scene.tilt_rad(),
            pile: largest_pile(&ends),
            last_s: 0.0,
            coupling: Coupling::new(&ends, pulse, contact_s),
            full,
            energy,
            tilted,
            alive: true,
            gravity: g,
            touch: (speed, spin, gap_m),
            coarse: None,
            next: Next::FIRST,
            falls: true,
            both: None,
            twice_energy: energy,
            touched: false,
            step: None,
        }
    }

    /// Both contacts of a bar whose end `landed` lands: as impacts, and as contacts.
    #[cold]
    fn both(&mut self, landed: usize) -> [Both; 2] {
        let (ends, contact_s) = (&self.ends, self.contact_s);
        let both = self.both.get_or_insert_with(|| {
            let q = (ends.flat[0] * ends.flat[1]).sqrt();
            let impacts = Both::of_impacts(q, ends.e);
            [impacts, if contact_s > 0.0 { Both::of_contacts(q, ends.e) } else { impacts }]
        });
        let [impacts, contacts] = both;
        [impacts.scaled(ends, landed), contacts.scaled(ends, landed)]
    }

    /// The next strike.
    #[inline]
    fn advance(&mut self) {
        if !self.falls {
            self.step = None;
            return;
        }
        let next = self.next;
        let first = !std::mem::replace(&mut self.touched, true);
        let pressed =
            if self.full.is_pressed_by(&self.ends, &next, self.contact_s) { Some(self.both(next.end)) } else { None };
        let ends = &self.ends;
        let delta_v = match &pressed {
            Some([_, contacts]) => self.full.strike_lying(ends, &next, contacts, self.contact_s),
            None => self.full.strike(ends, &next),
        };
        self.last_s += next.after;
        let times = [next.after, self.blur * self.last_s];
        let coupled = self.coupling.strike(next.end, delta_v, times, pressed.is_some());
        // Impacts take what they take; turning, as the lane has it, may lose some.
        self.energy = if pressed.is_some() {
            self.full.twice_energy(ends)
        } else {
            self.energy - self.full.twice_lost(ends, next.end, if next.end == 0 { delta_v.0 } else { delta_v.1 })
        };
        let (impacts, rests) = (pressed.as_ref().map(|[impacts, _]| impacts), self.full.lying());
        let tilted =
            if self.alive { self.tilted.along(ends, (next.end, next.after), first, impacts, rests) } else { None };
        self.alive = tilted.is_some();
        self.falls = self.full.next(ends, &mut self.next);
        let mut twice_energy = self.full.twice_energy(ends);
        let (mut rival, mut follows, mut tumbles) = ((f64::INFINITY, (0.0, 0.0)), None, false);
        if self.falls {
            let next = &self.next;
            let ([time, speed], other) = (next.rival, 1 - next.end);
            let jump = (1.0 + ends.e) * speed;
            let back = -ends.flat[other] * jump;
            rival = (time - next.after, if other == 0 { (jump, back) } else { (back, jump) });
            (follows, tumbles) = (Some(next.after), next.tumbles);
        }
        if self.falls || first {
            twice_energy = greater(self.energy, twice_energy);
        } else if self.alive {
            twice_energy = twice_energy.max(self.tilted.twice_energy(ends));
        }
        let overlaps = follows.is_some_and(|gap| gap < self.contact_s);
        self.step = Some(Step {
            landing: Landing { end: next.end, presses: pressed.is_some(), rests },
            delta_v,
            tilted,
            twice_energy,
            follows,
            rival,
            coupled,
            rebound: if overlaps { self.coupling.rebound() } else { 0.0 },
            together: pressed.map(|[_, contacts]| contacts.lasts),
            tumbles,
        });
    }
}

impl Course {
    /// Twice the energy that parabolas have left after the last strike that was asked of them, if they had the same.
    pub(super) fn left_as_parabolas(&self) -> Option<f64> {
        self.coarse.as_ref()?.twice_energy(&self.ends)
    }
    /// The strike that landed so, in the coarse lanes.
    fn along(&mut self, landing: &Landing) -> Alike {
        let impacts = if landing.presses { Some(self.both(landing.end)) } else { None };
        let coarse = self.coarse.get_or_insert_with(|| Coarse::start(&self.ends, self.touch, self.gravity));
        coarse.along(&self.ends, landing, impacts.as_ref().map(|[impacts, _]| impacts), self.contact_s)
    }
}

impl Strikes for Course {
    #[inline]
    fn step(&mut self, _: usize) -> Option<&Step> {
        self.advance();
        self.step.as_ref()
    }
    fn coarse(&mut self, _: usize, landing: &Landing) -> Alike {
        self.along(landing)
    }
    fn swing(&mut self, zeta: f64, acceleration: bool) -> Swing {
        Swing::new(zeta, acceleration)
    }
    #[inline]
    fn turn(&mut self, _: usize, swing: &Swing, theta: f64) -> Turn {
        swing.turn(theta)
    }
    fn course(&self) -> &Course {
        self
    }
}

/// Strikes as far as they were asked for, kept for all components of a drop.
#[derive(Debug, Clone)]
pub(crate) struct Trail {
    course: Course,
    steps: Vec<Step>,
    coarse: Vec<Alike>,
    /// The part asked last, and whether for its acceleration.
    swing: Option<(bool, Swing)>,
    /// How a part turns after each strike, for the frequencies asked last: damping ratio, phase, turn.
    turns: Vec<[Option<(f64, f64, Turn)>; FREQUENCIES]>,
}

impl Trail {
    /// Nothing followed yet.
    pub(crate) fn new(scene: &Scene, contact_time_s: Option<f64>) -> Self {
        Self {
            course: Course::new(Ends::new(scene, 0.0), scene, contact_time_s),
            steps: Vec::with_capacity(STRIKES),
            coarse: Vec::with_capacity(STRIKES),
            swing: None,
            turns: Vec::with_capacity(STRIKES),
        }
    }

    /// With all strikes that a forecast looks at, to be shared.
    pub(crate) fn whole(mut self) -> Self {
        let mut n = 0;
        while n < STRIKES
            && let Some(&Step { landing, .. }) = self.step(n)
        {
            self.coarse(n, &landing);
            n += 1;
        }
        self
    }
}

impl Strikes for Trail {
    fn step(&mut self, n: usize) -> Option<&Step> {
        if n >= self.steps.len() {
            self.course.advance();
            self.steps.extend(self.course.step);
        }
        self.steps.get(n)
    }
    fn coarse(&mut self, n: usize, landing: &Landing) -> Alike {
        if n == self.coarse.len() {
            self.coarse.push(self.course.along(landing));
        }
        self.coarse[n]
    }
    /// Worked out once for all places of a part, as its turns are.
    fn swing(&mut self, zeta: f64, acceleration: bool) -> Swing {
        match self.swing {
            Some((of, swing)) if of == acceleration && swing.zeta().to_bits() == zeta.to_bits() => swing,
            _ => self.swing.insert((acceleration, Swing::new(zeta, acceleration))).1,
        }
    }
    fn turn(&mut self, n: usize, swing: &Swing, theta: f64) -> Turn {
        if n >= self.turns.len() {
            self.turns.resize(n + 1, [None; FREQUENCIES]);
        }
        let kept = &mut self.turns[n];
        for (zeta, phase, turn) in kept.iter().flatten() {
            if zeta.to_bits() == swing.zeta().to_bits() && phase.to_bits() == theta.to_bits() {
                return *turn;
            }
        }
        let turn = swing.turn(theta);
        kept.rotate_right(1);
        kept[0] = Some((swing.zeta(), theta, turn));
        turn
    }
    fn course(&self) -> &Course {
        &self.course
    }
}
