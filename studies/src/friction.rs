//! What friction of the ground does to a box that falls tilted off its broad face: by tilt, thickness and coefficient.

mod page;

use std::f64::consts::FRAC_PI_2;

use clatter_flight::{Axis, Body, Contact, Drop, Followed, Model, Place, Side, Until};
use clatter_shock::{DampingRatio, Peaked, Pulses, STANDARD_GRAVITY_M_S2, Suspension};
use rayon::prelude::*;

use crate::Error;
pub(crate) use page::files;
pub use page::numbers;

/// Length and width of the box; its mass is spread evenly.
const SIDES_M: [f64; 2] = [0.16, 0.077];
/// Thickness over width.
const THICKNESSES: [f64; 3] = [0.1, 0.3, 1.0];
/// It falls from this height, onto hysteretic contacts.
const HEIGHT_M: f64 = 1.0;
const E: f64 = 0.4;
const CONTACT_S: f64 = 5e-4;
/// Natural frequency and damping ratio of the part.
const PART_HZ: f64 = 100.0;
const ZETA: f64 = 0.05;
/// Coefficients of friction.
pub(crate) const FRICTIONS: [f64; 3] = [0.1, 0.3, 0.6];
/// Tilts off the broad face in degrees, in even steps of their logarithm, and steps of the direction from along the length to along the
/// width.
const TILTS_DEG: [f64; 2] = [1.0, 60.0];
const TILTS: u16 = 36;
const DIRECTIONS: u16 = 18;
/// Tolerance of the drops.
const TOLERANCE: f64 = 0.01;

/// Change of the vertical velocity of the hardest corner by one press, in m/s; acceleration of a part along the thickness and along the
/// length, in m/s².
pub(crate) type Largest = [f64; 3];

/// The first landing of one drop.
#[derive(Debug, Clone, Copy)]
struct Landing {
    corner_m_s: f64,
    /// Acceleration of parts halfway from the center to each corner of the broad faces, along the thickness and along the length.
    parts_m_s2: [[f64; 4]; 2],
}

/// All landings of one tilt.
#[derive(Debug, Clone)]
pub(crate) struct Tilt {
    /// Off the broad face.
    pub(crate) degrees: f64,
    /// The largest of all directions: without friction.
    pub(crate) without: Largest,
    /// With each coefficient.
    pub(crate) with: [Largest; FRICTIONS.len()],
    /// Values with friction over those without, drop by drop: of the hardest corner, of a part along the thickness place by place.
    one_drop: [Vec<f64>; 2],
}

/// A box of one thickness.
#[derive(Debug)]
pub(crate) struct Thickness {
    /// Thickness over width.
    pub(crate) ratio: f64,
    pub(crate) tilts: Vec<Tilt>,
}

impl Landing {
    fn of(body: Body, tilt_rad: f64, direction_rad: f64, friction: f64) -> Result<Self, Error> {
        let drop = Drop {
            is_level: false,
            direction_rad,
            contact_time_s: Some(CONTACT_S),
            friction,
            ..Drop::new(body, (2.0 * STANDARD_GRAVITY_M_S2 * HEIGHT_M).sqrt(), tilt_rad, E)
        };
        let contact = Contact::new(drop.contact_law, E, CONTACT_S)?;
        let followed = Followed::new(&drop, Model::Contacts(contact), TOLERANCE, Until::Lands)?;
        let part = Suspension::from_hz(PART_HZ, DampingRatio::new(ZETA)?)?;
        let [x, y] = SIDES_M.map(|side| 0.25 * side);
        let mut parts_m_s2 = [[0.0; 4]; 2];
        for (axis, places) in [Axis::Z, Axis::X].into_iter().zip(&mut parts_m_s2) {
            for (place, [x, y]) in places.iter_mut().zip([[-x, -y], [x, -y], [x, y], [-x, y]]) {
                let felt = followed.felt(&Place { at_m: [x, y, 0.0], axis });
                let peak = Pulses::of_sections(felt.sections())?.peak_above(&part, Peaked::AccelerationOverOmega, 0.0);
                *place = peak.map_or(0.0, |peak| part.omega() * peak.value.abs());
            }
        }
        Ok(Self { corner_m_s: followed.largest_m_s, parts_m_s2 })
    }
    fn largest(&self) -> Largest {
        let [z, x] = self.parts_m_s2.map(|places| places.into_iter().fold(0.0, f64::max));
        [self.corner_m_s, z, x]
    }
}

