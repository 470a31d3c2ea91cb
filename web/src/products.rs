//! This module reads, assesses and draws product files.

use clatter::End;
use clatter_answer::assess as assess_of;
use clatter_assess::{Accuracy, Assessment, LimitAssessment, Portrait, repeat};
use clatter_figures::FigureError;
use clatter_product::{Component, LimitKind, Model, ProductFile, visible};
use serde::Serialize;

use crate::{Progress, Reply, json, quoted, text};

/// The worked products, each under the name of its file: a bar first, which takes least.
pub(crate) const WORKED: [[&str; 2]; 6] = [
    ["scanner-wand.toml", include_str!("../scanner-wand.toml")],
    ["handheld-terminal.toml", include_str!("../../reports/examples/handheld-terminal.toml")],
    ["phone.toml", include_str!("../../reports/examples/phone.toml")],
    ["laptop.toml", include_str!("../../reports/examples/laptop.toml")],
    ["tablet.toml", include_str!("../../reports/examples/tablet.toml")],
    ["handheld-transit.toml", include_str!("../../reports/examples/handheld-transit.toml")],
];

/// Reads a product, and the oddities of its file.
pub(crate) fn read(name: &str, given: &str) -> Result<(ProductFile, Vec<String>), String> {
    let (file, odd) = ProductFile::read_warned(given, name).map_err(text)?;
    let mut warnings = if odd.warnings().is_empty() { Vec::new() } else { vec![odd.to_string()] };
    if !file.records.is_empty() {
        warnings.push("the records that the file names are not read here: the command reads them".to_owned());
    }
    if file.reliability.is_some() {
        warnings.push("no products are drawn here, as [verdict] of the file asks: the command draws them".to_owned());
    }
    Ok((file, warnings))
}

/// The unit of a limit, its worst drop in words, and the command that answers that once more.
#[derive(Debug, Serialize)]
struct Shown {
    unit: &'static str,
    /// One of the unit in SI.
    si: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    drop: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    command: Option<String>,
}

/// Returns the unit in which the file gives a limit, else the customary one, and one of it in SI.
fn unit_of(component: &Component, limit: &LimitAssessment) -> (&'static str, f64) {
    let unit = component.limits.unit(limit.limit, limit.unit).unwrap_or(limit.unit.customary());
    (unit.name, unit.to_si(1.0))
}

/// The first answer about a plate or a box takes one of so many drops of the search.
const FIRST: usize = 8;

/// Returns the verdicts, and the data for each limit; of a plate or a box with the picture. A `quick` answer is by instant impacts, or by
/// the first drops of a plate or a box.
pub(crate) fn assess(name: &str, given: &str, quick: bool, progress: Progress<'_>) -> Result<Reply, String> {
    let (file, warnings) = read(name, given)?;
    let is_plate = file.product.body.is_wide();
    let model = (quick && !is_plate).then_some(Model::FiniteTilt);
    let accuracy = Accuracy { model, ..Accuracy::default() };
    let answer = assess_of::watched(&file, &accuracy, &|done, all| {
        progress(done, all);
        !(quick && is_plate) || FIRST * done < all
    });
    let answer = answer.map_err(|error| format!("{}: {error}", visible(name)))?;
    let shown = file.components.iter().zip(&answer.assessment.components).map(|(component, assessed)| {
        let shown = |limit: &LimitAssessment| {
            let (unit, si) = unit_of(component, limit);
            let command = limit.demand.and_then(|_| repeat(name, &component.name, limit.limit, &accuracy));
            let drop = limit.worst_case.as_ref().map(clatter_answer::drop_in_words);
            Shown { unit, si, drop, command }
        };
        assessed.limits.iter().map(shown).collect::<Vec<_>>()
    });
    let shown = serde_json::to_value(shown.collect::<Vec<_>>()).map_err(text)?;
    let model = model.map_or_else(String::new, |model| format!(" --model={}", model.name()));
    let command = format!("clatter assess {}{model} --format=json", quoted(name));
    // No command repeats an answer that is not complete.
    let command = (!quick || !is_plate).then_some(command);
    let mut figures = Vec::new();
    if is_plate {
        let drawing = clatter_figures::assessed(&file, &answer.assessment, &[]).map_err(text)?;
        figures.push(("From above, with the center of mass and the lines of percussion".to_owned(), drawing));
    }
    Ok(Reply { answer: Some(json(&answer)?), command, warnings, figures, shown })
}

