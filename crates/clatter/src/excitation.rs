//! The excitation of a part: the acceleration of its place over time, in sections that are sums of known functions.
//!
//! A part that falls with the body and is then carried by it is excited by the acceleration of its place above free
//! fall, `a + g`.

use std::ops::Range;

/// A sinusoid of a [`Section`], `amplitude · sin(phase + rate t)` with t from its begin.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sine {
    /// Amplitude, with its sign.
    pub amplitude: f64,
    /// Angular frequency, positive.
    pub rate: f64,
    /// Phase at the begin of the section, in rad.
    pub phase: f64,
}

/// An interval of time in which the acceleration of a place is one sum of known functions: a velocity shock, then a
/// straight line plus sinusoids. Any consistent units do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section<'a> {
    /// Time of its begin.
    pub from: f64,
    /// Its duration; 0 for the shock alone.
    pub length: f64,
    /// Velocity shock at its begin.
    pub delta_v: f64,
    /// Acceleration at its begin and its end, linear between them.
    pub acceleration: [f64; 2],
    /// Sinusoids that add to the straight line.
    pub sines: &'a [Sine],
    /// True if nothing presses all along the section: the acceleration is then that of the turning of the body alone,
    /// without a shock.
    pub free: bool,
}

impl Section<'_> {
    /// Creates a section that is a velocity shock alone.
    #[must_use]
    #[inline]
    pub const fn shock(from: f64, length: f64, delta_v: f64) -> Self {
        Self { from, length, delta_v, acceleration: [0.0; 2], sines: &[], free: false }
    }
    /// Returns the acceleration at a time after the begin of the section.
    #[must_use]
    #[inline]
    pub fn acceleration_at(&self, t: f64) -> f64 {
        let [a, b] = self.acceleration;
        let share = if self.length > 0.0 { t / self.length } else { 0.0 };
        a + (b - a) * share + self.sines.iter().map(|s| s.amplitude * libm::sin(s.phase + s.rate * t)).sum::<f64>()
    }
    /// Returns the change of velocity from the begin of the section, shock included, to a time after it.
    ///
    /// ```
    /// use clatter::{Section, Sine};
    /// let half_sine = [Sine { amplitude: 3.0, rate: 2.0, phase: 0.0 }];
    /// let pulse = Section { sines: &half_sine, ..Section::shock(0.0, std::f64::consts::FRAC_PI_2, 1.0) };
    /// assert!((pulse.velocity_after(pulse.length) - 4.0).abs() < 1e-15); // 1, and 2 · 3/2
    /// ```
    #[must_use]
    #[inline]
    pub fn velocity_after(&self, t: f64) -> f64 {
        let [a, b] = self.acceleration;
        let share = if self.length > 0.0 { t / self.length } else { 0.0 };
        let one = |s: &Sine| {
            // cos ψ − cos(ψ + νt) without cancellation.
            let half = 0.5 * s.rate * t;
            let over_rate = if s.rate > 0.0 { libm::sin(half) / s.rate } else { 0.5 * t };
            s.amplitude * 2.0 * over_rate * libm::sin(s.phase + half)
        };
        self.delta_v + t * (a + 0.5 * (b - a) * share) + self.sines.iter().map(one).sum::<f64>()
    }
}

/// Sections one after the other; each begins where the one before ends.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Excitation {
    sections: Vec<StoredSection>,
    sines: Vec<Sine>,
}

/// A section as it is stored: its sinusoids are a range of the list of all.
#[derive(Debug, Clone, PartialEq)]
struct StoredSection {
    from: f64,
    length: f64,
    delta_v: f64,
    acceleration: [f64; 2],
    sines: Range<usize>,
    free: bool,
}

impl Excitation {
    /// Creates an excitation without sections, with room for so many.
    #[must_use]
    pub fn with_capacity(sections: usize) -> Self {
        Self { sections: Vec::with_capacity(sections), sines: Vec::with_capacity(2 * sections) }
    }
    /// Appends a section, without the sinusoids that have no amplitude or no rate.
    #[inline]
    pub fn push(&mut self, section: Section<'_>) {
        let first = self.sines.len();
        self.sines.extend(section.sines.iter().filter(|s| s.amplitude != 0.0 && s.rate > 0.0));
        let Section { from, length, delta_v, acceleration, free, .. } = section;
        self.sections.push(StoredSection { from, length, delta_v, acceleration, sines: first..self.sines.len(), free });
    }
    /// Adds a steady acceleration to all sections from the one of this number on.
    #[inline]
    pub fn lift(&mut self, first: usize, acceleration: f64) {
        self.sections[first..].iter_mut().flat_map(|s| &mut s.acceleration).for_each(|a| *a += acceleration);
    }
    #[inline]
    fn view<'a>(&'a self, stored: &StoredSection) -> Section<'a> {
        let StoredSection { from, length, delta_v, acceleration, free, .. } = *stored;
        Section { from, length, delta_v, acceleration, sines: &self.sines[stored.sines.clone()], free }
    }
    /// Returns the section of this number, from 0.
    ///
    /// # Panics
    /// If there is none.
    #[must_use]
    #[inline]
    pub fn section(&self, number: usize) -> Section<'_> {
        self.view(&self.sections[number])
    }
    /// Returns all sections in order.
    #[must_use]
    #[inline]
    pub fn sections(&self) -> impl ExactSizeIterator<Item = Section<'_>> + Clone {
        self.sections.iter().map(|stored| self.view(stored))
    }
}
