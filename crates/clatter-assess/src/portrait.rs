//! This module draws a part for a page, next to its verdict: its response in the worst drop, its demand over the tilt, its safe
//! places.
//!
//! Curves and places are taken from one set of drops over all tilts, each followed once for all parts. Their demand at a
//! part's own place is compared with the result of the assessment there, and all else is scaled alike.

mod curves;
mod drops;
mod plate;
mod scale;
mod zone;

use crate::assess::ranges_of;
use clatter::End;
use clatter_shock::{State, Suspension};
use rayon::prelude::*;

use crate::engine::PlaceHistory;
use crate::model::follow;
use crate::search::{Ranges, rough_to_rad_s};
use crate::shock::{Shock, hardest_turn};
use crate::{Assessment, ComponentAssessment, LimitAssessment, Part, WorstCase};
use clatter_flight::{Drop, Until};
use clatter_product::{Component, ContactLaw, Error, Limit, Model, ProductFile, Source, Unit};
use drops::{Drops, Places, Tilt, along, parts, tilts};
pub use plate::{CornerStrike, PlaceMap, PlatePortrait};
use scale::Scale;

/// Points (x, y) of a line.
pub type Curve = Vec<(f64, f64)>;

/// The demand of a drop on a part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// The tilt that it stands at, in rad; a drop that lands as one is followed without it.
    pub tilt_rad: f64,
    /// The drop, which was followed.
    pub drop: Drop,
    /// The place of the part, and its suspension where that is needed.
    pub part: Part,
    /// The demand as a share of what is allowed.
    pub share: f64,
}

/// A part to be drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Portrait {
    /// Time (s) and value (SI) of what the tightest limit is on, in its worst drop. A velocity change is a spike.
    pub history: Curve,
    /// The times at which the ends or corners strike in that drop, in s.
    pub impacts_s: Vec<f64>,
    /// The drops with the largest demand for the tightest limit of those followed, by tilt: a curve for each end that may touch first.
    pub over_tilt: Vec<(End, Vec<Point>)>,
    /// The range in which the middle of the part could be, and every limit hold in the drops that were followed, in m from the middle of
    /// the product.
    pub zone_m: Option<[f64; 2]>,
    /// The picture of a plate in place of curves over the tilt and of zones; none of a bar, and where no drop is answered.
    pub plate: Option<PlatePortrait>,
}

/// Points of a history between two strikes and after the last, at least; in a period of the part, as far as there are
/// not too many.
const POINTS: f64 = 600.0;
const IN_A_PERIOD: f64 = 16.0;
const MOST_POINTS: f64 = 12_000.0;

/// Portraits of all components of an assessment of this file.
///
/// # Method
/// Drops at some forty tilts with either end first are followed until the product lands again, or past the peak of the worst
/// cases: at the highest speed and the ends of the ranges of spin, restitution and contact time. All parts are answered in the same
/// drops. The curve over the tilt holds besides the drops with the speed, spin, restitution and contact time of the worst case, and the
/// worst case itself. Safe places are those where no drop demands more than at the part's own place, but for what the assessment leaves
/// room for there: they are as good as these drops, and an assessment decides. Of a plate that has no contact law of its own the drops
/// are those of the hysteretic one. A drop that is not answered is not drawn; nothing is of an assessment of another product, or of
/// data that [`ProductFile::check`] refuses.
#[must_use]
pub fn portraits(file: &ProductFile, assessment: &Assessment) -> Vec<Portrait> {
    if file.check().and(assessment.accuracy.check()).and(assessment.is_of(file)).is_err() {
        return Vec::new();
    }
    let listed = file.listed();
    let of = listed.iter().map(|one| ranges_of(file, &one.drop, one.base, &assessment.accuracy));
    let each: Vec<Ranges<'_>> = of.collect();
    let at_worst = |limit: &LimitAssessment| each[limit.worst_case.map_or(0, |worst| worst.listed)];
    let ranges = each[0];
    let until = until(assessment);
    if file.product.body.is_wide() {
        let portrait = |(component, assessed): (&Component, &ComponentAssessment)| {
            let tightest = assessed.tightest();
            let ranges = at_worst(tightest);
            let (history, impacts_s) = history(tightest, &ranges).unwrap_or_default();
            let given = |worst: &WorstCase| each[worst.listed].drop.direction_rad.map(|given| [given.lo(), given.hi()]);
            let plate = plate::portrait(component, assessed, given, until);
            Portrait { history, impacts_s, plate, over_tilt: Vec::new(), zone_m: None }
        };
        return file.components.par_iter().zip(&assessment.components).map(portrait).collect();
    }
    let tilts: Vec<Vec<Tilt>> = each.iter().map(tilts).collect();
    // Where the file names no contact law a verdict counts with both of them.
    let laws = match (ranges.model, file.product.contact_law) {
        (Model::Compliant, None) => vec![ranges.law, ranges.law.other()],
        _ => vec![ranges.law],
    };
    let of_law = |&law: &ContactLaw| Drops::of_all(each.iter().map(|ranges| Ranges { law, ..*ranges }), &tilts, until);
    let drops: Vec<Drops> = laws.iter().filter_map(of_law).collect();
    let fastest = file.components.iter().map(rough_to_rad_s).fold(0.0, f64::max);
    let places = zone::grid(file.product.sides_m()[0]);
    let grids: Vec<_> = drops.iter().map(|drops| Places::new(drops, places.clone(), fastest)).collect();
    let each = file.components.par_iter().zip(&assessment.components);
    let portrait = |(component, assessed)| {
        let tightest: &LimitAssessment = ComponentAssessment::tightest(assessed);
        let (ranges, own) = (at_worst(tightest), tightest.worst_case.map_or(0, |worst| worst.listed));
        let (history, impacts_s) = history(tightest, &ranges).unwrap_or_default();
        let over_tilt = curves::over_tilt(&ranges, &drops[0], (component, tightest), &tilts[own], until);
        let fastest = rough_to_rad_s(component);
        let ends: Vec<_> = drops.iter().map(|drops| Places::new(drops, along(component), fastest)).collect();
        let scales = scales(component, assessed, &ends);
        let zone_m = scales.and_then(|scales| zone::zone(&grids, component, assessed, &scales));
        Portrait { history, impacts_s, over_tilt, zone_m, plate: None }
    };
    each.map(portrait).collect()
}

