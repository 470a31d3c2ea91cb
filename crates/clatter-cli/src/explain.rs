//! This module is `clatter explain`: it shows which model the worst drops of a product need, and why.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::ValueHint;
use clatter_answer::explain::Answer;
use clatter_assess::{
    Accuracy,
    ladder::{Groups, LandingLadder, LeftOut, LimitLadder, Measured, ProductLadder},
};
use clatter_product::{ProductFile, units};

use crate::columns::{Table, sentence};
use crate::inputs::{self, Format};
use crate::numbers::{figures, given};
use crate::output::Files;
use crate::progress::Counted;
use crate::text::shown;
use crate::words::{drop, in_words, percent};
use crate::{Failure, Streams, assess, text};

/// Tell which model the worst drops of a product need, and why
///
/// Six models from the least physics to the most answer the drop that 'clatter assess' finds worst for each limit: in
/// closed form the net change of velocity (net-change) and the largest shock alone (largest-shock), then strike by
/// strike map, ballistic, finite-tilt and compliant. Each is held against the one with the most physics that the file
/// allows, worked out more exactly. Told are the error of each, the cheapest within the tolerance, and the
/// dimensionless group that makes the next cheaper one too coarse.
///
/// Of a product with a width three bodies answer it, all with contacts that take time: the bar along its length, the plate of small tilt
/// and the box with full rotation, which the others are held against; told is what the bar gets wrong.
///
/// Of a box it tells of each drop which part it leaves least room, and how late the last corner of the face or edge may come within the
/// tolerance, beside a contact: from a clean landing to full clatter. Where the worst drop is on a face across which the part moves, the plate
/// that this face is and the bar along it answer it as well.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  clatter init handheld.toml && clatter explain handheld.toml
  clatter explain handheld.toml --tolerance=10%    what a quick look needs
  clatter explain handheld.toml --format=json
  clatter explain handheld-transit.toml            which of the 26 drops clatter, and what each does

'clatter tradeoff' tells what each model costs as well.")]
pub(crate) struct Args {
    /// Product file; 'clatter schema' describes it for editors
    #[arg(value_name = "PRODUCT.toml", value_hint = ValueHint::FilePath)]
    product: PathBuf,
    /// What a model may get wrong, as a share of the demand: 0.01 or 1%
    #[arg(long, value_name = "SHARE", default_value = "1%", allow_hyphen_values = true, value_parser = inputs::tolerance)]
    tolerance: f64,
    /// How to show the answer
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
}

impl Args {
    pub(crate) fn run(&self, streams: &mut Streams<'_>) -> Result<(), Failure> {
        let (file, ladders) = measure(&self.product, self.tolerance, &Files::default(), streams)?;
        match self.format {
            Format::Json => streams.json(&Answer(&ladders)),
            Format::Table => table(&file, &ladders, streams.out).map_err(Failure::Answer),
        }
    }
}

/// Measures all models on the worst drops of a product.
pub(crate) fn measure(
    path: &Path,
    tolerance: f64,
    files: &Files<'_>,
    streams: &mut Streams<'_>,
) -> Result<(ProductFile, ProductLadder), Failure> {
    let file = assess::read(path, files, streams)?;
    let ladders = assess::watched(&file, &Accuracy::default()).and_then(|answer| {
        let _measuring = Counted::begin("measuring models", 0);
        clatter_assess::ladders(&file, &answer.assessment, tolerance)
    });
    let ladders = ladders.map_err(|error| Failure::Product(format!("error: {}: {error}", text::path(path))))?;
    Ok((file, ladders))
}

/// Returns the unit in which the file gives a limit.
pub(crate) fn unit(file: &ProductFile, limit: &LimitLadder) -> Option<&'static units::Unit> {
    let component = file.components.iter().find(|component| component.name == limit.component)?;
    component.limits.unit(limit.limit, limit.ladder.unit)
}

/// Writes the limits that were left out, and why.
pub(crate) fn left_out(ladders: &ProductLadder, out: &mut dyn Write) -> io::Result<()> {
    for LeftOut { component, limit, reason } in &ladders.left_out {
        writeln!(out, "\n{}, {}: left out, {reason}", shown(component, 24), limit.name())?;
    }
    Ok(())
}

