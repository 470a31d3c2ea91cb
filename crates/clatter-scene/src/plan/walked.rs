//! What one component has of the strikes followed, and what a lane gets wrong by them.

use super::STRIKES;
use super::floats::{greater, lesser};
use super::lag::{Lag, Off};
use super::pulse::Pulse;
use super::swing::Peak;

/// Later strikes that could add more than this share of the peak are not foreseen from the earlier ones.
const ROOM: f64 = 0.5;

/// One interval between strikes, as the lane with all physics has it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Interval {
    /// When it begins.
    pub(super) from_s: f64,
    /// Its largest value; the slope is below 0 where a shock begins the interval, above 0 where the next one ends it.
    pub(super) peak: Peak,
    /// Bound on how far all lanes are off beside what each is.
    pub(super) doubt: f64,
    /// By how much more it may ring where strikes are mistimed in all models.
    pub(super) adrift: f64,
    /// Bound on all that comes after it.
    pub(super) late: f64,
}

impl Interval {
    pub(super) const NONE: Self =
        Self { from_s: 0.0, peak: Peak { value: 0.0, phase: 0.0, slope: 0.0 }, doubt: 0.0, adrift: 0.0, late: 0.0 };
}

/// What one component has of the strikes followed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Walk {
    pub(super) intervals: [Interval; STRIKES],
    pub(super) strikes: usize,
    /// As [`after_all`](Self::after_all), from the strikes alone; what of it one more shock does.
    pub(super) late: f64,
    pub(super) extra: f64,
    /// Until when models need to be followed for nothing later to exceed the peak.
    pub(super) until_s: f64,
    pub(super) last_s: f64,
    pub(super) shortest_gap_s: f64,
    pub(super) overlaps: bool,
    /// What the weight does in the end, which no train has.
    pub(super) weight: f64,
    /// Bound on what impacts, one after the other at one instant, do on the way.
    pub(super) jumps: f64,
    pub(super) tilted: Lag,
    pub(super) stop: Stop,
    /// Whether the next strike comes while the last contact is still there.
    pub(super) near: bool,
}

/// The interval that holds the peak, and bounds on all that comes after each.
#[derive(Debug)]
pub(super) struct Lates {
    pub(super) highest: usize,
    pub(super) after: [f64; STRIKES],
}

/// The largest value, and what pulses leave of it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Top {
    pub(super) peak: f64,
    /// What pulses take, as a share, and the coefficients of the terms linear and quadratic in their phase.
    pub(super) smooth: f64,
    pub(super) phase: [f64; 2],
    pub(super) left: f64,
}

/// What impulses in place of pulses change at a peak, as a share of it, and the coefficients of the terms linear and
/// quadratic in the phase ωτ (for a peak inside the swing an approximation).
///
/// A pulse is an impulse at its centroid, spread by its variance: `½ σ² ω²` of a peak inside the swing, which bends by
/// itself. A peak that stands where the shock begins is reached when the pulse is over, `age` after the centroid, and
/// has fallen by then: `slope age + ½ (1 − 2ζ slope) age²`. One that the next shock cuts off is cut off within that
/// pulse.
pub(super) fn smoothing(pulse: &Pulse, turned: f64, peak: &Peak, zeta: f64) -> (f64, [f64; 2]) {
    let age = 1.0 - pulse.centroid;
    let half = 0.5 * pulse.variance;
    let slope = if peak.value > 0.0 { -peak.slope / peak.value } else { 0.0 };
    if slope < 0.0 {
        let linear = -slope * age.max(pulse.centroid);
        return (linear * turned + half * turned * turned, [linear, half]);
    }
    let late = 0.5 * age * age;
    if peak.phase > 0.0 {
        let early = late * (turned - peak.phase / age).max(0.0).powi(2);
        // A peak as early as this is one that stands at the shock.
        return (half * turned * turned + early, [0.0, if peak.phase < 0.5 { half + late } else { half }]);
    }
    let (linear, square) = (slope * age, half + late * (1.0 - 2.0 * zeta * slope).max(0.0));
    (linear * turned + square * turned * turned, [linear, square])
}

/// Why the strikes followed end where they do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Stop {
    /// No later one counts, none is foreseen, or as many were followed as by any look.
    Whole,
    /// A longer look would follow more.
    CutShort,
    /// Real tilt is off by more than the tolerance, which later strikes seldom mend.
    Off,
}

