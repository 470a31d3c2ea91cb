//! A box with its contacts: forces at its corners, and the accelerations by them.

use super::dormand_prince::Vector;
use super::{Block, times};

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// State of the contact of a corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Hold {
    Up,
    Loads,
    /// Unloading from the largest depth.
    Unloads(f64),
    /// Contact of a dashpot that would pull.
    Slack,
}

#[derive(Debug, Clone, Copy)]
pub(super) struct Corner {
    pub(super) hold: Hold,
    /// Height of the ground of this corner: 0, or the bottom of its dent.
    pub(super) ground: f64,
    /// Stiffness of loading over the mass.
    pub(super) stiffness: f64,
    /// Index of its press, from 0.
    pub(super) strike: usize,
}

impl Corner {
    /// Returns whether the ground presses on it.
    fn bears(&self) -> bool {
        !matches!(self.hold, Hold::Up | Hold::Slack)
    }
}

/// A box with its contacts.
#[derive(Debug, Clone, Copy)]
pub(super) struct System {
    pub(super) corners: [[f64; 3]; 8],
    /// The box.
    pub(super) block: Block,
    pub(super) gravity: f64,
    /// θ of dashpots, and e² of the hysteretic contact of each corner.
    pub(super) delay: f64,
    pub(super) loss: [f64; 8],
    pub(super) holds: [Corner; 8],
}

/// Moment of a force of 1 on each corner, and the angular acceleration by it.
pub(super) struct Turns {
    arms: [[f64; 3]; 8],
    turned: [[f64; 3]; 8],
}

impl Turns {
    /// Returns the acceleration of one corner by a force of 1 over the mass on another.
    pub(super) fn coupling(&self, i: usize, j: usize) -> f64 {
        1.0 + dot(self.arms[i], self.turned[j])
    }
}

pub(super) fn parts(y: &Vector) -> (f64, f64, [f64; 3], [f64; 3]) {
    (y[0], y[1], [y[2], y[3], y[4]], [y[5], y[6], y[7]])
}

