//! This module describes a record of accelerations: its channels and its faults, and on request its shocks, the pulse of the largest one,
//! velocity and displacement.
//!
//! ```
//! use clatter_answer::record;
//! use clatter_record::{Options, Record};
//! let text = "time [s],a [m/s2]\n0,0\n0.001,50\n0.002,0\n0.003,0\n";
//! let record = Record::read(text.as_bytes(), &Options::default(), |_| ())?;
//! let mut question = record::Question::new(&record);
//! question.integrate = true;
//! let answer = record::answer(&question)?;
//! // The triangle of 50 m/s² over 2 ms.
//! assert!((record::end(&answer.motions.expect("asked for")[0])[0] - 0.05).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use clatter_record::{Account, Channel, Error, Finding, Motion, Record, TimeAxis, integrate};
use clatter_shock::{
    EffectiveDuration, PULSE_TOLERANCES, Pulse, PulseCheck, PulseFit, Search, Shocks, Within, check_pulse,
    effective_duration, find_shocks, fit_pulses,
};
use serde::{Serialize, Serializer};

use crate::{Json, shape_name};

/// Offsets are assessed by their effect on a spectrum from this frequency on: a spectrum begins here unless others are requested.
pub const LOWEST_HZ: f64 = 10.0;

/// A record, and the requests about it.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Question<'a> {
    /// The record.
    pub record: &'a Record,
    /// The search for its shocks, if they are to be found.
    pub find: Option<Search>,
    /// True where pulses are fitted to the largest shock and compared with the tolerances of standards.
    pub fit_pulse: bool,
    /// The pulse that tolerances are about; else the best that fits.
    pub nominal: Option<Pulse>,
    /// True where velocity and displacement are requested, from rest.
    pub integrate: bool,
}

impl<'a> Question<'a> {
    /// Makes a question about its channels alone.
    #[must_use]
    pub fn new(record: &'a Record) -> Self {
        Self { record, find: None, fit_pulse: false, nominal: None, integrate: false }
    }
}

/// The content of a record; each list has one entry for each channel.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Answer<'a> {
    /// The record.
    pub record: &'a Record,
    /// The faults and oddities of the record.
    pub findings: Vec<Finding>,
    /// Its shocks.
    pub shocks: Option<Vec<Shocks>>,
    /// The pulse of the largest shock.
    pub pulses: Option<Vec<Fitted>>,
    /// Velocity and displacement.
    pub motions: Option<Vec<Motion>>,
}

/// Pulses that fit the largest shock of a channel.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Fitted {
    /// The fits, the best first.
    pub fits: [PulseFit; 3],
    /// The durations of the shock.
    pub durations: EffectiveDuration,
    /// The pulse that the shock is compared with, placed where it fits best.
    pub nominal: Pulse,
    /// The checks, by the keyword of each standard.
    pub checks: Vec<(&'static str, PulseCheck)>,
}

impl Fitted {
    fn new(channel: &Channel, nominal: Option<&Pulse>) -> Result<Self, Error> {
        let (values, step_s) = (&channel.values, channel.times().even("a pulse")?);
        let fits = fit_pulses(values, step_s)?;
        let against = nominal.copied().unwrap_or(fits[0].pulse);
        let check = |tolerance| Ok((tolerance, check_pulse(values, step_s, &against, tolerance)?));
        let checks = PULSE_TOLERANCES.iter().map(check).collect::<Result<Vec<_>, Error>>()?;
        let nominal = checks.first().map_or(against, |(_, check)| check.nominal);
        let checks = checks.into_iter().map(|(tolerance, check)| (tolerance.keyword, check)).collect();
        Ok(Self { fits, durations: effective_duration(values, step_s)?, nominal, checks })
    }
}

/// Computes the requested results.
///
/// # Errors
/// Uneven times, which shocks, pulses and motions need even; a record in which they cannot be.
pub fn answer<'a>(question: &Question<'a>) -> Result<Answer<'a>, Error> {
    let Question { record, find, fit_pulse, nominal, integrate: moves } = question;
    let shocks = |channel: &Channel, search: &Search| {
        Ok::<_, Error>(find_shocks(&channel.values, channel.times().even("a search for shocks")?, search)?)
    };
    let motion = |channel: &Channel| integrate(&channel.values, channel.times().even("integration")?);
    let all = || record.channels().iter();
    Ok(Answer {
        record,
        findings: record.findings(LOWEST_HZ),
        shocks: find.as_ref().map(|search| all().map(|channel| shocks(channel, search)).collect()).transpose()?,
        pulses: fit_pulse.then(|| all().map(|channel| Fitted::new(channel, nominal.as_ref())).collect()).transpose()?,
        motions: moves.then(|| all().map(motion).collect()).transpose()?,
    })
}

