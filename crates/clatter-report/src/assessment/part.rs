//! This module writes the page of one part.

use clatter_assess::{ComponentAssessment, LimitAssessment, Portrait, Verdict, WorstCase, repeat};
use clatter_figures::{is_drawn, three};
use clatter_product::{Component, DropName, Input, Model, ProductFile};
use serde_json::{Value, json};

use super::changes::{Of, changes};
use super::inputs::held;
use super::plate;
use crate::Pages;
use crate::words::{end, hundredths, is_sure, millimeters, minus, name, percent, place, shown, span, sure_name};

/// Returns the further facts about a limit, one sentence each.
fn said(file: &ProductFile, of: &LimitAssessment) -> Vec<String> {
    let sentence = |text: &str| {
        let mut letters = text.chars();
        let first = letters.next().map(|c| c.to_uppercase().to_string()).unwrap_or_default();
        format!("{first}{}.", letters.as_str().trim_end_matches('.'))
    };
    let mut said = Vec::new();
    if of.demand.is_some() && of.uncertainty.is_finite() {
        let more = percent(of.uncertainty).replace('+', "");
        said.push(format!("Other drops may ask for up to {more} more."));
    }
    if let Some(bound) = of.bound {
        said.push(format!("The energy of the drops allows no more than {}.", shown(of.unit, bound)));
    }
    if let Some(other) = of.other_law {
        let law = file.product.law().other().words();
        said.push(format!("By the other contact law ({law}) the worst drop asks for {}.", shown(of.unit, other)));
    }
    if let Some(gyration_m) = of.worst_case.as_ref().and_then(WorstCase::gyration_m) {
        said.push(format!("In the worst drop the radius of gyration is {}.", millimeters(gyration_m)));
    }
    said.extend(of.notes.iter().map(|note| sentence(&minus(&note.to_string()))));
    said
}

/// Returns the worst drop as columns: first end or direction, tilt, speed, restitution, contact, frequency, damping, place, impact.
fn columns(of: &LimitAssessment, worst: &WorstCase) -> [String; 9] {
    let or_none = |value: Option<f64>, factor: f64| value.map_or("–".to_owned(), |v| three(factor * v));
    let contact = worst.drop.contact_time_s.filter(|_| of.model.bar == Model::Compliant);
    let first = match (worst.landing.and_then(DropName::attitude), worst.direction_deg()) {
        (Some(attitude), _) => attitude.to_string(),
        (None, Some(to)) => format!("{}°", three(to)),
        (None, None) => end(worst.drop.first()).to_owned(),
    };
    [
        worst.landing.and_then(DropName::number).map_or(first.clone(), |n| format!("drop {n}: {first}")),
        if worst.drop.is_flat { "flat".to_owned() } else { format!("{}°", three(worst.tilt_deg())) },
        format!("{} m/s{}", three(worst.drop.speed_m_s), optional(worst)),
        three(worst.drop.restitution),
        contact.map_or("–".to_owned(), |time| format!("{} ms", three(1e3 * time))),
        worst.frequency_hz().map_or("–".to_owned(), |hz| format!("{} Hz", three(hz))),
        or_none(worst.damping_ratio(), 1.0),
        if worst.drop.body.is_wide() {
            place(worst.part.place.plan_m())
        } else {
            millimeters(worst.part.place.at_m[0])
        },
        worst.impact.to_string(),
    ]
}

