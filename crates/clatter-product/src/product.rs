//! This module holds the contents of the product file: a product, its drop and its fragile parts. All values are in SI.
//!
//! Positions run along the bar from its middle, towards end b positive; across a plate from its middle as well.

use clatter::End;
use clatter_flight::{Body, Contact, ContactLaw, Drop, OwnContacts};
use serde::{Serialize, Serializer};

use crate::{Attitude, Base, Component, Error, INPUTS, Law, Reliability, Row, Spread};

/// The least side along a broad face over the thickness of a thin product: a phone has 77 mm over 9 mm.
const THIN: f64 = 8.0;
/// The largest tilt at which a thin body counts as level: friction hardly changes what parts along its thickness get.
pub const LEVEL_RAD: f64 = 10.0 * std::f64::consts::PI / 180.0;
/// The largest friction of products on floors that is taken where the file gives none; rubber may have more.
pub const MOST_FRICTION: f64 = 0.6;

/// A product, its drop and its parts.
#[derive(Debug, Clone, PartialEq)]
pub struct ProductFile {
    /// The product that falls.
    pub product: Product,
    /// The drop, as ranges.
    pub drop: DropRanges,
    /// The drops that it goes through one after the other, all of a box or none: none of a product that falls once, as its drop says.
    pub landings: Vec<Landing>,
    /// The components that must survive; at least one.
    pub components: Vec<Component>,
    /// The measured records; none unless the file names some.
    pub records: Vec<RecordFile>,
    /// The reliability that decides what no search decides, where the file asks for one.
    pub reliability: Option<Reliability>,
}

