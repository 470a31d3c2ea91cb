//! Which column is time, and which are accelerations: by name and unit, then by place.

use crate::heading::{Heading, Named};
use crate::unit::{Kind, Unit};
use crate::{Error, Options, Pick};

/// What the columns of a file are.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Roles {
    /// The column of time and the size of its unit in seconds; none where samples come at a given rate.
    pub(crate) time: Option<(usize, f64)>,
    pub(crate) channels: Vec<Role>,
    /// What is made of no other column, as messages call them.
    pub(crate) left_out: Vec<String>,
    /// Whether other channels have other times, for which lines may go on.
    pub(crate) beside_others: bool,
}

/// A column of accelerations.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Role {
    pub(crate) column: usize,
    pub(crate) name: String,
    /// Of its unit, in m/s².
    pub(crate) size: f64,
    /// Its unit as the file or the caller spells it.
    pub(crate) unit: String,
}

/// The columns as they are known before the numbers are read.
#[derive(Debug, Clone, Default)]
pub(crate) struct Seen {
    pub(crate) headings: Vec<Heading>,
    /// Whether the file names its columns.
    pub(crate) named: bool,
    /// Whether the file tells times apart from columns.
    pub(crate) sampled: bool,
    /// The first rows, for columns without names.
    pub(crate) rows: Vec<Vec<f64>>,
}

impl Seen {
    /// What each column is.
    ///
    /// # Errors
    /// [`Error::Columns`] where it is not clear, [`Error::Units`] for a unit that is missing, or not known, or another one.
    pub(crate) fn roles(&self, options: &Options) -> Result<Roles, Error> {
        let time = self.time(options)?;
        let channels = self.channels(time, options)?;
        let left_out = (0..self.headings.len())
            .filter(|column| Some(*column) != time && !channels.contains(column))
            .filter(|column| self.named && self.headings[*column].named() != Named::Index)
            .map(|column| self.called(column));
        let left_out = left_out.collect();
        let size = |column: usize| self.time_size(column, options).map(|size| (column, size));
        Ok(Roles {
            // A rate stands in place of times.
            time: time.filter(|_| options.sample_rate_hz.is_none()).map(size).transpose()?,
            channels: channels.iter().map(|column| self.channel(*column, options)).collect::<Result<_, _>>()?,
            left_out,
            beside_others: false,
        })
    }

    /// The column that a caller picks.
    fn picked(&self, pick: &Pick, what: &str) -> Result<usize, Error> {
        let found = match pick {
            Pick::Number(number) => number.checked_sub(1).filter(|column| *column < self.headings.len()),
            Pick::Name(name) => {
                let is = |heading: &Heading| {
                    heading.name.eq_ignore_ascii_case(name) || heading.shown().eq_ignore_ascii_case(name)
                };
                self.headings.iter().position(is)
            }
        };
        found.ok_or_else(|| {
            let all: Vec<_> = (0..self.headings.len()).map(|column| self.called(column)).collect();
            Error::Columns(format!("there is no column {pick} for the {what}; there are {}", all.join(", ")))
        })
    }

    /// As messages call a column: its number and its heading.
    pub(crate) fn called(&self, column: usize) -> String {
        match self.headings[column].shown() {
            shown if shown.is_empty() => (column + 1).to_string(),
            shown => format!("{} ({shown})", column + 1),
        }
    }

