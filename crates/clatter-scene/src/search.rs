//! The worst case by a search of stated resolution, for the models that have no bounds.
//!
//! A grid over tilt, speed, restitution, frequency, place and the end that strikes first is foreseen
//! ([`Setup::forecast`], a microsecond a place). Places are then followed in order of the most that they may reach,
//! each by the cheapest pair of models within the tolerance, until no place that is left may pass the worst found.
//! Around it the step is halved until that raises the demand by little. All components share the flights of one grid.

use std::cmp::Ordering as Order;
use std::collections::{BTreeMap, BinaryHeap, HashMap};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use clatter::End;
use clatter::flight::Scene;
use clatter_shock::{DampingRatio, Suspension};
use rayon::prelude::*;

use crate::base::{self, Base, Cells, MOST_CONTACTS, SingleDrop};
use crate::demand::{Demand, Reached};
use crate::plan::demand::{crowding, fineness, pieces_for};
use crate::plan::pulse::Pulse;
use crate::plan::trail::Trail;
use crate::plan::{BarRung, ComponentRung, Pair, Plan, Quantity, Setup};
use crate::{
    Accuracy, BarModel, Component, ComponentModel, Drop, Error, LimitKind, ModelChoice, Mount, Product, Spread,
    WorstCase,
};

/// Steps along the tilt; even in its square root, because contacts overlap at small tilts and gaps grow from there.
const TILTS: u32 = 16;
/// Steps along restitution and frequency.
const STEPS: u32 = 2;
/// How often the step is halved around the worst drop, at least and at most.
const HALVINGS: [u32; 2] = [3, 6];
/// Other places of the grid from which a worse drop is looked for.
const BASINS: usize = 4;
/// Steps of the tilt at which drops are looked at besides where a rebound may decide, and how often at most; pages draw
/// them.
pub(crate) const EVEN_TILTS: u32 = 40;
const SCANS: u32 = 3;
/// Contacts followed at first.
const CONTACTS: usize = 10;

/// The worst drop of the search.
#[derive(Debug, Clone)]
pub(crate) struct Found {
    pub(crate) reached: Reached,
    pub(crate) drop: SingleDrop,
    pub(crate) place: Place,
    pub(crate) pair: Pair,
    /// By which share the last refinement raised the demand.
    pub(crate) raised: f64,
    /// Whether a rebound decides, or may in a drop that came close enough to be followed.
    pub(crate) rebounds: bool,
}

/// One demand to be searched for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Task<'a> {
    pub(crate) component: &'a Component,
    pub(crate) demand: Demand,
    /// What no drop passes without gravity, at small tilt and for instant impacts, where that is proven.
    pub(crate) proven: Option<f64>,
}

/// The product and the ranges of its drop, and the drops as far as they were followed: they are the same for all parts.
pub(crate) struct Field<'a> {
    pub(crate) product: &'a Product,
    pub(crate) drop: &'a Drop,
    pub(crate) accuracy: Accuracy,
    cells: Cells,
    grid: OnceLock<Result<Grid, Error>>,
    beside: Beside,
}

/// Where in its range each quantity is, from 0 to 1, and where in the component.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Place {
    pub(crate) first: End,
    /// Of the square root of the tilt, speed, restitution and frequency.
    pub(crate) shares: [f64; 4],
    pub(crate) position_m: f64,
}

/// A drop, and its flights as far as they were followed.
struct Slot {
    number: usize,
    drop: SingleDrop,
    scene: Scene,
    trail: OnceLock<Trail>,
    strikes: [OnceLock<Result<Base, Error>>; 3],
    /// The first of them, and all.
    contacts: [OnceLock<Result<Base, Error>>; 2],
}

/// Drops of the grid.
type Grid = Vec<(Place, Arc<Slot>)>;
/// Drops beside the grid: first end and shares of tilt, speed and restitution.
type Beside = Mutex<HashMap<(bool, [u64; 3]), Arc<Slot>>>;

/// A place as it is foreseen.
#[derive(Clone)]
struct Candidate {
    place: Place,
    slot: Arc<Slot>,
    pair: Pair,
    /// Whether the pair is within the tolerance.
    within: bool,
    /// What it reaches, about, and at most.
    about: f64,
    at_most: f64,
    /// Later strikes do not count.
    until_s: f64,
}

/// A place as its drop, position and frequency.
type Key = (usize, u64, u64);
/// What places reach at most, as far as they were looked at.
type Known = HashMap<Key, f64>;

fn shares(steps: u32, fixed: bool) -> impl Iterator<Item = f64> + Clone {
    let steps = if fixed { 0 } else { steps };
    (0..=steps).map(move |i| if steps == 0 { 0.0 } else { f64::from(i) / f64::from(steps) })
}

/// The pair behind a demand.
pub(crate) fn pair_of(model: &ModelChoice) -> Pair {
    let pulses = model.component == ComponentModel::PulseTrain;
    let component = if pulses { ComponentRung::PulseTrain } else { ComponentRung::ImpulseTrain };
    Pair { bar: rung_of(model.bar), component }
}

