//! The design plane of a product and the front of the largest safe zone.

use clatter::contour::Point;
use clatter::design::{Front, FrontPoint};

use crate::FigureError;
use crate::axis::Axis;
use crate::chart::{Axes, Chart};
use crate::grid::{Cells, Shape, cells};
use crate::paper::{Paper, SMALL, What};
use crate::plane::{percent, plane_axes};
use crate::style::{Anchor, BLUES, GRAY, INK, Ink, LABEL, Label, Pt, RUST, SAND};

/// The safe part of the plane of (q, e).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DesignPlane {
    /// Name of each part that has to be safe, and its border.
    pub borders: Vec<(String, DesignBorder)>,
    /// The product: q, and the low and high end of e.
    pub product: Option<(f64, [f64; 2])>,
    /// The model of the drops of the product, in a few words.
    pub model: String,
    /// Ranges of q and e that can be built.
    pub reach: Option<[[f64; 2]; 2]>,
    /// Designs to compare with, by name.
    pub designs: Vec<(String, Point)>,
}

/// The border between safe and unsafe designs.
#[derive(Debug, Clone, PartialEq)]
pub enum DesignBorder {
    /// Safe below these curves e(q), q ascending in each; without any, nowhere.
    Exact(Vec<Vec<Point>>),
    /// Margins on a square grid over 0 ≤ q ≤ 1, 0 ≤ e ≤ 1 of `side` values each, e fastest; safe from 0 on.
    Grid {
        /// Values of q, and of e.
        side: usize,
        /// allowed/demand − 1; none where it is unknown.
        margins: Vec<Option<f64>>,
    },
}

/// Color of the safe part of the plane.
const SAFE: &str = BLUES[2];
const BORDER: Ink<'static> = Ink::line("#2c5a86", 0.9);
/// Color of the unknown part.
const UNKNOWN: &str = "#ffffff";
/// Length beyond which names are cut.
const LONGEST_NAME: usize = 26;

fn drawn(border: &DesignBorder) -> Cells {
    match border {
        DesignBorder::Exact(pieces) => {
            let Cells { mut shapes, mut lines, unknown } = Cells::default();
            let band = |from: f64, to: f64| vec![(0.0, from), (1.0, from), (1.0, to), (0.0, to)];
            let mut covered = 0.0;
            for piece in pieces {
                let (Some(first), Some(last)) = (piece.first(), piece.last()) else { continue };
                if first.q > covered {
                    shapes.push(band(covered, first.q));
                }
                let curve: Shape = piece.iter().map(|p| (p.e, p.q)).collect();
                let mut shape = curve.clone();
                shape.extend([(1.0, last.q), (1.0, first.q)]);
                shapes.push(shape);
                // along e = 1 the border is that of the plane
                let inner = curve.split(|(e, _)| *e >= 1.0).filter(|part| part.len() > 1);
                lines.extend(inner.map(|part| part.iter().rev().copied().collect()));
                covered = last.q;
            }
            if covered < 1.0 {
                shapes.push(band(covered, 1.0));
            }
            Cells { shapes, lines, unknown }
        }
        DesignBorder::Grid { side, margins } => grid(*side, margins),
    }
}

/// Returns the lines where margins on a grid vanish, linear in the logarithm of allowed over demand.
fn grid(side: usize, margins: &[Option<f64>]) -> Cells {
    #[expect(clippy::cast_precision_loss, reason = "a small count")]
    let at = |i: usize| i as f64 / (side.max(2) - 1) as f64;
    let margin = |i: usize, j: usize| margins.get(i * side + j).copied().flatten();
    cells([side; 2], |i, j| (at(j), at(i)), |i, j| margin(i, j).map(|m| m.ln_1p().clamp(-2.0, 2.0)))
}

/// Draws a letter or number at a point.
fn badge(paper: &mut Paper, [x, y]: Pt, text: &str) {
    paper.circle([x, y], 5.2, Ink { stroke: "#2c5a86", width: 0.6, ..Ink::fill("#ffffff") });
    paper.text([x, y + 2.6], text, Label { size: 7.5, ..LABEL });
}

/// Draws short strokes on the unsafe side of a border.
fn barbs(paper: &mut Paper, chart: &Chart<'_>, lines: &[Shape]) {
    const APART: f64 = 8.0;
    let mut since = 0.5 * APART;
    for line in lines {
        let page: Vec<Pt> = line.iter().map(|(e, q)| chart.at(*e, *q)).collect();
        for w in page.windows(2) {
            let (dx, dy) = (w[1][0] - w[0][0], w[1][1] - w[0][1]);
            let length = dx.hypot(dy);
            let mut along = APART - since;
            while along <= length {
                let (x, y) = (w[0][0] + along / length * dx, w[0][1] + along / length * dy);
                paper.line([x, y], [x + 3.2 * dy / length, y - 3.2 * dx / length], BORDER);
                along += APART;
            }
            since = length - (along - APART);
        }
    }
}

