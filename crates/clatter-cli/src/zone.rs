//! `clatter zone`: where on the bar or plate a threshold of velocity shock is not exceeded.

mod plate;

use std::io::{self, Write};

use clatter::{Extent, OffCenterBar, Shocks, Start, Zone};
use serde::Serialize;

use crate::inputs::{self, EndName, FallingBody, OffCenterArgs, RowFormat, Values};
use crate::numbers::{Json, digits, figures, given};
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

/// A safe zone by its width and its bounds, and the interval of one first end if that was asked.
struct Row {
    zone: Zone,
    bounds: Interval,
    interval: Option<Interval>,
}

/// Between these positions; `None` where nothing is safe.
#[derive(Clone, Copy)]
struct Interval(Option<[f64; 2]>);

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
        let start = Start::default();
        let either = bar.shocks_either(&start);
        let first = self.first.map(|first| bar.shocks(&start, first.into()));
        let row = |&threshold: &f64| Row {
            zone: either.safe_zone(threshold),
            bounds: Interval(either.safe_interval(threshold)),
            interval: first.map(|shocks| Interval(shocks.safe_interval(threshold))),
        };
        let rows: Vec<Row> = self.threshold.iter().map(row).collect();
        match self.format {
            RowFormat::Table => self.table(&bar, &either, &rows, streams.out).map_err(Failure::Answer),
            RowFormat::Csv => self.csv(&bar, &rows, streams.out).map_err(Failure::Answer),
            RowFormat::Json => streams.json(&self.answer(&bar, &either, &rows)),
        }?;
        self.bar.slips().for_each(|slip| streams.note("warning", slip));
        Ok(())
    }

    fn table(&self, bar: &OffCenterBar, either: &Shocks, rows: &[Row], out: &mut dyn Write) -> io::Result<()> {
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
        let first = self.first.map(|end| format!("   safe interval if {} strikes first", inputs::letter(end.into())));
        let head = format!("{:>12} {:>14}   {:<38}{}", "threshold", "safe zone s", "", first.unwrap_or_default());
        writeln!(out, "{}", head.trim_end())?;
        writeln!(out, "{:>12} {:>14}", "v0", "half-lengths")?;
        for Row { zone, bounds, interval } in rows {
            let meaning = match (zone.extent, bounds.0) {
                (Extent::None, _) if bar.is_symmetric() => "none: even the center sees more".to_owned(),
                (Extent::None, _) => "none: even the safest place sees more".to_owned(),
                (Extent::Part, Some([lo, hi])) if !bar.is_symmetric() => {
                    format!("from {} to {}", figures(lo), figures(hi))
                }
                (Extent::Part, _) => format!("the middle {:.1} % of the bar", 100.0 * zone.s),
                (Extent::Whole, _) => "the whole bar".to_owned(),
            };
            let interval = match interval {
                Some(Interval(Some([lo, hi]))) => format!("   from {} to {}", figures(*lo), figures(*hi)),
                Some(Interval(None)) => "   none".to_owned(),
                None => String::new(),
            };
            let line = format!("{:>12} {:>14}   {meaning:<38}{interval}", figures(zone.threshold), figures(zone.s));
            writeln!(out, "{}", line.trim_end())?;
        }
        Ok(())
    }

    fn csv(&self, bar: &OffCenterBar, rows: &[Row], out: &mut dyn Write) -> io::Result<()> {
        let bounds = if bar.is_symmetric() { "" } else { ",zone_lo,zone_hi" };
        let more = if self.first.is_some() { ",interval_lo,interval_hi" } else { "" };
        writeln!(out, "threshold,s,extent{bounds}{more}")?;
        for row in rows {
            let Row { zone, bounds, interval } = row;
            write!(out, "{},{},{}", digits(zone.threshold), digits(zone.s), extent(zone.extent))?;
            for Interval(bounds) in (!bar.is_symmetric()).then_some(bounds).into_iter().chain(interval) {
                match bounds {
                    Some([lo, hi]) => write!(out, ",{},{}", digits(*lo), digits(*hi))?,
                    None => write!(out, ",,")?,
                }
            }
            writeln!(out)?;
        }
        Ok(())
    }

    fn answer(&self, bar: &OffCenterBar, either: &Shocks, rows: &[Row]) -> Answer {
        let off = !bar.is_symmetric();
        let zones = rows.iter().map(|Row { zone, bounds, interval }| ZoneJson {
            threshold: Json(zone.threshold),
            s: Json(zone.s),
            extent: extent(zone.extent),
            zone: off.then(|| bounds.json()),
            interval: interval.map(Interval::json),
        });
        let safest = either.safest();
        Answer {
            q: Json(bar.q()),
            center_of_mass: off.then(|| Json(bar.center_of_mass())),
            inertia_ratios: off.then(|| bar.inertia_ratios().map(Json)),
            safest: off.then_some(SafestJson { s: Json(safest.s), shock: Json(safest.shock) }),
            gyration_ratio: Json(bar.gyration_ratio()),
            e: Json(bar.e()),
            first: self.first.map(|end| inputs::letter(end.into())),
            zones: zones.collect(),
        }
    }
}

impl Interval {
    fn json(self) -> IntervalJson {
        IntervalJson(self.0.map(|bounds| bounds.map(Json)))
    }
}

fn extent(extent: Extent) -> &'static str {
    match extent {
        Extent::None => "none",
        Extent::Part => "part",
        Extent::Whole => "whole",
    }
}

#[derive(Serialize)]
struct Answer {
    /// Of the symmetric bar with this clatter.
    q: Json,
    /// Only where it is not the middle; so too the three below.
    #[serde(skip_serializing_if = "Option::is_none")]
    center_of_mass: Option<Json>,
    /// For strikes at end a and end b.
    #[serde(skip_serializing_if = "Option::is_none")]
    inertia_ratios: Option<[Json; 2]>,
    /// Where the largest shock is least, whichever end strikes first.
    #[serde(skip_serializing_if = "Option::is_none")]
    safest: Option<SafestJson>,
    gyration_ratio: Json,
    e: Json,
    #[serde(skip_serializing_if = "Option::is_none")]
    first: Option<&'static str>,
    zones: Vec<ZoneJson>,
}

#[derive(Serialize)]
struct ZoneJson {
    threshold: Json,
    s: Json,
    extent: &'static str,
    /// The bounds of the safe zone, whichever end strikes first; null where nothing is safe.
    #[serde(skip_serializing_if = "Option::is_none")]
    zone: Option<IntervalJson>,
    /// Left out unless a first end was given, null where nothing is safe.
    #[serde(skip_serializing_if = "Option::is_none")]
    interval: Option<IntervalJson>,
}

#[derive(Serialize)]
struct SafestJson {
    s: Json,
    shock: Json,
}

#[derive(Serialize)]
struct IntervalJson(Option<[Json; 2]>);
