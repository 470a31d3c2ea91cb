//! Fig. 1: the bar, drawn.

use clatter_figures::FigureError;
use clatter_figures::draw::{Anchor, GRAY, INK, Ink, LABEL, Label, Paper, Pt, RUST};

/// Draws the bar at the moment end a touches, with both centers of percussion; `percussion` is p/L.
pub fn scheme(percussion: f64) -> Result<String, FigureError> {
    let mut paper = Paper::new(300.0, 122.0);
    let ground = 108.0;
    let (tilt, half) = (7f64.to_radians(), 118.0);
    let foot = [30.0, ground];
    let center = [foot[0] + half * tilt.cos(), ground - half * tilt.sin() - 4.0];
    let at = |s: f64, off: f64| -> Pt {
        [center[0] + s * half * tilt.cos() - off * tilt.sin(), center[1] - s * half * tilt.sin() - off * tilt.cos()]
    };
    // ground
    paper.line([8.0, ground], [294.0, ground], Ink::line(INK, 0.9));
    for i in 0..36u8 {
        let x = 13.0 + 8.0 * f64::from(i);
        paper.line([x, ground], [x - 5.0, ground + 5.0], Ink::line(GRAY, 0.4));
    }
    // bar
    paper.path(
        &[at(-1.0, 4.0), at(1.0, 4.0), at(1.0, -4.0), at(-1.0, -4.0)],
        true,
        Ink { stroke: INK, width: 0.8, ..Ink::fill("#cddeed") },
    );
    // arriving
    for s in [-0.84, 0.84] {
        let [x, y] = at(s, 37.0);
        paper.arrow([x, y], [x, y + 26.0], RUST, 1.0);
        paper.text([x + 5.0, y + 10.0], "*v*_0", Label { anchor: Anchor::Start, color: RUST, ..LABEL });
    }
    // points
    let dot = |paper: &mut Paper, s: f64, fill| {
        paper.circle(at(s, 0.0), 2.5, Ink { stroke: INK, width: 0.8, ..Ink::fill(fill) });
    };
    dot(&mut paper, 0.0, INK);
    dot(&mut paper, percussion, "#ffffff");
    dot(&mut paper, -percussion, "#ffffff");
    let over = |paper: &mut Paper, s: f64, text: &str| {
        let [x, y] = at(s, 9.0);
        paper.text([x, y], text, LABEL);
    };
    over(&mut paper, percussion, "*R*_a");
    over(&mut paper, -percussion, "*R*_b");
    over(&mut paper, 0.0, "CM");
    let [x, y] = at(-1.0, 9.0);
    paper.text([x - 9.0, y + 6.0], "*a*", LABEL);
    let [x, y] = at(1.0, 0.0);
    paper.text([x + 9.0, y + 3.0], "*b*", LABEL);
    // lengths along the bar, above it
    let measure = |paper: &mut Paper, from: f64, to: f64, off: f64, text: &str| {
        let (a, b) = (at(from, off), at(to, off));
        let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
        paper.arrow(middle, a, GRAY, 0.5);
        paper.arrow(middle, b, GRAY, 0.5);
        for s in [from, to] {
            paper.line(at(s, off - 3.5), at(s, off + 3.5), Ink::line(GRAY, 0.4));
        }
        let [x, y] = at(0.5 * (from + to), off + 5.0);
        paper.text([x, y], text, Label { turn: -tilt.to_degrees(), ..LABEL });
    };
    measure(&mut paper, 0.0, percussion, 26.0, "*p* = *J* / *mL*");
    measure(&mut paper, -1.0, 0.0, 48.0, "*L*");
    measure(&mut paper, 0.0, 1.0, 48.0, "*L*");
    // a point at l, below
    let l = 0.58;
    measure(&mut paper, 0.0, l, -14.0, "");
    let [x, y] = at(l, -14.0);
    paper.text([x + 4.0, y + 3.5], "*l* = *sL*", Label { anchor: Anchor::Start, ..LABEL });
    dot(&mut paper, l, "#98b8d6");
    // height gap
    let [x, y] = at(1.0, -4.0);
    paper.arrow([x, 0.5 * (y + ground)], [x, y], GRAY, 0.5);
    paper.arrow([x, 0.5 * (y + ground)], [x, ground], GRAY, 0.5);
    paper.text([x + 5.0, 0.5 * (y + ground) + 3.0], "*h*_0", Label { anchor: Anchor::Start, ..LABEL });
    paper.finish("A bar that strikes the ground with its left end first")
}
