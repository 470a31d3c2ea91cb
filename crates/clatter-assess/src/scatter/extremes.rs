//! The worst drops of a product as its body and its restitution vary: what a design plane is drawn from.

use clatter::End;
use clatter_flight::Body;
use clatter_shock::{DampingRatio, Suspension};
use rayon::prelude::*;

use super::full::{self, FollowedDrops, LEAST};
use super::philox::Stream;
use super::sample::{PartSample, Sample};
use super::{SampleDemand, cheap};
use clatter_product::{
    Component, Drop, Error, Input, Limit, MERGE_S, Model, Mount, ProductFile, Spread, Stops, searched,
};

/// The worst at every point of a plane.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Extremes {
    /// The model that answered: [`Model::Map`] is the closed form.
    pub model: Model,
    /// The largest factor, less 1, between both models' utilizations, in some drops all over the points; infinite where one of them
    /// has no answer.
    pub closed_form_error: f64,
    /// For each point the largest utilization of each component, in the order of the file; none where drops without an answer could
    /// change the verdict.
    pub worst: Vec<Vec<Option<f64>>>,
}

/// Tilts by the closed form and by the model with the most physics, which takes more time.
const TILTS: [u32; 2] = [33, 9];
/// Drops that are answered by both models.
const TRIED: u64 = 400;
/// The error up to which the closed form is taken.
const LARGEST_ERROR: f64 = 0.05;

/// Returns the largest utilization of each component over all ranges of a product but that of its restitution, for other bodies and
/// restitutions. Limits are at their least values, as in an assessment.
///
/// Drops: tilts all over their range, 33 by the closed form, else 9; the ends of the ranges of contact time, spin and speed, by the closed
/// form; else the highest speed; either end first. Parts: both ends of where they may be, the ends and the middle of the range of natural
/// frequencies, both ends of that of damping. The closed form is taken where 400 of these drops, of points drawn at random, show
/// errors of at most 5 % in all parts.
///
/// It is a picture and no proof: a worst case lies between drops.
///
/// # Errors
/// Data that product files do not allow, plates and boxes, contacts of their own, a restitution outside 0 to 1.
pub fn extremes(file: &ProductFile, points: &[(Body, f64)]) -> Result<Extremes, Error> {
    file.check()?;
    file.check_bar("the plane of q and e")?;
    file.check_alike("the plane of q and e")?;
    for &(_, e) in points {
        clatter::Restitution::new(e)?;
    }
    let mut parts = Vec::new();
    for component in &file.components {
        parts.push(variants(component)?);
    }
    // For a symmetric body one end first is the other one turned around.
    let symmetric = points.iter().all(|(body, _)| body.arms_m()[0].to_bits() == body.arms_m()[1].to_bits());
    let turns = symmetric && file.drops().iter().all(|drop| drop.first_ends().len() > 1);
    let corners = |tilts, slow| Corners::new(file, &parts, turns, tilts, slow);
    let [many, few] = [corners(TILTS[0], true), corners(TILTS[1], false)];
    let off = |k| {
        let stream = Stream::new(0, k);
        let pick = |input, count: usize| {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                clippy::cast_precision_loss,
                reason = "an index"
            )]
            let index = (stream.at(input) * count as f64) as usize;
            index.min(count - 1)
        };
        let (body, e) = &points[pick(0, points.len())];
        let sample = few.sample(body, *e, pick(1, few.drops.len()));
        let (mut cheap, mut full) = (Vec::new(), Vec::new());
        cheap::answer(&sample, &mut cheap);
        full::answer(&sample.drops[0], &sample.parts, None, &mut full);
        error(&cheap, &full)
    };
    let tried = if points.is_empty() { 0 } else { TRIED };
    let closed_form_error = (0..tried).into_par_iter().map(off).reduce(|| 0.0, f64::max);
    let closed = closed_form_error <= LARGEST_ERROR;
    let worst = points.par_iter().map(|(body, e)| if closed { many.closed(body, *e) } else { few.full(body, *e) });
    let fullest = few.drops.first().map_or(Model::FiniteTilt, Model::fullest);
    Ok(Extremes { model: if closed { Model::Map } else { fullest }, closed_form_error, worst: worst.collect() })
}

