//! `clatter scatter`: how likely each part of a product survives, and what that hangs on.

use std::convert::Infallible;
use std::io::{self, BufWriter, Write};
use std::path::PathBuf;

use clap::ValueHint;
use clatter_scene::scatter::{
    Column, ComponentScatter, Driver, Input, Probability, Progress, Sampler, Scatter, Settings,
};
use clatter_scene::{Component, ProductFile};
use serde::Serialize;

use crate::inputs::RowFormat;
use crate::numbers::{Json, digits, figures, given};
use crate::text::{column, field, shown};
use crate::{Failure, Streams, assess, output, progress};

/// Tell how likely each part of a product survives, and what that hangs on
///
/// Draws drops of the product from the distributions in its file (a plain range counts as equally likely all over it;
/// with first = "either" both ends are) and compares what each part goes through with its limits: without gravity and
/// at small tilt, the cheapest model, which 'clatter assess' holds against the others. The probability that a part
/// survives comes with the interval of Clopper and Pearson, which holds the truth at least as often as it says, and
/// with what it is at least.
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
  clatter scatter handheld.toml --samples=2000 -o samples.csv")]
pub(crate) struct Args {
    /// Product file
    #[arg(value_name = "PRODUCT.toml", value_hint = ValueHint::FilePath)]
    product: PathBuf,
    /// How many drops to draw, 1 to 1e12
    #[arg(long, value_name = "N", default_value = "1e5", allow_hyphen_values = true, value_parser = samples)]
    samples: u64,
    /// Another seed draws other drops
    #[arg(long, value_name = "S", default_value = "1", allow_hyphen_values = true, value_parser = seed)]
    seed: u64,
    /// How sure the intervals are, between 0 and 1
    #[arg(long, value_name = "P", default_value = "0.95", allow_hyphen_values = true, value_parser = confidence)]
    confidence: f64,
    /// Also write every sample to this file, ending in .csv: its drop, its frequencies and the utilization of every
    /// part
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath, value_parser = csv_file)]
    output: Option<PathBuf>,
    /// How to show the answer
    #[arg(long, value_enum, default_value_t = RowFormat::Table)]
    format: RowFormat,
}

fn samples(text: &str) -> Result<u64, String> {
    let wrong = || format!("'{text}' is not a number of samples: a whole number from 1 to 1e12");
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
    text.parse().map_err(|_| format!("'{text}' is not a seed: a whole number from 0 to {}", u64::MAX))
}

fn confidence(text: &str) -> Result<f64, String> {
    let good = text.parse::<f64>().ok().filter(|p| *p > 0.0 && *p < 1.0);
    good.ok_or_else(|| format!("'{text}' is not a confidence: between 0 and 1, such as 0.95"))
}

fn csv_file(text: &str) -> Result<PathBuf, &'static str> {
    let path = PathBuf::from(text);
    let csv = path.extension().is_some_and(|ending| ending == "csv");
    if csv { Ok(path) } else { Err("the file must end in .csv") }
}

impl Args {
    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let file = assess::read(&self.product)?;
        let settings = Settings { samples: self.samples, seed: self.seed, confidence: self.confidence };
        let sampler = Sampler::new(&file, settings)?;
        let scatter = {
            let mut bar = progress::Progress::new(streams.err, streams.interactive, self.samples);
            bar.stage("drawing");
            match &self.output {
                None => {
                    let watch = |progress: &Progress<'_>| {
                        bar.at(progress.done);
                        Ok::<(), Infallible>(())
                    };
                    let Ok(scatter) = sampler.run(false, watch);
                    scatter
                }
                Some(path) => {
                    let mut drawn = None;
                    output::replace(path, |target| {
                        let mut out = BufWriter::with_capacity(1 << 16, target);
                        drawn = Some(rows(&sampler, &file, &mut out, |done| bar.at(done))?);
                        out.flush()
                    })?;
                    let Some(scatter) = drawn else { unreachable!("a file that was written was drawn") };
                    scatter
                }
            }
        };
        match self.format {
            RowFormat::Table => table(&file, &scatter, streams.out).map_err(Failure::Answer)?,
            RowFormat::Csv => csv(&scatter, streams.out).map_err(Failure::Answer)?,
            RowFormat::Json => return streams.json(&Answer::new(&file, &scatter)),
        }
        Ok(())
    }
}

