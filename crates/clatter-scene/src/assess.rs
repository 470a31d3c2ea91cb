//! From a product to its verdict.

use clatter_shock::Peaked;
use rayon::prelude::*;

use crate::base::{Base, SingleDrop};
use crate::demand::{Demand, Heard};
use crate::guaranteed::{self, Asked, Ranges, Trains};
use crate::models::{self, Plan};
use crate::search::{Field, Found, Task};
use crate::{
    Assessment, BarModel, Component, ComponentAssessment, ComponentModel, Error, LimitAssessment, ModelChoice,
    ProductFile, Verdict, WorstCase,
};

/// A demand with its proof or its search.
struct Case {
    demand: f64,
    attained: f64,
    guaranteed: bool,
    tolerance: f64,
    drop: WorstCase,
    model: ModelChoice,
}

impl ProductFile {
    /// The worst case of every component over all stated ranges, and whether it stands it.
    ///
    /// # Method
    /// Without gravity, at small tilt and for velocity shocks, the demand is proven: bounds over the ranges leave no drop out, and
    /// lie at most 0.5 % above what the stated drop attains (where more work than is set aside would be needed, `tolerance` says
    /// how much). Where gravity, real tilt or contact that takes time count (see [`ModelChoice::reason`]), the model with them is
    /// searched over the ranges: 17 tilts, 2 speeds, 3 restitutions, 3 frequencies and both ends, then three times at half the
    /// step around the worst; the larger of both demands counts. For a part that is so stiff that a pulse is no velocity
    /// shock, the search alone counts.
    ///
    /// # Errors
    /// [`Error::ContactTime`] for a stiff or hard-mounted part of a product without contact time; [`Error::Bar`] and
    /// [`Error::Shock`] for values that the models do not take.
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
        let plans: Vec<_> = self.components.iter().map(|c| models::plan(&self.product, &self.drop, c)).collect();
        let demands: Vec<_> = self.components.iter().map(Demand::of).collect();
        for component in &self.components {
            if let Some(reason) = models::lacks_contact_time(&self.product, component) {
                return Err(Error::ContactTime { component: component.name.clone(), reason });
            }
        }
        let each = || self.components.iter().zip(&plans).zip(&demands);
        let mut tasks = Vec::new();
        for ((component, plan), demands) in each() {
            if let Some(model) = plan.searched {
                let pulses = plan.component == ComponentModel::PulseTrain;
                tasks.extend(demands.iter().map(|&demand| Task { component, demand, model, pulses }));
            }
        }
        let field = Field { product: &self.product, drop: &self.drop };
        let search = || field.worst(&tasks);
        let (found, proven) = rayon::join(search, || self.prove_all(&plans, &demands));
        let mut found = found?.into_iter();
        let mut components = Vec::with_capacity(self.components.len());
        for (((component, plan), demands), proven) in each().zip(proven?) {
            let mut limits = Vec::with_capacity(demands.len());
            for (demand, proven) in demands.iter().zip(proven) {
                let searched = if plan.searched.is_some() { found.next() } else { None };
                limits.push(self.limit(demand, plan, proven, searched.as_ref()));
            }
            components.push(verdict(component, limits));
        }
        let safe = components.iter().all(|c| c.verdict == Verdict::Safe);
        Ok(Assessment { product: self.product.name.clone(), verdict: Verdict::of(safe), components })
    }

    /// The demands of all limits without gravity, at small tilt and for velocity shocks: what no drop of the ranges passes, component
    /// by component in the order of [`ComponentAssessment::limits`]; `None` where that model says nothing of the limit.
    ///
    /// # Errors
    /// As [`ProductFile::assess`].
    pub fn prove(&self) -> Result<Vec<Vec<Option<f64>>>, Error> {
        let plans: Vec<_> = self.components.iter().map(|c| models::plan(&self.product, &self.drop, c)).collect();
        let demands: Vec<_> = self.components.iter().map(Demand::of).collect();
        let proven = self.prove_all(&plans, &demands)?;
        Ok(proven
            .iter()
            .map(|limits| limits.iter().map(|case| case.as_ref().map(|case| case.demand)).collect())
            .collect())
    }

    fn prove_all(&self, plans: &[Plan], demands: &[Vec<Demand>]) -> Result<Vec<Vec<Option<Case>>>, Error> {
        let all: Vec<_> = self.components.iter().zip(plans).zip(demands).collect();
        all.into_par_iter()
            .map_init(
                || Trains::new(&self.product),
                |trains, ((component, plan), demands)| {
                    demands.iter().map(|demand| self.prove_one(trains, component, plan, demand)).collect()
                },
            )
            .collect()
    }

    /// The gravity-free demand, where it says something of the limit.
    fn prove_one(
        &self,
        trains: &mut Trains,
        component: &Component,
        plan: &Plan,
        demand: &Demand,
    ) -> Result<Option<Case>, Error> {
        let Some(asked) = demand.asked().filter(|asked| plan.shocks || matches!(asked, Asked::Shock)) else {
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
        let reached = demand.reached(&base, &at, frequency_hz.unwrap_or(0.0), &mut Heard::new(false))?;
        let component_model =
            if matches!(asked, Asked::Shock) { ComponentModel::LargestShock } else { ComponentModel::ImpulseTrain };
        let quantity = match asked {
            Asked::Response(_, Peaked::AccelerationOverOmega | Peaked::PseudoVelocity) => "the response",
            Asked::Shock => "every shock",
        };
        Ok(Some(Case {
            demand: worst.demand.max(reached.value),
            attained: reached.value,
            guaranteed: true,
            tolerance: (worst.demand / reached.value - 1.0).max(0.0),
            drop: case(&drop, &reached),
            model: ModelChoice {
                bar: BarModel::Map,
                component: component_model,
                reason: format!("{quantity} is bounded over all ranges; {}", plan.reason),
            },
        }))
    }

    fn limit(&self, demand: &Demand, plan: &Plan, proven: Option<Case>, searched: Option<&Found>) -> LimitAssessment {
        let by_search = searched.map(|found| Case {
            demand: found.reached.value,
            attained: found.reached.value,
            guaranteed: false,
            tolerance: found.raised,
            drop: case(&found.drop, &found.reached),
            model: ModelChoice {
                bar: plan.searched.unwrap_or(BarModel::Map),
                component: match demand.asked() {
                    Some(Asked::Shock) => ComponentModel::LargestShock,
                    Some(Asked::Response(..)) => plan.component,
                    None => ComponentModel::Base,
                },
                reason: plan.reason.clone(),
            },
        });
        let bound = proven.as_ref().map(|case| case.demand);
        let case = match (proven, by_search) {
            (Some(proven), Some(search)) => {
                if search.demand > proven.demand {
                    search
                } else {
                    proven
                }
            }
            (Some(only), None) | (None, Some(only)) => only,
            (None, None) => unreachable!("what is not proven is searched"),
        };
        let contact_time_s = self.product.contact_time_s;
        let settled = demand.settle(case.demand, contact_time_s);
        let (asked, attained) = (settled.factor * case.demand, settled.factor * case.attained);
        let [_, fastest] = self.drop.speeds_m_s();
        let clatter_free = demand.clatter_free(fastest, self.product.restitution.hi(), contact_time_s);
        LimitAssessment {
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
        }
    }
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
