//! From a product to its verdict.

use clatter_shock::Peaked;
use rayon::prelude::*;

use crate::base::{Base, SingleDrop};
use crate::demand::Demand;
use crate::guaranteed::{self, Asked, Ranges, Trains};
use crate::models;
use crate::plan::{ComponentRung, Pair, Share, Warning};
use crate::search::{self, Field, Found, Task};
use crate::{
    Accuracy, Assessment, BarModel, Component, ComponentAssessment, ComponentModel, Error, LimitAssessment,
    ModelChoice, ProductFile, Verdict, WorstCase,
};

/// A demand with its proof or its search.
struct Case {
    demand: f64,
    attained: f64,
    guaranteed: bool,
    tolerance: f64,
    drop: WorstCase,
    model: ModelChoice,
    warning: Option<String>,
}

impl ProductFile {
    /// The worst case of every component over all stated ranges, and whether it stands it:
    /// [`assess_to`](Self::assess_to) 1 %.
    ///
    /// # Errors
    /// As [`assess_to`](Self::assess_to).
    ///
    /// # Examples
    /// ```
    /// use clatter_scene::{EXAMPLE, ProductFile};
    /// let assessment = ProductFile::read(EXAMPLE, "example.toml")?.assess()?;
    /// for component in &assessment.components {
    ///     assert!(component.limits.iter().all(|limit| limit.attained <= limit.demand));
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn assess(&self) -> Result<Assessment, Error> {
        self.assess_to(&Accuracy::default())
    }

    /// The same to an accuracy asked.
    ///
    /// # Method
    /// Without gravity, at small tilt and for velocity shocks, the demand is proven: bounds over the ranges leave no
    /// drop out, and lie at most 0.5 % above what the stated drop attains (where the work limit is reached, `tolerance`
    /// says how much). Where gravity, real tilt or contact that takes time count, the ranges are searched: 17 tilts, 2
    /// speeds, 3 restitutions, 3 frequencies, both ends of the part and either end first. At each of these places a
    /// forecast tells the cheapest models within the tolerance ([`plan`](crate::plan)) and the most that they may give;
    /// places are followed from the highest, until none that is left may pass the worst found. Around that the step is
    /// halved three times, and up to three times more while that gains more than half the tolerance; forecasts climb
    /// from up to 4 other high places of the grid; where rebounds may decide, 41 even tilts are searched as well. The
    /// larger of both demands counts. For a part that is so stiff that a pulse is no velocity shock, the search alone
    /// counts. What a body does that has bounced clear is sensitive to every value: where the energy it has left does
    /// not rule out that it asks for more, a warning says so.
    ///
    /// With a model named, every place of the grid is followed by it, with the cheapest way of the components to answer
    /// that is within the tolerance; the proof still stands beside it. A warning says how far off it may be in the drop
    /// that it finds worst; in others it may be further off.
    ///
    /// # Errors
    /// [`Error::Tolerance`] for a tolerance outside [1e-4, 0.5]; [`Error::ContactTime`] for a stiff or hard-mounted
    /// part of a product without contact time, [`Error::Contact`] for the compliant model of one; [`Error::Bar`] and
    /// [`Error::Shock`] for values that the models do not take.
    pub fn assess_to(&self, accuracy: &Accuracy) -> Result<Assessment, Error> {
        accuracy.check()?;
        if accuracy.model == Some(BarModel::Compliant) && self.product.contact_time_s.is_none() {
            return Err(Error::Contact);
        }
        for component in &self.components {
            if let Some(reason) = models::lacks_contact_time(&self.product, component) {
                return Err(Error::ContactTime { component: component.name.clone(), reason });
            }
        }
        self.assess_in(&Field::new(&self.product, &self.drop, &self.components, *accuracy))
    }

