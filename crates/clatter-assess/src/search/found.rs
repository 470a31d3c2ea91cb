//! This module holds the demands of drops: of each, of all, and of the worst of them.

use clatter_shock::Suspension;

use super::Coordinates;
use crate::engine::{Answer, Part};
use clatter_product::{Component, Error};

/// A drop and a part with a demand.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Candidate {
    pub(crate) place: Coordinates,
    /// The part, where the limit is on its response.
    pub(crate) part: Option<Suspension>,
    pub(crate) answer: Answer,
    /// True where it comes after the body has bounced clear once.
    pub(crate) late: bool,
}

/// The worst that was found for one limit.
#[derive(Debug, Clone)]
pub(crate) struct Worst {
    /// The drop with the largest demand; none where no drop of the ranges was answered.
    pub(crate) asked: Option<Candidate>,
    /// Drops some way from one another with nearly as large a demand, as they were found.
    pub(crate) near: Vec<Candidate>,
    /// The utilization that strikes after the body has come down once may reach, by the energy left; 0 where that is below the worst.
    pub(crate) later: f64,
    /// How far a part with stops would swing without them in any of the drops, as a velocity.
    pub(crate) swing: f64,
    /// The largest demand of a drop that was found after it has bounced clear once, as a utilization.
    pub(crate) late: f64,
    /// Drops that the model does not take, and why the first of them; of edges that touch, why the one that sinks in deepest.
    pub(crate) refused: Option<(usize, Error)>,
    /// Drops that were followed besides climbing.
    pub(crate) drops: usize,
    /// True where the search was stopped before its end.
    pub(crate) stopped: bool,
}

/// What may come after a body has come down once.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Later {
    /// The demand that the energy allows, as a utilization.
    pub(super) most: f64,
    /// The utilization to which the part still rings; of one with stops the amplitude as a velocity.
    pub(super) rings: f64,
}

/// The demands of one drop.
#[derive(Default)]
pub(super) struct OfDrop {
    /// The demands on the tasks of these numbers.
    pub(super) asked: Vec<(usize, Candidate)>,
    /// What may come after the body has come down once, on tasks where that is more.
    pub(super) later: Vec<(usize, Later)>,
    /// How far parts with stops would swing without them, as a velocity, for their tasks.
    pub(super) swings: Vec<(usize, f64)>,
    /// The energy over the mass that the body still has as it is left, where it lands again.
    pub(super) energy_m2_s2: f64,
    /// The lean of a box that was followed on, from the posture in which it landed.
    pub(super) lean: f64,
}

impl Worst {
    pub(super) fn none() -> Self {
        let near = Vec::new();
        Self { asked: None, near, later: 0.0, swing: 0.0, late: 0.0, refused: None, drops: 0, stopped: false }
    }
    pub(super) fn refuse(&mut self, count: usize, error: &Error) {
        let (own, first) = self.refused.take().unwrap_or_else(|| (0, error.clone()));
        self.refused = Some((own + count, first.or_deeper(error.clone())));
    }
}

/// The demands of all drops.
pub(super) struct Candidates {
    /// The drops found for each task.
    pub(super) found: Vec<Vec<Candidate>>,
    /// The number of drops that are not answered, and the reason of the first; of edges that touch, the one that does deepest.
    pub(super) refused: Option<(usize, Error)>,
    /// What may come after the body has come down once, for each task: the most of any drop.
    pub(super) later: Vec<Later>,
    /// How far parts with stops would swing without them, as a velocity, for each task.
    pub(super) swings: Vec<f64>,
    pub(super) drops: usize,
    /// The most energy over the mass that the body still has as it lands again.
    pub(super) energy_m2_s2: f64,
    /// The box that leaned most, and how far.
    pub(super) leaning: Option<(f64, Coordinates)>,
}

