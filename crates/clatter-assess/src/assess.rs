//! This module goes from a product to its verdict.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use crate::bound::bound;
use crate::decide::decide;
use crate::engine::answer;
use crate::reason::{Contradiction, Doubt, Note, Reason};
use crate::search::{Candidate, Coordinates, LaterLandings, Ranges, Task, Watch, Worst, with_gravity};
use crate::{
    Accuracy, Assessment, Assumed, ComponentAssessment, LandingAssessment, LimitAssessment, ModelChoice, Sides,
    Verdict, WorstCase,
};
use clatter_flight::Drop;
use clatter_product::{
    Base, Component, ContactLaw, DropName, DropRanges, Error, LEVEL_RAD, Limit, LimitKind, Model, Mount, ProductFile,
    Source, Unit,
};

/// The part of a worst case that the search may miss, as a share of it: tests hold single drops of the same ranges to this.
pub(crate) const COVERAGE: f64 = 0.02;
/// The same of a box, of which fewer drops are followed, and of the demand of any product after rebounds, which depends on every input:
/// single drops of 200 limits of boxes passed what was found by 5 % at most, and climbs from thousands of drops of 240 limits of lively
/// bars by 10 % in 4, in which energy allowed more. And that of a part with stops, which grows by steps where a touch is gained: of 282 limits
/// of bars single drops passed two by 5 to 11 %; where such a part just reaches its stop it is how far it swings that is covered.
pub(crate) const COVERAGE_WHERE_ROUGH: f64 = 0.1;

/// A drop with a larger demand than is of use.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Breaker {
    /// True where the search is by the other contact law than that of the product.
    pub(crate) other_law: bool,
    /// The number of the drop among those that are searched.
    pub(crate) listed: usize,
    pub(crate) place: Coordinates,
}

/// The demands that no drop exceeds, by either contact law.
const NOTHING_BREAKS: [f64; 2] = [f64::INFINITY; 2];

/// Finds the worst drop of every component over all stated ranges, and whether it stands it: [`assess_to`](crate::assess_to) 1 %.
///
/// # Errors
/// As [`assess_to`](crate::assess_to).
///
/// # Examples
/// ```
/// use clatter_product::{EXAMPLE, ProductFile};
/// let assessment = clatter_assess::assess(&ProductFile::read(EXAMPLE, "example.toml")?)?;
/// for limit in assessment.components.iter().flat_map(|c| &c.limits) {
///     assert!(limit.bound.zip(limit.demand).is_none_or(|(bound, demand)| demand <= bound));
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn assess(file: &ProductFile) -> Result<Assessment, Error> {
    assess_to(file, &Accuracy::default())
}

/// Assesses the product to a tolerance, or by a named model.
///
/// # Method
/// Drops of the ranges are followed by the model with the most physics that the data allow: contacts that take time where
/// their time is known, else instant impacts at real tilt with gravity. The worst one is searched as the module of
/// the search says.
///
/// A limit is *unsafe* where a drop was found that exceeds it. It is *safe* where the energy of the drops allows no more than
/// it, or where every drop of the search was answered and the worst leaves room for what its answer may be off by, for what
/// the search may miss, 2 %, or 10 % of a box and after rebounds, and for the demand of rebounds by their energy. Else it is
/// *undecided*, and the reason is reported. The acceleration of a part that exceeds its rattle space is undecided: it hits its stop.
///
/// # Errors
/// Those of [`ProductFile::check`] for data that product files do not allow; [`Error::Tolerance`] for a tolerance outside
/// [1e-4, 0.5], [`Error::Merge`] for a time that is none; [`Error::Contact`] for the compliant model of a product without contact
/// time.
pub fn assess_to(file: &ProductFile, accuracy: &Accuracy) -> Result<Assessment, Error> {
    assess_watched(file, accuracy, &|_, _| true)
}

/// Assesses the product to a tolerance, watched. Where `watch` says to stop, no more drops are followed: what was found by then is
/// answered, unsafe limits as ever, and the others are undecided unless energy alone says that they are safe.
///
/// # Errors
/// As [`assess_to`](crate::assess_to).
pub fn assess_watched(file: &ProductFile, accuracy: &Accuracy, watch: Watch<'_>) -> Result<Assessment, Error> {
    let all: Vec<&Component> = file.components.iter().collect();
    let found = assess_these(file, &all, accuracy, NOTHING_BREAKS, watch)?;
    let Found { components, landings } = found.unwrap_or_else(|_| unreachable!("nothing exceeds infinity"));
    let verdict = Verdict::of(components.iter().map(|c| c.verdict));
    let (product, assumed) = (file.product.name.clone(), Assumed::of(file, accuracy));
    Ok(Assessment { product, verdict, assumed, components, landings, accuracy: *accuracy })
}

