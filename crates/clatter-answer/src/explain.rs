//! This module shows which model the worst drops of a product need, and why: the models of [`clatter_assess::ladder`] without their
//! times, which depend on the machine that measured them.
//!
//! ```
//! use clatter_answer::explain;
//! let file = clatter_product::ProductFile::read(clatter_product::EXAMPLE, "example.toml")?;
//! let ladders = clatter_assess::ladders(&file, &clatter_assess::assess(&file)?, 0.01)?;
//! assert!(!serde_json::to_string(&explain::Answer(&ladders))?.contains("seconds"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use clatter_assess::{
    WorstCase,
    ladder::{Groups, LandingLadder, LeftOut, LimitLadder, Measured, ProductLadder, Reference, Rung},
};
use clatter_product::{LimitKind, Unit};
use serde::{Serialize, Serializer};

use crate::Json;

/// All models on the worst drops of a product.
#[derive(Debug, Clone, Copy)]
pub struct Answer<'a>(pub &'a ProductLadder);

#[derive(Serialize)]
struct AnswerJson<'a> {
    product: &'a str,
    tolerance: Json,
    limits: Vec<LimitJson<'a>>,
    left_out: &'a [LeftOut],
    /// The drops of a box.
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    landings: &'a [LandingLadder],
}

#[derive(Serialize)]
struct LimitJson<'a> {
    component: &'a str,
    limit: LimitKind,
    unit: Unit,
    worst_case: &'a WorstCase,
    reference: Reference,
    models: Vec<ModelJson>,
    cheapest: Rung,
    reason: &'a str,
    groups: Groups,
}

#[derive(Serialize)]
struct ModelJson {
    model: Rung,
    value: Json,
    error: Json,
}

impl<'a> LimitJson<'a> {
    fn new(limit: &'a LimitLadder) -> Self {
        let model = |m: &Measured| ModelJson { model: m.model, value: Json(m.value), error: Json(m.error) };
        Self {
            component: &limit.component,
            limit: limit.limit,
            unit: limit.ladder.unit,
            worst_case: &limit.worst_case,
            reference: limit.ladder.reference,
            models: limit.ladder.models.iter().map(model).collect(),
            cheapest: limit.ladder.cheapest,
            reason: &limit.ladder.reason,
            groups: limit.ladder.groups,
        }
    }
}

impl Serialize for Answer<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self(ladders) = self;
        AnswerJson {
            product: &ladders.product,
            tolerance: Json(ladders.tolerance),
            limits: ladders.limits.iter().map(LimitJson::new).collect(),
            left_out: &ladders.left_out,
            landings: &ladders.landings,
        }
        .serialize(serializer)
    }
}
