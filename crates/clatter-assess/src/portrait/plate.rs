//! This module draws a part of a plate for a page: the corners of its worst drop, its demand over the direction, and its demand anywhere
//! on the plate.

use std::f64::consts::TAU;

use clatter_shock::Suspension;

use super::Point;
use crate::engine::PlaceHistory;
use crate::model::follow;
use crate::search::rough_to_rad_s;
use crate::{ComponentAssessment, LimitAssessment, Part, WorstCase};
use clatter_flight::{Drop, Followed, Place, Until};
use clatter_product::{Component, Limit, LimitKind, Source};

/// Directions of the curve, and of them one in so many for the map.
const DIRECTIONS: u32 = 72;
const OF_MAP: u32 = 3;
/// Places of the map, about.
const PLACES: f64 = 150.0;

/// The picture of a part of a plate.
#[derive(Debug, Clone, PartialEq)]
pub struct PlatePortrait {
    /// The strikes of the worst drop, in order of time.
    pub strikes: Vec<CornerStrike>,
    /// The demand on the part of the worst drop where the plate rises to other directions, in order of direction from 0 to 2π: all else is
    /// as in the worst drop, which is one of the points.
    pub over_direction: Vec<Point>,
    /// The directions that the file gives, from and to, in rad; any if none.
    pub given_rad: Option<[f64; 2]>,
    /// The demand for each of its limits at any place, around its own worst drop, the tightest first; none of those with the same demand
    /// everywhere.
    pub maps: Vec<(LimitKind, PlaceMap)>,
}

impl PlatePortrait {
    /// Returns whether the file gives a direction in rad.
    #[must_use]
    pub fn is_given(&self, direction_rad: f64) -> bool {
        is_given(self.given_rad, direction_rad)
    }
}

/// A strike of a corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CornerStrike {
    /// 0 for a (−, −), 1 for b (+, −), 2 for c (+, +), 3 for d (−, +), along and across the product.
    pub corner: usize,
    /// The time of the touch, since the first touch.
    pub time_s: f64,
    /// The velocity change that its force gives to the corner.
    pub delta_v_m_s: f64,
}

/// The demand on one point of a part over the plan of a plate.
#[derive(Debug, Clone, PartialEq)]
pub struct PlaceMap {
    /// Columns, from the middle along the product; that of the part's worst place is one of them.
    pub along_m: Vec<f64>,
    /// Rows, across it; that of the part's worst place is one of them.
    pub across_m: Vec<f64>,
    /// The demand as a share of what is allowed, row by row: the most of the drops.
    pub shares: Vec<f64>,
    /// The number of drops: the worst one, and those of the curve with every third direction that the file gives.
    pub drops: usize,
}

impl PlaceMap {
    /// Returns the share of a column and a row.
    #[must_use]
    pub fn share(&self, column: usize, row: usize) -> f64 {
        self.shares[row * self.along_m.len() + column]
    }
}

/// The data of one limit of a part around its worst drop.
struct OneLimit<'a> {
    limit: Limit,
    suspension: Option<Suspension>,
    /// The natural frequency up to which histories may be rough.
    rough_to_rad_s: f64,
    worst: &'a WorstCase,
}

impl<'a> OneLimit<'a> {
    /// Returns the data of a limit; none of one for which no drop is answered.
    fn of(component: &Component, limit: &'a LimitAssessment) -> Option<Self> {
        let worst = limit.worst_case.as_ref()?;
        let asked = Limit::of(component).into_iter().find(|asked| asked.kind == limit.limit)?;
        let (suspension, rough_to_rad_s) = (worst.part.suspension, rough_to_rad_s(component));
        Some(Self { limit: asked, suspension, rough_to_rad_s, worst })
    }
    /// Off an edge or a corner no direction is that of a plan, and a bar has none.
    fn has_directions(&self) -> bool {
        self.worst.drop.body.is_wide() && self.worst.drop.is_level
    }
    /// Returns whether the demand differs from place to place.
    fn has_map(&self) -> bool {
        self.limit.kind.source() != Source::Turn
    }
    /// Returns the worst drop with other directions all around, every so many of them, with their numbers.
    fn around(&self, every: u32) -> impl Iterator<Item = (u32, Drop)> {
        let turned = |k: u32| (k, self.rising_to(TAU * f64::from(k) / f64::from(DIRECTIONS)));
        let all: Vec<_> = (0..=DIRECTIONS).filter(|k| k.is_multiple_of(every)).map(turned).collect();
        all.into_iter()
    }
    /// Returns the demand of a followed drop at a place, as a share, where it passes `above`.
    fn share(&self, followed: &Followed, at_m: [f64; 2], above: f64) -> Option<f64> {
        let felt = PlaceHistory::rough(followed, Place::flat(at_m), self.rough_to_rad_s).ok()?;
        felt.answer(&self.limit, self.suspension.as_ref(), above).ok()?.map(|answer| answer.utilization())
    }
    /// Returns the largest share at some places, and the part there.
    fn most(&self, followed: &Followed, places: &[[f64; 2]]) -> Option<(f64, Part)> {
        let mut most: Option<(f64, Part)> = None;
        for &at_m in places {
            let part = Part::at(Place::flat(at_m), self.suspension);
            let more = self.share(followed, at_m, most.map_or(-1.0, |most| most.0));
            most = more.map(|share| (share, part)).or(most);
        }
        most
    }
    /// Returns the worst drop with another direction.
    fn rising_to(&self, direction_rad: f64) -> Drop {
        Drop { direction_rad, ..self.worst.drop }
    }
}

