//! This module computes the measured data as a function of the unknowns: one drop, by the flights of `clatter-flight`.

use std::cell::Cell;
use std::rc::Rc;

use clatter::End;
use clatter_flight::{Ahead, Contact, Model, Motion, Profile, Scene};

use super::solve::{self, Minimum, Problem};
use super::{Known, Set};

// These are the places of the unknowns. Those that are positive are their logarithms, so that a step is a share of them.
/// ln of the radius of gyration over half the length.
pub(super) const GYRATION: usize = 0;
/// Mean restitution of both ends.
pub(super) const RESTITUTION: usize = 1;
/// Half of the restitution of end a less that of end b.
pub(super) const DIFFERENCE: usize = 2;
/// ln of the gap over the speed, in s.
pub(super) const GAP_TIME: usize = 3;
/// ln of the speed, in m/s.
pub(super) const SPEED: usize = 4;
/// Angular velocity at the first touch times half the length over the speed; the second end upward.
pub(super) const SPIN: usize = 5;
/// ln of the contact time, in s.
pub(super) const CONTACT: usize = 6;
/// The first touch on the time axis of each record, in units of time of the drop.
pub(super) const OFFSET: usize = 7;

/// Radius of gyration over half the length that flights with contacts take at least.
const LEAST_GYRATION: f64 = 0.1;
/// Unknowns are searched within so many times of what the product file says: beyond, it is of another product or another drop.
const BEYOND: f64 = 4.0;
/// The sine of the largest tilt of a product file, 30 degrees.
const STEEPEST: f64 = 0.5;
/// A step of this share is far above the roundings of a rigid flight (1e−13) and far below its curvature.
const STEP: f64 = 1e-6;
/// Flights with contacts are exact to [`PRECISION`] for each contact; steps are far above that.
const CONTACT_STEP: f64 = 1e-4;
/// Flights of a search, by whether contacts take time, for so many data: some seconds of either.
pub(super) const FLIGHTS: [usize; 2] = [100_000, 10_000];
pub(super) const DATA: [usize; 2] = [16, 256];
/// Precision of flights with contacts, and while a search is on.
const PRECISION: f64 = 1e-5;
const ROUGH: f64 = 1e-3;
/// Searches, at most, until the scatter of the data and the weight of a range agree, to this share.
const SETTLES: usize = 6;
const SETTLED: f64 = 0.02;
/// With fewer degrees of freedom nothing tells the scatter.
const LEAST_DEGREES: f64 = 0.5;
/// Data that are met to this share of what they vary by are met exactly.
const ROUNDING: f64 = 1e-9;
/// A flight is followed for so many times as long as strikes were measured.
const HORIZON: f64 = 3.0;
/// The same of contacts that take time, where no more were measured.
const MOST_CONTACTS: usize = 64;
/// Events of a flight with contacts for each strike, at most: a body that rocks in its dents is left there.
const EVENTS: usize = 8;
/// Strikes of a flight at most, where no more were measured: later ones of a body that comes to rest are too small to be seen.
const MOST_STRIKES: usize = 256;

/// A drop of which some is unknown, and what was measured of it.
#[derive(Debug, Clone)]
pub(super) struct Drop<'a> {
    pub(super) known: &'a Known,
    pub(super) sets: Vec<Set<'a>>,
    /// The end that touches first.
    pub(super) first: End,
    /// True where contacts take time.
    pub(super) contacts: bool,
    /// Unit of time of the offsets.
    pub(super) unit_s: f64,
    /// True where flights with contacts are computed roughly, as a search needs them.
    pub(super) is_rough: bool,
    /// Unknowns that the product file gives in a range and the data do not tell: the range is a datum.
    pub(super) ranged: Vec<usize>,
    /// The scatter of the data over their deviations, where these are not given.
    pub(super) scatter: f64,
    /// Flights that may still be computed for a search; beyond, each minimum is left where it is.
    pub(super) left: Rc<Cell<usize>>,
}

/// A drop as it was computed.
#[derive(Debug, Clone)]
pub(super) struct Path {
    scene: Scene,
    pub(super) motion: Motion,
}

