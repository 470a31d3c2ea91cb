//! Effects of a plate that lands on its corners, beyond those of a bar: the data of the plate report, and its files.

pub(crate) mod bars;
mod claims;
pub(crate) mod directions;
mod products;
pub(crate) mod ties;

use clatter::design::DESIGNS;
use clatter::{Atlas, Bar, Plate, Start};
use clatter_report::File;
use rayon::prelude::*;
use serde_json::{Value, json};

use crate::Error;
use crate::figures::plates;
use crate::files::{decimals, pretty};
use crate::paper::{Claim, table};
use bars::{BarsAndPlate, STRIKES};
use directions::{Counts, Endless, endless_on_the_diagonal, endless_round_the_corners, letters, share};
use ties::Ties;

pub use claims::plate_claims;

/// Restitution used where one value is enough: that of the paper's reference design.
pub(crate) const E: f64 = 0.3;
/// Steps of e, of curves and of the map of counts.
const STEPS: u16 = 50;
const ROWS: u16 = 120;
/// Steps of α and β from 1 to 10, of curves and of the plane.
const INERTIAS: u16 = 27;
const CELLS: u16 = 45;
/// Restitutions of the curves over α = β.
const CURVES: [f64; 3] = [0.1, E, 0.5];

/// Returns uniform plates over e, from 0.02 to 1.
pub(crate) fn over_e() -> Result<Vec<BarsAndPlate>, Error> {
    let plate = |k: u16| BarsAndPlate::new([3.0; 2], f64::from(k) / f64::from(STEPS));
    (1..=STEPS).into_par_iter().map(plate).collect()
}

/// Returns α or β from 1 to 10.
fn inertia(k: u16, steps: u16) -> f64 {
    1.0 + 9.0 * f64::from(k) / f64::from(steps)
}

/// Returns plates over α and β at [`E`], α fastest.
pub(crate) fn plane() -> Result<Vec<BarsAndPlate>, Error> {
    let side = CELLS + 1;
    let plate = |k: u16| BarsAndPlate::new([inertia(k % side, CELLS), inertia(k / side, CELLS)], E);
    (0..side * side).into_par_iter().map(plate).collect()
}

/// All data of the report.
#[derive(Debug)]
pub(crate) struct Data {
    over_e: Vec<BarsAndPlate>,
    over_inertia: [Vec<BarsAndPlate>; 3],
    plane: Vec<BarsAndPlate>,
    designs: [BarsAndPlate; 4],
    atlas: Atlas,
    counts: Counts,
    bar_strikes: usize,
    endless: [Endless; 2],
    ties: Ties,
    claims: Vec<Claim>,
}

/// Returns every number on the page of [`Report::Plate`](crate::Report::Plate) apart from its claims, as it is printed:
/// the file `plate.json`.
///
/// # Errors
/// None in practice: all plates are valid.
pub fn plate_numbers() -> Result<String, Error> {
    pretty(&Data::compute()?.numbers()?)
}

impl Data {
    /// Computes everything.
    pub(crate) fn compute() -> Result<Self, Error> {
        let alike = |e| {
            let plate = |k| BarsAndPlate::new([inertia(k, INERTIAS); 2], e);
            (0..=INERTIAS).into_par_iter().map(plate).collect::<Result<Vec<_>, Error>>()
        };
        let design = |[q, e]: [f64; 2]| BarsAndPlate::new([(1.0 + q) / (1.0 - q); 2], e);
        let ([a, b, c, d], [dead, usual, bouncy]) = (DESIGNS.map(design), CURVES.map(alike));
        let (over_e, plane) = (over_e()?, plane()?);
        Ok(Self {
            over_inertia: [dead?, usual?, bouncy?],
            designs: [a?, b?, c?, d?],
            atlas: Plate::uniform(E)?.atlas(STRIKES)?,
            counts: Counts::compute(ROWS)?,
            bar_strikes: Bar::new(DESIGNS[0][0], E)?.train(&Start::default()).count(),
            endless: [endless_on_the_diagonal()?, endless_round_the_corners()?],
            ties: Ties::compute()?,
            claims: claims::claims(&over_e, &plane)?,
            over_e,
            plane,
        })
    }