/// Assesses one component as [`assess_watched`] does, with the same drops.
///
/// # Errors
/// As [`assess_to`](crate::assess_to); [`Error::OtherProduct`] for a component that is none of this product.
///
/// # Examples
/// ```
/// use clatter_assess::Accuracy;
/// use clatter_product::{EXAMPLE, ProductFile};
/// let file = ProductFile::read(EXAMPLE, "example.toml")?;
/// let alone = clatter_assess::assess_one(&file, &file.components[1], &Accuracy::default(), &|_, _| true)?;
/// assert_eq!(alone, clatter_assess::assess(&file)?.components[1]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn assess_one(
    file: &ProductFile,
    component: &Component,
    accuracy: &Accuracy,
    watch: Watch<'_>,
) -> Result<ComponentAssessment, Error> {
    if !file.components.contains(component) {
        return Err(Error::OtherProduct(component.name.clone()));
    }
    let found = assess_these(file, &[component], accuracy, NOTHING_BREAKS, watch)?;
    Ok(found.map_or_else(|_| unreachable!("nothing exceeds infinity"), |mut found| found.components.remove(0)))
}

/// Assesses some components as [`assess_watched`] does, with the drops of all, where only drops are of use
/// that demand no more than `most` of any of their limits, by the first contact law and by the other: the search ends as soon as
/// a drop is answered that demands more, which is reported.
pub(crate) fn assess_these(
    file: &ProductFile,
    these: &[&Component],
    accuracy: &Accuracy,
    most: [f64; 2],
    watch: Watch<'_>,
) -> Result<Result<Found, Breaker>, Error> {
    accuracy.check()?;
    file.check()?;
    file.check_apart(accuracy.merge_s)?;
    if let Some(model) = accuracy.model.filter(|model| file.product.body.is_wide() && *model != Model::Compliant) {
        return Err(Error::PlateModel(model));
    }
    if accuracy.model == Some(Model::Compliant) && file.product.contact_time_s.is_none() {
        return Err(Error::Contact);
    }
    let own = !file.product.own_contacts.is_none();
    if let Some(model) = accuracy.model.filter(|model| own && *model != Model::Compliant) {
        return Err(Error::OwnContacts(model));
    }
    let listed = file.listed();
    let tasks: Vec<Task<'_>> = these.iter().copied().flat_map(limits_of).collect();
    let all_tasks: Vec<Task<'_>> = file.components.iter().flat_map(limits_of).collect();
    let searched: Vec<Vec<Ranges<'_>>> = listed
        .iter()
        .map(|one| {
            let ranges = ranges_of(file, &one.drop, one.base, accuracy);
            laws(file, ranges.model).into_iter().map(|law| Ranges { law, ..ranges }).collect()
        })
        .collect();
    let numbered = searched.iter().map(Vec::len).enumerate();
    let searches: Vec<(usize, usize)> =
        numbered.flat_map(|(listed, laws)| (0..laws).map(move |n| (listed, n))).collect();
    let mut worst: Vec<Vec<Vec<Worst>>> = searched.iter().map(|_| Vec::new()).collect();
    let progress = SideBySide { done: AtomicUsize::new(0), told: AtomicUsize::new(0), count: searches.len(), watch };
    // What a product does as it lands again depends on the law and on gravity, and on nothing else of the drop.
    let landings: Vec<[LaterLandings; 2]> = listed.iter().map(|_| <[LaterLandings; 2]>::default()).collect();
    let alike: Vec<usize> = listed.iter().map(|one| with_gravity(&listed, one.drop.gravity_m_s2)).collect();
    for some in searches.chunks(SIDE_BY_SIDE) {
        let search = |&(listed, n): &(usize, usize)| {
            let watch = |done, all| progress.goes_on(done, all);
            let found = searched[listed][n].worst(&tasks, &all_tasks, &landings[alike[listed]][n], most[n], &watch);
            progress.done.fetch_add(1, Ordering::Relaxed);
            found
        };
        let found: Vec<Result<Vec<Worst>, Box<Coordinates>>> = some.par_iter().map(search).collect();
        for (&(listed, n), found) in some.iter().zip(found) {
            match found {
                Ok(of_law) => worst[listed].push(of_law),
                Err(place) => return Ok(Err(Breaker { other_law: n > 0, listed, place: *place })),
            }
        }
    }
    // The results of all listed drops, of each limit by each law.
    let judged = |n: usize, task: &Task<'_>, drop: usize| -> Result<Vec<Judged>, Error> {
        let laws = searched[drop].iter().zip(&worst[drop]);
        laws.map(|(ranges, worst)| judge(file, ranges, task, &worst[n])).collect()
    };
    let mut all = tasks.iter().enumerate();
    let mut components = Vec::with_capacity(these.len());
    let names = file.drop_names();
    let mut landings: Vec<LandingAssessment> = names
        .iter()
        .zip(&file.landings)
        .map(|(name, landing)| LandingAssessment::new(*name, landing, &file.product))
        .collect();
    for component in these {
        // The results are collected for each limit over all drops, and then stops change those of each drop.
        let mut of_limits = Vec::new();
        for (n, task) in all.by_ref().take(component.limits.kinds().len()) {
            let said = |drop: usize| Ok(limit_of(&searched[drop][0], task, judged(n, task, drop)?));
            let of_drops: Vec<Result<LimitAssessment, Error>> = (0..listed.len()).into_par_iter().map(said).collect();
            // The first of all errors, not the fastest.
            of_limits.push(of_drops.into_iter().collect::<Result<Vec<_>, _>>()?);
        }
        for drop in 0..listed.len() {
            let mut of_drop: Vec<&mut LimitAssessment> =
                of_limits.iter_mut().map(|of_drops| &mut of_drops[drop]).collect();
            stopped(component, &mut of_drop);
            if let Some(landing) = landings.get_mut(drop) {
                for limit in of_drop {
                    landing.take(component, limit);
                }
            }
        }
        let mut limits: Vec<_> = of_limits.into_iter().map(|of_drops| governing(&of_drops, &names)).collect();
        // Nobody reads of a trial how it reaches its stop.
        if component.stops.is_none() && most == NOTHING_BREAKS {
            for limit in &mut limits {
                tell_stop(limit, component, &searched);
            }
        }
        components.push(verdict(file, component, limits));
    }
    Ok(Ok(Found { components, landings }))
}

