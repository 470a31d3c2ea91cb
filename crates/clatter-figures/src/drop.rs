//! One drop in time: heights, velocity shocks, and pulses where contacts take time.

use clatter_flight::history::{Forces, Row};
use clatter_flight::{Stop, Strike};
use clatter_product::STANDARD_GRAVITY_M_S2;

use crate::FigureError;
use crate::axis::{Axis, three};
use crate::chart::{Axes, Chart};
use crate::paper::{Paper, SMALL};
use crate::product::fit;
use crate::style::{Anchor, BLUES, GRAY, INK, Ink, Label, RUST, SAND, width};

/// One drop in time, as [`drop`] draws it.
#[derive(Debug, Clone, Copy)]
pub struct Drop<'a> {
    /// Name of the model, in a few words.
    pub model: &'a str,
    /// Heights, velocities and, where contacts take time, accelerations and forces over time.
    pub rows: &'a [Row],
    /// The strikes.
    pub strikes: &'a [Strike],
    /// The times of contact of each strike, where contacts take time; else empty.
    pub pulses: &'a [clatter_flight::Press],
    /// The end of the motion.
    pub stop: Stop,
    /// Positions on the body, in [−1, 1], whose shocks are shown too.
    pub at: &'a [f64],
    /// Names of these positions, such as "camera, 55 mm".
    pub called: &'a [String],
}

/// Lines of ends a and b.
const ENDS: [&str; 2] = [BLUES[7], RUST];
/// Marks of positions, one after the other.
const FILLS: [&str; 4] = ["#ffffff", "#b5b9bd", "#efe5d3", "#1d2329"];
/// Lines of positions, one after the other.
const DASHES: [&str; 4] = ["", "4 2", "1.5 1.5", "6 2 1.5 2"];

/// A unit of ten to some power of three.
#[derive(Clone, Copy)]
struct Unit {
    factor: f64,
    prefix: &'static str,
}

impl Unit {
    /// Returns the unit in which `largest` lies between 0.5 and 500, if there is one.
    fn of(largest: f64) -> Self {
        const PREFIXES: [(f64, &str); 9] = [
            (1e-9, "G"),
            (1e-6, "M"),
            (1e-3, "k"),
            (1.0, ""),
            (1e3, "m"),
            (1e6, "µ"),
            (1e9, "n"),
            (1e12, "p"),
            (1e15, "f"),
        ];
        let found = PREFIXES.into_iter().find(|(factor, _)| largest * factor >= 0.5);
        let (factor, prefix) = found.unwrap_or((1.0, ""));
        Self { factor, prefix }
    }
}

/// A span of time, drawn as a column.
#[derive(Clone, Copy)]
struct Column {
    left: f64,
    width: f64,
    from_s: f64,
    until_s: f64,
}

/// A frame in a column, and the factors of its numbers.
struct Panel<'a> {
    chart: Chart<'a>,
    time: f64,
    value: f64,
}

impl Panel<'_> {
    fn curve(&self, paper: &mut Paper, points: impl Iterator<Item = (f64, f64)>, ink: Ink) {
        let scaled: Vec<_> = points.map(|(t, y)| (t * self.time, y * self.value)).collect();
        let step = (self.chart.x.high - self.chart.x.low) / self.chart.size[0] / 4.0;
        self.chart.curve(paper, thinned(&scaled, step).into_iter(), ink);
    }
    fn at(&self, t: f64, y: f64) -> [f64; 2] {
        self.chart.at(t * self.time, y * self.value)
    }
}

/// Returns the visible points within each step: the first, the last, the lowest and the highest.
pub(crate) fn thinned(points: &[(f64, f64)], step: f64) -> Vec<(f64, f64)> {
    let bucket = |p: &(f64, f64)| (p.0 / step).floor();
    let mut kept = Vec::new();
    for run in points.chunk_by(|a, b| (bucket(a) - bucket(b)).abs() < 0.5) {
        let extreme =
            |sign: f64| (0..run.len()).max_by(|&i, &j| (sign * run[i].1).total_cmp(&(sign * run[j].1))).unwrap_or(0);
        let mut shown = [0, extreme(1.0), extreme(-1.0), run.len() - 1];
        shown.sort_unstable();
        kept.extend(shown.iter().enumerate().filter(|(k, i)| *k == 0 || shown[k - 1] != **i).map(|(_, i)| run[*i]));
    }
    kept
}

