//! The bar: the distribution of its mass and the restitution of its ends. A center of mass off the middle is reduced to
//! the middle.
//!
//! With ends at distances L_a and L_b from the center of mass, radius of gyration ρ, `I = L² + ρ²` and
//! `P = L_a L_b − ρ²`, a strike at end a of velocity u changes the velocities of the ends by
//!
//! ```text
//! Δv_a = −(1 + e) u,   Δv_b = q_a (1 + e) u,   q_a = P/I_a;   at end b likewise with q_b = P/I_b
//! ```
//!
//! Let a_n be the velocity of the end about to strike, and `κ = √(I_a/I_b)`. Then y_n = a_n for n even (end a) and κ
//! a_n for n odd (end b) obeys the recurrence of the symmetric bar with
//!
//! ```text
//! q = P/√(I_a I_b) = ±√(q_a q_b),   start (v_a, κ v_b),   height gap κ h0
//! ```
//!
//! because κ q_a = q = q_b/κ. Heights scale with velocities, so times are the same. Every closed form of the symmetric
//! bar holds.
//!
//! # Precision
//! q and κ are irrational as a rule, and are formed with twice the digits of a float; 1 − q² = ρ² (L_a + L_b)²/(I_a
//! I_b) keeps its digits however close q is to 1. The decisions are rational all the same: with c_0 = v_a, c_1 = I_a
//! a_1, c_2 = I_a I_b a_2 and so on the velocities obey
//!
//! ```text
//! c_{n+1} = P (1 + e) c_n − e I_a I_b c_{n−1},   c_1 = P (1 + e) v_a + I_a v_b
//! ```
//!
//! where every given value is a float. So the count is as exact as that of the symmetric bar, for the arms, the radius
//! of gyration and the velocities as given: digits first, whole numbers where they leave a doubt. Masses are another
//! matter: their center and radius of gyration are rounded sums, and the count is that of the bar with these.
//! [`Bar::count_is_exact`] returns whether it is also that of the masses.

use crate::dd::{Dd, two_sum};
use crate::mass::{SUMS, center_of, parts, positive, reach, roundings};
use crate::symmetric::{Moments, OffCenter, Symmetric};
use crate::{Count, End, Error, Mass, Start};

/// Coefficient of restitution of an end, in [0, 1]: departure speed over approach speed.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(try_from = "f64", into = "f64"))]
pub struct Restitution(f64);

impl Restitution {
    /// Creates a coefficient of restitution.
    ///
    /// # Errors
    /// [`Error::Restitution`] unless 0 ≤ e ≤ 1; −0 counts as 0.
    #[inline]
    pub fn new(e: f64) -> Result<Self, Error> {
        if (0.0..=1.0).contains(&e) { Ok(Self(e + 0.0)) } else { Err(Error::Restitution(e)) }
    }
    /// Returns the value.
    #[must_use]
    pub fn get(self) -> f64 {
        self.0
    }
}

/// A rigid bar with its center of mass anywhere between its ends, which alone strike the ground.
///
/// Positions s run from −1 (end a) to 1 (end b), with the middle of the bar, not its center of mass, at 0; velocities
/// are in v0, changes of angular velocity in v0/L with L half the length.
///
/// With the center of mass in the middle its whole behavior follows from the coefficient of restitution `e` and the
/// inertia ratio `q = (L² − ρ²)/(L² + ρ²)` of half-length L and radius of gyration ρ (paper, section 3): q = 1 has all
/// mass at the center, q = ½ is a uniform bar, q = 0 has all mass at the ends, q < 0 has mass beyond them. Elsewhere
/// each end has an inertia ratio of its own.
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
/// The center of mass near end a: a strike there whips end b, on the long arm.
/// ```
/// use clatter::{Bar, Start};
/// let bar = Bar::from_arms([1.0, 5.0], 1.0, 0.3)?;
/// let [q_a, q_b] = bar.inertia_ratios();
/// assert!((q_a - 2.0).abs() < 1e-15); // (1·5 − 1)/(1 + 1): end b jumps twice as much as end a, which strikes
/// assert!((q_b - 4.0 / 26.0).abs() < 1e-15);
/// assert!((bar.q() - (q_a * q_b).sqrt()).abs() < 1e-15);
/// let first = bar.train(&Start::default()).next().unwrap();
/// assert!((first.delta_v[1] + 2.6).abs() < 1e-15);
/// # Ok::<(), clatter::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bar {
    /// The symmetric bar with the same clatter.
    pub(crate) symmetric: Symmetric,
    /// √(I_a/I_b).
    kappa: Dd,
    /// The largest error of the center of mass and of the radius of gyration, in half-lengths: 0 where they are given.
    rounded: f64,
    /// Position of the center of mass, c.
    offset: f64,
    /// q of each end.
    ratios: [f64; 2],
    /// Share of a strike at a and b that the center of mass gets, ρ²/I.
    pub(crate) center: [f64; 2],
    /// Change of angular velocity by the same strike, L/I in half-lengths, (1 + q)/2.
    pub(crate) turn: [f64; 2],
}

