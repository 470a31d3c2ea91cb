//! This module answers about files of measured accelerations and their spectra.

use clatter_answer::record::{self as record_of, time_s};
use clatter_answer::spectrum::{self as spectrum_of, Excitation, Measured};
use clatter_figures::{Against, Trace};
use clatter_product::{
    STANDARD_GRAVITY_M_S2,
    units::{ACCELERATION, Dimension, FREQUENCY},
    visible, visible_lines,
};
use clatter_record::{Channel, Options, Record};
use clatter_shock::DampingRatio;
use serde::{Deserialize, Serialize};

use crate::{Reply, json, quoted, text};

/// A file by its name, and what it does not say of itself, as the flags of the command have it; empty where it says it.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(crate) struct Source {
    name: String,
    units: String,
    sample_rate: String,
    full_scale: String,
    sensitivity: String,
}

/// The quality factor of the parts, unless another is requested.
const QUALITY: f64 = 10.0;

impl Source {
    fn read(&self, file: &[u8]) -> Result<Record, String> {
        let mut options = Options::default();
        if let Some(units) = given(&self.units) {
            options.units = Some(units.parse().map_err(|error| format!("units: {error}"))?);
        }
        if let Some(rate) = given(&self.sample_rate) {
            options.sample_rate_hz = Some(positive("sampling rate", &FREQUENCY, rate)?);
        }
        if let Some(scale) = given(&self.full_scale) {
            options.full_scale_m_s2 = Some(positive("full scale", &ACCELERATION, scale)?);
        }
        if let Some(volts) = given(&self.sensitivity) {
            let volts = clatter_record::sensitivity(volts).map_err(|error| format!("sensitivity: {error}"))?;
            options.sensitivity_v_s2_m = Some(volts);
        }
        Record::read(file, &options, |_| ()).map_err(|error| self.refused(&error))
    }

    /// Names the file that is refused, as the command does.
    fn refused(&self, error: &clatter_record::Error) -> String {
        format!("{}: {}", visible(&self.name), visible_lines(&error.to_string()))
    }

    fn command(&self, name: &str) -> String {
        let mut command = format!("clatter {name} {}", quoted(&self.name));
        let flags = [
            ("units", &self.units),
            ("sample-rate", &self.sample_rate),
            ("full-scale", &self.full_scale),
            ("sensitivity", &self.sensitivity),
        ];
        for (flag, text) in flags {
            if let Some(text) = given(text) {
                command.extend([" --", flag, "=", &quoted(text)]);
            }
        }
        command + " --format=json"
    }
}

/// Returns what a field holds, if it holds anything.
fn given(field: &str) -> Option<&str> {
    Some(field.trim()).filter(|text| !text.is_empty())
}

/// Reads a number in SI, or a quantity with its unit.
fn positive(what: &str, dimension: &'static Dimension, text: &str) -> Result<f64, String> {
    let si = text.parse().or_else(|_| dimension.read(text).map(|quantity| quantity.si));
    let si = si.map_err(|error| format!("{what}: {error}"))?;
    if si > 0.0 && si.is_finite() { Ok(si) } else { Err(format!("{what}: {si:?} is not finite and > 0")) }
}

/// The answer with its file before it, as the command has it.
#[derive(Serialize)]
struct OfFile<'a> {
    file: &'a str,
    #[serde(flatten)]
    answer: &'a record_of::Answer<'a>,
}

/// Returns the content of the file, and its channels over time.
pub(crate) fn record(source: &Source, file: &[u8]) -> Result<Reply, String> {
    let record = source.read(file)?;
    let answer = record_of::answer(&record_of::Question::new(&record)).map_err(|error| source.refused(&error))?;
    Ok(Reply {
        answer: Some(json(&OfFile { file: &source.name, answer: &answer })?),
        command: Some(source.command("record")),
        warnings: answer.findings.iter().map(ToString::to_string).collect(),
        figures: vec![("The record".to_owned(), picture(&record).map_err(text)?)],
        shown: record.account().map(|account| visible(&account.to_string()).into_owned()).into(),
    })
}

/// Draws the channels over time, in gn where the file is.
fn picture(record: &Record) -> Result<String, clatter_figures::FigureError> {
    let in_g = record.channels().iter().all(|channel| channel.unit.to_lowercase().contains('g'));
    let (one, title) = if in_g { (STANDARD_GRAVITY_M_S2, "gn") } else { (1.0, "m/s²") };
    let longest_s = record.times().iter().map(|times| times.duration_s()).fold(0.0, f64::max);
    let (factor, time) = match longest_s {
        s if s < 1e-3 => (1e6, "time, us"),
        s if s < 1.0 => (1e3, "time, ms"),
        _ => (1.0, "time, s"),
    };
    let points = |channel: &Channel| {
        let values = channel.values.iter().enumerate();
        values.map(|(i, value)| (factor * time_s(channel, i), value / one)).collect()
    };
    let traces = record.channels().iter().map(|channel| Trace {
        name: &channel.name,
        title,
        points: points(channel),
        marks: Vec::new(),
        beside: None,
    });
    clatter_figures::record(&traces.collect::<Vec<_>>(), time)
}

/// Computes the shock response spectrum of the file.
pub(crate) fn spectrum(source: &Source, file: &[u8]) -> Result<Reply, String> {
    let record = source.read(file)?;
    let measured = Measured { file: source.name.clone(), name: None, record, shock: None };
    let damping = DampingRatio::from_quality_factor(QUALITY).map_err(text)?;
    let question = spectrum_of::Question::new(Excitation::Records(vec![measured]), damping);
    let answer = spectrum_of::answer(&question).map_err(text)?;
    let drawing = match &answer.parts[..] {
        [part] => clatter_figures::spectrum(&part.spectrum, Against::default()),
        parts => {
            let all: Vec<_> = parts.iter().map(|part| (&part.spectrum, part.name.as_deref().unwrap_or(""))).collect();
            clatter_figures::spectra(&all, Against::default())
        }
    };
    Ok(Reply {
        answer: Some(json(&answer)?),
        command: Some(source.command("spectrum")),
        figures: vec![(format!("Shock response spectrum, Q = {QUALITY}"), drawing.map_err(text)?)],
        ..Reply::default()
    })
}
