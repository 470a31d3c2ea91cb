//! The worst drop over the stated ranges.
//!
//! Drops all over the ranges are followed, each by the one engine: tilts are so close that the stiffest part turns by less than
//! a radian between the first two strikes, with the ends of the ranges of speed, restitution and contact time and some between, and in each
//! the parts at both ends of where they may be, at the end of the range of natural frequencies with the largest demand as a rule and at
//! others, from drop to drop at others still. Where the order in which ends touch and part changes between two tilts, the demand on stiff
//! parts jumps: drops on both sides of it are followed too. From the highest of all the search climbs in all ranges at once.
//!
//! Drops are first followed until the body comes down after its clatter. Where the energy left then may bring a part above the
//! worst found, they are followed for longer, and so are drops of a sequence that spreads evenly over all ranges.

mod at_stop;
mod budgets;
mod climb;
mod edges;
mod found;
mod grid;
mod landings;
mod ranges;
mod settle;

use std::f64::consts::{FRAC_PI_2, TAU};
use std::sync::atomic::{AtomicUsize, Ordering};

use clatter_shock::{DampingRatio, Suspension};
use rayon::prelude::*;

use crate::engine::{Part, PlaceHistory, once};
use crate::model::follow;
use budgets::{
    CLIMB, CLIMBS, FREQUENCIES, FREQUENCIES_LATE, IN_A_TURN, LATER_DECIDES, NEAR, REBOUNDS, SAMPLE, SAMPLE_OF_BOX,
};
use clatter_flight::{Drop, Followed, Place, Until};
use clatter_product::{Component, Error, Limit, Model, Mount, Source, Stops};
use climb::starts;
use edges::Order;
pub(crate) use found::{Candidate, Worst};
use found::{Candidates, Later, OfDrop, image};
use grid::halton;
pub(crate) use landings::{Landings, LaterLandings, with_gravity};
pub(crate) use ranges::{Coordinates, Ranges};
pub(crate) use ranges::{DAMPING, FREQUENCY, STOPS};

/// A callback that receives how much of how much is done, from any thread, and returns whether to go on.
pub type Watch<'a> = &'a (dyn Fn(usize, usize) -> bool + Sync);

/// The work of a search, counted in drops.
struct Work<'a> {
    watch: Watch<'a>,
    done: AtomicUsize,
    all: usize,
}

impl Work<'_> {
    /// So many drops more are to be followed.
    ///
    /// # Errors
    /// [`Error::Stopped`] where they are not wanted any more.
    fn go_on(&self, drops: usize) -> Result<(), Error> {
        if !(self.watch)(self.done.load(Ordering::Relaxed).min(self.all), self.all) {
            return Err(Error::Stopped);
        }
        self.done.fetch_add(drops, Ordering::Relaxed);
        Ok(())
    }
}

/// One limit of one component.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Task<'a> {
    pub(crate) component: &'a Component,
    pub(crate) limit: Limit,
}

impl Task<'_> {
    /// Returns whether the worst place of an extended part may lie between its ends.
    pub(crate) fn is_largest_between(&self) -> bool {
        self.limit.kind.is_largest_between() || self.hits_stops()
    }
    /// Returns whether the limit is on the response of a part with stops.
    pub(crate) fn hits_stops(&self) -> bool {
        self.component.stops.is_some() && self.limit.is_response()
    }
    /// Returns a place of the part.
    fn place(&self, at_m: [f64; 2]) -> Place {
        self.component.inside.place(at_m)
    }
}

/// The golden ratio: multiples of it spread evenly from 0 to 1.
const GOLDEN: f64 = 0.618_033_988_749_895;
/// Drops that are followed side by side, knowing the worst of those before.
const WAVE: usize = 64;

