//! A rigid body: its sides, its mass and what it lands on.

use clatter::Error;
use serde::{Deserialize, Serialize};

use crate::block::Block;
use crate::profile::Profile;

/// One side of a body, with the mass along it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Side {
    /// Distances of both ends from the center of mass, the one in the negative direction first.
    pub ends_m: [f64; 2],
    /// Radius of gyration of the mass along the side, √(∫x² dm/m) about the center of mass.
    pub gyration_m: f64,
}

impl Side {
    /// A side of this length over which the mass is spread evenly.
    #[must_use]
    pub fn even(length_m: f64) -> Self {
        Self { ends_m: [0.5 * length_m; 2], gyration_m: length_m / 12_f64.sqrt() }
    }
    /// From end to end.
    #[must_use]
    pub fn m(&self) -> f64 {
        self.ends_m[0] + self.ends_m[1]
    }
    /// The center of mass from the middle.
    #[must_use]
    pub fn center_m(&self) -> f64 {
        0.5 * (self.ends_m[0] - self.ends_m[1])
    }
}

/// Feet or bumpers inside the edges: they touch the ground first, and the product goes on beyond them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Feet {
    /// How far inside the edges, along the length and along the width; 0 across a bar.
    pub inset_m: [f64; 2],
    /// By how much they stand out.
    pub height_m: f64,
}

/// A rigid body that falls: a bar has a length, a plate a width too, a box a thickness.
///
/// On feet the sides are those between the feet, and the body goes on beyond them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// From end a to end b.
    pub length: Side,
    /// From front to back; none of a bar.
    pub width: Option<Side>,
    /// From bottom to top, where it is known.
    pub thickness: Option<Side>,
    /// ∫x y dm/m, ∫x z dm/m and ∫y z dm/m about the center of mass: 0 where the mass is even about the axes.
    pub products_m2: [f64; 3],
    /// Feet inside its edges.
    pub feet: Option<Feet>,
}

/// Thickness over length of a plate whose thickness is not known, where real tilt counts.
pub const THIN: f64 = 0.05;

