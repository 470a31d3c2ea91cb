//! This module reads quantities of the command line by the table of units of product files, and shows them in the unit that was typed.

use clatter::{Mass, Start, center_and_gyration};
pub(crate) use clatter_answer::neat;
use clatter_product::{
    Drop, Input, Optional, Row, Slip, optional_inputs, outside,
    units::{ACCELERATION, ANGLE, Dimension, FREQUENCY, LENGTH, MASS, Quantity, SPEED, TIME, Unit},
};

use crate::Failure;
use crate::inputs::{self, number, part_of};
use crate::numbers::{figures, given};

/// Reads a number in SI, or a quantity with its unit.
pub(crate) fn plain_or_typed(dimension: &'static Dimension, text: &str) -> Result<Quantity, String> {
    let text = text.trim();
    number(text).map(Quantity::of_si).or_else(|none| {
        let begins = text.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
        if begins { dimension.read(text) } else { Err(none) }
    })
}

/// Reads a quantity with its unit whose value in SI is checked.
fn checked(
    dimension: &'static Dimension,
    text: &str,
    check: impl Fn(f64) -> Result<f64, String>,
) -> Result<Quantity, String> {
    let Quantity { si, unit } = dimension.read(text)?;
    check(si).map(|si| Quantity { si, unit })
}

pub(crate) fn length(text: &str) -> Result<Quantity, String> {
    checked(&LENGTH, text, |si| part_of(si, inputs::length_of))
}

pub(crate) fn any_length(text: &str) -> Result<Quantity, String> {
    LENGTH.read(text)
}

pub(crate) fn speed(text: &str) -> Result<Quantity, String> {
    checked(&SPEED, text, |si| part_of(si, inputs::speed_of))
}

pub(crate) fn height(text: &str) -> Result<Quantity, String> {
    checked(&LENGTH, text, |si| part_of(si, inputs::height_of))
}

pub(crate) fn tilt(text: &str) -> Result<Quantity, String> {
    checked(&ANGLE, text, |si| part_of(neat(si.to_degrees()), inputs::tilt_of).map(|_| si))
}

/// Returns the degrees that an angle was typed in: the fewest digits that are the same angle in radians.
pub(crate) fn degrees(angle_rad: f64) -> f64 {
    let close = angle_rad.to_degrees();
    let same = |degrees: &f64| degrees.to_radians().to_bits() == angle_rad.to_bits();
    let shortest = (0..17).filter_map(|digits| format!("{close:.digits$e}").parse().ok()).find(same);
    shortest.or_else(|| [close.next_up(), close.next_down()].into_iter().find(same)).unwrap_or(close)
}

pub(crate) fn direction(text: &str) -> Result<Quantity, String> {
    ANGLE.read(text)
}

pub(crate) fn gravity(text: &str) -> Result<Quantity, String> {
    checked(&ACCELERATION, text, |si| part_of(si, inputs::gravity_of))
}

pub(crate) fn contact_time(text: &str) -> Result<Quantity, String> {
    checked(&TIME, text, |si| part_of(si, inputs::contact_of))
}

pub(crate) fn until(text: &str) -> Result<Quantity, String> {
    checked(&TIME, text, |si| part_of(si, inputs::until_of))
}

pub(crate) fn spin(text: &str) -> Result<Quantity, String> {
    clatter_product::units::ANGULAR_VELOCITY.read(text)
}

/// Reads the velocities of both ends; in v0, or with their units.
pub(crate) fn velocity(text: &str) -> Result<[Quantity; 2], String> {
    let [a, b] = inputs::parts(text, ',')[..] else {
        return Err("two velocities are needed, of ends a and b: VA,VB".to_owned());
    };
    let velocity = [plain_or_typed(&SPEED, a)?, plain_or_typed(&SPEED, b)?];
    Start::new(velocity.map(|v| v.si), 1.0).map(|_| velocity).map_err(|error| error.to_string())
}

/// Reads a height in h0, or with its unit.
pub(crate) fn height_gap(text: &str) -> Result<Quantity, String> {
    let gap = plain_or_typed(&LENGTH, text)?;
    Start::new([-1.0, -1.0], gap.si).map(|_| gap).map_err(|error| error.to_string())
}

