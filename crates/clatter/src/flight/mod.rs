//! The clatter in time: gravity, real tilt, an off-center mass, contact that takes time.
//!
//! Four models of one drop, each the cheapest that keeps its physics, all answering with the same kind of
//! [`Flight`], so that they can be compared strike by strike:
//!
//! | model | between strikes | a strike |
//! |---|---|---|
//! | [`Model::Map`] | straight lines, small tilt, no gravity | impulse |
//! | [`Model::Ballistic`] | parabolas, small tilt | impulse |
//! | [`Model::FiniteTilt`] | parabola of the center, uniform rotation, any angle | impulse, lever arm L cos φ, of corners where the body has a thickness |
//! | [`Scene::simulate_compliant`] | as `FiniteTilt` | linear spring and dashpot at each end |
//!
//! # The picture
//!
//! A body with ends `a` and `b` at distances `L_a`, `L_b` from its center of mass and radius of gyration `ρ`
//! falls on hard, frictionless, level ground. The tilt φ is positive where `b` is the higher end:
//! `h_a = y − L_a sin φ`, `h_b = y + L_b sin φ`. End `a` touches first, at time 0. Everything is in SI;
//! heights and velocities are vertical, upward positive, and forces and energies are per unit mass.
//!
//! # How a motion ends
//!
//! [`Stop`] is a result, never a tolerance on height or speed. A body has bounced clear when nothing can bring
//! it back (no gravity). It is at rest when its energy proves that all that is left takes less than an ulp of the
//! time and gives shocks below [`SHARE`] of the largest; both bounds are given. Everything else stops at a limit
//! and says so.
//!
//! ```
//! use clatter::flight::{Body, Model, Scene, Stop};
//! // A uniform bar with e = 0 and no tilt: both ends strike in turn at one instant, T = q = ½ each, until all is still.
//! let body = Body::new(0.14, 0.07 / 3.0_f64.sqrt())?;
//! let flight = Scene::new(body, 0.0, 1.0, 0.0, 9.81)?.simulate(Model::Ballistic);
//! assert_eq!(flight.strikes[0].approach_m_s, -1.0);
//! assert!((flight.strikes[1].approach_m_s + 1.5).abs() < 1e-15); // v_b − q v0
//! assert!((flight.strikes[2].approach_m_s + 0.75).abs() < 1e-15);
//! assert!(matches!(flight.stop, Stop::AtRest { time_s: 0.0, .. }));
//! # Ok::<(), clatter::Error>(())
//! ```

mod ballistic;
mod compliant;
mod finite_tilt;
mod map;
mod orders;
mod pivot;
mod roots;
mod scene;
mod settling;

pub use compliant::{CompliantFlight, Contact, Pulse, Sample};
pub use orders::{Order, Residue, orders, residues};
pub use scene::{Body, Scene};

use crate::{End, Error};

/// Share of the largest velocity shock below which shocks may be left out of the list once a bound on all of
/// them, and on the time they take, is proven: 2⁻⁵².
pub const SHARE: f64 = f64::EPSILON;

/// Which physics a flight keeps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Model {
    /// Small tilt, no gravity: the map of the paper. The scene's gravity is not used.
    Map,
    /// Small tilt, gravity.
    Ballistic,
    /// Any tilt, gravity.
    FiniteTilt,
}

/// One strike of an end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Strike {
    /// From 1.
    pub number: u64,
    /// The end that strikes.
    pub end: End,
    /// Since the first touch.
    pub time_s: f64,
    /// Vertical velocity of the striking end just before; negative.
    pub approach_m_s: f64,
    /// Jumps of the vertical velocities of ends a and b.
    pub delta_v_m_s: [f64; 2],
    /// Heights of ends a and b.
    pub height_m: [f64; 2],
    /// Vertical velocities of ends a and b just after.
    pub velocity_m_s: [f64; 2],
    /// Tilt, in (−π, π]; positive where end b is higher.
    pub tilt_rad: f64,
    /// Angular velocity just after, end b upward.
    pub spin_rad_s: f64,
}

impl Strike {
    /// Vertical velocity shock at position `s` in [−1, 1] along the body (−1 is end a):
    /// `((1 − s) Δv_a + (1 + s) Δv_b)/2`, for any tilt and any center of mass.
    #[must_use]
    pub fn delta_v_at(&self, s: f64) -> f64 {
        0.5 * ((1.0 - s) * self.delta_v_m_s[0] + (1.0 + s) * self.delta_v_m_s[1])
    }
}

