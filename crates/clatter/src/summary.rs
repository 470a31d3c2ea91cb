//! What a train amounts to: count, peak, net change, final velocities, duration.

use crate::motion::{Drive, Ending, Largest, NORMAL, after_first, rebound, rest, rises};
use crate::{Bar, Start};

/// How many impacts the train has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Count {
    /// Exactly so many.
    Finite(u64),
    /// Finite, but beyond 2⁶⁴: the nearest float.
    Huge(f64),
    /// The impacts never end, in finite or infinite time.
    Endless,
}

/// Which impact holds the peak.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PeakImpact {
    /// Impact number, from 1; the first if several tie.
    Number(u64),
    /// An impact beyond number 2⁶⁴: the nearest float.
    Huge(f64),
    /// No impact attains the peak: the shocks tend to it.
    Limit,
}

/// The largest velocity shocks of the train (Eq. 4 of the paper), all held by the same impact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// Largest velocity shock at a struck end, (1 + e) max |a_n|; may be infinite (q = e = 1).
    pub end: f64,
    /// The impact that holds it.
    pub impact: PeakImpact,
    /// Largest velocity shock of the center, (1 − q)/2 · `end`; 0 at q = 1.
    pub center: f64,
    /// Largest change of angular velocity, (1 + q)/2 · `end`, in v0/L.
    pub angular: f64,
}

/// Sum of all velocity shocks, from before the first to after the last impact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Net {
    /// At end a.
    pub a: f64,
    /// At end b.
    pub b: f64,
    /// At the center.
    pub center: f64,
    /// Of the angular velocity, in v0/L.
    pub angular: f64,
}

/// Everything about a train that needs no list of its impacts.
#[derive(Debug, Clone, Copy, PartialEq)]
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

/// Plain steps that are tried before the closed form.
const PLAIN: u32 = 16;
/// A velocity that came out of a cancellation by more than this factor is left to the closed form: 16 steps
/// accumulate some 300 roundings, so that the worst that is accepted is good to 300 · 2⁻⁵³ · 2¹² ≈ 1.4e−10.
const CLEAR: f64 = 1.0 / 4096.0;
/// Neighbors of the peak that differ by less are compared with more digits.
const DISTINCT: f64 = 1e-12;
/// 4e − T² in plain floats has this many digits to spare in its square root, and its sign, beyond this share of T².
const DISCERNIBLE: f64 = 1e-6;
/// sin²(π/18): a wave that turns by less a strike, from a start that does not spin up, takes more than 16 strikes.
const SLOW: f64 = 0.030_153;

impl Bar {
    /// Count, peak, net change, final velocities and duration of the train, in constant time.
    ///
    /// # Method
    /// Up to 16 plain steps of the recurrence `a_{n+1} = T a_n − e a_{n−1}`, T = q(1 + e), where they leave nothing
    /// in doubt; else its closed form. The sign of the discriminant is always certain: double-double with an error
    /// bound, and integers where that bound is not met. A count is the quotient of two angles (or logarithms) rounded
    /// up: taken from f64 where it is more than 24 roundings away from an integer, else from double-double angles
    /// (about 85 bits) where it is clear of its error there, else from the signs of the recurrence in whole integers,
    /// which also settle exact ties.
    ///
    /// # Accuracy
    /// The count, the impact that holds the peak and whether the train is endless are exact for every input; beyond
    /// 2⁶⁴ they are the nearest float. The errors of the rest are at most those of [`crate::accuracy`], as long as no
    /// velocity is so small (2⁻¹⁰²² and below) that floats have no digits left for it.
    ///
    /// # Cost
    /// Measured on a 2.9 GHz core (bench `speed`): 15 to 35 ns where plain steps do, 240 to 260 ns for a longer train,
    /// 500 to 700 ns where double-double is needed (N beyond 10⁷, or next to the endless curve), microseconds to a
    /// millisecond where integers decide (a start next to a tie), and tens of milliseconds for a count beyond 2⁹⁰.
    #[must_use]
    #[inline]
    pub fn summary(&self, start: &Start) -> Summary {
        match (self.plain_end(start), self.plain_peak(start)) {
            (Some(end), Some(peak)) => self.put(start, end, peak),
            (end, peak) => self.long_summary(start, end, peak),
        }
    }

