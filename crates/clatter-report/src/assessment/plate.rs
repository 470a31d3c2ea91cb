//! This module holds the figures and the texts of the pages that only a plate has.

use clatter_assess::{ComponentAssessment, CornerStrike, LimitAssessment, PlaceMap, PlatePortrait, WorstCase};
use clatter_figures::{
    Area, FigureError, HeatMap, Landing, Place, Strike, heat_map, is_drawn, landing, over_direction, plan as draw,
    reach_m, three,
};
use clatter_product::{Component, LimitKind};
use serde_json::{Value, json};

use super::{Part, title};
use crate::words::shown;

/// The effects that the model of a plate leaves out, each in place of one of a bar.
pub(super) const NOT_COVERED: [(&str, [&str; 2]); 3] = [
    (
        "Corners and edges",
        [
            "Real tilt",
            "The plate is followed at small tilt, with the lever arms of a level one. Where the thickness is known, a box at real tilt with full rotation is followed beside it, next to each worst drop, and the notes tell by how much it differs. Corners are points, and the plate does not turn before it lands.",
        ],
    ),
    (
        "The ground",
        [
            "The ground",
            "It is hard, level and the same for all corners. The plate is followed without friction; the box beside it is followed with a coefficient of 0.6 as well, and the notes tell by how much it differs. Soft ground lengthens the pulses and lowers e.",
        ],
    ),
    (
        "Places",
        [
            "Places",
            "Where a part could sit is told of the drops of the figures, which are by one contact law. An assessment of the changed file decides; what would make a part safe clatter design tells, which takes longer than this page.",
        ],
    ),
];

/// The words for a plate that does not turn before it lands; for one that turns, `SPIN` replaces them.
pub(super) const NO_SPIN: &str = "the plate does not turn before it lands";
pub(super) const SPIN: &str = "before it lands the plate turns about the axis of its tilt alone";

/// Draws the plan with some of the parts, after as many others.
pub(super) fn plan(
    plate: &clatter_flight::Plate,
    sides_m: [f64; 2],
    components: &[Component],
    places: &[Place<'_>],
    after: usize,
) -> Result<String, FigureError> {
    let with = places.iter().zip(components.iter().enumerate().skip(after));
    let area = with.map(|(place, (i, component))| Area {
        number: i + 1,
        name: place.name,
        reach_m: reach_m(component),
        verdict: place.verdict,
        word: place.word,
    });
    draw(plate, sides_m, &area.collect::<Vec<_>>())
}

/// Returns the direction in degrees, the share, and whether the file gives the direction.
pub(super) fn around(of: &PlatePortrait) -> impl Iterator<Item = (f64, f64, bool)> {
    of.over_direction.iter().map(|point| {
        let direction_rad = point.drop.direction_rad;
        (direction_rad.to_degrees(), point.share, of.is_given(direction_rad))
    })
}

/// Draws the demand over the direction, the landing, and the demand at any other place.
pub(super) fn figures(
    number: usize,
    (plate, sides_m): (&clatter_flight::Plate, [f64; 2]),
    ((component, assessed), portrait): &Part<'_>,
) -> Result<Vec<(String, String)>, FigureError> {
    let tightest = assessed.tightest();
    let (Some(of), Some(worst)) = (&portrait.plate, &tightest.worst_case) else { return Ok(Vec::new()) };
    let (allowed, title) = (tightest.unit.customary().of_si(tightest.allowed), title(tightest));
    let curve: Vec<_> = around(of).map(|(direction, share, given)| (direction, allowed * share, given)).collect();
    let strike = |strike: &CornerStrike| Strike {
        corner: strike.corner,
        time_ms: 1e3 * strike.time_s,
        shock_m_s: strike.delta_v_m_s,
    };
    let strikes: Vec<Strike> = told(of, worst).iter().map(strike).collect();
    let (reach_m, place_m) = (reach_m(component), worst.part.place.plan_m());
    let lands = Landing {
        plate,
        sides_m,
        strikes: &strikes,
        direction_deg: worst.direction_deg().unwrap_or_default(),
        reach_m,
        place_m,
        impact: usize::try_from(worst.impact).unwrap_or(usize::MAX),
    };
    let mut files = vec![
        (format!("direction-{number}.svg"), over_direction(&curve, allowed, &title)?),
        (format!("landing-{number}.svg"), landing(&lands)?),
    ];
    if let (Some((limit, map)), [_, others @ ..]) = (mapped(assessed, of), &of.maps[..]) {
        let others: Vec<&PlaceMap> = others.iter().map(|(_, map)| map).collect();
        let (allowed, title) = (limit.unit.customary().of_si(limit.allowed), super::title(limit));
        let place_m = limit.worst_case.map_or(place_m, |worst| worst.part.place.plan_m());
        let heat = HeatMap { plate, sides_m, map, others: &others, allowed, title: &title, reach_m, place_m };
        files.push((format!("map-{number}.svg"), heat_map(&heat)?));
    }
    Ok(files)
}

/// Finds the limit whose map is drawn: the tightest one whose demand differs from place to place.
fn mapped<'a>(assessed: &'a ComponentAssessment, of: &'a PlatePortrait) -> Option<(&'a LimitAssessment, &'a PlaceMap)> {
    let (kind, map) = of.maps.first()?;
    assessed.limits.iter().find(|limit| limit.limit == *kind).map(|limit| (limit, map))
}

