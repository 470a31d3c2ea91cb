//! This module sums up many samples: counts of failures, the intervals that hold them, and the inputs that drive them.

use super::drivers::Sums;
use super::landing::{LandingTally, sequence};
use super::{Answers, ComponentScatter, Driver, Inputs, Probability, SampleDemand, clopper_pearson};
use clatter_product::{Component, Error, Limit};

/// Verdicts on samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Count {
    pub(super) samples: u64,
    /// The number of samples that fail: as answered, at least and at most, whatever the answers may be off by. A sample that is not
    /// answered fails but for the least.
    fails: [u64; 3],
    unanswered: u64,
}

impl Count {
    /// Takes in the demand of a sample; none where that is not answered.
    pub(super) fn take(&mut self, asked: Option<&SampleDemand>) {
        let verdicts =
            |asked: &SampleDemand| [asked.utilization, asked.within[0], asked.within[1]].map(|used| used > 1.0);
        let fails = asked.map_or([true, false, true], verdicts);
        self.samples += 1;
        self.fails.iter_mut().zip(fails).for_each(|(count, fails)| *count += u64::from(fails));
        self.unanswered += u64::from(asked.is_none());
    }

    pub(super) fn merge(&mut self, later: &Self) {
        self.samples += later.samples;
        self.fails.iter_mut().zip(later.fails).for_each(|(count, later)| *count += later);
        self.unanswered += later.unanswered;
    }

    /// Returns the probability to survive. The lower end takes all that is open or not answered as failures, the upper end as none.
    pub(super) fn survival(&self, confidence: f64) -> Probability {
        let [told, most, least] =
            self.fails.map(|fails| clopper_pearson(self.samples - fails, self.samples, confidence));
        let estimate = told.estimate.filter(|_| self.unanswered < self.samples);
        Probability { estimate, lo: least.lo, hi: most.hi, at_least: least.at_least }
    }

    /// Returns how many fail, are open and are not answered.
    pub(super) fn counts(&self) -> [u64; 3] {
        let Self { fails: [told, least, most], unanswered, .. } = *self;
        [told - unanswered, most - least - unanswered, unanswered]
    }
}

/// The result of one block.
#[derive(Debug)]
pub(super) struct Block {
    pub(super) tallies: Vec<Tally>,
    /// The results of each drop of a box.
    pub(super) landings: Vec<LandingTally>,
    /// The count of all parts together.
    pub(super) all: Count,
    /// Samples in which a part is not answered, and why the first is not.
    pub(super) unanswered: u64,
    pub(super) reason: Option<Error>,
    pub(super) values: Vec<f64>,
}

impl Block {
    pub(super) fn new(components: &[Component], inputs: &Inputs, near: &[f64]) -> Self {
        let each = components.iter().zip(&inputs.of_part).zip(near);
        let tallies = each.map(|((component, own), near)| Tally::new(component, own.len(), *near)).collect();
        let landings = vec![LandingTally::new(components.len()); inputs.landings()];
        Self { tallies, landings, all: Count::default(), unanswered: 0, reason: None, values: Vec::new() }
    }

    /// Takes in sample k.
    pub(super) fn take(&mut self, k: u64, asked: &Answers, inputs: &Inputs, uniforms: &[f64]) {
        let Answers { parts, landings } = asked;
        for ((tally, own), asked) in self.tallies.iter_mut().zip(&inputs.of_part).zip(parts) {
            tally.take(k, asked.as_ref().ok(), own.iter().map(|input| uniforms[*input]));
        }
        self.all.take(sequence(parts).as_ref().ok());
        let reason = parts.iter().find_map(|asked| asked.as_ref().err());
        self.unanswered += u64::from(reason.is_some());
        if self.reason.is_none() {
            self.reason = reason.cloned();
        }
        self.landings.iter_mut().zip(landings).for_each(|(tally, parts)| tally.take(parts));
    }

    pub(super) fn merge(&mut self, later: &Self) {
        self.all.merge(&later.all);
        self.tallies.iter_mut().zip(&later.tallies).for_each(|(sum, later)| sum.merge(later));
        self.landings.iter_mut().zip(&later.landings).for_each(|(sum, later)| sum.merge(later));
        self.unanswered += later.unanswered;
        if self.reason.is_none() {
            self.reason.clone_from(&later.reason);
        }
    }
}

/// The result of one component, so far.
#[derive(Debug)]
pub(super) struct Tally {
    pub(super) count: Count,
    /// Failures of each limit.
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

    /// Takes in a sample as [`Count::take`], with the ranks of the inputs of the part.
    pub(super) fn take(&mut self, sample: u64, asked: Option<&SampleDemand>, ranks: impl Iterator<Item = f64>) {
        self.count.take(asked);
        let Some(asked) = asked else { return };
        self.limits.iter_mut().zip(asked.fails).for_each(|(count, fails)| *count += u64::from(fails));
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
        confidence: f64,
    ) -> ComponentScatter {
        let shares = self.sums.shares().unwrap_or_default();
        let mut drivers: Vec<Driver> =
            own.iter().zip(shares).map(|(input, share)| Driver { input: inputs.varied[*input], share }).collect();
        drivers.sort_by(|a, b| b.share.variance.total_cmp(&a.share.variance));
        let kinds = Limit::of(component).into_iter().map(|limit| limit.kind);
        let [failures, open, unanswered] = self.count.counts();
        ComponentScatter {
            name: component.name.clone(),
            failures,
            open,
            unanswered,
            survival: self.count.survival(confidence),
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
    use crate::scatter::OfPart;

    fn of(used: f64, least: f64, most: f64) -> SampleDemand {
        SampleDemand { utilization: used, within: [least, most], ..SampleDemand::default() }
    }

    /// Of five samples one fails, one may fail, one has no answer, and two are stood.
    #[test]
    fn every_sample_is_counted_once() {
        let mut count = Count::default();
        for asked in [of(1.2, 1.1, 1.3), of(0.98, 0.95, 1.01), of(0.5, 0.4, 0.6), of(0.7, 0.6, 0.8)] {
            count.take(Some(&asked));
        }
        count.take(None);
        assert_eq!(count.counts(), [1, 1, 1]);
        let survival = count.survival(0.95);
        assert_eq!(survival.estimate, Some(0.6), "what has no answer is no survivor: {survival:?}");
        let [two, four] = [2, 4].map(|survive| clopper_pearson(survive, 5, 0.95));
        for (told, known) in [(survival.lo, two.lo), (survival.at_least, two.at_least), (survival.hi, four.hi)] {
            assert_eq!(told.to_bits(), known.to_bits(), "nor is what may fail: {survival:?}");
        }
    }

    /// Of all that two parts may be in one sample: together they fail wherever one of them does, and may fail wherever one may.
    #[test]
    fn parts_together_survive_no_more_often_than_each() {
        let answered = [of(0.5, 0.4, 0.6), of(0.9, 0.8, 1.1), of(1.1, 0.9, 1.2), of(2.0, 1.5, 3.0)].map(Ok);
        let each: Vec<OfPart> = answered.into_iter().chain([Err(Error::Unfinished)]).collect();
        for (one, other) in each.iter().flat_map(|one| each.iter().map(move |other| (one, other))) {
            let [all, one, other] = [sequence([one, other]), one.clone(), other.clone()].map(|asked| {
                let mut count = Count::default();
                count.take(asked.as_ref().ok());
                count
            });
            for which in 0..3 {
                assert_eq!(all.fails[which], one.fails[which].max(other.fails[which]), "{one:?}, {other:?}: {all:?}");
            }
        }
    }
}
