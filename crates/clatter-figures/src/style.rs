//! Colors, lines and labels of the figures.

/// A point on the page.
pub type Pt = [f64; 2];

/// One calm palette, light to dark; its steps differ in gray as well.
pub const BLUES: [&str; 9] =
    ["#f2f6fa", "#e1ebf4", "#cddeed", "#b5cde3", "#98b8d6", "#779fc6", "#5585b3", "#37699a", "#1f4e7c"];
/// Lines and letters.
pub const INK: &str = "#1d2329";
/// Ticks, rules and second voices.
pub const GRAY: &str = "#68717b";
/// Color of special regions: endless, or no safe zone.
pub const SAND: &str = "#efe5d3";
/// Color of the main emphasis.
pub const RUST: &str = "#a34a1c";
/// Color of undecided results.
pub(crate) const OCHRE: &str = "#8f6b00";

/// The typeface of figures and pages, embedded in typst.
pub(crate) const FONT: &str = "Libertinus Serif";

/// The style of a shape.
#[derive(Debug, Clone, Copy)]
pub struct Ink<'a> {
    /// Fill color or `none`.
    pub fill: &'a str,
    /// Line color or `none`.
    pub stroke: &'a str,
    /// Line width in pt.
    pub width: f64,
    /// Lengths of dashes and gaps in pt, empty for a whole line.
    pub dash: &'static str,
}

impl<'a> Ink<'a> {
    /// Creates a whole line of this color, its width in pt.
    #[must_use]
    pub const fn line(stroke: &'a str, width: f64) -> Self {
        Self { fill: "none", stroke, width, dash: "" }
    }
    /// Creates an area of this color, without a line around it.
    #[must_use]
    pub const fn fill(fill: &'a str) -> Self {
        Self { fill, stroke: "none", width: 0.0, dash: "" }
    }
}

/// The position of a label relative to its point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// It begins there.
    Start,
    /// Its middle is there.
    Middle,
    /// It ends there.
    End,
}

/// The style of a label.
#[derive(Debug, Clone, Copy)]
pub struct Label<'a> {
    /// The part of it that lies at its point.
    pub anchor: Anchor,
    /// Font size in pt.
    pub size: f64,
    /// Rotation in degrees, clockwise on the page.
    pub turn: f64,
    /// Color of the letters.
    pub color: &'a str,
}

/// A label in the middle of its point, at the size of the figures' text.
pub const LABEL: Label<'static> = Label { anchor: Anchor::Middle, size: 8.5, turn: 0.0, color: INK };

/// Returns the approximate width of a label, from the widths of the typeface's letters (± 10 %): to keep labels apart.
#[must_use]
pub fn width(text: &str, size: f64) -> f64 {
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

/// Returns the bytes of a palette color `#rrggbb`.
pub(crate) fn rgb(color: &str) -> [u8; 3] {
    let channel =
        |i: usize| color.get(1 + 2 * i..3 + 2 * i).and_then(|hex| u8::from_str_radix(hex, 16).ok()).unwrap_or(0);
    [channel(0), channel(1), channel(2)]
}
