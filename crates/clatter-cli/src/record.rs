//! This module is `clatter record`: it shows the content of a file of measurements, and writes it anew.

mod pulse;
mod shocks;

use std::borrow::Cow;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::ValueHint;
use clatter_answer::record::{self, Answer, Question, extremes, time_s};
use clatter_figures::{FigureError, Trace};
use clatter_product::units::{ACCELERATION, FREQUENCY, TIME, Unit};
use clatter_record::{Channel, Record, Series, TimeAxis, write_parquet};
use clatter_shock::{Pulse, Shock};
use serde::Serialize;

use crate::condition_args::ConditionArgs;
use crate::excitation;
use crate::find_args::FindArgs;
use crate::inputs::RowFormat;
use crate::numbers::{digits, figures};
use crate::output::{self, Files, Kind, Target, buffered};
use crate::quantities::Show;
use crate::record_args::RecordArgs;
use crate::text::{self, column, shown};
use crate::{Failure, Streams, npy};

/// Show what a file of measured accelerations holds
///
/// Which column is time and which are accelerations, by their names and units, else by their places; the sampling rate, the peaks
/// of each channel, and what is odd: lines that cannot be used, gaps, offset, drift, clipping, a shock that is cut off.
///
/// Text is read as loggers and programs write it: with commas, semicolons, tabs or blanks between columns, decimal points or
/// commas, lines above the numbers, units in brackets, below the names or in the cells, comments, times of day and dates. The last
/// line of the answer says what every line and every column was taken for.
///
/// `-o FILE` writes the record anew, in s and m/s2: .csv, .parquet, .npy (a structured
/// array, whose fields are named as the columns of the .csv, such as `time [s]`), or a picture as .svg. Channels with times of their
/// own follow on a column of them, `time 2 [s]`; what is shorter than others is filled up with nothing, or with NaN.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  clatter record drop.csv
  clatter record drop.csv --acceleration=az -o drop.svg
  clatter record logger.txt --units=ms,g -o drop.csv
  clatter record day.csv --detrend=mean --find --format=csv
  clatter record table.csv --low-pass=1650 --fit-pulse --nominal=half-sine,50gn,11ms -o pulse.svg")]
pub(crate) struct Args {
    /// A file of measured accelerations; - is standard input
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    file: PathBuf,
    #[command(flatten)]
    reading: RecordArgs,
    #[command(flatten)]
    condition: ConditionArgs,
    #[command(flatten)]
    finding: FindArgs,
    /// Fit a half-sine, a haversine and a terminal-peak sawtooth to the largest shock, and hold it against the tolerances of
    /// standards
    #[arg(long)]
    fit_pulse: bool,
    /// The pulse that tolerances are about, such as half-sine,50gn,11ms or JESD22-B110/B [default: the best that fits]
    #[arg(long, value_name = "PULSE", requires = "fit_pulse", value_parser = nominal)]
    nominal: Option<Pulse>,
    /// Also velocity and displacement, integrated from rest: their last values, and in files a column each
    #[arg(long)]
    integrate: bool,
    /// File to write, ending in .csv, .npy, .parquet or .svg; what was there is replaced once the new file is whole
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath, value_parser = target)]
    output: Vec<Target>,
    /// How to show the answer
    #[arg(long, value_enum, default_value_t = RowFormat::Table)]
    format: RowFormat,
}

fn nominal(text: &str) -> Result<Pulse, String> {
    excitation::pulse(text)?.pulses.first().copied().ok_or_else(|| "no pulse".to_owned())
}

fn target(text: &str) -> Result<Target, String> {
    Target::of(text, &[Kind::Csv, Kind::Npy, Kind::Parquet, Kind::Svg])
}

