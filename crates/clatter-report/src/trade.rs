//! Speed for accuracy on scenes to compare with: the four bars of Table 1 and the worked products.

use clatter::paper::DESIGNS;
use clatter_scene::ProductFile;
use clatter_scene::plan::Quantity;
use clatter_scene::tradeoff::{Kept, Machine, PartTradeoff, ProductTradeoff, Tradeoff, bar, bars};
use serde::Serialize;

use crate::ReportError;
use crate::figure::trade::{panels, words};
use crate::paper::{File, pretty};

/// The worked products, and the name of the figure of each.
const EXAMPLES: [(&str, &str); 3] = [
    ("trade-phone.svg", include_str!("../../../reports/examples/phone.toml")),
    ("trade-handheld-terminal.svg", include_str!("../../../reports/examples/handheld-terminal.toml")),
    ("trade-laptop.svg", include_str!("../../../reports/examples/laptop.toml")),
];
const BARS: [&str; 4] = ["trade-bar-1.svg", "trade-bar-2.svg", "trade-bar-3.svg", "trade-bar-4.svg"];

/// The study of plans on random scenes, as it last ran.
pub(crate) const PLANS: &str = include_str!("../../../reports/plans.json");

/// Bars whose train never ends without gravity, from the shortest to one close to where trains begin to end.
const ENDLESS: [[f64; 2]; 3] = [[0.8, 0.1], [0.9, 0.3], [0.95, 0.5]];

/// Everything measured.
#[derive(Debug, Serialize)]
struct Trades {
    machine: Machine,
    bars: Vec<BarTrade>,
    products: Vec<ProductTradeoff>,
    endless: Vec<Train>,
}

/// How many strikes of an endless train are worth keeping.
#[derive(Debug, Serialize)]
struct Train {
    q: f64,
    e: f64,
    kept: Vec<Kept>,
}

/// One bar of Table 1.
#[derive(Debug, Serialize)]
struct BarTrade {
    q: f64,
    e: f64,
    #[serde(flatten)]
    trade: Tradeoff,
}

/// The trade between speed and accuracy for the four bars of Table 1 (peak acceleration; the scenes are those of
/// [`bars`]) and for every part of the three worked products: `trade.json`, and a figure for each. The JSON also has
/// how many strikes of three endless trains are worth keeping.
///
/// Errors, estimates, counts and choices are the same from run to run, `seconds` and what follows from them (`front`)
/// are of the machine.
///
/// # Errors
/// None in practice: all scenes are valid.
pub fn trade_files() -> Result<Vec<(&'static str, String)>, ReportError> {
    let mut files: Vec<File> = Vec::new();
    let mut trades = Trades { machine: Machine::here(), bars: Vec::new(), products: Vec::new(), endless: Vec::new() };
    for ((setup, [q, e]), name) in bars()?.iter().zip(DESIGNS).zip(BARS) {
        let trade = Tradeoff::measure(setup, Quantity::PeakAcceleration)?;
        let title = format!("q = {q}, e = {e}: peak acceleration of a board near the end that strikes second");
        files.push((name, panels(&[(title, &trade)])));
        trades.bars.push(BarTrade { q, e, trade });
    }
    for (name, text) in EXAMPLES {
        let file = ProductFile::read(text, name).map_err(|faults| ReportError::Data(faults.to_string()))?;
        let product = file.tradeoff(&file.assess()?)?;
        files.push((name, of_product(&product)));
        trades.products.push(product);
    }
    for [q, e] in ENDLESS {
        let kept = Tradeoff::measure(&bar(q, e)?, Quantity::PeakAcceleration)?.kept;
        trades.endless.push(Train { q, e, kept });
    }
    files.insert(0, ("trade.json", pretty(&trades)?));
    Ok(files)
}

