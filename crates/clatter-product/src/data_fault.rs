//! This module lists the faults of the data of a product: the words that messages of product files and errors of the library share.

use crate::keys::MOST_COMPONENTS;
use crate::standard;
use crate::{DropName, LimitKind};

/// A fault in the data of a product.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum DataFault {
    /// A value that is out of the range of its key.
    Value {
        /// The key of product files, such as `natural_frequency`.
        field: &'static str,
        /// The value, in SI.
        value: f64,
        /// Its SI unit; empty for a plain number.
        unit: &'static str,
        /// The allowed values.
        allowed: String,
    },
    /// A center of mass too far out.
    CenterOfMass {
        /// `length`, `width` or `thickness`.
        side: &'static str,
        /// Its place, from the middle.
        center_m: f64,
        /// The length of that side.
        side_m: f64,
    },
    /// A radius of gyration that no masses within the body have.
    Gyration {
        /// The side of the mass, along `length`, `width` or `thickness`.
        side: &'static str,
        /// The radius.
        gyration_m: f64,
        /// The least and the largest one.
        allowed_m: [f64; 2],
    },
    /// Something beyond a face of the body.
    Outside {
        /// The words of messages for it.
        what: &'static str,
        /// Along `length`, `width` or `thickness`.
        side: &'static str,
        /// The reach from the middle.
        reach_m: f64,
        /// Half of that side.
        half_m: f64,
    },
    /// A product of inertia that no masses within the body have, or that leaves all mass on a line, or next to one.
    ProductOfInertia {
        /// The sides along which it is, as `xy`.
        sides: &'static str,
        /// ∫x y dm over the mass.
        product_m2: f64,
        /// The least and the largest one.
        allowed_m2: [f64; 2],
    },
    /// Products of inertia that no mass has together.
    ProductsOfInertia {
        /// ∫x y dm, ∫x z dm and ∫y z dm over the mass.
        products_m2: [f64; 3],
    },
    /// A plate without contact time.
    PlateWithoutContactTime,
    /// A key that a plate does not have.
    OfPlate {
        /// The key.
        field: &'static str,
    },
    /// A key that a product without width does not have.
    OfBar {
        /// The key.
        field: &'static str,
    },
    /// Friction of a product that does not land as a box.
    FrictionOfLevel,
    /// A box without its thickness.
    BoxWithoutThickness,
    /// A drop that is listed twice.
    Twice(DropName),
    /// Drops on faces, edges and corners together with drops at a tilt.
    BoxAndPlate,
    /// Gravity that is not that of the other drops.
    Gravity,
    /// A value that is not the name of an attitude.
    Attitude {
        /// The key.
        field: &'static str,
        /// Its value.
        value: String,
    },
    /// A drop standard that is not built in.
    Standard(String),
    /// A standard that goes by the mass, of a product without one.
    StandardNeedsMass,
    /// A product that is too heavy for a standard.
    StandardMass {
        /// Its mass.
        mass_kg: f64,
        /// The largest mass.
        most_kg: f64,
    },
    /// An axis of a part that is no box's, or that a part on a suspension does not have.
    Axis(&'static str),
    /// A body with another radius of gyration than the middle of the range of the product.
    OtherGyration {
        /// The radius of gyration of the body.
        gyration_m: f64,
        /// The middle of the range.
        middle_m: f64,
    },
    /// A drop from a height without gravity.
    NoGravity,
    /// No component, or too many.
    Components(usize),
    /// A component without a name.
    NoName,
    /// Two components of one name: answers could not be distinguished.
    SameName(String),
    /// Feet that are too close to one another.
    FeetApart {
        /// The distance inside the edges.
        inset_m: f64,
        /// The side from edge to edge.
        side_m: f64,
    },
    /// Feet of a box that lands on any side.
    FeetOfBox,
    /// A contact of its own at a corner of a bar.
    CornerOfBar(&'static str),
    /// Two contacts of one place.
    SameContact(String),
    /// A contact of its own that says nothing.
    ContactAsAll,
    /// A contact law of a product without contact time.
    LawWithoutTime,
    /// Contacts of their own in a product without contact time.
    OwnContactsWithoutTime,
    /// Contacts of their own by another law than the hysteretic one, or by none that is named.
    OwnContactsLaw,
    /// Records of measured drops of a product with contacts of their own.
    OwnContactsMeasured,
    /// Records of a product that falls several times.
    ListMeasured,
    /// A drop so steep that an edge touches before the foot.
    FeetLow {
        /// The steepest of the drops.
        tilt_rad: f64,
        /// The steepest at which feet touch first.
        most_rad: f64,
    },
    /// A spin by which what touches first goes up.
    SpinUp {
        /// The spin, in rad/s.
        spin_rad_s: f64,
        /// The least speed of the drops.
        speed_m_s: f64,
        /// The largest distance of the touch from the center of mass.
        arm_m: f64,
        /// True where a spin of either sign may do so, as of a box.
        both: bool,
    },
    /// A spin of a product without contact time whose ends may land as one.
    SpinAsOne {
        /// Within this time.
        merge_s: f64,
    },
    /// A limit on the speed at a stop, of a part without one.
    NoStop,
    /// A stop beyond the rattle space.
    StopGap {
        /// The gap.
        gap_m: f64,
        /// The rattle space.
        space_m: f64,
    },
    /// A contact with a stop that lasts longer than the period of the part.
    StopTime {
        /// The contact time.
        time_s: f64,
        /// The longest period.
        period_s: f64,
    },
    /// A component without a limit.
    NoLimit,
    /// A damage boundary without an acceleration.
    NoAcceleration,
    /// A key that a part that is mounted rigidly does not have.
    Hard {
        /// The key.
        field: &'static str,
    },
}

impl DataFault {
    /// Returns the fault with the value, and the allowed values.
    #[must_use]
    #[expect(clippy::too_many_lines, reason = "a sentence for each")]
    pub fn told(&self) -> [String; 2] {
        match self {
            Self::Value { field, value, unit, allowed } => {
                let blank = if unit.is_empty() { "" } else { " " };
                [out_of_range(field, format_args!("{value}{blank}{unit}")), format!("allowed: {allowed}")]
            }
            Self::CenterOfMass { side, center_m, side_m } => [
                format!("the center of mass is {} mm from the middle of a {side} of {} mm", mm(*center_m), mm(*side_m)),
                "allowed: within 0.45 of it from the middle".to_owned(),
            ],
            Self::Gyration { side, gyration_m, allowed_m: [least, most] } => [
                format!("the radius of gyration of the mass along the {side} is {} mm", mm(*gyration_m)),
                format!("allowed: from {} to {} mm; masses within the body have no larger one", mm(*least), mm(*most)),
            ],
            Self::Outside { what, side, reach_m, half_m } => [
                format!("{what} reaches {} mm from the middle along the {side}", mm(*reach_m)),
                format!("allowed: up to {} mm, half of the product's {side}: it lies within the body", mm(*half_m)),
            ],
            Self::OtherGyration { gyration_m, middle_m } => [
                format!("the radius of gyration of the body is {} mm", mm(*gyration_m)),
                format!("allowed: {} mm, the middle of the range that the product gives", mm(*middle_m)),
            ],
            Self::NoGravity => [
                "without gravity nothing falls from a `height`".to_owned(),
                "give the `speed` at the first touch instead".to_owned(),
            ],
            Self::Components(count) => {
                [format!("`component` has {count} entries"), format!("expected 1 to {MOST_COMPONENTS}")]
            }
            Self::NoName => ["`name` is empty".to_owned(), "expected a name".to_owned()],
            Self::SameName(name) => {
                [format!("two components are named {name:?}"), "give each component a name of its own".to_owned()]
            }
            Self::FeetApart { inset_m, side_m } => [
                format!("the feet are {} mm inside the edges of a side of {} mm", mm(*inset_m), mm(*side_m)),
                format!("allowed: up to {} mm, 0.4 of it", mm(crate::check::FEET_INSIDE * side_m)),
            ],
            Self::FeetOfBox => [
                "feet are those of a bar or a plate; a box lands on any of its sides".to_owned(),
                "leave `feet_inset` and `feet_height` out, or give drops a `tilt` alone".to_owned(),
            ],
            Self::FeetLow { tilt_rad, most_rad } => [
                format!("at a tilt of {} deg an edge touches before the foot", degrees(*tilt_rad)),
                format!("allowed: up to {} deg, by `feet_inset` and `feet_height`", degrees(*most_rad)),
            ],
            Self::CornerOfBar(at) => [
                format!("a product without `width` has no contact at {at:?}"),
                "allowed: \"a\" and \"b\", its ends".to_owned(),
            ],
            Self::SameContact(at) => {
                [format!("two contacts are at {at:?}"), "give each place one contact".to_owned()]
            }
            Self::ContactAsAll => [
                "the contact is that of all others".to_owned(),
                "give its `restitution`, its `contact_time`, or both".to_owned(),
            ],
            Self::OwnContactsWithoutTime => [
                "`contacts` of their own need the `contact_time` of the others: impacts that take no time have no order where they \
                 differ"
                    .to_owned(),
                "add contact_time = \"0.4 ms\" or whatever was measured to [product]".to_owned(),
            ],
            Self::OwnContactsLaw => [
                "`contacts` of their own are hysteretic: dashpots that differ couple the vibrations of the product, which are no sum of \
                 modes then"
                    .to_owned(),
                "add contact_law = \"hysteretic\" to [product]".to_owned(),
            ],
            Self::OwnContactsMeasured => [
                "a fit takes a product whose contacts are alike, without `contacts` of their own".to_owned(),
                "leave one of `record` and `contacts` out".to_owned(),
            ],
            Self::ListMeasured => [
                "a fit takes a file with one drop: nothing says which of several a record is of".to_owned(),
                "leave `record` out, or give one [drop]".to_owned(),
            ],
            Self::SpinUp { spin_rad_s, speed_m_s, arm_m, both } => {
                let most = format!("{} rad/s", (1e3 * speed_m_s / arm_m).floor() / 1e3);
                [
                    format!("with a spin of {spin_rad_s} rad/s what touches first may not come down"),
                    format!(
                        "allowed: {}{most}, the least speed over the {} mm from the center of mass to where it touches",
                        if *both { "within " } else { "above -" },
                        mm(*arm_m)
                    ),
                ]
            }
            Self::SpinAsOne { merge_s } => [
                format!(
                    "with `spin` ends that land within {} ms of one another do not land as one, and only contacts tell what they do",
                    (1e6 * merge_s).round() / 1e3
                ),
                "add the `contact_time` to [product], or begin the tilt higher".to_owned(),
            ],
            Self::NoStop => [
                "a part without a `stop` has no `stop_speed_limit`".to_owned(),
                "add stop = { gap = \"1 mm\", contact_time = \"0.5 ms\", restitution = 0.4 } or whatever was measured".to_owned(),
            ],
            Self::StopGap { gap_m, space_m } => [
                format!("the `gap` of the stop is {} mm", mm(*gap_m)),
                format!("allowed: up to {} mm, the `rattle_space`, which ends at the stop", mm(*space_m)),
            ],
            Self::StopTime { time_s, period_s } => [
                format!("a contact with the stop lasts {} ms", mm(*time_s)),
                format!("allowed: up to {} ms, the period of the part", mm(*period_s)),
            ],
            Self::NoLimit => {
                let keys = LimitKind::ALL.map(LimitKind::key).join(", ");
                ["it has no limit".to_owned(), format!("give at least one of {keys}")]
            }
            Self::NoAcceleration => {
                ["its damage boundary has a velocity change alone".to_owned(), "give its acceleration too".to_owned()]
            }
            Self::Hard { field } => {
                [format!("a hard-mounted part has no `{field}`"), "leave one of both out".to_owned()]
            }
            Self::ProductOfInertia { sides, product_m2, allowed_m2 } => {
                let [product, least, most] = [*product_m2, allowed_m2[0], allowed_m2[1]].map(mm2);
                [
                    format!("the product of inertia {sides} over the mass is {product} mm2"),
                    format!("allowed: from {least} to {most} mm2, those of masses within the body that are not all on one line"),
                ]
            }
            Self::ProductsOfInertia { products_m2 } => {
                let [xy, xz, yz] = products_m2.map(mm2);
                [
                    format!("the products of inertia over the mass are {xy}, {xz} and {yz} mm2: no masses have them together"),
                    "allowed: those of masses within the body".to_owned(),
                ]
            }
            Self::LawWithoutTime => [
                "a `contact_law` needs the `contact_time`: impacts that take no time follow none".to_owned(),
                "add contact_time = \"0.4 ms\" or whatever was measured, or leave the law out".to_owned(),
            ],
            Self::PlateWithoutContactTime => [
                "a product with a `width` needs the `contact_time`: corners that land together have no order without it"
                    .to_owned(),
                "add contact_time = \"0.4 ms\" or whatever was measured to [product]".to_owned(),
            ],
            Self::OfPlate { field } => {
                [format!("a product with a `width` has no `{field}`"), "leave one of both out".to_owned()]
            }
            Self::OfBar { field } => {
                [format!("a product without `width` has no `{field}`"), "leave it out, or give the width".to_owned()]
            }
            Self::FrictionOfLevel => [
                "`friction` is followed of boxes alone, which land on faces, edges or corners or with an `attitude_tolerance`".to_owned(),
                "leave it out, or say on what the box lands".to_owned(),
            ],
            Self::BoxWithoutThickness => [
                "a drop on a face, an edge or a corner is that of a box".to_owned(),
                "add `width` and `thickness` to [product]".to_owned(),
            ],
            Self::Twice(name @ DropName::On(_)) => [
                format!("two drops are the same: {name}, from as high"),
                "allowed: each drop once, or from another height".to_owned(),
            ],
            Self::Twice(name @ DropName::Number(_)) => {
                [format!("{name} is the same as one before it"), "allowed: each drop once".to_owned()]
            }
            Self::BoxAndPlate => [
                "drops on faces, edges and corners stand beside drops at a tilt".to_owned(),
                "allowed: all of a box, or none".to_owned(),
            ],
            Self::Gravity => [
                "gravity differs from drop to drop".to_owned(),
                "give all drops the same, or another file".to_owned(),
            ],
            Self::Attitude { field, value } => [
                format!("`{field}` cannot be {value:?}"),
                match *field {
                    "face" => "expected one of end-a, end-b, front, back, bottom, top, or all",
                    "edge" => "expected two faces that meet, such as \"bottom front\", or \"all\"",
                    _ => "expected three faces that meet, such as \"bottom front end-a\", or \"all\"",
                }
                .to_owned(),
            ],
            Self::Standard(keyword) => [
                format!("the drops of {keyword:?} are not built in"),
                format!(
                    "built in: {}; of others give `height`, `face`, `edge` or `corner`, and `attitude_tolerance` by hand",
                    standard::STANDARDS.iter().map(|standard| standard.keyword).collect::<Vec<_>>().join(", ")
                ),
            ],
            Self::StandardNeedsMass => [
                "the `standard` goes by the mass of the product".to_owned(),
                "add mass = \"190 g\" or `masses` to [product]".to_owned(),
            ],
            Self::StandardMass { mass_kg, most_kg } => [
                format!("the product has {mass_kg} kg: the standard lists no drops of it"),
                format!("allowed: up to {most_kg} kg"),
            ],
            Self::Axis(axis) => [
                format!("`axis` = {axis:?} is not that of this part"),
                "x and y are axes of parts of a box with drops on its faces, edges or corners; any is for parts mounted rigidly there"
                    .to_owned(),
            ],
        }
    }
}

impl std::fmt::Display for DataFault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [wrong, allowed] = self.told();
        write!(f, "{wrong}; {allowed}")
    }
}

/// Returns the words of messages for a value as it was written.
pub(crate) fn out_of_range(field: &str, value: impl std::fmt::Display) -> String {
    format!("`{field}` = {value} is out of its range")
}

/// Degrees to a hundredth.
fn degrees(angle_rad: f64) -> f64 {
    (100.0 * angle_rad.to_degrees()).round() / 100.0
}

/// Millimeters to the micrometer, as messages have them, and milliseconds to the microsecond.
fn mm(length_m: f64) -> f64 {
    (1e6 * length_m).round() / 1e3
}

/// Returns square millimeters to a thousandth.
fn mm2(product_m2: f64) -> f64 {
    (1e9 * product_m2).round() / 1e3
}
