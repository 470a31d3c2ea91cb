//! Limits that no search decides, decided by products that are drawn.

use clatter_product::{Component, Drop, Error, Limit, LimitKind, Model, ProductFile, Reliability};

use crate::assess::{in_unit, laws, model_of, stopped, verdict};
use crate::engine::answer;
use crate::reason::{Doubt, Note};
use crate::scatter::{ByLaw, DrawnLimit, Shown, draw};
use crate::search::{Task, Watch};
use crate::{Assessment, LandingAssessment, LimitAssessment, Verdict, WorstCase};

/// The products are those that [`scatter`](crate::scatter) draws by this seed.
const SEED: u64 = 1;

/// Draws products for the limits that an assessment leaves undecided, until so many in a row hold that it is *reliable*.
///
/// # Method
/// Products and drops are drawn as the file spreads them, ranges evenly, each product through all of its drops, by the model with the most
/// physics. Where none of [`Reliability::samples`] exceeds a limit, it is reliable: were the share of products that survive below R, so
/// many would hold in a row with a probability of 1 − C at most. A drop that exceeds it is a drop of the ranges, and the limit is unsafe. A
/// product of which neither is known, though its drops are followed until they lie, leaves the limit undecided. Where the file names no contact
/// law, each product is drawn by both, and a limit that one of them exceeds stays undecided.
///
/// No product is drawn for a limit that one law is known to exceed while the other holds, nor for the acceleration of a part that hits its stop.
///
/// # Errors
/// [`Error::OtherProduct`], [`Error::OtherDrops`] for the assessment of another product, and those of a product that cannot be drawn.
///
/// # Examples
/// ```
/// use clatter_product::{EXAMPLE, ProductFile, Reliability};
/// let file = ProductFile::read(EXAMPLE, "example.toml")?;
/// let searched = clatter_assess::assess(&file)?;
/// let decided = clatter_assess::reliable(&file, searched.clone(), Reliability::new(0.99, 0.95)?, &|_, _| true)?;
/// assert!(decided == searched, "nothing was undecided");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn reliable(
    file: &ProductFile,
    assessment: Assessment,
    asked: Reliability,
    watch: Watch<'_>,
) -> Result<Assessment, Error> {
    seeded(file, assessment, asked, SEED, watch)
}

fn seeded(
    file: &ProductFile,
    mut assessment: Assessment,
    asked: Reliability,
    seed: u64,
    watch: Watch<'_>,
) -> Result<Assessment, Error> {
    assessment.is_of(file)?;
    let fullest = if file.product.contact_time_s.is_some() { Model::Compliant } else { Model::FiniteTilt };
    let laws = laws(file, fullest);
    let mut limits = Vec::new();
    for (component, (part, assessed)) in file.components.iter().zip(&assessment.components).enumerate() {
        for (number, (limit, found)) in Limit::of(part).into_iter().zip(&assessed.limits).enumerate() {
            let Some(by_law) = by_law(found, laws.len()) else { continue };
            let task = Task { component: part, limit };
            limits.push(DrawnLimit { task, component, number, by_law, drawn: 0, open: 0, error: None });
        }
    }
    if limits.is_empty() {
        return Ok(assessment);
    }
    draw(file, &assessment.accuracy, (seed, asked.samples()), &mut limits, watch)?;
    for drawn in &limits {
        let limit = &mut assessment.components[drawn.component].limits[drawn.number];
        limit.decide(file, drawn, asked);
        limit.hold_to_bound(assessment.accuracy.tolerance);
    }
    for (n, (component, assessed)) in file.components.iter().zip(&mut assessment.components).enumerate() {
        // A part that may still hit its stop has no other limit decided by what was drawn.
        let is_drawn = |k: usize| limits.iter().any(|drawn| (drawn.component, drawn.number) == (n, k));
        let own = assessed.limits.iter_mut().enumerate();
        let own = own.filter(|(k, limit)| is_drawn(*k) || limit.limit == LimitKind::RattleSpace);
        stopped(&mut own.map(|(_, limit)| limit).collect::<Vec<_>>());
        *assessed = verdict(file, component, std::mem::take(&mut assessed.limits));
    }
    for drawn in &limits {
        let limit = &assessment.components[drawn.component].limits[drawn.number];
        rows(&mut assessment.landings, drawn.task.component, limit);
    }
    assessment.verdict = Verdict::of(assessment.components.iter().map(|component| component.verdict));
    Ok(assessment)
}

