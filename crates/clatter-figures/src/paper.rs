//! A figure in progress: an area of plotters in points, y downward, and the one element that is drawn on it and on
//! charts.

use std::iter::Flatten;
use std::slice::Iter;

use plotters::coord::cartesian::Cartesian2d;
use plotters::coord::{CoordTranslate, Shift};
use plotters::drawing::{DrawingArea, IntoDrawingArea};
use plotters::element::{Drawable, PointCollection};
use plotters_backend::{BackendCoord, DrawingErrorKind};

use crate::FigureError;
use crate::axis::Axis;
use crate::page::{Page, UNITS};
use crate::style::{Anchor, GRAY, Ink, LABEL, Label, Pt};

/// An element that plotters lacks: lines with dashes, shapes in pieces, words in figure markup at any angle, images.
pub(crate) struct Element<'a, P> {
    pub(crate) pieces: Vec<Vec<P>>,
    pub(crate) what: What<'a>,
}

/// The content at or through the points of an element.
pub(crate) enum What<'a> {
    Lines(Ink<'a>),
    /// One area, its pieces closed.
    Area(Ink<'a>),
    /// A circle of this radius around each point.
    Circles(f64, Ink<'a>),
    /// Words in figure markup.
    Text(&'a str, Label<'a>),
    /// Words without markup.
    Plain(&'a str, Label<'a>),
    /// A PNG in base64, from the first point to the last.
    Image(&'a str),
}

impl<'b, P> PointCollection<'b, P> for &'b Element<'_, P> {
    type Point = &'b P;
    type IntoIter = Flatten<Iter<'b, Vec<P>>>;
    fn point_iter(self) -> Self::IntoIter {
        self.pieces.iter().flatten()
    }
}

impl<P> Drawable<Page> for Element<'_, P> {
    fn draw<I: Iterator<Item = BackendCoord>>(
        &self,
        at: I,
        page: &mut Page,
        _: (u32, u32),
    ) -> Result<(), DrawingErrorKind<std::convert::Infallible>> {
        let mut at = at.map(|(x, y)| [f64::from(x) / UNITS, f64::from(y) / UNITS]);
        match &self.what {
            What::Lines(ink) | What::Area(ink) => {
                let pieces: Vec<Vec<Pt>> =
                    self.pieces.iter().map(|piece| at.by_ref().take(piece.len()).collect()).collect();
                page.path(pieces.iter().map(Vec::as_slice), matches!(self.what, What::Area(_)), ink);
            }
            What::Circles(r, ink) => at.for_each(|at| page.circle(at, *r, ink)),
            What::Text(text, label) => at.for_each(|at| page.text(at, text, label)),
            What::Plain(text, label) => at.for_each(|at| page.plain(at, text, label)),
            What::Image(png) => {
                if let (Some(from), Some(to)) = (at.next(), at.last()) {
                    page.image(from, to, png);
                }
            }
        }
        Ok(())
    }
}

/// A page in points. The first failure of plotters is kept until the end.
pub struct Paper {
    page: Page,
    pub(crate) root: DrawingArea<Page, Shift>,
    points: DrawingArea<Page, Cartesian2d<Axis<'static>, Axis<'static>>>,
    /// Description of the content in words.
    described: Vec<String>,
    error: Option<FigureError>,
}

impl std::fmt::Debug for Paper {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Paper").field("described", &self.described).field("error", &self.error).finish_non_exhaustive()
    }
}

impl Paper {
    /// Creates a page of this width and height.
    #[must_use]
    pub fn new(width: f64, height: f64) -> Self {
        let page = Page::new([width, height]);
        let root = page.clone().into_drawing_area();
        let (w, h) = root.dim_in_pixel();
        let span = |n: u32| 0..i32::try_from(n).unwrap_or(i32::MAX);
        let (x, y) = (Axis::linear(0.0, width, ""), Axis::linear(0.0, height, ""));
        let points = root.apply_coord_spec(Cartesian2d::new(x, y, (span(w), span(h))));
        Self { page, root, points, described: Vec::new(), error: None }
    }

    /// Adds a description of the content, in figure markup, for readers that cannot see.
    pub(crate) fn describe(&mut self, what: &str) {
        let plain = what.replace(['*', '_', '{', '}'], "");
        if !self.described.contains(&plain) {
            self.described.push(plain);
        }
    }

    /// Returns the result of a step of plotters, and keeps its failure.
    pub(crate) fn keep<T>(&mut self, step: Result<T, impl std::fmt::Display>) -> Option<T> {
        step.map_err(|error| self.error.get_or_insert_with(|| FigureError(error.to_string())).clone()).ok()
    }

    /// Draws an element on an area of this page.
    pub(crate) fn draw<P, C: CoordTranslate<From = P>>(
        &mut self,
        area: &DrawingArea<Page, C>,
        element: &Element<'_, P>,
    ) {
        let drawn = area.draw(element);
        self.keep(drawn);
    }

    fn here(&mut self, points: &[Pt], what: What<'_>) {
        let pieces = vec![points.iter().map(|[x, y]| (*x, *y)).collect()];
        let drawn = self.points.draw(&Element { pieces, what });
        self.keep(drawn);
    }

    /// Draws a line through points, or the area within them.
    pub fn path(&mut self, points: &[Pt], closed: bool, ink: Ink<'_>) {
        self.here(points, if closed { What::Area(ink) } else { What::Lines(ink) });
    }

    /// Draws a straight line.
    pub fn line(&mut self, from: Pt, to: Pt, ink: Ink<'_>) {
        self.path(&[from, to], false, ink);
    }

    /// Draws a rectangle from its upper left corner, with its width and height.
    pub fn rect(&mut self, [x, y]: Pt, [w, h]: Pt, ink: Ink<'_>) {
        self.path(&[[x, y], [x + w, y], [x + w, y + h], [x, y + h]], true, ink);
    }

    /// Draws a circle of radius r.
    pub fn circle(&mut self, at: Pt, r: f64, ink: Ink<'_>) {
        self.here(&[at], What::Circles(r, ink));
    }

    /// Draws a line with a head at its end.
    pub fn arrow(&mut self, from: Pt, to: Pt, color: &str, width: f64) {
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        let length = dx.hypot(dy).max(1e-9);
        let (ux, uy) = (dx / length, dy / length);
        let (long, wide) = (5.0, 1.6);
        let neck = [to[0] - long * ux, to[1] - long * uy];
        self.line(from, [to[0] - 0.7 * long * ux, to[1] - 0.7 * long * uy], Ink::line(color, width));
        let side = |s: f64| [neck[0] - s * wide * uy, neck[1] + s * wide * ux];
        self.path(&[to, side(1.0), side(-1.0)], true, Ink::fill(color));
    }

    /// Writes words in figure markup.
    pub fn text(&mut self, at: Pt, text: &str, label: Label<'_>) {
        self.here(&[at], What::Text(text, label));
    }

    /// Writes words without markup.
    pub fn plain(&mut self, at: Pt, text: &str, label: Label<'_>) {
        self.here(&[at], What::Plain(text, label));
    }

    /// Draws the key of the lines of a figure, one below the other from `at` on, and returns the height of the next
    /// line.
    pub fn key(&mut self, [x, mut y]: Pt, lines: &[(Ink<'_>, &str)]) -> f64 {
        for (ink, text) in lines {
            self.describe(&format!("a line: {text}"));
            self.line([x, y - 2.8], [x + 18.0, y - 2.8], *ink);
            self.text([x + 23.0, y], text, Label { anchor: Anchor::Start, ..SMALL });
            y += 12.0;
        }
        y
    }

    /// Writes a line of words below a key.
    pub fn note(&mut self, at: Pt, text: &str) {
        self.text(at, text, Label { anchor: Anchor::Start, color: GRAY, ..SMALL });
    }

    /// Draws an image from corner to corner: a PNG in base64.
    pub(crate) fn image(&mut self, from: Pt, to: Pt, png: &str) {
        self.here(&[from, to], What::Image(png));
    }

    /// Returns the picture with its title.
    ///
    /// # Errors
    /// The first failure of plotters.
    pub fn finish(self, title: &str) -> Result<String, FigureError> {
        match self.error {
            Some(error) => Err(error),
            None => Ok(self.page.finish(title, &self.described.join("; "))),
        }
    }
}

/// Label of ticks and keys.
pub const SMALL: Label<'static> = Label { size: 8.0, ..LABEL };
