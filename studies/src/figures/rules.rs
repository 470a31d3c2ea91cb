//! Figures of the shock report: the effect of a clatter on parts of any frequency, anywhere.

use clatter_figures::FigureError;
use clatter_figures::draw::{
    Anchor, Axes, Axis, BLUES, GRAY, GUIDE, INK, Ink, LABEL, Label, Paper, Pt, RUST, SAND, SMALL, plane_axes, step_up,
    width,
};
use clatter_shock::Rule;

use crate::suspended::{GainMap, Holders, OMEGAS, SuspendedZones};

const OMEGA: &str = "*Ω* = *ωh*_0/*v*_0";
const DOTS: Ink = Ink { dash: "1.2 2", ..GUIDE };
const STANDARD: Ink = Ink { dash: "8 2 1.5 2", ..Ink::line(INK, 0.8) };

fn omega_axis(title: &str) -> Axis<'_> {
    Axis::log(OMEGAS[0], OMEGAS[1], title)
}

/// Returns the peaks of a rule over that of one shock of v0.
fn peaks(rule: &Rule) -> impl Iterator<Item = (f64, f64)> + '_ {
    rule.points.iter().map(|p| (p.omega, 2.0 * p.gain))
}

/// Returns the limits of a rule over the peak of one shock of v0: soft, and stiff if there is one.
fn limits(rule: &Rule) -> (f64, Option<f64>) {
    let unit = 0.5 * rule.standard.acceleration;
    (rule.soft.acceleration / unit, rule.stiff.map(|stiff| stiff.acceleration / unit))
}

/// The rule of one bar at its end, quarter points and center.
#[derive(Debug)]
pub struct BarRules {
    /// Design of the bar, q and e.
    pub design: [f64; 2],
    /// Rules at end, quarter point and center.
    pub rules: [Rule; 3],
}

/// Draws a panel for each bar: the rule at three distances from the center, between its asymptotes.
pub fn rules(bars: &[BarRules; 4]) -> Result<String, FigureError> {
    let inks = [Ink::line(BLUES[8], 1.2), Ink::line(RUST, 1.0), Ink::line("#4c7a49", 1.0)];
    let top = bars.iter().flat_map(|b| &b.rules).flat_map(peaks).fold(0.0_f64, |m, p| m.max(p.1));
    let mut paper = Paper::new(465.0, 336.0);
    for (i, bar) in bars.iter().enumerate() {
        let (column, row) = ([0.0, 1.0][i % 2], [0.0, 1.0][i / 2]);
        let axes = Axes {
            corner: [30.0 + 231.0 * column, 18.0 + 150.0 * row],
            size: [194.0, 118.0],
            x: omega_axis(if i > 1 { OMEGA } else { "" }),
            y: Axis::linear(0.0, 1.06 * top, if i % 2 == 0 { "peak, in *v*_0" } else { "" }),
        };
        let axes = axes.on(&mut paper, 22.0);
        axes.level(&mut paper, 2.0, STANDARD);
        for (rule, ink) in bar.rules.iter().zip(inks) {
            let (soft, stiff) = limits(rule);
            let guide = |paper: &mut Paper, y: f64, from: f64, to: f64, dash| {
                axes.curve(paper, [(from, y), (to, y)].into_iter(), Ink { dash, width: 0.7, ..ink });
            };
            guide(&mut paper, soft, OMEGAS[0], 2.0, "3 2");
            if let Some(stiff) = stiff {
                guide(&mut paper, stiff, 8.0, OMEGAS[1], "1.2 1.6");
            }
            axes.curve(&mut paper, peaks(rule), ink);
        }
        axes.border(&mut paper);
        let [q, e] = bar.design;
        let [left, upper] = axes.corner;
        let title = format!("*q* = {q}, *e* = {e}");
        paper.text([left + 97.0, upper - 5.0], &title, LABEL);
    }
    let lines = [(inks[0], "end"), (inks[1], "quarter point"), (inks[2], "center"), (STANDARD, "one shock of 2 *v*_0")];
    across(&mut paper, 332.0, &lines, &[60.0, 115.0, 210.0, 280.0]);
    paper.finish("The three-way rule: peak acceleration over natural frequency for four bars at three places")
}

/// Draws a key in one row.
fn across(paper: &mut Paper, y: f64, lines: &[(Ink, &str)], at: &[f64]) {
    for (line, x) in lines.iter().zip(at) {
        paper.key([*x, y], &[*line]);
    }
}

