//! The lines of numbers of a text.

mod plain;
mod row;
mod shape;

use super::cells::is_missing;
use super::digits::Digits;
use super::layout::uncommented;
use super::{cut, head, visible};
use crate::account::Lines;
use crate::decimal::Decimal;
use crate::error::Bad;
use crate::moment::{CLOCK, DAY_S};
use crate::roles::{Role, Roles};
use crate::times::Printed;
use crate::{At, Error, Options};
use clatter_shock::samples::float;
use row::Row;
pub(super) use shape::Shape;

/// Instruments write 9.9E37 for a value beyond their range and 9.91E37 for none (SCPI 1999).
const NO_VALUE: f64 = 9.8e37;

/// The uses that a column has.
#[derive(Debug, Clone, Copy)]
enum Use {
    Nothing,
    Time,
    /// A time that a given rate stands in place of: held against it where it can be read.
    Checked,
    /// The date of a time of day.
    Date,
    /// The fraction of a second.
    Fraction,
    /// The number of the sample, where there are no times.
    Count,
    /// A word that has to be the same in every line.
    Word(usize),
    Acceleration(usize),
}

/// Lines of numbers, as far as they are read.
#[derive(Debug, Default)]
pub(crate) struct Rows {
    shape: Shape,
    /// The use of each column, up to the last that has one.
    uses: Vec<Use>,
    sizes: Vec<f64>,
    names: Vec<String>,
    time_size: f64,
    most_values: usize,
    skip_bad: bool,
    line: usize,
    /// Tells whether the channels may end before the lines do, as others have times of their own.
    ends_early: bool,
    /// The numbers of one line, in the order of its columns.
    row: Vec<f64>,
    time: Option<Decimal>,
    day: Option<Decimal>,
    count: Option<Decimal>,
    /// The last number of a sample; how many do not follow on the one before, and the line of the first.
    counted: Option<f64>,
    skips: (usize, usize),
    fraction: Option<Decimal>,
    first_fraction: Option<Decimal>,
    first_time: Option<Decimal>,
    first_day: Option<Decimal>,
    /// The first date of which day and month may be either.
    first_date: Option<String>,
    /// Seconds of whole days by which a clock has gone round.
    days_s: f64,
    /// Lines of nothing but text that no number follows so far.
    text: Bad,
    /// The first of them that is a heading.
    heading: Option<usize>,
    /// The last time above a heading that came again, and the line of that.
    again: Option<(f64, usize)>,
    /// The last empty line, and how many there are between lines of numbers.
    empty: Option<usize>,
    breaks: (usize, usize),
    /// How the digits of numbers are grouped, for the time and each channel, and whether that is open: no fraction was read that
    /// tells its mark.
    digits: Vec<Digits>,
    open: bool,
    lines: Lines,
    /// Samples whose line is the one before once more, and the line.
    pub(crate) doubled: Vec<(usize, usize)>,
    /// Time of the first sample, and between samples, where lines above the numbers tell it.
    pub(crate) sampled_s: Option<[f64; 2]>,
    /// Seconds since the first sample.
    pub(crate) times: Vec<f64>,
    pub(crate) printed: Printed,
    /// In m/s².
    pub(crate) channels: Vec<Vec<f64>>,
    /// Lines that cannot be used.
    pub(crate) bad: Bad,
    /// Samples that follow no other on the line before, each with its line.
    pub(crate) numbering: Vec<(usize, At)>,
}

