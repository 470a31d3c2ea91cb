//! Products that are drawn one after the other, until enough of them have held or one has not.

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use super::full::{FINER, FollowedDrops, TOLERANCE};
use super::sample::{Inputs, PartSample, Sample};
use crate::assess::laws;
use crate::engine::{Answer, Part, answer};
use crate::search::{Landings, Task, Watch};
use crate::{Accuracy, Verdict};
use clatter_flight::Drop;
use clatter_product::{Error, Model, Product, ProductFile};

/// Products that are drawn side by side: the draw ends after a wave, so that it is of the same products on any number of threads.
const WAVE: u64 = 32;

/// A drop of a product that was drawn, which can be answered again.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shown {
    /// The number of the drop among those that the product goes through.
    pub(crate) listed: usize,
    pub(crate) drop: Drop,
    pub(crate) part: Part,
    pub(crate) answer: Answer,
    pub(crate) model: Model,
    pub(crate) tolerance: f64,
}

/// A limit for which products are drawn, and what they say of it.
#[derive(Debug)]
pub(crate) struct DrawnLimit<'a> {
    pub(crate) task: Task<'a>,
    /// The numbers of the component in the file, and of the limit among its own.
    pub(crate) component: usize,
    pub(crate) number: usize,
    /// By each contact law, the law of the product first.
    pub(crate) by_law: Vec<ByLaw>,
    /// The products that were drawn for it.
    pub(crate) drawn: u64,
    /// Those of them of which nobody knows whether they hold, and the reason why the first has no answer.
    pub(crate) open: u64,
    pub(crate) error: Option<Error>,
}

/// What is known of a limit by one contact law.
#[derive(Debug, Clone)]
pub(crate) struct ByLaw {
    /// True where a drop is known that exceeds it.
    pub(crate) exceeded: bool,
    /// The largest demand that is known, as a share.
    pub(crate) share: f64,
    /// The drawn drop with a larger one.
    pub(crate) shown: Option<Shown>,
    /// The largest demand of products that hold, with its sample and its drop.
    most: Option<(f64, u64, usize)>,
}

impl ByLaw {
    pub(crate) fn known(share: f64) -> Self {
        Self { exceeded: share > 1.0, share, shown: None, most: None }
    }
}

impl DrawnLimit<'_> {
    /// Returns the verdict by the products that were drawn, of which so many are needed.
    pub(crate) fn verdict(&self, needed: u64) -> Verdict {
        let exceeded = self.by_law.iter().filter(|law| law.exceeded).count();
        match exceeded {
            0 if self.open == 0 && self.drawn == needed => Verdict::Reliable,
            n if n == self.by_law.len() => Verdict::Unsafe,
            _ => Verdict::Undecided,
        }
    }
    /// Returns whether more products say no more: all laws exceed it, or not one product is decided.
    fn is_over(&self) -> bool {
        self.by_law.iter().all(|law| law.exceeded) || self.open == self.drawn
    }
}

/// What one product says of a limit by one law.
enum Outcome {
    /// It holds, with this share in its worst drop.
    Holds(f64, usize),
    Exceeds(Box<Shown>),
    Open(Option<Error>),
}

/// The product by one contact law.
struct OfLaw {
    inputs: Inputs,
    later: Option<Landings>,
}