/// Returns the end of the part that is magnified, 1.25 times the time t at which a long pause begins; `None` if there is
/// no such pause. A pause is long if it follows at least three strikes and lasts beyond 1.6 t; if none does, the last
/// pause is taken if it lasts beyond 2 t. Pauses count from the hardest strike on, as long as 7.5 t is before `end_s`.
fn early(drop: &Drop<'_>, end_s: f64) -> Option<f64> {
    let hardness = |strike: &Strike| strike.delta_v_m_s.iter().fold(0.0_f64, |most, dv| most.max(dv.abs()));
    let strikes = drop.strikes.iter().map(hardness).enumerate();
    let hardest = strikes.fold((0, 0.0), |most, (i, dv)| if dv > most.1 { (i, dv) } else { most }).0;
    let mut over_s = 0.0_f64;
    let over = drop.strikes.iter().enumerate().map(|(i, strike)| {
        let until_s = drop.pulses.get(i).map_or(strike.time_s, |pulse| pulse.until_s);
        over_s = over_s.max(if until_s.is_finite() { until_s } else { strike.time_s });
        over_s
    });
    let pauses = over.zip(drop.strikes.iter().skip(1)).enumerate();
    let mut before = None;
    for (i, (over_s, next)) in pauses.take_while(|(_, (over_s, _))| 7.5 * over_s < end_s) {
        let pause = if over_s > 0.0 { next.time_s / over_s } else { 0.0 };
        if i >= hardest.max(2) && pause > 1.6 {
            return Some(1.25 * over_s);
        }
        before = if i >= hardest && pause > 2.0 { Some(1.25 * over_s) } else { before };
    }
    before
}

/// Returns the lowest and highest of some values and 0, with a margin.
fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let (low, high) = values.filter(|v| v.is_finite()).fold((0.0, 0.0), |(a, b): (f64, f64), v| (a.min(v), b.max(v)));
    if high > low { [low - 0.06 * (high - low), high + 0.06 * (high - low)] } else { [-0.06, 1.0] }
}

/// Draws a drop: heights of both ends over time with the strikes marked, the velocity shocks below, and, where contacts
/// take time, forces and accelerations below these. Where the later strikes come much later than the first, the first
/// are drawn next to the whole, magnified.
///
/// ```
/// use clatter_flight::{Profile, Model, Scene};
/// let scene = Scene::new(Profile::new(0.14, 0.04)?, 0.3, 4.43, 5.0, 9.81)?;
/// let motion = scene.fly(Model::FiniteTilt)?;
/// let rows: Vec<_> = motion.rows().collect();
/// let (strikes, stop) = (&motion.strikes, motion.stop);
/// let drop = clatter_figures::Drop { model: "finite tilt", rows: &rows, strikes, pulses: &[], stop, at: &[0.0], called: &["middle".into()] };
/// assert!(clatter_figures::drop(&drop)?.contains("at rest"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn drop(drop: &Drop<'_>) -> Result<String, FigureError> {
    let end_s = drop.rows.last().map_or(0.0, |row| row.time_s);
    let end_s = if end_s > 0.0 { end_s } else { 1e-3 };
    let pressed = drop.rows.iter().any(|row| row.forces.is_some());
    let (top, high, gap) = (34.0, 112.0, 26.0);
    let panels = if pressed { 3 } else { 2 };
    let mut paper = Paper::new(520.0, top + f64::from(panels) * (high + gap) + 2.0);
    let columns = match early(drop, end_s) {
        Some(until_s) => vec![
            Column { left: 44.0, width: 195.0, from_s: 0.0, until_s },
            Column { left: 308.0, width: 195.0, from_s: 0.0, until_s: end_s },
        ],
        None => vec![Column { left: 44.0, width: 459.0, from_s: 0.0, until_s: end_s }],
    };
    heading(&mut paper, drop, pressed);
    for (k, column) in columns.iter().enumerate() {
        let magnified = (k > 0).then(|| columns[0].until_s);
        let bottom = |n: u8| [column.left, top + f64::from(n) * (high + gap)];
        heights(&mut paper, drop, *column, bottom(0), high, magnified);
        shocks(&mut paper, drop, *column, bottom(1), high, !pressed);
        if pressed {
            pulses(&mut paper, drop, *column, bottom(2), high);
        }
    }
    paper.finish("Heights of both ends and velocity shocks over time")
}

