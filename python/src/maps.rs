//! This module computes one quantity over a grid of bars.

use clatter::{Axis, Quantity};
use clatter_answer::map as map_of;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;

use crate::answered::Drawing;
use crate::{refused, work};

/// The first value, the last value and the number of values.
type Span = (f64, f64, usize);
/// Values of the inertia, of e, and of the quantity, with their picture.
type Made<'py> = (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>, Bound<'py, PyArray2<f64>>, Drawing);

/// The largest number of points of a map: a gigabyte.
const MOST: usize = 1 << 27;

#[pyfunction]
#[pyo3(signature = (quantity, e, q=None, gyration_ratio=None, threshold=None))]
pub(crate) fn map<'py>(
    py: Python<'py>,
    quantity: &str,
    e: Span,
    q: Option<Span>,
    gyration_ratio: Option<Span>,
    threshold: Option<f64>,
) -> PyResult<Made<'py>> {
    let quantity = match (quantity, threshold) {
        ("zone", Some(threshold)) => Quantity::Zone(threshold),
        ("zone", None) => return Err(refused("zone needs a threshold, in v0")),
        (_, Some(_)) => return Err(refused("threshold goes with the quantity zone alone")),
        ("impacts", None) => Quantity::Impacts,
        ("peak-end", None) => Quantity::PeakEnd,
        ("peak-center", None) => Quantity::PeakCenter,
        ("peak-angular", None) => Quantity::PeakAngular,
        ("net-center", None) => Quantity::NetCenter,
        ("duration", None) => Quantity::Duration,
        _ => {
            return Err(refused(format!(
                "quantity = '{quantity}' is none: impacts, peak-end, peak-center, peak-angular, net-center, duration, zone"
            )));
        }
    };
    let inertia = match (q, gyration_ratio) {
        (Some((lo, hi, n)), None) => Axis::q(lo, hi, n),
        (None, Some((lo, hi, n))) => Axis::gyration_ratio(lo, hi, n),
        _ => return Err(refused("a map needs one of q and gyration_ratio")),
    };
    let (inertia, e) = (inertia.map_err(refused)?, Axis::e(e.0, e.1, e.2).map_err(refused)?);
    let points = inertia.points().saturating_mul(e.points());
    if points > MOST {
        return Err(refused(format!("{points} points are too many: a map has {MOST} at most")));
    }
    let question = map_of::Question::new(quantity, inertia, e);
    let map = work::done(py, move |_| map_of::answer(&question).map(|answer| answer.map))?.map_err(refused)?;
    let axis = |axis: Axis| (0..axis.points()).map(|i| axis.value(i)).collect::<Vec<_>>().into_pyarray(py);
    let values = map.values.clone().into_pyarray(py).reshape([inertia.points(), e.points()])?;
    Ok((axis(inertia), axis(e), values, Drawing::new(move || clatter_figures::map(&map))))
}