impl Rows {
    pub(super) fn new(shape: Shape, roles: &Roles, options: &Options) -> Self {
        let mut used: Vec<(usize, Use)> =
            shape.words.iter().enumerate().map(|(i, word)| (word.column, Use::Word(i))).collect();
        used.extend(shape.date.map(|column| (column, Use::Date)));
        used.extend(shape.fraction.map(|(column, _)| (column, Use::Fraction)));
        used.extend(roles.counts.map(|column| (column, Use::Count)));
        used.extend(roles.checked.map(|(column, _)| (column, Use::Checked)));
        used.extend(roles.time.map(|(column, _)| (column, Use::Time)));
        used.extend(roles.channels.iter().enumerate().map(|(k, role)| (role.column, Use::Acceleration(k))));
        let last = used.iter().map(|(column, _)| *column).max();
        let mut uses = vec![Use::Nothing; last.map_or(0, |last| last + 1)];
        for (column, use_of) in used {
            uses[column] = use_of;
        }
        Self {
            uses,
            sizes: roles.channels.iter().map(|role| role.size).collect(),
            names: roles.channels.iter().map(|role| role.name.clone()).collect(),
            time_size: roles.time.or(roles.checked).map_or(1.0, |(_, size)| size),
            most_values: options.most_values,
            skip_bad: options.skip_bad,
            ends_early: roles.beside_others,
            digits: vec![Digits::default(); roles.channels.len() + 1],
            open: true,
            sampled_s: shape.sampled_s,
            channels: vec![Vec::new(); roles.channels.len()],
            shape,
            ..Self::default()
        }
    }

    /// Lines of a heading, that are read elsewhere.
    pub(super) fn skip_heading<T: AsRef<[u8]>>(&mut self, lines: &[T]) {
        let filled = self.skip(lines);
        self.lines.heading += filled;
    }
    /// Rows that were not asked for.
    pub(super) fn skip_rows<T: AsRef<[u8]>>(&mut self, lines: &[T]) {
        let filled = self.skip(lines);
        self.lines.others += filled;
    }
    /// Passes over lines, and says how many are not empty.
    fn skip<T: AsRef<[u8]>>(&mut self, lines: &[T]) -> usize {
        let empty = lines.iter().filter(|line| line.as_ref().trim_ascii().is_empty()).count();
        self.line += lines.len();
        self.lines.empty += empty;
        lines.len() - empty
    }
    /// Takes in a last line that has no end, below others, unless it is cut within a number.
    pub(super) fn take_end(&mut self, above: &[u8], line: &[u8]) -> Result<(), Error> {
        if line.is_empty() {
            return Ok(());
        }
        match cut::within(above, line, self.shape.form, self.shape.letters) {
            Some(why) => {
                self.line += 1;
                self.bad.add(At::Line(self.line), || why);
                Ok(())
            }
            None => self.take(&[line, b"\n"].concat()).map(|_| ()),
        }
    }
    /// The last line that was read.
    pub(super) fn line(&self) -> usize {
        self.line
    }
    /// Lines of text below the numbers: none of them is a sample.
    pub(crate) fn below(&self) -> &Bad {
        &self.text
    }
    /// Time between samples that a line above the numbers tells, and the line.
    pub(crate) fn rate(&self) -> Option<(f64, usize)> {
        self.shape.told
    }
    /// The same where there are times as well.
    pub(crate) fn told(&self) -> Option<(f64, usize)> {
        self.shape.told.filter(|_| !self.times.is_empty())
    }
    /// Returns how many lines were taken for what.
    pub(crate) fn lines(&self) -> Lines {
        self.lines
    }

    /// Says of so many lines, which were taken for empty ones, that they are of records that were not asked for.
    pub(super) fn of_other_records(&mut self, lines: usize) {
        let lines = lines.min(self.lines.empty);
        self.lines.empty -= lines;
        self.lines.others += lines;
    }

