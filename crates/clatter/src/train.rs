//! The train, impact by impact.

use crate::motion::{Drive, Kind, LANES, Lanes, NORMAL, after_first};
use crate::{Bar, Count, End, Start};

/// One impact of the train.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impact {
    /// From 1.
    pub number: u64,
    /// The end that strikes.
    pub end: End,
    /// Since the first contact, in h0/v0.
    pub time: f64,
    /// Velocity of the striking end just before, negative.
    pub approach: f64,
    /// Jumps of the velocities of ends a and b: −(1 + e) times the approach velocity at the end that strikes,
    /// q(1 + e) times it at the other (Eq. 2).
    pub delta_v: [f64; 2],
}

impl Impact {
    /// Velocity shock at position `s` in [−1, 1] (−1 is end a): `((1 − s) Δv_a + (1 + s) Δv_b)/2` (Eq. 3).
    ///
    /// # Examples
    /// The center of percussion of strikes at end a feels nothing of them:
    /// ```
    /// let bar = clatter::Bar::new(0.5, 0.3)?;
    /// let first = bar.train(&clatter::Start::default()).next().unwrap();
    /// assert!(first.delta_v_at(bar.percussion()).abs() < 1e-15);
    /// # Ok::<(), clatter::Error>(())
    /// ```
    #[must_use]
    pub fn delta_v_at(&self, s: f64) -> f64 {
        0.5 * ((1.0 - s) * self.delta_v[0] + (1.0 + s) * self.delta_v[1])
    }
}

/// Iterator over the impacts of a train; without end where the train is endless. Made by [`Bar::train`].
#[derive(Debug, Clone)]
pub struct Train {
    bar: Bar,
    start: Start,
    /// Impacts worked out so far; those from `next` on still wait in the buffers.
    ahead: u64,
    next: usize,
    filled: usize,
    approach: [f64; BUFFER],
    times: [f64; BUFFER],
    source: Source,
}

/// Where the next impacts come from.
#[derive(Debug, Clone)]
enum Source {
    /// The recurrence as it stands, for the first [`BUFFER`] impacts.
    Plain,
    /// Four strikes at a time, from the closed form.
    Lanes {
        drive: Box<Drive>,
        count: Option<u64>,
        lanes: Box<Lanes>,
    },
    /// Each from the closed form.
    Closed {
        drive: Box<Drive>,
        count: Option<u64>,
    },
    /// T ≤ 0: a second impact; e = 0: all further impacts at the instant of the second.
    Instant {
        first: f64,
        a: f64,
    },
    Done,
}

/// Impacts worked out together, and plain steps taken before the closed form, which forgets no digit, takes over.
const BUFFER: usize = 16;
/// A velocity that cancels by more than this is left to the closed form.
const CLEAR: f64 = 1.0 / 256.0;

impl Iterator for Train {
    type Item = Impact;

    #[inline]
    fn next(&mut self) -> Option<Impact> {
        if self.next == self.filled {
            self.fill();
            if self.filled == 0 {
                return None;
            }
        }
        let i = self.next;
        self.next += 1;
        let number = self.ahead - (self.filled - self.next) as u64;
        Some(self.bar.impact(number, self.approach[i], self.times[i]))
    }

    /// Skips in constant time, but for the plain steps at the beginning.
    fn nth(&mut self, mut skip: usize) -> Option<Impact> {
        while skip >= self.filled - self.next {
            skip -= self.filled - self.next;
            self.next = self.filled;
            match &mut self.source {
                Source::Lanes { drive, lanes, .. } => {
                    self.ahead = self.ahead.saturating_add(skip as u64);
                    **lanes = Lanes::new(drive, self.ahead);
                    skip = 0;
                }
                Source::Closed { .. } => {
                    self.ahead = self.ahead.saturating_add(skip as u64);
                    skip = 0;
                }
                Source::Instant { first, a } if self.ahead > 0 && *first > 0.0 && self.bar.t > 0.0 => {
                    self.ahead = self.ahead.saturating_add(skip as u64);
                    #[expect(clippy::cast_precision_loss, reason = "beyond 2^53 the power is 0, or 1 at q = 1")]
                    let steps = skip as f64;
                    *a *= libm::pow(self.bar.t, steps);
                    skip = 0;
                }
                _ => {}
            }
            self.fill();
            if self.filled == 0 {
                return None;
            }
        }
        self.next += skip;
        self.next()
    }
}

