//! The smallest change that makes a part safe with a margin: of one lever, or of two where one is not enough.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use super::lever::{Bounds, Change, Lever, Outcome, Remedies, Remedy, Together};
use super::trial::Breakers;
use super::trial::{is_enough, is_known_enough, room};
use crate::search::Watch;
use crate::{Accuracy, Assessment, ComponentAssessment, LimitAssessment, Verdict};
use clatter_product::{Component, Error, LimitKind, Mount, ProductFile, Source};

/// Steps from bound to bound in which safe values are looked for; an island of safety narrower than one may be missed.
pub const STEPS: u32 = 48;
/// Parts of the step in which safety begins: its place is known to one of them.
const PARTS: u32 = 256;
/// Values of a lever from which the best one is taken where none is enough.
const TRIES: u32 = 8;
/// Steps from the present values to the best ones of two levers together.
const SHARES: u32 = 16;

/// Finds, for every component that is not safe with a margin, and every lever alone, the smallest change that makes it so; where none
/// does, the best pair of changes, or how near one gets.
///
/// # Method
/// Values are tried outward from the present one, in steps of 1/48 of the bounds (frequencies: of their logarithm); the
/// step in which safety begins is bisected to 1/256. Every value is rounded before it is assessed to what can be specified,
/// as [`Change::to`] says: [`assess_to`](crate::assess_to) finds the part safe with the margin, of the file with the value as it is
/// printed; by both contact laws where contacts take time and the file names none. No mass is put outside of the body, ρ² ≤ `L_a L_b`.
/// A value is passed over at once where a drop that broke the part before still does, and a search for its worst drop is left as soon
/// as one breaks it: what takes its time is to find nothing. So the first value that no known drop breaks is searched, and what breaks
/// it tells of the next. Two levers go from their present values to the best of each together.
///
/// A box is searched in all of its drops, one after the other, until one breaks the part.
///
/// # Limitation
/// A safe stretch narrower than a step may be missed. Of pairs only those on the way to the best value of each lever are
/// looked at.
///
/// # Errors
/// Those of [`ProductFile::check`], [`Bounds::check`] and [`Accuracy::check`]; [`Error::OtherProduct`] for an assessment of another
/// product; [`Error::Number`] for a margin that is negative or not finite.
pub fn remedies(
    file: &ProductFile,
    assessment: &Assessment,
    bounds: &Bounds,
    margin: f64,
) -> Result<Vec<Remedies>, Error> {
    remedies_watched(file, assessment, bounds, margin, &|_, _| true)
}

/// Finds the same, watched. Where `watch` says to stop, the results so far are returned: levers that were not tried to their end are
/// [`Outcome::Stopped`].
///
/// # Errors
/// As [`remedies`].
pub fn remedies_watched(
    file: &ProductFile,
    assessment: &Assessment,
    bounds: &Bounds,
    margin: f64,
    watch: Watch<'_>,
) -> Result<Vec<Remedies>, Error> {
    if !(margin >= 0.0 && margin.is_finite()) {
        return Err(Error::Number(margin));
    }
    file.check()?;
    bounds.check()?;
    assessment.accuracy.check()?;
    assessment.is_of(file)?;
    let wanting = |c: &ComponentAssessment| !is_enough(file, c, margin);
    let failing = assessment.components.iter().enumerate().filter(|(_, found)| wanting(found));
    let levers = |i: usize| Lever::of(&file.product, &file.components[i]);
    let tasks: Vec<_> =
        failing.flat_map(|(i, found)| levers(i).into_iter().map(move |lever| (i, found, lever))).collect();
    // Each lever of each component is tried alone, and then together with the others.
    let (all, done) = (2 * tasks.len(), AtomicUsize::new(0));
    let go_on = || watch(done.load(Ordering::Relaxed).min(all), all);
    let does = |steps: usize| {
        done.fetch_add(steps, Ordering::Relaxed);
    };
    let case = |i: usize| {
        let component = &file.components[i];
        let accuracy = assessment.accuracy;
        Case { file, number: i, component, accuracy, bounds, margin, go_on: &go_on }
    };
    let solve = |&(i, found, lever): &(usize, &ComponentAssessment, Lever)| {
        let outcome = if go_on() { case(i).solve(lever, found) } else { Err(Error::Stopped) };
        does(1);
        Remedy { lever, outcome: outcome.unwrap_or(Outcome::Stopped) }
    };
    let solved: Vec<Remedy> = tasks.par_iter().map(solve).collect();
    let mut solved = solved.into_iter();
    let of_part = |of_one: &[(usize, &ComponentAssessment, Lever)]| {
        let levers = solved.by_ref().take(of_one.len()).collect();
        Remedies { component: of_one[0].0, levers, pair: None, nearest: None }
    };
    let parts: Vec<_> = tasks.chunk_by(|a, b| a.0 == b.0).map(of_part).collect();
    let together = |part: Remedies| {
        let found = &assessment.components[part.component];
        let settled = |remedy: &Remedy| matches!(remedy.outcome, Outcome::Change { .. } | Outcome::Stopped);
        let (mut pair, mut nearest) = (None, None);
        if !part.levers.iter().any(settled) && go_on() {
            (pair, nearest) = case(part.component).together(&part.levers, found).unwrap_or_default();
        }
        does(part.levers.len());
        Remedies { pair, nearest, ..part }
    };
    Ok(parts.into_par_iter().map(together).collect())
}

