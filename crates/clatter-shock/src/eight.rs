//! Eight numbers at a time: sine, cosine and exponential without branches, for the vector instructions of the machine.
//!
//! They are power series after an exact reduction, in fused multiply-adds throughout: the results do not depend on how
//! many numbers one instruction takes, nor on the machine; one without such instructions is slower.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2, LN_2, LOG2_E};

/// Numbers side by side.
pub(crate) const WIDTH: usize = 8;
pub(crate) type Many = [f64; WIDTH];

/// Differences between π/2 and ln 2 and the doubles nearest to them.
const FRAC_PI_2_LO: f64 = 6.123_233_995_736_766e-17;
const LN_2_LO: f64 = 2.319_046_813_846_299_6e-17;
/// Adding this number rounds to a whole number, which then stands in the last bits: 1.5·2⁵².
const ROUND: f64 = 6_755_399_441_055_744.0;
/// The exponent beyond which the exponential counts as 0, so that no number gets too small for full speed.
const FADED: f64 = 600.0;
/// Largest angle of [`sin_cos`].
pub(crate) const LARGEST_ANGLE: f64 = 1e12;

/// 1/k!
const INVERSE_FACTORIAL: [f64; 18] = {
    let mut table = [1.0; 18];
    let (mut i, mut k, mut product) = (1, 1.0, 1.0);
    while i < 18 {
        product *= k;
        table[i] = 1.0 / product;
        (i, k) = (i + 1, k + 1.0);
    }
    table
};

/// Returns Σ termsᵢ tⁱ.
#[inline(always)]
#[expect(clippy::inline_always, reason = "it must take on the instruction set of the caller")]
fn series<const N: usize>(terms: [f64; N], t: Many) -> Many {
    let mut sum = [terms[N - 1]; WIDTH];
    for term in terms.iter().rev().skip(1) {
        for l in 0..WIDTH {
            sum[l] = sum[l].mul_add(t[l], *term);
        }
    }
    sum
}

/// Returns the sine and cosine of `angle` + `lo`, for angles up to [`LARGEST_ANGLE`] and |lo| far below one: within 2
/// ε.
#[inline(always)]
pub(crate) fn sin_cos(angle: Many, lo: Many) -> (Many, Many) {
    const F: [f64; 18] = INVERSE_FACTORIAL;
    let (mut quarter, mut r, mut square) = ([0_u64; WIDTH], [0.0; WIDTH], [0.0; WIDTH]);
    for l in 0..WIDTH {
        let rounded = angle[l].mul_add(FRAC_2_PI, ROUND);
        let n = rounded - ROUND;
        quarter[l] = rounded.to_bits();
        r[l] = n.mul_add(-FRAC_PI_2_LO, n.mul_add(-FRAC_PI_2, angle[l])) + lo[l];
        square[l] = r[l] * r[l];
    }
    // For |r| ≤ π/4 the omitted terms are below 10⁻¹⁸.
    let odd = series([-F[3], F[5], -F[7], F[9], -F[11], F[13], -F[15], F[17]], square);
    let even = series([-F[2], F[4], -F[6], F[8], -F[10], F[12], -F[14], F[16]], square);
    let (mut sine, mut cosine) = ([0.0; WIDTH], [0.0; WIDTH]);
    for l in 0..WIDTH {
        let s = (r[l] * square[l]).mul_add(odd[l], r[l]).to_bits();
        let c = square[l].mul_add(even[l], 1.0).to_bits();
        // Every quarter turn the two change places, and one of them its sign.
        let change = (s ^ c) & 0_u64.wrapping_sub(quarter[l] & 1);
        sine[l] = f64::from_bits((s ^ change) ^ ((quarter[l] & 2) << 62));
        cosine[l] = f64::from_bits((c ^ change) ^ ((quarter[l].wrapping_add(1) & 2) << 62));
    }
    (sine, cosine)
}

/// Returns e^(−(y + lo)) and that less 1, for y ≥ 0, infinite too, and |lo| far below one: each within 2 ε of itself
/// where lo = 0. Beyond y = 600 they are 0 and −1.
#[inline(always)]
pub(crate) fn decay(y: Many, lo: Many) -> (Many, Many) {
    const F: [f64; 18] = INVERSE_FACTORIAL;
    let (mut power, mut r) = ([0.0; WIDTH], [0.0; WIDTH]);
    for l in 0..WIDTH {
        let x = if y[l] < FADED { -y[l] } else { 0.0 };
        let rounded = x.mul_add(LOG2_E, ROUND);
        let n = rounded - ROUND;
        r[l] = n.mul_add(-LN_2_LO, n.mul_add(-LN_2, x)) - if y[l] < FADED { lo[l] } else { 0.0 };
        power[l] = f64::from_bits(rounded.to_bits().wrapping_add(1023) << 52);
    }
    // For |r| ≤ ln 2/2 the omitted terms are below 10⁻¹⁷.
    let p = series([F[2], F[3], F[4], F[5], F[6], F[7], F[8], F[9], F[10], F[11], F[12], F[13]], r);
    let (mut whole, mut less) = ([0.0; WIDTH], [0.0; WIDTH]);
    for l in 0..WIDTH {
        let p = (r[l] * r[l]).mul_add(p[l], r[l]);
        let faded = y[l] >= FADED;
        whole[l] = if faded { 0.0 } else { power[l].mul_add(p, power[l]) };
        less[l] = if faded { -1.0 } else { power[l].mul_add(p, power[l] - 1.0) };
    }
    (whole, less)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]
        /// The functions keep the stated 2 ε; one more is allowed for those they are compared with.
        #[test]
        fn functions_are_those_of_the_standard_library(exponent in -9.0..12.0_f64, lo in -1e-9..1e-9_f64) {
            let x = 10_f64.powf(exponent);
            let (sine, cosine) = sin_cos([x; WIDTH], [0.0; WIDTH]);
            prop_assert!((sine[3] - x.sin()).abs() <= 3.0 * f64::EPSILON, "sine of {x}");
            prop_assert!((cosine[5] - x.cos()).abs() <= 3.0 * f64::EPSILON, "cosine of {x}");
            let (whole, less) = decay([x; WIDTH], [0.0; WIDTH]);
            if x < FADED {
                prop_assert!((whole[0] / (-x).exp() - 1.0).abs() <= 3.0 * f64::EPSILON, "exponential of {x}");
                prop_assert!((less[7] / (-x).exp_m1() - 1.0).abs() <= 3.0 * f64::EPSILON, "exponential of {x}, less 1");
            } else {
                prop_assert_eq!((whole[0], less[7]), (0.0, -1.0));
            }
            // The second double turns and decays a little more.
            let (turned, _) = sin_cos([x; WIDTH], [lo; WIDTH]);
            prop_assert!((turned[1] - (sine[1] + lo * cosine[1])).abs() <= 3.0 * f64::EPSILON, "sine of {x} + {lo}");
            let (later, _) = decay([x; WIDTH], [lo; WIDTH]);
            prop_assert!((later[1] - whole[1] * (1.0 - lo)).abs() <= 3.0 * f64::EPSILON * whole[1], "{x} + {lo}");
        }
    }
}
