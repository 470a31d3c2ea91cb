//! What a column is by its heading.

use crate::unit::{Kind, Unit};

/// A heading: the name of a column and its unit.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Heading {
    pub(crate) name: String,
    /// The unit, if the heading has one that is known.
    pub(crate) unit: Option<Unit>,
    /// The unit as it is spelled, known or not.
    pub(crate) spelled: Option<String>,
    /// Whether words stand in the column, and no numbers.
    pub(crate) is_text: bool,
}

/// What the name of a column says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Named {
    Time,
    Acceleration,
    /// A running number.
    Index,
    /// Something that a record of shocks has no use for.
    Other,
    Unknown,
}

const TIMES: [&str; 14] = [
    "t",
    "uhrzeit",
    "time",
    "times",
    "zeit",
    "timestamp",
    "temps",
    "tiempo",
    "tid",
    "tijd",
    "tempo",
    "datetime",
    "clock",
    "elapsed",
];
const INDICES: [&str; 21] = [
    "index",
    "idx",
    "sample",
    "samples",
    "n",
    "no",
    "nr",
    "num",
    "number",
    "row",
    "#",
    "id",
    "count",
    "unnamed",
    "frame",
    "point",
    "counter",
    "packet",
    "packetcounter",
    "seq",
    "sequence",
];
const ACCELERATIONS: [&str; 7] = ["ax", "ay", "az", "ar", "beschleunigung", "shock", "gforce"];
/// Beside an acceleration they say where it was measured.
const PLACES: [&str; 4] = ["height", "position", "distance", "displacement"];
const OTHERS: [&str; 33] = [
    "accuracy",
    "accelerator",
    "pedal",
    "status",
    "range",
    "threshold",
    "load",
    "field",
    "mag",
    "magx",
    "magy",
    "magz",
    "magnetometer",
    "sensitivity",
    "mass",
    "masse",
    "weight",
    "velocity",
    "speed",
    "force",
    "temperature",
    "temp",
    "voltage",
    "pressure",
    "gyro",
    "gyroscope",
    "angular",
    "rotation",
    "strain",
    "magnetic",
    "humidity",
    "comment",
    "trigger",
];

/// No heading with a unit has more bytes.
const LONGEST: usize = 1000;

impl Heading {
    /// Of the text of a cell: `time [ms]`, `Acceleration (g)`, `time, s`, `t / ms`, `acceleration_m_s2`, `Seconds`.
    pub(crate) fn of(cell: &str) -> Self {
        let cell = cell.trim().trim_matches(['"', '\'']).trim();
        if cell.len() > LONGEST {
            let begin: String = cell.chars().take(40).collect();
            return Self::named_alone(&format!("{begin}…"));
        }
        bracketed(cell).unwrap_or_else(|| {
            // `h` and `min` are names of other things as well.
            let is_seconds = |unit: &Unit| unit.kind == Kind::Time && unit.size <= 1.0;
            let whole = Unit::of(cell).filter(|unit| is_seconds(unit) || cell.chars().count() > 3 || cell == "g");
            if let Some(unit) = whole {
                return Self { unit: Some(unit), spelled: Some(cell.to_owned()), ..Self::named_alone(cell) };
            }
            trailing(cell).unwrap_or_else(|| Self::named_alone(cell))
        })
    }

    /// A name without a unit.
    pub(crate) fn named_alone(name: &str) -> Self {
        Self { name: name.to_owned(), unit: None, spelled: None, is_text: false }
    }

    /// The same with a unit that stands elsewhere.
    pub(crate) fn with_unit(mut self, unit: &str) -> Self {
        let unit = unbracketed(unit.trim().trim_matches('"'));
        if !unit.is_empty() {
            (self.unit, self.spelled) = (Unit::of(unit), Some(unit.to_owned()));
        }
        self
    }

    /// What the name says.
    pub(crate) fn named(&self) -> Named {
        let name = self.name.to_lowercase();
        let words: Vec<&str> =
            name.split(|c: char| !c.is_alphanumeric() && c != '#').filter(|w| !w.is_empty()).collect();
        let any = |list: &[&str]| words.iter().any(|word| list.contains(word));
        let within = |part: &str| words.iter().any(|word| word.starts_with(part));
        // `acc`, `accx`, `acc12`, `accelerometer`, and not `account`.
        let is_acc = |word: &&str| {
            word.strip_prefix("acc").is_some_and(|rest| rest.starts_with("el") || rest.chars().count() <= 3)
        };
        if words.is_empty() {
            return Named::Index;
        }
        if self.is_text || any(&OTHERS) {
            return Named::Other;
        }
        if any(&TIMES) || name == "x_value" || within("timestamp") || words == ["x", "value"] {
            return Named::Time;
        }
        let alone = words.first() == Some(&"a") && words.len() <= 2;
        if alone || any(&ACCELERATIONS) || words.iter().any(is_acc) || within("beschl") {
            return Named::Acceleration;
        }
        if any(&PLACES) {
            return Named::Other;
        }
        if any(&INDICES) {
            return Named::Index;
        }
        Named::Unknown
    }

