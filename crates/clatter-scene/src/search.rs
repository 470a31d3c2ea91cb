//! The worst case by a search of stated resolution, for the models that have no bounds.
//!
//! All components share the drops of one grid over tilt, speed, restitution and the end that strikes first; around the worst drop
//! of each demand the grid is then refined, the step halved each time.

use clatter::End;
use rayon::prelude::*;

use crate::base::{Base, SingleDrop};
use crate::demand::{Demand, Heard, Reached};
use crate::{BarModel, Component, Drop, Error, Product, Spread};

/// Steps along the tilt; even in its square root, because contacts overlap at small tilts and gaps grow from there.
const TILTS: u32 = 16;
/// Steps along restitution and frequency.
const STEPS: u32 = 2;
/// How often the step is halved around the worst drop.
const HALVINGS: u32 = 3;

/// The worst drop of the search.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Found {
    pub(crate) reached: Reached,
    pub(crate) drop: SingleDrop,
    /// By which share the last refinement raised the demand.
    pub(crate) raised: f64,
}

/// One demand to be searched for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Task<'a> {
    pub(crate) component: &'a Component,
    pub(crate) demand: Demand,
    pub(crate) model: BarModel,
    pub(crate) pulses: bool,
}

/// The product and the ranges of its drop.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Field<'a> {
    pub(crate) product: &'a Product,
    pub(crate) drop: &'a Drop,
}

/// Where in its range each quantity is, from 0 to 1.
#[derive(Debug, Clone, Copy)]
struct Place {
    first: End,
    /// Of the square root of the tilt.
    tilt: f64,
    speed: f64,
    restitution: f64,
    frequency: f64,
}

fn shares(steps: u32, fixed: bool) -> impl Iterator<Item = f64> + Clone {
    let steps = if fixed { 0 } else { steps };
    (0..=steps).map(move |i| if steps == 0 { 0.0 } else { f64::from(i) / f64::from(steps) })
}

