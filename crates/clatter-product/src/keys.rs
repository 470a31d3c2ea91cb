//! The keys of a product file: one table that the reader, its messages and the schema share.

use clatter_flight::PLACES as PLACES_OF_CONTACTS;

use crate::reliability::VERDICT_SHARES;
use crate::units::{self, Dimension};

/// One key of a table.
#[derive(Debug)]
pub(crate) struct Key {
    pub(crate) name: &'static str,
    pub(crate) kind: Kind,
    pub(crate) required: bool,
    /// The description of the key, for editors.
    pub(crate) doc: &'static str,
}

/// The kind of value that a key takes.
#[derive(Debug)]
pub(crate) enum Kind {
    Text,
    /// A text or a list of them.
    Texts,
    /// true or false.
    Flag,
    /// One of these words.
    Choice(&'static [&'static str]),
    /// A value within bounds, both included; the bounds are written as the value would be.
    Quantity(&'static Dimension, [&'static str; 2]),
    /// A value, a range or a distribution, within bounds.
    Spread(&'static Dimension, [&'static str; 2]),
    /// One of these of a bar; of a plate, a product with a width, two: along the length and across it.
    Sides(&'static Kind),
    Table(&'static [Key]),
    /// A table or several.
    OneOrMore(&'static [Key]),
    /// At least one table.
    Tables(&'static [Key]),
}

impl Kind {
    /// Returns the kind of value for one side.
    pub(crate) fn of_side(&self) -> &Self {
        if let Self::Sides(side) = self { side } else { self }
    }
}

const fn key(name: &'static str, required: bool, kind: Kind, doc: &'static str) -> Key {
    Key { name, kind, required, doc }
}

use Kind::{Choice, Flag, OneOrMore, Quantity, Sides, Spread, Table, Tables, Text, Texts};

/// Bounds that several keys share.
const PLACES: [&str; 2] = ["-100 m", "100 m"];
const MASSES: [&str; 2] = ["1 mg", "1000 kg"];

/// Tables of one kind at most.
pub(crate) const MOST_COMPONENTS: usize = 1000;
pub(crate) static FILE: &[Key] = &[
    key("product", true, Table(PRODUCT), "What falls: a flat body, seen from the side as a bar with ends a and b."),
    key(
        "drop",
        true,
        OneOrMore(DROP),
        "How it falls; one table [[drop]] for each of several drops, which all must hold.",
    ),
    key("component", true, Tables(COMPONENT), "The fragile parts, one table [[component]] each."),
    key("verdict", false, Table(VERDICT), "How limits are decided that no search decides: by products that are drawn."),
    key("record", false, Tables(RECORD), "Measured drops of the product, one table [[record]] for each file."),
];

pub(crate) static PRODUCT: &[Key] = &[
    key("name", true, Text, "Name of the product."),
    key("length", true, Quantity(&units::LENGTH, ["1 mm", "100 m"]), "Length from end a to end b."),
    key(
        "width",
        false,
        Quantity(&units::LENGTH, ["1 mm", "100 m"]),
        "Width across the length: with it the product is a plate that may land on any corner, and places have two values. It needs the \
         contact time. Without it the product is a bar; one that is wider than a quarter of its length may ask for up to 30 % more.",
    ),
    key(
        "thickness",
        false,
        Quantity(&units::LENGTH, ["0.1 mm", "100 m"]),
        "Thickness of a plate, where real tilt counts; a twentieth of the length unless given.",
    ),
    key(
        "feet_inset",
        false,
        Sides(&Quantity(&units::LENGTH, ["0 mm", "50 m"])),
        "How far inside the edges its feet or bumpers lie, which touch the ground first; of a plate across it too. Parts may lie beyond \
         them. Unless given, it lands on its ends or corners. Needs feet_height.",
    ),
    key(
        "feet_height",
        false,
        Quantity(&units::LENGTH, ["0.01 mm", "1 m"]),
        "By how much the feet stand out. Edges beyond them that come down press by the contact of the product; without a contact time a drop \
         in whose clatter one comes down is not answered, and what it does later is bounded by energy.",
    ),
    key("mass", false, Quantity(&units::MASS, MASSES), "Mass; needed with moment_of_inertia only."),
    key(
        "radius_of_gyration",
        false,
        Sides(&Spread(&units::LENGTH, ["0.01 mm", "100 m"])),
        "Radius of gyration about the center of mass (length/√12 = 0.289 length for evenly spread mass): a range where it is not \
         known well; of a plate two values, of the mass along the length and of that along the width. All mass lies within the product: at \
         most √(a b), with a and b from the center of mass to both ends. One of three ways to give the inertia.",
    ),
    key(
        "moment_of_inertia",
        false,
        Sides(&Quantity(&units::MOMENT_OF_INERTIA, ["1e-12 kg m2", "1e7 kg m2"])),
        "Moment of inertia about the center of mass; needs the mass; of a plate two, of the mass along the length and of that along \
         the width. One of three ways to give the inertia.",
    ),
    key(
        "masses",
        false,
        Tables(MASS),
        "Point masses and slabs within the product: their center of mass and radius of gyration are worked out. One of three ways to \
         give the inertia.",
    ),
    key(
        "center_of_mass",
        false,
        Sides(&Quantity(&units::LENGTH, PLACES)),
        "Where the center of mass lies, from the middle towards end b, of a plate across it too; 0 mm unless given. Not with masses.",
    ),
    key(
        "restitution",
        true,
        Spread(&units::SHARE, ["0", "1"]),
        "Coefficient of restitution of the ends: rebound over approach speed.",
    ),
    key(
        "contact_time",
        false,
        Spread(&units::TIME, ["1 us", "100 ms"]),
        "How long a lone contact of one end takes, from touch to parting; needed where a part is hard-mounted or stiff.",
    ),
    key(
        "contact_law",
        false,
        Choice(&clatter_flight::ContactLaw::NAMES),
        "What the force of an impact does: hysteretic has the peak of a half-sine; dashpot jumps at the touch, as with some rubber. Needs \
         the contact_time.",
    ),
    key(
        "friction",
        false,
        Spread(&units::SHARE, ["0", "10"]),
        "Coefficient of friction of the ground: of plastics, glass and steel on wood and concrete 0.1 to 0.6, of rubber 0.6 to 1. Of a box, where \
         it is 0 to 0.6 unless given, and of a plate at real tilt.",
    ),
    key(
        "contacts",
        false,
        Tables(CONTACT),
        "Ends or corners, or the feet there, with a contact of their own, such as a soft bumper; needs the contact_time of the others and \
         contact_law = \"hysteretic\". Of a box both corners, of the bottom and of the top, that are seen there from above.",
    ),
];

pub(crate) static CONTACT: &[Key] = &[
    key(
        "at",
        true,
        Choice(&PLACES_OF_CONTACTS),
        "Of a bar end a or b; of a plate corner a (left, front), b (right, front), c (right, back) or d (left, back), end b on the right.",
    ),
    key(
        "restitution",
        false,
        Quantity(&units::SHARE, ["0", "1"]),
        "Its coefficient of restitution; that of the product unless given.",
    ),
    key(
        "contact_time",
        false,
        Quantity(&units::TIME, ["1 us", "100 ms"]),
        "How long a lone contact takes there; as long as in the product unless given.",
    ),
];

pub(crate) static MASS: &[Key] = &[
    key("name", false, Text, "What it is."),
    key("mass", true, Quantity(&units::MASS, MASSES), "Its mass."),
    key(
        "position",
        false,
        Sides(&Quantity(&units::LENGTH, PLACES)),
        "Of a point mass: where, from the middle towards end b.",
    ),
    key("from", false, Sides(&Quantity(&units::LENGTH, PLACES)), "Of a slab: where it begins."),
    key("to", false, Sides(&Quantity(&units::LENGTH, PLACES)), "Of a slab: where it ends."),
    key(
        "height",
        false,
        Quantity(&units::LENGTH, PLACES),
        "Of a product with a thickness: where across it, from the middle; spread evenly over all of it unless given.",
    ),
];

pub(crate) static DROP: &[Key] = &[
    key(
        "height",
        false,
        Spread(&units::LENGTH, ["0.1 mm", "1000 m"]),
        "Height of the lower end before the drop. Either this or speed.",
    ),
    key(
        "speed",
        false,
        Spread(&units::SPEED, ["1 mm/s", "100 m/s"]),
        "Speed of the center of mass at the first touch. Either this or height.",
    ),
    key(
        "tilt",
        false,
        Spread(&units::ANGLE, ["0 deg", "90 deg"]),
        "Angle to the ground at the first touch, up to 30 deg; needed but for a box that lands on a face, edge or corner. Of a box, with \
         attitude_tolerance and direction: how far its bottom is off level, up to 90 deg.",
    ),
    key(
        "spin",
        false,
        Spread(&units::ANGULAR_VELOCITY, ["-1000 rad/s", "1000 rad/s"]),
        "How fast it turns at the first touch, about the axis about which it is tilted: positive where the tilt grows, negative where it \
         closes; speed and height stay those of the center of mass, and what touches first must come down. Of a box that lands on a face, \
         edge or corner, about the level axis about which it is turned off that, which is any. 0 rad/s unless given; not with standard.",
    ),
    key(
        "face",
        false,
        Texts,
        "Of a box, one with a thickness: the face it lands on: end-a, end-b, front, back, bottom or top; a list of them drop by drop, or \"all\".",
    ),
    key(
        "edge",
        false,
        Texts,
        "Of a box: two faces that meet in the edge it lands on, such as \"bottom front\"; a list of them, or \"all\".",
    ),
    key(
        "corner",
        false,
        Texts,
        "Of a box: three faces that meet in the corner it lands on, such as \"bottom front end-a\"; a list of them, or \"all\".",
    ),
    key(
        "standard",
        false,
        Text,
        "Of a box: the drops that a standard lists, each from its height, such as \"MIL-STD-810H/516.8-IV\".",
    ),
    key(
        "attitude_tolerance",
        false,
        Quantity(&units::ANGLE, ["0 deg", "15 deg"]),
        "By how much a box may be turned off its face, edge, corner or tilt, in any direction; as in ASTM D5276 2 deg of a face and 5 deg \
         of an edge or a corner unless given.",
    ),
    key(
        "first",
        false,
        Choice(&["a", "b", "either"]),
        "Which end touches first; either unless given. Of a plate its direction tells it.",
    ),
    key(
        "direction",
        false,
        Spread(&units::ANGLE, ["0 deg", "360 deg"]),
        "Of a plate: where it rises to from its lowest corner, from 0 deg along the length, towards end b, to 90 deg along the width; any \
         direction unless given.",
    ),
    key(
        "gravity",
        false,
        Quantity(&units::ACCELERATION, ["0 gn", "100 gn"]),
        "Gravity during the clatter; 1 gn unless given, 0 gn switches it off.",
    ),
];

pub(crate) static COMPONENT: &[Key] = &[
    key("name", true, Text, "Name of the part."),
    key(
        "position",
        true,
        Sides(&Spread(&units::LENGTH, PLACES)),
        "Where its middle is, from the middle of the product towards end b; of a plate across it too.",
    ),
    key(
        "extent",
        false,
        Sides(&Quantity(&units::LENGTH, ["0 mm", "100 m"])),
        "How far it extends along the bar; 0 mm unless given; of a plate across it too. All of it lies within the product.",
    ),
    key(
        "height",
        false,
        Quantity(&units::LENGTH, PLACES),
        "Where its middle is across the thickness of a box, from the middle towards the top, within the product; 0 mm unless given.",
    ),
    key(
        "axis",
        false,
        Choice(&["x", "y", "z", "any"]),
        "Along which axis of a box it moves and is shaken: x along the length, y along the width, z along the thickness. Unless given, a \
         part on a suspension moves along z, and one that is mounted rigidly is judged along the blow, which is any: by the magnitude.",
    ),
    key(
        "mount",
        false,
        Choice(&["hard", "suspended"]),
        "hard: mounted rigidly; suspended (unless given): with a natural frequency.",
    ),
    key(
        "natural_frequency",
        false,
        Spread(&units::FREQUENCY, ["0.1 Hz", "1000 kHz"]),
        "Natural frequency of a suspended part.",
    ),
    key(
        "damping_ratio",
        false,
        Spread(&units::SHARE, ["0", "100"]),
        "Damping ratio of a suspended part. Either this or quality_factor.",
    ),
    key(
        "quality_factor",
        false,
        Spread(&units::NUMBER, ["0.005", "1e9"]),
        "Quality factor 1/(2 damping ratio). Either this or damping_ratio.",
    ),
    key(
        "stop",
        false,
        Table(STOP),
        "The stops of a suspended part, which it presses beyond this gap on either side, beside its spring and damper.",
    ),
    key(
        "acceleration_limit",
        false,
        Spread(&units::ACCELERATION, ["1e-3 gn", "1e7 gn"]),
        "Largest absolute acceleration of the part that does no damage.",
    ),
    key(
        "rattle_space",
        false,
        Spread(&units::LENGTH, ["1e-3 um", "100 m"]),
        "Free space around a suspended part: its largest displacement relative to the product.",
    ),
    key(
        "velocity_change_limit",
        false,
        Spread(&units::SPEED, ["1e-3 mm/s", "1000 m/s"]),
        "Largest single velocity shock of the product at the part.",
    ),
    key(
        "angular_velocity_change_limit",
        false,
        Spread(&units::ANGULAR_VELOCITY, ["1e-3 rad/s", "1e6 rad/s"]),
        "Largest single change of the angular velocity of the product.",
    ),
    key(
        "stop_speed_limit",
        false,
        Spread(&units::SPEED, ["1e-3 mm/s", "1000 m/s"]),
        "Largest speed at which the part may reach its stop, relative to the product.",
    ),
    key("damage_boundary", false, Table(BOUNDARY), "Shocks at the part do damage beyond both of these alone."),
    key("limit_source", false, Text, "Where its limits are from, such as a data sheet; the printed report tells it."),
];

pub(crate) static STOP: &[Key] = &[
    key(
        "gap",
        true,
        Spread(&units::LENGTH, ["1e-3 um", "100 m"]),
        "The room from the part at rest to the stop; at most the rattle_space.",
    ),
    key(
        "contact_time",
        true,
        Spread(&units::TIME, ["1 us", "100 ms"]),
        "How long a contact of the part alone with the stop takes, at most the period of the part: of bare plastics and metal 0.2 ms, of foam \
         and rubber 1 ms and more.",
    ),
    key(
        "restitution",
        true,
        Spread(&units::SHARE, ["0", "1"]),
        "Coefficient of restitution of the stop: rebound over approach speed.",
    ),
];

pub(crate) static BOUNDARY: &[Key] = &[
    key("velocity_change", true, Spread(&units::SPEED, ["1e-3 mm/s", "1000 m/s"]), "Critical velocity change."),
    key("acceleration", true, Spread(&units::ACCELERATION, ["1e-3 gn", "1e7 gn"]), "Critical acceleration."),
];

pub(crate) static VERDICT: &[Key] = &[
    key(
        "reliability",
        true,
        Quantity(&units::SURE, VERDICT_SHARES),
        "The share of all products that is to survive, such as \"99 %\": products are drawn until so many hold in a row that this is sure.",
    ),
    key("confidence", false, Quantity(&units::SURE, VERDICT_SHARES), "How sure that is to be; \"95 %\" unless given."),
];

pub(crate) static RECORD: &[Key] = &[
    key(
        "file",
        true,
        Text,
        "The file, from where the product file is: strikes, heights of the ends, or an acceleration.",
    ),
    key(
        "drop",
        false,
        Text,
        "Name of the drop that was measured; records of one drop share it. A record without is of a drop of its own.",
    ),
    key(
        "position",
        false,
        Quantity(&units::LENGTH, PLACES),
        "Where an acceleration was measured, from the middle towards end b.",
    ),
    key(
        "acceleration",
        false,
        Text,
        "Column of the acceleration across the product, upward positive, by its name or number, where there are several.",
    ),
    key("units", false, Text, "Units where the file does not name them, such as \"ms,g\"."),
    key(
        "sample_rate",
        false,
        Quantity(&units::FREQUENCY, ["1 Hz", "1e6 kHz"]),
        "Samples a second, where the file has no times.",
    ),
    key(
        "timing",
        false,
        Quantity(&units::TIME, ["1e-9 s", "1 s"]),
        "Standard deviation of the times of strikes; unless given, their scatter tells it.",
    ),
];

/// A plan of a study.
pub(crate) static PLAN: &[Key] = &[
    key("product", true, Text, "The product file, from where the plan is."),
    key(
        "samples",
        false,
        Quantity(&units::NUMBER, ["1", "1e12"]),
        "How many drops of each product are drawn; needed but for a search.",
    ),
    key(
        "seed",
        false,
        Quantity(&units::NUMBER, ["0", "9007199254740992"]),
        "Another seed draws other drops; 1 unless given.",
    ),
    key("search", false, Flag, "true: the worst drop of each product is searched, and none are drawn."),
    key("grid", false, Table(&[]), "Quantities of the product file that vary, by table and key, each over its values."),
];

/// Returns the key of a table by its name.
pub(crate) fn find(table: &'static [Key], name: &str) -> Option<&'static Key> {
    table.iter().find(|key| key.name == name)
}

/// Returns whether a value in SI is within bounds as a key has them. One with a unit was converted: it is a bound but for roundings.
pub(crate) fn within(dimension: &Dimension, bounds: [&str; 2], si: f64) -> bool {
    let roundings = if dimension.plain { 0.0 } else { 4.0 * f64::EPSILON };
    let [lo, hi] = bounds.map(|bound| dimension.value(bound));
    (lo - roundings * lo.abs()..=hi + roundings * hi.abs()).contains(&si)
}

/// Returns the words of messages for bounds.
pub(crate) fn allowed(bounds: [&str; 2]) -> String {
    format!("from {} to {}", bounds[0], bounds[1])
}