impl Train {
    /// Works out the next impacts; none where the train has ended.
    #[inline(never)]
    fn fill(&mut self) {
        if let Source::Plain = self.source {
            self.plain();
            if self.filled > 0 {
                return;
            }
        }
        let ahead = self.ahead;
        // Beyond 2^64 − 1 impacts there are no numbers left.
        let left = |count: Option<u64>| count.unwrap_or(u64::MAX).saturating_sub(ahead);
        (self.next, self.filled) = (0, 0);
        match &mut self.source {
            Source::Lanes { drive, count, lanes } => {
                let left = left(*count);
                if left > 0 {
                    for (approach, times) in self.approach.chunks_mut(LANES).zip(self.times.chunks_mut(LANES)) {
                        lanes.take(drive, approach, times);
                    }
                }
                self.filled = usize::try_from(left).map_or(BUFFER, |left| left.min(BUFFER));
                // The first and the last strike by themselves: next to a tie, the last takes more digits.
                if ahead == 0 {
                    (self.approach[0], self.times[0]) = drive.strike(1);
                }
                if let (Some(count), 1..=16) = (*count, left) {
                    (self.approach[self.filled - 1], self.times[self.filled - 1]) = drive.strike(count);
                }
            }
            Source::Closed { drive, count } => {
                self.filled = usize::from(left(*count) > 0);
                if self.filled > 0 {
                    (self.approach[0], self.times[0]) = drive.strike(ahead + 1);
                }
            }
            Source::Instant { first, a } => {
                let h0 = self.start.height_gap();
                let later = if h0 == 0.0 || *first <= 0.0 { 0.0 } else { h0 / *first };
                (self.approach[0], self.times[0], self.filled) =
                    (*a, if ahead == 0 { 0.0 } else { later }, usize::from(left(None) > 0));
                *a = if ahead == 0 { -*first } else { *a * self.bar.t };
                if *first <= 0.0 || (ahead > 0 && self.bar.t <= 0.0) {
                    self.source = Source::Done;
                }
            }
            Source::Plain | Source::Done => {}
        }
        self.ahead += self.filled as u64;
    }

    /// The first impacts by the recurrence, up to the end, to a doubt, or until the buffer is full; then hands over.
    fn plain(&mut self) {
        let (t, e, h0) = (self.bar.t, self.bar.e, self.start.height_gap());
        let [va, vb] = self.start.velocity();
        let (mut before, mut a, mut next) = (0.0, va, t * va + vb);
        let (mut b, mut b_next) = (0.0, 1.0_f64);
        let mut n = 0;
        while n < BUFFER && a < 0.0 {
            // In doubt where the terms of a_{n+1}, of like size, nearly cancel: from this strike on, more digits.
            let terms = if n == 0 { t * a } else { e * before };
            if next.abs() <= CLEAR * terms.abs() || next.abs().min(b_next.abs()) <= NORMAL {
                break;
            }
            (self.approach[n], self.times[n]) = (a, h0 * (b / -a));
            n += 1;
            (before, a, next) = (a, next, t * next - e * a);
            (b, b_next) = (b_next, t * b_next - e * b);
        }
        (self.next, self.filled, self.ahead) = (0, n, n as u64);
        self.source = if a < 0.0 { self.long() } else { Source::Done };
    }

    /// The closed form that takes over.
    #[cold]
    fn long(&self) -> Source {
        let drive = Box::new(Drive::new(&self.bar, &self.start));
        let count = match drive.count() {
            Count::Finite(n) => Some(n),
            Count::Huge(_) | Count::Endless => None,
        };
        let closed = match drive.kind {
            Kind::Wave(_) => false,
            Kind::Decay(_) => count.is_some(),
            Kind::Edge => true,
        };
        if closed {
            return Source::Closed { drive, count };
        }
        let lanes = Box::new(Lanes::new(&drive, self.ahead));
        Source::Lanes { drive, count, lanes }
    }
}

impl Bar {
    /// The impacts, one by one.
    ///
    /// # Method
    /// The recurrence for 16 strikes, then the closed form: four neighboring strikes are carried on together by
    /// rotations that keep small angles exact, anchored anew every 256 strikes. The number of impacts is settled
    /// beforehand, as exactly as by [`Bar::count`].
    ///
    /// # Accuracy
    /// [`crate::accuracy::APPROACH`], [`JUMP`](crate::accuracy::JUMP) and [`TIME`](crate::accuracy::TIME), for a
    /// train of any length. Velocities below the range of floats are 0; where the last plain step or the only terms left
    /// are subnormal (a bar with massless ends that turns about its center), times have only the digits that these have.
    ///
    /// # Examples
    /// ```
    /// let bar = clatter::Bar::new(0.5, 0.3)?;
    /// let times: Vec<f64> = bar.train(&clatter::Start::default()).map(|impact| impact.time).collect();
    /// assert_eq!(times.len(), 4);
    /// assert!((times[1] - 1.0 / 1.65).abs() < 1e-15);
    /// # Ok::<(), clatter::Error>(())
    /// ```
    #[must_use]
    pub fn train(&self, start: &Start) -> Train {
        let [va, vb] = start.velocity();
        let (approach, times) = ([0.0; BUFFER], [0.0; BUFFER]);
        let mut train =
            Train { bar: *self, start: *start, ahead: 0, next: 0, filled: 0, approach, times, source: Source::Plain };
        if self.t <= 0.0 || self.e == 0.0 {
            train.source = Source::Instant { first: after_first(self, start), a: va };
        } else if vb > 0.0 || self.t * self.e <= NORMAL {
            train.source = train.long();
        }
        train
    }

    /// The impact as a whole.
    #[inline]
    fn impact(&self, number: u64, approach: f64, time: f64) -> Impact {
        let hit = -(1.0 + self.e()) * approach;
        let far = -self.q() * hit;
        let end = End::of_impact(number);
        Impact { number, end, time, approach, delta_v: if end == End::A { [hit, far] } else { [far, hit] } }
    }
}
