//! Elementary functions to nine digits, in line and without branches: an estimate needs no more, and those of `libm`
//! took a quarter of its time.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2, FRAC_PI_4, LN_2, LOG2_E, PI, SQRT_2};

/// Adding it rounds to a whole number, which then stands in the last bits: 1.5·2⁵².
const ROUND: f64 = 6_755_399_441_055_744.0;

/// Beyond, nothing worth telling is left.
const FADED: f64 = 600.0;

/// e^(−y) for y ≥ −600 within 10⁻⁹ of itself; beyond y = 600 that of 600.
#[inline]
pub(super) fn decay(y: f64) -> f64 {
    let x = if y > FADED { -FADED } else { -y };
    let rounded = x * LOG2_E + ROUND;
    // |r| ≤ ln 2/2: the first term left out is below 3·10⁻¹⁰.
    let r = x - (rounded - ROUND) * LN_2;
    let (r2, power) = (r * r, f64::from_bits(rounded.to_bits().wrapping_add(1023) << 52));
    let low = (1.0 + r) + r2 * (0.5 + r * (1.0 / 6.0));
    let high = (1.0 / 24.0 + r * (1.0 / 120.0)) + r2 * (1.0 / 720.0 + r * (1.0 / 5040.0));
    let r4 = r2 * r2;
    power * (low + r4 * (high + r4 * (1.0 / 40320.0)))
}

/// The first 33 bits of π/2, and what follows.
const FRAC_PI_2_HI: f64 = 1.570_796_326_734_125_6;
const FRAC_PI_2_LO: f64 = 6.077_100_506_506_192e-11;
/// Up to here a multiple of the first is exact.
const NEAR: f64 = 1e6;

/// Sine and cosine of an angle x ≥ 0 within 10⁻⁹; beyond 10¹⁵, of 10¹⁵.
#[inline]
pub(super) fn sin_cos(x: f64) -> (f64, f64) {
    if x > NEAR {
        return far(x);
    }
    let rounded = x * FRAC_2_PI + ROUND;
    let (n, quarter) = (rounded - ROUND, rounded.to_bits());
    let r = (x - n * FRAC_PI_2_HI) - n * FRAC_PI_2_LO;
    // |r| ≤ π/4: the first terms left out are below 8·10⁻¹² and 2·10⁻¹⁰.
    let u = r * r;
    let u2 = u * u;
    let odd =
        (-1.0 / 6.0 + u * (1.0 / 120.0)) + u2 * ((-1.0 / 5040.0 + u * (1.0 / 362_880.0)) - u2 * (1.0 / 39_916_800.0));
    let even = (-0.5 + u * (1.0 / 24.0)) + u2 * ((-1.0 / 720.0 + u * (1.0 / 40320.0)) - u2 * (1.0 / 3_628_800.0));
    let (s, c) = ((r + r * u * odd).to_bits(), (1.0 + u * even).to_bits());
    // Every quarter turn the two change places, and one of them its sign.
    let change = (s ^ c) & 0_u64.wrapping_sub(quarter & 1);
    (
        f64::from_bits((s ^ change) ^ ((quarter & 2) << 62)),
        f64::from_bits((c ^ change) ^ ((quarter.wrapping_add(1) & 2) << 62)),
    )
}

#[cold]
fn far(x: f64) -> (f64, f64) {
    libm::sincos(x.min(1e15))
}

/// ln x of a normal x > 0 within 10⁻⁹ of the larger of itself and 1.
#[inline]
pub(super) fn ln(x: f64) -> f64 {
    /// Bits of 1/√2.
    const LOW: u64 = 0x3FE6_A09E_667F_3BCD;
    let shifted = x.to_bits().wrapping_sub(LOW);
    #[expect(clippy::cast_possible_wrap, reason = "the exponent is signed")]
    let exponent = shifted as i64 >> 52;
    #[expect(clippy::cast_precision_loss, reason = "within 1100")]
    let k = exponent as f64;
    #[expect(clippy::cast_sign_loss, reason = "bits")]
    let m = f64::from_bits(x.to_bits().wrapping_sub((exponent as u64) << 52));
    // m in [1/√2, √2): |s| ≤ 0.172, the first term left out is below 6·10⁻¹¹.
    let s = (m - 1.0) / (m + 1.0);
    let u = s * s;
    let u2 = u * u;
    let series = (1.0 + u * (1.0 / 3.0)) + u2 * ((1.0 / 5.0 + u * (1.0 / 7.0)) + u2 * (1.0 / 9.0 + u * (1.0 / 11.0)));
    k * LN_2 + 2.0 * s * series
}

