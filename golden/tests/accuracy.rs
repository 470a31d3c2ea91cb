//! Accuracy of the results: orders, errors at every extreme, the page. Only sizes of errors are compared, never times.

#![allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")]

mod common;

use std::fmt::Write as _;

use clatter_studies::orders;
use common::{digits, golden, page};

/// Returns the power of ten that bounds an error; an error that is only rounding is marked as such.
fn size(error: Option<f64>) -> String {
    match error {
        None => "-".into(),
        Some(x) if !x.is_finite() => "fails".into(),
        Some(0.0) => "exact".into(),
        Some(x) if x <= 1e-12 => "rounding".into(),
        Some(x) => format!("<1e{}", x.log10().ceil() + 0.0),
    }
}

/// Returns the size of an error of this crate; one that is 0 by luck counts as rounding.
fn ours(quantity: &str, error: Option<f64>) -> String {
    let size = size(error);
    if quantity != "count" && size == "exact" { "rounding".into() } else { size }
}

#[test]
fn the_orders() {
    let mut text = String::new();
    for order in orders().unwrap() {
        let _ = writeln!(text, "{} to {}, {}: {}", order.model, order.limit, order.parameter, order.compared);
        // Contacts are computed to a precision of their own.
        let known = if order.model == "compliant" { 2 } else { 4 };
        let _ = writeln!(text, "  order {} of {}", digits(order.measured(), known), order.expected);
        let known = if order.model == "compliant" { 2 } else { 5 };
        for (parameter, difference) in order.steps {
            let _ = writeln!(text, "  {:<10} {}", digits(parameter, 3), digits(difference, known));
        }
    }
    golden("accuracy-orders", &text);
}

#[test]
fn the_errors() {
    let mut text = String::from("allowed  ours      recurrence  plain       quantity at extreme\n");
    for row in clatter_studies::measured().unwrap() {
        let allowed = row.allowed.map_or("-".into(), |allowed| format!("{allowed:.0e}"));
        let [recurrence, plain] = row.plain.map(|error| ours(row.quantity, error));
        let ours = ours(row.quantity, row.measured);
        let _ = writeln!(
            text,
            "{allowed:<8} {ours:<9} {recurrence:<11} {plain:<11} {} of {}, {}",
            row.quantity, row.subject, row.extreme
        );
    }
    golden("accuracy-errors", &text);
}

/// Checks every number of the section on measured tosses, as it is printed.
#[test]
fn the_tosses() {
    golden("accuracy-tosses", &clatter_studies::cube::numbers().expect("the numbers of the section"));
}

/// Checks every number of the section on friction, as it is printed.
#[test]
fn the_friction() {
    golden("accuracy-friction", &clatter_studies::friction::numbers().expect("the numbers of the section"));
}

#[test]
fn the_page() {
    let openings = [
        "An error is ",
        "Table 1 ",
        "Table 2 ",
        "Table 5 ",
        "Fig. 1 ",
        "Table 10 ",
        "Table 11 ",
        "Fig. 2 ",
        "The next touch.",
        "Below 10°",
        "Table 17 ",
        "Fig. 5 ",
    ];
    if let Some(text) = page(clatter_studies::Report::Accuracy, &openings) {
        golden("accuracy-page", &text);
    }
}
