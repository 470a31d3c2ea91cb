//! Quantities as text: a number and the name of a unit, in product files and on the command line. Factors are those of the
//! crate `uom`.

use uom::si::f64::{Acceleration, Angle, AngularVelocity, Frequency, Length, Mass, MomentOfInertia, Time, Velocity};
use uom::si::{acceleration, angle, angular_velocity, frequency, length, mass, moment_of_inertia, time, velocity};

/// A kind of quantity: its units by name, the SI unit first.
///
/// ```
/// use clatter_product::units::{ACCELERATION, LENGTH};
/// let length = LENGTH.read("70 mm").unwrap();
/// assert_eq!((length.si, length.unit.unwrap().name), (0.07, "mm"));
/// assert_eq!(ACCELERATION.read("2 g").unwrap().si, 2.0 * 9.806_65);
/// assert!(LENGTH.read("70").unwrap_err().contains("has no unit"));
/// ```
#[derive(Debug)]
pub struct Dimension {
    /// Its name in messages.
    pub name: &'static str,
    /// The example of a written quantity.
    pub example: &'static str,
    /// True where a number without a unit is one.
    pub plain: bool,
    /// Its units.
    pub units: &'static [Unit],
}

/// A unit of a quantity.
#[derive(Debug, Clone, Copy)]
pub struct Unit {
    /// Its name, with `2` for a square and a blank for a product.
    pub name: &'static str,
    to_si: fn(f64) -> f64,
}

/// A quantity as it was written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quantity {
    /// Its value in SI.
    pub si: f64,
    /// Its unit; none of a plain number.
    pub unit: Option<&'static Unit>,
}