/// The rung of a model.
fn rung_of(model: BarModel) -> BarRung {
    match model {
        BarModel::Map => BarRung::Map,
        BarModel::Ballistic => BarRung::Ballistic,
        BarModel::FiniteTilt => BarRung::FiniteTilt,
        BarModel::Compliant => BarRung::Compliant,
    }
}

/// How the bar moves; sums of the closed form are taken strike by strike where flights are shared.
pub(crate) fn bar_model(pair: Pair) -> BarModel {
    match pair.bar {
        BarRung::ClosedForm | BarRung::Map => BarModel::Map,
        BarRung::Ballistic => BarModel::Ballistic,
        BarRung::FiniteTilt => BarModel::FiniteTilt,
        BarRung::Compliant => BarModel::Compliant,
    }
}

impl<'a> Field<'a> {
    pub(crate) fn new(product: &'a Product, drop: &'a Drop, components: &[Component], accuracy: Accuracy) -> Self {
        let contact = product.contact_time_s.unwrap_or(0.0);
        let finest = components.iter().filter_map(|c| match c.mount {
            Mount::Suspended { frequency_hz, .. } => c.mount.suspension(frequency_hz.hi()).ok().flatten(),
            Mount::Hard => None,
        });
        let finest: Vec<_> = finest.map(|part| (fineness(&part, contact), crowding(&product.body, &part))).collect();
        let crowded = finest.iter().fold(1.0, |m: f64, f| m.max(f.1));
        let finest = finest.iter().fold(0.5, |m: f64, f| m.max(f.0));
        let most = crowded * finest * pieces_for(accuracy.tolerance);
        let cells = Cells { most, fineness: finest };
        Self { product, drop, accuracy, cells, grid: OnceLock::new(), beside: Beside::default() }
    }

    fn single(&self, place: &Place) -> SingleDrop {
        let [slow, fast] = self.drop.speeds_m_s();
        let [lo, hi] = [self.drop.tilt_rad.lo().sqrt(), self.drop.tilt_rad.hi().sqrt()];
        let [tilt, speed, restitution, _] = place.shares;
        let root = lo + tilt * (hi - lo);
        SingleDrop {
            first: place.first,
            tilt_rad: (root * root).clamp(self.drop.tilt_rad.lo(), self.drop.tilt_rad.hi()),
            speed_m_s: (slow + speed * (fast - slow)).clamp(slow, fast),
            restitution: self.product.restitution.at(restitution),
            gravity_m_s2: self.drop.gravity_m_s2,
        }
    }

    /// Where in the ranges a drop is.
    pub(crate) fn place_of(&self, worst: &WorstCase, frequencies: Option<Spread>) -> Place {
        let share = |[lo, hi]: [f64; 2], x: f64| if hi > lo { ((x - lo) / (hi - lo)).clamp(0.0, 1.0) } else { 0.0 };
        let of = |spread: &Spread, x: f64| share([spread.lo(), spread.hi()], x);
        let tilt = [self.drop.tilt_rad.lo(), self.drop.tilt_rad.hi()].map(f64::sqrt);
        let frequency = frequencies.zip(worst.frequency_hz).map_or(0.0, |(spread, f)| of(&spread, f));
        let shares = [
            share(tilt, worst.tilt_deg.to_radians().sqrt()),
            share(self.drop.speeds_m_s(), worst.speed_m_s),
            of(&self.product.restitution, worst.restitution),
            frequency,
        ];
        Place { first: worst.first, shares, position_m: worst.position_m }
    }

    /// Which of tilt, speed, restitution and frequency have a range.
    fn free(&self, demand: &Demand) -> [bool; 4] {
        let [slow, fast] = self.drop.speeds_m_s();
        [
            !self.drop.tilt_rad.is_value(),
            slow < fast,
            !self.product.restitution.is_value(),
            demand.frequencies().is_some_and(|f| !f.is_value()),
        ]
    }

    /// Places at one tilt: at the values of a worst place, and at the ends of their ranges, from the highest.
    pub(crate) fn at_tilt(&self, task: &Task<'_>, worst: &Place, first: End, tilt_rad: f64) -> Vec<Place> {
        let [lo, hi] = [self.drop.tilt_rad.lo().sqrt(), self.drop.tilt_rad.hi().sqrt()];
        let tilt = if hi > lo { ((tilt_rad.sqrt() - lo) / (hi - lo)).clamp(0.0, 1.0) } else { 0.0 };
        let free = self.free(&task.demand);
        let shares = |axis: usize| {
            let own = worst.shares[axis];
            let ends = [1.0, 0.0].into_iter().filter(move |end| free[axis] && (end - own).abs() > 0.0);
            std::iter::once(own).chain(ends)
        };
        let mut places = Vec::new();
        for speed in shares(1) {
            for restitution in shares(2) {
                for frequency in shares(3) {
                    for position_m in task.component.ends_m() {
                        places.push(Place { first, shares: [tilt, speed, restitution, frequency], position_m });
                    }
                }
            }
        }
        places
    }