impl Walk {
    /// The interval that holds the peak.
    pub(super) fn highest(&self) -> usize {
        let higher = |most: usize, n: usize| {
            if self.intervals[n].peak.value > self.intervals[most].peak.value { n } else { most }
        };
        (0..self.strikes).fold(0, higher)
    }
    /// The highest of all.
    pub(super) fn peak(&self) -> Peak {
        self.intervals[self.highest()].peak
    }
    /// Bound on how far a lane is off the largest value of interval n.
    fn off(&self, lag: &Lag, n: usize) -> f64 {
        let (interval, off) = (&self.intervals[n], &lag.off[n]);
        let off = off.all + interval.doubt + if interval.peak.phase > 0.0 { 0.0 } else { off.beginning };
        if off.is_nan() { f64::INFINITY } else { off }
    }
    /// What a lane gets wrong, if pulses leave `top` of the peak: by the strikes followed, and by all.
    pub(super) fn errors(&self, lag: &Lag, top: f64, lates: &Lates) -> (f64, f64) {
        let highest = lates.highest;
        let (error, least) = self.followed(lag, top, lates);
        let later = self.later(lag, self.intervals[highest].peak.value, top);
        (lesser(least, error), lesser(least, greater(later, error)))
    }
    /// What no interval of real tilt is off by more than.
    pub(super) fn off_at_most(&self) -> f64 {
        let of = |(off, interval): (&Off, &Interval)| {
            greater(off.all + off.beginning + interval.doubt, off.early - interval.peak.value)
        };
        self.tilted.off.iter().zip(&self.intervals[..self.strikes]).map(of).fold(0.0, |most, off| greater(off, most))
    }
    /// Bound on the response, or shock, after the strikes followed; none where what the next strike does to a contact
    /// that is still there belongs to the last one.
    pub(super) fn after_all(&self) -> f64 {
        if self.stop == Stop::CutShort && self.near { f64::INFINITY } else { self.late }
    }
    /// Bounds on all that comes after the intervals.
    pub(super) fn lates(&self) -> Lates {
        let (mut after, mut most) = ([0.0; STRIKES], self.after_all());
        for (late, interval) in after.iter_mut().zip(&self.intervals[..self.strikes]).rev() {
            most = greater(interval.late, most);
            *late = most;
        }
        Lates { highest: self.highest(), after }
    }
    /// What a lane gets wrong by the strikes followed, and what it gets wrong at most if what follows some interval is
    /// left to its bound.
    #[inline]
    pub(super) fn followed(&self, lag: &Lag, top: f64, lates: &Lates) -> (f64, f64) {
        let (mut error, mut least) = (self.off(lag, lates.highest), f64::INFINITY);
        let peak_s = self.intervals[lates.highest].from_s;
        for (n, interval) in self.intervals[..self.strikes].iter().enumerate() {
            // Another that comes up to the top may be the higher one.
            let short = lesser(interval.peak.value + interval.adrift - top, 0.0);
            error = greater(lag.off[n].early - top, greater(self.off(lag, n) + short, error));
            // From the peak on, what follows may be left to its bound.
            if interval.from_s >= peak_s {
                least = lesser(greater(lates.after[n] - top, error), least);
            }
        }
        (error, least)
    }
    /// What a lane may get wrong after the strikes followed.
    fn later(&self, lag: &Lag, peak: f64, top: f64) -> f64 {
        if self.stop == Stop::CutShort {
            // Pulses need not flatten what comes as they do the peak, and what is fitted is fitted to all strikes.
            return self.after_all() - top;
        }
        let above = self.after_all() - peak;
        // The map has no later strikes; the others have them, about.
        if above <= 0.0 || lag.is_map || self.extra >= ROOM * peak {
            return above;
        }
        let of_intervals = || lag.off.iter().zip(&self.intervals[..self.strikes]).map(|(off, i)| off.all + i.doubt);
        let (worst, last) = of_intervals().fold((0.0, 0.0), |(worst, _), off| (greater(off, worst), off));
        // Fitted: what later strikes add is off by 4 times what the earlier ones were.
        let share = if lag.alive { 4.0 * (worst / peak).min(1.0) } else { 4.0 };
        above.min(share * self.extra + self.weight + last)
    }
}
