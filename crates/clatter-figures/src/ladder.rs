//! Error over cost: the error of every model on one drop and its time, with a ring around the cheapest within the
//! tolerance.

use clatter_assess::ladder::{Ladder, Measured, Rung};
use clatter_product::Model;

use crate::FigureError;
use crate::axis::{Axis, step_up, tick};
use crate::chart::Axes;
use crate::labels::{LabelRequest, SIZE, arrange};
use crate::paper::{Paper, SMALL};
use crate::product::fit;
use crate::style::{Anchor, BLUES, GRAY, INK, Ink, LABEL, Label, Pt, RUST, SAND};

/// One panel.
#[derive(Debug)]
pub struct Panel<'a> {
    /// The measured quantity.
    pub title: String,
    /// The drop.
    pub drop: String,
    /// The models on it.
    pub ladder: &'a Ladder,
    /// The reason against cheaper models, in parts apart by semicolons.
    pub reason: String,
    /// Tolerance of the error.
    pub tolerance: f64,
}

/// Size of a frame, in pt, and the left edge of a frame in its column.
const FRAME: Pt = [184.0, 98.0];
const LEFT: f64 = 36.0;
/// Distances from the top of a panel to its frame, to the next panel, and from column to column.
const HEAD: f64 = 56.0;
const PANEL: f64 = HEAD + FRAME[1] + 32.0;
const COLUMN: f64 = 239.0;
/// Height of the strip at the foot for errors below the accuracy of the reference.
const STRIP: f64 = 16.0;
/// Radius of a mark, and of the ring around the cheapest model.
const MARK: f64 = 3.0;
const RING: f64 = 5.4;
/// The largest error in the picture: with a larger one a model is simply useless.
const MOST: f64 = 1e2;

/// Draws panels in two columns; one alone stands by itself.
pub fn panels(panels: &[Panel<'_>]) -> Result<String, FigureError> {
    let columns = if panels.len() < 2 { 1 } else { 2 };
    let rows = f64::from(u32::try_from(panels.len().div_ceil(columns)).unwrap_or(u32::MAX));
    let mut paper =
        Paper::new(LEFT + FRAME[0] + if columns > 1 { COLUMN } else { 24.0 } + 12.0, (PANEL * rows).max(HEAD));
    if panels.is_empty() {
        paper.note([4.0, 14.0], "No limit has a drop that was answered.");
    }
    for (k, of) in panels.iter().enumerate() {
        let column = if k % columns == 0 { 0.0 } else { COLUMN };
        let row = f64::from(u32::try_from(k / columns).unwrap_or(u32::MAX));
        panel(&mut paper, [column, PANEL * row], of);
    }
    paper.finish("Error over cost of every model on one drop")
}

/// Returns a model in words.
#[must_use]
pub fn words(model: Model) -> &'static str {
    match model {
        Model::NetChange => "net change",
        Model::LargestShock => "largest shock",
        Model::Map => "map",
        Model::Ballistic => "ballistic",
        Model::FiniteTilt => "finite tilt",
        Model::Compliant => "compliant",
    }
}

/// Returns the words for a rung of the ladder.
fn rung_words(rung: Rung) -> &'static str {
    match rung {
        Rung::Model(model) => words(model),
        Rung::Bar => "bar along the length",
        Rung::Plate => "plate of small tilt",
        Rung::Block => "box",
    }
}

/// Returns the ends of the error axis as shares: its low end, the begin of the strip, its high end.
fn errors(ladder: &Ladder, tolerance: f64) -> [f64; 3] {
    let strip = ladder.reference.tolerance;
    let shown = ladder.models.iter().map(|m| m.error).filter(|error| *error <= MOST);
    let most = shown.fold(10.0 * tolerance, f64::max);
    let high = step_up(1.3 * most);
    let decades = (high / strip).log10();
    [strip * 10f64.powf(-decades * STRIP / (FRAME[1] - STRIP)), strip, high]
}