/// Draws the rule of one bar at its end for several damping ratios.
pub fn damping(rules: &[(f64, Rule)]) -> Result<String, FigureError> {
    let inks = [
        Ink { width: 0.7, ..Ink::line(BLUES[5], 0.7) },
        Ink::line(BLUES[8], 1.2),
        Ink::line(RUST, 1.1),
        Ink { dash: "5 2", ..Ink::line(INK, 1.1) },
    ];
    let top = rules.iter().flat_map(|(_, rule)| peaks(rule)).fold(0.0_f64, |m, p| m.max(p.1));
    let last = rules.iter().filter_map(|(_, rule)| rule.points.last()).fold(0.0_f64, |m, p| m.max(p.omega));
    let axes = Axes {
        corner: [30.0, 8.0],
        size: [262.0, 176.0],
        x: Axis::log(OMEGAS[0], step_up(last), OMEGA),
        y: Axis::linear(0.0, 1.06 * top, "peak, in *v*_0"),
    };
    let mut paper = Paper::new(304.0, 230.0);
    let axes = axes.on(&mut paper, 22.0);
    let mut lines = Vec::new();
    for ((zeta, rule), ink) in rules.iter().zip(inks) {
        if let (soft, Some(stiff)) = limits(rule) {
            axes.level(&mut paper, soft, GUIDE);
            axes.level(&mut paper, stiff, DOTS);
        }
        axes.curve(&mut paper, peaks(rule), ink);
        lines.push((ink, format!("*ζ* = {zeta}")));
    }
    axes.border(&mut paper);
    let lines: Vec<(Ink, &str)> = lines.iter().map(|(ink, name)| (*ink, name.as_str())).collect();
    across(&mut paper, 225.0, &lines, &[30.0, 92.0, 160.0, 228.0]);
    paper.finish("The three-way rule at the end of a bar for four damping ratios")
}

/// The levels at which a band map changes color, and the colors: one more than levels.
struct Bands<'a> {
    levels: &'a [f64],
    colors: &'a [&'static str],
}

impl Bands<'_> {
    fn color(&self, v: f64) -> &'static str {
        let i = self.levels.iter().filter(|level| v >= **level).count();
        self.colors.get(i).copied().unwrap_or(SAND)
    }
}

/// Draws a frame whose cells are strips of one color from crossing to crossing of a level.
///
/// `values` row by row from the lowest, of cells whose middles are `columns` (on the page) apart from one another.
fn strips(paper: &mut Paper, corner: Pt, size: Pt, columns: usize, values: &[f64], bands: &Bands<'_>, smooth: bool) {
    let rows = values.len() / columns.max(1);
    #[expect(clippy::cast_precision_loss, reason = "a small grid")]
    let (high, wide) = (size[1] / rows as f64, size[0] / columns as f64);
    let mut bottom = corner[1] + size[1];
    for line in values.chunks(columns) {
        // a hair of overlap, or the ground shows between the strips
        let strip = |paper: &mut Paper, from: f64, to: f64, color: &'static str| {
            let (y, h) = ((bottom - high - 0.2).max(corner[1]), high + 0.2);
            paper.rect([corner[0] + from, y], [to - from, h.min(bottom - y)], Ink::fill(color));
        };
        let mut from = 0.0;
        let mut middle = 0.5 * wide;
        for pair in line.windows(2) {
            let colors = [bands.color(pair[0]), bands.color(pair[1])];
            if colors[0] != colors[1] {
                let crossed = bands.levels.iter().find(|level| (pair[0] < **level) != (pair[1] < **level));
                let share = crossed.map_or(0.5, |level| (level - pair[0]) / (pair[1] - pair[0]));
                let to = middle + wide * if smooth { share } else { 0.5 };
                strip(paper, from, to, colors[0]);
                from = to;
            }
            middle += wide;
        }
        strip(paper, from, size[0], bands.color(line[line.len() - 1]));
        bottom -= high;
    }
}

/// Returns rows between the rows, on straight lines; the first and last reach to the border.
fn between_rows(values: &[f64], columns: usize, times: u8) -> Vec<f64> {
    let rows: Vec<&[f64]> = values.chunks(columns).collect();
    let mut all = Vec::with_capacity(values.len() * usize::from(times));
    for (j, row) in rows.iter().enumerate() {
        for k in 0..times {
            let off = (f64::from(k) + 0.5) / f64::from(times) - 0.5;
            let other = if off < 0.0 { j.saturating_sub(1) } else { (j + 1).min(rows.len() - 1) };
            all.extend(row.iter().zip(rows[other]).map(|(a, b)| a + off.abs() * (b - a)));
        }
    }
    all
}

