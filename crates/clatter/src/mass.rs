//! Masses along a bar, their center and their radius of gyration.

use crate::Error;

/// A piece of mass on the bar, for [`Bar::from_masses`](crate::Bar::from_masses).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Mass {
    /// A point mass.
    Point {
        /// Mass in kg.
        mass_kg: f64,
        /// Distance from the middle of the bar, towards end b positive, in m; it may lie beyond an end.
        position_m: f64,
    },
    /// A slab whose mass is spread evenly along the bar.
    Slab {
        /// Mass in kg.
        mass_kg: f64,
        /// Begin of the slab, from the middle of the bar, in m.
        from_m: f64,
        /// End of the slab, in m, not before its begin.
        to_m: f64,
    },
}

impl Mass {
    fn part(&self) -> Result<Part, Error> {
        let (m, from, to) = match *self {
            Self::Point { mass_kg, position_m } => (mass_kg, place(position_m)?, position_m),
            Self::Slab { mass_kg, from_m, to_m } => {
                let (from, to) = (place(from_m)?, place(to_m)?);
                if to < from {
                    let allowed = "at or beyond where the slab begins";
                    return Err(Error::Quantity { name: "end of slab (m)", value: to, allowed });
                }
                (mass_kg, from, to)
            }
        };
        Ok((positive("mass (kg)", m)?, from, to))
    }
}

/// Returns the center of mass, from the middle towards end b, and radius of gyration about it, of masses along a bar,
/// in m.
///
/// # Accuracy
/// The center is exact to a rounding a mass of the reach of the masses; the radius is summed about it, so that masses
/// close together far off the middle keep their digits, and is 0 where it is no more than roundings of the positions.
///
/// # Errors
/// [`Error::NoMass`] for an empty list, [`Error::Quantity`] where a mass is not in [1e−25, 1e25] kg, a position is
/// beyond ±1e25 m or a slab ends before it begins.
///
/// ```
/// use clatter::{Mass, center_and_gyration};
/// let [center, gyration] = center_and_gyration(&[
///     Mass::Point { mass_kg: 1.0, position_m: 0.01 },
///     Mass::Point { mass_kg: 1.0, position_m: 0.05 },
/// ])?;
/// assert!((center - 0.03).abs() < 1e-17 && (gyration - 0.02).abs() < 1e-17);
/// # Ok::<(), clatter::Error>(())
/// ```
pub fn center_and_gyration(masses: &[Mass]) -> Result<[f64; 2], Error> {
    Ok(center_of(&parts(masses)?))
}

/// The mass of one piece, its begin and its end.
pub(crate) type Part = (f64, f64, f64);

/// Returns the masses as pieces, at least one, or the error of one that is invalid.
pub(crate) fn parts(masses: &[Mass]) -> Result<Vec<Part>, Error> {
    let parts = masses.iter().map(Mass::part).collect::<Result<Vec<_>, _>>()?;
    if parts.is_empty() { Err(Error::NoMass) } else { Ok(parts) }
}

/// Returns [`center_and_gyration`] of valid masses.
pub(crate) fn center_of(parts: &[Part]) -> [f64; 2] {
    let middle = |from: f64, to: f64| 0.5 * from + 0.5 * to;
    let mass: f64 = parts.iter().map(|(m, ..)| m).sum();
    let center = parts.iter().map(|(m, from, to)| m / mass * middle(*from, *to)).sum::<f64>();
    let squares = parts.iter().map(|(m, from, to)| {
        let (x, width) = (middle(*from, *to) - center, to - from);
        m / mass * (x * x + width * width / 12.0)
    });
    let gyration = squares.sum::<f64>().sqrt();
    [center, if gyration > 4.0 * roundings(parts) * reach(parts) { gyration } else { 0.0 }]
}

/// The largest error of the center of mass and of the radius of gyration of masses, in ε times the number of masses and
/// the larger of half the length and the reach of the masses: [`center_and_gyration`] rounds 12 times a mass at most
/// for either, and a center that counts as the middle is within 9 of it.
pub(crate) const SUMS: f64 = 16.0;

/// Returns the largest distance of a mass from the middle, in m.
pub(crate) fn reach(parts: &[Part]) -> f64 {
    parts.iter().fold(0.0, |reach, (_, from, to)| reach.max(from.abs()).max(to.abs()))
}

/// Returns ε times the number of masses.
pub(crate) fn roundings(parts: &[Part]) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "a count of roundings")]
    let count = parts.len() as f64;
    f64::EPSILON * count
}

/// Returns the length or mass if its products stay within the range of floats.
pub(crate) fn positive(name: &'static str, value: f64) -> Result<f64, Error> {
    let allowed = "in [1e-25, 1e25]";
    if (1e-25..=1e25).contains(&value) { Ok(value) } else { Err(Error::Quantity { name, value, allowed }) }
}

fn place(value: f64) -> Result<f64, Error> {
    let allowed = "in [-1e25, 1e25]";
    if value.abs() <= 1e25 { Ok(value) } else { Err(Error::Quantity { name: "position (m)", value, allowed }) }
}
