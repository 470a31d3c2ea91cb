//! The largest shocks at every position (Eq. 4), the safest place and safe zones (Eq. 5): where a threshold of velocity
//! shock is not exceeded.
//!
//! # The safest place
//! A strike at end a that changes the velocity there by A reaches a point at distance x from the center of mass
//! (towards b positive) with `A (ρ² − L_a x)/I_a`, one at end b with `B (ρ² + L_b x)/I_b`. With A and B the largest of
//! each end, the largest shock at x is f(x) = max(|A (ρ² − L_a x)|/I_a, |B (ρ² + L_b x)|/I_b), a convex function.
//! Between the two centers of percussion, x = −ρ²/L_b and ρ²/L_a, the first falls and the second rises, from 0 to 0 the
//! other way round, so they meet there, and where a falling and a rising piece of a convex function meet is its least
//! value:
//!
//! ```text
//! x = ρ² (α − β)/(α L_a + β L_b),   f(x) = α β ρ² (L_a + L_b)/(α L_a + β L_b),   α = A/I_a, β = B/I_b
//! ```
//!
//! If that is beyond an end, the end is the safest place, by convexity. The middle is safest only where α = β and
//! L_a = L_b: for a symmetric bar of which either end may strike first.

use crate::symmetric::Symmetric;
use crate::{Bar, End, Peak, PeakImpact, Start};

/// The share of the bar that a safe zone covers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Extent {
    /// s < 0: even the safest place, the center of a symmetric bar, gets more than the threshold.
    None,
    /// 0 ≤ s < 1.
    Part,
    /// s ≥ 1: the whole bar.
    Whole,
}

/// Safe zone of a threshold, whichever end strikes first.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Zone {
    /// Threshold of velocity shock, in v0.
    pub threshold: f64,
    /// Half-width over half-length, as Eq. 5 gives it: not clipped.
    pub s: f64,
    /// The share of the bar that `s` stands for.
    pub extent: Extent,
}

/// Largest shocks of one train at the ends that are struck, by end: with end a striking first they differ.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct EndPeaks {
    /// Largest velocity shock of end a in its own strikes.
    pub a: f64,
    /// Largest velocity shock of end b in its own strikes; 0 if it never strikes.
    pub b: f64,
}

impl Symmetric {
    /// Returns the largest velocity shocks of ends a and b in their own strikes, end a striking first, and the impacts
    /// that hold them; for an end that never strikes 0 and any impact. The larger of both is [`Peak::end`]; the other
    /// is held by a neighboring impact, because |a_n| rises to its peak, then falls.
    pub(crate) fn struck_peaks(&self, start: &Start) -> [(f64, PeakImpact); 2] {
        let Peak { end, impact, .. } = self.peak(start);
        let PeakImpact::Number(number) = impact else {
            return [(end, impact); 2]; // a limit, which both ends share
        };
        let skip = usize::try_from(number.saturating_sub(2)).unwrap_or(usize::MAX);
        let around = self.train(start).skip(skip).take(3).filter(|impact| impact.number != number);
        let struck = around.map(|impact| (-(1.0 + self.e) * impact.approach, PeakImpact::Number(impact.number)));
        let beside = struck.fold((0.0, impact), |most, next| if next.0 > most.0 { next } else { most });
        if End::striking(number) == End::A { [(end, impact), beside] } else { [beside, (end, impact)] }
    }
}

impl Bar {
    /// Returns the largest shocks of one train, everywhere on the bar. The velocities of the start are those of the end
    /// `first` and then of the other.
    #[must_use]
    pub fn shocks(&self, start: &Start, first: End) -> Shocks {
        let peaks = match first {
            End::A => self.struck(start),
            End::B => {
                let EndPeaks { a, b } = self.exchanged().struck(start);
                EndPeaks { a: b, b: a }
            }
        };
        Shocks { bar: *self, peaks }
    }

