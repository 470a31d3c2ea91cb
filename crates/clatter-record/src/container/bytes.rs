//! Bytes of a file in turn, never beyond their end.

use super::refuse;
use crate::Error;

/// A place in the bytes of a file, or of a part of it.
#[derive(Debug, Clone)]
pub(super) struct Bytes<'a> {
    all: &'a [u8],
    at: usize,
    pub(super) big_endian: bool,
    /// The name of the part in messages.
    part: &'static str,
}

macro_rules! number {
    ($name:ident) => {
        pub(super) fn $name(&mut self) -> Result<$name, Error> {
            let array = self.array()?;
            Ok(if self.big_endian { $name::from_be_bytes(array) } else { $name::from_le_bytes(array) })
        }
    };
}

impl<'a> Bytes<'a> {
    pub(super) fn new(bytes: &'a [u8], part: &'static str) -> Self {
        Self { all: bytes, at: 0, big_endian: false, part }
    }
    /// Bytes of a part, in the same order.
    pub(super) fn part<'b>(&self, bytes: &'b [u8], part: &'static str) -> Bytes<'b> {
        Bytes { big_endian: self.big_endian, ..Bytes::new(bytes, part) }
    }
    pub(super) fn at(&self) -> usize {
        self.at
    }
    pub(super) fn left(&self) -> usize {
        self.all.len() - self.at
    }
    pub(super) fn take(&mut self, count: usize) -> Result<&'a [u8], Error> {
        let taken = self.at.checked_add(count).and_then(|end| self.all.get(self.at..end)).ok_or_else(|| {
            refuse(format!(
                "{}: byte {} should be followed by {count} more, but only {} are left; the file is cut short or damaged",
                self.part,
                self.at,
                self.left()
            ))
        })?;
        self.at += count;
        Ok(taken)
    }
    /// The same for a length that the file tells in 32 or 64 bits.
    pub(super) fn take_u64(&mut self, count: u64) -> Result<&'a [u8], Error> {
        // A count beyond the address space is beyond the file.
        self.take(usize::try_from(count).unwrap_or(usize::MAX))
    }
    /// All that is left.
    pub(super) fn rest(&mut self) -> &'a [u8] {
        let rest = &self.all[self.at..];
        self.at = self.all.len();
        rest
    }
    fn array<const N: usize>(&mut self) -> Result<[u8; N], Error> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N)?);
        Ok(array)
    }
    number!(u8);
    number!(u16);
    number!(u32);
    number!(u64);
    number!(i64);
}
