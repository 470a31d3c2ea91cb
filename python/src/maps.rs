//! This module computes one quantity over a grid of bars.

use clatter::{Axis, Quantity};
use clatter_answer::map as map_of;
use numpy::{IntoPyArray, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::answered::Drawing;
use crate::given::{Given, Value, one_of, parts, whole};
use crate::{refused, work};

/// The first value, the last value and the number of values.
#[derive(Debug)]
struct Span(f64, f64, usize);

impl Value for Span {
    fn read(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        let [lo, hi, n] = parts(name, value, "(lo, hi, n)")?;
        let count = whole(&format!("n of {name}"), &n, 0..=1 << 53)?;
        Ok(Self(f64::read(name, &lo)?, f64::read(name, &hi)?, count))
    }
}

/// The largest number of points of a map: its values and their picture take a gigabyte, as in the command.
const MOST: usize = 1 << 26;

/// Reads the quantity of a map.
fn quantity(given: &Given<'_>) -> PyResult<Quantity> {
    let threshold: Option<f64> = given.read("threshold")?;
    let all = [
        ("impacts", Quantity::Impacts),
        ("peak-end", Quantity::PeakEnd),
        ("peak-center", Quantity::PeakCenter),
        ("peak-angular", Quantity::PeakAngular),
        ("net-center", Quantity::NetCenter),
        ("duration", Quantity::Duration),
        ("zone", Quantity::Zone(threshold.unwrap_or_default())),
    ];
    let quantity = one_of("quantity", &given.value("quantity")?, &all, ", ")?;
    match (quantity, threshold) {
        (Quantity::Zone(_), None) => Err(refused("zone needs a threshold, in v0")),
        (Quantity::Zone(_), Some(_)) | (_, None) => Ok(quantity),
        (_, Some(_)) => Err(refused("threshold goes with the quantity zone alone")),
    }
}

/// Returns values of the inertia, of e, and of the quantity, with their picture.
#[pyfunction]
pub(crate) fn map<'py>(py: Python<'py>, given: Given<'py>) -> PyResult<(Bound<'py, PyDict>, Drawing)> {
    let quantity = quantity(&given)?;
    let (q, gyration_ratio, e) = (given.read("q")?, given.read("gyration_ratio")?, given.read::<Span>("e")?);
    given.done()?;
    let (name, inertia) = match (q, gyration_ratio) {
        (Some(Span(lo, hi, n)), None) => ("q", Axis::q(lo, hi, n)),
        (None, Some(Span(lo, hi, n))) => ("gyration_ratio", Axis::gyration_ratio(lo, hi, n)),
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
    let made = PyDict::new(py);
    made.set_item(name, axis(inertia))?;
    made.set_item("e", axis(e))?;
    made.set_item("values", map.values.clone().into_pyarray(py).reshape([inertia.points(), e.points()])?)?;
    Ok((made, Drawing::new(move || clatter_figures::map(&map))))
}
