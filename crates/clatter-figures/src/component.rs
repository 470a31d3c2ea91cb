//! The load of one part: over time in its worst drop, and at worst over the tilt.

use clatter_assess::Verdict;

use crate::FigureError;
use crate::axis::Axis;
use crate::chart::{Axes, Chart};
use crate::drop::thinned;
use crate::paper::{Paper, SMALL};
use crate::product::{fit, shade};
use crate::style::{Anchor, BLUES, GRAY, INK, Ink, LABEL, Label, RUST, width};

/// Frame of both figures of a part: low, so that a page holds two parts. The key of its lines is above it.
const FRAME: [f64; 2] = [176.0, 76.0];
const CORNER: [f64; 2] = [44.0, 16.0];

const LIMIT: Ink = Ink { dash: "8 2 1.5 2", ..Ink::line(INK, 1.0) };

/// The largest limit that is drawn, over the largest value: one far away would press the curves flat, and is named
/// instead.
const SEEN: f64 = 3.0;

/// Returns whether figures with this largest value draw the limit.
#[must_use]
pub fn is_drawn(allowed: f64, largest: f64) -> bool {
    allowed <= SEEN * largest
}

/// Draws the key of the lines above a frame, side by side.
fn key(paper: &mut Paper, lines: &[(Ink<'_>, &str)]) {
    let mut x = CORNER[0];
    for (ink, text) in lines {
        paper.key([x, CORNER[1] - 5.0], &[(*ink, text)]);
        x += 33.0 + width(text, SMALL.size);
    }
}

/// Draws a response over time with its limit on both sides; impacts are ticks at the foot.
///
/// `points` are (time, value), `impacts` their times, all in the units of the titles.
pub fn history(points: &[(f64, f64)], impacts: &[f64], allowed: f64, titles: [&str; 2]) -> Result<String, FigureError> {
    let end = points.last().map_or(1.0, |p| p.0).max(f64::MIN_POSITIVE);
    let largest = points.iter().map(|p| p.1.abs()).fold(0.0_f64, f64::max);
    let shown = is_drawn(allowed, largest);
    let top = 1.12 * if shown { allowed.max(largest) } else { largest.max(f64::MIN_POSITIVE) };
    let axes = Axes {
        corner: CORNER,
        size: FRAME,
        // a shock at the first touch stands clear of the frame
        x: Axis::linear(-0.03 * end, end, titles[0]),
        y: Axis::linear(-top, top, titles[1]),
    };
    let mut paper = Paper::new(FRAME[0] + 50.0, FRAME[1] + 46.0);
    let axes = axes.on(&mut paper, 36.0);
    axes.level(&mut paper, 0.0, Ink::line(GRAY, 0.5));
    // The ticks are shorter than the room below the lower limit, so that no tick crosses it.
    for &t in impacts.iter().filter(|t| **t <= end) {
        let [x, y] = axes.at(t, -top);
        paper.line([x, y], [x, y - 3.5], Ink::line(RUST, 0.9));
    }
    let mut lines = vec![(Ink::line(RUST, 0.9), "impacts")];
    if shown {
        axes.level(&mut paper, allowed, LIMIT);
        axes.level(&mut paper, -allowed, LIMIT);
        lines.insert(0, (LIMIT, "limit"));
    }
    let step = 1.03 * end / FRAME[0] / 3.0;
    axes.curve(&mut paper, thinned(points, step).into_iter(), Ink::line(BLUES[8], 0.9));
    key(&mut paper, &lines);
    axes.border(&mut paper);
    paper.finish("Response over time in the worst drop")
}

/// Draws the demand over the tilt, a curve for each end that may touch first, with the limit.
pub fn over_tilt(curves: &[(&str, Vec<(f64, f64)>)], allowed: f64, titles: [&str; 2]) -> Result<String, FigureError> {
    let all = || curves.iter().flat_map(|c| &c.1).filter(|p| p.1.is_finite());
    let largest = all().map(|p| p.1).fold(0.0_f64, f64::max);
    let (lo, hi) = all().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), p| (a.min(p.0), b.max(p.0)));
    let (lo, hi) = if lo < hi { (lo, hi) } else { (0.0, 1.0) };
    let shown = is_drawn(allowed, largest);
    let top = 1.12 * if shown { allowed.max(largest) } else { largest.max(f64::MIN_POSITIVE) };
    let axes =
        Axes { corner: CORNER, size: FRAME, x: Axis::linear(lo, hi, titles[0]), y: Axis::linear(0.0, top, titles[1]) };
    let inks = [Ink::line(BLUES[8], 1.1), Ink { dash: "3.5 2", ..Ink::line(RUST, 1.0) }];
    let mut paper = Paper::new(FRAME[0] + 50.0, FRAME[1] + 46.0);
    let axes = axes.on(&mut paper, 36.0);
    let mut lines = Vec::new();
    if shown {
        axes.level(&mut paper, allowed, LIMIT);
        lines.push((LIMIT, "limit"));
    }
    for ((name, points), ink) in curves.iter().zip(inks) {
        axes.curve(&mut paper, points.iter().copied(), ink);
        lines.push((ink, *name));
    }
    key(&mut paper, &lines);
    axes.border(&mut paper);
    paper.finish("Demand over the tilt")
}

