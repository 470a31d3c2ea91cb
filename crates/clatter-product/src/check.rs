//! This module checks that a product can be assessed: the rules are the same for one from a file and for one that was built in code.

use std::collections::HashSet;

use clatter::End;
use clatter_flight::{Axis, Body, ContactLaw, Feet, Side};

use crate::inputs::INPUTS;
use crate::keys::{self, Key, Kind, MOST_COMPONENTS};
use crate::quantity::Source;
use crate::quantity::lacks_contact_time;
use crate::{
    Component, Damping, DataFault, DropRanges, Error, Fall, First, Inside, Landing, Law, LimitKind, Mount, Product,
    ProductFile, RecordFile, Spread,
};

/// Instant impacts that are closer than this are one, unless said otherwise: twice what hard cases press.
pub const MERGE_S: f64 = 1e-3;

/// Feet may lie so far inside the edges, over the side.
pub(crate) const FEET_INSIDE: f64 = 0.4;
/// The largest distance of the center of mass from the middle, over the length.
const FARTHEST_CENTER: f64 = 0.45;
/// Product of inertia over the mass, over the product of both radii of gyration: next to 1 all mass is along one line.
const FARTHEST_LEAN: f64 = 0.99;
/// Radius of gyration over the length: less mass at the ends no product has.
pub const LEAST_GYRATION: f64 = 0.05;
/// Masses and radii of gyration may pass the ends of the body by this share: that of values written to six digits.
pub(crate) const WRITTEN: f64 = 1e-5;
/// Places of parts are compared to this share of the length, radii of gyration of a range to this share of them.
const ROUNDINGS: f64 = 1e-9;

impl ProductFile {
    /// Checks everything that a product file would be refused for. Each function that assesses, scatters, or designs a product calls it.
    ///
    /// # Errors
    /// [`Error::Data`] for the first value that is not allowed, with the component that has it; [`Error::ContactTime`] for a stiff
    /// or hard-mounted part of a product without contact time.
    ///
    /// # Examples
    /// ```
    /// use clatter_product::{EXAMPLE, ProductFile, Spread};
    /// let mut file = ProductFile::read(EXAMPLE, "example.toml")?;
    /// assert!(file.check().is_ok());
    /// file.product.restitution = Spread::value(1.7)?;
    /// let said = file.check().unwrap_err().to_string();
    /// assert_eq!(said, "`restitution` = 1.7 is out of its range; allowed: from 0 to 1");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn check(&self) -> Result<(), Error> {
        inputs(&self.product, &self.drop, false)?;
        self.product.check()?;
        self.drop.check(&self.product)?;
        self.check_landings()?;
        self.check_feet()?;
        if self.product.friction.is_some() && !self.is_box() {
            return Err(DataFault::FrictionOfLevel.into());
        }
        self.check_spin()?;
        self.check_apart(MERGE_S)?;
        number_of_components(self.components.len())?;
        let mut names = HashSet::new();
        for component in &self.components {
            component.check(&self.product)?;
            let box_or_not = component.check_axis(self.is_box());
            box_or_not.map_err(|fault| Error::Data { component: Some(component.name.clone()), fault })?;
            if !names.insert(told_apart(&component.name)) {
                return Err(DataFault::SameName(component.name.clone()).into());
            }
        }
        if self.product.body.is_wide() && !self.records.is_empty() {
            return Err(DataFault::OfPlate { field: "record" }.into());
        }
        if !(self.product.own_contacts.is_none() || self.records.is_empty()) {
            return Err(DataFault::OwnContactsMeasured.into());
        }
        if !(self.landings.is_empty() || self.records.is_empty()) {
            return Err(DataFault::ListMeasured.into());
        }
        Ok(self.records.iter().try_for_each(|record| record.check(&self.product))?)
    }
}

/// Bars and plates are tilted by no more.
pub(crate) const FLAT: [&str; 2] = ["0 deg", "30 deg"];
/// The same, but for roundings.
pub(crate) const STEEPEST_RAD: f64 = std::f64::consts::FRAC_PI_6 * (1.0 + ROUNDINGS);

