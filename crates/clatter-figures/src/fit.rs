//! Measured beside computed: strikes, heights and accelerations of one drop.

use clatter::End;

use crate::FigureError;
use crate::axis::Axis;
use crate::chart::{Axes, Chart};
use crate::paper::{Paper, SMALL};
use crate::style::{Anchor, BLUES, GRAY, INK, Ink, Label, RUST, width};

/// A measured strike.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Strike {
    /// Since the first touch of the computed drop.
    pub time_s: f64,
    /// The end that strikes, where it is known.
    pub end: Option<End>,
    /// Whether the fit rests on it.
    pub is_used: bool,
}

/// One record; times are since the first touch of the computed drop.
#[derive(Debug, Clone, PartialEq)]
pub enum Panel {
    /// Strikes: measured above, computed below.
    Strikes {
        /// As measured.
        measured: Vec<Strike>,
        /// As computed.
        computed: Vec<(f64, End)>,
    },
    /// Heights of ends a and b in m: time, measured and computed value.
    Heights(Vec<Vec<[f64; 3]>>),
    /// An acceleration in m/s²: time, measured and computed value.
    Acceleration(Vec<Vec<[f64; 3]>>),
}

/// Lines of ends a and b.
const ENDS: [&str; 2] = [BLUES[7], RUST];
const LEFT: f64 = 52.0;
const WIDE: f64 = 451.0;
const HIGH: f64 = 112.0;
const GAP: f64 = 44.0;
const TOP: f64 = 30.0;
/// Points of a curve at most: more than the page can show.
const MOST: usize = 2000;

/// Each record as a panel: what was measured, and the drop that is nearest to it.
///
/// ```
/// use clatter::End;
/// use clatter_figures::{FitPanel, FitStrike};
/// let measured = vec![FitStrike { time_s: 0.0, end: Some(End::A), is_used: true }];
/// let panel = FitPanel::Strikes { measured, computed: vec![(0.0, End::A), (1.2e-3, End::B)] };
/// assert!(clatter_figures::fit(&[panel])?.contains("measured"));
/// # Ok::<(), clatter_figures::FigureError>(())
/// ```
pub fn fit(panels: &[Panel]) -> Result<String, FigureError> {
    #[expect(clippy::cast_precision_loss, reason = "a few")]
    let high = TOP + panels.len() as f64 * (HIGH + GAP);
    let mut paper = Paper::new(520.0, high);
    legend(&mut paper);
    let mut top = TOP;
    for panel in panels {
        match panel {
            Panel::Strikes { measured, computed } => strikes(&mut paper, top, measured, computed),
            Panel::Heights(curves) => values(&mut paper, top, curves, [1e3, 1.0], "height, mm"),
            Panel::Acceleration(curves) => values(&mut paper, top, curves, [1.0, 0.0], "acceleration, m/s²"),
        }
        top += HIGH + GAP;
    }
    paper.finish("Measured and computed drop")
}

/// What marks and lines mean.
fn legend(paper: &mut Paper) {
    let mut x = LEFT;
    let y = 16.0;
    let words = |paper: &mut Paper, x: &mut f64, text: &str| {
        paper.text([*x, y], text, Label { anchor: Anchor::Start, ..SMALL });
        *x += width(text, SMALL.size) + 16.0;
    };
    for (end, color) in ["end *a*", "end *b*"].into_iter().zip(ENDS) {
        paper.line([x, y - 2.8], [x + 16.0, y - 2.8], Ink::line(color, 1.2));
        x += 20.0;
        words(paper, &mut x, end);
    }
    paper.circle([x, y - 2.8], 2.2, mark(INK, true));
    x += 6.0;
    words(paper, &mut x, "measured");
    paper.line([x, y - 2.8], [x + 16.0, y - 2.8], Ink::line(INK, 1.0));
    x += 20.0;
    words(paper, &mut x, "computed");
}

fn mark(color: &str, is_used: bool) -> Ink<'_> {
    if is_used { Ink::fill(color) } else { Ink { stroke: color, width: 0.8, ..Ink::fill("#ffffff") } }
}

fn frame<'a>(paper: &mut Paper, top: f64, [from, to]: [f64; 2], [low, high]: [f64; 2], title: &'a str) -> Chart<'a> {
    let x = Axis::linear(1e3 * from, 1e3 * to, "time since the first touch, ms");
    let y = Axis { bare: title.is_empty(), ..Axis::linear(low, high, title) };
    Axes { corner: [LEFT, top], size: [WIDE, HIGH], x, y }.on(paper, 36.0)
}

/// Stems of computed strikes upward from the ground, of measured ones to their marks.
fn strikes(paper: &mut Paper, top: f64, measured: &[Strike], computed: &[(f64, End)]) {
    let last = measured.iter().map(|strike| strike.time_s).fold(0.0, f64::max);
    let first = measured.iter().map(|strike| strike.time_s).fold(0.0, f64::min);
    let span = if last > first { last - first } else { 1e-3 };
    let chart = frame(paper, top, [first - 0.03 * span, last + 0.06 * span], [0.0, 3.0], "");
    let color = |end: Option<End>| match end {
        Some(End::A) => ENDS[0],
        Some(End::B) => ENDS[1],
        None => GRAY,
    };
    for &(time_s, end) in computed.iter().filter(|(time_s, _)| *time_s <= last + 0.06 * span) {
        paper.line(chart.at(1e3 * time_s, 0.0), chart.at(1e3 * time_s, 1.4), Ink::line(color(Some(end)), 1.2));
    }
    for strike in measured {
        let ink = Ink { dash: "2 2", ..Ink::line(color(strike.end), 0.7) };
        paper.line(chart.at(1e3 * strike.time_s, 1.4), chart.at(1e3 * strike.time_s, 2.2), ink);
        paper.circle(chart.at(1e3 * strike.time_s, 2.2), 2.2, mark(color(strike.end), strike.is_used));
    }
    for (text, height) in [("measured", 2.2), ("computed", 0.7)] {
        let [x, y] = chart.at(1e3 * (first - 0.03 * span), height);
        paper.text([x - 4.0, y + 2.5], text, Label { anchor: Anchor::End, ..SMALL });
    }
    chart.border(paper);
}

/// Dots for what was measured, lines for what was computed.
fn values(paper: &mut Paper, top: f64, curves: &[Vec<[f64; 3]>], [factor, dots]: [f64; 2], title: &str) {
    let all = || curves.iter().flatten();
    let (from, to) = all().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), p| (a.min(p[0]), b.max(p[0])));
    let (low, high) = all().flat_map(|p| [p[1], p[2]]).fold((0.0, 0.0), |(a, b): (f64, f64), v| (a.min(v), b.max(v)));
    let room = 0.06 * (high - low).max(1e-9);
    let chart = frame(paper, top, [from, to], [factor * (low - room), factor * (high + room)], title);
    chart.level(paper, 0.0, Ink::line(GRAY, 0.6));
    for (k, curve) in curves.iter().enumerate() {
        let color = if curves.len() == 2 { ENDS[k] } else { INK };
        let step = curve.len().div_ceil(MOST).max(1);
        let points = |i: usize| curve.iter().step_by(step).map(move |p| (1e3 * p[0], factor * p[i]));
        if dots > 0.0 {
            for (x, y) in points(1) {
                paper.circle(chart.at(x, y), 1.4, mark(color, true));
            }
        } else {
            chart.curve(paper, points(1), Ink::line(GRAY, 1.6));
        }
        chart.curve(paper, points(2), Ink::line(if dots > 0.0 { color } else { RUST }, 0.9));
    }
    chart.border(paper);
}
