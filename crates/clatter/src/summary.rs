//! Summaries of a train: count, peak, net change, final velocities, duration.

use crate::motion::{Digits, Drive, Ending, Largest, NORMAL, after_first, rebound, rest, rises};
use crate::symmetric::Symmetric;
use crate::zone::shock;
use crate::{Bar, Start};

/// The number of impacts of a train.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Count {
    /// The exact number of impacts.
    Finite(u64),
    /// A finite number beyond 2⁶⁴: the nearest float.
    Huge(f64),
    /// The impacts never end, in finite or infinite time.
    Endless,
}

/// The impact that holds the peak.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum PeakImpact {
    /// Impact number, from 1; the first if several tie.
    Number(u64),
    /// An impact beyond number 2⁶⁴: the nearest float.
    Huge(f64),
    /// No impact attains the peak: the shocks tend to it.
    Limit,
}

/// The largest velocity shocks of the train (Eq. 4 of the paper), all held by the same impact where the center of mass
/// is the middle.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Peak {
    /// Largest velocity shock at a struck end, (1 + e) max |a_n|; may be infinite (q = e = 1).
    pub end: f64,
    /// The impact that holds it; where the center of mass is not the middle, any of those that are equal but for
    /// roundings.
    pub impact: PeakImpact,
    /// Largest velocity shock of the center of mass, (1 − q)/2 · `end` where that is the middle; 0 at q = 1.
    pub center: f64,
    /// Largest change of angular velocity, (1 + q)/2 · `end` where the center of mass is the middle, in v0/L.
    pub angular: f64,
}

/// Sum of all velocity shocks, from before the first to after the last impact.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Net {
    /// Net change at end a.
    pub a: f64,
    /// Net change at end b.
    pub b: f64,
    /// Net change at the center of mass.
    pub center: f64,
    /// Net change of the angular velocity, in v0/L.
    pub angular: f64,
}

/// The results about a train that need no list of its impacts.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Summary {
    /// Number of impacts.
    pub count: Count,
    /// Time of the last impact, or the limit it tends to; may be infinite.
    pub duration: f64,
    /// Largest velocity shocks.
    pub peak: Peak,
    /// Final velocities of ends a and b; `None` where they do not settle (q = 1).
    pub final_velocity: Option<[f64; 2]>,
    /// Sum of all velocity shocks; `None` with `final_velocity`.
    pub net: Option<Net>,
}

/// The number of plain steps before the closed form, which is no faster for a train of so many.
const PLAIN: u32 = 32;
/// A velocity that came out of a cancellation by more than this factor is left to the closed form. Of a wave with N
/// impacts, N steps add up to 1.3 N² roundings of its amplitude, of which the last velocities are π/N times this factor
/// at least: 1.3 N³/π · 2⁻⁵³ · 2⁹ ≤ 8e−10 for N ≤ 32.
const CLEAR: f64 = 1.0 / 512.0;
/// Neighbors of the peak that differ by less are compared with more digits.
const DISTINCT: f64 = 1e-12;
/// 4e − T² in plain floats has this many digits to spare in its square root, and its sign, beyond this share of T².
const DISCERNIBLE: f64 = 1e-6;
/// sin²(π/32.5): a wave that turns by less a strike takes more than 32 strikes from pure translation.
const SLOW: f64 = 0.009_315;

/// A train that plain steps followed to its end.
struct Short {
    end: Ending,
    peak: Largest,
    /// True if nothing about its end is in doubt.
    clear: bool,
    /// True if the impact that holds the peak is not in doubt either.
    distinct: bool,
}

/// Returns the lesser of two numbers, neither of them NaN: one instruction, where `f64::min` takes five.
#[inline]
pub(crate) fn least(x: f64, y: f64) -> f64 {
    if x < y { x } else { y }
}

