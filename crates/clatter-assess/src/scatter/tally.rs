//! What comes of many samples: counts of failures, what they are within, and what drives them.

use super::drivers::Sums;
use super::{Asked, ComponentScatter, Driver, Inputs, Probability, Settings, clopper_pearson};
use crate::{Component, Limit};

/// Failures among samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Count {
    /// As answered.
    pub(super) failures: u64,
    /// Whatever the answers may be off by.
    pub(super) at_least: u64,
    /// If all that is open fails: samples within the error of their limit, and those that were not answered.
    pub(super) at_most: u64,
    pub(super) unanswered: u64,
}

impl Count {
    pub(super) fn add(&mut self, asked: Option<&Asked>) {
        let Some(asked) = asked else {
            self.unanswered += 1;
            self.at_most += 1;
            return;
        };
        let [least, most] = asked.within;
        self.failures += u64::from(asked.utilization > 1.0);
        self.at_least += u64::from(least > 1.0);
        self.at_most += u64::from(most > 1.0);
    }

    pub(super) fn merge(&mut self, later: &Self) {
        self.failures += later.failures;
        self.at_least += later.at_least;
        self.at_most += later.at_most;
        self.unanswered += later.unanswered;
    }

    /// The probability to survive, where a `share` of drops may be off by anything.
    ///
    /// A true failure is one of `at_most` or of that share, so that survival is at least that of the others less the share; and
    /// likewise from above. `confidence` is that of the samples alone.
    pub(super) fn survival(&self, samples: u64, confidence: f64, share: f64) -> Probability {
        let interval = |failures: u64| clopper_pearson(samples - failures, samples, confidence);
        let (low, high) = (interval(self.at_most), interval(self.at_least));
        let estimate = interval(self.failures + self.unanswered).estimate;
        let less = |p: f64| (p - share).max(0.0);
        Probability { estimate, lo: less(low.lo), hi: (high.hi + share).min(1.0), at_least: less(low.at_least) }
    }
}

/// What came of one component, so far.
#[derive(Debug)]
pub(super) struct Tally {
    pub(super) count: Count,
    limits: Vec<u64>,
    sums: Sums,
    largest: f64,
    worst: Option<u64>,
}

impl Tally {
    /// `near` is any value near the utilizations.
    pub(super) fn new(component: &Component, inputs: usize, near: f64) -> Self {
        let limits = vec![0; component.limits.kinds().len()];
        Self { count: Count::default(), limits, sums: Sums::new(near, inputs), largest: 0.0, worst: None }
    }

    /// Takes in what a sample asks, with the ranks of the inputs of the part.
    pub(super) fn add(&mut self, sample: u64, asked: Option<&Asked>, ranks: impl Iterator<Item = f64>) {
        self.count.add(asked);
        let Some(asked) = asked else { return };
        self.limits.iter_mut().zip(asked.fails).for_each(|(failures, fails)| *failures += u64::from(fails));
        self.sums.add(asked.utilization, ranks);
        if self.worst.is_none() || asked.utilization > self.largest {
            (self.largest, self.worst) = (asked.utilization, Some(sample));
        }
    }

    pub(super) fn merge(&mut self, later: &Self) {
        self.count.merge(&later.count);
        self.limits.iter_mut().zip(&later.limits).for_each(|(sum, later)| *sum += later);
        self.sums.merge(&later.sums);
        if later.worst.is_some() && (self.worst.is_none() || later.largest > self.largest) {
            (self.largest, self.worst) = (later.largest, later.worst);
        }
    }

