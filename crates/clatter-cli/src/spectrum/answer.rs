//! A spectrum as JSON.

use std::path::Path;

use clatter_shock::{Finding, LimitCurve, Margin, Spectrum, Survey};
use serde::Serialize;

use super::{Boundary, Computed};
use crate::excitation::shape_name;
use crate::numbers::Json;

impl Computed<'_> {
    pub(super) fn answer(&self) -> Answer<'_> {
        let [quantity, unit] = self.args.quantity.name();
        let s = &self.spectrum;
        let all = |values: &[f64]| values.iter().copied().map(Json).collect::<Vec<_>>();
        Answer {
            quantity,
            unit,
            damping: Json(s.damping.get()),
            q_factor: Json(0.5 / s.damping.get()),
            record: self.survey.as_ref().map(RecordJson::new),
            frequency_hz: all(&s.frequency_hz),
            primary: all(&s.primary),
            residual: all(&s.residual),
            maximax: all(&s.maximax),
            positive: all(&s.positive),
            negative: all(&s.negative),
            limit: self.margins.as_ref().map(|margins| LimitJson::new(margins, s)),
            damage_boundary: self.boundary.as_ref().map(BoundaryJson::new),
            file: self.args.output.as_ref().map(|target| target.path.as_path()),
        }
    }
}

#[derive(Serialize)]
pub(super) struct Answer<'a> {
    quantity: &'static str,
    unit: &'static str,
    damping: Json,
    q_factor: Json,
    #[serde(skip_serializing_if = "Option::is_none")]
    record: Option<RecordJson>,
    frequency_hz: Vec<Json>,
    primary: Vec<Json>,
    residual: Vec<Json>,
    maximax: Vec<Json>,
    positive: Vec<Json>,
    negative: Vec<Json>,
    #[serde(skip_serializing_if = "Option::is_none")]
    limit: Option<LimitJson>,
    #[serde(skip_serializing_if = "Option::is_none")]
    damage_boundary: Option<BoundaryJson>,
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<&'a Path>,
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
    fn new(margins: &[Option<Margin>], spectrum: &Spectrum) -> Self {
        let worst = LimitCurve::worst(margins).and_then(|i| Some((spectrum.frequency_hz[i], margins[i]?)));
        Self {
            allowed: margins.iter().map(|m| m.map(|m| Json(m.allowed))).collect(),
            margin_db: margins.iter().map(|m| m.map(|m| Json(m.decibel()))).collect(),
            worst: worst.map(|(hz, margin)| WorstJson {
                frequency_hz: Json(hz),
                allowed: Json(margin.allowed),
                maximax: Json(margin.demand),
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
