//! This module finds the changes that make each part of a product safe with a margin; in the plane of q and e, [`goals`] finds the designs
//! that meet several goals.
//!
//! ```
//! use clatter_answer::design;
//! use clatter_product::ProductFile;
//! use clatter_assess::design::Bounds;
//! let file = ProductFile::read(clatter_product::EXAMPLE, "example.toml")?;
//! let answer = design::answer(&file, &Bounds::default(), 0.1)?;
//! // A part that is safe with that margin needs no change.
//! assert!(answer.remedies.len() <= file.components.len());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod goals;

use clatter_assess::{
    Assessment, ComponentAssessment, Verdict, Watch,
    design::{Bounds, Change, Lever, Outcome, Plane, Remedies, Remedy, Together},
};
use clatter_product::{Error, ProductFile};
use serde::{Serialize, Serializer};

use crate::Json;
use crate::numbers::neat;

/// Changes for each part that is not safe with the margin.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Answer<'a> {
    /// The product.
    pub file: &'a ProductFile,
    /// The assessment of the product as it is.
    pub assessment: Assessment,
    /// The changes.
    pub remedies: Vec<Remedies>,
    /// The region of the plane of q and e in which its parts are safe.
    pub plane: Option<Plane>,
    /// The requested margin: allowed/demand − 1.
    pub margin: f64,
}

/// Finds the smallest changes within the bounds; without the plane.
///
/// # Errors
/// As [`clatter_assess::assess()`] and [`clatter_assess::remedies`].
pub fn answer<'a>(file: &'a ProductFile, bounds: &Bounds, margin: f64) -> Result<Answer<'a>, Error> {
    let assessment = clatter_assess::assess(file)?;
    let remedies = clatter_assess::remedies(file, &assessment, bounds, margin)?;
    Ok(Answer::new(file, assessment, remedies, margin))
}

/// Finds the changes for the printed pages, by the bounds and with the margin that `clatter design` has by default. Of a plate or a
/// box there are none: to find them takes many times as long as to assess it.
///
/// # Errors
/// As [`clatter_assess::remedies_watched`].
pub fn of_pages(file: &ProductFile, assessment: &Assessment, watch: Watch<'_>) -> Result<Vec<Remedies>, Error> {
    if file.product.body.is_wide() {
        return Ok(Vec::new());
    }
    clatter_assess::remedies_watched(file, assessment, &Bounds::default(), 0.1, watch)
}

impl<'a> Answer<'a> {
    /// Makes the answer from changes that were found for this assessment, without the plane.
    #[must_use]
    pub fn new(file: &'a ProductFile, assessment: Assessment, remedies: Vec<Remedies>, margin: f64) -> Self {
        Self { file, assessment, remedies, plane: None, margin }
    }

    /// Returns the radius of gyration in mm behind an inertia ratio, which is what can be built.
    #[must_use]
    pub fn gyration_mm(&self, q: f64) -> f64 {
        let product = self.file.product.with_inertia_ratio(q);
        product.map_or(f64::NAN, |product| neat(1e3 * product.body.gyration_m()))
    }

