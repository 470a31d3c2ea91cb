//! A bar whose center of mass is not its middle, reduced to the symmetric one.
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
//! because κ q_a = q = q_b/κ. Heights go with velocities, so times are the same. Every closed form of [`Bar`] serves.
//!
//! # Precision
//! 1 − q² = ρ² (L_a + L_b)²/(I_a I_b) without cancellation, hence `k = ρ (L_a + L_b)/(√(I_a I_b) + P)` is the gyration
//! ratio of the symmetric bar, exact to a few roundings however close q is to 1; P itself is formed with twice the
//! digits. q is irrational as a rule: it and κ are rounded, to 4 ε of themselves (k: 8 ε). The count is exact for the
//! symmetric bar and start so rounded. For the bar as given it is that of a bar and start whose k, κ v_b and κ h0 are
//! off by so little: where two counts meet within that, either may come out.
//!
//! # The safest place
//! A strike at end a that changes the velocity there by A reaches a point at distance x from the center of mass
//! (towards b positive) with `A (ρ² − L_a x)/I_a`, one at end b with `B (ρ² + L_b x)/I_b`. With A and B the largest of
//! each end, the largest shock at x is f(x) = max(|A (ρ² − L_a x)|/I_a, |B (ρ² + L_b x)|/I_b), a convex function.
//! Between the two centers of percussion, x = −ρ²/L_b and ρ²/L_a, the first falls and the second rises, from 0 to 0 the
//! other way round, so they meet there, and where a falling and a rising piece of a convex function meet is its least
//! value:
//!
//! ```text
//! x = ρ² (α − β)/(α L_a + β L_b),   f(x) = α β ρ² (L_a + L_b)/(α L_a + β L_b),   α = A/I_a, β = B/I_b
//! ```
//!
//! If that is beyond an end, the end is the safest place, by convexity. The middle is safest only where α = β and
//! L_a = L_b: for a symmetric bar of which either end may strike first.

use crate::bar::positive;
use crate::dd::two_prod;
use crate::zone::shock;
use crate::{
    Bar, Count, End, EndPeaks, Error, Extent, Impact, Mass, Net, Peak, Restitution, Start, Summary, Train, Zone,
};

/// A rigid bar with its center of mass anywhere between its ends, which alone strike the ground.
///
/// Positions s run from −1 (end a) to 1 (end b), with the middle of the bar, not its center of mass, at 0; velocities
/// are in v0, changes of angular velocity in v0/L with L half the length, as for [`Bar`].
///
/// # Examples
/// The center of mass near end a: a strike there whips end b, on the long arm.
/// ```
/// use clatter::{OffCenterBar, Start};
/// let bar = OffCenterBar::new([1.0, 5.0], 1.0, 0.3)?;
/// let [q_a, q_b] = bar.inertia_ratios();
/// assert!((q_a - 2.0).abs() < 1e-15); // (1·5 − 1)/(1 + 1): end b jumps twice as much as end a, which strikes
/// assert!((q_b - 4.0 / 26.0).abs() < 1e-15);
/// assert!((bar.q() - (q_a * q_b).sqrt()).abs() < 1e-15);
/// let first = bar.train(&Start::default()).next().unwrap();
/// assert!((first.delta_v[1] + 2.6).abs() < 1e-15);
/// # Ok::<(), clatter::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OffCenterBar {
    /// The symmetric bar that it reduces to.
    bar: Bar,
    /// √(I_a/I_b).
    kappa: f64,
    /// Position of the center of mass, c.
    offset: f64,
    /// L_a and L_b over half the length, 1 + c and 1 − c.
    arms: [f64; 2],
    ratios: [f64; 2],
    /// q(1 + e) of each end: jump of the other end over the approach velocity.
    far: [f64; 2],
    /// Share of a strike at a and b that the center of mass gets, ρ²/I.
    center: [f64; 2],
    /// Change of angular velocity that it makes, L/I in half-lengths, (1 + q)/2.
    turn: [f64; 2],
}

impl From<Bar> for OffCenterBar {
    /// The symmetric bar, bit for bit.
    fn from(bar: Bar) -> Self {
        let (center, turn) = ([0.5 * bar.less; 2], [0.5 * bar.more; 2]);
        Self { bar, kappa: 1.0, offset: 0.0, arms: [1.0; 2], ratios: [bar.q(); 2], far: [bar.t; 2], center, turn }
    }
}