    /// Takes in all whole lines of a text, and says how many bytes they have.
    pub(super) fn take(&mut self, text: &[u8]) -> Result<usize, Error> {
        let Some(end) = text.iter().rposition(|byte| *byte == b'\n').map(|last| last + 1) else { return Ok(0) };
        let mut at = 0;
        let mut before = &text[..0];
        while at < end {
            self.line += 1;
            if let Some(length) = self.plain(&text[at..end]) {
                self.note_row()?;
                let line = &text[at..at + length];
                self.note_doubled(before, line);
                before = line;
                at += length;
                continue;
            }
            let length = text[at..end].iter().position(|byte| *byte == b'\n').unwrap_or(end - at - 1);
            let line = self.shape.letters.text(&text[at..at + length]);
            let rows = self.lines.rows;
            self.any(&line)?;
            let line = &text[at..at + length];
            if self.lines.rows > rows {
                self.note_doubled(before, line);
                before = line;
            }
            at += length + 1;
        }
        Ok(end)
    }

    /// Any other line.
    fn any(&mut self, line: &str) -> Result<(), Error> {
        let (text, commented) = uncommented(line);
        if commented {
            self.lines.comments += 1;
            return Ok(());
        }
        let form = self.shape.form;
        let cells = form.cells(line);
        if text.is_empty() || cells.iter().all(|cell| cell.is_empty()) {
            self.lines.empty += 1;
            self.empty = Some(self.line);
            return Ok(());
        }
        let is_data = |cell: &str| form.is_data(cell) || form.measured(cell).is_some();
        let is_text = cells.iter().all(|cell| cell.is_empty() || !is_data(cell));
        if is_text && head::numbers(text) > 1 {
            self.bad
                .add(At::Line(self.line), || format!("the numbers of '{}' do not fit the lines above", visible(text)));
            return Ok(());
        }
        if is_text || self.is_labelled(&cells) {
            if cells.iter().zip(&self.uses).any(|(cell, use_of)| self.is_other_unit(cell, *use_of)) {
                return Err(Error::File(format!(
                    "line {} begins a second block, in other units: one file each",
                    self.line
                )));
            }
            if self.again.is_none() && self.text.count == 0 && self.shape.heading.as_deref() == Some(text) {
                self.again = Some((self.times.last().copied().unwrap_or(f64::INFINITY), self.line));
                self.lines.heading += 1;
                return Ok(());
            }
            if self.heading.is_none() && Self::is_heading(&cells) {
                self.heading = Some(self.line);
            }
            self.text.add(At::Line(self.line), || format!("'{}' is no line of numbers", visible(text)));
            return Ok(());
        }
        let is_used = |column: &usize| !matches!(self.uses[*column], Use::Nothing);
        let is_empty = |column: usize| cells.get(column).is_none_or(|cell| cell.is_empty() || is_missing(cell));
        let is_channel = |column: &usize| matches!(self.uses[*column], Use::Acceleration(_));
        if self.shape.by_other && (0..self.uses.len()).filter(is_channel).all(is_empty) {
            let others = (0..self.shape.columns)
                .filter(|column| self.uses.get(*column).is_none_or(|use_of| matches!(use_of, Use::Nothing)));
            if others.into_iter().any(|column| cells.get(column).is_some_and(|cell| form.number(cell).is_some())) {
                self.lines.others += 1;
                return Ok(());
            }
        }
        if self.ends_early && (0..self.uses.len()).filter(is_used).all(is_empty) {
            // Without times a number that follows would be of another one.
            if self.uses.iter().any(|use_of| matches!(use_of, Use::Time)) {
                self.lines.rows += 1;
            } else {
                let names = self.names.join(", ");
                self.text.add(At::Line(self.line), || format!("nothing stands in the columns of {names}"));
            }
            return Ok(());
        }
        self.row.clear();
        match self.cells_of_row(text, &cells)? {
            Row::Whole => self.note_row(),
            Row::OfOther => {
                self.lines.others += 1;
                Ok(())
            }
            Row::Bad(what) => {
                self.bad.add(At::Line(self.line), || what);
                Ok(())
            }
        }
    }

