//! Results over planes and ranges: gain over (q, e), the impact that holds the peak over (Ω, position), zones over Ω.

use super::{impact_of_peak, omegas, suspended_zone, worst};
use clatter::{Bar, Start};
use clatter_shock::{DampingRatio, Error, Suspension};
use rayon::prelude::*;

/// Returns `of(0)`, …, `of(n − 1)`, computed on every core.
fn parallel<T: Send>(n: usize, of: impl Fn(usize) -> Result<T, Error> + Sync + Send) -> Result<Vec<T>, Error> {
    (0..n).into_par_iter().map(of).collect()
}

/// Returns i + ½ over n.
#[expect(clippy::cast_precision_loss, reason = "a small grid")]
fn middle(i: usize, n: usize) -> f64 {
    (i as f64 + 0.5) / n as f64
}

/// The largest gain over one shock of 2 v0, over all parts of a damping ratio, over the plane of bars 0 < q, e < 1.
#[derive(Debug, Clone, PartialEq)]
pub struct GainMap {
    /// Cells along each side; the values are those of their middles.
    pub cells: usize,
    /// Gains row by row, q upward from row to row, e along a row.
    pub gain: Vec<f64>,
    /// Share of the cells with a gain above 1: there some part gets more than drop standards assume.
    pub share_above_1: f64,
    /// Share of the cells where the largest single shock is above 2 v0.
    pub share_of_shocks_above_1: f64,
}

impl GainMap {
    /// Computes [`worst`] at each cell.
    ///
    /// # Errors
    /// The errors of [`worst`].
    pub fn compute(damping: DampingRatio, cells: usize, per_octave: u16) -> Result<Self, Error> {
        let bar = |i: usize| Bar::new(middle(i / cells, cells), middle(i % cells, cells));
        let values = parallel(cells * cells, |i| {
            let bar = bar(i)?;
            Ok((worst(&bar, damping, per_octave)?.gain, bar.summary(&Start::default()).peak.end))
        })?;
        #[expect(clippy::cast_precision_loss, reason = "a small grid")]
        let share = |good: &dyn Fn(&(f64, f64)) -> bool| {
            values.iter().filter(|v| good(v)).count() as f64 / values.len().max(1) as f64
        };
        Ok(Self {
            cells,
            share_above_1: share(&|v| v.0 > 1.0),
            share_of_shocks_above_1: share(&|v| v.1 > 2.0),
            gain: values.into_iter().map(|v| v.0).collect(),
        })
    }
}

/// The impact that the peak acceleration follows, over Ω within [`super::OMEGAS`] (in equal ratios) and the position.
#[derive(Debug, Clone, PartialEq)]
pub struct Holders {
    /// Ω of each column.
    pub omegas: Vec<f64>,
    /// Number of rows; positions are the middles of as many cells from −1, the end that strikes first, to 1.
    pub rows: usize,
    /// Number of the impact, row by row.
    pub impact: Vec<usize>,
    /// Share of the plane (logarithmic in Ω) where the first impact is the worst.
    pub share_of_first: f64,
    /// Number of impacts.
    pub impacts: usize,
}

impl Holders {
    /// Computes [`impact_of_peak`] at each point.
    ///
    /// # Errors
    /// The errors of [`clatter_shock::respond`].
    pub fn compute(bar: &Bar, damping: DampingRatio, per_octave: u16, rows: usize) -> Result<Self, Error> {
        let omegas = omegas(per_octave);
        let columns = omegas.len();
        let values = parallel(rows * columns, |i| {
            let position = 2.0 * middle(i / columns, rows) - 1.0;
            impact_of_peak(bar, position, &Suspension::new(omegas[i % columns], damping)?)
        })?;
        let first = values.iter().filter(|v| v.0 == 1).count();
        let impacts = values.iter().map(|v| v.1).max().unwrap_or(0);
        #[expect(clippy::cast_precision_loss, reason = "a small grid")]
        let share_of_first = first as f64 / values.len().max(1) as f64;
        Ok(Self { omegas, rows, impact: values.into_iter().map(|v| v.0).collect(), share_of_first, impacts })
    }
}

/// The safe zone of a suspended part over its frequency, and that of the paper for comparison.
#[derive(Debug, Clone, PartialEq)]
pub struct SuspendedZones {
    /// Threshold in v0.
    pub threshold: f64,
    /// Ω, within [`super::OMEGAS`].
    pub omegas: Vec<f64>,
    /// Zone by [`suspended_zone`] at each Ω.
    pub zones: Vec<Option<f64>>,
    /// s of Eq. 5, clipped to 1; `None` where there is none.
    pub paper: Option<f64>,
    /// Share of the range (logarithmic in Ω) where some part inside the paper's zone gets more than by one shock of the
    /// threshold.
    pub share_unsafe: f64,
    /// Smallest zone and the Ω of the part.
    pub smallest: (Option<f64>, f64),
}

impl SuspendedZones {
    /// Computes the zones for one bar, threshold and damping ratio.
    ///
    /// # Errors
    /// The errors of [`suspended_zone`].
    pub fn compute(bar: &Bar, threshold: f64, damping: DampingRatio, per_octave: u16) -> Result<Self, Error> {
        let omegas = omegas(per_octave);
        let zones = parallel(omegas.len(), |i| suspended_zone(bar, &Suspension::new(omegas[i], damping)?, threshold))?;
        let s = bar.shocks_either(&Start::default()).safe_zone(threshold).s;
        let paper = (s >= 0.0).then_some(s.min(1.0));
        // Bisection leaves a zone short by 1e-12, and the zone only tends to the stiff limit.
        let short = |zone: &&Option<f64>| paper.is_some_and(|s| zone.unwrap_or(-1.0) < s - 1e-3);
        #[expect(clippy::cast_precision_loss, reason = "a short list")]
        let share_unsafe = zones.iter().filter(short).count() as f64 / zones.len().max(1) as f64;
        let order = |i: &usize, k: &usize| zones[*i].unwrap_or(-1.0).total_cmp(&zones[*k].unwrap_or(-1.0));
        let least = (0..zones.len()).min_by(order).unwrap_or(0);
        let smallest = (zones[least], omegas[least]);
        Ok(Self { threshold, omegas, zones, paper, share_unsafe, smallest })
    }
}