/// Returns the strikes up to the one of the peak, and until each corner that strikes has struck: others come far later.
fn told<'a>(of: &'a PlatePortrait, worst: &WorstCase) -> &'a [CornerStrike] {
    let first = (0..4).filter_map(|corner| of.strikes.iter().position(|strike| strike.corner == corner));
    let all = usize::try_from(worst.impact).unwrap_or(usize::MAX).max(first.fold(0, |most, i| most.max(i + 1)));
    &of.strikes[..all.min(of.strikes.len())]
}

/// Names the lowest corner of a plate that rises to a direction in degrees, or its lowest edge.
pub(super) fn lowest(direction_deg: f64) -> String {
    let (corners, edges) = (["a", "b", "c", "d"], ["a–d", "a–b", "b–c", "c–d"]);
    let side = direction_deg / 90.0;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a quarter of a turn")]
    let quarter = |of: f64| of.rem_euclid(4.0) as usize % 4;
    // Within a millionth of a degree both corners of an edge touch at once.
    if (side - side.round()).abs() < 1e-8 {
        format!("edge {}", edges[quarter(side.round())])
    } else {
        format!("corner {}", corners[quarter(side.floor())])
    }
}

/// Returns the least and the largest value of a map.
fn span(map: &PlaceMap) -> [f64; 2] {
    map.shares.iter().fold([f64::INFINITY, 0.0], |[least, most], share| [least.min(*share), most.max(*share)])
}

/// Describes where the tightest limit holds, in a sentence.
pub(super) fn zone(tightest: LimitKind, of: &PlatePortrait) -> String {
    let own = of.maps.first().filter(|(kind, _)| *kind == tightest);
    let said = match own.map(|(_, map)| span(map)) {
        Some([least, _]) if least > 1.0 => "that limit holds at no place of its map",
        Some([_, most]) if most <= 1.0 => "that limit holds at every place of its map",
        Some(_) => "that limit holds where all of the part lies within the border of its map",
        None => return " That limit is asked for the same anywhere on the plate.".to_owned(),
    };
    format!(" In the drops of the figures {said}.")
}

/// Describes where the limits without a map hold, each in the drops around its own worst one.
fn of_others(of: &PlatePortrait) -> String {
    let one = |((kind, map), line): (&(LimitKind, PlaceMap), &str)| match span(map) {
        [least, _] if least > 1.0 => format!(" Its {} is exceeded everywhere.", kind.words()),
        [_, most] if most <= 1.0 => format!(" Its {} is exceeded nowhere.", kind.words()),
        _ => format!(" {line}: the border of its {}.", kind.words()),
    };
    of.maps
        .iter()
        .skip(1)
        .zip(["Dotted", "Dash-dotted", "Thin dashes", "Long dashes"])
        .map(one)
        .collect::<Vec<_>>()
        .concat()
}

