//! This module shows measured drops next to the computed ones that are nearest.

use clatter_figures::{FigureError, fit, model_words, three, two};
use clatter_fit::{Comparison, Estimate, Fit, MeasuredDrop, RecordFit};
use clatter_product::ProductFile;
use clatter_record::{Between, Channel, Record};
use clatter_shock::{DampingRatio, Frequencies, Quantity, Spectrum};
use serde_json::{Value, json};

use crate::words::{end, minus, shown, span, sure_name};

/// Quality factor of the spectra, and natural frequencies to the octave.
const Q: f64 = 10.0;
const PER_OCTAVE: f64 = 24.0;

/// Returns where a measured drop differs from the file, one sentence each.
pub(super) fn differences(file: &ProductFile, drops: &[MeasuredDrop]) -> Vec<String> {
    let mut said = Vec::new();
    for drop in drops {
        let name = sure_name(&drop.name);
        match &drop.found {
            Ok(fit) => said.extend(fit.differs(file).iter().map(|beside| {
                let [what, measured, interval, stated] = words(beside);
                let interval = if interval.is_empty() { interval } else { format!(" (95 %: {interval})") };
                format!("{name}: the {what} was measured as {measured}{interval}; the verdict is for the {stated} that the file states.")
            })),
            Err(reason) => said.push(format!("{name}: {}.", minus(reason))),
        }
    }
    said
}

/// Returns the content of the section of each drop.
pub(super) fn sections(file: &ProductFile, drops: &[MeasuredDrop]) -> Vec<Value> {
    let section = |(i, drop): (usize, &MeasuredDrop)| {
        let files: Vec<String> = drop.files.iter().map(|file| sure_name(file)).collect();
        let fit = match &drop.found {
            Ok(fit) => fit,
            Err(reason) => return json!({ "name": sure_name(&drop.name), "files": files, "reason": minus(reason) }),
        };
        let rows: Vec<_> = fit.beside(file).iter().map(|beside| (words(beside), agreement(beside))).collect();
        let untold = fit.untold.iter().map(|untold| {
            let (what, factor, unit) = untold.quantity.said();
            let held = span([untold.held_at; 2], factor.recip(), unit);
            format!("{what}, held at {held}: {}", minus(&untold.reason))
        });
        json!({
            "name": sure_name(&drop.name),
            "files": files,
            "reason": null,
            "model": model_words(fit.model),
            "first": end(fit.first),
            "rows": rows,
            "untold": untold.collect::<Vec<_>>(),
            "notes": fit.notes.iter().map(|note| minus(note)).collect::<Vec<_>>(),
            "figure": figure(i),
            "spectra": accelerations(fit).map(|(k, record)| said_of_peaks(i, k, record)).collect::<Vec<_>>(),
        })
    };
    drops.iter().enumerate().map(section).collect()
}

/// Draws the figures of the sections: each drop, and the spectra of its accelerations.
pub(super) fn figures(drops: &[MeasuredDrop]) -> Result<Vec<(String, String)>, FigureError> {
    let mut figures = Vec::new();
    for (i, found) in drops.iter().enumerate().filter_map(|(i, drop)| Some((i, drop.found.as_ref().ok()?))) {
        figures.push((figure(i), fit(found)?));
        for (k, record) in accelerations(found) {
            if let Some([measured, computed]) = both(&record.curves[0]) {
                figures.push((spectra_of(i, k), two((&measured, "measured"), (&computed, "computed"))?));
            }
        }
    }
    Ok(figures)
}

fn figure(drop: usize) -> String {
    format!("measured-{}.svg", drop + 1)
}

fn spectra_of(drop: usize, record: usize) -> String {
    format!("measured-{}-spectra-{}.svg", drop + 1, record + 1)
}

/// Returns the records of an acceleration, by their number in the drop.
fn accelerations(fit: &Fit) -> impl Iterator<Item = (usize, &RecordFit)> {
    fit.records.iter().enumerate().filter(|(_, record)| record.curves.len() == 1)
}

/// Returns name, estimate, interval and stated value; the first two to two digits of the width of the interval.
fn words(beside: &Comparison<'_>) -> [String; 4] {
    let Estimate { quantity, value, interval, .. } = beside.estimate;
    let (what, factor, unit) = quantity.said();
    let with = |text: String| match unit {
        "deg" => format!("{text}°"),
        unit => format!("{text} {unit}").trim_end().to_owned(),
    };
    let stated = beside.stated.map_or_else(String::new, |stated| with(span(stated, factor.recip(), "")));
    let Some([from, to]) = interval.map(|interval| interval.map(|x| factor * x)) else {
        return [what.to_owned(), with(span([*value; 2], factor.recip(), "")), String::new(), stated];
    };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 9")]
    let places = (1.0 - (to - from).log10().floor()).clamp(0.0, 9.0) as usize;
    let digits = |x: f64| format!("{x:.places$}").replace('-', "−");
    [what.to_owned(), with(digits(factor * value)), with(format!("{} to {}", digits(from), digits(to))), stated]
}

fn agreement(beside: &Comparison<'_>) -> &'static str {
    match beside.agrees {
        Some(true) => "agrees",
        Some(false) if beside.estimate.quantity.is_of_product() => "differs",
        Some(false) => "beyond",
        None => "",
    }
}

/// Returns the largest accelerations, measured and computed, and the picture of the spectra.
fn said_of_peaks(drop: usize, record: usize, found: &RecordFit) -> Value {
    let curve = &found.curves[0];
    let peak = |i: usize| curve.iter().map(|row| row[i].abs()).fold(0.0, f64::max);
    let [measured, computed] = [peak(1), peak(2)];
    let unit = clatter_product::Unit::MeterPerSecondSquared;
    json!({
        "file": both(curve).map(|_| spectra_of(drop, record)),
        "measured": shown(unit, measured),
        "computed": shown(unit, computed),
        "off": format!("{} %", three(100.0 * found.scatter / measured)),
    })
}

/// Computes shock response spectra of the measured and of the computed acceleration, of the same samples up to a third of their rate;
/// nothing where a record is too short for one.
fn both(curve: &[[f64; 3]]) -> Option<[Spectrum; 2]> {
    #[expect(clippy::cast_precision_loss, reason = "at most a million samples")]
    let step_s = (curve.last()?[0] - curve.first()?[0]) / (curve.len() - 1) as f64;
    let channel = |i: usize| ("", curve.iter().map(|row| row[i]).collect());
    let record = Record::from_samples(0.0, step_s, vec![channel(1), channel(2)]).ok()?;
    let high = (3.0 * step_s).recip();
    // Below this frequency a record shows more of its surroundings than of the shock.
    let low = record.channels()[0].times().duration_s().recip().max(10.0);
    let frequencies = Frequencies::per_octave(low, high, PER_OCTAVE).ok()?;
    let damping = DampingRatio::from_quality_factor(Q).ok()?;
    let of = |channel: &Channel| {
        let quantity = Quantity::AbsoluteAcceleration;
        channel.spectrum(&frequencies, damping, quantity, Between::BandLimited, |_| ()).ok()
    };
    Some([of(&record.channels()[0])?, of(&record.channels()[1])?])
}
