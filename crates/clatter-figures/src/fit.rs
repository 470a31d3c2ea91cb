//! Measured beside computed: strikes, heights and accelerations of one drop.

use clatter::End;
use clatter_fit::{Fit, RecordFit};
use clatter_product::STANDARD_GRAVITY_M_S2;

use crate::FigureError;
use crate::axis::Axis;
use crate::chart::{Axes, Chart};
use crate::paper::{Paper, SMALL};
use crate::record::thinned;
use crate::style::{Anchor, BLUES, GRAY, INK, Ink, Label, RUST, width};

/// Lines of ends a and b.
const ENDS: [&str; 2] = [BLUES[7], RUST];
const LEFT: f64 = 52.0;
const WIDE: f64 = 451.0;
const HIGH: f64 = 112.0;
const GAP: f64 = 44.0;
const TOP: f64 = 30.0;
/// Room between panels that the last one does not need.
const LAST: f64 = 12.0;
const MEASURED: Ink = Ink::line(GRAY, 1.6);
const COMPUTED: Ink = Ink::line(RUST, 0.9);

/// Draws each record as a panel: the measured values, and the drop that is nearest to them, in time since its first
/// touch.
///
/// ```
/// use clatter_fit::bounces;
/// let found = bounces(&[1.0, 1.4, 1.6, 1.7], 9.81, Some(1e-4))?;
/// assert!(clatter_figures::fit(&found)?.contains("measured"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn fit(fit: &Fit) -> Result<String, FigureError> {
    #[expect(clippy::cast_precision_loss, reason = "a few")]
    let high = TOP + fit.records.len() as f64 * (HIGH + GAP) - LAST;
    let mut paper = Paper::new(520.0, high);
    legend(&mut paper, fit);
    let mut top = TOP;
    for record in &fit.records {
        match record.curves.len() {
            0 => strikes(&mut paper, top, record, &fit.computed),
            2 => values(&mut paper, top, record, 1e3, "height, mm"),
            _ => values(&mut paper, top, record, 1.0 / STANDARD_GRAVITY_M_S2, "acceleration, gn"),
        }
        top += HIGH + GAP;
    }
    paper.finish("Measured and computed drop")
}

/// Draws the key of the kinds of marks and lines that occur.
fn legend(paper: &mut Paper, fit: &Fit) {
    let accelerations = fit.records.iter().filter(|record| record.curves.len() == 1).count();
    let mut x = LEFT;
    let y = 16.0;
    let words = |paper: &mut Paper, x: &mut f64, text: &str| {
        paper.text([*x, y], text, Label { anchor: Anchor::Start, ..SMALL });
        *x += width(text, SMALL.size) + 16.0;
    };
    let line = |paper: &mut Paper, x: &mut f64, ink: Ink<'_>, text: &str| {
        paper.line([*x, y - 2.8], [*x + 16.0, y - 2.8], ink);
        *x += 20.0;
        words(paper, x, text);
    };
    if accelerations < fit.records.len() {
        line(paper, &mut x, Ink::line(ENDS[0], 1.2), "end *a*");
        line(paper, &mut x, Ink::line(ENDS[1], 1.2), "end *b*");
        paper.circle([x, y - 2.8], 2.2, mark(INK, true));
        x += 6.0;
        words(paper, &mut x, "measured");
        line(paper, &mut x, Ink::line(INK, 1.0), "computed");
    }
    if accelerations > 0 {
        let of = if accelerations < fit.records.len() { " acceleration" } else { "" };
        line(paper, &mut x, MEASURED, &format!("measured{of}"));
        line(paper, &mut x, COMPUTED, &format!("computed{of}"));
    }
}

fn mark(color: &str, is_used: bool) -> Ink<'_> {
    if is_used { Ink::fill(color) } else { Ink { stroke: color, width: 0.8, ..Ink::fill("#ffffff") } }
}

fn frame<'a>(paper: &mut Paper, top: f64, [from, to]: [f64; 2], [low, high]: [f64; 2], title: &'a str) -> Chart<'a> {
    let x = Axis::linear(1e3 * from, 1e3 * to, "time since the first touch, ms");
    let y = Axis { bare: title.is_empty(), ..Axis::linear(low, high, title) };
    Axes { corner: [LEFT, top], size: [WIDE, HIGH], x, y }.on(paper, 36.0)
}

/// Draws stems of computed strikes upward from the ground, and of measured ones to their marks.
fn strikes(paper: &mut Paper, top: f64, record: &RecordFit, computed: &[(f64, End)]) {
    let since = |time_s: f64| time_s - record.first_touch_s;
    let times = || record.strikes.iter().map(|strike| since(strike.measured.time_s));
    let (first, last) = (times().fold(0.0, f64::min), times().fold(0.0, f64::max));
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
    for strike in &record.strikes {
        let (at, color) = (1e3 * since(strike.measured.time_s), color(strike.measured.end));
        paper.line(chart.at(at, 1.4), chart.at(at, 2.2), Ink { dash: "2 2", ..Ink::line(color, 0.7) });
        paper.circle(chart.at(at, 2.2), 2.2, mark(color, strike.number.is_some()));
    }
    for (text, height) in [("measured", 2.2), ("computed", 0.7)] {
        let [x, y] = chart.at(1e3 * (first - 0.03 * span), height);
        paper.text([x - 4.0, y + 2.5], text, Label { anchor: Anchor::End, ..SMALL });
    }
    chart.border(paper);
}

/// Draws dots for measured heights, and lines for computed values and for accelerations.
fn values(paper: &mut Paper, top: f64, record: &RecordFit, factor: f64, title: &str) {
    let dots = record.curves.len() == 2;
    let all = || record.curves.iter().flatten();
    let since = |time_s: f64| time_s - record.first_touch_s;
    let (from, to) =
        all().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), p| (a.min(since(p[0])), b.max(since(p[0]))));
    let (low, high) = all().flat_map(|p| [p[1], p[2]]).fold((0.0, 0.0), |(a, b): (f64, f64), v| (a.min(v), b.max(v)));
    let room = 0.06 * (high - low).max(1e-9);
    let chart = frame(paper, top, [from, to], [factor * (low - room), factor * (high + room)], title);
    chart.level(paper, 0.0, Ink::line(GRAY, 0.6));
    for (curve, color) in record.curves.iter().zip(ENDS) {
        let [measured, computed] = [1, 2].map(|i| {
            let points: Vec<_> = curve.iter().map(|p| (1e3 * since(p[0]), factor * p[i])).collect();
            thinned(&points, 1e3 * from, 1e3 * to)
        });
        if dots {
            for (x, y) in measured {
                paper.circle(chart.at(x, y), 1.4, mark(color, true));
            }
        } else {
            chart.curve(paper, measured.into_iter(), MEASURED);
        }
        chart.curve(paper, computed.into_iter(), if dots { Ink::line(color, 0.9) } else { COMPUTED });
    }
    chart.border(paper);
}
