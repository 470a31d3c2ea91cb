//! Charts of plotters with our axes: logarithmic or not, ticks as short words, series cut where they leave the frame.

use std::ops::Range;

use plotters::chart::{ChartBuilder, ChartContext};
use plotters::coord::cartesian::Cartesian2d;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use plotters::style::{Color, IntoFont, RGBColor};

use crate::page::{Page, UNITS};
use crate::paper::{Element, Paper, What};
use crate::shock::three;
use crate::style::{FONT, INK, Ink, LABEL, Pt, rgb};

/// Lines of the grid.
const GRID: &str = "#e3e7eb";
/// Room for the ticks and the title of x, below the frame.
const BELOW: f64 = 26.0;
/// From the title of y to the far side of its letters.
const LETTERS: f64 = 6.5;
/// Labels at most.
const LABELS: usize = 20;

/// One axis.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Axis<'a> {
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) log: bool,
    /// In figure markup.
    pub(crate) title: &'a str,
    /// Without ticks and grid.
    pub(crate) bare: bool,
}

impl Ranged for Axis<'_> {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;
    #[expect(clippy::cast_possible_truncation, reason = "figures are small")]
    fn map(&self, value: &f64, (from, to): (i32, i32)) -> i32 {
        from + (self.unit(*value) * f64::from(to - from)).round() as i32
    }
    fn key_points<H: KeyPointHint>(&self, hint: H) -> Vec<f64> {
        let (labels, lines) = self.ticks();
        if hint.weight().allow_light_points() { lines } else { labels }
    }
    fn range(&self) -> Range<f64> {
        self.low..self.high
    }
}

impl ValueFormatter<f64> for Axis<'_> {
    fn format_ext(&self, value: &f64) -> String {
        tick(*value)
    }
}

impl<'a> Axis<'a> {
    /// Logarithmic, as it is.
    pub(crate) fn log(low: f64, high: f64, title: &'a str) -> Self {
        Self { low, high, log: true, title, bare: false }
    }
    /// Logarithmic, widened to 1, 2 or 5 times powers of ten; at most `decades` down from the largest value.
    pub(crate) fn log_over(values: impl Iterator<Item = f64>, decades: f64, title: &'a str) -> Self {
        let (low, high) = values
            .filter(|v| *v > 0.0 && v.is_finite())
            .fold((f64::INFINITY, 0.0_f64), |(a, b), v| (a.min(v), b.max(v)));
        if low > high {
            return Self::log(0.1, 10.0, title);
        }
        let low = low.max(high * 10f64.powf(-decades));
        let (low, high) = (step_down(low), step_up(high));
        let (low, high) = if high < 8.0 * low { (step_down(0.4 * low), step_up(2.5 * high)) } else { (low, high) };
        Self::log(low.max(1e-307), high.min(1e307), title)
    }
    pub(crate) fn linear(low: f64, high: f64, title: &'a str) -> Self {
        Self { low, high, log: false, title, bare: false }
    }
    /// 0 at the low end, 1 at the high one; not finite for what a logarithm cannot show.
    pub(crate) fn unit(&self, v: f64) -> f64 {
        if self.log {
            (v.ln() - self.low.ln()) / (self.high.ln() - self.low.ln())
        } else {
            (v - self.low) / (self.high - self.low)
        }
    }
    /// The value at a share of the way.
    fn value(&self, unit: f64) -> f64 {
        let between = |a: f64, b: f64| a + unit * (b - a);
        if self.log { between(self.low.ln(), self.high.ln()).exp() } else { between(self.low, self.high) }
    }
    fn decades(&self) -> f64 {
        self.high.log10() - self.low.log10()
    }
    /// Values with a label, and values with a grid line alone.
    pub(crate) fn ticks(&self) -> (Vec<f64>, Vec<f64>) {
        if self.bare {
            return (Vec::new(), Vec::new());
        }
        if !self.log {
            return (round_values(self.low, self.high), Vec::new());
        }
        let decades = self.decades();
        let inside = |v: &f64| (-1e-9..=1.0 + 1e-9).contains(&self.unit(*v));
        let every = (decades / 10.0).ceil().max(1.0);
        let (mut labels, mut lines) = (Vec::new(), Vec::new());
        let mut exponent = self.low.log10().floor();
        while exponent <= self.high.log10() + 1e-9 {
            let decade = 10f64.powf(exponent);
            for k in 1..=9u8 {
                let v = f64::from(k) * decade;
                let labelled = match k {
                    1 => (exponent / every).fract() == 0.0,
                    2 | 5 => decades < 2.7,
                    _ => false,
                };
                if labelled {
                    labels.push(v);
                } else if k == 1 || decades < 6.5 {
                    lines.push(v);
                }
            }
            exponent += 1.0;
        }
        labels.retain(inside);
        lines.retain(inside);
        (labels, lines)
    }
}

