//! This module answers many bars, plates and boxes at once: each row of the arrays is a question.

use std::fmt::Display;

use clatter::{Bar, Count, End, Error, PeakImpact, Plate, PlateCount, PlateStart, Start};
use clatter_answer::{DropInputs, simulate, zone};
use clatter_product::Model;
use numpy::{IntoPyArray, PyArrayMethods, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::prelude::*;

use crate::given::{Given, Value};
use crate::refused;
use crate::work::{self, Wanted};

/// The largest number of elements of one call: the arrays of an answer, twelve at most, take a gigabyte.
pub(crate) const MOST: usize = 10_000_000;

/// A column of numbers: one for all rows, or one for each.
#[derive(Debug, Clone)]
pub(crate) struct Column(pub(crate) Vec<f64>);

impl Value for Column {
    fn read(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        if value.is_none() {
            return Err(refused(format!("{name} is not given")));
        }
        let array: PyReadonlyArray1<'_, f64> = value.extract()?;
        // This is a copy: others may write to the array while this works on it.
        Ok(Self(array.as_slice()?.to_vec()))
    }
}

impl Column {
    fn at(&self, row: usize) -> f64 {
        if let [one] = self.0[..] { one } else { self.0[row] }
    }
}

/// Columns of one quantity, along several axes or at several points of the body.
#[derive(Debug, Clone)]
struct Columns<const N: usize>([Column; N]);

impl<const N: usize> Columns<N> {
    /// Reads the columns whose names end in these letters.
    fn read(given: &Given<'_>, name: &str, letters: [char; N]) -> PyResult<Self> {
        let columns = letters.iter().map(|letter| given.read(&format!("{name}_{letter}")));
        let columns: Vec<Column> = columns.collect::<PyResult<_>>()?;
        columns.try_into().map(Self).map_err(|_| refused(format!("{name} takes {N} arrays")))
    }
    fn at(&self, row: usize) -> [f64; N] {
        std::array::from_fn(|i| self.0[i].at(row))
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

/// Returns columns with these names, with the work shared by all threads; the first refused row is reported with its place.
fn answer<'py, const N: usize, E: Display + Send>(
    py: Python<'py>,
    shape: Vec<usize>,
    names: &str,
    row: impl Fn(usize) -> Result<[f64; N], E> + Send + Sync + 'static,
) -> PyResult<Bound<'py, PyDict>> {
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
                columns.iter_mut().zip(values).for_each(|(column, value)| column.push(value + 0.0));
            }
        }
        Ok::<_, String>(columns)
    };
    named(py, names, work::done(py, all)?.map_err(refused)?)
}

/// Returns columns with their names, which blanks part.
pub(crate) fn named<'py, const N: usize>(
    py: Python<'py>,
    names: &str,
    columns: [Vec<f64>; N],
) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (name, column) in names.split(' ').zip(columns) {
        dict.set_item(name, column.into_pyarray(py))?;
    }
    Ok(dict)
}

/// Bars, with their inertia given in one way.
struct Bars {
    q: Option<Column>,
    gyration_ratio: Option<Column>,
    center_of_mass: Option<Column>,
    e: Column,
}

impl Bars {
    fn read(given: &Given<'_>) -> PyResult<Self> {
        let (q, gyration_ratio) = (given.read::<Option<_>>("q")?, given.read::<Option<_>>("gyration_ratio")?);
        let center_of_mass = given.read::<Option<_>>("center_of_mass")?;
        if q.is_some() == gyration_ratio.is_some() {
            return Err(refused("one of q and gyration_ratio says how the mass lies"));
        }
        if q.is_some() && center_of_mass.is_some() {
            return Err(refused("center_of_mass goes with gyration_ratio"));
        }
        Ok(Self { q, gyration_ratio, center_of_mass, e: given.read("e")? })
    }
    fn at(&self, row: usize) -> Result<Bar, Error> {
        let of = |column: &Option<Column>| column.as_ref().map(|column| column.at(row));
        let (gyration_ratio, e) = (of(&self.gyration_ratio).unwrap_or(f64::NAN), self.e.at(row));
        match (of(&self.q), of(&self.center_of_mass)) {
            (Some(q), _) => Bar::new(q, e),
            (None, None) => Bar::from_gyration_ratio(gyration_ratio, e),
            (None, Some(center)) => Bar::from_center_of_mass(center, gyration_ratio, e),
        }
    }
}