    /// Of a symmetric product one end first is the other one turned around.
    fn turns(&self) -> bool {
        let [a, b] = self.product.body.arms_m();
        a.to_bits() == b.to_bits() && self.drop.first_ends().len() > 1
    }

    /// The place of the same drop with the end first that is followed, and where it then is.
    fn followed(&self, place: &Place) -> (End, f64) {
        if self.turns() && place.first != self.drop.first_ends()[0] {
            (place.first.other(), -place.position_m)
        } else {
            (place.first, place.position_m)
        }
    }

    /// The drop of a place.
    fn slot(&self, place: &Place) -> Result<Slot, Error> {
        static NUMBER: AtomicUsize = AtomicUsize::new(0);
        let (first, position_m) = self.followed(place);
        let drop = self.single(&Place { first, position_m, ..*place });
        let scene = base::scene(self.product, &drop)?;
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let (strikes, contacts) = Default::default();
        Ok(Slot { number, drop, scene, trail: OnceLock::new(), strikes, contacts })
    }

    /// A drop beside the grid.
    fn slot_beside(&self, place: &Place) -> Result<Arc<Slot>, Error> {
        let (first, _) = self.followed(place);
        let [tilt, speed, restitution, _] = place.shares.map(f64::to_bits);
        let key = (first == End::B, [tilt, speed, restitution]);
        let known = self.beside.lock().unwrap_or_else(PoisonError::into_inner).get(&key).map(Arc::clone);
        if let Some(slot) = known {
            return Ok(slot);
        }
        let slot = Arc::new(self.slot(place)?);
        let mut beside = self.beside.lock().unwrap_or_else(PoisonError::into_inner);
        Ok(Arc::clone(beside.entry(key).or_insert(slot)))
    }

    /// The drops of the grid.
    fn slots(&self) -> Result<&[(Place, Arc<Slot>)], Error> {
        self.grid.get_or_init(|| self.sow()).as_deref().map_err(Clone::clone)
    }

    fn sow(&self) -> Result<Grid, Error> {
        let [slow, fast] = self.drop.speeds_m_s();
        let mut slots = Vec::new();
        for &first in if self.turns() { &self.drop.first_ends()[..1] } else { self.drop.first_ends() } {
            for tilt in shares(TILTS, self.drop.tilt_rad.is_value()) {
                for speed in shares(1, slow >= fast) {
                    for restitution in shares(STEPS, self.product.restitution.is_value()) {
                        let shares = [tilt, speed, restitution, 0.0];
                        let place = Place { first, shares, position_m: 0.0 };
                        let slot = self.slot(&place)?;
                        // At the same h0/v0 a faster drop does more in proportion, gravity and geometry aside.
                        let as_slow = slot.drop.tilt_rad.sin() * (fast / slot.drop.speed_m_s);
                        let outdone = speed < 1.0 && slow < fast && as_slow <= self.drop.tilt_rad.hi().sin();
                        if !outdone || self.accuracy.model.is_some() {
                            slots.push((place, Arc::new(slot)));
                        }
                    }
                }
            }
        }
        Ok(slots)
    }

