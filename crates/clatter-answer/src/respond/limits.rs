//! This module answers one drop of any body: its effect on a part and at its place, and its demand on the limits of the part.

use clatter_assess::Part;
use clatter_product::{Drop, LimitKind, Model, Place, Unit};
use clatter_shock::{ShockTable, Suspension};
use serde::Serialize;

use super::{AtStop, Equivalent, Factors, Largest, LargestValues, Peaks, swings};
use crate::{Error, Json};

/// One limit of a part in one drop; null where nothing acts on the part, or where the demand is not known.
#[derive(Debug, Clone, Copy, Serialize)]
#[non_exhaustive]
pub struct Limit {
    /// The limited quantity.
    pub limit: LimitKind,
    /// The SI unit.
    pub unit: Unit,
    /// The allowed value, in the unit.
    pub allowed: Json,
    /// The demand, as an assessment has it, in the unit.
    pub value: Option<Json>,
    /// The value over the allowed value.
    pub share: Option<Json>,
    /// The place with the highest demand, from the middle along length, width and thickness.
    pub position_m: [Json; 3],
    /// Number of the impact.
    pub impact: Option<u64>,
    /// The time since the first touch.
    pub time_s: Option<Json>,
    /// The largest error, as a share of the value.
    pub error: Option<Json>,
    /// The index of the place with the highest demand.
    #[serde(skip)]
    pub place: usize,
}

impl Limit {
    /// Returns the demand over the allowed value; below every such share where the demand is not known.
    fn of_allowed(&self) -> f64 {
        self.share.map_or(-1.0, |share| share.0)
    }
    /// Returns the limit with the least margin, of those that are known.
    fn tightest(limits: &[Self]) -> Option<&Self> {
        let known = limits.iter().filter(|limit| limit.share.is_some());
        known.max_by(|a, b| a.of_allowed().total_cmp(&b.of_allowed()))
    }
}

/// One drop and a part.
pub(super) struct OneDrop<'a> {
    pub(super) drop: Drop,
    pub(super) model: Model,
    pub(super) tolerance: f64,
    /// The part; none that is mounted rigidly.
    pub(super) suspension: Option<Suspension>,
    /// Limits that are held against the drop.
    pub(super) limits: Option<&'a [clatter_product::Limit]>,
    /// A table whose half-sine is to do the same to the part.
    pub(super) shock_table: Option<ShockTable>,
}

/// The effect of a drop on a part and at its place, the same for every body.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct AtPlace {
    /// The index of the answered place.
    #[serde(skip)]
    pub index: usize,
    /// The limits that were given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limits: Option<Vec<Limit>>,
    /// The part and its peaks.
    #[serde(flatten)]
    pub part: Option<Peaks>,
    /// The hits of its stops, where it has any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at_stop: Option<AtStop>,
    /// Largest change of velocity of one shock at the place.
    pub velocity_change_m_s: Json,
    /// Largest acceleration that acts there; null without a contact time.
    pub acceleration_m_s2: Option<Json>,
    /// Largest change of angular velocity of one shock, about any axis.
    pub angular_velocity_change_rad_s: Json,
    /// The largest values, with their times.
    pub answers: LargestValues,
    /// The response of the part to (1 + e) v at one instant, as without clatter.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clatter_free: Option<Factors>,
    /// The response of the part to 2 v, as standards assume.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub standard: Option<Factors>,
    /// Peak acceleration over that of the standards' shock.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gain: Option<Json>,
    /// The equivalent pulse, where a shock table was given.
    #[serde(flatten)]
    pub equivalent: Option<Equivalent>,
}

/// Makes a limit that allows or forbids nothing: the value alone counts.
fn unlimited(kind: LimitKind) -> clatter_product::Limit {
    clatter_product::Limit::new(kind, 1.0)
}

/// Returns the largest value, or 0 where nothing acts on the place.
fn value(largest: Option<Largest>) -> Json {
    largest.map_or(Json(0.0), |largest| largest.value)
}