impl Bar {
    /// Creates a bar from inertia ratio q and restitution e, with the center of mass in the middle.
    ///
    /// # Errors
    /// [`Error::InertiaRatio`] unless −1 < q ≤ 1, [`Error::Restitution`] unless 0 ≤ e ≤ 1. NaN is neither.
    #[inline]
    pub fn new(q: f64, e: f64) -> Result<Self, Error> {
        if !(q > -1.0 && q <= 1.0) {
            return Err(Error::InertiaRatio(q));
        }
        Ok(Self::centered(Symmetric::from_inertia_ratio(q + 0.0, Restitution::new(e)?)))
    }

    /// Creates a bar from k = ρ/L, radius of gyration over half-length: q = (1 − k²)/(1 + k²). No digit is lost near q
    /// = 1.
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

    /// Creates a bar from half-length and radius of gyration, in the same unit.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless the half-length is in [1e−25, 1e25], the radius is 0 or in that range and so is k in
    /// its own, [`Error::Restitution`] unless 0 ≤ e ≤ 1.
    pub fn from_gyration_radius(half_length: f64, radius_of_gyration: f64, e: f64) -> Result<Self, Error> {
        let l = positive("half-length", half_length)?;
        let rho = if radius_of_gyration == 0.0 { 0.0 } else { positive("radius of gyration", radius_of_gyration)? };
        Self::from_gyration_squared([rho, rho], [l, l, 1.0], e)
    }

    /// Creates a bar from mass, length from end to end and moment of inertia about the center: k² = 4J/(m (2L)²).
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

    /// Creates a bar from the distances of ends a and b to the center of mass and the radius of gyration about it, in
    /// one unit, and the restitution.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless both arms are in [1e−25, 1e25] and at most 10⁶ times one another, and the radius is 0
    /// or in [1e−25, 1e25] and 10⁻¹² to 10⁶ times half their sum; [`Error::Restitution`] unless 0 ≤ e ≤ 1.
    pub fn from_arms([a, b]: [f64; 2], radius_of_gyration: f64, e: f64) -> Result<Self, Error> {
        let (a, b) = (positive("arm of end a", a)?, positive("arm of end b", b)?);
        let rho = radius_of_gyration + 0.0;
        if rho != 0.0 {
            positive("radius of gyration", rho)?;
        }
        if a - b == 0.0 {
            return Self::from_gyration_radius(a, rho, e);
        }
        // The power of 2 below the longer arm, as a unit that rounds nothing.
        let unit = f64::from_bits(a.max(b).to_bits() & f64::INFINITY.to_bits());
        Self::reduced([a, b].map(|arm| Dd::from(arm / unit)), (a - b) / (a + b), rho / unit, e)
    }

    /// Creates a bar from the position of the center of mass, −1 < c < 1, and the gyration ratio k = ρ/L, the radius of
    /// gyration about the center of mass over half the length.
    ///
    /// # Errors
    /// The errors of [`Bar::from_arms`] with arms 1 + c and 1 − c.
    ///
    /// # Examples
    /// ```
    /// let bar = clatter::Bar::from_center_of_mass(0.2, 0.5, 0.3)?;
    /// let same = clatter::Bar::from_arms([1.2, 0.8], 0.5, 0.3)?;
    /// assert!((bar.center_of_mass() - same.center_of_mass()).abs() < 1e-16);
    /// # Ok::<(), clatter::Error>(())
    /// ```
    pub fn from_center_of_mass(c: f64, k: f64, e: f64) -> Result<Self, Error> {
        if !(c > -1.0 && c < 1.0) {
            return Err(Error::Quantity { name: "center of mass", value: c, allowed: "in (-1, 1), between the ends" });
        }
        if c == 0.0 {
            return Self::from_gyration_ratio(k, e);
        }
        Self::reduced([two_sum(1.0, c), two_sum(1.0, -c)], c, k + 0.0, e)
    }

