//! Largest positive and negative values of a response, and their times.

use crate::suspension::{Modes, Motion};

/// An extreme value of the response.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Extreme {
    /// The value, with its sign.
    pub value: f64,
    /// Time of the extreme, on the time axis of the excitation.
    pub time: f64,
    /// Index of its interval, from 0: interval i begins with shock i (or breakpoint i of the pulses) and lasts until
    /// the next; the last one is the ring-down.
    pub interval: usize,
}

/// The largest positive and the largest negative value of a quantity. Before the first shock all is at rest: a
/// quantity that never turns negative has 0 there.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Extremes {
    /// Largest value, at least 0.
    pub positive: Extreme,
    /// Smallest value, at most 0.
    pub negative: Extreme,
}

impl Extremes {
    /// Returns the extreme that is larger in absolute value; the earlier one if they tie.
    #[must_use]
    pub fn peak(&self) -> Extreme {
        let (p, n) = (self.positive, self.negative);
        if p.value > -n.value || (p.value + n.value == 0.0 && p.time <= n.time) { p } else { n }
    }
    /// Returns the largest absolute value.
    #[must_use]
    pub fn magnitude(&self) -> f64 {
        self.positive.value.max(-self.negative.value)
    }
    /// Returns the same extremes in another unit.
    fn map(self, unit: impl Fn(f64) -> f64) -> Self {
        let map = |e: Extreme| Extreme { value: unit(e.value) + 0.0, ..e };
        Self { positive: map(self.positive), negative: map(self.negative) }
    }
}

/// The quantity of a wanted peak.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Peaked {
    /// ω|z|.
    PseudoVelocity,
    /// |A|/ω.
    AccelerationOverOmega,
    /// |z′| at a touch of a [`Stop`](crate::Stop); there is none without one.
    StopSpeed,
}

impl Peaked {
    /// Returns the row of the motion that it is; a touch is none.
    pub(crate) fn row(self) -> Option<usize> {
        match self {
            Self::PseudoVelocity => Some(Modes::DISPLACEMENT),
            Self::AccelerationOverOmega => Some(Modes::ACCELERATION),
            Self::StopSpeed => None,
        }
    }
}

/// A mark within an interval, in phase τ from its begin.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Mark {
    pub(crate) value: f64,
    pub(crate) tau: f64,
    pub(crate) interval: usize,
}

/// Value of τ where only the block of a sample is known.
const UNPLACED: f64 = -1.0;

/// Running extremes of one quantity.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Range {
    pub(crate) high: Mark,
    pub(crate) low: Mark,
    /// True if only the larger one counts: values that are smaller in size are passed over.
    peak: bool,
}

