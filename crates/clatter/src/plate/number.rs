//! Numbers that carry a bound on their error, and the state of a plate after a word of corners in such numbers.

use std::cmp::Ordering;
use std::ops::{Add, Mul, Sub};

use super::Plate;
use crate::dd::{Dd, ldexp, two_sum};
use crate::exact::{Dyadic, clamp};

/// A number whose sign is either certain or known to be in doubt.
pub(super) trait Number: Clone {
    /// Creates the number from a float, without error.
    fn exactly(x: f64) -> Self;
    fn plus(&self, o: &Self) -> Self;
    fn minus(&self, o: &Self) -> Self;
    fn times(&self, o: &Self) -> Self;
    /// Returns the sign, or `None` where more digits are needed.
    fn sign(&self) -> Option<Ordering>;
    /// Returns `self/o`, rounded.
    fn over(&self, o: &Self) -> Dd;
    /// Returns the maps of velocities and intercepts by strikes.
    fn strikes(plate: &Plate) -> Strikes<Self>;
}

/// A strike at corner j takes `x_i` to `keep_j x_i − jump_ji x_j`, and `x_j` to `−rebound_j x_j`. Floats have keep = 1,
/// which is left out; whole numbers have keep = k_x² k_y² w_j(j), one positive factor for all that a strike changes.
#[derive(Debug, Clone)]
pub(super) struct Strikes<T> {
    keep: Option<[T; 4]>,
    jump: [[T; 4]; 4],
    rebound: [T; 4],
}

impl<T: Number> Strikes<T> {
    /// Returns the state after a strike at corner j.
    #[inline]
    pub(super) fn strike(&self, x: &[T; 4], j: usize) -> [T; 4] {
        let zero = || T::exactly(0.0);
        std::array::from_fn(|i| {
            if i == j {
                return zero().minus(&self.rebound[j].times(&x[j]));
            }
            let jump = self.jump[j][i].times(&x[j]);
            self.keep.as_ref().map_or_else(|| x[i].minus(&jump), |keep| keep[j].times(&x[i]).minus(&jump))
        })
    }
    /// Returns the factor by which a strike at j scales the state; `None` for numbers that are not scaled.
    pub(super) fn factor(&self, j: usize) -> Option<&T> {
        self.keep.as_ref().map(|keep| &keep[j])
    }
}

/// Compares the times at which two falling corners reach the ground: the sign of t_i − t_j, t = −p/v, of velocities
/// below 0.
#[inline]
pub(super) fn sooner<T: Number>(v: &[T; 4], p: &[T; 4], i: usize, j: usize) -> Option<Ordering> {
    p[j].times(&v[i]).minus(&p[i].times(&v[j])).sign()
}

/// Digits of a float that a ball is made of.
pub(super) trait Digits:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Into<f64>
{
    /// Bound on the rounding of an operation, over its result.
    const UNIT: f64;
    fn of(x: Dd) -> Self;
    fn wide(self) -> Dd;
}

impl Digits for f64 {
    const UNIT: f64 = 1.2e-16;
    #[inline]
    fn of(x: Dd) -> Self {
        x.hi
    }
    #[inline]
    fn wide(self) -> Dd {
        Dd::from(self)
    }
}

impl Digits for Dd {
    /// 2⁻¹⁰⁰.
    const UNIT: f64 = 7.9e-31;
    #[inline]
    fn of(x: Dd) -> Self {
        x
    }
    #[inline]
    fn wide(self) -> Dd {
        self
    }
}

/// A number within `off` of `middle`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ball<M> {
    pub(super) middle: M,
    pub(super) off: f64,
}

/// Factor for the rounding of the sums of errors themselves.
const ROUNDED: f64 = 1.0 + 1e-14;

impl<M: Digits> Ball<M> {
    #[inline]
    fn rounded(middle: M, off: f64) -> Self {
        let size: f64 = middle.into();
        Self { middle, off: (off + M::UNIT * size.abs()) * ROUNDED }
    }
    /// Creates the ball of a double-double with at most this error.
    fn of(x: Dd, off: f64) -> Self {
        Self::rounded(M::of(x), off)
    }
}

