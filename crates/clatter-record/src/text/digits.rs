//! Digits may stand in groups: `1.391` may be 1391, beside `704`.

use crate::decimal::Decimal;

/// Points that are kept as long as they may stand between groups.
const MOST: usize = 100_000;
/// Numbers with as many groups make sure that all are meant so.
const SURE: usize = 3;

/// How the numbers of one column are written.
#[derive(Debug, Clone, Default)]
#[expect(clippy::struct_excessive_bools, reason = "what was seen so far, each by itself")]
pub(super) struct Digits {
    /// There is a fraction that is no group of three.
    has_point: bool,
    /// There are whole numbers below 1000 without a point, and others without groups.
    has_whole: bool,
    has_long: bool,
    /// Samples with three digits behind a point and up to three before it.
    threes: Vec<usize>,
    /// Numbers with groups by the mark that is no point.
    grouped: usize,
    /// The last group of one of them ends in 0, as no fraction that is cut to its digits does.
    ends_in_zero: bool,
}

impl Digits {
    /// A number, of the sample that is next; whether it has a fraction that is no group of three.
    pub(super) fn note(&mut self, number: Decimal, sample: usize) -> bool {
        if number.exponent >= 0 {
            self.has_whole |= number.mantissa < 1000;
            self.has_long |= number.mantissa >= 1000;
        } else if number.exponent == -3 && (1000..1_000_000).contains(&number.mantissa) && self.threes.len() < MOST {
            self.ends_in_zero |= number.mantissa.is_multiple_of(10);
            self.threes.push(sample);
        } else {
            self.has_point = true;
        }
        self.has_point
    }

    /// A number with groups by the mark that is no point.
    pub(super) fn note_grouped(&mut self, cell: &str) {
        // By blanks and apostrophes there is nothing to mistake.
        if cell.contains([',', '.']) {
            self.grouped += 1;
            self.ends_in_zero |= cell.ends_with('0');
        }
    }

    pub(super) fn has_point(&self) -> bool {
        self.has_point
    }

    /// Sets right the values of a channel whose points stand between groups, or says what is not clear. `has_point` is whether there
    /// is a fraction in any column; the size is that of the unit.
    pub(super) fn close(&self, has_point: bool, values: Option<(&mut Vec<f64>, f64)>) -> Result<(), String> {
        if self.grouped > 0 && self.has_long {
            return Err("some numbers above 999 have their digits in groups, and others have not".to_owned());
        }
        let open = if has_point { 0 } else { self.grouped } + self.threes.len();
        if open == 0 || has_point && self.grouped > 0 || self.grouped == 0 && (has_point || !self.has_whole) {
            return Ok(());
        }
        let sure = self.has_whole
            && !self.has_long
            && self.ends_in_zero
            && open >= SURE
            && (self.grouped == 0) != self.threes.is_empty();
        if !sure {
            return Err("a mark with three digits behind it, beside whole numbers, may be a decimal mark or one between thousands: write \
                 numbers without groups"
                .to_owned());
        }
        if let Some((values, size)) = values {
            for sample in &self.threes {
                values[*sample] = (values[*sample] / size * 1000.0).round() * size;
            }
            return Ok(());
        }
        if self.threes.is_empty() {
            Ok(())
        } else {
            Err("times have their digits in groups: write them without".to_owned())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_are_told_from_fractions() {
        let of = |cells: &[&str], has_point: bool| {
            let (mut digits, mut values) = (Digits::default(), Vec::new());
            for cell in cells {
                let (number, _) = Decimal::scan(cell.as_bytes(), b'.').expect("a number");
                digits.note(number, values.len());
                values.push(number.float());
            }
            digits.close(has_point || digits.has_point(), Some((&mut values, 1.0))).map(|()| values)
        };
        assert_eq!(of(&["0", "704", "1.391", "2.222", "4.500"], false), Ok(vec![0.0, 704.0, 1391.0, 2222.0, 4500.0]));
        assert!(of(&["0", "704", "1.391", "2.222", "4.501"], false).is_err(), "none ends in 0");
        assert!(of(&["0", "704", "1.390"], false).is_err(), "one alone");
        assert_eq!(of(&["1.391", "2.222", "4.500"], false), Ok(vec![1.391, 2.222, 4.5]), "fractions");
        assert_eq!(of(&["0", "1.391", "0.5"], false), Ok(vec![0.0, 1.391, 0.5]), "a fraction that is no group");
        assert_eq!(of(&["0", "1.391", "4.500"], true), Ok(vec![0.0, 1.391, 4.5]), "times with points");
        assert!(of(&["0", "1234", "1.391", "2.222", "4.500"], false).is_err(), "both ways");
    }
}
