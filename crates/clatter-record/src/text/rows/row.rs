//! One line of numbers by its cells.

use std::borrow::Cow;

use super::{NO_VALUE, Rows, Use};
use crate::Error;
use crate::heading::{Heading, Named};
use crate::moment::{self, CLOCK, DATED};
use crate::samples::LARGEST;
use crate::text::cells::{is_beyond, is_missing};
use crate::text::visible;
use crate::unit::{Kind, Unit};

/// What a line is.
pub(super) enum Row {
    Whole,
    /// Of a sensor that was not asked for.
    OfOther,
    Bad(String),
}

impl Rows {
    /// The numbers of a line by its cells.
    pub(super) fn cells_of_row(&mut self, text: &str, cells: &[Cow<'_, str>]) -> Result<Row, Error> {
        let form = self.shape.form;
        for column in 0..self.uses.len() {
            let use_of = self.uses[column];
            let what = || match use_of {
                Use::Acceleration(k) => format!("column {} ({})", column + 1, visible(&self.names[k])),
                Use::Time | Use::Checked => format!("column {} (time)", column + 1),
                _ => format!("column {}", column + 1),
            };
            if let Use::Nothing = use_of {
                continue;
            }
            let Some(cell) = cells.get(column).map(|cell| &**cell) else {
                return Ok(Row::Bad(format!(
                    "{} has {} of {} columns",
                    visible(text),
                    cells.len(),
                    self.shape.columns
                )));
            };
            if let Use::Word(word) = use_of {
                let word = &self.shape.words[word];
                match cell == word.expected {
                    true => continue,
                    false if word.chosen => return Ok(Row::OfOther),
                    false if word.tells => {
                        return Err(Error::Columns(format!(
                            "line {} is of {}, and the lines above are of {}, by column {}: --sensor=NAME reads those of one",
                            self.line,
                            visible(cell),
                            visible(&word.expected),
                            column + 1
                        )));
                    }
                    false => {
                        let (cell, expected) = (visible(cell), visible(&word.expected));
                        return Ok(Row::Bad(format!("'{cell}' stands in {}, and {expected} above", what())));
                    }
                }
            }
            if is_beyond(cell) && matches!(use_of, Use::Acceleration(_)) {
                return Err(Error::File(format!(
                    "line {}: {} in {} is a value beyond the range of the instrument: the largest values of the shock are not \
                     in the file",
                    self.line,
                    visible(cell),
                    what()
                )));
            }
            if cell.is_empty() && !matches!(use_of, Use::Checked) {
                return Ok(Row::Bad(format!("nothing stands in {}", what())));
            }
            if is_missing(cell) && !matches!(use_of, Use::Checked) {
                return Ok(Row::Bad(format!("{cell} in {} is no finite number", what())));
            }
            let found = form.number(cell).map(|number| (number, None)).or_else(|| {
                let (number, unit) = form.measured(cell)?;
                Some((number, Some(unit)))
            });
            let Some((number, unit)) =
                found.filter(|(number, _)| number.float().is_finite() || !matches!(use_of, Use::Time))
            else {
                if let Use::Checked = use_of {
                    continue;
                }
                let kind = if matches!(use_of, Use::Time) && cell.contains(':') {
                    "not a time of day that is known"
                } else {
                    "not a number"
                };
                return Ok(Row::Bad(format!("'{}' in {} is {kind}", visible(cell), what())));
            };
            match use_of {
                Use::Date => {
                    if let Some(wrong) = self.date_of(cell) {
                        return Ok(Row::Bad(wrong));
                    }
                    self.day = Some(number);
                }
                Use::Acceleration(k) => {
                    let size = match self.size_of(cell, unit, column, Kind::Acceleration, self.sizes[k]) {
                        Ok(size) => size,
                        Err(wrong) => return Ok(Row::Bad(wrong + &what())),
                    };
                    if form.is_grouped(cell) {
                        self.digits[k + 1].note_grouped(cell);
                    } else if self.open {
                        self.open = !self.digits[k + 1].note(number, self.channels[k].len());
                    }
                    let value = number.float() * size;
                    if (NO_VALUE..1e38).contains(&number.float().abs()) {
                        return Ok(Row::Bad(format!(
                            "{} in {} is what instruments write for no value",
                            visible(cell),
                            what()
                        )));
                    }
                    if value.abs() > LARGEST {
                        return Ok(Row::Bad(format!("{} in {} is beyond {LARGEST:e} m/s²", visible(cell), what())));
                    }
                    self.row.push(value);
                }
                _ => {
                    let size = self.size_of(cell, unit, column, Kind::Time, self.time_size);
                    match size {
                        Ok(size) if size.to_bits() == self.time_size.to_bits() => {}
                        Ok(_) => {
                            return Ok(Row::Bad(format!(
                                "'{}' in {} is in another unit than above",
                                visible(cell),
                                what()
                            )));
                        }
                        Err(wrong) => return Ok(Row::Bad(wrong + &what())),
                    }
                    let is_moment = |digits: i32| digits == CLOCK || digits == DATED;
                    if self.first_time.is_some_and(|first| is_moment(first.digits) != is_moment(number.digits)) {
                        return Ok(Row::Bad(format!(
                            "'{}' in {} is another kind of time than above",
                            visible(cell),
                            what()
                        )));
                    }
                    if let Some(wrong) = self.date_of(cell) {
                        return Ok(Row::Bad(wrong));
                    }
                    if form.is_grouped(cell) {
                        self.digits[0].note_grouped(cell);
                    } else if self.open && !is_moment(number.digits) {
                        self.open = !self.digits[0].note(number, self.times.len());
                    }
                    self.time = Some(number);
                }
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

    /// Whether a line is one word and numbers that it tells of: `Max,50`.
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

    /// Whether cells are names of columns.
    pub(super) fn is_heading(&self, cells: &[Cow<'_, str>]) -> bool {
        let telling = |cell: &Cow<'_, str>| {
            let heading = Heading::of(cell);
            heading.unit.is_some() || matches!(heading.named(), Named::Time | Named::Acceleration)
        };
        cells.len() > 1 && cells.iter().any(telling)
    }

    /// Whether a text is a heading by which a column goes on in another unit.
    pub(super) fn is_other_unit(&self, cell: &str, use_of: Use) -> bool {
        let (kind, size) = match use_of {
            Use::Nothing | Use::Word(_) | Use::Date => return false,
            Use::Time | Use::Checked => (Kind::Time, self.time_size),
            Use::Acceleration(k) => (Kind::Acceleration, self.sizes[k]),
        };
        Heading::of(cell).unit.is_some_and(|unit| unit.kind == kind && unit.size.to_bits() != size.to_bits())
    }
}
