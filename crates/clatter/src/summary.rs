//! What a train amounts to: count, peak, net change, final velocities, duration.

use crate::motion::{Drive, Last, Steps, after_first, rises};
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
    /// Largest velocity shock at a struck end, (1 + e) max |`a_n`|; may be infinite (q = e = 1).
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
    /// Final velocities of ends a and b; `None` where they do not settle (q = 1) or where the count is beyond 2¹²⁰,
    /// which leaves open whose turn the last strike was.
    pub final_velocity: Option<[f64; 2]>,
    /// Sum of all velocity shocks; `None` with `final_velocity`.
    pub net: Option<Net>,
}

/// The peak before it is spread over the bar: index n and value of the largest |`a_n`|.
type Largest = (Steps, f64);

/// Plain steps that are tried before the closed form.
const PLAIN: u128 = 16;
/// A velocity that came out of a cancellation by more than this factor is left to the closed form: 16 steps
/// accumulate some 300 roundings, so that the worst that is accepted is good to 300 · 2⁻⁵³ · 2⁸ ≈ 1e−11.
const CLEAR: f64 = 1.0 / 256.0;
/// Neighbors of the peak that differ by less are compared with more digits.
const DISTINCT: f64 = 1e-12;
/// 4e − T² in plain floats has this many digits to spare in its square root, and its sign, beyond this share of T².
const DISCERNIBLE: f64 = 1e-6;
/// No term may come near the subnormal floats.
const NORMAL: f64 = 1e-280;

/// What the plain steps found, as far as they leave nothing in doubt.
struct Plain {
    /// Number of impacts and how the train ends: the last step, or the limit of the strike times.
    end: Option<(Steps, Last)>,
    peak: Option<Largest>,
}

impl Bar {
    /// Count, peak, net change, final velocities and duration of the train, in constant time.
    ///
    /// # Method
    /// Up to 16 plain steps of the recurrence `a_{n+1} = T a_n − e a_{n−1}`, T = q(1 + e), where they leave nothing
    /// in doubt; else its closed form, whose angles, discriminant and remainders are carried in as many digits as
    /// it takes: f64, then double-double, then integers.
    ///
    /// # Accuracy
    /// The count, the impact that holds the peak and whether the train is endless are exact for every input. The
    /// errors of the rest are at most those of [`crate::accuracy`].
    ///
    /// # Cost
    /// About 25 ns where a few plain steps do, 100–200 ns for a long train, up to 600 ns where double-double is
    /// needed, and up to a millisecond for a start built to lie within 2⁻⁴⁰ of a tie.
    #[must_use]
    pub fn summary(&self, start: &Start) -> Summary {
        let plain = self.plain(start);
        if let Plain { end: Some((steps, last)), peak: Some(peak) } = plain {
            return self.finish(start, steps, last, peak);
        }
        self.long_summary(start, &plain)
    }

    #[inline(never)]
    fn long_summary(&self, start: &Start, plain: &Plain) -> Summary {
        if self.t <= 0.0 || self.e == 0.0 {
            return self.special(start);
        }
        let drive = Drive::new(self, start);
        let (steps, last) = plain.end.unwrap_or_else(|| {
            let steps = drive.count();
            (steps, drive.last(steps))
        });
        self.finish(start, steps, last, plain.peak.unwrap_or_else(|| drive.peak()))
    }

    /// Number of impacts alone: exact, at most 100 ns but where double-double or integers must decide.
    #[must_use]
    pub fn count(&self, start: &Start) -> Count {
        match self.plain(start).end {
            Some((steps, _)) => steps.into(),
            None if self.t <= 0.0 || self.e == 0.0 => self.special(start).count,
            None => Drive::new(self, start).count().into(),
        }
    }

    /// Largest velocity shocks alone.
    #[must_use]
    pub fn peak(&self, start: &Start) -> Peak {
        match self.plain(start).peak {
            Some(peak) => self.spread(peak),
            None if self.t <= 0.0 || self.e == 0.0 => self.special(start).peak,
            None => self.spread(Drive::new(self, start).peak()),
        }
    }

