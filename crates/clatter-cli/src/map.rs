//! This module is `clatter map`: it writes one quantity over a grid of (q, e), or of gyration ratio and e, as a file.

use std::io::{self, Write};
use std::path::Path;

use clap::{ValueEnum, ValueHint};
use clatter::{Axis, Map, Quantity, Variable};
use clatter_answer::map::{self, Question};
use clatter_answer::whole;
use serde::Serialize;

use crate::inputs::{self, Format};
use crate::numbers::{digits, given};
use crate::output::{Files, Kind, Target, buffered};
use crate::progress::Counted;
use crate::{Failure, Streams, budget, npy, output, text};

/// Write a quantity over a grid of q and e to a file
///
/// A bar falls without spin at every point of the grid. The ending of the file decides what is
/// written:
///
///   .csv   a line q,e,QUANTITY for every point, e fastest
///   .json  {"clatter", "quantity", "threshold", "q": [...], "e": [...], "values": [[...], ...]}, a row for each
///          q
///   .npy   the values as numpy loads them, a row for each q
///   .svg   a picture
///
/// With --gyration-ratio in place of --q, "q" becomes "gyration_ratio" in the headings of .csv and
/// .json.
///
/// An endless train counts as inf ("infinite" in JSON).
#[derive(Debug, clap::Args)]
#[command(
    verbatim_doc_comment,
    after_help = "\
Examples:
  clatter map peak-end --q=0:1:201 --e=0:1:201 -o peak.svg
  clatter map zone --threshold=0.5 --q=0:1:1000 --e=0:1:1000 -o zone.npy
  clatter map impacts --gyration-ratio=1e-6:1e-3:201 --e=0.99:1:201 -o impacts.csv

'clatter --help' tells what q, e and the units are."
)]
pub(crate) struct Args {
    #[arg(value_enum)]
    quantity: QuantityName,
    #[command(flatten)]
    inertia: Inertia,
    /// Values of the coefficient of restitution e, in [0, 1]: N values from LO to HI, both included
    #[arg(long, value_name = "LO:HI:N", allow_hyphen_values = true, value_parser = inputs::e_axis)]
    e: Axis,
    /// For zone: velocity shock that a part survives, in v0
    #[arg(long, value_name = "X", allow_hyphen_values = true, value_parser = inputs::threshold, required_if_eq("quantity", "zone"))]
    threshold: Option<f64>,
    /// File to write, ending in .csv, .json, .npy or .svg; what was there is replaced once the new file is whole
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath, value_parser = target)]
    output: Target,
    /// How to tell what was written
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
}

#[derive(Debug, clap::Args)]
#[group(required = true, multiple = false)]
struct Inertia {
    /// Values of the inertia ratio q, in (-1, 1]: N values from LO to HI, both included
    #[arg(long, value_name = "LO:HI:N", allow_hyphen_values = true, value_parser = inputs::q_axis)]
    q: Option<Axis>,
    /// Instead of q: values of the gyration ratio ρ/L, 0 or in [1e-35, 1e35], exact also where q is within rounding of
    /// 1
    #[arg(long, value_name = "LO:HI:N", allow_hyphen_values = true, value_parser = inputs::gyration_axis)]
    gyration_ratio: Option<Axis>,
}

