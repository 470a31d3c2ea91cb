//! One line of numbers by its cells.

use std::borrow::Cow;

use clatter_shock::samples::LARGEST;

use super::{NO_VALUE, Rows, Use};
use crate::Error;
use crate::decimal::Decimal;
use crate::heading::Heading;
use crate::moment::{self, CLOCK, DATED};
use crate::text::cells::{is_beyond, is_missing};
use crate::text::visible;
use crate::unit::{Kind, Unit};

/// The kinds of lines.
pub(super) enum Row {
    Whole,
    /// Of a sensor that was not asked for.
    OfOther,
    Bad(String),
}

impl Rows {
    /// The numbers of a line by its cells.
    pub(super) fn cells_of_row(&mut self, text: &str, cells: &[Cow<'_, str>]) -> Result<Row, Error> {
        for column in 0..self.uses.len() {
            let use_of = self.uses[column];
            if let Use::Nothing = use_of {
                continue;
            }
            let Some(cell) = cells.get(column) else {
                let (text, count) = (visible(text), cells.len());
                return Ok(Row::Bad(format!("{text} has {count} of {} columns", self.shape.columns)));
            };
            let row = if let Use::Word(word) = use_of { self.word(cell, word)? } else { self.cell(cell, column)? };
            if let Some(row) = row {
                return Ok(row);
            }
        }
        let more = cells.iter().skip(self.shape.columns).filter(|cell| !cell.is_empty()).count();
        if more > 0 && self.shape.columns > 1 {
            return Ok(Row::Bad(format!(
                "'{}' has {} columns, and the lines above have {}",
                visible(text),
                cells.len(),
                self.shape.columns
            )));
        }
        Ok(Row::Whole)
    }

    /// As messages call a column.
    fn called(&self, column: usize) -> String {
        match self.uses[column] {
            Use::Acceleration(k) => format!("column {} ({})", column + 1, visible(&self.names[k])),
            Use::Time | Use::Checked | Use::Fraction => format!("column {} (time)", column + 1),
            _ => format!("column {}", column + 1),
        }
    }

    /// Returns what a line is by a word that has to be the same in all, if it is another one.
    fn word(&self, cell: &str, word: usize) -> Result<Option<Row>, Error> {
        let word = &self.shape.words[word];
        let (shown, expected, number) = (visible(cell), visible(&word.expected), word.column + 1);
        if cell == word.expected {
            Ok(None)
        } else if word.chosen {
            Ok(Some(Row::OfOther))
        } else if word.tells {
            Err(Error::Columns(format!(
                "line {} is of {shown}, and the lines above are of {expected}, by column {number}: --sensor=NAME reads those of one",
                self.line
            )))
        } else {
            Ok(Some(Row::Bad(format!("'{shown}' stands in column {number}, and {expected} above"))))
        }
    }

    /// Takes in a cell of numbers, or says what its line is.
    fn cell(&mut self, cell: &str, column: usize) -> Result<Option<Row>, Error> {
        let (form, use_of) = (self.shape.form, self.uses[column]);
        let bad = |text: String| Ok(Some(Row::Bad(text)));
        if is_beyond(cell) && matches!(use_of, Use::Acceleration(_)) {
            return Err(Error::File(format!(
                "line {}: {} in {} is a value beyond the range of the instrument: the largest values of the shock are not in the \
                 file",
                self.line,
                visible(cell),
                self.called(column)
            )));
        }
        let found = form.number(cell).map(|number| (number, None)).or_else(|| {
            let (number, unit) = form.measured(cell)?;
            Some((number, Some(unit)))
        });
        let is_used = |number: &Decimal| number.float().is_finite() || !matches!(use_of, Use::Time | Use::Fraction);
        let Some((number, unit)) = found.filter(|(number, _)| is_used(number)) else {
            let called = self.called(column);
            return match use_of {
                Use::Checked | Use::Count => Ok(None),
                _ if cell.is_empty() => bad(format!("nothing stands in {called}")),
                _ if is_missing(cell) => bad(format!("{cell} in {called} is no finite number")),
                Use::Time if cell.contains(':') => {
                    bad(format!("'{}' in {called} is not a time of day that is known", visible(cell)))
                }
                _ => bad(format!("'{}' in {called} is not a number", visible(cell))),
            };
        };
        let wrong = match use_of {
            Use::Date => {
                self.day = Some(number);
                self.date_of(cell)
            }
            Use::Fraction => {
                self.fraction = Some(number);
                let whole = !(0.0..1.0).contains(&(number.float() * self.shape.fraction.map_or(1.0, |(_, size)| size)));
                whole.then(|| format!("'{}' in {} is no fraction of a second", visible(cell), self.called(column)))
            }
            Use::Count => {
                self.count = Some(number);
                None
            }
            Use::Acceleration(k) => self.acceleration(cell, number, unit, column, k),
            _ => self.time_of(cell, number, unit, column),
        };
        Ok(wrong.map(Row::Bad))
    }

    /// Takes in an acceleration, or says why it is none.
    fn acceleration(
        &mut self,
        cell: &str,
        number: Decimal,
        unit: Option<&str>,
        column: usize,
        k: usize,
    ) -> Option<String> {
        let size = match self.size_of(cell, unit, column, Kind::Acceleration, self.sizes[k]) {
            Ok(size) => size,
            Err(wrong) => return Some(wrong + &self.called(column)),
        };
        if self.shape.form.is_grouped(cell) {
            self.digits[k + 1].note_grouped(cell);
        } else if self.open {
            self.open = !self.digits[k + 1].note(number, self.channels[k].len());
        }
        let value = number.float() * size;
        let what = || format!("{} in {}", visible(cell), self.called(column));
        if (NO_VALUE..1e38).contains(&number.float().abs()) {
            return Some(format!("{} is what instruments write for no value", what()));
        }
        if self.shape.header.fill == Some(number.float()) {
            return Some(format!("{} stands for no value, by a line above", what()));
        }
        if value.abs() > LARGEST {
            return Some(format!("{} is beyond {LARGEST:e} m/s²", what()));
        }
        self.row.push(value);
        None
    }

    /// Takes in a time, or says why it is none.
    fn time_of(&mut self, cell: &str, number: Decimal, unit: Option<&str>, column: usize) -> Option<String> {
        let what = || format!("'{}' in {}", visible(cell), self.called(column));
        match self.size_of(cell, unit, column, Kind::Time, self.time_size) {
            Ok(size) if size.to_bits() == self.time_size.to_bits() => {}
            Ok(_) => return Some(format!("{} is in another unit than above", what())),
            Err(wrong) => return Some(wrong + &self.called(column)),
        }
        let is_moment = |digits: i32| digits == CLOCK || digits == DATED;
        // A date whose day and month may be either counts as none, and one that is the same both ways does.
        let kind = |digits: i32| is_moment(digits).then_some(digits);
        if self.first_time.is_some_and(|first| kind(first.digits) != kind(number.digits)) {
            return Some(format!("{} is another kind of time than above", what()));
        }
        if self.shape.form.is_grouped(cell) {
            self.digits[0].note_grouped(cell);
        } else if self.open && !is_moment(number.digits) {
            self.open = !self.digits[0].note(number, self.times.len());
        }
        self.time = Some(number);
        self.date_of(cell)
    }

    /// Why a date is none that can be used: its day and month may be either, and it is another one than above.
    fn date_of(&mut self, cell: &str) -> Option<String> {
        if self.shape.form.order.is_some() {
            return None;
        }
        let date = moment::either(cell)?;
        match &self.first_date {
            None => self.first_date = Some(date.to_owned()),
            Some(first) if first == date => {}
            Some(first) => {
                return Some(format!("day and month of '{date}', and of '{first}' above, may be the one or the other"));
            }
        }
        None
    }

    /// The size of the unit of a cell: that of the column, or its own.
    fn size_of(&self, cell: &str, unit: Option<&str>, column: usize, kind: Kind, size: f64) -> Result<f64, String> {
        let is_measured = self.shape.measured.get(column) == Some(&true);
        match unit.map(|unit| (unit, Unit::of(unit))) {
            None if is_measured => Err(format!("no unit stands behind '{}' in ", visible(cell))),
            None => Ok(size),
            Some((_, Some(unit))) if unit.kind == kind && (is_measured || unit.size.to_bits() == size.to_bits()) => {
                Ok(unit.size)
            }
            Some((unit, _)) => {
                Err(format!("'{}' with its unit, {}, does not fit the heading of ", visible(cell), visible(unit)))
            }
        }
    }

    /// Returns whether a line is one word and numbers that it tells of: `Max,50`.
    pub(super) fn is_labelled(&self, cells: &[Cow<'_, str>]) -> bool {
        let time = self.uses.iter().position(|use_of| matches!(use_of, Use::Time | Use::Acceleration(_))).unwrap_or(0);
        let Some(cell) = cells.get(time).filter(|_| cells.len() > 1) else { return false };
        if !cell.starts_with(char::is_alphabetic) {
            return false;
        }
        let is_word = |c: char| c.is_alphabetic() || matches!(c, ' ' | '.' | ':' | '_' | '-');
        let is_word = cell.chars().filter(|c| c.is_alphabetic()).count() > 2 && cell.chars().all(is_word);
        is_word && !is_missing(cell) && !is_beyond(cell)
    }

    /// Returns whether cells are names of columns.
    pub(super) fn is_heading(cells: &[Cow<'_, str>]) -> bool {
        cells.len() > 1 && cells.iter().any(|cell| Heading::of(cell).is_telling())
    }

    /// Returns whether a text is a heading by which a column goes on in another unit.
    pub(super) fn is_other_unit(&self, cell: &str, use_of: Use) -> bool {
        let (kind, size) = match use_of {
            Use::Nothing | Use::Word(_) | Use::Date | Use::Fraction | Use::Count => return false,
            Use::Time | Use::Checked => (Kind::Time, self.time_size),
            Use::Acceleration(k) => (Kind::Acceleration, self.sizes[k]),
        };
        Heading::of(cell).unit.is_some_and(|unit| unit.kind == kind && unit.size.to_bits() != size.to_bits())
    }
}