impl OffCenterBar {
    /// From the distances of ends a and b to the center of mass and the radius of gyration about it, in one unit, and
    /// the restitution.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless both arms are in [1e−25, 1e25] and at most 10⁶ times one another, and the radius is 0
    /// or in [1e−25, 1e25] and 10⁻¹² to 10⁶ times half their sum; [`Error::Restitution`] unless 0 ≤ e ≤ 1.
    pub fn new([a, b]: [f64; 2], radius_of_gyration: f64, e: f64) -> Result<Self, Error> {
        let (a, b) = (positive("arm of end a", a)?, positive("arm of end b", b)?);
        let rho = radius_of_gyration + 0.0;
        if rho != 0.0 {
            positive("radius of gyration", rho)?;
        }
        if a - b == 0.0 {
            return Ok(Self::from(Bar::from_gyration_radius(a, rho, e)?));
        }
        let half = 0.5 * (a + b);
        Self::reduced([a / half, b / half], (a - b) / (a + b), rho / half, e)
    }

    /// From the position of the center of mass, −1 < c < 1, and the gyration ratio k = ρ/L, the radius of gyration
    /// about the center of mass over half the length.
    ///
    /// # Errors
    /// As [`OffCenterBar::new`] with arms 1 + c and 1 − c.
    ///
    /// # Examples
    /// ```
    /// let bar = clatter::OffCenterBar::from_center_of_mass(0.2, 0.5, 0.3)?;
    /// let same = clatter::OffCenterBar::new([1.2, 0.8], 0.5, 0.3)?;
    /// assert!((bar.center_of_mass() - same.center_of_mass()).abs() < 1e-16);
    /// # Ok::<(), clatter::Error>(())
    /// ```
    pub fn from_center_of_mass(c: f64, k: f64, e: f64) -> Result<Self, Error> {
        if !(c > -1.0 && c < 1.0) {
            return Err(Error::Quantity { name: "center of mass", value: c, allowed: "in (-1, 1), between the ends" });
        }
        if c == 0.0 {
            return Ok(Self::from(Bar::from_gyration_ratio(k, e)?));
        }
        Self::reduced([1.0 + c, 1.0 - c], c, k + 0.0, e)
    }

    /// From the masses along a bar of given length, wherever their center of mass lies between the ends. One within
    /// roundings of the middle counts as the middle, as in [`Bar::from_masses`].
    ///
    /// # Errors
    /// Those of [`Bar::from_masses`] but [`Error::OffCenter`], and those of [`OffCenterBar::new`].
    ///
    /// # Examples
    /// A uniform bar of 100 g and a battery of 50 g halfway to end b: the center of mass is at 1/6.
    /// ```
    /// use clatter::{Mass, OffCenterBar};
    /// let board = Mass::Slab { mass_kg: 0.1, from_m: -0.07, to_m: 0.07 };
    /// let battery = Mass::Point { mass_kg: 0.05, position_m: 0.035 };
    /// let bar = OffCenterBar::from_masses(0.14, &[board, battery], 0.3)?;
    /// assert!((bar.center_of_mass() - 1.0 / 6.0).abs() < 1e-15);
    /// # Ok::<(), clatter::Error>(())
    /// ```
    pub fn from_masses(length_m: f64, masses: &[Mass], e: f64) -> Result<Self, Error> {
        match Bar::from_masses(length_m, masses, e) {
            Ok(bar) => Ok(Self::from(bar)),
            Err(Error::OffCenter { .. }) => {
                let [center, gyration] = center_and_gyration(masses)?;
                let half = 0.5 * length_m;
                Self::from_center_of_mass(center / half, gyration / half, e)
            }
            Err(error) => Err(error),
        }
    }

