//! The baseline of a record: the offset and the drift of the sensor, taken out before anything is integrated.

use crate::Error;
use clatter_shock::samples::{check, float, peak, sum};

/// Which baseline is taken out.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Baseline {
    /// The mean of all samples.
    Mean,
    /// The straight line of least squares through all samples.
    Linear,
    /// The mean of the samples before the shock.
    ///
    /// The shock begins at the first sample that is further from the mean of the first 16 than `share` times the
    /// furthest one.
    PreShock {
        /// In (0, 1); [`PRE_SHOCK_SHARE`] by default.
        share: f64,
    },
}

/// Share of the peak at which the shock begins, if nobody says otherwise: above the noise of a usable record, and so
/// low that the rise up to it is short.
pub const PRE_SHOCK_SHARE: f64 = 0.05;

/// The fewest samples before the shock: their mean keeps a quarter of the noise of one (1/√16).
const FEWEST: usize = 16;

/// The baseline that was taken out: offset + drift · t, t from the first sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Removed {
    /// At the first sample, m/s².
    pub offset_m_s2: f64,
    /// Change with time, m/s³; zero but for [`Baseline::Linear`].
    pub drift_m_s3: f64,
    /// How many samples it was taken from.
    pub samples: usize,
}

/// Takes the baseline out of a record, in place, and tells what was taken out.
///
/// With n samples aᵢ, i from 0, and c = (n − 1)/2:
/// ```text
/// mean         ā = Σaᵢ/n
/// linear       drift = Σ(i − c)aᵢ / (step · n(n² − 1)/12),   offset = ā − drift · c · step
/// pre-shock    Σaᵢ/m over the m samples before the shock
/// ```
///
/// # Accuracy
///
/// The sums are compensated: offset and drift are those of the samples within 4 roundings of the largest sample, at any
/// length. What the rise of the shock adds to the mean before it is below the share, times the peak, times the part of
/// the samples in which it rises.
///
/// # Errors
///
/// [`Error::Quantity`] for a share outside (0, 1); [`Error::Shock`] for a time between samples outside [1e-15, 1e9] s, a sample
/// that is not usable, no sample, or one for a line; for a mean before the shock [`Error::Shock`] where all samples are alike, and
/// [`Error::NoQuiet`] where fewer than 16 come before it. The record is then as it was.
///
/// # Examples
///
/// ```
/// use clatter_record::{Baseline, remove_baseline};
/// let mut record = [1.0, 3.0, 5.0, 7.0]; // one more m/s² every half a second, twice over
/// let removed = remove_baseline(&mut record, 0.5, Baseline::Linear)?;
/// assert_eq!((removed.offset_m_s2, removed.drift_m_s3), (1.0, 4.0));
/// assert_eq!(record, [0.0; 4]);
/// # Ok::<(), clatter_record::Error>(())
/// ```
pub fn remove_baseline(acceleration: &mut [f64], step_s: f64, baseline: Baseline) -> Result<Removed, Error> {
    let removed = match baseline {
        Baseline::Mean => {
            check(acceleration, step_s, "a mean", 1)?;
            constant(acceleration)
        }
        Baseline::Linear => {
            check(acceleration, step_s, "a line", 2)?;
            line(acceleration, step_s)
        }
        Baseline::PreShock { share } => {
            check(acceleration, step_s, "a mean before the shock", FEWEST + 1)?;
            constant(&acceleration[..quiet(acceleration, share)?])
        }
    };
    let slope = removed.drift_m_s3 * step_s;
    for (i, a) in acceleration.iter_mut().enumerate() {
        *a -= removed.offset_m_s2 + slope * float(i);
    }
    Ok(removed)
}

fn constant(samples: &[f64]) -> Removed {
    let offset_m_s2 = sum(samples.iter().copied()) / float(samples.len());
    Removed { offset_m_s2, drift_m_s3: 0.0, samples: samples.len() }
}

fn line(samples: &[f64], step_s: f64) -> Removed {
    let n = float(samples.len());
    let center = 0.5 * (n - 1.0);
    // From the middle, so that a large offset does not hide the slope.
    let moment = sum(samples.iter().enumerate().map(|(i, a)| (float(i) - center) * a));
    let slope = moment / (n * (n * n - 1.0) / 12.0);
    let mean = constant(samples).offset_m_s2;
    Removed { offset_m_s2: mean - slope * center, drift_m_s3: slope / step_s, samples: samples.len() }
}

/// How many samples come before the shock.
fn quiet(samples: &[f64], share: f64) -> Result<usize, Error> {
    if !(share > 0.0 && share < 1.0) {
        return Err(Error::Quantity { name: "share of the peak", value: share, allowed: "in (0, 1)" });
    }
    let level = constant(&samples[..FEWEST]).offset_m_s2;
    let away: Vec<f64> = samples.iter().map(|a| a - level).collect();
    let largest = away[peak(&away)].abs();
    if largest == 0.0 {
        return Err(clatter_shock::Error::NoShock.into());
    }
    let begin = away.iter().position(|a| a.abs() > share * largest).unwrap_or(away.len());
    if begin < FEWEST {
        return Err(Error::NoQuiet { samples: begin, needed: FEWEST, share });
    }
    Ok(begin)
}
