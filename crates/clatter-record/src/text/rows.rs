//! The lines of numbers of a text.

use super::cells::{Form, is_missing};
use super::layout::uncommented;
use super::text_of;
use crate::decimal::Decimal;
use crate::error::Bad;
use crate::heading::Heading;
use crate::moment::{CLOCK, DAY_S};
use crate::roles::Roles;
use crate::samples::LARGEST;
use crate::times::Printed;
use crate::unit::Kind;
use crate::{At, Error, Options};

/// Instruments write 9.9E37 for a value beyond their range and 9.91E37 for none (SCPI 1999).
const NO_VALUE: f64 = 9.8e37;

/// What is made of a column.
#[derive(Debug, Clone, Copy)]
enum Use {
    Nothing,
    Time,
    Acceleration(usize),
}

/// Lines of numbers, as far as they are read.
#[derive(Debug)]
pub(crate) struct Rows {
    form: Form,
    /// What is made of each column, up to the last that is used.
    uses: Vec<Use>,
    columns: usize,
    sizes: Vec<f64>,
    names: Vec<String>,
    time_size: f64,
    most_values: usize,
    line: usize,
    /// Whether the channels may end before the lines do, as others have times of their own.
    ends_early: bool,
    /// The numbers of one line, in the order of its columns.
    row: Vec<f64>,
    time: Option<Decimal>,
    first_time: Option<Decimal>,
    /// Seconds of whole days by which a clock has gone round.
    days_s: f64,
    /// Lines of nothing but text that no number follows so far.
    text: Bad,
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
    pub(super) fn new(
        form: Form,
        roles: &Roles,
        options: &Options,
        columns: usize,
        sampled_s: Option<[f64; 2]>,
    ) -> Self {
        let last = roles.channels.iter().map(|role| role.column).chain(roles.time.map(|(column, _)| column)).max();
        let mut uses = vec![Use::Nothing; last.map_or(0, |last| last + 1)];
        if let Some((column, _)) = roles.time {
            uses[column] = Use::Time;
        }
        for (k, role) in roles.channels.iter().enumerate() {
            uses[role.column] = Use::Acceleration(k);
        }
        Self {
            form,
            uses,
            columns,
            sizes: roles.channels.iter().map(|role| role.size).collect(),
            names: roles.channels.iter().map(|role| role.name.clone()).collect(),
            time_size: roles.time.map_or(1.0, |(_, size)| size),
            most_values: options.most_values,
            line: 0,
            ends_early: false,
            row: Vec::new(),
            time: None,
            first_time: None,
            days_s: 0.0,
            text: Bad::default(),
            sampled_s,
            times: Vec::new(),
            printed: Printed::default(),
            channels: vec![Vec::new(); roles.channels.len()],
            bad: Bad::default(),
            numbering: Vec::new(),
        }
    }

    /// Lines that were read before.
    pub(super) fn skip_lines(&mut self, lines: usize) {
        self.line = lines;
    }
    /// Lines without a number for any of the channels are none of a row: other channels go on.
    pub(super) fn may_end_early(&mut self) {
        self.ends_early = true;
    }
    /// The next line cannot be used.
    pub(super) fn refuse(&mut self, what: &str) {
        self.line += 1;
        self.bad.add(At::Line(self.line), || what.to_owned());
    }
    /// The last line that was read.
    pub(super) fn line(&self) -> usize {
        self.line
    }
    /// Lines of text below the numbers: none of them is a sample.
    pub(crate) fn below(&self) -> &Bad {
        &self.text
    }

    /// Takes in all whole lines of a text, and says how many bytes they have.
    pub(super) fn take(&mut self, text: &[u8]) -> Result<usize, Error> {
        let Some(end) = text.iter().rposition(|byte| *byte == b'\n').map(|last| last + 1) else { return Ok(0) };
        let mut at = 0;
        while at < end {
            self.line += 1;
            if let Some(length) = self.plain(&text[at..end]) {
                at += length;
                self.note_row()?;
                continue;
            }
            let length = text[at..end].iter().position(|byte| *byte == b'\n').unwrap_or(end - at - 1);
            let line = text_of(&text[at..at + length]);
            at += length + 1;
            self.any(&line)?;
        }
        Ok(end)
    }

