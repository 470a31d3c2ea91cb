//! How exact the results are: the data of the accuracy report, and what is made of them.
//!
//! Everything is measured when the report is made, against the same equations in 512 binary digits.

mod big;
mod digits;
mod part;
mod train;

use clatter::accuracy::{APPROACH, Allowance, DURATION, DURATION_LONG, FINAL, JUMP, NEAR_ENDLESS, PEAK, TABLE, TIME};
use clatter::flight::{Body, Flight, Model, Order, Residue, Scene, orders, residues};
use clatter_shock::accuracy::{FREE, PULSE, RECORD, TRAIN};
use rayon::prelude::*;
use serde_json::{Value, json};

use crate::ReportError;
use crate::figure::axes::raised;
use crate::figure::orders::{Panel, orders as figure};
use crate::paper::{File, pretty};
use crate::table::{csv, decimals};
use big::Big;
use digits::inputs;
use part::{Cell, Part};
use train::{Found, Judged, Row, Way};

/// Everything the report shows.
#[derive(Debug)]
pub(crate) struct Data {
    orders: Vec<Order>,
    residues: Vec<Residue>,
    flights: Vec<(&'static str, Flight)>,
    /// h0/v0 of the flights, in seconds, and their contact time.
    unit_s: f64,
    contact_s: f64,
    trains: Vec<Row>,
    part: Part,
    lines: Vec<digits::Line>,
}

/// One error at one extreme, as the accuracy report prints it.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Measured {
    /// What is computed: a train, free motion, a pulse, a record, a model.
    pub subject: &'static str,
    /// The extreme.
    pub extreme: String,
    /// The quantity.
    pub quantity: &'static str,
    /// What is allowed, relative to what `clatter::accuracy` and `clatter_shock::accuracy` say; `None` where nothing is
    /// promised.
    pub allowed: Option<f64>,
    /// What ours is off by; `None` where the quantity has no value.
    pub measured: Option<f64>,
    /// What a plain recurrence in f64 is off by, and a plain closed form: infinite where none came out.
    pub plain: [Option<f64>; 2],
}

/// The quantities of a train, as a column is headed.
const COLUMNS: [&str; 6] = ["peak", "approach", "jump", "time", "final", "duration"];
/// Scene of the flights: q = ½, e = 0.3, half-length 70 mm, 4.43 m/s at 5°.
const HALF_M: f64 = 0.07;
const SPEED_M_S: f64 = 4.43;
const TILT_DEG: f64 = 5.0;
const CONTACT_S: f64 = 5e-5;
/// Strikes of the flights that are shown.
const STRIKES: usize = 5;

/// Every error that the accuracy report prints, measured anew.
///
/// ```
/// for row in clatter_report::measured()? {
///     let (Some(allowed), Some(error)) = (row.allowed, row.measured) else { continue };
///     assert!(error <= allowed, "{row:?}");
/// }
/// # Ok::<(), clatter_report::ReportError>(())
/// ```
///
/// # Errors
/// None in practice: all cases are valid.
pub fn measured() -> Result<Vec<Measured>, ReportError> {
    Ok(Data::compute()?.measured())
}

impl Data {
    /// Computes everything, in parallel.
    pub(crate) fn compute() -> Result<Self, ReportError> {
        let ((orders, residues), (trains, part)) = rayon::join(
            || (orders(), residues()),
            || {
                let rows = || train::cases().par_iter().map(Row::new).collect::<Result<Vec<_>, _>>();
                rayon::join(rows, Part::compute)
            },
        );
        let body = Body::new(2.0 * HALF_M, HALF_M / 3f64.sqrt())?;
        let scene = Scene::new(body, 0.3, SPEED_M_S, TILT_DEG, 9.81)?;
        let rigid = |name, model| (name, scene.simulate(model));
        let flights = vec![
            rigid("map", Model::Map),
            rigid("ballistic", Model::Ballistic),
            rigid("finite tilt", Model::FiniteTilt),
            ("compliant", scene.simulate_compliant(CONTACT_S)?.flight),
        ];
        let trains = trains?;
        let lines = digits::lines(&trains)?;
        Ok(Self {
            orders: orders?,
            residues: residues?,
            flights,
            unit_s: scene.height_gap_m() / SPEED_M_S,
            contact_s: CONTACT_S,
            trains,
            part: part?,
            lines,
        })
    }

