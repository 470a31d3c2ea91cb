//! This module is `clatter atlas`: it follows every direction of tilt of a plate.

use std::io::{self, Write};
use std::path::PathBuf;

use clap::ValueHint;
use clatter::Plate;
use clatter_answer::atlas::{Answer, Peak};

use crate::input::is_standard;
use crate::inputs::{FallingBody, OffCenterArgs, RowFormat};
use crate::numbers::{digits, figures, given};
use crate::output::Files;
use crate::progress::Counted;
use crate::{Failure, Streams, output};

/// List what every direction of tilt of a plate leads to: its words of corners, and the worst of all
///
/// The plate falls without spin at v0, and corner a strikes first. r = HY/(HX + HY) is the direction of its tilt, with HX and
/// HY the heights of b and d: 0 where a and d land together, 1 where a and b do. Each interval of directions leads to one
/// order of corners, its word. The largest shock of the list is the largest of all directions, and for a plate with its
/// center of mass in the middle whichever corner strikes first: proven, not searched.
///
/// Words that have not ended after --limit strikes are followed no further; what later strikes may give is then told.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  clatter atlas --gyration-ratio=0.577350269,0.577350269 --e=0.3          a uniform plate of any aspect
  clatter atlas --gyration-ratio=0.577350269,0.577350269 --e=0.3 -o ring.svg        every direction as a ring
  clatter atlas --gyration-ratio=0.5,0.6 --center-of-mass=0.1,-0.2 --e=0.3 --format=json

'clatter --help' tells what the corners and the units are.")]
pub(crate) struct Args {
    #[command(flatten)]
    body: OffCenterArgs,
    /// Follow at most so many strikes of each direction, from 1 to 100
    #[arg(long, value_name = "N", default_value = "40", allow_hyphen_values = true, value_parser = crate::inputs::limit)]
    limit: usize,
    /// Write the directions as a ring, each as far out as its largest shock; - writes it to standard output in place of the answer
    #[arg(short, long, value_name = "FILE.svg", value_hint = ValueHint::FilePath, value_parser = output::ending("svg"))]
    output: Option<PathBuf>,
    /// How to show the answer
    #[arg(long, value_enum, default_value_t = RowFormat::Table)]
    format: RowFormat,
}

impl Args {
    pub(crate) fn files(&self) -> Files<'_> {
        Files { reads: Vec::new(), writes: self.output.iter().map(AsRef::as_ref).collect() }
    }

    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        output::in_place_of_answer(self.output.as_deref(), matches!(self.format, RowFormat::Table))?;
        let FallingBody::Plate(plate) = self.body.body()? else {
            return Err(Failure::Usage(
                "an atlas is that of a plate: give --gyration-ratio=KX,KY, its two gyration ratios",
            ));
        };
        let working = Counted::begin("following every direction of tilt", 0);
        let atlas = plate.atlas(self.limit).map_err(Failure::flag("--limit"))?;
        drop(working);
        let answer = Answer::of(&plate, self.limit, &atlas);
        if let Some(path) = &self.output {
            let svg = clatter_figures::ring(&plate, &atlas)?;
            if is_standard(path) {
                return streams.out.write_all(svg.as_bytes()).map_err(Failure::Answer);
            }
            output::replace(path, |file| file.write_all(svg.as_bytes()))?;
        }
        match self.format {
            RowFormat::Table => table(&plate, &answer, streams.out).map_err(Failure::Answer)?,
            RowFormat::Csv => csv(&answer, streams.out).map_err(Failure::Answer)?,
            RowFormat::Json => streams.long_json(&answer)?,
        }
        let Peak { corner, later, .. } = answer.peak;
        if later.0 > corner.0 && self.format != RowFormat::Json {
            let later = figures(later.0);
            streams.note("warning", format_args!("strikes that were not followed may give a corner up to {later} v0"));
        }
        Ok(())
    }
}

fn shocks(peak: &Peak) -> [f64; 3] {
    [peak.corner, peak.center, peak.later].map(|shock| shock.0)
}

fn table(plate: &Plate, answer: &Answer, out: &mut dyn Write) -> io::Result<()> {
    let ([kx, ky], [sx, sy]) = (plate.gyration_ratios().map(given), plate.center_of_mass().map(given));
    let center = if plate.is_centered() { String::new() } else { format!(", center of mass {sx},{sy}") };
    writeln!(out, "Directions of a plate with gyration ratios {kx},{ky}{center}, e = {}", given(plate.e()))?;
    let [corner, center, later] = shocks(&answer.peak);
    let first = if plate.is_centered() { "any corner first" } else { "corner a first" };
    writeln!(
        out,
        "Largest shocks of all directions, {first}: {} v0 at a corner, {} v0 at the center of mass",
        figures(corner),
        figures(center)
    )?;
    if later > 0.0 {
        writeln!(out, "Strikes that were not followed give a corner at most {} v0", figures(later))?;
    }
    writeln!(out, "\n{:>12} {:>12} {:>12} {:>12}   word", "from r", "to r", "corner", "center")?;
    writeln!(out, "{:>12} {:>12} {:>12} {:>12}", "", "", "v0", "v0")?;
    for word in &answer.words {
        let more = if word.ended { "" } else { " …" };
        let [corner, center, _] = shocks(&word.peak);
        let [from, to, corner, center] = [word.from.0, word.to.0, corner, center].map(figures);
        writeln!(out, "{from:>12} {to:>12} {corner:>12} {center:>12}   {}{more}", word.word)?;
    }
    Ok(())
}

fn csv(answer: &Answer, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "from,to,word,ended,peak_corner,peak_center,later")?;
    for word in &answer.words {
        let ([from, to], shocks) = ([word.from, word.to].map(|r| digits(r.0)), shocks(&word.peak).map(digits));
        writeln!(out, "{from},{to},{},{},{}", word.word, word.ended, shocks.join(","))?;
    }
    Ok(())
}
