//! The presses of a box in one drop.

use std::io::{self, Write};

use clatter_answer::simulate::block::{self, Answer, Impact, Question};
use clatter_flight::Block;

use super::Args;
use crate::block::Setup;
use crate::drop_args::BesideBlock;
use crate::inputs::RowFormat;
use crate::numbers::{digits, figures, given};
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
        let answer = block::answer(&Question::new(setup.drop, setup.contact))?;
        let drop = Drop { setup, answer, all: self.all };
        match self.format {
            RowFormat::Table => drop.table(streams.out).map_err(Failure::Answer)?,
            RowFormat::Csv => drop.csv(streams.out).map_err(Failure::Answer)?,
            RowFormat::Json => streams.json(&drop.answer)?,
        }
        drop.warnings().into_iter().for_each(|warning| streams.note("warning", warning));
        Ok(())
    }
}

struct Drop {
    setup: Setup,
    answer: Answer,
    all: bool,
}

impl Drop {
    fn warnings(&self) -> Vec<String> {
        let mut warnings: Vec<String> = self.setup.warning().into_iter().collect();
        let unfinished = self.answer.impacts.iter().filter(|impact| impact.is_unfinished()).count();
        if unfinished > 0 {
            warnings.push(format!("{unfinished} contacts are cut off there: what they do in all is not known"));
        }
        warnings.extend(self.setup.left(&self.answer.stop));
        warnings
    }

    fn table(&self, out: &mut dyn Write) -> io::Result<()> {
        self.setup.heading(out)?;
        writeln!(out, "Impacts {:>26}", self.answer.impacts.len())?;
        writeln!(out, "{:<14} {:>19} s", crate::block::stopped(&self.answer.stop), digits(self.answer.stop.time_s()))?;
        let largest = self.answer.impacts.iter().map(Impact::largest_m_s).fold(0.0, f64::max);
        writeln!(out)?;
        writeln!(out, "   impact  corner        time         until      approach   shock there  largest shock")?;
        writeln!(out, "                             s             s           m/s           m/s            m/s")?;
        let mut left = 0;
        for impact in &self.answer.impacts {
            let largest_of = impact.largest_m_s();
            if !self.all && largest_of < MATTERS * largest && !impact.is_unfinished() {
                left += 1;
                continue;
            }
            let until = if impact.until_s.0.is_finite() { figures(impact.until_s.0) } else { "-".to_owned() };
            let known = |x: f64| if impact.is_unfinished() { "-".to_owned() } else { figures(x) };
            writeln!(
                out,
                "{:>9}  {:<6}{:>14}{until:>14}{:>14}{:>14}{:>15}",
                impact.number,
                impact.corner,
                figures(impact.time_s.0),
                figures(impact.approach_m_s.0),
                known(impact.delta_v_m_s[impact.index].map_or(0.0, |shock| shock.0)),
                known(largest_of),
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
        for impact in &self.answer.impacts {
            let Impact { number, corner, time_s, until_s, approach_m_s, .. } = impact;
            let until = if until_s.0.is_finite() { given(until_s.0) } else { "infinite".to_owned() };
            write!(out, "{number},{corner},{},{until},{}", given(time_s.0), given(approach_m_s.0))?;
            for shock in impact.delta_v_m_s {
                write!(out, ",{}", shock.map_or_else(String::new, |shock| given(shock.0)))?;
            }
            writeln!(out)?;
        }
        Ok(())
    }
}