    fn time(&self, options: &Options) -> Result<Option<usize>, Error> {
        if let Some(pick) = &options.time {
            return self.picked(pick, "time").map(Some);
        }
        let none = self.sampled || options.sample_rate_hz.is_some();
        if !self.named {
            return self.time_by_place(none);
        }
        let kind = |heading: &Heading| heading.unit.map(|unit| unit.kind);
        let is_named = |heading: &Heading| heading.named() == Named::Time;
        let is_unit = |heading: &Heading| kind(heading) == Some(Kind::Time);
        let fits = |heading: &Heading| matches!(kind(heading), None | Some(Kind::Time));
        let find = |is: &dyn Fn(&Heading) -> bool| self.headings.iter().position(is);
        let found = find(&|heading| is_named(heading) && is_unit(heading))
            .or_else(|| find(&|heading| is_unit(heading) && heading.named() != Named::Other))
            .or_else(|| find(&|heading| is_named(heading) && fits(heading)))
            .or_else(|| (0..self.headings.len()).find(|column| self.is_time(*column)));
        if found.is_some() || none {
            return Ok(found);
        }
        // By place: a first column that is named as nothing else.
        let first = self.headings.iter().position(|heading| heading.named() != Named::Index);
        let unknown = |heading: &Heading| heading.unit.is_none() && heading.named() == Named::Unknown;
        match first {
            Some(column) if self.headings.len() > 1 && unknown(&self.headings[column]) => Ok(Some(column)),
            _ => Err(Error::Columns(format!(
                "no column is a time: {}; name one by its number, or give the sample rate",
                self.all()
            ))),
        }
    }

    /// Refuses columns where another one of times does not go with the one that is taken.
    pub(crate) fn refuse_other_time(&self, time: usize) -> Result<(), Error> {
        let span = |column: usize| {
            let heading = &self.headings[column];
            let unit = heading.unit.filter(|unit| unit.kind == Kind::Time && heading.named() == Named::Time)?;
            let at = |row: Option<&Vec<f64>>| row.and_then(|row| row.get(column)).map(|time| time * unit.size);
            Some(at(self.rows.last())? - at(self.rows.first())?).filter(|span| *span > 0.0)
        };
        let Some(own) = span(time) else { return Ok(()) };
        // Far more than what is rounded in a few rows.
        let differs = |column: &usize| span(*column).is_some_and(|other| (other / own).ln().abs() > 0.3);
        match (0..self.headings.len()).find(differs) {
            None => Ok(()),
            Some(other) => Err(Error::Columns(format!(
                "column {} runs at another rate than column {}: take channels of one of them, by --time and --acceleration",
                self.called(other),
                self.called(time)
            ))),
        }
    }

    fn time_by_place(&self, none: bool) -> Result<Option<usize>, Error> {
        let count = self.headings.len();
        let rises = |column: usize| {
            let values = || self.rows.iter().filter_map(|row| row.get(column));
            self.rows.len() > 1 && values().zip(values().skip(1)).all(|(a, b)| a < b)
        };
        let is_index = |column: usize| {
            let values = || self.rows.iter().filter_map(|row| row.get(column));
            self.rows.len() > 1 && values().zip(values().skip(1)).all(|(a, b)| (b - a).to_bits() == 1.0_f64.to_bits())
        };
        match count {
            1 if none => Ok(None),
            1 => Err(Error::Columns("the file has one column: give the sample rate of its samples".to_owned())),
            _ if none && !rises(0) => Ok(None),
            _ if count > 2 && is_index(0) && rises(1) => Ok(Some(1)),
            _ => Ok(Some(0)),
        }
    }

    fn all(&self) -> String {
        const SHOWN: usize = 20;
        let count = self.headings.len();
        let all: Vec<_> = (0..count.min(SHOWN)).map(|column| self.called(column)).collect();
        let more = if count > SHOWN { format!(" and {} more", count - SHOWN) } else { String::new() };
        format!("the columns are {}{more}", all.join(", "))
    }

