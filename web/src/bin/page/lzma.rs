//! This module packs bytes as LZMA does: what follows is told from what came before, bit by bit, each by the chance that it had so far.
//! `page/engine.js` unpacks them.
//!
//! The stream is that of LZMA with lc = 3, lp = 0 and pb = 0, without its header and its first byte, which is 0: four bytes of the size,
//! the highest first, are before it.

// Where the chances of each kind of bit begin; `page/engine.js` has the same places.
const MATCH: usize = 0;
const AGAIN: usize = 12;
const OLDER: [usize; 3] = [24, 36, 48];
const LONGER: usize = 60;
const SLOT: usize = 72;
const NEAR: usize = 328;
const ALIGN: usize = 456;
const LENGTH: usize = 472;
const LENGTH_AGAIN: usize = 746;
const LITERAL: usize = 1020;
const CHANCES: usize = LITERAL + 8 * 0x300;

/// The longest copy.
const LONGEST: usize = 273;
/// Bytes for which the cheapest steps are found at once, by the chances before them.
const BLOCK: usize = 1 << 12;
/// Places that are looked at for a copy.
const DEPTH: usize = 200;
/// One bit, as prices have it: the eleventh power of 2048ths is a whole number of 121 bits.
const ONE_BIT: u32 = 11;

/// One step: a byte, or a copy of what is so far back. The distances of the last four copies are cheaper to tell.
#[derive(Debug, Clone, Copy)]
enum Step {
    Literal,
    /// The one byte at the last distance.
    Short,
    Again {
        which: usize,
        length: usize,
    },
    Copy {
        distance: usize,
        length: usize,
    },
}

impl Step {
    fn length(self) -> usize {
        match self {
            Self::Literal | Self::Short => 1,
            Self::Again { length, .. } | Self::Copy { length, .. } => length,
        }
    }
}

/// What the steps before tell of the next: their kinds, and the last four distances, less one.
#[derive(Debug, Clone, Copy, Default)]
struct Past {
    state: usize,
    distances: [usize; 4],
}

impl Past {
    fn after(mut self, step: Step) -> Self {
        let is_early = self.state < 7;
        match step {
            Step::Literal => {
                self.state = match self.state {
                    0..4 => 0,
                    4..10 => self.state - 3,
                    _ => self.state - 6,
                };
            }
            Step::Short => self.state = if is_early { 9 } else { 11 },
            Step::Again { which, .. } => {
                self.distances[..=which].rotate_right(1);
                self.state = if is_early { 8 } else { 11 };
            }
            Step::Copy { distance, .. } => {
                self.distances.rotate_right(1);
                self.distances[0] = distance;
                self.state = if is_early { 7 } else { 10 };
            }
        }
        self
    }
}

/// What is done with each bit of a step: with the place of its chance, if it has one, else it is as often 0 as 1.
type Each<'a> = dyn FnMut(Option<usize>, bool) + 'a;

/// Tells the bits of a step, from which it is written and priced.
fn told(bytes: &[u8], at: usize, past: &Past, step: Step, each: &mut Each<'_>) {
    let Past { state, distances } = *past;
    let is_copy = !matches!(step, Step::Literal);
    each(Some(MATCH + state), is_copy);
    if is_copy {
        each(Some(AGAIN + state), !matches!(step, Step::Copy { .. }));
    }
    match step {
        Step::Literal => {
            let before = at.checked_sub(1).map_or(0, |before| usize::from(bytes[before]));
            let base = LITERAL + 0x300 * (before >> 5);
            // After a copy, what would have come next in it tells what does not come.
            let mut beside = (state >= 7).then(|| bytes[at - distances[0] - 1]);
            let mut symbol = 1;
            for k in (0..8).rev() {
                let bit = bytes[at] >> k & 1 == 1;
                let other = beside.map(|beside| beside >> k & 1 == 1);
                each(Some(base + other.map_or(0, |other| (1 + usize::from(other)) << 8) + symbol), bit);
                beside = beside.filter(|_| other == Some(bit));
                symbol = 2 * symbol + usize::from(bit);
            }
        }
        Step::Short => {
            each(Some(OLDER[0] + state), false);
            each(Some(LONGER + state), false);
        }
        Step::Again { which, length } => {
            for (k, older) in OLDER.iter().enumerate().take(which + 1) {
                each(Some(older + state), k < which);
            }
            if which == 0 {
                each(Some(LONGER + state), true);
            }
            length_told(LENGTH_AGAIN, length, each);
        }
        Step::Copy { distance, length } => {
            length_told(LENGTH, length, each);
            distance_told(distance, length, each);
        }
    }
}

