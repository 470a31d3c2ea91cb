//! A product file: the body, its drop, and the limits of its parts.

use crate::flight::{Drop, Law, Own};
use crate::part::{Stop, Suspension};
use toml::{Table, Value};

/// Begin and end of a range.
pub type Range = [f64; 2];

/// The kind of a limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// Absolute acceleration of a suspended part, acceleration above free fall of a hard-mounted one.
    Acceleration,
    /// Displacement of a suspended part.
    RattleSpace,
    /// Speed at which a suspended part reaches its stop.
    StopSpeed,
    /// Velocity change of one shock.
    VelocityChange,
    /// Change of the angular velocity of one shock.
    AngularVelocityChange,
    /// Velocity change and acceleration of one shock, as a share of these.
    DamageBoundary(f64, f64),
}

impl Kind {
    /// Returns its name in `clatter assess`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Acceleration => "acceleration",
            Self::RattleSpace => "rattle-space",
            Self::StopSpeed => "stop-speed",
            Self::VelocityChange => "velocity-change",
            Self::AngularVelocityChange => "angular-velocity-change",
            Self::DamageBoundary(..) => "damage-boundary",
        }
    }
}

/// The ranges of what holds a suspended part.
#[derive(Debug, Clone, Copy)]
pub struct Suspensions {
    /// Natural angular frequency.
    pub omega: Range,
    /// Damping ratio.
    pub zeta: Range,
    /// Gap, contact time and restitution of its stops.
    pub stop: Option<[Range; 3]>,
}

impl Suspensions {
    /// Returns the suspension at shares of its ranges from 0 to 1: frequency, damping, and those of the stops.
    pub(crate) fn at(&self, omega: f64, zeta: f64, stops: &[f64]) -> Suspension {
        let stop = self.stop.map(|of| {
            let [gap, time, e] = [0, 1, 2].map(|i| between(of[i], stops[i]));
            Stop { gap, time, e }
        });
        Suspension { omega: between(self.omega, omega), zeta: between(self.zeta, zeta), stop }
    }
}

/// A fragile part.
#[derive(Debug, Clone)]
pub struct Part {
    /// Its name.
    pub name: String,
    /// Range of its place from the center of mass towards end b, with its extent.
    pub place: Range,
    /// What holds it; none for a hard-mounted part.
    pub suspension: Option<Suspensions>,
    /// Its limits.
    pub limits: Vec<Kind>,
}

/// A product and its drop; SI units.
#[derive(Debug, Clone)]
pub struct Product {
    length: f64,
    gyration: f64,
    center: f64,
    e: Range,
    contact: Option<(Law, Range)>,
    own: [Own; 2],
    speed: Range,
    tilt: Range,
    spin: Range,
    first: Vec<bool>,
    gravity: f64,
    /// The parts.
    pub parts: Vec<Part>,
}

/// A drop and a part within all ranges, each from 0 to 1: restitution, contact time, speed, tilt, first end, place,
/// frequency, damping, spin, and gap, contact time and restitution of stops.
pub type Sample = [f64; 12];

fn between(range: Range, share: f64) -> f64 {
    range[0] + (range[1] - range[0]) * share
}

impl Product {
    /// Returns the drop of a sample.
    #[must_use]
    pub fn drop(&self, sample: &Sample) -> Drop {
        let end = ((sample[4] * self.first.len() as f64) as usize).min(self.first.len() - 1);
        Drop {
            length: self.length,
            gyration: self.gyration,
            center: self.center,
            e: between(self.e, sample[0]),
            contact: self.contact.map(|(law, time)| (law, between(time, sample[1]))),
            own: self.own,
            speed: between(self.speed, sample[2]),
            tilt: between(self.tilt, sample[3]),
            spin: between(self.spin, sample[8]),
            b_first: self.first[end],
            gravity: self.gravity,
        }
    }

    /// Returns whether it turns as it lands, at some spin of a range.
    #[must_use]
    pub fn spins(&self) -> bool {
        self.spin[1] > self.spin[0]
    }

    /// Returns whether a part of it has stops.
    #[must_use]
    pub fn has_stops(&self) -> bool {
        self.parts.iter().any(|part| part.suspension.is_some_and(|suspension| suspension.stop.is_some()))
    }

