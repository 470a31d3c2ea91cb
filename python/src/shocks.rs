//! This module makes pulses, and computes the response of a part to them, to velocity shocks, to a bar and to a drop.

use std::f64::consts::TAU;

use clatter_answer::respond::{self as respond_of, Excitation, drop as drop_of};
use clatter_answer::{DropInputs, shape_name};
use clatter_product::{Axis, Model};
use clatter_shock::{Pulses, Shape, Suspension, VelocityShock, VelocityShocks};
use pyo3::prelude::*;

use crate::answered::{Answered, json, without_picture};
use crate::bodies::{Body, Fall, damping, stop};
use crate::given::{Given, Value, several, wrong};
use crate::{drops, refused, words};

/// A pulse of acceleration.
#[pyclass(frozen, module = "clatter._clatter", name = "PulseData")]
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pulse(pub(crate) clatter_shock::Pulse);

/// The length of a ramp of a trapezoid without given ramps, over the length of the trapezoid.
const RAMP: f64 = 0.1;

impl Value for Shape {
    fn read(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        let all = [
            Self::HalfSine,
            Self::Haversine,
            Self::Triangle,
            Self::InitialPeakSawtooth,
            Self::TerminalPeakSawtooth,
            Self::Rectangle,
        ];
        let text = String::read(name, value)?;
        if let Some(shape) = all.into_iter().find(|shape| shape_name(*shape) == text) {
            return Ok(shape);
        }
        let ramp = match text.split_once(':') {
            None if text == "trapezoid" => Some(RAMP),
            Some(("trapezoid", ramp)) => ramp.parse().ok(),
            _ => None,
        };
        ramp.map(|ramp| Self::Trapezoid { ramp }).ok_or_else(|| {
            let names = all.map(shape_name).join(", ");
            refused(format!("'{text}' is no shape; there are {names}, trapezoid and trapezoid:RAMP"))
        })
    }
}

