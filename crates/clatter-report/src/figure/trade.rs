//! Error over cost: what every pair of models gets wrong in one scene and how long it takes, with the front and the
//! plan's choices.

use clatter_scene::plan::{BarRung, ComponentRung, Quantity};
use clatter_scene::tradeoff::{Kept, Measured, TOLERANCES, Tradeoff};

use super::axes::{Axes, Axis, SMALL, note, step_up};
use super::product::fit;
use crate::svg::{Anchor, BLUES, GRAY, INK, Ink, LABEL, Label, Pt, RUST, SAND, Svg, width};

/// Size of the frame, in pt.
const FRAME: Pt = [352.0, 236.0];
/// Height of the strip at its foot for what a logarithm cannot show.
const STRIP: f64 = 26.0;
/// From the top of a panel to its frame, and to the top of the next panel.
const HEAD: f64 = 22.0;
const PANEL: f64 = HEAD + FRAME[1] + 42.0;
const LEFT: f64 = 44.0;
/// Column of the key.
const KEY: f64 = 122.0;
/// Radius of a mark, and of the ring around a choice of the plan.
const MARK: f64 = 3.2;
const RING: f64 = 5.8;
/// Errors below this share, far below any tolerance that is asked for, are no longer told apart; above the other one
/// neither.
const LEAST: f64 = 1e-5;
const MOST: f64 = 1e3;

/// Panels one below the other.
pub(crate) fn panels(trades: &[(String, &Tradeoff)]) -> String {
    let count = f64::from(u32::try_from(trades.len()).unwrap_or(u32::MAX));
    let wide = LEFT + FRAME[0] + 14.0 + KEY;
    let mut svg = Svg::new(wide, (PANEL * count).max(HEAD));
    if trades.is_empty() {
        note(&mut svg, [LEFT, 14.0], "No limit is on what the models of a plan speak of.");
    }
    let mut top = 0.0;
    for (title, trade) in trades {
        svg.plain(
            [LEFT, top + 14.0],
            &fit(title, wide - LEFT - 4.0),
            Label { anchor: Anchor::Start, size: 9.5, ..LABEL },
        );
        panel(&mut svg, top + HEAD, trade);
        top += PANEL;
    }
    svg.finish("Error over cost of every pair of models")
}

/// The error axis: its low end, where the strip begins, its high end, as shares.
fn errors(trade: &Tradeoff) -> [f64; 3] {
    let known = trade.reference.within.max(LEAST);
    let shown = trade.pairs.iter().map(|p| p.error).filter(|e| *e >= known && *e <= MOST);
    let (least, most) = shown.fold((5e-4_f64, 1.0_f64), |(a, b), e| (a.min(e), b.max(e)));
    let strip = 10f64.powf(least.log10().floor());
    let high = step_up(1.3 * most);
    let decades = (high / strip).log10();
    [strip * 10f64.powf(-decades * STRIP / (FRAME[1] - STRIP)), strip, high]
}