/// Reads stops: the gap, the contact time and the restitution, in SI where without units.
pub(crate) fn stop(text: &str) -> Result<[f64; 3], String> {
    let [gap, time, e] = inputs::parts(text, ',')[..] else {
        return Err("three values are needed: GAP,TIME,E, such as 1mm,0.5ms,0.4".to_owned());
    };
    Ok([plain_or_typed(&LENGTH, gap)?.si, plain_or_typed(&TIME, time)?.si, inputs::restitution(e)?])
}

/// Reads a natural frequency.
pub(crate) fn frequency(text: &str) -> Result<Quantity, String> {
    checked(&FREQUENCY, text, |si| {
        let good = si > 0.0;
        if good { Ok(si) } else { Err(format!("natural frequency = {si:?} Hz is not > 0")) }
    })
}

/// A place along the body.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Place {
    /// Position s in [-1, 1].
    Relative(f64),
    /// The distance from the middle towards end b.
    Length(Quantity),
}

impl Place {
    /// Returns the position s on a body of this half-length; where that is not known, lengths are refused.
    pub(crate) fn relative(self, flag: &'static str, half_m: Option<f64>) -> Result<f64, Failure> {
        match (self, half_m) {
            (Self::Relative(s), _) => Ok(s),
            (Self::Length(length), Some(half)) => Ok(length.si / half),
            (Self::Length(_), None) => Err(Failure::Wrong(format!(
                "{flag} is a position in [-1, 1] here, in half-lengths: a length needs a drop with a --length"
            ))),
        }
    }
    pub(crate) fn unit(self) -> Option<&'static Unit> {
        if let Self::Length(length) = self { length.unit } else { None }
    }
    /// Returns the place towards the other end where the sign is −1.
    pub(crate) fn turned(self, sign: f64) -> Self {
        match self {
            Self::Relative(s) => Self::Relative(sign * s),
            Self::Length(length) => Self::Length(Quantity { si: sign * length.si, ..length }),
        }
    }
    /// Writes the place as tables show it.
    pub(crate) fn said(self) -> String {
        match self {
            Self::Relative(s) => given(s),
            Self::Length(Quantity { si, unit }) => Show { unit, name: "m" }.given(si),
        }
    }
}

/// One value for a bar, two for a plate, along its length and its width, three for a box, across it too.
#[derive(Debug, Clone, Copy)]
pub(crate) enum PerAxis<T> {
    Bar(T),
    Plate([T; 2]),
    Block([T; 3]),
}

impl<T> PerAxis<T> {
    /// Returns the values, as many as were typed.
    pub(crate) fn values(self) -> Vec<T> {
        match self {
            Self::Bar(value) => vec![value],
            Self::Plate(values) => values.into(),
            Self::Block(values) => values.into(),
        }
    }
    pub(crate) fn of_bar(self, flag: &'static str) -> Result<T, Failure> {
        if let Self::Bar(value) = self {
            Ok(value)
        } else {
            Err(self.told(flag, "one value for a bar: --width makes it a plate"))
        }
    }
    pub(crate) fn of_plate(self, flag: &'static str) -> Result<[T; 2], Failure> {
        let what = "two values for a plate, along its length and its width";
        if let Self::Plate(values) = self { Ok(values) } else { Err(self.told(flag, what)) }
    }
    pub(crate) fn of_block(self, flag: &'static str) -> Result<[T; 3], Failure> {
        let what = "three values for a box, along its length, width and thickness";
        if let Self::Block(values) = self { Ok(values) } else { Err(self.told(flag, what)) }
    }
    fn told(&self, flag: &str, what: &str) -> Failure {
        let count = match self {
            Self::Bar(_) => "one",
            Self::Plate(_) => "two",
            Self::Block(_) => "three",
        };
        Failure::Wrong(format!("'{flag}' takes {what}, not {count}"))
    }
}

/// Reads the two values of a list in the same way.
fn two<T>(text: &str, read: impl Fn(&str) -> Result<T, String>) -> Result<[T; 2], String> {
    let [x, y] = inputs::parts(text, ',')[..] else {
        return Err("two values are needed, X,Y".to_owned());
    };
    Ok([read(x)?, read(y)?])
}

fn per_axis<T>(text: &str, read: impl Fn(&str) -> Result<T, String>) -> Result<PerAxis<T>, String> {
    let parts = inputs::parts(text, ',');
    match parts[..] {
        [one] => read(one).map(PerAxis::Bar),
        [x, y] => Ok(PerAxis::Plate([read(x)?, read(y)?])),
        [x, y, z] => Ok(PerAxis::Block([read(x)?, read(y)?, read(z)?])),
        _ => Err(format!("{} values are given: one is of a bar, two are of a plate, three of a box", parts.len())),
    }
}

