//! `clatter atlas`: what every direction of tilt of a plate leads to.

use std::io::{self, Write};

use clatter::{Atlas, AtlasPeak, Plate, Word};
use serde::Serialize;

use crate::inputs::{FallingBody, OffCenterArgs, RowFormat};
use crate::numbers::{Json, digits, figures, given};
use crate::{Failure, Streams};

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
  clatter atlas --gyration-ratio=0.5,0.6 --center-of-mass=0.1,-0.2 --e=0.3 --format=json

'clatter --help' tells what the corners and the units are.")]
pub(crate) struct Args {
    #[command(flatten)]
    body: OffCenterArgs,
    /// Follow at most so many strikes of each direction, from 1 to 100
    #[arg(long, value_name = "N", default_value = "40", allow_hyphen_values = true, value_parser = crate::inputs::limit)]
    limit: usize,
    /// How to show the answer
    #[arg(long, value_enum, default_value_t = RowFormat::Table)]
    format: RowFormat,
}

impl Args {
    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let FallingBody::Plate(plate) = self.body.body()? else {
            return Err(Failure::Usage(
                "an atlas is that of a plate: give --gyration-ratio=KX,KY, its two gyration ratios",
            ));
        };
        let atlas = plate.atlas(self.limit).map_err(Failure::flag("--limit"))?;
        match self.format {
            RowFormat::Table => table(&plate, &atlas, streams.out).map_err(Failure::Answer)?,
            RowFormat::Csv => csv(&atlas, streams.out).map_err(Failure::Answer)?,
            RowFormat::Json => streams.long_json(&answer(&plate, &atlas, self.limit))?,
        }
        let AtlasPeak { corner, later, .. } = atlas.peak();
        if later > corner && self.format != RowFormat::Json {
            let later = figures(later);
            streams.note("warning", format_args!("strikes that were not followed may give a corner up to {later} v0"));
        }
        Ok(())
    }
}

fn letters(word: &Word) -> String {
    word.corners.iter().map(|corner| corner.letter()).collect()
}

fn table(plate: &Plate, atlas: &Atlas, out: &mut dyn Write) -> io::Result<()> {
    let ([kx, ky], [sx, sy]) = (plate.gyration_ratios().map(given), plate.center_of_mass().map(given));
    let center = if plate.is_centered() { String::new() } else { format!(", center of mass {sx},{sy}") };
    writeln!(out, "Directions of a plate with gyration ratios {kx},{ky}{center}, e = {}", given(plate.e()))?;
    let AtlasPeak { corner, center, later, .. } = atlas.peak();
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
    for word in atlas.words() {
        let more = if word.ended { "" } else { " …" };
        let [from, to, corner, center] = [word.from, word.to, word.peak(), word.center].map(figures);
        writeln!(out, "{from:>12} {to:>12} {corner:>12} {center:>12}   {}{more}", letters(word))?;
    }
    Ok(())
}

fn csv(atlas: &Atlas, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "from,to,word,ended,peak_corner,peak_center,later")?;
    for word in atlas.words() {
        let [from, to, corner, center, later] = [word.from, word.to, word.peak(), word.center, word.later].map(digits);
        writeln!(out, "{from},{to},{},{},{corner},{center},{later}", letters(word), word.ended)?;
    }
    Ok(())
}

fn answer(plate: &Plate, atlas: &Atlas, limit: usize) -> Answer {
    let word = |word: &Word| WordJson {
        from: Json(word.from),
        to: Json(word.to),
        word: letters(word),
        ended: word.ended,
        peak: PeakJson { corner: Json(word.peak()), center: Json(word.center), later: Json(word.later) },
    };
    let AtlasPeak { corner, center, later, .. } = atlas.peak();
    Answer {
        gyration_ratio: plate.gyration_ratios().map(Json),
        center_of_mass: plate.center_of_mass().map(Json),
        e: Json(plate.e()),
        limit,
        words: atlas.words().iter().map(word).collect(),
        peak: PeakJson { corner: Json(corner), center: Json(center), later: Json(later) },
    }
}

#[derive(Serialize)]
struct Answer {
    gyration_ratio: [Json; 2],
    center_of_mass: [Json; 2],
    e: Json,
    limit: usize,
    words: Vec<WordJson>,
    /// Of all directions.
    peak: PeakJson,
}

#[derive(Serialize)]
struct WordJson {
    from: Json,
    to: Json,
    word: String,
    ended: bool,
    peak: PeakJson,
}

#[derive(Serialize)]
struct PeakJson {
    corner: Json,
    center: Json,
    /// What no strike that was not followed gives a corner.
    later: Json,
}
