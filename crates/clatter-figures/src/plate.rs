//! A plate from above: the places of its parts, the landing of its worst drop, and the demand on a part anywhere on it.

use clatter_assess::{PlaceMap, Verdict};
use clatter_flight::Plate;

use crate::FigureError;
use crate::axis::{Axis, round_values, three, tick};
use crate::grid::cells;
use crate::heat::{color, palette, png};
use crate::paper::{Paper, SMALL};
use crate::product::{fit, shade};
use crate::style::{Anchor, BLUES, GRAY, INK, Ink, LABEL, Label, Pt, RUST};

/// A part on the plan.
#[derive(Debug, Clone)]
pub struct Area<'a> {
    /// Number of the part on the pages.
    pub number: usize,
    /// Name of the part.
    pub name: &'a str,
    /// Range of its place along the plate and across it, from and to, in m from the middle.
    pub reach_m: [[f64; 2]; 2],
    /// Verdict, which decides the color.
    pub verdict: Verdict,
    /// Text beside the name, such as the margin.
    pub word: &'a str,
}

/// The plan of a plate on the page: the length to the right, the width upward.
struct View<'a> {
    plate: &'a Plate,
    sides_m: [f64; 2],
    corner: Pt,
    scale: f64,
}

impl<'a> View<'a> {
    /// Creates the view in the middle of a room, as large as possible.
    fn within(plate: &'a Plate, sides_m: [f64; 2], [left, top]: Pt, [wide, high]: Pt) -> Self {
        let [length, width] = sides_m;
        let scale = (wide / length).min(high / width);
        Self {
            plate,
            sides_m,
            corner: [left + 0.5 * (wide - scale * length), top + 0.5 * (high - scale * width)],
            scale,
        }
    }
    /// Returns the page coordinates of a place in m from the middle, clamped to the plate.
    fn at(&self, place: [f64; 2]) -> Pt {
        let half = self.sides_m.map(|side| 0.5 * side);
        let [x, y] = [0, 1].map(|k| place[k].clamp(-half[k], half[k]));
        [self.corner[0] + self.scale * (x + half[0]), self.corner[1] + self.scale * (half[1] - y)]
    }
    /// Returns the page coordinates of a place in m from the center of mass.
    fn about_center(&self, [x, y]: [f64; 2]) -> Pt {
        let [cx, cy] = self.center();
        self.at([x + cx, y + cy])
    }
    fn center(&self) -> [f64; 2] {
        let [left, right, front, back] = self.plate.edges_m();
        [0.5 * (left - right), 0.5 * (front - back)]
    }
    fn size(&self) -> Pt {
        self.sides_m.map(|side| self.scale * side)
    }
    /// Returns the page coordinates of corners a, b, c and d.
    fn corners(&self) -> [Pt; 4] {
        let [x, y] = self.sides_m.map(|side| 0.5 * side);
        [[-x, -y], [x, -y], [x, y], [-x, y]].map(|corner| self.at(corner))
    }
    /// Draws the plate, and its feet where it has some.
    fn outline(&self, paper: &mut Paper, fill: &str) {
        paper.rect(self.corner, self.size(), Ink { stroke: INK, width: 0.8, ..Ink::fill(fill) });
        let apart = self.plate.sides_m();
        if (0..2).any(|side| self.sides_m[side] > apart[side] * (1.0 + 1e-9)) {
            for [x, y] in self.plate.corners_m().map(|corner| self.about_center(corner)) {
                paper.rect([x - 1.8, y - 1.8], [3.6, 3.6], Ink::fill(INK));
            }
        }
    }
    /// Writes the letters of the corners, beside the ends.
    fn letters(&self, paper: &mut Paper) {
        let high = self.size()[1];
        // The letters of a narrow plate are moved apart.
        let apart = (0.5 * (13.5 - high)).max(0.0);
        for (k, [x, y]) in self.corners().into_iter().enumerate() {
            let (right, upper) = (k == 1 || k == 2, k >= 2);
            let label = Label { anchor: if right { Anchor::Start } else { Anchor::End }, ..LABEL };
            let y = if upper { y + 5.5 - apart } else { y + apart };
            paper.text([if right { x + 4.0 } else { x - 4.0 }, y], ["*a*", "*b*", "*c*", "*d*"][k], label);
        }
    }
    /// Draws a rectangle on the plate, or a mark where it is smaller than one.
    fn area(&self, paper: &mut Paper, [[left, right], [front, back]]: [[f64; 2]; 2], ink: Ink<'_>) {
        let ([x, foot], [end, y]) = (self.at([left, front]), self.at([right, back]));
        if end - x < 3.0 && foot - y < 3.0 {
            let middle = [0.5 * (x + end), 0.5 * (y + foot)];
            paper.circle(middle, 2.2, Ink { fill: ink.stroke, ..ink });
        } else {
            paper.rect([x, y], [end - x, foot - y], ink);
        }
    }
}