impl Bar {
    /// Returns the count, peak, net change, final velocities and duration of the train, end a first, in constant time.
    ///
    /// # Method
    /// Up to 32 plain steps of the recurrence `a_{n+1} = T a_n − e a_{n−1}`, T = q(1 + e), where they leave nothing
    /// in doubt; else its closed form. The sign of the discriminant is always certain: double-double with an error
    /// bound, and integers where that bound is not met. A count is the quotient of two angles (or logarithms) rounded
    /// up: taken from f64 where it is more than 24 roundings away from an integer, else from double-double angles
    /// (about 85 bits) where it is clear of its error there, else from the signs of the recurrence in whole integers,
    /// which also settle exact ties.
    ///
    /// # Accuracy
    /// The count and whether the train is endless are exact for every input, as is the impact that holds the peak where
    /// the center of mass is the middle; beyond 2⁶⁴ they are the nearest float. The errors of the rest are at most those
    /// of [`crate::accuracy`], as long as no velocity is so small (2⁻¹⁰²² and below) that floats have no digits left for
    /// it.
    ///
    /// # Cost
    /// Compared with the plain loop (bench `speed`): 0.9 to 1.3 times its time where it ends, on average over the
    /// unit square, and for up to 4 impacts; for a longer train the time of some 130 impacts of that loop, or of 200 to
    /// 250 where double-double is needed (N beyond 10⁷, or next to the endless curve). Where integers decide,
    /// microseconds to a millisecond for a start next to a tie, and one to a hundred milliseconds to decide which impact
    /// is the largest of more than 10¹⁴ (gyration ratios below 10⁻¹⁴).
    #[must_use]
    #[expect(clippy::inline_always, reason = "a bar that is made on the spot then needs no place in memory")]
    #[inline(always)]
    pub fn summary(&self, start: &Start) -> Summary {
        if self.is_symmetric() { self.symmetric.summary(start) } else { Self::off_center_summary(*self, *start) }
    }

    #[inline(never)]
    fn off_center_summary(self, start: Start) -> Summary {
        let symmetric = self.symmetric.summary(&self.arrival(&start));
        let final_velocity = symmetric.final_velocity.map(|[a, b]| [a, b / self.kappa()]);
        let ([va, vb], [arm_a, arm_b]) = (start.velocity(), self.arms());
        let net = final_velocity.map(|[a, b]| {
            let (a, b) = (a - va, b - vb);
            Net { a, b, center: 0.5 * (arm_b * a + arm_a * b), angular: 0.5 * (b - a) }
        });
        Summary { peak: self.off_center_peak(&start), final_velocity, net, ..symmetric }
    }

    /// Returns the number of impacts alone, as exact as in [`summary`](Self::summary), in a fraction of its time: that
    /// of the plain loop for a short train, of some 70 impacts of it for a train of any length. Beyond 2⁶⁴ it is a
    /// float, off by no more than its last digit.
    ///
    /// Where the bar is given by masses, [`count_is_exact`](Self::count_is_exact) returns whether the count is theirs.
    ///
    /// # Examples
    /// This bar is exactly on the endless curve, T = 1 = 2√e. With the next larger e it is not: D = 4e − T² is then 2.4
    /// times what e has gained, and the train has some π/√D impacts.
    /// ```
    /// use clatter::{Bar, Count, Start};
    /// let count = |e| Bar::from_arms([2.0, 5.5], 1.0, e).unwrap().count(&Start::default());
    /// assert_eq!(count(0.25), Count::Endless);
    /// assert_eq!(count(0.25_f64.next_up()), Count::Finite(272_178_700));
    /// ```
    #[must_use]
    #[inline]
    pub fn count(&self, start: &Start) -> Count {
        if self.is_symmetric() { self.symmetric.count(start) } else { self.off_center_count(start) }
    }

    #[inline(never)]
    fn off_center_count(&self, start: &Start) -> Count {
        self.symmetric.count(&self.arrival(start))
    }

    /// Returns the largest velocity shocks alone, those of [`summary`](Self::summary).
    ///
    /// The peak is the largest shock of an end in its own strikes; those of the center of mass and of the angular
    /// velocity are the largest that any strike gives, not always that same one. The largest shock of every position,
    /// ends included, is in [`shocks`](Self::shocks).
    #[must_use]
    pub fn peak(&self, start: &Start) -> Peak {
        if self.is_symmetric() { self.symmetric.peak(start) } else { self.off_center_peak(start) }
    }

    fn off_center_peak(&self, start: &Start) -> Peak {
        let [(a, at_a), (b, at_b)] = self.symmetric.struck_peaks(&self.arrival(start));
        let struck = [a, b / self.kappa()];
        let largest = |shares: [f64; 2]| shock(shares[0], struck[0]).max(shock(shares[1], struck[1]));
        let impact = if struck[1] > struck[0] { at_b } else { at_a };
        Peak { end: struck[0].max(struck[1]), impact, center: largest(self.center), angular: largest(self.turn) }
    }
}

