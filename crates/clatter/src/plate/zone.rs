//! Peaks over the plate (Eq. 4 of a plate) and safe zones (Eq. 5 of a plate).
//!
//! All strikes at one corner shake the plate in the same proportions, so that only the largest of each corner counts. With
//! S_j the largest shock of corner j in its own strikes, and w_j of the module above,
//!
//! ```text
//! Δv_max(x, y) = max_j S_j |w_j(x, y)|/w_j(j)        safe within t:  |w_j(x, y)|/w_j(j) ≤ t/S_j for all j
//! ```
//!
//! Each condition is a strip, and where four strips and the plate meet is a convex polygon. For a centered plate that
//! may land on any corner first every S_j is J, the largest of all directions, and with α = 1/k_x², β = 1/k_y²,
//! μ = 1 + α + β
//!
//! ```text
//! Δv_max = J (1 + α|x| + β|y|)/μ        safe within t:  α|x| + β|y| ≤ μ t/J − 1, a rhombus cut by the edges
//! ```

use super::{Corner, Plate};
use crate::Extent;

/// The largest shocks everywhere on a plate: of one drop, or of drops in all directions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlateShocks {
    plate: Plate,
    struck: [f64; 4],
    later: f64,
}

/// The part of the plate where no shock exceeds a threshold.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PlateZone {
    /// Threshold of velocity shock, in v0.
    pub threshold: f64,
    /// The share of the plate that the polygon covers.
    pub extent: Extent,
    /// Corners of the safe zone in half-lengths and half-widths from the middle, counterclockwise; none where nothing is
    /// safe.
    pub polygon: Vec<[f64; 2]>,
    /// Share of the area of the plate.
    pub share: f64,
}

impl PlateShocks {
    pub(super) fn new(plate: &Plate, struck: [f64; 4], later: f64) -> Self {
        Self { plate: *plate, struck, later }
    }

    /// Returns the largest shocks of corners a, b, c and d in their own strikes, S_j; 0 for a corner that never
    /// strikes.
    #[must_use]
    pub fn struck(&self) -> [f64; 4] {
        self.struck
    }

    /// Returns a bound on the shock of a corner in strikes that were not followed; 0 where all were followed, or are
    /// known to be less.
    #[must_use]
    pub fn later(&self) -> f64 {
        self.later
    }

    /// Returns the largest velocity shock at the place (x, y) in [−1, 1]² (Eq. 4).
    #[must_use]
    pub fn at(&self, place: [f64; 2]) -> f64 {
        let of = |corner: Corner| self.plate.share(corner, place).abs() * self.struck[corner as usize];
        Corner::ALL.map(of).into_iter().fold(0.0, f64::max)
    }

    /// Returns the polygon where no shock exceeds `threshold` (Eq. 5), and its share of the plate.
    ///
    /// # Accuracy
    /// Corners of the polygon are exact to some ε of the crossing of two lines; a threshold of NaN has no zone.
    ///
    /// # Examples
    /// A plate may have a safe zone for half the drop speed where the bar that stands for it has none:
    /// ```
    /// use clatter::{Bar, Extent, Plate, Start};
    /// let plate = Plate::uniform(0.3)?.worst(40)?;
    /// assert_eq!(Bar::new(0.5, 0.3)?.shocks_either(&Start::default()).safe_zone(0.5).extent, Extent::None);
    /// assert_eq!(plate.safe_zone(0.5).extent, Extent::Part);
    /// # Ok::<(), clatter::Error>(())
    /// ```
    #[must_use]
    pub fn safe_zone(&self, threshold: f64) -> PlateZone {
        let square = Corner::ALL.map(Corner::position).to_vec();
        let inside = |corner: Corner, side: f64| {
            let [constant, along_x, along_y] = self.plate.share_form(corner);
            let ([sx, sy], most) = (self.plate.center, threshold / self.struck[corner as usize]);
            move |[x, y]: [f64; 2]| most - side * (constant + (along_x * (x - sx) + along_y * (y - sy)))
        };
        let struck = Corner::ALL.into_iter().filter(|corner| self.struck[*corner as usize] > 0.0);
        let sides = struck.flat_map(|corner| [inside(corner, 1.0), inside(corner, -1.0)]);
        let (mut polygon, mut whole) = (square, true);
        for inside in sides {
            whole &= polygon.iter().all(|place| inside(*place) >= 0.0);
            polygon = clipped(&polygon, inside);
        }
        let extent = match (polygon.is_empty(), whole) {
            (true, _) => Extent::None,
            (false, true) => Extent::Whole,
            (false, false) => Extent::Part,
        };
        let share = if whole { 1.0 } else { 0.25 * area(&polygon) };
        PlateZone { threshold, extent, polygon, share }
    }
}

/// Returns the part of a convex polygon on the side where a linear form is not negative.
fn clipped(polygon: &[[f64; 2]], form: impl Fn([f64; 2]) -> f64) -> Vec<[f64; 2]> {
    let mut rest = Vec::with_capacity(polygon.len() + 1);
    for (i, &to) in polygon.iter().enumerate() {
        let from = polygon[(i + polygon.len() - 1) % polygon.len()];
        let (at_from, at_to) = (form(from), form(to));
        if (at_from < 0.0 && at_to > 0.0) || (at_from > 0.0 && at_to < 0.0) {
            let part = at_from / (at_from - at_to);
            rest.push(std::array::from_fn(|k| from[k] + part * (to[k] - from[k])));
        }
        if at_to >= 0.0 {
            rest.push(to);
        }
    }
    rest
}

/// Returns the area of a polygon whose corners go around counterclockwise.
fn area(polygon: &[[f64; 2]]) -> f64 {
    let Some(&[x0, y0]) = polygon.first() else { return 0.0 };
    let fan = polygon.windows(2).map(|w| {
        let [[x1, y1], [x2, y2]] = [w[0], w[1]].map(|[x, y]| [x - x0, y - y0]);
        0.5 * (x1 * y2 - x2 * y1)
    });
    fan.sum::<f64>().max(0.0)
}
