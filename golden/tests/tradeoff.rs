//! What every pair of models gets wrong: the four bars of Table 1 and a worked product. Times are never here.

#![cfg(test)]

use std::fmt::Write as _;

use clatter::paper::DESIGNS;
use clatter_scene::ProductFile;
use clatter_scene::plan::Quantity;
use clatter_scene::tradeoff::{Kept, Tradeoff, bar, bars};

fn golden(name: &str, text: &str) {
    insta::with_settings!(
        { snapshot_path => "../snapshots", prepend_module_to_snapshot => false, omit_expression => true },
        { insta::assert_snapshot!(name, text) }
    );
}

/// Two digits, of shares that are more than what a reference is good for.
fn share(error: f64) -> String {
    if error < 1e-6 { "< 1e-6".to_owned() } else { format!("{error:.1e}") }
}

fn rows(trade: &Tradeoff) -> String {
    let mut text = String::new();
    let reference = &trade.reference;
    let (bar, component) = (reference.bar.name(), reference.component.name());
    let _ = writeln!(text, "  reference {bar} {component}: {:.3e}, {} strikes", reference.value, reference.strikes);
    let _ = writeln!(text, "  {:<12} {:<13} {:<8} {:<8} strikes  plan", "bar", "part", "error", "estimate");
    for p in &trade.pairs {
        let estimate = if p.estimate.is_infinite() { "-".to_owned() } else { share(p.estimate) };
        let chosen: Vec<String> = p.chosen_at.iter().map(f64::to_string).collect();
        let line = format!(
            "  {:<12} {:<13} {:<8} {estimate:<8} {:<8} {}",
            p.bar.name(),
            p.component.name(),
            share(p.error),
            p.strikes,
            chosen.join(" ")
        );
        let _ = writeln!(text, "{}", line.trim_end());
    }
    text + &worth(&trade.kept)
}

/// How many strikes are enough, and what the first few get wrong.
fn worth(trains: &[Kept]) -> String {
    let mut text = String::new();
    for kept in trains {
        let least: Vec<String> = kept.least.iter().map(|n| n.map_or("-".to_owned(), |n| n.to_string())).collect();
        let first: Vec<String> = kept.errors.iter().take(8).map(|error| share(*error)).collect();
        let (bar, strikes, least, first) = (kept.bar.name(), kept.strikes, least.join(" "), first.join("  "));
        let _ = writeln!(text, "  worth keeping, {bar}: {least} of {strikes}; with the first few, off by {first}");
    }
    text
}

#[test]
fn the_bars_of_table_1() {
    let mut text = String::from("peak acceleration of a board at 230 Hz, Q = 10, near the end that strikes second\n");
    for (setup, [q, e]) in bars().unwrap().iter().zip(DESIGNS) {
        let trade = Tradeoff::measure(setup, Quantity::PeakAcceleration).unwrap();
        let _ = write!(text, "q = {q}, e = {e}\n{}", rows(&trade));
    }
    text.push_str("without end, but for gravity\n");
    for [q, e] in [[0.8, 0.1], [0.9, 0.3], [0.95, 0.5]] {
        let trade = Tradeoff::measure(&bar(q, e).unwrap(), Quantity::PeakAcceleration).unwrap();
        let _ = write!(text, "q = {q}, e = {e}\n{}", worth(&trade.kept));
    }
    golden("tradeoff-of-the-bars", &text);
}

#[test]
fn a_handheld_terminal() {
    let text = include_str!("../../reports/examples/handheld-terminal.toml");
    let file = ProductFile::read(text, "handheld-terminal.toml").unwrap();
    let answer = file.tradeoff(&file.assess().unwrap()).unwrap();
    let mut text = String::new();
    for part in &answer.trades {
        let scene = &part.trade.scene;
        let (tilt, e, s) = (scene.tilt_deg, scene.restitution, scene.position);
        let _ = writeln!(text, "{}, {}: {tilt:.2} deg, e = {e:.3}, s = {s:.3}", part.component, part.limit.name());
        text.push_str(&rows(&part.trade));
    }
    for left in &answer.left_out {
        let _ = writeln!(text, "{}, {}: {}", left.component, left.limit.name(), left.reason);
    }
    golden("tradeoff-of-a-handheld-terminal", &text);
}