    /// Returns figures as SVG, numbers and claims as JSON and CSV.
    pub(crate) fn files(&self) -> Result<Vec<File>, Error> {
        let claims = table::claims(&self.claims);
        Ok(vec![
            ("plate-shocks.svg", plates::shocks(&self.over_e)?),
            ("plate-zones.svg", plates::zones(&self.over_e)?),
            ("plate-inertia.svg", plates::inertia(&self.over_inertia)?),
            ("plate-plane.svg", plates::plane(&self.plane)?),
            ("plate-atlas.svg", plates::atlas(&self.atlas, self.bar())?),
            ("plate-counts.svg", plates::counts(&self.counts)?),
            ("plate-ties.svg", plates::over_direction(&self.ties)?),
            ("plate-gaps.svg", plates::over_gap(&self.ties, self.bar())?),
            ("plate.json", pretty(&self.numbers()?)?),
            ("plate-claims.json", pretty(&claims)?),
            ("plate-claims.csv", claims.csv()),
        ])
    }

    /// Returns the ends of the paper's bar, and of one along the diagonal, that stand for the uniform plate at [`E`].
    fn bar(&self) -> [f64; 2] {
        let [reference, ..] = self.designs;
        [reference.bar[0], reference.diagonal]
    }

    /// Returns every number on the page.
    fn numbers(&self) -> Result<Value, Error> {
        let percent = |share: f64| decimals(100.0 * share, 1);
        let row = |plate: &BarsAndPlate| {
            json!({
                "e": plate.e,
                "corner": decimals(plate.corner, 3), "end": decimals(plate.bar[0], 3),
                "over_end": decimals(plate.corner / plate.bar[0], 3),
                "middle": decimals(plate.middle, 3), "center": decimals(plate.bar[1], 3),
                "over_center": decimals(plate.middle / plate.bar[1], 3),
                "plan": plate.plan.map(percent), "length": plate.length.map(percent),
            })
        };
        // The first is the uniform plate at E.
        let designs = self.designs.iter().zip(DESIGNS).map(|(plate, [q, e])| {
            let mut row = row(plate);
            (row["q"], row["e"]) = (q.into(), e.into());
            row
        });
        // The range is over all plates of the plane: the least, the largest and the plate that has it.
        let range = |of: fn(&BarsAndPlate) -> f64| {
            let plates = self.plane.iter().map(|plate| (of(plate), plate.inertia));
            let least = plates.clone().fold(f64::INFINITY, |least, one| least.min(one.0));
            let most = plates.fold((0.0, [0.0; 2]), |most, one| if one.0 > most.0 { one } else { most });
            let (ratio, [alpha, beta]) = most;
            let [more, less] = [alpha.max(beta), alpha.min(beta)].map(|x| decimals(x, 1));
            json!({ "least": decimals(least, 2), "ratio": decimals(ratio, 2), "larger": more, "smaller": less })
        };
        let alike = self.over_inertia.iter().flatten().map(|plate| plate.corner / plate.diagonal - 1.0);
        let products = products::rows()?;
        Ok(json!({
            "e": E, "strikes": STRIKES,
            "uniform": self.over_e.iter().filter(|p| [0.1, 0.2, 0.3, 0.5, 0.7].contains(&p.e)).map(row).collect::<Vec<_>>(),
            "designs": designs.skip(1).collect::<Vec<_>>(),
            "over_bar": range(|plate| plate.corner / plate.bar[0]),
            "over_diagonal": range(|plate| plate.corner / plate.diagonal),
            "alike": decimals(100.0 * alike.fold(0.0, f64::max), 1),
            "no_zone": self.figure("plate").zip(self.figure("no zone within v₀/2 from e, bar")).map(|(own, bar)| json!([own, bar])),
            "words": self.words(),
            "counts": self.count_numbers(),
            "endless": self.endless.map(|e| json!({ "closed": decimals(e.closed, 6), "measured": decimals(e.measured, 6) })),
            "ties": self.tie_numbers(),
            "bar_off": decimals(100.0 * products::most_off(&products), 0),
            "products": products.iter().map(products::Row::json).collect::<Vec<_>>(),
        }))
    }

