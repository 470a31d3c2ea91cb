//! Speed for accuracy, measured: what every pair of models gets wrong in one drop, and what it costs.
//!
//! [`Tradeoff::measure`] runs every pair of rungs (see [`plan`]) on one scene that says something of the
//! quantity, holds it against the highest rung, and times it. [`ProductFile::tradeoff`] does so for every part of a
//! product in its worst drop, [`bars`] gives the four bars of the paper's Table 1 as scenes to compare with.
//!
//! # What the error is against
//! The compliant bar with the exact response to its pulses, followed until rest, each pulse in ten times as many pieces
//! as the models take. Where that cannot be had, because no contact time is known or the compliant model refuses the
//! drop, it is the highest rung there is: finite tilt, with pulses if the contact time is known, else with impulses.
//! [`Reference`] says which, and to what share of the quantity it knows its own value.
//!
//! Errors are the same from run to run; times are of the machine that [`Machine`] names.

mod keep;
mod time;

use std::f64::consts::TAU;

use clatter::End;
use clatter::flight::{Body, Scene};
use clatter::paper::DESIGNS;
use clatter_shock::{DampingRatio, STANDARD_GRAVITY_M_S2, Suspension};
use serde::Serialize;

pub use keep::{Kept, NEGLIGIBLE};
pub use time::Machine;

use crate::plan::{self, Answer, BarRung, ComponentRung, Pair, Quantity, Setup};
use crate::verdict::{letter, number};
use crate::{Assessment, Component, ComponentAssessment, Error, LimitAssessment, LimitKind, ProductFile};

/// The tolerances that plans are asked for.
pub const TOLERANCES: [f64; 3] = [0.1, 0.01, 0.001];

/// Pieces of a pulse in the reference, more than ten times as many as in the models: 400 times as close.
const FINE: usize = 384;
/// Strikes followed at most: bodies that lose next to nothing never rest.
const STRIKES: usize = 2000;
/// What roundings leave open in models without pulses: strike times and responses are good to a few hundred ulps.
const ROUNDING: f64 = 1e-12;

/// Every pair of models on one scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Tradeoff {
    /// What is asked of the component.
    pub quantity: Quantity,
    /// The scene.
    pub scene: Stated,
    /// What all pairs are held against.
    pub reference: Reference,
    /// From the lowest rung of the bar, and of the component.
    pub pairs: Vec<Measured>,
    /// What the plan chooses at each of [`TOLERANCES`].
    pub choices: Vec<Choice>,
    /// How many strikes are worth keeping: of the map, and with gravity and real tilt.
    pub kept: Vec<Kept>,
}

/// A scene as numbers.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Stated {
    /// Distances of the end that touches first and of the other one from the center of mass.
    pub arms_m: [f64; 2],
    /// Radius of gyration.
    pub gyration_m: f64,
    /// Coefficient of restitution.
    pub restitution: f64,
    /// Speed at the first touch.
    pub speed_m_s: f64,
    /// Tilt at the first touch.
    pub tilt_deg: f64,
    /// Gravity after the first touch.
    pub gravity_m_s2: f64,
    /// How long a lone contact takes; null where it is not known.
    pub contact_time_s: Option<f64>,
    /// Where the component is, in [−1, 1]; −1 is the end that touches first.
    pub position: f64,
    /// Its natural frequency; null where the quantity is one of the bar.
    pub frequency_hz: Option<f64>,
    /// Its damping ratio; null likewise.
    pub damping_ratio: Option<f64>,
}

/// What all pairs are held against: an error of 0 by definition.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Reference {
    /// How the bar moves.
    pub bar: BarRung,
    /// How the component answers.
    pub component: ComponentRung,
    /// Why it is not the highest rung; null where it is.
    pub lacks: Option<String>,
    /// The quantity, in m/s², m or m/s.
    pub value: f64,
    /// To what share of itself the value is known, as the numbers of its model go: half as many pieces change it by so
    /// much.
    pub within: f64,
    /// Time of one run.
    pub seconds: f64,
    /// Strikes followed.
    pub strikes: usize,
    /// Whether more would have come: what they do is in no number here.
    pub cut: bool,
    /// Pieces of pulses.
    pub pieces: usize,
}

