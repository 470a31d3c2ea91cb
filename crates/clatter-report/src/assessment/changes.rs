//! What would make a failing part safe: each change alone, the two that do it together, or how near two come.

use clatter_assess::design::{Change, Lever, Outcome, Remedies, Together};
use clatter_assess::{Component, ComponentAssessment, LimitKind, Product, Verdict};
use serde_json::{Value, json};

use crate::words::percent;

/// A number to four digits, as changes are assessed with it.
fn four(x: f64) -> String {
    format!("{x:.3e}").parse().unwrap_or(x).to_string().replace('-', "−")
}

fn what(lever: Lever) -> &'static str {
    match lever {
        Lever::InertiaRatio => "radius of gyration",
        Lever::Restitution => "restitution",
        Lever::Position => "place of its middle",
        Lever::Frequency => "natural frequency",
        Lever::Damping => "damping ratio",
        Lever::ContactTime => "contact time",
        Lever::Limit(LimitKind::Acceleration) => "acceleration limit",
        Lever::Limit(LimitKind::RattleSpace) => "rattle space",
        Lever::Limit(LimitKind::VelocityChange) => "velocity change limit",
        Lever::Limit(LimitKind::AngularVelocityChange) => "angular velocity change limit",
        Lever::Limit(LimitKind::DamageBoundary) => "critical velocity change",
    }
}

/// The product and the part that is changed.
#[derive(Clone, Copy)]
pub(super) struct Of<'a> {
    pub(super) product: &'a Product,
    pub(super) component: &'a Component,
}

impl Of<'_> {
    /// A value, low and high end, in the unit of the file; of an inertia ratio the radius of gyration that has it.
    fn value(&self, lever: Lever, of: [f64; 2]) -> String {
        let (mut numbers, name) = if lever == Lever::InertiaRatio {
            (of.map(|q| self.gyration_mm(q)), " mm".to_owned())
        } else {
            let unit = lever.written_in(self.product, self.component);
            let name = unit.map_or(lever.unit(), |unit| unit.name);
            let space = if name.is_empty() { "" } else { " " };
            (of.map(|x| unit.map_or(x, |unit| unit.of_si(x))), format!("{space}{name}"))
        };
        numbers.sort_by(f64::total_cmp);
        let [lo, hi] = numbers.map(four);
        if lo == hi { format!("{lo}{name}") } else { format!("{lo} to {hi}{name}") }
    }

    fn gyration_mm(&self, q: f64) -> f64 {
        self.product.with_inertia_ratio(q).map_or(f64::NAN, |product| 1e3 * product.body.gyration_m())
    }

    fn row(&self, change: &Change, margin: &str) -> Value {
        let of = |values| self.value(change.lever, values);
        json!({ "what": what(change.lever), "from": of(change.from), "to": of(change.to), "margin": margin })
    }

    /// Changes in one row each; the margin they leave together stands at the last.
    fn rows(&self, together: &Together) -> Vec<Value> {
        let last = together.changes.len().saturating_sub(1);
        let margin = left(&together.after);
        let each = together.changes.iter().enumerate();
        each.map(|(k, change)| self.row(change, if k == last { &margin } else { "" })).collect()
    }
}

/// The margin that is left, and the verdict where it is not safe.
fn left(after: &ComponentAssessment) -> String {
    let margin = percent(after.tightest().room());
    match after.verdict {
        Verdict::Safe => margin,
        verdict => format!("{margin}, {}", verdict.name()),
    }
}

/// What the page says: how the changes count, the changes, and what is not enough alone.
pub(super) fn changes(of: Of<'_>, remedies: &Remedies) -> Value {
    let (mut enough, mut not) = (Vec::new(), Vec::new());
    for remedy in &remedies.levers {
        match &remedy.outcome {
            Outcome::Change { change, after } => enough.push(of.row(change, &left(after))),
            Outcome::Nowhere { bounds } => {
                not.push(format!("{} (from {})", what(remedy.lever), of.value(remedy.lever, *bounds)));
            }
            Outcome::NoEffect | Outcome::Stopped => {}
        }
    }
    let alone = !enough.is_empty();
    let (say, rows) = match (&remedies.pair, &remedies.nearest) {
        _ if enough.len() == 1 => ("This change alone makes it safe with a margin of 10 %.", enough),
        _ if enough.len() > 1 => ("Any one of these changes alone makes it safe with a margin of 10 %.", enough),
        (Some(pair), _) => ("These two changes together make it safe with a margin of 10 %.", of.rows(pair)),
        (_, Some(near)) if near.changes.len() > 1 => (
            "No one or two changes were found that make it safe with a margin of 10 %. These two come nearest.",
            of.rows(near),
        ),
        (_, Some(near)) => (
            "No one or two changes were found that make it safe with a margin of 10 %. This one comes nearest.",
            of.rows(near),
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

    #[test]
    fn values_have_the_digits_and_units_that_they_were_assessed_with() {
        let file = ProductFile::read(clatter_assess::EXAMPLE, "example.toml").unwrap();
        let of = Of { product: &file.product, component: &file.components[1] };
        let told = |lever, values| of.value(lever, values);
        assert_eq!(told(Lever::Frequency, [130.0, 160.0]), "130 to 160 Hz");
        assert_eq!(told(Lever::Position, [-1e-3 * 20.0; 2]), "−20 mm");
        assert_eq!(told(Lever::Damping, [0.05; 2]), "0.05");
        assert_eq!(told(Lever::ContactTime, [0.8e-3; 2]), "0.8 ms");
        assert_eq!(told(Lever::Limit(LimitKind::Acceleration), [1200.0 * 9.806_65; 2]), "1200 gn");
        // ρ = 38 mm, L = 70 mm: (4900 − 1444)/(4900 + 1444)
        assert_eq!(told(Lever::InertiaRatio, [3456.0 / 6344.0; 2]), "38 mm");
    }
}