    /// The worst drop of each task; `None` where no drop may pass what is proven. Tasks of one component follow one
    /// another.
    ///
    /// # Errors
    /// A drop that a model does not take.
    pub(crate) fn worst(&self, tasks: &[Task<'_>]) -> Result<Vec<Option<Found>>, Error> {
        let slots = self.slots()?;
        let components: Vec<_> = tasks.chunk_by(|a, b| std::ptr::eq(a.component, b.component)).collect();
        let found = components.into_par_iter().map(|tasks| {
            let grids = self.grids(tasks, slots)?;
            let each = tasks.iter().zip(grids).map(|(task, grid)| Search::new(self, task, 0.0).run(grid));
            each.collect::<Result<Vec<_>, Error>>()
        });
        Ok(found.collect::<Result<Vec<_>, Error>>()?.into_iter().flatten().collect())
    }

    /// What the worst of some places reaches by one pair of models, if that passes `above`.
    ///
    /// # Errors
    /// As [`worst`](Self::worst).
    pub(crate) fn most(
        &self,
        task: &Task<'_>,
        pair: Option<Pair>,
        places: impl IntoIterator<Item = Place>,
        above: f64,
    ) -> Result<Option<Reached>, Error> {
        let mut search = Search::new(self, task, above);
        for place in places {
            let candidate = match pair {
                Some(pair) => {
                    let (slot, all) = (self.slot_beside(&place)?, f64::INFINITY);
                    Candidate { place, slot, pair, within: true, about: all, at_most: all, until_s: all }
                }
                None => search.foresee(place)?,
            };
            if search.may_be_worst(&candidate)? {
                search.consider(&candidate)?;
            }
        }
        Ok(search.best.map(|(_, reached)| reached).filter(|reached| reached.value > above))
    }

    /// The pairs over the grid, for one demand.
    ///
    /// # Errors
    /// As [`worst`](Self::worst).
    pub(crate) fn pairs(&self, task: &Task<'_>) -> Result<Vec<Pair>, Error> {
        let grids = self.grids(std::slice::from_ref(task), self.slots()?)?;
        Ok(grids.into_iter().flatten().map(|c| c.pair).collect())
    }

    /// All places of the grid, as they are foreseen, for each demand of one component.
    fn grids(&self, tasks: &[Task<'_>], slots: &[(Place, Arc<Slot>)]) -> Result<Vec<Vec<Candidate>>, Error> {
        let mut grids = vec![Vec::new(); tasks.len()];
        for (place, slot) in slots {
            // The strikes of one drop, and how far a part turns between them, are the same for all of its places.
            let mut trail = slot.trail(self).clone();
            for (task, grid) in tasks.iter().zip(&mut grids) {
                for place in self.places(task, *place) {
                    grid.push(self.foresee(task, place, slot, &mut trail)?);
                }
            }
        }
        Ok(grids)
    }

    /// The places of one drop: both ends of the component, either end first where that is the same, and its
    /// frequencies.
    fn places(&self, task: &Task<'_>, of_drop: Place) -> Vec<Place> {
        let turn = is_turn(task);
        let positions = if turn { vec![task.component.position_m] } else { task.component.ends_m() };
        let fixed = task.demand.frequencies().is_none_or(|f| f.is_value());
        let firsts = if self.turns() && !turn { self.drop.first_ends() } else { &[of_drop.first] };
        let [tilt, speed, restitution, _] = of_drop.shares;
        let mut places = Vec::new();
        for &first in firsts {
            for &position_m in &positions {
                let of = |frequency| Place { first, shares: [tilt, speed, restitution, frequency], position_m };
                places.extend(shares(STEPS, fixed).map(of));
            }
        }
        places
    }

    fn frequency_hz(task: &Task<'_>, place: &Place) -> f64 {
        task.demand.frequencies().map_or(0.0, |f| f.at(place.shares[3]))
    }

    /// The drop at a place as plans take it, for its own position or another one in [−1, 1].
    fn setup(&self, task: &Task<'_>, place: &Place, slot: &Slot, position: Option<f64>) -> Result<Setup, Error> {
        let toward = if place.first == End::A { 1.0 } else { -1.0 };
        let position = position.unwrap_or_else(|| toward * self.product.relative(place.position_m));
        let suspension = match task.demand.suspension(Self::frequency_hz(task, place))? {
            Some(suspension) => suspension,
            // Of a velocity shock it does not matter.
            None => Suspension::new(1.0, DampingRatio::new(0.0)?)?,
        };
        Ok(Setup::anywhere(slot.scene, self.product.contact_time_s, position, suspension))
    }

    /// When a drop has bounced clear.
    pub(crate) fn clear_s(&self, drop: &SingleDrop) -> f64 {
        drop.clear_s(self.product.body.length_m())
    }

    /// The plan for a place.
    ///
    /// # Errors
    /// A frequency that no suspension has.
    pub(crate) fn plan(&self, task: &Task<'_>, place: &Place) -> Result<Option<Plan>, Error> {
        let slot = self.slot(place)?;
        let setup = self.setup(task, place, &slot, None)?;
        let tolerance = self.accuracy.of_truth();
        Ok(task.demand.quantity().map(|quantity| setup.forecast(quantity).plan(tolerance)))
    }

    fn foresee(&self, task: &Task<'_>, place: Place, slot: &Arc<Slot>, trail: &mut Trail) -> Result<Candidate, Error> {
        let tolerance = self.accuracy.of_truth();
        let mut candidate = Candidate {
            place,
            slot: Arc::clone(slot),
            pair: Pair::HIGHEST,
            within: true,
            about: f64::INFINITY,
            at_most: f64::INFINITY,
            until_s: f64::INFINITY,
        };
        if let Some(quantity) = task.demand.quantity() {
            let setup = self.setup(task, &place, slot, None)?;
            let forecast = setup.forecast_along(trail, quantity);
            candidate.until_s = forecast.until_s;
            candidate.pair = match self.accuracy.model {
                None => {
                    candidate.at_most = forecast.at_most();
                    let plan = forecast.plan(tolerance);
                    candidate.within = plan.estimate.error <= tolerance;
                    plan.pair
                }
                Some(BarModel::Compliant) => Pair::HIGHEST,
                Some(model) => {
                    let impulses = self.product.contact_time_s.is_none()
                        || forecast.component(ComponentRung::ImpulseTrain).error <= tolerance;
                    let component = match quantity {
                        Quantity::VelocityShock => ComponentRung::LargestShock,
                        _ if impulses => ComponentRung::ImpulseTrain,
                        _ => ComponentRung::PulseTrain,
                    };
                    Pair { bar: rung_of(model), component }
                }
            };
            candidate.about = forecast.peak;
        } else {
            candidate.pair = match self.accuracy.model {
                None => self.pair_of_shocks(task, &place, slot, trail)?.0,
                Some(BarModel::Compliant) => Pair::HIGHEST,
                Some(model) => Pair { bar: rung_of(model), component: component_of_shocks(task) },
            };
        }
        Ok(candidate)
    }

    /// What a model that was named gets wrong at a place, as a share of the truth, about; infinite where that is not
    /// known.
    pub(crate) fn error_of(&self, model: BarModel, task: &Task<'_>, place: &Place) -> Result<f64, Error> {
        if let Some(plan) = self.plan(task, place)? {
            return Ok(plan.forecast.bar(rung_of(model)).error);
        }
        let (pair, is_within) = self.planned_of_shocks(task, place)?;
        let overlaps = pair == Pair::HIGHEST || !is_within;
        if overlaps && model != BarModel::Compliant {
            return Ok(f64::INFINITY);
        }
        let slot = self.slot(place)?;
        let mut error = 0.0_f64;
        for &position in places_of_shocks(task) {
            let forecast = self.setup(task, place, &slot, position)?.forecast(Quantity::VelocityShock);
            error = error.max(forecast.bar(rung_of(model)).error);
        }
        Ok(error + if model < BarModel::FiniteTilt { apart(task, &slot.drop) } else { 0.0 })
    }

    /// As [`pair_of_shocks`](Self::pair_of_shocks), for any place.
    pub(crate) fn planned_of_shocks(&self, task: &Task<'_>, place: &Place) -> Result<(Pair, bool), Error> {
        let slot = self.slot(place)?;
        let mut trail = slot.trail(self).clone();
        self.pair_of_shocks(task, place, &slot, &mut trail)
    }

    /// For a turn of the bar or the pulse of a hard-mounted part: the bar that gives the velocity shocks right, with
    /// contacts wherever two overlap; and whether it does, which it does not where the model of contacts does not take
    /// the drop.
    fn pair_of_shocks(
        &self,
        task: &Task<'_>,
        place: &Place,
        slot: &Slot,
        trail: &mut Trail,
    ) -> Result<(Pair, bool), Error> {
        let component = component_of_shocks(task);
        let (mut bar, tolerance, apart) = (BarRung::Map, self.accuracy.of_truth(), apart(task, &slot.drop));
        for &position in places_of_shocks(task) {
            let setup = self.setup(task, place, slot, position)?;
            let forecast = setup.forecast_along(trail, Quantity::VelocityShock);
            let plan = forecast.plan(tolerance);
            let alone = self.product.contact_time_s.is_none() || forecast.groups.overlap <= 1.0;
            if plan.pair.bar == BarRung::Compliant || !alone {
                let is_taken = forecast.bar(BarRung::Compliant).error < f64::INFINITY;
                let rigid = Pair { bar: BarRung::FiniteTilt, component };
                return Ok((if is_taken { Pair::HIGHEST } else { rigid }, is_taken));
            }
            let within = plan.estimate.error + apart <= tolerance;
            bar = bar.max(if within { plan.pair.bar } else { BarRung::FiniteTilt });
        }
        Ok((Pair { bar, component }, true))
    }
}

/// How a turn of the bar, or a hard-mounted part, has its shocks.
fn component_of_shocks(task: &Task<'_>) -> ComponentRung {
    if is_turn(task) { ComponentRung::LargestShock } else { ComponentRung::PulseTrain }
}

/// Where a drop is looked at: the place itself, or both ends of the product.
fn places_of_shocks(task: &Task<'_>) -> &'static [Option<f64>] {
    if is_turn(task) { &[Some(-1.0), Some(1.0)] } else { &[None] }
}

/// What models of small tilt get wrong of a turn: they have the ends as far apart on the ground as along the body.
fn apart(task: &Task<'_>, drop: &SingleDrop) -> f64 {
    if is_turn(task) { 1.0 / libm::cos(drop.tilt_rad) - 1.0 } else { 0.0 }
}

fn is_turn(task: &Task<'_>) -> bool {
    task.demand.kind == LimitKind::AngularVelocityChange
}

impl Slot {
    /// Its first strikes, all that a forecast looks at.
    fn trail(&self, field: &Field<'_>) -> &Trail {
        self.trail.get_or_init(|| Trail::new(&self.scene, field.product.contact_time_s).whole())
    }
    fn strikes(&self, field: &Field<'_>, model: BarModel) -> Result<&Base, Error> {
        let k = match model {
            BarModel::Map => 0,
            BarModel::Ballistic => 1,
            BarModel::FiniteTilt | BarModel::Compliant => 2,
        };
        let follow = || Base::of_strikes(field.product, &self.drop, model, field.cells);
        self.strikes[k].get_or_init(follow).as_ref().map_err(Clone::clone)
    }
    fn contacts(&self, field: &Field<'_>, all: bool) -> Result<&Base, Error> {
        let most = if all { MOST_CONTACTS } else { CONTACTS };
        let follow = || {
            let time = field.product.contact_time_s.ok_or(Error::Contact)?;
            Base::of_contacts(field.product, &self.drop, time, most, field.cells)
        };
        self.contacts[usize::from(all)].get_or_init(follow).as_ref().map_err(Clone::clone)
    }
}

/// A place of the grid that is not followed yet.
#[derive(Debug, Clone, Copy)]
struct Open {
    at_most: f64,
    k: usize,
    /// Whether it was looked at closer.
    closer: bool,
}

impl PartialEq for Open {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Order::Equal
    }
}
impl Eq for Open {}
impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<Order> {
        Some(self.cmp(other))
    }
}
impl Ord for Open {
    fn cmp(&self, other: &Self) -> Order {
        self.at_most.total_cmp(&other.at_most).then(other.k.cmp(&self.k))
    }
}

/// The search for one demand.
struct Search<'a> {
    field: &'a Field<'a>,
    task: &'a Task<'a>,
    /// What a place must pass to count.
    above: f64,
    known: Known,
    best: Option<(Candidate, Reached)>,
    /// Drops that were followed and come back, as far as is known.
    returning: BTreeMap<Key, Candidate>,
}

