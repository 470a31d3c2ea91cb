//! This module defines one shock, at a place and of the turning of the product: one definition for every command and page.
//!
//! Of contacts that take time, shocks are taken from the largest peak of the acceleration above free fall down. Each reaches on both sides
//! as long as the sign is kept and a tenth of its peak, at least 2 g, is exceeded, and from there as long as it goes on falling; never into
//! an earlier one, and never beyond the presses that overlap there: the acceleration of a place by the turning of the body in flight is no
//! shock. A push below 2 g is the weight that it pivots under and no shock, unless nothing of the history is more. The change of velocity
//! is that of the place over it: the integral of the acceleration above free fall, less the share of g along its axis. So a lone contact
//! gives (1 + e) v, two presses are one shock where the push between them never falls below a tenth, and a long gentle tail is none. Of
//! turning the same holds for the angular acceleration, with 2 g over the least radius of gyration. Instant impacts are each a shock; those
//! at one instant add up.

use std::slice::from_ref;

use clatter::{Excitation, Section};
use clatter_flight::{Followed, Place};

/// One shock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Shock {
    /// The beginning and the end.
    pub(crate) span_s: [f64; 2],
    /// Change of velocity, without its sign.
    pub(crate) change: f64,
    /// Largest acceleration in it, without its sign; infinite for an instant impact.
    pub(crate) peak: f64,
    /// The time of the peak.
    pub(crate) time_s: f64,
}

/// Share of its peak down to which a shock reaches, whatever the acceleration does in between.
const TENTH: f64 = 0.1;
/// The acceleration over g down to which a shock reaches at least, by definition: a push of that size changes the velocity of a place by no
/// more than its weight does in flight.
const WEIGHTS: f64 = 2.0;

