//! This module writes assessments for people.

use std::io::{self, Write};
use std::path::PathBuf;

use clatter_answer::assess::Answer;
use clatter_assess::{
    Accuracy, Assessment, Assumed, ComponentAssessment, LandingAssessment, LimitAssessment, Verdict, repeat,
};
use clatter_product::{Component, Input, ProductFile};

use crate::columns::{Table, sentence};
use crate::numbers::given;
use crate::quantities::neat;
use crate::text::{path, shown};
use crate::words::{drop, four, in_words, margin, percent};

fn verdict(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Safe => "safe",
        Verdict::Reliable => "reliable",
        Verdict::Undecided => "undecided",
        Verdict::Unsafe => "UNSAFE",
    }
}

fn name(component: &ComponentAssessment) -> String {
    shown(&component.name, 24)
}

pub(super) fn of_one(path: &str, answer: &Answer<'_>, out: &mut dyn Write) -> io::Result<()> {
    let Answer { file, assessment, .. } = answer;
    let of = (path, &assessment.accuracy);
    headline(assessment, out)?;
    limits(file, assessment, out)?;
    if !assessment.landings.is_empty() {
        landings(file, assessment, out)?;
    }
    writeln!(out)?;
    writeln!(out, "Bound by energy: no drop of the ranges asks for more; parts on a suspension have none.")?;
    let flat = match (file.is_box(), file.product.body.width) {
        (true, _) => "the box were not turned off what it lands on.",
        (_, Some(_)) => "all corners landed at once, as drop standards assume.",
        _ => "both ends landed at once, as drop standards assume.",
    };
    writeln!(out, "Flat drop: what the worst drop would ask if {flat}")?;
    let all = assessment.components.iter().flat_map(|component| &component.limits);
    if all.clone().any(|limit| limit.other_law.is_some()) {
        let asks = if file.product.contact_law.is_some() {
            "what the worst drop would ask by the other contact law, by which no drops are searched."
        } else {
            "what the worst drop by the other contact law asks for; the file names no law, and a limit has to hold by both."
        };
        sentence(out, "Other law: ", asks)?;
    }
    let of_friction = |row: &&Assumed| matches!(row, Assumed::Friction | Assumed::NoFriction);
    for [_, taken, why] in assessment.assumed.iter().filter(of_friction).map(|row| row.told()) {
        sentence(out, "Friction: ", &format!("{taken}, assumed: {why}."))?;
    }
    if let Some(limit) = all.clone().next() {
        writeln!(out)?;
        let by = format!("by the model {}: {}", limit.model.bar.name(), limit.model.reason);
        sentence(out, "Worst drops, ", &by)?;
    }
    for component in &assessment.components {
        component.limits.iter().try_for_each(|limit| worst_drop(of, component, limit, out))?;
    }
    Ok(())
}

/// Writes the verdict, and how many parts are behind it.
fn headline(assessment: &Assessment, out: &mut dyn Write) -> io::Result<()> {
    let count = |verdict: Verdict| assessment.components.iter().filter(|c| c.verdict == verdict).count();
    let (product, all) = (shown(&assessment.product, 60), assessment.components.len());
    let reliable = assessment.components.iter().find(|component| component.verdict == Verdict::Reliable);
    let why = reliable.and_then(|component| component.limits.iter().find_map(LimitAssessment::why_reliable));
    let verdict = match (count(Verdict::Unsafe), count(Verdict::Undecided)) {
        (0, 0) if let Some(why) = why => {
            format!("is reliable: {} of {all} components, {why}", count(Verdict::Reliable))
        }
        (0, 0) => "is safe: every limit holds in the worst drop".to_owned(),
        (0, undecided) => format!("is undecided: {undecided} of {all} components"),
        (failing, 0) => format!("is UNSAFE: {failing} of {all} components"),
        (failing, undecided) => format!("is UNSAFE: {failing} of {all} components, {undecided} undecided"),
    };
    let body = as_a(assessment).map_or(String::new(), |said| format!(", {said}"));
    sentence(out, &format!("{product} "), &format!("{verdict}{body}"))
}

