//! Surfaces over the design plane, seen from above, with correct hidden surfaces.

use clatter::Map;

use crate::svg::{Anchor, INK, Ink, LABEL, Label, Pt, RUST, Svg, width};

/// One sheet: its heights over the grid of a map, and its name.
#[derive(Debug, Clone)]
pub(crate) struct Sheet {
    pub(crate) map: Map,
    /// Label, in figure markup.
    pub(crate) name: &'static str,
    /// Where the label stands: q, e.
    pub(crate) at: [f64; 2],
    /// Light and dark fill.
    pub(crate) fill: [[u8; 3]; 2],
}

/// Sheets over the plane, lowest first, none crossing another.
#[derive(Debug, Clone)]
pub(crate) struct Surface {
    pub(crate) sheets: Vec<Sheet>,
    /// Height at which they are cut.
    pub(crate) cut: f64,
    /// Title of the vertical axis, in figure markup.
    pub(crate) axis: &'static str,
    /// What the figure shows.
    pub(crate) title: &'static str,
    /// Degrees by which the plane is turned: 45 puts (0, 0) nearest.
    pub(crate) azimuth: f64,
    /// Degrees above the horizon.
    pub(crate) elevation: f64,
}

/// A point (q, e, z).
type P3 = [f64; 3];

/// Where the middle of the box lies on the page, and the size of its floor, in pt.
const CENTER: Pt = [128.0, 116.0];
const SCALE: f64 = 130.0;
/// Height of the box over the side of its floor.
const TALL: f64 = 1.0;

/// Orthographic view.
struct View {
    sin: f64,
    cos: f64,
    lift: f64,
    lower: f64,
    cut: f64,
}

impl View {
    fn new(surface: &Surface) -> Self {
        let (a, b) = (surface.azimuth.to_radians(), surface.elevation.to_radians());
        Self { sin: a.sin(), cos: a.cos(), lift: b.sin(), lower: b.cos(), cut: surface.cut }
    }
    /// On the page: x right, y down, in pt; and the distance towards the eye.
    fn at(&self, [q, e, z]: P3) -> (Pt, f64) {
        let (x, y) = (e - 0.5, q - 0.5);
        let right = x * self.cos - y * self.sin;
        let back = x * self.sin + y * self.cos;
        let up = TALL * (z / self.cut - 0.5);
        ([CENTER[0] + SCALE * right, CENTER[1] - SCALE * (back * self.lift + up * self.lower)], -back)
    }
    fn pt(&self, p: P3) -> Pt {
        self.at(p).0
    }
    /// Towards the light, over the left shoulder of the eye, as (q, e, z).
    fn light(&self) -> P3 {
        let (right, back, up) = (-0.45, -0.4, 0.8);
        [back * self.cos - right * self.sin, right * self.cos + back * self.sin, up]
    }
}

/// The part of a polygon below the cut. 1/z is close to linear beside the pole at q = e = 1, and finite there.
fn below(polygon: &[P3], cut: f64) -> Vec<P3> {
    let mut out = Vec::new();
    for (i, a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        if a[2] <= cut {
            out.push(*a);
        }
        if (a[2] <= cut) != (b[2] <= cut) {
            let t = (1.0 / cut - 1.0 / a[2]) / (1.0 / b[2] - 1.0 / a[2]);
            out.push([a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), cut]);
        }
    }
    out
}

