//! What measured drops tell, beside what the product file states.

use std::io::{self, Write};

use clatter_answer::assess::Answer;
use clatter_assess::fit::Comparison;

use crate::Streams;
use crate::text::shown;
use crate::words::four;

/// Tells where the product that was measured is not that of the file.
pub(super) fn warn(answer: &Answer<'_>, streams: &mut Streams<'_>) {
    for drop in &answer.measured {
        let name = shown(&drop.name, 60);
        match &drop.found {
            Ok(fit) => {
                for beside in fit.differs(answer.file) {
                    let (what, measured, interval, stated) = said(&beside);
                    let interval = if interval.is_empty() { interval } else { format!(" ({interval})") };
                    let message = format!(
                        "{name}: {what} was measured as {measured}{interval}; the verdict is for the {stated} that the product file states"
                    );
                    streams.note("warning", message);
                }
            }
            Err(reason) => streams.note("warning", format!("{name}: {reason}")),
        }
    }
}

/// Name, estimate, interval and what is stated, with their unit.
fn said(beside: &Comparison<'_>) -> (&'static str, String, String, String) {
    let (what, factor, unit) = beside.estimate.quantity.said();
    let with = |text: String| format!("{text} {unit}").trim_end().to_owned();
    let range = |[lo, hi]: [f64; 2]| {
        let [lo, hi] = [lo, hi].map(|x| four(factor * x));
        if lo == hi { lo } else { format!("{lo} to {hi}") }
    };
    let interval = beside.estimate.interval.map_or_else(String::new, range);
    let stated = beside.stated.map_or_else(String::new, |stated| with(range(stated)));
    (what, with(four(factor * beside.estimate.value)), interval, stated)
}

pub(super) fn table(answer: &Answer<'_>, out: &mut dyn Write) -> io::Result<()> {
    for drop in &answer.measured {
        let name = shown(&drop.name, 60);
        let fit = match &drop.found {
            Ok(fit) => fit,
            Err(reason) => {
                writeln!(out, "\nMeasured, {name}: {reason}")?;
                continue;
            }
        };
        writeln!(out, "\nMeasured, {name}, by the nearest drop of the model {}", fit.model.name())?;
        writeln!(out, "{:<22} {:>12}  {:<24} {:<24}", "", "measured", "95 %", "stated")?;
        for beside in fit.beside(answer.file) {
            let (what, measured, interval, stated) = said(&beside);
            let agrees = match beside.agrees {
                Some(false) if beside.estimate.quantity.is_of_product() => "differs",
                Some(false) => "beyond",
                Some(true) => "agrees",
                None => "",
            };
            let line = format!("{what:<22} {measured:>12}  {interval:<24} {stated:<24} {agrees}");
            writeln!(out, "{}", line.trim_end())?;
        }
        for note in &fit.notes {
            writeln!(out, "Note: {note}.")?;
        }
    }
    Ok(())
}
