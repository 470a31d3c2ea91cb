//! This module reads measured accelerations, from files and from arrays, and computes their spectra.

use std::fmt::Display;
use std::fs::File;
use std::io::{self, Cursor, Read};
use std::path::PathBuf;

use clatter_answer::spectrum::{self as spectrum_of, Excitation, Measured, Part};
use clatter_answer::{figures, record as record_of};
use clatter_figures::{Against, FigureError};
use clatter_record::{
    Baseline, Between, Column, Kind, Options, PRE_SHOCK_SHARE, Pass, Pick, Table, Values, sensitivity,
};
use clatter_shock::{DampingRatio, Frequencies, LimitCurve, Quantity, RequiredSpectrum, Search};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use pyo3::types::{PyBool, PyDict};
use serde::Serialize;

use crate::answered::{Answered, Drawing, Refused, json, without_picture};
use crate::given::{Given, Value, one_of, several, whole, wrong};
use crate::shocks::Pulse;
use crate::single::LISTED;
use crate::work::Wanted;
use crate::{arrays, bodies, refused, words, work};

/// A record of measured accelerations.
#[pyclass(frozen, module = "clatter._clatter")]
#[derive(Debug, Clone)]
pub(crate) struct Record {
    pub(crate) record: clatter_record::Record,
    #[pyo3(get)]
    pub(crate) file: String,
}

impl Value for Pick {
    /// Reads a column by its number, from 1, or by its name.
    fn read(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        let number = value.extract().ok().filter(|_| !value.is_instance_of::<PyBool>()).map(Self::Number);
        let picked = number.or_else(|| value.extract().ok().map(Self::Name));
        picked.ok_or_else(|| wrong(name, value, "the number or the name of a column"))
    }
}

impl Value for Vec<Pick> {
    fn read(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        several(name, value, &[])?.iter().map(|one| Pick::read(name, one)).collect()
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

fn options(given: &Given<'_>) -> PyResult<Options> {
    let (units, volts): (Option<String>, Option<String>) = (given.read("units")?, given.read("sensitivity")?);
    Ok(Options {
        time: given.read("time")?,
        accelerations: given.read("acceleration")?,
        units: units.map(|units| units.parse()).transpose().map_err(refused)?,
        sample_rate_hz: given.read("sample_rate_hz")?,
        full_scale_m_s2: given.read("full_scale_m_s2")?,
        sensitivity_v_s2_m: volts.as_deref().map(sensitivity).transpose().map_err(refused)?,
        sensor: given.read("sensor")?,
        record: given.whole_if_given("record", 0..=u64::MAX)?,
        skip_bad: given.read("skip_bad")?,
        ..Options::default()
    })
}

/// Reads how the shocks of a record are found, where they are to be.
fn search(given: &Given<'_>) -> PyResult<Option<Search>> {
    let search = Search { threshold_m_s2: given.read("threshold_m_s2")?, quiet_s: given.read("quiet_s")? };
    Ok(given.read::<bool>("find")?.then_some(search))
}

/// Reads a record of a file of this size, 0 where that is not known. What is no text of lines is held in memory as a whole, so it is
/// bounded.
pub(crate) fn read(
    mut input: impl Read,
    size: u64,
    options: &Options,
    name: &str,
    wanted: &Wanted,
) -> Result<clatter_record::Record, Refused> {
    let mut begin = Vec::new();
    let words = |error: &dyn Display| Refused::Words(format!("{name}: {error}"));
    input.by_ref().take(BEGIN).read_to_end(&mut begin).map_err(|error| words(&error))?;
    let is_lines = begin.contains(&b'\n') && !begin.contains(&0) && matches!(Kind::of(&begin), Ok(Kind::Text));
    let left = if is_lines { u64::MAX } else { LARGEST - BEGIN };
    if !is_lines && size > LARGEST {
        return Err(words(&TOO_LARGE));
    }
    let rest = Cursor::new(begin).chain(Bounded { input, left });
    clatter_record::Record::read(rest, options, |_| wanted.or_leave()).map_err(|error| words(&error))
}

/// Bytes by which a file is known.
const BEGIN: u64 = 1 << 16;
/// Bytes of a file that is held in memory as a whole, at most: what the command may take.
const LARGEST: u64 = 1 << 30;
const TOO_LARGE: &str = "it is larger than 1 GiB, which is the most for what is no text";

/// An input that ends in an error where it is longer.
struct Bounded<R> {
    input: R,
    left: u64,
}

impl<R: Read> Read for Bounded<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.input.read(buffer)?;
        let left = self.left.checked_sub(count as u64);
        self.left = left.ok_or_else(|| io::Error::other(TOO_LARGE))?;
        Ok(count)
    }
}

