//! This module compares records with the computed drop.

use clatter::End;

use super::drop::Drop;
use super::{MeasuredHeights, MeasuredStrike, RecordFit, Set, StrikeFit, Which};

/// Strikes shown beyond the last measured one.
const MORE: usize = 3;

/// Returns the fit of each record.
pub(super) fn records(drop: &Drop<'_>, x: &[f64]) -> Vec<RecordFit> {
    let Some(path) = drop.path(x) else { return Vec::new() };
    let one = |(k, set): (usize, &Set<'_>)| {
        let offset_s = drop.offset_s(x, k);
        let computed = set.computed(drop, &path, offset_s);
        let measured = set.measured();
        #[expect(clippy::cast_precision_loss, reason = "a count of data")]
        let scatter = (measured.iter().zip(&computed).map(|(m, c)| (m - c) * (m - c)).sum::<f64>()
            / measured.len().max(1) as f64)
            .sqrt();
        let mut record = RecordFit {
            first_touch_s: offset_s,
            scatter,
            strikes: Vec::new(),
            missing: Vec::new(),
            curves: Vec::new(),
        };
        match set {
            Set::Strikes { strikes, index, .. } => {
                let mut computed = computed.iter();
                let places: Vec<Option<usize>> =
                    index.iter().map(|which| which.and_then(|which| which.find(drop, &path.motion.strikes))).collect();
                let one =
                    |((&measured, which), place): ((&MeasuredStrike, &Option<Which>), &Option<usize>)| StrikeFit {
                        measured,
                        number: place.map(|place| place + 1),
                        residual_s: which.and_then(|_| computed.next()).map(|time_s| measured.time_s - time_s),
                    };
                record.strikes = strikes.iter().zip(index).zip(&places).map(one).collect();
                record.missing = missing(&places);
            }
            Set::Heights { samples, .. } => {
                let curve = |end: usize| {
                    let at = |(k, s): (usize, &MeasuredHeights)| [s.time_s, s.height_m[end], computed[2 * k + end]];
                    samples.iter().enumerate().map(at).collect()
                };
                record.curves = vec![curve(0), curve(1)];
            }
            #[expect(clippy::cast_precision_loss, reason = "at most 4096")]
            Set::Acceleration { start_s, step_s, .. } => {
                let time = |k: usize| start_s + step_s * k as f64;
                let pairs = measured.iter().zip(&computed).enumerate();
                record.curves = vec![pairs.map(|(k, (measured, computed))| [time(k), *measured, *computed]).collect()];
            }
        }
        record
    };
    drop.sets.iter().enumerate().map(one).collect()
}

/// Numbers of computed strikes before the last measured one that are not among the measured; the place of one that was left out as
/// wrong is not missing.
pub(super) fn missing(places: &[Option<usize>]) -> Vec<usize> {
    let last = places.iter().flatten().max().copied().unwrap_or(0);
    let mut missing: Vec<usize> = (0..last).filter(|n| !places.contains(&Some(*n))).collect();
    for out in (0..places.len()).filter(|&k| places[k].is_none()) {
        let before = places[..out].iter().flatten().max().map_or(0, |before| before + 1);
        missing.retain(|n| *n != before);
    }
    missing.into_iter().map(|n| n + 1).collect()
}

/// Returns the computed strikes that are shown.
pub(super) fn computed(drop: &Drop<'_>, x: &[f64]) -> Vec<(f64, End)> {
    let Some(path) = drop.path(x) else { return Vec::new() };
    let needed = path.motion.strikes.len();
    let more = || {
        let last_s = path.motion.strikes.last().map_or(0.0, |strike| strike.time_s);
        drop.rigid(x, drop.horizon_s().max(last_s + drop.unit_s), |ahead| {
            ahead.struck.iter().sum::<usize>() >= needed + MORE
        })
    };
    let path = if drop.contacts { None } else { more() }.unwrap_or(path);
    path.motion.strikes.iter().map(|strike| (strike.time_s, drop.end(strike.point))).collect()
}