impl PartialEq for Unit {
    /// A name is one unit within a kind of quantity.
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Unit {
    /// Returns a unit, and its values in SI: a multiple of them.
    #[must_use]
    pub const fn new(name: &'static str, to_si: fn(f64) -> f64) -> Self {
        Self { name, to_si }
    }
    /// Converts a value of this unit to SI.
    #[must_use]
    pub fn to_si(&self, value: f64) -> f64 {
        (self.to_si)(value) + 0.0
    }
    /// Returns a value given in SI, in this unit.
    #[must_use]
    pub fn of_si(&self, si: f64) -> f64 {
        si / (self.to_si)(1.0)
    }
}

impl Quantity {
    /// Returns a quantity that was given in SI, without a unit.
    #[must_use]
    pub fn of_si(si: f64) -> Self {
        Self { si, unit: None }
    }
}

/// Rows of (name, to SI) for one quantity of `uom`.
macro_rules! units {
    ($quantity:ident, $module:ident: $($name:literal $unit:ident),+) => {
        &[$(Unit::new($name, |v| $quantity::new::<$module::$unit>(v).value)),+]
    };
}

/// Lengths.
pub static LENGTH: Dimension = Dimension {
    name: "length",
    example: "70 mm",
    plain: false,
    units: units!(Length, length: "m" meter, "mm" millimeter, "cm" centimeter, "um" micrometer, "in" inch, "ft" foot),
};
/// Masses.
pub static MASS: Dimension = Dimension {
    name: "mass",
    example: "190 g",
    plain: false,
    units: units!(Mass, mass: "kg" kilogram, "g" gram, "mg" milligram, "lb" pound, "oz" ounce),
};
/// Moments of inertia.
pub static MOMENT_OF_INERTIA: Dimension = Dimension {
    name: "moment of inertia",
    example: "350 kg mm2",
    plain: false,
    units: &[
        Unit::new("kg m2", |v| MomentOfInertia::new::<moment_of_inertia::kilogram_square_meter>(v).value),
        Unit::new("kg cm2", |v| v * 1e-4),
        Unit::new("kg mm2", |v| v * 1e-6),
        Unit::new("g cm2", |v| v * 1e-7),
        Unit::new("g mm2", |v| v * 1e-9),
    ],
};
/// Times.
pub static TIME: Dimension = Dimension {
    name: "time",
    example: "0.4 ms",
    plain: false,
    units: units!(Time, time: "s" second, "ms" millisecond, "us" microsecond, "min" minute, "h" hour),
};
/// Velocities.
pub static SPEED: Dimension = Dimension {
    name: "velocity",
    example: "4.85 m/s",
    plain: false,
    units: units!(Velocity, velocity: "m/s" meter_per_second, "mm/s" millimeter_per_second, "cm/s" centimeter_per_second,
        "km/h" kilometer_per_hour, "in/s" inch_per_second, "ft/s" foot_per_second),
};
/// Angles.
pub static ANGLE: Dimension = Dimension {
    name: "angle",
    example: "5 deg",
    plain: false,
    units: units!(Angle, angle: "rad" radian, "deg" degree, "°" degree),
};
/// Accelerations; a gram cannot be meant here, so that `g` is standard gravity.
pub static ACCELERATION: Dimension = Dimension {
    name: "acceleration",
    example: "400 gn",
    plain: false,
    units: units!(Acceleration, acceleration: "m/s2" meter_per_second_squared, "gn" standard_gravity,
        "g" standard_gravity, "G" standard_gravity),
};
/// Frequencies.
pub static FREQUENCY: Dimension = Dimension {
    name: "frequency",
    example: "180 Hz",
    plain: false,
    units: units!(Frequency, frequency: "Hz" hertz, "kHz" kilohertz),
};
/// Angular velocities.
pub static ANGULAR_VELOCITY: Dimension = Dimension {
    name: "angular velocity",
    example: "60 rad/s",
    plain: false,
    units: units!(AngularVelocity, angular_velocity: "rad/s" radian_per_second, "deg/s" degree_per_second,
        "rpm" revolution_per_minute),
};
/// A share, as a number or a percentage.
pub static SHARE: Dimension =
    Dimension { name: "number", example: "0.3", plain: true, units: &[Unit::new("%", |v| v / 100.0)] };
/// Shares that are neither nothing nor all, such as a reliability.
pub static SURE: Dimension =
    Dimension { name: "share below 1", example: "0.99", plain: true, units: &[Unit::new("%", |v| v / 100.0)] };
/// A plain number.
pub static NUMBER: Dimension = Dimension { name: "number", example: "0.3", plain: true, units: &[] };

impl Dimension {
    /// Returns the names of its units.
    #[must_use]
    pub fn names(&self) -> String {
        let names: Vec<_> = self.units.iter().map(|unit| unit.name).collect();
        names.join(", ")
    }
    /// Returns the unit of this name; of several spellings of one unit the first, in which answers are reported.
    #[must_use]
    pub fn unit(&self, name: &str) -> Option<&'static Unit> {
        let named = self.units.iter().find(|unit| unit.name == name)?;
        self.units.iter().find(|unit| unit.to_si(1.0).to_bits() == named.to_si(1.0).to_bits())
    }
    /// Returns the SI unit; none of a kind that has plain numbers.
    #[must_use]
    pub fn si_unit(&self) -> Option<&'static Unit> {
        if self.plain { None } else { self.units.first() }
    }
    /// Returns "an angle", "a length".
    #[must_use]
    pub fn one(&self) -> String {
        let article = if self.name.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" };
        format!("{article} {}", self.name)
    }

    /// Reads a quantity, or reports the fault of the text.
    ///
    /// Products may be written with a blank, `*` or `·`, squares as `2`, `^2` or `²`.
    ///
    /// # Errors
    /// Returns the fault, with the text and the allowed values.
    pub fn read(&self, text: &str) -> Result<Quantity, String> {
        let example = self.example;
        let text = text.trim();
        if text.len() > LONGEST {
            return Err(format!("this is no {} such as \"{example}\"", self.name));
        }
        let (number, unit) =
            split(text).ok_or_else(|| format!("{text:?} does not begin with a number such as \"{example}\""))?;
        if !number.is_finite() {
            return Err(format!("{text:?} is beyond the range of numbers"));
        }
        match (unit, self.units) {
            ("", _) if self.plain => Ok(Quantity { si: number, unit: None }),
            ("", _) => Err(format!("{text:?} has no unit: one of {}, as in \"{example}\"", self.names())),
            (_, []) => Err(format!("{text:?} has a unit, and this is a plain number")),
            _ => {
                let found = self.unit(&spelled(unit));
                let unit =
                    found.ok_or_else(|| format!("{unit:?} is no unit of {}: one of {}", self.name, self.names()))?;
                Ok(Quantity { si: unit.to_si(number), unit: Some(unit) })
            }
        }
    }
    /// Returns the value in SI of a text of our own; not a number where it is none.
    pub(crate) fn value(&self, text: &str) -> f64 {
        self.read(text).map_or(f64::NAN, |quantity| quantity.si)
    }
}

