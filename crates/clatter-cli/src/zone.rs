//! This module is `clatter zone`: it finds where on the bar or plate a threshold of velocity shock is not exceeded.

mod plate;

use std::io::{self, Write};

use clatter::{Bar, End, Extent, Start};
use clatter_answer::zone::{self, Answer, Interval, Question, Zone};

use crate::inputs::{self, EndName, FallingBody, OffCenterArgs, RowFormat, Values};
use crate::numbers::{digits, figures, given};
use crate::{Failure, Streams};

/// Tell where on the bar no shock exceeds a threshold: the safe zone
///
/// The safe zone reaches from the center to s half-lengths on either side (Eq. 5 of the paper), whichever end
/// strikes first. s is not clipped: below 0 not even the center is safe, from 1 on the whole bar is. The bar falls
/// without spin; thresholds are in v0, its drop speed.
///
/// Where the center of mass is not the middle, the safe zone reaches differently far to both sides of the safest place,
/// which is neither. It is given by its two bounds, and s is half the distance between them, not clipped.
///
/// The safe zone of a plate (--gyration-ratio=KX,KY) is a polygon, and its size a share of the plate: what no drop without
/// spin passes, in any direction of tilt and with any corner first, or with --height-gap one drop with corner a first.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  clatter zone --q=0.73 --e=0.2 --threshold=0.5 --threshold=1 --threshold=2
  clatter zone --q=0.73 --e=0.2 --threshold=0.5 --first=a --format=json
  clatter zone --mass=2@-1:1 --mass=1@0.5 --e=0.3 --threshold=1
  clatter zone --gyration-ratio=0.577,0.577 --e=0.3 --threshold=0.5

'clatter --help' tells what q, e and the units are.")]
pub(crate) struct Args {
    #[command(flatten)]
    bar: OffCenterArgs,
    /// Velocity shock that a part survives, in v0; may be given several times
    #[arg(long, value_name = "X", required = true, allow_hyphen_values = true, value_parser = inputs::threshold)]
    threshold: Vec<f64>,
    /// Also give the interval of positions that is safe if this end strikes first
    #[arg(long, value_name = "END")]
    first: Option<EndName>,
    /// For a plate: the safe zone of the one drop with these heights of corners b and d when a touches
    #[arg(long, value_name = "HX,HY", allow_hyphen_values = true, value_parser = inputs::height_gaps)]
    height_gap: Option<Values<1, 2>>,
    /// How to show the answer
    #[arg(long, value_enum, default_value_t = RowFormat::Table)]
    format: RowFormat,
}

impl Args {
    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let bar = match (self.bar.body()?, self.height_gap) {
            (FallingBody::Plate(plate), gap) => return self.plate(&plate, gap, streams),
            (FallingBody::Bar(_), Some(_)) => {
                return Err(Failure::Usage(
                    "--height-gap goes with a plate: the safe zone of a bar is the same for all",
                ));
            }
            (FallingBody::Bar(bar), None) => bar,
        };
        let mut question = Question::new(bar, self.threshold.clone());
        question.first = self.first.map(End::from);
        let answer = zone::answer(&question)?;
        match self.format {
            RowFormat::Table => table(&bar, &answer, streams.out).map_err(Failure::Answer),
            RowFormat::Csv => csv(&answer, streams.out).map_err(Failure::Answer),
            RowFormat::Json => streams.json(&answer),
        }?;
        self.bar.slips().for_each(|slip| streams.note("warning", slip));
        Ok(())
    }
}

fn table(bar: &Bar, answer: &Answer, out: &mut dyn Write) -> io::Result<()> {
    let either = bar.shocks_either(&Start::default());
    let e = given(bar.e());
    let [a, b] = [-1.0, 1.0].map(|s| figures(either.at(s)));
    if bar.is_symmetric() {
        writeln!(out, "Safe zones of a bar with q = {}, e = {e}; its ends see up to {a} v0", given(bar.q()))?;
    } else {
        let (c, safest) = (figures(bar.center_of_mass()), either.safest());
        writeln!(out, "Safe zones of a bar with its center of mass at {c}, e = {e}")?;
        writeln!(out, "End a sees up to {a} v0, end b up to {b} v0")?;
        writeln!(out, "The safest place is {}, with up to {} v0", figures(safest.s), figures(safest.shock))?;
    }
    writeln!(out)?;
    let first = answer.first.map(|end| format!("   safe interval if {end} strikes first"));
    let head = format!("{:>12} {:>14}   {:<38}{}", "threshold", "safe zone s", "", first.unwrap_or_default());
    writeln!(out, "{}", head.trim_end())?;
    writeln!(out, "{:>12} {:>14}", "v0", "half-lengths")?;
    for Zone { threshold, s, extent, zone, interval, .. } in &answer.zones {
        let meaning = match (extent, zone.and_then(|zone| zone.0)) {
            (Extent::None, _) if bar.is_symmetric() => "none: even the center sees more".to_owned(),
            (Extent::None, _) => "none: even the safest place sees more".to_owned(),
            (Extent::Part, Some([lo, hi])) => {
                format!("from {} to {}", figures(lo.0), figures(hi.0))
            }
            (Extent::Part, _) => format!("the middle {:.1} % of the bar", 100.0 * s.0),
            (Extent::Whole, _) => "the whole bar".to_owned(),
        };
        let interval = match interval {
            Some(Interval(Some([lo, hi]))) => format!("   from {} to {}", figures(lo.0), figures(hi.0)),
            Some(Interval(None)) => "   none".to_owned(),
            None => String::new(),
        };
        let line = format!("{:>12} {:>14}   {meaning:<38}{interval}", figures(threshold.0), figures(s.0));
        writeln!(out, "{}", line.trim_end())?;
    }
    Ok(())
}

fn csv(answer: &Answer, out: &mut dyn Write) -> io::Result<()> {
    let bounds = if answer.safest.is_none() { "" } else { ",zone_lo,zone_hi" };
    let more = if answer.first.is_some() { ",interval_lo,interval_hi" } else { "" };
    writeln!(out, "threshold,s,extent{bounds}{more}")?;
    for Zone { threshold, s, extent, zone, interval, .. } in &answer.zones {
        write!(out, "{},{},{}", digits(threshold.0), digits(s.0), zone::name(*extent))?;
        for Interval(bounds) in zone.iter().chain(interval) {
            match bounds {
                Some([lo, hi]) => write!(out, ",{},{}", digits(lo.0), digits(hi.0))?,
                None => write!(out, ",,")?,
            }
        }
        writeln!(out)?;
    }
    Ok(())
}
