//! One drop of a box in any orientation, as it is told.

use std::f64::consts::PI;
use std::io::{self, Write};

use clatter_flight::{BlockDrop, Contact, LEAST_OF_BLOCKS, Stop};

use crate::Failure;
use crate::numbers::{figures, given};
use crate::quantities::neat;

/// A drop of a box.
pub(crate) struct Setup {
    pub(crate) drop: BlockDrop,
    pub(crate) contact: Contact,
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

impl From<Axis> for clatter_assess::Axis {
    fn from(axis: Axis) -> Self {
        match axis {
            Axis::X => Self::X,
            Axis::Y => Self::Y,
            Axis::Z => Self::Z,
            Axis::Any => Self::Any,
        }
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
}

/// Why a flight ends, in words of a table.
pub(crate) fn stopped(stop: &Stop) -> &'static str {
    match stop {
        Stop::AtRest { .. } => "At rest at",
        Stop::BouncedClear { .. } => "Bounced clear",
        _ => "Left at",
    }
}
