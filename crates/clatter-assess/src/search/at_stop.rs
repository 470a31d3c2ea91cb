//! How the parts of a product reach stops of which its file says nothing.

use clatter_flight::Until;
use clatter_product::{Component, Limit, LimitKind, Stops};
use rayon::prelude::*;

use super::{Candidate, Coordinates, Ranges, Task, rough_to_rad_s};
use crate::AtStop;
use crate::assess::COVERAGE_WHERE_ROUGH;
use crate::engine::{PlaceHistory, in_swings};

/// Drops all over the ranges in which parts are followed to their stops.
const DROPS: u32 = 256;
/// The contact times of a soft and a hard stop, and their restitution: those of foam and of bare plastics.
const USUAL_S: [f64; 2] = [1e-3, 0.2e-3];
const USUAL_RESTITUTION: f64 = 0.5;

impl Ranges<'_> {
    /// Returns the utilization that parts with stops have of a task in a swing of this amplitude; of others the amplitude is one already.
    pub(crate) fn in_swing(&self, task: &Task<'_>, amplitude: f64) -> f64 {
        let parts = Self::softest_and_stiffest(task, &self.middle(task.component)).unwrap_or_default();
        in_swings(&task.limit, &parts, amplitude)
    }

    /// Returns the utilization that parts with stops may have of a task where they swing further than in the drop that was found, by what the
    /// search may miss: in proportion to what stops ask for in such swings; of a part that does not reach them there, all of that.
    pub(crate) fn covered_at_stops(&self, task: &Task<'_>, asked: &Candidate, swing: f64) -> f64 {
        let further = 1.0 + COVERAGE_WHERE_ROUGH;
        let found = || {
            let part = asked.part?;
            let followed = self.follow(&asked.place, Until::Lands).ok()?;
            let felt = PlaceHistory::new(&followed, task.place(asked.place.at_m)).ok()?;
            let here = felt.amplitude(&part.without_stop());
            let [here, covered] = [here, further * here].map(|amplitude| in_swings(&task.limit, [&part], amplitude));
            (here > 0.0 && asked.answer.value > 0.0).then(|| asked.answer.utilization() * covered / here)
        };
        found().unwrap_or_else(|| self.in_swing(task, further * swing))
    }

    /// Returns how a part reaches a stop so far away, at most in drops that spread evenly over the ranges, and in another one; none where it
    /// reaches none.
    pub(crate) fn at_stop(&self, component: &Component, gap_m: f64, other: Coordinates) -> Option<AtStop> {
        let limit = Limit::new(LimitKind::Acceleration, 1.0);
        let task = Task { component, limit };
        let stops = USUAL_S.map(|time_s| Stops::of([gap_m, time_s, USUAL_RESTITUTION]).ok());
        let [Some(soft), Some(hard)] = stops else { return None };
        let of_drop = |place: Coordinates| {
            let followed = self.follow(&place, Until::Lands).ok()?;
            let reaches = component.places_m().into_iter().filter_map(|at_m| {
                let felt = PlaceHistory::rough(&followed, task.place(at_m), rough_to_rad_s(component)).ok()?;
                let part = Self::part(&task, &place).ok()??;
                felt.at_stops(&part, [soft, hard])
            });
            reaches.reduce(AtStop::or_more)
        };
        let places = (1..=DROPS).map(|k| self.spread_out(k)).chain([other]).collect::<Vec<_>>();
        places.into_par_iter().filter_map(of_drop).reduce_with(AtStop::or_more)
    }
}

impl AtStop {
    /// Returns the larger of each.
    fn or_more(self, other: Self) -> Self {
        let [a, b] = [self.asks_m_s2, other.asks_m_s2];
        let asks_m_s2 = [a[0].max(b[0]), a[1].max(b[1])];
        Self { largest_hit_m_s: self.largest_hit_m_s.max(other.largest_hit_m_s), asks_m_s2 }
    }
}
