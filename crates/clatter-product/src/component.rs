//! A fragile part: where it is, how it is held and what it stands.

use clatter_shock::{DampingRatio, Stop, Suspension};

use clatter_flight::{Axis, Place};

use crate::{Error, LimitKind, Spread, Unit, units};

/// A fragile part.
#[derive(Debug, Clone, PartialEq)]
pub struct Component {
    /// The name in the file.
    pub name: String,
    /// The place of its middle.
    pub position_m: Spread,
    /// The extent along the bar, both sides together; 0 for a point.
    pub extent_m: f64,
    /// The place of its middle across a plate; 0 of a bar.
    pub across_m: Spread,
    /// The extent across a plate; 0 for a point.
    pub extent_across_m: f64,
    /// The place and axis of the part in a box.
    pub inside: Inside,
    /// The mounting of the part.
    pub mount: Mount,
    /// The stops of a suspended part; none where nothing is known of them.
    pub stops: Option<Stops>,
    /// The limits that it stands.
    pub limits: Limits,
    /// The source of its limits, as the file states it.
    pub limit_source: Option<String>,
}

/// The mounting of a part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mount {
    /// Rigidly: it goes through what the bar goes through at its place.
    Hard,
    /// On a suspension, or with a natural frequency of its own.
    Suspended {
        /// Natural frequency, in Hz.
        frequency_hz: Spread,
        /// Its damping.
        damping: Damping,
    },
}

/// The stops of a suspended part, one on either side of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stops {
    /// The distance from the part at rest to each of them.
    pub gap_m: Spread,
    /// The time of a contact of the part alone with one of them.
    pub contact_time_s: Spread,
    /// The restitution of such a contact.
    pub restitution: Spread,
}

/// The names of one number of a stop.
#[derive(Debug, Clone, Copy)]
pub struct StopInput {
    /// Its name for programs: `stop-gap`.
    pub name: &'static str,
    /// Its name for people: `gap of the stop`.
    pub words: &'static str,
    /// Its column, in SI: `stop_gap_m`.
    pub column: &'static str,
    /// Its SI unit; 1 where it has none.
    pub unit: &'static str,
}

impl Stops {
    /// The gap, the contact time and the restitution.
    pub const INPUTS: [StopInput; 3] = [
        StopInput { name: "stop-gap", words: "gap of the stop", column: "stop_gap_m", unit: "m" },
        StopInput {
            name: "stop-contact-time",
            words: "contact time of the stop",
            column: "stop_contact_time_s",
            unit: "s",
        },
        StopInput { name: "stop-restitution", words: "restitution of the stop", column: "stop_restitution", unit: "1" },
    ];
    /// Returns the ranges: of the gap, the contact time and the restitution.
    #[must_use]
    pub fn ranges(&self) -> [&Spread; 3] {
        [&self.gap_m, &self.contact_time_s, &self.restitution]
    }
    /// Returns a stop with these values of the three.
    ///
    /// # Errors
    /// [`Error::Shock`] for one out of range.
    pub fn of([gap_m, contact_time_s, restitution]: [f64; 3]) -> Result<Stop, Error> {
        Ok(Stop::new(gap_m, contact_time_s, restitution)?)
    }
    /// Returns the three numbers of a stop.
    #[must_use]
    pub fn numbers(stop: &Stop) -> [f64; 3] {
        [stop.gap(), stop.contact_time(), stop.restitution()]
    }
    /// Returns the stops at these shares of their ranges, from 0 to 1.
    ///
    /// # Errors
    /// As [`of`](Self::of).
    pub fn at(&self, shares: [f64; 3]) -> Result<Stop, Error> {
        let [gap, time, restitution] = self.ranges();
        Self::of([gap.at(shares[0]), time.at(shares[1]), restitution.at(shares[2])])
    }
    /// Returns the nearest ones that press shortest and throw back most, where parts are asked for most as a rule.
    ///
    /// # Errors
    /// As [`of`](Self::of).
    pub fn hardest(&self) -> Result<Stop, Error> {
        self.at(Self::HARDEST)
    }
    /// The shares of their ranges at which stops are hardest.
    pub const HARDEST: [f64; 3] = [0.0, 0.0, 1.0];
}

/// Damping of a suspension, as it was given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Damping {
    /// Damping ratio.
    Ratio(Spread),
    /// Quality factor, 1/(2 damping ratio).
    Quality(Spread),
}

