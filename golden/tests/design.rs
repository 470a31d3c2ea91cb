//! The paper's design example, and the designs for a product.

#![cfg(test)]
#![allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")]

use std::fmt::Write as _;

use clatter::design::{Goal, front, region};
use clatter_assess::{
    Verdict,
    design::{Bounds, Outcome, Together},
};
use clatter_product::ProductFile;

const LAPTOP: &str = include_str!("laptop.toml");

fn golden(name: &str, text: &str) {
    insta::with_settings!(
        { snapshot_path => "../snapshots", prepend_module_to_snapshot => false, omit_expression => true },
        { insta::assert_snapshot!(name, text) }
    );
}

/// v0/2 in the middle tenth of the bar, 2 v0 in 85 % of it: the border of the designs that meet both, and the fronts.
#[test]
fn the_paper_s_example() {
    let (near, far) = (Goal::zone(0.5, 0.1).unwrap(), Goal::zone(2.0, 0.85).unwrap());
    let mut text = String::from("border of the region\n  q        e\n");
    for piece in region(&[near, far], 1e-2) {
        for p in piece {
            let _ = writeln!(text, "  {:.5}  {:.5}", p.q, p.e);
        }
    }
    text.push_str("\nfronts of the zone within v0/2, 2 v0 within 85 %\n  e     first q  first s    last q   last s\n");
    for e in [0.0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3] {
        for piece in front(0.5, &[far], e, 200).unwrap().pieces {
            let (a, b) = (piece[0], piece[piece.len() - 1]);
            let s = a.s.max(0.0); // 0 to a rounding
            let _ = writeln!(text, "  {e:.2}  {:.5}  {s:.5}    {:.5}  {:.5}", a.q, b.q, b.s);
        }
    }
    golden("design-of-the-paper", &text);
}

/// The least margin that changes must leave.
const MARGIN: f64 = 0.1;

fn together(text: &mut String, name: &str, found: &Together) {
    let _ = writeln!(text, "  {name}: margin {:+.2}, {}", found.after.tightest().room(), found.after.verdict.name());
    for change in &found.changes {
        let _ = writeln!(text, "    {:<21} {:.3?} -> {:.3?}", change.lever.name(), change.from, change.to);
    }
}

#[test]
fn changes_that_make_a_laptop_safe() {
    let file = ProductFile::read(LAPTOP, "laptop.toml").unwrap();
    let assessment = clatter_assess::assess(&file).unwrap();
    let mut text = String::new();
    for part in clatter_assess::remedies(&file, &assessment, &Bounds::default(), MARGIN).unwrap() {
        let found = &assessment.components[part.component];
        let _ = writeln!(text, "{}: {}", found.name, found.verdict.name());
        for remedy in &part.levers {
            let said = match &remedy.outcome {
                Outcome::Change { change, after } => {
                    assert_eq!(after.verdict, Verdict::Safe, "assessed again");
                    assert!(after.tightest().room() >= MARGIN, "{after:?}");
                    format!("{:.3?} -> {:.3?}", change.from, change.to)
                }
                Outcome::Nowhere { bounds } => format!("nowhere in {bounds:.3?}"),
                Outcome::NoEffect => "no effect".to_owned(),
                Outcome::Stopped => "stopped".to_owned(),
            };
            let _ = writeln!(text, "  {:<21} {said}", remedy.lever.name());
        }
        if let Some(pair) = &part.pair {
            together(&mut text, "together", pair);
        }
        if let Some(nearest) = &part.nearest {
            together(&mut text, "nearest", nearest);
        }
    }
    golden("design-of-a-laptop", &text);
}
