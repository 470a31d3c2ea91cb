//! A sample by the model with the most physics that the data allow.

use std::f64::consts::PI;

use super::SampleDemand;
use super::sample::PartSample;
use crate::engine::{PlaceHistory, in_swings};
use crate::model::follow;
use crate::search::Landings;
use clatter_flight::{Followed, Until};
use clatter_product::{Drop, Error, Limit, LimitKind, Model, Source};

/// The tolerance to which a sample is answered. A coarser answer costs no less: more samples are left open and followed once more.
pub(super) const TOLERANCE: f64 = 0.005;
/// The tolerances to which a sample is answered whose error leaves open whether a limit holds, one after the other.
pub(super) const FINER: [f64; 2] = [5e-4, 5e-5];
/// The tolerance to which a drop is answered of which only the largest of many counts.
const COARSE: f64 = 0.02;
/// The error of a demand from the steps of a box, and the straight lines between them, at most.
const STEPS: f64 = 1e-3;
/// So many times v/g a box is followed on: through its bounces up to a restitution of 0.6, through the first two of any.
const BOUNCES: f64 = 4.0;

/// One drop, followed as far as its parts need it.
///
/// The drop is followed first until its energy allows no shock as large as the largest, then on where later strikes could still pass the
/// demand on a part so far. Where the error bound leaves open whether a limit holds, it is followed again, finer.
#[derive(Debug)]
pub(super) struct FollowedDrops<'a> {
    drop: &'a Drop,
    /// The box that a plate is.
    boxed: Option<Drop>,
    /// The first swing of the slowest part takes so long at most.
    swing_s: f64,
    /// What a box may ask for as it lands again.
    later: Option<&'a Landings>,
    early: LazyDrop,
    whole: LazyDrop,
    /// A box until it lies.
    rest: LazyDrop,
    finer: [LazyDrop; 2],
}

/// A drop that is followed when a part first needs it.
type LazyDrop = Option<Result<Followed, Error>>;

impl<'a> FollowedDrops<'a> {
    pub(super) fn of(drop: &'a Drop, parts: &[PartSample]) -> Self {
        let suspensions = parts.iter().filter_map(|part| part.suspension.as_ref());
        let swing_s = suspensions.map(|part| PI / part.omega()).fold(0.0, f64::max);
        let (boxed, finer) = (drop.boxed(), [None, None]);
        Self { drop, boxed, swing_s, later: None, early: None, whole: None, rest: None, finer }
    }

    /// Knows what a box may ask for as it lands again.
    pub(super) fn landing_again(self, later: Option<&'a Landings>) -> Self {
        Self { later, ..self }
    }

    /// Returns the drops that it is followed as, the one with the most physics first.
    pub(super) fn drops(&self) -> impl Iterator<Item = &Drop> {
        self.boxed.iter().chain([self.drop])
    }

    /// Returns the demand of the drop on a part; of a box that is followed until it lies where nothing less tells whether the part survives.
    pub(super) fn closed(&mut self, part: &PartSample) -> Result<SampleDemand, Error> {
        let asked = self.answer(part)?;
        if !asked.is_open() || !(self.drop.is_solid() || self.boxed.is_some()) {
            return Ok(asked);
        }
        let drop = self.boxed.as_ref().unwrap_or(self.drop);
        let rest = self.rest.get_or_insert_with(|| follow(drop, Model::fullest(drop), TOLERANCE, Until::Over));
        // A motion that is too long to be followed stays open.
        Ok(rest.as_ref().ok().and_then(|rest| of_part_of_box(rest, part, None).ok()).unwrap_or(asked))
    }

    /// Returns the demand of the drop on a part, or the reason why it is not answered.
    fn answer(&mut self, part: &PartSample) -> Result<SampleDemand, Error> {
        if self.drop.is_solid() || self.boxed.is_some() {
            return self.of_box(part);
        }
        let mut asked = self.passing(part, TOLERANCE, LEAST)?;
        for (following, tolerance) in self.finer.iter_mut().zip(FINER) {
            if !asked.is_open() {
                break;
            }
            let fine =
                following.get_or_insert_with(|| follow(self.drop, Model::fullest(self.drop), tolerance, Until::Over));
            let finer = fine.as_ref().map_err(Clone::clone).and_then(|fine| of_part(fine, part, LEAST));
            // A motion that is too long to be followed finer stays open.
            let Ok((finer, _)) = finer else { break };
            asked = finer;
        }
        Ok(asked)
    }