impl Damping {
    /// Returns the given value, a ratio or a quality factor.
    #[must_use]
    pub fn spread(&self) -> &Spread {
        match self {
            Self::Ratio(spread) | Self::Quality(spread) => spread,
        }
    }
    /// Returns the damping ratio for a value of the given quantity.
    ///
    /// # Errors
    /// [`Error::Shock`] for one out of range.
    pub fn ratio(&self, given: f64) -> Result<DampingRatio, Error> {
        Ok(match self {
            Self::Ratio(_) => DampingRatio::new(given)?,
            Self::Quality(_) => DampingRatio::from_quality_factor(given)?,
        })
    }
    /// Returns the range of damping ratios, from the least.
    #[must_use]
    pub fn ratios(&self) -> [f64; 2] {
        match self {
            Self::Ratio(spread) => [spread.lo(), spread.hi()],
            Self::Quality(spread) => [0.5 / spread.hi(), 0.5 / spread.lo()],
        }
    }
}

/// The limits of a part; at least one is set. Each is finite and positive. Where one has a range, its least value is held
/// against the worst drop.
///
/// # Examples
/// ```
/// use clatter_product::{LimitKind, Limits, Spread};
/// let limits = Limits::default()
///     .with(LimitKind::RattleSpace, Spread::value(2e-3)?)
///     .with_damage_boundary(Spread::value(3.0)?, Spread::value(5e3)?);
/// assert_eq!(limits.kinds(), [LimitKind::RattleSpace, LimitKind::DamageBoundary]);
/// # Ok::<(), clatter_product::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Limits {
    allowed: [Option<Spread>; LimitKind::ALL.len()],
    critical_acceleration_m_s2: Option<Spread>,
}

impl Limits {
    /// Returns the same limits with this allowed value of a kind, in its SI unit ([`LimitKind::unit`]). A damage boundary needs its
    /// acceleration too: see [`with_damage_boundary`](Self::with_damage_boundary).
    #[must_use]
    pub fn with(mut self, kind: LimitKind, allowed: Spread) -> Self {
        self.allowed[kind as usize] = Some(allowed);
        self
    }
    /// Returns the same with a damage boundary: a shock of the product at the part does damage only beyond both, a velocity change and an
    /// acceleration.
    #[must_use]
    pub fn with_damage_boundary(self, velocity_change_m_s: Spread, acceleration_m_s2: Spread) -> Self {
        let with = self.with(LimitKind::DamageBoundary, velocity_change_m_s);
        Self { critical_acceleration_m_s2: Some(acceleration_m_s2), ..with }
    }
    /// Returns the same without a limit of a kind.
    #[must_use]
    pub fn without(mut self, kind: LimitKind) -> Self {
        self.allowed[kind as usize] = None;
        self
    }
    /// Returns the allowed value of a kind; of a damage boundary the critical velocity change.
    #[must_use]
    pub fn get(&self, kind: LimitKind) -> Option<&Spread> {
        self.allowed[kind as usize].as_ref()
    }
    /// Returns the allowed value of a kind, to be changed.
    #[must_use]
    pub fn get_mut(&mut self, kind: LimitKind) -> Option<&mut Spread> {
        self.allowed[kind as usize].as_mut()
    }
    /// Returns the critical acceleration of a damage boundary.
    #[must_use]
    pub fn critical_acceleration_m_s2(&self) -> Option<&Spread> {
        self.critical_acceleration_m_s2.as_ref().filter(|_| self.get(LimitKind::DamageBoundary).is_some())
    }
    /// Returns the kinds that are set, in a fixed order.
    #[must_use]
    pub fn kinds(&self) -> Vec<LimitKind> {
        LimitKind::ALL.into_iter().filter(|kind| self.get(*kind).is_some()).collect()
    }
    /// Returns the unit in which the file gives a limit; of a damage boundary that of its velocity change or, by the SI unit, of its
    /// acceleration.
    #[must_use]
    pub fn unit(&self, kind: LimitKind, si: Unit) -> Option<&'static units::Unit> {
        let spread = if si == kind.unit() { self.get(kind) } else { self.critical_acceleration_m_s2() };
        spread.and_then(Spread::unit)
    }
}

/// The place and axis of a part in the thickness of a box.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Inside {
    /// The place of its middle across the thickness, from the middle; 0 of every bar and plate.
    pub height_m: f64,
    /// Along which axis it moves.
    pub axis: Axis,
}

impl Inside {
    /// Returns the place of a part there, along the product and across it.
    #[must_use]
    pub fn place(&self, [x, y]: [f64; 2]) -> Place {
        Place { at_m: [x, y, self.height_m], axis: self.axis }
    }
}

