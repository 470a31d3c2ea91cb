//! The plate: a rigid rectangle that falls almost level and strikes the ground at its corners only.
//!
//! Half the length and half the width are the units of x and y, so that the corners are `a` (−1, −1), `b` (1, −1),
//! `c` (1, 1) and `d` (−1, 1) whatever the aspect; corner a strikes first. Velocities are upward positive, heights are
//! those of the corners when a touches.
//!
//! # One strike
//! About the center of mass (s_x, s_y), with X = x − s_x, Y = y − s_y and radii of gyration k_x, k_y (of the mass along
//! x and y, over half the length and half the width), a strike at corner j with velocity v_j < 0 changes the velocity at
//! the place (x, y) by
//!
//! ```text
//! Δv(x, y) = −(1 + e) v_j w_j(x, y)/w_j(j),   w_j(x, y) = 1 + X X_j/k_x² + Y Y_j/k_y²
//! ```
//!
//! This is the impulse at a point of a rigid body that turns about its principal axes by small angles. A plate that is
//! struck in the middle of an edge, or with 1/k_y = 0, is the bar with q = (α − 1)/(α + 1), α = 1/k_x².
//!
//! # Between the strikes
//! A corner moves along h = p + v t. A strike of j at t = −p_j/v_j changes v to `S_j v` with the matrix S_j of the
//! formula above. The line of each corner then meets the old one at t, so that the intercepts change by the same matrix,
//! to `S_j p`: velocities and intercepts are the same numbers of the word of corners so far, applied to the start.
//! Neither grows, because S_j takes kinetic energy out of both (or keeps it, for e = 1).

mod atlas;
mod endless;
mod number;
mod summary;
mod train;
mod zone;

pub use atlas::{Atlas, AtlasPeak, Word};
pub use summary::{PlateCount, PlatePeak, PlateSummary};
pub use train::{PlateImpact, PlateTrain};
pub use zone::{PlateShocks, PlateZone};

use crate::dd::{Dd, two_prod, two_sum};
use crate::exact::Dyadic;
use crate::{Error, Restitution};

/// A corner of the plate. Corner `a` strikes first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Corner {
    /// Corner at (−1, −1).
    A,
    /// Corner at (1, −1).
    B,
    /// Corner at (1, 1), opposite of a.
    C,
    /// Corner at (−1, 1).
    D,
}

impl Corner {
    /// All four, around the plate.
    pub const ALL: [Self; 4] = [Self::A, Self::B, Self::C, Self::D];

    /// Returns the letter of the corner.
    #[must_use]
    pub fn letter(self) -> char {
        ['a', 'b', 'c', 'd'][self as usize]
    }
    /// Returns the position (x, y); each coordinate is −1 or 1.
    #[must_use]
    pub fn position(self) -> [f64; 2] {
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]][self as usize]
    }
}

/// A rigid rectangular plate, its mass anywhere about principal axes along its edges.
///
/// # Validity
/// Small tilt, hard level ground, no friction, no gravity while it clatters. Any two positive radii of gyration are
/// those of some plate: the mass may lie anywhere in it or beyond its edges.
///
/// # Examples
/// A uniform plate of any aspect has k_x² = k_y² = 1/3: a strike at one corner throws the opposite one down by 5/7 of
/// what it gets itself, and both neighbors up by 1/7.
/// ```
/// use clatter::{Plate, PlateStart};
/// let plate = Plate::uniform(0.3)?;
/// let first = plate.train(&PlateStart::default()).next().unwrap();
/// for (got, of_7) in first.delta_v.iter().zip([7.0, 1.0, -5.0, 1.0]) {
///     assert!((got - 1.3 * of_7 / 7.0).abs() < 1e-15);
/// }
/// # Ok::<(), clatter::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plate {
    /// k_x and k_y.
    gyration: [f64; 2],
    /// s_x and s_y.
    center: [f64; 2],
    e: f64,
    /// Change at corner i by a strike of unit speed at corner j, (1 + e) w_j(i)/w_j(j), at `[j][i]`.
    jump: [[f64; 4]; 4],
    /// The same, but e at the corner itself.
    change: [[f64; 4]; 4],
    /// w_j(j).
    weight: [f64; 4],
    /// The largest of them.
    heaviest: f64,
    /// 2K + 1 of the bound of roundings in `train`, K² = 1 + k_x² + k_y².
    spread: f64,
}

