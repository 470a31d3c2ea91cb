//! The first strikes of a drop in all lanes: what the forecasts for every component of one drop share.

use clatter::flight::Scene;

use super::STRIKES;
use super::both::Both;
use super::lane::{Ends, Lane, Next};
use super::pulse::Pulse;
use super::swing::{Swing, Turn};

/// A strike of the lane with all physics, and the same one in the others.
#[derive(Debug, Clone, Copy)]
pub(super) struct Step {
    /// The end that strikes.
    pub(super) end: usize,
    /// Velocity shocks of both ends.
    pub(super) delta_v: [f64; 2],
    /// Time since the last one and shocks in the map, as parabolas and with real tilt; `None` once a lane had another strike.
    pub(super) own: [Option<(f64, [f64; 2])>; 3],
    /// Twice the energy that is left.
    pub(super) twice_energy: f64,
    /// Time until the next strike; `None` where nothing falls.
    pub(super) follows: Option<f64>,
    /// How long after that the other end would strike without it, and the velocity shocks of both ends then.
    pub(super) rival: (f64, [f64; 2]),
    /// The end that lies on the ground until then.
    pub(super) rests: Option<usize>,
    /// Of both contacts at once: for how many contact times.
    pub(super) together: Option<f64>,
    /// Over how large a share of a contact time the strikes of the map are spread then.
    pub(super) spread: f64,
    /// Whether the bar turns upright or over until then.
    pub(super) tumbles: bool,
}

/// A strike of the map: the end, the time since the last one, and velocity shocks of both ends.
type MapStrike = (usize, f64, [f64; 2]);

/// Strikes of the map at most that are taken as one.
const MOST_AT_ONCE: usize = 32;

/// Frequencies of a part whose turns are kept: those of a grid over its range.
const FREQUENCIES: usize = 3;

/// Strikes as far as they were asked for.
#[derive(Debug, Clone)]
pub(crate) struct Trail {
    ends: Ends,
    pub(super) pulse: Pulse,
    full: Lane,
    contact_s: f64,
    /// Twice the energy after the strikes so far.
    energy: f64,
    map: Lane,
    /// Strikes of the map that belong to those followed.
    mapped: usize,
    others: [Lane; 2],
    next: Option<Next>,
    alive: [bool; 3],
    /// Twice the energy at the first touch.
    pub(super) twice_energy: f64,
    steps: Vec<Step>,
    of_map: Vec<MapStrike>,
    /// How a part turns after each strike, for the frequencies asked last: damping ratio, phase, turn.
    turns: Vec<[Option<(f64, f64, Turn)>; FREQUENCIES]>,
}

impl Trail {
    /// Nothing followed yet.
    pub(crate) fn new(scene: &Scene, contact_time_s: Option<f64>) -> Self {
        let ends = Ends::new(scene, 0.0);
        let pulse = Pulse::new(ends.e);
        let g = scene.gravity_m_s2();
        let start = Lane::start(scene, 1.0);
        let tilted = Lane::start(scene, libm::cos(scene.tilt_rad())).with_gravity(g).with_tilt();
        let full = tilted.with_contact(&pulse, contact_time_s.unwrap_or(0.0));
        Self {
            ends,
            pulse,
            full,
            contact_s: contact_time_s.unwrap_or(0.0),
            map: start,
            mapped: 0,
            energy: full.twice_energy(&ends),
            others: [start.with_gravity(g), tilted],
            next: Some(Next::FIRST),
            alive: [true; 3],
            twice_energy: full.twice_energy(&ends),
            steps: Vec::with_capacity(STRIKES),
            of_map: Vec::with_capacity(STRIKES),
            turns: Vec::with_capacity(STRIKES),
        }
    }

    /// With all strikes that a forecast looks at, to be shared.
    pub(crate) fn whole(mut self) -> Self {
        let mut n = 0;
        while n < STRIKES && self.step(n).is_some() {
            n += 1;
        }
        self
    }

    /// Strike n, from 0; those before it exist.
    pub(super) fn step(&mut self, n: usize) -> Option<Step> {
        if n >= self.steps.len() {
            self.advance();
        }
        self.steps.get(n).copied()
    }

