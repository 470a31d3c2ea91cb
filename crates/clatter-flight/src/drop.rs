//! One drop of a body: how it lies and moves as it touches the ground, and what the ground does to it.

mod levers;
mod points;

use std::f64::consts::{FRAC_PI_2, TAU};

use clatter::End;
use serde::{Deserialize, Serialize};

use crate::block::{Block, BlockDrop};
use crate::body::{Body, Feet, Side};
use crate::contact::{Contact, ContactLaw};
use crate::plate::{Plate, PlateScene};
use crate::profile::Profile;
use crate::scene::Scene;
use crate::{Error, OwnContact, OwnContacts};

pub use levers::Levers;

/// A drop of a body at the moment of its first touch.
///
/// Heights of its places follow from the vertical in its axes, [`up`](Self::up): `base`, turned by the tilt towards the direction.
///
/// # Examples
/// A bar of 150 mm that falls at 4 m/s with its end b 5° higher:
/// ```
/// use clatter_flight::{Body, Drop};
/// let drop = Drop::new(Body::new(0.15, 0.043)?, 4.0, 5_f64.to_radians(), 0.3);
/// assert!((drop.up()[0] - 5_f64.to_radians().sin()).abs() < 1e-15);
/// assert!((drop.gap_m() - 0.15 * 5_f64.to_radians().sin()).abs() < 1e-15);
/// # Ok::<(), clatter_flight::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Drop {
    /// What falls.
    pub body: Body,
    /// Whether it lands near level, as a bar or a plate of small tilt does; else it is a box at real tilt.
    pub is_level: bool,
    /// The vertical in axes of the body, but for the tilt: z of a bar and of a plate.
    pub base: [f64; 3],
    /// Angle by which it is turned off that at the first touch, in rad.
    pub tilt_rad: f64,
    /// Where it rises to from its lowest point, in rad from the length towards end b, towards the width: 0 of a bar whose end a touches
    /// first, π of one whose end b does. Of a box it is the direction of the tilt around the base.
    pub direction_rad: f64,
    /// Whether both ends land as one: instant impacts that are closer than any contact lasts. Every place then gets (1 + e) v at
    /// once, at the first landing and at each that follows, whatever the tilt.
    pub is_flat: bool,
    /// Speed of the center of mass at the first touch, in m/s.
    pub speed_m_s: f64,
    /// Angular velocity at the first touch about the axis of its tilt, in rad/s: positive where the tilt grows, so that what touches first
    /// comes down faster than the center of mass, negative where it closes. Flat drops of instant impacts have none.
    pub spin_rad_s: f64,
    /// The axis of the body about which it turns, where that is not the axis of its tilt.
    pub spin_axis: Option<[f64; 3]>,
    /// Gravity, in m/s².
    pub gravity_m_s2: f64,
    /// Coefficient of restitution.
    pub restitution: f64,
    /// How long a lone contact takes, where that is known.
    pub contact_time_s: Option<f64>,
    /// What the ground does to a point while it touches.
    pub contact_law: ContactLaw,
    /// Ends, corners or feet with a contact of their own.
    pub own_contacts: OwnContacts,
    /// Coefficient of friction of the ground, which a box alone feels.
    #[serde(default)]
    pub friction: f64,
    /// Velocity of the center of mass along x and y of the world, of which a box on ground with friction takes notice.
    #[serde(default)]
    pub slide_m_s: [f64; 2],
    /// The axis x of the world, along the ground, in axes of a box; where none is given, that of the box made level.
    #[serde(default)]
    pub along: Option<[f64; 3]>,
}

/// Which of the engines follows a drop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Engine {
    /// Seen from the side, at real tilt.
    Planar,
    /// A plate of small tilt.
    Level,
    /// A box at real tilt.
    Solid,
}

/// Radius of gyration across the square plate that stands for a bar, over the length: it does not turn about its length.
const ACROSS: f64 = 20.0;
/// A plate is turned about the axis of its tilt where the rest is below this share of its spin.
const ALONG_TILT: f64 = 1e-9;

