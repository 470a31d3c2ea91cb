//! The smallest change that makes a part safe with a margin: of one lever, or of two where one is not enough.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use super::lever::{Bounds, Change, Lever, Outcome, Remedies, Remedy, Together};
use crate::search::{Place, Ranges, Task, Watch};
use crate::{
    Accuracy, Assessment, Component, ComponentAssessment, Error, Limit, LimitKind, Mount, ProductFile, Verdict,
};

/// Steps from bound to bound in which safe values are looked for; an island of safety narrower than one may be missed.
pub const STEPS: u32 = 48;
/// Bisections of the step in which safety begins: its place is then known to 1/2⁸ of a step.
const BISECTIONS: u32 = 8;
/// Values of a lever from which the best one is taken where none is enough.
const TRIES: u32 = 8;
/// Steps from the present values to the best ones of two levers together.
const SHARES: u32 = 16;

impl ProductFile {
    /// For every component that is not safe with a margin, and every lever alone, the smallest change that makes it so; where none
    /// does, the best pair of changes, or how near one gets.
    ///
    /// # Method
    /// Values are tried outward from the present one, in steps of 1/48 of the bounds (frequencies: of their logarithm); the
    /// step in which safety begins is bisected eight times. Every value is rounded before it is assessed to what can be specified,
    /// as [`Change::to`] says: [`assess_to`](Self::assess_to) finds the part safe with the margin, of the file with the value as it is
    /// printed. No mass is put outside of the body, ρ² ≤ `L_a L_b`. A value is passed over at once where a drop that broke the part before still does. Two levers go from their present values to
    /// the best of each together.
    ///
    /// # Limitation
    /// A safe stretch narrower than a step may be missed. Of pairs only those on the way to the best value of each lever are
    /// looked at.
    ///
    /// # Errors
    /// As [`assess`](Self::assess), for the product as it is; [`Error::Number`] for a margin that is negative or not finite.
    pub fn remedies(&self, assessment: &Assessment, bounds: &Bounds, margin: f64) -> Result<Vec<Remedies>, Error> {
        self.remedies_watched(assessment, bounds, margin, &|_, _| true)
    }

    /// The same, watched.
    ///
    /// # Errors
    /// As [`remedies`](Self::remedies); [`Error::Stopped`] where `watch` says so.
    pub fn remedies_watched(
        &self,
        assessment: &Assessment,
        bounds: &Bounds,
        margin: f64,
        watch: Watch<'_>,
    ) -> Result<Vec<Remedies>, Error> {
        if !(margin >= 0.0 && margin.is_finite()) {
            return Err(Error::Number(margin));
        }
        let wanting = |c: &ComponentAssessment| !is_enough(c, margin);
        let failing = assessment.components.iter().enumerate().filter(|(_, found)| wanting(found));
        let levers = |i: usize| Lever::of(&self.product, &self.components[i]);
        let tasks: Vec<_> =
            failing.flat_map(|(i, found)| levers(i).into_iter().map(move |lever| (i, found, lever))).collect();
        let case = |i: usize| Case::new(self, &self.components[i], assessment.accuracy, bounds, margin);
        // One lever after the other of each component, then at most one pair of them, which takes as long as a lever.
        let all = tasks.len() + tasks.chunk_by(|a, b| a.0 == b.0).count();
        let done = AtomicUsize::new(0);
        let go_on = || if watch(done.fetch_add(1, Ordering::Relaxed), all) { Ok(()) } else { Err(Error::Stopped) };
        let solve =
            |&(i, found, lever): &(usize, &ComponentAssessment, Lever)| go_on().map(|()| case(i).solve(lever, found));
        let outcomes = tasks.par_iter().map(solve).collect::<Result<Vec<Outcome>, Error>>()?;
        let mut list: Vec<Remedies> = Vec::new();
        for ((component, _, lever), outcome) in tasks.into_iter().zip(outcomes) {
            if list.last().is_none_or(|last| last.component != component) {
                list.push(Remedies { component, levers: Vec::new(), pair: None, nearest: None });
            }
            if let Some(last) = list.last_mut() {
                last.levers.push(Remedy { lever, outcome });
            }
        }
        for remedies in &mut list {
            go_on()?;
            if !remedies.levers.iter().any(|remedy| matches!(remedy.outcome, Outcome::Change { .. })) {
                (remedies.pair, remedies.nearest) = case(remedies.component).together(&remedies.levers);
            }
        }
        Ok(list)
    }
}

