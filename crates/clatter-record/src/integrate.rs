//! Velocity and displacement of a record.

use crate::Error;
use clatter_shock::samples::{Sum, check};

/// Velocity and displacement at the samples, from rest at the first one.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// m/s.
    pub velocity_m_s: Vec<f64>,
    /// m.
    pub displacement_m: Vec<f64>,
}

/// Integrates a record once and twice, with straight lines between the samples; both start at zero.
///
/// For samples aᵢ a time h apart
/// ```text
/// vᵢ₊₁ = vᵢ + h (aᵢ + aᵢ₊₁)/2,      xᵢ₊₁ = xᵢ + h vᵢ + h² (aᵢ/3 + aᵢ₊₁/6)
/// ```
/// which is exact for the straight lines. Take the baseline out first: an offset of b grows to b t and b t²/2.
///
/// # Accuracy
///
/// The sums are compensated. Against the exact integral of the straight lines, a velocity is within 3 roundings of itself
/// (and ε² h Σ|aᵢ|), a displacement within 3 roundings of itself and one of h² Σ|aᵢ|, at any length.
///
/// # Errors
///
/// [`Error::Shock`] for a time between samples outside [1e-15, 1e9] s, a sample that is not usable, or none.
///
/// # Examples
///
/// 2 m/s² for a second: 2 m/s and 1 m.
///
/// ```
/// let motion = clatter_record::integrate(&[2.0, 2.0, 2.0], 0.5)?;
/// assert_eq!(motion.velocity_m_s, [0.0, 1.0, 2.0]);
/// assert_eq!(motion.displacement_m, [0.0, 0.25, 1.0]);
/// # Ok::<(), clatter_record::Error>(())
/// ```
pub fn integrate(acceleration: &[f64], step_s: f64) -> Result<Motion, Error> {
    check(acceleration, step_s, "an integral", 1)?;
    let n = acceleration.len();
    let mut motion = Motion { velocity_m_s: Vec::with_capacity(n), displacement_m: Vec::with_capacity(n) };
    // In units of the step: first = v/h, second = x/h².
    let (mut first, mut second) = (Sum::default(), Sum::default());
    let mut previous = None;
    for &a in acceleration {
        if let Some(b) = previous {
            // Both parts of the first sum, so that no rounding of it adds up in the second.
            for part in first.parts() {
                second.add(part);
            }
            second.add(b / 3.0);
            second.add(a / 6.0);
            first.add(0.5 * b);
            first.add(0.5 * a);
        }
        previous = Some(a);
        motion.velocity_m_s.push(step_s * first.value());
        motion.displacement_m.push(step_s * (step_s * second.value()));
    }
    Ok(motion)
}
