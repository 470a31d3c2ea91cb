//! Instant impacts of an almost level plate under gravity: parabolas of its corners between strikes.
//!
//! M_ij is the acceleration of corner j by a force of 1 over the mass at corner i (see [`level`](crate::contact)). A
//! strike of corner i with velocity u is the impulse −(1 + e) u/M_ii. Between strikes every corner has a constant
//! acceleration: −g in flight, and where corners lie that of the weight and of the forces which hold them; a corner
//! that would have to be held down is let go. A corner that lies stays until another one strikes, as all forces are
//! constant.
//!
//! # One instant
//! Corners on the ground at one time strike in the order of a vanishing tilt along the diagonal: from heights 0, 1, 2
//! and 1 of a and the others, in any small unit, along straight lines.
//!
//! # Chatter
//! Alone, a corner that leaves with w strikes ever sooner and is still after 2w/(g (1 − e)). Its strikes and its fall have then added up
//! to −w, as the force of a corner that lies would have added up to after an impulse that stops it now: the effect on the others is the same. So
//! corners that are slower than [`SHARE`] of the largest shock, and still before the time has moved by an ulp, lie from then on.
//!
//! # Rounding
//! A corner that strikes is at 0, and one that is near it keeps its digits; the largest height and velocity are what the other three
//! corners make them, so that the plate stays plane.

use clatter::{Error as InputError, Excitation, Restitution, Section};

use super::Clock;
use crate::contact::{Level, Pose, Sample, solve};
use crate::flight::{After, Log, Model, SHARE, State, Stop, Strike, short};
use crate::motion::{Ahead, Course, PlateMotion};
use crate::plate::PlateScene;
use crate::roots::safe_step;

/// Heights that settle the order at one instant.
const TILTED: [f64; 4] = [0.0, 1.0, 2.0, 1.0];

/// A plate between its strikes, in stretches of constant acceleration.
#[derive(Debug, Clone)]
pub struct Falls {
    scene: PlateScene,
    list: Vec<Fall>,
}

/// One stretch: its first state, and its constant accelerations and forces.
#[derive(Debug, Clone, Copy)]
struct Fall {
    from_s: f64,
    state: State<4>,
    acceleration: [f64; 4],
    force: [f64; 4],
    /// Number of strikes before it.
    strikes: usize,
}

impl Fall {
    fn at(&self, t: f64) -> State<4> {
        let State { h, v } = self.state;
        State {
            h: corner(|i| (h[i] + t * (v[i] + 0.5 * self.acceleration[i] * t)).max(0.0)),
            v: corner(|i| v[i] + t * self.acceleration[i]),
        }
    }
}

fn corner<T>(of: impl FnMut(usize) -> T) -> [T; 4] {
    std::array::from_fn(of)
}

/// Returns whether each corner is on the ground without moving.
fn still(state: &State<4>) -> [bool; 4] {
    corner(|i| state.h[i] == 0.0 && state.v[i] == 0.0)
}

/// Replaces the largest of these values by that of the plane through the other three.
fn plane(of: &mut [f64; 4]) {
    let size = |i: usize| of[i].abs();
    let k = (1..4).fold(0, |most, i| if size(i) > size(most) { i } else { most });
    of[k] = of[(k + 1) % 4] + of[(k + 3) % 4] - of[(k + 2) % 4];
}

/// A plate in motion.
struct Run {
    scene: PlateScene,
    e: f64,
    /// M_ij.
    m: [[f64; 4]; 4],
    /// The largest M_ii.
    most: f64,
    state: State<4>,
    time: Clock,
}

impl Run {
    fn new(scene: &PlateScene, e: f64) -> Self {
        let level = Level::start(scene);
        let [x, y] = scene.gaps_m();
        Self {
            scene: *scene,
            e,
            m: corner(|i| corner(|j| level.coupling(&(), i, j))),
            most: level.extent().coupling,
            state: State { h: [0.0, x, x + y, y], v: scene.corner_velocities() },
            time: Clock::default(),
        }
    }