/// Returns the first samples that hold the largest and the smallest value.
#[must_use]
pub fn extremes(channel: &Channel) -> [usize; 2] {
    let values = &channel.values;
    let first = |beyond: fn(f64, f64) -> bool| {
        values.iter().enumerate().fold(0, |best, (i, value)| if beyond(*value, values[best]) { i } else { best })
    };
    [first(|a, b| a > b), first(|a, b| a < b)]
}

/// Returns the time of a sample, on the axis of the file.
#[must_use]
pub fn time_s(channel: &Channel, sample: usize) -> f64 {
    channel.times().start_s() + channel.times().since_s(sample)
}

/// Returns the last velocity and displacement, in m/s and m.
#[must_use]
pub fn end(motion: &Motion) -> [f64; 2] {
    [&motion.velocity_m_s, &motion.displacement_m].map(|values| values.last().copied().unwrap_or(0.0))
}

#[derive(Serialize)]
struct AnswerJson<'a> {
    /// The times of all channels; null where they differ.
    #[serde(flatten)]
    times: TimesJson,
    channels: Vec<ChannelJson<'a>>,
    findings: Vec<String>,
    /// The use of every line and column; null for files that are not text.
    account: Option<AccountJson<'a>>,
}

#[derive(Serialize)]
struct AccountJson<'a> {
    lines: usize,
    heading: usize,
    rows: usize,
    not_asked_for: usize,
    not_used: usize,
    empty: usize,
    comments: usize,
    below: usize,
    columns: Vec<ColumnJson<'a>>,
}

#[derive(Serialize)]
struct ColumnJson<'a> {
    column: &'a str,
    taken_for: &'a str,
}

impl<'a> AccountJson<'a> {
    fn new(account: &'a Account) -> Self {
        let lines = account.lines;
        let column = |(column, taken_for): &'a (String, String)| ColumnJson { column, taken_for };
        Self {
            lines: lines.all,
            heading: lines.heading,
            rows: lines.rows,
            not_asked_for: lines.others,
            not_used: lines.bad,
            empty: lines.empty,
            comments: lines.comments,
            below: lines.below,
            columns: account.columns.iter().map(column).collect(),
        }
    }
}

impl Serialize for Answer<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let record = self.record;
        let one = if let [times] = record.times()[..] { Some(times) } else { None };
        AnswerJson {
            times: TimesJson::new(one),
            channels: (0..record.channels().len()).map(|k| ChannelJson::new(self, k)).collect(),
            findings: self.findings.iter().map(Finding::to_string).collect(),
            account: record.account().map(AccountJson::new),
        }
        .serialize(serializer)
    }
}

#[derive(Serialize)]
struct TimesJson {
    samples: Option<usize>,
    start_s: Option<Json>,
    duration_s: Option<Json>,
    /// The step; null where the samples are uneven, too.
    step_s: Option<Json>,
    sample_rate_hz: Option<Json>,
}

impl TimesJson {
    fn new(times: Option<&TimeAxis>) -> Self {
        let step_s = times.and_then(TimeAxis::step_s);
        Self {
            samples: times.map(TimeAxis::samples),
            start_s: times.map(|times| Json(times.start_s())),
            duration_s: times.map(|times| Json(times.duration_s())),
            step_s: step_s.map(Json),
            sample_rate_hz: step_s.map(|step_s| Json(step_s.recip())),
        }
    }
}

#[derive(Serialize)]
struct ChannelJson<'a> {
    name: &'a str,
    unit: &'a str,
    #[serde(flatten)]
    times: TimesJson,
    largest_m_s2: Json,
    largest_time_s: Json,
    smallest_m_s2: Json,
    smallest_time_s: Json,
    #[serde(skip_serializing_if = "Option::is_none")]
    last_velocity_m_s: Option<Json>,
    #[serde(skip_serializing_if = "Option::is_none")]
    last_displacement_m: Option<Json>,
    #[serde(skip_serializing_if = "Option::is_none")]
    shocks: Option<ShocksJson>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pulse: Option<PulseJson>,
}

