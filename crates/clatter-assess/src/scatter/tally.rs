//! What comes of many samples: counts of failures, what they are within, and what drives them.

#![expect(clippy::option_option, reason = "not asked, without an answer, answered")]

use super::drivers::Sums;
use super::landing::{LandingTally, all_of};
use super::levels::{Count, float, round};
use super::{Answers, ComponentScatter, Driver, Inputs, Probability, SampleDemand, Settings};
use crate::{Component, Error, Limit};

impl Count {
    /// Takes in a sample by what it asks by the cheap model, where that was asked, and by the full one: none where only the cheap one
    /// was asked, an inner none where it has no answer.
    pub(super) fn take(&mut self, cheap: Option<&SampleDemand>, full: Option<Option<&SampleDemand>>) {
        let fails = |asked: &SampleDemand| [asked.utilization, asked.within[0], asked.within[1]].map(|used| used > 1.0);
        self.add(cheap.is_some_and(|asked| asked.utilization > 1.0), full.map(|full| full.map(fails)));
    }

    /// The probability to survive. The lower end takes all that is open or not answered as failures, the upper end as none.
    pub(super) fn survival(&self, confidence: f64) -> Probability {
        let least = |confidence| (1.0 - self.bounds(2, confidence)[1]).max(0.0);
        Probability {
            estimate: (1.0 - self.probability(0)).clamp(0.0, 1.0),
            lo: least(confidence),
            hi: 1.0 - self.bounds(1, confidence)[0],
            at_least: least(2.0 * confidence - 1.0),
        }
    }

    /// So many of the samples asked for, by the verdicts of one kind.
    fn of(&self, samples: u64, which: usize) -> u64 {
        round(float(samples) * self.probability(which).clamp(0.0, 1.0))
    }

    /// Of the samples asked for, those that fail, that are open and that are not answered.
    pub(super) fn counts(&self, samples: u64) -> [u64; 3] {
        let Self { more, fewer, unanswered, both, .. } = *self;
        let scaled = |count: u64| round(float(count) * float(samples) / float(both.max(1)));
        let open = (more[2] + fewer[1]).saturating_sub(more[1] + fewer[2] + unanswered);
        [self.of(samples, 0).saturating_sub(scaled(unanswered)), scaled(open), scaled(unanswered)]
    }
}

/// What came of one block.
#[derive(Debug)]
pub(super) struct Block {
    pub(super) tallies: Vec<Tally>,
    /// Of each drop of a box.
    pub(super) landings: Vec<LandingTally>,
    pub(super) all: Count,
    pub(super) reason: Option<Error>,
    pub(super) values: Vec<f64>,
}

impl Block {
    pub(super) fn new(components: &[Component], inputs: &Inputs, near: &[f64]) -> Self {
        let each = components.iter().zip(&inputs.of_part).zip(near);
        let tallies = each.map(|((component, own), near)| Tally::new(component, own.len(), *near)).collect();
        let landings = vec![LandingTally::new(components.len()); inputs.landings()];
        Self { tallies, landings, all: Count::default(), reason: None, values: Vec::new() }
    }

    /// Takes in sample k; an empty list where a model was not asked.
    pub(super) fn take(&mut self, k: u64, asked: &Answers, inputs: &Inputs, uniforms: &[f64]) {
        let Answers { cheap, full, landings } = asked;
        for (i, (tally, own)) in self.tallies.iter_mut().zip(&inputs.of_part).enumerate() {
            let full = full.get(i).map(|full| full.as_ref().ok());
            tally.take(k, cheap.get(i), full, own.iter().map(|input| uniforms[*input]));
        }
        let cheap = cheap.iter().fold(SampleDemand::default(), SampleDemand::largest);
        let together = all_of(full);
        self.all.take(Some(&cheap), (!full.is_empty()).then_some(together.as_ref().ok()));
        if self.reason.is_none() {
            self.reason = together.err();
        }
        self.landings.iter_mut().zip(landings).for_each(|(tally, parts)| tally.take(parts));
    }