impl Symmetric {
    #[expect(clippy::inline_always, reason = "a bar that is made on the spot then needs no place in memory")]
    #[inline(always)]
    pub(crate) fn summary(&self, start: &Start) -> Summary {
        if self.may_be_short(start) {
            let Short { end, peak, clear, distinct } = self.steps(start);
            if clear && distinct {
                return self.put(start, end, peak);
            }
        }
        Self::long_summary(*self, *start)
    }

    /// Computes the summary by the closed form. It takes copies, so that a bar and a start whose train is short need no
    /// place in memory.
    #[inline(never)]
    fn long_summary(self, start: Start) -> Summary {
        let peak = self.plain_peak(&start);
        let (end, peak) = if let (Some(end), Some(peak)) = (self.endless(&start), peak) {
            (end, peak)
        } else if self.t <= 0.0 || self.e == 0.0 {
            let (end, special) = self.special(&start);
            (end, peak.unwrap_or(special))
        } else {
            let drive = Drive::new(&self, &start, if peak.is_some() { Digits::ENDING } else { Digits::ALL });
            (drive.ending(), peak.unwrap_or_else(|| drive.peak()))
        };
        self.put(&start, end, peak)
    }

    #[inline(always)]
    #[expect(clippy::inline_always, reason = "as `steps`")]
    pub(crate) fn count(&self, start: &Start) -> Count {
        if self.may_be_short(start) {
            let Short { end, clear, .. } = self.steps(start);
            if clear {
                return end.count;
            }
        } else if self.endless(start).is_some() {
            return Count::Endless;
        }
        self.long_count(start)
    }

    #[inline(never)]
    fn long_count(&self, start: &Start) -> Count {
        if self.t <= 0.0 || self.e == 0.0 {
            self.special(start).0.count
        } else {
            Drive::new(self, start, Digits::COUNT).count()
        }
    }

    pub(crate) fn peak(&self, start: &Start) -> Peak {
        if self.may_be_short(start) {
            let Short { peak, clear, distinct, .. } = self.steps(start);
            if clear && distinct {
                return self.spread(peak);
            }
        }
        match self.plain_peak(start) {
            Some(peak) => self.spread(peak),
            None if self.t <= 0.0 || self.e == 0.0 => self.spread(self.special(start).1),
            None => self.spread(Drive::new(self, start, Digits::ALL).peak()),
        }
    }

    /// Returns whether plain steps are worth a try.
    #[inline]
    fn may_be_short(&self, start: &Start) -> bool {
        let (t, e) = (self.t, self.e);
        let [va, vb] = start.velocity();
        let d = 4.0 * e - t * t;
        // They are not for T ≤ 0, e = 0, and a start that cancels, at once or, as a decay does, at every step.
        t * e > NORMAL
            && if vb > 0.0 {
                d >= DISCERNIBLE * t * t && (t * va + vb).abs() >= CLEAR * -va * t
            } else {
                d >= 4.0 * SLOW * e
            }
    }

    /// Returns the end of a train that is endless without a doubt.
    fn endless(&self, start: &Start) -> Option<Ending> {
        let (t, e) = (self.t, self.e);
        let [va, vb] = start.velocity();
        let d = 4.0 * e - t * t;
        (t * e > NORMAL && vb <= 0.0 && d < -DISCERNIBLE * t * t).then(|| {
            let time = start.height_gap() / (0.5 * (t + (-d).sqrt()) * -va - vb);
            Ending { count: Count::Endless, time, velocity: rest(self, start) }
        })
    }

