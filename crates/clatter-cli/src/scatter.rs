//! This module is `clatter scatter`: it shows how likely each part of a product survives, and which inputs decide that.

pub(crate) mod table;

use std::convert::Infallible;
use std::io::{self, BufWriter, Write};
use std::path::PathBuf;

use clap::ValueHint;
use clatter_answer::scatter::Answer;
use clatter_assess::scatter::{Column, Progress, Sampler, Scatter, Settings};
use clatter_product::{Input, ProductFile, Stops, units::Quantity};

use crate::input::is_standard;
use crate::inputs::{self, RowFormat};
use crate::numbers::digits;
use crate::output::Files;
use crate::progress::Counted;
use crate::text::{field, visible};
use crate::{Exit, Failure, Streams, assess, budget, output, quantities};

/// Tell how likely each part of a product survives, and what that hangs on
///
/// Draws drops and parts of the product from the distributions in its file (a plain range counts as equally likely all
/// over it; with first = "either" both ends are, and every direction of a plate without one) and compares what each part goes through with its limits. Drops are
/// answered as 'clatter assess' answers them, by the model with the most physics that the file allows. The probability that
/// a part survives comes with an interval that holds the truth at least as often as it says, and with what it is at
/// least; what answers may be off by widens both.
///
/// A plate is followed as the box that it is, with full rotation; where the file tells no thickness as one of a twentieth of its
/// length, which is told. One on feet is followed at small tilt, and what real tilt does is left out.
///
/// A sample of a box is one product that goes through all of its drops, and survives if it survives each: what the file says of
/// product and parts is drawn once for it, height or speed and attitude for each drop, every attitude within the tolerance
/// equally likely. Told are the survival of the whole sequence and of each drop. A drop is followed past its first landing
/// where the energy left may decide; where it still may in the end, or friction of the ground may, the sample is open, and widens the intervals.
///
/// What drives a part: the share of the variance of its utilization (demand over allowed) that an input explains alone
/// (first-order index of Sobol), and the way it goes: + more is worse, - less is worse, ~ neither throughout.
///
/// Sample k is the same for a seed whatever the number of samples, threads or the machine.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  clatter scatter handheld.toml
  clatter scatter handheld.toml --samples=1e6 --seed=7 --format=json
  clatter scatter handheld.toml --target=99.9%       exit status 1 where that is not sure
  clatter scatter handheld.toml --samples=2000 -o samples.csv
  clatter scatter handheld-transit.toml              26 drops of a box, one by one and in sequence

Exit status: 0 done, 1 the target is missed, 2 bad input.")]
pub(crate) struct Args {
    /// Product file
    #[arg(value_name = "PRODUCT.toml", value_hint = ValueHint::FilePath)]
    product: PathBuf,
    /// How many drops, 1 to 1e12; of a box how many products, each of which goes through all drops [default: 1e5, of a box 1000]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = samples)]
    samples: Option<u64>,
    /// Another seed draws other drops
    #[arg(long, value_name = "S", default_value = "1", allow_hyphen_values = true, value_parser = seed)]
    seed: u64,
    /// How sure the intervals are, between 0 and 1
    #[arg(long, value_name = "P", default_value = "0.95", allow_hyphen_values = true, value_parser = confidence)]
    confidence: f64,
    /// Instant impacts closer than this are one: where the contact time is not known, a sample whose ends land so closely
    /// lands flat
    #[arg(long, value_name = "TIME", default_value = "1ms", allow_hyphen_values = true, value_parser = quantities::contact_time)]
    merge: Quantity,
    /// Survival of all parts that is to be sure, as a share: 0.999 or 99.9%; missed where the interval begins below it
    #[arg(long, value_name = "SHARE", allow_hyphen_values = true, value_parser = target)]
    target: Option<f64>,
    /// Also write every sample to this file, ending in .csv: its drop, what varies of the parts, and the
    /// utilization of every part; - writes them to standard output in place of the answer
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath, value_parser = output::ending("csv"))]
    output: Option<PathBuf>,
    /// How to show the answer
    #[arg(long, value_enum, default_value_t = RowFormat::Table)]
    format: RowFormat,
}

