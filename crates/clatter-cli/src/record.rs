//! `clatter record`: what a file of measurements holds, and the same written anew.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::ValueHint;
use clatter_assess::units::{ACCELERATION, TIME, Unit};
use clatter_figures::{FigureError, Trace};
use clatter_record::{Channel, Finding, Record};
use serde::Serialize;

use crate::condition_args::ConditionArgs;
use crate::inputs::Format;
use crate::npy;
use crate::numbers::{Json, digits, figures};
use crate::output::{self, Files, Kind, Target, buffered};
use crate::quantities::Show;
use crate::record_args::RecordArgs;
use crate::text::{self, column, shown};
use crate::{Failure, Streams};

/// Show what a file of measured accelerations holds
///
/// Which column is time and which are accelerations, by their names and units, else by their places; the sampling rate, the peaks
/// of each channel, and what is odd: lines that cannot be used, gaps, offset, drift, clipping, a shock that is cut off.
///
/// Text is read as loggers and programs write it: with commas, semicolons, tabs or blanks between columns, decimal points or
/// commas, lines above the numbers, units in brackets or below the names, comments, times of day and dates.
///
/// `-o FILE` writes the record anew: .csv, .npy (time and channels as columns, in s and m/s2), or a picture as .svg.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  clatter record drop.csv
  clatter record drop.csv --acceleration=az -o drop.svg
  clatter record logger.txt --units=ms,g -o drop.csv")]
pub(crate) struct Args {
    /// A file of measured accelerations; - is standard input
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    file: PathBuf,
    #[command(flatten)]
    reading: RecordArgs,
    #[command(flatten)]
    condition: ConditionArgs,
    /// File to write, ending in .csv, .npy or .svg; what was there is replaced once the new file is whole
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath, value_parser = target)]
    output: Vec<Target>,
    /// How to show the answer
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
}

fn target(text: &str) -> Result<Target, String> {
    Target::of(text, &[Kind::Csv, Kind::Npy, Kind::Svg])
}

/// Offsets are judged by what they do to a spectrum from this frequency on, in Hz: where that of `clatter spectrum` begins.
pub(crate) const LOWEST_HZ: f64 = 10.0;

impl Args {
    pub(crate) fn files(&self) -> Files<'_> {
        Files { reads: vec![&self.file], writes: self.output.iter().map(|target| target.path.as_path()).collect() }
    }

    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let record = self.condition.apply(self.reading.read(&self.file)?, &self.file)?;
        for target in &self.output {
            output::replace(&target.path, |file| match target.kind {
                Kind::Npy => buffered(file, |out| npy::write(out, record.samples(), &rows(&record))),
                Kind::Svg => file.write_all(picture(&record)?.as_bytes()),
                _ => buffered(file, |out| csv(&record, out)),
            })?;
        }
        let findings = record.findings(LOWEST_HZ);
        match self.format {
            Format::Table => self.table(&record, streams.out).map_err(Failure::Answer)?,
            Format::Json => streams.json(&Answer::new(&self.file, &record, &findings))?,
        }
        for finding in &findings {
            streams.note("warning", format_args!("{}: {finding}", text::path(&self.file)));
        }
        Ok(())
    }

    fn table(&self, record: &Record, out: &mut dyn Write) -> io::Result<()> {
        let time = Show { unit: time_unit(record.duration_s()), name: "s" };
        let steps = match record.step_s() {
            Some(step_s) => {
                let rate = Show { unit: rate_unit(step_s.recip()), name: "Hz" };
                let step = Show { unit: time_unit(step_s), name: "s" };
                format!("every {}: {}", step.said(step_s), rate.said(step_s.recip()))
            }
            None => "uneven in time".to_owned(),
        };
        let (n, duration) = (record.samples(), time.said(record.duration_s()));
        writeln!(
            out,
            "{}: {n} samples in {duration} from {} s on, {steps}\n",
            text::path(&self.file),
            figures(record.start_s())
        )?;
        let width = 24;
        let (heading, _) = column("channel", width);
        writeln!(out, "{heading}{:>10}{:>14}{:>14}{:>14}{:>14}", "unit", "largest", "at", "smallest", "at")?;
        let (none, _) = column("", width);
        writeln!(out, "{none}{:>10}{:>14}{:>14}{:>14}{:>14}", "", "m/s2", time.name(), "m/s2", time.name())?;
        for channel in record.channels() {
            let [high, low] = extremes(channel);
            let (name, _) = column(&shown(&channel.name, width - 1), width);
            let (unit, cells) = (shown(&channel.unit, 9), [high, low].map(|i| (channel.values[i], record.since_s(i))));
            write!(out, "{name}{unit:>10}")?;
            for (value, since_s) in cells {
                write!(out, "{:>14}{:>14}", figures(value), time.figures(since_s))?;
            }
            writeln!(out)?;
        }
        for target in &self.output {
            writeln!(out, "\n{}: written", text::path(&target.path))?;
        }
        Ok(())
    }
}

