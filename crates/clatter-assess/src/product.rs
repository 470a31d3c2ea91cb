//! What the product file says: a product, its drop and its fragile parts. All SI.
//!
//! Positions run along the bar from its middle, towards end b positive; across a plate from its middle as well.

use clatter::End;
use clatter_flight::{Body, ContactLaw};
use clatter_shock::{DampingRatio, Suspension};

use crate::{Attitude, Error, LimitKind, Spread, Unit, units};

/// A product, its drop and its parts.
#[derive(Debug, Clone, PartialEq)]
pub struct ProductFile {
    /// What falls.
    pub product: Product,
    /// How it falls.
    pub drop: Drop,
    /// Of a box, what it lands on, one drop after the other; none of a product that lands as its drop says.
    pub landings: Vec<Landing>,
    /// What must survive; at least one.
    pub components: Vec<Component>,
    /// What was measured; none unless the file names some.
    pub records: Vec<RecordFile>,
}

impl ProductFile {
    /// A product built in code, checked as a file is; without records. Its fields are public: what assesses it checks it again.
    ///
    /// # Errors
    /// Those of [`check`](Self::check).
    ///
    /// # Examples
    /// A display on its frame, in a phone that is dropped from a meter at up to 10 degrees:
    /// ```
    /// use clatter_assess::{Component, Drop, Fall, Law, LimitKind, Limits, Mount, Product, ProductFile, Spread};
    /// use clatter_flight::Body;
    /// let phone = Product::new("phone", Body::new(0.15, 0.045)?, Spread::new(0.3, 0.5, Law::Range)?);
    /// let fall = Fall::HeightM(Spread::value(1.0)?);
    /// let drop = Drop::new(fall, Spread::new(0.0, 10_f64.to_radians(), Law::Range)?);
    /// let limits = Limits::default().with(LimitKind::VelocityChange, Spread::value(12.0)?);
    /// let display = Component::new("display", Spread::value(0.03)?, Mount::Hard, limits);
    /// let file = ProductFile::new(phone.clone(), drop, vec![display.clone()])?;
    /// assert!(file.check().is_ok());
    ///
    /// let long = Component { extent_m: -0.02, ..display };
    /// let said = ProductFile::new(phone, drop, vec![long]).unwrap_err().to_string();
    /// assert_eq!(said, "component \"display\": `extent` = -0.02 m is out of its range; allowed: from 0 mm to 100 m");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(product: Product, drop: Drop, components: Vec<Component>) -> Result<Self, Error> {
        let file = Self { product, drop, landings: Vec::new(), components, records: Vec::new() };
        file.check()?;
        Ok(file)
    }
}

/// What falls.
#[derive(Debug, Clone, PartialEq)]
pub struct Product {
    /// As the file names it.
    pub name: String,
    /// Length, center of mass and radius of gyration; where that has a range, of the middle of it.
    pub body: Body,
    /// What makes a plate of the bar: none of a product that is followed as a bar.
    pub width: Option<Width>,
    /// Radius of gyration about the center of mass, in m.
    pub gyration_m: Spread,
    /// Mass, where the file gives it: it cancels out of every answer.
    pub mass_kg: Option<f64>,
    /// Coefficient of restitution of its ends, within [0, 1].
    pub restitution: Spread,
    /// How long a lone contact of an end takes.
    pub contact_time_s: Option<Spread>,
    /// What the ground does to an end while it touches; where none is named, no limit is decided by one law alone.
    pub contact_law: Option<ContactLaw>,
}

/// The side of a plate across its length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Width {
    /// Distances of the long edges from the center of mass, −y and +y.
    pub edges_m: [f64; 2],
    /// Radius of gyration of the mass along y, √(∫y² dm/m) about the center of mass.
    pub gyration_m: f64,
    /// ∫x y dm/m about the center of mass: 0 where the mass is even about one of the axes.
    pub product_of_inertia_m2: f64,
    /// Thickness, where it is known.
    pub thickness_m: Option<f64>,
}