/// Returns the contact laws by which drops are followed, its own first.
pub(crate) fn laws(file: &ProductFile, model: Model) -> Vec<ContactLaw> {
    let (law, own) = (file.product.law(), !file.product.own_contacts.is_none());
    match model {
        // Contacts that differ are hysteretic, and a law that the file names is the one that counts.
        Model::Compliant if !own && file.product.contact_law.is_none() => vec![law, law.other()],
        _ => vec![law],
    }
}

/// Returns the ranges as the search takes them, of a product that falls once.
#[cfg(test)]
pub(crate) fn ranges<'a>(file: &'a ProductFile, accuracy: &Accuracy) -> Ranges<'a> {
    ranges_of(file, &file.drop, None, accuracy)
}

pub(crate) fn ranges_of<'a>(
    file: &'a ProductFile,
    drop: &'a DropRanges,
    base: Option<Base>,
    accuracy: &Accuracy,
) -> Ranges<'a> {
    let fullest = if file.product.contact_time_s.is_some() { Model::Compliant } else { Model::FiniteTilt };
    let model = accuracy.model.unwrap_or(fullest);
    let law = file.product.law();
    let listed = file.landings.len().max(1);
    let Accuracy { tolerance, merge_s, .. } = *accuracy;
    Ranges { product: &file.product, drop, model, base, listed, law, tolerance, merge_s }
}

/// Judges a limit by the worst drop that one contact law gives.
fn judge(file: &ProductFile, ranges: &Ranges<'_>, task: &Task<'_>, worst: &Worst) -> Result<Judged, Error> {
    let bound = bound(&file.product, ranges.drop, ranges.base, task.component, &task.limit, ranges.law);
    let bound = bound.filter(|bound| bound.is_finite());
    let Some(mut asked) = worst.asked else { return Ok(Judged::unanswered(worst, bound)) };
    // The steps that need further drops are left out where the time is over.
    let flat = if worst.stopped { None } else { landing_flat(ranges, task, &asked)? };
    if let Some(flat) = flat.filter(|flat| ranges.hold(flat) && flat.exceeds(&asked)) {
        asked = flat;
    }
    let found = asked.answer;
    let utilization = found.utilization();
    let is_rough = ranges.base.is_some() || asked.late || task.hits_stops();
    let covered = utilization * (1.0 + if is_rough { COVERAGE_WHERE_ROUGH } else { COVERAGE });
    let covered = covered.max(worst.late * (1.0 + COVERAGE_WHERE_ROUGH));
    let mut of = Judged { most: covered + found.off_by / found.allowed, ..Judged::new(bound) };
    if !file.product.body.is_wide() && task.limit.kind == LimitKind::AngularVelocityChange {
        of.notes.push(Note::Rolls);
    }
    if found.off_by.is_infinite() && !worst.stopped {
        of.notes.push(Note::NoError);
    } else if found.error().is_finite() && found.error() > 10.0 * ranges.tolerance {
        of.notes.push(Note::Error(found.error()));
    }
    // What a stop asks for begins steeply where the part just reaches it: how far it swings is covered, and not what it is asked for alone.
    if task.hits_stops() {
        of.most = of.most.max(ranges.covered_at_stops(task, &asked, worst.swing));
    }
    if worst.later > of.most {
        of.most = worst.later;
        of.notes.push(Note::Rebounds(of.most));
    }
    // With contacts the edges beyond feet are followed.
    let by_impacts = file.product.body.feet.is_some() && ranges.model < Model::Compliant;
    if by_impacts && (worst.later > 0.0 || of.most.is_infinite()) {
        of.notes.push(Note::Edges);
    }
    let drop = ranges.single(&asked.place);
    if ranges.model < Model::fullest(&drop) && !worst.stopped {
        let place = asked.part_there(task.component);
        let (asked, fullest) = (ranges.model, Model::fullest(&drop));
        match answer(&drop, &place, &task.limit, fullest, ranges.tolerance) {
            Ok(full) => {
                let off = full.utilization() - utilization;
                of.most += off.max(0.0);
                of.notes.push(Note::Model { asked, fullest, off: off / utilization });
            }
            Err(Error::Stopped) => return Err(Error::Stopped),
            Err(error) => of.doubts.push(Doubt::Fullest(fullest, error)),
        }
    }
    // A plate is of small tilt, and a bar at real tilt is followed without friction.
    let is_steep = drop.tilt_rad > LEVEL_RAD && ranges.model == Model::Compliant && drop.body.feet.is_none();
    if drop.is_level && (drop.body.is_wide() || is_steep) && !worst.stopped {
        let thickness_m = drop.body.is_wide().then(|| drop.body.thickness().m());
        match ranges.as_block(task, &asked, &worst.near) {
            Ok(most) => {
                of.most += (most - utilization).max(0.0);
                if utilization > 0.0 {
                    of.notes.push(Note::Tilt { off: most / utilization - 1.0, thickness_m });
                }
            }
            Err(error) => of.doubts.push(Doubt::NoTilt(error)),
        }
    }
    if let Some((count, error)) = worst.refused.clone() {
        of.doubts.push(Doubt::Refused { count, drops: worst.drops, error });
    }
    if worst.stopped {
        let refused = worst.refused.as_ref().map_or(0, |(count, _)| *count);
        of.doubts.push(Doubt::Stopped { answered: worst.drops.saturating_sub(refused) });
    }
    // The demand of drops that are not known may be any number that energy allows; a damage boundary has two.
    let is_known = of.doubts.iter().all(|doubt| matches!(doubt, Doubt::Stopped { .. }));
    if !is_known {
        let by_energy = bound.filter(|_| task.limit.kind.source() != Source::Boundary);
        of.most = by_energy.map_or(f64::INFINITY, |bound| bound / task.limit.allowed);
    } else if utilization <= 1.0 && !of.most.is_finite() {
        of.doubts.push(Doubt::NoBound);
    } else if utilization <= 1.0 && of.most > 1.0 {
        let (found, most) = (utilization, of.most);
        of.doubts.push(Doubt::Others { found, most });
    }
    of.most = of.most.max(utilization);
    let held = bound.is_some_and(|bound| bound <= task.limit.allowed);
    of.verdict = if utilization > 1.0 {
        Verdict::Unsafe
    } else if held || of.doubts.is_empty() {
        Verdict::Safe
    } else {
        Verdict::Undecided
    };
    if of.verdict == Verdict::Unsafe && of.most.is_infinite() && !of.doubts.is_empty() {
        of.notes.push(Note::Open(of.doubts.clone()));
    }
    of.flat = flat.map(|flat| flat.answer.value);
    of.asked = Some(asked);
    Ok(of)
}

