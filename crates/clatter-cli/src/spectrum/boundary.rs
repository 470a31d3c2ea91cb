//! This module shows the damage boundary of a pulse or a record.

use std::io::{self, Write};

use clatter_answer::spectrum::boundary::Boundary;
use clatter_answer::spectrum::{Excitation, Measured};
use clatter_shock::{DamageBoundary, Frequencies, Limit, Pulse, Shape, Suspension};

use super::{Args, QuantityName};
use crate::numbers::figures;
use crate::quantities::Show;
use crate::{Failure, lists};

const BOUNDARY_OF: &str = "--damage-boundary goes with one --pulse with one start or one record of one channel, and with one \
                           --frequency and one --q-factor or --tests";

impl Args {
    /// Finds the damage boundary of a pulse or a record.
    pub(super) fn boundary(&self, excitation: &Excitation, frequencies: &Frequencies) -> Result<Boundary, Failure> {
        if let Some(path) = &self.tests {
            let Some(pulse @ Pulse { shape: Shape::Rectangle, .. }) = one_pulse(excitation) else {
                return Err(Failure::Usage(
                    "--tests goes with one --pulse with one start, a rectangle, as the tests are",
                ));
            };
            let [velocity, acceleration] = lists::tests(path)?;
            let boundary = DamageBoundary::from_tests(&velocity, &acceleration);
            let boundary = boundary.map_err(|reason| Failure::Tests { path: path.clone(), reason })?;
            return Ok(Boundary::of_pulse(&boundary, &pulse)?);
        }
        let ([hz], [damping]) = (frequencies.hz(), &self.damping.ratios()?[..]) else {
            return Err(Failure::Usage(BOUNDARY_OF));
        };
        let level = self.limit.as_ref().and_then(|limit| limit.level);
        let limit = match (self.quantity, level) {
            (_, None) => return Err(Failure::Usage("--damage-boundary needs a --limit of one value")),
            (QuantityName::Acceleration, Some(level)) => Limit::Acceleration(level),
            (QuantityName::RelativeDisplacement, Some(level)) => Limit::RattleSpace(level),
            _ => {
                return Err(Failure::Usage(
                    "--damage-boundary goes with the quantities acceleration and relative-displacement alone",
                ));
            }
        };
        let suspension = Suspension::from_hz(*hz, *damping)?;
        match excitation {
            Excitation::Records(records) => {
                let [Measured { record, .. }] = &records[..] else { return Err(Failure::Usage(BOUNDARY_OF)) };
                let [channel] = record.channels() else {
                    return Err(Failure::Usage("--damage-boundary goes with one channel: --acceleration picks one"));
                };
                let bad = |reason| Failure::Record { path: self.excitation.records[0].clone(), reason };
                Boundary::of_channel(channel, self.interpolation.into(), &suspension, limit).map_err(bad)
            }
            excitation => {
                let pulse = one_pulse(excitation).ok_or(Failure::Usage(BOUNDARY_OF))?;
                Ok(Boundary::of_pulse(&DamageBoundary::new(suspension, limit, pulse.shape)?, &pulse)?)
            }
        }
    }
}

fn one_pulse(excitation: &Excitation) -> Option<Pulse> {
    if let Excitation::Pulses(pulses) = excitation
        && let [pulse] = pulses[..]
    {
        Some(pulse)
    } else {
        None
    }
}

pub(super) fn table(of: &Boundary, acceleration: Show, out: &mut dyn Write) -> io::Result<()> {
    let line = |out: &mut dyn Write, name: &str, value: f64, unit: &str| {
        writeln!(out, "{name:<28}{:>12} {unit}", figures(value))
    };
    writeln!(out, "\nDamage boundary for {}", of.of)?;
    match of.critical_velocity_change {
        Some(velocity) => line(out, "Critical velocity change", velocity, "m/s")?,
        None => writeln!(out, "No critical velocity change: both directions cancel")?,
    }
    line(out, "Critical acceleration", acceleration.value(of.critical_acceleration), acceleration.name())?;
    if let Some(knee) = of.knee_velocity_change {
        line(out, "Knee at a velocity change of", knee, "m/s")?;
    }
    line(out, "This shock, velocity change", of.velocity_change, "m/s")?;
    line(out, "            acceleration", acceleration.value(of.acceleration), acceleration.name())?;
    let word = if of.margin.is_safe() { "dB: no damage" } else { "dB: damage" };
    line(out, "            margin", of.margin.decibel(), word)?;
    writeln!(out)
}
