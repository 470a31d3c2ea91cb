//! What one drop of a search asks of the parts, and how far it is followed for that.

use super::budgets::{FREQUENCIES_LATE, NEAR, REBOUNDS};
use super::found::{Candidate, Later, OfDrop, image};
use super::landings::lands_s;
use super::{Coordinates, Ranges, Task, rough_to_rad_s};
use crate::engine::PlaceHistory;
use crate::model::follow;
use clatter_flight::{Followed, Until};
use clatter_product::{Error, Source};

/// How far a drop is followed beyond where it lands again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Further {
    No,
    /// Until it has landed twice.
    Again,
    ToRest,
}

impl Ranges<'_> {
    /// Returns the demand of drop k, which was followed until it lands, for each task, or for those marked in `only`, where that comes near
    /// the worst.
    pub(super) fn ask(
        &self,
        tasks: &[Task<'_>],
        (k, drop): &(u32, Coordinates),
        early: &Followed,
        mut best: Vec<f64>,
        only: Option<&[bool]>,
        further: Further,
    ) -> Result<OfDrop, Error> {
        let (mut of_drop, is_plate) = (OfDrop::default(), self.product.body.is_wide());
        let (mut landed_twice, mut rebounded, mut over) = (None, None, None);
        let mut first = 0;
        for of_one in tasks.chunk_by(|a, b| std::ptr::eq(a.component, b.component)) {
            let numbers = first..first + of_one.len();
            first = numbers.end;
            if only.is_some_and(|only| !only[numbers.clone()].contains(&true)) {
                continue;
            }
            let own: Vec<[f64; 2]> = of_one[0].component.places_m();
            let ends = of_one[0].component.ends_m().len();
            let images =
                self.mirrors().iter().flat_map(|&sides| own.iter().map(move |&at_m| (sides, image(at_m, sides))));
            // Which limits an end of the part comes near in this drop: those of a rectangle are many.
            let mut near_at_ends = vec![false; of_one.len()];
            for (n, (sides, at_m)) in images.enumerate() {
                if n % own.len() == 0 {
                    near_at_ends.fill(false);
                }
                let is_between = n % own.len() >= ends;
                let mut felt: Option<PlaceHistory<'_>> = None;
                for (own_number, (task, number)) in of_one.iter().zip(numbers.clone()).enumerate() {
                    // Turns are the same everywhere.
                    let again = n > 0 && task.limit.kind.source() == Source::Turn;
                    let far_from_worst = is_plate && !near_at_ends[own_number] && !task.hits_stops();
                    let not_there = is_between && (!task.is_largest_between() || far_from_worst);
                    if again || not_there || only.is_some_and(|only| !only[number]) {
                        continue;
                    }
                    let felt = match &mut felt {
                        Some(felt) => felt,
                        none => {
                            none.insert(PlaceHistory::rough(early, task.place(at_m), rough_to_rad_s(task.component))?)
                        }
                    };
                    let worst = best[number];
                    let place = Coordinates { at_m, ..*drop };
                    // A demand of nothing is an answer as well.
                    let near = if worst > 0.0 { NEAR * worst } else { -1.0 };
                    let frequencies = Self::frequencies(task, &early.drop);
                    let late = frequencies.max(FREQUENCIES_LATE);
                    let mut asked = self.most(task, &place, felt, *k, frequencies, near)?;
                    let reached =
                        |asked: Option<Candidate>| asked.map_or(worst, |asked| worst.max(asked.answer.utilization()));
                    if task.hits_stops() {
                        of_drop.swings.push((number, Self::swing(task, &place, felt, *k)?));
                    }
                    let parts = Self::softest_and_stiffest(task, &place)?;
                    let later = felt.later_most(&task.limit, &parts, reached(asked));
                    // Strikes without number are none of one landing.
                    let rings_of = |felt: &PlaceHistory<'_>, followed: &Followed, later: f64| {
                        if followed.is_given_up() { later } else { felt.rings(&task.limit, &parts) }
                    };
                    // A box is followed further later.
                    if later > 0.0 && (self.base.is_none() || further == Further::No) {
                        of_drop.energy_m2_s2 = early.energy_m2_s2();
                        of_drop.later.push((number, Later { most: later, rings: rings_of(felt, early, later) }));
                    }
                    let above = |asked: Option<Candidate>| asked.map_or(near, |asked| asked.answer.utilization());
                    if later > 0.0 && further == Further::Again {
                        let until =
                            Until::LandsAfter(early.stop().time_s() + lands_s(&early.drop, early.energy_m2_s2()));
                        let landed = self.followed(drop, until, &mut landed_twice)?;
                        let twice = felt.longer(landed)?;
                        asked = self.most(task, &place, &twice, *k, late, above(asked))?.or(asked);
                        let later = twice.later_most(&task.limit, &parts, reached(asked));
                        if later > 0.0 {
                            of_drop.rings_again.push((number, rings_of(&twice, landed, later)));
                        }
                    }
                    if later > 0.0 && further == Further::ToRest {
                        let rebounded = self.followed(drop, Until::Rebounded, &mut rebounded)?;
                        of_drop.lean = rebounded.lean();
                        let longer = felt.longer(rebounded)?;
                        asked = self.most(task, &place, &longer, *k, late, above(asked))?.or(asked);
                        if longer.later_most(&task.limit, &parts, reached(asked)) > 0.0 {
                            let longest = longer.longer(self.followed(drop, Until::Over, &mut over)?)?;
                            asked = self.most(task, &place, &longest, *k, late, above(asked))?.or(asked);
                        }
                    }
                    if let Some(mut asked) = asked {
                        asked.late = asked.answer.time_s > early.drop.clear_s();
                        best[number] = worst.max(asked.answer.utilization());
                        near_at_ends[own_number] = true;
                        of_drop.asked.push((number, asked.mirrored(sides, is_plate)));
                    }
                }
            }
        }
        Ok(of_drop)
    }

    pub(super) fn follow(&self, place: &Coordinates, until: Until) -> Result<Followed, Error> {
        let drop = self.single(place);
        // A plate that loses little goes on and on; what it may do later is bounded by its energy. A box topples late, onto its broad
        // faces at last, and lies soon after.
        let until = match until {
            Until::Rebounded | Until::Over if self.base.is_some() => until,
            Until::Rebounded if self.product.body.is_wide() => Until::Past(REBOUNDS[0] * drop.bounced_s()),
            Until::Over if self.product.body.is_wide() => Until::Past(REBOUNDS[1] * drop.bounced_s()),
            until => until,
        };
        follow(&drop, self.model, self.tolerance.max(0.02), until)
    }

    /// Follows a drop where it was not followed yet.
    fn followed<'f>(
        &self,
        place: &Coordinates,
        until: Until,
        once: &'f mut Option<Followed>,
    ) -> Result<&'f Followed, Error> {
        match once {
            Some(followed) => Ok(followed),
            none => Ok(none.insert(self.follow(place, until)?)),
        }
    }
}
