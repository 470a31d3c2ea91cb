//! A value of a quantity from a uniform number: the inverse of its distribution.

use clatter_product::{Law, Spread};

/// The value of a spread quantity that a share of all values stays below.
///
/// It rises with the share, so that the share is the rank of the value: what [`super::drivers`] sorts by.
#[derive(Debug, Clone, Copy)]
pub(super) struct Quantile {
    lo: f64,
    hi: f64,
    kind: Kind,
}

#[derive(Debug, Clone, Copy)]
enum Kind {
    /// One value, or equal density: x = lo + u (hi − lo).
    Even,
    /// Density rising to the mode and falling from there; `share` of all values lies below it.
    Triangle { mode: f64, share: f64 },
    /// x = mean ± deviation · Φ⁻¹(from + u · mass); the sign turns a range in the upper tail, where Φ has no digits
    /// left, into one in the lower.
    Normal { mean: f64, deviation: f64, from: f64, mass: f64, mirrored: bool },
}

/// Least share of a normal distribution that its range must hold.
const LEAST_MASS: f64 = 1e-200;

impl Quantile {
    /// Returns the drawing of a range; `None` for a normal distribution that has no values to speak of in its range.
    pub(super) fn new(spread: &Spread) -> Option<Self> {
        let (lo, hi) = (spread.lo(), spread.hi());
        let kind = match spread.law() {
            Law::Value | Law::Range | Law::Uniform => Kind::Even,
            Law::Triangular { mode } => Kind::Triangle { mode, share: (mode - lo) / (hi - lo) },
            Law::Normal { mean, deviation } => {
                let (a, b) = ((lo - mean) / deviation, (hi - mean) / deviation);
                let mirrored = a + b > 0.0;
                let [from, to] = if mirrored { [-b, -a] } else { [a, b] }.map(below);
                if to - from < LEAST_MASS {
                    return None;
                }
                Kind::Normal { mean, deviation, from, mass: to - from, mirrored }
            }
        };
        Some(Self { lo, hi, kind })
    }

    /// Returns the value, u in [0, 1].
    pub(super) fn at(&self, u: f64) -> f64 {
        let (lo, hi) = (self.lo, self.hi);
        let x = match self.kind {
            _ if u <= 0.0 => lo,
            _ if u >= 1.0 => hi,
            Kind::Even => lo + u * (hi - lo),
            Kind::Triangle { mode, share } if u < share => lo + (u * (hi - lo) * (mode - lo)).sqrt(),
            Kind::Triangle { mode, .. } => hi - ((1.0 - u) * (hi - lo) * (hi - mode)).sqrt(),
            Kind::Normal { mean, deviation, from, mass, mirrored: false } => {
                mean + deviation * normal_quantile(from + u * mass)
            }
            Kind::Normal { mean, deviation, from, mass, mirrored: true } => {
                mean - deviation * normal_quantile(from + (1.0 - u) * mass)
            }
        };
        x.clamp(lo, hi)
    }
}

/// Returns Φ(z), the share of a standard normal distribution below z.
fn below(z: f64) -> f64 {
    0.5 * libm::erfc(-z * std::f64::consts::FRAC_1_SQRT_2)
}

