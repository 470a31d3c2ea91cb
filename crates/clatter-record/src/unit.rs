//! Units as headers spell them.

use clatter_shock::STANDARD_GRAVITY_M_S2;

/// What a unit is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Time,
    Acceleration,
    /// Something that a record of shocks has no use for.
    Other(&'static str),
}

/// A unit: what it is of, and its size in SI; 1 for those of no use, but for lengths, velocities and frequencies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Unit {
    pub(crate) kind: Kind,
    pub(crate) size: f64,
}

/// Seconds, by all their usual names.
const TIMES: [(&str, f64); 39] = [
    ("s", 1.0),
    ("sec", 1.0),
    ("sec.", 1.0),
    ("sek.", 1.0),
    ("secs", 1.0),
    ("second", 1.0),
    ("seconds", 1.0),
    ("sekunde", 1.0),
    ("sekunden", 1.0),
    ("ms", 1e-3),
    ("msec", 1e-3),
    ("msecs", 1e-3),
    ("millisec", 1e-3),
    ("millisecs", 1e-3),
    ("millisecond", 1e-3),
    ("milliseconds", 1e-3),
    ("millis", 1e-3),
    ("us", 1e-6),
    ("usec", 1e-6),
    ("usecs", 1e-6),
    ("microsec", 1e-6),
    ("microsecs", 1e-6),
    ("microsecond", 1e-6),
    ("microseconds", 1e-6),
    ("micros", 1e-6),
    ("ns", 1e-9),
    ("nsec", 1e-9),
    ("nsecs", 1e-9),
    ("nanosecond", 1e-9),
    ("nanoseconds", 1e-9),
    ("nanos", 1e-9),
    ("min", 60.0),
    ("mins", 60.0),
    ("minute", 60.0),
    ("minutes", 60.0),
    ("h", 3600.0),
    ("hr", 3600.0),
    ("hour", 3600.0),
    ("hours", 3600.0),
];
/// Standard gravity, by all its usual names; `kg` is a mass.
const GRAVITIES: [(&str, f64); 19] = [
    ("g", 1.0),
    ("gs", 1.0),
    ("g's", 1.0),
    ("g’s", 1.0),
    ("g-force", 1.0),
    ("milli-g", 1e-3),
    ("millig", 1e-3),
    ("gn", 1.0),
    ("g_n", 1.0),
    ("g0", 1.0),
    ("g_0", 1.0),
    ("gee", 1.0),
    ("gees", 1.0),
    ("grav", 1.0),
    ("mg", 1e-3),
    ("mgs", 1e-3),
    ("mgn", 1e-3),
    ("milligs", 1e-3),
    ("ug", 1e-6),
];
/// Meters.
const LENGTHS: [(&str, f64); 20] = [
    ("m", 1.0),
    ("meter", 1.0),
    ("meters", 1.0),
    ("metre", 1.0),
    ("metres", 1.0),
    ("mm", 1e-3),
    ("millimeter", 1e-3),
    ("millimeters", 1e-3),
    ("millimetres", 1e-3),
    ("cm", 1e-2),
    ("um", 1e-6),
    ("km", 1e3),
    ("in", 0.0254),
    ("inch", 0.0254),
    ("inches", 0.0254),
    ("\"", 0.0254),
    ("ft", 0.3048),
    ("foot", 0.3048),
    ("feet", 0.3048),
    ("'", 0.3048),
];
const PER_SECOND: [&str; 6] = ["/s", "/sec", "/second", "ps", "s-1", "sec-1"];
const PER_SECOND_SQUARED: [&str; 16] = [
    "/s2",
    "/s/s",
    "/sec2",
    "/sec/sec",
    "/second2",
    "/second/second",
    "/secondsquared",
    "/(s2)",
    "/(s/s)",
    "s-2",
    ".s-2",
    "/s/2",
    "sec-2",
    "ps2",
    "/ssquared",
    "/secsquared",
];
/// Hertz.
const FREQUENCIES: [(&str, f64); 3] = [("hz", 1.0), ("khz", 1e3), ("cps", 1.0)];
/// Units of what is no time and no acceleration.
const OTHERS: [(&str, &str); 34] = [
    ("kg", "a mass"),
    ("gram", "a mass"),
    ("grams", "a mass"),
    ("lb", "a mass"),
    ("lbs", "a mass"),
    ("n", "a force"),
    ("kn", "a force"),
    ("lbf", "a force"),
    ("v", "a voltage"),
    ("mv", "a voltage"),
    ("uv", "a voltage"),
    ("volt", "a voltage"),
    ("volts", "a voltage"),
    ("a", "a current"),
    ("ma", "a current"),
    ("rad", "an angle"),
    ("deg", "an angle"),
    ("°", "an angle"),
    ("rad/s", "an angular velocity"),
    ("deg/s", "an angular velocity"),
    ("°/s", "an angular velocity"),
    ("dps", "an angular velocity"),
    ("rpm", "an angular velocity"),
    ("c", "a temperature"),
    ("°c", "a temperature"),
    ("degc", "a temperature"),
    ("k", "a temperature"),
    ("pa", "a pressure"),
    ("kpa", "a pressure"),
    ("ut", "a magnetic field"),
    ("lsb", "counts of a converter"),
    ("counts", "counts of a converter"),
    ("count", "counts of a converter"),
    ("%", "a share"),
];
/// Factors by name, which stand before a unit as words of their own.
const PREFIXES: [(&str, f64); 8] = [
    ("milli", 1e-3),
    ("micro", 1e-6),
    ("nano", 1e-9),
    ("kilo", 1e3),
    ("k", 1e3),
    ("m", 1e-3),
    ("u", 1e-6),
    ("n", 1e-9),
];