/// Names the body that a product is answered as, where its file does not state it.
fn as_a(assessment: &Assessment) -> Option<String> {
    let body = assessment.assumed.iter().find(|assumed| **assumed == Assumed::Bar)?;
    let [_, taken, why] = body.told();
    Some(format!("as a {taken}; {why}"))
}

/// Writes a row for each limit, in the unit in which the file gives it.
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
    let mut rows = vec![heads.map(str::to_owned).to_vec()];
    for (component, given) in assessment.components.iter().zip(&file.components) {
        for (i, limit) in component.limits.iter().enumerate() {
            let first = if i == 0 { name(component) } else { String::new() };
            let written = given.limits.unit(limit.limit, limit.unit);
            let of = |value: Option<f64>| value.map_or("-".to_owned(), |value| in_words(limit.unit, written, value));
            // A demand of nothing has no share.
            let share = limit.margin.filter(|margin| margin.is_finite());
            rows.push(vec![
                first,
                limit.limit.name().to_owned(),
                verdict(limit.verdict).to_owned(),
                of(Some(limit.allowed)),
                of(limit.demand),
                limit.margin.map_or("-".to_owned(), margin),
                share.map_or("-".to_owned(), |_| percent(limit.uncertainty)),
                of(limit.bound),
                of(limit.clatter_free),
                of(limit.other_law),
            ]);
        }
    }
    writeln!(out)?;
    Table { keys: 2, headings: 1, texts: 3, last_is_text: false, least: 9, rows }.write(out)
}

/// Writes a row for each of several drops: the limit with the least margin.
fn landings(file: &ProductFile, assessment: &Assessment, out: &mut dyn Write) -> io::Result<()> {
    let tilt = if file.is_box() { "off, deg" } else { "tilt, deg" };
    let heads = ["drop", tilt, "verdict", "tightest", "limit", "demand", "margin"];
    let mut rows = vec![heads.map(str::to_owned).to_vec()];
    let speeds = |landing: &LandingAssessment| {
        let optional = landing.optional.iter().map(|(_, range)| range.map(f64::to_bits));
        (landing.speed_m_s.map(f64::to_bits), optional.collect::<Vec<_>>())
    };
    let alike = assessment.landings.windows(2).all(|two| speeds(&two[0]) == speeds(&two[1]));
    for landing in &assessment.landings {
        let Some(tightest) = landing.tightest() else { continue };
        let name = |component: &&Component| component.name == tightest.component;
        let Some(component) = file.components.iter().find(name) else { continue };
        let unit = tightest.limit.unit();
        let of = |value: f64| in_words(unit, component.limits.unit(tightest.limit, unit), value);
        let [slow, fast] = landing.speed_m_s.map(four);
        let optional = |(input, range): &(Input, [f64; 2])| {
            let (phrase, unit) = (input.row().optional.map_or("", |optional| optional.phrase), input.row().unit);
            match range.map(four) {
                [least, most] if least == most => format!(", {phrase} {least} {unit}"),
                [least, most] => format!(", {phrase} {least} to {most} {unit}"),
            }
        };
        let optional: String = landing.optional.iter().map(optional).collect();
        rows.push(vec![
            match &landing.landing {
                on if alike => on.to_string(),
                on if slow == fast => format!("{on}, {slow} m/s{optional}"),
                on => format!("{on}, {slow} to {fast} m/s{optional}"),
            },
            match (landing.tilt_deg.map(|tilts| tilts.map(neat)), landing.tolerance_deg) {
                (Some([least, most]), _) if least < most => format!("{} to {}", given(least), given(most)),
                (Some([_, most]), _) => given(most),
                (None, tolerance) => tolerance.map_or("-".to_owned(), |degrees| given(neat(degrees))),
            },
            verdict(landing.verdict).to_owned(),
            shown(&tightest.component, 24),
            tightest.limit.name().to_owned(),
            tightest.demand.map_or("-".to_owned(), of),
            tightest.margin.map_or("-".to_owned(), margin),
        ]);
    }
    writeln!(out)?;
    if let Some(source) = assessment.landings.iter().find_map(|landing| landing.source) {
        let by_hand = assessment.landings.iter().filter(|landing| landing.source.is_none()).count();
        let first =
            if by_hand > 0 { format!("Drops: {by_hand} by hand, the others of ") } else { "Drops of ".to_owned() };
        sentence(out, &first, source)?;
    }
    Table { keys: 1, headings: 1, texts: 5, last_is_text: false, least: 9, rows }.write(out)
}

