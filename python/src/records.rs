//! This module reads measured accelerations, from files and from arrays, and computes their spectra.

use std::fs::File;
use std::path::PathBuf;

use clatter_answer::spectrum::{self as spectrum_of, Excitation, Measured, Part};
use clatter_answer::{figures, record as record_of};
use clatter_figures::{Against, FigureError};
use clatter_record::{
    Baseline, Between, Column, Options, PRE_SHOCK_SHARE, Pass, Pick, Table, Units, Values, sensitivity,
};
use clatter_shock::{
    DampingRatio, Frequencies, LimitCurve, Quantity, RequiredSpectrum, Search, VelocityShock, VelocityShocks,
};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;
use serde::Serialize;

use crate::answered::{Answered, Drawing, json};
use crate::shocks::{Pulse, shape};
use crate::{bodies, refused, work};

/// A record of measured accelerations.
#[pyclass(frozen, module = "clatter._clatter")]
#[derive(Debug, Clone)]
pub(crate) struct Record {
    record: clatter_record::Record,
    #[pyo3(get)]
    file: String,
}

/// A column by its number, from 1, or by its name.
#[derive(Debug, Clone, FromPyObject)]
pub(crate) enum Which {
    Number(usize),
    Name(String),
}

impl From<Which> for Pick {
    fn from(which: Which) -> Self {
        match which {
            Which::Number(number) => Self::Number(number),
            Which::Name(name) => Self::Name(name),
        }
    }
}

/// The numbers of a column; whole ones stay whole, as floats do not hold the nanoseconds since 1970.
#[derive(Debug)]
pub(crate) struct Numbers(Values);

impl<'py> FromPyObject<'_, 'py> for Numbers {
    type Error = PyErr;
    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(whole) = object.extract::<PyReadonlyArray1<'py, i64>>() {
            return Ok(Self(Values::Integer(whole.as_slice()?.to_vec())));
        }
        let floats: PyReadonlyArray1<'py, f64> = object.extract()?;
        Ok(Self(Values::Float(floats.as_slice()?.to_vec())))
    }
}

/// The numbers of a channel, or its times.
type Array<'py> = Bound<'py, PyArray1<f64>>;

fn options(
    time: Option<Which>,
    acceleration: Vec<Which>,
    units: Option<&str>,
    sample_rate_hz: Option<f64>,
    full_scale_m_s2: Option<f64>,
    sensor_sensitivity: Option<&str>,
    sensor: Option<String>,
    record: Option<usize>,
    skip_bad: bool,
) -> PyResult<Options> {
    Ok(Options {
        time: time.map(Pick::from),
        accelerations: acceleration.into_iter().map(Pick::from).collect(),
        units: units.map(str::parse::<Units>).transpose().map_err(refused)?,
        sample_rate_hz,
        full_scale_m_s2,
        sensitivity_v_s2_m: sensor_sensitivity.map(sensitivity).transpose().map_err(refused)?,
        sensor,
        record,
        skip_bad,
        ..Options::default()
    })
}

/// The answer with its file before it, as the command has it.
#[derive(Serialize)]
struct OfFile<'a> {
    file: &'a str,
    #[serde(flatten)]
    answer: &'a record_of::Answer<'a>,
}

impl Record {
    pub(crate) fn inner(&self) -> &clatter_record::Record {
        &self.record
    }
    pub(crate) fn file(&self) -> &str {
        &self.file
    }
    fn with(&self, record: clatter_record::Record) -> Self {
        Self { record, file: self.file.clone() }
    }
    fn channel(&self, index: usize) -> PyResult<&clatter_record::Channel> {
        let channels = self.record.channels();
        channels.get(index).ok_or_else(|| refused(format!("channel {index}; the record has {}", channels.len())))
    }
}

