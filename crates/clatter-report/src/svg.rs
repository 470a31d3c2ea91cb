//! A small SVG writer: lengths in points, y downward, labels with italics and subscripts.
//!
//! Plotting libraries were tried first. plotters draws on whole pixels, clamps what leaves the frame, turns text by
//! quarters only and sets no italic or subscript; its surfaces are not sorted by depth. Every figure here needs
//! one of these, and what remains of such a library is this page.

use std::fmt::Write as _;

/// A point on the page.
pub(crate) type Pt = [f64; 2];

/// One calm palette, light to dark; its steps are told apart in gray as well.
pub(crate) const BLUES: [&str; 9] =
    ["#f2f6fa", "#e1ebf4", "#cddeed", "#b5cde3", "#98b8d6", "#779fc6", "#5585b3", "#37699a", "#1f4e7c"];
/// Lines and letters.
pub(crate) const INK: &str = "#1d2329";
/// Ticks, rules and second voices.
pub(crate) const GRAY: &str = "#68717b";
/// Regions apart: endless, or no safe zone.
pub(crate) const SAND: &str = "#efe5d3";
/// What must catch the eye.
pub(crate) const RUST: &str = "#a34a1c";
/// What is open.
pub(crate) const OCHRE: &str = "#8f6b00";

/// The typeface of figures and pages, embedded in typst.
pub(crate) const FONT: &str = "Libertinus Serif";

/// How a shape is drawn.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ink {
    /// Fill color or `none`.
    pub(crate) fill: &'static str,
    /// Line color or `none`.
    pub(crate) stroke: &'static str,
    /// Line width in pt.
    pub(crate) width: f64,
    /// Lengths of dashes and gaps in pt, empty for a whole line.
    pub(crate) dash: &'static str,
}

impl Ink {
    pub(crate) const fn line(stroke: &'static str, width: f64) -> Self {
        Self { fill: "none", stroke, width, dash: "" }
    }
    pub(crate) const fn fill(fill: &'static str) -> Self {
        Self { fill, stroke: "none", width: 0.0, dash: "" }
    }
}

/// Where a label stands about its point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// How a label is set.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Label {
    pub(crate) anchor: Anchor,
    /// Font size in pt.
    pub(crate) size: f64,
    /// Degrees, clockwise as seen.
    pub(crate) turn: f64,
    pub(crate) color: &'static str,
}

/// A label in the middle of its point, at the size of the figures' text.
pub(crate) const LABEL: Label = Label { anchor: Anchor::Middle, size: 8.5, turn: 0.0, color: INK };

/// A picture in the making.
#[derive(Debug)]
pub(crate) struct Svg {
    size: Pt,
    body: String,
}

