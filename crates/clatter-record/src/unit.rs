//! Units as headers spell them.

use clatter_shock::STANDARD_GRAVITY_M_S2;

/// The quantity that a unit is of.
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

/// Units by all their usual names, in small letters: what each is of, its size in SI, its names.
const UNITS: [(Kind, f64, &str); 35] = [
    (Kind::Time, 1.0, "s sec sec. sek. secs second seconds sekunde sekunden 秒 초 с сек сек. segundos"),
    (Kind::Time, 1e-3, "ms msec msecs millisec millisecs millisecond milliseconds millis ミリ秒 毫秒 мс мсек"),
    (Kind::Time, 1e-6, "us usec usecs microsec microsecs microsecond microseconds micros マイクロ秒 微秒 мкс мксек"),
    (Kind::Time, 1e-9, "ns nsec nsecs nanosec nanosecs nanosecond nanoseconds nanos"),
    (Kind::Time, 60.0, "min mins minute minutes"),
    (Kind::Time, 3600.0, "h hr hour hours"),
    (Kind::Time, 86_400.0, "d day days"),
    // `kg` is a mass.
    (Kind::Acceleration, GRAVITY, "g gs g's g’s g-force gn g_n g0 g_0 gee gees grav"),
    (Kind::Acceleration, 1e-3 * GRAVITY, "milli-g millig mg mgs mgn milligs"),
    (Kind::Acceleration, 1e-6 * GRAVITY, "ug"),
    (Kind::Acceleration, 1e3 * GRAVITY, "kgn"),
    // Seismology has a name for cm/s².
    (Kind::Acceleration, 1e-2, "gal gals"),
    (Kind::Acceleration, 1e-5, "mgal milligal"),
    (LENGTH, 1.0, "m meter meters metre metres м 米"),
    (LENGTH, 1e-3, "mm millimeter millimeters millimetres мм"),
    (LENGTH, 1e-2, "cm см"),
    (LENGTH, 1e-6, "um"),
    (LENGTH, 1e3, "km"),
    (LENGTH, 0.0254, "in inch inches \""),
    (LENGTH, 0.3048, "ft foot feet '"),
    (FREQUENCY, 1.0, "hz cps"),
    (FREQUENCY, 1e3, "khz"),
    (VOLTAGE, 1.0, "v volt volts"),
    (VOLTAGE, 1e-3, "mv millivolt millivolts"),
    (VOLTAGE, 1e-6, "uv"),
    // The sizes of those below are of no use.
    (Kind::Other("a mass"), 1.0, "kg gram grams lb lbs"),
    (Kind::Other("a force"), 1.0, "n kn lbf"),
    (Kind::Other("a current"), 1.0, "a ma"),
    (Kind::Other("an angle"), 1.0, "rad deg °"),
    (Kind::Other("an angular velocity"), 1.0, "rad/s deg/s °/s dps rpm"),
    (Kind::Other("a temperature"), 1.0, "c °c degc k"),
    (Kind::Other("a pressure"), 1.0, "pa kpa"),
    (Kind::Other("a magnetic field"), 1.0, "ut gauss mgauss"),
    (Kind::Other("counts of a converter"), 1.0, "lsb counts count"),
    (Kind::Other("a share"), 1.0, "%"),
];
const GRAVITY: f64 = STANDARD_GRAVITY_M_S2;
pub(crate) const LENGTH: Kind = Kind::Other("a length");
pub(crate) const FREQUENCY: Kind = Kind::Other("a frequency");
pub(crate) const VELOCITY: Kind = Kind::Other("a velocity");
pub(crate) const VOLTAGE: Kind = Kind::Other("a voltage");
/// Ends that make a velocity of a length, and those that make an acceleration.
const PER_SECOND: &str = "/s /sec /second ps s-1 sec-1";
const PER_SECOND_SQUARED: &str = "\
    /s2 /s/s /sec2 /sec/sec /second2 /second/second /secondsquared /(s2) /(s/s) s-2 .s-2 /s/2 sec-2 ps2 /ssquared \
    /secsquared /(ss) /(s.s) /с2 /с/с /сек2 /秒2";
/// Factors by name, which stand before a unit as words of their own.
const PREFIXES: [(&str, f64); 4] = [("milli m", 1e-3), ("micro u", 1e-6), ("nano n", 1e-9), ("kilo k", 1e3)];

/// Returns whether a list of words has this one.
pub(crate) fn lists(list: &str, word: &str) -> bool {
    // Bytes are split in less time than letters, and units may stand in every cell.
    list.as_bytes().split(|byte| *byte == b' ').any(|other| other == word.as_bytes())
}