impl<'a> Search<'a> {
    fn new(field: &'a Field<'a>, task: &'a Task<'a>, above: f64) -> Self {
        Self { field, task, above, known: Known::new(), best: None, returning: BTreeMap::new() }
    }

    fn run(mut self, mut grid: Vec<Candidate>) -> Result<Option<Found>, Error> {
        if self.task.proven.is_some() && self.field.accuracy.model.is_none() {
            grid.retain(|c| !self.is_proven(c));
        }
        // The highest first, so that most of the others need not be followed.
        if let Some(first) = grid.iter().reduce(|a, b| if b.about > a.about { b } else { a }) {
            self.consider(first)?;
        }
        self.sweep(&grid)?;
        let mut raised = self.refine()?;
        if self.task.demand.quantity().is_some() {
            let mut falling: Vec<_> = grid.iter().collect();
            falling.sort_by(|a, b| b.about.total_cmp(&a.about));
            if self.climb_from_elsewhere(&falling)? {
                raised = self.refine()?;
            }
        }
        let (field, rebounds) = (self.field, self.rebounds_may_decide()?);
        if rebounds {
            self.scan()?;
        }
        Ok(self.best.map(|(candidate, reached)| Found {
            reached,
            drop: field.single(&candidate.place),
            place: candidate.place,
            pair: candidate.pair,
            raised,
            rebounds,
        }))
    }

