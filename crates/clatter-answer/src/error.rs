//! Why a question has no answer.

use clatter_assess::fit::MOST_SAMPLES;
use clatter_shock::Pulse;

/// A question that nothing answers: the value, and what is allowed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A number outside its range.
    #[error("{name} = {value:?} is not {allowed}")]
    Quantity {
        /// What the value stands for, with its unit.
        name: &'static str,
        /// The value.
        value: f64,
        /// The range that makes sense.
        allowed: &'static str,
    },
    /// Inputs without which there is no drop.
    #[error("the drop is not whole: give {}", .0.join(", "))]
    Missing(Vec<&'static str>),
    /// An input that no drop has, or not beside the others.
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
        /// Of the longest pulse.
        duration_s: f64,
        /// The highest that is asked for.
        frequency_hz: f64,
    },
    /// Goals of which the first is no safe zone.
    #[error("the first goal is a safe zone, whose front is given: a goal of turning needs one beside it")]
    NoZone,
    /// A record without shocks, or with too many for a spectrum of each.
    #[error("{count} shocks beyond {threshold_m_s2:?} m/s2; spectra are made of 1 to {most}")]
    Shocks {
        /// How many there are.
        count: usize,
        /// What they pass.
        threshold_m_s2: f64,
        /// How many there may be.
        most: usize,
    },
    /// What one of several records does not hold.
    #[error("{file}: {reason}")]
    OfRecord {
        /// Its file.
        file: String,
        /// What it is.
        reason: clatter_record::Error,
    },
    /// A record of an acceleration with more channels than the one of its place.
    #[error("{0} channels; a fit takes the one of its place")]
    Channels(usize),
    /// A record that is longer than a fit takes.
    #[error("{0} samples; a fit takes {MOST_SAMPLES} at most")]
    Samples(usize),
    /// A record of bounces beside others.
    #[error("a record of bounces is of another drop: fit it alone")]
    Bounces,
    /// A radius of gyration in m that counts as known, and is a range.
    #[error("the radius of gyration is to be known, and the product has a range, {} to {} m", .0[0], .0[1])]
    GyrationRange([f64; 2]),
    /// What the bar or the plate does not accept.
    #[error(transparent)]
    Bar(#[from] clatter::Error),
    /// What the flight does not accept.
    #[error(transparent)]
    Flight(#[from] clatter_flight::Error),
    /// What the part or its shocks do not accept.
    #[error(transparent)]
    Shock(#[from] clatter_shock::Error),
    /// What the product or its drop does not accept.
    #[error(transparent)]
    Assess(clatter_assess::Error),
    /// What measured drops do not tell.
    #[error(transparent)]
    Fit(#[from] clatter_assess::fit::Error),
    /// What a record does not hold.
    #[error(transparent)]
    Record(#[from] clatter_record::Error),
}

impl Error {
    pub(crate) fn input(name: &'static str, reason: impl Into<String>) -> Self {
        Self::Input { name, reason: reason.into() }
    }
}

impl From<clatter_assess::Error> for Error {
    fn from(error: clatter_assess::Error) -> Self {
        if let clatter_assess::Error::Flight(error) = error { Self::Flight(error) } else { Self::Assess(error) }
    }
}

/// Periods of a part that a pulse may last: each of its turning points is found.
const MOST_PERIODS: f64 = 1e5;

/// Refuses pulses that last too many periods of a part.
pub(crate) fn within_periods(pulses: &[Pulse], frequencies_hz: &[f64]) -> Result<(), Error> {
    let longest = |xs: &mut dyn Iterator<Item = f64>| xs.fold(0.0, f64::max);
    let duration_s = longest(&mut pulses.iter().map(|pulse| pulse.duration));
    let frequency_hz = longest(&mut frequencies_hz.iter().copied());
    if duration_s * frequency_hz <= MOST_PERIODS { Ok(()) } else { Err(Error::LongPulse { duration_s, frequency_hz }) }
}