    /// Figure as SVG, numbers as JSON, errors as CSV.
    pub(crate) fn files(&self) -> Result<Vec<File>, ReportError> {
        let of = |parameter: &str| {
            let chosen = self.orders.iter().filter(|order| order.parameter.starts_with(parameter));
            chosen.map(|order| (order, format!("{} to {}", order.model, order.limit))).collect()
        };
        let panels = [
            Panel { title: "tilt *φ* in degrees", guide: "slope 2", curves: of("tilt") },
            Panel { title: "*G* = *gh*_0/*v*_0²", guide: "slope 1", curves: of("g h0") },
            Panel { title: "contact time over *h*_0/*v*_0", guide: "slope 1", curves: of("contact") },
        ];
        Ok(vec![
            ("accuracy-orders.svg", figure(&panels)),
            ("accuracy.json", pretty(&self.numbers())?),
            ("accuracy.csv", table(&self.measured())),
        ])
    }

    /// Every error, one after the other.
    fn measured(&self) -> Vec<Measured> {
        let mut rows = Vec::new();
        for row in &self.trains {
            let extreme = format!("{}: {}", row.case.name, inputs(&row.case));
            let ways = [&row.ours, &row.recurrence, &row.closed];
            let [ours, recurrence, closed] = ways.map(|way| miscount(row.exact, way.found));
            rows.push(Measured {
                subject: "train",
                extreme: extreme.clone(),
                quantity: "count",
                allowed: Some(0.0),
                measured: ours,
                plain: [recurrence, closed],
            });
            for (k, quantity) in COLUMNS.into_iter().enumerate() {
                let [ours, recurrence, closed] = ways.map(|way| way.judged[k]);
                rows.push(Measured {
                    subject: "train",
                    extreme: extreme.clone(),
                    quantity,
                    allowed: ours.allowed.map(|a| a.error),
                    measured: ours.error,
                    plain: [recurrence.error, closed.error],
                });
            }
        }
        let mut cells = |[subject, quantity]: [&'static str; 2], axis: &str, at: &[&str], lines: &[part::Line]| {
            for line in lines {
                for (at, cell) in at.iter().zip(&line.cells) {
                    let Some(cell) = cell else { continue };
                    rows.push(Measured {
                        subject,
                        extreme: format!("ζ = {}, {axis} = {at}", line.zeta),
                        quantity,
                        allowed: Some(cell.allowed),
                        measured: Some(cell.ours),
                        plain: [None, cell.plain],
                    });
                }
            }
        };
        let part = &self.part;
        cells(["free motion", "ωz, z′"], "ωt", &part::FREE_AT.map(|at| at.0), &part.free);
        cells(["half-sine", "ωz, z′ at its end"], "ωD", &part::PULSE_AT.map(|at| at.0), &part.pulse);
        cells(["record", "primary acceleration"], "f/fs", &part::RECORD_AT.map(|at| at.0), &part.record);
        rows.push(Measured {
            subject: "part in a clatter",
            extreme: format!("{} parts", part.parts),
            quantity: "peak",
            allowed: Some(part.clatters.allowed),
            measured: Some(part.clatters.ours),
            plain: [None, None],
        });
        rows.extend(self.residues.iter().map(|r| Measured {
            subject: "flight",
            extreme: r.compared.into(),
            quantity: "residue",
            allowed: Some(r.allowed),
            measured: Some(r.value),
            plain: [None, None],
        }));
        rows
    }