/// Draws where each part would be safe, and for each part its worst drop over time and its demand over the tilt.
pub(crate) fn figures(name: &str, given: &str, progress: Progress<'_>) -> Result<Reply, String> {
    let (file, _) = read(name, given)?;
    let watch = |done, all| {
        progress(done, all);
        true
    };
    let assessment = clatter_assess::assess_watched(&file, &Accuracy::default(), &watch).map_err(text)?;
    let portraits = clatter_assess::portraits(&file, &assessment);
    let zones_m: Vec<_> = portraits.iter().map(|portrait| portrait.zone_m).collect();
    let figures = drawn(&file, &assessment, &portraits).map_err(text)?;
    let command = format!("clatter assess {} -o report.pdf", quoted(name));
    Ok(Reply { figures, command: Some(command), ..Reply::shown(zones_m)? })
}

fn drawn(
    file: &ProductFile,
    assessment: &Assessment,
    portraits: &[Portrait],
) -> Result<Vec<(String, String)>, FigureError> {
    let mut figures = Vec::new();
    if !file.product.body.is_wide() {
        figures.push((
            "Where each part would be safe".to_owned(),
            clatter_figures::assessed(file, assessment, portraits)?,
        ));
    }
    for ((component, assessed), portrait) in file.components.iter().zip(&assessment.components).zip(portraits) {
        let limit = assessed.tightest();
        let (unit, si) = unit_of(component, limit);
        let what = match limit.limit {
            LimitKind::AngularVelocityChange => "change of *ω*",
            kind => kind.measured(limit.unit),
        };
        let title = format!("{what}, {unit}");
        let allowed = limit.allowed / si;
        let points: Vec<_> = portrait.history.iter().map(|(time_s, value)| (1e3 * time_s, value / si)).collect();
        let impacts: Vec<f64> = portrait.impacts_s.iter().map(|time_s| 1e3 * time_s).collect();
        let titles = ["time since the first touch, ms", &title];
        let drawing = clatter_figures::history(&points, &impacts, allowed, titles)?;
        figures.push((format!("{}: its worst drop", component.name), drawing));
        if portrait.over_tilt.is_empty() {
            continue;
        }
        let curve = |(first, curve): &(End, Vec<clatter_assess::Point>)| {
            let points = curve.iter().map(|point| (point.tilt_rad.to_degrees(), allowed * point.share)).collect();
            (if *first == End::A { "end *a* first" } else { "end *b* first" }, points)
        };
        let curves: Vec<(&str, Vec<_>)> = portrait.over_tilt.iter().map(curve).collect();
        let titles = ["tilt at the first touch, degrees", &title];
        let drawing = clatter_figures::over_tilt(&curves, allowed, titles)?;
        figures.push((format!("{}: over the tilt", component.name), drawing));
    }
    Ok(figures)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The page divides answers in SI by the size of the unit in which the file gives the limit.
    #[test]
    fn answers_are_shown_in_the_units_of_the_file() {
        let [_, tablet] = *WORKED.iter().find(|[name, _]| *name == "tablet.toml").unwrap();
        let reply = assess("tablet.toml", tablet, true, &|_, _| ()).unwrap();
        let units: Vec<(&str, f64)> = reply
            .shown
            .as_array()
            .unwrap()
            .iter()
            .flat_map(|part| part.as_array().unwrap())
            .map(|limit| (limit["unit"].as_str().unwrap(), limit["si"].as_f64().unwrap()))
            .collect();
        assert_eq!(units, [("mm", 1e-3), ("gn", 9.806_65), ("m/s", 1.0), ("rad/s", 1.0)]);
    }
}