fn panel(paper: &mut Paper, [left, top]: Pt, of: &Panel<'_>) {
    head(paper, [left, top], of);
    let [low, strip, high] = errors(of.ladder, of.tolerance);
    let times = of.ladder.models.iter().map(|m| 1e6 * m.seconds);
    let axes = Axes {
        corner: [left + LEFT, top + HEAD],
        size: FRAME,
        x: Axis::log_over(times.flat_map(|us| [0.5 * us, 2.0 * us]), 12.0, "time of one run, µs"),
        y: Axis::log(100.0 * low, 100.0 * high, "error, per cent"),
    };
    let axes = axes.on(paper, 28.0);
    let ([left, top], [wide, _]) = (axes.corner, axes.size);
    let (right, foot) = (left + wide, top + FRAME[1]);
    let edge = axes.at(axes.x.low, 100.0 * strip)[1];
    paper.rect([left, edge], [wide, foot - edge], Ink::fill("#ffffff"));
    paper.rect([left, edge], [wide, foot - edge], Ink::fill(SAND));
    let below = format!("< {}", tick(100.0 * strip));
    paper.text([left - 5.0, 0.5 * (edge + foot) + 2.6], &below, Label { anchor: Anchor::End, ..SMALL });
    axes.level(paper, 100.0 * of.tolerance, Ink { dash: "2 2.5", ..Ink::line(RUST, 0.7) });
    let place = |m: &Measured| {
        let [x, y] = axes.at(1e6 * m.seconds, 100.0 * m.error);
        [x, if m.error < strip { 0.5 * (edge + foot) } else { y }]
    };
    let is_cheapest = |m: &Measured| m.model == of.ladder.cheapest;
    let mut shown: Vec<&Measured> = of.ladder.models.iter().filter(|m| m.error <= MOST).collect();
    // The most important label finds its place first.
    shown.sort_by_key(|m| !is_cheapest(m));
    let wanted: Vec<LabelRequest<'_>> = shown
        .iter()
        .map(|m| LabelRequest {
            at: place(m),
            radius: if is_cheapest(m) { RING } else { MARK },
            text: rung_words(m.model),
        })
        .collect();
    let lines = [100.0 * of.tolerance, 100.0 * strip].map(|y| {
        let y = axes.at(axes.x.low, y)[1];
        [[left, y], [right, y]]
    });
    let labels = arrange(&wanted, [[left, top], [right, foot]], &lines);
    for (label, of) in labels.iter().zip(&wanted) {
        if let Some(from) = label.leader(of) {
            paper.line(from, of.at, Ink::line(GRAY, 0.4));
        }
    }
    for (m, at) in shown.iter().zip(&wanted) {
        if is_cheapest(m) {
            paper.circle(at.at, RING, Ink { stroke: RUST, width: 1.1, ..Ink::fill("#ffffff") });
        }
        mark(paper, at.at, m.model);
    }
    for ((m, label), of) in shown.iter().zip(&labels).zip(&wanted) {
        let color = if is_cheapest(m) { RUST } else { INK };
        paper.text(label.baseline(), of.text, Label { anchor: Anchor::Start, size: SIZE, color, ..LABEL });
    }
    axes.border(paper);
}

/// Draws the quantity, the drop, the cheapest model, and the reason against cheaper ones.
fn head(paper: &mut Paper, [left, top]: Pt, of: &Panel<'_>) {
    let room = LEFT + FRAME[0] - 4.0;
    let cheapest = format!("Cheapest within {} %: {}", tick(100.0 * of.tolerance), rung_words(of.ladder.cheapest));
    let useless = of.ladder.models.iter().filter(|m| m.error > MOST).map(|m| rung_words(m.model)).collect::<Vec<_>>();
    let cheapest = match &useless[..] {
        [] => cheapest,
        names => format!("{cheapest}; off the scale: {}", names.join(", ")),
    };
    let why = of.reason.as_str();
    let mut lines =
        vec![(of.title.as_str(), 9.0, INK), (of.drop.as_str(), SMALL.size, GRAY), (&cheapest, SMALL.size, RUST)];
    lines.extend(why.split("; ").map(|part| (part, SMALL.size, GRAY)));
    lines.retain(|line| !line.0.is_empty());
    // The last line stands above the frame, the others above it.
    let mut y = top + HEAD - 6.0;
    for (text, size, color) in lines.into_iter().rev() {
        paper.plain([left + 4.0, y], &fit(text, room), Label { anchor: Anchor::Start, size, color, ..LABEL });
        y -= 10.0;
    }
}

/// Draws a square where the answer is a closed form, a circle where the drop is followed; darker with more physics.
fn mark(paper: &mut Paper, [x, y]: Pt, rung: Rung) {
    let fill = match rung {
        Rung::Model(Model::NetChange | Model::LargestShock) => "#ffffff",
        Rung::Model(Model::Map) | Rung::Bar => BLUES[2],
        Rung::Model(Model::Ballistic) => BLUES[4],
        Rung::Model(Model::FiniteTilt) | Rung::Plate => BLUES[6],
        Rung::Model(Model::Compliant) | Rung::Block => BLUES[8],
    };
    let ink = Ink { stroke: INK, width: 0.7, ..Ink::fill(fill) };
    if rung < Rung::Model(Model::Map) {
        paper.rect([x - 0.85 * MARK, y - 0.85 * MARK], [1.7 * MARK, 1.7 * MARK], ink);
    } else {
        paper.circle([x, y], MARK, ink);
    }
}