fn panel(svg: &mut Svg, top: f64, trade: &Tradeoff) {
    let [low, strip, high] = errors(trade);
    let seconds = || trade.pairs.iter().map(|p| p.seconds).chain([trade.reference.seconds]).map(|s| 1e6 * s);
    let ends = seconds().flat_map(|us| [0.5 * us, 2.0 * us]);
    let axes = Axes {
        corner: [LEFT, top],
        size: FRAME,
        x: Axis::log_over(ends, 12.0, "time of one run, µs"),
        y: Axis::log(100.0 * low, 100.0 * high, "error, per cent"),
    };
    axes.grid(svg);
    // What has no logarithm, or none that means anything.
    let edge = axes.at(axes.x.low, 100.0 * strip)[1];
    let foot = top + FRAME[1];
    svg.rect([LEFT, edge], [FRAME[0], foot - edge], Ink::fill("#ffffff"));
    svg.rect([LEFT, edge], [FRAME[0], foot - edge], Ink::fill(SAND));
    svg.text([LEFT - 5.0, 0.5 * (edge + foot) + 2.6], "≈ 0", Label { anchor: Anchor::End, ..SMALL });
    for tolerance in TOLERANCES {
        axes.level(svg, 100.0 * tolerance, Ink { dash: "2 2.5", ..Ink::line(RUST, 0.5) });
    }
    let place = |seconds: f64, error: f64| {
        let [x, y] = axes.at(1e6 * seconds, 100.0 * error.clamp(strip, high));
        [x, if error < strip { 0.5 * (edge + foot) } else { y }]
    };
    let points: Vec<Pt> = trade.pairs.iter().map(|p| place(p.seconds, p.error)).collect();
    let steps = steps(&trade.pairs, &points, [top, LEFT + FRAME[0]]);
    svg.path(&steps, false, Ink::line(BLUES[6], 1.3));
    let reference = place(trade.reference.seconds, 0.0);
    let mut wanted = vec![Wanted { at: reference, radius: MARK, lines: vec!["reference".to_owned()] }];
    let mut order: Vec<usize> = (0..points.len()).collect();
    // What matters most finds its place first.
    order.sort_by_key(|&i| (trade.pairs[i].chosen_at.is_empty(), !trade.pairs[i].front));
    for &i in &order {
        let pair = &trade.pairs[i];
        let mut lines = vec![format!("{}, {}", bar(pair.bar), component(pair.component))];
        if !pair.chosen_at.is_empty() {
            lines.push(format!("plan at {}", percents(&pair.chosen_at)));
        }
        let radius = if pair.chosen_at.is_empty() { MARK } else { RING };
        wanted.push(Wanted { at: points[i], radius, lines });
    }
    let level = |y: f64| [[LEFT, y], [LEFT + FRAME[0], y]];
    let mut lines: Vec<[Pt; 2]> = steps.windows(2).map(|step| [step[0], step[1]]).collect();
    lines.extend(TOLERANCES.map(|tolerance| level(axes.at(axes.x.low, 100.0 * tolerance)[1])));
    lines.push(level(edge));
    let labels = arrange(&wanted, [[LEFT, top], [LEFT + FRAME[0], foot]], &lines);
    for (label, of) in labels.iter().zip(&wanted) {
        if let Some(from) = label.leader(of) {
            svg.line(from, of.at, Ink::line(GRAY, 0.4));
        }
    }
    mark(svg, reference, ComponentRung::PulseTrain, RUST);
    for (pair, p) in trade.pairs.iter().zip(&points) {
        if !pair.chosen_at.is_empty() {
            svg.circle(*p, RING, Ink { stroke: RUST, width: 1.1, ..Ink::fill("#ffffff") });
        }
    }
    for (pair, p) in trade.pairs.iter().zip(&points) {
        mark(svg, *p, pair.component, fill(pair.bar));
    }
    for (label, of) in labels.iter().zip(&wanted) {
        for (k, line) in of.lines.iter().enumerate() {
            #[expect(clippy::cast_precision_loss, reason = "two lines")]
            let y = label.corner[1] + 6.3 + LINE * k as f64;
            let color = if k == 1 || of.lines[0] == "reference" { RUST } else { INK };
            svg.text([label.corner[0], y], line, Label { anchor: Anchor::Start, size: SIZE, color, ..LABEL });
        }
    }
    axes.border(svg, 32.0);
    beside(svg, [LEFT + FRAME[0] + 14.0, top + 8.0], trade);
}

/// The front: at each cost the least error of what costs no more.
fn steps(pairs: &[Measured], points: &[Pt], [top, right]: [f64; 2]) -> Vec<Pt> {
    let mut front: Vec<Pt> = pairs.iter().zip(points).filter(|(pair, _)| pair.front).map(|(_, p)| *p).collect();
    front.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let Some(first) = front.first() else { return Vec::new() };
    let mut steps = vec![[first[0], top]];
    let mut y = top;
    for p in front {
        steps.extend([[p[0], y], p]);
        y = p[1];
    }
    steps.push([right, y]);
    steps
}

/// What the marks mean, and how many strikes are worth keeping.
fn beside(svg: &mut Svg, [x, mut y]: Pt, trade: &Tradeoff) {
    let say = |svg: &mut Svg, y: &mut f64, text: &str| {
        svg.text([x + 23.0, *y], text, Label { anchor: Anchor::Start, ..SMALL });
        *y += 12.0;
    };
    svg.line([x, y - 2.8], [x + 18.0, y - 2.8], Ink::line(BLUES[6], 1.3));
    say(svg, &mut y, "front");
    svg.circle([x + 9.0, y - 2.8], MARK + 1.6, Ink { stroke: RUST, width: 1.1, ..Ink::fill("#ffffff") });
    say(svg, &mut y, "the plan's choice");
    for rung in BarRung::ALL {
        if trade.pairs.iter().any(|p| p.bar == rung) {
            svg.rect([x + 4.0, y - 6.5], [10.0, 7.0], Ink { stroke: INK, width: 0.5, ..Ink::fill(fill(rung)) });
            say(svg, &mut y, bar(rung));
        }
    }
    for rung in ComponentRung::ALL {
        if trade.pairs.iter().any(|p| p.component == rung) {
            mark(svg, [x + 9.0, y - 2.8], rung, BLUES[4]);
            say(svg, &mut y, component(rung));
        }
    }
    y += 6.0;
    let mut line = |text: &str| {
        note(svg, [x, y], text);
        y += 11.0;
    };
    line("Strikes worth keeping");
    line(&format!("at {}:", percents(&TOLERANCES)));
    for kept in &trade.kept {
        line(&format!("{} {}", bar(kept.bar), counts(kept)));
    }
    if trade.reference.bar != BarRung::Compliant {
        line("The reference is no");
        line("compliant bar here.");
    }
}