/// Smallest and largest gyration ratio: α and β from 10⁻¹⁸ to 10¹⁸, whose products stay far within floats.
const GYRATION: std::ops::RangeInclusive<f64> = 1e-9..=1e9;

impl Plate {
    /// Creates a plate from the gyration ratios k_x and k_y, radii of gyration over half the length and half the width,
    /// and the restitution; the center of mass is the middle.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless both ratios are in [1e−9, 1e9], [`Error::Restitution`] unless 0 ≤ e ≤ 1.
    pub fn new(gyration_ratios: [f64; 2], e: f64) -> Result<Self, Error> {
        Self::off_center(gyration_ratios, [0.0; 2], e)
    }

    /// Creates a plate whose mass is spread evenly, of any aspect: k_x = k_y = 1/√3.
    ///
    /// # Errors
    /// [`Error::Restitution`] unless 0 ≤ e ≤ 1.
    pub fn uniform(e: f64) -> Result<Self, Error> {
        Self::new([(1.0_f64 / 3.0).sqrt(); 2], e)
    }

    /// Creates a plate from the gyration ratios about the center of mass, the position of that, (s_x, s_y), and the
    /// restitution.
    ///
    /// # Errors
    /// Those of [`Plate::new`], and [`Error::Quantity`] unless s_x and s_y are in (−1, 1).
    pub fn off_center(gyration_ratios: [f64; 2], center_of_mass: [f64; 2], e: f64) -> Result<Self, Error> {
        let e = Restitution::new(e)?.get();
        for (name, value) in ["gyration ratio along x", "gyration ratio along y"].into_iter().zip(gyration_ratios) {
            if !GYRATION.contains(&value) {
                return Err(Error::Quantity { name, value, allowed: "in [1e-9, 1e9]" });
            }
        }
        for (name, value) in ["center of mass along x", "center of mass along y"].into_iter().zip(center_of_mass) {
            if !(value > -1.0 && value < 1.0) {
                return Err(Error::Quantity { name, value, allowed: "in (-1, 1), between the edges" });
            }
        }
        let mut plate = Self {
            gyration: gyration_ratios,
            center: center_of_mass.map(|s| s + 0.0),
            e,
            jump: [[0.0; 4]; 4],
            change: [[0.0; 4]; 4],
            weight: [0.0; 4],
            heaviest: 0.0,
            spread: 2.0
                * (1.0 + gyration_ratios[0] * gyration_ratios[0] + gyration_ratios[1] * gyration_ratios[1]).sqrt()
                + 1.0,
        };
        let coupling = plate.coupling();
        for (j, row) in coupling.iter().enumerate() {
            let own = row[j].0;
            plate.jump[j] = row.map(|(w, _)| (two_sum(1.0, e) * (w / own)).hi);
            plate.change[j] = plate.jump[j];
            (plate.jump[j][j], plate.change[j][j]) = (1.0 + e, e);
            plate.weight[j] = (own / plate.squares()).hi;
            plate.heaviest = plate.heaviest.max(plate.weight[j]);
        }
        Ok(plate)
    }

    /// Returns the gyration ratios k_x and k_y.
    #[must_use]
    pub fn gyration_ratios(&self) -> [f64; 2] {
        self.gyration
    }
    /// Returns the position of the center of mass, (s_x, s_y).
    #[must_use]
    pub fn center_of_mass(&self) -> [f64; 2] {
        self.center
    }
    /// Returns the coefficient of restitution.
    #[must_use]
    pub fn e(&self) -> f64 {
        self.e
    }
    /// Returns whether the center of mass is the middle, so that all corners are alike.
    #[must_use]
    pub fn is_centered(&self) -> bool {
        self.center.iter().all(|s| *s == 0.0)
    }
    /// Returns w_j(j) = 1 + X_j²/k_x² + Y_j²/k_y² of a corner: the mass of the plate over the mass that a strike there
    /// moves.
    #[must_use]
    pub fn weight(&self, corner: Corner) -> f64 {
        self.weight[corner as usize]
    }

