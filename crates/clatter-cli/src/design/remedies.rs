//! This module shows the changes that would make each part of a product safe with a margin.

use std::f64::consts::FRAC_PI_2;
use std::io::{self, Write};

use clatter_answer::design::Answer;
use clatter_assess::{
    ComponentAssessment, Verdict,
    design::{Change, Lever, Outcome, Remedies, Remedy, Together},
};
use clatter_product::{Model, ProductFile};

use crate::numbers::{digits, figures, given};
use crate::text::{field, shown};
use crate::words;

/// The output of an answer about changes.
pub(super) struct Found<'a>(pub(super) &'a Answer<'a>);

/// Writes a number with at most so many significant digits.
fn digits_of(x: f64, digits: usize) -> String {
    given(format!("{x:.*e}", digits - 1).parse().unwrap_or(x))
}

/// Writes a number with at most six significant digits.
fn short(x: f64) -> String {
    digits_of(x, 6)
}

/// Writes a range, or a single value where both ends are the same.
fn either([lo, hi]: [String; 2], unit: &str) -> String {
    if lo == hi { format!("{lo}{unit}") } else { format!("{lo} to {hi}{unit}") }
}

/// Writes a margin in words.
fn in_percent(margin: f64) -> String {
    if margin.is_infinite() { "no margin known".to_owned() } else { format!("margin {}", words::margin(margin)) }
}

/// Returns the highest speed at the first touch, in any of its drops.
fn fastest(file: &ProductFile) -> f64 {
    let listed = file.landings.iter().map(|landing| landing.drop.speeds_m_s()[1]).reduce(f64::max);
    listed.unwrap_or(file.drop.speeds_m_s()[1])
}

