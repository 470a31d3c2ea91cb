//! Headings tell what columns are.

mod brackets;
mod words;

use crate::factor;
use crate::unit::{Kind, Unit, lists};
use brackets::bracketed;
pub(crate) use brackets::unbracketed;
use words::{
    ACCELERATIONS, BEGINNINGS, CODED, DATES, DEVICES, FUNCTIONS, FUNCTIONS_WITHIN, G_FORCES, GRAMS, INDICES, OTHERS,
    PLACES, TIMES,
};

/// A heading: the name of a column and its unit.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Heading {
    pub(crate) name: String,
    /// The unit, if the heading has one that is known.
    pub(crate) unit: Option<Unit>,
    /// The unit as it is spelled, known or not.
    pub(crate) spelled: Option<String>,
    /// A factor that stands beside the name, in brackets of its own, where there is no unit.
    pub(crate) factor: f64,
    /// Tells whether words stand in the column, and no numbers.
    pub(crate) is_text: bool,
    /// The cell as it stands in the file, by which it may be picked as well.
    pub(crate) cell: String,
}

/// The kinds of columns that names tell apart.
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

/// No heading with a unit has more bytes.
const LONGEST: usize = 1000;

impl Heading {
    /// Of the text of a cell: `time [ms]`, `Acceleration (g)`, `time, s`, `t / ms`, `acceleration_m_s2`, `Seconds`.
    pub(crate) fn of(cell: &str) -> Self {
        Self { cell: cell.trim().trim_matches('"').to_owned(), ..Self::read(cell) }
    }