/// Returns what is asked of a place with this history, of instant impacts or of what pushes it.
fn of_place<T>(
    followed: &Followed,
    place: &Place,
    felt: &Excitation,
    instants: impl Fn(Vec<Shock>) -> T,
    of: impl Fn(&Pushed<'_>) -> T,
) -> T {
    let (gravity, least) = (followed.drop.gravity_m_s2, WEIGHTS * followed.drop.gravity_m_s2);
    if let Some(jumps) = followed.jumps(place) {
        return instants(at_instants(jumps.into_iter()));
    }
    match followed.accelerations(place) {
        Some(moved) => of(&Pushed { felt, moved: &moved, gravity: 0.0, least }),
        None => of(&Pushed { felt, moved: from_ref(felt), gravity, least }),
    }
}

/// Returns the shocks of a place with this history, in order of time.
pub(crate) fn shocks_at(followed: &Followed, place: &Place, felt: &Excitation) -> Vec<Shock> {
    of_place(followed, place, felt, |shocks| shocks, shocks)
}

/// Returns the largest of them.
pub(crate) fn largest_at(followed: &Followed, place: &Place, felt: &Excitation) -> Shock {
    of_place(followed, place, felt, |shocks| largest(&shocks), largest_of)
}

/// Returns the largest acceleration in any of them, and when; infinite of instant impacts.
pub(crate) fn crest_at(followed: &Followed, place: &Place, felt: &Excitation) -> Option<(f64, f64)> {
    let instant = |shocks: Vec<Shock>| shocks.first().map(|shock| (f64::INFINITY, shock.time_s));
    of_place(followed, place, felt, instant, crest_of)
}

/// Returns what is asked of an angular acceleration, of instant impacts or of what pushes it: what does so by less than two weights at the
/// least radius of gyration is no shock.
fn of_turning<T>(
    followed: &Followed,
    turned: &Excitation,
    instants: impl Fn(Vec<Shock>) -> T,
    of: impl Fn(&Pushed<'_>) -> T,
) -> T {
    if !followed.has_contacts() {
        return instants(at_instants(turned.sections().map(|k| (k.from, k.delta_v))));
    }
    let least = WEIGHTS * followed.drop.gravity_m_s2 / followed.drop.least_gyration_m();
    of(&Pushed { felt: turned, moved: from_ref(turned), gravity: 0.0, least })
}

/// Returns the shocks of the turning of the product about the axis of the largest, where that passes `above`.
pub(crate) fn hardest_turn(followed: &Followed, above: f64) -> Option<Vec<Shock>> {
    followed.hardest_turn(above, |turned| shocks_of_turning(followed, turned), |shocks| largest(shocks).change)
}

/// Returns the largest shock of the turning of the product, where it passes `above`.
pub(crate) fn largest_turn(followed: &Followed, above: f64) -> Option<Shock> {
    let of = |turned: &Excitation| of_turning(followed, turned, |shocks| largest(&shocks), largest_of);
    followed.hardest_turn(above, of, |shock| shock.change)
}

/// Returns the shocks of an angular acceleration.
pub(crate) fn shocks_of_turning(followed: &Followed, turned: &Excitation) -> Vec<Shock> {
    of_turning(followed, turned, |shocks| shocks, shocks)
}

impl Shock {
    /// The shock of a place where nothing happens.
    pub(crate) const NONE: Self = Self { span_s: [0.0; 2], change: 0.0, peak: 0.0, time_s: 0.0 };
}

/// Returns the largest of some shocks; one of 0 where there is none.
pub(crate) fn largest(shocks: &[Shock]) -> Shock {
    shocks.iter().fold(Shock::NONE, |most, shock| if shock.change > most.change { *shock } else { most })
}

/// Changes of velocity, those at one instant as one.
fn at_instants(changes: impl Iterator<Item = (f64, f64)>) -> Vec<Shock> {
    let mut all: Vec<(f64, f64)> = Vec::new();
    for (time_s, change) in changes {
        match all.last_mut() {
            Some(last) if last.0.to_bits() == time_s.to_bits() => last.1 += change,
            _ => all.push((time_s, change)),
        }
    }
    let shock =
        |(time_s, change): (f64, f64)| Shock { span_s: [time_s; 2], change: change.abs(), peak: f64::INFINITY, time_s };
    all.into_iter().map(shock).collect()
}

/// A sample of the acceleration: its section, the time in it, its time and acceleration.
#[derive(Debug, Clone, Copy)]
struct Sample {
    section: usize,
    t: f64,
    time_s: f64,
    felt: f64,
}

/// The excitation that pushes a place, or turns a body.
struct Pushed<'a> {
    /// The acceleration of the place above free fall, or the angular acceleration.
    felt: &'a Excitation,
    /// The excitation that changes the velocity, along one axis or along three, in the same sections, besides `gravity`.
    moved: &'a [Excitation],
    gravity: f64,
    /// Below this nothing is a shock.
    least: f64,
}

/// An acceleration above free fall in sections, with the changes of velocity of the place until each begins.
struct History<'a> {
    felt: &'a Excitation,
    moved: &'a [Excitation],
    velocity: Vec<Vec<f64>>,
    gravity: f64,
    /// No less than gravity, whose share is in what moves and not in what is felt: the least acceleration of a shock is two of it.
    weight: f64,
}

/// Samples to which a shock reaches.
struct Reach {
    peak: usize,
    /// The first and the last.
    ends: [usize; 2],
    /// Beside each end the one beyond, which no earlier shock has, and the one before.
    beside: [[Option<usize>; 2]; 2],
}

