//! This module shows the safe zone of a plate, which is a polygon.

use std::io::{self, Write};

use clatter::{Corner, Extent, Plate};
use clatter_answer::zone::plate::{self, Answer, Question};

use super::Args;
use crate::inputs::{RowFormat, Values};
use crate::numbers::{digits, figures, given};
use crate::{Failure, Streams};

impl Args {
    pub(super) fn plate(
        &self,
        plate: &Plate,
        gap: Option<Values<1, 2>>,
        streams: &mut Streams<'_>,
    ) -> Result<(), Failure> {
        if self.first.is_some() {
            return Err(Failure::Usage(
                "--first goes with a bar; one drop of a plate, corner a first, is --height-gap=HX,HY",
            ));
        }
        let mut question = Question::new(*plate, self.threshold.clone());
        question.height_gap = gap.map(|gap| gap.of_plate("--height-gap")).transpose()?;
        let answer = plate::answer(&question)?;
        match self.format {
            RowFormat::Table => table(&question, &answer, streams.out).map_err(Failure::Answer)?,
            RowFormat::Csv => csv(&answer, streams.out).map_err(Failure::Answer)?,
            RowFormat::Json => streams.json(&answer)?,
        }
        if !answer.proven && self.format != RowFormat::Json {
            let later = figures(answer.later.0);
            let what = format_args!(
                "impacts that were not followed may give a corner up to {later} v0: the zones may be smaller"
            );
            streams.note("warning", what);
        }
        Ok(())
    }
}

fn table(question: &Question, answer: &Answer, out: &mut dyn Write) -> io::Result<()> {
    let Question { plate, height_gap, .. } = question;
    let [kx, ky] = plate.gyration_ratios().map(given);
    let of = height_gap.map_or("in any direction, any corner first".to_owned(), |gaps| {
        let [hx, hy] = gaps.map(given);
        format!("with b at {hx} h0 and d at {hy} h0 when a touches")
    });
    writeln!(out, "Safe zones of a plate with gyration ratios {kx},{ky}, e = {}, {of}", given(plate.e()))?;
    let seen: Vec<_> = Corner::ALL
        .iter()
        .map(|corner| format!("{} up to {} v0", corner.letter(), figures(answer.shocks.at(corner.position()))))
        .collect();
    writeln!(out, "Corners see: {}", seen.join(", "))?;
    writeln!(out, "\n{:>12} {:>10}   corners of the safe zone", "threshold", "safe")?;
    writeln!(out, "{:>12} {:>10}   half-lengths,half-widths", "v0", "of the area")?;
    for zone in &answer.zones {
        // No place is written as −0.0000.
        let shown = |x: f64| (1e4 * x).round() / 1e4 + 0.0;
        let places: Vec<_> = zone.polygon.iter().map(|[x, y]| format!("{:.4},{:.4}", shown(x.0), shown(y.0))).collect();
        let meaning = match zone.extent {
            Extent::None => "none: every place sees more".to_owned(),
            Extent::Part => places.join("  "),
            Extent::Whole => "the whole plate".to_owned(),
        };
        writeln!(out, "{:>12} {:>9.1} %   {meaning}", figures(zone.threshold.0), 100.0 * zone.share.0)?;
    }
    Ok(())
}

fn csv(answer: &Answer, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "threshold,extent,share,x,y")?;
    for zone in &answer.zones {
        let head = format!("{},{},{}", digits(zone.threshold.0), super::zone::name(zone.extent), digits(zone.share.0));
        if zone.polygon.is_empty() {
            writeln!(out, "{head},,")?;
        }
        for [x, y] in &zone.polygon {
            writeln!(out, "{head},{},{}", digits(x.0), digits(y.0))?;
        }
    }
    Ok(())
}