    /// Follows the train for at most 32 plain steps.
    #[expect(
        clippy::inline_always,
        reason = "the whole summary of a short train takes 15 ns; a call would add a third"
    )]
    #[inline(always)]
    fn steps(&self, start: &Start) -> Short {
        let (t, e) = (self.t, self.e);
        let [va, vb] = start.velocity();
        let first = t * va + vb;
        let (mut before, mut a, mut next, mut b, mut b_next, mut n) = (0.0, va, first, 0.0, 1.0, 1_u32);
        // The lowest velocity so far, its impact, and how close any two neighbors came to each other.
        let (mut lowest, mut peak, mut margin) = (va, 1, f64::MAX);
        // |a_n| falls for good once it falls, so that a comparison of neighbors decides.
        let mut compare = |before: f64, velocity: f64, number: u32| {
            let above = velocity - before;
            peak = if above < 0.0 { number } else { peak };
            (lowest, margin) = (least(velocity, lowest), least(above.abs(), margin));
        };
        if vb <= 0.0 {
            // A branch predictor cannot know the last impact: two, three or four of them go without a branch. A second
            // one is certain, and a_3 < 0 comes after a_2 < 0 alone, so that no step too many moves the peak.
            let second = t * first - e * va;
            let third = t * second - e * first;
            let fourth = t * third - e * second;
            let twice = t * t - e;
            let more = usize::from(second < 0.0) + usize::from(third < 0.0);
            let strikes = [va, first, second, third, fourth];
            (before, a, next) = (strikes[more], strikes[more + 1], strikes[more + 2]);
            (b, b_next) = ([1.0, t, twice][more], t * twice - e * t);
            n = 2 + u32::from(second < 0.0) + u32::from(third < 0.0);
            compare(va, first, 2);
            compare(first, second, 3);
            compare(least(second, 0.0), third, 4);
        }
        while next < 0.0 && n < PLAIN {
            n += 1;
            compare(a, next, n);
            (before, a, next) = (a, next, t * next - e * a);
            (b, b_next) = (b_next, t * b_next - e * b);
        }
        // It is less than a_N and |a_{N−1}|, so that these too are above the range of subnormal floats. For N = 1, b
        // and a_{N−2} are 0.
        let cancels = least(next + CLEAR * e * before, CLEAR * t * before - a);
        let clear = cancels > NORMAL && (n < 2 || b > NORMAL);
        let time = start.height_gap() * (b / -a);
        let velocity = Some(rebound(self, n % 2 == 1, a, next));
        Short {
            end: Ending { count: Count::Finite(u64::from(n)), time, velocity },
            peak: (PeakImpact::Number(u64::from(peak)), -lowest),
            clear,
            distinct: margin > DISTINCT * -lowest,
        }
    }

    /// Returns the peak, where at most 32 plain steps leave nothing in doubt. The steps follow d = |a_{n+1}| − |a_n|,
    /// which obeys `d ← e d − (1 − q)(1 + e) |a|` and falls below zero at the peak.
    #[inline]
    fn plain_peak(&self, start: &Start) -> Option<Largest> {
        let [va, vb] = start.velocity();
        let (e, w) = (self.e, self.less * (1.0 + self.e));
        let (mut a, mut d) = (-va, -va * (e - w) - vb);
        // d falls no faster than this, so that it rises all the way.
        let steps = f64::from(PLAIN);
        let rises = d * (1.0 - steps * (1.0 - e)) > steps * w * (a + steps * d);
        if rises || d.abs() < DISTINCT * (vb.abs() - va) {
            return None;
        }
        for n in 0..PLAIN {
            if d.abs() < DISTINCT * a {
                return None;
            }
            if d < 0.0 {
                return Some((PeakImpact::Number(u64::from(n) + 1), a));
            }
            a += d;
            d = e * d - w * a;
        }
        None
    }

    /// Returns the end and the peak for T ≤ 0, where the second strike is the last, and for e = 0, where all strikes
    /// from the second on happen at once.
    fn special(&self, start: &Start) -> (Ending, Largest) {
        let alpha = -start.velocity()[0];
        let first = after_first(self, start);
        let number = PeakImpact::Number;
        let peak = if rises(self, start) { (number(2), first) } else { (number(1), alpha) };
        let h0 = start.height_gap();
        let time = if h0 == 0.0 || first <= 0.0 { 0.0 } else { h0 / first };
        let (count, velocity) = if first <= 0.0 {
            (Count::Finite(1), Some(rebound(self, true, -alpha, -first)))
        } else if self.t <= 0.0 {
            (Count::Finite(2), Some(rebound(self, false, -first, self.e * alpha - self.t * first)))
        } else {
            (Count::Endless, rest(self, start))
        };
        (Ending { count, time, velocity }, peak)
    }

    #[inline]
    fn spread(&self, (impact, largest): Largest) -> Peak {
        let end = (1.0 + self.e) * largest;
        let center = if self.less == 0.0 { 0.0 } else { 0.5 * self.less * end };
        Peak { end, impact, center, angular: 0.5 * self.more * end }
    }

    #[inline]
    fn put(&self, start: &Start, end: Ending, peak: Largest) -> Summary {
        let [va, vb] = start.velocity();
        let net = end.velocity.map(|[a, b]| {
            let (a, b) = (a - va, b - vb);
            Net { a, b, center: 0.5 * (a + b), angular: 0.5 * (b - a) }
        });
        let (count, duration, final_velocity) = (end.count, end.time, end.velocity);
        Summary { count, duration, peak: self.spread(peak), final_velocity, net }
    }
}
