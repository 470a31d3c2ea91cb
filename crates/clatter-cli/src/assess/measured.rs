//! This module compares the results of measured drops with the values that the product file states.

use std::io::{self, Write};

use clatter_answer::assess::{Answer, Said};

use crate::Streams;
use crate::text::shown;

/// Warns where the measured product is not that of the file.
pub(super) fn warn(answer: &Answer<'_>, streams: &mut Streams<'_>) {
    for (drop, told) in answer.warnings() {
        streams.note("warning", format_args!("{}: {told}", shown(drop, 60)));
    }
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
            let Said { what, measured, interval, stated } = Said::of(&beside);
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