impl System {
    /// Returns the height and vertical velocity of a place from the center of mass.
    #[inline]
    pub(super) fn place(y: &Vector, place: [f64; 3]) -> (f64, f64) {
        let (z, v, n, spin) = parts(y);
        (z + dot(n, place), v + dot(n, cross(spin, place)))
    }
    pub(super) fn force(&self, corner: usize, y: &Vector) -> f64 {
        if self.holds[corner].bears() { self.press(corner, Self::place(y, self.corners[corner])) } else { 0.0 }
    }
    #[inline]
    pub(super) fn press(&self, corner: usize, (height, velocity): (f64, f64)) -> f64 {
        let (Corner { hold, ground, stiffness, .. }, loss) = (self.holds[corner], self.loss[corner]);
        let depth = ground - height;
        match hold {
            Hold::Unloads(deepest) => stiffness / loss * (depth - deepest * (1.0 - loss)),
            _ => stiffness * (depth - self.delay * velocity),
        }
    }
    /// Returns whether the ground presses on a corner.
    pub(super) fn presses(&self) -> bool {
        self.holds.iter().any(Corner::bears)
    }
    /// Returns the force over the mass, and moment over the mass.
    pub(super) fn load(&self, y: &Vector) -> (f64, [f64; 3]) {
        let (_, _, n, _) = parts(y);
        let (mut force, mut moment) = (0.0, [0.0; 3]);
        for (i, corner) in self.corners.iter().enumerate().filter(|(i, _)| self.holds[*i].bears()) {
            let own = self.press(i, Self::place(y, *corner));
            if own != 0.0 {
                let arm = cross(*corner, n);
                force += own;
                (0..3).for_each(|axis| moment[axis] += own * arm[axis]);
            }
        }
        (force, moment)
    }
    /// Returns the angular acceleration.
    pub(super) fn turning(&self, spin: [f64; 3], moment: [f64; 3]) -> [f64; 3] {
        let gyration = cross(spin, times(&self.block.inertia, spin));
        times(&self.block.inverse, std::array::from_fn(|axis| moment[axis] - gyration[axis]))
    }
    pub(super) fn slope(&self, y: &Vector) -> Vector {
        let (_, v, n, spin) = parts(y);
        let (force, moment) = self.load(y);
        let (turn, spun) = (cross(n, spin), self.turning(spin, moment));
        [v, force - self.gravity, turn[0], turn[1], turn[2], spun[0], spun[1], spun[2]]
    }
    /// Returns the effect of a vertical force on each corner on the rotation of the box.
    pub(super) fn turns(&self, n: [f64; 3]) -> Turns {
        let arms = self.corners.map(|corner| cross(corner, n));
        Turns { arms, turned: arms.map(|arm| times(&self.block.inverse, arm)) }
    }
    /// Returns the height at which a corner parts from the ground, from its present depth.
    pub(super) fn dent(&self, i: usize, y: &Vector) -> f64 {
        let Corner { hold, ground, .. } = self.holds[i];
        let deepest = match hold {
            Hold::Up | Hold::Slack => 0.0,
            Hold::Loads => (ground - Self::place(y, self.corners[i]).0).max(0.0),
            Hold::Unloads(deepest) => deepest,
        };
        ground - deepest * (1.0 - self.loss[i])
    }
    /// Returns the kinetic and potential energy over the mass.
    pub(super) fn energy(&self, y: &Vector) -> f64 {
        let (z, v, _, spin) = parts(y);
        0.5 * (v * v + dot(spin, times(&self.block.inertia, spin))) + self.gravity * z
    }
    /// Returns the energy that pressed corners may give back, over the mass.
    pub(super) fn stored(&self, y: &Vector) -> f64 {
        let one = |i: usize| {
            let Corner { hold, ground, stiffness, .. } = self.holds[i];
            let (depth, loss) = (ground - Self::place(y, self.corners[i]).0, self.loss[i]);
            match hold {
                Hold::Up | Hold::Slack => 0.0,
                Hold::Loads => 0.5 * loss * stiffness * depth * depth,
                Hold::Unloads(deepest) => 0.5 * stiffness / loss * (depth - deepest * (1.0 - loss)).powi(2),
            }
        };
        (0..8).map(one).sum()
    }
    /// Returns whether a corner is up all along a step from y within which the numbers change by `reach` at most, with
    /// a margin for roundings.
    pub(super) fn stays_up(&self, i: usize, y: &Vector, reach: &Vector) -> bool {
        let (Corner { hold, ground, .. }, corner) = (self.holds[i], self.corners[i]);
        let falls = reach[0] + dot([reach[2], reach[3], reach[4]], corner.map(f64::abs));
        hold == Hold::Up && ground == 0.0 && y[0] + dot([y[2], y[3], y[4]], corner) > falls * (1.0 + 1e-6)
    }
    /// Returns whether a corner has come to its next event.
    pub(super) fn has_happened(&self, i: usize, y: &Vector) -> bool {
        let Corner { hold, ground, .. } = self.holds[i];
        // Most corners are up, most of the time.
        if hold == Hold::Up && ground == 0.0 && y[0] + dot([y[2], y[3], y[4]], self.corners[i]) >= 0.0 {
            return false;
        }
        let motion @ (height, velocity) = Self::place(y, self.corners[i]);
        let depth = ground - height;
        match hold {
            Hold::Up => depth > 0.0 && velocity < 0.0 || ground < 0.0 && height > 0.0,
            Hold::Loads if self.delay > 0.0 => self.press(i, motion) <= 0.0,
            Hold::Loads => velocity >= 0.0,
            Hold::Unloads(deepest) => depth <= deepest * (1.0 - self.loss[i]) || depth > deepest && velocity < 0.0,
            Hold::Slack => depth <= 0.0 || self.press(i, motion) > 0.0,
        }
    }
}