/// Returns what the search knows of a limit by each law, if products that are drawn may decide it.
fn by_law(limit: &LimitAssessment, laws: usize) -> Option<Vec<ByLaw>> {
    let no_draw_decides =
        |doubt: &Doubt| matches!(doubt, Doubt::Laws(_) | Doubt::Contradiction(_) | Doubt::Stop { hits: true, .. });
    if limit.verdict != Verdict::Undecided || limit.undecided.iter().any(no_draw_decides) {
        return None;
    }
    let share = |demand: Option<f64>| demand.map_or(0.0, |demand| demand / limit.allowed);
    let by_law: Vec<ByLaw> =
        [limit.demand, limit.other_law].map(share).map(ByLaw::known).into_iter().take(laws).collect();
    by_law.iter().any(|law| !law.exceeded).then_some(by_law)
}

impl LimitAssessment {
    /// Takes in what products say of the limit.
    fn decide(&mut self, file: &ProductFile, drawn: &DrawnLimit<'_>, asked: Reliability) {
        let before: Vec<bool> = [self.demand, self.other_law].map(|demand| demand > Some(self.allowed)).into();
        if let Some(shown) = drawn.by_law[0].shown {
            self.show(file, drawn, &shown);
        }
        if let Some(shown) = drawn.by_law.get(1).and_then(|law| law.shown) {
            let asked = shown.answer.utilization() * self.allowed;
            self.other_law = Some(self.other_law.map_or(asked, |most| most.max(asked)));
        }
        self.verdict = drawn.verdict(asked.samples());
        match self.verdict {
            Verdict::Undecided => {
                let is_news = drawn.by_law.iter().zip(before).any(|(law, before)| law.exceeded && !before);
                if is_news {
                    let share = |demand: Option<f64>| demand.map(|demand| demand / self.allowed);
                    let law = file.product.law();
                    self.undecided =
                        vec![Doubt::Laws([(law, share(self.demand)), (law.other(), share(self.other_law))])];
                } else if drawn.by_law.iter().all(|law| !law.exceeded) {
                    let DrawnLimit { drawn, open, error, .. } = drawn;
                    let (drawn, of) = (*drawn, asked.samples());
                    self.undecided.push(Doubt::Drawn { drawn, of, open: *open, error: error.clone() });
                }
            }
            verdict => {
                self.reliability = Some(asked).filter(|_| verdict == Verdict::Reliable);
                (self.undecided, self.governs) = (Vec::new(), None);
            }
        }
    }

    /// Takes a drop of a drawn product for the worst one.
    fn show(&mut self, file: &ProductFile, drawn: &DrawnLimit<'_>, shown: &Shown) {
        let Shown { listed, drop, part, answer: found, model, tolerance } = *shown;
        let most = self.demand.map_or(f64::INFINITY, |demand| demand / self.allowed * (1.0 + self.uncertainty));
        let used = found.utilization();
        self.uncertainty = (most.max(used + found.off_by / found.allowed) / used - 1.0).max(0.0);
        let limit = in_unit(&drawn.task.limit, found.unit);
        let of = |drop: &Drop| answer(drop, &part, &limit, model, tolerance).ok().map(|answer| answer.value);
        self.clatter_free = of(&drop.flattened());
        let by_other = Drop { contact_law: drop.contact_law.other(), ..drop };
        self.other_law = match self.other_law {
            Some(demand) if drawn.by_law.len() > 1 => Some(demand / self.allowed * found.allowed),
            _ if model == Model::Compliant && drop.own_contacts.is_none() => of(&by_other),
            _ => None,
        };
        self.bound = self.bound.filter(|_| found.unit == drawn.task.limit.kind.unit());
        (self.unit, self.allowed) = (found.unit, found.allowed);
        (self.demand, self.margin) = (Some(found.value), Some(found.allowed / found.value - 1.0));
        self.worst_case = Some(WorstCase {
            drop,
            part,
            drawn: true,
            gyration_varies: !file.product.gyration_m.is_value(),
            landing: file.drop_names().get(listed).copied(),
            listed,
            impact: found.impact,
            time_s: found.time_s,
            model,
            tolerance,
        });
        self.notes.retain(|note| !matches!(note, Note::Model { .. }));
        self.model = model_of(file, listed, &drawn.task);
    }
}

/// Takes the result for a limit into those of each of several drops: one that no product exceeded, none exceeded in any drop.
fn rows(landings: &mut [LandingAssessment], component: &Component, limit: &LimitAssessment) {
    let worst = limit.worst_case.filter(|worst| worst.drawn).map(|worst| worst.listed);
    for (listed, landing) in landings.iter_mut().enumerate() {
        let is_own = |name: &str, kind: LimitKind| name == component.name && kind == limit.limit;
        for row in landing.limits.iter_mut().filter(|row| is_own(&row.component, row.limit)) {
            if worst == Some(listed) {
                (row.demand, row.margin) = (limit.demand, limit.margin);
                row.verdict = row.verdict.max(limit.verdict);
            }
            if limit.verdict == Verdict::Reliable && row.verdict == Verdict::Undecided {
                row.verdict = Verdict::Reliable;
            }
        }
        landing.verdict = Verdict::of(landing.limits.iter().map(|row| row.verdict));
    }
}
