//! This module compares the result of the assessment for a limit with the drops of the pictures.

use crate::reason::Doubt;
use crate::{LimitAssessment, Verdict};

/// The factor between the demand of the assessment and the largest demand of the drops of the pictures at the part's own place: its search
/// climbs to the worst drop, and it adds what that may miss, and the demand of rebounds and of another contact law. Other places are
/// held to the same.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scale {
    /// The share that counts for the verdict.
    counted: f64,
    /// The largest demand of the drops at the part's own place.
    here: f64,
}

impl Scale {
    /// Returns the scales of a limit for which the drops of each contact law demand `here`; none where the possible demand is not known.
    pub(super) fn of(limit: &LimitAssessment, here: &[f64]) -> Option<Vec<Self>> {
        let demands = [limit.demand, limit.other_law];
        let mut scales = Vec::with_capacity(here.len());
        for (here, demand) in here.iter().zip(demands) {
            let demand = demand? / limit.allowed;
            let counted = demand * (1.0 + limit.uncertainty);
            let known = counted.is_finite() && (*here > 0.0 || demand == 0.0);
            scales.push(known.then_some(Self { counted, here: *here })?);
        }
        // The rattle space leaves undecided how a part moves otherwise that hits its stop.
        let by_stop = limit.undecided.iter().any(|doubt| matches!(doubt, Doubt::Stop { .. }));
        // The picture agrees with the verdict.
        match limit.verdict {
            Verdict::Safe => scales.iter_mut().for_each(|scale| scale.counted = scale.counted.min(1.0)),
            Verdict::Reliable | Verdict::Undecided | Verdict::Unsafe => {
                let most = scales.iter_mut().max_by(|a, b| a.counted.total_cmp(&b.counted)).filter(|_| !by_stop);
                if let Some(scale) = most {
                    scale.counted = scale.counted.max(1.0 + 1e-6);
                }
            }
        }
        Some(scales)
    }

    /// Returns the largest demand that a drop of the pictures may have where the limit holds.
    pub(super) fn most(&self) -> f64 {
        // A demand of nothing holds anywhere.
        if self.counted == 0.0 { f64::INFINITY } else { self.here / self.counted }
    }
}
