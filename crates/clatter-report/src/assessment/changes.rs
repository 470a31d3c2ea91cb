//! What would make a failing part safe: each change alone.

use clatter_assess::design::{Change, Lever};
use clatter_assess::{Changes, Component, Product};
use serde_json::{Value, json};

/// A number to four digits: changes have fewer.
fn four(x: f64) -> String {
    format!("{x:.3e}").parse().unwrap_or(x).to_string().replace('-', "−")
}

fn what(lever: Lever) -> &'static str {
    match lever {
        Lever::InertiaRatio => "radius of gyration",
        Lever::Restitution => "restitution",
        Lever::Position => "place of its middle",
        Lever::Across => "place of its middle across",
        Lever::Frequency => "natural frequency",
        Lever::Damping => "damping ratio",
        Lever::ContactTime => "contact time",
        Lever::Limit(kind) => kind.allowed(),
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
            let name = unit.map_or(lever.unit(), |unit| if unit.name == "gn" { "g" } else { unit.name });
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

    fn row(&self, change: &Change) -> Value {
        let of = |values| self.value(change.lever, values);
        json!({ "what": what(change.lever), "from": of(change.from), "to": of(change.to) })
    }
}

/// What the page says: how the changes count, the changes, and what is not enough alone.
pub(super) fn changes(of: Of<'_>, changes: &Changes) -> Value {
    let rows: Vec<Value> = changes.enough.iter().map(|change| of.row(change)).collect();
    let say = match rows.len() {
        0 => "By the drops of the figures no single change leaves a margin of 10 %.",
        1 => "By the drops of the figures this change alone leaves a margin of 10 %.",
        _ => "By the drops of the figures any one of these changes alone leaves a margin of 10 %.",
    };
    let one = |(lever, bounds): &(Lever, [f64; 2])| format!("{} (from {})", what(*lever), of.value(*lever, *bounds));
    let not: Vec<String> = changes.not.iter().map(one).collect();
    let not = if not.is_empty() { String::new() } else { format!("Tried without success: {}.", not.join("; ")) };
    json!({ "say": say, "rows": rows, "not": not })
}

#[cfg(test)]
mod tests {
    use super::*;
    use clatter_assess::{LimitKind, ProductFile};

    #[test]
    fn values_have_the_digits_and_units_of_the_file() {
        let file = ProductFile::read(include_str!("../../../../tests/cases/bar-handheld.toml"), "bar.toml").unwrap();
        let of = Of { product: &file.product, component: &file.components[1] };
        let told = |lever, values| of.value(lever, values);
        assert_eq!(told(Lever::Frequency, [130.0, 160.0]), "130 to 160 Hz");
        assert_eq!(told(Lever::Position, [-1e-3 * 20.0; 2]), "−20 mm");
        assert_eq!(told(Lever::Damping, [0.05; 2]), "0.05");
        assert_eq!(told(Lever::ContactTime, [0.8e-3; 2]), "0.8 ms");
        assert_eq!(told(Lever::Limit(LimitKind::Acceleration), [1200.0 * 9.806_65; 2]), "1200 g");
        // ρ = 38 mm, L = 70 mm: (4900 − 1444)/(4900 + 1444)
        assert_eq!(told(Lever::InertiaRatio, [3456.0 / 6344.0; 2]), "38 mm");
    }
}
