//! Charts of plotters with our axes, their series cut where they leave the frame.

use plotters::chart::{ChartBuilder, ChartContext};
use plotters::coord::cartesian::Cartesian2d;
use plotters::style::{Color, IntoFont, RGBColor};

use crate::axis::{Axis, three};
use crate::page::{Page, UNITS};
use crate::paper::{Element, Paper, What};
use crate::style::{FONT, INK, Ink, LABEL, Pt, rgb};

/// Lines of the grid.
const GRID: &str = "#e3e7eb";
/// Room for the ticks and the title of x, below the frame.
const BELOW: f64 = 26.0;
/// Distance from the title of y to the far side of its letters.
const LETTERS: f64 = 6.5;
/// The most labels.
const LABELS: usize = 20;

/// A frame on the page with its two axes.
#[derive(Debug, Clone, Copy)]
pub struct Axes<'a> {
    /// Upper left corner in pt.
    pub corner: Pt,
    /// Width and height in pt.
    pub size: Pt,
    /// Axis to the right.
    pub x: Axis<'a>,
    /// Axis upward.
    pub y: Axis<'a>,
}

/// A frame with its axes as drawn on the page.
pub struct Chart<'a> {
    /// Upper left corner in pt.
    pub corner: Pt,
    /// Width and height in pt.
    pub size: Pt,
    /// Axis to the right.
    pub x: Axis<'a>,
    /// Axis upward.
    pub y: Axis<'a>,
    context: Option<ChartContext<'a, Page, Cartesian2d<Axis<'a>, Axis<'a>>>>,
}

/// Returns a line style of plotters.
pub(crate) fn styled(color: &str, width: f64) -> plotters::style::ShapeStyle {
    let [r, g, b] = rgb(color);
    RGBColor(r, g, b).stroke_width(units(width).unsigned_abs())
}

#[expect(clippy::cast_possible_truncation, reason = "figures are small")]
pub(crate) fn units(points: f64) -> i32 {
    (UNITS * points).round() as i32
}

impl<'a> Axes<'a> {
    /// Draws white ground, grid, ticks and titles. The title of y stands at `off` to the left.
    #[must_use]
    pub fn on(self, paper: &mut Paper, off: f64) -> Chart<'a> {
        paper.rect(self.corner, self.size, Ink::fill("#ffffff"));
        self.built(paper, off, true)
    }

    /// Draws ticks and titles alone. The title of y stands at `off` to the left.
    #[must_use]
    pub fn without_grid(self, paper: &mut Paper, off: f64) -> Chart<'a> {
        self.built(paper, off, false)
    }

    fn built(self, paper: &mut Paper, off: f64, grid: bool) -> Chart<'a> {
        let titled = [self.y, self.x].into_iter().filter(|axis| !axis.title.is_empty());
        let ranges = titled.map(|axis| format!("{} from {} to {}", axis.title, three(axis.low), three(axis.high)));
        paper.describe(&ranges.collect::<Vec<_>>().join(" over "));
        let (off, [left, top], [w, h]) = (off + LETTERS, self.corner, self.size);
        let (from, size) = ([left - off, top], [w + off, h + BELOW]);
        let [x, y, wide, high] = [from[0], from[1], size[0], size[1]].map(units);
        // The last unit of an area is its own length less one.
        let area = paper.root.clone().shrink((x, y), (wide + 1, high + 1));
        let built = ChartBuilder::on(&area)
            .x_label_area_size(units(BELOW))
            .y_label_area_size(units(off))
            .build_cartesian_2d(self.x, self.y);
        let mut context = paper.keep(built);
        if let Some(chart) = &mut context {
            let font = |size: f64| (FONT, UNITS * size).into_font().color(&styled(INK, 0.0).color);
            let mut mesh = chart.configure_mesh();
            mesh.x_labels(LABELS)
                .y_labels(LABELS)
                .bold_line_style(styled(GRID, 0.6))
                .light_line_style(styled(GRID, 0.3))
                .axis_style(styled(INK, 0.6))
                .set_all_tick_mark_size(units(3.0))
                .label_style(font(8.0))
                .axis_desc_style(font(LABEL.size))
                .x_desc(self.x.title)
                .y_desc(self.y.title);
            if !grid {
                mesh.disable_mesh();
            }
            let drawn = mesh.draw();
            paper.keep(drawn);
        }
        let Self { corner, size, x, y } = self;
        Chart { corner, size, x, y, context }
    }
}

impl std::fmt::Debug for Chart<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { corner, size, x, y, context: _ } = self;
        f.debug_struct("Chart")
            .field("corner", corner)
            .field("size", size)
            .field("x", x)
            .field("y", y)
            .finish_non_exhaustive()
    }
}

