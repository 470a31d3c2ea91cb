//! Kinds of numbers in binary, and how they become values.

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
}

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
