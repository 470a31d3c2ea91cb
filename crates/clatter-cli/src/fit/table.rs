//! This module writes a fit for people.

use std::io::{self, Write};

use clatter_answer::fit::{Answer, Question};
use clatter_fit::Estimate;

use crate::inputs::letter;
use crate::text::{self, shown};
use crate::words::four;

pub(super) fn table(answer: &Answer<'_>, out: &mut dyn Write) -> io::Result<()> {
    let Answer { question: Question { file, records, .. }, fit, .. } = answer;
    let name = shown(&file.product.name, 60);
    let of = if records.len() == 1 { "1 record".to_owned() } else { format!("{} records", records.len()) };
    writeln!(out, "{name}: fit to {of}, model {}, {} degrees of freedom", fit.model.name(), fit.degrees_of_freedom)?;
    writeln!(out)?;
    writeln!(out, "{:<22}{:>12}  {:<24}unit", "", "estimate", "95 %")?;
    for estimate in &fit.estimates {
        line(estimate, out)?;
    }
    if !fit.untold.is_empty() {
        writeln!(out, "\nThe data do not tell")?;
    }
    for untold in &fit.untold {
        let (name, factor, unit) = untold.quantity.said();
        let held = format!("{} {unit}", four(factor * untold.held_at));
        writeln!(out, "  {name}, held at {}: {}", held.trim_end(), untold.reason)?;
    }
    writeln!(out)?;
    for (record, found) in records.iter().zip(&fit.records) {
        let (kind, factor, unit) = match record.data.kind() {
            kind @ ("strikes" | "bounces") => (kind, 1e6, "us"),
            kind @ "heights" => (kind, 1e3, "mm"),
            kind => (kind, 1.0, "m/s2"),
        };
        writeln!(
            out,
            "{}: {kind}, {} {unit} off on the mean (root mean square), first touch at {} ms",
            text::path(record.name.as_ref()),
            four(factor * found.scatter),
            four(1e3 * found.first_touch_s)
        )?;
    }
    if fit.records.iter().any(|record| !record.strikes.is_empty()) {
        strikes(answer, out)?;
    }
    for note in &fit.notes {
        writeln!(out, "\nNote: {note}.")?;
    }
    Ok(())
}

fn line(estimate: &Estimate, out: &mut dyn Write) -> io::Result<()> {
    let (name, factor, unit) = estimate.quantity.said();
    let interval = estimate
        .interval
        .map_or_else(|| "not known".to_owned(), |[lo, hi]| format!("{} to {}", four(factor * lo), four(factor * hi)));
    let note = estimate.note.clone().unwrap_or_default();
    let text = format!("{name:<22}{:>12}  {interval:<24}{unit:<6}{note}", four(factor * estimate.value));
    writeln!(out, "{}", text.trim_end())
}

/// The largest number of strikes that are shown.
const MOST: usize = 40;

/// Writes measured strikes next to computed ones.
fn strikes(answer: &Answer<'_>, out: &mut dyn Write) -> io::Result<()> {
    for record in answer.fit.records.iter().filter(|record| !record.strikes.is_empty()) {
        writeln!(out, "\n{:>7} {:>4} {:>14} {:>14}", "strike", "end", "measured, ms", "less computed")?;
        for strike in record.strikes.iter().take(MOST) {
            let number = strike.number.map_or_else(|| "none".to_owned(), |number| number.to_string());
            let residual =
                strike.residual_s.map_or_else(|| "left out".to_owned(), |s| format!("{:+.1} us", 1e6 * s + 0.0));
            let end = strike.measured.end.map_or("", letter);
            writeln!(
                out,
                "{number:>7} {end:>4} {:>14} {residual:>14}",
                format!("{:.4}", 1e3 * strike.measured.time_s)
            )?;
        }
        if record.strikes.len() > MOST {
            writeln!(out, "  and {} more; --format=json lists all", record.strikes.len() - MOST)?;
        }
    }
    Ok(())
}
