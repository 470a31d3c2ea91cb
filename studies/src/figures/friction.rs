//! What friction of the ground does to a box: values with friction over those without, over the tilt.

use clatter_figures::FigureError;
use clatter_figures::draw::{Axes, Axis, BLUES, GUIDE, Ink, LABEL, Paper};

use crate::friction::{FRICTIONS, Thickness};

/// Width and height of a panel, and the room from one to the next.
const SIZE: [f64; 2] = [126.0, 104.0];
const APART: [f64; 2] = [148.0, 124.0];
const INKS: [Ink<'_>; 3] = [Ink::line(BLUES[3], 1.1), Ink::line(BLUES[5], 1.3), Ink::line(BLUES[8], 1.5)];

/// Draws a column for each thickness and a row for each quantity, in each a curve for each coefficient.
pub(crate) fn friction(thicknesses: &[Thickness]) -> Result<String, FigureError> {
    let mut paper = Paper::new(465.0, 420.0);
    let tilts = || thicknesses.iter().flat_map(|thickness| &thickness.tilts);
    let over = |which: usize| tilts().flat_map(move |tilt| tilt.with.map(|with| with[which] / tilt.without[which]));
    let degrees = tilts().map(|tilt| tilt.degrees);
    let (from, to) = degrees.fold((f64::INFINITY, 0.0_f64), |(from, to), tilt| (from.min(tilt), to.max(tilt)));
    let linear = |which: usize, title| {
        let (low, high) = over(which).fold((1.0_f64, 1.0_f64), |(low, high), v| (low.min(v), high.max(v)));
        Axis::linear((10.0 * low - 0.2).floor() / 10.0, (10.0 * high + 0.2).ceil() / 10.0, title)
    };
    let rows =
        [linear(0, "corner"), linear(1, "part along *z*"), Axis::log_over(over(2).chain([1.0]), 3.0, "part along *x*")];
    let mut top = 18.0;
    for (which, y) in rows.into_iter().enumerate() {
        let mut left = 40.0;
        for (column, thickness) in thicknesses.iter().enumerate() {
            let x = Axis::log(from, to, if which + 1 == rows.len() { "tilt in degrees" } else { "" });
            let title = if column == 0 { y.title } else { "" };
            let chart = Axes { corner: [left, top], size: SIZE, x, y: Axis { title, ..y } }.on(&mut paper, 26.0);
            chart.level(&mut paper, 1.0, GUIDE);
            for (k, ink) in INKS.into_iter().enumerate() {
                let of = thickness.tilts.iter().map(|tilt| (tilt.degrees, tilt.with[k][which] / tilt.without[which]));
                chart.curve(&mut paper, of, ink);
            }
            chart.border(&mut paper);
            if which == 0 {
                let title = format!("thickness {:.1} of the width", thickness.ratio);
                paper.text([left + 0.5 * SIZE[0], top - 6.0], &title, LABEL);
            }
            left += APART[0];
        }
        top += APART[1];
    }
    for (k, (friction, ink)) in FRICTIONS.into_iter().zip(INKS).enumerate() {
        paper.key([40.0 + [0.0, 1.0, 2.0][k] * APART[0], 416.0], &[(ink, format!("*μ* = {friction}").as_str())]);
    }
    paper.finish("Values with friction over those without, over the tilt: corner, part along the thickness, part along the length")
}