/// The answer with its file before it, as the command has it.
#[derive(Serialize)]
struct OfFile<'a> {
    file: &'a str,
    #[serde(flatten)]
    answer: &'a record_of::Answer<'a>,
}

impl Record {
    fn with(&self, record: clatter_record::Record) -> Self {
        Self { record, file: self.file.clone() }
    }
    /// Finds a channel by its name, or by its index from 0.
    fn channel(&self, channel: &Bound<'_, PyAny>) -> PyResult<&clatter_record::Channel> {
        let channels = self.record.channels();
        let Ok(name) = channel.extract::<String>() else {
            return Ok(&channels[whole::<usize>("channel", channel, 0..=channels.len() as u64 - 1)?]);
        };
        channels.iter().find(|channel| channel.name == name).ok_or_else(|| {
            let names: Vec<_> = channels.iter().map(|channel| channel.name.as_str()).collect();
            refused(format!("there is no channel '{name}'; there are {}", names.join(", ")))
        })
    }
}

#[pymethods]
impl Record {
    /// Reads a file, or the bytes that it had.
    #[staticmethod]
    fn open(py: Python<'_>, given: Given<'_>) -> PyResult<Self> {
        let (path, options) = (given.read::<PathBuf>("path")?, options(&given)?);
        let bytes: Option<PyBackedBytes> = given.value("bytes")?.extract()?;
        given.done()?;
        let file = path.to_string_lossy().into_owned();
        let name = file.clone();
        let read = work::read(py, move |wanted| {
            if let Some(bytes) = bytes {
                return read(Cursor::new(bytes), 0, &options, &name, wanted);
            }
            let opened = File::open(&path).and_then(|file| Ok((file.metadata()?.len(), file)));
            let (size, file) = opened.map_err(|error| Refused::System(path, error))?;
            read(file, size, &options, &name, wanted)
        });
        Ok(Self { record: read??, file })
    }

    /// Makes a record of columns, each with its name, its unit where it is not in the name, and its numbers.
    #[staticmethod]
    fn of_columns(py: Python<'_>, given: Given<'_>) -> PyResult<Self> {
        let (options, file) = (options(&given)?, given.read("name")?);
        let (columns, left_out): (Vec<(String, Option<String>, Numbers)>, _) = given.value("data")?.extract()?;
        given.done()?;
        let column = |(name, unit, numbers): (String, Option<String>, Numbers)| Column {
            name,
            group: String::new(),
            unit,
            sampled_s: None,
            values: numbers.0,
        };
        let table = Table { columns: columns.into_iter().map(column).collect(), left_out, notes: Vec::new() };
        let record = work::done(py, move |_| clatter_record::Record::of_table(table, &options));
        Ok(Self { record: record?.map_err(refused)?, file })
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.file == other.file && self.record == other.record
    }

    /// Names of the channels.
    #[getter]
    fn channels(&self) -> Vec<String> {
        self.record.channels().iter().map(|channel| channel.name.clone()).collect()
    }