#[pymethods]
impl Pulse {
    #[new]
    fn new(given: Given<'_>) -> PyResult<Self> {
        let pulse = clatter_shock::Pulse {
            shape: given.read("shape")?,
            amplitude: given.read("amplitude_m_s2")?,
            duration: given.read("duration_s")?,
            start: given.read("start_s")?,
        };
        given.done()?;
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

impl Value for clatter_shock::Pulse {
    /// Reads the pulse that an object of Python holds.
    fn read(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        let data = value.getattr("_data").and_then(|data| Ok(data.extract::<Py<Pulse>>()?));
        data.map(|data| data.get().0).map_err(|_| wrong(name, value, "a Pulse"))
    }
}

impl Value for Vec<clatter_shock::Pulse> {
    fn read(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        let pulses = several(name, value, &[])?.iter().map(|one| Value::read(name, one)).collect::<PyResult<Self>>();
        let none = || refused(format!("{name} is a Pulse or a list of them"));
        pulses.ok().filter(|pulses| !pulses.is_empty()).ok_or_else(none)
    }
}

impl Value for VelocityShocks {
    /// Reads times and changes of velocity.
    fn read(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        let shocks = Vec::<[f64; 2]>::read(name, value)?;
        if shocks.is_empty() {
            return Err(refused(format!("{name} is empty")));
        }
        let shocks = shocks.into_iter().map(|[time, delta_v]| VelocityShock { time, delta_v }).collect();
        Self::new(shocks).map_err(refused)
    }
}

#[pyfunction]
pub(crate) fn respond(py: Python<'_>, given: Given<'_>) -> PyResult<Answered> {
    let inputs = drops::inputs(&given)?;
    if inputs.length_m.is_some() {
        let question = of_drop(&given, &inputs)?;
        given.done()?;
        return without_picture(py, move |_| json(&drop_of::answer(&question).map_err(words)?));
    }
    let question = of_shocks(&given, inputs.e)?;
    given.leave(&["q", "gyration_ratio", "masses", "velocity", "height_gap", "tolerance"])?;
    given.done()?;
    without_picture(py, move |_| json(&respond_of::answer(&question).map_err(words)?))
}

fn of_drop(given: &Given<'_>, inputs: &DropInputs) -> PyResult<drop_of::Question> {
    let of_others = ["pulses", "shocks", "q", "gyration_ratio", "masses", "velocity", "height_gap"];
    refuse(given, &of_others, "does not go with length_m, which makes a drop in SI units")?;
    let model = given.read::<Option<Model>>("model")?.unwrap_or(Model::Compliant);
    if inputs.is_flat && model == Model::Compliant {
        return Err(refused("flat goes with instant impacts: contacts that take time land flat with tilt_deg=0"));
    }
    let Some(at) = given.read::<Option<Vec<f64>>>("at")? else {
        return Err(refused("the drop is not whole: give at"));
    };
    let drop = inputs.drop(model).map_err(refused)?;
    let axis = match given.read::<Option<String>>("axis")? {
        Some(name) => Axis::of(&name).ok_or_else(|| refused(format!("axis = '{name}' is none: x, y, z or any")))?,
        None => Axis::default(),
    };
    let place = drop_of::place(&drop, &at, axis).map_err(refused)?;
    let mut question = drop_of::Question::new(drop, model, place);
    let (ratio, q_factor) = (given.read::<Option<f64>>("damping")?, given.read::<Option<f64>>("q_factor")?);
    let stop = stop(given)?;
    let swings = |hz| {
        let free = Suspension::from_hz(hz, damping(ratio, q_factor)?).map_err(refused)?;
        Ok::<_, PyErr>(stop.map_or(free, |stop| free.with_stop(stop)))
    };
    let hz = match (given.read::<Option<f64>>("omega")?, given.read::<Option<f64>>("frequency_hz")?) {
        (Some(_), Some(_)) => return Err(refused("omega and frequency_hz say both how the part swings: give one")),
        (None, None) if ratio.is_some() || q_factor.is_some() || stop.is_some() => {
            return Err(refused(
                "damping, q_factor and stop go with omega or frequency_hz: a part without is mounted rigidly",
            ));
        }
        (omega, hz) => omega.map(|omega| omega / TAU).or(hz),
    };
    question.suspension = hz.map(swings).transpose()?;
    question.tolerance = given.read("tolerance")?;
    Ok(question)
}

/// Refuses arguments that another question takes.
fn refuse(given: &Given<'_>, names: &[&str], why: &str) -> PyResult<()> {
    for name in names {
        if !given.value(name)?.is_none() {
            return Err(refused(format!("{name} {why}")));
        }
    }
    Ok(())
}

fn of_shocks(given: &Given<'_>, e: Option<f64>) -> PyResult<respond_of::Question> {
    refuse(given, &["axis", "model"], "goes with length_m alone, which makes a drop in SI units")?;
    let omega = match (given.read("omega")?, given.read::<Option<f64>>("frequency_hz")?) {
        (Some(omega), None) => omega,
        (None, Some(hz)) => TAU * hz,
        _ => return Err(refused("one of omega and frequency_hz says how the part swings")),
    };
    let free = Suspension::new(omega, damping(given.read("damping")?, given.read("q_factor")?)?).map_err(refused)?;
    let stop = stop(given)?;
    let excitation = match (given.read("shocks")?, given.read::<Option<Vec<_>>>("pulses")?, e, given.read("at")?) {
        (Some(shocks), ..) => Excitation::Shocks(shocks),
        (None, Some(pulses), ..) => Excitation::Pulses(pulses),
        (None, None, Some(_), Some(at)) => {
            let Body::Bar(bar) = Body::read(given)? else {
                return Err(refused("respond is that of a bar; gyration_ratio has two values here"));
            };
            if stop.is_some() {
                return Err(refused("stop goes with pulses, shocks or length_m, which are in SI units"));
            }
            Excitation::Bar { bar, start: Fall::read(given)?.of_bar()?, at }
        }
        _ => return Err(refused("pulses, shocks, or e and at of a bar say what shakes the part")),
    };
    Ok(respond_of::Question::new(excitation, stop.map_or(free, |stop| free.with_stop(stop))))
}
