//! Which part of a product fails, in which drop, and by how much; what measured drops tell beside it.
//!
//! ```
//! use clatter_answer::assess;
//! use clatter_assess::{Accuracy, ProductFile};
//! let file = ProductFile::read(clatter_assess::EXAMPLE, "example.toml")?;
//! let answer = assess::answer(&file, &Accuracy::default())?;
//! assert_eq!(answer.assessment.components.len(), file.components.len());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Measured drops come from records by [`DropRecords::fitted`](crate::fit::DropRecords::fitted).

use clatter_assess::fit::{Comparison, MeasuredDrop};
use clatter_assess::{Accuracy, Assessment, Error, ProductFile, Watch};
use serde::{Serialize, Serializer};

use crate::Json;

/// A verdict on every limit, with its worst drop.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Answer<'a> {
    /// The product.
    pub file: &'a ProductFile,
    /// The verdicts.
    pub assessment: Assessment,
    /// Drops that were measured, to stand beside them.
    pub measured: Vec<MeasuredDrop>,
}

/// Searches the worst drop for every limit; without measured drops.
///
/// # Errors
/// As [`ProductFile::assess_to`].
pub fn answer<'a>(file: &'a ProductFile, accuracy: &Accuracy) -> Result<Answer<'a>, Error> {
    watched(file, accuracy, &|_, _| true)
}

/// The same, counted; where `watch` says so, with what there is by then.
///
/// # Errors
/// As [`ProductFile::assess_watched`].
pub fn watched<'a>(file: &'a ProductFile, accuracy: &Accuracy, watch: Watch<'_>) -> Result<Answer<'a>, Error> {
    Ok(Answer { file, assessment: file.assess_watched(accuracy, watch)?, measured: Vec::new() })
}

impl Serialize for Answer<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self { file, assessment, measured } = self;
        let measured = measured.iter().map(|drop| MeasuredJson::new(file, drop)).collect();
        AnswerJson { assessment, measured }.serialize(serializer)
    }
}

#[derive(Serialize)]
struct AnswerJson<'a> {
    #[serde(flatten)]
    assessment: &'a Assessment,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    measured: Vec<MeasuredJson<'a>>,
}

#[derive(Serialize)]
struct MeasuredJson<'a> {
    drop: &'a str,
    files: &'a [String],
    #[serde(skip_serializing_if = "Option::is_none")]
    model: Option<&'static str>,
    /// Why there is no fit.
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<&'a str>,
    estimates: Vec<EstimateJson>,
}

#[derive(Serialize)]
struct EstimateJson {
    quantity: &'static str,
    unit: &'static str,
    value: Json,
    interval: Option<[Json; 2]>,
    stated: Option<[Json; 2]>,
    agrees: Option<bool>,
}

impl<'a> MeasuredJson<'a> {
    fn new(file: &ProductFile, drop: &'a MeasuredDrop) -> Self {
        let estimate = |beside: Comparison<'_>| EstimateJson {
            quantity: beside.estimate.quantity.name(),
            unit: beside.estimate.quantity.unit(),
            value: Json(beside.estimate.value),
            interval: beside.estimate.interval.map(|interval| interval.map(Json)),
            stated: beside.stated.map(|stated| stated.map(Json)),
            agrees: beside.agrees,
        };
        let fit = drop.found.as_ref().ok();
        Self {
            drop: &drop.name,
            files: &drop.files,
            model: fit.map(|fit| fit.model.name()),
            reason: drop.found.as_ref().err().map(String::as_str),
            estimates: fit.map(|fit| fit.beside(file).into_iter().map(estimate).collect()).unwrap_or_default(),
        }
    }
}
