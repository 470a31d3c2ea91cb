//! A single drop of a bar, followed by one of four models, or of a plate whose contacts take time.

mod edges;
mod followed;

use std::f64::consts::TAU;

use clatter::End;
use clatter_flight::{Block, BlockDrop, Body, Contact, ContactLaw, Model as Physics, Plate, PlateScene, Scene};
use serde::Serialize;

use crate::assess::THIN;
use crate::attitude::{turned_off, turns_off};
use crate::course::Course;
use crate::engine::Spot;
use crate::{Axis, Depth, Error, Feet, OwnContacts, Width};

pub(crate) use followed::{Followed, PRECISION, Until};

/// How a drop is answered: from the least physics to the most.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Model {
    /// In closed form, small tilt and no gravity: the whole clatter as one change of velocity. A part that is slow beside it
    /// feels no more.
    NetChange,
    /// In closed form, likewise: the largest velocity shock alone. A damped part that is fast beside the gaps feels no more.
    LargestShock,
    /// Instant impacts, strike by strike, small tilt, no gravity.
    Map,
    /// With gravity.
    Ballistic,
    /// With gravity and exact geometry.
    FiniteTilt,
    /// With contacts that take time.
    Compliant,
}

impl Model {
    /// Those that follow a drop strike by strike.
    pub const FOLLOWED: [Self; 4] = [Self::Map, Self::Ballistic, Self::FiniteTilt, Self::Compliant];
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::NetChange, Self::LargestShock, Self::Map, Self::Ballistic, Self::FiniteTilt, Self::Compliant];
    /// `net-change`, `largest-shock`, `map`, `ballistic`, `finite-tilt` or `compliant`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::NetChange => "net-change",
            Self::LargestShock => "largest-shock",
            Self::Map => "map",
            Self::Ballistic => "ballistic",
            Self::FiniteTilt => "finite-tilt",
            Self::Compliant => "compliant",
        }
    }
    /// What a flight keeps of a drop; of a closed form that of the map.
    fn physics(self, drop: &SingleDrop) -> Result<Physics, Error> {
        if self != Self::Compliant && !drop.own_contacts.is_none() {
            return Err(Error::OwnContacts(self));
        }
        Ok(match self {
            Self::NetChange | Self::LargestShock | Self::Map => Physics::Map,
            Self::Ballistic => Physics::Ballistic,
            Self::FiniteTilt => Physics::FiniteTilt,
            Self::Compliant => {
                let time_s = drop.contact_time_s.ok_or(Error::Contact)?;
                Physics::Contacts(Contact::new(drop.contact_law, drop.restitution, time_s)?)
            }
        })
    }
}

/// A single drop of a product.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SingleDrop {
    /// What falls.
    pub body: Body,
    /// What makes a plate of it; none of a bar.
    pub across: Option<Across>,
    /// The end that touches first; of a plate that of its lowest corner.
    pub first: End,
    /// Angle to the ground at the first touch, in rad.
    pub tilt_rad: f64,
    /// Whether both ends land as one: instant impacts that are closer than any contact lasts. Every place then gets (1 + e) v at
    /// once, at the first landing and at each that follows, whatever the tilt.
    pub flat: bool,
    /// Speed of the center of mass at the first touch, in m/s.
    pub speed_m_s: f64,
    /// Angular velocity at the first touch about the axis about which it is tilted, in rad/s: positive where the tilt grows, so that the end
    /// that touches first comes down faster than the center of mass, negative where it closes. Flat drops of instant impacts have none.
    pub spin_rad_s: f64,
    /// Coefficient of restitution.
    pub restitution: f64,
    /// Gravity, in m/s².
    pub gravity_m_s2: f64,
    /// How long a lone contact takes, where that is known.
    pub contact_time_s: Option<f64>,
    /// What the ground does to an end while it touches.
    pub contact_law: ContactLaw,
    /// Feet that it lands on; none where its ends or corners are what lands.
    pub feet: Option<Feet>,
    /// Ends, corners or feet of the product with a contact of their own.
    pub own_contacts: OwnContacts,
}

/// The side of a plate across its length, and how it falls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Across {
    /// The side.
    pub width: Width,
    /// Where the plate rises to from its lowest corner, in rad from the length, towards end b, towards the width: at 0 and at right
    /// angles it lands on an edge.
    pub direction_rad: f64,
    /// Of a box that lands on anything: tilt and direction are off this.
    pub posture: Option<Posture>,
}

/// How a box lands but for its tolerance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Posture {
    /// The vertical in axes of the box.
    pub upward: [f64; 3],
    /// Its thickness.
    pub thickness_m: f64,
    /// The axis of the box about which it turns, of one that lands at a tilt: then the tilt grows. Else it turns off what it lands on.
    pub about: Option<[f64; 3]>,
}

/// Lever arms of a place in a box.
pub(crate) struct Levers {
    /// From the center of mass to the farthest corner.
    pub(crate) farthest_m: f64,
    /// From there to the place.
    pub(crate) place_m: f64,
    /// The most that a push at a corner across the vertical does to the place along the axis of the part, over what it does to the center of
    /// mass.
    pub(crate) across: f64,
}

