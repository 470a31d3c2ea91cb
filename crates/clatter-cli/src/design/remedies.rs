//! What would make each part of a product safe with a margin.

use std::f64::consts::FRAC_PI_2;
use std::io::{self, Write};

use clatter_assess::design::{Change, Lever, Outcome, Plane, Remedies, Remedy, Together};
use clatter_assess::{Assessment, ComponentAssessment, LimitAssessment, ProductFile, Verdict};
use serde::Serialize;

use crate::numbers::{Json, digits, figures, given};
use crate::quantities::neat;
use crate::text::{field, shown};
use crate::words;

/// The answer for one product.
pub(super) struct Found<'a> {
    pub(super) file: &'a ProductFile,
    pub(super) assessment: &'a Assessment,
    pub(super) remedies: &'a [Remedies],
    /// If it was asked for.
    pub(super) plane: Option<&'a Plane>,
    /// Asked for.
    pub(super) margin: f64,
}

/// The smallest margin of a component.
fn margin(component: &ComponentAssessment) -> f64 {
    component.limits.iter().map(LimitAssessment::room).fold(f64::INFINITY, f64::min)
}

/// What a lever is called.
fn called(lever: Lever) -> &'static str {
    match lever {
        Lever::InertiaRatio => "radius of gyration",
        Lever::Restitution => "restitution e",
        Lever::Position => "place",
        Lever::Frequency => "natural frequency",
        Lever::Damping => "damping ratio",
        Lever::ContactTime => "contact time",
        Lever::Limit(kind) => kind.allowed(),
    }
}

/// At most so many significant digits.
fn digits_of(x: f64, digits: usize) -> String {
    given(format!("{x:.*e}", digits - 1).parse().unwrap_or(x))
}

/// At most six significant digits.
fn short(x: f64) -> String {
    digits_of(x, 6)
}

/// A range, or a value where it is one.
fn either([lo, hi]: [String; 2], unit: &str) -> String {
    if lo == hi { format!("{lo}{unit}") } else { format!("{lo} to {hi}{unit}") }
}

/// A margin in words.
fn in_percent(margin: f64) -> String {
    if margin.is_infinite() { "no margin known".to_owned() } else { format!("margin {}", words::margin(margin)) }
}

/// The margin of a changed part in words.
fn left(after: &ComponentAssessment) -> String {
    let undecided = if after.verdict == Verdict::Safe { "" } else { ", not safe" };
    format!("then {}{undecided}", in_percent(margin(after)))
}

/// What follows lever and unit in a row.
fn cells(outcome: &str, Change { from, to, .. }: &Change, after: &ComponentAssessment) -> String {
    let numbers = [from[0], from[1], to[0], to[1], margin(after)].map(digits);
    format!("{outcome},{}", numbers.join(","))
}

