//! Records as the fit takes them: checked, of a bounded length, and how each is held against a computed drop.

use clatter::End;
use clatter_flight::Strike;

use super::drop::{Drop, Path};
use super::{Error, Known, MOST_SAMPLES, MOST_STRIKES, Measured, MeasuredHeights, MeasuredStrike};

/// Values of heights and accelerations that are fitted at most: of a longer record some are left out, or taken together.
const MOST_VALUES: usize = 2048;

/// A computed strike, from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Which {
    /// The number of strikes that come before it.
    Of(usize),
    /// The end, and the number of strikes of that end that come before it: two of both ends close together are the same whichever is
    /// measured first.
    OfEnd(End, usize),
}

impl Which {
    /// Returns the place of the strike among all that were computed.
    pub(super) fn find(self, drop: &Drop<'_>, strikes: &[Strike]) -> Option<usize> {
        match self {
            Self::Of(n) => (n < strikes.len()).then_some(n),
            Self::OfEnd(end, n) => {
                let own = strikes.iter().enumerate().filter(|(_, strike)| drop.end(strike.point) == end);
                own.map(|(k, _)| k).nth(n)
            }
        }
    }
}

/// A record as the fit takes it.
#[derive(Debug, Clone)]
pub(super) enum Set<'a> {
    Strikes {
        strikes: &'a [MeasuredStrike],
        /// The computed strike that each one is; none of one that is left out.
        index: Vec<Option<Which>>,
        deviation: f64,
    },
    Heights {
        samples: Vec<MeasuredHeights>,
        deviation: f64,
    },
    Acceleration {
        /// The place from the middle towards end b, in half-lengths.
        place: f64,
        start_s: f64,
        step_s: f64,
        values: Vec<f64>,
        deviation: f64,
    },
}

