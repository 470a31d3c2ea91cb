//! This module makes one drop from numbers, as the options of the command and the arguments of the wheel give them.

use clatter::End;
use clatter_flight::{Block, BlockDrop, Body, ContactLaw, Drop, Plate, Profile, Side};
use clatter_product::{Model, STANDARD_GRAVITY_M_S2};

use crate::Error;

/// The inputs of one drop, in SI units and degrees: each where it is given.
///
/// A length makes a bar, a width with it a plate near level, a thickness with both a box in any orientation. Where there is a drop
/// already, these inputs replace its own.
///
/// # Examples
/// ```
/// use clatter_answer::DropInputs;
/// use clatter_product::{Model, STANDARD_GRAVITY_M_S2};
/// let inputs = DropInputs {
///     length_m: Some(0.15),
///     gyration_m: Some(vec![0.043]),
///     e: Some(0.3),
///     height_m: Some(1.0),
///     tilt_deg: Some(5.0),
///     ..DropInputs::default()
/// };
/// let drop = inputs.drop(Model::FiniteTilt)?;
/// assert!((drop.speed_m_s - (2.0 * 9.806_65_f64).sqrt()).abs() < 1e-15);
/// let text = inputs.drop(Model::Compliant).unwrap_err().to_string();
/// assert_eq!(text, "the drop is not whole: give contact_time_s");
/// # Ok::<(), clatter_answer::Error>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq)]
pub struct DropInputs {
    /// The length of the body from end to end.
    pub length_m: Option<f64>,
    /// The width of a plate or a box.
    pub width_m: Option<f64>,
    /// The thickness of a box, or of a bar that stands on a corner at real tilt.
    pub thickness_m: Option<f64>,
    /// Radii of gyration about the center of mass: along the length of a bar, along both sides of a plate, about the axes of a box.
    pub gyration_m: Option<Vec<f64>>,
    /// Center of mass from the middle in half-sides, along each side.
    pub center_of_mass: Option<Vec<f64>>,
    /// The same of a box in m.
    pub center_of_mass_m: Option<[f64; 3]>,
    /// ∫x y dm/m, ∫x z dm/m and ∫y z dm/m about the center of mass; of a plate the first alone.
    pub product_of_inertia_m2: Option<[f64; 3]>,
    /// Coefficient of restitution.
    pub e: Option<f64>,
    /// Speed of the center of mass at the first touch.
    pub speed_m_s: Option<f64>,
    /// Height of the lowest point before the drop, in place of the speed.
    pub height_m: Option<f64>,
    /// Tilt at the first touch.
    pub tilt_deg: Option<f64>,
    /// The direction in which a plate or a box rises, from its length towards its width.
    pub direction_deg: Option<f64>,
    /// Heights of corners b and d of a plate as a touches, in place of tilt and direction.
    pub gaps_m: Option<[f64; 2]>,
    /// The unit quaternion that turns the axes of a box into those of the world, z upward, in place of tilt and direction.
    pub orientation: Option<[f64; 4]>,
    /// Spin at the first touch: of a bar where its tilt grows, of a plate the rates of both slopes, of a box about its axes.
    pub spin_rad_s: Option<Vec<f64>>,
    /// Gravity; standard gravity unless given.
    pub gravity_m_s2: Option<f64>,
    /// The duration of a lone contact.
    pub contact_time_s: Option<f64>,
    /// The law by which the ground acts during a contact; hysteretic unless given.
    pub contact_law: Option<ContactLaw>,
    /// Coefficient of friction of the ground under a box; none unless given.
    pub friction: Option<f64>,
    /// The end of a bar that touches first; end a unless given.
    pub first: Option<End>,
    /// True where both ends of a bar land at the same instant, without a tilt.
    pub is_flat: bool,
}

/// Largest radius of gyration over the side along it. A body beyond hardly turns, and clatters for hours.
const MOST_GYRATION: f64 = 2.0;

impl DropInputs {
    /// Returns the drop that they say.
    ///
    /// # Errors
    /// [`Error::Missing`] where one is missing that the model needs, [`Error::Input`] for one that no drop has.
    pub fn drop(&self, model: Model) -> Result<Drop, Error> {
        self.over(None, model)
    }

