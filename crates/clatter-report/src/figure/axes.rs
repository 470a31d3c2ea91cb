//! Axes, curves and keys of a graph: logarithmic or not, curves cut where they leave the frame.

use crate::svg::{Anchor, GRAY, INK, Ink, LABEL, Label, Pt, Svg};

/// Lines of the grid.
const GRID: &str = "#e3e7eb";
/// Ticks.
pub(crate) const SMALL: Label = Label { size: 8.0, ..LABEL };

/// One axis.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Axis<'a> {
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) log: bool,
    /// In figure markup.
    pub(crate) title: &'a str,
}

impl<'a> Axis<'a> {
    /// Logarithmic, as it is.
    pub(crate) fn log(low: f64, high: f64, title: &'a str) -> Self {
        Self { low, high, log: true, title }
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
        Self { low, high, log: false, title }
    }
    /// 0 at the low end, 1 at the high one; not finite for what a logarithm cannot show.
    fn unit(&self, v: f64) -> f64 {
        if self.log {
            (v.ln() - self.low.ln()) / (self.high.ln() - self.low.ln())
        } else {
            (v - self.low) / (self.high - self.low)
        }
    }
    fn decades(&self) -> f64 {
        self.high.log10() - self.low.log10()
    }
    /// Values with a label, and values with a grid line alone.
    fn ticks(&self) -> (Vec<f64>, Vec<f64>) {
        if !self.log {
            return (super::heat::round_values(self.low, self.high), Vec::new());
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
                    2 | 5 => decades < 2.2,
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
pub(crate) fn tick(v: f64) -> String {
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
pub(crate) fn raised(exponent: &str) -> String {
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

impl Axes<'_> {
    /// On the page; not finite for what a logarithm cannot show.
    pub(crate) fn at(&self, x: f64, y: f64) -> Pt {
        let ([left, top], [w, h]) = (self.corner, self.size);
        [left + w * self.x.unit(x), top + h * (1.0 - self.y.unit(y))]
    }
    /// Whether a point of the page is in the frame.
    fn holds(&self, p: Pt) -> bool {
        (0..2).all(|k| (self.corner[k] - 1e-6..=self.corner[k] + self.size[k] + 1e-6).contains(&p[k]))
    }

    /// White ground and grid, below the curves.
    pub(crate) fn grid(&self, svg: &mut Svg) {
        let ([left, top], [w, h]) = (self.corner, self.size);
        svg.rect(self.corner, self.size, Ink::fill("#ffffff"));
        let (labels, lines) = self.x.ticks();
        for (values, width) in [(lines, 0.3), (labels, 0.6)] {
            for v in values {
                let x = left + w * self.x.unit(v);
                svg.line([x, top], [x, top + h], Ink::line(GRID, width));
            }
        }
        let (labels, lines) = self.y.ticks();
        for (values, width) in [(lines, 0.3), (labels, 0.6)] {
            for v in values {
                let y = top + h * (1.0 - self.y.unit(v));
                svg.line([left, y], [left + w, y], Ink::line(GRID, width));
            }
        }
    }

    /// Border, ticks and titles, above the curves. The title of y stands at `off` to the left.
    pub(crate) fn border(&self, svg: &mut Svg, off: f64) {
        let ([left, top], [w, h]) = (self.corner, self.size);
        svg.rect(self.corner, self.size, Ink::line(INK, 0.6));
        for v in self.x.ticks().0 {
            let x = left + w * self.x.unit(v);
            svg.line([x, top + h], [x, top + h + 3.0], Ink::line(INK, 0.6));
            svg.text([x, top + h + 11.5], &tick(v), SMALL);
        }
        for v in self.y.ticks().0 {
            let y = top + h * (1.0 - self.y.unit(v));
            svg.line([left, y], [left - 3.0, y], Ink::line(INK, 0.6));
            svg.text([left - 5.0, y + 2.6], &tick(v), Label { anchor: Anchor::End, ..SMALL });
        }
        if !self.x.title.is_empty() {
            svg.text([left + 0.5 * w, top + h + 24.0], self.x.title, LABEL);
        }
        if !self.y.title.is_empty() {
            svg.text([left - off, top + 0.5 * h], self.y.title, Label { turn: -90.0, ..LABEL });
        }
    }

    /// A curve through points (x, y), cut at the frame.
    pub(crate) fn curve(&self, svg: &mut Svg, points: impl Iterator<Item = (f64, f64)>, ink: Ink) {
        let mut piece: Vec<Pt> = Vec::new();
        let mut last: Option<Pt> = None;
        for (x, y) in points {
            let p = self.at(x, y);
            if !p.iter().all(|c| c.is_finite()) {
                svg.path(&std::mem::take(&mut piece), false, ink);
                last = None;
                continue;
            }
            if let Some(from) = last
                && let Some([a, b]) = self.cut(from, p)
            {
                if piece.last().is_none_or(|end| !same(*end, a)) {
                    svg.path(&std::mem::take(&mut piece), false, ink);
                    piece.push(a);
                }
                piece.push(b);
            }
            last = Some(p);
        }
        svg.path(&piece, false, ink);
    }

    /// The part of a straight line within the frame (Liang and Barsky 1984).
    fn cut(&self, a: Pt, b: Pt) -> Option<[Pt; 2]> {
        let (mut from, mut to) = (0.0_f64, 1.0_f64);
        for k in 0..2 {
            let (low, high) = (self.corner[k], self.corner[k] + self.size[k]);
            let d = b[k] - a[k];
            if d == 0.0 {
                if a[k] < low || a[k] > high {
                    return None;
                }
                continue;
            }
            let (s, t) = ((low - a[k]) / d, (high - a[k]) / d);
            (from, to) = (from.max(s.min(t)), to.min(s.max(t)));
        }
        let at = |t: f64| [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])];
        (from <= to).then(|| [if from > 0.0 { at(from) } else { a }, if to < 1.0 { at(to) } else { b }])
    }

    /// A straight line across the whole frame at one y.
    pub(crate) fn level(&self, svg: &mut Svg, y: f64, ink: Ink) {
        self.curve(svg, [(self.x.low, y), (self.x.high, y)].into_iter(), ink);
    }

    /// A mark, if it lies in the frame.
    pub(crate) fn mark(&self, svg: &mut Svg, x: f64, y: f64, fill: &'static str) {
        let p = self.at(x, y);
        if self.holds(p) {
            svg.circle(p, 2.6, Ink { stroke: INK, width: 0.8, ..Ink::fill(fill) });
        }
    }
}

#[expect(clippy::float_cmp, reason = "the end of one piece is the very start of the next")]
fn same(a: Pt, b: Pt) -> bool {
    a == b
}

/// What the lines of a figure mean, one below the other from `at` on. Returns where the next line would stand.
pub(crate) fn key(svg: &mut Svg, [x, mut y]: Pt, lines: &[(Ink, &str)]) -> f64 {
    for (ink, text) in lines {
        svg.line([x, y - 2.8], [x + 18.0, y - 2.8], *ink);
        svg.text([x + 23.0, y], text, Label { anchor: Anchor::Start, ..SMALL });
        y += 12.0;
    }
    y
}

/// A line of words below a key.
pub(crate) fn note(svg: &mut Svg, [x, y]: Pt, text: &str) {
    svg.text([x, y], text, Label { anchor: Anchor::Start, color: GRAY, ..SMALL });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_are_cut_at_the_frame_and_never_held_at_its_edge() {
        let axes = Axes {
            corner: [0.0, 0.0],
            size: [100.0, 100.0],
            x: Axis::linear(0.0, 1.0, ""),
            y: Axis::linear(0.0, 1.0, ""),
        };
        let mut svg = Svg::new(100.0, 100.0);
        // up and out at the top, back in, through a value that is none
        let points = [(0.0, 0.5), (0.5, 1.5), (1.0, 0.5), (0.9, f64::NAN), (0.8, 0.2), (0.7, 0.1)];
        axes.curve(&mut svg, points.into_iter(), Ink::line(INK, 1.0));
        let drawn = svg.finish("");
        let paths: Vec<_> = drawn.split(" d=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
        assert_eq!(paths, ["M0 50L25 0", "M75 0L100 50", "M80 80L70 90"]);
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