    /// Each allowance, and the extreme that comes nearest to it.
    fn allowances(&self) -> Vec<Value> {
        let told = |a: Allowance, worst: Option<(f64, String)>| {
            let (error, at) = worst.unwrap_or((f64::NAN, String::new()));
            json!({
                "quantity": a.quantity, "scale": a.scale, "range": a.range,
                "allowed": power(a.error), "measured": upper(error), "at": at,
            })
        };
        let larger = |a: (f64, String), b: (f64, String)| if b.0 > a.0 { b } else { a };
        let of_train = |a: Allowance| {
            let judged = self.trains.iter().flat_map(|row| row.ours.judged.iter().map(move |j| (row, j)));
            let errors = judged.filter(|(_, j)| j.allowed == Some(a));
            errors.filter_map(|(row, j)| Some((j.error?, row.case.name.to_owned()))).reduce(larger)
        };
        // What is allowed more at one extreme than at others is taken off.
        let of_part = |a: Allowance, axis: &str, at: &[&str], lines: &[part::Line]| {
            let cells = lines.iter().flat_map(|line| {
                line.cells.iter().zip(at).filter_map(move |(cell, at)| Some((line.zeta, cell.as_ref()?, at)))
            });
            let told = |(zeta, cell, at): (&str, &Cell, &&str)| {
                (cell.ours * a.error / cell.allowed, format!("ζ = {zeta}, {axis} = {at}"))
            };
            cells.map(told).reduce(larger)
        };
        let part = &self.part;
        let clatters = (part.clatters.ours, format!("{} parts", part.parts));
        TABLE
            .into_iter()
            .map(|a| told(a, of_train(a)))
            .chain([
                told(FREE, of_part(FREE, "ωt", &part::FREE_AT.map(|at| at.0), &part.free)),
                told(PULSE, of_part(PULSE, "ωD", &part::PULSE_AT.map(|at| at.0), &part.pulse)),
                told(TRAIN, Some(clatters)),
                told(RECORD, of_part(RECORD, "f/fₛ", &part::RECORD_AT.map(|at| at.0), &part.record)),
            ])
            .collect()
    }

    /// Every number that the page says.
    fn numbers(&self) -> Value {
        let allowances = self.allowances();
        let orders = self.orders.iter().map(|o| {
            let (last, difference) = o.steps.last().copied().unwrap_or((f64::NAN, f64::NAN));
            json!({
                "model": o.model, "limit": o.limit, "parameter": o.parameter, "compared": o.compared,
                "expected": decimals(o.expected, 0), "measured": decimals(o.measured(), 4),
                "at": power(last), "difference": power(difference),
            })
        });
        let residues = self
            .residues
            .iter()
            .map(|r| json!({ "compared": r.compared, "allowed": power(r.allowed), "measured": upper(r.value) }));
        let flights = self.flights.iter().map(|(model, flight)| {
            let strikes = flight.strikes.iter().take(STRIKES).map(|s| {
                let end = if s.end == clatter::End::A { "a" } else { "b" };
                json!([end, decimals(s.time_s / self.unit_s, 4)])
            });
            json!({ "model": model, "strikes": strikes.collect::<Vec<_>>() })
        });
        let trains = self.trains.iter().map(|row| {
            let ways = [("ours", &row.ours), ("recurrence", &row.recurrence), ("closed form", &row.closed)];
            let ways = ways.map(|(name, way)| {
                let cells = way.judged.iter().map(judged);
                let cells: Vec<_> = std::iter::once(counted(row.exact, way)).chain(cells).collect();
                json!({ "way": name, "cells": cells })
            });
            json!({
                "name": row.case.name, "at": inputs(&row.case), "start": start(&row.case),
                "count": count(row.exact), "ways": ways,
            })
        });
        let part = |lines: &[part::Line], at: &[&str]| {
            let lines = lines.iter().map(|line| {
                let cells = line.cells.iter().map(|cell| cell.as_ref().map(pair));
                json!({ "zeta": line.zeta, "cells": cells.collect::<Vec<_>>() })
            });
            json!({ "at": at, "lines": lines.collect::<Vec<_>>() })
        };
        let lines = self.lines.iter().map(|line| {
            json!({
                "what": line.what, "at": line.at, "formula": line.formula,
                "exact": written(&line.exact, &line.exact), "ours": written(&line.exact, &line.ours),
                "plain": written(&line.exact, &line.plain),
            })
        });
        let allowed = [PEAK, APPROACH, JUMP, TIME, FINAL, DURATION].map(|a| power(a.error));
        json!({
            "allowances": allowances,
            "orders": orders.collect::<Vec<_>>(),
            "residues": residues.collect::<Vec<_>>(),
            "flights": flights.collect::<Vec<_>>(),
            "contact": power(self.contact_s / self.unit_s),
            "allowed": allowed,
            "allowed_long": power(DURATION_LONG.error),
            "allowed_edge": power(NEAR_ENDLESS.error),
            "trains": trains.collect::<Vec<_>>(),
            "free": part(&self.part.free, &part::FREE_AT.map(|at| at.0)),
            "free_allowed": upper(FREE.error),
            "pulse": part(&self.part.pulse, &part::PULSE_AT.map(|at| at.0)),
            "pulse_allowed": power(PULSE.error),
            "record": part(&self.part.record, &part::RECORD_AT.map(|at| at.0)),
            "record_allowed": power(RECORD.error),
            "clatters": json!({
                "parts": self.part.parts, "allowed": power(self.part.clatters.allowed), "measured": upper(self.part.clatters.ours),
            }),
            "lines": lines.collect::<Vec<_>>(),
        })
    }
}