impl ProductFile {
    /// Returns a product built in code, checked as a file is; without records. Its fields are public: each assessment checks it again.
    ///
    /// # Errors
    /// Those of [`check`](Self::check).
    ///
    /// # Examples
    /// A display on its frame, in a phone that is dropped from a meter at up to 10 degrees:
    /// ```
    /// use clatter_product::{Component, DropRanges, Fall, Law, LimitKind, Limits, Mount, Product, ProductFile, Spread};
    /// use clatter_flight::Body;
    /// let phone = Product::new("phone", Body::new(0.15, 0.045)?, Spread::new(0.3, 0.5, Law::Range)?);
    /// let fall = Fall::HeightM(Spread::value(1.0)?);
    /// let drop = DropRanges::new(fall, Spread::new(0.0, 10_f64.to_radians(), Law::Range)?);
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
    pub fn new(product: Product, drop: DropRanges, components: Vec<Component>) -> Result<Self, Error> {
        let file = Self { product, drop, landings: Vec::new(), components, records: Vec::new(), reliability: None };
        file.check()?;
        Ok(file)
    }
    /// Returns whether it lands on faces, edges and corners.
    #[must_use]
    pub fn is_box(&self) -> bool {
        self.landings.first().is_some_and(|landing| landing.attitude.is_some())
    }
    /// Takes the friction of a box whose file gives none to be any from 0 to 0.6, as of plastics, glass and steel on wood and concrete, where
    /// it counts.
    ///
    /// It hardly does for parts along the thickness of a thin product on a broad face: of phones, tablets and laptops tilted by up to 10°
    /// friction of 0.2 and 0.5 changed their demand by −11 to +2 % in independent integrations. Of thick bodies it was −49 to +37 %.
    pub(crate) fn assume_friction(&mut self) {
        if self.product.friction.is_some() || !self.is_box() {
            return;
        }
        let body = &self.product.body;
        let is_thin = THIN * body.thickness().m() <= body.length_m().min(body.width_m());
        let is_level = |landing: &Landing| {
            let up =
                landing.attitude.zip(body.faces_m()).map_or(0.0, |(attitude, faces_m)| attitude.upward(faces_m)[2]);
            libm::acos(up.abs().min(1.0)) + landing.tolerance_rad() <= LEVEL_RAD
        };
        let is_along = |component: &Component| component.inside.axis == clatter_flight::Axis::Z;
        let counts = !(is_thin && self.landings.iter().all(is_level) && self.components.iter().all(is_along));
        self.product.is_friction_assumed = true;
        self.product.friction = if counts { Spread::new(0.0, MOST_FRICTION, Law::Range).ok() } else { None };
    }
    /// Returns the names of its drops, in order; none of a product that falls once.
    #[must_use]
    pub fn drop_names(&self) -> Vec<DropName> {
        let name =
            |(number, landing): (usize, &Landing)| landing.attitude.map_or(DropName::Number(number), DropName::On);
        (1..).zip(&self.landings).map(name).collect()
    }
    /// Returns one drop of the ranges, each input at the value that is chosen of what the file gives; a bar touches with this end first.
    ///
    /// # Examples
    /// ```
    /// use clatter::End;
    /// use clatter_product::{EXAMPLE, ProductFile};
    /// let file = ProductFile::read(EXAMPLE, "example.toml")?;
    /// let fastest = file.one_drop(End::A, |_, given| given.hi());
    /// assert_eq!(fastest.restitution, file.product.restitution.hi());
    /// # Ok::<(), clatter_product::Faults>(())
    /// ```
    #[must_use]
    pub fn one_drop(&self, first: End, mut choose: impl FnMut(&'static Row, &Spread) -> f64) -> Drop {
        let mut drop = Drop { direction_rad: Drop::towards(first), ..self.product.unset(&self.drop, None) };
        for row in &INPUTS {
            if let (Some(given), Some(set)) = (row.input.given(&self.product, &self.drop), row.set) {
                set(&mut drop, choose(row, &given));
            }
        }
        drop
    }
    /// Returns the drops that are searched one after the other: all that are listed, or the only one.
    #[must_use]
    pub fn listed(&self) -> Vec<Listed> {
        let base = |landing: &Landing| {
            let (faces_m, attitude) = self.product.body.faces_m().zip(landing.attitude)?;
            Some(Base { up: attitude.upward(faces_m), spin_axis: attitude.about() })
        };
        if self.landings.is_empty() {
            return vec![Listed { drop: self.drop, base: None }];
        }
        self.landings.iter().map(|landing| Listed { drop: landing.drop, base: base(landing) }).collect()
    }
    /// Returns all of its drops: those that are listed, or the one.
    #[must_use]
    pub fn drops(&self) -> Vec<DropRanges> {
        if self.landings.is_empty() { vec![self.drop] } else { self.landings.iter().map(|one| one.drop).collect() }
    }
}

/// The product that falls.
#[derive(Debug, Clone, PartialEq)]
pub struct Product {
    /// The name in the file.
    pub name: String,
    /// Its sides, center of mass and inertia, and feet that it lands on; where the radius of gyration has a range, of the middle of it.
    pub body: Body,
    /// Ends, corners or feet with a contact of their own.
    pub own_contacts: OwnContacts,
    /// Radius of gyration about the center of mass, in m.
    pub gyration_m: Spread,
    /// Mass, where the file gives it: it cancels out of every answer.
    pub mass_kg: Option<f64>,
    /// Coefficient of restitution of its ends, within [0, 1].
    pub restitution: Spread,
    /// The time of a lone contact of an end.
    pub contact_time_s: Option<Spread>,
    /// The law of the force of the ground on an end while it touches; where none is named, no limit is decided by one law alone.
    pub contact_law: Option<ContactLaw>,
    /// Coefficient of friction of the ground; none of a product that is followed without.
    pub friction: Option<Spread>,
    /// True where the file does not give the friction, and it is taken to be any that is usual.
    pub is_friction_assumed: bool,
}

impl Product {
    /// Returns a product with one radius of gyration, that of the body; mass, contact time and contact law are not known.
    #[must_use]
    pub fn new(name: impl Into<String>, body: Body, restitution: Spread) -> Self {
        Self {
            name: name.into(),
            body,
            own_contacts: OwnContacts::NONE,
            gyration_m: Spread::finite(body.gyration_m()),
            mass_kg: None,
            restitution,
            contact_time_s: None,
            contact_law: None,
            friction: None,
            is_friction_assumed: false,
        }
    }
    /// Returns the contact law by which drops are followed: the one that is named, else the hysteretic one.
    #[must_use]
    pub fn law(&self) -> ContactLaw {
        self.contact_law.unwrap_or_default()
    }
    /// Returns the shortest and the longest contact of all ranges, where that of the product is known.
    #[must_use]
    pub fn contact_times_s(&self) -> Option<[f64; 2]> {
        let of = |time_s: f64| self.own_contacts.contact_times_s(self.body.points(), time_s);
        self.contact_time_s.as_ref().map(|time| [of(time.lo())[0], of(time.hi())[1]])
    }
    /// Returns the longest contact of each kind: of the product first, unless all have their own, and of others whose time is their own.
    pub fn longest_contacts_s(&self) -> Vec<f64> {
        let Some(time) = &self.contact_time_s else { return Vec::new() };
        let all = self.own_contacts.0[..self.body.points()].iter().map(|own| own.contact_time_s.unwrap_or(time.hi()));
        let mut all: Vec<f64> = all.collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    }
    /// Returns the contacts of its ends or corners by a law, each as stiff and as lively as its ranges have it.
    #[must_use]
    pub fn stiffest(&self, law: ContactLaw) -> Option<Vec<Contact>> {
        let (e, time_s) = (self.restitution.hi(), self.contact_time_s.as_ref()?.lo());
        let all: [Contact; 4] = self.own_contacts.contacts(law, e, time_s).ok()?;
        Some(all[..self.body.points()].to_vec())
    }
    /// Returns the sides from edge to edge, along the length and along the width; 0 across a bar.
    #[must_use]
    pub fn sides_m(&self) -> [f64; 2] {
        self.body.sides_m()
    }
    /// Returns the body with this radius of gyration, in m.
    ///
    /// # Errors
    /// [`Error::Bar`] unless it is finite and positive.
    pub fn body_with(&self, gyration_m: f64) -> Result<Body, Error> {
        Ok(self.body.with_gyration_m(gyration_m)?)
    }
    /// Returns the body at `share` in [0, 1] of the range of its radius of gyration.
    #[must_use]
    pub fn body_at(&self, share: f64) -> Body {
        // Both ends of the range were checked as it was read.
        self.body_with(self.gyration_m.at(share)).unwrap_or(self.body)
    }
}

/// One of the drops that a file lists.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Landing {
    /// The drop, as ranges; a box is tilted by up to so much off its attitude.
    pub drop: DropRanges,
    /// The face, edge or corner on which a box lands; none of a bar and of a plate.
    pub attitude: Option<Attitude>,
    /// The standard that demands it, with clause and title; none of one that was given by hand.
    pub source: Option<&'static str>,
}