    fn values_m_s2<'py>(&self, channel: &Bound<'py, PyAny>) -> PyResult<Array<'py>> {
        Ok(PyArray1::from_slice(channel.py(), &self.channel(channel)?.values))
    }

    fn times_s<'py>(&self, channel: &Bound<'py, PyAny>) -> PyResult<Array<'py>> {
        let times = self.channel(channel)?.times();
        Ok(times.times_s().map(|since_s| times.start_s() + since_s).collect::<Vec<_>>().into_pyarray(channel.py()))
    }

    #[getter]
    fn step_s(&self) -> Option<f64> {
        self.record.step_s()
    }

    #[getter]
    fn findings(&self) -> Vec<String> {
        self.record.findings(record_of::LOWEST_HZ).iter().map(ToString::to_string).collect()
    }

    fn window(&self, from_s: &Bound<'_, PyAny>, to_s: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (from_s, to_s) = (f64::read("from_s", from_s)?, f64::read("to_s", to_s)?);
        Ok(self.with(self.record.clone().window(from_s, to_s).map_err(refused)?))
    }

    fn detrend(&self, baseline: &Bound<'_, PyAny>) -> PyResult<Self> {
        let pre_shock = Baseline::PreShock { share: PRE_SHOCK_SHARE };
        let all = [("mean", Baseline::Mean), ("linear", Baseline::Linear), ("pre-shock", pre_shock)];
        let mut record = self.record.clone();
        record.without_baseline(one_of("baseline", baseline, &all, " or ")?).map_err(refused)?;
        Ok(self.with(record))
    }

    /// Filters the record as the command does: two poles, forward and backward.
    fn filter(&self, py: Python<'_>, high: bool, hz: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (hz, pass) = (f64::read("hz", hz)?, if high { Pass::High } else { Pass::Low });
        let mut record = self.record.clone();
        let filtered = work::done(py, move |_| record.filter(pass, hz, 2).map(|()| record));
        Ok(self.with(filtered?.map_err(refused)?))
    }

    fn describe(&self, py: Python<'_>, given: Given<'_>) -> PyResult<Answered> {
        let (own, find, nominal) = (self.clone(), search(&given)?, given.read("nominal")?);
        let (fit_pulse, integrate) = (given.read("fit_pulse")?, given.read("integrate")?);
        given.done()?;
        without_picture(py, move |_| {
            let mut question = record_of::Question::new(&own.record);
            question.find = find;
            (question.fit_pulse, question.nominal, question.integrate) = (fit_pulse, nominal, integrate);
            json(&OfFile { file: &own.file, answer: &record_of::answer(&question).map_err(words)? })
        })
    }
}

/// The source of the shocks on the parts, but for velocity shocks.
#[derive(FromPyObject)]
pub(crate) enum Shaken {
    Records(Vec<Py<Record>>),
    Pulses(Vec<Py<Pulse>>),
}

impl Value for LimitCurve {
    /// Reads one value, or points of a curve.
    fn read(_: &str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        if value.len().is_err() {
            return Self::constant(f64::read("a limit", value)?).map_err(refused);
        }
        let points = Vec::<[f64; 2]>::read("a limit", value)?;
        Self::new(points.into_iter().map(<(f64, f64)>::from).collect()).map_err(refused)
    }
}

impl Value for Quantity {
    fn read(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        let all = [
            Self::AbsoluteAcceleration,
            Self::RelativeDisplacement,
            Self::RelativeVelocity,
            Self::PseudoVelocity,
            Self::EquivalentStaticAcceleration,
        ];
        one_of(name, value, &all.map(|quantity| (spectrum_of::name(quantity)[0], quantity)), ", ")
    }
}