/// A count's error: 0 if it is right, infinite if it is of another kind.
fn miscount(exact: Found, found: Found) -> Option<f64> {
    match (exact, found) {
        (_, Found::Open) => None,
        #[expect(clippy::cast_precision_loss, reason = "its size is what is told")]
        (Found::Impacts(n), Found::Impacts(m)) => Some(n.abs_diff(m) as f64 / n as f64),
        (exact, found) => Some(if exact == found { 0.0 } else { f64::INFINITY }),
    }
}

/// The errors in full, one row each.
fn table(rows: &[Measured]) -> String {
    let head = ["subject", "extreme", "quantity", "allowed", "measured", "plain recurrence", "plain closed form"];
    let number = |v: Option<f64>| v.map_or(String::new(), |v| format!("{v:e}"));
    let line = |row: &Measured| {
        let [recurrence, closed] = row.plain.map(number);
        let words = [row.subject.to_owned(), row.extreme.clone(), row.quantity.to_owned()];
        words.into_iter().chain([number(row.allowed), number(row.measured), recurrence, closed]).collect()
    };
    csv(std::iter::once(head.map(String::from).to_vec()).chain(rows.iter().map(line)))
}

/// A number with one digit and its power of ten, rounded by `round`.
fn one_digit(value: f64, round: impl Fn(f64) -> f64) -> String {
    let mut exponent = value.abs().log10().floor();
    // Read back from its decimals, so that 1e−10 is 1 and not 1.000…1.
    let digit = |exponent: f64| format!("{:.6}", value / 10f64.powf(exponent)).parse::<f64>().map_or(0.0, &round);
    let mut first = digit(exponent);
    if first >= 10.0 {
        exponent += 1.0;
        first = 1.0;
    }
    if (-2.0..=2.0).contains(&exponent) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0, 1 or 2")]
        return format!("{:.*}", (-exponent).max(0.0) as usize, first * 10f64.powf(exponent));
    }
    let power = format!("10{}", raised(&exponent.to_string()));
    if (first - 1.0).abs() < 0.5 { power } else { format!("{first}·{power}") }
}

/// A number as one digit and a power of ten.
fn power(value: f64) -> String {
    one_digit(value, f64::round)
}

/// An error from above: `ε` for a rounding or less, else one digit that it stays below.
fn upper(error: f64) -> String {
    match error {
        x if !x.is_finite() => "∞".into(),
        x if x <= f64::EPSILON => "ε".into(),
        x => one_digit(x, f64::ceil),
    }
}

/// What an error looks like on the page: within what is allowed, or not; nothing promised.
fn state(allowed: Option<f64>, error: f64) -> &'static str {
    match allowed {
        None => "free",
        Some(allowed) if error <= allowed => "within",
        Some(_) => "beyond",
    }
}

fn judged(j: &Judged) -> Value {
    let Some(error) = j.error else { return Value::Null };
    let mark = match j.allowed {
        Some(DURATION_LONG) => "long",
        Some(NEAR_ENDLESS) => "edge",
        _ => "",
    };
    json!({ "shown": upper(error), "state": state(j.allowed.map(|a| a.error), error), "mark": mark })
}

