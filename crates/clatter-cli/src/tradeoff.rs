//! This module is `clatter tradeoff`: it shows the error of every model in the worst drops of a product, and its cost.

use std::io::{self, Write};
use std::path::PathBuf;

use clap::ValueHint;
use clatter_assess::ladder::{LimitLadder, Measured, ProductLadder};
use clatter_product::ProductFile;

use crate::columns::sentence;
use crate::input::is_standard;
use crate::inputs::{self, RowFormat};
use crate::numbers::{digits, given};
use crate::output::Files;
use crate::text::{field, shown};
use crate::words::{drop, in_words, percent, time};
use crate::{Failure, Streams, explain, output};

/// Measure speed against accuracy: what every model gets wrong in the worst drops of a product, and what it costs
///
/// Six models from the least physics to the most answer the drop that 'clatter assess' finds worst for each limit, and
/// are held against the one with the most physics that the file allows, worked out more exactly; of a product with a width three bodies:
/// bar, plate and box. Times are of this
/// machine; errors are the same everywhere. 'clatter explain' tells what the models are and which physics decides.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  clatter init handheld.toml && clatter tradeoff handheld.toml
  clatter tradeoff handheld.toml --tolerance=10%   the cheapest model that is good to 10 %
  clatter tradeoff handheld.toml -o trade.svg      error over cost, a panel for each limit
  clatter tradeoff handheld.toml --format=csv      a row for each model, every digit

How to read the table:
  error      what the model gets wrong here, as a share of the demand by the reference
  time       one run, the median of many
  strikes    strikes followed; 0 in closed form
  cheapest   no other model within the tolerance takes less time")]
pub(crate) struct Args {
    /// Product file; 'clatter init' writes one
    #[arg(value_name = "PRODUCT.toml", value_hint = ValueHint::FilePath)]
    product: PathBuf,
    /// What a model may get wrong, as a share of the demand: 0.01 or 1%
    #[arg(long, value_name = "SHARE", default_value = "1%", allow_hyphen_values = true, value_parser = inputs::tolerance)]
    tolerance: f64,
    /// Write error over cost as a figure, log-log; - writes it to standard output in place of the answer
    #[arg(short, long, value_name = "FILE.svg", value_hint = ValueHint::FilePath, value_parser = output::ending("svg"))]
    output: Option<PathBuf>,
    /// How to show the answer
    #[arg(long, value_enum, default_value_t = RowFormat::Table)]
    format: RowFormat,
}

impl Args {
    pub(crate) fn files(&self) -> Files<'_> {
        Files { reads: vec![&self.product], writes: self.output.iter().map(AsRef::as_ref).collect() }
    }

    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        output::in_place_of_answer(self.output.as_deref(), matches!(self.format, RowFormat::Table))?;
        let (file, ladders) = explain::measure(&self.product, self.tolerance, &self.files(), streams)?;
        if let Some(path) = &self.output {
            let svg = clatter_report::ladder_svg(&ladders)?;
            if is_standard(path) {
                return streams.out.write_all(svg.as_bytes()).map_err(Failure::Answer);
            }
            output::replace(path, |file| file.write_all(svg.as_bytes()))?;
        }
        match self.format {
            RowFormat::Table => table(&file, &ladders, streams.out).map_err(Failure::Answer),
            RowFormat::Csv => csv(&ladders, streams.out).map_err(Failure::Answer),
            RowFormat::Json => streams.json(&ladders),
        }
    }
}

fn table(file: &ProductFile, ladders: &ProductLadder, out: &mut dyn Write) -> io::Result<()> {
    let (name, tolerance) = (shown(&ladders.product, 60), given(100.0 * ladders.tolerance));
    writeln!(out, "{name}: speed for accuracy, to {tolerance} %")?;
    let machine = &ladders.machine;
    let slow = if machine.optimized { "" } else { "; built without optimization, times say nothing" };
    writeln!(
        out,
        "Times of one run on one of {} processors, {} ({}){slow}",
        machine.processors,
        shown(&machine.processor, 80),
        machine.system
    )?;
    ladders.limits.iter().try_for_each(|limit| of_limit(file, limit, out))?;
    explain::left_out(ladders, out)
}

fn of_limit(file: &ProductFile, limit: &LimitLadder, out: &mut dyn Write) -> io::Result<()> {
    let (ladder, reference, unit) = (&limit.ladder, &limit.ladder.reference, explain::unit(file, limit));
    writeln!(out, "\n{}, {}", shown(&limit.component, 24), limit.limit.name())?;
    sentence(out, "  drop       ", &drop(&limit.worst_case))?;
    let (name, value) = (reference.model.name(), in_words(ladder.unit, unit, reference.value));
    writeln!(out, "  reference  {name}: {value}, worked out to {}\n", percent(reference.tolerance))?;
    writeln!(out, "  {:<13} {:>14} {:>9} {:>9} {:>7}", "model", "demand", "error", "time", "strikes")?;
    for Measured { model, value, error, seconds, strikes } in &ladder.models {
        let value = in_words(ladder.unit, unit, *value);
        let cheapest = if *model == ladder.cheapest { "  cheapest" } else { "" };
        let (model, error, time) = (model.name(), percent(*error), time(*seconds));
        writeln!(out, "  {model:<13} {value:>14} {error:>9} {time:>9} {strikes:>7}{cheapest}")?;
    }
    writeln!(out, "  {}", ladder.reason)
}

fn csv(ladders: &ProductLadder, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "component,limit,model,value,unit,error,seconds,strikes,cheapest")?;
    for LimitLadder { component, limit, ladder, .. } in &ladders.limits {
        for Measured { model, value, error, seconds, strikes } in &ladder.models {
            let [value, error, seconds] = [*value, *error, *seconds].map(digits);
            let (component, limit, unit) = (field(component), limit.name(), ladder.unit.name());
            let (name, cheapest) = (model.name(), *model == ladder.cheapest);
            writeln!(out, "{component},{limit},{name},{value},{unit},{error},{seconds},{strikes},{cheapest}")?;
        }
    }
    Ok(())
}
