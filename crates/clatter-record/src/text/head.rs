//! The lines above the numbers tell more than the names of columns: rates, the settings of instruments, lines of numbers.

use super::layout::uncommented;
use crate::decimal::Decimal;
use crate::moment;
use crate::unit::{FREQUENCY, Kind, Unit};

/// Lines over which a quoted name may go.
const LONGEST_NAME: usize = 8;

/// Lines whose quotes close on a later one, joined; in place of those that were joined stand empty ones.
pub(super) fn join_quotes(mut lines: Vec<String>) -> Vec<String> {
    let odd = |line: &str| line.matches('"').count() % 2 == 1;
    let mut i = 0;
    while i < lines.len() {
        // An inch mark does not begin a cell.
        let begins = lines[i].rfind('"').is_some_and(|at| {
            let before = lines[i][..at].trim_end_matches(' ');
            before.is_empty() || before.ends_with([',', ';', '\t', '|'])
        });
        let end = (i + 1..lines.len().min(i + LONGEST_NAME)).find(|next| odd(&lines[*next]));
        if let Some(end) = end.filter(|_| begins && odd(&lines[i])) {
            let rest: Vec<String> = lines[i + 1..=end].iter_mut().map(std::mem::take).collect();
            for line in rest {
                let trimmed = lines[i].trim_end_matches('\r').len();
                lines[i].truncate(trimmed);
                lines[i].push(' ');
                lines[i].push_str(&line);
            }
            i = end;
        }
        i += 1;
    }
    lines
}

/// How many numbers a line is, if it is nothing else, by any separator and decimal mark. Dates are none.
pub(super) fn numbers(line: &str) -> usize {
    let line = line.trim();
    let is_plain =
        |c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.' | ',' | ';' | '|' | '\t' | ' ' | 'e' | 'E');
    if !line.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.')) || !line.chars().all(is_plain) {
        return 0;
    }
    if moment::seconds(line, None).is_some() {
        return 0;
    }
    let mut count = 0;
    for cell in line.split([';', '|', '\t', ' ']).flat_map(|cell| cell.split(", ")).filter(|cell| !cell.is_empty()) {
        let whole = |text: &str, point: u8| {
            Decimal::scan(text.as_bytes(), point).is_some_and(|(_, length)| length == text.len())
        };
        if whole(cell, b'.') || whole(cell, b',') {
            count += 1;
        } else if cell.split(',').all(|part| part.is_empty() || whole(part, b'.')) {
            count += cell.split(',').filter(|part| !part.is_empty()).count();
        } else {
            return 0;
        }
    }
    count
}

/// Words that a line of a sampling rate begins with.
const RATES: &str = "\
    sample rate, samplerate, sampling rate, samplingrate, sample frequency, sampling frequency, sampling freq, sample \
    freq, samples per second, abtastrate, abtastfrequenz, messrate, \
    update rate, scan rate, data rate, output data rate, rate, fs, frecuencia de muestreo, fréquence d'échantillonnage";
/// The same of the time between samples.
const INTERVALS: &str = "\
    sample interval, sampling interval, sample period, sampling period, time interval, time step, time increment, timestep, delta \
    t, dt, interval, x-axis delta, pas de temps, intervalo de muestreo, abtastintervall, abtastzeit, abtastperiode";

/// A time between samples of so many seconds has its unit beside it.
const LONGEST_STEP_S: f64 = 0.05;

/// The time between samples that lines above the numbers tell, and the line, from 1; nothing where they tell several, or in a way that
/// [may be read twice](in_groups).
pub(super) fn step(lines: &[String]) -> Option<(f64, usize)> {
    let mut found: Option<(f64, usize)> = None;
    for (i, line) in lines.iter().enumerate() {
        let Some(step_s) = step_of(line).filter(|_| !in_groups(line)) else { continue };
        if found.is_some_and(|(other, _)| (other / step_s - 1.0).abs() > 1e-6) {
            return None;
        }
        found = found.or(Some((step_s, i + 1)));
    }
    found
}

/// Returns whether a rate in hertz has three digits behind one point, which may stand between thousands: `10.000 Hz`.
pub(super) fn in_groups(line: &str) -> bool {
    let is_rate = step_of(line).is_some_and(|step_s| step_s < 1.0) && !line.to_lowercase().contains("khz");
    let grouped = |word: &str| {
        let (whole, fraction) = word.split_once('.').unwrap_or_default();
        let is = |text: &str| text.bytes().all(|c| c.is_ascii_digit());
        fraction.len() == 3 && (1..=3).contains(&whole.len()) && !whole.starts_with('0') && is(whole) && is(fraction)
    };
    is_rate && !told_as_time(line) && line.split(|c: char| !c.is_ascii_digit() && c != '.').any(grouped)
}

