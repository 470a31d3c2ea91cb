//! The numbers and the figure of the page on friction.

use clatter_report::File;
use serde_json::{Value, json};

use super::{
    CONTACT_S, E, FRICTIONS, HEIGHT_M, PART_HZ, SIDES_M, TILTS_DEG, Thickness, Tilt, ZETA, range, thicknesses,
};
use crate::Error;
use crate::cube::quantile;
use crate::figures::friction as figure;
use crate::files::{decimals, pretty};

/// Bounds of the ranges of tilt that a row of the table has, in degrees.
const BOUNDS_DEG: [f64; 4] = [TILTS_DEG[0], 10.0, 30.0, TILTS_DEG[1]];

/// Single drops are told from one less this share of them up to this share: the last few hang on the drops that were taken.
const SHARE: f64 = 0.99;

/// Returns `friction.json` and `friction.svg`.
pub(crate) fn files() -> Result<Vec<File>, Error> {
    let thicknesses = thicknesses()?;
    Ok(vec![("friction.json", pretty(&shown(&thicknesses))?), ("friction.svg", figure(&thicknesses)?)])
}

/// Returns every number of the section on friction, as it is printed: the file `friction.json`.
///
/// # Errors
/// None in practice: all drops are valid.
pub fn numbers() -> Result<String, Error> {
    pretty(&shown(&thicknesses()?))
}

fn shown(thicknesses: &[Thickness]) -> Value {
    let rows = thicknesses.iter().flat_map(|thickness| {
        BOUNDS_DEG.windows(2).map(|bounds| {
            let within = thickness.tilts.iter().filter(|tilt| (bounds[0]..=bounds[1]).contains(&tilt.degrees));
            row(thickness.ratio, [bounds[0], bounds[1]], &within.collect::<Vec<_>>())
        })
    });
    json!({
        "sides_mm": SIDES_M.map(|side| decimals(1e3 * side, 0)), "height_m": decimals(HEIGHT_M, 0), "e": decimals(E, 1),
        "contact_ms": decimals(1e3 * CONTACT_S, 1), "part_hz": decimals(PART_HZ, 0), "zeta": decimals(ZETA, 2),
        "frictions": FRICTIONS.map(|friction| decimals(friction, 1)), "tilts_deg": TILTS_DEG.map(|tilt| decimals(tilt, 0)),
        "of_100": decimals(100.0 * (2.0 * SHARE - 1.0), 0), "rows": rows.collect::<Vec<_>>(),
    })
}

/// Returns a row of the table: a thickness within a range of tilts.
fn row(ratio: f64, bounds_deg: [f64; 2], tilts: &[&Tilt]) -> Value {
    let over = |which: usize| {
        range(tilts.iter().flat_map(|tilt| tilt.with.iter().map(move |with| with[which] / tilt.without[which])))
    };
    let one_drop = |which: usize| {
        let values = || tilts.iter().flat_map(|tilt| tilt.one_drop[which].iter().copied());
        [1.0 - SHARE, SHARE].map(|share| quantile(values(), share))
    };
    let [[_, smooth], [_, rough]] = [
        range(tilts.iter().map(|tilt| tilt.without[2] / tilt.without[1])),
        range(tilts.iter().flat_map(|tilt| tilt.with.iter().map(|with| with[2] / tilt.without[1]))),
    ];
    let along_x = over(2).map(|times| decimals(times, 1));
    let x_over_z = [smooth, rough].map(|share| decimals(100.0 * share, 0));
    json!({
        "thickness": decimals(ratio, 1), "tilts_deg": bounds_deg.map(|bound| decimals(bound, 0)),
        "corner": percent(over(0)), "along_z": percent(over(1)), "along_x": along_x,
        "x_over_z": x_over_z,
        "one_drop": { "corner": percent(one_drop(0)), "along_z": percent(one_drop(1)) },
    })
}

/// Returns by how many percent values over others change, with their signs.
fn percent(range: [f64; 2]) -> [String; 2] {
    range.map(|over| {
        let text = decimals(100.0 * (over - 1.0), 0);
        if text == "0" || text.starts_with('−') { text } else { format!("+{text}") }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::friction::THICKNESSES;

    const THEORY: &str = include_str!("../../../docs/theory.md");

    #[test]
    fn the_docs_tell_what_friction_changes() {
        let all = shown(&thicknesses().unwrap());
        let rows = all["rows"].as_array().unwrap();
        let said = THEORY.split_whitespace().collect::<Vec<_>>().join(" ");
        let holds = |text: String| assert!(said.contains(&text), "the docs do not say: {text}");
        let text = |value: &Value| value.as_str().unwrap().to_owned();
        let words = |list: &Value| list.as_array().unwrap().iter().map(text).collect::<Vec<_>>();
        let [sides_mm, frictions] = [words(&all["sides_mm"]), words(&all["frictions"])];
        holds(format!(
            "of a box of {} mm × {} mm from {} m, friction of {} to {} changes what a part along its thickness gets in {} of 100 drops",
            sides_mm[0],
            sides_mm[1],
            text(&all["height_m"]),
            frictions[0],
            frictions[FRICTIONS.len() - 1],
            text(&all["of_100"]),
        ));
        let mm = THICKNESSES.map(|ratio| 1e3 * ratio * SIDES_M[1]);
        holds(format!("| tilt | {:.1} mm thick | {:.0} mm | {:.0} mm |", mm[0], mm[1], mm[2]));
        let bands = BOUNDS_DEG.len() - 1;
        for k in 0..bands {
            let cells = rows.iter().skip(k).step_by(bands).map(|row| words(&row["one_drop"]["along_z"]).join(" to "));
            let tilts = words(&rows[k]["tilts_deg"]).join(" to ");
            holds(format!("| {tilts}° | {} % |", cells.collect::<Vec<_>>().join(" % | ")));
        }
        let below = || rows.iter().step_by(bands);
        let listed = |cells: Vec<String>| format!("{}, {} and {}", cells[0], cells[1], cells[2]);
        let last = |key: &str| listed(below().map(|row| words(&row[key])[1].clone()).collect());
        holds(format!(
            "gets up to {} times as much below 10°. That is {} % at most of what one along the thickness gets.",
            last("along_x"),
            last("x_over_z"),
        ));
    }

    /// Phones, tablets and laptops of other programs are as thin as the first box.
    #[test]
    fn thin_boxes_near_level_agree_with_independent_integrations() {
        let told = "friction of 0.2 and 0.5 changed the demand on phones, tablets and laptops by −11 to +2 %";
        assert!(THEORY.split_whitespace().collect::<Vec<_>>().join(" ").contains(told));
        let thin = Thickness::of(THICKNESSES[0]).unwrap();
        let level = thin.tilts.iter().filter(|tilt| tilt.degrees <= BOUNDS_DEG[1]);
        let [low, high] = range(level.flat_map(|tilt| tilt.one_drop[1].iter().copied()));
        assert!(low > 1.0 - 0.11 && high < 1.0 + 0.02, "{low} to {high}");
        assert!(low < 0.99, "friction does something: {low}");
    }

    #[test]
    fn the_figure_stays_within_its_frame() {
        let files = files().unwrap();
        crate::frame::stay_within_their_frame(&files);
        assert!(files.iter().any(|(name, text)| *name == "friction.svg" && text.contains("part along")));
    }
}