/// Returns the ground color of a verdict.
fn ground(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Safe => "#e9f0f7",
        Verdict::Reliable => "#f2f6fa",
        Verdict::Undecided => "#f7f2da",
        Verdict::Unsafe => "#f8ebe4",
    }
}

/// Room of the plan, and of a row of the list beside it.
const ROOM: Pt = [260.0, 140.0];
const ROW: f64 = 10.5;

/// Draws the plate, from edge to edge, with its center of mass, the lines of percussion of the corners or feet that it
/// lands on, and its parts, which are listed at the right.
pub fn plan(plate: &Plate, sides_m: [f64; 2], parts: &[Area<'_>]) -> Result<String, FigureError> {
    let [length, width] = sides_m;
    let (left, top) = (24.0, 10.0);
    let high = (ROOM[0] / length).min(ROOM[1] / width) * width;
    let rows = f64::from(u32::try_from(parts.len()).unwrap_or(u32::MAX));
    // A narrow plate leaves room for the numbers of its parts.
    let tall = high.max(ROW * rows).max(40.0);
    let mut paper = Paper::new(464.0, top + tall + 24.0);
    let view = View::within(plate, sides_m, [left, top], [ROOM[0], tall]);
    view.outline(&mut paper, "#ffffff");
    let size = |part: &Area<'_>| part.reach_m.iter().map(|[from, to]| to - from).product::<f64>();
    let mut by_size: Vec<&Area<'_>> = parts.iter().collect();
    by_size.sort_by(|a, b| size(b).total_cmp(&size(a)));
    let is_all = |part: &Area<'_>| size(part) > 0.8 * length * width;
    let (rectangles, marks): (Vec<_>, Vec<_>) = by_size.into_iter().partition(|part| size(part) > 0.0);
    for part in rectangles {
        let color = shade(part.verdict);
        let fill = if is_all(part) { "none" } else { ground(part.verdict) };
        view.area(&mut paper, part.reach_m, Ink { stroke: color, width: 1.1, ..Ink::fill(fill) });
    }
    for ends in (0..4).filter_map(|corner| plate.percussion(corner)) {
        let [from, to] = ends.map(|end| view.about_center(end));
        paper.line(from, to, Ink { dash: "1.5 2", ..Ink::line(GRAY, 0.7) });
    }
    let [x, y] = view.about_center([0.0; 2]);
    paper.circle([x, y], 3.4, Ink { stroke: INK, width: 0.8, ..Ink::fill("#ffffff") });
    for part in marks {
        view.area(&mut paper, part.reach_m, Ink::line(shade(part.verdict), 1.1));
    }
    numbers(&mut paper, &view, parts);
    view.letters(&mut paper);
    let mut y = top + 0.5 * (tall - ROW * rows) + 8.0;
    for part in parts {
        let label = Label { anchor: Anchor::Start, color: shade(part.verdict), ..SMALL };
        paper.text([left + ROOM[0] + 30.0, y], &part.number.to_string(), Label { anchor: Anchor::End, ..label });
        paper.text([left + ROOM[0] + 35.0, y], &fit(part.name, 88.0), label);
        paper.text([462.0, y], part.word, Label { anchor: Anchor::End, ..label });
        y += ROW;
    }
    scale(&mut paper, &view, top + tall + 7.0);
    paper.finish("The plate from above, its parts, its center of mass and its lines of percussion")
}

/// Writes the numbers of parts, none over another or over a mark: in the upper left of their rectangle, above a mark,
/// else further along.
fn numbers(paper: &mut Paper, view: &View<'_>, parts: &[Area<'_>]) {
    let at = |part: &Area<'_>| {
        let [[from, to], [front, back]] = part.reach_m;
        let ([x, foot], [end, y]) = (view.at([from, front]), view.at([to, back]));
        let is_mark = end - x < 12.0 || foot - y < 9.0;
        (is_mark, if is_mark { [0.5 * (x + end), y] } else { [x + 6.0, y + 5.5] })
    };
    let mut taken: Vec<Pt> = parts.iter().map(at).filter(|(is_mark, _)| *is_mark).map(|(_, at)| at).collect();
    taken.push(view.about_center([0.0; 2]));
    for part in parts {
        let (is_mark, [x, y]) = at(part);
        let from = if is_mark { [x, y - 8.5] } else { [x, y] };
        let is_free = |[x, y]: &Pt| taken.iter().all(|t| (t[0] - x).abs() > 9.0 || (t[1] - y).abs() > 8.0);
        let mut places = (0..60).map(|k| [from[0] + 10.0 * f64::from(k % 12), from[1] + 8.5 * f64::from(k / 12)]);
        let [x, y] = places.find(is_free).unwrap_or(from);
        taken.push([x, y]);
        paper.text([x, y + 2.7], &part.number.to_string(), Label { color: shade(part.verdict), ..SMALL });
    }
}