/// Returns whether a line tells a time between samples, and no rate.
fn told_as_time(line: &str) -> bool {
    let text = text_of(line);
    INTERVALS.split(", ").any(|key| text.starts_with(key))
}

/// A line as keys are sought in it.
fn text_of(line: &str) -> String {
    uncommented(line).0.trim_start_matches([';', '"', '*', ' ']).to_lowercase().replace('_', " ")
}

fn step_of(line: &str) -> Option<f64> {
    let text = text_of(line);
    let key = |keys: &str| {
        let ends = |rest: &&str| rest.starts_with(|c: char| !c.is_alphanumeric() && c != '_');
        keys.split(", ").filter_map(|key| text.strip_prefix(key)).find(ends).map(str::to_owned)
    };
    let (rest, is_rate) = match key(RATES) {
        Some(rest) => (rest, true),
        None => (key(INTERVALS)?, false),
    };
    let mut numbers: Vec<f64> = Vec::new();
    let mut unit = None;
    let separators = |c: char| c.is_whitespace() || matches!(c, ',' | ';' | ':' | '=' | '"' | '(' | ')' | '[' | ']');
    for word in rest.split(separators).filter(|word| !word.is_empty()) {
        let end = word.find(|c: char| c.is_alphabetic() && c != 'e' || c == 'µ').unwrap_or(word.len());
        let (number, spelled) = word.split_at(end);
        if let Ok(number) = number.parse::<f64>() {
            numbers.push(number);
        } else if !number.is_empty() {
            return None;
        }
        if !spelled.is_empty() {
            let size = match spelled {
                "sps" | "s/s" | "sa/s" | "samples/s" | "samples/sec" | "samples/second" => Some(1.0),
                "ksps" | "ks/s" | "ksa/s" => Some(1e3),
                _ => Unit::of(spelled).and_then(|unit| match (unit.kind, is_rate) {
                    (FREQUENCY, true) | (Kind::Time, false) => Some(unit.size),
                    _ => None,
                }),
            };
            // Other words may belong to another quantity.
            unit = Some(size?);
        }
    }
    let (number, others) = numbers.split_first()?;
    if others.iter().any(|other| other.to_bits() != number.to_bits()) {
        return None;
    }
    // A time without a unit that no logger has in seconds may be in any other.
    if !is_rate && unit.is_none() && *number >= LONGEST_STEP_S {
        return None;
    }
    let value = number * unit.unwrap_or(1.0);
    let step_s = if is_rate { value.recip() } else { value };
    (step_s > 0.0 && step_s.is_normal()).then_some(step_s)
}

/// The columns of an oscilloscope, as its settings tell them.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Scope {
    /// Name of each column.
    pub(super) names: Vec<String>,
    /// Unit of each column; empty where it tells none.
    pub(super) units: Vec<String>,
    /// Time of the first sample and between samples, where the first column counts them.
    pub(super) sampled_s: Option<[f64; 2]>,
}

/// Of a Rigol: `X,CH1,Start,Increment`, and below `Sequence,Volt,-6e-3,1e-4`.
pub(super) fn rigol(lines: &[String]) -> Option<Scope> {
    let split = |line: &String| line.split(',').map(|cell| cell.trim().to_owned()).collect::<Vec<_>>();
    let (names, below) =
        lines.windows(2).take(4).map(|pair| (split(&pair[0]), split(&pair[1]))).find(|(names, below)| {
            names.iter().any(|name| name == "Increment") && below.first().is_some_and(|word| word == "Sequence")
        })?;
    let told = |name: &str| below.get(names.iter().position(|other| other == name)?)?.parse::<f64>().ok();
    let sampled_s = [told("Start")?, told("Increment")?];
    let channels = names.iter().position(|name| name == "Start")?;
    let units = std::iter::once(String::new()).chain(below.get(1..channels)?.iter().cloned()).collect();
    Some(Scope { names, units, sampled_s: Some(sampled_s) })
}

/// Of a Tektronix TDS: the settings stand in the first two columns beside the numbers, times and values in the fourth and the
/// fifth.
pub(super) fn tektronix(lines: &[String]) -> Option<Scope> {
    let split =
        |line: &String| line.split(',').map(|cell| cell.trim().trim_matches('"').to_owned()).collect::<Vec<_>>();
    let first = split(lines.first()?);
    let is_number = |cell: Option<&String>| cell.is_some_and(|cell| cell.parse::<f64>().is_ok());
    if first[0] != "Record Length" || !is_number(first.get(3)) || !is_number(first.get(4)) {
        return None;
    }
    let names = ["", "", "", "time", "channel"].map(str::to_owned).to_vec();
    let units = vec![String::new(), String::new(), String::new(), axis(lines, "Horizontal")?, axis(lines, "Vertical")?];
    Some(Scope { names, units, sampled_s: None })
}