impl Body {
    /// A bar with its center of mass in the middle: length from end to end and radius of gyration.
    ///
    /// # Errors
    /// As [`Body::off_center`].
    pub fn new(length_m: f64, gyration_m: f64) -> Result<Self, Error> {
        let [a, b] = Profile::new(length_m, gyration_m)?.arms_m();
        Self::off_center(a, b, gyration_m)
    }
    /// A bar with its center of mass at distances `a_m` and `b_m` from ends a and b.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless both arms are in [1e−31, 1e30], the longer at most 10⁶ times the shorter, and the
    /// radius of gyration is 0 or between 10⁻¹² and 10⁶ times the length.
    pub fn off_center(a_m: f64, b_m: f64, gyration_m: f64) -> Result<Self, Error> {
        Ok(Self::from(Profile::off_center(a_m, b_m, gyration_m)?))
    }
    /// The same body with a width: a plate.
    #[must_use]
    pub fn with_width(self, width: Side) -> Self {
        Self { width: Some(width), ..self }
    }
    /// The same body with a thickness.
    #[must_use]
    pub fn with_thickness(self, thickness: Side) -> Self {
        Self { thickness: Some(thickness), ..self }
    }
    /// The same with another radius of gyration along the length.
    ///
    /// # Errors
    /// As [`Body::off_center`].
    pub fn with_gyration_m(self, gyration_m: f64) -> Result<Self, Error> {
        let [a, b] = self.arms_m();
        Ok(Self { length: Self::off_center(a, b, gyration_m)?.length, ..self })
    }
    /// From end to end, or from foot to foot.
    #[must_use]
    pub fn length_m(&self) -> f64 {
        self.length.m()
    }
    /// Distances of ends a and b from the center of mass.
    #[must_use]
    pub fn arms_m(&self) -> [f64; 2] {
        self.length.ends_m
    }
    /// Radius of gyration of the mass along the length.
    #[must_use]
    pub fn gyration_m(&self) -> f64 {
        self.length.gyration_m
    }
    /// From front to back; 0 of a bar.
    #[must_use]
    pub fn width_m(&self) -> f64 {
        self.width.map_or(0.0, |width| width.m())
    }
    /// Whether it has a width, and may turn about its length: no bar.
    #[must_use]
    pub fn is_wide(&self) -> bool {
        self.width.is_some()
    }
    /// How many ends or corners it has, seen from above: two or four.
    #[must_use]
    pub fn points(&self) -> usize {
        if self.is_wide() { 4 } else { 2 }
    }
    /// From edge to edge, along the length and along the width; 0 across a bar.
    #[must_use]
    pub fn sides_m(&self) -> [f64; 2] {
        let [x, y] = self.feet.map_or([0.0; 2], |feet| feet.inset_m);
        [self.length_m() + 2.0 * x, self.width.map_or(0.0, |width| width.m() + 2.0 * y)]
    }
    /// The thickness, or the one that is assumed where none is known.
    #[must_use]
    pub fn thickness(&self) -> Side {
        self.thickness.unwrap_or_else(|| Side::even(THIN * self.length_m()))
    }
    /// Distances of the faces of a box from its center of mass, −x, +x, −y and so on; none of a body whose thickness is not known.
    #[must_use]
    pub fn faces_m(&self) -> Option<[[f64; 2]; 3]> {
        Some([self.length.ends_m, self.width?.ends_m, self.thickness?.ends_m])
    }
    /// Inertia ratios of both ends, as of a bar: minus the jump of the other end over the jump of the striking end.
    #[must_use]
    pub fn inertia_ratios(&self) -> [f64; 2] {
        self.profile().map_or([f64::NAN; 2], |profile| profile.inertia_ratios())
    }
    /// A place from the center of mass, that is given from the middle.
    #[must_use]
    pub fn from_center(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let center = |side: Option<Side>| side.map_or(0.0, |side| side.center_m());
        let [a, b] = self.arms_m();
        [x - 0.5 * (a - b), y - center(self.width), z - center(self.thickness)]
    }
    /// The smallest and the largest radius of gyration about axes in the plane of a plate; those of the length of a bar.
    #[must_use]
    pub fn gyrations_in_plane_m(&self) -> [f64; 2] {
        let along_m = self.gyration_m();
        let Some(width) = &self.width else { return [along_m; 2] };
        let ([xx, yy], xy) = ([along_m, width.gyration_m].map(|k| k * k), self.products_m2[0]);
        let (middle, half) = (0.5 * (xx + yy), libm::hypot(0.5 * (xx - yy), xy));
        [(middle - half).max(0.0).sqrt(), (middle + half).sqrt()]
    }
    /// Its ends seen from the side, which touch the ground as those of a bar.
    ///
    /// # Errors
    /// As [`Body::off_center`].
    pub fn profile(&self) -> Result<Profile, Error> {
        let [a, b] = self.arms_m();
        Profile::off_center(a, b, self.gyration_m())
    }
    /// The box that it is, so thick; `on_bottom` goes on upward, so that the corners of its bottom alone land, however far they sink in.
    pub(crate) fn block(&self, width: &Side, thickness: &Side, on_bottom: bool) -> Result<Block, Error> {
        let [kx, ky, kz] = [self.length.gyration_m, width.gyration_m, thickness.gyration_m];
        let radii = [libm::hypot(ky, kz), libm::hypot(kx, kz), libm::hypot(kx, ky)];
        let [length_m, width_m, thickness_m] = [self.length.m(), width.m(), thickness.m()];
        let height_m = if on_bottom { thickness_m.max(length_m).max(width_m) } else { thickness_m };
        let center_m =
            [self.length.center_m(), width.center_m(), thickness.center_m() + 0.5 * (thickness_m - height_m)];
        Block::new([length_m, width_m, height_m], center_m, radii)?.with_products_of_inertia(self.products_m2)
    }
}

impl From<Profile> for Body {
    /// The bar whose ends these are.
    fn from(profile: Profile) -> Self {
        let length = Side { ends_m: profile.arms_m(), gyration_m: profile.gyration_m() };
        Self { length, width: None, thickness: None, products_m2: [0.0; 3], feet: None }
    }
}

impl From<Block> for Body {
    /// The box, with the mass along its sides.
    fn from(block: Block) -> Self {
        let [a, b, c] = block.gyration_m().map(|about| about * about);
        let along = [(a, b + c), (b, c + a), (c, a + b)].map(|(own, others)| (0.5 * (others - own)).max(0.0).sqrt());
        let (sizes, centers) = (block.size_m(), block.center_of_mass_m());
        let side = |axis: usize| {
            let (half_m, center_m) = (0.5 * sizes[axis], centers[axis]);
            Side { ends_m: [half_m + center_m, half_m - center_m], gyration_m: along[axis] }
        };
        let [length, width, thickness] = [side(0), side(1), side(2)];
        let products_m2 = block.products_of_inertia_m2();
        Self { length, width: Some(width), thickness: Some(thickness), products_m2, feet: None }
    }
}
