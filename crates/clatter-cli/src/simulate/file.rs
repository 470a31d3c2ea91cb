//! This module writes the whole motion as a file.

use std::io::{self, Write};

use clatter_flight::Motion;

use super::Drop;
use crate::Failure;
use crate::numbers::digits;
use crate::output::{self, Kind, Target};
use clatter_figures::FigureError;

/// The largest number of rows that is written where the command line gives no limit.
const MOST_ROWS: usize = 4_000_000;

impl Drop<'_> {
    pub(super) fn write(&self, Target { path, kind }: &Target) -> Result<(), Failure> {
        let (Some(motion), Some(history)) = (self.answer.impacts.train().motion(), self.answer.with_history()) else {
            return Err(Failure::Usage(
                "-o writes the motion of a bar: that of a plate or a box is not written to a file, --format=json or csv has its strikes",
            ));
        };
        let unasked = self.args.time_limit_s().is_none() && self.args.impact_limit.is_none();
        if unasked && motion.rows().nth(MOST_ROWS).is_some() {
            return Err(Failure::Usage(
                "the motion has more than 4 million rows, some hundred megabytes: --time-limit-s or --impact-limit says how far it is wanted",
            ));
        }
        output::replace(path, |file| match kind {
            Kind::Csv => output::buffered(file, |out| self.history_csv(motion, out)),
            Kind::Json => output::json(file, &history),
            _ => output::buffered(file, |out| out.write_all(self.svg(motion)?.as_bytes())),
        })
    }

    /// Returns the requested positions.
    fn at(&self) -> Vec<f64> {
        self.answer.at.iter().map(|[s, ..]| s.0).collect()
    }

    fn svg(&self, motion: &Motion) -> Result<String, FigureError> {
        let rows: Vec<_> = motion.rows().collect();
        clatter_figures::drop(&clatter_figures::Drop {
            model: &self.physics(),
            rows: &rows,
            strikes: &motion.strikes,
            pulses: &motion.presses,
            stop: motion.stop,
            at: &self.at(),
            called: &self.named(),
        })
    }

    /// Returns the names of the places in the picture: the part of the product, or else the length from the middle.
    fn named(&self) -> Vec<String> {
        let millimeters =
            |s: f64| format!("{} mm", clatter_figures::three(500.0 * self.answer.drop.body.length_m() * s));
        let part = self.setup.part.as_ref().filter(|_| self.args.at.is_empty());
        let named =
            |s: f64| part.map_or(format!("at {}", millimeters(s)), |part| format!("{}, {}", part.name, millimeters(s)));
        self.at().into_iter().map(named).collect()
    }

    fn history_csv(&self, motion: &Motion, out: &mut dyn Write) -> io::Result<()> {
        let at = self.at();
        write!(out, "time_s,height_a_m,height_b_m,velocity_a_m_s,velocity_b_m_s")?;
        for s in &at {
            write!(out, ",velocity_at_{}_m_s", digits(*s))?;
        }
        if motion.contact().is_some() {
            write!(out, ",force_per_mass_a_m_s2,force_per_mass_b_m_s2,acceleration_a_m_s2,acceleration_b_m_s2")?;
            for s in &at {
                write!(out, ",acceleration_at_{}_m_s2", digits(*s))?;
            }
        }
        writeln!(out)?;
        for row in motion.rows() {
            write!(out, "{}", digits(row.time_s))?;
            let velocities = row.velocity_m_s.into_iter().chain(at.iter().map(|s| row.velocity_at(*s)));
            for x in row.height_m.into_iter().chain(velocities) {
                write!(out, ",{}", digits(x))?;
            }
            if let Some(forces) = row.forces {
                let ends = forces.force_per_mass_m_s2.into_iter().chain(forces.acceleration_m_s2);
                for x in ends.chain(at.iter().map(|s| forces.acceleration_at(*s))) {
                    write!(out, ",{}", digits(x))?;
                }
            }
            writeln!(out)?;
        }
        Ok(())
    }
}
