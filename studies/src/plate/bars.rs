//! A plate compared with the two bars that may stand for it: one along its edges, which is the paper's, and one along
//! its diagonal.

use clatter::{Bar, Plate, Start, Summary};

use crate::Error;

/// The most strikes that are followed in each direction of tilt.
pub(crate) const STRIKES: usize = 24;
/// Thresholds of the safe zones, in v0.
pub(crate) const THRESHOLDS: [f64; 3] = [0.5, 1.0, 2.0];

/// A centered plate over all directions of tilt, and the bars that may stand for it. Shocks are in v0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BarsAndPlate {
    /// α = A²/k_x² and β = B²/k_y².
    pub(crate) inertia: [f64; 2],
    /// Restitution.
    pub(crate) e: f64,
    /// Largest shock of a corner.
    pub(crate) corner: f64,
    /// Largest shock of the middle.
    pub(crate) middle: f64,
    /// Bound on the shock of a corner in strikes that were not followed: at most `corner` where the worst case is
    /// proven.
    pub(crate) later: f64,
    /// Largest shocks of the ends and of the middle of the paper's bar, with the larger of α and β.
    pub(crate) bar: [f64; 2],
    /// Largest shock of the ends of the bar along the diagonal, q = (α + β − 1)/(α + β + 1).
    pub(crate) diagonal: f64,
    /// Share of the plan that is safe, for each threshold.
    pub(crate) plan: [f64; 3],
    /// Share of the length of the paper's bar that is safe, for each threshold.
    pub(crate) length: [f64; 3],
}

impl BarsAndPlate {
    /// Creates the comparison for a plate of these α and β.
    ///
    /// # Errors
    /// The errors of [`Plate::new`].
    pub(crate) fn new(inertia: [f64; 2], e: f64) -> Result<Self, Error> {
        let [alpha, beta] = inertia;
        let shocks = Plate::new(inertia.map(|a| a.sqrt().recip()), e)?.worst(STRIKES)?;
        let along = q(alpha.max(beta));
        let peak = summary(along, e)?.peak;
        let zones = Bar::new(along, e)?.shocks_either(&Start::default());
        Ok(Self {
            inertia,
            e,
            corner: shocks.struck()[0],
            middle: shocks.at([0.0; 2]),
            later: shocks.later(),
            bar: [peak.end, peak.center],
            diagonal: summary(q(alpha + beta), e)?.peak.end,
            plan: THRESHOLDS.map(|threshold| shocks.safe_zone(threshold).share),
            length: THRESHOLDS.map(|threshold| zones.safe_zone(threshold).s.clamp(0.0, 1.0)),
        })
    }
}

/// Returns the inertia ratio of a bar with α = L²/ρ².
pub(crate) fn q(alpha: f64) -> f64 {
    (alpha - 1.0) / (alpha + 1.0)
}

fn summary(q: f64, e: f64) -> Result<Summary, Error> {
    Ok(Bar::new(q, e)?.summary(&Start::default()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Up to T = q (1 + e) = √(1 + e) the second strike is the hardest: (1 + e)(1 + T) at the corner, 1/μ of it in the
    /// middle, with q = 5/7 and μ = 7 for a uniform plate; the rhombus α|x| + β|y| ≤ μ t/J − 1 has the area 2 c²/(αβ)
    /// of 4.
    #[test]
    fn a_uniform_plate_has_its_closed_forms() {
        for e in [0.2, 0.3, 0.5, 0.8] {
            let plate = BarsAndPlate::new([3.0; 2], e).unwrap();
            let corner = (1.0 + e) * (1.0 + 5.0 / 7.0 * (1.0 + e));
            assert!((plate.corner - corner).abs() < 1e-13 && plate.later <= plate.corner, "{plate:?}");
            assert!((plate.middle - corner / 7.0).abs() < 1e-13, "{plate:?}");
            assert!((plate.diagonal - corner).abs() < 1e-13, "{plate:?}");
            let c = (7.0 * 0.5 / corner - 1.0).max(0.0);
            assert!((plate.plan[0] - 0.5 * c * c / 9.0).abs() < 1e-13, "{plate:?}");
        }
    }

    #[test]
    fn a_plate_without_width_is_the_bar() {
        let plate = BarsAndPlate::new([3.0, 1e-12], 0.3).unwrap();
        assert!((plate.corner - plate.bar[0]).abs() < 1e-9 && (plate.middle - plate.bar[1]).abs() < 1e-9, "{plate:?}");
        assert!(plate.plan.iter().zip(plate.length).all(|(plan, length)| (plan - length).abs() < 1e-9), "{plate:?}");
    }
}
