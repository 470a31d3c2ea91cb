//! Quantities as text: a number and the name of a unit. Factors are those of the crate `uom`.

use uom::si::f64::{Acceleration, Angle, AngularVelocity, Frequency, Length, Mass, MomentOfInertia, Time, Velocity};
use uom::si::{acceleration, angle, angular_velocity, frequency, length, mass, moment_of_inertia, time, velocity};

/// A kind of quantity: its units by name, the SI unit first.
#[derive(Debug)]
pub(crate) struct Dimension {
    /// What it is called in messages.
    pub(crate) name: &'static str,
    /// How one is written.
    pub(crate) example: &'static str,
    pub(crate) units: &'static [Unit],
}

/// The name of a unit, and its values in SI.
type Unit = (&'static str, fn(f64) -> f64);

/// Rows of (name, to SI) for one quantity of `uom`.
macro_rules! units {
    ($quantity:ident, $module:ident: $($name:literal $unit:ident),+) => {
        &[$(($name, |v| $quantity::new::<$module::$unit>(v).value)),+]
    };
}

pub(crate) static LENGTH: Dimension = Dimension {
    name: "length",
    example: "70 mm",
    units: units!(Length, length: "m" meter, "mm" millimeter, "cm" centimeter, "um" micrometer, "µm" micrometer,
        "in" inch, "ft" foot),
};
pub(crate) static MASS: Dimension = Dimension {
    name: "mass",
    example: "190 g",
    units: units!(Mass, mass: "kg" kilogram, "g" gram, "mg" milligram, "lb" pound, "oz" ounce),
};
pub(crate) static MOMENT_OF_INERTIA: Dimension = Dimension {
    name: "moment of inertia",
    example: "350 kg mm2",
    units: &[
        ("kg m2", |v| MomentOfInertia::new::<moment_of_inertia::kilogram_square_meter>(v).value),
        ("kg cm2", |v| v * 1e-4),
        ("kg mm2", |v| v * 1e-6),
        ("g cm2", |v| v * 1e-7),
        ("g mm2", |v| v * 1e-9),
    ],
};
pub(crate) static TIME: Dimension = Dimension {
    name: "time",
    example: "0.4 ms",
    units: units!(Time, time: "s" second, "ms" millisecond, "us" microsecond, "µs" microsecond),
};
pub(crate) static SPEED: Dimension = Dimension {
    name: "velocity",
    example: "4.85 m/s",
    units: units!(Velocity, velocity: "m/s" meter_per_second, "mm/s" millimeter_per_second, "cm/s" centimeter_per_second,
        "km/h" kilometer_per_hour, "in/s" inch_per_second, "ft/s" foot_per_second),
};
pub(crate) static ANGLE: Dimension =
    Dimension { name: "angle", example: "5 deg", units: units!(Angle, angle: "rad" radian, "deg" degree, "°" degree) };
pub(crate) static ACCELERATION: Dimension = Dimension {
    name: "acceleration",
    example: "400 gn",
    units: units!(Acceleration, acceleration: "m/s2" meter_per_second_squared, "m/s²" meter_per_second_squared,
        "gn" standard_gravity),
};
pub(crate) static FREQUENCY: Dimension = Dimension {
    name: "frequency",
    example: "180 Hz",
    units: units!(Frequency, frequency: "Hz" hertz, "kHz" kilohertz),
};
pub(crate) static ANGULAR_VELOCITY: Dimension = Dimension {
    name: "angular velocity",
    example: "60 rad/s",
    units: units!(AngularVelocity, angular_velocity: "rad/s" radian_per_second, "deg/s" degree_per_second,
        "rpm" revolution_per_minute),
};
/// A plain number.
pub(crate) static NUMBER: Dimension = Dimension { name: "number", example: "0.3", units: &[] };

impl Dimension {
    /// The names of its units.
    pub(crate) fn names(&self) -> String {
        let names: Vec<_> = self.units.iter().map(|(name, _)| *name).collect();
        names.join(", ")
    }

    /// A quantity in SI, or what is wrong with the text.
    pub(crate) fn read(&self, text: &str) -> Result<f64, String> {
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
        if self.units.is_empty() {
            return if unit.is_empty() {
                Ok(number)
            } else {
                Err(format!("{text:?} has a unit, and this is a plain number"))
            };
        }
        if unit.is_empty() {
            return Err(format!("{text:?} has no unit: one of {}", self.names()));
        }
        let unit: Vec<_> = unit.split_whitespace().collect();
        let unit = unit.join(" ");
        match self.units.iter().find(|(name, _)| *name == unit) {
            Some((_, to_si)) => Ok(to_si(number) + 0.0),
            None if unit == "g" && self.name == ACCELERATION.name => {
                Err("\"g\" is the gram; standard gravity is \"gn\"".to_owned())
            }
            None => Err(format!("{unit:?} is no unit of {}: one of {}", self.name, self.names())),
        }
    }
}

/// No quantity needs more characters.
const LONGEST: usize = 64;

/// The longest beginning that is a number, and the rest without the blanks before it.
fn split(text: &str) -> Option<(f64, &str)> {
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
        ] {
            let value = dimension.read(text).unwrap();
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
            (&ACCELERATION, "400 g", "standard gravity is \"gn\""),
            (&NUMBER, "0.3 m", "has a unit"),
            (&LENGTH, "１ m", "does not begin with a number"),
        ] {
            let error = dimension.read(text).unwrap_err();
            assert!(error.contains(said), "{text}: {error}");
        }
        assert!(LENGTH.read(&"9".repeat(100_000)).is_err(), "too long to be a quantity");
    }

    /// Names that are one unit twice would hide a conversion.
    #[test]
    fn every_name_is_one_unit() {
        for d in
            [&LENGTH, &MASS, &MOMENT_OF_INERTIA, &TIME, &SPEED, &ANGLE, &ACCELERATION, &FREQUENCY, &ANGULAR_VELOCITY]
        {
            for (i, (name, to_si)) in d.units.iter().enumerate() {
                assert!(d.units[..i].iter().all(|(other, _)| other != name), "{name} twice");
                assert!(i > 0 || to_si(3.0).to_bits() == 3.0_f64.to_bits(), "the first unit of {} is SI", d.name);
            }
            assert!(d.read(d.example).is_ok(), "{}", d.example);
        }
    }
}
