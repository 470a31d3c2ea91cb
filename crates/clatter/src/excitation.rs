//! What shakes a part: the acceleration of its place over time, in sections that are sums of known functions.
//!
//! A part that falls with the body and is then carried by it feels the acceleration of its place above free fall, `a + g`.

use std::ops::Range;

/// A sinusoid of a [`Section`], `amplitude · sin(phase + rate t)` with t from its begin.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sine {
    /// With its sign.
    pub amplitude: f64,
    /// Positive.
    pub rate: f64,
    /// In rad.
    pub phase: f64,
}

/// A time in which the acceleration of a place is one sum of known functions: a velocity shock, then a straight line and sinusoids
/// besides. In any units that go together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section<'a> {
    /// When it begins.
    pub from: f64,
    /// How long it lasts; 0 for the shock alone.
    pub length: f64,
    /// Velocity shock as it begins.
    pub delta_v: f64,
    /// Acceleration at its begin and its end, on a straight line between.
    pub acceleration: [f64; 2],
    /// What swings besides.
    pub sines: &'a [Sine],
    /// Whether nothing presses all along it: what is felt then is the turning of the body alone, and no shock.
    pub free: bool,
}

impl Section<'_> {
    /// Nothing but a velocity shock.
    #[must_use]
    #[inline]
    pub const fn shock(from: f64, length: f64, delta_v: f64) -> Self {
        Self { from, length, delta_v, acceleration: [0.0; 2], sines: &[], free: false }
    }
    /// Acceleration at a time after its begin.
    #[must_use]
    #[inline]
    pub fn acceleration_at(&self, t: f64) -> f64 {
        let [a, b] = self.acceleration;
        let share = if self.length > 0.0 { t / self.length } else { 0.0 };
        a + (b - a) * share + self.sines.iter().map(|s| s.amplitude * libm::sin(s.phase + s.rate * t)).sum::<f64>()
    }
    /// Change of velocity from its begin, shock included, until a time after it.
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
    sections: Vec<Kept>,
    sines: Vec<Sine>,
}

#[derive(Debug, Clone, PartialEq)]
struct Kept {
    from: f64,
    length: f64,
    delta_v: f64,
    acceleration: [f64; 2],
    sines: Range<usize>,
    free: bool,
}

impl Excitation {
    /// Nothing yet, with room for so many sections.
    #[must_use]
    pub fn with_capacity(sections: usize) -> Self {
        Self { sections: Vec::with_capacity(sections), sines: Vec::with_capacity(2 * sections) }
    }
    /// Appends a section. Sinusoids without an amplitude or a rate are left out.
    #[inline]
    pub fn push(&mut self, section: Section<'_>) {
        let first = self.sines.len();
        self.sines.extend(section.sines.iter().filter(|s| s.amplitude != 0.0 && s.rate > 0.0));
        let Section { from, length, delta_v, acceleration, free, .. } = section;
        self.sections.push(Kept { from, length, delta_v, acceleration, sines: first..self.sines.len(), free });
    }
    /// Adds a steady acceleration to all sections from the one of this number on.
    #[inline]
    pub fn lift(&mut self, first: usize, acceleration: f64) {
        self.sections[first..].iter_mut().flat_map(|s| &mut s.acceleration).for_each(|a| *a += acceleration);
    }
    #[inline]
    fn view<'a>(&'a self, kept: &Kept) -> Section<'a> {
        let Kept { from, length, delta_v, acceleration, free, .. } = *kept;
        Section { from, length, delta_v, acceleration, sines: &self.sines[kept.sines.clone()], free }
    }
    /// The section of this number, from 0.
    ///
    /// # Panics
    /// If there is none.
    #[must_use]
    #[inline]
    pub fn section(&self, number: usize) -> Section<'_> {
        self.view(&self.sections[number])
    }
    /// All sections in order.
    #[must_use]
    #[inline]
    pub fn sections(&self) -> impl ExactSizeIterator<Item = Section<'_>> + Clone {
        self.sections.iter().map(|kept| self.view(kept))
    }
}