/// Returns the axis of degrees all around, with a tick at each side of a plate.
fn around<'a>() -> Axis<'a> {
    Axis { bare: true, ..Axis::linear(0.0, 360.0, "") }
}

/// Draws the ticks and title of [`around`], and the name of the lowest corner in between.
fn sides(paper: &mut Paper, chart: &Chart<'_>) {
    let foot = chart.corner[1] + chart.size[1];
    for k in 0..=4_u8 {
        let x = chart.at(90.0 * f64::from(k), 0.0)[0];
        paper.line([x, foot], [x, foot + 3.0], Ink::line(INK, 0.6));
        if (1..4).contains(&k) {
            paper.line([x, chart.corner[1]], [x, foot], Ink { dash: "1.5 1.5", ..Ink::line(GRAY, 0.4) });
        }
        paper.text([x, foot + 11.0], &format!("{}", 90 * u16::from(k)), SMALL);
    }
    for (k, name) in (0_u8..).zip(["*a* lowest", "*b* lowest", "*c* lowest", "*d* lowest"]) {
        let x = chart.at(45.0 + 90.0 * f64::from(k), 0.0)[0];
        // A low frame has room for the letter alone.
        let name = if chart.size[0] < 200.0 { &name[..3] } else { name };
        paper.text([x, foot + 11.0], name, Label { color: GRAY, ..SMALL });
    }
    paper.text([chart.corner[0] + 0.5 * chart.size[0], foot + 22.0], "direction the plate rises to, degrees", LABEL);
}

/// Draws the demand over the direction that a plate rises to, in degrees, with the limit; directions that are not in
/// the file are dashed.
///
/// `points` are (direction, value, whether the file gives it).
pub fn over_direction(points: &[(f64, f64, bool)], allowed: f64, title: &str) -> Result<String, FigureError> {
    let largest = points.iter().map(|p| p.1).fold(0.0_f64, f64::max);
    let shown = is_drawn(allowed, largest);
    let top = 1.12 * if shown { allowed.max(largest) } else { largest.max(f64::MIN_POSITIVE) };
    let axes = Axes { corner: CORNER, size: FRAME, x: around(), y: Axis::linear(0.0, top, title) };
    let mut paper = Paper::new(FRAME[0] + 50.0, FRAME[1] + 46.0);
    let chart = axes.on(&mut paper, 36.0);
    let mut lines = Vec::new();
    if shown {
        chart.level(&mut paper, allowed, LIMIT);
        lines.push((LIMIT, "limit"));
    }
    let inks = [Ink::line(BLUES[8], 1.1), Ink { dash: "3.5 2", ..Ink::line(GRAY, 0.9) }];
    for ((given, name), ink) in [(true, "demand"), (false, "not given")].into_iter().zip(inks) {
        // A stretch reaches to its neighbors.
        let of = |pair: &[(f64, f64, bool)]| (pair[0].2 && pair[1].2) == given;
        let pieces = points.windows(2).filter(|pair| of(pair));
        chart.curve(&mut paper, pieces.flat_map(|p| [(p[0].0, p[0].1), (p[1].0, p[1].1), (f64::NAN, 0.0)]), ink);
        if points.windows(2).any(of) {
            lines.push((ink, name));
        }
    }
    sides(&mut paper, &chart);
    key(&mut paper, &lines);
    chart.border(&mut paper);
    paper.finish("Demand over the direction of the tilt")
}

/// One line: the demand on a part at each tilt or direction, in degrees, as a share of its limit.
#[derive(Debug)]
pub struct Share<'a> {
    /// Name of the part.
    pub name: &'a str,
    /// Verdict, which decides the color.
    pub verdict: Verdict,
    /// Tilt or direction, and share.
    pub points: Vec<(f64, f64)>,
}