    /// Returns the drop that they say, each that is not given as another drop has it.
    ///
    /// # Errors
    /// As [`drop`](Self::drop).
    pub fn over(&self, base: Option<&Drop>, model: Model) -> Result<Drop, Error> {
        self.check_whole(base, model)?;
        let restitution = self.e.or(base.map(|drop| drop.restitution)).unwrap_or(f64::NAN);
        let gravity_m_s2 = self.gravity_m_s2.or(base.map(|drop| drop.gravity_m_s2)).unwrap_or(STANDARD_GRAVITY_M_S2);
        let drop = if self.is_box() {
            self.box_drop(restitution, self.speed(None, gravity_m_s2)?, gravity_m_s2)?
        } else {
            let body = self.level_body(base.map(|drop| &drop.body))?;
            let fresh = || Drop::new(body, 0.0, 0.0, 0.0);
            let drop = Drop {
                body,
                restitution,
                gravity_m_s2,
                speed_m_s: self.speed(base, gravity_m_s2)?,
                ..base.copied().unwrap_or_else(fresh)
            };
            self.turned(drop, base.is_some())?
        };
        let drop = Drop {
            contact_time_s: self.contact_time_s.or(base.and_then(|drop| drop.contact_time_s)),
            contact_law: self.contact_law.or(base.map(|drop| drop.contact_law)).unwrap_or_default(),
            friction: self.friction.or(base.map(|drop| drop.friction)).unwrap_or_default(),
            ..drop
        };
        if self.friction.is_some() && !drop.is_solid() {
            return Err(Error::input("friction", "it is that of the ground under a box: give width and thickness"));
        }
        // A value that no flight accepts is refused under the name of its input.
        clatter::Restitution::new(drop.restitution).map_err(|error| self.input(error))?;
        drop.of_box().and(drop.of_level()).map_err(|error| self.input(error))?;
        if !drop.body.is_wide() {
            drop.scene().map_err(|error| self.input(error))?;
        }
        Ok(drop)
    }

    /// Returns whether the inputs describe a box in any orientation.
    #[must_use]
    pub fn is_box(&self) -> bool {
        let is_in_space = self.orientation.is_some() || self.center_of_mass_m.is_some();
        self.width_m.is_some() && self.thickness_m.is_some() || is_in_space
    }

    fn check_whole(&self, base: Option<&Drop>, model: Model) -> Result<(), Error> {
        let (is_new, is_wide, is_box) = (base.is_none(), self.width_m.is_some(), self.is_box());
        let tilted = self.tilt_deg.is_some() || self.is_flat;
        let is_turned = tilted || self.orientation.is_some() || self.gaps_m.is_some();
        let rises = !is_wide || self.direction_deg.is_some() || self.tilt_deg == Some(0.0);
        let lasts = self.contact_time_s.or(base.and_then(|drop| drop.contact_time_s));
        let missing = [
            (is_new && self.length_m.is_none(), "length_m"),
            (is_box && self.width_m.is_none(), "width_m"),
            (is_box && self.thickness_m.is_none(), "thickness_m"),
            (is_new && self.gyration_m.is_none(), "gyration_m"),
            (is_new && self.e.is_none(), "e"),
            (is_new && self.speed_m_s.is_none() && self.height_m.is_none(), "speed_m_s or height_m"),
            (is_new && is_box && !is_turned, "orientation or tilt_deg"),
            (
                is_new && !is_box && !tilted && self.gaps_m.is_none(),
                if is_wide { "tilt_deg or gaps_m" } else { "tilt_deg" },
            ),
            (is_new && !is_box && tilted && !rises, "direction_deg"),
            (model == Model::Compliant && lasts.is_none(), "contact_time_s"),
        ];
        let missing: Vec<_> = missing.into_iter().filter(|(is, _)| *is).map(|(_, name)| name).collect();
        if missing.is_empty() { Ok(()) } else { Err(Error::Missing(missing)) }
    }

    fn speed(&self, base: Option<&Drop>, gravity_m_s2: f64) -> Result<f64, Error> {
        if self.speed_m_s.is_some() && self.height_m.is_some() {
            return Err(Error::input("height_m", "the speed says already how fast it comes down"));
        }
        let Some(height_m) = self.height_m else {
            return Ok(self.speed_m_s.or(base.map(|drop| drop.speed_m_s)).unwrap_or(f64::NAN));
        };
        if gravity_m_s2 == 0.0 {
            return Err(Error::input("height_m", "a height needs gravity above 0"));
        }
        if !(1e-30..=1e30).contains(&height_m) {
            return Err(Error::input("height_m", format!("height in m = {height_m:?} is not in [1e-30, 1e30]")));
        }
        Ok((2.0 * gravity_m_s2 * height_m).sqrt())
    }