/// Draws the sheets back to front, column by column, and in a column from the lowest up: exact for sheets that
/// are functions of (q, e), seen from above.
pub(crate) fn surface(data: &Surface) -> String {
    let view = View::new(data);
    let mut svg = Svg::new(226.0, 246.0);
    box_back(&mut svg, &view, data);
    let Some(first) = data.sheets.first() else { return svg.finish(data.title) };
    let (nq, ne) = (first.map.q.points(), first.map.e.points());
    let mut columns: Vec<(usize, usize)> = (0..nq - 1).flat_map(|i| (0..ne - 1).map(move |j| (i, j))).collect();
    let near = |(i, j): (usize, usize)| view.at([first.map.q.value(i), first.map.e.value(j), 0.0]).1;
    columns.sort_by(|a, b| near(*a).total_cmp(&near(*b)));
    let light = view.light();
    for (i, j) in columns {
        for sheet in &data.sheets {
            let point = |i: usize, j: usize| [sheet.map.q.value(i), sheet.map.e.value(j), sheet.map.values[i * ne + j]];
            let quad = [point(i, j), point(i, j + 1), point(i + 1, j + 1), point(i + 1, j)];
            let shape = below(&quad, data.cut);
            if shape.len() < 3 {
                continue;
            }
            let page: Vec<Pt> = shape.iter().map(|p| view.pt(*p)).collect();
            let bright = brightness(&shape, data.cut, light);
            let fill = mix(sheet.fill, bright);
            let line = mix([sheet.fill[0].map(|c| c / 4 * 3), sheet.fill[1].map(|c| c / 4 * 3)], bright);
            svg.facet(&page, &fill, &line);
            for w in 0..shape.len() {
                let (a, b) = (shape[w], shape[(w + 1) % shape.len()]);
                if a[2] >= data.cut && b[2] >= data.cut {
                    svg.line(view.pt(a), view.pt(b), Ink::line(RUST, 0.9));
                }
            }
        }
    }
    box_front(&mut svg, &view, data);
    for sheet in &data.sheets {
        let (i, j) = (nearest(nq, sheet.at[0]), nearest(ne, sheet.at[1]));
        let z = sheet.map.values[i * ne + j].min(data.cut);
        let [x, y] = view.pt([sheet.map.q.value(i), sheet.map.e.value(j), z]);
        if !sheet.name.is_empty() {
            let half = 0.5 * width(sheet.name, LABEL.size) + 2.0;
            svg.rect([x - half, y - 5.0], [2.0 * half, 10.0], Ink::fill("#ffffff"));
            svg.text([x, y + 2.7], sheet.name, LABEL);
        }
    }
    svg.finish(data.title)
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "a small index"
)]
fn nearest(points: usize, x: f64) -> usize {
    (x * (points - 1) as f64).round() as usize
}

/// Cosine between the normal and the light, 0 to 1, of a polygon in the box of the figure.
fn brightness(shape: &[P3], cut: f64, light: P3) -> f64 {
    let scaled = |p: P3| [p[0], p[1], p[2] / cut * TALL];
    let mut n = [0.0; 3];
    for k in 0..shape.len() {
        let (a, b) = (scaled(shape[k]), scaled(shape[(k + 1) % shape.len()]));
        for d in 0..3 {
            n[d] += (a[(d + 1) % 3] - b[(d + 1) % 3]) * (a[(d + 2) % 3] + b[(d + 2) % 3]);
        }
    }
    let sign = if n[2] < 0.0 { -1.0 } else { 1.0 };
    let dot: f64 = n.iter().zip(light).map(|(a, b)| sign * a * b).sum();
    let norm: f64 = n.iter().map(|x| x * x).sum();
    if norm > 0.0 { (dot / norm.sqrt()).clamp(0.0, 1.0) } else { 0.5 }
}

fn mix([light, dark]: [[u8; 3]; 2], x: f64) -> String {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between two bytes")]
    let c: [u8; 3] =
        std::array::from_fn(|i| (f64::from(dark[i]) + x * (f64::from(light[i]) - f64::from(dark[i]))).round() as u8);
    format!("#{:02x}{:02x}{:02x}", c[0], c[1], c[2])
}

/// Walls behind and floor.
fn box_back(svg: &mut Svg, view: &View, data: &Surface) {
    let (back_q, back_e) = back(view);
    let rule = Ink::line("#c9cfd6", 0.4);
    let steps = 4u8;
    for k in 0..=5u8 {
        let v = f64::from(k) / 5.0;
        svg.line(view.pt([0.0, v, 0.0]), view.pt([1.0, v, 0.0]), rule);
        svg.line(view.pt([v, 0.0, 0.0]), view.pt([v, 1.0, 0.0]), rule);
        svg.line(view.pt([back_q, v, 0.0]), view.pt([back_q, v, data.cut]), rule);
        svg.line(view.pt([v, back_e, 0.0]), view.pt([v, back_e, data.cut]), rule);
    }
    for k in 0..=steps {
        let z = data.cut * f64::from(k) / f64::from(steps);
        svg.line(view.pt([back_q, 0.0, z]), view.pt([back_q, 1.0, z]), rule);
        svg.line(view.pt([0.0, back_e, z]), view.pt([1.0, back_e, z]), rule);
    }
}