fn samples(text: &str) -> Result<u64, String> {
    let wrong = || format!("'{}' is not a number of samples: a whole number from 1 to 1e12", visible(text));
    let whole = if let Ok(whole) = text.parse::<u64>() {
        whole
    } else {
        let number: f64 = text.parse().map_err(|_| wrong())?;
        if !(1.0..=1e12).contains(&number) || number.fract() != 0.0 {
            return Err(wrong());
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole and in 1 ..= 1e12")]
        let whole = number as u64;
        whole
    };
    if (1..=1_000_000_000_000).contains(&whole) { Ok(whole) } else { Err(wrong()) }
}

fn seed(text: &str) -> Result<u64, String> {
    text.parse().map_err(|_| format!("'{}' is not a seed: a whole number from 0 to {}", visible(text), u64::MAX))
}

pub(crate) fn confidence(text: &str) -> Result<f64, String> {
    let good = text.parse::<f64>().ok().filter(|p| *p > 0.0 && *p < 1.0);
    good.ok_or_else(|| format!("'{}' is not a confidence: between 0 and 1, such as 0.95", visible(text)))
}

pub(crate) fn target(text: &str) -> Result<f64, String> {
    let share = inputs::share(text)?;
    let good = share > 0.0 && share < 1.0;
    if good { Ok(share) } else { Err(format!("target {share:?} is not between 0 and 1, such as 0.999 or 99.9%")) }
}

impl Args {
    pub(crate) fn files(&self) -> Files<'_> {
        Files { reads: vec![&self.product], writes: self.output.iter().map(AsRef::as_ref).collect() }
    }

    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<Exit, Failure> {
        output::in_place_of_answer(self.output.as_deref(), matches!(self.format, RowFormat::Table))?;
        let file = assess::read(&self.product, &self.files(), streams)?;
        let mut answer = Answer::new(&file, self.draw(&file, streams)?);
        answer.target = self.target;
        match self.format {
            // The samples are the answer.
            _ if self.output.as_deref().is_some_and(is_standard) => {}
            RowFormat::Table => table::table(&answer, streams.out).map_err(Failure::Answer)?,
            RowFormat::Csv => table::csv(&answer.scatter, streams.out).map_err(Failure::Answer)?,
            RowFormat::Json => streams.json(&answer)?,
        }
        Ok(if answer.is_met() { Exit::Done } else { Exit::Unsafe })
    }

    fn draw(&self, file: &ProductFile, streams: &mut Streams<'_>) -> Result<Scatter, Failure> {
        let samples = self.samples.unwrap_or_else(|| Settings::samples_of(file));
        let settings = Settings { samples, seed: self.seed, confidence: self.confidence, merge_s: self.merge.si };
        let sampler = Sampler::new(file, settings)?;
        let counted = Counted::begin("drawing", samples);
        let Some(path) = &self.output else {
            let count = |progress: &Progress<'_>| {
                counted.at(progress.done);
                Ok::<_, Infallible>(())
            };
            let Ok(scatter) = sampler.run(false, &budget::go_on, count);
            return Ok(scatter);
        };
        if is_standard(path) {
            return rows(&sampler, file, &mut streams.out, &counted).map_err(Failure::Answer);
        }
        let mut drawn = None;
        output::replace(path, |target| {
            let mut out = BufWriter::with_capacity(1 << 16, target);
            drawn = Some(rows(&sampler, file, &mut out, &counted)?);
            out.flush()
        })?;
        let Some(scatter) = drawn else { unreachable!("a file that was written was drawn") };
        Ok(scatter)
    }
}

/// Returns the heading of a column.
fn title(file: &ProductFile, column: Column) -> String {
    let there = |what: &str, n: usize| format!("{what} {}", file.drop_names()[n].there());
    match column {
        Column::Drop(input, None) => input.title(),
        Column::Drop(input, Some(n)) => there(&input.title(), n),
        Column::FrequencyHz(i) => format!("frequency_hz of {}", name_of(file, i)),
        Column::DampingRatio(i) => format!("damping_ratio of {}", name_of(file, i)),
        Column::Stop(i, n) => format!("{} of {}", Stops::INPUTS[n].column, name_of(file, i)),
        Column::PositionM(i) => format!("position_m of {}", name_of(file, i)),
        Column::AcrossM(i) => format!("position_across_m of {}", name_of(file, i)),
        Column::Limit(i, kind) => format!("{} limit of {}", kind.name(), name_of(file, i)),
        Column::CriticalAccelerationMS2(i) => format!("critical_acceleration_m_s2 of {}", name_of(file, i)),
        Column::LandingUtilization(n, i) => there(&format!("utilization of {}", name_of(file, i)), n),
        Column::Utilization(i) => format!("utilization of {}", name_of(file, i)),
        _ => "value".to_owned(),
    }
}

/// Draws and writes every sample, as long as it may go on.
fn rows(sampler: &Sampler, file: &ProductFile, out: &mut impl Write, counted: &Counted) -> io::Result<Scatter> {
    let columns = sampler.columns();
    write!(out, "sample")?;
    for column in &columns {
        write!(out, ",{}", field(&title(file, *column)))?;
    }
    writeln!(out)?;
    let mut sample = 0_u64;
    sampler.run(true, &budget::go_on, |progress: &Progress<'_>| {
        for row in progress.values.chunks(columns.len()) {
            write!(out, "{sample}")?;
            for (column, value) in columns.iter().zip(row) {
                match column {
                    Column::Drop(Input::First, None) => write!(out, ",{}", if *value < 0.5 { "a" } else { "b" })?,
                    // no answer
                    _ if value.is_nan() => write!(out, ",")?,
                    Column::Drop(input, _) if input.is_angle() => write!(out, ",{}", digits(value.to_degrees()))?,
                    _ => write!(out, ",{}", digits(*value))?,
                }
            }
            writeln!(out)?;
            sample += 1;
        }
        counted.at(progress.done);
        Ok::<_, io::Error>(())
    })
}

/// Returns the name of a part by its index.
fn name_of(file: &ProductFile, i: usize) -> &str {
    file.components.get(i).map_or("", |component| &component.name)
}
