//! The bar: how its mass lies and how its ends rebound.

use crate::Error;
use crate::dd::{Dd, power_of_two, two_prod, two_sum};
use crate::exact::{Dyadic, clamp};

/// Coefficient of restitution of an end, in [0, 1]: departure speed over approach speed.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct Restitution(f64);

impl Restitution {
    /// A coefficient of restitution.
    ///
    /// # Errors
    /// [`Error::Restitution`] unless 0 ≤ e ≤ 1; −0 counts as 0.
    #[inline]
    pub fn new(e: f64) -> Result<Self, Error> {
        if (0.0..=1.0).contains(&e) { Ok(Self(e + 0.0)) } else { Err(Error::Restitution(e)) }
    }
    /// The value.
    #[must_use]
    pub fn get(self) -> f64 {
        self.0
    }
}

/// A piece of mass on the bar, for [`Bar::from_masses`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mass {
    /// A point mass.
    Point {
        /// Mass in kg.
        mass_kg: f64,
        /// Distance from the middle of the bar, towards end b positive, in m; it may lie beyond an end.
        position_m: f64,
    },
    /// A slab whose mass is spread evenly along the bar.
    Slab {
        /// Mass in kg.
        mass_kg: f64,
        /// Where it begins, from the middle of the bar, in m.
        from_m: f64,
        /// Where it ends; not before it begins.
        to_m: f64,
    },
}

impl Mass {
    /// Mass, and where it begins and ends.
    pub(crate) fn parts(&self) -> Result<(f64, f64, f64), Error> {
        let (m, from, to) = match *self {
            Self::Point { mass_kg, position_m } => (mass_kg, place(position_m)?, position_m),
            Self::Slab { mass_kg, from_m, to_m } => {
                let (from, to) = (place(from_m)?, place(to_m)?);
                if to < from {
                    let allowed = "at or beyond where the slab begins";
                    return Err(Error::Quantity { name: "end of slab (m)", value: to, allowed });
                }
                (mass_kg, from, to)
            }
        };
        Ok((positive("mass (kg)", m)?, from, to))
    }
}

/// What the inertia was given as: kept, because rounding it to a q would lose digits near q = 1, and because the
/// last word on a count is spoken in integers.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Given {
    /// The inertia ratio itself.
    InertiaRatio,
    /// k² = (ρ/L)² as a quotient of products.
    GyrationSquared { over: [f64; 2], under: [f64; 3] },
    /// The bar stands for one that is not symmetric, q = (L_a L_b − ρ²)/√(I_a I_b) with I = L² + ρ².
    OffCenter(OffCenter),
}

/// Distances of ends a and b to the center of mass, each the sum of two floats, and radius of gyration about it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct OffCenter {
    pub(crate) arms: [Dd; 2],
    pub(crate) rho: f64,
}

/// What a strike at an end of an off-center bar depends on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Moments {
    /// I = L² + ρ² of both ends.
    pub(crate) inertia: [Dd; 2],
    /// P = L_a L_b − ρ², to a relative 2⁻¹⁰², and 0 only where it is.
    pub(crate) excess: Dd,
    /// √(I_a I_b).
    pub(crate) root: Dd,
}

/// A rigid bar with symmetric mass that strikes the ground at its ends only.
///
/// Its whole behavior follows from the coefficient of restitution `e` and the inertia ratio
/// `q = (L² − ρ²)/(L² + ρ²)` of half-length L and radius of gyration ρ (paper, section 3): q = 1 has all mass at
/// the center, q = ½ is a uniform bar, q = 0 has all mass at the ends, q < 0 has mass beyond them.
///
/// # Examples
/// The paper's reference bar, uniform with moderate damping:
/// ```
/// let bar = clatter::Bar::new(0.5, 0.3)?;
/// let summary = bar.summary(&clatter::Start::default());
/// assert_eq!(summary.count, clatter::Count::Finite(4));
/// assert!((summary.peak.end - 2.145).abs() < 1e-12);
/// # Ok::<(), clatter::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bar {
    /// q rounded.
    q: f64,
    pub(crate) e: f64,
    /// q(1 + e) rounded.
    pub(crate) t: f64,
    /// 1 − q and 1 + q rounded, but not from a rounded q.
    pub(crate) less: f64,
    pub(crate) more: f64,
    given: Given,
}

impl Bar {
    /// From inertia ratio q and restitution e.
    ///
    /// # Errors
    /// [`Error::InertiaRatio`] unless −1 < q ≤ 1, [`Error::Restitution`] unless 0 ≤ e ≤ 1. NaN is neither.
    #[inline]
    pub fn new(q: f64, e: f64) -> Result<Self, Error> {
        if !(q > -1.0 && q <= 1.0) {
            return Err(Error::InertiaRatio(q));
        }
        let (q, e) = (q + 0.0, Restitution::new(e)?.get());
        Ok(Self { q, e, t: q + q * e, less: 1.0 - q, more: 1.0 + q, given: Given::InertiaRatio })
    }