/// A coordinate, to 1/100 pt, without a negative zero.
fn pt(x: f64) -> String {
    let text = format!("{x:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}

/// Text as XML.
pub(crate) fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// `*x*` is italic, `_x` or `_{xyz}` a subscript.
fn markup(text: &str, size: f64) -> String {
    let mut out = String::new();
    let (mut italic, mut lowered) = (false, false);
    let mut rest = text.chars().peekable();
    let mut run = |run: &mut String, italic: bool, shift: f64, small: bool| {
        if !run.is_empty() {
            out.push_str("<tspan");
            if italic {
                out.push_str(" font-style=\"italic\"");
            }
            if shift != 0.0 {
                let _ = write!(out, " dy=\"{}\"", pt(shift));
            }
            if small {
                let _ = write!(out, " font-size=\"{}\"", pt(0.72 * size));
            }
            let _ = write!(out, ">{}</tspan>", escape(run));
            run.clear();
        }
    };
    let mut word = String::new();
    while let Some(c) = rest.next() {
        let shift = if lowered { -0.2 * size } else { 0.0 };
        match c {
            '*' => {
                lowered &= word.is_empty();
                run(&mut word, italic, shift, false);
                italic = !italic;
            }
            '_' => {
                run(&mut word, italic, shift, false);
                let mut low: String = rest.next().into_iter().collect();
                if low == "{" {
                    low = rest.by_ref().take_while(|c| *c != '}').collect();
                }
                run(&mut low, false, 0.2 * size, true);
                lowered = true;
            }
            c => word.push(c),
        }
    }
    let shift = if lowered { -0.2 * size } else { 0.0 };
    run(&mut word, italic, shift, false);
    out
}

/// About how wide a label is, from the widths of the typeface's letters (± 10 %): to keep labels apart.
pub(crate) fn width(text: &str, size: f64) -> f64 {
    let letter = |c: char| match c {
        '*' | '_' | '{' | '}' => 0.0,
        'i' | 'j' | 'l' | 't' | 'f' | 'r' | '.' | ',' | ' ' | '\'' | '(' | ')' | ':' => 0.28,
        '0'..='9' => 0.47,
        'm' | 'w' | '%' | 'M' | 'W' | '≥' | '≤' | '∞' => 0.75,
        c if c.is_uppercase() => 0.65,
        _ => 0.48,
    };
    size * text.chars().map(letter).sum::<f64>()
}

impl Svg {
    pub(crate) fn new(width: f64, height: f64) -> Self {
        Self { size: [width, height], body: String::new() }
    }

    /// A line through `points`, closed if `closed`.
    pub(crate) fn path(&mut self, points: &[Pt], closed: bool, ink: Ink) {
        let Some(([x, y], rest)) = points.split_first() else { return };
        let mut d = format!("M{} {}", pt(*x), pt(*y));
        let mut last = [pt(*x), pt(*y)];
        for [x, y] in rest {
            let next = [pt(*x), pt(*y)];
            if next != last {
                let _ = write!(d, "L{} {}", next[0], next[1]);
                last = next;
            }
        }
        if closed {
            d.push('Z');
        }
        self.raw_path(&d, ink);
    }

    pub(crate) fn raw_path(&mut self, d: &str, ink: Ink) {
        let _ = write!(self.body, "<path d=\"{d}\" fill=\"{}\"", ink.fill);
        if ink.stroke != "none" {
            let _ = write!(self.body, " stroke=\"{}\" stroke-width=\"{}\"", ink.stroke, pt(ink.width));
            if !ink.dash.is_empty() {
                let _ = write!(self.body, " stroke-dasharray=\"{}\" stroke-linecap=\"butt\"", ink.dash);
            }
        }
        self.body.push_str("/>\n");
    }

    pub(crate) fn line(&mut self, from: Pt, to: Pt, ink: Ink) {
        self.path(&[from, to], false, ink);
    }

    pub(crate) fn rect(&mut self, [x, y]: Pt, [w, h]: Pt, ink: Ink) {
        self.path(&[[x, y], [x + w, y], [x + w, y + h], [x, y + h]], true, ink);
    }

    pub(crate) fn circle(&mut self, [x, y]: Pt, r: f64, ink: Ink) {
        let (l, k) = (pt(x - r), pt(2.0 * r));
        self.raw_path(&format!("M{l} {}a{r} {r} 0 1 0 {k} 0a{r} {r} 0 1 0 -{k} 0Z", pt(y)), ink);
    }

    /// A line with a head at its end.
    pub(crate) fn arrow(&mut self, from: Pt, to: Pt, color: &'static str, width: f64) {
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        let length = dx.hypot(dy).max(1e-9);
        let (ux, uy) = (dx / length, dy / length);
        let (long, wide) = (5.0, 1.6);
        let neck = [to[0] - long * ux, to[1] - long * uy];
        self.line(from, [to[0] - 0.7 * long * ux, to[1] - 0.7 * long * uy], Ink::line(color, width));
        let side = |s: f64| [neck[0] - s * wide * uy, neck[1] + s * wide * ux];
        self.path(&[to, side(1.0), side(-1.0)], true, Ink::fill(color));
    }

    /// Words in figure markup.
    pub(crate) fn text(&mut self, at: Pt, text: &str, label: Label) {
        self.set(at, &markup(text, label.size), label);
    }

    /// Words as they are: a name that somebody gave. What XML cannot say is left out.
    pub(crate) fn plain(&mut self, at: Pt, text: &str, label: Label) {
        let clean: String = text.chars().filter(|c| !c.is_control() && !matches!(c, '\u{FFFE}' | '\u{FFFF}')).collect();
        self.set(at, &escape(&clean), label);
    }

    fn set(&mut self, [x, y]: Pt, inner: &str, label: Label) {
        let anchor = match label.anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let (x, y) = (pt(x), pt(y));
        let _ = write!(
            self.body,
            "<text xml:space=\"preserve\" x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\" font-size=\"{}\" fill=\"{}\"",
            pt(label.size),
            label.color
        );
        if label.turn != 0.0 {
            let _ = write!(self.body, " transform=\"rotate({} {x} {y})\"", pt(label.turn));
        }
        let _ = writeln!(self.body, ">{inner}</text>");
    }

    /// An image of `size` at `corner`, its pixels kept as they are.
    pub(crate) fn image(&mut self, [x, y]: Pt, [w, h]: Pt, png: &str) {
        let _ = writeln!(
            self.body,
            "<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" preserveAspectRatio=\"none\" image-rendering=\"optimizeSpeed\" style=\"image-rendering:pixelated\" href=\"data:image/png;base64,{png}\"/>",
            pt(x),
            pt(y),
            pt(w),
            pt(h)
        );
    }

    /// The picture, with what it shows as its title.
    pub(crate) fn finish(self, title: &str) -> String {
        let [w, h] = self.size.map(pt);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}pt\" height=\"{h}pt\" viewBox=\"0 0 {w} {h}\" \
             font-family=\"{FONT}\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n<title>{}</title>\n{}</svg>\n",
            escape(title),
            self.body
        )
    }
}

impl Svg {
    /// A facet of a surface: filled, with a hairline of its own.
    pub(crate) fn facet(&mut self, points: &[Pt], fill: &str, line: &str) {
        let d: String = points.iter().map(|[x, y]| format!("{} {}", pt(*x), pt(*y))).collect::<Vec<_>>().join("L");
        let _ = writeln!(self.body, "<path d=\"M{d}Z\" fill=\"{fill}\" stroke=\"{line}\" stroke-width=\".25\"/>");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_have_italics_and_subscripts_that_come_back_up() {
        let plain = |text| markup(text, 10.0);
        assert_eq!(
            plain("*v*_0 < 1"),
            concat!(
                "<tspan font-style=\"italic\">v</tspan><tspan dy=\"2\" font-size=\"7.2\">0</tspan>",
                "<tspan dy=\"-2\"> &lt; 1</tspan>"
            )
        );
        assert_eq!(
            plain("*v*_{max}*x*"),
            concat!(
                "<tspan font-style=\"italic\">v</tspan><tspan dy=\"2\" font-size=\"7.2\">max</tspan>",
                "<tspan font-style=\"italic\" dy=\"-2\">x</tspan>"
            )
        );
    }

    #[test]
    fn coordinates_are_short_and_have_no_negative_zero() {
        assert_eq!([pt(-0.001), pt(1.0), pt(2.504)], ["0", "1", "2.5"]);
    }
}