    fn json(&self) -> ProductJson<'_> {
        let product = &self.file.product;
        let components = self.assessment.components.iter().enumerate();
        ProductJson {
            product: &product.name,
            q: (!product.body.is_wide()).then(|| Json(product.inertia_ratio())),
            restitution: [Json(product.restitution.lo()), Json(product.restitution.hi())],
            verdict: self.assessment.verdict,
            margin: Json(self.margin),
            plane: self.plane.as_ref().map(|plane| PlaneJson {
                model: plane.model.name(),
                side: plane.side,
                closed_form_error: Json(plane.closed_form_error),
            }),
            components: components.map(|(i, component)| self.part_json(i, component)).collect(),
        }
    }

    fn part_json<'b>(&'b self, i: usize, component: &'b ComponentAssessment) -> PartJson<'b> {
        let part = self.remedies.iter().find(|part| part.component == i);
        let together = |together: &Together| TogetherJson {
            changes: together.changes.iter().map(|change| self.change_json(change)).collect(),
            verdict: together.after.verdict,
            margin_after: Json(clatter_assess::least_margin(self.file, &together.after)),
        };
        PartJson {
            name: &component.name,
            verdict: component.verdict,
            margin: Json(clatter_assess::least_margin(self.file, component)),
            remedies: part.iter().flat_map(|part| &part.levers).map(|remedy| self.remedy_json(remedy)).collect(),
            pair: part.and_then(|part| part.pair.as_ref()).map(together),
            nearest: part.and_then(|part| part.nearest.as_ref()).map(together),
        }
    }

    fn change_json(&self, change: &Change) -> ChangeJson {
        ChangeJson {
            lever: change.lever.name(),
            unit: change.lever.unit(),
            from: change.from.map(Json),
            to: change.to.map(Json),
            radius_of_gyration_m: (change.lever == Lever::InertiaRatio)
                .then(|| Json(neat(1e-3 * self.gyration_mm(change.to[0])))),
        }
    }

    fn remedy_json(&self, Remedy { lever, outcome }: &Remedy) -> RemedyJson {
        let none = RemedyJson {
            lever: lever.name(),
            unit: lever.unit(),
            outcome: "no-effect",
            from: None,
            to: None,
            radius_of_gyration_m: None,
            margin_after: None,
            warning: None,
            bounds: None,
        };
        match outcome {
            Outcome::Change { change, after } => {
                let ChangeJson { from, to, radius_of_gyration_m, .. } = self.change_json(change);
                let notes: Vec<_> = after.tightest().notes.iter().map(ToString::to_string).collect();
                RemedyJson {
                    outcome: "change",
                    from: Some(from),
                    to: Some(to),
                    radius_of_gyration_m,
                    margin_after: Some(Json(clatter_assess::least_margin(self.file, after))),
                    warning: (!notes.is_empty()).then(|| notes.join("; ")),
                    ..none
                }
            }
            Outcome::Nowhere { bounds } => RemedyJson { outcome: "nowhere", bounds: Some(bounds.map(Json)), ..none },
            Outcome::NoEffect => none,
            Outcome::Stopped => RemedyJson { outcome: "stopped", ..none },
        }
    }
}

impl Serialize for Answer<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.json().serialize(serializer)
    }
}

#[derive(Serialize)]
struct ProductJson<'a> {
    product: &'a str,
    /// The inertia ratio; null of a plate.
    q: Option<Json>,
    restitution: [Json; 2],
    verdict: Verdict,
    /// The requested margin.
    margin: Json,
    /// The description of how the plane was found, where it was requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    plane: Option<PlaneJson>,
    components: Vec<PartJson<'a>>,
}

#[derive(Serialize)]
struct PlaneJson {
    model: &'static str,
    /// The number of values of q, and of e.
    side: usize,
    /// The worst that the closed form got wrong on drops all over the plane; null where one of the models has no answer.
    closed_form_error: Json,
}

#[derive(Serialize)]
struct PartJson<'a> {
    name: &'a str,
    verdict: Verdict,
    /// The margin, as of [`clatter_assess::least_margin`].
    margin: Json,
    remedies: Vec<RemedyJson>,
    /// The two changes that are enough together, where no change alone is.
    pair: Option<TogetherJson>,
    /// The two changes that come nearest, where no two are enough either.
    nearest: Option<TogetherJson>,
}

#[derive(Serialize)]
struct TogetherJson {
    changes: Vec<ChangeJson>,
    verdict: Verdict,
    margin_after: Json,
}

#[derive(Serialize)]
struct ChangeJson {
    lever: &'static str,
    unit: &'static str,
    from: [Json; 2],
    to: [Json; 2],
    /// The radius of gyration of an inertia ratio.
    #[serde(skip_serializing_if = "Option::is_none")]
    radius_of_gyration_m: Option<Json>,
}

#[derive(Serialize)]
struct RemedyJson {
    lever: &'static str,
    unit: &'static str,
    outcome: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    from: Option<[Json; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    to: Option<[Json; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    radius_of_gyration_m: Option<Json>,
    #[serde(skip_serializing_if = "Option::is_none")]
    margin_after: Option<Json>,
    /// The warning about the part after the change.
    #[serde(skip_serializing_if = "Option::is_none")]
    warning: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    bounds: Option<[Json; 2]>,
}