/// Returns the samples to which shocks reach, the highest peak first.
fn reaches(samples: &[Sample], least: f64) -> Vec<Reach> {
    let size = |k: usize| samples[k].felt.abs();
    let is_peak = |k: &usize| {
        let (k, before) = (*k, k.checked_sub(1));
        let rises = before.is_none_or(|j| size(j) < size(k) || samples[j].felt * samples[k].felt <= 0.0);
        let next = k + 1;
        let falls = next == samples.len() || size(next) <= size(k) || samples[next].felt * samples[k].felt <= 0.0;
        size(k) > 0.0 && rises && falls
    };
    let mut peaks: Vec<usize> = (0..samples.len()).filter(is_peak).collect();
    if peaks.iter().any(|k| size(*k) > least) {
        peaks.retain(|k| size(*k) > least);
    }
    peaks.sort_by(|&j, &k| size(k).total_cmp(&size(j)).then(j.cmp(&k)));
    let mut taken = vec![false; samples.len()];
    let mut found = Vec::new();
    for peak in peaks {
        if taken[peak] {
            continue;
        }
        let back = |k: usize| k.checked_sub(1);
        let on = |k: usize| Some(k + 1).filter(|k| *k < samples.len());
        let least = least.max(TENTH * size(peak));
        let [first, last] = [reach(samples, &taken, least, peak, back), reach(samples, &taken, least, peak, on)];
        let free = |k: &usize| !taken[*k];
        let begin = [back(first).filter(free), on(first).filter(|k| *k <= last)];
        let end = [on(last).filter(free), back(last).filter(|k| *k >= first)];
        taken[first..=last].fill(true);
        found.push(Reach { peak, ends: [first, last], beside: [begin, end] });
    }
    found
}

/// Returns the shocks of an acceleration above free fall, or of an angular one.
fn shocks(pushed: &Pushed<'_>) -> Vec<Shock> {
    let history = History::new(pushed);
    let samples = history.sampled();
    let mut found: Vec<Shock> =
        reaches(&samples, pushed.least).iter().map(|reach| history.shock(&samples, reach)).collect();
    found.sort_by(|a, b| a.span_s[0].total_cmp(&b.span_s[0]));
    found
}

/// Returns the largest of them, the first of several: where no other may be larger only that one is worked out.
fn largest_of(pushed: &Pushed<'_>) -> Shock {
    let history = History::new(pushed);
    let samples = history.sampled();
    let reaches = reaches(&samples, pushed.least);
    let mut most: Vec<(f64, &Reach)> = reaches.iter().map(|reach| (history.most(&samples, reach), reach)).collect();
    most.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut largest = Shock::NONE;
    for (most, reach) in most {
        if most < largest.change {
            break;
        }
        let shock = history.shock(&samples, reach);
        let first = || largest.span_s[0].total_cmp(&shock.span_s[0]);
        if shock.change.total_cmp(&largest.change).then_with(first).is_gt() {
            largest = shock;
        }
    }
    largest
}

/// Returns the largest acceleration of any of them, and when.
fn crest_of(pushed: &Pushed<'_>) -> Option<(f64, f64)> {
    let history = History::new(pushed);
    let samples = history.sampled();
    let mut crests: Vec<(f64, f64)> =
        reaches(&samples, pushed.least).iter().map(|reach| history.crest(&samples, reach.peak)).collect();
    crests.sort_by(|a, b| a.1.total_cmp(&b.1));
    crests.into_iter().reduce(|most, one| if one.0 > most.0 { one } else { most })
}

/// Returns the last sample to which the shock of a peak reaches on one side.
fn reach(samples: &[Sample], taken: &[bool], least: f64, peak: usize, next: impl Fn(usize) -> Option<usize>) -> usize {
    let mut at = peak;
    while let Some(k) = next(at).filter(|&k| !taken[k]) {
        let (here, there) = (samples[at].felt, samples[k].felt);
        let keeps_its_sign = here * there > 0.0;
        let goes_on = here.abs() >= least && there.abs() >= least || there.abs() < here.abs();
        if !(keeps_its_sign && goes_on) {
            break;
        }
        at = k;
    }
    at
}

/// Steps of a zero or a least value between two samples: each is at least halved, or brought to its third power.
const STEPS: u32 = 48;

