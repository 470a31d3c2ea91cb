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
const TIMES: [(&str, f64); 56] = [
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
    ("d", 86_400.0),
    ("day", 86_400.0),
    ("days", 86_400.0),
    ("秒", 1.0),
    ("ミリ秒", 1e-3),
    ("毫秒", 1e-3),
    ("マイクロ秒", 1e-6),
    ("微秒", 1e-6),
    ("초", 1.0),
    ("с", 1.0),
    ("сек", 1.0),
    ("сек.", 1.0),
    ("мс", 1e-3),
    ("мсек", 1e-3),
    ("мкс", 1e-6),
    ("мксек", 1e-6),
    ("segundos", 1.0),
];
/// Standard gravity, by all its usual names; `kg` is a mass.
const GRAVITIES: [(&str, f64); 20] = [
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
    ("kgn", 1e3),
];
/// cm/s², by the names that seismology has for it.
const GALS: [(&str, f64); 4] = [("gal", 1e-2), ("gals", 1e-2), ("mgal", 1e-5), ("milligal", 1e-5)];
/// Meters.
const LENGTHS: [(&str, f64); 24] = [
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
    ("м", 1.0),
    ("мм", 1e-3),
    ("см", 1e-2),
    ("米", 1.0),
];
const PER_SECOND: [&str; 6] = ["/s", "/sec", "/second", "ps", "s-1", "sec-1"];
const PER_SECOND_SQUARED: [&str; 22] = [
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
    "/(ss)",
    "/(s.s)",
    "/с2",
    "/с/с",
    "/сек2",
    "/秒2",
];
/// Hertz.
const FREQUENCIES: [(&str, f64); 3] = [("hz", 1.0), ("khz", 1e3), ("cps", 1.0)];
/// What a unit of voltage is of.
pub(crate) const VOLTAGE: Kind = Kind::Other("a voltage");
const VOLTAGES: [(&str, f64); 7] =
    [("v", 1.0), ("mv", 1e-3), ("uv", 1e-6), ("volt", 1.0), ("volts", 1.0), ("millivolt", 1e-3), ("millivolts", 1e-3)];
/// Units of what is no time and no acceleration.
const OTHERS: [(&str, &str); 29] = [
    ("kg", "a mass"),
    ("gram", "a mass"),
    ("grams", "a mass"),
    ("lb", "a mass"),
    ("lbs", "a mass"),
    ("n", "a force"),
    ("kn", "a force"),
    ("lbf", "a force"),
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
        if text.len() > LONGEST {
            return None;
        }
        if let Some((power, unit)) = power_of_ten(text) {
            return Some(Self::of(unit)?.times(power));
        }
        let spelled = spelled(text);
        // `v_m_s` is a velocity.
        if let Some((before, after)) = spelled.split_once('/')
            && !text.contains('_')
            && voltage(before)
            && Self::of(after).is_some()
        {
            return Some(Self { kind: Kind::Other("the sensitivity of a sensor"), size: 1.0 });
        }
        let (number, rest) = factor(&spelled);
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
            .or_else(|| of(Kind::Acceleration, &GALS, 1.0))
            .or_else(|| over(&PER_SECOND_SQUARED).map(|size| Self { kind: Kind::Acceleration, size }))
            .or_else(|| over(&PER_SECOND).map(|size| Self { size, ..other("a velocity") }))
            .or_else(|| of(Kind::Other("a length"), &LENGTHS, 1.0))
            .or_else(|| of(Kind::Other("a frequency"), &FREQUENCIES, 1.0))
            .or_else(|| of(VOLTAGE, &VOLTAGES, 1.0))
            .or_else(|| OTHERS.iter().find(|(name, _)| *name == text).map(|(_, what)| other(what)))
    }

    pub(crate) fn times(self, factor: f64) -> Self {
        Self { size: self.size * factor, ..self }
    }
}

/// No unit is longer.
const LONGEST: usize = 80;

