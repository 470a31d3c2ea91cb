//! A record as JSON.

use std::path::Path;

use clatter_record::{Account, Channel, Finding, TimeAxis};
use clatter_shock::{Pulse, PulseCheck, Shocks, Within};
use serde::Serialize;

use super::pulse::Fitted;
use super::{Whole, extremes, last, time_s};
use crate::excitation::shape_name;
use crate::numbers::Json;

#[derive(Serialize)]
pub(super) struct Answer<'a> {
    file: &'a Path,
    /// Of all channels; null where they differ.
    #[serde(flatten)]
    times: TimesJson,
    channels: Vec<ChannelJson<'a>>,
    findings: Vec<String>,
    /// What became of every line and column; null for files that are no text.
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

impl<'a> Answer<'a> {
    pub(super) fn new(whole: &'a Whole<'_>, findings: &[Finding]) -> Self {
        let record = &whole.record;
        let one = if let [times] = record.times()[..] { Some(times) } else { None };
        Self {
            file: &whole.args.file,
            times: TimesJson::new(one),
            channels: (0..record.channels().len()).map(|k| ChannelJson::new(whole, k)).collect(),
            findings: findings.iter().map(Finding::to_string).collect(),
            account: record.account().map(AccountJson::new),
        }
    }
}

#[derive(Serialize)]
struct TimesJson {
    samples: Option<usize>,
    start_s: Option<Json>,
    duration_s: Option<Json>,
    /// Null where the samples are uneven, too.
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
    fn new(whole: &'a Whole<'_>, k: usize) -> Self {
        let channel: &Channel = &whole.record.channels()[k];
        let [high, low] = extremes(channel);
        let found = &whole.found;
        let ends = found.motions.as_ref().map(|motions| last(&motions[k]).map(Json));
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
            shocks: found.shocks.as_ref().map(|found| ShocksJson::new(start_s, &found[k])),
            pulse: found.fits.as_ref().map(|fits| PulseJson::new(start_s, &fits[k])),
        }
    }
}

#[derive(Serialize)]
struct ShocksJson {
    threshold_m_s2: Json,
    count: usize,
    /// The largest, if there are more than are listed.
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
    /// Best first.
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
    /// Measured, least and most allowed; null where the standard limits none, or by a figure that is not built in.
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