/// Multiples of 1, 2 or 5 times a power of ten from `low` to `high`, four to nine of them; one if both are the same.
pub(crate) fn round_values(low: f64, high: f64) -> Vec<f64> {
    let span = high - low;
    if !(span > 0.0 && span.is_finite()) {
        return vec![low];
    }
    let rough = span / 5.0;
    let decade = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|k| k * decade).find(|s| *s >= rough * 0.9).unwrap_or(rough);
    let first = (low / step - 1e-9).ceil();
    let all = (0..=12u8).map(|k| (first + f64::from(k)) * step);
    all.filter(|v| *v <= high + 1e-9 * span).collect()
}

/// The largest 1, 2 or 5 times a power of ten at or below `v`.
fn step_down(v: f64) -> f64 {
    let decade = 10f64.powf(v.log10().floor());
    [5.0, 2.0, 1.0].into_iter().map(|k| k * decade).find(|s| *s <= v * (1.0 + 1e-9)).unwrap_or(0.5 * decade)
}

/// The smallest one at or above `v`.
pub(crate) fn step_up(v: f64) -> f64 {
    let decade = 10f64.powf(v.log10().floor());
    [1.0, 2.0, 5.0].into_iter().map(|k| k * decade).find(|s| *s >= v * (1.0 - 1e-9)).unwrap_or(10.0 * decade)
}

/// A round value: plain from 0.001 to below 100 000, else with a power of ten.
#[must_use]
pub fn tick(v: f64) -> String {
    if v == 0.0 || (1e-3 * 0.999..0.999e5).contains(&v.abs()) {
        let text = format!("{v:.4}");
        let text = text.trim_end_matches('0').trim_end_matches('.');
        return text.replace('-', "−");
    }
    let text = format!("{v:.0e}");
    let (digit, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let power = format!("10{}", raised(exponent));
    if digit == "1" { power } else { format!("{digit}·{power}") }
}

/// An exponent as it stands above the line.
#[must_use]
pub fn raised(exponent: &str) -> String {
    let sign = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        c => c.to_digit(10).and_then(|d| char::from_u32(0x2070 + d)).unwrap_or(c),
    };
    exponent.chars().map(sign).collect()
}

/// A frame on the page with its two axes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Axes<'a> {
    /// Upper left corner and size in pt.
    pub(crate) corner: Pt,
    pub(crate) size: Pt,
    pub(crate) x: Axis<'a>,
    pub(crate) y: Axis<'a>,
}

/// The same, drawn.
pub(crate) struct Chart<'a> {
    pub(crate) corner: Pt,
    pub(crate) size: Pt,
    pub(crate) x: Axis<'a>,
    pub(crate) y: Axis<'a>,
    context: Option<ChartContext<'a, Page, Cartesian2d<Axis<'a>, Axis<'a>>>>,
}