    /// A line of plain numbers, the usual one, straight from its bytes: how many they are, or nothing where it is not so plain.
    #[inline]
    fn plain(&mut self, text: &[u8]) -> Option<usize> {
        let Form { separator, point } = self.form;
        let is_blank = |byte: u8| byte == b' ' || byte == b'\t' && separator != Some(b'\t');
        let mut at = 0;
        self.row.clear();
        for (column, use_of) in self.uses.iter().enumerate() {
            while is_blank(text[at]) {
                at += 1;
            }
            if let Use::Nothing = use_of {
                let ends = |byte: u8| separator.map_or(is_blank(byte), |separator| byte == separator);
                while !ends(text[at]) {
                    if text[at] == b'\n' || text[at] == b'"' {
                        return None;
                    }
                    at += 1;
                }
            } else {
                let (number, length) = Decimal::scan(&text[at..], point)?;
                at += length;
                match use_of {
                    Use::Acceleration(k) => {
                        let number = number.float();
                        let value = number * self.sizes[*k];
                        if value.abs() > LARGEST || number.abs() >= NO_VALUE {
                            return None;
                        }
                        self.row.push(value);
                    }
                    _ => self.time = Some(number),
                }
            }
            let before = at;
            while is_blank(text[at]) {
                at += 1;
            }
            let last = column + 1 == self.uses.len();
            match (text[at], separator) {
                (b'\n', _) if last => return Some(at + 1),
                (b'\r', _) if last => {}
                // More columns than there are is a fault, and nothing beyond the last separator is none.
                (byte, Some(separator)) if byte == separator && last && column + 1 == self.columns => {
                    at += 1;
                    return (text[at..].starts_with(b"\n") || text[at..].starts_with(b"\r\n"))
                        .then(|| at + if text[at] == b'\n' { 1 } else { 2 });
                }
                (byte, Some(separator)) if byte == separator => at += 1,
                (_, None) if last && column + 1 == self.columns => return None,
                (_, None) if at > before => {}
                _ => return None,
            }
        }
        // Whatever else is on the line is of no use.
        let rest = text[at..].iter().position(|byte| *byte == b'\n')?;
        Some(at + rest + 1)
    }

    /// Any other line.
    fn any(&mut self, line: &str) -> Result<(), Error> {
        let (text, commented) = uncommented(line);
        if text.is_empty() || commented {
            return Ok(());
        }
        let cells = self.form.cells(line);
        let form = self.form;
        if cells.iter().all(|cell| cell.is_empty()) {
            return Ok(());
        }
        if cells.iter().all(|cell| cell.is_empty() || !form.is_data(cell)) {
            if cells.iter().zip(&self.uses).any(|(cell, use_of)| self.is_other_unit(cell, *use_of)) {
                return Err(Error::File(format!(
                    "line {} begins a second block, in other units: one file each",
                    self.line
                )));
            }
            self.text.add(At::Line(self.line), || format!("'{}' is no line of numbers", visible(text)));
            return Ok(());
        }
        let is_used = |column: &usize| !matches!(self.uses[*column], Use::Nothing);
        let is_empty = |column: usize| cells.get(column).is_none_or(|cell| cell.is_empty() || is_missing(cell));
        if self.ends_early && (0..self.uses.len()).filter(is_used).all(is_empty) {
            // Without times a number that follows would be of another one.
            if self.time.is_none() {
                self.text
                    .add(At::Line(self.line), || format!("nothing stands in the columns of {}", self.names.join(", ")));
            }
            return Ok(());
        }
        self.row.clear();
        let mut wrong = None;
        for column in 0..self.uses.len() {
            let use_of = self.uses[column];
            let what = || match use_of {
                Use::Acceleration(k) => format!("column {} ({})", column + 1, visible(&self.names[k])),
                _ => format!("column {} (time)", column + 1),
            };
            if let Use::Nothing = use_of {
                continue;
            }
            let number = cells.get(column).and_then(|cell| form.number(cell));
            match (number, cells.get(column).map(|cell| &**cell)) {
                (Some(number), _) if matches!(use_of, Use::Time) && number.float().is_finite() => {
                    self.time = Some(number);
                }
                (Some(number), Some(cell)) => {
                    let size = if let Use::Acceleration(k) = use_of { self.sizes[k] } else { 1.0 };
                    let value = number.float() * size;
                    if (NO_VALUE..1e38).contains(&number.float().abs()) {
                        wrong = Some(format!("{} in {} is what instruments write for no value", visible(cell), what()));
                        break;
                    }
                    if value.abs() > LARGEST {
                        wrong = Some(format!("{} in {} is beyond {LARGEST:e} m/s²", visible(cell), what()));
                        break;
                    }
                    self.row.push(value);
                }
                (_, None) => {
                    wrong = Some(format!("{} has {} of {} columns", visible(text), cells.len(), self.columns));
                    break;
                }
                (_, Some("")) => {
                    wrong = Some(format!("nothing stands in {}", what()));
                    break;
                }
                (_, Some(cell)) if is_missing(cell) => {
                    wrong = Some(format!("{cell} in {} is no finite number", what()));
                    break;
                }
                (_, Some(cell)) => {
                    wrong = Some(format!("'{}' in {} is not a number", visible(cell), what()));
                    break;
                }
            }
        }
        let more = cells.iter().skip(self.columns).filter(|cell| !cell.is_empty()).count();
        if wrong.is_none() && more > 0 && self.columns > 1 {
            wrong = Some(format!(
                "'{}' has {} columns, and the lines above have {}",
                visible(text),
                cells.len(),
                self.columns
            ));
        }
        match wrong {
            None => return self.note_row(),
            Some(what) => self.bad.add(At::Line(self.line), || what),
        }
        Ok(())
    }

