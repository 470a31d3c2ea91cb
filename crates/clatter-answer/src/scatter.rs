//! This module computes how likely each part of a product survives, and which inputs decide that.
//!
//! ```
//! use clatter_answer::scatter;
//! use clatter_assess::scatter::Settings;
//! let file = clatter_product::ProductFile::read(clatter_product::EXAMPLE, "example.toml")?;
//! let mut answer = scatter::answer(&file, Settings { samples: 200, seed: 1, confidence: 0.95, merge_s: 1e-3 })?;
//! answer.target = Some(0.999);
//! // 200 drops cannot show that.
//! assert!(!answer.is_met());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A sample of a box is one product that goes through all of its drops: [`SEQUENCE`].
//!
//! To watch the samples, or to keep them, draw with a [`Sampler`] and make the answer of what it gives.

use std::convert::Infallible;

use clatter_assess::scatter::{
    ComponentScatter, Driver, LandingComponent, LandingScatter, PlateAs, Probability, Sampler, Scatter, Settings,
    Varied,
};
use clatter_product::{Component, DropName, Error, Model, ProductFile};
use serde::{Serialize, Serializer};

use crate::Json;

/// The definition of a sample of a box.
pub const SEQUENCE: &str = "a sample is one product that goes through all drops: what [product] and [[component]] give is drawn once \
for it, height or speed and attitude for each drop, every attitude within the tolerance equally likely; it survives if it survives each drop";

/// The result of all samples.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Answer<'a> {
    /// The product.
    pub file: &'a ProductFile,
    /// The samples.
    pub scatter: Scatter,
    /// The share of drops that all parts are to survive.
    pub target: Option<f64>,
}

impl<'a> Answer<'a> {
    /// Makes the answer from samples that were drawn of this product, without a target.
    #[must_use]
    pub fn new(file: &'a ProductFile, scatter: Scatter) -> Self {
        Self { file, scatter, target: None }
    }
    /// Returns whether the interval of the survival lies above the target, if there is one.
    #[must_use]
    pub fn is_met(&self) -> bool {
        self.target.is_none_or(|share| self.scatter.survival.lo >= share)
    }
}

/// Draws the samples.
///
/// # Errors
/// Those of [`Sampler::new`].
pub fn answer(file: &ProductFile, settings: Settings) -> Result<Answer<'_>, Error> {
    let Ok(scatter) = Sampler::new(file, settings)?.run(false, &|| true, |_| Ok::<_, Infallible>(()));
    Ok(Answer::new(file, scatter))
}

#[derive(Serialize)]
struct AnswerJson<'a> {
    product: &'a str,
    samples: u64,
    seed: u64,
    confidence: Json,
    model: ModelJson,
    inputs: Vec<InputJson>,
    survival: SurvivalJson,
    #[serde(skip_serializing_if = "Option::is_none")]
    target: Option<TargetJson>,
    unanswered: u64,
    /// The reason why the first of them has no answer.
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<String>,
    /// The number of samples that the error of answers, or the energy left, decides.
    open: u64,
    components: Vec<ComponentJson<'a>>,
    /// Each drop, where there are several.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    landings: Vec<LandingJson<'a>>,
}

#[derive(Serialize)]
struct LandingJson<'a> {
    landing: DropName,
    survival: SurvivalJson,
    components: Vec<LandingComponentJson<'a>>,
}

#[derive(Serialize)]
struct LandingComponentJson<'a> {
    name: &'a str,
    failed: u64,
    open: u64,
    unanswered: u64,
    survival: SurvivalJson,
    /// The largest utilization; null where no drop was answered.
    largest_utilization: Option<Json>,
}

#[derive(Serialize)]
struct ModelJson {
    bar: &'static str,
    reason: &'static str,
    /// The way in which a plate is followed.
    #[serde(skip_serializing_if = "Option::is_none")]
    plate: Option<PlateJson>,
    /// The definition of a sample, where there are several drops.
    #[serde(skip_serializing_if = "Option::is_none")]
    sequence: Option<&'static str>,
}

#[derive(Serialize)]
#[serde(tag = "as", rename_all = "kebab-case")]
enum PlateJson {
    Box {
        thickness_m: Json,
        /// True where the file gives no thickness.
        assumed: bool,
    },
    /// A plate on feet: real tilt is left out.
    LevelPlate,
}

#[derive(Serialize)]
struct TargetJson {
    survival: Json,
    met: bool,
}

#[derive(Serialize)]
struct InputJson {
    input: &'static str,
    /// Index of the component that it belongs to.
    #[serde(skip_serializing_if = "Option::is_none")]
    component: Option<usize>,
    /// The drop of several that it belongs to.
    #[serde(skip_serializing_if = "Option::is_none")]
    landing: Option<DropName>,
    /// The kind of limit, where the input belongs to one.
    #[serde(skip_serializing_if = "Option::is_none")]
    limit: Option<&'static str>,
    /// True where the file gives only a range, without a distribution.
    assumed_uniform: bool,
}

