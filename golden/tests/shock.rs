//! The response of suspended parts to a clatter: rule, gains, zones, pulses and the page.

#![allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")]

mod common;
#[path = "common/rows.rs"]
mod rows;

use std::fmt::Write as _;

use clatter::Bar;
use clatter::design::DESIGNS;
use clatter_shock::{DampingRatio, Shape};
use clatter_studies::suspended::{GainMap, Holders, ShapeFigures, SuspendedZones, rule_either_end, worst};
use common::{digits, golden, page};
use rows::rows;
use serde_json::Value;

fn bar([q, e]: [f64; 2]) -> Bar {
    Bar::new(q, e).expect("q and e in range")
}

fn damping(zeta: f64) -> DampingRatio {
    DampingRatio::new(zeta).expect("a damping ratio")
}

#[test]
fn the_rule() {
    let omegas = [1e-2, 1.0, 3.0, 10.0, 42.0, 1e3];
    let mut text = String::from("peak |A|/(omega v0) over Omega, whichever end strikes first\n");
    let _ =
        writeln!(text, "zeta  q     e     s    soft        {}  stiff", omegas.map(|w| format!("{w:<11}")).join(" "));
    for zeta in [0.0, 0.05, 1.0] {
        for design in DESIGNS {
            for distance in [1.0, 0.5, 0.0] {
                let rule = rule_either_end(&bar(design), distance, damping(zeta), &omegas).unwrap();
                let points: Vec<_> = rule.points.iter().map(|p| format!("{:<11}", digits(p.acceleration, 9))).collect();
                let [q, e] = design;
                let soft = digits(rule.soft.acceleration, 9);
                let stiff = rule.stiff.map_or("none".into(), |stiff| digits(stiff.acceleration, 9));
                let _ =
                    writeln!(text, "{zeta:<5} {q:<5} {e:<5} {distance:<4} {soft:<11} {}  {stiff}", points.join(" "));
            }
        }
    }
    golden("shock-rule", &text);
}

#[test]
fn the_worst_parts() {
    let mut text = String::from("q     e     acceleration  over 2 v0  over (1+e) v0  at Omega\n");
    for design in DESIGNS {
        let w = worst(&bar(design), damping(0.05), 60).unwrap();
        let ([q, e], d) = (design, |x| digits(x, 6));
        let _ = writeln!(
            text,
            "{q:<5} {e:<5} {:<13} {:<10} {:<14} {}",
            d(w.acceleration),
            d(w.gain),
            d(w.gain_over_flat),
            digits(w.omega, 5)
        );
    }
    let map = GainMap::compute(damping(0.05), 8, 10).unwrap();
    let _ = writeln!(text, "\ngain over 2 v0, q upward, e to the right; above 1: {}", digits(map.share_above_1, 6));
    for row in map.gain.chunks(map.cells).rev() {
        let cells: Vec<_> = row.iter().map(|g| format!("{:<7}", digits(*g, 5))).collect();
        let _ = writeln!(text, "{}", cells.join(" ").trim_end());
    }
    golden("shock-worst", &text);
}

#[test]
fn the_impact_that_holds_the_peak() {
    let mut text = String::new();
    for design in DESIGNS {
        let map = Holders::compute(&bar(design), damping(0.05), 3, 9).unwrap();
        let [q, e] = design;
        let _ = writeln!(text, "q = {q}, e = {e}: {} impacts; Omega to the right, position upward", map.impacts);
        for row in map.impact.chunks(map.omegas.len()).rev() {
            let cells: Vec<_> = row.iter().map(|n| format!("{n:>3}")).collect();
            let _ = writeln!(text, "{}", cells.concat());
        }
    }
    golden("shock-impact-of-peak", &text);
}

#[test]
fn the_zones_of_suspended_parts() {
    let mut text = String::from("q     e     threshold  paper     smallest  at Omega  unsafe    zones\n");
    for design in DESIGNS {
        for threshold in [0.5, 1.0, 2.0] {
            let zones = SuspendedZones::compute(&bar(design), threshold, damping(0.05), 1).unwrap();
            let [q, e] = design;
            let s = |zone: Option<f64>| zone.map_or("none".into(), |s| digits(s, 6));
            let (least, omega) = zones.smallest;
            let list: Vec<_> = zones.zones.iter().map(|zone| s(*zone)).collect();
            let _ = writeln!(
                text,
                "{q:<5} {e:<5} {threshold:<10} {:<9} {:<9} {:<9} {:<9} {}",
                s(zones.paper),
                s(least),
                digits(omega, 5),
                digits(zones.share_unsafe, 5),
                list.join(" ")
            );
        }
    }
    golden("shock-zones", &text);
}

#[test]
fn the_pulse_shapes() {
    let shapes = [
        Shape::HalfSine,
        Shape::Haversine,
        Shape::Triangle,
        Shape::InitialPeakSawtooth,
        Shape::TerminalPeakSawtooth,
        Shape::Rectangle,
        Shape::Trapezoid { ramp: 0.1 },
    ];
    let mut text = String::from("zeta  amplification  at fD     knee         shape\n");
    for zeta in [0.0, 0.05, 0.5] {
        for shape in shapes {
            let f = ShapeFigures::new(shape, damping(zeta)).unwrap();
            // The top is flat: its place is known to half the digits of its height.
            let (top, at, knee) = (digits(f.amplification, 10), digits(f.frequency_duration, 6), digits(f.knee, 6));
            let _ = writeln!(text, "{zeta:<5} {top:<14} {at:<9} {knee:<12} {shape:?}");
        }
    }
    golden("shock-shapes", &text);
}

fn numbers() -> Value {
    let json = clatter_studies::shock_numbers().expect("the numbers of the page");
    serde_json::from_str(&json).expect("JSON")
}

/// Checks every number of the page, as it is printed, except those of the equivalent pulse.
#[test]
fn the_numbers_of_the_page() {
    let (mut numbers, mut text) = (numbers(), String::new());
    numbers["phone"]["equivalent"].take();
    rows("", &numbers, &mut text);
    golden("shock-numbers", &text);
}

/// The half-sine of a shock table that the page gives; null if there is none.
#[test]
fn the_equivalent_pulse() {
    golden("shock-equivalent", &numbers()["phone"]["equivalent"].to_string());
}

/// Checks the text of the page besides its numbers: headings, alternative texts and the beginnings of its parts.
#[test]
fn the_page() {
    let openings = ["What follows, in short", "Fig. 1 ", "Fig. 3 ", "Fig. 7 ", "Fig. 10 ", "Fig. 12 "];
    let Some(text) = page(clatter_studies::Report::Shock, &openings) else { return };
    golden("shock-page", &text);
}
