//! What one shock is, at a place and of the turning of the product: one definition for every command and page.
//!
//! Of contacts that take time, shocks are taken from the largest peak of the felt acceleration down. Each reaches on both sides as
//! long as the sign is kept and a tenth of its peak is exceeded, and from there as long as it goes on falling; never into an
//! earlier one. Its change of velocity is that of the place over it: the integral of what is felt, less g times its length. So a lone
//! contact gives (1 + e) v, two presses are one shock where the push between them never falls below a tenth, and a long gentle tail
//! is none. In free flight nothing is felt. Instant impacts are each a shock; those at one instant add up.

use clatter_flight::{Model, Stretch, Strike};

use crate::drop::{Followed, Motion};

/// One shock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Shock {
    /// From when to when.
    pub(crate) span_s: [f64; 2],
    /// Change of velocity, without its sign.
    pub(crate) change: f64,
    /// Largest acceleration in it, without its sign; infinite for an instant impact.
    pub(crate) peak: f64,
    /// When that is.
    pub(crate) time_s: f64,
}

/// Share of its peak down to which a shock reaches, whatever the acceleration does in between.
const TENTH: f64 = 0.1;

impl Followed {
    /// The shocks of a place that feels these sections, in order of time.
    pub(crate) fn shocks(&self, position_m: f64, sections: &[Stretch]) -> Vec<Shock> {
        match &self.motion {
            Motion::Impacts(_, _, flight) => {
                let s = self.drop.relative(position_m);
                at_instants(flight.strikes.iter().map(|k| (k.time_s, k.delta_v_at(s))))
            }
            Motion::Contacts(_) => shocks(sections, self.drop.gravity_m_s2),
        }
    }

    /// The same of the turning of the product.
    pub(crate) fn turns(&self) -> Vec<Shock> {
        match &self.motion {
            Motion::Impacts(scene, model, flight) => {
                let [a, b] = scene.body().arms_m();
                let real = *model == Model::FiniteTilt;
                let mut before = scene.spin_rad_s();
                let turn = |k: &Strike| {
                    let cos = if real { k.tilt_rad.cos().abs() } else { 1.0 };
                    // Next to upright the velocities of both ends say little of the turn; in flight the spin stays.
                    let [da, db] = k.delta_v_m_s;
                    let turn = if cos > 0.1 { (db - da) / ((a + b) * cos) } else { k.spin_rad_s - before };
                    before = k.spin_rad_s;
                    (k.time_s, turn)
                };
                at_instants(flight.strikes.iter().map(turn))
            }
            Motion::Contacts(flight) => shocks(&flight.turned(self.precision), 0.0),
        }
    }
}

impl Shock {
    /// That nothing happens.
    const NONE: Self = Self { span_s: [0.0; 2], change: 0.0, peak: 0.0, time_s: 0.0 };
}

/// The largest of some shocks; one of 0 where there is none.
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

/// A sample of what is felt: its section, time, acceleration, and the change of velocity until then.
#[derive(Debug, Clone, Copy)]
struct Sample {
    section: usize,
    time_s: f64,
    felt: f64,
    velocity: f64,
}

/// The shocks of a felt acceleration, which falls with `gravity` besides.
fn shocks(sections: &[Stretch], gravity: f64) -> Vec<Shock> {
    let samples = sampled(sections, gravity);
    let size = |k: usize| samples[k].felt.abs();
    let is_peak = |k: &usize| {
        let (k, before) = (*k, k.checked_sub(1));
        let rises = before.is_none_or(|j| size(j) < size(k) || samples[j].felt * samples[k].felt <= 0.0);
        let next = k + 1;
        let falls = next == samples.len() || size(next) <= size(k) || samples[next].felt * samples[k].felt <= 0.0;
        size(k) > 0.0 && rises && falls
    };
    let mut peaks: Vec<usize> = (0..samples.len()).filter(is_peak).collect();
    peaks.sort_by(|&j, &k| size(k).total_cmp(&size(j)).then(j.cmp(&k)));
    let mut taken = vec![false; samples.len()];
    let mut found = Vec::new();
    for peak in peaks {
        if taken[peak] {
            continue;
        }
        let first = reach(&samples, &taken, peak, |k| k.checked_sub(1));
        let last = reach(&samples, &taken, peak, |k| Some(k + 1).filter(|k| *k < samples.len()));
        taken[first..=last].fill(true);
        let [begin, end] = [
            crossing(&samples[first], first.checked_sub(1).map(|k| &samples[k])),
            crossing(&samples[last], samples.get(last + 1)),
        ];
        let (peak, time_s) = crest(sections, &samples, peak);
        let change = (end.velocity - begin.velocity).abs();
        found.push(Shock { span_s: [begin.time_s, end.time_s], change, peak, time_s });
    }
    found.sort_by(|a, b| a.span_s[0].total_cmp(&b.span_s[0]));
    found
}

