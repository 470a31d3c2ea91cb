//! This module makes a fit, from records to the report.

use std::cell::Cell;
use std::rc::Rc;

use clatter::End;

use super::criterion::{Faults, variances_differ};
use super::drop::{DATA, Drop, FLIGHTS};
use super::join::{is_same, join};
use super::matching::CHANCE;
use super::records::records;
use super::report::report;
use super::set::{sets, unit_s};
use super::starts::ONSET;
use super::told::{self, DeterminedFit};
use super::{Error, Fit, Known, Measured, RecordFit, Set, matching};
use clatter_product::First;

/// Strikes that are off by this share of the mean time between them are not explained, nor heights by this share of the length.
const FAR_OFF: f64 = 0.1;
/// Nor accelerations of which half is left: a sensor on a case that rings is off by less.
const FAR_OFF_ACCELERATION: f64 = 0.5;
/// The number of samples before the first touch that determine the noise.
const QUIET: usize = 16;
/// Heights that are off by this share of the length, 0.3 mm of 140 mm, are met, and the other end is not tried.
const MET: f64 = 0.002;

/// Finds the drop that is nearest to what was measured, what the data tell of it, and what they do not.
///
/// All records are of one drop; the time axis of each begins anywhere. The method is described in the [module](crate::fit).
///
/// # Validity
/// A rigid bar on hard, level ground without friction; one restitution at any speed. Strikes are distinguished where they are missing
/// or wrong as the module says. Contacts take time in the fit where the product file gives their time or an acceleration was
/// measured; else impacts are instant, at real tilt and with gravity.
///
/// # Accuracy
/// The intervals of 95 % hold the truth in 93 to 97 of 100 synthetic drops with normal noise, for strikes with instant
/// impacts where both ends have one restitution (`tests/fit`); less often where they differ and the timing is not given, see
/// [the module](super). Of accelerations ten synthetic drops are explained to 1 % or refused. Intervals know of noise alone: a bar that
/// bends, an edge that is not flat or slides, or a restitution that is another one in the next drop is not in them.
///
/// # Errors
/// [`Error`] for what [`Known::check`] refuses, for values that are no times, heights or accelerations, for too many or too few of them,
/// and where no computed drop has the strikes that were measured.
///
/// # Examples
/// The paper's reference bar (q = ½, e = 0.3) with a gap of 2 ms times the speed: its four strikes are at 0, 1.212,
/// 1.683 and 34.386 ms.
/// ```
/// use clatter::End;
/// use clatter_product::First;
/// use clatter_fit::{Known, Measured, MeasuredStrike, Quantity, fit};
/// use clatter_flight::{Body, ContactLaw};
/// let known = Known {
///     gyration_m: [0.0433; 2],
///     body: Body::new(0.15, 0.15 / 12_f64.sqrt())?,
///     gyration_known: true,
///     first: First::End(End::A),
///     gravity_m_s2: 0.0,
///     restitution: [0.2, 0.5],
///     speed_m_s: [0.3, 0.5],
///     tilt_rad: [0.0, 0.05],
///     contact_time_s: None,
///     contact_law: ContactLaw::Hysteretic,
/// };
/// let mut train = clatter::Bar::new(0.5, 0.3)?.train(&clatter::Start::default());
/// let strikes = train.map(|s| MeasuredStrike { time_s: 2e-3 * s.time, end: Some(s.end) }).collect();
/// let found = fit(&known, &[Measured::Strikes { strikes, deviation_s: Some(1e-6) }])?;
/// let e = found.estimates.iter().find(|estimate| estimate.quantity == Quantity::Restitution).unwrap();
/// assert!((e.value - 0.3).abs() < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn fit(known: &Known, measured: &[Measured]) -> Result<Fit, Error> {
    known.check()?;
    let sets = sets(known, measured)?;
    let is_given = |one: &Measured| match one {
        Measured::Strikes { deviation_s, .. } => deviation_s.is_some(),
        Measured::Heights { deviation_m, .. } => deviation_m.is_some(),
        Measured::Acceleration { .. } => false,
    };
    let given = measured.iter().all(is_given);
    let contacts = known.contact_time_s.is_some() || sets.iter().any(|set| matches!(set, Set::Acceleration { .. }));
    let unit_s = unit_s(&sets);
    let (mut all, mut refused) = (Vec::new(), None);
    let firsts = firsts(known, measured);
    // An explanation of the record with one end is a start for the other: for the first one too, once more, where it had no explanation.
    let (mut hints, mut explained): (Vec<Vec<f64>>, Vec<End>) = (Vec::new(), Vec::new());
    for (k, &first) in firsts.iter().chain(firsts).enumerate() {
        if k >= firsts.len() && (hints.is_empty() || explained.contains(&first)) {
            continue;
        }
        let count: usize = sets.iter().map(Set::len).sum();
        let kind = usize::from(contacts);
        let left = Rc::new(Cell::new(FLIGHTS[kind] * DATA[kind] / count.max(DATA[kind])));
        let (sets, ranged) = (sets.clone(), Vec::new());
        let drop = Drop { known, sets, first, contacts, unit_s, is_rough: false, ranged, scatter: 1.0, left };
        match explanations(&drop, measured, given, &hints) {
            Ok((of_first, is_plain)) => {
                if of_first.iter().all(|(_, told)| told.faults == 0 && told.excess.is_none()) {
                    explained.push(first);
                    let of_one = of_first.iter().filter(|_| measured.len() == 1);
                    hints.extend(of_one.map(|(_, told)| told.minimum.x.clone()));
                }
                all.extend(of_first);
                // The end that was measured first, or that is lower as the product lands, and that explains all is the one.
                if is_plain {
                    break;
                }
            }
            Err(error) => refused = refused.or(Some(error)),
        }
    }
    // A strike is left out or missing only where neither end explains them all.
    if !explained.is_empty() {
        all.retain(|(_, told)| told.faults == 0);
    }
    let order = |a: &(Drop<'_>, DeterminedFit), b: &(Drop<'_>, DeterminedFit)| {
        let is_odd = |told: &DeterminedFit| told.excess.is_some();
        is_odd(&a.1).cmp(&is_odd(&b.1)).then(a.1.score.above(&b.1.score).total_cmp(&0.0))
    };
    all.sort_by(order);
    // Of those that are about as good, the one comes first that drops and invents least, then the one within the ranges of the file.
    if let Some((_, best)) = all.first() {
        let (best, beyond) = (best.clone(), all[0].0.beyond(&best.minimum.x));
        all.retain(|(drop, told)| {
            let is_within = told.excess.is_none() && drop.beyond(&told.minimum.x) < beyond;
            best.excess.is_some() || told.is_about_as_good(&best) || is_within
        });
        all.sort_by_key(|(drop, told)| (told.faults, drop.beyond(&told.minimum.x)));
    }
    let Some((best, others)) = all.split_first() else { return Err(refused.unwrap_or(Error::Nothing)) };
    if let Some(factor) = best.1.excess {
        return Err(Error::Scatter { record: best.0.worst(&best.1.minimum.x) + 1, factor });
    }
    let mut fit = report(&best.0, &best.1);
    for (k, (record, set)) in fit.records.iter().zip(&best.0.sets).enumerate() {
        near(k + 1, record, set, &best.0)?;
        if !is_told_by_noise(k + 1, record, set)? {
            fit.notes.push(
                "before the first touch nothing tells the noise: whether this drop explains the record is not tested"
                    .into(),
            );
        }
    }
    let others = others.iter().map(|(drop, told)| report(drop, told));
    let others: Vec<Fit> = others.filter(|other| !is_same(&fit, other)).collect();
    join(&mut fit, others);
    Ok(fit)
}