impl Drop<'_> {
    /// Returns the least-squares problem over its unknowns.
    pub(super) fn problem(&self) -> Problem<'_> {
        let step = match (self.contacts, self.is_rough) {
            (false, _) => STEP,
            (true, true) => 10.0 * CONTACT_STEP,
            (true, false) => CONTACT_STEP,
        };
        // Flights with contacts take ten times as long.
        let patience = match (self.left.get(), self.contacts) {
            (0, _) => 1,
            (_, true) => 12,
            (_, false) => 60,
        };
        Problem {
            residuals: Box::new(|x| self.residuals(x)),
            bounds: self.bounds(),
            step,
            one_sided: !self.contacts,
            patience,
            precision: solve::PRECISION,
        }
    }
    /// Returns whether strike times alone are fitted, with impacts that are instant: a flight is then so quick that hundreds more of them
    /// count for nothing.
    pub(super) fn is_quick(&self) -> bool {
        !self.contacts && self.sets.iter().all(Set::is_strikes)
    }
    /// Returns the values that the product file gives, a range in its middle.
    pub(super) fn given(&self) -> Vec<f64> {
        let Known { body, restitution, speed_m_s, tilt_rad, contact_time_s, .. } = self.known;
        let ln_middle = |[lo, hi]: [f64; 2]| 0.5 * (libm::log(lo) + libm::log(hi));
        let speed = ln_middle(*speed_m_s);
        let gap_m = body.length_m() * libm::sin(0.5 * (tilt_rad[0] + tilt_rad[1])).max(1e-3);
        let mut x = vec![0.0; OFFSET + self.sets.len()];
        x[GYRATION] = libm::log(2.0 * body.gyration_m() / body.length_m());
        x[RESTITUTION] = 0.5 * (restitution[0] + restitution[1]);
        x[GAP_TIME] = libm::log(gap_m) - speed;
        x[SPEED] = speed;
        x[CONTACT] = contact_time_s.map_or(0.0, ln_middle);
        x
    }
    /// Returns the middle of the range that the product file gives for an unknown, and half its width; none of a single value.
    pub(super) fn range(&self, unknown: usize) -> Option<[f64; 2]> {
        let ln = |[lo, hi]: [f64; 2]| [libm::log(lo), libm::log(hi)];
        let [lo, hi] = match unknown {
            SPEED => ln(self.known.speed_m_s),
            CONTACT => ln(self.known.contact_time_s?),
            RESTITUTION => self.known.restitution,
            GYRATION if !self.known.gyration_known => {
                ln(self.known.gyration_m.map(|radius| 2.0 * radius / self.known.body.length_m()))
            }
            _ => return None,
        };
        (hi > lo).then_some([0.5 * (lo + hi), 0.5 * (hi - lo)])
    }
    /// Returns how many of the two, radius of gyration and speed, are beyond the ranges that the product file gives. The restitution is not
    /// counted, since the fit is for it.
    pub(super) fn beyond(&self, x: &[f64]) -> usize {
        let is_beyond = |unknown: &usize| {
            self.range(*unknown).is_some_and(|[middle, half]| (x[*unknown] - middle).abs() > half * (1.0 + 1e-9))
        };
        [GYRATION, SPEED].iter().filter(|unknown| is_beyond(unknown)).count()
    }
    /// Finds the minimum next to `x` over these unknowns, and within their ranges over those that the file gives in one. `known`: whether
    /// the deviations of the data are given; else their scatter sets the weight of a range.
    pub(super) fn settle(&mut self, x: &[f64], free: &[usize], known: bool) -> Minimum {
        let all = self.with_ranged(free);
        let mut minimum = self.problem().minimize(x, &all);
        for _ in 0..SETTLES {
            if known || self.ranged.is_empty() {
                break;
            }
            let Some((scatter, _)) = self.scattered(&minimum, free) else { break };
            let change = (scatter / self.scatter - 1.0).abs();
            self.scatter = scatter;
            if change < SETTLED {
                break;
            }
            minimum = self.problem().minimize(&minimum.x, &all);
        }
        minimum
    }
    /// Returns the scatter of the data over their deviations, and the degrees of freedom behind it; none where these are too few.
    ///
    /// A range is no datum about the scatter: of an unknown that the data tell, and not its range, they have one degree of freedom less.
    /// The leverage of the range says how much of it that is.
    pub(super) fn scattered(&self, minimum: &Minimum, free: &[usize]) -> Option<(f64, f64)> {
        let data = minimum.residuals.len() - self.ranged.len();
        let all = self.with_ranged(free);
        #[expect(clippy::cast_precision_loss, reason = "counts of data")]
        let mut degrees = data as f64 - all.len() as f64;
        if !self.ranged.is_empty() {
            let q = self.problem().jacobian(&minimum.x, &all).qr().q();
            degrees += (data..q.nrows()).map(|datum| q.row(datum).norm_squared()).sum::<f64>();
        }
        let sum: f64 = minimum.residuals[..data].iter().map(|r| r * r).sum();
        (degrees > LEAST_DEGREES).then(|| ((sum / degrees).sqrt().max(self.least_scatter()), degrees))
    }
    /// Returns the free unknowns, and those within a range.
    pub(super) fn with_ranged(&self, free: &[usize]) -> Vec<usize> {
        free.iter().chain(self.ranged.iter().filter(|unknown| !free.contains(unknown))).copied().collect()
    }
    /// Returns the scatter of roundings.
    pub(super) fn least_scatter(&self) -> f64 {
        self.sets.iter().map(|set| ROUNDING * set.variation(self.unit_s)).fold(f64::MIN_POSITIVE, f64::max)
    }
    pub(super) fn bounds(&self) -> Vec<[f64; 2]> {
        let ln = |[lo, hi]: [f64; 2]| [libm::log(lo), libm::log(hi)];
        let length = self.known.body.length_m();
        let arm = self.arms()[0];
        let about = |[lo, hi]: [f64; 2]| ln([lo / BEYOND, hi * BEYOND]);
        let gyration = 2.0 * self.known.body.gyration_m() / length;
        let mut bounds = vec![[f64::NEG_INFINITY, f64::INFINITY]; OFFSET + self.sets.len()];
        bounds[GYRATION] = about([gyration.max(BEYOND * LEAST_GYRATION), gyration]);
        bounds[RESTITUTION] = [0.0, 1.0];
        bounds[DIFFERENCE] = [-0.5, 0.5];
        // The second end strikes within what was measured.
        let longest_s = if self.horizon_s() > 0.0 { self.horizon_s() } else { 10.0 };
        bounds[GAP_TIME] = ln([1e-6 * longest_s, longest_s]);
        bounds[SPEED] = about(self.known.speed_m_s);
        // The end that touches first still approaches.
        bounds[SPIN] = [-0.45 * length / arm, 5.0];
        bounds[CONTACT] = self.known.contact_time_s.map_or_else(|| ln([1e-6, 0.1]), about);
        bounds
    }
    /// Arms of the end that touches first and of the other one.
    fn arms(&self) -> [f64; 2] {
        let [a, b] = self.known.body.arms_m();
        if self.first == End::A { [a, b] } else { [b, a] }
    }
    /// Returns the contact point that an end is, and the other way around.
    pub(super) fn end(&self, point: usize) -> End {
        if (point == 0) == (self.first == End::A) { End::A } else { End::B }
    }
    /// Returns the restitution of the first and the second end.
    pub(super) fn restitutions(&self, x: &[f64]) -> [f64; 2] {
        let side = if self.first == End::A { 1.0 } else { -1.0 };
        [1.0, -1.0].map(|sign| (x[RESTITUTION] + sign * side * x[DIFFERENCE]).clamp(0.0, 1.0))
    }
    /// Returns the sine of the tilt, at most [`STEEPEST`].
    pub(super) fn sin_tilt(&self, x: &[f64]) -> f64 {
        (libm::exp(x[GAP_TIME] + x[SPEED]) / self.known.body.length_m()).min(STEEPEST)
    }
    /// Returns the angular velocity at the first touch, end b upward.
    pub(super) fn spin_rad_s(&self, x: &[f64]) -> f64 {
        let side = if self.first == End::A { 1.0 } else { -1.0 };
        side * x[SPIN] * libm::exp(x[SPEED]) * 2.0 / self.known.body.length_m()
    }
    fn scene(&self, x: &[f64]) -> Result<Scene, clatter::Error> {
        let ([a, b], length) = (self.arms(), self.known.body.length_m());
        let body = Profile::off_center(a, b, 0.5 * length * libm::exp(x[GYRATION]))?;
        let (speed, tilt) = (libm::exp(x[SPEED]), libm::asin(self.sin_tilt(x)));
        Scene::new(body, x[RESTITUTION], speed, tilt.to_degrees(), self.known.gravity_m_s2)?
            .with_spin(x[SPIN] * speed * 2.0 / length)
    }
    /// Computes the flight of the rigid body until `enough`.
    pub(super) fn rigid(&self, x: &[f64], horizon_s: f64, enough: impl FnMut(&Ahead) -> bool) -> Option<Path> {
        let most = self.sets.iter().map(Set::strikes).max().unwrap_or(0).max(MOST_STRIKES);
        let scene = self.scene(x).ok()?.with_impact_limit(most).ok()?.with_time_limit_s(horizon_s).ok()?;
        let motion = scene.fly_by_ends(self.restitutions(x), enough).ok()?;
        Some(Path { scene, motion })
    }
    /// Computes the flight by the model of the fit, as far as the records need it.
    pub(super) fn path(&self, x: &[f64]) -> Option<Path> {
        self.left.set(self.left.get().saturating_sub(1));
        let until_s = self.until_s(x);
        let horizon_s = self.horizon_s().max(until_s);
        if !self.contacts {
            let needed: Vec<[usize; 3]> = self.sets.iter().map(Set::needed).collect();
            return self.rigid(x, horizon_s, |ahead| {
                let [first, second] = ahead.struck;
                let [of_a, of_b] = if self.first == End::A { [first, second] } else { [second, first] };
                let has = |[all, a, b]: &[usize; 3]| first + second >= *all && of_a >= *a && of_b >= *b;
                ahead.time_s > until_s && needed.iter().all(has)
            });
        }
        let needed = self.sets.iter().map(Set::strikes).max().unwrap_or(0);
        // Phases are limited with the strikes.
        let scene = self.scene(x).ok()?.with_impact_limit(needed.max(MOST_CONTACTS)).ok()?;
        let contact = Contact::new(self.known.contact_law, x[RESTITUTION], libm::exp(x[CONTACT])).ok()?;
        let (mut touches, mut events) = (1, 0);
        let most = EVENTS * needed.max(MOST_CONTACTS);
        let precision = if self.is_rough { ROUGH } else { PRECISION };
        let motion = scene.fly_until(Model::Contacts(contact), precision, |ahead| {
            touches += usize::from(ahead.lands);
            events += 1;
            ahead.time_s > horizon_s || ahead.time_s > until_s && touches > needed || events > most
        });
        Some(Path { scene, motion: motion.ok()? })
    }
    /// No strike that was measured is later after the first touch: what is computed later never happens.
    pub(super) fn horizon_s(&self) -> f64 {
        HORIZON * self.sets.iter().filter_map(Set::span_s).fold(0.0, f64::max)
    }
    /// Returns until when heights and accelerations need the motion, since the first touch.
    fn until_s(&self, x: &[f64]) -> f64 {
        let last = |(k, set): (usize, &Set<'_>)| set.end_s().map(|end_s| end_s - self.offset_s(x, k));
        self.sets.iter().enumerate().filter_map(last).fold(f64::NEG_INFINITY, f64::max)
    }
    /// Returns the first touch on the time axis of a record.
    pub(super) fn offset_s(&self, x: &[f64], set: usize) -> f64 {
        x[OFFSET + set] * self.unit_s
    }
    /// Returns the measured less the computed values over a standard deviation, of all records.
    pub(super) fn residuals(&self, x: &[f64]) -> Vec<f64> {
        let path = self.path(x);
        let mut all = Vec::new();
        for (k, set) in self.sets.iter().enumerate() {
            set.residuals(self, path.as_ref(), self.offset_s(x, k), &mut all);
        }
        // Any value of a range is as likely: its standard deviation is half its width over √3 (JCGM 100:2008, 4.3.7).
        let datum = |&unknown: &usize| {
            let [middle, half] = self.range(unknown)?;
            Some(self.scatter * (x[unknown] - middle) * 3_f64.sqrt() / half)
        };
        all.extend(self.ranged.iter().filter_map(datum));
        all
    }
}

