//! What the pages show and say of a plate alone.

use clatter_assess::{Component, CornerStrike, LimitAssessment, PlaceMap, PlatePortrait, WorstCase};
use clatter_figures::{
    Area, FigureError, HeatMap, Landing, Place, Strike, heat_map, is_drawn, landing, over_direction, plan as draw,
    three,
};
use serde_json::{Value, json};

use super::{Part, title};
use crate::words::{customary, shown};

/// What is left out of a plate, each in place of what is said of a bar.
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
            "It is hard, level and without friction, and the same for all corners: nothing holds a corner or lets it slide. Soft ground lengthens the pulses and lowers e.",
        ],
    ),
    (
        "Places and changes",
        [
            "Places and changes",
            "Where a part could sit is told of the drops of the figures, for its tightest limit. An assessment of the changed file decides; changes that would make a part safe are not looked for on a plate.",
        ],
    ),
];

/// Where a part may be along the plate and across it.
fn reach_m(component: &Component) -> [[f64; 2]; 2] {
    let ends = component.ends_m();
    let of = |side: usize| {
        let all = ends.iter().map(|end| end[side]);
        all.fold([f64::INFINITY, f64::NEG_INFINITY], |[from, to], x| [from.min(x), to.max(x)])
    };
    [of(0), of(1)]
}

/// The plan with some of the parts, after as many others.
pub(super) fn plan(
    plate: &clatter_flight::Plate,
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
    draw(plate, &area.collect::<Vec<_>>())
}

/// Direction in degrees, share, and whether the file gives the direction.
pub(super) fn around(of: &PlatePortrait) -> impl Iterator<Item = (f64, f64, bool)> {
    of.over_direction.iter().map(|point| {
        let direction_rad = point.drop.across.map_or(0.0, |across| across.direction_rad);
        (direction_rad.to_degrees(), point.share, of.is_given(direction_rad))
    })
}

/// The demand over the direction, the landing, and what would be asked anywhere.
pub(super) fn figures(
    number: usize,
    plate: &clatter_flight::Plate,
    ((component, assessed), portrait): &Part<'_>,
) -> Result<Vec<(String, String)>, FigureError> {
    let tightest = assessed.tightest();
    let (Some(of), Some(worst)) = (&portrait.plate, &tightest.worst_case) else { return Ok(Vec::new()) };
    let (allowed, title) = (tightest.allowed / customary(tightest.unit).0, title(tightest));
    let curve: Vec<_> = around(of).map(|(direction, share, given)| (direction, allowed * share, given)).collect();
    let strike = |strike: &CornerStrike| Strike {
        corner: strike.corner,
        time_ms: 1e3 * strike.time_s,
        shock_m_s: strike.delta_v_m_s,
    };
    let strikes: Vec<Strike> = told(of, worst).iter().map(strike).collect();
    let (reach_m, place_m) = (reach_m(component), [worst.part.position_m, worst.part.across_m]);
    let lands = Landing {
        plate,
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
    if let Some(map) = &of.map {
        let heat = HeatMap { plate, map, allowed, title: &title, reach_m, place_m };
        files.push((format!("map-{number}.svg"), heat_map(&heat)?));
    }
    Ok(files)
}

/// The strikes up to the one of the peak, and until each corner that strikes has struck: others come far later.
fn told<'a>(of: &'a PlatePortrait, worst: &WorstCase) -> &'a [CornerStrike] {
    let first = (0..4).filter_map(|corner| of.strikes.iter().position(|strike| strike.corner == corner));
    let all = usize::try_from(worst.impact).unwrap_or(usize::MAX).max(first.fold(0, |most, i| most.max(i + 1)));
    &of.strikes[..all.min(of.strikes.len())]
}

/// The lowest corner of a plate that rises to a direction in degrees, or its lowest edge.
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

/// Least and most of a map.
fn span(map: &PlaceMap) -> [f64; 2] {
    map.shares.iter().fold([f64::INFINITY, 0.0], |[least, most], share| [least.min(*share), most.max(*share)])
}

/// Where the tightest limit holds, in a sentence.
pub(super) fn zone(of: &PlatePortrait) -> String {
    let said = match of.map.as_ref().map(span) {
        Some([least, _]) if least > 1.0 => "that limit holds nowhere on the plate",
        Some([_, most]) if most <= 1.0 => "that limit holds anywhere on the plate",
        Some(_) => "that limit holds where all of the part lies within the border of its map",
        None => return " That limit is asked for the same anywhere on the plate.".to_owned(),
    };
    format!(" In the drops of the figures {said}.")
}

/// What stands below the figures of a part.
pub(super) fn captions(of: &LimitAssessment, worst: &WorstCase, portrait: &PlatePortrait) -> Value {
    let (what, tilt) = (of.limit.measured(of.unit), three(worst.tilt_deg()));
    let most = portrait.over_direction.iter().map(|point| of.allowed * point.share).fold(0.0, f64::max);
    let allowed = shown(of.unit, of.allowed);
    let seen = if is_drawn(of.allowed, most) { "is" } else { "lies outside the figure, at" };
    let dashed = if portrait.given_rad.is_some() { " Dashed: directions that the file does not give." } else { "" };
    let part = worst.frequency_hz().map(|hz| format!(" at {} Hz", three(hz))).unwrap_or_default();
    let map = portrait.map.as_ref().map(|map| {
        let (drops, others) = (map.drops, map.drops - 1);
        let holds = match span(map) {
            [least, _] if least > 1.0 => "It is exceeded everywhere.".to_owned(),
            [_, most] if most <= 1.0 => "It is exceeded nowhere.".to_owned(),
            _ => format!("Bold line: the border of where {allowed} is not exceeded, which is in the lighter part."),
        };
        let of_drops = if others == 0 {
            "in the worst drop".to_owned()
        } else {
            format!("the most of {drops} drops, the worst one and it with {others} other directions")
        };
        json!({
            "said": format!("The {what} that this part{part} would be asked for anywhere on the plate: {of_drops}. {holds} Dashed: the part."),
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
            "The worst drop from above. At each corner its first strikes: number, time, change of velocity; the peak comes after number {}. Arrow: where the plate rises to. Dashed: the part; dot: its place that is asked most.",
            worst.impact
        ),
        "landing-alt": format!("Plan of the plate as it lands, its corners numbered in the order of their strikes: {order}."),
        "map": map,
    })
}