    /// The same where drops of the product may have been followed before.
    pub(crate) fn assess_in(&self, field: &Field<'_>) -> Result<Assessment, Error> {
        let demands: Vec<_> = self.components.iter().map(Demand::of).collect();
        let proven = self.prove_all(&demands)?;
        let each = || self.components.iter().zip(&demands);
        let task = |(component, (&demand, proven)): (_, (_, &Option<Case>))| Task {
            component,
            demand,
            proven: proven.as_ref().map(|case| case.demand),
        };
        let of_one = |((component, demands), proven)| std::iter::repeat(component).zip(std::iter::zip(demands, proven));
        let tasks: Vec<_> = each().zip(&proven).flat_map(of_one).map(task).collect();
        let found = field.worst(&tasks)?;
        let mut found = tasks.iter().zip(found);
        let mut components = Vec::with_capacity(self.components.len());
        for ((component, demands), proven) in each().zip(proven) {
            let mut limits = Vec::with_capacity(demands.len());
            for (demand, proven) in demands.iter().zip(proven) {
                let Some((task, found)) = found.next() else { unreachable!("a task for each demand") };
                limits.push(self.limit(field, task, proven, found.as_ref(), demand)?);
            }
            components.push(verdict(component, limits));
        }
        let safe = components.iter().all(|c| c.verdict == Verdict::Safe);
        let (product, verdict) = (self.product.name.clone(), Verdict::of(safe));
        Ok(Assessment { product, verdict, components, accuracy: field.accuracy })
    }

    /// The demands of all limits without gravity, at small tilt and for velocity shocks: what no drop of the ranges
    /// passes, component by component in the order of [`ComponentAssessment::limits`]; `None` where that model says
    /// nothing of the limit.
    ///
    /// # Errors
    /// As [`ProductFile::assess`].
    pub fn prove(&self) -> Result<Vec<Vec<Option<f64>>>, Error> {
        let demands: Vec<_> = self.components.iter().map(Demand::of).collect();
        let proven = self.prove_all(&demands)?;
        Ok(proven
            .iter()
            .map(|limits| limits.iter().map(|case| case.as_ref().map(|case| case.demand)).collect())
            .collect())
    }

    fn prove_all(&self, demands: &[Vec<Demand>]) -> Result<Vec<Vec<Option<Case>>>, Error> {
        let all: Vec<_> = self.components.iter().zip(demands).collect();
        all.into_par_iter()
            .map_init(
                || Trains::new(&self.product),
                |trains, (component, demands)| {
                    demands.iter().map(|demand| self.prove_one(trains, component, demand)).collect()
                },
            )
            .collect()
    }

    /// The gravity-free demand, where it says something of the limit.
    fn prove_one(&self, trains: &mut Trains, component: &Component, demand: &Demand) -> Result<Option<Case>, Error> {
        let shocks = models::feels_shocks(&self.product, component);
        let Some(asked) = demand.asked().filter(|asked| shocks || matches!(asked, Asked::Shock)) else {
            return Ok(None);
        };
        let mut ranges = Ranges::new(&self.product, &self.drop);
        let omega = std::f64::consts::TAU;
        ranges.omega = demand.frequencies().map_or([0.0; 2], |f| [omega * f.lo(), omega * f.hi()]);
        let variants = demand.variants(trains, &self.product, &self.drop, component);
        let worst = guaranteed::worst(trains, asked, &variants, &ranges);
        let sine = (worst.gap / self.product.body.length_m()).clamp(0.0, 1.0);
        let drop = SingleDrop {
            first: worst.variant.first,
            tilt_rad: sine.asin().clamp(self.drop.tilt_rad.lo(), self.drop.tilt_rad.hi()),
            speed_m_s: worst.speed,
            restitution: worst.restitution,
            gravity_m_s2: 0.0,
        };
        let frequency_hz = demand.frequencies().map(|f| (worst.omega / omega).clamp(f.lo(), f.hi()));
        let base = Base::new(&self.product, &drop, BarModel::Map)?;
        let at = Component { position_m: worst.variant.position_m, extent_m: 0.0, ..component.clone() };
        let reached = demand.reached(&base, &at, frequency_hz.unwrap_or(0.0))?;
        let component_model =
            if matches!(asked, Asked::Shock) { ComponentModel::LargestShock } else { ComponentModel::ImpulseTrain };
        let quantity = match asked {
            Asked::Response(_, Peaked::AccelerationOverOmega | Peaked::PseudoVelocity) => "the response",
            Asked::Shock => "every shock",
        };
        // What was reached lacks the strikes that are weak at the end, which a part without damping adds up.
        let attained = worst.attained.max(reached.value);
        Ok(Some(Case {
            demand: worst.demand.max(reached.value),
            attained,
            guaranteed: true,
            tolerance: (worst.demand / attained - 1.0).max(0.0),
            drop: case(&drop, &reached),
            model: ModelChoice {
                bar: BarModel::Map,
                component: component_model,
                reason: format!("{quantity} is bounded over all ranges"),
            },
            warning: None,
        }))
    }