impl Drop<'_> {
    /// Returns the record whose data scatter most, over their deviations.
    pub(super) fn worst(&self, x: &[f64]) -> usize {
        let mut residuals = self.residuals(x).into_iter();
        let mean = |set: &Set<'_>| {
            #[expect(clippy::cast_precision_loss, reason = "a count of data")]
            let count = set.len().max(1) as f64;
            residuals.by_ref().take(set.len()).map(|r| r * r).sum::<f64>() / count
        };
        let means: Vec<f64> = self.sets.iter().map(mean).collect();
        (0..means.len()).max_by(|&a, &b| means[a].total_cmp(&means[b])).unwrap_or(0)
    }
}

impl Path {
    /// Heights of the first and the second end at a time since the first touch; before it in free flight.
    pub(super) fn heights_m(&self, time_s: f64) -> [f64; 2] {
        if time_s >= 0.0 {
            return self.motion.at(time_s).height_m;
        }
        let scene = &self.scene;
        let [a, b] = scene.body().arms_m();
        let tilt = scene.tilt_rad();
        let center = a * libm::sin(tilt) - time_s * (scene.speed_m_s() + 0.5 * scene.gravity_m_s2() * time_s);
        let sin = libm::sin(tilt + scene.spin_rad_s() * time_s);
        [center - a * sin, center + b * sin]
    }
    /// Returns the velocity of a place, at `s` in [−1, 1] from the first end to the second, less that of a free fall from the first touch
    /// on: what the contacts have given it.
    pub(super) fn given_m_s(&self, s: f64, time_s: f64) -> f64 {
        if self.motion.contact().is_none() {
            return 0.0;
        }
        let time_s = time_s.max(0.0);
        self.motion.at(time_s).velocity_at(s) + self.scene.gravity_m_s2() * time_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Measured, MeasuredStrike};
    use clatter_flight::ContactLaw;
    use clatter_product::First;