/// The angle of (x, y) for y ≥ 0, in [0, π], within 10⁻⁹; 0 at the origin.
#[inline]
pub(super) fn angle(y: f64, x: f64) -> f64 {
    let wide = x.abs();
    let steep = y > wide;
    let (small, large) = if steep { (wide, y) } else { (y, wide) };
    // tan(φ − π/4) = (t − 1)/(t + 1) beyond π/8.
    let beyond = small > (SQRT_2 - 1.0) * large;
    let (over, under) = if beyond { (small - large, small + large) } else { (small, large) };
    let t = if under == 0.0 { 0.0 } else { over / under };
    let (u, from) = (t * t, if beyond { FRAC_PI_4 } else { 0.0 });
    let u2 = u * u;
    // Chebyshev in t², within 3·10⁻¹¹.
    let low = (0.999_999_999_978_398_8 - u * 0.333_333_320_976_093_86)
        + u2 * (0.199_998_838_565_513 - u * 0.142_815_887_726_541_24);
    let high = (0.110_404_892_272_182_4 - u * 0.084_561_928_869_404_96) + u2 * 0.047_073_481_419_680_2;
    let first = from + t * (low + u2 * u2 * high);
    let acute = if steep { FRAC_PI_2 - first } else { first };
    if x < 0.0 { PI - acute } else { acute }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const STATED: f64 = 1e-9;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]
        #[test]
        fn functions_have_the_nine_digits_stated(exponent in -12.0..16.0_f64, sign in any::<bool>(), turn in 0.0..=PI) {
            let x = libm::pow(10.0, exponent);
            let (sin, cos) = sin_cos(x);
            let exact = libm::sincos(x.min(1e15));
            prop_assert!((sin - exact.0).abs() <= STATED && (cos - exact.1).abs() <= STATED, "sine and cosine of {x}");
            let y = if sign { x.min(600.0) } else { -x.min(600.0) };
            prop_assert!((decay(y) / libm::exp(-y) - 1.0).abs() <= STATED, "decay by {y}");
            for x in [x, x.recip()] {
                let exact = libm::log(x);
                prop_assert!((ln(x) - exact).abs() <= STATED * exact.abs().max(1.0), "logarithm of {x}");
            }
            let (sin, cos) = libm::sincos(turn);
            prop_assert!((angle(x * sin, x * cos) - turn).abs() <= STATED, "angle {turn} of {x}");
        }
    }

    /// What is exact, where it ends, and what is no number.
    #[test]
    fn ends_are_as_stated() {
        assert_eq!((decay(0.0), sin_cos(0.0), ln(1.0), angle(0.0, 1.0)), (1.0, (0.0, 1.0), 0.0, 0.0));
        assert_eq!((angle(0.0, 0.0), angle(0.0, -1.0), angle(2.0, 0.0)), (0.0, PI, FRAC_PI_2));
        assert_eq!((decay(1e300), decay(f64::INFINITY)), (decay(600.0), decay(600.0)));
        assert_eq!((sin_cos(1e300), sin_cos(f64::INFINITY)), (sin_cos(1e15), sin_cos(1e15)));
        assert!(decay(f64::NAN).is_nan() && sin_cos(f64::NAN).0.is_nan() && angle(f64::NAN, 1.0).is_nan());
        // Next to where the reduction changes.
        for k in 1..2000 {
            for x in [
                NEAR,
                NEAR * (1.0 + f64::EPSILON),
                f64::from(k) * FRAC_PI_4,
                f64::from(k) * FRAC_PI_4 * (1.0 - f64::EPSILON),
            ] {
                let (got, exact) = (sin_cos(x), libm::sincos(x));
                assert!((got.0 - exact.0).abs() <= STATED && (got.1 - exact.1).abs() <= STATED, "{x}");
            }
        }
    }
}