    fn read(cell: &str) -> Self {
        let cell = &plain(cell.trim().trim_matches(['"', '\'']).trim());
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
            trailing(cell).or_else(|| spoken(cell)).unwrap_or_else(|| Self::named_alone(cell))
        })
    }

    /// A name without a unit.
    pub(crate) fn named_alone(name: &str) -> Self {
        Self { name: name.to_owned(), unit: None, spelled: None, factor: 1.0, is_text: false, cell: String::new() }
    }

    /// The same with a unit that stands elsewhere.
    pub(crate) fn with_unit(mut self, unit: &str) -> Self {
        let unit = unbracketed(unit.trim().trim_matches('"'));
        if !unit.is_empty() {
            let sized = Unit::of(unit).map(|unit| unit.times(self.factor));
            (self.unit, self.spelled) = (sized, Some(unit.to_owned()));
        }
        self
    }

    /// The quantity of the unit, if it is known.
    pub(crate) fn kind(&self) -> Option<Kind> {
        self.unit.map(|unit| unit.kind)
    }

    /// Returns what the name says.
    pub(crate) fn named(&self) -> Named {
        let name = self.name.to_lowercase();
        let words = parts(&name);
        let any = |list: &str| words.iter().any(|word| lists(list, word));
        let within = |part: &str| words.iter().any(|word| word.contains(part));
        // `acc`, `accx`, `acc12`, `accelerometer`, `accSmooth`, and not `account`.
        let is_acc = |word: &&str| {
            word.strip_prefix("acc").is_some_and(|rest| {
                ["el", "smooth", "raw"].iter().any(|part| rest.starts_with(part)) || rest.chars().count() <= 3
            })
        };
        if words.is_empty() {
            return Named::Index;
        }
        if let Some(coded) = coded(&self.name) {
            return coded;
        }
        // A magnetic one, but for `field.acceleration.x`.
        let is_field = words.contains(&"field") && !words.iter().any(is_acc);
        if self.is_text
            || any(OTHERS)
            || is_field
            || BEGINNINGS.split(' ').any(|begin| words.iter().any(|word| word.starts_with(begin)))
        {
            return Named::Other;
        }
        if any(TIMES) || name == "x_value" || within("timestamp") || words == ["x", "value"] {
            return Named::Time;
        }
        if any(DATES) {
            return Named::Other;
        }
        let alone = words.first() == Some(&"a") && words.len() <= 2;
        if alone || any(ACCELERATIONS) || words.iter().any(is_acc) || within("beschl") {
            return Named::Acceleration;
        }
        if any(PLACES) {
            return Named::Other;
        }
        if any(INDICES) {
            return Named::Index;
        }
        Named::Unknown
    }

    /// Returns whether it says something of time or acceleration, or has a unit.
    pub(crate) fn is_telling(&self) -> bool {
        self.unit.is_some() || self.names_time_or_acceleration()
    }
    pub(crate) fn names_time_or_acceleration(&self) -> bool {
        matches!(self.named(), Named::Time | Named::Acceleration)
    }

    /// Returns whether the name alone says that a column is of times, whatever stands in it.
    pub(crate) fn is_time_by_name(&self) -> bool {
        Self::named_alone(&self.name).named() == Named::Time
    }

    /// Returns whether a column is one of times, by its name or its unit; `t1` is, as `t`.
    pub(crate) fn is_time(&self) -> bool {
        let stem = self.name.trim_end_matches(|c: char| c.is_ascii_digit());
        let is_named = || [self.named(), Self::named_alone(stem).named()].contains(&Named::Time);
        match self.kind() {
            _ if self.is_text => false,
            Some(Kind::Time) => self.named() != Named::Other,
            None => is_named(),
            Some(_) => false,
        }
    }

    /// Why a column with a unit of acceleration, or with such a name, is no plain acceleration, if its name says so.
    pub(crate) fn function(&self) -> Option<String> {
        let name = self.name.to_lowercase();
        let word = parts(&name).into_iter().find(|word| lists(FUNCTIONS, word));
        let word = word.or_else(|| FUNCTIONS_WITHIN.split(' ').find(|part| name.contains(part)));
        let begins = name.starts_with(['-', '−', '–', '|']) && name.len() > 1;
        let raised = ["^", "²", "³", "**", "d/dt", "/dt"].iter().find(|mark| name.contains(**mark));
        let factor = parts(&name).into_iter().find(|word| factor::is_marked(word)).map(str::to_owned);
        let factor = factor.or_else(|| factor::beside(&name));
        word.map(|word| format!("'{word}'"))
            .or_else(|| raised.map(|mark| format!("'{mark}'")))
            .or_else(|| factor.map(|word| format!("'{word}'")))
            .or_else(|| {
                begins.then(|| format!("'{}' before its name", &name[..name.chars().next().map_or(0, char::len_utf8)]))
            })
    }

    /// Returns whether the name is one of an acceleration in g.
    pub(crate) fn is_g_force(&self) -> bool {
        lists(G_FORCES, &self.name.to_lowercase())
    }

    /// Returns whether the name tells devices or packets apart, and counts nothing.
    pub(crate) fn is_of_device(&self) -> bool {
        let name = self.name.to_lowercase();
        parts(&name).iter().any(|word| lists(DEVICES, word))
    }

    /// Returns whether the unit is written as gauss is, with a capital letter.
    pub(crate) fn is_in_capital_g(&self) -> bool {
        self.spelled.as_deref().is_some_and(|unit| ["G", "mG", "kG", "uG", "µG"].contains(&unit))
    }

    /// Returns whether the name is one of a magnetic field: `Bx`, `H_y`, `B field`.
    pub(crate) fn is_of_field(&self) -> bool {
        let name = self.name.to_lowercase();
        let words = parts(&name);
        let letter = |word: &&str| matches!(word.as_bytes(), [b'b' | b'h'] | [b'b' | b'h', b'x' | b'y' | b'z']);
        let named = ["field", "feld", "champ", "hall", "flux", "compass", "磁場"];
        words.iter().any(|word| named.contains(word)) || words.first().is_some_and(letter)
    }

    /// Returns whether a unit such as g or mG is one of a mass or of a magnetic field, by the name.
    pub(crate) fn is_of_grams(&self) -> bool {
        let name = self.name.to_lowercase();
        let words = parts(&name);
        let is_acc = words.iter().any(|word| lists(ACCELERATIONS, word) || word.starts_with("acc"));
        let in_grams =
            self.spelled.as_deref().is_some_and(|unit| unit.to_lowercase().ends_with('g') && !unit.contains('/'));
        in_grams && !is_acc && words.iter().any(|word| lists(GRAMS, word) || word.starts_with("magn"))
    }

    /// As messages call it.
    pub(crate) fn shown(&self) -> String {
        match &self.spelled {
            Some(unit) if *unit != self.name => format!("{} [{unit}]", self.name),
            _ => self.name.clone(),
        }
    }
}

