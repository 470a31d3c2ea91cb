//! A measured record over time.

use crate::FigureError;
use crate::axis::Axis;
use crate::chart::Axes;
use crate::paper::{Paper, SMALL};
use crate::style::{Anchor, BLUES, GRAY, INK, Ink, Label, RUST};

/// A channel of a record.
#[derive(Debug)]
pub struct Trace<'a> {
    /// Its name.
    pub name: &'a str,
    /// Quantity of its values, with their unit.
    pub title: &'a str,
    /// Time and value, in order of time, in the units of the titles.
    pub points: Vec<(f64, f64)>,
    /// Points that are marked.
    pub marks: Vec<(f64, f64)>,
    /// A curve to compare with, such as a pulse that fits, and its name.
    pub beside: Option<(&'a str, Vec<(f64, f64)>)>,
}

const BESIDE: Ink = Ink { dash: "5 2", ..Ink::line(RUST, 1.1) };

/// The most channels that are drawn; a note gives the number of the others.
const MOST: usize = 12;
const FRAME: [f64; 2] = [400.0, 96.0];
/// Distance from one frame to the next.
const PITCH: f64 = FRAME[1] + 14.0;
const CORNER: [f64; 2] = [52.0, 16.0];

/// Draws channels over time, one below the other; `time` is the title of their times.
///
/// ```
/// use clatter_figures::{Trace, record};
/// let points = vec![(0.0, 0.0), (1.0, 50.0), (2.0, 0.0)];
/// let trace = Trace { name: "ax", title: "gn", points, marks: vec![], beside: None };
/// assert!(record(&[trace], "time, ms")?.contains("ax"));
/// # Ok::<(), clatter_figures::FigureError>(())
/// ```
pub fn record(traces: &[Trace<'_>], time: &str) -> Result<String, FigureError> {
    let shown = &traces[..traces.len().min(MOST)];
    let ends = shown.iter().flat_map(|trace| [trace.points.first(), trace.points.last()]).flatten();
    let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p.0), high.max(p.0)));
    let (low, high) = if low < high { (low, high) } else { (0.0, 1.0) };
    #[expect(clippy::cast_precision_loss, reason = "a dozen")]
    let count = shown.len() as f64;
    let mut paper = Paper::new(CORNER[0] + FRAME[0] + 12.0, CORNER[1] + PITCH * count + 26.0);
    for (i, Trace { name, title, points, marks, beside }) in shown.iter().enumerate() {
        let all = points.iter().chain(beside.iter().flat_map(|(_, points)| points));
        let (least, most) = all.fold((0.0_f64, 0.0_f64), |(least, most), p| (least.min(p.1), most.max(p.1)));
        let room = if least < most { 0.06 * (most - least) } else { 1.0 };
        let last = i + 1 == shown.len();
        #[expect(clippy::cast_precision_loss, reason = "a dozen")]
        let top = CORNER[1] + PITCH * i as f64;
        let axes = Axes {
            corner: [CORNER[0], top],
            size: FRAME,
            x: Axis { bare: !last, ..Axis::linear(low, high, if last { time } else { "" }) },
            y: Axis::linear(least - room, most + room, title),
        };
        let axes = axes.on(&mut paper, 38.0);
        axes.level(&mut paper, 0.0, Ink::line(GRAY, 0.5));
        axes.curve(&mut paper, thinned(points, low, high).into_iter(), Ink::line(BLUES[8], 0.8));
        if let Some((name, curve)) = beside {
            axes.curve(&mut paper, curve.iter().copied(), BESIDE);
            paper.key([CORNER[0] + FRAME[0] - 118.0, top + 12.0], &[(BESIDE, *name)]);
        }
        for (at, value) in marks {
            axes.mark(&mut paper, *at, *value, RUST);
        }
        axes.border(&mut paper);
        let label = Label { anchor: Anchor::Start, color: INK, ..SMALL };
        paper.plain([CORNER[0] + 2.0, top - 3.0], name, label);
    }
    if traces.len() > MOST {
        let more = format!("and {} channels more", traces.len() - MOST);
        let label = Label { anchor: Anchor::End, color: INK, ..SMALL };
        paper.plain([CORNER[0] + FRAME[0], CORNER[1] - 3.0], &more, label);
    }
    paper.finish("Measured accelerations over time")
}

/// Returns points that draw the same line: of all that fall into half a point of the page the first, the lowest, the
/// highest and the last.
pub(crate) fn thinned(points: &[(f64, f64)], low: f64, high: f64) -> Vec<(f64, f64)> {
    let columns = 2.0 * FRAME[0];
    if points.len() < 8 * 800 || low >= high {
        return points.to_vec();
    }
    let column = |p: &(f64, f64)| ((p.0 - low) / (high - low) * columns).floor();
    let mut thin = Vec::new();
    for run in points.chunk_by(|a, b| column(a).total_cmp(&column(b)).is_eq()) {
        let most =
            |sign: f64| (0..run.len()).max_by(|a, b| (sign * run[*a].1).total_cmp(&(sign * run[*b].1))).unwrap_or(0);
        let mut kept = [0, most(1.0), most(-1.0), run.len() - 1];
        kept.sort_unstable();
        thin.extend(kept.map(|i| run[i]));
    }
    thin
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_record_keeps_its_peaks() {
        let peak = 123_456;
        let points: Vec<(f64, f64)> = (0..1_000_000)
            .map(|i| {
                (
                    f64::from(i),
                    if i == peak {
                        7.0
                    } else if i == peak + 1 {
                        -9.0
                    } else {
                        f64::from(i % 2)
                    },
                )
            })
            .collect();
        let thin = thinned(&points, 0.0, 999_999.0);
        assert!(thin.len() < 4000, "{}", thin.len());
        assert!(thin.contains(&points[123_456]) && thin.contains(&points[123_457]), "both peaks");
        assert!(thin.windows(2).all(|pair| pair[0].0 <= pair[1].0), "in order");
    }
}