#[derive(Serialize)]
struct SurvivalJson {
    /// The probability; null where nothing was answered.
    probability: Option<Json>,
    interval: [Json; 2],
    at_least: Json,
}

#[derive(Serialize)]
struct ComponentJson<'a> {
    name: &'a str,
    failed: u64,
    /// The number of drops whose utilization is so near 1 that its error decides.
    open: u64,
    unanswered: u64,
    survival: SurvivalJson,
    limits: Vec<LimitJson>,
    /// The utilization; null where no drop was answered.
    utilization: Option<UtilizationJson>,
    drivers: Vec<DriverJson>,
}

#[derive(Serialize)]
struct LimitJson {
    limit: &'static str,
    failed: u64,
}

#[derive(Serialize)]
struct UtilizationJson {
    mean: Json,
    standard_deviation: Json,
    largest: Json,
    largest_sample: u64,
}

#[derive(Serialize)]
struct DriverJson {
    input: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    landing: Option<DropName>,
    #[serde(skip_serializing_if = "Option::is_none")]
    limit: Option<&'static str>,
    variance_share: Json,
    trend: Json,
}

impl SurvivalJson {
    fn new(p: Probability) -> Self {
        Self { probability: p.estimate.map(Json), interval: [Json(p.lo), Json(p.hi)], at_least: Json(p.at_least) }
    }
}

impl ModelJson {
    fn new(scatter: &Scatter) -> Self {
        let reason = match scatter.model {
            Model::Compliant => "contacts that take time: how long is known",
            _ => "instant impacts at real tilt, with gravity: the contact time is not known",
        };
        let plate = |plate| match plate {
            PlateAs::Box { thickness_m, assumed } => PlateJson::Box { thickness_m: Json(thickness_m), assumed },
            PlateAs::Level => PlateJson::LevelPlate,
        };
        let sequence = (!scatter.landings.is_empty()).then_some(SEQUENCE);
        Self { bar: scatter.model.name(), reason, plate: scatter.plate.map(plate), sequence }
    }
}

/// Returns the name of the limit, where an input is one.
fn limit(input: &Varied) -> Option<&'static str> {
    if let Varied::Limit(_, kind) = input { Some(kind.name()) } else { None }
}

impl<'a> LandingJson<'a> {
    fn new(file: &'a ProductFile, of: &LandingScatter) -> Self {
        let one = |(component, of): (&'a Component, &LandingComponent)| LandingComponentJson {
            name: &component.name,
            failed: of.failures,
            open: of.open,
            unanswered: of.unanswered,
            survival: SurvivalJson::new(of.survival),
            largest_utilization: of.largest_utilization.map(Json),
        };
        let components = file.components.iter().zip(&of.components).map(one).collect();
        Self { landing: of.landing, survival: SurvivalJson::new(of.survival), components }
    }
}

impl<'a> ComponentJson<'a> {
    fn new(c: &'a ComponentScatter, landing: &dyn Fn(&Varied) -> Option<DropName>) -> Self {
        let driver = |driver: &Driver| DriverJson {
            input: driver.input.name(),
            landing: landing(&driver.input),
            limit: limit(&driver.input),
            variance_share: Json(driver.share.variance),
            trend: Json(driver.share.trend),
        };
        Self {
            name: &c.name,
            failed: c.failures,
            open: c.open,
            unanswered: c.unanswered,
            survival: SurvivalJson::new(c.survival),
            limits: c.limits.iter().map(|(kind, failed)| LimitJson { limit: kind.name(), failed: *failed }).collect(),
            utilization: c.worst_sample.map(|largest_sample| UtilizationJson {
                mean: Json(c.mean_utilization),
                standard_deviation: Json(c.utilization_deviation),
                largest: Json(c.largest_utilization),
                largest_sample,
            }),
            drivers: c.drivers.iter().map(driver).collect(),
        }
    }
}

impl Serialize for Answer<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self { file, scatter, target } = self;
        let Settings { samples, seed, confidence, .. } = scatter.settings;
        let names = file.drop_names();
        let landing = |input: &Varied| input.landing().map(|n| names[n]);
        let input = |input: &Varied| InputJson {
            input: input.name(),
            component: input.component(),
            landing: landing(input),
            limit: limit(input),
            assumed_uniform: scatter.assumed_even.contains(input),
        };
        AnswerJson {
            product: &file.product.name,
            samples,
            seed,
            confidence: Json(confidence),
            model: ModelJson::new(scatter),
            inputs: scatter.inputs.iter().map(input).collect(),
            survival: SurvivalJson::new(scatter.survival),
            target: target.map(|share| TargetJson { survival: Json(share), met: self.is_met() }),
            unanswered: scatter.unanswered,
            reason: scatter.reason.as_ref().map(ToString::to_string),
            open: scatter.open,
            components: scatter.components.iter().map(|c| ComponentJson::new(c, &landing)).collect(),
            landings: scatter.landings.iter().map(|of| LandingJson::new(file, of)).collect(),
        }
        .serialize(serializer)
    }
}
