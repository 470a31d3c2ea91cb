//! Speed for accuracy on scenes to compare with: the four bars of Table 1 and the worked products.

use clatter::paper::DESIGNS;
use clatter_scene::ProductFile;
use clatter_scene::plan::Quantity;
use clatter_scene::tradeoff::{Machine, PartTradeoff, ProductTradeoff, Tradeoff, bars};
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

/// Everything measured.
#[derive(Debug, Serialize)]
struct Trades {
    machine: Machine,
    bars: Vec<BarTrade>,
    products: Vec<ProductTradeoff>,
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
/// [`bars`]) and for every part of the three worked products: `trade.json`, and a figure for each.
///
/// Errors, estimates, counts and choices are the same from run to run, `seconds` and what follows from them (`front`) are of the
/// machine.
///
/// # Errors
/// None in practice: all scenes are valid.
pub fn trade_files() -> Result<Vec<(&'static str, String)>, ReportError> {
    let mut files: Vec<File> = Vec::new();
    let mut trades = Trades { machine: Machine::here(), bars: Vec::new(), products: Vec::new() };
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
