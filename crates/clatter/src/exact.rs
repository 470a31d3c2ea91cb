//! Signs by integer arithmetic, for decisions that no fixed number of digits is sure to make.
//!
//! Every input is a float, hence an integer times a power of two, and so is every term of the recurrence
//! once its denominators are multiplied out:
//!
//! ```text
//! c_{n+1} = P c_n − Q c_{n−1},   c_n = v U_{n+1} + w U_n,   U_0 = 0, U_1 = 1
//! ```
//!
//! with the same signs as a_n, where `U_n(P, Q)` is the Lucas sequence. Doubling reaches any n in about
//! log₂ n steps. Up to n = [`EXACT`] the integers are kept whole, so that a sign, and a tie, is certain.
//! Beyond, significands are cut at [`BITS`] bits: the relative error then stays below 2⁻³⁰⁰⁰ for n up to 2¹²⁰, and
//! a `c_n` that cancels by more than 2²⁰⁴⁸ counts as a tie. No tie is known to be there: it fixes the ratio of the
//! starting velocities to that of two successive `U_n`, whose reduced numerators grow by half a bit a step or more
//! unless c is a multiple of 2, √2 or 1 over 2 (where ties repeat and the first is found early), so that beyond a few
//! hundred steps no ratio of floats can be it.
//!
//! # Cost
//! A sign takes about 4 log₂ n products of integers, whole ones of some 100 n bits. A count that is settled here costs
//! about 2 µs for a tie at one impact, some 50 µs for one at a few hundred, and tens of milliseconds beyond 2⁹⁰
//! impacts, where the bracket is wide. Integers are needed where double-double angles leave the count of a wave within
//! its error of an integer, where f64 logarithms leave that of a decay so, and where f64 leaves the place of a peak so.

use crate::dd::{Dd, ldexp, power_of_two, two_sum};
use num_bigint::{BigInt, Sign};
use std::cmp::Ordering;

/// Largest index whose sign is decided with whole integers.
const EXACT: u128 = 1024;
/// Bits of the significand that are kept beyond that index.
const BITS: u64 = 4096;

/// `m 2^x`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Dyadic {
    m: BigInt,
    x: i128,
}

impl From<f64> for Dyadic {
    #[expect(clippy::cast_possible_wrap, reason = "53 and 11 bits")]
    fn from(v: f64) -> Self {
        let bits = v.to_bits();
        let (fraction, exponent) = (bits & ((1 << 52) - 1), (bits >> 52) & 0x7FF);
        let m = if exponent == 0 { fraction } else { fraction | (1 << 52) } as i64;
        Self { m: BigInt::from(if v < 0.0 { -m } else { m }), x: i128::from(exponent.max(1)) - 1075 }
    }
}

impl From<Dd> for Dyadic {
    fn from(v: Dd) -> Self {
        Self::from(v.hi).add(&Self::from(v.lo))
    }
}

impl Dyadic {
    /// Returns the same number without the zeros at the end of its significand, which products would carry along.
    pub(crate) fn odd(self) -> Self {
        let zeros = self.m.trailing_zeros().unwrap_or(0);
        Self { m: self.m >> zeros, x: self.x + i128::from(zeros) }
    }
    /// Returns the number of binary digits of its significand.
    pub(crate) fn bits(&self) -> u64 {
        self.m.bits()
    }
    pub(crate) fn add(&self, o: &Self) -> Self {
        let (low, high) = if self.x <= o.x { (self, o) } else { (o, self) };
        if high.m.sign() == Sign::NoSign {
            return low.clone();
        }
        let shift = high.x - low.x;
        // The term is far below the last bit that is ever kept; only cut significands get here.
        if shift > 1 << 22 {
            return high.clone();
        }
        let m = (&high.m << shift) + &low.m;
        Self { m, x: low.x }
    }
    pub(crate) fn power_of_two(x: i128) -> Self {
        Self { m: BigInt::from(1), x }
    }
    pub(crate) fn neg(&self) -> Self {
        Self { m: -&self.m, x: self.x }
    }
    pub(crate) fn sub(&self, o: &Self) -> Self {
        self.add(&o.neg())
    }
    pub(crate) fn mul(&self, o: &Self) -> Self {
        Self { m: &self.m * &o.m, x: self.x + o.x }
    }
    pub(crate) fn sign(&self) -> Ordering {
        match self.m.sign() {
            Sign::Minus => Ordering::Less,
            Sign::NoSign => Ordering::Equal,
            Sign::Plus => Ordering::Greater,
        }
    }
    /// Returns the top 64 bits as a float in ±[1, 2] and the exponent; (0, 0) for zero.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bit counts of numbers in memory")]
    pub(crate) fn to_float(&self) -> (f64, i128) {
        let bits = i128::from(self.m.bits());
        if bits == 0 {
            return (0.0, 0);
        }
        let cut = (bits - 64).max(0);
        let top = (self.m.magnitude() >> cut as usize).iter_u64_digits().next().unwrap_or(0);
        #[expect(clippy::cast_precision_loss, reason = "rounds to nearest")]
        let v = top as f64 / power_of_two((bits - cut - 1) as i32);
        (if self.m.sign() == Sign::Minus { -v } else { v }, self.x + bits - 1)
    }
    /// Returns the same number with twice the digits.
    pub(crate) fn to_wide(&self) -> (Dd, i128) {
        let (hi, exponent) = self.to_float();
        let lo = self.mul(&Self::power_of_two(-exponent)).sub(&Self::from(hi)).to_float();
        (two_sum(hi, ldexp(lo.0, clamp(lo.1))), exponent)
    }
    fn cut(self, bits: u64) -> Self {
        let extra = self.m.bits().saturating_sub(bits);
        Self { m: self.m >> extra, x: self.x + i128::from(extra) }
    }
    /// Returns the exponent of the leading bit, very low for zero.
    fn top(&self) -> i128 {
        if self.sign() == Ordering::Equal { i128::MIN / 2 } else { self.x + i128::from(self.m.bits()) }
    }
}

