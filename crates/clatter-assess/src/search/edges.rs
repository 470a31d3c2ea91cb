//! This module finds where the order of touches and partings changes between neighboring tilts: the demand on stiff parts jumps there.

use rayon::prelude::*;

use super::Work;
use super::budgets::{EDGE_HALVINGS, EVENTS};
use super::ranges::{AXES, Coordinates, DIRECTION, Ranges, TILT};
use clatter_flight::{Followed, Until};

/// The first touches and partings of a drop in their order: which end, and whether it parts.
#[derive(PartialEq, Clone)]
pub(super) struct Order(Vec<(usize, bool)>);

impl Order {
    /// Returns the order of a drop that was followed until it lands.
    pub(super) fn of(followed: &Followed) -> Self {
        let pressed = followed.presses().into_iter();
        let mut events: Vec<(f64, usize, bool)> =
            pressed.flat_map(|(point, [from_s, until_s])| [(from_s, point, false), (until_s, point, true)]).collect();
        events.sort_by(|a, b| a.0.total_cmp(&b.0));
        Self(events.into_iter().take(EVENTS).map(|(_, point, parts)| (point, parts)).collect())
    }
}

/// Two neighboring drops between which the order changes, and that of the first.
struct Edge {
    axis: usize,
    sides: [Coordinates; 2],
    order: Order,
}

impl Ranges<'_> {
    /// Returns drops on both sides of each edge between neighbors of the grid, of which these are the orders, as close to it as the space
    /// between them over 2⁸.
    pub(super) fn edges(
        &self,
        grid: &[(u32, Coordinates)],
        orders: &[Option<Order>],
        work: &Work<'_>,
    ) -> Vec<(u32, Coordinates)> {
        let pairs = grid.windows(2).zip(orders.windows(2));
        let edges: Vec<Edge> = pairs
            .filter_map(|(places, orders)| {
                let ([(_, a), (_, b)], [Some(order), Some(other)]) = (places, orders) else { return None };
                let axis = differ_by(a, b).filter(|_| order != other)?;
                Some(Edge { axis, sides: [*a, *b], order: order.clone() })
            })
            .collect();
        let close: Vec<[Coordinates; 2]> = edges.into_par_iter().map(|edge| self.close_in(edge, work)).collect();
        (0..).zip(close.into_iter().flatten()).collect()
    }

    fn close_in(&self, Edge { axis, sides: [mut near, mut far], order }: Edge, work: &Work<'_>) -> [Coordinates; 2] {
        for _ in 0..EDGE_HALVINGS {
            let middle = near.with(axis, 0.5 * (near.shares[axis] + far.shares[axis]));
            let Some(found) = self.order(&middle, work) else { break };
            if found == order { near = middle } else { far = middle }
        }
        [near, far]
    }

    /// Returns the order of a drop; none of one that is not answered, or where no more are wanted.
    fn order(&self, place: &Coordinates, work: &Work<'_>) -> Option<Order> {
        work.go_on(0).ok()?;
        self.follow(place, Until::Lands).ok().as_ref().map(Order::of)
    }
}

/// Returns the axis of two drops of the grid that differ by their tilt or their direction alone.
fn differ_by(a: &Coordinates, b: &Coordinates) -> Option<usize> {
    let differs = |axis: &usize| a.shares[*axis].to_bits() != b.shares[*axis].to_bits();
    let mut axes = (0..AXES).filter(differs);
    let axis = axes.next().filter(|axis| matches!(*axis, TILT | DIRECTION))?;
    (a.first == b.first && a.flat == b.flat && !a.flat && axes.next().is_none()).then_some(axis)
}
