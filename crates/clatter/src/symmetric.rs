//! The recurrence that every bar obeys, that of a symmetric bar: its numbers and their digits.

use crate::Error;
use crate::bar::Restitution;
use crate::dd::{Dd, power_of_two, two_prod, two_sum};
use crate::exact::{Dyadic, clamp};

/// The given form of the inertia. It is kept, because rounding it to a q would lose digits near q = 1, and because
/// integers decide the count in the end.
#[derive(Debug, Clone, Copy, PartialEq)]
enum GivenInertia {
    /// The inertia ratio itself.
    InertiaRatio,
    /// k² = (ρ/L)² as a quotient of products.
    GyrationSquared { over: [f64; 2], under: [f64; 3] },
    /// A bar that is not symmetric, q = (L_a L_b − ρ²)/√(I_a I_b) with I = L² + ρ².
    OffCenter(OffCenter),
}

/// Distances of ends a and b to the center of mass, each the sum of two floats, and radius of gyration about it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct OffCenter {
    pub(crate) arms: [Dd; 2],
    pub(crate) rho: f64,
}

/// Quantities that a strike at an end of an off-center bar depends on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Moments {
    /// I = L² + ρ² of both ends.
    pub(crate) inertia: [Dd; 2],
    /// P = L_a L_b − ρ², to a relative 2⁻¹⁰², and 0 only where it is.
    pub(crate) excess: Dd,
    /// √(I_a I_b).
    pub(crate) root: Dd,
}

/// The symmetric bar with the clatter of a [`Bar`](crate::Bar), which is it where the center of mass is the middle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Symmetric {
    /// q rounded.
    pub(crate) q: f64,
    pub(crate) e: f64,
    /// q(1 + e) rounded.
    pub(crate) t: f64,
    /// 1 − q and 1 + q rounded, but not from a rounded q.
    pub(crate) less: f64,
    pub(crate) more: f64,
    given: GivenInertia,
}

impl Symmetric {
    /// Creates the bar from an inertia ratio in (−1, 1].
    #[inline]
    pub(crate) fn from_inertia_ratio(q: f64, e: Restitution) -> Self {
        let e = e.get();
        Self { q, e, t: q + q * e, less: 1.0 - q, more: 1.0 + q, given: GivenInertia::InertiaRatio }
    }

    /// Creates the bar from k² = over/under, every product within the range of floats.
    pub(crate) fn from_gyration_squared(over: [f64; 2], under: [f64; 3], e: f64) -> Result<Self, Error> {
        let e = Restitution::new(e)?.get();
        // Beyond this range the count would exceed 2^120; nothing real comes near.
        let k = (over[0] / under[0]).sqrt() * (over[1] / under[1] / under[2]).sqrt();
        if k != 0.0 && !(1e-35..=1e35).contains(&k) {
            return Err(Error::Quantity { name: "gyration ratio", value: k, allowed: "0 or in [1e-35, 1e35]" });
        }
        let given = GivenInertia::GyrationSquared { over, under };
        let ((n, d), two) = (terms(over, under), Dd::from(2.0));
        let (q, less, more) = (((d - n) / (d + n)).hi, (two * n / (d + n)).hi, (two * d / (d + n)).hi);
        Ok(Self { q, e, t: q + q * e, less, more, given })
    }

    /// Creates the symmetric bar of one whose ends are at different distances from its center of mass. They are sums of
    /// two floats, 10⁻⁶ to 10⁶ of each other; the radius is 0 or 10⁻¹² to 10⁶ times half their sum, which is about 1.
    pub(crate) fn from_off_center(given: OffCenter, moments: &Moments, e: Restitution) -> Self {
        let (e, q, one) = (e.get(), given.q(moments), Dd::from(1.0));
        // (1 − q)(1 + q) over the one of both that does not cancel.
        let product = given.less_more(moments);
        let [less, more] = if q.hi > 0.0 { [product / (one + q), one + q] } else { [one - q, product / (one - q)] };
        let given = GivenInertia::OffCenter(given);
        Self { q: q.hi, e, t: q.hi + q.hi * e, less: less.hi, more: more.hi, given }
    }

    /// Returns an off-center bar with its ends exchanged.
    pub(crate) fn exchanged(self) -> Self {
        match self.given {
            GivenInertia::OffCenter(OffCenter { arms: [a, b], rho }) => {
                Self { given: GivenInertia::OffCenter(OffCenter { arms: [b, a], rho }), ..self }
            }
            GivenInertia::InertiaRatio | GivenInertia::GyrationSquared { .. } => self,
        }
    }

    /// Returns k of the symmetric bar, relative error below 1e−15.
    pub(crate) fn gyration_ratio(&self) -> f64 {
        (self.less / self.more).sqrt()
    }

    /// Returns the given lengths of an off-center bar.
    pub(crate) fn off_center(&self) -> Option<OffCenter> {
        if let GivenInertia::OffCenter(given) = self.given { Some(given) } else { None }
    }

    /// Returns q to about 2⁻¹⁰⁰.
    pub(crate) fn wide_q(&self) -> Dd {
        match self.given {
            GivenInertia::InertiaRatio => Dd::from(self.q),
            GivenInertia::GyrationSquared { over, under } => {
                let (n, d) = terms(over, under);
                (d - n) / (d + n)
            }
            GivenInertia::OffCenter(given) => given.q(&given.moments()),
        }
    }

