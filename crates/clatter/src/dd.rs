//! Double-double numbers: an unevaluated sum `hi + lo` of two floats, about 106 bits.
//!
//! They serve where the digits of one float cannot decide. Products and sums follow Dekker (1971) and Knuth (TAOCP 2,
//! 4.2.2); no fused multiply-add is needed, so results agree on every machine. Relative errors are a few 2⁻¹⁰⁴ as long
//! as nothing under- or overflows; callers scale first.

use std::ops::{Add, Div, Mul, Neg, Sub};

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Dd {
    pub(crate) hi: f64,
    pub(crate) lo: f64,
}

/// Returns `a + b` without error.
#[inline]
pub(crate) fn two_sum(a: f64, b: f64) -> Dd {
    let hi = a + b;
    let bb = hi - a;
    Dd { hi, lo: (a - (hi - bb)) + (b - bb) }
}

/// Returns `a + b` without error, given |a| ≥ |b|.
#[inline]
fn quick_two_sum(a: f64, b: f64) -> Dd {
    let hi = a + b;
    Dd { hi, lo: b - (hi - a) }
}

/// Returns `a b` without error.
#[inline]
pub(crate) fn two_prod(a: f64, b: f64) -> Dd {
    /// Splits a 53-bit significand into halves of at most 26 bits each (Veltkamp).
    #[inline]
    fn split(a: f64) -> (f64, f64) {
        let c = 134_217_729.0 * a; // 2^27 + 1
        let hi = c - (c - a);
        (hi, a - hi)
    }
    let hi = a * b;
    let ((ah, al), (bh, bl)) = (split(a), split(b));
    Dd { hi, lo: ((ah * bh - hi) + ah * bl + al * bh) + al * bl }
}

impl Dd {
    pub(crate) const ZERO: Self = Self { hi: 0.0, lo: 0.0 };

    pub(crate) fn abs(self) -> Self {
        if self.hi < 0.0 { -self } else { self }
    }
    /// Returns `2^n self`, exact unless it leaves the range of normal floats.
    pub(crate) fn scale(self, n: i32) -> Self {
        Self { hi: ldexp(self.hi, n), lo: ldexp(self.lo, n) }
    }
    /// Returns the square root, by one Newton step on that of `hi`; 0 for 0.
    #[inline]
    pub(crate) fn sqrt(self) -> Self {
        if self.hi <= 0.0 {
            return Self::ZERO;
        }
        let r = self.hi.sqrt();
        let rest = self - two_prod(r, r);
        quick_two_sum(r, rest.hi / (2.0 * r))
    }
    #[inline]
    pub(crate) fn sqr(self) -> Self {
        self * self
    }
}

/// Returns 2ⁿ for −1022 ≤ n ≤ 1023.
#[expect(clippy::cast_sign_loss, reason = "a biased exponent")]
pub(crate) const fn power_of_two(n: i32) -> f64 {
    f64::from_bits(((n + 1023) as u64) << 52)
}

/// Returns `2^n x`, in steps that neither over- nor underflow before the result does.
pub(crate) fn ldexp(mut x: f64, mut n: i32) -> f64 {
    while n > 1000 {
        x *= power_of_two(1000);
        n -= 1000;
    }
    while n < -1000 {
        x *= power_of_two(-1000);
        n += 1000;
    }
    x * power_of_two(n)
}

impl From<f64> for Dd {
    #[inline]
    fn from(hi: f64) -> Self {
        Self { hi, lo: 0.0 }
    }
}
impl From<Dd> for f64 {
    #[inline]
    fn from(x: Dd) -> Self {
        x.hi
    }
}
impl Neg for Dd {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self { hi: -self.hi, lo: -self.lo }
    }
}
impl Add for Dd {
    type Output = Self;
    #[inline]
    fn add(self, o: Self) -> Self {
        let (s, t) = (two_sum(self.hi, o.hi), two_sum(self.lo, o.lo));
        let s = quick_two_sum(s.hi, s.lo + t.hi);
        quick_two_sum(s.hi, s.lo + t.lo)
    }
}
impl Sub for Dd {
    type Output = Self;
    #[inline]
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}
impl Mul for Dd {
    type Output = Self;
    #[inline]
    fn mul(self, o: Self) -> Self {
        let p = two_prod(self.hi, o.hi);
        quick_two_sum(p.hi, p.lo + (self.hi * o.lo + self.lo * o.hi))
    }
}
impl Mul<f64> for Dd {
    type Output = Self;
    #[inline]
    fn mul(self, o: f64) -> Self {
        let p = two_prod(self.hi, o);
        quick_two_sum(p.hi, p.lo + self.lo * o)
    }
}
impl Div for Dd {
    type Output = Self;
    #[inline]
    fn div(self, o: Self) -> Self {
        let q = self.hi / o.hi;
        let rest = self - o * q;
        quick_two_sum(q, rest.hi / o.hi)
    }
}

/// π as a sum of two floats.
pub(crate) const PI: Dd = Dd { hi: std::f64::consts::PI, lo: 1.224_646_799_147_353_2e-16 };

