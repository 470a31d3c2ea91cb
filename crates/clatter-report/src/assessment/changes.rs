//! What would make a failing part safe: each change alone, the two that do it together, or how near two come.

use clatter_assess::design::{Change, Lever, Outcome, Remedies, Together};
use clatter_assess::{ComponentAssessment, Product, Verdict};
use serde_json::{Value, json};

use crate::words::percent;

/// A number to four digits, as changes are assessed with it.
fn four(x: f64) -> String {
    format!("{x:.3e}").parse().unwrap_or(x).to_string().replace('-', "−")
}

fn what(lever: Lever) -> &'static str {
    match lever {
        Lever::InertiaRatio => "inertia ratio",
        Lever::Restitution => "restitution",
        Lever::Position => "place of its middle",
        Lever::Frequency => "natural frequency",
        Lever::Damping => "damping ratio",
    }
}

/// A value, low and high end. An inertia ratio comes with the radius of gyration that has it.
fn value(product: &Product, lever: Lever, of: [f64; 2]) -> String {
    let text = plain(lever, of);
    match product.with_inertia_ratio(of[0]) {
        Ok(other) if lever == Lever::InertiaRatio => {
            format!("{text} (radius of gyration {} mm)", four(1e3 * other.body.gyration_m()))
        }
        _ => text,
    }
}

fn plain(lever: Lever, of: [f64; 2]) -> String {
    let (size, unit) = match lever {
        Lever::Position => (1e3, " mm"),
        Lever::Frequency => (1.0, " Hz"),
        Lever::InertiaRatio | Lever::Restitution | Lever::Damping => (1.0, ""),
    };
    let [lo, hi] = of.map(|v| four(size * v));
    if lo == hi { format!("{lo}{unit}") } else { format!("{lo} to {hi}{unit}") }
}

fn row(product: &Product, change: &Change, margin: &str) -> Value {
    let of = |values| value(product, change.lever, values);
    json!({ "what": what(change.lever), "from": of(change.from), "to": of(change.to), "margin": margin })
}

/// The margin that is left, and the verdict where it is not safe.
fn left(after: &ComponentAssessment) -> String {
    let margin = percent(after.tightest().room());
    match after.verdict {
        Verdict::Safe => margin,
        verdict => format!("{margin}, {}", verdict.name()),
    }
}

/// Changes in one row each; the margin they leave together stands at the last.
fn rows(product: &Product, together: &Together) -> Vec<Value> {
    let last = together.changes.len().saturating_sub(1);
    let margin = left(&together.after);
    let each = together.changes.iter().enumerate();
    each.map(|(k, change)| row(product, change, if k == last { &margin } else { "" })).collect()
}

/// What the page says: how the changes count, the changes, and what is not enough alone.
pub(super) fn changes(product: &Product, remedies: &Remedies) -> Value {
    let (mut enough, mut not) = (Vec::new(), Vec::new());
    for remedy in &remedies.levers {
        match &remedy.outcome {
            Outcome::Change { change, after } => enough.push(row(product, change, &left(after))),
            Outcome::Nowhere { bounds } => {
                not.push(format!("{} (from {})", what(remedy.lever), plain(remedy.lever, *bounds)));
            }
            Outcome::NoEffect => {}
        }
    }
    let alone = !enough.is_empty();
    let (say, rows) = match (&remedies.pair, &remedies.nearest) {
        _ if enough.len() == 1 => ("This change alone makes it safe with a margin of 10 %.", enough),
        _ if enough.len() > 1 => ("Any one of these changes alone makes it safe with a margin of 10 %.", enough),
        (Some(pair), _) => ("These two changes together make it safe with a margin of 10 %.", rows(product, pair)),
        (_, Some(near)) if near.changes.len() > 1 => (
            "No one or two changes were found that make it safe with a margin of 10 %. These two come nearest.",
            rows(product, near),
        ),
        (_, Some(near)) => (
            "No one or two changes were found that make it safe with a margin of 10 %. This one comes nearest.",
            rows(product, near),
        ),
        _ => ("No change was found that makes it safe with a margin of 10 %.", Vec::new()),
    };
    let intro = if alone || remedies.pair.is_some() { "Not enough alone" } else { "Tried" };
    let not = if not.is_empty() { String::new() } else { format!("{intro}: {}.", not.join("; ")) };
    json!({ "say": say, "rows": rows, "not": not })
}

#[cfg(test)]
mod tests {
    use super::*;
    use clatter_assess::ProductFile;

    fn product() -> Product {
        ProductFile::read(clatter_assess::EXAMPLE, "example.toml").unwrap().product
    }

    #[test]
    fn values_have_the_digits_that_they_were_assessed_with() {
        let product = product();
        let told = |lever, of| value(&product, lever, of);
        assert_eq!(told(Lever::Frequency, [131.2, 157.4]), "131.2 to 157.4 Hz");
        assert_eq!(told(Lever::Position, [-1e-3 * 20.17; 2]), "−20.17 mm");
        assert_eq!(told(Lever::Damping, [0.05; 2]), "0.05");
        // ρ = 38 mm, L = 70 mm: (4900 − 1444)/(4900 + 1444)
        assert_eq!(told(Lever::InertiaRatio, [3456.0 / 6344.0; 2]), "0.5448 (radius of gyration 38 mm)");
    }
}
