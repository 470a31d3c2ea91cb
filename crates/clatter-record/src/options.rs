//! Settings that a caller tells beside the file.

use crate::Error;
use crate::unit::{Kind, Unit, VOLTAGE};

/// Settings that a caller tells beside the file.
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
    /// Full scale in m/s², for files that count in shares of it.
    pub full_scale_m_s2: Option<f64>,
    /// Volts that a sensor gives for an acceleration, in V s²/m, for channels in volts.
    pub sensitivity_v_s2_m: Option<f64>,
    /// The sensor whose rows are read, where rows of several come in turns.
    pub sensor: Option<String>,
    /// Which record of a file that holds several, from 1.
    pub record: Option<usize>,
    /// Tells whether lines that cannot be used are left out; else they are an error.
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
            sensitivity_v_s2_m: None,
            sensor: None,
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

/// The sensitivity of a sensor such as 100mV/g or 10.2 mV/(m/s2), in V s²/m.
///
/// ```
/// assert_eq!(clatter_record::sensitivity("2V/g").unwrap(), 2.0 / 9.80665);
/// assert!(clatter_record::sensitivity("100 pC/g").is_err());
/// ```
///
/// # Errors
/// [`Error::Units`] for anything else than a voltage over an acceleration.
pub fn sensitivity(text: &str) -> Result<f64, Error> {
    let of = || {
        let (volts, acceleration) = text.split_once('/')?;
        let end = volts.rfind(|c: char| c.is_ascii_digit() || c == '.')? + 1;
        let number: f64 =
            volts[..end].trim().parse().ok().filter(|number: &f64| *number > 0.0 && number.is_finite())?;
        let volt = Unit::of_kind(&volts[end..], VOLTAGE)?;
        let acceleration = acceleration.trim();
        let inner = acceleration.strip_prefix('(').and_then(|text| text.strip_suffix(')')).unwrap_or(acceleration);
        let per = Unit::of_kind(inner, Kind::Acceleration)?;
        Some(number * volt.size / per.size)
    };
    of().ok_or_else(|| {
        Error::Units(format!("'{text}' is no voltage for an acceleration, such as 100mV/g or 10.2mV/(m/s2)"))
    })
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
