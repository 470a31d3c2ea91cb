//! Speed for accuracy, measured: the four bars of Table 1 and the worked products.

use std::f64::consts::TAU;

use clatter::paper::DESIGNS;
use clatter_assess::ladder::{Ladder, LimitLadder, Machine, ProductLadder, bars};
use clatter_assess::{Accuracy, ProductFile};
use clatter_figures::{FigureError, LadderPanel as Panel, ladders as panels, three};
use serde::Serialize;
use serde_json::json;

use crate::paper::{File, pretty};
use crate::{ReportError, words};

/// The worked products, and the name of the figure of each.
const EXAMPLES: [(&str, &str); 3] = [
    ("trade-phone.svg", include_str!("../../../reports/examples/phone.toml")),
    ("trade-handheld-terminal.svg", include_str!("../../../reports/examples/handheld-terminal.toml")),
    ("trade-laptop.svg", include_str!("../../../reports/examples/laptop.toml")),
];

/// One bar of Table 1.
#[derive(Debug, Serialize)]
struct BarLadder {
    q: f64,
    e: f64,
    #[serde(flatten)]
    ladder: Ladder,
}

/// Why no cheaper model does, in words: limit by limit.
fn reasons(ladders: &[LimitLadder]) -> Vec<String> {
    ladders.iter().map(|limit| words::reason(&limit.ladder.reason)).collect()
}

/// What every model gets wrong and what it costs, for the four bars of Table 1 (the peak acceleration of a board; the drops are
/// those of [`bars`]) and for the worst drop of every limit of the three worked products: `trade.json`, a figure of the bars and
/// one of each product.
///
/// Errors and strikes are the same from run to run; `seconds`, and with them `cheapest`, are of the machine.
///
/// # Errors
/// None in practice: all drops are valid.
pub fn trade_files() -> Result<Vec<(&'static str, String)>, ReportError> {
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
    let mut files: Vec<File> = vec![("trade-bars.svg", panels(&of_bars)?)];
    let mut products = Vec::new();
    for (name, text) in EXAMPLES {
        let file = ProductFile::read(text, name).map_err(|faults| ReportError::Data(faults.to_string()))?;
        let product = file.ladders(&file.assess()?, tolerance)?;
        files.push((name, of_product(&product)?));
        products.push(product);
    }
    let [(drop, part, _), ..] = &all;
    let scene = json!({
        "length_mm": three(1e3 * drop.body.length_m()), "speed_m_s": three(drop.speed_m_s),
        "tilt_deg": three(drop.tilt_rad.to_degrees()), "contact_ms": drop.contact_time_s.map(|time| three(1e3 * time)),
        "frequency_hz": part.suspension.map(|part| three(part.omega() / TAU)),
        "position": three(2.0 * part.position_m / drop.body.length_m()),
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

/// A panel for each limit.
pub(crate) fn of_product(product: &ProductLadder) -> Result<String, FigureError> {
    panels(&product.limits.iter().map(|limit| of_limit(limit, product.tolerance)).collect::<Vec<_>>())
}

fn of_limit(limit: &LimitLadder, tolerance: f64) -> Panel<'_> {
    let LimitLadder { component, limit: kind, worst_case: worst, ladder } = limit;
    Panel {
        title: format!("{}: {}", words::name(component), kind.words()),
        drop: format!(
            "end {} first at {} m/s, {}°, e = {}",
            words::end(worst.drop.first),
            three(worst.drop.speed_m_s),
            three(worst.tilt_deg()),
            three(worst.drop.restitution)
        ),
        ladder,
        reason: words::reason(&ladder.reason),
        tolerance,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paper::tests::stay_within_their_frame;
    use clatter_assess::{Limit, LimitKind, Model, Part, SingleDrop};
    use clatter_flight::{Body, ContactLaw};
    use clatter_shock::{DampingRatio, Suspension};

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

    /// A flat drop, a dead one and a lively one: errors beyond all scales, times that differ little.
    #[test]
    fn extremes_stay_in_the_frame() {
        let part = Suspension::from_hz(100.0, DampingRatio::new(0.0).unwrap()).unwrap();
        for (gyration_m, e, tilt_rad, contact_time_s) in
            [(0.01, 0.5, 0.1, None), (0.04, 0.0, 0.0, Some(1e-3)), (0.04, 0.6, 0.0, None)]
        {
            let drop = SingleDrop {
                body: Body::new(0.14, gyration_m).unwrap(),
                first: clatter::End::A,
                tilt_rad,
                flat: false,
                speed_m_s: 1.0,
                restitution: e,
                gravity_m_s2: 9.81,
                contact_time_s,
                contact_law: ContactLaw::Hysteretic,
            };
            for kind in [LimitKind::Acceleration, LimitKind::VelocityChange] {
                let place = Part { position_m: 0.02, suspension: Some(part) };
                let mut ladder = Ladder::measure(&drop, &place, &Limit::new(kind, 1.0), 0.01).unwrap();
                ladder.models[0].error = f64::INFINITY;
                let of = Panel {
                    title: "an *extreme* <one>".to_owned(),
                    drop: String::new(),
                    ladder: &ladder,
                    reason: String::new(),
                    tolerance: 0.01,
                };
                let svg = panels(&[of]).unwrap();
                assert!(svg.contains("off the scale") && svg.contains("&lt;one&gt;"), "{svg}");
                stay_within_their_frame(&[("extreme.svg", svg)]);
            }
        }
    }

    /// Every model that the page names has a word there.
    #[test]
    fn the_page_names_every_model() {
        let page = include_str!("../../../reports/trade.typ");
        for model in Model::ALL {
            assert!(page.contains(&format!("\"{}\"", model.name())), "{}", model.name());
        }
    }
}
