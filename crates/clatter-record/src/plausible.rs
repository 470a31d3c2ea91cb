//! Rates and units that are told of a record are held against its numbers.

use clatter_shock::samples::float;

use crate::raw::Untimed;
use crate::unit::Unit;
use crate::{Error, Finding};

/// Holds a rate against times that a file has as well, which may be rounded by so much. Samples that are missing by both are an
/// error.
pub(crate) fn against_times(
    step_s: f64,
    since_s: &[f64],
    rounded_s: f64,
    what: &str,
) -> Result<Option<Finding>, Error> {
    /// Rates that differ by less are one.
    const SAME: f64 = 0.01;
    let steps = since_s.len().saturating_sub(1);
    if steps == 0 {
        return Ok(None);
    }
    let count = float(steps);
    let mut sorted: Vec<f64> = since_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let (span_s, expected_s) = (since_s[steps], step_s * count);
    if (span_s - expected_s).abs() <= step_s + 2.0 * rounded_s + SAME * expected_s {
        return Ok(None);
    }
    let usual_s = *sorted.select_nth_unstable_by(steps / 2, f64::total_cmp).1;
    let is_usual = (usual_s / step_s - 1.0).abs() <= SAME + rounded_s / step_s * 0.5;
    if is_usual && span_s > expected_s {
        return Err(Error::Columns(format!(
            "by {what} {} samples take {expected_s:.6e} s, and by their times {span_s:.6e} s, though most are {step_s:.6e} s apart: \
             samples are missing",
            steps + 1
        )));
    }
    Ok(Some(Finding::Rate { what: what.to_owned(), told_hz: step_s.recip(), times_hz: count / span_s }))
}

/// Refuses whole numbers that are large at rest, for which units are given: counts of a converter.
pub(crate) fn refuse_counts(channels: &[Untimed]) -> Result<(), Error> {
    /// Nothing at rest is accelerated so, in m/s².
    const REST: f64 = 30.0;
    /// Samples that show a rest.
    const SAMPLES: usize = 8;
    for channel in channels {
        let Some(first) = channel.values.first().filter(|_| channel.values.len() > SAMPLES) else { continue };
        let rests = channel.values[..SAMPLES].iter().all(|value| value.to_bits() == first.to_bits());
        let Some(unit) = Unit::of(&channel.unit).filter(|_| rests && first.abs() > REST) else { continue };
        let counts =
            |value: &f64| (value / unit.size - (value / unit.size).round()).abs() < 1e-9 * (value / unit.size).abs();
        if channel.values.iter().all(|value| *value == 0.0 || counts(value)) {
            return Err(Error::Units(format!(
                "{} is {} in all of its first samples, and a whole number in all: counts of a converter, it seems, and not {}",
                channel.name,
                first / unit.size,
                channel.unit
            )));
        }
    }
    Ok(())
}