/// Returns the portrait of a part; none where no drop is answered, and of a box that lands on a face, an edge or a corner. `given`: the
/// directions that the file gives for the drop of a worst case.
pub(super) fn portrait(
    component: &Component,
    assessed: &ComponentAssessment,
    given: impl Fn(&WorstCase) -> Option<[f64; 2]>,
    until: Until,
) -> Option<PlatePortrait> {
    let tightest = assessed.tightest();
    let asked = OneLimit::of(component, tightest).filter(OneLimit::has_directions)?;
    let worst = asked.worst;
    let own = follow(&worst.drop, worst.model, worst.tolerance, Until::Over).ok()?;
    let given_rad = given(worst);
    let places = component.places_m();
    let (mut points, mut counted) = (Vec::new(), Vec::new());
    for (k, drop) in asked.around(1) {
        let Ok(followed) = follow(&drop, worst.model, worst.tolerance, until) else { continue };
        let Some((share, part)) = asked.most(&followed, &places) else { continue };
        points.push(Point { tilt_rad: drop.tilt_rad, drop, part, share });
        if k < DIRECTIONS && k.is_multiple_of(OF_MAP) && is_given(given_rad, drop.direction_rad) {
            counted.push((share, followed));
        }
    }
    let share = tightest.demand? / tightest.allowed;
    let here = asked.rising_to(worst.drop.direction_rad.rem_euclid(TAU));
    let after = points.partition_point(|point| point.drop.direction_rad < here.direction_rad);
    points.insert(after, Point { tilt_rad: here.tilt_rad, drop: here, part: worst.part, share });
    let map = if asked.has_map() { map_of(&asked, &own, &in_order(counted)) } else { None };
    let mut others: Vec<_> = assessed.limits.iter().filter(|limit| limit.limit != tightest.limit).collect();
    others.sort_by(|a, b| a.room().total_cmp(&b.room()));
    let other = |limit: &LimitAssessment| {
        let asked = OneLimit::of(component, limit).filter(|asked| asked.has_map() && asked.has_directions())?;
        let worst = asked.worst;
        let given_rad = given(worst);
        let counts = |(k, drop): (u32, Drop)| {
            let is_counted = k < DIRECTIONS && is_given(given_rad, drop.direction_rad);
            let followed = is_counted.then(|| follow(&drop, worst.model, worst.tolerance, until).ok())??;
            let (share, _) = asked.most(&followed, &places)?;
            Some((share, followed))
        };
        let counted = asked.around(OF_MAP).filter_map(counts).collect();
        let own = follow(&worst.drop, worst.model, worst.tolerance, Until::Over).ok()?;
        Some((limit.limit, map_of(&asked, &own, &in_order(counted))?))
    };
    Some(PlatePortrait {
        strikes: own.strikes_of_corners().into_iter().map(strike).collect(),
        over_direction: points,
        given_rad,
        maps: map.map(|map| (tightest.limit, map)).into_iter().chain(others.into_iter().filter_map(other)).collect(),
    })
}

/// Sorts drops by their demand, the most demanding ones first, so that the others are soon known to have less.
fn in_order(mut counted: Vec<(f64, Followed)>) -> Vec<Followed> {
    counted.sort_by(|a, b| b.0.total_cmp(&a.0));
    counted.into_iter().map(|(_, followed)| followed).collect()
}

/// Returns whether the file gives a direction, in whatever turn; its ends are allowed to be off by roundings.
fn is_given(given_rad: Option<[f64; 2]>, direction_rad: f64) -> bool {
    given_rad.is_none_or(|[lo, hi]| (direction_rad - lo + 1e-9).rem_euclid(TAU) <= hi - lo + 2e-9)
}

fn strike((corner, time_s, delta_v_m_s): (usize, f64, f64)) -> CornerStrike {
    CornerStrike { corner, time_s, delta_v_m_s }
}

/// Returns the map: the worst drop as exactly as it is assessed, others roughly. None where the worst drop is not answered everywhere.
fn map_of(asked: &OneLimit<'_>, own: &Followed, others: &[Followed]) -> Option<PlaceMap> {
    let [length, width] = own.drop.sides_m();
    let [x, y] = asked.worst.part.at_m();
    // The demand is least near the center of mass.
    let center = own.drop.body.from_center([0.0; 3]).map(|from| 0.0 - from);
    let columns = (PLACES * length / width).sqrt().clamp(7.0, 24.0).round();
    let rows = (PLACES / columns).max(7.0).round();
    let (along_m, across_m) = (lines(length, columns, [center[0], x]), lines(width, rows, [center[1], y]));
    let mut shares = Vec::with_capacity(along_m.len() * across_m.len());
    for &y in &across_m {
        for &x in &along_m {
            let felt = PlaceHistory::new(own, Place::flat([x, y])).ok()?;
            let answer = felt.answer(&asked.limit, asked.suspension.as_ref(), -1.0).ok()?;
            let own = answer.map_or(0.0, |answer| answer.utilization());
            shares.push(others.iter().fold(own, |most, other| asked.share(other, [x, y], most).unwrap_or(most)));
        }
    }
    Some(PlaceMap { along_m, across_m, shares, drops: 1 + others.len() })
}

/// Lines from edge to edge of a side, evenly but for those through two places.
fn lines(side_m: f64, count: f64, through_m: [f64; 2]) -> Vec<f64> {
    let last = (count - 1.0).max(1.0);
    let mut lines: Vec<f64> =
        (0..32).map(f64::from).take_while(|k| *k <= last).map(|k| side_m * (k / last - 0.5)).collect();
    for through_m in through_m {
        lines.retain(|line| (line - through_m).abs() > 1e-3 * side_m);
        lines.push(through_m);
    }
    lines.sort_by(f64::total_cmp);
    lines
}
