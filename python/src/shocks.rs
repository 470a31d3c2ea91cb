//! This module makes pulses, and computes the response of a part to them, to velocity shocks, to a bar and to a drop.

use clatter_answer::respond::{self as respond_of, Excitation, drop as drop_of};
use clatter_answer::shape_name;
use clatter_product::{Axis, Model};
use clatter_shock::{Pulses, Shape, Suspension};
use pyo3::prelude::*;

use crate::answered::{Answered, json};
use crate::bodies::{Body, Piece, Ratio, damping, model, start};
use crate::drops::Inputs;
use crate::records::velocity_shocks;
use crate::{refused, work};

/// A pulse of acceleration.
#[pyclass(frozen, module = "clatter._clatter", name = "PulseData")]
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pulse(pub(crate) clatter_shock::Pulse);

/// The length of a ramp of a trapezoid without given ramps, over the length of the trapezoid.
const RAMP: f64 = 0.1;

/// Finds a shape by its name.
pub(crate) fn shape(name: &str) -> PyResult<Shape> {
    let all = [
        Shape::HalfSine,
        Shape::Haversine,
        Shape::Triangle,
        Shape::InitialPeakSawtooth,
        Shape::TerminalPeakSawtooth,
        Shape::Rectangle,
    ];
    if let Some(shape) = all.into_iter().find(|shape| shape_name(*shape) == name) {
        return Ok(shape);
    }
    let ramp = match name.split_once(':') {
        None if name == "trapezoid" => Some(RAMP),
        Some(("trapezoid", ramp)) => ramp.parse().ok(),
        _ => None,
    };
    ramp.map(|ramp| Shape::Trapezoid { ramp }).ok_or_else(|| {
        let names = all.map(shape_name).join(", ");
        refused(format!("'{name}' is no shape; there are {names}, trapezoid and trapezoid:RAMP"))
    })
}

#[pymethods]
impl Pulse {
    #[new]
    fn new(shape_name: &str, amplitude_m_s2: f64, duration_s: f64, start_s: f64) -> PyResult<Self> {
        let shape = shape(shape_name)?;
        let pulse = clatter_shock::Pulse { shape, amplitude: amplitude_m_s2, duration: duration_s, start: start_s };
        Pulses::new(&[pulse]).map_err(refused)?;
        Ok(Self(pulse))
    }

    /// Makes the pulse of a standard, by its keyword.
    #[staticmethod]
    fn of_standard(keyword: &str) -> PyResult<Self> {
        let standard = clatter_shock::standard_pulse(keyword);
        let standard =
            standard.ok_or_else(|| refused(format!("'{keyword}' is no pulse of a standard that is known")))?;
        Ok(Self(standard.pulse()))
    }

    #[getter]
    fn shape(&self) -> String {
        shape_name(self.0.shape)
    }
    #[getter]
    fn amplitude_m_s2(&self) -> f64 {
        self.0.amplitude
    }
    #[getter]
    fn duration_s(&self) -> f64 {
        self.0.duration
    }
    #[getter]
    fn start_s(&self) -> f64 {
        self.0.start
    }
    #[getter]
    fn velocity_change_m_s(&self) -> f64 {
        self.0.velocity_change()
    }
}

/// The source of the shocks on a part, other than a bar.
#[derive(FromPyObject)]
pub(crate) enum Shaken {
    Pulses(Vec<Py<Pulse>>),
    Shocks(Vec<(f64, f64)>),
}

#[pyfunction]
pub(crate) fn respond(
    py: Python<'_>,
    shaken: Option<Shaken>,
    e: Option<f64>,
    q: Option<f64>,
    gyration_ratio: Option<f64>,
    center_of_mass: Option<f64>,
    masses: Option<Vec<Piece>>,
    velocity: Option<Vec<f64>>,
    height_gap: Option<f64>,
    at: Option<f64>,
    omega: f64,
    damping_ratio: Option<f64>,
    q_factor: Option<f64>,
) -> PyResult<Answered> {
    let excitation = match (shaken, e, at) {
        (Some(Shaken::Pulses(pulses)), ..) => Excitation::Pulses(pulses.iter().map(|pulse| pulse.get().0).collect()),
        (Some(Shaken::Shocks(shocks)), ..) => Excitation::Shocks(velocity_shocks(shocks)?),
        (None, Some(e), Some(at)) => {
            let [k, c] = [gyration_ratio, center_of_mass].map(|value| value.map(Ratio::Bar));
            let bar = Body::new(e, q, k, c, masses)?.bar("respond")?;
            Excitation::Bar { bar, start: start(velocity, height_gap.map(Ratio::Bar))?, at }
        }
        _ => return Err(refused("pulses, shocks, or e and at of a bar say what shakes the part")),
    };
    let suspension = Suspension::new(omega, damping(damping_ratio, q_factor)?).map_err(refused)?;
    let told = work::done(py, move |_| {
        let answer = respond_of::answer(&respond_of::Question::new(excitation, suspension));
        json(&answer.map_err(|error| error.to_string())?)
    });
    Ok((told?.map_err(refused)?, None))
}

#[pyfunction]
pub(crate) fn respond_drop(
    py: Python<'_>,
    inputs: Inputs,
    model_name: Option<&str>,
    at: Vec<f64>,
    axis: Option<&str>,
    frequency_hz: Option<f64>,
    damping_ratio: Option<f64>,
    q_factor: Option<f64>,
    tolerance: f64,
) -> PyResult<Answered> {
    let model = model_name.map_or(Ok(Model::Compliant), model)?;
    let drop = inputs.drop(model)?;
    let place = drop_of::place(&drop, &at, Axis::of(axis.unwrap_or("z"))).map_err(refused)?;
    let mut question = drop_of::Question::new(drop, model, place);
    let suspension = frequency_hz.map(|hz| Suspension::from_hz(hz, damping(damping_ratio, q_factor)?).map_err(refused));
    (question.suspension, question.tolerance) = (suspension.transpose()?, tolerance);
    let told = work::done(py, move |_| json(&drop_of::answer(&question).map_err(|error| error.to_string())?));
    Ok((told?.map_err(refused)?, None))
}
