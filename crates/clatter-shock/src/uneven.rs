//! Spectra of unevenly sampled records: the exact response to straight lines between samples, eight frequencies side by
//! side.
//!
//! Over a step in which the acceleration is linear, the motion obeys
//!
//! ```text
//! x ← x + (f₀ − x) X₀ + (w − σx) h + f₁ X₁
//! w ← w + (f₀ − ρw − px) h + (σf₀ + f₁ − w) X₀ + σf₁ X₁
//! ```
//!
//! with the forcing f₀ + f₁τ, the impulse response h and its first two integrals X₀ and X₁. X₀ and X₁ come from power
//! series where the step is short, which cost less than sine and exponential, and h is τ − 2ζX₀ − X₁: nothing cancels
//! at frequencies far below the sampling rate. Longer steps take the closed forms.
//!
//! Steps are taken a block at a time. Where bounds on the motion say that a block can hold no new extreme, it is
//! crossed in one leap or in a few. A leap is the effect of several steps on every part, in powers of their phase that
//! all frequencies share. Where a peak between two samples may pass the largest value so far, it is found exactly.

mod group;
mod steps;

use crate::eight::WIDTH;
use crate::peaks::{Peak, Peaks, Range};
use crate::suspension::{Modes, Motion};
use crate::{DampingRatio, Error, Frequencies, Quantity, Spectrum};
use group::{Constants, Group, Run};
use std::f64::consts::TAU;
use steps::{Block, Series, Step};

/// Steps between two bounds.
const BLOCK: usize = 32;
/// Steps that are processed for one group of frequencies before the next: they stay in the nearest cache.
const CHUNK: usize = 16 * BLOCK;

/// A shock response spectrum in progress, from samples at any times. They come in pieces of any size; memory does not
/// grow.
///
/// [`SpectrumFilter`](crate::SpectrumFilter) is faster for samples that are even in time.
#[derive(Debug, Clone)]
pub struct UnevenFilter {
    frequencies: Frequencies,
    damping: DampingRatio,
    quantity: Quantity,
    modes: Modes,
    series: Series,
    groups: Vec<Group>,
    /// Steps that wait for more, so that the result does not depend on the pieces.
    steps: Vec<Step>,
    /// The newest sample.
    last: Option<(f64, f64)>,
    /// Number of samples so far.
    count: usize,
}

