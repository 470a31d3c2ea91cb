//! A fit, from records to what is told of it.

use std::cell::Cell;
use std::rc::Rc;

use clatter::End;
use clatter_flight::Body;

use super::criterion::{Faults, SIMILAR};
use super::drop::{CONTACT, DATA, DIFFERENCE, Drop, FLIGHTS, GAP_TIME, GYRATION, OFFSET, RESTITUTION, SPEED, SPIN};
use super::matching::SUSPECT;
use super::region::{Function, Region};
use super::set::{sets, unit_s};
use super::told::{self, Told};
use super::{
    Error, Estimate, Explanation, Fit, Known, Measured, MeasuredStrike, Quantity, RecordFit, Set, StrikeFit, Untold,
    Which, matching,
};
use crate::{First, Model};

/// Strikes that are off by this share of the mean time between them are not explained, nor heights by this share of the length.
const FAR_OFF: f64 = 0.1;
/// Nor accelerations of which half is left: a sensor on a case that rings is off by less.
const FAR_OFF_ACCELERATION: f64 = 0.5;
/// Heights that are off by this share of the length, 0.3 mm of 140 mm, are met, and the other end is not tried.
const MET: f64 = 0.002;
/// Strikes shown beyond the last measured one.
const MORE: usize = 3;

/// Finds the drop that is nearest to what was measured, what the data tell of it, and what they do not.
///
/// All records are of one drop; the time axis of each begins anywhere. The method is told in the [module](crate::fit).
///
/// # Validity
/// A rigid bar on hard, level ground without friction; one restitution at any speed. Strikes are told apart where they are missing
/// or wrong as the module says. Contacts take time in the fit where the product file gives their time or an acceleration was
/// measured; else impacts are instant, at real tilt and with gravity.
///
/// # Accuracy
/// The intervals of 95 % hold the truth in 93 to 97 of 100 synthetic drops with normal noise, for strikes with instant
/// impacts where both ends have one restitution (`tests/fit`); less often where they differ and the timing is not given, see
/// [the module](super). Of accelerations it is not established. Intervals know of noise alone: a bar that bends, an edge that is not flat
/// or slides, or a restitution that is another one in the next drop is not in them.
///
/// # Errors
/// [`Error`] for values that are no times, heights or accelerations, for too many or too few of them, and where no computed drop
/// has the strikes that were measured.
///
/// # Examples
/// The paper's reference bar (q = ½, e = 0.3) with a gap of 2 ms times the speed: its four strikes are at 0, 1.212,
/// 1.683 and 34.386 ms.
/// ```
/// use clatter::End;
/// use clatter_assess::First;
/// use clatter_assess::fit::{Known, Measured, MeasuredStrike, Quantity, fit};
/// use clatter_flight::{Body, ContactLaw};
/// let known = Known {
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
    for &first in firsts(known, measured) {
        let count: usize = sets.iter().map(Set::len).sum();
        let kind = usize::from(contacts);
        let left = Rc::new(Cell::new(FLIGHTS[kind] * DATA[kind] / count.max(DATA[kind])));
        let (sets, ranged) = (sets.clone(), Vec::new());
        let drop = Drop { known, sets, first, contacts, unit_s, is_rough: false, ranged, scatter: 1.0, left };
        match explanations(&drop, measured, given) {
            Ok((of_first, is_plain)) => {
                all.extend(of_first);
                // The end that was measured first, or that is lower as the product lands, and that explains all is the one.
                if is_plain {
                    break;
                }
            }
            Err(error) => refused = refused.or(Some(error)),
        }
    }
    let order = |a: &(Drop<'_>, Told), b: &(Drop<'_>, Told)| {
        let is_odd = |told: &Told| told.excess.is_some();
        is_odd(&a.1).cmp(&is_odd(&b.1)).then(a.1.score.above(&b.1.score).total_cmp(&0.0))
    };
    all.sort_by(order);
    let Some((best, others)) = all.split_first() else { return Err(refused.unwrap_or(Error::Nothing)) };
    if let Some(factor) = best.1.excess {
        return Err(Error::Scatter { record: best.0.worst(&best.1.minimum.x) + 1, factor });
    }
    let mut fit = report(&best.0, &best.1);
    for (k, (record, set)) in fit.records.iter().zip(&best.0.sets).enumerate() {
        near(k + 1, record, set, &best.0)?;
    }
    let about_as_good =
        |(_, told): &&(Drop<'_>, Told)| told.excess.is_none() && told.score.above(&best.1.score) <= SIMILAR;
    let others = others.iter().filter(about_as_good).map(|(drop, told)| report(drop, told));
    let others: Vec<Fit> = others.filter(|other| !is_same(&fit, other)).collect();
    join(&mut fit, others);
    Ok(fit)
}