impl Set<'_> {
    /// Returns how many strikes are requested: of all, and of ends a and b.
    pub(super) fn needed(&self) -> [usize; 3] {
        let Self::Strikes { index, .. } = self else { return [0; 3] };
        let most = |end: Option<End>| {
            let of = |which: &Which| match *which {
                Which::Of(n) => end.is_none().then_some(n + 1),
                Which::OfEnd(own, n) => (end == Some(own)).then_some(n + 1),
            };
            index.iter().flatten().filter_map(of).max().unwrap_or(0)
        };
        let [all, a, b] = [None, Some(End::A), Some(End::B)].map(most);
        [all.max(a + b), a, b]
    }
    /// Returns a number of computed strikes that has all requested ones among them, unless one end strikes several times in a row more.
    pub(super) fn strikes(&self) -> usize {
        self.needed()[0] + 2
    }
    /// Returns the time from the first to the last measured strike.
    pub(super) fn span_s(&self) -> Option<f64> {
        let Self::Strikes { strikes, .. } = self else { return None };
        strikes.last().zip(strikes.first()).map(|(last, first)| last.time_s - first.time_s)
    }
    /// Returns until when the motion is requested, on the time axis of the record; strikes need their number alone.
    pub(super) fn end_s(&self) -> Option<f64> {
        match self {
            Self::Strikes { .. } => None,
            Self::Heights { samples, .. } => samples.last().map(|sample| sample.time_s),
            #[expect(clippy::cast_precision_loss, reason = "at most a million")]
            Self::Acceleration { start_s, step_s, values, .. } => Some(start_s + step_s * values.len() as f64),
        }
    }
    pub(super) fn deviation(&mut self) -> &mut f64 {
        match self {
            Self::Strikes { deviation, .. }
            | Self::Heights { deviation, .. }
            | Self::Acceleration { deviation, .. } => deviation,
        }
    }
    /// Returns the variation of its data, over their deviation: the time between strikes, the largest height or acceleration.
    pub(super) fn variation(&self, unit_s: f64) -> f64 {
        match self {
            Self::Strikes { deviation, .. } => unit_s / deviation,
            Self::Heights { samples, deviation } => {
                samples.iter().flat_map(|s| s.height_m).fold(0.0_f64, |most, h| most.max(h.abs())) / deviation
            }
            Self::Acceleration { values, deviation, .. } => {
                values.iter().fold(0.0_f64, |most, a| most.max(a.abs())) / deviation
            }
        }
    }
    pub(super) fn is_strikes(&self) -> bool {
        matches!(self, Self::Strikes { .. })
    }
    /// Counts the measured strikes that are left out.
    pub(super) fn left_out(&self) -> usize {
        if let Self::Strikes { index, .. } = self { index.iter().filter(|index| index.is_none()).count() } else { 0 }
    }
    /// Returns the number of residuals.
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Strikes { index, .. } => index.iter().flatten().count(),
            Self::Heights { samples, .. } => 2 * samples.len(),
            Self::Acceleration { values, .. } => values.len(),
        }
    }
    /// Returns the computed values as the record has them: times, heights of ends a and b in turn, accelerations.
    pub(super) fn computed(&self, drop: &Drop<'_>, path: &Path, offset_s: f64) -> Vec<f64> {
        match self {
            Self::Strikes { index, .. } => {
                let computed = &path.motion.strikes;
                let never = drop.horizon_s();
                let of_end = |end: End| -> Vec<usize> {
                    (0..computed.len()).filter(|k| drop.end(computed[*k].point) == end).collect()
                };
                let (a, b) = (of_end(End::A), of_end(End::B));
                let place = |which: &Which| match *which {
                    Which::Of(n) => Some(n),
                    Which::OfEnd(End::A, n) => a.get(n).copied(),
                    Which::OfEnd(End::B, n) => b.get(n).copied(),
                };
                let time = |which: &Which| {
                    let found = place(which).and_then(|k| computed.get(k));
                    offset_s + found.map_or(never, |strike| strike.time_s.min(never))
                };
                index.iter().flatten().map(time).collect()
            }
            Self::Heights { samples, .. } => {
                let ends = |sample: &MeasuredHeights| {
                    let [first, second] = path.heights_m(sample.time_s - offset_s);
                    if drop.first == End::A { [first, second] } else { [second, first] }
                };
                samples.iter().flat_map(ends).collect()
            }
            Self::Acceleration { place, start_s, step_s, values, .. } => {
                let s = if drop.first == End::A { *place } else { -place };
                #[expect(clippy::cast_precision_loss, reason = "at most a million")]
                let edge = |k: usize| path.given_m_s(s, start_s + step_s * (k as f64 - 0.5) - offset_s);
                let mut before = edge(0);
                let mut mean = |k: usize| {
                    let now = edge(k + 1);
                    let mean = (now - before) / step_s;
                    before = now;
                    mean
                };
                (0..values.len()).map(&mut mean).collect()
            }
        }
    }
    /// Returns the measured values in the same order.
    pub(super) fn measured(&self) -> Vec<f64> {
        match self {
            Self::Strikes { strikes, index, .. } => strikes
                .iter()
                .zip(index)
                .filter(|(_, index)| index.is_some())
                .map(|(strike, _)| strike.time_s)
                .collect(),
            Self::Heights { samples, .. } => samples.iter().flat_map(|sample| sample.height_m).collect(),
            Self::Acceleration { values, .. } => values.clone(),
        }
    }
    pub(super) fn residuals(&self, drop: &Drop<'_>, path: Option<&Path>, offset_s: f64, all: &mut Vec<f64>) {
        let (Self::Strikes { deviation, .. } | Self::Heights { deviation, .. } | Self::Acceleration { deviation, .. }) =
            self;
        let measured = self.measured();
        match path {
            Some(path) => {
                let computed = self.computed(drop, path, offset_s);
                all.extend(measured.iter().zip(computed).map(|(measured, computed)| (measured - computed) / deviation));
            }
            // A drop that no flight answers is no answer: further off than any.
            None => all.extend(measured.iter().map(|_| FAR)),
        }
    }
}

/// A residual that none passes.
const FAR: f64 = 1e9;

/// Checks the records, and takes them as the fit needs them.
pub(super) fn sets<'a>(known: &Known, measured: &'a [Measured]) -> Result<Vec<Set<'a>>, Error> {
    if measured.is_empty() {
        return Err(Error::Nothing);
    }
    measured.iter().enumerate().map(|(k, one)| set(known, one, k + 1)).collect()
}