impl Found<'_> {
    /// Radius of gyration in mm behind an inertia ratio, which is what can be built.
    fn gyration_mm(&self, q: f64) -> f64 {
        let product = self.file.product.with_inertia_ratio(q);
        product.map_or(f64::NAN, |product| neat(1e3 * product.body.gyration_m()))
    }

    /// A value of a lever of a part in words, a range where it is one, in the unit of the file.
    fn value(&self, part: &Remedies, lever: Lever, value: [f64; 2]) -> String {
        if lever == Lever::InertiaRatio {
            let mut radii = value.map(|q| self.gyration_mm(q));
            radii.sort_by(f64::total_cmp);
            return either(radii.map(|mm| digits_of(mm, 4)), " mm");
        }
        let unit = lever.written_in(&self.file.product, &self.file.components[part.component]);
        let name = unit.map_or(lever.unit(), |unit| unit.name);
        let name = if name.is_empty() { String::new() } else { format!(" {name}") };
        either(value.map(|x| short(unit.map_or(x, |unit| unit.of_si(x)))), &name)
    }

    /// A change in words.
    fn said(&self, part: &Remedies, change: &Change) -> String {
        let Change { lever, from, to } = *change;
        let more = match lever {
            Lever::InertiaRatio => format!(", q {} -> {}", digits_of(from[0], 4), digits_of(to[0], 4)),
            Lever::ContactTime => {
                let [_, fastest] = self.file.drop.speeds_m_s();
                // That of the hysteretic law: τ = (π/2)(1 + e) d/v.
                let give_m = to[1] * fastest / (FRAC_PI_2 * (1.0 + self.file.product.restitution.lo()));
                format!(", an edge that gives by {} mm", digits_of(1e3 * give_m, 2))
            }
            _ => String::new(),
        };
        format!("{} -> {}{more}", self.value(part, lever, from), self.value(part, lever, to))
    }

    pub(super) fn table(&self, out: &mut dyn Write) -> io::Result<()> {
        let product = &self.file.product;
        let e = either([product.restitution.lo(), product.restitution.hi()].map(short), "");
        let q = figures(product.inertia_ratio());
        writeln!(out, "{}: q = {q}, e = {e}", shown(&product.name, 60))?;
        let (wanted, count) = (given(100.0 * self.margin), self.assessment.components.len());
        if let Some(plane) = self.plane {
            let (model, side) = (plane.model.name(), plane.side);
            writeln!(
                out,
                "Plane of q and e: by the model {model}, {side} by {side} values where a border has no closed form"
            )?;
        }
        if self.remedies.is_empty() {
            return writeln!(out, "Every part is safe with a margin of {wanted} %: nothing has to change");
        }
        let failing = self.remedies.len();
        let are = if failing == 1 { "is" } else { "are" };
        writeln!(
            out,
            "{failing} of {count} parts {are} not safe with a margin of {wanted} %; what would make it so, one change at a time:"
        )?;
        self.remedies.iter().try_for_each(|part| self.part(part, out))
    }

    fn part(&self, part: &Remedies, out: &mut dyn Write) -> io::Result<()> {
        let Some(component) = self.assessment.components.get(part.component) else { return Ok(()) };
        let (verdict, before) = (component.verdict.name(), in_percent(margin(component)));
        writeln!(out, "\n{} ({verdict}, {before})", shown(&component.name, 60))?;
        let width = part.levers.iter().map(|remedy| called(remedy.lever).len()).max().unwrap_or(0);
        let mut notes: Vec<(String, Vec<&str>)> = Vec::new();
        for Remedy { lever, outcome } in &part.levers {
            let name = called(*lever);
            match outcome {
                Outcome::Change { change, after } => {
                    writeln!(out, "  {name:<width$} {}   ({})", self.said(part, change), left(after))?;
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
        let width = together.changes.iter().map(|change| called(change.lever).len()).max().unwrap_or(0);
        for change in &together.changes {
            writeln!(out, "    {:<width$} {}", called(change.lever), self.said(part, change))?;
        }
        writeln!(out, "    ({})", left(&together.after))
    }

    /// Changes that go together have one name as outcome and the margin that all of them leave.
    pub(super) fn csv(&self, out: &mut dyn Write) -> io::Result<()> {
        writeln!(out, "component,margin,lever,unit,outcome,from_lo,from_hi,to_lo,to_hi,margin_after")?;
        for part in self.remedies {
            let Some(component) = self.assessment.components.get(part.component) else { continue };
            let before = format!("{},{}", field(&component.name), digits(margin(component)));
            for Remedy { lever, outcome } in &part.levers {
                let rest = match outcome {
                    Outcome::Change { change, after } => cells("change", change, after),
                    Outcome::Nowhere { .. } => "nowhere,,,,,".to_owned(),
                    Outcome::NoEffect => "no-effect,,,,,".to_owned(),
                    Outcome::Stopped => "stopped,,,,,".to_owned(),
                };
                writeln!(out, "{before},{},{},{rest}", lever.name(), lever.unit())?;
            }
            for (outcome, together) in [("pair", &part.pair), ("nearest", &part.nearest)] {
                for (change, after) in together.iter().flat_map(|all| all.changes.iter().map(|one| (one, &all.after))) {
                    let (lever, rest) = (change.lever, cells(outcome, change, after));
                    writeln!(out, "{before},{},{},{rest}", lever.name(), lever.unit())?;
                }
            }
        }
        Ok(())
    }

    pub(super) fn json(&self) -> ProductJson<'_> {
        let product = &self.file.product;
        let components = self.assessment.components.iter().enumerate();
        ProductJson {
            product: &product.name,
            q: Json(product.inertia_ratio()),
            restitution: [Json(product.restitution.lo()), Json(product.restitution.hi())],
            verdict: self.assessment.verdict,
            margin: Json(self.margin),
            plane: self.plane.map(|plane| PlaneJson {
                model: plane.model.name(),
                side: plane.side,
                closed_form_error: Json(plane.closed_form_error),
            }),
            components: components.map(|(i, component)| self.part_json(i, component)).collect(),
        }
    }

    fn part_json<'a>(&'a self, i: usize, component: &'a ComponentAssessment) -> PartJson<'a> {
        let part = self.remedies.iter().find(|part| part.component == i);
        let together = |together: &Together| TogetherJson {
            changes: together.changes.iter().map(|change| self.change_json(change)).collect(),
            verdict: together.after.verdict,
            margin_after: Json(margin(&together.after)),
        };
        PartJson {
            name: &component.name,
            verdict: component.verdict,
            margin: Json(margin(component)),
            remedies: part.iter().flat_map(|part| &part.levers).map(|remedy| self.remedy_json(remedy)).collect(),
            pair: part.and_then(|part| part.pair.as_ref()).map(together),
            nearest: part.and_then(|part| part.nearest.as_ref()).map(together),
        }
    }

    fn change_json(&self, change: &Change) -> ChangeJson {
        ChangeJson {
            lever: change.lever.name(),
            unit: change.lever.unit(),
            from: change.from.map(Json),
            to: change.to.map(Json),
            radius_of_gyration_m: (change.lever == Lever::InertiaRatio)
                .then(|| Json(neat(1e-3 * self.gyration_mm(change.to[0])))),
        }
    }

    fn remedy_json(&self, Remedy { lever, outcome }: &Remedy) -> RemedyJson {
        let none = RemedyJson {
            lever: lever.name(),
            unit: lever.unit(),
            outcome: "no-effect",
            from: None,
            to: None,
            radius_of_gyration_m: None,
            margin_after: None,
            warning: None,
            bounds: None,
        };
        match outcome {
            Outcome::Change { change, after } => {
                let ChangeJson { from, to, radius_of_gyration_m, .. } = self.change_json(change);
                let notes: Vec<_> = after.tightest().notes.iter().map(ToString::to_string).collect();
                RemedyJson {
                    outcome: "change",
                    from: Some(from),
                    to: Some(to),
                    radius_of_gyration_m,
                    margin_after: Some(Json(margin(after))),
                    warning: (!notes.is_empty()).then(|| notes.join("; ")),
                    ..none
                }
            }
            Outcome::Nowhere { bounds } => RemedyJson { outcome: "nowhere", bounds: Some(bounds.map(Json)), ..none },
            Outcome::NoEffect => none,
            Outcome::Stopped => RemedyJson { outcome: "stopped", ..none },
        }
    }
}

#[derive(Serialize)]
pub(super) struct ProductJson<'a> {
    product: &'a str,
    q: Json,
    restitution: [Json; 2],
    verdict: Verdict,
    /// Asked for.
    margin: Json,
    /// How the plane was found, where it was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    plane: Option<PlaneJson>,
    components: Vec<PartJson<'a>>,
}

