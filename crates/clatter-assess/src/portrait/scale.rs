//! What the assessment says of a limit beside the drops of the pictures.

use crate::{ComponentAssessment, LimitAssessment, LimitKind, Verdict};

/// How much more the assessment counts with than the most that the drops of the pictures ask at the part's own place: its search
/// climbs to the worst drop, and it adds what that may miss, what rebounds may ask and what another contact law asks. Other places
/// and changed parts are held to the same.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scale {
    /// The share that the worst drop asks, by the contact law that asks more.
    pub(super) demand: f64,
    /// The share that counts for the verdict.
    pub(super) counted: f64,
    /// The most that the drops ask at the part's own place.
    pub(super) here: f64,
}

impl Scale {
    /// Of a limit of which the drops ask `here`; none where the assessment does not know how much may be asked.
    pub(super) fn of(assessed: &ComponentAssessment, limit: &LimitAssessment, law_is_named: bool, here: f64) -> Option<Self> {
        let share = |value: f64| value / limit.allowed;
        let other = limit.other_law.filter(|_| !law_is_named).map_or(0.0, share);
        let demand = share(limit.demand?).max(other);
        let counted = demand * (1.0 + limit.uncertainty);
        // The acceleration of a part that hits its stop is undecided by its rattle space.
        let stops = |l: &LimitAssessment| l.limit == LimitKind::RattleSpace && l.verdict != Verdict::Safe;
        let by_stop = limit.limit == LimitKind::Acceleration && assessed.limits.iter().any(stops);
        let counted = match limit.verdict {
            Verdict::Safe => counted.min(1.0),
            Verdict::Undecided if by_stop => counted,
            Verdict::Undecided | Verdict::Unsafe => counted.max(1.0 + 1e-6),
        };
        (counted.is_finite() && (here > 0.0 || demand == 0.0)).then_some(Self { demand, counted, here })
    }

    /// The most that a drop of the pictures may ask where the limit holds, with room of `margin` between the demand and what is allowed.
    pub(super) fn most(&self, margin: f64) -> Option<f64> {
        let most = self.here / self.counted.max((1.0 + margin) * self.demand);
        // A demand of nothing holds anywhere.
        if self.counted == 0.0 { Some(f64::INFINITY) } else { Some(most).filter(|most| most.is_finite()) }
    }
}