/// The first samples that hold the largest and the smallest value.
fn extremes(channel: &Channel) -> [usize; 2] {
    let values = &channel.values;
    let first = |beyond: fn(f64, f64) -> bool| {
        values.iter().enumerate().fold(0, |best, (i, value)| if beyond(*value, values[best]) { i } else { best })
    };
    [first(|a, b| a > b), first(|a, b| a < b)]
}

/// A unit in which a time has a few digits before its point.
fn time_unit(time_s: f64) -> Option<&'static Unit> {
    let name = match time_s {
        t if t < 1e-3 => "us",
        t if t < 1.0 => "ms",
        _ => return None,
    };
    TIME.units.iter().find(|unit| unit.name == name)
}

fn rate_unit(hz: f64) -> Option<&'static Unit> {
    clatter_assess::units::FREQUENCY.units.iter().find(|unit| unit.name == "kHz" && hz >= 1e3)
}

/// Time and channels of each sample, in s and m/s².
fn rows(record: &Record) -> Vec<f64> {
    let row = |i: usize| {
        std::iter::once(record.start_s() + record.since_s(i)).chain(record.channels().iter().map(move |c| c.values[i]))
    };
    (0..record.samples()).flat_map(row).collect()
}

fn csv(record: &Record, out: &mut dyn Write) -> io::Result<()> {
    let names = record.channels().iter().map(|channel| text::field(&format!("{} [m/s2]", channel.name)));
    writeln!(out, "time [s],{}", names.collect::<Vec<_>>().join(","))?;
    for (i, since_s) in record.times_s().enumerate() {
        write!(out, "{}", digits(record.start_s() + since_s))?;
        for channel in record.channels() {
            write!(out, ",{}", digits(channel.values[i]))?;
        }
        writeln!(out)?;
    }
    Ok(())
}

/// All channels over time; in g where the file is.
fn picture(record: &Record) -> Result<String, FigureError> {
    let in_g = record.channels().iter().all(|channel| channel.unit.to_lowercase().contains('g'));
    let unit = if in_g { ACCELERATION.units.iter().find(|unit| unit.name == "g") } else { None };
    let value = Show { unit, name: "m/s²" };
    let time = Show { unit: time_unit(record.duration_s()), name: "s" };
    let points = |channel: &Channel| {
        let point = |(since_s, a): (f64, &f64)| (time.value(since_s), value.value(*a));
        record.times_s().zip(&channel.values).map(point).collect()
    };
    let traces: Vec<_> =
        record.channels().iter().map(|channel| Trace { name: &channel.name, points: points(channel) }).collect();
    clatter_figures::record(&traces, [&format!("time, {}", time.name()), value.name()])
}

#[derive(Serialize)]
struct Answer<'a> {
    file: &'a Path,
    samples: usize,
    start_s: Json,
    duration_s: Json,
    /// Null where the samples are uneven.
    step_s: Option<Json>,
    sample_rate_hz: Option<Json>,
    channels: Vec<ChannelJson<'a>>,
    findings: Vec<String>,
}

#[derive(Serialize)]
struct ChannelJson<'a> {
    name: &'a str,
    unit: &'a str,
    largest_m_s2: Json,
    largest_time_s: Json,
    smallest_m_s2: Json,
    smallest_time_s: Json,
}

impl<'a> Answer<'a> {
    fn new(file: &'a Path, record: &'a Record, findings: &[Finding]) -> Self {
        let channel = |channel: &'a Channel| {
            let [high, low] = extremes(channel);
            let [at_high, at_low] = [high, low].map(|i| Json(record.start_s() + record.since_s(i)));
            let [high, low] = [high, low].map(|i| Json(channel.values[i]));
            ChannelJson {
                name: &channel.name,
                unit: &channel.unit,
                largest_m_s2: high,
                largest_time_s: at_high,
                smallest_m_s2: low,
                smallest_time_s: at_low,
            }
        };
        Self {
            file,
            samples: record.samples(),
            start_s: Json(record.start_s()),
            duration_s: Json(record.duration_s()),
            step_s: record.step_s().map(Json),
            sample_rate_hz: record.step_s().map(|step_s| Json(step_s.recip())),
            channels: record.channels().iter().map(channel).collect(),
            findings: findings.iter().map(Finding::to_string).collect(),
        }
    }
}
