//! This module finds where along the product a part holds.

use super::drops::{Places, View, parts};
use super::scale::Scale;
use crate::{ComponentAssessment, LimitAssessment};
use clatter_product::{Component, Limit};

/// Places along the product, from end to end.
pub(super) const PLACES: u32 = 33;

/// Returns the places of the grid, in m from the middle.
pub(super) fn grid(length_m: f64) -> Vec<f64> {
    (0..PLACES).map(|i| length_m * (f64::from(i) / f64::from(PLACES - 1) - 0.5)).collect()
}

/// Finds where the middle of a part may be, so that no drop demands more than any limit allows.
///
/// The demand of a drop is convex along the product, the largest absolute value of functions linear in the place. So the places that
/// hold are one stretch, any place between two of them holds, and the edges taken from straight lines lie within it.
pub(super) fn zone(
    grids: &[Places<'_>],
    component: &Component,
    assessed: &ComponentAssessment,
    scales: &[Vec<Scale>],
) -> Option<[f64; 2]> {
    let half = 0.5 * component.extent_m;
    let reach = 0.5 * grids.first()?.drops.length_m();
    let (mut lo, mut hi) = (-reach, reach);
    for ((limit, found), scales) in Limit::of(component).iter().zip(&assessed.limits).zip(scales) {
        for (grid, scale) in grids.iter().zip(scales) {
            let [from, to] = stretch(grid, component, (limit, found), scale.most())?;
            (lo, hi) = (lo.max(from), hi.min(to));
        }
    }
    (lo + half <= hi - half).then_some([lo + half, hi - half])
}

/// Finds where no drop demands more than a share of one limit.
fn stretch(
    grid: &Places<'_>,
    component: &Component,
    (limit, found): (&Limit, &LimitAssessment),
    share: f64,
) -> Option<[f64; 2]> {
    let parts = parts(component, limit, found.worst_case.as_ref());
    let mut views = grid.drops.counted();
    let last = grid.positions_m.len() - 1;
    let holds = |views: &mut [View], at: usize| !grid.exceeds(views, &[at], limit, &parts, share);
    let here = component.position_m.at(0.5);
    let mut nearest: Vec<usize> = (0..=last).collect();
    nearest.sort_by(|a, b| (grid.positions_m[*a] - here).abs().total_cmp(&(grid.positions_m[*b] - here).abs()));
    let inside = nearest.into_iter().find(|at| holds(&mut views, *at))?;
    let mut edge = |end: usize| {
        if holds(&mut views, end) {
            return grid.positions_m[end];
        }
        let (mut inner, mut outer) = (inside, end);
        while inner.abs_diff(outer) > 1 {
            let middle = usize::midpoint(inner, outer);
            if holds(&mut views, middle) { inner = middle } else { outer = middle }
        }
        let [a, b] = [inner, outer].map(|at| grid.most(&views, &[at], limit, &parts));
        let [x, y] = [inner, outer].map(|at| grid.positions_m[at]);
        x + (y - x) * ((share - a) / (b - a)).clamp(0.0, 1.0)
    };
    Some([edge(0), edge(last)])
}