/// Refuses a drop that does not come near what was measured: intervals about it would say nothing of the product.
fn near(number: usize, found: &RecordFit, set: &Set, drop: &Drop<'_>) -> Result<(), Error> {
    let root_mean_square = |curve: &Vec<[f64; 3]>| {
        #[expect(clippy::cast_precision_loss, reason = "at most a million")]
        let count = curve.len().max(1) as f64;
        (curve.iter().map(|[_, measured, _]| measured * measured).sum::<f64>() / count).sqrt()
    };
    let (unit, allowed, what, of) = match set {
        Set::Strikes { .. } => (drop.unit_s, FAR_OFF, "strikes", "the mean time between them"),
        Set::Heights { .. } => (drop.known.body.length_m(), FAR_OFF, "heights", "the length"),
        Set::Acceleration { .. } => {
            let size = found.curves.iter().map(root_mean_square).fold(0.0, f64::max);
            (size, FAR_OFF_ACCELERATION, "accelerations", "the measured ones")
        }
    };
    if found.scatter <= allowed * unit {
        return Ok(());
    }
    Err(Error::Far { record: number, name: what, percent: 100.0 * found.scatter / unit, of, allowed: 100.0 * allowed })
}

/// Returns whether a record tells its noise, so that the drop was tested to explain it: accelerations by what they are before the first
/// touch, other records always.
///
/// # Errors
/// [`Error::Noise`] where the drop leaves more than that noise, by the test of two variances.
fn is_told_by_noise(record: usize, found: &RecordFit, set: &Set) -> Result<bool, Error> {
    let (Set::Acceleration { step_s, .. }, [curve]) = (set, &found.curves[..]) else { return Ok(true) };
    // The sample at the touch may hold some of the first press; and what was found may touch later than what was measured.
    let largest = curve.iter().fold(0.0_f64, |most, [_, measured, _]| most.max(measured.abs()));
    let is_before = |at: &&[f64; 3]| at[0] < found.first_touch_s - step_s && at[1].abs() < ONSET * largest;
    let quiet: Vec<f64> = curve.iter().take_while(is_before).map(|[_, measured, _]| *measured).collect();
    #[expect(clippy::cast_precision_loss, reason = "at most a million")]
    let [all, count] = [curve.len() as f64, quiet.len() as f64];
    let noise = (quiet.iter().map(|value| value * value).sum::<f64>() / count).sqrt();
    if quiet.len() < QUIET || noise == 0.0 {
        return Ok(false);
    }
    let factor = found.scatter / noise;
    if variances_differ(factor * factor, [all, count]) < CHANCE {
        return Err(Error::Noise { record, factor });
    }
    Ok(true)
}

