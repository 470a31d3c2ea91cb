//! This module answers many bars, plates and boxes at once: each row of the arrays is a question.

use std::fmt::Display;

use clatter::{Count, End, Error, PeakImpact, Plate, PlateCount, PlateStart, Start};
use clatter_answer::{DropInputs, simulate};
use clatter_product::Model;
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::prelude::*;

use crate::bodies::{self, bar_of};
use crate::work::{self, Wanted};
use crate::{refused, single};

/// A column of numbers: one for all rows, or one for each.
#[derive(Debug, Clone)]
pub(crate) struct Column(Vec<f64>);

impl<'py> FromPyObject<'_, 'py> for Column {
    type Error = PyErr;
    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let array: PyReadonlyArray1<'py, f64> = object.extract()?;
        // This is a copy: others may write to the array while this works on it.
        Ok(Self(array.as_slice()?.to_vec()))
    }
}

impl Column {
    fn at(&self, row: usize) -> f64 {
        if let [one] = self.0[..] { one } else { self.0[row] }
    }
}

/// Describes where a row is in the given arrays.
fn place(mut row: usize, shape: &[usize]) -> String {
    if shape.is_empty() {
        return String::new();
    }
    let mut index: Vec<String> = shape
        .iter()
        .rev()
        .map(|size| {
            let at = row % size;
            row /= size;
            at.to_string()
        })
        .collect();
    index.reverse();
    format!("at [{}]: ", index.join(", "))
}

/// The number of rows that are worked on between two looks at errors.
const BLOCK: usize = 1 << 14;

/// Returns as many columns as `row` gives numbers, with the work shared by all threads; the first refused row is reported with its place.
fn columns<const N: usize, E: Display + Send>(
    py: Python<'_>,
    shape: Vec<usize>,
    row: impl Fn(usize) -> Result<[f64; N], E> + Send + Sync + 'static,
) -> PyResult<[Vec<f64>; N]> {
    let rows: usize = shape.iter().product();
    let all = move |wanted: &Wanted| {
        let mut columns: [Vec<f64>; N] = std::array::from_fn(|_| Vec::with_capacity(rows));
        for from in (0..rows).step_by(BLOCK) {
            let one = |i| {
                wanted.or_leave();
                row(i)
            };
            let block: Vec<_> = (from..rows.min(from + BLOCK)).into_par_iter().map(one).collect();
            for (i, values) in block.into_iter().enumerate() {
                let values = values.map_err(|error| format!("{}{error}", place(from + i, &shape)))?;
                columns.iter_mut().zip(values).for_each(|(column, value)| column.push(value));
            }
        }
        Ok::<_, String>(columns)
    };
    work::done(py, all)?.map_err(refused)
}

/// Returns columns with their names.
fn named<'py, const N: usize>(
    py: Python<'py>,
    names: [&str; N],
    columns: [Vec<f64>; N],
) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (name, column) in names.into_iter().zip(columns) {
        dict.set_item(name, column.into_pyarray(py))?;
    }
    Ok(dict)
}

/// Bars and how they fall.
struct Bars {
    q: Option<Column>,
    gyration_ratio: Option<Column>,
    center_of_mass: Option<Column>,
    e: Column,
    velocity: [Column; 2],
    height_gap: Column,
}

impl Bars {
    fn at(&self, row: usize) -> Result<(clatter::Bar, Start), Error> {
        let of = |column: &Option<Column>| column.as_ref().map(|column| column.at(row));
        let bar = bar_of(of(&self.q), of(&self.gyration_ratio), of(&self.center_of_mass), self.e.at(row))?;
        let [a, b] = &self.velocity;
        Ok((bar, Start::new([a.at(row), b.at(row)], self.height_gap.at(row))?))
    }
}

#[expect(clippy::cast_precision_loss, reason = "counts beyond 2^53 are the nearest float")]
fn count(count: Count) -> f64 {
    match count {
        Count::Finite(n) => n as f64,
        Count::Huge(n) => n,
        Count::Endless => f64::INFINITY,
    }
}

