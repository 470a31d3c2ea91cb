//! This module holds the answer of a study, and its JSON.

use clatter_assess::{Verdict, scatter::Scatter};
use clatter_product::{LimitKind, ProductFile, Unit};
use serde::{Serialize, Serializer};

use super::Study;
use crate::{Json, scatter};

/// The result of all rows of a study.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Answer<'a> {
    /// The study.
    pub study: &'a Study,
    /// The confidence of all intervals.
    pub confidence: f64,
    /// The share of drops that all parts of each product are to survive.
    pub target: Option<f64>,
    /// Its products, in the order of the grid.
    pub members: Vec<Member>,
}

/// A product of the study, and what came of it.
#[derive(Debug, Clone)]
pub struct Member {
    /// Its values of the grid, as a product file has them, without quotes.
    pub values: Vec<String>,
    /// The product.
    pub file: ProductFile,
    /// The result of the product.
    pub outcome: Outcome,
}

/// The result of a product.
#[derive(Debug, Clone)]
pub enum Outcome {
    /// Its drops.
    Drawn(Box<Scatter>),
    /// Its limits in their worst drops.
    Searched(Vec<SearchedLimit>),
}

/// A limit in the worst drop that was found, in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SearchedLimit {
    /// The part, by its index in the file.
    pub component: usize,
    /// The kind of limit.
    pub limit: LimitKind,
    /// The allowed value of the file; none of a damage boundary.
    pub allowed: Option<f64>,
    /// The demand of the worst drop; none where no drop has an answer, and of a damage boundary.
    pub demand: Option<f64>,
    /// The bound by energy, which no drop exceeds.
    pub bound: Option<f64>,
    /// The allowed value over the demand, less 1.
    pub margin: Option<f64>,
    /// The verdict on the limit.
    pub verdict: Verdict,
}

impl Member {
    /// Returns whether the product holds: each limit is safe, and the interval of the survival lies above the target, if there is one.
    #[must_use]
    pub fn holds(&self, target: Option<f64>) -> bool {
        match &self.outcome {
            Outcome::Drawn(scatter) => target.is_none_or(|share| scatter.survival.lo >= share),
            Outcome::Searched(limits) => limits.iter().all(|limit| limit.verdict == Verdict::Safe),
        }
    }
}

impl Answer<'_> {
    /// Returns whether all products of the study hold.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.members.iter().all(|member| member.holds(self.target))
    }
}

#[derive(Serialize)]
struct AnswerJson<'a> {
    study: &'static str,
    product: &'a str,
    /// Names of what varies.
    grid: Vec<String>,
    members: Vec<MemberJson<'a>>,
}

#[derive(Serialize)]
struct MemberJson<'a> {
    values: &'a [String],
    #[serde(flatten)]
    outcome: OutcomeJson<'a>,
}

#[derive(Serialize)]
#[serde(untagged)]
enum OutcomeJson<'a> {
    Drawn(Box<scatter::Answer<'a>>),
    Searched { verdict: Verdict, limits: Vec<LimitJson<'a>> },
}

#[derive(Serialize)]
struct LimitJson<'a> {
    component: &'a str,
    limit: &'static str,
    unit: Unit,
    allowed: Option<Json>,
    demand: Option<Json>,
    bound: Option<Json>,
    margin: Option<Json>,
    verdict: Verdict,
}

impl<'a> MemberJson<'a> {
    fn new(member: &'a Member, target: Option<f64>) -> Self {
        let outcome = match &member.outcome {
            Outcome::Drawn(scatter) => {
                let mut answer = scatter::Answer::new(&member.file, (**scatter).clone());
                answer.target = target;
                OutcomeJson::Drawn(Box::new(answer))
            }
            Outcome::Searched(limits) => {
                let limit = |limit: &SearchedLimit| LimitJson {
                    component: &member.file.components[limit.component].name,
                    limit: limit.limit.name(),
                    unit: limit.limit.unit(),
                    allowed: limit.allowed.map(Json),
                    demand: limit.demand.map(Json),
                    bound: limit.bound.map(Json),
                    margin: limit.margin.map(Json),
                    verdict: limit.verdict,
                };
                let verdict = limits.iter().map(|limit| limit.verdict).max().unwrap_or(Verdict::Undecided);
                OutcomeJson::Searched { verdict, limits: limits.iter().map(limit).collect() }
            }
        };
        Self { values: &member.values, outcome }
    }
}

impl Serialize for Answer<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let plan = self.study.plan();
        let product = self.members.first().map_or("", |member| &*member.file.product.name);
        AnswerJson {
            study: if plan.search { "search" } else { "scatter" },
            product,
            grid: plan.grid.iter().map(clatter_product::GridAxis::name).collect(),
            members: self.members.iter().map(|member| MemberJson::new(member, self.target)).collect(),
        }
        .serialize(serializer)
    }
}