/// Returns the captions below the figures of a part.
pub(super) fn captions(
    component: &Component,
    assessed: &ComponentAssessment,
    worst: &WorstCase,
    portrait: &PlatePortrait,
) -> Value {
    let has_extent = component.extent_m > 0.0 || component.extent_across_m > 0.0;
    let of = assessed.tightest();
    let (what, tilt) = (of.limit.measured(of.unit), three(worst.tilt_deg()));
    let most = portrait.over_direction.iter().map(|point| of.allowed * point.share).fold(0.0, f64::max);
    let allowed = shown(of.unit, of.allowed);
    let seen = if is_drawn(of.allowed, most) { "is" } else { "lies outside the figure, at" };
    let dashed = if portrait.given_rad.is_some() { " Dashed: directions that the file does not give." } else { "" };
    let map = mapped(assessed, portrait).map(|(of, map)| {
        let (what, allowed) = (of.limit.measured(of.unit), shown(of.unit, of.allowed));
        let hz = of.worst_case.and_then(|worst| worst.frequency_hz());
        let part = hz.map(|hz| format!(" at {} Hz", three(hz))).unwrap_or_default();
        let (drops, others) = (map.drops, map.drops - 1);
        let holds = match span(map) {
            [least, _] if least > 1.0 => format!("Everywhere it is above {allowed}."),
            [_, most] if most <= 1.0 => format!("Nowhere it is above {allowed}."),
            _ => format!("Bold line: the border of where {allowed} is not exceeded, which is in the lighter part."),
        };
        let of_others = of_others(portrait);
        let outline = if has_extent { " Dashed: the part." } else { "" };
        let of_drops = if others == 0 {
            "in the worst drop".to_owned()
        } else {
            format!("the most of {drops} drops, the worst one and it with {others} other directions")
        };
        json!({
            "said": format!("The {what} that this part{part} would be asked for anywhere on the plate: {of_drops}. {holds}{of_others}{outline}"),
            "alt": format!("Map over the plan of the plate: the {what} that this part would be asked for at each place."),
        })
    });
    let letter = |strike: &CornerStrike| ["a", "b", "c", "d"][strike.corner % 4];
    let order = told(portrait, worst).iter().map(letter).collect::<Vec<_>>().join(" ");
    json!({
        "direction": format!(
            "The most {what} by the direction that the plate rises to, at the tilt of the worst drop, {tilt}°, and else as there. Letters: the lowest corner. The limit {seen} {allowed}.{dashed}"
        ),
        "direction-alt": format!("Curve of the {what} over the direction in which the plate is tilted."),
        "landing": format!(
            "The worst drop from above. At each corner its first strikes: number, time, change of velocity; the peak comes after number {}. Arrow: where the plate rises to.{} Dot: the place of the part that is asked most.",
            worst.impact,
            if has_extent { " Dashed: the part." } else { "" },
        ),
        "landing-alt": format!("Plan of the plate as it lands, its corners numbered in the order of their strikes: {order}."),
        "map": map,
    })
}

#[cfg(test)]
mod tests {
    use super::super::files;
    use super::*;
    use crate::Pages;
    use clatter_product::ProductFile;

    const PLATE: &str = include_str!("../../../../reports/examples/handheld-terminal.toml");

    #[test]
    fn the_lowest_corner_lies_opposite_to_where_the_plate_rises() {
        let said = [0.0, 25.0, 90.0, 95.0, 180.0, 200.0, 270.0, 291.0, 359.999_999_999_9].map(lowest);
        let expected = ["edge a–d", "corner a", "edge a–b", "corner b", "edge b–c", "corner c", "edge c–d", "corner d"];
        assert_eq!(said[..8], expected);
        assert_eq!(said[8], "edge a–d");
    }

    /// No word of a bar is left, and every part has its pictures: a change of angular velocity is the same anywhere and has no map.
    #[test]
    fn pages_of_a_plate_speak_of_a_plate() {
        let text =
            PLATE.replace("tilt = [\"1 deg\", \"12 deg\"]", "tilt = \"3 deg\"\ndirection = [\"20 deg\", \"50 deg\"]");
        let file = ProductFile::read(&text, "plate.toml").unwrap();
        let assessment = clatter_assess::assess(&file).unwrap();
        let portraits = clatter_assess::portraits(&file, &assessment);
        let (file, assessment, portraits) = (&file, &assessment, &portraits[..]);
        let pages = Pages { file, assessment, portraits, remedies: &[], measured: &[], path: "plate.toml", date: None };
        let files = files(&pages).unwrap();
        let names = files.iter().map(|(name, _)| name.as_str()).filter(|name| *name != "assessment.json");
        let names: Vec<&str> = names.collect();
        let part = |k: usize| ["history", "direction", "landing", "map"].map(|what| format!("{what}-{k}.svg"));
        let expected =
            [&["product-1.svg".to_owned()][..], &part(1), &part(2), &part(3)[..3], &["shares.svg".to_owned()]];
        assert_eq!(names, expected.concat());
        let json = &files.iter().find(|(name, _)| name == "assessment.json").unwrap().1;
        let data: Value = serde_json::from_str(json).unwrap();
        assert_eq!(data["inputs"][5][1], "3° at the first touch, rising to 20 to 50°");
        let said = data.to_string();
        for of_bar in
            [" bar ", "either end", "both ends as", "an end touches", "towards end", "along the product", "end a at"]
        {
            assert!(!said.contains(of_bar), "{of_bar}: {said}");
        }
        for of_plate in [
            "length 220 mm, width 85 mm, thickness 25 mm",
            "0.42 kg, radii of gyration 65.4 mm along the length, 21.8 mm along the width, center of mass at −8.93, −1.55 mm",
            "product of inertia over the mass 245 mm²",
            "It sits at 95, 15 mm, and is 20 mm by 30 mm.",
            "That drop lands on corner a, rising to ",
            "a box at real tilt",
            "Dashed: directions that the file does not give.",
        ] {
            assert!(said.contains(of_plate), "{of_plate}: {said}");
        }
    }
}