impl Width {
    /// From edge to edge.
    #[must_use]
    pub fn m(&self) -> f64 {
        self.edges_m[0] + self.edges_m[1]
    }
    /// The smallest radius of gyration about any axis in the plane, that along the length given: by the smaller principal second moment.
    pub(crate) fn least_gyration_m(&self, along_m: f64) -> f64 {
        let ([xx, yy], xy) = ([along_m, self.gyration_m].map(|k| k * k), self.product_of_inertia_m2);
        (0.5 * (xx + yy) - libm::hypot(0.5 * (xx - yy), xy)).max(0.0).sqrt()
    }
    /// Where the center of mass is, from the middle.
    #[must_use]
    pub fn center_m(&self) -> f64 {
        0.5 * (self.edges_m[0] - self.edges_m[1])
    }
}

impl Product {
    /// A product with one radius of gyration, that of the body; mass, contact time and contact law are not known.
    #[must_use]
    pub fn new(name: impl Into<String>, body: Body, restitution: Spread) -> Self {
        Self {
            name: name.into(),
            body,
            width: None,
            gyration_m: Spread::finite(body.gyration_m()),
            mass_kg: None,
            restitution,
            contact_time_s: None,
            contact_law: None,
        }
    }
    /// The same with this range of the radius of gyration, and the body of the middle of it.
    ///
    /// # Errors
    /// [`Error::Bar`] unless that is a radius of gyration.
    pub fn with_gyration(self, gyration_m: Spread) -> Result<Self, Error> {
        Ok(Self { body: self.body_with(gyration_m.at(0.5))?, gyration_m, ..self })
    }
    /// The contact law by which drops are followed: the one that is named, else the hysteretic one.
    #[must_use]
    pub fn law(&self) -> ContactLaw {
        self.contact_law.unwrap_or_default()
    }
    /// Distances of the faces of a box from its center of mass, −x, +x, −y and so on, and its thickness; none without one.
    pub(crate) fn faces_m(&self) -> Option<([[f64; 2]; 3], f64)> {
        let thickness_m = self.width?.thickness_m?;
        Some(([self.body.arms_m(), self.width?.edges_m, [0.5 * thickness_m; 2]], thickness_m))
    }
    /// The body with this radius of gyration, in m.
    ///
    /// # Errors
    /// [`Error::Bar`] unless it is finite and positive.
    pub fn body_with(&self, gyration_m: f64) -> Result<Body, Error> {
        let [a, b] = self.body.arms_m();
        Ok(Body::off_center(a, b, gyration_m)?)
    }
    /// The body at `share` in [0, 1] of the range of its radius of gyration.
    pub(crate) fn body_at(&self, share: f64) -> Body {
        // Both ends of the range were checked as it was read.
        self.body_with(self.gyration_m.at(share)).unwrap_or(self.body)
    }
}

/// A drop of a box on a face, an edge or a corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Landing {
    /// What it lands on.
    pub attitude: Attitude,
    /// The standard that asks for it, with clause and title; none of one that was given by hand.
    pub source: Option<&'static str>,
    /// By how much it may be turned off that, in rad.
    pub tolerance_rad: f64,
    /// From where, or how fast.
    pub fall: Fall,
}

/// Along which axis of a box a part moves and is shaken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Axis {
    /// Along the length.
    X,
    /// Along the width.
    Y,
    /// Along the thickness, as of every bar and plate.
    #[default]
    Z,
    /// The magnitude, of a part that is mounted rigidly.
    Any,
}

impl Axis {
    /// By its name; z of any other word.
    pub(crate) fn of(name: &str) -> Self {
        [Self::X, Self::Y, Self::Any].into_iter().find(|axis| axis.name() == name).unwrap_or_default()
    }
    /// `x`, `y`, `z` or `any`.
    #[must_use]
    pub fn name(self) -> &'static str {
        ["x", "y", "z", "any"][self as usize]
    }
}

/// How a part lies in the thickness of a box.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Inside {
    /// Where its middle is across the thickness, from the middle; 0 of every bar and plate.
    pub height_m: f64,
    /// Along which axis it moves.
    pub axis: Axis,
}

