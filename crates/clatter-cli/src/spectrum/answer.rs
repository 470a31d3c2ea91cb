//! A spectrum as JSON.

use std::path::Path;

use clatter_record::{Finding, Record};
use clatter_shock::{LimitCurve, Margin, Spectrum};
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
            record: self.record.as_ref().map(|record| RecordJson::new(record, s.frequency_hz[0])),
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
    fn new(record: &Record, lowest_hz: f64) -> Self {
        let all = record.channels().iter().flat_map(|channel| &channel.values);
        Self {
            samples: record.samples(),
            start_s: Json(record.start_s()),
            end_s: Json(record.start_s() + record.duration_s()),
            step_s: record.step_s().map(Json),
            largest_m_s2: Json(all.fold(0.0_f64, |most, a| most.max(a.abs()))),
            findings: record.findings(lowest_hz).iter().map(Finding::to_string).collect(),
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