/// Returns the largest of some landings. By symmetry one of four parts gets in directions over a right angle what each gets in all.
fn largest(landings: &[Landing]) -> Largest {
    landings.iter().map(Landing::largest).fold([0.0; 3], |most, one| [0, 1, 2].map(|i| f64::max(most[i], one[i])))
}

/// Returns the range of some values.
fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)])
}

impl Tilt {
    fn of(body: Body, degrees: f64) -> Result<Self, Error> {
        let direction = |k: u16| FRAC_PI_2 * f64::from(k) / f64::from(DIRECTIONS);
        let landings = |friction| {
            let one = |k| Landing::of(body, degrees.to_radians(), direction(k), friction);
            (0..=DIRECTIONS).map(one).collect::<Result<Vec<_>, _>>()
        };
        let smooth = landings(0.0)?;
        let mut tilt = Self {
            degrees,
            without: largest(&smooth),
            with: [[0.0; 3]; FRICTIONS.len()],
            one_drop: [Vec::new(), Vec::new()],
        };
        for (with, friction) in tilt.with.iter_mut().zip(FRICTIONS) {
            let rough = landings(friction)?;
            *with = largest(&rough);
            for (rough, smooth) in rough.iter().zip(&smooth) {
                tilt.one_drop[0].push(rough.corner_m_s / smooth.corner_m_s);
                let [rough, smooth] = [rough, smooth].map(|landing| landing.parts_m_s2[0]);
                tilt.one_drop[1].extend(rough.into_iter().zip(smooth).map(|(rough, smooth)| rough / smooth));
            }
        }
        Ok(tilt)
    }
}

/// Returns the box of a thickness over its width.
fn body(ratio: f64) -> Result<Body, Error> {
    let [length, width_m] = SIDES_M;
    let body = Body::new(length, Side::even(length).gyration_m)?;
    Ok(body.with_width(Side::even(width_m)).with_thickness(Side::even(ratio * width_m)))
}

impl Thickness {
    fn of(ratio: f64) -> Result<Self, Error> {
        let (body, [low, high]) = (body(ratio)?, TILTS_DEG);
        let tilt = |k: u16| Tilt::of(body, low * libm::pow(high / low, f64::from(k) / f64::from(TILTS)));
        Ok(Self { ratio, tilts: (0..=TILTS).into_par_iter().map(tilt).collect::<Result<_, _>>()? })
    }
}

/// Returns a box of each thickness.
fn thicknesses() -> Result<Vec<Thickness>, Error> {
    THICKNESSES.into_iter().map(Thickness::of).collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    /// Directions over a right angle are enough: tilted to the other side it is the same drop in a mirror, with other parts.
    #[test]
    fn tilted_the_other_way_parts_change_places() {
        let body = body(0.3).unwrap();
        for friction in [0.0, 0.3] {
            let [one, other] = [0.5, PI - 0.5].map(|direction| Landing::of(body, 0.2, direction, friction).unwrap());
            for ([a, b, c, d], places) in one.parts_m_s2.into_iter().zip(other.parts_m_s2) {
                for (one, other) in [b, a, d, c].into_iter().zip(places) {
                    // The bound is what steps of the integration get wrong.
                    assert!((one / other - 1.0).abs() < 1e-4, "{one} and {other} m/s²");
                }
            }
        }
    }

    /// A box that tilts about its length alone is pushed along its width alone, by friction as well.
    #[test]
    fn a_tilt_across_does_nothing_along() {
        for friction in [0.0, 0.6] {
            let [_, z, x] = Landing::of(body(1.0).unwrap(), 0.3, FRAC_PI_2, friction).unwrap().largest();
            assert!(x < 1e-9 * z, "{x} of {z} m/s²");
        }
    }

    /// The engine has states of its own with friction: with next to none they say what those without say.
    #[test]
    fn next_to_no_friction_does_next_to_nothing() {
        for (ratio, tilt_rad, direction) in [(0.1, 0.05, 0.3), (0.3, 0.3, 0.8), (1.0, 0.9, 1.3)] {
            let body = body(ratio).unwrap();
            let [smooth, rough, rougher] =
                [0.0, 1e-6, 0.1].map(|friction| Landing::of(body, tilt_rad, direction, friction).unwrap().largest());
            let off = |one: Largest| (0..3).map(|i| (one[i] / smooth[i] - 1.0).abs()).fold(0.0, f64::max);
            assert!(off(rough) < 1e-4 && off(rougher) > 1e-2, "{} and {}", off(rough), off(rougher));
        }
    }
}
