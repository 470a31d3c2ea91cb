//! Surfaces over the design plane, seen from above: the view, walls and coordinates of plotters, hidden surfaces in our order.

use std::f64::consts::PI;

use clatter::Map;
use plotters::chart::{ChartBuilder, ChartContext};
use plotters::coord::cartesian::Cartesian3d;

use crate::FigureError;
use crate::axis::{Axis, tick};
use crate::chart::{styled, units};
use crate::page::{Page, UNITS};
use crate::paper::{Element, Paper, SMALL, What};
use crate::style::{Anchor, INK, Ink, LABEL, Label, Pt, RUST, width};

/// One sheet: its heights over the grid of a map, and its name.
#[derive(Debug, Clone)]
pub struct Sheet {
    /// Its heights.
    pub map: Map,
    /// Label, in figure markup.
    pub name: &'static str,
    /// Place of the label: q, e.
    pub at: [f64; 2],
    /// Light and dark fill.
    pub fill: [[u8; 3]; 2],
}

/// Sheets over the plane, lowest first, none crossing another.
#[derive(Debug, Clone)]
pub struct Surface {
    /// The sheets, from the lowest up.
    pub sheets: Vec<Sheet>,
    /// Height at which they are cut.
    pub cut: f64,
    /// Title of the vertical axis, in figure markup.
    pub axis: &'static str,
    /// Title of the figure.
    pub title: &'static str,
    /// Rotation of the plane in degrees: 45 puts (0, 0) nearest.
    pub azimuth: f64,
    /// Elevation of the eye in degrees above the horizon.
    pub elevation: f64,
}

/// A point (q, e, z).
type P3 = [f64; 3];

/// The middle of the box on the page, and the length of its sides, in pt.
const CENTER: Pt = [128.0, 116.0];
const SIDE: f64 = 130.0;
/// Half the side of the area for plotters, in pt, and the share of it that its box takes.
const HALF: f64 = 106.0;
const SHARE: f64 = 0.8;

/// A box as plotters sees it: q, height and e, the plane turned by the azimuth and seen from the elevation.
struct View<'a> {
    chart: ChartContext<'a, Page, Cartesian3d<Axis<'a>, Axis<'a>, Axis<'a>>>,
    azimuth: f64,
}

impl<'a> View<'a> {
    fn new(paper: &mut Paper, data: &'a Surface) -> Option<Self> {
        let corner = CENTER.map(|c| units(c - HALF));
        let area = paper.root.clone().shrink((corner[0], corner[1]), (units(2.0 * HALF), units(2.0 * HALF)));
        let flat = |title| Axis::linear(0.0, 1.0, title);
        let built = ChartBuilder::on(&area).build_cartesian_3d(
            flat("inertia ratio *q*"),
            Axis::linear(0.0, data.cut, data.axis),
            flat("restitution *e*"),
        );
        let (azimuth, elevation) = (data.azimuth.to_radians(), data.elevation.to_radians());
        let mut chart = paper.keep(built)?;
        chart.with_projection(|mut view| {
            (view.yaw, view.pitch, view.scale) = (1.5 * PI - azimuth, elevation, SIDE / (2.0 * HALF * SHARE));
            view.into_matrix()
        });
        let (rule, empty) = (styled("#c9cfd6", 0.4), |_: &f64| String::new());
        let mut axes = chart.configure_axes();
        axes.max_light_lines(0).x_labels(6).y_labels(6).z_labels(6).tick_size(0);
        axes.bold_grid_style(rule).axis_panel_style(styled("#ffffff", 0.0));
        axes.x_formatter(&empty).y_formatter(&empty).z_formatter(&empty);
        let drawn = axes.draw();
        paper.keep(drawn);
        Some(Self { chart, azimuth })
    }

    fn on_chart([q, e, z]: P3) -> (f64, f64, f64) {
        (q, z, e)
    }
    /// Returns the place on the page, in pt.
    fn pt(&self, p: P3) -> Pt {
        let (x, y) = self.chart.plotting_area().map_coordinate(&Self::on_chart(p));
        [f64::from(x) / UNITS, f64::from(y) / UNITS]
    }
    /// Returns the distance from the eye.
    fn depth(&self, [q, e, z]: P3) -> i32 {
        self.chart.plotting_area().as_coord_spec().projected_depth(&q, &z, &e)
    }
    fn draw(&self, paper: &mut Paper, points: &[P3], what: What<'_>) {
        let pieces = vec![points.iter().map(|p| Self::on_chart(*p)).collect()];
        paper.draw(self.chart.plotting_area(), &Element { pieces, what });
    }
    /// Returns the direction towards the light, over the left shoulder of the eye, as (q, e, z).
    fn light(&self) -> P3 {
        let (right, back, up) = (-0.45, -0.4, 0.8);
        let (sin, cos) = self.azimuth.sin_cos();
        [back * cos - right * sin, right * cos + back * sin, up]
    }
}

