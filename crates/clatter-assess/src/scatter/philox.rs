//! Random numbers by their place: a counter-based generator, so that sample k is the same wherever and whenever it is
//! drawn.

/// Computes Philox4x32 with ten rounds: 128 random bits for each counter, under a key of 64 bits.
///
/// Source: J. K. Salmon, M. A. Moraes, R. O. Dror, D. E. Shaw, “Parallel random numbers: as easy as 1, 2, 3”, SC 2011;
/// the published known answers are its test.
fn philox4x32_10(mut counter: [u32; 4], mut key: [u32; 2]) -> [u32; 4] {
    const MULTIPLIER: [u32; 2] = [0xD251_1F53, 0xCD9E_8D57];
    const WEYL: [u32; 2] = [0x9E37_79B9, 0xBB67_AE85]; // of the golden ratio and of √3 − 1
    for _ in 0..10 {
        let wide = [0, 1].map(|i| u64::from(MULTIPLIER[i]) * u64::from(counter[2 * i]));
        let [high, low] = [wide.map(|w| word(w, 32)), wide.map(|w| word(w, 0))];
        counter = [high[1] ^ counter[1] ^ key[0], low[1], high[0] ^ counter[3] ^ key[1], low[0]];
        key = [key[0].wrapping_add(WEYL[0]), key[1].wrapping_add(WEYL[1])];
    }
    counter
}

/// Returns 32 bits of 64.
#[expect(clippy::cast_possible_truncation, reason = "the upper half is another word")]
fn word(wide: u64, shift: u32) -> u32 {
    (wide >> shift) as u32
}

/// The uniform numbers of one sample: input i of sample k under a seed is one fixed number in (0, 1), whatever else is
/// drawn.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stream {
    key: [u32; 2],
    sample: [u32; 2],
}

impl Stream {
    pub(super) fn new(seed: u64, sample: u64) -> Self {
        let halves = |wide| [word(wide, 0), word(wide, 32)];
        Self { key: halves(seed), sample: halves(sample) }
    }

    /// Returns input 0, 1, 2, …: the middle of one of 2⁵² equal steps of (0, 1), never 0 and never 1.
    pub(super) fn at(self, input: u32) -> f64 {
        let bits = philox4x32_10([self.sample[0], self.sample[1], input / 2, 0], self.key);
        let half = 2 * (input as usize % 2);
        unit(bits[half], bits[half + 1])
    }
}

/// Returns 52 bits as the middle of their step of (0, 1), without rounding.
fn unit(low: u32, high: u32) -> f64 {
    let bits = (u64::from(high) << 20) | u64::from(low >> 12);
    // 1.bits in [1, 2), less 1, plus half a step
    f64::from_bits(0x3FF0_0000_0000_0000 | bits) - (1.0 - 0.5 * f64::EPSILON)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The three lines of Random123's `kat_vectors` for philox4x32-10.
    #[test]
    fn known_answers() {
        let pi = [0x243f_6a88, 0x85a3_08d3, 0x1319_8a2e, 0x0370_7344];
        for (counter, key, known) in [
            ([0; 4], [0; 2], [0x6627_e8d5, 0xe169_c58d, 0xbc57_ac4c, 0x9b00_dbd8]),
            ([u32::MAX; 4], [u32::MAX; 2], [0x408f_276d, 0x41c8_3b0e, 0xa20b_c7c6, 0x6d54_51fd]),
            (pi, [0xa409_3822, 0x299f_31d0], [0xd16c_fe09, 0x94fd_cceb, 0x5001_e420, 0x2412_6ea1]),
        ] {
            assert_eq!(philox4x32_10(counter, key), known);
        }
    }

    #[test]
    fn a_uniform_number_is_a_middle_of_its_step() {
        let half = 0.5 * f64::EPSILON;
        for (low, high, middle) in [(0, 0, half), (u32::MAX, u32::MAX, 1.0 - half), (0, 1 << 31, 0.5 + half)] {
            assert_eq!(unit(low, high).to_bits(), f64::to_bits(middle), "{low:x} {high:x}");
        }
    }

    #[test]
    fn every_input_of_every_sample_is_a_number_of_its_own() {
        let draw = |seed, sample| (0..9).map(move |i| Stream::new(seed, sample).at(i).to_bits());
        let mut all: Vec<u64> = [(7, 1 << 40), (8, 1 << 40), (7, (1 << 40) + 1), (7, 0)]
            .into_iter()
            .flat_map(|(seed, sample)| draw(seed, sample))
            .collect();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), 36);
    }
}
