//! This module measures which model a drop needs: every model on the worst drop of each limit, its error and its cost.
//!
//! Six models from the least physics to the most ([`Model`]) answer the same drop of a bar. Each is held against the one with the most
//! physics that the data allow, worked out more exactly; the cheapest within the tolerance is named, with the dimensionless
//! group that makes the next cheaper one too coarse. A drop of a plate is answered with contacts that take time by three bodies: the bar
//! along its length, the plate of small tilt, and the box with full rotation, which is what they are held against. A drop of a box on a
//! face is answered by the same three where the part moves across that face, and by itself alone on an edge or a corner; next to it stands
//! how late the last corner may come ([`LandingLadder`]). Errors are the same from run to run; times are of the machine that [`Machine`]
//! names.

mod bodies;
mod landing;
mod time;

use serde::{Serialize, Serializer};

pub use landing::LandingLadder;
pub use time::Machine;

use crate::engine::{Answer, Part, answer};
use crate::model::follow;
use crate::verdict::{number, number_or_null};
use crate::{Assessment, WorstCase};
use clatter_flight::{Drop, Until};
use clatter_product::{Error, Limit, LimitKind, Model, ProductFile, Unit};

/// The reference is worked out so much more exactly than the tolerance demands.
const FINER: f64 = 0.1;

/// The model or body that answers a drop.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rung {
    /// A bar, by a model.
    Model(Model),
    /// The bar along the length of a plate, with contacts that take time: as if it were of no width.
    Bar,
    /// The plate of small tilt, with contacts that take time.
    Plate,
    /// The same as a box with full rotation.
    Block,
}

impl Rung {
    /// Returns the name of the model; `bar`, `plate` or `box`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Model(model) => model.name(),
            Self::Bar => "bar",
            Self::Plate => "plate",
            Self::Block => "box",
        }
    }
}

impl Serialize for Rung {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

/// All models on the worst drops of a product.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ProductLadder {
    /// Name of the product.
    pub product: String,
    /// The error that a model may have.
    pub tolerance: f64,
    /// The machine on which the times were taken.
    pub machine: Machine,
    /// Part by part, limit by limit, in the order of the assessment.
    pub limits: Vec<LimitLadder>,
    /// Limits of which no drop was answered.
    pub left_out: Vec<LeftOut>,
    /// The drops of a box, one by one; else empty.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub landings: Vec<LandingLadder>,
}

/// All models on the worst drop of one limit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LimitLadder {
    /// Name of the part.
    pub component: String,
    /// The limited quantity.
    pub limit: LimitKind,
    /// The drop.
    pub worst_case: WorstCase,
    /// The models on it.
    #[serde(flatten)]
    pub ladder: Ladder,
}

/// A limit without a ladder.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct LeftOut {
    /// Name of the part.
    pub component: String,
    /// The limited quantity.
    pub limit: LimitKind,
    /// The reason.
    pub reason: String,
}

/// All models on one drop.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Ladder {
    /// Unit of the values.
    pub unit: Unit,
    /// The reference for the models.
    pub reference: Reference,
    /// The models from the least physics to the most; those that say something of the limit.
    pub models: Vec<Measured>,
    /// The cheapest one within the tolerance.
    pub cheapest: Rung,
    /// The dimensionless group that makes the next cheaper one too coarse, in a sentence.
    pub reason: String,
    /// The dimensionless groups of the drop and the part.
    pub groups: Groups,
}

/// The reference against which the models are compared.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Reference {
    /// The model with the most physics that the data allow; of a plate the box, where it is followed.
    pub model: Rung,
    /// Its answer.
    pub value: f64,
    /// The tolerance that it was worked out to.
    pub tolerance: f64,
}

/// One model on the drop.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Measured {
    /// The model or body.
    pub model: Rung,
    /// Its answer.
    pub value: f64,
    /// |value/reference − 1|.
    #[serde(serialize_with = "number")]
    pub error: f64,
    /// Time of one run, the median of many.
    pub seconds: f64,
    /// Strikes followed; 0 in closed form.
    pub strikes: usize,
}

/// The dimensionless groups that decide which physics count.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Groups {
    /// G = g h₀/v₀²: gravity.
    pub gravity: f64,
    /// φ²: real tilt.
    pub geometry: f64,
    /// τ/Δt, contact time over the gap between the first two strikes: overlap; null without a contact time.
    pub overlap: Option<f64>,
    /// ωτ: whether a pulse is a velocity shock to the part; null without a contact time and for limits on the product itself.
    pub pulse: Option<f64>,
    /// ω t_N, t_N the time from the first to the last strike that counts: whether the clatter is one change of velocity to the part.
    pub train: Option<f64>,
    /// ζωΔt: whether the part has calmed down before the next strike.
    pub damping: Option<f64>,
    /// h_y/h_x, what a plate rises along its width over what it rises along its length: what a bar lacks; infinite where it rises along
    /// its width alone. None of a bar.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "number_or_null")]
    pub across: Option<f64>,
}