/// In small letters, with digits for raised ones, `/` for underscores between units, and without signs of products.
fn spelled(text: &str) -> String {
    // Some loggers mark a unit with a star.
    let text = text.trim().trim_end_matches('*').to_lowercase();
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

/// A power of ten that a text begins with, as in `10^-3 g`, `x10³ m/s²` and `×10**3 g`, and the rest.
pub(crate) fn power_of_ten(text: &str) -> Option<(f64, &str)> {
    let text = text.trim().trim_start_matches(['x', 'X', '×', '*', '·']).trim_start().strip_prefix("10")?;
    let raised =
        |c: char| "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().position(|digit| digit == c).and_then(|digit| u32::try_from(digit).ok());
    let (marked, text) = match text.strip_prefix('^').or_else(|| text.strip_prefix("**")) {
        Some(text) => (true, text.trim_start_matches(['(', '{'])),
        None => (false, text),
    };
    let (negative, text) = match text.strip_prefix(['-', '−', '⁻']) {
        Some(text) => (true, text),
        None => (false, text.trim_start_matches('+')),
    };
    let digit = |c: char| if marked { c.to_digit(10).or_else(|| raised(c)) } else { raised(c) };
    let end = text.find(|c: char| digit(c).is_none()).unwrap_or(text.len());
    let power = text[..end]
        .chars()
        .filter_map(digit)
        .fold(None, |power: Option<u32>, digit| Some(power.unwrap_or(0).saturating_mul(10).saturating_add(digit)))?;
    let rest = text[end..].trim_start_matches([')', '}']).trim_start_matches([' ', '*', '·', '×', 'x']);
    let power = i32::try_from(power).ok().filter(|power| *power <= 30)?;
    Some((10_f64.powi(if negative { -power } else { power }), rest))
}

/// Whether a text, with or without a number, is a unit of voltage, current or charge.
fn voltage(text: &str) -> bool {
    ["v", "mv", "uv", "ma", "pc"].contains(&factor(text).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every name of the tables above, by a list of its own: its size in SI.
    #[test]
    fn sizes_of_all_names() {
        let g = 9.806_65;
        let lists: [(Kind, f64, &str); 22] = [
            (Kind::Time, 1.0, "s sec sec. sek. secs second seconds sekunde sekunden 秒 초 с сек сек. segundos"),
            (Kind::Time, 1e-3, "ms msec msecs millisec millisecs millisecond milliseconds millis ミリ秒 毫秒 мс мсек"),
            (
                Kind::Time,
                1e-6,
                "us usec usecs microsec microsecs microsecond microseconds micros マイクロ秒 微秒 мкс мксек",
            ),
            (Kind::Time, 1e-9, "ns nsec nsecs nanosecond nanoseconds nanos"),
            (Kind::Time, 60.0, "min mins minute minutes"),
            (Kind::Time, 3600.0, "h hr hour hours"),
            (Kind::Time, 86_400.0, "d day days"),
            (Kind::Acceleration, g, "g gs g's g’s g-force gn g_n g0 g_0 gee gees grav"),
            (Kind::Acceleration, 1e-3 * g, "mg mgs mgn milligs milli-g millig"),
            (Kind::Acceleration, 1e-6 * g, "ug"),
            (Kind::Acceleration, 1e3 * g, "kgn"),
            (Kind::Acceleration, 1e-2, "gal gals"),
            (Kind::Acceleration, 1e-5, "mgal milligal"),
            (Kind::Other("a length"), 1.0, "m meter meters metre metres м 米"),
            (Kind::Other("a length"), 1e-3, "mm millimeter millimeters millimetres мм"),
            (Kind::Other("a length"), 1e-2, "cm см"),
            (Kind::Other("a length"), 0.0254, "in inch inches \""),
            (Kind::Other("a length"), 0.3048, "ft foot feet '"),
            (VOLTAGE, 1.0, "v volt volts"),
            (VOLTAGE, 1e-3, "mv millivolt millivolts"),
            (Kind::Other("a frequency"), 1.0, "hz cps"),
            (Kind::Other("a frequency"), 1e3, "khz"),
        ];
        let more = [("um", 1e-6, "a length"), ("km", 1e3, "a length"), ("uv", 1e-6, "a voltage")];
        let mut checked = 0;
        let mut check = |name: &str, kind: Kind, size: f64| {
            let unit = Unit::of(name).unwrap_or_else(|| panic!("{name} is no unit"));
            // A product of two roundings.
            assert!(unit.kind == kind && (unit.size / size - 1.0).abs() < 3e-16, "{name}: {unit:?}, not {size}");
            checked += 1;
        };
        for (kind, size, names) in lists {
            names.split_whitespace().for_each(|name| check(name, kind, size));
        }
        for (name, size, what) in more {
            check(name, Kind::Other(what), size);
        }
        let all = [TIMES.len(), GRAVITIES.len(), GALS.len(), LENGTHS.len(), VOLTAGES.len(), FREQUENCIES.len()];
        assert_eq!(checked, all.iter().sum::<usize>(), "every name is here once");
    }

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
            ("x10^3 m/s2", Kind::Acceleration, 1000.0),
            ("×10³ m/s²", Kind::Acceleration, 1000.0),
            ("10⁻³ g", Kind::Acceleration, 1e-3 * g),
            ("10**-3 g", Kind::Acceleration, 1e-3 * g),
            ("m/(s*s)", Kind::Acceleration, 1.0),
            ("m/(s·s)", Kind::Acceleration, 1.0),
            ("m/(s^2)*", Kind::Acceleration, 1.0),
            ("м/с²", Kind::Acceleration, 1.0),
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
            "103 g",
            "x103 m/s2 y",
            "10^ g",
        ] {
            assert_eq!(Unit::of(none), None, "{none}");
        }
    }
}
