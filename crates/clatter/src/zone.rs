//! Peaks along the bar (Eq. 4) and safe zones (Eq. 5): where a threshold of velocity shock is not exceeded.

use crate::{Bar, End, Peak, PeakImpact, Start};

/// How much of the bar a safe zone covers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Extent {
    /// s < 0: even the center sees more than the threshold.
    None,
    /// 0 ≤ s < 1.
    Part,
    /// s ≥ 1: the whole bar.
    Whole,
}

/// Safe zone of a threshold, whichever end strikes first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Zone {
    /// Threshold of velocity shock, in v0.
    pub threshold: f64,
    /// Half-width from the center over half-length, as Eq. 5 gives it: not clipped.
    pub s: f64,
    /// What `s` means for the bar.
    pub extent: Extent,
}

/// Largest shocks of one train at the ends that are struck, by end: with end a striking first they differ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EndPeaks {
    /// Largest velocity shock of end a in its own strikes.
    pub a: f64,
    /// Largest velocity shock of end b in its own strikes; 0 if it never strikes.
    pub b: f64,
}

impl Bar {
    /// Largest velocity shock at distance `s` in [0, 1] from the center, whichever end strikes first (Eq. 4):
    /// `((1 − q) + s (1 + q))/2` of the peak at the ends; 0 for s = 0 at q = 1.
    ///
    /// # Accuracy
    /// [`crate::accuracy::PEAK`].
    #[must_use]
    pub fn peak_at(&self, start: &Start, s: f64) -> f64 {
        shock(self.share(s.abs()), self.peak(start).end)
    }

    /// Safe zone for `threshold`, whichever end strikes first (Eq. 5):
    /// `s = (2 threshold/peak + q − 1)/(1 + q)`.
    ///
    /// # Validity
    /// Any threshold ≥ 0; `s` may be negative or exceed 1, which [`Zone::extent`] says. NaN has no zone.
    ///
    /// # Accuracy
    /// 1e−12 of the larger of |s| and 1.
    ///
    /// # Examples
    /// Table 1 prints 28.8 % for the reference bar at v0 and "0 %" at v0/2, where no zone exists:
    /// ```
    /// use clatter::{Bar, Extent, Start};
    /// let bar = Bar::new(0.5, 0.3)?;
    /// assert!((bar.safe_zone(&Start::default(), 1.0).s - 0.288).abs() < 5e-4);
    /// assert_eq!(bar.safe_zone(&Start::default(), 0.5).extent, Extent::None);
    /// # Ok::<(), clatter::Error>(())
    /// ```
    #[must_use]
    pub fn safe_zone(&self, start: &Start, threshold: f64) -> Zone {
        let s = self.zone_of(threshold, self.peak(start).end);
        let extent = match s {
            s if s >= 1.0 => Extent::Whole,
            s if s >= 0.0 => Extent::Part,
            _ => Extent::None,
        };
        Zone { threshold, s, extent }
    }

    /// Eq. 5 for a known peak.
    pub(crate) fn zone_of(&self, threshold: f64, peak: f64) -> f64 {
        (2.0 * threshold / peak - self.less) / self.more
    }

    /// Largest velocity shocks of each end in its own strikes, end a striking first. The larger of both is
    /// [`Peak::end`]; the other is held by a neighboring impact, because |a_n| rises to its peak, then falls.
    #[must_use]
    pub fn end_peaks(&self, start: &Start) -> EndPeaks {
        let [(a, _), (b, _)] = self.struck_peaks(start);
        EndPeaks { a, b }
    }

    /// [`end_peaks`](Self::end_peaks) with the impacts that hold them; for an end that never strikes 0 and any impact.
    pub(crate) fn struck_peaks(&self, start: &Start) -> [(f64, PeakImpact); 2] {
        let Peak { end, impact, .. } = self.peak(start);
        let PeakImpact::Number(number) = impact else {
            return [(end, impact); 2]; // a limit, which both ends share
        };
        let skip = usize::try_from(number.saturating_sub(2)).unwrap_or(usize::MAX);
        let around = self.train(start).skip(skip).take(3).filter(|impact| impact.number != number);
        let struck = around.map(|impact| (-(1.0 + self.e()) * impact.approach, PeakImpact::Number(impact.number)));
        let beside = struck.fold((0.0, impact), |most, next| if next.0 > most.0 { next } else { most });
        if End::of_impact(number) == End::A { [(end, impact), beside] } else { [beside, (end, impact)] }
    }

