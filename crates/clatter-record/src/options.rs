//! What is told of a file beside the file.

use crate::Error;
use crate::unit::{Kind, Unit};

/// What is told of a file beside the file.
///
/// ```
/// use clatter_record::{Options, Units};
/// let options = Options { units: Some("ms, g".parse()?), ..Options::default() };
/// assert!("ms, kg".parse::<Units>().unwrap_err().to_string().contains("mass"));
/// # Ok::<(), clatter_record::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// The column of time; by its name and unit, else by its place, unless given.
    pub time: Option<Pick>,
    /// Columns of acceleration; all that are recognized unless some are given.
    pub accelerations: Vec<Pick>,
    /// Units, where the file names none.
    pub units: Option<Units>,
    /// Samples a second, in place of a column of time.
    pub sample_rate_hz: Option<f64>,
    /// What full scale is in m/s², for files that count in shares of it.
    pub full_scale_m_s2: Option<f64>,
    /// Which record of a file that holds several, from 1.
    pub record: Option<usize>,
    /// Whether lines that cannot be used are left out; else they are an error.
    pub skip_bad: bool,
    /// Numbers that are read at most: what is larger is refused.
    pub most_values: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            time: None,
            accelerations: Vec::new(),
            units: None,
            sample_rate_hz: None,
            full_scale_m_s2: None,
            record: None,
            skip_bad: false,
            most_values: 100_000_000,
        }
    }
}

/// A column by its number, from 1, or by its name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Pick {
    /// Its number, from 1.
    Number(usize),
    /// Its name, as the file has it, with its unit or without.
    Name(String),
}

impl std::str::FromStr for Pick {
    type Err = std::convert::Infallible;
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let text = text.trim();
        Ok(text.parse().map_or_else(|_| Self::Name(text.to_owned()), Self::Number))
    }
}

impl std::fmt::Display for Pick {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number}"),
            Self::Name(name) => write!(f, "'{name}'"),
        }
    }
}

/// Units of time and acceleration, or of acceleration alone.
#[derive(Debug, Clone, PartialEq)]
pub struct Units {
    pub(crate) time: Option<(Unit, String)>,
    pub(crate) acceleration: (Unit, String),
}

impl Units {
    /// Seconds and m/s².
    #[must_use]
    pub fn si() -> Self {
        let unit = |kind, name: &str| (Unit { kind, size: 1.0 }, name.to_owned());
        Self { time: Some(unit(Kind::Time, "s")), acceleration: unit(Kind::Acceleration, "m/s2") }
    }
}

impl std::str::FromStr for Units {
    type Err = Error;
    fn from_str(text: &str) -> Result<Self, Error> {
        let (time, acceleration) = match text.split_once(',') {
            Some((time, acceleration)) => (Some(time.trim()).filter(|time| !time.is_empty()), acceleration.trim()),
            None => (None, text.trim()),
        };
        let read = |text: &str, kind: Kind, what: &str, allowed: &str| match Unit::of(text) {
            Some(unit) if unit.kind == kind => Ok((unit, text.to_owned())),
            Some(Unit { kind: Kind::Other(other), .. }) => {
                Err(Error::Units(format!("'{text}' is a unit of {}, not of {what}", other.trim_start_matches("a "))))
            }
            _ => Err(Error::Units(format!("'{text}' is no unit of {what} that is known, such as {allowed}"))),
        };
        Ok(Self {
            time: time.map(|time| read(time, Kind::Time, "time", "s, ms, us, ns or min")).transpose()?,
            acceleration: read(acceleration, Kind::Acceleration, "acceleration", "g, mg, m/s2, mm/s2, in/s2 or ft/s2")?,
        })
    }
}
