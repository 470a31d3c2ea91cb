//! This module is `clatter design`: it finds the inertia ratios and restitutions that meet the limits, and the changes that would make
//! each failing part safe.

mod goals;
mod plane;
mod remedies;

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use clap::ValueHint;
use clatter::design::Goal;
use clatter_answer::design::Answer;
use clatter_assess::{
    Accuracy,
    design::{Bounds, Plane},
};
use clatter_figures::FigureError;
use clatter_product::ProductFile;

use crate::input::is_standard;
use crate::inputs::{self, RowFormat};
use crate::output::Files;
use crate::progress::Counted;
use crate::{Exit, Failure, Streams, assess, budget, output, quantities, text};

/// Tell which q and e meet the limits, and what would make each failing part safe
///
/// Of a product file: every part that 'clatter assess' does not find safe with the margin, and for each thing that can
/// be changed alone (the radius of gyration of a bar, the restitution e, the part's place, of a plate
/// or a box across it too, its natural frequency, its damping,
/// the contact time by a bumper, the room that the part has, what it stands) the smallest change that makes it so, or that
/// none does within the bounds. Values are rounded to what can be specified, two digits (places and the radius of gyration
/// to 1 mm of 140 mm), and assessed again as they are printed, a box in all of its drops; no mass is put outside of the body. Where no change alone is enough, two together, or how near one gets. Of goals (safe zones, in v0): where
/// in the plane of q and e they are met, and the front of the largest zone against q for each e. Without either, the
/// goals are the paper's example: v0/2 in the middle tenth of the bar, 2 v0 in nearly all of it; the designs of its
/// Table 1 stand beside the front.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  clatter design                                                 the paper's example
  clatter design --zone=0.5:0.1 --zone=2:0.85 --front=front.svg
  clatter design handheld.toml --margin=20%
  clatter design bar.toml -o plane.svg                           where in the plane of q and e its parts are safe
  clatter design bar.toml --q=0.3:0.7 --e=0.2:0.5 --format=json

'clatter --help' tells what q, e and the units are.")]
pub(crate) struct Args {
    /// Product file
    #[arg(value_name = "PRODUCT.toml", value_hint = ValueHint::FilePath)]
    product: Option<PathBuf>,
    /// Goal: shocks up to X v0 within S of the bar, its middle part in [0, 1]; may be given several times, and the
    /// first is the one whose zone the front enlarges
    #[arg(long, value_name = "X:S", allow_hyphen_values = true, value_parser = zone, conflicts_with = "product")]
    zone: Vec<Goal>,
    /// Goal: changes of the angular velocity up to W, in v0/L
    #[arg(long, value_name = "W", allow_hyphen_values = true, value_parser = turn, conflicts_with = "product")]
    turn: Option<Goal>,
    /// Inertia ratios that can be built, in [0, 1]
    #[arg(long, value_name = "LO:HI", default_value = "0:0.9", allow_hyphen_values = true, value_parser = unit_range)]
    q: [f64; 2],
    /// Coefficients of restitution that can be had, in [0, 1]
    #[arg(long, value_name = "LO:HI", default_value = "0.05:0.9", allow_hyphen_values = true, value_parser = unit_range)]
    e: [f64; 2],
    /// Largest factor on a natural frequency, up or down, above 1
    #[arg(long, value_name = "F", default_value = "4", allow_hyphen_values = true, value_parser = factor)]
    frequency_factor: f64,
    /// Damping ratios that can be had, in [0, 10]
    #[arg(long, value_name = "LO:HI", default_value = "0:0.5", allow_hyphen_values = true, value_parser = damping_range)]
    damping: [f64; 2],
    /// Contact times that can be had; a bumper that gives by d at the speed v takes (π/2)(1 + e) d/v
    #[arg(long, value_name = "LO:HI", default_value = "0.2ms:2ms", allow_hyphen_values = true, value_parser = contact_times)]
    contact_time: [f64; 2],
    /// Largest factor on what a part stands and on the room that it has, above 1
    #[arg(long, value_name = "F", default_value = "4", allow_hyphen_values = true, value_parser = factor)]
    limit_factor: f64,
    /// Margin allowed/demand - 1 that every limit of a part is to have: 0.2 or 20%; by
    /// both contact laws where contacts take time and the file names none
    #[arg(long, value_name = "SHARE", default_value = "10%", allow_hyphen_values = true, value_parser = margin)]
    margin: f64,
    /// Write the plane of q and e to this file: .svg a picture, .csv its borders or margins. Of a product within --q and
    /// --e, by the worst of drops all over its ranges, which takes some seconds: 41 by 41 values over the whole plane,
    /// 21 by 21 where contacts take time. It is a picture and no proof
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath, value_parser = target)]
    output: Option<PathBuf>,
    /// Write the fronts of the largest zone to this file: .svg a picture, .csv their points
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, value_parser = target, conflicts_with = "product")]
    front: Option<PathBuf>,
    /// How to show the answer
    #[arg(long, value_enum, default_value_t = RowFormat::Table)]
    format: RowFormat,
}

