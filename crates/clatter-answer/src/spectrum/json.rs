//! This module writes a spectrum for programs.

use clatter_assess::CaseStop;
use clatter_product::units::Unit;
use clatter_record::{Channel, Finding, TimeAxis};
use clatter_shock::{EnvelopingPulse, LimitCurve, Margin, RequiredSpectrum, Spectrum};
use serde::{Serialize, Serializer};

use super::boundary::Boundary;
use super::{Answer, Excitation, Measured, Part, largest, name, outermost};
use crate::{Json, shape_name};

impl Serialize for Answer<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self { question, frequencies, parts, boundary } = self;
        let columns = || parts.iter().map(|part| ColumnsJson::new(part, question.required.as_ref(), question.unit));
        // Where there are several channels, none of them is the first.
        let is_one = parts.iter().all(|part| part.name.is_none());
        let lowest_hz = frequencies.hz().iter().fold(f64::INFINITY, |least, hz| least.min(*hz));
        let measured: &[Measured] = if let Excitation::Records(all) = &question.excitation { all } else { &[] };
        let mut records = measured.iter().map(|measured| RecordJson::new(measured, lowest_hz));
        let [quantity, si] = name(question.quantity);
        AnswerJson {
            quantity,
            unit: question.unit.map_or(si, |unit| unit.name),
            stop: question.stop.map(CaseStop::from),
            records: if measured.len() > 1 { records.by_ref().collect() } else { Vec::new() },
            record: records.next(),
            first: columns().next().filter(|_| is_one),
            spectra: if parts.len() > 1 { columns().collect() } else { Vec::new() },
            damage_boundary: boundary.as_ref().map(BoundaryJson::new),
        }
        .serialize(serializer)
    }
}

#[derive(Serialize)]
struct AnswerJson<'a> {
    quantity: &'static str,
    unit: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    stop: Option<CaseStop>,
    #[serde(skip_serializing_if = "Option::is_none")]
    record: Option<RecordJson<'a>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    records: Vec<RecordJson<'a>>,
    #[serde(flatten)]
    first: Option<ColumnsJson<'a>>,
    /// The spectra of each channel and damping ratio, where there are several; of one channel the first is also above.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    spectra: Vec<ColumnsJson<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    damage_boundary: Option<BoundaryJson<'a>>,
}

/// One spectrum.
#[derive(Serialize)]
struct ColumnsJson<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    of: Option<&'a str>,
    damping: Json,
    q_factor: Json,
    frequency_hz: Vec<Json>,
    primary: Vec<Json>,
    residual: Vec<Json>,
    maximax: Vec<Json>,
    positive: Vec<Json>,
    negative: Vec<Json>,
    primary_positive: Vec<Json>,
    primary_negative: Vec<Json>,
    residual_positive: Vec<Json>,
    residual_negative: Vec<Json>,
    /// The time of the peak; null where the spectrum is made of several.
    time_of_peak_s: Vec<Option<Json>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    limit: Option<LimitJson>,
    #[serde(skip_serializing_if = "Option::is_none")]
    required: Option<RequiredJson>,
    #[serde(skip_serializing_if = "Option::is_none")]
    enveloping_pulse: Option<EnvelopingJson>,
}

