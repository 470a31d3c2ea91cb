//! What the engine asks of a body in motion: the one place where it meets a shape.

use std::fmt::Debug;

use clatter::Sine;

use super::Sample;

/// A body in motion. All that the engine knows of its shape it knows from here, the coupling
///
/// ```text
/// M_ij    what a force of 1 over the mass at point i does to the vertical acceleration of point j
/// ```
///
/// first. Heights and velocities are vertical, upward positive, forces and energies per mass of the body.
///
/// What has a body of its own below holds where lever arms never change and nothing turns over.
pub trait Pose<const N: usize>: Copy + Debug {
    /// Lever arms of one position, which a phase keeps.
    type Arms: Copy + Debug;
    /// What a motion by instant impacts is known by, between them.
    type Impacts: Clone + Debug;

    /// Acceleration of gravity in a motion by instant impacts.
    fn gravity_of(impacts: &Self::Impacts) -> f64;
    /// The body at one time of a motion by instant impacts, where they have forces in between.
    fn sample_of(_impacts: &Self::Impacts, _time_s: f64) -> Option<Sample<N>> {
        None
    }

    /// How large it is.
    fn extent(&self) -> Extent;
    /// Acceleration of gravity.
    fn gravity(&self) -> f64;
    /// Heights and vertical velocities of all points, by the lever arms of now.
    fn points_by(&self, arms: &Self::Arms) -> ([f64; N], [f64; N]);
    /// Velocity of a place on the body.
    fn velocity_of(&self, place: [f64; 2]) -> f64;
    /// Tilt and angular velocity, as [`Strike`](crate::Strike) tells them.
    fn angles(&self) -> [f64; 2];
    /// Energy of its motion.
    fn kinetic(&self) -> f64;
    /// The same and that of its height, the center of mass at height 0 without any.
    fn energy(&self) -> f64;

    /// The pose after a free flight of time t.
    fn flown(&self, t: f64) -> Self;
    /// Height of a point after a free flight of time t, and its first three derivatives.
    fn flying(&self, point: usize, t: f64) -> [f64; 4];
    /// Bounds of the second, third and fourth derivative of the height of a point in free flight.
    fn flying_bounds(&self, point: usize) -> [f64; 3];
    /// What a place feels of the turning in a free flight of this length, and what that changes its velocity by.
    fn flying_felt(&self, _place: [f64; 2], _length_s: f64) -> (Sine, f64) {
        (Sine::default(), 0.0)
    }
    /// Time after t in which no angle lets a point touch.
    fn clear(&self, _point: usize, _t: f64) -> f64 {
        0.0
    }

    /// The lever arms of now.
    fn arms(&self) -> Self::Arms;
    /// M_ij by these lever arms.
    fn coupling(&self, arms: &Self::Arms, i: usize, j: usize) -> f64;
    /// What a force of 1 over the mass at each point does to a place.
    fn couplings_of(&self, arms: &Self::Arms, place: [f64; 2]) -> [f64; N];
    /// Acceleration with which each point falls where nothing presses: gravity and turning.
    fn falls(&self, arms: &Self::Arms) -> [f64; N];
    /// Upward acceleration of a place by turning alone.
    fn turning(&self, _arms: &Self::Arms, _place: [f64; 2]) -> f64 {
        0.0
    }
    /// The pose a time t later, the ground having done meanwhile ∫F dt and ∬F dt² at these lever arms.
    fn after(&self, t: f64, arms: &Self::Arms, pushes: &Pushes<N>) -> Self;

    /// The pose in the middle of a phase, with the angles that its forces weigh those of its begin, middle and end by.
    fn mean(_begin: &Self, middle: &Self, _end: &Self, _weigh: impl Fn([f64; 3]) -> f64) -> Self {
        *middle
    }
    /// The angle from another pose that changes lever arms.
    fn turned_from(&self, _other: &Self) -> f64 {
        0.0
    }
    /// What a turn changes the lever arm of a point by, over itself.
    fn steepness(&self, _arms: &Self::Arms, _point: usize) -> f64 {
        0.0
    }

