//! Values that are allowed and that no product has: most of them are slips of the unit.

use crate::STANDARD_GRAVITY_M_S2;
use crate::units::{ACCELERATION, Dimension, FREQUENCY, LENGTH, MASS, Quantity, SHARE, SPEED, TIME, Unit};

/// The usual values of products, by the key of the product file, in SI: far apart, so that no sound product is doubted.
static USUAL: [(&str, &Dimension, [f64; 2]); 12] = [
    ("length", &LENGTH, [2e-3, 10.0]),
    ("radius_of_gyration", &LENGTH, [2e-4, 5.0]),
    ("mass", &MASS, [1e-5, 200.0]),
    ("contact_time", &TIME, [2e-6, 0.05]),
    ("height", &LENGTH, [1e-3, 50.0]),
    ("speed", &SPEED, [1e-3, 50.0]),
    ("natural_frequency", &FREQUENCY, [0.5, 2e5]),
    // A part of critical damping, 1, does not swing any more.
    ("damping_ratio", &SHARE, [0.0, 1.5]),
    ("acceleration_limit", &ACCELERATION, [STANDARD_GRAVITY_M_S2, 1e5 * STANDARD_GRAVITY_M_S2]),
    ("acceleration", &ACCELERATION, [STANDARD_GRAVITY_M_S2, 1e5 * STANDARD_GRAVITY_M_S2]),
    ("rattle_space", &LENGTH, [1e-5, 0.5]),
    ("friction", &SHARE, [0.0, 2.0]),
];

/// The reach of a mass over the half-length, beyond which it is doubted.
const BEYOND: f64 = 1.2;

/// A value that is likely a slip.
#[derive(Debug, Clone, PartialEq)]
pub struct Slip {
    /// The odd value and the usual range, as a message.
    pub message: String,
    /// The value that may be meant, such as "150 mm?"; may be empty.
    pub hint: String,
}

/// Tells that a value of a key of the product file, or of what the command line calls alike, is one that no product has.
///
/// ```
/// use clatter_product::{slip, units::LENGTH};
/// let said = slip("length", &LENGTH.read("150 m").unwrap()).unwrap();
/// assert_eq!(said.to_string(), "a length of 150 m is none that products have, from 2 mm to 10 m: 150 mm?");
/// ```
#[must_use]
pub fn slip(key: &str, quantity: &Quantity) -> Option<Slip> {
    let (_, dimension, [lo, hi]) = USUAL.iter().find(|(name, ..)| *name == key)?;
    let usual = |si: f64| (*lo..=*hi).contains(&si);
    if usual(quantity.si) {
        return None;
    }
    let (number, written) = shown(quantity, dimension);
    let hint = dimension.units.iter().find(|unit| usual(unit.to_si(number)));
    let hint = hint.map_or(String::new(), |unit| format!("{} {}?", short(number), unit.name));
    let range = [*lo, *hi].map(|si| in_words(si, dimension));
    let message = format!("{} of {written} is none that products have, from {} to {}", named(key), range[0], range[1]);
    Some(Slip { message, hint })
}

/// Tells that a mass is far outside of a body of this length; its place is from the middle.
#[must_use]
pub fn outside(place: &Quantity, length_m: f64) -> Option<Slip> {
    let half = 0.5 * length_m;
    let within = |m: f64| m.abs() <= BEYOND * half;
    if within(place.si) {
        return None;
    }
    let (number, written) = shown(place, &LENGTH);
    let hint = LENGTH.units.iter().find(|unit| within(unit.to_si(number)) && unit.to_si(number).abs() > 1e-3 * half);
    let hint = hint.map_or(String::new(), |unit| format!("{} {}?", short(number), unit.name));
    let message = format!(
        "a mass at {written} is outside of the body, which reaches {} from its middle",
        in_words(half, &LENGTH)
    );
    Some(Slip { message, hint })
}

impl std::fmt::Display for Slip {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let colon = if self.hint.is_empty() { "" } else { ": " };
        write!(f, "{}{colon}{}", self.message, self.hint)
    }
}

/// Returns the number that was written, and the same with its unit.
fn shown(quantity: &Quantity, dimension: &Dimension) -> (f64, String) {
    let unit = quantity.unit.or(dimension.si_unit());
    let number = unit.map_or(quantity.si, |unit| unit.of_si(quantity.si));
    (number, with(number, unit))
}

/// Returns a value in the largest unit in which it is 1 or more.
fn in_words(si: f64, dimension: &Dimension) -> String {
    let metric =
        |unit: &&Unit| ["m", "mm", "kg", "g", "mg", "s", "ms", "us", "Hz", "kHz", "m/s", "gn"].contains(&unit.name);
    let all = dimension.units.iter().filter(metric).filter(|unit| unit.of_si(si) >= 1.0 - 1e-9);
    let unit = all.min_by(|a, b| a.of_si(si).total_cmp(&b.of_si(si))).or(dimension.si_unit());
    with(unit.map_or(si, |unit| unit.of_si(si)), unit)
}

fn with(number: f64, unit: Option<&Unit>) -> String {
    let blank = if unit.is_some() { " " } else { "" };
    format!("{}{blank}{}", short(number), unit.map_or("", |unit| unit.name))
}

/// Returns a number without the digits that a conversion adds.
fn short(x: f64) -> String {
    let rounded: f64 = format!("{x:.9e}").parse().unwrap_or(x);
    if (1e-4..1e7).contains(&rounded.abs()) || rounded == 0.0 { rounded.to_string() } else { format!("{rounded:e}") }
}

/// Returns "a length", from the name of a key.
fn named(key: &str) -> String {
    let article = if key.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" };
    format!("{article} {}", key.replace('_', " "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_are_named() {
        for (key, dimension, text, said) in [
            ("length", &LENGTH, "150 m", "a length of 150 m is none that products have, from 2 mm to 10 m: 150 mm?"),
            ("damping_ratio", &SHARE, "10", "a damping ratio of 10 is none that products have, from 0 to 1.5: 10 %?"),
            (
                "contact_time",
                &TIME,
                "0.4 s",
                "a contact time of 0.4 s is none that products have, from 2 us to 50 ms: 0.4 ms?",
            ),
            (
                "natural_frequency",
                &FREQUENCY,
                "900 kHz",
                "a natural frequency of 900 kHz is none that products have, from 0.5 Hz to 200 kHz: 900 Hz?",
            ),
            (
                "acceleration_limit",
                &ACCELERATION,
                "4e5 g",
                "an acceleration limit of 400000 gn is none that products have, from 1 gn to 100000 gn: 400000 m/s2?",
            ),
            ("mass", &MASS, "250 kg", "a mass of 250 kg is none that products have, from 10 mg to 200 kg: 250 g?"),
        ] {
            assert_eq!(slip(key, &dimension.read(text).unwrap()).unwrap().to_string(), said);
        }
        assert_eq!(slip("length", &LENGTH.read("1.9 m").unwrap()), None);
        let mass = |text: &str| outside(&LENGTH.read(text).unwrap(), 0.14).map(|slip| slip.to_string());
        assert_eq!(
            mass("5 m").unwrap(),
            "a mass at 5 m is outside of the body, which reaches 70 mm from its middle: 5 mm?"
        );
        assert_eq!(mass("-75 mm"), None);
    }
}
