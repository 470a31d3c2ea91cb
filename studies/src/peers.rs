//! Results of other tools for the same scenes: `peers/results.json`, as `peers/run.py` last wrote it, as rows and a
//! figure.

use std::collections::BTreeMap;

use crate::figures::{Dot, Tool, tools};
use clatter_figures::{FigureError, tick};
use clatter_report::File;
use serde::Deserialize;
use serde_json::{Value, json};

use crate::Error;
use crate::files::pretty;

/// The last run.
const RESULTS: &str = include_str!("../../peers/results.json");

#[derive(Debug, Deserialize)]
struct Results {
    date: String,
    machine: Machine,
    bars: Bars,
    spectra: Spectra,
    maps: Maps,
    records: Records,
    skipped: BTreeMap<String, String>,
}

#[derive(Debug, Deserialize)]
struct Machine {
    cpu: String,
    cores: u32,
    load_before: f64,
    load_after: f64,
    rustc: String,
    python: String,
}

#[derive(Debug, Deserialize)]
struct Bars {
    designs: [[f64; 2]; 4],
    impacts: [u64; 4],
    half_length_m: f64,
    speed_m_s: f64,
    tilt_deg: f64,
    rows: Vec<BarRow>,
}

#[derive(Debug, Deserialize)]
struct BarRow {
    tool: String,
    version: String,
    setting: String,
    impacts: [u64; 4],
    /// The least and the largest number from starts lifted by parts of a step's travel, where there are steps.
    impacts_lifted: Option<[[u64; 2]; 4]>,
    /// Error of the largest shock at an end, relative, the largest of the four bars.
    error: f64,
    ms: [f64; 4],
    /// Time over that of the train of clatter.
    ratio: [f64; 4],
}

impl Machine {
    fn numbers(&self, date: &str) -> Value {
        json!({ "date": date, "cpu": self.cpu, "cores": self.cores,
                "load": [tick(round(self.load_before)), tick(round(self.load_after))],
                "rustc": self.rustc, "python": self.python })
    }
}

impl BarRow {
    /// Returns the correctness of the count of a bar.
    fn dot(&self, bar: usize, truth: u64) -> Dot {
        let lifted = self.impacts_lifted.map_or([truth; 2], |lifted| lifted[bar]);
        match (self.impacts[bar] == truth, lifted == [truth; 2]) {
            (true, true) => Dot::Right,
            (true, false) => Dot::ByChance,
            (false, _) => Dot::Wrong,
        }
    }
}

#[derive(Debug, Deserialize)]
struct Spectra {
    /// Date and machine of the spectra, where they were measured again alone.
    date: Option<String>,
    machine: Option<Machine>,
    rows: Vec<SpectrumRow>,
}

#[derive(Debug, Deserialize)]
struct SpectrumRow {
    tool: String,
    /// Sampling rate; none where the pulses themselves are given.
    rate_hz: Option<f64>,
    error: f64,
    ms: f64,
    /// Time over that of clatter on the same record.
    ratio: Option<f64>,
}

/// A file of measured accelerations, and band-limited tones.
#[derive(Debug, Deserialize)]
struct Records {
    date: String,
    machine: Machine,
    samples: u64,
    samples_a_cycle: Vec<f64>,
    rows: Vec<RecordRow>,
}

#[derive(Debug, Deserialize)]
struct RecordRow {
    tool: String,
    reading_ms: Option<f64>,
    /// Time of the spectra, without reading.
    ms: Option<f64>,
    /// Errors at each number of samples a cycle.
    errors: Option<Vec<f64>>,
}

impl Records {
    fn numbers(&self) -> Value {
        let rows = self.rows.iter().map(|row| {
            let errors = row
                .errors
                .iter()
                .flatten()
                .map(|error| format!("{:.2}", (1e4 * error).round() / 100.0 + 0.0).replace('-', "−"));
            json!({
                "tool": row.tool, "reading": row.reading_ms.map(time), "time": row.ms.map(time),
                "errors": errors.collect::<Vec<_>>(),
            })
        });
        json!({
            "measured": self.machine.numbers(&self.date), "samples": self.samples,
            "samples_a_cycle": self.samples_a_cycle.iter().map(|count| tick(*count)).collect::<Vec<_>>(),
            "rows": rows.collect::<Vec<_>>(),
        })
    }
}