/// How it falls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drop {
    /// From where, or how fast.
    pub fall: Fall,
    /// Angle to the ground at the first touch, within [0, π/6] rad.
    pub tilt_rad: Spread,
    /// Which end touches first; of a plate its direction tells it.
    pub first: First,
    /// Where a plate rises to from its lowest corner, in rad from the length towards the width; any direction if none is given.
    pub direction_rad: Option<Spread>,
    /// Gravity after the first touch; 0 switches it off.
    pub gravity_m_s2: f64,
}

/// The drop's height or the speed that it gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fall {
    /// Height of the lower end before the drop, in m; the speed at the first touch is √(2 g h).
    HeightM(Spread),
    /// Speed at the first touch, in m/s.
    SpeedMS(Spread),
}

/// Which end touches the ground first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum First {
    /// Always this one.
    End(End),
    /// Either end; the worse case counts.
    Either,
}

/// A fragile part.
#[derive(Debug, Clone, PartialEq)]
pub struct Component {
    /// As the file names it.
    pub name: String,
    /// Where its middle is.
    pub position_m: Spread,
    /// How far it extends along the bar, both sides together; 0 for a point.
    pub extent_m: f64,
    /// Where its middle is across a plate; 0 of a bar.
    pub across_m: Spread,
    /// How far it extends across a plate; 0 for a point.
    pub extent_across_m: f64,
    /// How it lies in a box.
    pub inside: Inside,
    /// How it is held.
    pub mount: Mount,
    /// What it stands.
    pub limits: Limits,
    /// Where its limits are from, as the file tells it.
    pub limit_source: Option<String>,
}

/// How a part is held.
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

/// Damping of a suspension, as it was given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Damping {
    /// Damping ratio.
    Ratio(Spread),
    /// Quality factor, 1/(2 damping ratio).
    Quality(Spread),
}

impl Damping {
    /// What was given, a ratio or a quality factor.
    #[must_use]
    pub fn spread(&self) -> &Spread {
        match self {
            Self::Ratio(spread) | Self::Quality(spread) => spread,
        }
    }
    /// The damping ratio for a value of what was given.
    ///
    /// # Errors
    /// [`Error::Shock`] for one out of range.
    pub fn ratio(&self, given: f64) -> Result<DampingRatio, Error> {
        Ok(match self {
            Self::Ratio(_) => DampingRatio::new(given)?,
            Self::Quality(_) => DampingRatio::from_quality_factor(given)?,
        })
    }
    /// The range of damping ratios, from the least.
    #[must_use]
    pub fn ratios(&self) -> [f64; 2] {
        match self {
            Self::Ratio(spread) => [spread.lo(), spread.hi()],
            Self::Quality(spread) => [0.5 / spread.hi(), 0.5 / spread.lo()],
        }
    }
}

/// What a part stands; at least one limit is set. Each is finite and positive. Where one has a range, its least value is held
/// against the worst drop.
///
/// # Examples
/// ```
/// use clatter_assess::{LimitKind, Limits, Spread};
/// let limits = Limits::default()
///     .with(LimitKind::RattleSpace, Spread::value(2e-3)?)
///     .with_damage_boundary(Spread::value(3.0)?, Spread::value(5e3)?);
/// assert_eq!(limits.kinds(), [LimitKind::RattleSpace, LimitKind::DamageBoundary]);
/// # Ok::<(), clatter_assess::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Limits {
    allowed: [Option<Spread>; LimitKind::ALL.len()],
    critical_acceleration_m_s2: Option<Spread>,
}