impl Chart<'_> {
    /// Returns the place of a point on the page; not finite for a value that a logarithm cannot show.
    #[must_use]
    pub fn at(&self, x: f64, y: f64) -> Pt {
        let ([left, top], [w, h]) = (self.corner, self.size);
        [left + w * self.x.unit(x), top + h * (1.0 - self.y.unit(y))]
    }

    /// Draws an element over the coordinates of the chart.
    pub(crate) fn draw(&self, paper: &mut Paper, pieces: Vec<Vec<(f64, f64)>>, what: What<'_>) {
        if let Some(chart) = &self.context {
            paper.draw(chart.plotting_area(), &Element { pieces, what });
        }
    }

    /// Fills the area within points (x, y).
    pub fn area(&self, paper: &mut Paper, points: Vec<(f64, f64)>, fill: &str) {
        self.draw(paper, vec![points], What::Area(Ink::fill(fill)));
    }

    /// Draws the frame, above the series.
    pub fn border(&self, paper: &mut Paper) {
        paper.rect(self.corner, self.size, Ink::line(INK, 0.6));
    }

    /// Draws a curve through points (x, y), cut at the frame: plotters would hold it at the edge.
    pub fn curve(&self, paper: &mut Paper, points: impl Iterator<Item = (f64, f64)>, ink: Ink<'_>) {
        let (x, y) = (self.x, self.y);
        let pieces = cut(points.map(|(a, b)| [x.unit(a), y.unit(b)]));
        for piece in pieces {
            let piece = piece.iter().map(|[a, b]| (x.value(*a), y.value(*b))).collect();
            self.draw(paper, vec![piece], What::Lines(ink));
        }
    }

    /// Draws a straight line across the whole frame at one y.
    pub fn level(&self, paper: &mut Paper, y: f64, ink: Ink<'_>) {
        self.curve(paper, [(self.x.low, y), (self.x.high, y)].into_iter(), ink);
    }

    /// Draws a mark, if it lies in the frame.
    pub fn mark(&self, paper: &mut Paper, x: f64, y: f64, fill: &str) {
        let inside = |axis: &Axis<'_>, v| (-1e-9..=1.0 + 1e-9).contains(&axis.unit(v));
        if inside(&self.x, x) && inside(&self.y, y) {
            self.draw(
                paper,
                vec![vec![(x, y)]],
                What::Circles(2.6, Ink { stroke: INK, width: 0.8, ..Ink::fill(fill) }),
            );
        }
    }
}

/// Returns the pieces of a curve within the unit square; values that are not finite part them.
fn cut(points: impl Iterator<Item = Pt>) -> Vec<Vec<Pt>> {
    let mut pieces: Vec<Vec<Pt>> = Vec::new();
    let mut last: Option<Pt> = None;
    for p in points {
        let there = p.iter().all(|c| c.is_finite()).then_some(p);
        if let (Some(from), Some(to)) = (last, there)
            && let Some([a, b]) = inside(from, to)
        {
            match pieces.last_mut() {
                Some(piece) if piece.last().is_some_and(|end| same(*end, a)) => piece.push(b),
                _ => pieces.push(vec![a, b]),
            }
        }
        last = there;
    }
    pieces
}

/// Returns the part of a straight line within the unit square (Liang and Barsky 1984).
fn inside(a: Pt, b: Pt) -> Option<[Pt; 2]> {
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for k in 0..2 {
        let d = b[k] - a[k];
        if d == 0.0 {
            if !(-1e-12..=1.0 + 1e-12).contains(&a[k]) {
                return None;
            }
            continue;
        }
        let (s, t) = (-a[k] / d, (1.0 - a[k]) / d);
        (from, to) = (from.max(s.min(t)), to.min(s.max(t)));
    }
    let at = |t: f64| [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])];
    (from <= to).then(|| [if from > 0.0 { at(from) } else { a }, if to < 1.0 { at(to) } else { b }])
}

#[expect(clippy::float_cmp, reason = "the end of one piece is the very start of the next")]
fn same(a: Pt, b: Pt) -> bool {
    a == b
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_are_cut_at_the_frame_and_never_held_at_its_edge() {
        let axes = Axes {
            corner: [50.0, 0.0],
            size: [100.0, 100.0],
            x: Axis::linear(0.0, 1.0, "time"),
            y: Axis::linear(0.0, 1.0, "speed *v*_0"),
        };
        let mut paper = Paper::new(160.0, 140.0);
        let chart = axes.without_grid(&mut paper, 20.0);
        // up and out at the top, back in, through a value that is none
        let points = [(0.0, 0.5), (0.5, 1.5), (1.0, 0.5), (0.9, f64::NAN), (0.8, 0.2), (0.7, 0.1)];
        chart.curve(&mut paper, points.into_iter(), Ink::line("#123456", 1.0));
        let drawn = paper.finish("").expect("a figure");
        assert!(drawn.contains("<desc>speed v0 from 0 to 1 over time from 0 to 1</desc>"), "{drawn}");
        let drawn: String = drawn.lines().filter(|line| line.contains("#123456")).collect();
        let paths: Vec<_> = drawn.split(" d=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
        assert_eq!(paths, ["M50 50L75 0", "M125 0L150 50", "M130 80L120 90"]);
    }
}