impl ProductFile {
    fn check_landings(&self) -> Result<(), DataFault> {
        let is_box = self.is_box();
        if is_box && self.product.body.faces_m().is_none() {
            return Err(DataFault::BoxWithoutThickness);
        }
        for (n, (name, landing)) in self.drop_names().into_iter().zip(&self.landings).enumerate() {
            let Landing { drop, attitude, .. } = landing;
            if attitude.is_some() != is_box {
                return Err(DataFault::BoxAndPlate);
            }
            if self.landings[..n].iter().any(|other| other.is_same(landing)) {
                return Err(DataFault::Twice(name));
            }
            if drop.gravity_m_s2.to_bits() != self.drop.gravity_m_s2.to_bits() {
                return Err(DataFault::Gravity);
            }
            if is_box {
                // Its tilt is its tolerance.
                one(keys::DROP, "attitude_tolerance", landing.tolerance_rad())?;
                DropRanges { tilt_rad: Spread::finite(0.0), ..*drop }.check(&self.product)?;
                if drop.direction_rad.is_some() {
                    return Err(DataFault::OfPlate { field: "direction" });
                }
            } else {
                drop.check(&self.product)?;
            }
        }
        Ok(())
    }
    /// Checks that feet touch first, also in the steepest drop.
    fn check_feet(&self) -> Result<(), DataFault> {
        let Some(feet) = &self.product.body.feet else { return Ok(()) };
        if self.is_box() {
            return Err(DataFault::FeetOfBox);
        }
        self.drops().iter().try_for_each(|drop| {
            let (tilt_rad, most_rad) =
                (drop.tilt_rad.hi(), feet.steepest_rad(drop.direction_rad.map(|given| [given.lo(), given.hi()])));
            if tilt_rad > most_rad { Err(DataFault::FeetLow { tilt_rad, most_rad }) } else { Ok(()) }
        })
    }
    /// Refuses contacts that differ where they are to be alike.
    ///
    /// # Errors
    /// [`Error::AlikeContacts`], which names what takes alike contacts alone.
    pub fn check_alike(&self, what: &'static str) -> Result<(), Error> {
        if self.product.own_contacts.is_none() { Ok(()) } else { Err(Error::AlikeContacts(what)) }
    }
    /// Checks that the place that touches first comes down, whatever the spin.
    fn check_spin(&self) -> Result<(), DataFault> {
        self.listed().iter().try_for_each(|one| spin_down(&self.product, &one.drop, one.base.is_some()))
    }
    /// Checks that separate strikes stay separate: without contact time those within a time would be one, which with a spin they are not.
    ///
    /// # Errors
    /// [`DataFault::SpinAsOne`].
    pub fn check_apart(&self, merge_s: f64) -> Result<(), DataFault> {
        if self.product.contact_time_s.is_some() {
            return Ok(());
        }
        let length_m = self.product.body.length_m();
        self.drops().iter().filter(|drop| drop.may_spin()).try_for_each(|drop| {
            let (least_rad, [_, fast]) = (drop.tilt_rad.lo(), drop.speeds_m_s());
            let fastest = fast + drop.fastest_rad_s() * length_m;
            let apart = length_m * libm::sin(least_rad) >= merge_s * fastest && least_rad > 0.0;
            if apart { Ok(()) } else { Err(DataFault::SpinAsOne { merge_s }) }
        })
    }
    /// Refuses a plate where bars alone are taken.
    ///
    /// # Errors
    /// [`Error::OfBars`], which names what takes bars alone.
    pub fn check_bar(&self, what: &'static str) -> Result<(), Error> {
        if self.product.body.is_wide() { Err(Error::OfBars(what)) } else { Ok(()) }
    }
}