/// Draws the length in mm below a plan.
fn scale(paper: &mut Paper, view: &View<'_>, y: f64) {
    let length = view.plate.sides_m()[0];
    let ([left, wide], at) = ([view.corner[0], view.size()[0]], |mm: f64| view.at([1e-3 * mm, 0.0])[0]);
    paper.line([left, y], [left + wide, y], Ink::line(INK, 0.6));
    for mm in round_values(-500.0 * length, 500.0 * length) {
        paper.line([at(mm), y], [at(mm), y + 3.0], Ink::line(INK, 0.6));
        paper.text([at(mm), y + 11.5], &tick(mm), SMALL);
    }
    paper.text([left + wide + 13.0, y + 11.5], "mm", Label { anchor: Anchor::Start, ..SMALL });
}

/// A strike of a corner.
#[derive(Debug, Clone, Copy)]
pub struct Strike {
    /// Index of the corner, 0 to 3 for a to d.
    pub corner: usize,
    /// Time of the strike, in ms.
    pub time_ms: f64,
    /// Velocity change of the corner, in m/s.
    pub shock_m_s: f64,
}

/// The landing of a plate.
#[derive(Debug, Clone, Copy)]
pub struct Landing<'a> {
    /// The plate of the corners or feet that it lands on, seen from above.
    pub plate: &'a Plate,
    /// Sides from edge to edge.
    pub sides_m: [f64; 2],
    /// The strikes to list, in order of time.
    pub strikes: &'a [Strike],
    /// Direction that it rises to, in degrees.
    pub direction_deg: f64,
    /// Range of the part, in m from the middle.
    pub reach_m: [[f64; 2]; 2],
    /// The place of the largest demand in it.
    pub place_m: [f64; 2],
    /// Number of the strike before the peak, from 1.
    pub impact: usize,
}

/// Room of the pictures of a part, below one another as wide as its curves.
const PAGE: Pt = [226.0, 122.0];
/// The most strikes listed at a corner, and the distance from line to line.
const SHOWN: usize = 3;
const LINE: f64 = 9.5;