/// The unit of an axis by a line such as `Vertical Units,V`.
fn axis(lines: &[String], axis: &str) -> Option<String> {
    lines.iter().take(60).find_map(|line| {
        let mut cells = line.split([',', '\t']).map(|cell| cell.trim().trim_matches('"'));
        let key = cells.next()?;
        (key.strip_prefix(axis).is_some_and(|rest| rest == " Units"))
            .then(|| cells.next().unwrap_or_default().to_owned())
    })
}

/// The units of time and values that settings above the numbers tell.
pub(super) fn axes(lines: &[String]) -> Option<[String; 2]> {
    if lines.first().is_some_and(|line| line.starts_with("LECROY")) {
        return Some(["s".to_owned(), "V".to_owned()]);
    }
    Some([axis(lines, "Horizontal")?, axis(lines, "Vertical")?])
}

/// The units of time and acceleration that lines such as `Units: g` and `Time unit: ms` tell; empty where one is not told.
pub(super) fn units(lines: &[String]) -> Option<[String; 2]> {
    const KEYS: &str = "\
        unit, units, unité, unidad, unità, 単位, unitname, einheit, acceleration unit, acceleration units, unit of acceleration, units of acceleration, \
        amplitude unit, time unit, time units, x-axis unit";
    let mut found = [String::new(), String::new()];
    for line in lines.iter().take(60) {
        let text = uncommented(line).0;
        let Some((key, value)) = text.split_once([':', '=', ',', ';', '\t']) else { continue };
        let (key, value) = (key.trim().to_lowercase(), value.trim().trim_matches(['"', ',', ';']).trim());
        if !KEYS.split(", ").any(|other| other == key) {
            continue;
        }
        match Unit::of(value).map(|unit| unit.kind) {
            Some(Kind::Time) => value.clone_into(&mut found[0]),
            Some(Kind::Acceleration) => value.clone_into(&mut found[1]),
            _ => {}
        }
    }
    found.iter().any(|unit| !unit.is_empty()).then_some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_that_are_told() {
        let of = |line: &str| step(&[line.to_owned()]).map(|(step_s, _)| step_s.recip());
        for (line, hz) in [
            ("Sample rate,20000 Hz", Some(20_000.0)),
            ("# Sampling frequency (Hz): 10000", Some(10_000.0)),
            ("Samplerate: 10 kHz\tSamplerate: 10 kHz", None),
            ("fs = 51200", Some(51_200.0)),
            ("Sample Interval,1.0e-04", Some(1e4)),
            ("dt [ms]=0.1", Some(1e4)),
            ("DT=   .0001 SEC", Some(1e4)),
            ("SAMPLING_INTERVAL_S: 0.000100", Some(1e4)),
            ("X-Axis delta:\t1.000000E-004", Some(1e4)),
            ("Abtastrate: 10.000 Hz", None),
            ("Sample rate: 10.000 kHz", Some(1e4)),
            ("dt: 1.000 ms", Some(1e3)),
            ("Interval: 100", None),
            ("Sample rate: 100 Hz, 200 Hz", None),
            ("interval of calibration: 12 months", None),
            ("fsk 12", None),
            ("dt", None),
        ] {
            let got = of(line);
            assert!(got.zip(hz).is_some_and(|(a, b)| (a / b - 1.0).abs() < 1e-12) || got == hz, "{line}: {got:?}");
        }
        assert_eq!(step(&["fs: 100".to_owned(), "dt: 0.02".to_owned()]), None, "two that differ");
    }

    #[test]
    fn lines_of_numbers() {
        for (line, count) in [
            ("1,2,3", 3),
            ("0,0080;0,5", 2),
            ("1.5 -2e3", 2),
            ("80", 1),
            ("2023-05-01 12:00:00", 0),
            ("01.05.2023", 0),
            ("1,x", 0),
            ("e", 0),
            ("1.2.3", 0),
            ("", 0),
        ] {
            assert_eq!(numbers(line), count, "{line}");
        }
    }

    #[test]
    fn quotes_over_lines() {
        let lines = |text: &str| text.split('\n').map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(join_quotes(lines("\"t\n[s]\",\"a\n[g]\"\n0,1")), ["\"t [s]\",\"a [g]\"", "", "", "0,1"]);
        assert_eq!(join_quotes(lines("drop of 30\"\nfoam of 2\"\n0,1")), ["drop of 30\"", "foam of 2\"", "0,1"]);
    }
}