    /// Returns the largest shocks whichever end strikes first.
    #[must_use]
    pub fn shocks_either(&self, start: &Start) -> Shocks {
        let first = self.struck(start);
        // With its ends exchanged a symmetric bar is the same.
        let second = if self.is_symmetric() { first } else { self.exchanged().struck(start) };
        Shocks { bar: *self, peaks: EndPeaks { a: first.a.max(second.b), b: first.b.max(second.a) } }
    }

    fn struck(&self, start: &Start) -> EndPeaks {
        let [(a, _), (b, _)] = self.symmetric.struck_peaks(&self.arrival(start));
        EndPeaks { a, b: b / self.kappa() }
    }
}

/// The largest shocks on a bar, at every position: of one train, or of the trains after either end has struck first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shocks {
    bar: Bar,
    peaks: EndPeaks,
}

/// The position where the largest shock is least.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Safest {
    /// Position in [−1, 1].
    pub s: f64,
    /// Largest velocity shock there.
    pub shock: f64,
}

impl Shocks {
    /// Returns the largest shocks of each end in its own strikes.
    #[must_use]
    pub fn struck(&self) -> EndPeaks {
        self.peaks
    }

    /// Returns the largest velocity shock at position s in [−1, 1]: `((1 − q) + |s| (1 + q))/2` of the peak at the ends
    /// for a symmetric bar of which either end may strike first (Eq. 4).
    ///
    /// # Accuracy
    /// 1e−12 of the larger of A and B.
    #[must_use]
    pub fn at(&self, s: f64) -> f64 {
        let of = |end: End, peak: f64| shock(self.bar.share(end, s).abs(), peak);
        of(End::A, self.peaks.a).max(of(End::B, self.peaks.b))
    }

    /// Returns the position with the least largest shock, and that shock (formula and proof in the module).
    ///
    /// # Examples
    /// For a symmetric bar it is the middle, if either end may strike first. If end a does, it leans away from the end
    /// with the hardest strike, here b.
    /// ```
    /// use clatter::{Bar, End, Start};
    /// let bar = Bar::new(0.5, 0.3)?;
    /// let safest = bar.shocks_either(&Start::default()).safest();
    /// assert_eq!(safest.s, 0.0);
    /// assert!((safest.shock - 0.53625).abs() < 1e-12);
    /// assert!(bar.shocks(&Start::default(), End::A).safest().s < 0.0);
    /// // Bring the center of mass towards b, and the safest place follows it, but not all the way.
    /// let bar = Bar::from_center_of_mass(0.3, bar.gyration_ratio(), 0.3)?;
    /// let safest = bar.shocks_either(&Start::default()).safest();
    /// assert!(safest.s > 0.1 && safest.s < 0.3);
    /// # Ok::<(), clatter::Error>(())
    /// ```
    #[must_use]
    pub fn safest(&self) -> Safest {
        let EndPeaks { a, b } = self.peaks;
        // Two infinite peaks (q = e = 1) grow alike.
        let (a, b) = if a.is_infinite() || b.is_infinite() { (1.0, 1.0) } else { (a, b) };
        let Bar { center, turn, .. } = self.bar;
        let x = (a * center[0] - b * center[1]) / (a * turn[0] + b * turn[1]);
        let s = (self.bar.center_of_mass() + x).clamp(-1.0, 1.0);
        Safest { s, shock: self.at(s) }
    }

    /// Returns the positions in [−1, 1] where no shock exceeds `threshold`: an interval, because the largest shock is a
    /// convex function of the position; `None` where there are none, as for NaN.
    ///
    /// # Accuracy
    /// 1e−12.
    ///
    /// # Examples
    /// The uniform bar's largest strike is the second, at end b, so the safe interval leans towards end a:
    /// ```
    /// use clatter::{Bar, End, Start};
    /// let [lo, hi] = Bar::new(0.5, 0.3)?.shocks(&Start::default(), End::A).safe_interval(1.0).unwrap();
    /// assert!(-lo > hi);
    /// # Ok::<(), clatter::Error>(())
    /// ```
    #[must_use]
    pub fn safe_interval(&self, threshold: f64) -> Option<[f64; 2]> {
        let [lo, hi] = self.bounds(threshold);
        (lo <= hi && lo <= 1.0 && hi >= -1.0).then(|| [lo.max(-1.0), hi.min(1.0)])
    }