#[pymethods]
impl Record {
    #[staticmethod]
    fn open(
        py: Python<'_>,
        path: PathBuf,
        time: Option<Which>,
        acceleration: Vec<Which>,
        units: Option<&str>,
        sample_rate_hz: Option<f64>,
        full_scale_m_s2: Option<f64>,
        sensitivity: Option<&str>,
        sensor: Option<String>,
        record: Option<usize>,
        skip_bad: bool,
    ) -> PyResult<Self> {
        let (rate, scale) = (sample_rate_hz, full_scale_m_s2);
        let options = options(time, acceleration, units, rate, scale, sensitivity, sensor, record, skip_bad)?;
        let input = File::open(&path)
            .map_err(|error| PyOSError::new_err((error.raw_os_error(), error.to_string(), path.clone())))?;
        let file = path.to_string_lossy().into_owned();
        let read = work::done(py, move |wanted| {
            clatter_record::Record::read(input, &options, |_| wanted.or_leave())
                .map_err(|error| format!("{file}: {error}"))
        });
        Ok(Self { record: read?.map_err(refused)?, file: path.to_string_lossy().into_owned() })
    }

    /// Makes a record of columns, each with its name, its unit where it is not in the name, and its numbers.
    #[staticmethod]
    fn of_columns(
        columns: Vec<(String, Option<String>, Numbers)>,
        left_out: Vec<String>,
        file: String,
        time: Option<Which>,
        acceleration: Vec<Which>,
        units: Option<&str>,
        sample_rate_hz: Option<f64>,
        full_scale_m_s2: Option<f64>,
        sensitivity: Option<&str>,
        skip_bad: bool,
    ) -> PyResult<Self> {
        let (rate, scale) = (sample_rate_hz, full_scale_m_s2);
        let options = options(time, acceleration, units, rate, scale, sensitivity, None, None, skip_bad)?;
        let column = |(name, unit, numbers): (String, Option<String>, Numbers)| Column {
            name,
            group: String::new(),
            unit,
            sampled_s: None,
            values: numbers.0,
        };
        let table = Table { columns: columns.into_iter().map(column).collect(), left_out, notes: Vec::new() };
        let record = clatter_record::Record::of_table(table, &options).map_err(refused)?;
        Ok(Self { record, file })
    }

    /// Names and units of the channels.
    #[getter]
    fn channels(&self) -> Vec<(String, String)> {
        self.record.channels().iter().map(|channel| (channel.name.clone(), channel.unit.clone())).collect()
    }

    fn values_m_s2<'py>(&self, py: Python<'py>, index: usize) -> PyResult<Array<'py>> {
        Ok(PyArray1::from_slice(py, &self.channel(index)?.values))
    }

    fn times_s<'py>(&self, py: Python<'py>, index: usize) -> PyResult<Array<'py>> {
        let times = self.channel(index)?.times();
        Ok(times.times_s().map(|since_s| times.start_s() + since_s).collect::<Vec<_>>().into_pyarray(py))
    }

    #[getter]
    fn step_s(&self) -> Option<f64> {
        self.record.step_s()
    }

    #[getter]
    fn findings(&self) -> Vec<String> {
        self.record.findings(record_of::LOWEST_HZ).iter().map(ToString::to_string).collect()
    }

    fn window(&self, from_s: f64, to_s: f64) -> PyResult<Self> {
        Ok(self.with(self.record.clone().window(from_s, to_s).map_err(refused)?))
    }

    fn detrend(&self, baseline: &str) -> PyResult<Self> {
        let baseline = match baseline {
            "mean" => Baseline::Mean,
            "linear" => Baseline::Linear,
            "pre-shock" => Baseline::PreShock { share: PRE_SHOCK_SHARE },
            _ => return Err(refused(format!("baseline = '{baseline}' is none: mean, linear or pre-shock"))),
        };
        let mut record = self.record.clone();
        record.without_baseline(baseline).map_err(refused)?;
        Ok(self.with(record))
    }

    /// Filters the record as the command does: two poles, forward and backward.
    fn filter(&self, py: Python<'_>, high: bool, hz: f64) -> PyResult<Self> {
        let (mut record, pass) = (self.record.clone(), if high { Pass::High } else { Pass::Low });
        let filtered = work::done(py, move |_| record.filter(pass, hz, 2).map(|()| record));
        Ok(self.with(filtered?.map_err(refused)?))
    }

    fn describe(
        &self,
        py: Python<'_>,
        find: bool,
        threshold_m_s2: Option<f64>,
        quiet_s: f64,
        fit_pulse: bool,
        nominal: Option<PyRef<'_, Pulse>>,
        integrate: bool,
    ) -> PyResult<Answered> {
        let (own, nominal) = (self.clone(), nominal.map(|pulse| pulse.0));
        let told = work::done(py, move |_| {
            let mut question = record_of::Question::new(&own.record);
            question.find = find.then_some(Search { threshold_m_s2, quiet_s });
            (question.fit_pulse, question.nominal, question.integrate) = (fit_pulse, nominal, integrate);
            let answer = record_of::answer(&question).map_err(|error| error.to_string())?;
            json(&OfFile { file: &own.file, answer: &answer })
        });
        Ok((told?.map_err(refused)?, None))
    }
}

