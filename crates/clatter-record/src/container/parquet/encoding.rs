//! How the numbers of a page are encoded: as they are, by a dictionary, by differences, byte by byte.
//!
//! Source: "Parquet encoding definitions", Apache Parquet format 2.11. Bytes that end too early give none.

/// `count` whole numbers of `width` bits: runs of one number, and groups of 8 side by side.
pub(super) fn hybrid(mut bytes: &[u8], width: u32, count: usize) -> Option<Vec<u32>> {
    let mut numbers = Vec::with_capacity(count);
    while numbers.len() < count {
        let head = usize::try_from(whole(&mut bytes)?).ok()?;
        let left = count - numbers.len();
        if head & 1 == 0 {
            let number = bytes.split_off(..width.div_ceil(8) as usize)?;
            let number = number.iter().rev().fold(0, |sum: u32, byte| sum << 8 | u32::from(*byte));
            numbers.resize(numbers.len() + left.min(head >> 1), number);
        } else {
            // The last group may lack what nobody reads.
            let length = (head >> 1).saturating_mul(width as usize);
            let group = bytes.split_off(..length.min(bytes.len()))?;
            for i in 0..left.min((head >> 1).saturating_mul(8)) {
                numbers.push(u32::try_from(bits(group, i * width as usize, width)?).ok()?);
            }
        }
    }
    Some(numbers)
}

/// Numbers that pages give by their place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Dictionary<'a> {
    pub(super) numbers: &'a [u8],
    /// Bytes of a number.
    pub(super) width: usize,
}

impl Dictionary<'_> {
    /// The plain bytes of `count` numbers.
    pub(super) fn look_up(self, bytes: &[u8], count: usize) -> Option<Vec<u8>> {
        // A page of rows without a number may be empty.
        if count == 0 {
            return Some(Vec::new());
        }
        let (width, places) = bytes.split_first()?;
        let width = Some(u32::from(*width)).filter(|width| *width <= 32)?;
        let mut plain = Vec::with_capacity(count * self.width);
        for place in hybrid(places, width, count)? {
            let start = (place as usize).checked_mul(self.width)?;
            plain.extend_from_slice(self.numbers.get(start..start.checked_add(self.width)?)?);
        }
        Some(plain)
    }
}

/// First bytes of all numbers, then second ones, and so on.
pub(super) fn split_streams(bytes: &[u8], width: usize, count: usize) -> Option<Vec<u8>> {
    let bytes = bytes.get(..count * width)?;
    Some((0..count * width).map(|i| bytes[i % width * count + i / width]).collect())
}

/// Flags, eight a byte, the first in the last bit; each a byte of its own.
pub(super) fn plain_bits(bytes: &[u8], count: usize) -> Option<Vec<u8>> {
    let bytes = bytes.get(..count.div_ceil(8))?;
    Some((0..count).map(|i| bytes[i / 8] >> (i % 8) & 1).collect())
}

/// Bytes of any length, each with its length before it, to the end; none where it is cut short.
pub(super) fn plain_texts(mut bytes: &[u8]) -> impl Iterator<Item = Option<&[u8]>> {
    std::iter::from_fn(move || {
        (!bytes.is_empty()).then(|| {
            let length = bytes.split_off(..4).and_then(<[u8]>::first_chunk);
            length.and_then(|length| bytes.split_off(..u32::from_le_bytes(*length) as usize))
        })
    })
}

/// Differences, in blocks of so many bits each; and the bytes behind them.
pub(super) fn delta(mut bytes: &[u8], count: usize) -> Option<(Vec<i64>, &[u8])> {
    let block = usize::try_from(whole(&mut bytes)?).ok()?;
    let parts = usize::try_from(whole(&mut bytes)?).ok()?;
    let told = usize::try_from(whole(&mut bytes)?).ok()?;
    let first = signed(&mut bytes)?;
    let in_part = block.checked_div(parts)?;
    if told < count || in_part == 0 || !in_part.is_multiple_of(8) {
        return None;
    }
    let mut numbers = Vec::with_capacity(count);
    numbers.extend((count > 0).then_some(first));
    let mut last = first;
    while numbers.len() < count {
        let least = signed(&mut bytes)?;
        let widths = bytes.split_off(..parts)?;
        for width in widths {
            // Parts behind the last number are not there.
            if numbers.len() == count {
                break;
            }
            let width = Some(u32::from(*width)).filter(|width| *width <= 64)?;
            let part = bytes.split_off(..(in_part / 8).checked_mul(width as usize)?.min(bytes.len()))?;
            for i in 0..in_part.min(count - numbers.len()) {
                let more = bits(part, i * width as usize, width)?;
                last = last.wrapping_add(least).wrapping_add(more.cast_signed());
                numbers.push(last);
            }
        }
    }
    Some((numbers, bytes))
}

/// A whole number of 7 bits a byte.
fn whole(bytes: &mut &[u8]) -> Option<u64> {
    let mut number = 0;
    for i in 0..10 {
        let byte = bytes.split_off_first()?;
        number |= u64::from(byte & 0x7f) << (7 * i);
        if *byte < 0x80 {
            return Some(number);
        }
    }
    None
}

/// The same with a sign in the last bit.
fn signed(bytes: &mut &[u8]) -> Option<i64> {
    let number = whole(bytes)?;
    Some((number >> 1).cast_signed() ^ -(number & 1).cast_signed())
}

/// `width` bits, at most 64, from bit `at` on; the least of a byte is its first.
fn bits(bytes: &[u8], at: usize, width: u32) -> Option<u64> {
    if width == 0 {
        return Some(0);
    }
    let (first, shift) = (at / 8, at % 8);
    let end = (at + width as usize).div_ceil(8);
    let found = bytes.get(first..end)?;
    let number = found.iter().rev().fold(0, |sum: u128, byte| sum << 8 | u128::from(*byte)) >> shift;
    u64::try_from(number & ((1 << width) - 1)).ok()
}