/// Returns the demand of the worst drop if it landed flat, in the unit of the worst: where no drop of the ranges lands so, one at the
/// same place of them.
fn landing_flat(ranges: &Ranges<'_>, task: &Task<'_>, worst: &Candidate) -> Result<Option<Candidate>, Error> {
    let drop = ranges.single(&worst.place).flattened();
    let part = worst.part_there(task.component);
    let limit = in_unit(&task.limit, worst.answer.unit);
    let flat = match answer(&drop, &part, &limit, ranges.model, ranges.tolerance) {
        Err(Error::Stopped) => return Err(Error::Stopped),
        flat => flat.ok(),
    };
    let place = worst.place.flattened(drop.is_flat);
    Ok(flat.map(|answer| Candidate { place, part: worst.part, answer, late: false }))
}

/// Returns the limit by its contact laws: its own first, and then the other one where contacts take time.
fn limit_of(ranges: &Ranges<'_>, task: &Task<'_>, judged: Vec<Judged>) -> LimitAssessment {
    let mut judged = judged.into_iter();
    let Some(own) = judged.next() else { unreachable!("drops are followed by one law at least") };
    let other = judged.next();
    let Judged { asked, mut verdict, mut doubts, notes, most, bound, flat } = own;
    let other_law = match &other {
        Some(other) => asked.as_ref().zip(other.asked.as_ref()).map(|(own, other)| in_unit_of(own, other)),
        None => asked.as_ref().and_then(|asked| by_other_law(ranges, task, asked)),
    };
    if let Some(other) = other.filter(|other| other.verdict != verdict) {
        let law = ranges.law.other();
        let decided = |of: Verdict| of != Verdict::Undecided;
        if decided(verdict) && decided(other.verdict) {
            let share = |asked: Option<Candidate>| asked.map(|asked| asked.answer.utilization());
            doubts = vec![Doubt::Laws([(ranges.law, share(asked)), (law, share(other.asked))])];
        } else if decided(verdict) {
            doubts = vec![Doubt::OtherLaw { law, doubts: other.doubts }];
        } else if other.verdict == Verdict::Unsafe {
            doubts.push(Doubt::ExceededByOtherLaw(law));
        }
        verdict = Verdict::Undecided;
    }
    let (demand, unit) = (asked.map(|asked| asked.answer), task.limit.kind.unit());
    let utilization = demand.map_or(0.0, |answer| answer.utilization());
    // With no demand and none to come it is 0.
    let uncertainty = if demand.is_none() { f64::INFINITY } else { (most / utilization - 1.0).max(0.0) };
    let shown = asked.map_or_else(|| ranges.middle(task.component), |asked| asked.place);
    let mut limit = LimitAssessment {
        limit: task.limit.kind,
        unit: demand.map_or(unit, |answer| answer.unit),
        allowed: demand.map_or(task.limit.allowed, |answer| answer.allowed),
        demand: demand.map(|answer| answer.value),
        margin: demand.map(|answer| answer.allowed / answer.value - 1.0),
        verdict,
        reliability: None,
        bound: bound.filter(|_| demand.is_none_or(|answer| answer.unit == unit)),
        uncertainty,
        governs: None,
        clatter_free: flat,
        other_law,
        worst_case: asked.map(|asked| worst_case(&asked, ranges, task.component)),
        at_stop: None,
        model: model(ranges, task, accuracy_reason(ranges, &ranges.single(&shown))),
        undecided: if verdict == Verdict::Undecided { doubts } else { Vec::new() },
        decided_by: None,
        notes,
    };
    limit.hold_to_bound(ranges.tolerance);
    limit
}

