//! The verdicts on the worked products.

#![allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")]

use std::fmt::Write as _;

use clatter_assess::LimitAssessment;
use clatter_product::ProductFile;

const EXAMPLES: [&str; 4] = [
    include_str!("../../reports/examples/phone.toml"),
    include_str!("../../reports/examples/handheld-terminal.toml"),
    include_str!("../../reports/examples/laptop.toml"),
    include_str!("../../reports/examples/tablet.toml"),
];

/// Returns a value with three digits, if there is one.
fn three(name: &str, value: Option<f64>) -> String {
    value.map_or(String::new(), |value| format!("; {name} {value:.2e}"))
}

/// Returns a limit with three digits, more than the accuracy of any drop: the search resolves no more.
fn line(limit: &LimitAssessment) -> String {
    let beside = [("flat", limit.clatter_free), ("bound", limit.bound), ("other law", limit.other_law)];
    format!(
        "    {:<24} {:<9} allowed {:.2e}, demand {:.2e} {:<6} margin {:+.2}, within {:.2}; {} {}{}",
        limit.limit.name(),
        limit.verdict.name(),
        limit.allowed,
        limit.demand.expect("an answer"),
        limit.unit.name(),
        limit.margin.expect("an answer"),
        limit.uncertainty,
        limit.model.bar.name(),
        limit.model.component,
        beside.map(|(name, value)| three(name, value)).concat(),
    )
}

#[test]
fn the_worked_products() {
    let mut text = String::new();
    for example in EXAMPLES {
        let assessment = clatter_assess::assess(&ProductFile::read(example, "example").unwrap()).unwrap();
        let _ = writeln!(text, "{}: {}", assessment.product, assessment.verdict.name());
        for component in &assessment.components {
            let _ = writeln!(text, "  {}: {}", component.name, component.verdict.name());
            for limit in &component.limits {
                let _ = writeln!(text, "{}", line(limit));
                if let Some(why) = limit.why_undecided() {
                    let _ = writeln!(text, "      {why}");
                }
            }
        }
    }
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("../snapshots");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| insta::assert_snapshot!("verdicts", text));
}