fn length_told(base: usize, length: usize, each: &mut Each<'_>) {
    let n = length - 2;
    each(Some(base), n >= 8);
    if n >= 8 {
        each(Some(base + 1), n >= 16);
    }
    match n {
        0..8 => tree(base + 2, 3, n, each),
        8..16 => tree(base + 10, 3, n - 8, each),
        _ => tree(base + 18, 8, n - 16, each),
    }
}

fn distance_told(distance: usize, length: usize, each: &mut Each<'_>) {
    let top = distance.checked_ilog2().map_or(0, |top| top as usize);
    let slot = if distance < 4 { distance } else { 2 * top + (distance >> (top - 1) & 1) };
    tree(SLOT + 64 * (length - 2).min(3), 6, slot, each);
    if slot < 4 {
        return;
    }
    let base = (2 | slot & 1) << (top - 1);
    let rest = distance - base;
    if slot < 14 {
        return reversed(NEAR + base - slot, top - 1, rest, each);
    }
    for k in (4..top - 1).rev() {
        each(None, rest >> k & 1 == 1);
    }
    reversed(ALIGN, 4, rest, each);
}

/// A number of so many bits, the highest first.
fn tree(base: usize, count: usize, value: usize, each: &mut Each<'_>) {
    let mut m = 1;
    for k in (0..count).rev() {
        let bit = value >> k & 1;
        each(Some(base + m), bit == 1);
        m = 2 * m + bit;
    }
}

/// The same, the lowest first.
fn reversed(base: usize, count: usize, value: usize, each: &mut Each<'_>) {
    let mut m = 1;
    for k in 0..count {
        let bit = value >> k & 1;
        each(Some(base + m), bit == 1);
        m = 2 * m + bit;
    }
}

/// The chances so far, and the range coder that writes bits by them.
struct Packer {
    /// In 2048ths, that a bit is 0.
    chances: Vec<u16>,
    low: u64,
    range: u32,
    /// The last byte, which a carry may still change, and how many 0xff come after it.
    held: Option<u8>,
    full: usize,
    out: Vec<u8>,
}

impl Packer {
    fn bit(&mut self, place: Option<usize>, bit: bool) {
        let bound = match place {
            Some(place) => {
                let chance = &mut self.chances[place];
                let bound = (self.range >> 11) * u32::from(*chance);
                *chance = if bit { *chance - (*chance >> 5) } else { *chance + ((2048 - *chance) >> 5) };
                bound
            }
            None => self.range >> 1,
        };
        if bit {
            self.low += u64::from(bound);
            // Without a chance both halves are as large.
            self.range = if place.is_some() { self.range - bound } else { bound };
        } else {
            self.range = bound;
        }
        while self.range < 1 << 24 {
            self.range <<= 8;
            self.shift();
        }
    }

    fn shift(&mut self) {
        let [_, _, _, carry, top, ..] = self.low.to_be_bytes();
        if carry == 0 && top == 0xff {
            self.full += 1;
        } else {
            self.out.extend(self.held.map(|held| held.wrapping_add(carry)));
            self.out.extend(std::iter::repeat_n(0xffu8.wrapping_add(carry), std::mem::take(&mut self.full)));
            self.held = Some(top);
        }
        self.low = (self.low & 0x00ff_ffff) << 8;
    }
}

/// The prices of bits by the chances before a block.
struct Prices<'a> {
    chances: &'a [u16],
    /// Of a bit by its chance.
    bits: &'a [u32],
    lengths: [Vec<u32>; 2],
}

impl<'a> Prices<'a> {
    fn new(chances: &'a [u16], bits: &'a [u32]) -> Self {
        let mut prices = Self { chances, bits, lengths: [Vec::new(), Vec::new()] };
        let of = |base| {
            let price = |length| prices.of(|each| length_told(base, length, each));
            (0..=LONGEST).map(|length| if length < 2 { 0 } else { price(length) }).collect()
        };
        prices.lengths = [of(LENGTH), of(LENGTH_AGAIN)];
        prices
    }

    fn of(&self, told: impl FnOnce(&mut Each<'_>)) -> u32 {
        let mut price = 0;
        told(&mut |place, bit| {
            price += place.map_or(ONE_BIT, |place| {
                let chance = self.chances[place];
                self.bits[usize::from(if bit { 2048 - chance } else { chance })]
            });
        });
        price
    }
}

/// Where the same three bytes were before.
struct Before {
    last: Vec<usize>,
    chain: Vec<usize>,
}

impl Before {
    const NONE: usize = usize::MAX;

    fn new(size: usize) -> Self {
        Self { last: vec![Self::NONE; 1 << 18], chain: vec![Self::NONE; size] }
    }