/// Draws the plate as it lands: at each corner its strikes by number, time and change of velocity.
pub fn landing(of: &Landing<'_>) -> Result<String, FigureError> {
    let mut paper = Paper::new(PAGE[0], PAGE[1]);
    let view = View::within(of.plate, of.sides_m, [14.0, 36.0], [PAGE[0] - 28.0, PAGE[1] - 72.0]);
    view.outline(&mut paper, BLUES[1]);
    view.area(&mut paper, of.reach_m, Ink { stroke: GRAY, width: 0.8, dash: "2.5 1.5", ..Ink::fill("none") });
    arrow(&mut paper, &view, of.direction_deg);
    let [x, y] = view.at(of.place_m);
    paper.circle([x, y], 2.2, Ink { stroke: INK, width: 0.7, ..Ink::fill("#ffffff") });
    view.letters(&mut paper);
    let [head, foot] = [view.corner[1] - 8.0, view.corner[1] + view.size()[1] + 14.0];
    for corner in 0..4 {
        let (right, upper) = (corner == 1 || corner == 2, corner >= 2);
        let own: Vec<usize> = (0..of.strikes.len()).filter(|i| of.strikes[*i].corner == corner).collect();
        let (x, anchor) = if right { (PAGE[0] - 2.0, Anchor::End) } else { (2.0, Anchor::Start) };
        let rows = own.len().min(SHOWN);
        for (k, &i) in own.iter().take(SHOWN).enumerate() {
            let more = if k + 1 == SHOWN && own.len() > SHOWN { " …" } else { "" };
            let (line, color) = (words(i + 1, &of.strikes[i]) + more, if i + 1 == of.impact { RUST } else { INK });
            let y = if upper { head - LINE * count(rows - 1 - k) } else { foot + LINE * count(k) };
            paper.text([x, y], &line, Label { anchor, color, ..SMALL });
        }
    }
    paper.describe(&format!("corners in the order of their strikes: {}", order(of.strikes)));
    paper.finish(
        "The plate as it lands in its worst drop, from above, its corners numbered in the order of their strikes",
    )
}

fn count(lines: usize) -> f64 {
    f64::from(u8::try_from(lines).unwrap_or(u8::MAX))
}

fn words(number: usize, strike: &Strike) -> String {
    // Times are rounded to a hundredth of a microsecond: a strike at the same time is later by a rounding.
    let time_ms = (1e5 * strike.time_ms).round() / 1e5;
    format!("{number}: {} ms, {} m/s", three(time_ms), three(strike.shock_m_s))
}

fn order(strikes: &[Strike]) -> String {
    strikes.iter().map(|strike| ["a", "b", "c", "d"][strike.corner % 4]).collect::<Vec<_>>().join(" ")
}

/// Draws the direction that the plate rises to, through its middle as far as its outline allows.
fn arrow(paper: &mut Paper, view: &View<'_>, direction_deg: f64) {
    let (sin, cos) = direction_deg.to_radians().sin_cos();
    let [wide, high] = view.size();
    let reach = (0.42 * wide / cos.abs().max(1e-9)).min(0.42 * high / sin.abs().max(1e-9));
    let [x, y] = view.at([0.0; 2]);
    // An arrow too short for a head is left out.
    if reach > 6.0 {
        paper.arrow([x - reach * cos, y + reach * sin], [x + reach * cos, y - reach * sin], BLUES[6], 1.0);
    }
}

/// The demand on a part anywhere on a plate.
#[derive(Debug, Clone, Copy)]
pub struct HeatMap<'a> {
    /// The plate of the corners or feet that it lands on, seen from above.
    pub plate: &'a Plate,
    /// Sides from edge to edge.
    pub sides_m: [f64; 2],
    /// Demand over the limit, over the plate.
    pub map: &'a PlaceMap,
    /// Maps of the other limits, four at most, whose borders are dotted, dash-dotted, in thin and in long dashes.
    pub others: &'a [&'a PlaceMap],
    /// The limit, in the unit of the title.
    pub allowed: f64,
    /// Quantity of the colors.
    pub title: &'a str,
    /// Range of the part, in m from the middle.
    pub reach_m: [[f64; 2]; 2],
    /// The place of the largest demand in it.
    pub place_m: [f64; 2],
}

/// Columns of pixels.
const PIXELS: u16 = 160;

