//! The atlas of a plate as a ring of directions.

use std::f64::consts::PI;

use clatter::{Atlas, Plate, Word};

use crate::FigureError;
use crate::axis::three;
use crate::paper::{Paper, SMALL};
use crate::style::{Anchor, BLUES, GRAY, INK, Ink, Label, Pt, RUST};

/// The middle of the ring, its radius without a shock, and at the largest.
const MIDDLE: Pt = [150.0, 150.0];
const INNER: f64 = 36.0;
const OUTER: f64 = 124.0;
/// Arcs are drawn in steps of this, in rad.
const STEP: f64 = 0.02;
/// The least width of a sector, in rad: a tenth of a point.
const NARROW: f64 = 1e-3;
/// The most rows of the list, and letters of a word.
const ROWS: usize = 16;
const LETTERS: usize = 12;

/// Returns the angle of a direction of the ring, in rad: r = h_d/(h_b + h_d) from 0 to 1 as a quarter of a turn.
fn angle(r: f64) -> f64 {
    libm::atan2(r, 1.0 - r)
}

fn at(angle: f64, radius: f64) -> Pt {
    let (sin, cos) = libm::sincos(angle);
    [MIDDLE[0] + radius * cos, MIDDLE[1] - radius * sin]
}

/// Returns points of an arc.
fn arc([from, to]: [f64; 2], radius: f64) -> Vec<Pt> {
    let steps = ((to - from).abs() / STEP).ceil().clamp(1.0, 1000.0);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 1000")]
    let count = steps as u32;
    (0..=count).map(|k| at(from + (to - from) * f64::from(k) / steps, radius)).collect()
}

/// Draws every direction of tilt: for each order of corners a sector, as far out as its largest corner shock, darker
/// the more strikes it has. A plate with its center of mass in the middle has all four quarters, mirror images of one
/// another; else that of corner a is drawn.
///
/// # Errors
/// [`FigureError`].
pub fn ring(plate: &Plate, atlas: &Atlas) -> Result<String, FigureError> {
    let mut paper = Paper::new(464.0, 300.0);
    let (words, most) = (atlas.words(), atlas.peak().corner.max(1.0 + plate.e()));
    let radius = |shock: f64| INNER + (OUTER - INNER) * shock / most;
    let counts = || words.iter().map(|word| word.corners.len());
    let strikes = [counts().min().unwrap_or(0), counts().max().unwrap_or(0)];
    // The quarters are those of corner a, then b, c and d, each rising away from it.
    let mirrors: [fn(f64) -> f64; 4] = [|x| x, |x| PI - x, |x| PI + x, |x| -x];
    let quarters = if plate.is_centered() { &mirrors[..] } else { &mirrors[..1] };
    for mirrored in quarters {
        for some in sectors(words) {
            let (Some(first), Some(last)) = (some.first(), some.last()) else { continue };
            let ends = [first.from, last.to].map(|r| mirrored(angle(r)));
            let highest = some.iter().fold(first, |most, word| if word.peak() > most.peak() { word } else { most });
            let mut sector = arc(ends, radius(highest.peak()));
            sector.extend(arc([ends[1], ends[0]], INNER));
            paper.path(&sector, true, Ink { stroke: "#ffffff", width: 0.3, ..Ink::fill(shade(highest, strikes)) });
        }
    }
    paper.describe("sectors, as far out as the largest shock of a corner, darker the more strikes");
    let whole = [0.0, if plate.is_centered() { 2.0 * PI } else { 0.5 * PI }];
    paper.path(&arc(whole, INNER), false, Ink::line(GRAY, 0.6));
    let flat = Ink { dash: "2.5 2", ..Ink::line(RUST, 0.9) };
    paper.path(&arc(whole, radius(1.0 + plate.e())), false, flat);
    for (mirrored, letter) in quarters.iter().zip(["*a*", "*b*", "*c*", "*d*"]) {
        let [x, y] = at(mirrored(0.25 * PI), 0.6 * INNER);
        paper.text([x, y + 3.0], letter, SMALL);
    }
    let beside = Label { color: GRAY, ..SMALL };
    paper.text(at(0.0, OUTER + 6.0).map(|x| x + 2.0), "length", Label { anchor: Anchor::Start, ..beside });
    let [x, y] = at(0.5 * PI, OUTER + 6.0);
    paper.text([x, y], "width", beside);
    list(&mut paper, words, flat, 1.0 + plate.e());
    paper.finish("Where the plate rises to, and what each direction does: inside, the corner that strikes first")
}

/// Returns words one by one, except those that are too narrow to be visible together: of these the highest shock is
/// drawn.
fn sectors(words: &[Word]) -> Vec<&[Word]> {
    let (mut all, mut from) = (Vec::new(), 0);
    for (k, word) in words.iter().enumerate() {
        if angle(word.to) - angle(words[from].from) >= NARROW || k + 1 == words.len() {
            all.push(&words[from..=k]);
            from = k + 1;
        }
    }
    all
}

/// Returns the color of a word: darker the more strikes it has, between the least and the most.
fn shade(word: &Word, [least, most]: [usize; 2]) -> &'static str {
    BLUES[2 + 4 * (word.corners.len() - least) / (most - least).max(1)]
}

/// Lists the words, or the widest of them, with their directions and largest corner shocks.
fn list(paper: &mut Paper, words: &[Word], flat: Ink<'_>, flat_v0: f64) {
    let left = 322.0;
    let start = Label { anchor: Anchor::Start, ..SMALL };
    let end = Label { anchor: Anchor::End, ..SMALL };
    let mut y = 16.0;
    paper.line([left, y - 2.8], [left + 18.0, y - 2.8], flat);
    paper.text([left + 23.0, y], &format!("a flat drop, {} *v*_0_", three(flat_v0)), start);
    y += 16.0;
    let heads = Label { color: GRAY, ..SMALL };
    paper.text([left, y], "from", Label { anchor: Anchor::Start, ..heads });
    paper.text([left + 44.0, y], "order", Label { anchor: Anchor::Start, ..heads });
    paper.text([456.0, y], "*v*_0_", Label { anchor: Anchor::End, ..heads });
    let wide = |word: &Word| angle(word.to) - angle(word.from);
    let mut widest: Vec<&Word> = words.iter().collect();
    widest.sort_by(|a, b| wide(b).total_cmp(&wide(a)));
    widest.truncate(ROWS);
    widest.sort_by(|a, b| a.from.total_cmp(&b.from));
    for word in &widest {
        y += 12.0;
        let letters: String = word.corners.iter().take(LETTERS).map(|corner| corner.letter()).collect();
        let more = if word.corners.len() > LETTERS || !word.ended { "…" } else { "" };
        paper.text([left, y], &format!("{}°", three(angle(word.from).to_degrees())), start);
        paper.plain([left + 44.0, y], &format!("{letters}{more}"), Label { color: INK, ..start });
        paper.text([456.0, y], &three(word.peak()), end);
    }
    if words.len() > widest.len() {
        paper.text(
            [left, y + 14.0],
            &format!("and {} narrower ones", words.len() - widest.len()),
            Label { color: GRAY, ..start },
        );
    }
}