impl Inertia {
    fn axis(&self) -> Result<Axis, Failure> {
        // The group requires one of the two.
        self.gyration_ratio.or(self.q).ok_or(Failure::Usage("a map needs --q or --gyration-ratio"))
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum QuantityName {
    /// Number of impacts
    Impacts,
    /// Largest velocity shock at the ends, in v0
    PeakEnd,
    /// Largest velocity shock at the center, in v0
    PeakCenter,
    /// Largest change of angular velocity, in v0/L
    PeakAngular,
    /// Net change of velocity at the center, in v0
    NetCenter,
    /// Time of the last impact or the limit it tends to, in h0/v0
    Duration,
    /// Safe zone s of --threshold, in half-lengths, not clipped
    Zone,
}

fn target(text: &str) -> Result<Target, String> {
    Target::of(text, &[Kind::Csv, Kind::Json, Kind::Npy, Kind::Svg])
}

impl QuantityName {
    fn quantity(self, threshold: Option<f64>) -> Result<Quantity, Failure> {
        match (self, threshold) {
            (Self::Zone, Some(threshold)) => Ok(Quantity::Zone(threshold)),
            (Self::Zone, None) => Err(Failure::Usage("zone needs --threshold=X")),
            (_, Some(_)) => Err(Failure::Usage("--threshold goes with the quantity zone alone")),
            (Self::Impacts, None) => Ok(Quantity::Impacts),
            (Self::PeakEnd, None) => Ok(Quantity::PeakEnd),
            (Self::PeakCenter, None) => Ok(Quantity::PeakCenter),
            (Self::PeakAngular, None) => Ok(Quantity::PeakAngular),
            (Self::NetCenter, None) => Ok(Quantity::NetCenter),
            (Self::Duration, None) => Ok(Quantity::Duration),
        }
    }
}

impl Args {
    pub(crate) fn files(&self) -> Files<'_> {
        Files { reads: Vec::new(), writes: vec![&self.output.path] }
    }

    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let quantity = self.quantity.quantity(self.threshold)?;
        let axis = self.inertia.axis()?;
        let points = axis.points() as u128 * self.e.points() as u128;
        // The text of a picture or a file in JSON takes memory in addition to the values.
        if 2 * 8 * points > u128::from(budget::memory()) {
            return Err(Failure::Large { points, most: u128::from(budget::memory()) / 16 });
        }
        let answer = {
            let _computing = Counted::begin("computing", 0);
            map::answer(&Question::new(quantity, axis, self.e))?
        };
        let map = &answer.map;
        let Target { path, kind } = &self.output;
        output::replace(path, |file| match kind {
            Kind::Npy => npy::write(file, map.q.points(), &map.values),
            Kind::Csv => buffered(file, |out| csv(map, out)),
            Kind::Json => output::json(file, &answer),
            Kind::Svg | Kind::Parquet => file.write_all(clatter_figures::map(map)?.as_bytes()),
        })?;
        match self.format {
            Format::Table => {
                let axis = |name: &str, axis: Axis| {
                    let (n, lo, hi) = (axis.points(), given(axis.value(0)), given(axis.value(axis.points() - 1)));
                    format!("{n} values of {name} from {lo} to {hi}")
                };
                let (file, name, q, e) =
                    (text::path(path), answer.quantity, axis(&inertia(map).replace('_', " "), map.q), axis("e", map.e));
                writeln!(streams.out, "{file}: {name} over {q} and {e}").map_err(Failure::Answer)
            }
            Format::Json => {
                let (axes, points) = ([inertia(map), "e"], [map.q.points(), map.e.points()]);
                streams.json(&WrittenJson { file: path, quantity: answer.quantity, axes, points })
            }
        }
    }
}

/// Returns the name of the slow axis in headings.
fn inertia(map: &Map) -> &'static str {
    if map.q.variable() == Variable::GyrationRatio { "gyration_ratio" } else { "q" }
}

fn csv(map: &Map, out: &mut dyn Write) -> io::Result<()> {
    let counts = map.quantity == Quantity::Impacts;
    writeln!(out, "{},e,{}", inertia(map), map::name(map.quantity))?;
    for (i, row) in map.values.chunks(map.e.points()).enumerate() {
        let q = digits(map.q.value(i));
        for (j, &value) in row.iter().enumerate() {
            writeln!(out, "{q},{},{}", digits(map.e.value(j)), if counts { whole(value) } else { digits(value) })?;
        }
    }
    Ok(())
}

#[derive(Serialize)]
struct WrittenJson<'a> {
    file: &'a Path,
    quantity: &'static str,
    axes: [&'static str; 2],
    points: [usize; 2],
}
