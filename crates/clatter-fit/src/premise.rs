//! This module lists the assumptions about a record of strikes: which of them are none, or missing.

use clatter::End;

use super::criterion::Faults;
use super::drop::{DIFFERENCE, SPEED};
use super::{MeasuredStrike, Which};

/// More strikes than these can tell both ends apart and that they do.
const ENOUGH_FOR_BOTH: usize = 6;
/// Strikes may be missing before so many of the first measured ones.
const PLACES: usize = 16;

/// The assumptions about a drop and its record.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Premise {
    /// Measured strikes, from 0, before each of which a computed one is missing.
    pub(super) missing: Vec<usize>,
    /// A measured strike that is left out, and whether it is one at a wrong time; else it is none at all.
    pub(super) left_out: Option<(usize, bool)>,
    /// An unknown that is free although the product file or a simpler product has it otherwise.
    pub(super) freed: Option<usize>,
    /// The number of ways in which that many strikes may be dropped or invented.
    ways: usize,
}

impl Premise {
    pub(super) fn faults(&self) -> Faults {
        #[expect(clippy::cast_precision_loss, reason = "some hundred")]
        let ln_ways = libm::log(self.ways.max(1) as f64);
        Faults { count: self.missing.len() + usize::from(self.left_out.is_some()), ln_ways }
    }

    /// Returns for each measured strike the computed one that it is: in the order of its end where all ends are known, else in that of all.
    pub(super) fn index(&self, strikes: &[MeasuredStrike]) -> Vec<Option<Which>> {
        let ends_known = strikes.iter().all(|strike| strike.end.is_some());
        let mut next = [0; 2];
        let one = |(k, strike): (usize, &MeasuredStrike)| {
            let end = strike.end.filter(|_| ends_known);
            let count = &mut next[usize::from(end == Some(End::B))];
            *count += self.missing.iter().filter(|place| **place == k).count();
            let is_out = self.left_out.filter(|(out, _)| *out == k);
            let now = *count;
            *count += is_out.map_or(1, |(_, is_strike)| usize::from(is_strike));
            is_out.is_none().then(|| end.map_or(Which::Of(now), |end| Which::OfEnd(end, now)))
        };
        strikes.iter().enumerate().map(one).collect()
    }

    /// Returns the premises with all of so many strikes and one more free unknown.
    pub(super) fn freed(count: usize) -> Vec<Self> {
        let freed = [SPEED, DIFFERENCE].into_iter().filter(|&unknown| unknown != DIFFERENCE || count > ENOUGH_FOR_BOTH);
        freed.map(|unknown| Self { freed: Some(unknown), ..Self::default() }).collect()
    }

    /// Returns the other premises for so many strikes, in the order in which they are tried: one strike missing or wrong, then two missing.
    /// The odd strike is among the first `reach`, which do not go together, or it is the single time that is off, `outlier`.
    pub(super) fn rounds(count: usize, reach: usize, outlier: Option<usize>) -> [Vec<Self>; 2] {
        let all = count.min(PLACES);
        let places = all.min(reach.max(1));
        let wrong = (0..places)
            .flat_map(|k| [true, false].map(|is_strike| (k, is_strike)))
            .filter(|wrong| *wrong != (count - 1, false))
            .chain(outlier.filter(|k| *k >= places).map(|k| (k, true)));
        let ways = 2 * all + usize::from(outlier.is_some_and(|k| k >= all));
        let wrong = wrong.map(|left_out| Self { left_out: Some(left_out), ways, ..Self::default() });
        let one = (0..places).map(|k| Self { missing: vec![k], ways: all, ..Self::default() });
        let pairs = (0..places).flat_map(|k| (k..all).map(move |j| vec![k, j]));
        let ways = all * (all + 1) / 2;
        let two = pairs.map(|missing| Self { missing, ways, ..Self::default() });
        [wrong.chain(one).collect(), two.collect()]
    }

    /// Returns the premise that one time is wrong, of so many strikes.
    pub(super) fn wrong(count: usize, outlier: usize) -> Self {
        Self { left_out: Some((outlier, true)), ways: count, ..Self::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A choice among many ways pays for at least as many.
    #[test]
    fn as_many_ways_are_paid_for_as_there_are() {
        for count in [3, 8, 40] {
            for outlier in [None, Some(count - 1)] {
                let [one, two] = Premise::rounds(count, count, outlier);
                let is_missing = |premise: &&Premise| premise.left_out.is_none();
                let places = count.min(PLACES);
                assert_eq!(two[0].ways, places * (places + 1) / 2, "{count}");
                assert_eq!(two.len(), two[0].ways, "{count}");
                let (missing, out): (Vec<&Premise>, Vec<&Premise>) = one.iter().partition(is_missing);
                assert!(missing.len() == missing[0].ways && out.len() <= out[0].ways, "{count}");
                assert!(out.len() + 1 >= out[0].ways);
            }
        }
        assert!((Premise::rounds(8, 8, None)[1][0].faults().ln_ways - 36_f64.ln()).abs() < 1e-15);
    }

    /// A strike at a wrong time is one of the computed, a strike that is none is not.
    #[test]
    fn computed_strikes_are_counted_past_what_is_left_out() {
        let strikes: Vec<MeasuredStrike> = (0..4).map(|k| MeasuredStrike { time_s: f64::from(k), end: None }).collect();
        let index = |premise: Premise| premise.index(&strikes);
        let of = |all: [Option<usize>; 4]| all.map(|n| n.map(Which::Of)).to_vec();
        assert_eq!(index(Premise::default()), of([Some(0), Some(1), Some(2), Some(3)]));
        let wrong = Premise { left_out: Some((1, true)), ..Premise::default() };
        assert_eq!(index(wrong), of([Some(0), None, Some(2), Some(3)]));
        let none = Premise { left_out: Some((1, false)), ..Premise::default() };
        assert_eq!(index(none), of([Some(0), None, Some(1), Some(2)]));
        let missing = Premise { missing: vec![1, 1], ..Premise::default() };
        assert_eq!(index(missing), of([Some(0), Some(3), Some(4), Some(5)]));
    }
}
