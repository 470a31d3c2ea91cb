//! Which column is time, and which are accelerations: by name and unit, then by place.

mod by_place;

use crate::heading::{Heading, Named};
use crate::unit::{Kind, Unit, VOLTAGE};
use crate::{Error, Options, Pick};

/// The columns of a file by what they are.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Roles {
    /// The column of time and the size of its unit in seconds; none where samples come at a given rate.
    pub(crate) time: Option<(usize, f64)>,
    pub(crate) channels: Vec<Role>,
    /// The column of times that a given rate stands in place of, and the size of its unit.
    pub(crate) checked: Option<(usize, f64)>,
    /// The column of the numbers of the samples, where there is no other time.
    pub(crate) counts: Option<usize>,
    /// Columns that nothing is made of, as messages call them.
    pub(crate) left_out: Vec<String>,
    /// Every column, as messages call it, and what it is taken for.
    pub(crate) columns: Vec<(String, String)>,
    /// Tells whether other channels have other times, for which lines may go on.
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
pub(crate) struct Preview {
    pub(crate) headings: Vec<Heading>,
    /// Tells whether the file names its columns.
    pub(crate) named: bool,
    /// Tells whether the file tells times apart from columns.
    pub(crate) sampled: bool,
    /// The first rows, for columns without names.
    pub(crate) rows: Vec<Vec<f64>>,
    /// The cells of the first row of a text.
    pub(crate) cells: Vec<String>,
}

impl Preview {
    /// Returns what each column is.
    ///
    /// # Errors
    /// [`Error::Columns`] where it is not clear, [`Error::Units`] for a unit that is missing, or not known, or another one.
    pub(crate) fn roles(&self, options: &Options) -> Result<Roles, Error> {
        let time = self.time(options)?;
        let channels = self.channels(time, options)?;
        let left_out = (0..self.headings.len())
            .filter(|column| Some(*column) != time && !channels.contains(column))
            .filter(|column| self.named && !self.is_index(*column))
            .map(|column| self.called(column));
        let left_out = left_out.collect();
        let columns =
            (0..self.headings.len()).map(|column| (self.called(column), self.taken_for(column, time, &channels)));
        let columns = columns.collect();
        let size = |column: usize| self.time_size(column, options).map(|size| (column, size));
        Ok(Roles {
            // A rate stands in place of times.
            time: time.filter(|_| options.sample_rate_hz.is_none()).map(size).transpose()?,
            channels: channels.iter().map(|column| self.channel(*column, options)).collect::<Result<_, _>>()?,
            checked: self.checked_time(&channels, options),
            counts: if time.is_none() || options.sample_rate_hz.is_some() { self.counts() } else { None },
            left_out,
            columns,
            beside_others: false,
        })
    }

    /// Returns what a column is taken for, or why it is nothing.
    fn taken_for(&self, column: usize, time: Option<usize>, channels: &[usize]) -> String {
        let heading = &self.headings[column];
        let is = match heading.kind() {
            _ if time == Some(column) => "time",
            _ if channels.contains(&column) => "acceleration",
            _ if heading.is_text => "words",
            _ if self.is_index(column) => "number of the row",
            Some(Kind::Acceleration) if self.is_of_grams(column) => "no acceleration by its name",
            Some(Kind::Acceleration) => "not asked for",
            Some(Kind::Time) => "another time",
            Some(Kind::Other(what)) => what,
            None => "no acceleration by its name",
        };
        is.to_owned()
    }

    /// The column of times that a given rate stands in place of, and the size of its unit, if it can be read.
    fn checked_time(&self, channels: &[usize], options: &Options) -> Option<(usize, f64)> {
        options.sample_rate_hz?;
        let without = Options { sample_rate_hz: None, ..options.clone() };
        let time = self.time(&without).ok()??;
        let heading = &self.headings[time];
        let is_time = heading.kind() == Some(Kind::Time) || heading.named() == Named::Time || !self.named;
        let size = self.time_size(time, &without).ok()?;
        (is_time && !channels.contains(&time) && self.goes_on(time)).then_some((time, size))
    }