fn counted(exact: Found, way: &Way) -> Value {
    match miscount(exact, way.found) {
        None => json!({ "shown": "open", "state": "free", "mark": "" }),
        Some(0.0) => json!({ "shown": "exact", "state": "within", "mark": "" }),
        Some(_) => json!({ "shown": count(way.found), "state": "beyond", "mark": "" }),
    }
}

fn count(found: Found) -> String {
    match found {
        #[expect(clippy::cast_precision_loss, reason = "three digits of it are shown")]
        Found::Impacts(n) if n >= 10_000_000_000 => {
            let text = format!("{:.2e}", n as f64);
            let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
            format!("{digits}·10{}", raised(exponent))
        }
        Found::Impacts(n) => n.to_string(),
        Found::Endless => "∞".into(),
        Found::Open => "open".into(),
        Found::Nothing => "NaN".into(),
    }
}

/// What is not pure translation from h0.
fn start(case: &train::Case) -> String {
    let [va, vb] = case.velocity;
    #[expect(clippy::float_cmp, reason = "the default, to the bit")]
    let plain = va == -1.0 && vb == -1.0;
    match (plain, case.gap) {
        (true, 0.0) => "h₀ = 0".into(),
        (true, _) => String::new(),
        _ => format!("v = [{}, {}]", decimals(va, 3), decimals(vb, 3)),
    }
}

fn pair(cell: &Cell) -> Value {
    let told = |error: f64| json!({ "shown": upper(error), "state": state(Some(cell.allowed), error) });
    json!({ "ours": told(cell.ours), "plain": cell.plain.map(told) })
}

/// Digits that are shown of a number.
const DIGITS: u32 = 16;

/// A value as its digits: those that it shares with the exact one, the others, the power of ten.
fn written(exact: &digits::Value, value: &digits::Value) -> Value {
    let digits = |value: &digits::Value| match value {
        digits::Value::Number(x) => Ok(number(x)),
        digits::Value::Count(n) => Ok((n.to_string(), String::new())),
        digits::Value::Word(word) => Err(*word),
    };
    match (digits(exact), digits(value)) {
        (Ok((want, scale)), Ok((got, other))) => {
            let same = scale == other && want.len() == got.len();
            let shared = want.chars().zip(got.chars()).take_while(|(a, b)| same && a == b).count();
            let (good, bad): (String, String) =
                (got.chars().take(shared).collect(), got.chars().skip(shared).collect());
            json!({ "good": good, "bad": bad, "power": other })
        }
        (_, Ok((got, power))) => json!({ "good": "", "bad": got, "power": power }),
        (Err(want), Err(got)) if want == got => json!({ "good": got, "bad": "", "power": "" }),
        (_, Err(got)) => json!({ "good": "", "bad": got, "power": "" }),
    }
}

/// Sign and digits with a point after the first, and the power of ten if it is not 0.
fn number(x: &Big) -> (String, String) {
    let (digits, power) = x.decimal(DIGITS);
    let (first, rest) = digits.split_at(1);
    let sign = if x.is_negative() { "−" } else { "" };
    let power = if power == 0 { String::new() } else { format!("·10{}", raised(&power.to_string())) };
    (format!("{sign}{first}.{rest}"), power)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_error_is_within_what_is_allowed() {
        let rows = measured().unwrap();
        assert!(rows.len() > 200, "{} rows", rows.len());
        for row in &rows {
            if let (Some(allowed), Some(error)) = (row.allowed, row.measured) {
                assert!(error <= allowed, "{row:?}");
            }
        }
    }

    #[test]
    fn errors_are_told_from_above() {
        let told = [0.0, 2.2e-16, 3.1e-16, 1e-10, 9.5e-13, 0.031, 0.95, 3.2, 4567.0, f64::NAN].map(upper);
        assert_eq!(told, ["ε", "ε", "4·10⁻¹⁶", "10⁻¹⁰", "10⁻¹²", "0.04", "1", "4", "5·10³", "∞"]);
    }

    #[test]
    fn figures_stay_within_their_frame() {
        let files = Data::compute().unwrap().files().unwrap();
        crate::paper::tests::stay_within_their_frame(&files);
    }
}
