//! A fit for programs.

use std::path::Path;

use clatter::End;
use clatter_assess::fit::{Estimate, Explanation, Measured, RecordFit, StrikeFit, Untold};
use serde::Serialize;

use super::{Answered, Record};
use crate::inputs::letter;
use crate::numbers::Json;

/// What a record holds, in a word.
pub(super) fn kind(record: &Record) -> &'static str {
    match record {
        Record::Bounces(_) => "bounces",
        Record::Measured(Measured::Strikes { .. }) => "strikes",
        Record::Measured(Measured::Heights { .. }) => "heights",
        Record::Measured(Measured::Acceleration { .. }) => "acceleration",
    }
}

#[derive(Serialize)]
pub(super) struct Answer<'a> {
    product: &'a str,
    model: &'static str,
    first: &'static str,
    degrees_of_freedom: usize,
    estimates: Vec<EstimateJson<'a>>,
    untold: Vec<UntoldJson<'a>>,
    correlations: Vec<Vec<Json>>,
    records: Vec<RecordJson<'a>>,
    others: Vec<OtherJson<'a>>,
    computed: Vec<ComputedJson>,
    notes: &'a [String],
}

#[derive(Serialize)]
struct EstimateJson<'a> {
    quantity: &'static str,
    unit: &'static str,
    value: Json,
    interval: Option<[Json; 2]>,
    note: Option<&'a str>,
}

#[derive(Serialize)]
struct UntoldJson<'a> {
    quantity: &'static str,
    unit: &'static str,
    held_at: Json,
    reason: &'a str,
}

#[derive(Serialize)]
struct RecordJson<'a> {
    file: &'a Path,
    kind: &'static str,
    first_touch_s: Json,
    scatter: Json,
    strikes: Vec<StrikeJson>,
    missing: &'a [usize],
}

#[derive(Serialize)]
struct StrikeJson {
    time_s: Json,
    end: Option<&'static str>,
    number: Option<usize>,
    residual_s: Option<Json>,
}

#[derive(Serialize)]
struct OtherJson<'a> {
    first: &'static str,
    missing: &'a [Vec<usize>],
    left_out_s: Vec<Vec<Json>>,
    estimates: Vec<EstimateJson<'a>>,
}

#[derive(Serialize)]
struct ComputedJson {
    time_s: Json,
    end: &'static str,
}

impl<'a> Answer<'a> {
    pub(super) fn new(answered: &'a Answered<'_>) -> Self {
        let fit = &answered.fit;
        let estimate = |estimate: &'a Estimate| EstimateJson {
            quantity: estimate.quantity.name(),
            unit: estimate.quantity.unit(),
            value: Json(estimate.value),
            interval: estimate.interval.map(|interval| interval.map(Json)),
            note: estimate.note.as_deref(),
        };
        let other = |other: &'a Explanation| OtherJson {
            first: letter(other.first),
            missing: &other.missing,
            left_out_s: other.left_out_s.iter().map(|all| all.iter().copied().map(Json).collect()).collect(),
            estimates: other.estimates.iter().map(estimate).collect(),
        };
        let untold = |untold: &'a Untold| UntoldJson {
            quantity: untold.quantity.name(),
            unit: untold.quantity.unit(),
            held_at: Json(untold.held_at),
            reason: &untold.reason,
        };
        let strike = |strike: &StrikeFit| StrikeJson {
            time_s: Json(strike.measured.time_s),
            end: strike.measured.end.map(letter),
            number: strike.number,
            residual_s: strike.residual_s.map(Json),
        };
        let files = answered.args.records.iter().zip(&answered.records);
        let record = |((file, record), found): ((&'a std::path::PathBuf, &Record), &'a RecordFit)| RecordJson {
            file,
            kind: kind(record),
            first_touch_s: Json(found.first_touch_s),
            scatter: Json(found.scatter),
            strikes: found.strikes.iter().map(strike).collect(),
            missing: &found.missing,
        };
        let computed = |&(time_s, end): &(f64, End)| ComputedJson { time_s: Json(time_s), end: letter(end) };
        Self {
            product: &answered.file.product.name,
            model: fit.model.name(),
            first: letter(fit.first),
            degrees_of_freedom: fit.degrees_of_freedom,
            estimates: fit.estimates.iter().map(estimate).collect(),
            untold: fit.untold.iter().map(untold).collect(),
            correlations: fit.correlations.iter().map(|row| row.iter().copied().map(Json).collect()).collect(),
            records: files.zip(&fit.records).map(record).collect(),
            others: fit.others.iter().map(other).collect(),
            computed: fit.computed.iter().map(computed).collect(),
            notes: &fit.notes,
        }
    }
}
