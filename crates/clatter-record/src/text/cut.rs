//! A file may end inside a number: `1.25E-05` cut to `1.25E-0` is a number as well, and another one.

use super::cells::Form;
use super::encoding::Letters;

/// Bytes of the last lines that a cut one is held against.
const HELD: usize = 1 << 12;
/// As many lines show how all are printed.
const LEAST: usize = 3;

/// How a number is printed.
#[derive(Debug, Clone, Copy)]
struct Print {
    has_point: bool,
    /// Digits after the point.
    decimals: usize,
    /// Digits of the exponent; 0 where there is none.
    exponent: usize,
    /// Digits before the point.
    whole: usize,
}

impl Print {
    fn of(cell: &str, point: u8) -> Self {
        let digits = |text: &str| text.bytes().filter(u8::is_ascii_digit).count();
        let (number, exponent) = cell.split_once(['e', 'E', 'd', 'D']).unwrap_or((cell, ""));
        let (whole, decimals) = number.split_once(char::from(point)).unwrap_or((number, ""));
        let has_point = number.contains(char::from(point));
        Self { has_point, decimals: digits(decimals), exponent: digits(exponent), whole: digits(whole) }
    }
}

/// The last whole lines of a text.
pub(super) fn last_lines(text: &[u8]) -> Option<&[u8]> {
    if text.is_empty() {
        return None;
    }
    let from = text.len().saturating_sub(HELD);
    let begin =
        if from == 0 { 0 } else { text[from..].iter().position(|byte| *byte == b'\n').map_or(0, |at| from + at + 1) };
    Some(&text[begin..])
}

/// Why the last line, which has no end, is none that can be used, if its last number is printed shorter than all above it.
pub(super) fn within(above: &[u8], line: &[u8], form: Form, letters: Letters) -> Option<String> {
    let line = letters.text(line);
    let cells = form.cells(line.trim_end_matches('\r'));
    let last = cells.last().filter(|cell| !cell.is_empty())?;
    form.number(last)?;
    let others: Vec<Print> = above
        .split(|byte| *byte == b'\n')
        .filter_map(|line| {
            let line = letters.text(line);
            let others = form.cells(line.trim_end_matches('\r'));
            let cell = others.get(cells.len() - 1).filter(|cell| form.number(cell).is_some())?;
            Some(Print::of(cell, form.point))
        })
        .collect();
    if others.len() < LEAST {
        return None;
    }
    let own = Print::of(last, form.point);
    let all = |is: &dyn Fn(&Print) -> bool| others.iter().all(is);
    let shorter = all(&|other| other.exponent > own.exponent)
        || all(&|other| other.has_point && !own.has_point)
        || own.exponent == 0 && all(&|other| other.exponent == 0 && other.decimals > own.decimals)
        || !own.has_point && own.exponent == 0 && all(&|other| !other.has_point && other.whole > own.whole);
    shorter.then(|| format!("the file ends within this line, and '{last}' may be a part of a number"))
}
