//! `clatter zone`: where on the bar a threshold of velocity shock is not exceeded.

use std::io::{self, Write};

use clatter::{Bar, Extent, Start, Zone};
use serde::Serialize;

use crate::inputs::{self, BarArgs, EndName, RowFormat};
use crate::numbers::{Json, digits, figures, given};
use crate::{Failure, Streams};

/// Tell where on the bar no shock exceeds a threshold: the safe zone
///
/// The safe zone reaches from the center to s half-lengths on either side (Eq. 5 of the paper), whichever end
/// strikes first. s is not clipped: below 0 not even the center is safe, from 1 on the whole bar is. The bar falls
/// without spin; thresholds are in v0, its drop speed.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  clatter zone --q=0.73 --e=0.2 --threshold=0.5 --threshold=1 --threshold=2
  clatter zone --q=0.73 --e=0.2 --threshold=0.5 --first=a --format=json

'clatter --help' tells what q, e and the units are.")]
pub(crate) struct Args {
    #[command(flatten)]
    bar: BarArgs,
    /// Velocity shock that a part survives, in v0; may be given several times
    #[arg(long, value_name = "X", required = true, allow_hyphen_values = true, value_parser = inputs::threshold)]
    threshold: Vec<f64>,
    /// Also give the interval of positions that is safe if this end strikes first
    #[arg(long, value_name = "END")]
    first: Option<EndName>,
    /// How to show the answer
    #[arg(long, value_enum, default_value_t = RowFormat::Table)]
    format: RowFormat,
}

/// A safe zone, and the interval of one first end if that was asked.
struct Row {
    zone: Zone,
    interval: Option<Interval>,
}

/// Between these positions; `None` where nothing is safe.
#[derive(Clone, Copy)]
struct Interval(Option<[f64; 2]>);

impl Args {
    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let (bar, start) = (self.bar.bar()?, Start::default());
        let rows: Vec<Row> = self
            .threshold
            .iter()
            .map(|&threshold| Row {
                zone: bar.safe_zone(&start, threshold),
                interval: self.first.map(|first| Interval(bar.safe_interval(&start, threshold, first.into()))),
            })
            .collect();
        match self.format {
            RowFormat::Table => self.table(&bar, &start, &rows, streams.out).map_err(Failure::Answer),
            RowFormat::Csv => self.csv(&rows, streams.out).map_err(Failure::Answer),
            RowFormat::Json => streams.json(&self.answer(&bar, &rows)),
        }
    }

    fn table(&self, bar: &Bar, start: &Start, rows: &[Row], out: &mut dyn Write) -> io::Result<()> {
        let (q, e, peak) = (given(bar.q()), given(bar.e()), figures(bar.summary(start).peak.end));
        writeln!(out, "Safe zones of a bar with q = {q}, e = {e}; its ends see up to {peak} v0")?;
        writeln!(out)?;
        let first = self.first.map(|end| format!("   safe interval if {} strikes first", inputs::letter(end.into())));
        let head = format!("{:>12} {:>14}   {:<36}{}", "threshold", "safe zone s", "", first.unwrap_or_default());
        writeln!(out, "{}", head.trim_end())?;
        writeln!(out, "{:>12} {:>14}", "v0", "half-lengths")?;
        for Row { zone, interval } in rows {
            let meaning = match zone.extent {
                Extent::None => "none: even the center sees more".to_owned(),
                Extent::Part => format!("the middle {:.1} % of the bar", 100.0 * zone.s),
                Extent::Whole => "the whole bar".to_owned(),
            };
            let interval = match interval {
                Some(Interval(Some([lo, hi]))) => format!("   from {} to {}", figures(*lo), figures(*hi)),
                Some(Interval(None)) => "   none".to_owned(),
                None => String::new(),
            };
            let line = format!("{:>12} {:>14}   {meaning:<36}{interval}", figures(zone.threshold), figures(zone.s));
            writeln!(out, "{}", line.trim_end())?;
        }
        Ok(())
    }

    fn csv(&self, rows: &[Row], out: &mut dyn Write) -> io::Result<()> {
        let more = if self.first.is_some() { ",interval_lo,interval_hi" } else { "" };
        writeln!(out, "threshold,s,extent{more}")?;
        for Row { zone, interval } in rows {
            write!(out, "{},{},{}", digits(zone.threshold), digits(zone.s), extent(zone.extent))?;
            match interval {
                Some(Interval(Some([lo, hi]))) => writeln!(out, ",{},{}", digits(*lo), digits(*hi))?,
                Some(Interval(None)) => writeln!(out, ",,")?,
                None => writeln!(out)?,
            }
        }
        Ok(())
    }

    fn answer(&self, bar: &Bar, rows: &[Row]) -> Answer {
        let zones = rows.iter().map(|Row { zone, interval }| ZoneJson {
            threshold: Json(zone.threshold),
            s: Json(zone.s),
            extent: extent(zone.extent),
            interval: interval.map(|Interval(bounds)| IntervalJson(bounds.map(|bounds| bounds.map(Json)))),
        });
        Answer {
            q: Json(bar.q()),
            gyration_ratio: Json(bar.gyration_ratio()),
            e: Json(bar.e()),
            first: self.first.map(|end| inputs::letter(end.into())),
            zones: zones.collect(),
        }
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
    q: Json,
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
    /// Left out unless a first end was given, null where nothing is safe.
    #[serde(skip_serializing_if = "Option::is_none")]
    interval: Option<IntervalJson>,
}

#[derive(Serialize)]
struct IntervalJson(Option<[Json; 2]>);