impl Unit {
    /// Of a whole text, factors and all; none if it is no unit that is known.
    pub(crate) fn of(text: &str) -> Option<Self> {
        let spelled = spelled(text);
        if spelled.len() > LONGEST {
            return None;
        }
        if let Some((before, after)) = spelled.split_once('/')
            && voltage(before)
            && Self::of(after).is_some()
        {
            return Some(Self { kind: Kind::Other("the sensitivity of a sensor"), size: 1.0 });
        }
        let (number, rest) = factor(&spelled);
        if text.contains("10^") {
            return None;
        }
        if let Some(unit) = Self::plain(rest) {
            // `x1000 g` is a factor; of a sensor of 100 g the `100 g` is its range.
            let mark = ['x', 'X', '×', '*', '·'];
            let after = text.trim_start().trim_start_matches(|c: char| c.is_ascii_digit() || c == '.' || c == ' ');
            let is_factor = text.trim_start().starts_with(mark) || after.starts_with(mark);
            let is_range = unit.kind == Kind::Acceleration && number > 1.0 && !is_factor;
            return (!is_range).then(|| unit.times(number));
        }
        let (prefix, rest) = rest.split_once(' ')?;
        let size = PREFIXES.iter().find(|(name, _)| *name == prefix)?.1;
        Some(Self::plain(rest.trim())?.times(number * size))
    }

    /// Of a unit by one of its names, in small letters.
    fn plain(text: &str) -> Option<Self> {
        let of = |kind, list: &[(&str, f64)], unit: f64| {
            let (_, size) = list.iter().find(|(name, _)| *name == text)?;
            Some(Self { kind, size: size * unit })
        };
        let other = |name| Self { kind: Kind::Other(name), size: 1.0 };
        let close: String = text.replace("per", "/").split_whitespace().collect();
        let over = |per: &[&str]| {
            let length = |end: &&str| LENGTHS.iter().find(|(name, _)| close.strip_suffix(*end) == Some(*name));
            per.iter().find_map(length).map(|(_, size)| *size)
        };
        of(Kind::Time, &TIMES, 1.0)
            .or_else(|| of(Kind::Acceleration, &GRAVITIES, STANDARD_GRAVITY_M_S2))
            .or_else(|| over(&PER_SECOND_SQUARED).map(|size| Self { kind: Kind::Acceleration, size }))
            .or_else(|| over(&PER_SECOND).map(|size| Self { size, ..other("a velocity") }))
            .or_else(|| of(Kind::Other("a length"), &LENGTHS, 1.0))
            .or_else(|| of(Kind::Other("a frequency"), &FREQUENCIES, 1.0))
            .or_else(|| OTHERS.iter().find(|(name, _)| *name == text).map(|(_, what)| other(what)))
    }

    fn times(self, factor: f64) -> Self {
        Self { size: self.size * factor, ..self }
    }
}

/// No unit is longer.
const LONGEST: usize = 40;

/// In small letters, with digits for raised ones, `/` for underscores between units, and without signs of products.
fn spelled(text: &str) -> String {
    let text = text.trim().to_lowercase();
    // Names of their own, and our own columns: m_s2.
    let text = if GRAVITIES.iter().any(|(name, _)| *name == text) { text } else { text.replace('_', "/") };
    let mut spelled = String::with_capacity(text.len());
    for c in text.replace("**", "^").chars() {
        match c {
            '²' => spelled.push('2'),
            '¹' => spelled.push('1'),
            '³' => spelled.push('3'),
            '⁻' | '−' | '–' => spelled.push('-'),
            '^' => {}
            '·' | '*' | '⋅' | '×' => spelled.push(' '),
            'µ' | 'μ' => spelled.push('u'),
            c => spelled.push(c),
        }
    }
    let words: Vec<_> = spelled.split_whitespace().collect();
    words.join(" ").replace(" /", "/").replace("/ ", "/")
}