/// Draws the name of the model, the end of the motion, and the key of the lines.
fn heading(paper: &mut Paper, drop: &Drop<'_>, pressed: bool) {
    let stop = match drop.stop {
        Stop::AtRest { .. } => "at rest at",
        Stop::BouncedClear { .. } => "bounced clear at",
        Stop::TurnedOver { .. } => "turned over at",
        Stop::ImpactLimit { .. } => "list full at",
        _ => "left at",
    };
    let (n, time) = (drop.strikes.len(), drop.stop.time_s());
    let unit = Unit::of(time);
    let impacts = if n == 1 { "impact" } else { "impacts" };
    let text = format!("{}: {n} {impacts}, {stop} {} {}s", drop.model, three(time * unit.factor), unit.prefix);
    paper.text([44.0, 12.0], &text, Label { anchor: Anchor::Start, ..SMALL });
    let mut x = 44.0;
    let y = 25.0;
    let words = |paper: &mut Paper, x: &mut f64, text: &str| {
        paper.text([*x, y], text, Label { anchor: Anchor::Start, ..SMALL });
        *x += width(text, SMALL.size) + 16.0;
    };
    for (end, color) in ["end *a*", "end *b*"].into_iter().zip(ENDS) {
        paper.line([x, y - 2.8], [x + 16.0, y - 2.8], Ink::line(color, 1.2));
        x += 20.0;
        words(paper, &mut x, end);
    }
    for (k, name) in drop.called.iter().enumerate() {
        if pressed {
            paper.line([x, y - 2.8], [x + 16.0, y - 2.8], position_line(k));
            x += 8.0;
        }
        paper.circle([x, y - 2.8], 2.2, position_mark(k));
        x += if pressed { 12.0 } else { 5.0 };
        words(paper, &mut x, &fit(name, 130.0));
    }
    if pressed {
        let text = "last row: force on each end over the mass of the body";
        paper.text([503.0, y], text, Label { anchor: Anchor::End, color: GRAY, ..SMALL });
    }
}

fn position_line(k: usize) -> Ink<'static> {
    Ink { dash: DASHES[k % DASHES.len()], ..Ink::line(INK, 0.7) }
}

fn position_mark(k: usize) -> Ink<'static> {
    Ink { stroke: INK, width: 0.7, ..Ink::fill(FILLS[k % FILLS.len()]) }
}

/// Draws a frame over the time of a column, with ticks and a title of its values.
fn panel<'a>(
    paper: &mut Paper,
    column: Column,
    corner: [f64; 2],
    high: f64,
    [low, top]: [f64; 2],
    unit: Unit,
    titles: [&'a str; 2],
) -> Panel<'a> {
    let time = Unit::of(column.until_s);
    let x = Axis::linear(column.from_s * time.factor, column.until_s * time.factor, titles[0]);
    let y = Axis::linear(low * unit.factor, top * unit.factor, titles[1]);
    let chart = Axes { corner, size: [column.width, high], x, y }.on(paper, 31.0);
    Panel { chart, time: time.factor, value: unit.factor }
}

fn heights(paper: &mut Paper, drop: &Drop<'_>, column: Column, corner: [f64; 2], high: f64, magnified: Option<f64>) {
    let seen: Vec<&Row> = drop.rows.iter().filter(|row| row.time_s <= column.until_s).collect();
    let [low, top] = range(seen.iter().flat_map(|row| row.height_m));
    let unit = Unit::of(top.max(-low));
    let title = format!("height, {}m", unit.prefix);
    let panel = panel(paper, column, corner, high, [low, top], unit, ["", &title]);
    if let Some(until_s) = magnified {
        let [from, to] = [0.0, until_s].map(|t| panel.at(t, 0.0)[0]);
        paper.rect([from, corner[1]], [(to - from).max(0.8), high], Ink::fill(SAND));
    }
    panel.chart.level(paper, 0.0, Ink::line(GRAY, 0.6));
    for end in [1, 0] {
        panel.curve(paper, drop.rows.iter().map(|row| (row.time_s, row.height_m[end])), Ink::line(ENDS[end], 1.2));
    }
    for strike in shown(drop.strikes, &panel) {
        paper.circle(panel.at(strike.time_s, 0.0), 1.9, Ink::fill(ENDS[strike.point]));
    }
    panel.chart.border(paper);
}

/// Returns the strikes of a column; of those that would overlap only the hardest.
fn shown<'a>(strikes: &'a [Strike], panel: &Panel<'_>) -> Vec<&'a Strike> {
    let until = panel.chart.x.high * (1.0 + 1e-9);
    let seen = strikes.iter().take_while(|strike| strike.time_s * panel.time <= until);
    let mut kept: [Option<&Strike>; 2] = [None; 2];
    let mut all: Vec<&Strike> = Vec::new();
    for strike in seen {
        let k = strike.point;
        match kept[k] {
            Some(old) if panel.at(strike.time_s, 0.0)[0] - panel.at(old.time_s, 0.0)[0] < 0.5 => {
                if strike.approach_m_s < old.approach_m_s {
                    kept[k] = Some(strike);
                }
            }
            old => {
                all.extend(old);
                kept[k] = Some(strike);
            }
        }
    }
    all.extend(kept.into_iter().flatten());
    all.sort_by_key(|strike| strike.number);
    all
}

fn time_title(column: Column) -> String {
    format!("time since the first touch, {}s", Unit::of(column.until_s).prefix)
}

