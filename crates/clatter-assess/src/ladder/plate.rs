//! The rungs of a plate: the bar along its length, the plate of small tilt, the box with full rotation.

use super::{FINER, Groups, Ladder, Measured, Reference, Rung, cheapest, percent, time, with};
use crate::engine::{Answer, Part, answer, of_followed};
use crate::model::follow;
use clatter_flight::{Drop, Followed, Until};
use clatter_product::{Error, Limit, Model};

/// The time until which a box is followed, over the time of the peak that the plate of small tilt has.
pub(super) const BEYOND_PEAK: f64 = 1.5;
/// A box is left where later presses do less than this share of the largest.
pub(super) const BLOCK: f64 = 1e-3;

impl Ladder {
    pub(super) fn of_plate(drop: &Drop, part: &Part, limit: &Limit, tolerance: f64) -> Result<Self, Error> {
        let bar = (drop.along_length(), along_length(part));
        let peak = of_followed(&follow(drop, Model::Compliant, tolerance, Until::Over)?, part, limit)?;
        // All are followed as far, and once.
        let until_s = (BEYOND_PEAK * peak.time_s).max(drop.clatter_s());
        let as_block = || Ok(Followed::as_block(drop, tolerance, until_s)?);
        let until = |drop| follow(drop, Model::Compliant, tolerance, Until::Past(until_s));
        let block = as_block().and_then(|block| of_followed(&block, part, limit)).ok();
        let (fullest, exact) = match block {
            Some(block) => (Rung::Block, block),
            None => (Rung::Plate, answer(drop, part, limit, Model::Compliant, FINER * tolerance)?),
        };
        let measure = |model, part: &Part, follow: &dyn Fn() -> Result<Followed, Error>| {
            measured(model, follow, part, limit, &exact)
        };
        let mut models =
            vec![measure(Rung::Bar, &bar.1, &|| until(&bar.0))?, measure(Rung::Plate, part, &|| until(drop))?];
        if block.is_some() {
            models.push(measure(Rung::Block, part, &as_block)?);
        }
        let groups = Groups::of(drop, part)?;
        let cheapest = cheapest(&models, tolerance).unwrap_or(fullest);
        let steep = with("real tilt counts", "φ²", Some(groups.geometry));
        let reason = reason(&models, cheapest, tolerance, &groups, steep);
        let worked_out = if block.is_some() { BLOCK } else { FINER * tolerance };
        let reference = Reference { model: fullest, value: exact.value, tolerance: worked_out };
        Ok(Self { unit: exact.unit, reference, models, cheapest, reason, groups })
    }
}

/// Returns the part in the bar along the length.
pub(super) fn along_length(part: &Part) -> Part {
    Part::new(part.place.at_m[0], part.suspension)
}

/// Measures a body on the drop, next to the exact answer.
pub(super) fn measured(
    model: Rung,
    follow: &dyn Fn() -> Result<Followed, Error>,
    part: &Part,
    limit: &Limit,
    exact: &Answer,
) -> Result<Measured, Error> {
    let (found, seconds) = time::measured(|| of_followed(&follow()?, part, limit))?;
    let error = (found.utilization() / exact.utilization() - 1.0).abs();
    let strikes = follow()?.struck_s().len();
    Ok(Measured { model, value: found.value, error, seconds, strikes })
}

/// Returns the physics that the next cheaper body lacks; of the plate the given text.
pub(super) fn reason(models: &[Measured], cheapest: Rung, tolerance: f64, groups: &Groups, of_plate: String) -> String {
    let Some(coarser) = models.iter().rfind(|m| m.model < cheapest && m.error > tolerance) else {
        let off = models.iter().find(|m| m.model == cheapest).map_or(f64::INFINITY, |m| m.error);
        return match cheapest {
            Rung::Bar => format!(
                "{}; bar is off by {}",
                with("its width does nothing here", "h_y/h_x", groups.across),
                percent(off)
            ),
            model => format!("{} is the cheapest here", model.name()),
        };
    };
    let lacks = match coarser.model {
        Rung::Bar => with("it turns about its length too, as no bar does", "h_y/h_x", groups.across),
        _ => of_plate,
    };
    format!("{}; {} is off by {}", lacks, coarser.model.name(), percent(coarser.error))
}
