//! Exact response to velocity shocks.

use crate::eight::{LARGEST_ANGLE, WIDTH};
use crate::peaks::{Extreme, Peaks, Range, Response};
use crate::side_by_side::SideBySide;
use crate::suspension::{Modes, Motion, Phase};
use crate::{Error, Peaked, Pulses, Suspension};
use std::f64::consts::PI;
use std::ops::RangeInclusive;

/// A jump of the base's velocity, in no time.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct VelocityShock {
    /// Time of the jump.
    pub time: f64,
    /// Jump of the velocity of the base.
    pub delta_v: f64,
}

/// A checked list of velocity shocks, in order of time.
///
/// Shocks may share one instant; they then act in the order given, as the limit of vanishing gaps, and the velocity
/// between them counts.
#[derive(Debug, Clone, PartialEq)]
pub struct VelocityShocks {
    shocks: Vec<VelocityShock>,
    /// True if the last one stands for the sum of many shocks at one instant, and is no shock of its own.
    closes: bool,
}

const LIST: &str = "velocity shocks";

impl VelocityShocks {
    /// Creates a checked list of velocity shocks.
    ///
    /// # Errors
    /// [`Error::Empty`], [`Error::Entry`] for a value that is not finite, [`Error::TimeOrder`] where times run back.
    pub fn new(shocks: Vec<VelocityShock>) -> Result<Self, Error> {
        if shocks.is_empty() {
            return Err(Error::Empty(LIST));
        }
        let mut previous = f64::NEG_INFINITY;
        for (i, s) in shocks.iter().enumerate() {
            for (name, value) in [("time", s.time), ("velocity change", s.delta_v)] {
                if !value.is_finite() {
                    return Err(Error::Entry { list: LIST, entry: i + 1, name, value, allowed: "finite" });
                }
            }
            if s.time < previous {
                return Err(Error::TimeOrder { list: LIST, entry: i + 1, time: s.time, previous });
            }
            previous = s.time;
        }
        Ok(Self { shocks, closes: false })
    }
    /// Returns the list with one more change of velocity, the sum of the ever smaller shocks of an endless train at one
    /// instant.
    pub(crate) fn closed_by(self, last: VelocityShock) -> Result<Self, Error> {
        let shocks = self.shocks.into_iter().chain([last]).collect();
        Ok(Self { closes: true, ..Self::new(shocks)? })
    }
    /// Returns the single shocks, without the sum of those of an endless train in its last instant.
    #[must_use]
    pub fn single(&self) -> &[VelocityShock] {
        &self.shocks[..self.shocks.len() - usize::from(self.closes)]
    }
    /// Returns the shocks, in order; in an endless train the last one may stand for all later ones.
    #[must_use]
    pub fn as_slice(&self) -> &[VelocityShock] {
        &self.shocks
    }
    /// Returns the sum of all velocity changes.
    #[must_use]
    pub fn net(&self) -> f64 {
        self.shocks.iter().map(|s| s.delta_v).sum()
    }
    /// Returns the largest sum of the first few velocity changes, in absolute value: the largest deviation of the
    /// base's velocity.
    #[must_use]
    pub fn largest_partial_sum(&self) -> f64 {
        let mut sum = 0.0_f64;
        self.shocks.iter().fold(0.0, |m, s| {
            sum += s.delta_v;
            m.max(sum.abs())
        })
    }
    /// Returns the largest single velocity change, in absolute value.
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.single().iter().fold(0.0, |m, s| m.max(s.delta_v.abs()))
    }
    /// Returns the peaks of the component's response, ring-down included.
    ///
    /// At each shock z′ jumps by −Δv and A by 2ζωΔv; between shocks the motion is free, and its turning points are
    /// known in closed form ([`Suspension::free`]), so nothing is sampled.
    ///
    /// # Accuracy
    ///
    /// Each shock adds a few roundings: values are within 8 ε n of the sum of all |Δv| after n shocks (times ω for
    /// accelerations, 1/ω for displacements). With a [`Stop`](crate::Stop) they are as in [`Pulses::respond`].
    ///
    /// # Examples
    ///
    /// One shock on an undamped component gives ω z = Δv and A = ω Δv, a quarter of a period later.
    ///
    /// ```
    /// # use clatter_shock::{DampingRatio, Suspension, VelocityShock, VelocityShocks};
    /// let one = VelocityShocks::new(vec![VelocityShock { time: 0.0, delta_v: 2.0 }])?;
    /// let undamped = Suspension::new(100.0, DampingRatio::new(0.0)?)?;
    /// let response = one.respond(&undamped);
    /// let peak = response.absolute_acceleration.peak();
    /// assert!((peak.value - 200.0).abs() < 1e-12 && (peak.time - std::f64::consts::PI / 200.0).abs() < 1e-17);
    /// assert!((response.relative_displacement.peak().value + 0.02).abs() < 1e-16);
    /// # Ok::<(), clatter_shock::Error>(())
    /// ```
    #[must_use]
    pub fn respond(&self, suspension: &Suspension) -> Response {
        if let Some(stop) = suspension.stop() {
            let linear = self.respond(&suspension.without_stop());
            if linear.relative_displacement.magnitude() < stop.gap() {
                return linear;
            }
            return self.pulses().respond(suspension).last_interval(self.shocks.len() - 1);
        }
        let mut run = Run::new(suspension);
        for shock in &self.shocks {
            run.shock(shock.time, shock.delta_v);
        }
        run.finish(|i| self.shocks[i].time)
    }
    /// Returns the same history as sections, an interval for each shock.
    #[must_use]
    pub fn pulses(&self) -> Pulses {
        Pulses::of_shocks(&self.shocks)
    }
    /// Returns the peak of one quantity, ωz or A/ω with its sign or the speed at a stop, if it passes `above` ≥ 0 either
    /// way, as [`Pulses::peak_above`](crate::Pulses::peak_above).
    ///
    /// ```
    /// # use clatter_shock::{DampingRatio, Peaked, Suspension, VelocityShock, VelocityShocks};
    /// let one = VelocityShocks::new(vec![VelocityShock { time: 0.0, delta_v: 2.0 }])?;
    /// let undamped = Suspension::new(100.0, DampingRatio::new(0.0)?)?;
    /// let peak = one.peak_above(&undamped, Peaked::AccelerationOverOmega, 1.9).unwrap();
    /// assert!((peak.value - 2.0).abs() < 1e-15);
    /// assert_eq!(one.peak_above(&undamped, Peaked::AccelerationOverOmega, 2.1), None);
    /// # Ok::<(), clatter_shock::Error>(())
    /// ```
    #[must_use]
    pub fn peak_above(&self, suspension: &Suspension, peaked: Peaked, above: f64) -> Option<Extreme> {
        if let Some(stop) = suspension.stop() {
            let linear = suspension.without_stop();
            if self.peak_above(&linear, Peaked::PseudoVelocity, linear.omega() * stop.gap()).is_none() {
                return self.peak_above(&linear, peaked, above);
            }
            let peak = self.pulses().peak_above(suspension, peaked, above)?;
            return Some(Extreme { interval: peak.interval.min(self.shocks.len() - 1), ..peak });
        }
        let row = peaked.row()?;
        let modes = Modes::new(suspension.damping());
        let omega = suspension.omega();
        let mut range = Range::beyond(above);
        let mut m = Motion::default();
        for (i, shock) in self.shocks.iter().enumerate() {
            if let Some(before) = i.checked_sub(1) {
                let phase = gap(omega, self.shocks[before].time, shock.time);
                range.note_free(&modes, row, m, phase.hi, before);
                m = modes.propagator(phase).apply(modes.p, m);
                range.note(before, phase.hi, modes.quantity(row, m));
            }
            m.w -= shock.delta_v;
        }
        range.note_free(&modes, row, m, f64::INFINITY, self.shocks.len() - 1);
        range.peak_above(above, omega, |i| self.shocks[i].time)
    }
    /// Returns the peaks of one quantity from the first to the last shock, and after it, for each angular frequency.
    pub(crate) fn peaks_at(&self, modes: &Modes, omegas: &[f64], k: usize) -> Vec<[Peaks; 2]> {
        let arch = pulp::Arch::new();
        let span = self.shocks[self.shocks.len() - 1].time - self.shocks[0].time;
        let mut list = Vec::with_capacity(omegas.len());
        for chunk in omegas.chunks(WIDTH) {
            let omega = std::array::from_fn(|l| chunk[l.min(chunk.len() - 1)]);
            let tame = TAME.contains(&self.largest()) && chunk.iter().all(|w| w * span < LARGEST_ANGLE);
            if tame {
                let peaks = arch.dispatch(SideBySide { shocks: &self.shocks, modes, omega, k });
                list.extend(&peaks[..chunk.len()]);
            } else {
                list.extend(chunk.iter().map(|&w| self.peaks(modes, w, k)));
            }
        }
        list
    }
    /// Returns the same peaks at one frequency.
    fn peaks(&self, modes: &Modes, omega: f64, k: usize) -> [Peaks; 2] {
        let (mut m, mut during) = (Motion::default(), Range::default());
        for (i, shock) in self.shocks.iter().enumerate() {
            if let Some(before) = i.checked_sub(1) {
                let phase = gap(omega, self.shocks[before].time, shock.time);
                let end = modes.propagator(phase).apply(modes.p, m);
                during.note(before, 0.0, modes.quantity(k, m));
                // Within half a swing a slope that keeps its sign has not vanished.
                if modes.beta * phase.hi >= PI || modes.quantity(k + 1, m) * modes.quantity(k + 1, end) <= 0.0 {
                    during.note_free(modes, k, m, phase.hi, before);
                }
                during.note(before, phase.hi, modes.quantity(k, end));
                m = end;
            }
            m.w -= shock.delta_v;
        }
        let last = self.shocks.len() - 1;
        during.note(last, 0.0, modes.quantity(k, m));
        let mut after = Range::default();
        after.note_free(modes, k, m, f64::INFINITY, last);
        [during, after].map(|range| range.peaks(omega, |i| self.shocks[i].time))
    }
}

