//! This module computes the demand of a limit over the tilt.

use clatter::End;

use super::Point;
use super::drops::{Drops, Places, Tilt, along, corners, held, parts, with};
use crate::search::Ranges;
use crate::{LimitAssessment, WorstCase};
use clatter_flight::Until;
use clatter_product::{Component, Limit};

/// Returns a curve for each end that may touch first: at each tilt the drop with the largest demand of those followed. These are the
/// `shared` ones, at the ends of the ranges, and those with the speed, spin, restitution and contact time of the worst case; the worst case
/// is one of the points.
pub(super) fn over_tilt(
    ranges: &Ranges<'_>,
    shared: &Drops,
    (component, limit): (&Component, &LimitAssessment),
    tilts: &[Tilt],
    until: Until,
) -> Vec<(End, Vec<Point>)> {
    let Some(asked) = Limit::of(component).into_iter().find(|l| l.kind == limit.limit) else { return Vec::new() };
    let Some(worst) = &limit.worst_case else { return Vec::new() };
    let corners = corners(ranges);
    let own = with(ranges, held().filter_map(|row| Some((row, row.input.value(&worst.drop)?))));
    // All of them are followed at the tilt of the worst case, only those that are not shared at the others.
    let here = if worst.drop.is_flat { Vec::new() } else { vec![(worst.drop.tilt_rad, true)] };
    let at_worst = Drops::new(ranges, &here, &corners, until);
    let of_worst = Drops::new(ranges, if corners.contains(&own) { &[] } else { tilts }, &[own], until);
    let parts = parts(component, &asked, Some(worst));
    let mut found: Vec<Point> = Vec::new();
    for (drops, listed) in [(shared, worst.listed), (&at_worst, 0), (&of_worst, 0)] {
        let places = Places::new(drops, along(component), f64::INFINITY);
        for view in drops.views().into_iter().filter(|view| drops.listed(*view) == listed) {
            let of = |at| places.share(view, at, &asked, &parts, -1.0);
            let most = (0..places.positions_m.len()).filter_map(of).reduce(|a, b| if b.0 > a.0 { b } else { a });
            if let Some((share, part)) = most {
                found.push(Point { tilt_rad: drops.tilt(view).0, drop: drops.drop(view), part, share });
            }
        }
    }
    found.extend(of_worst_case(limit));
    let curve = |first: End| {
        let mut points: Vec<Point> = found.iter().filter(|point| point.drop.first() == first).copied().collect();
        points.sort_by(|a, b| a.tilt_rad.total_cmp(&b.tilt_rad));
        let same = |a: &Point, b: &Point| b.tilt_rad - a.tilt_rad < 1e-12;
        let most = |at: &[Point]| at.iter().copied().reduce(|a, b| if b.share > a.share { b } else { a });
        points.chunk_by(same).filter_map(most).collect::<Vec<Point>>()
    };
    ranges.drop.first_ends().iter().map(|&first| (first, curve(first))).collect()
}

/// Returns the worst case, as it is reported; a flat one has no tilt of its own.
fn of_worst_case(limit: &LimitAssessment) -> Option<Point> {
    let (WorstCase { drop, part, .. }, demand) = limit.worst_case.zip(limit.demand)?;
    (!drop.is_flat).then_some(Point { tilt_rad: drop.tilt_rad, drop, part, share: demand / limit.allowed })
}
