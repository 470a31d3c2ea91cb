//! This module shows the presses of a box in one drop.

use std::io::{self, Write};

use clatter_answer::simulate::block::{Answer, DropAnswer, Impact};
use clatter_flight::{Block, LEAST_OF_BLOCKS, Stop};

use super::Args;
use crate::drop_args::Setup;
use crate::numbers::{digits, figures, given};
use crate::quantities::neat;

/// Presses whose largest shock is below this share of the largest of all are left out of the table.
const MATTERS: f64 = 0.01;

/// A drop of a box and what came of it.
pub(super) struct Drop<'a> {
    pub(super) args: &'a Args,
    pub(super) setup: Setup,
    pub(super) answer: Answer,
}

impl Drop<'_> {
    pub(super) fn warnings(&self) -> Vec<String> {
        let (mut warnings, drop) = (Vec::new(), &self.setup.drop);
        let e = drop.restitution;
        if drop.contact_law.leaves_a_dent() && e < LEAST_OF_BLOCKS {
            let followed = format!("e = {e:?} is followed as {LEAST_OF_BLOCKS}");
            warnings.push(format!("{followed}: hysteretic contacts of a box rebound with that at least"));
        }
        let unfinished = self.answer.impacts.iter().filter(|impact| impact.is_unfinished()).count();
        if unfinished > 0 {
            warnings.push(format!("{unfinished} contacts are cut off there: what they do in all is not known"));
        }
        match self.answer.stop {
            Stop::TimeLimit { time_s } if self.args.time_limit_s().is_none_or(|limit_s| time_s < limit_s) => {
                warnings.push(format!(
                    "left at {time_s:?} s, where the box still moves: what follows is not in the answer"
                ));
            }
            Stop::ImpactLimit { .. } => {
                warnings.push("more impacts would follow; --impact-limit=N follows more".to_owned());
            }
            Stop::EnergyLimit { .. } => {
                warnings.push("left where the energy of the box is not what it should be".to_owned());
            }
            _ => {}
        }
        warnings
    }

    fn heading(&self, out: &mut dyn Write) -> io::Result<()> {
        let DropAnswer { size_m, gyration_m, e, speed_m_s, gravity_m_s2, contact_time_s, upward, .. } =
            &self.answer.drop;
        let [length, width, thickness] = size_m.map(|side| given(neat(1e3 * side.0)));
        let [x, y, z] = gyration_m.map(|radius| figures(1e3 * radius.0));
        let (law, time, gravity) =
            (self.answer.contact_law, given(neat(1e3 * contact_time_s.0)), given(gravity_m_s2.0));
        writeln!(out, "Any orientation, gravity {gravity} m/s2, {law} contacts of {time} ms")?;
        let e = given(e.0);
        writeln!(out, "Box of {length} x {width} x {thickness} mm, radii of gyration {x}, {y}, {z} mm; e = {e}")?;
        let [x, y, z] = upward.map(|up| figures(libm::acos(up.0.clamp(-1.0, 1.0)).to_degrees()));
        let speed = figures(speed_m_s.0);
        writeln!(
            out,
            "Its lowest corner touches at {speed} m/s; the vertical is {x}, {y} and {z} degrees from its axes\n"
        )
    }

    pub(super) fn table(&self, out: &mut dyn Write) -> io::Result<()> {
        self.heading(out)?;
        writeln!(out, "Impacts {:>26}", self.answer.impacts.len())?;
        let stopped = match self.answer.stop {
            Stop::AtRest { .. } => "At rest at",
            Stop::BouncedClear { .. } => "Bounced clear",
            _ => "Left at",
        };
        writeln!(out, "{stopped:<14} {:>19} s", digits(self.answer.stop.time_s()))?;
        let largest = self.answer.impacts.iter().map(Impact::largest_m_s).fold(0.0, f64::max);
        writeln!(out)?;
        writeln!(out, "   impact  corner        time         until      approach   shock there  largest shock")?;
        writeln!(out, "                             s             s           m/s           m/s            m/s")?;
        let mut left = 0;
        for impact in &self.answer.impacts {
            let largest_of = impact.largest_m_s();
            if !self.args.all && largest_of < MATTERS * largest && !impact.is_unfinished() {
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

    pub(super) fn csv(&self, out: &mut dyn Write) -> io::Result<()> {
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