impl Kind {
    /// Returns whether a record has columns of the quantity.
    pub(crate) fn is_recorded(self) -> bool {
        matches!(self, Self::Time | Self::Acceleration)
    }
}

impl Unit {
    /// Of a text that is a unit of this quantity.
    pub(crate) fn of_kind(text: &str, kind: Kind) -> Option<Self> {
        Self::of(text).filter(|unit| unit.kind == kind)
    }

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
        let (_, size) = PREFIXES.iter().find(|(names, _)| lists(names, prefix))?;
        Some(Self::plain(rest.trim())?.times(number * size))
    }

    /// Of a unit by one of its names, in small letters.
    fn plain(text: &str) -> Option<Self> {
        Self::named(text).or_else(|| {
            let close: String = text.replace("per", "/").split_whitespace().collect();
            let over = |ends: &str, kind: Kind| {
                let length = |end: &str| Self::named(close.strip_suffix(end)?).filter(|unit| unit.kind == LENGTH);
                ends.split(' ').find_map(length).map(|Self { size, .. }| Self { kind, size })
            };
            over(PER_SECOND_SQUARED, Kind::Acceleration).or_else(|| over(PER_SECOND, VELOCITY))
        })
    }

    fn named(name: &str) -> Option<Self> {
        let (kind, size, _) = UNITS.iter().find(|(_, _, names)| lists(names, name))?;
        Some(Self { kind: *kind, size: *size })
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
    // Some names have an underscore; in others, as m_s2 of our own columns, it stands for a slash.
    let text = if text.contains('_') && Unit::named(&text).is_none() { text.replace('_', "/") } else { text };
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

/// Returns whether a text, with or without a number, is a unit of voltage, current or charge.
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
            (Kind::Time, 1e-9, "ns nsec nsecs nanosec nanosecs nanosecond nanoseconds nanos"),
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
        let is_checked = |kind: &Kind| {
            matches!(kind, Kind::Time | Kind::Acceleration) || [LENGTH, VOLTAGE, FREQUENCY].contains(kind)
        };
        let all = UNITS.iter().filter(|(kind, ..)| is_checked(kind)).map(|(.., names)| names.split(' ').count());
        assert_eq!(checked, all.sum::<usize>(), "every name is here once");
    }

    #[test]
    fn units_by_every_usual_name() {
        let g = STANDARD_GRAVITY_M_S2;
        for (kind, size, texts) in [
            (Kind::Time, 1.0, "s | sec | Seconds"),
            (Kind::Time, 1e-3, "msec | milli s"),
            (Kind::Time, 1e-6, "µs | μs"),
            (Kind::Time, 1e-9, "ns"),
            (Kind::Time, 60.0, "min"),
            (Kind::Time, 1e-5, "10 us"),
            (Kind::Time, 1e-4, "1e-4 s"),
            (Kind::Acceleration, g, "g | G | Gs | g's | gn | g_n"),
            (Kind::Acceleration, 1e-3 * g, "mg | milli g | 0.001 g | 10⁻³ g | 10**-3 g"),
            (Kind::Acceleration, 1e3 * g, "k g"),
            (
                Kind::Acceleration,
                1.0,
                "m/s2 | m/s^2 | m/s**2 | m/s² | m/s/s | m / s^2 | m/(s^2) | m·s⁻² | m s^-2 | m s-2 | m*s^-2 | mps2 | m_s2 | \
                 m/sec2 | meters per second squared | m/(s*s) | m/(s·s) | m/(s^2)* | м/с²",
            ),
            (Kind::Acceleration, 1e-3, "mm/s^2"),
            (Kind::Acceleration, 1e-2, "cm/s2"),
            (Kind::Acceleration, 0.0254, "in/s2"),
            (Kind::Acceleration, 0.3048, "ft/s²"),
            (Kind::Acceleration, 1000.0, "x1000 m/s^2 | × 1000 m/s2 | 1000 × m/s2 | x10^3 m/s2 | ×10³ m/s²"),
        ] {
            for text in texts.split(" | ") {
                let unit = Unit::of(text).unwrap_or_else(|| panic!("{text} is no unit"));
                // A product of two roundings.
                assert!(unit.kind == kind && (unit.size / size - 1.0).abs() < 3e-16, "{text}: {unit:?}");
            }
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
        let none = " | x | milli | deka g | foo g | m/s3 | m/s2/Hz | g2 | 1000 | g/Hz | g rms | -3 g | x m/s2 y | 100g | 16 g | \
                    16 m·s⁻² | 1000 m/s2 | 103 g | x103 m/s2 y | 10^ g";
        for none in none.split(" | ") {
            assert_eq!(Unit::of(none), None, "{none}");
        }
    }
}