/// Whether two fits take the strikes for the same and tell the same: the search of one ended a little aside.
fn is_same(fit: &Fit, other: &Fit) -> bool {
    let numbers = |fit: &Fit| -> Vec<Option<usize>> {
        fit.records.iter().flat_map(|record| record.strikes.iter().map(|strike| strike.number)).collect()
    };
    let holds = |(a, b): (&Estimate, &Estimate)| {
        a.quantity == b.quantity && a.interval.is_none_or(|[lo, hi]| (lo..=hi).contains(&b.value))
    };
    fit.first == other.first
        && numbers(fit) == numbers(other)
        && fit.estimates.len() == other.estimates.len()
        && fit.estimates.iter().zip(&other.estimates).all(holds)
}

/// Widens intervals to hold those of other fits that are about as good, and says which these are.
fn join(fit: &mut Fit, others: Vec<Fit>) {
    let is_restitution =
        |quantity| matches!(quantity, Quantity::Restitution | Quantity::RestitutionA | Quantity::RestitutionB);
    for estimate in &mut fit.estimates {
        let is_same = |other: &&Estimate| {
            // One restitution is that of both ends.
            let both = [other.quantity, estimate.quantity];
            both[0] == both[1] || both.contains(&Quantity::Restitution) && both.into_iter().all(is_restitution)
        };
        let found = others.iter().flat_map(|other| other.estimates.iter().filter(is_same));
        let found: Vec<[f64; 2]> = found.filter_map(|other| other.interval).collect();
        let wider = |[lo, hi]: [f64; 2]| found.iter().fold([lo, hi], |[lo, hi], [a, b]| [lo.min(*a), hi.max(*b)]);
        estimate.interval = estimate.interval.map(wider);
    }
    fit.others = others.into_iter().map(|fit| Explanation::of(fit)).collect();
    if !fit.others.is_empty() {
        let said: Vec<String> = fit.others.iter().map(Explanation::said).collect();
        fit.notes.push(format!(
            "other explanations are about as good: {}; the intervals hold those of all of them",
            said.join(", or ")
        ));
    }
}

impl Explanation {
    fn of(fit: Fit) -> Self {
        let left_out = |record: &RecordFit| {
            let out = record.strikes.iter().filter(|strike| strike.number.is_none());
            out.map(|strike| strike.measured.time_s).collect()
        };
        Self {
            first: fit.first,
            left_out_s: fit.records.iter().map(left_out).collect(),
            missing: fit.records.into_iter().map(|record| record.missing).collect(),
            estimates: fit.estimates,
        }
    }

    fn said(&self) -> String {
        let record = |k: usize| if self.missing.len() > 1 { format!(" of record {}", k + 1) } else { String::new() };
        let missing = self.missing.iter().enumerate();
        let missing = missing.flat_map(|(k, all)| all.iter().map(move |n| format!("strike {n}{} missing", record(k))));
        let out = self.left_out_s.iter().enumerate();
        let out =
            out.flat_map(|(k, all)| all.iter().map(move |s| format!("the strike at {s:?} s{} left out", record(k))));
        let all: Vec<String> = missing.chain(out).collect();
        let all = if all.is_empty() { "no strike missing or left out".to_owned() } else { all.join(" and ") };
        let value = |quantity| self.estimates.iter().find(|estimate| estimate.quantity == quantity);
        let values =
            [Quantity::Restitution, Quantity::RestitutionA, Quantity::RadiusOfGyration].into_iter().filter_map(value);
        let values: Vec<String> = values
            .map(|estimate| {
                let (name, factor, unit) = estimate.quantity.said();
                format!("{name} {:.4} {unit}", factor * estimate.value).trim_end().to_owned()
            })
            .collect();
        let first = if self.first == End::A { "a" } else { "b" };
        format!("end {first} first, {all} ({})", values.join(", "))
    }
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
            (size, FAR_OFF_ACCELERATION, "accelerations", "their own root mean square")
        }
    };
    if found.scatter <= allowed * unit {
        return Ok(());
    }
    Err(Error::Far { record: number, name: what, percent: 100.0 * found.scatter / unit, of, allowed: 100.0 * allowed })
}

