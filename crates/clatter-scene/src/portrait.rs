//! What a page shows of a part beside its verdict: its response in the worst drop, its demand over the tilt, its safe
//! places, what would make it safe.

use clatter::End;
use clatter_shock::{State, Suspension};
use rayon::prelude::*;

use crate::base::{Base, SingleDrop};
use crate::demand::Demand;
use crate::design::{Bounds, Remedy};
use crate::search::{self, EVEN_TILTS, Field, Task};
use crate::{
    Accuracy, Assessment, BarModel, Component, ComponentModel, Drop, Error, Law, LimitAssessment, LimitKind,
    ProductFile, Spread, Unit,
};

/// Points (x, y) of a line.
pub type Curve = Vec<(f64, f64)>;

/// A part to be drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Portrait {
    /// Time (s) and value (SI) of what the tightest limit is on, in its worst drop. A velocity change is a spike.
    pub history: Curve,
    /// When the ends strike in that drop, in s.
    pub impacts_s: Vec<f64>,
    /// Tilt (rad) and the most that the tightest limit is asked there, a curve for each end that may touch first.
    pub over_tilt: Vec<(End, Curve)>,
    /// Where the middle of the part could be, and every limit hold in every drop, in m from the middle of the product.
    pub zone_m: Option<[f64; 2]>,
    /// The smallest single changes that make it safe, within [`Bounds::default`]; empty for a part that is.
    pub remedies: Vec<Remedy>,
}

/// Points of a history between two strikes and after the last, at least; in a period of the part, as far as there are
/// not too many.
const POINTS: f64 = 600.0;
const IN_A_PERIOD: f64 = 16.0;
const MOST_POINTS: f64 = 12_000.0;
/// Places along the product that are assessed for the zone.
const PLACES: u32 = 33;

impl ProductFile {
    /// Portraits of all components of an assessment of this file.
    ///
    /// The curves over the tilt take the largest over the ends of the ranges of speed, restitution and frequency, and
    /// over those of the worst case; where a rebound may decide, the assessment has looked at the same drops. Zones are
    /// interpolated between 33 places: the demand is convex along the bar (a largest absolute value of functions linear
    /// in the place), so that the zone shown lies within the true one.
    ///
    /// # Errors
    /// As [`ProductFile::assess`].
    pub fn portraits(&self, assessment: &Assessment) -> Result<Vec<Portrait>, Error> {
        let zones = self.zones(&assessment.accuracy)?;
        let mut remedies = vec![Vec::new(); self.components.len()];
        for part in self.remedies(assessment, &Bounds::default())? {
            if let Some(remedies) = remedies.get_mut(part.component) {
                *remedies = part.levers;
            }
        }
        let shown = self.shown()?;
        let field = Field::new(&self.product, &shown, &self.components, assessment.accuracy);
        let each = self.components.par_iter().zip(&assessment.components).zip(zones).zip(remedies);
        each.map(|(((component, assessed), zone_m), remedies)| {
            let tightest = assessed.tightest();
            let (history, impacts_s) = self.history(component, tightest)?;
            let over_tilt = self.over_tilt(&field, component, tightest)?;
            Ok(Portrait { history, impacts_s, over_tilt, zone_m, remedies })
        })
        .collect()
    }

    /// The drop of a worst case, in the model that found it.
    fn worst_drop(&self, limit: &LimitAssessment) -> SingleDrop {
        let worst = &limit.worst_case;
        SingleDrop {
            first: worst.first,
            tilt_rad: worst.tilt_deg.to_radians(),
            speed_m_s: worst.speed_m_s,
            restitution: worst.restitution,
            gravity_m_s2: if limit.model.bar == BarModel::Map { 0.0 } else { self.drop.gravity_m_s2 },
        }
    }

    fn history(&self, component: &Component, limit: &LimitAssessment) -> Result<(Curve, Vec<f64>), Error> {
        let worst = &limit.worst_case;
        let base = Base::new(&self.product, &self.worst_drop(limit), limit.model.bar)?;
        let pulses = limit.model.component != ComponentModel::ImpulseTrain;
        let slices = base.slices_at(worst.position_m, pulses);
        let impacts: Vec<f64> = base.times().collect();
        let suspension = worst.frequency_hz.map(|f| component.mount.suspension(f)).transpose()?.flatten();
        let period = suspension.map_or(0.0, |s| std::f64::consts::TAU / s.omega());
        // to the peak and a little on; what comes long after it is far weaker
        let second = impacts.get(1).copied().unwrap_or(0.0);
        let clatter = self.product.contact_time_s.map_or(second, |contact| 12.0 * contact);
        let late = worst.time_s.max(0.25 * clatter);
        let strikes = impacts.iter().copied().filter(|t| *t <= 4.0 * late).fold(late, f64::max);
        let end = (1.25 * strikes).max(worst.time_s + 2.5 * period).max(1e-9);
        let history = match (limit.limit, suspension) {
            (LimitKind::Acceleration | LimitKind::RattleSpace, Some(suspension)) => {
                let acceleration = limit.limit == LimitKind::Acceleration;
                respond(&suspension, &slices, end, |state| {
                    if acceleration { suspension.absolute_acceleration(state) } else { state.displacement }
                })
            }
            (LimitKind::Acceleration | LimitKind::RattleSpace, None) => {
                within(base.acceleration_at(worst.position_m), end)
            }
            (LimitKind::DamageBoundary, _) if limit.unit == Unit::MeterPerSecondSquared => {
                within(base.acceleration_at(worst.position_m), end)
            }
            (LimitKind::VelocityChange | LimitKind::DamageBoundary, _) => spikes(base.shocks_of(worst.position_m), end),
            (LimitKind::AngularVelocityChange, _) => spikes(base.turns(), end),
        };
        Ok((history, impacts.into_iter().filter(|t| *t <= end).collect()))
    }