impl Ladder {
    /// Runs and times every model on one drop.
    ///
    /// # Errors
    /// As [`answer`] of the model with the most physics, of a plate of the plate of small tilt.
    ///
    /// # Examples
    /// ```
    /// use clatter_assess::ladder::Ladder;
    /// use clatter_assess::Part;
    /// use clatter_product::{Body, Drop, Limit, LimitKind};
    /// let drop = Drop { contact_time_s: Some(2e-4), ..Drop::new(Body::new(0.14, 0.04)?, 4.43, 0.09, 0.3) };
    /// let part = Part::new(0.06, None);
    /// let ladder = Ladder::measure(&drop, &part, &Limit::new(LimitKind::VelocityChange, 3.0), 0.01)?;
    /// assert!(ladder.models.last().is_some_and(|fullest| fullest.error < 0.01));
    /// # Ok::<(), clatter_product::Error>(())
    /// ```
    pub fn measure(drop: &Drop, part: &Part, limit: &Limit, tolerance: f64) -> Result<Self, Error> {
        let of = if drop.body.is_wide() {
            bodies::compared(drop, part, limit, tolerance)?
        } else {
            models_of_bar(drop, part, limit, tolerance)?
        };
        let groups = Groups::of(&of.drop, &of.part)?;
        let Compared { unit, reference, models, plate_lacks, .. } = of;
        let cheapest = cheapest(&models, tolerance).unwrap_or(reference.model);
        let reason = reason(&models, cheapest, tolerance, &groups, plate_lacks);
        Ok(Self { unit, reference, models, cheapest, reason, groups })
    }
}

/// Models or bodies on one drop.
struct Compared {
    unit: Unit,
    reference: Reference,
    models: Vec<Measured>,
    /// The drop and the part of which the dimensionless groups are: of a box those of the plate that its face is.
    drop: Drop,
    part: Part,
    /// What the plate of small tilt lacks, and why a box has nothing to be compared with.
    plate_lacks: String,
}

/// Compares the models on a drop of a bar.
fn models_of_bar(drop: &Drop, part: &Part, limit: &Limit, tolerance: f64) -> Result<Compared, Error> {
    let fullest = Model::fullest(drop);
    let exact = answer(drop, part, limit, fullest, FINER * tolerance)?;
    let says = |model: &Model| *model <= fullest && (*model != Model::NetChange || part.suspension.is_some());
    let one = |model: Model| {
        let strikes = || match model {
            Model::NetChange | Model::LargestShock => Ok(0),
            _ => Ok(follow(drop, model, tolerance, Until::Over)?.struck_s().len()),
        };
        measured(Rung::Model(model), &exact, &|| answer(drop, part, limit, model, tolerance), &strikes)
    };
    // A model that refuses the drop is left out: an endless train has no net change.
    let models = Model::ALL.into_iter().filter(says).filter_map(|model| one(model).ok()).collect();
    let reference = Reference { model: Rung::Model(fullest), value: exact.value, tolerance: FINER * tolerance };
    Ok(Compared { unit: exact.unit, reference, models, drop: *drop, part: *part, plate_lacks: String::new() })
}

/// Measures one of them next to the exact answer.
fn measured(
    model: Rung,
    exact: &Answer,
    answer: &dyn Fn() -> Result<Answer, Error>,
    strikes: &dyn Fn() -> Result<usize, Error>,
) -> Result<Measured, Error> {
    let (found, seconds) = time::measured(answer)?;
    let error = (found.utilization() / exact.utilization() - 1.0).abs();
    Ok(Measured { model, value: found.value, error, seconds, strikes: strikes()? })
}

impl Groups {
    fn of(drop: &Drop, part: &Part) -> Result<Self, Error> {
        let h0 = drop.gap_m();
        // For a plate and for contacts that differ, only contacts that take time are followed.
        let alone = drop.body.is_wide() || !drop.own_contacts.is_none();
        let model = if alone { Model::Compliant } else { Model::Map };
        let times = follow(drop, model, 0.01, Until::Over)?.struck_s();
        let gap = times.get(1).copied().unwrap_or(f64::INFINITY);
        let last = times.last().copied().unwrap_or(0.0);
        let omega = part.suspension.map(|part| part.omega());
        Ok(Self {
            gravity: drop.gravity_m_s2 * h0 / drop.speed_m_s.powi(2),
            geometry: drop.tilt_rad.powi(2),
            overlap: drop.contact_times_s().map(|[_, longest]| longest / gap),
            pulse: omega.zip(drop.contact_times_s()).map(|(omega, [_, longest])| omega * longest),
            train: omega.map(|omega| omega * last),
            damping: part.suspension.map(|part| part.damping().get() * part.omega() * gap),
            across: (drop.body.is_wide() && drop.is_level).then(|| {
                let [along, across] = drop.gaps_m();
                across / along
            }),
        })
    }
}