/// The source of the shocks on the parts.
#[derive(FromPyObject)]
pub(crate) enum Shaken {
    Records(Vec<Py<Record>>),
    Pulses(Vec<Py<Pulse>>),
    Shocks(Vec<(f64, f64)>),
}

/// A limit: one value, or points of a curve.
#[derive(Debug, FromPyObject)]
pub(crate) enum Limit {
    Level(f64),
    Curve(Vec<(f64, f64)>),
}

impl Limit {
    fn curve(self) -> PyResult<LimitCurve> {
        match self {
            Self::Level(level) => LimitCurve::constant(level),
            Self::Curve(points) => LimitCurve::new(points),
        }
        .map_err(refused)
    }
}

fn quantity(name: &str) -> PyResult<Quantity> {
    const ALL: [Quantity; 5] = [
        Quantity::AbsoluteAcceleration,
        Quantity::RelativeDisplacement,
        Quantity::RelativeVelocity,
        Quantity::PseudoVelocity,
        Quantity::EquivalentStaticAcceleration,
    ];
    let names = || ALL.map(|quantity| spectrum_of::name(quantity)[0]).join(", ");
    let found = ALL.into_iter().find(|quantity| spectrum_of::name(*quantity)[0] == name);
    found.ok_or_else(|| refused(format!("quantity = '{name}' is none: {}", names())))
}

fn between(name: &str) -> PyResult<Between> {
    match name {
        "band-limited" => Ok(Between::BandLimited),
        "linear" => Ok(Between::Linear),
        _ => Err(refused(format!("interpolation = '{name}' is none: band-limited or linear"))),
    }
}

/// Returns the damping ratios of quality factors; Q = 10 where none is given.
fn dampings(ratio: Option<f64>, q_factors: Option<Vec<f64>>) -> PyResult<Vec<DampingRatio>> {
    match q_factors {
        Some(several) if !several.is_empty() => several.iter().map(|q| bodies::damping(ratio, Some(*q))).collect(),
        _ => Ok(vec![bodies::damping(ratio, None)?]),
    }
}

/// A required spectrum with how far below and above it one may be, in dB.
type Required = (Limit, f64, Option<f64>);

#[pyfunction]
pub(crate) fn spectrum(
    py: Python<'_>,
    shaken: Shaken,
    list_hz: Option<Vec<f64>>,
    per_octave_hz: Option<[f64; 3]>,
    damping: Option<f64>,
    q_factors: Option<Vec<f64>>,
    quantity_name: &str,
    interpolation: &str,
    limit: Option<Limit>,
    required: Option<Required>,
    enveloping_pulse: Option<&str>,
    find: Option<(Option<f64>, f64)>,
    summaries: [bool; 3],
) -> PyResult<Answered> {
    let dampings = dampings(damping, q_factors)?;
    let mut question = spectrum_of::Question::new(excitation(shaken, find)?, dampings[0]);
    question.dampings = dampings;
    question.frequencies = match (list_hz, per_octave_hz) {
        (Some(list), _) => Some(Frequencies::list(list).map_err(refused)?),
        (None, Some([low, high, count])) => Some(Frequencies::per_octave(low, high, count).map_err(refused)?),
        (None, None) => None,
    };
    (question.quantity, question.between) = (quantity(quantity_name)?, between(interpolation)?);
    question.limit = limit.map(Limit::curve).transpose()?;
    let required = required
        .map(|(limit, below_db, above_db)| RequiredSpectrum::new(limit.curve()?, below_db, above_db).map_err(refused));
    question.required = required.transpose()?;
    question.enveloping = enveloping_pulse.map(shape).transpose()?;
    [question.resultant, question.envelope, question.mean_3db] = summaries;
    let (told, parts, limit, required) = work::done(py, move |wanted| {
        let answer = spectrum_of::counted(&question, |_| wanted.or_leave()).map_err(|error| error.to_string())?;
        let told = json(&answer)?;
        let parts = answer.parts;
        Ok::<_, String>((told, parts, question.limit.clone(), question.required.clone()))
    })?
    .map_err(refused)?;
    let draw = move || drawn(&parts, Against { limit: limit.as_ref(), required: required.as_ref() });
    Ok((told, Some(Drawing::new(draw))))
}

