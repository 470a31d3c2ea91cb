//! The train, impact by impact.

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
    /// Jumps of the velocities of ends a and b.
    pub delta_v: [f64; 2],
}

impl Impact {
    /// Velocity shock at position `s` in [−1, 1] (−1 is end a): Eq. 3 of the paper,
    /// `((1 − s) Δv_a + (1 + s) Δv_b)/2`.
    #[must_use]
    pub fn delta_v_at(&self, s: f64) -> f64 {
        0.5 * ((1.0 - s) * self.delta_v[0] + (1.0 + s) * self.delta_v[1])
    }
}

/// Iterator over the impacts of a train; without end where the train is endless.
#[derive(Debug, Clone)]
pub struct Train {
    t: f64,
    e: f64,
    q: f64,
    h0: f64,
    a: f64,
    next: f64,
    b: f64,
    bn: f64,
    number: u64,
}

impl Iterator for Train {
    type Item = Impact;
    fn next(&mut self) -> Option<Impact> {
        if self.a >= 0.0 {
            return None;
        }
        let (a, b) = (self.a, self.b);
        self.number += 1;
        let end = End::of_impact(self.number);
        let (hit, far) = (-(1.0 + self.e) * a, self.q * (1.0 + self.e) * a);
        let impact = Impact {
            number: self.number,
            end,
            time: self.h0 * b / -a,
            approach: a,
            delta_v: if end == End::A { [hit, far] } else { [far, hit] },
        };
        (self.a, self.next) = (self.next, self.t * self.next - self.e * a);
        (self.b, self.bn) = (self.bn, self.t * self.bn - self.e * b);
        Some(impact)
    }
}

impl Bar {
    /// The impacts, one by one.
    #[must_use]
    pub fn train(&self, start: &Start) -> Train {
        let [va, vb] = start.velocity();
        let t = self.q() * (1.0 + self.e());
        Train {
            t,
            e: self.e(),
            q: self.q(),
            h0: start.height_gap(),
            a: va,
            next: t * va + vb,
            b: 0.0,
            bn: 1.0,
            number: 0,
        }
    }
}