    /// A value at the end of a range of any value is √3 of its standard deviation from the middle.
    #[test]
    fn a_range_counts_as_a_datum_of_its_standard_deviation() {
        let known = Known {
            gyration_m: [0.04; 2],
            body: clatter_flight::Body::new(0.15, 0.04).expect("a body"),
            gyration_known: true,
            first: First::End(End::A),
            gravity_m_s2: 0.0,
            restitution: [0.2, 0.5],
            speed_m_s: [3.0, 5.0],
            tilt_rad: [0.0, 0.05],
            contact_time_s: None,
            contact_law: ContactLaw::Hysteretic,
        };
        let strikes = [0.0, 1e-3].map(|time_s| MeasuredStrike { time_s, end: None }).to_vec();
        let measured = [Measured::Strikes { strikes, deviation_s: Some(1e-6) }];
        let sets = crate::set::sets(&known, &measured).expect("two strikes");
        let left = Rc::new(Cell::new(100));
        let mut drop = Drop {
            known: &known,
            sets,
            first: End::A,
            contacts: false,
            unit_s: 1e-3,
            is_rough: false,
            ranged: vec![SPEED],
            scatter: 1.0,
            left,
        };
        let mut x = drop.given();
        let last = |drop: &Drop<'_>, x: &[f64]| drop.residuals(x).last().copied().expect("three of them");
        assert_eq!(drop.residuals(&x).len(), 3);
        assert!(last(&drop, &x).abs() < 1e-12);
        x[SPEED] = libm::log(5.0);
        assert!((last(&drop, &x) - 3_f64.sqrt()).abs() < 1e-12);
        // Beside residuals that scatter by 2, the range keeps its weight.
        drop.scatter = 2.0;
        assert!((last(&drop, &x) - 2.0 * 3_f64.sqrt()).abs() < 1e-12);
    }
}