    /// From arms over half the length, the offset that they mean, and the radius of gyration over half the length.
    fn reduced([a, b]: [f64; 2], offset: f64, rho: f64, e: f64) -> Result<Self, Error> {
        let e = Restitution::new(e)?.get();
        if !(1e-6..=1e6).contains(&(a / b)) {
            return Err(Error::Quantity { name: "ratio of the arms", value: a / b, allowed: "in [1e-6, 1e6]" });
        }
        if rho != 0.0 && !(1e-12..=1e6).contains(&rho) {
            let allowed = "0 or in [1e-12, 1e6] half-lengths, for a center of mass off the middle";
            return Err(Error::Quantity { name: "radius of gyration", value: rho, allowed });
        }
        let product = (two_prod(a, b) - two_prod(rho, rho)).hi;
        let (far_a, far_b) = (libm::hypot(a, rho), libm::hypot(b, rho)); // √I
        let root = far_a * far_b;
        let q = product / root;
        let bar = if q.abs() < 0.5 {
            Bar::new(q, e)
        } else if q > 0.0 {
            Bar::from_gyration_ratio(2.0 * rho / (root + product), e)
        } else {
            Bar::from_gyration_ratio((root - product) / (2.0 * rho), e)
        }?;
        let inertia = [far_a * far_a, far_b * far_b];
        let ratios = inertia.map(|i| product / i);
        Ok(Self {
            bar,
            kappa: far_a / far_b,
            offset,
            arms: [a, b],
            ratios,
            far: ratios.map(|q| q + q * e),
            center: inertia.map(|i| rho * rho / i),
            turn: [a / inertia[0], b / inertia[1]],
        })
    }

    /// The same bar with its ends exchanged.
    #[must_use]
    pub fn exchanged(&self) -> Self {
        let swap = |[a, b]: [f64; 2]| [b, a];
        let (arms, ratios, far) = (swap(self.arms), swap(self.ratios), swap(self.far));
        Self {
            kappa: 1.0 / self.kappa,
            offset: 0.0 - self.offset,
            arms,
            ratios,
            far,
            center: swap(self.center),
            turn: swap(self.turn),
            ..*self
        }
    }

    /// Where the center of mass lies, in (−1, 1): (L_a − L_b)/(L_a + L_b).
    #[must_use]
    pub fn center_of_mass(&self) -> f64 {
        self.offset
    }
    /// Inertia ratios q_a and q_b: minus the velocity jump of the other end over that of the end that strikes. One of
    /// them may exceed 1.
    #[must_use]
    pub fn inertia_ratios(&self) -> [f64; 2] {
        self.ratios
    }
    /// Inertia ratio ±√(q_a q_b) of the symmetric bar with the same clatter.
    #[must_use]
    pub fn q(&self) -> f64 {
        self.bar.q()
    }
    /// Coefficient of restitution.
    #[must_use]
    pub fn e(&self) -> f64 {
        self.bar.e()
    }
    /// Radius of gyration about the center of mass over half the length.
    ///
    /// # Accuracy
    /// 1e−14.
    #[must_use]
    pub fn gyration_ratio(&self) -> f64 {
        if self.is_symmetric() {
            return self.bar.gyration_ratio();
        }
        // ρ²/I over L/I is ρ²/L.
        (self.center[0] / self.turn[0] * self.arms[0]).sqrt()
    }
    /// κ = √((L_a² + ρ²)/(L_b² + ρ²)): how much a velocity of end b counts beside one of end a.
    #[must_use]
    pub fn kappa(&self) -> f64 {
        self.kappa
    }
    /// Whether the center of mass is the middle.
    #[must_use]
    pub fn is_symmetric(&self) -> bool {
        self.offset == 0.0
    }
    /// Share of the shock at a struck end that reaches position s: `(ρ² ∓ L x)/(L² + ρ²)` at distance x from the center
    /// of mass towards b. 1 at the struck end itself, 0 at its center of percussion, −q at the other end.
    #[must_use]
    pub fn share(&self, struck: End, s: f64) -> f64 {
        let x = s - self.center_of_mass();
        match struck {
            End::A => self.center[0] - self.turn[0] * x,
            End::B => self.center[1] + self.turn[1] * x,
        }
    }

    /// How the symmetric bar arrives.
    fn reduce(&self, start: &Start) -> Start {
        start.with_b_times(self.kappa)
    }