impl Range {
    /// Creates a range that notes the extreme of larger absolute value alone, beyond `above` in size.
    pub(crate) fn beyond(above: f64) -> Self {
        let mark = |value| Mark { value, ..Mark::default() };
        Self { high: mark(above.max(0.0)), low: mark(-above.max(0.0)), peak: true }
    }
    /// Creates a range that notes extremes beyond these values.
    pub(crate) fn outside(low: f64, high: f64) -> Self {
        let mark = |value| Mark { value, ..Mark::default() };
        Self { high: mark(high), low: mark(low), peak: false }
    }
    /// Returns the larger extreme in absolute value, if it passes `above`.
    pub(crate) fn peak_above(&self, above: f64, omega: f64, start: impl Fn(usize) -> f64) -> Option<Extreme> {
        Some(self.extremes(omega, start).peak()).filter(|peak| peak.value.abs() > above.max(0.0))
    }
    #[inline]
    pub(crate) fn note(&mut self, interval: usize, tau: f64, value: f64) {
        // Of two equal sizes the earlier counts, and its mirror image does not.
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
    /// Notes the largest sample of a block; [`Self::place`] later finds its place within the block.
    pub(crate) fn note_block(&mut self, block: usize, value: f64) {
        self.note(block, UNPLACED, value);
    }
    /// Returns whether the largest or the smallest value is a sample of this block whose place is not known.
    pub(crate) fn is_unplaced(&self, block: usize) -> bool {
        [self.high, self.low].iter().any(|mark| mark.tau < 0.0 && mark.interval == block)
    }
    /// Gives the value of a sample of the block: if it is one of the two extremes, this is its place.
    pub(crate) fn place(&mut self, block: usize, interval: usize, value: f64) {
        let extreme = [value >= self.high.value, value <= self.low.value];
        for (mark, is_it) in [&mut self.high, &mut self.low].into_iter().zip(extreme) {
            if is_it && mark.tau < 0.0 && mark.interval == block {
                (mark.interval, mark.tau) = (interval, 0.0);
            }
        }
    }
    /// Notes the free motion from `m` over `span`: its start and its turning points. Its end is the start of the next
    /// motion.
    #[inline]
    pub(crate) fn note_free(&mut self, modes: &Modes, k: usize, m: Motion, span: f64, interval: usize) {
        self.note(interval, 0.0, modes.quantity(k, m));
        let seen = (self.low.value, self.high.value);
        modes.free_extremes(k, m, span, seen, |tau, value| self.note(interval, tau, value));
    }
    /// Notes the motion under a constant forcing from now on, which tends to x = f.
    pub(crate) fn note_carried(&mut self, modes: &Modes, k: usize, m: Motion, forcing: f64, interval: usize) {
        if forcing == 0.0 {
            return self.note_free(modes, k, m, f64::INFINITY, interval);
        }
        self.note(interval, 0.0, modes.quantity(k, m));
        let swing = Motion { x: m.x - forcing, w: m.w - modes.sigma * forcing };
        let about = match k {
            Modes::DISPLACEMENT => forcing,
            Modes::VELOCITY => 0.0,
            _ => -forcing,
        };
        // Damped beyond critical it comes ever closer to that from one side.
        self.note(interval, 0.0, about);
        let seen = (self.low.value - about, self.high.value - about);
        modes.free_extremes(k, swing, f64::INFINITY, seen, |tau, value| self.note(interval, tau, about + value));
    }
    /// Returns the extremes and their times; interval i begins at `start(i)`.
    pub(crate) fn peaks(&self, omega: f64, start: impl Fn(usize) -> f64) -> Peaks {
        let peak = |m: Mark| Peak { value: m.value, time: start(m.interval) + m.tau / omega };
        Peaks { high: peak(self.high), low: peak(self.low) }
    }
    pub(crate) fn extremes(&self, omega: f64, start: impl Fn(usize) -> f64) -> Extremes {
        let mark = |m: Mark| Extreme { value: m.value, time: start(m.interval) + m.tau / omega, interval: m.interval };
        Extremes { positive: mark(self.high), negative: mark(self.low) }
    }
}

/// A value and the time at which it is reached.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Peak {
    pub(crate) value: f64,
    pub(crate) time: f64,
}

/// The largest positive and the largest negative value of one quantity over a part of its history.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Peaks {
    pub(crate) high: Peak,
    pub(crate) low: Peak,
}

impl Peaks {
    /// Returns the larger of the two in absolute value; the earlier one if they tie.
    pub(crate) fn largest(&self) -> Peak {
        let [high, low] = [self.high, Peak { value: -self.low.value, ..self.low }];
        if low.value > high.value || (low.value >= high.value && low.time < high.time) { low } else { high }
    }
}

/// The largest values that a component reaches, exactly.
///
/// z and A are infinite where they overflow (ω below 10⁻³⁰⁰ or above 10³⁰⁰); as velocities,
/// [`pseudo_velocity`](Self::pseudo_velocity) and [`acceleration_over_omega`](Self::acceleration_over_omega), they
/// remain known.
///
/// Signs: z is the displacement of the component relative to its base, so that a base that accelerates upward first
/// drives z downward and the absolute acceleration A = −(2ζωz′ + ω²z) upward.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Response {
    omega: f64,
    /// ωz and A/ω as computed: the way back from z and A would lose values that overflow there.
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
    /// Returns the pseudo-velocity ωz.
    #[must_use]
    pub fn pseudo_velocity(&self) -> Extremes {
        self.pseudo_velocity
    }
    /// Returns the absolute acceleration as a velocity, A/ω.
    #[must_use]
    pub fn acceleration_over_omega(&self) -> Extremes {
        self.acceleration_over_omega
    }
    /// Returns the equivalent static acceleration ω²z: in size the steady acceleration of the base that bends the
    /// suspension as far. Its sign is that of z: a base that accelerates upward makes it negative first.
    #[must_use]
    pub fn equivalent_static_acceleration(&self) -> Extremes {
        self.pseudo_velocity.map(|x| self.omega * x)
    }
    /// Returns the same response with its intervals up to `last`, which later ones belong to.
    pub(crate) fn last_interval(mut self, last: usize) -> Self {
        let of = |extremes: &mut Extremes| {
            for extreme in [&mut extremes.positive, &mut extremes.negative] {
                extreme.interval = extreme.interval.min(last);
            }
        };
        of(&mut self.pseudo_velocity);
        of(&mut self.acceleration_over_omega);
        of(&mut self.relative_displacement);
        of(&mut self.relative_velocity);
        of(&mut self.absolute_acceleration);
        self
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
