//! The history of a place as the response of a part takes it.

use std::ops::Range;

use clatter::{Excitation, Section};
use clatter_shock::Pulses;

use clatter_product::Error;

/// Phase of a part within which pulses act by their impulse, their mean time and their spread alone: what else their shape does is at
/// most a sixth of their third moment, below (0.7)³/60 of them.
pub(crate) const SHORT: f64 = 0.7;
/// Phase of a part over which impulses spread without doing less: by (0.1)²/2 of them.
const NARROW: f64 = 0.1;

/// Returns the history of a place as the response takes it; sections that together take no longer than `short_s` are two velocity shocks
/// that do the same.
/// `carried_m_s2` acts from their end on.
pub(crate) fn pulses(felt: &Excitation, short_s: f64, carried_m_s2: f64) -> Result<Pulses, Error> {
    let pulses = if short_s > 0.0 {
        Pulses::of_sections(joined(felt, short_s).sections())
    } else {
        Pulses::of_sections(felt.sections())
    };
    Ok(pulses?.carried(carried_m_s2)?)
}

/// Returns the same motion with sections that are short joined.
fn joined(felt: &Excitation, short_s: f64) -> Excitation {
    let mut all = Excitation::with_capacity(2 * felt.sections().len());
    let (mut moments, mut first) = (Moments::default(), 0);
    for (k, section) in felt.sections().enumerate() {
        if moments.length_s + section.length > short_s {
            moments.join(felt, first..k, NARROW / SHORT * short_s, &mut all);
            (moments, first) = (Moments::default(), k);
        }
        if section.length <= short_s {
            moments.add(&section);
        } else {
            all.push(section);
            first = k + 1;
        }
    }
    moments.join(felt, first..felt.sections().len(), NARROW / SHORT * short_s, &mut all);
    all
}

/// The moments of sections that follow one another: the change of velocity, and its first and second moments in time.
#[derive(Default)]
struct Moments {
    length_s: f64,
    change_m_s: f64,
    first: f64,
    second: f64,
}

impl Moments {
    fn add(&mut self, section: &Section<'_>) {
        let (begun, length) = (self.length_s, section.length);
        let [begin, middle, end] = [0.0, 0.5, 1.0].map(|share| section.velocity_after(share * length));
        // The integral is by parts, and Simpson's rule: pulses are no more than half a period of a wave.
        let first = length * (end - (begin + 4.0 * middle + end) / 6.0);
        let second = length * length * (end - 2.0 * (2.0 * middle + end) / 6.0);
        self.change_m_s += end;
        self.first += begun * end + first;
        self.second += begun * begun * end + 2.0 * begun * first + second;
        self.length_s += length;
    }
    /// Puts half of the impulse before and half after its mean time, as far apart as it spreads, or all at once where that is within
    /// `narrow_s`; the sections themselves where they push to both sides.
    fn join(&self, felt: &Excitation, those: Range<usize>, narrow_s: f64, all: &mut Excitation) {
        let Self { length_s, change_m_s, first, second } = *self;
        let mean = first / change_m_s;
        let spread = (second / change_m_s - mean * mean).max(0.0).sqrt();
        if !(mean - spread >= 0.0 && mean + spread <= length_s) || length_s == 0.0 {
            return those.for_each(|k| all.push(felt.section(k)));
        }
        let from = felt.section(those.start).from;
        let mut quiet = |begun: f64, length_s: f64, change| all.push(Section::shock(from + begun, length_s, change));
        if spread < narrow_s {
            quiet(0.0, mean, 0.0);
            quiet(mean, length_s - mean, change_m_s);
            return;
        }
        quiet(0.0, mean - spread, 0.0);
        quiet(mean - spread, 2.0 * spread, 0.5 * change_m_s);
        quiet(mean + spread, length_s - mean - spread, 0.5 * change_m_s);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pushes of 10, 30, 5 and 20 m/s² for a tenth of a second each: half of their impulse as long before their mean time as the other
    /// half comes after it, so that the impulse and its first and second moment in time are those of the pushes.
    #[test]
    fn pushes_that_are_joined_keep_their_moments() {
        let (pushes, each_s) = ([10.0, 30.0, 5.0, 20.0], 0.1);
        let mut felt = Excitation::default();
        let mut moments = [0.0_f64; 3];
        for (k, push) in (0..4).zip(pushes) {
            let (from, to) = (f64::from(k) * each_s, f64::from(k + 1) * each_s);
            felt.push(Section { acceleration: [push; 2], ..Section::shock(from, each_s, 0.0) });
            for (power, moment) in (1..=3).zip(&mut moments) {
                *moment += push * (to.powi(power) - from.powi(power)) / f64::from(power);
            }
        }
        let joined = joined(&felt, 0.5);
        let halves: Vec<_> = joined.sections().filter(|section| section.delta_v != 0.0).collect();
        assert_eq!(halves.len(), 2, "{joined:?}");
        for (power, moment) in (0..3).zip(moments) {
            let kept: f64 = halves.iter().map(|half| half.delta_v * half.from.powi(power)).sum();
            assert!((kept - moment).abs() < 1e-12, "moment {power}: {kept}, not {moment}");
        }
        let last = joined.sections().last().unwrap();
        assert!((last.from + last.length - 0.4).abs() < 1e-15, "they end with the pushes");
    }
}