#[pyfunction]
pub(crate) fn bars(
    py: Python<'_>,
    shape: Vec<usize>,
    q: Option<Column>,
    gyration_ratio: Option<Column>,
    center_of_mass: Option<Column>,
    e: Column,
    velocity: [Column; 2],
    height_gap: Column,
) -> PyResult<Bound<'_, PyDict>> {
    let all = Bars { q, gyration_ratio, center_of_mass, e, velocity, height_gap };
    let row = move |i| {
        let (bar, start) = all.at(i)?;
        let of = bar.summary(&start);
        #[expect(clippy::cast_precision_loss, reason = "impacts beyond 2^53 are the nearest float")]
        let impact = match of.peak.impact {
            PeakImpact::Number(n) => n as f64,
            PeakImpact::Huge(n) => n,
            PeakImpact::Limit => f64::INFINITY,
        };
        let [final_a, final_b] = of.final_velocity.unwrap_or([f64::NAN; 2]);
        let net = of.net.map_or([f64::NAN, f64::NAN, 0.0, f64::NAN], |net| [net.a, net.b, net.center, net.angular]);
        let peak = [of.peak.end, impact, of.peak.center, of.peak.angular];
        let [end, impact, center, angular] = peak;
        let [net_a, net_b, net_center, net_angular] = net;
        let values = [count(of.count), of.duration, end, impact, center, angular];
        let after = [net_a, net_b, net_center, net_angular, final_a, final_b];
        let mut row = [0.0; 12];
        row[..6].copy_from_slice(&values);
        row[6..].copy_from_slice(&after);
        Ok::<_, Error>(row.map(|x| x + 0.0))
    };
    let names = [
        "count",
        "duration",
        "peak_end",
        "peak_impact",
        "peak_center",
        "peak_angular",
        "net_a",
        "net_b",
        "net_center",
        "net_angular",
        "final_a",
        "final_b",
    ];
    named(py, names, columns(py, shape, row)?)
}

#[pyfunction]
pub(crate) fn zones(
    py: Python<'_>,
    shape: Vec<usize>,
    q: Option<Column>,
    gyration_ratio: Option<Column>,
    center_of_mass: Option<Column>,
    e: Column,
    threshold: Column,
) -> PyResult<Bound<'_, PyDict>> {
    let row = move |i| {
        let of = |column: &Option<Column>| column.as_ref().map(|column| column.at(i));
        let bar = bar_of(of(&q), of(&gyration_ratio), of(&center_of_mass), e.at(i))?;
        let question = clatter_answer::zone::Question::new(bar, vec![threshold.at(i)]);
        let s = clatter_answer::zone::answer(&question)?.zones[0].s.0;
        let shocks = bar.shocks_either(&Start::default());
        let [from, to] = shocks.safe_interval(threshold.at(i)).unwrap_or([f64::NAN; 2]);
        Ok::<_, Error>([s, from, to].map(|x| x + 0.0))
    };
    named(py, ["s", "lower", "upper"], columns(py, shape, row)?)
}

#[pyfunction]
pub(crate) fn shocks<'py>(
    py: Python<'py>,
    shape: Vec<usize>,
    q: Option<Column>,
    gyration_ratio: Option<Column>,
    center_of_mass: Option<Column>,
    e: Column,
    velocity: [Column; 2],
    height_gap: Column,
    at: Column,
    first: Option<&str>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let first: Option<End> = first.map(single::end).transpose()?;
    let all = Bars { q, gyration_ratio, center_of_mass, e, velocity, height_gap };
    let row = move |i| {
        let (bar, start) = all.at(i)?;
        let s = at.at(i);
        if !(-1.0..=1.0).contains(&s) {
            return Err(Error::Quantity { name: "position", value: s, allowed: "in [-1, 1]" });
        }
        let shocks = first.map_or_else(|| bar.shocks_either(&start), |first| bar.shocks(&start, first));
        Ok([shocks.at(s) + 0.0])
    };
    let [column] = columns(py, shape, row)?;
    Ok(column.into_pyarray(py))
}

#[pyfunction]
pub(crate) fn trains(
    py: Python<'_>,
    shape: Vec<usize>,
    q: Option<Column>,
    gyration_ratio: Option<Column>,
    center_of_mass: Option<Column>,
    e: Column,
    velocity: [Column; 2],
    height_gap: Column,
    limit: usize,
) -> PyResult<Bound<'_, PyDict>> {
    const NAMES: [&str; 4] = ["time", "approach", "delta_v_a", "delta_v_b"];
    let all = Bars { q, gyration_ratio, center_of_mass, e, velocity, height_gap };
    let rows: usize = shape.iter().product();
    let whole = move |wanted: &Wanted| {
        let mut columns: [Vec<f64>; NAMES.len()] = std::array::from_fn(|_| vec![f64::NAN; rows * limit]);
        for row in 0..rows {
            wanted.or_leave();
            let (bar, start) = all.at(row).map_err(|error| format!("{}{error}", place(row, &shape)))?;
            for (k, impact) in bar.train(&start).take(limit).enumerate() {
                if k.is_multiple_of(BLOCK) {
                    wanted.or_leave();
                }
                let [a, b] = impact.delta_v;
                let values = [impact.time, impact.approach, a, b];
                columns.iter_mut().zip(values).for_each(|(column, value)| column[row * limit + k] = value + 0.0);
            }
        }
        Ok::<_, String>(columns)
    };
    named(py, NAMES, work::done(py, whole)?.map_err(refused)?)
}