/// Whether a part is safe with a margin.
fn is_enough(found: &ComponentAssessment, margin: f64) -> bool {
    found.verdict == Verdict::Safe && found.tightest().room() >= margin
}

/// One part that is to be made safe.
#[derive(Clone, Copy)]
pub(crate) struct Case<'a> {
    pub(super) file: &'a ProductFile,
    pub(super) component: &'a Component,
    accuracy: Accuracy,
    pub(super) bounds: &'a Bounds,
    margin: f64,
}

impl<'a> Case<'a> {
    pub(crate) fn new(
        file: &'a ProductFile,
        component: &'a Component,
        accuracy: Accuracy,
        bounds: &'a Bounds,
        margin: f64,
    ) -> Self {
        Self { file, component, accuracy, bounds, margin }
    }

    fn solve(&self, lever: Lever, found: &ComponentAssessment) -> Outcome {
        if !self.matters(lever) {
            return Outcome::NoEffect;
        }
        let (here, [lo, hi]) = (self.here(lever), self.reach(lever));
        // Where the present value is beyond the bounds, from the bound that is next to it.
        let start = here.clamp(lo, hi);
        let ranges = self.ranges(self.file);
        let mut breakers: Vec<Place> =
            found.worst_case.iter().map(|worst| ranges.place_of(self.component, worst)).collect();
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
                let Some(after) = self.enough(&[(lever, outer)], &mut breakers) else { continue };
                let begin = self.begin(lever, inner, (outer, Box::new(after)), &mut breakers);
                if best.as_ref().is_none_or(|(x, _)| (begin.0 - here).abs() < (x - here).abs()) {
                    best = Some(begin);
                }
            }
            if let Some((x, after)) = best {
                return Outcome::Change { change: self.change(lever, x), after };
            }
        }
        Outcome::Nowhere { bounds: [self.shown(lever, lo), self.shown(lever, hi)] }
    }

    /// The enough value nearest to `short`, which is not, from one that is.
    fn begin(
        &self,
        lever: Lever,
        mut short: f64,
        mut enough: (f64, Box<ComponentAssessment>),
        breakers: &mut Vec<Place>,
    ) -> (f64, Box<ComponentAssessment>) {
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (short + enough.0);
            if self.value(lever, middle).map(f64::to_bits) == self.value(lever, enough.0).map(f64::to_bits) {
                enough.0 = middle;
                continue;
            }
            match self.enough(&[(lever, middle)], breakers) {
                Some(after) => enough = (middle, Box::new(after)),
                None => short = middle,
            }
        }
        enough
    }

    /// The best pair that is enough, and else how near one gets.
    fn together(&self, levers: &[Remedy]) -> (Option<Together>, Option<Together>) {
        let useful = levers.iter().filter(|remedy| remedy.outcome != Outcome::NoEffect).map(|remedy| remedy.lever);
        let best: Vec<_> = useful.filter_map(|lever| self.best_of(lever)).collect();
        let mut nearest: Option<Together> = None;
        let mut near = |changes: Vec<Change>, after: ComponentAssessment| {
            // Of a limit without an answer nobody knows how near it is.
            if after.limits.iter().any(|limit| limit.verdict == Verdict::Undecided && limit.uncertainty.is_infinite()) {
                return;
            }
            let closer = |last: &Together| after.tightest().room() > last.after.tightest().room();
            if nearest.as_ref().is_none_or(closer) {
                nearest = Some(Together { changes, after: Box::new(after) });
            }
        };
        let mut pair: Option<(u32, Together)> = None;
        for (i, (one, x, after)) in best.iter().enumerate() {
            near(vec![self.change(*one, *x)], after.clone());
            for (two, y, _) in &best[i + 1..] {
                let at = |k: u32| {
                    let share = f64::from(k) / f64::from(SHARES);
                    let along = |lever: Lever, to: f64| {
                        let here = self.here(lever);
                        (lever, here + share * (to - here))
                    };
                    [along(*one, *x), along(*two, *y)]
                };
                let Some(all) = self.assessed(&at(SHARES)) else { continue };
                let changes = |k: u32| at(k).iter().map(|&(lever, x)| self.change(lever, x)).collect::<Vec<_>>();
                if !is_enough(&all, self.margin) {
                    near(changes(SHARES), all);
                    continue;
                }
                let (mut short, mut enough, mut after) = (0, SHARES, all);
                while enough - short > 1 {
                    let middle = u32::midpoint(short, enough);
                    match self.assessed(&at(middle)).filter(|found| is_enough(found, self.margin)) {
                        Some(found) => (enough, after) = (middle, found),
                        None => short = middle,
                    }
                }
                if pair.as_ref().is_none_or(|(least, _)| enough < *least) {
                    pair = Some((enough, Together { changes: changes(enough), after: Box::new(after) }));
                }
            }
        }
        match pair {
            Some((_, pair)) => (Some(pair), None),
            None => (None, nearest),
        }
    }

    /// The value of a lever, among some from bound to bound, that leaves the largest margin.
    fn best_of(&self, lever: Lever) -> Option<(Lever, f64, ComponentAssessment)> {
        let [lo, hi] = self.reach(lever);
        let tries = (0..=TRIES).filter_map(|k| {
            let x = lo + f64::from(k) / f64::from(TRIES) * (hi - lo);
            Some((lever, x, self.assessed(&[(lever, x)])?))
        });
        tries.max_by(|a, b| a.2.tightest().room().total_cmp(&b.2.tightest().room()))
    }

    /// Whether a limit of the part depends on a lever.
    pub(crate) fn matters(&self, lever: Lever) -> bool {
        let kinds = self.component.limits.kinds();
        let suspended = matches!(self.component.mount, Mount::Suspended { .. });
        let responds = kinds.iter().any(|kind| matches!(kind, LimitKind::Acceleration | LimitKind::RattleSpace));
        match lever {
            Lever::Frequency | Lever::Damping => suspended && responds,
            Lever::Position => kinds.iter().any(|kind| *kind != LimitKind::AngularVelocityChange),
            Lever::InertiaRatio | Lever::Restitution | Lever::ContactTime | Lever::Limit(_) => true,
        }
    }

    fn ranges<'b>(&self, file: &'b ProductFile) -> Ranges<'b> {
        file.ranges(&self.accuracy)
    }

    /// The part with these values, if it is safe with the margin. What cannot be assessed is not known to be safe.
    fn enough(&self, values: &[(Lever, f64)], breakers: &mut Vec<Place>) -> Option<ComponentAssessment> {
        let file = self.changed(values)?;
        let (ranges, component) = (self.ranges(&file), file.components.first()?);
        let breaks = |place: &Place| {
            Limit::of(component)
                .into_iter()
                .any(|limit| ranges.in_one(&Task { component, limit }, place) * (1.0 + self.margin) > 1.0)
        };
        if breakers.iter().rev().any(breaks) {
            return None;
        }
        let found = self.assess(&file)?;
        if is_enough(&found, self.margin) {
            return Some(found);
        }
        breakers.extend(found.worst_case.iter().map(|worst| ranges.place_of(component, worst)));
        None
    }

    fn assessed(&self, values: &[(Lever, f64)]) -> Option<ComponentAssessment> {
        self.assess(&self.changed(values)?)
    }

    fn assess(&self, file: &ProductFile) -> Option<ComponentAssessment> {
        file.assess_to(&self.accuracy).ok()?.components.into_iter().next()
    }
}
