//! Comparisons of one instruction.

/// The smaller one, and b for a NaN: one instruction, where `f64::min` takes five.
#[inline]
pub(super) fn lesser(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The larger one, and b for a NaN.
#[inline]
pub(super) fn greater(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}