/// A number that a unit begins with, as in `x1000 m/s2` and `10 us`, and the rest. `×` and `*` are blanks by now.
fn factor(text: &str) -> (f64, &str) {
    let number = text.strip_prefix('x').unwrap_or(text).trim_start();
    let digits = number.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(number.len());
    let end = match number[digits..].strip_prefix('e') {
        Some(power) => {
            let signed = power.trim_start_matches(['-', '+']);
            let length = signed.find(|c: char| !c.is_ascii_digit()).unwrap_or(signed.len());
            if length > 0 { number.len() - signed.len() + length } else { digits }
        }
        None => digits,
    };
    let (factor, rest) = number.split_at(end);
    match factor.parse::<f64>() {
        Ok(factor) if factor > 0.0 && factor.is_finite() => (factor, rest.trim_start_matches([' ', 'x'])),
        _ => (1.0, text),
    }
}

/// Whether a text, with or without a number, is a unit of voltage, current or charge.
fn voltage(text: &str) -> bool {
    ["v", "mv", "uv", "ma", "pc"].contains(&factor(text).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_by_every_usual_name() {
        let g = STANDARD_GRAVITY_M_S2;
        for (text, kind, size) in [
            ("s", Kind::Time, 1.0),
            ("sec", Kind::Time, 1.0),
            ("Seconds", Kind::Time, 1.0),
            ("msec", Kind::Time, 1e-3),
            ("µs", Kind::Time, 1e-6),
            ("μs", Kind::Time, 1e-6),
            ("ns", Kind::Time, 1e-9),
            ("min", Kind::Time, 60.0),
            ("10 us", Kind::Time, 1e-5),
            ("1e-4 s", Kind::Time, 1e-4),
            ("milli s", Kind::Time, 1e-3),
            ("g", Kind::Acceleration, g),
            ("G", Kind::Acceleration, g),
            ("Gs", Kind::Acceleration, g),
            ("g's", Kind::Acceleration, g),
            ("gn", Kind::Acceleration, g),
            ("g_n", Kind::Acceleration, g),
            ("mg", Kind::Acceleration, 1e-3 * g),
            ("milli g", Kind::Acceleration, 1e-3 * g),
            ("k g", Kind::Acceleration, 1e3 * g),
            ("m/s2", Kind::Acceleration, 1.0),
            ("m/s^2", Kind::Acceleration, 1.0),
            ("m/s**2", Kind::Acceleration, 1.0),
            ("m/s²", Kind::Acceleration, 1.0),
            ("m/s/s", Kind::Acceleration, 1.0),
            ("m / s^2", Kind::Acceleration, 1.0),
            ("m/(s^2)", Kind::Acceleration, 1.0),
            ("m·s⁻²", Kind::Acceleration, 1.0),
            ("m s^-2", Kind::Acceleration, 1.0),
            ("m s-2", Kind::Acceleration, 1.0),
            ("m*s^-2", Kind::Acceleration, 1.0),
            ("mps2", Kind::Acceleration, 1.0),
            ("m_s2", Kind::Acceleration, 1.0),
            ("m/sec2", Kind::Acceleration, 1.0),
            ("meters per second squared", Kind::Acceleration, 1.0),
            ("mm/s^2", Kind::Acceleration, 1e-3),
            ("cm/s2", Kind::Acceleration, 1e-2),
            ("in/s2", Kind::Acceleration, 0.0254),
            ("ft/s²", Kind::Acceleration, 0.3048),
            ("x1000 m/s^2", Kind::Acceleration, 1000.0),
            ("0.001 g", Kind::Acceleration, 1e-3 * g),
            ("× 1000 m/s2", Kind::Acceleration, 1000.0),
            ("1000 × m/s2", Kind::Acceleration, 1000.0),
        ] {
            let unit = Unit::of(text).unwrap_or_else(|| panic!("{text} is no unit"));
            // A product of two roundings.
            assert!(unit.kind == kind && (unit.size / size - 1.0).abs() < 3e-16, "{text}: {unit:?}");
        }
        for (text, what) in [
            ("m/s", "a velocity"),
            ("in/s", "a velocity"),
            ("mm", "a length"),
            ("kg", "a mass"),
            ("100 mV/g", "the sensitivity of a sensor"),
            ("mV/g", "the sensitivity of a sensor"),
            ("V", "a voltage"),
            ("°/s", "an angular velocity"),
            ("counts", "counts of a converter"),
        ] {
            match Unit::of(text) {
                Some(Unit { kind: Kind::Other(name), .. }) => assert_eq!(name, what, "{text}"),
                unit => panic!("{text}: {unit:?}"),
            }
        }
        for none in [
            "",
            "x",
            "milli",
            "deka g",
            "foo g",
            "m/s3",
            "m/s2/Hz",
            "g2",
            "1000",
            "g/Hz",
            "g rms",
            "-3 g",
            "x m/s2 y",
            "100g",
            "16 g",
            "16 m·s⁻²",
            "1000 m/s2",
            "x10^3 m/s2",
        ] {
            assert_eq!(Unit::of(none), None, "{none}");
        }
    }
}