impl<'a> History<'a> {
    fn new(&Pushed { felt, moved, gravity, least }: &Pushed<'a>) -> Self {
        let begins = |moved: &Excitation| {
            let mut now = 0.0;
            let begin = |section: Section<'_>| {
                let begin = now;
                now += section.velocity_after(section.length) - gravity * section.length;
                begin
            };
            moved.sections().map(begin).collect()
        };
        Self { velocity: moved.iter().map(begins).collect(), felt, moved, gravity, weight: least.max(gravity) }
    }
    /// Returns the sample of a section at a time in it.
    fn at(&self, section: usize, t: f64) -> Sample {
        let of = self.felt.section(section);
        let felt = if of.free { 0.0 } else { of.acceleration_at(t) };
        Sample { section, t, time_s: of.from + t, felt }
    }
    /// Returns the change of velocity from one sample to another, without its sign.
    fn change(&self, begin: &Sample, end: &Sample) -> f64 {
        let along = |(moved, velocity): (&Excitation, &Vec<f64>)| {
            let until = |&Sample { section, t, .. }: &Sample| {
                velocity[section] + moved.section(section).velocity_after(t) - self.gravity * t
            };
            until(end) - until(begin)
        };
        self.moved.iter().zip(&self.velocity).map(along).fold(0.0, libm::hypot)
    }
    /// Returns a shock.
    fn shock(&self, samples: &[Sample], &Reach { peak, ends, beside }: &Reach) -> Shock {
        let [begin, end] = [0, 1].map(|k| self.end_of(samples, ends[k], beside[k]));
        let (peak, time_s) = self.crest(samples, peak);
        Shock { span_s: [begin.time_s, end.time_s], change: self.change(&begin, &end), peak, time_s }
    }
    /// Returns more than it changes the velocity by: from sample to sample, with all that the acceleration may do between its ends and those
    /// beside them.
    fn most(&self, samples: &[Sample], reach: &Reach) -> f64 {
        let [first, last] = reach.ends.map(|k| &samples[k]);
        let beside = |k: usize| {
            let here = &samples[reach.ends[k]];
            let one = |other: &Sample| {
                let pushed = (here.felt.abs() + other.felt.abs() + self.weight) * (here.time_s - other.time_s).abs();
                let jumps = [here, other].map(|sample| self.felt.section(sample.section).delta_v.abs());
                pushed + jumps[0] + jumps[1]
            };
            reach.beside[k].into_iter().flatten().map(|k| one(&samples[k])).fold(0.0, f64::max)
        };
        self.change(first, last) + beside(0) + beside(1)
    }
    fn sampled(&self) -> Vec<Sample> {
        let mut all: Vec<Sample> = Vec::with_capacity(8 * self.felt.sections().len());
        for (n, section) in self.felt.sections().enumerate() {
            let count = if section.free { 1 } else { samples(&section) };
            for k in 0..=count {
                let sample = self.at(n, f64::from(k) / f64::from(count) * section.length);
                // Sections join but for what lever arms miss.
                let joins = |last: &Sample| (last.felt - sample.felt).abs() <= JOINS * last.felt.abs();
                if k > 0 || !all.last().is_some_and(joins) {
                    all.push(sample);
                }
            }
        }
        all
    }
    /// Returns the section in which two neighboring samples lie, and when in it.
    fn between(&self, one: &Sample, other: &Sample) -> (usize, [f64; 2]) {
        let n = one.section.max(other.section);
        let section = self.felt.section(n);
        (n, [one, other].map(|sample| (sample.time_s - section.from).clamp(0.0, section.length)))
    }
    /// Finds where a shock ends whose last sample this is: where its acceleration falls to zero on the way to the sample beyond, or is
    /// least on one side of the last.
    fn end_of(&self, samples: &[Sample], last: usize, [beyond, before]: [Option<usize>; 2]) -> Sample {
        let here = samples[last];
        let Some(next) = beyond.map(|k| &samples[k]) else { return here };
        if here.felt * next.felt <= 0.0 {
            return self.zero(&here, next);
        }
        let sides = [Some(next), before.map(|k| &samples[k])].into_iter().flatten();
        sides.map(|side| self.least(&here, side)).fold(here, |a, b| if b.felt.abs() < a.felt.abs() { b } else { a })
    }
    /// Finds where the acceleration falls to zero between two samples, by the Illinois method.
    fn zero(&self, here: &Sample, beyond: &Sample) -> Sample {
        let (n, [mut a, mut b]) = self.between(here, beyond);
        let section = self.felt.section(n);
        let (mut fa, mut fb) = (here.felt, beyond.felt);
        if fb == 0.0 {
            // Without force from where the section begins.
            return *beyond;
        }
        for _ in 0..STEPS {
            let t = b - fb * (b - a) / (fb - fa);
            if !(t > a.min(b) && t < a.max(b)) {
                break;
            }
            let f = section.acceleration_at(t);
            if f * fb < 0.0 {
                (a, fa) = (b, fb);
            } else {
                fa *= 0.5;
            }
            (b, fb) = (t, f);
            if f == 0.0 {
                break;
            }
        }
        self.at(n, b)
    }
    /// Returns the least acceleration without its sign from one sample to the next, by halves and thirds.
    fn least(&self, here: &Sample, side: &Sample) -> Sample {
        let (n, [mut a, mut b]) = self.between(here, side);
        let section = self.felt.section(n);
        let of = |t: f64| section.acceleration_at(t).abs();
        for _ in 0..STEPS {
            let [one, two] = [a + (b - a) / 3.0, b - (b - a) / 3.0];
            if of(one) <= of(two) { b = two } else { a = one }
        }
        self.at(n, 0.5 * (a + b))
    }
    /// Returns the largest value at a peak and its time: by the parabola through the section on both sides of the sample.
    fn crest(&self, samples: &[Sample], peak: usize) -> (f64, f64) {
        let here = samples[peak];
        let most = (here.felt.abs(), here.time_s);
        let beside = [peak.checked_sub(1), Some(peak + 1)].into_iter().flatten().filter_map(|k| samples.get(k));
        let rises = |other: &Sample| {
            let (n, [from, to]) = self.between(&here, other);
            let (step, section) = (to - from, self.felt.section(n));
            let at = |share: f64| section.acceleration_at(from + share * step).abs();
            let (a, b, c) = (at(0.0), at(0.5), at(1.0));
            let (slope, bend) = (4.0 * b - 3.0 * a - c, 4.0 * (a - 2.0 * b + c));
            let share = if bend < 0.0 { (-slope / bend).clamp(0.0, 1.0) } else { 0.0 };
            (a + share * (slope + 0.5 * bend * share), here.time_s + share * step)
        };
        beside.map(rises).fold(most, |most, one| if one.0 > most.0 { one } else { most })
    }
}

