//! This module reports a fit.

use clatter_flight::Body;

use super::drop::{CONTACT, DIFFERENCE, Drop, GAP_TIME, GYRATION, OFFSET, RESTITUTION, SPEED, SPIN};
use super::matching::SUSPECT;
use super::records::{computed, records};
use super::region::{Function, Region};
use super::told::DeterminedFit;
use super::{Estimate, Fit, Known, Quantity, RecordFit, Undetermined};
use clatter_product::Model;

const WITH_SPEED: &str = "with the speed of the product file";

/// Reports all results of a fit.
pub(super) fn report(drop: &Drop<'_>, told: &DeterminedFit) -> Fit {
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
        Some(Undetermined { quantity, held_at: quantity.of(drop, x), reason: reason.clone() })
    });
    let untold = untold.collect();
    let records = records(drop, x);
    let estimates: Vec<Estimate> = estimates;
    let mut notes = notes(drop, told, &records);
    if region.is_none() && told.scatter.is_some() && told.excess.is_none() {
        notes.push("some of the unknowns do not change the data, or one undoes another: no intervals".to_owned());
    }
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

/// Returns how far each quantity may be off.
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

impl Quantity {
    /// Returns the value of the quantity for these unknowns.
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
    /// Returns whether it is positive, so that its logarithm is the number that scatters evenly.
    fn is_positive(self) -> bool {
        !matches!(self, Self::Restitution | Self::RestitutionA | Self::RestitutionB | Self::InertiaRatio | Self::Spin)
    }
    /// Returns the number that scatters evenly.
    fn even(self, drop: &Drop<'_>, x: &[f64]) -> f64 {
        let value = self.of(drop, x);
        if self.is_positive() { libm::log(value) } else { value }
    }
    /// Returns the interval of two numbers that scatter evenly, within the possible values.
    fn interval(self, lo: f64, hi: f64) -> [f64; 2] {
        match self {
            Self::Restitution | Self::RestitutionA | Self::RestitutionB => [lo.max(0.0), hi.min(1.0)],
            Self::InertiaRatio => [lo.max(-1.0), hi.min(1.0)],
            Self::Spin => [lo, hi],
            _ => [lo, hi].map(libm::exp),
        }
    }
    /// Returns the quantity that it is least and largest with: of the same unknown alone.
    fn leader(self, speed_moves: bool) -> Self {
        match self {
            Self::InertiaRatio => Self::RadiusOfGyration,
            Self::DropHeight => Self::Speed,
            Self::Tilt if !speed_moves => Self::GapOverSpeed,
            own => own,
        }
    }
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

fn notes(drop: &Drop<'_>, told: &DeterminedFit, records: &[RecordFit]) -> Vec<String> {
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