impl Product {
    pub(crate) fn check(&self) -> Result<(), DataFault> {
        named(&self.name)?;
        one(keys::PRODUCT, "length", self.body.length_m())?;
        self.mass_kg.map_or(Ok(()), mass)?;
        let inset_m = self.body.feet.map_or(0.0, |feet| feet.inset_m[0]);
        for gyration_m in [self.gyration_m.lo(), self.gyration_m.hi()] {
            body_of(self.body.length_m(), inset_m, self.body.length.center_m(), gyration_m)?;
        }
        let (gyration_m, middle_m) = (self.body.gyration_m(), self.gyration_m.at(0.5));
        if (gyration_m - middle_m).abs() > ROUNDINGS * middle_m {
            return Err(DataFault::OtherGyration { gyration_m, middle_m });
        }
        self.body.feet.as_ref().map_or(Ok(()), |feet| self.check_feet(feet))?;
        if !self.body.is_wide() && (self.body.thickness.is_some() || self.body.products_m2.iter().any(|of| *of != 0.0))
        {
            return Err(DataFault::OfBar { field: "thickness" });
        }
        self.check_own_contacts()?;
        if self.contact_law.is_some() && self.contact_time_s.is_none() {
            return Err(DataFault::LawWithoutTime);
        }
        self.body.width.as_ref().map_or(Ok(()), |width| self.check_width(width))
    }

    fn check_own_contacts(&self) -> Result<(), DataFault> {
        if self.own_contacts.is_none() {
            return Ok(());
        }
        for (at, own) in self.own_contacts.given() {
            if !self.body.is_wide() && !["a", "b"].contains(&at) {
                return Err(DataFault::CornerOfBar(at));
            }
            optional(keys::CONTACT, "restitution", own.restitution)?;
            optional(keys::CONTACT, "contact_time", own.contact_time_s)?;
        }
        if self.contact_time_s.is_none() {
            return Err(DataFault::OwnContactsWithoutTime);
        }
        if self.contact_law == Some(ContactLaw::Hysteretic) { Ok(()) } else { Err(DataFault::OwnContactsLaw) }
    }

    fn check_feet(&self, feet: &Feet) -> Result<(), DataFault> {
        one(keys::PRODUCT, "feet_height", feet.height_m)?;
        for (inset_m, side_m) in feet.inset_m.into_iter().zip(self.sides_m()) {
            one(keys::PRODUCT, "feet_inset", inset_m)?;
            if inset_m > FEET_INSIDE * side_m {
                return Err(DataFault::FeetApart { inset_m, side_m });
            }
        }
        Ok(())
    }

    fn check_width(&self, width: &Side) -> Result<(), DataFault> {
        let width_m = width.m();
        one(keys::PRODUCT, "width", width_m)?;
        let inset_m = self.body.feet.map_or(0.0, |feet| feet.inset_m[1]);
        width_of(width_m, inset_m, width.center_m(), width.gyration_m)?;
        if let Some(thickness) = &self.body.thickness {
            one(keys::PRODUCT, "thickness", thickness.m())?;
            center("thickness", thickness.center_m(), thickness.m())?;
            gyration("thickness", thickness.gyration_m, 0.0, thickness.ends_m)?;
        }
        self.check_products(width)?;
        if self.contact_time_s.is_none() { Err(DataFault::PlateWithoutContactTime) } else { Ok(()) }
    }

