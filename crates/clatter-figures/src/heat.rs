//! A map as a heat map: one pixel a grid point, with contours and a color bar.

use base64::Engine as _;
use clatter::{Map, Quantity, Variable};
use plotters::style::RGBColor;
use plotters::style::colors::colormaps::{ColorMap, DerivedColorMap};

use crate::FigureError;
use crate::axis::{Axis, three, tick};
use crate::chart::Axes;
use crate::grid::cells;
use crate::paper::{Paper, SMALL, What};
use crate::style::{Anchor, BLUES, INK, Ink, LABEL, Label, SAND, rgb, width};

/// Returns the name of a quantity on the color bar, in figure markup.
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

/// The map from values to colors: along an axis, which may end below the largest value.
struct Scale {
    axis: Axis<'static>,
    /// The largest value, if it is beyond the axis.
    most: Option<f64>,
}

/// The share of the map below which the scale may end, if that saves half of the colors: a corner must not take them
/// all.
const CUT: f64 = 0.98;

impl Scale {
    /// Creates the scale over the finite values. If none is negative and the positive ones span more than a factor of
    /// 30, it is logarithmic from the smallest positive one on.
    fn of(values: &[f64]) -> Self {
        let mut finite: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
        finite.sort_by(f64::total_cmp);
        let (Some(&low), Some(&high)) = (finite.first(), finite.last()) else {
            return Self { axis: Axis::linear(0.0, 1.0, ""), most: None };
        };
        let least = finite.iter().copied().find(|v| *v > 0.0).unwrap_or(high);
        let up_to = |high: f64| {
            let log = low >= 0.0 && high > 30.0 * least;
            if log { Axis::log(least, high, "") } else { Axis::linear(low, high, "") }
        };
        let whole = up_to(high);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            clippy::cast_precision_loss,
            reason = "an index"
        )]
        let upper = finite[(CUT * (finite.len() - 1) as f64) as usize];
        let saves = upper > whole.low && whole.unit(upper) < 0.5;
        if saves { Self { axis: up_to(upper), most: Some(high) } } else { Self { axis: whole, most: None } }
    }
    /// Returns the place of a value between the ends, 0 to 1.
    fn unit(&self, v: f64) -> f64 {
        let unit = self.axis.unit(v.clamp(self.axis.low, self.axis.high));
        if unit.is_finite() { unit } else { 0.5 }
    }
    /// Returns the levels of contours: the ticks and, where they are even, the middles between them.
    fn levels(&self) -> Vec<f64> {
        let ticks = self.axis.ticks().0;
        let middles = ticks.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).filter(|_| !self.axis.log);
        let middles: Vec<f64> = middles.collect();
        [ticks, middles].concat()
    }
}

/// Returns the palette for plotters.
pub(crate) fn palette() -> DerivedColorMap<RGBColor> {
    let colors = BLUES.map(|color| {
        let [r, g, b] = rgb(color);
        RGBColor(r, g, b)
    });
    DerivedColorMap::new(&colors)
}

/// Returns the color at 0 ≤ x ≤ 1 of the palette.
#[expect(clippy::cast_possible_truncation, reason = "a share")]
pub(crate) fn color(palette: &DerivedColorMap<RGBColor>, x: f64) -> [u8; 3] {
    let RGBColor(r, g, b) = palette.get_color(x as f32);
    [r, g, b]
}

/// Returns pixels as a PNG in base64; empty if there are none.
pub(crate) fn png(width: usize, height: usize, pixels: &[u8]) -> String {
    let mut bytes = Vec::new();
    let (Ok(w), Ok(h)) = (u32::try_from(width), u32::try_from(height)) else { return String::new() };
    let mut encoder = png::Encoder::new(&mut bytes, w, h);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(pixels));
    if written.is_err() { String::new() } else { base64::engine::general_purpose::STANDARD.encode(&bytes) }
}

/// Returns the pixels of a grid point on a side, so that viewers which smooth do so within a point.
fn zoom(points: usize) -> usize {
    500usize.div_ceil(points.max(1)).min(64)
}