    /// The numbers of a line of several values of the one channel.
    pub(super) fn values(&mut self, line: &str) -> Result<(), Error> {
        self.line += 1;
        if line.trim().is_empty() {
            self.lines.empty += 1;
            return Ok(());
        }
        let cells = self.shape.form.cells(line);
        let read: Option<Vec<Decimal>> = cells.iter().map(|cell| self.shape.form.number(cell)).collect();
        let Some(read) = read.filter(|_| self.text.count == 0) else {
            self.text.add(At::Line(self.line), || format!("'{}' is no line of numbers", visible(line.trim())));
            if head::numbers(line) > 0 {
                self.bad.add(At::Line(self.line), || format!("numbers below text: '{}'", visible(line.trim())));
            }
            return Ok(());
        };
        for number in read {
            self.row.clear();
            self.row.push(number.float() * self.sizes[0]);
            self.note_row()?;
            self.lines.rows -= 1;
        }
        self.lines.rows += 1;
        Ok(())
    }

    /// Checks that all lines that were read go together.
    pub(super) fn close(&mut self) -> Result<(), Error> {
        self.drop_counts();
        let has_point = self.digits.iter().any(Digits::has_point);
        for (k, digits) in self.digits.iter().enumerate() {
            let values = k.checked_sub(1).map(|k| (&mut self.channels[k], self.sizes[k]));
            digits.close(has_point, values).map_err(|what| {
                let name = k.checked_sub(1).map_or("time", |k| &self.names[k]);
                Error::Columns(format!("in column '{}' {what}", visible(name)))
            })?;
        }
        let samples = self.channels[0].len();
        if let Some((count, line)) = self.shape.count.filter(|(count, _)| *count != samples) {
            return Err(Error::File(format!(
                "line {line} is a number, {count}, apart from the {samples} lines of numbers below, and not their count: a # before \
                 what is none of them"
            )));
        }
        let (breaks, line) = self.breaks;
        if self.times.is_empty() && breaks > 0 && 2 * breaks < samples {
            return Err(Error::File(format!(
                "line {line} is empty, and numbers without times stand above and below: one record a file"
            )));
        }
        self.lines.below = self.text.count;
        self.lines.bad = self.bad.count;
        self.lines.all = self.line;
        Ok(())
    }

    /// Takes in the number of a sample, which is that of the one before and 1.
    #[inline]
    fn note_count(&mut self, number: f64) {
        if self.counted.is_some_and(|last| (number - last - 1.0).abs() > 0.5) {
            self.skips = (self.skips.0 + 1, if self.skips.0 == 0 { self.line } else { self.skips.1 });
        }
        self.counted = Some(number);
    }

    /// Leaves out a first line that says of each channel how many samples follow.
    fn drop_counts(&mut self) {
        let samples = self.channels[0].len();
        let is_count =
            |(channel, size): (&Vec<f64>, &f64)| channel[0].to_bits() == (float(samples - 1) * size).to_bits();
        if samples < 3 || !self.times.is_empty() || !self.channels.iter().zip(&self.sizes).all(is_count) {
            return;
        }
        for channel in &mut self.channels {
            channel.remove(0);
        }
        let first = self.numbering.first().map(|(_, at)| at.after(1));
        self.numbering = first
            .into_iter()
            .map(|at| (0, at))
            .chain(self.numbering.iter().skip(1).map(|(sample, at)| (sample - 1, *at)))
            .collect();
        (self.lines.rows, self.lines.heading) = (self.lines.rows - 1, self.lines.heading + 1);
    }

    /// Notes a row at the time of the one before whose line is the same.
    #[inline]
    fn note_doubled(&mut self, before: &[u8], line: &[u8]) {
        if let [.., a, b] = self.times[..]
            && a.to_bits() == b.to_bits()
            && before.trim_ascii() == line.trim_ascii()
        {
            self.doubled.push((self.times.len() - 1, self.line));
        }
    }

