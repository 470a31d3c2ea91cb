//! Figures over the design plane: e to the right, q upward, as the paper describes it.

use clatter::contour::Point;
use clatter_figures::FigureError;
use clatter_figures::draw::{BLUES, Chart, GRAY, INK, Ink, LABEL, Label, Paper, Pt, SAND, percent, plane_axes, width};

/// Number of impacts over the plane.
#[derive(Debug, Clone)]
pub struct Impacts {
    /// n and the curve between n and n + 1 impacts.
    pub curves: Vec<(u32, Vec<Point>)>,
    /// The curve from which on the impacts never end.
    pub endless: Vec<Point>,
}

/// Safe zones of one threshold over the plane.
#[derive(Debug, Clone)]
pub struct Zones {
    /// Threshold in v0.
    pub threshold: f64,
    /// Level s and its curve in pieces, q ascending.
    pub levels: Vec<(f64, Vec<Vec<Point>>)>,
    /// Designs to mark, as (q, e).
    pub designs: [[f64; 2]; 4],
}

fn line(chart: &Chart<'_>, curve: &[Point]) -> Vec<Pt> {
    curve.iter().map(|p| chart.at(p.e, p.q)).collect()
}

/// Fills the part of the plane to the left of a curve, or all of it.
fn fill(chart: &Chart<'_>, paper: &mut Paper, curve: &[Point], ends: &[(f64, f64)], color: &str) {
    chart.area(paper, curve.iter().map(|p| (p.e, p.q)).chain(ends.iter().copied()).collect(), color);
}

const SQUARE: [(f64, f64); 4] = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];

/// Returns e(q) of a level over the whole of 0 ≤ q ≤ 1, clamped to the border where the curve is outside.
fn outline(pieces: &[Vec<Point>]) -> Vec<Point> {
    let mut line: Vec<Point> = pieces.concat();
    if let (Some(first), Some(last)) = (line.first().copied(), line.last().copied()) {
        if first.q > 0.0 {
            line.insert(0, Point { q: 0.0, e: first.e.round() });
        }
        if last.q < 1.0 {
            line.push(Point { q: 1.0, e: last.e.round() });
        }
    }
    line
}

/// Returns q of a curve at e, between its points; the curve's e ascends or descends.
fn crossing(curve: &[Point], e: f64) -> Option<f64> {
    curve.windows(2).find_map(|w| {
        let (a, b) = (w[0], w[1]);
        let inside = (a.e - e) * (b.e - e) < 0.0;
        inside.then(|| a.q + (b.q - a.q) * (e - a.e) / (b.e - a.e))
    })
}