    /// Returns the share of the shock of a strike at `corner` that reaches the place (x, y): w_j(x, y)/w_j(j) of the
    /// module's formula. It is 0 along the line of percussion of that corner, and 1/w_j(j) at the center of mass.
    ///
    /// # Accuracy
    /// 4 ε of the sum of the sizes of its three terms.
    ///
    /// # Examples
    /// ```
    /// use clatter::{Corner, Plate};
    /// let plate = Plate::uniform(0.3)?;
    /// assert!((plate.share(Corner::A, [0.0, 0.0]) - 1.0 / 7.0).abs() < 1e-15);
    /// assert!(plate.share(Corner::A, [1.0 / 3.0, 0.0]).abs() < 1e-15); // α x + β y = 1
    /// # Ok::<(), clatter::Error>(())
    /// ```
    #[must_use]
    pub fn share(&self, corner: Corner, [x, y]: [f64; 2]) -> f64 {
        let [constant, along_x, along_y] = self.share_form(corner);
        constant + (along_x * (x - self.center[0]) + along_y * (y - self.center[1]))
    }

    /// Returns the share as a linear form about the center of mass: its constant, and its slopes along X and Y.
    fn share_form(&self, corner: Corner) -> [f64; 3] {
        let ([x, y], own) = (corner.position(), self.weight(corner));
        let [kx, ky] = self.gyration;
        [1.0 / own, (x - self.center[0]) / kx / kx / own, (y - self.center[1]) / ky / ky / own]
    }

    /// Returns the plate in a mirror across x: a ↔ b and d ↔ c.
    #[must_use]
    pub fn mirrored_x(&self) -> Self {
        self.renamed([0.0 - self.center[0], self.center[1]], self.gyration)
    }
    /// Returns the plate in a mirror across y: a ↔ d and b ↔ c.
    #[must_use]
    pub fn mirrored_y(&self) -> Self {
        self.renamed([self.center[0], 0.0 - self.center[1]], self.gyration)
    }
    /// Returns the plate with its axes exchanged: b ↔ d.
    #[must_use]
    pub fn exchanged(&self) -> Self {
        let [[sx, sy], [kx, ky]] = [self.center, self.gyration];
        self.renamed([sy, sx], [ky, kx])
    }
    fn renamed(&self, center: [f64; 2], gyration: [f64; 2]) -> Self {
        // The values were checked when this plate was made.
        Self::off_center(gyration, center, self.e).unwrap_or(*self)
    }

    /// Returns k_x² k_y².
    fn squares(&self) -> Dd {
        let [kx, ky] = self.gyration.map(|k| two_prod(k, k));
        kx * ky
    }

    /// Returns k_x² k_y² w_j(i) = k_x² k_y² + X_i X_j k_y² + Y_i Y_j k_x², and the sum of the sizes of its terms: the
    /// error is 2⁻¹⁰⁰ of that.
    fn coupling(&self) -> [[(Dd, f64); 4]; 4] {
        let [kx, ky] = self.gyration.map(|k| two_prod(k, k));
        let arms = Corner::ALL.map(|corner| {
            let [x, y] = corner.position();
            [two_sum(x, -self.center[0]), two_sum(y, -self.center[1])]
        });
        let product = kx * ky;
        std::array::from_fn(|j| {
            std::array::from_fn(|i| {
                let [x, y] = [arms[i][0] * arms[j][0] * ky, arms[i][1] * arms[j][1] * kx];
                (product + x + y, product.hi + x.hi.abs() + y.hi.abs())
            })
        })
    }

    /// Returns the same as [`coupling`](Self::coupling) in whole numbers, with one factor for all.
    fn exact_coupling(&self) -> [[Dyadic; 4]; 4] {
        let whole = |x: f64| Dyadic::from(x).odd();
        let [kx, ky] = self.gyration.map(|k| whole(k).mul(&whole(k)));
        let arms = Corner::ALL.map(|corner| {
            let [x, y] = corner.position();
            [whole(x).sub(&whole(self.center[0])), whole(y).sub(&whole(self.center[1]))]
        });
        let product = kx.mul(&ky);
        std::array::from_fn(|j| {
            std::array::from_fn(|i| {
                let [x, y] = [arms[i][0].mul(&arms[j][0]).mul(&ky), arms[i][1].mul(&arms[j][1]).mul(&kx)];
                product.add(&x).add(&y).odd()
            })
        })
    }

