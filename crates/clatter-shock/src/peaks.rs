//! Largest positive and negative values of a response, and where they stand.

use crate::suspension::{Modes, Motion};

/// An extreme value of the response.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extreme {
    /// The value, with its sign.
    pub value: f64,
    /// When it is reached, on the time axis of the excitation.
    pub time: f64,
    /// Which interval holds it, from 0: interval i begins with shock i (or breakpoint i of the pulses) and lasts until
    /// the next; the last one is the ring-down.
    pub interval: usize,
}

/// The largest positive and the largest negative value of a quantity. Before the first shock all is at rest: a
/// quantity that never turns negative has 0 there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extremes {
    /// Largest value, at least 0.
    pub positive: Extreme,
    /// Smallest value, at most 0.
    pub negative: Extreme,
}

impl Extremes {
    /// The one that is larger in absolute value; the earlier one if they tie.
    #[must_use]
    pub fn peak(&self) -> Extreme {
        let (p, n) = (self.positive, self.negative);
        if p.value > -n.value || (p.value + n.value == 0.0 && p.time <= n.time) { p } else { n }
    }
    /// Largest absolute value.
    #[must_use]
    pub fn magnitude(&self) -> f64 {
        self.positive.value.max(-self.negative.value)
    }
    /// The same extremes in another unit.
    fn map(self, unit: impl Fn(f64) -> f64) -> Self {
        let map = |e: Extreme| Extreme { value: unit(e.value) + 0.0, ..e };
        Self { positive: map(self.positive), negative: map(self.negative) }
    }
}

/// Which peak is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Peaked {
    /// ω|z|.
    PseudoVelocity,
    /// |A|/ω.
    AccelerationOverOmega,
}

impl Peaked {
    pub(crate) fn row(self) -> usize {
        match self {
            Self::PseudoVelocity => Modes::DISPLACEMENT,
            Self::AccelerationOverOmega => Modes::ACCELERATION,
        }
    }
}

/// A mark within an interval, in phase τ from its begin.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Mark {
    pub(crate) value: f64,
    tau: f64,
    pub(crate) interval: usize,
}

/// Running extremes of one quantity.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Range {
    pub(crate) high: Mark,
    pub(crate) low: Mark,
    /// Whether only the larger one counts: what is smaller either way is passed over.
    peak: bool,
}

impl Range {
    /// Of the one that is larger in absolute value, with nothing in it that is within `above` of 0.
    pub(crate) fn beyond(above: f64) -> Self {
        let mark = |value| Mark { value, ..Mark::default() };
        Self { high: mark(above.max(0.0)), low: mark(-above.max(0.0)), peak: true }
    }
    /// The larger extreme in absolute value, if it passes `above`.
    pub(crate) fn peak_above(&self, above: f64, omega: f64, start: impl Fn(usize) -> f64) -> Option<Extreme> {
        Some(self.extremes(omega, start).peak()).filter(|peak| peak.value.abs() > above.max(0.0))
    }
    #[inline]
    pub(crate) fn note(&mut self, interval: usize, tau: f64, value: f64) {
        // Of two as large as each other the earlier counts, and that is not the mirror image.
        let mirror = Mark { value: -value, tau: f64::INFINITY, interval };
        if value > self.high.value {
            self.high = Mark { value, tau, interval };
            if self.peak {
                self.low = mirror;
            }
        } else if value < self.low.value {
            self.low = Mark { value, tau, interval };
            if self.peak {
                self.high = mirror;
            }
        }
    }
    /// Takes in the free motion from `m` over `span`: its start and its turning points. Its end is the start of what
    /// follows.
    #[inline]
    pub(crate) fn note_free(&mut self, modes: &Modes, k: usize, m: Motion, span: f64, interval: usize) {
        self.note(interval, 0.0, modes.quantity(k, m));
        let seen = (self.low.value, self.high.value);
        modes.free_extremes(k, m, span, seen, |tau, value| self.note(interval, tau, value));
    }
    pub(crate) fn extremes(&self, omega: f64, start: impl Fn(usize) -> f64) -> Extremes {
        let mark = |m: Mark| Extreme { value: m.value, time: start(m.interval) + m.tau / omega, interval: m.interval };
        Extremes { positive: mark(self.high), negative: mark(self.low) }
    }
}

/// The largest values that a component reaches, exactly.
///
/// z and A are infinite where they pass the floats (ω below 10⁻³⁰⁰ or above 10³⁰⁰); as velocities,
/// [`pseudo_velocity`](Self::pseudo_velocity) and [`acceleration_over_omega`](Self::acceleration_over_omega), they
/// still are known.
///
/// Signs: z is the displacement of the component relative to its base, so that a base that accelerates upward first
/// drives z downward and the absolute acceleration A = −(2ζωz′ + ω²z) upward.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Response {
    omega: f64,
    /// ωz and A/ω as they were found: the way from z and A back would lose what those cannot hold.
    pseudo_velocity: Extremes,
    acceleration_over_omega: Extremes,
    /// Relative displacement z (rattle space).
    pub relative_displacement: Extremes,
    /// Relative velocity z′.
    pub relative_velocity: Extremes,
    /// Absolute acceleration A, its jumps 2ζωΔv included.
    pub absolute_acceleration: Extremes,
}

impl Response {
    /// Pseudo-velocity ωz.
    #[must_use]
    pub fn pseudo_velocity(&self) -> Extremes {
        self.pseudo_velocity
    }
    /// Absolute acceleration as a velocity, A/ω.
    #[must_use]
    pub fn acceleration_over_omega(&self) -> Extremes {
        self.acceleration_over_omega
    }
    /// Equivalent static acceleration −ω²z: the steady acceleration of the base that bends the suspension as far.
    #[must_use]
    pub fn equivalent_static_acceleration(&self) -> Extremes {
        let mirrored = self.pseudo_velocity.map(|x| -self.omega * x);
        Extremes { positive: mirrored.negative, negative: mirrored.positive }
    }
    pub(crate) fn from_ranges(omega: f64, ranges: &[Range; 3], start: impl Fn(usize) -> f64) -> Self {
        let [x, y, a] = ranges.map(|range| range.extremes(omega, &start));
        Self {
            omega,
            pseudo_velocity: x,
            acceleration_over_omega: a,
            relative_displacement: x.map(|x| x / omega),
            relative_velocity: y,
            absolute_acceleration: a.map(|a| omega * a),
        }
    }
}