/// Draws the inertia ratios and restitutions that make the parts of a product safe.
///
/// ```
/// use clatter::design::{Goal, region};
/// use clatter_figures::{DesignBorder, DesignPlane};
/// let border = DesignBorder::Exact(region(&[Goal::zone(0.5, 0.1)?], 1e-3));
/// let plane = DesignPlane { borders: vec![("display".into(), border)], ..DesignPlane::default() };
/// assert!(clatter_figures::design_plane(&plane)?.contains("coefficient of restitution"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn plane(data: &DesignPlane) -> Result<String, FigureError> {
    let axes = plane_axes([40.0, 8.0], 220.0);
    let right = axes.corner[0] + axes.size[0] + 14.0;
    let rows = 12.0 * f64::from(u32::try_from(data.borders.len() + data.designs.len()).unwrap_or(u32::MAX)) + 96.0;
    let mut paper = Paper::new(right + 150.0, (axes.corner[1] + axes.size[1] + 30.0).max(rows));
    let chart = axes.without_grid(&mut paper, 26.0);
    paper.rect(axes.corner, axes.size, Ink::fill(SAFE));
    let parts: Vec<_> = data.borders.iter().map(|(name, border)| (name, drawn(border))).collect();
    let unknown = parts.iter().any(|(_, drawn)| !drawn.unknown.is_empty());
    // a hairline of its own color closes the seams between cells
    let mut fill = |shapes: &[Shape], color| {
        if !shapes.is_empty() {
            let ink = Ink { stroke: color, width: 0.3, ..Ink::fill(color) };
            chart.draw(&mut paper, shapes.to_vec(), What::Area(ink));
        }
    };
    for (_, drawn) in &parts {
        fill(&drawn.unknown, UNKNOWN);
    }
    // A design that is unsafe for one part is unsafe, even if others are unknown.
    for (_, drawn) in &parts {
        fill(&drawn.shapes, SAND);
    }
    let mut y = axes.corner[1] + 8.0;
    let line = |paper: &mut Paper, y: &mut f64, text: &str, color| {
        paper.text([right, *y], text, Label { anchor: Anchor::Start, color, ..SMALL });
        *y += 12.0;
    };
    let (good, bad) =
        if data.product.is_some() { ("all are safe", "one fails at least") } else { ("goals met", "goals missed") };
    if !data.model.is_empty() {
        line(&mut paper, &mut y, &data.model, INK);
    }
    let legend = [(SAFE, good), (SAND, bad), (UNKNOWN, "not tried, or no answer")];
    for (fill, text) in legend.into_iter().take(if unknown { 3 } else { 2 }) {
        paper.rect([right, y - 7.0], [14.0, 8.0], Ink { stroke: GRAY, width: 0.4, ..Ink::fill(fill) });
        paper.text([right + 19.0, y], text, Label { anchor: Anchor::Start, ..SMALL });
        y += 12.0;
    }
    line(&mut paper, &mut y, "strokes: the side that fails", GRAY);
    y += 4.0;
    let mut taken: Vec<Pt> = data.product.iter().flat_map(|(q, e)| e.map(|e| chart.at(e, *q))).collect();
    taken.extend(data.designs.iter().map(|(_, p)| chart.at(p.e, p.q)));
    for (k, (name, Cells { shapes, lines, unknown })) in parts.iter().enumerate() {
        chart.draw(&mut paper, lines.clone(), What::Lines(BORDER));
        barbs(&mut paper, &chart, lines);
        if parts.len() == 1 && data.product.is_none() {
            continue; // the legend has said it
        }
        // The number stands where it is farthest from other numbers, marks and the frame.
        let points = lines.iter().flatten().map(|(e, q)| chart.at(*e, *q));
        let room = |p: &Pt| {
            let edge = (0..2).map(|i| (p[i] - axes.corner[i]).min(axes.corner[i] + axes.size[i] - p[i]));
            let others = taken.iter().map(|o| (p[0] - o[0]).hypot(p[1] - o[1]));
            edge.map(|d| 3.0 * d).chain(others).fold(90.0, f64::min)
        };
        let best = points.max_by(|a, b| room(a).total_cmp(&room(b)));
        let number = (k + 1).to_string();
        if let Some(p) = best {
            badge(&mut paper, p, &number);
            taken.push(p);
        }
        let everywhere = shapes.is_empty() && lines.is_empty();
        let where_safe = match (everywhere, lines.is_empty()) {
            (true, _) if !unknown.is_empty() => ", safe wherever known",
            (true, _) => ", safe everywhere",
            (false, true) => ", safe nowhere",
            _ => "",
        };
        let short: String = name.chars().take(LONGEST_NAME).collect();
        let more = if name.chars().nth(LONGEST_NAME).is_some() { "…" } else { "" };
        paper.plain(
            [right, y],
            &format!("{number}  {short}{more}{where_safe}"),
            Label { anchor: Anchor::Start, ..SMALL },
        );
        y += 12.0;
    }
    y += 4.0;
    if let Some([q, e]) = data.reach {
        let box_of = [(e[0], q[0]), (e[1], q[0]), (e[1], q[1]), (e[0], q[1])].map(|(e, q)| chart.at(e, q));
        let ink = Ink { dash: "3 2.5", ..Ink::line(GRAY, 0.9) };
        paper.path(&box_of, true, ink);
        paper.line([right, y - 2.8], [right + 14.0, y - 2.8], ink);
        paper.text([right + 19.0, y], "can be built", Label { anchor: Anchor::Start, ..SMALL });
        y += 12.0;
    }
    for (k, (name, p)) in data.designs.iter().enumerate() {
        let letter = char::from(b'A' + u8::try_from(k.min(25)).unwrap_or(25));
        badge(&mut paper, chart.at(p.e, p.q), &letter.to_string());
        line(&mut paper, &mut y, &format!("{letter}  {name}"), INK);
    }
    if let Some((q, [lo, hi])) = data.product {
        let ends = [chart.at(lo, q), chart.at(hi, q)];
        paper.line(ends[0], ends[1], Ink::line(RUST, 2.0));
        for end in ends {
            paper.circle(end, 2.8, Ink { stroke: INK, width: 0.6, ..Ink::fill(RUST) });
        }
        paper.circle([right + 7.0, y - 2.8], 2.8, Ink { stroke: INK, width: 0.6, ..Ink::fill(RUST) });
        paper.text([right + 19.0, y], "the product", Label { anchor: Anchor::Start, ..SMALL });
    }
    chart.border(&mut paper);
    paper.finish("Inertia ratio and restitution that make the parts safe")
}

