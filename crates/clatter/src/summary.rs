//! What a train amounts to: count, peak, net change, final velocities, duration.

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
    /// Sum of all velocity shocks; `None` where the velocities do not settle (the center's is 0 there).
    pub net: Option<Net>,
}

impl Bar {
    /// Count, peak, net change, final velocities and duration of the train.
    #[must_use]
    pub fn summary(&self, start: &Start) -> Summary {
        let (t, e, q) = (self.q() * (1.0 + self.e()), self.e(), self.q());
        let [va, vb] = start.velocity();
        let (mut a, mut next, mut b, mut n) = (va, t * va + vb, 0.0, 1u64);
        let (mut bn, mut big, mut at) = (1.0, -a, 1u64);
        while next < 0.0 && n < 100_000 {
            (a, next) = (next, t * next - e * a);
            (b, bn) = (bn, t * bn - e * b);
            n += 1;
            if -a > big {
                (big, at) = (-a, n);
            }
        }
        let end = (1.0 + e) * big;
        let peak =
            Peak { end, impact: PeakImpact::Number(at), center: 0.5 * (1.0 - q) * end, angular: 0.5 * (1.0 + q) * end };
        let last = if n % 2 == 1 { [-e * a, next] } else { [next, -e * a] };
        let last = if n == 100_000 { [0.0, 0.0] } else { last };
        let (da, db) = (last[0] - va, last[1] - vb);
        Summary {
            count: if n == 100_000 { Count::Endless } else { Count::Finite(n) },
            duration: start.height_gap() * b / -a,
            peak,
            final_velocity: Some(last),
            net: Some(Net { a: da, b: db, center: 0.5 * (da + db), angular: 0.5 * (db - da) }),
        }
    }
    /// Number of impacts alone.
    #[must_use]
    pub fn count(&self, start: &Start) -> Count {
        self.summary(start).count
    }
}
