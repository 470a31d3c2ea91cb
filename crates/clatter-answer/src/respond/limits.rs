//! What a drop asks of the limits of a part and at its place, of a bar as of a plate.

use clatter_assess::{Drop, LimitKind, Model, Part, Unit};
use clatter_shock::Suspension;
use serde::Serialize;

use super::Largest;
use crate::{Error, Json};

/// One limit of a part in one drop; null where nothing is felt, or where it is not known.
#[derive(Debug, Clone, Copy, Serialize)]
#[non_exhaustive]
pub struct Limit {
    /// What is limited.
    pub limit: LimitKind,
    /// SI.
    pub unit: Unit,
    /// In the unit.
    pub allowed: Json,
    /// In the unit: the demand of an assessment.
    pub value: Option<Json>,
    /// Value over allowed.
    pub share: Option<Json>,
    /// The place that asks most.
    pub position_m: Position,
    /// Number of the impact.
    pub impact: Option<u64>,
    /// Since the first touch.
    pub time_s: Option<Json>,
    /// As a share of the value.
    pub error: Option<Json>,
    /// Which of the places asks most.
    #[serde(skip)]
    pub place: usize,
}

/// A place, in m from the middle of the product.
#[derive(Debug, Clone, Copy, Serialize)]
#[serde(untagged)]
pub enum Position {
    /// Along a bar, towards end b.
    Along(Json),
    /// Along a plate and across it.
    Both([Json; 2]),
    /// Along, across and in the thickness of a box.
    All([Json; 3]),
}

impl Limit {
    /// Below every share where nothing is known.
    fn of_allowed(&self) -> f64 {
        self.share.map_or(-1.0, |share| share.0)
    }
    /// The one that leaves least, of those that are known.
    pub(super) fn tightest(limits: &[Self]) -> Option<&Self> {
        let known = limits.iter().filter(|limit| limit.share.is_some());
        known.max_by(|a, b| a.of_allowed().total_cmp(&b.of_allowed()))
    }
}

/// A drop that is asked about.
pub(super) struct OneDrop {
    pub(super) drop: Drop,
    pub(super) model: Model,
    pub(super) tolerance: f64,
}

/// Nothing is allowed or forbidden by this: the value alone counts.
pub(super) fn unlimited(kind: LimitKind) -> clatter_assess::Limit {
    clatter_assess::Limit::new(kind, 1.0)
}

/// What is not felt is 0.
pub(super) fn value(largest: Option<Largest>) -> Json {
    largest.map_or(Json(0.0), |largest| largest.value)
}

impl OneDrop {
    pub(super) fn answer(
        &self,
        limit: &clatter_assess::Limit,
        part: &Part,
    ) -> Result<clatter_assess::Answer, clatter_assess::Error> {
        clatter_assess::answer(&self.drop, part, limit, self.model, self.tolerance)
    }

    /// What is asked of a limit at a place; none where nothing is felt, or where it is not known.
    fn felt(
        &self,
        limit: &clatter_assess::Limit,
        place: &Part,
        part: Option<Suspension>,
    ) -> Result<Option<clatter_assess::Answer>, Error> {
        let suspension = part.filter(|_| limit.is_response());
        match self.answer(limit, &Part { suspension, ..*place }) {
            Err(clatter_assess::Error::Unfinished | clatter_assess::Error::Contact) => Ok(None),
            answer => Ok(Some(answer?)),
        }
    }

    /// The largest value of a quantity at a place.
    pub(super) fn largest(
        &self,
        kind: LimitKind,
        place: &Part,
        part: Option<Suspension>,
    ) -> Result<Option<Largest>, Error> {
        Ok(self.felt(&unlimited(kind), place, part)?.map(Largest::from))
    }

    /// Every limit at the worst of these places, which are told as they are on the product.
    pub(super) fn limits(
        &self,
        limits: &[clatter_assess::Limit],
        places: &[(Part, Position)],
        part: Option<Suspension>,
    ) -> Result<Vec<Limit>, Error> {
        let mut found = Vec::with_capacity(limits.len());
        for limit in limits {
            let mut worst: Option<Limit> = None;
            for (place, (at, position_m)) in places.iter().enumerate() {
                let answer = self.felt(limit, at, part)?;
                let one = Limit {
                    limit: limit.kind,
                    unit: answer.map_or(limit.kind.unit(), |answer| answer.unit),
                    allowed: Json(answer.map_or(limit.allowed, |answer| answer.allowed)),
                    value: answer.map(|answer| Json(answer.value)),
                    share: answer.map(|answer| Json(answer.utilization())),
                    position_m: *position_m,
                    impact: answer.map(|answer| answer.impact),
                    time_s: answer.map(|answer| Json(answer.time_s)),
                    error: answer.map(|answer| Json(answer.error())),
                    place,
                };
                if worst.is_none_or(|worst| one.of_allowed() > worst.of_allowed()) {
                    worst = Some(one);
                }
            }
            found.extend(worst);
        }
        Ok(found)
    }
}