/// "2, 4, 7 of 16"
fn counts(kept: &Kept) -> String {
    let each: Vec<String> = kept.least.iter().map(|n| n.map_or("–".to_owned(), |n| n.to_string())).collect();
    format!("{} of {}", each.join(", "), kept.strikes)
}

/// "10 %, 1 %"
fn percents(shares: &[f64]) -> String {
    let each: Vec<String> = shares.iter().map(|share| format!("{}\u{a0}%", 100.0 * share)).collect();
    each.join(", ")
}

fn bar(rung: BarRung) -> &'static str {
    match rung {
        BarRung::ClosedForm => "closed form",
        BarRung::Map => "map",
        BarRung::Ballistic => "ballistic",
        BarRung::FiniteTilt => "finite tilt",
        BarRung::Compliant => "compliant",
    }
}

fn component(rung: ComponentRung) -> &'static str {
    match rung {
        ComponentRung::NetChange => "net change",
        ComponentRung::LargestShock => "largest shock",
        ComponentRung::ImpulseTrain => "impulses",
        ComponentRung::PulseTrain => "pulses",
    }
}

/// What a quantity is called in a title.
pub(crate) fn words(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::PeakAcceleration => "peak acceleration",
        Quantity::RattleSpace => "rattle space",
        Quantity::VelocityShock => "velocity shock",
    }
}

fn fill(rung: BarRung) -> &'static str {
    match rung {
        BarRung::ClosedForm => "#ffffff",
        BarRung::Map => BLUES[2],
        BarRung::Ballistic => BLUES[4],
        BarRung::FiniteTilt => BLUES[6],
        BarRung::Compliant => BLUES[8],
    }
}

/// A mark whose shape says how the component answers.
fn mark(svg: &mut Svg, [x, y]: Pt, rung: ComponentRung, fill: &'static str) {
    let ink = Ink { stroke: INK, width: 0.7, ..Ink::fill(fill) };
    let r = MARK;
    match rung {
        ComponentRung::NetChange => svg.path(&[[x - r, y - 0.8 * r], [x + r, y - 0.8 * r], [x, y + r]], true, ink),
        ComponentRung::LargestShock => svg.rect([x - 0.85 * r, y - 0.85 * r], [1.7 * r, 1.7 * r], ink),
        ComponentRung::ImpulseTrain => svg.circle([x, y], r, ink),
        ComponentRung::PulseTrain => {
            let r = 1.2 * r;
            svg.path(&[[x - r, y], [x, y - r], [x + r, y], [x, y + r]], true, ink);
        }
    }
}

/// Font size and line height of the labels.
const SIZE: f64 = 7.0;
const LINE: f64 = 8.0;

/// A label that has to stand near a point.
#[derive(Debug)]
struct Wanted {
    at: Pt,
    /// Of what is drawn there.
    radius: f64,
    lines: Vec<String>,
}

/// Where it stands.
#[derive(Debug, Clone, Copy)]
struct Placed {
    corner: Pt,
    size: Pt,
}

impl Placed {
    /// How far two boxes reach into one another; negative where they are apart.
    fn overlap(&self, other: &Self) -> f64 {
        let along = |k: usize| {
            let end = (self.corner[k] + self.size[k]).min(other.corner[k] + other.size[k]);
            end - self.corner[k].max(other.corner[k])
        };
        along(0).min(along(1))
    }
    /// The point nearest to `p`, and how far it is.
    fn nearest(&self, p: Pt) -> (Pt, f64) {
        let near: Pt = std::array::from_fn(|k| p[k].clamp(self.corner[k], self.corner[k] + self.size[k]));
        (near, (near[0] - p[0]).hypot(near[1] - p[1]))
    }
    /// Where a line to the mark begins, if that is too far to be seen as its own.
    fn leader(&self, of: &Wanted) -> Option<Pt> {
        let (near, far) = self.nearest(of.at);
        (far > of.radius + 5.0).then_some(near)
    }
    /// Whether a line comes through the box.
    fn is_crossed(&self, [a, b]: [Pt; 2]) -> bool {
        (0..=40).any(|i| {
            let t = f64::from(i) / 40.0;
            (0..2).all(|k| {
                let p = a[k] + t * (b[k] - a[k]);
                (self.corner[k]..=self.corner[k] + self.size[k]).contains(&p)
            })
        })
    }
}

