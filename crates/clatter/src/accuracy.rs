//! The errors that are allowed, quantity by quantity: one table that the docs state and the tests hold.
//!
//! The table leaves out the count and the answer to whether a train ends: they are exact, off center as well. The
//! impact that holds the peak of a bar with its mass in the middle is exact too.

/// The number of impacts up to which a train counts as short.
pub const SHORT: u64 = 10_000;

/// The largest error that a quantity may have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Allowance {
    /// The quantity.
    pub quantity: &'static str,
    /// Largest error over `scale`.
    pub error: f64,
    /// The quantity that the error is divided by.
    pub scale: &'static str,
    /// The range in which the bound holds.
    pub range: &'static str,
}

/// Peak velocity shocks.
pub const PEAK: Allowance = Allowance { quantity: "peak", error: 1e-13, scale: "itself", range: "everywhere" };
/// Velocity of the striking end before an impact.
pub const APPROACH: Allowance = Allowance {
    quantity: "approach velocity",
    error: 1e-12,
    scale: "the larger of itself and the first",
    range: "a train of any length",
};
/// Jumps of the velocities of both ends at an impact.
pub const JUMP: Allowance = Allowance {
    quantity: "velocity jump",
    error: 1e-12,
    scale: "twice the larger of its approach velocity and the first",
    range: "a train of any length",
};
/// Time of an impact.
pub const TIME: Allowance = Allowance {
    quantity: "strike time",
    error: 1e-10,
    scale: "the larger of itself and h0/v0",
    range: "a train of any length",
};
/// Final velocities and net changes.
pub const FINAL: Allowance = Allowance {
    quantity: "final velocity",
    error: 1e-9,
    scale: "the larger of both ends",
    range: "up to 10^4 impacts",
};
/// Time of the last impact of a short train, and the limit of an endless one.
pub const DURATION: Allowance = Allowance {
    quantity: "duration",
    error: 1e-9,
    scale: "the larger of itself and h0/v0",
    range: "up to 10^4 impacts, and endless",
};
/// Time of the last impact of a long train.
pub const DURATION_LONG: Allowance = Allowance { error: 1e-6, range: "beyond 10^4 impacts", ..DURATION };
/// Times and final velocities of a train that hardly ends at all.
pub const NEAR_ENDLESS: Allowance = Allowance {
    quantity: "time, final velocity",
    error: 1e-5,
    range: "a start within 1e-9 of the edge of endless",
    ..DURATION
};

/// All allowances.
pub const TABLE: [Allowance; 8] = [PEAK, APPROACH, JUMP, TIME, FINAL, DURATION, DURATION_LONG, NEAR_ENDLESS];