    /// How the ground bears the weight at these lever arms and heights, where it can; each point on the straight line of its force,
    /// by stiffness and height without force.
    fn borne(&self, arms: &Self::Arms, height: &[f64; N], line: impl Fn(usize) -> [f64; 2]) -> Option<Borne<N>>;
    /// Energy that it may yet give by coming to lie on a lower side.
    fn lower(&self) -> f64 {
        0.0
    }
    /// Where the points that lie hold the body, the forces on them beside these of the others.
    fn held_by(&self, _lying: &[bool; N], _forces: &[f64; N]) -> Option<[f64; N]> {
        None
    }
    /// Impulses at points that carry it that stop it; none where they can not.
    fn stopping(&self, carrying: &[bool; N]) -> Option<[Option<f64>; N]>;

    /// The same without motion.
    #[must_use]
    fn still(&self) -> Self;

    /// Time until it stands upright and may turn over to a side without points.
    fn upright(&self) -> f64 {
        f64::INFINITY
    }
    /// Whether it has turned over.
    fn is_over(&self) -> bool {
        false
    }
    /// The same without whole turns, which have done their part and take digits.
    #[must_use]
    fn unwound(self) -> Self {
        self
    }

    /// Heights and vertical velocities of all points.
    fn points(&self) -> ([f64; N], [f64; N]) {
        self.points_by(&self.arms())
    }
    /// M_ij of now.
    fn coupled(&self, i: usize, j: usize) -> f64 {
        self.coupling(&self.arms(), i, j)
    }
    /// Acceleration with which a point falls now where nothing presses.
    fn fall(&self, point: usize) -> f64 {
        self.falls(&self.arms())[point]
    }
}

/// How large a body is.
#[derive(Debug, Clone, Copy)]
pub struct Extent {
    /// Its length, or twice how far it reaches if that is shorter.
    pub(super) size: f64,
    /// From the center of mass to the farthest point.
    pub(super) reach: f64,
    /// The largest M_ii at any angle.
    pub(crate) coupling: f64,
}

/// What the ground has done since a phase began: ∫F dt and ∬F dt² of each point, per mass.
#[derive(Debug, Clone, Copy)]
pub struct Pushes<const N: usize> {
    pub(super) impulse: [f64; N],
    pub(super) path: [f64; N],
}

/// What pushes at some points are worth to move these points so: x of M x = b, of as many of them as move independently.
///
/// Corners of a plate are four, and have three ways to move: what is no more than a rounding is left out.
pub(crate) fn solve<const N: usize>(
    coupling: impl Fn(usize, usize) -> f64,
    points: &[bool; N],
    mut b: [f64; N],
) -> [f64; N] {
    let mut those = (0..N).filter(|i| points[*i]);
    if let (Some(p), None) = (those.next(), those.next()) {
        let mut x = [0.0; N];
        x[p] = b[p] / coupling(p, p);
        return x;
    }
    let mut m: [[f64; N]; N] = std::array::from_fn(|i| std::array::from_fn(|j| coupling(i, j)));
    let mut moves = *points;
    for p in 0..N {
        moves[p] &= moves_freely(m[p][p], coupling(p, p));
        for i in (p + 1..N).filter(|i| moves[p] && points[*i]) {
            let share = m[i][p] / m[p][p];
            b[i] -= share * b[p];
            m[i] = std::array::from_fn(|j| m[i][j] - share * m[p][j]);
        }
    }
    let mut x = [0.0; N];
    for p in (0..N).rev().filter(|p| moves[*p]) {
        let others: f64 = (p + 1..N).map(|j| m[p][j] * x[j]).sum();
        x[p] = (b[p] - others) / m[p][p];
    }
    x
}

/// Whether a point moves where others are held: its own coupling then, over that where nothing is held, is no rounding.
pub(super) fn moves_freely(held: f64, own: f64) -> bool {
    held > 1e-10 * own
}

/// A body whose weight the ground bears.
#[derive(Debug, Clone, Copy)]
pub struct Borne<const N: usize> {
    /// The points that may do so.
    pub(super) on: [bool; N],
    /// Their forces.
    pub(super) forces: [f64; N],
}
