//! Columns without names, by their places and their first rows.

use super::Preview;
use crate::Error;

impl Preview {
    /// Refuses columns without names that are not sure to be one time and channels.
    pub(super) fn refuse_unclear(&self, time: Option<usize>) -> Result<(), Error> {
        /// Rows that tell a time from a signal that rises.
        const SURE: usize = 6;
        /// So many columns may be two records side by side, or, without times, one channel that goes on from line to line.
        const MANY: usize = 4;
        /// No logger has more without a name.
        const CHANNELS: usize = 33;
        let count = self.headings.len();
        let rises = |column: usize| self.steps(column).all(|(a, b)| a < b);
        let is_like = |column: &usize| {
            let ratio = time.and_then(|time| Some(self.span(*column)? / self.span(time)?));
            rises(*column) && ratio.is_some_and(|ratio| (0.5..2.0).contains(&ratio))
        };
        let other = (time.map_or(count, |time| time + 1)..count).find(is_like);
        let sure = count >= MANY && self.rows.len() >= SURE && time.is_some_and(rises);
        if let Some(other) = other.filter(|_| sure) {
            return Err(Error::Columns(format!(
                "column {} rises from line to line as a time does, beside column {}: name the columns of one record, by --time and \
                 --acceleration",
                other + 1,
                time.unwrap_or(0) + 1
            )));
        }
        if count > CHANNELS && !self.cells.is_empty() {
            return Err(Error::Columns(format!(
                "{count} numbers a line without names are hardly {count} channels: name the channels, by --acceleration=1 and so on"
            )));
        }
        if time.is_none() && count >= MANY && !self.cells.is_empty() {
            return Err(Error::Columns(format!(
                "{count} numbers a line without names may be {count} channels, or one that goes on from line to line: name the \
                 channels, by --acceleration=1 and so on"
            )));
        }
        Ok(())
    }

    /// The column of times of those without names.
    pub(super) fn time_by_place(&self, none: bool) -> Result<Option<usize>, Error> {
        let count = self.headings.len();
        let all = |column: usize, is: fn((f64, f64)) -> bool| self.rows.len() > 1 && self.steps(column).all(is);
        let rises = |column| all(column, |(a, b)| a < b);
        let is_index = |column| all(column, |(a, b)| (b - a).to_bits() == 1.0_f64.to_bits());
        match count {
            1 if none => Ok(None),
            1 => Err(Error::Columns("the file has one column: give the sample rate of its samples".to_owned())),
            _ if self.headings[0].is_text => Ok(Some(1)),
            _ if none && !rises(0) => Ok(None),
            _ if count > 2 && is_index(0) && rises(1) => Ok(Some(1)),
            _ => Ok(Some(0)),
        }
    }
}
