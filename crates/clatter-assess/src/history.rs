//! The history of a place as the response of a part takes it.

use std::ops::Range;

use clatter_flight::Stretch;
use clatter_shock::{Pulses, Section, Sine};

use crate::Error;

/// Phase of a part within which pulses act by their impulse, their mean time and their spread alone: what else their shape does is at
/// most a sixth of their third moment, below (0.7)³/60 of them.
pub(crate) const SHORT: f64 = 0.7;
/// Phase of a part over which impulses spread without doing less: by (0.1)²/2 of them.
const NARROW: f64 = 0.1;

/// The history of a place as the response takes it; sections that together take no longer than `short_s` are two velocity shocks
/// that do the same.
/// `carried_m_s2` acts from their end on.
pub(crate) fn pulses<const N: usize>(
    sections: &[Stretch<N>],
    short_s: f64,
    carried_m_s2: f64,
) -> Result<Pulses, Error> {
    let mut pieces = Pieces {
        narrow_s: NARROW / SHORT * short_s,
        sines: Vec::with_capacity(2 * sections.len()),
        all: Vec::with_capacity(2 * sections.len()),
    };
    let (mut joined, mut first) = (Moments::default(), 0);
    for (k, section) in sections.iter().enumerate() {
        if joined.length_s + section.length_s > short_s {
            pieces.join(&joined, &sections[first..k]);
            (joined, first) = (Moments::default(), k);
        }
        if section.length_s <= short_s {
            joined.add(section);
        } else {
            pieces.add(section);
            first = k + 1;
        }
    }
    pieces.join(&joined, &sections[first..]);
    let one = |piece: &Piece| Section {
        length: piece.length_s,
        delta_v: piece.delta_v_m_s,
        acceleration: piece.line_m_s2,
        sines: &pieces.sines[piece.sines.clone()],
    };
    let start = sections.first().map_or(0.0, |section| section.from_s);
    Ok(Pulses::of_sections(start, pieces.all.iter().map(one))?.carried(carried_m_s2)?)
}

/// A section, with the numbers of its sines.
#[derive(Default)]
struct Piece {
    length_s: f64,
    delta_v_m_s: f64,
    line_m_s2: [f64; 2],
    sines: Range<usize>,
}

struct Pieces {
    /// Less of a spread does not count.
    narrow_s: f64,
    sines: Vec<Sine>,
    all: Vec<Piece>,
}

impl Pieces {
    fn add<const N: usize>(&mut self, section: &Stretch<N>) {
        let first = self.sines.len();
        let waves = section.waves.iter().filter(|w| w.amplitude_m_s2 != 0.0 && w.rate_rad_s > 0.0);
        self.sines.extend(waves.map(|w| Sine { amplitude: w.amplitude_m_s2, rate: w.rate_rad_s, phase: w.phase_rad }));
        self.all.push(Piece {
            length_s: section.length_s,
            delta_v_m_s: section.delta_v_m_s,
            line_m_s2: section.acceleration_m_s2,
            sines: first..self.sines.len(),
        });
    }
    /// Half of the impulse before and half after its mean time, as far apart as it spreads, or all at once; the sections themselves
    /// where they push to both sides.
    fn join<const N: usize>(&mut self, joined: &Moments, sections: &[Stretch<N>]) {
        let Moments { length_s, change_m_s, first, second } = *joined;
        let mean = first / change_m_s;
        let spread = (second / change_m_s - mean * mean).max(0.0).sqrt();
        if !(mean - spread >= 0.0 && mean + spread <= length_s) || length_s == 0.0 {
            return sections.iter().for_each(|section| self.add(section));
        }
        let quiet = |length_s: f64, delta_v_m_s: f64| Piece { length_s, delta_v_m_s, ..Piece::default() };
        if spread < self.narrow_s {
            self.all.extend([quiet(mean, 0.0), quiet(length_s - mean, change_m_s)]);
            return;
        }
        let half = 0.5 * change_m_s;
        self.all.push(quiet(mean - spread, 0.0));
        self.all.push(quiet(2.0 * spread, half));
        self.all.push(quiet(length_s - mean - spread, half));
    }
}

/// Of sections that follow one another: the change of velocity, and its first and second moments in time.
#[derive(Default)]
struct Moments {
    length_s: f64,
    change_m_s: f64,
    first: f64,
    second: f64,
}

impl Moments {
    fn add<const N: usize>(&mut self, section: &Stretch<N>) {
        let (begun, length) = (self.length_s, section.length_s);
        let [begin, middle, end] = [0.0, 0.5, 1.0].map(|share| section.velocity_after(share * length));
        // By parts, and Simpson's rule: pulses are no more than half a period of a wave.
        let first = length * (end - (begin + 4.0 * middle + end) / 6.0);
        let second = length * length * (end - 2.0 * (2.0 * middle + end) / 6.0);
        self.change_m_s += end;
        self.first += begun * end + first;
        self.second += begun * begun * end + 2.0 * begun * first + second;
        self.length_s += length;
    }
}
