//! Tools side by side on four bars: the time for a scene, the number of impacts, the error of the largest shock.

use clatter_figures::FigureError;
use clatter_figures::draw::{Anchor, Axes, Axis, BLUES, GRAY, INK, Ink, LABEL, Label, Paper, RUST, SMALL};

/// The correctness of a count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dot {
    /// Right from every start.
    Right,
    /// Right from this start; wrong from others that differ by less than a step.
    ByChance,
    /// The count is wrong.
    Wrong,
}

impl Dot {
    fn fill(self) -> &'static str {
        match self {
            Self::Right => BLUES[7],
            Self::ByChance => "#ffffff",
            Self::Wrong => RUST,
        }
    }
}

/// A row of the figure.
#[derive(Debug)]
pub struct Tool<'a> {
    /// Name of the tool.
    pub name: &'a str,
    /// Impacts, their correctness, and ms a scene.
    pub bars: [(u64, Dot, f64); 4],
    /// Error of the largest shock, in words.
    pub error: String,
}

/// Height of a row.
const ROW: f64 = 11.5;
const START: Label = Label { anchor: Anchor::Start, ..SMALL };
const END: Label = Label { anchor: Anchor::End, ..SMALL };

/// Draws a row a tool, with a dot for the time of each bar.
pub fn tools(rows: &[Tool<'_>], designs: [[f64; 2]; 4]) -> Result<String, FigureError> {
    let height = rows.iter().fold(0.0, |h, _| h + ROW);
    let times = || rows.iter().flat_map(|row| row.bars.iter().map(|bar| bar.2));
    let axes = Axes {
        corner: [106.0, 34.0],
        size: [186.0, height],
        x: Axis {
            title: "time a scene, in ms",
            ..Axis::log_over(times().flat_map(|ms| [0.8 * ms, 1.25 * ms]), 12.0, "")
        },
        y: Axis { bare: true, ..Axis::linear(0.0, 1.0, "") },
    };
    let columns = [312.0, 338.0, 364.0, 390.0];
    let bottom = axes.corner[1] + height;
    let mut paper = Paper::new(465.0, bottom + 44.0);
    let chart = axes.on(&mut paper, 0.0);
    paper.text([0.5 * (columns[0] + columns[3]), 10.0], "impacts, bar by bar", LABEL);
    paper.text([462.0, 10.0], "largest shock", Label { anchor: Anchor::End, ..LABEL });
    paper.text([462.0, 24.0], "off by", END);
    for (x, [q, _]) in columns.into_iter().zip(designs) {
        paper.text([x, 24.0], &format!("*q* {q}"), Label { color: GRAY, ..SMALL });
    }
    let mut y = axes.corner[1] + 0.5 * ROW;
    for (i, row) in rows.iter().enumerate() {
        if i > 0 {
            paper.line([0.0, y - 0.5 * ROW], [465.0, y - 0.5 * ROW], Ink::line("#e3e7eb", 0.6));
        }
        paper.plain([2.0, y + 2.8], row.name, START);
        for ((impacts, dot, ms), x) in row.bars.iter().zip(columns) {
            let at = [chart.at(*ms, 0.0)[0], y];
            paper.circle(at, 2.4, Ink { stroke: INK, width: 0.7, ..Ink::fill(dot.fill()) });
            let color = if *dot == Dot::Wrong { RUST } else { INK };
            let mark = if *dot == Dot::ByChance { "\u{2009}?" } else { "" };
            paper.text([x, y + 2.8], &format!("{impacts}{mark}"), Label { color, ..SMALL });
        }
        paper.plain([462.0, y + 2.8], &row.error, END);
        y += ROW;
    }
    chart.border(&mut paper);
    let words = ["right count", "right, but not from every start within a step (?)", "wrong count"];
    for ((dot, word), x) in [Dot::Right, Dot::ByChance, Dot::Wrong].into_iter().zip(words).zip([110.0, 180.0, 366.0]) {
        paper.circle([x, bottom + 37.2], 2.8, Ink { stroke: INK, width: 0.7, ..Ink::fill(dot.fill()) });
        paper.text([x + 7.0, bottom + 40.0], word, START);
    }
    paper.finish("Tools side by side: time, impacts and the error of the largest shock on four bars")
}