impl<M: Digits> Number for Ball<M> {
    #[inline]
    fn exactly(x: f64) -> Self {
        Self { middle: M::of(Dd::from(x)), off: 0.0 }
    }
    #[inline]
    fn plus(&self, o: &Self) -> Self {
        Self::rounded(self.middle + o.middle, self.off + o.off)
    }
    #[inline]
    fn minus(&self, o: &Self) -> Self {
        Self::rounded(self.middle - o.middle, self.off + o.off)
    }
    #[inline]
    fn times(&self, o: &Self) -> Self {
        let (a, b): (f64, f64) = (self.middle.into(), o.middle.into());
        Self::rounded(self.middle * o.middle, a.abs() * o.off + b.abs() * self.off + self.off * o.off)
    }
    #[inline]
    fn sign(&self) -> Option<Ordering> {
        let x: f64 = self.middle.into();
        if x > self.off {
            Some(Ordering::Greater)
        } else if x < -self.off {
            Some(Ordering::Less)
        } else {
            None // also an exact zero: a tie takes whole numbers
        }
    }
    fn over(&self, o: &Self) -> Dd {
        self.middle.wide() / o.middle.wide()
    }
    fn strikes(plate: &Plate) -> Strikes<Self> {
        let (coupling, e) = (plate.coupling(), plate.e());
        let jump = std::array::from_fn(|j| {
            let own = coupling[j][j].0;
            coupling[j].map(|(w, size)| Self::of(two_sum(1.0, e) * (w / own), 16.0 * Dd::UNIT * size / own.hi))
        });
        Strikes { keep: None, jump, rebound: [Self::exactly(e); 4] }
    }
}

impl Number for Dyadic {
    fn exactly(x: f64) -> Self {
        Self::from(x).odd()
    }
    fn plus(&self, o: &Self) -> Self {
        self.add(o)
    }
    fn minus(&self, o: &Self) -> Self {
        self.sub(o)
    }
    fn times(&self, o: &Self) -> Self {
        self.mul(o)
    }
    fn sign(&self) -> Option<Ordering> {
        Some(Self::sign(self))
    }
    fn over(&self, o: &Self) -> Dd {
        let ((x, of_x), (d, of_d)) = (self.to_wide(), o.to_wide());
        let shift = clamp(of_x - of_d);
        let Dd { hi, lo } = x / d;
        Dd { hi: ldexp(hi, shift), lo: ldexp(lo, shift) }
    }
    fn strikes(plate: &Plate) -> Strikes<Self> {
        let (coupling, e) = (plate.exact_coupling(), Self::exactly(plate.e()));
        let more = Self::exactly(1.0).plus(&e);
        let keep: [Self; 4] = std::array::from_fn(|j| coupling[j][j].clone());
        let jump = std::array::from_fn(|j| std::array::from_fn(|i| more.mul(&coupling[j][i])));
        let rebound = std::array::from_fn(|j| e.mul(&keep[j]));
        Strikes { keep: Some(keep), jump, rebound }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Computes the same sums and products in any kind of numbers.
    fn form<T: Number>(x: &[f64]) -> T {
        let terms: Vec<T> = x.iter().map(|x| T::exactly(*x)).collect();
        terms.iter().skip(1).enumerate().fold(terms[0].clone(), |sum, (k, term)| match k % 3 {
            0 => sum.times(term),
            1 => sum.plus(term),
            _ => term.minus(&sum.times(term)),
        })
    }

    fn holds<M: Digits>(ball: Ball<M>, exact: &Dyadic) -> bool {
        let Dd { hi, lo } = ball.middle.wide();
        let off = Dyadic::from(hi).plus(&Dyadic::from(lo)).minus(exact);
        let most = Dyadic::from(ball.off);
        [off.plus(&most), most.minus(&off)].iter().all(|x| Dyadic::sign(x) != Ordering::Less)
    }

    proptest! {
        #[test]
        fn a_ball_holds_the_exact_number(x in prop::collection::vec(-2.0..2.0_f64, 2..12)) {
            let exact: Dyadic = form(&x);
            let (plain, wide): (Ball<f64>, Ball<Dd>) = (form(&x), form(&x));
            prop_assert!(holds(plain, &exact) && holds(wide, &exact), "{plain:?}, {wide:?}");
            prop_assert!(wide.off < 1e-25, "{wide:?}");
            for sign in [plain.sign(), wide.sign()].into_iter().flatten() {
                prop_assert_eq!(sign, Dyadic::sign(&exact));
            }
        }

        /// It covers numbers that cancel to 0, and to next to 0.
        #[test]
        fn no_sign_is_told_that_is_not_certain(x in 0.1..2.0_f64, y in 0.1..2.0_f64) {
            prop_assert_eq!(form::<Ball<f64>>(&[x, y]).minus(&form(&[y, x])).sign(), None);
            let exact = form::<Dyadic>(&[x, y]).minus(&form(&[y, x]));
            prop_assert_eq!(Dyadic::sign(&exact), Ordering::Equal);
        }
    }
}