    /// Whether a text is a heading by which a column goes on in another unit.
    fn is_other_unit(&self, cell: &str, use_of: Use) -> bool {
        let (kind, size) = match use_of {
            Use::Nothing => return false,
            Use::Time => (Kind::Time, self.time_size),
            Use::Acceleration(k) => (Kind::Acceleration, self.sizes[k]),
        };
        Heading::of(cell).unit.is_some_and(|unit| unit.kind == kind && unit.size.to_bits() != size.to_bits())
    }

    /// Keeps the numbers of a line.
    #[inline]
    fn note_row(&mut self) -> Result<(), Error> {
        if self.text.count > 0 {
            let text = std::mem::take(&mut self.text);
            for (at, what) in &text.first {
                self.bad.add(*at, || what.clone());
            }
            self.bad.count += text.count - text.first.len();
        }
        let sample = self.channels[0].len();
        let at = At::Line(self.line);
        if self.numbering.last().is_none_or(|(first, begin)| begin.after(sample - first) != at) {
            self.numbering.push((sample, at));
        }
        if let Some(time) = self.time {
            let first = *self.first_time.get_or_insert(time);
            let mut since_s = time.above(first) * self.time_size + self.days_s;
            // A clock goes round at midnight.
            if time.digits == CLOCK && self.times.last().is_some_and(|last| since_s < last - 0.5 * DAY_S) {
                self.days_s += DAY_S;
                since_s += DAY_S;
            }
            self.times.push(since_s);
            self.printed.note(time);
        }
        for (channel, value) in self.channels.iter_mut().zip(&self.row) {
            channel.push(*value);
        }
        if (sample + 1) * (self.channels.len() + 1) > self.most_values {
            return Err(Error::Many(self.most_values));
        }
        Ok(())
    }

    /// Time of the first sample in seconds.
    pub(crate) fn start_s(&self) -> f64 {
        self.first_time.map_or(0.0, |time| time.float() * self.time_size)
    }
    /// The size of the unit of time, in seconds.
    pub(crate) fn time_size(&self) -> f64 {
        self.time_size
    }
}

/// What a message shows of a text from outside: its beginning, without what a terminal would act on.
fn visible(text: &str) -> String {
    const SHOWN: usize = 40;
    let plain = |c: char| if c.is_control() { '□' } else { c };
    let shown: String = text.chars().take(SHOWN).map(plain).collect();
    if text.chars().count() > SHOWN { format!("{shown}…") } else { shown }
}