    fn limit(
        &self,
        field: &Field<'_>,
        task: &Task<'_>,
        proven: Option<Case>,
        found: Option<&Found>,
        demand: &Demand,
    ) -> Result<LimitAssessment, Error> {
        let bound = proven.as_ref().map(|case| case.demand);
        let case = match (proven, found) {
            (Some(proven), Some(found)) if found.reached.value <= proven.demand => {
                beside_proof(field, task, proven, found.rebounds)?
            }
            (Some(proven), None) => beside_proof(field, task, proven, false)?,
            (_, Some(found)) => searched(field, task, found)?,
            (None, None) => unreachable!("what is not proven is searched"),
        };
        let contact_time_s = self.product.contact_time_s;
        let settled = demand.settle(case.demand, contact_time_s);
        let (asked, attained) = (settled.factor * case.demand, settled.factor * case.attained);
        let [_, fastest] = self.drop.speeds_m_s();
        let clatter_free = demand.clatter_free(fastest, self.product.restitution.hi(), contact_time_s)?;
        Ok(LimitAssessment {
            limit: demand.kind,
            unit: settled.unit,
            allowed: settled.allowed,
            demand: asked,
            attained,
            margin: settled.allowed / asked - 1.0,
            clatter_free: settled.factor * clatter_free,
            proven: bound.map(|bound| settled.factor * bound),
            guaranteed: case.guaranteed,
            tolerance: case.tolerance,
            worst_case: case.drop,
            model: case.model,
            warning: case.warning,
        })
    }
}

/// What the search found, with its reasons.
fn searched(field: &Field<'_>, task: &Task<'_>, found: &Found) -> Result<Case, Error> {
    let plan = field.plan(task, &found.place)?;
    let component = match (task.demand.asked(), found.pair.component) {
        (Some(Asked::Shock), _) => ComponentModel::LargestShock,
        (None, _) => ComponentModel::Base,
        (_, ComponentRung::PulseTrain) => ComponentModel::PulseTrain,
        _ => ComponentModel::ImpulseTrain,
    };
    // A share of the truth, as one of the demand.
    let passed = |error: f64| if error < 1.0 { error / (1.0 - error) } else { f64::INFINITY };
    let (reason, warning, error) = match (field.accuracy.model, plan) {
        (Some(model), plan) => {
            let error = match plan {
                Some(plan) => plan.forecast.pair(found.pair).error,
                None => field.error_of(model, task, &found.place)?,
            };
            (format!("{} was asked for", model.name()), off(model, error, field), passed(error))
        }
        (None, Some(plan)) => {
            let error = passed(plan.forecast.pair(found.pair).error).max(field.accuracy.tolerance);
            (plan.reason().to_string(), plan.warning.map(|w| w.to_string()), error)
        }
        (None, None) => {
            let (pair, is_within) = field.planned_of_shocks(task, &found.place)?;
            let why = if pair == Pair::HIGHEST || !is_within {
                "contacts overlap, or come too close to tell them apart"
            } else {
                "contacts follow one another without overlap"
            };
            let error = if is_within { field.accuracy.tolerance } else { f64::INFINITY };
            (why.to_owned(), not_taken(is_within), error)
        }
    };
    let rebound = if found.reached.time_s > field.clear_s(&found.drop) {
        Some(sensitive("the worst comes after a rebound"))
    } else {
        may_rebound(found.rebounds)
    };
    let warning = both(warning, rebound);
    Ok(Case {
        demand: found.reached.value,
        attained: found.reached.value,
        guaranteed: false,
        tolerance: found.raised + error,
        drop: case(&found.drop, &found.reached),
        model: ModelChoice { bar: search::bar_model(found.pair), component, reason },
        warning,
    })
}