    /// Keeps the numbers of a line.
    #[inline]
    fn note_row(&mut self) -> Result<(), Error> {
        if self.text.count > 0 {
            self.go_on()?;
        }
        let sample = self.channels[0].len();
        if let Some(empty) = self.empty.take()
            && sample > 0
        {
            self.breaks = (self.breaks.0 + 1, if self.breaks.0 == 0 { empty } else { self.breaks.1 });
        }
        self.lines.rows += 1;
        if let Some(number) = self.count.take() {
            self.note_count(number.float());
        }
        let at = At::Line(self.line);
        if self.numbering.last().is_none_or(|(first, begin)| begin.after(sample - first) != at) {
            self.numbering.push((sample, at));
        }
        let again = self.again.take();
        if let Some(time) = self.time {
            let first = *self.first_time.get_or_insert(time);
            let mut since_s = time.above(first) * self.time_size + self.days_s;
            if let Some(day) = self.day {
                since_s += day.above(*self.first_day.get_or_insert(day));
            } else if time.digits == CLOCK && self.times.last().is_some_and(|last| since_s < last - 0.5 * DAY_S) {
                // A clock goes round at midnight.
                self.days_s += DAY_S;
                since_s += DAY_S;
            }
            let mut printed = time;
            if let Some((fraction, (_, size))) = self.fraction.zip(self.shape.fraction) {
                since_s += fraction.above(*self.first_fraction.get_or_insert(fraction)) * size;
                // As exact as the fraction is, wherever the seconds are.
                printed = Decimal { digits: CLOCK, ..fraction };
            }
            self.times.push(since_s);
            self.printed.note(printed);
        }
        // Numbers below a heading that came again go on where their times do, which they have.
        if let Some((last, line)) = again
            && !(self.time.is_some() && self.times.last().is_some_and(|time| *time > last))
        {
            return Err(Self::another_record(line));
        }
        for (channel, value) in self.channels.iter_mut().zip(&self.row) {
            channel.push(*value);
        }
        if (sample + 1) * (self.channels.len() + 1) > self.most_values {
            return Err(Error::Many(self.most_values));
        }
        Ok(())
    }

    fn another_record(line: usize) -> Error {
        Error::Records(format!("line {line} begins another record: --record=1 reads the first, --record=2 the next"))
    }

    /// Numbers follow on lines of text: those are no footer, or another record begins.
    fn go_on(&mut self) -> Result<(), Error> {
        if let Some(line) = self.heading.take().filter(|_| !self.skip_bad && !self.channels[0].is_empty()) {
            return Err(Self::another_record(line));
        }
        let text = std::mem::take(&mut self.text);
        for (at, what) in &text.first {
            self.bad.add(*at, || what.clone());
        }
        self.bad.count += text.count - text.first.len();
        Ok(())
    }

    /// Time of the first sample in seconds.
    pub(crate) fn start_s(&self) -> f64 {
        let fraction =
            self.first_fraction.zip(self.shape.fraction).map_or(0.0, |(part, (_, size))| part.float() * size);
        self.first_time.map_or(0.0, |time| time.float() * self.time_size) + fraction
    }
    /// The size of the unit of time in which its last digit is, in seconds.
    pub(crate) fn time_size(&self) -> f64 {
        self.shape.fraction.map_or(self.time_size, |(_, size)| size)
    }
    /// What lines above the numbers tell that does not go with them.
    pub(crate) fn against_header(&self, channels: &[Role]) -> Vec<String> {
        let own: Vec<_> = channels.iter().map(|role| (role.name.clone(), role.unit.clone())).collect();
        let start_s = self.first_time.map(|_| self.start_s());
        let mut found = self.shape.header.against(self.lines.rows + self.lines.bad, start_s, &own);
        let (skips, line) = self.skips;
        if skips > 0 {
            found.push(format!(
                "the numbers of samples do not go on by one {skips} times, first in line {line}: samples may be missing"
            ));
        }
        found
    }
    /// The slope and the offset by which numbers without a unit of their own become accelerations, and the line that tells them.
    pub(crate) fn slope(&self) -> Option<([f64; 2], usize)> {
        self.shape.header.slope
    }
}