    /// Returns the safe zone as a width: `s` is half that of the interval between its bounds, not clipped at the ends,
    /// in half-lengths, below 0 where even the safest place sees more. For a symmetric bar of which either end may
    /// strike first it is `(2 threshold/peak + q − 1)/(1 + q)` (Eq. 5).
    ///
    /// # Accuracy
    /// 1e−12 of the larger of |s| and 1.
    ///
    /// # Examples
    /// Table 1 prints 28.8 % for the reference bar at v0 and "0 %" at v0/2, where no zone exists:
    /// ```
    /// use clatter::{Bar, Extent, Start};
    /// let shocks = Bar::new(0.5, 0.3)?.shocks_either(&Start::default());
    /// assert!((shocks.safe_zone(1.0).s - 0.288).abs() < 5e-4);
    /// assert_eq!(shocks.safe_zone(0.5).extent, Extent::None);
    /// # Ok::<(), clatter::Error>(())
    /// ```
    #[must_use]
    pub fn safe_zone(&self, threshold: f64) -> Zone {
        let [lo, hi] = self.bounds(threshold);
        let extent = match self.safe_interval(threshold) {
            None => Extent::None,
            Some(_) if lo <= -1.0 && hi >= 1.0 => Extent::Whole,
            Some(_) => Extent::Part,
        };
        Zone { threshold, s: 0.5 * (hi - lo), extent }
    }

    /// Returns the positions where |share · peak| reaches the threshold on either side, for the strikes of both ends.
    fn bounds(&self, threshold: f64) -> [f64; 2] {
        let (Bar { center, turn, .. }, c) = (self.bar, self.bar.center_of_mass());
        let reach = [threshold / self.peaks.a, threshold / self.peaks.b];
        let lo = ((center[0] - reach[0]) / turn[0]).max((-reach[1] - center[1]) / turn[1]);
        let hi = ((reach[1] - center[1]) / turn[1]).min((center[0] + reach[0]) / turn[0]);
        [c + lo, c + hi]
    }
}

/// Returns `share · peak`, and 0 for a share of 0 even if the peak is infinite.
pub(crate) fn shock(share: f64, peak: f64) -> f64 {
    if share == 0.0 { 0.0 } else { share * peak }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Compares Eq. 4 and the interval with the list of impacts, at any position.
        #[test]
        fn peaks_and_intervals_are_those_of_the_impacts(
            q in -0.9..0.95_f64, e in 0.05..0.95_f64, vb in -2.0..0.5_f64, s in -1.0..1.0_f64, threshold in 0.1..4.0_f64,
        ) {
            let (bar, start) = (Bar::new(q, e).unwrap(), Start::new([-1.0, vb], 1.0).unwrap());
            let worst = |s: f64| bar.train(&start).take(300).map(|i| i.delta_v_at(s).abs()).fold(0.0, f64::max);
            let either = worst(s).max(worst(-s));
            // Each impact carries a few roundings of its own, relative to the largest shock.
            let budget = 1e-13 * bar.peak(&start).end;
            let shocks = bar.shocks_either(&start);
            let largest = shocks.at(s);
            // Eq. 4 holds for the distance where the struck side's share is the larger one, always so for s ≥ 0.
            prop_assert!((either - largest).abs() <= budget, "{either} not {largest}");
            let [first, second] = [End::A, End::B].map(|first| bar.shocks(&start, first));
            let peaks = first.struck();
            prop_assert!((worst(-1.0).max(worst(1.0)) - peaks.a.max(peaks.b)).abs() <= budget, "ends");
            match first.safe_interval(threshold) {
                Some([lo, hi]) => {
                    prop_assert_eq!(second.safe_interval(threshold), Some([-hi, -lo]), "mirror image");
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
        assert!(bar.shocks_either(&start).at(0.0).abs() < f64::MIN_POSITIVE, "not 0 · ∞");
        assert_eq!(bar.shocks(&start, End::A).safe_interval(1.0), Some([0.0, 0.0]), "the center alone");
    }
}
