//! The safe zone of a plate: a polygon.

use std::io::{self, Write};

use clatter::{Corner, Extent, Plate, PlateShocks, PlateStart, PlateZone};
use clatter_answer::zone::name as extent;
use serde::Serialize;

use super::Args;
use crate::inputs::{RowFormat, Values};
use crate::numbers::{Json, digits, figures, given};
use crate::{Failure, Streams};

/// Strikes that are followed in every direction, and in one drop.
const OF_EACH: usize = 40;
const OF_ONE: u64 = 1000;

/// The zones of a plate and what they are of.
struct Zones {
    plate: Plate,
    shocks: PlateShocks,
    gaps: Option<[f64; 2]>,
    of_each: Vec<PlateZone>,
}

impl Args {
    pub(super) fn plate(
        &self,
        plate: &Plate,
        gap: Option<Values<1, 2>>,
        streams: &mut Streams<'_>,
    ) -> Result<(), Failure> {
        if self.first.is_some() {
            return Err(Failure::Usage(
                "--first goes with a bar; one drop of a plate, corner a first, is --height-gap=HX,HY",
            ));
        }
        let gaps = gap.map(|gap| gap.of_plate("--height-gap")).transpose()?;
        let shocks = match gaps {
            Some(gaps) => plate.shocks(&PlateStart::level(gaps)?, OF_ONE),
            None => plate.worst(OF_EACH)?,
        };
        let of_each = self.threshold.iter().map(|threshold| shocks.safe_zone(*threshold)).collect();
        let zones = Zones { plate: *plate, shocks, gaps, of_each };
        match self.format {
            RowFormat::Table => zones.table(streams.out).map_err(Failure::Answer)?,
            RowFormat::Csv => zones.csv(streams.out).map_err(Failure::Answer)?,
            RowFormat::Json => streams.json(&zones.answer())?,
        }
        if !zones.is_proven() && self.format != RowFormat::Json {
            let later = figures(shocks.later());
            let what = format_args!(
                "impacts that were not followed may give a corner up to {later} v0: the zones may be smaller"
            );
            streams.note("warning", what);
        }
        Ok(())
    }
}

impl Zones {
    /// Whether no strike that was not followed makes a zone smaller.
    fn is_proven(&self) -> bool {
        self.shocks.later() <= self.shocks.struck().into_iter().fold(f64::INFINITY, f64::min)
    }

    fn table(&self, out: &mut dyn Write) -> io::Result<()> {
        let [kx, ky] = self.plate.gyration_ratios().map(given);
        let of = self.gaps.map_or("in any direction, any corner first".to_owned(), |gaps| {
            let [hx, hy] = gaps.map(given);
            format!("with b at {hx} h0 and d at {hy} h0 when a touches")
        });
        writeln!(out, "Safe zones of a plate with gyration ratios {kx},{ky}, e = {}, {of}", given(self.plate.e()))?;
        let seen: Vec<_> = Corner::ALL
            .iter()
            .map(|corner| format!("{} up to {} v0", corner.letter(), figures(self.shocks.at(corner.position()))))
            .collect();
        writeln!(out, "Corners see: {}", seen.join(", "))?;
        writeln!(out, "\n{:>12} {:>10}   corners of the safe zone", "threshold", "safe")?;
        writeln!(out, "{:>12} {:>10}   half-lengths,half-widths", "v0", "of the area")?;
        for zone in &self.of_each {
            let places: Vec<_> = zone.polygon.iter().map(|[x, y]| format!("{:.4},{:.4}", x + 0.0, y + 0.0)).collect();
            let meaning = match zone.extent {
                Extent::None => "none: every place sees more".to_owned(),
                Extent::Part => places.join("  "),
                Extent::Whole => "the whole plate".to_owned(),
            };
            writeln!(out, "{:>12} {:>9.1} %   {meaning}", figures(zone.threshold), 100.0 * zone.share)?;
        }
        Ok(())
    }

    fn csv(&self, out: &mut dyn Write) -> io::Result<()> {
        writeln!(out, "threshold,extent,share,x,y")?;
        for zone in &self.of_each {
            let head = format!("{},{},{}", digits(zone.threshold), extent(zone.extent), digits(zone.share));
            if zone.polygon.is_empty() {
                writeln!(out, "{head},,")?;
            }
            for [x, y] in &zone.polygon {
                writeln!(out, "{head},{},{}", digits(*x), digits(*y))?;
            }
        }
        Ok(())
    }

    fn answer(&self) -> Answer {
        let zone = |zone: &PlateZone| ZoneJson {
            threshold: Json(zone.threshold),
            extent: extent(zone.extent),
            polygon: zone.polygon.iter().map(|place| place.map(Json)).collect(),
            share: Json(zone.share),
        };
        Answer {
            gyration_ratio: self.plate.gyration_ratios().map(Json),
            center_of_mass: self.plate.center_of_mass().map(Json),
            e: Json(self.plate.e()),
            height_gap: self.gaps.map(|gaps| gaps.map(Json)),
            struck: self.shocks.struck().map(Json),
            later: Json(self.shocks.later()),
            proven: self.is_proven(),
            zones: self.of_each.iter().map(zone).collect(),
        }
    }
}

#[derive(Serialize)]
struct Answer {
    gyration_ratio: [Json; 2],
    center_of_mass: [Json; 2],
    e: Json,
    /// Of the one drop that the zones are of; null for all directions.
    height_gap: Option<[Json; 2]>,
    /// Largest shocks of corners a, b, c and d in their own strikes.
    struck: [Json; 4],
    /// What impacts that were not followed give a corner at most.
    later: Json,
    /// Whether that makes no zone smaller.
    proven: bool,
    zones: Vec<ZoneJson>,
}

#[derive(Serialize)]
struct ZoneJson {
    threshold: Json,
    extent: &'static str,
    polygon: Vec<[Json; 2]>,
    share: Json,
}
