//! Impacts that take no time: three models of a bar, from straight lines to exact geometry.

mod ballistic;
mod finite_tilt;
mod map;
mod pivot;
mod plate;
mod settling;

use crate::flight::{Flight, Log, Model, State, Stop, Strike};
use crate::motion::{Ahead, Motion};
use crate::scene::Scene;

pub(crate) use ballistic::Clock;
pub(crate) use plate::Falls;

/// Returns the strikes by a model of instant impacts, as far as they are needed: `enough` is called before each but the
/// first. `ends` is the restitution of each end at real tilt, where it is not that of the scene.
pub(crate) fn strikes(
    scene: &Scene,
    model: Model,
    ends: Option<[f64; 2]>,
    mut enough: impl FnMut(&Ahead) -> bool,
) -> Flight {
    let enough = |log: &Log<2>| enough(&scene.ahead(model, log));
    match model {
        // Without gravity the small-tilt motion is the map, which has closed forms where iteration drifts.
        Model::Ballistic if scene.gravity_m_s2() > 0.0 => ballistic::simulate(scene, enough),
        Model::Map | Model::Ballistic => map::simulate(scene, enough),
        Model::FiniteTilt | Model::Contacts(_) => {
            let horizon_s = ends.map_or(f64::INFINITY, |_| scene.time_limit_s());
            finite_tilt::simulate(scene, ends.unwrap_or([scene.e(); 2]), horizon_s, enough)
        }
    }
}

impl Scene {
    fn ahead(&self, model: Model, log: &Log<2>) -> Ahead {
        let last = log.flight.strikes.last();
        Ahead {
            time_s: last.map_or(0.0, |strike| strike.time_s),
            struck: log.struck,
            largest_m_s: log.largest_m_s,
            most_m_s: last.map_or(f64::INFINITY, |strike| self.most_m_s(model, strike)),
            lands: true,
        }
    }

    /// Returns twice the fastest approach after a strike, by the energy after it: that of the end that is farther from
    /// the center of mass, if all energy were in it.
    pub(crate) fn most_m_s(&self, model: Model, strike: &Strike) -> f64 {
        let body = self.body();
        let [a, b] = body.arms_m();
        let g = if model == Model::Map { 0.0 } else { self.gravity_m_s2() };
        let center = |of: [f64; 2]| (b * of[0] + a * of[1]) / (a + b);
        let (v, turning) = (center(strike.velocity_m_s), body.gyration_m() * strike.spin_rad_s);
        let energy = 0.5 * (v * v + turning * turning) + g * center(strike.height_m);
        let mass = 1.0 / (1.0 + (a.max(b) / body.gyration_m()).powi(2));
        2.0 * (2.0 * energy / mass).sqrt()
    }
}

impl Motion {
    /// Returns the heights of both ends by instant impacts, and their rates, just after the events at this time.
    pub(crate) fn ends_of_impacts(&self, scene: &Scene, time_s: f64) -> ([f64; 2], [f64; 2]) {
        if matches!(self.stop, Stop::AtRest { time_s: rest, .. } if time_s >= rest) {
            return ([0.0; 2], [0.0; 2]);
        }
        let past = self.pivots.partition_point(|p| p.from_s <= time_s);
        let pivot = self.pivots[..past].last();
        if let Some(p) = pivot.filter(|p| time_s < p.until_s) {
            let t = time_s - p.from_s;
            let (mut h, mut v) = ([0.0; 2], [0.0; 2]);
            let j = 1 - p.point;
            if self.model == Model::FiniteTilt {
                let begin = [p.tilt_rad, p.spin_rad_s];
                let whole = p.until_s - p.from_s;
                let [tilt, spin] = pivot::along(&scene.body(), scene.gravity_m_s2(), p.point, begin, t, whole);
                let (x, over) = scene.body().levers(libm::sin(tilt), libm::cos(tilt));
                (h[j], v[j]) = ((over[j] - over[p.point]).max(0.0), (x[j] - x[p.point]) * spin);
            } else {
                let fall = scene.gravity_m_s2() * (1.0 + scene.body().inertia_ratios()[p.point]);
                (h[j], v[j]) =
                    ((p.height_m + t * (p.velocity_m_s - 0.5 * fall * t)).max(0.0), p.velocity_m_s - fall * t);
            }
            return (h, v);
        }
        let past = self.strikes.partition_point(|s| s.time_s <= time_s);
        let strike = self.strikes[..past].last();
        let lifted = pivot.filter(|p| strike.is_none_or(|s| s.time_s < p.until_s));
        let (from, ends, tilt, spin) = match (lifted.and_then(|p| p.lift_off.map(|off| (p, off))), strike) {
            (Some((p, off)), _) => {
                let mut ends = State { h: [0.0; 2], v: [0.0; 2] };
                let j = 1 - p.point;
                (ends.h[j], ends.v[j]) = (off.height_m, off.velocity_m_s);
                (p.until_s, ends, off.tilt_rad, off.spin_rad_s)
            }
            (None, Some(s)) => (s.time_s, State { h: s.height_m, v: s.velocity_m_s }, s.tilt_rad, s.spin_rad_s),
            (None, None) => {
                let levers = scene.body().levers(libm::sin(scene.tilt_rad()), libm::cos(scene.tilt_rad())).0;
                return ([0.0, scene.height_gap_m()], scene.end_velocities(levers));
            }
        };
        let t = time_s - from;
        let g = self.gravity_m_s2();
        let (h, v) = if self.model == Model::FiniteTilt {
            let (sin, cos) = libm::sincos(tilt);
            let pose = finite_tilt::Airborne { body: scene.body(), gravity: g, ends, sin, cos, spin };
            ([0, 1].map(|i| pose.end(i, t)[0]), [0, 1].map(|i| pose.end(i, t)[1]))
        } else {
            ([0, 1].map(|i| ends.h[i] + t * (ends.v[i] - 0.5 * g * t)), ends.v.map(|v| v - g * t))
        };
        (h.map(|h| h.max(0.0)), v)
    }
}