    pub(crate) fn channels(&self, time: Option<usize>, options: &Options) -> Result<Vec<usize>, Error> {
        if !options.accelerations.is_empty() {
            return options.accelerations.iter().map(|pick| self.picked(pick, "acceleration")).collect();
        }
        // Times of other channels are none.
        let is_time = |column: usize| Some(column) == time || self.named && self.is_time(column);
        let rest: Vec<usize> = (0..self.headings.len()).filter(|column| !is_time(*column)).collect();
        if !self.named {
            let skipped = time.filter(|time| *time == 1).map_or(0, |_| 1);
            return Ok(rest.into_iter().skip(skipped).collect());
        }
        let those = |is: &dyn Fn(&Heading) -> bool| -> Vec<usize> {
            rest.iter().copied().filter(|column| is(&self.headings[*column])).collect()
        };
        // What has a unit of acceleration, or one that is not understood below such a name, is one.
        let found = those(&|heading| match (heading.named(), heading.unit.map(|unit| unit.kind)) {
            (Named::Other | Named::Time, _) => false,
            (_, Some(kind)) => kind == Kind::Acceleration || heading.named() == Named::Acceleration,
            (named, None) => named == Named::Acceleration,
        });
        let found = if found.is_empty() {
            let unknown = those(&|heading| heading.unit.is_none() && heading.named() == Named::Unknown);
            let is = |column: &usize, names: &[&str]| {
                names.iter().any(|name| self.headings[*column].name.eq_ignore_ascii_case(name))
            };
            // Beside x, y and z they are those of a gyroscope.
            let turns = unknown.iter().any(|column| is(column, &["x"]));
            unknown.into_iter().filter(|column| !turns || !is(column, &["gx", "gy", "gz"])).collect()
        } else {
            found
        };
        if found.is_empty() {
            return Err(Error::Columns(format!("no column is an acceleration: {}", self.all())));
        }
        Ok(found)
    }

    pub(crate) fn time_size(&self, column: usize, options: &Options) -> Result<f64, Error> {
        let given = options.units.as_ref().and_then(|units| units.time.as_ref());
        self.unit(column, given, Kind::Time, "time", "ms").map(|(unit, _)| unit.size)
    }

    fn channel(&self, column: usize, options: &Options) -> Result<Role, Error> {
        let heading = &self.headings[column];
        let name = if heading.name.is_empty() { format!("column {}", column + 1) } else { heading.name.clone() };
        if heading.spelled.as_deref() == Some(crate::FULL_SCALE) {
            let size = options.full_scale_m_s2.ok_or_else(|| {
                Error::Units("the file counts in shares of full scale: say what full scale is, such as 50g".to_owned())
            })?;
            return Ok(Role { column, name, size, unit: crate::FULL_SCALE.to_owned() });
        }
        let given = options.units.as_ref().map(|units| &units.acceleration);
        let (unit, spelled) = self.unit(column, given, Kind::Acceleration, "acceleration", "g or m/s2")?;
        Ok(Role { column, name, size: unit.size, unit: spelled })
    }

    /// The unit of a column: that of the file, which must not be another than the given one.
    fn unit(
        &self,
        column: usize,
        given: Option<&(Unit, String)>,
        kind: Kind,
        what: &str,
        example: &str,
    ) -> Result<(Unit, String), Error> {
        let heading = &self.headings[column];
        let called = self.called(column);
        match (heading.unit, &heading.spelled, given) {
            (Some(unit), Some(spelled), _) if unit.kind != kind => {
                let is = match unit.kind {
                    Kind::Other(is) => is,
                    Kind::Time => "a time",
                    Kind::Acceleration => "an acceleration",
                };
                Err(Error::Units(format!("column {called} is in {spelled}, {is}, and not the {what}")))
            }
            (Some(unit), Some(spelled), Some((other, name))) if unit.size.to_bits() != other.size.to_bits() => {
                Err(Error::Units(format!(
                    "column {called} is in {spelled} by its heading, and in {name} by the units given"
                )))
            }
            (Some(unit), spelled, _) => Ok((unit, spelled.clone().unwrap_or_default())),
            (None, _, Some((unit, name))) => Ok((*unit, name.clone())),
            (None, Some(spelled), None) => {
                let is_number = spelled.starts_with(|c: char| c.is_ascii_digit());
                let hint = if is_number { "; its number may be a range: write x1000 for a factor" } else { "" };
                Err(Error::Units(format!(
                    "column {called}: '{spelled}' is no unit of {what} that is known, such as {example}{hint}"
                )))
            }
            (None, None, None) => Err(Error::Units(format!(
                "the unit of column {called}, the {what}, is not named: give the units, or begin the file with a heading \
                 such as `time [s],acceleration [m/s2]`"
            ))),
        }
    }
}