    /// As messages call it.
    pub(crate) fn shown(&self) -> String {
        match &self.spelled {
            Some(unit) if *unit != self.name => format!("{} [{unit}]", self.name),
            _ => self.name.clone(),
        }
    }
}

/// A text without the brackets around all of it.
pub(crate) fn unbracketed(text: &str) -> &str {
    let text = text.trim();
    let inner = [('[', ']'), ('(', ')')].into_iter().find_map(|(open, close)| {
        let whole = text.starts_with(open) && closing(text, close) == Some(text.len() - 1);
        whole.then(|| text[1..text.len() - 1].trim())
    });
    inner.unwrap_or(text)
}

/// A heading whose unit stands in brackets. Names of axes and the like may stand in brackets too; what stands in the last ones
/// and is neither is a unit that is not known.
fn bracketed(cell: &str) -> Option<Heading> {
    let mut groups = Vec::new();
    let mut rest = cell;
    let mut name = String::new();
    while let Some(open) = rest.find(['[', '(']) {
        let close = if rest[open..].starts_with('[') { ']' } else { ')' };
        let length = closing(&rest[open..], close)?;
        name.push_str(&rest[..open]);
        groups.push(rest[open + 1..open + length].trim());
        rest = &rest[open + length + 1..];
    }
    name.push_str(rest);
    let aside = |group: &&str| group.is_empty() || group.chars().count() == 1 && Unit::of(group).is_none();
    let named: Vec<_> = groups.iter().filter(|group| aside(group)).copied().collect();
    let units: Vec<_> = groups.iter().filter(|group| !aside(group)).copied().collect();
    let spelled = match units[..] {
        [] => return None,
        [unit] => unit.to_owned(),
        // One of them may be a unit and the others words, but no one can tell for all.
        _ => units.join("; "),
    };
    let words: Vec<_> = name.split_whitespace().chain(named).collect();
    Some(Heading { unit: Unit::of(&spelled), spelled: Some(spelled), ..Heading::named_alone(&words.join(" ")) })
}

/// Bytes up to the bracket that closes the one a text begins with.
fn closing(text: &str, close: char) -> Option<usize> {
    let open = text.chars().next()?;
    let mut depth = 0_usize;
    for (at, c) in text.char_indices() {
        depth += usize::from(c == open);
        if c == close {
            depth -= 1;
            if depth == 0 {
                return Some(at);
            }
        }
    }
    None
}