/// The name of one of several drops.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DropName {
    /// The face, edge or corner on which a box lands.
    On(Attitude),
    /// The number of a drop of a bar or of a plate in the file, from 1.
    Number(usize),
}

impl DropName {
    /// Returns, of a box, the face, edge or corner on which it lands.
    #[must_use]
    pub fn attitude(self) -> Option<Attitude> {
        if let Self::On(attitude) = self { Some(attitude) } else { None }
    }
    /// Returns, of a bar and of a plate, its number in the file, from 1.
    #[must_use]
    pub fn number(self) -> Option<usize> {
        if let Self::Number(number) = self { Some(number) } else { None }
    }
    /// Returns the words for the drop of an event: `on face bottom`, `in drop 2`.
    #[must_use]
    pub fn there(self) -> String {
        let on = if matches!(self, Self::On(_)) { "on" } else { "in" };
        format!("{on} {self}")
    }
}

impl std::fmt::Display for DropName {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::On(attitude) => attitude.fmt(f),
            Self::Number(number) => write!(f, "drop {number}"),
        }
    }
}

impl Serialize for DropName {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl Landing {
    /// Returns a drop of a bar or of a plate, one of several.
    #[must_use]
    pub fn tilted(drop: DropRanges) -> Self {
        Self { drop, attitude: None, source: None }
    }
    /// Returns the angle by which a box may be turned off its attitude.
    #[must_use]
    pub fn tolerance_rad(&self) -> f64 {
        self.drop.tilt_rad.hi()
    }
    /// Returns whether another drop is the same; the tolerance of the attitude of a box does not count.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        let [one, two] = [self, other].map(|landing| match landing.attitude {
            Some(_) => DropRanges { tilt_rad: Spread::finite(0.0), ..landing.drop },
            None => landing.drop,
        });
        self.attitude == other.attitude && one == two
    }
}

