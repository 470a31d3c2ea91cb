//! The paper's table, claims, curves and page.

#![allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")]

mod common;

use std::fmt::Write as _;

use clatter::{Axis, Map, Quantity};
use clatter_studies::contour::{self, SafeZone};
use clatter_studies::paper::{Kind, claims, table1};
use common::{digits, golden, page};

#[test]
fn table_1() {
    let mut text = String::new();
    for row in table1().unwrap() {
        let _ = writeln!(text, "{:?}", row.kind);
        for cell in row.cells {
            let _ = writeln!(text, "  {:>6}  {:<12} {:?}", cell.printed, digits(cell.value, 11), cell.agreement);
        }
    }
    golden("table-1", &text);
}

#[test]
fn the_claims() {
    let mut text = String::new();
    for claim in claims().unwrap() {
        let _ = writeln!(text, "{:?}  {}: {}", claim.verdict, claim.place, claim.statement);
        for m in claim.measured {
            let value = if m.kind == Kind::Count { format!("{:.0}", m.value) } else { digits(m.value, 6) };
            let _ = writeln!(text, "    {value:<10} {}", m.what);
        }
    }
    golden("claims", &text);
}

#[test]
fn the_curves_between_counts() {
    let mut text = String::from("curve      q            e\n");
    for n in [2, 3, 4, 10, 100] {
        for point in contour::impacts(n, 4) {
            let _ = writeln!(text, "{n:<6} {:<12.10} {:.10}", point.q, point.e);
        }
    }
    for point in contour::endless(4) {
        let _ = writeln!(text, "endls  {:<12.10} {:.10}", point.q, point.e);
    }
    golden("curves-of-impacts", &text);
}

#[test]
fn the_levels_of_the_safe_zones() {
    let levels = [(0.5, 0.0), (0.5, 0.1), (1.0, 0.0), (1.0, 0.2), (1.0, 0.5), (2.0, 0.5), (2.0, 1.0)];
    let mut text = String::from("e where s = level; - where no e has it\nq     ");
    for (threshold, level) in levels {
        let _ = write!(text, " {:<12}", format!("s({threshold})={level}"));
    }
    for i in 0..=10u8 {
        let q = f64::from(i) / 10.0;
        let _ = write!(text, "\n{q:<6}");
        for (threshold, level) in levels {
            let e = SafeZone::new(threshold).restitution(level, q);
            let _ = write!(text, " {:<12}", e.map_or("-".into(), |e| format!("{e:.10}")));
        }
    }
    golden("levels-of-safe-zones", &text);
}

#[test]
fn coarse_maps() {
    let mut text = String::new();
    for quantity in [Quantity::Impacts, Quantity::PeakEnd, Quantity::Duration, Quantity::NetCenter, Quantity::Zone(1.0)]
    {
        let map = Map::compute(quantity, Axis::q(-0.5, 1.0, 7).unwrap(), Axis::e(0.0, 1.0, 6).unwrap()).unwrap();
        let _ = writeln!(text, "{quantity:?}: q down from -0.5 to 1, e across from 0 to 1");
        for line in map.values.chunks(6) {
            let cells: Vec<_> = line.iter().map(|v| format!("{:<11}", digits(*v, 9))).collect();
            let _ = writeln!(text, "  {}", cells.join(" ").trim_end());
        }
    }
    golden("coarse-maps", &text);
}

/// Checks that the text of the page is where a reader or a screen reader looks for it.
#[test]
fn the_page() {
    let openings = ["Of its ", "Fig. 2 ", "Fig. 5 ", "Fig. 6 ", "Fig. 7 "];
    if let Some(text) = page(clatter_studies::Report::Paper, &openings) {
        golden("page", &text);
    }
}
