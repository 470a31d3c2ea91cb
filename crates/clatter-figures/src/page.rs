//! Pages that plotters draws on: SVG in units of 1/100 pt, with elements that its own backend lacks: lines of any width
//! and dash, labels at any angle with italics and subscripts, images, a title.

use std::cell::RefCell;
use std::convert::Infallible;
use std::fmt::Write as _;
use std::rc::Rc;

use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind, FontTransform,
    text_anchor,
};

use crate::style::{Anchor, FONT, Ink, Label, Pt, width};

/// The origin in every picture.
const MADE_BY: &str = concat!("clatter ", env!("CARGO_PKG_VERSION"));

/// Units of a backend in a point.
pub(crate) const UNITS: f64 = 100.0;

/// A page, and the SVG that is on it so far.
#[derive(Debug, Clone)]
pub(crate) struct Page {
    size: Pt,
    body: Rc<RefCell<String>>,
}

type Drawn = Result<(), DrawingErrorKind<Infallible>>;

/// Returns a coordinate as text, to 1/100 pt, without a negative zero.
fn pt(x: f64) -> String {
    let text = format!("{x:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}

/// Returns text as XML.
pub(crate) fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Returns SVG for a text in figure markup: `*x*` is italic, `_x` or `_{xyz}` a subscript.
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

fn points(at: BackendCoord) -> Pt {
    [f64::from(at.0) / UNITS, f64::from(at.1) / UNITS]
}

impl Page {
    pub(crate) fn new(size: Pt) -> Self {
        Self { size, body: Rc::default() }
    }

    /// Draws one path through pieces, each closed if `closed`.
    pub(crate) fn path<'a>(&self, pieces: impl IntoIterator<Item = &'a [Pt]>, closed: bool, ink: &Ink) {
        let mut d = String::new();
        for piece in pieces {
            let mut last = None;
            for [x, y] in piece {
                let next = [pt(*x), pt(*y)];
                if last.as_ref() != Some(&next) {
                    let _ = write!(d, "{}{} {}", if last.is_none() { 'M' } else { 'L' }, next[0], next[1]);
                    last = Some(next);
                }
            }
            if closed && last.is_some() {
                d.push('Z');
            }
        }
        if !d.is_empty() {
            self.outline(&d, ink);
        }
    }

    fn outline(&self, d: &str, ink: &Ink) {
        let body = &mut *self.body.borrow_mut();
        let _ = write!(body, "<path d=\"{d}\" fill=\"{}\"", ink.fill);
        if ink.stroke != "none" {
            let _ = write!(body, " stroke=\"{}\" stroke-width=\"{}\"", ink.stroke, pt(ink.width));
            if !ink.dash.is_empty() {
                let _ = write!(body, " stroke-dasharray=\"{}\" stroke-linecap=\"butt\"", ink.dash);
            }
        }
        body.push_str("/>\n");
    }

    pub(crate) fn circle(&self, [x, y]: Pt, r: f64, ink: &Ink) {
        let (l, k) = (pt(x - r), pt(2.0 * r));
        self.outline(&format!("M{l} {}a{r} {r} 0 1 0 {k} 0a{r} {r} 0 1 0 -{k} 0Z", pt(y)), ink);
    }

    /// Writes words in figure markup: `*x*` is italic, `_x` and `_{xyz}` are subscripts.
    pub(crate) fn text(&self, at: Pt, text: &str, label: &Label) {
        self.set(at, &markup(text, label.size), label);
    }

    /// Writes a given name without markup. Characters that XML does not allow are left out.
    pub(crate) fn plain(&self, at: Pt, text: &str, label: &Label) {
        let clean: String = text.chars().filter(|c| !c.is_control() && !matches!(c, '\u{FFFE}' | '\u{FFFF}')).collect();
        self.set(at, &escape(&clean), label);
    }

    fn set(&self, [x, y]: Pt, inner: &str, label: &Label) {
        let anchor = match label.anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let (x, y, size) = (pt(x), pt(y), pt(label.size));
        let body = &mut *self.body.borrow_mut();
        let _ = write!(
            body,
            "<text xml:space=\"preserve\" x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\" font-size=\"{size}\" fill=\"{}\"",
            label.color
        );
        if label.turn != 0.0 {
            let _ = write!(body, " transform=\"rotate({} {x} {y})\"", pt(label.turn));
        }
        let _ = writeln!(body, ">{inner}</text>");
    }

    /// Draws an image from one corner to the other, without smoothing of its pixels.
    pub(crate) fn image(&self, [x, y]: Pt, [right, foot]: Pt, png: &str) {
        let [x, y, w, h] = [x, y, right - x, foot - y].map(pt);
        let _ = writeln!(
            self.body.borrow_mut(),
            "<image x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" preserveAspectRatio=\"none\" \
             image-rendering=\"optimizeSpeed\" style=\"image-rendering:pixelated\" href=\"data:image/png;base64,{png}\"/>",
        );
    }

    /// Returns the picture with its title, a description of its content, and its origin.
    pub(crate) fn finish(self, title: &str, description: &str) -> String {
        let [w, h] = self.size.map(pt);
        let described =
            if description.is_empty() { String::new() } else { format!("<desc>{}</desc>\n", escape(description)) };
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}pt\" height=\"{h}pt\" viewBox=\"0 0 {w} {h}\" role=\"img\" \
             font-family=\"{FONT}\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n<title>{}</title>\n{described}<metadata>{MADE_BY}</metadata>\n{}</svg>\n",
            escape(title),
            self.body.borrow()
        )
    }

    /// Draws the elements of plotters itself: grids, axes and ticks.
    fn styled<S: BackendStyle>(&self, piece: &[BackendCoord], closed: bool, style: &S, filled: bool) {
        let BackendColor { rgb: (r, g, b), alpha } = style.color();
        if alpha > 0.0 {
            let (color, piece) =
                (format!("#{r:02x}{g:02x}{b:02x}"), piece.iter().map(|at| points(*at)).collect::<Vec<_>>());
            let width = f64::from(style.stroke_width()) / UNITS;
            let ink = if filled { Ink::fill(&color) } else { Ink::line(&color, width) };
            self.path([&piece[..]], closed, &ink);
        }
    }
}