/// Draws and writes every sample.
fn rows(sampler: &Sampler, file: &ProductFile, out: &mut impl Write, mut done: impl FnMut(u64)) -> io::Result<Scatter> {
    let columns = sampler.columns();
    let name = |i: &usize| file.components.get(*i).map_or("", |component| component.name.as_str());
    write!(out, "sample")?;
    for column in &columns {
        let title = match column {
            Column::First => "first".to_owned(),
            Column::SpeedMS => "speed_m_s".to_owned(),
            Column::TiltDeg => "tilt_deg".to_owned(),
            Column::Restitution => "restitution".to_owned(),
            Column::FrequencyHz(i) => format!("frequency_hz of {}", name(i)),
            Column::Utilization(i) => format!("utilization of {}", name(i)),
        };
        write!(out, ",{}", field(&title))?;
    }
    writeln!(out)?;
    let mut sample = 0_u64;
    sampler.run(true, |progress: &Progress<'_>| {
        for row in progress.values.chunks(columns.len()) {
            write!(out, "{sample}")?;
            for (column, value) in columns.iter().zip(row) {
                match column {
                    Column::First => write!(out, ",{}", if *value < 0.5 { "a" } else { "b" })?,
                    _ => write!(out, ",{}", digits(*value))?,
                }
            }
            writeln!(out)?;
            sample += 1;
        }
        done(progress.done);
        Ok::<(), io::Error>(())
    })
}

/// How an input is called in a table: its name; a frequency is the part's own.
fn called(input: &Input) -> &'static str {
    match input {
        Input::Frequency(_) => "own frequency",
        Input::First => "first end",
        other => other.name(),
    }
}

/// Which way it goes, where that accounts for at least half of what the input does.
fn way(driver: &Driver) -> &'static str {
    let share = driver.share;
    match (&driver.input, share.trend * share.trend >= 0.5 * share.variance, share.trend > 0.0) {
        // two values have no way in between
        (Input::First, _, true) => " (b)",
        (Input::First, _, false) => " (a)",
        (_, false, _) => "~",
        (_, true, true) => "+",
        (_, true, false) => "-",
    }
}

/// Inputs that explain less than this share are not named in a table.
const NAMED: f64 = 0.01;

fn table(file: &ProductFile, scatter: &Scatter, out: &mut dyn Write) -> io::Result<()> {
    let Settings { samples, seed, confidence } = scatter.settings;
    let product = shown(&file.product.name, 60);
    let sure = given(100.0 * confidence);
    writeln!(out, "{product}: {samples} drops drawn with seed {seed}, without gravity, at small tilt")?;
    let Probability { estimate, at_least, .. } = scatter.survival;
    let percent = |p: f64| if p >= 1.0 { "100".to_owned() } else { figures(100.0 * p) };
    writeln!(
        out,
        "All parts survive in {} % of them; in at least {} % of all drops ({sure} % confidence)",
        percent(estimate),
        percent(at_least)
    )?;
    if !scatter.assumed_even.is_empty() {
        let name = |input: &Input| match input {
            Input::Frequency(i) => {
                format!("frequency of {}", shown(file.components.get(*i).map_or("", |c: &Component| &c.name), 24))
            }
            other => other.name().to_owned(),
        };
        let names: Vec<_> = scatter.assumed_even.iter().map(name).collect();
        writeln!(out, "Taken as equally likely all over the range: {}", names.join(", "))?;
    }
    writeln!(out)?;
    let wide = scatter.components.iter().map(|c| column(&shown(&c.name, 24), 0).1).max().unwrap_or(0).max(4);
    writeln!(
        out,
        "{:<wide$}  {:>9}  {:>9}  {:>19}  {:>11}  {:>9}   driven by",
        "part",
        "survives",
        "at least",
        format!("{sure} % interval"),
        "utilization",
        "largest"
    )?;
    writeln!(out, "{:<wide$}  {:>9}  {:>9}  {:>19}  {:>11}", "", "%", "%", "%", "mean")?;
    for component in &scatter.components {
        let Probability { estimate, lo, hi, at_least } = component.survival;
        let drivers: Vec<String> = component
            .drivers
            .iter()
            .filter(|driver| driver.share.variance >= NAMED)
            .take(4)
            .map(|driver| format!("{}{} {:.0} %", called(&driver.input), way(driver), 100.0 * driver.share.variance))
            .collect();
        let line = format!(
            "{}  {:>9}  {:>9}  {:>9} {:>9}  {:>11}  {:>9}   {}",
            column(&shown(&component.name, 24), wide).0,
            percent(estimate),
            percent(at_least),
            percent(lo),
            percent(hi),
            figures(component.mean_utilization),
            figures(component.largest_utilization),
            drivers.join(", ")
        );
        writeln!(out, "{}", line.trim_end())?;
    }
    Ok(())
}

