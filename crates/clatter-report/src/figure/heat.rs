//! A map as a heat map: one pixel a grid point, with a color bar.

use base64::Engine as _;
use clatter::{Map, Quantity, Variable};

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
    /// Over the finite values. If none is negative and the positive ones span more than a factor of 30, logarithmic
    /// from the smallest positive one on.
    fn of(values: &[f64]) -> Self {
        let range = |from: f64| {
            let inside = values.iter().copied().filter(|v| v.is_finite() && *v >= from);
            inside.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)))
        };
        let (low, high) = range(f64::NEG_INFINITY);
        let (least, _) = range(f64::MIN_POSITIVE);
        if low > high {
            Self { low: 0.0, high: 1.0, log: false }
        } else if low >= 0.0 && high > 30.0 * least {
            Self { low: least, high, log: true }
        } else {
            Self { low, high, log: false }
        }
    }
    /// Where a value lies between the ends, 0 to 1.
    fn unit(&self, v: f64) -> f64 {
        let v = v.clamp(self.low, self.high);
        let (v, a, b) = if self.log { (v.ln(), self.low.ln(), self.high.ln()) } else { (v, self.low, self.high) };
        if b > a { (v - a) / (b - a) } else { 0.5 }
    }
    /// Round values for ticks.
    fn ticks(&self) -> Vec<f64> {
        if !self.log {
            return round_values(self.low, self.high);
        }
        let decades = (self.high / self.low).log10();
        let steps: &[f64] = if decades < 3.5 { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let first = self.low.log10().floor();
        let mut ticks = Vec::new();
        for k in 0..=308u16 {
            let decade = 10f64.powf(first + f64::from(k));
            if decade > self.high {
                break;
            }
            ticks.extend(steps.iter().map(|s| s * decade).filter(|v| (self.low..=self.high).contains(v)));
        }
        let every = ticks.len().div_ceil(10).max(1);
        ticks.into_iter().step_by(every).collect()
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
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|k| k * decade).find(|s| *s >= rough * 0.999).unwrap_or(rough);
    let first = (low / step - 1e-9).ceil();
    let all = (0..=12u8).map(|k| (first + f64::from(k)) * step);
    all.filter(|v| *v <= high + 1e-9 * span).collect()
}

/// The bytes of a palette color `#rrggbb`.
fn rgb(color: &str) -> [u8; 3] {
    let channel =
        |i: usize| color.get(1 + 2 * i..3 + 2 * i).and_then(|hex| u8::from_str_radix(hex, 16).ok()).unwrap_or(0);
    [channel(0), channel(1), channel(2)]
}

/// The color at 0 ≤ x ≤ 1 of the palette.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "a small index, a byte"
)]
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