/// A time in which one end lies on the ground and the body turns about it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pivot {
    /// The end on the ground.
    pub end: End,
    /// When it came to rest.
    pub from_s: f64,
    /// When the other end landed, or the resting end lifted off.
    pub until_s: f64,
    /// Height of the other end at the beginning.
    pub height_m: f64,
    /// Vertical velocity of the other end at the beginning.
    pub velocity_m_s: f64,
    /// How the resting end lifted off, if the pivot ended so; else the other end landed.
    pub lift_off: Option<LiftOff>,
}

/// The body as a resting end lifts off, pulled up by a fast turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LiftOff {
    /// Height of the other end.
    pub height_m: f64,
    /// Vertical velocity of the other end.
    pub velocity_m_s: f64,
    /// Tilt, in (−π, π]; positive where end b is higher.
    pub tilt_rad: f64,
    /// Angular velocity, end b upward.
    pub spin_rad_s: f64,
}

/// Why a flight ends.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Stop {
    /// Both ends lie still.
    AtRest {
        /// When the last listed strike happened, or the limit that strikes summed in closed form tend to.
        time_s: f64,
        /// The motion ends at most this much later: proven, and below an ulp of the time.
        time_bound_s: f64,
        /// No shock left out of the list is larger: proven, and at most [`SHARE`] of the largest.
        shock_bound_m_s: f64,
    },
    /// No strike can follow (without gravity alone).
    BouncedClear {
        /// When the last strike happened.
        time_s: f64,
    },
    /// A body of thickness has turned past its end, and comes down on corners that no model here knows.
    TurnedOver {
        /// When it stood on its end, or flew by at a right angle.
        time_s: f64,
    },
    /// More strikes would follow after the time limit.
    TimeLimit {
        /// The limit; earlier where a body at finite tilt turns more often before it comes down than can be followed (a
        /// thousand times or so).
        time_s: f64,
    },
    /// More strikes would follow than may be listed.
    ImpactLimit {
        /// When the last listed strike happened.
        time_s: f64,
    },
}

impl Stop {
    /// `at-rest`, `bounced-clear`, `turned-over`, `time-limit` or `impact-limit`.
    #[must_use]
    pub fn reason(&self) -> &'static str {
        match self {
            Self::AtRest { .. } => "at-rest",
            Self::BouncedClear { .. } => "bounced-clear",
            Self::TurnedOver { .. } => "turned-over",
            Self::TimeLimit { .. } => "time-limit",
            Self::ImpactLimit { .. } => "impact-limit",
        }
    }
    /// When the flight ends, since the first touch.
    #[must_use]
    pub fn time_s(&self) -> f64 {
        match *self {
            Self::AtRest { time_s, .. }
            | Self::BouncedClear { time_s }
            | Self::TurnedOver { time_s }
            | Self::TimeLimit { time_s }
            | Self::ImpactLimit { time_s } => time_s,
        }
    }
}

/// What a model says of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Flight {
    /// The strikes in order of time; at one instant, in the order in which a vanishing tilt makes them happen.
    pub strikes: Vec<Strike>,
    /// The times in which one end lay on the ground.
    pub pivots: Vec<Pivot>,
    /// Why it ends.
    pub stop: Stop,
}

impl Flight {
    /// Nothing followed yet.
    const NONE: Self = Self { strikes: Vec::new(), pivots: Vec::new(), stop: Stop::ImpactLimit { time_s: 0.0 } };
}

impl Scene {
    /// The strikes of this scene and why they end.
    #[must_use]
    pub fn simulate(&self, model: Model) -> Flight {
        self.simulate_until(model, |_| false)
    }

    /// The same, as far as it is needed: before each strike but the first `enough` is asked of the flight up to there,
    /// which is that of an impact limit, and ends it if so.
    ///
    /// ```
    /// use clatter::flight::{Body, Model, Scene};
    /// let scene = Scene::new(Body::new(0.14, 0.05)?, 0.5, 2.0, 5.0, 9.81)?;
    /// let three = scene.simulate_until(Model::FiniteTilt, |flight| flight.strikes.len() == 3);
    /// assert_eq!(three, scene.with_impact_limit(3)?.simulate(Model::FiniteTilt));
    /// # Ok::<(), clatter::Error>(())
    /// ```
    #[must_use]
    pub fn simulate_until(&self, model: Model, enough: impl FnMut(&Flight) -> bool) -> Flight {
        match model {
            Model::Map => map::simulate(self, enough),
            // Without gravity the small-tilt motion is the map, which has closed forms where iteration drifts.
            Model::Ballistic if self.gravity_m_s2() == 0.0 => map::simulate(self, enough),
            Model::Ballistic => ballistic::simulate(self, enough),
            Model::FiniteTilt => finite_tilt::simulate(self, enough),
        }
    }
}