/// Draws Fig. 2: the number of impacts.
pub fn impacts(data: &Impacts) -> Result<String, FigureError> {
    let mut paper = Paper::new(300.0, 242.0);
    let chart = plane_axes([88.0, 6.0], 206.0).without_grid(&mut paper, 24.0);
    let side = chart.size[0];
    // from the top down: all of the square is endless, then each region covers the one above it
    fill(&chart, &mut paper, &[], &SQUARE, SAND);
    let left = [(1.0, 0.0), (0.0, 0.0)];
    fill(&chart, &mut paper, &data.endless, &left, BLUES[7]);
    for (i, (_, curve)) in data.curves.iter().enumerate().rev() {
        let down: Vec<Point> = curve.iter().rev().copied().collect();
        fill(&chart, &mut paper, &down, &left, BLUES[i.min(6)]);
    }
    for (_, curve) in &data.curves {
        paper.path(&line(&chart, curve), false, Ink::line("#ffffff", 0.5));
    }
    paper.path(&line(&chart, &data.endless), false, Ink::line(INK, 1.1));
    chart.border(&mut paper);

    // a number in each region, along e = 0.86, as long as there is room for it
    let mut lower = 0.0;
    for (n, curve) in &data.curves {
        let Some(upper) = crossing(curve, 0.86) else { continue };
        if (upper - lower) * side > 8.0 {
            let [x, y] = chart.at(0.86, 0.5 * (lower + upper));
            let color = if *n > 5 { "#ffffff" } else { INK };
            let text = if lower > 0.0 { n.to_string() } else { format!("{n} impacts") };
            paper.text([x, y + 2.9], &text, Label { color, ..LABEL });
        }
        lower = upper;
    }
    let [x, y] = chart.at(0.18, 0.93);
    paper.text([x, y], "endless", LABEL);
    paper.text([x, y + 10.0], "*q* ≥ 2√*e*/(1 + *e*)", LABEL);

    // These are the mass distributions at q = 0, 0.5, 1, beside the axis.
    let (a, b) = (5.0, 47.0);
    let middle = 0.5 * (a + b);
    for (q, shift, dots, name) in [
        (1.0, 4.0, vec![middle], "at the center"),
        (0.5, 0.0, vec![], "uniform"),
        (0.0, -10.0, vec![a + 2.0, b - 2.0], "at the ends"),
    ] {
        let y = chart.at(0.0, q)[1] + shift;
        paper.line([a, y], [b, y], Ink::line(GRAY, if dots.is_empty() { 5.2 } else { 1.2 }));
        for x in dots {
            paper.circle([x, y], 4.2, Ink::fill(INK));
        }
        paper.text([middle, y + 14.0], name, Label { size: 7.5, color: GRAY, ..LABEL });
    }
    paper.finish("Number of impacts over restitution and inertia ratio")
}

/// Returns the place of a label on a curve: its index in the line, point and turn.
fn place(line: &[Pt], half: f64, others: &[Vec<Pt>], taken: &[Pt], chart: &Chart<'_>) -> Option<(f64, Pt, f64)> {
    let length: f64 = line.windows(2).map(|w| (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1])).sum();
    if length < 5.0 * half {
        return None;
    }
    let mut best: Option<(f64, f64)> = None;
    for k in 0..=24u8 {
        let t = 0.2 + 0.6 * f64::from(k) / 24.0;
        let p = along(line, t * length);
        let edge = (0..2).map(|k| (p[k] - chart.corner[k]).min(chart.corner[k] + chart.size[k] - p[k]));
        let edge = edge.fold(f64::INFINITY, f64::min);
        let near = |q: &Pt| (q[0] - p[0]).hypot(q[1] - p[1]);
        let curve = others.iter().flatten().map(near).fold(60.0, f64::min);
        let label = taken.iter().map(near).fold(60.0, f64::min);
        let score = curve.min(20.0) + 0.5 * label.min(40.0) + edge.min(14.0) - 6.0 * (t - 0.5).abs();
        if best.is_none_or(|(s, _)| score > s) {
            best = Some((score, t * length));
        }
    }
    let (_, at) = best?;
    let (a, b) = (along(line, at - half), along(line, at + half));
    let mut turn = (b[1] - a[1]).atan2(b[0] - a[0]).to_degrees();
    if turn > 90.0 {
        turn -= 180.0;
    } else if turn <= -90.0 {
        turn += 180.0;
    }
    Some((at, [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])], turn))
}

/// Returns the point at a distance along a line.
fn along(line: &[Pt], distance: f64) -> Pt {
    let mut left = distance.max(0.0);
    for w in line.windows(2) {
        let d = (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1]);
        if left <= d && d > 0.0 {
            let x = left / d;
            return [w[0][0] + x * (w[1][0] - w[0][0]), w[0][1] + x * (w[1][1] - w[0][1])];
        }
        left -= d;
    }
    line.last().copied().unwrap_or_default()
}

/// Returns the parts of a line before and after the gap for its label.
fn cut(line: &[Pt], from: f64, to: f64) -> [Vec<Pt>; 2] {
    let (mut before, mut after) = (Vec::new(), vec![along(line, to)]);
    let mut at = 0.0;
    for (i, p) in line.iter().enumerate() {
        if i > 0 {
            at += (p[0] - line[i - 1][0]).hypot(p[1] - line[i - 1][1]);
        }
        if at < from {
            before.push(*p);
        } else if at > to {
            after.push(*p);
        }
    }
    before.push(along(line, from));
    [before, after]
}