fn excitation(shaken: Shaken, find: Option<(Option<f64>, f64)>) -> PyResult<Excitation> {
    Ok(match shaken {
        Shaken::Records(records) => {
            let several = records.len() > 1;
            let one = |record: Py<Record>| {
                let Record { record, file } = record.get().clone();
                let name = several.then(|| file.rsplit(['/', '\\']).next().unwrap_or(&file).to_owned());
                let whole = Measured { file, name, record, shock: None };
                match find {
                    Some((threshold_m_s2, quiet_s)) => whole.apart(&Search { threshold_m_s2, quiet_s }),
                    None => Ok(vec![whole]),
                }
            };
            let records = records.into_iter().map(one).collect::<Result<Vec<_>, _>>().map_err(refused)?;
            Excitation::Records(records.into_iter().flatten().collect())
        }
        Shaken::Pulses(pulses) => Excitation::Pulses(pulses.iter().map(|pulse| pulse.get().0).collect()),
        Shaken::Shocks(shocks) => Excitation::Shocks(velocity_shocks(shocks)?),
    })
}

/// Makes velocity shocks of times and changes of velocity.
pub(crate) fn velocity_shocks(shocks: Vec<(f64, f64)>) -> PyResult<VelocityShocks> {
    let shocks = shocks.into_iter().map(|(time, delta_v)| VelocityShock { time, delta_v }).collect();
    VelocityShocks::new(shocks).map_err(refused)
}

/// Draws the picture that the command writes.
fn drawn(parts: &[Part], against: Against<'_>) -> Result<String, FigureError> {
    if let [part] = parts {
        return clatter_figures::spectrum(&part.spectrum, against);
    }
    let several = parts.iter().any(|other| other.spectrum.damping != parts[0].spectrum.damping);
    let name = |part: &Part| {
        let q = several.then(|| format!("Q = {}", figures(0.5 / part.spectrum.damping.get())));
        part.name.clone().into_iter().chain(q).collect::<Vec<_>>().join(", ")
    };
    let names: Vec<String> = parts.iter().map(name).collect();
    let all: Vec<_> = parts.iter().zip(&names).map(|(part, name)| (&part.spectrum, name.as_str())).collect();
    clatter_figures::spectra(&all, against)
}

/// Maximax, positive and negative of many histories of even samples, one after the other.
type Spectra<'py> = [Array<'py>; 3];

#[pyfunction]
pub(crate) fn spectra<'py>(
    py: Python<'py>,
    histories: PyReadonlyArray1<'py, f64>,
    samples: usize,
    step_s: f64,
    hz: Vec<f64>,
    damping: Option<f64>,
    q_factor: Option<f64>,
    quantity_name: &str,
    interpolation: &str,
) -> PyResult<Spectra<'py>> {
    let (damping, quantity, between) =
        (bodies::damping(damping, q_factor)?, quantity(quantity_name)?, between(interpolation)?);
    let frequencies = Frequencies::list(hz).map_err(refused)?;
    let histories = histories.as_slice()?.to_vec();
    let all = work::done(py, move |wanted| {
        let mut all: [Vec<f64>; 3] = Default::default();
        for (n, values) in histories.chunks(samples.max(1)).enumerate() {
            let of = |error: clatter_record::Error| {
                if histories.len() > samples { format!("history {n}: {error}") } else { error.to_string() }
            };
            let record = clatter_record::Record::from_samples(0.0, step_s, vec![("", values.to_vec())]).map_err(of)?;
            let channel = &record.channels()[0];
            let spectrum = channel.spectrum(&frequencies, damping, quantity, between, |_| wanted.or_leave());
            let spectrum = spectrum.map_err(of)?;
            let parts = [spectrum.maximax, spectrum.positive, spectrum.negative];
            all.iter_mut().zip(parts).for_each(|(all, part)| all.extend(part));
        }
        Ok::<_, String>(all)
    });
    Ok(all?.map_err(refused)?.map(|column| column.into_pyarray(py)))
}