/// Draws a map over the plate in colors, with the border where the limit is reached.
pub fn heat_map(of: &HeatMap<'_>) -> Result<String, FigureError> {
    let mut paper = Paper::new(PAGE[0], PAGE[1]);
    let view = View::within(of.plate, of.sides_m, [14.0, 10.0], [138.0, PAGE[1] - 40.0]);
    let most = of.map.shares.iter().copied().filter(|v| v.is_finite()).fold(0.0, f64::max);
    let least = of.map.shares.iter().copied().filter(|v| v.is_finite()).fold(most, f64::min);
    // Equal values would have no axis.
    let axis = Axis::linear(of.allowed * least.min(0.98 * most), of.allowed * most.max(f64::MIN_POSITIVE), of.title);
    let palette = palette();
    let [wide, high] = view.size();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few hundred")]
    let rows = (f64::from(PIXELS) * high / wide).ceil().clamp(4.0, 400.0) as u16;
    let sides = of.sides_m;
    let mut pixels = Vec::with_capacity(3 * usize::from(PIXELS) * usize::from(rows));
    for j in 0..rows {
        for i in 0..PIXELS {
            let x = sides[0] * ((f64::from(i) + 0.5) / f64::from(PIXELS) - 0.5);
            let y = sides[1] * (0.5 - (f64::from(j) + 0.5) / f64::from(rows));
            pixels.extend(color(&palette, axis.unit(of.allowed * between(of.map, [x, y]))));
        }
    }
    let [x, y] = view.corner;
    paper.image([x, y], [x + wide, y + high], &png(PIXELS.into(), rows.into(), &pixels));
    for level in axis.ticks().0 {
        border(&mut paper, &view, of.map, level / of.allowed, Ink::line(INK, 0.3));
    }
    for (map, dash) in of.others.iter().zip(["1.2 1.6", "4 1.5 1 1.5", "2.5 1.5", "6 2"]) {
        border(&mut paper, &view, map, 1.0, Ink { dash, ..Ink::line(RUST, 1.2) });
    }
    border(&mut paper, &view, of.map, 1.0, Ink::line(RUST, 1.5));
    view.area(&mut paper, of.reach_m, Ink { stroke: INK, width: 0.8, dash: "2.5 1.5", ..Ink::fill("none") });
    let at = view.at(of.place_m);
    paper.circle(at, 2.2, Ink { stroke: INK, width: 0.7, ..Ink::fill("#ffffff") });
    view.outline(&mut paper, "none");
    view.letters(&mut paper);
    bar(&mut paper, of, &axis);
    scale(&mut paper, &view, PAGE[1] - 23.0);
    paper.finish("What the part would be asked anywhere on the plate, from above")
}

/// Draws the line where a share of a map has this value.
fn border(paper: &mut Paper, view: &View<'_>, map: &PlaceMap, level: f64, ink: Ink<'_>) {
    let place = |i: usize, j: usize| (map.along_m[j], map.across_m[i]);
    let above = |i: usize, j: usize| Some(map.share(j, i) - level).filter(|v| v.is_finite());
    for line in cells([map.across_m.len(), map.along_m.len()], place, above).lines {
        let line: Vec<Pt> = line.into_iter().map(|(x, y)| view.at([x, y])).collect();
        paper.path(&line, false, ink);
    }
}

/// Draws the colors with their values, the limit among them.
fn bar(paper: &mut Paper, of: &HeatMap<'_>, axis: &Axis<'_>) {
    let ([left, top], high, palette) = ([184.0, 10.0], PAGE[1] - 40.0, palette());
    let strip: Vec<u8> = (0..=255u8).rev().flat_map(|i| color(&palette, f64::from(i) / 255.0)).collect();
    paper.image([left, top], [left + 7.0, top + high], &png(1, 256, &strip));
    paper.rect([left, top], [7.0, high], Ink::line(INK, 0.5));
    let at = |value: f64| top + high * (1.0 - axis.unit(value));
    for value in axis.ticks().0 {
        paper.line([left + 7.0, at(value)], [left + 9.5, at(value)], Ink::line(INK, 0.5));
        paper.text([left + 11.0, at(value) + 2.6], &tick(value), Label { anchor: Anchor::Start, ..SMALL });
    }
    if (0.0..=1.0).contains(&axis.unit(of.allowed)) {
        paper.line([left - 2.0, at(of.allowed)], [left + 9.0, at(of.allowed)], Ink::line(RUST, 1.5));
    }
    let (middle, what) = (top + 0.5 * high, format!("{} from {} to {}", of.title, three(axis.low), three(axis.high)));
    paper.text([left - 6.0, middle], of.title, Label { turn: -90.0, ..SMALL });
    paper.describe(&what);
}