/// Returns the end of the motion to follow: past the peaks of the worst cases that come after the product has landed again.
fn until(assessment: &Assessment) -> Until {
    let worst = assessment.components.iter().flat_map(|c| &c.limits).filter_map(|l| l.worst_case.as_ref());
    let late = worst.filter(|worst| worst.time_s > worst.drop.clear_s());
    late.map(|worst| worst.time_s).reduce(f64::max).map_or(Until::Lands, Until::Past)
}

fn history(limit: &LimitAssessment, ranges: &Ranges<'_>) -> Result<(Curve, Vec<f64>), Error> {
    let Some(worst) = &limit.worst_case else { return Ok(Default::default()) };
    let WorstCase { drop, part, .. } = worst;
    let followed = follow(drop, ranges.model, ranges.tolerance, Until::Over)?;
    let felt = PlaceHistory::new(&followed, part.place)?;
    let impacts = followed.struck_s();
    let period = part.suspension.map_or(0.0, |s| std::f64::consts::TAU / s.omega());
    // to the peak and a little on; what comes long after it is far weaker
    let second = impacts.get(1).copied().unwrap_or(0.0);
    let clatter = drop.contact_times_s().map_or(second, |[_, longest]| 12.0 * longest);
    let late = worst.time_s.max(0.25 * clatter);
    let strikes = impacts.iter().copied().filter(|t| *t <= 4.0 * late).fold(late, f64::max);
    let end = (1.25 * strikes).max(worst.time_s + 2.5 * period).max(1e-9);
    let history = match (limit.limit.source(), part.suspension) {
        (Source::Response(peak), Some(suspension)) if suspension.stop().is_some() => {
            felt.with_stop(&suspension, peak, (end / POINTS).min(period / 64.0), end)?
        }
        (Source::Response(peak), Some(suspension)) => {
            let slices = felt.slices((end / POINTS).min(period / 64.0), end);
            respond(&suspension, &slices, end, |state| peak.of_state(&suspension, state))
        }
        (Source::Turn, _) => spikes(&hardest_turn(&followed, 0.0).unwrap_or_default(), 1.0, end),
        (Source::Shock, _) => spikes(felt.shocks(), 1.0, end),
        (Source::Boundary, _) if limit.unit == Unit::MeterPerSecond => spikes(felt.shocks(), 1.0, end),
        _ if !followed.has_contacts() => {
            let factor = std::f64::consts::FRAC_PI_2 / drop.contact_time_s.ok_or(Error::Contact)?;
            spikes(felt.shocks(), factor, end)
        }
        _ => within(felt.acceleration(), end),
    };
    Ok((history, impacts.into_iter().filter(|t| *t <= end).collect()))
}

/// Compares, for each limit and contact law, the assessment with the drops; none where it does not know the possible demand.
fn scales(component: &Component, assessed: &ComponentAssessment, ends: &[Places<'_>]) -> Option<Vec<Vec<Scale>>> {
    let of = |(limit, found): (&Limit, &LimitAssessment)| {
        let parts = parts(component, limit, found.worst_case.as_ref());
        let here = |ends: &Places<'_>| {
            let at: Vec<usize> = (0..ends.positions_m.len()).collect();
            ends.most(&ends.drops.counted(), &at, limit, &parts)
        };
        Scale::of(found, &ends.iter().map(here).collect::<Vec<_>>())
    };
    Limit::of(component).iter().zip(&assessed.limits).map(of).collect()
}

/// Computes the motion of a part that is driven by small velocity shocks, sampled and right at every shock.
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

/// Returns a history up to `end`, at rest from its last point on.
fn within(mut history: Vec<(f64, f64)>, end: f64) -> Vec<(f64, f64)> {
    history.retain(|p| p.0 <= end);
    history.push((end, 0.0));
    history
}

/// Shocks as spikes from zero.
fn spikes(shocks: &[Shock], factor: f64, end: f64) -> Vec<(f64, f64)> {
    let mut points = vec![(0.0, 0.0)];
    let spike = |shock: &Shock| [0.0, factor * shock.change, 0.0].map(|value| (shock.time_s, value));
    points.extend(shocks.iter().take_while(|shock| shock.time_s <= end).flat_map(spike));
    points.push((end, 0.0));
    points
}