impl<'a> ColumnsJson<'a> {
    fn new(part: &'a Part, required: Option<&RequiredSpectrum>, unit: Option<&Unit>) -> Self {
        let s = &part.spectrum;
        let show = &|x: f64| Json(unit.map_or(x, |unit| unit.of_si(x)));
        let plain = |values: &[f64]| values.iter().copied().map(Json).collect::<Vec<_>>();
        let all = |values: &[f64]| values.iter().map(|x| show(*x)).collect::<Vec<_>>();
        let time = |time: &f64| Some(Json(*time)).filter(|_| !time.is_nan());
        Self {
            of: part.name.as_deref(),
            damping: Json(s.damping.get()),
            q_factor: Json(0.5 / s.damping.get()),
            frequency_hz: plain(&s.frequency_hz),
            primary: all(&s.primary),
            residual: all(&s.residual),
            maximax: all(&s.maximax),
            positive: all(&s.positive),
            negative: all(&s.negative),
            primary_positive: all(&s.primary_positive),
            primary_negative: all(&s.primary_negative),
            residual_positive: all(&s.residual_positive),
            residual_negative: all(&s.residual_negative),
            time_of_peak_s: s.time_of_peak_s.iter().map(time).collect(),
            limit: part.margins.as_ref().map(|margins| LimitJson::new(margins, s, show)),
            enveloping_pulse: part.enveloping.as_ref().map(EnvelopingJson::new),
            required: required.map(|required| RequiredJson::new(part, required, show)),
        }
    }
}

#[derive(Serialize)]
struct RecordJson<'a> {
    file: &'a str,
    #[serde(flatten)]
    times: TimesJson,
    largest_m_s2: Json,
    /// The times of each channel, where they differ.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    channels: Vec<ChannelJson<'a>>,
    findings: Vec<String>,
}

/// The times of channels; null where channels differ.
#[derive(Serialize)]
struct TimesJson {
    samples: Option<usize>,
    start_s: Option<Json>,
    end_s: Option<Json>,
    /// The step; null where the samples are uneven, too.
    step_s: Option<Json>,
}

#[derive(Serialize)]
struct ChannelJson<'a> {
    name: &'a str,
    #[serde(flatten)]
    times: TimesJson,
}

impl TimesJson {
    fn new(times: Option<&TimeAxis>) -> Self {
        Self {
            samples: times.map(TimeAxis::samples),
            start_s: times.map(|times| Json(times.start_s())),
            end_s: times.map(|times| Json(times.start_s() + times.duration_s())),
            step_s: times.and_then(TimeAxis::step_s).map(Json),
        }
    }
}

impl<'a> RecordJson<'a> {
    fn new(Measured { file, record, .. }: &'a Measured, lowest_hz: f64) -> Self {
        let times = record.times();
        let one = if let [times] = times[..] { Some(times) } else { None };
        let channel =
            |channel: &'a Channel| ChannelJson { name: &channel.name, times: TimesJson::new(Some(channel.times())) };
        Self {
            file,
            times: TimesJson::new(one),
            largest_m_s2: Json(record.channels().iter().map(largest).fold(0.0, f64::max)),
            channels: if one.is_none() { record.channels().iter().map(channel).collect() } else { Vec::new() },
            findings: record.findings(lowest_hz).iter().map(Finding::to_string).collect(),
        }
    }
}

#[derive(Serialize)]
struct LimitJson {
    /// The allowed value; null outside of the limit curve, as the margin is.
    allowed: Vec<Option<Json>>,
    margin_db: Vec<Option<Json>>,
    worst: Option<WorstJson>,
}

#[derive(Serialize)]
struct WorstJson {
    frequency_hz: Json,
    allowed: Json,
    maximax: Json,
    margin_db: Json,
    safe: bool,
}

impl LimitJson {
    fn new(margins: &[Option<Margin>], spectrum: &Spectrum, show: &impl Fn(f64) -> Json) -> Self {
        let worst = LimitCurve::worst(margins).and_then(|i| Some((spectrum.frequency_hz[i], margins[i]?)));
        Self {
            allowed: margins.iter().map(|m| m.map(|m| show(m.allowed))).collect(),
            margin_db: margins.iter().map(|m| m.map(|m| Json(m.decibel()))).collect(),
            worst: worst.map(|(hz, margin)| WorstJson {
                frequency_hz: Json(hz),
                allowed: show(margin.allowed),
                maximax: show(margin.demand),
                margin_db: Json(margin.decibel()),
                safe: margin.is_safe(),
            }),
        }
    }
}

