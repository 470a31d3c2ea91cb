//! This module finds whether values of levers make a part safe, by the drops that break it.

use super::lever::Lever;
use super::remedies::Case;
use crate::assess::ranges_of;
use crate::assess::{Breaker, Found, assess_these};
use crate::search::{Ranges, Task};
use crate::{ComponentAssessment, LimitAssessment, Verdict, WorstCase};
use clatter_product::{Error, Limit, LimitKind, Listed, ProductFile};

/// Returns the least margin of a part that was assessed, allowed/demand − 1: by both contact laws where contacts take time and the file
/// names none, for a verdict counts with both then; infinite where no drop was answered.
#[must_use]
pub fn least_margin(file: &ProductFile, found: &ComponentAssessment) -> f64 {
    found.limits.iter().map(|limit| room(file, limit)).fold(f64::INFINITY, f64::min)
}

/// Returns the margin of a limit, by both contact laws where the file names none.
pub(super) fn room(file: &ProductFile, limit: &LimitAssessment) -> f64 {
    let other = limit.other_law.filter(|_| file.product.contact_law.is_none());
    other.map_or(f64::INFINITY, |other| limit.allowed / other - 1.0).min(limit.room())
}

/// Returns whether a part is safe with a margin.
pub(super) fn is_enough(file: &ProductFile, found: &ComponentAssessment, margin: f64) -> bool {
    found.verdict == Verdict::Safe && least_margin(file, found) >= margin
}

/// Returns the same where every margin is known: of a change, drops that nothing answers show nothing.
pub(super) fn is_known_enough(file: &ProductFile, found: &ComponentAssessment, margin: f64) -> bool {
    is_enough(file, found, margin) && found.limits.iter().all(|limit| limit.margin.is_some())
}

/// The same share but for roundings.
const ALIKE: f64 = 1.0 + 1e-12;

/// Values of levers as they are written.
type Written = Vec<(Lever, [u64; 2])>;

/// What is known of a part that is changed.
pub(super) struct Breakers {
    /// Drops that broke it, those that did so last at the end.
    drops: Vec<Breaker>,
    /// Values that were searched, as they are written, and what the part is with them.
    searched: Vec<(Written, Option<Box<ComponentAssessment>>)>,
    /// Of each limit the least allowed value that may be enough, whatever else is changed with it.
    least: Vec<(LimitKind, f64)>,
}

impl Breakers {
    /// Returns the worst cases of an assessment.
    pub(super) fn of(file: &ProductFile, case: &Case<'_>, found: &ComponentAssessment) -> Self {
        // How far a box is followed depends on what it is allowed; a damage boundary has two values.
        let is_told = |limit: &&LimitAssessment| !file.is_box() && limit.limit != LimitKind::DamageBoundary;
        let least = |limit: &LimitAssessment| {
            let asked = |share: f64| limit.demand.map(|demand| demand * (1.0 + share));
            let [found, most] = [asked(case.margin)?, asked(limit.uncertainty.max(case.margin))?];
            // What energy does not allow is safe too.
            Some((limit.limit, most.min(found.max(limit.bound.unwrap_or(f64::INFINITY))) / ALIKE))
        };
        let least = found.limits.iter().filter(is_told).filter_map(least).collect();
        let mut breakers = Self { drops: Vec::new(), searched: Vec::new(), least };
        breakers.learn(file, case, found);
        breakers
    }
    /// The tightest limit tells most, and is the last.
    fn learn(&mut self, file: &ProductFile, case: &Case<'_>, found: &ComponentAssessment) {
        let listed = file.listed();
        let mut limits: Vec<_> = found.limits.iter().collect();
        limits.sort_by(|a, b| b.room().total_cmp(&a.room()));
        let worst = limits.into_iter().filter_map(|limit| limit.worst_case.as_ref());
        let breaker = |worst: &WorstCase| {
            let n = worst.listed;
            let ranges = case.ranges(file, &listed[n]);
            Breaker { other_law: false, listed: n, place: ranges.place_of(case.component, worst) }
        };
        self.drops.extend(worst.map(breaker));
    }
}

/// A product with a part that is changed, and the demands on that part.
struct Changed {
    file: ProductFile,
    /// The number of the part.
    number: usize,
    /// Its drops.
    listed: Vec<Listed>,
    limits: Vec<Limit>,
}

impl Changed {
    fn tasks(&self) -> impl Iterator<Item = Task<'_>> {
        let component = &self.file.components[self.number];
        self.limits.iter().map(move |limit| Task { component, limit: *limit })
    }
}

/// Returns the largest demand, as a share of the limit, that leaves a margin.
fn most(margin: f64) -> f64 {
    (1.0 + margin).recip()
}