    /// Returns the forces that hold the lying corners, and the accelerations of all.
    fn held(&self) -> ([f64; 4], [f64; 4]) {
        let g = self.scene.gravity_m_s2();
        let mut lying = still(&self.state);
        let force = loop {
            let force = solve(|i, j| self.m[i][j], &lying, [g; 4]);
            let Some(up) = (0..4).find(|&i| lying[i] && force[i] < 0.0) else { break force };
            lying[up] = false;
        };
        let pushed = |k: usize| (0..4).map(|i| self.m[k][i] * force[i]).sum::<f64>() - g;
        let mut acceleration = corner(|k| if lying[k] { 0.0 } else { pushed(k) });
        plane(&mut acceleration);
        (force, acceleration)
    }

    /// Flies until the first corner lands, and returns whether one does.
    fn flown(&mut self, fall: &Fall) -> bool {
        let State { h, v } = self.state;
        let a = fall.acceleration;
        let lands = corner(|i| {
            // Where nothing pulls it down, there is no step.
            let t = if still(&self.state)[i] { f64::INFINITY } else { safe_step(h[i], v[i], -a[i]) };
            if t >= 0.0 { t } else { f64::INFINITY }
        });
        let t = lands.into_iter().fold(f64::INFINITY, f64::min);
        if t < f64::INFINITY {
            self.state = fall.at(t);
            for i in (0..4).filter(|&i| lands[i] <= t) {
                self.state.h[i] = 0.0;
                if h[i] == 0.0 {
                    // Its speed is that of leaving, however short the time.
                    self.state.v[i] = -v[i];
                }
            }
            self.plane();
            self.time.add(t);
        }
        t < f64::INFINITY
    }

    fn plane(&mut self) {
        let State { h, v } = &mut self.state;
        plane(h);
        plane(v);
        // A plate on two opposite corners is flat.
        let flat = h[0] + h[2] <= 0.0 || h[1] + h[3] <= 0.0;
        *h = if flat { [0.0; 4] } else { h.map(|h| h.max(0.0)) };
    }

    /// Applies a strike, and returns the velocity changes of all corners.
    fn strike(&mut self, i: usize) -> [f64; 4] {
        let u = self.state.v[i];
        let jump = -(1.0 + self.e) * u;
        let delta_v = corner(|k| if k == i { jump } else { self.m[k][i] / self.m[i][i] * jump });
        self.state.v = corner(|k| self.state.v[k] + delta_v[k]);
        self.state.v[i] = -self.e * u;
        self.plane();
        delta_v
    }

    /// Ends the motion where no shock counts any more, or lays down corners whose shocks do not count.
    fn settled(&mut self, i: usize, log: &mut Log<4>) -> bool {
        let (g, now, counts) = (self.scene.gravity_m_s2(), self.time.now(), SHARE * log.largest_m_s);
        let left = (1.0 + self.e) * self.fastest(&self.state);
        if left <= counts {
            log.at_rest(now, f64::INFINITY, left);
            return true;
        }
        let State { h, v } = self.state;
        let speed = corner(|k| libm::hypot(v[k], (2.0 * g * h[k]).sqrt()));
        let is_short = |speed: f64| short(2.0 * speed / (g * (1.0 - self.e)), now, self.scene.speed_m_s() / g);
        let slow = speed.map(|speed| (1.0 + self.e) * speed <= counts && is_short(speed));
        if slow[i] {
            let push = solve(|i, j| self.m[i][j], &slow, v.map(|v| -v));
            let pushed = |k: usize| (0..4).map(|i| self.m[k][i] * push[i]).sum::<f64>();
            self.state.v = corner(|k| if slow[k] { 0.0 } else { v[k] + pushed(k) });
            self.state.h = corner(|k| if slow[k] { 0.0 } else { h[k] });
            self.plane();
            let omitted = (0..4).filter(|&k| slow[k]).map(|k| (1.0 + self.e) * speed[k]);
            log.omitted_m_s = omitted.fold(log.omitted_m_s, f64::max);
        }
        false
    }

    /// Returns a bound on the speed of every corner by the energy of a state.
    fn fastest(&self, state: &State<4>) -> f64 {
        let energy = Level::of(&self.scene, state.h, state.v).energy();
        (2.0 * self.most * energy.max(0.0)).sqrt()
    }

    fn after(&self) -> After<4> {
        let [tilt, spin] = Level::of(&self.scene, self.state.h, self.state.v).angles();
        After { ends: self.state, tilt, spin }
    }

    fn fall(&self, log: &Log<4>) -> Fall {
        let (force, acceleration) = self.held();
        let strikes = log.flight.strikes.len();
        Fall { from_s: self.time.now(), state: self.state, acceleration, force, strikes }
    }