/// Returns the exponent, clamped to a range far beyond that of floats.
pub(crate) fn clamp(x: i128) -> i32 {
    #[expect(clippy::cast_possible_truncation, reason = "clamped to far beyond the exponents of floats")]
    let small = x.clamp(-20_000, 20_000) as i32;
    small
}

/// The recurrence with its denominators multiplied out.
#[derive(Debug, Clone)]
pub(crate) struct Recurrence {
    pub(crate) p: Dyadic,
    pub(crate) q: Dyadic,
    /// `c_0`.
    pub(crate) v: Dyadic,
    /// `c_1` − P `c_0`.
    pub(crate) w: Dyadic,
}

impl Recurrence {
    /// Returns 4Q − P². Where it is 0 or negative, the train may be endless.
    pub(crate) fn discriminant(&self) -> Dyadic {
        Dyadic::from(4.0).mul(&self.q).sub(&self.p.mul(&self.p))
    }
    /// Returns whether `c_n` < 0 for ever, given 4Q ≤ P² and P > 0, Q > 0, v < 0. The condition is w ≤ λ₊ |v| for the
    /// larger root λ₊ of λ² − Pλ + Q, here without a square root: w ≤ P|v|/2 or w² + P v w + Q v² ≤ 0.
    pub(crate) fn endless(&self) -> bool {
        let half = Dyadic::from(2.0).mul(&self.w).add(&self.p.mul(&self.v));
        half.sign() != Ordering::Greater || self.form().sign() != Ordering::Greater
    }
    /// Returns w² + P v w + Q v², which is (λ₊|v| − w)(λ₋|v| − w) for the roots λ± of λ² − Pλ + Q.
    pub(crate) fn form(&self) -> Dyadic {
        let pv = self.p.mul(&self.v);
        self.w.mul(&self.w).add(&pv.mul(&self.w)).add(&self.q.mul(&self.v.mul(&self.v)))
    }
    /// Returns (`U_n`, U_{n+1}).
    fn lucas(&self, n: u128) -> (Dyadic, Dyadic) {
        let keep = |d: Dyadic| if n <= EXACT { d } else { d.cut(BITS) };
        let two = Dyadic::from(2.0);
        let (mut low, mut high) = (Dyadic::from(0.0), Dyadic::from(1.0));
        for bit in (0..u128::BITS - n.leading_zeros()).rev() {
            let even = low.mul(&two.mul(&high).sub(&self.p.mul(&low)));
            let odd = high.mul(&high).sub(&self.q.mul(&low.mul(&low)));
            (low, high) = if n >> bit & 1 == 0 {
                (keep(even), keep(odd))
            } else {
                let next = self.p.mul(&odd).sub(&self.q.mul(&even));
                (keep(odd), keep(next))
            };
        }
        (low, high)
    }
    /// Returns `c_n`, `U_n`; exactly 0 where the terms cancel to far below what was kept of them.
    fn term(&self, n: u128) -> (Dyadic, Dyadic) {
        let (low, high) = self.lucas(n);
        let (x, y) = (self.v.mul(&high), self.w.mul(&low));
        let sum = x.add(&y);
        let tie = n > EXACT && sum.top() < x.top().max(y.top()) - 2048;
        (if tie { Dyadic::from(0.0) } else { sum }, low)
    }
    /// Returns the sign of `c_n`.
    pub(crate) fn sign(&self, n: u128) -> Ordering {
        self.term(n).0.sign()
    }
    /// Returns `c_n` and `U_n` as floats with exponents.
    pub(crate) fn values(&self, n: u128) -> ((f64, i128), (f64, i128)) {
        let (c, u) = self.term(n);
        (c.to_float(), u.to_float())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares doubling with the recurrence itself.
    #[test]
    fn terms_by_doubling_are_those_of_the_recurrence() {
        let d = Dyadic::from;
        for (p, q, v, w) in [(1.5, 0.7, -1.0, 0.3), (-0.3, 1.0, -1.0, -1.0), (2.0, 1.0, -2.5, 1e-20)] {
            let r = Recurrence { p: d(p), q: d(q), v: d(v), w: d(w) };
            let (mut c, mut next) = (r.v.clone(), r.p.mul(&r.v).add(&r.w));
            for n in 0..60 {
                assert_eq!(r.term(n).0.sub(&c).sign(), Ordering::Equal, "term {n} of ({p}, {q}, {v}, {w})");
                (c, next) = (next.clone(), r.p.mul(&next).sub(&r.q.mul(&c)));
            }
        }
    }

    #[test]
    fn cut_significands_agree_with_whole_ones() {
        let d = Dyadic::from;
        let r = Recurrence { p: d(1.7), q: d(0.8), v: d(-1.0), w: d(-1.0) };
        let (low, _) = r.lucas(EXACT);
        let (c, _) = r.lucas(EXACT - 1);
        // One more step from whole numbers, against cut ones.
        let next = r.p.mul(&low).sub(&r.q.mul(&c));
        let (a, b) = (next.to_float(), r.lucas(EXACT + 1).0.to_float());
        assert_eq!(a, b, "U_1025");
    }

    #[test]
    fn a_float_survives_the_way_there_and_back() {
        for v in [1.0, -0.1, 5e-324, f64::MAX, -2.2e-308, 0.0] {
            let (m, x) = Dyadic::from(v).to_float();
            assert_eq!(ldexp(m, i32::try_from(x).unwrap()).to_bits(), v.to_bits(), "{v:e}");
        }
    }
}
