//! Impacts that take no time: three models of a bar, from straight lines to exact geometry.

mod ballistic;
mod finite_tilt;
mod map;
mod pivot;
mod settling;

use clatter::{Error, Restitution};

use crate::flight::{Flight, Model, State, Stop, Strike};
use crate::scene::Scene;

pub(crate) use ballistic::Clock;

impl Scene {
    /// The strikes of this scene and why they end.
    #[must_use]
    pub fn simulate(&self, model: Model) -> Flight {
        self.simulate_until(model, |_| false)
    }

    /// The same, as far as it is needed: before each strike but the first `enough` is asked of the flight up to there,
    /// and ends it if so.
    ///
    /// ```
    /// use clatter_flight::{Body, Model, Scene};
    /// let scene = Scene::new(Body::new(0.14, 0.05)?, 0.5, 2.0, 5.0, 9.81)?;
    /// let three = scene.simulate_until(Model::FiniteTilt, |flight| flight.strikes.len() == 3);
    /// assert_eq!(three.strikes, scene.with_impact_limit(3)?.simulate(Model::FiniteTilt).strikes);
    /// # Ok::<(), clatter::Error>(())
    /// ```
    #[must_use]
    pub fn simulate_until(&self, model: Model, enough: impl FnMut(&Flight) -> bool) -> Flight {
        match model {
            Model::Map => map::simulate(self, enough),
            // Without gravity the small-tilt motion is the map, which has closed forms where iteration drifts.
            Model::Ballistic if self.gravity_m_s2() == 0.0 => map::simulate(self, enough),
            Model::Ballistic => ballistic::simulate(self, enough),
            Model::FiniteTilt => finite_tilt::simulate(self, [self.e(); 2], f64::INFINITY, enough),
        }
    }

    /// The same at any tilt, of a body whose ends rebound differently: `restitution` of ends a and b counts in place of that
    /// of the scene. Beyond the time limit of the scene no strike is looked for: the flight ends with [`Stop::TimeLimit`] also where
    /// none would follow.
    ///
    /// # Errors
    /// [`Error::Restitution`] unless both are in [0, 1].
    ///
    /// # Examples
    /// A dead end a, and an end b that gives back all of its speed: e = 0, then e = 1.
    /// ```
    /// use clatter_flight::{Body, Scene};
    /// let scene = Scene::new(Body::new(0.14, 0.04)?, 0.5, 2.0, 1.0, 9.81)?;
    /// let flight = scene.simulate_ends([0.0, 1.0], |flight| flight.strikes.len() == 2)?;
    /// let [first, second] = &flight.strikes[..] else { panic!("two strikes") };
    /// assert!((first.point, second.point) == (0, 1) && first.velocity_m_s[0] == 0.0);
    /// assert!((second.velocity_m_s[1] + second.approach_m_s).abs() < 1e-15);
    /// # Ok::<(), clatter::Error>(())
    /// ```
    pub fn simulate_ends(&self, restitution: [f64; 2], enough: impl FnMut(&Flight) -> bool) -> Result<Flight, Error> {
        for e in restitution {
            Restitution::new(e)?;
        }
        Ok(finite_tilt::simulate(self, restitution, self.time_limit_s(), enough))
    }
}

impl Scene {
    /// No velocity shock of an end after this strike is larger, by the energy that the strike leaves: the approach of the end
    /// that is farther from the center of mass, doubled for what a rebound gives back, if all energy were in it.
    #[must_use]
    pub fn later_shock_m_s(&self, model: Model, strike: &Strike) -> f64 {
        let body = self.body();
        let [a, b] = body.arms_m();
        let g = if model == Model::Map { 0.0 } else { self.gravity_m_s2() };
        let center = |of: [f64; 2]| (b * of[0] + a * of[1]) / (a + b);
        let (v, turning) = (center(strike.velocity_m_s), body.gyration_m() * strike.spin_rad_s);
        let energy = 0.5 * (v * v + turning * turning) + g * center(strike.height_m);
        let mass = 1.0 / (1.0 + (a.max(b) / body.gyration_m()).powi(2));
        (1.0 + self.e()) * (2.0 * energy / mass).sqrt()
    }
}

impl Scene {
    /// Heights of ends a and b at a time of a flight of instant impacts, for drawing.
    ///
    /// Exact in flight, and to 1e−9 of the length while the body turns about an end that lies.
    #[must_use]
    pub fn heights_m(&self, model: Model, flight: &Flight, time_s: f64) -> [f64; 2] {
        self.ends(model, flight, time_s).0
    }

    /// Heights as [`heights_m`](Self::heights_m) and their rates, just after what happens at this time.
    pub(crate) fn ends(&self, model: Model, flight: &Flight, time_s: f64) -> ([f64; 2], [f64; 2]) {
        if matches!(flight.stop, Stop::AtRest { time_s: rest, .. } if time_s >= rest) {
            return ([0.0; 2], [0.0; 2]);
        }
        let past = flight.pivots.partition_point(|p| p.from_s <= time_s);
        let pivot = flight.pivots[..past].last();
        if let Some(p) = pivot.filter(|p| time_s < p.until_s) {
            let t = time_s - p.from_s;
            let (mut h, mut v) = ([0.0; 2], [0.0; 2]);
            let j = 1 - p.point;
            if model == Model::FiniteTilt {
                let begin = [p.tilt_rad, p.spin_rad_s];
                let whole = p.until_s - p.from_s;
                let [tilt, spin] = pivot::along(&self.body(), self.gravity_m_s2(), p.point, begin, t, whole);
                let (x, over) = self.body().levers(tilt.sin(), tilt.cos());
                (h[j], v[j]) = ((over[j] - over[p.point]).max(0.0), (x[j] - x[p.point]) * spin);
            } else {
                let fall = self.gravity_m_s2() * (1.0 + self.body().inertia_ratios()[p.point]);
                (h[j], v[j]) =
                    ((p.height_m + t * (p.velocity_m_s - 0.5 * fall * t)).max(0.0), p.velocity_m_s - fall * t);
            }
            return (h, v);
        }
        let past = flight.strikes.partition_point(|s| s.time_s <= time_s);
        let strike = flight.strikes[..past].last();
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
                let levers = self.body().levers(self.tilt_rad().sin(), self.tilt_rad().cos()).0;
                return ([0.0, self.height_gap_m()], self.end_velocities(levers));
            }
        };
        let t = time_s - from;
        let g = if model == Model::Map { 0.0 } else { self.gravity_m_s2() };
        let (h, v) = if model == Model::FiniteTilt {
            let (sin, cos) = tilt.sin_cos();
            let pose = finite_tilt::Pose { body: self.body(), gravity: g, ends, sin, cos, spin };
            ([0, 1].map(|i| pose.end(i, t)[0]), [0, 1].map(|i| pose.end(i, t)[1]))
        } else {
            ([0, 1].map(|i| ends.h[i] + t * (ends.v[i] - 0.5 * g * t)), ends.v.map(|v| v - g * t))
        };
        (h.map(|h| h.max(0.0)), v)
    }
}