impl DrawingBackend for Page {
    type ErrorType = Infallible;

    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "figures are small and not negative")]
    fn get_size(&self) -> (u32, u32) {
        let [w, h] = self.size.map(|side| (UNITS * side).ceil() as u32);
        (w, h)
    }
    fn ensure_prepared(&mut self) -> Drawn {
        Ok(())
    }
    fn present(&mut self) -> Drawn {
        Ok(())
    }
    fn draw_pixel(&mut self, (x, y): BackendCoord, color: BackendColor) -> Drawn {
        self.styled(&[(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)], true, &color, true);
        Ok(())
    }
    fn draw_line<S: BackendStyle>(&mut self, from: BackendCoord, to: BackendCoord, style: &S) -> Drawn {
        self.styled(&[from, to], false, style, false);
        Ok(())
    }
    fn draw_rect<S: BackendStyle>(&mut self, from: BackendCoord, to: BackendCoord, style: &S, fill: bool) -> Drawn {
        self.styled(&[from, (to.0, from.1), to, (from.0, to.1)], true, style, fill);
        Ok(())
    }
    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(&mut self, path: I, style: &S) -> Drawn {
        self.styled(&path.into_iter().collect::<Vec<_>>(), false, style, false);
        Ok(())
    }
    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(&mut self, corners: I, style: &S) -> Drawn {
        self.styled(&corners.into_iter().collect::<Vec<_>>(), true, style, true);
        Ok(())
    }
    fn draw_text<S: BackendTextStyle>(&mut self, text: &str, style: &S, at: BackendCoord) -> Drawn {
        let BackendColor { rgb: (r, g, b), .. } = style.color();
        let (size, color) = (style.size() / UNITS, format!("#{r:02x}{g:02x}{b:02x}"));
        // The baseline is below the point, in the direction of the words.
        let down = size
            * match style.anchor().v_pos {
                text_anchor::VPos::Top => 0.72,
                text_anchor::VPos::Center => 0.33,
                text_anchor::VPos::Bottom => -0.24,
            };
        let anchor = match style.anchor().h_pos {
            text_anchor::HPos::Left => Anchor::Start,
            text_anchor::HPos::Center => Anchor::Middle,
            text_anchor::HPos::Right => Anchor::End,
        };
        let ([x, y], at) = (points(at), |turn, x, y| ([x, y], turn));
        let (at, turn) = match style.transform() {
            FontTransform::None => at(0.0, x, y + down),
            FontTransform::Rotate90 => at(90.0, x - down, y),
            FontTransform::Rotate180 => at(180.0, x, y - down),
            FontTransform::Rotate270 => at(-90.0, x + down, y),
        };
        self.text(at, text, &Label { anchor, size, turn, color: &color });
        Ok(())
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "words are short")]
    fn estimate_text_size<S: BackendTextStyle>(
        &self,
        text: &str,
        style: &S,
    ) -> Result<(u32, u32), DrawingErrorKind<Infallible>> {
        Ok((width(text, style.size()) as u32, style.size() as u32))
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