impl Limits {
    /// The same with what is allowed of a kind, in its SI unit ([`LimitKind::unit`]). A damage boundary needs its acceleration too: see
    /// [`with_damage_boundary`](Self::with_damage_boundary).
    #[must_use]
    pub fn with(mut self, kind: LimitKind, allowed: Spread) -> Self {
        self.allowed[kind as usize] = Some(allowed);
        self
    }
    /// The same with a damage boundary: a shock of the product at the part does damage only beyond both, a velocity change and an
    /// acceleration.
    #[must_use]
    pub fn with_damage_boundary(self, velocity_change_m_s: Spread, acceleration_m_s2: Spread) -> Self {
        let with = self.with(LimitKind::DamageBoundary, velocity_change_m_s);
        Self { critical_acceleration_m_s2: Some(acceleration_m_s2), ..with }
    }
    /// The same without a limit of a kind.
    #[must_use]
    pub fn without(mut self, kind: LimitKind) -> Self {
        self.allowed[kind as usize] = None;
        self
    }
    /// What is allowed of a kind; of a damage boundary the critical velocity change.
    #[must_use]
    pub fn get(&self, kind: LimitKind) -> Option<&Spread> {
        self.allowed[kind as usize].as_ref()
    }
    pub(crate) fn get_mut(&mut self, kind: LimitKind) -> Option<&mut Spread> {
        self.allowed[kind as usize].as_mut()
    }
    /// The critical acceleration of a damage boundary.
    #[must_use]
    pub fn critical_acceleration_m_s2(&self) -> Option<&Spread> {
        self.critical_acceleration_m_s2.as_ref().filter(|_| self.get(LimitKind::DamageBoundary).is_some())
    }
    /// Those that are set, in a fixed order.
    #[must_use]
    pub fn kinds(&self) -> Vec<LimitKind> {
        LimitKind::ALL.into_iter().filter(|kind| self.get(*kind).is_some()).collect()
    }
    /// The unit in which the file gives a limit; of a damage boundary that of its velocity change or, by the SI unit, of its
    /// acceleration.
    #[must_use]
    pub fn unit(&self, kind: LimitKind, si: Unit) -> Option<&'static units::Unit> {
        let spread = if si == kind.unit() { self.get(kind) } else { self.critical_acceleration_m_s2() };
        spread.and_then(Spread::unit)
    }
}

/// A file in which a drop of the product was measured.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordFile {
    /// Its name, from where the product file is.
    pub file: String,
    /// The drop that was measured; records of one drop share it. A record without is of a drop of its own.
    pub drop: Option<String>,
    /// Where an acceleration was measured, in m from the middle towards end b.
    pub position_m: Option<f64>,
    /// Name or number of the column of acceleration.
    pub acceleration: Option<String>,
    /// Units of time and acceleration, where the file does not name them.
    pub units: Option<String>,
    /// Samples a second in Hz, where the file has no times.
    pub sample_rate_hz: Option<f64>,
    /// Standard deviation of the times of strikes, in s.
    pub timing_s: Option<f64>,
}

impl Product {
    /// Positions s in [−1, 1] of a place given in m from the middle.
    #[must_use]
    pub fn relative(&self, position_m: f64) -> f64 {
        2.0 * position_m / self.body.length_m()
    }
    /// Inertia ratio (L² − ρ²)/(L² + ρ²) of the product; off center ±√(q_a q_b), that of the symmetric bar with the
    /// same clatter; of the middle of the range of the radius of gyration.
    #[must_use]
    pub fn inertia_ratio(&self) -> f64 {
        ratio(&self.body)
    }
    /// The same at `share` in [0, 1] of the range of the radius of gyration.
    #[must_use]
    pub fn inertia_ratio_at(&self, share: f64) -> f64 {
        ratio(&self.body_at(share))
    }
}

/// Inertia ratio of the symmetric bar with the same clatter.
fn ratio(body: &Body) -> f64 {
    let [a, b] = body.inertia_ratios();
    (a * b).sqrt().copysign(a)
}

impl Drop {
    /// A drop on either end, with standard gravity.
    #[must_use]
    pub fn new(fall: Fall, tilt_rad: Spread) -> Self {
        let (first, gravity_m_s2) = (First::Either, clatter_shock::STANDARD_GRAVITY_M_S2);
        Self { fall, tilt_rad, first, direction_rad: None, gravity_m_s2 }
    }
    /// The range of speeds at the first touch, in m/s.
    #[must_use]
    pub fn speeds_m_s(&self) -> [f64; 2] {
        match self.fall {
            Fall::HeightM(h) => [h.lo(), h.hi()].map(|h| self.speed_from(h)),
            Fall::SpeedMS(v) => [v.lo(), v.hi()],
        }
    }
    /// √(2 g h).
    #[must_use]
    pub fn speed_from(&self, height_m: f64) -> f64 {
        (2.0 * self.gravity_m_s2 * height_m).sqrt()
    }
    /// The ends that may touch first.
    #[must_use]
    pub fn first_ends(&self) -> &'static [End] {
        match self.first {
            First::End(End::A) => &[End::A],
            First::End(End::B) => &[End::B],
            First::Either => &[End::A, End::B],
        }
    }
}