    /// Whether a rebound may pass the worst in drops like those that were followed.
    fn rebounds_may_decide(&self) -> Result<bool, Error> {
        for candidate in self.returning.values() {
            let Candidate { place, slot, until_s, .. } = candidate;
            let clear_s = self.field.clear_s(&slot.drop);
            let (base, _) = self.followed(candidate)?;
            let (least, (positions, quantity)) = (self.least(place, slot)?, self.places());
            for position in positions {
                let setup = self.field.setup(self.task, place, slot, *position)?;
                if base.may_pass_within([clear_s, *until_s], &setup, quantity, least) {
                    return Ok(true);
                }
            }
        }
        Ok(false)
    }

    /// Where a drop is looked at, the place itself or both ends of the product, and for what.
    fn places(&self) -> (&'static [Option<f64>], Quantity) {
        (places_of_shocks(self.task), self.task.demand.quantity().unwrap_or(Quantity::VelocityShock))
    }

    /// What a place must pass to count.
    fn worst(&self) -> f64 {
        let proven = if self.field.accuracy.model.is_none() { self.task.proven } else { None };
        self.best.as_ref().map_or(self.above, |(_, reached)| reached.value).max(proven.unwrap_or(0.0))
    }

    /// Whether the plan of a place knows nothing that the proof does not know.
    fn is_proven(&self, candidate: &Candidate) -> bool {
        let Pair { bar, component } = candidate.pair;
        let instants = self.task.demand.quantity().is_none() || component != ComponentRung::PulseTrain;
        bar <= BarRung::Map && instants && candidate.within
    }

    /// Follows the grid from the highest bound down, each place once a closer look has not lowered its bound below that
    /// of others.
    fn sweep(&mut self, grid: &[Candidate]) -> Result<(), Error> {
        let mut open: BinaryHeap<Open> =
            grid.iter().enumerate().map(|(k, c)| Open { at_most: c.at_most, k, closer: false }).collect();
        while let Some(Open { at_most, k, closer }) = open.pop() {
            if at_most <= self.worst() {
                break;
            }
            if closer {
                self.consider(&grid[k])?;
            } else {
                open.push(Open { at_most: self.seen_closer(&grid[k])?, k, closer: true });
            }
        }
        Ok(())
    }

    /// Follows a candidate, and keeps it where it is the worst.
    fn consider(&mut self, candidate: &Candidate) -> Result<bool, Error> {
        let reached = self.follow(candidate)?;
        if let Some(reached) = reached {
            self.best = Some((candidate.clone(), reached));
        }
        Ok(reached.is_some())
    }