/// Returns Φ⁻¹(p) for p in (0, 1).
///
/// Source: M. J. Wichura, “Algorithm AS 241: the percentage points of the normal distribution”, Applied Statistics 37
/// (1988), routine PPND16; relative error about 1e−16 from p = 1e−316 to 1 − 1e−16.
#[expect(clippy::excessive_precision, reason = "as published")]
fn normal_quantile(p: f64) -> f64 {
    // Coefficients from the highest power down.
    const A: [f64; 8] = [
        2.509_080_928_730_122_672_7e3,
        3.343_057_558_358_812_810_5e4,
        6.726_577_092_700_870_085_3e4,
        4.592_195_393_154_987_145_7e4,
        1.373_169_376_550_946_112_5e4,
        1.971_590_950_306_551_442_7e3,
        1.331_416_678_917_843_774_5e2,
        3.387_132_872_796_366_608_0,
    ];
    const B: [f64; 8] = [
        5.226_495_278_852_854_561_0e3,
        2.872_908_573_572_194_267_4e4,
        3.930_789_580_009_271_061_0e4,
        2.121_379_430_158_659_586_7e4,
        5.394_196_021_424_751_107_7e3,
        6.871_870_074_920_579_083_0e2,
        4.231_333_070_160_091_125_2e1,
        1.0,
    ];
    const C: [f64; 8] = [
        7.745_450_142_783_414_076_4e-4,
        2.272_384_498_926_918_458_33e-2,
        2.417_807_251_774_506_117_7e-1,
        1.270_458_252_452_368_382_58,
        3.647_848_324_763_204_605_04,
        5.769_497_221_460_691_405_5,
        4.630_337_846_156_545_295_9,
        1.423_437_110_749_683_577_34,
    ];
    const D: [f64; 8] = [
        1.050_750_071_644_416_843_24e-9,
        5.475_938_084_995_344_946e-4,
        1.519_866_656_361_645_719_66e-2,
        1.481_039_764_274_800_745_9e-1,
        6.897_673_349_851_000_045_5e-1,
        1.676_384_830_183_803_849_4,
        2.053_191_626_637_758_821_87,
        1.0,
    ];
    const E: [f64; 8] = [
        2.010_334_399_292_288_132_65e-7,
        2.711_555_568_743_487_578_15e-5,
        1.242_660_947_388_078_438_6e-3,
        2.653_218_952_657_612_309_3e-2,
        2.965_605_718_285_048_912_3e-1,
        1.784_826_539_917_291_335_8,
        5.463_784_911_164_114_369_9,
        6.657_904_643_501_103_777_2,
    ];
    const F: [f64; 8] = [
        2.044_263_103_389_939_785_64e-15,
        1.421_511_758_316_445_888_7e-7,
        1.846_318_317_510_054_681_8e-5,
        7.868_691_311_456_132_591e-4,
        1.487_536_129_085_061_485_25e-2,
        1.369_298_809_227_358_053_1e-1,
        5.998_322_065_558_879_376_9e-1,
        1.0,
    ];
    let polynomial = |c: &[f64; 8], x: f64| c.iter().fold(0.0, |sum, c| sum * x + c);
    let off = p - 0.5;
    if off.abs() <= 0.425 {
        let r = 0.180_625 - off * off;
        return off * polynomial(&A, r) / polynomial(&B, r);
    }
    let r = libm::sqrt(-libm::log(if off < 0.0 { p } else { 1.0 - p }));
    let (r, over, under) = if r <= 5.0 { (r - 1.6, &C, &D) } else { (r - 5.0, &E, &F) };
    (polynomial(over, r) / polynomial(under, r)).copysign(off)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Share and quantile: mpmath 1.3 at 40 digits, rounded to 17.
    #[expect(clippy::excessive_precision, reason = "as computed")]
    const NORMAL: &[(f64, f64)] = &[
        (1e-300, -37.047_096_299_361_199),
        (1e-100, -21.273_453_560_965_324),
        (1e-20, -9.262_340_089_798_407_6),
        (1e-8, -5.612_001_244_174_788_7),
        (0.001, -3.090_232_306_167_813_5),
        (0.024_25, -1.972_961_051_311_884_8),
        (0.074_99, -1.439_602_118_239_316_2),
        (0.075_1, -1.438_825_392_752_54),
        (0.25, -0.674_489_750_196_081_74),
        (0.4, -0.253_347_103_135_799_74),
        (0.7, 0.524_400_512_708_040_66),
        (0.924_9, 1.438_825_392_752_540_4),
        (0.975, 1.959_963_984_540_053_9),
        (0.999_999, 4.753_424_308_817_087_8),
    ];

    #[test]
    fn quantiles_of_the_normal_distribution_are_the_published_ones() {
        for &(p, z) in NORMAL {
            let error = (normal_quantile(p) - z).abs() / z.abs();
            assert!(error < 4e-16, "{error:e} at {p}"); // twice the rounding of the last operation
        }
        assert!(normal_quantile(0.5).abs() < f64::MIN_POSITIVE, "the middle");
    }

    #[test]
    fn a_range_far_in_a_tail_keeps_its_digits_and_one_out_of_reach_is_refused() {
        let normal =
            |lo: f64, hi: f64| Quantile::new(&Spread::new(lo, hi, Law::Normal { mean: 0.0, deviation: 1.0 }).unwrap());
        let (upper, lower) = (normal(20.0, 25.0).unwrap(), normal(-25.0, -20.0).unwrap());
        // Beyond 20 the density falls like exp(−20 x): the middle of it is near 20 + ln 2/20.
        assert!((upper.at(0.5) - 20.034_5).abs() < 1e-3, "{}", upper.at(0.5));
        for u in [1e-6, 0.1, 0.5, 0.9] {
            assert!((upper.at(1.0 - u) + lower.at(u)).abs() < 1e-10, "mirror images");
        }
        assert!(normal(40.0, 41.0).is_none(), "no value in 10^300");
    }

    proptest! {
        /// Every law: values within the range, rising, and with the distribution's own share below them.
        #[test]
        fn the_quantile_inverts_the_distribution(
            lo in -3.0..1.0_f64, width in 0.1..4.0_f64, mean in -2.0..2.0_f64, deviation in 0.1..5.0_f64,
            share in 0.0..=1.0_f64, u in 0.001..0.999_f64,
        ) {
            let (hi, mode) = (lo + width, lo + share * width);
            let cut = |x: f64| below((x - mean) / deviation);
            let triangle = |x: f64| if x < mode {
                (x - lo) * (x - lo) / (width * (mode - lo))
            } else if x < hi {
                1.0 - (hi - x) * (hi - x) / (width * (hi - mode))
            } else { 1.0 };
            for law in [Law::Uniform, Law::Normal { mean, deviation }, Law::Triangular { mode: mode.min(hi) }] {
                let Some(quantile) = Quantile::new(&Spread::new(lo, hi, law).unwrap()) else { continue };
                let x = quantile.at(u);
                let back = match law {
                    Law::Normal { .. } => (cut(x) - cut(lo)) / (cut(hi) - cut(lo)),
                    Law::Triangular { .. } => triangle(x),
                    _ => (x - lo) / width,
                };
                prop_assert!((lo..=hi).contains(&x) && x <= quantile.at(u + 1e-3), "{law:?}");
                // The plain Φ of this test cancels in the upper tail.
                let slack = if let Law::Normal { .. } = law { 1e-15 / (cut(hi) - cut(lo)) } else { 0.0 };
                if slack > 1e-3 {
                    continue;
                }
                prop_assert!((back - u).abs() < 1e-12 + slack, "{law:?}: {back} not {u}");
            }
        }
    }
}