impl Drop {
    /// A drop of a bar or of a plate near level, end a or corner a first, without spin, in standard gravity, with hysteretic contacts whose
    /// time is not known.
    #[must_use]
    pub fn new(body: Body, speed_m_s: f64, tilt_rad: f64, restitution: f64) -> Self {
        Self {
            body,
            is_level: true,
            base: [0.0, 0.0, 1.0],
            tilt_rad,
            direction_rad: 0.0,
            is_flat: false,
            speed_m_s,
            spin_rad_s: 0.0,
            spin_axis: None,
            gravity_m_s2: STANDARD_GRAVITY_M_S2,
            restitution,
            contact_time_s: None,
            contact_law: ContactLaw::Hysteretic,
            own_contacts: OwnContacts::NONE,
            friction: 0.0,
            slide_m_s: [0.0; 2],
            along: None,
        }
    }
    /// The drop that a scene of a plate has, corner a the lowest one; how long its contacts take is not known.
    ///
    /// # Errors
    /// [`Error::Given`] for a plate whose slopes are those of no tilt.
    pub fn of_plate(scene: &PlateScene, restitution: f64) -> Result<Self, Error> {
        let (plate, [hx, hy]) = (scene.plate(), scene.gaps_m());
        let ([left, right, front, back], [length, width], [kx, ky]) =
            (plate.edges_m(), plate.sides_m(), plate.gyration_m());
        let slopes = [hx / length, hy / width];
        let steepest = libm::hypot(slopes[0], slopes[1]);
        if steepest >= 1.0 {
            let (name, allowed) = ("steepest slope of the plate", "below 1");
            return Err(clatter::Error::Quantity { name, value: steepest, allowed }.into());
        }
        let mut body = Body::off_center(left, right, kx)?.with_width(Side { ends_m: [front, back], gyration_m: ky });
        body.products_m2[0] = plate.product_of_inertia_m2();
        let drop = Self {
            direction_rad: libm::atan2(slopes[1], slopes[0]),
            gravity_m_s2: scene.gravity_m_s2(),
            ..Self::new(body, scene.speed_m_s(), libm::asin(steepest), restitution)
        };
        Ok(drop.with_slope_rates(scene.spin_rad_s()))
    }
    /// The same plate whose slopes along length and width grow at these rates at the first touch, in rad/s.
    #[must_use]
    pub fn with_slope_rates(self, [x, y]: [f64; 2]) -> Self {
        let spins = libm::hypot(x, y);
        if self.tilt_rad == 0.0 && spins > 0.0 {
            // Level, it turns to the direction in which it rises from then on.
            return Self { direction_rad: libm::atan2(y, x), spin_rad_s: spins, ..self };
        }
        let (sin, cos) = libm::sincos(self.direction_rad);
        let is_off = (x * sin - y * cos).abs() > ALONG_TILT * spins;
        let spin_axis = is_off.then(|| [y / spins, -x / spins, 0.0]);
        let spin_rad_s = if is_off { spins } else { spins.copysign(x * cos + y * sin) + 0.0 };
        Self { spin_rad_s, spin_axis, ..self }
    }
    /// The drop of a box as flights take it; how long its contacts take is not known.
    #[must_use]
    pub fn of_block(drop: &BlockDrop, restitution: f64) -> Self {
        let spin = drop.spin_rad_s();
        let spin_rad_s = spin.iter().map(|about| about * about).sum::<f64>().sqrt();
        Self {
            is_level: false,
            base: drop.upward(),
            spin_rad_s,
            spin_axis: (spin_rad_s > 0.0).then(|| spin.map(|about| about / spin_rad_s)),
            gravity_m_s2: drop.gravity_m_s2(),
            friction: drop.friction(),
            along: Some(drop.along()),
            ..Self::new(Body::from(drop.block()), drop.speed_m_s(), 0.0, restitution)
        }
    }
    /// The same drop of the box that a plate of small tilt is, as thick as it is known to be, else thin; none of other bodies and of a plate
    /// on feet, which no box is.
    #[must_use]
    pub fn boxed(&self) -> Option<Self> {
        let is_plate = self.engine() == Engine::Level && self.body.feet.is_none();
        is_plate.then(|| Self { is_level: false, body: self.body.with_thickness(self.body.thickness()), ..*self })
    }
    /// The same drop of a square plate that stands for a bar, two of whose corners land in place of an end.
    pub(crate) fn widened(&self) -> Self {
        if self.body.is_wide() {
            return *self;
        }
        let length_m = self.body.length_m();
        let width = Side { ends_m: [0.5 * length_m; 2], gyration_m: ACROSS * length_m };
        // The mass of a bar lies along its length alone, and its ends are as far below that as it is half thick.
        let thickness = self.body.thickness.map_or([0.0; 2], |thickness| thickness.ends_m);
        let thickness = Side { ends_m: thickness, gyration_m: 0.0 };
        let [a, b, ..] = self.own_contacts.0;
        let body = self.body.with_width(width).with_thickness(thickness);
        Self { body, own_contacts: OwnContacts([a, b, b, a]), ..*self }
    }
    pub(crate) fn engine(&self) -> Engine {
        match (self.body.is_wide(), self.is_level) {
            (false, _) => Engine::Planar,
            (true, true) => Engine::Level,
            (true, false) => Engine::Solid,
        }
    }
    /// Whether it is followed as a box at real tilt.
    #[must_use]
    pub fn is_solid(&self) -> bool {
        self.engine() == Engine::Solid
    }
    /// The vertical in axes of the body.
    #[must_use]
    pub fn up(&self) -> [f64; 3] {
        if self.is_solid() {
            return turned_off(self.base, self.tilt_rad, self.direction_rad);
        }
        let ((sin, cos), [x, y]) = (libm::sincos(self.tilt_rad), self.rises());
        [sin * x, sin * y, cos]
    }
    /// Its angular velocity in axes of the body.
    #[must_use]
    pub fn spin(&self) -> [f64; 3] {
        let about = self.spin_axis.unwrap_or_else(|| {
            if self.is_solid() {
                return turns_off(self.base, self.direction_rad);
            }
            let [x, y] = self.rises();
            [y, -x, 0.0]
        });
        about.map(|about| self.spin_rad_s * about + 0.0)
    }
    /// Cosine and sine of the direction.
    fn rises(&self) -> [f64; 2] {
        let (sin, cos) = libm::sincos(self.direction_rad);
        if self.body.is_wide() { [cos, sin] } else { [1.0_f64.copysign(cos), 0.0] }
    }
    /// The end that touches first; of a plate that of its lowest corner.
    #[must_use]
    pub fn first(&self) -> End {
        if self.signs()[0] < 0.0 { End::B } else { End::A }
    }
    /// The direction of a bar that touches with this end first.
    #[must_use]
    pub fn towards(first: End) -> f64 {
        if first == End::A { 0.0 } else { std::f64::consts::PI }
    }
    /// −1 for the sides that are exchanged, so that what touches first is end a or corner a.
    #[must_use]
    pub fn signs(&self) -> [f64; 2] {
        self.rises().map(|rises| if rises < 0.0 { -1.0 } else { 1.0 })
    }
    /// The least and the largest restitution of its contacts.
    #[must_use]
    pub fn restitutions(&self) -> [f64; 2] {
        let [least, most] = self.own_contacts.restitutions(self.body.points(), self.restitution);
        // Edges beyond feet have the contact of the product.
        let of_edges = self.body.feet.map(|_| self.restitution);
        [of_edges.map_or(least, |e| least.min(e)), of_edges.map_or(most, |e| most.max(e))]
    }
    /// The shortest and the longest of its contacts, where that of the product is known.
    #[must_use]
    pub fn contact_times_s(&self) -> Option<[f64; 2]> {
        let time_s = self.contact_time_s?;
        let [shortest, longest] = self.own_contacts.contact_times_s(self.body.points(), time_s);
        Some(if self.body.feet.is_some() { [shortest.min(time_s), longest.max(time_s)] } else { [shortest, longest] })
    }
    /// The same drop with restitutions changed alike.
    #[must_use]
    pub fn with_restitutions(&self, of: impl Fn(f64) -> f64) -> Self {
        let own_contacts = self.own_contacts.with_restitutions(&of);
        Self { restitution: of(self.restitution), own_contacts, ..*self }
    }
    /// The contacts of its ends, corners or feet, that which touches first in front; those beyond them are of the product.
    pub(crate) fn contacts<const N: usize>(&self) -> Result<[Contact; N], Error> {
        let time_s = self.contact_time_s.ok_or(Error::ContactTime)?;
        let own = self.own_contacts.mirrored(self.signs().map(|sign| sign < 0.0));
        Ok(own.contacts(self.contact_law, self.restitution, time_s)?)
    }
    /// The same of the corners of a box, in the order that a box has.
    pub(crate) fn contacts_of_block(&self) -> Result<[Contact; 8], Error> {
        let time_s = self.contact_time_s.ok_or(Error::ContactTime)?;
        Ok(self.own_contacts.of_box(&Contact::new(self.contact_law, self.restitution, time_s)?)?)
    }
    /// From edge to edge, along the length and along the width; 0 across a bar.
    #[must_use]
    pub fn sides_m(&self) -> [f64; 2] {
        self.body.sides_m()
    }
    /// From the lowest point to the highest, along the body.
    #[must_use]
    pub fn reach_m(&self) -> f64 {
        let [cos, sin] = self.rises().map(f64::abs);
        self.body.length_m() * cos + self.body.width_m() * sin
    }
    /// How far the last point of what lands has to come down.
    #[must_use]
    pub fn gap_m(&self) -> f64 {
        if !self.is_solid() {
            return self.reach_m() * libm::sin(self.tilt_rad);
        }
        let (up, sides) = (self.up(), [self.body.length_m(), self.body.width_m(), self.body.thickness().m()]);
        let rises = [0, 1, 2].map(|axis| sides[axis] * up[axis].abs());
        rises.iter().sum::<f64>() - rises.iter().fold(0.0_f64, |most, rise| most.max(*rise))
    }
    /// How long the clatter takes, about: four times what the raised end needs to come down, and some contacts.
    #[must_use]
    pub fn clatter_s(&self) -> f64 {
        let gap_m = self.gap_m();
        4.0 * (gap_m / self.closing_m_s() + self.contact_times_s().map_or(0.0, |[_, longest]| longest))
    }
    /// How fast the raised end comes down at least, about: a spin that opens the tilt holds it up until the other end strikes.
    fn closing_m_s(&self) -> f64 {
        let held = self.spin_rad_s.max(0.0) * self.reach_m();
        (self.speed_m_s - held).max(0.25 * self.speed_m_s)
    }
    /// Whether the ends land so close after one another that no contact tells them apart: within this time, where that of a contact
    /// is not known.
    #[must_use]
    pub fn lands_as_one(&self, merge_s: f64) -> bool {
        self.contact_time_s.is_none()
            && self.spin_rad_s == 0.0
            && self.body.length_m() * libm::sin(self.tilt_rad) < merge_s * self.speed_m_s
    }
    /// The same drop on ground without friction, on which nothing along it counts.
    #[must_use]
    pub fn without_friction(&self) -> Self {
        Self { friction: 0.0, slide_m_s: [0.0; 2], along: None, ..*self }
    }
    /// The same drop landing flat, without spin.
    #[must_use]
    pub fn flattened(&self) -> Self {
        Self { tilt_rad: 0.0, spin_rad_s: 0.0, is_flat: self.contact_time_s.is_none(), ..*self }
    }
    /// When a box lies as a rule: after all of its bounces and ten times of falling over. One that balances on an edge is left then.
    pub(crate) fn settled_s(&self) -> f64 {
        // The same however the drop is said: about whatever it is tilted and turns.
        let ([length_m, width_m], turned) = (self.sides_m(), Self { spin_rad_s: self.spin_rad_s.abs(), ..*self });
        let reach_m = libm::hypot(length_m, width_m);
        // What it turns with may lift it as well.
        let speed_m_s = libm::hypot(self.speed_m_s, self.spin_rad_s * reach_m);
        let bounces_s = 2.0 * self.restitution / (1.0 - self.restitution) * speed_m_s / self.gravity_m_s2;
        // Without gravity and restitution there are none.
        turned.clatter_s() + bounces_s.max(0.0) + 10.0 * (reach_m / self.gravity_m_s2).sqrt()
    }
    /// When a body has bounced clear: after its clatter and a quarter of the flight of 2 e v0/g.
    #[must_use]
    pub fn clear_s(&self) -> f64 {
        self.clatter_s() + 0.5 * self.restitutions()[0] * self.speed_m_s / self.gravity_m_s2
    }
    /// The same by its liveliest contact.
    #[must_use]
    pub fn bounced_s(&self) -> f64 {
        self.clatter_s() + 0.5 * self.restitutions()[1] * self.speed_m_s / self.gravity_m_s2
    }
    /// The points of a bar that land, that which touches first in front.
    fn profile(&self) -> Result<Profile, Error> {
        let [a, b] = self.body.arms_m();
        let [first, other] = if self.first() == End::A { [a, b] } else { [b, a] };
        let profile = Profile::off_center(first, other, self.body.gyration_m())?;
        let thickness = self.body.thickness.filter(|_| !self.body.is_wide());
        Ok(profile.with_thickness(thickness.map_or(0.0, |thickness| thickness.m()))?)
    }
    /// The drop as flights of bars take it, the end that touches first in front.
    ///
    /// # Errors
    /// [`Error::Given`] for a body or a drop that none is.
    pub fn scene(&self) -> Result<Scene, Error> {
        self.scene_of(self.profile()?)
    }
    /// The drop of a bar on feet, whose edges are further points.
    pub(crate) fn scene_on(&self, feet: &Feet) -> Result<Scene<4>, Error> {
        let ([[first, _], [other, _]], [inset_m, _]) = (self.profile()?.points_m(), feet.inset_m);
        let edge = |x: f64| [x + inset_m.copysign(x), feet.height_m];
        let points_m = [[first, 0.0], [other, 0.0], edge(first), edge(other)];
        self.scene_of(Profile::of_points(points_m, self.body.gyration_m())?)
    }
    fn scene_of<const N: usize>(&self, profile: Profile<N>) -> Result<Scene<N>, Error> {
        let (tilt_deg, gravity_m_s2) = (self.tilt_rad.to_degrees(), self.gravity_m_s2);
        let scene = Scene::new(profile, self.restitution, self.speed_m_s, tilt_deg, gravity_m_s2)?;
        Ok(scene.with_spin(self.spin_rad_s)?)
    }
    /// Vertical velocities of the end that touches first and of the other one, at small tilt.
    #[must_use]
    pub fn approaches_m_s(&self) -> [f64; 2] {
        let [a, b] = self.body.arms_m();
        let [first, other] = if self.first() == End::A { [a, b] } else { [b, a] };
        [-first, other].map(|x| x * self.spin_rad_s - self.speed_m_s)
    }
    /// The drop as flights of plates take it, corner a the lowest one; none of a bar and of a box.
    ///
    /// # Errors
    /// [`Error::Given`] for a plate or a drop that none is.
    pub fn of_level(&self) -> Result<Option<PlateScene>, Error> {
        let width = self.body.width.filter(|_| self.is_level);
        width.map(|width| self.plate_scene(&width)).transpose()
    }
    pub(crate) fn plate_scene(&self, width: &Side) -> Result<PlateScene, Error> {
        let [sx, sy] = self.signs();
        let ordered = |[lo, hi]: [f64; 2], sign: f64| if sign < 0.0 { [hi, lo] } else { [lo, hi] };
        let ([left, right], [front, back]) = (ordered(self.body.arms_m(), sx), ordered(width.ends_m, sy));
        let plate = Plate::new([left, right, front, back], [self.body.gyration_m(), width.gyration_m])?
            .with_product_of_inertia(sx * sy * self.body.products_m2[0])?;
        let scene = PlateScene::new(plate, self.speed_m_s, self.gaps_m(), self.gravity_m_s2)?;
        let thickness = self.body.thickness.map_or(0.0, |thickness| thickness.m());
        Ok(scene.with_spin(self.spin_of_plate())?.with_thickness(thickness))
    }
    /// Heights of the corners next to the lowest one as it touches, along the length and along the width.
    #[must_use]
    pub fn gaps_m(&self) -> [f64; 2] {
        let (rise, [cos, sin]) = (libm::sin(self.tilt_rad), self.rises().map(f64::abs));
        [self.body.length_m() * rise * cos, self.body.width_m() * rise * sin]
    }
    /// How fast the corners next to the lowest one rise, over the side between: along the length and along the width.
    #[must_use]
    pub fn spin_of_plate(&self) -> [f64; 2] {
        if let Some([about_x, about_y, _]) = self.spin_axis {
            let [sx, sy] = self.signs();
            return [-sx * about_y, sy * about_x].map(|rate| self.spin_rad_s * rate + 0.0);
        }
        self.rises().map(|rises| self.spin_rad_s * rises.abs())
    }
    /// The box that falls; of a plate the corners of its bottom alone land, however far they sink in.
    pub(crate) fn block_drop(&self) -> Result<BlockDrop, Error> {
        let width = self.body.width.ok_or(Error::NoBox)?;
        let block = self.body.block(&width, &self.body.thickness(), !self.is_solid())?;
        let (speed, gravity) = (self.speed_m_s, self.gravity_m_s2);
        let drop = if self.is_solid() {
            BlockDrop::upright(block, self.up(), speed, gravity)?
        } else {
            BlockDrop::tilted(block, self.tilt_rad, self.direction_rad % TAU, speed, gravity)?
        };
        let drop = self.along.map_or(Ok(drop), |along| drop.with_along(along))?;
        Ok(drop.with_spin(self.spin())?.with_friction(self.friction)?.with_slide(self.slide_m_s)?)
    }
    /// A later landing of a box: with this vertical in its axes, turning about this axis, its energy over the mass shared between fall, spin and
    /// a slide along the ground, in a direction from x of the box made level. The energy counts from where the center of mass lies on the ground;
    /// none where it does not lift the box into that posture.
    #[must_use]
    pub fn landing(
        &self,
        up: [f64; 3],
        about: [f64; 3],
        energy_m2_s2: f64,
        [fall, spin, slide]: [f64; 3],
        direction_rad: f64,
    ) -> Option<Self> {
        let block = self.as_box()?;
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let height_m = block.corners_m().into_iter().map(|corner| -dot(up, corner)).fold(0.0, f64::max);
        let moves = energy_m2_s2 - self.gravity_m_s2 * height_m;
        let speed = |share: f64, inertia: f64| (2.0 * share * moves / inertia).sqrt();
        let (sin, cos) = libm::sincos(direction_rad);
        let landing = Self {
            base: up,
            tilt_rad: 0.0,
            direction_rad: 0.0,
            speed_m_s: speed(fall, 1.0),
            spin_rad_s: speed(spin, block.inertia_about(about)),
            spin_axis: Some(about),
            slide_m_s: [cos, sin].map(|along| along * speed(slide, 1.0)),
            along: None,
            ..*self
        };
        // One that goes up lands nowhere.
        (moves > 0.0 && landing.block_drop().is_ok()).then_some(landing)
    }
    /// A later landing of a bar or of a plate near level: with this tilt, rising in a direction, its slopes growing in another one, and its
    /// energy over the mass shared between fall and spin. The energy counts from where it lies; none where it does not lift the body so, or
    /// where what is lowest goes up.
    #[must_use]
    pub fn landing_tilted(
        &self,
        tilt_rad: f64,
        direction_rad: f64,
        energy_m2_s2: f64,
        spin: f64,
        turns_rad: f64,
    ) -> Option<Self> {
        let (k, (sin, cos)) = (self.body.gyration_m(), libm::sincos(turns_rad));
        let landing = Self { tilt_rad, direction_rad, spin_rad_s: 0.0, spin_axis: None, ..*self };
        let moves = energy_m2_s2 - self.gravity_m_s2 * landing.center_m();
        let inertia = match self.body.width {
            Some(Side { gyration_m, .. }) => {
                (k * cos).powi(2) + (gyration_m * sin).powi(2) + 2.0 * self.body.products_m2[0] * sin * cos
            }
            None => k * k,
        };
        let [speed_m_s, spins] =
            [(1.0 - spin, 1.0), (spin, inertia)].map(|(share, of)| (2.0 * share * moves / of).sqrt());
        let landing = Self { speed_m_s, ..landing };
        let landing = if self.body.is_wide() {
            landing.with_slope_rates([spins * cos, spins * sin])
        } else {
            // Level, it turns away from the end that it lands on.
            Self { spin_rad_s: if tilt_rad > 0.0 { spins.copysign(cos) } else { spins }, ..landing }
        };
        let lands = |drop: &Self| match drop.body.width {
            Some(width) => drop.plate_scene(&width).is_ok(),
            None => drop.scene().is_ok(),
        };
        (moves > 0.0 && lands(&landing)).then_some(landing)
    }
    /// How high the center of mass of a bar or of a plate is over where it lies, as it touches.
    fn center_m(&self) -> f64 {
        let ([sx, sy], [cos, sin]) = (self.signs(), self.rises().map(f64::abs));
        let first = |[lo, hi]: [f64; 2], sign: f64| if sign < 0.0 { hi } else { lo };
        let across = self.body.width.map_or(0.0, |width| first(width.ends_m, sy));
        let rises = libm::sin(self.tilt_rad) * (first(self.body.arms_m(), sx) * cos + across * sin);
        // The ends of a bar with a thickness are below its middle, and less so as it is tilted.
        let thickness_m = self.body.thickness.filter(|_| !self.body.is_wide()).map_or(0.0, |thickness| thickness.m());
        rises - 0.5 * thickness_m * (1.0 - libm::cos(self.tilt_rad))
    }
    /// The drop of a box that lands on anything, as flights take it; none of a bar and of a plate.
    ///
    /// # Errors
    /// [`Error::Given`] for a box that no body is.
    pub fn of_box(&self) -> Result<Option<BlockDrop>, Error> {
        self.is_solid().then(|| self.block_drop()).transpose()
    }
    /// The box that it is; none of a bar and of a plate, and of a box that no body is.
    pub(crate) fn as_box(&self) -> Option<Block> {
        let width = self.body.width.filter(|_| self.is_solid())?;
        self.body.block(&width, &self.body.thickness(), false).ok()
    }
    /// The same drop without what is across: of the bar along the length, which rises to its other end as the edge does.
    #[must_use]
    pub fn along_length(&self) -> Self {
        let rises = self.gaps_m()[0] / self.body.length_m();
        // Its ends press as the corners of the edge that comes down first.
        let lands = self.own_contacts.mirrored([false, self.signs()[1] < 0.0]);
        let own_contacts = OwnContacts([lands.0[0], lands.0[1], OwnContact::NONE, OwnContact::NONE]);
        // That is how much of its spin lies along the length, at any tilt.
        let spin_rad_s = self.spin_rad_s * libm::cos(self.direction_rad).abs();
        let direction_rad = Self::towards(self.first());
        let body = Body { width: None, thickness: None, products_m2: [0.0; 3], ..self.body };
        Self { body, direction_rad, tilt_rad: libm::asin(rises), spin_rad_s, own_contacts, ..self.without_friction() }
    }
}