/// Returns the largest factor, less 1, between the demands of both models on the parts of a drop; infinite where the fuller one has no
/// answer.
fn error(cheap: &[f64], full: &[Result<SampleDemand, Error>]) -> f64 {
    let of = |(cheap, full): (&f64, &Result<SampleDemand, Error>)| {
        let Ok(full) = full else { return f64::INFINITY };
        let [least, most] = full.within;
        if most <= 0.0 && *cheap <= 0.0 {
            return 0.0;
        }
        let factor = (most / cheap).max(cheap / least);
        if factor.is_nan() { f64::INFINITY } else { factor - 1.0 }
    };
    cheap.iter().zip(full).map(of).fold(0.0, f64::max)
}

/// The drops of the search and the parts in them.
struct Corners {
    drops: Vec<Drop>,
    /// The parts of each component, in one row.
    parts: Vec<PartSample>,
    /// The number of parts of each component.
    counts: Vec<usize>,
}

/// Returns the ends and the middle of a range.
fn three(spread: &Spread) -> Vec<f64> {
    if spread.is_value() { vec![spread.lo()] } else { vec![spread.lo(), spread.at(0.5), spread.hi()] }
}
/// Its ends.
fn two(spread: &Spread) -> Vec<f64> {
    if spread.is_value() { vec![spread.lo()] } else { vec![spread.lo(), spread.hi()] }
}

/// Returns a component at the ends of its ranges.
fn variants(component: &Component) -> Result<Vec<PartSample>, Error> {
    let mut suspensions = vec![None];
    if let Mount::Suspended { frequency_hz, damping } = &component.mount {
        suspensions.clear();
        let [least, most] = damping.ratios();
        for ratio in std::iter::once(least).chain((most > least).then_some(most)) {
            for hz in three(frequency_hz) {
                let free = Suspension::from_hz(hz, DampingRatio::new(ratio)?)?;
                match &component.stops {
                    Some(stops) => {
                        for shares in [Stops::HARDEST, Stops::HARDEST.map(|share| 1.0 - share)] {
                            suspensions.push(Some(free.with_stop(stops.at(shares)?)));
                        }
                    }
                    None => suspensions.push(Some(free)),
                }
            }
        }
    }
    let reaches_m = component.reaches_m();
    let part = |suspension| {
        let limits = Limit::of(component);
        let (at_m, inside) = (reaches_m.map(|[lo, hi]| 0.5 * (lo + hi)), component.inside);
        PartSample { number: 0, skipped: 0, at_m, reaches_m, inside, suspension, limits }
    };
    Ok(suspensions.into_iter().map(part).collect())
}

