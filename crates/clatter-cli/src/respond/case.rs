//! One drop that was written as data.

use std::io::{self, Write};
use std::path::Path;

use clatter_answer::respond::case::{self, Answer};
use clatter_assess::Case;

use super::{Args, peaks};
use crate::inputs::Format;
use crate::numbers::given;
use crate::text::path as shown;
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
    peaks::place(place.at_m, place.axis.name(), out)?;
    peaks::largest_values(&answer.place, *tolerance, out)
}