    /// What the phase θ after strike n does to a part: worked out once for all of its places.
    pub(super) fn turn(&mut self, n: usize, swing: &Swing, theta: f64) -> Turn {
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

    fn advance(&mut self) {
        let Some(next) = self.next else { return };
        let n = self.steps.len();
        let ends = self.ends;
        let pressed = self.full.is_pressed_by(&ends, &next, self.contact_s).then(|| {
            let q = (ends.ratio(0, 1.0) * ends.ratio(1, 1.0)).sqrt();
            let impacts = Both::of_impacts(q, ends.e).scaled(&ends, next.end);
            let contacts =
                if self.contact_s > 0.0 { Both::of_contacts(q, ends.e).scaled(&ends, next.end) } else { impacts };
            [impacts, contacts]
        });
        let delta_v = match &pressed {
            Some([_, contacts]) => self.full.strike_lying(&ends, &next, contacts, self.contact_s),
            None => self.full.strike(&ends, &next),
        };
        // Impacts take what they take; turning, as the lane has it, may lose some.
        self.energy = if pressed.is_some() {
            self.full.twice_energy(&ends)
        } else {
            self.energy - self.full.twice_lost(&ends, next.end, delta_v[next.end])
        };
        let (mut own, mut spread) = ([None; 3], 0.0);
        if self.alive[0]
            && let Some((end, after, delta_v)) = self.of_map(self.mapped)
            && end == next.end
        {
            self.mapped += 1;
            let (mut sum, mut last, most) = (delta_v, 0.0, self.mapped + MOST_AT_ONCE);
            while pressed.is_some()
                && self.mapped < most
                && let Some((_, after, more)) = self.of_map(self.mapped)
                && last + after < self.contact_s
            {
                last += after;
                self.mapped += 1;
                sum = [sum[0] + more[0], sum[1] + more[1]];
                spread = last / self.contact_s;
            }
            own[0] = Some((after, sum));
        }
        let ends = &self.ends;
        for (k, lane) in self.others.iter_mut().enumerate() {
            let strike = if n == 0 { Some(Next::FIRST) } else { lane.next(ends) };
            if let Some(strike) = strike.filter(|strike| self.alive[k + 1] && strike.end == next.end) {
                let delta_v = match &pressed {
                    Some([impacts, _]) if lane.lying().is_some() => lane.strike_lying(ends, &strike, impacts, 0.0),
                    _ => lane.strike(ends, &strike),
                };
                own[k + 1] = Some((strike.after, delta_v));
                if let Some(end) = self.full.lying()
                    && lane.lying().is_none()
                {
                    lane.lie(ends, end);
                }
            }
        }
        self.alive = [own[0].is_some(), own[1].is_some(), own[2].is_some()];
        self.next = self.full.next(ends);
        let rival = self.next.as_ref().map_or((f64::INFINITY, [0.0; 2]), |next| {
            let ([time, speed], other) = (next.rival, 1 - next.end);
            let jump = (1.0 + ends.e) * speed;
            let mut delta_v = [-ends.ratio(other, 1.0) * jump; 2];
            delta_v[other] = jump;
            (time - next.after, delta_v)
        });
        self.steps.push(Step {
            end: next.end,
            delta_v,
            own,
            twice_energy: if self.next.is_none() && n > 0 {
                self.others
                    .iter()
                    .zip(&self.alive[1..])
                    .filter(|(_, alive)| **alive)
                    .fold(self.full.twice_energy(ends), |m, (lane, _)| m.max(lane.twice_energy(ends)))
            } else {
                self.full.twice_energy_until(ends, self.next.as_ref()).max(self.energy)
            },
            follows: self.next.map(|next| next.after),
            rival,
            rests: self.full.lying(),
            together: pressed.map(|[_, contacts]| contacts.lasts),
            spread,
            tumbles: self.next.is_some_and(|next| next.tumbles),
        });
    }

    /// Strike k, from 0, of the map; those before it exist.
    pub(super) fn of_map(&mut self, k: usize) -> Option<MapStrike> {
        if k >= self.of_map.len() {
            let next = if k == 0 { Next::FIRST } else { self.map.next(&self.ends)? };
            self.of_map.push((next.end, next.after, self.map.strike(&self.ends, &next)));
        }
        self.of_map.get(k).copied()
    }
}