    /// Returns the values of an input, of which there must be `N`.
    fn values<const N: usize>(given: Option<&Vec<f64>>, name: &'static str) -> Result<Option<[f64; N]>, Error> {
        let Some(given) = given else { return Ok(None) };
        let (takes, means) = [
            ("one value for a bar", "a width makes it a plate"),
            ("two values for a plate", "along its length and its width"),
            ("three values for a box", "along its length, width and thickness"),
        ][N - 1];
        let count = ["no", "one", "two", "three"].get(given.len()).copied().unwrap_or("more");
        let values = <[f64; N]>::try_from(&given[..]);
        values.map(Some).map_err(|_| Error::input(name, format!("{takes}, not {count}: {means}")))
    }

    /// Makes the body of a bar or a plate.
    fn level_body(&self, base: Option<&Body>) -> Result<Body, Error> {
        let is_given = self.length_m.is_some() || self.width_m.is_some() || self.thickness_m.is_some();
        let is_given = is_given || self.gyration_m.is_some() || self.center_of_mass.is_some();
        if let (Some(body), false, None) = (base, is_given, self.product_of_inertia_m2) {
            return Ok(*body);
        }
        let width_m = self.width_m.or(base.and_then(|body| body.width).map(|width| width.m()));
        let Some(width_m) = width_m else { return self.bar(base) };
        if self.thickness_m.is_some() {
            return Err(Error::input("thickness_m", "it is that of a bar or, with a width, of a box"));
        }
        let gyration_m = Self::values::<2>(self.gyration_m.as_ref(), "gyration_m")?;
        let center = Self::values::<2>(self.center_of_mass.as_ref(), "center_of_mass")?;
        let one = |n: usize, m: Option<f64>, base: Option<Side>| {
            side(m, gyration_m.map(|k| k[n]), center.map(|c| c[n]), base)
        };
        let length = one(0, self.length_m, base.map(|body| body.length))?;
        let width = one(1, Some(width_m), base.and_then(|body| body.width))?;
        let stretched = base.map_or(1.0, |body| length.m() / body.length_m());
        let product_m2 = match self.product_of_inertia_m2 {
            Some([_, xz, yz]) if xz != 0.0 || yz != 0.0 => {
                return Err(Error::input("product_of_inertia_m2", "a plate takes one value"));
            }
            Some([xy, ..]) => xy,
            None => base.map_or(0.0, |body| stretched * body.products_m2[0]),
        };
        let edges_m = [length.ends_m[0], length.ends_m[1], width.ends_m[0], width.ends_m[1]];
        let plate = Plate::new(edges_m, [length.gyration_m, width.gyration_m]);
        plate.and_then(|plate| plate.with_product_of_inertia(product_m2)).map_err(|error| self.input(error))?;
        let (thickness, feet) = base.map_or((None, None), |body| (body.thickness, body.feet));
        let [_, xz, yz] = base.map_or([0.0; 3], |body| body.products_m2);
        Ok(Body { length, width: Some(width), thickness, products_m2: [product_m2, xz, yz], feet })
    }

    fn bar(&self, base: Option<&Body>) -> Result<Body, Error> {
        if self.product_of_inertia_m2.is_some() {
            return Err(Error::input("product_of_inertia_m2", "it is that of a plate: give its width"));
        }
        let [gyration_m] = Self::values(self.gyration_m.as_ref(), "gyration_m")?.map_or([None], |[k]| [Some(k)]);
        let [center] = Self::values(self.center_of_mass.as_ref(), "center_of_mass")?.map_or([None], |[c]| [Some(c)]);
        let length = side(self.length_m, gyration_m, center, base.map(|body| body.length))?;
        let profile = Profile::off_center(length.ends_m[0], length.ends_m[1], length.gyration_m);
        let thick = self.thickness_m.filter(|thickness_m| *thickness_m != 0.0);
        let profile = profile.and_then(|profile| profile.with_thickness(thick.unwrap_or(0.0)));
        let body = Body::from(profile.map_err(|error| self.input(error))?);
        Ok(Body { length, thickness: thick.map(Side::even), feet: base.and_then(|body| body.feet), ..body })
    }