/// The q and the e of the far walls.
fn back(view: &View) -> (f64, f64) {
    let far = |p: P3| view.at(p).1;
    let q = if far([0.0, 0.5, 0.0]) < far([1.0, 0.5, 0.0]) { 0.0 } else { 1.0 };
    let e = if far([0.5, 0.0, 0.0]) < far([0.5, 1.0, 0.0]) { 0.0 } else { 1.0 };
    (q, e)
}

/// Axes with ticks and titles, at the near edges and the left of the box.
fn box_front(svg: &mut Svg, view: &View, data: &Surface) {
    let (back_q, back_e) = back(view);
    let (near_q, near_e) = (1.0 - back_q, 1.0 - back_e);
    let rule = Ink::line(INK, 0.7);
    svg.line(view.pt([near_q, 0.0, 0.0]), view.pt([near_q, 1.0, 0.0]), rule);
    svg.line(view.pt([0.0, near_e, 0.0]), view.pt([1.0, near_e, 0.0]), rule);
    let tick = Label { size: 8.0, ..LABEL };
    // an axis along the floor; ticks and title stand off square to it on the page
    let floor = |svg: &mut Svg, p: &dyn Fn(f64) -> P3, title: &str| {
        let (a, b) = (view.pt(p(0.0)), view.pt(p(1.0)));
        let (a, b) = if a[0] < b[0] { (a, b) } else { (b, a) };
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let length = dx.hypot(dy);
        let away = |v: f64, d: f64| {
            let [x, y] = view.pt(p(v));
            [x - d * dy / length, y + d * dx / length]
        };
        for k in 0..=5u8 {
            let v = f64::from(k) / 5.0;
            svg.line(view.pt(p(v)), away(v, 3.0), Ink::line(INK, 0.6));
            let [x, y] = away(v, 10.0);
            let text = if k == 0 || k == 5 { format!("{v:.0}") } else { format!("{v:.1}") };
            svg.text([x, y + 2.6], &text, tick);
        }
        let turn = dy.atan2(dx).to_degrees();
        let [x, y] = away(0.5, 22.0);
        svg.text([x, y], title, Label { turn, ..LABEL });
    };
    floor(svg, &|v| [near_q, v, 0.0], "restitution *e*");
    floor(svg, &|v| [v, near_e, 0.0], "inertia ratio *q*");
    // the vertical axis stands at the leftmost corner
    let corners = [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0]];
    let left =
        corners.into_iter().min_by(|a, b| view.pt([a[0], a[1], 0.0])[0].total_cmp(&view.pt([b[0], b[1], 0.0])[0]));
    let [q, e] = left.unwrap_or_default();
    svg.line(view.pt([q, e, 0.0]), view.pt([q, e, data.cut]), rule);
    for k in 1..=4u8 {
        let z = data.cut * f64::from(k) / 4.0;
        let [x, y] = view.pt([q, e, z]);
        svg.line([x, y], [x - 3.0, y], Ink::line(INK, 0.6));
        let text = format!("{z:.1}");
        let text = text.trim_end_matches('0').trim_end_matches('.');
        svg.text([x - 5.0, y + 2.6], text, Label { anchor: Anchor::End, ..tick });
    }
    let [x, y] = view.pt([q, e, 0.5 * data.cut]);
    svg.text([x - 24.0, y], data.axis, Label { turn: -90.0, ..LABEL });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_facet_is_cut_at_the_height_and_beside_the_pole() {
        let quad = [[0.0, 0.0, 1.0], [0.0, 1.0, 1.0], [1.0, 1.0, f64::INFINITY], [1.0, 0.0, f64::INFINITY]];
        // 1/z falls linearly from 1 to 0 along the edges to the pole, so that z = 2 lies in the middle
        assert_eq!(below(&quad, 2.0), [[0.0, 0.0, 1.0], [0.0, 1.0, 1.0], [0.5, 1.0, 2.0], [0.5, 0.0, 2.0],]);
        assert_eq!(below(&quad, 0.5), Vec::<P3>::new(), "all above");
    }
}