    /// Up to 16 plain steps, for T > 0 and e > 0.
    #[inline]
    fn plain(&self, start: &Start) -> Plain {
        let (t, e) = (self.t, self.e);
        let [va, vb] = start.velocity();
        let (mut before, mut a, mut next) = (0.0, va, t * va + vb);
        // Left alone: T ≤ 0, e = 0, and a start that cancels, at once or, as a decay does, at every step.
        let d = 4.0 * e - t * t;
        let spun = vb > 0.0 && !(d > DISCERNIBLE * t * t && next.abs() > CLEAR * -va * t);
        if t * e <= NORMAL || spun {
            return Plain { end: None, peak: None };
        }
        let endless = d < -DISCERNIBLE * t * t;
        let (mut b, mut b_next) = (0.0, 1.0);
        let (mut n, mut at, mut largest) = (1, 0, -va);
        let mut closest = f64::INFINITY;
        let done = loop {
            // |a_n| rises to its peak, then falls.
            closest = (next - a).abs().min(closest);
            if next < a {
                (at, largest) = (n, -next);
            } else if endless || next >= 0.0 {
                break true;
            }
            if n == PLAIN {
                break false;
            }
            (before, a, next) = (a, next, t * next - e * a);
            (b, b_next) = (b_next, t * b_next - e * b);
            n += 1;
        };
        let found = done && closest > DISTINCT * largest;
        let peak = found.then_some((Steps::Exactly(at), largest));
        let h0 = start.height_gap();
        if endless {
            let limit = h0 / (0.5 * (t + (-d).sqrt()) * -va - vb);
            return Plain { end: Some((Steps::Endless, Last { a: 0.0, next: 0.0, time: limit })), peak };
        }
        let clear = done
            && (n < 2 || next > CLEAR * e * -before)
            && (n < 3 || -a > CLEAR * t * -before)
            && next.min(-a) > NORMAL;
        let time = if n == 1 { 0.0 } else { h0 * (b / -a) };
        Plain { end: clear.then_some((Steps::Exactly(n), Last { a, next, time })), peak }
    }

    /// T ≤ 0, where the second strike is the last, and e = 0, where all strikes from the second on happen at once.
    fn special(&self, start: &Start) -> Summary {
        let alpha = -start.velocity()[0];
        let first = after_first(self, start);
        let peak = if rises(self, start) { (Steps::Exactly(1), first) } else { (Steps::Exactly(0), alpha) };
        if first <= 0.0 {
            let last = Last { a: -alpha, next: -first, time: 0.0 };
            return self.finish(start, Steps::Exactly(1), last, peak);
        }
        let h0 = start.height_gap();
        let time = if h0 == 0.0 { 0.0 } else { h0 / first };
        if self.t <= 0.0 {
            let last = Last { a: -first, next: self.e * alpha - self.t * first, time };
            return self.finish(start, Steps::Exactly(2), last, peak);
        }
        self.finish(start, Steps::Endless, Last { a: 0.0, next: 0.0, time }, peak)
    }

    fn spread(&self, (steps, largest): Largest) -> Peak {
        let end = (1.0 + self.e) * largest;
        let impact = match steps {
            Steps::Exactly(n) => u64::try_from(n + 1).map_or_else(|_| PeakImpact::Huge(nearest(n)), PeakImpact::Number),
            Steps::About(n) => PeakImpact::Huge(n),
            Steps::Endless => PeakImpact::Limit,
        };
        let center = if self.less == 0.0 { 0.0 } else { 0.5 * self.less * end };
        Peak { end, impact, center, angular: 0.5 * self.more * end }
    }

    /// Final velocities and net change from the last step; all ends at rest after an endless train, unless the
    /// ends have no mass (q = 1): then only a bar that turns about a still center comes to rest.
    fn finish(&self, start: &Start, steps: Steps, last: Last, peak: Largest) -> Summary {
        let [va, vb] = start.velocity();
        let final_velocity = match steps {
            Steps::Exactly(n) => {
                let struck = -self.e * last.a;
                Some(if n % 2 == 1 { [struck, last.next] } else { [last.next, struck] })
            }
            Steps::Endless if self.less > 0.0 || (va + vb == 0.0 && self.e < 1.0) => Some([0.0, 0.0]),
            _ => None,
        };
        let net = final_velocity.map(|[a, b]| {
            let (a, b) = (a - va, b - vb);
            Net { a, b, center: 0.5 * (a + b), angular: 0.5 * (b - a) }
        });
        Summary { count: steps.into(), duration: last.time, peak: self.spread(peak), final_velocity, net }
    }
}

impl From<Steps> for Count {
    fn from(steps: Steps) -> Self {
        match steps {
            Steps::Exactly(n) => u64::try_from(n).map_or_else(|_| Self::Huge(nearest(n)), Self::Finite),
            Steps::About(n) => Self::Huge(n),
            Steps::Endless => Self::Endless,
        }
    }
}

#[expect(clippy::cast_precision_loss, reason = "the nearest float is what is asked for")]
fn nearest(n: u128) -> f64 {
    n as f64
}
