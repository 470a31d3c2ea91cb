//! The motion of a soft part after a record, from integrals of the record, where the filter of samples has too few
//! digits.

use crate::suspension::{Modes, Motion};

/// Phase of a record, times 1 + 2ζ, up to which the series is taken: its remainder is the fourth power of that.
const SOFT: f64 = 1e-3;

/// Repeated integrals of a record, by the time between samples: the first one in two doubles.
///
/// Where base velocity and displacement cancel in the end, roundings of the filter are far above the remaining velocity
/// of a part so soft that it hardly moved. For such a part, of phase θ a sample and at rest before,
/// ```text
/// z″ + 2ζωz′ + ω²z = −a,    z′ = −dt Σ cₖθᵏIₖ,    ωz = −dt θ Σ cₖθᵏIₖ₊₁,    c₀ = 1,  cₖ = −2ζcₖ₋₁ − cₖ₋₂.
/// ```
#[derive(Debug, Clone, Default)]
pub(crate) struct Integrals {
    /// Number of samples, less one.
    steps: f64,
    /// Rounding error of the first integral.
    rest: f64,
    of: [f64; 5],
}

impl Integrals {
    /// Extends the integrals by the next step, in which the acceleration is linear.
    pub(crate) fn step(&mut self, from: f64, to: f64) {
        let [i0, i1, i2, i3, i4] = self.of;
        let rise = to - from;
        let higher = [
            i1 + (i0 + (from / 2.0 + rise / 6.0)),
            i2 + (i1 + i0 / 2.0 + (from / 6.0 + rise / 24.0)),
            i3 + (i2 + i1 / 2.0 + i0 / 6.0 + (from / 24.0 + rise / 120.0)),
            i4 + (i3 + i2 / 2.0 + i1 / 6.0 + i0 / 24.0 + (from / 120.0 + rise / 720.0)),
        ];
        let mut first = i0;
        for half in [0.5 * from, 0.5 * to] {
            let sum = first + half;
            let added = sum - first;
            self.rest += (first - (sum - added)) + (half - added);
            first = sum;
        }
        self.of = [first, higher[0], higher[1], higher[2], higher[3]];
        self.steps += 1.0;
    }
    /// Returns whether the series holds for this phase a sample.
    pub(crate) fn suit(&self, zeta: f64, theta: f64) -> bool {
        (1.0 + 2.0 * zeta) * theta * self.steps < SOFT
    }
    pub(crate) fn motion(&self, modes: &Modes, theta: f64, dt: f64) -> Motion {
        let (mut c, mut before, mut power) = (1.0, 0.0, 1.0);
        let (mut velocity, mut x) = (self.rest, 0.0);
        for k in 0..5 {
            velocity += c * power * self.of[k];
            x += c * power * self.of.get(k + 1).unwrap_or(&0.0);
            (c, before) = (-2.0 * modes.zeta * c - before, c);
            power *= theta;
        }
        let (velocity, x) = (-dt * velocity, -dt * theta * x);
        Motion { x, w: velocity + modes.sigma * x }
    }
}
