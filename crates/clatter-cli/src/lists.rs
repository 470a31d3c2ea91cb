//! Lists of shocks, pulses and tests that come as files: a header that names the columns, in any order, and a row for
//! each.

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

use clatter_shock::{Pulse, Trial, VelocityShock};

use crate::Failure;
use crate::excitation;
use crate::inputs::number;

/// Bytes of a line at most.
const LONGEST: u64 = 1 << 16;

/// Reads the rows of a file, the columns of these names handed to `each` in the order of the names.
///
/// Empty lines and those that begin with `#` are skipped, columns of other names left out.
fn rows<const N: usize>(
    path: &Path,
    names: [&str; N],
    mut each: impl FnMut([&str; N]) -> Result<(), String>,
) -> Result<(), Failure> {
    let file = File::open(path).map_err(|reason| Failure::Unreadable { path: path.to_owned(), reason })?;
    let mut input = BufReader::with_capacity(1 << 20, file);
    let (mut text, mut line, mut rows) = (String::new(), 0, 0_usize);
    let mut places: Option<[usize; N]> = None;
    loop {
        text.clear();
        line += 1;
        let read = (&mut input).take(LONGEST).read_line(&mut text);
        let bad = |what: String| Failure::Line { path: path.to_owned(), line, what };
        let n = read.map_err(|reason| match reason.kind() {
            std::io::ErrorKind::InvalidData => bad("not text (UTF-8)".to_owned()),
            _ => Failure::Unreadable { path: path.to_owned(), reason },
        })? as u64;
        if n == 0 {
            break;
        }
        if n == LONGEST && !text.ends_with('\n') {
            return Err(bad(format!("longer than {LONGEST} bytes")));
        }
        let row = text.trim().trim_start_matches('\u{feff}');
        if row.is_empty() || row.starts_with('#') {
            continue;
        }
        let Some(places) = places else {
            let columns: Vec<_> = row.split(',').map(|name| name.trim().trim_matches('"')).collect();
            let mut found = [0; N];
            for (place, name) in found.iter_mut().zip(names) {
                let mut at = (0..columns.len()).filter(|i| columns[*i] == name);
                *place = at.next().ok_or_else(|| {
                    bad(format!("no column {name}; the first line names the columns, {} among them", names.join(",")))
                })?;
                if let Some(other) = at.next() {
                    return Err(bad(format!("columns {} and {} are both named {name}", *place + 1, other + 1)));
                }
            }
            places = Some(found);
            continue;
        };
        let mut cells = [None; N];
        for (i, cell) in row.split(',').enumerate() {
            if let Some(k) = places.iter().position(|place| *place == i) {
                cells[k] = Some(cell.trim().trim_matches('"'));
            }
        }
        if let Some(k) = cells.iter().position(Option::is_none) {
            return Err(bad(format!("column {} ({}) is missing", places[k] + 1, names[k])));
        }
        each(cells.map(Option::unwrap_or_default)).map_err(bad)?;
        rows += 1;
    }
    if rows == 0 {
        let what = format!("no rows; the first line is {}, a row for each follows", names.join(","));
        return Err(Failure::Line { path: path.to_owned(), line: (line - 1).max(1), what });
    }
    Ok(())
}

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
            _ => return Err(format!("test '{test}' is not velocity-change (in m/s) or acceleration (in m/s2)")),
        };
        let level = finite("level", level)?;
        if level <= 0.0 {
            return Err(format!("level = {level:?} is not > 0"));
        }
        let damaged = match damaged {
            "yes" => true,
            "no" => false,
            _ => return Err(format!("damaged '{damaged}' is not yes or no")),
        };
        lists[list].push(Trial { level, damaged });
        Ok(())
    })?;
    Ok(lists)
}

fn finite(name: &str, text: &str) -> Result<f64, String> {
    let value = number(text).map_err(|error| format!("{name}: {error}"))?;
    if value.is_finite() { Ok(value) } else { Err(format!("{name} = {value:?} is not finite")) }
}