/// A round value, for a tick.
fn tick(v: f64) -> String {
    if v != 0.0 && !(1e-3..1e5).contains(&v.abs()) {
        return format!("{v:.0e}").replace('-', "−");
    }
    let text = format!("{v:.4}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.replace('-', "−") }
}

/// Pixels a grid point gets on a side, so that viewers which smooth do so within a point.
fn zoom(points: usize) -> usize {
    500usize.div_ceil(points.max(1)).min(64)
}

/// The heat map; +∞ is drawn apart.
pub(crate) fn heat(map: &Map) -> String {
    let (left, top, side) = (46.0, 8.0, 250.0);
    let mut svg = Svg::new(390.0, 290.0);
    let scale = Scale::of(&map.values);
    let (nq, ne) = (map.q.points(), map.e.points());
    let (wide, high) = (zoom(ne), zoom(nq));
    let mut pixels = Vec::with_capacity(3 * map.values.len() * wide * high);
    for line in map.values.chunks(ne.max(1)).rev() {
        let colors = line.iter().map(|&v| if v.is_finite() { color(scale.unit(v)) } else { rgb(SAND) });
        let row: Vec<u8> = colors.flat_map(|c| std::iter::repeat_n(c, wide)).flatten().collect();
        pixels.extend(std::iter::repeat_n(row, high).flatten());
    }
    svg.image([left, top], [side, side], &png(ne * wide, nq * high, &pixels));
    svg.rect([left, top], [side, side], Ink::line(INK, 0.6));
    let small = Label { size: 8.0, ..LABEL };
    // a grid point is a cell: the first and last lie half a cell inside the frame
    #[expect(clippy::cast_precision_loss, reason = "a grid has far fewer than 2^53 points")]
    let marks = |axis: clatter::Axis| {
        let n = axis.points().max(1);
        let (low, high) = (axis.value(0), axis.value(n - 1));
        let inside = move |v: f64| {
            let unit = if high > low { (v - low) / (high - low) } else { 0.0 };
            side * (unit * (n - 1) as f64 + 0.5) / n as f64
        };
        round_values(low, high).into_iter().map(move |v| (inside(v), tick(v)))
    };
    for (x, text) in marks(map.e) {
        svg.line([left + x, top + side], [left + x, top + side + 3.0], Ink::line(INK, 0.6));
        svg.text([left + x, top + side + 11.5], &text, small);
    }
    for (y, text) in marks(map.q) {
        let y = top + side - y;
        svg.line([left, y], [left - 3.0, y], Ink::line(INK, 0.6));
        svg.text([left - 5.0, y + 2.6], &text, Label { anchor: Anchor::End, ..small });
    }
    svg.text([left + 0.5 * side, top + side + 24.0], "coefficient of restitution *e*", LABEL);
    let (inertia, title) = match map.q.variable() {
        Variable::GyrationRatio => ("gyration ratio *ρ*/*L*", "Map over restitution and gyration ratio"),
        _ => ("inertia ratio *q*", "Map over restitution and inertia ratio"),
    };
    svg.text([left - 30.0, top + 0.5 * side], inertia, Label { turn: -90.0, ..LABEL });
    // the bar
    let bar = left + side + 18.0;
    let strip: Vec<u8> = (0..=255u8).rev().flat_map(|i| color(f64::from(i) / 255.0)).collect();
    let endless = map.values.iter().any(|v| !v.is_finite());
    let (from, high) = if endless { (top + 22.0, side - 22.0) } else { (top, side) };
    svg.image([bar, from], [12.0, high], &png(1, 256, &strip));
    svg.rect([bar, from], [12.0, high], Ink::line(INK, 0.5));
    for v in scale.ticks() {
        let y = from + high * (1.0 - scale.unit(v));
        svg.line([bar + 12.0, y], [bar + 15.0, y], Ink::line(INK, 0.5));
        svg.text([bar + 17.0, y + 2.6], &tick(v), Label { anchor: Anchor::Start, ..small });
    }
    if endless {
        svg.rect([bar, top], [12.0, 12.0], Ink { stroke: INK, width: 0.5, ..Ink::fill(SAND) });
        let word = if map.quantity == Quantity::Impacts { "endless" } else { "infinite" };
        svg.text([bar + 17.0, top + 8.6], word, Label { anchor: Anchor::Start, ..small });
    }
    svg.text([bar + 60.0, top + 0.5 * side], &name(map.quantity), Label { turn: -90.0, ..LABEL });
    svg.finish(title)
}

#[cfg(test)]
mod tests {
    use super::*;
    use clatter::Axis;

    #[test]
    fn ticks_are_round_and_inside() {
        let fifths: Vec<_> = round_values(0.0, 1.0).into_iter().map(tick).collect();
        assert_eq!(fifths, ["0", "0.2", "0.4", "0.6", "0.8", "1"]);
        assert_eq!(round_values(-0.5, 0.9).first(), Some(&-0.5), "the first");
        assert_eq!(round_values(0.3, 0.3), [0.3]);
        let scale = Scale::of(&[2.0, 900.0, f64::INFINITY]);
        assert_eq!(scale.ticks(), [2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0]);
        let (low, high) = (Scale::of(&[0.0, 1e-300]), Scale::of(&[1e-300, 1e300]));
        assert!(low.ticks().len() < 12 && high.ticks().len() < 12, "not too many");
    }

    #[test]
    fn every_map_can_be_drawn() {
        for (q, e) in [(Axis::q(0.2, 0.2, 1), Axis::e(0.0, 1.0, 3)), (Axis::q(-0.9, 1.0, 2), Axis::e(1.0, 1.0, 1))] {
            let (q, e) = (q.unwrap(), e.unwrap());
            for quantity in [Quantity::Impacts, Quantity::PeakEnd, Quantity::Duration, Quantity::Zone(0.5)] {
                let svg = heat(&Map::compute(quantity, q, e).unwrap());
                assert!(svg.starts_with("<svg") && svg.ends_with("</svg>\n") && !svg.contains("NaN"), "{svg}");
            }
        }
        let nothing = Map {
            quantity: Quantity::PeakEnd,
            q: Axis::q(0.0, 1.0, 2).unwrap(),
            e: Axis::e(0.0, 1.0, 2).unwrap(),
            values: vec![f64::NAN; 4],
        };
        assert!(!heat(&nothing).contains("NaN"), "what is no number gets the color apart");
    }
}