#[derive(Serialize)]
struct PlaneJson {
    model: &'static str,
    /// Values of q, and of e.
    side: usize,
    /// The worst that the closed form got wrong on drops all over the plane; null where one of the models has no answer.
    closed_form_error: Json,
}

#[derive(Serialize)]
struct PartJson<'a> {
    name: &'a str,
    verdict: Verdict,
    margin: Json,
    remedies: Vec<RemedyJson>,
    /// Where no change alone is enough, the two that are together.
    pair: Option<TogetherJson>,
    /// Where no two are enough either, how near one gets.
    nearest: Option<TogetherJson>,
}

#[derive(Serialize)]
struct TogetherJson {
    changes: Vec<ChangeJson>,
    verdict: Verdict,
    margin_after: Json,
}

#[derive(Serialize)]
struct ChangeJson {
    lever: &'static str,
    unit: &'static str,
    from: [Json; 2],
    to: [Json; 2],
    /// Of an inertia ratio.
    #[serde(skip_serializing_if = "Option::is_none")]
    radius_of_gyration_m: Option<Json>,
}

#[derive(Serialize)]
struct RemedyJson {
    lever: &'static str,
    unit: &'static str,
    outcome: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    from: Option<[Json; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    to: Option<[Json; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    radius_of_gyration_m: Option<Json>,
    #[serde(skip_serializing_if = "Option::is_none")]
    margin_after: Option<Json>,
    /// What else is to be known of the part then.
    #[serde(skip_serializing_if = "Option::is_none")]
    warning: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    bounds: Option<[Json; 2]>,
}