/// What explains the data if a given end touches first, and whether there is no need to try the other.
fn explanations<'a>(
    drop: &Drop<'a>,
    measured: &[Measured],
    given: bool,
) -> Result<(Vec<(Drop<'a>, Told)>, bool), Error> {
    let (mut matched, mut is_plain) = (Vec::new(), false);
    for (k, one) in measured.iter().enumerate() {
        if let Measured::Strikes { strikes, deviation_s } = one {
            let found = matching::find(drop, k, deviation_s.is_some())?;
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

/// The ends that may touch first: both where it matters and nothing says which.
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
    let times_alone = measured.iter().all(|one| matches!(one, Measured::Strikes { .. }));
    match (known.first, named) {
        (First::End(End::A), _) => &[End::A],
        (First::End(End::B), _) => &[End::B],
        (First::Either, None) if symmetric && times_alone => &[End::A],
        (First::Either, Some(End::B)) => &[End::B, End::A],
        (First::Either, _) => &[End::A, End::B],
    }
}

impl Quantity {
    /// Of these unknowns.
    fn of(self, drop: &Drop<'_>, x: &[f64]) -> f64 {
        let [a, b] = drop.known.body.arms_m();
        let gyration = 0.5 * (a + b) * libm::exp(x[GYRATION]);
        let speed = libm::exp(x[SPEED]);
        match self {
            Self::Restitution => x[RESTITUTION],
            Self::RestitutionA => x[RESTITUTION] + x[DIFFERENCE],
            Self::RestitutionB => x[RESTITUTION] - x[DIFFERENCE],
            Self::RadiusOfGyration => gyration,
            Self::InertiaRatio => Body::off_center(a, b, gyration).map_or(0.0, |body| {
                let [a, b] = body.inertia_ratios();
                (a * b).sqrt().copysign(a)
            }),
            Self::GapOverSpeed => libm::exp(x[GAP_TIME]),
            Self::Speed => speed,
            Self::DropHeight => 0.5 * speed * speed / drop.known.gravity_m_s2,
            Self::Tilt => libm::asin(drop.sin_tilt(x)),
            Self::Spin => drop.spin_rad_s(x),
            Self::ContactTime => libm::exp(x[CONTACT]),
        }
    }
    /// Whether it is positive, so that its logarithm is what scatters evenly.
    fn is_positive(self) -> bool {
        !matches!(self, Self::Restitution | Self::RestitutionA | Self::RestitutionB | Self::InertiaRatio | Self::Spin)
    }
    /// The number that scatters evenly.
    fn even(self, drop: &Drop<'_>, x: &[f64]) -> f64 {
        let value = self.of(drop, x);
        if self.is_positive() { libm::log(value) } else { value }
    }
    /// Of two numbers that scatter evenly, within what there is.
    fn interval(self, lo: f64, hi: f64) -> [f64; 2] {
        match self {
            Self::Restitution | Self::RestitutionA | Self::RestitutionB => [lo.max(0.0), hi.min(1.0)],
            Self::InertiaRatio => [lo.max(-1.0), hi.min(1.0)],
            Self::Spin => [lo, hi],
            _ => [lo, hi].map(libm::exp),
        }
    }
    /// The quantity that it is least and largest with: of the same unknown alone.
    fn leader(self, speed_moves: bool) -> Self {
        match self {
            Self::InertiaRatio => Self::RadiusOfGyration,
            Self::DropHeight => Self::Speed,
            Self::Tilt if !speed_moves => Self::GapOverSpeed,
            own => own,
        }
    }
}

const WITH_SPEED: &str = "with the speed of the product file";

fn report(drop: &Drop<'_>, told: &Told) -> Fit {
    let x = &told.minimum.x;
    let is_free = |unknown: usize| told.free.contains(&unknown);
    let mut quantities = Vec::new();
    if is_free(RESTITUTION) {
        let ends = [Quantity::RestitutionA, Quantity::RestitutionB];
        quantities.extend_from_slice(if is_free(DIFFERENCE) { &ends } else { &[Quantity::Restitution] });
    }
    if is_free(GYRATION) {
        quantities.extend([Quantity::RadiusOfGyration, Quantity::InertiaRatio]);
    }
    quantities.push(Quantity::GapOverSpeed);
    if is_free(SPEED) {
        quantities.push(Quantity::Speed);
        quantities.extend((drop.known.gravity_m_s2 > 0.0).then_some(Quantity::DropHeight));
    }
    quantities.push(Quantity::Tilt);
    quantities.extend(is_free(SPIN).then_some(Quantity::Spin));
    quantities.extend(is_free(CONTACT).then_some(Quantity::ContactTime));
    let problem = drop.problem();
    let all = drop.with_ranged(&told.free);
    let region = told.region(&problem, &all);
    let intervals = region.as_ref().map(|region| intervals(drop, region, &quantities, all.contains(&SPEED)));
    let estimates = quantities.iter().enumerate().map(|(k, &quantity)| Estimate {
        quantity,
        value: quantity.of(drop, x),
        interval: intervals.as_ref().map(|intervals| intervals[k]),
        note: (quantity == Quantity::Tilt && !is_free(SPEED)).then(|| WITH_SPEED.to_owned()),
    });
    let estimates = estimates.collect();
    let evens: Vec<_> = quantities.iter().map(|quantity| move |x: &[f64]| quantity.even(drop, x)).collect();
    let evens: Vec<&Function<'_>> = evens.iter().map(|even| even as _).collect();
    let correlations = region.as_ref().map_or_else(Vec::new, |region| region.correlations(&evens));
    let untold = told.held.iter().filter_map(|(unknown, reason)| {
        let quantity = match *unknown {
            GYRATION => Quantity::RadiusOfGyration,
            RESTITUTION => Quantity::Restitution,
            SPEED => Quantity::Speed,
            SPIN => Quantity::Spin,
            CONTACT => Quantity::ContactTime,
            _ => return None,
        };
        Some(Untold { quantity, held_at: quantity.of(drop, x), reason: reason.clone() })
    });
    let untold = untold.collect();
    let records = records(drop, x);
    let estimates: Vec<Estimate> = estimates;
    let mut notes = notes(drop, told, &records);
    notes.extend(estimates.iter().filter_map(|estimate| beyond(drop.known, estimate)));
    Fit {
        model: if drop.contacts { Model::Compliant } else { Model::FiniteTilt },
        first: drop.first,
        estimates,
        untold,
        correlations,
        degrees_of_freedom: told.degrees,
        others: Vec::new(),
        computed: computed(drop, x),
        records,
        notes,
    }
}

/// How far each quantity may be off.
fn intervals(drop: &Drop<'_>, region: &Region<'_>, quantities: &[Quantity], speed_moves: bool) -> Vec<[f64; 2]> {
    // A search that was cut short has no flights left.
    let by_profile = drop.is_quick() && drop.left.get() > 0;
    let mut found: Vec<(Quantity, [Vec<f64>; 2])> = Vec::new();
    let one = |&quantity: &Quantity| {
        let leader = quantity.leader(speed_moves);
        if !found.iter().any(|(known, _)| *known == leader) {
            let even = |x: &[f64]| leader.even(drop, x);
            found.push((leader, if by_profile { region.ends(&even) } else { region.straight_ends(&even) }));
        }
        let ends = found.iter().filter(|(known, _)| *known == leader).flat_map(|(_, ends)| ends);
        let [lo, hi] = ends.fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], end| {
            let value = quantity.even(drop, end);
            [lo.min(value), hi.max(value)]
        });
        quantity.interval(lo, hi)
    };
    quantities.iter().map(one).collect()
}

fn records(drop: &Drop<'_>, x: &[f64]) -> Vec<RecordFit> {
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
                    index.iter().map(|which| which.and_then(|which| which.find(drop, path.strikes()))).collect();
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
                    let at =
                        |(k, s): (usize, &super::MeasuredHeights)| [s.time_s, s.height_m[end], computed[2 * k + end]];
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

/// The computed strikes that are shown.
fn computed(drop: &Drop<'_>, x: &[f64]) -> Vec<(f64, End)> {
    let Some(path) = drop.path(x) else { return Vec::new() };
    let needed = path.strikes().len();
    let more = || {
        let last_s = path.strikes().last().map_or(0.0, |strike| strike.time_s);
        drop.rigid(x, drop.horizon_s().max(last_s + drop.unit_s), |flight| flight.strikes.len() >= needed + MORE)
    };
    let path = if drop.contacts { None } else { more() }.unwrap_or(path);
    path.strikes().iter().map(|strike| (strike.time_s, drop.end(strike.point))).collect()
}

/// Says that what was found is not what the product file states.
fn beyond(known: &Known, estimate: &Estimate) -> Option<String> {
    if matches!(estimate.quantity, Quantity::InertiaRatio | Quantity::DropHeight) {
        return None;
    }
    let [lo, hi] = known.stated(estimate.quantity)?;
    if estimate.agrees([lo, hi]) != Some(false) {
        return None;
    }
    let (name, factor, unit) = estimate.quantity.said();
    let [value, lo, hi] = [estimate.value, lo, hi].map(|x| format!("{:.4}", factor * x));
    let stated = if lo == hi { lo } else { format!("{lo} to {hi}") };
    Some(
        format!("the {name} found, {value} {unit}, is not what the product file states, {stated} {unit}")
            .replace(" ,", ",")
            .trim_end()
            .to_owned(),
    )
}

fn notes(drop: &Drop<'_>, told: &Told, records: &[RecordFit]) -> Vec<String> {
    let mut notes = Vec::new();
    for (k, record) in records.iter().enumerate() {
        let which = if records.len() > 1 { format!("record {}: ", k + 1) } else { String::new() };
        if !record.missing.is_empty() {
            let numbers: Vec<String> = record.missing.iter().map(ToString::to_string).collect();
            let (strikes, are) = if numbers.len() == 1 { ("strike", "is") } else { ("strikes", "are") };
            notes.push(format!(
                "{which}computed {strikes} {} {are} missing among the measured ones",
                numbers.join(" and ")
            ));
        }
        for strike in record.strikes.iter().filter(|strike| strike.number.is_none()) {
            notes.push(format!(
                "{which}the strike at {:?} s was left out: it is no strike, or its time is wrong",
                strike.measured.time_s
            ));
        }
    }
    let is_odd = |record: &RecordFit| {
        let is_off = record.scatter > SUSPECT * drop.unit_s;
        !record.strikes.is_empty() && is_off || record.strikes.iter().any(|strike| strike.number.is_none())
    };
    if drop.contacts && records.iter().any(is_odd) {
        notes.push(
            "strikes do not match well, and with contacts that take time missing strikes are not looked for: for that, fit the \
             strikes alone with a product file without contact_time"
                .to_owned(),
        );
    }
    if let Some((_, reason)) = told.held.iter().find(|(unknown, _)| *unknown == DIFFERENCE) {
        notes.push(format!("one restitution for both ends: {reason}"));
    }
    if told.scatter.is_none() {
        notes.push("there are as many unknowns as data, and nothing tells their scatter: no intervals".to_owned());
    }
    if told.free.contains(&OFFSET) && told.minimum.x[SPEED].is_finite() && drop.sin_tilt(&told.minimum.x) > 0.5 {
        notes.push("the tilt found is above 30 deg, the most that a product file takes".to_owned());
    }
    notes
}