    /// Refuses products of inertia that no masses within the body have. Of ∫x y dm, x from −a to b and y from −c to d about the center of
    /// mass, the largest is that of (x + a)(d − y) or (b − x)(y + c), which are nowhere negative, and of both radii of gyration.
    fn check_products(&self, width: &Side) -> Result<(), DataFault> {
        let [x, y] = self.body.feet.map_or([0.0; 2], |feet| feet.inset_m);
        let beyond = |arms_m: [f64; 2], inset_m: f64| arms_m.map(|arm_m| arm_m + inset_m);
        let (along, across) = (beyond(self.body.arms_m(), x), beyond(width.ends_m, y));
        let deep = self.body.thickness.unwrap_or(Side { ends_m: [0.0; 2], gyration_m: 0.0 });
        let faces = deep.ends_m;
        // The least radius leaves the least room.
        let radii_m = [self.gyration_m.lo(), width.gyration_m, deep.gyration_m];
        let products_m2 @ [_, xz, yz] = self.body.products_m2;
        for (product_m2, sides, [one, other], lean) in [
            (products_m2[0], "xy", [(along, radii_m[0]), (across, radii_m[1])], FARTHEST_LEAN),
            (xz, "xz", [(along, radii_m[0]), (faces, radii_m[2])], 1.0),
            (yz, "yz", [(across, radii_m[1]), (faces, radii_m[2])], 1.0),
        ] {
            let (([a, b], k), ([c, d], l)) = (one, other);
            let roundings = WRITTEN * (a + b) * (c + d);
            let allowed_m2 = [-(lean * k * l).min(a * c).min(b * d), (lean * k * l).min(a * d).min(b * c)];
            if !(allowed_m2[0] - roundings..=allowed_m2[1] + roundings).contains(&product_m2) {
                return Err(DataFault::ProductOfInertia { sides, product_m2, allowed_m2 });
            }
        }
        let sides_m = [along, across, faces].map(|[a, b]| if a + b > 0.0 { a + b } else { 1.0 });
        let second = |i: usize, j: usize| match (i, j) {
            _ if i == j => radii_m[i] * radii_m[i],
            _ => products_m2[i + j - 1],
        };
        let shares = nalgebra::Matrix3::from_fn(|i, j| second(i, j) / (sides_m[i] * sides_m[j]));
        if shares.determinant() >= -ROUNDINGS { Ok(()) } else { Err(DataFault::ProductsOfInertia { products_m2 }) }
    }
}

/// Checks that the place that touches first comes down in all drops of the ranges, with a thousandth of the speed at least: of a bar an
/// end, of a plate a corner, of a box any corner.
pub(crate) fn spin_down(product: &Product, drop: &DropRanges, is_box: bool) -> Result<(), DataFault> {
    let [speed_m_s, _] = drop.speeds_m_s();
    let [x, y] = product.body.feet.map_or([0.0; 2], |feet| feet.inset_m);
    let most = |[one, other]: [f64; 2]| one.max(other);
    let arm_m = match &product.body.width {
        None => {
            let [a, b] = product.body.arms_m();
            x + drop.first_ends().iter().map(|end| if *end == End::A { a } else { b }).fold(0.0, f64::max)
        }
        Some(width) => {
            let [along, across] = [x + most(product.body.arms_m()), y + most(width.ends_m)];
            let up = match &drop.direction_rad {
                Some(given) if given.is_value() && !is_box => {
                    let (sin, cos) = libm::sincos(given.lo());
                    along * cos.abs() + across * sin.abs()
                }
                _ => libm::hypot(along, across),
            };
            let deep = product.body.thickness.filter(|_| is_box).map_or(0.0, |thickness| most(thickness.ends_m));
            libm::hypot(up, deep)
        }
    };
    let spin_rad_s = if is_box && drop.spin_rad_s.hi() > -drop.spin_rad_s.lo() {
        drop.spin_rad_s.hi()
    } else {
        drop.spin_rad_s.lo()
    };
    let turned_up = if is_box { spin_rad_s.abs() } else { -spin_rad_s };
    if turned_up * arm_m <= (1.0 - LEAST_APPROACH) * speed_m_s {
        return Ok(());
    }
    Err(DataFault::SpinUp { spin_rad_s, speed_m_s: (1.0 - LEAST_APPROACH) * speed_m_s, arm_m, both: is_box })
}

/// The place that touches first comes down with this share of the speed at least.
const LEAST_APPROACH: f64 = 1e-3;

pub(crate) fn mass(mass_kg: f64) -> Result<(), DataFault> {
    one(keys::PRODUCT, "mass", mass_kg)
}

