//! A drop of a box at the moment of its first touch.

use clatter::Error;

use super::Block;
use super::system::{cross, dot};
use crate::scene::within;

/// A box at the moment when its lowest corner touches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BlockDrop {
    pub(super) block: Block,
    /// Vertical in axes of the box.
    pub(super) upward: [f64; 3],
    /// The axis x of the world, along the ground, in axes of the box.
    pub(super) along: [f64; 3],
    pub(super) friction: f64,
    /// Velocity of the center of mass along x and y of the world.
    pub(super) slide: [f64; 2],
    pub(super) spin: [f64; 3],
    pub(super) speed: f64,
    pub(super) gravity: f64,
    pub(super) time_limit: f64,
    pub(super) lands_after: f64,
    pub(super) impact_limit: usize,
    pub(super) enough: f64,
}

impl BlockDrop {
    /// Creates a drop of a box whose axes are turned into those of the world, z upward, by the unit quaternion w, x, y,
    /// z; its center of mass comes down at a speed.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless the quaternion has the length 1 to 1e−6, the speed is in [1e−6, 1e6] m/s, and gravity is 0 or in
    /// [1e−6, 1e6] m/s².
    pub fn new(block: Block, orientation: [f64; 4], speed_m_s: f64, gravity_m_s2: f64) -> Result<Self, Error> {
        let length = orientation.iter().map(|x| x * x).sum::<f64>().sqrt();
        within("length of the quaternion", length, 1.0 - 1e-6, 1.0 + 1e-6, "1: a rotation is a unit quaternion")?;
        let [w, x, y, z] = orientation.map(|part| part / length);
        let upward = [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)];
        let along = [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)];
        Self::toward(block, upward, speed_m_s, gravity_m_s2)?.with_along(along)
    }

    /// Creates a drop of a box whose bottom is tilted by an angle, highest in a direction that turns from x towards y.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless the tilt is in [0, π] and the direction within a turn; else as [`BlockDrop::new`].
    pub fn tilted(
        block: Block,
        tilt_rad: f64,
        direction_rad: f64,
        speed_m_s: f64,
        gravity_m_s2: f64,
    ) -> Result<Self, Error> {
        use std::f64::consts::{PI, TAU};
        within("tilt in rad", tilt_rad, 0.0, PI, "in [0, pi]")?;
        within("direction in rad", direction_rad, -TAU, TAU, "within a turn")?;
        let (sin, cos) = (libm::sin(tilt_rad), libm::cos(tilt_rad));
        let upward = [sin * libm::cos(direction_rad), sin * libm::sin(direction_rad), cos];
        Self::toward(block, upward, speed_m_s, gravity_m_s2)
    }

    /// Creates a drop of a box with this vertical in its axes, of any length.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless it has a direction; else as [`BlockDrop::new`].
    pub fn upright(block: Block, upward: [f64; 3], speed_m_s: f64, gravity_m_s2: f64) -> Result<Self, Error> {
        let length = dot(upward, upward).sqrt();
        within("length of the vertical", length, 1e-9, 1e9, "in [1e-9, 1e9]")?;
        Self::toward(block, upward.map(|part| part / length), speed_m_s, gravity_m_s2)
    }

    fn toward(block: Block, upward: [f64; 3], speed_m_s: f64, gravity_m_s2: f64) -> Result<Self, Error> {
        within("speed in m/s", speed_m_s, 1e-6, 1e6, "in [1e-6, 1e6]")?;
        if gravity_m_s2 != 0.0 {
            within("gravity in m/s²", gravity_m_s2, 1e-6, 1e6, "0 or in [1e-6, 1e6]")?;
        }
        Ok(Self {
            block,
            upward,
            along: level(upward, if upward[0].abs() < 0.9 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] }),
            friction: 0.0,
            slide: [0.0; 2],
            spin: [0.0; 3],
            speed: speed_m_s,
            gravity: gravity_m_s2 + 0.0,
            time_limit: f64::INFINITY,
            lands_after: f64::INFINITY,
            impact_limit: 100_000,
            enough: 0.0,
        })
    }

    /// Returns the drop with a spin at the first touch, in axes of the box.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless each is within 10⁵ rad/s and a lowest corner still approaches.
    pub fn with_spin(mut self, spin_rad_s: [f64; 3]) -> Result<Self, Error> {
        for spin in spin_rad_s {
            within("spin in rad/s", spin, -1e5, 1e5, "in [-1e5, 1e5]")?;
        }
        self.spin = spin_rad_s;
        let heights = self.block.corners_m().map(|corner| dot(self.upward, corner));
        let lowest = heights.iter().copied().fold(f64::INFINITY, f64::min);
        let near = 1e-12 * self.block.half.iter().sum::<f64>();
        let slowest = (0..8)
            .filter(|&i| heights[i] <= lowest + near)
            .map(|i| dot(self.upward, cross(spin_rad_s, self.block.corners_m()[i])) - self.speed)
            .fold(f64::INFINITY, f64::min);
        within(
            "velocity of the lowest corner in m/s",
            slowest,
            -1e9,
            -1e-9,
            "downward: with this spin it does not land",
        )?;
        Ok(self)
    }

    /// Returns the drop with this axis x of the world, made level, in axes of the box.
    ///
    /// # Errors
    /// [`Error::Quantity`] for one that is upright or none.
    pub fn with_along(mut self, along: [f64; 3]) -> Result<Self, Error> {
        let rises = dot(along, self.upward);
        let level = (dot(along, along) - rises * rises).max(0.0).sqrt();
        within("level part of the axis x of the world", level, 1e-9, 1e9, "in [1e-9, 1e9]")?;
        self.along = self::level(self.upward, along);
        Ok(self)
    }

    /// Returns the drop on ground with a coefficient of friction.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless it is in [0, 10].
    pub fn with_friction(mut self, friction: f64) -> Result<Self, Error> {
        within("friction", friction, 0.0, 10.0, "in [0, 10]")?;
        self.friction = friction + 0.0;
        Ok(self)
    }

    /// Returns the drop with a velocity along x and y of the world, which friction alone takes notice of.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless both are within 10⁶ m/s.
    pub fn with_slide(mut self, slide_m_s: [f64; 2]) -> Result<Self, Error> {
        for slide in slide_m_s {
            within("velocity along the ground in m/s", slide, -1e6, 1e6, "in [-1e6, 1e6]")?;
        }
        self.slide = slide_m_s;
        Ok(self)
    }

    /// Returns the drop, left where it lands again: at the first touch of a corner after a time since the first touch.
    #[must_use]
    pub fn until_it_lands_after_s(mut self, time_s: f64) -> Self {
        self.lands_after = time_s;
        self
    }

    /// Returns the drop with a limit of time since the first touch: later strikes are not computed.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless positive; infinity is no limit.
    pub fn with_time_limit_s(mut self, time_s: f64) -> Result<Self, Error> {
        if time_s > 0.0 {
            self.time_limit = time_s;
            return Ok(self);
        }
        Err(Error::Quantity { name: "time limit in s", value: time_s, allowed: "positive" })
    }

    /// Returns the drop with a limit on the number of strikes.
    #[must_use]
    pub fn with_impact_limit(mut self, impacts: usize) -> Self {
        self.impact_limit = impacts.max(1);
        self
    }

    /// Returns the drop with an earlier end: where the remaining energy lets later presses change the velocity of no
    /// corner by more than this share of the largest approach.
    #[must_use]
    pub fn with_enough(mut self, share: f64) -> Self {
        self.enough = share;
        self
    }

    /// Returns the box.
    #[must_use]
    pub fn block(&self) -> Block {
        self.block
    }
    /// Returns the vertical in axes of the box.
    #[must_use]
    pub fn upward(&self) -> [f64; 3] {
        self.upward
    }
    /// Returns the speed of the center of mass at the first touch, downward.
    #[must_use]
    pub fn speed_m_s(&self) -> f64 {
        self.speed
    }
    /// Returns the limit of time since the first touch.
    #[must_use]
    pub fn time_limit_s(&self) -> f64 {
        self.time_limit
    }
    /// Returns the coefficient of friction of the ground.
    #[must_use]
    pub fn friction(&self) -> f64 {
        self.friction
    }
    /// Returns the axis x of the world in axes of the box.
    #[must_use]
    pub fn along(&self) -> [f64; 3] {
        self.along
    }
    /// Returns the acceleration of gravity.
    #[must_use]
    pub fn gravity_m_s2(&self) -> f64 {
        self.gravity
    }
    /// Returns the spin at the first touch, in axes of the box.
    #[must_use]
    pub fn spin_rad_s(&self) -> [f64; 3] {
        self.spin
    }
}

/// Returns the direction of the level part of an axis.
fn level(upward: [f64; 3], axis: [f64; 3]) -> [f64; 3] {
    let rises = dot(axis, upward);
    let level: [f64; 3] = std::array::from_fn(|k| axis[k] - rises * upward[k]);
    let length = dot(level, level).sqrt();
    level.map(|part| part / length)
}
