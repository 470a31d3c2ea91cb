//! Where the order of touches and partings changes between neighboring tilts: what stiff parts feel jumps there.

use rayon::prelude::*;

use super::Work;
use super::ranges::{AXES, Place, Ranges, TILT};
use crate::drop::{Followed, Until};

/// How often the space between two tilts of the grid is halved about such an edge.
const HALVINGS: u32 = 8;
/// Touches and partings that are put in order. What comes later is small.
const EVENTS: usize = 6;

/// The first touches and partings of a drop in their order: which end, and whether it parts.
type Order = Vec<(usize, bool)>;

/// Two neighboring drops between which the order changes, and that of the first.
struct Edge {
    sides: [Place; 2],
    order: Order,
}

impl Ranges<'_> {
    /// Drops on both sides of each edge between neighbors of the grid, as close to it as the space between them over 2⁸.
    pub(super) fn edges(&self, grid: &[(u32, Place)], work: &Work<'_>) -> Vec<(u32, Place)> {
        let orders: Vec<Option<Order>> = grid.par_iter().map(|(_, place)| self.order(place, work)).collect();
        let pairs = grid.windows(2).zip(orders.windows(2));
        let edges: Vec<Edge> = pairs
            .filter_map(|(places, orders)| {
                let ([(_, a), (_, b)], [Some(order), Some(other)]) = (places, orders) else { return None };
                (are_neighbors(a, b) && order != other).then(|| Edge { sides: [*a, *b], order: order.clone() })
            })
            .collect();
        let close: Vec<[Place; 2]> = edges.into_par_iter().map(|edge| self.close_in(edge, work)).collect();
        (0..).zip(close.into_iter().flatten()).collect()
    }

    fn close_in(&self, Edge { sides: [mut near, mut far], order }: Edge, work: &Work<'_>) -> [Place; 2] {
        for _ in 0..HALVINGS {
            let middle = near.with(TILT, 0.5 * (near.shares[TILT] + far.shares[TILT]));
            let Some(found) = self.order(&middle, work) else { break };
            if found == order { near = middle } else { far = middle }
        }
        [near, far]
    }

    /// None of a drop that is not answered, or where no more are wanted.
    fn order(&self, place: &Place, work: &Work<'_>) -> Option<Order> {
        work.go_on(0).ok()?;
        let Followed { motion, .. } = self.follow(place, Until::Lands).ok()?;
        let pressed = motion.strikes.iter().zip(&motion.presses);
        let mut events: Vec<(f64, usize, bool)> = pressed
            .flat_map(|(strike, press)| [(press.from_s, strike.point, false), (press.until_s, strike.point, true)])
            .collect();
        events.sort_by(|a, b| a.0.total_cmp(&b.0));
        Some(events.into_iter().take(EVENTS).map(|(_, point, parts)| (point, parts)).collect())
    }
}

/// Whether two drops of the grid differ by their tilt alone.
fn are_neighbors(a: &Place, b: &Place) -> bool {
    let same = |axis: usize| axis == TILT || a.shares[axis].to_bits() == b.shares[axis].to_bits();
    a.first == b.first && a.flat == b.flat && !a.flat && (0..AXES).all(same)
}
