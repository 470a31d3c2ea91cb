//! The drops of a list, one by one and in sequence.

use super::tally::Count;
use super::{OfPart, Probability, SampleDemand};
use clatter_product::DropName;

/// The result of one of several drops.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct LandingScatter {
    /// The name of the drop.
    pub landing: DropName,
    /// Probability that every component survives this drop alone.
    pub survival: Probability,
    /// The components, in the order of the file.
    pub components: Vec<LandingComponent>,
}

/// The result of one of several drops for a component, as of [`ComponentScatter`](super::ComponentScatter).
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct LandingComponent {
    /// Samples in which a limit did not hold.
    pub failures: u64,
    /// Samples in which what the answer may be off by, or the energy left, decides.
    pub open: u64,
    /// Samples that the model does not answer.
    pub unanswered: u64,
    /// Probability that all of its limits hold in this drop.
    pub survival: Probability,
    /// The largest utilization seen; none where none was answered.
    pub largest_utilization: Option<f64>,
}

/// Returns the demand of a sequence of drops on a part, and of a drop on all parts together: as much as the largest one. Where one of them
/// is not answered, neither are all, unless another has failed for sure.
pub(super) fn sequence<'a>(each: impl IntoIterator<Item = &'a OfPart>) -> OfPart {
    let (mut most, mut error) = (SampleDemand::default(), None);
    for one in each {
        match one {
            Ok(asked) => most = most.largest(asked),
            Err(why) => error = error.or(Some(why)),
        }
    }
    error.filter(|_| most.within[0] <= 1.0).map_or(Ok(most), |error| Err(error.clone()))
}

/// The result of one of several drops, so far: of all parts, and of each with the largest utilization.
#[derive(Debug, Clone)]
pub(super) struct LandingTally {
    all: Count,
    parts: Vec<(Count, Option<f64>)>,
}

impl LandingTally {
    pub(super) fn new(parts: usize) -> Self {
        Self { all: Count::default(), parts: vec![(Count::default(), None); parts] }
    }

    pub(super) fn take(&mut self, parts: &[OfPart]) {
        for ((count, largest), asked) in self.parts.iter_mut().zip(parts) {
            count.take(asked.as_ref().ok());
            *largest = larger(*largest, asked.as_ref().ok().map(|asked| asked.utilization));
        }
        self.all.take(sequence(parts).as_ref().ok());
    }

    pub(super) fn merge(&mut self, later: &Self) {
        self.all.merge(&later.all);
        for ((count, largest), later) in self.parts.iter_mut().zip(&later.parts) {
            count.merge(&later.0);
            *largest = larger(*largest, later.1);
        }
    }

    pub(super) fn summary(&self, landing: DropName, confidence: f64) -> LandingScatter {
        let of = |(count, largest_utilization): &(Count, Option<f64>)| {
            let [failures, open, unanswered] = count.counts();
            let (survival, largest_utilization) = (count.survival(confidence), *largest_utilization);
            LandingComponent { failures, open, unanswered, survival, largest_utilization }
        };
        let survival = self.all.survival(confidence);
        LandingScatter { landing, survival, components: self.parts.iter().map(of).collect() }
    }
}

fn larger(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    a.into_iter().chain(b).reduce(f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use clatter_product::Error;

    /// A sequence that holds where it was answered is not answered if one drop is not; one that has failed has failed.
    #[test]
    fn a_drop_without_an_answer_leaves_a_sequence_without_one() {
        let asked = |used: f64| Ok(SampleDemand { utilization: used, within: [used; 2], ..SampleDemand::default() });
        let none = || Err(Error::Unfinished);
        for (drops, used) in [
            (vec![asked(0.5), asked(0.8)], Some(0.8)),
            (vec![asked(0.5), none()], None),
            (vec![none(), asked(0.5)], None),
            (vec![none(), asked(1.2)], Some(1.2)),
        ] {
            let found = sequence(drops.iter()).ok().map(|most| most.utilization);
            assert_eq!(found, used, "{drops:?}");
        }
    }
}
