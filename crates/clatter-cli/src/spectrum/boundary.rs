//! The damage boundary of a pulse or a record.

use std::io::{self, Write};

use clatter_shock::{DamageBoundary, Frequencies, HistoryBoundary, Limit, Margin, Pulse, Shape, Suspension};

use super::records::{Measured, largest};
use super::{Args, QuantityName};
use crate::excitation::{FrequencyArg, shape_name};
use crate::numbers::figures;
use crate::quantities::Show;
use crate::{Failure, lists};

/// The damage boundary, and where the shock stands.
pub(super) struct Boundary {
    /// Of which shape, or of which record.
    pub(super) of: String,
    /// None where velocities cancel.
    pub(super) critical_velocity_change: Option<f64>,
    pub(super) critical_acceleration: f64,
    pub(super) knee_velocity_change: Option<f64>,
    pub(super) curve: Vec<(f64, f64)>,
    pub(super) velocity_change: f64,
    pub(super) acceleration: f64,
    pub(super) margin: Margin,
}

const BOUNDARY_OF: &str = "--damage-boundary goes with one --pulse with one start or one record of one channel, and with one \
                           --frequency and one --q-factor or --tests";
/// Points of the damage boundary between the critical velocity change and the knee.
const BOUNDARY_POINTS: usize = 200;

impl Args {
    /// The damage boundary of a pulse or a record.
    pub(super) fn boundary(&self, records: &[Measured], frequencies: &FrequencyArg) -> Result<Boundary, Failure> {
        if let Some(path) = &self.tests {
            let [pulse @ Pulse { shape: Shape::Rectangle, .. }] = self.pulses()?[..] else {
                return Err(Failure::Usage(
                    "--tests goes with one --pulse with one start, a rectangle, as the tests are",
                ));
            };
            let [velocity, acceleration] = lists::tests(path)?;
            let boundary = DamageBoundary::from_tests(&velocity, &acceleration);
            return Boundary::of_pulse(
                boundary.map_err(|reason| Failure::Tests { path: path.clone(), reason })?,
                pulse,
            );
        }
        let ([hz], [damping]) = (frequencies.list.hz(), &self.damping.ratios()?[..]) else {
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
        match (&self.pulses()?[..], records) {
            ([pulse], _) => Boundary::of_pulse(DamageBoundary::new(suspension, limit, pulse.shape)?, *pulse),
            ([], [measured]) => of_record(self, measured, suspension, limit),
            _ => Err(Failure::Usage(BOUNDARY_OF)),
        }
    }
}

impl Boundary {
    fn of_pulse(numbers: DamageBoundary, pulse: Pulse) -> Result<Self, Failure> {
        let knee = numbers.knee_velocity_change();
        Ok(Self {
            of: shape_name(pulse.shape),
            critical_velocity_change: Some(numbers.critical_velocity_change()),
            critical_acceleration: numbers.critical_acceleration(),
            knee_velocity_change: Some(knee),
            curve: numbers.curve(BOUNDARY_POINTS)?,
            velocity_change: pulse.velocity_change().abs(),
            acceleration: pulse.amplitude.abs(),
            margin: numbers.margin(pulse.amplitude, pulse.duration)?,
        })
    }
}

impl Boundary {
    pub(super) fn table(&self, acceleration: Show, out: &mut dyn Write) -> io::Result<()> {
        let line = |out: &mut dyn Write, name: &str, value: f64, unit: &str| {
            writeln!(out, "{name:<28}{:>12} {unit}", figures(value))
        };
        writeln!(out, "\nDamage boundary for {}", self.of)?;
        match self.critical_velocity_change {
            Some(velocity) => line(out, "Critical velocity change", velocity, "m/s")?,
            None => writeln!(out, "No critical velocity change: both directions cancel")?,
        }
        line(out, "Critical acceleration", acceleration.value(self.critical_acceleration), acceleration.name())?;
        if let Some(knee) = self.knee_velocity_change {
            line(out, "Knee at a velocity change of", knee, "m/s")?;
        }
        line(out, "This shock, velocity change", self.velocity_change, "m/s")?;
        line(out, "            acceleration", acceleration.value(self.acceleration), acceleration.name())?;
        let word = if self.margin.is_safe() { "dB: no damage" } else { "dB: damage" };
        line(out, "            margin", self.margin.decibel(), word)?;
        writeln!(out)
    }
}

/// The damage boundary of a record of one channel.
fn of_record(args: &Args, measured: &Measured, suspension: Suspension, limit: Limit) -> Result<Boundary, Failure> {
    let Measured { path, record, .. } = measured;
    let [channel] = record.channels() else {
        return Err(Failure::Usage("--damage-boundary goes with one channel: --acceleration picks one"));
    };
    let bad = |reason: clatter_shock::Error| Failure::Record { path: path.clone(), reason: reason.into() };
    let points = channel.history(args.interpolation.into());
    let numbers = HistoryBoundary::new(suspension, limit, &points).map_err(bad)?;
    let hz = Frequencies::list(vec![suspension.omega() / std::f64::consts::TAU])?;
    let (quantity, between) = (args.quantity.quantity(), args.interpolation.into());
    let spectrum = channel.spectrum(&hz, suspension.damping(), quantity, between, |_| ());
    let demand = spectrum.map_err(|reason| Failure::Record { path: path.clone(), reason })?.maximax[0];
    let (Limit::Acceleration(allowed) | Limit::RattleSpace(allowed)) = limit;
    let curve = if numbers.critical_velocity_change().is_some() { numbers.curve(BOUNDARY_POINTS)? } else { Vec::new() };
    Ok(Boundary {
        of: channel.name.clone(),
        critical_velocity_change: numbers.critical_velocity_change(),
        critical_acceleration: numbers.critical_acceleration(),
        knee_velocity_change: numbers.knee_velocity_change(),
        curve,
        velocity_change: velocity_change(&points).abs(),
        acceleration: largest(channel),
        margin: Margin { allowed, demand },
    })
}

/// The area below straight lines, in m/s.
fn velocity_change(points: &[(f64, f64)]) -> f64 {
    points.windows(2).map(|pair| (pair[1].0 - pair[0].0) * 0.5 * (pair[0].1 + pair[1].1)).sum()
}