    /// The impacts, one by one, end a first; as [`Bar::train`], with [`Impact::delta_v_at`] for any position.
    ///
    /// # Accuracy
    /// As [`Bar::train`], for the bar as it is rounded (see the module): velocities and times are off by a few times as
    /// much as a change of q and κ by some ε makes, and velocity jumps of each end are relative to the largest of that
    /// end.
    #[must_use]
    pub fn train(&self, start: &Start) -> OffCenterTrain {
        OffCenterTrain { bar: *self, train: self.bar.train(&self.reduce(start)) }
    }

    /// Number of impacts, as [`Bar::count`].
    #[must_use]
    pub fn count(&self, start: &Start) -> Count {
        self.bar.count(&self.reduce(start))
    }

    /// Count, peak, net change, final velocities and duration, end a first, in constant time.
    ///
    /// The peak is the largest shock of an end in its own strikes; those of the center of mass and of the angular
    /// velocity are the largest that any strike gives, not always that same one. `center` is the center of mass
    /// throughout. The largest shock of every position, ends included, is in [`shocks`](Self::shocks).
    #[must_use]
    pub fn summary(&self, start: &Start) -> Summary {
        let symmetric = self.bar.summary(&self.reduce(start));
        let [(a, at_a), (b, at_b)] = self.bar.struck_peaks(&self.reduce(start));
        let struck = [a, b / self.kappa];
        let largest = |shares: [f64; 2]| shock(shares[0], struck[0]).max(shock(shares[1], struck[1]));
        let end = struck[0].max(struck[1]);
        let impact = if self.is_symmetric() {
            symmetric.peak.impact
        } else if struck[1] > struck[0] {
            at_b
        } else {
            at_a
        };
        let final_velocity = symmetric.final_velocity.map(|[a, b]| [a, b / self.kappa]);
        let [va, vb] = start.velocity();
        let net = final_velocity.map(|[a, b]| {
            let (a, b) = (a - va, b - vb);
            Net { a, b, center: 0.5 * (self.arms[1] * a + self.arms[0] * b), angular: 0.5 * (b - a) }
        });
        let peak = Peak { end, impact, center: largest(self.center), angular: largest(self.turn) };
        Summary { peak, final_velocity, net, ..symmetric }
    }

    /// The largest shocks of one train, everywhere on the bar. The start is that of the end `first` and then of the
    /// other.
    #[must_use]
    pub fn shocks(&self, start: &Start, first: End) -> Shocks {
        let peaks = match first {
            End::A => self.struck(start),
            End::B => {
                let EndPeaks { a, b } = self.exchanged().struck(start);
                EndPeaks { a: b, b: a }
            }
        };
        Shocks { bar: *self, peaks }
    }

    /// The largest shocks whichever end strikes first.
    #[must_use]
    pub fn shocks_either(&self, start: &Start) -> Shocks {
        let [first, second] = [End::A, End::B].map(|first| self.shocks(start, first).peaks);
        Shocks { bar: *self, peaks: EndPeaks { a: first.a.max(second.a), b: first.b.max(second.b) } }
    }

    fn struck(&self, start: &Start) -> EndPeaks {
        let EndPeaks { a, b } = self.bar.end_peaks(&self.reduce(start));
        EndPeaks { a, b: b / self.kappa }
    }
}