    /// The column that a caller picks.
    fn picked(&self, pick: &Pick, what: &str) -> Result<usize, Error> {
        let found = match pick {
            Pick::Number(number) => number.checked_sub(1).filter(|column| *column < self.headings.len()),
            Pick::Name(name) => {
                let names = |heading: &Heading| [heading.name.clone(), heading.shown(), heading.cell.clone()];
                let exact = |heading: &Heading| names(heading).iter().any(|own| own == name);
                let alike = |heading: &Heading| names(heading).iter().any(|own| own.eq_ignore_ascii_case(name));
                self.headings.iter().position(exact).or_else(|| self.headings.iter().position(alike))
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
            let column = self.picked(pick, "time")?;
            if self.sampled && self.named && self.is_index(column) && options.sample_rate_hz.is_none() {
                return Err(Error::Columns(format!(
                    "column {} counts the samples, and the lines above tell their times",
                    self.called(column)
                )));
            }
            return Ok(Some(column));
        }
        let none = self.sampled || options.sample_rate_hz.is_some();
        if !self.named {
            return self.time_by_place(none);
        }
        if let Some((whole, ..)) = self.fraction().filter(|_| !none) {
            return Ok(Some(whole));
        }
        let is_named = |heading: &Heading| heading.named() == Named::Time;
        let is_unit = |heading: &Heading| heading.kind() == Some(Kind::Time);
        let fits = |heading: &Heading| matches!(heading.kind(), None | Some(Kind::Time));
        // One that goes on, where there is one: what is told of a whole file may be a time as well.
        let find = |is: &dyn Fn(&Heading) -> bool| {
            let all = || (0..self.headings.len()).filter(|column| is(&self.headings[*column]));
            all().find(|column| self.goes_on(*column)).or_else(|| all().next())
        };
        let found = find(&|heading| is_named(heading) && is_unit(heading))
            .filter(|column| self.goes_on(*column) || self.rows.len() < 2)
            .or_else(|| find(&|heading| is_unit(heading) && heading.named() != Named::Other))
            .or_else(|| find(&|heading| is_named(heading) && fits(heading)))
            .or_else(|| find(&Heading::is_time));
        if found.is_none()
            && !none
            && let Some(column) = self.headings.iter().position(|heading| heading.is_text && heading.is_time_by_name())
        {
            let cell = self.cells.get(column).map_or("", String::as_str);
            return Err(Error::Columns(format!(
                "'{cell}' in column {} is no number and no time of day that is known",
                self.called(column)
            )));
        }
        if found.is_some() || none {
            return Ok(found);
        }
        // By place: a first column that is named as nothing else.
        let first = (0..self.headings.len()).find(|column| !self.is_index(*column));
        let unknown = |heading: &Heading| heading.unit.is_none() && heading.named() == Named::Unknown;
        match first {
            Some(column) if self.headings.len() > 1 && unknown(&self.headings[column]) => Ok(Some(column)),
            _ => Err(Error::Columns(format!(
                "no column is a time: {}; name one by its number, or give the sample rate",
                self.all()
            ))),
        }
    }

    /// A column of whole seconds, or of a clock without their fraction, and one of the fraction beside it, with the size of its unit: both
    /// are one time.
    pub(crate) fn fraction(&self) -> Option<(usize, usize, f64)> {
        let size =
            |column: usize| self.headings[column].unit.filter(|unit| unit.kind == Kind::Time).map(|unit| unit.size);
        let all =
            |column: usize, is: &dyn Fn(f64) -> bool| self.numbers(column).count() > 1 && self.numbers(column).all(is);
        let columns = || 0..self.headings.len();
        // A date alone is none.
        let is_number = |column: usize| {
            self.cells.get(column).is_some_and(|cell| cell.contains(':') || cell.parse::<f64>().is_ok())
        };
        let is_whole = |column: usize| {
            size(column).is_some_and(|size| size.to_bits() == 1.0_f64.to_bits())
                && self.headings[column].named() != Named::Other
                && all(column, &|number| number.fract() == 0.0)
        };
        let whole = columns().find(|column| is_number(*column) && is_whole(*column))?;
        let part = columns().find(|column| {
            let below = |size: f64| size < 1.0 && all(*column, &|number| (0.0..1.0).contains(&(number * size)));
            size(*column).is_some_and(below)
                && self.headings[*column].named() != Named::Other
                && self.numbers(*column).any(|number| number != 0.0)
        })?;
        Some((whole, part, size(part)?))
    }

    /// Takes the unit of times that have none from the time between samples that the file tells.
    pub(crate) fn take_unit_of_time(&mut self, step_s: f64) {
        /// Times may be printed to few digits.
        const SAME: f64 = 0.05;
        let open = |column: &usize| self.headings[*column].is_time() && self.headings[*column].spelled.is_none();
        for column in (0..self.headings.len()).filter(open).collect::<Vec<_>>() {
            let steps = clatter_shock::samples::float(self.rows.len().max(2) - 1);
            let Some(step) = self.span(column).map(|span| span / steps) else { continue };
            let unit = [("s", 1.0), ("ms", 1e-3), ("us", 1e-6)];
            if let Some((unit, _)) = unit.into_iter().find(|(_, size)| (step * size / step_s - 1.0).abs() < SAME) {
                self.headings[column] = self.headings[column].clone().with_unit(unit);
            }
        }
    }

    /// The numbers of a column in the first rows.
    pub(crate) fn numbers(&self, column: usize) -> impl DoubleEndedIterator<Item = f64> {
        self.rows.iter().filter_map(move |row| row.get(column)).copied()
    }
    /// The same in pairs, each number with the next.
    fn steps(&self, column: usize) -> impl Iterator<Item = (f64, f64)> {
        self.numbers(column).zip(self.numbers(column).skip(1))
    }
    /// From the number in the first row to that in the last one.
    pub(crate) fn span(&self, column: usize) -> Option<f64> {
        let at = |row: Option<&Vec<f64>>| row.and_then(|row| row.get(column)).copied();
        Some(at(self.rows.last())? - at(self.rows.first())?)
    }

    /// Returns whether the first rows of a column rise, or stay for a while and rise, or are too few to tell.
    pub(crate) fn goes_on(&self, column: usize) -> bool {
        let values = || self.numbers(column).filter(|value| value.is_finite());
        let rises = values().zip(values().skip(1)).all(|(a, b)| a <= b);
        let moves = values().next().zip(values().next_back()).is_some_and(|(a, b)| a < b);
        self.rows.len() > 1 && rises && moves
    }

    /// The column that counts the samples.
    fn counts(&self) -> Option<usize> {
        let is_number =
            |column: &usize| self.named && self.is_index(*column) && self.steps(*column).all(|(a, b)| a < b);
        (0..self.headings.len()).filter(|_| self.rows.len() > 1).find(is_number)
    }

    /// Returns whether a column counts its rows, as its name says: in whole numbers that are each as far from the next, or the same.
    fn is_index(&self, column: usize) -> bool {
        let heading = &self.headings[column];
        if heading.named() != Named::Index || heading.kind() == Some(Kind::Acceleration) {
            return false;
        }
        let step = self.steps(column).map(|(a, b)| b - a).find(|step| *step != 0.0);
        let counts = |step: f64| {
            let is_step = |(a, b): (f64, f64)| b.to_bits() == a.to_bits() || ((b - a) - step).abs() < 0.5;
            step >= 1.0 && self.steps(column).all(|(a, b)| is_step((a, b)) && a.fract() == 0.0 && b.fract() == 0.0)
        };
        // What has no numbers counts nothing else, nor does what tells devices apart.
        let is_empty = || self.numbers(column).all(f64::is_nan);
        step.is_some_and(counts) || is_empty() || heading.is_of_device()
    }

    /// Returns whether a column is one of times: by its name or unit, or one that rises evenly before the values of the same name, as in
    /// `Trace 2 X`, `Trace 2 Y`.
    pub(crate) fn is_time(&self, column: usize) -> bool {
        let heading = &self.headings[column];
        if heading.is_time() {
            return true;
        }
        let stem = |column: usize, axis: char| {
            let name = self.headings.get(column)?.name.to_lowercase();
            name.strip_suffix(axis).map(|stem| stem.trim_end_matches([' ', '_', '-', '.']).to_owned())
        };
        let is_open = heading.unit.is_none() && heading.named() == Named::Unknown && !heading.is_text;
        let before_values = || {
            stem(column, 'x').is_some_and(|name| stem(column + 1, 'y') == Some(name) && stem(column + 2, 'z').is_none())
        };
        is_open && before_values() && self.rises_evenly(column)
    }

    /// Returns whether a column of which nothing is known rises by just as much as the times do.
    fn rises_with(&self, column: usize, time: Option<usize>) -> bool {
        let heading = &self.headings[column];
        let is_open = heading.unit.is_none() && heading.named() == Named::Unknown && !heading.is_text;
        let same = |(own, span): (f64, f64)| (own / span - 1.0).abs() < 1e-6;
        is_open
            && self.rises_evenly(column)
            && time.is_some_and(|time| self.span(column).zip(self.span(time)).is_some_and(same))
    }

    /// Returns whether the first rows of a column rise by steps that are all alike, and are enough to tell.
    fn rises_evenly(&self, column: usize) -> bool {
        /// Rows that tell a time from a signal that rises.
        const SURE: usize = 6;
        let Some(mean) = self.span(column).map(|span| span / clatter_shock::samples::float(self.rows.len() - 1)) else {
            return false;
        };
        // Times that are printed to few digits.
        self.rows.len() >= SURE && mean > 0.0 && self.steps(column).all(|(a, b)| ((b - a) / mean - 1.0).abs() < 0.3)
    }

    /// Returns whether a unit of acceleration is one of mass or of a magnetic field: by the name, or as a capital G beside small ones.
    fn is_of_grams(&self, column: usize) -> bool {
        let heading = &self.headings[column];
        let small = |other: &Heading| other.spelled.as_deref().is_some_and(|unit| ["g", "mg"].contains(&unit));
        heading.is_of_grams() || heading.is_in_capital_g() && (heading.is_of_field() || self.headings.iter().any(small))
    }

    /// Of columns that nothing else is known of those of x, y and z, where all three are there and other ones beside.
    fn axes(&self, columns: &[usize]) -> Option<Vec<usize>> {
        let find =
            |axis: &str| columns.iter().copied().find(|column| self.headings[*column].name.eq_ignore_ascii_case(axis));
        let three = ["x", "y", "z"].iter().map(|axis| find(axis)).collect::<Option<Vec<_>>>()?;
        Some(columns.iter().copied().filter(|column| three.contains(column)).collect())
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
        let is_time = |column: usize| {
            Some(column) == time || self.named && (self.is_time(column) || self.rises_with(column, time))
        };
        let rest: Vec<usize> = (0..self.headings.len()).filter(|column| !is_time(*column)).collect();
        if !self.named {
            self.refuse_unclear(time)?;
            let rest: Vec<usize> = rest.into_iter().filter(|column| !self.headings[*column].is_text).collect();
            let skipped = time.filter(|time| *time == 1 && !self.headings[0].is_text).map_or(0, |_| 1);
            let found: Vec<usize> = rest.into_iter().skip(skipped).collect();
            if found.is_empty() {
                return Err(Error::Columns(format!("no column is an acceleration: {}", self.all())));
            }
            return Ok(found);
        }
        let those = |is: &dyn Fn(&Heading) -> bool| -> Vec<usize> {
            rest.iter().copied().filter(|column| is(&self.headings[*column]) && !self.is_of_grams(*column)).collect()
        };
        let volts = |heading: &Heading| options.sensitivity_v_s2_m.is_some() && heading.kind() == Some(VOLTAGE);
        // Words drop no column that has a unit of acceleration, but for grams and gausses. Below a name of an acceleration a unit
        // that is not understood, or one of something else, has to be cleared up.
        let mut found = those(&|heading| match (heading.named(), heading.kind()) {
            (_, Some(Kind::Acceleration)) => !heading.is_text,
            (Named::Other | Named::Time, _) => volts(heading),
            (named, _) => volts(heading) || named == Named::Acceleration,
        });
        // Accelerations in g beside those in m/s²: the unit given tells which.
        let is_g_force = |column: &usize| self.headings[*column].is_g_force();
        if found.iter().any(is_g_force) && !found.iter().all(is_g_force) {
            let in_g = options.units.as_ref().is_some_and(|units| units.acceleration.0.size > 1.0);
            found.retain(|column| is_g_force(column) == in_g);
        }
        if found.is_empty() {
            let unknown: Vec<usize> = rest
                .iter()
                .copied()
                .filter(|column| {
                    let heading = &self.headings[*column];
                    let is_unknown = matches!(heading.named(), Named::Unknown | Named::Index);
                    heading.unit.is_none() && is_unknown && !self.is_index(*column)
                })
                .collect();
            found = self.axes(&unknown).unwrap_or(unknown);
        }
        // By its name alone, a function of accelerations is one of the other columns.
        let is_plain =
            |column: &usize| self.headings[*column].unit.is_some() || self.headings[*column].function().is_none();
        if found.iter().any(is_plain) {
            found.retain(is_plain);
        }
        if let Some((column, what)) = found.iter().find_map(|column| Some((column, self.headings[*column].function()?)))
        {
            return Err(Error::Columns(format!(
                "column {} is no plain acceleration by {what} in its heading: take the others, by --acceleration",
                self.called(*column)
            )));
        }
        if found.is_empty() {
            let in_volts = self.headings.iter().any(|heading| heading.kind() == Some(VOLTAGE));
            let hint = if in_volts { "; --sensitivity such as 100mV/g makes accelerations of a voltage" } else { "" };
            return Err(Error::Columns(format!("no column is an acceleration: {}{hint}", self.all())));
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
        if let Some(function) = heading.function().filter(|_| options.accelerations.is_empty()) {
            return Err(Error::Columns(format!(
                "column {} is no plain acceleration by {function}",
                self.called(column)
            )));
        }
        if let Some(per) = options.sensitivity_v_s2_m {
            return match heading.unit {
                Some(unit) if unit.kind == VOLTAGE => {
                    let unit_name = heading.spelled.clone().unwrap_or_default();
                    Ok(Role { column, name, size: unit.size / per, unit: unit_name })
                }
                _ => Err(Error::Units(format!(
                    "a sensitivity is for volts, and column {} is in none by its heading",
                    self.called(column)
                ))),
            };
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
            (None, _, Some((unit, name))) => Ok((unit.times(heading.factor), name.clone())),
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