    fn may_be_worst(&mut self, candidate: &Candidate) -> Result<bool, Error> {
        Ok(candidate.at_most > self.worst() && self.seen_closer(candidate)? > self.worst())
    }

    fn key(&self, Candidate { place, slot, .. }: &Candidate) -> Key {
        let (_, position_m) = self.field.followed(place);
        (slot.number, position_m.to_bits(), Field::frequency_hz(self.task, place).to_bits())
    }

    /// What a candidate reaches at most, where contacts overlap by the response to each of them as a single shock; of
    /// what was followed, no more than what it reached or was then to pass.
    fn seen_closer(&mut self, candidate: &Candidate) -> Result<f64, Error> {
        let key = self.key(candidate);
        if let Some(at_most) = self.known.get(&key) {
            return Ok(*at_most);
        }
        let at_most = self.look_closer(candidate)?.map_or(candidate.at_most, |closer| closer.min(candidate.at_most));
        self.known.insert(key, at_most);
        Ok(at_most)
    }

    fn look_closer(&mut self, candidate: &Candidate) -> Result<Option<f64>, Error> {
        let Candidate { place, slot, pair, .. } = candidate;
        let (field, demand) = (self.field, &self.task.demand);
        let frequency_hz = Field::frequency_hz(self.task, place);
        let (_, position_m) = field.followed(place);
        let Some(asked) = demand.asked_of(position_m, frequency_hz, self.worst())? else { return Ok(None) };
        if pair.bar != BarRung::Compliant || field.accuracy.model.is_some() {
            return Ok(None);
        }
        let (base, until_s) = self.contacts(place, slot)?;
        self.keep_if_returning(candidate, base, until_s);
        base.peak_at_most(until_s, &asked, demand.of_unit_shock(frequency_hz))
    }

    /// What a candidate reaches, if it is the worst yet.
    fn follow(&mut self, candidate: &Candidate) -> Result<Option<Reached>, Error> {
        let (field, task, place) = (self.field, self.task, &candidate.place);
        let pulses = candidate.pair.component == ComponentRung::PulseTrain;
        let (base, until_s) = self.followed(candidate)?;
        self.keep_if_returning(candidate, base, until_s);
        let (_, position_m) = field.followed(place);
        let frequency_hz = Field::frequency_hz(task, place);
        let above = self.best.as_ref().map_or(Demand::ANY, |(_, best)| best.value);
        let reached = task.demand.reached_at(base, position_m, frequency_hz, pulses, until_s, above)?;
        self.known.insert(self.key(candidate), reached.map_or(above, |reached| reached.value));
        Ok(reached.map(|reached| Reached { position_m: place.position_m, ..reached }))
    }

    /// Keeps a drop that comes back after it has bounced clear.
    fn keep_if_returning(&mut self, candidate: &Candidate, base: &Base, until_s: f64) {
        let clear_s = self.field.clear_s(&candidate.slot.drop);
        let returns = until_s == f64::INFINITY || base.strikes_within(clear_s, f64::INFINITY);
        if clear_s < f64::INFINITY && returns {
            self.returning.entry(self.key(candidate)).or_insert_with(|| candidate.clone());
        }
    }

    /// What a shock or a response, as a velocity, must pass to count.
    fn least(&self, place: &Place, slot: &Slot) -> Result<f64, Error> {
        let (field, task, worst) = (self.field, self.task, self.worst());
        let (_, position_m) = field.followed(place);
        let asked = task.demand.asked_of(position_m, Field::frequency_hz(task, place), worst)?;
        Ok(match (asked, task.demand.kind) {
            (Some(asked), _) => worst / asked.unit(),
            (None, LimitKind::VelocityChange | LimitKind::DamageBoundary) => worst,
            // Of all motions of one energy a turn about the center of mass is the fastest one; a shock of an end turns
            // by less.
            (None, LimitKind::AngularVelocityChange) => {
                let (body, [a, b]) = (field.product.body, field.product.body.arms_m());
                worst * body.gyration_m().hypot(a.min(b))
            }
            // The shock of a lone contact whose crest is as high.
            (None, LimitKind::Acceleration | LimitKind::RattleSpace) => {
                let crest = Pulse::new(slot.drop.restitution).crest();
                worst * field.product.contact_time_s.unwrap_or(0.0) / crest
            }
        })
    }

