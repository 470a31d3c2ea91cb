//! The worst of what a search reached, answered to the tolerance.

use super::budgets::{NARROWED, TRIES};
use super::ranges::{Coordinates, RESTITUTION, Ranges};
use super::{Candidate, Task, Worst};
use crate::engine::{Answer, PlaceHistory};
use crate::model::follow;
use clatter_flight::Until;
use clatter_product::Error;

/// Returns the largest demand of any of these after rebounds.
fn late_most(reached: &[Candidate]) -> f64 {
    let late = reached.iter().filter(|found| found.late);
    late.map(|found| found.answer.utilization()).fold(0.0, f64::max)
}

impl Ranges<'_> {
    /// Returns the worst of the drops reached, answered to the tolerance. The demand after rebounds is so sensitive that it may not come up
    /// again; so the next are tried until none may be worse.
    pub(super) fn settle(&self, task: &Task<'_>, mut reached: Vec<Candidate>) -> Worst {
        reached.sort_by(|a, b| b.answer.utilization().total_cmp(&a.answer.utilization()));
        let mut worst = Worst { late: late_most(&reached), ..Worst::none() };
        // A drop that bounces on and on is not followed to its end, nor are those that bounce more.
        let mut bounces = f64::INFINITY;
        for late in [false, true] {
            let such = reached.iter().filter(|found| found.late == late);
            let mut tries = 0;
            for found in such {
                let most = worst.asked.map_or(0.0, |asked: Candidate| asked.answer.utilization());
                if found.answer.utilization() < most || tries == TRIES {
                    break;
                }
                if found.place.shares[RESTITUTION] >= bounces {
                    continue;
                }
                tries += 1;
                match self.exactly(task, found) {
                    Ok(exact) if exact.answer.utilization() > most || worst.asked.is_none() => {
                        worst.asked = Some(exact);
                    }
                    Ok(_) => {}
                    Err(error) => {
                        if matches!(error, Error::Unfinished) && self.free(task)[RESTITUTION] {
                            bounces = found.place.shares[RESTITUTION];
                        }
                        worst.refuse(1, &error);
                    }
                }
            }
        }
        // The one that counts, with all that it may be off by.
        if let Some(asked) = &mut worst.asked {
            let part = asked.part_there(task.component);
            let drop = self.single(&asked.place);
            asked.answer =
                asked.answer.with_what_strikes_multiply(&drop, &part, &task.limit, self.model, self.tolerance);
        }
        worst
    }

    /// Returns the worst of the drops reached as it was found, where the time is over: to the tolerance if it decides, and nobody knows how
    /// far off.
    pub(super) fn settle_at_once(&self, task: &Task<'_>, reached: Vec<Candidate>) -> Worst {
        let mut worst = Worst { late: late_most(&reached), stopped: true, ..Worst::none() };
        let found = reached.into_iter().max_by(|a, b| a.answer.utilization().total_cmp(&b.answer.utilization()));
        let exact =
            |found: Candidate| if found.answer.utilization() > 1.0 { self.exactly(task, &found) } else { Ok(found) };
        match found.map(exact) {
            Some(Ok(asked)) => {
                let answer = Answer { off_by: f64::INFINITY, ..asked.answer };
                worst.asked = Some(Candidate { answer, ..asked });
            }
            Some(Err(error)) => worst.refuse(1, &error),
            None => {}
        }
        worst
    }

    /// Answers a drop that was found to the tolerance, for the part that was found.
    pub(super) fn exactly(&self, task: &Task<'_>, found: &Candidate) -> Result<Candidate, Error> {
        let followed = follow(&self.single(&found.place), self.model, self.tolerance, Until::Over)?;
        let at = |at_m: [f64; 2]| {
            let there = Candidate { place: Coordinates { at_m, ..found.place }, ..*found };
            let part = there.part_there(task.component);
            // What may come later is told by the worst landings.
            let felt = PlaceHistory::new(&followed, part.place)?.leaving_later();
            let answer = felt.answer_or_nothing(&task.limit, part.suspension.as_ref())?;
            Ok::<_, Error>(Candidate { answer, ..there })
        };
        let mut worst = at(found.place.at_m)?;
        if !task.is_largest_between() {
            return Ok(worst);
        }
        // Where two shocks become one lies anywhere between two places.
        let (reaches, between) = (task.component.reaches_m(), f64::from(task.component.between()));
        let mut steps = reaches.map(|[lo, hi]| 0.5 * (hi - lo) / (between + 1.0));
        for _ in 0..NARROWED {
            for axis in (0..2).filter(|axis| reaches[*axis][0] < reaches[*axis][1]) {
                for by in [-steps[axis], steps[axis]] {
                    let mut next = worst.place.at_m;
                    next[axis] = (next[axis] + by).clamp(reaches[axis][0], reaches[axis][1]);
                    let next = at(next)?;
                    if next.exceeds(&worst) {
                        worst = next;
                    }
                }
            }
            steps = steps.map(|step| 0.5 * step);
        }
        Ok(worst)
    }
}