/// Returns a unit as the tables have it, of the spellings that there are.
fn spelled(unit: &str) -> String {
    // The micro sign and the Greek letter look alike.
    let unit = unit.replace("^2", "2").replace('²', "2").replace(['*', '·'], " ").replace(['µ', 'μ'], "u");
    let words: Vec<_> = unit.split_whitespace().collect();
    words.join(" ").replace(" /", "/").replace("/ ", "/")
}

/// Returns a regular expression of the spellings of a unit that [`Dimension::read`] takes.
pub(crate) fn pattern(unit: &Unit) -> String {
    let mut pattern = String::new();
    for c in unit.name.chars() {
        match c {
            '2' => pattern.push_str(r"(2|\^2|²)"),
            ' ' => pattern.push_str(r"(\s*[*·]\s*|\s+)"),
            '/' => pattern.push_str(r"\s*/\s*"),
            'u' => pattern.push_str("[uµμ]"),
            c => pattern.push(c),
        }
    }
    pattern
}

/// No quantity needs more characters.
const LONGEST: usize = 64;

/// Returns the longest beginning that is a number, and the rest without the blanks before it.
pub(crate) fn split(text: &str) -> Option<(f64, &str)> {
    let numeric = |c: char| c.is_ascii_digit() || "+-.eE".contains(c);
    let mut end = text.find(|c| !numeric(c)).unwrap_or(text.len());
    loop {
        if let Ok(number) = text.get(..end)?.parse::<f64>() {
            return Some((number, text[end..].trim_start()));
        }
        end = end.checked_sub(1)?;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantities_are_numbers_with_units() {
        for (dimension, text, si) in [
            (&LENGTH, "70 mm", 0.07),
            (&LENGTH, "1.2m", 1.2),
            (&LENGTH, "-2e1 mm", -0.02),
            (&LENGTH, "1 in", 0.0254),
            (&ACCELERATION, "400 gn", 400.0 * 9.80665),
            (&MOMENT_OF_INERTIA, "350  kg mm2", 350e-6),
            (&ANGLE, "180°", std::f64::consts::PI),
            (&NUMBER, "0.3", 0.3),
            (&FREQUENCY, "0.18kHz", 180.0),
            (&TIME, "300 µs", 3e-4),
            (&SPEED, "50 in/s", 1.27),
            (&ANGULAR_VELOCITY, "60 rpm", std::f64::consts::TAU),
            (&MASS, "190 g", 0.19),
            (&ACCELERATION, "400 g", 400.0 * 9.80665),
            (&ACCELERATION, "400G", 400.0 * 9.80665),
            (&ACCELERATION, "15 m/s^2", 15.0),
            (&ACCELERATION, "15 m / s²", 15.0),
            (&MOMENT_OF_INERTIA, "350 kg*mm^2", 350e-6),
            (&MOMENT_OF_INERTIA, "3 kg·m²", 3.0),
            (&MOMENT_OF_INERTIA, "3 kg * m^2", 3.0),
            (&TIME, "300 μs", 3e-4),
            (&SHARE, "5 %", 0.05),
            (&SHARE, "30%", 0.3),
            (&SHARE, "0.3", 0.3),
        ] {
            let value = dimension.read(text).unwrap().si;
            assert!((value - si).abs() <= 2.0 * f64::EPSILON * si.abs(), "{text}: {value}"); // a product of two roundings
        }
    }

    #[test]
    fn what_is_none_is_told() {
        for (dimension, text, said) in [
            (&LENGTH, "70", "has no unit: one of m, mm"),
            (&LENGTH, "70 kg", "\"kg\" is no unit of length"),
            (&LENGTH, "mm", "does not begin with a number"),
            (&LENGTH, "", "does not begin with a number"),
            (&LENGTH, "1,2 m", "\",2 m\" is no unit"),
            (&LENGTH, "nan m", "does not begin with a number"),
            (&LENGTH, "1e999 m", "beyond the range"),
            (&ACCELERATION, "400 kg", "\"kg\" is no unit of acceleration: one of m/s2, gn, g, G"),
            (&SHARE, "5 %%", "\"%%\" is no unit of number"),
            (&LENGTH, "1 m^2", "\"m^2\" is no unit of length"),
            (&NUMBER, "0.3 m", "has a unit"),
            (&LENGTH, "１ m", "does not begin with a number"),
        ] {
            let error = dimension.read(text).unwrap_err();
            assert!(error.contains(said), "{text}: {error}");
        }
        assert!(LENGTH.read(&"9".repeat(100_000)).is_err(), "too long to be a quantity");
    }

    /// Every unit is as large as its definition says: those of inches, pounds and ounces are exact.
    #[test]
    fn every_unit_has_its_size() {
        let degree = std::f64::consts::PI / 180.0;
        let sizes: [(&Dimension, &[f64]); 9] = [
            (&LENGTH, &[1.0, 1e-3, 1e-2, 1e-6, 0.0254, 0.3048]),
            (&MASS, &[1.0, 1e-3, 1e-6, 0.453_592_37, 0.453_592_37 / 16.0]),
            (&MOMENT_OF_INERTIA, &[1.0, 1e-4, 1e-6, 1e-7, 1e-9]),
            (&TIME, &[1.0, 1e-3, 1e-6, 60.0, 3600.0]),
            (&SPEED, &[1.0, 1e-3, 1e-2, 1.0 / 3.6, 0.0254, 0.3048]),
            (&ANGLE, &[1.0, degree, degree]),
            (&ACCELERATION, &[1.0, 9.806_65, 9.806_65, 9.806_65]),
            (&FREQUENCY, &[1.0, 1e3]),
            (&ANGULAR_VELOCITY, &[1.0, degree, std::f64::consts::TAU / 60.0]),
        ];
        for (dimension, sizes) in sizes {
            assert_eq!(dimension.units.len(), sizes.len(), "{}", dimension.name);
            for (unit, size) in dimension.units.iter().zip(sizes) {
                // uom knows an ounce to seven digits.
                assert!((unit.to_si(1.0) / size - 1.0).abs() < 1e-6, "{} is {}", unit.name, unit.to_si(1.0));
            }
        }
    }

    /// Names that are one unit twice would hide a conversion.
    #[test]
    fn every_name_is_one_unit() {
        for d in
            [&LENGTH, &MASS, &MOMENT_OF_INERTIA, &TIME, &SPEED, &ANGLE, &ACCELERATION, &FREQUENCY, &ANGULAR_VELOCITY]
        {
            for (i, unit) in d.units.iter().enumerate() {
                assert!(!d.units[..i].contains(unit), "{} twice", unit.name);
                assert_eq!(spelled(unit.name), unit.name, "as the table has it");
                assert!((unit.of_si(unit.to_si(3.0)) - 3.0).abs() < 1e-15, "{}", unit.name);
                assert!(i > 0 || unit.to_si(3.0).to_bits() == 3.0_f64.to_bits(), "the first unit of {} is SI", d.name);
            }
            assert!(d.read(d.example).is_ok(), "{}", d.example);
        }
    }

    #[test]
    fn a_kind_has_its_article() {
        assert_eq!([&ACCELERATION, &LENGTH, &ANGLE].map(Dimension::one), ["an acceleration", "a length", "an angle"]);
    }
}