/// g, as standards have it.
const STANDARD_GRAVITY_M_S2: f64 = 9.806_65;

/// The vertical of a box that is turned off an attitude by an angle, towards a direction around it.
#[must_use]
pub fn turned_off(upward: [f64; 3], angle_rad: f64, direction_rad: f64) -> [f64; 3] {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    // Two axes across the vertical: from the axis of the box that is farthest from it.
    let far = (0..3).min_by(|a, b| upward[*a].abs().total_cmp(&upward[*b].abs())).unwrap_or(0);
    let mut first = [0.0; 3];
    first[far] = 1.0;
    let along = dot(first, upward);
    let off: [f64; 3] = std::array::from_fn(|i| first[i] - along * upward[i]);
    let size = dot(off, off).sqrt();
    let first = off.map(|x| x / size);
    let second = [
        upward[1] * first[2] - upward[2] * first[1],
        upward[2] * first[0] - upward[0] * first[2],
        upward[0] * first[1] - upward[1] * first[0],
    ];
    let ((sin, cos), (s, c)) = (libm::sincos(angle_rad), libm::sincos(direction_rad));
    std::array::from_fn(|i| cos * upward[i] + sin * (c * first[i] + s * second[i]))
}

/// The axis about which the vertical of a box turns off an attitude towards a direction around it, positive as the angle grows.
fn turns_off(upward: [f64; 3], direction_rad: f64) -> [f64; 3] {
    let [x, y, z] = turned_off(upward, FRAC_PI_2, direction_rad);
    let [a, b, c] = upward;
    [y * c - z * b, z * a - x * c, x * b - y * a]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// However lively and however light, a box lies after a time that is known.
    #[test]
    fn a_box_lies_after_a_time_that_is_known() {
        let side = |m: f64| Side::even(m);
        let body = Body::from(Profile::new(0.15, 0.043).unwrap()).with_width(side(0.07)).with_thickness(side(0.02));
        let drop = Drop { is_level: false, contact_time_s: Some(1e-4), ..Drop::new(body, 3.0, 0.05, 0.4) };
        for (restitution, gravity_m_s2) in [(0.0, 0.0), (0.5, 0.0), (1.0, 9.81), (0.0, 9.81)] {
            let settled_s = Drop { gravity_m_s2, restitution, ..drop }.settled_s();
            assert!(settled_s > 0.3, "{restitution}, {gravity_m_s2}: {settled_s}");
        }
    }
}
