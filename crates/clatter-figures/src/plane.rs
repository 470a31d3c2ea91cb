//! The design plane: e to the right, q upward.

use crate::axis::Axis;
use crate::chart::Axes;
use crate::style::Pt;

/// Returns the plane as a chart, e to the right and q upward.
#[must_use]
pub fn plane_axes(corner: Pt, side: f64) -> Axes<'static> {
    Axes {
        corner,
        size: [side; 2],
        x: Axis::linear(0.0, 1.0, "coefficient of restitution *e*"),
        y: Axis::linear(0.0, 1.0, "inertia ratio *q*"),
    }
}

/// Returns a share in per cent.
#[must_use]
pub fn percent(share: f64) -> String {
    let text = format!("{:.1}", 100.0 * share);
    format!("{} %", text.trim_end_matches('0').trim_end_matches('.'))
}