/// Draws Figs. 5 to 7: the safe zone of one threshold.
pub fn zones(data: &Zones) -> Result<String, FigureError> {
    let mut paper = Paper::new(214.0, 204.0);
    let chart = plane_axes([38.0, 6.0], 168.0).without_grid(&mut paper, 25.0);
    let bare = data.levels.first().is_some_and(|(level, _)| *level <= 0.0);
    fill(&chart, &mut paper, &[], &SQUARE, if bare { SAND } else { BLUES[0] });
    let shade = |i: usize| ((i + usize::from(!bare)) * 7 / (data.levels.len() - usize::from(bare)).max(1)).min(7);
    for (i, (_, pieces)) in data.levels.iter().enumerate() {
        fill(&chart, &mut paper, &outline(pieces), &[(0.0, 1.0), (0.0, 0.0)], BLUES[shade(i)]);
    }
    let lines: Vec<Vec<Vec<Pt>>> =
        data.levels.iter().map(|(_, pieces)| pieces.iter().map(|piece| line(&chart, piece)).collect()).collect();
    let mut taken: Vec<Pt> = data.designs.iter().map(|[q, e]| chart.at(*e, *q)).collect();
    for (i, (level, _)) in data.levels.iter().enumerate() {
        let bound = *level <= 0.0 || *level >= 1.0;
        let ink = if bound { Ink::line(INK, 1.1) } else { Ink::line("#2c5a86", 0.7) };
        let text = percent(*level);
        let half = 0.5 * width(&text, 7.5) + 1.8;
        let others: Vec<Vec<Pt>> =
            lines.iter().enumerate().filter(|(j, _)| *j != i).flat_map(|(_, l)| l.iter().cloned()).collect();
        for curve in &lines[i] {
            let Some((at, [x, y], turn)) = place(curve, half, &others, &taken, &chart) else {
                paper.path(curve, false, ink);
                continue;
            };
            for part in cut(curve, at - half, at + half) {
                paper.path(&part, false, ink);
            }
            taken.push([x, y]);
            let turned = turn.to_radians();
            let base = [x - 2.5 * turned.sin(), y + 2.5 * turned.cos()];
            paper.text(
                base,
                &text,
                Label { size: 7.5, turn, color: if shade(i) > 6 { "#ffffff" } else { INK }, ..LABEL },
            );
        }
    }
    for [q, e] in data.designs {
        paper.circle(chart.at(e, q), 2.0, Ink { stroke: INK, width: 0.8, ..Ink::fill("#ffffff") });
    }
    chart.border(&mut paper);
    let none = data.levels.iter().find(|(level, _)| *level <= 0.0).map(|(_, pieces)| outline(pieces));
    let area =
        |line: &[Point]| line.windows(2).map(|w| (w[1].q - w[0].q) * (1.0 - 0.5 * (w[0].e + w[1].e))).sum::<f64>();
    if none.is_some_and(|line| area(&line) > 0.2) {
        let [x, y] = chart.at(0.72, 0.28);
        paper.text([x, y], "no safe zone", LABEL);
    } else if data.levels.iter().any(|(level, pieces)| *level <= 0.0 && !pieces.is_empty()) {
        let [x, y] = chart.at(0.925, 0.24);
        paper.text([x, y], "none", LABEL);
    }
    if data.levels.iter().any(|(level, pieces)| *level >= 1.0 && !pieces.is_empty()) {
        let [x, y] = chart.at(0.22, 0.2);
        paper.text([x, y], "the whole bar", Label { color: "#ffffff", ..LABEL });
    }
    let x = data.threshold;
    paper.finish(&format!("Safe zone for velocity shocks up to {x} v0, in per cent of the bar"))
}
