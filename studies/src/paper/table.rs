//! Tables: the words and digits of Table 1 and of the claims, as JSON and CSV.

use clatter::design::DESIGNS;
use serde::Serialize;

use super::{Agreement, Claim, Kind, Measured, Row, RowKind, Verdict};
use crate::files::{csv, decimals};

/// Table 1 as data.
#[derive(Debug, Serialize)]
pub(crate) struct Table1 {
    designs: [[f64; 2]; 4],
    rows: Vec<TableRow>,
}

#[derive(Debug, Serialize)]
struct TableRow {
    quantity: String,
    unit: &'static str,
    cells: Vec<TableCell>,
}

#[derive(Debug, Serialize)]
struct TableCell {
    printed: &'static str,
    value: f64,
    shown: String,
    agreement: &'static str,
}

/// The claims as data.
#[derive(Debug, Serialize)]
pub(crate) struct Claims {
    claims: Vec<ClaimRow>,
}

#[derive(Debug, Serialize)]
struct ClaimRow {
    place: &'static str,
    statement: &'static str,
    measured: Vec<Figure>,
    verdict: &'static str,
    remark: &'static str,
}

#[derive(Debug, Serialize)]
struct Figure {
    what: &'static str,
    value: f64,
    error: f64,
    unit: &'static str,
    shown: String,
}

/// Returns the agreement as a word.
fn agreement(agreement: Agreement) -> &'static str {
    match agreement {
        Agreement::Rounded => "rounded",
        Agreement::Truncated => "truncated",
        Agreement::Clipped => "clipped",
        Agreement::Disagrees => "disagrees",
    }
}

/// Returns the verdict in words.
fn verdict(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Holds => "holds",
        Verdict::InPart => "holds in part",
        Verdict::Fails => "fails",
    }
}

/// Returns Table 1, with two decimals more than printed for per cent values and one more for the others.
pub(crate) fn table1(rows: &[Row]) -> Table1 {
    let row = |row: &Row| {
        let (quantity, unit, digits) = match row.kind {
            RowKind::SafeZone(x) => (format!("safe zone for shocks up to {x} v₀"), "%", 3),
            RowKind::PeakEnd => ("largest velocity shock at the ends".into(), "v₀", 6),
            RowKind::PeakAngular => ("largest change of angular velocity".into(), "v₀/L", 6),
            RowKind::NetCenter => ("net change of velocity at the center".into(), "v₀", 6),
            RowKind::Impacts => ("number of impacts".into(), "", 0),
        };
        let cells = row.cells.iter().map(|cell| TableCell {
            printed: cell.printed,
            value: cell.value,
            shown: decimals(cell.value, digits),
            agreement: agreement(cell.agreement),
        });
        TableRow { quantity, unit, cells: cells.collect() }
    };
    Table1 { designs: DESIGNS, rows: rows.iter().map(row).collect() }
}

/// Returns a measured figure as text: shares in per cent, rounding errors by their size.
fn shown(m: &Measured) -> String {
    match m.kind {
        Kind::Count => decimals(m.value, 0),
        Kind::Share => {
            let percent = 100.0 * m.value;
            let whole = (percent - percent.round()).abs() < 1e-9;
            format!("{}\u{a0}%", decimals(percent, if whole { 0 } else { 2 }))
        }
        Kind::Number if m.value != 0.0 && m.value.abs() < 1e-12 => "below 10⁻¹²".into(),
        Kind::Number => {
            let text = decimals(m.value, 4);
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        }
    }
}

/// Returns the claims.
pub(crate) fn claims(claims: &[Claim]) -> Claims {
    let figure = |m: &Measured| Figure {
        what: m.what,
        value: m.value,
        error: m.error,
        unit: match m.kind {
            Kind::Number => "number",
            Kind::Count => "count",
            Kind::Share => "share",
        },
        shown: shown(m),
    };
    let row = |c: &Claim| ClaimRow {
        place: c.place,
        statement: c.statement,
        measured: c.measured.iter().map(figure).collect(),
        verdict: verdict(c.verdict),
        remark: c.remark,
    };
    Claims { claims: claims.iter().map(row).collect() }
}

impl Table1 {
    /// Returns one row a cell.
    pub(crate) fn csv(&self) -> String {
        let head = ["quantity", "unit", "q", "e", "printed", "value", "agreement"].map(String::from).to_vec();
        let cells = self.rows.iter().flat_map(|row| {
            row.cells.iter().zip(&self.designs).map(|(cell, [q, e])| {
                let text = [row.quantity.clone(), row.unit.into(), q.to_string(), e.to_string()];
                let rest = [cell.printed.into(), cell.value.to_string(), cell.agreement.into()];
                text.into_iter().chain(rest).collect()
            })
        });
        csv(std::iter::once(head).chain(cells))
    }
}

impl Claims {
    /// Returns one row a measured figure.
    pub(crate) fn csv(&self) -> String {
        let head =
            ["place", "statement", "verdict", "remark", "what", "unit", "value", "error"].map(String::from).to_vec();
        let figures = self.claims.iter().flat_map(|c| {
            c.measured.iter().map(|m| {
                let claim = [c.place, c.statement, c.verdict, c.remark, m.what, m.unit].map(String::from);
                claim.into_iter().chain([m.value.to_string(), m.error.to_string()]).collect()
            })
        });
        csv(std::iter::once(head).chain(figures))
    }
}
