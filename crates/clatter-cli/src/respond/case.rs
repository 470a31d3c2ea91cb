//! One drop that was written as data.

use std::io::{self, Write};
use std::path::Path;

use clatter_answer::respond::Largest;
use clatter_answer::respond::case::{self, Answer};
use clatter_assess::Case;

use super::Args;
use super::peaks::doubts;
use crate::inputs::Format;
use crate::numbers::{figures, given};
use crate::text::path as shown;
use crate::words::in_words;
use crate::{Failure, Streams, assess};

impl Args {
    pub(super) fn case(&self, path: &Path, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let case: Case = serde_json::from_str(&assess::text(path)?)
            .map_err(|error| Failure::Wrong(format!("{}: {error}", shown(path))))?;
        let answer = case::answer(&case)?;
        match self.format {
            Format::Table => table(&answer, streams.out).map_err(Failure::Answer),
            Format::Json => streams.json(&answer),
        }
    }
}

fn table(answer: &Answer, out: &mut dyn Write) -> io::Result<()> {
    let Case { drop, model, tolerance, place, .. } = &answer.drop;
    let (speed, e, tilt) = (given(drop.speed_m_s), given(drop.restitution), given(drop.tilt_rad.to_degrees()));
    writeln!(out, "One drop at {speed} m/s, e = {e}, tilt {tilt} deg, by the model {}", model.name())?;
    let [x, y, z] = place.at_m.map(|at| given(1e3 * at));
    writeln!(out, "Place at {x}, {y}, {z} mm from the middle, along {}", place.axis.name())?;
    let row = |out: &mut dyn Write, name: &str, largest: Option<Largest>| {
        let Some(Largest { value, unit, time_s, impact, .. }) = largest else { return Ok(()) };
        let (value, when) = (in_words(unit, None, value.0), figures(1e3 * time_s.0));
        writeln!(out, "  {name:<26}{value:>18}{when:>13}  at impact {impact}")
    };
    let of = &answer.place.answers;
    writeln!(out, "\nLargest at this place                             when, ms")?;
    row(out, "change of velocity", of.velocity_change)?;
    row(out, "acceleration", of.acceleration)?;
    row(out, "change of angular velocity", of.angular_velocity_change)?;
    if let Some(part) = &answer.place.part {
        let [omega, damping] = [part.omega, part.damping].map(|of| given(super::six(of.0)));
        writeln!(out, "\nPeak of the part, W = {omega} rad/s, damping ratio {damping}")?;
        row(out, "acceleration", of.part_acceleration)?;
        row(out, "relative displacement", of.part_displacement)?;
    }
    doubts(*tolerance, of, out)
}