#[derive(Debug, Deserialize)]
struct Maps {
    points: u64,
    rows: Vec<MapRow>,
    largest_difference: Option<f64>,
}

#[derive(Debug, Deserialize)]
struct MapRow {
    tool: String,
    ms: f64,
    ratio: f64,
}

impl Results {
    fn read() -> Result<Self, Error> {
        serde_json::from_str(RESULTS).map_err(|error| Error::Data(format!("peers/results.json: {error}")))
    }

    /// Returns the numbers of the page.
    fn numbers(&self) -> Value {
        let bars = self.bars.rows.iter().map(|row| {
            let dots = std::array::from_fn::<_, 4, _>(|i| row.dot(i, self.bars.impacts[i]));
            let count = |kept: fn(&Dot) -> bool| dots.iter().filter(|dot| kept(dot)).count();
            json!({
                "tool": row.tool, "version": row.version, "setting": row.setting,
                "impacts": row.impacts, "lifted": row.impacts_lifted,
                "right": count(|dot| *dot != Dot::Wrong), "right_from_any_start": count(|dot| *dot == Dot::Right),
                "error": error(row.error), "time": row.ms.map(time), "ratio": span(&row.ratio),
            })
        });
        let mut spectra: Vec<(&str, Vec<Value>)> = Vec::new();
        for row in &self.spectra.rows {
            let cell = json!({
                "rate_khz": row.rate_hz.map(|hz| tick(1e-3 * hz)), "error": percent(row.error), "time": time(row.ms),
                "ratio": row.ratio.map(two),
            });
            match spectra.iter_mut().find(|(tool, _)| *tool == row.tool) {
                Some((_, cells)) => cells.push(cell),
                None => spectra.push((&row.tool, vec![cell])),
            }
        }
        let maps =
            self.maps.rows.iter().map(|row| json!({ "tool": row.tool, "time": time(row.ms), "ratio": two(row.ratio) }));
        json!({
            "measured": self.machine.numbers(&self.date),
            "spectra_measured": self.spectra.machine.as_ref().zip(self.spectra.date.as_ref()).map(|(m, date)| m.numbers(date)),
            "bars": { "designs": self.bars.designs, "impacts": self.bars.impacts, "rows": bars.collect::<Vec<_>>(),
                      "half_length_mm": tick(1e3 * self.bars.half_length_m), "speed_m_s": tick(self.bars.speed_m_s),
                      "tilt_deg": tick(self.bars.tilt_deg) },
            "spectra": spectra.into_iter().map(|(tool, cells)| json!({ "tool": tool, "cells": cells })).collect::<Vec<_>>(),
            "maps": { "points": self.maps.points, "rows": maps.collect::<Vec<_>>(),
                      "difference": self.maps.largest_difference.map(error) },
            "records": self.records.numbers(),
            "skipped": self.skipped,
        })
    }

    fn figure(&self) -> Result<String, FigureError> {
        let rows = self.bars.rows.iter().map(|row| Tool {
            name: &row.tool,
            bars: std::array::from_fn(|i| (row.impacts[i], row.dot(i, self.bars.impacts[i]), row.ms[i])),
            error: error(row.error),
        });
        tools(&rows.collect::<Vec<_>>(), self.bars.designs)
    }
}

/// Rounds to a tenth.
fn round(v: f64) -> f64 {
    (10.0 * v).round() / 10.0
}

/// Returns two significant digits; thousands apart, below 0.001 with a power of ten.
fn two(v: f64) -> String {
    if v < 1e-3 {
        return tick(v);
    }
    let rounded = format!("{v:.1e}");
    let (value, exponent) =
        (rounded.parse().unwrap_or(v), rounded.rsplit('e').next().and_then(|e| e.parse::<i32>().ok()));
    let text = format!("{value:.*}", usize::try_from(1 - exponent.unwrap_or(0)).unwrap_or(0));
    if value < 1e3 {
        return text;
    }
    let (head, rest) = text.split_at(text.len() % 3);
    let groups = rest.as_bytes().chunks(3).map(|group| String::from_utf8_lossy(group).into_owned());
    let head = (!head.is_empty()).then(|| head.to_owned());
    head.into_iter().chain(groups).collect::<Vec<_>>().join("\u{202f}")
}

