//! What a product must be to be assessed: the same for one from a file and for one that was built in code.

use std::fmt::Display;

use crate::keys::{self, Key, Kind};
use crate::{Component, Damping, Error, Fall, Mount, Product, ProductFile, Spread};

/// How far the center of mass may lie from the middle, over the length.
pub(crate) const FARTHEST_CENTER: f64 = 0.45;
/// Radius of gyration over the length: less mass at the ends no product has, more beyond them neither.
pub(crate) const GYRATION: [f64; 2] = [0.05, 2.0];
/// Places are compared to this share of the length.
const ROUNDINGS: f64 = 1e-9;

impl ProductFile {
    /// Checks that every value is within what a product file allows.
    ///
    /// # Errors
    /// [`Error::Given`] for the first one that is not.
    ///
    /// # Examples
    /// ```
    /// use clatter_assess::{EXAMPLE, ProductFile, Spread};
    /// let mut file = ProductFile::read(EXAMPLE, "example.toml")?;
    /// assert!(file.check().is_ok());
    /// file.product.restitution = Spread::value(1.7)?;
    /// assert_eq!(file.check().unwrap_err().to_string(), "restitution is 1.7; allowed: from 0 to 1");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn check(&self) -> Result<(), Error> {
        let Self { product, drop, components, .. } = self;
        let body = &product.body;
        one(keys::PRODUCT, "length", body.length_m(), "")?;
        spread(keys::PRODUCT, "restitution", Some(&product.restitution), "")?;
        spread(keys::PRODUCT, "contact_time", product.contact_time_s.as_ref(), "")?;
        if let Some(mass) = product.mass_kg {
            one(keys::PRODUCT, "mass", mass, "")?;
        }
        product.check_body()?;
        match &drop.fall {
            Fall::HeightM(height) => spread(keys::DROP, "height", Some(height), "")?,
            Fall::SpeedMS(speed) => spread(keys::DROP, "speed", Some(speed), "")?,
        }
        spread(keys::DROP, "tilt", Some(&drop.tilt_rad), "")?;
        one(keys::DROP, "gravity", drop.gravity_m_s2, "")?;
        if components.is_empty() {
            return Err(given("number of components", 0, "at least 1"));
        }
        components.iter().try_for_each(|component| component.check(product))
    }
}

impl Product {
    /// Center of mass and radius of gyration within the body.
    pub(crate) fn check_body(&self) -> Result<(), Error> {
        let length = self.body.length_m();
        let [a, b] = self.body.arms_m();
        let center = 0.5 * (a - b);
        if center.is_nan() || center.abs() > FARTHEST_CENTER * length {
            return Err(given("center_of_mass", metres(center), "within 0.45 of the length from the middle"));
        }
        let [least, most] = GYRATION.map(|share| share * length);
        for gyration in [self.gyration_m.lo(), self.gyration_m.hi(), self.body.gyration_m()] {
            if !(least..=most).contains(&gyration) {
                return Err(given("radius_of_gyration", metres(gyration), "from 0.05 to 2 times the length"));
            }
        }
        Ok(())
    }
}

impl Component {
    /// How far it reaches from the middle of the product.
    pub(crate) fn reach_m(&self) -> f64 {
        self.position_m.lo().abs().max(self.position_m.hi().abs()) + 0.5 * self.extent_m
    }

    /// Whether it is within the product.
    pub(crate) fn fits(&self, product: &Product) -> bool {
        self.reach_m() <= 0.5 * product.body.length_m() * (1.0 + ROUNDINGS)
    }

    fn check(&self, product: &Product) -> Result<(), Error> {
        let of = format!(" of component {:?}", self.name);
        let component = |name, value: Option<&Spread>| spread(keys::COMPONENT, name, value, &of);
        component("position", Some(&self.position_m))?;
        one(keys::COMPONENT, "extent", self.extent_m, &of)?;
        if !self.fits(product) {
            return Err(given(&format!("reach{of}"), metres(self.reach_m()), "up to half of the product's length"));
        }
        match &self.mount {
            Mount::Hard if self.limits.rattle_space_m.is_some() => {
                return Err(given(&format!("rattle_space{of}"), "given", "not for a part that is mounted rigidly"));
            }
            Mount::Hard => {}
            Mount::Suspended { frequency_hz, damping } => {
                component("natural_frequency", Some(frequency_hz))?;
                match damping {
                    Damping::Ratio(ratio) => component("damping_ratio", Some(ratio))?,
                    Damping::Quality(quality) => component("quality_factor", Some(quality))?,
                }
            }
        }
        let limits = &self.limits;
        if limits.kinds().is_empty() {
            return Err(given(&format!("number of limits{of}"), 0, "at least 1"));
        }
        component("acceleration_limit", limits.acceleration_m_s2.as_ref())?;
        component("rattle_space", limits.rattle_space_m.as_ref())?;
        component("velocity_change_limit", limits.velocity_change_m_s.as_ref())?;
        component("angular_velocity_change_limit", limits.angular_velocity_change_rad_s.as_ref())?;
        let boundary = limits.damage_boundary.as_ref();
        spread(keys::BOUNDARY, "velocity_change", boundary.map(|boundary| &boundary.velocity_change_m_s), &of)?;
        spread(keys::BOUNDARY, "acceleration", boundary.map(|boundary| &boundary.acceleration_m_s2), &of)
    }
}

fn given(name: &str, value: impl Display, allowed: &str) -> Error {
    Error::Given { name: name.to_owned(), value: value.to_string(), allowed: allowed.to_owned() }
}

fn metres(value: f64) -> String {
    format!("{value} m")
}

/// A range within the bounds of its key.
fn spread(table: &'static [Key], name: &str, value: Option<&Spread>, of: &str) -> Result<(), Error> {
    let ends = value.map_or([None; 2], |value| [Some(value.lo()), Some(value.hi())]);
    ends.into_iter().flatten().try_for_each(|end| one(table, name, end, of))
}

/// A value in SI within the bounds of its key.
fn one(table: &'static [Key], name: &str, value: f64, of: &str) -> Result<(), Error> {
    let Some(Key { kind: Kind::Quantity(dimension, bounds) | Kind::Spread(dimension, bounds), .. }) =
        keys::find(table, name)
    else {
        unreachable!("{name} is a quantity")
    };
    let [lo, hi] = bounds.map(|bound| dimension.value(bound));
    // What was worked out, as an angle from degrees, is a bound but for roundings.
    let most = hi.abs().max(lo.abs()) * 1e-12;
    if (lo - most..=hi + most).contains(&value) {
        return Ok(());
    }
    let si = dimension.units.first().filter(|_| !dimension.plain);
    let unit = si.map_or(String::new(), |unit| format!(" {}", unit.name));
    Err(given(&format!("{name}{of}"), format!("{value}{unit}"), &format!("from {} to {}", bounds[0], bounds[1])))
}
