//! The arrival of the bar: the velocities of both ends at first contact and the height gap.

use crate::Error;
use crate::dd::Dd;

/// An end of the bar. End `a` strikes first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum End {
    /// The end that strikes first, at position −1.
    A,
    /// The other end, at position 1.
    B,
}

impl End {
    /// Returns the other end.
    #[must_use]
    pub fn other(self) -> Self {
        match self {
            Self::A => Self::B,
            Self::B => Self::A,
        }
    }
    /// Returns the end of impact `number` (from 1): odd numbers fall on `a`, even ones on `b`.
    #[must_use]
    pub fn striking(number: u64) -> Self {
        if number % 2 == 1 { Self::A } else { Self::B }
    }
}

/// State of the bar at the instant end `a` first touches.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "crate::fields::StartFields", into = "crate::fields::StartFields")
)]
pub struct Start {
    velocity: [f64; 2],
    height_gap: f64,
    /// Rounding error of `velocity[1]`, which for an off-center bar is κ times the velocity of end b, and the velocity
    /// of end b itself.
    rest: f64,
    pub(crate) own_b: f64,
    /// True if a train may begin by plain steps; it does not depend on the bar.
    pub(crate) plain: bool,
}

/// With |v_a| and h0 not smaller than this or larger than its reciprocal, and T and e not small, no term of a plain
/// step comes near the subnormal floats, nor near those that overflow.
const MODERATE: f64 = 1e-20;

impl Default for Start {
    /// Returns pure translation at unit speed with unit height gap: velocities in v0, times in h0/v0.
    fn default() -> Self {
        Self::of([-1.0, -1.0], 1.0)
    }
}

impl Start {
    /// Creates a start from the velocities of both ends (upward positive) and the height of end `b` above the ground.
    ///
    /// # Errors
    /// [`Error::Velocity`] unless `velocity[0]` is in [−1e150, −1e−150] and `|velocity[1]| ≤ 1e150`;
    /// [`Error::Quantity`] unless `height_gap` is 0 or in [1e−150, 1e150]. Within these bounds no result
    /// overflows that is finite.
    pub fn new(velocity: [f64; 2], height_gap: f64) -> Result<Self, Error> {
        let [va, vb] = velocity;
        if !(-1e150..=-1e-150).contains(&va) {
            return Err(Error::Velocity(va, vb, "end a must approach the ground, with v_a in [-1e150, -1e-150]"));
        }
        if !(-1e150..=1e150).contains(&vb) {
            return Err(Error::Velocity(va, vb, "v_b must be in [-1e150, 1e150]"));
        }
        if height_gap != 0.0 && !(1e-150..=1e150).contains(&height_gap) {
            return Err(Error::Quantity { name: "height gap", value: height_gap, allowed: "0 or in [1e-150, 1e150]" });
        }
        Ok(Self::of([va, vb + 0.0], height_gap + 0.0))
    }
    #[inline]
    fn of(velocity: [f64; 2], height_gap: f64) -> Self {
        let moderate = |x: f64| (MODERATE..=1.0 / MODERATE).contains(&x);
        let plain = velocity[1] <= 0.0 && moderate(-velocity[0]) && (height_gap == 0.0 || moderate(height_gap));
        Self { velocity, height_gap, rest: 0.0, own_b: velocity[1], plain }
    }
    /// Returns the start with the velocity of end b and the height gap times κ, 10⁻⁶ to 10⁶: the arrival of an
    /// off-center bar in the variables of its symmetric one. The bounds of a start leave room for that.
    pub(crate) fn with_b_times(self, kappa: Dd) -> Self {
        let [va, own_b] = self.velocity;
        let Dd { hi, lo } = kappa * own_b;
        Self { rest: lo, own_b, ..Self::of([va, hi], kappa.hi * self.height_gap) }
    }
    /// Returns the velocity of end b to about 2⁻¹⁰⁰.
    pub(crate) fn wide_b(&self) -> Dd {
        Dd { hi: self.velocity[1], lo: self.rest }
    }
    /// Returns the velocities of ends `a` and `b`, upward positive.
    #[must_use]
    pub fn velocity(&self) -> [f64; 2] {
        self.velocity
    }
    /// Returns the height of end `b` above the ground when end `a` touches.
    #[must_use]
    pub fn height_gap(&self) -> f64 {
        self.height_gap
    }
}