    /// Returns the demand of a box: by its first landing and the first swing of its parts, and by what follows where its energy may decide
    /// whether a limit holds. Where what is left of it in the end still may, the sample is open.
    ///
    /// A plate whose contacts are too soft for so thin a box lands on the corners of its bottom, however far they sink in.
    fn of_box(&mut self, part: &PartSample) -> Result<SampleDemand, Error> {
        let later = self.later;
        let drop = self.boxed.as_ref().unwrap_or(self.drop);
        let until = |time_s| follow(drop, Model::fullest(drop), TOLERANCE, Until::Past(time_s));
        let lands_s = self.swing_s.max(drop.clatter_s());
        let on_bottom = |error| {
            let boxed = self.boxed.as_ref().ok_or(error)?;
            Ok(Followed::as_block(self.drop, lands_s)?.left_early(boxed))
        };
        let of_part = |followed: &Result<Followed, Error>| {
            let followed = followed.as_ref().map_err(Clone::clone)?;
            let landings = match later.filter(|_| followed.is_early()) {
                Some(later) => Some(later.worst(followed.energy_m2_s2(), drop.gravity_m_s2)?.swap_remove(part.number)),
                None => None,
            };
            of_part_of_box(followed, part, landings.as_deref())
        };
        let first = of_part(self.early.get_or_insert_with(|| until(self.swing_s).or_else(on_bottom)))?;
        let whole = first.is_open().then(|| {
            let on_s = if drop.gravity_m_s2 > 0.0 { BOUNCES * drop.speed_m_s / drop.gravity_m_s2 } else { 0.0 };
            // A motion that is too long to be followed stays open.
            of_part(self.whole.get_or_insert_with(|| until(on_s.max(self.swing_s)))).ok()
        });
        Ok(whole.flatten().unwrap_or(first))
    }

    /// Returns the larger of a utilization and the demand of the drop on a part.
    pub(super) fn larger(&mut self, part: &PartSample, utilization: f64) -> Result<f64, Error> {
        Ok(self.passing(part, COARSE, utilization)?.utilization.max(utilization))
    }

    /// Returns the demand of the drop on a part where that passes a utilization.
    fn passing(&mut self, part: &PartSample, tolerance: f64, above: f64) -> Result<SampleDemand, Error> {
        let (drop, model) = (self.drop, Model::fullest(self.drop));
        let followed = |following: &mut LazyDrop, follow: &dyn Fn() -> Result<Followed, Error>| {
            let followed = following.get_or_insert_with(follow);
            followed.as_ref().map_err(Clone::clone).and_then(|followed| of_part(followed, part, above))
        };
        let (asked, goes_on) = followed(&mut self.early, &|| follow(drop, model, tolerance, Until::Lands))?;
        if !goes_on {
            return Ok(asked);
        }
        match followed(&mut self.whole, &|| follow(drop, model, tolerance, Until::Over)) {
            Ok((asked, _)) => Ok(asked),
            // However it goes on, it has failed.
            Err(_) if asked.within[0] > 1.0 => Ok(asked),
            Err(error) => Err(error),
        }
    }
}

/// Writes the demand of a drop on every part; of those that it does not answer, the reason.
pub(super) fn answer(
    drop: &Drop,
    parts: &[PartSample],
    later: Option<&Landings>,
    asked: &mut Vec<Result<SampleDemand, Error>>,
) {
    let mut followings = FollowedDrops::of(drop, parts).landing_again(later);
    asked.clear();
    asked.extend(parts.iter().map(|part| followings.answer(part)));
}

/// A value below every utilization: the demand of a drop passes it, 0 too, unless it is no number.
pub(super) const LEAST: f64 = -1.0;

