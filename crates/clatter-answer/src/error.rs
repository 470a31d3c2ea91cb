//! This module has the reasons why a question has no answer.

use clatter_fit::MOST_SAMPLES;
use clatter_shock::Pulse;

/// A question that nothing answers: the value, and what is allowed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A number outside its range.
    #[error("{name} = {value:?} is not {allowed}")]
    Quantity {
        /// The quantity that the value stands for, with its unit.
        name: &'static str,
        /// The value.
        value: f64,
        /// The range that makes sense.
        allowed: &'static str,
    },
    /// Inputs without which there is no drop.
    #[error("the drop is not whole: give {}", .0.join(", "))]
    Missing(Vec<&'static str>),
    /// An input that no drop has, or that does not go together with the others.
    #[error("{name}: {reason}")]
    Input {
        /// Its name, with its unit.
        name: &'static str,
        /// The value and what is allowed.
        reason: String,
    },
    /// A pulse that no part is followed through.
    #[error("a pulse of {duration_s:?} s lasts more than 100000 periods of a component of {frequency_hz:?} Hz")]
    LongPulse {
        /// The duration of the longest pulse.
        duration_s: f64,
        /// The highest requested frequency.
        frequency_hz: f64,
    },
    /// Goals of which the first is no safe zone.
    #[error("the first goal is a safe zone, whose front is given: a goal of turning needs one beside it")]
    NoZone,
    /// A record without shocks, or with too many for a spectrum of each.
    #[error("{count} shocks beyond {threshold_m_s2:?} m/s2; spectra are made of 1 to {most}")]
    Shocks {
        /// The number of shocks.
        count: usize,
        /// The threshold that the shocks exceed.
        threshold_m_s2: f64,
        /// The largest number that is allowed.
        most: usize,
    },
    /// A fault in one of several records.
    #[error("{file}: {reason}")]
    OfRecord {
        /// Its file.
        file: String,
        /// The fault.
        reason: clatter_record::Error,
    },
    /// A record of an acceleration with more channels than the one of its place.
    #[error("{0} channels; a fit takes the one of its place")]
    Channels(usize),
    /// A record that is longer than a fit takes.
    #[error("{0} samples; a fit takes {MOST_SAMPLES} at most")]
    Samples(usize),
    /// A record of bounces together with other records.
    #[error("a record of bounces is of another drop: fit it alone")]
    Bounces,
    /// A radius of gyration in m that counts as known, and is a range.
    #[error("the radius of gyration is to be known, and the product has a range, {} to {} m", .0[0], .0[1])]
    GyrationRange([f64; 2]),
    /// A fault in the bar or the plate.
    #[error(transparent)]
    Bar(#[from] clatter::Error),
    /// A fault in the flight.
    #[error(transparent)]
    Flight(#[from] clatter_flight::Error),
    /// A fault in the part or its shocks.
    #[error(transparent)]
    Shock(#[from] clatter_shock::Error),
    /// A fault in the product or its drop.
    #[error(transparent)]
    Assess(clatter_product::Error),
    /// A fault in the fit of measured drops.
    #[error(transparent)]
    Fit(#[from] clatter_fit::Error),
    /// A fault in a record.
    #[error(transparent)]
    Record(#[from] clatter_record::Error),
}

impl Error {
    pub(crate) fn input(name: &'static str, reason: impl Into<String>) -> Self {
        Self::Input { name, reason: reason.into() }
    }
}

impl From<clatter_product::Error> for Error {
    fn from(error: clatter_product::Error) -> Self {
        if let clatter_product::Error::Flight(error) = error { Self::Flight(error) } else { Self::Assess(error) }
    }
}

/// The number of periods of a part that a pulse may last: each of its turning points is found.
const MOST_PERIODS: f64 = 1e5;

/// Refuses pulses that last too many periods of a part.
pub(crate) fn within_periods(pulses: &[Pulse], frequencies_hz: &[f64]) -> Result<(), Error> {
    let longest = |xs: &mut dyn Iterator<Item = f64>| xs.fold(0.0, f64::max);
    let duration_s = longest(&mut pulses.iter().map(|pulse| pulse.duration));
    let frequency_hz = longest(&mut frequencies_hz.iter().copied());
    if duration_s * frequency_hz <= MOST_PERIODS { Ok(()) } else { Err(Error::LongPulse { duration_s, frequency_hz }) }
}