/// Center of mass, from the middle towards end b, and radius of gyration about it, of masses along a bar, in m.
///
/// # Accuracy
/// The center to a rounding a mass of where the masses reach; the radius is summed about it, so that masses close
/// together far off the middle keep their digits, and is 0 where it is no more than roundings of the positions.
///
/// # Errors
/// [`Error::NoMass`] for an empty list, [`Error::Quantity`] where a mass is not in [1e−25, 1e25] kg, a position is
/// beyond ±1e25 m or a slab ends before it begins.
///
/// ```
/// use clatter::{Mass, center_and_gyration};
/// let [center, gyration] = center_and_gyration(&[
///     Mass::Point { mass_kg: 1.0, position_m: 0.01 },
///     Mass::Point { mass_kg: 1.0, position_m: 0.05 },
/// ])?;
/// assert!((center - 0.03).abs() < 1e-17 && (gyration - 0.02).abs() < 1e-17);
/// # Ok::<(), clatter::Error>(())
/// ```
pub fn center_and_gyration(masses: &[Mass]) -> Result<[f64; 2], Error> {
    let parts = masses.iter().map(Mass::parts).collect::<Result<Vec<_>, _>>()?;
    let middle = |from: f64, to: f64| 0.5 * from + 0.5 * to;
    let mass: f64 = parts.iter().map(|(m, ..)| m).sum();
    if parts.is_empty() {
        return Err(Error::NoMass);
    }
    let center = parts.iter().map(|(m, from, to)| m / mass * middle(*from, *to)).sum::<f64>();
    let squares = parts.iter().map(|(m, from, to)| {
        let (x, width) = (middle(*from, *to) - center, to - from);
        m / mass * (x * x + width * width / 12.0)
    });
    let gyration = squares.sum::<f64>().sqrt();
    let reach = parts.iter().fold(0.0, |reach: f64, (_, from, to)| reach.max(from.abs()).max(to.abs()));
    #[expect(clippy::cast_precision_loss, reason = "a count of roundings")]
    let roundings = 4.0 * f64::EPSILON * parts.len() as f64;
    Ok([center, if gyration > roundings * reach { gyration } else { 0.0 }])
}

/// Iterator over the impacts of an off-center bar. Made by [`OffCenterBar::train`].
#[derive(Debug, Clone)]
pub struct OffCenterTrain {
    bar: OffCenterBar,
    train: Train,
}

impl OffCenterTrain {
    fn own(&self, impact: Impact) -> Impact {
        let (e, [far_a, far_b]) = (self.bar.e(), self.bar.far);
        let (approach, delta_v) = match impact.end {
            End::A => (impact.approach, [-(1.0 + e) * impact.approach, far_a * impact.approach]),
            End::B => {
                let approach = impact.approach / self.bar.kappa;
                (approach, [far_b * approach, -(1.0 + e) * approach])
            }
        };
        Impact { approach, delta_v, ..impact }
    }
}

impl Iterator for OffCenterTrain {
    type Item = Impact;

    fn next(&mut self) -> Option<Impact> {
        self.train.next().map(|impact| self.own(impact))
    }

    /// Skips in constant time, as [`Train`].
    fn nth(&mut self, n: usize) -> Option<Impact> {
        self.train.nth(n).map(|impact| self.own(impact))
    }
}

/// The largest shocks on a bar, at every position: of one train, or of the trains after either end has struck first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shocks {
    bar: OffCenterBar,
    peaks: EndPeaks,
}

/// The position where the largest shock is least.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Safest {
    /// Position in [−1, 1].
    pub s: f64,
    /// Largest velocity shock there.
    pub shock: f64,
}

impl Shocks {
    /// Largest shocks of each end in its own strikes, A and B of the module's formulas.
    #[must_use]
    pub fn struck(&self) -> EndPeaks {
        self.peaks
    }

    /// Largest velocity shock at position s in [−1, 1].
    ///
    /// # Accuracy
    /// 1e−12 of the larger of A and B.
    #[must_use]
    pub fn at(&self, s: f64) -> f64 {
        let of = |end: End, peak: f64| shock(self.bar.share(end, s).abs(), peak);
        of(End::A, self.peaks.a).max(of(End::B, self.peaks.b))
    }

    /// The position with the least largest shock, and that shock (formula and proof in the module).
    ///
    /// # Examples
    /// For a symmetric bar it is the middle, if either end may strike first; if end a does, it leans away from the end
    /// that is struck hardest, here b.
    /// ```
    /// use clatter::{Bar, End, OffCenterBar, Start};
    /// let bar = OffCenterBar::from(Bar::new(0.5, 0.3)?);
    /// let safest = bar.shocks_either(&Start::default()).safest();
    /// assert_eq!(safest.s, 0.0);
    /// assert!((safest.shock - 0.53625).abs() < 1e-12);
    /// assert!(bar.shocks(&Start::default(), End::A).safest().s < 0.0);
    /// // Bring the center of mass towards b, and the safest place follows it, but not all the way.
    /// let bar = OffCenterBar::from_center_of_mass(0.3, bar.gyration_ratio(), 0.3)?;
    /// let safest = bar.shocks_either(&Start::default()).safest();
    /// assert!(safest.s > 0.1 && safest.s < 0.3);
    /// # Ok::<(), clatter::Error>(())
    /// ```
    #[must_use]
    pub fn safest(&self) -> Safest {
        let EndPeaks { a, b } = self.peaks;
        // Two infinite peaks (q = e = 1) grow alike.
        let (a, b) = if a.is_infinite() || b.is_infinite() { (1.0, 1.0) } else { (a, b) };
        let OffCenterBar { center, turn, .. } = self.bar;
        let x = (a * center[0] - b * center[1]) / (a * turn[0] + b * turn[1]);
        let s = (self.bar.center_of_mass() + x).clamp(-1.0, 1.0);
        Safest { s, shock: self.at(s) }
    }

