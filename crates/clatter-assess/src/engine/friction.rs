//! Bounds what friction of the ground, which no drop is followed with, may add to parts of a box that move along the ground.

use clatter_flight::{Axis, Push};
use clatter_shock::Suspension;

use super::PlaceHistory;
use super::later::slowest;
use crate::bound::FRICTION;
use clatter_product::{Limit, Source};

impl PlaceHistory<'_> {
    /// Returns [`friction`](Self::friction) of the part that it adds most to; of a limit that is no response there are none.
    pub(crate) fn most_friction(&self, limit: &Limit, parts: &[Suspension]) -> f64 {
        let of_parts = parts.iter().map(|part| self.friction(limit, Some(part))).reduce(f64::max);
        of_parts.unwrap_or_else(|| self.friction(limit, None))
    }

    /// Returns the utilization that [`FRICTION`] may add to the demand of this drop for a limit; 0 of a bar, of a plate, of a part along
    /// the thickness of a box and of the turning.
    ///
    /// # Formula
    /// Each corner is pushed across the vertical by at most μ times its force, all of them by μ P together, P the acceleration of the
    /// center of mass. At the place that is at most μ P (1 + |J⁻¹ (p × a)| r), a the axis of the part and r the distance of the farthest
    /// corner. Pushes that overlap are one, of impulse I and peak P; each acts on a suspended part as a shock of the velocity I, and as no
    /// more than twice its peak.
    fn friction(&self, limit: &Limit, suspension: Option<&Suspension>) -> f64 {
        let axis = self.place.axis;
        let Some(levers) = self.followed.drop.levers(&self.place).filter(|_| axis != Axis::Z) else { return 0.0 };
        let turned = levers.across - 1.0;
        // Across the blow where the axis is that of the blow, but for what turning does.
        let adds = |own: f64, push: f64| {
            let across = FRICTION * push;
            let straight = if axis == Axis::Any {
                let aside = own.min(turned * push);
                (own * own + 2.0 * aside * across + across * across).sqrt()
            } else {
                own + across
            };
            straight + turned * across - own
        };
        let pushes = self.followed.pushes();
        let most = |of: &dyn Fn(&Push) -> f64| pushes.iter().map(of).fold(0.0, f64::max);
        let own = |pushed: &Push, of: &dyn Fn(&crate::shock::Shock) -> f64| {
            let within = |shock: &&crate::shock::Shock| (pushed.from_s..=pushed.until_s).contains(&shock.time_s);
            self.shocks().iter().filter(within).map(of).fold(0.0, f64::max)
        };
        let changes = |pushed: &Push| adds(own(pushed, &|shock| shock.change), pushed.impulse_m_s);
        let peaks = |pushed: &Push| adds(own(pushed, &|shock| shock.peak), pushed.peak_m_s2);
        match (limit.kind.source(), suspension) {
            (Source::Turn, _) => 0.0,
            (Source::Shock, _) => most(&changes) / limit.allowed,
            // It takes both.
            (Source::Boundary, _) => {
                (most(&changes) / limit.allowed).max(most(&peaks) / limit.critical_acceleration_m_s2)
            }
            (Source::Response(_), None) => most(&peaks) / limit.allowed,
            (Source::Response(peak), Some(part)) => {
                let unit = peak.of_velocity(peak.after_impulse(part.damping()), part.omega());
                let decays = slowest(part) * part.omega();
                let (mut rings, mut largest, mut last_s) = (0.0, 0.0_f64, 0.0);
                for pushed in &pushes {
                    let one = adds(0.0, pushed.impulse_m_s).min(2.0 * adds(0.0, pushed.peak_m_s2) / part.omega());
                    rings = rings * libm::exp(-decays * (pushed.from_s - last_s)) + one;
                    (largest, last_s) = (largest.max(rings), pushed.from_s);
                }
                unit * largest / limit.allowed
            }
        }
    }
}