/// Returns an axis whose first and last grid points lie half a cell inside the frame.
fn axis(of: clatter::Axis, title: &str) -> Axis<'_> {
    #[expect(clippy::cast_precision_loss, reason = "a grid has far fewer than 2^53 points")]
    let last = of.points().max(1) as f64 - 1.0;
    let (low, high) = (of.value(0), of.value(of.points().max(1) - 1));
    let half = if high > low { 0.5 * (high - low) / last } else { 0.5 };
    Axis::linear(low - half, high + half, title)
}

/// Draws a map as a heat map with a color bar, a cell a grid point, and contours at the ticks of the bar, and between
/// them, where the quantity is continuous; that of no safe zone is bold. Endless (+∞) is shown apart. The color bar is
/// logarithmic where no value is negative and the positive ones span more than a factor of 30; where one corner would
/// take most of the colors, it ends below it, with a note.
///
/// ```
/// use clatter::{Axis, Map, Quantity};
/// let map = Map::compute(Quantity::Impacts, Axis::q(0.0, 1.0, 50)?, Axis::e(0.0, 1.0, 50)?)?;
/// assert!(clatter_figures::map(&map)?.contains("endless"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn map(map: &Map) -> Result<String, FigureError> {
    let (inertia, title) = match map.q.variable() {
        Variable::GyrationRatio => ("gyration ratio *ρ*/*L*", "Map over restitution and gyration ratio"),
        _ => ("inertia ratio *q*", "Map over restitution and inertia ratio"),
    };
    let (scale, palette) = (Scale::of(&map.values), palette());
    let beyond = beyond(map, &scale);
    let words = beyond.iter().map(|(_, text)| WORDS + 1.1 * width(text, SMALL.size) + 4.0);
    let mut paper = Paper::new(words.fold(390.0, f64::max), 290.0);
    let axes = Axes {
        corner: [46.0, 8.0],
        size: [250.0; 2],
        x: axis(map.e, "coefficient of restitution *e*"),
        y: axis(map.q, inertia),
    };
    let chart = axes.without_grid(&mut paper, 30.0);
    let (nq, ne) = (map.q.points(), map.e.points());
    let (wide, high) = (zoom(ne), zoom(nq));
    let mut pixels = Vec::with_capacity(3 * map.values.len() * wide * high);
    for line in map.values.chunks(ne.max(1)).rev() {
        let colors = line.iter().map(|&v| if v.is_finite() { color(&palette, scale.unit(v)) } else { rgb(SAND) });
        let row: Vec<u8> = colors.flat_map(|c| std::iter::repeat_n(c, wide)).flatten().collect();
        pixels.extend(std::iter::repeat_n(row, high).flatten());
    }
    let corners = vec![(axes.x.low, axes.y.high), (axes.x.high, axes.y.low)];
    chart.draw(&mut paper, vec![corners], What::Image(&png(ne * wide, nq * high, &pixels)));
    // Numbers of impacts and quantities that depend on them change by steps, which the colors show.
    if !matches!(map.quantity, Quantity::Impacts | Quantity::Duration) {
        for level in scale.levels() {
            let place = |i: usize, j: usize| (map.e.value(j), map.q.value(i));
            let above = |i: usize, j: usize| map.values.get(i * ne + j).map(|v| v - level).filter(|v| v.is_finite());
            let zero = level == 0.0 && matches!(map.quantity, Quantity::Zone(_));
            let ink = if zero { Ink::line(INK, 1.2) } else { Ink::line(INK, 0.35) };
            chart.draw(&mut paper, cells([nq, ne], place, above).lines, What::Lines(ink));
        }
    }
    chart.border(&mut paper);
    bar(&mut paper, map, &scale, &palette, beyond);
    paper.finish(title)
}

/// Left edges of the color bar and of its words.
const BAR: f64 = 314.0;
const WORDS: f64 = BAR + 17.0;