    /// Creates a bar from the masses along a given length; their center of mass may lie anywhere between the ends.
    ///
    /// # Accuracy
    /// Sums and products are rounded as f64; k² of the sums then loses no more. The center of mass counts as the middle
    /// where it is off by no more than roundings of the positions: 8 ε a mass, of the half-length or of the reach of a
    /// mass beyond it.
    ///
    /// # Errors
    /// [`Error::NoMass`] for an empty list, [`Error::Quantity`] where the length or a mass is not in [1e−25, 1e25], a
    /// position is beyond ±1e25 or a slab ends before it begins, and those of [`Bar::from_center_of_mass`].
    ///
    /// # Examples
    /// A uniform bar of 100 g and a battery of 50 g halfway to end b: the center of mass is at 1/6. With 100 g in the
    /// middle instead, ρ² = L²/6 and q = 5/7.
    /// ```
    /// use clatter::{Bar, Mass};
    /// let board = Mass::Slab { mass_kg: 0.1, from_m: -0.07, to_m: 0.07 };
    /// let battery = Mass::Point { mass_kg: 0.05, position_m: 0.035 };
    /// let bar = Bar::from_masses(0.14, &[board, battery], 0.3)?;
    /// assert!((bar.center_of_mass() - 1.0 / 6.0).abs() < 1e-15);
    /// let battery = Mass::Point { mass_kg: 0.1, position_m: 0.0 };
    /// let bar = Bar::from_masses(0.14, &[board, battery], 0.3)?;
    /// assert!((bar.q() - 5.0 / 7.0).abs() < 1e-14);
    /// # Ok::<(), clatter::Error>(())
    /// ```
    pub fn from_masses(length_m: f64, masses: &[Mass], e: f64) -> Result<Self, Error> {
        let length = positive("length (m)", length_m)?;
        let (parts, half) = (parts(masses)?, 0.5 * length);
        let (mut mass, mut first, mut size, mut second) = (0.0, 0.0, 0.0, 0.0);
        for (m, from, to) in &parts {
            // A slab is a point mass at its middle plus its own moment m w²/12.
            let (x, width) = (0.5 * from + 0.5 * to, to - from);
            mass += m;
            first += m * x;
            size += m * from.abs().max(to.abs()).max(half);
            second += m * (x * x + width * width / 12.0);
        }
        let bar = if first.abs() > 8.0 * roundings(&parts) * size {
            let [center, gyration] = center_of(&parts);
            Self::from_center_of_mass(center / half, gyration / half, e)?
        } else {
            // A smaller sum is left by roundings of the positions alone.
            let second = if second < 1e-75 { 0.0 } else { second };
            Self::from_gyration_squared([second, 4.0], [mass, length, length], e)?
        };
        Ok(Self { rounded: SUMS * roundings(&parts) * (reach(&parts) / half).max(1.0), ..bar })
    }

    fn from_gyration_squared(over: [f64; 2], under: [f64; 3], e: f64) -> Result<Self, Error> {
        Symmetric::from_gyration_squared(over, under, e).map(Self::centered)
    }

    /// Creates the bar with its center of mass in the middle.
    #[inline]
    fn centered(symmetric: Symmetric) -> Self {
        let Symmetric { q, less, more, .. } = symmetric;
        let (ratios, center, turn) = ([q; 2], [0.5 * less; 2], [0.5 * more; 2]);
        Self { symmetric, kappa: Dd::from(1.0), rounded: 0.0, offset: 0.0, ratios, center, turn }
    }

    /// Creates a bar from arms, the offset that they mean, and the radius of gyration, all in one unit that is about
    /// half the length.
    fn reduced([a, b]: [Dd; 2], offset: f64, rho: f64, e: f64) -> Result<Self, Error> {
        let e = Restitution::new(e)?;
        let (ratio, half) = (a.hi / b.hi, 0.5 * (a.hi + b.hi));
        if !(1e-6..=1e6).contains(&ratio) {
            return Err(Error::Quantity { name: "ratio of the arms", value: ratio, allowed: "in [1e-6, 1e6]" });
        }
        let k = rho / half;
        if rho != 0.0 && !(1e-12..=1e6).contains(&k) {
            let allowed = "0 or in [1e-12, 1e6] half-lengths, for a center of mass off the middle";
            return Err(Error::Quantity { name: "radius of gyration", value: k, allowed });
        }
        let given = OffCenter { arms: [a, b], rho };
        let moments @ Moments { inertia, excess, root } = given.moments();
        Ok(Self {
            symmetric: Symmetric::from_off_center(given, &moments, e),
            kappa: inertia[0] / root,
            rounded: 0.0,
            offset,
            ratios: inertia.map(|i| excess.hi / i.hi),
            center: inertia.map(|i| rho * rho / i.hi),
            turn: [a.hi * half / inertia[0].hi, b.hi * half / inertia[1].hi],
        })
    }

