//! Speed for accuracy, measured: the four bars of Table 1 and the worked products.

use std::f64::consts::TAU;

use clatter::design::DESIGNS;
use clatter_assess::{
    Accuracy, Part,
    ladder::{Ladder, LimitLadder, Machine},
};
use clatter_figures::{LadderPanel as Panel, ladders as panels, three};
use clatter_flight::Body;
use clatter_product::{Drop, Limit, LimitKind, ProductFile};
use clatter_report::{File, ladder_svg, words};
use clatter_shock::{DampingRatio, STANDARD_GRAVITY_M_S2, Suspension};
use serde::Serialize;
use serde_json::json;

use crate::Error;
use crate::files::pretty;

/// The worked products, and the name of the figure of each.
const EXAMPLES: [(&str, &str); 3] = [
    ("trade-phone.svg", include_str!("../../tests/cases/bar-phone.toml")),
    ("trade-handheld-terminal.svg", include_str!("../../tests/cases/bar-terminal.toml")),
    ("trade-laptop.svg", include_str!("../../tests/cases/bar-laptop.toml")),
];

/// Returns the four bars of the paper's Table 1 ([`DESIGNS`]) as drops to compare others with: 140 mm long, 4.43 m/s
/// (from 1 m), 5°, standard gravity, contacts of 0.2 ms; the acceleration of a board with a mode at 230 Hz, Q = 10,
/// near the end that strikes second (s = 0.9).
///
/// # Errors
/// None in practice: the numbers are valid.
pub fn bars() -> Result<[(Drop, Part, Limit); 4], clatter_product::Error> {
    let [a, b, c, d] = DESIGNS.map(|[q, e]| bar(q, e));
    Ok([a?, b?, c?, d?])
}

/// Returns one of these bars.
fn bar(q: f64, e: f64) -> Result<(Drop, Part, Limit), clatter_product::Error> {
    let part = Suspension::new(TAU * 230.0, DampingRatio::from_quality_factor(10.0)?)?;
    // q = (L² − ρ²)/(L² + ρ²)
    let gyration_m = 0.07 * ((1.0 - q) / (1.0 + q)).sqrt();
    let drop = Drop {
        gravity_m_s2: STANDARD_GRAVITY_M_S2,
        contact_time_s: Some(2e-4),
        ..Drop::new(Body::new(0.14, gyration_m)?, 4.43, 5f64.to_radians(), e)
    };
    let place = Part::new(0.9 * 0.07, Some(part));
    Ok((drop, place, Limit::new(LimitKind::Acceleration, 1.0)))
}

/// One bar of Table 1.
#[derive(Debug, Serialize)]
struct BarLadder {
    q: f64,
    e: f64,
    #[serde(flatten)]
    ladder: Ladder,
}

/// Returns the reasons against cheaper models in words, limit by limit.
fn reasons(ladders: &[LimitLadder]) -> Vec<String> {
    ladders.iter().map(|limit| words::reason(&limit.ladder.reason)).collect()
}

/// Returns the error and the cost of every model, for the four bars of Table 1 (the peak acceleration of a board; the
/// drops are those of [`bars`]) and for the worst drop of every limit of the three worked products: `trade.json`, a
/// figure of the bars and one of each product.
///
/// Errors and strikes are the same from run to run; `seconds`, and with them `cheapest`, depend on the machine.
///
/// # Errors
/// None in practice: all drops are valid.
pub fn trade_files() -> Result<Vec<File>, Error> {
    let tolerance = Accuracy::default().tolerance;
    let mut ladders = Vec::new();
    let all = bars()?;
    for ((drop, part, limit), [q, e]) in all.iter().zip(DESIGNS) {
        ladders.push(BarLadder { q, e, ladder: Ladder::measure(drop, part, limit, tolerance)? });
    }
    let of_bars: Vec<Panel<'_>> = ladders
        .iter()
        .map(|bar| Panel {
            title: format!("q = {}, e = {}: acceleration of the board", bar.q, bar.e),
            drop: String::new(),
            ladder: &bar.ladder,
            reason: words::reason(&bar.ladder.reason),
            tolerance,
        })
        .collect();
    let mut files = vec![("trade-bars.svg", panels(&of_bars)?)];
    let mut products = Vec::new();
    for (name, text) in EXAMPLES {
        let file = ProductFile::read(text, name).map_err(|faults| Error::Data(faults.to_string()))?;
        let product = clatter_assess::ladders(&file, &clatter_assess::assess(&file)?, tolerance)?;
        files.push((name, ladder_svg(&product)?));
        products.push(product);
    }
    let [(drop, part, _), ..] = &all;
    let scene = json!({
        "length_mm": three(1e3 * drop.body.length_m()), "speed_m_s": three(drop.speed_m_s),
        "tilt_deg": three(drop.tilt_rad.to_degrees()), "contact_ms": drop.contact_time_s.map(|time| three(1e3 * time)),
        "frequency_hz": part.suspension.map(|part| three(part.omega() / TAU)),
        "position": three(2.0 * part.place.at_m[0] / drop.body.length_m()),
    });
    let of_bars: Vec<String> = ladders.iter().map(|bar| words::reason(&bar.ladder.reason)).collect();
    let of_products: Vec<Vec<String>> = products.iter().map(|product| reasons(&product.limits)).collect();
    let data = json!({
        "machine": Machine::here(), "tolerance": tolerance, "scene": scene, "bars": ladders, "products": products,
        "reasons": { "bars": of_bars, "products": of_products },
    });
    files.insert(0, ("trade.json", pretty(&data)?));
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::stay_within_their_frame;
    use clatter_product::Model;

    #[test]
    fn four_figures_and_their_data() {
        let files = trade_files().unwrap();
        stay_within_their_frame(&files);
        let names: Vec<_> = files.iter().map(|(name, _)| *name).collect();
        assert_eq!((names.len(), names[..2].to_vec()), (5, vec!["trade.json", "trade-bars.svg"]));
        let data: serde_json::Value = serde_json::from_str(&files[0].1).unwrap();
        for (k, [q, e]) in DESIGNS.into_iter().enumerate() {
            assert_eq!((&data["bars"][k]["q"], &data["bars"][k]["e"]), (&q.into(), &e.into()));
            assert!(files[1].1.contains(&format!("q = {q}, e = {e}")), "{}", files[1].1);
        }
        assert_eq!(data["products"].as_array().unwrap().len(), 3);
        // The laptop has no contact time, and no model of contacts.
        let says = |name| files.iter().find(|(n, _)| *n == name).unwrap().1.contains("compliant");
        assert!(says("trade-phone.svg") && !says("trade-laptop.svg"));
    }

    /// Every model that the page names has a word there.
    #[test]
    fn the_page_names_every_model() {
        let page = include_str!("../../reports/trade.typ");
        for model in Model::ALL {
            assert!(page.contains(&format!("\"{}\"", model.name())), "{}", model.name());
        }
    }
}
