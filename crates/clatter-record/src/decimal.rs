//! Numbers as files print them: decimal digits, kept exact until a float is asked for.

/// A printed number: ± mantissa · 10^exponent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Decimal {
    pub(crate) negative: bool,
    pub(crate) mantissa: u64,
    pub(crate) exponent: i32,
    /// Significant digits that were printed.
    pub(crate) digits: i32,
}

/// Digits that a mantissa holds.
const MOST_DIGITS: i32 = 19;
/// Powers of ten that are floats without rounding.
const EXACT: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20,
    1e21, 1e22,
];
/// Whole numbers up to it are floats without rounding.
const WHOLE: u64 = 1 << 53;
/// Exponents beyond are none of a measured number.
const FARTHEST: i32 = 400;

impl Decimal {
    /// The number that a text begins with, and how many bytes it takes. `point` separates the fraction; an exponent begins with
    /// e, or with d as Fortran has it. A number of more than 19 digits is none.
    #[inline]
    pub(crate) fn scan(text: &[u8], point: u8) -> Option<(Self, usize)> {
        let mut at = 0;
        let negative = match text.first()? {
            b'-' => {
                at = 1;
                true
            }
            b'+' => {
                at = 1;
                false
            }
            _ => false,
        };
        let (mut mantissa, mut digits, mut seen) = (0_u64, 0, 0);
        let mut take = |at: &mut usize| {
            let begin = *at;
            while let Some(digit) = text.get(*at).map(|c| c.wrapping_sub(b'0')).filter(|digit| *digit < 10) {
                mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(digit));
                digits += i32::from(digits > 0 || digit > 0);
                *at += 1;
            }
            seen += *at - begin;
            *at - begin
        };
        take(&mut at);
        let mut exponent = 0;
        if text.get(at) == Some(&point) {
            at += 1;
            exponent = -i32::try_from(take(&mut at)).ok()?;
        }
        if seen == 0 || digits > MOST_DIGITS {
            return None;
        }
        if let Some(b'e' | b'E' | b'd' | b'D') = text.get(at)
            && let Some((power, length)) = power(&text[at + 1..])
        {
            exponent = exponent.saturating_add(power);
            at += 1 + length;
        }
        Some((Self { negative, mantissa, exponent, digits }, at))
    }

    /// The float nearest to it.
    #[inline]
    pub(crate) fn float(self) -> f64 {
        let size = if self.mantissa == 0 {
            0.0
        } else if self.mantissa <= WHOLE && self.exponent.unsigned_abs() < 23 {
            // One rounding of two exact numbers.
            #[expect(clippy::cast_precision_loss, reason = "at most 2^53")]
            let mantissa = self.mantissa as f64;
            let power = EXACT[self.exponent.unsigned_abs() as usize];
            if self.exponent < 0 { mantissa / power } else { mantissa * power }
        } else {
            let exponent = self.exponent.clamp(-FARTHEST, FARTHEST);
            format!("{}e{exponent}", self.mantissa).parse().unwrap_or(f64::NAN)
        };
        if self.negative { -size } else { size }
    }

    /// Returns what it is above another one: exact before its one rounding, where both have their digits close together.
    #[inline]
    pub(crate) fn above(self, other: Self) -> f64 {
        let exponent = self.exponent.min(other.exponent);
        let (Some(a), Some(b)) = (self.scaled(exponent), other.scaled(exponent)) else {
            return self.float() - other.float();
        };
        let difference = a - b;
        match u64::try_from(difference.unsigned_abs()) {
            Ok(mantissa) => Self { negative: difference < 0, mantissa, exponent, digits: 0 }.float(),
            Err(_) => self.float() - other.float(),
        }
    }

    /// The whole number that it is in units of 10^exponent, which is not above its own.
    fn scaled(self, exponent: i32) -> Option<i128> {
        let power = self.exponent.checked_sub(exponent)?;
        // 10¹⁹ · 10¹⁸ is below 2¹²⁷.
        let size = (power <= 18).then(|| i128::from(self.mantissa) * 10_i128.pow(power.unsigned_abs()))?;
        Some(if self.negative { -size } else { size })
    }
}

/// A signed whole number, and how many bytes it takes.
fn power(text: &[u8]) -> Option<(i32, usize)> {
    let (sign, mut at) = match text.first()? {
        b'-' => (-1, 1),
        b'+' => (1, 1),
        _ => (1, 0),
    };
    let (begin, mut value) = (at, 0_i32);
    while let Some(digit) = text.get(at).map(|c| c.wrapping_sub(b'0')).filter(|digit| *digit < 10) {
        value = value.saturating_mul(10).saturating_add(i32::from(digit)).min(FARTHEST);
        at += 1;
    }
    (at > begin).then_some((sign * value, at))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Option<(f64, usize)> {
        Decimal::scan(text.as_bytes(), b'.').map(|(number, length)| (number.float(), length))
    }

    #[test]
    fn numbers_are_the_nearest_floats() {
        for text in
            ["0", "-0.0", "1", "0.1", "3.14159", "1e-3", "123456789.123456789", "9007199254740993", "1e22", "1.5E+05"]
        {
            let (number, length) = read(text).expect(text);
            assert_eq!((number.to_bits(), length), (text.parse::<f64>().expect(text).to_bits(), text.len()), "{text}");
        }
        // Random bits, printed shortest, come back the same: also where digits and powers are many.
        let mut state = 1_u64;
        for _ in 0..20_000 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let number = f64::from_bits(state);
            if number.is_finite() {
                let text = format!("{number:e}");
                assert_eq!(read(&text).expect(&text).0.to_bits(), number.to_bits(), "{text}");
            }
        }
    }

    #[test]
    fn other_notations() {
        assert_eq!(read("1.5D+02,"), Some((150.0, 7)));
        assert_eq!(read("5."), Some((5.0, 2)));
        assert_eq!(read(".5"), Some((0.5, 2)));
        // An e that no power follows ends the number.
        assert_eq!(read("5e"), Some((5.0, 1)));
        assert_eq!(read("1e999999999"), Some((f64::INFINITY, 11)));
        assert_eq!(read("1e-999999999"), Some((0.0, 12)));
        assert_eq!(Decimal::scan(b"0,25;", b',').map(|(number, length)| (number.float(), length)), Some((0.25, 4)));
        for none in ["", "-", ".", "e5", "abc", "12345678901234567890"] {
            assert_eq!(read(none), None, "{none}");
        }
        assert_eq!(Decimal::scan(b"00.00120", b'.').expect("a number").0.digits, 3, "the last zero was printed");
    }

    /// Epochs in nanoseconds are beyond the floats; their differences are not.
    #[test]
    fn differences_are_exact() {
        let scan = |text: &str| Decimal::scan(text.as_bytes(), b'.').expect("a number").0;
        for (a, b, difference) in [
            ("1700000000000100000", "1700000000000000000", 1e5),
            ("1700000000000.3", "1700000000000", 0.3),
            ("0.3", "0.1", 0.2),
            ("-1.5", "1e3", -1001.5),
            ("1e30", "1", 1e30),
        ] {
            assert_eq!(scan(a).above(scan(b)).to_bits(), f64::to_bits(difference), "{a} - {b}");
        }
    }
}