/// One pair on the scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Measured {
    /// How the bar moves.
    pub bar: BarRung,
    /// How the component answers.
    pub component: ComponentRung,
    /// The quantity, in m/s², m or m/s.
    #[serde(serialize_with = "number")]
    pub value: f64,
    /// |value/reference − 1|.
    #[serde(serialize_with = "number")]
    pub error: f64,
    /// What the plan thinks of it before anything is run; infinite where it has no estimate.
    #[serde(serialize_with = "number")]
    pub estimate: f64,
    /// Time of one run, the median of many.
    pub seconds: f64,
    /// Strikes followed; 0 in closed form.
    pub strikes: usize,
    /// Straight pieces of pulses that the component was driven through; 0 without pulses.
    pub pieces: usize,
    /// Whether no other pair is both cheaper and closer, as far as the reference can tell.
    pub front: bool,
    /// The tolerances at which the plan takes it.
    pub chosen_at: Vec<f64>,
}

/// What the plan chooses.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Choice {
    /// What was asked for.
    pub tolerance: f64,
    /// How the bar moves.
    pub bar: BarRung,
    /// How the component answers.
    pub component: ComponentRung,
    /// What the plan says that it gets wrong.
    #[serde(serialize_with = "number")]
    pub estimate: f64,
    /// What it gets wrong.
    #[serde(serialize_with = "number")]
    pub error: f64,
    /// Time of the choice.
    pub plan_seconds: f64,
    /// Time of running what was chosen.
    pub seconds: f64,
    /// Which groups of the scene decided.
    pub reason: String,
    /// Where the tolerance is not reached, or is reached on a condition.
    pub warning: Option<String>,
}

impl Measured {
    /// Both rungs.
    #[must_use]
    pub fn pair(&self) -> Pair {
        Pair { bar: self.bar, component: self.component }
    }
}

/// The pairs that say something of a quantity. In closed form there is no train to answer to, and a velocity shock of
/// an instant impact is the same whatever the component.
fn pairs(quantity: Quantity) -> impl Iterator<Item = Pair> {
    let says = move |pair: &Pair| match (quantity, pair.bar, pair.component) {
        (Quantity::VelocityShock, _, ComponentRung::LargestShock) => true,
        (Quantity::VelocityShock, _, _) => *pair == Pair::HIGHEST,
        (_, BarRung::ClosedForm, component) => component <= ComponentRung::LargestShock,
        _ => true,
    };
    let all = |bar| ComponentRung::ALL.into_iter().map(move |component| Pair { bar, component });
    BarRung::ALL.into_iter().flat_map(all).filter(says)
}

/// How far a value is off, as a share of the true one.
fn off(value: f64, truth: f64) -> f64 {
    let error = (value / truth - 1.0).abs();
    if error.is_nan() {
        // 0/0: a place that nothing reaches; ∞/∞ says nothing.
        if value.is_finite() { 0.0 } else { f64::INFINITY }
    } else {
        error
    }
}

/// Of points (cost, error): whether no other is cheaper and no farther off, or closer and no dearer.
fn front(points: &[(f64, f64)]) -> Vec<bool> {
    let beats = |a: &(f64, f64), b: &(f64, f64)| a.0 <= b.0 && a.1 <= b.1 && (a.0 < b.0 || a.1 < b.1);
    points.iter().map(|point| !points.iter().any(|other| beats(other, point))).collect()
}