    /// The interval of signed positions in [−1, 1] where no shock exceeds `threshold` if end `first` strikes first;
    /// `None` where there is none, as for a threshold of NaN. A strike at end a reaches position s with
    /// `((1 − q) − (1 + q) s)/2` of its shock (Eq. 3), one at end b with `((1 − q) + (1 + q) s)/2`, so each end bounds
    /// the interval on both sides.
    ///
    /// # Accuracy
    /// 1e−12.
    ///
    /// # Examples
    /// The uniform bar's largest strike is the second, at end b, so the safe interval leans towards end a:
    /// ```
    /// use clatter::{Bar, End, Start};
    /// let [lo, hi] = Bar::new(0.5, 0.3)?.safe_interval(&Start::default(), 1.0, End::A).unwrap();
    /// assert!(-lo > hi);
    /// # Ok::<(), clatter::Error>(())
    /// ```
    #[must_use]
    pub fn safe_interval(&self, start: &Start, threshold: f64, first: End) -> Option<[f64; 2]> {
        if threshold.is_nan() {
            return None; // max and min would pass over it
        }
        let EndPeaks { a, b } = self.end_peaks(start);
        // |(1 − q) ± (1 + q) s| ≤ 2 threshold/peak.
        let bounds = |peak: f64| {
            let reach = 2.0 * threshold / peak;
            [(-reach - self.less) / self.more, (reach - self.less) / self.more]
        };
        let ([b_lo, b_hi], [a_hi, a_lo]) = (bounds(b), bounds(a).map(|s| -s));
        let (lo, hi) = (a_lo.max(b_lo).max(-1.0), a_hi.min(b_hi).min(1.0));
        let interval = if first == End::A { [lo, hi] } else { [-hi, -lo] };
        (lo <= hi).then_some(interval)
    }
}

/// `share · peak`, where nothing of an infinite peak is nothing.
pub(crate) fn shock(share: f64, peak: f64) -> f64 {
    if share == 0.0 { 0.0 } else { share * peak }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Eq. 4 and the interval against the list of impacts, at any position.
        #[test]
        fn peaks_and_intervals_are_those_of_the_impacts(
            q in -0.9..0.95_f64, e in 0.05..0.95_f64, vb in -2.0..0.5_f64, s in -1.0..1.0_f64, threshold in 0.1..4.0_f64,
        ) {
            let (bar, start) = (Bar::new(q, e).unwrap(), Start::new([-1.0, vb], 1.0).unwrap());
            let worst = |s: f64| bar.train(&start).take(300).map(|i| i.delta_v_at(s).abs()).fold(0.0, f64::max);
            let either = worst(s).max(worst(-s));
            // Each impact carries a few roundings of its own, relative to the largest shock.
            let budget = 1e-13 * bar.peak(&start).end;
            let largest = bar.peak_at(&start, s);
            // Eq. 4 holds for the distance where the struck side's share is the larger one, always so for s ≥ 0.
            prop_assert!((either - largest).abs() <= budget, "{either} not {largest}");
            let peaks = bar.end_peaks(&start);
            prop_assert!((worst(-1.0).max(worst(1.0)) - peaks.a.max(peaks.b)).abs() <= budget, "ends");
            match bar.safe_interval(&start, threshold, End::A) {
                Some([lo, hi]) => {
                    prop_assert_eq!(bar.safe_interval(&start, threshold, End::B), Some([-hi, -lo]), "mirror image");
                    for safe in [lo, hi, 0.5 * (lo + hi)] {
                        prop_assert!(worst(safe) <= threshold + budget, "{safe} sees {}", worst(safe));
                    }
                    for beyond in [lo - 1e-9, hi + 1e-9] {
                        prop_assert!(beyond.abs() > 1.0 || worst(beyond) > threshold, "{beyond} sees no more");
                    }
                }
                None => prop_assert!(worst(s) > threshold - budget, "{s} would be safe"),
            }
        }
    }

    #[test]
    fn an_infinite_peak_leaves_the_center_alone() {
        let (bar, start) = (Bar::new(1.0, 1.0).unwrap(), Start::default());
        assert!(bar.peak_at(&start, 0.0).abs() < f64::MIN_POSITIVE, "not 0 · ∞");
        assert_eq!(bar.safe_interval(&start, 1.0, End::A), Some([0.0, 0.0]), "the center alone");
    }
}
