//! Kinds of numbers in binary and as text, and how they become values.

use crate::Values;

/// How a number lies in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Number {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
    /// A float of so many bytes, bits of the exponent and of the fraction: half, bfloat, and what languages call long double.
    Float(u8, u8, u8),
    /// A whole number of so many bytes, in tens to the power of minus its scale; the bytes of some files are big-endian whatever
    /// else is.
    #[cfg(feature = "parquet")]
    Decimal {
        bytes: u8,
        scale: i32,
        big_endian: bool,
    },
}

/// Of 16 bits.
pub(super) const HALF: Number = Number::Float(2, 5, 10);

/// From here on floats do not hold every integer.
const FLOAT_HOLDS: u64 = 1 << 53;

impl Number {
    /// Of an integer of so many bytes.
    pub(super) fn integer(bytes: u64, signed: bool) -> Option<Self> {
        Some(match (bytes, signed) {
            (1, true) => Self::I8,
            (1, false) => Self::U8,
            (2, true) => Self::I16,
            (2, false) => Self::U16,
            (4, true) => Self::I32,
            (4, false) => Self::U32,
            (8, true) => Self::I64,
            (8, false) => Self::U64,
            _ => return None,
        })
    }
    /// Of a float of so many bytes.
    pub(super) fn float(bytes: u64) -> Option<Self> {
        match bytes {
            2 => Some(HALF),
            4 => Some(Self::F32),
            8 => Some(Self::F64),
            _ => None,
        }
    }
    /// Bytes of one.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
            Self::Float(bytes, ..) => bytes.into(),
            #[cfg(feature = "parquet")]
            Self::Decimal { bytes, .. } => bytes.into(),
        }
    }
    /// All numbers of the bytes; what is left at the end is no number.
    pub(super) fn values(self, bytes: &[u8], big_endian: bool) -> Values {
        self.strided(bytes, big_endian, 0, 1, bytes.len() / self.size())
    }
    /// `length` numbers from number `first` on, every `step`-th.
    pub(super) fn strided(self, bytes: &[u8], big_endian: bool, first: usize, step: usize, length: usize) -> Values {
        self.placed(bytes, big_endian, first * self.size(), step * self.size(), length)
    }
    /// `length` numbers, the first at byte `offset`, `stride` bytes from one to the next; fewer where the bytes end.
    pub(super) fn placed(self, bytes: &[u8], big_endian: bool, offset: usize, stride: usize, length: usize) -> Values {
        let bytes = bytes.get(offset..).unwrap_or_default();
        macro_rules! floats {
            ($number:ty, $convert:expr) => {{
                const SIZE: usize = size_of::<$number>();
                let number = if big_endian { <$number>::from_be_bytes } else { <$number>::from_le_bytes };
                Values::Float(each::<SIZE>(bytes, stride).take(length).map(|array| $convert(number(array))).collect())
            }};
        }
        match self {
            Self::I8 => floats!(i8, f64::from),
            Self::U8 => floats!(u8, f64::from),
            Self::I16 => floats!(i16, f64::from),
            Self::U16 => floats!(u16, f64::from),
            Self::I32 => floats!(i32, f64::from),
            Self::U32 => floats!(u32, f64::from),
            Self::F32 => floats!(f32, f64::from),
            Self::F64 => floats!(f64, f64::from),
            Self::Float(size, exponent, fraction) => {
                let each = bytes.chunks(stride.max(1)).filter_map(|chunk| chunk.get(..size.into())).take(length);
                Values::Float(each.map(|bytes| float(whole(bytes, big_endian)[0], exponent, fraction)).collect())
            }
            #[cfg(feature = "parquet")]
            Self::Decimal { bytes: size, scale, big_endian: always } => {
                let each = bytes.chunks(stride.max(1)).filter_map(|chunk| chunk.get(..size.into())).take(length);
                Values::Float(each.map(|bytes| decimal(bytes, scale, big_endian || always)).collect())
            }
            Self::I64 => {
                let number = if big_endian { i64::from_be_bytes } else { i64::from_le_bytes };
                integers(each(bytes, stride).take(length).map(number).collect())
            }
            Self::U64 => {
                let number = if big_endian { u64::from_be_bytes } else { u64::from_le_bytes };
                let numbers: Vec<u64> = each(bytes, stride).take(length).map(number).collect();
                if numbers.iter().all(|number| i64::try_from(*number).is_ok()) {
                    integers(numbers.into_iter().map(u64::cast_signed).collect())
                } else {
                    #[expect(clippy::cast_precision_loss, reason = "beyond both kinds of values; within half an ulp")]
                    Values::Float(numbers.into_iter().map(|number| number as f64).collect())
                }
            }
        }
    }
}

