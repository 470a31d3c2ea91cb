//! The train, impact by impact.

use crate::motion::{Drive, Kind, Lanes, Steps, after_first};
use crate::{Bar, End, Start};

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
    /// Impacts given so far.
    given: u64,
    source: Source,
}

/// Where the next impacts come from.
#[derive(Debug, Clone)]
enum Source {
    /// The recurrence as it stands: a_{n−1}, `a_n`, a_{n+1} and `b_n`, b_{n+1}.
    Plain {
        before: f64,
        a: f64,
        next: f64,
        b: f64,
        b_next: f64,
    },
    /// Four strikes at a time, from the closed form.
    Lanes {
        drive: Box<Drive>,
        count: Option<u128>,
        lanes: Box<Lanes>,
    },
    /// Each from the closed form.
    Closed {
        drive: Box<Drive>,
        count: Option<u128>,
    },
    /// T ≤ 0: a second impact; e = 0: all further impacts at the instant of the second.
    Instant {
        first: f64,
        a: f64,
    },
    Done,
}

/// Plain steps that are taken before the closed form, which forgets no digit, takes over.
const PLAIN: u64 = 16;
/// A velocity that cancels by more than this is left to the closed form.
const CLEAR: f64 = 1.0 / 256.0;

impl Iterator for Train {
    type Item = Impact;

    #[inline]
    fn next(&mut self) -> Option<Impact> {
        let n = self.given;
        let (approach, time) = match &mut self.source {
            Source::Plain { before, a, next, b, b_next } if n < PLAIN => {
                if *a >= 0.0 {
                    return None;
                }
                let (t, e) = (self.bar.t, self.bar.e);
                // In doubt where the terms of a_{n+1}, of like size, nearly cancel.
                let terms = if n == 0 { t * *a } else { e * *before };
                if next.abs() <= CLEAR * terms.abs() {
                    self.source = self.long();
                    return self.next();
                }
                let strike = (*a, self.start.height_gap() * (*b / -*a));
                (*before, *a, *next) = (*a, *next, t * *next - e * *a);
                (*b, *b_next) = (*b_next, t * *b_next - e * *b);
                strike
            }
            Source::Plain { a, .. } => {
                if *a >= 0.0 {
                    return None;
                }
                self.source = self.long();
                return self.next();
            }
            Source::Lanes { drive, count, lanes } => {
                let n = u128::from(n);
                match *count {
                    Some(count) if n >= count => return None,
                    Some(count) if n + 1 == count => drive.strike(count),
                    _ if n == 0 => drive.strike(1),
                    _ => lanes.strike(drive, n),
                }
            }
            Source::Closed { drive, count } => {
                if count.is_some_and(|count| u128::from(n) >= count) {
                    return None;
                }
                drive.strike(u128::from(n) + 1)
            }
            Source::Instant { first, a } => {
                let h0 = self.start.height_gap();
                let time = if n == 0 || h0 == 0.0 { 0.0 } else { h0 / *first };
                let strike = (*a, time);
                if n > 0 {
                    *a *= self.bar.t;
                } else {
                    *a = -*first;
                }
                if *first <= 0.0 || (n > 0 && self.bar.t <= 0.0) {
                    self.source = Source::Done;
                }
                strike
            }
            Source::Done => return None,
        };
        self.given = n + 1;
        Some(self.bar.impact(self.given, approach, time))
    }

    /// Skips in constant time where the closed form has taken over.
    fn nth(&mut self, skip: usize) -> Option<Impact> {
        let mut skip = skip as u64;
        if skip > PLAIN && matches!(self.source, Source::Plain { .. }) {
            // The plain steps end the train by themselves, or hand over.
            for _ in self.given..PLAIN {
                self.next()?;
                skip -= 1;
            }
            self.source = self.long();
        }
        match &mut self.source {
            Source::Lanes { drive, lanes, .. } => {
                self.given = self.given.saturating_add(skip);
                **lanes = Lanes::new(drive, u128::from(self.given));
            }
            Source::Closed { .. } => self.given = self.given.saturating_add(skip),
            _ => {
                for _ in 0..skip {
                    self.next()?;
                }
            }
        }
        self.next()
    }
}

impl Train {
    /// The closed form that takes over.
    #[cold]
    fn long(&self) -> Source {
        let drive = Box::new(Drive::new(&self.bar, &self.start));
        let count = match drive.count() {
            Steps::Exactly(n) => Some(n),
            Steps::About(_) | Steps::Endless => None,
        };
        let closed = match drive.kind {
            Kind::Wave(_) => false,
            Kind::Decay(_) => count.is_some(),
            Kind::Edge => true,
        };
        if closed {
            return Source::Closed { drive, count };
        }
        let lanes = Box::new(Lanes::new(&drive, u128::from(self.given)));
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
    /// train of any length. Velocities below the range of floats are 0.
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
        let mut train = Train { bar: *self, start: *start, given: 0, source: Source::Done };
        let next = self.t * va + vb;
        train.source = if self.t <= 0.0 || self.e == 0.0 {
            Source::Instant { first: after_first(self, start), a: va }
        } else if vb <= 0.0 && self.t * self.e > 1e-280 {
            Source::Plain { before: 0.0, a: va, next, b: 0.0, b_next: 1.0 }
        } else {
            train.long()
        };
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