/// Returns a time in the unit that leaves one to three digits before the point.
fn time(ms: f64) -> String {
    let (value, unit) = if ms < 1e-3 {
        (1e6 * ms, "ns")
    } else if ms < 1.0 {
        (1e3 * ms, "µs")
    } else {
        (ms, "ms")
    };
    format!("{}\u{a0}{unit}", two(value))
}

/// Returns a relative error; one that is only rounding is marked as such.
fn error(v: f64) -> String {
    if v < 1e-15 { "rounding".to_owned() } else { two(v) }
}

/// Returns an error in per cent.
fn percent(v: f64) -> String {
    if v == 0.0 { "exact".to_owned() } else { format!("{}\u{a0}%", two(100.0 * v)) }
}

/// Returns the span from the least to the largest.
fn span(values: &[f64; 4]) -> String {
    let (low, high) = values.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), v| (a.min(*v), b.max(*v)));
    let (low, high) = (two(low), two(high));
    if low == high { low } else { format!("{low}–{high}") }
}

/// Returns `peers.json` and `peers.svg`.
pub(crate) fn files() -> Result<Vec<File>, Error> {
    let results = Results::read()?;
    Ok(vec![("peers.json", pretty(&results.numbers())?), ("peers.svg", results.figure()?)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use clatter::design::DESIGNS;
    use clatter::{Bar, Count, Start};
    use clatter_flight::{Model, Profile, Scene};

    #[test]
    fn the_last_run_left_no_tool_out() {
        let results = Results::read().unwrap();
        assert!(results.skipped.is_empty(), "left out: {:?}", results.skipped);
        let bars: Vec<_> = results.bars.rows.iter().map(|row| row.tool.as_str()).collect();
        let [closed, train, tilt] = ["clatter, closed form", "clatter, train", "clatter, real tilt"];
        let [python, scipy, siconos] = ["plain Python loop", "SciPy solve_ivp", "Siconos"];
        assert_eq!(bars, [closed, train, tilt, python, scipy, siconos, "Rapier2D f64", "MuJoCo"]);
        let spectra: Vec<_> = results.spectra.rows.iter().map(|row| (row.tool.as_str(), row.rate_hz)).collect();
        let record = |tool| [20e3, 100e3, 500e3].map(|rate| (tool, Some(rate)));
        for tool in ["clatter, record", "pyyeti", "pyyeti, no roll-off correction", "endaq"] {
            for row in record(tool) {
                assert!(spectra.contains(&row), "no row {row:?}");
            }
        }
        let records: Vec<_> = results.records.rows.iter().map(|row| row.tool.as_str()).collect();
        assert_eq!(records, ["clatter", "clatter, straight lines", "polars", "pyyeti", "endaq"]);
        let ours = results.records.rows[0].errors.as_ref().unwrap();
        // README states these errors, except that of the last tone: its bell reaches beyond the band.
        assert!(ours.len() == 7 && ours[..6].iter().all(|error| error.abs() < 1e-3), "{ours:?}");
        assert!(spectra.contains(&("clatter, exact pulses", None)), "no row of exact pulses");
        assert_eq!((spectra.len(), results.maps.rows.len()), (13, 4));
        let unit = results.bars.rows[1].ms;
        for row in &results.bars.rows {
            for ((ms, ratio), unit) in row.ms.iter().zip(row.ratio).zip(unit) {
                assert!(*ms > 0.0, "{} has no time", row.tool);
                assert!((ratio * unit / ms - 1.0).abs() < 1e-12, "{}: the ratio of {ms} ms is not {ratio}", row.tool);
            }
        }
    }

    #[test]
    fn our_rows_are_exact_and_those_of_this_code() {
        let results = Results::read().unwrap();
        assert_eq!((results.bars.designs, results.bars.impacts), (DESIGNS, [4, 16, 31, 24]));
        let [closed, train, tilt] = [0, 1, 2].map(|i| &results.bars.rows[i]);
        for row in [closed, train, tilt] {
            assert_eq!(row.impacts, results.bars.impacts, "{}", row.tool);
        }
        // This is the accuracy that the peak has everywhere.
        assert!(closed.error <= 1e-13 && train.error <= 1e-13, "{closed:?}, {train:?}");
        let mut off = 0.0_f64;
        for ([q, e], truth) in DESIGNS.into_iter().zip(results.bars.impacts) {
            let bar = Bar::new(q, e).unwrap();
            let summary = bar.summary(&Start::default());
            assert_eq!(summary.count, Count::Finite(truth), "({q}, {e})");
            assert_eq!(bar.train(&Start::default()).count() as u64, truth, "({q}, {e})");
            let body =
                Profile::new(2.0 * results.bars.half_length_m, results.bars.half_length_m * bar.gyration_ratio());
            let scene = Scene::new(body.unwrap(), e, results.bars.speed_m_s, results.bars.tilt_deg, 0.0).unwrap();
            let strikes = scene.fly(Model::FiniteTilt).unwrap().strikes;
            assert_eq!(strikes.len() as u64, truth, "({q}, {e}) at real tilt");
            let largest = strikes.iter().flat_map(|s| s.delta_v_m_s).fold(0.0_f64, |m, v| m.max(v.abs()));
            off = off.max((largest / (results.bars.speed_m_s * summary.peak.end) - 1.0).abs());
        }
        // The tilt itself changes the peak by that much, to roundings of shocks of order 1.
        assert!((off - tilt.error).abs() < 1e-13, "{off:e} and {:e}", tilt.error);
    }

    #[test]
    fn counts_are_right_by_chance_where_another_start_changes_them() {
        let mut row: BarRow = serde_json::from_value(json!({
            "tool": "", "version": "", "setting": "", "error": 0.0, "ms": [1, 1, 1, 1], "ratio": [1, 1, 1, 1],
            "impacts": [4, 15, 31, 24], "impacts_lifted": [[4, 4], [16, 16], [30, 31], [24, 25]],
        }))
        .unwrap();
        let dots = |row: &BarRow| [0, 1, 2, 3].map(|i| row.dot(i, [4, 16, 31, 24][i]));
        assert_eq!(dots(&row), [Dot::Right, Dot::Wrong, Dot::ByChance, Dot::ByChance]);
        row.impacts_lifted = None;
        assert_eq!(dots(&row), [Dot::Right, Dot::Wrong, Dot::Right, Dot::Right]);
    }

    #[test]
    fn numbers_have_two_digits_and_their_unit() {
        let expected = ["0.025", "0.31", "1.0", "100", "350", "1\u{202f}000", "120\u{202f}000"];
        assert_eq!([0.0252, 0.31, 1.04, 99.6, 347.0, 999.0, 123_456.0].map(two), expected);
        assert_eq!([5.46e-5, 0.0243, 213.1].map(time), ["55\u{a0}ns", "24\u{a0}µs", "210\u{a0}ms"]);
        assert_eq!([2e-16, 3.8e-5, 0.0306].map(error), ["rounding", "4·10⁻⁵", "0.031"]);
        assert_eq!(span(&[2.0, 30.0, 4.0, 5.0]), "2.0–30");
    }

    #[test]
    fn the_figure_stays_within_its_frame_and_shows_every_count() {
        let files = files().unwrap();
        crate::frame::stay_within_their_frame(&files);
        let results = Results::read().unwrap();
        for row in &results.bars.rows {
            assert!(files[1].1.contains(&row.tool), "{} is not drawn", row.tool);
        }
    }

    #[test]
    fn the_section_names_every_tool() {
        let section = ("peers.typ", include_str!("../../reports/peers.typ").to_owned());
        let files = || Ok::<_, Error>(files()?.into_iter().chain([section.clone()]).collect());
        let source = "#import \"style.typ\": *\n#import \"peers.typ\": peers\n#show: report.with(title: \"Peers\")\n= Peers\n\
                      #peers(json(\"peers.json\"))";
        let dir = tempfile::tempdir().unwrap();
        clatter_report::write_pages("x.pdf", ("x.typ", source), &files, &[], dir.path(), &mut |_| ()).unwrap();
        let pdf = lopdf::Document::load(dir.path().join("x.pdf")).unwrap();
        let said = pdf.extract_text(&pdf.get_pages().into_keys().collect::<Vec<_>>()).unwrap();
        let plain = |text: &str| text.chars().filter(|c| !c.is_whitespace()).collect::<String>();
        for row in &Results::read().unwrap().bars.rows {
            assert!(plain(&said).contains(&plain(&row.tool)), "{}: {said}", row.tool);
        }
    }
}