/// Returns color and words for the values beyond the bar.
fn beyond(map: &Map, scale: &Scale) -> Vec<(&'static str, String)> {
    let mut beyond = Vec::new();
    if map.values.iter().any(|v| !v.is_finite()) {
        beyond.push((SAND, if map.quantity == Quantity::Impacts { "endless" } else { "infinite" }.to_owned()));
    }
    if let Some(most) = scale.most {
        beyond.push((BLUES[BLUES.len() - 1], format!("2 % above, to {}", three(most))));
    }
    beyond
}

/// Draws the color bar with its ticks and title.
fn bar(
    paper: &mut Paper,
    map: &Map,
    scale: &Scale,
    palette: &DerivedColorMap<RGBColor>,
    beyond: Vec<(&'static str, String)>,
) {
    let (left, top, side) = (BAR, 8.0, 250.0);
    let word = |paper: &mut Paper, y: f64, text: &str| {
        paper.text([WORDS, y], text, Label { anchor: Anchor::Start, ..SMALL });
    };
    let rows = beyond.iter().map(|_| 16.0).sum::<f64>();
    let (from, high) = if rows > 0.0 { (top + rows + 6.0, side - rows - 6.0) } else { (top, side) };
    let strip: Vec<u8> = (0..=255u8).rev().flat_map(|i| color(palette, f64::from(i) / 255.0)).collect();
    paper.image([left, from], [left + 12.0, from + high], &png(1, 256, &strip));
    paper.rect([left, from], [12.0, high], Ink::line(INK, 0.5));
    for v in scale.axis.ticks().0 {
        let y = from + high * (1.0 - scale.unit(v));
        paper.line([left + 12.0, y], [left + 15.0, y], Ink::line(INK, 0.5));
        word(paper, y + 2.6, &tick(v));
    }
    for (k, (color, text)) in (0_u8..).zip(beyond) {
        let y = top + 16.0 * f64::from(k);
        paper.rect([left, y], [12.0, 12.0], Ink { stroke: INK, width: 0.5, ..Ink::fill(color) });
        word(paper, y + 8.6, &text);
    }
    paper.text([left + 60.0, top + 0.5 * side], &name(map.quantity), Label { turn: -90.0, ..LABEL });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axis::round_values;
    use clatter::Axis as Of;

    #[test]
    fn ticks_are_round_and_inside() {
        let fifths: Vec<_> = round_values(0.0, 1.0).into_iter().map(tick).collect();
        assert_eq!(fifths, ["0", "0.2", "0.4", "0.6", "0.8", "1"]);
        assert_eq!(round_values(-0.5, 0.9).first(), Some(&-0.5), "the first");
        assert_eq!(round_values(0.3, 0.3), [0.3]);
        let scale = Scale::of(&[2.0, 900.0, f64::INFINITY]);
        assert_eq!(scale.axis.ticks().0, [2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0]);
        let (low, high) = (Scale::of(&[0.0, 1e-300]), Scale::of(&[1e-300, 1e300]));
        assert!(low.axis.ticks().0.len() < 12 && high.axis.ticks().0.len() < 14, "not too many");
    }

    #[test]
    fn a_corner_does_not_take_all_colors_and_what_is_above_is_told() {
        let mut values: Vec<f64> = (0..1000).map(|k| 1.0 + f64::from(k) / 1000.0).collect();
        let even = Scale::of(&values);
        assert!(even.most.is_none() && !even.axis.log);
        values.extend([500.0; 3]);
        let scale = Scale::of(&values);
        assert_eq!(scale.most, Some(500.0));
        assert!((1.9..2.1).contains(&scale.axis.high) && scale.unit(500.0) >= 1.0, "{:?}", scale.axis);
    }

    /// Words of the legend end within the picture, whatever their length.
    #[test]
    fn the_legend_is_not_cut() {
        let mut values: Vec<f64> = (0..1000).map(|k| 1.0 + f64::from(k) / 1000.0).collect();
        values[999] = 123_456.0;
        let axis = |points| Of::q(0.0, 1.0, points).unwrap();
        let (q, e) = (axis(10), Of::e(0.0, 1.0, 100).unwrap());
        let drawn = map(&Map { quantity: Quantity::PeakEnd, q, e, values }).unwrap();
        let wide: f64 = drawn.split("viewBox=\"0 0 ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
        assert!(drawn.contains("2 % above"), "{drawn}");
        // The typeface is at most a tenth wider than the estimate.
        let needs = WORDS + 1.1 * width(&format!("2 % above, to {}", three(123_456.0)), SMALL.size);
        assert!(wide > needs, "{wide} for {needs}");
    }

    /// Returns the width of the first picture in a drawing, and its pixels from the top left on.
    fn picture(drawn: &str) -> (usize, Vec<u8>) {
        let text = drawn.split("data:image/png;base64,").nth(1).unwrap().split('"').next().unwrap();
        let bytes = base64::engine::general_purpose::STANDARD.decode(text).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        (reader.info().width as usize, pixels)
    }

    /// Both run upward and to the right from 0 to 1: the elastic bar with all its mass in the middle, whose shocks grow for ever, is the
    /// cell at the top right, and no other is without end.
    #[test]
    fn a_map_stands_upright_beside_its_axes() {
        let map_of = Map::compute(Quantity::PeakEnd, Of::q(0.0, 1.0, 2).unwrap(), Of::e(0.0, 1.0, 3).unwrap()).unwrap();
        let (wide, pixels) = picture(&map(&map_of).unwrap());
        let high = pixels.len() / 3 / wide;
        let at = |x: usize, y: usize| pixels[3 * (y * wide + x)..][..3].to_vec();
        for (x, y) in [(0, 0), (wide / 2, 0), (0, high - 1), (wide / 2, high - 1), (wide - 1, high - 1)] {
            assert!(at(x, y) != rgb(SAND), "{x}, {y}");
        }
        assert_eq!(at(wide - 1, 0), rgb(SAND));
    }

    /// Three values from 0 to 1 are cells half a unit wide, the first and the last as wide as that between them.
    #[test]
    fn each_value_is_in_the_middle_of_its_cell() {
        let drawn = axis(Of::q(0.0, 1.0, 3).unwrap(), "");
        for (value, share) in [(0.0, 1.0 / 6.0), (0.5, 0.5), (1.0, 5.0 / 6.0)] {
            assert!((drawn.unit(value) - share).abs() < 1e-12, "{value}: {}", drawn.unit(value));
        }
    }

    /// Trains may be endless, and shocks infinite.
    #[test]
    fn what_is_without_end_is_called_so() {
        let drawn = |quantity| {
            map(&Map::compute(quantity, Of::q(0.0, 1.0, 3).unwrap(), Of::e(0.0, 1.0, 3).unwrap()).unwrap()).unwrap()
        };
        let (count, peak) = (drawn(Quantity::Impacts), drawn(Quantity::PeakEnd));
        assert!(count.contains(">endless<") && !count.contains(">infinite<"), "{count}");
        assert!(peak.contains(">infinite<") && !peak.contains(">endless<"), "{peak}");
    }

    #[test]
    fn every_map_can_be_drawn() {
        for (q, e) in [(Of::q(0.2, 0.2, 1), Of::e(0.0, 1.0, 3)), (Of::q(-0.9, 1.0, 2), Of::e(1.0, 1.0, 1))] {
            let (q, e) = (q.unwrap(), e.unwrap());
            for quantity in [Quantity::Impacts, Quantity::PeakEnd, Quantity::Duration, Quantity::Zone(0.5)] {
                let drawn = map(&Map::compute(quantity, q, e).unwrap()).unwrap();
                assert!(drawn.starts_with("<svg") && drawn.ends_with("</svg>\n") && !drawn.contains("NaN"), "{drawn}");
            }
        }
        let nothing = Map {
            quantity: Quantity::PeakEnd,
            q: Of::q(0.0, 1.0, 2).unwrap(),
            e: Of::e(0.0, 1.0, 2).unwrap(),
            values: vec![f64::NAN; 4],
        };
        assert!(!map(&nothing).unwrap().contains("NaN"), "what is no number gets the color apart");
    }
}