    /// Tilts and turns a bar or a plate as it is at the first touch.
    fn turned(&self, mut drop: Drop, is_over: bool) -> Result<Drop, Error> {
        if !drop.body.is_wide() && (self.direction_deg.is_some() || self.gaps_m.is_some()) {
            let name = if self.gaps_m.is_some() { "gaps_m" } else { "direction_deg" };
            return Err(Error::input(name, "it is that of a plate: give its width"));
        }
        if drop.body.is_wide() && (self.is_flat || self.first.is_some()) {
            let name = if self.is_flat { "flat" } else { "first" };
            return Err(Error::input(name, "it is that of a bar: a plate lands flat with a tilt of 0, corner a first"));
        }
        if let Some(first) = self.first {
            drop.direction_rad = Drop::towards(first);
        }
        if let Some(direction_deg) = self.direction_deg {
            if !is_over && !(0.0..=90.0).contains(&direction_deg) {
                let allowed = "is not in [0, 90]: else it is not corner a that touches first";
                return Err(Error::input(
                    "direction_deg",
                    format!("direction in degrees = {direction_deg:?} {allowed}"),
                ));
            }
            drop.direction_rad = direction_deg.to_radians();
        }
        if let Some(tilt_deg) = self.tilt_deg {
            drop.tilt_rad = tilt_deg.to_radians();
        }
        if let Some(gaps_m) = self.gaps_m {
            let [x, y] = [gaps_m[0] / drop.body.length_m(), gaps_m[1] / drop.body.width_m()];
            let steepest = libm::hypot(x, y);
            if !(x >= 0.0 && y >= 0.0 && steepest < 1.0) {
                let allowed = "0 or more, and below the side along which it rises: together a tilt below 90 degrees";
                return Err(Error::input("gaps_m", format!("gaps in m = {gaps_m:?} are not {allowed}")));
            }
            (drop.tilt_rad, drop.direction_rad) = (libm::asin(steepest), libm::atan2(y, x));
        }
        if self.is_flat {
            (drop.is_flat, drop.tilt_rad, drop.spin_rad_s) = (true, 0.0, 0.0);
        }
        let Some(spin) = &self.spin_rad_s else { return Ok(drop) };
        if !drop.body.is_wide() {
            let [spin_rad_s] = Self::values(Some(spin), "spin_rad_s")?.unwrap_or_default();
            return Ok(Drop { spin_rad_s, ..drop });
        }
        Ok(drop.with_slope_rates(Self::values(Some(spin), "spin_rad_s")?.unwrap_or_default()))
    }

    fn box_drop(&self, restitution: f64, speed_m_s: f64, gravity_m_s2: f64) -> Result<Drop, Error> {
        let radii_m = Self::values::<3>(self.gyration_m.as_ref(), "gyration_m")?.unwrap_or([f64::NAN; 3]);
        if self.is_flat || self.first.is_some() || self.gaps_m.is_some() {
            let name = if self.is_flat {
                "flat"
            } else if self.first.is_some() {
                "first"
            } else {
                "gaps_m"
            };
            return Err(Error::input(name, "it does not go with a box: an orientation says how it lands"));
        }
        // The sides are given, as was checked before.
        let size_m = [self.length_m, self.width_m, self.thickness_m].map(|side| side.unwrap_or(f64::NAN));
        let center = Self::values::<3>(self.center_of_mass.as_ref(), "center_of_mass")?;
        let center_m = center.map(|center| std::array::from_fn(|axis| 0.5 * size_m[axis] * center[axis]));
        let center_m = self.center_of_mass_m.or(center_m).unwrap_or_default();
        let block = Block::new(size_m, center_m, radii_m);
        let products_m2 = self.product_of_inertia_m2.unwrap_or_default();
        let block = block.and_then(|block| block.with_products_of_inertia(products_m2));
        let block = block.map_err(|error| self.input(error))?;
        let lands = match (self.orientation, self.tilt_deg) {
            (Some(_), Some(_)) => {
                return Err(Error::input("tilt_deg", "the orientation says already how the box is turned"));
            }
            (Some(orientation), None) => BlockDrop::new(block, orientation, speed_m_s, gravity_m_s2),
            (None, tilt_deg) => {
                let [tilt, direction] = [tilt_deg, self.direction_deg].map(|angle| angle.unwrap_or(0.0).to_radians());
                BlockDrop::tilted(block, tilt, direction, speed_m_s, gravity_m_s2)
            }
        };
        let spin = Self::values::<3>(self.spin_rad_s.as_ref(), "spin_rad_s")?.unwrap_or_default();
        let lands = lands.and_then(|drop| drop.with_spin(spin)).map_err(|error| self.input(error))?;
        Ok(Drop::of_block(&lands, restitution))
    }