    /// Finds the copies that could be at a place, longer ones from farther back, as distance and length, and takes the place in.
    fn copies(&mut self, bytes: &[u8], at: usize, longest: usize) -> Vec<(usize, usize)> {
        let mut found = Vec::new();
        let Some(&[a, b, c]) = bytes[at..].first_chunk() else { return found };
        let key = (usize::from(a) << 10 ^ usize::from(b) << 5 ^ usize::from(c)) ^ usize::from(c) << 9;
        let mut place = std::mem::replace(&mut self.last[key & 0x3ffff], at);
        self.chain[at] = place;
        let mut most = 2;
        for _ in 0..DEPTH {
            if place == Self::NONE || most >= longest {
                break;
            }
            if bytes[place + most] == bytes[at + most] {
                let length = same(bytes, place, at, longest);
                if length > most {
                    found.push((at - place - 1, length));
                    most = length;
                }
            }
            place = self.chain[place];
        }
        found
    }
}

/// How many bytes are the same from two places on.
fn same(bytes: &[u8], place: usize, at: usize, longest: usize) -> usize {
    bytes[place..].iter().zip(&bytes[at..]).take(longest).take_while(|(a, b)| a == b).count()
}

/// A way to a place: its price, its last step, and what that leaves.
#[derive(Clone, Copy)]
struct Way {
    price: u32,
    step: Step,
    past: Past,
}

/// Finds the cheapest steps of a block by the chances before it.
fn cheapest(bytes: &[u8], begin: usize, end: usize, past: Past, before: &mut Before, prices: &Prices<'_>) -> Vec<Step> {
    let count = end - begin;
    let mut ways = vec![Way { price: u32::MAX, step: Step::Literal, past }; count + 1];
    ways[0].price = 0;
    for k in 0..count {
        let at = begin + k;
        if k > 0 {
            ways[k].past = ways[k - ways[k].step.length()].past.after(ways[k].step);
        }
        let Way { price, past, .. } = ways[k];
        let of = |step| price + prices.of(|each| told(bytes, at, &past, step, each));
        let mut offer = |step: Step, price| {
            let way = &mut ways[k + step.length()];
            if price < way.price {
                (way.price, way.step) = (price, step);
            }
        };
        let longest = LONGEST.min(end - at);
        offer(Step::Literal, of(Step::Literal));
        for (which, distance) in past.distances.into_iter().enumerate().filter(|(_, distance)| *distance < at) {
            let length = same(bytes, at - distance - 1, at, longest);
            if which == 0 && length > 0 {
                offer(Step::Short, of(Step::Short));
            }
            if length >= 2 {
                let [_, lengths] = &prices.lengths;
                let base = of(Step::Again { which, length: 2 }) - lengths[2];
                (2..=length).for_each(|length| offer(Step::Again { which, length }, base + lengths[length]));
            }
        }
        let mut from = 2;
        for (distance, to) in before.copies(bytes, at, longest) {
            let [lengths, _] = &prices.lengths;
            let mut base = 0;
            for (length, price) in lengths.iter().enumerate().take(to + 1).skip(from) {
                // Distances of short copies have chances of their own.
                if length <= 5 || length == from {
                    base = of(Step::Copy { distance, length }) - price;
                }
                offer(Step::Copy { distance, length }, base + price);
            }
            from = to + 1;
        }
    }
    let mut steps = Vec::new();
    let mut k = count;
    while k > 0 {
        steps.push(ways[k].step);
        k -= ways[k].step.length();
    }
    steps.reverse();
    steps
}

/// Packs bytes.
pub(crate) fn packed(bytes: &[u8]) -> Vec<u8> {
    let size = u32::try_from(bytes.len()).expect("a page is smaller than 4 GB");
    let chances = vec![1024; CHANCES];
    let out = size.to_be_bytes().to_vec();
    let mut packer = Packer { chances, low: 0, range: u32::MAX, held: None, full: 0, out };
    let bits: Vec<u32> = (0..=2048).map(|chance: u128| 11 * ONE_BIT - chance.max(1).pow(ONE_BIT).ilog2()).collect();
    let mut before = Before::new(bytes.len());
    let mut past = Past::default();
    let mut at = 0;
    while at < bytes.len() {
        let end = bytes.len().min(at + BLOCK);
        let prices = Prices::new(&packer.chances, &bits);
        let steps = cheapest(bytes, at, end, past, &mut before, &prices);
        for step in steps {
            told(bytes, at, &past, step, &mut |place, bit| packer.bit(place, bit));
            past = past.after(step);
            at += step.length();
        }
    }
    (0..5).for_each(|_| packer.shift());
    packer.out
}
