//! The errors that are allowed in the motion of a component: one table that the docs state and the tests hold.
//!
//! ```
//! for allowed in clatter_shock::accuracy::TABLE {
//!     assert!(allowed.error <= 1e-10, "{allowed:?}");
//! }
//! ```

use clatter::accuracy::Allowance;

/// ωz and z′ after free motion ([`crate::Suspension::free`]).
pub const FREE: Allowance = Allowance {
    quantity: "free motion",
    error: 8.0 * f64::EPSILON,
    scale: "(|ωz₀| + |z′₀|) e^(−σωt), σ the slower decay; times 1 + ωt where |ζ − 1| < 0.2",
    range: "ωt up to 10¹²; beyond critical damping ωt/ζ roundings more",
};
/// ωz and z′ at the end of a pulse ([`crate::Pulses::state_at_end`]).
pub const PULSE: Allowance = Allowance {
    quantity: "motion at the end of a pulse",
    error: 1e-13,
    scale: "√((ωz)² + z′²); of ωz itself where ωD ≤ 0.01",
    range: "any pulse, at resonance and at critical damping",
};
/// Peaks in a clatter ([`crate::respond`]).
pub const TRAIN: Allowance =
    Allowance { quantity: "peak in a clatter", error: 1e-12, scale: "itself", range: "trains of up to 300 shocks" };
/// Spectra of records ([`crate::SpectrumFilter`]).
pub const RECORD: Allowance = Allowance {
    quantity: "spectrum of a record",
    error: 1e-10,
    scale: "itself (primary), maximax (others)",
    range: "f/fs from 10⁻⁹ to 10",
};

/// All allowances.
pub const TABLE: [Allowance; 4] = [FREE, PULSE, TRAIN, RECORD];
