//! Figures over the design plane: e to the right, q upward, as the paper's words have it.

use clatter::contour::Point;

use crate::svg::{Anchor, BLUES, GRAY, INK, Ink, LABEL, Label, Pt, SAND, Svg, width};

/// Number of impacts over the plane.
#[derive(Debug, Clone)]
pub(crate) struct Impacts {
    /// n and the curve between n and n + 1 impacts.
    pub(crate) curves: Vec<(u32, Vec<Point>)>,
    /// The curve from which on the impacts never end.
    pub(crate) endless: Vec<Point>,
}

/// Safe zones of one threshold over the plane.
#[derive(Debug, Clone)]
pub(crate) struct Zones {
    /// Threshold in v0.
    pub(crate) threshold: f64,
    /// Level s and its curve in pieces, q ascending.
    pub(crate) levels: Vec<(f64, Vec<Vec<Point>>)>,
    /// Designs to mark, as (q, e).
    pub(crate) designs: [[f64; 2]; 4],
}

/// The frame: left, top and the side of the square, in pt.
#[derive(Debug, Clone, Copy)]
struct Frame {
    left: f64,
    top: f64,
    side: f64,
}

impl Frame {
    fn at(self, p: Point) -> Pt {
        [self.left + p.e * self.side, self.top + (1.0 - p.q) * self.side]
    }
    fn line(self, curve: &[Point]) -> Vec<Pt> {
        curve.iter().map(|p| self.at(*p)).collect()
    }
    fn corner(self, q: f64, e: f64) -> Pt {
        self.at(Point { q, e })
    }

    /// Border, ticks and titles; `titles` is how far left the title of q stands.
    fn draw(self, svg: &mut Svg, titles: f64) {
        svg.rect([self.left, self.top], [self.side, self.side], Ink::line(INK, 0.6));
        let tick = Label { size: 8.0, color: INK, ..LABEL };
        for i in 0..=5u8 {
            let v = f64::from(i) / 5.0;
            let text = if i == 0 || i == 5 { format!("{v:.0}") } else { format!("{v:.1}") };
            let [x, y] = self.corner(0.0, v);
            svg.line([x, y], [x, y + 3.0], Ink::line(INK, 0.6));
            svg.text([x, y + 11.5], &text, tick);
            let [x, y] = self.corner(v, 0.0);
            svg.line([x, y], [x - 3.0, y], Ink::line(INK, 0.6));
            svg.text([x - 5.0, y + 2.6], &text, Label { anchor: Anchor::End, ..tick });
        }
        let [x, y] = self.corner(0.0, 0.5);
        svg.text([x, y + 24.0], "coefficient of restitution *e*", LABEL);
        let [x, y] = self.corner(0.5, 0.0);
        svg.text([x - titles, y], "inertia ratio *q*", Label { turn: -90.0, ..LABEL });
    }
}

/// e(q) of a level over the whole of 0 ≤ q ≤ 1, held at the border where the curve is outside.
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

/// q of a curve at e, between its points; the curve's e ascends or descends.
fn crossing(curve: &[Point], e: f64) -> Option<f64> {
    curve.windows(2).find_map(|w| {
        let (a, b) = (w[0], w[1]);
        let inside = (a.e - e) * (b.e - e) < 0.0;
        inside.then(|| a.q + (b.q - a.q) * (e - a.e) / (b.e - a.e))
    })
}

/// Fig. 2: the number of impacts.
pub(crate) fn impacts(data: &Impacts) -> String {
    let frame = Frame { left: 88.0, top: 6.0, side: 206.0 };
    let mut svg = Svg::new(300.0, 242.0);
    // from the top down: all of the square is endless, then each region covers the one above it
    svg.rect([frame.left, frame.top], [frame.side, frame.side], Ink::fill(SAND));
    let below = |svg: &mut Svg, curve: &[Point], fill| {
        let mut shape = frame.line(curve);
        shape.extend([frame.corner(0.0, 1.0), frame.corner(0.0, 0.0)]);
        svg.path(&shape, true, Ink::fill(fill));
    };
    below(&mut svg, &data.endless, BLUES[7]);
    for (i, (_, curve)) in data.curves.iter().enumerate().rev() {
        let mut curve = curve.clone();
        curve.reverse();
        below(&mut svg, &curve, BLUES[i.min(6)]);
    }
    for (_, curve) in &data.curves {
        svg.path(&frame.line(curve), false, Ink::line("#ffffff", 0.5));
    }
    svg.path(&frame.line(&data.endless), false, Ink::line(INK, 1.1));
    frame.draw(&mut svg, 24.0);

    // a number in each region, along e = 0.86, as long as there is room for it
    let mut lower = 0.0;
    for (n, curve) in &data.curves {
        let Some(upper) = crossing(curve, 0.86) else { continue };
        if (upper - lower) * frame.side > 8.0 {
            let [x, y] = frame.corner(0.5 * (lower + upper), 0.86);
            let color = if *n > 5 { "#ffffff" } else { INK };
            let text = if lower > 0.0 { n.to_string() } else { format!("{n} impacts") };
            svg.text([x, y + 2.9], &text, Label { color, ..LABEL });
        }
        lower = upper;
    }
    let [x, y] = frame.corner(0.93, 0.18);
    svg.text([x, y], "endless", LABEL);
    svg.text([x, y + 10.0], "*q* ≥ 2√*e*/(1 + *e*)", LABEL);

    // how the mass lies at q = 0, 0.5, 1, beside the axis
    let (a, b) = (5.0, 47.0);
    let middle = 0.5 * (a + b);
    for (q, shift, dots, name) in [
        (1.0, 4.0, vec![middle], "at the center"),
        (0.5, 0.0, vec![], "uniform"),
        (0.0, -10.0, vec![a + 2.0, b - 2.0], "at the ends"),
    ] {
        let y = frame.corner(q, 0.0)[1] + shift;
        svg.line([a, y], [b, y], Ink::line(GRAY, if dots.is_empty() { 5.2 } else { 1.2 }));
        for x in dots {
            svg.circle([x, y], 4.2, Ink::fill(INK));
        }
        svg.text([middle, y + 14.0], name, Label { size: 7.5, color: GRAY, ..LABEL });
    }
    svg.finish("Number of impacts over restitution and inertia ratio")
}

