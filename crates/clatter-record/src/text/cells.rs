//! Lines of text as cells, and cells as numbers.

use std::borrow::Cow;

use crate::decimal::Decimal;
use crate::moment;

/// How a file separates its columns and writes its numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Form {
    /// None for blanks.
    pub(super) separator: Option<u8>,
    /// What separates the fraction of a number.
    pub(super) point: u8,
}

/// Cells that stand for no value.
const MISSING: [&str; 6] = ["nan", "na", "n/a", "inf", "-inf", "null"];

impl Form {
    /// The cells of a line, without quotes around them and blanks beside them.
    pub(super) fn cells(self, line: &str) -> Vec<Cow<'_, str>> {
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
        let whole = |text: &str| {
            let (number, length) = Decimal::scan(text.as_bytes(), self.point)?;
            (length == text.len()).then_some(number)
        };
        whole(cell)
            .or_else(|| moment::seconds(cell))
            .or_else(|| whole(&ungrouped(cell)?))
            .or_else(|| whole(&short(cell)?))
    }

    /// Whether a cell can stand in a line of numbers.
    pub(super) fn is_data(self, cell: &str) -> bool {
        cell.is_empty() || is_missing(cell) || self.number(cell).is_some()
    }
}

/// Whether a cell says that there is no value.
pub(super) fn is_missing(cell: &str) -> bool {
    MISSING.iter().any(|word| cell.eq_ignore_ascii_case(word))
}

/// A number whose digits stand in groups of three, as in 29'700 or 29 700, without what is between them.
fn ungrouped(cell: &str) -> Option<String> {
    let between = |c: char| matches!(c, '\'' | '’' | ' ' | '\u{a0}' | '\u{202f}' | '\u{2009}');
    if !cell.contains(between) {
        return None;
    }
    let (sign, digits) = match cell.strip_prefix(['-', '+']) {
        Some(digits) => (&cell[..1], digits),
        None => ("", cell),
    };
    let end = digits.find(|c: char| !c.is_ascii_digit() && !between(c)).unwrap_or(digits.len());
    let (whole, fraction) = digits.split_at(end);
    let groups: Vec<&str> = whole.split(between).collect();
    let full = |group: &str| group.len() == 3;
    let grouped = groups.len() > 1 && (1..=3).contains(&groups[0].len()) && groups[1..].iter().all(|group| full(group));
    grouped.then(|| format!("{sign}{}{fraction}", groups.concat()))
}

/// A number of more digits than are kept, cut to those that floats can tell apart.
fn short(cell: &str) -> Option<String> {
    let number: f64 = cell.parse().ok().filter(|_| cell.len() > 19 && cell.ends_with(|c: char| c.is_ascii_digit()))?;
    number.is_finite().then(|| format!("{number:e}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_and_numbers() {
        let comma = Form { separator: Some(b','), point: b'.' };
        assert_eq!(comma.cells(r#""time, s","a ""x"" [g]", 5 "#), ["time, s", "a \"x\" [g]", "5"]);
        assert_eq!(Form { separator: None, point: b'.' }.cells("  1   2 "), ["1", "2"]);
        let number = |text: &str| comma.number(text).map(Decimal::float);
        for (text, value) in [
            ("29'700", Some(29_700.0)),
            ("-1 234 567.5", Some(-1_234_567.5)),
            ("5 2", None),
            ("1'23", None),
            ("'123", None),
            ("12:00:01", Some(43_201.0)),
            ("0.12345678901234567890123", Some(0.123_456_789_012_345_68)),
            ("1.5e", None),
            ("abc", None),
        ] {
            assert_eq!(number(text), value, "{text}");
        }
    }
}