    /// From k = ρ/L, radius of gyration over half-length: q = (1 − k²)/(1 + k²). No digit is lost near q = 1.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless k is 0 or in [1e−35, 1e35], [`Error::Restitution`] unless 0 ≤ e ≤ 1.
    ///
    /// # Examples
    /// So little mass at the ends that q rounds to 1, and yet the bar clatters a finite number of times:
    /// ```
    /// let bar = clatter::Bar::from_gyration_ratio(1e-9, 1.0)?;
    /// assert_eq!(bar.q(), 1.0);
    /// assert_eq!(bar.count(&clatter::Start::default()), clatter::Count::Finite(1_570_796_327));
    /// # Ok::<(), clatter::Error>(())
    /// ```
    pub fn from_gyration_ratio(k: f64, e: f64) -> Result<Self, Error> {
        Self::from_gyration_squared([k, k], [1.0; 3], e)
    }

    /// From half-length and radius of gyration, in the same unit.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless the half-length is in [1e−25, 1e25], the radius is 0 or in that range and so is k in
    /// its own, [`Error::Restitution`] unless 0 ≤ e ≤ 1.
    pub fn from_gyration_radius(half_length: f64, radius_of_gyration: f64, e: f64) -> Result<Self, Error> {
        let l = positive("half-length", half_length)?;
        let rho = if radius_of_gyration == 0.0 { 0.0 } else { positive("radius of gyration", radius_of_gyration)? };
        Self::from_gyration_squared([rho, rho], [l, l, 1.0], e)
    }

    /// From mass, length from end to end and moment of inertia about the center: k² = 4J/(m (2L)²).
    ///
    /// # Errors
    /// [`Error::Quantity`] unless mass and length are in [1e−25, 1e25], the moment is 0 or in that range and k in its
    /// own, [`Error::Restitution`] unless 0 ≤ e ≤ 1.
    ///
    /// # Examples
    /// A uniform bar has J = m (2L)²/12, hence q = ½:
    /// ```
    /// let bar = clatter::Bar::from_moment_of_inertia(1.2, 0.5, 1.2 * 0.25 / 12.0, 0.3)?;
    /// assert!((bar.q() - 0.5).abs() < 1e-15);
    /// # Ok::<(), clatter::Error>(())
    /// ```
    pub fn from_moment_of_inertia(mass_kg: f64, length_m: f64, moment_kg_m2: f64, e: f64) -> Result<Self, Error> {
        let (m, l) = (positive("mass (kg)", mass_kg)?, positive("length (m)", length_m)?);
        let j = if moment_kg_m2 == 0.0 { 0.0 } else { positive("moment of inertia (kg m²)", moment_kg_m2)? };
        Self::from_gyration_squared([j, 4.0], [m, l, l], e)
    }

    /// From the masses along a bar of given length, whose center of mass must be the middle.
    ///
    /// # Accuracy
    /// Sums and products are rounded as f64; k² of the sums then loses no more. The center of mass counts as the middle
    /// where it is off by no more than roundings of the positions: 8 ε a mass, of the half-length or of where the mass
    /// reaches beyond it.
    ///
    /// # Errors
    /// [`Error::NoMass`] for an empty list, [`Error::OffCenter`] where the center of mass is not the middle,
    /// [`Error::Quantity`] where the length or a mass is not in [1e−25, 1e25], a position is beyond ±1e25 or a slab
    /// ends before it begins, [`Error::Restitution`] unless 0 ≤ e ≤ 1.
    ///
    /// # Examples
    /// Half the mass spread evenly, half at the center: ρ² = L²/6, q = 5/7.
    /// ```
    /// use clatter::{Bar, Mass};
    /// let slab = Mass::Slab { mass_kg: 0.1, from_m: -0.07, to_m: 0.07 };
    /// let battery = Mass::Point { mass_kg: 0.1, position_m: 0.0 };
    /// let bar = Bar::from_masses(0.14, &[slab, battery], 0.3)?;
    /// assert!((bar.q() - 5.0 / 7.0).abs() < 1e-14);
    /// # Ok::<(), clatter::Error>(())
    /// ```
    pub fn from_masses(length_m: f64, masses: &[Mass], e: f64) -> Result<Self, Error> {
        let length = positive("length (m)", length_m)?;
        let (mut mass, mut first, mut size, mut second) = (0.0, 0.0, 0.0, 0.0);
        for piece in masses {
            let (m, from, to) = piece.parts()?;
            // A slab is a point mass at its middle plus its own moment m w²/12.
            let (x, width) = (0.5 * from + 0.5 * to, to - from);
            mass += m;
            first += m * x;
            size += m * from.abs().max(to.abs()).max(0.5 * length);
            second += m * (x * x + width * width / 12.0);
        }
        if masses.is_empty() {
            return Err(Error::NoMass);
        }
        #[expect(clippy::cast_precision_loss, reason = "a count of roundings")]
        let roundings = 8.0 * f64::EPSILON * masses.len() as f64;
        if first.abs() > roundings * size {
            return Err(Error::OffCenter { offset: 2.0 * first / (mass * length) });
        }
        // Less than that only roundings of a position leave.
        let second = if second < 1e-75 { 0.0 } else { second };
        Self::from_gyration_squared([second, 4.0], [mass, length, length], e)
    }