/// Draws products as their file spreads them, each through all of its drops, until `needed` of them hold for each limit or one exceeds it by
/// every contact law, and tells what they say. A drop that exceeds a limit is answered again to `accuracy`.
///
/// # Errors
/// Those of a product that cannot be drawn.
pub(crate) fn draw(
    file: &ProductFile,
    accuracy: &Accuracy,
    (seed, needed): (u64, u64),
    limits: &mut [DrawnLimit<'_>],
    watch: Watch<'_>,
) -> Result<(), Error> {
    let laws = laws(file, if file.product.contact_time_s.is_some() { Model::Compliant } else { Model::FiniteTilt });
    let of_law = |law| -> Result<OfLaw, Error> {
        // A law that stands alone is the file's own.
        let contact_law = if laws.len() > 1 { Some(law) } else { file.product.contact_law };
        let product = Product { contact_law, ..file.product.clone() };
        let file = ProductFile { product, ..file.clone() };
        Ok(OfLaw { inputs: Inputs::new(&file, accuracy.merge_s)?, later: Landings::of(&file) })
    };
    let of_laws = laws.iter().map(|law| of_law(*law)).collect::<Result<Vec<_>, _>>()?;
    let (done, mut next, mut stopped) = (AtomicU64::new(0), 0, false);
    #[expect(clippy::cast_possible_truncation, reason = "about a million at most")]
    let goes_on = || watch(done.load(Ordering::Relaxed).min(needed) as usize, needed as usize);
    while next < needed && !stopped {
        let active: Vec<usize> = (0..limits.len()).filter(|i| next == 0 || !limits[*i].is_over()).collect();
        if active.is_empty() {
            break;
        }
        let until = needed.min(next + WAVE);
        let known = &*limits;
        let of_sample = |k: u64| {
            let each = |(n, of_law): (usize, &OfLaw)| {
                let asked: Vec<usize> = active.iter().copied().filter(|i| !known[*i].by_law[n].exceeded).collect();
                let said = of_law.sample((seed, k), accuracy.tolerance, asked.iter().map(|i| &known[*i]));
                asked.into_iter().zip(said).collect()
            };
            let said = goes_on().then(|| of_laws.iter().enumerate().map(each).collect());
            done.fetch_add(1, Ordering::Relaxed);
            said
        };
        let wave: Vec<Option<Said>> = (next..until).into_par_iter().map(of_sample).collect();
        // Those after the first that was not drawn are left out, as on one thread.
        for (k, said) in (next..until).zip(wave.into_iter().map_while(|said| said)) {
            next = k + 1;
            take(limits, &active, k, said);
        }
        stopped = next < until;
    }
    // The demand is the largest of all drops that were answered.
    for limit in limits {
        for (n, of_law) in of_laws.iter().enumerate() {
            let ByLaw { exceeded, share, most, .. } = limit.by_law[n];
            let Some((_, k, listed)) = most.filter(|(most, ..)| !exceeded && *most > share) else { continue };
            let shown = of_law.again((seed, k), listed, accuracy.tolerance, limit, share);
            limit.by_law[n].shown = shown.filter(|shown| shown.answer.utilization() <= 1.0);
        }
    }
    Ok(())
}

/// What a product says by each law of the limits of these numbers.
type Said = Vec<Vec<(usize, Outcome)>>;

/// Takes in what product k says.
fn take(limits: &mut [DrawnLimit<'_>], active: &[usize], k: u64, said: Said) {
    let mut open = vec![false; limits.len()];
    for (n, outcomes) in said.into_iter().enumerate() {
        for (i, outcome) in outcomes {
            let of_law = &mut limits[i].by_law[n];
            match outcome {
                Outcome::Exceeds(shown) => (of_law.exceeded, of_law.shown) = (true, of_law.shown.or(Some(*shown))),
                Outcome::Holds(share, listed) if of_law.most.is_none_or(|(most, ..)| share > most) => {
                    of_law.most = Some((share, k, listed));
                }
                Outcome::Holds(..) => {}
                Outcome::Open(error) => {
                    open[i] = true;
                    limits[i].error = limits[i].error.take().or(error);
                }
            }
        }
    }
    for i in active {
        limits[*i].drawn += 1;
        limits[*i].open += u64::from(open[*i]);
    }
}

impl OfLaw {
    /// Draws a product, and returns what it says of each of these limits.
    fn sample<'a>(
        &self,
        (seed, k): (u64, u64),
        tolerance: f64,
        limits: impl Iterator<Item = &'a DrawnLimit<'a>> + Clone,
    ) -> Vec<Outcome> {
        let mut sample = self.inputs.blank();
        if let Err(error) = self.inputs.draw(seed, k, &mut sample) {
            return limits.map(|_| Outcome::Open(Some(error.clone()))).collect();
        }
        let mut all: Vec<Outcome> = limits.clone().map(|_| Outcome::Holds(0.0, 0)).collect();
        for listed in 0..sample.drops.len() {
            let mut followed = self.followed(&sample, listed);
            for (limit, outcome) in limits.clone().zip(&mut all) {
                if matches!(outcome, Outcome::Exceeds(_)) {
                    continue;
                }
                let part = sample.parts[limit.component].with_one_limit(limit.number);
                let open = match followed.closed(&part) {
                    Ok(asked) if asked.utilization > 1.0 => {
                        match shown(&followed, listed, &part, &limit.task, tolerance, 1.0) {
                            Some(shown) => {
                                *outcome = Outcome::Exceeds(Box::new(shown));
                                continue;
                            }
                            None => None,
                        }
                    }
                    Ok(asked) if asked.is_open() => None,
                    Ok(asked) => {
                        // As a share of what the product with the lowest limit allows.
                        let share = asked.utilization * part.limits[0].allowed / limit.task.limit.allowed;
                        if matches!(outcome, Outcome::Holds(most, _) if share > *most) {
                            *outcome = Outcome::Holds(share, listed);
                        }
                        continue;
                    }
                    Err(error) => Some(error),
                };
                if matches!(outcome, Outcome::Holds(..)) {
                    *outcome = Outcome::Open(open);
                }
            }
        }
        all
    }

    fn followed<'a>(&'a self, sample: &'a Sample, listed: usize) -> FollowedDrops<'a> {
        FollowedDrops::of(&sample.drops[listed], &sample.parts).landing_again(self.later.as_ref())
    }

    /// Answers a drop of a product once more, if it asks for more than a share.
    fn again(
        &self,
        (seed, k): (u64, u64),
        listed: usize,
        tolerance: f64,
        limit: &DrawnLimit<'_>,
        above: f64,
    ) -> Option<Shown> {
        let mut sample = self.inputs.blank();
        self.inputs.draw(seed, k, &mut sample).ok()?;
        let mut part = sample.parts[limit.component].with_one_limit(limit.number);
        part.limits = vec![limit.task.limit];
        shown(&self.followed(&sample, listed), listed, &part, &limit.task, tolerance, above)
    }
}

/// Returns the drop answered as any other is, to the tolerance or more exactly, where it asks a part for more than a share of its limit.
fn shown(
    followed: &FollowedDrops<'_>,
    listed: usize,
    part: &PartSample,
    task: &Task<'_>,
    tolerance: f64,
    above: f64,
) -> Option<Shown> {
    for tolerance in [tolerance, TOLERANCE].into_iter().chain(FINER) {
        for drop in followed.drops() {
            let model = Model::fullest(drop);
            let of = |place| {
                let part_there = Part::at(place, part.suspension.filter(|_| task.limit.is_response()));
                let asked = |limit| answer(drop, &part_there, limit, model, tolerance).ok();
                asked(&part.limits[0]).filter(|answer| answer.utilization() > above)?;
                let answer = asked(&task.limit)?;
                Some(Shown { listed, drop: *drop, part: part_there, answer, model, tolerance })
            };
            let all = part.spots().into_iter().filter_map(of);
            let most = all.max_by(|a, b| a.answer.utilization().total_cmp(&b.answer.utilization()));
            if most.is_some() {
                return most;
            }
        }
    }
    None
}