/// The drop of a product, as ranges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DropRanges {
    /// The drop height or the speed.
    pub fall: Fall,
    /// Angle to the ground at the first touch, within [0, π/6] rad.
    pub tilt_rad: Spread,
    /// Angular velocity at the first touch about the axis about which it is tilted, in rad/s: positive where the tilt grows, negative where
    /// it closes; what touches first must still come down.
    pub spin_rad_s: Spread,
    /// The end that touches first; of a plate its direction decides it.
    pub first: First,
    /// The direction to which a plate rises from its lowest corner, in rad from the length towards the width; any direction if none is
    /// given.
    pub direction_rad: Option<Spread>,
    /// Gravity after the first touch; 0 switches it off.
    pub gravity_m_s2: f64,
}

/// The drop's height or the speed that it gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fall {
    /// Height of the lower end before the drop, in m; the speed at the first touch is √(2 g h).
    HeightM(Spread),
    /// Speed of the center of mass at the first touch, in m/s.
    SpeedMS(Spread),
}

/// The end that touches the ground first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum First {
    /// Always this one.
    End(End),
    /// Either end; the worse case counts.
    Either,
}

/// A file in which a drop of the product was measured.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordFile {
    /// Its name, from where the product file is.
    pub file: String,
    /// The drop that was measured; records of one drop share it. A record without is of a drop of its own.
    pub drop: Option<String>,
    /// The place where an acceleration was measured, in m from the middle towards end b.
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
    /// Returns a drop of the ranges as it lands, a box on its posture, whose inputs are still to be set: they are 0.
    #[must_use]
    pub fn unset(&self, drop: &DropRanges, base: Option<Base>) -> Drop {
        Drop {
            is_level: base.is_none(),
            base: base.map_or([0.0, 0.0, 1.0], |base| base.up),
            spin_axis: base.and_then(|base| base.spin_axis),
            gravity_m_s2: drop.gravity_m_s2,
            contact_law: self.law(),
            own_contacts: self.own_contacts,
            ..Drop::new(self.body, 0.0, 0.0, 0.0)
        }
    }
    /// Positions s in [−1, 1] of a place given in m from the middle.
    #[must_use]
    pub fn relative(&self, position_m: f64) -> f64 {
        2.0 * position_m / self.body.length_m()
    }
    /// Returns the inertia ratio (L² − ρ²)/(L² + ρ²) of the product; off center ±√(q_a q_b), that of the symmetric bar with the
    /// same clatter; of the middle of the range of the radius of gyration.
    #[must_use]
    pub fn inertia_ratio(&self) -> f64 {
        ratio(&self.body)
    }
    /// Returns the same at `share` in [0, 1] of the range of the radius of gyration.
    #[must_use]
    pub fn inertia_ratio_at(&self, share: f64) -> f64 {
        ratio(&self.body_at(share))
    }
    /// Returns the plate as flights take it, corner a at (−, −); none of a bar.
    #[must_use]
    pub fn plate(&self) -> Option<clatter_flight::Plate> {
        let (width, [left, right]) = (self.body.width.as_ref()?, self.body.arms_m());
        let [front, back] = width.ends_m;
        let gyration = [self.body.gyration_m(), width.gyration_m];
        let plate = clatter_flight::Plate::new([left, right, front, back], gyration).ok()?;
        plate.with_product_of_inertia(self.body.products_m2[0]).ok()
    }
    /// Returns the product with another inertia ratio: the radius of gyration that has it, the arms as they are.
    ///
    /// # Formula
    /// q² (L_a² + ρ²)(L_b² + ρ²) = (L_a L_b − ρ²)², a quadratic in ρ², whose smaller root has q > 0.
    ///
    /// # Errors
    /// [`Error::Bar`] unless −1 < q ≤ 1.
    pub fn with_inertia_ratio(&self, q: f64) -> Result<Self, Error> {
        clatter::Bar::new(q, 0.0)?;
        let [a, b] = self.body.arms_m();
        let (product, squares) = (a * b, a * a + b * b);
        let less = (1.0 - q) * (1.0 + q);
        let half = product + 0.5 * q * q * squares;
        // half² − (1 − q²)² P², without cancellation for small q
        let root = (0.5 * q * q * squares + product * q * q).max(0.0).sqrt() * (half + product * less).max(0.0).sqrt();
        let larger = half + root;
        let square = if q > 0.0 { product * product * less / larger } else { larger / less };
        let rho = square.sqrt();
        Ok(Self { body: self.body_with(rho)?, gyration_m: Spread::value(rho)?, ..self.clone() })
    }
}

