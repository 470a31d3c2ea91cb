//! Models, strikes, times at rest on a point, and why a motion ends.

use crate::contact::Contact;

/// Share of the largest velocity shock below which shocks may be left out of the list once a bound on all of
/// them, and on the time they take, is proven: 2⁻⁵².
pub const SHARE: f64 = f64::EPSILON;

/// Which physics a motion keeps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Model {
    /// Small tilt, no gravity: the map of the paper. The scene's gravity is not used.
    Map,
    /// Small tilt, gravity.
    Ballistic,
    /// Any tilt, gravity.
    FiniteTilt,
    /// Any tilt, gravity, contacts that take time.
    Contacts(Contact),
}

impl Model {
    /// `map`, `ballistic`, `finite-tilt` or `compliant`.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Map => "map",
            Self::Ballistic => "ballistic",
            Self::FiniteTilt => "finite-tilt",
            Self::Contacts(_) => "compliant",
        }
    }
}

/// One strike of a contact point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Strike<const N: usize = 2> {
    /// From 1.
    pub number: u64,
    /// The contact point that strikes, by its index in [`Profile::points_m`](crate::Profile::points_m).
    pub point: usize,
    /// Since the first touch.
    pub time_s: f64,
    /// Vertical velocity of the striking point just before; negative.
    pub approach_m_s: f64,
    /// Jumps of the vertical velocities of all points.
    pub delta_v_m_s: [f64; N],
    /// Heights of all points.
    pub height_m: [f64; N],
    /// Vertical velocities of all points just after.
    pub velocity_m_s: [f64; N],
    /// Tilt, in (−π, π]; positive where end b of a bar is higher.
    pub tilt_rad: f64,
    /// Angular velocity just after, end b of a bar upward.
    pub spin_rad_s: f64,
}

impl Strike<2> {
    /// Vertical velocity shock at position `s` in [−1, 1] along a bar (−1 is end a):
    /// `((1 − s) Δv_a + (1 + s) Δv_b)/2`, for any tilt and any center of mass.
    #[must_use]
    pub fn delta_v_at(&self, s: f64) -> f64 {
        0.5 * ((1.0 - s) * self.delta_v_m_s[0] + (1.0 + s) * self.delta_v_m_s[1])
    }
}

/// A time in which one end lies on the ground and the body turns about it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pivot {
    /// The contact point on the ground.
    pub point: usize,
    /// When it came to rest.
    pub from_s: f64,
    /// When the other end landed, or the resting end lifted off.
    pub until_s: f64,
    /// Height of the other end at the beginning.
    pub height_m: f64,
    /// Vertical velocity of the other end at the beginning.
    pub velocity_m_s: f64,
    /// Tilt at the beginning, in (−π, π]; positive where end b is higher.
    pub tilt_rad: f64,
    /// Angular velocity at the beginning, end b upward.
    pub spin_rad_s: f64,
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
    /// All contact points lie still.
    AtRest {
        /// When the last listed strike happened, or the limit that strikes summed in closed form tend to.
        time_s: f64,
        /// The motion ends at most this much later: proven, and below an ulp of the time. Infinite where nothing bounds it: of contacts
        /// that take time, which die away and never end, and of instant impacts of a plate, which its energy alone says not to matter.
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
    /// What follows was not asked for.
    Enough {
        /// When the next strike comes.
        time_s: f64,
    },
    /// More strikes would follow after the time limit.
    TimeLimit {
        /// The limit; earlier where a body at finite tilt turns more often before it comes down than can be followed (a
        /// thousand times or so), or where contacts take more than 150 000 phases and 128 for each strike.
        time_s: f64,
    },
    /// What follows is not known: the energy of the body has changed by more than 1 % without reason (contacts that take time).
    EnergyLimit {
        /// When it had.
        time_s: f64,
    },
    /// More strikes would follow than may be listed.
    ImpactLimit {
        /// When the last listed strike happened; of contacts that take time, when the next one would.
        time_s: f64,
    },
}

impl Stop {
    /// `at-rest`, `bounced-clear`, `turned-over`, `enough`, `time-limit`, `energy-limit` or `impact-limit`.
    #[must_use]
    pub fn reason(&self) -> &'static str {
        match self {
            Self::AtRest { .. } => "at-rest",
            Self::BouncedClear { .. } => "bounced-clear",
            Self::TurnedOver { .. } => "turned-over",
            Self::Enough { .. } => "enough",
            Self::TimeLimit { .. } => "time-limit",
            Self::EnergyLimit { .. } => "energy-limit",
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
            | Self::Enough { time_s }
            | Self::TimeLimit { time_s }
            | Self::EnergyLimit { time_s }
            | Self::ImpactLimit { time_s } => time_s,
        }
    }
}

/// Strikes and pivots, and why there are no more.
#[derive(Debug)]
pub(crate) struct Flight<const N: usize = 2> {
    pub(crate) strikes: Vec<Strike<N>>,
    pub(crate) pivots: Vec<Pivot>,
    pub(crate) stop: Stop,
}

/// The list under construction, with its limits.
#[derive(Debug)]
pub(crate) struct Log<const N: usize> {
    pub(crate) flight: Flight<N>,
    pub(crate) time_limit_s: f64,
    pub(crate) impact_limit: usize,
    /// Strikes of each point so far.
    pub(crate) struck: [usize; N],
    /// Largest velocity shock at an end so far.
    pub(crate) largest_m_s: f64,
    /// Largest shock summed in closed form instead of being listed.
    pub(crate) omitted_m_s: f64,
}