/// Phase of the fastest wave between two samples of a section.
const PHASE: f64 = 0.2;
/// Samples of one section at most.
const MOST: f64 = 512.0;

/// Share of an acceleration by which two sections may differ where they join.
const JOINS: f64 = 0.01;

/// Samples of a section: where it is curved, at least one within it, so that no crest is missed between its ends.
pub(crate) fn samples(section: &Section<'_>) -> u32 {
    let fastest = section.sines.iter().fold(0.0, |most: f64, sine| most.max(sine.rate));
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 512")]
    let count = (fastest * section.length / PHASE).clamp(if fastest > 0.0 { 2.0 } else { 1.0 }, MOST).ceil() as u32;
    count
}

#[cfg(test)]
mod tests {
    use super::*;
    use clatter::Sine;

    /// Of pushes that are nearly alike, some in two directions, the largest shock and the largest acceleration are those of all shocks.
    #[test]
    fn the_largest_is_the_largest_of_all() {
        for n in 0..200_u32 {
            let peak = |k: u32| {
                let x = f64::from((n * 37 + k * 101 + n * k) % 97) / 97.0;
                (1.0 + 0.1 * x) * if (n + k).is_multiple_of(3) { -900.0 } else { 900.0 }
            };
            let felt = pushes(&[0, 1, 2, 3, 4, 5].map(peak));
            for least in [0.0, 20.0] {
                let pushed = Pushed { felt: &felt, moved: from_ref(&felt), gravity: 9.81, least };
                let all = shocks(&pushed);
                assert_eq!(largest_of(&pushed), largest(&all), "{n}");
                let crest = all.iter().map(|shock| shock.peak).fold(0.0, f64::max);
                assert_eq!(crest_of(&pushed).unwrap().0.to_bits(), crest.to_bits(), "{n}");
            }
        }
    }