impl LimitAssessment {
    /// Checks that the demand is within the bound, but for what its answer may be off by.
    pub(crate) fn hold_to_bound(&mut self, tolerance: f64) {
        if let Some((demand, bound)) =
            self.demand.zip(self.bound).filter(|(demand, bound)| *demand > bound * (1.0 + tolerance))
        {
            self.contradicted(Contradiction::AboveBound { demand, bound });
        }
    }
    /// An assessment that contradicts itself has no bound, and says nothing is safe.
    fn contradicted(&mut self, contradiction: Contradiction) {
        self.bound = None;
        self.notes.push(Note::Contradiction(contradiction));
        if self.verdict != Verdict::Unsafe {
            self.verdict = Verdict::Undecided;
            self.undecided = vec![Doubt::Contradiction(contradiction)];
        }
    }
}

/// Searches that are made side by side: of each listed drop by each law. The first of all that stops early gives the reason, the same on
/// any number of threads.
const SIDE_BY_SIDE: usize = 8;

/// The progress of searches side by side.
struct SideBySide<'a> {
    /// Searches that are over.
    done: AtomicUsize,
    /// The progress that was reported, which never goes back.
    told: AtomicUsize,
    count: usize,
    watch: Watch<'a>,
}

impl SideBySide<'_> {
    /// Tells that of one search so much is done, and says whether to go on.
    fn goes_on(&self, done: usize, all: usize) -> bool {
        const PARTS: usize = 10_000;
        let parts = self.done.load(Ordering::Relaxed) * PARTS + done * PARTS / all.max(1);
        let told = self.told.fetch_max(parts, Ordering::Relaxed).max(parts);
        (self.watch)(told.min(self.count * PARTS), self.count * PARTS)
    }
}

/// The results for components, and for each drop of a box.
pub(crate) struct Found {
    pub(crate) components: Vec<ComponentAssessment>,
    landings: Vec<LandingAssessment>,
}

/// Returns the result of all listed drops together for one limit. The demand is the largest of all drops that were answered, with the drop
/// that causes it; the verdict is the worst of all. Where another drop decides the verdict, it is named, and the reasons are its own. The
/// bound and the demand that others may add are those of all.
fn governing(of_drops: &[LimitAssessment], names: &[DropName]) -> LimitAssessment {
    // The values are shares of the allowed value: a damage boundary is reported in either of two units.
    let share = |limit: &LimitAssessment, value: f64| value / limit.allowed;
    let most = |limit: &LimitAssessment| {
        limit.demand.map_or(f64::INFINITY, |demand| share(limit, demand) * (1.0 + limit.uncertainty))
    };
    let all = |of: &dyn Fn(&LimitAssessment) -> Option<f64>| {
        of_drops.iter().map(of).reduce(|one, other| Some(one?.max(other?))).flatten()
    };
    let unit = of_drops.first().map(|limit| limit.unit);
    let bound = all(&|limit| limit.bound.filter(|_| Some(limit.unit) == unit));
    let other_law = all(&|limit| limit.other_law.map(|other| share(limit, other)));
    let asked = |limit: &LimitAssessment| limit.demand.map_or(-1.0, |demand| share(limit, demand));
    // The first of several that are alike counts.
    let first_of = |order: &dyn Fn(&LimitAssessment, &LimitAssessment) -> std::cmp::Ordering| {
        let numbered = of_drops.iter().enumerate().rev();
        numbered.max_by(|(_, a), (_, b)| order(a, b)).map_or(0, |(n, _)| n)
    };
    let top = first_of(&|a, b| asked(a).total_cmp(&asked(b)));
    let governs = first_of(&|a, b| a.verdict.cmp(&b.verdict).then(asked(a).total_cmp(&asked(b))));
    let widest = first_of(&|a, b| most(a).total_cmp(&most(b)));
    let most_of_all = most(&of_drops[widest]);
    let governor = of_drops[governs].clone();
    let mut limit = of_drops[top].clone();
    if of_drops.len() > 1 {
        (limit.bound, limit.other_law) = (bound, other_law.map(|share| share * limit.allowed));
        if let Some(demand) = limit.demand {
            limit.uncertainty = (most_of_all / share(&limit, demand) - 1.0).max(0.0);
        }
        if governor.verdict == limit.verdict {
            for doubt in &mut limit.undecided {
                if let Doubt::Others { most, .. } = doubt {
                    *most = most_of_all;
                }
            }
        } else {
            (limit.verdict, limit.undecided) = (governor.verdict, governor.undecided);
            limit.governs = names.get(governs).copied();
        }
        let open = &of_drops[widest].undecided;
        if most_of_all.is_infinite() && widest != governs && !open.is_empty() {
            limit.notes.push(Note::OpenIn(names.get(widest).copied(), open.clone()));
        }
        let told = asked(&limit);
        let above = of_drops.iter().map(asked).find(|found| *found > told);
        if let Some(found) = above {
            limit.contradicted(Contradiction::AboveWorst { found, told });
        }
    }
    if let Some(worst) = &mut limit.worst_case {
        (worst.listed, worst.landing) = (top, names.get(top).copied());
    }
    limit
}