impl Tradeoff {
    /// Runs and times every pair on one scene.
    ///
    /// Each pair is run as a plan would run it, until [`Forecast::until_s`], over and over for a few milliseconds; the
    /// median counts. All of it takes some 0.1 s. No model follows more than 2000 strikes; [`Reference::cut`] says
    /// where more would have come.
    ///
    /// # Errors
    /// As [`Setup::demand`], of scenes that no rung takes.
    ///
    /// # Examples
    /// ```
    /// use clatter_scene::plan::{Pair, Quantity};
    /// use clatter_scene::tradeoff::{Tradeoff, bars};
    /// let [reference, ..] = bars()?;
    /// let trade = Tradeoff::measure(&reference, Quantity::PeakAcceleration)?;
    /// let of = |pair| trade.pairs.iter().find(|p| p.pair() == pair).map(|p| p.error);
    /// assert!(of(Pair::HIGHEST) < Some(1e-3));
    /// # Ok::<(), clatter_scene::Error>(())
    /// ```
    ///
    /// [`Forecast::until_s`]: crate::plan::Forecast::until_s
    pub fn measure(setup: &Setup, quantity: Quantity) -> Result<Self, Error> {
        let scene = setup.scene().with_impact_limit(STRIKES.min(setup.scene().impact_limit()))?;
        let setup = &Setup::new(scene, setup.contact_time_s(), setup.position(), *setup.suspension())?;
        let reference = Reference::measure(setup, quantity)?;
        let compliant = reference.bar == BarRung::Compliant;
        let forecast = setup.forecast(quantity);
        let plan = |tolerance| setup.plan_from(quantity, tolerance, plan::STRIKES);
        let mut choices = Vec::new();
        for tolerance in TOLERANCES {
            let (plan, plan_seconds) = time::measured(|| Ok(plan(tolerance)))?;
            let (value, seconds) = time::measured(|| plan.run(setup))?;
            choices.push(Choice {
                tolerance,
                bar: plan.pair.bar,
                component: plan.pair.component,
                estimate: plan.estimate.error,
                error: off(value, reference.value),
                plan_seconds,
                seconds,
                reason: plan.reason().to_string(),
                warning: plan.warning.map(|warning| warning.to_string()),
            });
        }
        let pulses = setup.contact_time_s().is_some();
        let possible = |pair: &Pair| {
            (compliant || pair.bar < BarRung::Compliant) && (pulses || pair.component < ComponentRung::PulseTrain)
        };
        let mut measured = Vec::new();
        for pair in pairs(quantity).filter(possible) {
            // A net change is that of the whole clatter, whatever decides the quantity.
            let whole = pair.component == ComponentRung::NetChange;
            let until_s = if whole { f64::INFINITY } else { forecast.until_s };
            let (answer, seconds) = time::measured(|| setup.answer(pair, quantity, until_s))?;
            let chose = |choice: &&Choice| choice.bar == pair.bar && choice.component == pair.component;
            measured.push(Measured {
                bar: pair.bar,
                component: pair.component,
                value: answer.value,
                error: off(answer.value, reference.value),
                estimate: forecast.pair(pair).error,
                seconds,
                strikes: answer.strikes,
                pieces: answer.pieces,
                front: false,
                chosen_at: choices.iter().filter(chose).map(|choice| choice.tolerance).collect(),
            });
        }
        let points: Vec<_> = measured.iter().map(|m| (m.seconds, m.error.max(reference.within))).collect();
        for (pair, on) in measured.iter_mut().zip(front(&points)) {
            pair.front = on;
        }
        let kept = [BarRung::Map, BarRung::FiniteTilt].map(|bar| Kept::of(setup, bar, quantity));
        let kept = kept.into_iter().collect::<Result<_, _>>()?;
        Ok(Self { quantity, scene: Stated::of(setup, quantity), reference, pairs: measured, choices, kept })
    }
}

impl Reference {
    fn measure(setup: &Setup, quantity: Quantity) -> Result<Self, Error> {
        let fine = |pair, cells| setup.answer_fine(pair, quantity, f64::INFINITY, cells);
        let run = |pair| {
            let coarse = fine(pair, FINE / 2)?.value;
            let (answer, seconds) = time::once(|| fine(pair, FINE))?;
            Ok((pair, answer, coarse, seconds))
        };
        let mut lacks = None;
        let highest = match run(Pair::HIGHEST) {
            Err(why @ (Error::Bar(_) | Error::Contact)) => {
                let component = match (quantity, setup.contact_time_s()) {
                    (Quantity::VelocityShock, _) => ComponentRung::LargestShock,
                    (_, None) => ComponentRung::ImpulseTrain,
                    (_, Some(_)) => ComponentRung::PulseTrain,
                };
                lacks = Some(why.to_string());
                run(Pair { bar: BarRung::FiniteTilt, component })
            }
            other => other,
        };
        let (Pair { bar, component }, Answer { value, strikes, pieces }, coarse, seconds) = highest?;
        let within = off(coarse, value).max(ROUNDING);
        let cut = strikes >= setup.scene().impact_limit();
        Ok(Self { bar, component, lacks, value, within, seconds, strikes, cut, pieces })
    }
}

