//! The product drawn to scale from the side, with the safe zone of each part and its place.

use clatter_assess::Verdict;

use crate::FigureError;
use crate::axis::round_values;
use crate::axis::tick;
use crate::paper::{Paper, SMALL};
use crate::style::{Anchor, BLUES, GRAY, INK, Ink, LABEL, Label, OCHRE, RUST, width};

/// One part on the product.
#[derive(Debug, Clone)]
pub struct Place<'a> {
    /// Name of the part.
    pub name: &'a str,
    /// Begin of its range along the bar, from the middle towards end b, in m.
    pub from_m: f64,
    /// End of its range, in m.
    pub to_m: f64,
    /// Verdict, which decides the color.
    pub verdict: Verdict,
    /// Text at the right, such as the margin.
    pub word: &'a str,
    /// Safe zone of the middle of the part, in m; `None` if there is none.
    pub zone_m: Option<[f64; 2]>,
}

/// Returns the color of a verdict, on the page as in the figures.
pub(crate) fn shade(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Safe => BLUES[8],
        Verdict::Reliable => BLUES[6],
        Verdict::Undecided => OCHRE,
        Verdict::Unsafe => RUST,
    }
}

/// Draws the bar with its center of mass and centers of percussion, and a row a part; `beyond_m` is its overhang over
/// the feet that are its ends.
pub fn product(arms_m: [f64; 2], gyration_m: f64, beyond_m: f64, places: &[Place<'_>]) -> Result<String, FigureError> {
    let length = arms_m[0] + arms_m[1] + 2.0 * beyond_m;
    let (left, wide, row) = (92.0, 316.0, 17.0);
    let top = 40.0;
    let bottom = top + 14.0 + row * f64::from(u32::try_from(places.len()).unwrap_or(u32::MAX));
    let mut paper = Paper::new(464.0, bottom + 26.0);
    let at = |m: f64| left + wide * (m / length + 0.5);
    // the bar
    paper.rect([left, top - 9.0], [wide, 9.0], Ink { stroke: INK, width: 0.8, ..Ink::fill(BLUES[2]) });
    if beyond_m > 0.0 {
        for m in [beyond_m - 0.5 * length, 0.5 * length - beyond_m] {
            paper.rect([at(m) - 3.0, top], [6.0, 4.0], Ink { stroke: INK, width: 0.8, ..Ink::fill(INK) });
        }
    }
    for (x, name) in [(left - 9.0, "*a*"), (left + wide + 9.0, "*b*")] {
        paper.text([x, top - 1.5], name, LABEL);
    }
    let center = 0.5 * (arms_m[0] - arms_m[1]);
    let dot = |paper: &mut Paper, m: f64, fill| {
        paper.circle([at(m), top - 4.5], 2.5, Ink { stroke: INK, width: 0.8, ..Ink::fill(fill) });
    };
    let square = gyration_m * gyration_m;
    let mut over = vec![(at(center), "CM")];
    dot(&mut paper, center, INK);
    for (m, name) in [(center + square / arms_m[0], "*R*_a"), (center - square / arms_m[1], "*R*_b")] {
        // A bar whose mass sits at its ends has no place that an impact leaves at rest.
        if m.abs() <= 0.5 * length {
            dot(&mut paper, m, "#ffffff");
            over.push((at(m), name));
        }
    }
    over.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut last = f64::NEG_INFINITY;
    for (x, name) in over {
        let raised = if x - last < 16.0 { 10.0 } else { 0.0 };
        paper.text([x, top - 14.0 - raised], name, LABEL);
        last = if raised > 0.0 { last } else { x };
    }
    // the parts
    let half = 0.5 * length;
    let mut y = top + 14.0;
    for place in places {
        paper.line([left, y + 5.0], [left + wide, y + 5.0], Ink::line(GRAY, 0.4));
        if let Some([lo, hi]) = place.zone_m {
            let (lo, hi) = (lo.max(-half), hi.min(half));
            paper.rect([at(lo), y], [at(hi) - at(lo), 10.0], Ink::fill(BLUES[1]));
            for m in [lo, hi] {
                paper.line([at(m), y], [at(m), y + 10.0], Ink::line(BLUES[5], 0.8));
            }
        }
        let color = shade(place.verdict);
        let (from, to) = (at(place.from_m.max(-half)), at(place.to_m.min(half)));
        let (from, to) = if to - from < 3.0 { (0.5 * (from + to) - 1.5, 0.5 * (from + to) + 1.5) } else { (from, to) };
        paper.rect([from, y + 2.5], [to - from, 5.0], Ink::fill(color));
        paper.text([left - 12.0, y + 8.0], &fit(place.name, left - 14.0), Label { anchor: Anchor::End, ..SMALL });
        let weight = Label { anchor: Anchor::Start, color, ..SMALL };
        paper.text([left + wide + 8.0, y + 8.0], place.word, weight);
        y += row;
    }
    // the scale
    paper.line([left, bottom], [left + wide, bottom], Ink::line(INK, 0.6));
    for mm in round_values(-500.0 * length, 500.0 * length) {
        let x = at(1e-3 * mm);
        paper.line([x, bottom], [x, bottom + 3.0], Ink::line(INK, 0.6));
        paper.text([x, bottom + 11.5], &tick(mm), SMALL);
    }
    paper.text([left + wide + 8.0, bottom + 11.5], "mm", Label { anchor: Anchor::Start, ..SMALL });
    paper.finish("The product from the side, its parts and where each would be safe")
}

/// Returns a name without the marks that figures read as markup, cut to `room` pt.
pub(crate) fn fit(name: &str, room: f64) -> String {
    let plain: String = name.chars().map(|c| if matches!(c, '*' | '_') { ' ' } else { c }).collect();
    if width(&plain, SMALL.size) <= room {
        return plain;
    }
    let mut cut = String::new();
    for c in plain.chars() {
        cut.push(c);
        if width(&cut, SMALL.size) > room - 7.0 {
            break;
        }
    }
    cut + "…"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zones_and_parts_are_drawn_to_scale_and_stay_on_the_bar() {
        let place = Place {
            name: "part",
            from_m: 0.0,
            to_m: 0.05,
            verdict: Verdict::Unsafe,
            word: "−3 %",
            zone_m: Some([-0.2, 0.025]),
        };
        let drawn = product([0.05, 0.05], 0.02, 0.0, std::slice::from_ref(&place)).unwrap();
        // 316 pt for 100 mm from x = 92: the zone is cut at end a and ends three quarters along
        assert!(drawn.contains("M92 54L329 54L329 64L92 64Z"), "{drawn}");
        assert!(drawn.contains("M250 56.5L408 56.5L408 61.5L250 61.5Z"), "{drawn}");
    }

    #[test]
    fn long_names_are_cut_and_marks_are_no_markup() {
        let name = fit(&"*x_".repeat(100_000), 78.0);
        assert!(name.ends_with('…') && width(&name, 8.0) < 90.0 && !name.contains(['*', '_']), "{name}");
        assert_eq!(fit("camera", 78.0), "camera");
    }
}