impl Scene {
    /// The flight with a linear spring and dashpot at each end, fitted to the scene's restitution and to the time that
    /// a lone contact takes.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless e is in [0.01, 1], the body without thickness, the radius of gyration at least 0.05
    /// of the length (light ends would whirl the body through large angles while they touch), and the contact time in
    /// [1e−12, 1e3] s and so short that the ends sink in by a small part of the length: at most 0.1 length over the
    /// speed of either end, and 0.1 √(length/gravity).
    pub fn simulate_compliant(&self, contact_time_s: f64) -> Result<CompliantFlight, Error> {
        self.simulate_compliant_until(contact_time_s, |_| false)
    }

    /// The same, as far as it is needed: before each strike but the first `enough` is asked of the flight up to there,
    /// which is that of an impact limit, and ends it if so.
    ///
    /// # Errors
    /// As [`simulate_compliant`](Self::simulate_compliant).
    ///
    /// ```
    /// use clatter::flight::{Body, Scene};
    /// let scene = Scene::new(Body::new(0.14, 0.05)?, 0.5, 2.0, 5.0, 9.81)?;
    /// let three = scene.simulate_compliant_until(1e-4, |flight| flight.pulses.len() == 3)?;
    /// assert_eq!(three.flight, scene.with_impact_limit(3)?.simulate_compliant(1e-4)?.flight);
    /// # Ok::<(), clatter::Error>(())
    /// ```
    pub fn simulate_compliant_until(
        &self,
        contact_time_s: f64,
        enough: impl FnMut(&CompliantFlight) -> bool,
    ) -> Result<CompliantFlight, Error> {
        let contact = Contact::new(self.e(), contact_time_s)?;
        let gyration_m = self.body().gyration_m();
        let length = self.body().length_m();
        let thickness = self.body().thickness_m();
        if thickness > 0.0 {
            let allowed = "0 for a compliant contact, which knows no corners";
            return Err(Error::Quantity { name: "thickness in m", value: thickness, allowed });
        }
        if gyration_m < 0.05 * length {
            let allowed = "at least 0.05 of the length for a compliant contact";
            return Err(Error::Quantity { name: "radius of gyration in m", value: gyration_m, allowed });
        }
        let fastest = self.level_velocities().into_iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        let sinks = contact_time_s * fastest > 0.1 * length;
        if sinks || contact_time_s.powi(2) * self.gravity_m_s2() > 0.01 * length {
            let allowed = "at most 0.1 length/speed and 0.1 sqrt(length/gravity), so that the ends sink in little";
            return Err(Error::Quantity { name: "contact time in s", value: contact_time_s, allowed });
        }
        Ok(compliant::simulate(self, contact, enough))
    }
}