fn set<'a>(known: &Known, measured: &'a Measured, record: usize) -> Result<Set<'a>, Error> {
    let finite = |name, value: f64| {
        let allowed = "a finite number below 1e9";
        if value.abs() < 1e9 { Ok(()) } else { Err(Error::Value { record, name, value, allowed }) }
    };
    let positive = |name, value: f64| {
        let allowed = "positive and below 1e9";
        if value > 0.0 && value < 1e9 { Ok(()) } else { Err(Error::Value { record, name, value, allowed }) }
    };
    let counted = |name, count: usize, least: usize, most: usize, allowed| {
        if (least..=most).contains(&count) { Ok(()) } else { Err(Error::Count { record, count, name, allowed }) }
    };
    let rising = |name, before: Option<f64>, now: f64| match before {
        Some(before) if now < before => {
            Err(Error::Value { record, name, value: now, allowed: "after the one before it" })
        }
        _ => finite(name, now),
    };
    Ok(match measured {
        Measured::Strikes { strikes, deviation_s } => {
            counted("strikes", strikes.len(), 2, MOST_STRIKES, "2 to 4096")?;
            let mut before = None;
            for strike in strikes {
                rising("time_s", before, strike.time_s)?;
                before = Some(strike.time_s);
            }
            let span = strikes[strikes.len() - 1].time_s - strikes[0].time_s;
            positive("time from the first to the last strike in s", span)?;
            deviation_s.map_or(Ok(()), |s| positive("standard deviation in s", s))?;
            let index = (0..strikes.len()).map(|n| Some(Which::Of(n))).collect();
            // Where none is given, any deviation serves: it cancels out.
            Set::Strikes { strikes, index, deviation: deviation_s.unwrap_or(1e-3 * span) }
        }
        Measured::Heights { samples, deviation_m } => {
            counted("samples", samples.len(), 4, MOST_SAMPLES, "4 to 1000000")?;
            let mut before = None;
            for sample in samples {
                rising("time_s", before, sample.time_s)?;
                sample.height_m.into_iter().try_for_each(|height| finite("height in m", height))?;
                before = Some(sample.time_s);
            }
            deviation_m.map_or(Ok(()), |s| positive("standard deviation in m", s))?;
            let every = samples.len().div_ceil(MOST_VALUES);
            let samples = samples.iter().step_by(every).copied().collect();
            Set::Heights { samples, deviation: deviation_m.unwrap_or(1e-3 * known.body.length_m()) }
        }
        Measured::Acceleration { position_m, start_s, step_s, values_m_s2 } => {
            counted("values", values_m_s2.len(), 8, MOST_SAMPLES, "8 to 1000000")?;
            finite("position in m", *position_m)?;
            finite("start in s", *start_s)?;
            positive("time step in s", *step_s)?;
            values_m_s2.iter().try_for_each(|value| finite("acceleration in m/s2", *value))?;
            let place = 2.0 * position_m / known.body.length_m();
            if place.abs() > 1.0 + 1e-9 {
                let allowed = "within the product";
                return Err(Error::Value { record, name: "position in m", value: *position_m, allowed });
            }
            let largest = values_m_s2.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
            positive("largest acceleration in m/s2", largest)?;
            let together = values_m_s2.len().div_ceil(MOST_VALUES);
            #[expect(clippy::cast_precision_loss, reason = "at most a million")]
            let (n, mean) = (together as f64, |chunk: &[f64]| chunk.iter().sum::<f64>() / chunk.len() as f64);
            let values = values_m_s2.chunks_exact(together).map(mean).collect();
            let start_s = start_s + 0.5 * (n - 1.0) * step_s;
            Set::Acceleration { place, start_s, step_s: n * step_s, values, deviation: 1e-2 * largest }
        }
    })
}

/// Returns a time of the drop: the mean one between strikes, or a share of a record.
pub(super) fn unit_s(sets: &[Set<'_>]) -> f64 {
    let of = |set: &Set<'_>| match set {
        #[expect(clippy::cast_precision_loss, reason = "at most 4096")]
        Set::Strikes { strikes, .. } => {
            (strikes[strikes.len() - 1].time_s - strikes[0].time_s) / (strikes.len() - 1) as f64
        }
        Set::Heights { .. } | Set::Acceleration { .. } => 1e-3,
    };
    sets.iter().map(of).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of two values taken together the time is midway between theirs.
    #[test]
    fn values_of_a_long_record_are_taken_together() {
        let known = Known {
            body: clatter_flight::Body::new(0.15, 0.04).expect("a body"),
            gyration_m: [0.04; 2],
            gyration_known: true,
            first: clatter_product::First::Either,
            gravity_m_s2: 0.0,
            restitution: [0.2, 0.5],
            speed_m_s: [3.0, 5.0],
            tilt_rad: [0.0, 0.05],
            contact_time_s: None,
            contact_law: clatter_flight::ContactLaw::Hysteretic,
        };
        let values_m_s2 = (0..2 * MOST_VALUES).map(|k| if k % 2 == 0 { 1.0 } else { 3.0 }).collect();
        let measured = [Measured::Acceleration { position_m: 0.0, start_s: 7.0, step_s: 0.5, values_m_s2 }];
        let Set::Acceleration { start_s, step_s, values, .. } = &sets(&known, &measured).expect("a record")[0] else {
            panic!("it is one of accelerations")
        };
        assert_eq!((*start_s, *step_s, values.len(), values[1]), (7.25, 1.0, MOST_VALUES, 2.0));
    }
}
