//! Errors of models on measured tosses: corners over time, and the velocity of the second flight.

use clatter_figures::FigureError;
use clatter_figures::draw::{Axes, Axis, BLUES, GRAY, INK, Ink, Paper, RUST};

/// A model in the first panel.
#[derive(Debug)]
pub struct OverTime<'a> {
    /// Name of the model.
    pub name: &'a str,
    /// True for a model with friction.
    pub friction: bool,
    /// Error of corners: first quartile, median and third quartile at each sample.
    pub corners_mm: Vec<[f64; 3]>,
}

/// Draws errors over time, and velocities foretold over measured ones, in m/s: by the first model, which has friction,
/// and by the second, which has none.
pub fn tosses(
    models: &[OverTime<'_>],
    step_ms: f64,
    [with, without]: [&[(f64, f64)]; 2],
) -> Result<String, FigureError> {
    let mut paper = Paper::new(465.0, 250.0);
    let time = |sample: usize| step_ms * (f64::from(u32::try_from(sample).unwrap_or(u32::MAX)) + 0.5);
    let end = models.first().map_or(1.0, |model| time(model.corners_mm.len()));
    let axes = Axes {
        corner: [36.0, 6.0],
        size: [232.0, 160.0],
        x: Axis::linear(0.0, end, "time since the first touch, in ms"),
        y: Axis::linear(0.0, 25.0, "corners off by, in mm"),
    };
    let chart = axes.on(&mut paper, 24.0);
    let points = |model: &OverTime<'_>, which: usize| {
        model.corners_mm.iter().enumerate().map(|(k, quartiles)| (time(k), quartiles[which])).collect::<Vec<_>>()
    };
    if let Some(own) = models.first() {
        let back = points(own, 2).into_iter().rev();
        chart.area(&mut paper, points(own, 0).into_iter().chain(back).collect(), BLUES[1]);
    }
    let mut key = Vec::new();
    for (i, model) in models.iter().enumerate() {
        let ink = ink(i, model.friction);
        chart.curve(&mut paper, points(model, 1).into_iter(), ink);
        key.push((ink, format!("{}, {}", model.name, if model.friction { "with friction" } else { "no friction" })));
    }
    chart.border(&mut paper);
    let half = key.len().div_ceil(2);
    for (column, lines) in key.chunks(half).enumerate() {
        let lines: Vec<_> = lines.iter().map(|(ink, name)| (*ink, name.as_str())).collect();
        paper.key([if column == 0 { 36.0 } else { 190.0 }, 208.0], &lines);
    }
    let range = |title| Axis::linear(-0.6, 0.6, title);
    let axes = Axes {
        corner: [314.0, 6.0],
        size: [148.0, 160.0],
        x: range("measured, in m/s"),
        y: range("vertical velocity foretold, in m/s"),
    };
    let chart = axes.on(&mut paper, 24.0);
    chart.curve(&mut paper, [(-0.6, -0.6), (0.6, 0.6)].into_iter(), Ink::line(GRAY, 0.8));
    for (points, fill) in [(without, BLUES[2]), (with, BLUES[7])] {
        for (measured, predicted) in points {
            chart.mark(&mut paper, *measured, *predicted, fill);
        }
    }
    chart.border(&mut paper);
    paper.finish(
        "Measured tosses of a cube beside models: errors of corners over time, and the velocity of the second flight",
    )
}

/// Returns the line of a model: the first two are the box of the product; those with friction are solid.
fn ink(model: usize, friction: bool) -> Ink<'static> {
    let color = [BLUES[7], INK, RUST, GRAY][model / 2 % 4];
    let width = if model < 2 { 2.2 } else { 1.1 };
    if friction { Ink::line(color, width) } else { Ink { dash: "3 2", ..Ink::line(color, width) } }
}
