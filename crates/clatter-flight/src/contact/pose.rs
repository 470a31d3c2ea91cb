//! The interface between the engine and a body in motion: the one place where the engine meets a shape.

use std::fmt::Debug;

use clatter::Sine;

use super::Sample;

/// A body in motion. The engine knows its shape through these methods alone, in the first place through the coupling
///
/// ```text
/// M_ij    the vertical acceleration of point j by a force of 1 over the mass at point i
/// ```
///
/// first. Heights and velocities are vertical, upward positive, forces and energies per mass of the body.
///
/// The provided methods hold where lever arms never change and nothing turns over.
pub trait Pose<const N: usize>: Copy + Debug {
    /// Lever arms of one position, which a phase keeps.
    type Arms: Copy + Debug;
    /// The data of a motion by instant impacts between them.
    type Impacts: Clone + Debug;

    /// Returns the acceleration of gravity in a motion by instant impacts.
    fn gravity_of(impacts: &Self::Impacts) -> f64;
    /// Returns the body at one time of a motion by instant impacts, where they have forces in between.
    fn sample_of(_impacts: &Self::Impacts, _time_s: f64) -> Option<Sample<N>> {
        None
    }

    /// Returns its size.
    fn extent(&self) -> Extent;
    /// Returns the acceleration of gravity.
    fn gravity(&self) -> f64;
    /// Returns the heights and vertical velocities of all points, by the given lever arms.
    fn points_by(&self, arms: &Self::Arms) -> ([f64; N], [f64; N]);
    /// Returns the velocity of a place on the body.
    fn velocity_of(&self, place: [f64; 2]) -> f64;
    /// Returns tilt and angular velocity, as a [`Strike`](crate::Strike) has them.
    fn angles(&self) -> [f64; 2];
    /// Returns the kinetic energy.
    fn kinetic(&self) -> f64;
    /// Returns the kinetic and potential energy; the latter is 0 for the center of mass at height 0.
    fn energy(&self) -> f64;

    /// Returns the pose after a free flight of time t.
    fn flown(&self, t: f64) -> Self;
    /// Returns the height of a point after a free flight of time t, and its first three derivatives.
    fn flying(&self, point: usize, t: f64) -> [f64; 4];
    /// Returns bounds of the second, third and fourth derivative of the height of a point in free flight.
    fn flying_bounds(&self, point: usize) -> [f64; 3];
    /// Returns the acceleration of a place by turning in a free flight of this length, and the change of its velocity
    /// by it.
    fn flying_excitation(&self, _place: [f64; 2], _length_s: f64) -> (Sine, f64) {
        (Sine::default(), 0.0)
    }
    /// Returns the time after t in which no angle lets a point touch.
    fn clear(&self, _point: usize, _t: f64) -> f64 {
        0.0
    }

    /// Returns the present lever arms.
    fn arms(&self) -> Self::Arms;
    /// Returns M_ij by these lever arms.
    fn coupling(&self, arms: &Self::Arms, i: usize, j: usize) -> f64;
    /// Returns the acceleration of a place by a force of 1 over the mass at each point.
    fn couplings_of(&self, arms: &Self::Arms, place: [f64; 2]) -> [f64; N];
    /// Returns the acceleration with which each point falls without contact: gravity and turning.
    fn falls(&self, arms: &Self::Arms) -> [f64; N];
    /// Returns the upward acceleration of a place by turning alone.
    fn turning(&self, _arms: &Self::Arms, _place: [f64; 2]) -> f64 {
        0.0
    }
    /// Returns the pose a time t later, after the impulses ∫F dt and double integrals ∬F dt² of the ground at these
    /// lever arms.
    fn after(&self, t: f64, arms: &Self::Arms, pushes: &Pushes<N>) -> Self;

    /// Returns the pose in the middle of a phase, with the mean of the angles at its begin, middle and end, weighed by
    /// its forces.
    fn mean(_begin: &Self, middle: &Self, _end: &Self, _weigh: impl Fn([f64; 3]) -> f64) -> Self {
        *middle
    }
    /// Returns the angle from another pose as far as it changes lever arms.
    fn turned_from(&self, _other: &Self) -> f64 {
        0.0
    }
    /// Returns the relative change of the lever arm of a point by a turn.
    fn steepness(&self, _arms: &Self::Arms, _point: usize) -> f64 {
        0.0
    }
    /// Returns the largest change, by a turn, of the acceleration of any point by a force on this one, over that of this point.
    fn bend(&self, _arms: &Self::Arms, _point: usize) -> f64 {
        0.0
    }

    /// Returns the points and forces by which the ground can bear the weight at these lever arms and heights; the force
    /// on each point is a straight line, given by stiffness and height without force.
    fn borne(&self, arms: &Self::Arms, height: &[f64; N], line: impl Fn(usize) -> [f64; 2]) -> Option<Borne<N>>;
    /// Returns the energy that it may still give by coming to lie on a lower side.
    fn lower(&self) -> f64 {
        0.0
    }
    /// Returns the forces on the lying points if they hold the body, together with those on the others.
    fn held_by(&self, _lying: &[bool; N], _forces: &[f64; N]) -> Option<[f64; N]> {
        None
    }
    /// Returns the impulses at carrying points that stop it; `None` where they cannot.
    fn stopping(&self, carrying: &[bool; N]) -> Option<[Option<f64>; N]>;

    /// Returns the pose without motion.
    #[must_use]
    fn still(&self) -> Self;

    /// Returns the time until it stands upright and may turn over to a side without points.
    fn upright(&self) -> f64 {
        f64::INFINITY
    }
    /// Returns whether it has turned over.
    fn is_over(&self) -> bool {
        false
    }
    /// Returns the pose without whole turns, which have no effect and cost digits.
    #[must_use]
    fn unwound(self) -> Self {
        self
    }

    /// Returns the heights and vertical velocities of all points.
    fn points(&self) -> ([f64; N], [f64; N]) {
        self.points_by(&self.arms())
    }
    /// Returns M_ij at the present lever arms.
    fn coupled(&self, i: usize, j: usize) -> f64 {
        self.coupling(&self.arms(), i, j)
    }
    /// Returns the present acceleration with which a point falls without contact.
    fn fall(&self, point: usize) -> f64 {
        self.falls(&self.arms())[point]
    }
}

/// The size of a body.
#[derive(Debug, Clone, Copy)]
pub struct Extent {
    /// Its length, or twice its reach if that is shorter.
    pub(super) size: f64,
    /// Distance from the center of mass to the farthest point.
    pub(super) reach: f64,
    /// The largest M_ii at any angle.
    pub(crate) coupling: f64,
}

/// The integrals of the forces of the ground since a phase began: ∫F dt and ∬F dt² of each point, per mass.
#[derive(Debug, Clone, Copy)]
pub struct Pushes<const N: usize> {
    pub(super) impulse: [f64; N],
    pub(super) path: [f64; N],
}

/// Returns the pushes at some points that give the wanted motions of these points: x of M x = b, of as many of them as
/// move independently.
///
/// Four corners of a plate have three degrees of freedom: a pivot that is no more than a rounding is left out.
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

/// Returns whether a point moves while others are held: its coupling with these held, over that without, exceeds
/// roundings.
pub(super) fn moves_freely(held: f64, own: f64) -> bool {
    held > 1e-10 * own
}

/// A body whose weight the ground bears.
#[derive(Debug, Clone, Copy)]
pub struct Borne<const N: usize> {
    /// Points that may bear it.
    pub(super) on: [bool; N],
    /// Their forces.
    pub(super) forces: [f64; N],
}