/// Returns the inertia ratio of the symmetric bar with the same clatter.
fn ratio(body: &Body) -> f64 {
    let [a, b] = body.inertia_ratios();
    (a * b).sqrt().copysign(a)
}

impl DropRanges {
    /// Returns a drop on either end, without spin, with standard gravity.
    #[must_use]
    pub fn new(fall: Fall, tilt_rad: Spread) -> Self {
        let (first, gravity_m_s2) = (First::Either, clatter_shock::STANDARD_GRAVITY_M_S2);
        Self { fall, tilt_rad, spin_rad_s: Spread::finite(0.0), first, direction_rad: None, gravity_m_s2 }
    }
    /// Returns the range of speeds at the first touch, in m/s.
    #[must_use]
    pub fn speeds_m_s(&self) -> [f64; 2] {
        match self.fall {
            Fall::HeightM(h) => [h.lo(), h.hi()].map(|h| self.speed_from(h)),
            Fall::SpeedMS(v) => [v.lo(), v.hi()],
        }
    }
    /// Returns whether it may turn as it touches.
    #[must_use]
    pub fn may_spin(&self) -> bool {
        self.spin_rad_s.lo() != 0.0 || self.spin_rad_s.hi() != 0.0
    }
    /// Returns the fastest that it may turn, either way, in rad/s.
    #[must_use]
    pub fn fastest_rad_s(&self) -> f64 {
        self.spin_rad_s.hi().max(-self.spin_rad_s.lo())
    }
    /// Returns √(2 g h).
    #[must_use]
    pub fn speed_from(&self, height_m: f64) -> f64 {
        (2.0 * self.gravity_m_s2 * height_m).sqrt()
    }
    /// Returns the ends that may touch first.
    #[must_use]
    pub fn first_ends(&self) -> &'static [End] {
        match self.first {
            First::End(End::A) => &[End::A],
            First::End(End::B) => &[End::B],
            First::Either => &[End::A, End::B],
        }
    }
}

/// A drop that is searched.
#[derive(Debug, Clone, Copy)]
pub struct Listed {
    /// Its ranges.
    pub drop: DropRanges,
    /// The posture of a box as it lands.
    pub base: Option<Base>,
}

#[cfg(test)]
mod tests {
    use crate::ProductFile;

    /// Where a box may slide it is searched over all usual friction, unless the file gives it; a phone on its broad face is not.
    #[test]
    fn friction_is_assumed_where_it_counts() {
        let of = |thickness: &str, lands: &str, axis: &str, friction: &str| {
            let text = format!(
                "product = {{ name = \"box\", length = \"150 mm\", width = \"77 mm\", thickness = \"{thickness}\", radius_of_gyration = [\"43 mm\", \
                 \"22 mm\"], restitution = 0.3, contact_time = \"0.4 ms\"{friction} }}\ndrop = {{ height = \"1 m\", {lands} }}\n\
                 component = [{{ name = \"part\", position = [\"0 mm\", \"0 mm\"], axis = \"{axis}\", mount = \"hard\", acceleration_limit = \"100 gn\" }}]\n"
            );
            let product =
                ProductFile::read(&text, "box.toml").unwrap_or_else(|faults| panic!("{faults}\n{text}")).product;
            (product.friction.map(|friction| (friction.lo(), friction.hi())), product.is_friction_assumed)
        };
        let bottom = "face = \"bottom\"";
        assert_eq!(of("9 mm", bottom, "z", ""), (None, true));
        assert_eq!(of("9 mm", bottom, "z", ", friction = 0.3"), (Some((0.3, 0.3)), false));
        let some = (Some((0.0, 0.6)), true);
        assert_eq!(of("9 mm", bottom, "x", ""), some);
        assert_eq!(of("9 mm", bottom, "any", ""), some);
        assert_eq!(of("10 mm", bottom, "z", ""), some);
        assert_eq!(of("9 mm", "face = \"top\", attitude_tolerance = \"11 deg\"", "z", ""), some);
        assert_eq!(of("9 mm", "face = \"end-a\"", "z", ""), some);
    }
}