impl Corners {
    fn new(file: &ProductFile, parts: &[Vec<PartSample>], turns: bool, tilts: u32, slow: bool) -> Self {
        let product = &file.product;
        let turned = |part: &PartSample| {
            let [[lo, hi], across] = part.reaches_m;
            PartSample { reaches_m: [[-hi, -lo], across], ..part.clone() }
        };
        let each = |of_one: &Vec<PartSample>| {
            let mut of_one = of_one.clone();
            if turns {
                of_one.extend(of_one.iter().map(turned).collect::<Vec<_>>());
            }
            of_one
        };
        let of_each: Vec<Vec<PartSample>> = parts.iter().map(each).collect();
        let mut drops = Vec::new();
        for drop in file.drops() {
            let [slowest, fastest] = drop.speeds_m_s();
            let speeds = if slow && slowest < fastest { vec![fastest, slowest] } else { vec![fastest] };
            let steps = if drop.tilt_rad.is_value() { 0 } else { tilts - 1 };
            // At the ends of the ranges of all that lines of drops go through, but for what is given.
            let mut ends = vec![Drop { speed_m_s: fastest, ..product.unset(&drop, None) }];
            for (row, _) in searched().filter(|(_, search)| search.line.is_some()) {
                let (Some(given), Some(set)) = (row.input.given(product, &drop), row.set) else { continue };
                if matches!(row.input, Input::Restitution | Input::Gyration) {
                    continue;
                }
                let with = |one: &Drop| {
                    let one = *one;
                    two(&given).into_iter().map(move |end| {
                        let mut with = one;
                        set(&mut with, end);
                        with
                    })
                };
                ends = ends.iter().flat_map(with).collect();
            }
            for &first in if turns { &[End::A][..] } else { drop.first_ends() } {
                for &speed_m_s in &speeds {
                    for one in &ends {
                        drops.extend((0..=steps).map(|k| {
                            let tilt_rad = drop.tilt_rad.at(f64::from(k) / f64::from(steps.max(1)));
                            Drop { direction_rad: Drop::towards(first), tilt_rad, speed_m_s, ..*one }
                        }));
                        let least = drops.len() - 1 - steps as usize;
                        let flat: Option<Drop> = drops.get(least).filter(|drop| drop.lands_as_one(MERGE_S)).copied();
                        drops.extend(flat.map(|drop| Drop { is_flat: true, ..drop }));
                    }
                }
            }
        }
        Self { drops, counts: of_each.iter().map(Vec::len).collect(), parts: of_each.concat() }
    }

    /// Returns one of the drops, of another body and restitution.
    fn sample(&self, body: &Body, e: f64, drop: usize) -> Sample {
        let drop = Drop { body: *body, restitution: e, ..self.drops[drop] };
        Sample { uniforms: Vec::new(), drops: vec![drop], parts: self.parts.clone() }
    }

    fn closed(&self, body: &Body, e: f64) -> Vec<Option<f64>> {
        let (mut asked, mut sample) = (Vec::new(), self.sample(body, e, 0));
        let mut worst = Worst::new(&self.counts);
        for drop in &self.drops {
            // Another body may be turned up where it touches, which no train tells.
            if (Drop { body: *body, ..*drop }).approaches_m_s()[0] >= 0.0 {
                return vec![None; self.counts.len()];
            }
            sample.drops[0] = Drop { body: *body, restitution: e, ..*drop };
            cheap::answer(&sample, &mut asked);
            worst.raise(&asked, |asked, most| Some(asked.max(most)));
        }
        worst.verdicts()
    }

    fn full(&self, body: &Body, e: f64) -> Vec<Option<f64>> {
        let mut worst = Worst::new(&self.counts);
        for drop in &self.drops {
            let drop = Drop { body: *body, restitution: e, ..*drop };
            let mut followings = FollowedDrops::of(&drop, &self.parts);
            worst.raise(&self.parts, |part, most| followings.larger(part, most).ok());
        }
        worst.verdicts()
    }
}

/// The worst so far, of each component.
struct Worst<'a> {
    counts: &'a [usize],
    utilization: Vec<f64>,
    unanswered: Vec<bool>,
}

impl<'a> Worst<'a> {
    fn new(counts: &'a [usize]) -> Self {
        Self { counts, utilization: vec![LEAST; counts.len()], unanswered: vec![false; counts.len()] }
    }
    /// Takes in the demand of a drop: for each part, the larger of that and of the worst so far.
    fn raise<T>(&mut self, parts: &[T], mut larger: impl FnMut(&T, f64) -> Option<f64>) {
        let mut parts = parts.iter();
        for (i, count) in self.counts.iter().enumerate() {
            for part in parts.by_ref().take(*count) {
                match larger(part, self.utilization[i]) {
                    Some(worst) => self.utilization[i] = worst,
                    None => self.unanswered[i] = true,
                }
            }
        }
    }
    /// A limit that is passed is passed, whatever the demand of other drops.
    fn verdicts(self) -> Vec<Option<f64>> {
        let each = self.utilization.into_iter().zip(self.unanswered);
        each.map(|(used, unanswered)| (!unanswered || used > 1.0).then_some(used)).collect()
    }
}