impl Case<'_> {
    fn with(&self, values: &[(Lever, f64)]) -> Option<Changed> {
        let file = self.changed(values)?;
        let limits = Limit::of(&file.components[self.number]);
        Some(Changed { listed: file.listed(), file, number: self.number, limits })
    }

    fn ranges<'b>(&self, file: &'b ProductFile, listed: &'b Listed) -> Ranges<'b> {
        ranges_of(file, &listed.drop, listed.base, &self.accuracy)
    }

    /// Returns the law by which a drop breaks the part.
    fn by_law<'b>(&self, changed: &'b Changed, breaker: &Breaker) -> Ranges<'b> {
        let own = self.ranges(&changed.file, &changed.listed[breaker.listed]);
        if breaker.other_law { Ranges { law: own.law.other(), ..own } } else { own }
    }

    /// Returns whether a drop that is known breaks the part with these values, or they cannot be had.
    fn is_broken(&self, values: &[(Lever, f64)], breakers: &mut Breakers) -> bool {
        if let &[(lever @ Lever::Limit(kind), x)] = values {
            let [allowed, _] = self.value(lever, x);
            if breakers.least.iter().any(|(of, least)| *of == kind && allowed < *least) {
                return true;
            }
        }
        let Some(changed) = self.with(values) else { return true };
        let breaks = |breaker: &Breaker| {
            let ranges = self.by_law(&changed, breaker);
            changed.tasks().any(|task| ranges.in_one(&task, &breaker.place) > most(self.margin))
        };
        let by = breakers.drops.iter().rposition(breaks);
        if let Some(n) = by {
            // It is tried first the next time.
            breakers.drops[n..].rotate_left(1);
        }
        by.is_some()
    }

    /// Returns the largest demand of known drops on the part with these values.
    pub(super) fn asked(&self, values: &[(Lever, f64)], breakers: &Breakers) -> f64 {
        let Some(changed) = self.with(values) else { return f64::INFINITY };
        let asked = breakers.drops.iter().flat_map(|b| {
            let ranges = self.by_law(&changed, b);
            changed.tasks().map(move |task| ranges.in_one(&task, &b.place))
        });
        asked.fold(0.0, f64::max)
    }

    /// Returns the part with these values, unless its margin is below `room`. A part that cannot be assessed has no result.
    ///
    /// # Errors
    /// [`Error::Stopped`].
    pub(super) fn with_room(
        &self,
        values: &[(Lever, f64)],
        room: Option<f64>,
        breakers: &mut Breakers,
    ) -> Result<Option<ComponentAssessment>, Error> {
        let most = room.map_or(f64::INFINITY, |room| most(room) * ALIKE);
        let Some(changed) = self.with(values) else { return Ok(None) };
        let asks_more = |breaker: &Breaker| {
            let ranges = self.by_law(&changed, breaker);
            changed.tasks().any(|task| ranges.asks_more(&task, &breaker.place, most))
        };
        if breakers.drops.iter().rev().any(asks_more) {
            return Ok(None);
        }
        self.searched(&changed, most, breakers)
    }

    /// Returns the part with these values, unless a drop is found that demands more, by any law that its verdict counts with.
    fn searched(
        &self,
        changed: &Changed,
        most: f64,
        breakers: &mut Breakers,
    ) -> Result<Option<ComponentAssessment>, Error> {
        let by_other = if self.file.product.contact_law.is_some() { f64::INFINITY } else { most };
        let part = &changed.file.components[self.number];
        let found = assess_these(&changed.file, &[part], &self.accuracy, [most, by_other], &|_, _| (self.go_on)());
        if !(self.go_on)() {
            return Err(Error::Stopped);
        }
        match found {
            Ok(Ok(Found { components, .. })) => {
                let found = components.into_iter().next();
                if let Some(found) = &found {
                    breakers.learn(&changed.file, self, found);
                }
                Ok(found)
            }
            Ok(Err(breaker)) => {
                breakers.drops.push(breaker);
                Ok(None)
            }
            Err(_) => Ok(None),
        }
    }

    /// Returns the part with these values, if it is safe with the margin.
    fn enough(
        &self,
        values: &[(Lever, f64)],
        breakers: &mut Breakers,
    ) -> Result<Option<Box<ComponentAssessment>>, Error> {
        let written = self.written(values);
        if let Some((_, found)) = breakers.searched.iter().find(|(other, _)| *other == written) {
            return Ok(found.clone());
        }
        let Some(changed) = self.with(values) else { return Ok(None) };
        let found = self.searched(&changed, most(self.margin) * ALIKE, breakers)?;
        let found = found.filter(|found| is_known_enough(self.file, found, self.margin)).map(Box::new);
        breakers.searched.push((written, found.clone()));
        Ok(found)
    }

    /// Returns values as they are written.
    fn written(&self, values: &[(Lever, f64)]) -> Written {
        values.iter().map(|&(lever, x)| (lever, self.value(lever, x).map(f64::to_bits))).collect()
    }

    /// Finds the first step of those up to `last` that makes the part safe with the margin, where the steps before fail and those after do
    /// not; `last` may be known. None where that one fails.
    ///
    /// # Errors
    /// [`Error::Stopped`].
    pub(super) fn first(
        &self,
        last: u32,
        known: Option<ComponentAssessment>,
        at: &dyn Fn(u32) -> Vec<(Lever, f64)>,
        breakers: &mut Breakers,
    ) -> Result<Option<(u32, Box<ComponentAssessment>)>, Error> {
        let (mut short, mut enough) = (0, known.map(|after| (last, Box::new(after))));
        // The flag is true as long as the drops that are known show where to look.
        let mut guided = true;
        loop {
            let end = enough.as_ref().map_or(last, |(n, _)| *n);
            if enough.is_none() && self.is_broken(&at(end), breakers) {
                return Ok(None);
            }
            let mut open = end;
            while open - short > 1 {
                let middle = u32::midpoint(short, open);
                if self.is_broken(&at(middle), breakers) { short = middle } else { open = middle }
            }
            if enough.is_some() && open == end {
                return Ok(enough);
            }
            let next = match &enough {
                _ if guided => open,
                None => end,
                Some(_) => open + (end - open) / 2,
            };
            if let Some(after) = self.enough(&at(next), breakers)? {
                enough = Some((next, after));
            } else if next == last {
                return Ok(None);
            } else {
                short = next;
                guided = self.is_broken(&at(next), breakers);
            }
        }
    }
}