/// Returns the limits of a component, each to be searched.
fn limits_of(component: &Component) -> impl Iterator<Item = Task<'_>> {
    Limit::of(component).into_iter().map(move |limit| Task { component, limit })
}

/// The result of the search by one contact law for a limit.
struct Judged {
    /// The drop with the largest demand.
    asked: Option<Candidate>,
    verdict: Verdict,
    /// The reasons why it is not safe though nothing exceeds it.
    doubts: Vec<Doubt>,
    notes: Vec<Note>,
    /// The utilization that other drops of the ranges may reach.
    most: f64,
    /// The bound by energy.
    bound: Option<f64>,
    /// The demand of the worst drop if it landed flat.
    flat: Option<f64>,
}

impl Judged {
    fn new(bound: Option<f64>) -> Self {
        let (doubts, notes) = (Vec::new(), Vec::new());
        Self { asked: None, verdict: Verdict::Undecided, doubts, notes, most: f64::INFINITY, bound, flat: None }
    }
    /// No drop was answered: a bound alone makes nothing safe.
    fn unanswered(worst: &Worst, bound: Option<f64>) -> Self {
        let why = match worst.refused.clone() {
            _ if worst.stopped => Error::Stopped,
            Some((_, error)) => error,
            None => Error::Unfinished,
        };
        Self { doubts: vec![Doubt::Unanswered(why)], ..Self::new(bound) }
    }
}

/// Returns what the worst drop by the law that the file names asks for by the other one; none where contacts take no time or differ.
fn by_other_law(ranges: &Ranges<'_>, task: &Task<'_>, worst: &Candidate) -> Option<f64> {
    if ranges.model != Model::Compliant || !ranges.product.own_contacts.is_none() {
        return None;
    }
    let drop = Drop { contact_law: ranges.law.other(), ..ranges.single(&worst.place) };
    let (part, limit) = (worst.part_there(task.component), in_unit(&task.limit, worst.answer.unit));
    answer(&drop, &part, &limit, ranges.model, ranges.tolerance).ok().map(|answer| answer.value)
}

/// Returns the demand of the worst drop by another law, in the unit of the demand.
fn in_unit_of(own: &Candidate, other: &Candidate) -> f64 {
    if own.answer.unit == other.answer.unit {
        other.answer.value
    } else {
        // A damage boundary counts by its share: one law leaves more room by the velocity change, the other by the acceleration.
        other.answer.utilization() * own.answer.allowed
    }
}

/// Returns the limit whose demand has this unit: of a damage boundary the velocity change or the acceleration.
pub(crate) fn in_unit(limit: &Limit, unit: Unit) -> Limit {
    match limit.kind.source() {
        Source::Boundary if unit != limit.kind.unit() => {
            Limit::new(LimitKind::Acceleration, limit.critical_acceleration_m_s2)
        }
        Source::Boundary => Limit::new(LimitKind::VelocityChange, limit.allowed),
        Source::Response(_) | Source::Shock | Source::Turn => *limit,
    }
}

fn accuracy_reason(ranges: &Ranges<'_>, drop: &Drop) -> Reason {
    match (ranges.model, Model::fullest(drop)) {
        (Model::Compliant, _) => Reason::ContactTime,
        (model, fullest) if model < fullest => Reason::ByRequest(model),
        _ => Reason::NoContactTime,
    }
}

/// Returns the model with the most physics for a task in one of the drops.
pub(crate) fn model_of(file: &ProductFile, listed: usize, task: &Task<'_>) -> ModelChoice {
    let one = file.listed()[listed];
    let ranges = ranges_of(file, &one.drop, one.base, &Accuracy::default());
    model(&ranges, task, accuracy_reason(&ranges, &ranges.single(&ranges.middle(task.component))))
}