impl Component {
    /// Returns a part without extent, whose limits have no stated source.
    #[must_use]
    pub fn new(name: impl Into<String>, position_m: Spread, mount: Mount, limits: Limits) -> Self {
        let (extent_m, across_m, extent_across_m) = (0.0, Spread::finite(0.0), 0.0);
        let (name, inside, limit_source) = (name.into(), Inside::default(), None);
        Self { name, position_m, extent_m, across_m, extent_across_m, inside, mount, stops: None, limits, limit_source }
    }
    /// Returns the ends of where the part may be, \[x, y\]: one where it is a point, both ends along a bar, the corners of a rectangle on a
    /// plate.
    ///
    /// The worst place is one of them for all but changes of velocity and parts with stops, see [`places_m`](Self::places_m): for one drop
    /// the motion of the body is linear in the position, so is the response to it, and the largest absolute value of linear functions is
    /// convex, which has its maximum at a corner of the region.
    #[must_use]
    pub fn ends_m(&self) -> Vec<[f64; 2]> {
        let [along, across] = self.reaches_m();
        corners(along, across)
    }
    /// Places at which a drop is answered: the ends first and, where a change of velocity limits the part or it has stops, some between.
    /// Whether contacts that overlap are one shock differs from place to place, and so does how often the part hits its stop, so that the
    /// largest demand may lie between the ends.
    #[must_use]
    pub fn places_m(&self) -> Vec<[f64; 2]> {
        places(self.reaches_m(), self.is_largest_between())
    }
    /// Returns the same of a part whose middle is at one place of its ranges.
    #[must_use]
    pub fn places_at_m(&self, at_m: [f64; 2]) -> Vec<[f64; 2]> {
        places(self.reaches_from_m(at_m.map(Spread::finite)), self.is_largest_between())
    }
    fn is_largest_between(&self) -> bool {
        self.stops.is_some() || self.limits.kinds().into_iter().any(LimitKind::is_largest_between)
    }
    /// Returns the range of places where the part may be, along the length and across it.
    #[must_use]
    pub fn reaches_m(&self) -> [[f64; 2]; 2] {
        self.reaches_from_m([self.position_m, self.across_m])
    }
    fn reaches_from_m(&self, [along, across]: [Spread; 2]) -> [[f64; 2]; 2] {
        let reach = |of: Spread, half: f64| [of.lo() - half, of.hi() + half];
        [reach(along, 0.5 * self.extent_m), reach(across, 0.5 * self.extent_across_m)]
    }
    /// Returns how many places lie between its ends along each side.
    #[must_use]
    pub fn between(&self) -> u32 {
        between(self.reaches_m())
    }
}

/// Returns the ends of where a part reaches and, where its demand may be largest there, places between.
#[must_use]
pub fn places(reaches: [[f64; 2]; 2], is_largest_between: bool) -> Vec<[f64; 2]> {
    let [along, across] = reaches;
    let mut places = corners(along, across);
    if is_largest_between {
        let count = between(reaches);
        let all = [along, across].map(|reach| with_between(reach, count));
        let rest = all[1].iter().flat_map(|&y| all[0].iter().map(move |&x| [x, y]));
        let rest: Vec<_> = rest.filter(|place| !places.contains(place)).collect();
        places.extend(rest);
    }
    places
}

/// Returns how many places lie between the ends along each side.
fn between(reaches: [[f64; 2]; 2]) -> u32 {
    let is_rectangle = reaches.iter().all(|[lo, hi]| lo < hi);
    if is_rectangle { BETWEEN_ON_PLATE } else { BETWEEN }
}

/// Returns the corners of a rectangle, of which a side may be none.
pub(crate) fn corners([left, right]: [f64; 2], [front, back]: [f64; 2]) -> Vec<[f64; 2]> {
    let along = if left < right { vec![left, right] } else { vec![left] };
    let mut all: Vec<_> = along.iter().map(|&x| [x, front]).collect();
    if front < back {
        all.extend(along.iter().map(|&x| [x, back]));
    }
    all
}

/// Places between both ends, and between the edges of a part that extends along both sides of a plate.
const BETWEEN: u32 = 7;
const BETWEEN_ON_PLATE: u32 = 2;

/// Returns both ends, and so many places that lie evenly between them; one where both are the same.
fn with_between([lo, hi]: [f64; 2], count: u32) -> Vec<f64> {
    if lo >= hi {
        return vec![lo];
    }
    let between = (1..=count).map(|k| lo + (hi - lo) * f64::from(k) / f64::from(count + 1));
    [lo, hi].into_iter().chain(between).collect()
}

impl Mount {
    /// Returns the suspension at a frequency and a damping ratio; none of a part that is mounted rigidly.
    ///
    /// # Errors
    /// [`Error::Shock`] unless the frequency is finite and positive and the ratio in range.
    pub fn suspension(&self, frequency_hz: f64, damping_ratio: f64) -> Result<Option<Suspension>, Error> {
        match self {
            Self::Hard => Ok(None),
            Self::Suspended { .. } => Ok(Some(Suspension::from_hz(frequency_hz, DampingRatio::new(damping_ratio)?)?)),
        }
    }
}
