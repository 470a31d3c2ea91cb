//! Numbers with more digits than any result that they check: 512 bits in the significand, and the matrix exponential in
//! them.

use num_bigint::{BigInt, Sign};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Digits that a result keeps. A strike beyond 10¹⁶ loses some 60 of them, a phase of 10¹² some 90.
const BITS: u64 = 512;

/// `m · 2^x`, results cut to [`BITS`].
#[derive(Debug, Clone)]
pub(super) struct Big {
    m: BigInt,
    x: i64,
}

impl Big {
    fn new(m: BigInt, x: i64) -> Self {
        let bits = m.bits();
        if bits <= BITS {
            return Self { m, x };
        }
        let off = bits - BITS;
        Self { m: m >> off, x: x.saturating_add_unsigned(off) }
    }
    pub(super) fn zero() -> Self {
        Self::from(0.0)
    }
    pub(super) fn is_zero(&self) -> bool {
        self.m.sign() == Sign::NoSign
    }
    pub(super) fn is_negative(&self) -> bool {
        self.m.sign() == Sign::Minus
    }
    pub(super) fn abs(&self) -> Self {
        if self.is_negative() { -self } else { self.clone() }
    }
    pub(super) fn max(&self, other: &Self) -> Self {
        if (self - other).is_negative() { other.clone() } else { self.clone() }
    }
    /// Returns the number times `2^n`.
    pub(super) fn scale(&self, n: i64) -> Self {
        Self { m: self.m.clone(), x: self.x + n }
    }
    /// Returns the exponent of the leading bit; a very low one for zero.
    fn top(&self) -> i64 {
        if self.is_zero() { i64::MIN / 2 } else { self.x.saturating_add_unsigned(self.m.bits()) }
    }
    /// Returns the square root; 0 for a negative number.
    pub(super) fn sqrt(&self) -> Self {
        if self.is_zero() || self.is_negative() {
            return Self::zero();
        }
        let up = 2 * BITS + u64::from(self.x % 2 != 0);
        Self::new((&self.m << up).sqrt(), (self.x - i64::try_from(up).unwrap_or(0)) / 2)
    }
    /// Returns the nearest float or its neighbor; 0 or infinite beyond their range.
    pub(super) fn to_f64(&self) -> f64 {
        let bits = self.m.bits();
        let off = bits.saturating_sub(64);
        let top = (self.m.magnitude() >> off).iter_u64_digits().next().unwrap_or(0);
        #[expect(clippy::cast_precision_loss, reason = "a rounding to the nearest float is what is wanted")]
        let top = top as f64;
        let power = self.x.saturating_add_unsigned(off).clamp(-3000, 3000);
        let size = libm::ldexp(top, i32::try_from(power).unwrap_or(0));
        if self.is_negative() { -size } else { size }
    }
    /// Returns the first `digits` significant decimal digits, rounded, and the power of ten of the first.
    pub(super) fn decimal(&self, digits: u32) -> (String, i64) {
        if self.is_zero() {
            return ("0".repeat(digits as usize), 0);
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_precision_loss,
            reason = "off by one is put right below"
        )]
        let mut power = ((self.top() - 1) as f64 * std::f64::consts::LOG10_2).floor() as i64;
        loop {
            let shift = i64::from(digits) - 1 - power;
            let ten = Self::new(BigInt::from(10).pow(u32::try_from(shift.unsigned_abs()).unwrap_or(0)), 0);
            let scaled = if shift < 0 { &self.abs() / &ten } else { &self.abs() * &ten };
            let scaled = &scaled + &Self::from(0.5);
            let whole =
                if scaled.x < 0 { scaled.m >> scaled.x.unsigned_abs() } else { scaled.m << scaled.x.unsigned_abs() };
            let text = whole.to_string();
            match text.len().cmp(&(digits as usize)) {
                std::cmp::Ordering::Equal => return (text, power),
                std::cmp::Ordering::Greater => power += 1,
                std::cmp::Ordering::Less => power -= 1,
            }
        }
    }
    /// Returns π = 16 atan 1/5 − 4 atan 1/239 (Machin 1706).
    pub(super) fn pi() -> Self {
        let one = BigInt::from(1) << (BITS + 32);
        let atan = |n: u32| {
            let (mut power, mut sum, mut k) = (&one / n, BigInt::from(0), 1_u32);
            while power.sign() != Sign::NoSign {
                sum += &power / k * if k % 4 == 1 { 1 } else { -1 };
                power = power / n / n;
                k += 2;
            }
            sum
        };
        let pi: BigInt = 16 * atan(5) - 4 * atan(239);
        Self::new(pi, -i64::try_from(BITS + 32).unwrap_or(0))
    }
}

