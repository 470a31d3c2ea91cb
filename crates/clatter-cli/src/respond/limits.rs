//! What one drop asks of the limits of a part of a product file, as an assessment tells it.

use std::io::{self, Write};

use clatter_assess::{Answer, Limit, LimitKind, Unit};
use serde::Serialize;

use crate::Failure;
use crate::columns::Table;
use crate::numbers::Json;
use crate::one_drop::PartSetup;
use crate::quantities::Show;
use crate::text::shown;
use crate::words::in_words;

/// One limit in one drop.
pub(super) struct OfLimit {
    limit: Limit,
    /// The place of the part that asks most: position s of the product, and from its middle.
    pub(super) at: f64,
    position_m: f64,
    /// What is asked there; none where nothing is felt, or where it is not known.
    answer: Option<Answer>,
}

/// Every limit of a part at the worst of these places.
pub(super) fn of(
    part: &PartSetup,
    places: &[f64],
    half_m: f64,
    felt: impl Fn(&Limit, f64) -> Result<Option<Answer>, Failure>,
) -> Result<Vec<OfLimit>, Failure> {
    let mut limits = Vec::with_capacity(part.allowed.len());
    for limit in &part.allowed {
        let mut worst: Option<OfLimit> = None;
        for &at in places {
            let found = OfLimit { limit: *limit, at, position_m: at * half_m, answer: felt(limit, at)? };
            if worst.as_ref().is_none_or(|worst| found.share() > worst.share()) {
                worst = Some(found);
            }
        }
        limits.extend(worst);
    }
    Ok(limits)
}

/// The limit that is exceeded by most, or nearest to that.
pub(super) fn worst(limits: &[OfLimit]) -> Option<&OfLimit> {
    let answered = limits.iter().filter(|limit| limit.answer.is_some());
    answered.max_by(|a, b| a.share().total_cmp(&b.share()))
}

impl OfLimit {
    /// Of the limit; below every share where nothing is known.
    fn share(&self) -> f64 {
        self.answer.map_or(-1.0, |answer| answer.utilization())
    }
}

pub(super) fn table(part: &PartSetup, limits: &[OfLimit], time: Show, out: &mut dyn Write) -> io::Result<()> {
    let (title, when) = (format!("Limits of {}", shown(&part.name, 24)), format!("when, {}", time.name()));
    let mut rows = vec![[&title, "value", "allowed", "of limit", "at", &when, ""].map(str::to_owned).to_vec()];
    for row in limits {
        let name = format!("  {}", row.limit.kind.name());
        let Some(answer) = row.answer else {
            rows.push(vec![name, "-".to_owned()]);
            continue;
        };
        let words = |value| in_words(answer.unit, part.limits.unit(row.limit.kind, answer.unit), value);
        let share = format!("{:.1} %", 100.0 * answer.utilization());
        let place = if row.limit.kind == LimitKind::AngularVelocityChange {
            "-".to_owned()
        } else {
            in_words(Unit::Meter, part.place.unit(), row.position_m)
        };
        let over = if answer.utilization() > 1.0 { ", EXCEEDED" } else { "" };
        let (at, impact) = (time.figures(answer.time_s), format!("impact {}{over}", answer.impact));
        rows.push(vec![name, words(answer.value), words(answer.allowed), share, place, at, impact]);
    }
    writeln!(out)?;
    Table { keys: 1, headings: 1, texts: 1, last_is_text: true, least: 8, rows }.write(out)
}

/// As in the answer of `clatter assess`, whose `demand` is the value here; null where nothing is known.
#[derive(Serialize)]
pub(super) struct LimitJson {
    limit: LimitKind,
    unit: &'static str,
    allowed: Json,
    value: Option<Json>,
    /// Value over allowed.
    share: Option<Json>,
    position_m: Json,
    impact: Option<u64>,
    time_s: Option<Json>,
    error: Option<Json>,
}

impl From<&OfLimit> for LimitJson {
    fn from(OfLimit { limit, position_m, answer, .. }: &OfLimit) -> Self {
        Self {
            limit: limit.kind,
            unit: answer.map_or(limit.kind.unit(), |answer| answer.unit).name(),
            allowed: Json(answer.map_or(limit.allowed, |answer| answer.allowed)),
            value: answer.map(|answer| Json(answer.value)),
            share: answer.map(|answer| Json(answer.utilization())),
            position_m: Json(*position_m),
            impact: answer.map(|answer| answer.impact),
            time_s: answer.map(|answer| Json(answer.time_s)),
            error: answer.map(|answer| Json(answer.error())),
        }
    }
}
