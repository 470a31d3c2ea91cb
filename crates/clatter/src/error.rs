//! The one error type of the crate. Each error holds the given value and the allowed range.

/// A value that describes no bar, no drop or no grid. Each message names the value and the range.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A restitution outside [0, 1].
    #[error("restitution e = {0:?} is not in [0, 1]")]
    Restitution(f64),
    /// An inertia ratio outside (−1, 1].
    #[error("inertia ratio q = {0:?} is not in (-1, 1]")]
    InertiaRatio(f64),
    /// A length, mass, radius or moment that is not finite and positive (or not negative, where zero makes sense).
    #[error("{name} = {value:?} is not {allowed}")]
    Quantity {
        /// The quantity, with its unit.
        name: &'static str,
        /// The value.
        value: f64,
        /// The range that makes sense.
        allowed: &'static str,
    },
    /// End a does not approach the ground, or a velocity is not a number of a usable size.
    #[error("starting velocities [{0:?}, {1:?}]: {2}")]
    Velocity(f64, f64, &'static str),
    /// A center of mass off the middle, where only a symmetric bar makes sense.
    #[error("the center of mass lies {offset:?} of a half-length off the middle; this bar must be symmetric")]
    OffCenter {
        /// Offset over half-length.
        offset: f64,
    },
    /// A list of masses without any.
    #[error("no mass is given")]
    NoMass,
    /// A grid axis that is no axis.
    #[error("axis {name} = {lo:?}:{hi:?}:{points}: {reason}")]
    Axis {
        /// `q`, `gyration ratio` or `e`.
        name: &'static str,
        /// First value.
        lo: f64,
        /// Last value.
        hi: f64,
        /// Number of values.
        points: usize,
        /// The fault and the allowed range.
        reason: &'static str,
    },
    /// A map of more points than memory is set aside for, or than there is memory for.
    #[error("a map of {0} points takes more memory than is set aside: at most 268435456 points (2 GiB)")]
    TooLarge(usize),
}