impl Found<'_> {
    /// Describes the margin of a changed part in words.
    fn left(&self, after: &ComponentAssessment) -> String {
        let undecided = if after.verdict == Verdict::Safe { "" } else { ", not safe" };
        format!("then {}{undecided}", in_percent(clatter_assess::least_margin(self.0.file, after)))
    }

    /// Returns the cells that follow lever and unit in a row.
    fn cells(&self, outcome: &str, Change { from, to, .. }: &Change, after: &ComponentAssessment) -> String {
        let numbers = [from[0], from[1], to[0], to[1], clatter_assess::least_margin(self.0.file, after)].map(digits);
        format!("{outcome},{}", numbers.join(","))
    }

    /// Writes a value of a lever of a part in words, or a range where it is one, in the unit of the file.
    fn value(&self, part: &Remedies, lever: Lever, value: [f64; 2]) -> String {
        if lever == Lever::InertiaRatio {
            let mut radii = value.map(|q| self.0.gyration_mm(q));
            radii.sort_by(f64::total_cmp);
            return either(radii.map(|mm| digits_of(mm, 4)), " mm");
        }
        let unit = lever.written_in(&self.0.file.product, &self.0.file.components[part.component]);
        let name = unit.map_or(lever.unit(), |unit| unit.name);
        let name = if name.is_empty() { String::new() } else { format!(" {name}") };
        either(value.map(|x| short(unit.map_or(x, |unit| unit.of_si(x)))), &name)
    }

    /// Describes a change in words.
    fn said(&self, part: &Remedies, change: &Change) -> String {
        let Change { lever, from, to } = *change;
        let more = match lever {
            Lever::InertiaRatio => format!(", q {} -> {}", digits_of(from[0], 4), digits_of(to[0], 4)),
            Lever::ContactTime => {
                let fastest = fastest(self.0.file);
                // The depth is that of the hysteretic law: τ = (π/2)(1 + e) d/v.
                let give_m = to[1] * fastest / (FRAC_PI_2 * (1.0 + self.0.file.product.restitution.lo()));
                format!(", an edge that gives by {} mm", digits_of(1e3 * give_m, 2))
            }
            _ => String::new(),
        };
        format!("{} -> {}{more}", self.value(part, lever, from), self.value(part, lever, to))
    }

    pub(super) fn table(&self, out: &mut dyn Write) -> io::Result<()> {
        let product = &self.0.file.product;
        let e = either([product.restitution.lo(), product.restitution.hi()].map(short), "");
        let is = match product.body.width {
            None => format!("q = {}", figures(product.inertia_ratio())),
            Some(_) if !self.0.file.is_box() => "a plate".to_owned(),
            Some(_) => "a box".to_owned(),
        };
        writeln!(out, "{}: {is}, e = {e}", shown(&product.name, 60))?;
        let (wanted, count) = (given(100.0 * self.0.margin), self.0.assessment.components.len());
        if let Some(plane) = &self.0.plane {
            let (model, side) = (plane.model.name(), plane.side);
            let contacts = plane.model == Model::Compliant;
            let law = if contacts { format!(", {} contacts", product.law().name()) } else { String::new() };
            writeln!(
                out,
                "Plane of q and e: by the model {model}{law}, {side} by {side} values where a border has no closed form"
            )?;
        }
        let mut limits = self.0.assessment.components.iter().flat_map(|component| &component.limits);
        let both = product.contact_law.is_none() && limits.any(|limit| limit.other_law.is_some());
        let by = if both { " by both contact laws" } else { "" };
        if self.0.remedies.is_empty() {
            return writeln!(out, "Every part is safe with a margin of {wanted} %{by}: nothing has to change");
        }
        let failing = self.0.remedies.len();
        let are = if failing == 1 { "is" } else { "are" };
        writeln!(
            out,
            "{failing} of {count} parts {are} not safe with a margin of {wanted} %{by}; what would make it so, one change at a time:"
        )?;
        self.0.remedies.iter().try_for_each(|part| self.part(part, out))
    }

    fn part(&self, part: &Remedies, out: &mut dyn Write) -> io::Result<()> {
        let Some(component) = self.0.assessment.components.get(part.component) else { return Ok(()) };
        let (verdict, before) =
            (component.verdict.name(), in_percent(clatter_assess::least_margin(self.0.file, component)));
        writeln!(out, "\n{} ({verdict}, {before})", shown(&component.name, 60))?;
        let width = part.levers.iter().map(|remedy| remedy.lever.words().len()).max().unwrap_or(0);
        let mut notes: Vec<(String, Vec<&str>)> = Vec::new();
        for Remedy { lever, outcome } in &part.levers {
            let name = lever.words();
            match outcome {
                Outcome::Change { change, after } => {
                    writeln!(out, "  {name:<width$} {}   ({})", self.said(part, change), self.left(after))?;
                    for note in after.tightest().notes.iter().map(ToString::to_string) {
                        match notes.iter_mut().find(|(known, _)| *known == note) {
                            Some((_, levers)) => levers.push(name),
                            None => notes.push((note, vec![name])),
                        }
                    }
                }
                Outcome::Nowhere { bounds: [lo, hi] } => {
                    let range = self.value(part, *lever, [*lo, *hi]);
                    writeln!(out, "  {name:<width$} no value from {range} is enough")?;
                }
                Outcome::NoEffect => writeln!(out, "  {name:<width$} has no effect on its limits")?,
                Outcome::Stopped => writeln!(out, "  {name:<width$} not known: the time was over before")?,
            }
        }
        for (note, levers) in notes {
            writeln!(out, "  note ({}): {note}", levers.join(", "))?;
        }
        if let Some(pair) = &part.pair {
            self.together(part, "No change alone is enough; these together are:", pair, out)?;
        }
        match &part.nearest {
            Some(nearest) => self.together(part, "Nothing is enough; nearest come:", nearest, out),
            None => Ok(()),
        }
    }

    fn together(&self, part: &Remedies, head: &str, together: &Together, out: &mut dyn Write) -> io::Result<()> {
        writeln!(out, "  {head}")?;
        let width = together.changes.iter().map(|change| change.lever.words().len()).max().unwrap_or(0);
        for change in &together.changes {
            writeln!(out, "    {:<width$} {}", change.lever.words(), self.said(part, change))?;
        }
        writeln!(out, "    ({})", self.left(&together.after))
    }

    /// Writes the changes as CSV; those that go together have one name as outcome and the margin that all of them leave.
    pub(super) fn csv(&self, out: &mut dyn Write) -> io::Result<()> {
        writeln!(out, "component,margin,lever,unit,outcome,from_lo,from_hi,to_lo,to_hi,margin_after")?;
        for part in &self.0.remedies {
            let Some(component) = self.0.assessment.components.get(part.component) else { continue };
            let before =
                format!("{},{}", field(&component.name), digits(clatter_assess::least_margin(self.0.file, component)));
            for Remedy { lever, outcome } in &part.levers {
                let rest = match outcome {
                    Outcome::Change { change, after } => self.cells("change", change, after),
                    Outcome::Nowhere { .. } => "nowhere,,,,,".to_owned(),
                    Outcome::NoEffect => "no-effect,,,,,".to_owned(),
                    Outcome::Stopped => "stopped,,,,,".to_owned(),
                };
                writeln!(out, "{before},{},{},{rest}", lever.name(), lever.unit())?;
            }
            for (outcome, together) in [("pair", &part.pair), ("nearest", &part.nearest)] {
                for (change, after) in together.iter().flat_map(|all| all.changes.iter().map(|one| (one, &all.after))) {
                    let (lever, rest) = (change.lever, self.cells(outcome, change, after));
                    writeln!(out, "{before},{},{},{rest}", lever.name(), lever.unit())?;
                }
            }
        }
        Ok(())
    }
}