impl Across {
    /// Cosine and sine of the direction.
    fn upward(&self) -> [f64; 2] {
        let (sin, cos) = libm::sincos(self.direction_rad);
        [cos, sin]
    }
    /// The end of its lowest corner.
    pub(crate) fn first(&self) -> End {
        if self.signs()[0] < 0.0 { End::B } else { End::A }
    }
    /// The vertical in axes of a box at this tilt off its posture.
    pub(crate) fn upward_of(&self, posture: &Posture, tilt_rad: f64) -> [f64; 3] {
        turned_off(posture.upward, tilt_rad, self.direction_rad)
    }
    /// −1 for the sides of the plate that are exchanged, so that its lowest corner is the first.
    pub(crate) fn signs(&self) -> [f64; 2] {
        self.upward().map(|rises| if rises < 0.0 { -1.0 } else { 1.0 })
    }
}

/// A plate is turned about the axis of its tilt where the rest is below this share of its spin.
const ALONG_TILT: f64 = 1e-9;

impl SingleDrop {
    /// The drop that a scene of a plate has, corner a the lowest one, with contacts that take time.
    ///
    /// # Errors
    /// [`Error::Setting`] for a plate whose slopes are those of no tilt, and for one that turns about another axis than that of its tilt.
    pub fn of_plate(scene: &PlateScene, contact: &Contact) -> Result<Self, Error> {
        let (plate, [hx, hy]) = (scene.plate(), scene.gaps_m());
        let ([left, right, front, back], [length, width], [kx, ky]) =
            (plate.edges_m(), plate.sides_m(), plate.gyration_m());
        let slopes = [hx / length, hy / width];
        let steepest = libm::hypot(slopes[0], slopes[1]);
        if steepest >= 1.0 {
            let (name, allowed) = ("steepest slope of the plate", "below 1");
            return Err(Error::Setting { name, value: steepest, allowed });
        }
        let [x, y] = scene.spin_rad_s();
        let spins = libm::hypot(x, y);
        // Level, it turns to the direction in which it rises from then on.
        let [up, aside] = if steepest > 0.0 { slopes } else { [x, y] };
        let off = (x * aside - y * up).abs() / steepest;
        if off > ALONG_TILT * spins {
            let (name, allowed) =
                ("spin across the tilt of the plate in rad/s", "0: turning along length and width as its corners rise");
            return Err(Error::Setting { name, value: off, allowed });
        }
        let direction_rad = libm::atan2(aside, up);
        let spin_rad_s = spins.copysign(x * up + y * aside) + 0.0;
        let edges_m = [front, back];
        let product_of_inertia_m2 = plate.product_of_inertia_m2();
        let width = Width { edges_m, gyration_m: ky, product_of_inertia_m2, thickness_m: None, depth: None };
        Ok(Self {
            body: Body::off_center(left, right, kx)?,
            across: Some(Across { width, direction_rad, posture: None }),
            first: End::A,
            tilt_rad: libm::asin(steepest),
            flat: false,
            speed_m_s: scene.speed_m_s(),
            spin_rad_s,
            restitution: contact.restitution(),
            gravity_m_s2: scene.gravity_m_s2(),
            contact_time_s: Some(contact.time_s()),
            contact_law: contact.law(),
            feet: None,
            own_contacts: OwnContacts::NONE,
        })
    }
    /// The drop of a box as flights take it, with contacts that take time.
    ///
    /// # Errors
    /// [`Error::Bar`] for a center of mass on a face.
    pub fn of_block(drop: &BlockDrop, contact: &Contact) -> Result<Self, Error> {
        let block = drop.block();
        let ([length, width, thickness_m], [x, y, center_m]) = (block.size_m(), block.center_of_mass_m());
        let [a, b, c] = block.gyration_m().map(|about| about * about);
        let along = |own: f64, others: f64| (0.5 * (others - own)).max(0.0).sqrt();
        let [kx, ky, kz] = [along(a, b + c), along(b, c + a), along(c, a + b)];
        let [product_of_inertia_m2, xz, yz] = block.products_of_inertia_m2();
        let depth = Some(Depth { center_m, gyration_m: kz, products_of_inertia_m2: [xz, yz] });
        let edges_m = [0.5 * width + y, 0.5 * width - y];
        let width = Width { edges_m, gyration_m: ky, product_of_inertia_m2, thickness_m: Some(thickness_m), depth };
        let spin = drop.spin_rad_s();
        let spin_rad_s = spin.iter().map(|about| about * about).sum::<f64>().sqrt();
        let about = (spin_rad_s > 0.0).then(|| spin.map(|about| about / spin_rad_s));
        let posture = Some(Posture { upward: drop.upward(), thickness_m, about });
        Ok(Self {
            body: Body::off_center(0.5 * length + x, 0.5 * length - x, kx)?,
            across: Some(Across { width, direction_rad: 0.0, posture }),
            first: End::A,
            tilt_rad: 0.0,
            flat: false,
            speed_m_s: drop.speed_m_s(),
            spin_rad_s,
            restitution: contact.restitution(),
            gravity_m_s2: drop.gravity_m_s2(),
            contact_time_s: Some(contact.time_s()),
            contact_law: contact.law(),
            feet: None,
            own_contacts: OwnContacts::NONE,
        })
    }
    /// The model with the most physics that the data allow: contacts where their time is known, else real tilt.
    #[must_use]
    pub fn fullest(&self) -> Model {
        if self.contact_time_s.is_some() { Model::Compliant } else { Model::FiniteTilt }
    }
    fn is_plate(&self) -> bool {
        self.across.is_some()
    }
    /// The least and the largest restitution of its contacts.
    pub(crate) fn restitutions(&self) -> [f64; 2] {
        let [least, most] = self.own_contacts.restitutions(self.is_plate(), self.restitution);
        // Edges beyond feet have the contact of the product.
        let of_edges = self.feet.map(|_| self.restitution);
        [of_edges.map_or(least, |e| least.min(e)), of_edges.map_or(most, |e| most.max(e))]
    }
    /// The shortest and the longest of its contacts, where that of the product is known.
    pub(crate) fn contact_times_s(&self) -> Option<[f64; 2]> {
        let time_s = self.contact_time_s?;
        let [shortest, longest] = self.own_contacts.contact_times_s(self.is_plate(), time_s);
        Some(if self.feet.is_some() { [shortest.min(time_s), longest.max(time_s)] } else { [shortest, longest] })
    }
    /// With restitutions changed alike.
    pub(crate) fn with_restitutions(&self, of: impl Fn(f64) -> f64) -> Self {
        let own_contacts = self.own_contacts.with_restitutions(&of);
        Self { restitution: of(self.restitution), own_contacts, ..*self }
    }
    /// The contacts of its ends, corners or feet, that which touches first in front; those beyond them are of the product.
    ///
    /// # Errors
    /// [`Error::Contact`] where no contact time is known, [`Error::Bar`] for contacts that are none.
    pub(crate) fn contacts<const N: usize>(&self) -> Result<[Contact; N], Error> {
        let sides = match &self.across {
            Some(across) => across.signs().map(|sign| sign < 0.0),
            None => [self.first == End::B, false],
        };
        let time_s = self.contact_time_s.ok_or(Error::Contact)?;
        self.own_contacts.mirrored(self.is_plate(), sides).contacts(self.contact_law, self.restitution, time_s)
    }
    /// The same of the corners of a box, in the order that a box has.
    pub(crate) fn contacts_of_block(&self) -> Result<[Contact; 8], Error> {
        let time_s = self.contact_time_s.ok_or(Error::Contact)?;
        self.own_contacts.of_box(&Contact::new(self.contact_law, self.restitution, time_s)?)
    }
    /// Checks what no model would refuse: the contact time, which instant impacts do not ask for, the spin of a flat drop, and the place of a
    /// part.
    ///
    /// # Errors
    /// [`Error::Setting`].
    pub(crate) fn check(&self, [position_m, across_m]: [f64; 2]) -> Result<(), Error> {
        if let Some(value) = self.contact_time_s.filter(|time| !(1e-12..=1e3).contains(time)) {
            return Err(Error::Setting { name: "contact time in s", value, allowed: "in [1e-12, 1000]" });
        }
        if self.flat && self.spin_rad_s != 0.0 {
            let (name, allowed) = ("spin in rad/s", "0 of a flat drop by instant impacts: its ends do not land as one");
            return Err(Error::Setting { name, value: self.spin_rad_s, allowed });
        }
        // Places are rounded as they are converted.
        let [most, most_across] = self.sides_m().map(|side_m| 0.5 * side_m * (1.0 + 1e-9));
        if position_m.is_nan() || position_m.abs() > most {
            let (name, allowed) = ("position of the part in m", "up to half of the length on both sides");
            return Err(Error::Setting { name, value: position_m, allowed });
        }
        if across_m.is_nan() || across_m.abs() > most_across {
            let (name, allowed) =
                ("place of the part across the product in m", "up to half of the width on both sides");
            return Err(Error::Setting { name, value: across_m, allowed });
        }
        Ok(())
    }
    /// From edge to edge, along the length and along the width; 0 across a bar.
    pub(crate) fn sides_m(&self) -> [f64; 2] {
        let [x, y] = self.feet.map_or([0.0; 2], |feet| feet.inset_m);
        [self.body.length_m() + 2.0 * x, self.across.map_or(0.0, |across| across.width.m() + 2.0 * y)]
    }
    /// Whether it is a box that lands on a face, an edge or a corner.
    pub(crate) fn is_box(&self) -> bool {
        self.across.is_some_and(|across| across.posture.is_some())
    }
    /// Of a plate of small tilt the box that it is, as thick as its file tells, else thin; none of one on feet, which no box is.
    pub(crate) fn boxed(&self) -> Option<Self> {
        let across = self.across.filter(|across| across.posture.is_none() && self.feet.is_none())?;
        let thickness_m = across.width.thickness_m.unwrap_or(THIN * self.body.length_m());
        let posture = Some(Posture { upward: [0.0, 0.0, 1.0], thickness_m, about: None });
        Some(Self { across: Some(Across { posture, ..across }), ..*self })
    }
    /// From the lowest point to the highest, along the body.
    pub(crate) fn reach_m(&self) -> f64 {
        let length = self.body.length_m();
        self.across.map_or(length, |across| {
            let [cos, sin] = across.upward().map(f64::abs);
            length * cos + across.width.m() * sin
        })
    }
    /// How far the last point of what lands has to come down.
    pub(crate) fn gap_m(&self) -> f64 {
        let (Some(across), Some(posture)) = (&self.across, self.across.and_then(|across| across.posture)) else {
            return self.reach_m() * libm::sin(self.tilt_rad);
        };
        let upward = across.upward_of(&posture, self.tilt_rad);
        let sides = [self.body.length_m(), across.width.m(), posture.thickness_m];
        let rises = [0, 1, 2].map(|axis| sides[axis] * upward[axis].abs());
        rises.iter().sum::<f64>() - rises.iter().fold(0.0_f64, |most, rise| most.max(*rise))
    }
    /// How long the clatter takes, about: four times what the raised end needs to come down, and some contacts.
    pub(crate) fn clatter_s(&self) -> f64 {
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
    pub(crate) fn lands_as_one(&self, merge_s: f64) -> bool {
        self.contact_time_s.is_none()
            && self.spin_rad_s == 0.0
            && self.body.length_m() * libm::sin(self.tilt_rad) < merge_s * self.speed_m_s
    }
    /// The same drop landing flat, without spin.
    #[must_use]
    pub fn flattened(&self) -> Self {
        Self { tilt_rad: 0.0, spin_rad_s: 0.0, flat: self.contact_time_s.is_none(), ..*self }
    }
    /// When a box lies as a rule: after all of its bounces and ten times of falling over. One that balances on an edge is left then.
    fn settled_s(&self) -> f64 {
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
    pub(crate) fn clear_s(&self) -> f64 {
        self.clatter_s() + 0.5 * self.restitutions()[0] * self.speed_m_s / self.gravity_m_s2
    }
    /// The same by its liveliest contact.
    pub(crate) fn bounced_s(&self) -> f64 {
        self.clatter_s() + 0.5 * self.restitutions()[1] * self.speed_m_s / self.gravity_m_s2
    }
    /// The drop as flights take it, the end that touches first in front.
    pub(crate) fn scene(&self) -> Result<Scene, Error> {
        let [a, b] = self.body.arms_m();
        let body = match self.first {
            End::A => self.body,
            End::B => Body::off_center(b, a, self.body.gyration_m())?,
        };
        let (tilt_deg, gravity_m_s2) = (self.tilt_rad.to_degrees(), self.gravity_m_s2);
        Ok(Scene::new(body, self.restitution, self.speed_m_s, tilt_deg, gravity_m_s2)?.with_spin(self.spin_rad_s)?)
    }
    /// The drop of a bar on feet, whose edges are further points.
    pub(crate) fn scene_on(&self, feet: &Feet) -> Result<Scene<4>, Error> {
        let ([a, b], [inset_m, _]) = (self.body.arms_m(), feet.inset_m);
        let [first, other] = if self.first == End::A { [a, b] } else { [b, a] };
        let edge = |x: f64| [x + inset_m.copysign(x), feet.height_m];
        let points_m = [[-first, 0.0], [other, 0.0], edge(-first), edge(other)];
        let body = Body::of_points(points_m, self.body.gyration_m())?;
        let (tilt_deg, gravity_m_s2) = (self.tilt_rad.to_degrees(), self.gravity_m_s2);
        Ok(Scene::new(body, self.restitution, self.speed_m_s, tilt_deg, gravity_m_s2)?.with_spin(self.spin_rad_s)?)
    }
    /// Vertical velocities of the end that touches first and of the other one, at small tilt.
    pub(crate) fn approaches_m_s(&self) -> [f64; 2] {
        let [a, b] = self.body.arms_m();
        let [first, other] = if self.first == End::A { [a, b] } else { [b, a] };
        [-first, other].map(|x| x * self.spin_rad_s - self.speed_m_s)
    }
    /// The same of a plate, corner a the lowest one.
    pub(crate) fn plate_scene(&self, across: &Across) -> Result<PlateScene, Error> {
        let ([sx, sy], width) = (across.signs(), &across.width);
        let ordered = |[lo, hi]: [f64; 2], sign: f64| if sign < 0.0 { [hi, lo] } else { [lo, hi] };
        let ([left, right], [front, back]) = (ordered(self.body.arms_m(), sx), ordered(width.edges_m, sy));
        let plate = Plate::new([left, right, front, back], [self.body.gyration_m(), width.gyration_m])?
            .with_product_of_inertia(sx * sy * width.product_of_inertia_m2)?;
        let scene = PlateScene::new(plate, self.speed_m_s, self.gaps_m(across), self.gravity_m_s2)?;
        Ok(scene.with_spin(self.spin_of_plate(across))?)
    }
    /// Heights of the corners next to the lowest one as it touches, along the length and along the width.
    pub(crate) fn gaps_m(&self, across: &Across) -> [f64; 2] {
        let (rise, [cos, sin]) = (libm::sin(self.tilt_rad), across.upward().map(f64::abs));
        [self.body.length_m() * rise * cos, across.width.m() * rise * sin]
    }
    /// How fast the corners next to the lowest one rise, over the side between: along the length and along the width.
    pub(crate) fn spin_of_plate(&self, across: &Across) -> [f64; 2] {
        across.upward().map(|rises| self.spin_rad_s * rises.abs())
    }
    /// A place of a plate, from its middle, as its scene has it: from the center of mass.
    pub(crate) fn place(&self, across: &Across, at_m: [f64; 2]) -> [f64; 2] {
        let ([sx, sy], [x, y]) = (across.signs(), self.about_center(at_m));
        [sx * x, sy * y]
    }
    /// A place from the center of mass.
    fn about_center(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [a, b] = self.body.arms_m();
        [x - 0.5 * (a - b), y - self.across.map_or(0.0, |across| across.width.center_m())]
    }
    /// The box of this thickness. One that stands for a plate goes on upward, so that what lands are the corners of its bottom, however
    /// far they sink in.
    fn block(&self, across: &Across, thickness_m: f64) -> Result<Block, Error> {
        let ([a, b], width) = (self.body.arms_m(), &across.width);
        let depth = width.depth_of(thickness_m);
        let (kx, ky, kz) = (self.body.gyration_m(), width.gyration_m, depth.gyration_m);
        let radii = [libm::hypot(ky, kz), libm::hypot(kx, kz), libm::hypot(kx, ky)];
        let height_m = if across.posture.is_some() { thickness_m } else { thickness_m.max(a + b).max(width.m()) };
        let center_m = [0.5 * (a - b), width.center_m(), depth.center_m + 0.5 * (thickness_m - height_m)];
        let [xz, yz] = depth.products_of_inertia_m2;
        let block = Block::new([a + b, width.m(), height_m], center_m, radii)?;
        Ok(block.with_products_of_inertia([width.product_of_inertia_m2, xz, yz])?)
    }
    /// The same drop of a box of this thickness.
    pub(crate) fn block_drop(&self, across: &Across, thickness_m: f64) -> Result<BlockDrop, Error> {
        let (block, speed, gravity) = (self.block(across, thickness_m)?, self.speed_m_s, self.gravity_m_s2);
        let drop = match &across.posture {
            Some(posture) => BlockDrop::upright(block, across.upward_of(posture, self.tilt_rad), speed, gravity)?,
            None => BlockDrop::tilted(block, self.tilt_rad, across.direction_rad % TAU, speed, gravity)?,
        };
        Ok(drop.with_spin(self.spin_of_box(across))?)
    }
    /// Its angular velocity in axes of a box.
    pub(crate) fn spin_of_box(&self, across: &Across) -> [f64; 3] {
        let about = across.posture.map_or_else(
            || {
                let [x, y] = across.upward();
                [y, -x, 0.0]
            },
            |posture| posture.about.unwrap_or_else(|| turns_off(posture.upward, across.direction_rad)),
        );
        about.map(|about| self.spin_rad_s * about + 0.0)
    }
    /// The drop of a box that lands on anything, as flights take it; none of a bar and of a plate.
    ///
    /// # Errors
    /// [`Error::Flight`] for a box that no body is.
    pub fn of_box(&self) -> Result<Option<BlockDrop>, Error> {
        let of = |across: &Across| across.posture.map(|posture| self.block_drop(across, posture.thickness_m));
        self.across.as_ref().and_then(of).transpose()
    }
    /// Points that touch the ground and a place, from the center of mass, in units in which an impulse of 1 over the mass at p does
    /// 1 + p·q to q: x/ρ of a bar.
    pub(crate) fn in_radii(&self, spot: &Spot) -> (Vec<[f64; 2]>, [f64; 2]) {
        let [x, y] = spot.at_m;
        let ([a, b], rho) = (self.body.arms_m(), self.body.gyration_m());
        let beyond = self.feet.map(|feet| feet.inset_m);
        let Some(Across { width, posture, .. }) = self.across else {
            let mut ends = vec![[-a / rho, 0.0], [b / rho, 0.0]];
            ends.extend(beyond.into_iter().flat_map(|[x, _]| [[-(a + x) / rho, 0.0], [(b + x) / rho, 0.0]]));
            return (ends, [(x + 0.5 * (b - a)) / rho, 0.0]);
        };
        if posture.is_some() {
            return self.in_radii_of_box(spot);
        }
        let lean = width.product_of_inertia_m2 / (rho * rho);
        let across = (width.gyration_m * width.gyration_m - lean * lean * rho * rho).sqrt();
        let of = |[x, y]: [f64; 2]| [x / rho, (y - lean * x) / across];
        let [front, back] = width.edges_m;
        let corners =
            |[x, y]: [f64; 2]| [[-a - x, -front - y], [b + x, -front - y], [b + x, back + y], [-a - x, back + y]];
        let all = std::iter::once([0.0; 2]).chain(beyond).flat_map(corners);
        (all.map(of).collect(), of([x + 0.5 * (b - a), y - width.center_m()]))
    }
    /// The same of a box, as bounds that hold however it lies: impulses at a corner q do no more than
    /// `√(1 + q²) √(1 + p²)` to the place along the axis of the part, with p the lever arm of that axis over the radii of gyration.
    fn in_radii_of_box(&self, spot: &Spot) -> (Vec<[f64; 2]>, [f64; 2]) {
        // A box that is not followed has no bound.
        let Some(block) = self.as_box() else { return (vec![[f64::INFINITY, 0.0]; 4], [f64::INFINITY, 0.0]) };
        let place @ [x, y, z] = self.place_in_box(spot);
        let (least, dot) =
            (block.least_gyration_m(), |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
        let far = |place: [f64; 3]| dot(place, place).sqrt() / least;
        // What turning adds to a blow with this arm about the center of mass: √(a J⁻¹ a).
        let turned = |arm: [f64; 3]| dot(arm, block.turned_by(arm)).sqrt();
        let here = match spot.inside.axis {
            Axis::X => turned([0.0, z, -y]),
            Axis::Y => turned([-z, 0.0, x]),
            Axis::Z => turned([y, -x, 0.0]),
            Axis::Any => far(place),
        };
        let farthest = block.corners_m().into_iter().map(far).fold(0.0, f64::max);
        (vec![[farthest, 0.0]; 4], [here, 0.0])
    }
    /// What bounds a push across at a corner of a box; none of other bodies.
    pub(crate) fn levers(&self, spot: &Spot) -> Option<Levers> {
        let block = self.as_box()?;
        let place @ [x, y, z] = self.place_in_box(spot);
        let size = |a: [f64; 3]| libm::hypot(libm::hypot(a[0], a[1]), a[2]);
        let farthest_m = block.corners_m().into_iter().map(size).fold(0.0, f64::max);
        // The spin that a push of 1 over the mass at the place along the axis gives.
        let turned = |arm: [f64; 3]| size(block.turned_by(arm));
        let spins = match spot.inside.axis {
            Axis::X => turned([0.0, z, -y]),
            Axis::Y => turned([-z, 0.0, x]),
            Axis::Z => turned([y, -x, 0.0]),
            Axis::Any => size(place) / block.least_gyration_m().powi(2),
        };
        Some(Levers { farthest_m, place_m: size(place), across: 1.0 + spins * farthest_m })
    }
    /// The box that it is.
    fn as_box(&self) -> Option<Block> {
        let across = self.across?;
        self.block(&across, across.posture?.thickness_m).ok()
    }
    /// The smallest radius of gyration; 0 of a box that no body is.
    pub(crate) fn least_gyration_m(&self) -> f64 {
        let along = self.body.gyration_m();
        match &self.across {
            None => along,
            Some(across) if across.posture.is_some() => self.as_box().map_or(0.0, |block| block.least_gyration_m()),
            Some(across) => across.width.least_gyration_m(along),
        }
    }
    /// What a place feels of a motion of this drop.
    pub(crate) fn felt(&self, motion: &Course, spot: &Spot) -> clatter::Excitation {
        let at = spot.at_m;
        match (motion, &self.across) {
            (Course::Plate(motion), Some(across)) => motion.felt(self.place(across, at)),
            (Course::PlateOnFeet(motion), Some(across)) => motion.felt(self.place(across, at)),
            (Course::Block(motion), Some(_)) => motion.felt(self.place_in_box(spot), spot.inside.axis),
            (Course::Bar(motion), _) => motion.felt(self.relative(at[0])),
            (Course::BarOnFeet(motion), _) => {
                let [x, _] = self.about_center(at);
                motion.felt_at([if self.first == End::A { x } else { -x }, 0.0]).unwrap_or_default()
            }
            (Course::Plate(_) | Course::PlateOnFeet(_) | Course::Block(_), None) => unreachable!("they have a width"),
        }
    }
    /// A place in a box from the center of mass.
    pub(crate) fn place_in_box(&self, spot: &Spot) -> [f64; 3] {
        let [x, y] = self.about_center(spot.at_m);
        let thickness_m = self.across.and_then(|across| across.posture).map(|posture| posture.thickness_m);
        let depth = self.across.zip(thickness_m).map(|(across, thickness_m)| across.width.depth_of(thickness_m));
        // Of a plate that a box stands for, a place is as high as its center of mass.
        [x, y, depth.map_or(0.0, |depth| spot.inside.height_m - depth.center_m)]
    }
    /// Position s, −1 the end that touches first and 1 the other, of a place in m from the middle; beyond them where the product goes on
    /// beyond its feet.
    pub(crate) fn relative(&self, position_m: f64) -> f64 {
        let most = self.sides_m()[0] / self.body.length_m();
        let s = (2.0 * position_m / self.body.length_m()).clamp(-most, most);
        if self.first == End::A { s } else { -s }
    }
}
#[cfg(test)]
mod tests {
    use clatter_flight::Stop;

    use super::*;
    use crate::Inside;

    fn dropped([length, width, thickness_m]: [f64; 3], [kx, ky]: [f64; 2], center: f64) -> SingleDrop {
        let edges_m = [0.5 * width + center, 0.5 * width - center];
        let width =
            Width { edges_m, gyration_m: ky, product_of_inertia_m2: 0.0, thickness_m: Some(thickness_m), depth: None };
        let posture = Some(Posture { upward: [0.6, 0.0, 0.8], thickness_m, about: None });
        SingleDrop {
            body: Body::new(length, kx).unwrap(),
            across: Some(Across { width, direction_rad: 0.3, posture }),
            first: End::A,
            tilt_rad: 0.05,
            flat: false,
            speed_m_s: 3.0,
            spin_rad_s: 0.0,
            restitution: 0.4,
            gravity_m_s2: 9.81,
            contact_time_s: Some(1e-4),
            contact_law: ContactLaw::Hysteretic,
            feet: None,
            own_contacts: OwnContacts::NONE,
        }
    }

    fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    }

    /// A blow of 1 over the mass on a corner, along any line, does no more to a place than the arms of both allow.
    #[test]
    fn no_blow_on_a_corner_does_more_to_a_place_than_its_arms_allow() {
        // Mass near the middle of a broad box, and near the sides of a tower.
        let (broad, tower) = (([0.06, 0.15, 0.01], [0.03, 0.012]), ([0.05, 0.05, 0.2], [0.025, 0.025]));
        let mut tightest = 0.0_f64;
        for ((size, gyration), n) in [broad, tower].into_iter().flat_map(|of| (0..200).map(move |n| (of, n))) {
            let x = |k: u32| f64::from((n * k + 7) % 199) / 199.0 - 0.5;
            let mut drop = dropped(size, gyration, 0.1 * size[1] * x(3));
            if let Some(across) = &mut drop.across {
                across.width.product_of_inertia_m2 = x(31) * gyration[0] * gyration[1];
            }
            let (at_m, height_m) = ([size[0] * x(5), size[1] * x(11)], size[2] * x(17));
            let block = drop.block_drop(&drop.across.unwrap(), size[2]).unwrap().block();
            let place = block.place([at_m[0], at_m[1], height_m]);
            let z = 2.0 * x(23);
            let (sin, cos) = (TAU * x(29)).sin_cos();
            let along = [(1.0 - z * z).sqrt() * cos, (1.0 - z * z).sqrt() * sin, z];
            for (axis, index) in [(Axis::X, Some(0)), (Axis::Y, Some(1)), (Axis::Z, Some(2)), (Axis::Any, None)] {
                let (points, here) = drop.in_radii(&Spot { at_m, inside: Inside { height_m, axis } });
                let root = |[x, y]: [f64; 2]| (1.0 + x * x + y * y).sqrt();
                let most = points.iter().map(|point| root(*point) * root(here)).fold(0.0, f64::max);
                for corner in block.corners_m() {
                    let moment = cross(corner, along);
                    let turned = cross(block.turned_by(moment), place);
                    let change: [f64; 3] = std::array::from_fn(|i| along[i] + turned[i]);
                    let felt = index
                        .map_or_else(|| change.iter().map(|c| c * c).sum::<f64>().sqrt(), |i: usize| change[i].abs());
                    assert!(felt <= most * (1.0 + 1e-9), "{n}, {axis:?}: {felt} beyond {most}");
                    tightest = tightest.max(felt / most);
                }
            }
        }
        assert!(tightest > 0.7, "{tightest}: far from what is allowed, nothing would be seen");
    }

    /// In radii of gyration a blow at one place does 1 + p·q to another: with masses askew 1 + r C⁻¹ r′, C their second moments.
    #[test]
    fn a_blow_on_a_plate_does_what_its_second_moments_say() {
        let (kx, ky, c) = (0.043_f64, 0.02_f64, 5e-4);
        let mut drop = dropped([0.15, 0.07, 0.004], [kx, ky], 0.01);
        let across = drop.across.as_mut().unwrap();
        (across.width.product_of_inertia_m2, across.posture) = (c, None);
        let (corners, here) = drop.in_radii(&Spot::from([0.05, 0.02]));
        let whole = kx * kx * ky * ky - c * c;
        // The center of mass is 10 mm off across: the edges lie 45 mm in front and 25 mm behind.
        let place = [0.05, 0.01];
        for (corner, [x, y]) in corners.iter().zip([[-0.075, -0.045], [0.075, -0.045], [0.075, 0.025], [-0.075, 0.025]])
        {
            let moments = ky * ky * x * place[0] + kx * kx * y * place[1] - c * (x * place[1] + y * place[0]);
            let [told, want] = [1.0 + corner[0] * here[0] + corner[1] * here[1], 1.0 + moments / whole];
            assert!((told - want).abs() < 1e-12, "{x}, {y}: {told}, not {want}");
        }
    }

    /// Set down on its narrow end it falls over, and lies: a place carries its weight along the axis that is up, and all of it along any.
    #[test]
    fn a_box_is_followed_until_it_lies() {
        let mut drop = dropped([0.15, 0.07, 0.02], [0.043, 0.02], 0.0);
        let posture = Some(Posture { upward: [0.98, 0.0, 0.2], thickness_m: 0.02, about: None });
        drop.across = drop.across.map(|across| Across { posture, ..across });
        let followed = Followed::new(&drop, Model::Compliant, 0.01).unwrap();
        assert!(matches!(followed.motion.stop(), Stop::AtRest { .. }), "{:?}", followed.motion.stop());
        let at = |axis| followed.carried_m_s2(&Spot { at_m: [0.02, 0.01], inside: Inside { height_m: 0.003, axis } });
        let [x, y, z, any] = [Axis::X, Axis::Y, Axis::Z, Axis::Any].map(at);
        // It lies on its broad side, but for some that turns on about the vertical and dents.
        assert!((z.abs() - 9.81).abs() < 0.1 && x.abs() < 0.5 && y.abs() < 0.5, "{x}, {y}, {z}");
        assert!((any - (x * x + y * y + z * z).sqrt()).abs() < 1e-12 && followed.weight_to_come_m_s2() == 0.0);
        for (restitution, gravity_m_s2) in [(0.0, 0.0), (0.5, 0.0), (1.0, 9.81), (0.0, 9.81)] {
            assert!(
                SingleDrop { restitution, gravity_m_s2, ..drop }.settled_s() > 0.3,
                "{restitution}, {gravity_m_s2}"
            );
        }
        // Left in flight, it has its weight still to come.
        let left = Followed::until(&drop, Model::Compliant, 0.01, Until::Lands).unwrap();
        let weights = [left.weight_to_come_m_s2(), left.carried_m_s2(&Spot::from([0.0; 2]))];
        assert_eq!(weights.map(f64::to_bits), [9.81_f64, 0.0].map(f64::to_bits));
    }

    /// It has bounced clear before it comes down again: after 2 e v/g.
    #[test]
    fn a_body_is_clear_in_its_first_flight() {
        let mut drop = dropped([0.15, 0.07, 0.004], [0.043, 0.02], 0.0);
        drop.across = None;
        drop.tilt_rad = 0.0;
        let flight_s = 2.0 * drop.restitution * drop.speed_m_s / drop.gravity_m_s2;
        assert!(drop.clear_s() > 2e-4 && drop.clear_s() < flight_s, "{} of {flight_s}", drop.clear_s());
    }

    /// Of plates that tumble over several corners too the largest turn is that of all directions.
    #[test]
    fn the_largest_turn_of_a_plate_is_that_of_all_directions() {
        let mut off = 0.0_f64;
        for n in 0..60_u32 {
            let x = |k: u32| f64::from((n * k + 7) % 61) / 61.0;
            let mut drop = dropped([0.15, 0.04 + 0.1 * x(11), 0.004], [0.043, 0.012 + 0.03 * x(11)], 0.01 * x(5));
            drop.across = drop.across.map(|across| Across { direction_rad: TAU * x(17), posture: None, ..across });
            (drop.tilt_rad, drop.restitution) = (0.2 * x(23), 0.1 + 0.5 * x(29));
            drop.first = drop.across.unwrap().first();
            let followed = Followed::until(&drop, Model::Compliant, 0.01, Until::Lands).unwrap();
            let all = crate::shock::largest(&followed.turns()).change;
            let most = followed.largest_turn(0.0).unwrap().change;
            off = off.max(1.0 - most / all);
            assert!(followed.largest_turn(1.001 * all).is_none() && most <= all, "{n}: {most} of {all}");
            assert!(followed.largest_turn(0.9 * all).is_some(), "{n}: {all}");
        }
        assert!(off < 1e-12, "{off} is missed");
    }

    /// The largest turn of a box is found wherever it is above what is asked for, and only there.
    #[test]
    fn the_largest_turn_of_a_box_is_not_passed_over() {
        for tilt_rad in [0.02, 0.1, 0.25] {
            let drop = SingleDrop { tilt_rad, ..dropped([0.15, 0.07, 0.02], [0.043, 0.02], 0.0) };
            let followed = Followed::until(&drop, Model::Compliant, 0.01, Until::Lands).unwrap();
            let most = followed.largest_turn(0.0).unwrap().change;
            // About each axis one by one.
            let each =
                followed.motion.turned().map(|about| crate::shock::largest(&followed.shocks_of_turning(&about)).change);
            assert_eq!(each.fold(0.0, f64::max).to_bits(), most.to_bits());
            assert!(most > 1.0 && followed.largest_turn(0.999 * most).is_some(), "{tilt_rad}: {most}");
            assert!(followed.largest_turn(1.001 * most).is_none(), "{tilt_rad}: {most}");
        }
    }
}
