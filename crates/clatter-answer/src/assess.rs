//! This module finds which part of a product fails, in which drop, and by how much; measured drops stand next to these verdicts.
//!
//! ```
//! use clatter_answer::assess;
//! use clatter_assess::Accuracy;
//! use clatter_product::ProductFile;
//! let file = ProductFile::read(clatter_product::EXAMPLE, "example.toml")?;
//! let answer = assess::answer(&file, &Accuracy::default())?;
//! assert_eq!(answer.assessment.components.len(), file.components.len());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Measured drops come from records by [`DropRecords::fitted`](crate::fit::DropRecords::fitted).

use clatter_assess::{Accuracy, Assessment, Watch};
use clatter_fit::{Comparison, MeasuredDrop};
use clatter_product::{Error, ProductFile, Reliability};
use serde::{Serialize, Serializer};

use crate::{Json, significant};

/// A verdict on every limit, with its worst drop.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Answer<'a> {
    /// The product.
    pub file: &'a ProductFile,
    /// The verdicts.
    pub assessment: Assessment,
    /// Measured drops, which stand next to the verdicts.
    pub measured: Vec<MeasuredDrop>,
}

/// Searches the worst drop for every limit; without measured drops.
///
/// # Errors
/// As [`clatter_assess::assess_to`].
pub fn answer<'a>(file: &'a ProductFile, accuracy: &Accuracy) -> Result<Answer<'a>, Error> {
    watched(file, accuracy, &|_, _| true)
}

/// Searches as [`answer`] does and counts the progress; ends early where `watch` says so, with the verdicts by then.
///
/// # Errors
/// As [`clatter_assess::assess_watched`].
pub fn watched<'a>(file: &'a ProductFile, accuracy: &Accuracy, watch: Watch<'_>) -> Result<Answer<'a>, Error> {
    Ok(Answer { file, assessment: clatter_assess::assess_watched(file, accuracy, watch)?, measured: Vec::new() })
}

impl Answer<'_> {
    /// Draws products for the limits that are undecided, and counts the progress; ends early where `watch` says so.
    ///
    /// # Errors
    /// As [`clatter_assess::reliable`].
    pub fn draw(&mut self, asked: Reliability, watch: Watch<'_>) -> Result<(), Error> {
        self.assessment = clatter_assess::reliable(self.file, self.assessment.clone(), asked, watch)?;
        Ok(())
    }
    /// Returns the warnings about measured drops, each with the name of the drop: where the measured product differs from that of the file,
    /// and where no fit was found.
    #[must_use]
    pub fn warnings(&self) -> Vec<(&str, String)> {
        let of = |drop: &MeasuredDrop| match &drop.found {
            Ok(fit) => fit.differs(self.file).iter().map(differs).collect(),
            Err(reason) => vec![reason.clone()],
        };
        self.measured.iter().flat_map(|drop| of(drop).into_iter().map(|told| (drop.name.as_str(), told))).collect()
    }
}

fn differs(beside: &Comparison<'_>) -> String {
    let Said { what, measured, interval, stated } = Said::of(beside);
    let interval = if interval.is_empty() { interval } else { format!(" ({interval})") };
    format!("{what} was measured as {measured}{interval}; the verdict is for the {stated} that the product file states")
}

/// A measured quantity next to the stated one, in words: to four digits, with units.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Said {
    /// The quantity.
    pub what: &'static str,
    /// Its estimate.
    pub measured: String,
    /// The range of the quantity by 95 %, without a unit; empty where the range is not known.
    pub interval: String,
    /// The value of the product file; empty where the file has none.
    pub stated: String,
}

impl Said {
    /// Writes a comparison in words.
    #[must_use]
    pub fn of(beside: &Comparison<'_>) -> Self {
        let (what, factor, unit) = beside.estimate.quantity.said();
        let four = |x: f64| significant(factor * x, 4);
        let with = |text: String| format!("{text} {unit}").trim_end().to_owned();
        let range = |[lo, hi]: [f64; 2]| {
            let [lo, hi] = [lo, hi].map(four);
            if lo == hi { lo } else { format!("{lo} to {hi}") }
        };
        Self {
            what,
            measured: with(four(beside.estimate.value)),
            interval: beside.estimate.interval.map_or_else(String::new, range),
            stated: beside.stated.map_or_else(String::new, |stated| with(range(stated))),
        }
    }
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
    /// The reason why there is no fit.
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