/// A line as plotters has it.
pub(crate) fn styled(color: &str, width: f64) -> plotters::style::ShapeStyle {
    let [r, g, b] = rgb(color);
    RGBColor(r, g, b).stroke_width(units(width).unsigned_abs())
}

#[expect(clippy::cast_possible_truncation, reason = "figures are small")]
pub(crate) fn units(points: f64) -> i32 {
    (UNITS * points).round() as i32
}

impl<'a> Axes<'a> {
    /// White ground, grid, ticks and titles. The title of y stands at `off` to the left.
    pub(crate) fn on(self, paper: &mut Paper, off: f64) -> Chart<'a> {
        paper.rect(self.corner, self.size, Ink::fill("#ffffff"));
        self.built(paper, off, true)
    }

    /// Ticks and titles alone.
    pub(crate) fn without_grid(self, paper: &mut Paper, off: f64) -> Chart<'a> {
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

impl Chart<'_> {
    /// On the page; not finite for what a logarithm cannot show.
    pub(crate) fn at(&self, x: f64, y: f64) -> Pt {
        let ([left, top], [w, h]) = (self.corner, self.size);
        [left + w * self.x.unit(x), top + h * (1.0 - self.y.unit(y))]
    }

    /// An element over the coordinates of the chart, on it.
    pub(crate) fn draw(&self, paper: &mut Paper, pieces: Vec<Vec<(f64, f64)>>, what: What<'_>) {
        if let Some(chart) = &self.context {
            paper.draw(chart.plotting_area(), &Element { pieces, what });
        }
    }

    /// The frame, above the series.
    pub(crate) fn border(&self, paper: &mut Paper) {
        paper.rect(self.corner, self.size, Ink::line(INK, 0.6));
    }

    /// A curve through points (x, y), cut at the frame: plotters would hold it at the edge.
    pub(crate) fn curve(&self, paper: &mut Paper, points: impl Iterator<Item = (f64, f64)>, ink: Ink<'_>) {
        let (x, y) = (self.x, self.y);
        let pieces = cut(points.map(|(a, b)| [x.unit(a), y.unit(b)]));
        for piece in pieces {
            let piece = piece.iter().map(|[a, b]| (x.value(*a), y.value(*b))).collect();
            self.draw(paper, vec![piece], What::Lines(ink));
        }
    }

    /// A straight line across the whole frame at one y.
    pub(crate) fn level(&self, paper: &mut Paper, y: f64, ink: Ink<'_>) {
        self.curve(paper, [(self.x.low, y), (self.x.high, y)].into_iter(), ink);
    }

    /// A mark, if it lies in the frame.
    pub(crate) fn mark(&self, paper: &mut Paper, x: f64, y: f64, fill: &str) {
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

/// The pieces of a curve within the unit square; what is not finite parts them.
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

/// The part of a straight line within the unit square (Liang and Barsky 1984).
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

    #[test]
    fn ticks_are_short_words() {
        assert_eq!([0.0, 0.001, 0.2, 5000.0, -2.0].map(tick), ["0", "0.001", "0.2", "5000", "−2"]);
        assert_eq!([1e5, 2e-4, 5e12].map(tick), ["10⁵", "2·10⁻⁴", "5·10¹²"]);
    }

    #[test]
    fn an_axis_has_a_few_labels_whatever_its_span() {
        for (low, high) in [(1.0, 9.0), (0.3, 40.0), (10.0, 1e4), (1e-12, 1e12), (1e-300, 1e300)] {
            let n = Axis::log(low, high, "").ticks().0.len();
            assert!((2..=12).contains(&n), "{low:e} to {high:e}: {n} labels");
        }
        let axis = Axis::log_over([3.0, 700.0, 0.0, f64::INFINITY].into_iter(), 5.0, "");
        assert_eq!((axis.low, axis.high), (2.0, 1000.0));
        let flat = Axis::log_over([2.5].into_iter(), 5.0, "");
        assert!(flat.low < 2.5 && flat.high > 2.5, "{flat:?}");
    }
}