    pub(super) fn merge(&mut self, later: &Self) {
        self.all.merge(&later.all);
        self.tallies.iter_mut().zip(&later.tallies).for_each(|(sum, later)| sum.merge(later));
        self.landings.iter_mut().zip(&later.landings).for_each(|(sum, later)| sum.merge(later));
        if self.reason.is_none() {
            self.reason.clone_from(&later.reason);
        }
    }
}

/// What came of one component, so far.
#[derive(Debug)]
pub(super) struct Tally {
    pub(super) count: Count,
    limits: Vec<Count>,
    sums: Sums,
    largest: f64,
    worst: Option<u64>,
}

impl Tally {
    /// `near` is any value near the utilizations.
    pub(super) fn new(component: &Component, inputs: usize, near: f64) -> Self {
        let limits = vec![Count::default(); component.limits.kinds().len()];
        Self { count: Count::default(), limits, sums: Sums::new(near, inputs), largest: 0.0, worst: None }
    }

    /// Takes in a sample as [`Count::take`], with the ranks of the inputs of the part.
    pub(super) fn take(
        &mut self,
        sample: u64,
        cheap: Option<&SampleDemand>,
        full: Option<Option<&SampleDemand>>,
        ranks: impl Iterator<Item = f64>,
    ) {
        self.count.take(cheap, full);
        for (k, count) in self.limits.iter_mut().enumerate() {
            let full = full.map(|full| [full.is_some_and(|asked| asked.fails[k]); 3]);
            count.add(cheap.is_some_and(|asked| asked.fails[k]), full.map(Some));
        }
        let Some(Some(asked)) = full else { return };
        self.sums.add(asked.utilization, ranks);
        if self.worst.is_none() || asked.utilization > self.largest {
            (self.largest, self.worst) = (asked.utilization, Some(sample));
        }
    }

    pub(super) fn merge(&mut self, later: &Self) {
        self.count.merge(&later.count);
        self.limits.iter_mut().zip(&later.limits).for_each(|(sum, later)| sum.merge(later));
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
    ) -> ComponentScatter {
        let shares = self.sums.shares().unwrap_or_default();
        let mut drivers: Vec<Driver> =
            own.iter().zip(shares).map(|(input, share)| Driver { input: inputs.varied[*input], share }).collect();
        drivers.sort_by(|a, b| b.share.variance.total_cmp(&a.share.variance));
        let kinds = Limit::of(component).into_iter().map(|limit| limit.kind);
        let [failures, open, unanswered] = self.count.counts(settings.samples);
        ComponentScatter {
            name: component.name.clone(),
            failures,
            open,
            unanswered,
            survival: self.count.survival(settings.confidence),
            limits: kinds.zip(self.limits.iter().map(|count| count.of(settings.samples, 0))).collect(),
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
    use crate::scatter::clopper_pearson;

    /// Of five samples one fails, one may fail, one has no answer, and two are stood.
    #[test]
    fn every_sample_is_counted_once() {
        let mut count = Count::default();
        let of = |used, least, most| {
            Some(SampleDemand { utilization: used, within: [least, most], ..SampleDemand::default() })
        };
        for full in [of(1.2, 1.1, 1.3), of(0.98, 0.95, 1.01), None, of(0.5, 0.4, 0.6), of(0.7, 0.6, 0.8)] {
            count.take(None, Some(full.as_ref()));
        }
        assert_eq!(count.counts(5), [1, 1, 1]);
        let survival = count.survival(0.95);
        assert!((survival.estimate - 0.6).abs() < 1e-12, "what has no answer is no survivor: {survival:?}");
        assert!(survival.lo < clopper_pearson(2, 5, 0.95).lo + 1e-12, "nor is what may fail: {survival:?}");
        assert!(survival.hi > clopper_pearson(4, 5, 0.95).hi - 1e-12, "{survival:?}");
    }
}