    /// Returns the same bar with its ends exchanged.
    #[must_use]
    pub fn exchanged(&self) -> Self {
        let swap = |[a, b]: [f64; 2]| [b, a];
        Self {
            symmetric: self.symmetric.exchanged(),
            kappa: Dd::from(1.0) / self.kappa,
            rounded: self.rounded,
            offset: 0.0 - self.offset,
            ratios: swap(self.ratios),
            center: swap(self.center),
            turn: swap(self.turn),
        }
    }

    /// Returns this bar if its center of mass is the middle; some laws hold for such bars alone.
    ///
    /// # Errors
    /// [`Error::OffCenter`] where it is elsewhere.
    pub fn symmetric(&self) -> Result<&Self, Error> {
        if self.is_symmetric() { Ok(self) } else { Err(Error::OffCenter { offset: self.offset }) }
    }

    /// Returns the position of the center of mass, in (−1, 1): (L_a − L_b)/(L_a + L_b).
    #[must_use]
    pub fn center_of_mass(&self) -> f64 {
        self.offset
    }
    /// Returns the inertia ratios q_a and q_b: minus the velocity jump of the other end over that of the end that
    /// strikes. One of them may exceed 1.
    #[must_use]
    pub fn inertia_ratios(&self) -> [f64; 2] {
        self.ratios
    }
    /// Returns the inertia ratio: q = (L² − ρ²)/(L² + ρ²) where the center of mass is the middle, the negative ratio of
    /// the velocity jumps of the free and the struck end; else ±√(q_a q_b), that of the symmetric bar with the same
    /// clatter.
    #[must_use]
    pub fn q(&self) -> f64 {
        self.symmetric.q
    }
    /// Returns the coefficient of restitution.
    #[must_use]
    pub fn e(&self) -> f64 {
        self.symmetric.e
    }
    /// Returns k = ρ/L, radius of gyration about the center of mass over half the length.
    ///
    /// # Accuracy
    /// 1e−15 of itself.
    #[must_use]
    pub fn gyration_ratio(&self) -> f64 {
        self.symmetric.off_center().map_or_else(|| self.symmetric.gyration_ratio(), |given| given.rho / given.half())
    }
    /// Returns κ = √((L_a² + ρ²)/(L_b² + ρ²)), the weight of a velocity of end b relative to one of end a.
    #[must_use]
    pub fn kappa(&self) -> f64 {
        self.kappa.hi
    }
    /// Returns whether the center of mass is the middle.
    #[must_use]
    #[inline]
    pub fn is_symmetric(&self) -> bool {
        self.offset == 0.0
    }
    /// Returns the share of the shock at a struck end that reaches position s: `(ρ² ∓ L x)/(L² + ρ²)` at distance x
    /// from the center of mass towards b. 1 at the struck end itself, 0 at its center of percussion, −q at the other
    /// end; `((1 − q) ∓ s (1 + q))/2` where the center of mass is the middle (Eq. 3).
    #[must_use]
    pub fn share(&self, struck: End, s: f64) -> f64 {
        let x = s - self.offset;
        match struck {
            End::A => self.center[0] - self.turn[0] * x,
            End::B => self.center[1] + self.turn[1] * x,
        }
    }
    /// Returns the center of percussion of a struck end: the position that its strikes do not move, ρ²/L beyond the
    /// center of mass; ±k² where that is the middle (paper, section 3).
    #[must_use]
    pub fn percussion(&self, struck: End) -> f64 {
        match struck {
            End::A => self.offset + self.center[0] / self.turn[0],
            End::B => self.offset - self.center[1] / self.turn[1],
        }
    }

    /// Returns L_a and L_b over half the length, 1 + c and 1 − c.
    pub(crate) fn arms(&self) -> [f64; 2] {
        self.symmetric.off_center().map_or([1.0; 2], |given| given.arms.map(|arm| arm.hi / given.half()))
    }

    /// Returns the start in the variables of the symmetric bar.
    #[inline]
    pub(crate) fn arrival(&self, start: &Start) -> Start {
        if self.is_symmetric() { *start } else { start.with_b_times(self.kappa) }
    }

