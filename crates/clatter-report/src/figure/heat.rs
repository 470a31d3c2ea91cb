//! A map as a heat map: one pixel a grid point, with a color bar.

use base64::Engine as _;
use clatter::{Map, Quantity};

use crate::svg::{Anchor, BLUES, INK, Ink, LABEL, Label, SAND, Svg};

/// What a quantity is called on the color bar, in figure markup.
fn name(quantity: Quantity) -> String {
    match quantity {
        Quantity::Impacts => "number of impacts".into(),
        Quantity::PeakEnd => "largest velocity shock at the ends, in *v*_0".into(),
        Quantity::PeakCenter => "largest velocity shock at the center, in *v*_0".into(),
        Quantity::PeakAngular => "largest change of angular velocity, in *v*_0/*L*".into(),
        Quantity::NetCenter => "net change of velocity at the center, in *v*_0".into(),
        Quantity::Duration => "duration, in *h*_0/*v*_0".into(),
        Quantity::Zone(x) => format!("safe zone *s* for shocks up to {x} *v*_0"),
    }
}

/// How values become colors.
struct Scale {
    low: f64,
    high: f64,
    log: bool,
}

impl Scale {
    /// Over the finite values; logarithmic if they are positive and span more than two decades.
    fn of(values: &[f64]) -> Self {
        let finite = || values.iter().copied().filter(|v| v.is_finite());
        let (low, high) = finite().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
        let (low, high) = if low > high { (0.0, 1.0) } else { (low, high) };
        Self { low, high, log: low > 0.0 && high > 100.0 * low }
    }
    fn unit(&self, v: f64) -> f64 {
        let (v, a, b) = if self.log { (v.ln(), self.low.ln(), self.high.ln()) } else { (v, self.low, self.high) };
        if b > a { ((v - a) / (b - a)).clamp(0.0, 1.0) } else { 0.5 }
    }
    fn value(&self, x: f64) -> f64 {
        if self.log { self.low * (self.high / self.low).powf(x) } else { self.low + x * (self.high - self.low) }
    }
}

/// The bytes of a palette color `#rrggbb`.
fn rgb(color: &str) -> [u8; 3] {
    let channel = |i: usize| color.get(1 + 2 * i..3 + 2 * i).and_then(|hex| u8::from_str_radix(hex, 16).ok()).unwrap_or(0);
    [channel(0), channel(1), channel(2)]
}

/// The color at 0 ≤ x ≤ 1 of the palette.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss, reason = "a small index, a byte")]
fn color(x: f64) -> [u8; 3] {
    let x = x * (BLUES.len() - 1) as f64;
    let i = (x as usize).min(BLUES.len() - 2);
    let (a, b, t) = (rgb(BLUES[i]), rgb(BLUES[i + 1]), x - i as f64);
    std::array::from_fn(|k| (f64::from(a[k]) + t * (f64::from(b[k]) - f64::from(a[k]))).round() as u8)
}

/// Pixels as a PNG in base64; empty if there are none.
fn png(width: usize, height: usize, pixels: &[u8]) -> String {
    let mut bytes = Vec::new();
    let (Ok(w), Ok(h)) = (u32::try_from(width), u32::try_from(height)) else { return String::new() };
    let mut encoder = png::Encoder::new(&mut bytes, w, h);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(pixels));
    if written.is_err() { String::new() } else { base64::engine::general_purpose::STANDARD.encode(&bytes) }
}

/// A number with at most four significant digits, for ticks.
fn tick(v: f64) -> String {
    if v == 0.0 {
        return "0".into();
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within 0 to 3")]
    let decimals = (2.0 - v.abs().log10().floor()).clamp(0.0, 4.0) as usize;
    if v.abs() >= 1e5 || v.abs() < 1e-3 {
        return format!("{v:.1e}");
    }
    let text = format!("{v:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}

/// The heat map; +∞ is drawn apart.
pub(crate) fn heat(map: &Map) -> String {
    let (left, top, side) = (46.0, 8.0, 250.0);
    let mut svg = Svg::new(390.0, 290.0);
    let scale = Scale::of(&map.values);
    let (nq, ne) = (map.q.points(), map.e.points());
    let mut pixels = Vec::with_capacity(3 * map.values.len());
    for line in map.values.chunks(ne.max(1)).rev() {
        for &v in line {
            pixels.extend(if v.is_finite() { color(scale.unit(v)) } else { rgb(SAND) });
        }
    }
    svg.image([left, top], [side, side], &png(ne, nq, &pixels));
    svg.rect([left, top], [side, side], Ink::line(INK, 0.6));
    let small = Label { size: 8.0, ..LABEL };
    // a grid point is a pixel: the first and last lie half a pixel inside the frame
    #[expect(clippy::cast_precision_loss, reason = "a grid has far fewer than 2^53 points")]
    let inside = |i: usize, n: usize| side * (i as f64 + 0.5) / n.max(1) as f64;
    let mut marks = |n: usize| {
        let mut marks: Vec<usize> = (0..=4).map(|k| k * n.saturating_sub(1) / 4).collect();
        marks.dedup();
        marks
    };
    for i in marks(ne) {
        let x = left + inside(i, ne);
        svg.line([x, top + side], [x, top + side + 3.0], Ink::line(INK, 0.6));
        svg.text([x, top + side + 11.5], &tick(map.e.value(i)), small);
    }
    for i in marks(nq) {
        let y = top + side - inside(i, nq);
        svg.line([left, y], [left - 3.0, y], Ink::line(INK, 0.6));
        svg.text([left - 5.0, y + 2.6], &tick(map.q.value(i)), Label { anchor: Anchor::End, ..small });
    }
    svg.text([left + 0.5 * side, top + side + 24.0], "coefficient of restitution  *e*", LABEL);
    svg.text([left - 30.0, top + 0.5 * side], "inertia ratio  *q*", Label { turn: -90.0, ..LABEL });
    // the bar
    let bar = left + side + 18.0;
    let strip: Vec<u8> = (0..=255u8).rev().flat_map(|i| color(f64::from(i) / 255.0)).collect();
    let endless = map.values.iter().any(|v| !v.is_finite());
    let (from, high) = if endless { (top + 22.0, side - 22.0) } else { (top, side) };
    svg.image([bar, from], [12.0, high], &png(1, 256, &strip));
    svg.rect([bar, from], [12.0, high], Ink::line(INK, 0.5));
    for k in 0..=4u8 {
        let x = f64::from(k) / 4.0;
        let y = from + high * (1.0 - x);
        svg.line([bar + 12.0, y], [bar + 15.0, y], Ink::line(INK, 0.5));
        svg.text([bar + 17.0, y + 2.6], &tick(scale.value(x)), Label { anchor: Anchor::Start, ..small });
    }
    if endless {
        svg.rect([bar, top], [12.0, 12.0], Ink { stroke: INK, width: 0.5, ..Ink::fill(SAND) });
        let word = if map.quantity == Quantity::Impacts { "endless" } else { "infinite" };
        svg.text([bar + 17.0, top + 8.6], word, Label { anchor: Anchor::Start, ..small });
    }
    svg.text([bar + 60.0, top + 0.5 * side], &name(map.quantity), Label { turn: -90.0, ..LABEL });
    svg.finish("Map over restitution and inertia ratio")
}