    #[inline(never)]
    fn long_summary(&self, start: &Start, end: Option<Ending>, peak: Option<Largest>) -> Summary {
        let (end, peak) = if self.t <= 0.0 || self.e == 0.0 {
            let (end, special) = self.special(start);
            (end, peak.unwrap_or(special))
        } else {
            let drive = Drive::new(self, start);
            (end.unwrap_or_else(|| drive.ending()), peak.unwrap_or_else(|| drive.peak()))
        };
        self.put(start, end, peak)
    }

    /// Number of impacts alone, as exact as in [`summary`](Self::summary): 8 to 26 ns where plain steps do, 80 to 130 ns
    /// for a longer train, 180 to 240 ns next to the endless curve, more where integers decide.
    #[must_use]
    pub fn count(&self, start: &Start) -> Count {
        match self.plain_end(start) {
            Some(end) => end.count,
            None if self.t <= 0.0 || self.e == 0.0 => self.special(start).0.count,
            None => Drive::new(self, start).count(),
        }
    }

    /// Largest velocity shocks alone.
    #[must_use]
    pub fn peak(&self, start: &Start) -> Peak {
        match self.plain_peak(start) {
            Some(peak) => self.spread(peak),
            None if self.t <= 0.0 || self.e == 0.0 => self.spread(self.special(start).1),
            None => self.spread(Drive::new(self, start).peak()),
        }
    }

    /// How the train ends, where at most 16 plain steps, or the limit of an endless one, leave nothing in doubt.
    #[expect(clippy::inline_always, reason = "the whole summary of a short train takes 15 ns; calls would double it")]
    #[inline(always)]
    fn plain_end(&self, start: &Start) -> Option<Ending> {
        let (t, e) = (self.t, self.e);
        let [va, vb] = start.velocity();
        let (mut before, mut a, mut next) = (0.0, va, t * va + vb);
        let d = 4.0 * e - t * t;
        // Left alone: T ≤ 0, e = 0, and a start that cancels, at once or, as a decay does, at every step.
        if t * e <= NORMAL || (vb > 0.0 && (d < DISCERNIBLE * t * t || next.abs() < CLEAR * -va * t)) {
            return None;
        }
        let h0 = start.height_gap();
        if d < 4.0 * SLOW * e && vb <= 0.0 {
            let limit = || h0 / (0.5 * (t + (-d).sqrt()) * -va - vb);
            let at_rest = || Ending { count: Count::Endless, time: limit(), velocity: rest(self, start) };
            return (d < -DISCERNIBLE * t * t).then(at_rest);
        }
        let (mut b, mut b_next, mut n) = (0.0, 1.0, 1_u32);
        while next < 0.0 {
            if n == PLAIN {
                return None;
            }
            (before, a, next) = (a, next, t * next - e * a);
            (b, b_next) = (b_next, t * b_next - e * b);
            n += 1;
        }
        // No short circuits: which impact is the last is what a branch predictor cannot know. For N = 1, b and
        // a_{N−2} are 0.
        let margin = (next + CLEAR * e * before).min(CLEAR * t * before - a).min(next - NORMAL).min(-a - NORMAL);
        let clear = margin > 0.0 && (n < 2 || b > NORMAL);
        let time = h0 * (b / -a);
        let velocity = Some(rebound(self, n % 2 == 1, a, next));
        clear.then_some(Ending { count: Count::Finite(u64::from(n)), time, velocity })
    }

    /// The peak, where at most 16 plain steps leave nothing in doubt, by d = |a_{n+1}| − |a_n|, which obeys
    /// `d ← e d − (1 − q)(1 + e) |a|` and falls below zero at the peak.
    #[expect(clippy::inline_always, reason = "the whole summary of a short train takes 15 ns; calls would double it")]
    #[inline(always)]
    fn plain_peak(&self, start: &Start) -> Option<Largest> {
        let [va, vb] = start.velocity();
        let (e, w) = (self.e, self.less * (1.0 + self.e));
        let (mut a, mut d) = (-va, -va * (e - w) - vb);
        if d.abs() < DISTINCT * (vb.abs() - va) {
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

    /// T ≤ 0, where the second strike is the last, and e = 0, where all strikes from the second on happen at once.
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