    pub(super) fn summary(
        &self,
        component: &Component,
        inputs: &Inputs,
        own: &[usize],
        settings: &Settings,
        [confidence, share]: [f64; 2],
    ) -> ComponentScatter {
        let shares = self.sums.shares().unwrap_or_default();
        let mut drivers: Vec<Driver> =
            own.iter().zip(shares).map(|(input, share)| Driver { input: inputs.varied[*input], share }).collect();
        drivers.sort_by(|a, b| b.share.variance.total_cmp(&a.share.variance));
        let kinds = Limit::of(component).into_iter().map(|limit| limit.kind);
        let Count { failures, at_least, at_most, unanswered } = self.count;
        ComponentScatter {
            name: component.name.clone(),
            failures,
            open: at_most - at_least - unanswered,
            unanswered,
            survival: self.count.survival(settings.samples, confidence, share),
            limits: kinds.zip(self.limits.iter().copied()).collect(),
            mean_utilization: self.sums.mean(),
            utilization_deviation: self.sums.deviation(),
            largest_utilization: self.largest,
            worst_sample: self.worst,
            drivers,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scatter::philox::Stream;
    use crate::scatter::pilot::{self, Pilot};

    fn asked(utilization: f64) -> Asked {
        let mut asked = Asked::default();
        asked.raise(0, utilization, 0.0);
        asked
    }

    /// The promise itself, on made-up models: the cheap one is off by up to 2 %, and in 1 of 600 drops it sees nothing of a failure. A
    /// pilot of 400 drops misses that half of the time, and the interval holds the truth all the same.
    #[test]
    fn the_interval_holds_the_truth_where_a_pilot_misses_what_is_rare() {
        let (rare, runs, samples) = (1.0 / 600.0, 400, 8000);
        let drop = |run, k| {
            let stream = Stream::new(run, k);
            let full = 0.5 + 0.55 * stream.at(0);
            let seen = full * (1.0 + 0.02 * (2.0 * stream.at(1) - 1.0));
            if stream.at(2) < rare { (0.5, 2.0) } else { (seen, full) }
        };
        let truth = (1.0 - rare) * 0.5 / 0.55;
        let (mut taken, mut within, mut above) = (0, 0, 0);
        for run in 0..runs {
            let pilot = Pilot::of(samples, 0.975, |k| {
                let (cheap, full) = drop(run, k);
                pilot::error(&[asked(cheap)], &[Ok(asked(full))])
            });
            if !pilot.taken {
                continue;
            }
            let mut count = Count::default();
            for k in 0..samples {
                let (cheap, full) = drop(run, k);
                let near = asked(cheap).off_by(pilot.worst_error).is_open();
                count.add(Some(&asked(if near { full } else { cheap })));
            }
            let survival = count.survival(samples, 0.975, pilot.share);
            taken += 1;
            within += u32::from(survival.lo <= truth && truth <= survival.hi);
            above += u32::from(survival.at_least <= truth);
        }
        assert!(taken > 150 && taken < 250, "{taken} pilots of {runs} took the cheap model");
        assert!(f64::from(within.min(above)) >= 0.95 * f64::from(taken), "{within}, {above} of {taken}");
    }

    #[test]
    fn what_is_open_or_unanswered_widens_the_interval() {
        let mut count = Count::default();
        for k in 0..1000 {
            let near = Asked { within: [0.99, 1.01], ..asked(0.995) };
            count.add(match k {
                0..20 => None,
                20..50 => Some(&near),
                50..60 => Some(const { &Asked { utilization: 2.0, within: [1.9, 2.1], fails: [true; 5] } }),
                _ => Some(const { &Asked { utilization: 0.5, within: [0.4, 0.6], fails: [false; 5] } }),
            });
        }
        assert_eq!((count.failures, count.at_least, count.at_most, count.unanswered), (10, 10, 60, 20));
        let survival = count.survival(1000, 0.95, 0.0);
        assert!((survival.estimate - 0.97).abs() < 1e-12, "{survival:?}");
        // From 940 survivors for sure up to 990 at most.
        assert!(survival.lo < 0.94 && survival.lo > 0.92 && survival.hi > 0.99 && survival.hi < 0.997, "{survival:?}");
        let share = count.survival(1000, 0.95, 0.01);
        assert!((survival.lo - share.lo - 0.01).abs() < 1e-12 && share.hi >= 0.9999, "{share:?}");
    }
}