impl OneDrop<'_> {
    fn answer(
        &self,
        limit: &clatter_product::Limit,
        part: &Part,
    ) -> Result<clatter_assess::Answer, clatter_product::Error> {
        clatter_assess::answer(&self.drop, part, limit, self.model, self.tolerance)
    }

    /// Returns the demand on a limit at a place; none where nothing acts there, or where the demand is not known.
    fn felt(
        &self,
        limit: &clatter_product::Limit,
        place: &Part,
        part: Option<Suspension>,
    ) -> Result<Option<clatter_assess::Answer>, Error> {
        let suspension = part.filter(|_| limit.is_response());
        match self.answer(limit, &Part { suspension, ..*place }) {
            Err(clatter_product::Error::Unfinished | clatter_product::Error::Contact) => Ok(None),
            answer => Ok(Some(answer?)),
        }
    }

    /// Follows the drop until nothing later counts, and answers that one of these places that has the highest demand on a limit, else the
    /// first. Where not even the place that goes through all of the drop has an answer, there is none.
    pub(super) fn at(&self, places: &[Place]) -> Result<AtPlace, Error> {
        let Some(first) = places.first() else {
            return Err(clatter_shock::Error::Empty("the list of places").into());
        };
        // End a or corner a lies where a bar and a plate turn most.
        let [length_m, width_m] = [self.drop.body.length_m(), self.drop.body.width_m()];
        let most = if self.drop.is_solid() { *first } else { Place::flat([-0.5 * length_m, -0.5 * width_m]) };
        self.answer(&unlimited(LimitKind::VelocityChange), &Part::at(most, None))?;
        swings(self.suspension.as_ref())?;
        let limits = self.limits.map(|limits| self.limits(limits, places)).transpose()?;
        let index = limits.as_ref().and_then(|limits| Limit::tightest(limits)).map_or(0, |limit| limit.place);
        let place = &Part::at(places[index], None);
        let largest = |kind, part| self.largest(kind, place, part);
        let of_part = |kind| self.suspension.map_or(Ok(None), |_| largest(kind, self.suspension));
        let contact_time_s = self.drop.contact_time_s;
        let answers = LargestValues {
            velocity_change: largest(LimitKind::VelocityChange, None)?,
            acceleration: contact_time_s.map_or(Ok(None), |_| largest(LimitKind::Acceleration, None))?,
            angular_velocity_change: largest(LimitKind::AngularVelocityChange, None)?,
            part_acceleration: of_part(LimitKind::Acceleration)?,
            part_displacement: of_part(LimitKind::RattleSpace)?,
        };
        let response = |part| {
            clatter_assess::respond(&self.drop, place, &part, self.model, self.tolerance).map(|found| (part, found))
        };
        let response = self.suspension.map(response).transpose()?;
        let part = response.as_ref().map(|(part, (response, _))| Peaks::new(part, response, |_| None));
        let at_stop =
            response.as_ref().filter(|(part, _)| part.stop().is_some()).map(|(_, (_, hits))| AtStop::of(hits));
        let at_once =
            self.suspension.map(|of| Factors::at_once(of.damping(), self.drop.restitution, self.drop.speed_m_s));
        let equivalent = response.as_ref().zip(self.shock_table);
        let equivalent =
            equivalent.map(|((part, (response, _)), table)| Equivalent::new(&table, part, response)).transpose()?;
        Ok(AtPlace {
            index,
            limits,
            velocity_change_m_s: value(answers.velocity_change),
            acceleration_m_s2: contact_time_s.map(|_| value(answers.acceleration)),
            angular_velocity_change_rad_s: value(answers.angular_velocity_change),
            answers,
            clatter_free: at_once.map(|[flat, _]| flat),
            standard: at_once.map(|[_, standard]| standard),
            gain: part.zip(at_once).map(|(part, [_, standard])| part.gain(&standard)),
            part,
            at_stop,
            equivalent,
        })
    }

    /// Returns the largest value of a quantity at a place.
    fn largest(&self, kind: LimitKind, place: &Part, part: Option<Suspension>) -> Result<Option<Largest>, Error> {
        Ok(self.felt(&unlimited(kind), place, part)?.map(Largest::from))
    }

    /// Answers every limit at the worst of these places.
    fn limits(&self, limits: &[clatter_product::Limit], places: &[Place]) -> Result<Vec<Limit>, Error> {
        let mut found = Vec::with_capacity(limits.len());
        for limit in limits {
            let mut worst: Option<Limit> = None;
            for (place, at) in places.iter().enumerate() {
                let answer = self.felt(limit, &Part::at(*at, None), self.suspension)?;
                let one = Limit {
                    limit: limit.kind,
                    unit: answer.map_or(limit.kind.unit(), |answer| answer.unit),
                    allowed: Json(answer.map_or(limit.allowed, |answer| answer.allowed)),
                    value: answer.map(|answer| Json(answer.value)),
                    share: answer.map(|answer| Json(answer.utilization())),
                    position_m: at.at_m.map(Json),
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