/// A response in progress: all three quantities, shock by shock.
#[derive(Debug)]
pub(crate) struct Run {
    omega: f64,
    modes: Modes,
    m: Motion,
    ranges: [Range; 3],
    last: Option<f64>,
    number: usize,
}

impl Run {
    pub(crate) fn new(suspension: &Suspension) -> Self {
        Self {
            omega: suspension.omega(),
            modes: Modes::new(suspension.damping()),
            m: Motion::default(),
            ranges: [Range::default(); 3],
            last: None,
            number: 0,
        }
    }
    pub(crate) fn shock(&mut self, time: f64, delta_v: f64) {
        if let Some(last) = self.last {
            let phase = gap(self.omega, last, time);
            self.note(phase.hi);
            self.m = self.modes.propagator(phase).apply(self.modes.p, self.m);
            // This is the end of the interval, before the jump.
            for (k, range) in self.ranges.iter_mut().enumerate() {
                range.note(self.number - 1, phase.hi, self.modes.quantity(k, self.m));
            }
        }
        self.m.w -= delta_v;
        self.last = Some(time);
        self.number += 1;
    }
    /// Notes the free motion from the last shock over `span`.
    fn note(&mut self, span: f64) {
        for (k, range) in self.ranges.iter_mut().enumerate() {
            range.note_free(&self.modes, k, self.m, span, self.number - 1);
        }
    }
    pub(crate) fn finish(mut self, start: impl Fn(usize) -> f64) -> Response {
        self.note(f64::INFINITY);
        Response::from_ranges(self.omega, &self.ranges, start)
    }
}