impl Value for Between {
    fn read(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Self> {
        one_of(name, value, &[("band-limited", Self::BandLimited), ("linear", Self::Linear)], " or ")
    }
}

/// Returns the damping ratios of quality factors; Q = 10 where none is given.
fn dampings(given: &Given<'_>) -> PyResult<Vec<DampingRatio>> {
    let ratio = given.read("damping")?;
    match given.read::<Option<Vec<f64>>>("q_factor")? {
        Some(several) if several.is_empty() => Err(refused("q_factor is empty")),
        Some(several) => several.into_iter().map(|q| bodies::damping(ratio, Some(q))).collect(),
        None => Ok(vec![bodies::damping(ratio, None)?]),
    }
}

/// Reads natural frequencies, as a list or by their number to the octave.
fn frequencies(given: &Given<'_>) -> PyResult<Option<Frequencies>> {
    let frequencies = match (given.read("frequency_hz")?, given.read::<Option<[f64; 3]>>("per_octave_hz")?) {
        (Some(list), _) => Frequencies::list(list),
        (None, Some([low, high, count])) => Frequencies::per_octave(low, high, count),
        (None, None) => return Ok(None),
    };
    frequencies.map(Some).map_err(refused)
}

/// Reads the spectrum that a test was to reach, with how far below and above it one may be, in dB.
fn required(given: &Given<'_>) -> PyResult<Option<RequiredSpectrum>> {
    let [below_db, above_db] = given.read::<[Option<f64>; 2]>("tolerance_db")?;
    let Some(curve) = given.read("required")? else { return Ok(None) };
    let below_db = below_db.ok_or_else(|| refused("tolerance_db = None is not a number"))?;
    RequiredSpectrum::new(curve, below_db, above_db).map(Some).map_err(refused)
}

#[pyfunction]
pub(crate) fn spectrum(py: Python<'_>, given: Given<'_>) -> PyResult<Answered> {
    let dampings = dampings(&given)?;
    let mut question = spectrum_of::Question::new(excitation(&given)?, dampings[0]);
    question.dampings = dampings;
    question.stop = bodies::stop(&given)?;
    question.frequencies = frequencies(&given)?;
    (question.quantity, question.between) = (given.read("quantity")?, given.read("interpolation")?);
    (question.limit, question.required) = (given.read("limit")?, required(&given)?);
    question.enveloping = given.read("enveloping_pulse")?;
    (question.resultant, question.envelope) = (given.read("resultant")?, given.read("envelope")?);
    question.mean_3db = given.read("mean_3db")?;
    given.done()?;
    let channels = question.records().iter().map(|of| of.record.channels().len()).sum::<usize>().max(1);
    let count = question.frequencies().map_err(refused)?.hz().len();
    let listed = count.saturating_mul(channels).saturating_mul(question.dampings.len());
    if listed > LISTED {
        return Err(refused(format!(
            "{listed} frequencies of all spectra in one call; it takes {LISTED}: ask in pieces"
        )));
    }
    let (told, parts, limit, required) = work::done(py, move |wanted| {
        let answer = spectrum_of::counted(&question, |_| wanted.or_leave()).map_err(words)?;
        let told = json(&answer)?;
        let parts = answer.parts;
        Ok::<_, String>((told, parts, question.limit.clone(), question.required.clone()))
    })?
    .map_err(refused)?;
    let draw = move || drawn(&parts, Against { limit: limit.as_ref(), required: required.as_ref() });
    Ok((told, Some(Drawing::new(draw))))
}

fn excitation(given: &Given<'_>) -> PyResult<Excitation> {
    let find = search(given)?;
    let shaken = given.value("excitation")?.extract()?;
    let records = match (shaken, given.read("shocks")?) {
        (None, Some(shocks)) => return Ok(Excitation::Shocks(shocks)),
        (Some(Shaken::Pulses(pulses)), None) => {
            return Ok(Excitation::Pulses(pulses.iter().map(|pulse| pulse.get().0).collect()));
        }
        (Some(Shaken::Records(records)), None) if !records.is_empty() => records,
        _ => return Err(refused("a record, pulses or shocks say what shakes the part")),
    };
    let several = records.len() > 1;
    let one = |record: Py<Record>| {
        let Record { record, file } = record.get().clone();
        let name = several.then(|| file.rsplit(['/', '\\']).next().unwrap_or(&file).to_owned());
        let whole = Measured { file, name, record, shock: None };
        find.as_ref().map_or_else(|| Ok(vec![whole.clone()]), |search| whole.apart(search))
    };
    let records = records.into_iter().map(one).collect::<Result<Vec<_>, _>>().map_err(refused)?;
    Ok(Excitation::Records(records.into_iter().flatten().collect()))
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

/// Computes the spectra of many histories of even samples, one after the other.
#[pyfunction]
pub(crate) fn spectra<'py>(py: Python<'py>, given: Given<'py>) -> PyResult<Bound<'py, PyDict>> {
    let damping = bodies::damping(given.read("damping")?, given.read("q_factor")?)?;
    let (quantity, between) = (given.read("quantity")?, given.read("interpolation")?);
    let frequencies = Frequencies::list(given.read("frequency_hz")?).map_err(refused)?;
    let (rate_hz, samples) = (given.read::<f64>("sample_rate_hz")?, given.whole("samples", 2..=u64::MAX)?);
    if !(rate_hz > 0.0 && rate_hz.is_finite()) {
        return Err(refused(format!("sample_rate_hz = {rate_hz:?} is not finite and > 0")));
    }
    let step_s = 1.0 / rate_hz;
    let arrays::Column(histories) = given.read("acceleration_m_s2")?;
    given.done()?;
    let all = work::done(py, move |wanted| {
        let mut all: [Vec<f64>; 3] = Default::default();
        for (n, values) in histories.chunks(samples).enumerate() {
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
    arrays::named(py, "maximax positive negative", all?.map_err(refused)?)
}