/// Bars and how they fall.
struct Falling {
    bars: Bars,
    velocity: Columns<2>,
    height_gap: Column,
}

impl Falling {
    fn read(given: &Given<'_>) -> PyResult<Self> {
        let velocity = Columns::read(given, "velocity", ['a', 'b'])?;
        Ok(Self { bars: Bars::read(given)?, velocity, height_gap: given.read("height_gap")? })
    }
    fn at(&self, row: usize) -> Result<(Bar, Start), Error> {
        Ok((self.bars.at(row)?, Start::new(self.velocity.at(row), self.height_gap.at(row))?))
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
pub(crate) fn bars<'py>(py: Python<'py>, shape: Vec<usize>, given: Given<'py>) -> PyResult<Bound<'py, PyDict>> {
    let all = Falling::read(&given)?;
    given.done()?;
    let row = move |i| {
        let (bar, start) = all.at(i)?;
        let of = bar.summary(&start);
        #[expect(clippy::cast_precision_loss, reason = "impacts beyond 2^53 are the nearest float")]
        let impact = match of.peak.impact {
            PeakImpact::Number(n) => n as f64,
            PeakImpact::Huge(n) => n,
            PeakImpact::Limit => f64::INFINITY,
        };
        let (end, center, angular) = (of.peak.end, of.peak.center, of.peak.angular);
        let net = of.net.map_or([f64::NAN, f64::NAN, 0.0, f64::NAN], |net| [net.a, net.b, net.center, net.angular]);
        let ([net_a, net_b, net_center, net_angular], [a, b]) = (net, of.final_velocity.unwrap_or([f64::NAN; 2]));
        let count = count(of.count);
        Ok::<_, Error>([count, of.duration, end, impact, center, angular, net_a, net_b, net_center, net_angular, a, b])
    };
    let names = "count duration peak_end peak_impact peak_center peak_angular net_a net_b net_center net_angular \
        final_a final_b";
    answer(py, shape, names, row)
}

#[pyfunction]
pub(crate) fn zones<'py>(py: Python<'py>, shape: Vec<usize>, given: Given<'py>) -> PyResult<Bound<'py, PyDict>> {
    let (bars, threshold) = (Bars::read(&given)?, given.read::<Column>("threshold")?);
    given.done()?;
    let row = move |i| {
        let (bar, threshold) = (bars.at(i)?, threshold.at(i));
        let s = zone::answer(&zone::Question::new(bar, vec![threshold]))?.zones[0].s.0;
        let shocks = bar.shocks_either(&Start::default());
        let [from, to] = shocks.safe_interval(threshold).unwrap_or([f64::NAN; 2]);
        Ok::<_, Error>([s, from, to])
    };
    answer(py, shape, "s lower upper", row)
}

#[pyfunction]
pub(crate) fn shocks<'py>(py: Python<'py>, shape: Vec<usize>, given: Given<'py>) -> PyResult<Bound<'py, PyDict>> {
    let (all, at) = (Falling::read(&given)?, given.read::<Column>("at")?);
    let first: Option<End> = given.read("first")?;
    given.done()?;
    let row = move |i| {
        let ((bar, start), s) = (all.at(i)?, at.at(i));
        if !(-1.0..=1.0).contains(&s) {
            return Err(Error::Quantity { name: "position", value: s, allowed: "in [-1, 1]" });
        }
        let shocks = first.map_or_else(|| bar.shocks_either(&start), |first| bar.shocks(&start, first));
        Ok([shocks.at(s)])
    };
    answer(py, shape, "shock", row)
}

#[pyfunction]
pub(crate) fn trains<'py>(py: Python<'py>, shape: Vec<usize>, given: Given<'py>) -> PyResult<Bound<'py, PyDict>> {
    const NAMES: [&str; 4] = ["time", "approach", "delta_v_a", "delta_v_b"];
    let (all, limit) = (Falling::read(&given)?, given.whole::<usize>("limit", 1..=1 << 31)?);
    given.done()?;
    let rows: usize = shape.iter().product();
    let size = NAMES.len() * rows * limit;
    if size > MOST {
        return Err(refused(format!("{size} elements in one call; it takes {MOST}: ask in pieces")));
    }
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
    let dict = PyDict::new(py);
    for (name, column) in NAMES.into_iter().zip(work::done(py, whole)?.map_err(refused)?) {
        dict.set_item(name, column.into_pyarray(py).reshape([rows, limit])?)?;
    }
    Ok(dict)
}

#[pyfunction]
pub(crate) fn plates<'py>(py: Python<'py>, shape: Vec<usize>, given: Given<'py>) -> PyResult<Bound<'py, PyDict>> {
    let gyration_ratio = Columns::read(&given, "gyration_ratio", ['x', 'y'])?;
    let center_of_mass = Columns::read(&given, "center_of_mass", ['x', 'y'])?;
    let height_gap = Columns::read(&given, "height_gap", ['x', 'y'])?;
    let velocity = Columns::read(&given, "velocity", ['a', 'b', 'd'])?;
    let (e, limit) = (given.read::<Column>("e")?, given.whole("limit", 1..=1 << 31)?);
    given.done()?;
    let row = move |i| {
        let plate = Plate::off_center(gyration_ratio.at(i), center_of_mass.at(i), e.at(i))?;
        let of = plate.summary(&PlateStart::new(velocity.at(i), height_gap.at(i))?, limit);
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
        Ok::<_, Error>([count, exact, of.duration, corner, impact, center, later, a, b, c, d])
    };
    let names = "count count_exact duration peak_corner peak_impact peak_center peak_later final_a final_b \
        final_c final_d";
    answer(py, shape, names, row)
}

#[pyfunction]
pub(crate) fn boxes<'py>(py: Python<'py>, shape: Vec<usize>, given: Given<'py>) -> PyResult<Bound<'py, PyDict>> {
    let axes = |name| Columns::read(&given, name, ['x', 'y', 'z']);
    let (gyration, center, spin) = (axes("gyration_m")?, axes("center_of_mass_m")?, axes("spin_rad_s")?);
    let orientation = Columns::read(&given, "orientation", ['w', 'x', 'y', 'z'])?;
    let column = |name| given.read::<Column>(name);
    let (length, width, thickness) = (column("length_m")?, column("width_m")?, column("thickness_m")?);
    let (e, speed, gravity) = (column("e")?, column("speed_m_s")?, column("gravity_m_s2")?);
    let (contact_time, law) = (column("contact_time_s")?, given.read("contact_law")?);
    let friction = column("friction")?;
    given.done()?;
    let row = move |i| {
        let inputs = DropInputs {
            length_m: Some(length.at(i)),
            width_m: Some(width.at(i)),
            thickness_m: Some(thickness.at(i)),
            gyration_m: Some(gyration.at(i).to_vec()),
            center_of_mass_m: Some(center.at(i)),
            orientation: Some(orientation.at(i)),
            spin_rad_s: Some(spin.at(i).to_vec()),
            e: Some(e.at(i)),
            speed_m_s: Some(speed.at(i)),
            gravity_m_s2: Some(gravity.at(i)),
            contact_time_s: Some(contact_time.at(i)),
            contact_law: Some(law),
            friction: Some(friction.at(i)),
            ..DropInputs::default()
        };
        let question = simulate::Question::new(inputs.drop(Model::Compliant)?, Model::Compliant);
        let answer = simulate::answer(&question)?;
        let largest = answer.impacts.iter().map(|impact| impact.largest_m_s()).fold(0.0, f64::max);
        #[expect(clippy::cast_precision_loss, reason = "a small number")]
        let count = answer.impacts.train().count() as f64;
        let at_rest = if answer.stop.reason() == "at-rest" { 1.0 } else { 0.0 };
        Ok::<_, clatter_answer::Error>([
            count,
            largest,
            answer.stop.time_s(),
            at_rest,
            answer.energy_error.map_or(f64::NAN, |error| error.0),
        ])
    };
    let names = "count largest_delta_v_m_s stop_time_s at_rest energy_error";
    answer(py, shape, names, row)
}