impl UnevenFilter {
    /// Creates a filter for samples at any times.
    ///
    /// # Accuracy
    ///
    /// The spectrum is exact for a history that is linear between samples, but for rounding: for steps of 10⁻⁹ to 10
    /// periods and beyond, at any damping, for samples of up to 10¹⁰⁰ m/s² ([`crate::accuracy::RECORD`]). The component
    /// is at rest before the first sample; after the last the acceleration is zero and the ring-down is complete.
    ///
    /// # Examples
    ///
    /// ```
    /// # use clatter_shock::{DampingRatio, Frequencies, Quantity, UnevenFilter};
    /// let mut filter = UnevenFilter::new(
    ///     Frequencies::list(vec![10.0])?,
    ///     DampingRatio::new(0.0)?,
    ///     Quantity::AbsoluteAcceleration,
    /// );
    /// filter.push(&[2.0, 2.01, 2.05], &[1.0, 1.0, 1.0])?; // a rectangle of half a period doubles
    /// let spectrum = filter.finish()?;
    /// assert!((spectrum.maximax[0] - 2.0).abs() < 1e-12);
    /// assert!((spectrum.time_of_peak_s[0] - 2.05).abs() < 1e-8);
    /// # Ok::<(), clatter_shock::Error>(())
    /// ```
    #[must_use]
    pub fn new(frequencies: Frequencies, damping: DampingRatio, quantity: Quantity) -> Self {
        let omegas: Vec<f64> = frequencies.hz().iter().map(|f| TAU * f).collect();
        let groups = omegas.chunks(WIDTH).map(|chunk| Group::new(chunk, quantity.row(chunk[0]).0)).collect();
        let modes = Modes::new(damping);
        let series = Series::new(&modes);
        Self {
            frequencies,
            damping,
            quantity,
            modes,
            series,
            groups,
            steps: Vec::with_capacity(CHUNK),
            last: None,
            count: 0,
        }
    }
    /// Processes more samples: their times in seconds, in order, and the base acceleration there. Two samples at one
    /// time are a jump.
    ///
    /// # Errors
    /// [`Error::Entry`] for a value that is not finite, [`Error::TimeOrder`] where times run back, entries counted from
    /// the first sample of all; [`Error::Lengths`] unless there are as many times as accelerations. No sample of the
    /// piece is then processed.
    pub fn push(&mut self, times_s: &[f64], accelerations: &[f64]) -> Result<(), Error> {
        self.check(times_s, accelerations)?;
        self.count = self.count.saturating_add(times_s.len());
        let mut samples = times_s.iter().copied().zip(accelerations.iter().copied());
        if self.last.is_none() {
            self.last = samples.next();
            let start = self.last.map_or(0.0, |sample| sample.0);
            for group in &mut self.groups {
                let rest = Peak { value: 0.0, time: start };
                group.peaks = [Peaks { high: rest, low: rest }; WIDTH];
            }
        }
        let Some(mut last) = self.last else { return Ok(()) };
        for (time, a) in samples {
            let dt = time - last.0;
            let slope = (a - last.1) / dt;
            // A step too short for a slope moves nothing.
            if dt > 0.0 && slope.is_finite() {
                self.steps.push(Step { start: last.0, end: time, dt, from: last.1, to: a, slope });
            }
            last = (time, a);
            if self.steps.len() == CHUNK {
                self.run();
            }
        }
        self.last = Some(last);
        Ok(())
    }
    fn check(&self, times_s: &[f64], accelerations: &[f64]) -> Result<(), Error> {
        if times_s.len() != accelerations.len() {
            return Err(Error::Lengths { times: times_s.len(), values: accelerations.len() });
        }
        let mut previous = self.last.map_or(f64::NEG_INFINITY, |sample| sample.0);
        for (i, (&time, &a)) in times_s.iter().zip(accelerations).enumerate() {
            let entry = self.count.saturating_add(i + 1);
            for (name, value) in [("time", time), ("acceleration", a)] {
                if !value.is_finite() {
                    return Err(Error::Entry { list: RECORD, entry, name, value, allowed: "finite" });
                }
            }
            if time < previous {
                return Err(Error::TimeOrder { list: RECORD, entry, time, previous });
            }
            previous = time;
        }
        Ok(())
    }
    /// Processes the waiting steps.
    fn run(&mut self) {
        let blocks: Vec<Block<'_>> = self.steps.chunks(BLOCK).map(|steps| Block::new(&self.series, steps)).collect();
        let arch = pulp::Arch::new();
        let constants = Constants { modes: &self.modes, series: &self.series };
        for group in &mut self.groups {
            arch.dispatch(Run { group, constants, blocks: &blocks });
        }
        self.steps.clear();
    }
    /// Returns the spectrum, with the ring-down after the last sample.
    /// # Errors
    /// [`Error::Empty`] if no sample came.
    pub fn finish(mut self) -> Result<Spectrum, Error> {
        let (end, _) = self.last.ok_or(Error::Empty(RECORD))?;
        self.run();
        Ok(Spectrum::collect(&self.frequencies, self.damping, self.quantity, |i, omega, k| {
            let (group, l) = (&self.groups[i / WIDTH], i % WIDTH);
            let mut after = Range::default();
            after.note_free(&self.modes, k, Motion { x: group.x[l], w: group.w[l] }, f64::INFINITY, 0);
            [group.peaks[l], after.peaks(omega, |_| end)]
        }))
    }
}

const RECORD: &str = "record";
