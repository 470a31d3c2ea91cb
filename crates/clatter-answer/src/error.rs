//! Why a question has no answer.

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
    /// A pulse that no part is followed through.
    #[error("a pulse of {duration_s:?} s lasts more than 100000 periods of a component of {frequency_hz:?} Hz")]
    LongPulse {
        /// Of the longest pulse.
        duration_s: f64,
        /// The highest that is asked for.
        frequency_hz: f64,
    },
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
}

impl From<clatter_assess::Error> for Error {
    fn from(error: clatter_assess::Error) -> Self {
        if let clatter_assess::Error::Flight(error) = error { Self::Flight(error) } else { Self::Assess(error) }
    }
}

/// Periods of a part that a pulse may last: each takes work.
const MOST_PERIODS: f64 = 1e5;

/// Refuses pulses that last too many periods of a part.
pub(crate) fn within_periods(pulses: &[Pulse], frequencies_hz: &[f64]) -> Result<(), Error> {
    let longest = |xs: &mut dyn Iterator<Item = f64>| xs.fold(0.0, f64::max);
    let duration_s = longest(&mut pulses.iter().map(|pulse| pulse.duration));
    let frequency_hz = longest(&mut frequencies_hz.iter().copied());
    if duration_s * frequency_hz <= MOST_PERIODS { Ok(()) } else { Err(Error::LongPulse { duration_s, frequency_hz }) }
}