    /// Returns (1 − q)(1 + q) to a relative 2⁻¹⁰⁰: 4nd/(d + n)² with k² = n/d.
    pub(crate) fn wide_less_more(&self) -> Dd {
        match self.given {
            GivenInertia::InertiaRatio => two_sum(1.0, -self.q) * two_sum(1.0, self.q),
            GivenInertia::GyrationSquared { over, under } => {
                let (n, d) = terms(over, under);
                n * d * 4.0 / (d + n).sqr()
            }
            GivenInertia::OffCenter(given) => given.less_more(&given.moments()),
        }
    }

    /// Returns q as a quotient of whole numbers.
    pub(crate) fn exact_q(&self) -> Ratio {
        let ratio = |mu: Dyadic, nu: Dyadic| Ratio { mu, square: nu.mul(&nu), factor_b: nu.clone(), nu };
        match self.given {
            GivenInertia::InertiaRatio => ratio(Dyadic::from(self.q), Dyadic::from(1.0)),
            GivenInertia::GyrationSquared { over, under } => {
                let product = |f: &[f64]| f.iter().fold(Dyadic::from(1.0), |p, &x| p.mul(&Dyadic::from(x)));
                let (n, d) = (product(&over), product(&under));
                ratio(d.sub(&n), d.add(&n))
            }
            GivenInertia::OffCenter(given) => {
                let ([a, b], square) = (given.arms.map(Dyadic::from), Dyadic::from(two_prod(given.rho, given.rho)));
                let [i_a, i_b] = [&a, &b].map(|arm| arm.mul(arm).add(&square));
                let nu = Dyadic::from(given.moments().root);
                Ratio { mu: a.mul(&b).sub(&square), square: i_a.mul(&i_b), factor_b: i_a, nu }
            }
        }
    }
}

/// q = μ/ν with whole numbers μ and ν². So is ν, but for an off-center bar: then it is the root of I_a I_b.
pub(crate) struct Ratio {
    pub(crate) mu: Dyadic,
    /// ν².
    pub(crate) square: Dyadic,
    /// Factor of the velocity of end b, where that of end a has μ: ν, or I_a of an off-center bar.
    pub(crate) factor_b: Dyadic,
    /// ν; of an off-center bar rounded to about 2⁻¹⁰⁰.
    pub(crate) nu: Dyadic,
}

impl Ratio {
    /// Returns `2^shift x/ν`.
    pub(crate) fn over_nu(&self, x: &Dyadic, shift: i32) -> Dd {
        quotient(x, &self.nu, shift)
    }
    /// Returns `2^shift x/ν²`.
    pub(crate) fn over_square(&self, x: &Dyadic, shift: i32) -> Dd {
        quotient(x, &self.square, shift)
    }
}

/// Returns `2^shift x/d` as a double-double.
fn quotient(x: &Dyadic, d: &Dyadic, shift: i32) -> Dd {
    let ((x, of_x), (d, of_d)) = (x.to_wide(), d.to_wide());
    (x / d).scale(clamp(of_x - of_d + i128::from(shift)))
}

impl OffCenter {
    /// Returns the half the length.
    pub(crate) fn half(&self) -> f64 {
        0.5 * (self.arms[0].hi + self.arms[1].hi)
    }

    pub(crate) fn moments(&self) -> Moments {
        let Self { arms: [a, b], rho } = *self;
        let (square, cross) = (two_prod(rho, rho), [two_prod(a.hi, b.lo), two_prod(a.lo, b.hi)]);
        let low = cross[0].lo + cross[1].lo + a.lo * b.lo;
        let mut excess = two_prod(a.hi, b.hi) - square + two_sum(cross[0].hi, cross[1].hi) + Dd::from(low);
        // Where the difference cancels more than that, integers form it.
        if excess.hi.abs() <= power_of_two(-40) * square.hi {
            let [a, b, square] = [a, b, square].map(Dyadic::from);
            let (high, exponent) = a.mul(&b).sub(&square).to_wide();
            excess = high.scale(clamp(exponent));
        }
        let inertia = [a, b].map(|arm| arm.sqr() + square);
        Moments { inertia, excess, root: (inertia[0] * inertia[1]).sqrt() }
    }

    /// Returns P/√(I_a I_b).
    fn q(&self, moments: &Moments) -> Dd {
        if self.rho == 0.0 { Dd::from(1.0) } else { moments.excess / moments.root }
    }

    /// Returns (1 − q)(1 + q) = ρ² (L_a + L_b)²/(I_a I_b).
    fn less_more(&self, Moments { inertia, .. }: &Moments) -> Dd {
        let [a, b] = self.arms;
        two_prod(self.rho, self.rho) * (a + b).sqr() / (inertia[0] * inertia[1])
    }
}

/// Returns numerator and denominator of k².
fn terms(over: [f64; 2], under: [f64; 3]) -> (Dd, Dd) {
    (two_prod(over[0], over[1]), two_prod(under[0], under[1]) * under[2])
}