    /// Reads a product file.
    ///
    /// # Errors
    /// A message about a part of the file that is missing or not understood.
    pub fn read(text: &str) -> Result<Self, String> {
        let file: Table = text.parse().map_err(|error: toml::de::Error| error.to_string())?;
        let table = |key: &str| file.get(key).and_then(Value::as_table).ok_or(format!("no table [{key}]"));
        let (product, drop) = (table("product")?, table("drop")?);
        // The feet are the ends that land.
        let length = one(product, "length")? - 2.0 * optional(product, "feet_inset")?.map_or(0.0, |inset| inset[0]);
        let (gyration, center) = inertia(product)?;
        let gravity = optional(drop, "gravity")?.map_or(9.806_65, |range| range[0]);
        let speed = match optional(drop, "height")? {
            Some(height) => height.map(|height| (2.0 * gravity * height).sqrt()),
            None => range(drop, "speed")?,
        };
        let law = match product.get("contact_law").and_then(Value::as_str) {
            Some("dashpot") => Law::Dashpot,
            None | Some("hysteretic") => Law::Hysteretic,
            Some(law) => return Err(format!("{law} is a contact law that is not followed here")),
        };
        let first = match drop.get("first").and_then(Value::as_str) {
            Some("a") => vec![false],
            Some("b") => vec![true],
            _ => vec![false, true],
        };
        let parts = file.get("component").and_then(Value::as_array).ok_or("no table [[component]]")?;
        Ok(Self {
            length,
            gyration,
            center,
            e: range(product, "restitution")?,
            contact: optional(product, "contact_time")?.map(|time| (law, time)),
            own: own(product)?,
            speed,
            tilt: range(drop, "tilt")?,
            spin: optional(drop, "spin")?.unwrap_or([0.0; 2]),
            first,
            gravity,
            parts: parts.iter().filter_map(Value::as_table).map(|t| part(t, center)).collect::<Result<_, _>>()?,
        })
    }
}

impl Part {
    /// Returns whether any value of it is a range.
    #[must_use]
    pub fn varies(&self) -> bool {
        let wide = |range: Range| range[1] > range[0];
        let held = |of: Suspensions| {
            wide(of.omega) || wide(of.zeta) || of.stop.is_some_and(|stop| stop.iter().any(|&of| wide(of)))
        };
        wide(self.place) || self.suspension.is_some_and(held)
    }

    /// Returns the place from the center of mass and the suspension of a sample.
    #[must_use]
    pub fn at(&self, sample: &Sample) -> (f64, Option<Suspension>) {
        let suspension = self.suspension.map(|of| of.at(sample[6], sample[7], &sample[9..]));
        (between(self.place, sample[5]), suspension)
    }
}

fn part(table: &Table, center: f64) -> Result<Part, String> {
    let [from, to] = range(table, "position")?;
    let half = optional(table, "extent")?.map_or(0.0, |extent| extent[0] / 2.0);
    let suspension = match optional(table, "natural_frequency")? {
        None => None,
        Some(frequency) => {
            let zeta = match optional(table, "quality_factor")? {
                Some([low, high]) => [0.5 / high, 0.5 / low],
                None => range(table, "damping_ratio")?,
            };
            Some(Suspensions { omega: frequency.map(|f| f * std::f64::consts::TAU), zeta, stop: stops(table)? })
        }
    };
    let kinds = [
        ("acceleration_limit", Kind::Acceleration),
        ("rattle_space", Kind::RattleSpace),
        ("stop_speed_limit", Kind::StopSpeed),
        ("velocity_change_limit", Kind::VelocityChange),
        ("angular_velocity_change_limit", Kind::AngularVelocityChange),
    ];
    let is_known = |key: &String| kinds.iter().any(|(known, _)| key == known) || key == "limit_source";
    if let Some(key) = table.keys().find(|key| key.contains("limit") && !is_known(key)) {
        return Err(format!("{key} is a limit that is not followed here"));
    }
    let mut limits: Vec<Kind> =
        kinds.into_iter().filter(|(key, _)| table.contains_key(*key)).map(|(_, kind)| kind).collect();
    if let Some(boundary) = table.get("damage_boundary").and_then(Value::as_table) {
        limits.push(Kind::DamageBoundary(one(boundary, "velocity_change")?, one(boundary, "acceleration")?));
    }
    let name = table.get("name").and_then(Value::as_str).ok_or("a component without a name")?.to_owned();
    Ok(Part { name, place: [from - half - center, to + half - center], suspension, limits })
}

