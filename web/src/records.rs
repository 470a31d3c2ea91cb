//! This module answers about files of measured accelerations and their spectra.

use clatter_answer::record::{self as record_of, time_s};
use clatter_answer::spectrum::{self as spectrum_of, Excitation, Measured};
use clatter_figures::{Against, Trace};
use clatter_product::{STANDARD_GRAVITY_M_S2, units::FREQUENCY, visible, visible_lines};
use clatter_record::{Channel, Options, Record};
use clatter_shock::DampingRatio;
use serde::{Deserialize, Serialize};

use crate::{Reply, json, quoted, text};

/// A file by its name, and what it does not say of itself, as the flags of the command have it; empty where it says it.
#[derive(Debug, Deserialize)]
pub(crate) struct Source {
    name: String,
    units: String,
    sample_rate: String,
}

/// The quality factor of the parts, unless another is requested.
const QUALITY: f64 = 10.0;

impl Source {
    fn read(&self, file: &[u8]) -> Result<Record, String> {
        let mut options = Options::default();
        let [units, rate] = [&self.units, &self.sample_rate].map(|text| text.trim());
        if !units.is_empty() {
            options.units = Some(units.parse().map_err(|error| format!("units: {error}"))?);
        }
        if !rate.is_empty() {
            let hz = rate.parse().or_else(|_| FREQUENCY.read(rate).map(|hz| hz.si));
            let hz = hz.map_err(|error| format!("sampling rate: {error}"))?;
            if !(hz > 0.0 && hz.is_finite()) {
                return Err(format!("sampling rate: {hz:?} is not finite and > 0"));
            }
            options.sample_rate_hz = Some(hz);
        }
        Record::read(file, &options, |_| ()).map_err(|error| self.refused(&error))
    }

    /// Names the file that is refused, as the command does.
    fn refused(&self, error: &clatter_record::Error) -> String {
        format!("{}: {}", visible(&self.name), visible_lines(&error.to_string()))
    }

    fn command(&self, name: &str) -> String {
        let mut command = format!("clatter {name} {}", quoted(&self.name));
        for (flag, given) in [("units", &self.units), ("sample-rate", &self.sample_rate)] {
            if !given.trim().is_empty() {
                command.extend([" --", flag, "=", &quoted(given.trim())]);
            }
        }
        command + " --format=json"
    }
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
