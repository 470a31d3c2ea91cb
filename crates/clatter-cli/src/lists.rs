//! This module reads lists of shocks, pulses and tests from files: a header that names the columns, in any order, and a row for
//! each, in any notation of records.

use std::path::Path;

use clatter_product::units::Dimension;
use clatter_record::Cell;
use clatter_shock::{LimitCurve, Pulse, Trial, VelocityShock};

use crate::excitation::{self, LimitArg};
use crate::text::visible;
use crate::{Failure, input};

/// Reads velocity shocks, in order of time.
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

/// Reads pulses, in any order.
pub(crate) fn pulses(path: &Path) -> Result<Vec<Pulse>, Failure> {
    let mut list = Vec::new();
    rows(path, ["shape", "amplitude_m_s2", "duration_s", "start_s"], |[shape, amplitude, duration, start]| {
        let shape = excitation::shape(shape.text)?;
        let [amplitude, duration, start] =
            [("amplitude_m_s2", amplitude), ("duration_s", duration), ("start_s", start)]
                .map(|(name, cell)| finite(name, cell));
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

/// Reads shock tests: of rising velocity change in short pulses, in m/s, and of rising acceleration in long rectangles, in
/// m/s².
pub(crate) fn tests(path: &Path) -> Result<[Vec<Trial>; 2], Failure> {
    let mut lists = [Vec::new(), Vec::new()];
    rows(path, ["test", "level", "damaged"], |[test, level, damaged]| {
        let list = match test.text.to_ascii_lowercase().as_str() {
            "velocity-change" => 0,
            "acceleration" => 1,
            _ => {
                return Err(format!(
                    "test '{}' is not velocity-change (in m/s) or acceleration (in m/s2)",
                    visible(test.text)
                ));
            }
        };
        let level = finite("level", level)?;
        if level <= 0.0 {
            return Err(format!("level = {level:?} is not > 0"));
        }
        let damaged = match damaged.text.to_ascii_lowercase().as_str() {
            "yes" => true,
            "no" => false,
            _ => return Err(format!("damaged '{}' is not yes or no", visible(damaged.text))),
        };
        lists[list].push(Trial { level, damaged });
        Ok(())
    })?;
    Ok(lists)
}

/// Reads a limit curve, for spectra of this kind of quantity.
pub(crate) fn limit(path: &Path, dimension: &'static Dimension) -> Result<LimitArg, Failure> {
    let bad = |reason| Failure::Record { path: path.to_owned(), reason };
    let file = input::open(path).map_err(|error| bad(clatter_record::Error::Read(error.to_string())))?;
    let read = clatter_record::read_limit(file).map_err(bad)?;
    if let Some(of) = read.of.filter(|of| *of != dimension.name) {
        let reason = format!("the level is of {of}, and the spectrum is one of {}", dimension.name);
        return Err(bad(clatter_record::Error::Units(reason)));
    }
    let curve = LimitCurve::new(read.points).map_err(|reason| bad(reason.into()))?;
    let spelled = read.unit.map(|unit| unit.to_lowercase());
    let unit = spelled.and_then(|spelled| dimension.unit(&spelled));
    Ok(LimitArg { curve, level: None, typed: unit.map(|unit| (dimension, unit)) })
}

/// Reads the columns of these names row by row.
fn rows<const N: usize>(
    path: &Path,
    names: [&str; N],
    each: impl FnMut([Cell<'_>; N]) -> Result<(), String>,
) -> Result<(), Failure> {
    let unreadable = |reason| Failure::Unreadable { path: path.to_owned(), reason };
    clatter_record::read_list(input::open(path).map_err(unreadable)?, names, each)
        .map_err(|reason| Failure::List { path: path.to_owned(), reason })
}

/// Reads the number of a cell.
fn finite(name: &str, cell: Cell<'_>) -> Result<f64, String> {
    cell.number.ok_or_else(|| format!("{name}: '{}' is not a number such as 0.5", visible(cell.text)))
}