impl Field<'_> {
    fn single(&self, place: &Place) -> SingleDrop {
        let [slow, fast] = self.drop.speeds_m_s();
        let [lo, hi] = [self.drop.tilt_rad.lo().sqrt(), self.drop.tilt_rad.hi().sqrt()];
        let root = lo + place.tilt * (hi - lo);
        SingleDrop {
            first: place.first,
            tilt_rad: (root * root).clamp(self.drop.tilt_rad.lo(), self.drop.tilt_rad.hi()),
            speed_m_s: (slow + place.speed * (fast - slow)).clamp(slow, fast),
            restitution: self.product.restitution.at(place.restitution),
            gravity_m_s2: self.drop.gravity_m_s2,
        }
    }

    fn symmetric(&self) -> bool {
        let [a, b] = self.product.body.arms_m();
        a.to_bits() == b.to_bits()
    }

    fn places(&self) -> Vec<Place> {
        let [slow, fast] = self.drop.speeds_m_s();
        let mut places = Vec::new();
        // Of a symmetric product one end first is the other one turned around.
        for &first in if self.symmetric() { &self.drop.first_ends()[..1] } else { self.drop.first_ends() } {
            for tilt in shares(TILTS, self.drop.tilt_rad.is_value()) {
                // From the fastest and most elastic one, which is often the worst.
                for speed in shares(1, slow >= fast) {
                    for restitution in shares(STEPS, self.product.restitution.is_value()) {
                        places.push(Place { first, tilt, speed, restitution, frequency: 0.0 });
                    }
                }
            }
        }
        places
    }

    /// The worst drop of each task, over one grid for each model.
    ///
    /// # Errors
    /// A drop that a model does not take.
    pub(crate) fn worst(&self, tasks: &[Task<'_>]) -> Result<Vec<Found>, Error> {
        let mut models: Vec<_> = tasks.iter().map(|task| task.model).collect();
        models.sort_unstable();
        models.dedup();
        let mut best: Vec<Option<(Place, Reached)>> = vec![None; tasks.len()];
        for model in models {
            let columns: Vec<Vec<Option<(Place, Reached)>>> =
                self.places().par_iter().map(|place| self.column(tasks, model, place)).collect::<Result<_, Error>>()?;
            for column in columns {
                for (best, new) in best.iter_mut().zip(column) {
                    if let Some(new) = new
                        && best.as_ref().is_none_or(|old| new.1.value > old.1.value)
                    {
                        *best = Some(new);
                    }
                }
            }
        }
        let refined = |(task, best): (&Task<'_>, Option<(Place, Reached)>)| {
            let (place, reached) = best.unwrap_or_else(|| unreachable!("a grid has places"));
            self.refine(task, place, reached)
        };
        tasks.par_iter().zip(best).map(refined).collect()
    }

    /// What the tasks of a model get from the drops of a place.
    fn column(
        &self,
        tasks: &[Task<'_>],
        model: BarModel,
        place: &Place,
    ) -> Result<Vec<Option<(Place, Reached)>>, Error> {
        let mut bases = vec![(*place, Base::new(self.product, &self.single(place), model)?)];
        if self.symmetric() && self.drop.first_ends().len() > 1 {
            let turned = Place { first: place.first.other(), ..*place };
            bases.push((turned, bases[0].1.turned()));
        }
        let mut column: Vec<Option<(Place, Reached)>> = vec![None; tasks.len()];
        for (place, base) in &bases {
            // Tasks of one component follow one another.
            let (mut component, mut heard) = (std::ptr::null(), Heard::new(false));
            for (task, best) in tasks.iter().zip(&mut column).filter(|(task, _)| task.model == model) {
                if !std::ptr::eq(component, task.component) {
                    (component, heard) = (task.component, Heard::new(task.pulses));
                }
                let new = reach_all(task, base, place, &mut heard)?;
                if best.as_ref().is_none_or(|old| new.1.value > old.1.value) {
                    *best = Some(new);
                }
            }
        }
        Ok(column)
    }

    /// Halves the step around a place.
    fn refine(&self, task: &Task<'_>, mut place: Place, mut reached: Reached) -> Result<Found, Error> {
        let [slow, fast] = self.drop.speeds_m_s();
        let free = [
            !self.drop.tilt_rad.is_value(),
            slow < fast,
            !self.product.restitution.is_value(),
            task.demand.frequencies().is_some_and(|f| !f.is_value()),
        ];
        let mut step = [1.0 / f64::from(TILTS), 1.0, 1.0 / f64::from(STEPS), 1.0 / f64::from(STEPS)];
        let mut raised = 0.0;
        for _ in 0..HALVINGS {
            let before = reached.value;
            for axis in (0..4).filter(|&axis| free[axis]) {
                step[axis] *= 0.5;
                for sign in [-1.0, 1.0] {
                    let mut next = place;
                    let share = [&mut next.tilt, &mut next.speed, &mut next.restitution, &mut next.frequency];
                    let share = share.into_iter().nth(axis).unwrap_or_else(|| unreachable!("one of four"));
                    let moved = (*share + sign * step[axis]).clamp(0.0, 1.0);
                    if (moved - *share).abs() < f64::EPSILON {
                        continue;
                    }
                    *share = moved;
                    let base = Base::new(self.product, &self.single(&next), task.model)?;
                    let new = reach(task, &base, &next, &mut Heard::new(task.pulses))?;
                    if new.value > reached.value {
                        (place, reached) = (next, new);
                    }
                }
            }
            raised = reached.value / before - 1.0;
        }
        Ok(Found { reached, drop: self.single(&place), raised: if raised.is_finite() { raised } else { 0.0 } })
    }
}

/// The worst over the frequencies of the part.
fn reach_all(task: &Task<'_>, base: &Base, place: &Place, heard: &mut Heard) -> Result<(Place, Reached), Error> {
    let fixed = task.demand.frequencies().is_none_or(|f| f.is_value());
    let mut worst: Option<(Place, Reached)> = None;
    for frequency in shares(STEPS, fixed) {
        let place = Place { frequency, ..*place };
        let reached = reach(task, base, &place, heard)?;
        if worst.as_ref().is_none_or(|worst| reached.value > worst.1.value) {
            worst = Some((place, reached));
        }
    }
    Ok(worst.unwrap_or_else(|| unreachable!("at least one frequency")))
}

fn reach(task: &Task<'_>, base: &Base, place: &Place, heard: &mut Heard) -> Result<Reached, Error> {
    let frequency_hz = task.demand.frequencies().map_or(0.0, |f: Spread| f.at(place.frequency));
    task.demand.reached(base, task.component, frequency_hz, heard)
}