/// Returns whether a limit of a suspended part depends on a lever. What the part is asked for beyond its room is not known, so that its room
/// counts for its other responses too.
fn affects(lever: Lever, kind: LimitKind) -> bool {
    match lever {
        Lever::Frequency | Lever::Damping | Lever::StopGap | Lever::StopTime | Lever::Limit(LimitKind::RattleSpace) => {
            kind.is_response()
        }
        Lever::Position | Lever::Across => kind.source() != Source::Turn,
        Lever::Limit(own) => own == kind,
        Lever::InertiaRatio | Lever::Restitution | Lever::ContactTime => true,
    }
}

/// One part that is to be made safe.
#[derive(Clone, Copy)]
pub(super) struct Case<'a> {
    pub(super) file: &'a ProductFile,
    /// The number of the component in the file.
    pub(super) number: usize,
    pub(super) component: &'a Component,
    pub(super) accuracy: Accuracy,
    pub(super) bounds: &'a Bounds,
    pub(super) margin: f64,
    /// Returns true as long as there is time.
    pub(super) go_on: &'a (dyn Fn() -> bool + Sync),
}

impl Case<'_> {
    /// Finds the effect of one lever.
    ///
    /// # Errors
    /// [`Error::Stopped`].
    fn solve(&self, lever: Lever, found: &ComponentAssessment) -> Result<Outcome, Error> {
        if !self.matters(lever) {
            return Ok(Outcome::NoEffect);
        }
        let (here, [lo, hi]) = (self.here(lever), self.reach(lever));
        let nowhere = || Outcome::Nowhere { bounds: [self.shown(lever, lo), self.shown(lever, hi)] };
        let fails = |limit: &LimitAssessment| limit.verdict != Verdict::Safe || room(self.file, limit) < self.margin;
        if found.limits.iter().any(|limit| fails(limit) && !affects(lever, limit.limit)) {
            return Ok(nowhere());
        }
        // Where the present value is beyond the bounds, the search starts from the bound next to it.
        let start = here.clamp(lo, hi);
        let mut breakers = Breakers::of(self.file, self, found);
        let step = (hi - lo) / f64::from(STEPS);
        for k in 1..=STEPS {
            let mut best: Option<(f64, Box<ComponentAssessment>)> = None;
            for side in [-1.0, 1.0] {
                let outer = (start + side * f64::from(k) * step).clamp(lo, hi);
                let inner = (start + side * f64::from(k - 1) * step).clamp(lo, hi);
                // beyond the bound nothing is left to try but the bound itself
                if (outer - inner).abs() <= 0.0 && k > 1 {
                    continue;
                }
                let at = |n: u32| inner + f64::from(n) / f64::from(PARTS) * (outer - inner);
                let first = self.first(PARTS, None, &|n| vec![(lever, at(n))], &mut breakers)?;
                let Some((x, after)) = first.map(|(n, after)| (at(n), after)) else { continue };
                if best.as_ref().is_none_or(|(other, _)| (x - here).abs() < (other - here).abs()) {
                    best = Some((x, after));
                }
            }
            if let Some((x, after)) = best {
                return Ok(Outcome::Change { change: self.change(lever, x), after });
            }
        }
        Ok(nowhere())
    }

    /// Finds the best pair that is enough, and else how near one gets.
    ///
    /// # Errors
    /// [`Error::Stopped`].
    fn together(
        &self,
        levers: &[Remedy],
        found: &ComponentAssessment,
    ) -> Result<(Option<Together>, Option<Together>), Error> {
        let mut breakers = Breakers::of(self.file, self, found);
        let mut best = Vec::new();
        for remedy in levers.iter().filter(|remedy| remedy.outcome != Outcome::NoEffect) {
            best.extend(self.best_of(remedy.lever, &mut breakers)?);
        }
        let mut nearest: Option<Together> = None;
        let mut pair: Option<(u32, Together)> = None;
        for (i, (one, x, after)) in best.iter().enumerate() {
            self.nearer(&mut nearest, &[self.change(*one, *x)], after);
            for (two, y, _) in &best[i + 1..] {
                let at = |k: u32| {
                    let share = f64::from(k) / f64::from(SHARES);
                    let along = |lever: Lever, to: f64| {
                        let here = self.here(lever);
                        (lever, here + share * (to - here))
                    };
                    vec![along(*one, *x), along(*two, *y)]
                };
                let changes = |k: u32| at(k).iter().map(|&(lever, x)| self.change(lever, x)).collect::<Vec<_>>();
                let first = if let Some((least, _)) = &pair {
                    // The second lever is of use where it takes a smaller share.
                    if *least > 1 { self.first(least - 1, None, &at, &mut breakers)? } else { None }
                } else {
                    let room =
                        nearest.as_ref().map(|nearest| crate::least_margin(self.file, &nearest.after).min(self.margin));
                    let Some(all) = self.with_room(&at(SHARES), room, &mut breakers)? else { continue };
                    if !is_known_enough(self.file, &all, self.margin) {
                        self.nearer(&mut nearest, &changes(SHARES), &all);
                        continue;
                    }
                    self.first(SHARES, Some(all), &at, &mut breakers)?
                };
                if let Some((enough, after)) = first {
                    pair = Some((enough, Together { changes: changes(enough), after }));
                }
            }
        }
        Ok(match pair {
            Some((_, pair)) => (Some(pair), None),
            None => (None, nearest),
        })
    }

    /// Returns the value of a lever, among some from bound to bound, that leaves the largest margin.
    fn best_of(
        &self,
        lever: Lever,
        breakers: &mut Breakers,
    ) -> Result<Option<(Lever, f64, ComponentAssessment)>, Error> {
        let [lo, hi] = self.reach(lever);
        let at = |k: u32| lo + f64::from(k) / f64::from(TRIES) * (hi - lo);
        // The most hopeful first; the others are left as soon as a drop shows that they are worse.
        let asked = |k: u32| (self.asked(&[(lever, at(k))], breakers), k);
        let mut order: Vec<(f64, u32)> = (0..=TRIES).rev().map(asked).collect();
        order.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut best: Option<(u32, ComponentAssessment)> = None;
        let room = |after: &ComponentAssessment| crate::least_margin(self.file, after);
        for (_, k) in order {
            let least = best.as_ref().map(|(_, best)| room(best));
            let Some(after) = self.with_room(&[(lever, at(k))], least, breakers)? else { continue };
            // Of two that are alike the one nearer to the upper bound counts.
            let better = |(other, best): &(u32, ComponentAssessment)| {
                room(&after).total_cmp(&room(best)).then(k.cmp(other)).is_gt()
            };
            if best.as_ref().is_none_or(better) {
                best = Some((k, after));
            }
        }
        Ok(best.map(|(k, after)| (lever, at(k), after)))
    }

    /// Returns whether a limit of the part depends on a lever.
    fn matters(&self, lever: Lever) -> bool {
        let of_suspension = matches!(lever, Lever::Frequency | Lever::Damping | Lever::StopGap | Lever::StopTime);
        let is_there = !of_suspension || matches!(self.component.mount, Mount::Suspended { .. });
        is_there && self.component.limits.kinds().into_iter().any(|kind| affects(lever, kind))
    }
    /// Keeps the changes that leave the largest margin. Of a limit without an answer nobody knows how near it is.
    fn nearer(&self, nearest: &mut Option<Together>, changes: &[Change], after: &ComponentAssessment) {
        let unknown = after.limits.iter().any(|l| l.verdict == Verdict::Undecided && l.uncertainty.is_infinite());
        let room = |after: &ComponentAssessment| crate::least_margin(self.file, after);
        if !unknown && nearest.as_ref().is_none_or(|last| room(after) > room(&last.after)) {
            *nearest = Some(Together { changes: changes.to_vec(), after: Box::new(after.clone()) });
        }
    }
}
