//! One drop of a box in any orientation: its presses, and what a place of it goes through.

use std::f64::consts::{PI, TAU};
use std::io::{self, Write};

use clatter_answer::simulate::block::DropAnswer;
use clatter_flight::{BlockDrop, BlockFlight, Contact, LEAST_OF_BLOCKS, Stop};
use clatter_shock::{DampingRatio, Frequencies, Quantity, Spectrum, UnevenFilter};

use crate::Failure;
use crate::numbers::{figures, given};
use crate::quantities::neat;

/// A drop of a box.
pub(crate) struct Setup {
    pub(crate) drop: BlockDrop,
    pub(crate) contact: Contact,
}

/// Samples of a smooth part of a flight, between which lines are straight: of some dozen parts a contact.
const SAMPLES: u32 = 8;
/// A part is followed on for so many periods once the box lies still.
const PERIODS: f64 = 3.0;

/// What a place feels along the axes of the box, over time.
pub(crate) struct Felt {
    times_s: Vec<f64>,
    along_m_s2: [Vec<f64>; 3],
    /// What it feels once the box lies, its turn about the vertical with it.
    at_rest_m_s2: [f64; 3],
    pub(crate) flight: BlockFlight,
}

/// Along which axis a place is asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Axis {
    X,
    Y,
    Z,
    /// The magnitude, of a place on which a part is mounted rigidly.
    Any,
}

impl Axis {
    pub(crate) fn index(self) -> Option<usize> {
        match self {
            Self::X => Some(0),
            Self::Y => Some(1),
            Self::Z => Some(2),
            Self::Any => None,
        }
    }
    pub(crate) fn name(self) -> &'static str {
        ["x", "y", "z", "any"][self.index().unwrap_or(3)]
    }
}

impl Setup {
    /// Refuses a place beyond the box.
    pub(crate) fn within(&self, at_m: [f64; 3]) -> Result<(), Failure> {
        let size = self.drop.block().size_m();
        for ((at, size), axis) in at_m.iter().zip(size).zip(["x", "y", "z"]) {
            if at.is_nan() || at.abs() > 0.5 * size * (1.0 + 1e-9) {
                let half = given(0.5 * size);
                return Err(Failure::Wrong(format!(
                    "--at-m: {axis} = {at:?} m is not within the box, {half} m from its middle"
                )));
            }
        }
        Ok(())
    }

    /// What is said of the drop before the answer.
    pub(crate) fn heading(&self, out: &mut dyn Write) -> io::Result<()> {
        let block = self.drop.block();
        let [length, width, thickness] = block.size_m().map(|x| given(neat(1e3 * x)));
        let [x, y, z] = block.gyration_m().map(|x| figures(1e3 * x));
        let (law, time) = (self.contact.law().name(), given(neat(1e3 * self.contact.time_s())));
        writeln!(
            out,
            "Any orientation, gravity {} m/s2, {law} contacts of {time} ms",
            given(self.drop.gravity_m_s2())
        )?;
        writeln!(
            out,
            "Box of {length} x {width} x {thickness} mm, radii of gyration {x}, {y}, {z} mm; e = {}",
            given(self.contact.restitution())
        )?;
        let [x, y, z] = self.drop.upward().map(|x| figures(libm::acos(x.clamp(-1.0, 1.0)) * 180.0 / PI));
        let speed = figures(self.drop.speed_m_s());
        writeln!(
            out,
            "Its lowest corner touches at {speed} m/s; the vertical is {x}, {y} and {z} degrees from its axes"
        )?;
        writeln!(out)
    }

    /// A restitution that is not followed as it stands.
    pub(crate) fn warning(&self) -> Option<String> {
        let e = self.contact.restitution();
        (self.contact.law().leaves_a_dent() && e < LEAST_OF_BLOCKS).then(|| {
            format!(
                "e = {e:?} is followed as {LEAST_OF_BLOCKS}: hysteretic contacts of a box rebound with that at least"
            )
        })
    }

    /// Where a flight ends by itself before it is at rest.
    pub(crate) fn left(&self, stop: &Stop) -> Option<String> {
        match *stop {
            Stop::TimeLimit { time_s } if time_s < self.drop.time_limit_s() => {
                Some(format!("left at {time_s:?} s, where the box still moves: what follows is not in the answer"))
            }
            Stop::ImpactLimit { .. } => Some("more impacts would follow; --impact-limit=N follows more".to_owned()),
            Stop::EnergyLimit { .. } => Some("left where the energy of the box is not what it should be".to_owned()),
            _ => None,
        }
    }

    pub(crate) fn answer(&self) -> DropAnswer {
        DropAnswer::new(&self.drop, &self.contact)
    }

    /// At a place from the middle of the box.
    pub(crate) fn felt(&self, at_m: [f64; 3]) -> Result<Felt, Failure> {
        let place = self.drop.block().place(at_m);
        let (mut times_s, mut along_m_s2) = (Vec::new(), [const { Vec::new() }; 3]);
        let flight = self.drop.contacts(&self.contact, |step| {
            for k in 0..=SAMPLES {
                let share = f64::from(k) / f64::from(SAMPLES);
                times_s.push(step.from_s + share * step.length_s);
                for (values, value) in along_m_s2.iter_mut().zip(step.felt_m_s2(place, share)) {
                    values.push(value);
                }
            }
        })?;
        let at_rest_m_s2 = flight.at_rest_m_s2(place, self.drop.gravity_m_s2());
        Ok(Felt { times_s, along_m_s2, at_rest_m_s2, flight })
    }
}

impl Felt {
    /// The largest felt acceleration along an axis, or in magnitude, and when.
    pub(crate) fn largest(&self, axis: Axis) -> [f64; 2] {
        let [x, y, z] = &self.along_m_s2;
        let size = |k: usize| match axis.index() {
            Some(axis) => self.along_m_s2[axis][k].abs(),
            None => (x[k] * x[k] + y[k] * y[k] + z[k] * z[k]).sqrt(),
        };
        let largest = (0..self.times_s.len()).max_by(|&a, &b| size(a).total_cmp(&size(b)).then(b.cmp(&a)));
        largest.map_or([0.0; 2], |k| [size(k), self.times_s[k]])
    }

    /// Largest values of a quantity of a part that moves along an axis, from 0, over the whole flight; at rest the weight is on.
    pub(crate) fn peak(
        &self,
        axis: usize,
        omega: f64,
        damping: DampingRatio,
        quantity: Quantity,
    ) -> Result<[f64; 2], Failure> {
        let mut filter = UnevenFilter::new(Frequencies::list(vec![omega / TAU])?, damping, quantity);
        filter.push(&self.times_s, &self.along_m_s2[axis])?;
        if let (Stop::AtRest { .. }, Some(end_s)) = (self.flight.stop, self.times_s.last()) {
            filter.push(&[*end_s, end_s + PERIODS * TAU / omega], &[self.at_rest_m_s2[axis]; 2])?;
            let Spectrum { primary, time_of_peak_s, .. } = filter.finish()?;
            return Ok([primary[0], time_of_peak_s[0]]);
        }
        let Spectrum { maximax, time_of_peak_s, .. } = filter.finish()?;
        Ok([maximax[0], time_of_peak_s[0]])
    }
}

/// Why a flight ends, in words of a table.
pub(crate) fn stopped(stop: &Stop) -> &'static str {
    match stop {
        Stop::AtRest { .. } => "At rest at",
        Stop::BouncedClear { .. } => "Bounced clear",
        _ => "Left at",
    }
}