impl Candidates {
    pub(super) fn none(tasks: usize) -> Self {
        Self {
            found: vec![Vec::new(); tasks],
            refused: None,
            later: vec![Later::default(); tasks],
            swings: vec![0.0; tasks],
            drops: 0,
            energy_m2_s2: 0.0,
            leaning: None,
        }
    }
    /// Returns the largest utilization of each task so far.
    pub(super) fn best(&self) -> Vec<f64> {
        let most = |found: &Vec<Candidate>| found.iter().map(|asked| asked.answer.utilization()).fold(0.0, f64::max);
        self.found.iter().map(most).collect()
    }
    pub(super) fn take(&mut self, answers: Vec<(Coordinates, Result<OfDrop, Error>)>) {
        for (place, answer) in answers.into_iter().filter(|(_, answer)| !matches!(answer, Err(Error::Stopped))) {
            self.drops += 1;
            match answer {
                Ok(of_drop) => {
                    if of_drop.lean > self.leaning.map_or(0.0, |(lean, _)| lean) {
                        self.leaning = Some((of_drop.lean, place));
                    }
                    self.energy_m2_s2 = self.energy_m2_s2.max(of_drop.energy_m2_s2);
                    of_drop.asked.into_iter().for_each(|(task, asked)| self.found[task].push(asked));
                    of_drop.swings.into_iter().for_each(|(task, most)| self.swings[task] = most.max(self.swings[task]));
                    for (task, Later { most, rings }) in of_drop.later {
                        let later = &mut self.later[task];
                        *later = Later { most: later.most.max(most), rings: later.rings.max(rings) };
                    }
                }
                Err(error) => {
                    self.refused = Some(
                        self.refused.take().map_or((1, error.clone()), |(n, first)| (n + 1, first.or_deeper(error))),
                    );
                }
            }
        }
    }
}

/// Returns a place with sides exchanged.
pub(super) fn image(at_m: [f64; 2], sides: [bool; 2]) -> [f64; 2] {
    [0, 1].map(|k| if sides[k] { -at_m[k] } else { at_m[k] })
}

impl Candidate {
    /// Returns the part where it is.
    pub(crate) fn part_there(&self, component: &Component) -> Part {
        Part::at(component.inside.place(self.place.at_m), self.part)
    }
    /// Returns whether its demand for the limit is larger than that of another drop.
    pub(crate) fn exceeds(&self, other: &Self) -> bool {
        self.answer.utilization() > other.answer.utilization()
    }
    /// Returns the same of the product with sides exchanged.
    pub(super) fn mirrored(self, sides: [bool; 2], is_plate: bool) -> Self {
        let Coordinates { first, mirrored, at_m, .. } = self.place;
        let place = if is_plate {
            Coordinates { mirrored: [0, 1].map(|k| mirrored[k] ^ sides[k]), ..self.place }
        } else {
            Coordinates { first: if sides[0] { first.other() } else { first }, ..self.place }
        };
        Self { place: Coordinates { at_m: image(at_m, sides), ..place }, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The demand of rebounds is the largest of any drop, in whatever order they come.
    #[test]
    fn rebounds_of_all_drops_are_the_most_of_any() {
        for order in [[3.0, 1.0, 2.0], [1.0, 2.0, 3.0]] {
            let mut all = Candidates::none(1);
            let place = Coordinates {
                first: clatter::End::A,
                flat: false,
                mirrored: [false; 2],
                at_m: [0.0; 2],
                shares: [0.0; super::super::ranges::AXES],
            };
            let of = |most: f64| OfDrop { later: vec![(0, Later { most, rings: 0.5 * most })], ..OfDrop::default() };
            all.take(order.map(|most| (place, Ok(of(most)))).into());
            let [most, rings] = [all.later[0].most, all.later[0].rings];
            assert!((most - 3.0).abs() < 1e-12 && (rings - 1.5).abs() < 1e-12 && all.drops == 3, "{:?}", all.later);
        }
    }
}