fn zone(text: &str) -> Result<Goal, String> {
    let (x, s) =
        text.split_once(':').ok_or("a goal is X:S, a velocity shock in v0 and the part of the bar, such as 0.5:0.1")?;
    Goal::zone(inputs::number(x.trim())?, inputs::share(s)?).map_err(|error| error.to_string())
}

fn turn(text: &str) -> Result<Goal, String> {
    Goal::turn(inputs::number(text)?).map_err(|error| error.to_string())
}

fn unit_range(text: &str) -> Result<[f64; 2], String> {
    range(text, 1.0)
}

fn damping_range(text: &str) -> Result<[f64; 2], String> {
    range(text, 10.0)
}

fn contact_times(text: &str) -> Result<[f64; 2], String> {
    let (lo, hi) = text.split_once(':').ok_or("a range is LO:HI, such as 0.2ms:2ms")?;
    let [lo, hi] = [quantities::contact_time(lo)?.si, quantities::contact_time(hi)?.si];
    if lo <= hi { Ok([lo, hi]) } else { Err("a range LO:HI begins at its lower end, such as 0.2ms:2ms".to_owned()) }
}

fn range(text: &str, most: f64) -> Result<[f64; 2], String> {
    let (lo, hi) = text.split_once(':').ok_or("a range is LO:HI, such as 0.1:0.6")?;
    let (lo, hi) = (inputs::share(lo)?, inputs::share(hi)?);
    if lo >= 0.0 && lo <= hi && hi <= most {
        Ok([lo, hi])
    } else {
        Err(format!("{lo:?}:{hi:?} is not a range LO:HI within [0, {most}]"))
    }
}

fn margin(text: &str) -> Result<f64, String> {
    let share = inputs::share(text)?;
    let good = (0.0..=100.0).contains(&share);
    if good { Ok(share) } else { Err(format!("margin {share:?} is not in [0, 100], 0 to 10000 %")) }
}

fn factor(text: &str) -> Result<f64, String> {
    let factor = inputs::number(text)?;
    let allowed = "above 1 and at most 1000";
    if factor > 1.0 && factor <= 1000.0 { Ok(factor) } else { Err(format!("factor {factor:?} is not {allowed}")) }
}

fn target(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("svg" | "csv") => Ok(path),
        _ if is_standard(&path) => Err(output::no_kind(&[".svg", ".csv"])),
        _ => Err("the file must end in .svg or .csv".to_owned()),
    }
}

/// Returns whether the path is that of a picture.
fn picture(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == "svg")
}

fn write(
    path: &Path,
    svg: impl FnOnce() -> Result<String, FigureError>,
    csv: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), Failure> {
    output::replace(path, |file: &mut File| {
        let mut out = BufWriter::new(file);
        if picture(path) {
            out.write_all(svg()?.as_bytes())?;
        } else {
            csv(&mut out)?;
        }
        out.flush()
    })
}

impl Args {
    pub(crate) fn files(&self) -> Files<'_> {
        Files {
            reads: self.product.iter().map(AsRef::as_ref).collect(),
            writes: self.output.iter().chain(&self.front).map(AsRef::as_ref).collect(),
        }
    }

    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<Exit, Failure> {
        match &self.product {
            Some(path) => {
                let file = assess::read(path, &self.files(), streams)?;
                self.of_product(&file, streams)
            }
            None => self.of_goals(streams).map(|()| Exit::Done),
        }
    }

    fn of_product(&self, file: &ProductFile, streams: &mut Streams<'_>) -> Result<Exit, Failure> {
        let bounds = Bounds {
            q: self.q,
            e: self.e,
            frequency_factor: self.frequency_factor,
            damping: self.damping,
            contact_time_s: self.contact_time,
            limit_factor: self.limit_factor,
        };
        let assessment = assess::watched(file, &Accuracy::default())?.assessment;
        let remedies = {
            let changes = Counted::begin("changing", 0);
            clatter_assess::remedies_watched(file, &assessment, &bounds, self.margin, &|done, all| {
                changes.of(done, all);
                budget::go_on()
            })?
        };
        let plane = {
            let _drawing = Counted::begin("drawing the plane", 0);
            let of = |_: &PathBuf| {
                let file = file.clone();
                budget::in_time(move || Plane::of(&file, &bounds))
            };
            self.output.as_ref().filter(|_| budget::go_on()).and_then(of).transpose()?
        };
        let mut exit = Exit::Done;
        if let (Some(path), None) = (&self.output, &plane) {
            exit = Exit::Unprinted;
            streams.note("warning", format_args!("--time-limit is over: {} is not written", text::path(path)));
        }
        if let (Some(path), Some(plane)) = (&self.output, &plane) {
            plane::write(path, plane)?;
        }
        let mut answer = Answer::new(file, assessment, remedies, self.margin);
        answer.plane = plane;
        let found = remedies::Found(&answer);
        match self.format {
            RowFormat::Table => found.table(streams.out).map_err(Failure::Answer),
            RowFormat::Csv => found.csv(streams.out).map_err(Failure::Answer),
            RowFormat::Json => streams.json(&answer),
        }?;
        Ok(exit)
    }
}