/// Fronts of the largest safe zone against q.
#[derive(Debug, Clone, PartialEq)]
pub struct DesignFronts {
    /// Threshold of the zone, in v0.
    pub threshold: f64,
    /// Zone that is wanted.
    pub wanted: f64,
    /// Fronts at each e: among designs that meet the other goals, and without these.
    pub fronts: Vec<[Front; 2]>,
    /// The other goals, in figure markup; empty if there are none.
    pub others: String,
    /// Designs to compare with: name, q, and the zone they give.
    pub designs: Vec<(String, FrontPoint)>,
}

/// Draws the front of the largest safe zone against the inertia ratio, for each restitution.
pub fn fronts(data: &DesignFronts) -> Result<String, FigureError> {
    let largest = data.fronts.iter().filter_map(|[_, free]| free.largest()).map(|p| p.s).fold(data.wanted, f64::max);
    let title = format!("safe zone within {} *v*_0, per cent of the bar", data.threshold);
    let axes = Axes {
        corner: [40.0, 8.0],
        size: [260.0, 200.0],
        x: Axis::linear(0.0, 1.0, "inertia ratio *q*"),
        y: Axis::linear(0.0, 100.0 * largest * 1.06, &title),
    };
    let right = axes.corner[0] + axes.size[0];
    let mut paper = Paper::new(right + 178.0, axes.corner[1] + axes.size[1] + 30.0);
    let axes = axes.on(&mut paper, 26.0);
    let (met, free) = (Ink::line(BLUES[8], 1.4), Ink { dash: "3 2.5", ..Ink::line(GRAY, 0.8) });
    axes.level(&mut paper, 100.0 * data.wanted, Ink::line(RUST, 0.8));
    let mut last = f64::NEG_INFINITY;
    for [within, without] in &data.fronts {
        for (front, ink) in [(without, free), (within, met)] {
            for piece in &front.pieces {
                axes.curve(&mut paper, piece.iter().map(|p| (p.q, 100.0 * p.s)), ink);
            }
        }
        if let Some(end) = within.largest() {
            axes.mark(&mut paper, end.q, 100.0 * end.s, BLUES[8]);
        }
        if let Some(end) = without.largest() {
            let y = (axes.at(end.q, 100.0 * end.s)[1] + 2.6).max(last + 9.0);
            paper.text([right + 5.0, y], &format!("*e* = {}", within.e), Label { anchor: Anchor::Start, ..SMALL });
            last = y;
        }
    }
    for (k, (_, p)) in data.designs.iter().enumerate() {
        let letter = char::from(b'A' + u8::try_from(k.min(25)).unwrap_or(25)).to_string();
        if p.s < 0.0 {
            continue; // no zone at all, which its line in the key says
        }
        badge(&mut paper, axes.at(p.q, 100.0 * p.s), &letter);
    }
    axes.border(&mut paper);
    let x = right + 46.0;
    let mut y = 16.0;
    let mut say = |paper: &mut Paper, mark: Option<Ink>, text: &str| {
        if let Some(ink) = mark {
            paper.line([x, y - 2.8], [x + 14.0, y - 2.8], ink);
            paper.text([x + 19.0, y], text, Label { anchor: Anchor::Start, ..SMALL });
        } else {
            paper.note([x, y], text);
        }
        y += 12.0;
    };
    if data.others.is_empty() {
        say(&mut paper, Some(met), "front");
    } else {
        say(&mut paper, Some(met), "front, other goals met");
        say(&mut paper, Some(free), "they are not");
        say(&mut paper, None, &data.others);
    }
    say(&mut paper, Some(Ink::line(RUST, 0.8)), &format!("wanted: {}", percent(data.wanted)));
    for (k, (name, p)) in data.designs.iter().enumerate() {
        let letter = char::from(b'A' + u8::try_from(k.min(25)).unwrap_or(25));
        let none = if p.s < 0.0 { ": no zone" } else { "" };
        say(&mut paper, None, &format!("{letter}  {name}{none}"));
    }
    say(&mut paper, None, "*q* = 1, *e* = 0 cannot be built");
    paper.finish("The largest safe zone against the inertia ratio, for each restitution")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_cut_where_the_margin_vanishes() {
        // safe below q = e, by margins linear in their logarithm
        let side = 5;
        let margins: Vec<Option<f64>> = (0..25_u8)
            .map(|k| (f64::from(k / 5) / 4.0, f64::from(k % 5) / 4.0))
            .map(|(q, e)| Some((e - q + 0.05_f64).exp_m1()))
            .collect();
        let Cells { shapes, lines, unknown } = grid(side, &margins);
        assert!(unknown.is_empty(), "all is known");
        for (e, q) in lines.iter().flatten() {
            assert!((q - e - 0.05).abs() < 1e-12, "({e}, {q}) is off the line");
        }
        let area = |shape: &Shape| {
            let next = shape.iter().cycle().skip(1);
            0.5 * shape.iter().zip(next).map(|(a, b)| a.0 * b.1 - b.0 * a.1).sum::<f64>().abs()
        };
        let total: f64 = shapes.iter().map(area).sum();
        assert!((total - 0.5 * 0.95 * 0.95).abs() < 1e-12, "unsafe area {total}");
    }

    #[test]
    fn what_no_curve_covers_is_unsafe() {
        let curve = vec![Point { q: 0.25, e: 0.0 }, Point { q: 0.75, e: 0.5 }];
        let Cells { shapes, lines, .. } = drawn(&DesignBorder::Exact(vec![curve]));
        assert_eq!((shapes.len(), lines.len()), (3, 1), "below, beside, above");
        let Cells { shapes, lines, .. } = drawn(&DesignBorder::Exact(Vec::new()));
        assert_eq!((shapes.len(), lines.len()), (1, 0), "safe nowhere");
        let Cells { shapes, .. } =
            drawn(&DesignBorder::Exact(vec![vec![Point { q: 0.0, e: 1.0 }, Point { q: 1.0, e: 1.0 }]]));
        assert_eq!(shapes.len(), 1, "a shape without area");
    }

    #[test]
    fn what_is_not_known_is_neither_safe_nor_unsafe() {
        // Four cells; the corner that is not known leaves three of them.
        let mut margins =
            [Some(-0.5), Some(-0.5), Some(-0.5), Some(1.0), Some(1.0), Some(1.0), Some(1.0), Some(1.0), None];
        let Cells { shapes, lines, unknown } = grid(3, &margins);
        assert_eq!((shapes.len(), lines.len(), unknown.len()), (2, 2, 1));
        assert_eq!(unknown[0], [(0.5, 0.5), (1.0, 0.5), (1.0, 1.0), (0.5, 1.0)]);
        margins[4] = None;
        let Cells { shapes, lines, unknown } = grid(3, &margins);
        assert_eq!((shapes.len(), lines.len(), unknown.len()), (0, 0, 4), "each cell has that corner");
    }

    #[test]
    fn names_stand_as_they_are() {
        let border = DesignBorder::Exact(Vec::new());
        let borders = vec![("a_b*<c> & d".to_owned(), border)];
        // the goals of a plane without a product have no names
        let data = DesignPlane { borders, product: Some((0.5, [0.2, 0.3])), ..DesignPlane::default() };
        let drawn = plane(&data).unwrap();
        assert!(drawn.contains("a_b*&lt;c&gt; &amp; d"), "{drawn}");
    }
}