fn shocks(paper: &mut Paper, drop: &Drop<'_>, column: Column, corner: [f64; 2], high: f64, last: bool) {
    let bounds = range(drop.strikes.iter().flat_map(|strike| strike.delta_v_m_s));
    let unit = Unit::of(bounds[1]);
    let title = format!("velocity shock, {}m/s", unit.prefix);
    let time = if last { time_title(column) } else { String::new() };
    let panel = panel(paper, column, corner, high, bounds, unit, [&time, &title]);
    panel.chart.level(paper, 0.0, Ink::line(GRAY, 0.6));
    let strikes = shown(drop.strikes, &panel);
    let mut last: Option<(usize, f64)> = None;
    for strike in strikes {
        let [mut x, ground] = panel.at(strike.time_s, 0.0);
        // The other end's strike at this very time is moved aside to remain visible.
        if last.is_some_and(|(end, at)| end != strike.point && (x - at).abs() < 0.5) {
            x += 1.8;
        }
        last = Some((strike.point, x));
        let tips = strike.delta_v_m_s.map(|v| panel.at(0.0, v)[1]);
        if tips.iter().all(|y| (y - ground).abs() < 2.0) {
            continue; // nothing to be seen; the strike is marked above
        }
        for (y, color) in tips.into_iter().zip(ENDS) {
            paper.line([x, ground], [x, y], Ink::line(color, 1.0));
            paper.circle([x, y], 1.9, Ink::fill(color));
        }
        for (k, s) in drop.at.iter().enumerate() {
            paper.circle([x, panel.at(0.0, strike.delta_v_at(*s))[1]], 2.2, position_mark(k));
        }
    }
    panel.chart.border(paper);
}

fn pulses(paper: &mut Paper, drop: &Drop<'_>, column: Column, corner: [f64; 2], high: f64) {
    let rows = || drop.rows.iter().filter_map(|row| row.forces.as_ref().map(|forces| (row.time_s, forces)));
    let positions = |forces: &Forces| drop.at.iter().map(|s| forces.acceleration_at(*s)).collect::<Vec<_>>();
    let bounds = range(rows().flat_map(|(_, forces)| forces.force_per_mass_m_s2.into_iter().chain(positions(forces))));
    let time = time_title(column);
    let unit = Unit { factor: 1.0 / STANDARD_GRAVITY_M_S2, prefix: "" };
    let panel = panel(paper, column, corner, high, bounds, unit, [&time, "acceleration, gn"]);
    panel.chart.level(paper, 0.0, Ink::line(GRAY, 0.6));
    for end in [1, 0] {
        panel.curve(paper, rows().map(|(t, forces)| (t, forces.force_per_mass_m_s2[end])), Ink::line(ENDS[end], 1.8));
    }
    for (k, s) in drop.at.iter().enumerate() {
        panel.curve(paper, rows().map(|(t, forces)| (t, forces.acceleration_at(*s))), position_line(k));
    }
    panel.chart.border(paper);
}

#[cfg(test)]
mod tests {
    use super::*;
    use clatter_flight::{Model, Profile, Scene};

    /// Of points that are too close to tell apart, the first, the last and both extremes are drawn, in order.
    #[test]
    fn a_curve_keeps_its_highs_and_lows() {
        let points: Vec<(f64, f64)> = (0..100).map(|i| (0.01 * f64::from(i), f64::from(i * 37 % 100))).collect();
        // 37 i is 0 and 99 of a hundred at i = 0 and 27, and 63 at the last.
        assert_eq!(thinned(&points, 1.0), [points[0], points[27], points[99]]);
        let turned: Vec<(f64, f64)> = points.iter().map(|(t, y)| (*t, 50.0 - (y - 20.0).abs())).collect();
        // The least is where y is 99, the largest where it is 20.
        assert_eq!(thinned(&turned, 1.0), [turned[0], turned[27], turned[60], turned[99]]);
    }

    #[test]
    fn the_hardest_strike_is_magnified_with_those_before_it() {
        let scene = Scene::new(Profile::new(0.14, 0.04).unwrap(), 0.3, 4.43, 5.0, 9.81).unwrap();
        let flight = scene.fly(Model::FiniteTilt).unwrap();
        let rows: Vec<_> = flight.rows().collect();
        let until = |strikes: &[Strike]| {
            let drop = Drop { model: "", rows: &rows, strikes, pulses: &[], stop: flight.stop, at: &[], called: &[] };
            early(&drop, flight.stop.time_s())
        };
        let first = until(&flight.strikes).expect("a long pause");
        let after = flight.strikes.iter().position(|strike| strike.time_s > first).expect("strikes after it");
        let mut strikes = flight.strikes.clone();
        strikes[after].delta_v_m_s = [100.0, 0.0];
        assert!(until(&strikes).is_none_or(|until| until > strikes[after].time_s));
    }
}