impl<const N: usize> Log<N> {
    pub(crate) fn new(time_limit_s: f64, impact_limit: usize) -> Self {
        let stop = Stop::ImpactLimit { time_s: 0.0 };
        let flight = Flight { strikes: Vec::new(), pivots: Vec::new(), stop };
        Self { flight, time_limit_s, impact_limit, struck: [0; N], largest_m_s: 0.0, omitted_m_s: 0.0 }
    }
    /// Takes the strike down, or the stop that its time, its number or `enough` means; false ends the simulation.
    pub(crate) fn strike(
        &mut self,
        point: usize,
        time_s: f64,
        approach: f64,
        delta_v: [f64; N],
        after: &After<N>,
        enough: &mut impl FnMut(&Self) -> bool,
    ) -> bool {
        if time_s > self.time_limit_s {
            self.flight.stop = Stop::TimeLimit { time_s: self.time_limit_s };
            return false;
        }
        // The map's times are each exact to roundings, by which neighbors may change places.
        let last_s = self.flight.strikes.last().map(|last| last.time_s);
        let time_s = last_s.map_or(time_s, |last| time_s.max(last));
        let strikes = self.flight.strikes.len();
        if strikes == self.impact_limit {
            self.flight.stop = Stop::ImpactLimit { time_s: last_s.unwrap_or(time_s) };
            return false;
        }
        if strikes > 0 && enough(self) {
            self.flight.stop = Stop::Enough { time_s };
            return false;
        }
        self.struck[point] += 1;
        self.flight.strikes.push(Strike {
            number: strikes as u64 + 1,
            point,
            time_s,
            approach_m_s: approach,
            delta_v_m_s: delta_v,
            height_m: after.ends.h,
            velocity_m_s: after.ends.v,
            tilt_rad: after.tilt,
            spin_rad_s: after.spin,
        });
        self.largest_m_s = delta_v.iter().fold(self.largest_m_s, |most, v| most.max(v.abs()));
        true
    }
    pub(crate) fn bounced_clear(&mut self) {
        self.flight.stop = Stop::BouncedClear { time_s: self.flight.strikes.last().map_or(0.0, |s| s.time_s) };
    }
    /// The next strike cannot be told.
    pub(crate) fn lost(&mut self, time_s: f64) {
        self.flight.stop = Stop::TimeLimit { time_s: time_s.min(self.time_limit_s) };
    }
    pub(crate) fn turned_over(&mut self, time_s: f64) {
        self.flight.stop = if time_s > self.time_limit_s {
            Stop::TimeLimit { time_s: self.time_limit_s }
        } else {
            Stop::TurnedOver { time_s }
        };
    }
    /// At rest if what is left is proven to take less than an ulp of the time and to give negligible shocks.
    ///
    /// At time 0 (a flat drop whose strikes all fall on one instant) the ulp is that of the scene's own time, v0/g.
    pub(crate) fn settled(&mut self, time_s: f64, scale_s: f64, left_s: f64, shock: f64) -> bool {
        if shock > SHARE * self.largest_m_s || !short(left_s, time_s, scale_s) {
            return false;
        }
        self.at_rest(time_s, left_s, shock);
        true
    }
    pub(crate) fn at_rest(&mut self, time_s: f64, time_bound_s: f64, shock: f64) {
        let shock_bound_m_s = shock.max(self.omitted_m_s);
        self.flight.stop = if time_s > self.time_limit_s {
            Stop::TimeLimit { time_s: self.time_limit_s }
        } else {
            Stop::AtRest { time_s, time_bound_s, shock_bound_m_s }
        };
    }
}

impl Log<2> {
    pub(crate) fn pivot(&mut self, point: usize, from_s: f64, until_s: f64, state: &After) {
        let j = 1 - point;
        let (height_m, velocity_m_s) = (state.ends.h[j], state.ends.v[j]);
        let (tilt_rad, spin_rad_s) = (state.tilt, state.spin);
        let pivot = Pivot { point, from_s, until_s, height_m, velocity_m_s, tilt_rad, spin_rad_s, lift_off: None };
        self.flight.pivots.push(pivot);
    }
    /// The last pivot ended as the resting end lifted off.
    pub(crate) fn lifted(&mut self, after: &After) {
        if let Some(pivot) = self.flight.pivots.last_mut() {
            let j = 1 - pivot.point;
            let (height_m, velocity_m_s) = (after.ends.h[j], after.ends.v[j]);
            pivot.lift_off = Some(LiftOff { height_m, velocity_m_s, tilt_rad: after.tilt, spin_rad_s: after.spin });
        }
    }
}

/// Whether a duration is below an ulp of the time, at time 0 of the scene's own time.
pub(crate) fn short(left_s: f64, time_s: f64, scale_s: f64) -> bool {
    left_s <= 0.5 * f64::EPSILON * if time_s == 0.0 { scale_s } else { time_s }
}

/// Heights and vertical velocities of all contact points.
#[derive(Debug, Clone, Copy)]
pub(crate) struct State<const N: usize = 2> {
    pub(crate) h: [f64; N],
    pub(crate) v: [f64; N],
}

/// How a strike leaves the body.
pub(crate) struct After<const N: usize = 2> {
    pub(crate) ends: State<N>,
    pub(crate) tilt: f64,
    pub(crate) spin: f64,
}

impl After<2> {
    /// At small tilt, of a body of this length.
    pub(crate) fn small(ends: &State, length: f64) -> Self {
        Self { ends: *ends, tilt: (ends.h[1] - ends.h[0]) / length, spin: (ends.v[1] - ends.v[0]) / length }
    }
}
