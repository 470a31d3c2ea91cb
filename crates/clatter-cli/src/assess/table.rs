//! Assessments for people.

use std::io::{self, Write};
use std::path::PathBuf;

use clatter_assess::{Assessment, ComponentAssessment, LimitAssessment, ProductFile, Verdict};

use crate::text::{column, path, shown};
use crate::words::{drop, four, in_words, margin, percent};

fn verdict(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Safe => "safe",
        Verdict::Undecided => "undecided",
        Verdict::Unsafe => "UNSAFE",
    }
}

fn name(component: &ComponentAssessment) -> String {
    shown(&component.name, 24)
}

pub(super) fn of_one(file: &ProductFile, assessment: &Assessment, out: &mut dyn Write) -> io::Result<()> {
    headline(assessment, out)?;
    limits(file, assessment, out)?;
    writeln!(out)?;
    writeln!(out, "Bound by energy: no drop of the ranges asks for more; parts on a suspension have none.")?;
    writeln!(out, "Flat drop: what the worst drop would ask if both ends landed at once, as drop standards assume.")?;
    let all = assessment.components.iter().flat_map(|component| &component.limits);
    if all.clone().any(|limit| limit.other_law.is_some()) {
        writeln!(out, "Other law: what the worst drop by the other contact law asks for.")?;
    }
    if let Some(limit) = all.clone().next() {
        writeln!(out, "\nWorst drops, by the model {}: {}", limit.model.bar.name(), limit.model.reason)?;
    }
    for component in &assessment.components {
        component.limits.iter().try_for_each(|limit| worst_drop(component, limit, out))?;
    }
    Ok(())
}

/// The verdict, and how many parts are behind it.
fn headline(assessment: &Assessment, out: &mut dyn Write) -> io::Result<()> {
    let count = |verdict: Verdict| assessment.components.iter().filter(|c| c.verdict == verdict).count();
    let (product, all) = (shown(&assessment.product, 60), assessment.components.len());
    match (count(Verdict::Unsafe), count(Verdict::Undecided)) {
        (0, 0) => writeln!(out, "{product} is safe: every limit holds in the worst drop"),
        (0, undecided) => writeln!(out, "{product} is undecided: {undecided} of {all} components"),
        (failing, 0) => writeln!(out, "{product} is UNSAFE: {failing} of {all} components"),
        (failing, undecided) => {
            writeln!(out, "{product} is UNSAFE: {failing} of {all} components, {undecided} undecided")
        }
    }
}

/// A row for each limit, in the unit in which the file gives it.
fn limits(file: &ProductFile, assessment: &Assessment, out: &mut dyn Write) -> io::Result<()> {
    let heads = [
        "component",
        "limit",
        "verdict",
        "allowed",
        "demand",
        "margin",
        "good to",
        "bound by energy",
        "flat drop",
        "other law",
    ];
    let mut rows = vec![heads.map(str::to_owned)];
    for (component, given) in assessment.components.iter().zip(&file.components) {
        for (i, limit) in component.limits.iter().enumerate() {
            let first = if i == 0 { name(component) } else { String::new() };
            let written = given.limits.unit(limit.limit, limit.unit);
            let of = |value: Option<f64>| value.map_or("-".to_owned(), |value| in_words(limit.unit, written, value));
            rows.push([
                first,
                limit.limit.name().to_owned(),
                verdict(limit.verdict).to_owned(),
                of(Some(limit.allowed)),
                of(limit.demand),
                limit.margin.map_or("-".to_owned(), margin),
                limit.margin.map_or("-".to_owned(), |_| percent(limit.uncertainty)),
                of(limit.bound),
                of(limit.clatter_free),
                of(limit.other_law),
            ]);
        }
    }
    // At least as wide as what there mostly is, so that tables look alike.
    let least = [9, 24, 9, 12, 12, 9, 9, 15, 12, 12];
    let width = |i: usize| rows.iter().map(|row| column(&row[i], 0).1).max().unwrap_or(0).max(least[i]);
    let widths: Vec<_> = (0..least.len()).map(width).collect();
    writeln!(out)?;
    for row in &rows {
        let cells = row.iter().zip(&widths).enumerate().map(|(i, (cell, width))| {
            if i < 3 { column(cell, *width).0 } else { format!("{}{cell}", " ".repeat(width - column(cell, 0).1)) }
        });
        writeln!(out, "{}", cells.collect::<Vec<_>>().join(" "))?;
    }
    Ok(())
}

/// The drop behind a demand: why the limit is undecided, what else is to be known, and the command that repeats it.
fn worst_drop(component: &ComponentAssessment, limit: &LimitAssessment, out: &mut dyn Write) -> io::Result<()> {
    write!(out, "{}, {}: ", name(component), limit.limit.name())?;
    match &limit.worst_case {
        Some(worst) => writeln!(out, "{}; impact {} at {} ms", drop(worst), worst.impact, four(1e3 * worst.time_s))?,
        None => writeln!(out, "no drop is answered")?,
    }
    if let Some(reason) = &limit.undecided {
        writeln!(out, "  undecided: {reason}")?;
    }
    limit.notes.iter().try_for_each(|note| writeln!(out, "  note: {note}"))?;
    limit.worst_case.iter().try_for_each(|worst| writeln!(out, "  {}", worst.command))
}

/// Margins of several products, a column each.
pub(super) fn side_by_side(files: &[PathBuf], assessments: &[Assessment], out: &mut dyn Write) -> io::Result<()> {
    let mut rows: Vec<(String, &'static str)> = Vec::new();
    for assessment in assessments {
        for component in &assessment.components {
            for limit in &component.limits {
                let row = (component.name.clone(), limit.limit.name());
                if !rows.contains(&row) {
                    rows.push(row);
                }
            }
        }
    }
    let wide = rows.iter().map(|(name, _)| column(&shown(name, 24), 0).1).max().unwrap_or(0).max(9);
    // Products of one name are told apart by their files.
    let alike = |name: &str| assessments.iter().filter(|a| shown(&a.product, 20) == shown(name, 20)).count() > 1;
    let head = |(a, file): (&Assessment, &PathBuf)| {
        if alike(&a.product) { path(file) } else { shown(&a.product, 20) }
    };
    let heads: Vec<_> = assessments.iter().zip(files).map(head).collect();
    let widths: Vec<_> = heads.iter().map(|head| column(head, 0).1.max(10)).collect();
    let line = |first: &str, second: &str, cells: &[String]| {
        let mut line = format!("{} {second:<24}", column(first, wide).0);
        for (cell, width) in cells.iter().zip(&widths) {
            let padding = width.saturating_sub(column(cell, 0).1);
            line.extend(["  ", &" ".repeat(padding), cell.as_str()]);
        }
        line
    };
    writeln!(out, "{}", line("component", "margin of", &heads))?;
    for (name, limit) in &rows {
        let cell = |assessment: &Assessment| {
            let component = assessment.components.iter().find(|c| c.name == *name);
            let found = component.and_then(|c| c.limits.iter().find(|l| l.limit.name() == *limit));
            found.map_or("-".to_owned(), |limit| limit.margin.map_or("?".to_owned(), margin))
        };
        let cells: Vec<_> = assessments.iter().map(cell).collect();
        writeln!(out, "{}", line(&shown(name, 24), limit, &cells))?;
    }
    let verdicts: Vec<_> = assessments.iter().map(|a| verdict(a.verdict).to_owned()).collect();
    writeln!(out, "{}", line("", "verdict", &verdicts))
}