/// Refuses a center of mass next to an end of a side.
fn center(side: &'static str, center_m: f64, side_m: f64) -> Result<(), DataFault> {
    let is_within = center_m.abs() <= FARTHEST_CENTER * side_m;
    if is_within { Ok(()) } else { Err(DataFault::CenterOfMass { side, center_m, side_m }) }
}

/// Refuses a radius of gyration larger than that of masses at both ends of a side, √(a b), which lie a and b from the center of mass: of
/// all masses between them with this center these have the largest.
fn gyration(side: &'static str, gyration_m: f64, least_m: f64, [a, b]: [f64; 2]) -> Result<(), DataFault> {
    let most_m = (a * b).sqrt();
    let is_possible = (least_m..=most_m * (1.0 + WRITTEN)).contains(&gyration_m);
    if is_possible { Ok(()) } else { Err(DataFault::Gyration { side, gyration_m, allowed_m: [least_m, most_m] }) }
}

/// Refuses what reaches beyond the ends of a side by more than this share of it.
pub(crate) fn within(
    what: &'static str,
    side: &'static str,
    reach_m: f64,
    side_m: f64,
    roundings: f64,
) -> Result<(), DataFault> {
    let half_m = 0.5 * side_m;
    let is_within = reach_m <= half_m * (1.0 + roundings);
    if is_within { Ok(()) } else { Err(DataFault::Outside { what, side, reach_m, half_m }) }
}

/// Returns the largest radius of gyration of masses within a product, about its center of mass.
#[must_use]
pub fn most_gyration_m(product: &Product) -> f64 {
    let inset_m = product.body.feet.map_or(0.0, |feet| feet.inset_m[0]);
    let [a, b] = product.body.arms_m().map(|arm_m| arm_m + inset_m);
    (a * b).sqrt()
}

/// Returns the body with its center of mass so far from the middle, towards end b; the product goes on beyond it by `inset_m`.
pub(crate) fn body_of(length_m: f64, inset_m: f64, center_m: f64, gyration_m: f64) -> Result<Body, DataFault> {
    center("length", center_m, length_m)?;
    let half = 0.5 * length_m;
    let arms_m = [half + center_m, half - center_m];
    let (least_m, ends_m) = (LEAST_GYRATION * length_m, arms_m.map(|arm_m| arm_m + inset_m));
    gyration("length", gyration_m, least_m, ends_m)?;
    let body = if center_m == 0.0 {
        Body::new(length_m, gyration_m)
    } else {
        Body::off_center(arms_m[0], arms_m[1], gyration_m)
    };
    let allowed_m = [least_m, (ends_m[0] * ends_m[1]).sqrt()];
    body.map_err(|_| DataFault::Gyration { side: "length", gyration_m, allowed_m })
}

/// Returns the side across a plate with its center of mass so far from the middle; the product goes on beyond it by `inset_m`.
pub(crate) fn width_of(width_m: f64, inset_m: f64, center_m: f64, gyration_m: f64) -> Result<Side, DataFault> {
    center("width", center_m, width_m)?;
    let half = 0.5 * width_m;
    let ends_m = [half + center_m, half - center_m];
    gyration("width", gyration_m, LEAST_GYRATION * width_m, ends_m.map(|end_m| end_m + inset_m))?;
    Ok(Side { ends_m, gyration_m })
}

impl DropRanges {
    fn check(&self, product: &Product) -> Result<(), DataFault> {
        inputs(product, self, true)?;
        let steepest = self.tilt_rad.hi();
        if steepest > STEEPEST_RAD {
            return Err(DataFault::Value { field: "tilt", value: steepest, unit: "rad", allowed: keys::allowed(FLAT) });
        }
        one(keys::DROP, "gravity", self.gravity_m_s2)?;
        if matches!(self.fall, Fall::HeightM(_)) && self.gravity_m_s2 == 0.0 {
            return Err(DataFault::NoGravity);
        }
        match (product.body.is_wide(), self.first, &self.direction_rad) {
            (true, First::End(_), _) => Err(DataFault::OfPlate { field: "first" }),
            (false, _, Some(_)) => Err(DataFault::OfBar { field: "direction" }),
            _ => Ok(()),
        }
    }
}