impl Stated {
    fn of(setup: &Setup, quantity: Quantity) -> Self {
        let (scene, part) = (setup.scene(), setup.suspension());
        let suspended = quantity != Quantity::VelocityShock;
        Self {
            arms_m: scene.body().arms_m(),
            gyration_m: scene.body().gyration_m(),
            restitution: scene.e(),
            speed_m_s: scene.speed_m_s(),
            tilt_deg: scene.tilt_rad().to_degrees(),
            gravity_m_s2: scene.gravity_m_s2(),
            contact_time_s: setup.contact_time_s(),
            position: setup.position(),
            frequency_hz: suspended.then(|| part.omega() / TAU),
            damping_ratio: suspended.then(|| part.damping().get()),
        }
    }
}

/// A bar with this inertia ratio and restitution as a drop to compare others with: 140 mm long, 4.43 m/s (from 1 m),
/// 5°, standard gravity, contacts of 0.2 ms; a board with a mode at 230 Hz, Q = 10, near the end that strikes second (s
/// = 0.9).
///
/// # Errors
/// [`Error::Bar`] unless q is in (−1, 1] and e in [0, 1].
pub fn bar(q: f64, e: f64) -> Result<Setup, Error> {
    let part = Suspension::from_hz(230.0, DampingRatio::from_quality_factor(10.0)?)?;
    // q = (L² − ρ²)/(L² + ρ²)
    let gyration_m = 0.07 * ((1.0 - q) / (1.0 + q)).sqrt();
    let scene = Scene::new(Body::new(0.14, gyration_m)?, e, 4.43, 5.0, STANDARD_GRAVITY_M_S2)?;
    Setup::new(scene, Some(2e-4), 0.9, part)
}

/// The four bars of the paper's Table 1 ([`DESIGNS`]) as drops, each a [`bar`].
///
/// # Errors
/// None in practice: the numbers are valid.
///
/// # Examples
/// ```
/// let [bar, ..] = clatter_scene::tradeoff::bars()?;
/// // Evenly spread mass has q = 0.5: ρ = 140 mm/√12.
/// assert!((bar.scene().body().gyration_m() - 0.14 / 12.0_f64.sqrt()).abs() < 1e-16);
/// # Ok::<(), clatter_scene::Error>(())
/// ```
pub fn bars() -> Result<[Setup; 4], Error> {
    let [a, b, c, d] = DESIGNS.map(|[q, e]| bar(q, e));
    Ok([a?, b?, c?, d?])
}

/// The trade for all parts of a product.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ProductTradeoff {
    /// Name of the product.
    pub product: String,
    /// Where the times were taken.
    pub machine: Machine,
    /// Part by part, limit by limit, in the order of the assessment.
    pub trades: Vec<PartTradeoff>,
    /// Limits that the models of a plan say nothing of.
    pub left_out: Vec<LeftOut>,
}

/// The trade for one limit of a part, in the drop that is worst for the part's tightest limit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PartTradeoff {
    /// Name of the part.
    pub component: String,
    /// What is limited.
    pub limit: LimitKind,
    /// The end that touches first.
    #[serde(serialize_with = "letter")]
    pub first: End,
    /// Where in the part, from the middle of the product towards end b.
    pub position_m: f64,
    /// The models.
    #[serde(flatten)]
    pub trade: Tradeoff,
}

/// A limit without a trade.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LeftOut {
    /// Name of the part.
    pub component: String,
    /// What is limited.
    pub limit: LimitKind,
    /// Why.
    pub reason: &'static str,
}