    /// Returns a measured figure of the claims by its name, with two decimals.
    fn figure(&self, what: &str) -> Option<String> {
        let mut figures = self.claims.iter().flat_map(|claim| &claim.measured);
        figures.find(|figure| figure.what == what).map(|figure| decimals(figure.value, 2))
    }

    /// Returns the words from r = 0 to the diagonal; those beyond are their mirror images.
    fn words(&self) -> Vec<Value> {
        let half = self.atlas.words().iter().filter(|word| word.from < 0.5);
        let word = |word: &clatter::Word| {
            let same = |corners: &[clatter::Corner]| corners == word.corners;
            json!({
                "from": decimals(word.from, 4), "to": decimals(word.to, 4), "word": letters(&word.corners),
                // The share includes the mirror image on a square plate; the middle word is its own.
                "share": decimals(100.0 * share(&self.atlas, 1.0, same) * if word.to > 0.5 { 1.0 } else { 2.0 }, 1),
                "corner": decimals(word.peak(), 3), "center": decimals(word.center, 3),
                "struck": word.struck.map(|shock| decimals(shock, 2)),
            })
        };
        half.map(word).collect()
    }

    fn count_numbers(&self) -> Value {
        let share = |is: &dyn Fn(Option<usize>) -> bool| decimals(100.0 * self.counts.share(is), 0);
        let strikes = self.atlas.words().iter().map(|word| word.corners.len());
        json!({
            "six_seven": share(&|n| matches!(n, Some(6 | 7))), "open": share(&|n| n.is_none()),
            "plate": [strikes.clone().min(), strikes.max()], "bar": self.bar_strikes,
        })
    }

    fn tie_numbers(&self) -> Value {
        let ties = &self.ties;
        let rigid = ties.rigid.iter().fold(0.0_f64, |most, word| most.max(word[2]));
        let laws = [0, 1].map(|law| {
            let (gap, shock) = ties.worst(law);
            // From here on the worst of all directions stays within 2 % of the rigid one.
            let off = ties.over_gap[law].iter().rposition(|(_, shock)| (shock / rigid - 1.0).abs() > 0.02);
            let settled = off.and_then(|k| ties.over_gap[law].get(k + 1));
            json!({
                "acceleration_over_rigid": decimals(100.0 * (ties.peaks[law] / rigid - 1.0), 0),
                "worst": decimals(shock, 2), "gap": decimals(gap, 1), "over_rigid": decimals(100.0 * (shock / rigid - 1.0), 0),
                "settled": settled.map(|(gap, _)| decimals(*gap, 0)),
            })
        });
        let edge =
            ties.edge.iter().map(|(name, shocks)| json!({ "name": name, "shocks": shocks.map(|x| decimals(x, 2)) }));
        json!({
            "rigid": decimals(rigid, 2), "laws": laws, "edge": edge.collect::<Vec<_>>(),
        })
    }
}

#[cfg(test)]
mod tests {
    use std::sync::LazyLock;

    use super::*;

    static DATA: LazyLock<Data> = LazyLock::new(|| Data::compute().unwrap());

    #[test]
    fn figures_stay_within_their_frame() {
        crate::frame::stay_within_their_frame(&DATA.files().unwrap());
    }

    #[test]
    fn every_worst_case_on_the_page_is_proven() {
        let data = &*DATA;
        let all = data.over_e.iter().chain(&data.plane).chain(data.over_inertia.iter().flatten()).chain(&data.designs);
        for plate in all {
            assert!(plate.later <= plate.corner, "{plate:?}");
        }
    }
}