fn csv(scatter: &Scatter, out: &mut dyn Write) -> io::Result<()> {
    writeln!(
        out,
        "name,samples,failed,survival,interval_lo,interval_hi,at_least,mean_utilization,largest_utilization"
    )?;
    let samples = scatter.settings.samples;
    for ComponentScatter { name, failures, survival, mean_utilization, largest_utilization, .. } in &scatter.components
    {
        let numbers = [survival.estimate, survival.lo, survival.hi, survival.at_least];
        let numbers = numbers.into_iter().chain([*mean_utilization, *largest_utilization]).map(digits);
        writeln!(out, "{},{samples},{failures},{}", field(name), numbers.collect::<Vec<_>>().join(","))?;
    }
    Ok(())
}

#[derive(Serialize)]
struct Answer<'a> {
    product: &'a str,
    samples: u64,
    seed: u64,
    confidence: Json,
    model: ModelJson,
    inputs: Vec<InputJson>,
    survival: SurvivalJson,
    components: Vec<ComponentJson<'a>>,
}

#[derive(Serialize)]
struct ModelJson {
    bar: &'static str,
    reason: &'static str,
}

#[derive(Serialize)]
struct InputJson {
    input: &'static str,
    /// Index of the component whose frequency it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    component: Option<usize>,
    /// Whether the file gives no distribution, only a range.
    assumed_uniform: bool,
}

#[derive(Serialize)]
struct SurvivalJson {
    probability: Json,
    interval: [Json; 2],
    at_least: Json,
}

#[derive(Serialize)]
struct ComponentJson<'a> {
    name: &'a str,
    failed: u64,
    survival: SurvivalJson,
    limits: Vec<LimitJson>,
    utilization: UtilizationJson,
    drivers: Vec<DriverJson>,
}

#[derive(Serialize)]
struct LimitJson {
    limit: &'static str,
    failed: u64,
}

#[derive(Serialize)]
struct UtilizationJson {
    mean: Json,
    standard_deviation: Json,
    largest: Json,
    largest_sample: u64,
}

#[derive(Serialize)]
struct DriverJson {
    input: &'static str,
    variance_share: Json,
    trend: Json,
}

impl SurvivalJson {
    fn new(p: Probability) -> Self {
        Self { probability: Json(p.estimate), interval: [Json(p.lo), Json(p.hi)], at_least: Json(p.at_least) }
    }
}

impl<'a> Answer<'a> {
    fn new(file: &'a ProductFile, scatter: &'a Scatter) -> Self {
        let Settings { samples, seed, confidence } = scatter.settings;
        let input = |input: &Input| InputJson {
            input: input.name(),
            component: if let Input::Frequency(i) = input { Some(*i) } else { None },
            assumed_uniform: scatter.assumed_even.contains(input),
        };
        let driver = |driver: &Driver| DriverJson {
            input: driver.input.name(),
            variance_share: Json(driver.share.variance),
            trend: Json(driver.share.trend),
        };
        let component = |c: &'a ComponentScatter| ComponentJson {
            name: &c.name,
            failed: c.failures,
            survival: SurvivalJson::new(c.survival),
            limits: c.limits.iter().map(|(kind, failed)| LimitJson { limit: kind.name(), failed: *failed }).collect(),
            utilization: UtilizationJson {
                mean: Json(c.mean_utilization),
                standard_deviation: Json(c.utilization_deviation),
                largest: Json(c.largest_utilization),
                largest_sample: c.worst_sample,
            },
            drivers: c.drivers.iter().map(driver).collect(),
        };
        Self {
            product: &file.product.name,
            samples,
            seed,
            confidence: Json(confidence),
            model: ModelJson { bar: "map", reason: "millions of drops: small tilt, no gravity" },
            inputs: scatter.inputs.iter().map(input).collect(),
            survival: SurvivalJson::new(scatter.survival),
            components: scatter.components.iter().map(component).collect(),
        }
    }
}
