//! This module joins explanations that are about as good to the best one.

use clatter::End;

use super::{Estimate, Explanation, Fit, Quantity, RecordFit};

/// Returns whether two fits take the strikes for the same and give the same values: the search of one ended a little aside.
pub(super) fn is_same(fit: &Fit, other: &Fit) -> bool {
    let numbers = |fit: &Fit| -> Vec<Option<usize>> {
        fit.records.iter().flat_map(|record| record.strikes.iter().map(|strike| strike.number)).collect()
    };
    let holds = |(a, b): (&Estimate, &Estimate)| {
        a.quantity == b.quantity && a.interval.is_none_or(|[lo, hi]| (lo..=hi).contains(&b.value))
    };
    fit.first == other.first
        && numbers(fit) == numbers(other)
        && fit.estimates.len() == other.estimates.len()
        && fit.estimates.iter().zip(&other.estimates).all(holds)
}

/// Widens intervals to hold those of other fits that are about as good, and says which these are.
pub(super) fn join(fit: &mut Fit, others: Vec<Fit>) {
    let is_restitution =
        |quantity| matches!(quantity, Quantity::Restitution | Quantity::RestitutionA | Quantity::RestitutionB);
    for estimate in &mut fit.estimates {
        let is_same = |other: &&Estimate| {
            // One restitution is that of both ends.
            let both = [other.quantity, estimate.quantity];
            both[0] == both[1] || both.contains(&Quantity::Restitution) && both.into_iter().all(is_restitution)
        };
        let found = others.iter().flat_map(|other| other.estimates.iter().filter(is_same));
        let found: Vec<[f64; 2]> = found.filter_map(|other| other.interval).collect();
        let wider = |[lo, hi]: [f64; 2]| found.iter().fold([lo, hi], |[lo, hi], [a, b]| [lo.min(*a), hi.max(*b)]);
        estimate.interval = estimate.interval.map(wider);
    }
    fit.others = others.into_iter().map(Explanation::of).collect();
    if !fit.others.is_empty() {
        let said: Vec<String> = fit.others.iter().map(Explanation::said).collect();
        fit.notes.push(format!(
            "other explanations are about as good: {}; the intervals hold those of all of them",
            said.join(", or ")
        ));
    }
}

impl Explanation {
    fn of(fit: Fit) -> Self {
        let left_out = |record: &RecordFit| {
            let out = record.strikes.iter().filter(|strike| strike.number.is_none());
            out.map(|strike| strike.measured.time_s).collect()
        };
        Self {
            first: fit.first,
            left_out_s: fit.records.iter().map(left_out).collect(),
            missing: fit.records.into_iter().map(|record| record.missing).collect(),
            estimates: fit.estimates,
        }
    }

    fn said(&self) -> String {
        let record = |k: usize| if self.missing.len() > 1 { format!(" of record {}", k + 1) } else { String::new() };
        let missing = self.missing.iter().enumerate();
        let missing = missing.flat_map(|(k, all)| all.iter().map(move |n| format!("strike {n}{} missing", record(k))));
        let out = self.left_out_s.iter().enumerate();
        let out =
            out.flat_map(|(k, all)| all.iter().map(move |s| format!("the strike at {s:?} s{} left out", record(k))));
        let all: Vec<String> = missing.chain(out).collect();
        let all = if all.is_empty() { "no strike missing or left out".to_owned() } else { all.join(" and ") };
        let value = |quantity| self.estimates.iter().find(|estimate| estimate.quantity == quantity);
        let values =
            [Quantity::Restitution, Quantity::RestitutionA, Quantity::RadiusOfGyration].into_iter().filter_map(value);
        let values: Vec<String> = values
            .map(|estimate| {
                let (name, factor, unit) = estimate.quantity.said();
                format!("{name} {:.4} {unit}", factor * estimate.value).trim_end().to_owned()
            })
            .collect();
        let first = if self.first == End::A { "a" } else { "b" };
        format!("end {first} first, {all} ({})", values.join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bounces whose flights are 0.4, 0.2 and 0.1 s.
    fn found() -> Fit {
        super::super::bounces(&[1.0, 1.4, 1.6, 1.7], 9.81, Some(1e-4)).expect("times that rise")
    }

    #[test]
    fn intervals_hold_those_of_all_explanations() {
        for (own, other, joined) in [
            ([0.4, 0.5], [0.45, 0.6], [0.4, 0.6]),
            ([0.4, 0.5], [0.2, 0.45], [0.2, 0.5]),
            ([0.4, 0.5], [0.7, 0.8], [0.4, 0.8]),
        ] {
            let [mut fit, mut beside] = [found(), found()];
            fit.estimates[0].interval = Some(own);
            beside.estimates[0].interval = Some(other);
            // The restitution of one end alone counts as the restitution too, another quantity does not.
            beside.estimates[0].quantity = Quantity::RestitutionB;
            let height = fit.estimates[1].interval;
            join(&mut fit, vec![beside]);
            assert_eq!((fit.estimates[0].interval, fit.estimates[1].interval), (Some(joined), height));
            assert_eq!(fit.others.len(), 1);
            assert!(fit.notes[0].contains("other explanations are about as good"), "{:?}", fit.notes);
        }
    }

    #[test]
    fn what_tells_the_same_is_no_other_explanation() {
        let [fit, mut other] = [found(), found()];
        assert!(is_same(&fit, &other));
        other.estimates[0].value = fit.estimates[0].interval.expect("a timing is given")[1] + 1e-6;
        assert!(!is_same(&fit, &other));
        let mut other = found();
        other.records[0].strikes[1].number = None;
        assert!(!is_same(&fit, &other));
    }
}