impl<'a> ChannelJson<'a> {
    fn new(answer: &'a Answer<'_>, k: usize) -> Self {
        let channel: &Channel = &answer.record.channels()[k];
        let [high, low] = extremes(channel);
        let ends = answer.motions.as_ref().map(|motions| end(&motions[k]).map(Json));
        let start_s = channel.times().start_s();
        Self {
            name: &channel.name,
            unit: &channel.unit,
            times: TimesJson::new(Some(channel.times())),
            largest_m_s2: Json(channel.values[high]),
            largest_time_s: Json(time_s(channel, high)),
            smallest_m_s2: Json(channel.values[low]),
            smallest_time_s: Json(time_s(channel, low)),
            last_velocity_m_s: ends.map(|[velocity, _]| velocity),
            last_displacement_m: ends.map(|[_, displacement]| displacement),
            shocks: answer.shocks.as_ref().map(|found| ShocksJson::new(start_s, &found[k])),
            pulse: answer.pulses.as_ref().map(|fits| PulseJson::new(start_s, &fits[k])),
        }
    }
}

#[derive(Serialize)]
struct ShocksJson {
    threshold_m_s2: Json,
    count: usize,
    /// The shocks; the largest ones where there are too many for the list.
    list: Vec<ShockJson>,
}

#[derive(Serialize)]
struct ShockJson {
    start_s: Json,
    peak_m_s2: Json,
    peak_time_s: Json,
    duration_s: Json,
    velocity_change_m_s: Json,
}

impl ShocksJson {
    fn new(start_s: f64, found: &Shocks) -> Self {
        let list = found.shocks.iter().map(|shock| ShockJson {
            start_s: Json(start_s + shock.start_s),
            peak_m_s2: Json(shock.peak_m_s2),
            peak_time_s: Json(start_s + shock.peak_time_s),
            duration_s: Json(shock.duration_s),
            velocity_change_m_s: Json(shock.velocity_change_m_s),
        });
        Self {
            threshold_m_s2: Json(found.threshold_m_s2),
            count: found.shocks.len() + found.omitted,
            list: list.collect(),
        }
    }
}

#[derive(Serialize)]
struct PulseJson {
    /// The fits, the best first.
    fits: Vec<FitJson>,
    effective_duration_third_of_peak_s: Json,
    effective_duration_tenth_of_rms_s: Json,
    nominal: FitJson,
    tolerances: Vec<ToleranceJson>,
}

#[derive(Serialize)]
struct FitJson {
    shape: String,
    amplitude_m_s2: Json,
    duration_s: Json,
    start_s: Json,
    #[serde(skip_serializing_if = "Option::is_none")]
    residual: Option<Json>,
}

#[derive(Serialize)]
struct ToleranceJson {
    standard: &'static str,
    within: bool,
    /// The measured, the least and the most allowed value; null where the standard limits none, or by a figure that is not built in.
    velocity_change_m_s: Option<[Json; 3]>,
    duration_s: Option<[Json; 3]>,
    largest_difference_m_s2: Option<[Json; 3]>,
}

impl PulseJson {
    fn new(start_s: f64, fitted: &Fitted) -> Self {
        let fit = |pulse: &Pulse, residual: Option<f64>| FitJson {
            shape: shape_name(pulse.shape),
            amplitude_m_s2: Json(pulse.amplitude),
            duration_s: Json(pulse.duration),
            start_s: Json(start_s + pulse.start),
            residual: residual.map(Json),
        };
        let three = |within: Within| [within.measured, within.allowed[0], within.allowed[1]].map(Json);
        let tolerance = |(standard, check): &(&'static str, PulseCheck)| ToleranceJson {
            standard,
            within: check.holds(),
            velocity_change_m_s: check.velocity_change_m_s.map(three),
            duration_s: check.duration_s.map(three),
            largest_difference_m_s2: check.distortion.map(|distortion| three(distortion.largest_m_s2)),
        };
        Self {
            fits: fitted.fits.iter().map(|one| fit(&one.pulse, Some(one.residual))).collect(),
            effective_duration_third_of_peak_s: Json(fitted.durations.third_of_peak_s),
            effective_duration_tenth_of_rms_s: Json(fitted.durations.tenth_of_rms_s),
            nominal: fit(&fitted.nominal, None),
            tolerances: fitted.checks.iter().map(tolerance).collect(),
        }
    }
}
