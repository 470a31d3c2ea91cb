//! The stops of a suspended component, and its touches of them.

use crate::Error;
use std::f64::consts::FRAC_PI_2;

/// Restitution below which a stop counts as this dead: its way back is 10⁴ times as stiff as its way in.
const LEAST_RESTITUTION: f64 = 0.01;

/// Two stops, at +gap and −gap from the rest position of a suspended component, that it presses beside its spring and
/// damper.
///
/// The force F per mass of the component follows the hysteretic law of Walton and Braun (J. Rheol. 30, 1986). With the
/// depth d below the surface of the stop, its largest value d_max in this press, and
///
/// ```text
/// first loading            F = k₁ d,             k₁ = ω₁²,   ω₁ = (π/2)(1 + e)/τ
/// unloading, reloading     F = k₂ (d − d₀),      k₂ = k₁/e²,   d₀ = d_max (1 − e²)
/// ```
///
/// it never pulls: the component parts from the stop at F = 0, and beyond d_max it is on the first line again. Parted, it
/// leaves a dent: the surface of that stop stays d₀ lower, and the next press begins there on the first line. Once the
/// component has been back within the gap, the surface is up again. Each stop has its own dent.
///
/// τ is the contact time of the component alone on the stop, and e its restitution: without its spring it arrives at v,
/// leaves at ev, and presses with at most (π/2)(1 + e) v/τ per mass.
///
/// # Examples
///
/// ```
/// # use clatter_shock::Stop;
/// let stop = Stop::new(1e-3, 0.5e-3, 0.4)?;
/// assert_eq!((stop.gap(), stop.contact_time(), stop.restitution()), (1e-3, 0.5e-3, 0.4));
/// # Ok::<(), clatter_shock::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "crate::fields::StopFields", into = "crate::fields::StopFields")
)]
pub struct Stop {
    gap: f64,
    contact_time: f64,
    restitution: f64,
}

impl Stop {
    /// Creates stops from the gap on either side, the contact time and the restitution. A restitution below 0.01 acts as
    /// 0.01.
    ///
    /// # Errors
    /// [`Error::Quantity`] unless gap and contact time are finite and positive and the restitution is in [0, 1].
    pub fn new(gap: f64, contact_time: f64, restitution: f64) -> Result<Self, Error> {
        let gap = crate::error::positive("gap of the stop", gap)?;
        let contact_time = crate::error::positive("contact time of the stop", contact_time)?;
        if (0.0..=1.0).contains(&restitution) {
            Ok(Self { gap, contact_time, restitution: restitution + 0.0 })
        } else {
            Err(Error::Quantity { name: "restitution of the stop", value: restitution, allowed: "in [0, 1]" })
        }
    }
    /// Returns the distance from the rest position to the stop on either side.
    #[must_use]
    pub fn gap(&self) -> f64 {
        self.gap
    }
    /// Returns the contact time τ of the component alone on the stop.
    #[must_use]
    pub fn contact_time(&self) -> f64 {
        self.contact_time
    }
    /// Returns the restitution e.
    #[must_use]
    pub fn restitution(&self) -> f64 {
        self.restitution
    }
    /// Returns the restitution that acts.
    pub(crate) fn acting_restitution(&self) -> f64 {
        self.restitution.max(LEAST_RESTITUTION)
    }
    /// Returns ω₁ = √k₁. A contact time so short that it overflows counts as the shortest that does not.
    pub(crate) fn omega(&self) -> f64 {
        (FRAC_PI_2 * (1.0 + self.acting_restitution()) / self.contact_time).min(MOST_OMEGA)
    }
}

/// The largest ω₁: the way back, a hundred times it, is still finite.
const MOST_OMEGA: f64 = 1e300;

/// One touch of a stop: the component reaches its surface.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Hit {
    /// Time of the touch, on the time axis of the excitation.
    pub time: f64,
    /// Speed |z′| at the touch.
    pub speed: f64,
    /// Sign of z there: 1 for the stop at +gap, −1 for that at −gap.
    pub side: i8,
}