impl From<f64> for Big {
    /// Converts exactly; 0 for a value that is not finite.
    fn from(v: f64) -> Self {
        if v == 0.0 || !v.is_finite() {
            return Self { m: BigInt::from(0), x: 0 };
        }
        let (fraction, exponent) = libm::frexp(v);
        #[expect(clippy::cast_possible_truncation, reason = "an integer below 2^53")]
        let m = libm::ldexp(fraction, 53) as i64;
        Self { m: BigInt::from(m), x: i64::from(exponent) - 53 }
    }
}
impl Neg for &Big {
    type Output = Big;
    fn neg(self) -> Big {
        Big { m: -&self.m, x: self.x }
    }
}
impl Add for &Big {
    type Output = Big;
    fn add(self, o: &Big) -> Big {
        let (high, low) = if self.top() >= o.top() { (self, o) } else { (o, self) };
        let reach = i64::try_from(2 * BITS).unwrap_or(0);
        if low.is_zero() || high.top().saturating_sub(low.top()) > reach {
            return high.clone();
        }
        let x = high.x.min(low.x);
        let whole = |b: &Big| &b.m << (b.x - x).unsigned_abs();
        Big::new(whole(high) + whole(low), x)
    }
}
impl Sub for &Big {
    type Output = Big;
    fn sub(self, o: &Big) -> Big {
        self + &-o
    }
}
impl Mul for &Big {
    type Output = Big;
    fn mul(self, o: &Big) -> Big {
        if self.is_zero() || o.is_zero() {
            return Big::zero();
        }
        Big::new(&self.m * &o.m, self.x + o.x)
    }
}
impl Div for &Big {
    type Output = Big;
    /// Returns the quotient; 0 over anything is 0, and the divisor must not be 0.
    fn div(self, o: &Big) -> Big {
        if self.is_zero() {
            return Big::zero();
        }
        let up = BITS + o.m.bits();
        Big::new((&self.m << up) / &o.m, self.x - o.x - i64::try_from(up).unwrap_or(0))
    }
}

/// A square matrix.
pub(super) type Matrix<const N: usize> = [[Big; N]; N];

fn product<const N: usize>(a: &Matrix<N>, b: &Matrix<N>) -> Matrix<N> {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..N).fold(Big::zero(), |sum, k| &sum + &(&a[i][k] * &b[k][j]))))
}

/// Returns e^A, by its power series at a small share of A, squared back up.
pub(super) fn exponential<const N: usize>(a: &Matrix<N>) -> Matrix<N> {
    let top = a.iter().flatten().map(Big::top).max().unwrap_or(0);
    let halvings = (top + 8).max(0);
    let small: Matrix<N> = std::array::from_fn(|i| std::array::from_fn(|j| a[i][j].scale(-halvings)));
    let one = |i, j| Big::from(if i == j { 1.0 } else { 0.0 });
    let mut sum: Matrix<N> = std::array::from_fn(|i| std::array::from_fn(|j| one(i, j)));
    let mut term = sum.clone();
    for k in 1..100_u8 {
        let by = Big::from(f64::from(k));
        let next = product(&term, &small);
        term = std::array::from_fn(|i| std::array::from_fn(|j| &next[i][j] / &by));
        sum = std::array::from_fn(|i| std::array::from_fn(|j| &sum[i][j] + &term[i][j]));
    }
    (0..halvings).fold(sum, |power, _| product(&power, &power))
}

/// Returns the image of a vector.
pub(super) fn image<const N: usize>(a: &Matrix<N>, v: &[Big; N]) -> [Big; N] {
    std::array::from_fn(|i| (0..N).fold(Big::zero(), |sum, k| &sum + &(&a[i][k] * &v[k])))
}

/// Returns the difference of `got` from `want`, over `scale`: 0 where they agree, infinite where `got` is not finite.
pub(super) fn off(got: f64, want: &Big, scale: &Big) -> f64 {
    if !got.is_finite() {
        return f64::INFINITY;
    }
    let off = (&Big::from(got) - want).abs();
    if off.is_zero() {
        return 0.0;
    }
    if scale.is_zero() { f64::INFINITY } else { (&off / scale).to_f64() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_and_floats_are_those_of_the_number() {
        let third = &Big::from(1.0) / &Big::from(3.0);
        assert_eq!(third.decimal(20), ("33333333333333333333".into(), -1));
        assert!((third.to_f64() - 1.0 / 3.0).abs() < 1e-16, "a third");
        assert_eq!(Big::pi().decimal(40).0, "3141592653589793238462643383279502884197");
        assert_eq!(Big::from(2.0).sqrt().decimal(30).0, "141421356237309504880168872421");
        assert_eq!(Big::from(9.996).decimal(3), ("100".into(), 1));
        for v in [0.0, -0.1, 5e-324, f64::MAX, 1e-300] {
            assert_eq!(Big::from(v).to_f64().to_bits(), v.to_bits(), "{v:e}");
        }
    }

    /// Checks a turn by one radian and by a thousand.
    #[test]
    fn the_exponential_of_a_turn_is_sine_and_cosine() {
        for (angle, sine) in [(1.0, "841470984807896506652502321630"), (1000.0, "826879540532002560255887429109")] {
            let zero = Big::zero;
            let turn = exponential(&[[zero(), Big::from(angle)], [Big::from(-angle), zero()]]);
            assert_eq!(turn[0][1].decimal(30), (sine.into(), -1), "sin {angle}");
            let one = &(&turn[0][1] * &turn[0][1]) + &(&turn[0][0] * &turn[0][0]);
            assert!((&one - &Big::from(1.0)).abs().to_f64() < 1e-140, "sin² + cos²");
        }
    }
}
