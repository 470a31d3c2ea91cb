//! Errors of every model on the four bars of Table 1 and a worked product. Times, and results that depend on them, are
//! left out.

#![cfg(test)]
#![allow(clippy::disallowed_methods, reason = "cases and references may differ in the last digit between machines")]

use std::fmt::Write as _;

use clatter::design::DESIGNS;
use clatter_assess::ladder::Ladder;
use clatter_product::ProductFile;
use clatter_studies::bars;

/// Tolerance of a model; the reference is ten times as exact.
const TOLERANCE: f64 = 0.01;

fn golden(name: &str, text: &str) {
    insta::with_settings!(
        { snapshot_path => "../snapshots", prepend_module_to_snapshot => false, omit_expression => true },
        { insta::assert_snapshot!(name, text) }
    );
}

fn group(name: &str, value: Option<f64>) -> String {
    value.map_or(String::new(), |value| format!(", {name} = {value:.2e}"))
}

fn rows(ladder: &Ladder) -> String {
    let mut text = String::new();
    let (reference, groups) = (&ladder.reference, &ladder.groups);
    let _ = writeln!(text, "  reference {}: {:.3e} {}", reference.model.name(), reference.value, ladder.unit.name());
    let more = [("tau/dt", groups.overlap), ("omega tau", groups.pulse), ("omega t_N", groups.train)];
    let more: String = more.into_iter().chain([("zeta omega dt", groups.damping)]).map(|(n, v)| group(n, v)).collect();
    let _ = writeln!(text, "  g h0/v0^2 = {:.2e}, phi^2 = {:.2e}{more}", groups.gravity, groups.geometry);
    for m in &ladder.models {
        // Errors above the accuracy of the reference have two digits.
        let error = if m.error < reference.tolerance { "< 1e-3".to_owned() } else { format!("{:.1e}", m.error) };
        let within = if m.error <= TOLERANCE { "within 1 %" } else { "" };
        let line = format!("  {:<14} {error:<8} {:<5} {within}", m.model.name(), m.strikes);
        let _ = writeln!(text, "{}", line.trim_end());
    }
    text
}

#[test]
fn the_bars_of_table_1() {
    let mut text =
        String::from("acceleration of a board at 230 Hz, Q = 10, near the end that strikes second: error, strikes\n");
    for ((drop, part, limit), [q, e]) in bars().unwrap().iter().zip(DESIGNS) {
        let ladder = Ladder::measure(drop, part, limit, TOLERANCE).unwrap();
        let _ = write!(text, "q = {q}, e = {e}\n{}", rows(&ladder));
    }
    golden("ladder-of-the-bars", &text);
}

#[test]
fn a_handheld_terminal() {
    let text = include_str!("../../tests/cases/bar-terminal.toml");
    let file = ProductFile::read(text, "handheld-terminal.toml").unwrap();
    let answer = clatter_assess::ladders(&file, &clatter_assess::assess(&file).unwrap(), TOLERANCE).unwrap();
    let mut text = String::new();
    for limit in &answer.limits {
        let worst = &limit.worst_case;
        let _ = writeln!(
            text,
            "{}, {}: {:.2} deg, e = {:.3}, {:.1} mm",
            limit.component,
            limit.limit.name(),
            worst.tilt_deg(),
            worst.drop.restitution,
            1e3 * worst.part.place.at_m[0]
        );
        text.push_str(&rows(&limit.ladder));
    }
    for left in &answer.left_out {
        let _ = writeln!(text, "{}, {}: {}", left.component, left.limit.name(), left.reason);
    }
    golden("ladder-of-a-handheld-terminal", &text);
}