/// Writes the drop behind a demand: why the limit is undecided, the further facts, and the command that repeats the drop.
fn worst_drop(
    (path, accuracy): (&str, &Accuracy),
    component: &ComponentAssessment,
    limit: &LimitAssessment,
    out: &mut dyn Write,
) -> io::Result<()> {
    let first = format!("{}, {}: ", name(component), limit.limit.name());
    match &limit.worst_case {
        Some(worst) => {
            let text = format!("{}; impact {} at {} ms", drop(worst), worst.impact, four(1e3 * worst.time_s));
            sentence(out, &first, &text)?;
        }
        None => sentence(out, &first, "no drop is answered")?,
    }
    if let Some(why) = limit.why_reliable() {
        sentence(out, "  reliable: ", &why)?;
    }
    match (limit.why_undecided(), limit.governs) {
        (Some(reason), _) => sentence(out, "  undecided: ", &reason)?,
        (None, Some(other)) => sentence(out, &format!("  {}: ", verdict(limit.verdict)), &format!("by {other}"))?,
        (None, None) => {}
    }
    if let Some(change) = &limit.decided_by {
        sentence(out, "  decided by: ", change)?;
    }
    limit.notes.iter().try_for_each(|note| sentence(out, "  note: ", &note.to_string()))?;
    let Some(worst) = &limit.worst_case else { return Ok(()) };
    let short = repeat(path, &component.name, limit.limit, accuracy).filter(|_| !worst.drawn);
    writeln!(out, "  {}", short.unwrap_or_else(|| worst.command()))
}

/// Writes the margins of several products, one column each.
pub(super) fn side_by_side(files: &[PathBuf], answers: &[Answer<'_>], out: &mut dyn Write) -> io::Result<()> {
    let assessments: Vec<&Assessment> = answers.iter().map(|answer| &answer.assessment).collect();
    let mut rows: Vec<(String, &'static str)> = Vec::new();
    for assessment in &assessments {
        for component in &assessment.components {
            for limit in &component.limits {
                let row = (component.name.clone(), limit.limit.name());
                if !rows.contains(&row) {
                    rows.push(row);
                }
            }
        }
    }
    // Products of one name are distinguished by their files.
    let alike = |name: &str| assessments.iter().filter(|a| shown(&a.product, 20) == shown(name, 20)).count() > 1;
    let head = |(a, file): (&&Assessment, &PathBuf)| {
        if alike(&a.product) { path(file) } else { shown(&a.product, 20) }
    };
    let heads: Vec<_> = assessments.iter().zip(files).map(head).collect();
    let mut table = vec![
        ["component".to_owned(), "margin of".to_owned()].into_iter().chain(heads.iter().cloned()).collect::<Vec<_>>(),
    ];
    for (name, limit) in &rows {
        let cell = |assessment: &&Assessment| {
            let component = assessment.components.iter().find(|c| c.name == *name);
            let found = component.and_then(|c| c.limits.iter().find(|l| l.limit.name() == *limit));
            found.map_or("-".to_owned(), |limit| limit.margin.map_or("?".to_owned(), margin))
        };
        let first = [shown(name, 24), (*limit).to_owned()];
        table.push(first.into_iter().chain(assessments.iter().map(cell)).collect());
    }
    let verdicts = assessments.iter().map(|a| verdict(a.verdict).to_owned());
    table.push([String::new(), "verdict".to_owned()].into_iter().chain(verdicts).collect());
    Table { keys: 2, headings: 1, texts: 2, last_is_text: false, least: 10, rows: table }.write(out)?;
    let said = assessments.iter().zip(&heads).filter_map(|(assessment, head)| Some((head, as_a(assessment)?)));
    for (n, (head, said)) in said.enumerate() {
        if n == 0 {
            writeln!(out)?;
        }
        sentence(out, &format!("{head}: "), &said)?;
    }
    Ok(())
}