impl ProductFile {
    /// What each pair of models gets wrong for each part, and costs.
    ///
    /// A part is dropped as the assessment of this file found worst for its tightest limit; the place in it and its
    /// frequency are those of the worst case of each limit.
    ///
    /// # Errors
    /// As [`Tradeoff::measure`].
    ///
    /// # Examples
    /// ```
    /// use clatter_scene::{EXAMPLE, ProductFile};
    /// let file = ProductFile::read(EXAMPLE, "example.toml")?;
    /// let answer = file.tradeoff(&file.assess()?)?;
    /// assert!(answer.trades.iter().all(|part| part.trade.pairs.iter().any(|pair| pair.front)));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn tradeoff(&self, assessment: &Assessment) -> Result<ProductTradeoff, Error> {
        let (mut trades, mut left_out) = (Vec::new(), Vec::new());
        for (component, assessed) in self.components.iter().zip(&assessment.components) {
            for limit in &assessed.limits {
                let name = component.name.clone();
                match quantity(limit) {
                    Ok(quantity) => {
                        let setup = self.setup(component, assessed, limit)?;
                        trades.push(PartTradeoff {
                            component: name,
                            limit: limit.limit,
                            first: assessed.worst_case.first,
                            position_m: limit.worst_case.position_m,
                            trade: Tradeoff::measure(&setup, quantity)?,
                        });
                    }
                    Err(reason) => left_out.push(LeftOut { component: name, limit: limit.limit, reason }),
                }
            }
        }
        Ok(ProductTradeoff { product: self.product.name.clone(), machine: Machine::here(), trades, left_out })
    }

    /// The worst drop of the part, with the place and the frequency that are worst for the limit.
    fn setup(
        &self,
        component: &Component,
        assessed: &ComponentAssessment,
        limit: &LimitAssessment,
    ) -> Result<Setup, Error> {
        let (worst, at) = (&assessed.worst_case, &limit.worst_case);
        let [a, b] = self.product.body.arms_m();
        let (body, turn) = match worst.first {
            End::A => (self.product.body, 1.0),
            End::B => (Body::off_center(b, a, self.product.body.gyration_m())?, -1.0),
        };
        let scene = Scene::new(body, worst.restitution, worst.speed_m_s, worst.tilt_deg, self.drop.gravity_m_s2)?;
        let part = at.frequency_hz.map(|f| component.mount.suspension(f)).transpose()?.flatten();
        // A velocity shock is the same for any.
        let part = part.map_or_else(|| Suspension::new(1.0, DampingRatio::new(0.0)?), Ok)?;
        let position = (turn * self.product.relative(at.position_m)).clamp(-1.0, 1.0);
        Setup::new(scene, self.product.contact_time_s, position, part)
    }
}

/// What of a plan's quantities a limit is on.
fn quantity(limit: &LimitAssessment) -> Result<Quantity, &'static str> {
    let suspended = limit.worst_case.frequency_hz.is_some();
    match limit.limit {
        LimitKind::Acceleration if suspended => Ok(Quantity::PeakAcceleration),
        LimitKind::RattleSpace => Ok(Quantity::RattleSpace),
        LimitKind::VelocityChange | LimitKind::DamageBoundary => Ok(Quantity::VelocityShock),
        LimitKind::Acceleration => Err("a hard-mounted part has the acceleration of the contact itself"),
        LimitKind::AngularVelocityChange => Err("it is on the turning of the whole product"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_front_is_what_nothing_beats() {
        // cheap and coarse, dear and close, beaten, twice the same, free and infinitely wrong
        let points = [(1.0, 0.5), (8.0, 0.01), (9.0, 0.5), (2.0, 0.1), (2.0, 0.1), (0.5, f64::INFINITY)];
        assert_eq!(front(&points), [true, true, false, true, true, true]);
    }

    #[test]
    fn errors_are_shares_and_never_not_a_number() {
        for (value, truth, error) in [(1.5, 1.0, 0.5), (0.5, 1.0, 0.5), (0.0, 0.0, 0.0), (0.0, 2.0, 1.0)] {
            assert_eq!(off(value, truth).to_bits(), f64::to_bits(error), "{value} for {truth}");
        }
        for (value, truth) in [(1.0, 0.0), (f64::INFINITY, 1.0), (f64::INFINITY, f64::INFINITY), (f64::NAN, 1.0)] {
            assert!(off(value, truth).is_infinite(), "{value} for {truth}");
        }
    }

    #[test]
    fn pairs_are_those_that_say_something() {
        let count = |quantity| pairs(quantity).count();
        // two in closed form, four on each other rung
        assert_eq!(count(Quantity::PeakAcceleration), 18);
        assert_eq!(count(Quantity::RattleSpace), 18);
        // the largest shock on five rungs, and what a contact does within its time
        assert_eq!(count(Quantity::VelocityShock), 6);
        for quantity in [Quantity::PeakAcceleration, Quantity::RattleSpace, Quantity::VelocityShock] {
            assert!(Pair::planned(quantity).iter().all(|planned| pairs(quantity).any(|pair| pair == *planned)));
        }
    }
}
