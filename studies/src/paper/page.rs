//! The paper's figures, table and claims: their data and files.

use clatter::design::DESIGNS;
use clatter::{Axis, Bar, End, Map, Quantity};
use clatter_figures::{Sheet, Surface, surface};
use clatter_report::File;
use rayon::prelude::*;

use super::{Claim, Row, claims, table, table1};
use crate::Error;
use crate::contour::{self, SafeZone};
use crate::figures::{Impacts, Zones, impacts, scheme, zones};
use crate::files::pretty;

/// All data of the report.
#[derive(Debug)]
pub(crate) struct Data {
    percussion: f64,
    impacts: Impacts,
    zones: [Zones; 3],
    surfaces: [Surface; 2],
    table1: [Row; 7],
    claims: Vec<Claim>,
}

/// Largest distance of chords from the exact curves, in parts of the unit square: 0.02 pt in print.
const FLATNESS: f64 = 1e-4;
/// Points of a side of the surfaces' grids.
const MESH: usize = 37;
/// Curves of Fig. 2 that are drawn: beyond them they run closer than lines can.
const CURVES: std::ops::RangeInclusive<u32> = 2..=12;
/// Height at which the surfaces are cut.
const CUT: f64 = 6.0;

const BLUE: [[u8; 3]; 2] = [[0xd8, 0xe6, 0xf2], [0x2f, 0x62, 0x94]];
const GREEN: [[u8; 3]; 2] = [[0xdd, 0xe8, 0xd8], [0x5f, 0x86, 0x5c]];
const AMBER: [[u8; 3]; 2] = [[0xf6, 0xea, 0xcf], [0xb8, 0x8a, 0x3c]];

/// Levels of a threshold's figure, as parts of the bar.
fn levels(threshold: f64) -> Vec<f64> {
    let percent: &[f64] = if threshold < 1.0 {
        &[0.0, 2.5, 5.0, 7.5, 10.0, 15.0, 20.0]
    } else if threshold < 2.0 {
        &[0.0, 10.0, 20.0, 25.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 90.0]
    } else {
        &[10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 90.0, 100.0]
    };
    percent.iter().map(|p| p / 100.0).collect()
}

fn zones_of(threshold: f64) -> Zones {
    let zone = SafeZone::new(threshold);
    let levels = levels(threshold).into_par_iter().map(|s| (s, zone.curve(s, FLATNESS))).collect();
    Zones { threshold, levels, designs: DESIGNS }
}

fn sheet(quantity: Quantity, name: &'static str, at: [f64; 2], fill: [[u8; 3]; 2]) -> Result<Sheet, Error> {
    let map = Map::compute(quantity, Axis::q(0.0, 1.0, MESH)?, Axis::e(0.0, 1.0, MESH)?)?;
    Ok(Sheet { map, name, at, fill })
}

/// Returns the sheet at distance `s` from the center (Eq. 4), from that of the ends.
fn at_distance(end: &Sheet, s: f64, name: &'static str, at: [f64; 2], fill: [[u8; 3]; 2]) -> Result<Sheet, Error> {
    let mut map = end.map.clone();
    for (i, line) in map.values.chunks_mut(MESH).enumerate() {
        let share = Bar::new(map.q.value(i), 0.0)?.share(End::B, s);
        for value in line {
            *value = if share == 0.0 { 0.0 } else { share * *value };
        }
    }
    Ok(Sheet { map, name, at, fill })
}

impl Data {
    /// Computes everything, in parallel.
    pub(crate) fn compute() -> Result<Self, Error> {
        let (claims, (zones, rest)) = rayon::join(claims, || {
            rayon::join(
                || [zones_of(0.5), zones_of(1.0), zones_of(2.0)],
                || {
                    let curves = CURVES.map(|n| (n, contour::impacts(n, 160))).collect();
                    let end = sheet(Quantity::PeakEnd, "*s* = 1", [0.45, 0.2], BLUE)?;
                    let quarter = at_distance(&end, 0.5, "*s* = 0.5", [0.93, 0.5], GREEN)?;
                    let center = at_distance(&end, 0.0, "*s* = 0", [0.85, 0.62], AMBER)?;
                    let angular = sheet(Quantity::PeakAngular, "", [0.0, 1.0], BLUE)?;
                    let view = |sheets, axis, title, [azimuth, elevation]: [f64; 2]| Surface {
                        sheets,
                        cut: CUT,
                        axis,
                        title,
                        azimuth,
                        elevation,
                    };
                    let surfaces = [
                        view(
                            vec![angular],
                            "Δ*ω*_{max} in *v*_0/*L*",
                            "Largest change of angular velocity",
                            [38.0, 24.0],
                        ),
                        view(
                            vec![center, quarter, end],
                            "Δ*v*_{max} in *v*_0",
                            "Largest velocity shocks",
                            [150.0, 16.0],
                        ),
                    ];
                    let table1 = table1()?;
                    Ok::<_, Error>((Impacts { curves, endless: contour::endless(160) }, surfaces, table1))
                },
            )
        });
        let (impacts, surfaces, table1) = rest?;
        Ok(Self {
            percussion: Bar::new(0.5, 0.3)?.percussion(End::A),
            impacts,
            zones,
            surfaces,
            table1,
            claims: claims?,
        })
    }

    /// Returns figures as SVG, tables as JSON and CSV.
    pub(crate) fn files(&self) -> Result<Vec<File>, Error> {
        let figures: Vec<File> = vec![
            ("figure-1.svg", scheme(self.percussion)?),
            ("figure-2.svg", impacts(&self.impacts)?),
            ("figure-3.svg", surface(&self.surfaces[0])?),
            ("figure-4.svg", surface(&self.surfaces[1])?),
            ("figure-5.svg", zones(&self.zones[0])?),
            ("figure-6.svg", zones(&self.zones[1])?),
            ("figure-7.svg", zones(&self.zones[2])?),
        ];
        let (table1, claims) = (table::table1(&self.table1), table::claims(&self.claims));
        let tables = [
            ("table-1.json", pretty(&table1)?),
            ("table-1.csv", table1.csv()),
            ("claims.json", pretty(&claims)?),
            ("claims.csv", claims.csv()),
        ];
        Ok(figures.into_iter().chain(tables).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::stay_within_their_frame;

    #[test]
    fn figures_stay_within_their_frame() {
        stay_within_their_frame(&Data::compute().unwrap().files().unwrap());
    }
}
