//! The history of a place as the response of a part takes it.

use clatter_flight::Stretch;
use clatter_shock::{Pulses, Section, Sine};

use crate::Error;

/// Phase of a part within which a pulse acts by its impulse and its mean time: what its shape adds is below (0.7)²/24 of it.
pub(crate) const SHORT: f64 = 0.7;

/// The history of a place as the response takes it; sections of less than `short_s` are joined up to that.
pub(crate) fn pulses(sections: &[Stretch], short_s: f64) -> Result<Pulses, Error> {
    let mut pieces = Pieces { sines: Vec::with_capacity(2 * sections.len()), all: Vec::with_capacity(sections.len()) };
    let mut joined = Joined::default();
    for section in sections {
        if joined.length_s + section.length_s > short_s {
            pieces.join(&joined);
            joined = Joined::default();
        }
        if section.length_s <= short_s {
            joined.add(section);
        } else {
            pieces.add(section);
        }
    }
    pieces.join(&joined);
    let one = |(length, delta_v, acceleration, range): &(f64, f64, [f64; 2], std::ops::Range<usize>)| Section {
        length: *length,
        delta_v: *delta_v,
        acceleration: *acceleration,
        sines: &pieces.sines[range.clone()],
    };
    let start = sections.first().map_or(0.0, |section| section.from_s);
    Ok(Pulses::of_sections(start, pieces.all.iter().map(one))?)
}

/// A history: lengths, velocity shocks, straight lines, and which of the sines.
struct Pieces {
    sines: Vec<Sine>,
    all: Vec<(f64, f64, [f64; 2], std::ops::Range<usize>)>,
}

impl Pieces {
    fn add(&mut self, section: &Stretch) {
        let first = self.sines.len();
        let waves = section.waves.iter().filter(|w| w.amplitude_m_s2 != 0.0 && w.rate_rad_s > 0.0);
        self.sines.extend(waves.map(|w| Sine { amplitude: w.amplitude_m_s2, rate: w.rate_rad_s, phase: w.phase_rad }));
        let range = first..self.sines.len();
        self.all.push((section.length_s, section.delta_v_m_s, section.acceleration_m_s2, range));
    }
    /// A velocity shock of the same impulse at the mean time; where that is not within, a straight line that does the same.
    fn join(&mut self, joined: &Joined) {
        let Joined { length_s: length, change_m_s: change, moved_m } = *joined;
        let mean = length - moved_m / change;
        if (0.0..=length).contains(&mean) {
            self.all.push((mean, 0.0, [0.0; 2], 0..0));
            self.all.push((length - mean, change, [0.0; 2], 0..0));
        } else if length > 0.0 {
            // The change is L (a + b)/2, and it moves by L² (2a + b)/6.
            let (mean, moved) = (change / length, 6.0 * moved_m / (length * length));
            let first = moved - 2.0 * mean;
            self.all.push((length, 0.0, [first, 2.0 * mean - first], 0..0));
        }
    }
}

/// Sections that act as one.
#[derive(Default)]
struct Joined {
    length_s: f64,
    /// Change of velocity, and its integral over time: the displacement.
    change_m_s: f64,
    moved_m: f64,
}

impl Joined {
    fn add(&mut self, section: &Stretch) {
        let length = section.length_s;
        let [begin, middle, end] = [0.0, 0.5, 1.0].map(|share| section.velocity_after(share * length));
        self.moved_m += length * (self.change_m_s + (begin + 4.0 * middle + end) / 6.0);
        self.change_m_s += end;
        self.length_s += length;
    }
}