/// Returns the ranges of the stops of a part: gap, contact time and restitution.
fn stops(part: &Table) -> Result<Option<[Range; 3]>, String> {
    let Some(stop) = part.get("stop").and_then(Value::as_table) else { return Ok(None) };
    Ok(Some([range(stop, "gap")?, range(stop, "contact_time")?, range(stop, "restitution")?]))
}

/// Returns the ranges of the stops in the text of a part.
pub(crate) fn stops_of(text: &str) -> Option<[Range; 3]> {
    stops(&text.parse().ok()?).ok()?
}

/// Returns the largest gap of the stops of each part of a file, 0 where it has none.
pub(crate) fn gaps(text: &str) -> Vec<f64> {
    let file: Table = text.parse().unwrap_or_default();
    let parts = file.get("component").and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_table);
    parts.map(|part| stops(part).ok().flatten().map_or(0.0, |[gap, ..]| gap[1])).collect()
}

/// Returns the radius of gyration and the center of mass.
fn inertia(product: &Table) -> Result<(f64, f64), String> {
    let center = optional(product, "center_of_mass")?.map_or(0.0, |range| range[0]);
    if product.contains_key("radius_of_gyration") {
        return Ok((one(product, "radius_of_gyration")?, center));
    }
    if product.contains_key("moment_of_inertia") {
        return Ok(((one(product, "moment_of_inertia")? / one(product, "mass")?).sqrt(), center));
    }
    // Mass, first and second moment about the middle.
    let mut sums = [0.0; 3];
    for piece in product.get("masses").and_then(Value::as_array).ok_or("no inertia")?.iter().filter_map(Value::as_table)
    {
        let mass = one(piece, "mass")?;
        let (middle, width) = match optional(piece, "position")? {
            Some(at) => (at[0], 0.0),
            None => (f64::midpoint(one(piece, "from")?, one(piece, "to")?), one(piece, "to")? - one(piece, "from")?),
        };
        for (sum, add) in sums.iter_mut().zip([1.0, middle, middle * middle + width * width / 12.0]) {
            *sum += mass * add;
        }
    }
    let center = sums[1] / sums[0];
    Ok(((sums[2] / sums[0] - center * center).sqrt(), center))
}

/// Returns the own contacts of ends a and b.
fn own(product: &Table) -> Result<[Own; 2], String> {
    let mut own = [Own::default(); 2];
    for contact in product.get("contacts").and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_table) {
        let end = match contact.get("at").and_then(Value::as_str) {
            Some("a") => 0,
            Some("b") => 1,
            at => return Err(format!("{at:?} is no end")),
        };
        let of = |key: &str| optional(contact, key).map(|range| range.map(|range| range[0]));
        own[end] = Own { e: of("restitution")?, time: of("contact_time")? };
    }
    Ok(own)
}

fn one(table: &Table, key: &str) -> Result<f64, String> {
    range(table, key).map(|range| range[0])
}

fn range(table: &Table, key: &str) -> Result<Range, String> {
    optional(table, key)?.ok_or(format!("no {key}"))
}

fn optional(table: &Table, key: &str) -> Result<Option<Range>, String> {
    table.get(key).map(|value| spread(value).ok_or(format!("{key} = {value:?}: not understood"))).transpose()
}

/// Returns a value, a range, or the bounds of a distribution.
fn spread(value: &Value) -> Option<Range> {
    match value {
        Value::Array(list) => Some([quantity(list.first()?)?, quantity(list.last()?)?]),
        Value::Table(table) => spread(table.get("range").or(table.get("uniform")).or(table.get("triangular"))?),
        _ => quantity(value).map(|value| [value, value]),
    }
}

/// Returns a number with its unit, in SI.
fn quantity(value: &Value) -> Option<f64> {
    let text = match value {
        Value::Float(number) => return Some(*number),
        Value::Integer(number) => return Some(*number as f64),
        _ => value.as_str()?,
    };
    let (number, unit) = text.trim().split_once(' ').unwrap_or((text, ""));
    let factor = match unit.trim() {
        "" | "m" | "kg" | "s" | "Hz" | "m/s" | "m/s2" | "rad" | "rad/s" | "kg m2" => 1.0,
        "mm" | "g" | "ms" | "mm/s" => 1e-3,
        "um" | "us" | "mg" => 1e-6,
        "cm" | "%" => 1e-2,
        "kHz" => 1e3,
        "deg" | "deg/s" => std::f64::consts::PI / 180.0,
        "gn" => 9.806_65,
        _ => return None,
    };
    number.parse::<f64>().ok().map(|number| number * factor)
}