    /// Returns √(V² + k_x² Ω_x² + k_y² Ω_y²) of the motion with these corner values, where V is that of the center of
    /// mass: the root of twice the kinetic energy per mass. Strikes do not raise it, and no corner j is faster than
    /// √w_j(j) times it.
    fn norm(&self, [a, b, _, d]: [f64; 4]) -> f64 {
        let [wx, wy] = [0.5 * (b - a), 0.5 * (d - a)];
        let v = a + (1.0 + self.center[0]) * wx + (1.0 + self.center[1]) * wy;
        let [x, y] = [self.gyration[0] * wx, self.gyration[1] * wy];
        (v * v + x * x + y * y).sqrt()
    }
}

/// The state of a plate when corner a touches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlateStart {
    /// Velocities of a, b and d.
    velocity: [f64; 3],
    /// Heights of b and d.
    gaps: [f64; 2],
}

impl Default for PlateStart {
    /// Returns pure translation at unit speed, tilted along the diagonal: b and d at the same height 1.
    fn default() -> Self {
        Self { velocity: [-1.0; 3], gaps: [1.0; 2] }
    }
}

/// Sizes of velocities and gaps whose products stay within the range of floats.
const SIZES: std::ops::RangeInclusive<f64> = 1e-60..=1e60;

impl PlateStart {
    /// Creates a start from the upward velocities of corners a, b and d, and the heights of b and d; c lies and moves
    /// in the plane of the other three, v_c = v_b + v_d − v_a and h_c = h_b + h_d.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless v_a is in [−1e60, −1e−60], the other velocities are 0 or of a size in [1e−60, 1e60], and
    /// gaps are 0 or in that range.
    pub fn new(velocity: [f64; 3], gaps: [f64; 2]) -> Result<Self, Error> {
        let name = "velocity of corner a";
        if !SIZES.contains(&-velocity[0]) {
            let allowed = "in [-1e60, -1e-60]: corner a must approach the ground";
            return Err(Error::Quantity { name, value: velocity[0], allowed });
        }
        for (name, value) in
            ["velocity of corner b", "velocity of corner d"].into_iter().zip([velocity[1], velocity[2]])
        {
            if value != 0.0 && !SIZES.contains(&value.abs()) {
                return Err(Error::Quantity { name, value, allowed: "0 or of a size in [1e-60, 1e60]" });
            }
        }
        for (name, value) in ["height gap of corner b", "height gap of corner d"].into_iter().zip(gaps) {
            if value != 0.0 && !SIZES.contains(&value) {
                return Err(Error::Quantity { name, value, allowed: "0 or in [1e-60, 1e60]" });
            }
        }
        Ok(Self { velocity: velocity.map(|v| v + 0.0), gaps: gaps.map(|h| h + 0.0) })
    }

    /// Creates a start of pure translation at unit speed with these heights of b and d.
    ///
    /// # Errors
    /// Those of [`PlateStart::new`].
    pub fn level(gaps: [f64; 2]) -> Result<Self, Error> {
        Self::new([-1.0; 3], gaps)
    }

    /// Returns the velocities of the four corners; that of c is rounded.
    #[must_use]
    pub fn velocities(&self) -> [f64; 4] {
        let [a, b, d] = self.velocity;
        [a, b, (two_sum(b, d) - Dd::from(a)).hi, d]
    }
    /// Returns the heights of corners b and d.
    #[must_use]
    pub fn gaps(&self) -> [f64; 2] {
        self.gaps
    }
    /// Returns whether all four corners touch at once.
    fn is_flat(&self) -> bool {
        self.gaps.iter().all(|gap| *gap == 0.0)
    }
    /// Returns the gaps that order the corners: for a flat drop those of the tilt along the diagonal, of any size.
    fn ordering_gaps(&self) -> [f64; 2] {
        if self.is_flat() { [1.0; 2] } else { self.gaps }
    }
    /// Returns the change of the gaps with the tilt that settles a tie: towards h_d, or from h_b = 0 towards h_b.
    fn nudge(&self) -> [f64; 2] {
        let [hx, _] = self.ordering_gaps();
        if hx == 0.0 { [1.0, 0.0] } else { [0.0, 1.0] }
    }
}