/// What is to be said where rebounds are not ruled out.
fn may_rebound(rebounds: bool) -> Option<String> {
    rebounds.then(|| sensitive("rebounds are not ruled out"))
}

/// What is known of rebounds, and what they leave open.
fn sensitive(what: &str) -> String {
    format!("{what}, whose timing is sensitive to every input: drops between those searched may ask for more")
}

/// Two warnings as one.
fn both(one: Option<String>, other: Option<String>) -> Option<String> {
    match (one, other) {
        (Some(one), Some(other)) => Some(format!("{one}; {other}")),
        (one, other) => one.or(other),
    }
}

/// What is to be said of a model that was named where it is off by more than the tolerance.
fn off(model: BarModel, error: f64, field: &Field<'_>) -> Option<String> {
    let is_off = error > field.accuracy.of_truth();
    is_off.then(|| format!("{} was asked for, and may be {}", model.name(), Share(error)))
}

/// What is to be said where contacts overlap and their model does not take the drop.
fn not_taken(is_within: bool) -> Option<String> {
    let warning = Warning::ToleranceNotReached { error: f64::INFINITY, overlaps: true };
    (!is_within).then(|| warning.to_string())
}

/// A proof, with what more physics would say of its worst drop, and whether `rebounds` may ask for more.
fn beside_proof(field: &Field<'_>, task: &Task<'_>, proven: Case, rebounds: bool) -> Result<Case, Error> {
    let place = field.place_of(&proven.drop, task.demand.frequencies());
    let (more, warning) = match (field.accuracy.model, field.plan(task, &place)?) {
        (Some(model), _) => {
            let warning = off(model, field.error_of(model, task, &place)?, field);
            (Some(format!("{} was asked for", model.name())).filter(|_| model != BarModel::Map), warning)
        }
        (None, Some(plan)) => {
            let is_map = search::bar_model(plan.pair) == BarModel::Map;
            let more = if is_map { "" } else { ", but no drop with it asks for more" };
            (Some(format!("{}{more}", plan.reason())), plan.warning.map(|warning| warning.to_string()))
        }
        (None, None) => (None, not_taken(field.planned_of_shocks(task, &place)?.1)),
    };
    let reason = std::iter::once(proven.model.reason).chain(more).collect::<Vec<_>>().join("; ");
    let warning = both(warning, may_rebound(rebounds));
    Ok(Case { model: ModelChoice { reason, ..proven.model }, warning, ..proven })
}

fn case(drop: &SingleDrop, reached: &crate::demand::Reached) -> WorstCase {
    WorstCase {
        first: drop.first,
        tilt_deg: drop.tilt_rad.to_degrees(),
        speed_m_s: drop.speed_m_s,
        restitution: drop.restitution,
        frequency_hz: reached.frequency_hz,
        position_m: reached.position_m,
        impact: reached.strike as u64 + 1,
        time_s: reached.time_s,
    }
}

fn verdict(component: &Component, limits: Vec<LimitAssessment>) -> ComponentAssessment {
    let safe = limits.iter().all(LimitAssessment::is_safe);
    let tightest = limits.iter().min_by(|a, b| a.margin.total_cmp(&b.margin));
    let Some(tightest) = tightest else { unreachable!("a component has a limit") };
    let (worst_case, model) = (tightest.worst_case, tightest.model.clone());
    ComponentAssessment {
        name: component.name.clone(),
        position_m: component.position_m,
        verdict: Verdict::of(safe),
        limits,
        worst_case,
        model,
    }
}
