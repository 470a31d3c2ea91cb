//! Figures of the plate report: a plate compared with bars, over the directions of its tilt, and near ties.

use clatter::Atlas;
use clatter_figures::FigureError;
use clatter_figures::draw::{
    Anchor, Axes, Axis, BLUES, GRAY, GUIDE, INK, Ink, LABEL, Label, Paper, RUST, SAND, SMALL, width,
};

use crate::plate::bars::{BarsAndPlate, STRIKES};
use crate::plate::directions::{Counts, Interval, letters};
use crate::plate::ties::{GAP, Ties};

const GREEN: &str = "#4c7a49";
const PLATE: [Ink; 3] = [Ink::line(BLUES[8], 1.3), Ink::line(RUST, 1.2), Ink::line(GREEN, 1.2)];
const DASH: &str = "3.5 2";

fn dashed(ink: Ink<'_>) -> Ink<'_> {
    Ink { dash: DASH, width: 0.9, ..ink }
}

fn frame<'a>(x: Axis<'a>, y: Axis<'a>) -> Axes<'a> {
    Axes { corner: [34.0, 8.0], size: [178.0, 116.0], x, y }
}

/// Draws the key below a frame: whole lines with their names, then a note on the broken ones.
fn key(paper: &mut Paper, lines: &[(Ink<'_>, &str)], at: &[f64], note: &str) {
    for (line, x) in lines.iter().zip(at) {
        paper.key([*x, 166.0], &[*line]);
    }
    paper.note([34.0, 179.0], note);
}

const HEIGHT: f64 = 184.0;

/// Draws the largest shocks over e: the corners and the middle of a uniform plate, the ends and the middle of its bar.
pub(crate) fn shocks(plates: &[BarsAndPlate]) -> Result<String, FigureError> {
    let mut paper = Paper::new(226.0, HEIGHT);
    let top = plates.iter().fold(0.0_f64, |most, plate| most.max(plate.corner));
    let x = Axis::linear(0.0, 1.0, "coefficient of restitution *e*");
    let axes = frame(x, Axis::linear(0.0, 1.04 * top, "largest shock, in *v*_0")).on(&mut paper, 22.0);
    let pairs: [fn(&BarsAndPlate) -> [f64; 2]; 2] =
        [|plate| [plate.corner, plate.bar[0]], |plate| [plate.middle, plate.bar[1]]];
    for (of, ink) in pairs.into_iter().zip(PLATE) {
        axes.curve(&mut paper, plates.iter().map(|plate| (plate.e, of(plate)[1])), dashed(ink));
        axes.curve(&mut paper, plates.iter().map(|plate| (plate.e, of(plate)[0])), ink);
    }
    axes.border(&mut paper);
    key(
        &mut paper,
        &[(PLATE[0], "corners"), (PLATE[1], "middle")],
        &[34.0, 108.0],
        "broken: ends and middle of the bar, *q* = ½",
    );
    paper.finish("Largest shocks of a uniform plate and of a uniform bar over restitution")
}

/// Draws the safe share over e for each threshold: of the plan of a uniform plate, of the length of its bar.
pub(crate) fn zones(plates: &[BarsAndPlate]) -> Result<String, FigureError> {
    let mut paper = Paper::new(226.0, HEIGHT);
    let x = Axis::linear(0.0, 1.0, "coefficient of restitution *e*");
    let axes = frame(x, Axis::linear(0.0, 1.0, "share that is safe")).on(&mut paper, 22.0);
    for (k, ink) in PLATE.into_iter().enumerate() {
        axes.curve(&mut paper, plates.iter().map(|plate| (plate.e, plate.length[k])), dashed(ink));
        axes.curve(&mut paper, plates.iter().map(|plate| (plate.e, plate.plan[k])), ink);
    }
    axes.border(&mut paper);
    let lines = [(PLATE[0], "*v*_0/2"), (PLATE[1], "*v*_0"), (PLATE[2], "2 *v*_0")];
    key(&mut paper, &lines, &[34.0, 100.0, 158.0], "whole: of the plan; broken: of the length of the bar");
    paper.finish("Share of a uniform plate and of a uniform bar that is safe, over restitution")
}

/// Draws the share within v0/2 over α = β for some e: of the plan, of the length of the bar.
pub(crate) fn inertia(curves: &[Vec<BarsAndPlate>; 3]) -> Result<String, FigureError> {
    let mut paper = Paper::new(226.0, HEIGHT);
    let top = curves.iter().flatten().fold(0.0_f64, |most, plate| most.max(plate.length[0]));
    let axes = frame(Axis::linear(1.0, 10.0, "*α* = *β*"), Axis::linear(0.0, 1.05 * top, "share within *v*_0/2"));
    let axes = axes.on(&mut paper, 22.0);
    let mut names = Vec::new();
    for (plates, ink) in curves.iter().zip(PLATE) {
        axes.curve(&mut paper, plates.iter().map(|plate| (plate.inertia[0], plate.length[0])), dashed(ink));
        axes.curve(&mut paper, plates.iter().map(|plate| (plate.inertia[0], plate.plan[0])), ink);
        names.push((ink, plates.first().map_or_else(String::new, |plate| format!("*e* = {}", plate.e))));
    }
    axes.border(&mut paper);
    let lines: Vec<(Ink<'_>, &str)> = names.iter().map(|(ink, name)| (*ink, name.as_str())).collect();
    key(&mut paper, &lines, &[34.0, 98.0, 162.0], "whole: of the plan; broken: of the length of the bar");
    paper.finish("Share within half the drop speed over the inertia of a plate and of its bar")
}

/// Returns the names of bands, from below the first level to above the last.
fn bands(levels: &[f64]) -> Vec<String> {
    let between = levels.windows(2).map(|w| format!("{} to {}", w[0], w[1]));
    let (first, last) = (levels.first().copied().unwrap_or_default(), levels.last().copied().unwrap_or_default());
    std::iter::once(format!("below {first}")).chain(between).chain([format!("above {last}")]).collect()
}

/// Draws the largest corner shock over that of the bar's ends, over α and β; the plates row by row, α fastest.
pub(crate) fn plane(plates: &[BarsAndPlate]) -> Result<String, FigureError> {
    const LEVELS: [f64; 6] = [1.05, 1.1, 1.15, 1.2, 1.25, 1.3];
    const COLORS: [&str; 7] = [SAND, BLUES[1], BLUES[2], BLUES[4], BLUES[5], BLUES[6], BLUES[8]];
    let mut paper = Paper::new(226.0, HEIGHT);
    let axes = Axes {
        corner: [34.0, 8.0],
        size: [136.0, 116.0],
        x: Axis::linear(1.0, 10.0, "*α*"),
        y: Axis::linear(1.0, 10.0, "*β*"),
    };
    let axes = axes.without_grid(&mut paper, 22.0);
    // These are rows of one β, in them runs of one color; each cell reaches half way to its neighbors.
    let band = |plate: &BarsAndPlate| LEVELS.iter().filter(|level| plate.corner / plate.bar[0] >= **level).count();
    let half = plates.first().zip(plates.get(1)).map_or(0.0, |(a, b)| 0.5 * (b.inertia[0] - a.inertia[0]));
    for run in plates.chunk_by(|a, b| a.inertia[1].to_bits() == b.inertia[1].to_bits() && band(a) == band(b)) {
        let (first, last) = (&run[0], &run[run.len() - 1]);
        let [low, high] = [-half, half].map(|off| (first.inertia[1] + off).clamp(1.0, 10.0));
        let (from, to) = ((first.inertia[0] - half).max(1.0), (last.inertia[0] + half).min(10.0));
        axes.area(&mut paper, vec![(from, low), (to, low), (to, high), (from, high)], COLORS[band(first)]);
    }
    axes.mark(&mut paper, 3.0, 3.0, "#ffffff");
    axes.border(&mut paper);
    let names = bands(&LEVELS);
    swatches(&mut paper, [177.0, 20.0], &COLORS.into_iter().zip(names).collect::<Vec<_>>());
    paper.note([34.0, 166.0], "corner of the plate over end of the bar");
    paper.finish("Largest corner shock of a plate over that of the ends of its bar, over its inertia")
}

fn swatches(paper: &mut Paper, [x, mut y]: [f64; 2], list: &[(&'static str, String)]) {
    for (color, name) in list {
        paper.rect([x, y - 7.0], [8.0, 8.0], Ink { stroke: GRAY, width: 0.4, ..Ink::fill(color) });
        paper.text([x + 11.0, y], name, Label { anchor: Anchor::Start, size: 7.5, ..LABEL });
        y += 13.0;
    }
}

/// Draws the atlas: the largest corner shock over the direction of tilt, beside two bars, and the words below it.
pub(crate) fn atlas(atlas: &Atlas, [bar, diagonal]: [f64; 2]) -> Result<String, FigureError> {
    let mut paper = Paper::new(465.0, 152.0);
    let axes = Axes {
        corner: [34.0, 8.0],
        size: [420.0, 72.0],
        x: Axis { bare: true, ..Axis::linear(0.0, 1.0, "") },
        y: Axis::linear(2.0, 2.6, "corner, in *v*_0"),
    };
    let axes = axes.on(&mut paper, 22.0);
    let label = |paper: &mut Paper, y: f64, text: &str| {
        let [x, y] = axes.at(0.0, y);
        paper.text([x + 6.0, y - 3.0], text, Label { anchor: Anchor::Start, color: GRAY, ..SMALL });
    };
    for (level, text) in [(bar, "bar along an edge, *q* = 1/2"), (diagonal, "bar along the diagonal, *q* = 5/7")] {
        axes.level(&mut paper, level, Ink { dash: DASH, ..Ink::line(GRAY, 0.8) });
        label(&mut paper, level, text);
    }
    let steps = atlas.words().iter().flat_map(|word| [(word.from, word.peak()), (word.to, word.peak())]);
    axes.curve(&mut paper, steps, PLATE[0]);
    axes.border(&mut paper);

    let strip = Axes {
        corner: [34.0, 86.0],
        size: [420.0, 34.0],
        x: Axis::linear(0.0, 1.0, "direction of tilt *r* = *h*_d/(*h*_b + *h*_d)"),
        y: Axis { bare: true, ..Axis::linear(0.0, 1.0, "") },
    };
    let strip = strip.without_grid(&mut paper, 22.0);
    for (i, word) in atlas.words().iter().enumerate() {
        let color = if i % 2 == 0 { BLUES[1] } else { BLUES[3] };
        strip.area(&mut paper, vec![(word.from, 0.0), (word.to, 0.0), (word.to, 1.0), (word.from, 1.0)], color);
        let ([from, y], [to, _]) = (strip.at(word.from, 0.5), strip.at(word.to, 0.5));
        let text = letters(&word.corners);
        let middle = 0.5 * (from + to);
        if width(&text, LABEL.size) + 6.0 < to - from {
            paper.text([middle, y + 3.0], &format!("*{text}*"), LABEL);
        } else if to - from > 9.0 {
            // The text stands upright, as far as the strip is high.
            paper.text([middle + 2.7, y], &format!("*{text}*"), Label { turn: -90.0, size: 7.5, ..LABEL });
        }
    }
    strip.border(&mut paper);
    paper.finish("Largest corner shock and order of corners over the direction of tilt")
}

/// Draws numbers of strikes over direction and restitution.
pub(crate) fn counts(counts: &Counts) -> Result<String, FigureError> {
    const COLORS: [&str; 8] = [BLUES[0], BLUES[2], BLUES[3], BLUES[4], BLUES[5], BLUES[6], BLUES[8], SAND];
    let class = |interval: &Interval| match interval.strikes {
        Some(n) => n.clamp(4, 10) - 4,
        None => 7,
    };
    let mut paper = Paper::new(226.0, 152.0);
    let axes = Axes {
        corner: [34.0, 8.0],
        size: [136.0, 116.0],
        x: Axis::linear(0.0, 1.0, "direction of tilt *r*"),
        y: Axis::linear(0.0, 1.0, "coefficient of restitution *e*"),
    };
    let axes = axes.without_grid(&mut paper, 22.0);
    #[expect(clippy::cast_precision_loss, reason = "a small grid")]
    let half = 0.5 / counts.rows.len() as f64;
    for (e, row) in &counts.rows {
        // The overlap keeps the ground from showing between the rows.
        let (low, high) = (e - half, (e + 1.2 * half).min(1.0));
        let mut merged: Vec<(f64, f64, usize)> = Vec::new();
        for interval in row {
            match merged.last_mut() {
                Some(last) if last.2 == class(interval) => last.1 = interval.to,
                _ => merged.push((interval.from, interval.to, class(interval))),
            }
        }
        for (from, to, class) in merged {
            axes.area(&mut paper, vec![(from, low), (to, low), (to, high), (from, high)], COLORS[class]);
        }
    }
    axes.border(&mut paper);
    let open = format!("{STRIKES} and on");
    let names = ["4 strikes", "5", "6", "7", "8", "9", "10 or more", &open].map(String::from);
    swatches(&mut paper, [177.0, 20.0], &COLORS.into_iter().zip(names).collect::<Vec<_>>());
    paper.finish("Number of strikes of a uniform plate over direction of tilt and restitution")
}

const RIGID: Ink = Ink::line(INK, 0.9);

/// Draws the largest corner shock over direction: rigid, and with contacts of both laws.
pub(crate) fn over_direction(ties: &Ties) -> Result<String, FigureError> {
    let mut paper = Paper::new(226.0, HEIGHT);
    let x = Axis::linear(0.0, 0.5, "direction of tilt *r*");
    let axes = frame(x, Axis::linear(1.8, 2.8, "largest corner shock, in *v*_0")).on(&mut paper, 22.0);
    let steps = ties.rigid.iter().flat_map(|[from, to, shock]| [(*from, *shock), (*to, *shock)]);
    axes.curve(&mut paper, steps, Ink { dash: DASH, ..RIGID });
    for (curve, ink) in ties.over_direction.iter().zip(PLATE) {
        axes.curve(&mut paper, curve.iter().copied(), ink);
    }
    axes.border(&mut paper);
    laws(&mut paper, &format!("corners b and d together {GAP} contact times high"));
    paper.finish("Largest corner shock over the direction of tilt, rigid and with contacts that take time")
}

fn laws(paper: &mut Paper, note: &str) {
    let lines = [(PLATE[0], "hysteretic"), (PLATE[1], "dashpot"), (Ink { dash: DASH, ..RIGID }, "rigid")];
    key(paper, &lines, &[34.0, 106.0, 170.0], note);
}

/// Draws the worst of all directions over the gap: rigid, and with contacts of both laws.
pub(crate) fn over_gap(ties: &Ties, [bar, _]: [f64; 2]) -> Result<String, FigureError> {
    let mut paper = Paper::new(226.0, HEIGHT);
    let gaps = ties.over_gap.iter().flatten().map(|point| point.0);
    let (low, high) = gaps.fold((f64::INFINITY, 0.0_f64), |(low, high), gap| (low.min(gap), high.max(gap)));
    let x = Axis::log(low, high, "(*h*_b + *h*_d)/(*v*_0 *τ*)");
    let axes = frame(x, Axis::linear(1.2, 2.8, "worst of all directions, in *v*_0")).on(&mut paper, 22.0);
    let rigid = ties.rigid.iter().fold(0.0_f64, |most, word| most.max(word[2]));
    axes.level(&mut paper, rigid, Ink { dash: DASH, ..RIGID });
    axes.level(&mut paper, bar, GUIDE);
    for (curve, ink) in ties.over_gap.iter().zip(PLATE) {
        axes.curve(&mut paper, curve.iter().copied(), ink);
    }
    axes.border(&mut paper);
    laws(&mut paper, "fine broken line: ends of the bar");
    paper.finish("Largest corner shock of all directions over the gap in contact times")
}