/// As floats where they hold every one, else as integers.
pub(super) fn integers(numbers: Vec<i64>) -> Values {
    if numbers.iter().all(|number| number.unsigned_abs() <= FLOAT_HOLDS) {
        #[expect(clippy::cast_precision_loss, reason = "exact up to 2^53")]
        Values::Float(numbers.into_iter().map(|number| number as f64).collect())
    } else {
        Values::Integer(numbers)
    }
}

/// `N` bytes at the start of every `stride`.
fn each<const N: usize>(bytes: &[u8], stride: usize) -> impl Iterator<Item = [u8; N]> {
    bytes.chunks(stride.max(1)).filter_map(|chunk| chunk.first_chunk().copied())
}

/// A whole number of up to 32 bytes with a sign, as its lower and its upper half.
fn whole(bytes: &[u8], big_endian: bool) -> [u128; 2] {
    let at = |i: usize| if big_endian { bytes[bytes.len() - 1 - i] } else { bytes[i] };
    let sign = if bytes.is_empty() || at(bytes.len() - 1) < 0x80 { 0 } else { 0xff };
    let half = |first: usize| {
        (first..first + 16).rev().fold(0, |sum, i| sum << 8 | u128::from(if i < bytes.len() { at(i) } else { sign }))
    };
    [half(0), half(16)]
}

/// The value of a float of so many bits of exponent and fraction. That of 64 bits of fraction, as the coprocessors have it, begins with
/// the one that others leave out.
fn float(bits: u128, exponent: u8, fraction: u8) -> f64 {
    let of = |first: u8, count: u8| bits >> first & ((1 << count) - 1);
    let (mantissa, power) = (of(0, fraction), i32::try_from(of(fraction, exponent)).unwrap_or(0));
    let is_told = exponent == 15 && fraction == 64;
    let last = (1 << exponent) - 1;
    let size = if power == last {
        // Beyond all numbers, or none.
        let is_none = mantissa & ((1 << (fraction - u8::from(is_told))) - 1) != 0;
        if is_none { f64::NAN } else { f64::INFINITY }
    } else {
        let one = if is_told || power == 0 { 0 } else { 1 << fraction };
        let unit = last / 2 + i32::from(fraction) - i32::from(is_told);
        #[expect(clippy::cast_precision_loss, reason = "within half an ulp")]
        libm::scalbn((mantissa | one) as f64, power.max(1) - unit)
    };
    if of(fraction + exponent, 1) == 1 { -size } else { size }
}

/// The number that stands for its whole number in tens to the power of minus the scale, to the nearest float.
#[cfg(feature = "parquet")]
pub(super) fn decimal(bytes: &[u8], scale: i32, big_endian: bool) -> f64 {
    let [low, high] = whole(bytes, big_endian).map(u128::cast_signed);
    if high == low >> 127 {
        return format!("{low}e{}", -i64::from(scale)).parse().unwrap_or(f64::NAN);
    }
    #[expect(clippy::cast_precision_loss, reason = "beyond 38 digits; within some ulp")]
    let number = high as f64 * 2_f64.powi(128) + low.cast_unsigned() as f64;
    number * 10_f64.powi(scale.saturating_neg())
}

/// The number that a text is: NaN for one without letters, which is a gap; none where it is no number.
pub(super) fn number(text: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(text).ok()?.trim_matches(|c: char| c == '\0' || c.is_whitespace());
    if text.is_empty() || text.eq_ignore_ascii_case("nan") {
        return Some(f64::NAN);
    }
    text.parse().ok().filter(|_| text.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)))
}

/// The numbers of texts; none where one of them is no number, or all are gaps.
pub(super) fn numbers<T: AsRef<[u8]>>(texts: impl IntoIterator<Item = T>) -> Option<Vec<f64>> {
    let numbers = texts.into_iter().map(|text| number(text.as_ref())).collect::<Option<Vec<f64>>>()?;
    numbers.iter().any(|number| !number.is_nan()).then_some(numbers)
}
