//! Which models a scene needs, and why: what an assessment decides drop by drop, told.

use serde::Serialize;

use crate::demand::Demand;
use crate::plan::{Groups, Pair, Plan};
use crate::search::{Field, Task};
use crate::verdict::number;
use crate::{Accuracy, Error, LimitAssessment, LimitKind, ProductFile, WorstCase};

/// The models for every limit of a product.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Explanation {
    /// Name of the product.
    pub product: String,
    /// What models may get wrong.
    pub tolerance: f64,
    /// In the order of the file.
    pub components: Vec<ComponentExplanation>,
}

/// The models for one component.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ComponentExplanation {
    /// Its name.
    pub name: String,
    /// One for each limit of the file.
    pub limits: Vec<LimitExplanation>,
}

/// The models for one limit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LimitExplanation {
    /// Which one.
    pub limit: LimitKind,
    /// The cheapest pairs that are good enough, over the drops of the grid that [`ProductFile::assess_to`] looks at,
    /// from the cheapest bar.
    pub shares: Vec<PairShare>,
    /// The drop that asks most of it.
    pub worst_case: WorstCase,
    /// Whether its demand is proven, without gravity, at small tilt and for velocity shocks.
    pub guaranteed: bool,
    /// The plan for that drop; null for what no plan estimates: turns of the product and pulses of hard-mounted parts.
    pub plan: Option<PlanExplanation>,
    /// Where the tolerance is not reached in that drop, or is reached on a condition.
    pub warning: Option<String>,
}

/// How many drops get a pair of models.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PairShare {
    /// How the bar moves.
    pub bar: &'static str,
    /// How the component answers.
    pub component: &'static str,
    /// Share of the grid.
    pub share: f64,
}

/// The pair for one drop, and why.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PlanExplanation {
    /// How the bar moves.
    pub bar: &'static str,
    /// How the component answers.
    pub component: &'static str,
    /// Which groups decided, in a sentence.
    pub reason: String,
    /// The dimensionless groups.
    pub groups: GroupValues,
    /// What the pair gets wrong, as a share of the quantity.
    #[serde(serialize_with = "number")]
    pub error: f64,
    /// Whether that is proven, or an estimate.
    pub is_bound: bool,
    /// What it costs, about: see [`Forecast::cost_ns`](crate::plan::Forecast::cost_ns).
    pub cost_ns: f64,
}

/// The dimensionless groups of a drop and a component: see [`Groups`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct GroupValues {
    /// G = g h0/v0².
    pub gravity: f64,
    /// φ².
    pub geometry: f64,
    /// τ/Δt; 0 where the contact time is not known.
    #[serde(serialize_with = "number")]
    pub overlap: f64,
    /// ωτ; null for a velocity shock.
    pub pulse: Option<f64>,
    /// ω t_N; null for a velocity shock.
    pub train: Option<f64>,
    /// ζωΔt; null for a velocity shock.
    pub damping: Option<f64>,
}

impl ProductFile {
    /// Which models every limit needs over the stated ranges for a tolerance, and why.
    ///
    /// # Errors
    /// As [`ProductFile::assess_to`].
    ///
    /// # Examples
    /// ```
    /// use clatter_scene::{EXAMPLE, ProductFile};
    /// let explanation = ProductFile::read(EXAMPLE, "example.toml")?.explain(0.01)?;
    /// for limit in explanation.components.iter().flat_map(|c| &c.limits) {
    ///     let whole: f64 = limit.shares.iter().map(|pair| pair.share).sum();
    ///     assert!((whole - 1.0).abs() < 1e-12);
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn explain(&self, tolerance: f64) -> Result<Explanation, Error> {
        let accuracy = Accuracy { tolerance, model: None };
        let assessment = self.assess_to(&accuracy)?;
        let field = Field::new(&self.product, &self.drop, &self.components, accuracy);
        let mut components = Vec::with_capacity(self.components.len());
        for (component, assessed) in self.components.iter().zip(assessment.components) {
            let mut limits = Vec::with_capacity(assessed.limits.len());
            for (demand, limit) in Demand::of(component).into_iter().zip(&assessed.limits) {
                let task = Task { component, demand, proven: None };
                limits.push(explain(&field, &task, limit)?);
            }
            components.push(ComponentExplanation { name: assessed.name, limits });
        }
        Ok(Explanation { product: assessment.product, tolerance, components })
    }
}

fn explain(field: &Field<'_>, task: &Task<'_>, limit: &LimitAssessment) -> Result<LimitExplanation, Error> {
    let mut counts: Vec<(Pair, u32)> = Vec::new();
    let (mut all, pairs) = (0, field.pairs(task)?);
    for pair in pairs {
        all += 1;
        match counts.iter_mut().find(|(known, _)| *known == pair) {
            Some((_, count)) => *count += 1,
            None => counts.push((pair, 1)),
        }
    }
    counts.sort_by_key(|(pair, _)| (pair.bar, pair.component));
    let share = |(pair, count): (Pair, u32)| PairShare {
        bar: pair.bar.name(),
        component: pair.component.name(),
        share: f64::from(count) / f64::from(all),
    };
    let plan = field.plan(task, &field.place_of(&limit.worst_case, task.demand.frequencies()))?;
    Ok(LimitExplanation {
        limit: limit.limit,
        shares: counts.into_iter().map(share).collect(),
        worst_case: limit.worst_case,
        guaranteed: limit.guaranteed,
        warning: plan.and_then(|plan| plan.warning).map(|warning| warning.to_string()),
        plan: plan.map(|plan| explained(&plan, task.demand.frequencies().is_some())),
    })
}

fn explained(plan: &Plan, responds: bool) -> PlanExplanation {
    let Groups { gravity, geometry, overlap, pulse, train, damping } = plan.reason().groups;
    let of_response = |x: f64| responds.then_some(x);
    PlanExplanation {
        bar: plan.pair.bar.name(),
        component: plan.pair.component.name(),
        reason: plan.reason().to_string(),
        groups: GroupValues {
            gravity,
            geometry,
            overlap,
            pulse: of_response(pulse),
            train: of_response(train),
            damping: of_response(damping),
        },
        error: plan.estimate.error,
        is_bound: plan.estimate.is_bound,
        cost_ns: plan.cost_ns(),
    }
}