fn model(ranges: &Ranges<'_>, task: &Task<'_>, reason: Reason) -> ModelChoice {
    let contacts = ranges.model == Model::Compliant;
    let component = match (task.limit.is_response(), task.component.mount) {
        (false, _) => "largest-shock",
        (true, Mount::Hard) => "base",
        (true, _) if contacts => "pulse-train",
        (true, _) => "impulse-train",
    };
    ModelChoice { bar: ranges.model, component, reason }
}

fn worst_case(asked: &Candidate, ranges: &Ranges<'_>, component: &Component) -> WorstCase {
    WorstCase {
        drop: ranges.single(&asked.place),
        part: asked.part_there(component),
        drawn: false,
        gyration_varies: !ranges.product.gyration_m.is_value(),
        landing: None,
        listed: 0,
        impact: asked.answer.impact,
        time_s: asked.answer.time_s,
        model: ranges.model,
        tolerance: ranges.tolerance,
    }
}

/// Tells of a part that exceeds its rattle space how fast it reaches its stop, and what stops would make of that.
fn tell_stop(limit: &mut LimitAssessment, component: &Component, searched: &[Vec<Ranges<'_>>]) {
    let exceeded = limit.limit == LimitKind::RattleSpace && limit.demand.is_some_and(|demand| demand > limit.allowed);
    let of_worst = |worst: &WorstCase| {
        let ranges = &searched[worst.listed][0];
        ranges.at_stop(component, limit.allowed, ranges.place_of(component, worst))
    };
    limit.at_stop = limit.worst_case.as_ref().filter(|_| exceeded).and_then(of_worst);
    limit.notes.extend(limit.at_stop.map(Note::AtStop));
}

/// Margins beyond ten times what is asked say nothing.
const TOLD_MARGIN: f64 = 10.0;

/// A part that exceeds its rattle space hits its stop, whatever the linear suspension says of its acceleration where the file has none. Where none of the drops that
/// were found reaches it, one of them that exceeds another limit does so all the same.
pub(crate) fn stopped(component: &Component, limits: &mut [&mut LimitAssessment]) {
    if component.stops.is_some() {
        return;
    }
    let stop = limits.iter().find(|l| l.limit == LimitKind::RattleSpace && l.verdict > Verdict::Reliable);
    let Some((verdict, margin)) = stop.map(|l| (l.verdict, l.margin)) else { return };
    // By either law, where the file names none.
    let within = |limit: &&mut LimitAssessment| {
        let mut demands = limit.demand.into_iter().chain(limit.other_law);
        limit.demand.is_some() && demands.all(|demand| demand * (1.0 + COVERAGE) < limit.allowed)
    };
    let none_reaches = limits.iter().filter(|l| l.limit == LimitKind::RattleSpace).all(within);
    let may_change =
        |l: &LimitAssessment| l.limit.is_changed_by_stop() && !(none_reaches && l.verdict == Verdict::Unsafe);
    for limit in limits.iter_mut().filter(|l| may_change(l)) {
        let margin = margin.filter(|margin| margin.abs() < TOLD_MARGIN);
        (limit.verdict, limit.reliability) = (Verdict::Undecided, None);
        limit.undecided = vec![Doubt::Stop { hits: verdict == Verdict::Unsafe, margin }];
    }
}

/// Returns the result of a component from those of its limits.
pub(crate) fn verdict(
    file: &ProductFile,
    component: &Component,
    mut limits: Vec<LimitAssessment>,
) -> ComponentAssessment {
    let is_plate = file.product.body.is_wide();
    decide(&mut limits, file.product.contact_law.is_none() && file.product.contact_time_s.is_some());
    let tightest = limits.iter().min_by(|a, b| a.room().total_cmp(&b.room()));
    let Some(tightest) = tightest else { unreachable!("a component has a limit") };
    let (worst_case, model) = (tightest.worst_case, tightest.model.clone());
    let verdict = Verdict::of(limits.iter().map(|l| l.verdict));
    ComponentAssessment {
        name: component.name.clone(),
        position_m: Sides::new([component.position_m, component.across_m].map(|place| place.at(0.5)), is_plate),
        verdict,
        reliability: limits.iter().filter(|_| verdict == Verdict::Reliable).find_map(|l| l.reliability),
        limits,
        worst_case,
        model,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A drop that went unanswered counts before one that leaves little room, and an unsafe one before both.
    #[test]
    fn the_governing_drop_is_the_one_of_the_worst_verdict() {
        let file = ProductFile::read(clatter_product::EXAMPLE, "example.toml").unwrap();
        let limit = assess(&file).unwrap().components[0].limits[0].clone();
        let of = |verdict, share: Option<f64>| LimitAssessment {
            demand: share.map(|share| share * limit.allowed),
            margin: share.map(|share| 1.0 / share - 1.0),
            bound: Some(3.0 * limit.allowed),
            verdict,
            ..limit.clone()
        };
        let (tight, open, over) =
            (of(Verdict::Safe, Some(0.95)), of(Verdict::Undecided, None), of(Verdict::Unsafe, Some(1.2)));
        let (loose, worse) = (of(Verdict::Safe, Some(0.6)), of(Verdict::Unsafe, Some(1.7)));
        let names: Vec<DropName> = (1..=5).map(DropName::Number).collect();
        let told = |drops: &[&LimitAssessment]| {
            let drops: Vec<LimitAssessment> = drops.iter().map(|drop| (*drop).clone()).collect();
            let limit = governing(&drops, &names);
            (limit.demand.map(|demand| (1e9 * demand / limit.allowed).round() / 1e9), limit.verdict, limit.governs)
        };
        assert_eq!(told(&[&loose, &tight]), (Some(0.95), Verdict::Safe, None));
        assert_eq!(told(&[&worse, &open, &over, &loose, &tight]), (Some(1.7), Verdict::Unsafe, None));
        // The demand is the largest of those that were answered; the drop that is open decides.
        assert_eq!(told(&[&loose, &open, &tight]), (Some(0.95), Verdict::Undecided, Some(names[1])));
        let doubtful = of(Verdict::Undecided, Some(0.7));
        assert_eq!(told(&[&tight, &loose, &doubtful]), (Some(0.95), Verdict::Undecided, Some(names[2])));
        assert_eq!(told(&[&open, &open]), (None, Verdict::Undecided, None));
    }

    /// An assessment that says more of a drop than its energy allows is an error of the program: it has no bound, and is not safe.
    #[test]
    fn a_demand_above_its_bound_is_told_as_an_error() {
        let file = ProductFile::read(clatter_product::EXAMPLE, "example.toml").unwrap();
        let mut limit = assess(&file).unwrap().components[0].limits[0].clone();
        assert_eq!(limit.verdict, Verdict::Safe);
        limit.bound = limit.demand.map(|demand| demand / 1.005);
        let mut near = limit.clone();
        near.hold_to_bound(0.01);
        assert_eq!(near, limit, "within what the answer may be off by");
        limit.bound = limit.demand.map(|demand| demand / 1.02);
        let mut over = limit.clone();
        over.hold_to_bound(0.01);
        assert_eq!((over.verdict, over.bound), (Verdict::Undecided, None));
        assert!(over.why_undecided().unwrap().contains("please report it"), "{over:?}");
        let mut fails = LimitAssessment { verdict: Verdict::Unsafe, ..limit };
        fails.hold_to_bound(0.01);
        assert_eq!((fails.verdict, fails.bound), (Verdict::Unsafe, None));
        assert!(fails.notes.iter().any(|note| note.to_string().contains("please report it")), "{:?}", fails.notes);
    }

    /// A damage boundary that one drop uses up by its velocity change and another by its acceleration has no bound in one unit; what others
    /// may add is reported by shares: 0.5 of 8 m/s within 60 %, next to 0.4 of 5000 m/s² within 150 %, is all of it, twice what is shown.
    #[test]
    fn drops_in_two_units_are_told_by_shares() {
        let file = ProductFile::read(clatter_product::EXAMPLE, "example.toml").unwrap();
        let limit = assess(&file).unwrap().components[2].limits[0].clone();
        let of = |unit, allowed: f64, share: f64, uncertainty| LimitAssessment {
            unit,
            allowed,
            demand: Some(share * allowed),
            margin: Some(1.0 / share - 1.0),
            uncertainty,
            bound: (unit == Unit::MeterPerSecond).then_some(7.0),
            other_law: Some(0.6 * allowed),
            verdict: Verdict::Safe,
            ..limit.clone()
        };
        let changes = of(Unit::MeterPerSecond, 8.0, 0.5, 0.6);
        let peaks = of(Unit::MeterPerSecondSquared, 5000.0, 0.4, 1.5);
        for drops in [vec![changes.clone(), peaks.clone()], vec![peaks, changes]] {
            let all = governing(&drops, &[]);
            assert_eq!((all.unit, all.demand, all.bound), (Unit::MeterPerSecond, Some(4.0), None));
            assert!((all.uncertainty - 1.0).abs() < 1e-12 && (all.other_law.unwrap() - 4.8).abs() < 1e-12, "{all:?}");
        }
    }

    /// One law uses up a damage boundary by its velocity change, the other by its acceleration: they are reported next to one another by
    /// the shares that they use up.
    #[test]
    fn what_the_other_law_asks_is_told_in_the_unit_of_the_demand() {
        let file = ProductFile::read(clatter_product::EXAMPLE, "example.toml").unwrap();
        let place = ranges(&file, &Accuracy::default()).middle(&file.components[0]);
        let of = |value, allowed, unit| {
            let answer = crate::engine::Answer { value, allowed, unit, time_s: 0.0, impact: 1, off_by: 0.0 };
            Candidate { place, part: None, answer, late: false }
        };
        let own = of(3.0, 4.0, Unit::MeterPerSecond);
        // Two fifths of 4 m/s.
        assert!(
            (in_unit_of(&own, &of(2000.0, 5000.0, Unit::MeterPerSecondSquared)) - 1.6).abs() < 1e-12,
            "by its share"
        );
        assert!((in_unit_of(&own, &of(2.0, 4.0, Unit::MeterPerSecond)) - 2.0).abs() < 1e-12, "as it is");
    }
}