/// Finds the explanations of the data if a given end touches first, and whether there is no need to try the other.
fn explanations<'a>(
    drop: &Drop<'a>,
    measured: &[Measured],
    given: bool,
    hints: &[Vec<f64>],
) -> Result<(Vec<(Drop<'a>, DeterminedFit)>, bool), Error> {
    let (mut matched, mut is_plain) = (Vec::new(), false);
    for (k, one) in measured.iter().enumerate() {
        if let Measured::Strikes { strikes, deviation_s } = one {
            let found = matching::find(drop, k, deviation_s.is_some(), hints)?;
            is_plain |= found.iter().all(|one| one.is_plain) && strikes[0].end.is_some();
            matched.push((k, found));
        }
    }
    // The best of each record, and each other one in its place.
    let mut choices = vec![vec![0; matched.len()]];
    for (i, (_, found)) in matched.iter().enumerate() {
        choices.extend((1..found.len()).map(|j| (0..matched.len()).map(|k| if k == i { j } else { 0 }).collect()));
    }
    let mut all = Vec::new();
    for choice in choices {
        let (mut drop, mut begin, mut faults) = (drop.clone(), None, Faults::default());
        for ((set, found), j) in matched.iter().zip(choice) {
            if let Set::Strikes { index, .. } = &mut drop.sets[*set] {
                index.clone_from(&found[j].index);
            }
            begin = (measured.len() == 1).then(|| (found[j].x.clone(), found[j].freed));
            faults = faults.and(found[j].faults);
        }
        let told = told::find(&mut drop, given, begin, faults)?;
        let heights = drop.sets.iter().all(|set| matches!(set, Set::Heights { .. }));
        let met = MET * drop.known.body.length_m();
        is_plain |= heights && records(&drop, &told.minimum.x).iter().all(|record| record.scatter < met);
        all.push((drop, told));
    }
    Ok((all, is_plain))
}

/// Returns the ends that may touch first: both where it matters and nothing says which.
fn firsts(known: &Known, measured: &[Measured]) -> &'static [End] {
    let named = measured.iter().find_map(|one| match one {
        Measured::Strikes { strikes, .. } => strikes.first().and_then(|strike| strike.end),
        // The end that is lower the first time that one turns upward.
        Measured::Heights { samples, .. } => samples.windows(3).find_map(|three| {
            let turns =
                |i: usize| three[1].height_m[i] <= three[0].height_m[i] && three[1].height_m[i] < three[2].height_m[i];
            let [a, b] = three[1].height_m;
            (turns(0) && a <= b).then_some(End::A).or((turns(1) && b < a).then_some(End::B))
        }),
        Measured::Acceleration { .. } => None,
    });
    let symmetric = {
        let [a, b] = known.body.arms_m();
        (a - b).abs() <= 1e-12 * (a + b)
    };
    let all_named = measured.iter().all(
        |one| matches!(one, Measured::Strikes { strikes, .. } if strikes.iter().all(|strike| strike.end.is_some())),
    );
    let times_alone = measured.iter().all(|one| matches!(one, Measured::Strikes { .. }));
    match (known.first, named) {
        (First::End(End::A), _) => &[End::A],
        (First::End(End::B), _) => &[End::B],
        (First::Either, None) if symmetric && times_alone => &[End::A],
        // Where all ends are known, the one that was measured first is the one that touches first.
        (First::Either, Some(End::A)) if all_named => &[End::A],
        (First::Either, Some(End::B)) if all_named => &[End::B],
        (First::Either, Some(End::B)) => &[End::B, End::A],
        (First::Either, _) => &[End::A, End::B],
    }
}