/// Returns the demand of a followed drop on a part where that passes a utilization, and whether later strikes may have a larger one.
fn of_part(followed: &Followed, part: &PartSample, above: f64) -> Result<(SampleDemand, bool), Error> {
    let mut asked = SampleDemand::default();
    let mut goes_on = false;
    let felt: Vec<PlaceHistory<'_>> =
        part.spots().into_iter().map(|spot| PlaceHistory::new(followed, spot)).collect::<Result<_, Error>>()?;
    let each = || felt.iter().flat_map(|felt| part.limits.iter().enumerate().map(move |(k, limit)| (k, felt, limit)));
    for (k, felt, limit) in each() {
        if above >= 0.0 && !may_pass(felt, limit, &followed.drop, above)? {
            continue;
        }
        match felt.answer(limit, part.suspension.as_ref(), above)? {
            Some(answer) => {
                let (used, error) = (answer.utilization(), answer.error());
                asked.raise(k, used, [used / (1.0 + error), used * (1.0 + error)]);
            }
            None if above >= 0.0 => {}
            // It may have been left before the part began to move.
            _ if followed.is_early() => goes_on = true,
            _ => return Err(Error::Unfinished),
        }
    }
    let most = asked.utilization.max(above);
    goes_on |= each().any(|(_, felt, limit)| may_pass_later(felt, limit, part, &followed.drop, most));
    Ok((asked, goes_on))
}

/// Returns the demand of a followed drop of a box on a part, and the demand that it may have as it lands again: by the worst landings with the
/// energy that is left, where they are known, else by all of that energy.
fn of_part_of_box(followed: &Followed, part: &PartSample, landings: Option<&[f64]>) -> Result<SampleDemand, Error> {
    let mut asked = SampleDemand::default();
    for spot in part.spots() {
        let felt = PlaceHistory::new(followed, spot)?;
        for (k, limit) in part.limits.iter().enumerate() {
            let answer = felt.answer_or_nothing(limit, part.suspension.as_ref())?;
            let used = answer.utilization();
            // A boundary is passed by both of its quantities, and what is off nothing has no share.
            let later = if let Some(landings) = landings {
                {
                    let parts = part.suspension.as_slice();
                    in_swings(limit, parts, landings[part.skipped + k] + felt.rings(limit, parts))
                }
            } else if used > 0.0 && limit.kind.source() != Source::Boundary {
                used + answer.off_by / answer.allowed
            } else {
                felt.later_most(limit, part.suspension.as_ref(), used)
            };
            asked.raise(k, used, [used / (1.0 + STEPS), later.max(used * (1.0 + STEPS))]);
        }
    }
    Ok(asked)
}

/// Returns the acceleration that a damage boundary has together with its velocity change, as a limit of its own; without a contact time no
/// acceleration is known, and the velocity change alone counts.
fn critical_acceleration(limit: &Limit, drop: &Drop) -> Option<Limit> {
    let of_boundary = limit.kind.source() == Source::Boundary && drop.contact_time_s.is_some();
    of_boundary.then(|| Limit::new(LimitKind::Acceleration, limit.critical_acceleration_m_s2))
}

/// Returns whether a limit may pass a utilization. A damage boundary does not unless the largest velocity change and the largest
/// acceleration of all shocks both do, which is found sooner than shock by shock.
fn may_pass(felt: &PlaceHistory<'_>, limit: &Limit, drop: &Drop, above: f64) -> Result<bool, Error> {
    let Some(acceleration) = critical_acceleration(limit, drop) else { return Ok(true) };
    let change = Limit::new(LimitKind::VelocityChange, limit.allowed);
    Ok(felt.answer(&change, None, above)?.is_some() && felt.answer(&acceleration, None, above)?.is_some())
}

/// Returns whether later strikes may pass a utilization; a damage boundary only by both of its quantities.
fn may_pass_later(felt: &PlaceHistory<'_>, limit: &Limit, part: &PartSample, drop: &Drop, above: f64) -> bool {
    let parts = part.suspension.as_slice();
    let acceleration = critical_acceleration(limit, drop);
    let may_pass = |limit: &Limit, parts| felt.later_most(limit, parts, above) > above;
    may_pass(limit, parts) && acceleration.is_none_or(|limit| may_pass(&limit, &[]))
}