/// A panel for each limit.
pub(crate) fn of_product(product: &ProductTradeoff) -> String {
    let title = |part: &PartTradeoff| {
        let scene = &part.trade.scene;
        format!(
            "{}: {}, dropped at {:.3} m/s and {:.2}°, e = {:.3}",
            part.component,
            words(part.trade.quantity),
            scene.speed_m_s,
            scene.tilt_deg,
            scene.restitution
        )
    };
    panels(&product.trades.iter().map(|part| (title(part), &part.trade)).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paper::tests::stay_within_their_frame;
    use clatter::flight::{Body, Scene};
    use clatter_scene::plan::{Pair, Setup};
    use clatter_shock::{DampingRatio, Suspension};

    #[test]
    fn seven_figures_and_their_data() {
        let files = trade_files().unwrap();
        stay_within_their_frame(&files);
        let names: Vec<_> = files.iter().map(|(name, _)| *name).collect();
        assert_eq!((names.len(), names[0]), (8, "trade.json"));
        let data: serde_json::Value = serde_json::from_str(&files[0].1).unwrap();
        for (k, [q, e]) in DESIGNS.into_iter().enumerate() {
            assert_eq!((&data["bars"][k]["q"], &data["bars"][k]["e"]), (&q.into(), &e.into()));
            let figure = &files[1 + k].1;
            assert!(figure.contains(&format!("q = {q}, e = {e}")) && figure.contains("compliant, pulses"), "{figure}");
        }
        assert_eq!(data["products"].as_array().unwrap().len(), 3);
        for train in data["endless"].as_array().unwrap() {
            let start = clatter::Start::default();
            let bar = clatter::Bar::new(train["q"].as_f64().unwrap(), train["e"].as_f64().unwrap()).unwrap();
            assert_eq!(bar.summary(&start).count, clatter::Count::Endless, "{train}");
            assert!(train["kept"][0]["least"][2].as_u64() < train["kept"][0]["strikes"].as_u64(), "{train}");
        }
        // The laptop has no contact time: its figure says so, the phone's need not.
        let says = |name| files.iter().find(|(n, _)| *n == name).unwrap().1.contains("compliant bar here");
        assert!(says("trade-laptop.svg") && !says("trade-phone.svg"));
    }

    /// The record is of pairs that plans choose from today, of enough scenes, and holds what plans promise.
    #[test]
    fn the_study_of_plans_holds_them() {
        let data: serde_json::Value = serde_json::from_str(PLANS).unwrap();
        assert!(data["scenes"].as_u64() >= Some(10_000), "{}", data["scenes"]);
        for quantity in [Quantity::PeakAcceleration, Quantity::RattleSpace, Quantity::VelocityShock] {
            let of = |row: &&serde_json::Value| row["quantity"] == quantity.name();
            let pairs = data["pairs"].as_array().unwrap().iter().filter(of);
            let pairs = pairs.map(|p| (p["bar"].as_str().unwrap(), p["component"].as_str().unwrap()));
            let planned = Pair::planned(quantity).iter().map(|p| (p.bar.name(), p.component.name()));
            assert!(pairs.eq(planned), "run the study again: the pairs of {} have changed", quantity.name());
            for row in data["worth"].as_array().unwrap().iter().filter(of) {
                assert!(row["within"].as_f64() >= Some(0.995), "{row}");
            }
        }
    }

    /// All mass in the middle: shocks of the map grow without end, at no place that is reached.
    #[test]
    fn infinite_errors_and_a_flat_drop_stay_in_the_frame() {
        let part = Suspension::from_hz(100.0, DampingRatio::new(0.0).unwrap()).unwrap();
        for (gyration_m, e, tilt, contact) in
            [(0.0, 0.5, 5.0, None), (0.04, 0.0, 0.0, Some(1e-3)), (0.04, 1.0, 0.0, None)]
        {
            let scene = Scene::new(Body::new(0.14, gyration_m).unwrap(), e, 1.0, tilt, 0.0).unwrap();
            let setup = Setup::new(scene, contact, 0.3, part).unwrap();
            for quantity in [Quantity::PeakAcceleration, Quantity::VelocityShock] {
                let trade = Tradeoff::measure(&setup, quantity).unwrap();
                let svg = panels(&[("an *extreme* <one>".to_owned(), &trade)]);
                stay_within_their_frame(&[("extreme.svg", svg)]);
            }
        }
    }
}
