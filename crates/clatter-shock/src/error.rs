//! The one error type of the crate. Each error holds the given value, its place and the allowed range.

/// A value that describes no suspension and no shock, or samples that are no history. Each message names the value and the range.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A damping ratio below 0, not finite, or beyond the range of the arithmetic.
    #[error("damping ratio {0:?} is not in [0, 1e60]")]
    DampingRatio(f64),
    /// A quality factor that is not positive.
    #[error("quality factor {0:?} is not at least 1e-60 (infinite: undamped)")]
    QualityFactor(f64),
    /// A number outside its range.
    #[error("{name} = {value:?} is not {allowed}")]
    Quantity {
        /// The quantity, with its unit.
        name: &'static str,
        /// The value.
        value: f64,
        /// The range that makes sense.
        allowed: &'static str,
    },
    /// An entry of a list that is not usable; entries count from 1.
    #[error("{list}, entry {entry}: {name} = {value:?} is not {allowed}")]
    Entry {
        /// The list.
        list: &'static str,
        /// Its entry, from 1.
        entry: usize,
        /// The quantity.
        name: &'static str,
        /// The value.
        value: f64,
        /// The range that makes sense.
        allowed: &'static str,
    },
    /// Times of a list that run back.
    #[error("{list}, entry {entry}: time {time:?} is before {previous:?}, the one above it")]
    TimeOrder {
        /// The list.
        list: &'static str,
        /// Its entry, from 1.
        entry: usize,
        /// Its time.
        time: f64,
        /// The time of the entry above.
        previous: f64,
    },
    /// Times and values that do not go together.
    #[error("there are {times} times and {values} values; each value needs its time")]
    Lengths {
        /// Number of times.
        times: usize,
        /// Number of values.
        values: usize,
    },
    /// A pulse of no length.
    #[error(
        "a pulse of zero duration has no area: give the velocity change of the shock instead (a velocity shock), or a duration > 0"
    )]
    ZeroDuration,
    /// Too many sinusoids of different lengths at once.
    #[error(
        "the pulses overlap in {sines} sinusoids of different lengths, more than {allowed}: give equal pulses equal durations (they then add up), or fewer at a time"
    )]
    Overlap {
        /// Sinusoids between all begins and ends, those of one length counted once.
        sines: usize,
        /// The most that are held.
        allowed: usize,
    },
    /// A list without entries.
    #[error("{0} is empty")]
    Empty(&'static str),
    /// A curve of fewer than two points.
    #[error("{0} has {points}; it needs two at least", points = if *.1 == 1 { "one point" } else { "no points" })]
    Points(&'static str, usize),
    /// The response off center to an endless train at q = 1.
    #[error(
        "at q = 1 and position {position:?} the bar strikes for ever without losing speed, so the response has no limit; only the center (position 0) has one"
    )]
    Unsettled {
        /// Position on the bar.
        position: f64,
    },
    /// A history whose velocity change is zero, to roundings.
    #[error(
        "the velocity change of the history is zero, both directions cancel: it has no damage boundary over velocity change, only a critical acceleration"
    )]
    NoVelocityChange,
    /// A sample that is not usable; samples count from 1.
    #[error("sample {sample}: acceleration (m/s²) = {value:?} is not finite and at most 1e100 in size")]
    Sample {
        /// Its place in the history, from 1.
        sample: usize,
        /// Its value.
        value: f64,
    },
    /// A history too short for the analysis.
    #[error("{what} needs {needed} samples at least; the record has {samples}")]
    Short {
        /// The analysis.
        what: &'static str,
        /// Number of samples.
        samples: usize,
        /// Number of samples needed.
        needed: usize,
    },
    /// A history that never changes.
    #[error("every sample of the record is alike: there is no shock in it")]
    NoShock,
    /// Shock tests that show no critical level.
    #[error("the {0} trials show no critical level: some level without damage must lie below the lowest with damage")]
    Trials(&'static str),
    /// No half-sine of the shock table has the same effect on the component.
    #[error(
        "no half-sine of this shock table is equivalent: {}",
        if nearest.is_finite() {
            format!(
                "at equal acceleration the displacement is off by {} % at best, more than the {} % allowed",
                percent(*nearest, f64::ceil),
                percent(*tolerance, f64::round)
            )
        } else {
            "all that give the same acceleration are beyond its acceleration or velocity change".to_owned()
        }
    )]
    NoEquivalent {
        /// Smallest relative mismatch in displacement; infinite if the table reaches the acceleration with no pulse.
        nearest: f64,
        /// The largest mismatch that was allowed.
        tolerance: f64,
    },
    /// A suspension with a stop where the answer is that of a linear component.
    #[error("{0} takes no stop: give the suspension without it")]
    Stop(&'static str),
    /// A component that touches its stops, or swings on one of them, so often that it is no longer followed.
    #[error(
        "the component touches its stops more than {0} times, or swings on one that often; it is not followed further"
    )]
    Hits(usize),
    /// An invalid bar or drop.
    #[error(transparent)]
    Bar(#[from] clatter::Error),
}

/// Returns a share in percent, with three digits; a share above a limit is rounded up, so that it does not look as if
/// the limit held.
fn percent(share: f64, round: fn(f64) -> f64) -> f64 {
    let percent = 100.0 * share;
    let digit = libm::pow(10.0, libm::log10(percent).floor() - 2.0);
    format!("{:.2e}", round(percent / digit) * digit).parse().unwrap_or(percent)
}

/// Returns `value` if it is finite and greater than zero.
pub(crate) fn positive(name: &'static str, value: f64) -> Result<f64, Error> {
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err(Error::Quantity { name, value, allowed: "finite and > 0" })
    }
}