fn table(file: &ProductFile, ladders: &ProductLadder, out: &mut dyn Write) -> io::Result<()> {
    let (name, tolerance) = (shown(&ladders.product, 60), given(100.0 * ladders.tolerance));
    let head = format!("{name}: the cheapest model within {tolerance} % of the one with the most physics");
    sentence(out, "", &head)?;
    ladders.limits.iter().try_for_each(|limit| of_limit(file, limit, out))?;
    left_out(ladders, out)?;
    if ladders.landings.is_empty() { Ok(()) } else { landings(&ladders.landings, out) }
}

/// Writes a row for each drop of a box: the range that its tolerance leaves open, and the limit with the least margin.
fn landings(landings: &[LandingLadder], out: &mut dyn Write) -> io::Result<()> {
    let row = |cells: [&str; 8]| cells.map(str::to_owned).to_vec();
    let mut rows = vec![
        row(["drop", "off", "last corner", "contact", "one landing", "tightest", "limit", "margin"]),
        row(["", "deg", "ms", "ms", "deg", "", "", ""]),
    ];
    let range = |[lo, hi]: [f64; 2]| {
        let [low, high] = [lo, hi].map(|s| figures(1e3 * s));
        if lo < hi { format!("{low} to {high}") } else { low }
    };
    for landing in landings {
        let tightest = landing.tightest.as_ref();
        rows.push(vec![
            landing.landing.to_string(),
            figures(landing.tolerance_deg),
            if landing.corners > 1 { range(landing.last_corner_s) } else { "one corner".to_owned() },
            range(landing.contact_time_s),
            landing.as_one_to_deg.map_or("always".to_owned(), |deg| format!("to {}", figures(deg))),
            tightest.map_or("-".to_owned(), |limit| shown(&limit.component, 24)),
            tightest.map_or("-".to_owned(), |limit| limit.limit.name().to_owned()),
            tightest
                .and_then(|limit| limit.margin)
                .map_or("-".to_owned(), |margin| format!("{:+.1} %", 100.0 * margin)),
        ]);
    }
    writeln!(out)?;
    Table { keys: 1, headings: 2, texts: 1, last_is_text: false, least: 9, rows }.write(out)?;
    let clatter = landings.iter().filter(|landing| landing.may_clatter()).count();
    let text = format!(
        "{clatter} of {} drops may clatter: within their tolerance the last corner of the face or edge comes when the contact of the first is \
         over, the gap over the speed. The same drop is one landing where it is turned off by less than stands under it.",
        landings.len()
    );
    writeln!(out)?;
    sentence(out, "", &text)
}

fn of_limit(file: &ProductFile, limit: &LimitLadder, out: &mut dyn Write) -> io::Result<()> {
    let ladder = &limit.ladder;
    writeln!(out, "\n{}, {}", shown(&limit.component, 60), limit.limit.name())?;
    sentence(out, "  worst drop ", &drop(&limit.worst_case))?;
    for Measured { model, value, error, .. } in &ladder.models {
        let mark = if *model == ladder.cheapest { "  cheapest within the tolerance" } else { "" };
        let value = in_words(ladder.unit, unit(file, limit), *value);
        let line = format!("  {:<14}{value:>14}  off by {:<8}{mark}", model.name(), percent(*error));
        writeln!(out, "{}", line.trim_end())?;
    }
    sentence(out, "  because    ", &ladder.reason)?;
    sentence(out, "  groups     ", &groups(&ladder.groups))
}

/// Writes the dimensionless groups that are known.
fn groups(groups: &Groups) -> String {
    let Groups { gravity, geometry, overlap, pulse, train, damping, across } = *groups;
    let named = [
        ("g h0/v0²", Some(gravity)),
        ("φ²", Some(geometry)),
        ("τ/Δt", overlap),
        ("ωτ", pulse),
        ("ω t_N", train),
        ("ζωΔt", damping),
        ("h_y/h_x", across),
    ];
    let known = named.into_iter().filter_map(|(name, x)| x.map(|x| format!("{name} = {}", figures(x))));
    known.collect::<Vec<_>>().join(", ")
}