/// Returns what a channel code of ISO 13499 is of, by its 13th and 14th place; none of another name.
fn coded(name: &str) -> Option<Named> {
    let is_code = |c: u8| c.is_ascii_uppercase() || c.is_ascii_digit() || c == b'?';
    let what = name.get(12..14).filter(|_| name.len() == 16 && name.bytes().all(is_code))?.to_lowercase();
    match &what[..] {
        "ac" => Some(Named::Acceleration),
        what => lists(CODED, what).then_some(Named::Other),
    }
}

/// Brackets as keyboards of the west have them, and one blank for all that is blank.
fn plain(cell: &str) -> String {
    let plain = |c: char| match c {
        '（' | '﹙' => '(',
        '）' | '﹚' => ')',
        '［' | '【' => '[',
        '］' | '】' => ']',
        '：' => ':',
        c if c.is_whitespace() => ' ',
        c => c,
    };
    let text: String = cell.chars().map(plain).collect();
    if text.contains("  ") { text.split_whitespace().collect::<Vec<_>>().join(" ") } else { text }
}

/// Returns whether a word before a number makes a factor or an offset of it.
pub(crate) fn is_factor_word(word: &str) -> bool {
    lists(words::FACTORS, word)
}

/// Words of a name, in small letters.
fn parts(name: &str) -> Vec<&str> {
    name.split(|c: char| !c.is_alphanumeric() && c != '#').filter(|word| !word.is_empty()).collect()
}

/// A name that says its unit in words: `seconds_elapsed`, `millis since start`.
fn spoken(cell: &str) -> Option<Heading> {
    let name = cell.to_lowercase();
    let words = parts(&name);
    let mut units =
        words.iter().filter(|word| word.chars().count() > 3).filter_map(|word| Some((word, Unit::of(word)?)));
    let (word, unit) = units.next().filter(|(_, unit)| unit.kind == Kind::Time && unit.size <= 1.0)?;
    let is_time = Heading::named_alone(cell).named() == Named::Time || words.contains(&"since");
    is_time.then(|| Heading { unit: Some(unit), spelled: Some((*word).to_owned()), ..Heading::named_alone(cell) })
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
        // `t_in_s` is a time in seconds, not one in inches a second.
        let in_words = unit.strip_prefix("in_").is_some_and(|unit| Unit::of_kind(unit, Kind::Time).is_some());
        if in_words && name_only.named() == Named::Time {
            continue;
        }
        let name_only = match name.strip_suffix(" in").or_else(|| name.strip_suffix("_in")) {
            Some(name) if !name.is_empty() => Heading::named_alone(name),
            _ => name_only,
        };
        // One letter after a blank or an underscore is the name of an axis or of a channel as well.
        let lone = unit.chars().count() == 1 && !matches!(unit, "s" | "g" | "G" | "с" | "秒");
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
            ("t_in_s", "t", Some("s"), Named::Time),
            ("time in ms", "time", Some("ms"), Named::Time),
            ("a_in_g", "a", Some("g"), Named::Acceleration),
            ("a_in_s2", "a", Some("in_s2"), Named::Acceleration),
            ("v_in_s", "v", Some("in_s"), Named::Unknown),
            ("acceleration_m_s2", "acceleration", Some("m_s2"), Named::Acceleration),
            ("ax [g]", "ax", Some("g"), Named::Acceleration),
            ("v_mm_s", "v", Some("mm_s"), Named::Unknown),
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
            ("az (raw) [g]", "az (raw)", Some("g"), Named::Acceleration),
            ("Response (Trigger)", "Response (Trigger)", None, Named::Other),
            ("時間（秒）", "時間", Some("秒"), Named::Time),
            ("accSmooth[2]", "accSmooth[2]", None, Named::Acceleration),
            ("seconds_elapsed", "seconds_elapsed", Some("seconds"), Named::Time),
            ("gyroX", "gyroX", None, Named::Other),
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