/// Draws the largest gain over one shock of 2 v0, over the plane of bars.
pub fn gain(map: &GainMap, designs: &[[f64; 2]; 4]) -> Result<String, FigureError> {
    let bands = Bands {
        levels: &[0.8, 1.0, 1.25, 1.5, 2.0, 3.0],
        colors: &[SAND, "#f6f0e4", BLUES[1], BLUES[3], BLUES[4], BLUES[6], BLUES[8]],
    };
    let mut paper = Paper::new(296.0, 236.0);
    let axes = plane_axes([34.0, 8.0], 190.0).without_grid(&mut paper, 24.0);
    strips(&mut paper, axes.corner, axes.size, map.cells, &between_rows(&map.gain, map.cells, 6), &bands, true);
    for [q, e] in designs {
        axes.mark(&mut paper, *e, *q, "#ffffff");
    }
    axes.border(&mut paper);
    let names = ["below 0.8", "0.8 to 1", "1 to 1.25", "1.25 to 1.5", "1.5 to 2", "2 to 3", "above 3"];
    swatches(&mut paper, [234.0, 20.0], &bands.colors.iter().copied().zip(names).collect::<Vec<_>>());
    paper.finish("Largest gain over a single shock of 2 v0, over restitution and inertia ratio")
}

/// Draws colors and their meaning, one below the other.
fn swatches(paper: &mut Paper, [x, mut y]: Pt, list: &[(&'static str, &str)]) {
    for (color, name) in list {
        paper.rect([x, y - 7.5], [9.0, 9.0], Ink { stroke: GRAY, width: 0.4, ..Ink::fill(color) });
        paper.text([x + 13.0, y], name, Label { anchor: Anchor::Start, ..SMALL });
        y += 13.0;
    }
}

/// Draws the impact that the peak follows, over Ω and position.
pub fn holders(data: &Holders, [q, e]: [f64; 2]) -> Result<String, FigureError> {
    let colors: [&'static str; 6] = [SAND, BLUES[2], BLUES[4], BLUES[6], BLUES[8], "#d8a27f"];
    let bands = Bands { levels: &[1.5, 2.5, 3.5, 4.5, 5.5], colors: &colors };
    // the first by number, those between, the last
    let last = data.impacts;
    let class = |n: usize| match n {
        n if n == last => 6.0,
        1 => 1.0,
        2 => 2.0,
        3 => 3.0,
        4 => 4.0,
        _ => 5.0,
    };
    let values: Vec<f64> = data.impact.iter().map(|&n| class(n)).collect();
    let mut paper = Paper::new(226.0, 236.0);
    let axes = Axes {
        corner: [34.0, 18.0],
        size: [178.0, 150.0],
        x: omega_axis(OMEGA),
        y: Axis::linear(-1.0, 1.0, "position *s*"),
    };
    let axes = axes.without_grid(&mut paper, 25.0);
    strips(&mut paper, axes.corner, axes.size, data.omegas.len(), &values, &bands, false);
    axes.border(&mut paper);
    paper.text([axes.corner[0] + 89.0, 13.0], &format!("*q* = {q}, *e* = {e}: {} impacts", data.impacts), LABEL);
    let between = format!("5 to {}", last.saturating_sub(1));
    let names = ["1", "2", "3", "4", &between, "the last"];
    let mut x = 34.0;
    for (i, (color, name)) in colors.iter().zip(names).enumerate() {
        let there = match i {
            0..=3 => i + 1 < last,
            4 => last > 5,
            _ => true,
        };
        if there {
            swatches(&mut paper, [x, 226.0], &[(*color, name)]);
            x += 18.0 + width(name, SMALL.size);
        }
    }
    paper.text([34.0, 211.0], "the peak follows impact", Label { anchor: Anchor::Start, ..SMALL });
    paper.finish("Number of the impact that the peak acceleration follows, over frequency and position")
}

/// Draws safe zones of suspended parts over Ω, with those of the paper.
pub fn zones(data: &[SuspendedZones; 3], [q, e]: [f64; 2]) -> Result<String, FigureError> {
    let inks = [Ink::line(BLUES[8], 1.3), Ink::line(RUST, 1.2), Ink::line("#4c7a49", 1.2)];
    let mut paper = Paper::new(226.0, 222.0);
    let axes = Axes {
        corner: [34.0, 18.0],
        size: [178.0, 150.0],
        x: omega_axis(OMEGA),
        y: Axis::linear(0.0, 1.0, "safe zone *s*"),
    };
    let axes = axes.on(&mut paper, 25.0);
    let mut lines = Vec::new();
    for (zone, ink) in data.iter().zip(inks) {
        if let Some(own) = zone.paper {
            axes.level(&mut paper, own, Ink { dash: "3 2", width: 0.7, ..ink });
        }
        let curve = zone.omegas.iter().zip(&zone.zones).map(|(w, s)| (*w, s.unwrap_or(0.0)));
        axes.curve(&mut paper, curve, ink);
        lines.push((ink, format!("{} *v*_0", zone.threshold)));
    }
    axes.border(&mut paper);
    paper.text([axes.corner[0] + 89.0, 13.0], &format!("*q* = {q}, *e* = {e}"), LABEL);
    let lines: Vec<(Ink, &str)> = lines.iter().map(|(ink, name)| (*ink, name.as_str())).collect();
    across(&mut paper, 214.0, &lines, &[40.0, 104.0, 162.0]);
    paper.finish("Safe zone of a suspended part over its natural frequency, for three thresholds")
}

/// Draws the amplification of single pulses over natural frequency times duration: a name and a curve each.
pub fn amplifications(shapes: &[(&str, Vec<(f64, f64)>)]) -> Result<String, FigureError> {
    let ink = |color, dash| Ink { dash, ..Ink::line(color, 1.1) };
    let inks = [
        ink(BLUES[8], ""),
        ink(BLUES[5], ""),
        ink("#4c7a49", ""),
        ink(RUST, "4 2"),
        ink(RUST, ""),
        ink(INK, ""),
        ink(GRAY, "2 1.5"),
    ];
    let axes = Axes {
        corner: [32.0, 8.0],
        size: [268.0, 130.0],
        x: Axis::log(0.1, 10.0, "natural frequency times duration, *fD*"),
        y: Axis::linear(0.0, 2.1, "peak over amplitude, |*A*|/*a*"),
    };
    let mut paper = Paper::new(440.0, 172.0);
    let axes = axes.on(&mut paper, 24.0);
    for ((_, curve), ink) in shapes.iter().zip(inks) {
        axes.curve(&mut paper, curve.iter().copied(), ink);
    }
    axes.border(&mut paper);
    let lines: Vec<(Ink, &str)> = shapes.iter().zip(inks).map(|((name, _), ink)| (ink, *name)).collect();
    paper.key([310.0, 20.0], &lines);
    paper.finish("Amplification of single pulses without damping")
}

/// Draws the estimates of simpler models over the peak by the train of pulses: a name and a curve each.
pub fn models(curves: &[(&str, Vec<(f64, f64)>)]) -> Result<String, FigureError> {
    let inks = [
        Ink { dash: "3 2.5", ..Ink::line(GRAY, 1.1) },
        Ink { dash: "1.2 1.6", ..Ink::line(RUST, 1.2) },
        Ink::line(RUST, 1.1),
        Ink::line(BLUES[8], 1.4),
    ];
    let ends =
        |k: usize| curves.iter().filter_map(move |(_, c)| if k == 0 { c.first() } else { c.last() }).map(|p| p.0);
    let axes = Axes {
        corner: [30.0, 8.0],
        size: [262.0, 140.0],
        x: Axis::log(ends(0).fold(f64::INFINITY, f64::min), ends(1).fold(0.0, f64::max), "natural frequency, Hz"),
        y: Axis::linear(0.0, 2.5, "estimate over peak"),
    };
    let mut paper = Paper::new(304.0, 206.0);
    let axes = axes.on(&mut paper, 24.0);
    axes.level(&mut paper, 1.0, Ink::line(INK, 0.7));
    for ((_, curve), ink) in curves.iter().zip(inks) {
        axes.curve(&mut paper, curve.iter().copied(), ink);
    }
    axes.border(&mut paper);
    let lines: Vec<(Ink, &str)> = curves.iter().zip(inks).map(|((name, _), ink)| (ink, *name)).collect();
    for (pair, x) in lines.chunks(2).zip([30.0, 170.0]) {
        paper.key([x, 190.0], pair);
    }
    paper.finish("Estimates of simpler models over the peak that the train of pulses makes")
}