    fn ahead(&self, log: &Log<4>) -> Ahead<4> {
        let last = log.flight.strikes.last();
        let fastest = |strike: &Strike<4>| self.fastest(&State { h: strike.height_m, v: strike.velocity_m_s });
        Ahead {
            time_s: last.map_or(0.0, |strike| strike.time_s),
            struck: log.struck,
            largest_m_s: log.largest_m_s,
            most_m_s: last.map_or(f64::INFINITY, |strike| 2.0 * fastest(strike)),
            lands: true,
        }
    }
}

fn motion(scene: &PlateScene, e: f64, mut enough: impl FnMut(&Ahead<4>) -> bool) -> PlateMotion {
    let (mut run, mut log) = (Run::new(scene, e), Log::new(scene.time_limit_s(), scene.impact_limit()));
    // The bounds depend on the strikes so far, whatever the state of the run.
    let still_to_run = Run::new(scene, e);
    let mut enough = |log: &Log<4>| enough(&still_to_run.ahead(log));
    let mut list = vec![run.fall(&log)];
    let mut order = TILTED;
    loop {
        let State { h, v } = run.state;
        let first = |i: usize| order[i] / -v[i];
        let next = (0..4).filter(|&i| h[i] == 0.0 && v[i] < 0.0).min_by(|&i, &j| first(i).total_cmp(&first(j)));
        if let Some(i) = next {
            let wait = first(i);
            order = corner(|k| if k == i { 0.0 } else { (order[k] + wait * v[k]).max(0.0) });
            plane(&mut order);
            let (u, delta_v) = (v[i], run.strike(i));
            if !log.strike(i, run.time.now(), u, delta_v, &run.after(), &mut enough)
                || delta_v[i] <= SHARE * log.largest_m_s && run.settled(i, &mut log)
            {
                break;
            }
            continue;
        }
        order = TILTED;
        if still(&run.state) == [true; 4] {
            log.at_rest(run.time.now(), 0.0, 0.0);
            break;
        }
        let fall = run.fall(&log);
        list.push(fall);
        if !run.flown(&fall) {
            log.bounced_clear();
            break;
        }
    }
    let later_m_s = match log.flight.stop {
        Stop::AtRest { shock_bound_m_s, .. } => {
            run.state = State { h: [0.0; 4], v: [0.0; 4] };
            list.push(run.fall(&log));
            shock_bound_m_s
        }
        Stop::BouncedClear { .. } => 0.0,
        _ => 0.5 * (1.0 + e) * run.ahead(&log).most_m_s,
    };
    let course = Course::Impacts(Falls { scene: *scene, list });
    let (strikes, stop) = (log.flight.strikes, log.flight.stop);
    let (pivots, presses) = (Vec::new(), Vec::new());
    PlateMotion { strikes, pivots, presses, stop, later_m_s, energy_error: 0.0, model: Model::Ballistic, course }
}

impl PlateScene {
    /// Returns the motion by instant impacts with a coefficient of restitution, as far as it is needed: as
    /// [`Scene::fly_until`](crate::Scene::fly_until) by [`Model::Ballistic`]. Without gravity [`clatter::Plate`] is
    /// exact to the last digit, while this method goes strike by strike.
    ///
    /// Corners that come down at one instant strike in the order of a vanishing tilt along the diagonal.
    ///
    /// # Errors
    /// [`Error::Restitution`](InputError::Restitution) unless that is in [0, 1].
    ///
    /// # Examples
    /// A plate that has bounced clear comes back, until it lies still.
    /// ```
    /// use clatter_flight::{Plate, PlateScene, Stop};
    /// let plate = Plate::new([0.075, 0.075, 0.035, 0.035], [0.0433, 0.0202])?;
    /// let motion = PlateScene::new(plate, 2.0, [2e-3, 1e-3], 9.81)?.impacts_until(0.5, |_| false)?;
    /// assert_eq!((motion.strikes[0].point, motion.strikes[0].velocity_m_s[0]), (0, 1.0));
    /// assert!(matches!(motion.stop, Stop::AtRest { shock_bound_m_s, .. } if shock_bound_m_s < 1e-14));
    /// # Ok::<(), clatter::Error>(())
    /// ```
    pub fn impacts_until(
        &self,
        restitution: f64,
        enough: impl FnMut(&Ahead<4>) -> bool,
    ) -> Result<PlateMotion, InputError> {
        Ok(motion(self, Restitution::new(restitution)?.get(), enough))
    }
}

