//! This module writes the pages about several drops, and about a box that lands on faces, edges and corners.

use clatter_assess::{Assessment, LandingAssessment};
use clatter_figures::three;
use clatter_product::{Landing, ProductFile, Spread};
use serde_json::{Value, json};

use super::inputs::first;
use crate::words::{name, percent, shown, span};

/// The effects that the pages of a box leave out.
pub(super) const NOT_COVERED: [[&str; 2]; 7] = [
    [
        "Landing again",
        "The worst drops are followed until the box lies, others for the clatter of their first landing. How a box comes down again is sensitive to every input: it is taken to land in any posture, with all of the energy that is left.",
    ],
    [
        "Drops between",
        "Fewer drops are followed than of a bar or a plate: the search may miss a tenth of what is asked.",
    ],
    [
        "Corners and edges",
        "They are sharp: no case is. Mass without a height of its own is spread evenly over the thickness.",
    ],
    ["The ground", "It is hard and level, and the same for all corners."],
    ["The case", "It is rigid: a case that bends rings on its own, and may take part of a blow or add to it."],
    ["Parts", "They are light and linear. A part that hits its stop is undecided."],
    ["Ranges", "Values are those of the product file. What is not measured is assumed."],
];

/// Returns a row for each of several drops: its name, its tilt or how far off a box may be, its verdict, and the limit with the least
/// margin.
pub(super) fn rows(file: &ProductFile, assessment: &Assessment) -> Vec<Value> {
    let speeds = |landing: &LandingAssessment| {
        let optional = landing.optional.iter().map(|(_, range)| range.map(f64::to_bits));
        (landing.speed_m_s.map(f64::to_bits), optional.collect::<Vec<_>>())
    };
    let alike = assessment.landings.windows(2).all(|two| speeds(&two[0]) == speeds(&two[1]));
    let is_plate = file.product.body.is_wide();
    let row = |(landing, listed): (&LandingAssessment, &Landing)| {
        let tightest = landing.tightest()?;
        let component = file.components.iter().find(|component| component.name == tightest.component)?;
        let unit = tightest.limit.unit();
        let of = |value: Option<f64>| value.map_or("–".to_owned(), |value| shown(unit, value));
        let mut called = vec![landing.landing.to_string()];
        called.extend(listed.attitude.is_none().then(|| first(&listed.drop, is_plate)));
        if !alike {
            called.push(span(landing.speed_m_s, 1.0, "m/s"));
            called.extend(landing.optional.iter().map(|(input, range)| {
                let row = input.row();
                format!("{} {}", row.optional.map_or("", |optional| optional.phrase), span(*range, 1.0, row.unit))
            }));
        }
        Some(json!([
            called.join(", "),
            landing.tilt_deg.map_or_else(
                || format!("{}°", three(landing.tolerance_deg.unwrap_or_default())),
                |tilts| span(tilts, 1.0, "°").replace(" °", "°"),
            ),
            name(&tightest.component),
            tightest.limit.words(),
            of(component.limits.get(tightest.limit).map(Spread::lo)),
            of(tightest.demand),
            tightest.margin.map_or("?".to_owned(), percent),
            landing.verdict.name(),
        ]))
    };
    assessment.landings.iter().zip(&file.landings).filter_map(row).collect()
}