/// Boxes for all labels: apart from one another, from all marks and within the frame, each as near to its point as the
/// ones before it leave, and clear of the lines where that is to be had.
fn arrange(wanted: &[Wanted], [from, to]: [Pt; 2], lines: &[[Pt; 2]]) -> Vec<Placed> {
    let around = |p: Pt, r: f64| Placed { corner: [p[0] - r, p[1] - r], size: [2.0 * r, 2.0 * r] };
    let marks: Vec<Placed> = wanted.iter().map(|w| around(w.at, w.radius + 1.2)).collect();
    let (mut placed, mut leaders) = (Vec::<Placed>::new(), Vec::<[Pt; 2]>::new());
    for w in wanted {
        let wide = w.lines.iter().map(|line| 1.1 * width(line, SIZE)).fold(0.0, f64::max);
        #[expect(clippy::cast_precision_loss, reason = "two lines")]
        let size = [wide, LINE * w.lines.len() as f64];
        let mut best: Option<(f64, Placed)> = None;
        for ring in 0..28 {
            let r = w.radius + 2.5 + 6.0 * f64::from(ring);
            for turn in 0..24 {
                let (sin, cos) = (f64::from(turn) * std::f64::consts::PI / 12.0).sin_cos();
                // The box touches the ring from outside.
                let middle = [w.at[0] + cos * (r + 0.5 * size[0]), w.at[1] - sin * (r + 0.5 * size[1])];
                let label = Placed { corner: [middle[0] - 0.5 * size[0], middle[1] - 0.5 * size[1]], size };
                let inside =
                    (0..2).all(|k| label.corner[k] > from[k] + 1.0 && label.corner[k] + label.size[k] < to[k] - 1.0);
                if !inside || marks.iter().chain(&placed).any(|other| label.overlap(other) > 0.0) {
                    continue;
                }
                let (near, far) = label.nearest(w.at);
                let crossed = lines.iter().filter(|line| label.is_crossed(**line)).count();
                // A leader through what others say misleads.
                let through = marks.iter().chain(&placed).filter(|other| other.is_crossed([near, w.at])).count();
                let through = through.saturating_sub(1) // its own mark
                    + leaders.iter().filter(|leader| label.is_crossed(**leader)).count();
                #[expect(clippy::cast_precision_loss, reason = "a few")]
                let cost = far + 14.0 * crossed as f64 + 30.0 * through as f64 + if cos < -0.5 { 1.0 } else { 0.0 };
                if best.is_none_or(|(least, _)| cost < least) {
                    best = Some((cost, label));
                }
            }
            // Farther rings cost more by themselves.
            if best.is_some_and(|(least, _)| least < r - w.radius) {
                break;
            }
        }
        // A frame without any room left: an empty box, and no words over others.
        let label = best.map_or(Placed { corner: w.at, size: [0.0, 0.0] }, |(_, label)| label);
        leaders.extend(label.leader(w).map(|near| [near, w.at]));
        placed.push(label);
    }
    placed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_of_a_crowd_keep_apart_and_within_the_frame() {
        // Eighteen marks: four heaps of four, two apart.
        let at = |k: u8| {
            let (heap, i) = (f64::from(k / 4), f64::from(k % 4));
            [40.0 + 70.0 * heap + 5.0 * i, 60.0 + 30.0 * heap + 4.0 * (i * 7.0 % 3.0)]
        };
        let wanted: Vec<Wanted> = (0..18)
            .map(|k| Wanted {
                at: at(k),
                radius: MARK,
                lines: vec!["finite tilt, largest shock".to_owned(); usize::from(1 + k % 2)],
            })
            .collect();
        let labels = arrange(&wanted, [[0.0, 0.0], FRAME], &[]);
        for (i, a) in labels.iter().enumerate() {
            assert!(a.size[0] > 50.0, "label {i} has found a place");
            let inside = |k: usize| a.corner[k] > 0.0 && a.corner[k] + a.size[k] < FRAME[k];
            assert!(inside(0) && inside(1), "label {i}: {a:?}");
            for b in &labels[..i] {
                assert!(a.overlap(b) <= 0.0, "{a:?} and {b:?}");
            }
            for (j, w) in wanted.iter().enumerate() {
                let p = Placed { corner: w.at, size: [0.0, 0.0] };
                assert!(a.overlap(&p) <= 0.0, "label {i} on mark {j}");
            }
        }
    }

    #[test]
    fn a_frame_without_room_leaves_words_out() {
        let wanted = [Wanted { at: [5.0, 5.0], radius: MARK, lines: vec!["closed form, net change".to_owned()] }];
        let [label] = arrange(&wanted, [[0.0, 0.0], [10.0, 10.0]], &[])[..] else { panic!("one label") };
        assert!(label.size[0].abs() < f64::EPSILON, "{label:?}");
    }
}