/// atan(k/16) for k = 0 … 16, each correct to 2⁻¹⁰⁶ (checked in the tests by Machin-like series).
#[expect(clippy::approx_constant, reason = "atan 1 is π/4, in two parts like the rest")]
const ATAN: [Dd; 17] = [
    Dd { hi: 0.0, lo: 0.0 },
    Dd { hi: 0.062_418_809_995_957_35, lo: -1.549_075_630_829_504_6e-18 },
    Dd { hi: 0.124_354_994_546_761_44, lo: -3.125_324_142_453_938_3e-18 },
    Dd { hi: 0.185_347_949_995_694_76, lo: 4.180_692_268_843_079e-18 },
    Dd { hi: 0.244_978_663_126_864_14, lo: 1.069_875_561_873_445_1e-17 },
    Dd { hi: 0.302_884_868_374_971_4, lo: -1.101_082_790_300_136_9e-17 },
    Dd { hi: 0.358_770_670_270_572_25, lo: -2.462_381_558_263_863_5e-17 },
    Dd { hi: 0.412_410_441_597_387_3, lo: -1.587_652_227_770_689e-17 },
    Dd { hi: 0.463_647_609_000_806_1, lo: 2.269_877_745_296_168_7e-17 },
    Dd { hi: 0.512_389_460_310_737_7, lo: -2.546_278_147_285_580_4e-17 },
    Dd { hi: 0.558_599_315_343_562_4, lo: -5.455_630_548_591_626_4e-18 },
    Dd { hi: 0.602_287_346_134_964_2, lo: 2.950_430_737_228_402e-17 },
    Dd { hi: 0.643_501_108_793_284_4, lo: 1.583_478_505_144_428_6e-17 },
    Dd { hi: 0.682_316_554_874_748_1, lo: 6.943_223_671_560_008e-18 },
    Dd { hi: 0.718_829_999_621_624_5, lo: -2.147_838_844_445_698_3e-17 },
    Dd { hi: 0.753_151_280_962_194_4, lo: -2.425_693_465_918_206_8e-17 },
    Dd { hi: 0.785_398_163_397_448_3, lo: 3.061_616_997_868_383e-17 },
];

/// 1/9, 1/7, 1/5, 1/3.
const INVERSE_ODD: [Dd; 4] = [
    Dd { hi: 0.111_111_111_111_111_1, lo: 6.167_905_692_361_980_4e-18 },
    Dd { hi: 0.142_857_142_857_142_85, lo: 7.930_164_461_608_26e-18 },
    Dd { hi: 0.2, lo: -1.110_223_024_625_156_6e-17 },
    Dd { hi: 0.333_333_333_333_333_3, lo: 1.850_371_707_708_594e-17 },
];

/// 1/23, 1/21, … 1/7.
const LATE_ODD: [f64; 9] =
    [1.0 / 23.0, 1.0 / 21.0, 1.0 / 19.0, 1.0 / 17.0, 1.0 / 15.0, 1.0 / 13.0, 1.0 / 11.0, 1.0 / 9.0, 1.0 / 7.0];

/// Returns the angle of the point (x, y), in [0, π], for y ≥ 0, with a relative error below 2⁻⁹⁹, or below 2⁻⁸² if
/// `enough`.
///
/// The angle is folded to the first octant and reduced by the nearest atan(k/16). The rest is the alternating series of
/// atan t for |t| ≤ 1/32; its late terms need f64 only.
pub(crate) fn atan2(y: Dd, x: Dd, enough: bool) -> Dd {
    debug_assert!(y.hi >= 0.0, "the lower half plane is not needed");
    let (ax, half_turn) = (x.abs(), x.hi < 0.0);
    let steep = y.hi > ax.hi;
    let (n, d) = if steep { (ax, y) } else { (y, ax) };
    if d.hi == 0.0 {
        return Dd::ZERO;
    }
    if 32.0 * n.hi <= d.hi {
        return fold(atan(n / d, enough), steep, half_turn);
    }
    let k = (16.0 * n.hi / d.hi).round();
    let c = k / 16.0;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an integer in 0 … 16")]
    let base = ATAN[k as usize];
    fold(base + atan((n - d * c) / (d + n * c), enough), steep, half_turn)
}

/// Returns the arc tangent for |t| ≤ 1/32.
#[inline]
fn atan(t: Dd, enough: bool) -> Dd {
    if t.hi.abs() < power_of_two(-23) {
        // The terms of the series beside t are below 2⁻⁴⁶ of it, so that f64 has digits enough for them.
        let z = t.hi * t.hi;
        return t - Dd::from(t.hi * z * (1.0 / 3.0 - 0.2 * z));
    }
    let z = t.sqr();
    if z.hi < power_of_two(-36) {
        // Of 106 bits the second term of the bracket 1/3 − z/5 + z²/7 needs 34, the third none beyond f64.
        return t - t * (z * INVERSE_ODD[3] - Dd::from(z.hi * z.hi * (0.2 - z.hi / 7.0)));
    }
    // In the term z^m/(2m + 1) of the series, beside its first term 1, f64 loses 2^-53: less than 2^-103 from z⁵ on,
    // for small z from an earlier one on; less than 2^-83 from z³ on.
    let skip =
        if enough { 2 } else { [power_of_two(-12), power_of_two(-16)].iter().filter(|&&below| z.hi < below).count() };
    let tail = LATE_ODD[..7 + skip].iter().fold(0.0, |s, inverse| inverse - z.hi * s);
    let head = INVERSE_ODD[skip..].iter().fold(Dd::from(tail), |s, &inverse| inverse - z * s);
    t - t * (z * head)
}

