//! A spectrum as JSON.

use std::path::Path;

use clatter_shock::{Finding, LimitCurve, Margin, Spectrum, Survey};
use serde::Serialize;

use super::{Boundary, Computed, Part};
use crate::excitation::shape_name;
use crate::numbers::Json;
use crate::quantities::Show;

impl Computed<'_> {
    pub(super) fn answer(&self) -> Answer<'_> {
        let show = self.args.written();
        let mut columns = self.parts.iter().map(|part| ColumnsJson::new(part, &show));
        let (first, others) = (columns.next(), columns.len() > 0);
        let all = || self.parts.iter().map(|part| ColumnsJson::new(part, &show)).collect();
        Answer {
            quantity: self.args.quantity.name()[0],
            unit: show.name(),
            record: self.survey.as_ref().map(RecordJson::new),
            first,
            spectra: if others { all() } else { Vec::new() },
            damage_boundary: self.boundary.as_ref().map(BoundaryJson::new),
            file: self.args.output.as_ref().map(|target| target.path.as_path()),
        }
    }
}

#[derive(Serialize)]
pub(super) struct Answer<'a> {
    quantity: &'static str,
    unit: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    record: Option<RecordJson>,
    #[serde(flatten)]
    first: Option<ColumnsJson>,
    /// Of each damping ratio, where there are several; the first is also above.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    spectra: Vec<ColumnsJson>,
    #[serde(skip_serializing_if = "Option::is_none")]
    damage_boundary: Option<BoundaryJson>,
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<&'a Path>,
}

/// The spectrum of one damping ratio.
#[derive(Serialize)]
struct ColumnsJson {
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
    time_of_peak_s: Vec<Json>,
    #[serde(skip_serializing_if = "Option::is_none")]
    limit: Option<LimitJson>,
}

impl ColumnsJson {
    fn new(part: &Part, show: &Show) -> Self {
        let s = &part.spectrum;
        let plain = |values: &[f64]| values.iter().copied().map(Json).collect::<Vec<_>>();
        let all = |values: &[f64]| values.iter().map(|x| Json(show.value(*x))).collect::<Vec<_>>();
        Self {
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
            time_of_peak_s: plain(&s.time_of_peak_s),
            limit: part.margins.as_ref().map(|margins| LimitJson::new(margins, s, show)),
        }
    }
}

#[derive(Serialize)]
struct RecordJson {
    samples: usize,
    start_s: Json,
    end_s: Json,
    /// Null where the samples are uneven.
    step_s: Option<Json>,
    largest_m_s2: Json,
    findings: Vec<String>,
}

impl RecordJson {
    fn new(survey: &Survey) -> Self {
        Self {
            samples: survey.samples,
            start_s: Json(survey.start),
            end_s: Json(survey.end),
            step_s: survey.step.map(Json),
            largest_m_s2: Json(survey.largest),
            findings: survey.findings.iter().map(Finding::to_string).collect(),
        }
    }
}

#[derive(Serialize)]
struct LimitJson {
    /// Null outside of the limit curve, as the margin is.
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
    fn new(margins: &[Option<Margin>], spectrum: &Spectrum, show: &Show) -> Self {
        let worst = LimitCurve::worst(margins).and_then(|i| Some((spectrum.frequency_hz[i], margins[i]?)));
        Self {
            allowed: margins.iter().map(|m| m.map(|m| Json(show.value(m.allowed)))).collect(),
            margin_db: margins.iter().map(|m| m.map(|m| Json(m.decibel()))).collect(),
            worst: worst.map(|(hz, margin)| WorstJson {
                frequency_hz: Json(hz),
                allowed: Json(show.value(margin.allowed)),
                maximax: Json(show.value(margin.demand)),
                margin_db: Json(margin.decibel()),
                safe: margin.is_safe(),
            }),
        }
    }
}

#[derive(Serialize)]
struct BoundaryJson {
    shape: String,
    critical_velocity_change_m_s: Json,
    critical_acceleration_m_s2: Json,
    knee_velocity_change_m_s: Json,
    velocity_change_m_s: Json,
    acceleration_m_s2: Json,
    margin: Json,
    margin_db: Json,
    safe: bool,
    /// Pairs of velocity change and acceleration.
    curve: Vec<[Json; 2]>,
}

impl BoundaryJson {
    fn new(b: &Boundary) -> Self {
        Self {
            shape: shape_name(b.pulse.shape),
            critical_velocity_change_m_s: Json(b.numbers.critical_velocity_change()),
            critical_acceleration_m_s2: Json(b.numbers.critical_acceleration()),
            knee_velocity_change_m_s: Json(b.numbers.knee_velocity_change()),
            velocity_change_m_s: Json(b.pulse.velocity_change().abs()),
            acceleration_m_s2: Json(b.pulse.amplitude.abs()),
            margin: Json(b.margin.ratio()),
            margin_db: Json(b.margin.decibel()),
            safe: b.margin.is_safe(),
            curve: b.curve.iter().map(|(v, a)| [Json(*v), Json(*a)]).collect(),
        }
    }
}