/// Draws the demand on each part, as a share of its limit, over the tilt or, for a plate, over the direction; each line
/// has its name at its right end.
pub fn shares(parts: &[Share<'_>], by_direction: bool) -> Result<String, FigureError> {
    let all = || parts.iter().flat_map(|p| &p.points).filter(|p| p.1.is_finite());
    let largest = all().map(|p| p.1).fold(1.0_f64, f64::max);
    let (lo, hi) = all().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), p| (a.min(p.0), b.max(p.0)));
    let (lo, hi) = if lo < hi { (lo, hi) } else { (0.0, 1.0) };
    let rows = f64::from(u32::try_from(parts.len()).unwrap_or(u32::MAX));
    let axes = Axes {
        corner: [44.0, 8.0],
        size: [316.0, if by_direction { 84.0_f64 } else { 92.0 }.max(9.5 * rows)],
        x: if by_direction { around() } else { Axis::linear(lo, hi, "tilt at the first touch, degrees") },
        y: Axis::linear(0.0, 108.0 * largest, "demand, % of the limit"),
    };
    let right = axes.corner[0] + axes.size[0];
    let mut paper = Paper::new(464.0, axes.corner[1] + axes.size[1] + 30.0);
    let axes = axes.on(&mut paper, 32.0);
    axes.level(&mut paper, 100.0, LIMIT);
    let dashes = ["", "5 2", "1.5 1.5"];
    let mut ends: Vec<(f64, f64, Ink, &str)> = Vec::new();
    for (i, Share { name, verdict, points }) in parts.iter().enumerate() {
        let color = if *verdict == Verdict::Safe { BLUES[8 - 2 * (i / 3 % 3)] } else { shade(*verdict) };
        let ink = Ink { dash: dashes[i % 3], ..Ink::line(color, 1.1) };
        axes.curve(&mut paper, points.iter().map(|p| (p.0, 100.0 * p.1)), ink);
        let last = points.iter().rev().find(|p| p.1.is_finite());
        let y = last.map_or(0.0, |p| axes.at(p.0, 100.0 * p.1)[1]);
        ends.push((y, y, ink, name));
    }
    // Names are moved apart, from the top down, then pushed back up from the foot.
    ends.sort_by(|a, b| a.0.total_cmp(&b.0));
    let foot = axes.corner[1] + axes.size[1];
    let mut free = axes.corner[1] + 3.0;
    for end in &mut ends {
        end.1 = end.1.max(free);
        free = end.1 + 9.5;
    }
    let mut free = foot;
    for end in ends.iter_mut().rev() {
        end.1 = end.1.min(free);
        free = end.1 - 9.5;
    }
    for (y, at, ink, name) in ends {
        paper.line([right + 1.0, y], [right + 9.0, at], Ink::line(GRAY, 0.4));
        let label = Label { anchor: Anchor::Start, color: ink.stroke, ..SMALL };
        paper.text([right + 11.0, at + 2.6], &fit(name, 464.0 - right - 14.0), label);
    }
    if by_direction {
        sides(&mut paper, &axes);
    }
    axes.border(&mut paper);
    let over = if by_direction { "direction of the tilt" } else { "tilt" };
    paper.finish(&format!("What each part is asked, as a share of what it stands, over the {over}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_out_of_reach_is_not_drawn_and_a_near_one_is_on_both_sides() {
        let points = [(0.0, 0.0), (1.0, 2.0), (2.0, -1.0)];
        let limits = |allowed| history(&points, &[0.5], allowed, ["t", "a"]).unwrap().matches(LIMIT.dash).count();
        // The third line is that of the key.
        assert_eq!([limits(100.0), limits(2.5)], [0, 3]);
    }

    /// Directions that are not in the file are dashed, up to those that are.
    #[test]
    fn directions_that_are_not_given_are_dashed() {
        let drawn = |given: fn(f64) -> bool| {
            let points: Vec<_> = (0..=12).map(|k| 30.0 * f64::from(k)).map(|x| (x, 2.0, given(x))).collect();
            over_direction(&points, 1.5, "demand").unwrap()
        };
        let dashes = |drawn: &str| drawn.matches("\"3.5 2\"").count();
        // The dashes are one line before 60°, one after 180°, and that of the key.
        assert_eq!([dashes(&drawn(|_| true)), dashes(&drawn(|x| (60.0..=180.0).contains(&x)))], [0, 2 + 1]);
        assert!(drawn(|_| true).contains(">d</tspan>"), "the lowest corners");
    }

    #[test]
    fn the_key_stands_above_the_frame() {
        let curves = [("end *a* first", vec![(0.0, 1.0), (5.0, 2.0)]), ("end *b* first", vec![(0.0, 2.0), (5.0, 0.1)])];
        let drawn = over_tilt(&curves, 1.5, ["tilt", "demand"]).unwrap();
        let feet: Vec<f64> = ["limit", "first"]
            .iter()
            .flat_map(|word| drawn.match_indices(word).map(|(at, _)| at).collect::<Vec<_>>())
            .filter_map(|at| drawn[..at].rsplit_once(" y=\"")?.1.split('"').next()?.parse().ok())
            .collect();
        assert!(feet.len() >= 3 && feet.iter().all(|y| *y < CORNER[1]), "{feet:?}: {drawn}");
    }
}