/// Returns the angle of the first octant, put back into the octant it came from.
fn fold(angle: Dd, steep: bool, half_turn: bool) -> Dd {
    let angle = if steep { PI.scale(-1) - angle } else { angle };
    if half_turn { PI - angle } else { angle }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_bigint::BigInt;
    use proptest::prelude::*;

    /// Returns 2^200 atan(n/d) by the alternating series, for 0 ≤ n/d ≤ 1/2, to a few units.
    fn atan_fixed(n: i64, d: i64) -> BigInt {
        let (n2, d2) = (BigInt::from(n * n), BigInt::from(d * d));
        let mut power = (BigInt::from(n) << 200) / d;
        let (mut sum, mut k) = (BigInt::from(0), 1);
        while power != BigInt::from(0) {
            sum += &power / k * if k % 4 == 1 { 1 } else { -1 };
            power = power * &n2 / &d2;
            k += 2;
        }
        sum
    }

    fn fixed(x: Dd) -> BigInt {
        let part = |v: f64| {
            let bits = v.abs().to_bits();
            let (m, e) = ((bits & ((1 << 52) - 1)) | (1 << 52), i64::try_from(bits >> 52).unwrap() - 1075);
            if v == 0.0 {
                return BigInt::from(0);
            }
            let m = BigInt::from(m);
            let m = if e + 200 >= 0 { m << (e + 200) } else { m >> (-e - 200) };
            if v < 0.0 { -m } else { m }
        };
        part(x.hi) + part(x.lo)
    }

    /// Returns |a − b| < 2^-bits, for numbers in units of 2^-200.
    fn close(a: &BigInt, b: &BigInt, bits: u64) -> bool {
        (a - b).magnitude().bits() < 200 - bits
    }

    #[test]
    fn the_table_of_arcus_tangents_is_correct_to_106_bits() {
        // Machin: π/4 = 4 atan 1/5 − atan 1/239; beyond 1/2: atan x = π/4 − atan((1 − x)/(1 + x)).
        let quarter: BigInt = 4 * atan_fixed(1, 5) - atan_fixed(1, 239);
        assert!(close(&fixed(PI.scale(-2)), &quarter, 107), "π");
        for (k, &got) in (0..).zip(&ATAN) {
            let want = if k <= 8 { atan_fixed(k, 16) } else { &quarter - atan_fixed(16 - k, 16 + k) };
            assert!(close(&fixed(got), &want, 106), "atan({k}/16)");
        }
        for (&got, odd) in INVERSE_ODD.iter().zip([9, 7, 5, 3]) {
            assert!(close(&fixed(got), &((BigInt::from(1) << 200) / odd), 106), "1/{odd}");
        }
    }

    proptest! {
        /// Compares with the series, for every octant that occurs, at the stated 2⁻⁹⁹.
        #[test]
        fn an_angle_has_99_good_bits(n in 1..1_000_000_i32, d in 1..1_000_000_i32) {
            let quarter: BigInt = 4 * atan_fixed(1, 5) - atan_fixed(1, 239);
            let (lo, hi) = (i64::from(n.min(d)), i64::from(n.max(d)));
            let first = if 2 * lo <= hi { atan_fixed(lo, hi) } else { &quarter - atan_fixed(hi - lo, hi + lo) };
            let angle = if n <= d { first } else { 2 * &quarter - first };
            let (y, x) = (Dd::from(f64::from(n)), Dd::from(f64::from(d)));
            let got = fixed(atan2(y, x, false));
            // Relative: 99 bits below the leading bit of the angle.
            let below_one = 299 - angle.magnitude().bits();
            prop_assert!(close(&got, &angle, below_one), "atan2({n}, {d})");
            prop_assert!(close(&fixed(atan2(y, x, true)), &angle, below_one - 17), "atan2({n}, {d}) to 82 bits");
            let obtuse: BigInt = 4 * &quarter - angle;
            prop_assert!(close(&fixed(atan2(y, -x, false)), &obtuse, 98), "atan2({n}, -{d})");
        }

        #[test]
        fn products_quotients_and_roots_undo_each_other(a in 1e-3..1e3_f64, b in 1e-3..1e3_f64) {
            let (x, y) = (Dd::from(a) / Dd::from(3.0), Dd::from(b) / Dd::from(7.0));
            let tiny = 2f64.powi(-101);
            prop_assert!(((x * y / y - x) / x).hi.abs() < tiny, "x y / y");
            prop_assert!(((x.sqr().sqrt() - x) / x).hi.abs() < tiny, "√x²");
            prop_assert!(((x + y - y - x) / (x + y)).hi.abs() < tiny, "x + y − y");
        }
    }
}