#[pyfunction]
pub(crate) fn plates(
    py: Python<'_>,
    shape: Vec<usize>,
    gyration_ratio: [Column; 2],
    center_of_mass: [Column; 2],
    e: Column,
    velocity: [Column; 3],
    height_gap: [Column; 2],
    limit: u64,
) -> PyResult<Bound<'_, PyDict>> {
    let row = move |i| {
        let pair = |columns: &[Column; 2]| [columns[0].at(i), columns[1].at(i)];
        let plate = Plate::off_center(pair(&gyration_ratio), pair(&center_of_mass), e.at(i))?;
        let velocity = [velocity[0].at(i), velocity[1].at(i), velocity[2].at(i)];
        let of = plate.summary(&PlateStart::new(velocity, pair(&height_gap))?, limit);
        #[expect(clippy::cast_precision_loss, reason = "counts beyond 2^53 are the nearest float")]
        let (count, exact) = match of.count {
            PlateCount::Finite(n) => (n as f64, 1.0),
            PlateCount::MoreThan(n) => (n as f64, 0.0),
            _ => (f64::INFINITY, 1.0),
        };
        #[expect(clippy::cast_precision_loss, reason = "below the limit")]
        let impact = of.peak.impact as f64;
        let [a, b, c, d] = of.final_velocity.unwrap_or([f64::NAN; 4]);
        let [corner, center, later] = [of.peak.corner, of.peak.center, of.peak.later];
        Ok::<_, Error>([count, exact, of.duration, corner, impact, center, later, a, b, c, d].map(|x| x + 0.0))
    };
    let names = [
        "count",
        "count_exact",
        "duration",
        "peak_corner",
        "peak_impact",
        "peak_center",
        "peak_later",
        "final_a",
        "final_b",
        "final_c",
        "final_d",
    ];
    named(py, names, columns(py, shape, row)?)
}

#[pyfunction]
pub(crate) fn boxes<'py>(
    py: Python<'py>,
    shape: Vec<usize>,
    size_m: [Column; 3],
    gyration_m: [Column; 3],
    center_of_mass_m: [Column; 3],
    orientation: [Column; 4],
    spin_rad_s: [Column; 3],
    e: Column,
    speed_m_s: Column,
    gravity_m_s2: Column,
    contact_time_s: Column,
    contact_law: &str,
) -> PyResult<Bound<'py, PyDict>> {
    let law = bodies::law(contact_law)?;
    let row = move |i| {
        let triple = |columns: &[Column; 3]| [columns[0].at(i), columns[1].at(i), columns[2].at(i)];
        let [length_m, width_m, thickness_m] = triple(&size_m).map(Some);
        let inputs = DropInputs {
            length_m,
            width_m,
            thickness_m,
            gyration_m: Some(triple(&gyration_m).to_vec()),
            center_of_mass_m: Some(triple(&center_of_mass_m)),
            orientation: Some(std::array::from_fn(|k| orientation[k].at(i))),
            spin_rad_s: Some(triple(&spin_rad_s).to_vec()),
            e: Some(e.at(i)),
            speed_m_s: Some(speed_m_s.at(i)),
            gravity_m_s2: Some(gravity_m_s2.at(i)),
            contact_time_s: Some(contact_time_s.at(i)),
            contact_law: Some(law),
            ..DropInputs::default()
        };
        let question = simulate::Question::new(inputs.drop(Model::Compliant)?, Model::Compliant);
        let simulate::Answer::Block(answer) = simulate::answer(&question)? else { return Ok([f64::NAN; 5]) };
        let largest = answer.impacts.iter().map(simulate::block::Impact::largest_m_s).fold(0.0, f64::max);
        #[expect(clippy::cast_precision_loss, reason = "a small number")]
        let count = answer.impacts.len() as f64;
        let at_rest = if answer.stop.reason() == "at-rest" { 1.0 } else { 0.0 };
        Ok::<_, clatter_answer::Error>([count, largest, answer.stop.time_s(), at_rest, answer.energy_error.0])
    };
    let names = ["count", "largest_delta_v_m_s", "stop_time_s", "at_rest", "energy_error"];
    named(py, names, columns(py, shape, row)?)
}