/// Where a label sits on a curve: its index in the line, point and turn.
fn place(line: &[Pt], half: f64, others: &[Vec<Pt>], taken: &[Pt], frame: Frame) -> Option<(f64, Pt, f64)> {
    let length: f64 = line.windows(2).map(|w| (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1])).sum();
    if length < 5.0 * half {
        return None;
    }
    let mut best: Option<(f64, f64)> = None;
    for k in 0..=24u8 {
        let t = 0.2 + 0.6 * f64::from(k) / 24.0;
        let p = along(line, t * length);
        let edge = [p[0] - frame.left, frame.left + frame.side - p[0], p[1] - frame.top, frame.top + frame.side - p[1]]
            .into_iter()
            .fold(f64::INFINITY, f64::min);
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

/// The point at a distance along a line.
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

/// The parts of a line before and after the gap for its label.
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

/// Figs. 5 to 7: the safe zone of one threshold.
pub(crate) fn zones(data: &Zones) -> String {
    let frame = Frame { left: 38.0, top: 6.0, side: 168.0 };
    let mut svg = Svg::new(214.0, 204.0);
    let bare = data.levels.first().is_some_and(|(level, _)| *level <= 0.0);
    svg.rect([frame.left, frame.top], [frame.side, frame.side], Ink::fill(if bare { SAND } else { BLUES[0] }));
    let shade = |i: usize| ((i + usize::from(!bare)) * 7 / (data.levels.len() - usize::from(bare)).max(1)).min(7);
    for (i, (_, pieces)) in data.levels.iter().enumerate() {
        let mut shape = frame.line(&outline(pieces));
        shape.extend([frame.corner(1.0, 0.0), frame.corner(0.0, 0.0)]);
        svg.path(&shape, true, Ink::fill(BLUES[shade(i)]));
    }
    let lines: Vec<Vec<Vec<Pt>>> =
        data.levels.iter().map(|(_, pieces)| pieces.iter().map(|piece| frame.line(piece)).collect()).collect();
    let mut taken: Vec<Pt> = data.designs.iter().map(|[q, e]| frame.corner(*q, *e)).collect();
    for (i, (level, _)) in data.levels.iter().enumerate() {
        let bound = *level <= 0.0 || *level >= 1.0;
        let ink = if bound { Ink::line(INK, 1.1) } else { Ink::line("#2c5a86", 0.7) };
        let text = percent(*level);
        let half = 0.5 * width(&text, 7.5) + 1.8;
        let others: Vec<Vec<Pt>> =
            lines.iter().enumerate().filter(|(j, _)| *j != i).flat_map(|(_, l)| l.iter().cloned()).collect();
        for line in &lines[i] {
            let Some((at, [x, y], turn)) = place(line, half, &others, &taken, frame) else {
                svg.path(line, false, ink);
                continue;
            };
            for part in cut(line, at - half, at + half) {
                svg.path(&part, false, ink);
            }
            taken.push([x, y]);
            let turned = turn.to_radians();
            let base = [x - 2.5 * turned.sin(), y + 2.5 * turned.cos()];
            svg.text(
                base,
                &text,
                Label { size: 7.5, turn, color: if shade(i) > 6 { "#ffffff" } else { INK }, ..LABEL },
            );
        }
    }
    for [q, e] in data.designs {
        svg.circle(frame.corner(q, e), 2.0, Ink { stroke: INK, width: 0.8, ..Ink::fill("#ffffff") });
    }
    frame.draw(&mut svg, 25.0);
    let none = data.levels.iter().find(|(level, _)| *level <= 0.0).map(|(_, pieces)| outline(pieces));
    let area =
        |line: &[Point]| line.windows(2).map(|w| (w[1].q - w[0].q) * (1.0 - 0.5 * (w[0].e + w[1].e))).sum::<f64>();
    if none.is_some_and(|line| area(&line) > 0.2) {
        let [x, y] = frame.corner(0.28, 0.72);
        svg.text([x, y], "no safe zone", LABEL);
    } else if data.levels.iter().any(|(level, pieces)| *level <= 0.0 && !pieces.is_empty()) {
        let [x, y] = frame.corner(0.24, 0.925);
        svg.text([x, y], "none", LABEL);
    }
    if data.levels.iter().any(|(level, pieces)| *level >= 1.0 && !pieces.is_empty()) {
        let [x, y] = frame.corner(0.2, 0.22);
        svg.text([x, y], "the whole bar", Label { color: "#ffffff", ..LABEL });
    }
    let x = data.threshold;
    svg.finish(&format!("Safe zone for velocity shocks up to {x} v0, in per cent of the bar"))
}

/// A level in per cent.
pub(crate) fn percent(level: f64) -> String {
    let text = format!("{:.1}", 100.0 * level);
    format!("{} %", text.trim_end_matches('0').trim_end_matches('.'))
}