/// Returns the cells of the tables for one limit of a part.
fn row(pages: &Pages<'_>, part: &str, of: &LimitAssessment) -> Value {
    let file = pages.file;
    // No command finds a name that is drawn as boxes.
    let short = repeat(pages.path, part, of.limit, &pages.assessment.accuracy).filter(|said| said.chars().all(is_sure));
    let known = |value: Option<f64>| value.map_or("–".to_owned(), |value| shown(of.unit, value));
    json!({
        "name": of.limit.words(),
        "allowed": shown(of.unit, of.allowed),
        "demand": known(of.demand),
        "flat": known(of.clatter_free),
        "bound": known(of.bound),
        "margin": of.margin.map_or("–".to_owned(), percent),
        "verdict": of.verdict.name(),
        "worst": of.worst_case.as_ref().map(|worst| columns(of, worst)),
        "said": said(file, of),
        "undecided": of.why_undecided().as_deref().map(minus),
        "command": of.worst_case.as_ref().map(|worst| short.filter(|_| !worst.drawn).unwrap_or_else(|| worst.command())),
    })
}

/// Describes the tightest limit and the drop behind it, in a few sentences.
fn summary(component: &Component, of: &LimitAssessment, portrait: &Portrait, file: &ProductFile) -> String {
    let what = of.limit.words();
    let tightest = if let (Some(demand), Some(margin), Some(worst)) = (of.demand, of.margin, &of.worst_case) {
        format!(
            "The tightest limit is its {what}: {} is allowed, and the worst drop that was found asks for {}, {} of it (margin {}). {}",
            shown(of.unit, of.allowed),
            shown(of.unit, demand),
            hundredths(demand / of.allowed),
            percent(margin),
            drop(worst),
        )
    } else {
        format!("No drop of the ranges is answered for its {what}.")
    };
    let zone = match portrait.zone_m {
        Some([lo, hi]) if lo < hi => {
            format!(
                " In the drops of the figures it holds with its middle anywhere from {} to {}.",
                millimeters(lo),
                millimeters(hi)
            )
        }
        Some(_) => String::new(),
        None if file.product.body.is_wide() => {
            portrait.plate.iter().map(|plate| plate::zone(of.limit, plate)).collect()
        }
        None => " In the drops of the figures it holds nowhere along the product.".to_owned(),
    };
    format!("{} {tightest}{zone}", held(component, file))
}

fn drop(worst: &WorstCase) -> String {
    let frequency = worst.frequency_hz().map(|hz| format!(", the part at {} Hz", three(hz))).unwrap_or_default();
    let peak = if worst.impact > 1 {
        format!("the peak comes after impact {}, not after the first", worst.impact)
    } else {
        "the peak comes after the first impact".to_owned()
    };
    let lands = if let Some(landing) = worst.landing.and_then(DropName::attitude) {
        let peak = peak.as_str();
        let (off, speed, e) = (three(worst.tilt_deg()), three(worst.drop.speed_m_s), three(worst.drop.restitution));
        return format!(
            "That drop lands on the {landing}, {off}° off, at {speed} m/s{}, with e = {e}{frequency}; {peak}.{}",
            optional(worst),
            in_the_lab(worst, &landing.in_a_sentence()),
        );
    } else if let Some(direction) = worst.direction_deg() {
        format!("on {}, rising to {}°,", plate::lowest(direction), three(direction))
    } else if worst.drop.is_flat {
        "flat, both ends as one,".to_owned()
    } else {
        format!("on end {}", end(worst.drop.first()))
    };
    let tilted = if worst.drop.is_flat { String::new() } else { format!(", tilted by {}°", three(worst.tilt_deg())) };
    let (speed, e) = (three(worst.drop.speed_m_s), three(worst.drop.restitution));
    let optional = optional(worst);
    let which = worst.landing.and_then(DropName::number).map_or(String::new(), |n| format!(", drop {n} of the file,"));
    format!("That drop{which} lands {lands} at {speed} m/s{tilted}{optional}, with e = {e}{frequency}; {peak}.")
}

/// Describes the drop of a box to be made in a laboratory, from rest.
fn in_the_lab(worst: &WorstCase, lands: &str) -> String {
    let drop = &worst.drop;
    if drop.gravity_m_s2 == 0.0 {
        return String::new();
    }
    let height_m = 0.5 * drop.speed_m_s * drop.speed_m_s / drop.gravity_m_s2;
    let off = if drop.tilt_rad > 0.0 { format!(", turned by {}°", three(worst.tilt_deg())) } else { String::new() };
    format!(" In the lab: drop it from {} m {lands}{off}.", three(height_m))
}