    /// The peak of a wave lies between two samples a fifth of a radian apart, wherever they are: by a parabola within 1e-5 of it, and a
    /// hundredth of the time between them.
    #[test]
    fn a_peak_is_found_between_the_samples() {
        for k in 0..50 {
            let phase = 0.02 + 0.02 * f64::from(k);
            let sine = Sine { amplitude: 900.0, rate: 2000.0, phase };
            let mut felt = Excitation::default();
            felt.push(Section { sines: &[sine], ..Section::shock(0.0, (3.1 - phase) / 2000.0, 0.0) });
            let found = largest(&shocks(&Pushed { felt: &felt, moved: from_ref(&felt), gravity: 0.0, least: 0.0 }));
            let time_s = (std::f64::consts::FRAC_PI_2 - phase) / 2000.0;
            assert!((found.peak / 900.0 - 1.0).abs() < 1e-5, "{phase}: {}", found.peak);
            assert!((found.time_s - time_s).abs() < 0.01 * 0.2 / 2000.0, "{phase}: {}, not {time_s}", found.time_s);
        }
    }

    /// Returns half-sines of these peaks over 1 ms and a millisecond of flight, in which it turns, after each.
    fn pushes(peaks: &[f64]) -> Excitation {
        let mut felt = Excitation::default();
        for (k, peak) in (0..).zip(peaks) {
            let from = 2e-3 * f64::from(k);
            let sine = Sine { amplitude: *peak, rate: std::f64::consts::PI / 1e-3, phase: 0.0 };
            felt.push(Section { sines: &[sine], ..Section::shock(from, 1e-3, 0.0) });
            felt.push(Section { acceleration: [300.0; 2], free: true, ..Section::shock(from + 1e-3, 1e-3, 0.0) });
        }
        felt
    }

    /// A push of 1.5 g next to one of 3 g is the weight under which a body pivots; alone it is all that there is. The acceleration in
    /// flight is none. Each changes the velocity by 2/π of its peak and less g over its time.
    #[test]
    fn a_push_below_two_weights_is_a_shock_where_it_is_all() {
        let g = 9.81;
        let of = |peaks: &[f64]| {
            let felt = pushes(&peaks.iter().map(|peak| peak * g).collect::<Vec<_>>());
            shocks(&Pushed { felt: &felt, moved: from_ref(&felt), gravity: g, least: WEIGHTS * g })
        };
        for (peaks, found) in
            [(&[1.5, 3.0, 1.9][..], &[3.0][..]), (&[1.5, 1.2], &[1.5, 1.2]), (&[3.0, 2.5], &[3.0, 2.5])]
        {
            let shocks = of(peaks);
            assert_eq!(shocks.len(), found.len(), "{shocks:?}");
            for (shock, peak) in shocks.iter().zip(found) {
                let change = (peak * std::f64::consts::FRAC_2_PI - 1.0) * g * 1e-3;
                assert!((shock.change - change.abs()).abs() < 1e-6, "{shock:?}, not {change}");
            }
        }
    }
}