/// The words of messages for a part.
const PART: &str = "the component with its extent";

impl Component {
    /// Checks that it moves along an axis that it has.
    pub(crate) fn check_axis(&self, of_box: bool) -> Result<(), DataFault> {
        let Inside { height_m, axis } = self.inside;
        one(keys::COMPONENT, "height", height_m)?;
        if !of_box && height_m != 0.0 {
            return Err(DataFault::OfBar { field: "height" });
        }
        let has = of_box && (axis != Axis::Any || self.mount == Mount::Hard) || axis == Axis::Z;
        if has { Ok(()) } else { Err(DataFault::Axis(axis.name())) }
    }

    /// Refuses a part beyond the faces of the product.
    pub(crate) fn fits(&self, product: &Product) -> Result<(), DataFault> {
        let [length_m, width_m] = product.sides_m();
        let reach = |place: &Spread, extent_m: f64| place.lo().abs().max(place.hi().abs()) + 0.5 * extent_m;
        within(PART, "length", reach(&self.position_m, self.extent_m), length_m, ROUNDINGS)?;
        within(PART, "width", reach(&self.across_m, self.extent_across_m), width_m, ROUNDINGS)?;
        let thickness = product.body.thickness;
        let reach_m = self.inside.height_m.abs();
        thickness.map_or(Ok(()), |side| within(PART, "thickness", reach_m, side.m(), ROUNDINGS))
    }

    /// Checks everything but that its name is its own.
    pub(crate) fn check(&self, product: &Product) -> Result<(), Error> {
        let own = || -> Result<(), DataFault> {
            named(&self.name)?;
            let of = |name, value: Option<&Spread>| spread(keys::COMPONENT, name, value);
            of("position", Some(&self.position_m))?;
            of("position", Some(&self.across_m))?;
            one(keys::COMPONENT, "extent", self.extent_m)?;
            one(keys::COMPONENT, "extent", self.extent_across_m)?;
            self.fits(product)?;
            self.check_mount()?;
            self.check_stops()?;
            if self.limits.kinds().is_empty() {
                return Err(DataFault::NoLimit);
            }
            LimitKind::ALL.into_iter().try_for_each(|kind| self.check_limit(kind))
        };
        own().map_err(|fault| Error::Data { component: Some(self.name.clone()), fault })?;
        let lacks = lacks_contact_time(product, self);
        lacks.map_or(Ok(()), |reason| Err(Error::ContactTime { component: self.name.clone(), reason }))
    }

    fn check_limit(&self, kind: LimitKind) -> Result<(), DataFault> {
        let limit = self.limits.get(kind);
        if kind.source() != Source::Boundary {
            return spread(keys::COMPONENT, kind.key(), limit);
        }
        let critical = self.limits.critical_acceleration_m_s2();
        if limit.is_some() && critical.is_none() {
            return Err(DataFault::NoAcceleration);
        }
        spread(keys::BOUNDARY, "velocity_change", limit)?;
        spread(keys::BOUNDARY, "acceleration", critical)
    }

    /// Checks its stops beside its mount and its rattle space.
    pub(crate) fn check_stops(&self) -> Result<(), DataFault> {
        let Some(stops) = &self.stops else {
            let needs = self.limits.get(LimitKind::StopSpeed).is_some();
            return if needs { Err(DataFault::NoStop) } else { Ok(()) };
        };
        let Mount::Suspended { frequency_hz, .. } = &self.mount else { return Err(DataFault::Hard { field: "stop" }) };
        let keys = ["gap", "contact_time", "restitution"];
        keys.into_iter().zip(stops.ranges()).try_for_each(|(key, range)| spread(keys::STOP, key, Some(range)))?;
        let (gap_m, time_s, period_s) = (stops.gap_m.hi(), stops.contact_time_s.hi(), frequency_hz.lo().recip());
        match self.limits.get(LimitKind::RattleSpace) {
            Some(space) if gap_m > space.hi() => Err(DataFault::StopGap { gap_m, space_m: space.hi() }),
            _ if time_s > period_s => Err(DataFault::StopTime { time_s, period_s }),
            _ => Ok(()),
        }
    }