/// Velocity changes whose squares are neither too small nor too large to compare.
const TAME: RangeInclusive<f64> = 1e-100..=1e100;

/// Returns ω (to − from), exact in its second double where it is long.
#[inline]
pub(crate) fn gap(omega: f64, from: f64, to: f64) -> Phase {
    let (dt, lo) = difference(from, to);
    Phase::product2(omega, dt, lo)
}

/// Returns to − from in two doubles (Knuth's two-sum).
#[inline]
pub(crate) fn difference(from: f64, to: f64) -> (f64, f64) {
    let dt = to - from;
    let back = dt - to;
    (dt, (to - (dt - back)) + (-from - back))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DampingRatio;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(400))]
        /// Compares eight frequencies side by side, by series, with one at a time, by the functions of the standard
        /// library.
        #[test]
        fn lanes_agree_with_one_frequency(
            list in prop::collection::vec((-6.0..3.0_f64, -10.0..10.0_f64, 0..4_u8), 1..40),
            zeta in prop_oneof![
                Just(0.0), 1e-12..1e-3_f64, 1e-3..1.0_f64, Just(1.0 - 1e-9), Just(1.0), Just(1.0 + 1e-9), 1.0..60.0_f64
            ],
            low in -4.0..2.0_f64,
        ) {
            let mut time = 0.0;
            let shocks: Vec<VelocityShock> = list
                .iter()
                .map(|&(gap, delta_v, kind)| {
                    // One in four comes at the instant of the one before.
                    time += if kind == 0 { 0.0 } else { 10_f64.powf(gap) };
                    VelocityShock { time, delta_v }
                })
                .collect();
            let shocks = VelocityShocks::new(shocks).expect("shocks");
            let modes = Modes::new(DampingRatio::new(zeta).expect("damping"));
            let omegas: Vec<f64> = (0..11).map(|i| 10_f64.powf(low + 0.4 * f64::from(i))).collect();
            let sum: f64 = shocks.shocks.iter().map(|s| s.delta_v.abs()).sum();
            for k in [Modes::DISPLACEMENT, Modes::VELOCITY, Modes::ACCELERATION] {
                let together = shocks.peaks_at(&modes, &omegas, k);
                prop_assert_eq!(together.len(), omegas.len());
                // The stated accuracy of either, 8 ε a shock; A/ω is 2ζ times a velocity.
                let size = if k == Modes::ACCELERATION { 1.0 + 2.0 * zeta } else { 1.0 };
                let allowed = 16.0 * f64::EPSILON * size * sum * f64::from(u32::try_from(list.len()).expect("few"));
                for (&omega, together) in omegas.iter().zip(together) {
                    for (a, b) in together.iter().zip(shocks.peaks(&modes, omega, k)) {
                        for (a, b) in [(a.high.value, b.high.value), (a.low.value, b.low.value)] {
                            prop_assert!((a - b).abs() <= allowed, "{k} at {omega}: {a}, not {b}");
                        }
                    }
                }
            }
        }
    }
}