    /// Returns whether [`count`](Self::count) is proven to be the number of impacts of the bar as it was given.
    ///
    /// It is for every bar given by lengths, unless it is a float, [`Count::Huge`]. The center of mass and the radius of
    /// gyration of masses are rounded sums: there the count is proven where all bars within these roundings have the
    /// same.
    ///
    /// # Method
    /// The ratios of successive velocities are r_1 = T + κ v_b/v_a and r_{n+1} = T − e/r_n, and the train ends with the
    /// first that is not positive. They rise with T and with κ v_b/v_a, so the count does not fall. Two symmetric bars,
    /// one with the least q and the least κ v_b/v_a, the other with the largest, have the least and the largest count.
    #[must_use]
    pub fn count_is_exact(&self, start: &Start) -> bool {
        let count = self.count(start);
        !matches!(count, Count::Huge(_)) && (self.rounded == 0.0 || self.bounds_of_count(start) == Some([count; 2]))
    }

    /// Returns the least and the largest count of the bars that round to this one; `None` where some of them are no
    /// bars at all.
    fn bounds_of_count(&self, start: &Start) -> Option<[Count; 2]> {
        let (c, k, off) = (self.offset, self.gyration_ratio(), self.rounded);
        let ([low, high], away) = ([(k - off).max(0.0), k + off], c.abs());
        // κ = √(I_a/I_b) rises with c and comes closer to 1 as k rises; q falls where k or |c| rises.
        let kappa = |c: f64| [low, high].map(|k| libm::hypot(1.0 + c, k) / libm::hypot(1.0 - c, k));
        let ([a, b], [x, y]) = (kappa(c + off), kappa(c - off));
        let [least, most] = [x.min(y) * (1.0 - 8.0 * f64::EPSILON), a.max(b) * (1.0 + 8.0 * f64::EPSILON)];
        let bar = |c: f64, k: f64, factor: f64| {
            let bar = Self::from_center_of_mass(c, k, self.e()).ok()?;
            Self::from_gyration_ratio(bar.symmetric.gyration_ratio() * factor, self.e()).ok()
        };
        let [few, many] = [
            bar(away + off, high, 1.0 + 8.0 * f64::EPSILON)?,
            bar((away - off).max(0.0), low, 1.0 - 8.0 * f64::EPSILON)?,
        ];
        let [va, vb] = start.velocity();
        let [slow, fast] = if vb > 0.0 { [most, least] } else { [least, most] };
        let count = |bar: Self, kappa: f64| Some(bar.count(&Start::new([va, kappa * vb], 1.0).ok()?));
        Some([count(few, slow)?, count(many, fast)?])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::Dyadic;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4096))]

        /// q, 1 − q² and κ against whole numbers, by their squares, for arms and radii over the whole range and where P
        /// cancels.
        #[test]
        fn the_symmetric_bar_has_the_digits_it_is_said_to_have(
            arms in -6.0..6.0_f64, c in -0.99999..0.99999_f64, rho in -11.5..5.5_f64, given in prop::bool::ANY,
            near in prop::option::of(-3..4_i64), e in 0.0..=1.0_f64,
        ) {
            let (a, b) = if given { (1.0, 10f64.powf(arms)) } else { (1.0 + c, 1.0 - c) };
            // A radius for which P is as good as 0, or any.
            let none = f64::sqrt(a * b);
            let rho = near.map_or(0.5 * (a + b) * 10f64.powf(rho), |ulps| f64::from_bits(none.to_bits().wrapping_add_signed(ulps)));
            let made = if given { Bar::from_arms([a, b], rho, e) } else { Bar::from_center_of_mass(c, rho, e) };
            let Bar { symmetric: bar, kappa, .. } = made.unwrap();
            let whole = bar.exact_q();
            let squared = |x: &Dyadic| x.mul(x);
            let near = |got: Dyadic, want: Dyadic, bits: i128| {
                let (off, size) = (got.sub(&want).to_float(), want.to_float());
                off.0 == 0.0 || off.1 < size.1 - bits
            };
            let [q, less_more] = [bar.wide_q(), bar.wide_less_more()].map(Dyadic::from);
            prop_assert!(near(squared(&q).mul(&whole.square), squared(&whole.mu), 98), "q {}", bar.q);
            let rest = whole.square.sub(&squared(&whole.mu));
            prop_assert!(near(less_more.mul(&whole.square), rest, 98), "1 - q^2 = {}", bar.wide_less_more().hi);
            let square = squared(&Dyadic::from(kappa)).mul(&whole.square);
            prop_assert!(near(square, squared(&whole.factor_b), 98), "kappa {}", kappa.hi);
            // In floats q is rounded once, the others next to once.
            prop_assert_eq!(bar.q.partial_cmp(&0.0), Some(whole.mu.sign()), "sign of q");
            let product = Dyadic::from(bar.less).mul(&Dyadic::from(bar.more));
            prop_assert!(near(product, less_more, 51), "less {} more {}", bar.less, bar.more);
        }
    }
}