impl Args {
    pub(crate) fn files(&self) -> Files<'_> {
        Files { reads: vec![&self.file], writes: self.output.iter().map(|target| target.path.as_path()).collect() }
    }

    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let record = self.condition.apply(self.reading.read(&self.file)?, &self.file)?;
        let mut question = Question::new(&record);
        question.find = self.finding.search();
        (question.fit_pulse, question.nominal, question.integrate) = (self.fit_pulse, self.nominal, self.integrate);
        let bad = |reason| Failure::Record { path: self.file.clone(), reason };
        let whole = Whole { args: self, record: &record, answer: &record::answer(&question).map_err(bad)? };
        for target in &self.output {
            output::replace(&target.path, |file| match target.kind {
                Kind::Npy => buffered(file, |out| whole.npy(out)),
                Kind::Svg => file.write_all(whole.picture()?.as_bytes()),
                Kind::Parquet => file.write_all(&whole.parquet()?),
                _ => buffered(file, |out| whole.csv(out)),
            })?;
        }
        match (self.format, &whole.answer.shocks) {
            (RowFormat::Table, _) => whole.table(streams.out).map_err(Failure::Answer)?,
            (RowFormat::Json, _) => streams.json(&OfFile { file: &self.file, answer: whole.answer })?,
            (RowFormat::Csv, Some(found)) => {
                shocks::csv(&record, found, streams.out).map_err(Failure::Answer)?;
            }
            (RowFormat::Csv, None) => whole.channels_csv(streams.out).map_err(Failure::Answer)?,
        }
        for finding in &whole.answer.findings {
            streams.note("warning", format_args!("{}: {finding}", text::path(&self.file)));
        }
        Ok(())
    }
}

/// The answer for programs.
#[derive(Serialize)]
struct OfFile<'a> {
    file: &'a Path,
    #[serde(flatten)]
    answer: &'a Answer<'a>,
}

/// A record and all that goes with it.
struct Whole<'a> {
    args: &'a Args,
    record: &'a Record,
    answer: &'a Answer<'a>,
}

/// Describes a time axis: the number of samples, their duration and their start.
fn said(times: &TimeAxis) -> String {
    let time = Show { unit: time_unit(times.duration_s()), name: "s" };
    let steps = match times.step_s() {
        Some(step_s) => {
            let rate = Show { unit: rate_unit(step_s.recip()), name: "Hz" };
            let step = Show { unit: time_unit(step_s), name: "s" };
            format!("every {}: {}", step.said(step_s), rate.said(step_s.recip()))
        }
        None => "uneven in time".to_owned(),
    };
    let (n, duration) = (times.samples(), time.said(times.duration_s()));
    format!("{n} samples in {duration} from {} s on, {steps}", figures(times.start_s()))
}

/// Returns the time of the first sample in a table: that of the file, but 0 for one of a clock, beside which the record is short.
fn begin_s(times: &TimeAxis) -> f64 {
    /// A time of six digits tells a thousandth of the record.
    const SHORT: f64 = 1e3;
    let start_s = times.start_s();
    if start_s.abs() <= SHORT * times.duration_s() { start_s } else { 0.0 }
}

/// A column of a file.
struct ColumnOut<'a> {
    name: String,
    unit: &'static str,
    values: Cow<'a, [f64]>,
}

impl ColumnOut<'_> {
    /// Writes the column as headings have it.
    fn heading(&self) -> String {
        format!("{} [{}]", self.name, self.unit)
    }
}