#[derive(Serialize)]
struct EnvelopingJson {
    shape: String,
    amplitude_m_s2: Json,
    duration_s: Json,
    velocity_change_m_s: Json,
    /// The height of its spectrum above the enveloped one.
    mean_db: Json,
    most_db: Json,
    most_frequency_hz: Json,
}

impl EnvelopingJson {
    fn new(EnvelopingPulse { pulse, most_db, most_hz, mean_db }: &EnvelopingPulse) -> Self {
        Self {
            shape: shape_name(pulse.shape),
            amplitude_m_s2: Json(pulse.amplitude),
            duration_s: Json(pulse.duration),
            velocity_change_m_s: Json(pulse.velocity_change()),
            mean_db: Json(*mean_db),
            most_db: Json(*most_db),
            most_frequency_hz: Json(*most_hz),
        }
    }
}

#[derive(Serialize)]
struct RequiredJson {
    /// The required level; null outside of the required curve, as the deviation is.
    level: Vec<Option<Json>>,
    deviation_db: Vec<Option<Json>>,
    lowest: Option<DeviationJson>,
    highest: Option<DeviationJson>,
    /// The number of frequencies that are compared, and how many of them are below and above by more than the tolerance.
    frequencies: usize,
    below: usize,
    above: usize,
    /// True where the spectrum reaches the required curve; null where a part of the curve is not covered, and the covered part is reached.
    reached: Option<bool>,
}

#[derive(Serialize)]
struct DeviationJson {
    frequency_hz: Json,
    level: Json,
    maximax: Json,
    deviation_db: Json,
}

impl RequiredJson {
    fn new(part: &Part, required: &RequiredSpectrum, show: &impl Fn(f64) -> Json) -> Self {
        let deviations = part.deviations.as_deref().unwrap_or_default();
        let ends = outermost(deviations).map(|ends| {
            ends.map(|(i, of)| DeviationJson {
                frequency_hz: Json(part.spectrum.frequency_hz[i]),
                level: show(of.required),
                maximax: show(of.reached),
                deviation_db: Json(of.decibel()),
            })
        });
        let (lowest, highest) = ends.map_or((None, None), |[lowest, highest]| (Some(lowest), Some(highest)));
        let told = || deviations.iter().flatten();
        Self {
            level: deviations.iter().map(|of| of.map(|of| show(of.required))).collect(),
            deviation_db: deviations.iter().map(|of| of.map(|of| Json(of.decibel()))).collect(),
            lowest,
            highest,
            frequencies: told().count(),
            below: told().filter(|of| of.is_below).count(),
            above: told().filter(|of| of.is_above).count(),
            reached: part.reaches(required),
        }
    }
}

#[derive(Serialize)]
struct BoundaryJson<'a> {
    shape: &'a str,
    /// The critical velocity change; null where both directions cancel, as the knee.
    critical_velocity_change_m_s: Option<Json>,
    critical_acceleration_m_s2: Json,
    knee_velocity_change_m_s: Option<Json>,
    velocity_change_m_s: Json,
    acceleration_m_s2: Json,
    margin: Json,
    margin_db: Json,
    safe: bool,
    /// Pairs of velocity change and acceleration.
    curve: Vec<[Json; 2]>,
}

impl<'a> BoundaryJson<'a> {
    fn new(b: &'a Boundary) -> Self {
        Self {
            shape: &b.of,
            critical_velocity_change_m_s: b.critical_velocity_change.map(Json),
            critical_acceleration_m_s2: Json(b.critical_acceleration),
            knee_velocity_change_m_s: b.knee_velocity_change.map(Json),
            velocity_change_m_s: Json(b.velocity_change),
            acceleration_m_s2: Json(b.acceleration),
            margin: Json(b.margin.ratio()),
            margin_db: Json(b.margin.decibel()),
            safe: b.margin.is_safe(),
            curve: b.curve.iter().map(|(v, a)| [Json(*v), Json(*a)]).collect(),
        }
    }
}