    fn check_mount(&self) -> Result<(), DataFault> {
        match &self.mount {
            Mount::Hard => {
                let wrong = self.limits.kinds().into_iter().find(|kind| kind.needs_suspension());
                wrong.map_or(Ok(()), |kind| Err(DataFault::Hard { field: kind.key() }))
            }
            Mount::Suspended { frequency_hz, damping } => {
                spread(keys::COMPONENT, "natural_frequency", Some(frequency_hz))?;
                let name = match damping {
                    Damping::Ratio(_) => "damping_ratio",
                    Damping::Quality(_) => "quality_factor",
                };
                spread(keys::COMPONENT, name, Some(damping.spread()))
            }
        }
    }
}

impl RecordFile {
    fn check(&self, product: &Product) -> Result<(), DataFault> {
        optional(keys::RECORD, "position", self.position_m)?;
        optional(keys::RECORD, "sample_rate", self.sample_rate_hz)?;
        optional(keys::RECORD, "timing", self.timing_s)?;
        self.position_m.map_or(Ok(()), |position_m| sensor(position_m, product))
    }
}

/// Checks that an acceleration was measured at a place of the product.
pub(crate) fn sensor(position_m: f64, product: &Product) -> Result<(), DataFault> {
    within("the sensor", "length", position_m.abs(), product.sides_m()[0], ROUNDINGS)
}

pub(crate) fn named(name: &str) -> Result<(), DataFault> {
    if name.trim().is_empty() { Err(DataFault::NoName) } else { Ok(()) }
}

/// Returns the part of a name that distinguishes a component from others: blanks around it do not.
pub(crate) fn told_apart(name: &str) -> &str {
    name.trim_matches(' ')
}

fn number_of_components(count: usize) -> Result<(), DataFault> {
    if (1..=MOST_COMPONENTS).contains(&count) { Ok(()) } else { Err(DataFault::Components(count)) }
}

/// Checks that all numbers of a range or a distribution are within the bounds of its key.
/// Checks the inputs of a drop, or those that all drops share, against their keys.
fn inputs(product: &Product, drop: &DropRanges, of_drop: bool) -> Result<(), DataFault> {
    INPUTS.iter().filter(|row| row.input.is_of_drop() == of_drop).try_for_each(|row| {
        let (table, key) = row.key;
        spread(table, key, row.input.given(product, drop).as_ref())
    })
}

fn spread(table: &'static [Key], name: &'static str, value: Option<&Spread>) -> Result<(), DataFault> {
    let Some(value) = value else { return Ok(()) };
    let own = match value.law() {
        Law::Normal { mean, deviation } => [mean, deviation],
        Law::Value | Law::Range | Law::Uniform | Law::Triangular { .. } => [value.lo(), value.hi()],
    };
    [value.lo(), value.hi()].into_iter().chain(own).try_for_each(|number| one(table, name, number))
}

fn optional(table: &'static [Key], name: &'static str, value: Option<f64>) -> Result<(), DataFault> {
    value.map_or(Ok(()), |value| one(table, name, value))
}

/// Checks that a value in SI is within the bounds of its key.
fn one(table: &'static [Key], name: &'static str, value: f64) -> Result<(), DataFault> {
    let key = keys::find(table, name).map(|key| key.kind.of_side());
    let Some(Kind::Quantity(dimension, bounds) | Kind::Spread(dimension, bounds)) = key else {
        unreachable!("{name} is a quantity")
    };
    if keys::within(dimension, *bounds, value) {
        return Ok(());
    }
    let unit = dimension.si_unit().map_or("", |unit| unit.name);
    Err(DataFault::Value { field: name, value, unit, allowed: keys::allowed(*bounds) })
}
