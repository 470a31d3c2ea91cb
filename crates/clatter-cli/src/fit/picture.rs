//! The picture of measured beside computed.

use clatter_figures::{FitPanel, FitStrike};

use super::Answered;
use crate::Failure;

pub(super) fn draw(answered: &Answered<'_>) -> Result<String, Failure> {
    let fit = &answered.fit;
    let panel = |record: &clatter_assess::fit::RecordFit| {
        if record.curves.is_empty() {
            let measured = record.strikes.iter().map(|strike| FitStrike {
                time_s: strike.measured.time_s - record.first_touch_s,
                end: strike.measured.end,
                is_used: strike.number.is_some(),
            });
            FitPanel::Strikes { measured: measured.collect(), computed: fit.computed.clone() }
        } else {
            let shifted = |curve: &Vec<[f64; 3]>| {
                curve.iter().map(|[time_s, m, c]| [time_s - record.first_touch_s, *m, *c]).collect::<Vec<_>>()
            };
            let curves = record.curves.iter().map(shifted).collect();
            if record.curves.len() == 2 { FitPanel::Heights(curves) } else { FitPanel::Acceleration(curves) }
        }
    };
    let panels: Vec<FitPanel> = fit.records.iter().map(panel).collect();
    Ok(clatter_figures::fit(&panels)?)
}