impl Falls {
    pub(crate) fn gravity_m_s2(&self) -> f64 {
        self.scene.gravity_m_s2()
    }

    pub(crate) fn sample(&self, time_s: f64) -> Sample<4> {
        let n = self.list.partition_point(|fall| fall.from_s <= time_s).saturating_sub(1);
        let fall = &self.list[n];
        let State { h, v } = fall.at((time_s - fall.from_s).max(0.0));
        let [tilt_rad, spin_rad_s] = Level::of(&self.scene, h, v).angles();
        Sample {
            height_m: h,
            velocity_m_s: v,
            acceleration_m_s2: fall.acceleration,
            force_per_mass_m_s2: fall.force,
            tilt_rad,
            spin_rad_s,
        }
    }

    /// Returns the weights of the corners in the slope along a direction.
    pub(crate) fn slope(&self, [x, y]: [f64; 2]) -> [f64; 4] {
        let [length, width] = self.scene.plate().sides_m();
        let [b, d] = [x / length, y / width];
        [-b - d, b, 0.0, d]
    }
    /// Returns the weights of the corners in the motion of a place, in m from the center of mass.
    pub(crate) fn place(&self, [x, y]: [f64; 2]) -> [f64; 4] {
        let [left, _, front, _] = self.scene.plate().edges_m();
        let [a, b, c, d] = self.slope([x + left, y + front]);
        [1.0 + a, b, c, d]
    }

    /// Returns the excitation of a sum of the motions of the corners with these weights, above a fall with an
    /// acceleration.
    pub(crate) fn excitation(&self, motion: &PlateMotion, weights: [f64; 4], gravity: f64) -> Excitation {
        let (strikes, end_s) = (&motion.strikes, motion.stop.time_s());
        let of = |corners: &[f64; 4]| weights.iter().zip(corners).map(|(weight, x)| weight * x).sum::<f64>();
        let mut excitation = Excitation::with_capacity(strikes.len() + self.list.len());
        let mut struck = 0;
        let mut shocks = |until: usize, excitation: &mut Excitation| {
            for strike in &strikes[struck..until] {
                excitation.push(Section::shock(strike.time_s, 0.0, of(&strike.delta_v_m_s)));
            }
            struck = until;
        };
        for (n, fall) in self.list.iter().enumerate() {
            shocks(fall.strikes, &mut excitation);
            let until = self.list.get(n + 1).map_or(end_s, |next| next.from_s);
            let section = Section::shock(fall.from_s, (until - fall.from_s).max(0.0), 0.0);
            excitation.push(Section { acceleration: [of(&fall.acceleration) + gravity; 2], ..section });
        }
        shocks(strikes.len(), &mut excitation);
        excitation
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Plate;

    /// Edges on the ground without motion: each corner that lies stays and is pushed up, and one that is let go rises. With mass along a
    /// diagonal a corner is let go.
    #[test]
    fn the_ground_pushes_and_never_pulls() {
        let mut let_go = 0;
        for product in [0.0, 0.5, -0.5, 0.98, -0.98] {
            let plate = Plate::new([0.1, 0.05, 0.03, 0.06], [0.03, 0.04]).expect("a plate");
            let plate = plate.with_product_of_inertia(product * 0.03 * 0.04).expect("a plate");
            let mut run = Run::new(&PlateScene::new(plate, 1.0, [0.0; 2], 9.81).expect("a drop"), 0.5);
            for (i, j) in [(0, 1), (1, 2), (2, 3), (3, 0)] {
                let lies = |k: usize| k == i || k == j;
                run.state = State { h: corner(|k| if lies(k) { 0.0 } else { 1e-3 }), v: [0.0; 4] };
                let (force, acceleration) = run.held();
                for k in (0..4).filter(|&k| lies(k)) {
                    let held = force[k] > 0.0 && acceleration[k] == 0.0;
                    let_go += usize::from(!held);
                    assert!(held || force[k] == 0.0 && acceleration[k] > 0.0, "{product}: {force:?} {acceleration:?}");
                }
                assert!((0..4).all(|k| lies(k) || force[k] == 0.0), "{product}: {force:?}");
            }
        }
        assert!((1..20).contains(&let_go), "{let_go}");
    }
}