/// Returns the one within the tolerance that takes the least time.
fn cheapest(models: &[Measured], tolerance: f64) -> Option<Rung> {
    let within = models.iter().filter(|m| m.error <= tolerance);
    within.min_by(|a, b| a.seconds.total_cmp(&b.seconds)).map(|m| m.model)
}

/// Returns words, and the value of a group where it is known.
fn with(words: &str, group: &str, value: Option<f64>) -> String {
    value.map_or_else(|| words.to_owned(), |value| format!("{words}: {group} = {value:.2e}"))
}

fn percent(share: f64) -> String {
    format!("{:.2} %", 100.0 * share)
}

/// Returns the reason why the next cheaper one is too coarse: the physics that it lacks, as a number.
fn reason(models: &[Measured], cheapest: Rung, tolerance: f64, groups: &Groups, plate_lacks: String) -> String {
    if models.iter().all(|m| m.model == Rung::Block) {
        return "no bar and no plate lands so, or moves the part along this axis".to_owned();
    }
    let Some(coarser) = models.iter().rfind(|m| m.model < cheapest && m.error > tolerance) else {
        let off = models.iter().find(|m| m.model == cheapest).map_or(f64::INFINITY, |m| m.error);
        return match cheapest {
            Rung::Model(Model::NetChange) => with("the clatter is short beside the period", "ω t_N", groups.train),
            Rung::Model(Model::LargestShock) => with("one shock decides", "ζωΔt", groups.damping),
            Rung::Bar => {
                let width = with("its width does nothing here", "h_y/h_x", groups.across);
                format!("{width}; bar is off by {}", percent(off))
            }
            model => format!("{} is the cheapest here", model.name()),
        };
    };
    let lacks = match coarser.model {
        Rung::Model(Model::NetChange) => with("the part feels single strikes", "ω t_N", groups.train),
        Rung::Model(Model::LargestShock) => with("shocks add up", "ζωΔt", groups.damping),
        Rung::Model(Model::Map) => with("gravity counts", "g h0/v0²", Some(groups.gravity)),
        Rung::Model(Model::Ballistic) => with("real tilt counts", "φ²", Some(groups.geometry)),
        Rung::Bar => with("it turns about its length too, as no bar does", "h_y/h_x", groups.across),
        Rung::Plate | Rung::Block => plate_lacks,
        Rung::Model(_) if groups.overlap.is_some_and(|x| x > 1.0) => with("contacts overlap", "τ/Δt", groups.overlap),
        Rung::Model(_) if groups.pulse.is_none() => {
            with("the force has the shape that the contact gives it", "τ/Δt", groups.overlap)
        }
        Rung::Model(_) => with("pulses are no velocity shocks", "ωτ", groups.pulse),
    };
    format!("{}; {} is off by {}", lacks, coarser.model.name(), percent(coarser.error))
}

/// Runs every model on the worst drop of each limit, as an assessment of this file found it.
///
/// # Errors
/// As [`Ladder::measure`]; [`Error::OtherProduct`] for an assessment of another product.
///
/// # Examples
/// ```
/// use clatter_product::{EXAMPLE, ProductFile};
/// let file = ProductFile::read(EXAMPLE, "example.toml")?;
/// let ladders = clatter_assess::ladders(&file, &clatter_assess::assess(&file)?, 0.01)?;
/// assert!(ladders.limits.iter().all(|limit| limit.ladder.models.len() > 2));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn ladders(file: &ProductFile, assessment: &Assessment, tolerance: f64) -> Result<ProductLadder, Error> {
    file.check()?;
    assessment.is_of(file)?;
    let (mut limits, mut left_out) = (Vec::new(), Vec::new());
    for (component, assessed) in file.components.iter().zip(&assessment.components) {
        for (limit, found) in Limit::of(component).iter().zip(&assessed.limits) {
            let name = component.name.clone();
            let Some(worst) = found.worst_case.as_ref().filter(|_| found.demand.is_some_and(|demand| demand > 0.0))
            else {
                let reason = found.why_undecided().unwrap_or_else(|| "nothing is asked of it".to_owned());
                left_out.push(LeftOut { component: name, limit: limit.kind, reason });
                continue;
            };
            let ladder = Ladder::measure(&worst.drop, &worst.part, limit, tolerance)?;
            let (limit, worst_case) = (limit.kind, *worst);
            limits.push(LimitLadder { component: name, limit, worst_case, ladder });
        }
    }
    let (product, machine) = (assessment.product.clone(), Machine::here());
    let landings = landing::landing_ladders(file, assessment);
    Ok(ProductLadder { product, tolerance, machine, limits, left_out, landings })
}