impl Ranges<'_> {
    /// Finds the worst of each task; tasks of one component follow one another. They are searched in the drops in which `all_tasks` are,
    /// so that some of them alone have the same worst drops. Where only drops that demand no more than `most` of any limit are of
    /// use, the search is left as soon as one is answered that demands more: that one.
    pub(crate) fn worst(
        &self,
        tasks: &[Task<'_>],
        all_tasks: &[Task<'_>],
        landings: &LaterLandings,
        most: f64,
        watch: Watch<'_>,
    ) -> Result<Vec<Worst>, Box<Coordinates>> {
        // A box is followed to its rest in some drops only: it is slow.
        let of_all = self.base.is_none();
        let [steps, turn_steps] = self.steps(all_tasks);
        let mut all = Candidates::none(tasks.len());
        let grid: Vec<(u32, Coordinates)> = (0..).zip(self.grid(steps, turn_steps)).collect();
        let shocks: Vec<bool> = tasks.iter().map(|task| !task.limit.is_response()).collect();
        let overlaps = if shocks.contains(&true) { self.overlaps() } else { Vec::new() };
        let climbing = CLIMB * CLIMBS * tasks.len();
        let sample = self.sample();
        let count = grid.len() + overlaps.len() + sample + climbing;
        let work = Work { watch, done: AtomicUsize::new(0), all: count };
        // A drop that comes near the worst so far is looked at more closely: the worst of the waves before, so that the same drops are on
        // any number of threads.
        let ask = |all: &mut Candidates, drops: &[(u32, Coordinates)], only: Option<&[bool]>, to_rest: bool| {
            let mut orders = Vec::with_capacity(drops.len());
            for wave in drops.chunks(WAVE) {
                let best = all.best();
                let of_one = |drop: &(u32, Coordinates)| {
                    let early = work.go_on(1).and_then(|()| self.follow(&drop.1, Until::Lands));
                    let order = early.as_ref().ok().map(Order::of);
                    let asked = early.and_then(|early| self.ask(tasks, drop, &early, best.clone(), only, to_rest));
                    (order, (drop.1, asked))
                };
                let (of_wave, asked): (Vec<_>, Vec<_>) = wave.par_iter().map(of_one).unzip();
                orders.extend(of_wave);
                all.take(asked);
                self.passes(tasks, all, &best, most).map_or(Ok(()), Err)?;
            }
            Ok::<_, Box<Coordinates>>(orders)
        };
        let orders = ask(&mut all, &grid, None, of_all)?;
        ask(&mut all, &overlaps, Some(&shocks), of_all)?;
        let edged: Vec<bool> = tasks.iter().map(|task| self.has_edges(task)).collect();
        if edged.contains(&true) {
            ask(&mut all, &self.edges(&grid, &orders, &work), Some(&edged), of_all)?;
        }
        let spread: Vec<(u32, Coordinates)> = (1..).take(sample).map(|k| (k, self.spread_out(k))).collect();
        if self.base.is_some() {
            ask(&mut all, &spread, None, false)?;
        }
        // The demand of rebounds is sensitive to every input: where later landings may ask for more, drops all over the ranges are
        // followed for longer as well, a box only where that may decide.
        let least = if self.base.is_some() { LATER_DECIDES } else { 0.0 };
        let only: Vec<bool> =
            self.land_again(&all, landings, tasks, &work).into_iter().map(|most| most > least).collect();
        if only.contains(&true) {
            let longer = if self.base.is_some() { &spread[..spread.len() / 2] } else { &spread };
            ask(&mut all, longer, Some(&only), true)?;
            // A product that stands and hardly ever falls over has the largest demand where it does.
            let stands = all.leaning.filter(|(lean, _)| self.faces() == 1 && *lean < 1.0);
            if let Some(fallen) = stands.and_then(|(lean, place)| self.fallen_over(&tasks[0], place, lean, &work)) {
                ask(&mut all, &[(1, fallen)], Some(&only), true)?;
            }
        }
        let later = self.land_again(&all, landings, tasks, &work);
        if work.go_on(0).is_ok() {
            work.done.fetch_max(count - climbing, Ordering::Relaxed);
        }
        let Candidates { mut found, refused, drops, swings, .. } = all;
        let most_starts = [usize::MAX, 2, 2, 1][self.faces()];
        let climbs: Vec<(usize, Candidate)> = found
            .iter_mut()
            .enumerate()
            .flat_map(|(n, found)| {
                let all = starts(found);
                // A box that tumbles is followed for long: only where that has the largest demand.
                let tumbles = all.first().copied().filter(|start| !of_all && start.late);
                let such = all.into_iter().filter(move |start| of_all || !start.late).take(most_starts);
                tumbles.into_iter().chain(such).map(move |start| (n, start))
            })
            .collect();
        let each_climb = climbing / climbs.len().max(1);
        let climb = |(n, start): (usize, Candidate)| {
            let goes_on = work.go_on(each_climb).is_ok();
            (n, if goes_on { self.climb_from(&tasks[n], start, 0.5 / steps, &work) } else { start })
        };
        let climbed: Vec<(usize, Candidate)> = climbs.into_par_iter().map(climb).collect();
        let each = (0..tasks.len()).into_par_iter().map(|n| {
            let mut reached: Vec<Candidate> =
                climbed.iter().filter(|(of, _)| *of == n).map(|(_, asked)| *asked).collect();
            reached.extend_from_slice(&found[n]);
            let in_time = work.go_on(0).is_ok();
            let near = if self.product.body.is_wide() { starts(&mut reached) } else { Vec::new() };
            let mut worst =
                if in_time { self.settle(&tasks[n], reached) } else { self.settle_at_once(&tasks[n], reached) };
            (worst.drops, worst.later, worst.near, worst.swing) = (drops, later[n], near, swings[n]);
            if let Some((count, error)) = &refused {
                worst.refuse(*count, error);
            }
            worst
        });
        let mut all: Vec<Worst> = each.collect();
        // Last, so that no task counts as searched whose worst case was not settled as it should be.
        let stopped = work.go_on(0).is_err();
        for worst in &mut all {
            worst.stopped = stopped;
        }
        Ok(all)
    }

    /// Returns how many drops are followed besides those of the grid where rebounds count.
    fn sample(&self) -> usize {
        let [of_all_drops, of_each] = SAMPLE_OF_BOX;
        match self.base {
            Some(_) => (of_all_drops / self.listed).max(of_each),
            None => SAMPLE[self.by_impacts()],
        }
    }

    /// Returns 1 for instant impacts, 0 for contacts that take time.
    fn by_impacts(&self) -> usize {
        usize::from(self.model != Model::Compliant)
    }

    /// Finds a drop of the last wave that demands more than `most` of a limit, answered to the tolerance; `best` are those before it.
    fn passes(&self, tasks: &[Task<'_>], all: &Candidates, best: &[f64], most: f64) -> Option<Box<Coordinates>> {
        let of_one = |(n, task): (usize, &Task<'_>)| {
            let highest =
                all.found[n].iter().max_by(|a, b| a.answer.utilization().total_cmp(&b.answer.utilization()))?;
            let rough = highest.answer.utilization();
            let exact = || self.exactly(task, highest).is_ok_and(|exact| exact.answer.utilization() > most);
            (rough > most && rough > best[n] && exact()).then(|| Box::new(highest.place))
        };
        tasks.iter().enumerate().find_map(of_one)
    }

    /// Returns the demand of drop k, which was followed until it lands, for each task, or for those marked in `only`, where that comes near
    /// the worst.
    fn ask(
        &self,
        tasks: &[Task<'_>],
        (k, drop): &(u32, Coordinates),
        early: &Followed,
        mut best: Vec<f64>,
        only: Option<&[bool]>,
        to_rest: bool,
    ) -> Result<OfDrop, Error> {
        let (mut of_drop, is_plate) = (OfDrop::default(), self.product.body.is_wide());
        let (mut rebounded, mut over) = (None, None);
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
                    // A box is followed to its rest later.
                    if later > 0.0 && (self.base.is_none() || !to_rest) {
                        of_drop.energy_m2_s2 = early.energy_m2_s2();
                        let rings = felt.rings(&task.limit, &parts);
                        // Strikes without number are none of one landing.
                        let rings = if early.is_given_up() { later } else { rings };
                        of_drop.later.push((number, Later { most: later, rings }));
                    }
                    if later > 0.0 && to_rest {
                        let rebounded = self.followed(drop, Until::Rebounded, &mut rebounded)?;
                        of_drop.lean = rebounded.lean();
                        let longer = felt.longer(rebounded)?;
                        let above = |asked: Option<Candidate>| asked.map_or(near, |asked| asked.answer.utilization());
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

    fn follow(&self, place: &Coordinates, until: Until) -> Result<Followed, Error> {
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

    /// Returns how many natural frequencies are tried in one drop: some in each turn that the ends of their range differ by.
    fn frequencies(task: &Task<'_>, drop: &Drop) -> u32 {
        let Mount::Suspended { frequency_hz, .. } = task.component.mount else { return 0 };
        let gap_s = 0.25 * drop.clatter_s();
        let [least, most] = FREQUENCIES;
        let turns = (frequency_hz.hi() - frequency_hz.lo()) * gap_s;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 16")]
        let count = (IN_A_TURN * turns).ceil().clamp(least, most) as u32;
        count
    }

    /// Returns the part at a place, where the limit is on its response.
    fn part(task: &Task<'_>, place: &Coordinates) -> Result<Option<Suspension>, Error> {
        let Mount::Suspended { frequency_hz, damping } = task.component.mount else { return Ok(None) };
        if !task.limit.is_response() {
            return Ok(None);
        }
        let [least, most] = damping.ratios();
        let ratio = DampingRatio::new(least + place.shares[DAMPING] * (most - least))?;
        let free = Suspension::from_hz(frequency_hz.at(place.shares[FREQUENCY]), ratio)?;
        let Some(stops) = &task.component.stops else { return Ok(Some(free)) };
        Ok(Some(free.with_stop(stops.at(STOPS.map(|axis| place.shares[axis]))?)))
    }

    /// Returns the part with least damping at both ends of the range of its frequencies, with stops at all ends of theirs.
    fn softest_and_stiffest(task: &Task<'_>, place: &Coordinates) -> Result<Vec<Suspension>, Error> {
        let mut places: Vec<Coordinates> =
            [0.0, 1.0].map(|frequency| place.with(FREQUENCY, frequency).with(DAMPING, 0.0)).to_vec();
        if task.hits_stops() {
            for axis in STOPS {
                places = places.iter().flat_map(|at| [0.0, 1.0].map(|share| at.with(axis, share))).collect();
            }
        }
        places.iter().filter_map(|at| Self::part(task, at).transpose()).collect()
    }

    /// Returns how far a part would swing without its stops in drop k, as a velocity.
    fn swing(task: &Task<'_>, place: &Coordinates, felt: &PlaceHistory<'_>, k: u32) -> Result<f64, Error> {
        let mut most = 0.0_f64;
        for share in [0.0, 1.0, (GOLDEN * f64::from(k)).fract()] {
            let at = place.with(FREQUENCY, share).with(DAMPING, 0.0);
            most = Self::part(task, &at)?.map_or(most, |part| most.max(felt.amplitude(&part.without_stop())));
        }
        Ok(most)
    }

    /// Returns the demand of a part on which this drop acts, where it passes `above`.
    fn in_drop(
        task: &Task<'_>,
        place: &Coordinates,
        felt: &PlaceHistory<'_>,
        above: f64,
    ) -> Result<Option<Candidate>, Error> {
        let part = Self::part(task, place)?;
        let answer = felt.answer(&task.limit, part.as_ref(), above)?;
        Ok(answer.map(|answer| Candidate { place: *place, part, answer, late: false }))
    }

    /// Returns the largest demand of drop k at the end of the range of frequencies where it is largest as a rule, and at `others` in it.
    fn most(
        &self,
        task: &Task<'_>,
        place: &Coordinates,
        felt: &PlaceHistory<'_>,
        k: u32,
        others: u32,
        above: f64,
    ) -> Result<Option<Candidate>, Error> {
        let free = self.free(task);
        let grows = matches!(task.limit.kind.source(), Source::Response(peak) if peak.grows_with_frequency());
        let end = if grows { 1.0 } else { 0.0 };
        let place = &place.at_hardest_stops();
        let stops_vary = STOPS.into_iter().any(|axis| free[axis]);
        let mut worst = Self::in_drop(task, &place.with(FREQUENCY, end), felt, above)?;
        let mut ask = |place: &Coordinates| -> Result<(), Error> {
            let above = worst.map_or(above, |worst| worst.answer.utilization());
            worst = Self::in_drop(task, place, felt, above)?.or(worst);
            Ok(())
        };
        if stops_vary {
            // The other end of each, and of all: far stops that give are reached fast, and let the part go far.
            let others = |at: &Coordinates, axes: &[usize]| {
                axes.iter().fold(*at, |at, far| at.with(*far, 1.0 - at.shares[*far]))
            };
            for far in STOPS.iter().filter(|axis| free[**axis]) {
                ask(&others(place, &[*far]).with(FREQUENCY, end))?;
            }
            ask(&others(place, &STOPS).with(FREQUENCY, end))?;
        }
        for n in 0..if free[FREQUENCY] || stops_vary { others } else { 0 } {
            let number = k * others + n;
            let mut place =
                place.with(FREQUENCY, if free[FREQUENCY] { (GOLDEN * f64::from(number)).fract() } else { end });
            if stops_vary {
                for axis in STOPS {
                    place.shares[axis] = (2.0 * halton(axis, number) - 0.5).clamp(0.0, 1.0);
                }
            }
            ask(&place)?;
        }
        if free[DAMPING] {
            ask(&place.with(FREQUENCY, end).with(DAMPING, 1.0))?;
        }
        Ok(worst)
    }

    /// Returns whether the demand on a part at a place of the ranges is more than `most` of a limit there, answered to the tolerance.
    pub(crate) fn asks_more(&self, task: &Task<'_>, place: &Coordinates, most: f64) -> bool {
        let of = |at_m: [f64; 2]| {
            let place = Coordinates { at_m, ..*place };
            let part = Part::at(task.place(at_m), Self::part(task, &place)?);
            once(&self.single(&place), &part, &task.limit, self.model, self.tolerance)
        };
        task.component.places_m().into_iter().any(|x| of(x).is_ok_and(|answer| answer.utilization() > most))
    }

    /// Returns the demand of one drop of the ranges for a task, as a utilization; 0 where it is not answered.
    pub(crate) fn in_one(&self, task: &Task<'_>, place: &Coordinates) -> f64 {
        let Ok(followed) = self.follow(place, Until::Lands) else { return 0.0 };
        let of = |at_m: [f64; 2]| {
            let felt = PlaceHistory::new(&followed, task.place(at_m)).ok()?;
            Self::in_drop(task, &Coordinates { at_m, ..*place }, &felt, 0.0).ok()?
        };
        let asked = task.component.places_m().into_iter().filter_map(of);
        asked.map(|asked| asked.answer.utilization()).fold(0.0, f64::max)
    }
}

/// Above this damping ratio a part is followed pulse by pulse: its damper passes on the velocity that it has in between, 2ζ of it, which
/// pulses taken together do not show.
const DAMPED: f64 = 0.1;

/// Returns the natural frequency up to which a rough history has to hold for a part.
pub(crate) fn rough_to_rad_s(component: &Component) -> f64 {
    match component.mount {
        Mount::Suspended { damping, .. } if damping.ratios()[1] > DAMPED => f64::INFINITY,
        // A part may reach its stop while it is pushed.
        _ if component.stops.is_some() => f64::INFINITY,
        _ => fastest_rad_s(component),
    }
}

/// Returns the fastest that a part moves by itself; of one that is mounted rigidly no response is needed.
pub(crate) fn fastest_rad_s(component: &Component) -> f64 {
    let Mount::Suspended { frequency_hz, damping } = component.mount else { return 0.0 };
    let [_, most] = damping.ratios();
    let free = TAU * frequency_hz.hi() * if most > 1.0 { most + (most * most - 1.0).sqrt() } else { 1.0 };
    let at_stop = |stops: &Stops| FRAC_PI_2 * (1.0 + stops.restitution.hi()) / stops.contact_time_s.lo();
    libm::hypot(free, component.stops.as_ref().map_or(0.0, at_stop))
}
