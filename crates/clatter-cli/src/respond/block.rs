//! A part of a box in one drop.

use std::io::{self, Write};

use clatter_answer::simulate::block::{DropAnswer, StopAnswer};
use clatter_shock::{DampingRatio, Quantity};
use serde::Serialize;

use super::Args;
use crate::block::{Axis, Felt, Setup};
use crate::drop_args::BesideBlock;
use crate::inputs::Format;
use crate::numbers::{Json, figures, given};
use crate::{Failure, Streams};

impl Args {
    /// Where the part is, from the middle.
    fn at_of_block(&self, size_m: [f64; 3]) -> Result<[f64; 3], Failure> {
        if let Some(at_m) = self.at_m {
            return Ok(at_m);
        }
        let Some(at) = self.at else {
            return Err(Failure::Usage("where the part of a box is has to be given: --at=X,Y,Z from its middle"));
        };
        let mut at_m = size_m;
        for (at, place) in at_m.iter_mut().zip(at.of_block("--at")?) {
            let half = 0.5 * *at;
            *at = half * place.relative("--at", Some(half))?;
        }
        Ok(at_m)
    }

    pub(super) fn block(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        if self.output.is_some() || self.flat || self.equivalent_pulse {
            return Err(Failure::Usage("-o, --flat and --equivalent-pulse go with bars alone"));
        }
        let gyration = self.inertia.given().map(|radii| radii.of_block(self.inertia.flag())).transpose()?;
        let setup = self.drop.block(&BesideBlock {
            model: self.model,
            e: self.e,
            gyration,
            spin_rad_s: self.spin_rad_s.unwrap_or_default(),
            time_limit_s: None,
            impact_limit: usize::MAX,
        })?;
        let at_m = self.at_of_block(setup.drop.block().size_m())?;
        setup.within(at_m)?;
        let axis = self.axis.unwrap_or(Axis::Z);
        let felt = setup.felt(at_m)?;
        let damping = self.damping.ratio()?;
        let part = match (self.omega(), axis.index()) {
            (Some(_), None) => {
                return Err(Failure::Usage(
                    "a part that swings does so along one axis: --axis=x, y or z, or no --omega",
                ));
            }
            (Some(omega), Some(axis)) => Some(Part::new(&felt, axis, omega, damping)?),
            (None, _) => None,
        };
        let answer = Answer {
            drop: setup.answer(),
            contact_law: setup.contact.law().name(),
            at_m: at_m.map(Json),
            axis: axis.name(),
            part,
            acceleration: felt.largest(axis).into(),
            stop: StopAnswer::new(&felt.flight.stop),
        };
        match self.format {
            Format::Table => answer.table(&setup, streams.out).map_err(Failure::Answer)?,
            Format::Json => streams.json(&answer)?,
        }
        for warning in setup.warning().into_iter().chain(setup.left(&felt.flight.stop)) {
            streams.note("warning", warning);
        }
        self.warn(std::iter::empty(), streams);
        Ok(())
    }
}

#[derive(Serialize)]
struct Answer {
    #[serde(flatten)]
    drop: DropAnswer,
    contact_law: &'static str,
    at_m: [Json; 3],
    axis: &'static str,
    #[serde(flatten)]
    part: Option<Part>,
    /// What an accelerometer at the place feels at most along the axis.
    acceleration: Value,
    stop: StopAnswer,
}

#[derive(Serialize)]
struct Value {
    value_m_s2: Json,
    time_s: Json,
}

impl From<[f64; 2]> for Value {
    fn from([value, time]: [f64; 2]) -> Self {
        Self { value_m_s2: Json(value), time_s: Json(time) }
    }
}

/// A part on its suspension.
#[derive(Serialize)]
struct Part {
    omega: Json,
    damping: Json,
    omega_peak_relative_displacement: Json,
    time_of_peak_relative_displacement: Json,
    peak_absolute_acceleration_over_omega: Json,
    time_of_peak: Json,
}

impl Part {
    fn new(felt: &Felt, axis: usize, omega: f64, damping: DampingRatio) -> Result<Self, Failure> {
        let [displacement, when] = felt.peak(axis, omega, damping, Quantity::PseudoVelocity)?;
        let [acceleration, time] = felt.peak(axis, omega, damping, Quantity::AbsoluteAcceleration)?;
        Ok(Self {
            omega: Json(omega),
            damping: Json(damping.get()),
            omega_peak_relative_displacement: Json(displacement),
            time_of_peak_relative_displacement: Json(when),
            peak_absolute_acceleration_over_omega: Json(acceleration / omega),
            time_of_peak: Json(time),
        })
    }
}

impl Answer {
    fn table(&self, setup: &Setup, out: &mut dyn Write) -> io::Result<()> {
        setup.heading(out)?;
        let [x, y, z] = self.at_m.map(|x| given(1e3 * x.0));
        let axis = if self.axis == "any" { "in magnitude".to_owned() } else { format!("along {}", self.axis) };
        writeln!(out, "Place at {x}, {y}, {z} mm from the middle, {axis}")?;
        writeln!(out)?;
        writeln!(out, "Largest at this place                        when, ms")?;
        let row = |out: &mut dyn Write, name: &str, value: String, time: f64| {
            writeln!(out, "  {name:<22}{value:>16}{:>13}", figures(1e3 * time))
        };
        let gn = |x: f64| format!("{} gn", figures(x / clatter_assess::STANDARD_GRAVITY_M_S2));
        row(out, "acceleration", gn(self.acceleration.value_m_s2.0), self.acceleration.time_s.0)?;
        let Some(part) = &self.part else { return Ok(()) };
        writeln!(out)?;
        writeln!(out, "Peak of the part, W = {} rad/s, damping ratio {}", given(part.omega.0), given(part.damping.0))?;
        let omega = part.omega.0;
        let acceleration = gn(omega * part.peak_absolute_acceleration_over_omega.0);
        row(out, "acceleration", acceleration, part.time_of_peak.0)?;
        let displacement = format!("{} mm", figures(1e3 * part.omega_peak_relative_displacement.0 / omega));
        row(out, "relative displacement", displacement, part.time_of_peak_relative_displacement.0)
    }
}