/// A heading that ends with its unit, after a comma, a colon, a slash, an underscore or a blank. The longest end that is a unit
/// counts, and what is before it must be a name: no number, and no word for a factor.
fn trailing(cell: &str) -> Option<Heading> {
    // A number before an underscore is part of a name: `acceleration_at_0.5_m_s2`; after such a word as well: `Channel 2 g`.
    let counted = |name: &str| {
        let before = name.split_whitespace().rev().nth(1).unwrap_or_default().to_lowercase();
        ["channel", "ch", "chan", "kanal", "canal", "voie", "sensor", "drop", "test", "run"].contains(&before.as_str())
    };
    let is_factor = |word: &str, blank: bool| {
        let word = word.to_lowercase();
        blank && word.starts_with(|c: char| c.is_ascii_digit())
            || word.strip_prefix('x').is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()))
            || [
                "deci", "centi", "milli", "micro", "nano", "pico", "deka", "hecto", "kilo", "mega", "giga", "k", "m",
                "u", "n",
            ]
            .contains(&word.as_str())
    };
    for (at, c) in cell.char_indices() {
        if !matches!(c, ',' | ':' | ';' | '/' | '_' | ' ') {
            continue;
        }
        let (name, unit) = (cell[..at].trim_end_matches([' ', ',', ':', '/', '_']), cell[at + c.len_utf8()..].trim());
        // A slash may be one of the unit.
        let name_only = Heading::named_alone(name);
        if c == '/' && !cell[..at].ends_with(' ') && matches!(name_only.named(), Named::Unknown | Named::Index) {
            continue;
        }
        // A number that no `x` stands before is the number of a channel or the range of a sensor.
        if unit.starts_with(|c: char| c.is_ascii_digit()) {
            continue;
        }
        let last = name.rsplit([' ', '_', ',', '/']).next().unwrap_or_default();
        if last.eq_ignore_ascii_case("per") {
            let sensitivity = Unit { kind: Kind::Other("the sensitivity of a sensor"), size: 1.0 };
            return Some(Heading { unit: Some(sensitivity), spelled: Some(format!("per {unit}")), ..name_only });
        }
        // One letter after a blank or an underscore is the name of an axis or of a channel as well.
        let lone = unit.chars().count() == 1 && !matches!(unit, "s" | "g" | "G");
        if let Some(known) = Unit::of(unit)
            && !name.is_empty()
            && !lone
            && !is_factor(last, c == ' ' && !counted(name))
        {
            return Some(Heading { unit: Some(known), spelled: Some(unit.to_owned()), ..name_only });
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headings_have_names_and_units() {
        for (cell, name, unit, named) in [
            ("time [ms]", "time", Some("ms"), Named::Time),
            ("\"Acceleration (g)\"", "Acceleration", Some("g"), Named::Acceleration),
            ("time, s", "time", Some("s"), Named::Time),
            ("t / ms", "t", Some("ms"), Named::Time),
            ("t/ms", "t", Some("ms"), Named::Time),
            ("time_ms", "time", Some("ms"), Named::Time),
            ("acceleration_m_s2", "acceleration", Some("m_s2"), Named::Acceleration),
            ("ax [g]", "ax", Some("g"), Named::Acceleration),
            ("a_x (m/s²)", "a_x", Some("m/s²"), Named::Acceleration),
            ("Linear Acceleration x (m/s^2)", "Linear Acceleration x", Some("m/s^2"), Named::Acceleration),
            ("Acceleration (z) [g]", "Acceleration z", Some("g"), Named::Acceleration),
            ("Acceleration (milli g)", "Acceleration", Some("milli g"), Named::Acceleration),
            ("acceleration milli g", "acceleration", Some("milli g"), Named::Acceleration),
            ("Seconds", "Seconds", Some("Seconds"), Named::Unknown),
            ("Zeit [s]", "Zeit", Some("s"), Named::Time),
            ("timestamp (ns)", "timestamp", Some("ns"), Named::Time),
            ("X_Value", "X_Value", None, Named::Time),
            ("height_a_m", "height_a_m", None, Named::Other),
            ("accel at position 2 [g]", "accel at position 2", Some("g"), Named::Acceleration),
            ("h", "h", None, Named::Unknown),
            ("min", "min", None, Named::Unknown),
            ("acceleration_at_0.5_m_s2", "acceleration_at_0.5", Some("m_s2"), Named::Acceleration),
            ("accel_x", "accel_x", None, Named::Acceleration),
            ("mass [g]", "mass", Some("g"), Named::Other),
            ("Velocity (m/s)", "Velocity", Some("m/s"), Named::Other),
            ("", "", None, Named::Index),
            ("Unnamed: 0", "Unnamed: 0", None, Named::Index),
            ("Channel 1", "Channel 1", None, Named::Unknown),
            ("ch1 g", "ch1", Some("g"), Named::Unknown),
        ] {
            let heading = Heading::of(cell);
            assert_eq!((heading.name.as_str(), heading.spelled.as_deref()), (name, unit), "{cell}");
            assert_eq!(heading.named(), named, "{cell}");
            assert_eq!(heading.unit.is_some(), unit.is_some(), "{cell}");
        }
    }

    /// A unit is never taken by its last letters.
    #[test]
    fn what_is_no_unit_as_a_whole_is_none() {
        for cell in [
            "acceleration [deka g]",
            "acceleration deka g",
            "acceleration 1000 g x",
            "acceleration [g] (100 mV/g)",
            "acceleration (g rms)",
            "acceleration [foo m/s2]",
            "a [m/s2/Hz]",
        ] {
            assert_eq!(Heading::of(cell).unit, None, "{cell}");
        }
        let sensor = Heading::of("acceleration (100 mV/g)").unit.expect("a unit of something else");
        assert_eq!(sensor.kind, Kind::Other("the sensitivity of a sensor"));
    }
}