    /// k² = over/under, every product within the range of floats.
    fn from_gyration_squared(over: [f64; 2], under: [f64; 3], e: f64) -> Result<Self, Error> {
        let e = Restitution::new(e)?.get();
        // Beyond, the count would exceed 2^120; nothing real comes near.
        let k = (over[0] / under[0]).sqrt() * (over[1] / under[1] / under[2]).sqrt();
        if k != 0.0 && !(1e-35..=1e35).contains(&k) {
            return Err(Error::Quantity { name: "gyration ratio", value: k, allowed: "0 or in [1e-35, 1e35]" });
        }
        let given = Given::GyrationSquared { over, under };
        let ((n, d), two) = (terms(over, under), Dd::from(2.0));
        let (q, less, more) = (((d - n) / (d + n)).hi, (two * n / (d + n)).hi, (two * d / (d + n)).hi);
        Ok(Self { q, e, t: q + q * e, less, more, given })
    }

    /// The symmetric bar with the clatter of one whose ends are at different distances from its center of mass. They
    /// are sums of two floats, 10⁻⁶ to 10⁶ of each other; the radius is 0 or 10⁻¹² to 10⁶ times half their sum, which
    /// is about 1.
    pub(crate) fn off_center(given: OffCenter, moments: &Moments, e: Restitution) -> Self {
        let (e, q, one) = (e.get(), given.q(moments), Dd::from(1.0));
        // (1 − q)(1 + q) over the one of both that does not cancel.
        let product = given.less_more(moments);
        let [less, more] = if q.hi > 0.0 { [product / (one + q), one + q] } else { [one - q, product / (one - q)] };
        let given = Given::OffCenter(given);
        Self { q: q.hi, e, t: q.hi + q.hi * e, less: less.hi, more: more.hi, given }
    }

    /// An off-center bar with its ends exchanged.
    pub(crate) fn exchanged(self) -> Self {
        match self.given {
            Given::OffCenter(OffCenter { arms: [a, b], rho }) => {
                Self { given: Given::OffCenter(OffCenter { arms: [b, a], rho }), ..self }
            }
            Given::InertiaRatio | Given::GyrationSquared { .. } => self,
        }
    }

    /// Inertia ratio `q = (L² − ρ²)/(L² + ρ²)`, the negative ratio of the velocity jumps of the free and the
    /// struck end.
    #[must_use]
    pub fn q(&self) -> f64 {
        self.q
    }
    /// Coefficient of restitution.
    #[must_use]
    pub fn e(&self) -> f64 {
        self.e
    }
    /// k = ρ/L, the radius of gyration over the half-length: `√((1 − q)/(1 + q))`, relative error below 1e−15.
    #[must_use]
    pub fn gyration_ratio(&self) -> f64 {
        (self.less / self.more).sqrt()
    }
    /// Distance p/L = k² from the center of mass to the center of percussion of the other side's end, over the
    /// half-length: the point that feels nothing of a strike at the other end (paper, section 3).
    #[must_use]
    pub fn percussion(&self) -> f64 {
        self.less / self.more
    }
    /// Share of the shock at a struck end that reaches signed position `s` (the struck end is at s = 1):
    /// `((1 − q) + s (1 + q))/2` (Eq. 3).
    #[must_use]
    pub fn share(&self, s: f64) -> f64 {
        0.5 * (self.less + s * self.more)
    }

    /// q to about 2⁻¹⁰⁰.
    pub(crate) fn wide_q(&self) -> Dd {
        match self.given {
            Given::InertiaRatio => Dd::from(self.q),
            Given::GyrationSquared { over, under } => {
                let (n, d) = terms(over, under);
                (d - n) / (d + n)
            }
            Given::OffCenter(given) => given.q(&given.moments()),
        }
    }

    /// (1 − q)(1 + q) to a relative 2⁻¹⁰⁰: with k² = n/d, 4nd/(d + n)².
    pub(crate) fn wide_less_more(&self) -> Dd {
        match self.given {
            Given::InertiaRatio => two_sum(1.0, -self.q) * two_sum(1.0, self.q),
            Given::GyrationSquared { over, under } => {
                let (n, d) = terms(over, under);
                n * d * 4.0 / (d + n).sqr()
            }
            Given::OffCenter(given) => given.less_more(&given.moments()),
        }
    }

