//! Bounds what friction of the ground, which no drop is followed with, may add to parts of a box.

use clatter_flight::{Axis, Drop, Push};
use clatter_shock::Suspension;

use super::PlaceHistory;
use super::later::slowest;
use crate::bound::FRICTION;
use clatter_product::{Limit, Source};

/// The cosine of 10°: up to there friction changed the demand of parts along the thickness of phones, tablets and laptops by −11 to +2 %.
const LEVEL: f64 = 0.985;

/// Returns whether a box is no thicker than a fifth of its other sides, as those products are.
fn is_thin(drop: &Drop) -> bool {
    let body = &drop.body;
    body.thickness.is_some_and(|thickness| 5.0 * thickness.m() <= body.length_m().min(body.width_m()))
}

impl PlaceHistory<'_> {
    /// Returns [`friction`](Self::friction) of the part that it adds most to; of a limit that is no response there are none.
    pub(crate) fn most_friction(&self, limit: &Limit, parts: &[Suspension]) -> f64 {
        let of_parts = parts.iter().map(|part| self.friction(limit, Some(part))).reduce(f64::max);
        of_parts.unwrap_or_else(|| self.friction(limit, None))
    }

    /// Returns the utilization that [`FRICTION`] may add to the demand of this drop for a limit; 0 of a bar, of a plate, of the turning, and
    /// of a part along the thickness of a thin box while that lies on a broad face to [`LEVEL`].
    ///
    /// # Formula
    /// Each corner is pushed across the vertical by at most μ times its force, all of them by μ P together, P the acceleration of the
    /// center of mass. To a part along an axis they do what the worst of the corners that press does. Along any axis that is at most
    /// μ P (1 + |J⁻¹ (p × a)| r), a the axis of the part and r the distance of the farthest corner. Pushes that overlap are one, of
    /// impulse I and peak P; each acts on a suspended part as a shock of the velocity I, and as no more than twice its peak.
    fn friction(&self, limit: &Limit, suspension: Option<&Suspension>) -> f64 {
        let followed = &self.followed;
        let Some(levers) = followed.drop.levers(&self.place) else { return 0.0 };
        let (turned, is_thin) = (levers.across - 1.0, self.place.axis == Axis::Z && is_thin(&followed.drop));
        let adds = |own: f64, push: &Push, pushed: f64| {
            let straight = FRICTION * pushed;
            match followed.across(&self.place, push) {
                Some(_) if is_thin && push.level > LEVEL => 0.0,
                Some(across) => across * straight,
                // Across the blow, but for what turning does.
                None => {
                    let aside = own.min(turned * pushed);
                    (own * own + 2.0 * aside * straight + straight * straight).sqrt() + turned * straight - own
                }
            }
        };
        let pushes = followed.pushes();
        let most = |of: &dyn Fn(&Push) -> f64| pushes.iter().map(of).fold(0.0, f64::max);
        let own = |pushed: &Push, of: &dyn Fn(&crate::shock::Shock) -> f64| {
            let within = |shock: &&crate::shock::Shock| (pushed.from_s..=pushed.until_s).contains(&shock.time_s);
            self.shocks().iter().filter(within).map(of).fold(0.0, f64::max)
        };
        let changes = |pushed: &Push| adds(own(pushed, &|shock| shock.change), pushed, pushed.impulse_m_s);
        let peaks = |pushed: &Push| adds(own(pushed, &|shock| shock.peak), pushed, pushed.peak_m_s2);
        match (limit.kind.source(), suspension) {
            (Source::Turn, _) => 0.0,
            (Source::Shock, _) => most(&changes) / limit.allowed,
            // A damage boundary takes both: it is used up by no more than the larger share.
            (Source::Boundary, _) => {
                (most(&changes) / limit.allowed).max(most(&peaks) / limit.critical_acceleration_m_s2)
            }
            (Source::Response(_), None) => most(&peaks) / limit.allowed,
            (Source::Response(peak), Some(part)) => {
                let unit = peak.of_velocity(peak.after_impulse(part.damping()), part.omega());
                let decays = slowest(part) * part.omega();
                let (mut rings, mut largest, mut last_s) = (0.0, 0.0_f64, 0.0);
                for pushed in &pushes {
                    let [impulse, peak] = [pushed.impulse_m_s, pushed.peak_m_s2].map(|of| adds(0.0, pushed, of));
                    let one = impulse.min(2.0 * peak / part.omega());
                    rings = rings * libm::exp(-decays * (pushed.from_s - last_s)) + one;
                    (largest, last_s) = (largest.max(rings), pushed.from_s);
                }
                unit * largest / limit.allowed
            }
        }
    }
}