/// The last sample to which the shock of a peak reaches on one side.
fn reach(samples: &[Sample], taken: &[bool], peak: usize, next: impl Fn(usize) -> Option<usize>) -> usize {
    let (least, mut at) = (TENTH * samples[peak].felt.abs(), peak);
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

/// Where the acceleration falls to zero between the last sample of a shock and the one beyond, by a straight line; the sample itself
/// where it does not.
fn crossing(last: &Sample, beyond: Option<&Sample>) -> Sample {
    match beyond {
        Some(beyond) if last.felt * beyond.felt < 0.0 => {
            let share = last.felt / (last.felt - beyond.felt);
            let time_s = last.time_s + share * (beyond.time_s - last.time_s);
            // The velocity is flat there: by the parabola through both.
            let velocity = last.velocity + 0.5 * last.felt * (time_s - last.time_s);
            Sample { time_s, felt: 0.0, velocity, ..*last }
        }
        Some(beyond) if beyond.felt == 0.0 => *beyond,
        _ => *last,
    }
}

/// The largest value at a peak and its time: by the parabola through the section on both sides of the sample.
fn crest(sections: &[Stretch], samples: &[Sample], peak: usize) -> (f64, f64) {
    let here = samples[peak];
    let most = (here.felt.abs(), here.time_s);
    let beside = [peak.checked_sub(1), Some(peak + 1)].into_iter().flatten().filter_map(|k| samples.get(k));
    let rises = |other: &Sample| {
        let section = &sections[other.section.max(here.section)];
        let [from, to] = [here, *other].map(|s| (s.time_s - section.from_s).clamp(0.0, section.length_s));
        let step = to - from;
        let at = |share: f64| section.acceleration_at(from + share * step).abs();
        let (a, b, c) = (at(0.0), at(0.5), at(1.0));
        let (slope, bend) = (4.0 * b - 3.0 * a - c, 4.0 * (a - 2.0 * b + c));
        let share = if bend < 0.0 { (-slope / bend).clamp(0.0, 1.0) } else { 0.0 };
        (a + share * (slope + 0.5 * bend * share), here.time_s + share * step)
    };
    beside.map(rises).fold(most, |most, one| if one.0 > most.0 { one } else { most })
}

/// Phase of the fastest wave between two samples of a section.
const PHASE: f64 = 0.2;
/// Samples of one section at most.
const MOST: f64 = 512.0;

/// Share of an acceleration by which two sections may differ where they join.
const JOINS: f64 = 0.01;

/// Samples of a section over a time.
pub(crate) fn samples(section: &Stretch, length_s: f64) -> u32 {
    let fastest =
        section.waves.iter().filter(|w| w.amplitude_m_s2 != 0.0).fold(0.0, |most: f64, w| most.max(w.rate_rad_s));
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 512")]
    let count = (fastest * length_s / PHASE).clamp(1.0, MOST).ceil() as u32;
    count
}

fn sampled(sections: &[Stretch], gravity: f64) -> Vec<Sample> {
    let mut all = Vec::with_capacity(8 * sections.len());
    let mut velocity = 0.0;
    for (n, section) in sections.iter().enumerate() {
        let count = if section.free { 1 } else { samples(section, section.length_s) };
        for k in 0..=count {
            let t = f64::from(k) / f64::from(count) * section.length_s;
            let fallen = section.velocity_after(t) - gravity * t;
            let felt = if section.free { 0.0 } else { section.acceleration_at(t) };
            // Sections join but for what lever arms miss.
            if k == 0 && all.last().is_some_and(|last: &Sample| (last.felt - felt).abs() <= JOINS * last.felt.abs()) {
                continue;
            }
            all.push(Sample { section: n, time_s: section.from_s + t, felt, velocity: velocity + fallen });
        }
        velocity += section.velocity_after(section.length_s) - gravity * section.length_s;
    }
    all
}