impl Scene {
    /// Heights of ends a and b at a time of a flight of instant impacts, for drawing.
    ///
    /// Exact in flight. While the body pivots at finite tilt it is the parabola with the height and velocity of the
    /// beginning that ends where the pivot ends.
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
            let whole = p.until_s - p.from_s;
            let x = (time_s - p.from_s) / whole;
            let last = p.lift_off.map_or(0.0, |off| off.height_m);
            let bulge = p.height_m - last + p.velocity_m_s * whole;
            let (mut h, mut v) = ([0.0; 2], [0.0; 2]);
            let j = index(p.end.other());
            h[j] = (p.height_m * (1.0 - x) + last * x + bulge * x * (1.0 - x)).max(0.0);
            v[j] = p.velocity_m_s - 2.0 * bulge * x / whole;
            return (h, v);
        }
        let past = flight.strikes.partition_point(|s| s.time_s <= time_s);
        let strike = flight.strikes[..past].last();
        let lifted = pivot.filter(|p| strike.is_none_or(|s| s.time_s < p.until_s));
        let (from, ends, tilt, spin) = match (lifted.and_then(|p| p.lift_off.map(|off| (p, off))), strike) {
            (Some((p, off)), _) => {
                let mut ends = State { h: [0.0; 2], v: [0.0; 2] };
                let j = index(p.end.other());
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

/// An end as an index.
fn index(end: End) -> usize {
    match end {
        End::A => 0,
        End::B => 1,
    }
}

/// The list under construction, with its limits.
#[derive(Debug)]
struct Log {
    flight: Flight,
    time_limit_s: f64,
    impact_limit: usize,
    /// Largest velocity shock at an end so far.
    largest_m_s: f64,
    /// Largest shock summed in closed form instead of being listed.
    omitted_m_s: f64,
}

impl Log {
    fn new(scene: &Scene) -> Self {
        Self {
            flight: Flight::NONE,
            time_limit_s: scene.time_limit_s(),
            impact_limit: scene.impact_limit(),
            largest_m_s: 0.0,
            omitted_m_s: 0.0,
        }
    }
    /// Takes the strike down, or the stop that its time, its number or `enough` means; false ends the simulation.
    fn strike(
        &mut self,
        end: End,
        time_s: f64,
        approach: f64,
        delta_v: [f64; 2],
        after: &After,
        enough: &mut impl FnMut(&Flight) -> bool,
    ) -> bool {
        if time_s > self.time_limit_s {
            self.flight.stop = Stop::TimeLimit { time_s: self.time_limit_s };
            return false;
        }
        // The map's times are each exact to roundings, by which neighbors may change places.
        let time_s = self.flight.strikes.last().map_or(time_s, |last| {
            self.flight.stop = Stop::ImpactLimit { time_s: last.time_s };
            time_s.max(last.time_s)
        });
        let strikes = self.flight.strikes.len();
        if strikes == self.impact_limit || (strikes > 0 && enough(&self.flight)) {
            return false;
        }
        self.flight.strikes.push(Strike {
            number: strikes as u64 + 1,
            end,
            time_s,
            approach_m_s: approach,
            delta_v_m_s: delta_v,
            height_m: after.ends.h,
            velocity_m_s: after.ends.v,
            tilt_rad: after.tilt,
            spin_rad_s: after.spin,
        });
        self.largest_m_s = self.largest_m_s.max(delta_v[0].abs()).max(delta_v[1].abs());
        true
    }
    fn pivot(&mut self, end: End, from_s: f64, until_s: f64, state: &State) {
        let j = index(end.other());
        let (height_m, velocity_m_s) = (state.h[j], state.v[j]);
        self.flight.pivots.push(Pivot { end, from_s, until_s, height_m, velocity_m_s, lift_off: None });
    }
    /// The last pivot ended as the resting end lifted off.
    fn lifted(&mut self, after: &After) {
        if let Some(pivot) = self.flight.pivots.last_mut() {
            let j = index(pivot.end.other());
            let (height_m, velocity_m_s) = (after.ends.h[j], after.ends.v[j]);
            pivot.lift_off = Some(LiftOff { height_m, velocity_m_s, tilt_rad: after.tilt, spin_rad_s: after.spin });
        }
    }
    fn bounced_clear(&mut self) {
        self.flight.stop = Stop::BouncedClear { time_s: self.flight.strikes.last().map_or(0.0, |s| s.time_s) };
    }
    /// The next strike cannot be told.
    fn lost(&mut self, time_s: f64) {
        self.flight.stop = Stop::TimeLimit { time_s: time_s.min(self.time_limit_s) };
    }
    fn turned_over(&mut self, time_s: f64) {
        self.flight.stop = if time_s > self.time_limit_s {
            Stop::TimeLimit { time_s: self.time_limit_s }
        } else {
            Stop::TurnedOver { time_s }
        };
    }
    /// At rest if what is left is proven to take less than an ulp of the time and to give negligible shocks.
    ///
    /// At time 0 (a flat drop whose strikes all fall on one instant) the ulp is that of the scene's own time, v0/g.
    fn settled(&mut self, time_s: f64, scale_s: f64, left_s: f64, shock: f64) -> bool {
        if shock > SHARE * self.largest_m_s || !short(left_s, time_s, scale_s) {
            return false;
        }
        self.at_rest(time_s, left_s, shock);
        true
    }
    fn at_rest(&mut self, time_s: f64, time_bound_s: f64, shock: f64) {
        let shock_bound_m_s = shock.max(self.omitted_m_s);
        self.flight.stop = if time_s > self.time_limit_s {
            Stop::TimeLimit { time_s: self.time_limit_s }
        } else {
            Stop::AtRest { time_s, time_bound_s, shock_bound_m_s }
        };
    }
}

/// Whether a duration is below an ulp of the time, at time 0 of the scene's own time.
fn short(left_s: f64, time_s: f64, scale_s: f64) -> bool {
    left_s <= 0.5 * f64::EPSILON * if time_s == 0.0 { scale_s } else { time_s }
}

/// Heights and vertical velocities of ends a and b.
#[derive(Debug, Clone, Copy)]
struct State {
    h: [f64; 2],
    v: [f64; 2],
}

/// How a strike leaves the body.
struct After {
    ends: State,
    tilt: f64,
    spin: f64,
}

impl After {
    /// At small tilt, of a body of this length.
    fn small(ends: &State, length: f64) -> Self {
        Self { ends: *ends, tilt: (ends.h[1] - ends.h[0]) / length, spin: (ends.v[1] - ends.v[0]) / length }
    }
}
