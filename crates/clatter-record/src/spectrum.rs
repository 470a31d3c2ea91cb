//! Shock response spectra of records.

use clatter_shock::samples::float;
use clatter_shock::{DampingRatio, Frequencies, Quantity, Spectrum, SpectrumFilter, UnevenFilter};

use crate::between::{BAND, UpSampler};
use crate::{Channel, Error};

/// The course of the acceleration between samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Between {
    /// A history without content from half the sampling rate on; of uneven records straight lines.
    #[default]
    BandLimited,
    /// Straight lines.
    Linear,
}

/// Samples that are handed to a filter at a time.
const PIECE: usize = 1 << 14;

impl Channel {
    /// The shock response spectrum of the channel, its times on the axis of the file; `progress` is told how many samples are done.
    ///
    /// # Accuracy
    /// Straight lines: exact for what they say, but for rounding. Band-limited: within 0.1 % for a record
    /// without content above 0.4 of the sampling rate, which is 2.5 samples a cycle, at any natural frequency. A record with
    /// content above, such as corners of pulses, rings by it: there is no telling from samples alone.
    ///
    /// # Errors
    /// Those of [`SpectrumFilter::new`].
    pub fn spectrum(
        &self,
        frequencies: &Frequencies,
        damping: DampingRatio,
        quantity: Quantity,
        between: Between,
        mut progress: impl FnMut(u64),
    ) -> Result<Spectrum, Error> {
        let filter = |step_s| SpectrumFilter::new(frequencies.clone(), damping, quantity, step_s);
        let values = &self.values;
        let mut spectrum = match (self.times.step_s(), between) {
            (None, _) => {
                let mut filter = UnevenFilter::new(frequencies.clone(), damping, quantity);
                let times_s: Vec<f64> = self.times.times_s().collect();
                for (i, (times_s, piece)) in times_s.chunks(PIECE).zip(values.chunks(PIECE)).enumerate() {
                    filter.push(times_s, piece)?;
                    progress((i * PIECE + piece.len()) as u64);
                }
                filter.finish()?
            }
            (Some(step_s), Between::Linear) => {
                let mut filter = filter(step_s)?;
                for (i, piece) in values.chunks(PIECE).enumerate() {
                    filter.push(piece);
                    progress((i * PIECE + piece.len()) as u64);
                }
                filter.finish()?
            }
            (Some(step_s), Between::BandLimited) => {
                // A stiff or heavily damped part goes along with what lines add beyond the band, so that it takes more points.
                let highest = frequencies.hz().iter().fold(0.0_f64, |most, hz| most.max(*hz));
                if highest * (1.0 + 2.0 * damping.get()) * step_s > BAND {
                    points::<16>(values, filter(step_s / 16.0)?, &mut progress)?
                } else {
                    points::<4>(values, filter(step_s / 4.0)?, &mut progress)?
                }
            }
        };
        // The filters count from the first sample on.
        spectrum.time_of_peak_s.iter_mut().for_each(|time| *time += self.times.start_s());
        Ok(spectrum)
    }
}

impl Channel {
    /// The history of the channel as points with straight lines between them, in seconds since the first sample and m/s²: the samples,
    /// or where they are even and the record is band-limited 16 points for each.
    #[must_use]
    pub fn history(&self, between: Between) -> Vec<(f64, f64)> {
        const POINTS: usize = 16;
        let (Some(step_s), Between::BandLimited) = (self.times.step_s(), between) else {
            return self.times.times_s().zip(self.values.iter().copied()).collect();
        };
        let mut points = Vec::with_capacity(POINTS * self.values.len());
        let mut more = UpSampler::<POINTS>::new();
        let mut each = |values: &[f64]| {
            for value in values {
                let time_s = float(points.len()) * step_s / float(POINTS);
                points.push((time_s, *value));
            }
        };
        more.push(&self.values, &mut each);
        more.finish(&mut each);
        points
    }
}

/// Through a filter by so many points a sample.
fn points<const POINTS: usize>(
    values: &[f64],
    mut filter: SpectrumFilter,
    progress: &mut dyn FnMut(u64),
) -> Result<Spectrum, Error> {
    let mut more = UpSampler::<POINTS>::new();
    for (i, piece) in values.chunks(PIECE / POINTS).enumerate() {
        more.push(piece, &mut |points| filter.push(points));
        progress((i * PIECE / POINTS + piece.len()) as u64);
    }
    more.finish(&mut |points| filter.push(points));
    Ok(filter.finish()?)
}