    /// A drop by the model of its plan, and until when its strikes count.
    fn followed<'b>(
        &self,
        Candidate { place, slot, pair, until_s, .. }: &'b Candidate,
    ) -> Result<(&'b Base, f64), Error> {
        match bar_model(*pair) {
            BarModel::Compliant => self.contacts(place, slot),
            model => Ok((slot.strikes(self.field, model)?, *until_s)),
        }
    }

    /// The contacts of a drop, followed until nothing later counts, and until when they count.
    fn contacts<'b>(&self, place: &Place, slot: &'b Slot) -> Result<(&'b Base, f64), Error> {
        let (field, task) = (self.field, self.task);
        let ((positions, quantity), least) = (self.places(), self.least(place, slot)?);
        let settled = |base: &Base| {
            let mut until_s = Some(0.0_f64);
            for position in positions {
                let settled_s = base.settled_s(&field.setup(task, place, slot, *position)?, quantity, least);
                until_s = until_s.zip(settled_s).map(|(a, b)| a.max(b));
            }
            Ok::<_, Error>(until_s)
        };
        let first = slot.contacts(field, false)?;
        if let Some(until_s) = settled(first)? {
            return Ok((first, until_s));
        }
        let all = slot.contacts(field, true)?;
        Ok((all, settled(all)?.unwrap_or(f64::INFINITY)))
    }

    /// The places next to one, at a share of the step of the grid.
    fn neighbors(&self, place: Place, axis: usize, step: f64) -> impl Iterator<Item = Place> + use<> {
        let whole = [1.0 / f64::from(TILTS), 1.0, 1.0 / f64::from(STEPS), 1.0 / f64::from(STEPS)][axis];
        let free = self.field.free(&self.task.demand)[axis];
        [-1.0, 1.0].into_iter().filter_map(move |sign| {
            let mut next = place;
            next.shares[axis] = (place.shares[axis] + sign * step * whole).clamp(0.0, 1.0);
            (free && (next.shares[axis] - place.shares[axis]).abs() > f64::EPSILON).then_some(next)
        })
    }

    /// A place beside the grid, as it is foreseen; of one drop all that was worked out is kept.
    fn foresee(&self, place: Place) -> Result<Candidate, Error> {
        let slot = self.field.slot_beside(&place)?;
        let mut trail = slot.trail(self.field).clone();
        self.field.foresee(self.task, place, &slot, &mut trail)
    }

    /// Halves the step around the worst place; returns by which share the last halving raised the demand.
    fn refine(&mut self) -> Result<f64, Error> {
        let (mut step, mut raised) = (1.0, 0.0);
        for halving in 0..HALVINGS[1] {
            let Some((_, Reached { value: before, .. })) = self.best else { return Ok(0.0) };
            step *= 0.5;
            for axis in 0..4 {
                let Some((Candidate { place, .. }, _)) = self.best else { return Ok(0.0) };
                for next in self.neighbors(place, axis, step) {
                    let candidate = self.foresee(next)?;
                    if self.may_be_worst(&candidate)? {
                        self.consider(&candidate)?;
                    }
                }
            }
            let after = self.best.as_ref().map_or(0.0, |(_, reached)| reached.value);
            raised = if before > 0.0 { after / before - 1.0 } else { 0.0 };
            if halving + 1 >= HALVINGS[0] && raised <= 0.5 * self.field.accuracy.tolerance {
                break;
            }
        }
        Ok(raised)
    }

    /// Follows drops at even tilts, for what rebounds ask between the places of the grid, until that changes nothing.
    fn scan(&mut self) -> Result<(), Error> {
        let [lo, hi] = [self.field.drop.tilt_rad.lo(), self.field.drop.tilt_rad.hi()];
        for _ in 0..SCANS {
            let Some((Candidate { place: worst, .. }, _)) = self.best else { return Ok(()) };
            let mut moved = false;
            for step in 0..=EVEN_TILTS {
                let tilt_rad = lo + f64::from(step) / f64::from(EVEN_TILTS) * (hi - lo);
                for first in self.field.drop.first_ends() {
                    for place in self.field.at_tilt(self.task, &worst, *first, tilt_rad) {
                        let candidate = self.foresee(place)?;
                        if self.may_be_worst(&candidate)? {
                            moved |= self.consider(&candidate)?;
                        }
                    }
                }
            }
            if !moved {
                break;
            }
        }
        Ok(())
    }

    /// Climbs by what is foreseen alone from the highest places of the grid that are no neighbors; follows where that
    /// leads. `grid` in falling order. Whether the worst place is another one now.
    fn climb_from_elsewhere(&mut self, grid: &[&Candidate]) -> Result<bool, Error> {
        let mut starts: Vec<Place> = self.best.iter().map(|(candidate, _)| candidate.place).collect();
        let next_to = |a: &Place, b: &Place| {
            let same = a.first == b.first && a.position_m.to_bits() == b.position_m.to_bits();
            same && (a.shares[0] - b.shares[0]).abs() < 1.5 / f64::from(TILTS)
        };
        let mut moved = false;
        for candidate in grid {
            if starts.len() > BASINS {
                break;
            }
            if starts.iter().any(|start| next_to(start, &candidate.place)) {
                continue;
            }
            starts.push(candidate.place);
            let (mut top, mut step) = (Candidate::clone(candidate), 1.0);
            for _ in 0..HALVINGS[0] {
                step *= 0.5;
                for axis in 0..4 {
                    for next in self.neighbors(top.place, axis, step) {
                        let candidate = self.foresee(next)?;
                        if candidate.about > top.about {
                            top = candidate;
                        }
                    }
                }
            }
            if self.may_be_worst(&top)? {
                moved |= self.consider(&top)?;
            }
        }
        Ok(moved)
    }
}
