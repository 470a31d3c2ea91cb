//! This module finds the damage boundary of a pulse or a record: the velocity changes and accelerations of a shock that damage a part.
//!
//! ```
//! use clatter_answer::spectrum::boundary::Boundary;
//! use clatter_shock::{DamageBoundary, DampingRatio, Limit, Pulse, Shape, Suspension};
//! // A part of 100 Hz that stands 2000 m/s², in a half-sine of 10 000 m/s² and 1 ms.
//! let part = Suspension::from_hz(100.0, DampingRatio::new(0.05)?)?;
//! let pulse = Pulse { shape: Shape::HalfSine, amplitude: 1e4, duration: 1e-3, start: 0.0 };
//! let boundary = DamageBoundary::new(part, Limit::Acceleration(2000.0), pulse.shape)?;
//! assert!(!Boundary::of_pulse(&boundary, &pulse)?.margin.is_safe());
//! # Ok::<(), clatter_shock::Error>(())
//! ```

use std::f64::consts::TAU;

use clatter_record::{Between, Channel};
use clatter_shock::{DamageBoundary, Error, Frequencies, HistoryBoundary, Limit, Margin, Pulse, Quantity, Suspension};

use super::largest;
use crate::shape_name;

/// The damage boundary, and where the shock stands.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Boundary {
    /// The shape of the pulse, or the name of the record.
    pub of: String,
    /// The critical velocity change in m/s; none where velocities cancel.
    pub critical_velocity_change: Option<f64>,
    /// The critical acceleration in m/s².
    pub critical_acceleration: f64,
    /// The velocity change at the knee in m/s; none where velocities cancel.
    pub knee_velocity_change: Option<f64>,
    /// Velocity changes and accelerations.
    pub curve: Vec<(f64, f64)>,
    /// The velocity change of the shock.
    pub velocity_change: f64,
    /// The acceleration of the shock.
    pub acceleration: f64,
    /// The margin of the part for the shock.
    pub margin: Margin,
}

/// The number of points of the damage boundary between the critical velocity change and the knee.
const BOUNDARY_POINTS: usize = 200;

impl Boundary {
    /// Finds the damage boundary of a pulse.
    ///
    /// # Errors
    /// An amplitude or a duration that is none.
    pub fn of_pulse(numbers: &DamageBoundary, pulse: &Pulse) -> Result<Self, Error> {
        let knee = numbers.knee_velocity_change();
        Ok(Self {
            of: shape_name(pulse.shape),
            critical_velocity_change: Some(numbers.critical_velocity_change()),
            critical_acceleration: numbers.critical_acceleration(),
            knee_velocity_change: Some(knee),
            curve: numbers.curve(BOUNDARY_POINTS)?,
            velocity_change: pulse.velocity_change().abs(),
            acceleration: pulse.amplitude.abs(),
            margin: numbers.margin(pulse.amplitude, pulse.duration)?,
        })
    }

    /// Finds the damage boundary of a channel of a record.
    ///
    /// # Errors
    /// Fails for a history without a boundary, or a frequency that its samples do not cover.
    pub fn of_channel(
        channel: &Channel,
        between: Between,
        part: &Suspension,
        limit: Limit,
    ) -> Result<Self, clatter_record::Error> {
        let points = channel.history(between);
        let numbers = HistoryBoundary::new(*part, limit, &points)?;
        let hz = Frequencies::list(vec![part.omega() / TAU])?;
        let (quantity, allowed) = match limit {
            Limit::Acceleration(allowed) => (Quantity::AbsoluteAcceleration, allowed),
            Limit::RattleSpace(allowed) => (Quantity::RelativeDisplacement, allowed),
        };
        let demand = channel.spectrum(&hz, part.damping(), quantity, between, |_| ())?.maximax[0];
        let cancels = numbers.critical_velocity_change().is_none();
        Ok(Self {
            of: channel.name.clone(),
            critical_velocity_change: numbers.critical_velocity_change(),
            critical_acceleration: numbers.critical_acceleration(),
            knee_velocity_change: numbers.knee_velocity_change(),
            curve: if cancels { Vec::new() } else { numbers.curve(BOUNDARY_POINTS)? },
            velocity_change: velocity_change(&points).abs(),
            acceleration: largest(channel),
            margin: Margin { allowed, demand },
        })
    }
}

/// Returns the area below straight lines, in m/s.
fn velocity_change(points: &[(f64, f64)]) -> f64 {
    points.windows(2).map(|pair| (pair[1].0 - pair[0].0) * 0.5 * (pair[0].1 + pair[1].1)).sum()
}