/// Reads plain numbers.
pub(crate) fn numbers(text: &str) -> Result<PerAxis<f64>, String> {
    per_axis(text, number)
}

/// Reads a radius of gyration, or one for each axis.
pub(crate) fn gyration(text: &str) -> Result<PerAxis<Quantity>, String> {
    per_axis(text, any_length)
}

pub(crate) fn gyration_m(text: &str) -> Result<PerAxis<Quantity>, String> {
    per_axis(text, |text| number(text).map(Quantity::of_si))
}

/// Reads the heights of two corners.
pub(crate) fn gaps(text: &str) -> Result<[Quantity; 2], String> {
    two(text, any_length)
}

pub(crate) fn gaps_m(text: &str) -> Result<[f64; 2], String> {
    two(text, number)
}

/// Reads a length, or else a position as it is read where there are no lengths.
fn place_or(text: &str, relative: impl Fn(&str) -> Result<f64, String>) -> Result<Place, String> {
    let length = LENGTH.read(text).ok().filter(|length| length.unit.is_some());
    length.map_or_else(|| relative(text).map(Place::Relative), |length| Ok(Place::Length(length)))
}

/// Reads a position in [-1, 1], or a length.
pub(crate) fn place(text: &str) -> Result<PerAxis<Place>, String> {
    per_axis(text, place_of_bar)
}

pub(crate) fn place_of_bar(text: &str) -> Result<Place, String> {
    place_or(text, inputs::worked_out_position)
}

pub(crate) fn center_of_mass(text: &str) -> Result<PerAxis<Place>, String> {
    per_axis(text, |text| place_or(text, inputs::center_of_mass))
}

/// Returns the position on a body of this half-length that goes on so far beyond the feet which are its ends; a position that misses an
/// end by rounding is that end.
pub(crate) fn position(place: Place, flag: &'static str, half_m: f64, beyond_m: f64) -> Result<f64, Failure> {
    let (s, most) = (place.relative(flag, Some(half_m))?, 1.0 + beyond_m / half_m);
    if s.abs() <= most * (1.0 + 1e-9) {
        return Ok(s.clamp(-most, most));
    }
    let (place, half) = (place.said(), Show { unit: place.unit(), name: "m" }.given(neat(half_m + beyond_m)));
    Err(Failure::Wrong(format!("{flag} {place} is beyond the ends: allowed is up to {half} from the middle")))
}

/// One `--mass`: a point, or a piece from the first place to the second.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Piece {
    mass: Quantity,
    from: Place,
    to: Option<Place>,
}

pub(crate) fn mass(text: &str) -> Result<Piece, String> {
    let form = "a mass is M@S at position S, or M@S:T from S to T";
    let (mass, place) = text.split_once('@').ok_or(form)?;
    let place_of = |text: &str| {
        let place = plain_or_typed(&LENGTH, text)?;
        Ok::<_, String>(if place.unit.is_some() { Place::Length(place) } else { Place::Relative(place.si) })
    };
    let (from, to) = match place.split_once(':') {
        None => (place_of(place)?, None),
        Some((from, to)) => (place_of(from)?, Some(place_of(to)?)),
    };
    let piece = Piece { mass: plain_or_typed(&MASS, mass)?, from, to };
    // The places themselves are known later: their unit does not matter here.
    let trial = piece.on(Some(1.0)).map_err(|failure| failure.to_string())?;
    center_and_gyration(&[trial]).map(|_| piece).map_err(|error| error.to_string())
}

impl Piece {
    /// Converts the mass to places in half-lengths.
    pub(crate) fn on(&self, half_m: Option<f64>) -> Result<Mass, Failure> {
        let [from, to] = [Some(self.from), self.to].map(|place| place.map(|place| place.relative("--mass", half_m)));
        Ok(match (from, to) {
            (Some(from), Some(to)) => Mass::Slab { mass_kg: self.mass.si, from_m: from?, to_m: to? },
            (from, _) => Mass::Point { mass_kg: self.mass.si, position_m: from.unwrap_or(Ok(0.0))? },
        })
    }
    /// Returns warnings about places far outside of the body.
    pub(crate) fn slips(&self, half_m: f64) -> impl Iterator<Item = Slip> {
        [Some(self.from), self.to].into_iter().flatten().filter_map(move |place| match place {
            Place::Length(length) => outside(&length, 2.0 * half_m),
            Place::Relative(s) => outside_relative(s),
        })
    }
}

