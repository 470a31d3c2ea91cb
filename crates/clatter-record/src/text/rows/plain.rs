//! A line of plain numbers, straight from its bytes.

use clatter_shock::samples::LARGEST;

use super::{NO_VALUE, Rows, Use};
use crate::decimal::Decimal;
use crate::text::cells::Form;

impl Rows {
    /// A line of plain numbers, the usual one, straight from its bytes: how many they are, or nothing where it is not so plain.
    #[inline]
    pub(super) fn plain(&mut self, text: &[u8]) -> Option<usize> {
        let Form { separator, point, .. } = self.shape.form;
        let columns = self.shape.columns;
        // Between quotes alone.
        if separator == Some(point) {
            return None;
        }
        let is_blank = |byte: u8| byte == b' ' || byte == b'\t' && separator != Some(b'\t');
        let mut at = 0;
        self.row.clear();
        for (column, use_of) in self.uses.iter().enumerate() {
            while is_blank(text[at]) {
                at += 1;
            }
            if let Use::Nothing | Use::Word(_) | Use::Date = use_of {
                let ends = |byte: u8| separator.map_or(is_blank(byte), |separator| byte == separator);
                let begin = at;
                while !ends(text[at]) {
                    if text[at] == b'\n' || text[at] == b'"' {
                        return None;
                    }
                    at += 1;
                }
                if let Use::Word(word) = use_of
                    && text[begin..at] != *self.shape.words[*word].expected.as_bytes()
                {
                    return None;
                }
            } else {
                let (number, length) = Decimal::scan(&text[at..], point)?;
                at += length;
                if let Use::Acceleration(k) = use_of {
                    if self.open {
                        self.open = !self.digits[*k + 1].note(number, self.channels[*k].len());
                    }
                    let number = number.float();
                    let value = number * self.sizes[*k];
                    if value.abs() > LARGEST || number.abs() >= NO_VALUE || self.shape.header.fill == Some(number) {
                        return None;
                    }
                    self.row.push(value);
                } else if let Use::Fraction = use_of {
                    let size = self.shape.fraction.map_or(1.0, |(_, size)| size);
                    if !(0.0..1.0).contains(&(number.float() * size)) {
                        return None;
                    }
                    self.fraction = Some(number);
                } else if let Use::Count = use_of {
                    self.count = Some(number);
                } else {
                    if self.open {
                        self.open = !self.digits[0].note(number, self.times.len());
                    }
                    self.time = Some(number);
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
                (byte, Some(separator)) if byte == separator && last && column + 1 == columns => {
                    at += 1;
                    return (text[at..].starts_with(b"\n") || text[at..].starts_with(b"\r\n"))
                        .then(|| at + if text[at] == b'\n' { 1 } else { 2 });
                }
                (byte, Some(separator)) if byte == separator => at += 1,
                (_, None) if last && column + 1 == columns => return None,
                (_, None) if at > before => {}
                _ => return None,
            }
        }
        // Whatever else is on the line is of no use.
        let rest = text[at..].iter().position(|byte| *byte == b'\n')?;
        Some(at + rest + 1)
    }
}
