//! This module describes the changes that would make a part safe with a margin, as `clatter design` finds them.

use clatter_assess::{
    ComponentAssessment, Verdict,
    design::{Change, Lever, Outcome, Remedies, Remedy},
};
use clatter_product::{Component, ProductFile};
use serde_json::{Value, json};

use crate::words::percent;

/// Writes a number to four digits: changes have fewer.
fn four(x: f64) -> String {
    format!("{x:.3e}").parse().unwrap_or(x).to_string().replace('-', "−")
}

/// The product and the part that is changed.
#[derive(Clone, Copy)]
pub(super) struct Of<'a> {
    pub(super) file: &'a ProductFile,
    pub(super) component: &'a Component,
}

impl Of<'_> {
    /// Writes a value, low and high end, in the unit of the file; of an inertia ratio the radius of gyration that has it.
    fn value(&self, lever: Lever, of: [f64; 2]) -> String {
        let (mut numbers, name) = if lever == Lever::InertiaRatio {
            (of.map(|q| self.gyration_mm(q)), " mm".to_owned())
        } else {
            let unit = lever.written_in(&self.file.product, self.component);
            let name = unit.map_or(lever.unit(), |unit| unit.name);
            let space = if name.is_empty() { "" } else { " " };
            (of.map(|x| unit.map_or(x, |unit| unit.of_si(x))), format!("{space}{name}"))
        };
        numbers.sort_by(f64::total_cmp);
        let [lo, hi] = numbers.map(four);
        if lo == hi { format!("{lo}{name}") } else { format!("{lo} to {hi}{name}") }
    }

    fn gyration_mm(&self, q: f64) -> f64 {
        self.file.product.with_inertia_ratio(q).map_or(f64::NAN, |product| 1e3 * product.body.gyration_m())
    }

    fn row(&self, change: &Change) -> Value {
        let of = |values| self.value(change.lever, values);
        json!({ "what": change.lever.words(), "from": of(change.from), "to": of(change.to) })
    }
}

/// Returns the text about a part that is not safe with the margin: the changes that are enough alone, else the pair that is enough or that
/// comes nearest, and the changes that were tried.
pub(super) fn changes(of: Of<'_>, assessed: &ComponentAssessment, found: Option<&Remedies>) -> Value {
    let Some(found) = found else {
        let elsewhere = "Of a plate or a box this takes long to find: clatter design of the product file tells.";
        let failing = assessed.verdict != Verdict::Safe;
        return if failing { json!({ "say": elsewhere, "rows": [], "not": "" }) } else { Value::Null };
    };
    let outcome = |remedy: &Remedy| match &remedy.outcome {
        Outcome::Change { change, .. } => Some(*change),
        _ => None,
    };
    let mut changes: Vec<Change> = found.levers.iter().filter_map(outcome).collect();
    let together = found.pair.as_ref().or(found.nearest.as_ref());
    let say = match (changes.len(), together) {
        (0, None) => "No change is known to be enough.".to_owned(),
        (0, Some(together)) => {
            changes.clone_from(&together.changes);
            let margin = percent(clatter_assess::least_margin(of.file, &together.after));
            match (&found.pair, &changes[..]) {
                (Some(_), _) => {
                    format!("No single change is enough; these two together are, with a margin of {margin}.")
                }
                (None, [_]) => {
                    format!("Neither one change is enough nor two; this one comes nearest, with a margin of {margin}.")
                }
                (None, _) => format!(
                    "Neither one change is enough nor two; these two together come nearest, with a margin of {margin}."
                ),
            }
        }
        (1, _) => "This change alone is enough.".to_owned(),
        (_, _) => "Any one of these changes alone is enough.".to_owned(),
    };
    let (mut tried, mut stopped) = (Vec::new(), Vec::new());
    for Remedy { lever, outcome } in &found.levers {
        match outcome {
            Outcome::Nowhere { bounds } => {
                tried.push(format!("{} (from {})", lever.words(), of.value(*lever, *bounds)));
            }
            Outcome::Stopped => stopped.push(lever.words()),
            Outcome::Change { .. } | Outcome::NoEffect => {}
        }
    }
    let mut not = Vec::new();
    if !tried.is_empty() {
        not.push(format!("Tried without success: {}.", tried.join("; ")));
    }
    if !stopped.is_empty() {
        not.push(format!("Not tried to the end, for the time was over: {}.", stopped.join(", ")));
    }
    let rows: Vec<Value> = changes.iter().map(|change| of.row(change)).collect();
    json!({ "say": say, "rows": rows, "not": not.join(" ") })
}

#[cfg(test)]
mod tests {
    use super::*;
    use clatter_product::{LimitKind, ProductFile};

    #[test]
    fn values_have_the_digits_and_units_of_the_file() {
        let file = ProductFile::read(include_str!("../../../../tests/cases/bar-handheld.toml"), "bar.toml").unwrap();
        let of = Of { file: &file, component: &file.components[1] };
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
