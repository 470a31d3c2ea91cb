//! Lists of shocks, pulses and tests that come as files: a header that names the columns, in any order, and a row for
//! each.

mod rows;

use std::path::Path;

use clatter_shock::{Pulse, Trial, VelocityShock};

use crate::Failure;
use crate::excitation;
use crate::inputs::number;
use crate::text::visible;
use rows::rows;
pub(crate) use rows::rows_of;

/// Velocity shocks, in order of time.
pub(crate) fn shocks(path: &Path) -> Result<Vec<VelocityShock>, Failure> {
    let mut list: Vec<VelocityShock> = Vec::new();
    rows(path, ["time_s", "delta_v_m_s"], |[time, delta_v]| {
        let shock = VelocityShock { time: finite("time_s", time)?, delta_v: finite("delta_v_m_s", delta_v)? };
        if let Some(before) = list.last().filter(|before| shock.time < before.time) {
            return Err(format!("time_s {:?} is before {:?}, the row above; sort by time", shock.time, before.time));
        }
        list.push(shock);
        Ok(())
    })?;
    Ok(list)
}

/// Pulses, in any order.
pub(crate) fn pulses(path: &Path) -> Result<Vec<Pulse>, Failure> {
    let mut list = Vec::new();
    rows(path, ["shape", "amplitude_m_s2", "duration_s", "start_s"], |[shape, amplitude, duration, start]| {
        let shape = excitation::shape(shape)?;
        let [amplitude, duration, start] =
            [("amplitude_m_s2", amplitude), ("duration_s", duration), ("start_s", start)]
                .map(|(name, text)| finite(name, text));
        let pulse = Pulse { shape, amplitude: amplitude?, duration: duration?, start: start? };
        if pulse.duration == 0.0 {
            return Err("a pulse of zero duration is a velocity shock: give its velocity change in a file of shocks \
                        (--shocks-file), or a duration > 0"
                .to_owned());
        }
        list.push(excitation::checked(pulse)?);
        Ok(())
    })?;
    Ok(list)
}

/// Shock tests: of rising velocity change in short pulses, in m/s, and of rising acceleration in long rectangles, in
/// m/s².
pub(crate) fn tests(path: &Path) -> Result<[Vec<Trial>; 2], Failure> {
    let mut lists = [Vec::new(), Vec::new()];
    rows(path, ["test", "level", "damaged"], |[test, level, damaged]| {
        let list = match test {
            "velocity-change" => 0,
            "acceleration" => 1,
            _ => {
                return Err(format!(
                    "test '{}' is not velocity-change (in m/s) or acceleration (in m/s2)",
                    visible(test)
                ));
            }
        };
        let level = finite("level", level)?;
        if level <= 0.0 {
            return Err(format!("level = {level:?} is not > 0"));
        }
        let damaged = match damaged {
            "yes" => true,
            "no" => false,
            _ => return Err(format!("damaged '{}' is not yes or no", visible(damaged))),
        };
        lists[list].push(Trial { level, damaged });
        Ok(())
    })?;
    Ok(lists)
}

pub(crate) fn finite(name: &str, text: &str) -> Result<f64, String> {
    let value = number(text).map_err(|error| format!("{name}: {error}"))?;
    if value.is_finite() { Ok(value) } else { Err(format!("{name} = {value:?} is not finite")) }
}
