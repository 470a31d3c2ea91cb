//! Lines of text as cells, and cells as numbers.

use std::borrow::Cow;

use crate::decimal::Decimal;
use crate::moment::{self, Order};
use crate::unit::Unit;

/// How a file separates its columns and writes its numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Form {
    /// None for blanks.
    pub(super) separator: Option<u8>,
    /// The mark that separates the fraction of a number.
    pub(super) point: u8,
    /// The order of day and month in dates that may be read in both.
    pub(super) order: Option<Order>,
    /// Tells whether an arrow stands behind the first cell, as monitors of serial ports set it.
    pub(super) arrow: bool,
}

/// Cells that stand for no value.
const MISSING: &str = "- -- nan na n/a #n/a #nv null none nil -nan -nan(ind)";
/// Cells that stand for a value beyond the range of an instrument.
const BEYOND: &str = "inf -inf +inf infinity -infinity ∞ -∞ ol -ol over overload overflow overrange";
/// The arrow between time and numbers.
pub(super) const ARROW: &str = " -> ";

impl Default for Form {
    fn default() -> Self {
        Self::new(None, b'.')
    }
}

impl Form {
    pub(super) const fn new(separator: Option<u8>, point: u8) -> Self {
        Self { separator, point, order: None, arrow: false }
    }

    /// The cells of a line, without quotes around them and blanks beside them.
    pub(super) fn cells(self, line: &str) -> Vec<Cow<'_, str>> {
        if self.arrow
            && let Some((time, rest)) = line.split_once(ARROW)
        {
            let mut cells = vec![Cow::Borrowed(time.trim())];
            cells.extend(Self { arrow: false, ..self }.cells(rest));
            return cells;
        }
        let Some(separator) = self.separator.map(char::from) else {
            return line.split_whitespace().map(|cell| Cow::Borrowed(cell.trim_matches('"'))).collect();
        };
        if !line.contains('"') {
            return line.split(separator).map(|cell| Cow::Borrowed(cell.trim())).collect();
        }
        // RFC 4180: separators between quotes are text, two quotes stand for one.
        let (mut cells, mut cell, mut quoted) = (Vec::new(), String::new(), false);
        let mut rest = line.chars().peekable();
        while let Some(c) = rest.next() {
            match c {
                '"' if quoted && rest.peek() == Some(&'"') => cell.extend(rest.next()),
                '"' => quoted = !quoted,
                c if c == separator && !quoted => cells.push(Cow::Owned(std::mem::take(&mut cell).trim().to_owned())),
                c => cell.push(c),
            }
        }
        cells.push(Cow::Owned(cell.trim().to_owned()));
        cells
    }

    /// The number of a whole cell: with digits in groups of three as well, or a time of day.
    pub(super) fn number(self, cell: &str) -> Option<Decimal> {
        self.whole(cell)
            .or_else(|| moment::seconds(cell, self.order))
            .or_else(|| self.whole(&self.ungrouped(cell)?))
            .or_else(|| self.whole(&short(cell, self.point)?))
            .or_else(|| self.whole(&powered(cell)?))
            .or_else(|| {
                // A sign apart from its digits.
                let (sign, digits) = cell.split_at_checked(1)?;
                let digits = digits.strip_prefix(' ').filter(|_| matches!(sign, "-" | "+"))?.trim_start();
                digits.starts_with(|c: char| c.is_ascii_digit()).then(|| self.number(&format!("{sign}{digits}")))?
            })
            .or_else(|| {
                // A minus sign as it is set in print.
                let signs = ['−', '–'];
                cell.contains(signs).then(|| self.number(&cell.replace(signs, "-")))?
            })
    }

    /// The number of a cell of nothing but digits, sign, point and power.
    fn whole(self, text: &str) -> Option<Decimal> {
        let (number, length) = Decimal::scan(text.as_bytes(), self.point)?;
        (length == text.len()).then_some(number)
    }

    /// The number of a cell that its unit stands behind, and the unit.
    pub(super) fn measured(self, cell: &str) -> Option<(Decimal, &str)> {
        let (_, length) = Decimal::scan(cell.as_bytes(), self.point)?;
        let end =
            cell[length..].find(|c: char| c.is_alphabetic() || matches!(c, 'µ' | '°' | '%')).map(|at| length + at)?;
        // A time of day has no unit behind it.
        let number = self.number(cell[..end].trim_end()).filter(|_| !cell[..end].contains(':'))?;
        Unit::of(&cell[end..]).map(|_| (number, &cell[end..]))
    }

    /// Returns whether a cell can stand in a line of numbers.
    pub(super) fn is_data(self, cell: &str) -> bool {
        cell.is_empty() || is_missing(cell) || is_beyond(cell) || self.number(cell).is_some()
    }

    /// A number whose digits stand in groups of three, as in 29'700, 29 700 or, with a decimal point, 29,700, without what is
    /// between them.
    fn ungrouped(self, cell: &str) -> Option<String> {
        let other = if self.point == b'.' { ',' } else { '.' };
        let between = |c: char| c == other || matches!(c, '\'' | '’' | ' ' | '\u{a0}' | '\u{202f}' | '\u{2009}');
        if !cell.contains(between) {
            return None;
        }
        let (sign, digits) = match cell.strip_prefix(['-', '+', '−', '–']) {
            Some(digits) => (if cell.starts_with('+') { "" } else { &cell[..cell.len() - digits.len()] }, digits),
            None => ("", cell),
        };
        let end = digits.find(|c: char| !c.is_ascii_digit() && !between(c)).unwrap_or(digits.len());
        let (whole, fraction) = digits.split_at(end);
        let mark = whole.find(between)?;
        let mark = whole[mark..].chars().next()?;
        let groups: Vec<&str> = whole.split(mark).collect();
        let full = |group: &&str| group.len() == 3 && group.bytes().all(|c| c.is_ascii_digit());
        // No number begins with a group of nothing.
        let first = groups[0];
        let begins =
            (1..=3).contains(&first.len()) && !first.starts_with('0') && first.bytes().all(|c| c.is_ascii_digit());
        (groups.len() > 1 && begins && groups[1..].iter().all(full))
            .then(|| format!("{sign}{}{fraction}", groups.concat()))
    }

    /// Returns whether a cell is a number by its groups of digits alone.
    pub(super) fn is_grouped(self, cell: &str) -> bool {
        self.whole(cell).is_none() && self.ungrouped(cell).is_some()
    }
}