    /// The positions in [−1, 1] where no shock exceeds `threshold`: an interval, because the largest shock is a convex
    /// function of the position; `None` where there are none, as for NaN.
    ///
    /// # Accuracy
    /// 1e−12.
    #[must_use]
    pub fn safe_interval(&self, threshold: f64) -> Option<[f64; 2]> {
        let [lo, hi] = self.bounds(threshold);
        let (lo, hi) = (lo.max(-1.0), hi.min(1.0));
        (lo <= hi).then_some([lo, hi])
    }

    /// The safe zone as a width: `s` is half that of the interval between its bounds, not clipped at the ends, in
    /// half-lengths, below 0 where even the safest place sees more. For a symmetric bar of which either end may strike
    /// first it is Eq. 5.
    #[must_use]
    pub fn safe_zone(&self, threshold: f64) -> Zone {
        let [lo, hi] = self.bounds(threshold);
        let extent = match self.safe_interval(threshold) {
            None => Extent::None,
            Some(_) if lo <= -1.0 && hi >= 1.0 => Extent::Whole,
            Some(_) => Extent::Part,
        };
        Zone { threshold, s: 0.5 * (hi - lo), extent }
    }

    /// Where |share · peak| reaches the threshold on either side, for the strikes of both ends.
    fn bounds(&self, threshold: f64) -> [f64; 2] {
        if threshold.is_nan() {
            return [f64::NAN; 2];
        }
        let (OffCenterBar { center, turn, .. }, c) = (self.bar, self.bar.center_of_mass());
        let reach = [threshold / self.peaks.a, threshold / self.peaks.b];
        let lo = ((center[0] - reach[0]) / turn[0]).max((-reach[1] - center[1]) / turn[1]);
        let hi = ((reach[1] - center[1]) / turn[1]).min((center[0] + reach[0]) / turn[0]);
        [c + lo, c + hi]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dd::{Dd, two_sum};
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4096))]

        /// q, 1 − q², κ against twice the digits, for arms and radii over the whole range.
        #[test]
        fn the_symmetric_bar_is_rounded_as_stated(arms in -6.0..6.0_f64, rho in -11.5..5.5_f64, e in 0.0..=1.0_f64) {
            let (a, b, rho) = (1.0, 10f64.powf(arms), 10f64.powf(rho) * 0.5 * (1.0 + 10f64.powf(arms)));
            let bar = OffCenterBar::new([a, b], rho, e).unwrap();
            let squared = two_prod(rho, rho);
            let [ia, ib] = [two_prod(a, a) + squared, two_prod(b, b) + squared];
            let product = two_prod(a, b) - squared;
            let near = |x: Dd, y: Dd, roundings: f64| ((x - y) / y).hi.abs() <= roundings * f64::EPSILON;
            let kappa = (ia / ib).sqrt();
            prop_assert!(near(Dd::from(bar.kappa), kappa, 4.0), "kappa {}", bar.kappa);
            let q = product / (ia * ib).sqrt();
            prop_assert!((bar.bar.wide_q() - q).hi.abs() <= 4.0 * f64::EPSILON, "q {}", bar.q());
            // (1 − q)(1 + q) is 4k² where either is small, so twice the roundings of k.
            let less_more = squared * (two_sum(a, b) * two_sum(a, b)) / (ia * ib);
            prop_assert!(near(bar.bar.wide_less_more(), less_more, 16.0), "1 - q^2 = {}", less_more.hi);
        }
    }
}
