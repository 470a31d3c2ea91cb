//! Effects of a plate beyond a bar: claims, numbers and the page.

#![allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")]

mod common;
#[path = "common/rows.rs"]
mod rows;

use std::fmt::Write as _;

use clatter_studies::paper::Kind;
use clatter_studies::{Report, plate_claims, plate_numbers};
use common::{digits, golden, page};
use rows::rows;

#[test]
fn the_claims() {
    let mut text = String::new();
    for claim in plate_claims().unwrap() {
        let _ = writeln!(text, "{:?}  {}: {}", claim.verdict, claim.place, claim.statement);
        for m in claim.measured {
            let value = if m.kind == Kind::Count { format!("{:.0}", m.value) } else { digits(m.value, 6) };
            let _ = writeln!(text, "    {value:<10} {}", m.what);
        }
    }
    golden("plate-claims", &text);
}

/// Checks every number of the page, as it is printed.
#[test]
fn the_numbers_of_the_page() {
    let (json, mut text) = (plate_numbers().expect("the numbers of the page"), String::new());
    rows("", &serde_json::from_str(&json).expect("JSON"), &mut text);
    golden("plate-numbers", &text);
}

/// Checks the text of the page besides its numbers: headings, alternative texts and the beginnings of its parts.
#[test]
fn the_page() {
    let openings =
        ["Two bars may stand", "Of the paper", "Fig. 2 ", "Fig. 4 ", "Fig. 5 ", "Fig. 8 ", "The worst case of"];
    let Some(text) = page(Report::Plate, &openings) else { return };
    golden("plate-page", &text);
}