    /// Makes the error that names the refused input.
    fn input(&self, error: impl Into<clatter_flight::Error>) -> Error {
        let reason = match error.into() {
            clatter_flight::Error::Given(reason) => reason,
            error => return error.into(),
        };
        let name = match &reason {
            clatter::Error::Restitution { .. } => "e",
            clatter::Error::Quantity { name, .. } => {
                let fields = [
                    ("speed", if self.speed_m_s.is_some() { "speed_m_s" } else { "height_m" }),
                    ("tilt", "tilt_deg"),
                    ("direction", "direction_deg"),
                    ("height of corner", "gaps_m"),
                    ("length of the quaternion", "orientation"),
                    ("velocity of the lowest corner", "spin_rad_s"),
                    ("friction", "friction"),
                    ("contact time", "contact_time_s"),
                    ("gravity", "gravity_m_s2"),
                    ("spin", "spin_rad_s"),
                    ("thickness", "thickness_m"),
                    ("product", "product_of_inertia_m2"),
                    ("radius", "gyration_m"),
                    ("center", "center_of_mass"),
                    ("ratio of the arms", "center_of_mass"),
                ];
                fields.into_iter().find(|(begins, _)| name.starts_with(begins)).map_or("length_m", |(_, field)| field)
            }
            _ => "length_m",
        };
        Error::input(name, reason.to_string())
    }
}

/// Makes a side of this length with its mass, over another side: values that are not given are scaled with the length.
fn side(m: Option<f64>, gyration_m: Option<f64>, center: Option<f64>, base: Option<Side>) -> Result<Side, Error> {
    let m = m.or(base.map(|side| side.m())).unwrap_or(f64::NAN);
    let center = center.or(base.map(|side| 2.0 * side.center_m() / side.m())).unwrap_or(0.0);
    if center.is_nan() || center.abs() >= 1.0 {
        let (name, allowed) = ("center of mass", "in (-1, 1), between the edges");
        return Err(Error::input(
            "center_of_mass",
            clatter::Error::Quantity { name, value: center, allowed }.to_string(),
        ));
    }
    let own = base.map(|side| side.gyration_m * (m / side.m()));
    let gyration_m = gyration_m.or(own).unwrap_or(f64::NAN);
    let most = MOST_GYRATION * m;
    if gyration_m.is_finite() && gyration_m > most {
        let [k, most] = [gyration_m, most].map(|m| crate::figures(1e3 * m));
        let reason = format!(
            "radius of gyration {k} mm: at most {most} mm here, twice the side along it; two masses at its ends have 0.5"
        );
        return Err(Error::input("gyration_m", reason));
    }
    Ok(Side { ends_m: [0.5 * m * (1.0 + center), 0.5 * m * (1.0 - center)], gyration_m })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A value that no drop has is refused under the name of its own input.
    #[test]
    fn a_refused_value_is_named() {
        let whole = DropInputs {
            length_m: Some(0.15),
            width_m: Some(0.07),
            thickness_m: Some(0.02),
            gyration_m: Some(vec![0.022, 0.044, 0.048]),
            e: Some(0.3),
            speed_m_s: Some(3.0),
            orientation: Some([1.0, 0.0, 0.0, 0.0]),
            contact_time_s: Some(4e-4),
            ..DropInputs::default()
        };
        assert!(whole.drop(Model::Compliant).is_ok());
        // Half-sides and meters say the same place.
        let [halves, meters] = [
            DropInputs { center_of_mass: Some(vec![0.2, -0.1, 0.3]), ..whole.clone() },
            DropInputs { center_of_mass_m: Some([0.015, -0.0035, 0.003]), ..whole.clone() },
        ]
        .map(|inputs| inputs.drop(Model::Compliant).unwrap().body);
        for (one, other) in
            halves.faces_m().unwrap().as_flattened().iter().zip(meters.faces_m().unwrap().as_flattened())
        {
            assert!((one - other).abs() < 1e-15, "{halves:?}, not {meters:?}");
        }
        assert!((halves.length.center_m() - 0.015).abs() < 1e-15, "{halves:?}");
        let wrong = [
            ("orientation", DropInputs { orientation: Some([2.0, 0.0, 0.0, 0.0]), ..whole.clone() }),
            (
                "spin_rad_s",
                DropInputs {
                    orientation: None,
                    tilt_deg: Some(10.0),
                    direction_deg: Some(30.0),
                    spin_rad_s: Some(vec![0.0, 200.0, 0.0]),
                    ..whole.clone()
                },
            ),
            ("gravity_m_s2", DropInputs { gravity_m_s2: Some(-1.0), ..whole.clone() }),
            ("speed_m_s", DropInputs { speed_m_s: Some(-3.0), ..whole.clone() }),
            ("e", DropInputs { e: Some(1.5), ..whole.clone() }),
            ("gyration_m", DropInputs { gyration_m: Some(vec![0.0, 0.044, 0.048]), ..whole.clone() }),
            ("length_m", DropInputs { length_m: Some(-0.15), ..whole }),
        ];
        for (input, drop) in wrong {
            let error = drop.drop(Model::Compliant).unwrap_err();
            assert!(matches!(&error, Error::Input { name, .. } if *name == input), "{input}: {error:?}");
        }
    }
}