/// Returns the part of a polygon below the cut. 1/z is close to linear near the pole at q = e = 1, and finite there.
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
pub fn surface(data: &Surface) -> Result<String, FigureError> {
    let mut paper = Paper::new(CENTER[0] + HALF, 246.0);
    let view = View::new(&mut paper, data);
    if let (Some(view), Some(first)) = (view, data.sheets.first()) {
        let [nq, ne] = [first.map.q.points(), first.map.e.points()];
        facets(&mut paper, &view, data, [nq, ne]);
        front(&mut paper, &view, data);
        for sheet in data.sheets.iter().filter(|sheet| !sheet.name.is_empty()) {
            let (i, j) = (nearest(nq, sheet.at[0]), nearest(ne, sheet.at[1]));
            let z = sheet.map.values[i * ne + j].min(data.cut);
            let [x, y] = view.pt([sheet.map.q.value(i), sheet.map.e.value(j), z]);
            let half = 0.5 * width(sheet.name, LABEL.size) + 2.0;
            paper.rect([x - half, y - 5.0], [2.0 * half, 10.0], Ink::fill("#ffffff"));
            paper.text([x, y + 2.7], sheet.name, LABEL);
        }
    }
    paper.finish(data.title)
}

fn facets(paper: &mut Paper, view: &View<'_>, data: &Surface, [nq, ne]: [usize; 2]) {
    let first = &data.sheets[0].map;
    let mut columns: Vec<(usize, usize)> = (0..nq - 1).flat_map(|i| (0..ne - 1).map(move |j| (i, j))).collect();
    columns.sort_by_key(|&(i, j)| std::cmp::Reverse(view.depth([first.q.value(i), first.e.value(j), 0.0])));
    let light = view.light();
    for (i, j) in columns {
        for Sheet { map, fill, .. } in &data.sheets {
            let point = |i: usize, j: usize| [map.q.value(i), map.e.value(j), map.values[i * ne + j]];
            let shape = below(&[point(i, j), point(i, j + 1), point(i + 1, j + 1), point(i + 1, j)], data.cut);
            if shape.len() < 3 {
                continue;
            }
            let bright = brightness(&shape, data.cut, light);
            let (color, line) = (mix(*fill, bright), mix(fill.map(|c| c.map(|c| c / 4 * 3)), bright));
            view.draw(paper, &shape, What::Area(Ink { stroke: &line, width: 0.25, ..Ink::fill(&color) }));
            for (k, a) in shape.iter().enumerate() {
                let b = shape[(k + 1) % shape.len()];
                if a[2] >= data.cut && b[2] >= data.cut {
                    view.draw(paper, &[*a, b], What::Lines(Ink::line(RUST, 0.9)));
                }
            }
        }
    }
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

/// Returns the cosine between the normal and the light, 0 to 1, of a polygon in the box of the figure.
fn brightness(shape: &[P3], cut: f64, light: P3) -> f64 {
    let scaled = |p: P3| [p[0], p[1], p[2] / cut];
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

/// Draws axes with ticks and titles, at the near edges of the floor and the leftmost corner: those of plotters overlap.
fn front(paper: &mut Paper, view: &View<'_>, data: &Surface) {
    let nearer = |a: P3, b: P3| if view.depth(a) < view.depth(b) { 0.0 } else { 1.0 };
    let near_q = nearer([0.0, 0.5, 0.0], [1.0, 0.5, 0.0]);
    let near_e = nearer([0.5, 0.0, 0.0], [0.5, 1.0, 0.0]);
    // ticks and title stand off square to an axis along the floor
    let floor = |paper: &mut Paper, p: &dyn Fn(f64) -> P3, title: &str| {
        let (a, b) = (view.pt(p(0.0)), view.pt(p(1.0)));
        let (a, b) = if a[0] < b[0] { (a, b) } else { (b, a) };
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let length = dx.hypot(dy);
        let away = |v: f64, d: f64| {
            let [x, y] = view.pt(p(v));
            [x - d * dy / length, y + d * dx / length]
        };
        paper.line(a, b, Ink::line(INK, 0.7));
        for k in 0..=5u8 {
            let v = f64::from(k) / 5.0;
            paper.line(view.pt(p(v)), away(v, 3.0), Ink::line(INK, 0.6));
            let [x, y] = away(v, 10.0);
            paper.text([x, y + 2.6], &tick(v), SMALL);
        }
        paper.text(away(0.5, 22.0), title, Label { turn: dy.atan2(dx).to_degrees(), ..LABEL });
    };
    floor(paper, &|v| [near_q, v, 0.0], "restitution *e*");
    floor(paper, &|v| [v, near_e, 0.0], "inertia ratio *q*");
    let corners = [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0]];
    let left =
        corners.into_iter().min_by(|[q, e], [p, d]| view.pt([*q, *e, 0.0])[0].total_cmp(&view.pt([*p, *d, 0.0])[0]));
    let [q, e] = left.unwrap_or_default();
    paper.line(view.pt([q, e, 0.0]), view.pt([q, e, data.cut]), Ink::line(INK, 0.7));
    for k in 1..=4u8 {
        let z = data.cut * f64::from(k) / 4.0;
        let [x, y] = view.pt([q, e, z]);
        paper.line([x, y], [x - 3.0, y], Ink::line(INK, 0.6));
        paper.text([x - 5.0, y + 2.6], &tick(z), Label { anchor: Anchor::End, ..SMALL });
    }
    let [x, y] = view.pt([q, e, 0.5 * data.cut]);
    paper.text([x - 24.0, y], data.axis, Label { turn: -90.0, ..LABEL });
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