/// Returns a share between the places of a map, along straight lines.
fn between(map: &PlaceMap, [x, y]: [f64; 2]) -> f64 {
    let cell = |lines: &[f64], at: f64| {
        let next = lines.partition_point(|line| *line <= at).clamp(1, lines.len().max(2) - 1);
        let (from, to) = (lines[next - 1], lines[next]);
        (next, ((at - from) / (to - from)).clamp(0.0, 1.0))
    };
    let ((column, across), (row, up)) = (cell(&map.along_m, x), cell(&map.across_m, y));
    let line = |row: usize| {
        let (from, to) = (map.share(column - 1, row), map.share(column, row));
        from + across * (to - from)
    };
    let (from, to) = (line(row - 1), line(row));
    from + up * (to - from)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a uniform plate of 100 by 50 mm.
    fn plate() -> Plate {
        Plate::new([0.05, 0.05, 0.025, 0.025], [0.1, 0.05].map(|side: f64| side / 12_f64.sqrt())).unwrap()
    }

    fn part(number: usize, reach_m: [[f64; 2]; 2]) -> Area<'static> {
        Area { number, name: "part", reach_m, verdict: Verdict::Unsafe, word: "−3 %" }
    }

    /// Returns the place of a text that is exactly this.
    fn stands(drawn: &str, words: &str) -> Pt {
        let line = drawn
            .lines()
            .find(|line| line.contains(&format!(">{words}<")))
            .unwrap_or_else(|| panic!("{words}: {drawn}"));
        let of =
            |name: &str| line.split(&format!(" {name}=\"")).nth(1).unwrap().split('"').next().unwrap().parse().unwrap();
        [of("x"), of("y")]
    }

    /// 2.6 pt a millimeter from (24, 10): a part from the middle beyond end b is cut there. The line of percussion of corner a of a
    /// uniform plate goes from a third of the way down its end to a third along its far edge.
    #[test]
    fn parts_and_lines_of_percussion_are_drawn_to_scale() {
        let drawn = plan(&plate(), plate().sides_m(), &[part(1, [[0.0, 0.08], [-0.01, 0.02]])]).unwrap();
        assert!(drawn.contains("M24 10L284 10L284 140L24 140Z"), "{drawn}");
        assert!(drawn.contains("M154 23L284 23L284 101L154 101Z"), "{drawn}");
        assert!(drawn.contains("M284 118.33L67.33 10\""), "{drawn}");
        assert!(drawn.contains("−3 %"), "{drawn}");
    }

    /// The scale runs along the length, as far as the plate goes: 20 mm are 52 pt, from the middle at 154 pt.
    #[test]
    fn the_scale_goes_along_the_whole_plate() {
        let drawn = plan(&plate(), plate().sides_m(), &[part(1, [[0.0, 0.01]; 2])]).unwrap();
        for (mm, words) in [(-40.0, "−40"), (-20.0, "−20"), (20.0, "20"), (40.0, "40")] {
            let [x, _] = stands(&drawn, &format!("<tspan>{words}</tspan>"));
            assert!((x - (154.0 + 2.6 * mm)).abs() < 0.1, "{words} at {x}");
        }
    }

    #[test]
    fn numbers_of_parts_at_one_place_stand_apart() {
        for reach in [[[0.01; 2], [0.01; 2]], [[-0.05, 0.05], [-0.025, 0.025]]] {
            let parts: Vec<_> = (1..=12).map(|number| part(number, reach)).collect();
            let drawn = plan(&plate(), plate().sides_m(), &parts).unwrap();
            let at: Vec<Pt> = (1..=12).map(|number| stands(&drawn, &format!("<tspan>{number}</tspan>"))).collect();
            for (i, a) in at.iter().enumerate() {
                let apart = |b: &Pt| (a[0] - b[0]).abs() > 9.0 || (a[1] - b[1]).abs() > 8.0;
                assert!(at[..i].iter().all(apart), "{at:?}");
            }
        }
    }

    #[test]
    fn corners_tell_their_strikes_and_the_one_of_the_peak() {
        let strike = |corner, time_ms| Strike { corner, time_ms, shock_m_s: 2.0 };
        let strikes =
            [strike(3, 0.0), strike(0, 1e-17), strike(2, 1.5), strike(3, 2.0), strike(3, 3.0), strike(3, 4.0)];
        let (plate, reach_m, place_m) = (plate(), [[0.0, 0.01]; 2], [0.01; 2]);
        let sides_m = plate.sides_m();
        let of =
            Landing { plate: &plate, sides_m, strikes: &strikes, direction_deg: 280.0, reach_m, place_m, impact: 3 };
        let drawn = landing(&of).unwrap();
        let at = |words: &str| stands(&drawn, &format!("<tspan>{words}</tspan>"));
        let (d, a, c) = (at("1: 0 ms, 2 m/s"), at("2: 0 ms, 2 m/s"), at("3: 1.5 ms, 2 m/s"));
        assert!(d[0] < c[0] && a[1] > d[1] && at("5: 3 ms, 2 m/s …")[1] > d[1], "{drawn}");
        assert!(!drawn.contains("6: "), "a corner tells three strikes: {drawn}");
        let peak = drawn.lines().filter(|line| line.contains("<text") && line.contains(RUST)).collect::<Vec<_>>();
        assert!(peak.len() == 1 && peak[0].contains("3: 1.5 ms"), "{peak:?}");
        assert!(drawn.contains("in the order of their strikes: d a c d d d"), "{drawn}");
    }

    /// Shares that grow evenly from 0.5 at end a to 1.5 at end b: the border is the middle line, whatever the columns.
    #[test]
    fn the_border_stands_where_the_share_is_one() {
        let plate = plate();
        let drawn = |scale: f64| {
            let (along_m, across_m) = (vec![-0.05, -0.02, 0.03, 0.05], vec![-0.025, 0.0, 0.025]);
            let line: Vec<f64> = along_m.iter().map(|x| scale * (1.0 + 10.0 * x)).collect();
            let map = PlaceMap { shares: [&line[..]; 3].concat(), along_m, across_m, drops: 1 };
            let (reach_m, place_m) = ([[0.0, 0.01]; 2], [0.01; 2]);
            // This is the map of another limit, on the other side.
            let other =
                PlaceMap { shares: map.shares.iter().map(|share| share - 0.3 * scale).collect(), ..map.clone() };
            heat_map(&HeatMap {
                plate: &plate,
                sides_m: plate.sides_m(),
                others: &[&other],
                map: &map,
                allowed: 300.0,
                title: "gn",
                reach_m,
                place_m,
            })
            .unwrap()
        };
        let border = |drawn: &str| {
            let lines = drawn.lines().filter(|line| line.contains(RUST) && line.contains("<path"));
            lines.map(str::to_owned).collect::<Vec<_>>()
        };
        let found = border(&drawn(1.0));
        // The plan is 138 pt wide from x = 14; the last line is the mark on the bar. The other limit is exceeded from 30 mm on.
        let along = |line: &String, x: &str| line.matches(x).count() == 2;
        assert!(found.len() == 5 && found[2..4].iter().all(|line| along(line, "83 ")), "{found:?}");
        let dotted = |line: &String| along(line, "124.4 ") && line.contains("dasharray");
        assert!(found[..2].iter().all(dotted), "{found:?}");
        assert_eq!(border(&drawn(0.5)), Vec::<String>::new(), "no border where all holds");
        assert!(!drawn(0.0).contains("NaN"));
    }

    #[test]
    fn between_places_a_map_is_linear() {
        let map = PlaceMap {
            along_m: vec![-1.0, 0.0, 3.0],
            across_m: vec![-1.0, 1.0],
            shares: vec![0.0, 1.0, 4.0, 2.0, 3.0, 6.0],
            drops: 1,
        };
        for place in [[-1.0, -1.0], [3.0, 1.0], [1.0, 0.5], [-0.5, -0.25]] {
            assert!((between(&map, place) - (1.0 + place[0] + 1.0 + place[1])).abs() < 1e-15, "{place:?}");
        }
    }
}