/// Returns whether a cell is one of some words, by bytes, as cells are many.
fn is_among(words: &str, cell: &str) -> bool {
    words.as_bytes().split(|byte| *byte == b' ').any(|word| cell.as_bytes().eq_ignore_ascii_case(word))
}

/// Returns whether a cell says that there is no value.
pub(super) fn is_missing(cell: &str) -> bool {
    is_among(MISSING, cell)
}

/// Returns whether a cell says that the value is beyond what the instrument can tell.
pub(super) fn is_beyond(cell: &str) -> bool {
    is_among(BEYOND, cell)
}

/// A number with its power as Fortran writes one of three digits, without the letter: `1.2345-110`.
fn powered(cell: &str) -> Option<String> {
    let (digits, power) = cell.split_at_checked(cell.len().checked_sub(4)?)?;
    let is_power = power.starts_with(['-', '+']) && power[1..].bytes().all(|c| c.is_ascii_digit());
    (is_power && digits.contains(['.', ',']) && digits.ends_with(|c: char| c.is_ascii_digit()))
        .then(|| format!("{digits}e{power}"))
}

/// A number of more digits than are kept, cut to those that floats can tell apart.
fn short(cell: &str, point: u8) -> Option<String> {
    if cell.len() <= 19 || !cell.ends_with(|c: char| c.is_ascii_digit()) {
        return None;
    }
    let text = if point == b',' { Cow::Owned(cell.replace(',', ".")) } else { Cow::Borrowed(cell) };
    let number: f64 = text.parse().ok().filter(|number: &f64| number.is_finite())?;
    Some(format!("{number:e}").replace('.', &char::from(point).to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_and_numbers() {
        let comma = Form::new(Some(b','), b'.');
        assert_eq!(comma.cells(r#""time, s","a ""x"" [g]", 5 "#), ["time, s", "a \"x\" [g]", "5"]);
        assert_eq!(Form::new(None, b'.').cells("  1   2 "), ["1", "2"]);
        assert_eq!(Form { arrow: true, ..comma }.cells("a->b -> 1,2"), ["a->b", "1", "2"]);
        let number = |text: &str| comma.number(text).map(Decimal::float);
        for (text, value) in [
            ("29'700", Some(29_700.0)),
            ("-1 234 567.5", Some(-1_234_567.5)),
            ("5 2", None),
            ("1 2345", None),
            ("12 3456", None),
            ("1'2'345", None),
            ("1 234'567", None),
            ("0,123", None),
            ("012 345", None),
            ("1,391.5", Some(1391.5)),
            ("−1.5", Some(-1.5)),
            ("–1,391", Some(-1391.0)),
            ("1.5e−3", Some(1.5e-3)),
            ("1'23", None),
            ("'123", None),
            ("12:00:01", Some(43_201.0)),
            ("0.12345678901234567890123", Some(0.123_456_789_012_345_68)),
            ("1.2345-110", Some(1.2345e-110)),
            ("-1.2345+101", Some(-1.2345e101)),
            ("12345-110", None),
            ("+ 0.5", Some(0.5)),
            ("-  1.5", Some(-1.5)),
            ("- x", None),
            ("1.5e", None),
            ("abc", None),
        ] {
            assert_eq!(number(text), value, "{text}");
        }
    }
}
