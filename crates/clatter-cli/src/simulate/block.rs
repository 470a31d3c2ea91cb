//! The presses of a box in one drop.

use std::io::{self, Write};

use clatter_flight::{Block, BlockFlight, BlockStrike, Stop};
use serde::Serialize;

use super::Args;
use crate::block::Setup;
use crate::drop_args::BesideBlock;
use crate::inputs::RowFormat;
use crate::numbers::{Json, digits, figures, given};
use crate::{Failure, Streams};

/// Presses whose largest shock is below this share of the largest of all are left out of the table.
const MATTERS: f64 = 0.01;

impl Args {
    pub(super) fn block(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        if self.output.is_some() {
            return Err(Failure::Usage(
                "the motion of a box is not written to a file: --format=json or csv has its strikes",
            ));
        }
        let spin = match self.spin_rad_s {
            Some(spin) => spin.of_block("--spin-rad-s")?,
            None if self.spin.is_some() => {
                return Err(Failure::Usage("--spin turns a bar; of a box it is --spin-rad-s=WX,WY,WZ"));
            }
            None => [0.0; 3],
        };
        if !self.at.is_empty() {
            return Err(Failure::Usage(
                "--at is a place of a bar: 'clatter respond --at-m=X,Y,Z' answers one of a box",
            ));
        }
        let gyration = self.inertia.given().map(|radii| radii.of_block(self.inertia.flag())).transpose()?;
        let setup = self.drop.block(&BesideBlock {
            model: self.model,
            e: self.e,
            gyration,
            spin_rad_s: spin,
            time_limit_s: self.time_limit_s(),
            impact_limit: self.impact_limit,
        })?;
        let drop = Drop { flight: setup.flight()?, setup, all: self.all };
        match self.format {
            RowFormat::Table => drop.table(streams.out).map_err(Failure::Answer)?,
            RowFormat::Csv => drop.csv(streams.out).map_err(Failure::Answer)?,
            RowFormat::Json => streams.json(&drop.answer())?,
        }
        drop.warnings().into_iter().for_each(|warning| streams.note("warning", warning));
        Ok(())
    }
}

struct Drop {
    setup: Setup,
    flight: BlockFlight,
    all: bool,
}

fn shock(strike: &BlockStrike) -> f64 {
    strike.delta_v_m_s.into_iter().fold(0.0, |most, v| most.max(v.abs()))
}

impl Drop {
    /// Whether a limit has cut off a press, so that its shock is not known.
    fn is_unfinished(&self, strike: &BlockStrike) -> bool {
        let is_over = matches!(self.flight.stop, Stop::AtRest { .. } | Stop::BouncedClear { .. });
        !is_over && strike.until_s.is_infinite()
    }

    fn warnings(&self) -> Vec<String> {
        let mut warnings: Vec<String> = self.setup.warning().into_iter().collect();
        let unfinished = self.flight.strikes.iter().filter(|strike| self.is_unfinished(strike)).count();
        if unfinished > 0 {
            warnings.push(format!("{unfinished} contacts are cut off there: what they do in all is not known"));
        }
        warnings.extend(self.setup.left(&self.flight));
        warnings
    }

    fn table(&self, out: &mut dyn Write) -> io::Result<()> {
        self.setup.heading(out)?;
        writeln!(out, "Impacts {:>26}", self.flight.strikes.len())?;
        writeln!(out, "{:<14} {:>19} s", crate::block::stopped(&self.flight.stop), digits(self.flight.stop.time_s()))?;
        let largest = self.flight.strikes.iter().map(shock).fold(0.0, f64::max);
        writeln!(out)?;
        writeln!(out, "   impact  corner        time         until      approach   shock there  largest shock")?;
        writeln!(out, "                             s             s           m/s           m/s            m/s")?;
        let mut left = 0;
        for strike in &self.flight.strikes {
            if !self.all && shock(strike) < MATTERS * largest && !self.is_unfinished(strike) {
                left += 1;
                continue;
            }
            let until = if strike.until_s.is_finite() { figures(strike.until_s) } else { "-".to_owned() };
            let known = |x: f64| if self.is_unfinished(strike) { "-".to_owned() } else { figures(x) };
            writeln!(
                out,
                "{:>9}  {:<6}{:>14}{until:>14}{:>14}{:>14}{:>15}",
                strike.number,
                Block::corner_name(strike.corner),
                figures(strike.time_s),
                figures(strike.approach_m_s),
                known(strike.delta_v_m_s[strike.corner]),
                known(shock(strike)),
            )?;
        }
        if left > 0 {
            writeln!(out, "and {left} of less than {} of the largest shock; --all lists them", given(MATTERS))?;
        }
        Ok(())
    }

    fn csv(&self, out: &mut dyn Write) -> io::Result<()> {
        write!(out, "number,corner,time_s,until_s,approach_m_s")?;
        (0..8).try_for_each(|corner| write!(out, ",delta_v_{}_m_s", Block::corner_name(corner)))?;
        writeln!(out)?;
        for strike in &self.flight.strikes {
            let BlockStrike { number, corner, time_s, until_s, approach_m_s, delta_v_m_s } = strike;
            let until = if until_s.is_finite() { given(*until_s) } else { "infinite".to_owned() };
            let corner = Block::corner_name(*corner);
            write!(out, "{number},{corner},{},{until},{}", given(*time_s), given(*approach_m_s))?;
            for v in delta_v_m_s {
                let known = if self.is_unfinished(strike) { String::new() } else { given(*v) };
                write!(out, ",{known}")?;
            }
            writeln!(out)?;
        }
        Ok(())
    }

    fn answer(&self) -> Answer {
        let impact = |strike: &BlockStrike| ImpactJson {
            number: strike.number,
            corner: Block::corner_name(strike.corner),
            time_s: Json(strike.time_s),
            approach_m_s: Json(strike.approach_m_s),
            delta_v_m_s: strike.delta_v_m_s.map(|v| (!self.is_unfinished(strike)).then_some(Json(v))),
            until_s: Json(strike.until_s),
        };
        Answer {
            drop: self.setup.answer(),
            contact_law: self.setup.contact.law().name(),
            energy_error: Json(self.flight.energy_error),
            impacts: self.flight.strikes.iter().map(impact).collect(),
            stop: crate::block::StopJson::new(&self.flight.stop),
        }
    }
}

#[derive(Serialize)]
struct Answer {
    #[serde(flatten)]
    drop: crate::block::DropJson,
    contact_law: &'static str,
    /// What the energy of the body changes by without reason, over that at the first touch.
    energy_error: Json,
    impacts: Vec<ImpactJson>,
    stop: crate::block::StopJson,
}

#[derive(Serialize)]
struct ImpactJson {
    number: u64,
    /// The signs of x, y and z.
    corner: &'static str,
    time_s: Json,
    approach_m_s: Json,
    /// Of the corners ---, +--, -+-, ++-, --+, +-+, -++, +++; null where a limit has cut off the contact.
    delta_v_m_s: [Option<Json>; 8],
    until_s: Json,
}
