//! This module shows the shocks of a record.

use std::io::{self, Write};

use clatter_record::{Channel, Record};
use clatter_shock::Shocks;

use super::begin_s;
use crate::numbers::{digits, figures};
use crate::text;

pub(super) fn table(channel: &Channel, name: &str, found: &Shocks, out: &mut dyn Write) -> io::Result<()> {
    let (count, beyond) = (found.shocks.len() + found.omitted, figures(found.threshold_m_s2));
    let plural = if count == 1 { "" } else { "s" };
    writeln!(out, "\n{name}: {count} shock{plural} beyond {beyond} m/s2")?;
    if found.omitted > 0 {
        writeln!(out, "the largest {} of them are listed", found.shocks.len())?;
    }
    if found.shocks.is_empty() {
        return Ok(());
    }
    let line = |out: &mut dyn Write, cells: [&str; 5]| {
        let cells = cells.map(|cell| format!("{cell:>16}"));
        writeln!(out, "{}", cells.concat())
    };
    line(out, ["start", "peak", "at", "duration", "velocity change"])?;
    line(out, ["s", "m/s2", "s", "s", "m/s"])?;
    for shock in &found.shocks {
        let [start, at] = [shock.start_s, shock.peak_time_s].map(|since_s| figures(begin_s(channel.times()) + since_s));
        let [peak, duration, velocity] = [shock.peak_m_s2, shock.duration_s, shock.velocity_change_m_s].map(figures);
        line(out, [&start, &peak, &at, &duration, &velocity])?;
    }
    Ok(())
}

pub(super) fn csv(record: &Record, found: &[Shocks], out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "channel,start_s,peak_m_s2,peak_time_s,duration_s,velocity_change_m_s")?;
    for (channel, found) in record.channels().iter().zip(found) {
        for shock in &found.shocks {
            let [start, at] = [shock.start_s, shock.peak_time_s].map(|since_s| channel.times().start_s() + since_s);
            let numbers = [start, shock.peak_m_s2, at, shock.duration_s, shock.velocity_change_m_s];
            writeln!(out, "{},{}", text::field(&channel.name), numbers.map(digits).join(","))?;
        }
    }
    Ok(())
}