    /// The drops with one end first over the tilts that are shown; one stated tilt is shown among its neighbors.
    fn shown(&self) -> Result<Drop, Error> {
        let tilt = &self.drop.tilt_rad;
        if !tilt.is_value() {
            return Ok(self.drop);
        }
        let [lo, hi] = [0.2 * tilt.lo(), (2.0 * tilt.hi()).clamp(1f64.to_radians(), 30f64.to_radians())];
        Ok(Drop { tilt_rad: Spread::new(lo, hi, Law::Range)?, ..self.drop })
    }

    fn over_tilt(
        &self,
        field: &Field<'_>,
        component: &Component,
        limit: &LimitAssessment,
    ) -> Result<Vec<(End, Curve)>, Error> {
        let demands = Demand::of(component);
        let Some(&demand) = demands.iter().find(|d| d.kind == limit.limit) else { return Ok(Vec::new()) };
        let (task, worst) = (Task { component, demand, proven: None }, &limit.worst_case);
        let [lo, hi] = [field.drop.tilt_rad.lo(), field.drop.tilt_rad.hi()];
        let mut tilts: Vec<f64> =
            (0..=EVEN_TILTS).map(|i| lo + f64::from(i) / f64::from(EVEN_TILTS) * (hi - lo)).collect();
        tilts.push(worst.tilt_deg.to_radians());
        tilts.sort_by(f64::total_cmp);
        let worst = field.place_of(worst, demand.frequencies());
        let most = |first: End, tilt_rad: f64| {
            // The worst case first, then from the highest: most others are soon outdone.
            let places = field.at_tilt(&task, &worst, first, tilt_rad);
            let most =
                field.most(&task, Some(search::pair_of(&limit.model)), places, 0.0)?.map_or(0.0, |most| most.value);
            Ok((tilt_rad, demand.settle(most, self.product.contact_time_s).factor * most))
        };
        let curve = |first| tilts.par_iter().map(|&tilt| most(first, tilt)).collect::<Result<_, Error>>();
        self.drop.first_ends().iter().map(|&first| Ok((first, curve(first)?))).collect()
    }

    /// The safe places of every component, as far as it is within the product.
    fn zones(&self, accuracy: &Accuracy) -> Result<Vec<Option<[f64; 2]>>, Error> {
        let length = self.product.body.length_m();
        let place =
            |c: &Component, i: u32| (length - c.extent_m).max(0.0) * (f64::from(i) / f64::from(PLACES - 1) - 0.5);
        let moved = |c: &Component| {
            let c = c.clone();
            (0..PLACES).map(move |i| Component { position_m: place(&c, i), ..c.clone() })
        };
        let all = Self { components: self.components.iter().flat_map(moved).collect(), ..self.clone() };
        let assessed = all.assess_to(accuracy)?;
        let zone = |(component, places): (&Component, &[crate::ComponentAssessment])| {
            let margins: Vec<f64> = places.iter().map(|c| c.tightest().demand / c.tightest().allowed - 1.0).collect();
            let safe = |m: &f64| *m <= 0.0;
            let (first, last) = (margins.iter().position(safe)?, margins.iter().rposition(safe)?);
            let at = |i: usize| place(component, u32::try_from(i).unwrap_or(PLACES));
            let cross = |inner: usize, outer: usize| {
                let (m, n) = (margins[inner], margins[outer]);
                at(inner) + (at(outer) - at(inner)) * (-m / (n - m))
            };
            let lo = if first == 0 { at(0) } else { cross(first, first - 1) };
            let hi = if last + 1 == margins.len() { at(last) } else { cross(last, last + 1) };
            Some([lo, hi])
        };
        Ok(self.components.iter().zip(assessed.components.chunks(PLACES as usize)).map(zone).collect())
    }
}

/// The motion of a part that is driven by small velocity shocks, sampled and right at every shock.
fn respond(suspension: &Suspension, slices: &[(f64, f64)], end: f64, value: impl Fn(State) -> f64) -> Vec<(f64, f64)> {
    let period = std::f64::consts::TAU / suspension.omega();
    let step = (end / POINTS).min(period / IN_A_PERIOD).max(end / MOST_POINTS);
    let (mut state, mut now) = (State::default(), 0.0);
    let mut points = vec![(0.0, value(state))];
    let mut coast = |points: &mut Vec<(f64, f64)>, state: &mut State, until: f64| {
        let mut t = step;
        while t < until - now {
            points.push((now + t, value(suspension.free(*state, t))));
            t += step;
        }
        *state = suspension.free(*state, until - now);
        now = until;
        points.push((now, value(*state)));
    };
    for &(time, delta_v) in slices.iter().take_while(|s| s.0 < end) {
        if time > points.last().map_or(0.0, |p| p.0) {
            coast(&mut points, &mut state, time);
        }
        state.velocity -= delta_v;
        points.push((time, value(state)));
    }
    coast(&mut points, &mut state, end);
    points
}

/// A history up to `end`, at rest from its last point on.
fn within(mut history: Vec<(f64, f64)>, end: f64) -> Vec<(f64, f64)> {
    history.retain(|p| p.0 <= end);
    history.push((end, 0.0));
    history
}

/// Shocks as spikes from zero.
fn spikes(shocks: Vec<(f64, f64)>, end: f64) -> Vec<(f64, f64)> {
    let mut points = vec![(0.0, 0.0)];
    points.extend(shocks.into_iter().take_while(|s| s.0 <= end).flat_map(|(t, v)| [(t, 0.0), (t, v), (t, 0.0)]));
    points.push((end, 0.0));
    points
}