impl Component {
    /// A part without extent, whose limits are from nowhere that is told.
    #[must_use]
    pub fn new(name: impl Into<String>, position_m: Spread, mount: Mount, limits: Limits) -> Self {
        let (extent_m, across_m, extent_across_m) = (0.0, Spread::finite(0.0), 0.0);
        let (name, inside, limit_source) = (name.into(), Inside::default(), None);
        Self { name, position_m, extent_m, across_m, extent_across_m, inside, mount, limits, limit_source }
    }
    /// The ends of where the part may be, \[x, y\]: one where it is a point, both ends along a bar, the corners of a rectangle on a
    /// plate.
    ///
    /// The worst place is one of them for all but changes of velocity, see [`places_m`](Self::places_m): for one drop the motion of the
    /// body is linear in the position, so is the response to it, and the largest absolute value of linear functions is convex, which
    /// has its maximum at a corner of the region.
    #[must_use]
    pub fn ends_m(&self) -> Vec<[f64; 2]> {
        let [along, across] = self.reaches_m();
        corners(along, across)
    }
    /// Places at which a drop is answered: the ends first and, where a change of velocity limits the part, some between. Whether contacts
    /// that overlap are one shock differs from place to place, so that the largest change of velocity may lie between the ends.
    #[must_use]
    pub fn places_m(&self) -> Vec<[f64; 2]> {
        places(self.reaches_m(), self.limits.kinds())
    }
    /// The same of a part whose middle is at one place of its ranges.
    #[must_use]
    pub fn places_at_m(&self, at_m: [f64; 2]) -> Vec<[f64; 2]> {
        places(self.reaches_from_m(at_m.map(Spread::finite)), self.limits.kinds())
    }
    /// From where to where the part may be along the length and across it.
    pub(crate) fn reaches_m(&self) -> [[f64; 2]; 2] {
        self.reaches_from_m([self.position_m, self.across_m])
    }
    fn reaches_from_m(&self, [along, across]: [Spread; 2]) -> [[f64; 2]; 2] {
        let reach = |of: Spread, half: f64| [of.lo() - half, of.hi() + half];
        [reach(along, 0.5 * self.extent_m), reach(across, 0.5 * self.extent_across_m)]
    }
    /// How many places lie between its ends along each side.
    pub(crate) fn between(&self) -> u32 {
        between(self.reaches_m())
    }
}

/// The ends of where a part reaches and, where a limit of these kinds asks for it, places between.
pub(crate) fn places(reaches: [[f64; 2]; 2], kinds: impl IntoIterator<Item = LimitKind>) -> Vec<[f64; 2]> {
    let [along, across] = reaches;
    let mut places = corners(along, across);
    if kinds.into_iter().any(LimitKind::is_largest_between) {
        let count = between(reaches);
        let all = [along, across].map(|reach| with_between(reach, count));
        let rest = all[1].iter().flat_map(|&y| all[0].iter().map(move |&x| [x, y]));
        let rest: Vec<_> = rest.filter(|place| !places.contains(place)).collect();
        places.extend(rest);
    }
    places
}

/// How many places lie between the ends along each side.
fn between(reaches: [[f64; 2]; 2]) -> u32 {
    let is_rectangle = reaches.iter().all(|[lo, hi]| lo < hi);
    if is_rectangle { BETWEEN_ON_PLATE } else { BETWEEN }
}

/// The corners of a rectangle, of which a side may be none.
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

/// Both ends, and so many places that lie evenly between them; one where both are the same.
fn with_between([lo, hi]: [f64; 2], count: u32) -> Vec<f64> {
    if lo >= hi {
        return vec![lo];
    }
    let between = (1..=count).map(|k| lo + (hi - lo) * f64::from(k) / f64::from(count + 1));
    [lo, hi].into_iter().chain(between).collect()
}

impl Mount {
    /// The suspension at a frequency and a damping ratio; none of a part that is mounted rigidly.
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
