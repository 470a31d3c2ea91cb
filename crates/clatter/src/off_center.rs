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
//! q and κ are irrational as a rule, and are formed with twice the digits of a float; 1 − q² = ρ² (L_a + L_b)²/(I_a I_b)
//! keeps its digits however close q is to 1. What decides is rational all the same: with c_0 = v_a, c_1 = I_a a_1, c_2 =
//! I_a I_b a_2 and so on the velocities obey
//!
//! ```text
//! c_{n+1} = P (1 + e) c_n − e I_a I_b c_{n−1},   c_1 = P (1 + e) v_a + I_a v_b
//! ```
//!
//! where all that is given is a float. So the count is as exact as that of the symmetric bar, for the arms, the radius of
//! gyration and the velocities as given: digits first, whole numbers where they leave a doubt. Masses are another matter:
//! their center and radius of gyration are rounded sums, and the count is that of the bar with these. Whether it is
//! that of the masses too, [`OffCenterBar::count_is_exact`] tells.
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

use crate::bar::{Moments, OffCenter, positive};
use crate::dd::{Dd, two_sum};
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
    kappa: Dd,
    /// How far the center of mass and the radius of gyration may be off, in half-lengths: 0 where they are given.
    rounded: f64,
    /// Position of the center of mass, c.
    offset: f64,
    /// Radius of gyration about it over half the length.
    gyration: f64,
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
    /// The symmetric bar, bit for bit. Its inertia counts as given, also where it was summed up from masses.
    fn from(bar: Bar) -> Self {
        let (center, turn) = ([0.5 * bar.less; 2], [0.5 * bar.more; 2]);
        let (kappa, ratios, far) = (Dd::from(1.0), [bar.q(); 2], [bar.t; 2]);
        let gyration = bar.gyration_ratio();
        Self { bar, kappa, rounded: 0.0, offset: 0.0, gyration, arms: [1.0; 2], ratios, far, center, turn }
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
        // The power of 2 below the longer arm, as a unit that rounds nothing.
        let unit = f64::from_bits(a.max(b).to_bits() & f64::INFINITY.to_bits());
        Self::reduced([a, b].map(|arm| Dd::from(arm / unit)), (a - b) / (a + b), rho / unit, e)
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
        Self::reduced([two_sum(1.0, c), two_sum(1.0, -c)], c, k + 0.0, e)
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
        let half = 0.5 * length_m;
        let bar = match Bar::from_masses(length_m, masses, e) {
            Ok(bar) => Self::from(bar),
            Err(Error::OffCenter { .. }) => {
                let [center, gyration] = center_and_gyration(masses)?;
                Self::from_center_of_mass(center / half, gyration / half, e)?
            }
            Err(error) => return Err(error),
        };
        let parts = masses.iter().map(Mass::parts).collect::<Result<Vec<_>, _>>()?;
        Ok(Self { rounded: SUMS * roundings(&parts) * (reach(&parts) / half).max(1.0), ..bar })
    }

    /// From arms, the offset that they mean, and the radius of gyration, all in one unit that is about half the length.
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
        let ratios = inertia.map(|i| excess.hi / i.hi);
        Ok(Self {
            bar: Bar::off_center(given, &moments, e),
            kappa: inertia[0] / root,
            rounded: 0.0,
            offset,
            gyration: k,
            arms: [a.hi / half, b.hi / half],
            ratios,
            far: ratios.map(|q| q + q * e.get()),
            center: inertia.map(|i| rho * rho / i.hi),
            turn: [a.hi * half / inertia[0].hi, b.hi * half / inertia[1].hi],
        })
    }

    /// The same bar with its ends exchanged.
    #[must_use]
    pub fn exchanged(&self) -> Self {
        let swap = |[a, b]: [f64; 2]| [b, a];
        let (arms, ratios, far) = (swap(self.arms), swap(self.ratios), swap(self.far));
        Self {
            bar: self.bar.exchanged(),
            kappa: Dd::from(1.0) / self.kappa,
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
    /// 1e−15 of itself.
    #[must_use]
    pub fn gyration_ratio(&self) -> f64 {
        self.gyration
    }
    /// κ = √((L_a² + ρ²)/(L_b² + ρ²)): how much a velocity of end b counts beside one of end a.
    #[must_use]
    pub fn kappa(&self) -> f64 {
        self.kappa.hi
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

    /// The symmetric bar with the same clatter, and how it arrives.
    pub(crate) fn symmetric(&self, start: &Start) -> (Bar, Start) {
        (self.bar, if self.is_symmetric() { *start } else { start.with_b_times(self.kappa) })
    }

    /// The impacts, one by one, end a first; as [`Bar::train`], with [`Impact::delta_v_at`] for any position.
    ///
    /// # Accuracy
    /// As [`Bar::train`]; velocity jumps of each end are relative to the largest of that end.
    #[must_use]
    pub fn train(&self, start: &Start) -> OffCenterTrain {
        let (bar, start) = self.symmetric(start);
        OffCenterTrain { bar: *self, train: bar.train(&start) }
    }

    /// Number of impacts, as exact as that of [`Bar::count`]; [`count_is_exact`](Self::count_is_exact) for masses.
    ///
    /// # Examples
    /// This bar is exactly on the endless curve, T = 1 = 2√e. With the next larger e it is not: D = 4e − T² is then 2.4
    /// times what e has gained, and the train has some π/√D impacts.
    /// ```
    /// use clatter::{Count, OffCenterBar, Start};
    /// let count = |e| OffCenterBar::new([2.0, 5.5], 1.0, e).unwrap().count(&Start::default());
    /// assert_eq!(count(0.25), Count::Endless);
    /// assert_eq!(count(0.25_f64.next_up()), Count::Finite(272_178_700));
    /// ```
    #[must_use]
    pub fn count(&self, start: &Start) -> Count {
        let (bar, start) = self.symmetric(start);
        bar.count(&start)
    }

    /// Whether [`count`](Self::count) is proven to be the number of impacts of the bar as it was given.
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

    /// The least and the largest count of bars that are rounded to this one; `None` where some are no bars at all.
    fn bounds_of_count(&self, start: &Start) -> Option<[Count; 2]> {
        let (c, k, off) = (self.offset, self.gyration, self.rounded);
        let ([low, high], away) = ([(k - off).max(0.0), k + off], c.abs());
        // κ = √(I_a/I_b) rises with c and comes closer to 1 as k rises; q falls where k or |c| rises.
        let kappa = |c: f64| [low, high].map(|k| libm::hypot(1.0 + c, k) / libm::hypot(1.0 - c, k));
        let ([a, b], [x, y]) = (kappa(c + off), kappa(c - off));
        let [least, most] = [x.min(y) * (1.0 - 8.0 * f64::EPSILON), a.max(b) * (1.0 + 8.0 * f64::EPSILON)];
        let bar = |c: f64, k: f64, factor: f64| {
            let bar = Self::from_center_of_mass(c, k, self.e()).ok()?.bar;
            Bar::from_gyration_ratio(bar.gyration_ratio() * factor, self.e()).ok()
        };
        let [few, many] = [
            bar(away + off, high, 1.0 + 8.0 * f64::EPSILON)?,
            bar((away - off).max(0.0), low, 1.0 - 8.0 * f64::EPSILON)?,
        ];
        let [va, vb] = start.velocity();
        let [slow, fast] = if vb > 0.0 { [most, least] } else { [least, most] };
        let count = |bar: Bar, kappa: f64| Some(bar.count(&Start::new([va, kappa * vb], 1.0).ok()?));
        Some([count(few, slow)?, count(many, fast)?])
    }

    /// Count, peak, net change, final velocities and duration, end a first, in constant time.
    ///
    /// The peak is the largest shock of an end in its own strikes; those of the center of mass and of the angular
    /// velocity are the largest that any strike gives, not always that same one. `center` is the center of mass
    /// throughout. The largest shock of every position, ends included, is in [`shocks`](Self::shocks).
    ///
    /// # Accuracy
    /// The count is that of [`count`](Self::count), and the errors of the rest are at most those of [`crate::accuracy`],
    /// as for [`Bar::summary`]. Of impacts whose shocks are equal but for roundings, any may be said to hold the peak.
    #[must_use]
    pub fn summary(&self, start: &Start) -> Summary {
        let (bar, arrival) = self.symmetric(start);
        let symmetric = bar.summary(&arrival);
        let [(a, at_a), (b, at_b)] = bar.struck_peaks(&arrival);
        let struck = [a, b / self.kappa()];
        let largest = |shares: [f64; 2]| shock(shares[0], struck[0]).max(shock(shares[1], struck[1]));
        let end = struck[0].max(struck[1]);
        let impact = if self.is_symmetric() {
            symmetric.peak.impact
        } else if struck[1] > struck[0] {
            at_b
        } else {
            at_a
        };
        let final_velocity = symmetric.final_velocity.map(|[a, b]| [a, b / self.kappa()]);
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
        let (bar, arrival) = self.symmetric(start);
        let EndPeaks { a, b } = bar.end_peaks(&arrival);
        EndPeaks { a, b: b / self.kappa() }
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
    Ok([center, if gyration > 4.0 * roundings(&parts) * reach(&parts) { gyration } else { 0.0 }])
}

/// How far the center of mass and the radius of gyration of masses are off at most, in ε times the number of masses and
/// the larger of half the length and where they reach: [`center_and_gyration`] rounds 12 times a mass at most for
/// either, and a center that counts as the middle is within 9 of it.
const SUMS: f64 = 16.0;

/// How far from the middle masses reach, in m.
fn reach(parts: &[(f64, f64, f64)]) -> f64 {
    parts.iter().fold(0.0, |reach, (_, from, to)| reach.max(from.abs()).max(to.abs()))
}

/// ε times the number of masses.
fn roundings(parts: &[(f64, f64, f64)]) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "a count of roundings")]
    let count = parts.len() as f64;
    f64::EPSILON * count
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
                let approach = impact.approach / self.bar.kappa();
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
            let made = if given { OffCenterBar::new([a, b], rho, e) } else { OffCenterBar::from_center_of_mass(c, rho, e) };
            let OffCenterBar { bar, kappa, .. } = made.unwrap();
            let whole = bar.exact_q();
            let squared = |x: &Dyadic| x.mul(x);
            let near = |got: Dyadic, want: Dyadic, bits: i128| {
                let (off, size) = (got.sub(&want).to_float(), want.to_float());
                off.0 == 0.0 || off.1 < size.1 - bits
            };
            let [q, less_more] = [bar.wide_q(), bar.wide_less_more()].map(Dyadic::from);
            prop_assert!(near(squared(&q).mul(&whole.square), squared(&whole.mu), 98), "q {}", bar.q());
            let rest = whole.square.sub(&squared(&whole.mu));
            prop_assert!(near(less_more.mul(&whole.square), rest, 98), "1 - q^2 = {}", bar.wide_less_more().hi);
            let square = squared(&Dyadic::from(kappa)).mul(&whole.square);
            prop_assert!(near(square, squared(&whole.beside), 98), "kappa {}", kappa.hi);
            // In floats q is rounded once, the others next to once.
            prop_assert_eq!(bar.q().partial_cmp(&0.0), Some(whole.mu.sign()), "sign of q");
            let product = Dyadic::from(bar.less).mul(&Dyadic::from(bar.more));
            prop_assert!(near(product, less_more, 51), "less {} more {}", bar.less, bar.more);
        }
    }
}