    /// q as a quotient of whole numbers.
    pub(crate) fn exact_q(&self) -> Ratio {
        let ratio = |mu: Dyadic, nu: Dyadic| Ratio { mu, square: nu.mul(&nu), beside: nu.clone(), nu };
        match self.given {
            Given::InertiaRatio => ratio(Dyadic::from(self.q), Dyadic::from(1.0)),
            Given::GyrationSquared { over, under } => {
                let product = |f: &[f64]| f.iter().fold(Dyadic::from(1.0), |p, &x| p.mul(&Dyadic::from(x)));
                let (n, d) = (product(&over), product(&under));
                ratio(d.sub(&n), d.add(&n))
            }
            Given::OffCenter(given) => {
                let ([a, b], square) = (given.arms.map(Dyadic::from), Dyadic::from(two_prod(given.rho, given.rho)));
                let [i_a, i_b] = [&a, &b].map(|arm| arm.mul(arm).add(&square));
                let nu = Dyadic::from(given.moments().root);
                Ratio { mu: a.mul(&b).sub(&square), square: i_a.mul(&i_b), beside: i_a, nu }
            }
        }
    }
}

/// q = μ/ν with whole numbers μ and ν². So is ν, but for an off-center bar: then it is the root of I_a I_b.
pub(crate) struct Ratio {
    pub(crate) mu: Dyadic,
    /// ν².
    pub(crate) square: Dyadic,
    /// What the velocity of end b counts beside μ times that of end a: ν, or I_a of an off-center bar.
    pub(crate) beside: Dyadic,
    /// ν; of an off-center bar rounded to about 2⁻¹⁰⁰.
    pub(crate) nu: Dyadic,
}

impl Ratio {
    /// `2^shift x/ν`.
    pub(crate) fn over_nu(&self, x: &Dyadic, shift: i32) -> Dd {
        quotient(x, &self.nu, shift)
    }
    /// `2^shift x/ν²`.
    pub(crate) fn over_square(&self, x: &Dyadic, shift: i32) -> Dd {
        quotient(x, &self.square, shift)
    }
}

/// `2^shift x/d` as a double-double.
fn quotient(x: &Dyadic, d: &Dyadic, shift: i32) -> Dd {
    let ((x, of_x), (d, of_d)) = (x.to_wide(), d.to_wide());
    (x / d).scale(clamp(of_x - of_d + i128::from(shift)))
}

impl OffCenter {
    pub(crate) fn moments(&self) -> Moments {
        let Self { arms: [a, b], rho } = *self;
        let (square, cross) = (two_prod(rho, rho), [two_prod(a.hi, b.lo), two_prod(a.lo, b.hi)]);
        let low = cross[0].lo + cross[1].lo + a.lo * b.lo;
        let mut excess = two_prod(a.hi, b.hi) - square + two_sum(cross[0].hi, cross[1].hi) + Dd::from(low);
        // Where more cancels, the low parts do.
        if excess.hi.abs() <= power_of_two(-40) * square.hi {
            let [a, b, square] = [a, b, square].map(Dyadic::from);
            let (high, exponent) = a.mul(&b).sub(&square).to_wide();
            excess = high.scale(clamp(exponent));
        }
        let inertia = [a, b].map(|arm| arm.sqr() + square);
        Moments { inertia, excess, root: (inertia[0] * inertia[1]).sqrt() }
    }

    /// P/√(I_a I_b).
    fn q(&self, moments: &Moments) -> Dd {
        if self.rho == 0.0 { Dd::from(1.0) } else { moments.excess / moments.root }
    }

    /// (1 − q)(1 + q) = ρ² (L_a + L_b)²/(I_a I_b).
    fn less_more(&self, Moments { inertia, .. }: &Moments) -> Dd {
        let [a, b] = self.arms;
        two_prod(self.rho, self.rho) * (a + b).sqr() / (inertia[0] * inertia[1])
    }
}

/// Numerator and denominator of k².
fn terms(over: [f64; 2], under: [f64; 3]) -> (Dd, Dd) {
    (two_prod(over[0], over[1]), two_prod(under[0], under[1]) * under[2])
}

/// A length or mass of a size whose products stay within the range of floats.
pub(crate) fn positive(name: &'static str, value: f64) -> Result<f64, Error> {
    let allowed = "in [1e-25, 1e25]";
    if (1e-25..=1e25).contains(&value) { Ok(value) } else { Err(Error::Quantity { name, value, allowed }) }
}

fn place(value: f64) -> Result<f64, Error> {
    let allowed = "in [-1e25, 1e25]";
    if value.abs() <= 1e25 { Ok(value) } else { Err(Error::Quantity { name: "position (m)", value, allowed }) }
}