/// Returns a warning about a position far outside of the body.
fn outside_relative(s: f64) -> Option<Slip> {
    outside(&Quantity::of_si(s), 2.0).map(|_| Slip {
        message: format!("a mass at {} is outside of the body, which reaches from -1 to 1 half-lengths", given(s)),
        hint: String::new(),
    })
}

/// Returns all pieces, in half-lengths.
pub(crate) fn masses(pieces: &[Piece], half_m: Option<f64>) -> Result<Vec<Mass>, Failure> {
    let typed = pieces.iter().filter(|piece| piece.mass.unit.is_some()).count();
    if (1..pieces.len()).contains(&typed) {
        return Err(Failure::Usage(
            "a --mass has a unit and another has none: give all of them with their units, or none",
        ));
    }
    pieces.iter().map(|piece| piece.on(half_m)).collect()
}

/// The unit in which a kind of quantity is shown: the one that was typed, else SI.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Show {
    pub(crate) unit: Option<&'static Unit>,
    /// The SI unit.
    pub(crate) name: &'static str,
}

impl Show {
    pub(crate) fn name(&self) -> &'static str {
        self.unit.map_or(self.name, |unit| unit.name)
    }
    pub(crate) fn value(&self, si: f64) -> f64 {
        self.unit.map_or(si, |unit| unit.of_si(si))
    }
    /// Writes a value with six digits, without the unit.
    pub(crate) fn figures(&self, si: f64) -> String {
        figures(self.value(si))
    }
    /// Writes an input with its unit.
    pub(crate) fn given(&self, si: f64) -> String {
        let value = if self.unit.is_some() { neat(self.value(si)) } else { si };
        format!("{} {}", given(value), self.name())
    }
    /// Writes a value with six digits and the unit.
    pub(crate) fn said(&self, si: f64) -> String {
        format!("{} {}", self.figures(si), self.name())
    }
}

/// The units in which the answer about a drop is shown.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shown {
    pub(crate) length: Show,
    pub(crate) speed: Show,
    pub(crate) time: Show,
    pub(crate) acceleration: Show,
    pub(crate) spin: Show,
    /// The unit of angles: degrees unless another was typed.
    pub(crate) angle: Option<&'static Unit>,
}

impl Shown {
    /// Writes the inputs that a drop may be without, each after a comma; the values as `rounded` has them.
    pub(crate) fn optional(&self, drop: &Drop, rounded: impl Fn(f64) -> f64) -> String {
        let told = |(row, optional): (&Row, Optional)| {
            let value = row.input.value(drop).filter(|value| !optional.is_left_out(*value))?;
            let (show, about) = match row.input {
                Input::Spin => (self.spin, drop.spin_axis),
                _ => (Show { unit: None, name: row.unit }, None),
            };
            let about = about.map(|axis| format!(" about {}", axis.map(figures).join(", ")));
            Some(format!(", {} {}{}", optional.phrase, show.given(rounded(value)), about.unwrap_or_default()))
        };
        optional_inputs().filter_map(told).collect()
    }
    /// Writes a tilt that is given in degrees.
    pub(crate) fn tilt(&self, degrees: f64) -> String {
        match self.angle.filter(|unit| unit.name == "rad") {
            Some(unit) => Show { unit: Some(unit), name: "rad" }.given(degrees.to_radians()),
            None => format!("{} degrees", given(degrees)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Degrees in all of their digits, and in few.
    #[test]
    fn degrees_are_those_that_were_typed() {
        let mut state = 1_u64;
        for n in 0..20_000 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            #[expect(clippy::cast_precision_loss, reason = "any number")]
            let any = 90.0 * (state >> 11) as f64 / 2_f64.powi(53);
            let typed: f64 = if n % 2 == 0 { any } else { format!("{any:.4}").parse().unwrap() };
            let read = tilt(&format!("{typed:?}deg")).unwrap().si;
            assert_eq!(degrees(read).to_radians().to_bits(), typed.to_radians().to_bits(), "{typed:?}");
            assert!(n % 2 == 0 || degrees(read).to_bits() == typed.to_bits(), "{typed:?}, {:?}", degrees(read));
        }
    }
}