impl Whole<'_> {
    fn table(&self, out: &mut dyn Write) -> io::Result<()> {
        let record = self.record;
        let times = record.times();
        let longest_s = times.iter().map(|times| times.duration_s()).fold(0.0, f64::max);
        let time = Show { unit: time_unit(longest_s), name: "s" };
        let from_first = times.iter().any(|times| begin_s(times).to_bits() != times.start_s().to_bits());
        let file = text::path(&self.args.file);
        match times[..] {
            [times] => writeln!(out, "{file}: {}\n", said(times))?,
            _ => writeln!(out, "{file}: channels with times of their own\n")?,
        }
        let width = 24;
        let (heading, _) = column("channel", width);
        writeln!(out, "{heading}{:>10}{:>14}{:>14}{:>14}{:>14}", "unit", "largest", "at", "smallest", "at")?;
        let (none, _) = column("", width);
        writeln!(out, "{none}{:>10}{:>14}{:>14}{:>14}{:>14}", "", "m/s2", time.name(), "m/s2", time.name())?;
        for channel in record.channels() {
            let [high, low] = extremes(channel);
            let (name, _) = column(&shown(&channel.name, width - 1), width);
            let (unit, cells) = (
                shown(&channel.unit, 9),
                [high, low].map(|i| (channel.values[i], begin_s(channel.times()) + channel.times().since_s(i))),
            );
            write!(out, "{name}{unit:>10}")?;
            for (value, since_s) in cells {
                write!(out, "{:>14}{:>14}", figures(value), time.figures(since_s))?;
            }
            writeln!(out)?;
            if times.len() > 1 {
                writeln!(out, "    {}", said(channel.times()))?;
            }
        }
        if from_first {
            writeln!(out, "\nTimes count from the first sample.")?;
        }
        for (k, channel) in record.channels().iter().enumerate() {
            let name = shown(&channel.name, 40);
            if let Some(motions) = &self.answer.motions {
                let [velocity, displacement] = record::end(&motions[k]).map(figures);
                writeln!(out, "\n{name}: at the end {velocity} m/s and {displacement} m, from rest")?;
            }
            if let Some(found) = &self.answer.shocks {
                shocks::table(channel, &name, &found[k], out)?;
            }
            if let Some(fits) = &self.answer.pulses {
                pulse::table(channel, &name, &fits[k], out)?;
            }
        }
        if let Some(account) = record.account() {
            let account = account.to_string();
            writeln!(out, "\n{}", text::visible(&account))?;
        }
        for target in &self.args.output {
            writeln!(out, "\n{}: written", text::path(&target.path))?;
        }
        Ok(())
    }

    fn channels_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        writeln!(out, "channel,unit,largest_m_s2,largest_time_s,smallest_m_s2,smallest_time_s")?;
        for channel in self.record.channels() {
            write!(out, "{},{}", text::field(&channel.name), text::field(&channel.unit))?;
            for i in extremes(channel) {
                write!(out, ",{},{}", digits(channel.values[i]), digits(time_s(channel, i)))?;
            }
            writeln!(out)?;
        }
        Ok(())
    }

    /// Returns the columns of a file: for each time axis the seconds, then the channels that were sampled together.
    fn columns(&self) -> Vec<ColumnOut<'_>> {
        let mut columns = Vec::new();
        for (n, times) in self.record.times().into_iter().enumerate() {
            let name = if n == 0 { "time".to_owned() } else { format!("time {}", n + 1) };
            let seconds = times.times_s().map(|since_s| times.start_s() + since_s).collect();
            columns.push(ColumnOut { name, unit: "s", values: Cow::Owned(seconds) });
            for (k, channel) in self.record.channels().iter().enumerate() {
                if !channel.times().is_that_of(times) {
                    continue;
                }
                let mut add =
                    |name, unit, values| columns.push(ColumnOut { name, unit, values: Cow::Borrowed(values) });
                add(channel.name.clone(), "m/s2", &channel.values[..]);
                if let Some(motions) = &self.answer.motions {
                    add(format!("velocity of {}", channel.name), "m/s", &motions[k].velocity_m_s[..]);
                    add(format!("displacement of {}", channel.name), "m", &motions[k].displacement_m[..]);
                }
            }
        }
        columns
    }

    /// Returns the columns filled up with NaN to the length of the longest, for files that have one length.
    fn filled(&self) -> Vec<ColumnOut<'_>> {
        let mut columns = self.columns();
        let rows = columns.iter().map(|column| column.values.len()).max().unwrap_or(0);
        for column in columns.iter_mut().filter(|column| column.values.len() < rows) {
            column.values.to_mut().resize(rows, f64::NAN);
        }
        columns
    }

    fn csv(&self, out: &mut dyn Write) -> io::Result<()> {
        let columns = self.columns();
        let names = columns.iter().map(|column| text::field(&column.heading()));
        writeln!(out, "{}", names.collect::<Vec<_>>().join(","))?;
        let rows = columns.iter().map(|column| column.values.len()).max().unwrap_or(0);
        for i in 0..rows {
            for (k, column) in columns.iter().enumerate() {
                let comma = if k > 0 { "," } else { "" };
                write!(out, "{comma}{}", column.values.get(i).map_or_else(String::new, |value| digits(*value)))?;
            }
            writeln!(out)?;
        }
        Ok(())
    }

    fn npy(&self, out: &mut impl Write) -> io::Result<()> {
        let columns = self.filled();
        let named: Vec<_> = columns.iter().map(|column| (column.heading(), &column.values[..])).collect();
        npy::write_columns(out, &named)
    }

    fn parquet(&self) -> io::Result<Vec<u8>> {
        let columns = self.filled();
        let series =
            columns.iter().map(|column| Series { name: &column.name, unit: column.unit, values: &column.values });
        write_parquet(&series.collect::<Vec<_>>()).map_err(io::Error::other)
    }

    /// Draws all channels over time, in gn where the file is; with a fitted pulse the part around it, and the pulse next to it.
    fn picture(&self) -> Result<String, FigureError> {
        let record = self.record;
        let in_g = record.channels().iter().all(|channel| channel.unit.to_lowercase().contains('g'));
        let unit = if in_g { ACCELERATION.unit("gn") } else { None };
        let value = Show { unit, name: "m/s²" };
        let span = self.span();
        let longest_s = record.times().iter().map(|times| times.duration_s()).fold(0.0, f64::max);
        let time = Show { unit: time_unit(longest_s.min(span[1] - span[0])), name: "s" };
        let points = |channel: &Channel, values: &[f64], show: &Show| -> Vec<(f64, f64)> {
            let within = (0..values.len()).map(|i| (time_s(channel, i), values[i]));
            let within = within.filter(|(time_s, _)| (span[0]..=span[1]).contains(time_s));
            within.map(|(time_s, value)| (time.value(time_s), show.value(value))).collect()
        };
        let (title, velocity, length) =
            (value.name(), Show { unit: None, name: "m/s" }, Show { unit: None, name: "m" });
        let mut traces = Vec::new();
        for (k, channel) in record.channels().iter().enumerate() {
            let start_s = channel.times().start_s();
            let marks = self.answer.shocks.as_ref().map_or(Vec::new(), |found| {
                let mark = |shock: &Shock| (time.value(start_s + shock.peak_time_s), value.value(shock.peak_m_s2));
                found[k].shocks.iter().map(mark).collect()
            });
            let beside = self.answer.pulses.as_ref().map(|fits| {
                let curve = pulse::curve(&fits[k]).into_iter();
                let point = |(since_s, a)| (time.value(start_s + since_s), value.value(a));
                ("nominal pulse", curve.map(point).collect::<Vec<_>>())
            });
            traces.push(Trace {
                name: &channel.name,
                title,
                points: points(channel, &channel.values, &value),
                marks,
                beside,
            });
            if let Some(motions) = &self.answer.motions {
                let plain = |name, title, points| Trace { name, title, points, marks: Vec::new(), beside: None };
                traces.push(plain("velocity", "m/s", points(channel, &motions[k].velocity_m_s, &velocity)));
                traces.push(plain("displacement", "m", points(channel, &motions[k].displacement_m, &length)));
            }
        }
        clatter_figures::record(&traces, &format!("time, {}", time.name()))
    }

    /// Returns the time span of the picture, in seconds on the axis of the file.
    fn span(&self) -> [f64; 2] {
        match (self.answer.pulses.as_deref(), self.record.channels()) {
            (Some([fitted, ..]), [channel, ..]) => {
                let Pulse { start, duration, .. } = fitted.nominal;
                let begin_s = channel.times().start_s() + start;
                [begin_s - duration, begin_s + 2.0 * duration]
            }
            _ => [f64::NEG_INFINITY, f64::INFINITY],
        }
    }
}

/// Returns a unit in which a time has a few digits before its point.
fn time_unit(time_s: f64) -> Option<&'static Unit> {
    let name = match time_s {
        t if t < 1e-3 => "us",
        t if t < 1.0 => "ms",
        _ => return None,
    };
    TIME.units.iter().find(|unit| unit.name == name)
}

fn rate_unit(hz: f64) -> Option<&'static Unit> {
    FREQUENCY.units.iter().find(|unit| unit.name == "kHz" && hz >= 1e3)
}