/// Describes the inputs that a file may leave out, where they count, and the friction of a box.
fn optional(worst: &WorstCase) -> String {
    let each = worst.optional();
    let told = each.map(|(row, optional, x)| format!(", {} {}", optional.phrase, span([x; 2], 1.0, row.unit)));
    let friction = Input::Friction.value(&worst.drop).map(|friction| format!(", friction {}", three(friction)));
    told.chain(friction).collect::<Vec<_>>().concat()
}

/// Describes up to which tilt both ends land at the same instant.
fn flat_until(portrait: &Portrait) -> String {
    let flat = portrait.over_tilt.iter().flat_map(|(_, points)| points).filter(|point| point.drop.is_flat);
    let most = flat.map(|point| point.tilt_rad.to_degrees()).reduce(f64::max);
    most.map_or_else(String::new, |tilt| format!(" Up to {}° both ends land as one.", three(tilt)))
}

/// Returns the content of the page of one part.
pub(super) fn part(
    pages: &Pages<'_>,
    number: usize,
    (component, assessed): (&Component, &ComponentAssessment),
    portrait: &Portrait,
) -> Value {
    let remedies = pages.remedies.iter().find(|found| found.component == number);
    let tightest = assessed.tightest();
    let what = tightest.limit.measured(tightest.unit);
    let allowed = shown(tightest.unit, tightest.allowed);
    let seen = |largest: f64| {
        if is_drawn(tightest.allowed, largest) {
            format!(" The limit is {allowed}.")
        } else {
            format!(" The limit, {allowed}, lies outside the figure.")
        }
    };
    let is_plate = pages.file.product.body.is_wide();
    let over_time = portrait.history.iter().map(|p| p.1.abs()).fold(0.0, f64::max);
    let over_tilt = portrait.over_tilt.iter().flat_map(|(_, curve)| curve).map(|p| tightest.allowed * p.share);
    let reliable = assessed.limits.iter().filter(|l| l.verdict == Verdict::Reliable);
    let undecided = assessed.limits.iter().filter(|l| l.verdict == Verdict::Undecided);
    json!({
        "name": name(&assessed.name),
        "verdict": assessed.verdict.name(),
        "position": if is_plate { place(assessed.position_m.m()) } else { millimeters(assessed.position_m.m()[0]) },
        "summary": summary(component, tightest, portrait, pages.file),
        "undecided": undecided.map(|l| json!({ "limit": l.limit.words(), "why": l.why_undecided().as_deref().map(minus), "by": l.decided_by })).collect::<Vec<_>>(),
        "reliable": reliable.map(|l| json!({ "limit": l.limit.words(), "why": l.why_reliable() })).collect::<Vec<_>>(),
        "limits": assessed.limits.iter().map(|l| row(pages, &component.name, l)).collect::<Vec<_>>(),
        "changes": changes(Of { file: pages.file, component }, assessed, remedies),
        "drawn": !portrait.history.is_empty(),
        "history": format!("The {what} over time in the worst drop.{}", seen(over_time)),
        "history-alt": format!("Curve of the {what} of this part over time in its worst drop, with the impacts marked at the foot."),
        "tilt": format!(
            "The most {what} at each tilt, of the drops that were followed.{}{}",
            seen(over_tilt.fold(0.0, f64::max)),
            flat_until(portrait)
        ),
        "plate": tightest.worst_case.as_ref().zip(portrait.plate.as_ref()).map(|(worst, of)| plate::captions(component, assessed, worst, of)),
        "source": component.limit_source.as_deref().map(sure_name),
        "tilt-alt": format!("Curve of the worst {what} over the tilt at the first touch."),
    })
}
